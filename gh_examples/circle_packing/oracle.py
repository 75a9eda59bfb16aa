"""Nineteen circles in a boundary that is too small, by the radii a and b of their two rings and the angle t of an outer
circle to the next inner one: the gradient of their energy, by Newton's method in three unknowns.

Prints JSON by the names of expected.json.
"""

import json
from math import cos, pi, sin, sqrt

import numpy as np

STIFFNESS, BOUNDARY = 1e4, 4.8  # N/m, m


def overlaps(a, b, t):
    """Of an inner circle with the centre (and with its neighbours), inner with outer, outer with outer on either side,
    outer with the boundary [m]."""
    apart = sqrt(a * a + b * b - 2 * a * b * cos(t))
    return 2 - a, 2 - apart, 2 - 2 * b * sin(t), 2 - 2 * b * sin(pi / 6 - t), b - (BOUNDARY - 1)


def gradient(unknown):
    """Of the energy of a sixth of the packing: 2, 2, 1, 1 and 2 contacts."""
    a, b, t = unknown
    c, s, u = cos(t), sin(t), pi / 6 - t
    apart = sqrt(a * a + b * b - 2 * a * b * c)
    middle, across, near, far, wall = overlaps(a, b, t)
    return np.array(
        [
            -2 * middle - 2 * across * (a - b * c) / apart,
            -2 * across * (b - a * c) / apart - 2 * near * s - 2 * far * sin(u) + 2 * wall,
            -2 * across * a * b * s / apart - 2 * near * b * c + 2 * far * b * cos(u),
        ]
    )


x, h = np.array([1.98, 3.83, pi / 12]), 1e-6
for _ in range(30):
    slopes = np.column_stack([(gradient(x + h * e) - gradient(x - h * e)) / (2 * h) for e in np.eye(3)])
    x = x - np.linalg.solve(slopes, gradient(x))
found = overlaps(*x)
print(
    json.dumps(
        {
            "nineteen: radius of the inner ring": x[0],
            "nineteen: radius of the outer ring": x[1],
            "nineteen: force of the boundary on a circle": STIFFNESS * found[4],
            "nineteen: largest force between circles": STIFFNESS * max(found[:4]),
        }
    )
)
