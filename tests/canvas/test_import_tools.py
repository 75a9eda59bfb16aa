"""Tools of Kangaroo that are translated: inputs and outputs of every one, in both generations, as files name them."""

from __future__ import annotations

from typing import Any

import pytest

from canvas.kangaroo_samples import Kangaroo
from canvas.test_import import behind, the, translated
from hookean_canvas.archive.guids import PYTHON3_SCRIPT
from hookean_canvas.archive.parts import outputs, parts
from hookean_canvas.kangaroo.ids import COMPONENTS
from hookean_canvas.kangaroo.make import recipe
from hookean_canvas.kangaroo.table import CLASSIC, SECOND
from hookean_canvas.kangaroo.tools import CLASSIC as CLASSIC_TOOLS
from hookean_canvas.kangaroo.tools import SECOND as SECOND_TOOLS

MESH = (("Mesh", None),)
LEVEL = (("Mesh", None), ("Level", 3))
POINTS = (("points", None), ("tolerance", 0.01))
FOLD = tuple((f"P{i}", None) for i in (1, 2, 3, 4))
MACHINE = (("Geometry", None), ("Length", 2.5), ("FixCurves", None), ("FixVertices", None), ("Flip", 1),
           ("PullStrength", 0.8), ("CurvatureAdaptivity", 0.0), ("BoundaryScale", 1.0), ("BoundaryDistance", 5.0),
           ("SizePoints", None), ("SizeValues", None), ("Exponent", 2), ("Background", 0.5), ("Iterations", 1),
           ("Reset", True))  # fmt: skip
MULTIPIPE = (("Curves", None), ("NodeSize", None), ("SizePoints", None), ("EndOffset", 1.0), ("StrutSize", 1.0),
             ("Segment", 0.0), ("KinkAngle", 0.6), ("CubeFit", 0.0), ("Caps", 1))  # fmt: skip
BOTH = {
    "removeDuplicatePts": (POINTS, ("unique points",), "RemoveDuplicatePoints", {"points": "points"}, ["points"]),
    "Combine&Clean": ((("Meshes", None),), ("Mesh",), "CombineClean", {"meshes": "meshes"}, ["mesh"]),
    "HingePoints": (MESH, ("1", "2", "3", "4"), "HingePoints", {"mesh": "mesh"}, ["start", "end", "tip_1", "tip_2"]),
    "Refine": (LEVEL, ("Mesh",), "Refine", {"mesh": "mesh"}, ["mesh"]),
    "FoldAngle": (FOLD, ("Angle",), "FoldAngle", {"p1": "start", "p4": "tip_2"}, ["angle"]),
}
FIRST = {
    "RefineStrips": (LEVEL, ("Mesh",), "RefineStrips", {"mesh": "mesh"}, ["mesh"]),
    "MeshMachine": (MACHINE, ("Mesh",), "Remesh", {"geometry": "mesh"}, ["mesh"]),
    "Counter": ((("Reset", False),), ("t",), "Counter", {"reset": "reset"}, ["count"]),
    "Sequence": ((("Frames", 20),), ("S",), "Sequence", {"frames": "frames"}, ["reset"]),
    "Trail": ((("Points", None), ("Reset", None), ("Record", None)), ("Trail",), "Trail", {"points": "points"},
              ["trail"]),
}  # fmt: skip
LATER = {
    "MeshCorners": ((("Mesh", None), ("Angle", 2.356194490192345)), ("Corners",), "MeshCorners", {"mesh": "mesh"},
                    ["corners"]),
    "Diagonalize": (MESH, ("DiagonalMesh",), "Diagonalize", {"mesh": "mesh"}, ["mesh"]),
    "Checkerboard": (MESH, ("A",), "Checkerboard", {"mesh": "mesh"}, ["pattern"]),
    "SimpleRemesh": ((("Geometry", None), ("Length", None), ("Creases", None), ("Corners", None), ("Steps", 50)),
                     ("Mesh",), "Remesh", {"geometry": "mesh", "length": "length"}, ["mesh"]),
    "TriRemesh": ((("Geometry", None), ("Target", None), ("Sharp", None), ("Features", None), ("Length", 1.0),
                   ("Iterations", 25)), ("Triangulation",), "Remesh", {"geometry": "mesh"}, ["mesh"]),
    "SplitAtCorners": ((("Poly", None), ("Angle", 1.0)), ("Corners", "Parts"), "SplitAtCorners",
                       {"poly": "polyline"}, ["corners", "parts"]),
    "MeshMap": ((("SourceMesh", None), ("TargetMesh", None), ("Point", None), ("Distance", 1.0)), ("Point",),
                "MeshMap", {"sourcemesh": "source", "targetmesh": "target", "point": "point"}, ["points"]),
    "MeshDirection": (MESH, ("Mesh",), "AlignQuads", {"mesh": "mesh"}, ["mesh"]),
    "MeshTurn": (MESH, ("Mesh",), "TurnQuads", {"mesh": "mesh"}, ["mesh"]),
    "MultiPipe": (MULTIPIPE, ("Pipe",), "Pipes", {"curves": "lines", "nodesize": "radius"}, ["mesh"]),
}  # fmt: skip
CASES = [(True, name, *case) for name, case in {**BOTH, **FIRST}.items()]
CASES += [(False, name, *case) for name, case in {**BOTH, **LATER}.items()]


@pytest.mark.parametrize(("classic", "name", "inputs", "results", "bundle", "wired", "ours"), CASES)
def test_a_tool_is_swapped_with_its_wires(
    classic: bool, name: str, inputs: Any, results: Any, bundle: str, wired: dict[str, str], ours: list[str]
) -> None:
    """Each wire in arrives at the input with the same meaning, each wire out starts at the output with it."""
    d = Kangaroo("tool", "Tool", name)
    given = {key: d.parameter("Data", key) for key in wired}
    made = d.kangaroo(name, inputs, results, classic=classic, **given)
    after, report = translated(d)
    assert report.complete, report.text()
    [found] = [part for part in parts(after) if part.guid == PYTHON3_SCRIPT]
    assert found.container is not None and found.container.value("Name") == recipe(bundle).name
    for key, input_ in wired.items():
        assert [part.label for part in behind(after, found, input_)] == [key]
    places = [place for place, _ in made.outputs.values()]
    titles = {port.value("InstanceGuid"): port.value("Name") for port in outputs(found.container)}
    assert [titles[place] for place in places] == ours


def test_corners_of_an_import_come_along_the_boundary() -> None:
    """A panel says so, as lists that go with the corners follow the boundary."""
    d = Kangaroo("corners", "Corners", "MeshCorners.")
    d.kangaroo("MeshCorners", (("Mesh", None), ("Angle", 2.0)), ["Corners"], mesh=d.parameter("Mesh", "Given"))
    after, _ = translated(d)
    told = [behind(after, the(after, "Corners"), name) for name in ("order", "angle")]
    assert [part.container.value("UserText") for (part,) in told if part.container] == ["boundary", "2"]


def test_what_is_typed_into_a_tool_is_kept_or_listed() -> None:
    """A level of 3 becomes a panel; a curvature adaptivity other than 0 is listed, the usual values are not."""
    d = Kangaroo("typed", "Typed", "Refine and MeshMachine.")
    mesh = d.parameter("Mesh", "Given")
    d.kangaroo("Refine", LEVEL, ["Mesh"], classic=True, mesh=mesh)
    machine = tuple((key, 0.5 if key == "CurvatureAdaptivity" else value) for key, value in MACHINE)
    d.kangaroo("MeshMachine", machine, ["Mesh"], classic=True, geometry=mesh)
    after, report = translated(d)
    held = {
        label: [part.container.value("UserText") for part in behind(after, the(after, label), name) if part.container]
        for label, name in (("Refine", "level"), ("Remesh", "length"))
    }
    assert held == {"Refine": ["3"], "Remesh": ["2.5"]}
    assert [where for where, _ in report.values] == ["MeshMachine, CurvatureAdaptivity = 0.5"]


@pytest.mark.parametrize(("table", "whole"), [(CLASSIC_TOOLS, CLASSIC), (SECOND_TOOLS, SECOND)])
def test_every_entry_names_inputs_and_outputs_of_its_component(table: Any, whole: Any) -> None:
    for name, swap in table.items():
        assert whole[name] is swap
        for piece in swap.pieces:
            known = recipe(piece.bundle)
            assert set(piece.inputs.values()) <= {slot.name.strip("_") for slot in known.inputs}, name
            assert set(piece.outputs) <= {slot.name for slot in known.outputs}, name
            needed = {slot.name[1:] for slot in known.inputs if slot.name[0] == "_" and slot.name[-1] != "_"}
            assert needed <= set(piece.inputs.values()), name


def test_the_tools_of_the_table_are_components_of_kangaroo() -> None:
    known = {(one.generation, one.name.lower().replace(" ", "")) for one in COMPONENTS.values()}
    for classic, name, *_ in CASES:
        assert ("classic" if classic else "second", name.lower().replace(" ", "")) in known
