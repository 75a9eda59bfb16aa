"""Numbers of figure 9.6: the equations of motion integrated by scipy, and the equilibrium by Newton's method."""

import json
import sys
from pathlib import Path

import numpy as np
import rhino3dm
from scipy.integrate import solve_ivp

sys.path.insert(0, str(Path(__file__).parents[1]))
from independent import springs

MASS, STIFFNESS, DAMPING, DRAG, LOAD = 1.0, 1000.0, 10.0, 1.0, np.array([0.0, 0.0, -10.0])
file = rhino3dm.File3dm.Read(str(Path(__file__).with_name("model.3dm")))
curve = next(o.Geometry for o in file.Objects if isinstance(o.Geometry, rhino3dm.Curve))
start = np.linspace(*([p.X, p.Y, p.Z] for p in (curve.PointAtStart, curve.PointAtEnd)), 11)
REST = np.linalg.norm(np.diff(start, axis=0), axis=1)


def motion(_, y):
    """Hooke's law and damping along each spring, drag on each particle; both ends held."""
    x, v = y.reshape(2, -1, 3)
    d, u = np.diff(x, axis=0), np.diff(v, axis=0)
    length = np.linalg.norm(d, axis=1)
    along = d / length[:, None]
    force = (STIFFNESS * (length - REST) + DAMPING * (u * along).sum(axis=1))[:, None] * along
    total = LOAD - DRAG * v
    total[:-1] += force
    total[1:] -= force
    a = total / MASS
    a[[0, -1]] = 0.0
    return np.concatenate([v.ravel(), a.ravel()])


def length(x):
    return np.linalg.norm(np.diff(x, axis=0), axis=1).sum()


times = [0.3, 0.6, 0.9, 1.2, 1.8]
still = np.concatenate([start.ravel(), np.zeros(start.size)])
solved = solve_ivp(motion, (0.0, 1.8), still, "DOP853", times, rtol=1e-12, atol=1e-12)
shapes = solved.y.T[:, : start.size].reshape(-1, *start.shape)
rest = springs(start, np.array([[i, i + 1] for i in range(10)]), STIFFNESS, REST, LOAD, held=[0, 10])
numbers = {f"length at {t:.1f} s": length(x) for t, x in zip(times, shapes, strict=True)}
numbers |= {"sag at 0.9 s": -shapes[2, :, 2].min(), "length at rest": length(rest), "sag at rest": -rest[:, 2].min()}
print(json.dumps(numbers))
