"""What a Grasshopper archive is made of: chunks that hold typed items and further chunks.

Layout and type codes: GH_IO, archive version 0.2.2.
"""

from __future__ import annotations

import bisect
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from enum import IntEnum
from typing import Any

from hookean.errors import InputError

MOST_BYTES = 256 * 2**20  # an archive's size once unpacked
MOST_PARTS = 3_000_000  # items and chunks of an archive, together
DEEPEST = 200  # chunks within chunks
CLUSTERS = 20  # clusters within clusters that are looked into


class Type(IntEnum):
    """The type code of an item; what its value is in Python stands beside it."""

    BOOL = 1  # bool
    BYTE = 2  # int, 0 to 255
    INT32 = 3  # int
    INT64 = 4  # int
    SINGLE = 5  # float
    DOUBLE = 6  # float
    DECIMAL = 7  # decimal.Decimal, at most 96 bits and 28 decimals
    DATE = 8  # int, ticks of 100 ns since year 1, with .NET's two bits for the kind of date
    GUID = 9  # uuid.UUID
    STRING = 10  # str
    BYTEARRAY = 20  # bytes
    DOUBLEARRAY = 21  # tuple of float
    DRAWING_POINT = 30  # (x, y) int, pixels of the canvas
    DRAWING_POINTF = 31  # (x, y) float
    DRAWING_SIZE = 32  # (width, height) int
    DRAWING_SIZEF = 33  # (width, height) float
    DRAWING_RECTANGLE = 34  # (x, y, width, height) int
    DRAWING_RECTANGLEF = 35  # (x, y, width, height) float
    DRAWING_COLOR = 36  # (alpha, red, green, blue) int, 0 to 255
    DRAWING_BITMAP = 37  # bytes of a PNG file
    POINT2D = 50  # (x, y) float
    POINT3D = 51  # (x, y, z)
    POINT4D = 52  # (x, y, z, w)
    INTERVAL1D = 60  # (a, b)
    INTERVAL2D = 61  # (a of u, b of u, a of v, b of v)
    LINE = 70  # (x, y, z) of the start, then of the end
    BOUNDINGBOX = 71  # (x, y, z) of the minimum, then of the maximum
    PLANE = 72  # (x, y, z) of the origin, of the x axis and of the y axis
    VERSION = 80  # (major, minor, revision) int

    @property
    def label(self) -> str:
        """The name an XML archive gives the type, such as `gh_int32`."""
        return "gh_" + self.name.lower()


@dataclass(slots=True)
class Item:
    """A typed value under a name; `index` is -1 where the name stands alone. `Type` has the allowed values."""

    name: str
    index: int
    type: Type
    value: Any


@dataclass(slots=True)
class Chunk:
    """A named group of items and chunks; items are unique by name and index, chunks keep their order."""

    name: str
    index: int = -1
    items: list[Item] = field(default_factory=list)
    chunks: list[Chunk] = field(default_factory=list)

    @property
    def label(self) -> str:
        """The name with its index, as a person would write it: `Object[3]`."""
        return labelled(self.name, self.index)

    def item(self, name: str, index: int = -1) -> Item | None:
        """The item of that name and index, or None."""
        return next((item for item in self.items if item.name == name and item.index == index), None)

    def value(self, name: str, index: int = -1, default: Any = None) -> Any:
        """The value of an item, or `default` where there is no such item."""
        item = self.item(name, index)
        return default if item is None else item.value

    def put(self, name: str, type: Type, value: Any, index: int = -1) -> Chunk:
        """Set an item, in its sorted place; one of the same name and index is replaced. Returns the chunk itself."""
        found = self.item(name, index)
        if found is None:
            bisect.insort(self.items, Item(name, index, type, value), key=sort_key)
        else:
            found.type, found.value = type, value
        return self

    def chunk(self, name: str, index: int = -1) -> Chunk | None:
        """The first chunk of that name and index directly in this one, or None."""
        return next((chunk for chunk in self.chunks if chunk.name == name and chunk.index == index), None)

    def add(self, name: str, index: int = -1) -> Chunk:
        """Append an empty chunk and return it; ValueError where one of that name and index is there."""
        if self.chunk(name, index) is not None:
            raise ValueError(f"{self.label} already has a chunk {labelled(name, index)}")
        self.chunks.append(Chunk(name, index))
        return self.chunks[-1]

    def walk(self) -> Iterator[Chunk]:
        """This chunk and all in it, each before what it holds."""
        waiting = [self]
        while waiting:
            chunk = waiting.pop()
            yield chunk
            waiting.extend(reversed(chunk.chunks))


def labelled(name: str, index: int) -> str:
    """`name` with its index, where it has one."""
    return name if index == -1 else f"{name}[{index}]"


def placed(place: tuple[str, ...]) -> str:
    """A path of labels as an error names it: long names cut, and what cannot be printed left out."""
    cut = (label if len(label) <= 60 else label[:57] + "..." for label in place)
    return "".join(letter if letter.isprintable() else "?" for letter in "/".join(cut)) or "the start"


def twin(items: Iterable[Item]) -> Item | None:
    """The first item whose name and index an earlier one has, or None."""
    seen = set()
    for item in items:
        if (item.name, item.index) in seen:
            return item
        seen.add((item.name, item.index))
    return None


def in_order(chunk: Chunk, place: tuple[str, ...]) -> list[Item]:
    """The items as an archive holds them: sorted; InputError where one stands twice."""
    again = twin(chunk.items)
    if again is not None:
        where = placed((*place, labelled(again.name, again.index)))
        raise InputError(where, "occurs twice in its chunk; name and index together must be unique.")
    return sorted(chunk.items, key=sort_key)


def sort_key(item: Item) -> tuple[bytes, int]:
    """The order of items in an archive: by name in UTF-16 code units (.NET's ordinal order), then by index."""
    return item.name.encode("utf-16-be", "surrogatepass"), item.index
