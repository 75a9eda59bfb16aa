"""A definition as a graph: objects with their inputs, outputs and wires, read from an archive."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from uuid import UUID

from hookean.errors import InputError
from hookean_canvas import archive
from hookean_canvas.archive import Chunk
from hookean_canvas.guids import GROUP, SCRIBBLE
from hookean_canvas.trees import Tree, path_of


@dataclass
class Port:
    """An input, an output, or a whole floating parameter. `sources` are ids of ports; `data` is persistent data."""

    id: UUID
    name: str
    nickname: str
    access: int = 0
    optional: bool = False
    sources: list[UUID] = field(default_factory=list)
    mapping: int = 0
    reverse: bool = False
    simplify: bool = False
    hint: UUID | None = None
    data: Tree | None = None
    faint: bool = False


@dataclass
class Node:
    """An object on the canvas. A floating one (slider, panel, parameter) has one port, which is both in and out."""

    id: UUID
    guid: UUID
    name: str
    nickname: str
    container: Chunk
    inputs: list[Port]
    outputs: list[Port]
    bounds: tuple[float, float, float, float] | None = None
    locked: bool = False

    @property
    def floating(self) -> bool:
        """Whether it is a parameter and no component."""
        return len(self.inputs) == 1 and self.inputs[0] is self.outputs[0]

    @property
    def label(self) -> str:
        """What a person reads on it: the nickname, or the name."""
        return self.nickname or self.name


@dataclass
class Group:
    """Objects with a coloured border and a title."""

    id: UUID
    title: str
    members: list[UUID]
    colour: tuple[int, int, int, int]


@dataclass
class Graph:
    """A definition. `id` is the document's, `file` where it was read."""

    id: UUID
    name: str
    description: str
    nodes: list[Node]
    groups: list[Group]
    file: Path | None = None

    def owners(self) -> dict[UUID, tuple[Node, Port]]:
        """The object and the port behind each id that a wire can come from."""
        return {port.id: (node, port) for node in self.nodes for port in node.outputs}

    def wires(self) -> Iterator[tuple[Node, Port, Node, Port]]:
        """Every wire: object and output it leaves, object and input it enters; those that lead nowhere are left out."""
        owners = self.owners()
        for node in self.nodes:
            for port in node.inputs:
                for source in port.sources:
                    if source in owners:
                        yield (*owners[source], node, port)

    def ordered(self) -> list[Node]:
        """Objects so that each comes after those that feed it; InputError where wires run in a circle."""
        feeds: dict[UUID, list[Node]] = {}
        missing = {node.id: 0 for node in self.nodes}
        for start, _, end, _ in self.wires():
            feeds.setdefault(start.id, []).append(end)
            missing[end.id] += 1
        ready = [node for node in self.nodes if not missing[node.id]]
        for node in ready:  # grows on the way
            for after in feeds.get(node.id, ()):
                missing[after.id] -= 1
                if not missing[after.id]:
                    ready.append(after)
        if len(ready) < len(self.nodes):
            circle = ", ".join(sorted(node.label for node in self.nodes if missing[node.id]))
            raise InputError("wires", f"they run in a circle through {circle}; take one of them away")
        return ready


def read(path: Path) -> Graph:
    """The definition in a .ghx or .gh file; InputError where it is none."""
    found = of(archive.read(path), str(path))
    found.file = Path(path).resolve()
    return found


def of(root: Chunk, where: str = "definition") -> Graph:
    """The definition in an archive."""
    definition = root.chunk("Definition")
    objects = definition.chunk("DefinitionObjects") if definition is not None else None
    if definition is None or objects is None:
        raise InputError(where, "this is no Grasshopper definition; give a .ghx or .gh file")
    header = definition.chunk("DocumentHeader")
    properties = definition.chunk("DefinitionProperties")
    graph = Graph(
        id=header.value("DocumentID", default=UUID(int=0)) if header is not None else UUID(int=0),
        name=properties.value("Name", default="") if properties is not None else "",
        description=properties.value("Description", default="") if properties is not None else "",
        nodes=[],
        groups=[],
    )
    for chunk in objects.chunks:
        container = chunk.chunk("Container")
        if chunk.name != "Object" or container is None:
            continue
        guid = chunk.value("GUID")
        if guid == GROUP:
            graph.groups.append(_group(container))
        elif guid != SCRIBBLE:
            graph.nodes.append(_node(guid, chunk.value("Name", default=""), container))
    return graph


def _group(container: Chunk) -> Group:
    members = [container.value("ID", i) for i in range(container.value("ID_Count", default=0))]
    colour = container.value("Colour", default=(255, 150, 150, 150))
    return Group(container.value("InstanceGuid"), container.value("NickName", default=""), members, colour)


def _node(guid: UUID, name: str, container: Chunk) -> Node:
    parameters = container.chunk("ParameterData")
    if parameters is not None:
        inputs = [port(chunk) for chunk in parameters.chunks if chunk.name == "InputParam"]
        outputs = [port(chunk) for chunk in parameters.chunks if chunk.name == "OutputParam"]
    else:
        inputs = [port(chunk) for chunk in container.chunks if chunk.name == "param_input"]
        outputs = [port(chunk) for chunk in container.chunks if chunk.name == "param_output"]
    if not inputs and not outputs:
        inputs = outputs = [port(container)]
    attributes = container.chunk("Attributes")
    bounds = attributes.value("Bounds") if attributes is not None else None
    if "InstanceGuid" not in {item.name for item in container.items}:
        raise InputError(name or "object", "this has no InstanceGuid; the file is damaged")
    return Node(
        id=container.value("InstanceGuid"),
        guid=guid,
        name=container.value("Name", default=name),
        nickname=container.value("NickName", default=""),
        container=container,
        inputs=inputs,
        outputs=outputs,
        bounds=bounds,
        locked=bool(container.value("Locked", default=False)),
    )


def port(chunk: Chunk) -> Port:
    """The parameter that a chunk describes."""
    access = chunk.value("ScriptParamAccess", default=chunk.value("Access", default=0))
    data = chunk.chunk("PersistentData")
    return Port(
        id=chunk.value("InstanceGuid"),
        name=chunk.value("Name", default=""),
        nickname=chunk.value("NickName", default=""),
        access=int(access),
        optional=bool(chunk.value("Optional", default=False)),
        sources=[chunk.value("Source", i) for i in range(chunk.value("SourceCount", default=0))],
        mapping=int(chunk.value("Mapping", default=0)),
        reverse=bool(chunk.value("ReverseData", default=False)),
        simplify=bool(chunk.value("SimplifyData", default=False)),
        hint=chunk.value("TypeHintID"),
        data=_persistent(data) if data is not None else None,
        faint=chunk.value("WireDisplay", default=0) != 0,
    )


def _persistent(chunk: Chunk) -> Tree:
    tree = Tree()
    for branch in chunk.chunks:
        values = [_stored(item) for item in branch.chunks]
        tree.add(path_of(str(branch.value("Path", default="{0}"))), values)
    return tree


def _stored(chunk: Chunk) -> Any:
    """A stored value: a number, text, a truth or the coordinates of a point or vector; anything else is Unread."""
    for name in ("number", "string", "boolean", "Coordinate", "vector"):
        value = chunk.value(name)
        if value is not None:
            return value
    return Unread([item.name for item in chunk.items])


@dataclass(frozen=True)
class Unread:
    """A stored value of a kind that is not read; `items` are the names under which it is stored."""

    items: list[str]
