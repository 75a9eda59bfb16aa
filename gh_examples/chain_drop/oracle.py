"""A falling chain by an integrator of order 8 with steps of its own length (Dormand and Prince), from the shape at rest
that bisection finds link by link.

Prints JSON by the names of expected.json.
"""

import json

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

LENGTH, APART, LINKS, K, G = 10.0, 1.2, 40, 4e5, 9.81  # m, m, -, N/m, m/s2; 1 kg on each particle

size = LENGTH / LINKS
up = G * (np.arange(LINKS) - 0.5 * (LINKS - 1))


def links(pull):
    """Vectors (2, LINKS) [m] of a chain at rest with this horizontal pull [N]."""
    tension = np.hypot(pull, up)
    return (size + tension / K) / tension * np.array([np.full(LINKS, pull), up])


at_rest = np.zeros((2, LINKS + 1))
at_rest[:, 1:] = np.cumsum(links(brentq(lambda pull: links(pull)[0].sum() - APART, 1e-6, 500.0, xtol=1e-15)), axis=1)


def motion(_, state):
    """Velocities and accelerations; the first particle is held."""
    x, v = state.reshape(2, 2, LINKS + 1)
    along = np.diff(x, axis=1)
    now = np.sqrt(along[0] ** 2 + along[1] ** 2)
    force = K * (1.0 - size / now) * along
    pulled = np.zeros_like(x)
    pulled[:, :-1] += force
    pulled[:, 1:] -= force
    pulled[1] -= G
    pulled[:, 0] = 0.0
    return np.concatenate([v.ravel(), pulled.ravel()])


times = (0.3, 0.6, 0.9, 1.1, 1.2)
start = np.concatenate([at_rest.ravel(), np.zeros(at_rest.size)])
found = solve_ivp(motion, (0.0, 1.2), start, "DOP853", times, rtol=1e-10, atol=1e-12).y.reshape(2, 2, LINKS + 1, -1)
numbers = {f"depth of the free end at {time:g} s": -found[0, 1, -1, i] for i, time in enumerate(times) if time != 1.1}
numbers["ahead of a stone at 1.2 s"] = -found[0, 1, -1, -1] - 0.5 * G * 1.2**2
numbers["speed of the free end at 1.1 s"] = -found[1, 1, -1, 3]
print(json.dumps(numbers))
