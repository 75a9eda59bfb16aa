"""Conical: a mesh of quads whose opposite angles at each vertex have the same sum."""

from __future__ import annotations

from typing import ClassVar, Literal

import numpy as np

from hookean.forces.base import Floats, Ints
from hookean.forces.vertex_angles import VertexAngles, two_fans


class Conical(VertexAngles):
    """Opposite angles at each vertex with four faces have the same sum: E = m (t1 - t2 + t3 - t4)^2 / 2.

    t1 to t4 are the angles of the faces round an interior vertex. Where the faces are flat (use `planarize`) they then
    touch a cone of revolution, and the mesh has offsets at a constant distance, and beams whose axes meet in nodes
    without torsion. Vertices with another number of faces have no such force. Forces and moments of each vertex sum to
    zero. Source: Wang, Wallner and Liu, "An angle criterion for conical mesh vertices", 2007.
    """

    kind: Literal["conical"] = "conical"

    formula: ClassVar[str] = "E = m (θ1 - θ2 + θ3 - θ4)²/2"

    @classmethod
    def signed(cls, corners: Ints) -> tuple[Ints, Floats]:
        """Vertices with four faces; of each face the sign is that of the one across, with which it shares no side."""
        _, which, count = np.unique(corners[:, 0], return_inverse=True, return_counts=True)
        corners = corners[count[which] == 4]
        sides = corners[:, 1:].reshape(-1, 4, 2)
        common = (sides[:, :, :, None] == sides[:, :1, None, :]).any(axis=(2, 3))
        common[:, 0] = False
        return corners, np.where(common, -1.0, 1.0).ravel()

    @classmethod
    def example(cls) -> tuple[Conical, Floats]:
        """Two fans of four triangles, apart from each other (`example_faces`)."""
        return cls(mesh="skin", strength=7.0), two_fans()
