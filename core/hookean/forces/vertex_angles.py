"""What forces on the angles round interior vertices of meshes share: E = m a^2 / 2, a a signed sum of these angles.

A vertex is a group of corners: the vertex, and its neighbours before and after in one face. The gradient of an angle is
that of `line_angles` for the two sides that meet there. Its second derivatives are -(u p + p u) / |a|^2 in the plane of
the corner and n n cot(theta) / |a|^2 across it, where both sides are joined by -n n / (|a| |b| sin theta).
"""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np

from hookean.compiled import dispatch
from hookean.compiled.marks import device
from hookean.forces import groups
from hookean.forces.base import Block, Floats, Force, Ints, Places, complete
from hookean.forces.groups import begins, following
from hookean.forces.line_angles import PARALLEL, fill, line_angles, spread
from hookean.values.fields import Field

STRENGTH, REST, SIGN = 2, 3, 4  # columns of the parameters, after the links


@device
def corner(x: Any, indices: Any, e: Any, g: Any) -> Any:
    """`line_angles.spread` of the two sides of a corner."""
    return spread(x, indices[e, 0], indices[e, 1], indices[e, 0], indices[e, 2], g)


@device
def excess(x: Any, indices: Any, parameters: Any, first: Any, g: Any) -> Any:
    """The signed sum of the angles round a vertex, less that at rest, and a bound of the sum of its gradients."""
    total, reach = -parameters[first, REST], 0.0
    e = first
    while e >= 0:
        sine, cosine, a, b = corner(x, indices, e, g)
        if not np.isnan(sine):
            total += parameters[e, SIGN] * np.arctan2(sine, cosine)
            reach += 2.0 * (1.0 / a + 1.0 / b)
        e = following(parameters, e)
    return total, reach


def vertex_angles_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy, g = 0.0, np.zeros((5, 3))
    for first in range(indices.shape[0]):
        if not begins(parameters, first):
            continue
        strength = parameters[first, STRENGTH]
        off, reach = excess(x, indices, parameters, first, g)
        energy += 0.5 * strength * off * off
        e = first
        while e >= 0:
            sine, cosine, a, b = corner(x, indices, e, g)
            if not np.isnan(sine):
                moment, bend = strength * off * parameters[e, SIGN], np.abs(strength * off)
                for i in range(2):
                    own, other = (a, b) if i == 0 else (b, a)
                    turn = bend / own / own
                    if sine > PARALLEL:
                        turn = max(turn, bend * (np.abs(cosine) / own + 1.0 / other) / sine / own)
                    w[indices[e, 1 + i]] += strength * reach / own + 2.0 * turn
                    w[indices[e, 0]] += strength * reach / own + 2.0 * turn
                    for c in range(3):
                        push = moment / own * g[2 + i, c]
                        f[indices[e, 1 + i], c] += push
                        f[indices[e, 0], c] -= push
            e = following(parameters, e)
    return energy


def vertex_angles_second(x, indices, parameters, moments, slopes, whole):  # type: ignore[no-untyped-def]
    """Write the moment of each corner (m,), the gradient of its signed angle (m, 12) and m a times the second
    derivatives of that (m, 12, 12), by vertex, side, vertex, side."""
    g = np.zeros((5, 3))
    for first in range(indices.shape[0]):
        if not begins(parameters, first):
            continue
        off, _ = excess(x, indices, parameters, first, g)
        e = first
        while e >= 0:
            moments[e] = parameters[first, STRENGTH] * off
            sine, cosine, a, b = corner(x, indices, e, g)
            if not np.isnan(sine):
                fill(whole, e, 0.0, moments[e] * parameters[e, SIGN], sine, cosine, a, b, g)
                for i in range(2):
                    for c in range(3):
                        slope = parameters[e, SIGN] * g[2 + i, c] / (a if i == 0 else b)
                        slopes[e, 6 * i + c] = slope
                        slopes[e, 6 * i + 3 + c] = -slope
            e = following(parameters, e)


class VertexAngles(groups.Grouped):
    """Base of these forces: interior vertices of a mesh, those with faces all round."""

    mesh: str = Field(description="Name of the mesh")
    strength: float = Field(default=1.0, ge=0, le=1e12, description="m, moment per angle [force length]")

    arity: ClassVar[int] = 3
    solid: ClassVar[bool] = False
    outputs: ClassVar[dict[str, str]] = {"angle": "angle", "moment": "moment"}
    kernel: ClassVar[Any] = staticmethod(vertex_angles_kernel)
    rest: ClassVar[float] = 0.0
    example_faces: ClassVar[list[list[int]]] = [[c, c + 1 + i, c + 1 + (i + 1) % 4] for c in (0, 5) for i in range(4)]

    @classmethod
    def signed(cls, corners: Ints) -> tuple[Ints, Floats]:
        """Those of the `corners` (m, 3) of vertices, one vertex after the other, that count, and their signs (m,)."""
        return corners, np.ones(len(corners))

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: links of the corners of each vertex, m, angle at rest, signs."""
        index, sign = self.signed(around(complete(places.faces(self.mesh))))
        links = groups.links(index, index[:, 0])
        return Block.of(index, links=links, strength=self.strength, rest=self.rest, sign=sign)

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """How far the sum of the angles of the vertex of each corner is from rest [rad], and m times this [force
        length]."""
        head = groups.heads(block)
        angle = block.parameters[:, SIGN] * line_angles(x, block.indices[:, [0, 1, 0, 2]])
        off = np.bincount(head, angle, len(head))[head] - block.parameters[:, REST]
        return {"angle": off, "moment": block.parameters[:, STRENGTH] * off}

    @classmethod
    def gathered(cls, block: Block, memory: Floats, x: Floats, node: int | None) -> list[tuple[type[Force], Block]]:
        """Each vertex with all of its neighbours."""
        count = len(block.indices)
        moments, slopes, bent = np.zeros(count), np.zeros((count, 12)), np.zeros((count, 12, 12))
        dispatch.compiled(vertex_angles_second)(x, block.indices, block.parameters, moments, slopes, bent)
        found: list[tuple[type[Force], Block]] = []
        for rows in groups.by_size(block):
            many, corners = rows.shape
            index, place = rings(block, rows)
            slope = np.zeros((many, corners + 1, 3))
            whole = np.zeros((many, corners + 1, 3, corners + 1, 3))
            each = np.arange(many)
            for j in range(corners):
                own = place[:, j, [0, 1, 0, 2]].T
                for p in range(4):
                    slope[each, own[p]] += slopes[rows[:, j], 3 * p : 3 * p + 3]
                    for q in range(4):
                        part = bent[rows[:, j], 3 * p : 3 * p + 3, 3 * q : 3 * q + 3]
                        whole[each, own[p], :, own[q]] += part
            strength = block.parameters[rows[:, 0], STRENGTH]
            whole += np.einsum("e,eic,ejd->eicjd", strength, slope, slope)
            found.append((groups.Whole, groups.stiff(index, whole)))
        return found

    @classmethod
    def no_tangent(cls, block: Block, *, sparse: bool) -> str:
        """Vertices have few neighbours."""
        return ""


def rings(block: Block, rows: Ints) -> tuple[Ints, Ints]:
    """Of vertices with `rows` (k, c) of corners the particles (k, 1 + c), the vertex and its neighbours, and which of
    these each corner has (k, c, 3): every neighbour is in two corners."""
    many, corners = rows.shape
    ends = block.indices[rows, 1:].reshape(many, -1)
    order = np.argsort(ends, axis=1, kind="stable")
    place = np.empty_like(order)
    np.put_along_axis(place, order, np.arange(2 * corners)[None, :] // 2, axis=1)
    own = np.zeros((many, corners, 3), np.int64)
    own[:, :, 1:] = 1 + place.reshape(many, corners, 2)
    return np.column_stack([block.indices[rows[:, 0], 0], np.take_along_axis(ends, order, 1)[:, ::2]]), own


def around(faces: Ints) -> Ints:
    """Corners (m, 3) of interior vertices, one vertex after the other: vertex, and its neighbours in one face.

    Interior are vertices of which every neighbour is in two of their faces.
    """
    quad = faces[:, 2] != faces[:, 3]
    found = []
    for some, sides in ((faces[quad], 4), (faces[~quad], 3)):
        loop = some[:, :sides]
        found.append(np.stack([loop, np.roll(loop, -1, axis=1), np.roll(loop, 1, axis=1)], axis=2).reshape(-1, 3))
    corners = np.concatenate(found)
    corners = corners[np.argsort(corners[:, 0], kind="stable")]
    size = int(corners.max(initial=0)) + 1
    sides_of = corners[:, :1] * size + corners[:, 1:]
    _, which, count = np.unique(sides_of, return_inverse=True, return_counts=True)
    twice = (count[which] == 2).reshape(sides_of.shape).all(axis=1)
    open_ones = np.unique(corners[~twice, 0])
    return np.ascontiguousarray(corners[~np.isin(corners[:, 0], open_ones)])


def two_fans() -> Floats:
    """Two irregular fans of four triangles, apart from each other, `VertexAngles.example_faces`."""
    turn = 0.5 * np.pi * np.arange(8) + 0.2 * np.cos(3.0 * np.arange(8))
    rim = np.column_stack([np.cos(turn), 1.2 * np.sin(turn), 0.3 * np.cos(1.3 * turn + 0.5)])
    rim[4:, 0] += 4.0
    return np.vstack([[0.2, 0.1, 0.4], rim[:4], [4.1, -0.2, 0.5], rim[4:]])
