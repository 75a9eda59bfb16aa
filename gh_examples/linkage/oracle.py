"""Chebyshev's linkage by circles that meet, and the crank's torque by virtual work: T da = W dz of the pen.

Prints JSON by the names of expected.json.
"""

import json
from math import cos, pi, sin, sqrt

WEIGHT = 10.0  # N


def pen(angle):
    """Place of the pen [m] for a crank of 1 m at an angle [rad], bars of 2.5 m, a base of 2 m."""
    a, b = cos(angle), sin(angle)
    half = 0.5 * sqrt((2.0 - a) ** 2 + b * b)
    up = sqrt(6.25 - half * half) / (2.0 * half)
    x, z = 0.5 * (a + 2.0) + b * up, 0.5 * b + (2.0 - a) * up
    return 2.0 * x - a, 2.0 * z - b


found = {}
for angle in (90, 135, 180, 225, 270):
    turn, step = angle * pi / 180.0, 1e-4
    found[f"height of the pen at {angle} degrees"] = pen(turn)[1]
    steps = [pen(turn + k * step)[1] for k in (-2, -1, 1, 2)]
    slope = (steps[0] - 8.0 * steps[1] + 8.0 * steps[2] - steps[3]) / (12.0 * step)
    found[f"torque of the crank at {angle} degrees"] = WEIGHT * slope
found["length of the line"] = pen(0.5 * pi)[0] - pen(1.5 * pi)[0]
print(json.dumps(found))
