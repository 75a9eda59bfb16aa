"""Start-up: seconds from the shell to the answer of the book's cable, with compiled kernels on disk and without."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import problems

PYTHON = "import sys, hookean; assert hookean.relax(hookean.Scene.read(open(sys.argv[1]).read())).converged"


def startup(repeats: int = 10) -> list[tuple[str, list[float]]]:
    """Seconds of whole processes, in turn; those of the first one apart, which compiles."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "cable.json"
        file.write_text(problems.scene(problems.make("cable", 50)).canonical, encoding="utf-8")
        ways = {
            "python -c 'hookean.relax(...)'": [sys.executable, "-c", PYTHON, str(file)],
            "hookean relax FILE": [sys.executable, "-m", "hookean.cli", "relax", str(file)],
        }
        cache = str(Path(folder) / "cache")
        first = [(f"{what}, nothing compiled", [_process(ways[what], cache)]) for what in list(ways)[:1]]
        found: dict[str, list[float]] = {what: [] for what in ways}
        for command in ways.values():
            _process(command, cache)
        for _ in range(repeats):
            for what, command in ways.items():
                found[what].append(_process(command, cache))
    return [*found.items(), *first]


def _process(command: list[str], cache: str) -> float:
    begun = time.perf_counter()
    subprocess.run(command, env={**os.environ, "HOOKEAN_CACHE": cache}, capture_output=True, check=True)
    return time.perf_counter() - begun
