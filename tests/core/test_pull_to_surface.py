"""Pulls to NURBS surfaces: those that are spheres, cylinders and tori exactly, and any others against brute force."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize

from hookean import Scene, relax
from hookean.discretize import NurbsSurface, nurbs_surface
from hookean.errors import InputError
from hookean.forces import PullToSurface
from hookean.system.system import compile
from soak import examples

SEEDED = settings(derandomize=True, deadline=None, max_examples=examples(25), database=None)
H = np.sqrt(0.5)
CIRCLE = np.array([[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1], [1, 0.0]])
ROUND = np.array([1, H, 1, H, 1, H, 1, H, 1])
QUARTERS = [0, 0, 1, 1, 2, 2, 3, 3, 4, 4]


def revolved(profile: Any, weights: Any, degree: int, knots: Any) -> NurbsSurface:
    """A profile of radii and heights (n, 2) turned about z, exactly (The NURBS Book, 8.5)."""
    profile = np.asarray(profile, float)
    points = [[[r * c, r * s, z] for r, z in profile] for c, s in CIRCLE]
    return nurbs_surface(2, degree, points, QUARTERS, knots, np.outer(ROUND, weights))


def sphere(radius: float) -> NurbsSurface:
    profile = radius * np.array([[0, -1], [1, -1], [1, 0], [1, 1], [0, 1.0]])
    return revolved(profile, [1, H, 1, H, 1], 2, [0, 0, 1, 1, 2, 2])


def cylinder(radius: float, height: float) -> NurbsSurface:
    return revolved([[radius, 0], [radius, height]], [1, 1], 1, [0, 1])


def torus(major: float, minor: float) -> NurbsSurface:
    return revolved(minor * CIRCLE + [major, 0.0], ROUND, 2, QUARTERS)


def pulled(x: np.ndarray, surface: Any) -> tuple[np.ndarray, float]:
    """Vectors to the closest points, and the energy with S = 2."""
    force = PullToSurface.on(surface, particles=range(len(x)), strength=2.0)
    system = compile(Scene(particles=x, forces=[force]))
    f, _, energies = system.evaluate(system.start())
    return f / 2.0, float(energies.sum())


def off_sphere(x: np.ndarray) -> np.ndarray:
    return (2.0 / np.linalg.norm(x, axis=1) - 1.0)[:, None] * x


def off_cylinder(x: np.ndarray) -> np.ndarray:
    flat = np.linalg.norm(x[:, :2], axis=1)
    return np.column_stack([(1.5 / flat - 1.0)[:, None] * x[:, :2], np.clip(x[:, 2], 0.0, 3.0) - x[:, 2]])


def off_torus(x: np.ndarray) -> np.ndarray:
    flat = np.linalg.norm(x[:, :2], axis=1)
    ring = np.column_stack([2.0 / flat[:, None] * x[:, :2], 0.0 * flat])
    return (0.7 / np.linalg.norm(x - ring, axis=1) - 1.0)[:, None] * (x - ring)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("surface", "expected"),
    [(sphere(2.0), off_sphere), (cylinder(1.5, 3.0), off_cylinder), (torus(2.0, 0.7), off_torus)],
    ids=["sphere", "cylinder", "torus"],
)
@SEEDED
@given(seed=st.integers(0, 2**32 - 1))
def test_of_exact_surfaces_the_distance_is_exact(surface: NurbsSurface, expected: Any, seed: int) -> None:
    """Within, without and beyond their ends, over seams and quarters, to 1e-13; E = S d^2 / 2."""
    x = np.random.default_rng(seed).uniform(-3.0, 4.0, (30, 3))
    found, energy = pulled(x, surface)
    assert found == pytest.approx(expected(x), abs=1e-13)
    assert energy == pytest.approx((expected(x) ** 2).sum(), rel=1e-13)


@pytest.mark.parametrize(("u", "v"), [(1e9, 1e-9), (1e-11, 1e11), (1e-300, 1.0), (1.0, 5e-324)])
def test_the_scale_of_knots_does_not_count(u: float, v: float) -> None:
    """Knots that are longer by a factor move along the same surface, only slower: |r - 2| from a sphere."""
    x, ball = np.random.default_rng(4).normal(size=(30, 3)), sphere(2.0)
    off, _ = pulled(x, replace(ball, knots_u=ball.knots_u * u, knots_v=ball.knots_v * v))
    assert off == pytest.approx(off_sphere(x), abs=1e-12)


def test_on_poles_seams_and_axes_distances_are_right() -> None:
    """Where a parameter has no direction, several points are closest, or the surface was cut to have an end."""
    along = np.array(
        [[0, 0, 3.0], [0, 0, -1.0], [3.0, 0, 0], [1e-9, 0, 3.0], [0, -3.0, 0], [2.0, -1e-12, 0], [0, 0, 0]]
    )
    distance = np.linalg.norm(pulled(along, sphere(2.0))[0], axis=1)
    assert distance == pytest.approx(np.abs(np.linalg.norm(along, axis=1) - 2.0), abs=1e-13)


@pytest.mark.soak
@SEEDED
@given(seed=st.integers(0, 2**32 - 1))
def test_of_any_surface_the_distance_is_that_of_a_minimiser(seed: int) -> None:
    """Degrees 1 to 4, weights 0.5 to 2, knots repeated or not: from the nearest of 60 x 60 samples downhill by scipy
    (L-BFGS-B, to 1e-6 here), nowhere farther, and the point found is on the surface."""
    rng = np.random.default_rng(seed)
    degrees, counts = rng.integers(1, 5, 2), rng.integers(5, 8, 2)
    points = np.stack(np.meshgrid(*(np.arange(n, dtype=float) for n in counts), [0.0], indexing="ij"), -1)[:, :, 0]
    points += rng.uniform(-0.5, 0.5, points.shape)
    knots = []
    for p, n in zip(degrees, counts, strict=True):
        inner = np.sort(rng.integers(1, 6, n - p - 1))
        inner = [k for k in inner.tolist() if inner.tolist().count(k) <= p]
        while len(inner) < n - p - 1:
            inner.append(inner[-1] + 1 if inner else 1)
        knots.append([0] * (p + 1) + sorted(inner) + [max([*inner, 5]) + 1] * (p + 1))
    surface = nurbs_surface(int(degrees[0]), int(degrees[1]), points, *knots, rng.uniform(0.5, 2.0, counts))
    x = rng.uniform(-2.0, 8.0, (5, 3))
    found, _ = pulled(x, surface)
    bounds = [surface.domain_u, surface.domain_v]
    us, vs = (np.linspace(*bound, 60) for bound in bounds)
    grid = surface.points_at(us, vs)
    for i in range(5):
        apart = ((grid - x[i]) ** 2).sum(axis=2)
        a, b = np.unravel_index(np.argmin(apart), apart.shape)

        def square(t: np.ndarray, p: np.ndarray = x[i]) -> float:
            return float(((surface.point_at(*t) - p) ** 2).sum())

        best = minimize(square, [us[a], vs[b]], bounds=bounds, method="L-BFGS-B").fun
        assert np.linalg.norm(found[i]) <= np.sqrt(min(best, apart.min())) + 1e-6


def test_a_sphere_of_rhino3dm_and_its_numbers_are_the_same() -> None:
    """Given as a surface, as plain numbers as a scene stores them, and as those of the NURBS Book."""
    rhino3dm = pytest.importorskip("rhino3dm")
    x = np.random.default_rng(3).uniform(-3.0, 4.0, (20, 3))
    ball = rhino3dm.NurbsSurface.CreateFromSphere(rhino3dm.Sphere(rhino3dm.Point3d(0, 0, 0), 2.0))
    force = PullToSurface.on(ball, particles=range(20), strength=2.0)
    again = Scene.read(Scene(particles=x, forces=[force]).model_dump_json()).forces[0]
    assert again == force
    assert pulled(x, ball)[0] == pytest.approx(off_sphere(x), abs=1e-13)
    assert (pulled(x, again.surface())[0] == pulled(x, ball)[0]).all()


def test_a_weight_slides_to_the_bottom_of_a_sphere_and_pulls_it_by_its_part_of_the_stiffness() -> None:
    """Nothing holds it back along the surface: at rest at z = -(R + P / S), below the middle."""
    strength, load = 50.0, 3.0
    forces = [
        PullToSurface.on(sphere(2.0), particles=[0], strength=strength),
        {"kind": "unary", "particles": [0], "vector": [0, 0, -load]},
    ]
    for solver in ("relaxation", "newton"):
        found = relax(
            Scene(particles=[[1.3, 0.9, 1.0]], forces=forces, settings={"tolerance": 1e-11, "solver": solver})
        )
        assert found.converged
        assert found.particles == pytest.approx(np.array([[0.0, 0.0, -2.0 - load / strength]]), abs=1e-9)
        assert found.forces[0]["distance"] == pytest.approx([load / strength], rel=1e-9)


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"degree_u": 2}, "/forces/0/control_points: 2 points for degree 2 in one direction; at least 3 expected"),
        ({"knots_u": [0, 1, 2]}, "/forces/0/knots_u: 3 knots for 2 points of degree 1; 4 expected, or Rhino's 2"),
        ({"weights": [[1, 1], [1, 0]]}, "/forces/0/weights: contain 0; positive numbers expected"),
        ({"weights": [[1, 1]]}, r"/forces/0/weights: have the shape \[1, 2\]; one for each point, \[2, 2\], expected"),
        ({"knots_v": [1, 1]}, "/forces/0/knots_v: do not ascend"),
    ],
)
def test_the_numbers_of_a_surface_fit_each_other(fields: Any, message: str) -> None:
    force = {"kind": "pull_to_surface", "particles": [0], "control_points": np.zeros((2, 2, 3)), "knots_u": [0, 1]}
    force |= {"knots_v": [0, 1], "degree_u": 1, "degree_v": 1, **fields}
    with pytest.raises(InputError, match=message):
        Scene(particles=[[0, 0, 0]], forces=[force])


@pytest.mark.parametrize(
    ("surface", "message"),
    [("ball", "str is not a surface; give degree_u"), ({"degree_u": 1}, "degree_v is missing; a surface has degree_u")],
)
def test_what_is_no_surface_is_refused(surface: Any, message: str) -> None:
    with pytest.raises(InputError, match=message):
        PullToSurface.on(surface, particles=[0])
