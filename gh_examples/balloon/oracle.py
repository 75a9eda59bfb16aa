"""A balloon, and one of two bubbles alike: the radius R at which the gas (Boyle) has the pressure 2 T / R of its film.

(p_out + 2 T / R) c R^3 = p0 V0, by bisection; c R^3 is the volume. Prints JSON by the names of expected.json.
"""

import json
from math import pi

GAS, OUTSIDE, TENSION = 8.0, 1.0, 1.0  # N m, Pa, N/m


def pressure(c):
    """2 T / R [Pa]."""
    low, high = 1e-3, 10.0
    for _ in range(200):
        middle = 0.5 * (low + high)
        if (OUTSIDE + 2.0 * TENSION / middle) * c * middle**3 < GAS:
            low = middle
        else:
            high = middle
    return 2.0 * TENSION / low


# a bubble of two alike is a ball of R without what is beyond R / 2 from its centre: a cap of the height R / 2
cap = pi / 3.0 * 0.5**2 * (3.0 - 0.5)
print(
    json.dumps(
        {
            "balloon: pressure, in the limit of fine meshes": pressure(4.0 / 3.0 * pi),
            "pair: pressure, in the limit of fine meshes": pressure(4.0 / 3.0 * pi - cap),
        }
    )
)
