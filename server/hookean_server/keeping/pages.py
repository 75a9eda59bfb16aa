"""Rows of a store read from its bytes alone, where SQLite refuses the file or stops at what is damaged.

Every page of the database and every frame of its write-ahead log that looks like a leaf of a table is taken apart; rows
count only where their checksum holds, so nothing that was damaged, and nothing that never was a row, comes through.
Formats: https://www.sqlite.org/fileformat2.html, sections 1.6 (b-tree pages), 2.1 (records) and 4 (the log).
"""

from __future__ import annotations

import mmap
import struct
from bisect import bisect_right
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from hookean_server.keeping.schema import PAGE, TABLES, Table

LEAF = 0x0D
HEADER, FRAME = 32, 24  # bytes before the frames of a log, and before the page of each
INLINE = PAGE - 35  # bytes of a row that fit into its leaf
LEAST = (PAGE - 12) * 32 // 255 - 23
INTEGERS = {1: 1, 2: 2, 3: 3, 4: 4, 5: 6, 6: 8}
WIDTHS: dict[int, list[Table]] = {}
for _table in TABLES.values():
    WIDTHS.setdefault(len(_table.columns), []).append(_table)

Row = tuple[str, tuple[Any, ...]]
"""The name of a table and a row of it, in the order of its columns."""


class Damaged(Exception):
    """Bytes that are not what they should be."""


def rows(path: Path | None, log: Path | None) -> Iterator[Row]:
    """All versions of all rows that are whole in a database and its log, each once; either may be missing."""
    with _bytes(path) as data, _bytes(log) as frames:
        yield from Pages(data, frames).rows()


@contextmanager
def _bytes(path: Path | None) -> Iterator[Any]:
    if path is None or not path.exists() or not path.stat().st_size:
        yield b""
        return
    with path.open("rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data:
        yield data


class Pages:
    """The pages of a database, and those in its log."""

    def __init__(self, data: Any, log: Any) -> None:
        self.data, self.log = data, log
        self.frames = range(max(0, (len(log) - HEADER) // (FRAME + PAGE)))
        self.versions: dict[int, list[int]] = {}
        self.ends: list[int] = []  # frames that end a transaction
        for frame in self.frames:
            number, size = struct.unpack_from(">II", log, HEADER + frame * (FRAME + PAGE))
            self.versions.setdefault(number, []).append(frame)
            if size:
                self.ends.append(frame)
        self.seen: set[bytes] = set()

    def rows(self) -> Iterator[Row]:
        """All rows that are whole."""
        for start in range(0, len(self.data), PAGE):
            yield from self._leaf(self.data[start : start + PAGE], 100 if start == 0 else 0, -1)
        for frame in self.frames:
            start = HEADER + frame * (FRAME + PAGE) + FRAME
            page = self.log[start : start + PAGE]
            yield from self._leaf(page, 100 if page.startswith(b"SQLite format 3") else 0, frame)

    def _leaf(self, page: bytes, start: int, frame: int) -> Iterator[Row]:
        if len(page) <= start or page[start] != LEAF:
            return
        count = min(int.from_bytes(page[start + 3 : start + 5], "big"), PAGE // 4)
        for cell in range(count):
            place = int.from_bytes(page[start + 8 + 2 * cell : start + 10 + 2 * cell], "big")
            try:
                found = self._cell(page, place, frame)
            except (Damaged, IndexError, struct.error, UnicodeDecodeError, OverflowError):
                continue
            if found is not None:
                yield found

    def _cell(self, page: bytes, place: int, frame: int) -> Row | None:
        size, place = _varint(page, place)
        _, place = _varint(page, place)
        local = size if size <= INLINE else LEAST + (size - LEAST) % (PAGE - 4)
        if local > INLINE:
            local = LEAST
        head = page[place : place + local]
        kinds, begin = _kinds(head)
        for table in WIDTHS.get(len(kinds), ()):
            known = _values(head, kinds[: len(table.key) + 1], begin)
            if known is None or not isinstance(known[-1], bytes) or known[-1] in self.seen:
                continue
            for snapshot in self._snapshots(frame) if local < size else (-1,):
                row = self._whole(table, page, place, local, size, snapshot)
                if row is not None:
                    self.seen.add(known[-1])
                    return table.name, row
        return None

    def _whole(
        self, table: Table, page: bytes, place: int, local: int, size: int, snapshot: int
    ) -> tuple[Any, ...] | None:
        data = page[place : place + local]
        if local < size:
            first = int.from_bytes(page[place + local : place + local + 4], "big")
            data += self._chain(first, size - local, snapshot)
        kinds, begin = _kinds(data)
        try:
            row = _values(data, kinds, begin)
        except UnicodeDecodeError:
            return None
        return row if row is not None and table.whole(row) else None

    def _snapshots(self, frame: int) -> Iterator[int]:
        """The last frames of the moments in which a page of this frame (-1: of the database) may have been read: at
        the end of its transaction, now, and before all of the log."""
        if frame >= 0:
            later = bisect_right(self.ends, frame - 1)
            yield self.ends[later] if later < len(self.ends) else len(self.frames) - 1
        yield len(self.frames) - 1
        yield -1

    def _chain(self, number: int, size: int, snapshot: int) -> bytes:
        """The bytes of a row that are on pages of their own."""
        parts, left = [], size
        while left > 0:
            page = self._page(number, snapshot)
            if len(page) < PAGE or not number:
                return b""
            parts.append(page[4 : 4 + left])
            left -= PAGE - 4
            number = int.from_bytes(page[:4], "big")
        return b"".join(parts)

    def _page(self, number: int, snapshot: int) -> bytes:
        frames = self.versions.get(number, [])
        later = bisect_right(frames, snapshot)
        if later:
            start = HEADER + frames[later - 1] * (FRAME + PAGE) + FRAME
            return bytes(self.log[start : start + PAGE])
        return bytes(self.data[(number - 1) * PAGE : number * PAGE])


def _varint(data: bytes, place: int) -> tuple[int, int]:
    value = 0
    for i in range(9):
        byte = data[place + i]
        if i == 8:
            return value << 8 | byte, place + 9
        value = value << 7 | byte & 0x7F
        if byte < 0x80:
            return value, place + i + 1
    raise Damaged


def _kinds(data: bytes) -> tuple[list[int], int]:
    """The types of the values of a record, and where these begin."""
    end, place = _varint(data, 0)
    if end > min(len(data), 200):
        raise Damaged
    kinds = []
    while place < end:
        kind, place = _varint(data, place)
        kinds.append(kind)
    return kinds, end


def _values(data: bytes, kinds: list[int], place: int) -> tuple[Any, ...] | None:
    """The values of a record; None where it is too short for them."""
    found: list[Any] = []
    for kind in kinds:
        size = INTEGERS.get(kind, 8 if kind == 7 else max(0, kind - 12) // 2)
        part = data[place : place + size]
        if len(part) < size or kind in (10, 11):
            return None
        place += size
        if kind in INTEGERS:
            found.append(int.from_bytes(part, "big", signed=True))
        elif kind == 7:
            found.append(struct.unpack(">d", part)[0])
        elif kind in (0, 8, 9):
            found.append(None if kind == 0 else kind - 8)
        else:
            found.append(part if kind % 2 == 0 else part.decode())
    return tuple(found)
