"""XML GH_IO archives (.ghx): read without DTDs or entities, written so that no value changes on the way."""

from __future__ import annotations

import base64
import re
import struct
import uuid
from decimal import Decimal
from typing import Any
from xml.etree.ElementTree import Element, TreeBuilder
from xml.parsers import expat

import numpy

from hookean.errors import InputError
from hookean_canvas.archive.binary import SCALARS, TUPLES, pack
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

_CORNERS = {  # the elements of a value that has several numbers
    Type.DRAWING_POINT: "X Y",
    Type.DRAWING_POINTF: "X Y",
    Type.DRAWING_SIZE: "W H",
    Type.DRAWING_SIZEF: "W H",
    Type.DRAWING_RECTANGLE: "X Y W H",
    Type.DRAWING_RECTANGLEF: "X Y W H",
    Type.POINT2D: "X Y",
    Type.POINT3D: "X Y Z",
    Type.POINT4D: "X Y Z W",
    Type.INTERVAL1D: "A B",
    Type.INTERVAL2D: "Au Bu Av Bv",
    Type.LINE: "Ax Ay Az Bx By Bz",
    Type.BOUNDINGBOX: "Xmin Ymin Zmin Xmax Ymax Zmax",
    Type.PLANE: "Ox Oy Oz Xx Xy Xz Yx Yy Yz",
    Type.VERSION: "Major Minor Revision",
}
_WHOLE = {Type.BYTE, Type.INT32, Type.INT64, Type.DATE}
_WHOLE |= {Type.DRAWING_POINT, Type.DRAWING_SIZE, Type.DRAWING_RECTANGLE, Type.VERSION}
_SINGLE = {Type.SINGLE, Type.DRAWING_POINTF, Type.DRAWING_SIZEF, Type.DRAWING_RECTANGLEF}
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")
_FORBIDDEN = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff]")  # no XML 1.0 may hold these


def to_xml(chunk: Chunk) -> bytes:
    """The chunk as an XML archive in UTF-8; InputError for a value not of its type or a text XML cannot hold."""
    tag = "Archive" if chunk.name == "Root" else "Fragment"
    out = ['<?xml version="1.0" encoding="utf-8" standalone="yes"?>']
    _write_chunk(chunk, out, (chunk.label,), tag)
    return ("\n".join(out) + "\n").encode()


def of_xml(data: bytes | str, name: str = "archive", limit: int = MOST_BYTES) -> Chunk:
    """The chunk in an XML archive.

    `name` is what errors call it. An archive of more than `limit` bytes, one with a DTD, one that is no XML or no
    archive, and a value that is not of its type are InputErrors. Items keep the order they have in the file.
    """
    data = data.encode() if isinstance(data, str) else data
    if len(data) > limit:
        raise InputError(name, f"has {len(data)} bytes, {limit} are allowed; remove large geometry from the file.")
    root = _parse(data, name)
    if root.tag not in ("Archive", "Fragment"):
        raise InputError(name, f"is XML, but no Grasshopper archive: it starts with <{root.tag}>, not <Archive>.")
    return _Reader(name).chunk(root, ())


# ---------------------------------------------------------------------------------------------------------- writing


def _write_chunk(chunk: Chunk, out: list[str], place: tuple[str, ...], tag: str = "chunk") -> None:
    if len(place) > DEEPEST:
        raise InputError(placed(place[:3]) + "/…", f"chunks are nested more than {DEEPEST} deep; write it flatter.")
    indent = "  " * (2 * len(place) - 2)
    out.append(f"{indent}<{tag} name={_attribute(chunk.name, place)}{_index(chunk.index)}>")
    if chunk.items:
        out.append(f'{indent}  <items count="{len(chunk.items)}">')
        _write_items(chunk, out, place, indent + "    ")
        out.append(f"{indent}  </items>")
    if chunk.chunks:
        out.append(f'{indent}  <chunks count="{len(chunk.chunks)}">')
        for inner in chunk.chunks:
            _write_chunk(inner, out, (*place, inner.label))
        out.append(f"{indent}  </chunks>")
    out.append(f"{indent}</{tag}>")


def _write_items(chunk: Chunk, out: list[str], place: tuple[str, ...], indent: str) -> None:
    for item in in_order(chunk, place):
        here = (*place, labelled(item.name, item.index))
        name = _attribute(item.name, here) + _index(item.index)
        kind = f'type_name="{item.type.label}" type_code="{int(item.type)}"'
        out.append(f"{indent}<item name={name} {kind}>{_body(item, here)}</item>")


def _index(index: int) -> str:
    return "" if index == -1 else f' index="{index}"'


def _attribute(text: str, place: tuple[str, ...]) -> str:
    safe = _escape(text, place).replace('"', "&quot;").replace("\t", "&#9;").replace("\n", "&#10;")
    return f'"{safe}"'


def _escape(text: str, place: tuple[str, ...]) -> str:
    found = _FORBIDDEN.search(text)
    if found:
        raise InputError(
            placed(place), f"holds the character {found[0]!r}, which no XML file may; save as .gh or leave it out."
        )
    # a bare carriage return would come back as a line feed
    return text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;").replace("\r", "&#13;")


def _body(item: Item, place: tuple[str, ...]) -> str:
    value = item.value
    if item.type is Type.STRING and isinstance(value, str):
        return _escape(value, place)
    try:
        packed = pack(item.type, value)
    except (struct.error, TypeError, ValueError, OverflowError, AttributeError):
        raise InputError(placed(place), f"is {value!r:.60}, which is not a {item.type.label}.") from None
    match item.type:
        case Type.BOOL:
            return "true" if value else "false"
        case Type.GUID:
            return str(value)
        case Type.DECIMAL:
            return format(value, "f")
        case Type.BYTEARRAY | Type.DOUBLEARRAY | Type.DRAWING_BITMAP:
            tag = "bitmap" if item.type is Type.DRAWING_BITMAP else "stream"
            return f'<{tag} length="{len(packed) - 4}">{base64.b64encode(packed[4:]).decode()}</{tag}>'
        case Type.DRAWING_COLOR:
            return f"<ARGB>{';'.join(map(str, map(int, value)))}</ARGB>"
    if item.type in _CORNERS:
        tags = _CORNERS[item.type].split()
        return "".join(f"<{tag}>{_number(item.type, part)}</{tag}>" for tag, part in zip(tags, value, strict=True))
    return _number(item.type, value)


def _number(type: Type, value: Any) -> str:
    """The shortest text that reads back as the same number, whatever the machine's language."""
    if type in _WHOLE:
        return str(int(value))
    if value != value:
        return "NaN"
    if value in (float("inf"), float("-inf")):
        return "INF" if value > 0 else "-INF"
    text = str(numpy.float32(value)) if type in _SINGLE else repr(float(value))
    return text.removesuffix(".0").replace("e", "E")


# ---------------------------------------------------------------------------------------------------------- reading


def _parse(data: bytes, name: str) -> Element:
    """The elements of an XML file; DTDs, and with them entities, are refused before they can do anything."""
    parser = expat.ParserCreate()
    builder = TreeBuilder()
    depth = count = 0

    def start(tag: str, attributes: dict[str, str]) -> None:
        nonlocal depth, count
        depth, count = depth + 1, count + 1
        if depth > 2 * DEEPEST + 4:
            raise InputError(name, f"is damaged: its elements lie more than {2 * DEEPEST + 4} deep.")
        if count > MOST_PARTS:
            raise InputError(name, f"holds more than {MOST_PARTS} elements; internalise less geometry.")
        builder.start(tag, attributes)

    def end(tag: str) -> None:
        nonlocal depth
        depth -= 1
        builder.end(tag)

    def refuse(*_: object) -> None:
        raise InputError(name, "declares a document type (<!DOCTYPE>), which no Grasshopper archive does; remove it.")

    parser.StartElementHandler, parser.EndElementHandler, parser.CharacterDataHandler = start, end, builder.data
    parser.StartDoctypeDeclHandler = parser.EntityDeclHandler = refuse
    parser.buffer_text = True
    try:
        parser.Parse(data, True)
    except expat.ExpatError as error:
        raise InputError(name, f"is no sound XML: {error}; save or copy it again.") from None
    except (ValueError, LookupError) as error:  # an encoding nobody knows
        if isinstance(error, InputError):
            raise
        raise InputError(name, f"is no sound XML: {error}; save it as UTF-8.") from None
    return builder.close()


class _Reader:
    """Elements to chunks."""

    def __init__(self, name: str) -> None:
        self.name = name

    def chunk(self, element: Element, place: tuple[str, ...]) -> Chunk:
        name, index = element.get("name", ""), self._index(element, place)
        chunk = Chunk(name, index)
        place = (*place, chunk.label)
        if len(place) > DEEPEST:
            raise self._damage(place[:3], f"chunks are nested more than {DEEPEST} deep")
        for group in element:
            if group.tag not in ("items", "chunks"):
                raise self._damage(place, f"<{group.tag}> is neither <items> nor <chunks>")
            for part in group:
                if part.tag == "item" and group.tag == "items":
                    chunk.items.append(self._item(part, place))
                elif part.tag == "chunk" and group.tag == "chunks":
                    chunk.chunks.append(self.chunk(part, place))
                else:
                    raise self._damage(place, f"<{part.tag}> stands in <{group.tag}>")
        again = twin(chunk.items)
        if again is not None:
            raise self._damage((*place, labelled(again.name, again.index)), "the item occurs twice in its chunk")
        return chunk

    def _item(self, element: Element, place: tuple[str, ...]) -> Item:
        name, index = element.get("name", ""), self._index(element, place)
        here = (*place, labelled(name, index))
        code = element.get("type_code", "")
        try:
            type = Type(int(code))
        except ValueError:
            raise self._damage(here, f"type code {code!r} is unknown to GH_IO") from None
        try:
            return Item(name, index, type, _value(type, element))
        except (ValueError, ArithmeticError, struct.error):
            text = "".join(element.itertext()).strip()
            raise self._damage(here, f"{text!r:.60} is no {type.label}") from None

    def _index(self, element: Element, place: tuple[str, ...]) -> int:
        text = element.get("index", "-1")
        if not re.fullmatch(r"-?\d{1,10}", text, re.ASCII) or not -(2**31) <= int(text) < 2**31:
            raise self._damage((*place, element.get("name", "")), f"the index {text!r:.60} is no 32-bit whole number")
        return int(text)

    def _damage(self, place: tuple[str, ...], what: str) -> InputError:
        return InputError(self.name, f"is damaged at {placed(place)}: {what}; save or copy it again.")


def _value(type: Type, element: Element) -> Any:
    """The value of an item; raises ValueError and the like if the text is not of its type."""
    text = element.text or ""
    if type is Type.STRING:
        return text
    if type in _CORNERS:
        parts = [(part.tag, part.text or "") for part in element]
        if [tag for tag, _ in parts] != _CORNERS[type].split():
            raise ValueError
        return TUPLES[type].unpack(TUPLES[type].pack(*(_read_number(type, part) for _, part in parts)))
    match type:
        case Type.BOOL:
            return text.strip().lower() == "true" if text.strip().lower() in ("true", "false") else _fail()
        case Type.GUID:
            return uuid.UUID(text.strip())
        case Type.DECIMAL:
            number = Decimal(text.strip() if _NUMBER.fullmatch(text.strip()) else _fail())
            pack(type, number)
            return number
        case Type.BYTEARRAY | Type.DOUBLEARRAY | Type.DRAWING_BITMAP:
            return _stream(type, element)
        case Type.DRAWING_COLOR:
            return _color(element)
    return SCALARS[type].unpack(SCALARS[type].pack(_read_number(type, text)))[0]


def _fail() -> Any:
    raise ValueError


def _read_number(type: Type, text: str) -> int | float:
    text = text.strip()
    if type in _WHOLE:
        return int(text) if re.fullmatch(r"[+-]?\d{1,20}", text, re.ASCII) else _fail()
    if text in ("NaN", "INF", "-INF"):
        return float(text.lower())
    # a decimal comma is refused: read as anything it would be another number
    return float(text) if _NUMBER.fullmatch(text) else _fail()


def _stream(type: Type, element: Element) -> bytes | tuple[float, ...]:
    tag = "bitmap" if type is Type.DRAWING_BITMAP else "stream"
    if [part.tag for part in element] != [tag]:
        raise ValueError
    data = base64.b64decode("".join((element[0].text or "").split()), validate=True)
    if type is Type.DOUBLEARRAY:
        return struct.unpack(f"<{len(data) // 8}d", data)
    return data


def _color(element: Element) -> tuple[int, ...]:
    if [part.tag for part in element] != ["ARGB"]:
        raise ValueError
    parts = tuple(int(part) for part in (element[0].text or "").split(";"))
    pack(Type.DRAWING_COLOR, parts)
    return parts
