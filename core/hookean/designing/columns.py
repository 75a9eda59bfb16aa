"""Columns of forces as variables: their values, and derivatives of what a force says by them.

Derivatives come from differences of the compiled kernel with all elements changed at once, so every force has them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from hookean.designing.ranges import natural
from hookean.designing.readers import readers
from hookean.errors import InputError
from hookean.forces.base import PLACES, Block, Force, Rider
from hookean.running.patch import changed_forces
from hookean.scene.catalogue import unit
from hookean.scene.load_cases import case_loads
from hookean.scene.scene import Scene
from hookean.system.group import Group, Part, fitted, ride
from hookean.system.system import System
from hookean.system.weld import element_columns, takes_a_vector

if TYPE_CHECKING:
    from hookean.designing.problem import Variable

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Give = Callable[[Force | None, Block], Floats]

STEP = 1e-5  # of a value, and of the mean of its column: the error is its square, and rounding 1e-11
NOTHING = 1e-9  # part of the first values: means that are less are 0 but for rounding
JUMP = 1e-7  # part of the values: what is less is rounding
MANY = 40  # unknowns of a force as a whole, above which it pays to find the elements that each number changes
AXES = {"x": 0, "y": 1, "z": 2}


@dataclass
class Entries:
    """Numbers (m, c) of which some vary: `tie` (m, c) has the unknown of each, -1 where it keeps its value."""

    values: Floats
    tie: Ints

    @cached_property
    def count(self) -> int:
        """How many unknowns there are."""
        return int(self.tie.max(initial=-1)) + 1

    @property
    def start(self) -> Floats:
        """The mean value (count,) of the entries of each unknown."""
        kept = self.tie >= 0
        tie, values = (self.tie.ravel(), self.values.ravel()) if kept.all() else (self.tie[kept], self.values[kept])
        return np.asarray(np.bincount(tie, values, self.count) / np.bincount(tie, minlength=self.count))

    def with_values(self, unknowns: Floats) -> Floats:
        """All numbers (m, c), those that vary with these values (count,)."""
        return np.where(self.tie >= 0, unknowns[np.maximum(self.tie, 0)], self.values)


def tied(variable: Variable, rows: int, columns: Ints, width: int, pointer: str) -> Ints:
    """The unknown of each of (rows, width) numbers, those of `columns` varying."""
    found = np.full((rows, width), -1)
    if isinstance(variable.tie, str):
        each = variable.tie == "each"
        number = np.arange(rows) if each else np.zeros(rows, np.int64)
        found[:, columns] = number[:, None] * len(columns) + np.arange(len(columns))
        return found
    for i, group in enumerate(np.asarray(group) for group in variable.tie):
        if not len(group) or group.max() >= rows:
            given = "no elements" if not len(group) else f"element {int(group.max())}"
            raise InputError(f"{pointer}/tie/{i}", f"{given} given; there are {rows}, counted from 0")
        if (found[np.ix_(group, columns)] >= 0).any():
            twice = int(group[(found[np.ix_(group, columns)] >= 0).any(axis=1)][0])
            raise InputError(
                f"{pointer}/tie/{i}", f"element {twice} is in an earlier list, too; give each element once"
            )
        found[np.ix_(group, columns)] = i * len(columns) + np.arange(len(columns))
    return found


class Column:
    """A variable that is a column of a force: `entries` with a row for each element, or as many as the force has of a
    column that it takes as a whole: one for each face, vertex or point, or one alone."""

    def __init__(self, variable: Variable, system: System, pointer: str, factor: float = 1.0) -> None:
        self.variable, self.pointer, self.factor = variable, pointer, factor
        self.number = numbered(system.scene, variable.force, f"{pointer}/force")
        self.group, self.part = placed(system, self.number, f"{pointer}/force")
        given = self._given(system)
        self.elements = len(system.places.recompile(self.number, self.force).indices)
        vector = dict(element_columns(type(self.force))).get(variable.field)
        if self.group.block.rooms and vector is None:
            said = f"{variable.field} of {self.force.kind_name} cannot vary; it is fixed geometry"
            raise InputError(f"{pointer}/field", said)
        self.given_shape = given.shape
        self.by_element = vector is not None and self._by_element(system, given, vector)
        if self.by_element:
            wide = 3 if vector or given.ndim == 2 else 1
            rows = 1 if variable.tie == "all" and given.ndim == int(bool(vector)) else self.elements
            values = np.array(np.broadcast_to(given if given.ndim == 2 else given.reshape(-1, wide), (rows, wide)))
        else:
            several = given.ndim > 1 or (given.ndim == 1 and takes_a_vector(type(self.force), variable.field))
            wide = given.shape[-1] if several else 1
            values = given.reshape(-1, wide).copy()
        columns = np.array([AXES[a] for a in variable.axes]) if wide == 3 else np.arange(wide)
        self.entries = Entries(values, tied(variable, len(values), columns, wide, pointer))
        self.shape = shape_of(len(columns), self.entries.count, wide > 1)
        whole = self.entries.values
        self.lower, self.upper = natural(
            type(self.force), variable.field, whole, lambda v: self._accepts(system, self._field(v))
        )
        self.size = float(np.abs(whole).mean()) or 1.0
        self._readers: list[Ints | None] = []

    @property
    def force(self) -> Force:
        """The force as it is now."""
        return self.part.force

    @property
    def unit(self) -> str:
        """The unit of the column, such as `force/length`; empty for a number."""
        return unit(type(self.force).model_fields[self.variable.field]).strip("-")

    def _given(self, system: System) -> Floats:
        """The column's values as they are given, or as the force works them out."""
        field, force = self.variable.field, self.force
        known = [n for n in type(force).model_fields if n not in ("kind", "name", *PLACES)]
        if field not in known:
            said = f"{force.kind_name} has no column {field!r}; it has {', '.join(known)}"
            raise InputError(f"{self.pointer}/field", said)
        value = getattr(force, field)
        if value is None and field in self.group.block.names:
            value = system.places.recompile(self.number, force).parameters[:, self.group.block.names.index(field)]
        if value is None:
            raise InputError(f"{self.pointer}/field", f"{field} has no value to start from; give it one")
        text = isinstance(value, np.ndarray) and value.dtype.kind == "U"
        if text or isinstance(value, bool | str) or not isinstance(value, int | float | np.ndarray):
            raise InputError(f"{self.pointer}/field", f"{field} is not a number; only numbers vary")
        return np.asarray(value, dtype=np.float64)

    def _by_element(self, system: System, given: Floats, vector: bool) -> bool:
        """Whether the column takes a row for each element."""
        if given.ndim == 2:
            return given.shape == (self.elements, 3)
        if given.ndim == 1 and not vector:
            return len(given) == self.elements
        rows = np.broadcast_to(given, (self.elements, *given.shape))
        return self._accepts(system, rows)

    def _accepts(self, system: System, value: Any) -> bool:
        try:
            changed_forces(system.scene, {str(self.number): {self.variable.field: value}})
        except InputError:
            return False
        return True

    def _field(self, values: Floats) -> Any:
        """Numbers (m, c) in the shape that the field takes."""
        if not self.by_element:
            whole = values.reshape(self.given_shape)
            return whole if whole.ndim else float(whole)
        if values.shape[1] == 3:
            return values if len(self.given_shape) == 2 or len(values) > 1 or self.variable.tie != "all" else values[0]
        return values[:, 0] if len(values) > 1 or self.given_shape else float(values[0, 0])

    def changed(self, scene: Scene, unknowns: Floats) -> Force:
        """The force with these values."""
        return self._with(scene, self.numbers(unknowns))

    def numbers(self, unknowns: Floats) -> Floats:
        """All numbers (m, c) of the column with these values of its unknowns."""
        return self.entries.with_values(self.factor * unknowns)

    def _with(self, scene: Scene, values: Floats) -> Force:
        force: Force = changed_forces(scene, {str(self.number): {self.variable.field: self._field(values)}})[
            self.number
        ]
        return force

    def differences(self, system: System, give: Give, *, linear: bool = False) -> Iterator[tuple[Ints, Floats]]:
        """Derivatives (m, ...) of what `give` says of each element, with the unknown (m,) by which, -1 for none: a pair
        for each number that an element has in the column. `linear`: what `give` says is in proportion to forces."""
        values, tie = self.entries.values, self.entries.tie
        exact = self._units(system) if linear else []
        for column, block in exact:
            yield (
                np.broadcast_to(tie[:, column], self.elements)[self.part.inputs],
                self.factor * give(self.force, block),
            )
        for column in range(values.shape[1]) if self.by_element and not exact else ():
            if (tie[:, column] >= 0).any():
                steps = self._steps(column)
                change = np.zeros(values.shape)
                change[:, column] = np.where(tie[:, column] >= 0, steps, 0.0)
                slope, unknown = self.slope(system, change, give), np.broadcast_to(tie[:, column], self.elements)
                by = np.broadcast_to(steps, self.elements)[self.part.inputs]
                yield unknown[self.part.inputs], self.factor * slope / by.reshape(-1, *[1] * (slope.ndim - 1))
        if not self.by_element and self.entries.count > MANY:
            found = self._by_readers(system, give)
            if found is not None:
                yield from found
                return
        for number in range(self.entries.count) if not self.by_element else ():
            step = self.step(number)
            slope = self.slope(system, np.where(tie == number, step, 0.0), give)
            yield np.full(len(slope), number), self.factor * slope / step

    def _by_readers(self, system: System, give: Give) -> list[tuple[Ints, Floats]] | None:
        """The same of a column that the force takes as a whole, where each element reads one number of each of its
        columns at most: all numbers of a column change at once. None where elements read several."""
        if not self._readers:
            wide = self.entries.values.shape[1]
            alike = self._read(system, list(range(wide)))  # one row of all columns, such as the face of an element
            self._readers = [self._read(system, [i]) if alike is None else alike for i in range(wide)]
        found = []
        for column, own in enumerate(self._readers):
            tie = self.entries.tie[:, column]
            if not (tie >= 0).any():
                continue
            if own is None:
                return None
            steps, change = self._steps(column), np.zeros(self.entries.values.shape)
            change[:, column] = np.where(tie >= 0, steps, 0.0)
            slope, reads = self.slope(system, change, give), own >= 0
            if slope[~reads].any():  # what other variables multiply by 0 at the first shape
                self._readers = []
                return self._by_readers(system, give)
            by = np.where(reads, steps[own], 1.0).reshape(-1, *[1] * (slope.ndim - 1))
            found.append((np.where(reads, tie[own], -1), self.factor * slope / by))
        return found

    def _read(self, system: System, columns: list[int]) -> Ints | None:
        """The row of the entries from which each element has its numbers of some columns."""
        values, steps = self.entries.values, np.zeros(self.entries.values.shape)
        for column in columns:
            steps[:, column] = self._steps(column)

        def parameters(some: NDArray[np.bool_]) -> Floats:
            moved = values + np.where(some[:, None], steps, 0.0)
            return compiled(system, self.group, self.number, self._with(system.scene, moved)).parameters

        whole = parameters(np.zeros(len(values), dtype=bool))
        return readers(len(values), lambda some: (parameters(some) != whole).any(axis=1))

    def _steps(self, column: int) -> Floats:
        """Changes of the numbers (m,) of the column, small for derivatives."""
        size = np.abs(self.entries.values[:, column])
        return np.asarray(STEP * np.maximum(size, self._typical(size)))

    def _units(self, system: System) -> list[tuple[int, Block]]:
        """Where forces are linear in the column: each number of it that varies, with a block in which that is 1 and the
        others are 0, so that forces are derivatives by it. None where other parameters change with the column, such as
        the rest length of springs of a given prestress with their stiffness."""
        whole, entries = self.group.block.some(self.part.rows), self.entries
        own = [i for i, name in enumerate(whole.names) if name == self.variable.field]
        if not self.by_element or self.group.cls.linear != self.variable.field or len(own) != entries.values.shape[1]:
            return []
        given = np.broadcast_to(entries.values, (self.elements, len(own)))[self.part.inputs]
        if not np.array_equal(whole.parameters[:, own], given):  # worked out from another column
            return []
        moved = entries.values + np.column_stack([self._steps(column) for column in range(len(own))])
        other = self.force.replaced(**{self.variable.field: self._field(moved)})  # nobody sees it: no check
        fresh = compiled(system, self.group, self.number, other).parameters
        others = [i for i in range(len(whole.names)) if i not in own]
        if not all(np.array_equal(fresh[:, i], whole.parameters[:, i]) for i in others):
            return []
        found = []
        for column in np.flatnonzero((entries.tie >= 0).any(axis=0)):
            parameters = whole.parameters.copy()
            parameters[:, own] = 0.0
            parameters[:, own[column]] = 1.0
            found.append((int(column), replace(whole, parameters=parameters)))
        return found

    def step(self, unknown: int) -> float:
        """A change of one unknown, small for derivatives."""
        start = np.abs(self.entries.start)
        return STEP * max(float(start[unknown]), self._typical(start))

    def _typical(self, sizes: Floats) -> float:
        """The mean of sizes; that of the first values where it is 0 but for rounding."""
        mean = float(sizes.mean())
        return mean if mean > NOTHING * self.size else self.size

    def slope(self, system: System, change: Floats, give: Give) -> Floats:
        """By how much what `give` says changes with a change (m, c) of the values: differences of second order, on one
        side where the other is not allowed. InputError where it jumps at a value."""
        values = self.entries.values
        both = (values - change >= self.lower).all()
        ways = ((0.5, 1.0), (-0.5, -1.0)) if both else ((-1.5, 0.0), (2.0, 1.0), (-0.5, 2.0))
        if both and (values + change > self.upper).any():
            ways = ((1.5, 0.0), (-2.0, -1.0), (0.5, -2.0))
        given = []
        for _, way in ways:
            if way == 0.0:
                given.append(give(self.force, self.group.block.some(self.part.rows)))
                continue
            force = self._with(system.scene, values + way * change)
            given.append(give(force, compiled(system, self.group, self.number, force)))
        if len(ways) == 3:
            self._check_smooth(given, self.upper if both else self.lower)
        return np.asarray(sum(weight * each for (weight, _), each in zip(ways, given, strict=True)))

    def _check_smooth(self, given: list[Floats], end: float) -> None:
        """InputError where values at 0, 1 and 2 steps from the end of the range do not follow a smooth curve."""
        near, far = np.abs(given[1] - given[0]), np.abs(given[2] - given[1])
        size = max(float(np.abs(each).max(initial=0.0)) for each in given)
        if ((np.abs(near - far) > 0.5 * np.maximum(near, far)) & (np.maximum(near, far) > JUMP * size)).any():
            name = self.variable.field
            said = f"{name} is {end:g}, where {self.force.kind_name} changes by a jump; give it a value beyond,"
            raise InputError(f"{self.pointer}/field", f"{said} or leave such elements out by tie")


def shape_of(columns: int, count: int, wide: Any) -> tuple[int, ...]:
    """The shape of a variable's values in an answer."""
    return (count // columns, columns) if wide and columns > 1 else (count,)


def compiled(system: System, group: Group, number: int, force: Force) -> Block:
    """The block of a changed force in a group, rows that met particles alone, in its own room, with its slots."""
    fresh = system.places.recompile(number, force)
    if fresh.indices.min(initial=0) < 0:
        fresh = fresh.some(np.flatnonzero((fresh.indices >= 0).all(axis=1)))
    made = number, force, fresh, np.arange(len(fresh.indices))
    if issubclass(group.cls, Rider):
        return ride(system.slots, group.cls, made)[2]
    return fitted(system.slots, group.cls, made)[2]


def placed(system: System, number: int, pointer: str) -> tuple[Group, Part]:
    """The elements of a force."""
    for group in system.groups:
        for part in group.parts:
            if part.number == number:
                return group, part
    force = system.scene.forces[number]
    title = force.name or force.kind_name
    if number in case_loads(system.scene):
        said = f"{title} is of load cases, which do not act in the shape that is designed; take it out of them"
        raise InputError(pointer, said)
    raise InputError(pointer, f"{title} is a contact or an impulse; it has no columns that can vary or be measured")


def numbered(scene: Scene, wanted: Any, pointer: str) -> int:
    """The number of the force of a name or number; InputError if no force has it."""
    names = [i for i, force in enumerate(scene.forces) if force.name == wanted and wanted != ""]
    if len(names) == 1:
        return names[0]
    kinds = [i for i, force in enumerate(scene.forces) if force.kind_name == wanted]
    if not names and len(kinds) == 1:
        return kinds[0]
    if not names and isinstance(wanted, int) and 0 <= wanted < len(scene.forces):
        return wanted
    if len(names) > 1 or len(kinds) > 1:
        raise InputError(pointer, f"{len(names) or len(kinds)} forces are called {wanted!r}; give the number of one")
    known = ", ".join(repr(force.name or force.kind_name) for force in scene.forces) or "none"
    raise InputError(pointer, f"no force is called {wanted!r}; there are {known}")
