"""The tangent stiffness of a system, ready to be solved with at one shape after another."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from hookean.forces.base import lengths
from hookean.linear.block_cg import Steps, solve
from hookean.linear.block_hierarchy import Hierarchy
from hookean.linear.tangent_blocks import Blocks, Floats

if TYPE_CHECKING:
    from hookean.system.state import State
    from hookean.system.system import System

FIRST, LATER = 10.0, 3.0  # steps of conjugate gradients after which to gather anew, and times as many for the next time
KNOWN = 3  # steps of conjugate gradients before which nothing is concluded, where the tangent is positive definite
SLIGHT = 0.1  # of the last step, and of the energy of a movement
PUSHED = 0.05  # of all connections: else the graph of the start does as well


class Tangent:
    """Blocks, and a hierarchy over them: gathered for the start of a system, and again for the shape it has got where
    that pushes; seldom, for it takes as long as ten steps of conjugate gradients. `steps` of these were taken, and
    `work` [passes over all springs] is what all took.

    What it knows of the way is in `state.scratch` after `keep`, and one made later goes on from there.
    """

    def __init__(self, system: System, state: State) -> None:
        self.blocks = Blocks(system)
        self.blocks.fill(system, system.start())  # not the state, which depends on when this is made
        self.blocks.weigh()
        self.work = 0.0
        self.steps, self._due = state.scratch.get("gathering", np.array([0.0, FIRST]))
        self._shape = state.scratch.get("gathered")
        if self._shape is not None:
            then = state.copy()
            then.x = self._shape
            self.blocks.fill(system, then)
        self.hierarchy = self._gathered(state)
        self._filled = state.scratch.get("filled")
        self._shift, self._pulling = state.scratch.get("filling", np.zeros(2))
        if self._filled is not None:
            then = state.copy()
            then.x = self._filled
            self.blocks.fill(system, then, pulling=bool(self._pulling))
            self.blocks.settle(state, self._shift)
            self.hierarchy.fill(self.blocks.values)

    def keep(self, state: State) -> None:
        """Let the state know for which shapes the hierarchy and its values are, and when it is due again."""
        state.scratch["gathering"] = np.array([self.steps, self._due])
        state.scratch["filling"] = np.array([self._shift, self._pulling])
        for name, shape in (("gathered", self._shape), ("filled", self._filled)):
            state.scratch.pop(name, None)
            if shape is not None:
                state.scratch[name] = shape

    def take_up(self, system: System, state: State, shift: float, *, pulling: bool = False) -> bool:
        """Take up K + shift L; False if that is not positive definite. K is the tangent of the state, as if no spring
        pushed across itself where `pulling`, L the Laplacian of the tangent's graph at the start."""
        self.blocks.fill(system, state, pulling=pulling)
        if self.steps >= self._due and not pulling:
            self._due *= LATER
            found = self._gathered(state) if self.blocks.pushing() > PUSHED else None
            if found is not None and found.coarse:
                self.work += self.hierarchy.fill_work
                self.hierarchy, self._shape = found, state.x.copy()
        self.blocks.settle(state, shift)
        self.work += 1.0 + self.hierarchy.fill_work
        sound = self.hierarchy.fill(self.blocks.values)
        self._filled, self._shift, self._pulling = state.x.copy() if sound else None, shift, float(pulling)
        return sound

    @property
    def ready(self) -> bool:
        """Whether a tangent that is positive definite, as far as was seen, is taken up."""
        return self._filled is not None

    def solve(self, b: Floats, part: float, most: int) -> tuple[Floats | None, bool]:
        """x (n, 3) of A x = b on free axes, A as taken up, to `part` of b or by `most` steps, and whether A is positive
        definite as far as was seen; see `block_cg.solve` for x where it is not."""
        x, steps, positive = solve(self.hierarchy, b, part, most)
        self.steps += steps
        self.work += steps * (1.0 + self.hierarchy.cycle_work)
        if not positive:
            self._filled = None
        return x, positive

    def correction(self, b: Floats, x: Floats, most: int) -> Floats | None:
        """K^-1 b (n, 3), right within a factor of 3 where it is largest, by the tangent that is taken up, K that of a
        shape x (n, 3) near by. None where they may differ more, or it takes more steps than `most`.

        K changes on the way from shape to shape by about twice as much, for its part, as what is left to go is of that
        way; and what the shift adds is seen in the energy of the movement."""
        if self._filled is None or self._pulling:
            return None
        moved, steps, positive = self.settle(b, most, Steps(KNOWN))
        if moved is None or not positive or not steps.settled:
            return None
        short = lengths(moved).max(initial=0.0) <= SLIGHT * lengths(x - self._filled).max(initial=0.0)
        plain = self.blocks.shifted(self._shift, moved) <= SLIGHT * float((b * moved).sum())
        return moved if short and plain else None

    def settle(self, b: Floats, most: int, steps: Steps) -> tuple[Floats | None, Steps, bool]:
        """`solve`, until x has settled: right within a factor of 3 where it is largest. What the steps say, and whether
        A is positive definite as far as was seen."""
        x, count, positive = solve(self.hierarchy, b, 1e-3, most, steps)
        self.steps += count
        self.work += count * (1.0 + self.hierarchy.cycle_work)
        return x, steps, positive

    def _gathered(self, state: State) -> Hierarchy:
        return Hierarchy(self.blocks.starts, self.blocks.columns, self.blocks.weights(), state.moving)
