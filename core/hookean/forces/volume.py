"""Volume: closed meshes that keep a volume, as what is in them is compressed."""

from __future__ import annotations

from typing import ClassVar, Literal

import numpy as np

from hookean.forces.base import Block, Floats, Places
from hookean.forces.enclosed import ELASTIC, Enclosed
from hookean.values.fields import Field


class Volume(Enclosed):
    """A closed mesh that resists a change of its volume V: E = K (V - V0)^2 / (2 V0), a pressure p = K (V0 - V) / V0.

    K is the bulk modulus of what is in it, V0 the volume at the start times a factor. Each corner of a triangle takes p
    A n / 3. Faces are oriented outwards; forces and moments sum to zero. Meshes of more than 300 particles have no
    tangent: such models relax, and their stability is unknown.
    """

    kind: Literal["volume"] = "volume"
    mesh: str = Field(description="Name of a closed mesh")
    stiffness: float = Field(default=1000.0, ge=0, le=1e12, description="K, bulk modulus [force/length^2]")
    volume_factor: float = Field(default=1.0, ge=1e-6, le=1e6, description="Factor on the volume at the start [-]")

    formula: ClassVar[str] = "E = K (V - V0)²/(2 V0)"
    example_faces: ClassVar[list[list[int]]] = [[0, 3, 2, 1], [0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: links, shares of triangles, K, V0."""
        return self.blocked(places, self.mesh, self.stiffness, 0.0, ELASTIC, self.volume_factor)

    @classmethod
    def example(cls) -> tuple[Volume, Floats]:
        """An irregular pyramid on a quad (`example_faces`), a little too small."""
        x = [[0, 0.1, 0], [2.1, 0, 0.3], [2, 2.3, 0.1], [-0.2, 2, 0.25], [0.9, 1.1, 1.9]]
        return cls(mesh="skin", stiffness=3.0, volume_factor=1.2), np.array(x)
