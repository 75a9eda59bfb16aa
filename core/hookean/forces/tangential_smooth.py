"""Tangential smooth: vertices of a mesh that move along it, under the mean of their neighbours."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.compiled.marks import device
from hookean.forces import groups
from hookean.forces.base import Block, Floats, Force, Places, complete, lengths
from hookean.forces.groups import begins, following
from hookean.forces.line_angles import cross
from hookean.forces.soapfilm import SLIVER
from hookean.forces.vertex_angles import VertexAngles, around, rings, two_fans
from hookean.values.fields import Field

STIFF, SHARE = 2, 3  # columns of the parameters, after the links
R, N, Q, A, B, ROOM = 0, 1, 2, 3, 4, 7  # rows of the room to work in


@device
def size(v: Any) -> Any:
    """Length of a vector."""
    return np.sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])


@device
def spokes(x: Any, indices: Any, e: Any, g: Any) -> None:
    """Write the vectors from the vertex to both neighbours of a corner."""
    for c in range(3):
        g[A, c] = x[indices[e, 1], c] - x[indices[e, 0], c]
        g[B, c] = x[indices[e, 2], c] - x[indices[e, 0], c]


@device
def lean(x: Any, indices: Any, parameters: Any, first: Any, g: Any) -> Any:
    """Size of the area vector of a ring, height h of the vertex over the mean of its neighbours, and bounds of the
    slopes of the area vector; 0, 0, 0 without a normal.

    `g` (7, 3): the vector r from the mean to the vertex, the normal n, the part of r in the tangent plane.
    """
    g[R] = 0.0
    g[N] = 0.0
    whole, reach = 0.0, 0.0
    e = first
    while e >= 0:
        spokes(x, indices, e, g)
        cross(g[A], g[B], g[5])
        whole += 0.5 * size(g[5])
        reach += size(g[A]) + size(g[B])
        for c in range(3):
            g[R, c] -= 0.5 * parameters[e, SHARE] * (g[A, c] + g[B, c])
            g[N, c] += 0.5 * g[5, c]
        e = following(parameters, e)
    area = size(g[N])
    if not (area > SLIVER * whole and whole > 1e-140):
        return 0.0, 0.0, 0.0
    height = 0.0
    for c in range(3):
        g[N, c] /= area
        height += g[R, c] * g[N, c]
    for c in range(3):
        g[Q, c] = g[R, c] - height * g[N, c]
    return area, height, reach


def tangential_smooth_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy, g = 0.0, np.zeros((ROOM, 3))
    for first in range(indices.shape[0]):
        if not begins(parameters, first):
            continue
        area, height, reach = lean(x, indices, parameters, first, g)
        if area == 0.0:
            continue
        k, apart = parameters[first, STIFF], size(g[Q])
        energy += 0.5 * k * apart * apart
        tilt, high = height / area, np.abs(height) / area
        e = first
        while e >= 0:
            part = parameters[e, SHARE]
            spokes(x, indices, e, g)
            cross(g[B], g[Q], g[5])
            cross(g[Q], g[A], g[6])
            for i in range(3):
                own = part if i == 0 else 0.5 * part
                slope = 0.5 * (size(g[A]) + size(g[B])) if i == 0 else 0.5 * size(g[B if i == 1 else A])
                # how r, n and the second derivatives of n change by this particle, times all others
                bound = own * reach + 2.0 * slope + (2.0 * apart / area + high) * slope * reach + apart
                w[indices[e, i]] += k * (2.0 * own + high * bound)
            for c in range(3):
                pull, one, other = k * part * g[Q, c], 0.5 * k * tilt * g[5, c], 0.5 * k * tilt * g[6, c]
                f[indices[e, 0], c] -= pull + one + other
                f[indices[e, 1], c] += 0.5 * pull + one
                f[indices[e, 2], c] += 0.5 * pull + other
            e = following(parameters, e)
    return energy


class TangentialSmooth(groups.Grouped):
    """Interior vertices of a mesh move along it, under or over the mean of their neighbours: E = k |r - (r.n) n|^2 / 2.

    r is the vector from the mean of the neighbours to the vertex, n the normal of their ring, along its area vector.
    The vertex is pulled in its tangent plane only, and keeps its height over the mean; where it has a height, the
    neighbours feel a small couple that turns the normal: forces and moments sum to zero. It keeps meshes even without
    making them flat. The faces have one orientation. A ring without area has no normal and no force. `soapfilm` keeps
    its triangles even by itself.
    """

    kind: Literal["tangential_smooth"] = "tangential_smooth"
    mesh: str = Field(description="Name of the mesh")
    stiffness: float = Field(default=1.0, ge=0, le=1e12, description="k [force/length]")

    formula: ClassVar[str] = "E = k |r - (r·n) n|²/2"
    arity: ClassVar[int] = 3
    solid: ClassVar[bool] = False
    outputs: ClassVar[dict[str, str]] = {"distance": "length", "force": "force"}
    kernel: ClassVar[Any] = staticmethod(tangential_smooth_kernel)
    example_faces: ClassVar[list[list[int]]] = VertexAngles.example_faces

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: links of the corners of each vertex, k, one over their number."""
        index = around(complete(places.faces(self.mesh)))
        count = np.bincount(index[:, 0], minlength=1)[index[:, 0]]
        links = groups.links(index, index[:, 0])
        return Block.of(index, links=links, stiffness=self.stiffness, share=1.0 / count)

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """Distance of the vertex of each corner from the normal through the mean of its neighbours [length], and k
        times this [force]."""
        distance = np.zeros(len(block.indices))
        for rows in groups.by_size(block):
            distance[rows] = lengths(_ring(block, rows, x)[5])[:, None]
        return {"distance": distance, "force": block.parameters[:, STIFF] * distance}

    @classmethod
    def gathered(cls, block: Block, memory: Floats, x: Floats, node: int | None) -> list[tuple[type[Force], Block]]:
        """Each vertex with all of its neighbours."""
        found: list[tuple[type[Force], Block]] = []
        for rows in groups.by_size(block):
            stiffness = block.parameters[rows[:, 0], STIFF, None, None] * _second(block, rows, x)
            found.append((groups.Whole, groups.stiff(rings(block, rows)[0], stiffness)))
        return found

    @classmethod
    def no_tangent(cls, block: Block, *, sparse: bool) -> str:
        """Vertices have few neighbours."""
        return ""

    @classmethod
    def example(cls) -> tuple[TangentialSmooth, Floats]:
        """Two fans of four triangles, apart from each other (`example_faces`)."""
        return cls(mesh="skin", stiffness=7.0), two_fans()


def _ring(block: Block, rows: Any, x: Floats) -> tuple[Floats, ...]:
    """Of vertices with `rows` (k, c) of corners: the spokes to both neighbours (k, c, 3), twice; sizes of area vectors
    and heights (k,), 0 without a normal; normals and parts of r in the tangent planes (k, 3)."""
    a, b = (x[block.indices[rows, i]] - x[block.indices[rows, 0]] for i in (1, 2))
    r = -0.5 * (a + b).mean(axis=1)
    crosses = 0.5 * np.cross(a, b)
    area, whole = lengths(crosses.sum(axis=1)), np.linalg.norm(crosses, axis=2).sum(axis=1)
    there = (area > SLIVER * whole) & (whole > 1e-140)
    area = np.where(there, area, 0.0)
    normal = crosses.sum(axis=1) / np.where(there, area, 1.0)[:, None] * there[:, None]
    height = (r * normal).sum(axis=1)
    return a, b, area, height, normal, (r - height[:, None] * normal) * there[:, None]


def _second(block: Block, rows: Any, x: Floats) -> Floats:
    """Second derivatives (k, s, s) of (|r|^2 - h^2) / 2, h = r.n, by the vertices and their neighbours."""
    a, b, area, height, normal, flat = _ring(block, rows, x)
    place, (many, corners), each = rings(block, rows)[1], rows.shape, np.arange(len(rows))
    eye, points = np.eye(3), corners + 1
    mean, turn = np.zeros((many, 3, points, 3)), np.zeros((many, 3, points, 3))  # of r and of the area vector
    bent = np.zeros((many, points, 3, points, 3))  # of the area vector along `flat`
    skew = -0.5 * np.cross(flat[:, None], eye).transpose(0, 2, 1)
    for j in range(corners):
        v, p, q = place[:, j].T
        by_p = -0.5 * np.cross(b[:, j, None], eye).transpose(0, 2, 1)
        by_q = 0.5 * np.cross(a[:, j, None], eye).transpose(0, 2, 1)
        for own, slope, part in ((v, -by_p - by_q, 1.0), (p, by_p, -0.5), (q, by_q, -0.5)):
            turn[each, :, own] += slope
            mean[each, :, own] += part / corners * eye
        for one, sign in ((p, 1.0), (v, -1.0)):
            for other, more in ((q, sign), (v, -sign)):
                bent[each, one, :, other] += more * skew
                bent[each, other, :, one] += more * skew.transpose(0, 2, 1)
    mean, turn = mean.reshape(many, 3, -1), turn.reshape(many, 3, -1)
    there = area > 0.0
    less = (1.0 / np.where(there, area, 1.0))[:, None, None]
    across = eye - normal[:, :, None] * normal[:, None]
    along, aside = (np.einsum("kc,kcs->ks", vector, turn) for vector in (normal, flat))
    slope = np.einsum("kc,kcs->ks", normal, mean) + less[:, 0] * aside
    mixed = less * np.einsum("kcs,kcd,kdt->kst", mean, across, turn, optimize=True)
    mixed -= less**2 * along[:, :, None] * aside[:, None]
    second = mixed + mixed.transpose(0, 2, 1) + less * bent.reshape(mixed.shape)
    second -= less**2 * height[:, None, None] * np.einsum("kcs,kcd,kdt->kst", turn, across, turn, optimize=True)
    whole = np.einsum("kcs,kct->kst", mean, mean) - slope[:, :, None] * slope[:, None]
    return np.asarray((whole - height[:, None, None] * second) * there[:, None, None])
