"""Convex solids that touch: the energy by scipy's polyhedra, Winkler's foundation, Coulomb's slope, both momenta."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import linprog
from scipy.spatial import ConvexHull, Delaunay, HalfspaceIntersection
from scipy.spatial.transform import Rotation

from hookean import InputError, Scene, relax
from hookean.forces import KINDS
from hookean.forces.rigid_body import TURN, poses
from hookean.running.run import relax_state
from hookean.solvers import solver
from hookean.system.system import compile
from soak import examples

CUBE = np.array([[i & 1, i >> 1 & 1, i >> 2] for i in range(8)]) - 0.5


def solids(bodies: Any, settings: Any = None, held: Any = (), forces: Any = (), **columns: Any) -> Scene:
    """Rigid bodies (a list of corners of each) that collide; some of them held, with other forces."""
    x = np.vstack(bodies)
    group = np.repeat(range(len(bodies)), [len(body) for body in bodies])
    both = {"particles": range(len(x)), "group": group}
    given = [{"kind": "rigid_body", **both, "strength": 1e4}, {"kind": "rigid_collide", **both, **columns}, *forces]
    anchors = [{"particles": np.flatnonzero(group == body)} for body in held]
    return Scene.read({"particles": x, "forces": given, "anchors": anchors, "settings": settings or {}})


def weight(first: int, force: Any, count: int = 8) -> dict[str, Any]:
    """A force on a body, shared by all of its particles."""
    return {"kind": "unary", "particles": range(first, first + count), "vector": np.asarray(force, float) / count}


def energy(bodies: list[np.ndarray], **columns: Any) -> float:
    x = np.vstack(bodies)
    group = np.repeat(range(len(bodies)), [len(body) for body in bodies])
    force = KINDS["rigid_collide"](particles=range(len(x)), group=group, **columns)
    system = compile(Scene(particles=x, forces=[force]))
    return float(system.evaluate(system.start())[2].sum())


def overlap(a: np.ndarray, b: np.ndarray) -> tuple[float, np.ndarray]:
    """Volume and centroid of what two convex hulls share, by scipy's half spaces and tetrahedra."""
    spaces = np.vstack([ConvexHull(a).equations, ConvexHull(b).equations])
    inner = linprog([0, 0, 0, -1], np.column_stack([spaces[:, :3], np.ones(len(spaces))]), -spaces[:, 3],
                    bounds=[(None, None)] * 4)  # fmt: skip
    if inner.status or inner.x[3] < 1e-7:
        return 0.0, np.zeros(3)
    corners = HalfspaceIntersection(spaces, inner.x[:3]).intersections
    cells = corners[Delaunay(corners).simplices]
    volumes = np.abs(np.linalg.det(cells[:, 1:] - cells[:, :1])) / 6.0
    return float(volumes.sum()), volumes @ cells.mean(axis=1) / volumes.sum()


def two(seed: int) -> list[np.ndarray]:
    """A box and some other solid, of any sizes, turned, near each other."""
    rng = np.random.default_rng(seed)
    shapes = [CUBE * rng.uniform(0.5, 3.0, 3), rng.normal(size=(7, 3))]
    if seed % 3 == 0:
        turn = np.arange(6) * np.pi / 3.0
        ring = np.column_stack([np.cos(turn), np.sin(turn), 0 * turn])
        shapes[1] = np.vstack([ring, 0.7 * ring + [0, 0, 1.5]])
    bodies = [s @ Rotation.random(random_state=rng.integers(1e9)).as_matrix().T for s in shapes]
    return [bodies[0], bodies[1] + rng.uniform(0.6, 1.4) * rng.normal(size=3)]


@settings(derandomize=True, deadline=None, max_examples=examples(100), database=None)
@given(seed=st.integers(0, 2**32 - 1))
def test_the_energy_is_the_integral_of_the_depth_below_the_nearest_face(seed: int) -> None:
    """k V d: V the volume of the overlap, d the depth of its centroid below the nearest face, both by scipy; to 1e-6,
    as tetrahedra are."""
    bodies = two(seed)
    volume, middle = overlap(*bodies)
    depth = min(-(ConvexHull(body).equations @ [*middle, 1.0]).max() for body in bodies)
    assert energy(bodies, strength=7.0) == pytest.approx(7.0 * volume * depth, rel=1e-6, abs=1e-9)


def test_crossed_edges_push_each_other_apart() -> None:
    """A ridge on a ridge at right angles, no corner near: boxes on their edges. Apart they feel nothing; twice as deep
    all lengths of the overlap are doubled, and the energy, a volume times a depth, is 16 times as large. The force
    upwards is 4 E / h, and nothing else by symmetry."""
    log = CUBE @ np.diag([8.0, 1.0, 1.0]) @ Rotation.from_euler("x", 45, degrees=True).as_matrix().T
    other = log @ Rotation.from_euler("z", 90, degrees=True).as_matrix().T
    high = 2.0 * math.sqrt(0.5)
    found = [energy([log, other + [0, 0, high - h]], strength=1.0) for h in (-0.01, 0.1, 0.2)]
    assert found[0] == 0.0 and found[1] > 0.0
    assert found[2] == pytest.approx(2.0**4 * found[1], rel=1e-9)
    system = compile(solids([log, other + [0, 0, high - 0.1]], strength=1.0))
    push = system.evaluate(system.start())[0][8:].sum(axis=0)
    assert push[2] == pytest.approx(4.0 * found[1] / 0.1, rel=1e-9)


def crossed_logs(tilt: float = 90.0) -> tuple[list[np.ndarray], float]:
    """Two logs 8 x 1 x 1 on their edges, the second across the first at an angle [degree], both about the origin; how
    far apart their axes are as the edges touch.

    Crossed at right angles and h deep, the overlap at a height z below the upper edge of the first is 2 z by 2 (h - z),
    and z / sqrt(2) below a face on average: E = k int 4 z^2 (h - z) / sqrt(2) dz = k h^4 / (3 sqrt(2)), and
    F = dE/dh = 2 sqrt(2) k h^3 / 3."""
    log = CUBE @ np.diag([8.0, 1.0, 1.0]) @ Rotation.from_euler("x", 45, degrees=True).as_matrix().T
    return [log, log @ Rotation.from_euler("z", tilt, degrees=True).as_matrix().T], math.sqrt(2.0)


def test_a_log_on_the_edge_of_another_sinks_by_its_weight() -> None:
    """A weight on a keel keeps the upper one from rolling. One face presses, so the force is beside the edges by less
    than the depth h; the keel, 7.3 below, leans by less than h / 7.3, and all lengths of the overlap change by less
    than that part. The lower log carries the weight, to the residual."""
    (lower, upper), high = crossed_logs()
    k, load = 1e4, 5.0
    h = (3.0 * load / (2.0 * math.sqrt(2.0) * k)) ** (1.0 / 3.0)
    x = np.vstack([lower, upper + [0, 0, high - 0.5 * h], [[0.0, 0.0, -8.0 + high - 0.5 * h]]])
    group = np.repeat([0, 1], [8, 9])
    forces = [
        {"kind": "rigid_body", "particles": range(17), "group": group, "strength": 1e5},
        {"kind": "rigid_collide", "particles": range(16), "group": group[:16], "strength": k},
        {"kind": "unary", "particles": [16], "vector": [0.0, 0.0, -load]},
    ]
    result = relax(Scene.read({"particles": x, "forces": forces, "anchors": [{"particles": range(8)}]}))
    assert result.status == "converged"
    deep = high - result.particles[8:16].mean(axis=0)[2]
    assert deep == pytest.approx(h, rel=h / 7.3)
    total = result.reactions["force"].sum(axis=0)  # on the lower log: it carries the weight
    assert total == pytest.approx([0.0, 0.0, load], abs=1e-3 * load)


@pytest.mark.parametrize("step", [1e-3, 5e-4])
def test_logs_that_hit_edge_on_edge_keep_the_energy(step: float) -> None:
    """A free log hits the edge of one that is held, m u^2 / 2 = k h^4 / (3 sqrt(2)). It comes as deep as h. All energy
    is kept, to the second order of the step: less than (omega dt)^2 / 4, omega^2 = E'' / m at the deepest. It parts
    with its speed, but for what turns: an impulse 2 m u less than h / 2 beside its axis takes 4 m (h / 2)^2 / I of the
    energy, m = 8 and I = 8 / 2 about that axis."""
    (lower, upper), high = crossed_logs()
    k, h, mass = 1e4, 0.1, 8.0
    kinetic = k * h**4 / (3.0 * math.sqrt(2.0))
    settings = {"solver": "verlet", "time_step": step, "drag": 0.0}
    system = compile(solids([lower, upper + [0, 0, high + 0.01]], settings, [0], strength=k))
    state = system.start()
    state.v[8:] = [0.0, 0.0, -math.sqrt(2.0 * kinetic / mass)]
    deepest, whole, method = 0.0, [], solver("verlet")
    for _ in range(round(1.6 / step / 20)):
        method.advance(system, state, 20, 0.0)
        whole.append(float(system.evaluate(state)[2].sum() + 0.5 * (state.v[8:] ** 2).sum()))
        deepest = max(deepest, high - state.x[8:].mean(axis=0)[2])
    omega = math.sqrt(2.0 * math.sqrt(2.0) * k * h**2 / mass)
    assert np.abs(np.array(whole) / kinetic - 1.0).max() <= (omega * step) ** 2 / 4.0
    assert deepest == pytest.approx(h, rel=1e-3)
    assert 1.0 - 8.0 * (0.5 * h) ** 2 < 0.5 * mass * (state.v[8:].mean(axis=0) ** 2).sum() / kinetic <= 1.0


def on_slab(load: Any, k: float = 1e5, **columns: Any) -> tuple[np.ndarray, np.ndarray]:
    """Where the centre of a cube of 1 comes to rest on a held slab, and its rotation, by what is on its top corners."""
    slab, cube = CUBE * [4, 4, 1] - [0, 0, 0.5], CUBE + [0.3, -0.2, 0.5]
    force = {"kind": "unary", "particles": range(12, 16), "vector": np.column_stack([np.zeros((4, 2)), load])}
    scene = solids([slab, cube], {"tolerance": 1e-9}, [0], [force], strength=k, **columns)
    found = relax(scene)
    assert found.converged
    block = compile(scene).groups[0].block
    pose = poses(block, found.particles)[8]
    return pose[:3] - cube.mean(axis=0), pose[TURN : TURN + 9].reshape(3, 3)


def test_a_box_sinks_by_its_weight_over_k_times_the_area() -> None:
    """Winkler: depth F / (k A), rotation M / (k I), I = 1/12, so that the centre at a height of 1/2 moves, too. Loads
    that go with the box turn it by another part, F / (k I), 1.2e-3, twice over."""
    k, loads = 1e5, np.array([-2.0, -2.0, -3.0, -3.0])
    moved, turn = on_slab(loads, k, friction=0.5)
    angle = 0.5 * (loads[2:].sum() - loads[:2].sum()) / (k / 12.0)  # forces at y = -1/2 and 1/2
    assert moved == pytest.approx([0.0, -0.5 * angle, -10.0 / k], abs=3e-3 * 10.0 / k)
    assert Rotation.from_matrix(turn).as_rotvec() == pytest.approx([angle, 0.0, 0.0], abs=3e-3 * abs(angle))


def test_a_load_outside_the_core_lifts_one_edge() -> None:
    """At e from the centre of a width b, b / 6 < e < b / 2, the contact is 3 (b / 2 - e) long, and deepest at the edge
    by 2 F / (3 w (b / 2 - e) k) (Hetenyi, Beams on Elastic Foundation, 1946). The load goes with the box by its height
    times the rotation, 2e-4, which is a part of 2e-3 of b / 2 - e, and of all that follows."""
    k, loads = 1e6, np.array([-0.5, -0.5, -4.5, -4.5])
    e, total = 0.5 * 8.0 / 10.0, 10.0
    moved, turn = on_slab(loads, k, friction=0.5)
    deepest, length = 2.0 * total / (3.0 * (0.5 - e) * k), 3.0 * (0.5 - e)
    edges = moved[2] + 0.5 + turn[2, 1] * np.array([-0.5, 0.5]) - 0.5 * turn[2, 2]
    assert edges == pytest.approx([-deepest + deepest / length, -deepest], rel=1e-2)


def slope(tangent: float, **given: Any) -> tuple[Scene, np.ndarray]:
    """A box of weight 8 on a held plank of some slope, friction 0.5, and the directions down the slope and off it."""
    turn = Rotation.from_euler("y", math.atan(tangent)).as_matrix()
    plank, box = (CUBE * [9, 3, 1] - [0, 0, 0.5]) @ turn.T, (CUBE + [-2, 0, 0.5]) @ turn.T
    scene = solids([plank, box], given, [0], [weight(8, [0, 0, -8.0])], strength=1e4, friction=0.5)
    return scene, turn[:, [0, 2]]


@pytest.mark.parametrize("tangent", [0.2, 0.3, 0.45])
def test_a_box_on_another_rests_below_the_angle_of_friction(tangent: float) -> None:
    """It sinks by N / k and creeps by T / k while it sticks; the moment T / 2 of its weight about the contact turns it
    by T / 2 / (k I - N / 2), I = 1/12, the centre moving along by half of that; to 2e-3. Beyond tan a = 1/3 it stands
    on a part of its face alone, and moves by more. It stays there in time."""
    scene, directions = slope(tangent, tolerance=1e-10)
    system = compile(scene)
    state = system.start()
    assert relax_state(system, state, solver("relaxation")).converged
    moved, k, angle = (state.x - system.x)[8:].mean(axis=0) @ directions, 1e4, math.atan(tangent)
    down, normal = 8.0 * math.sin(angle), 8.0 * math.cos(angle)
    known = down / k + 0.25 * down / (k / 12.0 - 0.5 * normal)
    if tangent < 1.0 / 3.0:
        assert moved == pytest.approx([known, -normal / k], rel=2e-3)
    assert moved[0] < 1.2 * known
    rest = state.x.copy()
    solver("verlet").advance(system, state, 500, 0.0)
    assert np.abs(state.x - rest).max() < 1e-3 * known


def test_more_boxes_than_a_slab_has_corners_stay_on_it() -> None:
    """Twelve boxes of weight 1 on a held slab of eight corners, each pushed by 0.3 with friction 0.5: all sink by
    1 / (k A), and none slides in time, by 1e-6 of that. A box without friction would by 0.3 t^2 / 16, 0.019."""
    slab, boxes = CUBE * [26, 4, 1] + [11.5, 0, -0.5], [CUBE + [2.0 * i, 0, 0.5] for i in range(12)]
    load = {"kind": "unary", "particles": range(8, 104), "vector": [0.3 / 8.0, 0.0, -1.0 / 8.0]}
    given = {"tolerance": 1e-9, "time_step": 0.002, "drag": 0.0}
    system = compile(solids([slab, *boxes], given, [0], [load], strength=1e4, friction=0.5))
    state = system.start()
    assert relax_state(system, state, solver("relaxation")).converged
    sunk = (system.x - state.x)[8:, 2].reshape(12, 8).mean(axis=1)
    assert sunk == pytest.approx(np.full(12, 1e-4), rel=1e-3)
    rest = state.x.copy()
    solver("verlet").advance(system, state, 500, 0.0)
    assert np.abs(state.x - rest).max() < 1e-6 * 1e-4


def test_a_box_on_another_slides_above_the_angle_of_friction() -> None:
    """By g (sin a - 0.5 cos a) t^2 / 2 (Coulomb): the second difference of three places, which it vibrates about as it
    is let go, by up to some 8e-4 each; 2 per cent of it."""
    scene, directions = slope(0.7, solver="verlet", time_step=0.002, drag=0.0)
    system = compile(scene)
    state, places = system.start(), []
    for _ in range(3):
        solver("verlet").advance(system, state, 600, 0.0)
        places.append(float((state.x[8:].mean(axis=0) @ directions)[0]))
    angle = math.atan(0.7)
    known = (math.sin(angle) - 0.5 * math.cos(angle)) * 1.2**2
    assert places[2] - 2.0 * places[1] + places[0] == pytest.approx(known, rel=0.02)


def test_bodies_that_meet_keep_both_momenta() -> None:
    """Spinning boxes that hit each other off their centres, with friction: to rounding, 1e-11 of the sizes."""
    bodies = [CUBE, CUBE @ Rotation.from_euler("xyz", [0.4, 0.5, 0.6]).as_matrix().T + [1.4, 0.5, 0.3]]
    given = {"solver": "verlet", "time_step": 0.001, "drag": 0.0}
    system = compile(solids(bodies, given, strength=1e4, friction=0.4))
    state = system.start()
    state.v[:8] = [2.0, 0.0, 0.0]
    state.v[8:] = np.cross([3.0, -2.0, 5.0], state.x[8:] - state.x[8:].mean(axis=0))
    before = state.v.sum(axis=0), np.cross(state.x, state.v).sum(axis=0), state.v.copy()
    solver("verlet").advance(system, state, 1000, 0.0)
    assert np.abs(state.v - before[2]).max() > 1.0
    assert state.v.sum(axis=0) == pytest.approx(before[0], abs=1e-10)
    assert np.cross(state.x, state.v).sum(axis=0) == pytest.approx(before[1], abs=1e-10)


def test_what_sticks_gains_no_energy_on_a_closed_way() -> None:
    """A box that rocks, turns and shifts on a slab with its whole face in contact, and comes back, has had no work done
    on it: its friction acts at the middle of the area, that of k |s|^2 on each part of it. Where the pressure has its
    middle, it would do 7 % of all work done. Slips are 2e-3 of the size, so that work of third order is below 1e-3."""
    at = 2.0 * np.pi * np.arange(32) / 32
    turns = Rotation.from_rotvec(np.column_stack([0.0 * at, 0.01 * np.cos(at), 0.02 * np.sin(at)]))
    foot = CUBE + [0.0, 0.0, 0.5]
    ways = np.array([r.apply(foot) + [0, 0.002 * np.cos(2 * a), -0.006] for r, a in zip(turns, at, strict=True)])
    slab = CUBE * [4.0, 4.0, 1.0] - [0.0, 0.0, 0.5]
    system = compile(solids([slab, foot - [0.0, 0.0, 0.006]], friction=1e9))
    state, forces = system.start(), []
    for place in ways:
        state.x[8:] = place
        forces.append(system.evaluate(state)[0][8:].copy())
    work = 0.5 * (forces * (np.roll(ways, -1, axis=0) - np.roll(ways, 1, axis=0))).sum(axis=(1, 2))
    assert abs(work.sum()) < 1e-3 * np.abs(work).sum()


def test_forces_do_not_depend_on_when_the_list_of_neighbours_was_made() -> None:
    """To the bit: with the list of a shape before, a new one, and none."""
    rng = np.random.default_rng(1)
    bodies = [CUBE * rng.uniform(0.5, 1.5, 3) + rng.uniform(0.0, 4.0, 3) for _ in range(40)]
    system = compile(solids(bodies, friction=0.3))
    state, room = system.start(), system.groups[1].block.rooms[0]
    first = system.evaluate(state)[0]
    state.x += rng.uniform(-0.01, 0.01, state.x.shape)  # less than half of the skin
    found = []
    for count, pairs in ((room[0, 3], room[0, 1]), (-1.0, room[0, 1]), (-1.0, 3.0)):
        room[0, 3], room[0, 1] = count, pairs
        found.append(system.evaluate(state))
    assert np.abs(found[0][0] - first).max() > 0.0
    for other in found[1:]:
        assert all((a == b).all() for a, b in zip(found[0], other, strict=True))


def test_solids_of_one_collision_group_ignore_each_other() -> None:
    """Two cubes half in each other: nothing if they are of one group, k ab h^2 / 2 if not."""
    bodies = [CUBE, CUBE * [2, 2, 1] + [0, 0, 0.9]]
    assert energy(bodies, strength=3.0) == pytest.approx(3.0 * 0.5 * 0.1**2, rel=1e-9)
    assert energy(bodies, strength=3.0, collision_group=[1] * 16) == 0.0
    assert energy(bodies, strength=[3.0] * 8 + [1.0] * 8, collision_group=[0] * 16) == pytest.approx(0.005, rel=1e-9)


@pytest.mark.parametrize("size", [0.0, 1e-300])
def test_a_solid_without_a_size_is_refused(size: float) -> None:
    force = {"kind": "rigid_collide", "particles": range(8)}
    with pytest.raises(InputError, match=r"/forces/0: the 8 corners of a solid .all particles. are at one place"):
        compile(Scene.read({"particles": CUBE * size, "forces": [force]}))


@pytest.mark.parametrize("x", [CUBE[:3], CUBE * [1, 1, 0]])
def test_a_flat_solid_is_refused(x: np.ndarray) -> None:
    force = {"kind": "rigid_collide", "particles": range(len(x))}
    with pytest.raises(InputError, match=r"/forces/0: the . corners of a solid .all particles. lie in a plane"):
        compile(Scene.read({"particles": x, "forces": [force]}))


@pytest.mark.parametrize("solver", ["auto", "relaxation"])
@pytest.mark.parametrize("shift", [0.0, 0.05, -0.24])
def test_a_solid_inside_another_is_not_at_rest(shift: float, solver: str) -> None:
    """A cube of half the size within another: the volume they share and the depth of its centroid are constant, so
    nothing pushes them, though they overlap. In one collision group they do not feel each other, and may rest."""
    small = 0.5 * CUBE + [shift, 0.0, 0.0]
    found = relax(solids([CUBE, small], {"solver": solver}))
    assert not found.converged
    assert "the solid of particle 8 lies inside that of particle 0, and nothing pushes it out" in found.message
    assert relax(solids([CUBE, small], {"solver": solver}, collision_group=[1] * 16)).converged


def test_solids_at_one_place_part() -> None:
    """Two equal cubes: the nearest face of one pushes the other out, as far as it must."""
    found = relax(solids([CUBE, CUBE]))
    apart = found.particles[8:].mean(axis=0) - found.particles[:8].mean(axis=0)
    assert found.converged and np.abs(apart).max() >= 1.0 - 1e-9
