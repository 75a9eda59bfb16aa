"""Smooth: vertices of a mesh that are pulled to the mean of their neighbours."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.forces import groups
from hookean.forces.base import Block, Floats, Force, Places, complete, lengths
from hookean.forces.groups import begins, following
from hookean.forces.soapfilm import SLIVER, halves
from hookean.values.fields import Field
from hookean.values.mesh import Mesh

STIFF, SHARE = 2, 3  # columns of the parameters, after the links


def smooth_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy, r = 0.0, np.zeros(3)
    for first in range(indices.shape[0]):
        if not begins(parameters, first):
            continue
        stiff, spread, a = parameters[first, STIFF], 0.0, indices[first, 0]
        r[:] = 0.0
        e = first
        while e >= 0:
            spread += np.abs(parameters[e, SHARE])
            for c in range(3):
                r[c] += parameters[e, SHARE] * (x[a, c] - x[indices[e, 1], c])
            e = following(parameters, e)
        energy += 0.5 * stiff * (r[0] * r[0] + r[1] * r[1] + r[2] * r[2])
        e = first
        while e >= 0:
            # the tangent is k s s with the shares s: |s_i| times the sum of all |s|
            part, b = stiff * parameters[e, SHARE], indices[e, 1]
            w[a] += 2.0 * np.abs(part) * spread
            w[b] += 2.0 * np.abs(part) * spread
            for c in range(3):
                f[a, c] -= part * r[c]
                f[b, c] += part * r[c]
            e = following(parameters, e)
    return energy


class Smooth(groups.Grouped):
    """Vertices of a mesh are pulled to the weighted mean of their neighbours: E = k |p - sum w_j p_j|^2 / 2.

    The weights sum to 1 and are those of the start shape, so the force is linear: -k r on the vertex and k w_j r on
    its neighbours, r = p - sum w_j p_j. Forces and moments sum to zero. Uniform weights are those of K2's Smooth, which
    has half of its strength as k: they also make edges equally long. Cotangent weights (of a quad the mean of both
    cuts) are those of Laplace's equation on the mesh: no vertex of a flat mesh moves within its plane. With inverse
    lengths near neighbours count more (Fujiwara). A vertex whose weights have no positive sum gets uniform ones.
    Interior vertices have a force of their own; the others only as neighbours, unless all are asked for.
    """

    kind: Literal["smooth"] = "smooth"
    mesh: str = Field(description="Name of the mesh")
    stiffness: float = Field(default=1.0, ge=0, le=1e12, description="k [force/length]")
    weights: Literal["uniform", "cotangent", "inverse_length"] = Field(
        default="uniform", description="Weights of the neighbours: uniform, cotangent or inverse_length"
    )
    vertices: Literal["interior", "all"] = Field(default="interior", description="Which vertices: interior or all")

    formula: ClassVar[str] = "E = k |p - Σ w p_j|²/2"
    arity: ClassVar[int] = 2
    solid: ClassVar[bool] = False
    outputs: ClassVar[dict[str, str]] = {"distance": "length", "force": "force"}
    kernel: ClassVar[Any] = staticmethod(smooth_kernel)
    example_faces: ClassVar[list[list[int]]] = [
        *([0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5], [0, 5, 1]),
        *([6, 7, 8, 14], [8, 9, 10, 14], [10, 11, 12, 14], [12, 13, 6, 14]),
    ]

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: links of each vertex with its neighbours, k, weights."""
        from hookean.discretize.meshes import boundary, tidy_faces

        mesh = Mesh(places.x, tidy_faces(complete(places.faces(self.mesh))))
        centre, other, weight = neighbours(mesh, self.weights)
        if self.vertices == "interior":
            kept = np.isin(centre, boundary(mesh)[1])
            centre, other, weight = centre[kept], other[kept], weight[kept]
        pairs = np.column_stack([centre, other])
        return Block.of(pairs, links=groups.links(pairs, centre), stiffness=self.stiffness, share=weight)

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """Distance of the vertex from the mean of its neighbours [length], for each of these, and the force on the
        neighbour [force]."""
        head = groups.heads(block)
        apart = block.parameters[:, SHARE, None] * (x[block.indices[:, 0]] - x[block.indices[:, 1]])
        mean: Floats = np.column_stack([np.bincount(head, part, len(head)) for part in apart.T])
        return {"distance": lengths(mean[head]), "force": element_forces[:, 1]}

    @classmethod
    def gathered(cls, block: Block, memory: Floats, x: Floats, node: int | None) -> list[tuple[type[Force], Block]]:
        """Each vertex with all of its neighbours."""
        found: list[tuple[type[Force], Block]] = []
        for rows in groups.by_size(block):
            index = np.column_stack([block.indices[rows[:, 0], 0], block.indices[rows, 1]])
            share = block.parameters[rows, SHARE]
            share = np.column_stack([share.sum(axis=1), -share])
            stiffness = np.einsum("e,ei,ej,cd->eicjd", block.parameters[rows[:, 0], STIFF], share, share, np.eye(3))
            found.append((groups.Whole, groups.stiff(index, stiffness)))
        return found

    @classmethod
    def no_tangent(cls, block: Block, *, sparse: bool) -> str:
        """Vertices have few neighbours."""
        return ""

    @classmethod
    def example(cls) -> tuple[Smooth, Floats]:
        """Two pieces with one interior vertex each (`example_faces`), of triangles and of quads."""
        turn = 2.0 * np.pi * np.arange(13) / np.repeat([5, 8], [5, 8])
        rim = np.column_stack([np.cos(turn), 1.2 * np.sin(turn), 0.3 * np.cos(2.0 * turn + 0.5)])
        rim[5:, 0] += 4.0
        x = np.vstack([[0.2, 0.1, 0.4], rim, [4.1, -0.2, 0.5]])
        return cls(mesh="skin", stiffness=7.0, weights="cotangent"), x


def neighbours(mesh: Mesh, weights: str) -> tuple[Any, Any, Floats]:
    """Vertices (k,), a neighbour of each (k,) and its weight (k,), which sum to 1 for each vertex."""
    from scipy.sparse import coo_array

    from hookean.discretize.meshes import edges

    x = mesh.vertices
    if weights == "cotangent":
        corners, part, _ = halves(mesh.faces)
        apex, a, b = corners.T.ravel(), np.roll(corners, -1, 1).T.ravel(), np.roll(corners, -2, 1).T.ravel()
        u, v = x[a] - x[apex], x[b] - x[apex]
        area, size = lengths(np.cross(u, v)), (u * u).sum(axis=1) + (v * v).sum(axis=1)
        flat = area > SLIVER * size
        value = np.where(flat, np.tile(part, 3) * (u * v).sum(axis=1) / np.where(flat, area, 1.0), 0.0)
    else:
        a, b = edges(mesh).T
        apart = lengths(x[b] - x[a])
        value = np.ones(len(a))
        if weights == "inverse_length":
            value = np.where(apart > 0.0, 1.0 / np.where(apart > 0.0, apart, 1.0), 0.0)
    ends, others = np.concatenate([a, b]), np.concatenate([b, a])
    table = coo_array((np.tile(value, 2), (ends, others)), (len(x), len(x))).tocsr()
    centre = np.repeat(np.arange(len(x)), np.diff(table.indptr))
    total = np.bincount(centre, table.data, len(x))
    good = (total > SLIVER * np.bincount(centre, np.abs(table.data), len(x))) & np.isfinite(total)
    data = np.where(good[centre], table.data / np.where(good, total, 1.0)[centre], 1.0 / np.diff(table.indptr)[centre])
    return centre, table.indices.astype(np.int64), data
