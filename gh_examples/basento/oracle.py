"""Numbers of the Basento study from the drawing alone: one linear solve, and the balance of the reversed forces."""

import json
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))
import independent_net as net

MODEL, U, V = Path(__file__).parent / "model.3dm", 32, 8

start = net.grid(net.objects(MODEL, "skin")[0], U, V).reshape(-1, 3)
edges, rim = net.pairs(U, V)
feet, fingers = (net.nearest(start, net.points(MODEL, layer)) for layer in ("feet", "fingers"))
held = np.concatenate([feet, fingers])
density = np.where(rim, 300.0, 100.0)  # kN/m: the skin's 100, and 200 of the edge cables
x = net.force_density(start, edges, density, held)

length = np.linalg.norm(x[edges[:, 1]] - x[edges[:, 0]], axis=1)
force = density * length
cables = np.concatenate([100.0 * length, 200.0 * length[rim]])  # on the rim a cable lies beside the skin's own
pushed = net.pull(x, edges, -force)  # every member turned round
up = -pushed[:, 2]  # what it takes to hold the points then
middle = x[np.abs(x[:, 1]) < 1e-6]
print(
    json.dumps(
        {
            "least tension": cables.min(),
            "greatest tension": cables.max(),
            "least compression": cables.min(),
            "greatest compression": cables.max(),
            "deck carried": -up[fingers].sum(),
            "feet push up": up[feet].sum(),
            "force times length, in tension": (force * length).sum(),
            "area of the skin": net.area(x.reshape(U + 1, V + 1, 3)),
            "height over the pier": middle[np.abs(middle[:, 0]).argmin(), 2],
            "lowest height on the middle line": middle[:, 2].min(),
        }
    )
)
