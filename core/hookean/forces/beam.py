"""Beam: rods whose ends have orientations: normal force, bending about two axes, torsion, and shear if asked for."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import model_validator

from hookean.compiled import dispatch
from hookean.compiled.marks import device
from hookean.errors import InputError
from hookean.forces.base import Block, Floats, Force, Places
from hookean.forces.beam_element import (
    ABOUT_T,
    ABOUT_Y,
    ABOUT_Z,
    ANGLES,
    BALL,
    BEND_Y,
    CHORD,
    MOMENTS,
    NORMAL,
    ROOM,
    TORQUE,
    bound,
    element,
    energy_of,
    given,
    gradient,
    strains,
)
from hookean.forces.beam_frames import drawn_frames, straight_frames
from hookean.forces.elastic import growth, one_way, section_columns
from hookean.values.axes import AxisNames, named
from hookean.values.columns import Directions, IndexRows, Lines, NonNegatives, Positives, Reals, Vectors
from hookean.values.fields import Field, Maybe

SHORTEST = 1e-20  # length of a beam [length] that has no direction


@device
def take(x: Any, indices: Any, e: Any, p: Any) -> None:
    """The rows of an element, as `beam_element` has them."""
    for j in range(6):
        i = np.uint64(indices[e, j])
        p[j, 0], p[j, 1], p[j, 2] = x[i, 0], x[i, 1], x[i, 2]


def beam_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy = 0.0
    p, room = np.zeros((6, 3)), np.zeros(ROOM + 20)
    q, s, g = room[ROOM : ROOM + 4], room[ROOM + 4 : ROOM + 8], room[ROOM + 8 :]
    for e in range(indices.shape[0]):
        take(x, indices, e, p)
        if not element(p, parameters, e, room, q, s, g):
            continue
        energy += energy_of(parameters, e, room)
        for j in range(4):
            i = np.uint64(indices[e, j])
            f[i, 0] -= g[3 * j]
            f[i, 1] -= g[3 * j + 1]
            f[i, 2] -= g[3 * j + 2]
        bound(parameters, e, room, w, indices)
    return energy


def beam_hessian(x, indices, parameters, memory, blocks):  # type: ignore[no-untyped-def]
    step = 1e-40
    p, room = np.zeros((6, 3), np.complex128), np.zeros(ROOM + 20, np.complex128)
    q, s, g = room[ROOM : ROOM + 4], room[ROOM + 4 : ROOM + 8], room[ROOM + 8 :]
    for e in range(indices.shape[0]):
        take(x, indices, e, p)
        for k in range(12):
            p[k // 3, k % 3] += step * 1j
            if element(p, parameters, e, room, q, s, g):
                for j in range(12):
                    blocks[e, j, k] = g[j].imag / step
            p[k // 3, k % 3] = p[k // 3, k % 3].real
        for k in range(12):
            for j in range(k):
                mean = 0.5 * (blocks[e, j, k] + blocks[e, k, j])
                blocks[e, j, k], blocks[e, k, j] = mean, mean


def beam_stressed(x, indices, parameters, memory, blocks):  # type: ignore[no-untyped-def]
    """The stiffness that the forces have which a small movement, `memory` (m, 12) of both ends and slots, brings: the
    second derivatives of the strains by positions, times the rates of their forces along it."""
    step = 1e-40
    p, room = np.zeros((6, 3), np.complex128), np.zeros(ROOM + 20, np.complex128)
    q, s, g = room[ROOM : ROOM + 4], room[ROOM + 4 : ROOM + 8], room[ROOM + 8 :]
    rates = np.zeros(6)  # of N, the torque, and the four end moments of bending alone
    for e in range(indices.shape[0]):
        take(x, indices, e, p)
        for k in range(12):
            p[k // 3, k % 3] += step * memory[e, k] * 1j
        if not element(p, parameters, e, room, q, s, g):
            continue
        rates[0], rates[1] = room[NORMAL].imag / step, room[TORQUE].imag / step
        for axis in range(2):
            stiff, one, two = BEND_Y + 3 * axis, room[ANGLES + axis].imag / step, room[ANGLES + 2 + axis].imag / step
            rates[2 + axis] = parameters[e, stiff] * one + parameters[e, stiff + 1] * two
            rates[4 + axis] = parameters[e, stiff + 1] * one + parameters[e, stiff + 2] * two
        take(x, indices, e, p)
        for k in range(12):
            p[k // 3, k % 3] += step * 1j
            if strains(p, parameters, e, room, q, s):
                given(parameters, e, room, rates)
                gradient(p, parameters, e, room, g)
                for j in range(12):
                    blocks[e, j, k] = g[j].imag / step
            p[k // 3, k % 3] = p[k // 3, k % 3].real


def beam_stresses(x, indices, parameters, found):  # type: ignore[no-untyped-def]
    """Of each element the chord, N, torque, the four end moments y z y z, and the energy; zeros where it has none."""
    p, room = np.zeros((6, 3)), np.zeros(ROOM + 20)
    q, s, g = room[ROOM : ROOM + 4], room[ROOM + 4 : ROOM + 8], room[ROOM + 8 :]
    for e in range(indices.shape[0]):
        take(x, indices, e, p)
        if element(p, parameters, e, room, q, s, g):
            found[e, 0], found[e, 1], found[e, 2] = room[CHORD], room[NORMAL], room[TORQUE]
            for i in range(4):
                found[e, 3 + i] = room[MOMENTS + i]
            found[e, 7] = energy_of(parameters, e, room)


class Beam(Force):
    """Beams between two particles with orientations: E = EA u^2/(2L) + (bending) + GJ phi^2/(2L).

    Each particle at the end of a beam has an orientation, and takes moments; beams that share one are rigidly joined.
    A beam may move and turn as far as it likes; its strains, seen from its chord, are small: u is the change of the
    chord's length and of what bending shortens it by, L (2 a^2 - a b + 2 b^2) / 30 for the angles a, b [rad] of its
    ends to the chord, phi the twist [rad]. Bending about each axis has the energy EI/(2L) (4 a^2 + 4 a b + 4 b^2), the
    cubic of Euler and Bernoulli; with shear areas, that of Timoshenko. What a section feels: N (tension +) and Mt,
    which are even along a beam, My and Mz at its start (0) and end (1), and the shear forces Vz = (My1 - My0) / l,
    Vy = (Mz0 - Mz1) / l, as what lies behind a section acts on what lies before it, in the section's axes.

    Give E, G, A, Iy, Iz and J, or the names of a material and a section of the scene. With a `temperature` L is the
    drawn length times 1 + expansion x temperature; the section stays. Loads act on particles: a `line_weight` or
    `self_weight` W along a beam bends it by nothing between its ends, where W l / 8 is missing; divide beams under such
    loads into several (a warning reports where much is missing).

    The section's axis x runs along the beam, z is in the plane of x and `normal`, and y = z cross x. Rows that are
    straight without stress are bent in, and twisted in where the normals turn along the row. A hinge about one axis, or
    about all, may turn as far as it likes. Turns of particles whose beams are all hinged move nothing, and count as no
    mechanism. In motion a particle has an isotropic inertia, that of a rod of its mass and of the mean length of the
    beams there. Sources: Oran, "Tangent stiffness in space frames", 1973 (angles to the chord, and shortening); Bergou
    et al., "Discrete elastic rods", 2008 (twist); Przemieniecki, Theory of matrix structural analysis, 1968, 5.6
    (shear).
    """

    kind: Literal["beam"] = "beam"
    particles: Maybe[IndexRows] = Field(default=None, description="Pairs of particles, start and end")
    lines: Maybe[Lines] = Field(default=None, description="Straight lines; their ends become particles")
    E: Maybe[Positives] = Field(default=None, description="Young's modulus [force/length^2]")
    G: Maybe[Positives] = Field(default=None, description="Shear modulus [force/length^2]")
    A: Maybe[Positives] = Field(default=None, description="Area of the section [length^2]")
    Iy: Maybe[Positives] = Field(default=None, description="Second moment of area about y [length^4]")
    Iz: Maybe[Positives] = Field(default=None, description="Second moment of area about z [length^4]")
    J: Maybe[Positives] = Field(default=None, description="Torsion constant [length^4]")
    material: str | None = Field(default=None, description="Name of a material, with a section in their place")
    section: str | None = Field(default=None, description="Name of a section, with a material in their place")
    temperature: Maybe[Reals] = Field(default=None, description="Change of temperature, of a material [K]")
    shear_y: NonNegatives = Field(default=0.0, description="Shear area along y [length^2]; 0: no shear deformation")
    shear_z: NonNegatives = Field(default=0.0, description="Shear area along z [length^2]; 0: no shear deformation")
    normal: Maybe[Directions] = Field(
        default=None, description="Direction [-] near the section's axis z; default: z, or x for vertical beams"
    )
    offset_start: Vectors = Field(
        default=np.zeros(3), description="From the first particle to where the beam starts [length]; rigid"
    )
    offset_end: Vectors = Field(
        default=np.zeros(3), description="From the second particle to where the beam ends [length]; rigid"
    )
    release_start: AxisNames = Field(
        default="", description="Axes of the section about which the start is hinged, for all or for each"
    )
    release_end: AxisNames = Field(
        default="", description="Axes of the section about which the end is hinged, for all or for each"
    )
    curvature: Literal["drawn", "straight"] = Field(
        default="drawn", description="Shape without stress: as drawn, or straight, so that rows of beams are bent in"
    )

    formula: ClassVar[str] = "E = EA u²/(2L) + EI (4a²+4ab+4b²)/(2L) + GJ φ²/(2L)"
    arity: ClassVar[int] = 2
    turns: ClassVar[bool] = True
    shared: ClassVar[tuple[str, ...]] = ("curvature",)
    outputs: ClassVar[dict[str, str]] = {
        "length": "length", "force": "force", "Vy": "force", "Vz": "force", "Mt": "moment", "My0": "moment",
        "Mz0": "moment", "My1": "moment", "Mz1": "moment", "energy": "energy",
    }  # fmt: skip
    kernel: ClassVar[Any] = staticmethod(beam_kernel)
    hessian: ClassVar[Any] = staticmethod(beam_hessian)
    stressed: ClassVar[Any] = staticmethod(beam_stressed)

    @model_validator(mode="after")
    def _one_way(self) -> Beam:
        one_way(self)
        return self

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel, see `beam_element`. InputError for a beam of zero length, or one along its normal."""
        index = places.elements(self)
        own: Any = self.replaced(**section_columns(self, places))
        chords = places.x[index[:, 1]] + self.offset_end - places.x[index[:, 0]] - self.offset_start
        length = np.sqrt((chords**2).sum(axis=1))
        if (length <= SHORTEST).any():
            raise InputError("", f"beam {int(np.argmin(length))} has no length; move its ends apart")
        frames = drawn_frames(chords, self.normal)
        if not np.isfinite(frames).all():
            at = int(np.argmax(~np.isfinite(frames).all(axis=(1, 2))))
            raise InputError("", f"the normal is along beam {at}; give a direction across it")
        length = length * growth(self, places)
        start, end = (frames, frames) if self.curvature == "drawn" else straight_frames(index, chords, frames)
        bending, bowing = zip(*(own._plane(axis, length) for axis in "yz"), strict=True)
        return Block.of(
            index,
            arm=np.ones((len(index), 2)),
            length=length,
            A=own.E * own.A / length,
            J=np.where(self.hinged("x", len(index)).any(axis=1), 0.0, own.G * own.J / length),
            Iy=bending[0],
            Iz=bending[1],
            bow=np.column_stack(bowing),
            normal=np.column_stack([start.reshape(-1, 9), end.reshape(-1, 9)]),
            offset_start=np.broadcast_to(self.offset_start, chords.shape),
            offset_end=np.broadcast_to(self.offset_end, chords.shape),
            hinge=self._hinges(len(index)),
        )

    def _plane(self, axis: str, length: Floats) -> tuple[Floats, Floats]:
        """Bending stiffness (m, 3), aa ab bb, about an axis, and shortening likewise."""
        own: Any = self
        inertia, area = (own.Iy, own.shear_z) if axis == "y" else (own.Iz, own.shear_y)
        stiff, area = own.E * inertia / length, np.broadcast_to(area, length.shape)
        with np.errstate(over="ignore"):  # infinitely soft: what is shorter than any beam
            soft = np.where(area > 0.0, 12.0 * stiff / (own.G * np.where(area > 0.0, area, 1.0) * length), 0.0)
        own, other = stiff * (1.0 + 3.0 / (1.0 + soft)), stiff * (3.0 / (1.0 + soft) - 1.0)
        none, bow = np.zeros_like(length), length / 30.0
        start, end = self.hinged(axis, len(length)).T
        part = other / own  # the hinged end turns by minus this part of the other one
        left, short = own - other * part, bow * (4.0 + 2.0 * part + 4.0 * part**2)
        ends = [~start & ~end, start & ~end, end & ~start]  # none of these: hinged at both
        stiffness = [[own, none, left], [other, none, none], [own, left, none]]
        shortening = [[4.0 * bow, none, short], [-bow, none, none], [4.0 * bow, short, none]]
        return tuple(np.column_stack([np.select(ends, kinds) for kinds in of]) for of in (stiffness, shortening))  # type: ignore[return-value]

    def hinged(self, axis: str, count: int) -> NDArray[np.bool_]:
        """Whether the start and the end of each of `count` beams (m, 2) are hinged about an axis."""
        return np.column_stack([named(ends, axis, count) for ends in (self.release_start, self.release_end)])

    def _hinges(self, count: int) -> Floats:
        """How both ends of `count` beams (m, 2) are hinged, as `beam_element` has it."""
        x, y, z = (self.hinged(axis, count) for axis in "xyz")
        ball = y & z & (x | x[:, ::-1])
        lone = x & ~y & ~z
        followed = ~(ball | (x & (y | z)))[:, ::-1]  # the section of the other end is that of the beam
        lone &= followed & ~(lone[:, ::-1] & [False, True])
        return np.select([ball, lone, y & ~z, z & ~y], [BALL, ABOUT_T, ABOUT_Y, ABOUT_Z])

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """Length of the chord, forces and moments of the section, and strain energy of each beam."""
        found = np.zeros((len(block.indices), 8))
        dispatch.compiled(beam_stresses)(x, block.indices, block.parameters, found)
        chord, normal, torque, start_y, start_z, end_y, end_z, energy = found.T
        length = np.where(chord > 0.0, chord, 1.0)
        return {
            "length": chord, "force": normal, "Vy": -(start_z + end_z) / length, "Vz": (start_y + end_y) / length,
            "Mt": torque, "My0": -start_y, "Mz0": -start_z, "My1": end_y, "Mz1": end_z, "energy": energy,
        }  # fmt: skip

    @classmethod
    def amiss(cls, block: Block, x: Floats) -> str:
        """A frame that has turned against the chord, or a chord of zero length: the beam has no forces there."""
        found = np.zeros((len(block.indices), 8))
        dispatch.compiled(beam_stresses)(x, block.indices, block.parameters, found)
        lost = np.flatnonzero((found[:, 0] == 0.0) & (block.indices[:, 0] != block.indices[:, 1]))
        if not len(lost):
            return ""
        a, b = block.indices[lost[0], :2]
        more = f" (and {len(lost) - 1} more)" if len(lost) > 1 else ""
        return (
            f"the beam between particles {a} and {b}{more} has turned by 180 degrees against the line between its "
            "ends, where its forces are not defined. Draw the beams nearer to the shape they take, or lower the loads"
        )

    @classmethod
    def example(cls) -> tuple[Beam, Floats]:
        """Two beams that meet at an angle, and differ."""
        x = np.array([[0.2, 0.1, 0.3], [1.3, 0.4, 0.2], [1.9, 1.3, 0.8]])
        return cls(
            particles=[[0, 1], [1, 2]], E=200.0, G=80.0, A=1.0, Iy=0.08, Iz=0.05, J=0.14,
            shear_y=[0.0, 0.6], normal=[0.1, 0.0, 1.0], offset_end=[[0.0, 0.1, 0.05], [0.0, 0.0, 0.0]],
        ), x  # fmt: skip
