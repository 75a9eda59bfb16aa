"""What a solver is: how to prepare a state, and how to advance it. The loop around it is in running/run.py."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from numpy.typing import NDArray

from hookean.stability.limit import Limit

if TYPE_CHECKING:
    from hookean.linear.pattern import Pattern
    from hookean.linear.tangent import Tangent
    from hookean.solvers.force_density import Solved
    from hookean.system.balance import Balance
    from hookean.system.state import State
    from hookean.system.system import System

Floats = NDArray[np.float64]


class Solver(ABC):
    """One way to equilibrium, or through time. Everything it remembers is in `state.scratch`."""

    name: ClassVar[str]
    longest: ClassVar[int] = 10**9  # iterations in one call, so that a run can be cancelled in between
    together: ClassVar[int] = 0  # iterations that one call does where other calls give other numbers; 0: none do
    anew: int = 0  # iteration at which it last went back to the start of the run, to try another way
    remark: str = ""  # a sentence on the shape it found, where there is more to say than that it is at rest
    work: float = 0.0  # passes over all springs since its start; 0: one an iteration
    certain: bool = False  # whether it knows that the tangent of the shape it came to is positive definite
    tangent: Tangent | None = None  # what it solves with by multigrid, if it does
    pattern: Pattern | None = None  # of the tangent that it solves with by factors, if it does
    solved: Sequence[Solved] = ()  # what it solved a linear net with, for each set of axes
    leaves: ClassVar[bool] = False  # a run goes on from an unstable equilibrium, along the mode in which energy falls
    refines: ClassVar[bool] = False  # and while the shape is not known to the scene's position tolerance
    physical: ClassVar[bool] = False  # advances physical time with the scene's masses, damping and drag
    limit: ClassVar[Limit] = Limit()  # of its time steps, where it is physical

    def parts(self, system: System, state: State) -> int:
        """In how many parts a time step is divided."""
        return 1

    def covers(self, system: System, state: State) -> float:
        """The time [time] that an iteration takes, where time is physical."""
        return system.scene.settings.time_step

    def refuse(self, system: System) -> str:
        """Why this solver cannot take the system, as a sentence; empty if it can."""
        return ""

    def start(self, system: System, state: State) -> None:
        """Prepare `state.scratch`; called at the first step and after every patch."""
        state.scratch.clear()

    def depart(self, system: System, state: State) -> None:
        """Start again from beside an unstable equilibrium that it came to."""
        self.start(system, state)

    def correction(self, system: System, state: State, found: Balance) -> Floats | None:
        """The movement (n, 3) [length] that one more exact step would make from the shape that it came to, by what is
        in factors already; None where nothing is. `found` is what is out of balance there."""
        return None

    def sharpen(self, state: State) -> None:  # noqa: B027
        """Prepare for a tighter tolerance, from a shape that meets the last one."""

    @abstractmethod
    def advance(self, system: System, state: State, count: int, goal: float) -> int:
        """Advance by at most `count` iterations, in place; stop early when no free particle is out of balance by
        more than `goal` [force]. Returns the iterations done."""
