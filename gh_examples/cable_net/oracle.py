"""A cable net without hookean: its form by a dense force-density solve (Schek, 1974), and its shape under snow by
Newton's method with exact tangents.

Prints JSON by the names of expected.json.
"""

import json

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import spsolve

N, SIDE, RISE = 12, 12.0, 4.0  # meshes a side, m, m
DENSITY, STEEL, SNOW = (10.0, 150.0), (10_000.0, 300_000.0), 0.6  # kN/m and kN of net and edges, kN/m2

number = np.arange((N + 1) ** 2).reshape(N + 1, N + 1)
i, j = np.divmod(number.ravel(), N + 1)
u, v = i / N, j / N
drawn = np.column_stack([SIDE * u, SIDE * v, RISE * (u * v + (1 - u) * (1 - v))])
along, across = np.stack([number[:-1], number[1:]], axis=2), np.stack([number[:, :-1], number[:, 1:]], axis=2)
rim = np.concatenate([along[:, 0], along[:, -1], across[0], across[-1]])
net = np.concatenate([along[:, 1:-1].reshape(-1, 2), across[1:-1].reshape(-1, 2)])
pairs = np.concatenate([net, rim])
q = np.repeat(DENSITY, (len(net), len(rim)))
steel = np.repeat(STEEL, (len(net), len(rim)))
held = number[[0, 0, -1, -1], [0, -1, 0, -1]]
free = np.setdiff1d(number.ravel(), held)
sign = np.zeros((len(pairs), number.size))
sign[np.arange(len(pairs)), pairs[:, 0]], sign[np.arange(len(pairs)), pairs[:, 1]] = 1.0, -1.0

whole = sign.T @ (q[:, None] * sign)
form = drawn.copy()
form[free] = np.linalg.solve(whole[np.ix_(free, free)], -whole[np.ix_(free, held)] @ drawn[held])
length = np.linalg.norm(sign @ form, axis=1)
tension = q * length
cut = length / (1.0 + tension / steel)

a, b, c, d = number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]
e, f = (form[c] - form[a])[..., :2], (form[d] - form[b])[..., :2]
area = 0.5 * np.abs(e[..., 0] * f[..., 1] - e[..., 1] * f[..., 0])
load = np.zeros_like(form)
for corner in (a, b, c, d):
    np.add.at(load[:, 2], corner, -0.25 * SNOW * area)

x = form.copy()
dofs = (3 * free[:, None] + np.arange(3)).ravel()
ends = sparse.csc_matrix(np.kron(sign, np.eye(3))[:, dofs])
for _ in range(20):
    line = sign @ x
    now = np.linalg.norm(line, axis=1)
    t = steel * (now / cut - 1.0)
    residual = load - sign.T @ (t / now * line.T).T
    unit = line / now[:, None]
    block = (steel / cut - t / now)[:, None, None] * unit[:, :, None] * unit[:, None, :]
    block += (t / now)[:, None, None] * np.eye(3)
    step = spsolve(ends.T @ sparse.block_diag(block) @ ends, residual.ravel()[dofs])
    step *= min(1.0, 0.2 / np.abs(step).max())  # m: no further at once
    x.ravel()[dofs] += step
middle = number.size // 2
print(
    json.dumps(
        {
            "form: height of the middle": form[middle, 2],
            "form: sag of an edge in plan": form[number[0, N // 2], 0],
            "form: largest force in an edge": tension[len(net) :].max(),
            "form: largest force in the net": tension[: len(net)].max(),
            "snow: middle goes down by": form[middle, 2] - x[middle, 2],
            "snow: largest force in an edge": t[len(net) :].max(),
            "snow: largest force in the net": t[: len(net)].max(),
            "snow: least force in the net": t[: len(net)].min(),
        }
    )
)
