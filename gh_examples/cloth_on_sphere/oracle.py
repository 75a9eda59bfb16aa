"""A cloth on a ball by least energy: threads, diagonals, bending, weight and contact, minimised by scipy's L-BFGS-B
over the places of all vertices, without a solver for equilibrium.

Prints JSON by the names of expected.json.
"""

import json

import numpy as np
from scipy.optimize import minimize

N, SIDE, RADIUS, THICK = 16, 2.4, 0.8, 0.001  # -, m, m, m
WEIGHT, THREAD, SHEAR, BENDING, CONTACT = 4.0, 2000.0, 100.0, 0.005, 5000.0  # N/m2, N/m, N/m, N m2, N/m

H = SIDE / N
number = np.arange((N + 1) ** 2).reshape(N + 1, N + 1)
along = [np.stack([number[:-1], number[1:]], 2), np.stack([number[:, :-1], number[:, 1:]], 2)]
across = [np.stack([number[:-1, :-1], number[1:, 1:]], 2), np.stack([number[1:, :-1], number[:-1, 1:]], 2)]
threads, diagonals = (np.concatenate([part.reshape(-1, 2) for part in parts]) for parts in (along, across))
pairs = np.concatenate([threads, diagonals])
stiff = np.repeat([THREAD, SHEAR], [len(threads), len(diagonals)])
rest = np.repeat([H, H * np.sqrt(2.0)], [len(threads), len(diagonals)])
down, over = [number[:-2], number[1:-1], number[2:]], [number[:, :-2], number[:, 1:-1], number[:, 2:]]
a, b, c = np.concatenate([np.stack(part, 2).reshape(-1, 3) for part in (down, over)]).T
half = np.r_[0.5, np.ones(N - 1), 0.5]
load = WEIGHT * H * H * np.outer(half, half).ravel()
middle = number[N // 2, N // 2]


def energy(flat):
    """Energy [J] and its gradient [N]; the middle may only move up and down."""
    x = flat.reshape(-1, 3)
    g = np.zeros_like(x)
    d = x[pairs[:, 1]] - x[pairs[:, 0]]
    size = np.linalg.norm(d, axis=1)
    total = 0.5 * (stiff * (size - rest) ** 2).sum()
    pull = (stiff * (1.0 - rest / size))[:, None] * d
    np.add.at(g, pairs[:, 1], pull)
    np.add.at(g, pairs[:, 0], -pull)
    u, v = x[b] - x[a], x[c] - x[b]
    lu, lv = np.linalg.norm(u, axis=1), np.linalg.norm(v, axis=1)
    e, f = u / lu[:, None], v / lv[:, None]
    cosine = (e * f).sum(axis=1)
    turn = np.arctan2(np.linalg.norm(np.cross(e, f), axis=1), cosine)
    total += 0.5 * BENDING / H * (turn**2).sum()
    slope = -BENDING / H / np.sinc(turn / np.pi)  # of the energy by the cosine
    gu = (slope / lu)[:, None] * (f - cosine[:, None] * e)
    gv = (slope / lv)[:, None] * (e - cosine[:, None] * f)
    np.add.at(g, a, -gu)
    np.add.at(g, b, gu - gv)
    np.add.at(g, c, gv)
    out = np.linalg.norm(x, axis=1)
    depth = np.maximum(RADIUS + THICK - out, 0.0)
    total += 0.5 * CONTACT * (depth**2).sum() + load @ x[:, 2]
    g -= (CONTACT * depth / out)[:, None] * x
    g[:, 2] += load
    g[middle, :2] = 0.0
    return total, g.ravel()


place = np.linspace(-0.5 * SIDE, 0.5 * SIDE, N + 1)
start = np.stack([*np.meshgrid(place, place, indexing="ij"), np.full((N + 1, N + 1), RADIUS + THICK)], 2)
options = {"maxiter": 20000, "maxfun": 40000, "maxcor": 30, "ftol": 0.0, "gtol": 1e-6}
found = minimize(energy, start.ravel(), jac=True, method="L-BFGS-B", options=options)
x = found.x.reshape(-1, 3)
top = RADIUS + THICK
print(
    json.dumps(
        {
            "depth of a corner under the top": top - x[number[0, 0], 2],
            "depth of the middle of an edge under the top": top - x[number[0, N // 2], 2],
            "width of the cloth, corner to corner": np.linalg.norm(x[number[0, 0]] - x[number[-1, -1]]),
            "energy of weight, threads, bending and contact": found.fun,
        }
    )
)
