"""What each load of a scene puts on its particles in all."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.forces.base import lengths
from hookean.system.state import State
from hookean.system.system import System

Floats = NDArray[np.float64]

LEAST = 1e-9  # part of all its forces from which on a load has a resultant


def applied(system: System, state: State, element_forces: list[Floats]) -> dict[str, Any]:
    """Columns with a row for each load of the scene, in its order: `force` (its number), `kind`, `name`, `resultant`
    (k, 3) [force], `centre` (k, 3) [length] and `moment` about the centre (k, 3) [force length]. `element_forces`
    (m, arity, 3) [force] of every group."""
    rows: dict[int, tuple[Floats, Floats, Floats]] = {}
    for group, forces in zip(system.groups, element_forces, strict=True):
        if group.cls.role != "load":
            continue
        for part in group.parts:
            at = state.x[group.block.indices[part.rows]].reshape(-1, 3)
            rows[part.number] = resultant(forces[part.rows].reshape(-1, 3), at)
    numbers = sorted(rows)
    found = [np.array([rows[number][i] for number in numbers]).reshape(-1, 3) for i in range(3)]
    scene = system.scene.forces
    return {
        "force": np.array(numbers, dtype=np.int64),
        "kind": [scene[number].kind_name for number in numbers],
        "name": [scene[number].name for number in numbers],
        "resultant": found[0],
        "centre": found[1],
        "moment": found[2],
    }


def resultant(forces: Floats, at: Floats) -> tuple[Floats, Floats, Floats]:
    """Resultant, centre and moment about it of forces (n, 3) at points (n, 3).

    The centre is the mean of the points by the part of each force along the resultant, through which that of parallel
    forces goes; where forces cancel out, the mean by their size.
    """
    total = forces.sum(axis=0)
    size = lengths(forces)
    square, whole = float(total @ total), float(size.sum())
    if not whole > 0.0:
        return total, at.mean(axis=0) if len(at) else np.zeros(3), np.zeros(3)
    share = forces @ total / square if square > (LEAST * whole) ** 2 else size / whole
    centre = share @ at
    turning = np.einsum("ni,nj->ij", at - centre, forces)  # its skew part is the moment; np.cross takes 30 us
    return total, centre, (turning - turning.T)[[1, 2, 0], [2, 0, 1]]
