"""Couples between two straight lines that need not meet, by their angle alone, E = E(theta): shared by their kernels.

theta is the angle between the directions a and b of the lines, start to end, from 0 to pi. With their unit vectors u, v
and n = u x v / sin theta its gradient is -n x u / |a| at the end of a and n x v / |b| at the end of b, and the opposite
at the starts: couples of the moment dE/dtheta about n and -n, so that forces and moments sum to zero. The second
derivatives of a polar angle are -(u p + p u) / |a|^2 in the plane of both lines, p the direction of the gradient, and
n n (cot theta / |a|^2) across it, where a and b are joined by -n n / (|a| |b| sin theta).

Where E is m (theta - theta0)^2 / 2 and theta0 lies from 0 to pi, the part across the plane is at most 2 m / |a|^2, as
theta cot(theta / 2) <= 2: so the stiffness has a bound in every shape. Source: derived here; for the gradient see
Adriaenssens and Barnes, "Tensegrity spline beam and grid shell structures", 2001.
"""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from hookean.compiled.marks import device
from hookean.forces.base import Block, Floats, Force, Ints, lengths
from hookean.values.columns import IndexRows, NonNegatives, PointRows, fault
from hookean.values.fields import Field, Maybe

SHORTEST = 1e-70  # shorter lines have no direction, and no couple
PARALLEL = 1e-12  # sine below which two lines have no plane, and no couple
FLAT = 1e-6  # moment by stiffness below which parallel lines are at rest: else at a crest of the energy


@device
def unit(x: Any, a: Any, b: Any, u: Any) -> Any:
    """Write the unit vector from particle a to b; returns the distance."""
    dx = x[b, 0] - x[a, 0]
    dy = x[b, 1] - x[a, 1]
    dz = x[b, 2] - x[a, 2]
    length = np.sqrt(dx * dx + dy * dy + dz * dz)
    if length > SHORTEST:
        u[0] = dx / length
        u[1] = dy / length
        u[2] = dz / length
    return length


@device
def cross(u: Any, v: Any, n: Any) -> None:
    """Write u x v."""
    n[0] = u[1] * v[2] - u[2] * v[1]
    n[1] = u[2] * v[0] - u[0] * v[2]
    n[2] = u[0] * v[1] - u[1] * v[0]


@device
def between(x: Any, indices: Any, e: Any, g: Any) -> Any:
    """`spread` of an element's lines."""
    return spread(x, indices[e, 0], indices[e, 1], indices[e, 2], indices[e, 3], g)


@device
def spread(x: Any, p: Any, q: Any, r: Any, s: Any, g: Any) -> Any:
    """Sine and cosine of the angle between lines p-q and r-s and their lengths; sine nan where one is too short.

    `g` (5, 3): the unit vectors u, v, those across them in the plane of both, n x u and v x n, which point to each
    other, and n: zero for parallel lines.
    """
    a = unit(x, p, q, g[0])
    b = unit(x, r, s, g[1])
    if not (a > SHORTEST and b > SHORTEST):
        return np.nan, np.nan, a, b
    cross(g[0], g[1], g[4])
    sine = np.sqrt(g[4, 0] * g[4, 0] + g[4, 1] * g[4, 1] + g[4, 2] * g[4, 2])
    cosine = g[0, 0] * g[1, 0] + g[0, 1] * g[1, 1] + g[0, 2] * g[1, 2]
    for c in range(3):
        g[4, c] = g[4, c] / sine if sine > PARALLEL else 0.0
    cross(g[4], g[0], g[2])
    cross(g[1], g[4], g[3])
    return sine, cosine, a, b


@device
def turn(indices: Any, e: Any, stiffness: Any, moment: Any, a: Any, b: Any, g: Any, f: Any, w: Any) -> None:
    """Turn both lines by a moment, positive towards each other; `stiffness` is the moment per radian."""
    for i in range(2):
        own = a if i == 0 else b
        across = stiffness * (1.0 / a + 1.0 / b) / own + np.abs(moment) / (own * own)
        bound = 2.0 * max(across, 2.0 * stiffness / (own * own))
        start, end = indices[e, 2 * i], indices[e, 2 * i + 1]
        w[start] += bound
        w[end] += bound
        for c in range(3):
            push = moment / own * g[2 + i, c]
            f[end, c] += push
            f[start, c] -= push


@device
def frame(g: Any) -> None:
    """Some plane for parallel lines."""
    least = 0
    for c in range(1, 3):
        if np.abs(g[0, c]) < np.abs(g[0, least]):
            least = c
    for c in range(3):
        g[2, c] = (1.0 if c == least else 0.0) - g[0, least] * g[0, c]
    size = np.sqrt(g[2, 0] * g[2, 0] + g[2, 1] * g[2, 1] + g[2, 2] * g[2, 2])
    for c in range(3):
        g[2, c] /= size
    cross(g[0], g[2], g[4])
    cross(g[1], g[4], g[3])


@device
def fill(blocks: Any, e: Any, stiffness: Any, moment: Any, sine: Any, cosine: Any, a: Any, b: Any, g: Any) -> None:
    """Write the block of `Force.hessian`: `stiffness` is d2E/dtheta2, `moment` dE/dtheta."""
    slope = 0.0
    if sine > PARALLEL:
        slope = moment / sine
    else:
        frame(g)
        if np.abs(moment) <= FLAT * stiffness:
            slope = stiffness * cosine  # the limit of moment / sine
    for i in range(3):
        for j in range(3):
            across = slope * g[4, i] * g[4, j]
            aa = stiffness * g[2, i] * g[2, j] + moment * (g[0, i] * g[2, j] + g[2, i] * g[0, j]) + across * cosine
            bb = stiffness * g[3, i] * g[3, j] + moment * (g[1, i] * g[3, j] + g[3, i] * g[1, j]) + across * cosine
            ab = stiffness * g[2, i] * g[3, j] - across
            for p in range(2):
                for q in range(2):
                    sign = 1.0 if p == q else -1.0
                    blocks[e, 3 * p + i, 3 * q + j] = sign * aa / (a * a)
                    blocks[e, 6 + 3 * p + i, 6 + 3 * q + j] = sign * bb / (b * b)
                    blocks[e, 3 * p + i, 6 + 3 * q + j] = sign * ab / (a * b)
                    blocks[e, 6 + 3 * q + j, 3 * p + i] = sign * ab / (a * b)


@device
def nearest(angle: Any, multiple: Any) -> Any:
    """The multiple of an angle, up to pi, that is nearest to another angle."""
    step = np.maximum(multiple, 1e-16)  # finer than the numbers between angles: every one is a multiple
    return step * np.minimum(np.floor(angle / step + 0.5), np.floor(np.pi / step + 1e-9))


@device
def beyond(angle: Any, low: Any, high: Any, multiple: Any) -> Any:
    """How much larger an angle is than the one it turns to: a limit, or the nearest multiple."""
    return angle - (nearest(angle, multiple) if multiple > 0.0 else np.minimum(np.maximum(angle, low), high))


def angle_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy = 0.0
    g = np.zeros((5, 3))
    for e in range(indices.shape[0]):
        sine, cosine, a, b = between(x, indices, e, g)
        if np.isnan(sine):
            continue
        stiffness = parameters[e, 0]
        off = beyond(np.arctan2(sine, cosine), parameters[e, 1], parameters[e, 2], parameters[e, 3])
        energy += 0.5 * stiffness * off * off
        turn(indices, e, stiffness, stiffness * off, a, b, g, f, w)
    return energy


def angle_hessian(x, indices, parameters, memory, blocks):  # type: ignore[no-untyped-def]
    g = np.zeros((5, 3))
    for e in range(indices.shape[0]):
        sine, cosine, a, b = between(x, indices, e, g)
        if np.isnan(sine):
            continue
        low, high = parameters[e, 1], parameters[e, 2]
        off = beyond(np.arctan2(sine, cosine), low, high, parameters[e, 3])
        stiffness = parameters[e, 0] if off != 0.0 or low == high else 0.0
        fill(blocks, e, stiffness, parameters[e, 0] * off, sine, cosine, a, b, g)


class LinePair(Force):
    """Base of forces on pairs of lines."""

    kind: str = ""
    particles: Maybe[IndexRows] = Field(
        default=None, description="Start and end of line A, start and end of line B, for each pair"
    )
    points: Maybe[PointRows] = Field(
        default=None, description="Coordinates of the start and end of line A, the start and end of line B"
    )

    creates: ClassVar[bool] = False
    arity: ClassVar[int] = 4
    solid: ClassVar[bool] = False


class LineAngle(LinePair):
    """Base of forces that turn pairs of lines, each with a moment of its own."""

    strength: NonNegatives = Field(default=1.0, description="S, moment per angle [force length]")

    outputs: ClassVar[dict[str, str]] = {"angle": "angle", "moment": "moment"}
    kernel: ClassVar[Any] = staticmethod(angle_kernel)
    hessian: ClassVar[Any] = staticmethod(angle_hessian)

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """Angle [rad] and the moment that turns the lines towards each other [force length]."""
        angle = line_angles(x, block.indices)
        strength, low, high, multiple = block.parameters.T
        wanted, snaps = np.clip(angle, low, high), multiple > 0.0
        wanted[snaps] = nearest(angle[snaps], multiple[snaps])
        return {"angle": angle, "moment": strength * (angle - wanted)}


def angle_block(index: Ints, strength: Any, low: Any, high: Any, multiple: Any = 0.0) -> Block:
    """Arrays for `angle_kernel`: moment per angle, limits [rad] and, where not 0, the multiple [rad]."""
    return Block.of(index, strength=strength, lower_limit=low, upper_limit=high, multiple=multiple)


def within_half_a_turn(angle: float | Floats) -> float | Floats:
    """An angle that two lines can have [rad], from 0 to pi; else a fault of its field."""
    values = np.ravel(angle)
    wrong = values[(values < 0.0) | (values > np.pi + 1e-6)]  # that of single precision is allowed
    if len(wrong):
        raise fault(f"{wrong[0]:g} given; angles from 0 to pi allowed, in radians")
    return angle


def line_angles(x: Floats, rows: NDArray[np.int64]) -> Floats:
    """Angles [rad] of rows (m, 4) of particles: start and end of line A, start and end of line B; 0 where one has no
    length."""
    a, b = x[rows[:, 1]] - x[rows[:, 0]], x[rows[:, 3]] - x[rows[:, 2]]
    long = (lengths(a) > SHORTEST) & (lengths(b) > SHORTEST)
    u = a / np.where(long, lengths(a), 1.0)[:, None]
    v = b / np.where(long, lengths(b), 1.0)[:, None]
    found: Floats = np.where(long, np.arctan2(lengths(np.cross(u, v)), (u * v).sum(axis=1)), 0.0)
    return found
