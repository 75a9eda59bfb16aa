"""Slots: the rows of a state that hold the orientations of particles; see `hookean.forces.rotations`.

Particles that a force with `turns` acts on have orientations. Behind the n particles a state has a row for each of
these, its slot, and behind the slots a row for each one's reference, which is held. Scenes without have no such rows.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from hookean.compiled import dispatch
from hookean.forces import Block, Force
from hookean.forces.base import lengths
from hookean.forces.rotations import fold, quaternions

if TYPE_CHECKING:
    from hookean.system.state import State

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

GYRATION = 1.0 / np.sqrt(12.0)  # radius of gyration of a rod of length 1 about its middle


@dataclass(frozen=True)
class Slots:
    """Which of `count` particles have orientations (`particles` (r,), sorted), and the length l (r,) [length] of each
    slot: the radius of gyration of a rod as long as the elements there in the mean, so that a slot has the mass of its
    particle."""

    count: int
    particles: Ints = field(default_factory=lambda: np.zeros(0, np.int64))
    lengths: Floats = field(default_factory=lambda: np.zeros(0))

    def __len__(self) -> int:
        return len(self.particles)

    @classmethod
    def of(cls, x: Floats, blocks: list[Block]) -> Slots:
        """The slots for elements on particles `x` (n, 3), by the blocks of forces that turn."""
        total, number = np.zeros(len(x)), np.zeros(len(x))
        for block in blocks:
            wide = lengths(np.ptp(x[block.indices], axis=1))
            for corner in block.indices.T:
                total += np.bincount(corner, wide, len(x))
                number += np.bincount(corner, minlength=len(x))
        particles = np.flatnonzero(number)
        mean = total[particles] / number[particles]
        return cls(len(x), particles, np.where(mean > 0.0, GYRATION * mean, 1.0))

    @property
    def first(self) -> slice:
        """Rows of the slots."""
        return slice(self.count, self.count + len(self))

    @property
    def references(self) -> slice:
        """Rows of the references."""
        return slice(self.count + len(self), self.count + 2 * len(self))

    def rows(self, particles: Ints) -> Ints:
        """The slot's row of each particle; -1 where it has none."""
        if not len(self):
            return np.full(np.shape(particles), -1)
        place = np.minimum(np.searchsorted(self.particles, particles), len(self) - 1)
        return np.where(self.particles[place] == particles, self.count + place, -1)

    def owner(self, row: int) -> int:
        """The particle that a row belongs to."""
        return row if row < self.count else int(self.particles[(row - self.count) % len(self)])

    def extended(self, rows: Floats, value: float = 0.0) -> Floats:
        """Rows of particles, and behind them those of slots and references."""
        return np.concatenate([rows, np.full((2 * len(self), *rows.shape[1:]), value)]) if len(self) else rows

    def fitted(self, cls: type[Force], block: Block) -> Block:
        """A block whose elements have slots and references behind their particles, where its force uses them."""
        if not cls.turns:
            return block
        particles = block.indices[:, : cls.arity]
        slots = self.rows(particles)
        parameters = block.parameters.copy()
        arms = [i for i, name in enumerate(block.names) if name == "arm"]
        parameters[:, arms] = self.lengths[slots - self.count]
        index = np.ascontiguousarray(np.column_stack([particles, slots, slots + len(self)]))
        return replace(block, indices=index, parameters=parameters)

    def hold_references(self, state: State) -> None:
        """References never move by themselves."""
        state.free[self.references] = 0.0

    def fold(self, state: State) -> None:
        """Take what has turned into the references (see `rotations.fold`)."""
        if len(self):
            dispatch.compiled(fold)(state.x, state.v, self.count, self.lengths)

    def quaternions(self, x: Floats) -> Floats:
        """Unit quaternions w, x, y, z (r, 4) of the orientations in folded rows, turned from the start."""
        return quaternions(x[self.references] / self.lengths[:, None]) if len(self) else np.zeros((0, 4))

    def put(self, state: State, particles: Floats, quaternions: Floats) -> None:
        """Give a state positions (n, 3) [length] and orientations (r, 4) w, x, y, z, as results have them."""
        state.x[: self.count] = particles
        if len(self):
            from scipy.spatial.transform import Rotation

            turned = Rotation.from_quat(np.roll(quaternions, -1, axis=1)).as_rotvec()
            state.x[self.first], state.x[self.references] = 0.0, turned * self.lengths[:, None]

    def moments(self, rows: Floats, particles: Ints) -> Floats:
        """Moments (k, 3) [force length] on particles by forces on rows (folded), 0 where there is no orientation; no
        rows without slots."""
        if not len(self):
            return np.zeros((0, 3))
        own = self.rows(particles)
        arms = np.where(own >= 0, self.lengths[np.maximum(own - self.count, 0)], 0.0)
        return np.asarray(rows[own] * arms[:, None])

    def take_over(self, state: State, mine: Ints, other: Slots, before: State, theirs: Ints) -> None:
        """Give particles `mine` the places, orientations and velocities of particles `theirs` of another state."""
        state.x[mine], state.v[mine] = before.x[theirs], before.v[theirs]
        here, there = self.rows(mine), other.rows(theirs)
        both = (here >= 0) & (there >= 0)
        if not both.any():
            return
        here, there = here[both], there[both]
        scale = (self.lengths[here - self.count] / other.lengths[there - other.count])[:, None]
        for a, b in ((state.x, before.x), (state.v, before.v)):
            a[here] = scale * b[there]
            a[here + len(self)] = scale * b[there + len(other)]
