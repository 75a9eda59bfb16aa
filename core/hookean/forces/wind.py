"""Wind: the pressure of wind on the faces of a mesh, by their angle to it."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np
from pydantic import model_validator

from hookean.compiled.marks import device
from hookean.forces.base import Block, Floats, Force, Places, lengths, units
from hookean.forces.face_loads import FaceLoad, dome, fill, length, share, sides
from hookean.forces.hydrostatic import wet
from hookean.values.columns import Direction, fault
from hookean.values.fields import Field

# columns of the parameters; the last two where the wind ends at a water surface: its level, and 1 if it blows below it
Q, PART, ALONG, SPEED, DAMPING, LEVEL, BELOW = 0, 1, 2, 5, 6, 7, 8


@device
def blown(v: Any, indices: Any, parameters: Any, e: Any, n: Any, double: Any) -> Any:
    """n.d of a triangle, less n.u / W where the wind counts relative to it, u its velocity."""
    along = 0.0
    for c in range(3):
        along += n[c] / double * parameters[e, ALONG + c]
    if parameters[e, DAMPING] != 0.0:
        for i in range(3):
            for c in range(3):
                along -= n[c] / double * v[indices[e, i], c] / (3.0 * parameters[e, SPEED])
    return along


def wind_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    g, n = np.zeros((3, 3)), np.zeros(3)
    for e in range(indices.shape[0]):
        double = sides(x, indices, e, g, n)
        if not double > 0.0:
            continue
        half, along = 0.5 * parameters[e, Q] * parameters[e, PART], blown(v, indices, parameters, e, n, double)
        still = 0.0
        for c in range(3):
            still += n[c] / double * parameters[e, ALONG + c]
            n[c] *= half * along
        share(indices, e, n, np.abs(half) * (1.0 + np.abs(still)), g, f, w)
    return 0.0


def wind_at_water_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    g, n = np.zeros((3, 3)), np.zeros(3)
    depth, first, second = np.zeros(3), np.zeros(3), np.zeros((3, 3))
    for e in range(indices.shape[0]):
        double = sides(x, indices, e, g, n)
        if not double > 0.0:
            continue
        half, along = 0.5 * parameters[e, Q] * parameters[e, PART], blown(v, indices, parameters, e, n, double)
        wet(x, indices, e, parameters[e, LEVEL], depth, first, second)
        reach, still = length(g, 0) + length(g, 1) + length(g, 2), 0.0
        for c in range(3):
            still += np.abs(n[c] / double * parameters[e, ALONG + c])
        low, high = min(depth[0], depth[1], depth[2]), max(depth[0], depth[1], depth[2])
        # the part in the wind changes with the level by 2 / (high - low) at most: where the middle corner is
        rise = 6.0 * double * still / (high - low) if low < 0.0 < high else 0.0
        for i in range(3):
            part = second[i, 0] + second[i, 1] + second[i, 2]
            part = part if parameters[e, BELOW] != 0.0 else 1.0 / 3.0 - part
            w[indices[e, i]] += np.abs(half) * (0.5 * (1.0 + still) * (reach + length(g, i)) + rise)
            for c in range(3):
                f[indices[e, i], c] += half * along * part * n[c]
    return 0.0


def wind_hessian(x, indices, parameters, memory, blocks):  # type: ignore[no-untyped-def]
    # F = q (n . d) N / 2, so dF/dN = q (n d^T + (n . d) (1 - n n^T)) / 2
    g, n, slope = np.zeros((3, 3)), np.zeros(3), np.zeros((3, 3))
    for e in range(indices.shape[0]):
        double = sides(x, indices, e, g, n)
        half, along = 0.5 * parameters[e, Q] * parameters[e, PART], 0.0
        for c in range(3):
            n[c] = n[c] / double if double > 0.0 else 0.0
            along += n[c] * parameters[e, ALONG + c]
        for c in range(3):
            for k in range(3):
                flat = (1.0 if c == k else 0.0) - n[c] * n[k]
                slope[c, k] = half * (n[c] * parameters[e, ALONG + k] + along * flat)
        fill(blocks, e, slope, g)


class Wind(FaceLoad):
    """Wind on the faces of a mesh: f = q A (n.d) n, normal to each face, a third of it on each corner.

    q is the velocity pressure, rho W^2 / 2 times a coefficient, d the direction of the wind, A and n area and normal of
    the shape as it is. Either side of a face may meet the wind: the force is the same for a mesh turned inside out, and
    is q A cos(theta) on a plate at angle theta. Nothing shelters a face from the wind. A quad is the mean of its two
    cuts into triangles. These forces have no energy, and Newton steps take the symmetric part of their stiffness.

    With the speed W of the wind given, a face that moves with the velocity u feels the wind relative to it:
    f = q A n.(d - u / W) n, which takes energy out of its vibrations. With a waterline the wind blows on what is above
    the level alone, or below it as a current does: faces that the level cuts share the integrals of the part that is
    in the wind, exactly.
    """

    kind: Literal["wind"] = "wind"
    mesh: str = Field(description="Name of the mesh in the wind")
    pressure: float = Field(default=1.0, ge=-1e12, le=1e12, description="q, velocity pressure [force/length^2]")
    direction: Direction = Field(
        default=np.array([1.0, 0.0, 0.0]), description="d, where the wind blows to; its length is ignored"
    )
    speed: float = Field(
        default=0.0,
        ge=0,
        le=1e12,
        description="W, speed of the wind [length/time], for faces that move; 0: what moves feels what is at rest",
    )
    waterline: float | None = Field(
        default=None, ge=-1e12, le=1e12, description="Level of a water surface, z [length]; default: there is none"
    )
    below: bool = Field(default=False, description="Whether it acts below the waterline, not above")

    formula: ClassVar[str] = "f = q A (n·d) n"
    damped: ClassVar[bool] = True
    kernel: ClassVar[Any] = staticmethod(wind_kernel)
    hessian: ClassVar[Any] = staticmethod(wind_hessian)

    @model_validator(mode="after")
    def _takes_energy(self) -> Wind:
        if self.speed > 0.0 and self.pressure < 0.0:
            raise fault("a negative pressure given with a speed; turn the direction round instead", "/pressure")
        return self

    @property
    def compiled_as(self) -> type[Force]:
        """`WindAtWater` where there is a waterline."""
        return Wind if self.waterline is None else WindAtWater

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: q, share, the unit vector along d, W, a bound of the damping; level and side."""
        corners, part = self.triangles(places, self.mesh)
        along = np.tile(units(self.direction), (len(corners), 1))
        x = places.x[corners]
        area = 0.5 * lengths(np.cross(x[:, 1] - x[:, 0], x[:, 2] - x[:, 0]))
        rate = self.pressure / self.speed if self.speed > 0.0 else 0.0
        water: dict[str, Any] = {}
        if self.waterline is not None:
            water = {"waterline": self.waterline, "below": float(self.below)}
        return Block.of(
            corners, pressure=self.pressure, share=part, direction=along, speed=self.speed,
            damping=rate * part * area / 3.0, **water,
        )  # fmt: skip

    @classmethod
    def example(cls) -> tuple[Wind, Floats]:
        """An irregular dome of quads and triangles (`example_faces`) in a wind from above, relative to it."""
        return cls(mesh="skin", pressure=3.0, direction=[2.0, 0.5, -1.0], speed=4.0), dome()


class WindAtWater(Wind):
    """What `wind` with a waterline compiles to (see there); its tangent is differenced."""

    variant: ClassVar[bool] = True
    kernel: ClassVar[Any] = staticmethod(wind_at_water_kernel)
    hessian: ClassVar[Any] = None
