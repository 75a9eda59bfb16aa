"""The climb of `_complementary` to the highest point of D, compiled: force densities `q`, the positions `x` in balance
with the loads at them, and `gap`, the misfit of the lengths, step by step.

A net is the tuple of its ends (m, 2; the lower particle first, the free ones before all others), k and rest (m,) of
its springs, ground (free,) and pull (free, 3) of its free particles, and the first column of each row of its matrices.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from hookean.kernels import device
from hookean.solvers._profile import factor, solve

BEGIN = 60  # factors of 4 between tensions that all springs could share
HALVES = 10  # of a step
POLISH = 4


def climb(x, ends, k, rest, ground, pull, first, tension, near, goal, most):  # type: ignore[no-untyped-def]
    """Newton steps from the best tension that all springs share, at most so many, until one is shorter than `near` and
    the springs' own law leaves no more than `goal` on any particle; how many, 0 where they do not lead there."""
    net = (ends, k, rest, ground, pull, first)
    free, count = first.shape[0], ends.shape[0]
    starts, starts3 = np.zeros(free + 1, np.int64), np.zeros(3 * free + 1, np.int64)
    first3 = np.empty(3 * free, np.int64)
    for i in range(free):
        starts[i + 1] = starts[i] + i + 1 - first[i]
        for c in range(3):
            first3[3 * i + c] = 3 * first[i]
            starts3[3 * i + c + 1] = starts3[3 * i + c] + 3 * (i - first[i]) + c + 1
    matrix, matrix3 = np.empty(starts[free]), np.empty(starts3[3 * free])
    left, step, before = np.empty((3, free)), np.empty(3 * free), np.empty((free, 3))
    q, dq, now, gap = np.empty(count), np.empty(count), np.empty(count), np.empty(count)
    if not begin(tension, x, q, net, starts, matrix, left, gap):
        return 0
    for done in range(1, most + 1):
        before[:] = x[:free]
        slope = direction(x, q, net, gap, first3, starts3, matrix3, step, dq)
        if np.isnan(slope) or not onward(slope, x, q, dq, net, starts, matrix, left, gap, now):
            return 0
        moved = 0.0
        for i in range(free):
            for c in range(3):
                moved = max(moved, abs(x[i, c] - before[i, c]))
        if moved <= near and polish(goal, x, net, first3, starts3, matrix3, left, step, before):
            return done
    return 0


@device
def begin(tension: Any, x: Any, q: Any, net: Any, starts: Any, matrix: Any, left: Any, gap: Any) -> Any:
    """From the best tension that all springs could share, within a factor of 2; False where there is none."""
    slope = share(tension, x, q, net, starts, matrix, left, gap)
    rising = slope > 0.0
    apart = 4.0 if rising else 0.25
    for _ in range(BEGIN):
        if np.isnan(slope) or (slope > 0.0) != rising:
            break
        tension *= apart
        slope = share(tension, x, q, net, starts, matrix, left, gap)
    return not np.isnan(share(tension / np.sqrt(apart), x, q, net, starts, matrix, left, gap))


@device
def share(tension: Any, x: Any, q: Any, net: Any, starts: Any, matrix: Any, left: Any, gap: Any) -> Any:
    """Give all springs one tension; how D changes with its logarithm, nan where it holds nothing."""
    ends, k, rest = net[:3]
    for e in range(ends.shape[0]):
        q[e] = tension / (rest[e] + tension / k[e]) if rest[e] > 0.0 else k[e]
    if not settle(x, q, net, starts, matrix, left, gap):
        return np.nan
    slope = 0.0
    for e in range(ends.shape[0]):
        slope += gap[e] * q[e] * (1.0 - q[e] / k[e])
    return slope


@device
def settle(x: Any, q: Any, net: Any, starts: Any, matrix: Any, left: Any, gap: Any) -> Any:
    """Move the free particles to where force densities q balance the loads; False where nothing holds them.

    `gap` becomes half the squared length of each spring, less that of the length its force density asks for.
    """
    ends, k, rest, ground, pull, first = net
    free = ground.shape[0]
    matrix[:] = 0.0
    for i in range(free):
        matrix[starts[i + 1] - 1] = ground[i]
        for c in range(3):
            left[c, i] = pull[i, c] - ground[i] * x[i, c]
    for e in range(ends.shape[0]):
        low, high = ends[e, 0], ends[e, 1]
        for c in range(3):
            force = q[e] * (x[high, c] - x[low, c])
            left[c, low] += force
            if high < free:
                left[c, high] -= force
        matrix[starts[low + 1] - 1] += q[e]
        if high < free:
            matrix[starts[high + 1] - 1] += q[e]
            matrix[starts[high] + low - first[high]] -= q[e]
    if not factor(matrix, starts, first):
        return False
    for c in range(3):
        solve(matrix, starts, first, left[c])
        for i in range(free):
            x[i, c] += left[c, i]
    for e in range(ends.shape[0]):
        gap[e] = 0.0
        if rest[e] > 0.0:
            low, high = ends[e, 0], ends[e, 1]
            asked = rest[e] / (1.0 - q[e] / k[e])
            for c in range(3):
                gap[e] += 0.5 * (x[high, c] - x[low, c]) ** 2
            gap[e] -= 0.5 * asked * asked
    return True


@device
def direction(x: Any, q: Any, net: Any, gap: Any, first: Any, starts: Any, matrix: Any, step: Any, dq: Any) -> Any:
    """The Newton step of the force densities; how D changes along it, nan where the tangent is not definite."""
    ends, k, rest, ground = net[:4]
    free = ground.shape[0]
    matrix[:] = 0.0
    step[:] = 0.0
    for i in range(free):
        for c in range(3):
            matrix[starts[3 * i + c + 1] - 1] = ground[i]
    d = np.empty(3)
    for e in range(ends.shape[0]):
        low, high = ends[e, 0], ends[e, 1]
        stiff = stiffness(q[e], k[e], rest[e])
        for c in range(3):
            d[c] = x[high, c] - x[low, c]
        for c in range(3):
            near = starts[3 * low + c + 1] - 1 - c
            step[3 * low + c] += stiff * gap[e] * d[c]
            far, across = 0, 0
            if high < free:
                far = starts[3 * high + c + 1] - 1 - c
                across = far - 3 * (high - low)
                step[3 * high + c] -= stiff * gap[e] * d[c]
            for o in range(3):
                entry = stiff * d[c] * d[o] + (q[e] if c == o else 0.0)
                if o <= c:
                    matrix[near + o] += entry
                if high < free:
                    if o <= c:
                        matrix[far + o] += entry
                    matrix[across + o] -= entry
    if not factor(matrix, starts, first):
        return np.nan
    solve(matrix, starts, first, step)
    slope = 0.0
    for e in range(ends.shape[0]):
        low, high = ends[e, 0], ends[e, 1]
        stretch = gap[e]
        for c in range(3):
            other = step[3 * high + c] if high < free else 0.0
            stretch += (x[high, c] - x[low, c]) * (other - step[3 * low + c])
        dq[e] = stiffness(q[e], k[e], rest[e]) * stretch
        slope += gap[e] * dq[e]
    return slope


@device
def stiffness(q: Any, k: Any, rest: Any) -> Any:
    """Of a spring, k L0 / l^3 at the length l that its force density asks for."""
    if not rest > 0.0:
        return 0.0
    asked = rest / (1.0 - q / k)
    return k * rest / (asked * asked * asked)


@device
def onward(
    slope: Any, x: Any, q: Any, dq: Any, net: Any, starts: Any, matrix: Any, left: Any, gap: Any, now: Any
) -> Any:
    """One Newton step, shortened until D does not fall beyond it; False where there is none."""
    part = 1.0
    for tried in range(HALVES + 1):
        if tried > 1:
            part *= 0.5
        there = attempt(part, tried > 0, x, q, dq, net, starts, matrix, left, gap, now)
        if there >= -0.9 * slope:
            q[:] = now
            return True
    return False


@device
def attempt(
    part: Any, careful: Any, x: Any, q: Any, dq: Any, net: Any, starts: Any, matrix: Any, left: Any, gap: Any, now: Any
) -> Any:
    """Take force densities `now` a part of a step away; how D changes there along the step, nan where nothing holds.

    Where they grow it is the length asked for that grows evenly, so that none reaches k; with care none falls below a
    tenth of itself.
    """
    ends, k = net[:2]
    rate = dq.copy()
    for e in range(ends.shape[0]):
        now[e] = q[e] + part * dq[e]
        if dq[e] > 0.0:
            # the length asked for is L0 times this, and grows by dq / k times its square
            grown = 1.0 / (1.0 - q[e] / k[e])
            more = 1.0 + part * dq[e] / k[e] * grown
            now[e] = k[e] * (1.0 - 1.0 / (grown * more))
            rate[e] /= more * more
        elif careful and q[e] > 0.0 and now[e] < 0.1 * q[e]:
            now[e] = 0.1 * q[e]
            rate[e] = 0.0
    if not settle(x, now, net, starts, matrix, left, gap):
        return np.nan
    slope = 0.0
    for e in range(ends.shape[0]):
        slope += gap[e] * rate[e]
    return slope


@device
def polish(goal: Any, x: Any, net: Any, first: Any, starts: Any, tangent: Any, left: Any, step: Any, start: Any) -> Any:
    """Correct positions by what the springs' own law leaves; False, and back, unless that comes to the goal.

    Rounding of lengths makes force densities uncertain by k / T times as much, and with them x(q).
    """
    free = start.shape[0]
    start[:] = x[:free]
    worst = out_of_balance(x, net, left)
    for _ in range(POLISH):
        if worst <= goal:
            return True
        for i in range(free):
            for c in range(3):
                step[3 * i + c] = left[c, i]
        solve(tangent, starts, first, step)
        for i in range(free):
            for c in range(3):
                x[i, c] += step[3 * i + c]
        worst = out_of_balance(x, net, left)
    if worst <= goal:
        return True
    x[:free] = start
    return False


@device
def out_of_balance(x: Any, net: Any, left: Any) -> Any:
    """The largest force that the springs' own law leaves on a particle; infinite where a spring has no length."""
    ends, k, rest, ground, pull = net[:5]
    free = ground.shape[0]
    for i in range(free):
        for c in range(3):
            left[c, i] = pull[i, c] - ground[i] * x[i, c]
    for e in range(ends.shape[0]):
        low, high = ends[e, 0], ends[e, 1]
        length = np.sqrt((x[high, 0] - x[low, 0]) ** 2 + (x[high, 1] - x[low, 1]) ** 2 + (x[high, 2] - x[low, 2]) ** 2)
        if not length > 0.0 and rest[e] > 0.0:
            return np.inf  # no direction to push in: the highest energy, not the lowest
        density = k[e] * (length - rest[e]) / length if length > 0.0 else 0.0
        for c in range(3):
            force = density * (x[high, c] - x[low, c])
            left[c, low] += force
            if high < free:
                left[c, high] -= force
    worst = 0.0
    for i in range(free):
        square = left[0, i] ** 2 + left[1, i] ** 2 + left[2, i] ** 2
        if square > worst or np.isnan(square):
            worst = square
    return np.sqrt(worst)
