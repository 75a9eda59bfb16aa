"""Bend: a rod's bending stiffness between two neighbouring segments."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import field_validator

from hookean.compiled import dispatch
from hookean.compiled.marks import device
from hookean.forces import rod_links, rod_spins, rod_stress, rod_tangent
from hookean.forces.base import Block, Floats, Force, Ints, Places, lengths
from hookean.forces.line_angles import within_half_a_turn
from hookean.forces.rod_bound import ROOM, bound_chain
from hookean.forces.rod_chain import (
    ALONE,
    HELD,
    NEXT,
    OPEN,
    PLACE,
    SHARE,
    SIDE,
    begins,
    push_chain,
    record,
    single,
)  # fmt: skip
from hookean.forces.rod_frames import turn_angles, turn_vectors
from hookean.values.columns import IndexRows, NonNegatives, PointRows
from hookean.values.fields import Field, Maybe

Sections = Literal["tied", "free"]


def bend_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy = 0.0
    chains = parameters.shape[1] > NEXT
    if chains:
        energy = push_chains(x, indices, parameters, f, w, memory.shape[1] == 0)
    for e in range(indices.shape[0]):
        if chains and parameters[e, PLACE] != ALONE and not single(parameters, e):
            continue
        a = indices[e, 0]
        b = indices[e, 1]
        c = indices[e, 2]
        ux = x[b, 0] - x[a, 0]
        uy = x[b, 1] - x[a, 1]
        uz = x[b, 2] - x[a, 2]
        vx = x[c, 0] - x[b, 0]
        vy = x[c, 1] - x[b, 1]
        vz = x[c, 2] - x[b, 2]
        uu = ux * ux + uy * uy + uz * uz
        vv = vx * vx + vy * vy + vz * vz
        if not (uu > 1e-16 * vv and vv > 1e-16 * uu and uu * vv > 1e-280):
            continue
        nx = uy * vz - uz * vy
        ny = uz * vx - ux * vz
        nz = ux * vy - uy * vx
        sine = np.sqrt(nx * nx + ny * ny + nz * nz)
        cosine = ux * vx + uy * vy + uz * vz
        size = np.sqrt(uu * vv)
        k = parameters[e, 0]
        turn = np.arctan2(sine, cosine) - parameters[e, 1] * parameters[e, 2]
        moment = k * turn
        energy += 0.5 * moment * turn
        # out of the plane a moment stiffens by M cot(angle/2) or softens by M tan(angle/2); see the tests
        bound = k + np.abs(moment)
        if moment > 0.0 and sine > 0.0:
            bound = max(bound, 0.5 * moment * (size + cosine) / sine)
        elif moment < 0.0:
            bound = max(bound, -0.5 * moment * sine / max(size + cosine, 1e-9 * size))
        ru = 1.0 / np.sqrt(uu)
        rv = 1.0 / np.sqrt(vv)
        w[a] += 2.0 * bound * ru * (ru + rv)
        w[b] += 2.0 * bound * (ru + rv) * (ru + rv)
        w[c] += 2.0 * bound * rv * (ru + rv)
        # a straight corner that should bend has no side to bend to: it stays until something pushes it
        if sine == 0.0 or (moment < 0.0 and sine < 1e-9 * size):
            continue
        moment /= sine
        at_a = moment / uu
        at_c = moment / vv
        ax = at_a * (ny * uz - nz * uy)
        ay = at_a * (nz * ux - nx * uz)
        az = at_a * (nx * uy - ny * ux)
        cx = at_c * (ny * vz - nz * vy)
        cy = at_c * (nz * vx - nx * vz)
        cz = at_c * (nx * vy - ny * vx)
        f[a, 0] -= ax
        f[a, 1] -= ay
        f[a, 2] -= az
        f[b, 0] += ax + cx
        f[b, 1] += ay + cy
        f[b, 2] += az + cz
        f[c, 0] -= cx
        f[c, 1] -= cy
        f[c, 2] -= cz
    return energy


@device
def push_chains(x: Any, indices: Any, parameters: Any, f: Any, w: Any, bound: Any) -> Any:
    """Add the forces of all chains, and if asked for a bound of their stiffness; returns their energy."""
    energy = 0.0
    room, found = np.zeros(ROOM), np.zeros((0, 5))
    for e in range(indices.shape[0]):
        if not begins(parameters, e):
            continue
        energy += push_chain(x, indices, parameters, e, room, f, w, found)
        if bound:
            bound_chain(x, indices, parameters, e, room, w)
    return energy


class Bend(Force):
    """Bending of rods and splines at corners a-b-c: moment M = EI / l (phi - phi0).

    phi [rad] is the angle by which the segment b-c turns away from a-b, from 0 (straight) to pi, and l the mean
    start length of the two segments, so (phi - phi0) / l is the change of curvature. Energy per corner
    EI (phi - phi0)^2 / (2 l), phi0 = rest angle x angle factor. This is Hencky's bar chain: a straight column of n
    equal segments between pins buckles at (4 n^2 EI / L^2) sin^2(pi / 2n) and converges with the square of the
    segments to Euler's elastica.

    A rest angle has a side. Corners that share a segment make a rod, in whatever order they are given; where more than
    two corners share one, rods end. With tied sections phi and phi0 are vectors along the axis of the turn, and those
    at rest travel with the rod: carried along it without twist, as if its torsional stiffness GJ were infinite. A rod
    bent against its curvature then costs (phi + phi0)^2, and it converges to Kirchhoff's rod without twist. What is
    left is one spin of the whole rod about its axis. If it is free, the rod takes the spin of least energy: an arch on
    loose ends that is turned inside out is the same arch turned over. An end that is one of the scene's anchors holds
    its section (a fork bearing), so an arch between anchors snaps through at its cost. Closed rods, and rods between
    two anchors, may need to twist; that costs nothing and is even along the rod, up to half a turn from its start.

    With free sections every corner spins by itself (GJ = 0), as in Kangaroo's goals: (|phi| - phi0)^2, where both sides
    are the same. The side of a rest angle is that of the start shape; a corner that starts straight takes that of the
    one before it on the rod, or else after it. A rod that is straight all along has no side until something bends it.
    Sources: Hencky, "Ueber die angenaeherte Loesung von Stabilitaetsproblemen im Raum", 1920; Wang et al., "Hencky
    bar-chain/net for structural analysis", 2020; Bergou et al., "Discrete elastic rods", 2008.
    """

    kind: Literal["bend"] = "bend"
    particles: Maybe[IndexRows] = Field(default=None, description="Three particles a, b, c of each corner")
    points: Maybe[PointRows] = Field(default=None, description="Coordinates of a, b, c of each corner")
    stiffness: NonNegatives = Field(default=1.0, description="EI, bending stiffness [force length^2]")
    rest_angle: Maybe[NonNegatives] = Field(
        default=None, description="phi0 [rad], 0 straight, at most pi; default: start angle"
    )
    angle_factor: NonNegatives = Field(default=1.0, description="Factor on the rest angle [-]; 0: straight")

    sections: Sections = Field(
        default="tied",
        description="tied: sections do not spin against each other, so rest angles have a side; free: each spins alone",
    )

    formula: ClassVar[str] = "E = EI |φ - φ0|²/(2 l)"
    creates: ClassVar[bool] = False
    arity: ClassVar[int] = 3
    outputs: ClassVar[dict[str, str]] = {"angle": "angle", "moment": "moment"}
    blur: ClassVar[float] = 5e-13
    kernel: ClassVar[Any] = staticmethod(bend_kernel)
    bent: ClassVar[Any] = staticmethod(lambda block, x, moved: bend_bent(block, x, moved))

    @field_validator("rest_angle")
    @classmethod
    def _an_angle(cls, angle: float | Floats | None) -> float | Floats | None:
        return None if angle is None else within_half_a_turn(angle)

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: EI / l, rest angle, factor, and the chains of `rod_chain`. Corners of zero length have
        no stiffness."""
        index = places.elements(self)
        u = places.x[index[:, 1]] - places.x[index[:, 0]]
        v = places.x[index[:, 2]] - places.x[index[:, 1]]
        length = 0.5 * (np.linalg.norm(u, axis=1) + np.linalg.norm(v, axis=1))
        none = np.zeros((len(index), 1))
        block = Block.of(
            index,
            stiffness=np.where(length > 0, self.stiffness / np.where(length > 0, length, 1.0), 0.0),
            rest_angle=turn_angles(places.x, index) if self.rest_angle is None else self.rest_angle,
            angle_factor=self.angle_factor,
            side=np.tile([1.0, 0.0], (len(index), 1)),
            next=none,
            place=none,
            share=length,
            turn=none,
            directions=np.repeat(none, 6, axis=1),
            held=np.repeat(none, 2, axis=1),
        )
        if self.sections == "tied":
            met = (index >= 0).all(axis=1)  # the others are left out before anything follows a chain
            table = np.ascontiguousarray(block.parameters[met])
            rod_links.link(places.x, block.indices[met], table)
            block.parameters[met] = table
        else:
            block.parameters[:, SHARE] = 0.0
        return block

    @classmethod
    def brace(cls, block: Block, held: NDArray[np.bool_], mass: Floats) -> None:
        """An end of a rod at a held particle does not spin."""
        dispatch.compiled(rod_links.hold)(block.indices, block.parameters, held)

    @classmethod
    def pack(cls, block: Block, memory: Floats, damped: bool) -> tuple[Ints, Floats, Floats]:
        """Without chains, the three columns that corners alone need; with them, a memory that asks for no bound."""
        if (block.parameters[:, PLACE] != ALONE).any():
            return block.indices, block.parameters, np.zeros((0, 1))
        return block.indices, np.ascontiguousarray(block.parameters[:, :SIDE]), memory

    @classmethod
    def gathered(
        cls, block: Block, memory: Floats, x: Floats, node: int | None
    ) -> list[tuple[type[Force], Block]] | None:
        """Chains in pieces, or with the spins of sections as nodes from `node` on; and the corners that are in none."""
        p = block.parameters
        if not p[:, PLACE].any():
            return None
        alone = lone(block)
        some: list[tuple[type[Force], Block]] = []
        if len(alone):
            some.append((cls, Block(block.indices[alone], p[alone], memory[alone], block.names)))
        if len(alone) == len(p):
            return some
        found = recorded(block, x)
        if node is None:
            return [*some, *rod_tangent.gather(block, found)]
        return [*some, (rod_spins.Spins, rod_spins.gather(block, found, x, node))]

    @classmethod
    def taken(cls, block: Block, rows: Ints) -> tuple[Ints, Block]:
        """Whole chains: each corner of one feels all others."""
        rows = rod_links.whole_chains(block.parameters, rows)
        rows, part = super().taken(block, rows)
        number = np.zeros(len(block.indices), np.int64)
        number[rows] = np.arange(len(rows))
        later = rows + part.parameters[:, NEXT].astype(np.int64)
        part.parameters[:, NEXT] = number[later] - np.arange(len(rows))
        return rows, part

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """Turning angle [rad], and the size of the moment [force length]: negative where a corner is straighter than at
        rest, or bent to the other side."""
        angle = turn_angles(x, block.indices)
        off = angle - block.parameters[:, 1] * block.parameters[:, 2]
        found = recorded(block, x)
        tied = np.flatnonzero(found[:, 4] > 0.0)
        rest, way = found[tied, :3], np.sign(block.parameters[tied, PLACE])
        beyond = way[:, None] * turn_vectors(x, block.indices[tied]) - rest
        off[tied] = np.where((beyond * rest).sum(axis=1) < 0.0, -1.0, 1.0) * lengths(beyond)
        return {"angle": angle, "moment": block.parameters[:, 0] * off}

    @classmethod
    def example(cls) -> tuple[Bend, Floats]:
        """Three corners of a rod in space: bent, over-bent, at a right angle."""
        x = np.array([[0.0, 0.0, 0.0], [1.0, 0.1, 0.0], [1.8, 0.8, 0.3], [1.9, 1.7, 1.0], [1.0, 1.6, 1.6]])
        return cls(
            particles=[[0, 1, 2], [1, 2, 3], [2, 3, 4]], stiffness=[5.0, 20.0, 1.0], rest_angle=[0.0, 1.2, 0.9]
        ), x


def lone(block: Block) -> Ints:
    """The rows of corners that spin by themselves: in no chain, or one of their own with ends that are free."""
    place, p = block.parameters[:, PLACE], block.parameters
    single = (np.abs(place) == OPEN) & (p[:, NEXT] == 0.0) & (p[:, HELD : HELD + 2] == 0.0).all(axis=1)
    return np.flatnonzero((place == ALONE) | single)


def bend_bent(block: Block, x: Floats, moved: Floats) -> list[tuple[Ints, Floats]]:
    """Particles and stress stiffness of corners that spin alone, and of chains in pieces."""
    alone = lone(block)
    pieces = [rod_stress.single(block, alone, x)] if len(alone) else []
    if len(alone) < len(block.indices):
        pieces += [chained for _, chained in rod_tangent.gather(block, recorded(block, x))]
    return [(some.indices, rod_stress.stress_stiffness(some, x, moved)) for some in pieces]


def recorded(block: Block, x: Floats) -> Floats:
    """What `rod_chain.record` finds of each corner (m, 5)."""
    found, f = np.zeros((len(block.indices), 5)), np.zeros((len(x), 3))
    dispatch.compiled(record)(x, block.indices, block.parameters, np.zeros(ROOM), f, f[:, 0].copy(), found)
    return found
