"""History: what edits of a running system replaced, so that they can be taken back and made again.

A `Setup` is everything an edit may set: the system, its scene as patched (whose arrays are shared, never copied) and
the anchors.
Where the particles are, is not part of it: taking a patch back is an edit, and the form follows it as any other.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from hookean.errors import InputError
from hookean.forces.base import Force
from hookean.running.patch import retune
from hookean.scene.scene import Scene
from hookean.system.group import Group
from hookean.system.state import State
from hookean.system.system import Held, System
from hookean.system.wiring import Wiring

LONGEST = 100  # edits that can be taken back
SYSTEMS = 10  # and the systems among them, where these are large
LARGE = 20_000  # particles in all systems that are kept, up to which they are not


@dataclass(frozen=True)
class Setup:
    """A system with its scene, what its forces were compiled to, and its anchors, at one moment."""

    system: System
    scene: Scene
    held: tuple[Held, ...]
    wiring: Wiring

    @classmethod
    def of(cls, system: System) -> Setup:
        """The present setup of a system; patches replace anchors and never write into them."""
        return cls(system, system.scene, tuple(system.held), Wiring.of(system))

    def put_back(self, state: State) -> None:
        """Make this the setup of its system again, whose state is given; raises its revision."""
        self.wiring.put_into(self.system, state)
        retune(self.system, state, self.scene, list(self.held))


class Before:
    """All that an edit may change of a running system, its particles included, as it was before; `of_anchors`: an edit
    that changes parameters only of forces that know what anchors hold."""

    def __init__(self, system: System, state: State, *, of_anchors: bool = False) -> None:
        self.setup = Setup.of(system)
        self._state = state.copy()
        self._parameters = []
        for group in system.all_groups:
            kept = None if of_anchors and not _braced(group) else group.block.parameters.copy()
            self._parameters.append((kept, [part.force for part in group.parts]))

    @property
    def system(self) -> System:
        """The system that was changed, or that another one replaced."""
        return self.setup.system

    def put_back(self, state: State) -> State:
        """Undo what was done to the system since, and to its state `state`; the state as it was. Once only."""
        system = self.system
        self.setup.wiring.put_into(system, state)
        for group, (parameters, forces) in zip(system.all_groups, self._parameters, strict=True):
            if parameters is not None:
                group.block.parameters[:] = parameters
            for part, force in zip(group.parts, forces, strict=True):
                part.force = force
        scene = self.setup.scene
        system.scene, system.drag, system.held = scene, scene.settings.drag, list(self.setup.held)
        system.places.take_materials(scene)
        system.brace()
        return self._state


def _braced(group: Group) -> bool:
    """Whether anchors set parameters of a group."""
    own: Any = group.cls.brace
    return bool(own.__func__ is not Force.brace.__func__)  # type: ignore[attr-defined]


@dataclass
class History:
    """Setups before each edit, the latest last, and those that were taken back."""

    before: list[Setup] = field(default_factory=list)
    after: list[Setup] = field(default_factory=list)
    gesture: str = ""

    def copy(self) -> History:
        """The same setups in lists of its own."""
        return History(list(self.before), list(self.after), self.gesture)

    def note(self, setup: Setup, gesture: str) -> None:
        """An edit follows this setup. Edits of one gesture, such as the drag of an anchor, are taken back as one."""
        if not gesture or gesture != self.gesture:
            self.before.append(setup)
            del self.before[:-LONGEST]
            while self._too_large():
                del self.before[0]
        self.gesture = gesture
        self.after.clear()

    def _too_large(self) -> bool:
        systems = {id(one.system): one.system for one in self.before}
        return len(systems) > SYSTEMS and sum(system.slots.count for system in systems.values()) > LARGE

    def undo(self, now: Setup) -> Setup:
        """What is to be put back to undo the last edit; raises InputError if there is no edit."""
        return self._move(self.before, self.after, now, "undone")

    def redo(self, now: Setup) -> Setup:
        """What is to be put back to redo the last undone edit; raises InputError if there is no such edit."""
        return self._move(self.after, self.before, now, "redone")

    def _move(self, source: list[Setup], target: list[Setup], now: Setup, verb: str) -> Setup:
        if not source:
            raise InputError("", f"there is no edit to be {verb}")
        target.append(now)
        self.gesture = ""
        return source.pop()
