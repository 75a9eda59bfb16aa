"""Spheres against solids: sides by winding numbers, closest points by brute force, rest positions in closed form."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.test_pulls import on_triangles
from hookean import Scene, relax
from hookean.compiled.dispatch import compiled
from hookean.errors import InputError
from hookean.forces import CollideSolid
from hookean.forces.collide_solid import GRID, solid_kernel
from hookean.system.system import compile
from laws import laws
from laws.cases import case_of
from soak import examples

SEEDED = settings(derandomize=True, deadline=None, max_examples=examples(60), database=None)
seeds = st.integers(0, 2**32 - 1)
SIDES = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]


def box(size: float = 2.0) -> dict[str, Any]:
    """A box about the origin, in quads turned outwards."""
    corners = np.array([[i & 1, i >> 1 & 1, i >> 2] for i in range(8)]) - 0.5
    return {"vertices": size * corners, "faces": SIDES}


def ball(around: int, up: int) -> tuple[np.ndarray, np.ndarray]:
    """A unit sphere in triangles, with corners on it."""
    turn, rise = 2 * np.pi * np.arange(around) / around, np.pi * np.arange(1, up) / up
    ring = np.stack(
        [
            np.outer(np.sin(rise), np.cos(turn)),
            np.outer(np.sin(rise), np.sin(turn)),
            np.outer(np.cos(rise), 1 + 0 * turn),
        ],
        axis=2,
    )
    vertices = np.vstack([ring.reshape(-1, 3), [[0, 0, 1], [0, 0, -1]]])
    i, top = np.arange(around), around * (up - 1)
    j, last = (i + 1) % around, top - around
    faces = [np.column_stack([0 * i + top, i, j]), np.column_stack([last + i, 0 * i + top + 1, last + j])]
    for k in range(up - 2):
        a, b = around * k + i, around * k + j
        faces += [np.column_stack([a, a + around, b]), np.column_stack([b, a + around, b + around])]
    return vertices, np.concatenate(faces)


def spiked(seed: int) -> tuple[np.ndarray, np.ndarray]:
    """A ball with radii of 0.3 to 2 at its corners: spikes and pits."""
    vertices, faces = ball(7, 5)
    return vertices * np.random.default_rng(seed).uniform(0.3, 2.0, (len(vertices), 1)), faces


def winding(p: np.ndarray, corners: np.ndarray) -> float:
    """How often triangles (m, 3, 3) go round p (van Oosterom and Strackee, "The solid angle of a plane triangle")."""
    a, b, c = (corners - p).transpose(1, 0, 2)
    x, y, z = (np.linalg.norm(one, axis=1) for one in (a, b, c))
    below = x * y * z + (a * b).sum(1) * z + (b * c).sum(1) * x + (c * a).sum(1) * y
    return float(np.arctan2((a * np.cross(b, c)).sum(1), below).sum() / (2 * np.pi))


def evaluated(x: Any, **fields: Any) -> tuple[np.ndarray, np.ndarray, float]:
    """Force and depth of particles, and the energy."""
    x = np.asarray(x, float)
    force = CollideSolid(particles=range(len(x)), **fields)
    system = compile(Scene(particles=x, forces=[force]))
    f, _, energies = system.evaluate(system.start())
    group = system.groups[0]
    return f, force.measure(group.block, x, f[:, None])["depth"], float(energies.sum())


@pytest.mark.slow
@pytest.mark.parametrize("inside", [False, True])
@SEEDED
@given(seed=seeds)
def test_the_depth_is_that_of_the_winding_number_and_the_closest_point(inside: bool, seed: int) -> None:
    """On solids with spikes and pits, near their corners too: d = r - s or r + s, |s| by brute force and its sign by
    the winding number; the force is k d along the way to the closest point. Distances have errors of a few eps."""
    rng = np.random.default_rng(seed)
    vertices, faces = spiked(seed)
    corners = vertices[faces]
    near = vertices[rng.integers(0, len(vertices), 10)] + 0.1 * rng.normal(size=(10, 3))
    x, radius, k = np.concatenate([rng.uniform(-2, 2, (10, 3)), near]), rng.uniform(0.0, 0.4, 20), 7.0
    f, depth, energy = evaluated(x, vertices=vertices, faces=faces, radius=radius, inside=inside, strength=k)
    expected = np.zeros(20)
    for i, p in enumerate(x):
        found = on_triangles(p, corners)
        apart = np.linalg.norm(found - p, axis=1)
        within = winding(p, corners) > 0.5
        expected[i] = max(radius[i] + (apart.min() if within != inside else -apart.min()), 0.0)
        if expected[i] > 0.0:
            way = (found[np.argmin(apart)] - p) / apart.min() * (1.0 if within != inside else -1.0)
            ties = np.linalg.norm(found[apart <= apart.min() + 1e-9] - found[np.argmin(apart)], axis=1).max()
            assert np.abs(f[i] - k * expected[i] * way).max() <= 1e-9 or ties > 1e-6
    assert depth == pytest.approx(expected, abs=1e-12)
    assert energy == pytest.approx(0.5 * k * (expected**2).sum(), rel=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("inside", [False, True])
def test_with_both_sides_force_and_tangent_obey_the_laws(inside: bool) -> None:
    """Off the edges of spikes and pits, with radii: the gradient, its slope, and a bound of it."""
    vertices, faces = spiked(3)
    rng = np.random.default_rng(5)
    x = vertices[:20] * rng.uniform(0.8, 1.2, (20, 1))
    force = CollideSolid(
        particles=range(20), vertices=vertices, faces=faces, inside=inside, radius=0.5, strength=rng.uniform(1, 9, 20)
    )
    case = case_of("spiked", force, x)
    assert (np.abs(case.force(x)[0]).max(axis=1) > 0).sum() >= 10
    for seed in range(20):
        laws.force_is_the_gradient(case, np.random.default_rng(seed), 0.02)
        laws.tangent_is_the_gradient_of_the_force(case, np.random.default_rng(seed), 0.02)
        laws.lumped_stiffness_bounds_the_tangent(case, np.random.default_rng(seed), 0.02)


@pytest.mark.parametrize("solver", ["auto", "relaxation", "newton"])
@pytest.mark.parametrize(("inside", "rest"), [(False, 1.0 + 0.2), (True, -1.0 + 0.2)])
def test_a_weight_sinks_in_by_its_part_of_the_stiffness(solver: str, inside: bool, rest: float) -> None:
    """P / k: on the top of a box z = 1 + r - P / k, in it, at the bottom, z = -1 + r - P / k."""
    weight, k = 3.0, 200.0
    scene = Scene(
        particles=[[0.3, 0.1, 0.9 if inside else 1.15]],
        meshes={"box": box()},
        forces=[
            {
                "kind": "collide_solid",
                "particles": [0],
                "target": "box",
                "inside": inside,
                "radius": 0.2,
                "strength": k,
            },
            {"kind": "unary", "particles": [0], "vector": [0, 0, -weight]},
        ],
        anchors=[{"particles": [0], "axes": "xy"}],
        settings={"solver": solver, "tolerance": 1e-10},
    )
    if inside and solver == "newton":
        scene = scene.replaced(particles=[[0.3, 0.1, -0.85]])  # without a contact nothing is stiff
    found = relax(scene)
    assert found.converged
    assert found.particles[0] == pytest.approx([0.3, 0.1, rest - weight / k], abs=1e-9)
    assert found.force("collide_solid")["depth"] == pytest.approx([weight / k], rel=1e-8)


@pytest.mark.soak
def test_a_cloth_on_a_ball_is_carried_by_it_and_by_its_rim() -> None:
    """Contacts and reactions carry the weight W, to the residual; nothing is deeper in the ball than W / k."""
    count, k, weight = 13, 2000.0, 0.5
    t = np.linspace(-1.6, 1.6, count)
    x = np.column_stack([np.repeat(t, count), np.tile(t, count), np.full(count * count, 1.05)])
    number = np.arange(count * count).reshape(count, count)
    pairs = np.concatenate(
        [
            np.column_stack([number[:-1].ravel(), number[1:].ravel()]),
            np.column_stack([number[:, :-1].ravel(), number[:, 1:].ravel()]),
        ]
    )
    vertices, faces = ball(24, 12)
    rim = np.unique(np.concatenate([number[0], number[-1], number[:, 0], number[:, -1]]))
    x[rim, 2] = 0.2
    scene = Scene(
        particles=x,
        meshes={"ball": {"vertices": vertices, "faces": faces}},
        forces=[
            {"kind": "springs", "particles": pairs, "stiffness": 50.0, "rest_factor": 0.9},
            {"kind": "collide_solid", "particles": range(count**2), "target": "ball", "strength": k},
            {"kind": "unary", "particles": range(count**2), "vector": [0, 0, -weight]},
        ],
        anchors=[{"particles": rim}],
        settings={"tolerance": 1e-8},
    )
    found = relax(scene)
    assert found.converged
    contact = found.force("collide_solid")
    touching = contact["depth"] > 0.0
    assert touching.sum() > 20
    total = weight * count**2
    assert contact["force"][:, 2].sum() + np.sum(found.reactions["force"], axis=0)[2] == pytest.approx(total, rel=1e-6)
    radius = np.linalg.norm(found.particles[touching], axis=1)
    assert radius.max() <= 1.0 and contact["depth"].max() <= np.abs(contact["force"]).sum() / k


def test_a_mesh_means_the_same_turned_inwards_unwelded_and_in_triangles() -> None:
    """Vertices of each face of their own, as Rhino has them; faces all turned inwards; quads and triangles."""
    x = 1.5 * np.random.default_rng(1).uniform(-1, 1, (40, 3))
    vertices, faces = box()["vertices"], np.array(SIDES)
    f, _, _ = evaluated(x, vertices=vertices, faces=faces, radius=0.3)
    assert np.abs(f).max() > 0.0
    other = [
        (vertices, faces[:, ::-1]),
        (vertices[faces].reshape(-1, 3), np.arange(24).reshape(6, 4)),
        (vertices, np.concatenate([faces[:, [0, 1, 3]], faces[:, [1, 2, 3]]])),
    ]
    for points, corners in other:
        assert np.abs(evaluated(x, vertices=points, faces=corners, radius=0.3)[0] - f).max() <= 1e-9


def test_on_the_surface_a_sphere_is_pushed_out_along_the_normal() -> None:
    """Centres exactly on a face, an edge and a corner of a box: k r along the normal, the mean of two, of three."""
    x = [[1.0, 0.2, 0.1], [1.0, 1.0, 0.1], [1.0, 1.0, 1.0]]
    f, _, _ = evaluated(x, **box(), radius=0.5, strength=2.0)
    assert f == pytest.approx(np.array([[1, 0, 0], [0.5**0.5, 0.5**0.5, 0], [3**-0.5] * 3]), abs=1e-15)


def test_a_strength_of_zero_and_what_is_free_have_no_force() -> None:
    x = [[0.5, 0.1, 0.2], [5.0, 0.0, 0.0]]
    f, depth, energy = evaluated(x, **box(), strength=[0.0, 10.0])
    assert not f.any() and not depth.any() and energy == 0.0


OPEN = SIDES[:-1]
TURNED = [*SIDES[:-1], SIDES[-1][::-1]]


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({**box(), "faces": OPEN}, "/forces/0/faces: the mesh is not closed at the edge of vertices"),
        ({**box(), "faces": TURNED}, "/forces/0/faces: the mesh is not closed at the edge of vertices"),
        ({**box(), "faces": [[0, 1, 3], [3, 1, 0]]}, "/forces/0/faces: the mesh encloses no volume"),
        ({**box(0.0)}, "/forces/0/faces: all faces are without an area"),
        (
            {"vertices": [[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0], [0, 0, 1]],
             "faces": [[0, 1, 2], [1, 0, 3], [2, 1, 3], [0, 2, 4], [2, 3, 4], [3, 0, 4]]},
            "/forces/0/faces: the face of vertices 0, 1 and 2 has no area",
        ),
        ({"target": "open"}, "/meshes/open/faces: the mesh is not closed at the edge of vertices"),
        ({"target": "box", **box()}, "/forces/0: give the name of a mesh as target, or vertices and faces"),
        ({"target": "box", "radius": -1.0}, "/forces/0/radius"),
    ],
)  # fmt: skip
def test_a_solid_is_a_closed_mesh(fields: Any, message: str) -> None:
    meshes = {"box": box(), "open": {**box(), "faces": OPEN}}
    with pytest.raises(InputError, match=message):
        force = {"kind": "collide_solid", "particles": [0], **fields}
        compile(Scene(particles=[[0.0, 0.0, 2.0]], meshes=meshes, forces=[force]))


@pytest.mark.parametrize("inside", [False, True])
def test_the_grid_of_distances_changes_no_bit_of_any_contact(inside: bool) -> None:
    """Spheres all about a spiked ball, on it and in it: forces, energy and stiffness with the grid and without it."""
    vertices, faces = spiked(5)
    rng = np.random.default_rng(7)
    x = np.vstack([rng.uniform(-3, 3, (400, 3)), vertices, vertices * 1.001, 0.05 * vertices])
    force = {"kind": "collide_solid", "particles": np.arange(len(x)), "vertices": vertices, "faces": faces}
    force |= {"radius": rng.uniform(0.0, 0.2, len(x)), "strength": 10.0, "inside": inside}
    group = compile(Scene.read({"particles": x, "forces": [force]})).groups[0]
    kernel, found = compiled(solid_kernel, "force"), []
    for grid in (group.block.parameters[:, GRID], 0.0):
        table, f, w = group.block.parameters.copy(), np.zeros_like(x), np.zeros(len(x))
        table[:, GRID] = grid
        energy = kernel(x, np.zeros_like(x), group.block.indices, table, group.block.memory, f, w)
        found.append((energy, f, w))
    for one, other in zip(*found, strict=True):
        np.testing.assert_array_equal(one, other)
    touching = np.abs(found[0][1]).sum(axis=1) > 0
    assert 0.05 < touching.mean() < 0.99
