"""The closest point of a NURBS surface to a point: the table of a surface for kernels, and Newton's method on it."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np

from hookean.compiled.dispatch import rows
from hookean.compiled.marks import device
from hookean.discretize.nurbs import NurbsSurface
from hookean.forces.base import Floats
from hookean.forces.pull_to_mesh import WIDTH, closest

TREE, TABLE = 1, 3  # columns of the parameters, the first two of each: address and rows
# the head of a surface's table; of each direction: degree, points, closed or not, where its knots, breaks and cells are
DEGREE, COUNT, CLOSED, KNOTS, BREAKS, PIECES, CELLS, POINTS, ACROSS, HEAD = 0, 2, 4, 6, 8, 10, 12, 14, 15, 16
MOST = 100  # cells along a direction, from which a search starts
STEPS, HALVINGS = 60, 30
SMALL = 1e-15  # a step that is a smaller part of a piece is the last
SEAM = 1e-9  # part of a surface's size within which its ends are one
POLE = 1e-12  # part of the fastest speed below which a parameter does not move the point
R, U, V, UU, UV, VV = range(6)  # rows of a place: from the particle to the surface, and its derivatives
BASIS, PLACE, AT = 26, 12, 6  # columns of the rooms


@device
def slope(s: Any, knots: Any, low: Any, degree: Any, source: Any, target: Any) -> None:
    """Derivatives of the basis functions of a degree from those of one less (The NURBS Book, 2.7)."""
    for k in range(degree + 1):
        i, value = knots + low - degree + k, 0.0
        if k > 0 and s[i + degree, 0] > s[i, 0]:
            value += source[k - 1] / (s[i + degree, 0] - s[i, 0])
        if k < degree and s[i + degree + 1, 0] > s[i + 1, 0]:
            value -= source[k] / (s[i + degree + 1, 0] - s[i + 1, 0])
        target[k] = degree * value


@device
def basis(s: Any, way: Any, t: Any, piece: Any, b: Any) -> Any:
    """Basis functions of a direction and their first and second derivatives, rows 0 to 2 of `b`, at t within a piece;
    returns the first control point (The NURBS Book, A2.2)."""
    p, knots = int(s[DEGREE + way, 0]), int(s[KNOTS + way, 0])
    end = s[int(s[BREAKS + way, 0]) + piece + 1, 0]
    low, high = p, int(s[COUNT + way, 0])
    while high - low > 1:  # the last span that begins at t or before, and before the end of the piece
        middle = (low + high) // 2
        if s[knots + middle, 0] <= t and s[knots + middle, 0] < end:
            low = middle
        else:
            high = middle
    b[0, 0] = 1.0
    for degree in range(1, p + 1):
        for k in range(degree):
            if degree == p:
                b[3, k] = b[0, k]
            if degree == p - 1:
                b[4, k] = b[0, k]
        saved = 0.0
        for k in range(degree):
            right, left = s[knots + low + k + 1, 0] - t, t - s[knots + low + 1 - degree + k, 0]
            part = b[0, k] / (right + left)
            b[0, k] = saved + right * part
            saved = left * part
        b[0, degree] = saved
    slope(s, knots, low, p, b[3], b[1])
    if p > 1:
        slope(s, knots, low, p - 1, b[4], b[5])
        slope(s, knots, low, p, b[5], b[2])
    else:
        b[2, 0] = b[2, 1] = 0.0
    return low - p


@device
def place(s: Any, t: Any, piece: Any, x: Any, b: Any, g: Any) -> Any:
    """Write the vector from a point to the surface at the parameters t (2,) and the derivatives of it into rows of g;
    returns half of its square (The NURBS Book, 4.5)."""
    first = basis(s, 0, t[0], int(piece[0]), b[0:6])
    other = basis(s, 1, t[1], int(piece[1]), b[6:12])
    p, q, across, points = int(s[DEGREE, 0]), int(s[DEGREE + 1, 0]), int(s[COUNT + 1, 0]), int(s[POINTS, 0])
    for i in range(6):
        for c in range(4):
            g[6 + i, c] = 0.0
    for i in range(p + 1):
        for j in range(q + 1):
            at = points + 4 * ((first + i) * across + other + j)
            for c in range(4):
                n = s[at + c, 0]
                g[6 + R, c] += b[0, i] * b[6, j] * n
                g[6 + U, c] += b[1, i] * b[6, j] * n
                g[6 + V, c] += b[0, i] * b[7, j] * n
                g[6 + UU, c] += b[2, i] * b[6, j] * n
                g[6 + UV, c] += b[1, i] * b[7, j] * n
                g[6 + VV, c] += b[0, i] * b[8, j] * n
    w, wu, wv, square = g[6 + R, 3], g[6 + U, 3], g[6 + V, 3], 0.0
    for c in range(3):
        here = g[6 + R, c] / w
        g[R, c] = here - x[c]
        g[U, c] = (g[6 + U, c] - wu * here) / w
        g[V, c] = (g[6 + V, c] - wv * here) / w
        g[UU, c] = (g[6 + UU, c] - 2.0 * wu * g[U, c] - g[6 + UU, 3] * here) / w
        g[UV, c] = (g[6 + UV, c] - wu * g[V, c] - wv * g[U, c] - g[6 + UV, 3] * here) / w
        g[VV, c] = (g[6 + VV, c] - 2.0 * wv * g[V, c] - g[6 + VV, 3] * here) / w
        square += g[R, c] * g[R, c]
    return 0.5 * square


@device
def product(g: Any, i: Any, j: Any) -> Any:
    """Of two rows."""
    return g[i, 0] * g[j, 0] + g[i, 1] * g[j, 1] + g[i, 2] * g[j, 2]


@device
def outward(s: Any, way: Any, t: Any, piece: Any, g: Any) -> Any:
    """-1 or 1 where the end of the piece holds a search back that would leave it there; 0: it does not."""
    begin = int(s[BREAKS + way, 0]) + int(piece[way])
    rise = product(g, U + way, R)
    if t[way] <= s[begin, 0] and rise > 0.0:
        return -1
    return 1 if t[way] >= s[begin + 1, 0] and rise < 0.0 else 0


@device
def step_over(s: Any, way: Any, side: Any, t: Any, piece: Any) -> Any:
    """Go on to the same point of the next piece; whether there is one."""
    last, beyond = int(s[PIECES + way, 0]) - 1, int(piece[way]) + side
    if beyond < 0 or beyond > last:
        if s[CLOSED + way, 0] == 0.0:
            return False
        beyond = last if beyond < 0 else 0
    piece[way] = beyond
    t[way] = s[int(s[BREAKS + way, 0]) + beyond + (1 if side < 0 else 0), 0]
    return True


@device
def held_back(s: Any, t: Any, piece: Any, x: Any, b: Any, g: Any, held: Any) -> None:
    """Which parameters cannot move, as they are at an end of the surface or a crease: beyond, it is farther. Goes over
    to the piece beyond if it is not."""
    for way in range(2):
        side, held[way] = outward(s, way, t, piece, g), 0.0
        if side == 0:
            continue
        held[way] = 1.0
        before, was = t[way], piece[way]
        if step_over(s, way, side, t, piece):
            place(s, t, piece, x, b, g)
            rise = product(g, U + way, R)
            if rise * side < 0.0:
                held[way] = 0.0
            else:
                t[way], piece[way] = before, was
                place(s, t, piece, x, b, g)


@device
def curvature(g: Any, held: Any, h: Any) -> Any:
    """Write the inverse (2, 2) of the second derivatives by the parameters that are free, 0 for others; whether it is
    that of a minimum."""
    fast = max(product(g, U, U), product(g, V, V))
    a, c, d = product(g, U, U) + product(g, R, UU), product(g, U, V) + product(g, R, UV), product(g, V, V)
    d += product(g, R, VV)
    free_u = held[0] == 0.0 and product(g, U, U) > POLE * POLE * fast
    free_v = held[1] == 0.0 and product(g, V, V) > POLE * POLE * fast
    h[0, 0] = h[0, 1] = h[1, 0] = h[1, 1] = 0.0
    if free_u and free_v:
        determinant = a * d - c * c
        good = a > 0.0 and d > 0.0 and determinant > 1e-14 * a * d
        if good:
            h[0, 0], h[1, 1] = d / determinant, a / determinant
            h[0, 1] = h[1, 0] = -c / determinant
            return True
    good = True
    if free_u:
        good = a > 0.0 and not free_v
        h[0, 0] = 1.0 / (a if good else product(g, U, U))
    if free_v:
        good = d > 0.0 and not free_u
        h[1, 1] = 1.0 / (d if good else product(g, V, V))
    return good


@device
def nearest_place(parameters: Any, e: Any, x: Any, b: Any, g: Any, h: Any, room: Any, stack: Any) -> Any:
    """Find the closest point to x of the surface of an element: the vector to it and its derivatives in rows of g, and
    the inverse of second derivatives in h. Returns half of the square of the distance.

    Newton's method on the square of the distance, from the middle of the nearest cell of a sampled mesh.
    """
    s = rows(parameters[e, TABLE], parameters[e, TABLE + 1], 1)
    table = rows(parameters[e, TREE], parameters[e, TREE + 1], WIDTH)
    t, piece, held, then = room[AT], room[AT + 1], room[AT + 2], room[AT + 3]
    _, number = closest(table, x, room[4], room[5], room, stack, np.inf)
    across = int(s[ACROSS, 0])
    for way in range(2):
        cell = number // 2 // across if way == 0 else number // 2 % across
        t[way] = s[int(s[CELLS + way, 0]) + 2 * cell, 0]
        piece[way] = s[int(s[CELLS + way, 0]) + 2 * cell + 1, 0]
    energy = place(s, t, piece, x, b, g)
    for _ in range(STEPS):
        held_back(s, t, piece, x, b, g, held)
        curvature(g, held, h)
        part, largest, apart = 1.0, 0.0, np.sqrt(2.0 * energy)
        for way in range(2):
            then[way] = -(h[way, 0] * product(g, U, R) + h[way, 1] * product(g, V, R))
        moved = False
        before_u, before_v = t[0], t[1]
        for _ in range(HALVINGS):
            largest = 0.0
            for way in range(2):
                begin, before = int(s[BREAKS + way, 0]) + int(piece[way]), before_u if way == 0 else before_v
                low, high = s[begin, 0], s[begin + 1, 0]
                t[way] = min(max(before + part * then[way], low), high)
                largest = max(largest, np.abs(t[way] - before) / (high - low))
            tried = place(s, t, piece, x, b, g)
            # near the end the energies differ by the rounding of places only
            if tried <= energy + 1e-15 * apart * (apart + np.abs(x[0]) + np.abs(x[1]) + np.abs(x[2])):
                moved = True
                break
            part *= 0.5
        if not moved:
            t[0], t[1] = before_u, before_v
            place(s, t, piece, x, b, g)
            break
        energy = tried
        if largest <= SMALL:
            break
    return energy


def tables(surface: NurbsSurface) -> tuple[Floats, Floats]:
    """Triangles (m, 3, 3) of a mesh of a surface, two for each cell; and the table (k, 1) of the surface and cells."""
    degrees = surface.degree_u, surface.degree_v
    # from 0 to 1: of any others speeds along u and v may differ so much that one looks like a pole
    knots = tuple(_unit(own, degree) for own, degree in zip((surface.knots_u, surface.knots_v), degrees, strict=True))
    surface = replace(surface, knots_u=knots[0], knots_v=knots[1])
    size = float(np.ptp(surface.points.reshape(-1, 3), axis=0).max())
    breaks = [_breaks(own, degree) for own, degree in zip(knots, degrees, strict=True)]
    ends = [_ends(own, degree, edges) for own, degree, edges in zip(knots, degrees, breaks, strict=True)]
    grid = surface.points_at(*ends)
    cells = [np.column_stack([0.5 * (own[1:] + own[:-1]), 0.0 * own[1:]]) for own in ends]
    for own, edges in zip(cells, breaks, strict=True):
        own[:, 1] = np.searchsorted(edges, own[:, 0], side="right") - 1
    head = np.zeros(HEAD)
    head[DEGREE : DEGREE + 2], head[COUNT : COUNT + 2] = degrees, surface.points.shape[:2]
    seams = np.abs(grid[-1] - grid[0]).max(), np.abs(grid[:, -1] - grid[:, 0]).max()
    head[CLOSED : CLOSED + 2] = np.array(seams) <= SEAM * size
    head[PIECES : PIECES + 2] = [len(own) - 1 for own in breaks]
    weights = surface.weights[..., None]
    parts = [*knots, *breaks, *(own.ravel() for own in cells), np.dstack([surface.points * weights, weights]).ravel()]
    start = HEAD + np.cumsum([0, *(len(part) for part in parts)])
    head[KNOTS : KNOTS + 2], head[BREAKS : BREAKS + 2], head[CELLS : CELLS + 2] = start[:2], start[2:4], start[4:6]
    head[POINTS], head[ACROSS] = start[6], len(cells[1])
    a, b, c, d = grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]
    triangles = np.stack([np.stack([a, b, c], axis=2), np.stack([a, c, d], axis=2)], axis=2)
    return triangles.reshape(-1, 3, 3), np.concatenate([head, *parts])[:, None]


def _unit(knots: Floats, degree: int) -> Floats:
    """The same knots with a domain from 0 to 1."""
    low, high = knots[degree], knots[-degree - 1]
    return np.asarray((knots - low) / (high - low))


def _breaks(knots: Floats, degree: int) -> Floats:
    """The ends of the domain and the knots between at which the surface may have a crease."""
    inner = knots[degree : len(knots) - degree]
    value, count = np.unique(inner, return_counts=True)
    sharp = count >= degree
    sharp[[0, -1]] = True
    return np.asarray(value[sharp])


def _ends(knots: Floats, degree: int, breaks: Floats) -> Floats:
    """Ends of the cells: some in each span, breaks among them."""
    spans = np.unique(np.concatenate([knots[degree : len(knots) - degree], breaks]))
    each = max(1, min(4 * degree, MOST // (len(spans) - 1)))
    parts = [np.linspace(a, b, each + 1)[:-1] for a, b in pairwise(spans)]
    return np.concatenate([*parts, spans[-1:]])
