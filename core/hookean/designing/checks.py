"""A design problem checked as far as is possible without solving: names, bounds, targets and limits, at the drawn
shape."""

from __future__ import annotations

from typing import Any

from hookean.designing.equilibrium import Equilibrium
from hookean.designing.problem import Problem
from hookean.designing.search import Floats, Search, chosen


class _Drawn(Search):
    """A search whose only shape is the drawn one."""

    def at(self, y: Floats) -> Equilibrium:
        self.unknowns.put(self.system, self.state, self.unknowns.start)
        return Equilibrium(self.system, self.state, None, self.orders)


def checked(problem: Any) -> Search:
    """The search of a problem, not begun. Raises InputError with a pointer where the problem does not fit its scene."""
    search = _Drawn(Problem.read(problem))
    chosen(search)
    return search
