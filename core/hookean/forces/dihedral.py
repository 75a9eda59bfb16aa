"""Fold angles across an edge a-b between the triangles a-b-c and b-a-d, shared by hinges and shells.

With e = b - a, N1 = e x (c - a), N2 = (d - a) x e the fold angle is atan2(|e| N2 . (c - a), N1 . N2): 0 where flat,
positive where the tips c and d rise to the side N1 points to. Its gradient is N1 |e| / |N1|^2 at c and
N2 |e| / |N2|^2 at d; a and b share the opposite of both by the foot of each tip on the edge, so forces and moments
sum to zero for triangles of any size. Source: Grinspun et al., "Discrete shells", 2003; Bridson et al., "Simulation of
clothing with folds and wrinkles", 2003.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.compiled.marks import device

Floats = NDArray[np.float64]

SLIVER = 1e-8
"""Triangles lower than this part of their size have no normal to speak of, and fold without force."""


@device
def fold(x: Any, a: Any, b: Any, c: Any, d: Any, g: Any) -> Any:
    """Fold angle [rad] of a, b, c, d, and `g` as in `slopes`; nan for a sliver, and then `g` is not written."""
    sine, cosine = slopes(x, a, b, c, d, g)
    return np.arctan2(sine, cosine)


@device
def slopes(x: Any, a: Any, b: Any, c: Any, d: Any, g: Any) -> Any:
    """Sine and cosine of the fold angle of a, b, c, d, of one size; nan for a sliver, and then `g` is not written.

    `g` (4, 5): for a, b, c, d the gradient of the angle; then what one unit of stiffness (g g^T) and one unit of moment
    (the second derivatives of the angle) add at most to the stiffness that each particle feels.
    """
    ex = x[b, 0] - x[a, 0]
    ey = x[b, 1] - x[a, 1]
    ez = x[b, 2] - x[a, 2]
    px = x[c, 0] - x[a, 0]
    py = x[c, 1] - x[a, 1]
    pz = x[c, 2] - x[a, 2]
    qx = x[d, 0] - x[a, 0]
    qy = x[d, 1] - x[a, 1]
    qz = x[d, 2] - x[a, 2]
    mx = ey * pz - ez * py
    my = ez * px - ex * pz
    mz = ex * py - ey * px
    nx = qy * ez - qz * ey
    ny = qz * ex - qx * ez
    nz = qx * ey - qy * ex
    ee = ex * ex + ey * ey + ez * ez
    mm = mx * mx + my * my + mz * mz
    nn = nx * nx + ny * ny + nz * nz
    size = ee + px * px + py * py + pz * pz
    if not mm > SLIVER * SLIVER * size * size:
        return np.nan, np.nan
    size = ee + qx * qx + qy * qy + qz * qz
    if not nn > SLIVER * SLIVER * size * size or not ee * ee > 1e-280:
        return np.nan, np.nan
    length = np.sqrt(ee)
    at_c = length / mm
    at_d = length / nn
    foot_c = (px * ex + py * ey + pz * ez) / ee
    foot_d = (qx * ex + qy * ey + qz * ez) / ee
    g[2, 0] = mx * at_c
    g[2, 1] = my * at_c
    g[2, 2] = mz * at_c
    g[3, 0] = nx * at_d
    g[3, 1] = ny * at_d
    g[3, 2] = nz * at_d
    for i in range(3):
        g[0, i] = -(1.0 - foot_c) * g[2, i] - (1.0 - foot_d) * g[3, i]
        g[1, i] = -foot_c * g[2, i] - foot_d * g[3, i]
    up = length / np.sqrt(mm)
    down = length / np.sqrt(nn)
    g[2, 3] = up
    g[3, 3] = down
    g[0, 3] = np.sqrt(g[0, 0] * g[0, 0] + g[0, 1] * g[0, 1] + g[0, 2] * g[0, 2])
    g[1, 3] = np.sqrt(g[1, 0] * g[1, 0] + g[1, 1] * g[1, 1] + g[1, 2] * g[1, 2])
    g[2, 4] = up
    g[3, 4] = down
    g[0, 4] = np.abs(1.0 - foot_c) * up + np.abs(1.0 - foot_d) * down + 1.0 / length
    g[1, 4] = np.abs(foot_c) * up + np.abs(foot_d) * down + 1.0 / length
    first = g[0, 3] + g[1, 3] + g[2, 3] + g[3, 3]
    second = g[0, 4] + g[1, 4] + g[2, 4] + g[3, 4]
    for i in range(4):
        g[i, 3] *= first
        g[i, 4] *= second
    return length * (nx * px + ny * py + nz * pz), mx * nx + my * ny + mz * nz


@device
def bends(x: Any, a: Any, b: Any, c: Any, d: Any, g: Any, h: Any) -> None:
    """Write the second derivatives `h` (12, 12) of the fold angle by a, b, c, d, with `g` as in `slopes`.

    The gradient at a tip is L N / |N|^2, of which N and L change as c, d and the edge move; that at b is minus the sum
    of both, each by its foot s on the edge; and a translation changes nothing.
    """
    ex, ey, ez = x[b, 0] - x[a, 0], x[b, 1] - x[a, 1], x[b, 2] - x[a, 2]
    px, py, pz = x[c, 0] - x[a, 0], x[c, 1] - x[a, 1], x[c, 2] - x[a, 2]
    qx, qy, qz = x[d, 0] - x[a, 0], x[d, 1] - x[a, 1], x[d, 2] - x[a, 2]
    ee = ex * ex + ey * ey + ez * ez
    foot_c, foot_d = (px * ex + py * ey + pz * ez) / ee, (qx * ex + qy * ey + qz * ez) / ee
    tip(h, 2, g, 1.0, ex, ey, ez, px, py, pz)
    tip(h, 3, g, -1.0, ex, ey, ez, qx, qy, qz)
    for i in range(3):
        for j in range(3):
            ej, pj, qj = component(ex, ey, ez, j), component(px, py, pz, j), component(qx, qy, qz, j)
            h[6 + i, 9 + j] = 0.0
            h[9 + i, 6 + j] = 0.0
            h[3 + i, 3 + j] = -g[2, i] * (pj - 2.0 * foot_c * ej) / ee - g[3, i] * (qj - 2.0 * foot_d * ej) / ee
            h[3 + i, 3 + j] -= foot_c * h[6 + i, 3 + j] + foot_d * h[9 + i, 3 + j]
    for i in range(3):
        for j in range(3):
            h[3 + j, 6 + i] = h[6 + i, 3 + j]
            h[3 + j, 9 + i] = h[9 + i, 3 + j]
    for i in range(3, 12):
        for j in range(3):
            h[i, j] = -h[i, 3 + j] - h[i, 6 + j] - h[i, 9 + j]
            h[j, i] = h[i, j]
    for i in range(3):
        for j in range(3):
            h[i, j] = -h[i, 3 + j] - h[i, 6 + j] - h[i, 9 + j]


@device
def tip(h: Any, at: Any, g: Any, sign: Any, ex: Any, ey: Any, ez: Any, px: Any, py: Any, pz: Any) -> None:
    """Write how the gradient at a tip p from a changes with the tip and with b; `sign`: N = e x p, or p x e."""
    length = np.sqrt(ex * ex + ey * ey + ez * ez)
    gx, gy, gz = g[at, 0], g[at, 1], g[at, 2]
    gg = gx * gx + gy * gy + gz * gz  # L^2 / |N|^2
    # with J = (1 - 2 n n) / |N|^2: L J [e] by the tip, -L J [p] + N / |N|^2 e / L by b
    scale = gg / length
    for i in range(3):
        gi = component(gx, gy, gz, i)
        for j in range(3):
            k, m = (j + 1) % 3, (j + 2) % 3
            # row i of J times column j of a cross product [v]: (J [v])_ij = J_ik v_m - J_im v_k
            gk, gm = component(gx, gy, gz, k), component(gx, gy, gz, m)
            jk = scale * ((1.0 if i == k else 0.0) - 2.0 * gi * gk / gg)
            jm = scale * ((1.0 if i == m else 0.0) - 2.0 * gi * gm / gg)
            ek, em, ej = component(ex, ey, ez, k), component(ex, ey, ez, m), component(ex, ey, ez, j)
            pk, pm = component(px, py, pz, k), component(px, py, pz, m)
            h[3 * at + i, 3 * at + j] = sign * (jk * em - jm * ek)
            h[3 * at + i, 3 + j] = -sign * (jk * pm - jm * pk) + gi / length * ej / length


@device
def component(x: Any, y: Any, z: Any, i: Any) -> Any:
    """Component i of x, y, z."""
    return x if i == 0 else y if i == 1 else z


@device
def turn(indices: Any, e: Any, stiffness: Any, moment: Any, g: Any, f: Any, w: Any) -> None:
    """Turn both triangles by a moment against their fold, with `g` as in `slopes`; `stiffness` is that per radian."""
    for i in range(4):
        p = indices[e, i]
        w[p] += stiffness * g[i, 3] + np.abs(moment) * g[i, 4]
        for c in range(3):
            f[p, c] -= moment * g[i, c]


@device
def wrapped(angle: Any) -> Any:
    """The same angle in (-pi, pi]."""
    return angle - 2.0 * np.pi * np.ceil((angle - np.pi) / (2.0 * np.pi))


def fold_angles(x: Floats, corners: NDArray[np.int64]) -> Floats:
    """Fold angles [rad] of rows of `corners` (..., 4) = a, b, c, d; 0 where a triangle is a sliver."""
    a, b, c, d = (x[corners[..., i]] for i in range(4))
    e, p, q = b - a, c - a, d - a
    m, n = np.cross(e, p), np.cross(q, e)
    ee = (e * e).sum(axis=-1)
    flat_c = (m * m).sum(axis=-1) > (SLIVER * (ee + (p * p).sum(axis=-1))) ** 2
    flat_d = (n * n).sum(axis=-1) > (SLIVER * (ee + (q * q).sum(axis=-1))) ** 2
    angle = np.arctan2(np.sqrt(ee) * (n * p).sum(axis=-1), (m * n).sum(axis=-1))
    return np.where(flat_c & flat_d, angle, 0.0)
