"""What makes Grasshopper refuse a file, or leave out an object of it: a structure that its reader cannot follow.

Grasshopper asks for items by name, index and type, and for as many of them as a count promises; what is missing there
ends the reading of the object it belongs to, what is beyond the count is never read. It takes all else: unknown
components become placeholders, wires from nowhere and members of groups that are gone are dropped, items are sorted.
It writes counts and what they count from one list, so that a file it saved has none of these faults.
"""

from __future__ import annotations

from collections.abc import Iterator
from uuid import UUID

from hookean.errors import InputError
from hookean_canvas.archive import Chunk, Type, guids, of_bytes
from hookean_canvas.archive.chunk import labelled
from hookean_canvas.archive.parts import Part, given, inputs, outputs, parts

OUTER = {"BaseID": Type.GUID, "Object": Type.BYTEARRAY}
"""What a user object cannot do without: which component it is of, and that component."""


def refusals(root: Chunk) -> list[str]:
    """Why Grasshopper would refuse a definition, an object of it or a user object, a sentence each; nothing where it
    would not."""
    if root.chunk("Definition") is not None:
        return list(_of_definition(root))
    if root.name == "UserObject" and root.item("Object") is not None:
        return list(_of_user_object(root))
    return [f"the archive ({root.label}) contains no definition and no user object"]


def missing(chunk: Chunk, where: str, wanted: dict[str, Type]) -> Iterator[str]:
    """Items that have to be there, each with its type."""
    for name, type in wanted.items():
        item = chunk.item(name)
        if item is None:
            yield f"{where} has no {name}"
        elif item.type != type:
            yield f"{where} has {name} as {Type(item.type).label}, not {type.label}"


def miscounted(chunk: Chunk, where: str, count: str, name: str, of_items: bool = False) -> Iterator[str]:
    """A counting item agrees with what it counts, and that has the indices 0, 1, 2 ..."""
    entries = chunk.items if of_items else chunk.chunks
    indices = [entry.index for entry in entries if entry.name == name]
    counted = chunk.value(count, default=0)
    if counted != len(indices):
        yield f"{where} counts {counted} in {count}, but holds {len(indices)}"
    if sorted(indices) != list(range(len(indices))):
        yield f"{where} numbers its {name} {indices}, not 0 to {len(indices) - 1}"


def ports_refused(container: Chunk) -> Iterator[str]:
    """Inputs and outputs that cannot be read: without id, with wires or numbers that do not agree with their counts."""
    data = container.chunk("ParameterData")
    if data is not None:
        for side in ("Input", "Output"):
            yield from miscounted(data, "ParameterData", f"{side}Count", f"{side}Param")
            yield from miscounted(data, "ParameterData", f"{side}Count", f"{side}Id", of_items=True)
            yield from _guids(data, "ParameterData", f"{side}Id")
    for port in {id(port): port for port in (*inputs(container), *outputs(container))}.values():
        where = named(port, container)
        if port is not container:
            yield from missing(port, where, {"InstanceGuid": Type.GUID})
        yield from miscounted(port, where, "SourceCount", "Source", of_items=True)
        yield from _guids(port, where, "Source")


def named(port: Chunk, container: Chunk) -> str:
    """An input or output as a sentence names it."""
    return f"{port.label} ({port.value('NickName', default='')})" if port is not container else "it"


def _of_definition(root: Chunk) -> Iterator[str]:
    definition = root.chunk("Definition")
    objects = definition.chunk("DefinitionObjects") if definition is not None else None
    if objects is None:
        yield "the definition has no DefinitionObjects"
        return
    yield from missing(objects, "DefinitionObjects", {"ObjectCount": Type.INT32})
    yield from miscounted(objects, "DefinitionObjects", "ObjectCount", "Object")
    for number, part in enumerate(parts(root)):
        yield from (f"object {number} ({part.label}): {fault}" for fault in _of_part(part))


def _of_part(part: Part) -> Iterator[str]:
    yield from missing(part.chunk, "it", {"GUID": Type.GUID})
    container = part.container
    if container is None:
        yield "it has no Container"
        return
    yield from missing(container, "its Container", {"InstanceGuid": Type.GUID})
    yield from ports_refused(container)
    if part.guid == guids.GROUP:
        yield from miscounted(container, "the group", "ID_Count", "ID", of_items=True)
        yield from _guids(container, "the group", "ID")


def _of_user_object(root: Chunk) -> Iterator[str]:
    yield from missing(root, "the user object", OUTER)
    try:
        inner = of_bytes(given(root, "Object", b""), "the object in it")
    except InputError as error:
        yield str(error)
        return
    yield from ports_refused(inner)


def _guids(chunk: Chunk, where: str, name: str) -> Iterator[str]:
    for item in chunk.items:
        if item.name == name and not isinstance(item.value, UUID):
            yield f"{where} has {labelled(name, item.index)} as {Type(item.type).label}, not gh_guid"
