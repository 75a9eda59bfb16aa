"""All solvers, each a file here with a class `Method`, named after the file."""

from __future__ import annotations

import importlib
from functools import cache

from hookean.solvers.base import Solver


def solver(name: str) -> Solver:
    """A fresh solver by its name."""
    return _method(name)()


@cache
def _method(name: str) -> type[Solver]:
    found: type[Solver] = importlib.import_module(f"{__name__}.{name}").Method
    assert issubclass(found, Solver)
    return found


__all__ = ["Solver", "solver"]
