"""Draws the .3dm models of the examples, what a person would draw in Rhino before starting, and makes the wind.

Run it from the project's root: `.venv/bin/python gh_examples/build_models.py [NAME ...]`. Machines differ
in last digits. Where a figure's scene.py makes its geometry, the model is drawn from that; free-form curves and
surfaces are drawn here, and scene.py reads them from the model.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
import rhino3dm
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import make_interp_spline

from hookean.commands.examples import figure
from hookean.files.rhino.threedm import Additions, NewLayer, NewObject, write_new

HERE = Path(__file__).parent
Floats = NDArray[np.float64]
Colour = tuple[int, int, int]
Drawn = tuple[str, str, Any]  # layer, name, geometry

BLUE, RED, GREEN = (40, 90, 160), (180, 60, 40), (60, 130, 70)
BEZIER = {2: [0.0, 1.0], 3: [0.0, 0.0, 1.0, 1.0], 4: [0.0, 0.0, 0.0, 1.0, 1.0, 1.0]}  # knots by number of points
MEMBRANE = figure("9.24-membrane").scene


def write(folder: str, layers: dict[str, Colour], objects: Iterable[Drawn]) -> None:
    """The model of a figure. A layer `a::b` lies in `a`."""
    paths = [(path.rpartition("::"), colour) for path, colour in layers.items()]
    made = tuple(NewLayer(name, parent, colour=(*colour, 255)) for (parent, _, name), colour in paths)
    drawn = tuple(NewObject(geometry, layer=layer, name=name) for layer, name, geometry in objects)
    write_new(HERE / folder / "model.3dm", Additions(layers=made, objects=drawn), own=False)


def surface(points: Floats, along: Any = None, across: Any = None) -> Any:
    """The NURBS surface of control points (m, n, 3) [m] over knots as Rhino counts them; a Bezier without them."""
    knots = [BEZIER[n] if given is None else given for n, given in zip(points.shape, (along, across), strict=False)]
    degrees = [len(given) - n + 1 for n, given in zip(points.shape, knots, strict=False)]
    made = rhino3dm.NurbsSurface.Create(3, False, *(d + 1 for d in degrees), *points.shape[:2])
    for place in np.ndindex(*points.shape[:2]):
        made.Points[place] = rhino3dm.Point4d(*points[place].tolist(), 1.0)
    for target, values in zip((made.KnotsU, made.KnotsV), knots, strict=True):
        for i, value in enumerate(values):
            target[i] = value
    return made


def curve(points: Floats, knots: Iterable[float]) -> Any:
    """The cubic NURBS curve of control points (n, 3) [m] over knots as Rhino counts them."""
    made = rhino3dm.NurbsCurve(3, len(points))
    for i, place in enumerate(points.tolist()):
        made.Points[i] = rhino3dm.Point4d(*place, 1.0)
    for i, value in enumerate(knots):
        made.Knots[i] = value
    return made


def through(points: Floats) -> tuple[Floats, list[float]]:
    """Control points and knots of the cubic spline through points at parameters 0, 1, 2 ..."""
    spline = make_interp_spline(np.arange(len(points)), points, k=3, axis=0)
    return spline.c, spline.t[1:-1].tolist()


def closed(points: Floats) -> Any:
    """The periodic cubic NURBS curve through points (n, 3)."""
    spline = make_interp_spline(np.arange(len(points) + 1), np.vstack([points, points[:1]]), k=3, bc_type="periodic")
    return curve(spline.c, spline.t[1:-1].tolist())


def at(points: ArrayLike) -> list[Any]:
    """Points of Rhino."""
    return [rhino3dm.Point3d(*place) for place in np.asarray(points, float).tolist()]


def arc(points: ArrayLike) -> Any:
    """The arc through three points."""
    return rhino3dm.Arc(*at(points)).ToNurbsCurve()


def line(start: ArrayLike, end: ArrayLike) -> Any:
    return rhino3dm.LineCurve(*at([start, end])).ToNurbsCurve()


def points(layer: str, places: ArrayLike, name: str = "") -> list[Drawn]:
    return [(layer, name, rhino3dm.Point(place)) for place in at(places)]


def square() -> Any:
    """The membrane of figure 9.24: a flat surface of degree 3 whose even parameters make square faces."""
    return surface(MEMBRANE(divisions=3).particles.reshape(4, 4, 3))


def cables() -> None:
    """Figures 9.4, 9.6 and 9.7: a straight line; for 9.7 a point at each end as well."""
    left, right = figure("9.4-cable").scene().particles[[0, -1]]
    cable = ("cable", "cable", line(left, right))
    for folder in ("9.4-cable", "9.6-bouncing"):
        write(folder, {"cable": BLUE}, [cable])
    ends = [*points("left", [left], "left"), *points("right", [right], "right")]
    write("9.7-anchors-moved", {"cable": BLUE, "left": RED, "right": GREEN}, [cable, *ends])


def arcs() -> None:
    """Figures 9.17 to 9.21: a straight line of 10 m, and arcs of 20 m over chords of 10 m and 14 m."""
    scene = figure("9.17-arc-to-catenary").scene
    left, right = scene(arc_length=10.0).particles[[0, -1]]
    narrow, wide = (scene(span=span, pieces=2).particles for span in (10.0, 14.0))
    drawn = [
        ("line", "", line(left, right)),
        ("arc", "", arc(narrow + [0.0, 4.0, 0.0])),
        ("wide arc", "", arc(wide + [0.0, 8.0, 0.0])),
    ]
    write("9.17-arc-to-catenary", {"line": BLUE, "arc": (200, 90, 40), "wide arc": (60, 140, 90)}, drawn)
    write("9.21-arc-frames", {"arc": BLUE}, [("arc", "", arc(narrow))])


def frames() -> None:
    """Figure 9.22: two closed free-form frames, and a straight line for each chain between them."""
    t = np.linspace(0.0, 2.0 * np.pi, 9)[:-1]
    near = closed(np.stack([1.5 * np.sin(2 * t), 5.2 * np.cos(t) + 0.6 * np.cos(3 * t), 6.5 + 3.6 * np.sin(t)], 1))
    far = closed(
        np.stack([13.0 - 1.8 * np.cos(t), 4.0 * np.cos(t) - 1.0, 8.0 + 4.2 * np.sin(t) + 0.9 * np.cos(2 * t)], 1)
    )
    ends = figure("9.22-freeform-frames").scene(near, far, links=1).particles.reshape(-1, 2, 3)
    chains = [("chains", "", rhino3dm.LineCurve(*at(pair))) for pair in ends]
    drawn = [("frames", "", near), ("frames", "", far), *chains]
    write("9.22-freeform-frames", {"frames": BLUE, "chains": (200, 90, 40)}, drawn)


def membranes() -> None:
    """Figures 9.24 to 9.30: a square; for 9.26 its corners, two that rise and two that sink, for 9.27 what holds it."""
    write("9.24-membrane", {"membrane": BLUE}, [("membrane", "roof", square())])
    write("9.30-creases", {"membrane": BLUE}, [("membrane", "sheet", square())])
    corners = MEMBRANE(divisions=1).particles
    led = [*points("rising", corners[[0, 3]], "rising"), *points("sinking", corners[[2, 1]], "sinking")]
    layers = {"membrane": BLUE, "rising": RED, "sinking": GREEN}
    write("9.26-membrane-anchors-moved", layers, [("membrane", "membrane", square()), *led])
    anchors = points("anchors", figure("9.27-naked-vertices").POINTS)
    layers = {"membrane": BLUE, "anchors": (34, 48, 60)}
    write("9.27-naked-vertices", layers, [("membrane", "", square()), *anchors])


def hypar() -> None:
    """Figure 9.28: a surface whose rim is the frame; a bulge is 4 times as high at the control point below it."""
    controls = figure("9.28-rest-factor-zero").scene(divisions=2).particles.reshape(3, 3, 3).copy()
    controls[1, 1, 2] *= 4.0
    write("9.28-rest-factor-zero", {"membrane": BLUE}, [("membrane", "bulge", surface(controls))])


def diagonals() -> None:
    """Figures 9.29 and 9.31: the square with one diagonal of each face drawn, joined to polylines, one way and the
    other."""
    places = figure("9.29-diagonals").scene().particles.reshape(11, 11, 3)
    drawn = [("membrane", "", square())]
    for layer, rows in (("one way", places), ("other way", places[:, ::-1])):
        for shift in range(-9, 10):
            strip = rhino3dm.Polyline()
            for x, y, z in np.diagonal(rows, -shift).T.tolist():
                strip.Add(x, y, z)
            drawn.append((layer, "", strip.ToPolylineCurve()))
    for folder in ("9.29-diagonals", "9.31-diagonal-patterns"):
        write(folder, {"membrane": BLUE, "one way": (194, 53, 43), "other way": (42, 157, 92)}, drawn)


def profiles(arcs: int) -> Floats:
    """Control points (arcs, 5, 3) [m] of the ribbon's arcs, each in a vertical plane across the way of the ribbon."""
    t = np.linspace(0.0, 1.0, arcs)
    turn = 2.0 * np.pi * t
    sway = 0.95 * turn + 0.4
    foot = np.stack([26.0 * (t - 0.5), 4.0 * np.sin(sway), np.zeros(arcs)], axis=1)
    way = np.stack([np.full(arcs, 26.0), 4.0 * 1.9 * np.pi * np.cos(sway)], axis=1)
    way /= np.linalg.norm(way, axis=1)[:, None]
    across = np.stack([-way[:, 1], way[:, 0], np.zeros(arcs)], axis=1)
    low = 0.7 - 0.6 * np.cos(1.2 * turn + 0.3)
    high = 6.2 + 1.7 * np.cos(1.1 * turn - 1.9)
    lean = -2.6 * np.sin(sway)
    bulge = 3.2 * np.sin(sway)
    # along the arc: height from low to high, and how much of the lean and of the bulge
    shares = np.array([[0.0, 0.0, 0.0], [0.15, 0.0, 0.6], [0.6, 0.1, 1.05], [1.0, 0.4, 0.75], [1.0, 1.0, 0.0]])
    controls = np.repeat(foot[:, None, :], 5, axis=1)
    controls += (lean[:, None] * shares[:, 1] + bulge[:, None] * shares[:, 2])[..., None] * across[:, None, :]
    controls[..., 2] += low[:, None] + (high - low)[:, None] * shares[:, 0]
    return controls


def ribbon() -> None:
    """Figure 9.32. The arcs are curves v of the surface at u = 0, 1 .. 10, the beams its two long edges."""
    drawn = profiles(11)
    up = [0.0, 0.0, 0.0, 0.5, 1.0, 1.0, 1.0]
    controls, along = through(drawn)
    layers = {"beams": (20, 20, 20), "arcs": (150, 60, 40), "arcs::inner": (150, 60, 40), "arcs::ends": (200, 120, 40),
              "membrane": BLUE}  # fmt: skip
    beams = {"lower beam": controls[:, 0], "upper beam": controls[:, -1]}
    objects = [("beams", name, curve(beam, along)) for name, beam in beams.items()]
    for i, profile in enumerate(drawn):
        objects.append(("arcs::ends" if i in (0, 10) else "arcs::inner", f"arc {i + 1}", curve(profile, up)))
    write("9.32-ribbon", layers, [*objects, ("membrane", "ribbon", surface(controls, along, up))])


def sphere() -> None:
    """Section 9.7: the mesh sphere as Rhino's command MeshSphere numbers its faces, from pole to pole."""
    drawn = figure("sphere").scene().meshes["sphere"]
    mesh = rhino3dm.Mesh()
    for x, y, z in drawn.vertices.tolist():
        mesh.Vertices.Add(x, y, z)
    for a, b, c, d in drawn.faces.reshape(12, 20, 4).swapaxes(0, 1).reshape(-1, 4).tolist():
        mesh.Faces.AddFace(a, b, c) if c == d else mesh.Faces.AddFace(a, b, c, d)
    mesh.Normals.ComputeNormals()
    write("sphere", {"sphere": BLUE}, [("sphere", "sphere", mesh)])


def sail() -> None:
    """The sail: a ruled surface."""
    controls = figure("wind").scene(divisions=3).particles.reshape(4, 4, 3)
    write("wind", {"sail": BLUE}, [("sail", "sail", surface(controls))])


def wind() -> None:
    """wind.csv, made by formula and not measured: two waves about 8 m/s, a gust at 20 s that adds 1 - cos of 4 s, and
    from 28 s on a steady 12 m/s."""
    t = np.arange(0.0, 44.01, 0.5)
    waves = 8.0 + 2.0 * np.sin(2 * np.pi * t / 14.0) + 1.2 * np.sin(2 * np.pi * t / 4.7 + 1.0)
    gust = np.where(np.abs(t - 20.0) < 2.0, 4.0 * (1.0 + np.cos(np.pi * (t - 20.0) / 2.0)), 0.0)
    speed = np.where(t < 28.0, waves + gust, 12.0)
    rows = [f"{a:.1f},{b:.1f}" for a, b in zip(t, speed, strict=True)]
    text = "\n".join(["time [s],speed [m/s]", *rows, ""])
    (HERE / "wind" / "wind.csv").write_text(text, encoding="utf-8", newline="\n")


def hypar_roof() -> None:
    """The roof between its four masts: the hyperbolic paraboloid on straight edges."""
    controls = figure("hypar-roof").scene(divisions=1).particles.reshape(2, 2, 3)
    write("hypar-roof", {"roof": BLUE}, [("roof", "roof", surface(controls))])


def hanging_vault() -> None:
    """The flat net, its nine columns, and the chain as an arc that hangs down, 5 m in front of the net."""
    vault = figure("hanging-vault")
    net = vault.scene()
    columns = points("columns", net.particles[net.anchors[0].particles], "column")
    chain = arc(vault.chain(links=2).particles + [2.0, -5.0, 0.0])
    layers = {"net": BLUE, "columns": (190, 60, 40), "chain": (60, 60, 60)}
    roof = ("net", "roof", surface(net.particles.reshape(21, 15, 3)[::20, ::14]))
    write("hanging-vault", layers, [roof, *columns, ("chain", "chain", chain)])


def basento() -> None:
    """One bay of the bridge, near its proportions and not a survey: the skin through five sections (finger, foot,
    finger, foot, finger), its four feet, the six fingers that carry the deck, the edges of the deck."""
    bay, width, height = 70.0, 16.0, 16.0  # m
    apart, stance = 26.0, 11.0  # m, of the feet, along and across
    camber = 1.5  # m, how far the drawn skin bows across: it hangs between the fingers and arches over the feet
    along = 0.5 * np.array([-bay, -apart, 0.0, apart, bay])
    half = 0.5 * np.array([width, stance, width, stance, width])
    level = np.array([height, 0.0, height, 0.0, height])
    bow = camber * np.array([-1.0, 1.0, -1.0, 1.0, -1.0])
    sections = np.zeros((5, 3, 3))
    for j, (side, rise) in enumerate(((-1.0, 0.0), (0.0, 2.0), (1.0, 0.0))):
        sections[:, j] = np.column_stack([along, side * half, level + rise * bow])
    # cubic B-splines over the knots 0, 0.5 and 1 at 0, 1/4, 1/2, 3/4 and 1
    values = np.array([[32, 0, 0, 0, 0], [4, 19, 8, 1, 0], [0, 8, 16, 8, 0], [0, 1, 8, 19, 4], [0, 0, 0, 0, 32]]) / 32.0
    controls = np.linalg.solve(values, sections.reshape(5, 9)).reshape(5, 3, 3)
    skin = surface(controls, [0.0, 0.0, 0.0, 0.5, 1.0, 1.0, 1.0])
    x, y = 0.5 * bay, 0.5 * width
    feet = [(0.5 * a * apart, 0.5 * b * stance, 0.0) for a in (-1, 1) for b in (-1, 1)]
    fingers = [(a * x, b * y, height) for a in (-1, 0, 1) for b in (-1, 1)]
    edges = [("deck", "deck edge", line((-x, side, height), (x, side, height))) for side in (-y, y)]
    layers = {"skin": BLUE, "deck": (60, 60, 60), "feet": (190, 60, 40), "fingers": (190, 120, 40)}
    held = [*points("feet", feet, "foot"), *points("fingers", fingers, "finger")]
    write("basento", layers, [("skin", "bay", skin), *held, *edges])


if __name__ == "__main__":
    chosen = sys.argv[1:]
    models = (
        cables,
        arcs,
        frames,
        membranes,
        hypar,
        diagonals,
        ribbon,
        sphere,
        sail,
        wind,
        hypar_roof,
        hanging_vault,
        basento,
    )
    for model in models:
        if not chosen or model.__name__ in chosen:
            model()
            print(model.__name__)
