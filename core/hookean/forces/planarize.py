"""Planarize: quads, and polygons of more corners, that become flat."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.compiled.marks import device
from hookean.forces.base import Block, Floats, Force, Ints, Places, lengths
from hookean.forces.line_angles import cross
from hookean.forces.mesh_edges import quads
from hookean.forces.soapfilm import SLIVER
from hookean.values.columns import IndexRows, PointRows
from hookean.values.fields import Field, Maybe


@device
def gap(x: Any, indices: Any, e: Any, g: Any, share: Any) -> Any:
    """Distance of the diagonals of a quad, and `share` (4,) of it at each corner: the points of the diagonals that are
    nearest to each other are apart by d n = sum of share x corner. nan where the diagonals have no common normal.

    `g` (5, 3): the diagonals 0-2 and 1-3, the first side, n, and room.
    """
    for c in range(3):
        g[0, c] = x[indices[e, 2], c] - x[indices[e, 0], c]
        g[1, c] = x[indices[e, 3], c] - x[indices[e, 1], c]
        g[2, c] = x[indices[e, 1], c] - x[indices[e, 0], c]
    cross(g[0], g[1], g[3])
    size = np.sqrt(g[3, 0] * g[3, 0] + g[3, 1] * g[3, 1] + g[3, 2] * g[3, 2])
    one = np.sqrt(g[0, 0] * g[0, 0] + g[0, 1] * g[0, 1] + g[0, 2] * g[0, 2])
    other = np.sqrt(g[1, 0] * g[1, 0] + g[1, 1] * g[1, 1] + g[1, 2] * g[1, 2])
    if not (size > SLIVER * one * other and size > 1e-140):
        return np.nan
    distance = 0.0
    for c in range(3):
        g[3, c] /= size
        distance += g[2, c] * g[3, c]
    for i in range(2):
        # how far along one diagonal: (side x other diagonal) . n / |0-2 x 1-3|
        cross(g[2], g[1 - i], g[4])
        along = (g[4, 0] * g[3, 0] + g[4, 1] * g[3, 1] + g[4, 2] * g[3, 2]) / size
        share[i] = (along - 1.0) if i == 0 else (1.0 - along)
        share[2 + i] = -along if i == 0 else along
    return distance


def planarize_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy, g, share = 0.0, np.zeros((5, 3)), np.zeros(4)
    for e in range(indices.shape[0]):
        distance, k = gap(x, indices, e, g, share), parameters[e, 0]
        if np.isnan(distance):
            continue
        energy += 0.5 * k * distance * distance
        total = np.abs(share[0]) + np.abs(share[1]) + np.abs(share[2]) + np.abs(share[3])
        for i in range(4):
            # the energy is a minimum by the places on the diagonals: it is at most as stiff as where these are fixed
            w[indices[e, i]] += k * np.abs(share[i]) * total
            for c in range(3):
                f[indices[e, i], c] -= k * distance * share[i] * g[3, c]
    return energy


def planarize_hessian(x, indices, parameters, memory, blocks):  # type: ignore[no-untyped-def]
    # of the least |sum share x|^2 / 2 by the places s, t on the diagonals: K_xx - K_xq K_qq^-1 K_qx
    g, share, mixed = np.zeros((5, 3)), np.zeros(4), np.zeros((12, 2))
    for e in range(indices.shape[0]):
        distance, k = gap(x, indices, e, g, share), parameters[e, 0]
        if np.isnan(distance):
            continue
        aa = ab = bb = 0.0
        for c in range(3):
            aa += g[0, c] * g[0, c]
            ab += g[0, c] * g[1, c]
            bb += g[1, c] * g[1, c]
            for i in range(4):
                turn = distance * g[3, c] * (1.0 if i < 2 else -1.0)
                mixed[3 * i + c, 0] = -share[i] * g[0, c] + (turn if i % 2 == 0 else 0.0)
                mixed[3 * i + c, 1] = share[i] * g[1, c] - (turn if i % 2 == 1 else 0.0)
        cross(g[0], g[1], g[4])
        square = g[4, 0] * g[4, 0] + g[4, 1] * g[4, 1] + g[4, 2] * g[4, 2]
        for i in range(12):
            p, q = mixed[i, 0], mixed[i, 1]
            for j in range(i + 1):
                r, s = mixed[j, 0], mixed[j, 1]
                entry = -(bb * p * r + ab * (p * s + q * r) + aa * q * s) / square
                if i % 3 == j % 3:
                    entry += share[i // 3] * share[j // 3]
                blocks[e, i, j] = k * entry
                blocks[e, j, i] = k * entry


class Planarize(Force):
    """Quads that become flat: E = k d^2 / 2, d the distance between the diagonals.

    The force k d acts along the common normal of the diagonals, through the points where they are nearest to each
    other, and is shared by their ends accordingly: forces and moments sum to zero. In a quad whose diagonals halve each
    other each corner takes k d / 2, as in K2. Polygons of n corners, given as rows of n particles, are made flat by the
    n quads of four corners in a row. A quad whose diagonals are parallel, or that has one of zero length, has no force.
    Triangles of the mesh are flat.
    """

    kind: Literal["planarize"] = "planarize"
    particles: Maybe[IndexRows] = Field(default=None, description="Corners of each polygon, four or more, in order")
    points: Maybe[PointRows] = Field(default=None, description="Coordinates of the corners of each polygon, in order")
    mesh: str | None = Field(default=None, description="Name of a mesh: its quads")
    stiffness: float = Field(default=1.0, ge=0, le=1e12, description="k [force/length]")

    formula: ClassVar[str] = "E = k d²/2"
    arity: ClassVar[int] = 4
    solid: ClassVar[bool] = False
    outputs: ClassVar[dict[str, str]] = {"distance": "length", "force": "force"}
    kernel: ClassVar[Any] = staticmethod(planarize_kernel)
    hessian: ClassVar[Any] = staticmethod(planarize_hessian)
    example_faces: ClassVar[list[list[int]]] = [[0, 1, 2, 3], [1, 4, 5, 2], [3, 2, 6, 6]]

    @property
    def element_arity(self) -> int:
        """Polygons have four corners or more."""
        rows = self.particles if self.particles is not None else self.points
        return max(4, rows.shape[1]) if rows is not None and rows.ndim > 1 else 4

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: k."""
        if self.mesh is None:
            return Block.of(in_fours(places.elements(self)), stiffness=self.stiffness)
        return Block.of(quads(places.faces(self.mesh)), stiffness=self.stiffness)

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """Distance between the diagonals of each quad [length], 0 where they are parallel, and the force that closes it
        [force]."""
        p, q, r, s = (x[corner] for corner in block.indices.T)
        normal = np.cross(r - p, s - q)
        size = lengths(normal)
        common = (size > SLIVER * lengths(r - p) * lengths(s - q)) & (size > 1e-140)
        distance = np.where(common, np.abs(((q - p) * normal).sum(axis=1)) / np.where(common, size, 1.0), 0.0)
        return {"distance": distance, "force": block.parameters[:, 0] * distance}

    @classmethod
    def example(cls) -> tuple[Planarize, Floats]:
        """Two quads beside a triangle (`example_faces`)."""
        x = [[0, 0, 0.3], [2, 0.2, 0], [2.3, 1.9, 0.4], [-0.2, 1.5, -0.1], [3.7, -0.3, 0.5], [4.1, 2.2, -0.2]]
        return cls(mesh="skin", stiffness=30.0), np.array([*x, [1.0, 3.0, 0.5]])


def in_fours(rows: Ints) -> Ints:
    """Quads (k, 4) of four corners in a row of polygons (m, n): n of them, and one of a quad."""
    count = rows.shape[1]
    starts = np.arange(1 if count == 4 else count)
    return np.ascontiguousarray(rows[:, (starts[:, None] + np.arange(4)) % count].reshape(-1, 4))
