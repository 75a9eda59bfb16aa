"""Translated goals and forces, each alone between soft anchors, at rest where Kangaroo's published law has them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any
from uuid import UUID

import numpy as np
import pytest
from scipy.optimize import brentq, fsolve

from canvas.kangaroo_samples import ANCHOR, SOLVER, Kangaroo
from canvas.test_import_run import SOFT, places, ran

pytestmark = pytest.mark.usefixtures("home")

HOLD = 100.0
"""Strength of the soft anchors [N/m]."""
OLD_ANCHOR, OLD_SOLVER = UUID("b476d3d0-4daf-489c-b91a-49f5dd72a256"), UUID("a54d250e-e285-4f38-9fb3-8dd9c886c659")


class Bench(Kangaroo):
    """Goals beside each other, and where particles are to be at rest."""

    def __init__(self, name: str) -> None:
        super().__init__(name, name.capitalize(), "Goals beside each other.")
        self.goals: list[Any] = []
        self.expected: list[tuple[Sequence[float], float]] = []

    def goal(self, name: str, typed: dict[str, Any], **wires: Any) -> None:
        """A goal with what is typed into it (None: wired or empty)."""
        self.goals.append(self.kangaroo(name, tuple(typed.items()), ["G"], **wires))

    def soft(self, at: Any, strength: float = HOLD) -> None:
        """A soft anchor where a point is."""
        typed = tuple((name, strength if name == "Strength" else value) for name, value in ANCHOR)
        self.goals.append(self.kangaroo("Anchor", typed, ["A"], guid=SOFT, p=at))

    def load(self, at: Any, *force: float) -> None:
        """A force on a point."""
        self.goals.append(self.kangaroo("Load", (("P", None), ("FV", force)), ["U"], p=at))

    def line(self, *ends: Any) -> Any:
        """A line between two points."""
        return self.native("Line", start_point=ends[0], end_point=ends[1])

    def at_rest(self, place: Sequence[float], within: float = 1e-4) -> None:
        """A particle comes to rest at this place."""
        self.expected.append((place, within))

    def check(self, tmp_path: Path) -> None:
        """Run it; every expected particle is there."""
        solver = self.kangaroo("Solver", SOLVER, ["I", "V", "O"], goalobjects=self.goals, reset=self.toggle("R", False))
        self.panel("particles", solver["V"])
        found = places(ran(self, tmp_path))
        for place, within in self.expected:
            near = found[np.argmin(np.linalg.norm(found - np.array(place), axis=1))]
            np.testing.assert_allclose(near, place, atol=within)


@pytest.mark.soak
def test_goals_of_points_and_lines_keep_their_laws(tmp_path: Path) -> None:
    """Between anchors of h [N/m] at both ends, a spring k with a misfit e carries k e / (1 + 2 k / h), by hand."""
    d = Bench("lines")
    half = 10.0  # half of a strength of 20

    held, free = d.point(0, 0, 0), d.point(2.8, 0, 0)
    line = d.line(held, free)
    d.goal("LengthSnap", {"Line": None, "Factor": 1.0, "Strength": 10.0}, line=line)
    d.soft(held)
    d.load(free, 1.0, 0.0, 0.0)
    d.at_rest((3.0 + 1.0 / 10.0 + 1.0 / HOLD, 0, 0))

    held, free = d.point(0, 5, 0), d.point(2, 5, 0)
    d.goal("PlasticLength", {"Line": None, "L": 0.2, "Strength": 10.0}, line=d.line(held, free))
    d.soft(held)
    d.load(free, 1.5, 0.0, 0.0)
    d.at_rest((2.0 + 1.5 / 10.0 + 1.5 / HOLD, 5, 0))

    ends = [d.point(0, 10, 0), d.point(2, 10, 0)]
    d.goal("DynamicWeight1d", {"Line": None, "W": -4.0}, line=d.line(*ends))
    d.soft(ends)
    d.at_rest((0, 10, -4.0 / HOLD))

    near = [d.point(0, 15, 0), d.point(0.3, 15, 0)]
    d.goal("MagnetSnap", {"Points": None, "Range": 0.5, "Strength": 2 * half}, points=near)
    d.soft(near)
    d.at_rest((half * 0.25 / HOLD, 15, 0))  # F = half x 0.25: they are 0.3 - 2 F / h = 0.25 apart

    pair = [d.point(0, 20, 0), d.point(0, 20, 1.3)]
    up = d.script("Up", "t = [1.0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1]", {}, ["t"])
    d.goal("Transform", {"P0": None, "P1": None, "T": None, "Strength": 2 * half}, p0=pair[0], p1=pair[1], t=up)
    d.soft(pair)
    d.at_rest((0, 20, half * 0.25 / HOLD))
    d.at_rest((0, 20, 1.3 - half * 0.25 / HOLD))

    ratio = 1.5
    misfit = (ratio - 1) / (1 + 2 * half * (ratio**2 + 1) / HOLD)
    a, b = ([d.point(x, 25, 0), d.point(x + 1, 25, 0)] for x in (0, 5))
    typed = {"LineA": None, "LineB": None, "Ratio": ratio, "Strength": 2 * half}
    d.goal("LengthRatio", typed, linea=d.line(*a), lineb=d.line(*b))
    d.soft(a + b)
    d.at_rest((half * ratio * misfit / HOLD, 25, 0))
    d.at_rest((5 - half * misfit / HOLD, 25, 0))
    d.check(tmp_path)


@pytest.mark.soak
def test_points_are_fitted_and_kept_out_of_curves_by_the_whole_strength(tmp_path: Path) -> None:
    """Fits that residuals do not move: each residual r shrinks to r h / (h + k). A depth against
    an equal anchor: half."""
    d = Bench("fits")
    keep = HOLD / (HOLD + 50.0)
    row = [d.point(0, 0, 0), d.point(1, 0.3, 0), d.point(2, 0, 0)]
    d.goal("CoLinear", {"Points": None, "Strength": 50.0}, points=row)
    d.soft(row)
    d.at_rest((1, 0.1 + 0.2 * keep, 0))

    ball = [d.point(10 + s * 1.2, 0, 0) for s in (-1, 1)]
    ball += [d.point(10, *p) for p in ((1, 0), (-1, 0), (0, 1), (0, -1))]
    d.goal("CoSpherical", {"Points": None, "Strength": 50.0}, points=ball)
    d.soft(ball)
    mean = (2 * 1.2 + 4) / 6
    d.at_rest((10 + mean + (1.2 - mean) * keep, 0, 0))

    ring = [d.point(20 + x, y, 0) for x, y in ((1.2, 0), (-1.2, 0), (0, 1), (0, -1))]
    d.goal("CoCircular", {"Points": None, "Strength": 50.0}, points=ring)
    d.soft(ring)
    d.at_rest((20 + 1.1 + 0.1 * keep, 0, 0))

    square = [d.point(30 + x, y, 0) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    made = d.script(
        "Curve",
        "import Rhino.Geometry as rg\nc = rg.Polyline(5)\n"
        "for p in points + points[:1]: c.Add(p.X, p.Y, p.Z)\n"
        "plane = rg.Plane(rg.Point3d(0, 0, 0), rg.Vector3d(0, 0, 1))\n",
        {"points": square},
        ["c", "plane"],
        lists=["points"],
    )
    inner = d.point(30.8, 0, 0)
    typed = {"Points": None, "Curve": None, "Plane": None, "Interior": False, "Strength": HOLD}
    d.goal("CurvePointCollide", typed, points=inner, curve=made["c"], plane=made["plane"])
    d.soft(inner)
    d.at_rest((30.9, 0, 0))
    d.check(tmp_path)


def test_points_and_lines_of_a_collider_are_spheres_and_capsules_of_its_radii(tmp_path: Path) -> None:
    """Between anchors of h, two that overlap by e part by e k / (2 k + h) each, k half of the strength."""
    d = Bench("collider")
    balls = [d.point(0, 0, 0), d.point(0.8, 0, 0)]
    d.goal("Collider", {"Objects": None, "Radii": 0.5, "Strength": 100.0}, objects=balls)
    d.soft(balls)
    d.at_rest((-0.2 * 50.0 / (100.0 + HOLD), 0, 0))

    ends, ball = [d.point(0, 10, 0), d.point(2, 10, 0)], d.point(1, 10, 0.9)
    d.goal("Collider", {"Objects": None, "Radii": 0.5, "Strength": 100.0}, objects=[d.line(*ends), ball])
    d.soft([*ends, ball])
    force = 0.1 / (1.0 / 50.0 + 1.0 / HOLD + 0.5 / HOLD)  # both ends of the line carry half of it
    d.at_rest((1, 10, 0.9 + force / HOLD))
    d.at_rest((0, 10, -0.5 * force / HOLD))
    d.check(tmp_path)


def test_points_of_a_rigid_body_keep_their_shape_and_move_as_one(tmp_path: Path) -> None:
    """A square, one corner pulled by 4 N along x towards its neighbour: 4 anchors of h carry it, and the body is as
    stiff as its strength: the force moves all of it by 1 N / h, and turns it about the middle, by M / (4 h r^2)."""
    d = Bench("rigid")
    corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
    points = [d.point(*p, 0) for p in corners]
    d.goal("RigidPointSet", {"Points": None, "Plane": None, "Strength": 1e5}, points=points)
    d.soft(points)
    d.load(points[0], 4.0, 0.0, 0.0)
    turn = 4.0 / (4 * HOLD * 2)
    d.expected += [((x + 1 / HOLD - turn * y, y + turn * x, 0), 4e-4) for x, y in corners]  # turn^2 and h / k
    d.check(tmp_path)


def turned(start: Any, strength: float, law: Any) -> Any:
    """Ends of two lines at rest between soft anchors, by a published law of K2: couples on lines A and B."""

    def out_of_balance(flat: Any) -> Any:
        p = flat.reshape(4, 2)
        a, b = p[1] - p[0], p[3] - p[2]
        la, lb, lc = (np.hypot(*v) for v in (a, b, a + b))
        angle = np.arccos(a @ b / la / lb)
        top, scale = law(angle, la, lb)
        turn = np.sign(a[0] * b[1] - a[1] * b[0])
        push = [0.5 * top / (length * lc) * size for length, size in zip((la, lb), scale, strict=True)]
        normals = [np.array([-v[1], v[0]]) / length for v, length in ((a, la), (b, lb))]
        first, second = -turn * push[0] * normals[0], turn * push[1] * normals[1]
        forces = strength * np.array([first, -first, second, -second])
        return (HOLD * (start - p) + forces).ravel()

    return fsolve(out_of_balance, start.ravel(), xtol=1e-12).reshape(4, 2)


def test_angles_snap_and_clamp_by_the_moments_of_the_published_goals(tmp_path: Path) -> None:
    """S sin(t - t0) / (2 |A + B|) as a couple on each line, the directions of the shears of a clamp not unitised: of
    length a^2 b sin t. Ours is linear, with the lengths of the start: within 3 % of what they move for 10 degrees."""
    d = Bench("angles")
    limit = np.pi / 2
    for y, name, degrees in ((0.0, "AngleSnap", 80.0), (10.0, "ClampAngle", 100.0)):
        t = np.radians(degrees)
        start = np.array([[0, y], [1, y], [0, y + 2], [np.cos(t), y + 2 + np.sin(t)]])
        points = [d.point(*map(float, p), 0) for p in start]
        lines = {"linea": d.line(*points[:2]), "lineb": d.line(*points[2:])}
        strength = 90.0
        if name == "AngleSnap":
            d.goal(name, {"LineA": None, "LineB": None, "Factor": limit, "Strength": strength}, **lines)
            expected = turned(start, strength, lambda angle, a, b: (np.sin(angle - limit), (1, 1)))
        else:
            typed = {"LineA": None, "LineB": None, "Upper": limit, "Lower": 0.5, "Strength": strength}
            d.goal(name, typed, **lines)
            expected = turned(
                start,
                strength,
                lambda angle, a, b: (np.sin(angle - limit), (a**2 * b * np.sin(angle), b**2 * a * np.sin(angle))),
            )
        d.soft(points)
        moved = np.linalg.norm(expected - start, axis=1).max()
        assert moved > 0.02
        for place in expected:
            d.at_rest((*place, 0.0), 0.03 * moved)
    d.check(tmp_path)


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


def fan(x, top):
    rim = [(x + math.cos(i * math.pi / 3), math.sin(i * math.pi / 3), 0.0) for i in range(6)]
    return rim, of([(x, 0.0, top)] + rim, [(0, 1 + i, 1 + (i + 1) % 6) for i in range(6)])


tips = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]
solid = of(tips, [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)])
tips = [rg.Point3d(*p) for p in tips]
plate = [(10.0, 0.0, 0.0), (11.0, 0.0, 0.0), (10.0, 1.0, 0.0)]
sail = of(plate, [(0, 1, 2)])
plate = [rg.Point3d(*p) for p in plate]
rim, flat = fan(20.0, 0.0)
cone_rim, cone = fan(30.0, 0.3)
held = [rg.Point3d(*p) for p in rim + cone_rim]
rim = [rg.Point3d(*p) for p in rim]
quad = [(5.0, -20.0, 0.0), (6.0, -20.0, 0.0), (6.0, -19.0, 0.2), (5.0, -19.0, 0.0)]
twisted = of(quad, [(0, 1, 2, 3)])
quad = [rg.Point3d(*p) for p in quad[:2] + quad[3:]]
"""


def test_goals_of_meshes_keep_their_laws(tmp_path: Path) -> None:
    """Volume of an octahedron by its published law, 2 S (V0 - V) / A on the area vectors of the faces round a tip, the
    area that of the start here: within 3 % of the way. TangentialSmooth: half of the strength. Developablize: a cone
    becomes flat."""
    d = Bench("meshes")
    made = d.script("Meshes", MESHES, {}, ["solid", "tips", "flat", "cone", "held"])
    target = 4 / 3 * 1.05**3
    d.goal("Volume", {"Mesh": None, "Volume": target, "Strength": 20.0}, mesh=made["solid"])
    d.soft(made["tips"])
    area = 4 * np.sqrt(3)  # of radius 1; four faces round a tip have the area vector 2 r^2 along its axis
    far = brentq(lambda r: HOLD * (r - 1) - 40.0 * (target - 4 / 3 * r**3) / (area * r**2) * 2 * r**2, 1, 1.05)
    assert far > 1.01
    d.at_rest((0, 0, far), 0.03 * (far - 1))

    d.goal("TangentialSmooth", {"M": None, "Strength": 4.0}, m=made["flat"])
    d.load(d.point(20, 0, 0), 0.6, 0.0, 0.0)
    d.at_rest((20.3, 0, 0))

    d.goal("Developablize", {"M": None, "Strength": 4.0}, m=made["cone"])
    d.at_rest((30, 0, 0), 1e-2)  # the angle is 2 pi - c z^2, so that the moment ends before the way does
    fixed = {"P": None, "X": True, "Y": True, "Z": True, "Strength": 1000.0}
    d.goal("AnchorXYZ", fixed, p=made["held"])
    d.check(tmp_path)


def test_wind_pushes_the_corners_of_a_mesh(tmp_path: Path) -> None:
    """A third of |w| A on each corner of a triangle; what moves with the wind alone is played until it rests."""
    d = Bench("wind")
    made = d.script("Meshes", MESHES, {}, ["sail", "plate"])
    d.goal("Wind", {"Mesh": None, "WindVector": (0.0, 0.0, 6.0)}, mesh=made["sail"])
    d.soft(made["plate"])
    d.at_rest((11, 0, 6.0 * 0.5 / 3 / HOLD))
    d.check(tmp_path)


def test_triangles_by_points_are_one_film_and_polygons_push_their_edges_out(tmp_path: Path) -> None:
    """A cone of six triangles: E = S A, so 3 S z / sqrt(3/4 + z^2) = P. A square by the published law, S (A0 - A) / L
    along both edges of a corner; here by the lengths of the start, 2 % of the way for 1 % of length."""
    d = Bench("films")
    corners = [(np.cos(i * np.pi / 3), np.sin(i * np.pi / 3), 0.0) for i in range(7)]
    middle, rim = d.point(0, 0, 0.1), [d.point(*map(float, p)) for p in corners[:6]]
    for i in range(6):
        d.goal("SoapFilm", {"Pts": None, "Strength": 2.0}, pts=[middle, rim[i], rim[(i + 1) % 6]],
               guid=UUID("0c68b153-3c88-4e62-9827-f3793c013f88"))  # fmt: skip
    d.goal("AnchorXYZ", {"P": None, "X": True, "Y": True, "Z": True, "Strength": 1000.0}, p=rim)
    d.load(middle, 0.0, 0.0, 3.0)
    d.at_rest((0, 0, np.sqrt(0.75) / np.sqrt((3 * 2 / 3.0) ** 2 - 1)))

    square = [d.point(10 + x, y, 0) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    made = d.script(
        "Square",
        "import Rhino.Geometry as rg\nc = rg.Polyline(5)\nfor p in points + points[:1]: c.Add(p.X, p.Y, p.Z)\n",
        {"points": square},
        ["c"],
        lists=["points"],
    )
    d.goal("PolygonArea", {"Polyline": None, "Area": 4.4, "Strength": 40.0}, polyline=made["c"])
    d.soft(square)
    far = brentq(lambda r: HOLD * (r - 1) - 40.0 * (4.4 - 4 * r**2) / (8 * r), 1, 1.1)
    assert far > 1.01
    d.at_rest((10 + far, far, 0), 0.04 * (far - 1))
    d.check(tmp_path)


@pytest.mark.parametrize("by_index", [True, False])
def test_anchors_and_loads_by_index_act_on_the_points_of_the_solver(by_index: bool, tmp_path: Path) -> None:
    """A spring of 10 N/m from an anchor: 5 N stretch it by 0.5 m. The anchor's own point is where it pulls to."""
    d = Kangaroo("numbered", "Numbered", "Goals by index.")
    points = [d.point(0, 0, 1), d.point(0, 0, 0)]
    lengths = (("Line", None), ("Length", None), ("Strength", 10.0))
    anchor = (("Point", None), ("Index", None), ("Strength", 1e6))
    solver = (("GoalObjects", None), ("Points", None), ("Reset", False), ("Tolerance", 0.01))
    index = {"index": d.slider("i", 0, 0, 9)} if by_index else {}
    where: Any = d.slider("j", 1, 0, 9) if by_index else points[1]
    goals = [
        d.kangaroo("Length(Line)", lengths, ["S"], line=d.native("Line", start_point=points[0], end_point=points[1])),
        d.kangaroo("Anchor", anchor, ["A"], guid=OLD_ANCHOR, point=points[0], **index),
        d.kangaroo("Load", (("P", None), ("FV", (0.0, 0.0, -5.0))), ["U"], p=where),
    ]
    made = d.kangaroo("Solver", solver, ["V", "O"], guid=OLD_SOLVER, goalobjects=goals, points=points)
    d.panel("particles", made["V"])
    found = places(ran(d, tmp_path))
    np.testing.assert_allclose(found[:, 2], [1.0, -0.5], atol=1e-4)
