"""What loads on the triangles of meshes share: their sides and area vectors, their shares, and their tangents.

A load F = F(N) by the area vector N / 2 of a triangle puts a third of it on each corner. As dN = sum of (side opposite
to the corner) x dx, its derivative by a corner is dF/dN [side] x.
"""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np

from hookean.compiled.marks import device
from hookean.forces.base import Floats, Force, Ints, OnFilm, Places, complete
from hookean.forces.soapfilm import halves


@device
def sides(x: Any, indices: Any, e: Any, g: Any, n: Any) -> Any:
    """Write the sides (3, 3) opposite to the corners of a triangle and twice its area vector; its length."""
    for i in range(3):
        a = indices[e, (i + 1) % 3]
        b = indices[e, (i + 2) % 3]
        for c in range(3):
            g[i, c] = x[b, c] - x[a, c]
    n[0] = g[0, 1] * g[1, 2] - g[0, 2] * g[1, 1]
    n[1] = g[0, 2] * g[1, 0] - g[0, 0] * g[1, 2]
    n[2] = g[0, 0] * g[1, 1] - g[0, 1] * g[1, 0]
    return np.sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2])


@device
def length(g: Any, i: Any) -> Any:
    """Length of a side."""
    return np.sqrt(g[i, 0] * g[i, 0] + g[i, 1] * g[i, 1] + g[i, 2] * g[i, 2])


@device
def share(indices: Any, e: Any, push: Any, rate: Any, g: Any, f: Any, w: Any) -> None:
    """Put a third of `push` on each corner; `rate` is the largest |dF/dN|."""
    reach = length(g, 0) + length(g, 1) + length(g, 2)
    for i in range(3):
        w[indices[e, i]] += rate / 6.0 * (reach + 3.0 * length(g, i))
        for c in range(3):
            f[indices[e, i], c] += push[c] / 3.0


@device
def fill(blocks: Any, e: Any, slope: Any, g: Any) -> None:
    """Write the symmetric part of the stiffness from `slope` (3, 3), dF/dN."""
    for i in range(3):
        for j in range(3):
            for c in range(3):
                for k in range(3):
                    u, d = (k + 1) % 3, (k + 2) % 3
                    p, q = (c + 1) % 3, (c + 2) % 3
                    # (D [g])_ck = D_cu g_d - D_cd g_u, and the transpose
                    one = slope[c, u] * g[j, d] - slope[c, d] * g[j, u]
                    other = slope[k, p] * g[i, q] - slope[k, q] * g[i, p]
                    blocks[e, 3 * i + c, 3 * j + k] = -(one + other) / 6.0


class FaceLoad(Force):
    """Base of loads on the triangles of a mesh; a quad is the mean of its two cuts."""

    role: ClassVar[Any] = "load"
    conservative: ClassVar[bool] = False
    creates: ClassVar[bool] = False
    arity: ClassVar[int] = 3
    outputs: ClassVar[dict[str, str]] = {"force": "force"}
    on_film: ClassVar[OnFilm] = "across"
    example_faces: ClassVar[list[list[int]]] = [[0, 1, 4, 3], [1, 2, 5, 4], [3, 4, 7, 6], [4, 5, 8], [4, 8, 7]]

    @staticmethod
    def triangles(places: Places, mesh: str) -> tuple[Ints, Floats]:
        """Triangles (m, 3) of the scene's mesh whose corners met particles, and their shares (m,)."""
        corners, part, _ = halves(complete(places.faces(mesh)))
        return corners, part


def dome() -> Floats:
    """An irregular dome of quads and triangles, `FaceLoad.example_faces`."""
    x = [[0.0, 0.1, 0.0], [1.1, 0.0, 0.3], [2.0, -0.1, 0.1], [0.1, 1.0, 0.35], [0.9, 1.1, 0.7], [2.1, 0.9, 0.3]]
    return np.array([*x, [-0.1, 2.0, 0.05], [1.0, 2.2, 0.4], [1.9, 2.1, -0.1]])
