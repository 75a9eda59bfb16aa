"""Numbers of figure 9.4 from the line as drawn and the independent solver. Prints them as JSON by the names of
expected.json."""

import json
import sys
from pathlib import Path

import numpy as np
import rhino3dm

sys.path.insert(0, str(Path(__file__).parents[1]))
from independent import springs

file = rhino3dm.File3dm.Read(str(Path(__file__).with_name("model.3dm")))
curve = next(o.Geometry for o in file.Objects if isinstance(o.Geometry, rhino3dm.Curve))
start = np.linspace(*([p.X, p.Y, p.Z] for p in (curve.PointAtStart, curve.PointAtEnd)), 11)
pairs = np.array([[i, i + 1] for i in range(10)])
rest = np.linalg.norm(np.diff(start, axis=0), axis=1)
x = springs(start, pairs, 1000.0, rest, [0.0, 0.0, -10.0], held=[0, 10])
lengths = np.linalg.norm(np.diff(x, axis=0), axis=1)
print(
    json.dumps(
        {
            "length": lengths.sum(),
            "length of the first spring": lengths[0],
            "length of a middle spring": lengths[4],
            "force in the first spring": 1000.0 * (lengths[0] - rest[0]),
            "sag": -x[:, 2].min(),
        }
    )
)
