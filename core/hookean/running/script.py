"""Scripts: anchors led along paths and columns of forces led through values while a simulation runs.

    [[anchors]]                          # a path: linear between its times, held before and after
    anchor = "right"
    times = [0, 2, 4]                    # [time]
    shifts = [[0, 0, 0], [-2, 0, 1], [0, 0, 0]]

    [[forces]]                           # a column of a force, likewise
    force = "load"
    column = "vector"
    times = [1, 3]
    values = [[0, 0, -20], [0, 0, -40]]

    [[drives]]                           # a column that a stream drives: scale * speed^power
    force = "wind"
    column = "vector"
    source = "speed [m/s]"
    scale = [0, 0.613, 0]
    power = 2

The same as TOML, JSON and Python dicts. Numbers are in the scene's units. An anchor that is led has the velocity of its
path: springs are damped by how fast they stretch, not by how fast their support travels.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import PlainSerializer, PlainValidator, StrictInt, StrictStr, ValidationError, model_validator
from pydantic import WithJsonSchema as Schema

from hookean.errors import InputError
from hookean.running.patch import Move, Patch, changed_forces, home, lead_forces, named
from hookean.running.stream import Row, Stream
from hookean.system.state import State
from hookean.system.system import Held, System
from hookean.values.columns import Model, Points, _real, fault
from hookean.values.faults import first_fault
from hookean.values.fields import Field, Maybe, Parts

Floats = NDArray[np.float64]
ON_TIME = 1e-6  # of a step: what is due within it is due now, for times are sums of steps


def _times(value: Any) -> Floats:
    array = _real(value)
    if array.ndim != 1 or not len(array):
        raise fault("a list of one or more times expected")
    late = np.flatnonzero(np.diff(array) <= 0)
    if len(late):
        raise fault("times must increase from one to the next", f"/{late[0] + 1}")
    return array


_PLAIN = PlainSerializer(lambda a: a.tolist())
if TYPE_CHECKING:
    from hookean.values.fields import Column

    Times = Column[Floats]
    Rows = Column[Floats]
    Values = Column[Floats]
else:
    Times = Annotated[Floats, PlainValidator(_times), _PLAIN, Schema({"type": "array", "items": {"type": "number"}})]
    Rows = Annotated[Floats, PlainValidator(_real), _PLAIN, Schema({"type": "array", "items": {}})]
    Values = Annotated[Floats, PlainValidator(_real), _PLAIN, Schema({"type": ["number", "array"]})]


class AnchorPath(Model):
    """Where an anchor goes: shifted as a whole, or each of its particles to targets of its own."""

    anchor: StrictStr | StrictInt = Field(description="Name or number of an anchor")
    times: Times = Field(description="Increasing times (k,) [time]")
    shifts: Maybe[Points] = Field(default=None, description="(k, 3) shifts from where the scene holds it [length]")
    targets: Maybe[Rows] = Field(default=None, description="(k, particles, 3) [length]")

    @model_validator(mode="after")
    def _one_way(self) -> Self:
        if (self.shifts is None) == (self.targets is None):
            raise fault("give exactly one of shifts, targets")
        name, rows = "shifts" if self.targets is None else "targets", self.rows
        if rows.shape[:1] != self.times.shape:
            raise fault(f"{len(np.atleast_1d(rows))} {name} for {len(self.times)} times; give one for each", f"/{name}")
        if self.targets is not None and (rows.ndim != 3 or rows.shape[2] != 3):
            raise fault("for each time a list of x, y, z expected, one for each particle of the anchor", "/targets")
        return self

    @property
    def rows(self) -> Floats:
        """Shifts or targets, whichever are given."""
        rows = self.shifts if self.targets is None else self.targets
        assert rows is not None
        return rows

    def move(self, time: float) -> Move:
        """The anchor's place at a time."""
        place = between(self.times, self.rows, time)
        return Move(anchor=self.anchor, **{"shift" if self.targets is None else "targets": place})


class ForcePath(Model):
    """A column of a force over time."""

    force: StrictStr | StrictInt = Field(description="Name or number of a force")
    column: StrictStr = Field(description="Column of the force")
    times: Times = Field(description="Increasing times (k,) [time]")
    values: Rows = Field(description="(k,) or (k, ...) values, each as the column accepts it [its unit]")

    @property
    def rows(self) -> Floats:
        """The values."""
        return self.values

    @model_validator(mode="after")
    def _one_each(self) -> Self:
        if self.values.shape[:1] != self.times.shape:
            count = len(np.atleast_1d(self.values))
            raise fault(f"{count} values for {len(self.times)} times; give one for each", "/values")
        return self


class Drive(Model):
    """A column of a force led by a stream: scale * value^power."""

    force: StrictStr | StrictInt = Field(description="Name or number of a force")
    column: StrictStr = Field(description="Column of the force")
    source: StrictStr = Field(description="Column of the stream; with [unit] the unit is checked too")
    scale: Values = Field(description="Number or array, as the column accepts it [its unit / source^power]")
    power: float = Field(default=1.0, ge=0, description="Power of the value [-]; 2 for wind pressure")

    def value(self, row: Row) -> Any:
        """What the column becomes by a row; InputError where that is no number."""
        given = row.values[self.source]
        try:
            with np.errstate(all="ignore"):
                led = self.scale * np.float64(given) ** self.power
        except OverflowError:
            led = np.full_like(self.scale, np.nan)
        if not np.isfinite(led).all():
            raise InputError(
                row.place, f"{given:g} to the power {self.power:g} is not a finite number; check {self.source}"
            )
        return plain(led)


class Script(Model):
    """What moves by itself while a simulation runs; see the head of `hookean.running.script`."""

    anchors: Parts[AnchorPath] = Field(default=(), description="Anchors moved along paths")
    forces: Parts[ForcePath] = Field(default=(), description="Columns of forces that change over time")
    drives: Parts[Drive] = Field(default=(), description="Columns of forces driven by a stream")

    @classmethod
    def read(cls, value: Any, name: str = "") -> Self:
        """A script from a dict, JSON or TOML text; InputError with a pointer (behind `name`) and one sentence."""
        if isinstance(value, cls):
            return value
        if isinstance(value, str):
            from hookean.scene.text import parse_tables

            value = parse_tables(value, name or "script")
        try:
            return cls.model_validate(value)
        except ValidationError as error:
            found = first_fault(error)
            raise InputError(f"{name} {found.pointer}".lstrip(), found.sentence) from None

    @property
    def end(self) -> float:
        """When the last path ends [time]; drives have no end of their own."""
        return max((float(path.times[-1]) for path in self._paths), default=0.0)

    @property
    def _paths(self) -> tuple[AnchorPath | ForcePath, ...]:
        return (*self.anchors, *self.forces)

    def at(self, time: float, since: float | None = None) -> Patch | None:
        """The patch that puts everything where it is at `time`; None if there is nothing, or no change `since` then."""
        columns = {f: {c: np.asarray(v).tolist() for c, v in of.items()} for f, of in self.columns(time).items()}
        patch = Patch(move=tuple(path.move(time) for path in self.anchors), forces=columns)
        before = None if since is None else self.at(since)
        return None if patch == before or not (patch.move or patch.forces) else patch

    def quiet_until(self, time: float) -> float:
        """Until when nothing moves from `time` on; `time` itself where something does now."""
        due = np.inf
        for path in self._paths:
            i = int(np.searchsorted(path.times, time, side="right"))
            if 0 < i < len(path.times) and not np.array_equal(path.rows[i - 1], path.rows[i]):
                return time
            due = min(due, float(path.times[i]) if i < len(path.times) else np.inf)
        return due

    def columns(self, time: float) -> dict[str, dict[str, Any]]:
        """Values by force and column at a time."""
        found: dict[str, dict[str, Any]] = {}
        for path in self.forces:
            found.setdefault(str(path.force), {})[path.column] = plain(between(path.times, path.values, time))
        return found


def between(times: Floats, values: Floats, time: float) -> Floats:
    """Linear between times, held before the first and after the last; exact at each."""
    i = int(np.clip(np.searchsorted(times, time, side="right") - 1, 0, len(times) - 1))
    j = min(i + 1, len(times) - 1)
    part = float(np.clip((time - times[i]) / (times[j] - times[i]), 0.0, 1.0)) if j > i else 0.0
    met: Floats = np.asarray((1.0 - part) * values[i] + part * values[j])
    return met


def plain(value: Floats) -> Any:
    """An array, or the number that an array without axes is."""
    return float(value) if np.ndim(value) == 0 else value


@dataclass(frozen=True)
class _Led:
    """A path and the anchor it leads: its number, its particles and where the scene holds them."""

    path: AnchorPath
    number: int
    particles: NDArray[np.int64]
    home: Floats

    def targets(self, time: float, held: Held) -> Floats:
        """Where those particles that are still held are at a time."""
        move = self.path.move(time)
        targets = move.targets if move.shift is None else self.home + move.shift
        assert targets is not None
        return np.ascontiguousarray(targets[np.isin(self.particles, held.particles)])


class Playing:
    """A script at work in a system, with the stream that drives it if there is one.

    Raises InputError where script, stream and system do not fit together; nothing has moved then.
    """

    def __init__(self, script: Script, stream: Stream | str | Path | Iterable[str] | None, system: System) -> None:
        self.script = script
        self._led = [self._bound(path, f"/anchors/{i}", system) for i, path in enumerate(script.anchors)]
        self._fits(system)
        if script.drives and stream is None:
            raise InputError("/drives", f"{script.drives[0].source} needs a stream; give one")
        if stream is not None and not script.drives:
            raise InputError("/drives", "a stream is given, but no drive uses it; add a drive")
        self._stream = None if stream is None else stream if isinstance(stream, Stream) else Stream(stream)
        self._started = False
        self.finished = False
        self.rewind(system)

    @property
    def over(self) -> bool:
        """Whether there is a stream and its last row was read."""
        return self._stream is not None and self._ended

    def rewind(self, system: System) -> None:
        """Everything as it is at the start: anchors, forces, the first row. InputError for a stream that is gone."""
        if self._started and self._stream is not None and not self._stream.again:
            raise InputError("stream", "cannot be read twice; start a new simulation, or give the path of a file")
        self._rows: Iterator[Row] = iter(())
        if self._stream is not None:
            wanted = dict.fromkeys(drive.source for drive in self.script.drives)
            self._rows = self._stream.rows(wanted, system.scene.units.time)
        self._row: Row | None = None
        self._next: Row | None = None
        self._ended = False
        self._before: Mapping[str, Mapping[str, Any]] = {}
        self.finished = False
        if self._stream is not None:
            self._row = next(self._rows)  # a stream without rows says so itself
        self._write(self._columns(0.0), system)
        for led in self._led:
            for held in _of(system, led):
                held.targets = led.targets(0.0, held)
        self._started = True

    def before(self, system: System, state: State, step: float) -> bool:
        """Set forces as they are at the start of a step, and anchors going to where they are at its end; whether
        anything but loads changed."""
        now = state.time
        self._follow(now + ON_TIME * step)
        self.finished = now >= self.script.end - ON_TIME * step and (self._stream is None or self._ended)
        stiffer = self._write(self._columns(now), system)
        for led in self._led:
            for held in _of(system, led):
                here, there = led.targets(now, held), led.targets(now + step, held)
                _put(state, held, here, (there - here) / step)
        return stiffer

    def quiet(self, now: float, step: float) -> int:
        """For how many steps from `now` nothing changes, one less than known; 1 at least."""
        if self._stream is not None and self._next is None and not self._ended:
            return 1
        due = min(self.script.quiet_until(now), np.inf if self._next is None else self._next.time)
        return max(1, math.ceil(min((due - now) / step, 1e9)) - 1)

    def after(self, system: System, state: State) -> None:
        """Anchors exactly on their paths, and at rest for all who look between steps."""
        for led in self._led:
            for held in _of(system, led):
                held.targets = led.targets(state.time, held)
                _put(state, held, held.targets, np.zeros_like(held.targets))

    def _columns(self, now: float) -> dict[str, dict[str, Any]]:
        columns = self.script.columns(now)
        for drive in self.script.drives if self._row is not None else ():
            assert self._row is not None
            columns.setdefault(str(drive.force), {})[drive.column] = drive.value(self._row)
        return columns

    def _follow(self, now: float) -> None:
        """Read on until a row that is not due yet."""
        while self._stream is not None and not self._ended:
            if self._next is None:
                self._next = next(self._rows, None)
                self._ended = self._next is None
            if self._next is None or self._next.time > now:
                break
            self._row, self._next = self._next, None

    def _write(self, columns: dict[str, dict[str, Any]], system: System) -> bool:
        if _same(columns, self._before):
            return False
        try:
            forces = changed_forces(system.scene, columns)
            lead_forces(system, forces)
        except InputError as error:
            if self._row is None:
                raise
            raise InputError(self._row.place, f"{error.pointer} {error.sentence}") from None
        self._before = columns
        return any(type(force).role != "load" for force in forces.values())

    def _bound(self, path: AnchorPath, pointer: str, system: System) -> _Led:
        held = named(system.held, path.anchor, f"{pointer}/anchor")
        if path.targets is not None and path.targets.shape[1] != len(held.particles):
            raise InputError(
                f"{pointer}/targets",
                f"{path.targets.shape[1]} targets for {len(held.particles)} particles; give one for each",
            )
        return _Led(path, held.number, held.particles, home(system, held, f"{pointer}/anchor"))

    def _fits(self, system: System) -> None:
        """Whether every value on the way, and so every one between, is one that its force takes."""
        for i, path in enumerate(self.script.forces):
            for j, value in enumerate(path.values):
                _tried(system, path, plain(value), f"/forces/{i}", f"/values/{j}")
        for i, drive in enumerate(self.script.drives):
            _tried(system, drive, plain(drive.scale), f"/drives/{i}", "/scale")


def _tried(system: System, path: ForcePath | Drive, value: Any, pointer: str, where: str) -> None:
    key = str(path.force)
    try:
        changed_forces(system.scene, {key: {path.column: value}})
    except InputError as error:
        if error.pointer == f"/forces/{key}":
            where = "/force"
        elif path.column not in error.pointer or re.search("no field|cannot change", error.sentence):
            where = "/column"
        raise InputError(f"{pointer}{where}", error.sentence) from None


def _of(system: System, led: _Led) -> list[Held]:
    return [held for held in system.held if held.number == led.number]


def _put(state: State, held: Held, targets: Floats, velocity: Floats) -> None:
    axes = np.ix_(held.particles, held.free == 0)
    state.x[axes], state.v[axes] = targets[:, held.free == 0], velocity[:, held.free == 0]


def _same(a: Mapping[str, Mapping[str, Any]], b: Mapping[str, Mapping[str, Any]]) -> bool:
    return a.keys() == b.keys() and all(
        a[f].keys() == b[f].keys() and all(np.array_equal(a[f][c], b[f][c]) for c in a[f]) for f in a
    )
