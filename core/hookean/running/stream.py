"""Streams: rows of measured or made values that drive loads, read one by one as they come.

    time [s],speed [m/s]
    0,4.2
    0.5,4.4

The first line names the columns, with their units; `time` is one of them. Between rows nothing is guessed: a row stands
until the next one (zero-order hold). The first row's time is the start of the simulation.
"""

from __future__ import annotations

import csv
import math
import re
import sys
from collections.abc import Iterable, Iterator
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any

from hookean.errors import InputError
from hookean.values.units import SECONDS


@dataclass(frozen=True)
class Row:
    """One row: its time since the first row [time of the scene], the wanted values by column, where it stands."""

    time: float
    values: dict[str, float]
    place: str


class Stream:
    """Values over time in CSV: the path of a file, `-` for standard input, or any iterable of lines.

    Lines are read when they are needed and not before, so that a simulation follows a pipe that is still written to.
    """

    def __init__(self, source: str | Path | Iterable[str]) -> None:
        self._source = source
        self.again = isinstance(source, Path) or (isinstance(source, str) and source != "-")
        named = {True: Path(source).name if isinstance(source, str | Path) else "", False: "stream"}[self.again]
        self.name = "standard input" if isinstance(source, str) and source == "-" else named

    def rows(self, wanted: Iterable[str], time: str = "s") -> Iterator[Row]:
        """Rows with the columns `wanted` (`speed`, or with its unit `speed [m/s]`) and times in the unit `time`.

        Raises InputError: an unknown column, or an invalid row, with its line. The header is read at once.
        """
        lines = self._lines()
        reader = csv.reader(lines)
        try:
            header = next(reader, None)
        except (csv.Error, UnicodeDecodeError) as error:
            raise InputError(f"{self.name} line 1", _unreadable(error)) from None
        if not header:
            raise InputError(self.name, "is empty; the first line names columns, such as: time [s],speed [m/s]")
        columns = [_column(cell) for cell in header]
        clock = self._place(columns, "time")
        unit = columns[clock][1] or time
        if unit not in SECONDS:
            raise InputError(f"{self.name} line 1", f"time is in {unit!r}; one of {', '.join(SECONDS)} is allowed")
        places = {name: self._place(columns, name) for name in wanted}
        return self._rows(reader, columns, clock, places, SECONDS[unit] / SECONDS[time])

    def _rows(
        self, reader: Any, columns: list[tuple[str, str]], clock: int, places: dict[str, int], factor: float
    ) -> Iterator[Row]:
        first = last = None
        blank = ""
        while True:
            place = f"{self.name} line {reader.line_num + 1}"
            try:
                cells = next(reader, None)
            except (csv.Error, UnicodeDecodeError) as error:
                raise InputError(place, _unreadable(error)) from None
            if cells is None:
                break
            if not cells:
                blank = blank or place
                continue
            if blank:
                raise InputError(blank, "is empty; give a row of values, or remove the line")
            if len(cells) != len(columns):
                names = ", ".join(name for name, _ in columns)
                count = f"{len(cells)} value{'s' * (len(cells) > 1)} for {len(columns)} columns"
                raise InputError(place, f"{count}; give one for each of {names}")
            now = _number(cells[clock], columns[clock], place) * factor
            if last is not None and now <= last:
                raise InputError(place, f"time {cells[clock].strip()} is not after the row before; times must increase")
            first, last = now if first is None else first, now
            yield Row(now - first, {n: _number(cells[i], columns[i], place) for n, i in places.items()}, place)
        if first is None:
            raise InputError(self.name, "has no row after its first line; give rows of values")

    def _place(self, columns: list[tuple[str, str]], wanted: str) -> int:
        """The column with this name, and unit if one is given."""
        name, unit = _column(wanted)
        found = [i for i, column in enumerate(columns) if column[0] == name]
        if len(found) == 1 and unit in ("", columns[found[0]][1]):
            return found[0]
        where = f"{self.name} line 1"
        shown = ", ".join(f"{n} [{u}]" if u else n or "a column without a name" for n, u in columns)
        if len(found) > 1:
            raise InputError(where, f"{len(found)} columns have the name {name}; give each its own name")
        raise InputError(where, f"no column {wanted}; there are {shown} (separated by commas)")

    def _lines(self) -> Iterator[str]:
        if isinstance(self._source, Path) or self.again:
            try:
                opened: Any = open(str(self._source), encoding="utf-8-sig", newline="")  # noqa: SIM115
            except (OSError, ValueError) as error:
                why = getattr(error, "strerror", None) or "invalid path"
                raise InputError(self.name, f"cannot be read ({why}); check the path") from None
            return _each(opened)
        if self._source == "-":
            return _each(nullcontext(sys.stdin))
        return iter(self._source)


def _each(opened: AbstractContextManager[IO[str]]) -> Iterator[str]:
    with opened as lines:
        # readline gives a line as soon as it is there
        yield from iter(lines.readline, "")


def _column(cell: str) -> tuple[str, str]:
    """Name and unit of a heading such as `speed [m/s]`."""
    parts = re.fullmatch(r"\s*(.*?)\s*(?:\[([^\]]*)\])?\s*", cell.removeprefix("\ufeff"), re.S)
    return (parts[1], (parts[2] or "").strip()) if parts else (cell, "")


def _number(cell: str, column: tuple[str, str], place: str) -> float:
    try:
        value = float("" if "_" in cell else cell)
    except ValueError:
        value = math.nan
    if math.isfinite(value):
        return value
    given = f"{cell.strip()[:40]!r}" if cell.strip() else "empty"
    unit = f" in {column[1]}" if column[1] else ""
    raise InputError(place, f"{column[0]} is {given}; give a finite number{unit}")


def _unreadable(error: Exception) -> str:
    if isinstance(error, UnicodeDecodeError):
        return "is not UTF-8 text; save it as UTF-8"
    return f"cannot be read as CSV ({error}); give values separated by commas"
