"""Report: what became of a description on its way to particles, and what a person should know before solving."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import inf

from hookean.errors import InputError, several

MOST_LISTED = 10  # warnings on forces and anchors with points that met no particle, one each

_PLURALS = {"point": "points", "line": "lines", "vertex": "vertices"}
_WITHOUT = {"anchor": "nothing is held there", "load": "that part of the load is left out"}


@dataclass(frozen=True)
class Unmatched:
    """A point of an anchor or load that met no particle: where it is, and the nearest particle with its distance."""

    pointer: str
    name: str
    point: tuple[float, float, float]
    nearest: int
    distance: float

    @property
    def sentence(self) -> str:
        """One line on it."""
        spot = ", ".join(f"{c:.6g}" for c in self.point)
        return (
            f"{self.pointer}: no particle at ({spot}); the nearest is particle {self.nearest}, {self.distance:.6g} "
            "away. Move the point onto it, or raise weld_tolerance"
        )


@dataclass(frozen=True)
class Missed:
    """What of one force or anchor met no particle: `count` of `total` points, lines or vertices (`what`).

    `role` is that of the force, or `anchor`; `distance` is the smallest distance [length, `unit`] from such a point to
    a particle, `point` the point that is so near.
    """

    pointer: str
    name: str
    role: str
    what: str
    count: int
    total: int
    point: tuple[float, float, float]
    distance: float
    unit: str

    @property
    def sentence(self) -> str:
        """How many of how many met no particle, and how near one is."""
        who = f"{self.name}: " if self.name else ""
        what = f"its {self.what}" if self.total == 1 else f"{self.count} of {self.total} {_PLURALS[self.what]}"
        spot = ", ".join(f"{c:.6g}" for c in self.point)
        return f"{who}{what} met no particle; the nearest is {self.distance:.6g} {self.unit} away from ({spot})"

    @property
    def warning(self) -> str:
        """The warning if the scene continues without them."""
        without = _WITHOUT.get(self.role, "nothing acts there")
        return f"{self.pointer}: {self.sentence}, so {without}. {self._advice}, or raise weld_tolerance"

    def refusal(self, *, strict: bool) -> InputError:
        """The error if it does not: the scene is `strict`, or no anchor of it meets a particle."""
        if self.distance == inf:
            said = "the scene has no particles to meet; add particles, or forces with points there"
            return InputError(self.pointer, f"{self.name}: {said}" if self.name else said)
        if strict:
            advice = f"{self._advice}, raise weld_tolerance, or set strict to false to continue without them"
        else:
            advice = f"No anchor holds a particle: {self._advice.lower()}, or raise weld_tolerance"
        return InputError(self.pointer, f"{self.sentence}. {advice}")

    @property
    def _advice(self) -> str:
        return "Move it onto a particle" if self.count == 1 else "Move them onto particles"


@dataclass
class Report:
    """What compiling a scene merged, moved or left out, and warnings to read before solving.

    `missed` has an entry for each force and anchor with points that met no particle, `unmatched` each of these points;
    `warnings` has all other sentences; `beside` counts the coordinates that were moved onto a particle nearby.
    """

    merged: int = 0
    unmatched: list[Unmatched] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)
    beside: int = 0
    missed: list[Missed] = field(default_factory=list)

    def settle(self, *, strict: bool, held: bool) -> None:
        """Judge what met no particle, once all of it is known.

        InputError where the scene is strict, or where none of its anchors met any (`held`: one did).
        """
        refused = [m for m in self.missed if strict or (m.role == "anchor" and not held)]
        if refused:
            raise several([m.refusal(strict=held or m.role != "anchor") for m in refused])

    def left_out(self) -> list[str]:
        """A sentence for each force and anchor with points that met no particle: the first few, and how many more."""
        lines = [missed.warning for missed in self.missed[:MOST_LISTED]]
        more = len(self.missed) - MOST_LISTED
        return [*lines, f"points of {more} more forces or anchors met no particle"] if more > 0 else lines

    def sentences(self) -> list[str]:
        """All sentences: what met no particle, warnings, how much was moved onto a particle."""
        lines = [*self.left_out(), *self.warnings]
        if self.beside:
            what = "1 coordinate was" if self.beside == 1 else f"{self.beside} coordinates were"
            lines.append(f"{what} moved onto a particle nearby, within weld_tolerance")
        return lines
