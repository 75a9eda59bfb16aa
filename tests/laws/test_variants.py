"""What some forces of a kind compile to in the place of its own kernel: the laws that hold there, too.

Spheres that rub are no case of the other tests: they do not turn, so the sum of their moments is not zero, and
Coulomb's law is not linear in the speed. Their own tests hold them to that law.
"""

from __future__ import annotations

import numpy as np
import pytest

from hookean.forces import KINDS
from hookean.forces.collide import Collide
from hookean.forces.sliding_cable import SlidingCable
from hookean.forces.wind import Wind

from . import laws
from .cases import Case, case_of, identity, replaced
from .test_laws import DEGENERATE


def rough() -> list[Case]:
    """Spheres with restitution, with friction, and with both."""
    force, x = Collide.example()
    given = {name: getattr(force, name) for name in force.model_fields_set}
    more = ({"restitution": 0.5}, {"friction": 0.4}, {"restitution": 0.0, "friction": 0.7})
    return [case_of(f"collide, {columns}", Collide(**given, **columns), x) for columns in more]


def at_water() -> list[Case]:
    """A dome in the wind above and below a level that cuts it."""
    force, x = Wind.example()
    given = {name: getattr(force, name) for name in force.model_fields_set}
    return [case_of(f"wind, below {side}", Wind(**given, waterline=0.33, below=side), x) for side in (False, True)]


def over_saddles() -> list[Case]:
    """Two cables with friction that slip on some of their saddles; and on none."""
    force, x = SlidingCable.example()
    given = {name: getattr(force, name) for name in force.model_fields_set}
    more = ([0.0, 0.0, 0.01, 0.2, 0.5], 30.0)
    return [case_of(f"sliding_cable, friction {mu}", SlidingCable(**given, friction=mu), x) for mu in more]


cables = pytest.mark.parametrize("case", over_saddles(), ids=identity)
variants = pytest.mark.parametrize("case", rough() + at_water(), ids=identity)


@variants
def test_kernels_of_variants_obey_the_laws_of_all(case: Case) -> None:
    """They only add, stay inside their arrays, take no memory that grows, remember as declared, and are finite."""
    laws.kernels_only_add(case, np.random.default_rng(1))
    laws.allocates_nothing_that_grows(case, np.random.default_rng(2))
    laws.order_of_elements_does_not_matter(replaced(case, end_of_step=None), np.random.default_rng(4))
    laws.lumped_stiffness_bounds_the_tangent(case, np.random.default_rng(5), 1e-3)
    if case.name.startswith("wind"):
        laws.something_from_outside(case, np.random.default_rng(6))
        laws.damping_is_as_declared(case, np.random.default_rng(7))
    elif "friction" in case.name:
        laws.memory_is_as_declared(case, np.random.default_rng(3))
    else:
        laws.nothing_from_outside(case, np.random.default_rng(6))
        laws.damping_is_as_declared(case, np.random.default_rng(7))
    for shape in ("start", "two at one place", "on a line", "all at one place"):
        named = replaced(case, name=f"{case.name}, {shape}")
        laws.stays_inside_its_arrays(
            named, DEGENERATE[shape](case.moved(np.random.default_rng(8))), np.random.default_rng(9)
        )
        laws.degenerate_stays_finite(named, np.ascontiguousarray(DEGENERATE[shape](case.x)), np.random.default_rng(10))


@cables
@pytest.mark.parametrize("seed", range(5))
def test_cables_with_friction_obey_the_laws_of_all(case: Case, seed: int) -> None:
    """Their lines have an order, and where they slip their forces have no energy; they are internal, turn with the
    shape, remember as declared, and feel no velocity."""
    rng, amount = np.random.default_rng(seed), [0.001, 0.01, 0.05, 0.1, 0.15][seed]
    laws.kernels_only_add(case, rng)
    laws.allocates_nothing_that_grows(case, rng)
    laws.names_of_particles_do_not_matter(case, rng)
    laws.nothing_from_outside(case, rng, amount)
    laws.rigid_motion_changes_nothing(case, rng, amount)
    laws.damping_is_as_declared(case, rng)
    laws.memory_is_as_declared(case, rng)
    laws.lumped_stiffness_bounds_the_tangent(case, rng, amount)
    for shape, moved in DEGENERATE.items():
        named = replaced(case, name=f"{case.name}, {shape}")
        laws.degenerate_stays_finite(named, np.ascontiguousarray(moved(case.x)), rng)
    laws.stays_inside_its_arrays(case, case.moved(rng, amount), rng)


def test_a_cable_that_slips_has_no_energy() -> None:
    """Declared not conservative: the force differs from the gradient of what the kernel returns; not where it holds."""
    slipping, holding = over_saddles()
    assert not slipping.conservative
    with pytest.raises(AssertionError):
        for seed in range(10):
            laws.force_is_the_gradient(slipping, np.random.default_rng(seed))
    laws.force_is_the_gradient(holding, np.random.default_rng(0))


def test_a_variant_is_no_kind() -> None:
    """Only its own kind is in the catalogue."""
    assert KINDS["collide"] is Collide
    assert not any(cls.variant for cls in KINDS.values())
