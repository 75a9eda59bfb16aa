"""Natives of the tab Sets: lists and sequences."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from itertools import cycle, islice, pairwise, product
from typing import Any

import numpy as np

from hookean_canvas.run.natives.declare import Unfit, bounded, native

_ANY = "List (L): any list"
Values = list[Any]


def _place(index: int, count: int, wrap: bool) -> int | None:
    """An index within a list, wrapped to its bounds where that is asked for; None outside."""
    if not count or not wrap and not 0 <= index < count:
        return None
    return index % count


def _repeated(pattern: Sequence[Any], count: int) -> Iterable[Any]:
    """A pattern repeated to a length."""
    return islice(cycle(pattern), count)


@native("e64c5fb1-845c-4ab1-8911-5f338516ba67", "Series", "Series",
        "Start (S): number = 0.0; Step (N): number = 1.0; Count (C): integer = 10", "Series (S): list")  # fmt: skip
def series(start: float, step: float, count: int) -> Values:
    """Count numbers, the first is Start, each next one larger by Step; a list for each run."""
    if count < 0:
        raise Unfit("Count must not be negative")
    bounded(count)
    return [start + step * i for i in range(count)]


@native("9445ca40-cc73-4861-a455-146308676855", "Range", "Range",
        "Domain (D): domain; Steps (N): integer = 10", "Range (R): list")  # fmt: skip
def steps(domain: Any, count: int) -> Values:
    """Numbers at equal steps over a domain, both ends included: one more than steps."""
    if count < 1:
        raise Unfit("Steps must be at least 1")
    bounded(count)
    return [domain.T0 + (domain.T1 - domain.T0) * i / count for i in range(count + 1)]


@native("1817fd29-20ae-4503-b542-f0fb651e67d7", "List Length", "Lng", _ANY, "Length (L)")
def list_length(values: Values) -> int:
    """How many items a list has."""
    return len(values)


@native("59daf374-bc21-4a5e-8282-5504fb7ae9ae", "List Item", "Item",
        f"{_ANY}; Index (i): integer = 0; Wrap (W): boolean = True", "Item (i) ...", sees=True)  # fmt: skip
def list_item(values: Values, index: int, wrap: bool, node: Any) -> tuple[Any, ...]:
    """The item at an index; further outputs are those before and after it, as their names count. Null outside."""
    places = [_place(index + offset, len(values), wrap) for offset in _offsets(node.outputs)]
    return tuple(None if place is None else values[place] for place in places)


def _offsets(ports: Sequence[Any]) -> list[int]:
    """Offsets that the names of outputs state, such as i, +1, -2; by their order where a name states none."""
    found = []
    for number, port in enumerate(ports):
        sign = next((text for text in (port.nickname, port.name) if text.strip()[:1] in tuple("+-")), "")
        digits = sign.strip()[1:].split(" ")[0]
        found.append(int(sign.strip()[0] + digits) if digits.isdigit() else number)
    return found


@native("6f93d366-919f-4dda-a35e-ba03dd62799b", "Sort List", "Sort",
        "Keys (K): number list; Values A (A): any list optional ...", 
        "Keys (K): list; Values A (A): list ...")  # fmt: skip
def sort_list(keys: list[float], *lists: Values | None) -> tuple[Values, ...]:
    """Keys in ascending order, and lists in the order of their keys; equal keys keep their order."""
    order = sorted(range(len(keys)), key=lambda i: (keys[i] is None, keys[i] or 0.0))
    return tuple([values[i] for i in order if i < len(values)] for values in (keys, *(one or [] for one in lists)))


@native("6ec97ea8-c559-47a2-8d0f-ce80c794d1f4", "Reverse List", "Rev", _ANY, "List (L): list")
def reverse_list(values: Values) -> Values:
    """A list in the other direction."""
    return values[::-1]


@native("4fdfe351-6c07-47ce-9fb9-be027fb62186", "Shift List", "Shift",
        f"{_ANY}; Shift (S): integer = 1; Wrap (W): boolean = True", "List (L): list")  # fmt: skip
def shift_list(values: Values, shift: int, wrap: bool) -> Values:
    """All items offset: with Wrap those that leave at one end enter at the other, without they are left out."""
    if wrap:
        count = len(values) or 1
        return values[shift % count :] + values[: shift % count]
    return values[shift:] if shift >= 0 else values[:shift]


@native("501aecbb-c191-4d13-83d6-7ee32445ac50", "Cull Index", "Cull i",
        f"{_ANY}; Indices (I): integer list = 0; Wrap (W): boolean = True", "List (L): list")  # fmt: skip
def cull_index(values: Values, indices: list[int], wrap: bool) -> Values:
    """A list without the items at some indices."""
    gone = {_place(i, len(values), wrap) for i in indices if i is not None}
    return [value for i, value in enumerate(values) if i not in gone]


@native("932b9817-fcc6-4ac3-b5fd-c0e8eeadc53f", "Cull Nth", "CullN",
        f"{_ANY}; Cull frequency (N): integer = 2", "List (L): list")  # fmt: skip
def cull_nth(values: Values, frequency: int) -> Values:
    """A list without every Nth item."""
    if frequency < 1:
        raise Unfit("Cull frequency must be at least 1")
    return [value for i, value in enumerate(values) if (i + 1) % frequency]


@native("008e9a6f-478a-4813-8c8a-546273bc3a6b", "Cull Pattern", "Cull",
        f"{_ANY}; Cull Pattern (P): boolean list", "List (L): list")  # fmt: skip
def cull_pattern(values: Values, pattern: list[bool]) -> Values:
    """The items at which a repeated pattern is True."""
    return _dispatched(values, pattern)[0]


@native("d8332545-21b2-4716-96e3-8559a9876e17", "Dispatch", "Dispatch",
        f"{_ANY}; Dispatch pattern (P): boolean list", "List A (A): list; List B (B): list")  # fmt: skip
def dispatch(values: Values, pattern: list[bool]) -> tuple[Values, Values]:
    """The items at which a repeated pattern is True, and those at which it is False."""
    return _dispatched(values, pattern)


def _dispatched(values: Values, pattern: list[bool]) -> tuple[Values, Values]:
    if not pattern:
        raise Unfit("the pattern is empty")
    pairs = list(zip(values, _repeated(pattern, len(values)), strict=True))
    return [value for value, on in pairs if on], [value for value, on in pairs if not on]


@native("9ab93e1a-ebdf-4090-9296-b000cff7b202", "Split List", "Split",
        f"{_ANY}; Index (i): integer = 0", "List A (A): list; List B (B): list")  # fmt: skip
def split_list(values: Values, index: int) -> tuple[Values, Values]:
    """The items before an index, and those from it on."""
    at = max(index, 0)
    return values[:at], values[at:]


@native("b333ff42-93bd-406b-8e17-15780719b6ec", "Sub List", "SubSet",
        f"{_ANY}; Domain (D): domain; Wrap (W): boolean = True", "List (L): list; Index (I): list")  # fmt: skip
def sub_list(values: Values, domain: Any, wrap: bool) -> tuple[Values, list[int]]:
    """The items at the whole numbers of a domain, both ends included, and their indices."""
    first, last = math.floor(domain.T0 + 0.5), math.floor(domain.T1 + 0.5)
    bounded(abs(last - first))
    run = range(first, last + 1) if first <= last else range(first, last - 1, -1)
    places = [place for place in (_place(i, len(values), wrap) for i in run) if place is not None]
    return [values[i] for i in places], places


@native("50faccbd-9c92-4175-a5fa-d65e36013db6", "Weave", "Weave",
        "Pattern (P): integer list; Stream (0): any list optional ...", "Weave (W): list")  # fmt: skip
def weave(pattern: list[int], *streams: Values | None) -> Values:
    """Items of the streams in turn, as a repeated pattern of their numbers states; ended streams are skipped."""
    rest = [list(stream or []) for stream in streams]
    found: Values = []
    while any(rest[i] for i in pattern if i is not None and 0 <= i < len(rest)):
        for i in pattern:
            if i is not None and 0 <= i < len(rest) and rest[i]:
                found.append(rest[i].pop(0))
    return found


@native("5a93246d-2595-4c28-bc2d-90657634f92a", "Partition List", "Partition",
        f"{_ANY}; Size (S): integer list = 10", "Chunks (C): branches")  # fmt: skip
def partition_list(values: Values, sizes: list[int]) -> list[Values]:
    """Sublists of a repeated pattern of sizes, each in a branch of its own; the last has what remains."""
    if not sizes or min(sizes) < 1:
        raise Unfit("Size must be at least 1")
    found, at = [], 0
    for size in cycle(sizes):
        if at >= len(values):
            break
        found.append(values[at : at + size])
        at += size
    return found


@native("dd8134c0-109b-4012-92be-51d843edfff7", "Duplicate Data", "Dup",
        "Data (D): any list; Number (N): integer = 2; Order (O): boolean = True", "Data (D): list")  # fmt: skip
def duplicate_data(values: Values, number: int, order: bool) -> Values:
    """The list a number of times: whole lists after each other, or without Order each item as often in its place."""
    bounded(len(values) * number)
    return values * max(number, 0) if order else [value for value in values for _ in range(number)]


@native("c40dc145-9e36-4a69-ac1a-6d825c654993", "Repeat Data", "Repeat",
        "Data (D): any list; Length (L): integer", "Data (D): list")  # fmt: skip
def repeat_data(values: Values, length: int) -> Values:
    """A pattern repeated up to a length."""
    bounded(length)
    return list(_repeated(values, max(length, 0)))


@native("5fa4e736-0d82-4af0-97fb-30a79f4cbf41", "Stack Data", "Stack",
        "Data (D): any list; Stack (S): integer list", "Data (D): list")  # fmt: skip
def stack_data(values: Values, pattern: list[int]) -> Values:
    """Each item as often as a repeated pattern states."""
    counts = list(_repeated(pattern, len(values)))
    bounded(sum(max(count, 0) for count in counts))
    return [value for value, count in zip(values, counts, strict=True) for _ in range(count)]


@native("e2039b07-d3f3-40f8-af88-d74fed238727", "Insert Items", "Ins",
        f"{_ANY}; Item (I): any list optional; Indices (i): integer list; Wrap (W): boolean = False",
        "List (L): list")  # fmt: skip
def insert_items(values: Values, items: Values | None, indices: list[int], wrap: bool) -> Values:
    """A list with items inserted, one after the other at its index; the last item repeats, nulls without items."""
    found = list(values)
    given = items or [None]
    for number, index in enumerate(indices):
        at = index % (len(found) + 1) if wrap else index
        if not 0 <= at <= len(found):
            raise Unfit(f"Insertion index {index} is outside a list of {len(found)} items")
        found.insert(at, given[min(number, len(given) - 1)])
    return found


@native("7a218bfb-b93d-4c1f-83d3-5a0b909dd60b", "Replace Items", "Replace",
        f"{_ANY}; Item (I): any list optional; Indices (i): integer list; Wrap (W): boolean = False",
        "List (L): list")  # fmt: skip
def replace_items(values: Values, items: Values | None, indices: list[int], wrap: bool) -> Values:
    """A list with the items at some indices replaced; the last item repeats, nulls without items."""
    found = list(values)
    given = items or [None]
    for number, index in enumerate(indices):
        place = _place(index, len(found), wrap)
        if place is None:
            raise Unfit(f"Replacement index {index} is outside a list of {len(found)} items")
        found[place] = given[min(number, len(given) - 1)]
    return found


@native("c74efd0e-7fe3-4c2d-8c9d-295c5672fb13", "Null Item", "Null",
        "Item (I): any optional", "Null Flags (N); Invalid Flags (X); Description (D)")  # fmt: skip
def null_item(value: Any) -> tuple[bool, bool, str]:
    """Whether an item is null, whether it is invalid geometry, and which of these in words."""
    null, odd = value is None, getattr(value, "IsValid", True) is False
    return null, odd, "Null" if null else "Invalid" if odd else "Valid"


@native("f3230ecb-3631-4d6f-86f2-ef4b2ed37f45", "Replace Nulls", "NullRep",
        "Items (I): any list; Replacements (R): any list", "Items (I): list; Count (N)")  # fmt: skip
def replace_nulls(values: Values, others: Values) -> tuple[Values, int]:
    """A list with each null replaced by the replacement at its place; the last one repeats."""
    if not others:
        raise Unfit("there are no replacements")
    pairs = zip(values, (others[min(i, len(others) - 1)] for i in range(len(values))), strict=True)
    return [other if value is None else value for value, other in pairs], sum(value is None for value in values)


@native("a759fd55-e6be-4673-8365-c28d5b52c6c0", "Item Index", "Index", f"{_ANY}; Item (i): any", "Index (i)")
def item_index(values: Values, wanted: Any) -> int:
    """The index of the first item equal to another, -1 where there is none."""
    return next((i for i, value in enumerate(values) if same(value, wanted)), -1)


@native("3ff27857-b988-417a-b495-b24c733dbd00", "Member Index", "MIndex",
        "Set (S): any list; Member (M): any", "Index (I): list; Count (N)")  # fmt: skip
def member_index(values: Values, wanted: Any) -> tuple[list[int], int]:
    """The indices of all items equal to another, and how many they are."""
    found = [i for i, value in enumerate(values) if same(value, wanted)]
    return found, len(found)


@native("98c3c63a-e78a-43ea-a111-514fcf312c95", "Create Set", "CSet", _ANY, "Set (S): list; Map (M): list")
def create_set(values: Values) -> tuple[Values, list[int]]:
    """The different items of a list in their order, and for each item of the list its place among them."""
    found: Values = []
    places = []
    for value in values:
        place = next((i for i, known in enumerate(found) if same(known, value)), len(found))
        if place == len(found):
            found.append(value)
        places.append(place)
    return found, places


def same(a: Any, b: Any) -> bool:
    """Whether two items are equal: numbers and text by value, points and vectors by coordinates, others as objects."""
    if hasattr(a, "Z") and hasattr(b, "Z"):
        return bool(np.array_equal([a.X, a.Y, a.Z], [b.X, b.Y, b.Z]))
    plain = (bool, int, float, str, tuple)
    return bool(a == b) if isinstance(a, plain) and isinstance(b, plain) else a is b


@native("8440fd1b-b6e0-4bdb-aa93-4ec295c213e9", "Longest List", "Long",
        "List (A): any list; List (B): any list ...", "List (A): list; List (B): list ...")  # fmt: skip
def longest_list(*lists: Values) -> tuple[Values, ...]:
    """Lists grown to the length of the longest one; the last item repeats."""
    count = max(map(len, lists))
    return tuple(values + values[-1:] * (count - len(values)) for values in lists)


@native("5a13ec19-e4e9-43da-bf65-f93025fa87ca", "Shortest List", "Short",
        "List (A): any list; List (B): any list ...", "List (A): list; List (B): list ...")  # fmt: skip
def shortest_list(*lists: Values) -> tuple[Values, ...]:
    """Lists cut to the length of the shortest one."""
    return tuple(values[: min(map(len, lists))] for values in lists)


CROSSED: tuple[Callable[[tuple[int, ...]], bool], ...] = (
    lambda places: True,
    lambda places: len(set(places)) > 1,
    lambda places: len(set(places)) == len(places),
    lambda places: all(i >= j for i, j in pairwise(places)),
    lambda places: all(i <= j for i, j in pairwise(places)),
    lambda places: all(i > j for i, j in pairwise(places)),
    lambda places: all(i < j for i, j in pairwise(places)),
)
"""Which combinations a Cross Reference gives, by the numbers of their items in the lists: all, without those of equal
numbers, without those with any two equal, the lower and the upper triangle, and both without their diagonals."""


@native("36947590-f0cb-4807-a8f9-9c90c9b20621", "Cross Reference", "CrossRef",
        "List (A): any list; List (B): any list ...", "List (A): list; List (B): list ...", sees=True)  # fmt: skip
def cross_reference(*lists: Values, node: Any = None) -> tuple[Values, ...]:
    """Combinations of the items of lists, the last list in full for each item of those before; all, or those of the
    mode that is chosen in its menu."""
    bounded(math.prod(map(len, lists)))
    mode = node.container.value("CrossMode", default=0) if node is not None else 0
    if not 0 <= mode < len(CROSSED):
        raise Unfit(f"unknown mode {mode}; 0 to {len(CROSSED) - 1} are known")
    kept = CROSSED[mode]
    chosen = [places for places in product(*(range(len(values)) for values in lists)) if kept(places)]
    return tuple([values[places[i]] for places in chosen] for i, values in enumerate(lists))
