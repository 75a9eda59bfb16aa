"""Goals of Kangaroo 2 that few files have: what an import makes of them, and what that does."""

from __future__ import annotations

from pathlib import Path
from typing import Any
from uuid import UUID

import numpy as np
import pytest

from canvas.kangaroo_samples import Kangaroo, solver_of
from canvas.test_import_run import SOFT, places, ran
from canvas.test_stored import internalised
from hookean_canvas.archive import Type
from hookean_canvas.kangaroo import rare
from hookean_canvas.kangaroo import translate as kangaroo
from hookean_canvas.run import graph
from hookean_canvas.run.evaluate import Canvas
from hookean_canvas.run.rhino import rhino3dm
from serving import HANG

pytestmark = pytest.mark.usefixtures("home")

BOUNCY = (
    ("GoalObjects", None), ("Reset", False), ("Threshold", 1e-15), ("Tolerance", 0.01), ("Damping", 0.99),
    ("Iterations", 10), ("On", True),
)  # fmt: skip


def pixels(places: Any, values: Any) -> tuple[Any, Any]:
    """The image that the script of ImageCircles makes of vertices and their brightness."""
    script: dict[str, Any] = {}
    code = rare.PIXELS.split("image = corners = None")[0].replace("from hookean_client import canvas\n", "")
    exec(compile(code, "pixels", "exec"), script)
    rows, corners = script["pixels"](places, values)
    return np.array(rows), np.array(corners)


def test_the_image_of_a_grid_of_vertices_has_each_in_the_middle_of_a_pixel() -> None:
    """Brightness x + 10 y at the vertices of a grid of 5 by 3: the pixels are those numbers, in rows from low y on."""
    grid = [[0.5 * i, 0.5 * j, 0.0] for i in range(5) for j in range(3)]
    rows, corners = pixels(grid, [x + 10.0 * y for x, y, _ in grid])
    assert rows.shape == (3, 5)
    np.testing.assert_allclose(rows, [[0.5 * i + 5.0 * j for i in range(5)] for j in range(3)], atol=1e-12)
    np.testing.assert_allclose(corners[:, :2], [[-0.25, -0.25], [2.25, 1.25]], atol=1e-12)


def test_pixels_without_a_vertex_lie_between_those_around_them() -> None:
    rows, _ = pixels([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0.02, 0.5, 0], [0, 0, 0]] * 4, [0.0, 1.0] * 12)
    assert rows.min() >= 0.0 and rows.max() <= 1.0 and np.isfinite(rows).all()


def blown(count: float) -> Kangaroo:
    """Two points on soft anchors, and a bomb between them."""
    d = Kangaroo(f"bomb {count}", "Bomb", "Two points thrown apart.")
    points = [d.point(-1, 0, 0), d.point(1, 0, 0)]
    typed = (("P", None), ("T", None), ("Strength", 40.0))
    held = [d.kangaroo("Anchor", typed, ["A"], guid=SOFT, p=point) for point in points]
    bomb = d.kangaroo(
        "Bomb",
        (("Location", None), ("Points", None), ("DetonationTime", count), ("Strength", 2.0), ("Reset", None)),
        ["Bomb"],
        location=d.point(0, 0, 0),
        points=points,
    )
    solver = d.kangaroo(
        "BouncySolver", BOUNCY, ["I", "V", "O"], goalobjects=[*held, bomb], reset=d.toggle("Reset", False)
    )
    d.panel("particles", solver["V"])
    return d


def test_a_bomb_becomes_an_impulse_at_a_time_and_its_system_is_translated() -> None:
    after, report = kangaroo.translate(blown(30.0).archive())
    assert (report.solvers, report.whole, report.stays) == (1, 1, [])
    names = [chunk.value("Name") for chunk in after.walk() if chunk.name == "Container"]
    assert {"Impulse", "Detonations"} <= set(names)
    assert solver_of(after) == "verlet"  # a bomb needs physical time


@pytest.mark.slow
def test_points_thrown_apart_by_a_bomb_come_to_rest_on_their_anchors(tmp_path: Path) -> None:
    found = places(ran(blown(5.0), tmp_path))
    np.testing.assert_allclose(found[np.argsort(found[:, 0])], [[-1, 0, 0], [1, 0, 0]], atol=1e-2)


@pytest.mark.soak
def test_circles_as_large_as_a_mesh_is_bright_push_each_other_apart_by_their_radii(tmp_path: Path) -> None:
    """A mesh of one grey, 51 of 255: both radii are 0.2 + 0.2 (1 - 0.2) = 0.36 everywhere.

    Anchors of 5 at -0.2 and 0.2 hold two circles of half of 10: 5 (d / 2 - 0.2) = 5 (0.72 - d), so d = 0.92 / 1.5.
    """
    d = Kangaroo("image", "Image", "Two circles on an image.")
    corners = [d.point(x, y, 0) for x, y in ((-2, -2), (2, -2), (2, 2), (-2, 2))]
    grey = d.script("Greys", "import System\nc = [System.Drawing.Color.FromArgb(51, 51, 51)] * 4\n", {}, ["c"])
    face = d.native("Mesh Quad", corner_a=0, corner_b=1, corner_c=2, corner_d=3)
    mesh = d.native("Construct Mesh", vertices=corners, faces=face, colours=grey)
    points = [d.point(-0.2, 0, 0), d.point(0.2, 0, 0)]
    typed = (("Points", None), ("Mesh", None), ("Min", 0.2), ("Max", 1.0), ("Curves", None), ("Strength", 10.0))
    circles = d.kangaroo("ImageCircles", typed, ["ImageCircles"], points=points, mesh=mesh)
    soft = (("P", None), ("T", None), ("Strength", 5.0))
    held = [d.kangaroo("Anchor", soft, ["A"], guid=SOFT, p=point) for point in points]
    solver = d.solved(circles, *held, reset=d.toggle("Reset", False))
    d.panel("particles", solver["V"])
    d.panel("outputs", solver["O"])
    outcome = ran(d, tmp_path)
    found = places(outcome)
    assert float(np.linalg.norm(found[1] - found[0])) == pytest.approx(0.92 / 1.5, abs=1e-3)
    rounds = [one for one in outcome.panels["outputs"].values_in_order() if isinstance(one, rhino3dm.Circle)]
    assert [one.Radius for one in rounds] == pytest.approx([0.36, 0.36], rel=1e-6)
    np.testing.assert_allclose([[one.Center.X, one.Center.Y, one.Center.Z] for one in rounds], found)


@pytest.mark.slow
def test_a_rim_comes_to_a_circle_that_a_parameter_holds_with_the_solver_of_nine_inputs(tmp_path: Path) -> None:
    """A mesh whose rim is pulled to an internalised circle as a NURBS curve, rational and closed, of radius 2."""
    d = Kangaroo("museum", "Museum", "A mesh on a circle.")
    curve = d.parameter("Curve", "Circle")
    side = d.slider("Side", 2, 1, 5)
    size = d.native("Rectangle", plane=d.native("XY Plane", origin=d.point(-1, -1, 0)), x_size=side, y_size=side)
    mesh = d.native("Mesh Plane", boundary=size["Rectangle"], width_count=4, height_count=4)["Mesh"]
    rim = d.kangaroo("NakedVertices", (("Mesh", None),), ["ClothedIndex", "NakedIndex", "ClothedPts", "NakedPts"],
                     mesh=mesh)["NakedPts"]  # fmt: skip
    on = d.kangaroo(
        "OnCurve", (("Points", None), ("Curve", None), ("Strength", 1000.0)), ["P"], points=rim, curve=curve
    )
    springs = (("Mesh", None), ("LengthFactor", 1.0), ("Strength", 1.0))
    edges = d.kangaroo("EdgeLengths", springs, ["EL"], mesh=mesh)
    typed = (
        ("GoalObjects", None), ("Points", None), ("Reset", False), ("Restart", False), ("Parallel", True),
        ("Threshold", 1e-15), ("Tolerance", 0.01), ("AddCurrent", False), ("On", True),
    )  # fmt: skip
    solver = d.kangaroo("Solver", typed, ["V", "O"], guid=UUID("a54d250e-e285-4f38-9fb3-8dd9c886c659"),
                        goalobjects=[on, edges], reset=d.toggle("Reset", True))  # fmt: skip
    d.panel("particles", solver["V"])
    circle = rhino3dm.Circle(2.0).ToNurbsCurve()
    root = d.archive()
    held = next(one for one in root.walk() if one.value("InstanceGuid") == curve.id)
    held.chunks[:] = [one for one in held.chunks if one.name != "PersistentData"]
    branch = held.add("PersistentData").put("Count", Type.INT32, 1).add("Branch", 0)
    branch.put("Count", Type.INT32, 1).put("Path", Type.STRING, "{0}")
    item = branch.add("Item", 0).put("EdgeIndex", Type.INT32, -1).put("RefID", Type.GUID, UUID(int=0))
    item.put("ON_Data", Type.BYTEARRAY, internalised(circle))
    after, report = kangaroo.translate(root)
    assert (report.whole, report.stays) == (1, [])
    found = graph.of(after)
    outcome = Canvas(found).run(HANG)
    assert outcome.at_rest and [m for m in outcome.messages if m.level == "error"] == []
    far = np.linalg.norm(places(outcome), axis=1)
    assert np.sum(np.abs(far - 2.0) < 0.02) == 16 and far.min() < 0.02  # as near as the curve's polyline is


@pytest.mark.parametrize("kept_in", [False, True])
def test_circles_of_an_image_stay_in_curves_only_where_there_are_some(kept_in: bool) -> None:
    d = Kangaroo(f"curves {kept_in}", "Curves", "Circles on an image, in a curve.")
    wires = {"curves": d.parameter("Curve", "Curves")} if kept_in else {}
    typed = (("Points", None), ("Mesh", None), ("Min", 0.2), ("Max", 1.0), ("Curves", None), ("Strength", 1.0))
    circles = d.kangaroo("ImageCircles", typed, ["ImageCircles"], points=d.parameter("Point", "Points"),
                         mesh=d.parameter("Mesh", "Mesh"), **wires)  # fmt: skip
    d.solved(circles)
    after, report = kangaroo.translate(d.archive())
    names = [chunk.value("Name") for chunk in after.walk() if chunk.name == "Container"]
    assert (report.whole, report.stays, report.lost) == (1, [], [])
    assert "Circle Image" in names and ("Collide Curve" in names) == kept_in


def test_a_wire_into_the_reset_of_a_bomb_is_named() -> None:
    d = Kangaroo("reset", "Reset", "A bomb with a reset of its own.")
    typed = (("Location", None), ("Points", None), ("DetonationTime", 150.0), ("Strength", 1.0), ("Reset", None))
    toggle = d.toggle("Again", False)
    bomb = d.kangaroo(
        "Bomb", typed, ["Bomb"], location=d.point(0, 0, 0), points=d.parameter("Point", "P"), reset=toggle
    )
    d.solved(bomb)
    _, report = kangaroo.translate(d.archive())
    assert [why for _, why in report.lost] == ["the reset of the Engine starts the count again"]


def flag() -> Kangaroo:
    """A soft net, held at its corners, that the wind blows down and its rim is drawn to a plane below."""
    d = Kangaroo("wind", "Wind", "A net in the wind.")
    side = d.slider("Side", 4, 1, 5)
    size = d.native("Rectangle", plane=d.native("XY Plane", origin=d.point(0, 0, 0)), x_size=side, y_size=side)
    mesh = d.native("Mesh Plane", boundary=size["Rectangle"], width_count=3, height_count=4)["Mesh"]
    corners = d.kangaroo("MeshCorners", (("Mesh", None), ("Angle", 2.356)), ["Corners"], mesh=mesh)["Corners"]
    rim = d.kangaroo("NakedVertices", (("Mesh", None),), ["ClothedIndex", "NakedIndex", "ClothedPts", "NakedPts"],
                     mesh=mesh)["NakedPts"]  # fmt: skip
    axes = (("Point", None), ("X", True), ("Y", True), ("Z", True), ("Strength", 1000.0))
    low = d.native("XY Plane", origin=d.point(2, 2, -2))
    goals = [
        d.kangaroo("EdgeLengths", (("Mesh", None), ("LengthFactor", 1.0), ("Strength", 1.0)), ["EL"], mesh=mesh),
        d.kangaroo("AnchorXYZ", axes, ["A"], point=corners),
        d.kangaroo("Wind", (("Mesh", None), ("WindVector", (0.0, 0.0, -1.0))), ["Wind"], mesh=mesh),
        d.kangaroo("OnPlane", (("Points", None), ("Plane", None), ("Strength", 1.0)), ["P"], points=rim, plane=low),
    ]
    d.panel("particles", d.solved(*goals, reset=d.toggle("Reset", False))["V"])
    return d


@pytest.mark.slow
def test_a_net_that_would_flutter_in_the_wind_comes_to_rest_in_physical_time(tmp_path: Path) -> None:
    """Wind on a cloth that turns has no energy: the iteration of Kangaroo's solver goes round for ever here."""
    _, report = kangaroo.translate(flag().archive())
    assert [differs for name, _, differs in report.swapped if name == "Solver" and "in physical time" in differs]
    found = places(ran(flag(), tmp_path))
    assert len(found) == 20 and found[:, 2].min() < -2.0
