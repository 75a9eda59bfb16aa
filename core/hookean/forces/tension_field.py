"""Stress of elastic cloth by its strain, with the relaxed energy of tension-field theory where it wrinkles.

W(E) = E C E / 2 is the energy of a strain E = (E11, E22, 2 E12) along warp and weft. Cloth that buckles at once under
compression has the energy W_r(E) = min over A >= 0 of W(E + A), A the shortening that wrinkles take up. It is convex
in E, and its gradient S = C (E + A) is a stress without compression:

    taut      C E >= 0:  A = 0, S = C E
    slack     E <= 0:    A = -E, S = 0
    wrinkled  else:      S = s t t^T, and W_r = max over t of (t E t)^2 / (2 tt C^-1 tt)

With t = (Ew^(1/4) cos(u/2), Ef^(1/4) sin(u/2)), q = t E t = a + b cos u + d sin u and p = tt C^-1 tt = 1 + k sin^2 u,
the greatest q^2 / p is where d cos u = ((1 + k) b + k a cos u) sin u. Sources: Reissner, "On tension field theory",
1938; Pipkin, "Relaxed energy densities for large deformations of membranes", 1994; Steigmann, "Tension-field theory",
1990.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from hookean.compiled.marks import device

SLACK, WRINKLED, TAUT = 0.0, 1.0, 2.0
WARP, WEFT, SHEAR, POISSON = 0, 1, 2, 3  # of the numbers of a cloth


@device
def root(a: Any, b: Any, d: Any, k: Any, low: Any, high: Any) -> Any:
    """Where d cos u - ((1 + k) b + k a cos u) sin u falls through 0 between two angles."""
    u = 0.5 * (low + high)
    for _ in range(80):
        c, s = np.cos(u), np.sin(u)
        value = d * c - ((1.0 + k) * b + k * a * c) * s
        if value > 0.0:
            low = u
        else:
            high = u
        slope = -d * s - (1.0 + k) * b * c - k * a * (2.0 * c * c - 1.0)
        following = u - value / slope if slope < 0.0 else low
        if not low < following < high:
            following = 0.5 * (low + high)
        if following == u or np.abs(following - u) < 1e-17:
            break
        u = following
    return u


@device
def gain(a: Any, b: Any, d: Any, k: Any, u: Any) -> Any:
    """q / sqrt(p), of which the largest is wanted."""
    s = np.sin(u)
    return (a + b * np.cos(u) + d * s) / np.sqrt(1.0 + k * s * s)


@device
def lines_of_tension(a: Any, b: Any, d: Any, k: Any) -> Any:
    """The angle u in (-pi, pi] of the tension of wrinkled cloth."""
    sign = 1.0 if d >= 0.0 else -1.0
    d = np.abs(d)
    bend = k * a
    if not bend > d:  # the function falls all along
        return sign * root(a, b, d, k, 0.0, np.pi)
    turn = np.arcsin((d / bend) ** (1.0 / 3.0))
    one, other = root(a, b, d, k, 0.0, turn), root(a, b, d, k, np.pi - turn, np.pi)
    return sign * (one if gain(a, b, d, k, one) >= gain(a, b, d, k, other) else other)


@device
def respond(cloth: Any, e: Any, s: Any, wrinkling: Any) -> Any:
    """Write the stress (S11, S22, S12) of a strain (E11, E22, 2 E12); the energy, the state, and u where wrinkled."""
    whole = 1.0 / (1.0 - cloth[POISSON] * cloth[POISSON] * cloth[WEFT] / cloth[WARP])
    across = cloth[POISSON] * cloth[WEFT] * whole
    s[0] = cloth[WARP] * whole * e[0] + across * e[1]
    s[1] = across * e[0] + cloth[WEFT] * whole * e[1]
    s[2] = cloth[SHEAR] * e[2]
    if not wrinkling or (s[0] >= 0.0 and s[1] >= 0.0 and s[0] * s[1] >= s[2] * s[2]):
        return 0.5 * (s[0] * e[0] + s[1] * e[1] + s[2] * e[2]), TAUT, 0.0
    if e[0] <= 0.0 and e[1] <= 0.0 and 4.0 * e[0] * e[1] >= e[2] * e[2]:
        s[0], s[1], s[2] = 0.0, 0.0, 0.0
        return 0.0, SLACK, 0.0
    warp, weft = np.sqrt(cloth[WARP]), np.sqrt(cloth[WEFT])
    both = np.sqrt(warp * weft)
    a, b, d = 0.5 * (warp * e[0] + weft * e[1]), 0.5 * (warp * e[0] - weft * e[1]), 0.5 * both * e[2]
    k = stiffening(cloth)
    u = lines_of_tension(a, b, d, k)
    cosine, sine = np.cos(u), np.sin(u)
    q, p = max(a + b * cosine + d * sine, 0.0), 1.0 + k * sine * sine
    s[0] = 0.5 * q / p * warp * (1.0 + cosine)
    s[1] = 0.5 * q / p * weft * (1.0 - cosine)
    s[2] = 0.5 * q / p * both * sine
    return 0.5 * q * q / p, WRINKLED, u


@device
def stiffening(cloth: Any) -> Any:
    """k in p = 1 + k sin^2 u; 0 of isotropic cloth."""
    mean = np.sqrt(cloth[WARP] * cloth[WEFT])
    return 0.25 * (mean / cloth[SHEAR] - 2.0 * cloth[POISSON] * mean / cloth[WARP]) - 0.5


@device
def stiffen(cloth: Any, e: Any, state: Any, u: Any, t: Any, v: Any, stiff: Any) -> None:
    """Write the second derivatives (3, 3) of the energy by the strain; `t` and `v` (3,) are room."""
    for i in range(3):
        for j in range(3):
            stiff[i, j] = 0.0
    if state == SLACK:
        return
    if state == TAUT:
        whole = 1.0 / (1.0 - cloth[POISSON] * cloth[POISSON] * cloth[WEFT] / cloth[WARP])
        stiff[0, 0], stiff[1, 1], stiff[2, 2] = cloth[WARP] * whole, cloth[WEFT] * whole, cloth[SHEAR]
        stiff[0, 1] = stiff[1, 0] = cloth[POISSON] * cloth[WEFT] * whole
        return
    warp, weft = np.sqrt(cloth[WARP]), np.sqrt(cloth[WEFT])
    both, k = np.sqrt(warp * weft), stiffening(cloth)
    cosine, sine = np.cos(u), np.sin(u)
    p, slope = 1.0 + k * sine * sine, 2.0 * k * sine * cosine
    t[0], t[1], t[2] = 0.5 * warp * (1.0 + cosine), 0.5 * weft * (1.0 - cosine), 0.5 * both * sine
    v[0], v[1], v[2] = -0.5 * warp * sine, 0.5 * weft * sine, 0.5 * both * cosine
    q = t[0] * e[0] + t[1] * e[1] + t[2] * e[2]
    b, d = 0.5 * (warp * e[0] - weft * e[1]), 0.5 * both * e[2]
    bend = -b * cosine - d * sine
    bend += q * (0.25 * slope * slope / (p * p) - k * (cosine * cosine - sine * sine) / p)
    turning = -q / (p * bend) if bend < 0.0 and q > 0.0 else 0.0
    for i in range(3):
        v[i] -= 0.5 * slope / p * t[i]
    for i in range(3):
        for j in range(3):
            stiff[i, j] = t[i] * t[j] / p + turning * v[i] * v[j]
