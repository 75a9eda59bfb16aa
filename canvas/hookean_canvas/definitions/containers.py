"""The chunks of a definition's objects, as Grasshopper writes them: sliders, panels, components, scripts, groups.

What each chunk holds was read in definitions saved by Grasshopper 1.0.7 and 1.0.8 (Rhino 7 and 8).
"""

from __future__ import annotations

import base64
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any
from uuid import UUID

from hookean_canvas.archive import Chunk, Type
from hookean_canvas.archive.guids import CONVERTERS, HINTS, LIBRARIES, SCRIPT_LIBRARY, SCRIPT_PARAMETER
from hookean_canvas.archive.parts import Rectangle
from hookean_canvas.run.natives import PARAMETERS, Native

TICKS = 638_000_000_000_000_000
"""The date in every file, so that the same definition is the same file."""


def container(id: UUID, name: str, nickname: str, description: str) -> Chunk:
    """What every object has."""
    chunk = Chunk("Container")
    chunk.put("InstanceGuid", Type.GUID, id).put("Name", Type.STRING, name)
    return chunk.put("NickName", Type.STRING, nickname).put("Description", Type.STRING, description)


def floating(id: UUID, name: str, nickname: str, description: str) -> Chunk:
    """What an object has that is a parameter itself."""
    chunk = container(id, name, nickname, description)
    return chunk.put("Optional", Type.BOOL, False).put("SourceCount", Type.INT32, 0)


def slider(id: UUID, nickname: str, value: float, low: float, high: float, decimals: int) -> Chunk:
    """A number slider; whole numbers where there are no decimals."""
    chunk = floating(id, "Number Slider", nickname, "Numeric slider for single values")
    inner = chunk.add("Slider")
    inner.put("Digits", Type.INT32, decimals).put("GripDisplay", Type.INT32, 1)
    inner.put("Interval", Type.INT32, 0 if decimals else 1).put("SnapCount", Type.INT32, 0)
    for name, number in (("Max", high), ("Min", low), ("Value", value)):
        inner.put(name, Type.DOUBLE, float(number))
    return chunk


def toggle(id: UUID, nickname: str, value: bool) -> Chunk:
    """A boolean toggle."""
    chunk = floating(id, "Boolean Toggle", nickname, "Boolean (true/false) toggle")
    return chunk.put("ToggleValue", Type.BOOL, value)


def panel(id: UUID, nickname: str, text: str, colour: tuple[int, int, int, int] = (255, 255, 250, 90)) -> Chunk:
    """A panel; its text is one item."""
    chunk = floating(id, "Panel", nickname, "A panel for custom notes and text values")
    chunk.put("UserText", Type.STRING, text).put("ScrollRatio", Type.DOUBLE, 0.0)
    inner = chunk.add("PanelProperties").put("Colour", Type.DRAWING_COLOR, colour)
    for name, on in (
        ("DrawIndices", False), ("DrawPaths", False), ("Multiline", True), ("SpecialCodes", False), ("Stream", False),
        ("Wrap", True),
    ):  # fmt: skip
        inner.put(name, Type.BOOL, on)
    return chunk


def value_list(id: UUID, nickname: str, choices: Mapping[str, str], selected: str) -> Chunk:
    """A drop-down list; `choices` are expressions by the names a person reads."""
    chunk = floating(id, "Value List", nickname, "Provides a list of preset values to choose from")
    chunk.put("ListCount", Type.INT32, len(choices)).put("ListMode", Type.INT32, 1)
    for i, (name, expression) in enumerate(choices.items()):
        item = chunk.add("ListItem", i).put("Expression", Type.STRING, expression)
        item.put("Name", Type.STRING, name).put("Selected", Type.BOOL, name == selected)
    return chunk


def parameter(id: UUID, guid: UUID, nickname: str, values: Sequence[Any]) -> Chunk:
    """A floating parameter with persistent data."""
    name, kind = PARAMETERS[guid]
    chunk = floating(id, name, nickname, f"Contains a collection of {name.lower()} values")
    if values:
        persistent(chunk, kind, values)
    return chunk


_STORED: dict[str, tuple[str, Type]] = {
    "number": ("number", Type.DOUBLE),
    "integer": ("number", Type.INT32),
    "text": ("string", Type.STRING),
    "boolean": ("boolean", Type.BOOL),
    "point": ("Coordinate", Type.POINT3D),
    "vector": ("vector", Type.POINT3D),
    "domain": ("interval", Type.INTERVAL1D),
}


def typed(kind: str, value: float) -> Any:
    """A number as what an input of this kind stores; a domain is that from 0 to it. KeyError for a kind that holds no
    number."""
    if kind == "domain":
        return (0.0, float(value))
    return {"number": float, "integer": int, "boolean": bool}[kind](value)


def persistent(chunk: Chunk, kind: str, values: Sequence[Any]) -> None:
    """Give a parameter persistent data, in the branch {0}."""
    item, type_ = _STORED[kind]
    data = chunk.add("PersistentData").put("Count", Type.INT32, 1)
    branch = data.add("Branch", 0).put("Count", Type.INT32, len(values)).put("Path", Type.STRING, "{0}")
    for i, value in enumerate(values):
        branch.add("Item", i).put(item, type_, value)


@dataclass(frozen=True)
class Slot:
    """An input or output of a script: its variable, what it is, its access and type hint."""

    name: str
    description: str = ""
    access: int = 0
    hint: str = "none"
    optional: bool = True
    mapping: int = 0


def script(
    id: UUID, name: str, nickname: str, description: str, code: str, inputs: Sequence[tuple[UUID, Slot]],
    outputs: Sequence[tuple[UUID, Slot]],
) -> Chunk:  # fmt: skip
    """A Python 3 Script component of Rhino 8 and 9 (schema 3), with its code."""
    chunk = container(id, name, nickname, description)
    chunk.put("GraftStandardOutputLines", Type.BOOL, True).put("ScriptComponentVersion", Type.INT32, 3)
    chunk.put("Tooltip", Type.STRING, description)
    for flag in ("UsingLibraryInputParam", "UsingScriptInputParam", "UsingScriptOutputParam"):
        chunk.put(flag, Type.BOOL, False)
    chunk.put("UsingStandardOutputParam", Type.BOOL, False)
    parameters = chunk.add("ParameterData")
    for side, slots in (("Input", inputs), ("Output", outputs)):
        parameters.put(f"{side}Count", Type.INT32, len(slots))
        for i, (id_, slot) in enumerate(slots):
            parameters.put(f"{side}Id", Type.GUID, SCRIPT_PARAMETER, i)
            _slot(parameters.add(f"{side}Param", i), id_, slot)
    inner = chunk.add("Script").put("Title", Type.STRING, nickname)
    inner.put("Text", Type.STRING, base64.b64encode(code.encode("utf-8")).decode("ascii"))
    for flag in ("MarshGuids", "MarshInputs", "MarshOutputs"):
        chunk.put(flag, Type.BOOL, True)
        inner.put(flag, Type.BOOL, True)
    inner.add("LanguageSpec").put("Taxon", Type.STRING, "*.*.python").put("Version", Type.STRING, "3.*")
    return chunk


def _slot(chunk: Chunk, id: UUID, slot: Slot) -> None:
    chunk.put("AllowTreeAccess", Type.BOOL, True).put("Description", Type.STRING, slot.description)
    chunk.put("InstanceGuid", Type.GUID, id).put("Name", Type.STRING, slot.name).put("NickName", Type.STRING, slot.name)
    chunk.put("Optional", Type.BOOL, slot.optional).put("ScriptParamAccess", Type.INT32, slot.access)
    if slot.access:
        chunk.put("Access", Type.INT32, slot.access)
    if slot.mapping:
        chunk.put("Mapping", Type.INT32, slot.mapping)
    chunk.put("ScriptParameterVersion", Type.INT32, 2).put("ShowTypeHints", Type.BOOL, True)
    chunk.put("SourceCount", Type.INT32, 0).put("ToolTip", Type.STRING, slot.description)
    chunk.put("TypeHintID", Type.GUID, HINTS[slot.hint])
    assembly, type_ = CONVERTERS.get(slot.hint, CONVERTERS["none"])
    converter = chunk.add("ConverterData").put("AssemblyName", Type.STRING, assembly)
    converter.put("TypeName", Type.STRING, type_)


def native(id: UUID, of: Native, nickname: str, inputs: Sequence[UUID], outputs: Sequence[UUID]) -> Chunk:
    """One of Grasshopper's own components, with the defaults of its inputs."""
    chunk = container(id, of.name, nickname, of.does)
    for i, (id_, given) in enumerate(zip(inputs, of.inputs, strict=True)):
        inner = chunk.add("param_input", i)
        _named(inner, id_, given.name, given.nickname).put("Optional", Type.BOOL, False)
        if given.default:
            persistent(inner, given.kind, given.default)
    for i, (id_, result) in enumerate(zip(outputs, of.outputs, strict=True)):
        inner = chunk.add("param_output", i)
        _named(inner, id_, result.name, result.nickname).put("Optional", Type.BOOL, False)
    return chunk


def _named(chunk: Chunk, id: UUID, name: str, nickname: str) -> Chunk:
    chunk.put("InstanceGuid", Type.GUID, id).put("Name", Type.STRING, name).put("NickName", Type.STRING, nickname)
    return chunk.put("Description", Type.STRING, name).put("SourceCount", Type.INT32, 0)


def group(id: UUID, title: str, colour: tuple[int, int, int, int], members: Sequence[UUID]) -> Chunk:
    """A group with its title, drawn as a box around its members."""
    chunk = container(id, "Group", title, "A group of Grasshopper objects")
    chunk.put("Border", Type.INT32, 1).put("Colour", Type.DRAWING_COLOR, colour)
    chunk.put("ID_Count", Type.INT32, len(members))
    for i, member in enumerate(members):
        chunk.put("ID", Type.GUID, member, i)
    chunk.add("Attributes")
    return chunk


def wire(chunk: Chunk, sources: Sequence[UUID], mapping: int) -> None:
    """Connect a parameter; wires are kept on the side that receives."""
    chunk.put("SourceCount", Type.INT32, len(sources))
    for i, source in enumerate(sources):
        chunk.put("Source", Type.GUID, source, i)
    if mapping:
        chunk.put("Mapping", Type.INT32, mapping)


def place(chunk: Chunk, bounds: Rectangle) -> None:
    """Say where an object or a parameter of it stands."""
    x, y, width, height = bounds
    attributes = chunk.chunk("Attributes")
    if attributes is None:
        attributes = Chunk("Attributes")
        chunk.chunks.insert(0, attributes)
    attributes.put("Bounds", Type.DRAWING_RECTANGLEF, bounds)
    attributes.put("Pivot", Type.DRAWING_POINTF, (x + 0.5 * width, y + 0.5 * height))
    if chunk.chunk("PanelProperties") is not None:
        for side in ("MarginLeft", "MarginRight", "MarginTop"):
            attributes.put(side, Type.INT32, 0)


def header(definition: Chunk, id_: UUID, title: str, description: str) -> None:
    """What a definition has beside its objects: its id, title, words and the library of scripts."""
    head = definition.add("DocumentHeader").put("DocumentID", Type.GUID, id_).put("Preview", Type.STRING, "Shaded")
    head.put("PreviewMeshType", Type.INT32, 1).put("PreviewNormal", Type.DRAWING_COLOR, (100, 150, 0, 0))
    head.put("PreviewSelected", Type.DRAWING_COLOR, (100, 0, 150, 0))
    properties = definition.add("DefinitionProperties").put("Date", Type.DATE, TICKS).put("Name", Type.STRING, title)
    properties.put("Description", Type.STRING, description).put("KeepOpen", Type.BOOL, False)
    properties.add("Revisions").put("RevisionCount", Type.INT32, 0)
    properties.add("Projection").put("Target", Type.DRAWING_POINT, (0, 0)).put("Zoom", Type.SINGLE, 0.75)
    properties.add("Views").put("ViewCount", Type.INT32, 0)
    definition.add("RcpLayout").put("GroupCount", Type.INT32, 0)
    libraries = definition.add("GHALibraries").put("Count", Type.INT32, 1)
    library = libraries.add("Library", 0).put("Id", Type.GUID, SCRIPT_LIBRARY)
    name = LIBRARIES[SCRIPT_LIBRARY]
    library.put("Name", Type.STRING, name).put("Author", Type.STRING, "Robert McNeel & Associates")
    library.put("Version", Type.STRING, "")
