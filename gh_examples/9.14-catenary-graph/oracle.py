"""Numbers of figure 9.14 for the chain, a row of links by statics. Prints them as JSON."""

import json
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))
from independent_catenary import catenary, chain

scene = json.loads((Path(__file__).parent / "scene.json").read_text())
springs = scene["forces"][0]
rest = np.full(len(springs["particles"]), springs["rest_length"])
start, end = np.array(scene["particles"])[[0, -1]]
x, tension = chain(start, end, rest, springs["stiffness"], rest[0])
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
