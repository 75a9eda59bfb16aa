"""A mesh as two arrays, the form in which every part of hookean passes meshes on."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class Mesh:
    """Vertices `(n, 3)` float64 in length units and faces `(m, 4)` int64.

    A triangle repeats its third corner, `(a, b, c, c)`, as Rhino does.
    """

    vertices: NDArray[np.float64]
    faces: NDArray[np.int64]
