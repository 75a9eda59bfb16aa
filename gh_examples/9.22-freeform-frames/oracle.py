"""Numbers of figure 9.22: every chain by statics from model.3dm, and its catenary by bisection. Prints them as JSON."""

import json
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))
from independent_catenary import catenary, chain, curves, divided

LINKS, FACTOR, STIFFNESS = 24, 1.2, 1e6
drawn = curves(Path(__file__).parent / "model.3dm")
ends = np.array(
    [[[p.X, p.Y, p.Z] for p in (line.PointAtStart, line.PointAtEnd)] for line in drawn["chains"]]
)  # (chain, end, 3)
parts = np.stack([divided(frame, len(ends))[:-1] for frame in drawn["frames"]], axis=1)

lengths, sags, forces, off = [], [], [], []
for start, end in ends:
    length = FACTOR * np.linalg.norm(end - start)
    x, tension = chain(start, end, np.full(LINKS, length / LINKS), STIFFNESS, 1.0)
    lengths.append(np.linalg.norm(np.diff(x, axis=0), axis=1).sum())
    sags.append((np.linspace(start, end, LINKS + 1) - x)[:, 2].max())
    forces.append(tension.max())
    off.append(np.linalg.norm(x - catenary(start, end, length, LINKS), axis=1).max())
print(
    json.dumps(
        {
            "chains": len(ends),
            "ends off equal parts of the frames": np.linalg.norm(ends - parts, axis=2).max(),
            "total length": sum(lengths),
            "shortest chain": min(lengths),
            "longest chain": max(lengths),
            "largest sag": max(sags),
            "largest force": max(forces),
            "chains off the catenaries": max(off),
        }
    )
)
