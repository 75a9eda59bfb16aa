"""The checksums of a .3dm file's chunks, read past by rhino3dm: one wrong bit in a coordinate is noticed.

A chunk whose typecode has the bit 0x8000 ends with the CRC-32 of the bytes that are its own, those of chunks inside it
left out. Where inside it they begin depends on its class, so they are looked for by typecode and length.
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
# what nests inside objects: a class, its user data, their heads, its id, its data, and chunks without a name
_NESTED = re.compile(rb"[\xfa\xfd]\x7f\x02\x00|[\xf9\xfb\xfc]\xff\x02\x00|\x00\x80\x00\x40")
_DEEPEST = 24


class Checksums:
    """Of the bytes `data` with length fields of `size` bytes. Any bytes are safe; the time is linear."""

    def __init__(self, data: bytes, size: int) -> None:
        self.data, self.view = data, memoryview(data)
        self.head = struct.Struct("<Iq" if size == 8 else "<Ii")

    def hold(self, typecode: int, body: int, end: int, depth: int = 0) -> bool:
        """Whether a chunk and all inside it are as they were written, as far as they have checksums."""
        if typecode & _SHORT:
            return True
        if depth > _DEEPEST:
            return False
        if typecode in (_CLASS, _ATTACHED):
            return self._row(typecode, body, end, depth)
        if typecode == _USER_DATA and body < end and self.data[body] >> 4 != 1:  # 1: its head is not a chunk
            return self._row(typecode, body + 1, end, depth)
        return self._own(body, end, typecode & _CHECKED, depth)

    def _row(self, typecode: int, body: int, end: int, depth: int) -> bool:
        """Chunks only: a class has its id, its data and an end; user data have a head and a chunk without a name."""
        found = []
        while body < end:
            inner = self._chunk(body, end)
            if inner is None or not self.hold(*inner, depth + 1):
                return False
            found.append(inner[0])
            body = inner[2]
        if typecode == _ATTACHED:
            return set(found) <= {_USER_DATA, _CLASS_END}
        if typecode == _USER_DATA:
            return found == [_HEAD, _UNNAMED]
        return found[:1] == [_ID] and found[-1:] == [_CLASS_END] and set(found[1:-1]) <= {_DATA, _USER_DATA}

    def _own(self, body: int, end: int, checked: int, depth: int) -> bool:
        """A chunk of bytes of its own and chunks, in any order."""
        stop = end - 4 if checked else end
        if stop < body:
            return False
        stated = int.from_bytes(self.data[stop:end], "little")
        if checked and zlib.crc32(self.view[body:stop]) == stated:
            return True  # nothing nested in it
        found, position, look = 0, body, body
        while (match := _NESTED.search(self.data, look, stop)) is not None:
            look = match.start() + 1
            inner = self._chunk(match.start(), stop)
            if inner is not None and inner[1] < inner[2]:
                if not self.hold(*inner, depth + 1):
                    return False
                found = zlib.crc32(self.view[position : match.start()], found)
                position = look = inner[2]
        return not checked or zlib.crc32(self.view[position:stop], found) == stated

    def _chunk(self, start: int, end: int) -> tuple[int, int, int] | None:
        """Typecode, body and end of the chunk that begins at `start`; None if there is no room for one."""
        body = start + self.head.size
        if body > end:
            return None
        typecode, value = self.head.unpack_from(self.data, start)
        after = body if typecode & _SHORT else body + value
        return (typecode, body, after) if body <= after <= end else None
