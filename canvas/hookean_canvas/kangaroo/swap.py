"""Swaps one component of Kangaroo for ours: in its place, with its ids, so that wires stay wires."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any
from uuid import UUID, uuid5

from hookean_canvas.archive import Chunk, Type
from hookean_canvas.archive.guids import PARAMETERS, PYTHON3_SCRIPT
from hookean_canvas.archive.parts import Part, bounds_of, inputs, outputs, sources
from hookean_canvas.definitions import containers
from hookean_canvas.definitions.containers import Slot, wire
from hookean_canvas.kangaroo import make
from hookean_canvas.kangaroo.faces import are_faces, handed, takes_meshes
from hookean_canvas.kangaroo.ids import Known, key
from hookean_canvas.kangaroo.pieces import Piece, Swap
from hookean_canvas.kangaroo.recipe import Recipe
from hookean_canvas.kangaroo.roles import Role, called, role, usual
from hookean_canvas.kangaroo.space import size

if TYPE_CHECKING:
    from hookean_canvas.kangaroo.plan import Importing

CARRIED = {"length(line)": "line", "rod": "polyline", "edgelengths": "mesh", "rigidbody": "part"}
"""Goals of Kangaroo 2 whose output is the geometry of one of their inputs."""
FLOATING = {"*geometry": "a Data parameter", "*nothing": "an empty Data parameter"}
"""Pieces that are no component, in words."""
_SHORT = {"mesh": "m", "point": "p"}
SOLVERS = {0: "verlet", 1: "yoshida"}
"""Solvers of classic Kangaroo by the number that its settings have for them."""


class Swapping:
    """One component on its way."""

    def __init__(self, whole: Importing, part: Part, known: Known, swap: Swap) -> None:
        assert part.container is not None and part.id is not None
        self.whole, self.part, self.known, self.swap = whole, part, known, swap
        self.old, self.id = part.container, part.id
        self.given = {key(name): port for port in inputs(self.old) for name in reversed(names_of(port))}
        self.results = {key(name): port for port in outputs(self.old) for name in reversed(names_of(port))}
        self.used: set[UUID] = set()
        self.made: list[Chunk] = []
        self.recipes: list[Recipe] = []

    def run(self) -> None:
        """Make the pieces, then say what found no place."""
        whole = self.whole
        self._in_metres()
        self._in_time()
        if self.swap.pieces[0].bundle in FLOATING:
            self._parameter()
        else:
            for number, piece in enumerate(self.swap.pieces):
                self._piece(number, piece)
            self._feed()
            self._stream()
        self._left()
        words = " and ".join(recipe.name for recipe in self.recipes) or FLOATING[self.swap.pieces[0].bundle]
        whole.report.swapped.append((called(self.part, self.known), words, self.swap.differs))

    def _in_metres(self) -> None:
        """K2Engineering's models are in metres, whatever the unit of the document."""
        if not self._has_data():
            return
        pieces = [
            replace(piece, values={**piece.values, "length_unit": "m"}) if piece.bundle == "Settings" else piece
            for piece in self.swap.pieces
        ]
        self.swap = replace(self.swap, pieces=tuple(pieces))

    def _in_time(self) -> None:
        """Physical time for bombs, and for cloth in the wind, which may flutter for ever without drag."""
        solvers = {piece.values.get("solver") for piece in self.swap.pieces}
        goals = self.whole.systems.goals_of(self.part) if solvers & {"momentum", "bouncy"} else []
        told = "in wind it is played in physical time, with drag" if any(self.whole.swapped("Wind", goals)) else ""
        if not told and "bouncy" in solvers and any(self.whole.swapped("Impulse", goals)):
            told = "with a bomb it is played in physical time"
        if told:
            time = {"solver": "verlet"}
            pieces = (replace(p, values={**p.values, **time}) if "solver" in p.values else p for p in self.swap.pieces)
            self.swap = replace(self.swap, pieces=tuple(pieces), differs=f"{self.swap.differs}; {told}")

    def _has_data(self) -> bool:
        """Whether it is a solver of goals that give out data, or circles, not geometry that they got."""
        if role(self.known) is not Role.SOLVER or self.known.generation != "second":
            return False
        above = [self.whole.known[id(part.chunk)] for part in self.whole.systems.goals_of(self.part)]
        return any(known.generation == "engineering" or key(known.name) == "imagecircles" for known in above if known)

    def _parameter(self) -> None:
        """A floating parameter instead of a component that only hands on, or makes nothing here; the wires out of it
        keep their id."""
        result = outputs(self.old)[0]
        id_: UUID = result.value("InstanceGuid")
        guid = PARAMETERS["Data"]
        chunk = containers.floating(id_, "Data", self.part.label, "Contains a collection of generic data")
        self.used.add(id_)
        self.whole.renamed[self.id] = id_
        if self.swap.pieces[0].bundle == "*geometry":
            given = inputs(self.old)[0]
            connect(chunk, sources(given))
            _copy_modifiers(given, chunk)
            data = given.chunk("PersistentData")
            if data is not None and not sources(given):
                chunk.chunks.append(data)
            self.used.add(given.value("InstanceGuid"))
            self.whole.renamed[given.value("InstanceGuid")] = id_
        self._replace(guid, chunk, (60.0, 20.0))

    def _piece(self, number: int, piece: Piece) -> None:
        recipe = make.recipe(piece.bundle)
        id_ = self.id if number == 0 else uuid5(self.id, f"hookean piece {number}")
        taken: dict[str, Chunk] = {}
        ids = [self._input(id_, piece, slot, taken) for slot in recipe.inputs]
        results = [self._output(id_, piece, slot) for slot in recipe.outputs]
        nickname = self.part.label if number == 0 and key(self.part.label) not in usual(self.known) else ""
        chunk = make.component(recipe, id_, nickname, ids, results)
        self.made.append(chunk)
        self.recipes.append(recipe)
        for name in ("Hidden", "Locked"):
            if self.old.value(name):
                chunk.put(name, Type.BOOL, True)
        box = size([slot.name for slot in recipe.inputs], [slot.name for slot in recipe.outputs])
        if number == 0:
            self._replace(PYTHON3_SCRIPT, chunk, box)
        else:
            x, y, _, high = bounds_of(self.made[0]) or (0.0, 0.0, 0.0, 0.0)
            aside = x - box[0] - 70.0 if piece.feeds else x
            self._add(PYTHON3_SCRIPT, chunk, (aside, y + (0.0 if piece.feeds else high + 20.0)), box)
        for slot, port in zip(recipe.inputs, inputs(chunk), strict=True):
            name = slot.name.strip("_")
            if name in taken:
                self._connect(taken[name], port, slot, also_usual=name in piece.values)
            if name in piece.values and not sources(port):
                self._hold(port, slot, piece.values[name])
            elif piece.bundle == "*indexed" and name == "points":
                connect(port, self.whole.numbered)

    def _input(self, id_: UUID, piece: Piece, slot: Slot, taken: dict[str, Chunk]) -> UUID:
        """The id of an input: Kangaroo's where it stands for one of its inputs, else a new one."""
        name = slot.name.strip("_")
        if piece.bundle == "*indexed" and name == "points" and self.whole.points:
            return self.whole.points.pop(0)
        for old, ours in piece.inputs.items():
            if name in ours.split("|") and old in self.given and name not in taken:
                taken[name] = self.given[old]
                found: UUID = taken[name].value("InstanceGuid")
                if found not in self.used:
                    self.used.add(found)
                    return found
        return uuid5(id_, f"in {slot.name}")

    def _output(self, id_: UUID, piece: Piece, slot: Slot) -> UUID:
        old = piece.outputs.get(slot.name)
        new = uuid5(id_, f"out {slot.name}")
        port = next((self.results[name] for name in (old or "").split("|") if name in self.results), None)
        if port is None and len(piece.outputs) == 1 == len(outputs(self.old)) and old is not None and not piece.feeds:
            port = outputs(self.old)[0]  # its only output, whatever this version calls it
        if port is None:
            return new
        found: UUID = port.value("InstanceGuid")
        if found in self.used:
            self.whole.doubles.append((found, new))
            return new
        self.used.add(found)
        return found

    def _connect(self, old: Chunk, port: Chunk, slot: Slot, also_usual: bool = False) -> None:
        """Wires and modifiers of an input of Kangaroo's, or what is typed into it; `also_usual`: even our default."""
        wired = sources(old)
        if old.value("InternalExpression"):
            return self._express(old, port, slot)
        if takes_meshes(slot.name, names_of(old)) and any(are_faces(self.whole.streams, one) for one in wired):
            return self._mesh(old, port)
        _copy_modifiers(old, port)
        if wired and self._measures(old, slot):
            wired = [self._length(port, wired)]
        if wired:
            connect(port, wired)
            return
        items = make.stored(old)
        value = make.single(old)
        if not items or value is not None and make.usual(slot, value) and not also_usual:
            return
        if slot.name.strip("_") == "solver":
            if value in SOLVERS:
                self._hold(port, slot, SOLVERS[value])
            else:
                self._gone(old, "unknown solver; the Engine chooses one", value)
        elif slot.name.strip("_") == "upper_cutoff" and isinstance(value, (int, float)) and value < 0:
            lower = next(p for p in inputs(self.made[0]) if p.value("Name") == "_lower_cutoff_")
            self._hold(lower, slot, -value)
        elif value is not None:
            self._hold(port, slot, value)
        else:
            id_ = uuid5(port.value("InstanceGuid"), "held")
            guid, chunk, box = make.keeper(id_, _title(slot), old, slot.hint)
            self._beside(port, guid, chunk, box)

    def _express(self, old: Chunk, port: Chunk, slot: Slot) -> None:
        """A parameter with the expression of an input, which scripts cannot have; it takes over the id."""
        given: UUID = port.value("InstanceGuid")
        port.put("InstanceGuid", Type.GUID, uuid5(given, "in expressed"))
        guid, chunk, box = make.expressed(given, _title(slot), old, slot.hint)
        _copy_modifiers(old, chunk)
        connect(chunk, sources(old))
        self._beside(port, guid, chunk, box)

    def _mesh(self, old: Chunk, port: Chunk) -> None:
        """A parameter that makes meshes of what is wired; it takes over the id."""
        given: UUID = port.value("InstanceGuid")
        port.put("InstanceGuid", Type.GUID, uuid5(given, "in meshed"))
        chunk = containers.parameter(given, PARAMETERS["Mesh"], "Mesh", [])
        _copy_modifiers(old, chunk)
        connect(chunk, sources(old))
        self._beside(port, PARAMETERS["Mesh"], chunk, size([], ["Mesh"]))

    def _measures(self, old: Chunk, slot: Slot) -> bool:
        """Whether a length is wired from the very curves it is the length of; Grasshopper measures them."""
        line = next((self.given[name] for name in ("connection", "line") if name in self.given), None)
        name = slot.name.strip("_")
        return name == "rest_length" and line is not None and bool(set(sources(line)) & set(sources(old)))

    def _length(self, port: Chunk, wired: Sequence[UUID]) -> UUID:
        """A Length between curves and an input of ours; it takes over the input's id, so that the wire stays."""
        given: UUID = port.value("InstanceGuid")
        result, id_ = uuid5(given, "length out"), uuid5(given, "length")
        port.put("InstanceGuid", Type.GUID, uuid5(given, "in rest length"))
        chunk = make.length(id_, given, result)
        connect(inputs(chunk)[0], wired)
        self._beside(port, make.LENGTH, chunk, (75.0, 28.0), wire_it=False)
        return result

    def _hold(self, port: Chunk, slot: Slot, value: Any) -> None:
        id_ = uuid5(port.value("InstanceGuid"), "held")
        self._beside(port, *make.holder(id_, _title(slot), value))

    def _beside(self, port: Chunk, guid: UUID, chunk: Chunk, box: tuple[float, float], wire_it: bool = True) -> None:
        x, y, *_ = bounds_of(port) or (0.0, 0.0)
        self._add(guid, chunk, (x - box[0] - 60.0, y), box)
        if wire_it:
            connect(port, [chunk.value("InstanceGuid")])

    def _feed(self) -> None:
        """Wires between the pieces."""
        for piece, chunk in zip(self.swap.pieces, self.made, strict=True):
            ours = {port.value("Name"): port.value("InstanceGuid") for port in outputs(chunk)}
            for output, targets in piece.feeds.items():
                for target in targets.split("|"):
                    number, name = target.split(".")
                    connect(_input_of(self.made[int(number)], name), [ours[output]])

    def _stream(self) -> None:
        """A solver of Kangaroo 2 takes everything by one input: sort it, and carry what the goals would show."""
        stream = self.given.get("goalobjects")
        if stream is None or self.recipes[0].name != make.recipe("Engine").name:
            return
        whole = self.whole
        above = whole.systems.goals_of(self.part)
        shown = list(whole.swapped("*geometry", above))
        if self._has_data():
            self._outputs()
        if shown or any(whole.swapped("Anchors", above)) or any(whole.swapped("*support", above)):
            self._sort()
        result = self.results.get("o")
        if shown or self._has_data() or result is None or not whole.streams.taken(result.value("InstanceGuid")):
            return
        carried = [
            source
            for part in above
            if (known := whole.known[id(part.chunk)]) and key(known.name) in CARRIED
            for port in whole.streams.inputs_before(part)
            if key(CARRIED[key(known.name)]) in map(key, names_of(port))
            for source in handed(whole.streams, port)
        ]
        connect(_input_of(self.made[0], "geometry"), carried)

    def _outputs(self) -> None:
        """A script that gives the outputs of goals in their tree; it takes over the id of the solver's output."""
        result = self.results.get("o")
        if result is None or not self.whole.streams.taken(result.value("InstanceGuid")):
            return
        forces, engine = _input_of(self.made[0], "forces"), self.made[0]
        given = next(port for port in outputs(engine) if port.value("InstanceGuid") == result.value("InstanceGuid"))
        recipe = make.recipe("*outputs")
        id_ = uuid5(self.id, "hookean outputs")
        ids = [uuid5(id_, slot.name) for slot in recipe.inputs]
        chunk = make.component(recipe, id_, "", ids, [result.value("InstanceGuid")])
        given.put("InstanceGuid", Type.GUID, uuid5(id_, "geometry"))
        of = {port.value("Name"): port.value("InstanceGuid") for port in outputs(engine)}
        goals, results, reactions, geometry = inputs(chunk)
        connect(goals, sources(forces))
        _copy_modifiers(forces, goals)
        for port, name in ((results, "results"), (reactions, "reactions"), (geometry, "geometry")):
            connect(port, [of[name]])
        box = size([slot.name for slot in recipe.inputs], [slot.name for slot in recipe.outputs])
        x, y, wide, _ = bounds_of(engine) or (0.0, 0.0, 0.0, 0.0)
        self._add(PYTHON3_SCRIPT, chunk, (x + wide + 40.0, y), box)

    def _sort(self) -> None:
        forces = _input_of(self.made[0], "forces")
        given, wired = forces.value("InstanceGuid"), sources(forces)
        recipe = make.recipe("*sort")
        id_ = uuid5(self.id, "hookean sort")
        results = [uuid5(id_, slot.name) for slot in recipe.outputs]
        chunk = make.component(recipe, id_, "", [given], results)
        connect(inputs(chunk)[0], wired)
        forces.put("InstanceGuid", Type.GUID, uuid5(self.id, "in forces"))
        for slot, result in zip(recipe.outputs, results, strict=True):
            connect(_input_of(self.made[0], slot.name), [result])
        box = size(["_goals"], [slot.name for slot in recipe.outputs])
        x, y, *_ = bounds_of(self.made[0]) or (0.0, 0.0)
        self._add(PYTHON3_SCRIPT, chunk, (x - box[0] - 60.0, y - box[1] - 20.0), box)

    def _left(self) -> None:
        """Inputs and outputs that found no place: their wires and typed values."""
        for port in {id(port): port for port in self.given.values()}.values():
            found = port.value("InstanceGuid")
            if found in self.used:
                continue
            why = next(
                (w for k, w in self.swap.without.items() if k in map(key, names_of(port))), "it has no counterpart"
            )
            self.whole.because[found] = why
            expected = next((v for k, v in self.swap.usual.items() if k in map(key, names_of(port))), make)
            given = [make.constant(self.whole.streams.owner(one)) for one in sources(port)]
            if set(self.swap.idle) & set(map(key, names_of(port))) or set(given) == {expected} != {None}:
                self.whole.idle.add(found)
            value = make.single(port)
            if not sources(port) and make.stored(port) and expected is not None and value != expected:
                self._gone(port, why, value)
        for port in outputs(self.old):
            if port.value("InstanceGuid") not in self.used:
                self.whole.because[port.value("InstanceGuid")] = "it has no counterpart"

    def _gone(self, port: Chunk, why: str, value: Any = None) -> None:
        typed = f" = {value:g}" if isinstance(value, float) else f" = {value}" if value is not None else ""
        where = f"{called(self.part, self.known)}, {names_of(port)[0]}{typed}"
        self.whole.report.values.append((where, why))

    def _replace(self, guid: UUID, chunk: Chunk, box: tuple[float, float]) -> None:
        x, y, *_ = bounds_of(self.old) or (0.0, 0.0)
        make.fill(self.part.chunk, guid, chunk)
        self.whole.space.taken.pop(id(self.old), None)
        self.whole.space.put(chunk, (x, y, *box))

    def _add(self, guid: UUID, chunk: Chunk, at: tuple[float, float], box: tuple[float, float]) -> None:
        make.put_object(self.whole.objects, guid, chunk)
        self.whole.space.put(chunk, self.whole.space.free(*at, *box))


def connect(port: Chunk, wired: Sequence[UUID]) -> None:
    """Give an input these wires and no others."""
    port.items = [item for item in port.items if item.name != "Source"]
    wire(port, list(dict.fromkeys(wired)), port.value("Mapping", default=0))


def _title(slot: Slot) -> str:
    return slot.name.strip("_").replace("_", " ").capitalize()


def ports_of(part: Part) -> list[Chunk]:
    """The inputs of an object."""
    return inputs(part.container) if part.container is not None else []


def names_of(port: Chunk) -> list[str]:
    """The name and the nickname of an input or output, and the short name that some versions give it."""
    names = [str(port.value("Name", default="")), str(port.value("NickName", default=""))]
    return names + [_SHORT[key(name)] for name in names if key(name) in _SHORT]


def _input_of(chunk: Chunk, name: str) -> Chunk:
    return next(port for port in inputs(chunk) if str(port.value("Name")).strip("_") == name)


def _copy_modifiers(old: Chunk, new: Chunk) -> None:
    """Flatten or graft, reverse and simplify."""
    for name, type_ in (("Mapping", Type.INT32), ("ReverseData", Type.BOOL), ("SimplifyData", Type.BOOL)):
        value = old.value(name)
        if value:
            new.put(name, type_, value)
