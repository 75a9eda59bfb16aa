"""Spreading: films over their rims in one linear solve, vertices evenly spread.

The Dirichlet energy of a map from triangles with cotangents c (opposite to edges l) is D = T sum(c l^2) / 4. Mapped
from the film as it is, D is T times its area, and its minimum has less area and triangles that are more even: D >= T A
for any map, with equality where it is conformal. Mapped from a sound shape, a minimum makes a sound film of a torn one.
Yarns count as springs of their present force density, which bounds their energy in the same way.

Source: Pinkall and Polthier, "Computing discrete minimal surfaces and their conjugates", 1993.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from hookean.compiled import dispatch
from hookean.films import SLIDING
from hookean.forces.base import lengths
from hookean.forces.soapfilm import SoapFilm
from hookean.linear.sparse_factors import Factors

if TYPE_CHECKING:
    from hookean.films import Films
    from hookean.system.group import Group
    from hookean.system.state import State
    from hookean.system.system import System

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Flags = NDArray[np.bool_]


class Spread:
    """The linear systems of films in which they act alone: a number for each pair of particles."""

    def __init__(self, system: System, films: Films, free: Floats) -> None:
        self.films = films
        self._group: Group = next(g for g in system.groups if g.cls is SoapFilm)
        self._parts: list[Axes] = []
        left = [0, 1, 2]
        while left:
            moving = films.pure & (free[:, left[0]] > 0.0)
            axes = [axis for axis in left if np.array_equal(films.pure & (free[:, axis] > 0.0), moving)]
            left = [axis for axis in left if axis not in axes]
            if moving.any():
                self._parts.append(Axes(films.corners, moving, axes))

    def motion(self, system: System, state: State, blocks: Floats, led: Floats | None = None) -> Floats | None:
        """The motion (n, 3) of particles of films alone to where `blocks` balance what else counts, all others having
        moved as they are `led` (n, 3); None where nothing holds the film."""
        index = self._group.block.indices
        left = self._others(system, state)
        dispatch.compiled(pull)(index, blocks, state.x if led is None else state.x + led, left)
        moved = np.zeros_like(state.x)
        for part in self._parts:
            solution = part.solve(blocks, left)
            if solution is None:
                return None
            moved[np.ix_(part.particles, part.axes)] = solution
        return moved

    def sliding(self, system: System, state: State, led: Floats) -> Floats:
        """The motion (n, 3) along edges of particles that slide along curves, having moved as they are `led` (n, 3), to
        where they divide their edges as drawn: springs of rest length 0 as stiff as they were short."""
        from scipy.sparse import coo_matrix
        from scipy.sparse.linalg import spsolve

        films, found = self.films, np.zeros_like(led)
        axes, counts = films.frames(state.x, state.free)
        slides = np.flatnonzero((films.kind == SLIDING) & (counts.sum(axis=1) < state.free.sum(axis=1)))
        if not len(slides):
            return found
        number = np.full(len(led), -1)
        number[slides] = np.arange(len(slides))
        along, x = axes[slides, 0], state.x + led
        whole, right = np.zeros(len(slides)), np.zeros(len(slides))
        rows, columns, values = [np.arange(len(slides))], [np.arange(len(slides))], [whole]
        for other in films.ends[slides].T:
            drawn = lengths(system.x[other] - system.x[slides])
            stiffness = 1.0 / np.maximum(drawn, 0.01 * drawn.mean() or 1.0)
            whole += stiffness * (1.0 + 1e-9)  # a closed edge may turn as a whole
            right += stiffness * ((x[other] - x[slides]) * along).sum(axis=1)
            both = number[other] >= 0
            rows.append(np.flatnonzero(both))
            columns.append(number[other][both])
            values.append(-(stiffness * (along * axes[other, 0]).sum(axis=1))[both])
        matrix = coo_matrix((np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))))
        found[slides] = spsolve(matrix.tocsc(), right)[:, None] * along
        return found

    def _others(self, system: System, state: State) -> Floats:
        """What forces other than those of films put (n, 3) on particles of films alone, of what counts."""
        f, _, _ = system.evaluate(state)
        own, block = np.zeros_like(f), self._group.block
        force = dispatch.compiled(SoapFilm.kernel, "force")
        force(state.x, np.zeros_like(f), block.indices, block.parameters, block.memory, own, np.zeros(len(f)))
        f -= own
        self.films.across(state.x, state.free, f)
        return f

    def sides(self, x: Floats) -> Floats:
        """The mean side (n,) [length] of the triangles around each particle; of all where there are none."""
        corners, n = self.films.corners, len(x)
        one, two, three = (lengths(x[corners[:, i]] - x[corners[:, i - 1]]) for i in range(3))
        mean = (one + two + three) / 3.0
        count = np.bincount(corners.ravel(), minlength=n)
        total = np.bincount(corners.ravel(), np.repeat(mean, 3), n)
        return np.where(count > 0, total / np.maximum(count, 1), mean.mean())

    def sound(self, system: System, state: State) -> Floats | None:
        """Blocks (m, 3, 3) as drawn of films that are torn as they are, their own of others; None if none is torn."""
        films = self.films
        torn = films.torn(state.x, state.free)
        if not torn.any():
            return None
        drawn = films.conductances(system.x, films.torn(system.x, state.free))
        return np.where(torn[:, None, None], drawn, films.conductances(state.x))


class Axes:
    """One system for the axes on which the same particles move."""

    def __init__(self, corners: Ints, moving: Flags, axes: list[int]) -> None:
        self.particles, self.axes = np.flatnonzero(moving), np.array(axes)
        size, number = len(self.particles), np.cumsum(moving) - 1
        row, column = np.repeat(corners, 3, axis=1).ravel(), np.tile(corners, (1, 3)).ravel()
        self._taken = np.flatnonzero((row >= column) & moving[row] & moving[column])
        key = number[column[self._taken]] * size + number[row[self._taken]]
        pairs, self._places = np.unique(key, return_inverse=True)
        self._count = len(pairs)
        starts = np.searchsorted(pairs, size * np.arange(size + 1)).astype(np.int32)
        self._factors = Factors((pairs % size).astype(np.int32), starts)

    def solve(self, blocks: Floats, forces: Floats) -> Floats | None:
        """The solution (k, axes); None unless the system is positive definite."""
        values = np.bincount(self._places, blocks.reshape(-1)[self._taken], self._count).astype(np.float64)
        factor = self._factors.factor(values)
        if factor is None or factor.negatives:
            return None
        columns = [factor.solve(forces[self.particles, axis]) for axis in self.axes]
        return np.stack(columns, axis=-1) if np.isfinite(columns).all() else None


def pull(indices, blocks, x, f):  # type: ignore[no-untyped-def]
    """f -= blocks x."""
    for e in range(indices.shape[0]):
        for i in range(3):
            for j in range(3):
                for c in range(3):
                    f[indices[e, i], c] -= blocks[e, i, j] * x[indices[e, j], c]
