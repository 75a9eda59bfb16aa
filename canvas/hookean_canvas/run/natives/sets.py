"""Natives of the tab Sets that join and sort several lists, and those of colours that hand on what they colour."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

from hookean_canvas.run.natives.declare import Unfit, native
from hookean_canvas.run.natives.lists import same
from hookean_canvas.run.rhino import rhino3dm

Values = list[Any]
_TWO = "Set A (A): any list; Set B (B): any list"


def _different(values: Values) -> Values:
    found: Values = []
    for value in values:
        if not _holds(found, value):
            found.append(value)
    return found


def _holds(values: Values, value: Any) -> bool:
    return any(same(known, value) for known in values)


@native("8eed5d78-7810-4ba1-968e-8a1f1db98e39", "Set Union", "SUnion", f"{_TWO} ...", "Union (U): list")
def set_union(*sets: Values) -> Values:
    """The different items of all sets, in their order."""
    return _different([value for one in sets for value in one])


@native("e3b1a10c-4d49-4140-b8e6-0b5732a26c31", "Set Difference", "SDiff", _TWO, "Union (U): list")
def set_difference(first: Values, second: Values) -> Values:
    """The different items of the first set that the second lacks."""
    return [value for value in _different(first) if not _holds(second, value)]


@native("82f19c48-9e73-43a4-ae6c-3a8368099b08", "Set Intersection", "SInter", f"{_TWO} ...", "Union (U): list")
def set_intersection(first: Values, *others: Values) -> Values:
    """The different items that are in all sets."""
    return [value for value in _different(first) if all(_holds(other, value) for other in others)]


@native("e7c80ff6-0299-4303-be36-3080977c14a1", "Combine Data", "Combine",
        "Input 0 (0): any optional; Input 1 (1): any optional ...", "Result (R); Index (I)")  # fmt: skip
def combine_data(*values: Any) -> tuple[Any, int]:
    """The first input that is no null, and its number; null and -1 where all are."""
    return next(((value, i) for i, value in enumerate(values) if value is not None), (None, -1))


@native("3249222f-f536-467a-89f4-f0353fba455a", "Sift Pattern", "Sift",
        "List (L): any list; Sift Pattern (P): integer list", "0 (0): list; 1 (1): list ...", sees=True)  # fmt: skip
def sift_pattern(values: Values, pattern: list[int], node: Any) -> tuple[Values, ...]:
    """Each item to the output that the repeated pattern names, nulls to the others."""
    count = len(node.outputs) if node is not None else 1 + max(pattern, default=0)
    if not pattern or not all(0 <= one < count for one in pattern):
        raise Unfit("the pattern must hold numbers of outputs")
    return tuple(
        [value if pattern[i % len(pattern)] == k else None for i, value in enumerate(values)] for k in range(count)
    )


@native("03b801eb-87cd-476a-a591-257fe5d5bf0f", "Pick'n'Choose", "P'n'C",
        "Pattern (P): integer list; Stream 0 (0): any list; Stream 1 (1): any list ...",
        "Result (R): list")  # fmt: skip
def pick_and_choose(pattern: list[int], *streams: Values) -> Values:
    """For each number of the pattern the item at its place in that stream."""
    if not all(0 <= one < len(streams) for one in pattern):
        raise Unfit("the pattern must hold numbers of streams")
    return [streams[one][i] if i < len(streams[one]) else None for i, one in enumerate(pattern)]


@native("", "Consecutive Domains", "Consec", "Numbers (N): number list; Additive (A): boolean = True",
        "Domains (D): list")  # fmt: skip
def consecutive_domains(numbers: list[float], additive: bool) -> Values:
    """Domains from each number to the next; additive: one as long as each number, end to end from 0."""
    ends = list(numbers)
    if additive:
        ends = [0.0]
        for number in numbers:
            ends.append(ends[-1] + number)
    return [rhino3dm.Interval(a, b) for a, b in pairwise(ends)]


@native("d2cedf38-1149-4adc-8dbf-b06571cb5106", "Mesh Colours", "MCol",
        "Mesh (M): mesh; Colours (C): any list optional", "Mesh (M)", remark="meshes have no colours here")  # fmt: skip
def mesh_colours(mesh: Any, colours: Values | None) -> Any:
    """The mesh as it is."""
    return mesh


@native("45f19d16-1c9f-4b0f-a9a6-45a77f3d206c", "Loft Options", "Loft Opt",
        "Closed loft (Cls): any optional; Adjust seams (Adj): any optional; Rebuild count (Rbd): any optional; "
        "Refit tolerance (Rft): any optional; Loft type (T): any optional", "Options (O)")  # fmt: skip
def loft_options(*given: Any) -> Any:
    """Nothing: Loft has no options here."""
    return None
