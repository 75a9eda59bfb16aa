"""Numbers of figure 9.10: the independent solver, and a cubic spline over the lengths of the chords whose speed is
integrated. Prints them as JSON by the names of expected.json."""

import json
import sys
from itertools import pairwise
from pathlib import Path

import numpy as np
from scipy.integrate import quad
from scipy.interpolate import CubicSpline
from scipy.optimize import minimize_scalar

sys.path.insert(0, str(Path(__file__).parents[1]))
from independent import springs

start = np.array([[2.5 * i, 0.0, 0.0] for i in range(5)])
pairs = np.array([[i, i + 1] for i in range(4)])
x = springs(start, pairs, 200.0, 2.5, [0.0, 0.0, -40.0], held=[0, 4])
chords = np.linalg.norm(np.diff(x, axis=0), axis=1)
reach = np.concatenate([[0.0], np.cumsum(chords)])
curve = CubicSpline(reach, x)
speed = curve.derivative()


def off(s):
    i = min(np.searchsorted(reach, s, side="right") - 1, 3)
    return np.linalg.norm(np.cross(curve(s) - x[i], x[i + 1] - x[i])) / chords[i]


apart = [
    -minimize_scalar(lambda s: -off(s), bounds=(a, b), method="bounded", options={"xatol": 1e-10}).fun
    for a, b in pairwise(reach)
]
first, second = (np.arctan2(d[2], d[0]) for d in np.diff(x[1:4], axis=0))
print(
    json.dumps(
        {
            "largest distance of the curve from the cable": max(apart),
            "length of the cable": chords.sum(),
            "length of the curve": sum(
                quad(lambda s: np.linalg.norm(speed(s)), a, b, epsabs=1e-12)[0] for a, b in pairwise(reach)
            ),
            "turn of the cable at B": np.degrees(second - first),
        }
    )
)
