"""How a shape is judged: the residual by its definition, whatever is held and whatever touches it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as some

from hookean import Scene, Simulation, relax
from hookean.running.watch import PATIENCE, Watch
from hookean.solvers import solver
from hookean.system.balance import BEYOND, NOISE, OUT, ROUNDING, Balance, balance
from hookean.system.state import State
from hookean.system.system import System, compile
from soak import examples


def judged(seed: int, *, loads: bool, floor: bool) -> tuple[System, State, Balance]:
    """Eight particles in disorder, springs between them, some held on some axes."""
    rng = np.random.default_rng(seed)
    pairs = [[a, b] for a in range(8) for b in range(a)]
    forces = [{"kind": "springs", "particles": pairs, "stiffness": rng.uniform(1.0, 1e3, len(pairs))}]
    if loads:
        forces.append({"kind": "unary", "particles": [0, 3, 4], "vector": rng.normal(size=(3, 3))})
    axes = ["x", "yz", "xyz"]
    spec = {
        "particles": rng.normal(size=(8, 3)) + [0.0, 0.0, 5.0 * floor],
        "forces": forces,
        "anchors": [{"particles": [int(p)], "axes": axes[int(p) % 3]} for p in rng.permutation(8)[:4]],
        "settings": {"floor": {"point": [0.0, 0.0, 5.0]}} if floor else {},
    }
    system = compile(Scene.read(spec))
    state = system.start()
    state.x += rng.normal(size=(8, 3)) * (not floor)
    return system, state, balance(system, state)


@settings(max_examples=examples(60), derandomize=True, deadline=None)
@given(seed=some.integers(0, 2**32 - 1), loads=some.booleans(), floor=some.booleans())
def test_the_residual_is_what_its_definition_says(seed: int, loads: bool, floor: bool) -> None:
    """max |out of balance| / mean |load| on the free axes; reactions and what is left add up to all forces; the floor
    u (w |x| + |f| + |load|) / scale, |x| the largest of the elements at a particle, which here are all; beyond it what
    is more than its own particle's. Sums in another order: 8 terms, 16 roundings at most."""
    system, state, found = judged(seed, loads=loads, floor=floor)
    f, w, _ = system.evaluate(state)
    left = f * state.free
    contact = system.support(state, left)
    close = {"rtol": 16 * ROUNDING, "atol": 0.0}
    assert np.array_equal(found.forces, left) and np.array_equal(found.contact, contact)
    assert np.array_equal(found.reactions, -(f + contact) * (1.0 - state.free))
    sizes = np.linalg.norm(left, axis=1)
    assert found.worst == np.argmax(sizes)
    np.testing.assert_allclose(found.out_of_balance, sizes.max(), **close)
    load = np.linalg.norm(system.evaluate(state, only="load")[0] * state.free, axis=1)
    if loads and load.any():
        np.testing.assert_allclose(found.scale, load[load > 0.0].mean(), **close)
    noise = ROUNDING * (w * np.abs(state.x).max() + np.abs(f).max(axis=1) + load)
    np.testing.assert_allclose(found.floor * found.scale, noise[state.free.any(axis=1)].max(), rtol=1e-14)
    np.testing.assert_allclose(found.residual, sizes.max() / found.scale, rtol=1e-14)
    np.testing.assert_allclose(found.beyond * found.scale, sizes[sizes > noise].max(initial=0.0), rtol=1e-14)


@pytest.mark.parametrize("axes", [[0], [1], [2], [0, 1, 2]])
@pytest.mark.parametrize("particle", [0, 5])
def test_a_number_that_is_none_is_told(particle: int, axes: list[int]) -> None:
    """A coordinate that is not a number leaves a residual that is none: nothing calls that balanced."""
    system, state, _ = judged(1, loads=True, floor=False)
    state.free[:] = 1.0
    state.x[particle, axes] = np.nan
    found = balance(system, state)
    assert np.isnan(found.residual) and not found.met(1e9)


def test_where_nothing_may_move_nothing_is_out_of_balance() -> None:
    """All is held: no component, no force left, measured by a force of 1."""
    spec = {"particles": [[0, 0, 0], [1, 0, 0]], "forces": [{"kind": "springs", "particles": [[0, 1]]}]}
    system = compile(Scene.read({**spec, "anchors": [{"particles": [0, 1]}]}))
    found = balance(system, system.start())
    assert (found.part, found.residual, found.out_of_balance, found.scale, found.worst) == (-1, 0.0, 0.0, 1.0, 0)
    assert found.met(1e-9) and found.goal(1e-9) == 1e-9
    assert relax(system.scene).converged


@pytest.mark.parametrize("count", [1, 2, 5])
def test_what_nothing_strains_is_measured_by_a_millionth_of_what_it_resists(count: int) -> None:
    """A row of springs at their rest lengths without loads: the scale is the mean over the particles that may move of
    1e-6 x stiffness x extent of the elements there, as a force that strains by 1e-6 leaves."""
    rng = np.random.default_rng(count)
    apart, stiffness = rng.uniform(1.0, 2.0, count + 1), rng.uniform(1.0, 1e3, count + 1)
    x = np.zeros((count + 2, 3))
    x[1:, 0] = np.cumsum(apart)
    springs = {"kind": "springs", "particles": [[i, i + 1] for i in range(count + 1)], "stiffness": stiffness}
    spec = {"particles": x, "forces": [springs], "anchors": [{"particles": [0, count + 1]}]}
    system = compile(Scene.read(spec))
    found = balance(system, system.start())
    bound = 2.0 * (stiffness[1:] + stiffness[:-1])  # 2 k at each end, above any tangent of a spring
    extent = np.maximum(apart[1:], apart[:-1])
    assert found.scale == pytest.approx(1e-6 * (bound * extent).mean(), rel=1e-9)


some_parts = some.lists(some.tuples(*[some.sampled_from([0.0, 0.5, 1.0, 2.0, 3.0])] * 3), min_size=1, max_size=4)


@settings(max_examples=examples(200), derandomize=True, deadline=None)
@given(parts=some_parts, scale=some.sampled_from([0.5, 1.0, 4.0]), tolerance=some.sampled_from([0.1, 1.0, 2.5]))
def test_the_goal_is_the_least_force_that_meets_the_tolerance(
    parts: list[tuple[float, float, float]], scale: float, tolerance: float
) -> None:
    """The larger of tolerance and rounding floor, of the component where that is least; but the tolerance alone in one
    that rests within its floor while one of its particles has more left than the tolerance and its own rounding."""
    _, _, found = judged(1, loads=True, floor=False)
    columns = np.zeros((len(parts), 9))
    columns[:, [OUT, BEYOND, NOISE]] = np.array(parts) * scale
    goals = []
    for residual, beyond, noise in parts:
        hidden = residual <= noise and beyond > tolerance
        goals.append(tolerance if hidden else max(tolerance, noise))
    found = replace(found, found=columns, scales=np.full(len(parts), scale))
    assert found.goal(tolerance) == min(goals) * scale


def link(stiff: float, solver: str) -> Scene:
    """A soft cable of three springs under loads of 1 N, and beside it a stiff chain, 1000 km from the origin."""
    x = np.array([[0, 0], [1, 0], [2, 0], [3, 0], [0, 5], [1, 5], [2, 5]], float)
    forces = [
        {"kind": "springs", "name": "soft", "particles": [[0, 1], [1, 2], [2, 3]], "stiffness": 1.0},
        {"kind": "springs", "name": "stiff", "particles": [[4, 5], [5, 6]], "stiffness": stiff},
        {"kind": "unary", "particles": [1, 2], "vector": [0.0, 0.0, -1.0]},
    ]
    spec = {
        "particles": np.column_stack([x + [1e6, 0.0], np.zeros(7)]),
        "forces": forces,
        "anchors": [{"particles": [0, 3, 4, 6]}],
        "settings": {"solver": solver},
    }
    return Scene.read(spec)


@pytest.mark.parametrize("solver", ["auto", "relaxation", "newton", "momentum"])
def test_what_is_stiff_does_not_excuse_what_is_soft(solver: str) -> None:
    """Rounding leaves 4.4 N of a stiffness of 1e10 at 1e6, and nothing of one of 1: the cable hangs as it does beside a
    soft chain. The tolerance leaves 1e-6 N at a particle, which a stiffness of 0.01 N/m, far below any that is here,
    turns into 1e-4 m."""
    alone, beside = relax(link(1.0, solver)), relax(link(1e10, solver))
    assert alone.converged and beside.converged
    assert beside.components["rounding_floor"] * beside.components["force_scale"] == pytest.approx(
        [4.4e-10, 4.4], rel=0.1
    )
    assert np.abs(beside.particles[:4] - alone.particles[:4]).max() <= 1e-4
    assert beside.particles[1, 2] < -1.9


def chain(stiffness: object, **more: object) -> Scene:
    """Six particles in a row under pre-tension, without a load."""
    springs = {"kind": "springs", "name": "s", "particles": [[i, i + 1] for i in range(5)], "rest_factor": 0.8}
    anchors = [{"name": "a", "particles": [0]}, {"name": "b", "particles": [5], **more}]
    x = [[i, 0, 0] for i in range(6)]
    spec = {"particles": x, "forces": [{**springs, "stiffness": stiffness}], "anchors": anchors}
    return Scene.read({**spec, "settings": {"solver": "relaxation"}})


@pytest.mark.parametrize("stiffness", [1e3, 1.0, 1e-3])
def test_after_a_patch_forces_are_measured_by_those_of_now(stiffness: float) -> None:
    """A chain a million times softer than before, and with another end, is as near to rest as one made like that."""
    running = Simulation(chain(1e6))
    running.relax()
    moved = {"move": [{"anchor": "b", "targets": [[5.0, 2.0, 0.0]]}]}
    running.patch({"forces": {"s": {"stiffness": stiffness}}, **moved})
    found, made = running.relax(), relax(chain(stiffness, targets=[[5.0, 2.0, 0.0]]))
    assert found.converged and made.converged
    assert np.abs(found.particles - made.particles).max() <= 1e-4


def test_the_energy_is_that_of_what_has_yielded() -> None:
    """Two springs that both bear 50 N, one of 1000 N/m that yields, one of 2000 N/m: T^2 / 2k each."""
    springs = {"kind": "springs", "name": "s", "particles": [[0, 1], [1, 2]], "stiffness": [1000, 2000]}
    limits = {"rest_length": [0.5, 1.0], "plasticity": [0.1, 0.0]}
    spec = {"particles": [[0, 0, 0], [1, 0, 0], [2, 0, 0]], "forces": [{**springs, **limits}]}
    scene = Scene.read({**spec, "anchors": [{"particles": [0, 2]}]})
    running = Simulation(scene)
    tension = relax(scene).force("s")["force"]
    expected = float((tension**2 / [2000.0, 4000.0]).sum())
    for found in (relax(scene), running.relax(), running.result()):
        assert found.energy["springs"] == pytest.approx(expected, rel=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize(("load", "solver"), [(3.0, "relaxation"), (3.0, "auto"), (2.0, "auto"), (2.0, "multilevel")])
def test_a_run_that_stalls_returns_its_best_shape(load: float, solver: str) -> None:
    """A spring on its lower cutoff works or does not: the load is left over, or the spring's 10 N and more less it.
    These runs end at the worse of the two."""
    springs = {"kind": "springs", "particles": [[0, 1]], "stiffness": 100, "rest_length": 1.0, "lower_cutoff": 1.1}
    weight = {"kind": "unary", "particles": [1], "vector": [0.0, 0.0, -load]}
    spec = {"particles": [[0, 0, 0], [0, 0, -1]], "forces": [springs, weight], "anchors": [{"particles": [0]}]}
    seen: list[float] = []
    found = relax(Scene.read({**spec, "settings": {"solver": solver}}), progress=lambda _, left: seen.append(left))
    assert found.status == "stalled" and found.residual == min(seen) < max(seen)
    assert found.out_of_balance == pytest.approx(load)


def test_a_run_whose_energy_still_falls_has_not_stalled() -> None:
    """Spheres that settle have less energy long before they have a better residual. A load of 3 N on a spring goes down
    by 0.01, by 1e-9 more, up, and down by 0.02. Only the first and the last lower the energy by more than the work of
    the goal's force along the model."""
    spec = {"particles": [[0, 0, 0], [0, 0, -1]], "anchors": [{"particles": [0]}]}
    weight = {"kind": "unary", "particles": [1], "vector": [0.0, 0.0, -3.0]}
    springs = {"kind": "springs", "particles": [[0, 1]], "stiffness": 100, "rest_length": 1.0}
    system = compile(Scene.read({**spec, "forces": [springs, weight]}))
    state = system.start()
    watch = Watch(system, state, solver("relaxation"))
    state.iteration = 1
    watch.look(system, state)
    watch.best = 0.0  # a residual that is never reached again
    for down, status in ((0.01, "running"), (0.01 + 1e-9, "stalled"), (0.0, "stalled"), (0.02, "running")):
        state.x[1, 2] = -1.0 - down
        state.iteration += PATIENCE + 3
        assert watch.look(system, state) == status


def test_a_part_that_falls_stalls() -> None:
    """Nothing supports two spheres beside a stiff spring: they fall and have less energy, which is no progress."""
    spec = {"particles": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 0.05, -0.19]], "anchors": [{"particles": [0]}]}
    forces = [
        {"kind": "unary", "particles": [1], "vector": [0, 0, -1.0]},
        {"kind": "springs", "particles": [[0, 2]], "stiffness": 1e6, "rest_length": 0.5},
        {"kind": "collide", "particles": [1, 3], "radius": 0.1, "strength": 1e5},
    ]
    found = relax(Scene.read({**spec, "forces": forces, "settings": {"solver": "relaxation"}}))
    assert found.status == "stalled" and "Nothing supports" in found.message


def test_a_spring_that_begins_without_length_is_told() -> None:
    """Its ends are two particles at one place: in balance, and the highest energy of all."""
    springs = {"kind": "springs", "particles": [[0, 1], [1, 2]], "rest_length": [1.0, 2.0]}
    spec = {"particles": [[0, 0, 0], [0, 0, 0], [2, 0, 0]], "anchors": [{"particles": [0, 2]}]}
    said = relax(Scene.read({**spec, "forces": [springs]})).report.warnings
    assert len(said) == 1 and said[0].startswith("/forces/0: 1 of 2 elements have zero length (first: element 0)")
    assert not relax(Scene.read({**spec, "forces": [{**springs, "rest_length": 0.0}]})).report.warnings


CANCEL = [[0.1, 0.2, -0.3], [1e4, -1e4 * (1.0 + 2.0**-52)], [1e-9, 1e9, -1e9 - 1e-9]]


@pytest.mark.parametrize("solver", ["auto", "newton", "relaxation"])
@pytest.mark.parametrize("loads", CANCEL)
def test_loads_that_cancel_but_for_rounding_are_none(loads: list[float], solver: str) -> None:
    """Three chords of a taut string: the sum of their loads is some 1e-17 of them, and the residual is that of the
    string without loads, which is measured by its forces: to the rounding of those, 1e-13 of them."""
    string = {"kind": "springs", "particles": [[0, 1], [1, 2], [2, 3]], "stiffness": 1000.0, "rest_factor": 0.9}
    spec = {"particles": [[0, 0, 0], [1, 0, 0.1], [2, 0, 0.2], [3, 0, 0]], "anchors": [{"particles": [0, 3]}]}
    forces = [{"kind": "unary", "particles": [1, 2], "vector": [0, 0, load]} for load in loads]
    plain, found = (
        relax(Scene.read({**spec, "forces": [string, *more], "settings": {"solver": solver}})) for more in ([], forces)
    )
    assert plain.converged and found.converged, found.message
    assert np.abs(found.particles - plain.particles).max() <= 1e-6
    assert found.residual <= 1e-6 and found.rounding_floor == pytest.approx(plain.rounding_floor, rel=1e-6)


def test_loads_that_cancel_need_no_support() -> None:
    """A bar without anchors under 0.1 + 0.2 - 0.3 at each end, which is 5.6e-17; but 1e-10 counts."""
    forces = [{"kind": "unary", "particles": [0, 1], "vector": [0, 0, load]} for load in (0.1, 0.2, -0.3)]
    spec = {"particles": [[0, 0, 0], [1, 0, 0]], "forces": [{"kind": "springs", "particles": [[0, 1]]}, *forces]}
    assert relax(Scene.read(spec)).converged
    forces.append({"kind": "unary", "particles": [0, 1], "vector": [0, 0, 1e-10]})
    found = relax(Scene.read({**spec, "forces": [spec["forces"][0], *forces]}))
    assert not found.converged and "Nothing supports" in found.message


def test_a_small_load_beside_large_ones_that_cancel_counts() -> None:
    """One particle carries 1 N and -1 N, the other 1e-3 N: the scale is that of the other."""
    forces = [{"kind": "unary", "particles": [1], "vector": [0, 0, load]} for load in (0.3, 0.6, -0.9)]
    forces.append({"kind": "unary", "particles": [2], "vector": [0, 0, -1e-3]})
    string = {"kind": "springs", "particles": [[0, 1], [1, 2], [2, 3]], "stiffness": 1.0, "rest_factor": 0.9}
    spec = {"particles": [[i, 0, 0] for i in range(4)], "anchors": [{"particles": [0, 3]}]}
    system = compile(Scene.read({**spec, "forces": [string, *forces]}))
    assert balance(system, system.start()).scale == pytest.approx(1e-3, rel=1e-12)
