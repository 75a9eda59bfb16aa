"""Natives of the tab Sets that compare sets and make sequences."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from hookean_canvas.run.natives.declare import Unfit, bounded, native
from hookean_canvas.run.natives.expressions import evaluated
from hookean_canvas.run.natives.lists import same

Values = list[Any]
_TWO = "Set A (A): any list; Set B (B): any list"


def _holds(values: Values, value: Any) -> bool:
    return any(same(known, value) for known in values)


def _different(values: Values) -> Values:
    found: Values = []
    for value in values:
        if not _holds(found, value):
            found.append(value)
    return found


@native("d2461702-3164-4894-8c10-ed1fc4b52965", "Set Difference (S)", "ExDiff", _TWO, "ExDifference (X): list")
def symmetric_difference(a: Values, b: Values) -> Values:
    """The different items that are in one of two sets alone."""
    return _different([*(v for v in a if not _holds(b, v)), *(v for v in b if not _holds(a, v))])


@native("d4136a7b-7422-4660-9404-640474bd2725", "Set Majority", "Majority", f"{_TWO}; Set C (C): any list",
        "Result (R): list")  # fmt: skip
def set_majority(a: Values, b: Values, c: Values) -> Values:
    """The different items that are in two of three sets at least."""
    return [v for v in _different([*a, *b, *c]) if sum(_holds(one, v) for one in (a, b, c)) > 1]


@native("4cfc0bb0-0745-4772-a520-39f9bf3d99bc", "SubSet", "SubSet", _TWO, "Result (R)")
def subset(a: Values, b: Values) -> bool:
    """Whether all items of B are in A."""
    return all(_holds(a, v) for v in b)


@native("81800098-1060-4e2b-80d4-17f835cc825f", "Disjoint", "Disjoint", _TWO, "Result (R)")
def disjoint(a: Values, b: Values) -> bool:
    """Whether no item of A is in B."""
    return not any(_holds(b, v) for v in a)


@native("deffaf1e-270a-4c15-a693-9216b68afd4a", "Carthesian Product", "CProd", _TWO, "Product (P): branches")
def cartesian_product(a: Values, b: Values) -> list[Values]:
    """Pairs of the items of two lists of equal length, a branch each."""
    if len(a) != len(b):
        raise Unfit("both sets must have as many items")
    return [[x, y] for x, y in zip(a, b, strict=True)]


@native("190d042c-2270-4bc1-81c0-4f90c170c9c9", "Delete Consecutive", "DCon",
        "Set (S): any list; Wrap (W): boolean = False", "Set (S): list; Count (N)")  # fmt: skip
def delete_consecutive(values: Values, wrap: bool) -> tuple[Values, int]:
    """A list without items that are the same as the one before, and how many went."""
    found: Values = []
    for value in values:
        if not found or not same(found[-1], value):
            found.append(value)
    if wrap and len(found) > 1 and same(found[0], found[-1]):
        found.pop()
    return found, len(values) - len(found)


@native("1edcc3cf-cf84-41d4-8204-561162cfe510", "Key/Value Search", "KeySearch",
        "Keys (K): any list; Values (V): any list; Search (S): any", "Result (R)")  # fmt: skip
def key_search(keys: Values, values: Values, wanted: Any) -> Any:
    """The value of the first key that is the same as one."""
    for key, value in zip(keys, values, strict=False):
        if same(key, wanted):
            return value
    raise Unfit("no key is the same")


@native("bafac914-ede4-4a59-a7b2-cc41bc3de961", "Replace Members", "Replace",
        "Set (S): any list; Find (F): any list; Replace (R): any list", "Result (R): list")  # fmt: skip
def replace_members(values: Values, find: Values, instead: Values) -> Values:
    """A list with other items in the place of some, the last one for all that have none of their own."""
    if not instead:
        raise Unfit("there is nothing to replace them with")

    def other(value: Any) -> Any:
        number = next((i for i, known in enumerate(find) if same(known, value)), None)
        return value if number is None else instead[min(number, len(instead) - 1)]

    return [other(value) for value in values]


@native("b4d4235f-14ff-4d4e-a29a-b358dcd2baf4", "Find similar member", "FSim", "Data (D): any; Set (S): any list",
        "Hit (H); Index (i)", remark="numbers and points are compared; other values by being the same")  # fmt: skip
def find_similar(value: Any, values: Values) -> tuple[Any, int]:
    """The item of a list that is nearest to a value, and its number."""

    def apart(other: Any) -> float:
        if isinstance(value, (int, float)) and isinstance(other, (int, float)):
            return abs(value - other)
        if hasattr(value, "Z") and hasattr(other, "Z"):
            return math.dist((value.X, value.Y, value.Z), (other.X, other.Y, other.Z))
        return 0.0 if same(value, other) else math.inf

    gaps = [apart(other) for other in values]
    if not gaps or min(gaps) == math.inf:
        raise Unfit("no item is like it")
    number = gaps.index(min(gaps))
    return values[number], number


@native("a12dddbf-bb49-4ef4-aeb8-5653bc882cbd", "RandomEx", "RndEx",
        "Min (L0): integer; Max (L1): integer; Number (N): integer = 10; Seed (S): integer = 2", "Values (V): list",
        remark="other values than in Grasshopper, the same in every run")  # fmt: skip
def random_between(low: int, high: int, count: int, seed: int) -> list[int]:
    """Whole numbers from one to another by chance."""
    if count < 0 or high < low:
        raise Unfit("Number must not be negative, and Max not below Min")
    bounded(count)
    return [int(one) for one in np.random.default_rng(abs(seed)).integers(low, high + 1, count)]


@native("01640871-69ea-40ac-9380-4660d6d28bd2", "Char Sequence", "CharSeq",
        "Count (C): integer = 10; Char Pool (P): text = 'ABCDEFGHIJKLMNOPQRSTUVWXYZ'; Format (F): text optional",
        "Sequence (S): list")  # fmt: skip
def char_sequence(count: int, pool: str, form: str | None) -> list[str]:
    """Tags A, B, ... Z, AA, AB ... of some characters, within a text with {0} if one is given."""
    if count < 0 or not pool:
        raise Unfit("Count must not be negative, and the pool not empty")
    bounded(count)
    found = []
    for i in range(count):
        tag, number = "", i + 1
        while number > 0:
            number, digit = divmod(number - 1, len(pool))
            tag = pool[digit] + tag
        found.append(form.replace("{0}", tag) if form else tag)
    return found


@native("e9b2d2a6-0377-4c1c-a89e-b3f219a95b4d", "Sequence", "Seq",
        "Notation (N): text = 'Pr'; Length (L): integer = 10; Initial (I): number list",
        "Sequence (S): list")  # fmt: skip
def sequence(notation: str, length: int, initial: list[float]) -> list[float]:
    """Numbers each of which is an expression of those before: Pr or {n-1} the last one, {n-2} the one before, N its
    number, S the sum of all."""
    bounded(length)
    found = list(initial[:length])
    text = notation
    for k in range(20, 0, -1):
        text = text.replace(f"{{n-{k}}}", f"before{k}").replace(f"{{N-{k}}}", f"before{k}")
    if "{" in text:
        raise Unfit("the notation has braces other than {n-1} to {n-20}")
    while len(found) < length:
        values: dict[str, Any] = {f"before{k}": found[-k] for k in range(1, min(len(found), 20) + 1)}
        values |= {"N": float(len(found)), "n": float(len(found)), "S": math.fsum(found)}
        if found:
            values |= {"Pr": found[-1], "pr": found[-1]}
        found.append(float(evaluated(text, values)))
    return found
