"""Translated definitions run without Rhino, against a live server: the shapes that the originals have."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path
from typing import Any
from uuid import UUID

import numpy as np
import pytest

from canvas.kangaroo_samples import ANCHOR, LENGTH, SOLVER, Kangaroo, cable, star, tent
from hookean import Scene, relax
from hookean_canvas.archive import Type
from hookean_canvas.kangaroo import translate as kangaroo
from hookean_canvas.run import graph
from hookean_canvas.run.checking import Checked
from hookean_canvas.run.evaluate import Canvas, Outcome
from serving import HANG

pytestmark = pytest.mark.usefixtures("home")

SOFT = UUID("3c30b1a1-4473-4ad4-a700-ea9770726c03")
"""The Anchor with a target."""


def ran(d: Kangaroo, tmp_path: Path) -> Outcome:
    """A translation, run until it rests; no component may complain."""
    root, _ = kangaroo.translate(d.archive())
    found = graph.of(root)
    found.file = tmp_path / f"{d.key}.ghx"
    outcome = Canvas(found).run(HANG)
    assert [m for m in outcome.messages if m.level == "error"] == [], outcome.messages
    assert outcome.at_rest
    return outcome


def places(outcome: Outcome, panel: str = "particles") -> Any:
    """Points that a panel shows, in their order."""
    return np.array([[p.X, p.Y, p.Z] for p in outcome.panels[panel].values_in_order()])


def test_an_engine_that_is_paused_is_not_at_rest(tmp_path: Path) -> None:
    """Nothing is scheduled any more, and the load is out of balance: it is named by those who read the outcome."""
    root, _ = kangaroo.translate(tent().archive())
    found = graph.of(root)
    outcome = Canvas(found, {"On": "false"}).run(HANG)
    assert not outcome.at_rest and len(outcome.paused) == 1
    checked = Checked(tmp_path / "tent.ghx", outcome, [])
    assert checked.faults == [f"{outcome.paused[0]} It is paused; set its input on to True"]
    assert checked.as_json()["at_rest"] is False


def test_a_translated_classic_cable_hangs_as_the_same_scene_does(tmp_path: Path) -> None:
    x = np.arange(11.0)[:, None] * [1.0, 0.0, 0.0]
    scene = Scene.read(
        {
            "particles": x.tolist(),
            "forces": [
                {"kind": "springs", "particles": [[i, i + 1] for i in range(10)], "rest_length": 1.0},
                {"kind": "unary", "particles": list(range(1, 10)), "vector": [0, 0, -10]},
            ],
            "anchors": [{"particles": [0, 10]}],
            "settings": {"tolerance": 1e-9},
        }
    )
    expected = relax(scene).particles
    outcome = ran(cable(), tmp_path)
    np.testing.assert_allclose(places(outcome), expected, atol=1e-3)
    assert expected[5, 2] < -0.5
    assert len(outcome.panels["geometry"].values_in_order()) == 10


def test_a_translated_star_comes_to_the_point_that_kangaroo_2_is_published_with(tmp_path: Path) -> None:
    """github.com/oberbichler/kangaroo.py, example_01.json: Kangaroo 2's own answer."""
    expected = [
        [0.204663774296581, 0.709309307605647, 0.0],
        [-0.999574237567416, 0.999897261645, 0.0],
        [0.999523084414622, 0.00042533038873443, 0.0],
        [5.11531555739133e-05, 1.99967740797591, 0.0],
    ]
    outcome = ran(star(), tmp_path)
    np.testing.assert_allclose(places(outcome), expected, atol=2e-6)
    assert len(outcome.panels["shown"].values_in_order()) == 3  # nothing is shown, so the goals' lines are


def test_a_stream_of_goals_anchors_and_shown_lines_is_sorted_and_runs(tmp_path: Path) -> None:
    """Two springs of 1 m and 100 N/m with 10 N between them: 2 k (l - 1) sin = 10 with l = sqrt(1 + z^2)."""
    from scipy.optimize import brentq

    z = brentq(lambda z: 200.0 * (np.hypot(1, z) - 1) * z / np.hypot(1, z) - 10.0, 0.01, 2)
    outcome = ran(tent(), tmp_path)
    found = places(outcome)
    assert sorted(np.round(found[:, 2], 4).tolist()) == pytest.approx([0.0, 0.0, z], abs=1e-3)
    assert len(outcome.panels["shown"].values_in_order()) == 2


def test_a_rod_and_pairs_of_lines_bend_at_the_same_corners(tmp_path: Path) -> None:
    """A straight rod held by three soft anchors, its middle lifted: both ways to say it give one shape."""
    points = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (2.0, 0.0, 0.0)]
    shapes = []
    for rod in (True, False):
        d = Kangaroo(f"rod {rod}", "Rod", "A bent rod.")
        ends = [d.point(*p) for p in points]
        lines = [d.native("Line", start_point=a, end_point=b) for a, b in pairwise(ends)]
        goals = []
        if rod:
            polyline = d.script(
                "Polyline",
                "import Rhino.Geometry as rg\nc = rg.Polyline(3)\nfor p in points: c.Add(p.X, p.Y, p.Z)\n",
                {"points": ends},
                ["c"],
                lists=["points"],
            )
            typed = (
                ("Polyline", None),
                ("LengthFactor", 1.0),
                ("AngleFactor", 1.0),
                ("AxialStrength", 50.0),
                ("BendStrength", 4.0),
            )
            goals.append(d.kangaroo("Rod", typed, ["R"], polyline=polyline))
        else:
            springs = (("Line", None), ("Length", None), ("Strength", 50.0))
            goals.append(d.kangaroo("Length(Line)", springs, ["S"], line=lines))
            typed = (("LineA", None), ("LineB", None), ("RestAngle", None), ("Strength", 4.0))
            goals.append(d.kangaroo("Angle", typed, ["A"], linea=lines[0], lineb=lines[1]))
        soft = tuple((n, 100.0 if n == "Strength" else v) for n, v in ANCHOR)
        goals.append(d.kangaroo("Anchor", soft, ["A"], guid=SOFT, p=[ends[0], ends[2]]))
        load = (("P", None), ("FV", (0.0, 0.0, 5.0)))
        goals.append(d.kangaroo("Load", load, ["U"], p=ends[1]))
        solver = d.kangaroo("Solver", SOLVER, ["I", "V", "O"], goalobjects=goals, reset=d.toggle("Reset", False))
        d.panel("particles", solver["V"])
        shapes.append(places(ran(d, tmp_path)))
    np.testing.assert_allclose(shapes[0], shapes[1], atol=1e-6)
    assert shapes[0][1, 2] > 0.1


def test_vertex_loads_and_lengths_between_points_act_where_kangaroo_has_them(tmp_path: Path) -> None:
    """A spring of 10 N/m between points, held above by a soft anchor of 10^4 N/m: 5 N stretch it by 0.5 m."""
    d = Kangaroo("points", "Points", "Length(Pts).")
    top, low = d.point(0, 0, 1), d.point(0, 0, 0)
    lengths = (("Start", None), ("End", None), ("Length", None), ("Strength", 10.0))
    goals = [
        d.kangaroo("Length(Pts)", lengths, ["S"], start=top, end=low),
        d.kangaroo("Anchor", ANCHOR, ["A"], guid=SOFT, p=top),
        d.kangaroo("Load", (("P", None), ("FV", (0.0, 0.0, -5.0))), ["U"], p=low),
    ]
    solver = d.kangaroo("Solver", SOLVER, ["I", "V", "O"], goalobjects=goals, reset=d.toggle("Reset", False))
    d.panel("particles", solver["V"])
    found = places(ran(d, tmp_path))
    np.testing.assert_allclose(found[:, 2], [1 - 5e-4, -0.5 - 5e-4], atol=1e-5)
    assert LENGTH[2][1] == 10.0


def test_goals_that_pull_with_half_of_their_strength_pull_so_here(tmp_path: Path) -> None:
    """A rope of 0.5 m that stretches by half of 20 N/m holds 5 N: it is 1 m long; the point at its end is joined to
    another by half of 100 N/m, which carries 2 N of it: they are 0.04 m apart."""
    d = Kangaroo("halves", "Halves", "ClampLength and Coincident.")
    top, low, other = d.point(0, 0, 1), d.point(0, 0, 0.4), d.point(0, 0, 0.3)
    clamp = (("Line", None), ("LowerLimit", 0.0), ("UpperLimit", 0.5), ("Strength", 20.0))
    load = (("P", None), ("FV", (0.0, 0.0, -3.0)))
    goals = [
        d.kangaroo("ClampLength", clamp, ["Clamp"], line=d.native("Line", start_point=top, end_point=low)),
        d.kangaroo("Coincident", (("Point0", None), ("Point1", None), ("Strength", 100.0)), ["Coincident"],
                   point0=low, point1=other),
        d.kangaroo("Anchor", ANCHOR, ["A"], guid=SOFT, p=top),
        d.kangaroo("Load", load, ["U"], p=low),
        d.kangaroo("Load", (("P", None), ("FV", (0.0, 0.0, -2.0))), ["U"], p=other),
    ]  # fmt: skip
    solver = d.kangaroo("Solver", SOLVER, ["I", "V", "O"], goalobjects=goals, reset=d.toggle("Reset", False))
    d.panel("particles", solver["V"])
    found = np.sort(places(ran(d, tmp_path))[:, 2])
    np.testing.assert_allclose(np.diff(found), [0.04, 1.0], atol=1e-4)


MESHES = """
import math
import Rhino.Geometry as rg


def of(points, faces):
    mesh = rg.Mesh()
    for x, y, z in points:
        mesh.Vertices.Add(x, y, z)
    for face in faces:
        mesh.Faces.AddFace(*face)
    return mesh


rim = [(math.cos(i * math.pi / 3), math.sin(i * math.pi / 3), 0.0) for i in range(6)]
quad = [(5.0, 0.0, 0.0), (6.0, 0.0, 0.0), (6.0, 1.0, 0.5), (5.0, 1.0, 0.0)]
fan = of([(0.0, 0.0, 0.0)] + rim, [(0, 1 + i, 1 + (i + 1) % 6) for i in range(6)])
twisted = of(quad, [(0, 1, 2, 3)])
held = [rg.Point3d(*p) for p in rim + quad[:2] + quad[3:]]
"""


def test_goals_of_meshes_find_the_shapes_that_they_find_in_kangaroo(tmp_path: Path) -> None:
    """Smooth pulls with half of its strength: 3 N on the middle of a held ring, with 4 N/m, is 1.5 m below the mean.
    Planarize brings the fourth corner of a quad into the plane of the others, which are held."""
    d = Kangaroo("meshes", "Meshes", "Smooth and Planarize.")
    made = d.script("Meshes", MESHES, {}, ["fan", "twisted", "held"])
    fixed = (("P", None), ("X", True), ("Y", True), ("Z", True), ("Strength", 1000.0))
    goals = [
        d.kangaroo("Smooth", (("M", None), ("Strength", 4.0)), ["Smooth"], m=made["fan"]),
        d.kangaroo("Planarize", (("M", None), ("Strength", 10.0)), ["Planarize"], m=made["twisted"]),
        d.kangaroo("AnchorXYZ", fixed, ["A"], p=made["held"]),
        d.kangaroo("Load", (("P", None), ("FV", (0.0, 0.0, -3.0))), ["U"], p=d.point(0, 0, 0)),
    ]
    solver = d.kangaroo("Solver", SOLVER, ["I", "V", "O"], goalobjects=goals, reset=d.toggle("Reset", False))
    d.panel("particles", solver["V"])
    found = places(ran(d, tmp_path))
    np.testing.assert_allclose(found[np.abs(found[:, :2]).max(axis=1) < 0.1], [[0.0, 0.0, -1.5]], atol=1e-4)
    np.testing.assert_allclose(found[found[:, 0] > 4.5, 2], np.zeros(4), atol=1e-4)


def test_lines_with_a_radius_push_each_other_apart_by_half_of_the_strength(tmp_path: Path) -> None:
    """Two of radius 0.2 m cross 0.3 m apart, held at all ends by 10^4 N/m: o = 0.1 m - 2 F / (2 10^4 N/m) with F = o
    10^4 N/m, half of the strength: they are 0.35 m apart."""
    d = Kangaroo("capsules", "Capsules", "Collider.")
    ends = [d.point(-1, 0, 0), d.point(1, 0, 0), d.point(0, -1, 0.3), d.point(0, 1, 0.3)]
    lines = [d.native("Line", start_point=a, end_point=b) for a, b in (ends[:2], ends[2:])]
    typed = (("Objects", None), ("Radii", 0.2), ("IgnoreA", None), ("IgnoreB", None), ("Strength", 20000.0))
    goals = [
        d.kangaroo("Length(Line)", (("Line", None), ("Length", None), ("Strength", 50.0)), ["S"], line=lines),
        d.kangaroo("Collider", typed, ["Collider"], objects=lines),
        d.kangaroo("Anchor", ANCHOR, ["A"], guid=SOFT, p=ends),
    ]
    solver = d.kangaroo("Solver", SOLVER, ["I", "V", "O"], goalobjects=goals, reset=d.toggle("Reset", False))
    d.panel("particles", solver["V"])
    np.testing.assert_allclose(np.sort(places(ran(d, tmp_path))[:, 2]), [-0.025, -0.025, 0.325, 0.325], atol=1e-5)


def test_a_net_made_by_grasshoppers_own_components_comes_to_the_shape_of_the_same_scene(tmp_path: Path) -> None:
    """A mesh plane, its edges as springs of no length, its corners held, loads on its vertices: as files for Kangaroo
    have them, with the rectangle that Grasshopper stores in Mesh Plane."""
    d = Kangaroo("net", "Net", "A mesh plane that hangs from its corners.")
    mesh = d.native("Mesh Plane", width_count=4, height_count=4)
    stored = mesh.inputs["boundary"][1].add("PersistentData").put("Count", Type.INT32, 1)
    branch = stored.add("Branch", 0).put("Count", Type.INT32, 1).put("Path", Type.STRING, "{0}")
    rectangle = branch.add("Item", 0).put("Plane", Type.PLANE, (0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0))
    rectangle.put("Size", Type.INTERVAL2D, (-10.0, 10.0, -10.0, 10.0))
    edges = d.native("Mesh Edges", mesh=mesh["Mesh"])
    lines = d.native("Merge", data_1=[edges["Naked Edges"], edges["Interior Edges"]])
    vertices = d.native("Deconstruct Mesh", mesh=mesh["Mesh"])["Vertices"]
    corners = d.native("List Item", list=vertices, index=d.parameter("Integer", "Corners", [0, 4, 20, 24]), wrap=True)
    goals = [
        d.kangaroo("Length(Line)", (("Line", None), ("Length", 0.0), ("Strength", 10.0)), ["S"], line=lines),
        d.kangaroo("Anchor", ANCHOR, ["A"], guid=SOFT, p=corners),
        d.kangaroo("Load", (("P", None), ("FV", None)), ["U"], p=vertices, fv=d.native("Unit Z", factor=-2)),
    ]
    solver = d.kangaroo("Solver", SOLVER, ["I", "V", "O"], goalobjects=goals, reset=d.toggle("Reset", False))
    d.panel("particles", solver["V"])
    found = places(ran(d, tmp_path))
    x = np.array([[5.0 * i - 10, 5.0 * j - 10, 0.0] for j in range(5) for i in range(5)])
    rows = [[5 * j + i, 5 * j + i + 1] for j in range(5) for i in range(4)]
    rows += [[5 * j + i, 5 * j + i + 5] for j in range(4) for i in range(5)]
    scene = Scene.read(
        {
            "particles": x.tolist(),
            "forces": [
                {"kind": "springs", "particles": rows, "rest_length": 0.0, "stiffness": 10.0},
                {"kind": "unary", "particles": list(range(25)), "vector": [0, 0, -2]},
            ],
            "anchors": [{"particles": [0, 4, 20, 24]}],
            "settings": {"tolerance": 1e-9},
        }
    )
    expected = relax(scene).particles
    assert len(found) == 25 and expected[12, 2] < -0.5
    order = [np.lexsort(np.round(one[:, :2], 2).T) for one in (found, expected)]
    # anchors of 10^4 N/m yield under the pull of two springs and a load; nothing moves further, as the net is linear
    pull = 10.0 * (expected[1] + expected[5] - 2.0 * expected[0]) + [0, 0, -2]
    yielding = float(np.abs(pull).max()) / 1e4
    np.testing.assert_allclose(found[order[0]], expected[order[1]], atol=1.001 * yielding)


def test_a_beam_on_rigid_arms_bends_as_beam_theory_has_it(tmp_path: Path) -> None:
    """Frames 2 apart, nodes 0.5 outside of them, P at the outer node: w = P (8 / 3 + 1 + 1 / 2 (2 + 1)) / EI.

    EI = 1e5 and P = 1 give w / L = 2e-5, so what is not linear is below 1e-8 of it; the support, 1e9, below 1e-3.
    """
    d = Kangaroo("arms", "Arms", "A beam of Kangaroo 2.")
    frames = [d.native("YZ Plane", f"x{i}", origin=d.point(x, 0, 0)) for i, x in enumerate((0.0, 2.0, -0.5, 2.5))]
    stiff = (("E", 1000.0), ("A", 100.0), ("Ix", 100.0), ("Iy", 50.0), ("GJ", 1e5))
    places = [("StartFrame", None), ("EndFrame", None), ("StartNode", None), ("EndNode", None)]
    beam = d.kangaroo(
        "Beam", [*places, *stiff], ["Beam"], guid=UUID("3f8b0f83-6e8e-4a9d-b0ff-9474cc9eb89b"),
        startframe=frames[0], endframe=frames[1], startnode=frames[2], endnode=frames[3],
    )  # fmt: skip
    flags = [(name, True) for name in ("X", "Y", "Z", "XX", "YY", "ZZ")]
    guid = UUID("c41696fc-e8e8-42c9-89b2-a5a6aac030b0")
    support = d.kangaroo(
        "Support", [("Frame", None), *flags, ("Strength", 1e9)], ["Support"], guid=guid, frame=frames[2]
    )
    load = d.kangaroo("Load", (("P", None), ("FV", (0.0, 0.0, -1.0))), ["U"], p=d.point(2.5, 0, 0))
    solver = d.kangaroo(
        "Solver", SOLVER, ["I", "V", "O"], goalobjects=[beam, support, load], reset=d.toggle("Reset", False)
    )
    d.panel("particles", solver["V"])
    _, report = kangaroo.translate(d.archive())
    assert not report.stays and not report.lost, report.text()
    tip = min(ran(d, tmp_path).panels["particles"].values_in_order(), key=lambda p: p.Z)
    assert pytest.approx(-(8 / 3 + 1 + 1.5) / 1e5, rel=1e-3) == tip.Z
