"""A definition as a graph: objects with their inputs, outputs and wires, read from an archive."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from uuid import UUID

from hookean.errors import InputError
from hookean_canvas import archive
from hookean_canvas.archive import Chunk, Type
from hookean_canvas.archive import parts as chunks
from hookean_canvas.archive.guids import BOOLEAN_TOGGLE, GROUP, NUMBER_SLIDER, PANEL, SCRIBBLE, VALUE_LIST
from hookean_canvas.archive.parts import SCRIPTS, Part, Rectangle, bounds_of, given, sources
from hookean_canvas.run.internalised import unreadable
from hookean_canvas.run.stored import NOTHING, Unread, internalised_in, stored
from hookean_canvas.run.trees import Tree, path_of

NONE = UUID(int=0)
HOLDING = (NUMBER_SLIDER, BOOLEAN_TOGGLE, PANEL, VALUE_LIST)
"""Parameters that a person sets by hand."""
"""The library of what Grasshopper itself brings, in files of Rhino 8."""


@dataclass
class Port:
    """An input, an output, or a whole floating parameter. `sources` are ids of ports; `data` is persistent data.

    `unit`: curves and surfaces in it are given parameters from 0 to 1; `degrees`: its angles are in degrees.
    """

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
    expression: str = ""
    unit: bool = False
    degrees: bool = False


@dataclass
class Node:
    """An object on the canvas. A floating one (slider, panel, parameter) has one port, which is both in and out.

    `plugin`: whether it names a library; `library`: the name that the file lists for that.
    """

    id: UUID
    guid: UUID
    name: str
    nickname: str
    container: Chunk
    inputs: list[Port]
    outputs: list[Port]
    bounds: Rectangle | None = None
    locked: bool = False
    plugin: bool = False
    library: str = ""

    @property
    def floating(self) -> bool:
        """Whether it is a parameter and no component."""
        return len(self.inputs) == len(self.outputs) == 1 and self.inputs[0] is self.outputs[0]

    @property
    def label(self) -> str:
        """What a person reads on it: the nickname, or the name."""
        return self.nickname or self.name


@dataclass
class Group:
    """Objects and other groups with a coloured border and a title."""

    id: UUID
    title: str
    members: list[UUID]
    colour: tuple[int, int, int, int]


@dataclass
class Graph:
    """A definition. `id` is the document's, `file` where it was read; `damage`: a sentence for each object that lacks
    what Grasshopper needs to read it. Such an object has an id made of its number, or is left out."""

    id: UUID
    name: str
    description: str
    nodes: list[Node]
    groups: list[Group]
    file: Path | None = None
    damage: list[str] = field(default_factory=list)

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
        """Objects so that each comes after those that feed it.

        InputError where wires run in a circle, or two objects have one id.
        """
        twice = [node.label for node, count in zip(self.nodes, self._times(), strict=True) if count > 1]
        if twice:
            raise InputError(
                "ids", f"{', '.join(twice)} have one InstanceGuid; delete all but one and place them again"
            )
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
            raise InputError("wires", f"they run in a circle through {circle}; remove one of them")
        return ready

    def _times(self) -> list[int]:
        """How often the id of each object is there."""
        often = Counter(node.id for node in self.nodes)
        return [often[node.id] for node in self.nodes]


def read(path: Path, decode: bool = True) -> Graph:
    """The definition in a .ghx or .gh file, `decode`: with its geometry; InputError if it is not a definition."""
    return parse(archive.read_bytes(path), path, decode)


def parse(data: bytes, path: Path, decode: bool = True) -> Graph:
    """The definition in the bytes of the file `path`; InputError if it is not a definition.

    Its geometry is decoded in another process first, as damaged bytes can hold up rhino3dm or end it.
    """
    root = archive.parse(data, str(path))
    held = internalised_in(root)
    found = of(root, str(path), unreadable(held) if decode else dict.fromkeys(held, "it was not asked for"))
    found.file = Path(path).resolve()
    return found


def of(root: Chunk, where: str = "definition", refused: Mapping[bytes, str] = NOTHING) -> Graph:
    """The definition in an archive; `refused`: bytes of geometry that are not decoded, and why."""
    definition = root.chunk("Definition")
    objects = definition.chunk("DefinitionObjects") if definition is not None else None
    if definition is None or objects is None:
        raise InputError(where, "this is not a Grasshopper definition; give a .ghx or .gh file")
    header = definition.chunk("DocumentHeader")
    properties = definition.chunk("DefinitionProperties")
    graph = Graph(
        id=given(header, "DocumentID", UUID(int=0)),
        name=given(properties, "Name", ""),
        description=given(properties, "Description", ""),
        nodes=[],
        groups=[],
    )
    libraries = chunks.libraries(definition)
    for number, part in enumerate(chunks.parts(root)):
        told = f"object {number} ({part.label})"
        if part.container is None or part.guid is None:
            graph.damage.append(f"{told} has no {'Container' if part.container is None else 'GUID'}")
        elif part.guid == GROUP:
            graph.groups.append(_group(part.container))
        elif part.guid != SCRIBBLE:
            node = _node(part.guid, part, part.container, UUID(int=number), refused)
            node.library = libraries.get(part.chunk.value("Lib"), "") if node.plugin else ""
            graph.nodes.append(node)
            if part.id is None:
                graph.damage.append(f"{told} has no InstanceGuid")
            nameless = [port.nickname for port in (*node.inputs, *node.outputs) if port.id.int == 0]
            graph.damage += [f"{told}: {nickname or 'an input or output'} has no InstanceGuid" for nickname in nameless]
    return graph


def _group(container: Chunk) -> Group:
    items = sorted((item for item in container.items if item.name == "ID"), key=lambda item: item.index)
    members = [item.value for item in items if isinstance(item.value, UUID)]
    colour = container.item("Colour")
    rgb = colour.value if colour is not None and colour.type is Type.DRAWING_COLOR else (255, 150, 150, 150)
    return Group(given(container, "InstanceGuid", UUID(int=0)), given(container, "NickName", ""), members, rgb)


def _node(guid: UUID, part: Part, container: Chunk, instead: UUID, refused: Mapping[bytes, str]) -> Node:
    """An object; one without inputs and outputs that is no script is a parameter, such as a timer, and so is one that
    holds a value, whatever a damaged file says."""
    inputs, outputs = ([port(one, refused) for one in side(container)] for side in (chunks.inputs, chunks.outputs))
    if chunks.is_floating(container) or guid in HOLDING or not (inputs or outputs or guid in SCRIPTS):
        inputs = outputs = [port(container, refused)]
        inputs[0].id = part.id or instead
    return Node(
        id=part.id or instead,
        guid=guid,
        name=given(container, "Name", part.name),
        nickname=given(container, "NickName", ""),
        container=container,
        inputs=inputs,
        outputs=outputs,
        bounds=bounds_of(container),
        locked=given(container, "Locked", False),
        plugin=part.chunk.value("Lib", default=NONE) != NONE,
    )


def port(chunk: Chunk, refused: Mapping[bytes, str] = NOTHING) -> Port:
    """The parameter that a chunk describes; what is missing, or of another type, is as if never set."""
    access, mapping = given(chunk, "ScriptParamAccess", given(chunk, "Access", 0)), given(chunk, "Mapping", 0)
    data, hint = chunk.chunk("PersistentData"), chunk.value("TypeHintID")
    return Port(
        id=given(chunk, "InstanceGuid", UUID(int=0)),
        name=given(chunk, "Name", ""),
        nickname=given(chunk, "NickName", ""),
        access=access if access in (0, 1, 2) else 0,
        optional=given(chunk, "Optional", False),
        sources=sources(chunk),
        mapping=mapping if mapping in (0, 1, 2) else 0,
        reverse=given(chunk, "ReverseData", False),
        simplify=given(chunk, "SimplifyData", False),
        hint=hint if isinstance(hint, UUID) else None,
        data=_persistent(data, refused) if data is not None else None,
        faint=given(chunk, "WireDisplay", 0) != 0,
        expression=given(chunk, "InternalExpression", ""),
        unit=given(chunk, "Reparameterize", False),
        degrees=given(chunk, "UseDegrees", False),
    )


def _persistent(chunk: Chunk, refused: Mapping[bytes, str]) -> Tree:
    tree = Tree()
    for branch in chunk.chunks:
        values = [stored(item, refused) for item in branch.chunks]
        try:
            tree.add(path_of(given(branch, "Path", "{0}")), values)
        except ValueError:
            tree.add((branch.index,), [Unread(["Path"])])
    return tree
