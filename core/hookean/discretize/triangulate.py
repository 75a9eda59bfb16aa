"""Plane polygons with holes to triangles on their own vertices, by cutting ears."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hookean.errors import InputError

Array = NDArray[np.float64]
Index = NDArray[np.int64]


def plane_coordinates(points: Array, normal: Array) -> Array:
    """Coordinates `(n, 2)` of `points` in the plane across `normal`, right-handed about it."""
    n = normal / np.linalg.norm(normal)
    x = np.cross(n, np.eye(3)[np.abs(n).argmin()])
    x /= np.linalg.norm(x)
    return np.stack([points @ x, points @ np.cross(n, x)], axis=1)


def newell(points: Array) -> Array:
    """Vector area of a closed polygon `(n, 3)`: half the sum of the cross products of its sides."""
    p = points - points[0]
    area: Array = 0.5 * np.cross(p, np.roll(p, -1, axis=0)).sum(axis=0)
    return area


def triangulate(xy: Array, loops: list[Index]) -> Index:
    """Triangles `(t, 3)`, counter-clockwise, of the polygon `loops[0]` less the holes `loops[1:]`.

    `xy` `(n, 2)` holds all vertices, the loops index it, in either direction; n + 2 h - 2 triangles
    come of n vertices and h holes. Raises InputError where the loops cross themselves or each other.
    """
    outer = _turned(xy, loops[0], left=True)
    holes = sorted((_turned(xy, h, left=False) for h in loops[1:]), key=lambda h: -float(xy[h, 0].max()))
    for hole in holes:
        outer = _bridged(xy, outer, hole)
    return _ears(xy, outer)


def _turned(xy: Array, loop: Index, left: bool) -> Index:
    p = xy[loop] - xy[loop[0]]
    area = float((p[:, 0] * np.roll(p[:, 1], -1) - p[:, 1] * np.roll(p[:, 0], -1)).sum())
    return loop if (area > 0) == left else loop[::-1]


def _cross(o: Array, a: Array, b: Array) -> Array:
    out: Array = (a[..., 0] - o[..., 0]) * (b[..., 1] - o[..., 1]) - (a[..., 1] - o[..., 1]) * (b[..., 0] - o[..., 0])
    return out


def _bridged(xy: Array, outer: Index, hole: Index) -> Index:
    """One loop of both: a slit from the hole's rightmost vertex to the nearest outer vertex in sight."""
    hole = np.roll(hole, -int(xy[hole, 0].argmax()))
    m = xy[hole[0]]
    walls = [(loop, np.roll(loop, -1)) for loop in (outer, hole)]
    a, b = (np.concatenate(side) for side in zip(*walls, strict=True))
    for k in np.argsort(np.linalg.norm(xy[outer] - m, axis=1), kind="stable"):
        p, before, after = xy[outer[k]], xy[outer[k - 1]], xy[outer[(k + 1) % len(outer)]]
        apart = (a != outer[k]) & (b != outer[k]) & (a != hole[0]) & (b != hole[0])
        c, d = xy[a[apart]], xy[b[apart]]
        hit = (_cross(m, p, c) * _cross(m, p, d) <= 0) & (_cross(c, d, m) * _cross(c, d, p) <= 0)
        inside_before, inside_after = _cross(before, p, m) > 0, _cross(p, after, m) > 0
        convex = _cross(before, p, after) > 0
        inside = (inside_before and inside_after) if convex else (inside_before or inside_after)
        if inside and not hit.any():
            return np.concatenate([outer[: k + 1], hole, hole[:1], outer[k:]])
    raise InputError("face", "a hole of it crosses its outline; repair the profile")


def _ears(xy: Array, loop: Index) -> Index:
    rest, out, start = loop.tolist(), [], 0
    tiny = 1e-12 * float(np.ptp(xy[loop], axis=0).max()) ** 2  # points in a row are no ear
    while len(rest) > 3:
        found = _next_ear(xy, rest, start, tiny)
        k = found if found >= 0 else _next_ear(xy, rest, start, 0.0)
        if k < 0:
            raise InputError("face", "its outline crosses itself; repair it")
        out.append((rest[k - 1], rest[k], rest[(k + 1) % len(rest)]))
        del rest[k]
        start = k  # go on round the loop, which gives better triangles than a fan
    if _cross(xy[rest[0]], xy[rest[1]], xy[rest[2]]) < -tiny:
        raise InputError("face", "its outline crosses itself; repair it")
    out.append((rest[0], rest[1], rest[2]))
    return np.array(out, dtype=np.int64)


def _next_ear(xy: Array, rest: list[int], start: int, tiny: float) -> int:
    n = len(rest)
    every = np.array(rest)
    for step in range(n):
        k = (start + step) % n
        if _is_ear(xy, rest[k - 1], rest[k], rest[(k + 1) % n], every, tiny):
            return k
    return -1


def _is_ear(xy: Array, i: int, j: int, l: int, rest: Index, tiny: float) -> bool:
    a, b, c = xy[i], xy[j], xy[l]
    if _cross(a, b, c) <= tiny:
        return False
    others = xy[rest[(rest != i) & (rest != j) & (rest != l)]]
    inside = np.minimum(np.minimum(_cross(a, b, others), _cross(b, c, others)), _cross(c, a, others)) >= -tiny
    # a bridge passes twice through one place: its other vertex there is no obstacle
    inside &= ~((others == a).all(axis=1) | (others == c).all(axis=1))
    return not inside.any()
