"""Pressure: resultants, volumes, and vessels in equilibrium."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import ConvexHull

from hookean import Scene, relax
from hookean.discretize import grid, naked_vertices, quads
from hookean.forces import Pressure, SoapFilm, Springs
from hookean.running.result import Result
from hookean.system.system import compile
from soak import examples

SEEDED = settings(derandomize=True, deadline=None, max_examples=examples(50), database=None)
seeds = st.integers(0, 2**32 - 1)


def forces_at(x: np.ndarray, faces: Any, y: np.ndarray, p: float = 2.0) -> tuple[np.ndarray, float]:
    """Forces and energy of pressure at y on a mesh that started at x."""
    force = Pressure(mesh="m", pressure=p)
    system = compile(Scene(particles=x, meshes={"m": {"vertices": x, "faces": faces}}, forces=[force]))
    state = system.start()
    state.x = y
    f, _, energies = system.evaluate(state)
    return f, float(energies.sum())


@SEEDED
@given(seeds)
def test_closed_meshes_feel_no_resultant_and_have_an_energy(seed: int) -> None:
    """Any closed mesh: sum f = 0, sum x cross f = 0, E = -p V, f = -dE/dx (differences, 1e-7 of the largest force).

    V by the divergence theorem from the convex hull's own volume; then the hull is deformed.
    """
    rng = np.random.default_rng(seed)
    x = rng.normal(size=(10, 3))
    hull = ConvexHull(x)
    # orient outwards
    faces = [f if np.linalg.det(x[f] - x.mean(axis=0)) > 0 else f[::-1] for f in hull.simplices]
    f, energy = forces_at(x, faces, x)
    assert energy == pytest.approx(-2.0 * hull.volume, rel=1e-12)
    y = x + 0.3 * rng.normal(size=x.shape) + 5.0
    f, _ = forces_at(x, faces, y)
    size = np.abs(f).max()
    assert np.abs(f.sum(axis=0)).max() <= 1e-13 * size
    assert np.abs(np.cross(y, f).sum(axis=0)).max() <= 1e-12 * size
    for spot in ((0, 0), (4, 1), (9, 2)):
        sides = []
        for h in (1e-5, -1e-5):
            z = y.copy()
            z[spot] += h
            sides.append(forces_at(x, faces, z)[1])
        assert f[spot] == pytest.approx((sides[1] - sides[0]) / 2e-5, abs=1e-7 * size)


@SEEDED
@given(seeds)
def test_the_resultant_is_pressure_times_the_area_vector_of_the_rim(seed: int) -> None:
    """Any faces with the same rim: sum f = p sum(r x dr) / 2 around it, quads whichever way they are bent."""
    rng = np.random.default_rng(seed)
    x = rng.normal(size=(5, 3))
    rim = x[:4]
    vector = 0.5 * np.cross(rim, np.roll(rim, -1, axis=0)).sum(axis=0)
    for faces in ([[0, 1, 2, 3]], [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]], [[0, 1, 2, 4], [0, 4, 2, 3]]):
        f, _ = forces_at(x, faces, x)
        assert f.sum(axis=0) == pytest.approx(2.0 * vector, abs=1e-13)


def test_a_corner_takes_a_third_of_its_triangle() -> None:
    """A triangle of area 6 in the plane: 2 p each, along +z where its corners run counter-clockwise seen from there."""
    x = np.array([[0, 0, 0], [4, 0, 0], [0, 3, 0.0]])
    f, _ = forces_at(x, [[0, 1, 2]], x, 5.0)
    assert (f == [0, 0, 10.0]).all()
    assert (forces_at(x, [[2, 1, 0]], x, 5.0)[0] == [0, 0, -10.0]).all()
    assert (forces_at(x, [[0, 1, 2]], x, -5.0)[0] == [0, 0, -10.0]).all()


def solved(x: np.ndarray, faces: Any, forces: list[Any], anchors: list[Any], tolerance: float) -> Result:
    scene = Scene(
        particles=x, meshes={"m": {"vertices": x, "faces": faces}}, forces=forces, anchors=anchors,
        settings={"tolerance": tolerance},
    )  # fmt: skip
    result = relax(scene)
    assert result.converged, result.message
    return result


@pytest.mark.parametrize("n", [3, 7, 24])
def test_a_ring_of_springs_under_pressure(n: int) -> None:
    """R = k L0 / (2 k sin(pi/n) - p cos(pi/n)) to 1e-9: each spring k (2 R sin(pi/n) - L0) carries p R cos(pi/n).

    Two rings 2 apart are the rims of a prism; each bears the pressure on a height of 1. Heights are held.
    """
    k, start, p = 50.0, 1.0, 4.0
    radius = 0.5 * start / np.sin(np.pi / n)
    turn = 2 * np.pi * np.arange(n) / n
    ring = np.column_stack([radius * np.cos(turn), radius * np.sin(turn)])
    x = np.concatenate([np.column_stack([ring, np.full(n, z)]) for z in (-1.0, 1.0)])
    i, j = np.arange(n), (np.arange(n) + 1) % n
    faces = np.column_stack([i, j, j + n, i + n])
    pairs = np.concatenate([np.column_stack([i, j]), np.column_stack([i + n, j + n])])
    springs = Springs(particles=pairs, stiffness=k, rest_length=start)
    held = [{"particles": np.arange(2 * n), "axes": "z"}]
    result = solved(x, faces, [springs, Pressure(mesh="m", pressure=p)], held, 1e-12)
    right = k * start / (2 * k * np.sin(np.pi / n) - p * np.cos(np.pi / n))
    assert np.linalg.norm(result.particles[:, :2], axis=1) == pytest.approx(np.full(2 * n, right), rel=1e-9)
    tension = result.force("springs")["force"]
    assert tension == pytest.approx(np.full(2 * n, p * right * np.cos(np.pi / n)), rel=1e-8)


def test_a_film_in_a_slot_is_an_arc() -> None:
    """Cylinder T = p r: a film between two rails bulges to radius T / p; order 2 (+- 0.1) with n flat strips.

    Strips that are alike inscribe T / (p cos(phi / 2)), phi apart: 2 T sin(phi/2) = p l cos(phi/2), l = 2 R sin(phi/2).
    These begin uneven, and stay that; the height of the arc between rails 1 from its middle is r - sqrt(r^2 - 1).
    """
    tension, p, half, errors = 3.0, 2.0, 1.0, []
    for n in (12, 24, 48):
        i = np.arange(n + 1)
        rows = [np.column_stack([-half + 2 * half * i / n, np.full(n + 1, y), 0 * i]) for y in (0.0, 0.25)]
        x = np.concatenate(rows)
        x[:, 2] = 0.2 * (half**2 - x[:, 0] ** 2)
        faces = np.column_stack([i[:-1], i[1:], i[1:] + n + 1, i[:-1] + n + 1])
        held = [{"particles": [0, n, n + 1, 2 * n + 1]}, {"particles": np.arange(2 * n + 2), "axes": "y"}]
        forces = [SoapFilm(mesh="m", tension=tension), Pressure(mesh="m", pressure=p)]
        y = solved(x, faces, forces, held, 1e-11).particles
        assert np.abs(y[: n + 1, [0, 2]] - y[n + 1 :, [0, 2]]).max() <= 1e-9
        # each fold in turn: 2 T sin(phi/2) = p (l1 + l2) cos(phi/2) / 2, to the square of how unlike its strips are
        u = np.diff(y[: n + 1, [0, 2]], axis=0)
        turn, length = -np.diff(np.arctan2(u[:, 1], u[:, 0])), np.linalg.norm(u, axis=1)
        mean = 0.5 * (length[1:] + length[:-1])
        uneven = np.abs(np.diff(length) / mean).max()
        assert 2 * tension * np.tan(turn / 2) == pytest.approx(p * mean, rel=max(uneven**2, 1e-9))
        errors.append(y[:, 2].max() - (tension / p - np.sqrt((tension / p) ** 2 - half**2)))
    slopes = np.log2(np.abs(np.array(errors[:-1]) / errors[1:]))
    assert slopes == pytest.approx([2, 2], abs=0.1)


def test_a_bubble_on_a_rim_is_a_cap_of_a_sphere() -> None:
    """Sphere T = p r / 2: height r - sqrt(r^2 - a^2) over a rim of radius a, r = 2 T / p; order 2 (+- 0.15)."""
    tension, p, errors = 2.0, 2.5, []
    radius = 2 * tension / p
    right = radius - np.sqrt(radius**2 - 1.0)
    for n in (8, 16, 32):
        t = np.linspace(-1, 1, n + 1)
        u, v = np.meshgrid(t, t, indexing="ij")
        # squares to a disc, without corners that lie on the rim with three neighbours in a row
        x = np.stack([u * np.sqrt(1 - v**2 / 2), v * np.sqrt(1 - u**2 / 2), 0.3 * (1 - u**2) * (1 - v**2)], axis=-1)
        mesh = quads(x)
        forces = [SoapFilm(mesh="m", tension=tension), Pressure(mesh="m", pressure=p)]
        result = solved(mesh.vertices, mesh.faces, forces, [{"particles": naked_vertices(mesh)}], 1e-9)
        errors.append(result.particles[:, 2].max() - right)
    slopes = np.log2(np.abs(np.array(errors[:-1]) / errors[1:]))
    assert slopes == pytest.approx([2, 2], abs=0.15) and abs(errors[-1]) <= 2e-3


@pytest.mark.parametrize(("n", "c"), [(4, 0.0703125), (16, 0.07344577)])
def test_a_net_of_uniform_tension_under_small_pressure(n: int, c: float) -> None:
    """w = c p a^2 / T, n x n squares: c from the five-point Laplacian; 0.0703125 for n 4, 0.07344577 for n 16.

    The net is linear (rest length 0, force T per width); as p -> 0 the pressure's slope terms go as (p a / T)^2.
    """
    side, tension, p = 2.0, 5.0, 1e-4
    t = np.linspace(0, side, n + 1)
    mesh = grid(t, t)
    net = Springs(mesh="m", stiffness=tension, rest_length=0.0)
    held = [{"particles": naked_vertices(mesh)}]
    result = solved(mesh.vertices, mesh.faces, [net, Pressure(mesh="m", pressure=p)], held, 1e-11)
    middle = result.particles[len(mesh.vertices) // 2, 2]
    # half a unit of the last digit given
    assert middle * tension / (p * side**2) == pytest.approx(c, abs=6e-9)


def test_pressure_makes_no_particles_and_is_patched() -> None:
    """Vertices that meet no particle are reported, their faces left out; the pressure changes while it runs."""
    from hookean.running.simulation import Simulation

    x = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0.0]])
    meshes = {"m": {"vertices": [*x, [5, 5, 5]], "faces": [[0, 1, 2], [1, 3, 2]]}}
    scene = Scene(particles=x, meshes=meshes, forces=[Pressure(mesh="m", pressure=6.0)], strict=False)
    system = compile(scene)
    assert len(system.x) == 3 and len(system.groups[0].block.indices) == 1
    assert any("/meshes/m/vertices/3" in u.sentence for u in system.report.unmatched)
    running = Simulation(scene)
    assert running.system.evaluate(running.state)[0][:, 2] == pytest.approx([1, 1, 1])
    running.patch({"forces": {"0": {"pressure": -12.0}}})
    assert running.system.evaluate(running.state)[0][:, 2] == pytest.approx([-2, -2, -2])


@SEEDED
@given(seeds)
def test_the_tangent_of_a_closed_mesh_is_that_of_its_volume(seed: int) -> None:
    """K = -p d2V/dx2 by differences of the forces, to 1e-6: on a closed mesh their sum has an energy."""
    rng = np.random.default_rng(seed)
    x = rng.normal(size=(6, 3))
    hull = ConvexHull(x)
    faces = [f if np.linalg.det(x[f] - x.mean(axis=0)) > 0 else f[::-1] for f in hull.simplices]
    system = compile(Scene(particles=x, meshes={"m": {"vertices": x, "faces": faces}}, forces=[Pressure(mesh="m")]))
    state, (group,) = system.start(), system.groups
    whole = np.zeros((18, 18))
    for index, block in zip(group.block.indices, system.stiffness_blocks(group, state, state.memory[0]), strict=True):
        at = (3 * index[:, None] + np.arange(3)).ravel()
        whole[np.ix_(at, at)] += block
    for spot in ((0, 0), (3, 1), (5, 2)):
        sides = []
        for h in (1e-6, -1e-6):
            y = x.copy()
            y[spot] += h
            sides.append(forces_at(x, faces, y, 1.0)[0])
        slope = (sides[1] - sides[0]) / 2e-6
        assert whole[3 * spot[0] + spot[1]] == pytest.approx(slope.ravel(), abs=1e-6 * np.abs(whole).max())
