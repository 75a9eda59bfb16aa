"""Geometry that a file internalised: its bytes taken apart and decoded, and tried first in a process of its own.

Internalised geometry is the item `ON_Data`: raw deflate around a stream of .NET's binary serialisation (MS-NRBF) with
one object, of which the members version, archive3dm, opennurbs and data are those that rhino3dm decodes. Damaged bytes
can keep rhino3dm busy for minutes, or end its process.
"""

from __future__ import annotations

import base64
import struct
import subprocess
import sys
import threading
import zlib
from collections.abc import Mapping, Sequence
from contextlib import suppress
from typing import Any, BinaryIO

from hookean_canvas.archive.chunk import MOST_BYTES

SECONDS = 10.0
"""For how long one object may keep rhino3dm busy."""
MOST = 3
"""After so many that do not end, no others are tried."""


def decoded(data: bytes) -> Any:
    """The object of rhino3dm in internalised bytes, None where its version is unknown; ValueError where they are
    damaged."""
    from hookean_canvas.run.rhino import rhino3dm

    try:
        members = _members(_inflated(data))
        return rhino3dm.CommonObject.Decode(
            {
                "version": members["version"],
                "archive3dm": members["archive3dm"],
                "opennurbs": members["opennurbs"],
                "data": base64.b64encode(members["data"]).decode("ascii"),
            }
        )
    except (KeyError, ValueError, TypeError, IndexError, struct.error, zlib.error, RuntimeError) as error:
        raise ValueError(f"its bytes cannot be read ({type(error).__name__})") from None


def unreadable(objects: Sequence[bytes], seconds: float = SECONDS) -> Mapping[bytes, str]:
    """Why some of these bytes must not be decoded: one process decodes all, and is ended where one object takes longer
    than `seconds` or ends it; then another goes on with the next, up to `MOST` times."""
    waiting, found = list(dict.fromkeys(objects)), dict[bytes, str]()
    while waiting:
        if len(found) == MOST:
            return found | dict.fromkeys(waiting, f"it was not tried, after {MOST} damaged ones")
        done, ended = _tried(waiting, seconds)
        if done < len(waiting):
            after = f"ends rhino3dm ({ended})" if ended else f"keeps rhino3dm busy for more than {seconds:g} s"
            found[waiting[done]] = f"decoding it {after}; the file is damaged"
        waiting = waiting[done + 1 :]
    return found


def _tried(objects: Sequence[bytes], seconds: float) -> tuple[int, str]:
    """How many of the first of these a process decodes before it hangs or ends, and how it ended by itself."""
    child = subprocess.Popen(
        [sys.executable, "-m", "hookean_canvas.run.internalised"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
    )
    assert child.stdin is not None and child.stdout is not None
    given = threading.Thread(target=_give, args=(child.stdin, objects), daemon=True)
    given.start()
    done, late = -1, threading.Event()  # it reports once when it has started

    def end() -> None:
        late.set()
        child.kill()

    try:
        while done < len(objects):
            clock = threading.Timer(seconds if done >= 0 else 60.0, end)
            clock.start()
            answer = child.stdout.read(1)
            clock.cancel()
            if not answer:
                break
            done += 1
    finally:
        child.kill()
        child.wait()
        given.join()
        child.stdout.close()
    return max(done, 0), "" if late.is_set() else f"exit code {child.returncode}"


def _give(pipe: BinaryIO, objects: Sequence[bytes]) -> None:
    try:
        for data in objects:
            pipe.write(struct.pack("<Q", len(data)) + data)
        pipe.close()
    except OSError:  # it has ended
        pass


def _try_all() -> None:
    """Decode what comes in, and report each."""
    from hookean_canvas.run import rhino as _  # noqa: F401

    given, told = sys.stdin.buffer, sys.stdout.buffer
    told.write(b".")
    told.flush()
    while size := given.read(8):
        with suppress(ValueError):
            decoded(given.read(*struct.unpack("<Q", size)))
        told.write(b".")
        told.flush()


def _inflated(data: bytes) -> bytes:
    """Bytes without their compression, a raw deflate stream or none; ValueError where they are too many."""
    if data[:1] == b"\x00" and data[1:5] == b"\x01\x00\x00\x00":  # the header of a stream that is not compressed
        return data
    unpack = zlib.decompressobj(-15)
    found = unpack.decompress(data, MOST_BYTES)
    if unpack.unconsumed_tail:
        raise ValueError("too large")
    return found


# records and types of MS-NRBF, sections 2.1.2 and 2.3
_LIBRARY, _CLASSES, _OBJECT_STRING, _BYTES, _REFERENCE, _NULL, _END = 12, (4, 5), 6, 15, 9, 10, 11
_MOST_RECORDS = 100  # records of a stream and members of its object; geometry has four members in five records
_WIDTHS = {1: "?", 2: "B", 6: "d", 7: "h", 8: "i", 9: "q", 11: "f", 14: "H", 15: "I", 16: "Q"}


class _Reader:
    """A stream of .NET's binary serialisation, read from its start."""

    def __init__(self, data: bytes) -> None:
        self.data, self.at = data, 17  # after the header: a record type and four numbers

    def number(self, form: str = "i") -> Any:
        (found,) = struct.unpack_from("<" + form, self.data, self.at)
        self.at += struct.calcsize("<" + form)
        return found

    def text(self) -> str:
        """A text with its length before it, 7 bits a byte."""
        length, shift = 0, 0
        while True:
            byte = self.number("B")
            length |= (byte & 127) << shift
            shift += 7
            if byte < 128:
                break
            if shift > 28:
                raise ValueError("text without end")
        if length > len(self.data) - self.at:
            raise ValueError("text beyond the end")
        self.at += length
        return self.data[self.at - length : self.at].decode("utf-8")

    def array(self) -> tuple[int, bytes]:
        """The id and the bytes of an array of bytes."""
        number, length, kind = self.number(), self.number(), self.number("B")
        if kind != 2 or not 0 <= length <= len(self.data) - self.at:
            raise ValueError("not an array of bytes")
        self.at += length
        return number, self.data[self.at - length : self.at]


def _members(data: bytes) -> dict[str, Any]:
    """Numbers and bytes of the one object in a stream, by the names of its members."""
    reader = _Reader(data)
    members: dict[str, Any] = {}
    later: dict[int, str] = {}
    records = 0
    while reader.at < len(data):
        record, records = reader.number("B"), records + 1
        if records > _MOST_RECORDS:
            raise ValueError("too many records")
        if record == _LIBRARY:
            reader.number()
            reader.text()
        elif record in _CLASSES and not members:
            _object(reader, record, members, later)
        elif record == _BYTES:
            number, found = reader.array()
            members[later[number]] = found
        elif record == _END:
            break
        else:
            raise ValueError(f"record {record}")
    return members


def _object(reader: _Reader, record: int, members: dict[str, Any], later: dict[int, str]) -> None:
    """The values of an object; `later` gets the ids of arrays that follow it."""
    reader.number()
    reader.text()
    count = reader.number()
    if count > _MOST_RECORDS:
        raise ValueError("too many members")
    names = [reader.text() for _ in range(count)]
    kinds = [reader.number("B") for _ in names]
    more = [reader.number("B") if kind in (0, 7) else reader.text() if kind == 3 else None for kind in kinds]
    if record == 5:
        reader.number()
    for name, kind, primitive in zip(names, kinds, more, strict=True):
        if kind == 0:
            members[name] = reader.number(_WIDTHS[int(primitive or 0)])
            continue
        inner = reader.number("B")
        if inner == _REFERENCE:
            later[reader.number()] = name
        elif inner == _BYTES:
            members[name] = reader.array()[1]
        elif inner == _OBJECT_STRING:
            reader.number()
            members[name] = reader.text()
        elif inner != _NULL:
            raise ValueError(f"record {inner}")


if __name__ == "__main__":
    _try_all()
