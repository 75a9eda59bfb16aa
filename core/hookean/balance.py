"""Balance: how far a shape is from equilibrium, on what scale, and how near float64 lets it come."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import reduce

import numpy as np
from numpy.typing import NDArray

from hookean.forces import Block
from hookean.forces.base import lengths
from hookean.state import State
from hookean.system import Group, System

Floats = NDArray[np.float64]

CHUNK = 8192  # elements
ROUNDING = float(np.finfo(np.float64).eps) / 2.0


@dataclass(frozen=True)
class Balance:
    """Out-of-balance forces of a shape.

    residual = max over free particles of |out of balance| / scale [-]; scale = mean |load| over loaded free
    particles, or the mean size of the internal element forces where nothing is loaded [force]. `floor`: the residual
    that rounding of coordinates and sums leaves in the exact answer, u (w |x| + sum |f|) / scale.
    """

    forces: Floats  # (n, 3) what is left on free particles
    reactions: Floats  # (n, 3) what anchors put on held ones
    contact: Floats  # (n, 3) what contacts put on particles
    scale: float
    out_of_balance: float
    residual: float
    floor: float
    worst: int
    energies: Floats  # of each group of elements [force length]

    def met(self, tolerance: float) -> bool:
        """Converged: residual <= max(tolerance, floor)."""
        return self.residual <= max(tolerance, self.floor)


def balance(system: System, state: State) -> Balance:
    """Judge a shape at rest."""
    f, w, energies = system.evaluate(state)
    left = f * state.free
    contact = system.support(state, left) if system.contacts else np.zeros_like(f)
    reactions = -(f + contact) * (1.0 - state.free)
    size = lengths(left)
    worst = int(np.argmax(size)) if len(size) else 0
    out = float(size[worst]) if len(size) else 0.0
    loads = _load_size(system, state)
    scale = force_scale(system, state, loads)
    noise = ROUNDING * (w * _largest(state.x) + _largest(f) + loads)
    free = _largest(state.free) > 0.0
    floor = float(noise[free].max()) if free.any() else 0.0
    if scale > 0.0:
        return Balance(left, reactions, contact, scale, out, out / scale, floor / scale, worst, energies)
    # nothing pushes anywhere: balanced if what is left is rounding
    return Balance(left, reactions, contact, 1.0, out, out, floor, worst, energies)


def force_scale(system: System, state: State, loads: Floats) -> float:
    """The force that residuals are measured by [force]; see `Balance`. `loads` (n,) on the free axes."""
    loaded = (loads > 0) & (_largest(state.free) > 0.0)
    if loaded.any():
        return float(loads[loaded].mean())
    total, count = 0.0, 0
    for group, memory in zip(system.groups, state.memory, strict=True):
        if group.cls.role != "load" and len(group.block.indices):
            for sizes in _element_sizes(system, group, state, memory):
                total, count = total + float(sizes.sum()), count + len(sizes)
    now = total / count if count else 0.0
    # where stress dies out at equilibrium, the scale must not die with it
    state.force_scale = max(state.force_scale, now)
    return max(now, 1e-3 * state.force_scale)


def _element_sizes(system: System, group: Group, state: State, memory: Floats) -> Iterator[Floats]:
    """The largest force that each element puts on one of its particles."""
    if group.cls.arity != 2:
        forces = system.element_forces(group, state, memory)
        # column by column: reducing an axis of two or three is slow
        yield reduce(np.maximum, (lengths(forces[:, i]) for i in range(forces.shape[1])))
        return
    b = group.block
    for first in range(0, len(b.indices), CHUNK):  # few enough to stay in the nearest cache
        part = slice(first, first + CHUNK)
        some = Group(group.cls, Block(b.indices[part], b.parameters[part], b.memory[part]), [])
        yield lengths(system.element_forces(some, state, memory[part])[:, 0])  # the other end bears the same


def _load_size(system: System, state: State) -> Floats:
    if all(group.cls.role != "load" for group in system.groups):
        return np.zeros(len(state.x))
    loads, _, _ = system.evaluate(state, only="load")
    return lengths(loads * state.free)


def _largest(vectors: Floats) -> Floats:
    """Largest size of a component of each row (n, 3)."""
    x, y, z = np.abs(vectors).T
    largest: Floats = np.maximum(np.maximum(x, y), z)
    return largest
