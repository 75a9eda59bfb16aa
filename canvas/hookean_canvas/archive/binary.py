"""Binary GH_IO archives (.gh, .ghuser): one chunk in one raw deflate stream, little-endian throughout."""

from __future__ import annotations

import struct
import uuid
import zlib
from decimal import Decimal
from typing import Any

from hookean.errors import InputError
from hookean_canvas.archive.chunk import (
    DEEPEST,
    MOST_BYTES,
    MOST_PARTS,
    Chunk,
    Item,
    Type,
    in_order,
    labelled,
    placed,
    twin,
)

SCALARS = {
    Type.BYTE: struct.Struct("<B"),
    Type.INT32: struct.Struct("<i"),
    Type.INT64: struct.Struct("<q"),
    Type.SINGLE: struct.Struct("<f"),
    Type.DOUBLE: struct.Struct("<d"),
    Type.DATE: struct.Struct("<q"),
}
TUPLES = {
    Type.DRAWING_POINT: struct.Struct("<2i"),
    Type.DRAWING_POINTF: struct.Struct("<2f"),
    Type.DRAWING_SIZE: struct.Struct("<2i"),
    Type.DRAWING_SIZEF: struct.Struct("<2f"),
    Type.DRAWING_RECTANGLE: struct.Struct("<4i"),
    Type.DRAWING_RECTANGLEF: struct.Struct("<4f"),
    Type.POINT2D: struct.Struct("<2d"),
    Type.POINT3D: struct.Struct("<3d"),
    Type.POINT4D: struct.Struct("<4d"),
    Type.INTERVAL1D: struct.Struct("<2d"),
    Type.INTERVAL2D: struct.Struct("<4d"),
    Type.LINE: struct.Struct("<6d"),
    Type.BOUNDINGBOX: struct.Struct("<6d"),
    Type.PLANE: struct.Struct("<9d"),
    Type.VERSION: struct.Struct("<3i"),
}
_INT32 = SCALARS[Type.INT32]
_DECIMAL = struct.Struct("<IIII")  # low, middle and high word, then sign and scale
_TWO = struct.Struct("<2i")
_READ = {int(type): (type, SCALARS.get(type) or TUPLES.get(type)) for type in Type}
_LEAST_ITEM, _LEAST_CHUNK = 10, 13  # bytes


def to_bytes(chunk: Chunk) -> bytes:
    """The chunk as a raw deflate stream, items sorted as GH_IO sorts them; InputError for a value not of its type."""
    return deflate(to_plain(chunk))


def of_bytes(data: bytes, name: str = "archive", limit: int = MOST_BYTES) -> Chunk:
    """The chunk in a raw deflate stream.

    `name` is what errors call it; an archive of more than `limit` bytes once unpacked, a damaged or a cut one is
    an InputError.
    """
    return of_plain(inflate(data, name, limit), name)


def deflate(plain: bytes) -> bytes:
    """`plain` as a raw deflate stream."""
    packer = zlib.compressobj(6, zlib.DEFLATED, -15)
    return packer.compress(plain) + packer.flush()


def inflate(data: bytes, name: str = "archive", limit: int = MOST_BYTES) -> bytes:
    """The bytes in a raw deflate stream, at most `limit`; InputError otherwise."""
    unpacker = zlib.decompressobj(-15)
    try:
        plain = unpacker.decompress(data, limit + 1)
    except zlib.error:
        raise InputError(
            name, "is not a Grasshopper archive, or is damaged (no raw deflate stream and no XML); save it again."
        ) from None
    if len(plain) > limit:
        raise InputError(name, f"unpacks to more than the {limit} bytes allowed; remove large geometry from the file.")
    if not unpacker.eof:
        raise InputError(name, f"is incomplete: it ends after {len(data)} bytes; copy it again.")
    if unpacker.unused_data:
        raise InputError(name, f"has {len(unpacker.unused_data)} bytes after the end of the archive; copy it again.")
    return plain


# ---------------------------------------------------------------------------------------------------------- writing


def to_plain(chunk: Chunk) -> bytes:
    """The chunk's bytes before they are packed."""
    out: list[bytes] = []
    _write_chunk(chunk, out, (chunk.label,))
    return b"".join(out)


def _write_chunk(chunk: Chunk, out: list[bytes], place: tuple[str, ...]) -> None:
    if len(place) > DEEPEST:
        raise InputError(placed(place[:3]) + "/…", f"chunks are nested more than {DEEPEST} deep, the limit of GH_IO.")
    counts = _INT32.pack(len(chunk.items)) + _INT32.pack(len(chunk.chunks))
    out.append(_string(chunk.name, place) + _index(chunk.index, place) + counts)
    for item in in_order(chunk, place):
        here = (*place, labelled(item.name, item.index))
        out.append(_string(item.name, here) + _index(item.index, here) + _INT32.pack(item.type) + _value(item, here))
    for inner in chunk.chunks:
        _write_chunk(inner, out, (*place, inner.label))


def _string(text: str, place: tuple[str, ...]) -> bytes:
    try:
        data = text.encode()
    except UnicodeEncodeError:
        raise InputError(placed(place), f"is {text!r}, half a character (a lone surrogate); write it whole.") from None
    length, prefix = len(data), bytearray()
    while length > 127:
        prefix.append(length & 127 | 128)
        length >>= 7
    return bytes(prefix) + bytes([length]) + data


def _index(index: int, place: tuple[str, ...]) -> bytes:
    try:
        return _INT32.pack(index)
    except struct.error:
        raise InputError(placed(place), f"has the index {_short(index)}, which is not a 32-bit whole number.") from None


def _value(item: Item, place: tuple[str, ...]) -> bytes:
    if item.type is Type.STRING and isinstance(item.value, str):
        return _string(item.value, place)
    try:
        return pack(item.type, item.value)
    except (struct.error, TypeError, ValueError, OverflowError, AttributeError):
        raise InputError(placed(place), f"is {_short(item.value)}, which is not a {Type(item.type).label}.") from None


def pack(type: Type, value: Any) -> bytes:
    """A value of any type but a string as it stands in an archive; ValueError and its like for a value of another."""
    if type in SCALARS:
        return SCALARS[type].pack(value)
    if type in TUPLES:
        return TUPLES[type].pack(*value)
    match type:
        case Type.BOOL if isinstance(value, int) and value in (0, 1):
            return bytes([value])
        case Type.GUID:
            return bytes(value.bytes_le)
        case Type.BYTEARRAY | Type.DRAWING_BITMAP if isinstance(value, bytes | bytearray | memoryview):
            return _INT32.pack(len(value)) + bytes(value)
        case Type.DOUBLEARRAY:
            return struct.pack(f"<i{len(value)}d", len(value), *value)
        case Type.DRAWING_COLOR:
            alpha, red, green, blue = value
            return bytes([blue, green, red, alpha])
        case Type.DECIMAL:
            return _pack_decimal(value)
    raise ValueError(value)


def _pack_decimal(value: Decimal) -> bytes:
    sign, digits, exponent = value.as_tuple()
    if not isinstance(exponent, int) or exponent < -28 or exponent > 28:
        raise ValueError(value)
    number = int("".join(map(str, digits)) or "0") * 10 ** max(exponent, 0)
    words = number & 0xFFFFFFFF, number >> 32 & 0xFFFFFFFF, number >> 64
    return _DECIMAL.pack(*words, sign << 31 | max(-exponent, 0) << 16)


def _short(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "..."


# ---------------------------------------------------------------------------------------------------------- reading


def of_plain(plain: bytes, name: str = "archive") -> Chunk:
    """The chunk in unpacked bytes; raises InputError with the place of damage."""
    reader = _Reader(plain, name)
    chunk = reader.chunk()
    if reader.position < len(plain):
        raise InputError(name, f"is damaged: {len(plain) - reader.position} bytes follow the last chunk.")
    return chunk


class _Reader:
    """A place in the unpacked bytes, and what it is in."""

    def __init__(self, data: bytes, name: str) -> None:
        self.data = data
        self.name = name
        self.position = 0
        self.parts = 0
        self.within: list[tuple[str, int]] = []  # names and indices, labels where something is wrong

    def chunk(self) -> Chunk:
        name, index = self._string(), self._int()
        self.within.append((name, index))
        if len(self.within) > DEEPEST:
            del self.within[3:]
            raise self._damage(f"chunks are nested more than {DEEPEST} deep")
        items, chunks = self._int(), self._int()
        room = len(self.data) - self.position
        if items < 0 or chunks < 0 or items * _LEAST_ITEM + chunks * _LEAST_CHUNK > room:
            raise self._damage(f"{items} items and {chunks} chunks are announced, {room} bytes are left")
        self.parts += items + chunks
        if self.parts > MOST_PARTS:
            raise InputError(self.name, f"holds more than {MOST_PARTS} items and chunks; internalise less geometry.")
        chunk = Chunk(name, index)
        chunk.items = [self._item() for _ in range(items)]
        again = twin(chunk.items)
        if again is not None:
            self.within.append((again.name, again.index))
            raise self._damage("the item occurs twice in its chunk")
        chunk.chunks = [self.chunk() for _ in range(chunks)]
        self.within.pop()
        return chunk

    def _item(self) -> Item:
        name = self._string()
        index, code = _TWO.unpack(self._take(8))
        self.within.append((name, index))
        found = _READ.get(code)
        if found is None:
            raise self._damage(f"type code {code} is unknown to GH_IO")
        type, layout = found
        if layout is None:
            value = self._value(type)
        else:
            value = layout.unpack(self._take(layout.size))
            value = value[0] if type in SCALARS else value
        self.within.pop()
        return Item(name, index, type, value)

    def _value(self, type: Type) -> Any:
        match type:
            case Type.STRING:
                return self._string()
            case Type.BOOL:
                return self._bool()
            case Type.GUID:
                return uuid.UUID(bytes_le=self._take(16))
            case Type.BYTEARRAY | Type.DRAWING_BITMAP:
                return self._take(self._int())
            case Type.DOUBLEARRAY:
                count = self._int()
                return struct.unpack(f"<{max(count, 0)}d", self._take(8 * count))
            case Type.DRAWING_COLOR:
                return tuple(reversed(self._take(4)))
        return self._decimal()

    def _bool(self) -> bool:
        byte = self._take(1)[0]
        if byte > 1:
            raise self._damage(f"a truth value is stored as {byte}, where 0 and 1 are allowed")
        return byte == 1

    def _decimal(self) -> Decimal:
        low, middle, high, flags = _DECIMAL.unpack(self._take(16))
        scale = flags >> 16 & 0xFF
        if flags & 0x7F00FFFF or scale > 28:
            raise self._damage(f"a decimal number has the flags {flags:#x}")
        digits = tuple(map(int, str(low | middle << 32 | high << 64)))
        return Decimal((flags >> 31, digits, -scale))

    def _string(self) -> str:
        start = self.position + 1
        if start <= len(self.data) and (length := self.data[start - 1]) < 128 and start + length <= len(self.data):
            self.position = start + length  # as nearly all are
            return self._decoded(self.data[start : self.position])
        length = shift = 0
        while True:
            byte = self._take(1)[0]
            length |= (byte & 127) << shift
            shift += 7
            if byte < 128:
                break
            if shift > 28:
                raise self._damage("a text's length has no end")
        return self._decoded(self._take(length))

    def _decoded(self, text: bytes) -> str:
        try:
            return text.decode()
        except UnicodeDecodeError:
            raise self._damage("a text is not UTF-8") from None

    def _int(self) -> int:
        return int(_INT32.unpack(self._take(4))[0])

    def _take(self, count: int) -> bytes:
        end = self.position + count
        if count < 0 or end > len(self.data):
            raise self._damage(f"{count} bytes are expected, {len(self.data) - self.position} are left")
        self.position, start = end, self.position
        return self.data[start:end]

    def _damage(self, what: str) -> InputError:
        place = placed(tuple(labelled(name, index) for name, index in self.within))
        return InputError(self.name, f"is damaged at {place}, byte {self.position}: {what}; save or copy it again.")
