"""Numbers of figure 9.14 for the chain, a row of links by statics. Prints them as JSON."""

import json
import sys
from pathlib import Path

import numpy as np
from scipy.optimize import brentq

sys.path.insert(0, str(Path(__file__).parents[1]))
from independent_catenary import catenary, chain

# 120 links of 0.1 m and 1e7 N/m over a span of 10 m, held at the height of y = a cosh(x / a)
rest = np.full(120, 0.1)
a = brentq(lambda a: 2.0 * a * np.sinh(5.0 / a) - 12.0, 1.0, 100.0)
start, end = np.array([[-5.0, 0.0, a * np.cosh(5.0 / a)], [5.0, 0.0, a * np.cosh(5.0 / a)]])
x, tension = chain(start, end, rest, 1e7, rest[0])
# at an anchor the tension of the last link and half of its weight
direction = (x[1] - x[0]) / np.linalg.norm(x[1] - x[0])
reaction = -tension[0] * direction + [0.0, 0.0, 0.5 * rest[0]]
drawn = catenary(start, end, rest.sum(), len(rest))
print(
    json.dumps(
        {
            "chain: sag": x[0, 2] - x[:, 2].min(),
            "chain: largest reaction": np.linalg.norm(reaction),
            "chain: off the catenary": np.linalg.norm(x - drawn, axis=1).max(),
        }
    )
)
