"""Pulls to curves and meshes: the closest point against brute force, and particles that end there."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize

from hookean import Scene, relax
from hookean.compiled.dispatch import keep, rows
from hookean.discretize import grid
from hookean.errors import InputError
from hookean.forces import PullToCurve, PullToMesh, Unary
from hookean.running.simulation import Simulation
from hookean.system.system import compile
from soak import examples

SEEDED = settings(derandomize=True, deadline=None, max_examples=examples(60), database=None)
seeds = st.integers(0, 2**32 - 1)
EPS = float(np.finfo(float).eps)


def on_segments(p: np.ndarray, a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Closest points (m, 3) of segments a-b (m, 3) to p, one by one."""
    e = b - a
    ee = (e * e).sum(axis=1)
    t = np.clip(((p - a) * e).sum(axis=1) / np.where(ee > 0, ee, 1.0), 0.0, 1.0)
    return a + t[:, None] * e


def on_triangles(p: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """Closest points (m, 3) of triangles (m, 3, 3) to p: by barycentric coordinates, else on the three edges."""
    a, b, c = corners.transpose(1, 0, 2)
    best = on_segments(p, a, b)
    for other in (on_segments(p, b, c), on_segments(p, c, a)):
        nearer = ((other - p) ** 2).sum(axis=1) < ((best - p) ** 2).sum(axis=1)
        best = np.where(nearer[:, None], other, best)
    for i, (u, v) in enumerate(zip(b - a, c - a, strict=True)):
        gram = np.array([[u @ u, u @ v], [u @ v, v @ v]])
        if np.linalg.det(gram) > 1e-12 * gram[0, 0] * gram[1, 1]:
            s, t = np.linalg.solve(gram, [u @ (p - a[i]), v @ (p - a[i])])
            if s > 0 and t > 0 and s + t < 1:
                best[i] = a[i] + s * u + t * v
    return best


def pulled(force: Any, x: np.ndarray, meshes: Any = None) -> tuple[np.ndarray, np.ndarray]:
    """The force on every particle, and what `measure` says of distances."""
    system = compile(Scene(particles=x, meshes=meshes or {}, forces=[force]))
    state = system.start()
    f, w, energies = system.evaluate(state)
    block = system.groups[0].block
    told = force.measure(block, state.x, system.element_forces(system.groups[0], state, state.memory[0]))
    assert energies.sum() == pytest.approx(0.5 * (told["force"] * (f / w[:, None])).sum(), rel=1e-12)
    return f, told["distance"]


@pytest.mark.slow
@SEEDED
@given(seeds, st.integers(1, 60))
def test_the_closest_point_of_a_mesh(seed: int, count: int) -> None:
    """Any heap of triangles and quads, needles and faces without area too: as near as brute force, to 1e-12."""
    rng = np.random.default_rng(seed)
    vertices = rng.normal(size=(count + 3, 3)).round(int(rng.integers(0, 3)))
    faces = rng.integers(0, len(vertices), (count, 4))
    faces[::2, 3] = faces[::2, 2]
    x = 2.0 * rng.normal(size=(20, 3)).round(int(rng.integers(0, 3)))
    f, distance = pulled(PullToMesh(particles=np.arange(20), vertices=vertices, faces=faces, strength=7.0), x)
    quads = faces[faces[:, 2] != faces[:, 3]]
    threes = np.concatenate([faces[:, :3], quads[:, [0, 2, 3]], quads[:, [0, 1, 3]], quads[:, [1, 2, 3]]])
    for i, p in enumerate(x):
        found = on_triangles(p, vertices[threes])
        apart = np.linalg.norm(found - p, axis=1)
        assert distance[i] == pytest.approx(apart.min(), abs=1e-12 * (1 + apart.min()))
        reached = p + f[i] / 7.0
        near = found[apart <= apart.min() + 1e-9]
        assert np.linalg.norm(near - reached, axis=1).min() <= 1e-7


@SEEDED
@given(seeds, st.integers(2, 80), st.booleans())
def test_the_closest_point_of_a_curve(seed: int, count: int, closed: bool) -> None:
    """Any polyline, doubled points too, open and closed: as near as brute force, to 1e-12."""
    rng = np.random.default_rng(seed)
    curve = np.cumsum(rng.normal(size=(count, 3)).round(int(rng.integers(0, 3))), axis=0)
    x = np.concatenate([3.0 * rng.normal(size=(20, 3)), curve[:3]])
    _, distance = pulled(PullToCurve(particles=np.arange(len(x)), curve=curve, closed=closed, strength=7.0), x)
    after = np.roll(curve, -1, axis=0)
    end = count if closed else count - 1
    right = [np.linalg.norm(on_segments(p, curve[:end], after[:end]) - p, axis=1).min() for p in x]
    assert distance == pytest.approx(np.array(right), abs=1e-12 * (1 + max(right)))


def test_closest_in_the_sense_of_a_minimiser() -> None:
    """The brute force itself, for one triangle: constrained minimisation over barycentric coordinates (SLSQP)."""
    rng = np.random.default_rng(2)
    for _ in range(10):
        corners, p = rng.normal(size=(3, 3)), 2 * rng.normal(size=3)
        found = minimize(
            lambda s: ((s[0] * corners[0] + s[1] * corners[1] + (1 - s[0] - s[1]) * corners[2] - p) ** 2).sum(),  # noqa: B023
            [0.3, 0.3], bounds=[(0, 1), (0, 1)], constraints={"type": "ineq", "fun": lambda s: 1 - s[0] - s[1]},
            tol=1e-14,
        )  # fmt: skip
        apart = np.linalg.norm(on_triangles(p, corners[None])[0] - p)
        assert apart**2 == pytest.approx(found.fun, abs=1e-7)


def test_of_equal_distances_the_first_face_wins() -> None:
    """Six walls of a room about its centre, in any order of the list: pulled to the one given first."""
    x = np.zeros((1, 3))
    walls = []
    for axis in range(3):
        for side in (-1.0, 1.0):
            u, v = np.eye(3)[(axis + 1) % 3], np.eye(3)[(axis + 2) % 3]
            middle = side * np.eye(3)[axis]
            walls.append(np.array([middle - 4 * u - 4 * v, middle + 8 * u - 4 * v, middle - 4 * u + 8 * v]))
    for first in range(6):
        order = [first, *[i for i in range(6) if i != first]]
        vertices = np.concatenate([walls[i] for i in order])
        faces = np.arange(18).reshape(6, 3)
        f, _ = pulled(PullToMesh(particles=[0], vertices=vertices, faces=faces, strength=1.0), x)
        assert f[0] == pytest.approx(np.sign(first % 2 - 0.5) * np.eye(3)[first // 2], abs=4 * EPS)
    square = np.array([[1, 1, 0], [-1, 1, 0], [-1, -1, 0], [1, -1, 0.0]])
    f, _ = pulled(PullToCurve(particles=[0], curve=square, closed=True, strength=1.0), x)
    assert f[0] == pytest.approx([0, 1, 0], abs=4 * EPS)


def wave(n: int) -> tuple[np.ndarray, np.ndarray]:
    """A wavy mesh of n x n quads over [-2, 2]^2."""
    t = np.linspace(-2, 2, n + 1)
    mesh = grid(t, t, 0.3 * np.outer(np.sin(t), np.cos(t)))
    return mesh.vertices, mesh.faces


def test_particles_end_on_the_mesh() -> None:
    """Without loads: on it, to tolerance; under a load P each is P / S away, along the load (normal to its face)."""
    vertices, faces = wave(12)
    rng = np.random.default_rng(3)
    x = np.column_stack([rng.uniform(-1.5, 1.5, (40, 2)), rng.uniform(-1.0, 1.0, 40)])
    meshes = {"hill": {"vertices": vertices, "faces": faces}}
    pull = PullToMesh(particles=np.arange(40), target="hill", strength=200.0)
    free = relax(Scene(particles=x, meshes=meshes, forces=[pull], settings={"tolerance": 1e-10}))
    assert free.converged and len(free.particles) == 40
    assert free.force("pull_to_mesh")["distance"].max() <= 1e-9
    flat = {"hill": {"vertices": vertices * [1, 1, 0], "faces": faces}}
    down = Unary(particles=np.arange(40), vector=[0, 0, -3.0])
    loaded = relax(Scene(particles=x, meshes=flat, forces=[pull, down], settings={"tolerance": 1e-10}))
    assert loaded.converged and loaded.particles[:, 2] == pytest.approx(np.full(40, -3.0 / 200.0), rel=1e-8)
    assert loaded.particles[:, :2] == pytest.approx(x[:, :2], abs=1e-12)
    assert loaded.force("pull_to_mesh")["distance"] == pytest.approx(np.full(40, 3.0 / 200.0), rel=1e-8)


def test_particles_end_on_the_curve() -> None:
    """Points about a circle of 400 pieces end at its radius, less at most the piece's sagitta 2 pi^2 / 400^2 / 4."""
    turn = 2 * np.pi * np.arange(400) / 400
    circle = np.column_stack([np.cos(turn), np.sin(turn), 0 * turn])
    rng = np.random.default_rng(4)
    x = rng.normal(size=(30, 3))
    pull = PullToCurve(particles=np.arange(30), curve=circle, closed=True, strength=50.0)
    result = relax(Scene(particles=x, forces=[pull], settings={"tolerance": 1e-10}))
    assert result.converged and result.force("pull_to_curve")["distance"].max() <= 1e-9
    radius = np.linalg.norm(result.particles[:, :2], axis=1)
    assert radius.max() <= 1 + 1e-9 and radius.min() >= np.cos(np.pi / 400) - 1e-9
    assert np.abs(result.particles[:, 2]).max() <= 1e-9
    load = Unary(particles=np.arange(30), vector=[0, 0, 2.0])
    lifted = relax(Scene(particles=x, forces=[pull, load], settings={"tolerance": 1e-10}))
    assert lifted.particles[:, 2] == pytest.approx(np.full(30, 2.0 / 50.0), rel=1e-8)


def test_strength_zero_pulls_not_at_all() -> None:
    """No hard constraint hides behind it."""
    vertices, faces = wave(2)
    x = np.array([[0.1, 0.2, 3.0]])
    for force in (
        PullToMesh(particles=[0], vertices=vertices, faces=faces, strength=0.0),
        PullToCurve(particles=[0], curve=[[0, 0, 0], [1, 0, 0]], strength=0.0),
    ):
        system = compile(Scene(particles=x, forces=[force]))
        f, w, energies = system.evaluate(system.start())
        assert not f.any() and not w.any() and energies.sum() == 0.0


def test_two_targets_in_one_scene_and_a_new_curve_while_it_runs() -> None:
    """Forces of one kind share a block, each with its own target; a patch retargets."""
    x = np.array([[0.5, 1.0, 0.0], [0.5, -1.0, 0.0]])
    low, high = [[0, -2, 0], [1, -2, 0]], [[0, 3, 0], [1, 3, 0]]
    forces = [PullToCurve(particles=[0], curve=high), PullToCurve(particles=[1], curve=[*low, [2, -2, 0]])]
    result = relax(Scene(particles=x, forces=forces))
    assert result.particles[:, 1] == pytest.approx([3, -2])
    running = Simulation(Scene(particles=x, forces=forces))
    running.patch({"forces": {"0": {"curve": [[0, 7, 0], [1, 7, 0], [2, 7, 0]]}}})
    assert running.relax().particles[:, 1] == pytest.approx([7, -2])


@pytest.mark.parametrize(
    ("force", "says"),
    [
        ({"kind": "pull_to_curve", "particles": [0], "curve": [[0, 0, 0]]}, "/forces/0/curve: 1 points given"),
        ({"kind": "pull_to_mesh", "particles": [0]}, "/forces/0: give the name of a mesh as target"),
        (
            {"kind": "pull_to_mesh", "particles": [0], "target": "m", "vertices": [[0, 0, 0]]},
            "/forces/0: give the name",
        ),
        ({"kind": "pull_to_mesh", "particles": [0], "vertices": [[0, 0, 0]], "faces": []}, "/faces: a target without"),
        ({"kind": "pull_to_mesh", "particles": [0], "vertices": [[0, 0, 0]], "faces": [[0, 1, 2]]}, "a vertex beyond"),
        ({"kind": "pull_to_mesh", "particles": [0], "target": "hill"}, "mesh 'hill' does not exist; the scene has 'm'"),
        ({"kind": "pull_to_mesh", "particles": [0], "target": "empty"}, "without faces"),
    ],
)
def test_bad_targets_are_refused(force: dict[str, Any], says: str) -> None:
    """With the place and one sentence."""
    if force.get("target") == "empty":
        meshes: dict[str, Any] = {"empty": {"vertices": [[0, 0, 0]], "faces": []}}
    else:
        meshes = {"m": {"vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "faces": [[0, 1, 2]]}}
    with pytest.raises(InputError, match=says):
        compile(Scene.read({"particles": [[0, 0, 0]], "meshes": meshes, "forces": [force]}))


def test_kept_tables_are_copies_and_kept_once() -> None:
    """The table behind an address does not change with the array it came from; equal tables share an address."""
    given_table = np.arange(12.0).reshape(4, 3)
    address = keep(given_table)
    assert keep(given_table.copy()) == address != keep(given_table.reshape(3, 4))
    given_table[:] = 0.0
    assert (rows(address, 4.0, 3) == np.arange(12.0).reshape(4, 3)).all()
