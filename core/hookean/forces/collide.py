"""Collide: spheres that do not pass through one another; shared with the capsules of `collide_lines`."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.compiled import dispatch
from hookean.compiled.marks import device
from hookean.forces.base import Block, Floats, Force, Ints, Places
from hookean.forces.neighbours import (
    HERE,
    NUMBER,
    PARALLEL,
    ROW,
    capacity,
    ignore,
    listed,
    make_room,
    nearest,
    order_in,
    sums,
    tables,
)
from hookean.forces.springs import Springs
from hookean.values.columns import IndexRows, Labels, Points, Positives
from hookean.values.fields import Field, Maybe

STIFFNESS, SKIN, ROOM = 2, 3, 4  # columns of parameters, after the two that neighbours read
SKIN_PART = 0.15  # of the mean radius: how far beyond their reach neighbours are listed
NEAREST = 1e-20  # distance of centres from which a pair has a direction
TINY = 1e-280  # square of a length: what is smaller is a point


@device
def end_of_crowd(parameters: Any, start: Any) -> Any:
    """Where the elements of one room end."""
    room, count = parameters[start, ROOM], parameters.shape[0]
    stop = start + capacity(room)
    if stop > count or parameters[stop - 1, ROOM] != room or (stop < count and parameters[stop, ROOM] == room):
        stop = start
        while stop < count and parameters[stop, ROOM] == room:
            stop += 1
    return stop


@device
def push_apart(here: Any, i: Any, j: Any, skin: Any, stiffness: Any) -> Any:
    """Add the forces of two spheres, and how often they count for the stiffness; returns their energy."""
    dx = here[j, 0] - here[i, 0]
    dy = here[j, 1] - here[i, 1]
    dz = here[j, 2] - here[i, 2]
    reach = here[i, 3] + here[j, 3]
    square = dx * dx + dy * dy + dz * dz
    length = np.sqrt(square)
    overlap = max(reach - length, 0.0)
    # those that nearly touch count as well: they may before the stiffness is asked for again
    counts = 1.0 if length < reach + skin else 0.0
    push = stiffness * overlap / length if length > NEAREST else 0.0
    dx *= push
    dy *= push
    dz *= push
    here[i, 4] -= dx
    here[i, 5] -= dy
    here[i, 6] -= dz
    here[i, 7] += counts
    here[j, 4] += dx
    here[j, 5] += dy
    here[j, 6] += dz
    here[j, 7] += counts
    return 0.5 * stiffness * overlap * overlap


@device
def gap(here: Any, i: Any, j: Any) -> Any:
    """Squared distance of the axes of two elements, the sum of their radii, and where on the axes they are nearest."""
    s, t, radius = 0.0, 0.0, 3
    if here.shape[1] != HERE:
        s, t = nearest(here, i, j, 4)
        radius = 7
    square = 0.0
    for c in range(3):
        square += (here[j, c] + t * here[j, 4 + c] - here[i, c] - s * here[i, 4 + c]) ** 2
    return square, here[i, radius] + here[j, radius], s, t


@device
def stiffer(here: Any, i: Any, j: Any, s: Any, t: Any, length: Any, overlap: Any) -> Any:
    """How much more than 2 a contact of capsules counts for the stiffness, as its point slides along them.

    With U the half axes along which it slides and q^2 = 1 / the least eigenvalue of U'U, its tangent is at most
    k n n' + k overlap q (2 + length q / 2), n the gradient of the distance; the rest of it is negative.
    """
    uu, vv, turn = 0.0, 0.0, 0.0
    for c in range(3):
        d, k = (c + 1) % 3, (c + 2) % 3
        uu += here[i, 4 + c] * here[i, 4 + c]
        vv += here[j, 4 + c] * here[j, 4 + c]
        cross = here[i, 4 + d] * here[j, 4 + k] - here[i, 4 + k] * here[j, 4 + d]
        turn += cross * cross
    uu, vv = uu if abs(s) < 1.0 else 0.0, vv if abs(t) < 1.0 else 0.0
    least = max(turn, PARALLEL * uu * vv) / (uu + vv) if uu > TINY and vv > TINY else uu + vv
    q = 1.0 / np.sqrt(least) if least > TINY else 0.0
    return overlap * q * (2.0 + 0.5 * length * q)


@device
def push_capsules(here: Any, i: Any, j: Any, skin: Any, stiffness: Any) -> Any:
    """`push_apart` for capsules: forces on both ends of each, by where on the axis they act."""
    apart = 0.0
    for c in range(3):
        apart += (here[j, c] - here[i, c]) ** 2
    reach = here[i, 3] + here[j, 3] + skin
    if apart >= reach * reach:
        return 0.0
    square, reach, s, t = gap(here, i, j)
    if square >= (reach + skin) * (reach + skin):
        return 0.0
    here[i, 15] += 1.0
    here[j, 15] += 1.0
    if square >= reach * reach:
        return 0.0
    length = np.sqrt(square)
    overlap = reach - length
    more = 0.5 * stiffer(here, i, j, s, t, length, overlap)
    here[i, 15] += more
    here[j, 15] += more
    for c in range(3):
        push = here[j, c] + t * here[j, 4 + c] - here[i, c] - s * here[i, 4 + c]
        push *= stiffness * overlap / length if length > NEAREST else 0.0
        here[i, 8 + c] -= 0.5 * (1.0 - s) * push
        here[i, 11 + c] -= 0.5 * (1.0 + s) * push
        here[j, 8 + c] += 0.5 * (1.0 - t) * push
        here[j, 11 + c] += 0.5 * (1.0 + t) * push
    return 0.5 * stiffness * overlap * overlap


@device
def push_all(parameters, start, here, short, order, starts, found) -> Any:  # type: ignore[no-untyped-def]
    """Forces of all pairs of a crowd: those of the `short` list, else every one; returns their energy."""
    energy = 0.0
    skin, stiffness, spheres = parameters[start, SKIN], parameters[start, STIFFNESS], here.shape[1] == HERE
    for i in range(here.shape[0]):
        first = int(starts[i, 0]) if short else i + 1
        last = int(starts[i + 1, 0]) if short else here.shape[0]
        for s in range(first, last):
            j = int(found[np.uint64(s), 0]) if short else s
            if not short and ignore(parameters, start + int(order[i, NUMBER]), start + int(order[j, NUMBER])):
                continue
            if spheres:
                energy += push_apart(here, np.uint64(i), np.uint64(j), skin, stiffness)
            else:
                energy += push_capsules(here, i, j, skin, stiffness)
    return energy


def collide_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy = 0.0
    stop = 0
    while stop < indices.shape[0]:
        start = stop
        room, skin, stop = parameters[start, ROOM], parameters[start, SKIN], end_of_crowd(parameters, start)
        here = sums(room, stop - start)
        order = order_in(room, stop - start)
        short = listed(x, indices, parameters, start, here, order, room, skin)
        _, starts, found = tables(room)
        energy += push_all(parameters, start, here, short, order, starts, found)
        force, count = (4, 7) if here.shape[1] == HERE else (8, 15)
        stiffness = 2.0 * parameters[start, STIFFNESS]
        for e in range(start, stop):
            i = np.uint64(int(order[e - start, ROW]))
            for end in range(indices.shape[1]):
                a = indices[e, end]
                w[a] += stiffness * (1.0 + here[i, count])
                for c in range(3):
                    f[a, c] += here[i, force + 3 * end + c]
    return energy


def overlaps(x, indices, parameters, pair, place):  # type: ignore[no-untyped-def]
    """Write pairs of elements (k, 2) that overlap, the sums of their radii and where on their axes they are nearest
    (k, 3), as many as there is place for; returns how many there are."""
    count = 0
    stop = 0
    while stop < indices.shape[0]:
        start = stop
        room, skin, stop = parameters[start, ROOM], parameters[start, SKIN], end_of_crowd(parameters, start)
        here = sums(room, stop - start)
        order = order_in(room, stop - start)
        short = listed(x, indices, parameters, start, here, order, room, skin)
        _, starts, found = tables(room)
        for i in range(stop - start):
            first = int(starts[i, 0]) if short else i + 1
            last = int(starts[i + 1, 0]) if short else stop - start
            e = start + int(order[i, NUMBER])
            for n in range(first, last):
                j = int(found[n, 0]) if short else n
                o = start + int(order[j, NUMBER])
                square, reach, s, t = gap(here, i, j)
                if square < reach * reach and (short or not ignore(parameters, e, o)):
                    if count < len(pair):
                        pair[count, 0], pair[count, 1] = e, o
                        place[count, 0], place[count, 1], place[count, 2] = reach, s, t
                    count += 1
    return count


def overlapping(block: Block, x: Floats) -> tuple[Ints, Floats]:
    """Pairs of elements (k, 2) that overlap; the sums of their radii, and where on their axes they are nearest (k, 3),
    from -1 to 1."""
    pair, place = np.empty((0, 2), np.int64), np.empty((0, 3))
    given = np.ascontiguousarray(x), block.indices, block.parameters
    while (count := int(dispatch.compiled(overlaps)(*given, pair, place))) > len(pair):
        pair, place = np.empty((count, 2), np.int64), np.empty((count, 3))
    return pair, place


def crowd(places: Places, index: Ints, radius: Any, group: Any, strength: float, **more: Any) -> Block:
    """The block of elements that all feel one another: radius, group, stiffness, skin, address of the room for the list
    of neighbours."""
    room = make_room(places.x[index])
    block = Block.of(
        index,
        radius=radius,
        collision_group=0.0 if group is None else group,
        strength=strength,
        skin=SKIN_PART * float(np.mean(radius)) if len(index) else 0.0,
        room=float(room.ctypes.data),
        **more,
    )
    block.rooms = (room,)
    return block


class Crowd(Force):
    """Base of forces whose elements may all touch one another."""

    creates: ClassVar[bool] = False
    solid: ClassVar[bool] = False
    rewired: ClassVar[bool] = True
    outputs: ClassVar[dict[str, str]] = {"force": "force"}
    kernel: ClassVar[Any] = staticmethod(collide_kernel)

    @classmethod
    def connected(cls, block: Block) -> Ints:
        """All elements: any may come to rest on any other."""
        index = block.indices.reshape(-1, 1)
        return np.column_stack([index[:-1], index[1:]]) if len(index) > 1 else index

    @classmethod
    def taken(cls, block: Block, rows: Ints) -> tuple[Ints, Block]:
        """All elements: each may touch any other."""
        return np.arange(len(block.indices)), block

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """Force of all contacts on each element [force]."""
        return {"force": element_forces.sum(axis=1)}


class Collide(Crowd):
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

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: radius, group, stiffness, skin, address of the room for the list of neighbours."""
        return crowd(places, places.elements(self), self.radius, self.collision_group, self.strength)

    @classmethod
    def gathered(
        cls, block: Block, memory: Floats, x: Floats, node: int | None
    ) -> list[tuple[type[Force], Block]] | None:
        """The pairs that overlap, as springs."""
        pair, place = overlapping(block, x)
        none = np.zeros(len(pair))
        return [
            (
                Springs,
                Block.of(
                    block.indices[pair, 0],
                    memory=1,
                    stiffness=block.parameters[pair[:, 0], STIFFNESS],
                    damping=none,
                    rest_length=place[:, 0],
                    rest_factor=none + 1.0,
                    upper_cutoff=none,
                    lower_cutoff=none,
                    plasticity=none,
                ),
            )
        ]

    @classmethod
    def example(cls) -> tuple[Collide, Floats]:
        """Five spheres of different radii, most of which overlap; two ignore each other."""
        x = np.array([[0.0, 0.0, 0.0], [1.0, 0.1, 0.2], [0.4, 0.9, -0.1], [1.3, 1.0, 0.4], [0.7, 0.5, 1.1]])
        radius, group = [0.8, 0.9, 0.7, 0.8, 1.0], [0, 1, 1, 0, 0]
        return cls(particles=[0, 1, 2, 3, 4], radius=radius, strength=50.0, collision_group=group), x
