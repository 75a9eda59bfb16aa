"""Rigid collide: convex solids that do not pass through one another, with dry friction."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.compiled import dispatch
from hookean.compiled.dispatch import keep
from hookean.compiled.marks import device
from hookean.errors import InputError
from hookean.forces import groups
from hookean.forces.base import Block, Floats, Force, Ints, Places
from hookean.forces.collide import Crowd
from hookean.forces.contained import find_inside
from hookean.forces.convex import (
    BASE,
    BODY,
    COUNT,
    ENERGY,
    FLAT,
    FORCE,
    HEAD,
    HIT,
    INVERSE,
    MOMENT,
    NOTE,
    OTHERS,
    OWN,
    PRESS,
    PUSH,
    RADIUS,
    STIFF,
    TWIST,
    hull,
    radius,
    touch,
)
from hookean.forces.groups import following
from hookean.forces.neighbours import make_room, order_in, pairs_listed, tables
from hookean.forces.rigid_body import CENTRE, SHAPE
from hookean.forces.rigid_friction import ANCHOR, PARTNER, STARTED, grip, hold_on
from hookean.forces.rigid_places import (
    FRICTION,
    QUIET,
    ROOM,
    SKIN,
    STRENGTH,
    crowd_sizes,
    gather,
)
from hookean.forces.runs import ends
from hookean.forces.strays import listed, some_pairs
from hookean.values.columns import IndexRows, Labels, NonNegatives, Points
from hookean.values.fields import Field, Maybe

SKIN_PART = 0.15  # of the mean radius: how far beyond their reach neighbours are listed
SHORTEST = 1e-40  # extent below which a solid is a point: products of what is shorter would be 0
MARGIN = 0.25  # of the skin: how near solids are that count for the stiffness though they do not touch
CAUTION = 2.0  # times the stiffness of a contact on one particle, that its other side has as well


@device
def add_contact(bodies: Any, i: Any, j: Any, k: Any, hit: Any) -> Any:
    """Add what two bodies feel of each other; returns their energy."""
    base = int(hit[BASE])
    other = i + j - base
    bodies[base, STIFF] += CAUTION * k * hit[OWN]
    bodies[other, STIFF] += CAUTION * k * hit[OTHERS]
    if not hit[ENERGY] > 0.0:
        return 0.0
    for body in (other, base):
        sign = k if body == other else -k
        for c in range(3):
            p, q = (c + 1) % 3, (c + 2) % 3
            arm_p, arm_q = bodies[body, p] - bodies[j, p], bodies[body, q] - bodies[j, q]
            bodies[body, FORCE + c] += sign * hit[PUSH + c]
            bodies[body, MOMENT + c] += sign * (hit[TWIST + c] - arm_p * hit[PUSH + q] + arm_q * hit[PUSH + p])
    return k * hit[ENERGY]


@device
def meet(parameters: Any, memory: Any, i: Any, j: Any, solids: Any, desk: Any, noting: Any) -> Any:
    """Forces of two bodies, or if `noting` what they remember; returns their energy."""
    bodies = solids[0]
    a, b = int(bodies[i, HEAD]), int(bodies[j, HEAD])
    reach = bodies[i, RADIUS] + bodies[j, RADIUS] + MARGIN * parameters[a, SKIN]
    apart = 0.0
    for c in range(3):
        apart += (bodies[i, CENTRE + c] - bodies[j, CENTRE + c]) ** 2
    rough, k = (
        min(parameters[a, FRICTION], parameters[b, FRICTION]),
        min(parameters[a, STRENGTH], parameters[b, STRENGTH]),
    )
    quiet = noting or parameters[a, QUIET] != 0.0
    if not apart < reach * reach or k == 0.0 or (noting and rough == 0.0):
        return 0.0
    if not touch(solids, i, j, MARGIN * parameters[a, SKIN], rough > 0.0, quiet, desk):
        return 0.0
    hit, energy = desk[1][0], 0.0
    if not noting:
        energy = add_contact(bodies, i, j, k, hit)
    if rough > 0.0 and hit[ENERGY] > 0.0 and hit[PRESS] > 0.0:
        one, two = min(i, j), max(i, j)
        if noting:
            hold_on(parameters, memory, bodies, one, two, j, rough, desk)
        else:
            grip(parameters, memory, bodies, one, two, j, k, rough, desk)
    return energy


@device
def spread(indices: Any, parameters: Any, bodies: Any, count: Any, f: Any, w: Any) -> None:
    """Share forces and moments of bodies among their particles, so that sums and moments stay."""
    for b in range(count):
        turn, number = bodies[b, INVERSE : INVERSE + 9].reshape(3, 3), bodies[b, COUNT]
        m = bodies[b, MOMENT : MOMENT + 3]
        e = int(bodies[b, HEAD])
        while e >= 0:
            a = indices[e, 0]
            w[a] += bodies[b, STIFF]
            for c in range(3):
                p, q = (c + 1) % 3, (c + 2) % 3
                at_p = at_q = 0.0
                for i in range(3):
                    at_p += bodies[b, 3 + 3 * p + i] * parameters[e, SHAPE + i]
                    at_q += bodies[b, 3 + 3 * q + i] * parameters[e, SHAPE + i]
                spin_p = turn[p, 0] * m[0] + turn[p, 1] * m[1] + turn[p, 2] * m[2]
                spin_q = turn[q, 0] * m[0] + turn[q, 1] * m[1] + turn[q, 2] * m[2]
                f[a, c] += bodies[b, FORCE + c] / number + spin_p * at_q - spin_q * at_p
            e = following(parameters, e)


@device
def all_pairs(parameters: Any, memory: Any, start: Any, solids: Any, centres: Any, desk: Any, noting: Any) -> Any:
    """All contacts of a crowd, in the order of the list of neighbours; returns their energy."""
    room, count, energy = parameters[start, ROOM], centres.shape[0], 0.0
    plain, index = np.empty((count, 2)), np.arange(count).reshape(count, 1)
    for i in range(count):
        plain[i, 0], plain[i, 1] = centres[i, 3], centres[i, 4]
    here, sums, counts = tables(room, count)
    order, several = order_in(room, count), 1
    short = listed(centres, index, plain, 0, here, sums, counts, order, room, parameters[start, SKIN])
    pairs, reach, number = pairs_listed(room)
    if not short:
        pairs, reach, several = np.empty(count, np.int64), np.empty(count), count
    for i in range(several):
        if not short:
            number = some_pairs(plain, 0, order, i, pairs, reach)
        for n in range(number):
            one, other = ends(pairs[n])
            energy += meet(parameters, memory, int(order[one]), int(order[other]), solids, desk, noting)
    return energy


@device
def sweep(x: Any, indices: Any, parameters: Any, memory: Any, f: Any, w: Any, noting: Any) -> Any:
    """All contacts of all crowds: forces, or if `noting` what is remembered; returns the energy."""
    energy, stop, sizes = 0.0, 0, np.zeros(5, np.int64)
    while stop < indices.shape[0]:
        start = stop
        stop = crowd_sizes(indices, parameters, start, sizes)
        count, corners, faces, wide, most = sizes[0], sizes[1], sizes[2], sizes[4], sizes[3] + sizes[4] + 2
        a = BODY * count
        b = a + 3 * corners
        c = b + 4 * faces
        d = c + 5 * count
        e = d + 6 * most
        o = e + 6 * most * wide
        paper = np.zeros(o + HIT + 48)
        bodies, points, planes = (
            paper[:a].reshape(count, BODY),
            paper[a:b].reshape(corners, 3),
            paper[b:c].reshape(faces, 4),
        )
        centres, poly, flat = (
            paper[c:d].reshape(count, 5),
            paper[d:e].reshape(2, most, 3),
            paper[e:o].reshape(2 * most * wide, 3),
        )
        hits, room = paper[o : o + HIT].reshape(1, HIT), paper[o + HIT :].reshape(12, 4)
        desk = poly, hits, room, flat, np.zeros((2 * wide, NOTE), np.int64)
        gather(x, indices, parameters, start, stop, (bodies, points, planes), centres, desk[2])
        energy += all_pairs(parameters, memory, start, (bodies, points, planes), centres, desk, noting)
        if not noting:
            spread(indices, parameters, bodies, count, f, w)
    return energy


def rigid_collide_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    return sweep(x, indices, parameters, memory, f, w, False)


def rigid_collide_note(x, indices, parameters, memory):  # type: ignore[no-untyped-def]
    for e in range(indices.shape[0]):  # contacts that are not met again are forgotten
        memory[e, PARTNER] = -memory[e, PARTNER]
    sweep(x, indices, parameters, memory, x, np.zeros(1), True)
    for e in range(indices.shape[0]):
        memory[e, PARTNER] = max(memory[e, PARTNER], 0.0)
        memory[e, STARTED] = 1.0 if parameters[e, FRICTION] > 0.0 else memory[e, STARTED]


class RigidCollide(Crowd):
    """Convex solids that push each other apart where they overlap, with dry friction: E = k V d.

    A solid is the convex hull of the particles of a group, where they are at the start. It is rigid, and moves with the
    best fit to its particles; `rigid_body` with the same groups keeps these in their places. Of two that overlap, the
    face that is nearest to the centroid of the overlap presses on the other solid by k d, d the depth below the face.
    This is an elastic foundation: on an area A a force F sinks in by F / (k A), a moment M turns it by M / (k I). The
    energy is the integral of k d over the overlap, its volume V by the depth of its centroid. Forces and moments are
    shared among all particles of a solid, so that their sums stay.

    With friction they stick, as stiff along the contact as across it, until mu N is reached, mu the smaller of both.
    What holds starts from where they touch first: at the start itself for what touches there, and when they do not move
    in time. A solid that is not convex is made of several with one `collision_group`, on the particles of one body.
    For boxes that are tilted in any way, give their eight corners as a group here and to `rigid_body`; boxes along the
    axes that may grow or shrink are `box_collide`.
    Corners of two solids at one place, given as points, become one particle: give them as particles, or draw a joint.
    Boxes that are flush without friction are no stable stack: each gains room by moving out.
    """

    kind: Literal["rigid_collide"] = "rigid_collide"
    particles: Maybe[IndexRows] = Field(default=None, description="Particles at the corners of solids")
    points: Maybe[Points] = Field(default=None, description="Coordinates of the corners of solids")
    group: Maybe[Labels] = Field(
        default=None, description="Number of the solid of each particle; default: all are in one"
    )
    strength: NonNegatives = Field(
        default=1000.0, description="k, pressure by depth [force/length^3]; of two solids the smaller counts"
    )
    friction: NonNegatives = Field(default=0.0, description="mu [-]; of two solids the smaller counts")
    collision_group: Maybe[Labels] = Field(
        default=None,
        description="A number for each particle [-]: solids of one group ignore each other; 0: of no group",
    )

    formula: ClassVar[str] = "E = k V d"
    creates: ClassVar[bool] = True
    remembers: ClassVar[bool] = True
    yielding: ClassVar[tuple[str, ...]] = ("friction",)
    kernel: ClassVar[Any] = staticmethod(rigid_collide_kernel)
    end_of_step: ClassVar[Any] = staticmethod(rigid_collide_note)

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: what `rigid_body` has, with weights of 1; start, k, mu and the hull of each solid."""
        index = places.elements(self)
        link = groups.links(index, self.group)
        met = np.flatnonzero(index[:, 0] >= 0)
        head = np.arange(len(met)) - link[met, groups.FIRST].astype(np.int64)
        table = np.zeros((len(index), 9))
        table[met], centres = self._solids(places.x[index[met, 0]], head)
        room = make_room(centres[:, None])
        skin = SKIN_PART * float(table[met, 6].mean()) if len(met) else 0.0
        block = Block.of(
            index, memory=ANCHOR, links=link, weight=1.0, shape=table[:, :3], start=table[:, 3:6],
            strength=self.strength, friction=self.friction,
            collision_group=0.0 if self.collision_group is None else self.collision_group,
            hull=table[:, 6:], skin=skin, room=float(room.ctypes.data), quiet=0.0,
        )  # fmt: skip
        block.rooms = (room,)
        return block

    def _solids(self, x: Floats, head: Ints) -> tuple[Floats, Floats]:
        """Of each particle its place from the centre of its solid, that centre, the radius and the table of the solid,
        (m, 9); and the centres."""
        found, centres = np.zeros((len(x), 9)), []
        for first in np.unique(head):
            own = np.flatnonzero(head == first)
            centre = x[own[0]] + (x[own] - x[own[0]]).mean(axis=0)
            q = x[own] - centre
            q -= q.mean(axis=0)
            size = float(np.ptp(q, axis=0).max())
            label = "all particles" if self.group is None else f"group {self.group[own[0]]}"
            if len(own) > 3 and not size > SHORTEST:
                raise InputError("", f"the {len(own)} corners of a solid ({label}) are at one place; give it a size")
            if not (len(own) > 3 and np.linalg.svd(q, compute_uv=False)[2] > FLAT * size):
                said = f"the {len(own)} corners of a solid ({label}) lie in a plane; give at least four that do not"
                raise InputError("", said)
            solid = hull(q)
            found[own] = np.column_stack([q, np.tile([*centre, radius(solid), keep(solid), len(solid)], (len(own), 1))])
            centres.append(centre)
        return found, np.array(centres).reshape(-1, 3)

    @classmethod
    def pack(cls, block: Block, memory: Floats, damped: bool) -> tuple[Ints, Floats] | None:
        """The same, without what is for the stiffness."""
        parameters = block.parameters.copy()
        parameters[:, QUIET] = 1.0
        return block.indices, parameters

    @classmethod
    def gathered(
        cls, block: Block, memory: Floats, x: Floats, node: int | None
    ) -> list[tuple[type[Force], Block]] | None:
        """Particles by themselves, as stiff as they feel: a bound from above."""
        if not len(block.indices):
            return []
        own, w = np.unique(block.indices), np.zeros(len(x))
        dispatch.compiled(cls.kernel, "force")(
            x, np.zeros_like(x), block.indices, block.parameters, block.memory, np.zeros_like(x), w
        )
        return [(groups.Whole, groups.bounded(own[:, None], w[own]))]

    @classmethod
    def amiss(cls, block: Block, x: Floats) -> str:
        """Solids inside others, out of which nothing pushes them."""
        found = np.zeros(2, np.int64)
        count = int(dispatch.compiled(find_inside)(np.ascontiguousarray(x), block.indices, block.parameters, found))
        if not count:
            return ""
        more = f" (and {count - 1} more)" if count > 1 else ""
        return (
            f"the solid of particle {found[0]} lies inside that of particle {found[1]}{more}, and nothing pushes it "
            "out. Move them apart"
        )

    @classmethod
    def no_tangent(cls, block: Block, *, sparse: bool) -> str:
        """Contacts of solids have none."""
        return "contacts of rigid solids have no tangent"

    @classmethod
    def example(cls) -> tuple[RigidCollide, Floats]:
        """A box on a tilted one, a wedge in its side, and a rough one that is free."""
        corners = np.array([[i & 1, i >> 1 & 1, i >> 2] for i in range(8)]) - 0.5
        tilted = corners * [6.0, 5.0, 3.0] @ np.array([[0.8, 0.0, -0.6], [0.0, 1.0, 0.0], [0.6, 0.0, 0.8]]).T
        above = corners * [3.0, 2.0, 2.0] @ np.array([[0.6, -0.64, -0.48], [0.8, 0.48, 0.36], [0.0, -0.6, 0.8]]).T
        wedge = np.array([[0, 0, 0], [0.1, 0.2, 3.0], [4, 2, 1], [4, -2, 1.5], [5, 0.3, 4.0]])
        x = np.vstack([tilted, above + [0.9, 0.3, 3.1], wedge + [2.2, 0.4, -1.9], corners * 2.0 + [-9, 3, 0]])
        group = np.repeat([3, 1, 7, 2], [8, 8, 5, 8])
        return cls(particles=range(29), group=group, strength=10.0, friction=np.where(group == 2, 0.5, 0.0)), x
