"""Start-up: seconds from starting Python to the first result, with compiled kernels on disk and without."""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import tempfile
import time

FIRST = """
import time; begun = time.perf_counter()
import hookean
from hookean.run import relax
from hookean.scene import Scene
imported = time.perf_counter()
lines = [[[2 * i, 0, 0], [2 * i + 2, 0, 0]] for i in range(5)]
scene = Scene.read({"forces": [{"kind": "springs", "lines": lines}, {"kind": "self_weight", "total": 120}],
                    "anchors": [{"points": [[0, 0, 0], [10, 0, 0]]}]})
assert relax(scene).converged
first = time.perf_counter()
assert relax(scene).converged
print(imported - begun, first - imported, time.perf_counter() - first)
"""


def startup(repeats: int = 3) -> list[tuple[str, list[float]]]:
    """Rows of (what, [import, first solve, second solve, whole process]) in seconds: cold once, warm medians."""
    with tempfile.TemporaryDirectory() as cache:
        cold = _process(cache)
        warm = [_process(cache) for _ in range(repeats)]
    medians = [statistics.median(row[i] for row in warm) for i in range(4)]
    return [("nothing compiled yet", cold), ("compiled kernels on disk", medians)]


def _process(cache: str) -> list[float]:
    begun = time.perf_counter()
    done = subprocess.run(
        [sys.executable, "-c", FIRST], env={**os.environ, "HOOKEAN_CACHE": cache},
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    return [*(float(word) for word in done.stdout.split()), time.perf_counter() - begun]
