"""Numbers of figure 9.7: both equilibria by Newton's method, from the line and points as drawn."""

import json
import sys
from pathlib import Path

import numpy as np
import rhino3dm

sys.path.insert(0, str(Path(__file__).parents[1]))
from independent import springs

file = rhino3dm.File3dm.Read(str(Path(__file__).with_name("model.3dm")))
curve = next(o.Geometry for o in file.Objects if isinstance(o.Geometry, rhino3dm.Curve))
ends = [curve.PointAtStart, curve.PointAtEnd]
start = np.linspace(*([p.X, p.Y, p.Z] for p in ends), 11)
pairs = np.array([[i, i + 1] for i in range(10)])
rest = np.linalg.norm(np.diff(start, axis=0), axis=1)


def hung(shift):
    """The cable with its right end shifted: as drawn, bent down a little so that it knows where to go."""
    x = start + np.linspace(0, 1, 11)[:, None] * shift
    x[1:-1, 2] -= 2.0
    return springs(x, pairs, 1000.0, rest, [0.0, 0.0, -10.0], held=[0, 10])


def length(x):
    return np.linalg.norm(np.diff(x, axis=0), axis=1).sum()


before, moved = hung(np.zeros(3)), hung(np.array([-3.0, 0.0, 2.0]))
print(
    json.dumps(
        {
            "length before": length(before),
            "length while moved": length(moved),
            "lowest point while moved": moved[:, 2].min(),
            "largest force while moved": (1000.0 * (np.linalg.norm(np.diff(moved, axis=0), axis=1) - rest)).max(),
        }
    )
)
