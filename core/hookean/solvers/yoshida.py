"""Yoshida: three velocity-Verlet steps, one of them back in time, that together have order 4.

Steps w1 dt, w0 dt, w1 dt with w1 = 1/(2 - 2^(1/3)), w0 = 1 - 2 w1. Order 4 without damping along springs.
The steps of a vibration of frequency omega have a matrix of determinant 1; its trace leaves [-2, 2] at
omega dt = 1.5734, 0.7867 of the 2 of verlet. The step back in time amplifies what damping takes, so that damping limits
the step earlier, and drag does too. Source: Yoshida, Phys. Lett. A 150 (1990) 262.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from hookean.solvers import verlet
from hookean.stability.limit import Limit

if TYPE_CHECKING:
    from hookean.system.system import System

_OUTER = 1.0 / (2.0 - 2.0 ** (1.0 / 3.0))


class Method(verlet.Method):
    """Fourth-order symplectic steps: for long undamped motion."""

    name: ClassVar[str] = "yoshida"
    limit: ClassVar[Limit] = Limit(reach=0.7867, damping=0.44, drag=0.56)
    weights: ClassVar[tuple[float, ...]] = (_OUTER, 1.0 - 2.0 * _OUTER, _OUTER)

    def refuse(self, system: System) -> str:
        """A step back in time cannot bounce."""
        if system.contacts:
            return "yoshida goes back in time within a step, so it does not support floors; use verlet"
        return ""
