"""Write a definition as a person would lay it out: sliders, components, wires, groups with titles, notes.

    d = Definition("cable", "A hanging cable", "Ten springs under their loads.")
    with d.group("Cable"):
        line = d.native("Line", start_point=d.point(0, 0, 0), end_point=d.point(10, 0, 0))
        pieces = d.component("Shatter", curve=line, count=d.slider("Springs", 10, 1, 50))
    with d.group("Forces"):
        stiffness = d.slider("Stiffness [N/m]", 1000, 1, 5000)
        springs = d.component("Springs", connection=pieces["lines"], stiffness=stiffness)
    d.save(Path("cable.ghx"))

The same calls write the same bytes: ids are of the definition's key and of the order in which things are made.
"""

from __future__ import annotations

import textwrap
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any
from uuid import NAMESPACE_URL, UUID, uuid5

from hookean_canvas import archive
from hookean_canvas.archive import Chunk, Type, guids
from hookean_canvas.components import bundles, inline
from hookean_canvas.definitions import containers, layout
from hookean_canvas.definitions.containers import Slot
from hookean_canvas.run.natives import BY_NAME

ROW, CHARACTER = 20.0, 6.2
"""Height of a row of a component, and width of a letter, in pixels of the canvas."""
COLOURS = (
    (120, 150, 190, 215), (120, 190, 215, 150), (120, 235, 200, 140), (120, 215, 170, 200), (120, 200, 200, 200),
)  # fmt: skip
SHARED = 4
"""From so many wires into other groups on, those of an object are drawn faint."""
NOTE = (255, 245, 245, 245)


@dataclass(frozen=True)
class Output:
    """An output that a wire can leave."""

    owner: Made
    id: UUID
    name: str


@dataclass
class Made:
    """An object on the canvas. `made["lines"]` is an output by its name; one with a single output is that output."""

    id: UUID
    guid: UUID
    kind: str
    container: Chunk
    inputs: dict[str, tuple[UUID, Chunk]]
    outputs: dict[str, tuple[UUID, Chunk]]
    size: tuple[float, float]
    sources: dict[str, list[Output]] = field(default_factory=dict)
    library: UUID | None = None
    box: layout.Box = field(default_factory=lambda: layout.Box(0.0, 0.0))

    def __getitem__(self, name: str) -> Output:
        if name not in self.outputs:
            raise KeyError(f"{self.kind} has no output {name!r}; it has {', '.join(self.outputs)}")
        return Output(self, self.outputs[name][0], name)


@dataclass(frozen=True)
class Wired:
    """Sources of one input, flattened (1) or grafted (2) as they come in."""

    sources: tuple[Any, ...]
    mapping: int


def flat(*sources: Any) -> Wired:
    """Sources of an input that flattens them."""
    return Wired(sources, 1)


def graft(*sources: Any) -> Wired:
    """Sources of an input that grafts them."""
    return Wired(sources, 2)


class Definition:
    """A definition being written. `key` is short and the definition's own: its ids are made of it."""

    def __init__(self, key: str, title: str, description: str) -> None:
        self.key, self.title, self.description = key, title, description
        self._made: list[Made] = []
        self._groups: list[tuple[str, list[Made], list[Made]]] = []
        self._loose: list[Made] = []
        self._inside: tuple[str, list[Made], list[Made]] | None = None
        self.note(f"{title}\n\n{description}")

    @contextmanager
    def group(self, title: str, note: str = "") -> Iterator[None]:
        """What is made inside stands in a group of this title, with a note over it where one is given."""
        assert self._inside is None, "groups cannot contain groups"
        self._inside = (title, [], [])
        self._groups.append(self._inside)
        if note:
            self.note(note)
        yield
        self._inside = None

    def slider(self, name: str, value: float, low: float, high: float, decimals: int = 0) -> Made:
        """A number slider; whole numbers where there are no decimals."""
        assert low <= value <= high and round(value, decimals) == value, f"{name}: {value} is not on the slider"
        id_ = self._id("slider", name)
        container = containers.slider(id_, name, value, low, high, decimals)
        return self._float(id_, guids.NUMBER_SLIDER, "slider", container, (150.0 + CHARACTER * len(name), 20.0))

    def toggle(self, name: str, value: bool) -> Made:
        """A boolean toggle."""
        id_ = self._id("toggle", name)
        container = containers.toggle(id_, name, value)
        return self._float(id_, guids.BOOLEAN_TOGGLE, "toggle", container, (60.0 + CHARACTER * len(name), 22.0))

    def choice(self, name: str, choices: Mapping[str, str], selected: str) -> Made:
        """A drop-down list; `choices` are expressions (a text in quotes) by what a person reads."""
        id_ = self._id("choice", name)
        container = containers.value_list(id_, name, choices, selected)
        width = CHARACTER * (len(name) + max(map(len, choices))) + 60.0
        return self._float(id_, guids.VALUE_LIST, "value list", container, (width, 22.0))

    def text(self, name: str, text: str) -> Made:
        """A panel that holds a text or number for others to use."""
        id_ = self._id("text", name)
        size = (max(110.0, CHARACTER * max(len(name), len(text)) + 30.0), 44.0)
        return self._float(id_, guids.PANEL, "panel", containers.panel(id_, name, text), size)

    def panel(self, name: str, source: Made | Output) -> Made:
        """A panel that shows what reaches it; its name is what `hookean canvas run` prints and compares."""
        id_ = self._id("panel", name)
        size = (max(150.0, CHARACTER * len(name) + 30.0), 44.0)
        made = self._float(id_, guids.PANEL, "panel", containers.panel(id_, name, ""), size)
        self._wire(made, "in", source)
        return made

    def parameter(self, kind: str, name: str, values: Sequence[Any] = (), source: Any = None) -> Made:
        """A floating parameter ("Point", "Number", "Curve" ...) with data of its own, or fed by a wire."""
        id_ = self._id("parameter", name)
        guid = guids.PARAMETERS[kind]
        container = containers.parameter(id_, guid, name, values)
        made = self._float(id_, guid, kind, container, (CHARACTER * len(name) + 36.0, 20.0))
        if source is not None:
            self._wire(made, "in", source)
        return made

    def point(self, x: Any, y: Any, z: Any) -> Made:
        """Grasshopper's Construct Point from numbers, sliders or outputs."""
        return self.native("Construct Point", x_coordinate=x, y_coordinate=y, z_coordinate=z)

    def native(self, name: str, nickname: str = "", **inputs: Any) -> Made:
        """One of Grasshopper's own components; inputs by their names in lower case with _, numbers set as its data."""
        of = BY_NAME[name]
        id_ = self._id("native", name)
        ids = [uuid5(id_, f"in {i}") for i in range(len(of.inputs))]
        results = [uuid5(id_, f"out {i}") for i in range(len(of.outputs))]
        container = containers.native(id_, of, nickname or of.nickname, ids, results)
        rows = [chunk for chunk in container.chunks if chunk.name.startswith("param_")]
        keys = [given.name.lower().replace(" ", "_") for given in of.inputs]
        made = Made(
            id_, of.guid, name, container,
            dict(zip(keys, zip(ids, rows, strict=False), strict=False)),
            dict(zip([o.name for o in of.outputs], zip(results, rows[len(ids) :], strict=True), strict=True)),
            _size(nickname or of.nickname, [i.nickname for i in of.inputs], [o.nickname for o in of.outputs]),
        )  # fmt: skip
        kinds = {key: given.kind for key, given in zip(keys, of.inputs, strict=True)}
        return self._component(made, inputs, kinds)

    def component(self, bundle: str, nickname: str = "", **inputs: Any) -> Made:
        """One of hookean's components; inputs by nickname without the underscores at its ends."""
        found = bundles.read(bundle)
        slots = [
            [Slot(p.name, p.description, p.access, p.hint, p.optional, p.mapping) for p in side]
            for side in (found.inputs, found.outputs)
        ]
        code = _inlined(found.code)
        description = found.description
        return self._script(found.name, nickname or found.nickname, description, code, slots[0], slots[1], inputs)

    def script(
        self, name: str, code: str, inputs: Mapping[str, Any], outputs: Sequence[str], lists: Sequence[str] = (),
        trees: Sequence[str] = (), description: str = "",
    ) -> Made:  # fmt: skip
        """A Python 3 Script component; inputs in `lists` and `trees` have that access, the others take one item.

        Code that imports `hookean_client` carries it along.
        """
        access = {key: 1 if key in lists else 2 if key in trees else 0 for key in inputs}
        ins = [Slot(key, access=access[key], optional=False) for key in inputs]
        outs = [Slot(key.replace(" ", "_")) for key in outputs]
        body = textwrap.dedent(code).strip() + "\n"
        body = _inlined(body) if "hookean_client" in body else "#! python 3\n" + body
        return self._script("Python 3 Script", name, description or name, body, ins, outs, inputs)

    def numbers(
        self, code: str, inputs: Mapping[str, Any], names: Mapping[str, str], lists: Sequence[str] = (),
        trees: Sequence[str] = (),
    ) -> None:  # fmt: skip
        """The numbers of a figure: a script, and for each output a panel named as expected.json names the number.

        `names`: number by variable.
        """
        made = self.script("Numbers", code, inputs, list(names), lists, trees)
        for variable, number in names.items():
            self.panel(number, made[variable])

    def note(self, text: str) -> Made:
        """A panel with words for the reader: over its group, or over the whole definition."""
        id_ = self._id("note", text[:40])
        lines = [line for part in text.split("\n") for line in textwrap.wrap(part, 60) or [""]]
        size = (CHARACTER * max(map(len, lines)) + 40.0, 18.0 * len(lines) + 30.0)
        container = containers.panel(id_, "", text, NOTE)
        made = Made(id_, guids.PANEL, "note", container, {}, {"out": (id_, container)}, size)
        self._made.append(made)
        (self._inside[2] if self._inside is not None else self._loose).append(made)
        return made

    def archive(self) -> Chunk:
        """The definition as an archive."""
        self._arrange()
        root = Chunk("Root").put("ArchiveVersion", Type.VERSION, (0, 2, 2))
        self._soften()
        definition = root.add("Definition").put("plugin_version", Type.VERSION, (1, 0, 8))
        containers.header(
            definition, uuid5(NAMESPACE_URL, f"hookean definition {self.key}"), self.title, self.description
        )
        objects = definition.add("DefinitionObjects")
        for made in sorted(self._made, key=_order):
            self._finish(made)
            self._object(objects, made.guid, made.container, made.library)
        for i, (title, members, notes) in enumerate(self._groups):
            ids = [made.id for made in notes + members]
            chunk = containers.group(self._id("group", title), title, COLOURS[i % len(COLOURS)], ids)
            self._object(objects, guids.GROUP, chunk, None)
        objects.put("ObjectCount", Type.INT32, len(objects.chunks))
        return root

    def save(self, path: Path) -> None:
        """Write the definition; the suffix selects XML (.ghx) or binary (.gh)."""
        archive.write(self.archive(), path)

    def _id(self, kind: str, name: str) -> UUID:
        return uuid5(NAMESPACE_URL, f"hookean definition {self.key}: {len(self._made)} {kind} {name}")

    def _float(self, id_: UUID, guid: UUID, kind: str, container: Chunk, size: tuple[float, float]) -> Made:
        return self._add(Made(id_, guid, kind, container, {"in": (id_, container)}, {"out": (id_, container)}, size))

    def _add(self, made: Made) -> Made:
        self._made.append(made)
        if self._inside is not None:
            self._inside[1].append(made)
        return made

    def _script(
        self, name: str, nickname: str, description: str, code: str, ins: Sequence[Slot], outs: Sequence[Slot],
        inputs: Mapping[str, Any],
    ) -> Made:  # fmt: skip
        id_ = self._id("script", nickname)
        given = [(uuid5(id_, f"in {slot.name}"), slot) for slot in ins]
        results = [(uuid5(id_, f"out {slot.name}"), slot) for slot in outs]
        container = containers.script(id_, name, nickname, description, code, given, results)
        data = container.chunk("ParameterData")
        assert data is not None
        size = _size(nickname, [slot.name for slot in ins], [slot.name for slot in outs])
        sides = [[c for c in data.chunks if c.name == f"{side}Param"] for side in ("Input", "Output")]
        made = Made(
            id_, guids.PYTHON3_SCRIPT, nickname, container,
            {slot.name.strip("_"): (of, chunk) for (of, slot), chunk in zip(given, sides[0], strict=True)},
            {slot.name: (of, chunk) for (of, slot), chunk in zip(results, sides[1], strict=True)},
            size, library=guids.SCRIPT_LIBRARY,
        )  # fmt: skip
        return self._component(made, inputs, {})

    def _component(self, made: Made, inputs: Mapping[str, Any], kinds: Mapping[str, str]) -> Made:
        self._add(made)
        for key, value in inputs.items():
            if key.strip("_") not in made.inputs:
                raise KeyError(f"{made.kind} has no input {key!r}; it has {', '.join(made.inputs)}")
            if isinstance(value, (int, float)) and key in kinds:
                chunk = made.inputs[key][1]
                try:
                    stored = containers.typed(kinds[key], value)
                except KeyError:
                    raise TypeError(f"{made.kind}, {key}: {value!r} is a number, and this input takes a {kinds[key]}; "
                                    "connect an object that gives one") from None  # fmt: skip
                chunk.chunks = [c for c in chunk.chunks if c.name != "PersistentData"]
                containers.persistent(chunk, kinds[key], [stored])
            else:
                self._wire(made, key.strip("_"), value)
        return made

    def _wire(self, made: Made, key: str, value: Any) -> None:
        wired = value if isinstance(value, Wired) else Wired(tuple(value) if isinstance(value, list) else (value,), 0)
        sources = [_output(source, made.kind, key) for source in wired.sources]
        made.sources[key] = sources
        containers.wire(made.inputs[key][1], [source.id for source in sources], wired.mapping)

    def _arrange(self) -> None:
        placed = [made for made in self._made if made.kind != "note"]
        boxes: layout.Boxes = {made.id: layout.Box(*made.size) for made in placed}
        links = [
            layout.Link(
                source.owner.id, made.id, _height(source.owner, "outputs", source.name), _height(made, "inputs", key)
            )
            for made in placed for key, sources in made.sources.items() for source in sources
        ]  # fmt: skip
        heads = [
            (max((note.size[0] for note in notes), default=0.0), sum(note.size[1] + layout.DOWN for note in notes))
            for _, _, notes in self._groups
        ]
        layout.arrange(boxes, links, [[m.id for m in members] for _, members, _ in self._groups], heads)
        for made in placed:
            made.box = boxes[made.id]
        for _, members, notes in self._groups:
            left = min(made.box.x for made in members)
            top = min(made.box.y for made in members)
            for note in reversed(notes):
                top -= note.size[1] + layout.DOWN
                note.box = layout.Box(*note.size, left, top)
        top = (
            min(made.box.y for made in self._made if made not in self._loose or made.kind != "note") - 2 * layout.TITLE
        )
        left = min(made.box.x for made in placed)
        for note in reversed(self._loose):
            top -= note.size[1] + layout.DOWN
            note.box = layout.Box(*note.size, left, top)

    def _soften(self) -> None:
        """Faint wires where one object feeds several in other groups, as a person sets them for shared values."""
        group = {made.id: i for i, (_, members, _) in enumerate(self._groups) for made in members}
        far = Counter(
            source.owner.id for made in self._made for sources in made.sources.values() for source in sources
            if group.get(source.owner.id) != group.get(made.id)
        )  # fmt: skip
        for made in self._made:
            for key, sources in made.sources.items():
                if sources and all(far[source.owner.id] >= SHARED for source in sources):
                    made.inputs[key][1].put("WireDisplay", Type.INT32, 1)

    def _finish(self, made: Made) -> None:
        """Bounds of an object and of its inputs and outputs, from its box."""
        x, y, (width, height) = round(made.box.x), round(made.box.y), made.size
        containers.place(made.container, (float(x), float(y), width, height))
        if made.kind == "note" or "in" in made.inputs and made.inputs["in"][1] is made.container:
            return
        for side, left in ((made.inputs, True), (made.outputs, False)):
            rows = len(side)
            for i, (name, (_, chunk)) in enumerate(side.items()):
                row = (height - 4.0) / rows
                wide = CHARACTER * len(chunk.value("NickName", default=name)) + 8.0
                at = x + 2.0 if left else x + width - 2.0 - wide
                containers.place(chunk, (at, y + 2.0 + i * row, wide, row))

    def _object(self, objects: Chunk, guid: UUID, container: Chunk, library: UUID | None) -> None:
        chunk = objects.add("Object", len(objects.chunks)).put("GUID", Type.GUID, guid)
        name = "Python 3 Script" if guid == guids.PYTHON3_SCRIPT else container.value("Name")
        chunk.put("Name", Type.STRING, name)
        if library is not None:
            chunk.put("Lib", Type.GUID, library)
        chunk.chunks.append(container)


@cache
def _inlined(code: str) -> str:
    return inline.inlined(code, "rhino8")


def _order(made: Made) -> tuple[int, int]:
    """Scripts of about one length side by side, those with most inputs first: the compression, which looks back by 32
    kB, then stores once what they share."""
    script = made.container.chunk("Script")
    return (len(str(script.value("Text"))) // 4096, -len(made.inputs)) if script is not None else (-1, 0)


def _output(source: Any, kind: str, key: str) -> Output:
    if isinstance(source, Output):
        return source
    if isinstance(source, Made):
        if len(source.outputs) != 1:
            raise KeyError(
                f"{kind}, {key}: {source.kind} has several outputs; select one of {', '.join(source.outputs)}"
            )
        return source[next(iter(source.outputs))]
    raise TypeError(f"{kind}, {key}: {source!r} is not an object on the canvas; use a slider, a panel or an output")


def _size(nickname: str, inputs: Sequence[str], outputs: Sequence[str]) -> tuple[float, float]:
    wide = [CHARACTER * max((len(name) for name in side), default=0) + 8.0 for side in (inputs, outputs)]
    return sum(wide) + 32.0, ROW * max(len(inputs), len(outputs), 1) + 4.0


def _height(made: Made, side: str, name: str) -> float:
    """How far below its top a wire leaves or enters."""
    ports: dict[str, Any] = getattr(made, side)
    return 2.0 + (list(ports).index(name) + 0.5) * (made.size[1] - 4.0) / len(ports)
