"""Clusters that hold components of Kangaroo, opened before they are translated: their objects join the definition."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from uuid import UUID, uuid5

from hookean.errors import InputError
from hookean_canvas import archive
from hookean_canvas.archive import Chunk, Type
from hookean_canvas.archive.chunk import CLUSTERS
from hookean_canvas.archive.guids import CLUSTER, GROUP, PARAMETERS
from hookean_canvas.archive.parts import Part, bounds_of, inputs, is_floating, outputs, parts, sources
from hookean_canvas.definitions import containers
from hookean_canvas.kangaroo.ids import hidden, libraries
from hookean_canvas.kangaroo.make import fill, put_object
from hookean_canvas.kangaroo.room import move
from hookean_canvas.kangaroo.streams import sound

HOOKS = ("Cluster Input", "Cluster Output")
MOST_OBJECTS = 20_000
MARGIN = 60.0


def open_clusters(root: Chunk, known: Callable[[Part], bool]) -> list[str]:
    """Open the clusters of a definition that hold components of Kangaroo, and those in them; a note for each.

    `known`: whether a cluster is a component of Kangaroo itself, which is translated by its name. A cluster whose
    inputs and outputs are not those inside stays. `root` is changed.
    """
    notes: list[str] = []
    for _ in range(CLUSTERS):
        definition = root.chunk("Definition")
        assert definition is not None
        of = libraries(definition)
        held = [
            (part, why)
            for part in parts(root)
            if part.guid == CLUSTER and part.container is not None and not known(part)
            if (why := hidden(part.chunk, of)) and "holds" in why
        ]
        opened = [f"{part.label} was opened; it is {why}" for part, why in held if _open(root, part)]
        notes += opened
        if not opened:
            break
    return notes


def _open(root: Chunk, cluster: Part) -> bool:
    """Put the objects of a cluster into the definition, beneath all others; whether its hooks are its ports."""
    assert cluster.container is not None and cluster.id is not None
    ports = inputs(cluster.container), outputs(cluster.container)
    document = cluster.container.value("ClusterDocument")
    try:
        inside = archive.of_bytes(document, "cluster")
        sound(inside, "cluster")
    except InputError:
        return False
    found = [part for part in parts(inside) if part.container is not None and part.guid is not None]
    hooks = [
        [part for part in found if _name(part) == name and part.container and is_floating(part.container)]
        for name in HOOKS
    ]
    if not any(ports) or any(len(one) != len(other) for one, other in zip(hooks, ports, strict=True)):
        return False
    if len(found) + len(parts(root)) > MOST_OBJECTS:
        return False
    pairs = [pair for one, other in zip(ports, hooks, strict=True) for pair in _pairs(one, other)]
    names = {hook.id: port.value("InstanceGuid") for port, hook in pairs}
    _rename(cluster.id, found, names)
    for port, hook in pairs:
        _hook(port, hook, port in ports[0])
    _join(root, cluster, found)
    _libraries(root, inside)
    return True


def _name(part: Part) -> str:
    return str(part.container.value("Name", default=part.name)) if part.container is not None else ""


def _pairs(ports: Sequence[Chunk], hooks: Sequence[Part]) -> list[tuple[Chunk, Part]]:
    """Inputs or outputs with the objects inside that stand for them: by nickname, else from top to bottom."""
    by_name = {hook.label: hook for hook in hooks}
    if len(by_name) == len(hooks) and {port.value("NickName") for port in ports} == set(by_name):
        return [(port, by_name[port.value("NickName")]) for port in ports]
    return list(zip(ports, sorted(hooks, key=lambda hook: (bounds_of(hook.container) or (0, 0))[1]), strict=True))


def _rename(cluster: UUID, found: Sequence[Part], names: dict[UUID | None, UUID]) -> None:
    """Ids of its own for every object, input and output, as a cluster may be there several times."""
    own = {part.id for part in found}
    own |= {
        port.value("InstanceGuid")
        for part in found
        if part.container
        for port in (*inputs(part.container), *outputs(part.container))
    }
    for one in own - set(names):
        if isinstance(one, UUID):
            names[one] = uuid5(cluster, str(one))
    for part in found:
        for chunk in part.chunk.walk():
            for item in chunk.items:
                if item.type is Type.GUID and item.value in names:
                    item.value = names[item.value]


def _hook(port: Chunk, hook: Part, into: bool) -> None:
    """A parameter in the place of Cluster Input or Cluster Output, with what the cluster's own port has."""
    assert hook.container is not None and hook.id is not None
    chunk = containers.floating(port.value("InstanceGuid"), "Data", hook.label, "Contains a collection of generic data")
    wired = sources(port if into else hook.container)
    containers.wire(chunk, wired, port.value("Mapping", default=0) or hook.container.value("Mapping", default=0))
    for name in ("ReverseData", "SimplifyData"):
        if port.value(name) or hook.container.value(name):
            chunk.put(name, Type.BOOL, True)
    data = port.chunk("PersistentData") or hook.container.chunk("PersistentData")
    if data is not None and not wired:
        chunk.chunks.append(data)
    bounds = bounds_of(hook.container)
    if bounds is not None:
        containers.place(chunk, bounds)
    fill(hook.chunk, PARAMETERS["Data"], chunk)


def _join(root: Chunk, cluster: Part, found: Sequence[Part]) -> None:
    """Objects of a cluster in the definition, beneath what is there, in a group of its name."""
    definition = root.chunk("Definition")
    objects = definition.chunk("DefinitionObjects") if definition is not None else None
    assert objects is not None and cluster.id is not None
    boxes = [box for part in parts(root) if (box := bounds_of(part.container))]
    inner = [box for part in found if (box := bounds_of(part.chunk.chunk("Container")))]
    if boxes and inner:
        right = min(box[0] for box in boxes) - min(box[0] for box in inner)
        down = max(box[1] + box[3] for box in boxes) + MARGIN - min(box[1] for box in inner)
        for part in found:
            move(part.chunk, right, down)
    objects.chunks = [chunk for chunk in objects.chunks if chunk is not cluster.chunk]
    for part in found:
        part.chunk.index = 1 + max((chunk.index for chunk in objects.chunks), default=-1)
        objects.chunks.append(part.chunk)
    members = [id_ for part in found if isinstance(id_ := part.chunk.chunk("Container").value("InstanceGuid"), UUID)]  # type: ignore[union-attr]
    group = containers.group(uuid5(cluster.id, "group"), cluster.label, (150, 170, 135, 255), members)
    put_object(objects, GROUP, group)
    for i, chunk in enumerate(objects.chunks):
        chunk.index = i


def _libraries(root: Chunk, inside: Chunk) -> None:
    """The plug-ins that are listed in a cluster are listed in the definition."""
    definition, inner = root.chunk("Definition"), inside.chunk("Definition")
    given = inner.chunk("GHALibraries") if inner is not None else None
    if definition is None or given is None:
        return
    listed = definition.chunk("GHALibraries")
    if listed is None:
        listed = Chunk("GHALibraries")
        definition.chunks.insert(-1, listed)
    there = {chunk.value("Id") for chunk in listed.chunks}
    for chunk in given.chunks:
        if chunk.value("Id") not in there:
            chunk.index = len(listed.chunks)
            listed.chunks.append(chunk)
    listed.put("Count", Type.INT32, len(listed.chunks))
