"""What each load of a scene puts on its particles in all."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.compiled import dispatch
from hookean.forces.base import Rider
from hookean.system.state import State
from hookean.system.system import System

Floats = NDArray[np.float64]

LEAST = 1e-9  # part of all its forces from which on a load has a resultant


def applied(system: System, state: State, element_forces: list[Floats]) -> dict[str, Any]:
    """Columns with a row for each load of the scene, in its order: `force` (its number), `kind`, `name`, `resultant`
    (k, 3) [force], `centre` (k, 3) [length] and `moment` about the centre (k, 3) [force length], with the moments that
    it puts on particles. `element_forces` (m, arity, 3) [force] of every group."""
    rows: dict[int, tuple[Floats, Floats, Floats]] = {}
    turning: dict[int, Floats] = {}
    for group, forces in zip(system.groups, element_forces, strict=True):
        if group.cls.role != "load":
            continue
        for part in group.parts:
            if issubclass(group.cls, Rider):  # what slots feel, times their length
                own = forces[part.rows, 1] * group.block.parameters[part.rows, :1]
                turning[part.number] = np.asarray(own.sum(axis=0))
                continue
            at = state.x.take(group.block.indices[part.rows].ravel(), axis=0)
            rows[part.number] = resultant(forces[part.rows].reshape(-1, 3), at)
    numbers = sorted(rows)
    for number, moment in turning.items():
        rows[number][2][:] += moment
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
    found = np.empty((3, 3))
    dispatch.compiled(together)(np.ascontiguousarray(forces), at, LEAST, found)
    return found[0], found[1], found[2]


def together(forces, at, least, found):  # type: ignore[no-untyped-def]
    """Write the resultant, the centre and the moment about it."""
    n, whole = len(forces), 0.0
    found[:] = 0.0
    total, centre, moment = found[0], found[1], found[2]
    for i in range(n):
        for c in range(3):
            total[c] += forces[i, c]
        whole += np.sqrt(forces[i, 0] ** 2 + forces[i, 1] ** 2 + forces[i, 2] ** 2)
    square = total[0] ** 2 + total[1] ** 2 + total[2] ** 2
    along = square > (least * whole) ** 2
    for i in range(n):
        share = 1.0 / n
        if whole > 0.0:
            fx, fy, fz = forces[i, 0], forces[i, 1], forces[i, 2]
            here = (fx * total[0] + fy * total[1] + fz * total[2]) / square if along else 0.0
            share = here if along else np.sqrt(fx * fx + fy * fy + fz * fz) / whole
        for c in range(3):
            centre[c] += share * at[i, c]
    for i in range(n):
        x, y, z = at[i, 0] - centre[0], at[i, 1] - centre[1], at[i, 2] - centre[2]
        moment[0] += y * forces[i, 2] - z * forces[i, 1]
        moment[1] += z * forces[i, 0] - x * forces[i, 2]
        moment[2] += x * forces[i, 1] - y * forces[i, 0]
