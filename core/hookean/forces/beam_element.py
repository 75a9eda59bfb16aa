"""One beam element: its strains, its energy and the exact gradient, for real numbers and for complex ones.

Rows of `p` (6, 3): both ends, their slots, their references (see `rotations`). The chord e runs from end to end; the
frame of each end, t (along the beam), y, z, turns with its particle. The rotation that takes e to t the shortest way
has the angles about y and z

    theta_y = g e.z,  theta_z = -g e.y,  g = angle / sin(angle),  cos(angle) = e.t,

and the twist phi is the angle about e between both frames once they are turned to e that way. The same with complex
numbers gives derivatives without cancellation (the complex step), and so the Hessian.

The frame of an end that is hinged about its y or z alone is that of its particle, turned about this axis until t is as
near to e as it can be; of one that is hinged about t alone, turned about t until there is no twist: so hinges may turn
as far as they like. An end that is hinged about all axes has no angles.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from hookean.compiled.marks import device
from hookean.forces.rotations import mapped, orientation, rotated

ARM, LENGTH, AXIAL, TORSION, BEND_Y, BEND_Z, BOW_Y, BOW_Z, FRAME, OFFSET, HINGE = 0, 2, 3, 4, 5, 8, 11, 14, 17, 35, 41
"""Columns of a beam's parameters: lengths of both slots, L, EA / L, GJ / L, bending stiffness aa ab bb about y and z,
shortening aa ab bb about y and z, frames t y z of both ends at the start (18), eccentricities of both ends (6), and how
both ends are hinged:"""

ABOUT_Y, ABOUT_Z, ABOUT_T, BALL = 1.0, 2.0, 3.0, 4.0
"""about y or z of these two, about t alone, or about all; else 0."""

E, CHORD, ANGLES, TWIST, NORMAL, MOMENTS, TORQUE, STRETCH, ROOM = 24, 27, 28, 32, 33, 34, 38, 39, 48
"""Places in `r`: frames (18) and eccentricities (6) as they are now, e, |chord|, theta_y theta_z of both ends, phi; and
N, the moments of these four angles, that of phi, and the stretch [length]."""


@device
def element(p: Any, c: Any, row: Any, r: Any, q: Any, s: Any, g: Any) -> Any:
    """Write the gradient (12) of the energy of an element to both ends and both slots; False where a frame has turned
    against the chord, which has no direction then. `q` and `s` (4) are room for quaternions."""
    if not strains(p, c, row, r, q, s):
        return False
    stresses(c, row, r)
    gradient(p, c, row, r, g)
    return True


@device
def gradient(p: Any, c: Any, row: Any, r: Any, g: Any) -> None:
    """Write the gradient (12) to both ends and both slots of the strains times the forces in `r`."""
    for i in range(12):
        g[i] = 0.0
    pull(c, row, r, g)
    px, py, pz = g[3], g[4], g[5]
    for end in range(2):
        sign, at = 2.0 * end - 1.0, 6 + 3 * end
        ox, oy, oz = r[18 + 3 * end], r[19 + 3 * end], r[20 + 3 * end]
        a = g[at] + sign * (oy * pz - oz * py)
        b = g[at + 1] + sign * (oz * px - ox * pz)
        d = g[at + 2] + sign * (ox * py - oy * px)
        length = c[row, ARM + end]
        a, b, d = mapped(p, 2 + end, length, -1.0, a, b, d)
        g[at], g[at + 1], g[at + 2] = a / length, b / length, d / length


@device
def strains(p: Any, c: Any, row: Any, r: Any, q: Any, s: Any) -> Any:
    """Frames and eccentricities as they are now, the chord, and the five angles."""
    for end in range(2):
        orientation(p, 2 + end, 4 + end, c[row, ARM + end], q, s)
        for i in range(3):
            at, to = FRAME + 9 * end + 3 * i, 9 * end + 3 * i
            r[to], r[to + 1], r[to + 2] = rotated(q, c[row, at], c[row, at + 1], c[row, at + 2])
        at, to = OFFSET + 3 * end, 18 + 3 * end
        r[to], r[to + 1], r[to + 2] = rotated(q, c[row, at], c[row, at + 1], c[row, at + 2])
    for i in range(3):
        r[E + i] = p[1, i] - p[0, i] + (r[21 + i] - r[18 + i])
    chord = np.sqrt(r[E] * r[E] + r[E + 1] * r[E + 1] + r[E + 2] * r[E + 2])
    if not (1e-20 < chord.real < 1e150):  # far above the complex step
        return False
    r[CHORD] = chord
    for i in range(3):
        r[E + i] /= chord
    for end in range(2):
        hinge = c[row, HINGE + end]
        if hinge in (ABOUT_Y, ABOUT_Z) and not folded(r, end, 3 if hinge == ABOUT_Z else 6):
            return False
        if hinge != BALL and not across(r, end, 0).real > -0.999999:
            return False
    if not twist(c, row, r):
        return False
    for end in range(2):
        r[ANGLES + 2 * end], r[ANGLES + 2 * end + 1] = 0.0, 0.0
        if c[row, HINGE + end] != BALL:
            g = steepness(across(r, end, 0))[0]
            r[ANGLES + 2 * end] = g * across(r, end, 6)
            r[ANGLES + 2 * end + 1] = -g * across(r, end, 3)
    return True


@device
def folded(r: Any, end: Any, axis: Any) -> Any:
    """Turn t of an end and another axis of its frame, 3 y or 6 z, until t is nearest to the chord; False where the
    chord is along the hinge."""
    along, beside = across(r, end, 0), across(r, end, axis)
    size = np.sqrt(along * along + beside * beside)
    if not size.real > 1e-6:
        return False
    along, beside = along / size, beside / size
    for i in range(9 * end, 9 * end + 3):
        t, n = r[i], r[i + axis]
        r[i], r[i + axis] = along * t + beside * n, along * n - beside * t
    return True


@device
def across(r: Any, end: Any, axis: Any) -> Any:
    """The chord along an axis of an end's frame: 0 t, 3 y, 6 z."""
    at = 9 * end + axis
    return r[E] * r[at] + r[E + 1] * r[at + 1] + r[E + 2] * r[at + 2]


@device
def steepness(c: Any) -> Any:
    """g = angle / sin(angle) of a cosine, and its derivative by the cosine."""
    u = 1.0 / (1.0 + c)
    t = (1.0 - c) * u  # tan^2 of half the angle
    if np.abs(t.real) < 0.02:
        h, d = 0.0 * t, 0.0 * t
        for i in range(9, -1, -1):  # atan(sqrt t) / sqrt t, and its derivative
            h = h * t + (1.0 - 2.0 * (i % 2)) / (2 * i + 1)
            d = d * t - (1.0 - 2.0 * (i % 2)) * (i + 1) / (2 * i + 3)
    else:
        root = np.sqrt(t)
        h = np.arctan(root) / root
        d = (1.0 / (1.0 + t) - h) / (2.0 * t)
    return 2.0 * h * u, -2.0 * u * u * (h + 2.0 * u * d)


@device
def twist(c: Any, row: Any, r: Any) -> Any:
    """The angle phi about the chord between both frames, each turned to it the shortest way; none at a hinge, where the
    frame of an end that is hinged about t alone turns with the other one."""
    first, last = c[row, HINGE] == ABOUT_T, c[row, HINGE + 1] == ABOUT_T
    r[TWIST] = 0.0
    if c[row, TORSION] == 0.0 and not first and not last:
        return True
    ua, ub = 1.0 / (1.0 + across(r, 0, 0)), 1.0 / (1.0 + across(r, 1, 0))
    ay, az, by = ua * across(r, 0, 3), ua * across(r, 0, 6), ub * across(r, 1, 3)
    sine, cosine = 0.0 * ua, 0.0 * ua
    for i in range(3):
        y = r[12 + i] - by * (r[E + i] + r[9 + i])
        cosine += y * (r[3 + i] - ay * (r[E + i] + r[i]))
        sine += y * (r[6 + i] - az * (r[E + i] + r[i]))
    if first or last:
        size = np.sqrt(sine * sine + cosine * cosine)
        sine, cosine = sine / size, cosine / size
        at = 3 if first else 12
        for i in range(at, at + 3):
            y, z = r[i], r[i + 3]
            if first:
                r[i], r[i + 3] = cosine * y + sine * z, cosine * z - sine * y
            else:
                r[i], r[i + 3] = cosine * y - sine * z, cosine * z + sine * y
        return True
    if not cosine.real > -0.999999:
        return False
    r[TWIST] = 2.0 * np.arctan(sine / (1.0 + cosine))
    return True


@device
def stresses(c: Any, row: Any, r: Any) -> None:
    """The normal force, and the moments that work on the angles; bending shortens the chord."""
    stretch = r[CHORD] - c[row, LENGTH]
    for axis in range(2):
        bow = BOW_Y + 3 * axis
        one, two = r[ANGLES + axis], r[ANGLES + 2 + axis]
        stretch += one * (0.5 * c[row, bow] * one + c[row, bow + 1] * two) + 0.5 * c[row, bow + 2] * two * two
    normal = c[row, AXIAL] * stretch
    r[STRETCH], r[NORMAL] = stretch, normal
    for axis in range(2):
        stiff, bow = BEND_Y + 3 * axis, BOW_Y + 3 * axis
        one, two = r[ANGLES + axis], r[ANGLES + 2 + axis]
        mixed = c[row, stiff + 1] + normal * c[row, bow + 1]
        r[MOMENTS + axis] = (c[row, stiff] + normal * c[row, bow]) * one + mixed * two
        r[MOMENTS + 2 + axis] = mixed * one + (c[row, stiff + 2] + normal * c[row, bow + 2]) * two
    r[TORQUE] = c[row, TORSION] * r[TWIST]


@device
def given(c: Any, row: Any, r: Any, forces: Any) -> None:
    """Put forces (6) in the place of those that the strains have: N, the torque, and the moments y z y z of bending
    alone. What the normal force does on bending follows the angles."""
    r[NORMAL], r[TORQUE] = forces[0], forces[1]
    for axis in range(2):
        bow, one, two = BOW_Y + 3 * axis, r[ANGLES + axis], r[ANGLES + 2 + axis]
        r[MOMENTS + axis] = forces[2 + axis] + forces[0] * (c[row, bow] * one + c[row, bow + 1] * two)
        r[MOMENTS + 2 + axis] = forces[4 + axis] + forces[0] * (c[row, bow + 1] * one + c[row, bow + 2] * two)


@device
def energy_of(c: Any, row: Any, r: Any) -> Any:
    """The energy of an element by its strains."""
    energy = c[row, AXIAL] * r[STRETCH] * r[STRETCH] + c[row, TORSION] * r[TWIST] * r[TWIST]
    for axis in range(2):
        stiff = BEND_Y + 3 * axis
        one, two = r[ANGLES + axis], r[ANGLES + 2 + axis]
        energy += one * (c[row, stiff] * one + 2.0 * c[row, stiff + 1] * two) + c[row, stiff + 2] * two * two
    return 0.5 * energy


@device
def pull(c: Any, row: Any, r: Any, g: Any) -> None:
    """The gradient to both ends, and the moments about them (12): of the chord's length and of the angles."""
    ex, ey, ez = r[E], r[E + 1], r[E + 2]
    g[0], g[1], g[2] = 0.0 * ex, 0.0 * ex, 0.0 * ex  # gradient to e
    torque = r[TORQUE]
    for end in range(2):
        if c[row, HINGE + end] != BALL:
            bent(r, end, g)
        if c[row, HINGE + end] == ABOUT_T:  # what turning the frame about t would work, the twist of the others does
            at, to = 9 * end, 6 + 3 * end
            torque += (1.0 - 2.0 * end) * (g[to] * r[at] + g[to + 1] * r[at + 1] + g[to + 2] * r[at + 2])
    for end in range(2):
        hinge, at, to = c[row, HINGE + end], 9 * end, 6 + 3 * end
        if hinge == BALL:
            continue
        tx, ty, tz = r[at], r[at + 1], r[at + 2]
        turn = (2.0 * end - 1.0) * torque / (1.0 + across(r, end, 0))
        g[0] -= turn * (ty * ez - tz * ey)
        g[1] -= turn * (tz * ex - tx * ez)
        g[2] -= turn * (tx * ey - ty * ex)
        g[to] += turn * (ex + tx)
        g[to + 1] += turn * (ey + ty)
        g[to + 2] += turn * (ez + tz)
        if hinge in (ABOUT_Y, ABOUT_Z):
            hinged(r, end, hinge, g)
    qx, qy, qz = g[0], g[1], g[2]
    along = qx * ex + qy * ey + qz * ez
    scale = 1.0 / r[CHORD]
    normal = r[NORMAL] - scale * along
    g[3] = normal * ex + scale * qx
    g[4] = normal * ey + scale * qy
    g[5] = normal * ez + scale * qz
    g[0], g[1], g[2] = -g[3], -g[4], -g[5]


@device
def bent(r: Any, end: Any, g: Any) -> None:
    """Add what the moments of an end's bending give to e, in the first rows of `g`, and to the frame of the end."""
    at, to = 9 * end, 6 + 3 * end
    ex, ey, ez = r[E], r[E + 1], r[E + 2]
    along, y, z = across(r, end, 0), across(r, end, 3), across(r, end, 6)
    factor, slope = steepness(along)
    my, mz = r[MOMENTS + 2 * end], r[MOMENTS + 2 * end + 1]
    in_t, in_y, in_z = slope * (z * my - y * mz), -factor * mz, factor * my
    ax = in_t * r[at] + in_y * r[at + 3] + in_z * r[at + 6]
    ay = in_t * r[at + 1] + in_y * r[at + 4] + in_z * r[at + 7]
    az = in_t * r[at + 2] + in_y * r[at + 5] + in_z * r[at + 8]
    g[0] += ax
    g[1] += ay
    g[2] += az
    g[to] += ay * ez - az * ey
    g[to + 1] += az * ex - ax * ez
    g[to + 2] += ax * ey - ay * ex


@device
def hinged(r: Any, end: Any, hinge: Any, g: Any) -> None:
    """Add what moves the frame of an end about its hinge: where the particle turns by w and the chord's direction by d,
    by (d.n + w.(n x e)) / e.t about z, n = y, or by minus this about y, n = z."""
    at, to = 9 * end, 6 + 3 * end
    axis, other, sign = (6, 3, 1.0) if hinge == ABOUT_Z else (3, 6, -1.0)
    work = g[to] * r[at + axis] + g[to + 1] * r[at + axis + 1] + g[to + 2] * r[at + axis + 2]
    work *= sign / across(r, end, 0)
    nx, ny, nz = r[at + other], r[at + other + 1], r[at + other + 2]
    ex, ey, ez = r[E], r[E + 1], r[E + 2]
    g[0] += work * nx
    g[1] += work * ny
    g[2] += work * nz
    g[to] += work * (ny * ez - nz * ey)
    g[to + 1] += work * (nz * ex - nx * ez)
    g[to + 2] += work * (nx * ey - ny * ex)


@device
def bound(c: Any, row: Any, r: Any, w: Any, indices: Any) -> None:
    """Add the lumped stiffness of an element: k |b_i| sum |b| for each strain of stiffness k with the gradient b_i to
    node i, the larger one of those along and across the chord, and what the element's forces stiffen."""
    end, one, two = 1.0 / r[CHORD].real, 1.0 / c[row, ARM], 1.0 / c[row, ARM + 1]
    first, last, middle, forces = 0.0, 0.0, 0.0, 0.5 * np.abs(r[NORMAL]) / end + 2.0 * np.abs(r[TORQUE])
    bow_a, bow_b = 0.0, 0.0  # how much the angles shorten the chord
    for axis in range(2):
        stiff, bow = BEND_Y + 3 * axis, BOW_Y + 3 * axis
        mixed = np.abs(c[row, stiff + 1])
        a, b = (c[row, stiff] + mixed), (c[row, stiff + 2] + mixed)
        middle = max(middle, a * end * (2.0 * end + one) + b * end * (2.0 * end + two))
        first = max(first, a * one * (2.0 * end + one))
        last = max(last, b * two * (2.0 * end + two))
        forces += 2.0 * (np.abs(r[MOMENTS + axis]) + np.abs(r[MOMENTS + 2 + axis]))
        bow_a += np.abs(c[row, bow] * r[ANGLES + axis] + c[row, bow + 1] * r[ANGLES + 2 + axis])
        bow_b += np.abs(c[row, bow + 1] * r[ANGLES + axis] + c[row, bow + 2] * r[ANGLES + 2 + axis])
    twist_on = c[row, TORSION] * (one + two)
    bow = (bow_a + bow_b) * end
    along = c[row, AXIAL] * (2.0 + 2.0 * bow + bow_a * one + bow_b * two)
    pushed = forces * (2.0 * end + one + two)
    middle = max(along, middle) + along * bow + pushed * end
    first = max(first, twist_on * one) + along * bow_a * one + pushed * one
    last = max(last, twist_on * two) + along * bow_b * two + pushed * two
    for i in range(2):
        o, arm = OFFSET + 3 * i, one if i == 0 else two
        reach = np.sqrt(c[row, o] ** 2 + c[row, o + 1] ** 2 + c[row, o + 2] ** 2) * arm
        w[indices[row, i]] += middle * (1.0 + reach)
        w[indices[row, 2 + i]] += (first if i == 0 else last) + middle * (1.0 + reach) * reach
