"""Envelopes: the extremes of several results of one model, and which of them has each."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.running.utilisation import NAME, STRESS, dimensions
from hookean.values.units import Units

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
ALIKE = 1e-6  # of the largest value: what symmetry makes equal differs by what a solution leaves out of balance


def first_largest(values: Floats) -> int:
    """The place of the largest value (m,), of several that are alike the first; 0 of none."""
    largest = values.max(initial=-np.inf)
    return int(np.argmax(values >= largest - ALIKE * abs(largest))) if len(values) else 0


SHOWN = ("force", "moment", "warp", "weft", STRESS, NAME)
"""Columns of forces that a summary has."""


def _both(found: Extremes) -> list[tuple[Floats, Ints]]:
    return [(found.smallest, found.smallest_case), (found.largest, found.largest_case)]


@dataclass(frozen=True)
class Extremes:
    """Of a column of numbers (m,) over several cases: the `smallest` and `largest` (m,), and in which case each is."""

    smallest: Floats
    smallest_case: Ints
    largest: Floats
    largest_case: Ints

    @classmethod
    def of(cls, values: Floats) -> Extremes:
        """Of values (cases, m)."""
        low, high = values.argmin(axis=0), values.argmax(axis=0)
        row = np.arange(values.shape[1])
        return cls(values[low, row], low, values[high, row], high)


@dataclass(frozen=True, repr=False)
class Envelope:
    """The extremes of several cases, whose names are `cases`; extremes have the numbers of their cases.

    `displacement` [length]: how far each particle moves; `forces` one dict for each force of the scene with its name,
    kind and `columns` (size of vectors), in the units of results; `reaction` [force]: the size at each of the held
    `particles`, and `moment` [force length] likewise, where some have rotations.
    """

    cases: tuple[str, ...]
    displacement: Extremes
    forces: tuple[dict[str, Any], ...]
    particles: Ints
    reaction: Extremes
    units: Units
    moment: Extremes | None = None

    def __repr__(self) -> str:
        return "\n".join(["Envelope", *(f"  {line}" for line in self.summary())])

    def summary(self) -> list[str]:
        """The largest displacement, forces and reaction, where they are and in which case."""
        unit = self.units
        spot = first_largest(self.displacement.largest)
        lines = [self._line("displacement", self.displacement, spot, unit.length, f"particle {spot}")]
        for entry in self.forces:
            for name, found in entry["columns"].items():
                if name not in SHOWN or not len(found.largest):
                    continue
                kind = unit.of(dimensions(entry["kind"])[name]) or "-"
                at, low = first_largest(found.largest), first_largest(-found.smallest)
                lines.append(self._line(f"{entry['name'] or entry['kind']} {name}", found, at, kind, f"element {at}"))
                if found.smallest[low] < 0.0:
                    case = self.cases[found.smallest_case[low]]
                    lines.append(f"  smallest {found.smallest[low]:.5g} {kind} at element {low} in {case}")
            lines += self._bending(entry)
        if len(self.particles):
            at = first_largest(self.reaction.largest)
            lines.append(self._line("reaction", self.reaction, at, unit.force, f"particle {self.particles[at]}"))
        if self.moment is not None:
            at = first_largest(self.moment.largest)
            where = f"particle {self.particles[at]}"
            lines.append(self._line("reaction moment", self.moment, at, unit.of("moment"), where))
        return lines

    def _bending(self, entry: dict[str, Any]) -> list[str]:
        """The largest size of the moments at either end of beams, about each axis."""
        lines, unit = [], self.units.of("moment")
        for axis in "yz":
            ends = [entry["columns"][name] for name in (f"M{axis}0", f"M{axis}1") if name in entry["columns"]]
            values = [(part, which) for end in ends for part, which in _both(end)]
            if values and len(values[0][0]):
                sizes = np.abs(np.array([part for part, _ in values]))
                at = first_largest(sizes.max(axis=0))
                case = self.cases[values[int(sizes[:, at].argmax())][1][at]]
                title = f"{entry['name'] or entry['kind']} moment M{axis}"
                lines.append(f"{title}: largest {sizes[:, at].max():.5g} {unit} at element {at} in {case}")
        return lines

    def _line(self, what: str, found: Extremes, at: int, unit: str, where: str) -> str:
        return f"{what}: largest {found.largest[at]:.5g} {unit} at {where} in {self.cases[found.largest_case[at]]}"

    def to_dict(self) -> dict[str, Any]:
        """As plain lists and numbers, by the names of the HTTP answer; cases by name."""
        forces = []
        for entry in self.forces:
            columns = {name: self._plain(found) for name, found in entry["columns"].items()}
            forces.append({**entry, "columns": columns})
        reactions = {"particles": self.particles.tolist(), "force": self._plain(self.reaction)}
        if self.moment is not None:
            reactions["moment"] = self._plain(self.moment)
        return {
            "cases": list(self.cases),
            "displacement": self._plain(self.displacement),
            "forces": forces,
            "reactions": reactions,
        }

    def _plain(self, found: Extremes) -> dict[str, list[Any]]:
        return {
            "smallest": found.smallest.tolist(),
            "smallest_case": [self.cases[i] for i in found.smallest_case],
            "largest": found.largest.tolist(),
            "largest_case": [self.cases[i] for i in found.largest_case],
        }


Shown = tuple[Sequence[Mapping[str, Any]], Mapping[str, Any], Floats]
"""Of a case: its forces and reactions as a result has them, and the displacements (n, 3) [length]."""


def envelope(cases: Mapping[str, Shown], units: Units) -> Envelope:
    """The envelope of cases by their names; at least one."""
    first, held, _ = next(iter(cases.values()))
    moved = np.array([np.linalg.norm(displacements, axis=1) for _, _, displacements in cases.values()])
    reactions = np.array([np.linalg.norm(_vectors(found["force"]), axis=1) for _, found, _ in cases.values()])
    turned = np.array([np.linalg.norm(_vectors(found.get("moment", ())), axis=1) for _, found, _ in cases.values()])
    forces = []
    for number, entry in enumerate(first):
        columns = {}
        for name in dimensions(entry["kind"]):
            found = [_sizes(own[number].get(name)) for own, _, _ in cases.values()]
            whole = [values for values in found if values is not None]
            if len(whole) == len(found) and len({len(values) for values in whole}) == 1:
                columns[name] = Extremes.of(np.array(whole))
        forces.append({"name": entry["name"], "kind": entry["kind"], "columns": columns})
    particles = np.asarray(held["particles"], dtype=np.int64)
    moment = Extremes.of(turned) if turned.size else None  # no rows where no particle has a rotation
    return Envelope(tuple(cases), Extremes.of(moved), tuple(forces), particles, Extremes.of(reactions), units, moment)


def _vectors(rows: Any) -> Floats:
    return np.asarray(rows, dtype=float).reshape(-1, 3)


def _sizes(column: Any) -> Floats | None:
    """A column of numbers, or the sizes of vectors; None if the column is missing."""
    if column is None:
        return None
    values = np.asarray(column, dtype=float)
    return np.linalg.norm(values, axis=1) if values.ndim == 2 else values
