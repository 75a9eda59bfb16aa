"""Yoshida: three velocity-Verlet steps, one of them back in time, that together have order 4.

Steps w1 dt, w0 dt, w1 dt with w1 = 1/(2 - 2^(1/3)), w0 = 1 - 2 w1. Order 4 without damping along springs.
Source: Yoshida, Phys. Lett. A 150 (1990) 262.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from hookean.solvers import verlet

if TYPE_CHECKING:
    from hookean.system import System

_OUTER = 1.0 / (2.0 - 2.0 ** (1.0 / 3.0))


class Method(verlet.Method):
    """Fourth-order symplectic steps: for long undamped motion."""

    name: ClassVar[str] = "yoshida"
    weights: ClassVar[tuple[float, ...]] = (_OUTER, 1.0 - 2.0 * _OUTER, _OUTER)

    def refuse(self, system: System) -> str:
        """A step back in time cannot bounce."""
        if system.contacts:
            return "yoshida steps back in time inside a step and cannot bounce on a floor; use verlet"
        return ""
