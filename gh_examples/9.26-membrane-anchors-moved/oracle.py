"""Numbers of figure 9.26: the net on the drawn surface, in equilibrium with its corners moved, by Newton's method."""

import json
import sys
from pathlib import Path

import numpy as np
import rhino3dm

sys.path.insert(0, str(Path(__file__).parents[1]))
from independent import springs

N, STIFFNESS, FACTOR, LOAD = 20, 2000.0, 0.8, np.array([0.0, 0.0, -20.0])
file = rhino3dm.File3dm.Read(str(Path(__file__).with_name("model.3dm")))
surface = next(o.Geometry for o in file.Objects if isinstance(o.Geometry, rhino3dm.Surface))
(u0, u1), (v0, v1) = ((d.T0, d.T1) for d in (surface.Domain(0), surface.Domain(1)))
seen = [surface.PointAt(u, v) for v in np.linspace(v0, v1, N + 1) for u in np.linspace(u0, u1, N + 1)]
start = np.array([[p.X, p.Y, p.Z] for p in seen])
number = np.arange((N + 1) ** 2).reshape(N + 1, N + 1)
pairs = np.concatenate([
    np.stack([number[:, :-1].ravel(), number[:, 1:].ravel()], 1),
    np.stack([number[:-1].ravel(), number[1:].ravel()], 1),
])  # fmt: skip
rest = FACTOR * np.linalg.norm(start[pairs[:, 1]] - start[pairs[:, 0]], axis=1)
corners = {(0, 0): 4.0, (10, 10): 4.0, (10, 0): -1.0, (0, 10): -1.0}
held = [int(np.hypot(start[:, 0] - x, start[:, 1] - y).argmin()) for x, y in corners]

# from the surface ruled between the moved corners
u, v = start[:, 0] / 10.0, start[:, 1] / 10.0
moved = start.copy()
moved[:, 2] = 4.0 - 5.0 * (u + v - 2.0 * u * v)
moved[held, 2] = list(corners.values())
x = springs(moved, pairs, STIFFNESS, rest, LOAD, held, tolerance=1e-10)
d = x[pairs[:, 1]] - x[pairs[:, 0]]
length = np.linalg.norm(d, axis=1)
force = STIFFNESS * (length - rest)
pull = np.zeros_like(x)
np.add.at(pull, pairs[:, 0], (force / length)[:, None] * d)
np.add.at(pull, pairs[:, 1], -(force / length)[:, None] * d)
middle = int(np.hypot(start[:, 0] - 5.0, start[:, 1] - 5.0).argmin())
numbers = {
    "height of the middle": x[middle, 2],
    "largest force": force.max(),
    "smallest force": force.min(),
    "carried by the rising corners": -(pull + LOAD)[held[:2], 2].sum(),
}
print(json.dumps(numbers))
