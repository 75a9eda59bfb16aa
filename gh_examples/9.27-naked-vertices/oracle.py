"""Numbers of figure 9.27: the drawn surface and points, read here, and Newton's method on the energy of the net."""

import json
import sys
from pathlib import Path

import numpy as np
import rhino3dm

sys.path.insert(0, str(Path(__file__).parents[1]))
from independent import springs
from independent_membranes import drawn, forces

model = Path(__file__).parent / "model.3dm"
net = drawn(model, 20, 20)
rest = net.lengths(net.edges)
marks = [
    o.Geometry.Location for o in rhino3dm.File3dm.Read(str(model)).Objects if isinstance(o.Geometry, rhino3dm.Point)
]
points = np.array([net.at(p.X, p.Y) for p in marks])
numbers = {}
for name, held in (("rim", net.rim), ("points", points)):
    x = springs(net.points, net.edges, 2000.0, rest, [0.0, 0.0, -20.0], held, tolerance=1e-11)
    tension = forces(x, net.edges, 2000.0, rest)
    numbers[f"{name}: sag in the middle"] = -x[net.at(5, 5), 2]
    numbers[f"{name}: deepest sag"] = -x[:, 2].min()
    numbers[f"{name}: largest force"] = tension.max()
# what the springs pull down at a held particle, and its own load
down = np.full(len(x), 20.0)
along = (x[net.edges[:, 1]] - x[net.edges[:, 0]])[:, 2] / (rest + tension / 2000.0) * tension
np.add.at(down, net.edges[:, 0], -along)
np.add.at(down, net.edges[:, 1], along)
numbers["points: part of the load on the four inside"] = down[points[4:]].sum() / (20.0 * len(x))
print(json.dumps(numbers))
