"""What stands for each component of Kangaroo: which of ours, input by input, what differs, and what has no counterpart.

Inputs and outputs of Kangaroo by their names in lower case without spaces, as files have them; ours by the names of
their variables without underscores. Sources of the differences: docs/from-kangaroo.md.
"""

from __future__ import annotations

from hookean_canvas.kangaroo import bodies, classic, engineering, engines, goals, held, rare, scripts, six, tools
from hookean_canvas.kangaroo.ids import COMPONENTS, Generation, Known, key
from hookean_canvas.kangaroo.pieces import Swap
from hookean_canvas.kangaroo.reasons import REASONS

CLASSIC: dict[str, Swap] = {**engines.CLASSIC, **classic.FORCES, **tools.CLASSIC}
SECOND: dict[str, Swap] = {**engines.SECOND, **goals.GOALS, **tools.SECOND}

TABLES: dict[Generation, dict[str, Swap]] = {
    "classic": CLASSIC,
    "second": SECOND,
    "engineering": engineering.ENGINEERING,
}


def swap_of(known: Known) -> Swap | None:
    """What a component of Kangaroo is swapped for; None where it stays."""
    return TABLES[known.generation].get(key(known.name))


def markdown() -> str:
    """The table for docs/canvas.md: every component that is known, what stands for it, and what differs or why none."""
    lines = ["| Kangaroo | component | here | what differs |", "| --- | --- | --- | --- |"]
    for generation, table in zip(("0.099", "2", "K2Engineering"), TABLES.values(), strict=True):
        for name, swap in table.items():
            by = ", ".join(_HELPER.get(piece.bundle, piece.bundle) for piece in swap.pieces)
            told = "; ".join(
                [
                    swap.differs,
                    *(f"{key}: {why}" for key, why in swap.without.items() if why not in swap.differs),
                    *(f"stays where {why}" for why in dict.fromkeys(swap.unless.values()) if why),
                ]
            )
            lines.append(f"| {generation} | {name} | {by} | {told.strip('; ')} |")
    there = {key(known.name): known.generation for known in COMPONENTS.values() if known.generation != "engineering"}
    for name in dict.fromkeys([*there, *REASONS]):
        if name not in CLASSIC and name not in SECOND:
            number = "0.099" if there.get(name) == "classic" else "2" if name in there else "0.099, 2"
            lines.append(f"| {number} | {name} | stays | {REASONS.get(name, _TOOL)} |")
    for name, why in engineering.REASONS.items():
        lines.append(f"| K2Engineering | {name} | stays | {why} |")
    return "\n".join(lines) + "\n"


_TOOL = "a tool for geometry"
_HELPER = {
    "*geometry": "a parameter",
    "*nothing": "an empty parameter",
    "*corners": "a script for corners",
    "*upwards": "a script for vectors",
    "*lines": "a script for lines",
    "*half": "a script for halves",
    "*plane": "a script for planes",
    **scripts.TOLD,
    **engineering.TOLD,
    **six.TOLD,
    **held.TOLD,
    **rare.TOLD,
    **bodies.TOLD,
}
