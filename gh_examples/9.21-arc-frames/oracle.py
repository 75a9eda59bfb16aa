"""Numbers of figure 9.21: the equations of motion by a Runge-Kutta method of order 8, equilibrium by statics.

m a = springs k (l - l0) + their damping c dl/dt, along each spring - drag v - 1 N. Prints them as JSON.
"""

import json
import sys
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

sys.path.insert(0, str(Path(__file__).parents[1]))
from independent_catenary import chain, curves, divided

MASS, STIFFNESS, DAMPING, DRAG, LOAD = 1.0, 7000.0, 10.0, 1.0, 1.0
start = divided(curves(Path(__file__).parent / "model.3dm")["arc"][0], 50)
rest = 0.995 * np.linalg.norm(np.diff(start, axis=0), axis=1)


def motion(_, state):
    x, v = start.copy(), np.zeros_like(start)
    x[1:-1], v[1:-1] = state.reshape(2, -1, 3)
    along = np.diff(x, axis=0)
    length = np.linalg.norm(along, axis=1)
    along /= length[:, None]
    rate = (np.diff(v, axis=0) * along).sum(axis=1)
    pull = (STIFFNESS * (length - rest) + DAMPING * rate)[:, None] * along
    force = pull[1:] - pull[:-1] - DRAG * v[1:-1] - [0.0, 0.0, LOAD]
    return np.concatenate([v[1:-1].ravel(), (force / MASS).ravel()])


times = [4, 8, 12, 16, 20]
begin = np.concatenate([start[1:-1].ravel(), np.zeros(3 * 49)])
solved = solve_ivp(motion, (0.0, 20.0), begin, "DOP853", t_eval=times, rtol=1e-8, atol=1e-8)
x, _ = chain(start[0], start[-1], rest, STIFFNESS, LOAD)
numbers = {f"height of the middle after {t} s": z for t, z in zip(times, solved.y[3 * 24 + 2], strict=True)}
numbers["equilibrium: height of the middle"] = x[25, 2]
numbers["equilibrium: length"] = np.linalg.norm(np.diff(x, axis=0), axis=1).sum()
print(json.dumps(numbers))
