"""Numbers of figure 9.30: the drawn surface, read and divided here, and Newton's method on the energy of its nets.

With shorter diagonals there are many equilibria, which differ in where the creases run. What is printed is the one
from the flat start; `oracle.py starts` also prints those from six random starts, which give the bars of expected.json.
"""

import json
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))
from independent import springs
from independent_membranes import drawn, folds, forces

net = drawn(Path(__file__).parent / "model.3dm", 20, 20)
pairs = np.concatenate([net.edges, net.one, net.other])
held = np.isin(np.arange(len(net.points)), net.corners)


def numbers(factor, start):
    rest = net.lengths(pairs) * np.where(np.arange(len(pairs)) < len(net.edges), 1.0, factor)
    x = springs(start, pairs, 2000.0, rest, [0.0, 0.0, -1.0], net.corners, tolerance=1e-10)
    return {
        f"diagonals {factor:g}: energy of the springs": (forces(x, pairs, 2000.0, rest) ** 2).sum() / 2.0 / 2000.0,
        f"diagonals {factor:g}: deepest sag": -x[:, 2].min(),
        f"diagonals {factor:g}: mean fold of the faces": folds(x, net.faces).mean(),
    }


print(json.dumps({k: v for factor in (1.0, 0.95, 0.9) for k, v in numbers(factor, net.points).items()}))
random = np.random.default_rng(9)
for _ in range(6 if sys.argv[1:] == ["starts"] else 0):
    away = 0.1 * random.normal(size=net.points.shape) * ~held[:, None]
    print(*(f"{v:.4f}" for factor in (1.0, 0.95, 0.9) for v in numbers(factor, net.points + away).values()))
