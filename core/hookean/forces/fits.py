"""Least-squares planes, lines, spheres and circles of groups, as the kernels of forces find them.

A fit is a row of `WIDE` numbers: a point, a frame of three unit vectors of which the last is the normal of the plane or
circle, or the direction of the line, the radius, the size of the group (root mean square distance from its mean), and
which shape it is. Planes and lines come from the covariance of the group. Spheres and circles minimise the sum of
squared distances by damped Newton steps, from an algebraic fit. Where this has no minimum because the group is flat, or
on a line, they are planes and lines. Sources: Coope, "Circle fitting
by linear and nonlinear least squares", 1993; Golub and Van Loan, Matrix Computations, 2013, 8.5 (Jacobi's rotations).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from hookean.compiled.marks import device
from hookean.forces.groups import begins, following

STRENGTH, SHAPE = 2, 3  # columns of the parameters, after the links of the group
NOTHING, PLANE, LINE, SPHERE, CIRCLE = 0.0, 1.0, 2.0, 3.0, 4.0
POINT, U, NORMAL, RADIUS, SIZE, KIND, WIDE = 0, 3, 9, 12, 13, 14, 15
# of the rows of room to work in: another fit, a gradient, a step, a place, and the first of matrices
OTHER, GRADIENT, STEP, SLOPE, PLACE, HESSIAN, BEND, FACTOR, ROOM = 0, 1, 2, 3, 4, 5, 11, 17, 23
SWEEPS, STEPS = 12, 60
NEAR, SETTLED = 1e-4, 1e-9  # steps, by the size of the group: taken without a test; the last one
FARTHEST = 1e5  # times its size, the radius from which on a group is flat
FLAT = 1e-10  # part of the largest variance below which a group has no extent


@device
def rotate(a: Any, frame: Any, p: Any, q: Any) -> None:
    """One of Jacobi's rotations: a[p, q] becomes zero. Eigenvectors are the rows of the frame."""
    if a[p, q] == 0.0:
        return
    theta = 0.5 * (a[q, q] - a[p, p]) / a[p, q]
    t = 1.0 / (np.abs(theta) + np.sqrt(theta * theta + 1.0))
    if theta < 0.0:
        t = -t
    c = 1.0 / np.sqrt(t * t + 1.0)
    s = t * c
    a[p, p] -= t * a[p, q]
    a[q, q] += t * a[p, q]
    a[p, q] = a[q, p] = 0.0
    for r in range(a.shape[0]):
        if r != p and r != q:
            rp, rq = a[r, p], a[r, q]
            a[r, p] = a[p, r] = c * rp - s * rq
            a[r, q] = a[q, r] = s * rp + c * rq
        vp, vq = frame[p, r], frame[q, r]
        frame[p, r] = c * vp - s * vq
        frame[q, r] = s * vp + c * vq


@device
def principal(a: Any, frame: Any) -> None:
    """Eigenvalues of a symmetric matrix (3, 3) onto its diagonal, from large to small, and its eigenvectors as the
    rows of a frame."""
    for i in range(3):
        for j in range(3):
            frame[i, j] = 1.0 if i == j else 0.0
    for _ in range(SWEEPS):
        if a[0, 1] == 0.0 and a[0, 2] == 0.0 and a[1, 2] == 0.0:
            break
        rotate(a, frame, 0, 1)
        rotate(a, frame, 0, 2)
        rotate(a, frame, 1, 2)
    for i in range(2):
        for j in range(2 - i):
            if a[j, j] < a[j + 1, j + 1]:
                a[j, j], a[j + 1, j + 1] = a[j + 1, j + 1], a[j, j]
                for c in range(3):
                    frame[j, c], frame[j + 1, c] = frame[j + 1, c], frame[j, c]


@device
def moments(x: Any, indices: Any, parameters: Any, first: Any, fit: Any, a: Any) -> Any:
    """The total strength of a group, its mean and size into `fit`, its covariance into `a`."""
    total = 0.0
    start = indices[first, 0]
    for i in range(3):
        fit[i] = 0.0
        for j in range(3):
            a[i, j] = 0.0
    e = first
    while e >= 0:
        total += parameters[e, STRENGTH]
        for i in range(3):
            fit[i] += parameters[e, STRENGTH] * (x[indices[e, 0], i] - x[start, i])
        e = following(parameters, e)
    if total == 0.0:
        return 0.0
    for i in range(3):
        fit[i] = x[start, i] + fit[i] / total
    e = first
    while e >= 0:
        for i in range(3):
            y = x[indices[e, 0], i] - fit[i]
            for j in range(3):
                a[i, j] += parameters[e, STRENGTH] / total * y * (x[indices[e, 0], j] - fit[j])
        e = following(parameters, e)
    fit[SIZE] = np.sqrt(a[0, 0] + a[1, 1] + a[2, 2])
    return total


@device
def flat_fit(x: Any, indices: Any, parameters: Any, first: Any, shape: Any, fit: Any, a: Any) -> Any:
    """The plane or the line of a group; the total strength."""
    total = moments(x, indices, parameters, first, fit, a)
    fit[KIND] = shape if total > 0.0 else NOTHING
    fit[RADIUS] = 0.0
    frame = fit[U : U + 9].reshape(3, 3)
    principal(a, frame)
    if shape == LINE:  # its direction comes last
        for c in range(3):
            frame[0, c], frame[2, c] = frame[2, c], -frame[0, c]
    return total


@device
def start_round(x: Any, indices: Any, parameters: Any, first: Any, total: Any, fit: Any, a: Any, shape: Any) -> None:
    """Turn a plane into the sphere, or the circle in it, of Coope's algebraic fit: 2 C c = sum k |y|^2 y / sum k."""
    frame = fit[U : U + 9].reshape(3, 3)
    axes = 2 if shape == CIRCLE else 3
    square = 0.0
    for axis in range(axes):
        third = 0.0
        e = first
        while e >= 0:
            along, size = 0.0, 0.0
            for i in range(axes):
                part = 0.0
                for c in range(3):
                    part += (x[indices[e, 0], c] - fit[POINT + c]) * frame[i, c]
                size += part * part
                if i == axis:
                    along = part
            third += parameters[e, STRENGTH] / total * size * along
            e = following(parameters, e)
        place = 0.5 * third / a[axis, axis] if a[axis, axis] > FLAT * a[0, 0] else 0.0
        a[axis, 0 if axis else 1] = place  # off the diagonal there is room
        square += place * place + a[axis, axis]
    for c in range(3):
        fit[POINT + c] += a[0, 1] * frame[0, c] + a[1, 0] * frame[1, c] + (a[2, 0] * frame[2, c] if axes == 3 else 0.0)
    fit[RADIUS] = np.sqrt(square)
    fit[KIND] = shape


@device
def slopes(x: Any, indices: Any, parameters: Any, first: Any, fit: Any, room: Any) -> Any:
    """Sum of k |d|^2 / 2 of a sphere or circle; into `room` its gradient and Hessian by centre, radius and, of a
    circle, tilts: all in the frame of the fit.

    |d|^2 = |y|^2 - 2 r rho + r^2 with y from the centre, rho its distance from the centre or the axis.
    """
    energy, r = 0.0, fit[RADIUS]
    level = 1.0 if fit[KIND] == CIRCLE else 0.0
    frame, y, g, slope = fit[U : U + 9].reshape(3, 3), room[PLACE], room[GRADIENT], room[SLOPE]
    h, bend = room[HESSIAN : HESSIAN + 6], room[BEND : BEND + 6]
    g[:] = 0.0
    h[:] = 0.0
    e = first
    while e >= 0:
        k = parameters[e, STRENGTH]
        for i in range(3):
            y[i] = 0.0
            for c in range(3):
                y[i] += (x[indices[e, 0], c] - fit[POINT + c]) * frame[i, c]
        half_square(y, level, slope, bend)
        rho = np.sqrt(y[0] * y[0] + y[1] * y[1] + (1.0 - level) * y[2] * y[2])
        inverse = 1.0 / rho if rho > 1e-9 * r else 0.0
        energy += 0.5 * k * ((rho - r) * (rho - r) + level * y[2] * y[2])
        for i in range(6):
            g[i] += k * ((-y[i] if i < 3 else 0.0) - r * slope[i] * inverse)
            h[i, i] += k if i < 3 else 0.0
            h[i, 3] -= k * slope[i] * inverse
            h[3, i] -= k * slope[i] * inverse
            for j in range(6):
                h[i, j] -= k * r * inverse * (bend[i, j] - slope[i] * slope[j] * inverse * inverse)
        g[3] += k * (r - rho)
        h[3, 3] += k
        e = following(parameters, e)
    return energy


@device
def half_square(y: Any, level: Any, slope: Any, bend: Any) -> None:
    """Gradient (6,) and Hessian (6, 6) of rho^2 / 2 by centre, nothing, and two tilts of the axis."""
    a, b, h = y[0], y[1], y[2]
    slope[:] = 0.0
    bend[:] = 0.0
    slope[0], slope[1], slope[2] = -a, -b, (level - 1.0) * h
    bend[0, 0] = bend[1, 1] = 1.0
    bend[2, 2] = 1.0 - level
    if level == 0.0:
        return
    slope[4], slope[5] = -h * a, -h * b
    bend[4, 4], bend[5, 5] = h * h - a * a, h * h - b * b
    bend[4, 5] = bend[5, 4] = -a * b
    bend[0, 4] = bend[4, 0] = bend[1, 5] = bend[5, 1] = h
    bend[2, 4] = bend[4, 2] = a
    bend[2, 5] = bend[5, 2] = b


@device
def newton(room: Any, size: Any, weight: Any, damping: Any, unknowns: Any) -> Any:
    """Write the step -(H + damping D)^-1 g by Cholesky's factors, D the scale of each unknown; its length, or infinity
    unless the matrix is positive definite."""
    g, h, low, step = room[GRADIENT], room[HESSIAN : HESSIAN + 6], room[FACTOR : FACTOR + 6], room[STEP]
    for i in range(unknowns):
        unit = weight * (size * size if i > 3 else 1.0)
        for j in range(i + 1):
            s = h[i, j] + (damping * unit if i == j else 0.0)
            for c in range(j):
                s -= low[i, c] * low[j, c]
            if i > j:
                low[i, j] = s / low[j, j]
            elif not s > 1e-13 * unit:
                return np.inf
            else:
                low[i, i] = np.sqrt(s)
    for i in range(unknowns):
        s = -g[i]
        for c in range(i):
            s -= low[i, c] * step[c]
        step[i] = s / low[i, i]
    length = 0.0
    for j in range(unknowns):
        i = unknowns - 1 - j
        s = step[i]
        for c in range(i + 1, unknowns):
            s -= low[c, i] * step[c]
        step[i] = s / low[i, i]
        length = max(length, np.abs(step[i]) * (size if i > 3 else 1.0))
    return length


@device
def put(place: Any, numbers: Any) -> None:
    """Numbers at a place; an assignment of whole arrays takes numba seconds to compile."""
    for i in range(place.shape[0]):
        place[i] = numbers[i]


@device
def move(fit: Any, step: Any, unknowns: Any, other: Any) -> None:
    """The fit after a step."""
    put(other, fit)
    frame, after = fit[U : U + 9].reshape(3, 3), other[U : U + 9].reshape(3, 3)
    for c in range(3):
        other[POINT + c] += step[0] * frame[0, c] + step[1] * frame[1, c] + step[2] * frame[2, c]
    other[RADIUS] = fit[RADIUS] + step[3]
    if unknowns < 6:
        return
    for c in range(3):
        after[2, c] = frame[2, c] + step[4] * frame[0, c] + step[5] * frame[1, c]
    normalise(after[2])
    along = after[2, 0] * frame[0, 0] + after[2, 1] * frame[0, 1] + after[2, 2] * frame[0, 2]
    for c in range(3):
        after[0, c] = frame[0, c] - along * after[2, c]
    normalise(after[0])
    for c in range(3):
        i, j = (c + 1) % 3, (c + 2) % 3
        after[1, c] = after[2, i] * after[0, j] - after[2, j] * after[0, i]


@device
def normalise(vector: Any) -> None:
    """Give a vector the length 1."""
    length = np.sqrt(vector[0] * vector[0] + vector[1] * vector[1] + vector[2] * vector[2])
    for c in range(3):
        vector[c] /= length if length > 0.0 else 1.0


@device
def round_fit(x: Any, indices: Any, parameters: Any, first: Any, fit: Any, a: Any, room: Any) -> Any:
    """Fit the sphere or circle of a group; returns False if no such shape exists."""
    shape = parameters[first, SHAPE]
    total = flat_fit(x, indices, parameters, first, PLANE, fit, a)
    size = fit[SIZE]
    if not (total > 0.0 and size > 0.0):
        return False
    start_round(x, indices, parameters, first, total, fit, a, shape)
    other, unknowns, damping = room[OTHER], 6 if shape == CIRCLE else 4, 0.0
    energy = slopes(x, indices, parameters, first, fit, room)
    for _ in range(STEPS):
        length = newton(room, size, total, 0.0, unknowns)
        near = length < NEAR * size
        if damping > 0.0 and not near:
            length = newton(room, size, total, damping, unknowns)
        if length < 2.0 * FARTHEST * size:
            move(fit, room[STEP], unknowns, other)
            after = slopes(x, indices, parameters, first, other, room)
            if near or after < energy:
                energy = after
                put(fit, other)
                if near and length < SETTLED * size:
                    return fit[RADIUS] < FARTHEST * size
                damping = 0.1 * damping if damping > 1e-6 else 0.0
                continue
            slopes(x, indices, parameters, first, fit, room)
        damping = max(10.0 * damping, 1e-3)
    return False


@device
def fit_group(x: Any, indices: Any, parameters: Any, first: Any, fit: Any, a: Any, room: Any) -> None:
    """The shape of a group, whichever its parameters ask for."""
    shape = parameters[first, SHAPE]
    if shape <= LINE:
        flat_fit(x, indices, parameters, first, shape, fit, a)
    elif not round_fit(x, indices, parameters, first, fit, a, room):
        flat_fit(x, indices, parameters, first, PLANE if shape == SPHERE else LINE, fit, a)


@device
def off(x: Any, a: Any, fit: Any, d: Any) -> None:
    """The vector from the nearest point of a shape to a particle."""
    height, square, level = 0.0, 0.0, fit[KIND] == SPHERE
    for c in range(3):
        d[c] = x[a, c] - fit[POINT + c]
        height += d[c] * fit[NORMAL + c]
    if fit[KIND] == PLANE:
        for c in range(3):
            d[c] = height * fit[NORMAL + c]
        return
    for c in range(3):
        across = d[c] if level else d[c] - height * fit[NORMAL + c]
        square += across * across
    if fit[KIND] == LINE:
        for c in range(3):
            d[c] -= height * fit[NORMAL + c]
        return
    rho = np.sqrt(square)
    part = fit[RADIUS] / rho if rho > 1e-9 * fit[RADIUS] else 0.0
    for c in range(3):
        d[c] -= part * (d[c] if level else d[c] - height * fit[NORMAL + c])


def fit_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy = 0.0
    fit, a, room, d = np.zeros(WIDE), np.zeros((3, 3)), np.zeros((ROOM, WIDE)), np.zeros(3)
    for first in range(indices.shape[0]):
        if not begins(parameters, first):
            continue
        fit_group(x, indices, parameters, first, fit, a, room)
        e = first if fit[KIND] != NOTHING else -1
        while e >= 0:
            strength, i = parameters[e, STRENGTH], indices[e, 0]
            off(x, i, fit, d)
            w[i] += strength
            for c in range(3):
                f[i, c] -= strength * d[c]
                energy += 0.5 * strength * d[c] * d[c]
            e = following(parameters, e)
    return energy


def find_fits(x, indices, parameters, found):  # type: ignore[no-untyped-def]
    """Write the fit of its group for every row."""
    fit, a, room = np.zeros(WIDE), np.zeros((3, 3)), np.zeros((ROOM, WIDE))
    for first in range(indices.shape[0]):
        e = first if begins(parameters, first) else -1
        if e >= 0:
            fit_group(x, indices, parameters, first, fit, a, room)
        while e >= 0:
            put(found[e], fit)
            e = following(parameters, e)
