"""Numbers of figure 9.9 from the independent solver. Prints them as JSON by the names of expected.json."""

import json
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))
from independent import springs


def cable(held):
    start = np.array([[float(i), 0.0, 0.0] for i in range(11)])
    pairs = np.array([[i, i + 1] for i in range(10)])
    return springs(start, pairs, 1000.0, 1.0, [0.0, 0.0, -10.0], held=held)


two, three = cable([0, 10]), cable([0, 4, 10])
print(
    json.dumps(
        {
            "sag with two anchors": -two[:, 2].min(),
            "sag of the left part": -three[:5, 2].min(),
            "sag of the right part": -three[4:, 2].min(),
            "sag with an anchor between particles": -two[:, 2].min(),
        }
    )
)
