"""Translated forces of classic Kangaroo, each alone between soft anchors, at rest where its law has them.

Kangaroo 0.099 publishes no formulas; these are the laws that docs/canvas.md states for the translation.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any
from uuid import uuid5

import numpy as np
import pytest
from scipy.optimize import brentq

from canvas.kangaroo_samples import CLASSIC, PHYSICS, PHYSICS_OUT, SETTINGS, Kangaroo
from canvas.test_import_forces import HOLD, MESHES
from canvas.test_import_run import places, ran
from hookean_canvas.kangaroo.ids import CLASSIC_LIBRARY

pytestmark = pytest.mark.usefixtures("home")


class Bench(Kangaroo):
    """Classic forces beside each other, and where particles are to be at rest."""

    def __init__(self, name: str) -> None:
        super().__init__(name, name.capitalize(), "Forces beside each other.")
        self.goals: list[Any] = []
        self.fixed: list[Any] = []
        self.expected: list[Sequence[float]] = []
        self.around: list[tuple[Sequence[float], float]] = []

    def force(self, name: str, typed: dict[str, Any], **wires: Any) -> None:
        """A force with what is typed into it (None: wired or empty), known by its library and name."""
        guid = uuid5(CLASSIC_LIBRARY, name)
        self.goals.append(self.kangaroo(name, tuple(typed.items()), ["F"], guid=guid, classic=True, **wires))

    def soft(self, at: Any) -> None:
        """A soft anchor where points are."""
        self.force("AnchorSpring", {"Point": None, "Strength": HOLD, "Sticky": 0.0}, point=at)

    def load(self, at: Any, *force: float) -> None:
        """A force on a point."""
        self.force("UnaryForce", {"Point": None, "Force": force}, point=at)

    def row(self, y: float, *xs: float) -> list[Any]:
        """Points on the line y, softly held."""
        points = [self.point(x, y, 0) for x in xs]
        self.soft(points)
        return points

    def line(self, *ends: Any) -> Any:
        """A line between two points."""
        return self.native("Line", start_point=ends[0], end_point=ends[1])

    def check(self, tmp_path: Path) -> None:
        """Run it; every expected particle is there."""
        found = self.found(tmp_path)
        for place in self.expected:
            near = found[np.argmin(np.linalg.norm(found - np.array(place), axis=1))]
            np.testing.assert_allclose(near, place, atol=1e-5)
        for place, within in self.around:
            assert np.linalg.norm(found - np.array(place), axis=1).min() < within

    def found(self, tmp_path: Path) -> Any:
        """The particles at rest. A solver that is not here leaves the choice to the Engine."""
        typed = [(name, {"Floor": False, "Solver": 2}.get(name, value)) for name, value in SETTINGS]
        setting = self.kangaroo("Kangaroo Settings", typed, ["Settings"], classic=True)
        made = self.kangaroo(
            CLASSIC, PHYSICS, PHYSICS_OUT, classic=True, force_objects=self.goals, settings=setting,
            simulationreset=self.toggle("R", True), **({"anchorpoints": self.fixed} if self.fixed else {}),
        )  # fmt: skip
        self.panel("particles", made["ParticlesOut"])
        return places(ran(self, tmp_path))


@pytest.mark.soak
def test_classic_forces_between_points_keep_their_laws(tmp_path: Path) -> None:
    """Forces F on points that are held by h move them by F / h."""
    d = Bench("points")
    a, b, c, e = d.row(0, 0, 1, 5, 6.4)
    lines = [d.line(a, b), d.line(c, e)]
    d.force("Equalize", {"Lines": None, "EqNStrength": 50.0}, lines=lines)
    d.expected.append((1 + 0.2 / (1 / 50 + 2 / HOLD) / 2 / HOLD * 2, 0, 0))  # T = (l - mean) k

    ends = d.row(5, 0, 1)
    typed = {"Connection": None, "Stiffness": 7.0, "TargetForce": 3.0, "Damping": 1.0, "Rest Length": 0.5}
    d.force("FD", typed, connection=d.line(*ends))
    d.expected += [(3.0 / HOLD, 5, 0), (1 - 3.0 / HOLD, 5, 0)]

    ends = d.row(10, 0, 1)
    typed = {"Connection": None, "Exponent": 0, "Strength": 2.0, "Cutoff": 0.0}
    d.force("PowerLaw", typed, connection=d.line(*ends))
    d.expected += [(-2.0 / HOLD, 10, 0)]

    tail, nose = d.row(15, 0, 1)
    d.force("Rocket", {"Point1": None, "Point2": None, "RocketStrength": 4.0}, point1=tail, point2=nose)
    d.expected += [(2.0 / HOLD, 15, 0), (1 + 2.0 / HOLD, 15, 0)]

    pair = [d.point(0, 20, 0), d.point(1, 21, 0)]
    d.soft(pair)
    typed = {"P1": None, "P2": None, "Vector": (3.0, 0.0, 0.0)}
    d.force("ProjectedForce", typed, p1=pair[0], p2=pair[1])
    d.expected += [(3.0 / HOLD, 20 + 3.0 / HOLD, 0)]  # along a line of 45 degrees, which keeps its direction

    one, other = d.row(25, 0, 1)
    d.force("TranslationLock", {"P1": None, "P2": None}, p1=one, p2=other)
    d.load(one, 1.0, 0.0, 0.0)
    d.expected += [((1 / HOLD + 1 / (HOLD + 2000)) / 2, 25, 0)]

    left, right = d.row(30, -1, 1.2)
    b, c = d.point(-0.5, 30, 3), d.point(0.5, 30, 3)
    d.force("Mirror", {"A": None, "B": None, "C": None, "D": None, "Strength": HOLD}, a=left, b=b, c=c, d=right)
    d.expected += [(1.2 - 0.2 / 3, 30, 0)]

    spheres = d.row(35, 0, 1.5)
    d.force("SphereCollide", {"Centers": None, "Radius": 1.0}, centers=spheres)
    push = 1000 * 0.5 / (1 + 2 * 1000 / HOLD)
    d.expected += [(-push / HOLD, 35, 0)]

    [round_] = d.row(40, 1)
    axis = [d.point(0, 40, 0), d.point(0, 40, 1)]
    typed = {"AxisStart": None, "AxisEnd": None, "Point": None, "Strength": 2.0, "Cutoff": 0.0, "Exponent": 1}
    d.force("Vortex", typed, axisstart=axis[0], axisend=axis[1], point=round_)
    d.expected += [(HOLD**2 / (HOLD**2 + 4), 40 + 2 * HOLD / (HOLD**2 + 4), 0)]  # S times the radius turned
    d.check(tmp_path)


@pytest.mark.soak
def test_classic_angles_become_equal_and_lines_parallel(tmp_path: Path) -> None:
    """Anchors of h turn an angle back by h a^2 per radian at most, the moments of m turn it on: within h / m of it."""
    d = Bench("angles")
    strong = 1e4
    corners = []
    for y, degrees in ((0.0, 80.0), (5.0, 100.0)):
        t = np.radians(degrees)
        points = [d.point(1, y, 0), d.point(0, y, 0), d.point(float(np.cos(t)), y + float(np.sin(t)), 0)]
        d.soft(points)
        corners.append(points)
    typed: dict[str, Any] = {"Point1": None, "Point2": None, "Point3": None, "Strength": strong}
    given = {f"point{i + 1}": [points[i] for points in corners] for i in range(3)}
    d.force("EqualizeAngles", typed, **given)
    t = np.radians(170.0)
    ends = [
        d.point(0, 10, 0),
        d.point(1, 10, 0),
        d.point(0, 11, 0),
        d.point(float(np.cos(t)), 11 + float(np.sin(t)), 0),
    ]
    d.soft(ends)
    typed = {f"Align{i}": None for i in (1, 2, 3, 4)}
    typed |= {"AlignStrength": strong, "Exponent": 0.0, "Cutoff": 0.0, "AngleRange": 0.0}
    d.force("Align", typed, **{f"align{i + 1}": one for i, one in enumerate(ends)})
    found = d.found(tmp_path)

    def angle(a: Any, b: Any) -> float:
        return float(np.arccos(a @ b / np.linalg.norm(a) / np.linalg.norm(b)))

    rows = [found[np.abs(found[:, 1] - y) < 3] for y in (0.0, 5.0)]
    first, second = (angle(row[0] - row[1], row[2] - row[1]) for row in rows)
    assert abs(first - second) < np.radians(20) * HOLD / strong * 4
    aligned = found[found[:, 1] > 8]
    assert np.pi - angle(aligned[1] - aligned[0], aligned[3] - aligned[2]) < np.radians(10) * HOLD / strong * 4


def test_classic_forces_on_triangles_and_meshes_keep_their_laws(tmp_path: Path) -> None:
    """A pressure of 6 N/m2 on half a square metre is 1 N on each corner. Water of 2 N/m3, 3 m deep, has that pressure.
    Gas of an octahedron, K (V0 / V - 1), pushes each tip by a third of it on its area vector, 2 r^2."""
    d = Bench("faces")
    corners = {"point1": 0, "point2": 1, "point3": 2}
    for y, z, name, typed in (
        (0.0, 0.0, "Pressure", {"PressureLevel": 6.0}),
        (5.0, -3.0, "Hydro", {"Density": 2.0}),
        (10.0, 0.0, "Wind", {"Wind": (0.0, 0.0, 3.0), "Relative": False, "Strength": 2.0, "Waterline": 0}),
        (15.0, 0.0, "AreaWeight", {"Weight": 6.0, "Cotan": False}),
    ):
        points = [d.point(x, y + v, z) for x, v in ((50.0, 0.0), (51.0, 0.0), (50.0, 1.0))]
        d.soft(points)
        names = {"AreaWeight": ("p0", "p1", "p2")}.get(name, tuple(corners))
        given = dict.fromkeys((one.capitalize() for one in names), None)
        d.force(name, {**given, **typed}, **dict(zip(names, points, strict=True)))
        up = {"Hydro": 1 / (HOLD + 1 / 3), "AreaWeight": -1 / HOLD}.get(name, 1 / HOLD)
        d.expected.append((51, y, z + up))

    middle = d.point(20, 0, 0)
    turns = np.arange(6) * np.pi / 3
    ring = [d.point(20 + float(np.cos(t)), float(np.sin(t)), 0) for t in turns]
    typed = {"Center": None, "Neighbours": None, "Strength": 4.0, "Weighting": 0}
    d.force("Laplacian", typed, center=middle, neighbours=ring)
    d.load(middle, 0.0, 0.0, 0.6)
    d.fixed += ring
    d.expected.append((20, 0, 0.6 / 4.0))

    made = d.script("Meshes", MESHES, {}, ["solid", "tips", "flat", "rim", "sail", "plate", "twisted", "quad"])
    d.force("MeshSmooth", {"Mesh": None, "Strength": 4.0}, mesh=made["flat"])
    d.load(d.point(20, 0, 0), 0.0, 0.0, 0.6)  # with the Laplacian of this middle, above, and rims of a third each
    d.fixed.append(made["rim"])
    d.expected[-1] = (20, 0, 1.2 / (4.0 + 4.0 * (1 + 6 / 9)))

    d.force("HydroMesh", {"Mesh": None, "Density": -0.5}, mesh=made["sail"])
    d.force("WindMesh", {"Mesh": None, "Wind": (0.0, 0.0, 3.0), "Relative": False, "Strength": 2.0, "Waterline": 0},
            mesh=made["sail"])  # fmt: skip
    d.soft(made["plate"])
    d.expected.append((11, 0, 1 / HOLD))  # at z = 0 it is dry

    d.force("PlanarizeQuads", {"Mesh": None, "Strength": 10.0}, mesh=made["twisted"])
    d.fixed.append(made["quad"])
    d.around.append(((6, -19, 0), 0.06))  # it was 0.2 above, and moves along the gradient of the distance

    inner = d.point(0.3, 0.3, 0.3)
    typed = {"Solid": None, "Points": None, "Hardness": 0.5, "Traction": 0.5}
    d.force("CollideMesh", typed, solid=made["solid"], points=inner)
    d.soft(inner)
    out = 0.3 + 0.1 / 3 * 1000 / (1000 + HOLD)
    d.expected.append((out, out, out))  # a depth of 0.1 / sqrt(3) along the normal
    rest = 4 / 3 * 1.05**3
    d.force("GasVolume", {"Mesh": None, "Volume": rest, "K": 30.0}, mesh=made["solid"])
    d.soft(made["tips"])
    far = brentq(lambda r: HOLD * (r - 1) - 30.0 * (rest / (4 / 3 * r**3) - 1) * 2 * r**2 / 3, 1, 1.05)
    assert far > 1.01
    d.expected.append((0, 0, far))
    d.check(tmp_path)
