"""Across: the tangent stiffness of scenes with soap films, along the axes that count (see `hookean.films`)."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from hookean.compiled import dispatch
from hookean.forces import Block
from hookean.linear.pattern import Pattern
from hookean.system.group import Group

if TYPE_CHECKING:
    from hookean.linear.directions import Directions
    from hookean.system.state import State
    from hookean.system.system import System

Floats = NDArray[np.float64]

CHUNK = 20_000  # elements whose blocks are in memory at a time


def patterned(system: System, state: State, free: Floats, known: Pattern | None = None) -> Pattern:
    """The pattern of a shape on the axes with `free` (n, 3) above 0, or along those that count where there are films;
    the `known` one where that has as many."""
    if system.films is not None:
        return across(system, state, free, known)
    return known if known is not None and np.array_equal(known.free, free) else Pattern(system, free)


def across(system: System, state: State, free: Floats, known: Pattern | None = None) -> Across:
    """The pattern of a shape with films; the `known` one with other axes, where as many of each particle count."""
    films = system.films
    assert films is not None
    axes, counts = films.frames(state.x, free)
    if not isinstance(known, Across) or not np.array_equal(known.free, counts):
        known = Across(system, counts)
    known.axes = axes
    return known


class Across(Pattern):
    """A pattern with a row for each of the `axes` (n, 3, 3) that counts: one for a particle within a film, three for
    one that a spring holds, too. Forces and motions come and go as vectors (n, 3) all the same."""

    axes: Floats

    def tangent(self, system: System, state: State, directions: Directions | None = None) -> Floats:
        """Values of the lower triangle of the tangent stiffness along the axes; `directions` are not for films."""

        def turned(group: Group, memory: Floats, part: slice) -> Floats:
            some = Block(group.block.indices[part], group.block.parameters[part], memory[part])
            blocks = system.stiffness_blocks(Group(group.cls, some, []), state, memory[part])
            more = max(int(some.indices.max()) + 1 - len(self.axes), 0)  # unknowns that elements have of their own
            axes = np.concatenate([self.axes, np.tile(np.eye(3), (more, 1, 1))]) if more else self.axes
            dispatch.compiled(turn_blocks)(axes, some.indices, blocks)
            return blocks

        return self._gathered(self.elements(system, state), turned)

    def of_films(self, system: System, state: State, numbers: Floats) -> Floats:
        """The same of blocks that are a number (m, 3, 3) for each pair of corners of the triangles of films."""

        def turned(group: Group, memory: Floats, part: slice) -> Floats:
            index = group.block.indices[part]
            blocks = np.zeros((len(index), 3 * index.shape[1], 3 * index.shape[1]))
            if group.cls.is_film:
                dispatch.compiled(turn_numbers)(self.axes, index, numbers[part], blocks)
            return blocks

        return self._gathered(self.elements(system, state), turned)

    def _gathered(
        self, elements: list[tuple[Group, Floats]], turned: Callable[[Group, Floats, slice], Floats]
    ) -> Floats:
        """The sum of blocks, those of a part of a group's elements at a time."""
        summed, at = np.zeros(self.count), 0
        for (group, memory), take in zip(elements, self.takes, strict=True):
            index = group.block.indices
            size = 9 * index.shape[1] ** 2
            for first in range(0, len(index) if len(take) else 0, CHUNK):
                low, high = np.searchsorted(take, [first * size, (first + CHUNK) * size])
                values = turned(group, memory, slice(first, first + CHUNK)).ravel()[take[low:high] - first * size]
                summed += np.bincount(self.places[at + low : at + high], values, self.count)
            at += len(take)
        return summed

    def gather(self, vectors: Floats) -> Floats:
        """Vectors (n, 3) as unknowns: their parts along the axes that count."""
        return super().gather(np.einsum("nij,nj->ni", self.axes, vectors))

    def spread(self, unknowns: Floats) -> Floats:
        """Unknowns, parts along the axes that count, as vectors (n, 3)."""
        return np.asarray(np.einsum("nij,ni->nj", self.axes, super().spread(unknowns)))


def turn_blocks(axes, indices, blocks):  # type: ignore[no-untyped-def]
    """Blocks of elements along the axes of their particles, in place."""
    turned = np.empty((3, 3))
    for e in range(indices.shape[0]):
        for i in range(indices.shape[1]):
            for j in range(indices.shape[1]):
                a, b = axes[indices[e, i]], axes[indices[e, j]]
                block = blocks[e, 3 * i : 3 * i + 3, 3 * j : 3 * j + 3]
                for r in range(3):
                    for c in range(3):
                        turned[r, c] = a[r, 0] * block[0, c] + a[r, 1] * block[1, c] + a[r, 2] * block[2, c]
                for r in range(3):
                    for c in range(3):
                        block[r, c] = turned[r, 0] * b[c, 0] + turned[r, 1] * b[c, 1] + turned[r, 2] * b[c, 2]


def turn_numbers(axes, indices, numbers, blocks):  # type: ignore[no-untyped-def]
    """Blocks along the axes of particles, of a number for each pair of them."""
    for e in range(indices.shape[0]):
        for i in range(indices.shape[1]):
            for j in range(indices.shape[1]):
                a, b = axes[indices[e, i]], axes[indices[e, j]]
                for r in range(3):
                    for c in range(3):
                        dot = a[r, 0] * b[c, 0] + a[r, 1] * b[c, 1] + a[r, 2] * b[c, 2]
                        blocks[e, 3 * i + r, 3 * j + c] = numbers[e, i, j] * dot
