"""What a person sets on inputs and objects: parameters from 0 to 1, degrees, disabled objects; points of Rhino."""

from __future__ import annotations

from pathlib import Path
from typing import Any
from uuid import UUID

import pytest

from canvas.kangaroo_samples import Kangaroo
from canvas.native_values import near, plain
from canvas.test_references import rails, shown
from hookean.errors import InputError
from hookean_canvas.archive import Chunk, Type
from hookean_canvas.archive.parts import inputs, outputs, parts
from hookean_canvas.definitions.write import Definition
from hookean_canvas.run import graph
from hookean_canvas.run.evaluate import Canvas
from hookean_canvas.run.natives.kinds import over_unit_domain
from hookean_canvas.run.rhino import rhino3dm
from hookean_canvas.run.stored import Unread, stored
from hookean_canvas.run.unsupported import require_known


def found(d: Definition, panel: str) -> list[Any]:
    return [plain(v) for v in Canvas(graph.of(d.archive())).run(20.0).panels[panel].values_in_order()]


@pytest.mark.parametrize("where", ["input", "output", "parameter"])
def test_a_curve_that_is_reparameterized_has_its_middle_at_a_half(where: str) -> None:
    """A line of length 4 has parameters from 0 to 4, so that 0.5 is at 0.5; from 0 to 1 it is in the middle, at 2."""
    d = Definition("unit", "Unit", "A line, evaluated at a half.")
    line = d.native("Line", start_point=d.point(0, 0, 0), end_point=d.point(4, 0, 0))
    passed = d.parameter("Curve", "Crv", source=line)
    held = d.native("Evaluate Curve", curve=passed, parameter=d.slider("t", 0.5, 0, 1, 2))
    d.panel("at", held["Point"])
    before = found(d, "at")
    flagged = {"input": inputs(held.container)[0], "output": outputs(line.container)[0], "parameter": passed.container}
    flagged[where].put("Reparameterize", Type.BOOL, True)
    assert near([before, found(d, "at")], [[(0.5, 0, 0)], [(2, 0, 0)]])


def test_surfaces_and_breps_of_one_face_get_parameters_from_0_to_1_too() -> None:
    ball = rhino3dm.NurbsSurface.CreateFromSphere(rhino3dm.Sphere(rhino3dm.Point3d(0, 0, 0), 2.0))
    for given in (ball, rhino3dm.Brep.CreateFromSurface(ball)):
        made = over_unit_domain(given)
        assert [(made.Domain(i).T0, made.Domain(i).T1) for i in (0, 1)] == [(0, 1), (0, 1)]
    assert ball.Domain(0).T1 != 1.0  # the surface itself is left as it was
    assert over_unit_domain(3.0) == 3.0 and over_unit_domain(None) is None


def test_an_angle_in_degrees_turns_by_degrees() -> None:
    d = Definition("degrees", "Degrees", "A point turned by 90 degrees about z.")
    turned = d.native("Rotate", geometry=d.point(1, 0, 0), angle=d.slider("A", 90, 0, 360),
                      plane=d.native("XY Plane", origin=d.point(0, 0, 0)))  # fmt: skip
    d.panel("at", turned["Geometry"])
    inputs(turned.container)[1].put("UseDegrees", Type.BOOL, True)
    assert near(found(d, "at"), [(0, 1, 0)])


def referred(kind: str, one: UUID) -> Chunk:
    """A point that refers to a Rhino file, as Grasshopper 1.0.8 stores it: all of it in a chunk of its own."""
    item = Chunk("Item", 0)
    item.add("ReferenceData").put("RefID", Type.GUID, one).put("RefType", Type.STRING, kind)
    return item


@pytest.mark.parametrize("where", ["parameter", "input"])
def test_an_expression_gets_a_panel_s_text_as_the_kind_of_its_input(where: str) -> None:
    """Grasshopper casts what comes in to the kind of the input first: x * 2 of the text 25 is 50 for a number."""
    d = Definition("text", "Text", "A number written in a panel, with an expression on what takes it.")
    if where == "parameter":
        taking = d.parameter("Number", "Num", source=d.text("K", "25"))
        port = taking.container
    else:
        taking = d.native("Series", start=d.text("K", "25"), step=1, count=1)
        port = inputs(taking.container)[0]
    port.put("InternalExpression", Type.STRING, "x * 2")
    d.panel("at", taking)
    assert near(found(d, "at"), [50])


def test_points_that_refer_to_a_rhino_file_are_taken_from_it(tmp_path: Path) -> None:
    file, ids = rails(tmp_path)
    held = stored(referred("point_object", ids[2]))
    assert isinstance(held, Unread) and held.reference == ids[2]
    d = Definition("points", "Points", "A point of a Rhino file.")
    held_at = d.parameter("Point", "Pt")
    data = held_at.container.add("PersistentData").put("Count", Type.INT32, 1)
    branch = data.add("Branch", 0).put("Count", Type.INT32, 1).put("Path", Type.STRING, "{0}")
    branch.chunks.append(referred("point_object", ids[2]))
    d.panel("found", held_at)
    target = tmp_path / "points.ghx"
    d.save(target)
    assert near([plain(v) for v in shown(target, file)], [(1, 2, 3)])


def test_a_place_on_an_object_of_a_rhino_file_is_named_and_not_taken_for_the_object() -> None:
    held = stored(referred("curve_parameter", UUID(int=7)))
    assert isinstance(held, Unread) and held.reference is None
    assert held.why == "it refers to a place on an object of a Rhino file; internalise it in Grasshopper"


def test_what_an_engine_only_carries_along_may_be_left_out() -> None:
    for port in ("geometry", "forces"):
        d = Kangaroo(f"carried {port}", "Carried", "Geometry of a plug-in.")
        strange = d.foreign("Strange Mesh")
        d.component("Engine", **{port: strange})
        read = graph.of(d.archive())
        if port == "geometry":
            assert list(require_known(read)) == [strange.id]
        else:
            with pytest.raises(InputError, match="1 x Strange Mesh"):
                require_known(read)


def test_disabled_objects_are_not_needed_nor_is_what_feeds_them() -> None:
    d = Kangaroo("disabled", "Disabled", "An object of a plug-in that is disabled, and one that feeds a disabled one.")
    d.foreign("Strange Mesh").container.put("Locked", Type.BOOL, True)
    d.native("Length", curve=d.native("Line", start_point=d.point(0, 0, 0), end_point=d.point(1, 0, 0)))
    assert require_known(graph.of(d.archive())) == {}


def test_what_rhino_8_lists_under_no_library_is_grasshoppers_own() -> None:
    d = Kangaroo("own", "Own", "A native with the library that Rhino 8 writes for its own objects.")
    d.panel("found", d.native("Negative", value=d.slider("x", 3, 0, 9)))
    root = d.archive()
    chunk = next(part.chunk for part in parts(root) if part.name == "Negative")
    chunk.put("Lib", Type.GUID, UUID(int=0)).put("GUID", Type.GUID, UUID(int=7))
    (node,) = (node for node in graph.of(root).nodes if node.name == "Negative")
    assert not node.plugin and node.library == ""
    assert Canvas(graph.of(root)).run(20.0).panels["found"].values_in_order() == [-3.0]


@pytest.mark.parametrize(("engine", "level"), [(True, "warning"), (False, "error")])
def test_a_stand_in_that_fails_is_an_error_only_where_an_engine_or_no_engine_needs_it(engine: bool, level: str) -> None:
    """What only draws beside a form keeps no form from being found."""
    d = Kangaroo("beside", "Beside", "A number divided by zero.")
    d.native("Division", a=d.slider("A", 1, 0, 9), b=d.slider("B", 0, 0, 9))
    if engine:
        d.component("Engine")
    messages = Canvas(graph.of(d.archive())).run(20.0).messages
    assert [m.level for m in messages if m.text == "Division by zero"] == [level]


def test_what_only_draws_is_evaluated_once_after_the_last_solution(monkeypatch: pytest.MonkeyPatch) -> None:
    """A toggle that resets makes two solutions; what a script takes is needed in both, what is behind it is not."""
    d = Kangaroo("late", "Late", "A sum into an Engine, and one that nothing takes.")
    reset = d.toggle("Reset", False)
    taken = d.native("Addition", a=reset, b=d.slider("B", 1, 0, 9))
    d.component("Engine", reset=reset, forces=taken)
    d.panel("shown", d.native("Addition", a=taken, b=d.slider("C", 2, 0, 9)))
    canvas, counted = Canvas(graph.of(d.archive())), []
    evaluate = canvas._evaluate
    monkeypatch.setattr(canvas, "_evaluate", lambda node: (counted.append(node.label), evaluate(node)))
    outcome = canvas.run(20.0)
    assert counted.count("A+B") == 3 and counted.count("shown") == 1, counted
    assert outcome.panels["shown"].values_in_order() == [3.0]


def test_an_option_that_a_stand_in_does_not_look_at_is_warned_of() -> None:
    """Options of a component's menu are numbers and switches in its container: one that is chosen is named, unless
    it is as in a new component, concerns only how it looks, or is one that the stand-in follows."""
    d = Definition("menu", "Menu", "Options of components.")
    box = d.native("Bounding Box", content=d.point(0, 0, 0))
    crossed = d.native("Cross Reference")
    options = ((box, "UnionBox", True), (box, "Hidden", True), (box, "Other", 0), (crossed, "CrossMode", 6))
    for made, name, value in options:
        made.container.put(name, Type.BOOL if isinstance(value, bool) else Type.INT32, value)
    messages = Canvas(graph.of(d.archive())).run(20.0).messages
    assert [(m.level, m.text) for m in messages if "option" in m.text] == [
        ("warning", "its option UnionBox = True is not taken into account")
    ]
