"""Collide: spheres that do not pass through one another."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.compiled import dispatch
from hookean.compiled.marks import device
from hookean.forces.base import Block, Floats, Force, Ints, Places
from hookean.forces.neighbours import listed, make_room, pairs, same_group, sums
from hookean.forces.springs import Springs
from hookean.values.columns import IndexRows, Labels, Points, Positives
from hookean.values.fields import Field, Maybe

RADIUS, GROUP, STIFFNESS, SKIN, ROOM = range(5)  # columns of parameters; neighbours know the first two
SKIN_PART = 0.15  # of the mean radius: how far beyond their reach neighbours are listed
NEAREST = 1e-20  # distance of centres from which a pair has a direction


@device
def gather(x: Any, indices: Any, parameters: Any, start: Any, here: Any) -> None:
    """Centres and radii side by side, and no forces yet."""
    for i in range(here.shape[0]):
        for c in range(3):
            here[i, c] = x[indices[start + i, 0], c]
        here[i, 3] = parameters[start + i, RADIUS]
        for c in range(4, 8):
            here[i, c] = 0.0


@device
def push_apart(here: Any, i: Any, j: Any, skin: Any, stiffness: Any) -> Any:
    """Add the forces of two spheres, and how often they count for the stiffness; returns their energy."""
    dx = here[j, 0] - here[i, 0]
    dy = here[j, 1] - here[i, 1]
    dz = here[j, 2] - here[i, 2]
    reach = here[i, 3] + here[j, 3]
    square = dx * dx + dy * dy + dz * dz
    if square >= (reach + skin) * (reach + skin):
        return 0.0
    # those that nearly touch count as well: they may before the stiffness is asked for again
    here[i, 7] += 1.0
    here[j, 7] += 1.0
    if square >= reach * reach:
        return 0.0
    length = np.sqrt(square)
    overlap = reach - length
    if length > NEAREST:
        push = stiffness * overlap / length
        dx *= push
        dy *= push
        dz *= push
        here[i, 4] -= dx
        here[i, 5] -= dy
        here[i, 6] -= dz
        here[j, 4] += dx
        here[j, 5] += dy
        here[j, 6] += dz
    return 0.5 * stiffness * overlap * overlap


@device
def push_all(parameters: Any, start: Any, here: Any, short: Any, starts: Any, found: Any) -> Any:
    """Forces of all pairs of a crowd: those of the `short` list, else every one; returns their energy."""
    energy = 0.0
    skin, stiffness = parameters[start, SKIN], parameters[start, STIFFNESS]
    for i in range(here.shape[0]):
        if short:
            for s in range(int(starts[i, 0]), int(starts[i + 1, 0])):
                energy += push_apart(here, np.uint64(i), np.uint64(int(found[np.uint64(s), 0])), skin, stiffness)
            continue
        for j in range(i + 1, here.shape[0]):
            if not same_group(parameters[start + i, GROUP], parameters[start + j, GROUP]):
                energy += push_apart(here, i, j, skin, stiffness)
    return energy


def collide_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy = 0.0
    stop = 0
    while stop < indices.shape[0]:
        start = stop
        room = parameters[start, ROOM]
        while stop < indices.shape[0] and parameters[stop, ROOM] == room:
            stop += 1
        here = sums(room, stop - start)
        gather(x, indices, parameters, start, here)
        short = listed(x, indices, parameters, start, stop, room, parameters[start, SKIN])
        energy += push_all(parameters, start, here, short, *pairs(room))
        for i in range(stop - start):
            a = indices[start + i, 0]
            w[a] += 2.0 * parameters[start + i, STIFFNESS] * (1.0 + here[i, 7])
            for c in range(3):
                f[a, c] += here[i, 4 + c]
    return energy


def overlaps(x, indices, parameters, pair, reach):  # type: ignore[no-untyped-def]
    """Write pairs of elements (k, 2) that overlap and the sums of their radii (k,), as many as there is place for;
    returns how many there are."""
    count = 0
    stop = 0
    while stop < indices.shape[0]:
        start = stop
        room = parameters[start, ROOM]
        while stop < indices.shape[0] and parameters[stop, ROOM] == room:
            stop += 1
        short = listed(x, indices, parameters, start, stop, room, parameters[start, SKIN])
        starts, found = pairs(room)
        for e in range(start, stop):
            first = int(starts[e - start, 0]) if short else e + 1 - start
            last = int(starts[e - start + 1, 0]) if short else stop - start
            for s in range(first, last):
                o = start + (int(found[s, 0]) if short else s)
                apart = 0.0
                for c in range(3):
                    apart += (x[indices[e, 0], c] - x[indices[o, 0], c]) ** 2
                both = parameters[e, RADIUS] + parameters[o, RADIUS]
                if apart < both * both and (short or not same_group(parameters[e, GROUP], parameters[o, GROUP])):
                    if count < len(pair):
                        pair[count, 0], pair[count, 1], reach[count] = e, o, both
                    count += 1
    return count


def overlapping(block: Block, x: Floats) -> tuple[Ints, Floats]:
    """Pairs of elements (k, 2) that overlap, and the sums of their radii (k,)."""
    pair, reach = np.empty((0, 2), np.int64), np.empty(0)
    given = np.ascontiguousarray(x), block.indices, block.parameters
    while (count := int(dispatch.compiled(overlaps)(*given, pair, reach))) > len(pair):
        pair, reach = np.empty((count, 2), np.int64), np.empty(count)
    return pair, reach


class Collide(Force):
    """Spheres about particles that push each other apart where they overlap: E = k (a + b - d)^2 / 2.

    a and b are the radii of two spheres, d is the distance of their centres. All spheres of the force can touch, of any
    radii, except those of one `collision_group`. Two pressed together with a force F overlap by F / k. Spheres with the
    same centre have no direction in which to part: nothing pushes them.
    """

    kind: Literal["collide"] = "collide"
    particles: Maybe[IndexRows] = Field(default=None, description="Particles in the centres of spheres")
    points: Maybe[Points] = Field(default=None, description="Coordinates of the centres of spheres")
    radius: Positives = Field(default=1.0, description="Radius of each sphere [length]")
    strength: float = Field(default=1000.0, ge=0, le=1e12, description="k, stiffness of a contact [force/length]")
    collision_group: Maybe[Labels] = Field(
        default=None, description="A number for each sphere [-]: those of one group ignore each other; 0: of no group"
    )

    formula: ClassVar[str] = "E = k (a + b - d)²/2"
    creates: ClassVar[bool] = False
    solid: ClassVar[bool] = False
    outputs: ClassVar[dict[str, str]] = {"force": "force"}
    kernel: ClassVar[Any] = staticmethod(collide_kernel)

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: radius, group, stiffness, skin, address of the room for the list of neighbours."""
        index = places.elements(self)
        skin = SKIN_PART * float(np.mean(self.radius)) if len(index) else 0.0
        room = make_room(len(index))
        block = Block.of(
            index,
            radius=self.radius,
            collision_group=0.0 if self.collision_group is None else self.collision_group,
            strength=self.strength,
            skin=skin,
            room=float(room.ctypes.data),
        )
        block.rooms = (room,)
        return block

    @classmethod
    def connected(cls, block: Block) -> Ints:
        """All spheres: any may come to rest on any other."""
        index = block.indices[:, 0]
        return np.column_stack([index[:-1], index[1:]]) if len(index) > 1 else block.indices

    @classmethod
    def taken(cls, block: Block, rows: Ints) -> tuple[Ints, Block]:
        """All spheres: each may touch any other."""
        return np.arange(len(block.indices)), block

    @classmethod
    def gathered(
        cls, block: Block, memory: Floats, x: Floats, node: int | None
    ) -> list[tuple[type[Force], Block]] | None:
        """The pairs that overlap, as springs."""
        pair, reach = overlapping(block, x)
        none = np.zeros(len(pair))
        return [
            (
                Springs,
                Block.of(
                    block.indices[pair, 0],
                    memory=1,
                    stiffness=block.parameters[pair[:, 0], STIFFNESS],
                    damping=none,
                    rest_length=reach,
                    rest_factor=none + 1.0,
                    upper_cutoff=none,
                    lower_cutoff=none,
                    plasticity=none,
                ),
            )
        ]

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """Force of all contacts on each sphere [force]."""
        return {"force": element_forces[:, 0]}

    @classmethod
    def example(cls) -> tuple[Collide, Floats]:
        """Five spheres of different radii, most of which overlap; two ignore each other."""
        x = np.array([[0.0, 0.0, 0.0], [1.0, 0.1, 0.2], [0.4, 0.9, -0.1], [1.3, 1.0, 0.4], [0.7, 0.5, 1.1]])
        radius, group = [0.8, 0.9, 0.7, 0.8, 1.0], [0, 1, 1, 0, 0]
        return cls(particles=[0, 1, 2, 3, 4], radius=radius, strength=50.0, collision_group=group), x
