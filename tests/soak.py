"""Whether this is `make soak`: tests marked `soak` run, and counts are in full."""

from __future__ import annotations

import inspect
import os
from collections.abc import Callable, Iterable
from functools import wraps
from typing import Any

import numpy as np

SOAK = os.environ.get("HOOKEAN_SOAK") == "1"
MUTANTS = "HOOKEAN_REACHED" in os.environ
"""Whether the code that is tested is one of `make mutants`."""


def sampled(values: Iterable[Any], every: int) -> list[Any]:
    """Values of a parametrized test: the first of each `every` in all runs, the others in `make soak` only."""
    return list(values) if SOAK else list(values)[::every]


def examples(count: int) -> int:
    """How many examples hypothesis draws: `count` in `make soak`, in `make mutants` a third of them, at least 10,
    elsewhere an eighth, at least 8."""
    least, part = (10, 3) if MUTANTS else (8, 8)
    return count if SOAK else max(least, count // part)


Test = Callable[..., None]


def seeds(count: int, soak: int | None = None, most: float = 0.15) -> Callable[[Test], Test]:
    """Run a test once for each `seed` from 0 to `count` - 1, in `make soak` to `soak` - 1. Where it takes an `amount`,
    too, these are as many from 0.01 to `most`. A failure says for which. Hypothesis takes longer to draw a number than
    most laws take, and cannot make a seed simpler."""
    number = count if soak is None or not SOAK else soak

    def decorate(test: Test) -> Test:
        signature = inspect.signature(test)

        @wraps(test)
        def run(**given: Any) -> None:
            for seed, amount in enumerate(np.linspace(0.01, most, number)):
                drawn = {"seed": seed, "amount": float(amount)}
                drawn = {name: value for name, value in drawn.items() if name in signature.parameters}
                try:
                    test(**given, **drawn)
                except AssertionError as failed:
                    failed.add_note(f"with {drawn}")
                    raise

        given = [one for name, one in signature.parameters.items() if name not in ("seed", "amount")]
        run.__signature__ = signature.replace(parameters=given)  # type: ignore[attr-defined]
        return run

    return decorate


THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "RAYON_NUM_THREADS", *(("NUMBA_NUM_THREADS",) if SOAK else ()))
"""Variables that set how many threads a process has. That of numba is in the names of code on disk: with another
count all of it is compiled again, and none of it is parallel."""
