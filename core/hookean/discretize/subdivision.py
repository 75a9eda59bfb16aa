"""Meshes cut finer: refined in both directions or along strips, and turned so that each edge becomes a face."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.discretize.adjacency import sides_of_edges
from hookean.discretize.meshes import _edges, as_mesh, naked_edges, tidy_faces
from hookean.discretize.warpweft import warp_weft
from hookean.errors import InputError
from hookean.values.mesh import Mesh

Array = NDArray[np.float64]
Index = NDArray[np.int64]

MOST_FACES = 20_000_000


def refine(mesh: Any, level: int = 1, smooth: bool = False) -> Mesh:
    """The mesh with every quad and every triangle cut into four by the midpoints of its sides, `level` times.

    Old vertices keep their indices; midpoints follow in the order of `edges`, then the centres of the quads. Four
    faces take the place of one, and keep its direction round and of its sides. With `smooth` each level then averages
    vertices, which makes the surfaces of Catmull and Clark of quads and of Loop of triangles; boundaries become
    cubic B-splines, and vertices of one face at a boundary stay. Source of the averages: Warren, Schaefer, "A factored
    approach to subdivision surfaces", 2004. Raises InputError for a level that is not a whole number from 0 on, or
    too many faces.
    """
    m = as_mesh(mesh)
    for _ in range(_check_level(level, len(m.faces), 4)):
        m = _quarter(m)
        m = Mesh(_averaged(m), m.faces) if smooth else m
    return m


def refine_strips(mesh: Any, level: int = 1, direction: str = "along") -> Mesh:
    """The mesh with every face cut in two across one direction, `level` times.

    The edges of one family of `warp_weft` are halved, and each quad is cut between the midpoints of two opposite
    sides. `direction` names that family: "warp", "weft", or "along", in each connected part the one that runs along
    its strips: of whose edges a larger share is on the boundary; where both have the same share, the longer edges.
    Triangles are cut as the quads `(a, b, c, c)` that they are for `warp_weft`. Old vertices keep their indices.
    Raises InputError as `warp_weft` does, and for another direction or level.
    """
    if direction not in ("along", "warp", "weft"):
        raise InputError("direction", f'unknown direction {direction!r}; give "along", "warp" or "weft"')
    m = as_mesh(mesh)
    levels = _check_level(level, len(m.faces), 2)
    family = _family(m, direction) if levels else np.zeros((0, 2), np.int64)
    for _ in range(levels):
        m, family = _halve(m, family)
    return m


def diagonalize(mesh: Any) -> Mesh:
    """A face for each edge of the mesh, between the centres of the faces beside it.

    Edges of two faces give quads, those at the boundary triangles; they are in the order of `edges`. Vertices are the
    old ones, then the centres (means of the corners) of the faces. Area and outline of a flat mesh stay. Raises
    InputError where an edge has more than two faces.
    """
    m = as_mesh(mesh)
    left, right = sides_of_edges(m)
    corners = np.where(
        (m.faces[:, 2] == m.faces[:, 3])[:, None], np.c_[m.faces[:, :3], m.faces[:, :1] * 0 - 1], m.faces
    )
    real = corners >= 0
    centres = (m.vertices[m.faces] * real[..., None]).sum(axis=1) / real.sum(axis=1)[:, None]
    face, side = left.T
    start, end = m.faces[face, side], m.faces[face, (side + 1) % 4]
    here = len(m.vertices) + face
    beyond = np.where(right[:, 0] >= 0, len(m.vertices) + right[:, 0], -1)
    quads = np.stack([start, beyond, end, here], axis=1)
    ends = np.stack([start, end, here, here], axis=1)
    return Mesh(np.concatenate([m.vertices, centres]), np.where((beyond >= 0)[:, None], quads, ends))


def refined_faces(mesh: Any, level: int = 1, smooth: bool = False) -> int:
    """How many faces `refine` makes; raises InputError where it does for the level."""
    faces = len(as_mesh(mesh).faces)
    return faces << 2 * _check_level(level, faces, 4)


def strip_faces(mesh: Any, level: int = 1, direction: str = "along") -> int:
    """How many faces `refine_strips` makes, at most; raises InputError where it does for the level."""
    faces = len(as_mesh(mesh).faces)
    return faces << _check_level(level, faces, 2)


def _check_level(level: Any, faces: int, factor: int) -> int:
    whole = isinstance(level, (int, np.integer)) or (isinstance(level, float) and level.is_integer())
    if isinstance(level, bool) or not whole or level < 0:
        raise InputError("level", f"{level!r} levels were asked for; give a whole number of at least 0")
    if faces * float(factor) ** min(int(level), 64) > MOST_FACES:
        raise InputError("level", f"{int(level)} levels make more than {MOST_FACES} faces; give a lower one")
    return int(level)


def _quarter(m: Mesh) -> Mesh:
    sides, first, which = _edges(m)
    triangle = m.faces[:, 2] == m.faces[:, 3]
    middles = m.vertices[sides[first]].mean(axis=1)
    quads = np.flatnonzero(~triangle)
    centres = m.vertices[m.faces[quads]].mean(axis=1)
    a, b, c, d = m.faces.T
    ab, bc, cd, da = (len(m.vertices) + which.reshape(-1, 4)).T
    o = np.zeros(len(m.faces), np.int64)
    o[quads] = len(m.vertices) + len(middles) + np.arange(len(quads))
    four = np.array([[a, ab, o, da], [ab, b, bc, o], [o, bc, c, cd], [da, o, cd, d]])
    three = np.array([[a, ab, da, da], [ab, b, bc, bc], [da, bc, c, c], [ab, bc, da, da]])
    faces = np.where(triangle, three, four).transpose(2, 0, 1).reshape(-1, 4)
    return Mesh(np.concatenate([m.vertices, middles, centres]), faces)


def _averaged(m: Mesh) -> Array:
    """Vertices moved towards the weighted centroids of the faces round them, at the boundary of its edges."""
    triangle = m.faces[:, 2] == m.faces[:, 3]
    corners = m.vertices[m.faces]
    sums = np.zeros_like(m.vertices)
    quads, threes = np.zeros(len(m.vertices)), np.zeros(len(m.vertices))
    for k in range(4):
        at = m.faces[~triangle, k]
        np.add.at(sums, at, 3.0 * corners[~triangle].mean(axis=1))  # the angles of a square and of an equal triangle
        np.add.at(quads, at, 1.0)
    for k in range(3):
        at = m.faces[triangle, k]
        p = corners[triangle]
        np.add.at(sums, at, 2.0 * (0.25 * p[:, k] + 0.375 * (p[:, (k + 1) % 3] + p[:, (k + 2) % 3])))
        np.add.at(threes, at, 1.0)
    weights = 3.0 * quads + 2.0 * threes
    used = weights > 0.0
    turn = np.cos(2.0 * np.pi / np.maximum(threes, 1.0))
    loop = 5.0 / 3.0 - 8.0 / 3.0 * (0.375 + 0.25 * turn) ** 2
    share = np.where(quads > 0.0, 12.0 / np.where(used, weights, 1.0), loop)[:, None]
    out = m.vertices.copy()
    out[used] += share[used] * (sums[used] / weights[used, None] - m.vertices[used])
    rim = naked_edges(m)
    on, middle = np.unique(rim), m.vertices[rim].mean(axis=1)
    sums, count = np.zeros_like(m.vertices), np.zeros(len(m.vertices))
    for k in range(2):
        np.add.at(sums, rim[:, k], 0.5 * (m.vertices[rim[:, k]] + middle))
        np.add.at(count, rim[:, k], 1.0)
    out[on] = sums[on] / count[on, None]
    alone = on[(quads + threes)[on] == 1.0]
    out[alone] = m.vertices[alone]
    return out


def _halve(m: Mesh, family: Index) -> tuple[Mesh, Index]:
    """Faces cut across the edges of a family, and the halves of those edges."""
    sides, first, which = _edges(m)
    every, size = sides[first], len(m.vertices)
    chosen = np.isin(every @ [size, 1], family @ [size, 1])
    number = np.where(chosen, size + np.cumsum(chosen) - 1, -1)
    of = np.where(which >= 0, number[which], -1).reshape(-1, 4)
    faces, of = _turned(m.faces, of)
    a, b, c, d = faces.T
    ab, bc, cd, da = of.T
    cd = np.where(c == d, c, cd)  # the side c-c of a triangle has its middle at c
    lengthwise = np.array([[a, ab, cd, d], [ab, b, c, cd]])
    across = np.array([[b, bc, da, a], [bc, c, d, da]])
    cut = np.where(ab >= 0, lengthwise, across)
    cut[:, :, (ab < 0) & (bc < 0)] = faces[(ab < 0) & (bc < 0)].T
    keep = np.ones((len(faces), 2), bool)
    keep[(ab < 0) & (bc < 0), 1] = False
    ends = every[chosen]
    halves = np.stack([ends, np.repeat(number[chosen, None], 2, axis=1)], axis=2).reshape(-1, 2)
    vertices = np.concatenate([m.vertices, m.vertices[ends].mean(axis=1)])
    return Mesh(vertices, tidy_faces(cut.transpose(2, 0, 1)[keep])), halves


def _turned(faces: Index, of: Index) -> tuple[Index, Index]:
    """Triangles turned so that of their sides a-b alone is halved, or b-c and c-a are."""
    faces, of = faces.copy(), of.copy()
    triangle = np.flatnonzero(faces[:, 2] == faces[:, 3])
    halved = of[triangle][:, [0, 1, 3]] >= 0
    many = halved.sum(axis=1)
    if (many == 3).any():
        face = int(triangle[np.flatnonzero(many == 3)[0]])
        raise InputError(f"mesh/faces/{face}", "all sides of this triangle run in one direction; use quads there")
    lone = np.where(many == 1, halved.argmax(axis=1), np.where(many == 2, halved.argmin(axis=1), 0))
    order = (lone[:, None] + np.arange(3)) % 3
    faces[triangle] = np.take_along_axis(faces[triangle, :3], order, axis=1)[:, [0, 1, 2, 2]]
    three = np.take_along_axis(of[triangle][:, [0, 1, 3]], order, axis=1)
    of[triangle] = np.stack([three[:, 0], three[:, 1], np.full(len(three), -1), three[:, 2]], axis=1)
    return faces, of


def _family(m: Mesh, direction: str) -> Index:
    """The edges that are halved."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    sides, first, which = _edges(m)
    every, size = sides[first], len(m.vertices)
    warp = np.isin(every @ [size, 1], warp_weft(m)[0] @ [size, 1])
    if direction != "along":
        by_name: Index = every[warp == (direction == "warp")]
        return by_name
    face, side = np.nonzero(which.reshape(-1, 4) >= 0)
    links = (np.ones(len(face)), (face, len(m.faces) + which.reshape(-1, 4)[face, side]))
    count, part = connected_components(coo_array(links, shape=(len(m.faces) + len(every),) * 2), directed=False)
    part = part[len(m.faces) :]
    rim = np.isin(every @ [size, 1], naked_edges(m) @ [size, 1])
    long = np.linalg.norm(m.vertices[every[:, 1]] - m.vertices[every[:, 0]], axis=1)
    share, mean = np.zeros((2, count)), np.zeros((2, count))
    for i, family in enumerate((warp, ~warp)):
        total = np.maximum(np.bincount(part, family, count), 1.0)
        share[i] = np.bincount(part, family & rim, count) / total
        mean[i] = np.bincount(part, family * long, count) / total
    by_warp = (share[0] > share[1]) | ((share[0] == share[1]) & (mean[0] >= mean[1]))
    along: Index = every[warp == by_warp[part]]
    return along
