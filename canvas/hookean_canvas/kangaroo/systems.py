"""The systems of Kangaroo in a definition: each solver with the goals that flow into it, and what else does.

A solver takes goals from its own kind only, so a system is translated whole or not at all. Goals are followed upstream
through what hands on data of any kind: parameters, relays, merges, lists, trees, clusters. Whatever else stands where a
goal comes from, of another plug-in or a script, is taken for a maker of goals.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from uuid import UUID

from hookean.errors import InputError
from hookean_canvas import archive
from hookean_canvas.archive import Chunk, guids, native_guids
from hookean_canvas.archive.chunk import CLUSTERS
from hookean_canvas.archive.parts import SCRIPTS, Part, outputs, sources
from hookean_canvas.archive.parts import libraries as libraries_of
from hookean_canvas.kangaroo.ids import Generation, Known, hidden, key, libraries, recognised
from hookean_canvas.kangaroo.roles import Role, called, role
from hookean_canvas.kangaroo.streams import Streams

GOALS_IN = {"classic": ("forceobjects", "settings"), "second": ("goalobjects",)}
"""The inputs of a solver that goals, and in classic Kangaroo its settings, flow into."""
SHAPES_IN = {"classic": ("anchorpoints", "geometry"), "second": ()}
"""Those that geometry flows into."""

_DATA = UUID("8ec86459-bf01-4409-baee-174d0d2b13d0")
_DATA_DAM = UUID("65283518-ad00-49d3-87fb-f76823ebb162")
_CARRIERS = {_DATA, _DATA_DAM, guids.RELAY} | {UUID(line[:36]) for line in native_guids.SETS.split("\n") if line}
"""Grasshopper's own objects that hand on data of any kind; its others make or change values of one kind."""
_BESIDE_NAMES = """
index indices gate pattern path paths mask masks count number length size seed shift wrap domain frequency
reduction keys guide search replace offset depth key
"""
_BESIDE = frozenset(_BESIDE_NAMES.split())
"""Inputs of those that steer them and hand on nothing, by name."""
_TEXT_SCRIPTS = {UUID("a9a8ebd2-fff5-4c44-a8f5-739736d129ba"), UUID("079bd9bd-54a0-41d4-98af-db999015f63d")}
"""The C# and VB scripts of Rhino 5 to 7."""


@dataclass(eq=False)
class System:
    """Solvers that share goals, mostly one, with all their goals; it can be translated where nothing is in `blocks`.

    `blocks`: what stands in the way, by name; `foreign`: (what, why) for those of it that are not Kangaroo's.
    """

    solvers: list[Part]
    goals: list[Part] = field(default_factory=list)
    blocks: list[str] = field(default_factory=list)
    foreign: list[tuple[str, str]] = field(default_factory=list)


class Systems:
    """All systems of a definition. `why_not(part, known)`: why a component of Kangaroo has no counterpart, or None."""

    def __init__(
        self,
        root: Chunk,
        streams: Streams,
        known: dict[int, Known | None],
        why_not: Callable[[Part, Known], str | None],
    ) -> None:
        definition = root.chunk("Definition")
        assert definition is not None
        self._streams, self._known, self._why_not = streams, known, why_not
        self._generations = libraries(definition)
        self._plugins = libraries_of(definition)
        self._kinds: dict[int, str] = {}
        self.found: list[System] = []
        for part in streams.parts:
            if self._role(part, stream=True) is Role.SOLVER:
                self._join(self._of(part))

    def goals_of(self, solver: Part) -> list[Part]:
        """The goals, and in classic Kangaroo the settings, that flow into a solver, in the order of the file."""
        return self._upstream(solver)[0]

    def orphans(self) -> Iterator[tuple[Part, list[str]]]:
        """Goals that flow into no solver, each with the names of the objects of others that take them."""
        held = {id(goal.chunk) for system in self.found for goal in system.goals}
        for part in self._streams.parts:
            if self._role(part, stream=False) is Role.GOAL and id(part.chunk) not in held:
                yield part, list(dict.fromkeys(self._named(taker) for taker in self._downstream(part)))

    def _join(self, new: System) -> None:
        """Take up a system, as one with those that share a goal with it."""
        mine = {id(goal.chunk) for goal in new.goals}
        shared = [old for old in self.found if mine & {id(goal.chunk) for goal in old.goals}]
        self.found = [old for old in self.found if old not in shared]
        for old in shared:
            new.solvers = old.solvers + new.solvers
            new.goals = list({id(goal.chunk): goal for goal in old.goals + new.goals}.values())
            new.blocks = list(dict.fromkeys(old.blocks + new.blocks))
            new.foreign = list(dict.fromkeys(old.foreign + new.foreign))
        self.found.append(new)

    def _of(self, solver: Part) -> System:
        """A solver with its goals, and all that stands in the way of its translation."""
        goals, makers = self._upstream(solver)
        ours = [(part, known) for part in (solver, *goals) if (known := self._known[id(part.chunk)])]
        blocks = [called(part, known) for part, known in ours if self._why_not(part, known)]
        made = {id(part.chunk) for part in makers}
        takers = {id(taker.chunk): taker for goal in goals for taker in self._downstream(goal)}
        foreign = [(part, "makes goals for") for part in makers] + [
            (takers[key], "takes goals of") for key in takers if key not in made
        ]
        told = [(self._named(part), f"it {does} {solver.label} and is not Kangaroo's") for part, does in foreign]
        return System([solver], goals, list(dict.fromkeys(blocks + [what for what, _ in told])), told)

    def _upstream(self, solver: Part) -> tuple[list[Part], list[Part]]:
        """Goals that flow into a solver, and objects of others that stand where goals come from; in file order."""
        known = self._known[id(solver.chunk)]
        assert known is not None
        waiting: list[tuple[UUID, bool]] = []
        for port in self._streams.inputs_before(solver):
            names = {key(str(port.value(name, default=""))) for name in ("Name", "NickName")}
            for wanted, stream in ((GOALS_IN, True), (SHAPES_IN, False)):
                if names & set(wanted[known.generation]):
                    waiting += [(source, stream) for source in sources(port)]
        goals, foreign, seen = set(), set(), set(waiting)
        while waiting:
            source, stream = waiting.pop()
            part = self._streams.owner(source)
            if part is None:
                continue
            found = self._role(part, stream)
            if found is Role.SOLVER:
                continue  # another system; what comes out of it is geometry
            if found is Role.GOAL:
                goals.add(id(part.chunk))
            elif stream and self._is_foreign(part):
                foreign.add(id(part.chunk))
            for step in self._before(part, stream and found is None):
                if step not in seen:
                    seen.add(step)
                    waiting.append(step)
        order = self._streams.parts
        return [p for p in order if id(p.chunk) in goals], [p for p in order if id(p.chunk) in foreign]

    def _before(self, part: Part, stream: bool) -> Iterator[tuple[UUID, bool]]:
        """The outputs wired into an object, each with whether goals can come from it."""
        for port in self._streams.inputs_before(part):
            for source in sources(port):
                yield source, stream and self._carries(part, port)

    def _downstream(self, goal: Part) -> list[Part]:
        """Objects of others, no solvers of Kangaroo, that a goal flows into; it comes out of its first output."""
        waiting, seen, found = _ids(goal)[:1], {id(goal.chunk)}, []
        while waiting:
            for taker, into in self._streams.takers(waiting.pop()):
                known = id(taker.chunk) in seen or self._role(taker, stream=True) is not None
                if known or not self._carries(taker, into):
                    continue
                seen.add(id(taker.chunk))
                if self._is_foreign(taker):
                    found.append(taker)
                else:
                    waiting += _ids(taker)
        return found

    def _role(self, part: Part, stream: bool) -> Role | None:
        """What a component of Kangaroo is for; None for any other object."""
        known = self._known[id(part.chunk)]
        return role(known, stream) if known is not None else None

    def _carries(self, part: Part, port: Chunk) -> bool:
        """Whether goals that come into this input can go on from the object."""
        if part.guid in _CARRIERS:
            return key(str(port.value("Name", default=""))) not in _BESIDE
        return part.guid not in guids.NAMES or part.guid == guids.CLUSTER or self._is_foreign(part)

    def _is_foreign(self, part: Part) -> bool:
        """Whether an object may make or take goals though it is not Kangaroo's: of a plug-in, a script, a cluster."""
        return bool(self._kind(part))

    def _named(self, part: Part) -> str:
        """An object of others by its name, its nickname and where it is from."""
        nickname = f' "{part.label}"' if part.label != part.name else ""
        return f"{part.name or 'an object without a name'}{nickname} ({self._kind(part)})"

    def _kind(self, part: Part) -> str:
        """What an object is that is neither Grasshopper's own nor Kangaroo's, in words; empty for those."""
        found = self._kinds.get(id(part.chunk))
        if found is None:
            found = self._kinds[id(part.chunk)] = foreign(part.chunk, self._generations, self._plugins)
        return found


def _ids(part: Part) -> list[UUID]:
    """The ids of an object's outputs."""
    return [port.value("InstanceGuid") for port in outputs(part.container)] if part.container is not None else []


def foreign(thing: Chunk, of: dict[UUID, Generation], named: dict[UUID, str], depth: int = 0) -> str:
    """What an object is that may make goals without being Kangaroo's, in words; empty where it cannot."""
    guid, library = thing.value("GUID"), thing.value("Lib")
    if guid in SCRIPTS or guid in _TEXT_SCRIPTS:
        return "a script"
    container = thing.chunk("Container")
    if container is not None and container.item("ClusterDocument") is not None:
        return _cluster(container, of, depth)
    if library is None or guid in guids.NAMES and guid != guids.HOPS:
        return hidden(thing, of) or ""
    return f"plug-in {named.get(library) or library}"


def _cluster(container: Chunk, of: dict[UUID, Generation], depth: int) -> str:
    document = container.value("ClusterDocument")
    try:
        inside = archive.of_bytes(document, "cluster") if isinstance(document, bytes) and depth < CLUSTERS else None
    except InputError:
        inside = None
    if inside is None:
        return "a cluster that cannot be opened"
    definition = inside.chunk("Definition") or inside
    generations, named = of | libraries(definition), libraries_of(definition)
    held: list[str] = []
    for thing in definition.walk():
        if thing.name == "Object":
            known = recognised(thing, generations)
            what = f"{known.name} of Kangaroo" if known else foreign(thing, generations, named, depth + 1)
            held += [what] if what else []
    return f"a cluster that holds {', '.join(dict.fromkeys(held))}" if held else ""
