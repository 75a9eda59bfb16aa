"""Reactions + contacts + loads = 0, forces and moments: of whatever is relaxed to rest while a test runs."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pytest

from hookean.analysis import freezing
from hookean.running import run
from hookean.running.result import Result
from hookean.system.state import State
from hookean.system.system import System

MOST = 1e-9  # of all forces from outside, and of these at the radius of the structure for moments


@dataclass
class Balances:
    """The results of a test: `forces` and `moments` have of each the sum by the size of all; `checked` is how many."""

    forces: list[float] = field(default_factory=list)
    moments: list[float] = field(default_factory=list)

    @property
    def checked(self) -> int:
        """How many results were at rest."""
        return len(self.forces)

    def note(self, system: System, state: State, result: Result, scale: float) -> None:
        """Note a result; `scale` is a force of the structure, for one on which nothing acts."""
        at, forces, moments = outside(system, state, result)
        centre = result.particles.mean(axis=0)
        radius = float(np.linalg.norm(result.particles - centre, axis=1).max())
        size = np.linalg.norm(forces, axis=1).sum() + np.linalg.norm(moments, axis=1).sum() / radius + scale
        moment = np.cross(at - centre, forces).sum(axis=0) + moments.sum(axis=0)
        # where elastic supports carry, no step beyond the last digit of the coordinates is known, and rounding stays
        borne = any(group.cls.role == "support" for group in system.groups)
        rounding = result.rounding_floor * scale * len(result.particles) / size if borne else 0.0
        self.forces.append(max(float(np.abs(forces.sum(axis=0)).max() / size) - rounding, 0.0))
        turned = any(group.cls.oriented for group in system.groups)  # their directions in space hold against turning
        self.moments.append(0.0 if turned else float(np.abs(moment).max() / (size * radius)))


def outside(system: System, state: State, result: Result) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Points (n, 3), forces (n, 3) at them and moments (k, 3) that supports, floors and loads put on a structure."""
    hold, touch, loads = result.reactions, result.contacts, result.loads
    at = [result.particles[hold["particles"]], result.particles[touch["particles"]], loads["centre"]]
    forces = [hold["force"], touch["force"], loads["resultant"]]
    moments = [np.asarray(hold["moment"]).reshape(-1, 3), loads["moment"]]
    for group, memory in zip(system.groups, state.memory, strict=True):
        # elastic supports are among the reactions, floors among the contacts
        if group.cls.role == "support" and not group.cls.bearing and group.cls.support is None:
            own = system.element_forces(group, state, memory)
            at.append(state.x[group.block.indices.ravel()])
            forces.append(own.reshape(-1, 3))
    rows = [np.concatenate([np.asarray(part, float).reshape(-1, 3) for part in parts]) for parts in (at, forces)]
    return rows[0], rows[1], np.concatenate(moments)


@contextmanager
def balanced() -> Iterator[Balances]:
    """Check all that is relaxed to rest meanwhile, except forms that are found before they are frozen, which are made
    exact afterwards, and films, which are held along themselves."""
    found, paused = Balances(), [0]
    gather, form = run.gather, freezing.relax_state

    def noted(system: System, state: State, judged: Any, *given: Any, moving: bool) -> Result:
        result = gather(system, state, judged, *given, moving=moving)
        if result.converged and not (moving or paused[0] or system.films is not None):
            found.note(system, state, result, judged.scale)
        return result

    def unnoted(*given: Any, **more: Any) -> Result:
        paused[0] += 1
        try:
            return form(*given, **more)
        finally:
            paused[0] -= 1

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(run, "gather", noted)
        patch.setattr(freezing, "relax_state", unnoted)
        yield found
    assert max(found.forces, default=0.0) < MOST, f"reactions + loads = {max(found.forces):.2g} of all forces"
    assert max(found.moments, default=0.0) < MOST, f"their moments = {max(found.moments):.2g} of all"
