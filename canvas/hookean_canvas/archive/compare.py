"""Two archives, item by item; and an archive in the other form, XML or binary, with all that is in it."""

from __future__ import annotations

from decimal import Decimal
from itertools import zip_longest
from pathlib import Path
from typing import Any

from hookean.errors import InputError
from hookean_canvas import archive
from hookean_canvas.archive.chunk import Chunk, Item, labelled, placed, sort_key


def convert(source: Path, target: Path) -> Chunk:
    """Write the archive in a file to another one: XML to .ghx, binary to .gh and .ghuser; all chunks and items stay.

    Returns it. InputError where the source cannot be read, the target is the source or has another suffix, or a value
    has no form in XML.
    """
    if target.resolve() == source.resolve():
        raise InputError(str(target), "is the input file; give another name")
    root = archive.read(source)
    archive.write(root, target)
    return root


def difference(one: Chunk, other: Chunk) -> str | None:
    """The first place where two archives differ, and how; None where they are the same.

    Items go by name and index, chunks by their order; numbers are compared to the last bit.
    """
    waiting: list[tuple[Chunk, Chunk, tuple[str, ...]]] = [(one, other, (one.label,))]
    while waiting:
        first, second, place = waiting.pop()
        if (first.name, first.index) != (second.name, second.index):
            return f"{placed(place)}: {first.label} in the first, {second.label} in the second"
        found = _items(first, second)
        if found:
            return f"{placed(place)}/{found}"
        if len(first.chunks) != len(second.chunks):
            return f"{placed(place)}: {len(first.chunks)} chunks in the first, {len(second.chunks)} in the second"
        pairs = zip(first.chunks, second.chunks, strict=True)
        waiting += [(a, b, (*place, a.label)) for a, b in reversed(list(pairs))]
    return None


def _items(one: Chunk, other: Chunk) -> str | None:
    for first, second in zip_longest(*(sorted(chunk.items, key=sort_key) for chunk in (one, other))):
        item = first or second
        label = labelled(item.name, item.index)
        if first is None or second is None or (first.name, first.index) != (second.name, second.index):
            least = min((i for i in (first, second) if i is not None), key=sort_key)
            side = "second" if least is first else "first"
            return f"{labelled(least.name, least.index)}: missing in the {side}"
        if first.type != second.type:
            return f"{label}: {first.type.label} in the first, {second.type.label} in the second"
        if not _same(first.value, second.value):
            return f"{label}: {_told(first)} in the first, {_told(second)} in the second"
    return None


def _same(one: Any, other: Any) -> bool:
    """Whether values are the same; of numbers the sign of 0, too, and any one that is not a number is like another."""
    if isinstance(one, (tuple, list)) and isinstance(other, (tuple, list)):
        return len(one) == len(other) and all(map(_same, one, other))
    as_text = isinstance(one, (float, Decimal))
    return type(one) is type(other) and (repr(one) == repr(other) if as_text else bool(one == other))


def _told(item: Item) -> str:
    text = f"{len(item.value)} bytes" if isinstance(item.value, bytes) else repr(item.value)
    return text if len(text) <= 60 else text[:57] + "..."
