"""Grasshopper archives: .gh, .ghx and .ghuser files as chunks and items, and back.

root = archive.read("arch.ghx")
objects = root.chunk("Definition").chunk("DefinitionObjects")
objects.value("ObjectCount")
archive.write(root, "arch.gh")
"""

from __future__ import annotations

import re
from pathlib import Path

from hookean.errors import InputError, refuse_pointer
from hookean_canvas.archive.binary import of_bytes, to_bytes
from hookean_canvas.archive.chunk import MOST_BYTES, Chunk, Item, Type
from hookean_canvas.archive.xml import of_xml, to_xml

__all__ = ["Chunk", "Item", "Type", "of_bytes", "of_xml", "parse", "read", "read_bytes", "to_bytes", "to_xml", "write"]

_XML = re.compile(rb"(\xef\xbb\xbf)?\s*<[?!A-Za-z]|\xff\xfe<\x00|\xfe\xff\x00<")


def read(path: str | Path, limit: int = MOST_BYTES) -> Chunk:
    """The archive in a file, XML or binary by its content.

    InputError where the file cannot be read, is not an archive (a Git LFS pointer, for one), is damaged, or has more
    than `limit` bytes unpacked.
    """
    return parse(read_bytes(path, limit), str(path), limit)


def read_bytes(path: str | Path, limit: int = MOST_BYTES) -> bytes:
    """The bytes of a file; InputError where it cannot be read or has more than `limit`."""
    try:
        with Path(path).open("rb") as file:
            data = file.read(limit + 1)
    except OSError as error:
        raise InputError(str(path), f"cannot be read: {error.strerror or error}.") from None
    if len(data) > limit:
        raise InputError(str(path), f"has more than the {limit} bytes allowed; remove large geometry from the file.")
    return data


def parse(data: bytes, where: str, limit: int = MOST_BYTES) -> Chunk:
    """The archive in bytes, as of the file `where`; InputError as for `read`."""
    if not data:
        raise InputError(where, "is empty; a Grasshopper archive was expected.")
    refuse_pointer(data, where)
    return of_xml(data, where, limit) if _XML.match(data) else of_bytes(data, where, limit)


def write(chunk: Chunk, path: str | Path) -> None:
    """Write an archive: XML to .ghx, binary to .gh and .ghuser; InputError for another suffix or a wrong value."""
    path = Path(path)
    suffix = path.suffix.lower()
    if suffix not in (".gh", ".ghx", ".ghuser"):
        raise InputError(str(path), f"ends in {suffix!r}; Grasshopper archives end in .gh, .ghx or .ghuser.")
    data = to_xml(chunk) if suffix == ".ghx" else to_bytes(chunk)
    try:
        path.write_bytes(data)
    except OSError as error:
        raise InputError(str(path), f"cannot be written: {error.strerror or error}.") from None
