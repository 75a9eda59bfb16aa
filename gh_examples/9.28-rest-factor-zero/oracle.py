"""Numbers of figure 9.28 from integrals: the area of z = x y, and the minimal surface in the same frame, a patch of
Schwarz's D surface given by Weierstrass and Enneper's integrals."""

import json

import numpy as np
from scipy.integrate import dblquad, quad
from scipy.optimize import brentq

VERTEX = (np.sqrt(3.0) - 1.0) / np.sqrt(2.0)  # where 1 - 14 t^4 + t^8 = 0: a corner of the frame


def integral(f, t):
    """Integral of f / sqrt(1 - 14 t^4 + t^8) from 0 to t, with t = VERTEX sin(a), as it ends in a square root.

    1 - 14 t^4 + t^8 = (v^4 - t^4) (1 / v^4 - t^4), v = VERTEX, and v^4 - t^4 = v^4 cos^2(a) (1 + sin^2(a)).
    """

    def integrand(a):
        s = VERTEX * np.sin(a)
        return f(s) * VERTEX / (VERTEX**2 * np.sqrt((1.0 + np.sin(a) ** 2) * (VERTEX**-4 - s**4)))

    return quad(integrand, 0.0, np.arcsin(min(t / VERTEX, 1.0)), epsabs=1e-14)[0]


def across(t):
    """Distance from the centre along the plane of symmetry, unscaled."""
    return integral(lambda s: 1.0 - s * s, t)


def up(t):
    return integral(lambda s: 2.0 * s, t)


scale = 1.0 / up(VERTEX)  # the corner (1, 1) of the frame stands 1 high
assert abs(scale * across(VERTEX) - np.sqrt(2.0)) < 1e-12  # and lies sqrt(2) off the centre
there = brentq(lambda t: scale * across(t) - np.sqrt(0.5), 0.01, 0.5, xtol=1e-15)
net = dblquad(lambda y, x: np.sqrt(1.0 + x * x + y * y), -1.0, 1.0, -1.0, 1.0, epsabs=1e-12)[0]
print(json.dumps({"film: height over (0.5, 0.5)": scale * up(there), "net: area": net}))
