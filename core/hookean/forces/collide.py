"""Collide: spheres that do not pass through one another; shared with the capsules of `collide_lines`."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from hookean.compiled import dispatch
from hookean.compiled.marks import device
from hookean.forces.base import Block, Floats, Force, Ints, Places, lengths
from hookean.forces.capsules import gap, push_capsules
from hookean.forces.cells import GROUP, RADIUS
from hookean.forces.collide_friction import (
    SLOT,
    SLOTS,
    damping_ratio,
    dashpots,
    rough_collide_kernel,
    rough_collide_note,
)
from hookean.forces.crowd_rows import NEAREST, ROOM, SKIN, STIFFNESS, end_of_crowd
from hookean.forces.list_range import SKIN_PART
from hookean.forces.neighbours import (
    AS_GIVEN,
    HERE,
    capacity,
    forget,
    gather,
    make_room,
    order_in,
    pairs_listed,
    renew,
    served,
    tables,
)
from hookean.forces.runs import ends
from hookean.forces.springs import Springs
from hookean.forces.strays import listed, serves, some_pairs
from hookean.values.columns import IndexRows, Labels, Points, Positives
from hookean.values.fields import Field, Maybe

SEVERAL = 128  # pairs at a time: what is between stays in the nearest cache
# packed, a row of parameters for each room: where its elements start and how many they are, k, skin, address, and the
# first particle where rows are consecutive particles, else -1
BEGIN, SIZE, K, REACH, ADDRESS, PARTICLE, PACKED = range(7)


@device
def touching(at: Any, pairs: Any, reaches: Any, first: Any, last: Any, margin: Any, some: Any, table: Any) -> Any:
    """Of pairs from `first` to `last` those that are within a margin of their reach: the pairs in `some`, squares of
    their distances and their reach in the rows of `table`; how many."""
    count = 0
    for n in range(first, last):
        pair, reach = pairs[np.uint64(n)], reaches[np.uint64(n)]
        i, j = ends(pair)
        dx = at[j, 0] - at[i, 0]
        dy = at[j, 1] - at[i, 1]
        dz = at[j, 2] - at[i, 2]
        square, near, k = dx * dx + dy * dy + dz * dz, reach + margin, np.uint64(count)
        some[k] = pair  # overwritten by the next unless it counts: quicker than a branch
        table[0, k] = square
        table[1, k] = reach
        count += 1 if square < near * near else 0
    return count


@device
def densities(squares: Any, reach: Any, count: Any, stiffness: Any) -> None:
    """Force by distance of pairs, in the place of the squares of their distances, and overlaps in that of reaches."""
    for n in range(count):
        length = np.sqrt(squares[n])
        overlap = max(reach[n] - length, 0.0)
        push = stiffness * overlap / length
        reach[n] = overlap
        squares[n] = push if length > NEAREST else 0.0


@device
def push_spheres(  # type: ignore[no-untyped-def]
    at, sums, counts, pairs, reach, number, stiffness, margin, some, table, energy
) -> Any:  # fmt: skip
    """Add the forces of pairs of spheres; with a margin also how often each counts for the stiffness, and energy."""
    for first in range(0, number, SEVERAL):
        count = touching(at, pairs, reach, first, min(number, first + SEVERAL), margin, some, table)
        densities(table[0], table[1], count, stiffness)
        if margin > 0.0:
            for n in range(count):
                i, j = ends(some[np.uint64(n)])
                # those that nearly touch count as well: they may before the stiffness is asked for again
                counts[i] += 1.0
                counts[j] += 1.0
                energy += 0.5 * stiffness * table[1, np.uint64(n)] * table[1, np.uint64(n)]
        for n in range(count):
            (i, j), push = ends(some[np.uint64(n)]), table[0, np.uint64(n)]
            d0 = (at[j, 0] - at[i, 0]) * push
            d1 = (at[j, 1] - at[i, 1]) * push
            d2 = (at[j, 2] - at[i, 2]) * push
            d3 = (at[j, 3] - at[i, 3]) * push  # zeros: four columns are one operation
            sums[i, 0] -= d0
            sums[i, 1] -= d1
            sums[i, 2] -= d2
            sums[i, 3] -= d3
            sums[j, 0] += d0
            sums[j, 1] += d1
            sums[j, 2] += d2
            sums[j, 3] += d3
    return energy


@device
def push_all(parameters, start, here, sums, counts, order, short, room, margin) -> Any:  # type: ignore[no-untyped-def]
    """Forces of all pairs of a crowd: those of the `short` list, else every one; returns their energy."""
    energy, several = 0.0, here.shape[0]
    some, table = np.empty(SEVERAL, np.int64), np.empty((2, SEVERAL))
    pairs, reach, number = pairs_listed(room)
    skin, stiffness = parameters[start, SKIN], parameters[start, STIFFNESS]
    if short:
        several = 1
    else:
        pairs, reach = np.empty(several, np.int64), np.empty(several)
    for i in range(several):
        if not short:
            number = some_pairs(parameters, start, order, i, pairs, reach)
        if here.shape[1] == HERE:
            energy = push_spheres(here, sums, counts, pairs, reach, number, stiffness, margin, some, table, energy)
            continue
        for n in range(number):
            one, other = ends(pairs[n])
            energy += push_capsules(here, one, other, skin, stiffness)
    return energy


@device
def push_packed(x, indices, crowd, parameters, f) -> None:  # type: ignore[no-untyped-def]
    """Forces of a packed crowd of spheres."""
    start, size, room, skin = int(crowd[BEGIN]), int(crowd[SIZE]), crowd[ADDRESS], crowd[REACH]
    (here, sums, counts), order = tables(room, size), order_in(room, size)
    most, straight, a = served(room, size, skin, 0.0), crowd[PARTICLE] >= 0.0, int(max(crowd[PARTICLE], 0.0))
    at = x[a : a + size] if straight else here
    if not straight:
        gather(x, indices, start, here, sums, counts, order, True)
    short = most >= 0.0 and serves(at, room, most)
    if not short:
        gather(x, indices, start, here, sums, counts, order, True)
        short = renew(here, parameters, start, order, room, skin)
    if straight:
        push_all(parameters, start, at, f[a : a + size], counts, order, short, room, 0.0)
        return
    push_all(parameters, start, here, sums, counts, order, short, room, 0.0)
    for n in range(size):
        i, end = np.uint64(n), np.uint64(indices[start + n, 0])
        f[end, 0] += sums[i, 0]
        f[end, 1] += sums[i, 1]
        f[end, 2] += sums[i, 2]
        f[end, 3] += sums[i, 3]


@device
def add_spheres(indices, start, order, sums, counts, stiffness, f, w) -> None:  # type: ignore[no-untyped-def]
    """Add what spheres feel to their particles: forces, and lumped stiffness by how often they count."""
    for n in range(order.shape[0]):
        i = np.uint64(n)
        a = np.uint64(indices[np.uint64(start + int(order[i])), 0])
        w[a] += stiffness * (1.0 + counts[i])
        f[a, 0] += sums[i, 0]
        f[a, 1] += sums[i, 1]
        f[a, 2] += sums[i, 2]


@device
def add_capsules(indices, start, order, here, stiffness, f, w) -> None:  # type: ignore[no-untyped-def]
    """The same of capsules, for both ends."""
    for i in range(order.shape[0]):
        e = start + int(order[i])
        for end in range(indices.shape[1]):
            a = indices[e, end]
            w[a] += stiffness * (1.0 + here[i, 15])
            for c in range(3):
                f[a, c] += here[i, 8 + 3 * end + c]


def collide_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    if parameters.shape[1] == PACKED:
        for n in range(parameters.shape[0]):
            push_packed(x, indices, parameters[n], memory, f)
        return 0.0
    energy = 0.0
    stop = 0
    while stop < indices.shape[0]:
        start = stop
        room, skin, stop = parameters[start, ROOM], parameters[start, SKIN], end_of_crowd(parameters, start)
        here, sums, counts = tables(room, stop - start)
        order = order_in(room, stop - start)
        short = listed(x, indices, parameters, start, here, sums, counts, order, room, skin)
        energy += push_all(parameters, start, here, sums, counts, order, short, room, skin)
        stiffness = 2.0 * parameters[start, STIFFNESS]
        if here.shape[1] == HERE:
            add_spheres(indices, start, order, sums, counts, stiffness, f, w)
        else:
            add_capsules(indices, start, order, here, stiffness, f, w)
    return energy


def overlaps(x, indices, parameters, pair, place):  # type: ignore[no-untyped-def]
    """Write pairs of elements (k, 2) that overlap, the sums of their radii and where on their axes they are nearest
    (k, 3), as many as there is place for; returns how many there are."""
    count = 0
    stop = 0
    while stop < indices.shape[0]:
        start = stop
        room, skin, stop = parameters[start, ROOM], parameters[start, SKIN], end_of_crowd(parameters, start)
        here, sums, counts = tables(room, stop - start)
        order = order_in(room, stop - start)
        short = listed(x, indices, parameters, start, here, sums, counts, order, room, skin)
        pairs, reaches, number = pairs_listed(room)
        if not short:
            pairs, reaches = np.empty(stop - start, np.int64), np.empty(stop - start)
        for row in range(1 if short else stop - start):
            if not short:
                number = some_pairs(parameters, start, order, row, pairs, reaches)
            for n in range(number):
                i, j = ends(pairs[n])
                square, s, t = gap(here, i, j)
                if square < reaches[n] * reaches[n]:
                    if count < len(pair):
                        pair[count, 0], pair[count, 1] = start + int(order[i]), start + int(order[j])
                        place[count, 0], place[count, 1], place[count, 2] = reaches[n], s, t
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
    touches: ClassVar[bool] = True
    outputs: ClassVar[dict[str, str]] = {"force": "force"}
    kernel: ClassVar[Any] = staticmethod(collide_kernel)

    @classmethod
    def connected(cls, block: Block) -> Ints:
        """All elements of each crowd: any may come to rest on any other of the same force."""
        flat, names, rows = block.indices.ravel(), list(block.names), np.arange(len(block.indices), dtype=np.float64)
        if "room" in names:
            crowd = block.parameters[:, names.index("room")]
        else:  # by the first row of each
            crowd = rows - block.parameters[:, names.index("crowd" if "crowd" in names else "links")]
        crowd = np.repeat(crowd, block.indices.shape[1])
        onward = np.flatnonzero(crowd[:-1] == crowd[1:])
        first = flat[np.flatnonzero(np.diff(crowd, prepend=np.nan) != 0.0)]  # one alone is joined, too
        pairs = np.concatenate([np.column_stack([flat[onward], flat[onward + 1]]), np.column_stack([first, first])])
        return np.ascontiguousarray(pairs)

    @classmethod
    def taken(cls, block: Block, rows: Ints) -> tuple[Ints, Block]:
        """All elements: each may touch any other."""
        return np.arange(len(block.indices)), block

    @classmethod
    def pack(
        cls, block: Block, memory: Floats, damped: bool
    ) -> tuple[Ints, Floats] | tuple[Ints, Floats, Floats] | None:
        """Of spheres their particles by rows; a row for each room (`PACKED`); the parameters in the place of memory."""
        index, table = block.indices, block.parameters
        if index.shape[1] != 1 or not len(index):
            return None
        first = np.flatnonzero(np.diff(table[:, ROOM], prepend=-1.0))
        crowds = np.zeros((len(first), PACKED))
        for row, start, stop in zip(crowds, first, [*first[1:], len(index)], strict=True):
            address, part = table[start, ROOM], table[start:stop]
            room = next(room for room in block.rooms if room.ctypes.data == address)
            if capacity(room.ctypes.data) != stop - start:
                return None  # some were left out
            forget(room, part[:, RADIUS], part[:, GROUP])
            particle = index[start, 0]
            straight = room[0, AS_GIVEN] and np.array_equal(index[start:stop, 0], particle + np.arange(stop - start))
            if not room[0, AS_GIVEN]:
                index = index.copy() if index is block.indices else index
                order = order_in(room.ctypes.data, stop - start).astype(np.int64)
                index[start:stop] = block.indices[start:stop][order]
            row[:] = start, stop - start, part[0, STIFFNESS], part[0, SKIN], address, particle if straight else -1
        return index, crowds, table


class Collide(Crowd):
    """Spheres about particles that push each other apart where they overlap: E = k (a + b - d)^2 / 2.

    a and b are the radii of two spheres, d is the distance of their centres. All spheres of the force can touch, of any
    radii, except those of one `collision_group`. Two pressed together with a force F overlap by F / k. Spheres with the
    same centre have no direction in which to part: nothing pushes them.

    In physical time (`verlet`, `yoshida`, simulations) two that meet with the speed u part with e u: a dashpot
    c = 2 zeta sqrt(k m) acts while they overlap, m their reduced mass, zeta = -ln e / sqrt(pi^2 + ln^2 e). With
    friction they stick where they touched first, as stiff along the contact as across it, until mu N is reached, N the
    force that presses them together; then they slip. Spheres do not turn, so with friction the sum of their moments is
    not zero. At rest, and where nothing moves in time, there is neither.
    Source: Cundall and Strack, "A discrete numerical model for granular assemblies", 1979.
    """

    kind: Literal["collide"] = "collide"
    particles: Maybe[IndexRows] = Field(default=None, description="Particles in the centres of spheres")
    points: Maybe[Points] = Field(default=None, description="Coordinates of the centres of spheres")
    radius: Positives = Field(default=1.0, description="Radius of each sphere [length]")
    strength: float = Field(default=1000.0, ge=0, le=1e12, description="k, stiffness of a contact [force/length]")
    collision_group: Maybe[Labels] = Field(
        default=None, description="A number for each sphere [-]: those of one group ignore each other; 0: of no group"
    )

    restitution: float = Field(
        default=1.0, ge=0, le=1, description="e, part of the speed kept in a contact, in physical time [-]"
    )
    friction: float = Field(default=0.0, ge=0, le=1e12, description="mu, dry friction, in physical time [-]")

    formula: ClassVar[str] = "E = k (a + b - d)²/2"

    @property
    def compiled_as(self) -> type[Force]:
        """`RoughCollide` where spheres rub or lose speed."""
        if self.friction == 0.0 and self.restitution == 1.0:
            return Collide
        return RoughCollide

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: radius, group, stiffness, skin, address of the room for the list of neighbours."""
        more: dict[str, Any] = {}
        if self.compiled_as is not Collide:
            ratio = damping_ratio(self.restitution)
            more = {"damping_ratio": ratio, "friction": self.friction, "dashpot": 0.0, "damping": 0.0}
            more["memory"] = SLOTS * SLOT
        return crowd(places, places.elements(self), self.radius, self.collision_group, self.strength, **more)

    @classmethod
    def amiss(cls, block: Block, x: Floats) -> str:
        """Spheres with the same centre: nothing pushes them apart."""
        pair, _ = overlapping(block, x)
        a, b = block.indices[pair, 0].T
        same = np.flatnonzero((lengths(x[a] - x[b]) <= NEAREST) & (block.parameters[pair[:, 0], STIFFNESS] > 0.0))
        if not len(same):
            return ""
        more = f" (and {len(same) - 1} more pairs)" if len(same) > 1 else ""
        return (
            f"the spheres of particles {a[same[0]]} and {b[same[0]]}{more} have the same centre, and nothing pushes "
            "them apart. Move one of them"
        )

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


class RoughCollide(Collide):
    """What `collide` compiles to where spheres rub or lose speed (see there)."""

    variant: ClassVar[bool] = True
    conservative: ClassVar[bool] = False
    damped: ClassVar[bool] = True
    remembers: ClassVar[bool] = True
    yielding: ClassVar[tuple[str, ...]] = ("friction",)
    kernel: ClassVar[Any] = staticmethod(rough_collide_kernel)
    end_of_step: ClassVar[Any] = staticmethod(rough_collide_note)

    @classmethod
    def brace(cls, block: Block, held: NDArray[np.bool_], mass: Floats) -> None:
        """The dashpot of each sphere by its mass, and a bound of all damping [force time/length]."""
        dashpots(block, mass)

    @classmethod
    def pack(cls, block: Block, memory: Floats, damped: bool) -> None:
        """As they are."""
