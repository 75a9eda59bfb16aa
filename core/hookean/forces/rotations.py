"""Rotations: how the orientation of a particle lies in the rows of a state, and how it is moved.

A particle with an orientation has two more rows: its slot holds l theta, a rotation vector theta [rad] times a length l
that its system fixes, and its reference l rho. Its orientation is R = exp(theta) exp(rho), turned from the start. What
a force adds to a slot is -dE/d(l theta) = T(theta)^T M / l, M the moment and T the tangent map of the rotation group:
omega = T dtheta/dt. So a slot has forces, stiffness and mass in the units of particles, and solvers move it like one.
`fold` moves theta into the reference: M / l and omega l are then plain moments and angular velocities, and a step is
the exponential map. Source: Ibrahimbegovic, Frey and Kozar, "Computational aspects of vector-like parametrization of
three-dimensional finite rotations", 1995.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.compiled.marks import device

Floats = NDArray[np.float64]


@device
def quaternion(x: Any, row: Any, length: Any, q: Any) -> None:
    """The unit quaternion w, x, y, z of the rotation vector in a row, real or complex."""
    a, b, c = 0.5 * x[row, 0] / length, 0.5 * x[row, 1] / length, 0.5 * x[row, 2] / length
    square = a * a + b * b + c * c
    if square.real < 1e-8:
        part, q[0] = 1.0 - square / 6.0, 1.0 - 0.5 * square
    else:
        half = np.sqrt(square)
        part, q[0] = np.sin(half) / half, np.cos(half)
    q[1], q[2], q[3] = part * a, part * b, part * c


@device
def orientation(x: Any, slot: Any, reference: Any, length: Any, q: Any, r: Any) -> None:
    """The quaternion exp(theta) exp(rho) of a particle in `q`; `r` is room for another."""
    quaternion(x, reference, length, r)
    if x[slot, 0] == 0.0 and x[slot, 1] == 0.0 and x[slot, 2] == 0.0:
        for i in range(4):
            q[i] = r[i]
        return
    quaternion(x, slot, length, q)
    w, a, b, c = q[0], q[1], q[2], q[3]
    q[0] = w * r[0] - a * r[1] - b * r[2] - c * r[3]
    q[1] = w * r[1] + a * r[0] + b * r[3] - c * r[2]
    q[2] = w * r[2] - a * r[3] + b * r[0] + c * r[1]
    q[3] = w * r[3] + a * r[2] - b * r[1] + c * r[0]


@device
def rotated(q: Any, a: Any, b: Any, c: Any) -> Any:
    """A vector turned by a unit quaternion."""
    tx, ty, tz = 2.0 * (q[2] * c - q[3] * b), 2.0 * (q[3] * a - q[1] * c), 2.0 * (q[1] * b - q[2] * a)
    return (
        a + q[0] * tx + q[2] * tz - q[3] * ty,
        b + q[0] * ty + q[3] * tx - q[1] * tz,
        c + q[0] * tz + q[1] * ty - q[2] * tx,
    )


@device
def tangent_parts(square: Any) -> Any:
    """The factors of theta x and of theta x (theta x in the tangent map, of the square of an angle."""
    if square.real < 0.1:
        one = 1.0 - square / 56.0 * (1.0 - square / 90.0 * (1.0 - square / 132.0))
        one = 0.5 * (1.0 - square / 12.0 * (1.0 - square / 30.0 * one))
        two = 1.0 - square / 72.0 * (1.0 - square / 110.0 * (1.0 - square / 156.0))
        return one, (1.0 - square / 20.0 * (1.0 - square / 42.0 * two)) / 6.0
    angle = np.sqrt(square)
    return (1.0 - np.cos(angle)) / square, (angle - np.sin(angle)) / (angle * square)


@device
def mapped(x: Any, row: Any, length: Any, sign: Any, a: Any, b: Any, c: Any) -> Any:
    """T(theta) times a vector, theta in a row; with `sign` -1 its transpose: the moment that a slot feels."""
    p, q, r = x[row, 0] / length, x[row, 1] / length, x[row, 2] / length
    if p == 0.0 and q == 0.0 and r == 0.0:
        return a, b, c
    one, two = tangent_parts(p * p + q * q + r * r)
    u, v, w = q * c - r * b, r * a - p * c, p * b - q * a
    return (
        a + sign * one * u + two * (q * w - r * v),
        b + sign * one * v + two * (r * u - p * w),
        c + sign * one * w + two * (p * v - q * u),
    )


@device
def fold(x: Any, v: Any, first: Any, lengths: Any) -> None:
    """Move what slots hold into their references; velocities become angular ones times l.

    Slots are the rows from `first` on, as many as `lengths`, and references those behind them. Nothing changes where
    nothing has turned.
    """
    count = lengths.size
    for k in range(count):
        i, j, length = first + k, first + count + k, lengths[k]
        if x[i, 0] == 0.0 and x[i, 1] == 0.0 and x[i, 2] == 0.0:
            continue
        if not np.isfinite(x[i, 0] + x[i, 1] + x[i, 2]):
            continue
        v[i, 0], v[i, 1], v[i, 2] = mapped(x, i, length, 1.0, v[i, 0], v[i, 1], v[i, 2])
        compose(x, i, j, length)


@device
def compose(x: Any, i: Any, j: Any, length: Any) -> None:
    """exp(theta) exp(rho) as the new reference, an angle of at most pi; the slot is then 0."""
    a, b, c = 0.5 * x[i, 0] / length, 0.5 * x[i, 1] / length, 0.5 * x[i, 2] / length
    p, q, r = 0.5 * x[j, 0] / length, 0.5 * x[j, 1] / length, 0.5 * x[j, 2] / length
    one, two = np.sqrt(a * a + b * b + c * c), np.sqrt(p * p + q * q + r * r)
    f = np.sin(one) / one
    g = np.sin(two) / two if two > 1e-160 else 1.0
    w, s = np.cos(one), np.cos(two)
    a, b, c, p, q, r = f * a, f * b, f * c, g * p, g * q, g * r
    d0 = w * s - a * p - b * q - c * r
    d1 = w * p + a * s + b * r - c * q
    d2 = w * q - a * r + b * s + c * p
    d3 = w * r + a * q - b * p + c * s
    if d0 < 0.0:
        d0, d1, d2, d3 = -d0, -d1, -d2, -d3
    size = np.sqrt(d1 * d1 + d2 * d2 + d3 * d3)
    part = 2.0 * length * (np.arctan2(size, d0) / size if size > 1e-160 else 1.0)
    x[j, 0], x[j, 1], x[j, 2] = part * d1, part * d2, part * d3
    x[i, 0], x[i, 1], x[i, 2] = 0.0, 0.0, 0.0


def quaternions(vectors: Floats) -> Floats:
    """Unit quaternions w, x, y, z (r, 4) of rotation vectors (r, 3) [rad], w not negative for angles up to pi."""
    angle = np.sqrt((vectors**2).sum(axis=1))
    part = 0.5 * np.sinc(0.5 * angle / np.pi)
    return np.column_stack([np.cos(0.5 * angle), part[:, None] * vectors])
