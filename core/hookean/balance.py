"""Balance: how far a shape is from equilibrium, on what scale, and how near float64 lets it come."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import reduce

import numpy as np
from numpy.typing import NDArray

from hookean import kernels
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
    particles, or the mean size of the internal element forces where nothing is loaded [force]. Rounding of coordinates
    and sums leaves u (w |x| + |f| + |load|) at a particle of the exact answer, |x| the largest coordinate of all:
    `floor` is the most that it leaves anywhere, / scale; `beyond` the largest residual of a particle that is more than
    it leaves there.
    """

    forces: Floats  # (n, 3) what is left on free particles
    reactions: Floats  # (n, 3) what anchors put on held ones
    contact: Floats  # (n, 3) what contacts put on particles
    scale: float
    out_of_balance: float
    residual: float
    floor: float
    beyond: float
    worst: int
    energies: Floats  # of each group of elements [force length]

    def met(self, tolerance: float) -> bool:
        """Converged: what is left at each particle is within the tolerance, or no more than rounding leaves there."""
        return self.beyond <= tolerance


def balance(system: System, state: State) -> Balance:
    """Judge a shape at rest."""
    f, w, energies = system.evaluate(state)
    loads, _, _ = system.evaluate(state, only="load")
    left = f * state.free
    contact = system.support(state, left) if system.contacts else np.zeros(f.shape)
    reactions = np.empty(f.shape)
    judged = kernels.compiled(judge)(state.x, f, w, state.free, loads, contact, left, reactions)
    worst, out, beyond, floor, load, loaded = judged
    scale = load / loaded if loaded else _element_scale(system, state)
    # nothing pushes anywhere: balanced if what is left is rounding
    unit = scale if scale > 0.0 else 1.0
    return Balance(left, reactions, contact, unit, out, out / unit, floor / unit, beyond / unit, worst, energies)


def judge(x, f, w, free, loads, contact, left, reactions):  # type: ignore[no-untyped-def]
    """Write the reactions; the particle with the largest force left, that force, the largest beyond rounding and the
    most that rounding leaves [force], and the sizes of loads on what may move: their sum, and how many there are."""
    worst, out, beyond, floor, load, loaded = 0, 0.0, 0.0, 0.0, 0.0, 0
    reach = 0.0  # of all: what a particle hangs on may be farther out than itself
    for i in range(x.shape[0]):
        for c in range(3):
            if abs(x[i, c]) > reach and np.isfinite(x[i, c]):
                reach = abs(x[i, c])
    for i in range(x.shape[0]):
        largest, square, weight, moves = 0.0, 0.0, 0.0, False
        for c in range(3):
            reactions[i, c] = -(f[i, c] + contact[i, c]) * (1.0 - free[i, c])
            square += left[i, c] * left[i, c]
            weight += loads[i, c] * free[i, c] * loads[i, c] * free[i, c]
            largest = max(largest, abs(f[i, c]))
            moves = moves or free[i, c] > 0.0
        # where a position is none, neither is what its springs do
        size = np.sqrt(square) if np.isfinite(x[i, 0] + x[i, 1] + x[i, 2]) else np.nan
        weight = np.sqrt(weight)
        noise = ROUNDING * (w[i] * reach + largest + weight)
        if size > out or (np.isnan(size) and not np.isnan(out)):
            worst, out = i, size
        if (size > noise and size > beyond) or np.isnan(size):
            beyond = size
        if moves:
            floor = max(floor, noise)
            if weight > 0.0:
                load += weight
                loaded += 1
    return worst, out, beyond, floor, load, loaded


def _element_scale(system: System, state: State) -> float:
    """The mean size of the internal element forces [force]."""
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
