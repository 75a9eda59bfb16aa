"""Numbers of figure 9.11 from the independent solver. Prints them as JSON by the names of expected.json."""

import json
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))
from independent import springs

start = np.array([[2.0 * i, 0.0, 0.0] for i in range(6)])
pairs = np.array([[i, i + 1] for i in range(5)])
x = springs(start, pairs, 1000.0, 2.0, [0.0, 0.0, -20.0], held=[0, 5])
longer = np.linalg.norm(np.diff(x, axis=0), axis=1) - 2.0
print(json.dumps({f"extension of spring {i}": longer[i - 1] for i in (1, 2, 3)}))
