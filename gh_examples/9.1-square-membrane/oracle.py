"""Numbers of figure 9.1 from the independent solver. Prints them as JSON by the names of expected.json."""

import json
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))
from independent import springs

number = np.arange(81).reshape(9, 9)
start = np.array([[i, j, 0.0] for i in range(9) for j in range(9)])
pairs = np.concatenate(
    [
        np.stack([number[:, :-1].ravel(), number[:, 1:].ravel()], axis=1),
        np.stack([number[:-1].ravel(), number[1:].ravel()], axis=1),
    ]
)
x = springs(start, pairs, 1000.0, 1.0, [0.0, 0.0, -5.0], held=[0, 8, 72, 80])
force = 1000.0 * (np.linalg.norm(x[pairs[:, 1]] - x[pairs[:, 0]], axis=1) - 1.0)
print(
    json.dumps(
        {
            "sag in the middle": -x[40, 2],
            "sag of an edge": -x[4, 2],
            "largest force in a spring": force.max(),
            "least force in a spring": force.min(),
        }
    )
)
