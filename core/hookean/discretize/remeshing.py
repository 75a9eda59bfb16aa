"""Triangles of one size: a mesh split, collapsed, flipped and smoothed until its edges have the same length."""

from __future__ import annotations

from typing import Any

import numpy as np

from hookean.discretize.cleaning import clean
from hookean.discretize.mapping import Closest
from hookean.discretize.measures import area
from hookean.discretize.meshes import as_mesh, triangles
from hookean.discretize.triangle_nets import (
    FIXED,
    FREE,
    ON_LINE,
    Array,
    Flags,
    Index,
    Net,
    Table,
    collapse,
    flip,
    split,
)
from hookean.errors import InputError
from hookean.values.mesh import Mesh

MOST_FACES = 5_000_000
_LONG, _SHORT = 4.0 / 3.0, 4.0 / 5.0  # of the length that is wanted: beyond, halves or pairs come nearer to it
_WELD = 1e-6  # of the length: vertices nearer than this are one


def remesh(mesh: Any, length: float, feature_angle: float = np.pi / 6, iterations: int = 15) -> Mesh:
    """The mesh as triangles whose edges are about `length` long (length units), its boundary and folds kept.

    Each of the `iterations` splits edges longer than 4/3 of the length, collapses those shorter than 4/5, flips edges
    towards six neighbours at each vertex (four at boundaries), moves vertices along the surface to the mean of their
    neighbours, and then to the closest point of the given mesh. Boundaries, and edges that fold by more than
    `feature_angle` [rad], are lines: vertices on them move along them alone, and those where a line ends, branches or
    turns by more than that angle stay. So straight boundaries keep their length and flat parts their area; curved ones
    are met at the vertices. Near corners and between near lines edges may be shorter. The same input gives the same
    mesh. Source: Botsch, Kobbelt, "A remeshing approach to multiresolution modeling", 2004. Raises InputError for a
    length or angle that is not positive, a mesh without faces, edges of more than two faces, and neighbours that run
    round in different directions.
    """
    expected_faces(mesh, length, feature_angle, iterations)
    whole = clean([mesh], _WELD * length)
    given = Mesh(whole.vertices, triangles(whole)[:, [0, 1, 2, 2]])
    net = net_of(given, float(feature_angle), float(feature_angle))
    remeshed(net, given, length, int(iterations))
    return Mesh(net.vertices, net.faces[:, [0, 1, 2, 2]])


def remeshed(net: Net, mesh: Mesh, length: float, iterations: int) -> None:
    """Iterations of `remesh` on a net whose vertices stay on a mesh, and those of its lines on these as they are."""
    surface = Closest(mesh.vertices, mesh.faces[:, :3])
    lines = Closest(mesh.vertices, net.lines[:, [0, 1, 1]]) if len(net.lines) else None
    for _ in range(iterations):
        split(net, _LONG * length)
        collapse(net, _SHORT * length, _LONG * length)
        flip(net)
        _smooth(net, surface, lines)


def expected_faces(mesh: Any, length: float, feature_angle: float = np.pi / 6, iterations: int = 15) -> int:
    """About how many faces `remesh` makes at most, area / (sqrt(3) / 4 length^2), or more where it has to split slender
    faces; raises what it raises for its options."""
    if not (np.isfinite(length) and length > 0.0):
        raise InputError("length", f"it is {length!r}; give a positive length")
    if not 0.0 < feature_angle <= np.pi:
        raise InputError("feature_angle", f"it is {feature_angle!r}; give an angle from 0 to pi in radians")
    if isinstance(iterations, bool) or int(iterations) != iterations or not 0 <= iterations <= 1000:
        raise InputError("iterations", f"{iterations!r} were asked for; give a whole number from 0 to 1000")
    m = as_mesh(mesh)
    if not len(m.faces):
        raise InputError("mesh", "it has no faces; give a mesh with faces")
    faces = max(area(m) / (0.25 * np.sqrt(3.0)) / length / length, _halves(m, _LONG * length))
    if not np.isfinite(faces):
        raise InputError("length", "it is too small, or the mesh too large, for float64 arithmetic; use other units")
    if faces > MOST_FACES:
        raise InputError("length", f"it makes about {faces:.2g} faces; at most {MOST_FACES} are possible")
    return int(faces) + 1


def _halves(mesh: Mesh, longest: float) -> float:
    """About how many faces splitting makes, whatever their area: the pieces of the longest side times those of the
    shortest, of each triangle that is split."""
    p = mesh.vertices[triangles(mesh)]
    sides = np.sort(np.linalg.norm(p - np.roll(p, 1, axis=1), axis=2) / longest, axis=1)
    return float((sides[:, 2] * np.maximum(sides[:, 0], 1.0))[sides[:, 2] > 1.0].sum())


def net_of(mesh: Mesh, fold_angle: float, turn_angle: float, seams: Flags | None = None) -> Net:
    """The mesh with its lines, and the vertices that stay: boundaries, edges that fold by more than an angle [rad] and
    `seams`, by edges of its `Table`; vertices where a line ends, branches or turns by more than an angle [rad]."""
    t, v = mesh.faces[:, :3], mesh.vertices
    table = Table(t, len(v))
    if table.most > 2:
        raise InputError("mesh", f"an edge of it has {table.most} faces; an edge may have two at most")
    inner = table.right >= 0
    if (t.ravel()[table.left[inner]] == t.ravel()[table.right[inner]]).any():
        raise InputError("mesh", "faces beside each other run round in different directions; unify their normals first")
    normals = np.cross(v[t[:, 1]] - v[t[:, 0]], v[t[:, 2]] - v[t[:, 0]])
    one, two = normals[table.left // 3], normals[table.right // 3]
    fold = np.arctan2(np.linalg.norm(np.cross(one, two), axis=1), (one * two).sum(axis=1))
    chosen = ~inner | (fold > fold_angle)
    lines = table.edges[chosen if seams is None else chosen | seams]
    kinds, size = np.full(len(v), FREE), np.bincount(lines.ravel(), minlength=len(v))
    kinds[size > 0] = FIXED
    out = np.zeros((len(v), 2, 3))  # along the two lines at a vertex
    place = np.zeros(len(v), np.int64)
    for k in range(2):  # the ends of all lines, in turn
        for a, b in np.stack([lines[:, k], lines[:, 1 - k]], axis=1).tolist():
            if size[a] == 2:
                out[a, place[a]] = v[b] - v[a]
                place[a] += 1
    turn = np.arctan2(np.linalg.norm(np.cross(out[:, 0], -out[:, 1]), axis=1), -(out[:, 0] * out[:, 1]).sum(axis=1))
    kinds[(size == 2) & (turn <= turn_angle)] = ON_LINE
    return Net(v.copy(), t.copy(), kinds, _valences(v, t, table, kinds), lines)


def _valences(v: Array, t: Index, table: Table, kinds: Index) -> Index:
    """How many neighbours each vertex is to have: 6, 4 at a boundary, at its corners by their angle."""
    wanted = np.full(len(v), 6)
    rim = np.unique(table.edges[table.right < 0])
    wanted[rim] = 4
    inside = np.zeros(len(v))
    for k in range(3):
        u, w = v[t[:, (k + 1) % 3]] - v[t[:, k]], v[t[:, (k + 2) % 3]] - v[t[:, k]]
        np.add.at(inside, t[:, k], np.arctan2(np.linalg.norm(np.cross(u, w), axis=1), (u * w).sum(axis=1)))
    corners = rim[kinds[rim] == FIXED]
    wanted[corners] = np.maximum(np.rint(inside[corners] / (np.pi / 3)), 1).astype(np.int64) + 1
    return wanted


def _smooth(net: Net, surface: Closest, lines: Closest | None) -> None:
    """Free vertices along the surface, those of lines along them; none that would turn a triangle over."""
    v, t = net.vertices, net.faces
    edges = Table(t, len(v)).edges
    old = np.cross(v[t[:, 1]] - v[t[:, 0]], v[t[:, 2]] - v[t[:, 0]])
    normals = np.zeros_like(v)
    for k in range(3):
        np.add.at(normals, t[:, k], old)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    sizes = np.linalg.norm(old, axis=1)
    # the mean area of the triangles at a vertex: boundaries attract as much as what is inside
    shares = np.bincount(t.ravel(), np.repeat(sizes, 3), len(v)) / np.maximum(
        np.bincount(t.ravel(), minlength=len(v)), 1
    )
    to = _mean(edges, v, shares) - v
    goal = v + to - (to * normals).sum(axis=1, keepdims=True) * normals
    free, on = np.flatnonzero(net.kinds == FREE), np.flatnonzero(net.kinds == ON_LINE)
    moved = v.copy()
    moved[free] = surface(goal[free])[1]
    if lines is not None and len(on):
        moved[on] = lines(_mean(net.lines, v, np.ones(len(v)))[on])[1]
    while True:
        new = np.cross(moved[t[:, 1]] - moved[t[:, 0]], moved[t[:, 2]] - moved[t[:, 0]])
        turned = (new * old).sum(axis=1) <= 0.1 * np.linalg.norm(new, axis=1) * np.linalg.norm(old, axis=1)
        back = np.unique(t[turned])
        back = back[(moved[back] != v[back]).any(axis=1)]
        if not len(back):
            break
        moved[back] = v[back]
    net.vertices = moved


def _mean(edges: Index, v: Array, weights: Array) -> Array:
    """The weighted mean of the neighbours of each vertex; those without any stay."""
    sums, total = np.zeros_like(v), np.zeros(len(v))
    for a, b in ((0, 1), (1, 0)):
        np.add.at(sums, edges[:, a], weights[edges[:, b], None] * v[edges[:, b]])
        np.add.at(total, edges[:, a], weights[edges[:, b]])
    out: Array = np.where(total[:, None] > 0.0, sums / np.maximum(total, 1e-300)[:, None], v)
    return out
