"""Numbers of figure 9.6: the equations of motion integrated by scipy, and the equilibrium by Newton's method."""

import json
import sys
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

sys.path.insert(0, str(Path(__file__).parents[1]))
from independent import springs

MASS, STIFFNESS, REST, DAMPING, DRAG, LOAD = 1.0, 1000.0, 2.0, 10.0, 1.0, np.array([0.0, 0.0, -20.0])
start = np.array([[2.0 * i, 0.0, 0.0] for i in range(6)])


def motion(_, y):
    """Hooke's law and damping along each spring, drag on each particle; both ends held."""
    x, v = y.reshape(2, 6, 3)
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


times = [0.6, 0.8, 1.0, 1.2]
still = np.concatenate([start.ravel(), np.zeros(18)])
solved = solve_ivp(motion, (0.0, 1.2), still, "DOP853", times, rtol=1e-12, atol=1e-12)
shapes = solved.y.T[:, :18].reshape(-1, 6, 3)
rest = springs(start, np.array([[i, i + 1] for i in range(5)]), STIFFNESS, REST, LOAD, held=[0, 5])
numbers = {f"length at {t:.1f} s": length(x) for t, x in zip(times, shapes, strict=True)}
numbers |= {"sag at 0.6 s": -shapes[0, :, 2].min(), "length at rest": length(rest), "sag at rest": -rest[:, 2].min()}
print(json.dumps(numbers))
