"""Numbers of figure 9.29: the drawn surface, read and divided here, and Newton's method on the energy of its nets."""

import json
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))
from independent import springs
from independent_membranes import drawn, forces, skewness

net = drawn(Path(__file__).parent / "model.3dm", 10, 10)
number = len(net.edges)
numbers = {}
for name, ways in (("none", []), ("one", [net.one]), ("both", [net.one, net.other])):
    pairs = np.concatenate([net.edges, *ways])
    stiffness = np.where(np.arange(len(pairs)) < number, 2000.0, 1000.0)
    rest = net.lengths(pairs)
    x = springs(net.points, pairs, stiffness, rest, [0.0, 0.0, -20.0], net.corners, tolerance=1e-11)
    tension = forces(x, pairs, stiffness, rest)
    skew = skewness(x, net.faces)
    numbers[f"{name}: sag"] = -x[:, 2].min()
    numbers[f"{name}: largest skew of a face"] = skew.max()
    numbers[f"{name}: mean skew of the faces"] = skew.mean()
    numbers[f"{name}: largest force in an edge"] = tension[:number].max()
    if ways:
        numbers[f"{name}: largest force in a diagonal"] = tension[number:].max()
print(json.dumps(numbers))
