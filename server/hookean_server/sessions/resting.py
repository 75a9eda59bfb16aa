"""A session on its way to rest: a relaxation with the scene's own solver, as `Simulation.relax`, beside the session.

It works on a state of its own, on a thread of its own: one step of a large scene takes longer than the session may be
silent, and kernels let other threads run. The session shows the shapes on the way.
"""

from __future__ import annotations

import logging
import threading
from copy import copy

import numpy as np

from hookean.errors import InputError
from hookean.running.result import Result, Status
from hookean.running.run import relax_state
from hookean.running.simulation import Simulation
from hookean.solvers import solver

log = logging.getLogger("hookean.session")


class Resting(threading.Thread):
    """A relaxation from the present shape of a simulation. It starts when `before`, an earlier one, has ended."""

    def __init__(self, simulation: Simulation, before: Resting | None) -> None:
        super().__init__(name="hookean-resting", daemon=True)
        self._system = copy(simulation.system)  # patches give the simulation's own other forces and anchors
        self._solver = solver(simulation.scene.settings.solver)
        if refusal := self._solver.refuse(self._system):
            raise InputError("/settings/solver", refusal)
        self._state = simulation.state.copy()
        self._latest = simulation.state
        self._before = before
        self._left = threading.Event()
        self._result: Result | None = None
        self._fault = ""

    def run(self) -> None:
        """Relax until the end or until it is left."""
        if self._before is not None:
            self._before.join()
            self._before = None
        try:
            self._result = relax_state(self._system, self._state, self._solver, self._note, self._left.is_set)
        except MemoryError:
            self._fault = "This needs more memory than one session may use."
        except Exception:
            if not self._left.is_set():  # patches may write into what it still reads
                log.exception("relaxing failed")
            self._fault = "The solver failed on this scene; the log has the details."

    def leave(self, simulation: Simulation) -> None:
        """End it at the next opportunity; the simulation goes on from the last shape on the way."""
        self.show(simulation)
        self._left.set()

    def show(self, simulation: Simulation) -> bool:
        """Give the simulation the last shape on the way; whether there was another one."""
        latest = self._latest
        if latest is simulation.state:
            return False
        simulation.arrive(latest)
        return True

    def finish(self, simulation: Simulation) -> bool:
        """Give the simulation the shape at the end and the message on it, if that is reached; whether it is."""
        if self.is_alive():
            return False
        if self._result is None:
            simulation.arrive(self._latest, Status.STALLED, self._fault)
        else:
            simulation.arrive(self._state, self._result.status, self._result.message)
        return True

    def _note(self, iteration: int, residual: float) -> None:
        """Keep a shape on the way; the velocity of a solver without physical time is left out."""
        state = self._state
        if not (np.isfinite(state.x).all() and np.isfinite(state.v).all()):
            return
        shape = state.copy()
        shape.scratch.clear()
        if not self._solver.physical:
            shape.v[:] = 0.0
        self._latest = shape
