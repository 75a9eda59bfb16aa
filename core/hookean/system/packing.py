"""Lean: what the solvers' loops run over, thousands of times for each time a person looks.

Positions, velocities and forces have four columns, x y z and a zero, so that a particle is one vector of the processor.
Blocks are packed where their force can (`Force.pack`): they then give forces alone, neither stiffness nor energy.
Forces that never change are summed once.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.compiled import dispatch
from hookean.films.evenness import keeper
from hookean.system.group import Group
from hookean.system.state import State
from hookean.system.system import System

Floats = NDArray[np.float64]

LINE = 64  # bytes of a cache line
PAGE = 4096  # the processor takes addresses that are equal within a page for the same at first


@dataclass(frozen=True)
class Lean:
    """Tables of the force kernels for a loop (see `dispatch.table`), with their arrays in full or packed; `load` (n, 3)
    is the sum of the constant forces, which are in no table."""

    full: Any
    packed: Any
    quiet: Any  # the packed ones that change with the places of particles alone
    lively: Any  # and those that change with their speeds, or at the end of a step
    load: Floats
    calls: tuple[list[Any], list[Any]]  # kernels with their arrays, in full and packed, as the tables have them
    even: list[Any]  # and what keeps films even, last in all tables but the lively one


def lean(system: System, state: State, *, damped: bool) -> Lean:
    """The forces of a system for a loop; without `damped` the velocities do nothing."""
    load = np.zeros_like(state.x)
    full: list[Any] = []
    packed: list[Any] = []
    quiet: list[Any] = []
    lively: list[Any] = []
    for group, memory in zip(system.groups, state.memory, strict=True):
        b, kernel = group.block, group.cls.kernel
        if group.cls.constant:
            dispatch.compiled(kernel, "force")(state.x, load, b.indices, b.parameters, memory, load, load[:, 0].copy())
        else:
            full.append((kernel, group.cls.whole(b, memory)))
            packed.append((kernel, _packed(group, memory, damped)))
            (lively if damped and (group.damped or group.yields) else quiet).append(packed[-1])
    even = keeper(system, state)
    last = [] if even is None else [even]  # after all forces
    every = dispatch.table("force", packed + last)
    still = dispatch.table("force", quiet + last) if lively else every
    tables = dispatch.table("force", full + last), every, still, dispatch.table("force", lively)
    return Lean(*tables, load, (full, packed), last)


def contacts(system: System) -> tuple[Any, Any]:
    """Tables of the contacts' impact and support hooks."""
    impacts = [(g.cls.impact, (g.block.parameters,)) for g in system.contacts if g.cls.impact]
    supports = [(g.cls.support, (g.block.parameters,)) for g in system.contacts if g.cls.support]
    return dispatch.table("impact", impacts), dispatch.table("support", supports)


def _packed(group: Group, memory: Floats, damped: bool) -> tuple[Any, Any, Any]:
    """Indices, parameters and memory of a group, packed if its force can."""
    block = group.block
    if group.cls.pack is not None and (packed := group.cls.pack(block, memory, damped)) is not None:
        return (*packed, memory)[:3]
    if damped or not group.cls.damped:
        return block.indices, block.parameters, memory
    # kernels see no speed, and need not look for one at every element
    return block.indices, np.where([name == "damping" for name in block.names], 0.0, block.parameters), memory


class Seen:
    """Remembers what the forces of a system are made of, to detect changes."""

    def __init__(self) -> None:
        self._system: System | None = None
        self._arrays: list[Floats] = []
        self._copies: list[Floats] = []

    def same(self, system: System, state: State) -> bool:
        """Whether all parameters and memories are the arrays and have the numbers they had when last asked."""
        arrays = [
            a for g, memory in zip(system.groups, state.memory, strict=True) for a in (g.block.parameters, memory)
        ]
        arrays = [a for a in arrays + [g.block.parameters for g in system.contacts] if a.size]
        if system.films is not None:
            arrays.append(state.free)  # what keeps films even has it, too
        if (
            self._system is system
            and len(arrays) == len(self._arrays)
            and all(a is b for a, b in zip(arrays, self._arrays, strict=True))
            and all(dispatch.same(a, b) for a, b in zip(arrays, self._copies, strict=True))
        ):
            return True
        self._system, self._arrays, self._copies = system, arrays, [a.copy() for a in arrays]
        return False


class Desk:
    """Where a solver lays out its arrays, call after call: new memory of a large net costs as much as several steps."""

    def __init__(self) -> None:
        self._shape = (0, 0)
        self._rows: list[Floats] = []

    def lay(self, n: int, *rows: Floats | None) -> list[Floats]:
        """Copies of rows (n, 3) with a fourth column of zeros, or zeros (n, 4) for None; starts spread over a page.
        They hold until the next call."""
        made, _ = self.keep(n, len(rows))
        for array, given in zip(made, rows, strict=True):
            if given is None:
                array[:] = 0.0
            else:
                array[:, :3] = given
                array[:, 3] = 0.0
        return made

    def keep(self, n: int, count: int) -> tuple[list[Floats], bool]:
        """That many rows (n, 4) as the last call left them, and whether they are new: all zeros."""
        new = (n, count) != self._shape
        if new:
            size = -(-32 * n // PAGE) * PAGE + PAGE // count // LINE * LINE
            raw = np.zeros(size * count + PAGE, np.uint8)
            start = -raw.ctypes.data % PAGE
            places = range(start, start + size * count, size)
            self._shape = (n, count)
            self._rows = [raw[place : place + 32 * n].view(np.float64).reshape(n, 4) for place in places]
        return self._rows.copy(), new
