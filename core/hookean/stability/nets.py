"""Nets: whether a system is a plain net of springs, and whether the shape it hangs in is its lowest.

A net whose force densities make a positive definite matrix is stable however it bends: super-stable.
Source: Connelly, "Rigidity and energy", Inventiones Mathematicae 66 (1982) 11.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from hookean.forces.springs import Springs

if TYPE_CHECKING:
    from hookean.system.state import State
    from hookean.system.system import System

Floats = NDArray[np.float64]

CERTAIN = 1e9  # multiplications that it may take to find whether a shape is the lowest
FEW = 1e-3  # so few push where supports are points, and have no room to buckle


def suits(system: System) -> bool:
    """Whether a system is of plain springs and constant loads alone, whose shape of least energy is known."""
    plain = False
    for group in system.groups:
        if group.cls is Springs:
            plain = not (group.block.parameters[:, 4:] != 0.0).any()
        elif not group.cls.constant:
            return False
    return plain and not system.contacts


def pulled(system: System, state: State) -> bool:
    """Whether all springs pull, but for a few at supports."""
    return bool((_densities(system, state)[1] < 0.0).mean() <= FEW)


def super_stable(system: System, state: State) -> bool:
    """Whether the force densities of a shape of plain springs are positive definite, where that is quick to find out:
    then it is the shape of least energy, and its tangent positive definite.

    With s the squares of the lengths, k (sqrt(s) - L0)^2 / 2 is convex in s: the energy is nowhere below the quadratic
    form of the force densities q = k (1 - L0 / l), which has its minimum at the shape where it is positive definite:
    always where all springs pull.
    Source: Connelly, Rigidity and energy, Inventiones mathematicae 66 (1982) 11.
    """
    from hookean.linear import front_cholesky as _front
    from hookean.linear.laplacian import form

    pairs, density = _densities(system, state)
    net, rows = form(pairs, density[:, None], state.moving.astype(np.float64), np.zeros(len(state.x)))
    if len(rows) < np.count_nonzero(state.moving):
        return False
    way = _front.front(net, CERTAIN)
    return way is not None and way.held and _front.Factor(net, way).sound


def _densities(system: System, state: State) -> tuple[NDArray[np.int64], Floats]:
    """Ends (m, 2) and force densities (m,) of all springs; none of other forces."""
    pairs, found = [np.zeros((0, 2), np.int64)], [np.zeros(0)]
    for group, memory in zip(system.groups, state.memory, strict=True):
        if group.cls is Springs:
            index, p = group.block.indices, group.block.parameters
            d = state.x.take(index[:, 1], axis=0) - state.x.take(index[:, 0], axis=0)
            length = np.sqrt(np.einsum("ij,ij->i", d, d))
            rest = p[:, 2] * p[:, 3] + memory[:, 0]
            pairs.append(index)
            found.append(p[:, 0] * (1.0 - rest / np.where(length > 0.0, length, 1.0)))
    return np.concatenate(pairs), np.concatenate(found)
