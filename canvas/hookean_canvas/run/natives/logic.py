"""Natives of the tab Maths: comparisons, gates, domains."""

from __future__ import annotations

from collections.abc import Callable
from functools import reduce
from itertools import pairwise
from typing import Any

from hookean_canvas.run.natives.declare import Unfit, bounded, native
from hookean_canvas.run.rhino import rhino3dm

_NUMBERS = "First Number (A): number; Second Number (B): number = 0.0"


@native(
    "30d58600-1aab-42db-80a3-f1ea6c4269a0", "Larger Than", "Larger", _NUMBERS, "Larger than (>); … or Equal to (>=)"
)
def larger(a: float, b: float) -> tuple[bool, bool]:
    """Whether A is larger than B, and whether it is larger or equal."""
    return a > b, a >= b


@native("ae840986-cade-4e5a-96b0-570f007d4fc0", "Smaller Than", "Smaller",
        _NUMBERS, "Smaller than (<); … or Equal to (<=)")  # fmt: skip
def smaller(a: float, b: float) -> tuple[bool, bool]:
    """Whether A is smaller than B, and whether it is smaller or equal."""
    return a < b, a <= b


@native("5db0fb89-4f22-4f09-a777-fa5e55aed7ec", "Equality", "Equals", _NUMBERS, "Equality (=); Inequality (≠)")
def equality(a: float, b: float) -> tuple[bool, bool]:
    """Whether two numbers are equal, and whether they are not."""
    return a == b, a != b


@native("40177d8a-a35c-4622-bca7-d150031fe427", "Similarity", "Similar",
        f"{_NUMBERS}; Threshold (T%): number = 0.25", "Similarity (=); Absolute difference (dt)")  # fmt: skip
def similarity(a: float, b: float, percent: float) -> tuple[bool, float]:
    """Whether two numbers differ by no more than a percentage of the larger one, and their difference."""
    return abs(a - b) <= 0.01 * percent * max(abs(a), abs(b)), abs(a - b)


@native("cb2c7d3c-41b4-4c6d-a6bd-9235bd2851bb", "Gate Not", "Not", "A (A): boolean", "Result (R)")
def gate_not(a: bool) -> bool:
    """The opposite of a truth value."""
    return not a


_GATES: list[tuple[str, str, str, Callable[[bool, bool], bool], str, str]] = [
    ("040f195d-0b4e-4fe0-901f-fedb2fd3db15", "Gate And", "And", lambda a, b: a and b, " ...", "Whether all are True."),
    ("5cad70f9-5a53-4c5c-a782-54a479b4abe3", "Gate Or", "Or", lambda a, b: a or b, " ...", "Whether one is True."),
    ("de4a0d86-2709-4564-935a-88bf4d40af89", "Gate Xor", "Xor", lambda a, b: a != b, "", "Whether just one is True."),
    ("b6aedcac-bf43-42d4-899e-d763612f834d", "Gate Xnor", "Xnor", lambda a, b: a == b, "", "Whether both are equal."),
    ("5ca5de6b-bc71-46c4-a8f7-7f30d7040acb", "Gate Nand", "Nand", lambda a, b: not (a and b), "",
     "Whether not both are True."),
    ("548177c2-d1db-4172-b667-bec979e2d38b", "Gate Nor", "Nor", lambda a, b: not (a or b), "",
     "Whether neither is True."),
]  # fmt: skip


def _declare(guid: str, name: str, nickname: str, gate: Callable[[bool, bool], bool], more: str, does: str) -> None:
    def run(*values: bool) -> bool:
        return reduce(gate, values)

    run.__doc__ = does
    native(guid, name, nickname, f"A (A): boolean; B (B): boolean{more}", "Result (R)")(run)


for _row in _GATES:
    _declare(*_row)


@native("d1a28e95-cf96-4936-bf34-8bf142d731bf", "Construct Domain", "Dom",
        "Domain start (A): number = 0.0; Domain end (B): number = 1.0", "Domain (I)")  # fmt: skip
def construct_domain(start: float, end: float) -> Any:
    """A domain between two numbers."""
    return rhino3dm.Interval(start, end)


@native("825ea536-aebb-41e9-af32-8baeb2ecb590", "Deconstruct Domain", "DeDomain",
        "Domain (I): domain", "Start (S); End (E)")  # fmt: skip
def deconstruct_domain(domain: Any) -> tuple[float, float]:
    """The start and the end of a domain."""
    return domain.T0, domain.T1


@native("f44b92b0-3b5b-493a-86f4-fd7408c3daf3", "Bounds", "Bnd", "Numbers (N): number list", "Domain (I)")
def bounds(values: list[float]) -> Any:
    """The domain from the smallest to the largest number."""
    found = [value for value in values if value is not None]
    if not found:
        raise Unfit("the list has no numbers")
    return rhino3dm.Interval(min(found), max(found))


@native("75ef4190-91a2-42d9-a245-32a7162b0384", "Divide Domain", "Div",
        "Domain (I): domain; Count (C): integer = 10", "Segments (S): list")  # fmt: skip
def divide_domain(domain: Any, count: int) -> list[Any]:
    """Domains of equal length that a domain consists of."""
    if count < 1:
        raise Unfit("Count must be at least 1")
    bounded(count)
    ends = [domain.T0 + (domain.T1 - domain.T0) * i / count for i in range(count + 1)]
    return [rhino3dm.Interval(a, b) for a, b in pairwise(ends)]


@native("f217f873-92f1-47ae-ad71-ca3c5a45c3f8", "Includes", "Inc",
        "Value (V): number; Domain (D): domain", "Includes (I); Deviation (D)")  # fmt: skip
def includes(value: float, domain: Any) -> tuple[bool, float]:
    """Whether a domain includes a number, and how far the number is from it."""
    low, high = sorted((domain.T0, domain.T1))
    return low <= value <= high, max(low - value, value - high, 0.0)


@native("2fcc2743-8339-4cdf-a046-a1f17439191d", "Remap Numbers", "ReMap",
        "Value (V): number; Source (S): domain; Target (T): domain", "Mapped (R); Clipped (C)")  # fmt: skip
def remap_numbers(value: float, source: Any, target: Any) -> tuple[float, float]:
    """A number mapped linearly from one domain to another; the second result stays within the target."""
    span = source.T1 - source.T0
    t = (value - source.T0) / span if span else 0.0
    mapped, clipped = (target.T0 + (target.T1 - target.T0) * part for part in (t, min(max(t, 0.0), 1.0)))
    return mapped, clipped


@native("2013e425-8713-42e2-a661-b57e78840337", "Concatenate", "Concat",
        "Fragment A (A): text optional; Fragment B (B): text optional ...", "Result (R)")  # fmt: skip
def concatenate(*texts: str | None) -> str:
    """Text after text."""
    return "".join(text or "" for text in texts)


@native("1274d51a-81e6-4ccf-ad1f-0edf4c769cac", "Text Join", "Join",
        "Text (T): text list; Join (J): text = ','", "Result (R)")  # fmt: skip
def text_join(texts: list[str], join: str) -> str:
    """Texts with a separator between them."""
    return join.join(text or "" for text in texts)
