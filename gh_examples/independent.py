"""An equilibrium solver that shares nothing with hookean, for the numbers of the examples.

Springs of Hooke's law by Newton's method on their energy, E = sum k (l - l0)^2 / 2 - loads x. Only numpy and scipy.
The scripts beside the examples use it; it is short so that it can be checked by reading.
"""

import numpy as np
import scipy.sparse as sparse
from scipy.sparse.linalg import spsolve


def springs(points, pairs, stiffness, rest, loads, held, tolerance=1e-12, slack=False):
    """Positions (n, 3) in equilibrium: springs `pairs` (m, 2) of stiffness and rest length (m,), loads (n, 3), `held`
    particles fixed where they are. With `slack` springs do not push. Tolerance is relative to the mean load or force.
    """
    x = np.array(points, dtype=float)
    pairs = np.asarray(pairs)
    k = np.broadcast_to(np.asarray(stiffness, float), len(pairs))
    rest = np.broadcast_to(np.asarray(rest, float), len(pairs))
    loads = np.broadcast_to(np.asarray(loads, float), x.shape)
    free = np.setdiff1d(np.arange(len(x)), held)
    columns = (3 * free[:, None] + np.arange(3)).ravel()

    def energy(at):
        stretch = _lengths(at, pairs) - rest
        if slack:
            stretch = np.maximum(stretch, 0.0)
        return 0.5 * (k * stretch**2).sum() - (loads * at).sum()

    push = 1e-3
    for _ in range(2000):
        gradient, hessian = _derivatives(x, pairs, k, rest, loads, slack)
        g = gradient.ravel()[columns]
        scale = np.linalg.norm(loads[free], axis=1).mean() or (k * np.abs(_lengths(x, pairs) - rest)).mean()
        if np.abs(g).max() <= tolerance * scale:
            return x
        matrix = hessian[columns][:, columns].tocsc()
        size = abs(matrix.diagonal()).max()
        step = np.zeros_like(x)
        step.ravel()[columns] = -spsolve(matrix + push * size * sparse.eye(len(columns), format="csc"), g)
        now = energy(x)
        if energy(x + step) <= now + 1e-14 * abs(now):
            x, push = x + step, push / 10 if push > 1e-14 else 0.0
        else:
            push = max(10 * push, 1e-12)
    raise RuntimeError("no equilibrium found")


def _lengths(x, pairs):
    return np.linalg.norm(x[pairs[:, 1]] - x[pairs[:, 0]], axis=1)


def _derivatives(x, pairs, k, rest, loads, slack):
    d = x[pairs[:, 1]] - x[pairs[:, 0]]
    length = np.linalg.norm(d, axis=1)
    on = (length > rest) if slack else np.ones(len(d), bool)
    n = d / np.maximum(length, 1e-300)[:, None]
    force = np.where(on, k * (length - rest), 0.0)
    gradient = -loads.copy()
    np.add.at(gradient, pairs[:, 0], -force[:, None] * n)
    np.add.at(gradient, pairs[:, 1], force[:, None] * n)
    outer = n[:, :, None] * n[:, None, :]
    across = np.where(length > 0, force / np.maximum(length, 1e-300), k)
    block = np.where(on, k, 0.0)[:, None, None] * outer + across[:, None, None] * (np.eye(3) - outer)
    rows, columns, values = [], [], []
    for a, b, sign in ((0, 0, 1), (1, 1, 1), (0, 1, -1), (1, 0, -1)):
        i = 3 * pairs[:, a, None, None] + np.arange(3)[None, :, None]
        j = 3 * pairs[:, b, None, None] + np.arange(3)[None, None, :]
        rows.append(np.broadcast_to(i, block.shape).ravel())
        columns.append(np.broadcast_to(j, block.shape).ravel())
        values.append((sign * block).ravel())
    shape = (3 * len(x), 3 * len(x))
    ij = (np.concatenate(rows), np.concatenate(columns))
    return gradient, sparse.csr_matrix((np.concatenate(values), ij), shape=shape)
