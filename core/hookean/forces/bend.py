"""Bend: a rod's bending stiffness between two neighbouring segments."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.columns import IndexRows, NonNegatives, PointRows
from hookean.fields import Field, Maybe
from hookean.forces.base import Block, Floats, Force, Ints, Places


def bend_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy = 0.0
    for e in range(indices.shape[0]):
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


class Bend(Force):
    """Bending of rods and splines at corners a-b-c: moment M = EI / l (phi - phi0).

    phi [rad] is the angle by which the segment b-c turns away from a-b, from 0 (straight) to pi, and l the mean
    start length of the two segments, so (phi - phi0) / l is the change of curvature. Energy per corner
    EI (phi - phi0)^2 / (2 l), phi0 = rest angle x angle factor. This is Hencky's bar chain: a straight column of n
    equal segments between pins buckles at (4 n^2 EI / L^2) sin^2(pi / 2n) and converges with the square of the
    segments to Euler's elastica. The angle has no sign in space: any plane of bending is as stiff, there is no
    torsion, and a corner that is exactly straight but has a rest angle stays straight until something bends it.
    Source: Hencky, "Ueber die angenaeherte Loesung von Stabilitaetsproblemen im Raum", 1920; Wang et al., "Hencky
    bar-chain/net for structural analysis", 2020.
    """

    kind: Literal["bend"] = "bend"
    particles: Maybe[IndexRows] = Field(default=None, description="Three particles a, b, c of each corner")
    points: Maybe[PointRows] = Field(default=None, description="Coordinates of a, b, c of each corner")
    stiffness: NonNegatives = Field(default=1.0, description="EI, bending stiffness [force length^2]")
    rest_angle: Maybe[NonNegatives] = Field(default=None, description="phi0 [rad], 0 straight; none: the start angle")
    angle_factor: NonNegatives = Field(default=1.0, description="Factor on the rest angle [-]; 0: straight")

    formula: ClassVar[str] = "E = EI (φ - φ0)²/(2 l)"
    arity: ClassVar[int] = 3
    outputs: ClassVar[dict[str, str]] = {"angle": "angle", "moment": "moment"}
    kernel: ClassVar[Any] = staticmethod(bend_kernel)

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: EI / l, rest angle, factor. Corners without length have no stiffness."""
        index = places.elements(self)
        u = places.x[index[:, 1]] - places.x[index[:, 0]]
        v = places.x[index[:, 2]] - places.x[index[:, 1]]
        length = 0.5 * (np.linalg.norm(u, axis=1) + np.linalg.norm(v, axis=1))
        return Block.of(
            index,
            stiffness=np.where(length > 0, self.stiffness / np.where(length > 0, length, 1.0), 0.0),
            rest_angle=turn_angles(places.x, index) if self.rest_angle is None else self.rest_angle,
            angle_factor=self.angle_factor,
        )

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """Turning angle [rad] and the moment towards the rest angle [force length]."""
        angle = turn_angles(x, block.indices)
        rest = block.parameters[:, 1] * block.parameters[:, 2]
        return {"angle": angle, "moment": block.parameters[:, 0] * (angle - rest)}

    @classmethod
    def example(cls) -> tuple[Bend, Floats]:
        """Three corners of a rod in space: bent, over-bent, at a right angle."""
        x = np.array([[0.0, 0.0, 0.0], [1.0, 0.1, 0.0], [1.8, 0.8, 0.3], [1.9, 1.7, 1.0], [1.0, 1.6, 1.6]])
        return cls(
            particles=[[0, 1, 2], [1, 2, 3], [2, 3, 4]], stiffness=[5.0, 20.0, 1.0], rest_angle=[0.0, 1.2, 0.9]
        ), x


def turn_angles(x: Floats, corners: Ints) -> Floats:
    """Angle [rad] by which b-c turns away from a-b, for rows a, b, c of `corners`."""
    u = x[corners[:, 1]] - x[corners[:, 0]]
    v = x[corners[:, 2]] - x[corners[:, 1]]
    angle: Floats = np.arctan2(np.linalg.norm(np.cross(u, v), axis=1), (u * v).sum(axis=1))
    return angle
