"""Settling times of figure 9.13 from the solution of m u'' + c u' + k u = 0, u(0) = -50 cm, frame by frame.

Prints them as JSON by the names of expected.json.
"""

import json

import numpy as np
from scipy.linalg import expm

stiffness = 2.0
found = {}
for damping, frame in ((1.0, 0.05), (10.0, 0.2), (100.0, 0.8)):
    onward = expm(frame * np.array([[0.0, 1.0], [-stiffness, -damping]]))
    state, last = np.array([-50.0, 0.0]), 0.0
    for step in range(501):
        if abs(state[0]) > 0.5:
            last = step * frame
        state = onward @ state
    found[f"time to settle, damping {damping:g} N s/cm"] = last
print(json.dumps(found))
