"""Negative controls: forces that break one law each, and the law that must notice."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from hookean.forces import KINDS
from hookean.forces.springs import springs_hessian, springs_kernel, springs_yield

from . import laws
from .cases import Case, case_of, replaced

RIGHT = case_of("springs", *KINDS["springs"].example())


def wrong_sign(x, v, indices, parameters, memory, f, w):
    """Springs that push where they should pull; the energy is right."""
    g = np.zeros_like(f)
    energy = springs_kernel(x, v, indices, parameters, memory, g, w)
    f -= g
    return energy


def not_central(x, v, indices, parameters, memory, f, w):
    """Equal and opposite forces, but not along the line that joins the particles: their moment is not zero."""
    energy = springs_kernel(x, v, indices, parameters, memory, f, w)
    a, b = indices[0]
    f[a, 0] += 50.0
    f[b, 0] -= 50.0
    return energy


def one_sided(x, v, indices, parameters, memory, f, w):
    """The second particle of the first spring is not pulled."""
    energy = springs_kernel(x, v, indices, parameters, memory, f, w)
    g = np.zeros_like(f)
    springs_kernel(x, v, indices[:1], parameters[:1], memory[:1], g, np.zeros_like(w))
    f[indices[0, 1]] -= g[indices[0, 1]]
    return energy


def too_soft(x, v, indices, parameters, memory, f, w):
    """Half of the stiffness that bounds the tangent."""
    u = np.zeros_like(w)
    energy = springs_kernel(x, v, indices, parameters, memory, f, u)
    w += 0.5 * u
    return energy


def divides_by_length(x, v, indices, parameters, memory, f, w):
    """No care for springs of length zero."""
    with np.errstate(all="ignore"):
        for a, b in indices:
            f[a] += (x[b] - x[a]) / np.linalg.norm(x[b] - x[a])
    return 0.0


def driven(x, v, indices, parameters, memory, f, w):
    """Damping of the wrong sign: it feeds energy in."""
    energy = springs_kernel(x, v, indices, parameters, memory, f, w)
    f += 100.0 * v
    return energy


def first_is_special(x, v, indices, parameters, memory, f, w):
    """The first element of a block pulls twice."""
    energy = springs_kernel(x, v, indices, parameters, memory, f, w)
    return energy + springs_kernel(x, v, indices[:1], parameters[:1], memory[:1], f, w)


def particle_zero_is_special(x, v, indices, parameters, memory, f, w):
    """A force that depends on the number of a particle."""
    energy = springs_kernel(x, v, indices, parameters, memory, f, w)
    f[0] *= 1.5
    return energy


def writes_memory(x, v, indices, parameters, memory, f, w):
    """Remembers inside the kernel, which solvers call any number of times."""
    memory[:, 0] += 0.01
    return springs_kernel(x, v, indices, parameters, memory, f, w)


def overwrites(x, v, indices, parameters, memory, f, w):
    """Forgets what other forces put on the particles."""
    f[:] = 0.0
    return springs_kernel(x, v, indices, parameters, memory, f, w)


def wraps_around(x, v, indices, parameters, memory, f, w):
    """Reads before the start of an array; Python alone would wrap around."""
    return springs_kernel(x, v, indices, parameters, memory, f, w) + 0.0 * x[int(indices[0, 0]) - 1, 0]


def past_the_end(x, v, indices, parameters, memory, f, w):
    """Reads past the end of an array."""
    return springs_kernel(x, v, indices, parameters, memory, f, w) + 0.0 * x[x.shape[0], 0]


def wasteful(x, v, indices, parameters, memory, f, w):
    """Takes memory for every element."""
    energy = 0.0
    for e in range(indices.shape[0]):
        room = np.zeros(e + 40)
        room[e] = x[indices[e, 0], 0]
        energy += room.sum()
    return energy


def halved_hessian(x, indices, parameters, memory, blocks):
    """A tangent off by half of its first entry."""
    springs_hessian(x, indices, parameters, memory, blocks)
    blocks[0, 0, 0] *= 0.5


def creeps(x, indices, parameters, memory):
    """A memory that moves on although the shape does not."""
    springs_yield(x, indices, parameters, memory)
    memory[:, 0] += 0.01


def pulls_always(x, v, indices, parameters, memory, f, w):
    """Not free of force at its rest length."""
    energy = springs_kernel(x, v, indices, parameters, memory, f, w)
    for a, b in indices:
        pull = 10.0 * (x[b] - x[a])
        f[a] += pull
        f[b] -= pull
    return energy


def rng() -> np.random.Generator:
    """The same numbers for every control."""
    return np.random.default_rng(11)


def toy(kernel: Any = springs_kernel, **changes: Any) -> Case:
    """The springs' example with something wrong about it, run as plain Python."""
    return replaced(RIGHT, plain=True, kernel=kernel, **changes)


TOGETHER = np.zeros_like(RIGHT.x)
REST = case_of("rest", KINDS["springs"](particles=[[0, 1], [1, 2], [2, 3]]), RIGHT.x)

CONTROLS: dict[str, tuple[Callable[[Case], None], Case, Case]] = {
    "gradient": (lambda c: laws.force_is_the_gradient(c, rng()), toy(wrong_sign), toy()),
    "gradient of a moment": (lambda c: laws.force_is_the_gradient(c, rng()), toy(not_central), toy()),
    "forces sum to zero": (lambda c: laws.nothing_from_outside(c, rng()), toy(one_sided), toy()),
    "moments sum to zero": (lambda c: laws.nothing_from_outside(c, rng()), toy(not_central), toy()),
    "damping is internal": (lambda c: laws.nothing_from_outside(c, rng()), toy(driven), toy()),
    "rigid motion": (lambda c: laws.rigid_motion_changes_nothing(c, rng()), toy(not_central), toy()),
    "rest": (laws.zero_at_rest, replaced(REST, plain=True, kernel=pulls_always), REST),
    "resultant": (
        lambda c: laws.something_from_outside(c, rng()),
        toy(),
        case_of("unary", *KINDS["unary"].example()),
    ),
    "finite": (lambda c: laws.degenerate_stays_finite(c, TOGETHER, rng()), toy(divides_by_length), toy()),
    "order of elements": (lambda c: laws.order_of_elements_does_not_matter(c, rng()), toy(first_is_special), toy()),
    "names of particles": (
        lambda c: laws.names_of_particles_do_not_matter(c, rng()), toy(particle_zero_is_special), toy(),
    ),
    "lumped stiffness": (
        lambda c: laws.lumped_stiffness_bounds_the_tangent(c, rng(), 1e-3), toy(too_soft), toy(),
    ),
    "tangent": (
        lambda c: laws.tangent_is_the_gradient_of_the_force(c, rng()), toy(hessian=halved_hessian), toy(),
    ),
    "damping undeclared": (lambda c: laws.damping_is_as_declared(c, rng()), toy(damped=False), toy()),
    "damping takes energy": (lambda c: laws.damping_is_as_declared(c, rng()), toy(driven), toy()),
    "memory undeclared": (lambda c: laws.memory_is_as_declared(c, rng()), toy(remembers=False), toy()),
    "memory rests": (lambda c: laws.memory_is_as_declared(c, rng()), toy(end_of_step=creeps), toy()),
    "memory in the kernel": (lambda c: laws.kernels_only_add(c, rng()), toy(writes_memory), toy()),
    "kernels add": (lambda c: laws.kernels_only_add(c, rng()), toy(overwrites), toy()),
    "allocations": (
        lambda c: laws.allocates_nothing_that_grows(c, rng()), replaced(RIGHT, kernel=wasteful), RIGHT,
    ),
    "index below zero": (
        lambda c: laws.stays_inside_its_arrays(c, c.x, rng()), replaced(RIGHT, kernel=wraps_around), RIGHT,
    ),
    "index past the end": (
        lambda c: laws.stays_inside_its_arrays(c, c.x, rng()), replaced(RIGHT, kernel=past_the_end), RIGHT,
    ),
}  # fmt: skip


@pytest.mark.parametrize("law", CONTROLS)
def test_a_wrong_force_fails_its_law_and_a_right_one_passes(law: str) -> None:
    """Every law can fail: it fails for a force that breaks it and holds for one that does not."""
    check, wrong, right = CONTROLS[law]
    check(right)
    with pytest.raises((AssertionError, IndexError)):
        check(wrong)


def test_machine_code_that_differs_from_its_source_would_be_seen() -> None:
    """The comparison of plain Python and machine code is not of a thing with itself: a factor 1 + 1e-12 shows."""

    class Off(Case):
        def force(self, *given: Any) -> tuple[np.ndarray, np.ndarray, float]:
            f, w, energy = super().force(*given)
            return f * (1.0 + 1e-12 * math.sqrt(2.0)), w, energy

    with pytest.raises(AssertionError):
        laws.stays_inside_its_arrays(Off(**vars(RIGHT)), RIGHT.x + 0.1 * RIGHT.x**2, rng())
