"""Stability and accuracy of what is found at rest. Oracles: closed forms, and own tangents by differences of forces."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import scipy.sparse as sparse
from scipy.optimize import brentq
from scipy.sparse.linalg import spsolve

from hookean import Result, Scene, Simulation, relax
from hookean.discretize import diagonals, edges, grid, naked_vertices
from hookean.running.run import relax_state
from hookean.solvers import solver
from hookean.stability.equilibrium import LARGE_NET, Equilibrium, Stability, excess, leave
from hookean.system.balance import balance
from hookean.system.system import compile
from soak import sampled

from .test_components import Springs, chain

Spec = dict[str, Any]


def column(n: int, part: float, **settings: Any) -> Spec:
    """A column of length 1 and EI 1 between pins, in a plane, under `part` of the critical load of Hencky's bar chain,
    4 n^2 sin^2(pi / 2n); so stiff along itself that it does not shorten."""
    x = np.column_stack([np.linspace(0.0, 1.0, n + 1), *np.zeros((2, n + 1))])
    load = part * 4.0 * n * n * np.sin(np.pi / 2 / n) ** 2
    return {
        "particles": x,
        "forces": [
            {"kind": "springs", "particles": [[i, i + 1] for i in range(n)], "stiffness": 1e6 * n},
            {"kind": "bend", "particles": [[i - 1, i, i + 1] for i in range(1, n)], "stiffness": 1.0},
            {"kind": "unary", "particles": [n], "vector": [-load, 0.0, 0.0]},
        ],
        "anchors": [
            {"particles": [0]},
            {"particles": [n], "axes": "yz"},
            {"particles": list(range(1, n)), "axes": "z"},
        ],
        "settings": settings,
    }


def buckled(n: int, part: float) -> float:
    """The height of Hencky's bar chain beyond its critical load, by shooting: M = P y at each corner turns the next
    link by M l / EI, and a link shortens by P cos / k; the first angle brings the end back to the axis."""
    load, link = part * 4.0 * n * n * np.sin(np.pi / 2 / n) ** 2, 1.0 / n

    def heights(angle: float) -> np.ndarray:
        y = [0.0]
        for _ in range(n):
            y.append(y[-1] + link * (1.0 - load * np.cos(angle) / 1e6) * np.sin(angle))
            angle -= load * y[-1] * link
        return np.array(y)

    first = brentq(lambda angle: heights(angle)[-1], 1e-2 if part < 1.5 else 0.5, 3.0, xtol=1e-14)
    return float(heights(first).max())


@pytest.mark.thinned
@pytest.mark.parametrize("solver", ["auto", "newton"])
@pytest.mark.parametrize("part", [1.001, 1.01, 2.0])
def test_a_column_beyond_its_critical_load_buckles(part: float, solver: str) -> None:
    """The straight column is in equilibrium, and left. Near its critical load forces say little: at 1.001 of it a
    residual of 1e-6 is met at 0.001 of the span, 0.028 is right."""
    expected = buckled(20, part)
    found = relax(Scene.read(column(20, part, solver=solver, tolerance=1e-6 if solver == "auto" else 1e-10)))
    assert found.converged and found.stability == "stable", found.message
    assert np.abs(found.particles[:, 1]).max() == pytest.approx(expected, rel=1e-5)
    assert found.position_error is not None and found.position_error <= 1e-6
    if part == 1.001:
        assert expected == pytest.approx(0.0283, abs=1e-4)


@pytest.mark.parametrize("light", [1e-6, 1e-10, 1e-12])
def test_an_unstable_column_is_left_beside_one_that_is_so_stiff_that_its_energy_hides_the_other(light: float) -> None:
    """A column of EI `light` under twice its critical load buckles as the shooting says, beside one of EI 1 at rest."""
    n, heavy, small = 10, column(10, 0.5), column(10, 2.0)
    for force, name in zip(small["forces"], ("stiffness", "stiffness", "vector"), strict=True):
        force[name] = (light * np.asarray(force[name])).tolist()
    for part in (*small["forces"], *small["anchors"]):
        part["particles"] = (np.asarray(part["particles"]) + n + 1).tolist()
    x = np.vstack([heavy["particles"], small["particles"] + [0.0, 5.0, 0.0]])
    found = relax(Scene.read({key: heavy[key] + small[key] for key in ("forces", "anchors")} | {"particles": x}))
    assert (found.status, found.stability) == ("converged", "stable"), found.message
    height = np.abs(found.particles[n + 1 :, 1] - 5.0).max()
    assert height == pytest.approx(np.abs(buckled(n, 2.0)), rel=1e-3)


def test_an_unstable_column_is_kept_where_that_is_asked_for() -> None:
    found = relax(Scene.read(column(20, 2.0, allow_unstable=True)))
    assert found.converged and found.stability == "unstable"
    assert np.abs(found.particles[:, 1]).max() == 0.0
    assert (
        found.soft_particle == 10 and found.soft_modes == 1
    )  # of loads up to 4 times the critical one the first alone
    assert "It is unstable" in found.message and "particle 10 moves most" in found.message


@pytest.mark.parametrize("solver", ["relaxation", "momentum", "verlet"])
def test_solvers_that_do_not_leave_report_that_it_is_unstable(solver: str) -> None:
    settings = {"solver": solver, "time_step": 1e-4, "drag": 1e3}
    found = relax(Scene.read(column(4, 2.0, **settings)))
    assert found.converged and found.stability == "unstable" and found.soft_particle == 2


@pytest.mark.slow
@pytest.mark.parametrize("solver", sampled(["auto", "newton", "relaxation"], 3))
@pytest.mark.parametrize(("part", "n", "bow"), [(1.3, 50, 0.0), (1.3, 50, 1e-4), (1.7, 50, 0.01)])
def test_a_loose_tolerance_makes_no_mechanism_of_a_column(part: float, n: int, bow: float, solver: str) -> None:
    """Beyond the critical load, straight or bowed, to 1e-3: what is out of balance may be more than the stiffness that
    is left. The shape near by that balances decides: straight, it is unstable, and bent as it buckles, it is stable."""
    spec = column(n, part, solver=solver, tolerance=1e-3)
    spec["particles"][:, 1] += bow * np.sin(np.pi * np.arange(n + 1) / n)
    found = relax(Scene.read(spec))
    height = np.abs(found.particles[:, 1]).max()
    assert found.stability != "mechanism", found.message
    if found.stability == "stable":
        assert height == pytest.approx(buckled(n, part), rel=0.02)
    else:
        assert height < 0.01 and solver == "relaxation" or found.stability == "unknown", found.stability_reason


def test_a_loose_tolerance_leaves_mechanisms_what_they_are() -> None:
    """A column that buckled in space: it turns about the axis through its ends, one motion, at 1e-3 as at 1e-6."""
    spec = column(20, 1.3, tolerance=1e-3)
    spec["anchors"] = spec["anchors"][:2]
    found = relax(Scene.read(spec))
    assert found.converged and found.stability == "mechanism" and found.soft_modes == 1


@pytest.mark.parametrize("part", [0.5, 0.9, 0.999])
def test_a_column_below_its_critical_load_is_stable(part: float) -> None:
    found = relax(Scene.read(column(20, part)))
    assert found.converged and found.stability == "stable" and found.soft_particle is None


def test_a_pinned_column_in_space_turns_about_its_axis() -> None:
    """Nothing resists that: one motion, and the position is not known; but the rise is."""
    spec = column(20, 1.001)
    spec["anchors"] = spec["anchors"][:2]
    found = relax(Scene.read(spec))
    assert found.stability == "mechanism" and found.soft_modes == 1
    assert found.position_error is None and "singular" in found.position_reason
    assert np.hypot(*found.particles.T[1:]).max() == pytest.approx(buckled(20, 1.001), rel=1e-5)


def frame(x: Any, pairs: Any, **more: Any) -> Result:
    """Unloaded, unstressed bars."""
    spec = {"particles": x, "forces": [{"kind": "springs", "particles": pairs}], **more}
    return relax(Scene.read(spec))


CUBE = np.array([[i, j, k] for i in (0, 1) for j in (0, 1) for k in (0, 1)], float)
EDGES = [[a, b] for a in range(8) for b in range(a) if np.abs(CUBE[a] - CUBE[b]).sum() == 1]


@pytest.mark.parametrize(
    ("x", "pairs", "held", "modes"),
    [
        ([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1], [1, 2], [2, 0]], [], 6),
        ([[0, 0, 0], [1, 0, 0]], [[0, 1]], [0], 2),
        (CUBE, EDGES, [], 24 - 12),
        (CUBE, EDGES, [0, 1, 2], 24 - 9 - 10),
        ([[i, 0, 0] for i in range(6)], [[i, i + 1] for i in range(5)], [0, 5], 2 * 4),
    ],
    ids=["triangle", "pendulum", "cube", "cube held", "straight chain"],
)
def test_mechanisms_have_as_many_motions_as_maxwell_counts(x: Any, pairs: Any, held: list[int], modes: int) -> None:
    """Degrees of freedom less independent bars. Source: Maxwell, "On the calculation of the equilibrium and stiffness
    of frames", 1864; Calladine 1978. Of the straight chain's five bars one is redundant: 12 - 4."""
    found = frame(x, pairs, **({"anchors": [{"particles": held}]} if held else {}))
    assert found.converged and found.stability == "mechanism" and found.soft_modes == modes
    assert found.position_error is None and f"{modes} motions meet no resistance" in found.stability_reason


def test_a_large_frame_counts_its_motions_by_sparse_factors() -> None:
    """A row of 60 unbraced cubes in space: 4 x 61 nodes, 8 x 60 + 4 bars, all independent."""
    x = np.array([[i, j, k] for i in range(61) for j in (0, 1) for k in (0, 1)], float)
    near = [[a, b] for a in range(len(x)) for b in range(max(0, a - 5), a) if np.abs(x[a] - x[b]).sum() == 1]
    found = frame(x, near)
    assert found.stability == "mechanism" and found.soft_modes == 3 * 244 - (8 * 60 + 4)


def test_prestress_stiffens_a_straight_chain() -> None:
    """Pulled, it is stable; pushed, unstable in 2 x 4 motions; both by the sign of the tension alone."""
    chain = {"particles": [[i, 0, 0] for i in range(6)], "anchors": [{"particles": [0, 5]}]}
    for factor, kind, modes in ((0.99, "stable", None), (1.01, "unstable", 8)):
        springs = {"kind": "springs", "particles": [[i, i + 1] for i in range(5)], "rest_factor": factor}
        settings = {"allow_unstable": True}
        found = relax(Scene.read({**chain, "forces": [springs], "settings": settings}))
        assert found.stability == kind and found.soft_modes == modes
    left = relax(Scene.read({**chain, "forces": [springs]}))
    assert left.stability != "unstable" and left.energy["total"] < found.energy["total"]


def test_what_lies_on_a_floor() -> None:
    """A bar on a floor: friction holds it; without friction it slides and turns, three motions."""
    bar = {
        "particles": [[0, 0, 0], [1, 0, 0]],
        "forces": [
            {"kind": "springs", "particles": [[0, 1]]},
            {"kind": "unary", "particles": [0, 1], "vector": [0, 0, -1]},
        ],
    }
    for friction, kind, modes in ((0.5, "stable", None), (0.0, "mechanism", 3)):
        floor = {"static_friction": friction, "kinetic_friction": friction}
        found = relax(Scene.read({**bar, "settings": {"floor": floor, "solver": "relaxation"}}))
        assert found.converged and (found.stability, found.soft_modes) == (kind, modes)


def test_what_stands_on_a_floor_is_held_there_alone() -> None:
    """A triangle on edge, with friction under its base: its top still turns about that, one motion; loaded, it falls
    over."""
    upright = {
        "particles": [[0, 0, 0], [1, 0, 0], [0.5, 0, 1]],
        "forces": [
            {"kind": "springs", "particles": [[0, 1], [1, 2], [2, 0]]},
            {"kind": "unary", "particles": [0, 1], "vector": [0, 0, -1]},
        ],
    }
    settings = {"floor": {"static_friction": 0.5, "kinetic_friction": 0.5}, "solver": "relaxation"}
    found = relax(Scene.read({**upright, "settings": settings}))
    assert found.converged and (found.stability, found.soft_modes, found.soft_particle) == ("mechanism", 1, 2)
    loads = {"kind": "unary", "particles": [2], "vector": [0, 0, -0.1]}
    loaded = relax(Scene.read({**upright, "forces": [*upright["forces"], loads], "settings": settings}))
    assert (loaded.stability, loaded.soft_particle) == ("unstable", 2)


def test_the_lowest_shape_is_not_left() -> None:
    """From where the energy has its minimum a mode leads nowhere lower: nothing moves."""
    system = compile(Scene.read(column(6, 0.5)))
    state = system.start()
    relax_state(system, state, solver("auto"))
    rest, mode = state.x.copy(), np.zeros_like(state.x)
    mode[3, 1] = 1.0
    assert not leave(system, state, Equilibrium(Stability.UNSTABLE, mode=mode))
    assert (state.x == rest).all()


@pytest.mark.parametrize("tolerance", [1e-6, 1e-3, None])
def test_errors_are_measured_by_the_size_of_their_component(tolerance: float | None) -> None:
    """A chain of length 8 under tension: its error by the tolerance times 8; without a tolerance nothing counts."""
    x = np.column_stack([np.linspace(0.0, 8.0, 9), *np.zeros((2, 9))])
    springs = {"kind": "springs", "particles": [[i, i + 1] for i in range(8)], "rest_factor": 0.5}
    settings = {"position_tolerance": tolerance}
    spec = {"particles": x, "forces": [springs], "anchors": [{"particles": [0, 8]}], "settings": settings}
    system = compile(Scene.read(spec))
    state = system.start()
    rest = Equilibrium(Stability.STABLE, position_errors=np.array([1e-4]))
    found = excess(system, state, balance(system, state), rest)
    assert found == (0.0 if tolerance is None else pytest.approx(1e-4 / (8.0 * tolerance), rel=1e-14))


RIGID = [([], 6), ([0], 3), ([0, 3], 1)]
"""Particles of a plate that are held, and how many rigid motions that leaves."""


@pytest.mark.parametrize(("held", "left"), RIGID)
@pytest.mark.parametrize("kind", ["hinge", "shell"])
@pytest.mark.parametrize("turn", [0.0, 0.7])
def test_plates_that_are_free_to_turn_are_mechanisms(kind: str, held: list[int], left: int, turn: float) -> None:
    """A flat plate of four triangles, whose tangent is known by differences of forces: rigid motions cost nothing."""
    flat = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0], [1, 1, 0], [2, 1, 0]], float)
    x = flat @ np.array([[1, 0, 0], [0, np.cos(turn), np.sin(turn)], [0, -np.sin(turn), np.cos(turn)]])
    faces = [[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4]]
    sides = sorted({tuple(sorted((f[i], f[i - 1]))) for f in faces for i in range(3)})
    spec: Spec = {"particles": x, "forces": [{"kind": "springs", "particles": sides, "stiffness": 1000.0}]}
    if kind == "hinge":
        spec["forces"].append({"kind": "hinge", "particles": [[0, 4, 1, 3], [1, 5, 2, 4], [1, 4, 0, 5]]})
    else:
        spec["meshes"] = {"plate": {"vertices": x, "faces": faces}}
        spec["forces"].append({"kind": "shell", "mesh": "plate"})
    found = relax(Scene.read({**spec, "anchors": [{"particles": held}] if held else []}))
    assert found.converged and (found.stability, found.soft_modes) == ("mechanism", left)


@pytest.mark.parametrize(("anchors", "left"), [([], 5), ([{"particles": [0]}], 2)])
@pytest.mark.parametrize(("n", "stiffness"), [(3, 1e2), (30, 1e4)])
def test_rods_that_are_free_to_turn_are_mechanisms(n: int, stiffness: float, anchors: list[Spec], left: int) -> None:
    """A straight rod moves three ways and turns two; one whose end is held turns two ways."""
    x = np.column_stack([np.linspace(0.0, 1.0, n + 1), *np.zeros((2, n + 1))])
    springs = {"kind": "springs", "particles": [[i, i + 1] for i in range(n)], "stiffness": stiffness}
    bend = {"kind": "bend", "particles": [[i - 1, i, i + 1] for i in range(1, n)], "stiffness": 1.0}
    found = relax(Scene.read({"particles": x, "forces": [springs, bend], "anchors": anchors}))
    assert found.converged and (found.stability, found.soft_modes) == ("mechanism", left)


def sheet(n: int, factor: float, total: float, **settings: Any) -> Springs:
    """A square of n x n faces with both diagonals, its rim held, a total load."""
    steps = np.linspace(0.0, 1.0, n + 1)
    mesh = grid(steps, steps)
    x, pairs = mesh.vertices, np.concatenate([edges(mesh), diagonals(mesh)])
    loads = np.zeros_like(x)
    loads[:, 2] = -total / len(x)
    rest = factor * np.linalg.norm(x[pairs[:, 1]] - x[pairs[:, 0]], axis=1)
    return Springs(x, pairs, np.full(len(pairs), 100.0), rest, loads, naked_vertices(mesh))


def exact_step(structure: Springs, x: np.ndarray) -> float:
    """The largest movement of K^-1 f, K sparse, by scipy."""
    along, tension = structure.tensions(x)
    density = tension / np.linalg.norm(x[structure.pairs[:, 1]] - x[structure.pairs[:, 0]], axis=1)
    blocks = (structure.k - density)[:, None, None] * along[:, :, None] * along[:, None, :]
    blocks += density[:, None, None] * np.eye(3)
    rows, columns, values = [], [], []
    for i, j, sign in ((0, 0, 1), (1, 1, 1), (0, 1, -1), (1, 0, -1)):
        a, b = structure.pairs[:, i], structure.pairs[:, j]
        rows.append(np.broadcast_to(3 * a[:, None, None] + np.arange(3)[:, None], blocks.shape).ravel())
        columns.append(np.broadcast_to(3 * b[:, None, None] + np.arange(3), blocks.shape).ravel())
        values.append(sign * blocks.ravel())
    whole = sparse.csc_matrix((np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))))
    free = np.flatnonzero(np.repeat(structure.free, 3))
    step = spsolve(whole[free][:, free], structure.left(x).ravel()[free])
    return float(np.linalg.norm(step.reshape(-1, 3), axis=1).max())


@pytest.mark.thinned
@pytest.mark.parametrize("solver", ["relaxation", "newton", "auto", "multilevel"])
@pytest.mark.parametrize(("n", "factor"), [(6, 0.9), (20, 1.0), (20, 1.01), (66, 0.95)])
def test_position_errors_are_those_of_one_exact_step(n: int, factor: float, solver: str) -> None:
    """Within a factor of 3, whether found by dense or sparse factors, conjugate gradients or multigrid."""
    if n == 66 and solver in ("newton",):
        pytest.skip("too slow to be worth it")
    structure = sheet(n, factor, 10.0)
    assert (len(structure.x) >= LARGE_NET) == (n == 66)
    found = structure.solve(solver=solver, tolerance=1e-4, position_tolerance=None)
    assert found.converged and found.stability == "stable"
    exact = exact_step(structure, found.particles)
    rounding = 1e-15 / min(1.0, np.abs(1.0 - factor) + 0.1)
    assert exact / 3.0 - rounding <= found.position_error <= 3.0 * exact + rounding


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(24))
def test_position_errors_of_strips_and_nets_of_soft_and_stiff_springs(seed: int) -> None:
    """Long strips and nets whose stiffness differs by up to a thousand: the softest motions are slow to be found."""
    rng = np.random.default_rng(seed)
    n, m = (int(rng.integers(50, 140)), 2) if seed % 3 else (int(rng.integers(5, 25)), int(rng.integers(5, 25)))
    number = np.arange(n * m).reshape(n, m)
    ends = [(number[:-1], number[1:]), (number[:, :-1], number[:, 1:])]
    pairs = np.concatenate([np.column_stack([a.ravel(), b.ravel()]) for a, b in ends])
    place = np.stack(np.meshgrid(np.arange(n), np.arange(m), indexing="ij"), -1).reshape(-1, 2)
    x = np.column_stack([place, 0.1 * rng.standard_normal(n * m)])
    held = np.concatenate([number[0], number[-1]])
    loads = np.column_stack([np.zeros((n * m, 2)), -(rng.random(n * m) ** 4)])
    rest = rng.uniform(0.0, 0.9) * np.linalg.norm(x[pairs[:, 1]] - x[pairs[:, 0]], axis=1)
    structure = Springs(x, pairs, 10.0 ** rng.uniform(0.0, float(rng.choice([1, 3])), len(pairs)), rest, loads, held)
    tolerance = float(10.0 ** rng.uniform(-6.0, -3.0))
    found = structure.solve(solver="relaxation", tolerance=tolerance, position_tolerance=None)
    assert found.converged and found.stability == "stable"
    exact = exact_step(structure, found.particles)
    assert exact / 3.0 <= found.position_error <= 3.0 * exact


def test_auto_goes_on_until_the_position_is_known() -> None:
    """A loose tolerance leaves a position error of 4e-5 of the size; the position tolerance does not."""
    structure = sheet(12, 1.0, 10.0)
    loose = structure.solve(tolerance=1e-2, position_tolerance=None)
    known = structure.solve(tolerance=1e-2, position_tolerance=1e-9)
    assert loose.position_error > 1e-5 > 1e-9 * np.sqrt(2.0) >= known.position_error
    assert known.residual < loose.residual and known.converged
    assert exact_step(structure, known.particles) <= 3e-9 * np.sqrt(2.0)


@pytest.mark.slow
def test_a_flat_sheet_under_compression_is_left_or_called_unstable() -> None:
    """Flat, all springs push, and a push out of the plane is met by none: by factors, and by multigrid."""
    for n in (8, 66):
        flat = sheet(n, 1.02, 0.0)
        found = flat.solve(solver="multilevel" if n == 66 else "relaxation")
        assert found.converged and found.stability == "unstable" and not found.particles[:, 2].any()
        assert flat.free[found.soft_particle]
    left = sheet(8, 1.02, 0.0).solve()
    assert left.converged and left.stability == "stable" and np.abs(left.particles[:, 2]).max() > 0.01
    assert np.linalg.eigvalsh(sheet(8, 1.02, 0.0).tangent(left.particles))[0] > 0.0


def test_a_session_knows_once_it_has_come_to_rest() -> None:
    structure = chain([0.0, 0.0, 0.0], 4, 100.0, 1.0, 1.0)
    running = Simulation(Scene.read(structure.spec(drag=10.0)))
    running.step()
    assert running.result().stability == "unknown" and "not at rest" in running.result().stability_reason
    while running.status == "running":
        running.step(10)
    assert running.result().stability == "stable" and running.result().position_error < 1e-5


def test_a_result_that_is_not_at_rest_claims_nothing() -> None:
    found = chain([0.0, 0.0, 0.0], 20, 1e4, 1.0, 1.0).solve(solver="relaxation", max_iterations=3)
    assert found.status == "max_iterations" and found.stability == "unknown" and found.position_error is None
    assert found.stability_reason == found.position_reason == "the shape is not at rest"
    assert found.to_dict()["stability"] == "unknown"
