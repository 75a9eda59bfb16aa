"""Groups: the forces of a scene compiled, joined where they share a kernel."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from hookean.errors import InputError
from hookean.forces import Block, Force
from hookean.forces.base import Rider
from hookean.system.slots import Slots

if TYPE_CHECKING:
    from hookean.system.weld import Welded

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

Member = tuple[int, Force, Block, Ints]
"""A force of the scene compiled: its number, itself, its elements, and the inputs that they came from."""


@dataclass
class Part:
    """The elements of one force inside a group: `rows` of the group's arrays, and which inputs they came from."""

    number: int  # index in scene.forces, or -1 for the floor of the settings
    force: Force
    rows: slice
    inputs: Ints  # element of the input of every row


@dataclass
class Group:
    """All elements that share a kernel, in one block."""

    cls: type[Force]
    block: Block
    parts: list[Part]

    @property
    def particles(self) -> Ints:
        """Particles (m, arity) of its elements, without slots."""
        return self.block.indices[:, : self.cls.arity] if self.cls.turns else self.block.indices

    @property
    def conservative(self) -> bool:
        """Whether its forces are minus the gradient of the energy that its kernel returns."""
        return self.cls.conservative or any(not self._uses(column) for column in self.cls.zero)

    @property
    def damped(self) -> bool:
        """Whether it reads the velocities."""
        return self.cls.damped and self._uses("damping")

    @property
    def yields(self) -> bool:
        """Whether it may change at the end of a step because of what it remembers."""
        return self.cls.remembers and any(self._uses(column) for column in self.cls.yielding)

    def _uses(self, column: str) -> bool:
        """Whether the parameters of this name are not all zero; yes where there are none of this name."""
        columns = [i for i, name in enumerate(self.block.names) if name == column]
        return not columns or any(np.count_nonzero(self.block.parameters[:, i]) for i in columns)

    def of(self, part: Part) -> Block:
        """The part's own rows, as views."""
        return self.block.some(part.rows)


def groups_of(given: list[tuple[int, Force]], welded: Welded) -> tuple[list[Group], list[Group], list[Group], Slots]:
    """Blocks of all forces, joined where they share a kernel, contacts and impulses apart; the slots of what turns."""
    joined: dict[type[Force], list[Member]] = {}
    for number, force in given:
        pointer = f"/forces/{number}" if number >= 0 else "/settings/floor"
        block = welded.block(force, pointer)
        welded.check_force(force, pointer)
        inputs = np.arange(len(block.indices))
        if block.indices.min(initial=0) < 0:
            inputs = np.flatnonzero((block.indices >= 0).all(axis=1))
            block = block.some(inputs)
        joined.setdefault(force.compiled_as, []).append((number, force, block, inputs))
    slots = Slots(len(welded.x))
    if any(cls.turns for cls in joined):
        slots = Slots.of(welded.x, [block for cls, found in joined.items() if cls.turns for _, _, block, _ in found])
        joined = {cls: [fitted(slots, cls, member) for member in found] for cls, found in joined.items()}
    for cls, found in list(joined.items()):
        if cls.rider is not None:
            riding = [ride(slots, cls.rider, member) for member in found if len(slots) or not alone(cls.rider, member)]
            joined[cls.rider] = [member for member in riding if len(member[2].indices)]
    return *_joined({cls: found for cls, found in joined.items() if found}), slots


def fitted(slots: Slots, cls: type[Force], member: Member) -> Member:
    """The elements of a force with their slots."""
    number, force, block, inputs = member
    return number, force, slots.fitted(cls, block), inputs


def alone(rider: type[Rider], member: Member) -> bool:
    """Whether the elements of a force need none of its rider where no particle has an orientation."""
    return not rider.missing(member[1], member[2])


def ride(slots: Slots, rider: type[Rider], member: Member) -> Member:
    """The elements of a force's rider; InputError where it needs orientations at particles that have none."""
    number, force, block, inputs = member
    has = slots.rows(block.indices[:, 0]) >= 0
    if said := rider.missing(force, block.some(np.flatnonzero(~has))):
        raise InputError(f"/forces/{number}", said)
    some = rider.of(force, block.some(np.flatnonzero(has)))
    return number, force, slots.fitted(rider, some), inputs[has]


def _joined(joined: dict[type[Force], list[Member]]) -> tuple[list[Group], list[Group], list[Group]]:
    groups: list[Group] = []
    contacts: list[Group] = []
    impulses: list[Group] = []
    for cls, members in joined.items():
        parts: list[Part] = []
        start = 0
        for number, force, block, inputs in members:
            parts.append(Part(number, force, slice(start, start + len(block.indices)), inputs))
            start += len(block.indices)
        blocks = [block for _, _, block, _ in members]
        first = blocks[0]
        # the indices may be the scene's own
        whole = Block(first.indices.copy(), first.parameters, first.memory, first.names, rooms=first.rooms)
        if len(blocks) > 1:
            whole.indices = np.concatenate([b.indices for b in blocks])
            whole.parameters = np.concatenate([b.parameters for b in blocks])
            whole.memory = np.concatenate([b.memory for b in blocks])
            whole.rooms = tuple(room for b in blocks for room in b.rooms)
        kin = groups if cls.kernel is not None else impulses if cls.momentary else contacts
        kin.append(Group(cls, whole, parts))
    return groups, contacts, impulses
