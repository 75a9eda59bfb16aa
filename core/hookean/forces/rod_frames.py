"""Frames without twist along a rod, shared by what bends and what draws: vectors, corners, parallel transport.

A corner a-b-c turns from the direction s of a-b to the direction t of b-c, about n = s x t. Parallel transport is the
smallest rotation from s to t; it carries what is square to s without spinning it. Its spin changes with the shape:
where t moves by dt, what comes from s spins about t by -(n / (1 + s.t)) . dt beside what moves with t alone, and the
same of ds. Sources: Bishop, "There is more than one way to frame a curve", 1975; Bergou et al., "Discrete elastic
rods", 2008.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from hookean.compiled.marks import device
from hookean.forces.base import Floats, Ints, lengths

FOLD = 1e-9
"""1 + s.t below which a corner is folded back: what is carried across it has no direction to speak of."""


@device
def dot(a: Any, b: Any) -> Any:
    """a . b"""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@device
def cross(a: Any, b: Any) -> Any:
    """a x b"""
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


@device
def mix(p: Any, a: Any, q: Any, b: Any) -> Any:
    """p a + q b of numbers p, q and vectors a, b."""
    return (p * a[0] + q * b[0], p * a[1] + q * b[1], p * a[2] + q * b[2])


@device
def aside(a: Any, t: Any, size: Any) -> Any:
    """The part of a that is square to the unit vector t, divided by a size."""
    along = dot(a, t)
    return ((a[0] - along * t[0]) / size, (a[1] - along * t[1]) / size, (a[2] - along * t[2]) / size)


@device
def square_to(t: Any) -> Any:
    """A unit vector square to t, the same for the same t."""
    x, y, z = abs(t[0]), abs(t[1]), abs(t[2])
    if x <= y and x <= z:
        u = aside((1.0, 0.0, 0.0), t, 1.0)
    elif y <= z:
        u = aside((0.0, 1.0, 0.0), t, 1.0)
    else:
        u = aside((0.0, 0.0, 1.0), t, 1.0)
    return mix(1.0 / np.sqrt(dot(u, u)), u, 0.0, t)


@device
def carried(u: Any, s: Any, t: Any) -> Any:
    """A unit vector u, square to s, after parallel transport from s to t."""
    part = dot(u, t) / max(1.0 + dot(s, t), FOLD)
    u = aside((u[0] - part * (s[0] + t[0]), u[1] - part * (s[1] + t[1]), u[2] - part * (s[2] + t[2])), t, 1.0)
    size = dot(u, u)
    if not size > 0.25:
        return square_to(t)
    return mix(1.0 / np.sqrt(size), u, 0.0, t)


@device
def angle_from(u: Any, r: Any, t: Any) -> Any:
    """The angle [rad] about t from u to r, both square to t."""
    return np.arctan2(dot(r, cross(t, u)), dot(r, u))


@device
def corner(x: Any, a: Any, b: Any, c: Any) -> Any:
    """Directions s of a-b and t of b-c, their lengths, s x t, the sine, the cosine and the angle between them.

    Lengths are 0 where a segment has none beside the other, and then nothing else means anything.
    """
    u = (x[b, 0] - x[a, 0], x[b, 1] - x[a, 1], x[b, 2] - x[a, 2])
    v = (x[c, 0] - x[b, 0], x[c, 1] - x[b, 1], x[c, 2] - x[b, 2])
    uu, vv = dot(u, u), dot(v, v)
    if not (uu > 1e-16 * vv and vv > 1e-16 * uu and uu * vv > 1e-280):
        return u, v, 0.0, 0.0, u, 0.0, 1.0, 0.0
    before, after = np.sqrt(uu), np.sqrt(vv)
    s, t = mix(1.0 / before, u, 0.0, u), mix(1.0 / after, v, 0.0, v)
    n = cross(s, t)
    sine, cosine = np.sqrt(dot(n, n)), dot(s, t)
    return s, t, before, after, n, sine, cosine, np.arctan2(sine, cosine)


@device
def slopes(sine: Any, cosine: Any, angle: Any) -> Any:
    """h = angle / sine, and its derivative by the cosine: the turn of a corner as a vector is h s x t."""
    if angle < 0.1:
        q = angle * angle
        h = 1.0 + q * (1.0 / 6.0 + q * (7.0 / 360.0 + q * (31.0 / 15120.0 + q * 127.0 / 604800.0)))
        part = 1.0 / 3.0 - q * (1.0 / 30.0 - q * (1.0 / 840.0 - q * (1.0 / 45360.0)))
        return h, -part * h * h * h
    h = angle / sine
    return h, (h * cosine - 1.0) / (sine * sine)


def turn_angles(x: Floats, corners: Ints) -> Floats:
    """Angle [rad] by which b-c turns away from a-b, for rows a, b, c of `corners`."""
    u = x[corners[:, 1]] - x[corners[:, 0]]
    v = x[corners[:, 2]] - x[corners[:, 1]]
    angle: Floats = np.arctan2(np.linalg.norm(np.cross(u, v), axis=1), (u * v).sum(axis=1))
    return angle


def turn_vectors(x: Floats, corners: Ints) -> Floats:
    """The turn [rad] of a-b to b-c as a vector (m, 3) about its axis, for rows a, b, c of `corners`."""
    axis = np.cross(x[corners[:, 1]] - x[corners[:, 0]], x[corners[:, 2]] - x[corners[:, 1]])
    size = lengths(axis)
    return np.asarray(axis * (turn_angles(x, corners) / np.where(size > 0.0, size, 1.0))[:, None])
