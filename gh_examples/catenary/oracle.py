"""Chains of links between a nail and a ring on a rail, link by link: every particle is in balance.

The horizontal pull H is the same in all links, and the vertical one grows by the weight of a link from one to the next.
At the ring the pull and half the weight of a link are square to the rail. Bisection finds H, at which the ring is at
the distance N / k from its rail. Prints JSON by the names of expected.json.
"""

import json
from math import cos, hypot, pi, sin

SPAN, LENGTH, LINKS, WEIGHT, K = 6.0, 10.0, 40, 20.0, 1e6  # m, m, -, N/m, N/m


def chain(pull, angle):
    """Places [m] and tensions [N] of a chain, and how far its ring is beyond the rail [m]."""
    c, s = cos(angle), sin(angle)
    load = WEIGHT * LENGTH / LINKS
    last = -pull * c / s - 0.5 * load
    x, z, places, tensions = 0.0, 0.0, [(0.0, 0.0)], []
    for i in range(LINKS):
        up = last - (LINKS - 1 - i) * load
        tension = hypot(pull, up)
        size = LENGTH / LINKS + tension / K
        x, z = x + size * pull / tension, z + size * up / tension
        places.append((x, z))
        tensions.append(tension)
    push = pull * s - (last + 0.5 * load) * c  # of the ring on the rail, along (s, -c)
    return places, tensions, (x - SPAN) * s - z * c + push / K, push


found = {}
for degrees in (90, 120, 75):
    low, high = 1e-6, 1e4
    for _ in range(200):
        middle = 0.5 * (low + high)
        if chain(middle, degrees * pi / 180.0)[2] < 0.0:
            low = middle
        else:
            high = middle
    places, tensions, _, push = chain(low, degrees * pi / 180.0)
    found[f"rail at {degrees} degrees: depth of the ring"] = -places[-1][1]
    found[f"rail at {degrees} degrees: horizontal pull"] = low
    found[f"rail at {degrees} degrees: force of the rail"] = push
    found[f"rail at {degrees} degrees: lowest point"] = -min(z for _, z in places)
print(json.dumps(found))
