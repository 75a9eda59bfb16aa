"""What definitions of several figures have in common: a line cut into springs, a membrane drawn in Rhino, engines."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from hookean_canvas.definitions.write import Definition, Made, Output, flat


@dataclass(frozen=True)
class Line:
    """A line between two points: its ends, its pieces, the points between them."""

    ends: Made
    pieces: Output
    points: Made
    lengths: Output

    @property
    def held(self) -> Any:
        """Both ends, as anchors."""
        return flat(self.ends["Start"], self.ends["End"])


def line(d: Definition, pieces: int, least: int = 1) -> Line:
    """The group of a line of 10 m in so many pieces, `least` of them or up to 50."""
    with d.group("Line"):
        end = d.point(d.slider("Span [m]", 10, 1, 20, decimals=1), 0, 0)
        drawn = d.native("Line", start_point=d.point(0, 0, 0), end_point=end)
        ends = d.native("End Points", curve=drawn)
        count = d.slider("Springs [-]", pieces, least, 50)
        cut = d.component("Shatter", curve=drawn, count=count)
        return Line(ends, cut["lines"], d.component("Divide", curve=drawn, count=count), cut["lengths"])


def hung(d: Definition, line: Line, given: Mapping[str, Any], *, damped: bool = False) -> tuple[Any, Made]:
    """The group of a cable's forces: springs of the `stiffness`, and the `damping`, and the `load` that are given; and
    the slider of the stiffness."""
    with d.group("Forces"):
        stiffness = d.slider("Stiffness [N/m]", given["stiffness"], 10, 5000)
        more: dict[str, Any] = {"damping": d.slider("Damping [N s/m]", given["damping"], 0, 100)} if damped else {}
        springs = d.component("Springs", connection=line.pieces, stiffness=stiffness, **more)
        return flat(springs, d.component("Unary", point=line.points, force=down(d, given))), stiffness


def down(d: Definition, given: Mapping[str, Any], most: int = 100) -> Made:
    """The `load` that is given as a vector down, with its slider from -`most` to 0."""
    return d.native("Unit Z", factor=d.slider("Load [N]", -given["load"], -most, 0, decimals=1))


def at_rest(d: Definition, forces: Any, line: Line, anchors: Any) -> Made:
    """The group of an engine that brings a cable to rest."""
    with d.group("Engine"):
        settings = d.component("Settings", residual=d.text("Residual [-]", "1e-12"), fast=d.toggle("Fast", True))
        return d.component(
            "Engine", forces=forces, anchors=anchors, settings=settings, geometry=line.pieces,
            reset=d.toggle("Reset", True),
        )  # fmt: skip


def surface(d: Definition, given: Mapping[str, Any], most: int) -> tuple[Made, Output]:
    """The file beside the definition, and the mesh of the membrane drawn in it, in the `divisions` that are given, on
    sliders from 2 to `most`."""
    file, count = d.text("File", "model.3dm"), given["divisions"]
    drawn = d.component(
        "RhinoFile", file=file, layer=d.text("Surface", "membrane"), u=d.slider("U [-]", count, 2, most),
        v=d.slider("V [-]", count, 2, most),
    )  # fmt: skip
    return file, drawn["meshes"]


def solving(d: Definition, solver: str, residual: str) -> Made:
    """Settings of a solver that goes on to a residual."""
    texts = d.text("Solver", solver), d.text("Residual [-]", residual)
    return d.component("Settings", solver=texts[0], residual=texts[1], fast=d.toggle("Fast", True))


def engine(d: Definition, solver: str, residual: str, **inputs: Any) -> Made:
    """An engine that brings what is given to rest with a solver, once Reset is False."""
    settings = solving(d, solver, residual)
    return d.component("Engine", settings=settings, reset=d.toggle("Reset", True), **inputs)


def motion(sentence: str) -> str:
    """The script of a motion up to a time, by the forces, anchors and settings of a canvas, with its description."""
    return f'''
"""{sentence}"""

from hookean_client import canvas_ask, canvas_geometry, canvas_scene

setting = canvas_scene.read([settings], "settings", "settings")[0]
scene = canvas_scene.compose(canvas_scene.read(forces, None, "forces"), [], setting, [])
scene["anchors"] = [{{"points": canvas_geometry.points(anchors)}}]
scene["settings"]["max_iterations"] = int(round(time / scene["settings"]["time_step"]))
answer = canvas_ask.call(ghenv, "POST", "/v1/relax", scene)
particles = answer and [canvas_geometry.to_point(p) for p in answer["particles"]]
'''
