"""What loads apply: the resultant of each, and where it acts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hookean.running.loads import resultant
from hookean.system.state import State
from hookean.system.system import System

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Applied:
    """One load on a shape: its `resultant` (3,) and `moment` (3,) about the origin [force, force length], the `centre`
    (3,) [length] of its forces as `running.loads.resultant` finds it, and how many `particles` it acts on."""

    number: int
    name: str
    kind: str
    resultant: Floats
    moment: Floats
    centre: Floats
    particles: int


def applied(system: System, state: State) -> list[Applied]:
    """The loads of a system on a shape, in the order of the scene."""
    found: list[Applied] = []
    for group, memory in zip(system.groups, state.memory, strict=True):
        if group.cls.role != "load":
            continue
        forces = system.element_forces(group, state, memory)
        for part in group.parts:
            index, own = group.block.indices[part.rows], forces[part.rows]
            x, f = state.x[index].reshape(-1, 3), own.reshape(-1, 3)
            total, centre, _ = resultant(f, x)
            name = part.force.name or part.force.kind_name
            moment, count = np.cross(x, f).sum(axis=0), len(np.unique(index))
            found.append(Applied(part.number, name, part.force.kind_name, total, moment, centre, count))
    return sorted(found, key=lambda load: load.number)
