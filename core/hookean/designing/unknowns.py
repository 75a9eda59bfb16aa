"""The unknowns of a design problem: the values of its variables as one vector, put into a system and differentiated."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.designing.answer import once
from hookean.designing.columns import AXES, Column, Entries, shape_of, tied
from hookean.designing.drawn import Drawn, DrawnAnchor, DrawnColumn, Mass
from hookean.designing.equilibrium import Equilibrium, as_held
from hookean.designing.problem import Problem, Variable
from hookean.designing.pushes import NOTHING, pushes, work
from hookean.errors import InputError
from hookean.forces.base import Force
from hookean.running.patch import lead_forces, named
from hookean.scene.scene import Scene
from hookean.system.addressed import numbered
from hookean.system.state import State
from hookean.system.system import Held, System, hold

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

ALIKE = 1e-12  # part of the largest value by which equal ones differ


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


def _once(varied: list[Any]) -> None:
    """InputError where a number has two variables, or a variable and what another one drives."""
    taken: dict[tuple[Any, ...], list[tuple[str, NDArray[np.bool_]]]] = {}
    for one in varied:
        if isinstance(one, Moved):
            key: tuple[Any, ...] = (one.anchor.number,)
        elif isinstance(one, Column) and not isinstance(one, DrawnColumn):
            key = (one.number, one.variable.field)
        else:
            continue
        mine = one.entries.tie >= 0
        for pointer, others in taken.setdefault(key, []):
            if (mine & others).any():  # a row for all stands for each
                raise InputError(one.pointer, f"{pointer} gives these values already; leave one of them out")
        taken[key].append((one.pointer, mine))


class Unknowns:
    """All variables of a problem as one vector."""

    def __init__(self, problem: Problem, system: System) -> None:
        self.problem = problem
        weighed = [int(v.particles.max()) for v in problem.variables if v.field == "mass" and len(v.particles)]
        if max(weighed, default=-1) >= len(system.scene.particles):  # of points of forces no scene has masses
            system.scene = numbered(system, system.scene)
        self.variables: list[Column | Moved | Drawn | Mass] = []
        for i, variable in enumerate(problem.variables):
            self.variables.append(_kind(variable)(variable, system, f"/variables/{i}"))
        ends = np.cumsum([v.entries.count for v in self.variables])
        self.slices = [slice(int(e) - v.entries.count, int(e)) for v, e in zip(self.variables, ends, strict=True)]
        self.parts = [*zip(self.variables, self.slices, strict=True), *self._driven(system)]
        """All columns and anchors that vary, each with its part of the unknowns: variables, and what they drive."""
        _once([part for part, _ in self.parts])
        self.names = once(v.variable.title for v in self.variables)
        self.count = int(ends[-1])
        if not self.count:
            raise InputError("/variables", "nothing varies: the forces have no elements")
        self.start = np.concatenate([v.entries.start for v in self.variables])
        self.differing = self._differing()
        """Sentences on values of the scene that are no longer the same where variables tie or drive them."""
        self.lower, self.upper = self._bounds()
        outside = (self.start < self.lower) | (self.start > self.upper)
        self.start = np.clip(self.start, self.lower, self.upper)
        self.clipped = int(outside.sum())

    def _driven(self, system: System) -> list[tuple[Any, slice]]:
        """The columns that follow variables."""
        found: list[tuple[Any, slice]] = []
        moved = {id(v.anchor) for v in self.variables if isinstance(v, Moved)}
        for i, (variable, part) in enumerate(zip(self.variables, self.slices, strict=True)):
            if isinstance(variable, Drawn):
                found += [(column, part) for column in variable.columns(system, moved)]
            for j, drive in enumerate(variable.variable.drives):
                pointer = f"/variables/{i}/drives/{j}"
                own = variable.variable.replaced(force=drive.force, field=drive.field, drives=())
                column = Column(own, system, pointer, drive.factor)
                if column.entries.count != variable.entries.count:
                    said = f"it has {column.entries.count} values, the variable {variable.entries.count}; use tie"
                    raise InputError(pointer, said)
                found.append((column, part))
        return found

    def _differing(self) -> list[str]:
        said = []
        for i, (variable, part) in enumerate(self.parts):
            if isinstance(variable, DrawnColumn | DrawnAnchor):
                continue
            entries, start = variable.entries, getattr(variable, "factor", 1.0) * self.start[part]
            off = np.abs(entries.with_values(start) - entries.values)
            if not off.max(initial=0.0) > ALIKE * np.abs(entries.values).max(initial=0.0):
                continue
            own = entries.values[off > 0.0]
            if i < len(self.variables):
                title, put = self.names[i], "each tie gets the mean of its values"
            else:
                driven = variable.variable
                title, put = f"{driven.force}.{driven.field}", "it follows its variable"
            span = f"values from {own.min():g} to {own.max():g}" if np.ptp(own) > 0.0 else f"the value {own[0]:g}"
            verb = "are" if np.ptp(own) > 0.0 else "is"
            said.append(f"{title}: {span} in the scene {verb} not kept; {put}")
        return said

    def _bounds(self) -> tuple[Floats, Floats]:
        lower, upper = np.full(self.count, -np.inf), np.full(self.count, np.inf)
        for variable, part in zip(self.variables, self.slices, strict=True):
            given = variable.variable
            lower[part] = variable.lower if given.lower is None else max(variable.lower, given.lower)
            most = variable.upper if isinstance(variable, Column) else np.inf
            upper[part] = most if given.upper is None else min(most, given.upper)
            if given.upper is not None and given.upper < variable.lower:
                said = f"{given.upper:g} given; {given.field} is at least {variable.lower:g}"
                raise InputError(f"{variable.pointer}/upper", said)
            if given.lower is not None and given.lower > most:
                said = f"{given.lower:g} given; {given.field} is at most {most:g}"
                raise InputError(f"{variable.pointer}/lower", said)
        for column, part in self.parts[len(self.variables) :]:
            if column.lower == 0.0 and isinstance(column, Column):
                end, to = (lower, np.maximum) if column.factor > 0.0 else (upper, np.minimum)
                end[part] = to(end[part], 0.0)
                if (lower[part] > upper[part]).any():
                    field, allowed = column.variable.field, "at least" if column.factor > 0.0 else "at most"
                    said = f"{field} is at least 0, so its variable must be able to be {allowed} 0; change its bounds"
                    raise InputError(column.pointer, said)
        return lower, upper

    def begin(self, values: Any) -> None:
        """Start from these values (u,), within the bounds; InputError unless they are one finite number for each."""
        try:
            given = np.asarray(values, dtype=np.float64)
        except (TypeError, ValueError, OverflowError):
            given = np.zeros(0)
        if given.shape != (self.count,) or not np.isfinite(given).all():
            many = f"{self.count} finite number{'s' * (self.count != 1)}"
            raise InputError("/start", f"{many} expected, one for each unknown")
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
            if isinstance(variable, Moved | Drawn):
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
            if not isinstance(variable, Column) or isinstance(variable, DrawnColumn):
                continue
            forces[variable.number] = variable.changed(
                scene.replaced(forces=tuple(forces.get(i, f) for i, f in enumerate(scene.forces))), own
            )
        if forces:
            lead_forces(system, forces)
        self._put_particles(system, values)
        for variable, part in self.parts:
            if isinstance(variable, Column) and not isinstance(variable, DrawnColumn):
                variable.entries = replace(variable.entries, values=variable.numbers(values[part]))
        for anchor in system.held:
            hold(state, anchor, system.slots)

    def _put_particles(self, system: System, values: Floats) -> None:
        """Give particles their masses and drawn positions; then anchors follow these."""
        for variable, part in self.parts:
            if isinstance(variable, Mass | Drawn):
                variable.put(system, values[part])
        for variable, _ in self.parts:
            if isinstance(variable, DrawnAnchor):
                variable.put(system)
        if any(isinstance(variable, Mass) for variable in self.variables):
            system.brace()

    def scene(self, scene: Scene) -> Scene:
        """The scene with the anchors where they are held now; forces have their values already."""
        return as_held(scene, [v.anchor for v in self.variables if isinstance(v, Moved)])

    def slopes(self, found: Equilibrium) -> tuple[Any, Any]:
        """df/du (3n, u) [force by unit] at fixed positions, and how held particles move, dx_h/du (3n, u)."""
        kept = [(v, part) for v, part in self.parts if isinstance(v, Column | Moved | DrawnAnchor)]
        entries = [(pushes(found, v) if isinstance(v, Column) else _led(v), part.start) for v, part in kept]
        columns = [isinstance(variable, Column) for variable, _ in kept]
        shape = found.x.size, self.count
        given, moved = ([e for e, own in zip(entries, columns, strict=True) if own == which] for which in (True, False))
        return _matrix(given, shape), _matrix(moved, shape)

    def work(self, found: Equilibrium, moved: Floats) -> Floats:
        """y . df/du (u,) at fixed positions, for a motion y (n, 3)."""
        total = np.zeros(self.count)
        for variable, part in self.parts:
            if isinstance(variable, Column):
                total[part] += work(found, variable, moved)
        return total

    def lead(self, pulls: Floats) -> Floats:
        """r . dx_h/du (u,), for what r (3n,) [goal by length] it is worth to move held particles."""
        total = np.zeros(self.count)
        for variable, part in self.parts:
            if isinstance(variable, Moved | DrawnAnchor):
                places, unknown, _ = _led(variable)
                total[part] += np.bincount(unknown, pulls[places], variable.entries.count)
        return total

    @property
    def led(self) -> Ints:
        """The coordinates, of (3n,), that anchors among the variables move."""
        rows = [_led(variable)[0] for variable, _ in self.parts if isinstance(variable, Moved | DrawnAnchor)]
        return np.flatnonzero(np.bincount(np.concatenate([NOTHING, *rows])))


def _kind(variable: Variable) -> type[Column | Moved | Drawn | Mass]:
    """What a variable is."""
    if variable.force is not None:
        return Column
    return Moved if variable.anchor is not None else Drawn if variable.field == "drawn" else Mass


def _matrix(entries: list[tuple[tuple[Ints, Ints, Floats], int]], shape: tuple[int, int]) -> Any:
    """Entries, each with its first column, as a sparse matrix."""
    from scipy.sparse import coo_matrix

    if not entries:
        return coo_matrix(shape).tocsc()
    rows, columns, values = zip(*((row, column + first, value) for (row, column, value), first in entries), strict=True)
    places = np.concatenate(rows), np.concatenate(columns)
    return coo_matrix((np.concatenate(values), places), shape=shape).tocsc()


def _led(variable: Moved | DrawnAnchor) -> tuple[Ints, Ints, Floats]:
    """How an anchor's particles move: places in (3n, unknowns), and ones."""
    row, axis = np.nonzero(variable.entries.tie >= 0)
    return (3 * variable.anchor.particles[row] + axis, variable.entries.tie[row, axis], np.ones(len(row)))
