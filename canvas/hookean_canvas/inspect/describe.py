"""What an archive holds, as plain data: the part of `hookean canvas show` that programs read."""

from __future__ import annotations

import math
from collections import Counter
from decimal import Decimal
from typing import Any
from uuid import UUID

from hookean.errors import InputError
from hookean_canvas.archive import Chunk, Item, Type, guids, of_bytes
from hookean_canvas.archive.chunk import CLUSTERS, labelled
from hookean_canvas.archive.parts import Part, code, given, inputs, is_floating, outputs, parts, sources
from hookean_canvas.kangaroo import ids as kangaroo_guids

Data = dict[str, Any]
Owners = dict[Any, tuple[str, Chunk | None]]
"""Where wires come from: by an output's id the label of its object, and the output, None where it is the object."""

ACCESS = ("item", "list", "tree")
MAPPING = ("", "flatten", "graft")
_COMMON = {"Name", "NickName", "Description", "InstanceGuid", "Optional", "SourceCount", "Source", "Mapping"}
_COMMON |= {
    "GraftStandardOutputLines",
    "ScriptComponentVersion",
    "ReverseData",
    "SimplifyData",
    "CodeInput",
    "IconOverride",
    "IconDisplay",
    "Tooltip",
    "ToolTip",
}
_SHOWN = {"Attributes", "ParameterData", "PersistentData", "Script", "ScriptEditor", "PanelProperties"}
_SHOWN |= {"InputParam", "OutputParam", "param_input", "param_output", "EvalUnits"}


def describe(root: Chunk, depth: int = 0) -> Data:
    """A definition or user object as JSON-ready data; any other archive chunk by chunk, item by item.

    `depth`: in how many clusters it is.
    """
    if root.chunk("Definition") is not None:
        return _definition(root, depth)
    if root.name == "UserObject" and root.item("Object") is not None:
        return _user_object(root, depth)
    return {"kind": "archive", "root": raw(root)}


def raw(chunk: Chunk) -> Data:
    """Every item and chunk, nothing interpreted."""
    return {
        "name": chunk.label,
        "items": {labelled(item.name, item.index): plain(item.value) for item in chunk.items},
        "chunks": [raw(inner) for inner in chunk.chunks],
    }


def plain(value: Any) -> Any:
    """A value as JSON can hold it: bytes by their number, an id, a decimal or a number without end as its text."""
    match value:
        case bytes():
            return f"{len(value)} bytes"
        case UUID() | Decimal():
            return str(value)
        case tuple():
            return [plain(part) for part in value]
        case float() if not math.isfinite(value):
            return str(value)
    return value


def _text(chunk: Chunk | None, name: str) -> str:
    found = chunk.value(name, default="") if chunk is not None else ""
    return str(plain(found))


# ------------------------------------------------------------------------------------------------------- definitions


def _definition(root: Chunk, depth: int) -> Data:
    definition = root.chunk("Definition")
    assert definition is not None
    header, properties = definition.chunk("DocumentHeader"), definition.chunk("DefinitionProperties")
    found = parts(root)
    labels = _labels(found)
    owners = {
        port.value("InstanceGuid"): (label, None if port is part.container else port)
        for part, label in zip(found, labels, strict=True)
        for port in (outputs(part.container) if part.container is not None else [])
    }
    origins = _Origins(definition)
    objects = [
        {"index": number, "label": labels[number]} | _part(part, owners, origins, depth)
        for number, part in enumerate(found)
        if part.guid != guids.GROUP
    ]
    members = {part.id: label for part, label in zip(found, labels, strict=True)}
    libraries = definition.chunk("GHALibraries")
    return {
        "kind": "definition",
        "name": _text(properties, "Name"),
        "description": _text(properties, "Description"),
        "id": _text(header, "DocumentID"),
        "grasshopper": ".".join(map(str, given(definition, "plugin_version", ()))),
        "libraries": [_library(library) for library in libraries.chunks] if libraries is not None else [],
        "objects": objects,
        "groups": [_group(part, members) for part in found if part.guid == guids.GROUP and part.container is not None],
    }


def _labels(found: list[Part]) -> list[str]:
    """What each object is called in wires: by its nickname, with its number where others are called the same."""
    often = Counter(part.label for part in found if part.guid != guids.GROUP)  # no wire comes from a group
    return [part.label if often[part.label] < 2 else f"{part.label} #{n}" for n, part in enumerate(found)]


def _library(library: Chunk) -> Data:
    return {key.lower(): _text(library, key) for key in ("Name", "Version", "Author", "Id")}


def _group(part: Part, labels: dict[UUID | None, str]) -> Data:
    assert part.container is not None
    members = [item.value for item in part.container.items if item.name == "ID"]
    title = _text(part.container, "NickName")
    return {"name": title, "members": [labels.get(member, f"{member}, not in the file") for member in members]}


class _Origins:
    """Where the components of a definition come from that are not Grasshopper's own."""

    def __init__(self, definition: Chunk) -> None:
        self._kangaroo = kangaroo_guids.libraries(definition)
        listed = definition.chunk("GHALibraries")
        self._names = {one.value("Id"): _text(one, "Name") for one in (listed.chunks if listed is not None else ())}

    def known(self, thing: Chunk) -> tuple[str | None, str | None]:
        """The name of an object's kind, None where no table has it; the plug-in it is of, None for Grasshopper's."""
        guid = thing.value("GUID")
        name = guids.name(guid) if isinstance(guid, UUID) else None
        if name is not None:
            return name, None
        found = kangaroo_guids.recognised(thing, self._kangaroo)
        if found is not None:
            return found.name, kangaroo_guids.GENERATIONS[found.generation]
        return None, self._names.get(thing.value("Lib")) or None


def _part(part: Part, owners: Owners, origins: _Origins, depth: int) -> Data:
    guid = part.guid
    known, plugin = origins.known(part.chunk)
    described: Data = {
        "name": part.name,
        "nickname": _text(part.container, "NickName"),
        "known": known,
        "plugin": plugin,
        "guid": str(guid),
        "id": str(part.id),
        "library": _text(part.chunk, "Lib") or None,
    }
    if part.container is None:
        return described
    attributes = part.container.chunk("Attributes")
    place = given(attributes, "Pivot", ()) or given(attributes, "Bounds", ())[:2]
    return described | {"pivot": plain(tuple(place))} | _container(guid, part.container, owners, depth)


def _container(guid: UUID | None, container: Chunk, owners: Owners, depth: int) -> Data:
    """What a component or parameter holds, whether it stands in a definition or in a user object."""
    described: Data = {"description": _text(container, "Description"), "values": _values(guid, container, depth)}
    if is_floating(container):
        described |= _port(container, owners) | {"nickname": _text(container, "NickName")}
        described["floating"] = True
    else:
        described["inputs"] = [_port(port, owners) for port in inputs(container)]
        described["outputs"] = [_port(port, owners) for port in outputs(container)]
    try:
        script = code(container)
    except ValueError as error:
        return described | {"language": f"unreadable: {error}", "code": ""}
    if script is not None:
        described |= {"language": script.language, "code": script.text}
    return described


def _port(port: Chunk, owners: Owners) -> Data:
    hint = port.value("TypeHintID")
    access, mapping = given(port, "Access", given(port, "ScriptParamAccess", 0)), given(port, "Mapping", 0)
    stored = port.chunk("PersistentData")
    described: Data = {
        "name": _text(port, "Name"),
        "nickname": _text(port, "NickName"),
        "description": _text(port, "Description"),
        "id": _text(port, "InstanceGuid"),
        "access": ACCESS[access] if access in range(3) else str(access),
        "optional": bool(port.value("Optional", default=False)),
        "hint": (guids.hint(hint) or str(hint)) if isinstance(hint, UUID) else None,
        "sources": [_source(source, owners) for source in sources(port)],
        "data": _persistent(stored) if stored is not None else {},
    }
    marks = [MAPPING[mapping]] if mapping in (1, 2) else []
    marks += [word for word in ("reverse", "simplify") if port.value(word.capitalize() + "Data", default=False)]
    return described | {"changes": marks}


def _source(source: UUID, owners: Owners) -> Data:
    if source not in owners:
        return {"id": str(source), "object": None, "output": None}
    label, port = owners[source]
    output = None if port is None else _text(port, "NickName") or _text(port, "Name")
    return {"id": str(source), "object": label, "output": output}


def _persistent(stored: Chunk) -> Data:
    """The values a parameter holds itself, by branch."""
    return {
        str(branch.value("Path", default=f"branch {branch.index}")): [
            _datum(item) for item in branch.chunks if item.name == "Item"
        ]
        for branch in stored.chunks
        if branch.name == "Branch"
    }


def _datum(item: Chunk) -> Any:
    if len(item.items) == 1 and not item.chunks:
        return plain(item.items[0].value)
    return {labelled(entry.name, entry.index): plain(entry.value) for entry in item.items} | {
        inner.label: _datum(inner) for inner in item.chunks
    }


def _values(guid: UUID | None, container: Chunk, depth: int) -> Data:
    """The object's own settings, without what every object has; the common ones by plain words."""
    slider = container.chunk("Slider")
    if guid == guids.NUMBER_SLIDER and slider is not None:
        named = {"value": "Value", "from": "Min", "to": "Max", "decimals": "Digits"}
        return {word: plain(slider.value(name)) for word, name in named.items()}
    if guid == guids.BOOLEAN_TOGGLE:
        return {"value": plain(container.value("ToggleValue"))}
    if guid == guids.PANEL:
        return {} if sources(container) else {"text": _text(container, "UserText")}
    if guid == guids.VALUE_LIST:
        entries = [entry for entry in container.chunks if entry.name == "ListItem"]
        chosen = [_text(entry, "Name") for entry in entries if entry.value("Selected", default=False)]
        return {"chosen": chosen, "list": {_text(entry, "Name"): _text(entry, "Expression") for entry in entries}}
    return _others(container, depth)


def _others(container: Chunk, depth: int) -> Data:
    shown: Data = {labelled(item.name, item.index): _unpacked(item, depth) for item in container.items if _is_own(item)}
    for inner in container.chunks:
        if inner.name not in _SHOWN:
            shown[inner.label] = {labelled(item.name, item.index): plain(item.value) for item in inner.items}
    return shown


def _is_own(item: Item) -> bool:
    return item.name not in _COMMON and not item.name.startswith(("Using", "Marsh", "Hide", "Editor"))


def _unpacked(item: Item, depth: int) -> Any:
    """A value; an archive within it (a cluster's definition) as what it holds."""
    if item.type == Type.BYTEARRAY and item.name == "ClusterDocument" and depth < CLUSTERS:
        try:
            return describe(of_bytes(item.value, item.name), depth + 1)
        except InputError:
            pass
    return plain(item.value)


# ------------------------------------------------------------------------------------------------------ user objects


def _user_object(root: Chunk, depth: int) -> Data:
    base = root.value("BaseID")
    described: Data = {
        "kind": "user object",
        "name": _text(root, "Name"),
        "nickname": _text(root, "NickName"),
        "category": _text(root, "Category"),
        "subcategory": _text(root, "SubCategory"),
        "description": _text(root, "Description"),
        "exposure": plain(root.value("Exposure")),
        "icon": plain(root.value("Icon", default=b"")),
        "id": _text(root, "InstanceGuid"),
        "known": guids.name(base) if isinstance(base, UUID) else None,
        "guid": str(base),
    }
    try:
        inner = of_bytes(given(root, "Object", b""), "the object in it")
    except InputError as error:
        return described | {"damage": str(error)}
    return described | {"object": _container(base if isinstance(base, UUID) else None, inner, {}, depth)}
