"""Numbers of the sail: its motion row by row of the wind by scipy's integrator, its equilibrium by Newton's method."""

import json
import sys
from pathlib import Path

import numpy as np
import rhino3dm
from scipy.integrate import solve_ivp

sys.path.insert(0, str(Path(__file__).parents[1]))
from independent import springs

HERE, N = Path(__file__).parent, 10
DAMPING, DRAG, MASS, FRAME = 10.0, 3.0, 1.0, 0.1
file = rhino3dm.File3dm.Read(str(HERE / "model.3dm"))
surface = next(o.Geometry for o in file.Objects if isinstance(o.Geometry, rhino3dm.Surface))
(u0, u1), (v0, v1) = ((d.T0, d.T1) for d in (surface.Domain(0), surface.Domain(1)))
seen = [surface.PointAt(u, v) for v in np.linspace(v0, v1, N + 1) for u in np.linspace(u0, u1, N + 1)]
start = np.array([[p.X, p.Y, p.Z] for p in seen])
number = np.arange(len(start)).reshape(N + 1, N + 1)
held = number[[0, 0, -1, -1], [0, -1, 0, -1]]
net = np.concatenate([
    np.stack([number[:, :-1].ravel(), number[:, 1:].ravel()], 1),
    np.stack([number[:-1].ravel(), number[1:].ravel()], 1),
])  # fmt: skip
sides = (number[0], number[-1], number[:, 0], number[:, -1])
edge = np.concatenate([np.stack([side[:-1], side[1:]], 1) for side in sides])
pairs = np.concatenate([net, edge])  # springs of the sail, then the cables along its sides
kind = np.repeat([0, 1], [len(net), len(edge)])
STIFFNESS, FACTOR = np.array([4000.0, 40000.0])[kind], np.array([0.92, 0.97])[kind]
rest = FACTOR * np.linalg.norm(start[pairs[:, 1]] - start[pairs[:, 0]], axis=1)
ends = np.zeros((len(start), len(pairs)))
ends[pairs[:, 0], np.arange(len(pairs))], ends[pairs[:, 1], np.arange(len(pairs))] = 1.0, -1.0
wind = np.loadtxt(HERE / "wind.csv", delimiter=",", skiprows=1)
per_speed = 0.5 * 1.225 * 36.0 / 121.0 * np.array([0.5, 0.0, 0.8])


def motion(_, y, load):
    x, v = y.reshape(2, -1, 3)
    d, u = x[pairs[:, 1]] - x[pairs[:, 0]], v[pairs[:, 1]] - v[pairs[:, 0]]
    length = np.sqrt((d * d).sum(axis=1))
    along = d / length[:, None]
    force = STIFFNESS * (length - rest) + DAMPING * (u * along).sum(axis=1)
    a = (ends @ (force[:, None] * along) + load - DRAG * v) / MASS
    a[held] = 0.0
    return np.concatenate([v.ravel(), a.ravel()])


def largest(x):
    return (STIFFNESS * (np.linalg.norm(x[pairs[:, 1]] - x[pairs[:, 0]], axis=1) - rest))[kind == 1].max()


y = np.concatenate([start.ravel(), np.zeros(start.size)])
most, when = largest(start), 0.0
for (begin, speed), (end, _) in zip(wind[wind[:, 0] < 22], wind[1:], strict=False):
    times = begin + FRAME * np.arange(1, round((end - begin) / FRAME) + 1)
    load = per_speed * speed**2
    solved = solve_ivp(motion, (begin, end), y, "DOP853", np.minimum(times, end), args=(load,), rtol=1e-6, atol=1e-7)
    y = solved.y[:, -1]
    for time, at in zip(solved.t, solved.y.T, strict=True):
        force = largest(at[: start.size].reshape(-1, 3))
        if force > most:
            most, when = force, time
steady = springs(start, pairs, STIFFNESS, rest, per_speed * 12.0**2, held, tolerance=1e-10)
print(
    json.dumps(
        {
            "largest force in an edge, in the gust": most,
            "time of the largest force": when,
            "height of the middle at a steady 12 m/s": steady[number[N // 2, N // 2], 2],
            "largest force in an edge at a steady 12 m/s": largest(steady),
        }
    )
)
