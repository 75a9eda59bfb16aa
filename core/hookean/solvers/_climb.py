"""The climb of `_complementary` to the highest point of D, compiled: force densities `q`, the positions `x` in balance
with the loads at them, and `gap`, the misfit of the lengths, step by step.

A net is the tuple of its ends (m, 2; the lower particle first, the free ones before all others), k and rest (m,) of
its springs, ground (free,) and pull (free, 3) of its free particles, the first column of each row of its matrix and
where the rows start. Between steps a person may interrupt.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from hookean.compiled.marks import device
from hookean.linear.profile_cholesky import factor, solve

BEGIN = 60  # factors of 4 between tensions that all springs could share
HALVES = 10  # of a step
POLISH = 4
ROUNDING = 1e-15  # of the largest coordinate
SAFE = 0.5  # of the goal: where rounding is as large as that, it is less at particles with small coordinates


def begin(x, q, gap, ends, k, rest, ground, pull, first, starts, tension):  # type: ignore[no-untyped-def]
    """From the best tension that all springs could share, within a factor of 2; False where there is none."""
    net = (ends, k, rest, ground, pull, first, starts)
    slope, rising, apart, last = 0.0, False, 1.0, False
    for tried in range(BEGIN + 2):
        slope = share(tension, x, q, gap, net)
        if last:
            break
        if tried == 0:
            rising = slope > 0.0
            apart = 4.0 if rising else 0.25
        last = tried == BEGIN or np.isnan(slope) or (slope > 0.0) != rising
        tension = tension / np.sqrt(apart) if last else tension * apart
    return not np.isnan(slope)


def onward(x, q, gap, ends, k, rest, ground, pull, first, starts, tangent):  # type: ignore[no-untyped-def]
    """One Newton step, shortened until D does not fall beyond it: the farthest that a particle goes along an axis,
    infinite where there is no such step. `tangent` becomes the factor of its matrix."""
    net = (ends, k, rest, ground, pull, first, starts)
    before, dq, now = np.empty((ground.shape[0], 3)), np.empty(k.shape[0]), np.empty(k.shape[0])
    put(x, before)
    slope = direction(x, q, gap, net, tangent, dq)
    if np.isnan(slope):
        return np.inf
    part, found = 1.0, False
    for tried in range(HALVES + 1):
        if tried > 1:
            part *= 0.5
        if attempt(part, tried > 0, x, q, dq, now, gap, net) >= -0.9 * slope:
            found = True
            break
    if not found:
        return np.inf
    for e in range(k.shape[0]):
        q[e] = now[e]
    moved = 0.0
    for i in range(before.shape[0]):
        for c in range(3):
            moved = max(moved, abs(x[i, c] - before[i, c]))
    return moved


@device
def share(tension: Any, x: Any, q: Any, gap: Any, net: Any) -> Any:
    """Give all springs one tension; how D changes with its logarithm, nan where it holds nothing."""
    ends, k, rest = net[:3]
    for e in range(ends.shape[0]):
        q[e] = tension / (rest[e] + tension / k[e]) if rest[e] > 0.0 else k[e]
    if not settle(x, q, gap, net):
        return np.nan
    slope = 0.0
    for e in range(ends.shape[0]):
        slope += gap[e] * q[e] * (1.0 - q[e] / k[e])
    return slope


@device
def settle(x: Any, q: Any, gap: Any, net: Any) -> Any:
    """Move the free particles to where force densities q balance the loads; False where nothing holds them.

    `gap` becomes half the squared length of each spring, less that of the length its force density asks for.
    """
    ends, k, rest, ground, pull, first, starts = net
    free = ground.shape[0]
    matrix, left = np.zeros(starts[free]), np.empty((3, free))
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
def direction(x: Any, q: Any, gap: Any, net: Any, matrix: Any, dq: Any) -> Any:
    """The Newton step of the force densities; how D changes along it, nan where the tangent is not definite."""
    ends, k, rest, ground = net[:4]
    free = ground.shape[0]
    first, starts = tripled(net[5])
    step = np.zeros(3 * free)
    for s in range(matrix.shape[0]):
        matrix[s] = 0.0
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
def attempt(part: Any, careful: Any, x: Any, q: Any, dq: Any, now: Any, gap: Any, net: Any) -> Any:
    """Take force densities `now` a part of a step away; how D changes there along the step, nan where nothing holds.

    Where they grow it is the length asked for that grows evenly, so that none reaches k; with care none falls below a
    tenth of itself.
    """
    ends, k = net[:2]
    rate = np.empty(k.shape[0])
    for e in range(ends.shape[0]):
        rate[e] = dq[e]
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
    if not settle(x, now, gap, net):
        return np.nan
    slope = 0.0
    for e in range(ends.shape[0]):
        slope += gap[e] * rate[e]
    return slope


def polish(x, ends, k, rest, ground, pull, first, starts, tangent, goal, fine, step):  # type: ignore[no-untyped-def]
    """Correct positions by what the springs' own law leaves; False, and back, unless that comes to the goal. `step`
    (free, 3) becomes the next correction, `fine` at most where rounding allows it; one that is rounding of the
    coordinates alone is the last, whatever it leaves.

    Rounding of lengths makes force densities uncertain by k / T times as much, and with them x(q).
    """
    net = (ends, k, rest, ground, pull, first, starts)
    free = ground.shape[0]
    left, next_step, before = np.empty((3, free)), np.empty(3 * free), np.empty((free, 3))
    put(x, before)
    first3, starts3 = tripled(first)
    reach = 0.0
    for i in range(x.shape[0]):
        for c in range(3):
            reach = max(reach, abs(x[i, c]))
    for tried in range(POLISH + 1):
        worst = out_of_balance(x, left, net)
        for i in range(free):
            for c in range(3):
                next_step[3 * i + c] = left[c, i]
        solve(tangent, starts3, first3, next_step)
        largest = 0.0
        for i in range(free):
            for c in range(3):
                step[i, c] = next_step[3 * i + c]
                largest = max(largest, abs(step[i, c]))
        enough = worst <= SAFE * goal and largest <= fine or worst <= goal and tried == POLISH
        if enough or (worst < np.inf and largest <= ROUNDING * reach):
            return True
        if tried < POLISH:
            for i in range(free):
                for c in range(3):
                    x[i, c] += step[i, c]
    put(before, x)
    return False


@device
def put(values: Any, target: Any) -> None:
    """Copy the rows (n, 3) that both have; a slice takes a second to compile."""
    for i in range(min(values.shape[0], target.shape[0])):
        for c in range(3):
            target[i, c] = values[i, c]


@device
def tripled(first: Any) -> Any:
    """Of the matrix with a row for each axis of each particle, the first columns of the rows and where they start."""
    firsts, starts = np.empty(3 * first.shape[0], np.int64), np.zeros(3 * first.shape[0] + 1, np.int64)
    for i in range(first.shape[0]):
        for c in range(3):
            firsts[3 * i + c] = 3 * first[i]
            starts[3 * i + c + 1] = starts[3 * i + c] + 3 * (i - first[i]) + c + 1
    return firsts, starts


@device
def out_of_balance(x: Any, left: Any, net: Any) -> Any:
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
