"""Numbers of figures 9.17 to 9.20: chains by statics from the curves of model.3dm. Prints them as JSON."""

import json
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))
from independent_catenary import chain, curves, divided, parameter

drawn = curves(Path(__file__).parent / "model.3dm")
numbers = {}
for name, stiffness, rest in (
    ("line", 75.0, None),
    ("arc", 7000.0, None),
    ("wide arc", 7000.0, None),
    ("arc, rest by arc length", 7000.0, 0.995 * 0.4),
    ("wide arc, rest by arc length", 7000.0, 0.995 * 0.4),
):
    points = divided(drawn[name.partition(",")[0]][0], 50)
    pieces = np.linalg.norm(np.diff(points, axis=0), axis=1)
    by_chord = pieces * (1.0 if name == "line" else 0.995)
    x, _ = chain(points[0], points[-1], by_chord if rest is None else np.full(50, rest), stiffness, 1.0)
    lengths = np.linalg.norm(np.diff(x, axis=0), axis=1)
    span = x[-1, 0] - x[0, 0]
    a = parameter(span, lengths.sum() if name == "line" else 20.0)
    height = a * np.cosh((x[:, 0] - x[0, 0] - span / 2) / a) - a * np.cosh(span / 2 / a)
    numbers[f"{name}: length"] = lengths.sum()
    numbers[f"{name}: sag"] = -x[:, 2].min()
    numbers[f"{name}: off the catenary"] = np.abs(x[:, 2] - height).max()
    if name == "arc":
        numbers["arc: shortest segment"] = lengths.min()
        numbers["arc: longest segment"] = lengths.max()
print(json.dumps(numbers))
