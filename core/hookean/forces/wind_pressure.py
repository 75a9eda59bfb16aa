"""Wind pressure: velocity pressure times a coefficient, by regions of faces or by their angle to the wind."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np
from pydantic import model_validator

from hookean.compiled.marks import device
from hookean.errors import InputError
from hookean.forces.base import Block, Floats, Places, units
from hookean.forces.face_loads import FaceLoad, dome, fill, share, sides
from hookean.forces.soapfilm import halves
from hookean.values.columns import Direction, Reals, fault
from hookean.values.fields import Field, Maybe

Q, PART, WINDWARD, STEEPEST, COUNT, TABLE = 0, 1, 2, 5, 6, 7  # columns of the parameters


@device
def coefficient(parameters: Any, e: Any, n: Any, double: Any, found: Any) -> None:
    """Write Cp, its slope by the angle [1/rad], and cosine and sine of the angle between n and where the wind is."""
    count = int(parameters[e, COUNT])
    found[0], found[1], found[2], found[3] = parameters[e, TABLE + count], 0.0, 0.0, 1.0
    if count == 1:
        return
    for c in range(3):
        found[2] += n[c] / double * parameters[e, WINDWARD + c]
    found[2] = min(1.0, max(-1.0, found[2]))
    found[3] = np.sqrt(1.0 - found[2] * found[2])
    angle = np.arccos(found[2])
    for k in range(1, count):
        low, high = parameters[e, TABLE + k - 1], parameters[e, TABLE + k]
        first, last = parameters[e, TABLE + count + k - 1], parameters[e, TABLE + count + k]
        if low <= angle <= high:
            found[1] = (last - first) / (high - low)
            found[0] = first + found[1] * (angle - low)
            return
        if angle > high:
            found[0] = last


def wind_pressure_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    g, n, found = np.zeros((3, 3)), np.zeros(3), np.zeros(4)
    for e in range(indices.shape[0]):
        double = sides(x, indices, e, g, n)
        if not double > 0.0:
            continue
        half = -0.5 * parameters[e, Q] * parameters[e, PART]
        coefficient(parameters, e, n, double, found)
        for c in range(3):
            n[c] *= half * found[0]
        share(indices, e, n, np.abs(half) * (np.abs(found[0]) + parameters[e, STEEPEST]), g, f, w)
    return 0.0


def wind_pressure_hessian(x, indices, parameters, memory, blocks):  # type: ignore[no-untyped-def]
    # F = -q Cp N / 2, so dF/dN = -q (Cp - n Cp' (u - cos n)^T / sin) / 2, u the unit vector to where the wind is from
    g, n, slope, found = np.zeros((3, 3)), np.zeros(3), np.zeros((3, 3)), np.zeros(4)
    for e in range(indices.shape[0]):
        double = sides(x, indices, e, g, n)
        half = -0.5 * parameters[e, Q] * parameters[e, PART] if double > 0.0 else 0.0
        if double > 0.0:
            coefficient(parameters, e, n, double, found)
        for c in range(3):
            n[c] = n[c] / double if double > 0.0 else 0.0
        for c in range(3):
            for k in range(3):
                slope[c, k] = half * found[0] if c == k else 0.0
                if found[1] != 0.0 and found[3] > 1e-12:
                    turn = (parameters[e, WINDWARD + k] - found[2] * n[k]) / found[3]
                    slope[c, k] -= half * n[c] * found[1] * turn
        fill(blocks, e, slope, g)


class WindPressure(FaceLoad):
    """Wind as codes give it, on the faces of a mesh: f = -q Cp A n / 3 on each corner, q times a pressure coefficient.

    n and A are the normal and the area of a face as it is; n points to the side on which its corners run
    counter-clockwise, the outside. A positive Cp presses on the outside, a negative one is suction. For a roof that is
    open below, give the net coefficient of both sides.

    By regions, `coefficient` is one Cp, or one for each face. By angle, `angles` are those [deg] between the outward
    normal and the direction the wind comes from (0: the face meets the wind, 180: it is in the lee), and `coefficient`
    has a Cp for each: linear between them, constant beyond. The angle follows the shape. These forces have no energy
    unless Cp is constant and the rim held, and Newton steps take the symmetric part of their stiffness.
    Source: EN 1991-1-4, 5.2 (external pressure we = qp(ze) cpe).
    """

    kind: Literal["wind_pressure"] = "wind_pressure"
    mesh: str = Field(description="Name of the mesh in the wind")
    pressure: float = Field(default=1.0, ge=-1e12, le=1e12, description="q, velocity pressure [force/length^2]")
    coefficient: Reals = Field(default=1.0, description="Cp: one, one for each face, or one for each angle [-]")
    angles: Maybe[Reals] = Field(
        default=None, description="Increasing angles from the outward normal to where the wind is from, 0 to 180 [deg]"
    )
    direction: Direction = Field(
        default=np.array([1.0, 0.0, 0.0]), description="Where the wind blows to, for angles; its length is ignored"
    )

    formula: ClassVar[str] = "f = -q Cp A n/3"
    shared: ClassVar[tuple[str, ...]] = ("coefficient", "angles")
    outward: ClassVar[bool] = True
    kernel: ClassVar[Any] = staticmethod(wind_pressure_kernel)
    hessian: ClassVar[Any] = staticmethod(wind_pressure_hessian)

    @model_validator(mode="after")
    def _table(self) -> WindPressure:
        if self.angles is None:
            return self
        angles = np.atleast_1d(self.angles)
        if len(angles) < 2 or not (np.diff(angles) > 0.0).all() or angles[0] < 0.0 or angles[-1] > 180.0:
            raise fault("give at least two increasing angles from 0 to 180", "/angles")
        if np.shape(self.coefficient) != angles.shape:
            count = np.size(self.coefficient)
            raise fault(f"{count} values for {len(angles)} angles; give one for each", "/coefficient")
        return self

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: q, share, the unit vector to windward, a bound of the slope, angles [rad] and Cp."""
        faces = places.faces(self.mesh)
        whole = (faces >= 0).all(axis=1)
        corners, part, face = halves(faces[whole])
        if self.angles is None:
            given = np.asarray(self.coefficient)
            if given.ndim and len(given) not in (1, len(faces)):
                said = f"{len(given)} values of coefficient for {len(faces)} faces of {self.mesh}"
                raise InputError("", f"{said}; give one, or one for each face")
            table = np.broadcast_to(given, (len(faces),))[whole][face][:, None] * [0.0, 1.0]
            steepest = 0.0
        else:
            angles, values = np.radians(self.angles), np.asarray(self.coefficient)
            table = np.tile(np.concatenate([angles, values]), (len(corners), 1))
            steepest = float(np.abs(np.diff(values) / np.diff(angles)).max())
        return Block.of(
            corners, pressure=self.pressure, share=part, windward=np.tile(-units(self.direction), (len(corners), 1)),
            steepest=steepest, count=float(table.shape[1] // 2), table=table,
        )  # fmt: skip

    @classmethod
    def example(cls) -> tuple[WindPressure, Floats]:
        """An irregular dome of quads and triangles (`example_faces`), pressed to windward and sucked in the lee."""
        cp = {"coefficient": [0.8, -0.4, -1.2, -0.5], "angles": [10.0, 50.0, 80.0, 100.0]}
        return cls(mesh="skin", pressure=3.0, direction=[2.0, 0.5, -1.0], **cp), dome()  # type: ignore[arg-type]
