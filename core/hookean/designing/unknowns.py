"""The unknowns of a design problem: the values of its variables as one vector, put into a system and differentiated.

Derivatives by a column come from differences of the compiled kernel with all elements changed at once, so that every
force has them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.designing.equilibrium import Equilibrium
from hookean.designing.problem import Problem, Variable
from hookean.errors import InputError
from hookean.forces.base import PLACES, Block, Force
from hookean.running.patch import changed_forces, lead_forces, named
from hookean.scene.scene import Scene
from hookean.system.state import State
from hookean.system.system import Group, Held, Part, System, hold
from hookean.system.weld import element_columns

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

STEP = 1e-5  # of a value, and of the mean of its column: the error is its square, and rounding 1e-11
AXES = {"x": 0, "y": 1, "z": 2}
NOTHING = np.zeros(0, np.int64)


@dataclass
class Entries:
    """Numbers (m, c) of which some vary: `tie` (m, c) has the unknown of each, -1 where it keeps its value."""

    values: Floats
    tie: Ints

    @property
    def count(self) -> int:
        """How many unknowns there are."""
        return int(self.tie.max(initial=-1)) + 1

    @property
    def start(self) -> Floats:
        """The mean value (count,) of the entries of each unknown."""
        kept = self.tie >= 0
        sums = np.bincount(self.tie[kept], self.values[kept], self.count)
        return np.asarray(sums / np.bincount(self.tie[kept], minlength=self.count))

    def with_values(self, unknowns: Floats) -> Floats:
        """All numbers (m, c), those that vary with these values (count,)."""
        return np.where(self.tie >= 0, unknowns[np.maximum(self.tie, 0)], self.values)


def tied(variable: Variable, rows: int, columns: Ints, width: int, pointer: str) -> Ints:
    """The unknown of each of (rows, width) numbers, those of `columns` varying."""
    groups: list[Ints]
    if variable.tie == "each":
        groups = [np.array([row]) for row in range(rows)]
    elif variable.tie == "all":
        groups = [np.arange(rows)]
    else:
        groups = [np.asarray(group) for group in variable.tie]
    found = np.full((rows, width), -1)
    for i, group in enumerate(groups):
        if not len(group) or group.max() >= rows:
            given = "no elements" if not len(group) else f"element {int(group.max())}"
            raise InputError(f"{pointer}/tie/{i}", f"{given} given; there are {rows}, counted from 0")
        found[np.ix_(group, columns)] = i * len(columns) + np.arange(len(columns))
    return found


class Column:
    """A variable that is a column of a force: `entries` with a row for each element, or with all numbers of a column
    that the force has as a whole in one row."""

    def __init__(self, variable: Variable, system: System, pointer: str) -> None:
        self.variable, self.pointer = variable, pointer
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
        wide = self.by_element and (vector or given.ndim == 2)
        columns = np.array([AXES[a] for a in variable.axes]) if wide else np.array([0])
        if self.by_element:
            rows = 1 if variable.tie == "all" and given.ndim == int(bool(vector)) else self.elements
            values = np.array(np.broadcast_to(given if given.ndim == 2 else given.reshape(-1, 3 if wide else 1), (rows, 3 if wide else 1)))
            tie = tied(variable, rows, columns, values.shape[1], pointer)
        else:
            values = given.reshape(1, -1).copy()
            tie = np.zeros(values.shape, np.int64) if variable.tie == "all" else np.arange(values.size).reshape(1, -1)
        self.entries = Entries(values, tie)
        self.shape = _shape(len(columns), self.entries.count, wide)
        self.lower = self._least(system)

    @property
    def force(self) -> Force:
        """The force as it is now."""
        return self.part.force

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
        if isinstance(value, bool | str) or not isinstance(value, int | float | np.ndarray):
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

    def _least(self, system: System) -> float:
        """0 where the column takes no negative numbers, else -inf."""
        negative = self._field(-1.0 - np.abs(self.entries.values))
        return -np.inf if self._accepts(system, negative) else 0.0

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
        return self._with(scene, self.entries.with_values(unknowns))

    def _with(self, scene: Scene, values: Floats) -> Force:
        force: Force = changed_forces(scene, {str(self.number): {self.variable.field: self._field(values)}})[self.number]
        return force

    def differences(self, system: System, give: Callable[[Force, Block], Floats]) -> Iterator[tuple[Ints, Floats]]:
        """Derivatives (m, ...) of what `give` says of each element, with the unknown (m,) by which, -1 for none: a pair
        for each number that an element has in the column."""
        values, tie = self.entries.values, self.entries.tie
        for column in range(values.shape[1]) if self.by_element else ():
            if (tie[:, column] >= 0).any():
                steps = STEP * np.maximum(np.abs(values[:, column]), np.abs(values[:, column]).mean() or 1.0)
                change = np.zeros(values.shape)
                change[:, column] = steps
                slope, unknown = self.slope(system, change, give), np.broadcast_to(tie[:, column], self.elements)
                by = np.broadcast_to(steps, self.elements)[self.part.inputs]
                yield unknown[self.part.inputs], slope / by.reshape(-1, *[1] * (slope.ndim - 1))
        for unknown in range(self.entries.count) if not self.by_element else ():
            step = self.step(unknown)
            slope = self.slope(system, np.where(tie == unknown, step, 0.0), give)
            yield np.full(len(slope), unknown), slope / step

    def step(self, unknown: int) -> float:
        """A change of one unknown, small for derivatives."""
        mean = float(np.abs(self.entries.start).mean()) or 1.0
        return STEP * max(abs(float(self.entries.start[unknown])), mean)

    def slope(self, system: System, change: Floats, give: Callable[[Force, Block], Floats]) -> Floats:
        """By how much what `give` says changes with a change (m, c) of the values: differences of second order, on one
        side where the other is not allowed."""
        values = self.entries.values
        both = (values - change >= self.lower).all()
        ways = ((0.5, 1.0), (-0.5, -1.0)) if both else ((-1.5, 0.0), (2.0, 1.0), (-0.5, 2.0))
        total: Any = 0.0
        for weight, way in ways:
            force = self._with(system.scene, values + way * change)
            total = total + weight * give(force, compiled(system, self.number, force))
        return np.asarray(total)


class Moved:
    """A variable that is where an anchor holds its particles."""

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
        self.shape = _shape(len(columns), self.entries.count, variable.axes)
        self.lower = -np.inf

    def targets(self, unknowns: Floats) -> Floats:
        """Where the particles (k, 3) are held [length]."""
        values = self.entries.with_values(unknowns)
        return self.home + values if self.shifts else values


def _shape(columns: int, count: int, wide: Any) -> tuple[int, ...]:
    """The shape of a variable's values in an answer."""
    return (count // columns, columns) if wide and columns > 1 else (count,)


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
        self.count = int(ends[-1])
        if not self.count:
            raise InputError("/variables", "nothing varies: the forces have no elements")
        self.start = np.concatenate([v.entries.start for v in self.variables])
        self.lower, self.upper = self._bounds()
        outside = (self.start < self.lower) | (self.start > self.upper)
        self.start = np.clip(self.start, self.lower, self.upper)
        self.clipped = int(outside.sum())

    def _bounds(self) -> tuple[Floats, Floats]:
        lower, upper = np.full(self.count, -np.inf), np.full(self.count, np.inf)
        for variable, part in zip(self.variables, self.slices, strict=True):
            given = variable.variable
            lower[part] = variable.lower if given.lower is None else max(variable.lower, given.lower)
            upper[part] = np.inf if given.upper is None else given.upper
        return lower, upper

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
        for variable, part in zip(self.variables, self.slices, strict=True):
            own = values[part]
            if isinstance(variable, Moved):
                variable.anchor.targets = np.ascontiguousarray(variable.targets(own))
                continue
            forces[variable.number] = variable.changed(
                scene.replaced(forces=tuple(forces.get(i, f) for i, f in enumerate(scene.forces))), own
            )
        if forces:
            lead_forces(system, forces)
        for variable, part in zip(self.variables, self.slices, strict=True):
            if isinstance(variable, Column):
                variable.entries = replace(variable.entries, values=variable.entries.with_values(values[part]))
        for anchor in system.held:
            hold(state, anchor)

    def scene(self, scene: Scene) -> Scene:
        """The scene with the anchors where they are held now; forces have their values already."""
        anchors = list(scene.anchors)
        for variable in self.variables:
            if isinstance(variable, Moved) and variable.anchor.number >= 0:
                number = variable.anchor.number
                if len(variable.anchor.targets) == len(anchors[number].particles if anchors[number].particles is not None else anchors[number].points):  # type: ignore[arg-type]
                    anchors[number] = anchors[number].replaced(targets=variable.anchor.targets)
        return scene.replaced(anchors=tuple(anchors))

    def slopes(self, found: Equilibrium) -> tuple[Any, Any]:
        """df/du (3n, u) [force by unit] at fixed positions, and how held particles move, dx_h/du (3n, u)."""
        from scipy.sparse import coo_matrix

        pushes, moves = [], []
        for variable, part in zip(self.variables, self.slices, strict=True):
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
    if group.cls.gathered(group.block, memory, state.x, None) is not None:
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
        slope = variable.slope(system, np.where(variable.entries.tie == unknown, step, 0.0), forces).ravel() / step
        place = np.flatnonzero(slope)
        rows.append(place)
        columns.append(np.full(len(place), unknown))
        values.append(slope[place])
    lead_forces(system, {variable.number: first})
    return np.concatenate(rows), np.concatenate(columns), np.concatenate(values)


def compiled(system: System, number: int, force: Force) -> Block:
    """The block of a changed force, rows that met particles alone, in its own room."""
    fresh = system.places.recompile(number, force)
    return fresh.some((fresh.indices >= 0).all(axis=1).nonzero()[0])


def placed(system: System, number: int, pointer: str) -> tuple[Group, Part]:
    """The elements of a force."""
    for group in system.groups:
        for part in group.parts:
            if part.number == number:
                return group, part
    raise InputError(pointer, f"force {number} is a contact; it has no columns that can vary")


def numbered(scene: Scene, wanted: Any, pointer: str) -> int:
    """The number of the force of a name or number; InputError where there is none."""
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
