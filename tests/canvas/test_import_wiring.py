"""Wirings as people leave them: expressions on inputs, no reset, solvers on pause, objects that cannot run."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any
from uuid import UUID

import numpy as np
import pytest

from canvas.kangaroo_samples import ANCHOR, LENGTH, SOLVER, Kangaroo, star, wires
from canvas.test_import_run import SOFT, places, ran
from hookean.errors import InputError
from hookean_canvas.archive import Type
from hookean_canvas.archive.guids import BOOLEAN_TOGGLE
from hookean_canvas.archive.parts import parts
from hookean_canvas.kangaroo import translate as kangaroo
from hookean_canvas.kangaroo.bodies import SOLIDS
from hookean_canvas.run import graph
from hookean_canvas.run.evaluate import Canvas

pytestmark = pytest.mark.usefixtures("home")

INDEXED = UUID("b476d3d0-4daf-489c-b91a-49f5dd72a256")
ZOMBIE = (("GoalObjects", None), ("Threshold", 1e-10), ("Tolerance", 0.01), ("MaxIterations", 50000))


def hung(d: Kangaroo, strength: float = 100.0, **typed: Any) -> tuple[list[Any], Any]:
    """Goals of a weight of 10 between two springs of the given strength, 1 long, and the lines of the springs."""
    middle = d.point(0, 0, 0)
    ends = [d.point(-1, 0, 0), d.point(1, 0, 0)]
    lines = [d.native("Line", start_point=middle, end_point=end) for end in ends]
    length = [(name, typed.get(name, strength if name == "Strength" else value)) for name, value in LENGTH]
    springs = d.kangaroo("Length(Line)", length, ["S"], line=lines)
    load = d.kangaroo("Load", (("P", None), ("FV", (0.0, 0.0, -10.0))), ["U"], p=middle)
    return [springs, load, d.kangaroo("Anchor", ANCHOR, ["A"], guid=SOFT, p=ends)], lines


def sag(rest: float, strength: float) -> float:
    """How far the weight goes down: 2 k (l - rest) s / l = 10 with l^2 = 1 + s^2, by bisection."""
    low, high = 0.0, 100.0
    for _ in range(200):
        s = 0.5 * (low + high)
        length = math.hypot(1.0, s)
        low, high = (s, high) if 2.0 * strength * (length - rest) * s / length < 10.0 else (low, s)
    return low


def expected(rest: float = 1.0, strength: float = 100.0) -> float:
    return -sag(rest, strength)


def test_a_typed_and_a_wired_expression_on_an_input_act_as_in_grasshopper(tmp_path: Path) -> None:
    """A strength of 5 with x * 20 on the input is 100; a length of 2 from a slider with x / 4 is 0.5."""
    d = Kangaroo("expressed", "Expressed", "Expressions on inputs.")
    goals, _ = hung(d, strength=5.0)
    springs = goals[0]
    d._wire(springs, "length", d.slider("Length", 2, 1, 9))
    springs.inputs["strength"][1].put("InternalExpression", Type.STRING, "x * 20")
    springs.inputs["length"][1].put("InternalExpression", Type.STRING, "x / 4")
    solver = d.solved(*goals, reset=d.toggle("Reset", False))
    d.panel("particles", solver["V"])
    before = d.archive()
    after, report = kangaroo.translate(before, "expressed.gh")
    assert report.complete and report.kept == report.wires and wires(before) <= wires(after)
    found = places(ran(d, tmp_path))
    # anchors of 10,000 give way by T / 10,000 < 0.01 at both ends
    assert min(found[:, 2]) == pytest.approx(expected(0.5, 100.0), abs=0.02)


@pytest.mark.parametrize("zombie", [True, False])
def test_a_solver_whose_reset_is_not_wired_runs_at_once(zombie: bool, tmp_path: Path) -> None:
    """The ZombieSolver has no Reset; that of the Solver is False where nothing is connected."""
    d = Kangaroo("unwired", "Unwired", "No reset.")
    goals, _ = hung(d)
    if zombie:
        solver = d.kangaroo("ZombieSolver", ZOMBIE, ["I", "V", "O"], goalobjects=goals)
    else:
        given = [(name, None if name == "Reset" else value) for name, value in SOLVER]
        solver = d.kangaroo("Solver", given, ["I", "V", "O"], goalobjects=goals)
    d.panel("particles", solver["V"])
    assert min(places(ran(d, tmp_path))[:, 2]) == pytest.approx(expected(), abs=0.02)


@pytest.mark.parametrize("paused", [True, False])
def test_a_file_saved_paused_is_switched_on_to_run_unless_it_is_set(paused: bool, tmp_path: Path) -> None:
    d = Kangaroo("paused", "Paused", "Saved paused.")
    goals, _ = hung(d)
    solver = d.solved(*goals, reset=d.toggle("Reset", False), on=d.toggle("On", False))
    d.panel("particles", solver["V"])
    root, _ = kangaroo.translate(d.archive(), "paused.gh")
    toggles = {p.label: p.container for p in parts(root) if p.guid == BOOLEAN_TOGGLE}
    assert toggles["On"] is not None and toggles["On"].value("ToggleValue") is False
    found = graph.of(root)
    found.file = tmp_path / "paused.ghx"
    outcome = Canvas(found, {"On": "False"} if paused else None).run(60.0)
    assert min(places(outcome)[:, 2]) == (0.0 if paused else pytest.approx(expected(), abs=0.02))


def test_what_no_engine_needs_is_left_out_and_named(tmp_path: Path) -> None:
    """A plug-in's component that takes the shape; two panels without names."""
    d = Kangaroo("after", "After", "A plug-in after the solver.")
    goals, _ = hung(d)
    solver = d.solved(*goals, reset=d.toggle("Reset", False))
    shown = d.foreign("Analyse", ["In"], **{"in": solver["V"]})
    d.panel("", solver["V"])
    d.panel("", shown)
    root, report = kangaroo.translate(d.archive(), "after.gh")
    assert report.complete
    found = graph.of(root)
    found.file = tmp_path / "after.ghx"
    outcome = Canvas(found).run(60.0)
    told = [m.text for m in outcome.messages if m.component == "Analyse"]
    assert [one.split(" after ")[0] for one in outcome.engines] == ["Engine: In equilibrium"]
    assert outcome.at_rest and len(told) == 1 and told[0].startswith("left out, as no Engine needs it: ")
    assert list(outcome.panels) == ["Panel", "Panel (2)"] and not outcome.panels["Panel (2)"]
    assert min(places(outcome, "Panel")[:, 2]) == pytest.approx(expected(), abs=0.02)


def test_what_an_engine_needs_is_refused_where_it_cannot_run() -> None:
    d = Kangaroo("before", "Before", "A plug-in before the solver.")
    goals, _ = hung(d)
    d._wire(goals[0], "strength", d.foreign("Stiffness"))
    d.panel("particles", d.solved(*goals, reset=d.toggle("Reset", False))["V"])
    root, _ = kangaroo.translate(d.archive(), "before.gh")
    with pytest.raises(InputError, match=r"nothing was run; .* 1 x Stiffness: .* has no stand-in"):
        Canvas(graph.of(root))


def test_points_of_a_solver_go_to_the_anchors_that_pick_from_them() -> None:
    d = Kangaroo("picked", "Picked", "Anchors by index.")
    goals, lines = hung(d)
    index = (("Point", None), ("Index", 1), ("Strength", 1000.0))
    goals[2] = d.kangaroo("Anchor", index, ["A"], guid=INDEXED)
    given = [*SOLVER, ("Points", None), ("Restart", False), ("AddCurrent", False)]
    points = d.native("End Points", curve=lines)["End"]
    solver = d.kangaroo("Solver", given, ["V", "O"], goalobjects=goals, points=points)
    d.panel("particles", solver["V"])
    before = d.archive()
    after, report = kangaroo.translate(before, "picked.gh")
    assert report.complete and wires(before) <= wires(after)


@pytest.mark.parametrize(
    ("name", "inputs", "guid"),
    [
        ("SoapFilm", (("Mesh", None), ("Strength", 1.0)), "76ab889c-8593-4892-861d-a80b5311a981"),
        ("SoapFilm", (("M", None), ("Strength", 1.0)), "76ab889c-8593-4892-861d-a80b5311a981"),
        (
            "AnchorXYZ",
            (("Point", None), ("X", True), ("Y", True), ("Z", False), ("Strength", 1000.0)),
            "2128cde3-9694-40b0-874c-670c89341acd",
        ),
    ],
)
def test_inputs_are_known_by_their_long_and_their_short_names(name: str, inputs: Any, guid: str) -> None:
    """Names as the table of components found in public definitions has them."""
    d = Kangaroo("named", "Named", "A goal by its names.")
    first = inputs[0][0]
    data = d.parameter("Mesh" if first.startswith("M") else "Point", "Data")
    d.panel("particles", d.solved(d.kangaroo(name, inputs, ["S"], guid=UUID(guid), **{first.lower(): data}))["V"])
    _, report = kangaroo.translate(d.archive(), "named.gh")
    assert report.complete, report.text()


def test_the_corners_of_a_part_are_particles_of_its_body(tmp_path: Path) -> None:
    """A cube and a further point: where a face is turned by 90 degrees and held, all the rest follows, with the middle
    of the cube, where its frame is if none is given."""
    d = Kangaroo("bodies", "Bodies", "A rigid part.")
    plane = d.native("XY Plane", origin=d.point(0, 0, 0))
    middle = d.native("Center Box", base=plane, x=0.5, y=0.5, z=0.5)
    cube = d.native("Mesh Box", base=middle, x_count=1, y_count=1, z_count=1)
    box = d.kangaroo(
        "RigidBody", (("Part", None), ("Points", None), ("Strength", 1.0)), ["RigidBody"],
        guid=UUID("559ec10e-2671-4bba-b5a7-11816e8fb17b"), part=cube, points=d.point(2, 0, 0),
    )  # fmt: skip
    held = [(-0.5, -0.5, -0.5), (-0.5, 0.5, -0.5), (0.5, 0.5, -0.5), (0.5, -0.5, -0.5)]
    turned = [(-y, x, z) for x, y, z in held]
    anchors = d.kangaroo(
        "Anchor", ANCHOR, ["A"], guid=SOFT, p=[d.point(*p) for p in held], t=[d.point(*p) for p in turned]
    )
    solver = d.solved(box, anchors, reset=d.toggle("Reset", False))
    d.panel("particles", solver["V"])
    found = np.unique(places(ran(d, tmp_path)).round(6), axis=0)
    every = [(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)]
    every += [(0.0, 2.0, 0.0), (0.0, 0.0, 0.0)]
    far = [min(np.linalg.norm(found - place, axis=1)) for place in np.array(every)]
    assert max(far) < 1e-3 and len(found) == 10, found


def test_a_body_of_a_brep_carries_its_part_and_the_origin_of_its_frame(tmp_path: Path) -> None:
    """A cube of 2 that falls on a plane by 4 N at its middle, where a frame is: each of 4 corners of k = 5 sinks in by
    1 / 5. The planes come out as they went in."""
    d = Kangaroo("brep body", "Brep body", "A box on a plane.")
    middle = d.point(0, 0, 3)
    frame, ground = d.native("XY Plane", origin=middle), d.native("XY Plane", origin=d.point(0, 0, 0))
    box = d.native("Center Box", base=frame, x=1, y=1, z=1)["Box"]
    part = (("Part", None), ("Plane", None), ("Points", None), ("Strength", 1e5))
    body = d.kangaroo(
        "RigidBody", part, ["RigidBody", "Planes"], guid=UUID("e245de5b-6d3b-48d3-8092-3bf0202ebf8f"), part=box,
        plane=frame,
    )  # fmt: skip
    typed = (("Solid", None), ("SolidPlane", None), ("CollisionPlane", None), ("Strength", 5.0))
    rests = d.kangaroo(
        "SolidPlaneCollide", typed, ["SolidPlaneCollide"], solid=box, solidplane=frame, collisionplane=ground
    )
    load = d.kangaroo("Load", (("P", None), ("FV", (0.0, 0.0, -4.0))), ["U"], p=middle)
    solver = d.solved(body["RigidBody"], rests, load, reset=d.toggle("Reset", False))
    d.panel("particles", solver["V"])
    d.panel("shown", solver["O"])
    d.panel("planes", body["Planes"])
    _, report = kangaroo.translate(d.archive(), "body.gh")
    assert report.complete and report.wires == report.kept
    outcome = ran(d, tmp_path)
    found = np.unique(places(outcome).round(4), axis=0)
    every = [(x, y, z) for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-0.2, 1.8)] + [(0.0, 0.0, 0.8)]
    np.testing.assert_allclose(found, sorted(every), atol=1e-3)
    [shown] = outcome.panels["shown"].values_in_order()
    corners = np.array([[v.X, v.Y, v.Z] for v in shown.Vertices])
    np.testing.assert_allclose([corners[:, 2].min(), corners[:, 2].max()], [-0.2, 1.8], atol=1e-3)
    assert [p.Origin.Z for p in outcome.panels["planes"].values_in_order()] == [3.0]


def test_corners_of_solids_are_where_three_faces_meet() -> None:
    """A block of quads and triangles has its 8 corners, whatever is on its faces and edges; a net of one face all."""
    scope: dict[str, Any] = {}
    start = SOLIDS.index("def corners_of")
    exec(SOLIDS[start : SOLIDS.index("points, numbers")], scope)
    vertices, faces = [], []
    for axis in range(3):
        for far in (0.0, 3.0):
            first = len(vertices)
            for i in range(4):
                for j in range(4):
                    place = [float(i), float(j)]
                    place.insert(axis, far)
                    vertices.append(place)
            for i in range(3):
                for j in range(3):
                    a = first + 4 * i + j
                    quad = [a, a + 1, a + 5, a + 4]
                    faces += [quad] if axis else [quad[:3], [quad[0], quad[2], quad[3]]]
    found = scope["corners_of"]({"vertices": vertices, "faces": faces})
    assert found == [[x, y, z] for x in (0.0, 3.0) for y in (0.0, 3.0) for z in (0.0, 3.0)]
    flat = {"vertices": vertices[:16], "faces": [[0, 1, 5, 4]]}
    assert scope["corners_of"](flat) == vertices[:16]


def test_a_file_that_is_not_translated_yet_says_what_to_do() -> None:
    with pytest.raises(InputError, match=r"1 x Solver: it is of Kangaroo2 Components; translate the file first, with"):
        Canvas(graph.of(star().archive()))


@pytest.mark.parametrize("by", ["component", "parameter", "list"])
def test_a_brep_at_an_input_for_meshes_becomes_a_mesh_as_in_grasshopper(by: str, tmp_path: Path) -> None:
    """A point at x = 3 is pulled onto a box of 2 around the origin, by its side at x = 2; the wire is kept."""
    d = Kangaroo(f"brep {by}", "Brep", "A point on a Brep.")
    box = d.native("Center Box", base=d.native("XY Plane", origin=d.point(0, 0, 0)), x=2, y=2, z=2)["Box"]
    if by == "parameter":
        box = d.parameter("Brep", "Solid", source=box)["out"]
    if by == "list":
        box = d.native(
            "Merge", data_1=d.native("Move", geometry=box, motion=d.native("Unit Z", factor=0.1))["Geometry"]
        )
    typed = (("Points", None), ("Mesh", None), ("Strength", 1.0))
    goal = d.kangaroo("OnMesh", typed, ["P"], points=d.point(3, 0.2, 0.1), mesh=box)
    d.panel("particles", d.solved(goal, reset=d.toggle("Reset", False))["V"])
    before = wires(d.archive())
    root, report = kangaroo.translate(d.archive())
    assert (report.lost, report.kept) == ([], len(before))
    names = [part.name for part in parts(root)]
    assert names.count("Mesh") == 1
    np.testing.assert_allclose(places(ran(d, tmp_path)), [[2.0, 0.2, 0.1]], atol=1e-6)


def test_a_mesh_at_an_input_for_meshes_goes_straight_in() -> None:
    d = Kangaroo("mesh", "Mesh", "A point on a mesh.")
    ball = d.native("Mesh Sphere", base=d.native("XY Plane", origin=d.point(0, 0, 0)), radius=2)
    typed = (("Points", None), ("Mesh", None), ("Strength", 1.0))
    d.solved(d.kangaroo("OnMesh", typed, ["P"], points=d.point(3, 0, 0), mesh=d.native("Graft Tree", tree=ball)))
    assert "Mesh" not in [part.name for part in parts(kangaroo.translate(d.archive())[0])]


def test_a_point_at_an_input_for_planes_is_the_horizontal_plane_through_it(tmp_path: Path) -> None:
    """Grasshopper's own conversion; the point at z = 3 comes to z = 1."""
    d = Kangaroo("plane", "Plane", "A plane by a point.")
    typed = (("Points", None), ("Plane", None), ("Strength", 1.0))
    goal = d.kangaroo("OnPlane", typed, ["P"], points=d.point(2, 5, 3), plane=d.point(0, 0, 1))
    d.panel("particles", d.solved(goal, reset=d.toggle("Reset", False))["V"])
    np.testing.assert_allclose(places(ran(d, tmp_path)), [[2.0, 5.0, 1.0]], atol=1e-6)
