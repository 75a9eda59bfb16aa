"""The wires of a definition before anything is changed: what flows into an input, and where outputs go."""

from __future__ import annotations

from collections.abc import Iterator
from uuid import UUID

from hookean.errors import InputError
from hookean_canvas.archive import Chunk, Item, Type
from hookean_canvas.archive.parts import Part, inputs, outputs, parts, sources

Wire = tuple[UUID, UUID]
"""The ids of the output a wire leaves and of the input it enters."""


class Streams:
    """Objects and wires as they stand in a file; `parts` are the file's own objects, wires those at this moment."""

    def __init__(self, root: Chunk) -> None:
        self.parts = parts(root)
        self._inputs = {id(part.chunk): [copied(port) for port in _side(part, inputs)] for part in self.parts}
        self._owner = {_id(port): part for part in self.parts for port in _side(part, outputs)}
        self._takers: dict[UUID, list[tuple[Part, Chunk]]] = {}
        for part in self.parts:
            for port in self._inputs[id(part.chunk)]:
                for source in sources(port):
                    self._takers.setdefault(source, []).append((part, port))
        self._labels = dict(self._named())
        found = [(source, _id(port)) for ports in self._inputs.values() for port in ports for source in sources(port)]
        self.wires: list[Wire] = [wire for wire in dict.fromkeys(found) if wire[0] in self._owner]
        self.dangling: list[Wire] = [wire for wire in dict.fromkeys(found) if wire[0] not in self._owner]

    def inputs_before(self, part: Part) -> list[Chunk]:
        """The inputs of an object as they were."""
        return self._inputs[id(part.chunk)]

    def owner(self, output: UUID) -> Part | None:
        """The object that an output belongs to; None where there is no such output."""
        return self._owner.get(output)

    def takers(self, output: UUID) -> list[tuple[Part, Chunk]]:
        """The objects that a wire leads to from an output, each with the input it enters."""
        return self._takers.get(output, [])

    def all_above(self, part: Part) -> set[UUID]:
        """Ids of all objects whose data reaches an object."""
        found: set[UUID] = set()
        waiting = [part]
        while waiting:
            for port in self._inputs[id(waiting.pop().chunk)]:
                for source in sources(port):
                    owner = self._owner.get(source)
                    if owner is not None and owner.id is not None and owner.id not in found:
                        found.add(owner.id)
                        waiting.append(owner)
        return found

    def taken(self, output: UUID) -> bool:
        """Whether any wire leaves an output."""
        return output in self._takers

    def told(self, wire: Wire) -> str:
        """A wire as a person reads it: `Slider > Solver.On`."""
        return f"{self._labels.get(wire[0], wire[0])} > {self._labels.get(wire[1], wire[1])}"

    def _named(self) -> Iterator[tuple[UUID, str]]:
        for part in self.parts:
            for port in (*_side(part, inputs), *_side(part, outputs)):
                name = port.value("NickName", default="")
                yield _id(port), part.label if port is part.container else f"{part.label}.{name}"


def _side(part: Part, side: object) -> list[Chunk]:
    return side(part.container) if part.container is not None and callable(side) else []


def _id(port: Chunk) -> UUID:
    found: UUID = port.value("InstanceGuid")
    return found


_KINDS = {"InstanceGuid": Type.GUID, "Name": Type.STRING, "NickName": Type.STRING, "Source": Type.GUID}
_KINDS |= {"SourceCount": Type.INT32, "Mapping": Type.INT32, "GUID": Type.GUID, "Lib": Type.GUID}


def sound(root: Chunk, where: str) -> None:
    """InputError where objects, inputs or outputs lack an id, or have one or a name of another type."""
    for number, part in enumerate(parts(root)):
        told = f"{where}, object {number}"
        if part.container is None or part.guid is None:
            raise InputError(told, "has no Container or no GUID; the file is damaged")
        ports = [*inputs(part.container), *outputs(part.container)]
        for chunk in (part.chunk, part.container, *ports):
            for item in chunk.items:
                if item.type != _KINDS.get(item.name, item.type):
                    raise InputError(told, f"has {item.name} as {item.type.label}; the file is damaged")
        if not all(isinstance(chunk.value("InstanceGuid"), UUID) for chunk in (part.container, *ports)):
            raise InputError(told, "has no InstanceGuid, or an input or output of it has none; the file is damaged")


def copied(chunk: Chunk) -> Chunk:
    """A chunk of its own with all in it; values are shared, as none of them changes."""
    items = [Item(item.name, item.index, item.type, item.value) for item in chunk.items]
    return Chunk(chunk.name, chunk.index, items, [copied(inner) for inner in chunk.chunks])
