"""The checksums of a .3dm file's chunks, read past by rhino3dm: one wrong bit in a coordinate is noticed.

A chunk whose typecode has the bit 0x8000 ends with the CRC-32 of the bytes that are its own: chunks inside it, heads
included, are left out. Where they begin depends on the class that wrote them, so they are located by typecode and
length: those that openNURBS nests and, in user data, where plug-ins use typecodes of their own, whatever has a checksum
that holds. Source of the typecodes: openNURBS, `opennurbs_3dm.h`.
"""

from __future__ import annotations

import re
import struct
import zlib

_CHECKED = 0x8000
_SHORT = 0x80000000
_CLASS = 0x00027FFA
_ATTACHED = 0x02000073  # user data of an object's attributes
_HEAD, _UNNAMED = 0x0002FFF9, 0x40008000
_ID, _DATA, _USER_DATA, _CLASS_END = 0x0002FFFB, 0x0002FFFC, 0x00027FFD, 0x80027FFF
# of a class, its user data, their heads, its id, its data; a buffer; chunks without a name, text, attributes of a
# component, dictionaries; the parts of a view; histories: their bytes in order
_KNOWN = re.compile(rb"[\0-\x02\x10-\x12\x3b\x4b\x75\x76\xf9-\xfd][\x7f-\x8d\xff](?:\x02\0|\0[\x02\x20\x40])")
_ANY = re.compile(rb"[\0-\xff][\x7f-\xff](?:[\x02\x10\x20\x40\x80]\0|\0[\x02\x20\x40])")  # one bit of a category
_UNCHECKED = (_CLASS, _USER_DATA)  # those that nest without a checksum
# heads without a body, in a row of chunks: of a class, a view, a dictionary; the last ends a view
_SHORTS = re.compile(rb"\xff\x7f\x02\x80|\x3b[\x03-\x05\x09]\0\xa0|\x13\0\0\xc0|\xff{4}\0{4}")
_DEEPEST = 24
_MOST = 32, 2**26  # times the size of the file, and more, are read again and again; then the rest is taken as it is
_SEARCH = 4  # times as long a search takes as a sum

Span = tuple[int, int]
Heads = re.Pattern[bytes]


class Checksums:
    """Of the bytes `data` with length fields of `size` bytes. Any bytes are safe; the time is linear."""

    def __init__(self, data: bytes, size: int) -> None:
        self.data, self.view = data, memoryview(data)
        self.head = struct.Struct("<Iq" if size == 8 else "<Ii")
        self.left = _MOST[0] * len(data) + _MOST[1]
        self.known: dict[tuple[int, int], bool] = {}  # of chunks, by where their bodies are

    def hold(self, typecode: int, body: int, end: int) -> bool:
        """Whether a chunk and all inside it are as they were written, as far as they have checksums."""
        return self._holds(typecode, body, end, 0, _KNOWN) or self.left <= 0

    def _holds(self, typecode: int, body: int, end: int, depth: int, heads: Heads) -> bool:
        if typecode & _SHORT:
            return True
        if depth > _DEEPEST or self.left <= 0:
            return False
        if (body, end) not in self.known:
            self.known[body, end] = self._whole(typecode, body, end, depth, heads)
        return self.known[body, end]

    def _whole(self, typecode: int, body: int, end: int, depth: int, heads: Heads) -> bool:
        if typecode in (_CLASS, _ATTACHED):
            return self._row(typecode, body, end, depth, heads)
        if typecode == _USER_DATA and body < end and self.data[body] >> 4 != 1:  # 1: its head is not a chunk
            return self._row(typecode, body + 1, end, depth, _ANY)
        return self._own(body, end, typecode & _CHECKED, depth, heads)

    def _row(self, typecode: int, body: int, end: int, depth: int, heads: Heads) -> bool:
        """Chunks only: a class has its id, its data and an end; user data have a head and a chunk without a name."""
        found = []
        while body < end:
            inner = self._chunk(body, end)
            if inner is None or not self._holds(*inner, depth + 1, heads):
                return False
            found.append(inner[0])
            body = inner[2]
        if typecode == _ATTACHED:
            return set(found) <= {_USER_DATA, _CLASS_END}
        if typecode == _USER_DATA:
            return found == [_HEAD, _UNNAMED]
        return found[:1] == [_ID] and found[-1:] == [_CLASS_END] and set(found[1:-1]) <= {_DATA, _USER_DATA}

    def _own(self, body: int, end: int, checked: int, depth: int, heads: Heads) -> bool:
        """A chunk of bytes of its own and chunks, in any order."""
        if not checked:
            return all(good for _, good in self._nested(heads, body, end, depth))
        stop = end - 4
        if stop < body:
            return False
        stated = int.from_bytes(self.data[stop:end], "little")
        if self._sum(body, stop, []) == stated:
            return True  # nothing nested in it
        spans = [span for span, good in self._nested(heads, body, stop, depth) if good]
        # minus one behind a chunk is the end of a row, or a number
        return stated in (self._sum(body, stop, spans), self._sum(body, stop, self._ended(spans, stop)))

    def _nested(self, heads: Heads, body: int, stop: int, depth: int) -> list[tuple[Span, bool]]:
        """What may be chunks between two places, and whether each holds; one that does not may be bytes."""
        found, look = [], body
        self.left -= _SEARCH * (stop - body)
        while (match := heads.search(self.data, look, stop)) is not None:
            look = match.start() + 1
            inner = self._chunk(match.start(), stop)
            if inner is not None and inner[1] < inner[2] and (inner[0] & _CHECKED or inner[0] in _UNCHECKED):
                good = self._holds(*inner, depth + 1, heads)
                found.append(((match.start(), inner[2]), good))
                look = inner[2] if good else look
        return found

    def _ended(self, spans: list[Span], stop: int) -> list[Span]:
        """Chunks with the heads of short ones that follow them."""
        found = []
        for start, end in spans:
            while end + self.head.size <= stop and _SHORTS.match(self.data, end, stop):
                end += self.head.size
            found.append((start, end))
        return found

    def _sum(self, body: int, stop: int, without: list[Span]) -> int:
        """The CRC-32 of the bytes between two places that are not in these spans."""
        found, position = 0, body
        for start, end in (*without, (stop, stop)):
            found = zlib.crc32(self.view[position:start], found)
            position = end
        self.left -= stop - body
        return found

    def _chunk(self, start: int, end: int) -> tuple[int, int, int] | None:
        """Typecode, body and end of the chunk that begins at `start`; None if there is no room for one."""
        body = start + self.head.size
        if body > end:
            return None
        typecode, value = self.head.unpack_from(self.data, start)
        after = body if typecode & _SHORT else body + value
        return (typecode, body, after) if body <= after <= end else None
