"""Decides what of Kangaroo in a definition is swapped for ours: whole systems, and tools; and has it swapped."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from uuid import UUID

from hookean.errors import InputError
from hookean_canvas.archive import Chunk
from hookean_canvas.archive.guids import CLUSTER
from hookean_canvas.archive.parts import Part, bounds_of, inputs, outputs, parts, sources
from hookean_canvas.kangaroo import make
from hookean_canvas.kangaroo.ids import Generation, Known, hidden, key, libraries, recognised
from hookean_canvas.kangaroo.opening import open_clusters
from hookean_canvas.kangaroo.pieces import Swap
from hookean_canvas.kangaroo.report import Report
from hookean_canvas.kangaroo.roles import Role, called, reason, role
from hookean_canvas.kangaroo.room import make_room
from hookean_canvas.kangaroo.space import Space, size
from hookean_canvas.kangaroo.streams import Streams, sound
from hookean_canvas.kangaroo.swap import FLOATING, Swapping, connect, names_of, ports_of
from hookean_canvas.kangaroo.systems import System, Systems
from hookean_canvas.kangaroo.table import swap_of


class Importing:
    """One definition on its way; `root` is changed in place."""

    def __init__(self, root: Chunk, report: Report) -> None:
        definition = root.chunk("Definition")
        objects = definition.chunk("DefinitionObjects") if definition is not None else None
        if definition is None or objects is None:
            raise InputError(report.name, "this is not a Grasshopper definition; give a .gh or .ghx file")
        sound(root, report.name)
        report.notes += open_clusters(root, lambda part: self._recognised(part, libraries(definition)) is not None)
        self.root, self.objects, self.report = root, objects, report
        self.libraries = libraries(definition)
        self.known = {id(part.chunk): self._recognised(part, self.libraries) for part in parts(root)}
        self.streams = Streams(root)
        self.points: list[UUID] = []  # inputs Points of solvers, for those who pick from them
        self.numbered = self._numbered()
        self.plan: dict[int, Swap] = {}
        self.stays: dict[int, str] = {}
        self.systems = Systems(root, self.streams, self.known, self._why_not)
        self.space = Space(root)
        self.renamed: dict[UUID, UUID] = {}
        self.because: dict[UUID, str] = {}  # why wires into an input, or out of an output, are gone
        self.idle: set[UUID] = set()  # inputs whose wires are no loss
        self.doubles: list[tuple[UUID, UUID]] = []  # an output of Kangaroo's, and a second one that goes with it

    @staticmethod
    def _recognised(part: Part, of: dict[UUID, Generation]) -> Known | None:
        """What of Kangaroo an object is; some classic components are clusters of others."""
        known = recognised(part.chunk, of)
        if known is None and part.guid == CLUSTER and part.container is not None:
            named = Known("classic", str(part.container.value("Name", default="")))
            inside = hidden(part.chunk, of) or ""
            return named if swap_of(named) and "holds" in inside else None
        return known

    def run(self) -> None:
        """Swap every system that can be swapped whole; say what cannot, and why."""
        found = self.streams.parts
        self.report.objects = len(found)
        self.report.kangaroo = sum(known is not None for known in self.known.values())
        self._decide()
        self._reserve()
        for part in found:
            known = self.known[id(part.chunk)]
            if known and role(known) is Role.SOLVER and id(part.chunk) in self.plan:
                self.points += [port.value("InstanceGuid") for port in _points(part) if sources(port)]
        for part in found:
            known = self.known[id(part.chunk)]
            if known and id(part.chunk) in self.plan:
                Swapping(self, part, known, self.plan[id(part.chunk)]).run()
            elif known:
                self.report.stays.append((called(part, known), self.stays.get(id(part.chunk)) or reason(known)))
        for part in found:
            inside = hidden(part.chunk, self.libraries) if self.known[id(part.chunk)] is None else None
            if inside:
                self.report.stays.append((part.label, inside))
        self._wire_doubles()

    def _reserve(self) -> None:
        """Room for what is larger than before, so that nothing else is there, and nothing new is placed there."""
        larger: dict[int, tuple[float, float]] = {}
        for part in self.streams.parts:
            swap = self.plan.get(id(part.chunk))
            if swap and part.container is not None and swap.pieces[0].bundle not in FLOATING:
                of = make.recipe(swap.pieces[0].bundle)
                box = size([slot.name for slot in of.inputs], [slot.name for slot in of.outputs])
                larger[id(part.container)] = box
        moved = make_room(self.root, larger)
        if moved:
            self.report.notes.append(f"{moved} objects were moved down or to the right, as components are larger here")
        self.space = Space(self.root)
        for part in self.streams.parts:
            bounds = bounds_of(part.container)
            if bounds and id(part.container) in larger:
                self.space.taken[id(part.container)] = (bounds[0], bounds[1], *larger[id(part.container)])

    def _decide(self) -> None:
        """Which components are swapped: those of systems that are whole, and tools of no system that stays."""
        report, systems = self.report, self.systems
        kept: set[UUID] = set()
        for system in systems.found:
            report.solvers += len(system.solvers)
            if system.blocks:
                report.stays += [line for line in system.foreign if line not in report.stays]
                kept |= {one for solver in system.solvers for one in self.streams.all_above(solver)}
            else:
                report.whole += len(system.solvers)
            name = " and ".join(dict.fromkeys(solver.label for solver in system.solvers))
            for part in (*system.solvers, *system.goals):
                if system.blocks:
                    self.stays[id(part.chunk)] = self._because(part, system, name)
                else:
                    self._plan(part)
        for part, takers in systems.orphans():
            if takers:
                why = f"it flows into no solver of Kangaroo, only into {', '.join(takers)}"
                self.stays[id(part.chunk)] = f"{why}; a goal is translated with its solver"
            else:
                self._plan(part)
        for part in self.streams.parts:
            known = self.known[id(part.chunk)]
            if known and role(known) is Role.TOOL and id(part.chunk) not in self.stays:
                if self._reads_what_stays(part, known):
                    self.stays[id(part.chunk)] = "it reads a solver that stays"
                elif part.id in kept and isinstance(self._swap(part, known), Swap):
                    self.stays[id(part.chunk)] = "a tool for geometry; it stays with the system that it feeds"
                else:
                    self._plan(part)

    def _reads_what_stays(self, part: Part, known: Known) -> bool:
        """Whether it takes outputs of goals from a solver that is not translated."""
        if known.generation != "engineering" or not key(known.name).endswith("output"):
            return False
        above = self.streams.all_above(part)
        return any(solver.id in above for system in self.systems.found if system.blocks for solver in system.solvers)

    def _because(self, part: Part, system: System, name: str) -> str:
        """Why a component of a system stays: a reason of its own, or that of the system."""
        known = self.known[id(part.chunk)]
        why = self._why_not(part, known) if known else None
        if why is not None:
            return why
        if all(part.chunk is not solver.chunk for solver in system.solvers):
            return f"it stays with {name}"
        return f"it stays with all its goals, because of {', '.join(system.blocks)}"

    def _plan(self, part: Part) -> None:
        known = self.known[id(part.chunk)]
        swap = self._swap(part, known) if known else None
        if isinstance(swap, Swap):
            self.plan[id(part.chunk)] = swap

    def _why_not(self, part: Part, known: Known) -> str | None:
        found = self._swap(part, known)
        return found if isinstance(found, str) else None

    def _swap(self, part: Part, known: Known) -> Swap | str:
        """The swap of a component, or why there is none."""
        swap, why = swap_of(known), ""
        given = {key(name): port for port in ports_of(part) for name in names_of(port)}
        while swap is not None:
            wrong = self._unfit(swap, part, given)
            if wrong is None:
                return swap
            swap, why = swap.other, why or wrong
        return why or reason(known)

    def _unfit(self, swap: Swap, part: Part, given: Mapping[str, Chunk]) -> str | None:
        """Why a component cannot be swapped so; empty where it is another version, None where it can."""
        if not set(swap.needs) <= given.keys():
            return ""
        if part.container is None or not (inputs(part.container) or swap.pieces[0].bundle == "*nothing"):
            return "it has no input or no output; the file is damaged"
        if not outputs(part.container):
            return "it has no input or no output; the file is damaged"
        for name, why in swap.unless.items():
            if name in given and _says(given[name], swap.usual.get(name, make)):
                return why
        for piece in swap.pieces:
            if piece.bundle == "*indexed" and not self.numbered:
                return ""
            if piece.bundle not in FLOATING:
                try:
                    make.recipe(piece.bundle)
                except InputError:
                    return f"hookean has no component {piece.bundle}"
        return None

    def _numbered(self) -> list[UUID]:
        """What is wired into the Points of the solver that takes goals by index; empty where several differ."""
        found = []
        for part in self.streams.parts:
            known = self.known[id(part.chunk)]
            if known and known.generation == "second" and role(known) is Role.SOLVER:
                found += [sources(port) for port in _points(part)]
        wired = [one for one in found if one]
        return wired[0] if wired and all(one == wired[0] for one in wired) else []

    def swapped(self, wanted: str, among: Sequence[Part]) -> Iterator[tuple[Part, Known]]:
        """Components among some that are swapped for pieces of a kind."""
        for part in among:
            known, swap = self.known[id(part.chunk)], self.plan.get(id(part.chunk))
            if known and swap and any(piece.bundle == wanted for piece in swap.pieces):
                yield part, known

    def _wire_doubles(self) -> None:
        """Where a component became two, what took its output takes both."""
        for old, new in self.doubles:
            for part in parts(self.root):
                for port in ports_of(part):
                    wired = sources(port)
                    if old in wired:
                        connect(port, [*wired, new])


def _points(solver: Part) -> list[Chunk]:
    """The input Points of a solver that has one."""
    return [port for port in ports_of(solver) if "points" in map(key, names_of(port))]


def _says(port: Chunk, usual: object) -> bool:
    """Whether an input has wires, or typed values other than Kangaroo's own."""
    return bool(sources(port)) or bool(make.stored(port)) and make.single(port) != usual
