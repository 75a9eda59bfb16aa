"""Hydrostatic pressure: gates, buoyancy, a floating box, an energy on closed meshes."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.spatial import ConvexHull, Delaunay

from hookean import Scene, relax
from hookean.system.system import compile

GAMMA = 9.81


def forces_at(x: np.ndarray, faces: Any, level: float, weight: float = GAMMA) -> tuple[np.ndarray, float]:
    """Forces and energy of a liquid on a mesh."""
    force = {"kind": "hydrostatic", "mesh": "m", "weight": weight, "level": level}
    system = compile(Scene(particles=x, meshes={"m": {"vertices": x, "faces": faces}}, forces=[force]))
    f, _, energies = system.evaluate(system.start())
    return f, float(energies.sum())


def gate(seed: int, width: float, height: float) -> tuple[np.ndarray, np.ndarray]:
    """A rectangle in the plane x = 0 with corners at y = 0 and z = 0, of irregular triangles with normals along x."""
    rng = np.random.default_rng(seed)
    inside = rng.uniform(0.05, 0.95, (12, 2)) * [width, height]
    flat = np.vstack([np.array([[0, 0], [1, 0], [1, 1], [0, 1]]) * [width, height], inside])
    faces = Delaunay(flat).simplices
    a, b, c = flat[faces].transpose(1, 0, 2)
    turned = (b - a)[:, 0] * (c - a)[:, 1] < (b - a)[:, 1] * (c - a)[:, 0]
    return np.column_stack([np.zeros(len(flat)), flat]), np.where(turned[:, None], faces[:, ::-1], faces)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("level", [1.1, 2.0])
def test_a_gate_feels_the_triangle_of_pressure(seed: int, level: float) -> None:
    """gamma w h^2 / 2 at h / 3 above the sill, whichever triangles; also where the level cuts them: to rounding."""
    width, height = 1.5, 2.0
    x, faces = gate(seed, width, height)
    f, _ = forces_at(x, faces, level)
    total = 0.5 * GAMMA * width * level**2
    assert f.sum(axis=0) == pytest.approx([total, 0, 0], abs=1e-12 * total)
    assert f[:, 0] @ x[:, 2] == pytest.approx(total * level / 3.0, rel=1e-12)
    assert f[:, 0] @ x[:, 1] == pytest.approx(total * width / 2.0, rel=1e-12)


def test_a_gate_below_the_surface_feels_a_trapezium() -> None:
    """gamma w h (depth of the middle), as all of it is wet; of a quad both cuts give the same."""
    x = np.array([[0, 0, 0], [0, 3, 0], [0, 3, 2], [0, 0, 2.0]])
    f, _ = forces_at(x, [[0, 1, 2, 3]], 5.0, 2.0)
    assert f.sum(axis=0) == pytest.approx([2.0 * 6.0 * 4.0, 0, 0], abs=1e-12)
    assert f[:, 0] @ x[:, 2] == pytest.approx(2.0 * 3.0 * (5.0 * 2.0**2 / 2.0 - 2.0**3 / 3.0), rel=1e-13)


def test_what_is_dry_feels_nothing() -> None:
    """Above the level, and touching it."""
    x, faces = gate(0, 1.0, 1.0)
    assert not forces_at(x, faces, -0.5)[0].any()
    assert not forces_at(x, faces, 0.0)[0].any()


def body(seed: int) -> tuple[np.ndarray, np.ndarray]:
    """A convex body with faces oriented outwards."""
    x = np.random.default_rng(seed).normal(size=(12, 3))
    hull = ConvexHull(x)
    faces = [f if np.linalg.det(x[f] - x.mean(axis=0)) > 0 else f[::-1] for f in hull.simplices]
    return x, np.array(faces)


@pytest.mark.parametrize("seed", range(5))
def test_archimedes(seed: int) -> None:
    """A body in water, -gamma on faces that are oriented outwards: gamma V upwards, through the middle of the volume
    under water (of scipy's hull of the part below the level, its facets cut there): to 1e-12."""
    x, faces = body(seed)
    f, energy = forces_at(x, faces, 0.1, -GAMMA)
    ends = x[np.concatenate([np.roll(faces, i, axis=1)[:, :2] for i in range(3)])]
    low, high = ends[(ends[:, 0, 2] < 0.1) & (ends[:, 1, 2] > 0.1)].transpose(1, 0, 2)
    cut = low + ((0.1 - low[:, 2]) / (high[:, 2] - low[:, 2]))[:, None] * (high - low)
    wet = np.vstack([x[x[:, 2] <= 0.1], cut])
    hull = ConvexHull(wet)
    middle = wet.mean(axis=0)
    cones = wet[hull.simplices] - middle
    volumes = np.abs(np.linalg.det(cones)) / 6.0
    centre = middle + volumes @ cones.sum(axis=1) / 4.0 / hull.volume
    lift = GAMMA * hull.volume
    assert f.sum(axis=0) == pytest.approx([0, 0, lift], abs=1e-12 * lift)
    assert np.cross(x - centre, f).sum(axis=0) == pytest.approx(np.zeros(3), abs=1e-11 * lift)
    # energy: the work of lifting the water that was there to the surface
    assert energy == pytest.approx(lift * (0.1 - centre[2]), rel=1e-11)


@pytest.mark.parametrize("seed", range(3))
def test_on_a_closed_mesh_the_force_is_the_gradient_of_the_energy(seed: int) -> None:
    """By central differences, step 1e-5: to 1e-8 of the largest force (third derivatives of order 1)."""
    x, faces = body(seed)
    f, _ = forces_at(x, faces, 0.1)
    for spot in ((0, 0), (3, 1), (7, 2), (11, 2)):
        energies = []
        for h in (1e-5, -1e-5):
            y = x.copy()
            y[spot] += h
            energies.append(forces_at(y, faces, 0.1)[1])
        assert f[spot] == pytest.approx((energies[1] - energies[0]) / 2e-5, abs=1e-8 * np.abs(f).max())


def test_the_water_line_of_a_floating_box() -> None:
    """W = gamma a b draft, whatever the springs, as the sides are upright: the bottom floats at -W / (gamma a b)."""
    a, b, height, weight = 2.0, 3.0, 1.0, 20.0
    x = np.array([[i, j, k] for k in (0.0, 1.0) for i, j in ((0, 0), (1, 0), (1, 1), (0, 1))]) * [a, b, height]
    faces = [[3, 2, 1, 0], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]]
    forces: list[dict[str, Any]] = [
        {"kind": "hydrostatic", "mesh": "m", "weight": -GAMMA},
        {"kind": "springs", "particles": [[i, i + 4] for i in range(4)], "stiffness": 1e3},
        {"kind": "self_weight", "total": weight},
    ]
    held = [{"particles": range(8), "axes": "xy"}]
    model = Scene(
        particles=x, meshes={"m": {"vertices": x, "faces": faces}}, forces=forces, anchors=held,
        settings={"tolerance": 1e-11},
    )  # fmt: skip
    found = relax(model)
    assert found.converged and found.stability == "stable"
    assert found.particles[:4, 2] == pytest.approx(np.full(4, -weight / (GAMMA * a * b)), abs=1e-9)


@pytest.mark.parametrize("solver", ["auto", "newton"])
def test_water_carries_a_box_that_nothing_else_holds(solver: str) -> None:
    """Without anchors, its edges and diagonals stiff springs: it floats, and no anchor is asked for."""
    x = np.array([[2.0 * i, 3.0 * j, k - 0.3] for k in (0, 1) for j in (0, 1) for i in (0, 1)])
    faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [1, 3, 7, 5], [3, 2, 6, 7], [2, 0, 4, 6]]
    pairs = [[i, j] for i in range(8) for j in range(i)]
    forces: list[dict[str, Any]] = [
        {"kind": "hydrostatic", "mesh": "m", "weight": -GAMMA},
        {"kind": "springs", "particles": pairs, "stiffness": 1e4},
        {"kind": "self_weight", "total": 20.0},
    ]
    model = {"particles": x, "meshes": {"m": {"vertices": x, "faces": faces}}, "forces": forces}
    found = relax(Scene.read({**model, "settings": {"solver": solver, "tolerance": 1e-11}}))
    assert found.converged, found.message
    # as if rigid, but for stresses of some 20 kN by the stiffness, 1e4
    assert found.particles[:4, 2] == pytest.approx(np.full(4, -20.0 / (6.0 * GAMMA)), abs=20.0 / 1e4)


def test_water_ponds_on_a_roof_that_sags() -> None:
    """A flat roof of area A on springs k in all, under water up to a level h above it: it sinks by w until k w =
    gamma A (h + w), w = gamma A h / (k - gamma A): more than the water that stood there first would press it."""
    x = np.array([[0, 0, 0], [2, 0, 0], [2, 3, 0], [0, 3, 0.0]])
    level, stiffness, area = 0.1, 100.0, 6.0
    water = {"kind": "hydrostatic", "mesh": "m", "weight": -GAMMA, "level": level}
    springs = {"kind": "anchor_spring", "particles": range(4), "strength": stiffness / 4}
    guides = [{"particles": range(4), "axes": "xy"}]
    mesh = {"m": {"vertices": x, "faces": [[0, 1, 2, 3]]}}
    scene = Scene(particles=x, meshes=mesh, forces=[water, springs], anchors=guides, settings={"tolerance": 1e-11})
    found = relax(scene)
    assert found.converged and found.stability == "stable"
    assert found.particles[:, 2] == pytest.approx([-GAMMA * area * level / (stiffness - GAMMA * area)] * 4, rel=1e-9)
    assert found.loads["resultant"][0] == pytest.approx(
        [0, 0, -GAMMA * area * (level - found.particles[0, 2])], rel=1e-9, abs=1e-9
    )
