"""Numbers of figure 9.16: catenaries by bisection, chains by statics. Prints them as JSON by the names there."""

import json
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))
from independent_catenary import catenary, chain, heights_at_ends, parameter, plane

# start A, end B, length L [m] and direction of gravity of chains of 60 links of 1e7 N/m
CABLES = {
    "rising": ((0, 0, 0), (8, 0, 4), 12.0, (0, 0, -1)),
    "level": ((0, 0, 0), (10, 0, 0), 12.0, (0, 0, -1)),
    "nearly taut": ((0, 0, 0), (10, 0, 0), 10.1, (0, 0, -1)),
    "very slack": ((0, 0, 0), (3, 0, 1), 18.0, (0, 0, -1)),
    "gravity aslant": ((0, 0, 0), (9, 0, 0), 12.0, (0.6, 0, -0.8)),
    "gravity sideways": ((0, 0, 0), (0, 0, -8), 12.0, (1, 0, 0)),
}
numbers = {}
for name, (a, b, length, gravity) in CABLES.items():
    start, end = np.array([a, b], float)
    rest = np.full(60, round(length / 60, 12))
    _, _, span, rise = plane(start, end, gravity)
    at_a, at_b = heights_at_ends(span, rest.sum(), rise)
    found = parameter(span, rest.sum(), rise)
    x, _ = chain(start, end, rest, 1e7, rest[0], gravity)
    drawn = catenary(start, end, rest.sum(), len(rest), gravity)
    numbers[f"{name}: a"] = found
    numbers[f"{name}: depth below A"] = at_a - found
    numbers[f"{name}: largest tension"] = max(at_a, at_b)
    numbers[f"{name}: chain off the catenary"] = np.linalg.norm(x - drawn, axis=1).max()
print(json.dumps(numbers))
