"""Checks of Grasshopper files before Grasshopper sees them: what would make it refuse, repair or lose something.

Grasshopper's reader takes nearly everything and drops in silence what it does not understand. What it does not take is
in `lint_refused`; the rest is here: what a file written by a program should have, and one that Grasshopper saved may
lack, as it holds components of plug-ins that are not known here, or groups with members that are gone.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator
from graphlib import CycleError, TopologicalSorter
from uuid import UUID

from hookean.errors import InputError
from hookean_canvas.archive import Chunk, Type, guids, of_bytes
from hookean_canvas.archive.chunk import labelled, sort_key
from hookean_canvas.archive.parts import SCRIPTS, Part, given, inputs, outputs, parts, sources
from hookean_canvas.inspect.lint_code import script_faults
from hookean_canvas.inspect.lint_refused import OUTER, miscounted, missing, named, refusals

EXPOSURES = {-1, *(2**power for power in range(1, 9))}
"""Where on its tab a user object may be: hidden, or in one of the rows."""
OBSCURE = 2**16
"""Added to an exposure, or alone: only in the unfolded tab."""


def faults(chunk: Chunk) -> list[str]:
    """What is wrong with a definition or a user object, a sentence each: first what Grasshopper would refuse it for."""
    if chunk.chunk("Definition") is not None:
        return [*refusals(chunk), *_order_faults(chunk), *_definition_faults(chunk)]
    if chunk.name == "UserObject" and chunk.item("Object") is not None:
        return [*refusals(chunk), *_order_faults(chunk), *_user_object_faults(chunk)]
    return refusals(chunk)


def _order_faults(root: Chunk) -> Iterator[str]:
    """Items sorted and unique, chunks unique, in every chunk."""
    for chunk in root.walk():
        keys = [sort_key(item) for item in chunk.items]
        if keys != sorted(keys):
            yield f"the items of {chunk.label} are not sorted by name and index"
        for what, entries in (("item", chunk.items), ("chunk", chunk.chunks)):
            for (name, index), count in Counter((entry.name, entry.index) for entry in entries).items():
                if count > 1:
                    yield f"{chunk.label} holds {count} {what}s {labelled(name, index)}"


# ------------------------------------------------------------------------------------------------------- definitions


def _definition_faults(root: Chunk) -> Iterator[str]:
    definition = root.chunk("Definition")
    assert definition is not None
    if root.name != "Root":
        yield f"the archive has the name {root.name!r}, not 'Root'"
    yield from missing(root, "the archive", {"ArchiveVersion": Type.VERSION})
    yield from missing(definition, "the definition", {"plugin_version": Type.VERSION})
    header = definition.chunk("DocumentHeader")
    if header is None:
        yield "the definition has no DocumentHeader"
    else:
        yield from missing(header, "DocumentHeader", {"DocumentID": Type.GUID})
    libraries = definition.chunk("GHALibraries")
    if libraries is not None:
        yield from miscounted(libraries, "GHALibraries", "Count", "Library")
    objects = definition.chunk("DefinitionObjects")
    if objects is None:
        return
    known = {library.value("Id") for library in libraries.chunks} if libraries is not None else set()
    found = parts(root)
    for number, part in enumerate(found):
        yield from (f"object {number} ({part.label}): {fault}" for fault in _part_faults(part, known))
    yield from _id_faults(found)
    yield from _wire_faults(found)
    yield from _group_faults(found)


def _part_faults(part: Part, libraries: set[object]) -> Iterator[str]:
    yield from missing(part.chunk, "it", {"Name": Type.STRING})
    yield from _kind_faults(part, libraries)
    container = part.container
    if container is None:
        return
    yield from missing(container, "its Container", {"Name": Type.STRING})
    yield from _port_faults(container)
    if part.guid in SCRIPTS:
        yield from script_faults(part.guid, container)
    yield from _own_faults(part.guid, container)


def _kind_faults(part: Part, libraries: set[object]) -> Iterator[str]:
    """The id is one of the table, under a name Grasshopper gives it, or one of a library the file declares."""
    guid, library = part.guid, part.chunk.value("Lib")
    if guid is None:
        return
    if library is not None and library not in libraries:
        yield f"its library {library} is not among GHALibraries"
    names = guids.NAMES.get(guid)
    if names is None:
        if library is None or library in guids.LIBRARIES:
            yield f"its id {guid} is unknown, and the file names no library for it"
    elif guid not in guids.RENAMED and part.name not in names:
        yield f"its id {guid} is that of {names[0]!r}, not of {part.name!r}"


def _port_faults(container: Chunk) -> Iterator[str]:
    """Inputs and outputs: numbered, each with a name; data of its own counted."""
    for name in ("param_input", "param_output"):
        indices = [port.index for port in container.chunks if port.name == name]
        if sorted(indices) != list(range(len(indices))):
            yield f"it numbers its {name} {indices}, not 0 to {len(indices) - 1}"
    for port in {id(port): port for port in (*inputs(container), *outputs(container))}.values():
        where = named(port, container)
        yield from missing(port, where, {"NickName": Type.STRING})
        stored = port.chunk("PersistentData")
        if stored is not None:
            yield from _data_faults(stored, where)


def _data_faults(stored: Chunk, where: str) -> Iterator[str]:
    yield from miscounted(stored, f"the data of {where}", "Count", "Branch")
    for branch in stored.chunks:
        yield from miscounted(branch, f"a branch of the data of {where}", "Count", "Item")
        path = str(branch.value("Path", default=""))
        if not re.fullmatch(r"\{-?\d+(;-?\d+)*\}", path, re.ASCII):
            yield f"the data of {where} has a branch with the path {path!r}, not one like '{{0;1}}'"


def _own_faults(guid: UUID | None, container: Chunk) -> Iterator[str]:
    """What single kinds of objects hold."""
    slider = container.chunk("Slider")
    if guid == guids.NUMBER_SLIDER:
        if slider is None:
            yield "the slider has no chunk Slider"
        else:
            yield from missing(slider, "the slider", dict.fromkeys(("Min", "Max", "Value"), Type.DOUBLE))
            low, high, value = (given(slider, name, 0.0) for name in ("Min", "Max", "Value"))
            if not low <= value <= high:
                yield f"the slider has the value {value:g}, outside its limits {low:g} to {high:g}"
    elif guid == guids.VALUE_LIST:
        yield from miscounted(container, "the list", "ListCount", "ListItem")


def _id_faults(found: list[Part]) -> Iterator[str]:
    """No id stands twice, of objects, inputs and outputs together."""
    places: dict[UUID, list[str]] = {}
    for number, part in enumerate(found):
        for label, guid in _ids(part):
            places.setdefault(guid, []).append(f"object {number} ({part.label}){label}")
    for guid, where in places.items():
        if len(where) > 1:
            yield f"the id {guid} occurs {len(where)} times: {', '.join(where)}"


def _ids(part: Part) -> Iterator[tuple[str, UUID]]:
    if part.container is None:
        return
    if part.id is not None:
        yield "", part.id
    for port in (*inputs(part.container), *outputs(part.container)):
        guid = port.value("InstanceGuid")
        if port is not part.container and isinstance(guid, UUID):
            yield f" {port.label}", guid


def _wire_faults(found: list[Part]) -> Iterator[str]:
    """Every wire comes from an output, and none feed themselves."""
    owners = {
        port.value("InstanceGuid"): number
        for number, part in enumerate(found)
        for port in (outputs(part.container) if part.container is not None else [])
    }
    feeds: dict[int, set[int]] = {}
    for number, part in enumerate(found):
        for port in inputs(part.container) if part.container is not None else []:
            for source in sources(port):
                if source in owners:
                    feeds.setdefault(number, set()).add(owners[source])
                else:
                    name = port.value("NickName", default="")
                    where = f"object {number} ({part.label})"
                    yield f"{where}: the wire into {name!r} comes from {source}, not an output here"
    try:
        TopologicalSorter(feeds).prepare()
    except CycleError as error:
        circle = " <- ".join(f"object {number} ({found[number].label})" for number in error.args[1])
        yield f"wires run in a circle: {circle}"


def _group_faults(found: list[Part]) -> Iterator[str]:
    ids = {part.id for part in found}
    for number, part in enumerate(found):
        if part.guid == guids.GROUP and part.container is not None:
            for item in part.container.items:
                if item.name == "ID" and item.value not in ids:
                    yield f"object {number} (group {part.label}): its member {item.value} is not in the definition"


# ------------------------------------------------------------------------------------------------------ user objects

_OUTER = {
    "BaseID": Type.GUID,
    "Category": Type.STRING,
    "Description": Type.STRING,
    "Exposure": Type.INT32,
    "Icon": Type.BYTEARRAY,
    "InstanceGuid": Type.GUID,
    "Name": Type.STRING,
    "NickName": Type.STRING,
    "Object": Type.BYTEARRAY,
    "SubCategory": Type.STRING,
}


def _user_object_faults(root: Chunk) -> Iterator[str]:
    yield from missing(root, "the user object", {name: _OUTER[name] for name in _OUTER.keys() - OUTER.keys()})
    base = root.value("BaseID")
    if base not in guids.NAMES:
        yield f"its base {base} is unknown"
    exposure = given(root, "Exposure", 2)
    if exposure != OBSCURE and exposure not in EXPOSURES and exposure - OBSCURE not in EXPOSURES - {-1}:
        yield f"its exposure is {exposure}, which is not one of {sorted(EXPOSURES)}, with or without {OBSCURE}"
    yield from _icon_faults(given(root, "Icon", b""))
    try:
        inner = of_bytes(given(root, "Object", b""), "the object in it")
    except InputError:
        return
    yield from _order_faults(inner)
    yield from _port_faults(inner)
    ids = [port.value("InstanceGuid") for port in (*inputs(inner), *outputs(inner)) if port is not inner]
    yield from (
        f"the id {guid} occurs {ids.count(guid)} times" for guid in sorted({*ids}, key=str) if ids.count(guid) > 1
    )
    if base in SCRIPTS:
        yield from script_faults(base, inner)
    yield from _own_faults(base, inner)


def _icon_faults(icon: bytes) -> Iterator[str]:
    if icon[:8] != b"\x89PNG\r\n\x1a\n":
        yield "its icon is not a PNG"
    elif (int.from_bytes(icon[16:20]), int.from_bytes(icon[20:24])) != (24, 24):
        yield f"its icon has {int.from_bytes(icon[16:20])} x {int.from_bytes(icon[20:24])} pixels, not 24 x 24"
