"""What an import of a Kangaroo definition did and could not do, in words and numbers."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field


@dataclass
class Report:
    """`swapped`: (component, what stands for it, what differs); `stays`: (component, why); `lost`: (wire, why).
    `idle`: the same of wires that have nothing to do here.

    `solvers` counts the solvers of Kangaroo, `whole` those that were translated with all goals.

    `values`: (input, why its typed value is gone). `kangaroo` counts the components of Kangaroo there were, `wires`
    those that led somewhere, `kept` those that are in the translated file.
    """

    name: str
    objects: int = 0
    kangaroo: int = 0
    wires: int = 0
    kept: int = 0
    solvers: int = 0
    whole: int = 0
    swapped: list[tuple[str, str, str]] = field(default_factory=list)
    stays: list[tuple[str, str]] = field(default_factory=list)
    lost: list[tuple[str, str]] = field(default_factory=list)
    idle: list[tuple[str, str]] = field(default_factory=list)
    values: list[tuple[str, str]] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)

    @property
    def complete(self) -> bool:
        """Whether all of Kangaroo was translated: nothing stays, no wire and no value is lost."""
        return not (self.stays or self.lost or self.values)

    def text(self) -> str:
        """The report as lines for a terminal, or for a panel on the canvas."""
        return "\n".join(self._lines())

    def _lines(self) -> Iterator[str]:
        yield (
            f"{self.name}: {self.objects} objects, {self.kangaroo} of Kangaroo's, {len(self.swapped)} translated; "
            f"{self.wires} wires, {self.kept} kept, {len(self.lost) + len(self.idle)} not"
            + (f"; {self.whole} of {self.solvers} solvers translated with all goals" if self.solvers else "")
        )
        yield from _part("Not translated", _together(self.stays))
        yield from _part("Wires that are gone", [f"{wire}: {why}" for wire, why in self.lost])
        yield from _part("Wires that are not needed", [f"{wire}: {why}" for wire, why in self.idle])
        yield from _part("Typed values that are gone", [f"{where}: {why}" for where, why in self.values])
        yield from _part("Translated", _told_once(self.swapped))
        yield from _part("Note", self.notes)


def _part(title: str, lines: list[str]) -> Iterator[str]:
    if lines:
        yield ""
        yield title
        yield from (f"- {line}" for line in lines)


def _together(stays: list[tuple[str, str]]) -> list[str]:
    """A line for each reason, with all components that stay for it; equal names are counted."""
    reasons: dict[str, Counter[str]] = {}
    for what, why in stays:
        reasons.setdefault(why, Counter())[what] += 1
    return [
        f"{', '.join(what if count == 1 else f'{count} {what}' for what, count in found.items())}: {why}"
        for why, found in reasons.items()
    ]


def _told_once(swapped: list[tuple[str, str, str]]) -> list[str]:
    """Differences are reported with the first component of its kind."""
    said: set[str] = set()
    lines = []
    for what, by, differs in swapped:
        lines.append(f"{what} -> {by}" + (f": {differs}" if differs and differs not in said else ""))
        said.add(differs)
    return lines
