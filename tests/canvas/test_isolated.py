"""The code inside every user object, alone in the Pythons of Rhino: no error, one sentence where nothing is connected,
and against a live server the same numbers in all of them."""

from __future__ import annotations

import json
import math
import os
import shutil
import subprocess
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import pytest

import pythons
from canvas import isolated, wired
from hookean.forces import KINDS
from hookean_canvas import archive
from hookean_canvas.components import bundles, userobject
from hookean_canvas.run import stand_in
from serving import HANG, Home

PYTHONS = ("2.7", "3.9", "3.13")
"""Of Rhino 7 as far as it goes, Rhino 8 and Rhino 9."""
NAMES = [name for name in bundles.names() if not bundles.read(name).rhino8_only]
MODEL = Path(__file__).parents[2] / "gh_examples" / "9.4-cable" / "model.3dm"
LOOSE = {"iterations", "progress", "report", "status", "residual", "energy", "url", "version", "sessions"}
"""Outputs that tell how a run went, not where it ended."""

ABOUT = "import os; os.fstat(os.open(os.devnull, os.O_RDONLY))"
"""What the client asks of a server's file before it trusts it: Jython cannot answer in recent versions of Java."""


@cache
def interpreter(version: str) -> list[str]:
    """The command of a Python of that version, alone; none where this machine has it not."""
    if found := pythons.interpreter(version):
        return [found, *(["-I"] if version != "2.7" else ["-E", "-s"])]
    jython = shutil.which("jython") if version == "2.7" else None
    return [jython] if jython and subprocess.run([jython, "-c", ABOUT], capture_output=True).returncode == 0 else []


@cache
def inside(name: str, flavour: Any) -> str:
    """The code as it stands in the built user object of a bundle."""
    outer = archive.of_bytes(archive.to_bytes(userobject.user_object(bundles.read(name), flavour)))
    inner = archive.of_bytes(outer.value("Object"))
    if flavour == "rhino7":
        return str(inner.value("CodeInput"))
    import base64

    return base64.b64decode(inner.chunk("Script").value("Text")).decode()


def point(*parts: float) -> dict[str, Any]:
    return {"Point3d": parts}


def line(a: tuple[float, ...], b: tuple[float, ...]) -> dict[str, Any]:
    return {"Line": [a, b]}


QUADS = {"vertices": [[0, 0, 0], [1, 0, 0], [2, 0, 0.5], [0, 1, 0], [1, 1, 0.2], [2, 1, 0]],
         "faces": [[0, 1, 4, 3], [1, 2, 5, 4]]}  # fmt: skip
MESH, ROW = {"Mesh": QUADS}, [point(0, 0, 0), point(1, 0, 0), point(2, 0, 1), point(3, 1, 0)]
CURVE = {"NurbsCurve": {"degree": 2, "points": [[0, 0, 0], [1, 2, 0.5], [2, 0, 1]], "knots": [0, 0, 1, 1],
                        "weights": [1, 0.5, 1]}}  # fmt: skip
SURFACE = {"NurbsSurface": {"degree_u": 1, "degree_v": 1, "points": [[[0, 0, 0], [0, 2, 0]], [[3, 0, 0], [3, 2, 1]]],
                            "knots_u": [0, 1], "knots_v": [0, 1]}}  # fmt: skip
FLAT = {"Mesh": {**QUADS, "vertices": [[x, y, 0] for x, y, _ in QUADS["vertices"]]}}
MOVED = {"Mesh": {**QUADS, "vertices": [[y, 5 - x, 2 * z + 1] for x, y, z in QUADS["vertices"]]}}
FOLD = [[point(0, 0, 0)], [point(1, 0, 0)], [point(0, 1, 0), point(0, 1, 1)], [point(0, -1, 0)]]
SAMPLES: dict[str, dict[str, Any]] = {
    **{cls.__name__: wired.inputs(kind) for kind, cls in KINDS.items()},
    "AlignQuads": {"_mesh": [MESH]},
    "Anchors": {"_point": ROW, "_x_": [True, False]},
    "Variables": {"_force": ["Springs"], "_field": ["stiffness"], "_tie_": ["all"], "lower_": [1.0]},
    "Goals": {"_kind": ["position"], "points_": [point(5, 0, 0)], "axes_": ["z"], "target_": [-1.5]},
    "Constraints": {"_kind": ["force"], "forces_": ["Springs"], "upper_": [500.0]},
    "Bipartite": {"_lines": [line((0, 0, 0), (1, 0, 0)), line((1, 0, 0), (2, 0, 1))]},
    "Checkerboard": {"_mesh": [MESH]},
    "CombineClean": {"_meshes": [MESH, MESH]},
    "Catenary": {"_start": ROW[:1], "_end": ROW[3:], "_length": [4.0], "_count_": [5]},
    "Combination": {"_cases": ["snow"], "_factors_": [1.5], "name_": ["ULS"]},
    "Counter": {"_reset_": [True]},
    "LoadCase": {"_loads": ["Unary"], "_factor_": [2.0], "name_": ["snow"]},
    "Grab": {"_range_": [2.0]},
    "Diagonalize": {"_mesh": [MESH]},
    "Diagonals": {"_mesh": [MESH], "_pattern_": ["both"]},
    "Divide": {"_curve": [CURVE], "_count_": [7]},
    "FoldAngle": dict(zip(("_start", "_end", "_tip_1", "_tip_2"), FOLD, strict=True)),
    "HingePoints": {"_mesh": [MESH]},
    "InterconnectPoints": {"_points": ROW},
    "Interpolate": {"_points": ROW, "_count_": [6]},
    "LiveFilm": {"_mesh": [MESH], "_length": [0.4]},
    "MeshCorners": {"_mesh": [MESH]},
    "MeshEdges": {"_mesh": [MESH]},
    "MeshMap": {"_point": ROW, "_source": [MESH], "_target": [MOVED]},
    "MeshSurface": {"_surface": [SURFACE], "_u_": [3], "_v_": [2]},
    "MeshVertices": {"_mesh": [MESH]},
    "MoebiusTransformation": {"_points": ROW, "_angle": [0.4]},
    "NakedVertices": {"_mesh": [MESH]},
    "Pipes": {"_lines": [line((0, 0, 0), (1, 0, 0)), line((0, 0, 0), (0, 1, 0.3))], "_radius": [0.1], "_sides_": [4]},
    "ReciprocalDiagram": {"_mesh": [FLAT]},
    "RemoveDuplicateLines": {"_lines": [line((0, 0, 0), (1, 0, 0)), line((1, 0, 0), (0, 0, 0))]},
    "RemoveDuplicatePoints": {"_points": [*ROW, *ROW]},
    "Refine": {"_mesh": [MESH], "_smooth_": [True]},
    "RefineStrips": {"_mesh": [MESH], "_level_": [2]},
    "Remesh": {"_mesh": [MESH], "_length": [0.4]},
    "RhinoFile": {"_file": [str(MODEL)]},
    "Sequence": {"_frames_": [2], "_restart_": [True]},
    "Server": {},
    "Settings": {"_drag_": [5.0], "_fast_": [True]},
    "Shatter": {"_curve": [CURVE], "_count_": [4]},
    "SplitAtCorners": {"_polyline": [{"Polyline": [[0, 0, 0], [1, 0, 0], [2, 0, 0], [2, 1, 0]]}]},
    "Springs": {"_connection": [line((i, 0, 0), (i + 1, 0, 0)) for i in range(10)], "_stiffness_": [1000.0]},
    "Unary": {"_point": [point(i, 0, 0) for i in range(11)], "_force": [{"Vector3d": [0, 0, -10]}]},
    "Strips": {"_mesh": [MESH]},
    "Trail": {"_points": ROW, "_record_": [False]},
    "TurnQuads": {"_mesh": [MESH], "_turns_": [3]},
    "UnrollStrips": {"_mesh": [MESH], "_direction_": ["weft"], "_gap_": [0.25]},
    "VertexNeighbours": {"_mesh": [MESH], "vertices_": [1, 4]},
    "WarpWeft": {"_mesh": [MESH]},
}


def ask(version: str, request: dict[str, Any], folder: Path, home: Home | None) -> list[dict[str, Any]]:
    """What the runner answers in that Python, in an empty folder, with a server or without one."""
    command = interpreter(version)
    if not command:
        pytest.skip(f"this machine has no Python {version}")
    folder.mkdir(exist_ok=True)
    environment = {**os.environ, "HOOKEAN_STATE": str(home.folder if home else folder / "none")}
    for name in ("HOOKEAN_PYTHON", "PYTHONPATH"):
        environment.pop(name, None)
    done = subprocess.run(
        [*command, isolated.__file__, stand_in.__file__], input=json.dumps(request), capture_output=True, text=True,
        cwd=folder, env=environment, timeout=HANG, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr[-3000:]
    found: list[dict[str, Any]] = json.loads(done.stdout)
    return found


def flavour(version: str) -> str:
    return "rhino7" if version == "2.7" else "rhino8"


def step(version: str, name: str, inputs: dict[str, Any], **more: Any) -> dict[str, Any]:
    """A step of a request, with None where nothing is connected."""
    bundle = bundles.read(name)
    given = {parameter.name: inputs.get(parameter.name) for parameter in bundle.inputs}
    outputs = [parameter.name for parameter in bundle.outputs]
    return {"name": name, "code": inside(name, flavour(version)), "inputs": given, "outputs": outputs, **more}


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Home]:
    found = Home(tmp_path_factory.mktemp("isolated") / "state")
    found.serve()
    yield found
    found.end()


def chain(version: str) -> list[dict[str, Any]]:
    """A step for each bundle with inputs, the engine last: a cable of springs, loads, settings and anchors, and a sweep
    of its stiffness."""
    steps = [step(version, name, SAMPLES[name]) for name in NAMES if name in SAMPLES and name != "Server"]
    at = {step["name"]: i for i, step in enumerate(steps)}
    forces = [{"output": [at["Springs"], "force"]}, {"output": [at["Unary"], "force"]}]
    anchors = {"DataTree": {"{0}": [point(0, 0, 0)], "{1}": [point(10, 0, 0)]}}
    rides = {"DataTree": {"{0;2}": [{"Polyline": [(i, 0, 0) for i in range(11)]}], "{3}": [point(5, 0, 0)]}}
    given = {"_forces": forces, "anchors_": anchors, "settings_": [{"output": [at["Settings"], "settings"]}],
             "geometry_": rides}  # fmt: skip
    many = {**given, "_parameters": ["Springs.stiffness"], "_values": [1000.0, 2000.0], "_run": True}
    swept = step(version, "Sweep", {name: value for name, value in many.items() if name != "geometry_"})
    moments = step(version, "Moments", {**given, "_times": [0.1, 0.2]})
    table = {"_file": [str(MODEL.parents[1] / "wind" / "wind.csv")], "_column": ["speed [m/s]"], "_force": ["Unary"]}
    driven = step(version, "Stream", {**given, **table, "_scale": [{"Vector3d": [0, 0, -1.0]}], "_every_": [4.0]})
    problem = {f"_{name.lower()}": {"output": [at[name], name.lower()]} for name in ("Variables", "Goals")}
    problem["constraints_"] = {"output": [at["Constraints"], "constraints"]}
    designed = step(version, "Design", {**given, **problem})
    held = step(version, "Engine", {**given, "_reset": True})
    runs = step(version, "Engine", {**given, "_reset": False}, solutions=4000)
    return [*steps, swept, moments, driven, designed, held, runs]


@cache
def answers(version: str, folder: Path, home: Home) -> list[dict[str, Any]]:
    """The chain in one Python; each has a definition of its own."""
    identity = f"00000000-0000-0000-0000-0000000000{int(float(version) * 10):02d}"
    request = {"path": f"/models/{version}.gh", "document": identity, "steps": chain(version)}
    return ask(version, request, folder / version, home)


def alike(a: Any, b: Any) -> bool:
    """Whether two values are the same; numbers within what two runs that end at rest may differ by."""
    if isinstance(a, float) or isinstance(b, float):
        return math.isclose(a, b, rel_tol=1e-6, abs_tol=1e-6)
    if isinstance(a, list) and isinstance(b, list):
        return len(a) == len(b) and all(map(alike, a, b))
    if isinstance(a, dict) and isinstance(b, dict):
        return a.keys() == b.keys() and all(alike(a[name], b[name]) for name in a)
    return bool(a == b)


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("alone")


@pytest.mark.thinned
@pytest.mark.parametrize("version", PYTHONS)
def test_every_component_works(version: str, place: Path, home: Home) -> None:
    """No errors or warnings, and something in every output."""
    for step, answer in zip(chain(version), answers(version, place, home), strict=True):
        assert not answer["messages"], (step["name"], answer["messages"])
        assert any(value not in (None, []) for value in answer["outputs"].values()), step["name"]


@pytest.mark.thinned
@pytest.mark.parametrize("version", PYTHONS)
def test_the_cable_hangs_as_it_should(version: str, place: Path, home: Home) -> None:
    """The figure's closed form, with the geometry and forces in the trees they came in."""
    held, runs = (answer["outputs"] for answer in answers(version, place, home)[-2:])
    assert held["iterations"] == 0
    assert [p["Point3d"][2] for p in held["particles"]] == [0.0] * 11
    assert alike(runs["particles"][5]["Point3d"], [5.0, 0.0, -1.733760513267])
    assert alike(runs["forces"]["DataTree"]["{0}"][0], 83.051717456)
    assert alike(runs["forces"]["DataTree"]["{1}"][10], {"Vector3d": [0.0, 0.0, -10.0]})
    assert set(runs["reactions"]["DataTree"]) == {"{0}", "{1}"}
    assert alike(runs["reactions"]["DataTree"]["{1}"][0]["Vector3d"][2], 55.0)
    assert set(runs["geometry"]["DataTree"]) == {"{0;2}", "{3}"}
    assert runs["geometry"]["DataTree"]["{3}"] == [runs["particles"][5]]
    assert runs["geometry"]["DataTree"]["{0;2}"][0]["Polyline"] == [p["Point3d"] for p in runs["particles"]]


@pytest.mark.parametrize("version", PYTHONS[1:])
def test_all_pythons_give_the_same_numbers(version: str, place: Path, home: Home) -> None:
    first, other = (answers(v, place, home) for v in (PYTHONS[0] if interpreter(PYTHONS[0]) else "3.9", version))
    for step, a, b in zip(chain(version), first, other, strict=True):
        for name, value in a["outputs"].items():
            same = alike(value, b["outputs"][name]) if step["name"] == "Engine" else value == b["outputs"][name]
            assert name in LOOSE or same, (step["name"], name)


@pytest.mark.thinned
@pytest.mark.parametrize("version", PYTHONS)
def test_with_nothing_connected_there_is_at_most_one_sentence(version: str, tmp_path: Path) -> None:
    """No server either; nothing raises, and the sentence says what to connect."""
    steps = [step(version, name, {}, solutions=1) for name in NAMES if name != "Server"]
    for one, answer in zip(steps, ask(version, {"steps": steps}, tmp_path / "alone", None), strict=True):
        said = [text for _, text in answer["messages"]]
        needed = [name for name in one["inputs"] if name.startswith("_") and not name.endswith("_")]
        assert len(said) == bool(needed), (one["name"], said)
        assert all(text.endswith(".") and ("connect" in text or "missing" in text) for text in said), (
            one["name"],
            said,
        )


def test_every_component_has_a_sample() -> None:
    assert [
        name for name in NAMES if name not in {*SAMPLES, "Design", "Engine", "LoadCases", "Moments", "Stream", "Sweep"}
    ] == []
