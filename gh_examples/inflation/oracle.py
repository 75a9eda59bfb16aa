"""A film over a square frame as heights over a grid: div(grad z / (1 + grad z^2)^1/2) = -p / T, by finite differences,
with the root of the step before. Two grids give the limit.

Prints JSON by the names of expected.json.
"""

import json

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import spsolve

HALF, PRESSURE, TENSION = 5.0, 300.0, 1000.0  # m, Pa, N/m


def rise(n):
    """Height of the middle [m] on a grid of n steps a side."""
    h = 2.0 * HALF / n
    z = np.zeros((n + 1, n + 1))
    number = -np.ones(z.shape, int)
    number[1:-1, 1:-1] = np.arange((n - 1) ** 2).reshape(n - 1, n - 1)
    for _ in range(200):
        # at the middle of an edge: the slope along it, and the mean of those across
        dx, dy = np.diff(z, axis=0) / h, np.diff(z, axis=1) / h
        across = np.zeros_like(z)
        across[:, 1:-1] = 0.5 * (dy[:, 1:] + dy[:, :-1])
        other = np.zeros_like(z)
        other[1:-1] = 0.5 * (dx[1:] + dx[:-1])
        wx = 1.0 / np.sqrt(1.0 + dx**2 + (0.5 * (across[1:] + across[:-1])) ** 2)
        wy = 1.0 / np.sqrt(1.0 + dy**2 + (0.5 * (other[:, 1:] + other[:, :-1])) ** 2)
        rows, columns, values = [], [], []
        for w, one, two in ((wx, number[:-1], number[1:]), (wy, number[:, :-1], number[:, 1:])):
            for p, q in ((one, two), (two, one)):
                inside = p >= 0
                rows.append(p[inside])
                columns.append(p[inside])
                values.append(w[inside])
                both = inside & (q >= 0)
                rows.append(p[both])
                columns.append(q[both])
                values.append(-w[both])
        parts = (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns)))
        found = spsolve(sparse.csc_matrix(parts), np.full((n - 1) ** 2, PRESSURE / TENSION * h * h))
        change = np.abs(z[1:-1, 1:-1].ravel() - found).max()
        z[1:-1, 1:-1] = found.reshape(n - 1, n - 1)
        if change < 1e-10:
            break
    return z[n // 2, n // 2]


coarse, fine = rise(24), rise(48)
print(json.dumps({"cushion: rise of the upper film, in the limit of fine meshes": (4.0 * fine - coarse) / 3.0}))
