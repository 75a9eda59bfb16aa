"""Developable: a mesh whose angles round each interior vertex sum to a full turn."""

from __future__ import annotations

from typing import ClassVar, Literal

import numpy as np

from hookean.forces.base import Floats
from hookean.forces.vertex_angles import VertexAngles, two_fans


class Developable(VertexAngles):
    """Angles round each interior vertex of a mesh sum to 2 pi, as in a sheet: E = m (sum theta - 2 pi)^2 / 2.

    A mesh of flat faces with this property at all interior vertices unrolls into the plane. theta are the angles of the
    faces at the vertex, those of quads between their two sides (use `planarize` for quads that are not flat). Forces
    and moments of each vertex sum to zero. A vertex with a side of zero length counts without the angles there.
    """

    kind: Literal["developable"] = "developable"

    formula: ClassVar[str] = "E = m (Σθ - 2π)²/2"
    rest: ClassVar[float] = 2.0 * np.pi

    @classmethod
    def example(cls) -> tuple[Developable, Floats]:
        """Two fans of triangles, apart from each other (`example_faces`)."""
        return cls(mesh="skin", strength=7.0), two_fans()
