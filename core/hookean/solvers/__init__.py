"""All solvers, found by walking this folder: a file here named after its solver has a class `Method`."""

from __future__ import annotations

import importlib
import pkgutil

from hookean.solvers.base import Solver

NAMES: tuple[str, ...] = (
    "auto",
    *(m.name for m in pkgutil.iter_modules(__path__) if m.name not in ("auto", "base") and m.name[0] != "_"),
)
"""What `settings.solver` may be."""


def solver(name: str) -> Solver:
    """A fresh solver by its name."""
    found = importlib.import_module(f"{__name__}.{name}").Method()
    assert isinstance(found, Solver)
    return found


__all__ = ["NAMES", "Solver", "solver"]
