"""Numbers of figure 9.31: the drawn surface, read and divided here, and Newton's method on the energy of its nets."""

import json
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))
from independent import springs
from independent_membranes import drawn, forces

net = drawn(Path(__file__).parent / "model.3dm", 10, 10)


def solved(parts):
    """Particles, tensions by part and reactions of springs in parts (pairs, stiffness, rest factor)."""
    pairs = np.concatenate([p for p, _, _ in parts])
    stiffness = np.concatenate([np.full(len(p), k) for p, k, _ in parts])
    rest = np.concatenate([net.lengths(p) * factor for p, _, factor in parts])
    x = springs(net.points, pairs, stiffness, rest, [0.0, 0.0, -20.0], net.corners, tolerance=1e-11)
    tension = forces(x, pairs, stiffness, rest)
    d = x[pairs[:, 1]] - x[pairs[:, 0]]
    pull = (tension / np.linalg.norm(d, axis=1))[:, None] * d
    total = np.tile([0.0, 0.0, -20.0], (len(x), 1))
    np.add.at(total, pairs[:, 0], pull)
    np.add.at(total, pairs[:, 1], -pull)
    return x, np.split(tension, np.cumsum([len(p) for p, _, _ in parts])[:-1]), -total


a, (_, diagonals), reactions = solved([(net.edges, 2000.0, 1.0), (net.one, 1000.0, 1.0)])
_, _, turned = solved([(net.edges, 2000.0, 1.0), (net.other, 1000.0, 1.0)])
c, (warp, weft), _ = solved([(net.along_u, 4000.0, 0.9), (net.along_v, 1000.0, 1.1)])
print(
    json.dumps(
        {
            "A: deepest sag": -a[:, 2].min(),
            "A: reaction at (0, 0)": np.linalg.norm(reactions[net.at(0, 0)]),
            "A: reaction at (10, 0)": np.linalg.norm(reactions[net.at(10, 0)]),
            "A: largest force in a diagonal": diagonals.max(),
            "B: reaction at (0, 0)": np.linalg.norm(turned[net.at(0, 0)]),
            "C: sag in the middle": -c[net.at(5, 5), 2],
            "C: sag of the rim along the warp": -c[net.at(5, 0), 2],
            "C: sag of the rim along the weft": -c[net.at(0, 5), 2],
            "C: largest force in the warp": warp.max(),
            "C: largest force in the weft": weft.max(),
        }
    )
)
