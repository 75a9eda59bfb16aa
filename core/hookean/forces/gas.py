"""Gas: closed meshes with a fixed amount of gas in them."""

from __future__ import annotations

from typing import ClassVar, Literal

import numpy as np

from hookean.forces.base import Block, Floats, Places
from hookean.forces.enclosed import GAS, Enclosed
from hookean.values.fields import Field


class Gas(Enclosed):
    """A fixed amount of gas in a closed mesh, at constant temperature: p = p0 V0 / V - p_out (Boyle's law).

    Energy -p0 V0 ln(V / V0) + p_out V. p0 is the absolute pressure in the volume V0 at the start, p_out that around the
    mesh, 0 for none. Each corner of a triangle takes p A n / 3. Faces are oriented outwards; forces and moments sum to
    zero. Below a thousandth of V0 the gas stays as stiff as there. Meshes of more than 300 particles have no tangent:
    such models relax, and their stability is unknown.
    """

    kind: Literal["gas"] = "gas"
    mesh: str = Field(description="Name of a closed mesh")
    pressure: float = Field(default=1.0, ge=0, le=1e12, description="p0, absolute, at the start [force/length^2]")
    outside: float = Field(default=0.0, ge=0, le=1e12, description="p_out, absolute, around it [force/length^2]")

    formula: ClassVar[str] = "E = -p0 V0 ln(V/V0) + p_out V"
    example_faces: ClassVar[list[list[int]]] = [[0, 3, 2, 1], [0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: links, shares of triangles, p0, V0, p_out."""
        return self.blocked(places, self.mesh, self.pressure, self.outside, GAS, 1.0)

    @classmethod
    def example(cls) -> tuple[Gas, Floats]:
        """An irregular pyramid on a quad (`example_faces`)."""
        x = [[0, 0.1, 0], [2.1, 0, 0.3], [2, 2.3, 0.1], [-0.2, 2, 0.25], [0.9, 1.1, 1.9]]
        return cls(mesh="skin", pressure=3.0, outside=2.0), np.array(x)
