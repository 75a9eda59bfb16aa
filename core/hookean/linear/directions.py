"""Directions: Newton steps for lines that keep their force while they turn, down to where they nearly vanish.

Of E = T l the tangent is T / l (1 - u u) across the line u and none along it: true for turns much shorter than the line
alone. Here the direction p of the force is an unknown of its own, with l p = d for the vector d along the line instead
of p = d / l. One Newton step of both has, with p taken out, T / l (1 - (u p + p u) / 2) in place of the tangent, and
afterwards p' = u + (1 - (u p + p u) / 2) dd / l for the step dd of d. With p = 0, as a line begins, that is the
stiffness T / l on all axes, whose quadratic is nowhere below the energy; at rest p = u, and steps are those of Newton.
As no p is longer than 1, the stiffness never pushes.
Source: Chan, Golub and Mulet, "A nonlinear primal-dual method for total variation-based image restoration", SIAM J.
Sci. Comput. 20 (1999) 1964; Andersen, Christiansen, Conn and Overton, "An efficient primal-dual interior-point method
for minimizing a sum of Euclidean norms", SIAM J. Sci. Comput. 22 (2000) 243.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from hookean.compiled import dispatch
from hookean.forces.base import lengths

if TYPE_CHECKING:
    from hookean.system.group import Group
    from hookean.system.state import State
    from hookean.system.system import System

Floats = NDArray[np.float64]


def sharp(system: System) -> bool:
    """Whether the directions of some forces are unknowns: lines pull with a force that keeps its size."""
    return system.films is None and any(_pulls(group).any() for group in system.groups if group.cls.sharp)


def alone(system: System) -> bool:
    """The same, and no other force changes with the shape."""
    return sharp(system) and all(group.cls.sharp or group.cls.constant for group in system.groups)


def begin(system: System) -> Floats:
    """The directions (m, 3) [-] of all lines of such forces at the start: none."""
    return np.zeros((sum(len(group.block.indices) for group in system.groups if group.cls.sharp), 3))


class Directions:
    """The directions (m, 3) that lines have at a shape, and how they follow a step."""

    def __init__(self, system: System, state: State, given: Floats) -> None:
        self._lines: dict[str, _Lines] = {}
        self._given, first = given, 0
        for group, memory in zip(system.groups, state.memory, strict=True):
            if group.cls.sharp:
                own = given[first : first + len(group.block.indices)]
                self._lines[group.cls.kind_name] = _Lines(group, memory, state.x, own)
                first += len(own)

    def put(self, group: Group, blocks: Floats) -> None:
        """Put the tangent with these directions in the place of that of a group in its blocks (m, 6, 6)."""
        if group.cls.kind_name in self._lines:
            self._lines[group.cls.kind_name].put(blocks)

    def after(self, step: Floats) -> Floats:
        """The directions after a step (n, 3) [length] with that tangent."""
        return np.concatenate([self._given[:0], *(lines.after(step) for lines in self._lines.values())])


class _Lines:
    """Those of one group."""

    def __init__(self, group: Group, memory: Floats, x: Floats, given: Floats) -> None:
        b, rows = group.block, np.empty((len(group.block.indices), 5))
        assert group.cls.central is not None
        dispatch.compiled(group.cls.central, "central")(x, b.indices, b.parameters, memory, rows)
        self.ends, self.given, self.unit = b.indices, given, rows[:, 2:]
        self.across = rows[:, 1]
        self.whole = (rows[:, 0] == 0.0) & (self.across > 0.0)  # as long as they pull with all of their force
        most = b.parameters[:, b.names.index(group.cls.sharp)]
        self.turn = np.divide(self.across, most, out=np.zeros(len(rows)), where=most > 0.0)  # 1 / length
        force = self.across * lengths(x[self.ends[:, 1]] - x[self.ends[:, 0]])
        self.now = np.divide(force, most, out=np.zeros(len(rows)), where=most > 0.0)[:, None] * self.unit

    def put(self, blocks: Floats) -> None:
        u, half = self.unit[:, :, None], 0.5 * self.unit[:, :, None] * self.given[:, None, :]
        more = np.where(self.whole, self.across, 0.0)[:, None, None] * (
            u * self.unit[:, None, :] - half - half.transpose(0, 2, 1)
        )
        blocks[:, :3, :3] += more
        blocks[:, 3:, 3:] += more
        blocks[:, :3, 3:] -= more
        blocks[:, 3:, :3] -= more

    def after(self, step: Floats) -> Floats:
        u, p = self.unit, self.given
        moved = step[self.ends[:, 1]] - step[self.ends[:, 0]]
        turned = 0.5 * (p * _dot(u, moved) + u * _dot(p, moved))
        found = self.now + self.turn[:, None] * (moved - np.where(self.whole[:, None], turned, 0.0))
        return np.asarray(found / np.maximum(lengths(found), 1.0)[:, None])


def _dot(a: Floats, b: Floats) -> Floats:
    return np.asarray(np.einsum("ij,ij->i", a, b)[:, None])


def _pulls(group: Group) -> NDArray[np.bool_]:
    return np.asarray(group.block.parameters[:, group.block.names.index(group.cls.sharp)] > 0.0)
