"""Every force obeys the laws of mechanics that it declares; a new force file is met here without an edit."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from hookean.forces import KINDS
from soak import SOAK, seeds

from . import laws
from .cases import KERNELS, Case, case_of, identity, replaced, resting

seeded, fewer = seeds(30, soak=200), seeds(10, soak=50)
every = pytest.mark.parametrize("case", KERNELS, ids=identity)
conservative = pytest.mark.parametrize("case", [c for c in KERNELS if c.conservative], ids=identity)
internal = pytest.mark.parametrize("case", [c for c in KERNELS if c.role == "internal"], ids=identity)
external = pytest.mark.parametrize("case", [c for c in KERNELS if c.role != "internal"], ids=identity)
exact = pytest.mark.parametrize("case", [c for c in KERNELS if c.hessian is not None], ids=identity)


def test_every_kind_is_here() -> None:
    """The walk over the folder meets every class with a kernel, and every class gives an example of itself."""
    assert {name for name, cls in KINDS.items() if cls.kernel is not None} <= {case.name for case in KERNELS}
    for kind, cls in KINDS.items():
        force, x = cls.example()
        assert type(force) is cls and force.kind == kind and x.shape[1:] == (3,)


@conservative
@seeded
def test_force_is_minus_the_gradient_of_the_energy(case: Case, seed: int, amount: float) -> None:
    """f = -dE/dx; see the law."""
    laws.force_is_the_gradient(case, np.random.default_rng(seed), amount)


def test_a_kernel_that_declares_no_energy_has_none() -> None:
    """Declared not conservative: somewhere the force differs from the gradient of what the kernel returns."""
    for case in KERNELS:
        if not case.conservative:
            with pytest.raises(AssertionError):
                for seed in range(50):
                    laws.force_is_the_gradient(case, np.random.default_rng(seed))


@internal
@seeded
def test_internal_forces_and_moments_sum_to_zero(case: Case, seed: int, amount: float) -> None:
    """Newton's third law, damping and memory included."""
    laws.nothing_from_outside(case, np.random.default_rng(seed), amount)


@external
@fewer
def test_external_forces_have_a_resultant(case: Case, seed: int) -> None:
    """A load or a support pushes on the whole."""
    laws.something_from_outside(case, np.random.default_rng(seed))


@internal
@seeded
def test_rigid_motion_changes_nothing(case: Case, seed: int, amount: float) -> None:
    """Frame indifference of energy, force, stiffness and damping."""
    laws.rigid_motion_changes_nothing(case, np.random.default_rng(seed), amount)


def test_oriented_forces_change_when_turned() -> None:
    """Declared oriented: a rotation changes the force, so the law of rigid motion fails with one."""
    for case in KERNELS:
        if case.oriented:
            assert case.role == "internal"
            with pytest.raises(AssertionError):
                laws.rigid_motion_changes_nothing(replaced(case, oriented=False), np.random.default_rng(0))


@pytest.mark.parametrize("case", resting(), ids=identity)
def test_at_rest_there_is_no_force(case: Case) -> None:
    """With rest values taken from the start shape, the start shape is free of force; away from it there is some."""
    laws.zero_at_rest(case)


def _all_at_one_place(x: np.ndarray) -> np.ndarray:
    return np.ones_like(x)


def _on_a_line(x: np.ndarray) -> np.ndarray:
    return np.arange(len(x), dtype=float)[:, None] * np.array([0.3, -0.2, 0.9])


def _on_an_axis(x: np.ndarray) -> np.ndarray:
    return np.arange(len(x), dtype=float)[:, None] * np.array([1.0, 0.0, 0.0])


def _two_at_one_place(x: np.ndarray) -> np.ndarray:
    moved = x.copy()
    moved[-1] = moved[0]
    return moved


def _flat(x: np.ndarray) -> np.ndarray:
    return x * [1.0, 1.0, 0.0]


def _folded_flat(x: np.ndarray) -> np.ndarray:
    moved = x.copy()
    moved[-1] = 2.0 * moved[:-1].mean(axis=0) - moved[-1]
    return moved * [1.0, 1.0, 0.0]


def _apart(distance: float) -> Callable[[np.ndarray], np.ndarray]:
    return lambda x: (x - x.mean(axis=0)) * distance


def _tiny(distance: float) -> Callable[[np.ndarray], np.ndarray]:
    return lambda x: np.arange(len(x), dtype=float)[:, None] * np.array([distance, 0.0, 0.0])


def _two_near(distance: float) -> Callable[[np.ndarray], np.ndarray]:
    def shape(x: np.ndarray) -> np.ndarray:
        moved = x - x[0]
        moved[-1] = moved[0] + [distance, 0.0, 0.0]
        return moved

    return shape


DEGENERATE: dict[str, Callable[[np.ndarray], np.ndarray]] = {
    "all at one place": _all_at_one_place,
    "on a line": _on_a_line,
    "on an axis": _on_an_axis,
    "two at one place": _two_at_one_place,
    "flat": _flat,
    "folded flat": _folded_flat,
    "1e9 away": lambda x: x + 1e9,
    "spread over 1e9": _apart(1e9),
    "shrunk to 1e-9": _apart(1e-9),
    **{f"two {d:g} apart": _two_near(d) for d in (1e-300, 1e-200, 1e-162, 3e-162, 1e-160, 1e-154, 1e-100, 1e-30)},
    **{f"all {d:g} apart": _tiny(d) for d in (1e-300, 1e-162, 1e-155, 1e-120, 1e-108, 1e-80, 1e-30)},
    "start": lambda x: x,
}


@every
def test_degenerate_positions_give_finite_forces(case: Case) -> None:
    """Coincident, collinear, nearly coincident, far away: finite forces, stiffness, energy, tangent and memory."""
    for shape, moved in DEGENERATE.items():
        named = replaced(case, name=f"{case.name}, {shape}")
        laws.degenerate_stays_finite(named, np.ascontiguousarray(moved(case.x)), np.random.default_rng(3))


@pytest.mark.thinned
@pytest.mark.parametrize("kind", [kind for kind, cls in KINDS.items() if cls.kernel is not None])
def test_started_at_a_degenerate_shape_forces_are_finite(kind: str) -> None:
    """Compiled where the start shape itself is degenerate (rest lengths 0, flat hinges): still finite near and far."""
    for shape, moved in DEGENERATE.items():
        force, x = KINDS[kind].example()
        try:
            case = case_of(f"{kind}, {shape}", force, np.ascontiguousarray(moved(x)))
        except ValueError as refused:
            # refusing with a place and a sentence is fine
            assert str(refused).count("/") and str(refused).count(" ") > 3, shape
            continue
        laws.degenerate_stays_finite(case, case.x, np.random.default_rng(4))
        away = case.x.copy()
        away[: len(x)] += x[: len(away)]  # not the rows of orientations
        laws.degenerate_stays_finite(case, away, np.random.default_rng(5))


@every
@fewer
def test_order_of_elements_and_names_of_particles_do_not_matter(case: Case, seed: int) -> None:
    """Elements permuted: equal to rounding. Particles renumbered: equal to the bit."""
    laws.order_of_elements_does_not_matter(case, np.random.default_rng(seed))
    laws.names_of_particles_do_not_matter(case, np.random.default_rng(seed))


@every
@fewer
def test_lumped_stiffness_bounds_the_tangent_near_the_example(case: Case, seed: int) -> None:
    """diag(w) - K >= 0 near the example's shape, where relaxation takes its unit step."""
    laws.lumped_stiffness_bounds_the_tangent(case, np.random.default_rng(seed), 1e-3)


ANYWHERE = ("springs", "anchor_spring", "bend", "hinge", "shell")


@pytest.mark.parametrize("case", [c for c in KERNELS if c.name.startswith(ANYWHERE)], ids=identity)
@seeded
def test_lumped_stiffness_bounds_the_tangent_far_from_rest_too(case: Case, seed: int, amount: float) -> None:
    """Springs: k (l - L0)/l <= k, so 2k at both ends bounds any length. Bending adds a bound for its moment.

    Other forces need the bound near rest only, where relaxation ends.
    """
    laws.lumped_stiffness_bounds_the_tangent(case, np.random.default_rng(seed), amount)


@exact
@seeded
def test_a_given_tangent_is_exact(case: Case, seed: int, amount: float) -> None:
    """K = -df/dx where a force gives its Hessian."""
    laws.tangent_is_the_gradient_of_the_force(case, np.random.default_rng(seed), amount)


@every
@fewer
def test_declarations_are_true(case: Case, seed: int) -> None:
    """`damped` and `remembers` say what the kernel does; kernels add to f and w and write nothing else."""
    laws.damping_is_as_declared(case, np.random.default_rng(seed))
    laws.memory_is_as_declared(case, np.random.default_rng(seed))
    laws.kernels_only_add(case, np.random.default_rng(seed))


def test_declared_damping_and_memory_are_really_there() -> None:
    """Some case of every damped kind changes with v; some case of every remembering kind remembers large motion."""
    for kind, cls in KINDS.items():
        own = [c for c in KERNELS if c.name.split(",")[0] == kind]
        rng = np.random.default_rng(1)
        if cls.damped:
            changes = [c.force(c.x, rng.normal(size=c.x.shape))[0] - c.force(c.x)[0] for c in own]
            assert max(np.abs(c).max() for c in changes) > 0
        if cls.remembers:
            assert max(np.abs(c.past(rng) - c.block.memory).max() for c in own) > 0


@pytest.mark.thinned
@every
def test_kernels_stay_inside_their_arrays(case: Case) -> None:
    """As plain Python with every index checked, negative ones too, a kernel gives what machine code gives."""
    for shape in ("start", "two at one place", "on a line", "all at one place"):
        named = replaced(case, name=f"{case.name}, {shape}")
        for seed in range(5 if SOAK else 2):
            rng = np.random.default_rng(seed)
            laws.stays_inside_its_arrays(named, np.ascontiguousarray(DEGENERATE[shape](case.moved(rng))), rng)


@every
def test_kernels_allocate_nothing_that_grows(case: Case) -> None:
    """As many allocations for four times the elements, and every one is given back."""
    laws.allocates_nothing_that_grows(case, np.random.default_rng(2))
