"""Numbers of figure 9.16: catenaries by bisection, chains by statics. Prints them as JSON by the names there."""

import json
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))
from independent_catenary import catenary, chain, heights_at_ends, parameter, plane

FILES = {
    "rising": "scene.json",
    "level": "scene-level.json",
    "nearly taut": "scene-taut.json",
    "very slack": "scene-slack.json",
    "gravity aslant": "scene-aslant.json",
    "gravity sideways": "scene-sideways.json",
}
numbers = {}
for name, file in FILES.items():
    scene = json.loads((Path(__file__).parent / file).read_text())
    springs, weight = scene["forces"][:2]
    rest = np.full(len(springs["particles"]), springs["rest_length"])
    start, end = np.array(scene["particles"])[[0, -1]]
    gravity = weight["vector"]
    _, _, span, rise = plane(start, end, gravity)
    at_a, at_b = heights_at_ends(span, rest.sum(), rise)
    a = parameter(span, rest.sum(), rise)
    x, _ = chain(start, end, rest, springs["stiffness"], np.linalg.norm(gravity), gravity)
    drawn = catenary(start, end, rest.sum(), len(rest), gravity)
    numbers[f"{name}: a"] = a
    numbers[f"{name}: depth below A"] = at_a - a
    numbers[f"{name}: largest tension"] = max(at_a, at_b)
    numbers[f"{name}: chain off the catenary"] = np.linalg.norm(x - drawn, axis=1).max()
print(json.dumps(numbers))
