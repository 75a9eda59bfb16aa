"""Multigrid solves what direct solvers solve, in steps that hardly grow; the multilevel solver ends where others do."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sparse
from scipy.sparse.linalg import spsolve

from hookean import Scene, relax
from hookean.linear.block_cg import solve
from hookean.linear.block_hierarchy import Hierarchy
from hookean.linear.tangent import Tangent
from hookean.linear.tangent_blocks import Blocks
from hookean.running.watch import PATIENCE, Watch
from hookean.solvers import auto, multilevel, solver
from hookean.stability import nets
from hookean.system.state import State
from hookean.system.system import compile


def net(side, *, axes="xyz", load=-20.0, factor=0.5, ramp=0.0, extra=()):
    """A square net of side² particles on 10 x 10, held at its corners (and its middle, 2 higher)."""
    line = np.linspace(0.0, 10.0, side)
    x, y = np.meshgrid(line, line, indexing="ij")
    points = np.column_stack([x.ravel(), y.ravel(), ramp * x.ravel()])
    at = np.arange(side * side).reshape(side, side)
    springs = [np.stack([at[:-1], at[1:]], -1), np.stack([at[:, :-1], at[:, 1:]], -1)]
    corners = [0, side - 1, side * (side - 1), side * side - 1]
    return {
        "particles": points.tolist(),
        "forces": [
            {"kind": "springs", "particles": np.concatenate([s.reshape(-1, 2) for s in springs]).tolist(),
             "stiffness": 100, "rest_length": 10.0 / (side - 1), "rest_factor": factor},
            {"kind": "unary", "particles": list(range(side**2)), "vector": [0, 0, load / side**2]},
            *extra,
        ],
        "anchors": [{"particles": corners, "axes": axes}, {"particles": [int(at[side // 2, side // 2])],
                     "targets": [[*points[at[side // 2, side // 2], :2].tolist(), 2.0]]}],
    }  # fmt: skip


def bent(spec):
    """A system bent out of its plane, its free axes, blocks and hierarchy."""
    system = compile(Scene.read(spec))
    state = system.start()
    state.x += 0.05 * np.sin(3.0 * state.x[:, [1, 2, 0]]) * state.free
    blocks = Blocks(system)
    blocks.fill(system, system.start())
    blocks.weigh()
    hierarchy = Hierarchy(blocks.starts, blocks.columns, blocks.weights(), (state.free > 0).any(axis=1))
    blocks.fill(system, state)
    return system, state, blocks, hierarchy


def whole(level):
    """The symmetric matrix of what blocks or a level hold: the blocks on the diagonal and above."""
    n = len(level.starts) - 1
    rows = np.repeat(np.arange(n), np.diff(level.starts))
    below = np.where((rows == level.columns)[:, None], 0.0, level.values).reshape(-1, 3, 3).transpose(0, 2, 1)
    here = np.concatenate([level.values.reshape(-1, 3, 3), below])
    r, c = np.concatenate([rows, level.columns]), np.concatenate([level.columns, rows])
    a, b = (i.ravel() for i in np.meshgrid(range(3), range(3), indexing="ij"))
    places = (3 * r[:, None] + a).ravel(), (3 * c[:, None] + b).ravel()
    return sparse.coo_matrix((here.ravel(), places), shape=(3 * n, 3 * n)).tocsr()


def sparse_of(blocks, free):
    return whole(blocks)[free][:, free]


LIMITS = {"upper_cutoff": 2.6, "lower_cutoff": 1.9, "plasticity": 0.05}


@pytest.mark.parametrize("axes", ["xyz", "z"])
@pytest.mark.parametrize("limits", [{}, LIMITS], ids=["plain", "limits"])
def test_the_blocks_are_the_tangent_that_newton_assembles(axes, limits):
    """Values on free axes equal the sum of element tangents (assembled here densely); held axes are empty."""
    spec = net(6, axes=axes, factor=1.0 if limits else 0.5)
    spec["forces"][0].update(limits)
    system, state, blocks, _ = bent(spec)
    blocks.settle(state, 0.0)
    n = len(state.x)
    dense = np.zeros((3 * n, 3 * n))
    for group, memory in zip(system.groups, state.memory, strict=True):
        if group.cls.role == "load":
            continue
        found = system.stiffness_blocks(group, state, memory)
        for index, block in zip(group.block.indices, found, strict=True):
            places = (3 * index[:, None] + np.arange(3)).ravel()
            dense[np.ix_(places, places)] += block
    free = state.free.ravel() > 0
    dense[~free], dense[:, ~free] = 0.0, 0.0
    mine = whole(blocks).toarray()
    assert np.abs(mine - dense).max() <= 1e-12 * np.abs(dense).max()


def test_without_pushing_the_tangent_is_that_of_its_positive_part():
    """The block of a spring is k e e^T + (T / l) (I - e e^T): taking out what pushes is taking T / l < 0 for 0, and
    what is left has no negative eigenvalue (Teran et al., Robust quasistatic finite elements, 2005, section 6)."""
    system, state, blocks, _ = bent(net(8, factor=1.3))
    pairs = system.groups[0].block.indices
    d = state.x[pairs[:, 1]] - state.x[pairs[:, 0]]
    length = np.linalg.norm(d, axis=1)
    across = 100.0 * (1.0 - 1.3 * 10.0 / 7 / length)
    assert 0.2 < (across < 0.0).mean() < 1.0
    n = len(state.x)
    dense = np.zeros((n, 3, n, 3))
    for (i, j), e, t in zip(pairs, d / length[:, None], np.maximum(across, 0.0), strict=True):
        block = 100.0 * np.outer(e, e) + t * (np.eye(3) - np.outer(e, e))
        for a, b, sign in ((i, i, 1), (j, j, 1), (i, j, -1), (j, i, -1)):
            dense[a, :, b, :] += sign * block
    blocks.fill(system, state, pulling=True)
    found, dense = whole(blocks).toarray(), dense.reshape(3 * n, 3 * n)
    assert np.abs(found - dense).max() <= 1e-12 * np.abs(dense).max()
    assert np.linalg.eigvalsh(found)[0] >= -1e-12 * np.abs(dense).max()


@pytest.mark.parametrize("axes", ["xyz", "z"])
def test_conjugate_gradients_solve_what_a_direct_solver_solves(axes):
    """To 1e-10 of the right-hand side, the solution is that of SciPy's factor; condition about 1e4 here."""
    _, state, blocks, hierarchy = bent(net(30, axes=axes))
    blocks.settle(state, 0.1)
    assert hierarchy.fill(blocks.values) and hierarchy.coarse
    b = np.random.default_rng(3).normal(size=state.x.shape) * state.free
    x, _, _ = solve(hierarchy, b, 1e-10, 500)
    free = np.flatnonzero(state.free.ravel())
    exact = np.zeros(b.size)
    exact[free] = spsolve(sparse_of(blocks, free).tocsc(), b.ravel()[free])
    assert np.abs(x.ravel() - exact).max() <= 1e-6 * np.abs(exact).max()


@pytest.mark.parametrize("shift", [0.0, 3e-4])
def test_what_is_left_to_go_is_known_by_the_tangent_of_the_last_step(shift):
    """After two Newton steps, by the tangent of the second: K^-1 of what is out of balance is that of SciPy's factor of
    the tangent there, within a factor of 3; and nothing is said without a step, or where the shift holds the net."""
    system, state, blocks, _ = bent(net(30))
    relax_some(system, state)
    tangent = Tangent(system, state)
    for _ in range(2):
        assert tangent.take_up(system, state, shift)
        step, positive = tangent.solve(out_of_balance(system, state), 1e-6, 200)
        assert positive
        state.x += step
    left = out_of_balance(system, state)
    found = tangent.correction(left, state.x, 50)
    blocks.fill(system, state)
    free = np.flatnonzero(state.free.ravel())
    exact = np.zeros(left.size)
    exact[free] = spsolve(sparse_of(blocks, free).tocsc(), left.ravel()[free])
    size, known = (np.linalg.norm(x.reshape(-1, 3), axis=1).max() for x in (exact, found))
    assert size / 3.0 <= known <= 3.0 * size
    assert tangent.take_up(system, state, shift) and tangent.correction(left, state.x, 50) is None
    state.x -= step
    assert tangent.take_up(system, state, 10.0)
    state.x += step
    assert tangent.correction(left, state.x, 50) is None


def relax_some(system, state):
    """Some iterations of relaxation, to where Newton steps go on."""
    method = solver("relaxation")
    method.start(system, state)
    method.advance(system, state, 150, 0.0)
    state.v[:] = 0.0


def out_of_balance(system, state):
    return system.evaluate(state)[0] * state.free


@pytest.mark.slow
def test_steps_hardly_grow_with_the_net():
    """Steps to 1e-4 for four times the particles: at most half as many again (a method of one level would double)."""
    steps = []
    for side in (40, 80):
        _, state, blocks, hierarchy = bent(net(side))
        blocks.settle(state, 0.1)
        assert hierarchy.fill(blocks.values)
        b = np.random.default_rng(1).normal(size=state.x.shape) * state.free
        steps.append(solve(hierarchy, b, 1e-4, 200)[1])
    assert steps[1] <= 1.5 * steps[0]


def test_a_matrix_that_is_not_positive_definite_is_refused():
    """Springs pushed to half their length across: no Cholesky, no conjugate gradients."""
    _, state, blocks, hierarchy = bent(net(12, factor=4.0))
    blocks.settle(state, 0.0)
    b = state.free * [0.0, 0.0, 1.0]
    assert not hierarchy.fill(blocks.values) or not solve(hierarchy, b, 1e-8, 400)[2]


def test_the_last_step_goes_along_the_first_direction_that_bends_down():
    """As in Steihaug, SIAM J. Numer. Anal. 20 (1983) 626: what the last step adds has d A d < 0, and goes downhill; the
    steps before are those of the same matrix. Two smallest eigenvalues are made negative here, the cycle is not."""
    _, state, blocks, hierarchy = bent(net(12))
    blocks.settle(state, 0.1)
    assert hierarchy.fill(blocks.values)
    free = state.free.ravel() > 0
    low = np.linalg.eigvalsh(sparse_of(blocks, free).toarray())
    blocks.values[blocks.starts[:-1]] -= 0.5 * (low[1] + low[2]) * np.eye(3).ravel()
    a, b = whole(blocks), np.random.default_rng(2).normal(size=state.x.shape) * state.free
    x, steps, positive = solve(hierarchy, b, 1e-8, 400)
    before, all_but_one, positive_before = solve(hierarchy, b, 1e-8, steps - 1)
    assert (positive, positive_before, all_but_one) == (False, True, steps - 1) and steps > 1
    d = (x - before).ravel()
    assert d @ (a @ d) < 0.0 < d @ (b.ravel() - a @ before.ravel())


def sliding():
    """A net whose first side slides in its plane."""
    spec = net(12)
    spec["anchors"].append({"particles": list(range(1, 11)), "axes": "z"})
    return spec


@pytest.mark.parametrize(
    "spec",
    [
        net(20),
        net(20, factor=1.0, load=-200.0),
        sliding(),
        net(20, ramp=0.3, extra=({"kind": "self_weight", "total": 30.0},)),
    ],
)
def test_multilevel_ends_where_relaxation_ends(spec):
    """The springs pull: there is one shape at rest. Tolerance 1e-9, so shapes agree to 1e-6 of the span."""
    found = [
        relax(Scene.read({**spec, "settings": {"solver": name, "tolerance": 1e-9, "max_iterations": 200_000}}))
        for name in ("multilevel", "relaxation")
    ]
    assert all(r.converged for r in found), [r.message for r in found]
    assert np.abs(found[0].particles - found[1].particles).max() <= 1e-5


def crossed(side, *, factor=0.9, load=-500.0):
    """A net of side^2 particles with both diagonals of each face, by default shortened and loaded: its edges crease."""
    spec = net(side, factor=factor, load=load)
    at = np.arange(side * side).reshape(side, side)
    pairs = np.concatenate([np.stack([at[:-1, :-1], at[1:, 1:]], -1).reshape(-1, 2),
                            np.stack([at[1:, :-1], at[:-1, 1:]], -1).reshape(-1, 2)])  # fmt: skip
    spacing = 10.0 / (side - 1)
    spec["forces"].append({"kind": "springs", "particles": pairs.tolist(), "stiffness": 100,
                           "rest_length": 2**0.5 * spacing, "rest_factor": factor})  # fmt: skip
    spec["anchors"].pop()
    return spec


@pytest.mark.soak
def test_auto_takes_it_for_a_large_net_and_relaxation_where_another_shape_may_be_lower(monkeypatch):
    """4,096 particles that pull; the same pressed together, which may be at rest in many shapes; and again where
    relaxation would take too long: told so."""
    pulled = relax(Scene.read(net(64)))
    assert pulled.converged and pulled.solver == "auto: multilevel"
    pressed = Scene.read({**net(64, factor=1.3), "settings": {"max_iterations": 100_000}})
    second = relax(pressed)
    assert second.converged and second.solver.startswith("auto: relaxation")
    monkeypatch.setattr(auto, "MANY", 4096)
    third = relax(pressed)
    assert third.converged and third.solver == "auto: multilevel" and auto.CREASED in third.message
    assert auto.CREASED not in second.message + relax(Scene.read(net(64))).message


def test_a_sheet_that_creases_is_certain(monkeypatch):
    """A fifth of its springs push, and Newton steps take turns with relaxation; the form of its force densities is
    positive definite all the same, so that its shape is the lowest (Connelly 1982): that of relaxation."""
    monkeypatch.setattr(auto, "LEAST_MULTILEVEL", 1000)
    spec = crossed(32)
    found = relax(Scene.read({**spec, "settings": {"tolerance": 1e-8}}))
    assert found.converged and found.solver == "auto: multilevel"
    slow = relax(Scene.read({**spec, "settings": {"solver": "relaxation", "tolerance": 1e-8, "max_iterations": 10**6}}))
    assert slow.converged and np.abs(found.particles - slow.particles).max() <= 1e-4
    assert (np.concatenate([f["force"] for f in found.forces if "strain" in f]) < -1e-3).mean() > 0.1


@pytest.mark.slow
@pytest.mark.parametrize(("side", "factor"), [(20, 1.3), (28, 1.1)])
def test_what_relaxation_ended_is_looked_at_too(side, factor, monkeypatch):
    """These sheets, slack and lightly loaded, come to rest while all their particles relax, not by a Newton step; a
    shape that multilevel finds is handed out only where it is the lowest."""
    monkeypatch.setattr(auto, "LEAST_MULTILEVEL", 300)
    scene = Scene.read(crossed(side, factor=factor, load=-20.0))
    found, system = relax(scene), compile(scene)
    state = system.start()
    state.x[:] = found.particles
    assert found.converged
    assert "multilevel" not in found.solver or multilevel.lowest(system, state)


@pytest.mark.parametrize("load", [-0.002, -0.01])
def test_steps_do_not_follow_rounding(load):
    """At rest, energy that changes by less than its sum is off by says nothing of how far to go: steps are whole."""
    scene = Scene.read({**net(20, load=load), "settings": {"solver": "multilevel"}})
    system = compile(scene)
    state = system.start()
    state.x[:] = relax(scene).particles
    for _ in range(8):
        step = multilevel.Step(system, state, Tangent(system, state), 0.0, multilevel.MOST, False)
        step.take(None, 0.0, 0.0)
        assert step.length == 1.0


def test_a_state_forgets_a_tangent_that_is_given_up():
    """What is made of the state later is as ready as what made it."""
    system = compile(Scene.read(crossed(24, factor=1.3)))
    state = system.start()
    tangent = Tangent(system, state)
    assert tangent.take_up(system, state, 1.0)
    tangent.keep(state)
    assert Tangent(system, State.of(state.arrays())).ready
    state.x += 0.05 * np.sin(3.0 * state.x[:, [1, 2, 0]]) * state.free
    taken_up = tangent.take_up(system, state, 0.0)
    assert not (taken_up and tangent.solve(state.free, 1e-6, 200)[1])  # much pushes: not positive definite
    tangent.keep(state)
    assert not tangent.ready and not Tangent(system, State.of(state.arrays())).ready


@pytest.mark.slow
def test_same_net_same_bits():
    """Three runs, one of them in pieces of one iteration, one by a new solver at each from the state in a file."""
    system = compile(Scene.read(crossed(24)))
    shapes, calm = [], False
    for most, anew in ((100, False), (1, False), (1, True)):
        method, state = solver("multilevel"), system.start()
        method.start(system, state)
        while state.iteration < 150:
            if anew:
                method, state = solver("multilevel"), State.of(state.arrays())
            method.advance(system, state, min(most, 150 - state.iteration), 1e-12)
            calm |= bool(state.scratch["calm"][0] > 0.0)
        assert "gathered" in state.scratch  # the hierarchy is another than that of the start
        shapes.append(state.x.tobytes())
    assert calm  # some step went by the tangent of the one before
    assert shapes[0] == shapes[1] == shapes[2]


def test_pulled_springs_have_the_least_energy_and_pressed_ones_perhaps_not():
    """A chain under tension has the least energy; a straight one that is pressed could buckle."""
    for length, known in ((0.5, True), (2.0, False)):
        springs = {"kind": "springs", "particles": [[i, i + 1] for i in range(4)], "rest_length": length}
        spec = {"particles": [[i, 0, 0] for i in range(5)], "forces": [springs], "anchors": [{"particles": [0, 4]}]}
        system = compile(Scene.read(spec))
        assert nets.pulled(system, system.start()) is nets.super_stable(system, system.start()) is known


def test_bodies_that_hang_on_nothing_are_no_trouble():
    """Two nets, one of them loose: its Laplacian has no diagonal on the coarser levels. Newton solves the other."""
    held = net(24)
    loose = {"kind": "springs", "lines": [[[i, j, 9.0], [i + 1.0, j, 9.0]] for i in range(20) for j in range(20)]}
    across = {"kind": "springs", "lines": [[[i, j, 9.0], [i, j + 1.0, 9.0]] for i in range(20) for j in range(20)]}
    held["forces"] += [loose, across]
    found = relax(Scene.read({**held, "settings": {"solver": "multilevel"}}))
    assert found.converged, found.message


def test_coarse_patterns_hold_all_that_a_coarse_tangent_has():
    """P^T A P in each level's pattern equals the product by SciPy, to rounding."""
    _, state, blocks, hierarchy = bent(net(30))
    blocks.settle(state, 0.1)
    assert hierarchy.fill(blocks.values)
    for level, coarser in zip(hierarchy.levels, hierarchy.levels[1:], strict=False):
        starts, columns, values = level.prolong
        shape = (len(level.starts) - 1, len(coarser.starts) - 1)
        p = sparse.csr_matrix((values.astype(float), columns, starts), shape=shape)
        p = sparse.kron(p, sparse.eye(3))
        difference = np.abs((p.T @ whole(level) @ p - whole(coarser)).toarray()).max()
        assert difference <= 1e-12 * np.abs(coarser.values).max()


def test_patience_begins_anew_with_another_way():
    """A solver that went back to the start is not called stalled for being worse than the way it left."""
    system = compile(Scene.read(net(6)))
    method, state = solver("relaxation"), system.start()
    watch = Watch(system, state, method)
    state.iteration = 100
    watch.look(system, state)
    watch.best = 0.0  # what was reached on the way that was left
    state.iteration = 2 * watch.best_at + PATIENCE + 1
    assert watch.look(system, state) == "stalled"
    method.anew = state.iteration
    assert watch.look(system, state) == "running"


def test_steps_are_few_where_tension_differs_with_the_direction():
    """A net with 100 times the tension along x: half the steps to 1e-4 if gathered by tension rather than stiffness."""
    spec = net(60)
    springs = spec["forces"][0]
    along = np.arange(len(springs["particles"])) < len(springs["particles"]) // 2
    springs["rest_factor"] = np.where(along, 0.5, 0.995).tolist()
    system, state, blocks, _ = bent(spec)
    blocks.fill(system, system.start())
    alive, steps = (state.free > 0).any(axis=1), []
    for weights in (blocks.weights(), blocks.sizes):
        hierarchy = Hierarchy(blocks.starts, blocks.columns, weights, alive)
        blocks.fill(system, system.start())
        blocks.settle(state, 0.0)
        assert hierarchy.fill(blocks.values)
        steps.append(solve(hierarchy, state.free * [0.0, 0.0, 1.0], 1e-4, 400)[1])
    assert steps[0] <= 0.5 * steps[1], steps


def test_small_forces_are_solved_as_well_as_large_ones():
    """Cycles are in single precision, whose smallest number is 1e-45: forces of 1e-60 give 1e-60 times the answer."""
    _, state, blocks, hierarchy = bent(net(20))
    blocks.settle(state, 0.1)
    assert hierarchy.fill(blocks.values)
    b = np.random.default_rng(5).normal(size=state.x.shape) * state.free
    (large, many, _), (small, few, _) = solve(hierarchy, b, 1e-8, 200), solve(hierarchy, 2.0**-200 * b, 1e-8, 200)
    assert many == few and np.array_equal(small * 2.0**200, large)
