"""All solvers, each a file here with a class `Method`, named after the file."""

from __future__ import annotations

import importlib

from hookean.solvers.base import Solver


def solver(name: str) -> Solver:
    """A fresh solver by its name."""
    found = importlib.import_module(f"{__name__}.{name}").Method()
    assert isinstance(found, Solver)
    return found


__all__ = ["Solver", "solver"]
