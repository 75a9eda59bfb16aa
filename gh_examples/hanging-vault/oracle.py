"""Numbers of the hanging chain and net without hookean: one equation for the chain, Newton's method for the net."""

import json
import sys
from pathlib import Path

import numpy as np
from scipy.optimize import brentq

sys.path.insert(0, str(Path(__file__).parents[1]))
import independent_net as net
from independent import springs

# The chain: 32 links of 0.6 m and 1e7 kN/m, 1.8 kN on each of the 31 joints. By symmetry the vertical force in link i
# is V_i = 1.8 (i - 15.5), the horizontal one H in all; a link of tension T = sqrt(H^2 + V^2) is 0.6 + T / k long.
vertical = 1.8 * (np.arange(32) - 15.5)


def tension(pull):
    return np.hypot(pull, vertical)


def span(pull):
    return ((0.6 + tension(pull) / 1e7) * pull / tension(pull)).sum()


pull = brentq(lambda h: span(h) - 16.0, 1.0, 1000.0, xtol=1e-14, rtol=1e-15)
sag = ((0.6 + tension(pull) / 1e7) * np.abs(vertical) / tension(pull)).sum() / 2

# The net: strings of 1.1 times the grid, 10000 kN/m; weight by the length drawn. Where no string is slack, the shape is
# the minimum of a convex energy, and the only one.
model, u, v = Path(__file__).parent / "model.3dm", 20, 14
grid = net.grid(net.objects(model, "net")[0], u, v).reshape(-1, 3)
edges, _ = net.pairs(u, v)
columns = net.nearest(grid, net.points(model, "columns"))
drawn = np.linalg.norm(grid[edges[:, 1]] - grid[edges[:, 0]], axis=1)
loads = np.zeros_like(grid)
np.add.at(loads[:, 2], edges.ravel(), np.repeat(-0.25 * drawn, 2))
start = grid.copy()
start[:, 2] = -3.0 * np.abs(np.sin(np.pi * grid[:, 0] / 10)) - 2.0 * np.abs(np.sin(np.pi * grid[:, 1] / 7))
start[columns] = grid[columns]
x = springs(start, edges, 1e4, 1.1 * drawn, loads, columns, tolerance=1e-10, slack=True)
force = 1e4 * (np.linalg.norm(x[edges[:, 1]] - x[edges[:, 0]], axis=1) - 1.1 * drawn)
thrust = -(net.pull(x, edges, force) + loads)[columns]  # of the columns on the net; turned round, on the vault
print(
    json.dumps(
        {
            "chain: sag": sag,
            "chain: horizontal pull": pull,
            "chain: greatest tension": tension(pull).max(),
            "arch: rise": sag,
            "arch: thrust": pull,
            "arch: greatest force, tension +": -tension(pull).min(),
            "net: sag": -x[:, 2].min(),
            "net: least tension": force.min(),
            "net: greatest tension": force.max(),
            "vault: crown": -x[:, 2].min(),
            "vault: greatest force, tension +": -force.min(),
            "vault: thrust at a corner": np.hypot(*thrust[0, :2]),
        }
    )
)
