"""Numbers of figure 9.24: the drawn surface, read and divided here, and Newton's method on the energy of its net."""

import json
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))
from independent import springs
from independent_membranes import drawn, forces

net = drawn(Path(__file__).parent / "model.3dm", 20, 20)
rest = net.lengths(net.edges)
x = springs(net.points, net.edges, 2000.0, rest, [0.0, 0.0, -20.0], net.corners)
tension = forces(x, net.edges, 2000.0, rest)
print(
    json.dumps(
        {
            "sag in the middle": -x[net.at(5, 5), 2],
            "largest force": tension.max(),
            "least force": tension.min(),
            "length of all springs": np.sum(rest + tension / 2000.0),
        }
    )
)
