"""The unknowns of a design problem: the values of its variables as one vector, put into a system and differentiated."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.designing.columns import AXES, Column, Entries, shape_of, tied
from hookean.designing.equilibrium import Equilibrium, as_held
from hookean.designing.problem import Problem, Variable
from hookean.errors import InputError
from hookean.forces.base import Block, Force
from hookean.running.patch import lead_forces, named
from hookean.scene.scene import Scene
from hookean.system.group import Group
from hookean.system.state import State
from hookean.system.system import Held, System, hold

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

NOTHING = np.zeros(0, np.int64)


class Moved:
    """A variable that is where an anchor holds its particles."""

    unit = "length"

    def __init__(self, variable: Variable, system: System, pointer: str) -> None:
        assert variable.anchor is not None
        self.variable, self.pointer = variable, pointer
        self.anchor: Held = named(system.held, variable.anchor, f"{pointer}/anchor")
        columns = np.array([AXES[a] for a in variable.axes])
        loose = [a for a in variable.axes if self.anchor.free[AXES[a]] > 0.0]
        if loose:
            raise InputError(f"{pointer}/axes", f"the anchor does not hold its particles along {''.join(loose)}")
        self.home = self.anchor.targets.copy()
        self.shifts = variable.tie != "each"
        values = np.zeros_like(self.home) if self.shifts else self.home
        self.entries = Entries(values, tied(variable, len(self.home), columns, 3, pointer))
        self.shape = shape_of(len(columns), self.entries.count, variable.axes)
        self.lower = -np.inf

    def targets(self, unknowns: Floats) -> Floats:
        """Where the particles (k, 3) are held [length]."""
        values = self.entries.with_values(unknowns)
        return self.home + values if self.shifts else values


class Unknowns:
    """All variables of a problem as one vector."""

    def __init__(self, problem: Problem, system: System) -> None:
        self.problem = problem
        self.variables: list[Column | Moved] = []
        for i, variable in enumerate(problem.variables):
            cls = Column if variable.force is not None else Moved
            self.variables.append(cls(variable, system, f"/variables/{i}"))
        ends = np.cumsum([v.entries.count for v in self.variables])
        self.slices = [slice(int(e) - v.entries.count, int(e)) for v, e in zip(self.variables, ends, strict=True)]
        self.parts = [*zip(self.variables, self.slices, strict=True), *self._driven(system)]
        """All columns and anchors that vary, each with its part of the unknowns: variables, and what they drive."""
        self.count = int(ends[-1])
        if not self.count:
            raise InputError("/variables", "nothing varies: the forces have no elements")
        self.start = np.concatenate([v.entries.start for v in self.variables])
        self.lower, self.upper = self._bounds()
        outside = (self.start < self.lower) | (self.start > self.upper)
        self.start = np.clip(self.start, self.lower, self.upper)
        self.clipped = int(outside.sum())

    def _driven(self, system: System) -> list[tuple[Column | Moved, slice]]:
        """The columns that follow variables."""
        found: list[tuple[Column | Moved, slice]] = []
        for i, (variable, part) in enumerate(zip(self.variables, self.slices, strict=True)):
            for j, drive in enumerate(variable.variable.drives):
                pointer = f"/variables/{i}/drives/{j}"
                own = variable.variable.replaced(force=drive.force, field=drive.field, drives=())
                column = Column(own, system, pointer, drive.factor)
                if column.entries.count != variable.entries.count:
                    said = f"it has {column.entries.count} values, the variable {variable.entries.count}; use tie"
                    raise InputError(pointer, said)
                found.append((column, part))
        return found

    def _bounds(self) -> tuple[Floats, Floats]:
        lower, upper = np.full(self.count, -np.inf), np.full(self.count, np.inf)
        for variable, part in zip(self.variables, self.slices, strict=True):
            given = variable.variable
            lower[part] = variable.lower if given.lower is None else max(variable.lower, given.lower)
            upper[part] = np.inf if given.upper is None else given.upper
        for column, part in self.parts[len(self.variables) :]:
            if column.lower == 0.0 and isinstance(column, Column):
                end, to = (lower, np.maximum) if column.factor > 0.0 else (upper, np.minimum)
                end[part] = to(end[part], 0.0)
        return lower, upper

    def begin(self, values: Any) -> None:
        """Start from these values (u,), within the bounds; InputError unless they are one finite number for each."""
        try:
            given = np.asarray(values, dtype=np.float64)
        except (TypeError, ValueError, OverflowError):
            given = np.zeros(0)
        if given.shape != (self.count,) or not np.isfinite(given).all():
            raise InputError("/start", f"{self.count} finite numbers are expected, one for each unknown")
        self.start = np.clip(given, self.lower, self.upper)

    @property
    def differ(self) -> bool:
        """Whether the scene has other values than the start: where variables tie, drive or are cut at bounds."""
        entries = [(part, variable.entries) for variable, part in self.parts]
        return any(not np.array_equal(e.with_values(self.start[part]), e.values) for part, e in entries)

    @property
    def scale(self) -> Floats:
        """The size (u,) of each unknown: of its value, of its bounds, or of the mean of its variable."""
        found = np.empty(self.count)
        for variable, part in zip(self.variables, self.slices, strict=True):
            size = np.abs(self.start[part])
            if isinstance(variable, Moved):
                extent = float(np.ptp(variable.home, axis=0).max(initial=0.0))
                size = np.full(len(size), extent or float(np.abs(variable.home).max(initial=0.0)) or 1.0)
            mean = float(size.mean()) or 1.0
            found[part] = np.maximum(size, 0.1 * mean)
        return found

    def put(self, system: System, state: State, values: Floats) -> None:
        """Give a system and its state these values (u,)."""
        forces: dict[int, Force] = {}
        scene = system.scene
        for variable, part in self.parts:
            own = values[part]
            if isinstance(variable, Moved):
                variable.anchor.targets = np.ascontiguousarray(variable.targets(own))
                continue
            forces[variable.number] = variable.changed(
                scene.replaced(forces=tuple(forces.get(i, f) for i, f in enumerate(scene.forces))), own
            )
        if forces:
            lead_forces(system, forces)
        for variable, part in self.parts:
            if isinstance(variable, Column):
                variable.entries = replace(variable.entries, values=variable.numbers(values[part]))
        for anchor in system.held:
            hold(state, anchor, system.slots)

    def scene(self, scene: Scene) -> Scene:
        """The scene with the anchors where they are held now; forces have their values already."""
        return as_held(scene, [v.anchor for v in self.variables if isinstance(v, Moved)])

    def slopes(self, found: Equilibrium) -> tuple[Any, Any]:
        """df/du (3n, u) [force by unit] at fixed positions, and how held particles move, dx_h/du (3n, u)."""
        from scipy.sparse import coo_matrix

        pushes: list[tuple[Ints, Ints, Floats]] = []
        moves: list[tuple[Ints, Ints, Floats]] = []
        for variable, part in self.parts:
            rows = _pushed(found, variable) if isinstance(variable, Column) else _led(variable)
            (pushes if isinstance(variable, Column) else moves).append((rows[0], rows[1] + part.start, rows[2]))
        shape = (found.x.size, self.count)

        def matrix(entries: list[tuple[Ints, Ints, Floats]]) -> Any:
            if not entries:
                return coo_matrix(shape).tocsc()
            rows, columns, values = (np.concatenate(each) for each in zip(*entries, strict=True))
            return coo_matrix((values, (rows, columns)), shape=shape).tocsc()

        return matrix(pushes), matrix(moves)


def _led(variable: Moved) -> tuple[Ints, Ints, Floats]:
    """How an anchor's particles move: places in (3n, unknowns), and ones."""
    row, axis = np.nonzero(variable.entries.tie >= 0)
    return (3 * variable.anchor.particles[row] + axis, variable.entries.tie[row, axis], np.ones(len(row)))


def _pushed(found: Equilibrium, variable: Column) -> tuple[Ints, Ints, Floats]:
    """df/du of a column: places in (3n, unknowns), and values."""
    system, state = found.system, found.state
    group, part = variable.group, variable.part
    memory = state.memory[system.groups.index(group)]
    several = sum(part.number == variable.number for other in system.groups for part in other.parts) > 1
    if several or group.cls.gathered(group.block, memory, state.x, None) is not None:
        return _pushed_together(found, variable)

    def forces(force: Force, block: Block) -> Floats:
        return system.element_forces(Group(group.cls, block, []), state, memory[part.rows])

    index = group.block.indices[part.rows]
    rows, columns, values = [NOTHING], [NOTHING], [np.zeros(0)]
    for unknown, slope in variable.differences(system, forces):
        kept = unknown >= 0
        place = 3 * index[kept][:, :, None] + np.arange(3)
        rows.append(place.ravel())
        columns.append(np.repeat(unknown[kept], 3 * index.shape[1]))
        values.append(slope[kept].ravel())
    return np.concatenate(rows), np.concatenate(columns), np.concatenate(values)


def _pushed_together(found: Equilibrium, variable: Column) -> tuple[Ints, Ints, Floats]:
    """The same where elements feel one another: all forces, for one unknown at a time."""
    system, first = found.system, variable.force

    def forces(force: Force, block: Block) -> Floats:
        lead_forces(system, {variable.number: force})
        return system.evaluate(found.state)[0]

    rows, columns, values = [NOTHING], [NOTHING], [np.zeros(0)]
    for unknown in range(variable.entries.count):
        step = variable.step(unknown)
        change = np.where(variable.entries.tie == unknown, step, 0.0)
        slope = variable.factor * variable.slope(system, change, forces).ravel() / step
        place = np.flatnonzero(slope)
        rows.append(place)
        columns.append(np.full(len(place), unknown))
        values.append(slope[place])
    lead_forces(system, {variable.number: first})
    return np.concatenate(rows), np.concatenate(columns), np.concatenate(values)
