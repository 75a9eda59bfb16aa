"""History: what patches of a running system replaced, so that they can be taken back and made again.

A `Setup` is everything a patch may set: the scene as patched (whose arrays are shared, never copied) and the anchors.
Where the particles are, is not part of it: taking a patch back is an edit, and the form follows it as any other.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from hookean.errors import InputError
from hookean.running.patch import retune
from hookean.scene.scene import Scene
from hookean.system.state import State
from hookean.system.system import Held, System
from hookean.system.wiring import Wiring

LONGEST = 100  # edits that can be taken back


@dataclass(frozen=True)
class Setup:
    """A scene with its forces and settings, what the forces were compiled to, and the anchors, at one moment."""

    scene: Scene
    held: tuple[Held, ...]
    wiring: Wiring

    @classmethod
    def of(cls, system: System) -> Setup:
        """The present setup of a system; patches replace anchors and never write into them."""
        return cls(system.scene, tuple(system.held), Wiring.of(system))

    def put_back(self, system: System, state: State) -> None:
        """Make this the setup of the system again; raises its revision."""
        self.wiring.put_into(system, state)
        retune(system, state, self.scene, list(self.held))


class Before:
    """All that an edit may change of a running system, its particles included, as it was before."""

    def __init__(self, system: System, state: State) -> None:
        self.setup = Setup.of(system)
        self._state = state.copy()
        self._parameters = [
            (group.block.parameters.copy(), [part.force for part in group.parts]) for group in system.all_groups
        ]

    def put_back(self, system: System, state: State) -> State:
        """Undo what was done to the system since, and its state `state`; the state as it was. Once only."""
        self.setup.wiring.put_into(system, state)
        for group, (parameters, forces) in zip(system.all_groups, self._parameters, strict=True):
            group.block.parameters[:] = parameters
            for part, force in zip(group.parts, forces, strict=True):
                part.force = force
        scene = self.setup.scene
        system.scene, system.drag, system.held = scene, scene.settings.drag, list(self.setup.held)
        system.places.take_materials(scene)
        system.brace()
        return self._state


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
        self.gesture = gesture
        self.after.clear()

    def undo(self, system: System, state: State) -> None:
        """Undo the last edit; raises InputError if there is no edit."""
        self._move(self.before, self.after, system, state, "undone")

    def redo(self, system: System, state: State) -> None:
        """Redo the last undone edit; raises InputError if there is no such edit."""
        self._move(self.after, self.before, system, state, "redone")

    def _move(self, source: list[Setup], target: list[Setup], system: System, state: State, verb: str) -> None:
        if not source:
            raise InputError("", f"there is no edit to be {verb}")
        target.append(Setup.of(system))
        source.pop().put_back(system, state)
        self.gesture = ""
