"""A roof of quads that become flatter, near its drawing: least squares of the distances between diagonals and of the
movements by Gauss and Newton's steps, instead of a relaxation of forces.

Prints JSON by the names of expected.json.
"""

import json

import numpy as np

N, FLAT, NEAR = 10, 1.0, 0.03  # quads a side, N/m, N/m

u, v = np.meshgrid(*2 * [np.linspace(-1.0, 1.0, N + 1)], indexing="ij")
drawn = np.stack([6.0 * u, 6.0 * v * (1.0 + 0.2 * u), 3.2 - 2.0 * u**2 - 1.2 * v**2 + 1.2 * u * v], 2).reshape(-1, 3)
number = np.arange((N + 1) ** 2).reshape(N + 1, N + 1)
a, b, c, d = (part.ravel() for part in (number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]))
rows = np.arange(len(a))


def apart(x):
    """Distances between the diagonals [m], with a side, and their slopes by all coordinates."""
    p, q, r = x[c] - x[a], x[d] - x[b], x[b] - x[a]
    n = np.cross(p, q)
    size = np.linalg.norm(n, axis=1)
    n /= size[:, None]
    s = (r * n).sum(axis=1)
    across = (r - s[:, None] * n) / size[:, None]  # slope of s by p x q
    by_p, by_q = np.cross(q, across), np.cross(across, p)
    slopes = np.zeros((len(a), len(x), 3))
    for corner, part in ((a, -by_p - n), (b, n - by_q), (c, by_p), (d, by_q)):
        slopes[rows, corner] += part
    return s, slopes.reshape(len(a), -1)


x = drawn.copy()
for _ in range(40):
    s, slopes = apart(x)
    gradient = FLAT * s @ slopes + NEAR * (x - drawn).ravel()
    x -= np.linalg.solve(FLAT * slopes.T @ slopes + NEAR * np.eye(x.size), gradient).reshape(-1, 3)
print(
    json.dumps(
        {
            "as drawn: largest distance of diagonals": np.abs(apart(drawn)[0]).max(),
            "near the drawing: largest distance of diagonals": np.abs(apart(x)[0]).max(),
            "near the drawing: largest movement": np.linalg.norm(x - drawn, axis=1).max(),
        }
    )
)
