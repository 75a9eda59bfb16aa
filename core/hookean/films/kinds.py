"""Kinds: where the particles of films lie, by the topology of their faces and by what else acts on them."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from hookean.system.system import System

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Flags = NDArray[np.bool_]

WHOLE, EDGE, WITHIN, SLIDING = 0, 1, 2, 3
"""What does not count at a particle: nothing, the tangent of an edge unless that turns a corner, the tangent plane, the
tangent of an edge that slides along a curve, whose neighbours do so, too."""


class Edges(NamedTuple):
    """Edges of faces: `pairs` (e, 2) of particles, the number (e,) of `faces` there, and whether (e,) it is `smooth`:
    inside one film. Of smooth ones `joined` (s, 4): the slots (4 x face + corner) of its ends in both faces, and
    whether (s,) the faces have opposite normals (`turned`)."""

    pairs: Ints
    faces: Ints
    smooth: Flags
    joined: Ints
    turned: Flags


def edges_of(mesh: Ints, tension: Floats) -> Edges:
    """Edges of faces (k, 4), each of one tension (k,)."""
    flat, size = mesh.ravel(), mesh.size
    slots = np.arange(size).reshape(-1, 4)
    onward = np.roll(slots, -1, axis=1)
    # the last corner of a triangle is its third one again
    slots = np.where((mesh == np.roll(mesh, 1, axis=1)) & (np.arange(4) == 3), slots - 1, slots)
    keep = flat[slots] != flat[onward]
    slots, onward = slots[keep], onward[keep]
    low, high = np.minimum(flat[slots], flat[onward]), np.maximum(flat[slots], flat[onward])
    _, which, count = np.unique(low * (flat.max(initial=0) + 1) + high, return_inverse=True, return_counts=True)
    order = np.argsort(which, kind="stable")
    first = np.cumsum(count) - count
    one, other = order[first], order[np.minimum(first + 1, len(order) - 1)]
    smooth = (count == 2) & (tension[slots[one] // 4] == tension[slots[other] // 4])
    a, b = one[smooth], other[smooth]
    turned = flat[slots[a]] == flat[slots[b]]
    ends = np.where(turned[:, None], np.column_stack([slots[b], onward[b]]), np.column_stack([onward[b], slots[b]]))
    joined = np.column_stack([slots[a], onward[a], ends])
    return Edges(np.column_stack([low[one], high[one]]), count, smooth, joined, turned)


def fans_of(mesh: Ints, edges: Edges, n: int) -> tuple[Floats, Ints]:
    """Signs (4 k,) that turn the normal of each face to one side around each of its corners, and the number of fans of
    faces around each particle (n,)."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    size = mesh.size
    one, other = edges.joined[:, :2].ravel(), edges.joined[:, 2:].ravel()
    turned = np.repeat(edges.turned, 2)
    # every corner twice, as seen from either side
    rows = np.concatenate([one, one + size])
    columns = np.concatenate([other + size * turned, other + size * ~turned])
    links = coo_matrix((np.ones(len(rows), np.int8), (rows, columns)), shape=(2 * size, 2 * size))
    label = connected_components(links, directed=False)[1].reshape(2, size)
    used = np.ones(mesh.shape, bool)
    used[:, 3] = mesh[:, 2] != mesh[:, 3]
    fans = np.unique(mesh[used] * (2 * size) + label.min(axis=0).reshape(mesh.shape)[used]) // (2 * size)
    return np.where(label[0] <= label[1], 1.0, -1.0), np.bincount(fans, minlength=n)


def sheets_of(mesh: Ints, n: int) -> Ints:
    """Numbers (k,) of the connected films that faces belong to."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    rows, columns = np.repeat(mesh[:, 0], 3), mesh[:, 1:].ravel()
    links = coo_matrix((np.ones(len(rows), np.int8), (rows, columns)), shape=(n, n))
    label = connected_components(links, directed=False)[1]
    return np.unique(label[mesh[:, 0]], return_inverse=True)[1]


def kinds_of(system: System, mesh: Ints, edges: Edges, fans: Ints) -> tuple[Ints, Ints, Flags]:
    """Kind (n,), neighbours along an edge (n, 2), and where films act alone (n,)."""
    n = len(system.x)
    whole, film, loaded, lined, slides = (np.zeros(n, bool) for _ in range(5))
    film[mesh] = True
    bounds = ~edges.smooth
    for group in system.groups:
        for part in group.parts:
            index = group.block.indices[part.rows]
            if group.cls.on_film == "whole":
                whole[index] = True
            elif group.cls.on_film == "spread":
                loaded[index] = True
            elif group.cls.on_film == "curve":
                whole[index[lined[index]]] = True  # two curves hold it
                lined[index] = True
                along = _among(edges.pairs, index, n)
                slides |= np.bincount(edges.pairs[along].ravel(), minlength=n) == 2
                bounds |= along
    spread = np.zeros(n, bool)
    spread[mesh[loaded[mesh].all(axis=1)]] = True
    alone = loaded & ~spread  # single particles, or lines of them
    lined |= alone
    bounds |= alone[edges.pairs].all(axis=1)
    number = np.bincount(edges.pairs[bounds].ravel(), minlength=n)
    pairs = np.concatenate([edges.pairs[bounds], edges.pairs[bounds][:, ::-1]])
    pairs = pairs[np.argsort(pairs[:, 0], kind="stable")]
    pairs = pairs[number[pairs[:, 0]] == 2]
    kind, ends = np.full(n, WHOLE), np.zeros((n, 2), np.int64)
    ends[pairs[::2, 0]] = np.column_stack([pairs[::2, 1], pairs[1::2, 1]])
    kind[film & ~whole & (number == 2)] = EDGE
    kind[film & ~whole & (number == 2) & slides] = SLIDING
    kind[film & ~whole & (number == 0) & (fans == 1) & ~lined] = WITHIN
    return kind, ends, film & ~whole & ~lined


def _among(pairs: Ints, some: Ints, n: int) -> Flags:
    """Which pairs have both ends among some particles."""
    mark = np.zeros(n, bool)
    mark[some] = True
    return np.asarray(mark[pairs].all(axis=1))
