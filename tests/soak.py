"""Whether this is `make soak`: tests marked `soak` run, and counts are in full."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import Any

import pytest

SOAK = os.environ.get("HOOKEAN_SOAK") == "1"


def sampled(values: Iterable[Any], every: int) -> list[Any]:
    """Values of a parametrized test: the first of each `every` in all runs, the others in `make soak` only."""
    return [pytest.param(v, marks=[pytest.mark.soak] if i % every else []) for i, v in enumerate(values)]


THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "RAYON_NUM_THREADS", *(("NUMBA_NUM_THREADS",) if SOAK else ()))
"""Variables that set how many threads a process has. That of numba is in the names of code on disk: with another
count all of it is compiled again, and none of it is parallel."""
