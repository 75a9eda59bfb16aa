"""What stretched cloth shows on its surface: stress, state and utilisation, at the particles of its triangles."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hookean.running.utilisation import utilisation
from hookean.system.system import System

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class ClothScalars:
    """Numbers (n,) at particles, by the triangles of `membrane` forces that meet there; nan at particles without cloth.

    `stress` [force/length]: the largest principal stress per width; `state`: of the loosest triangle, 2 taut,
    1 wrinkled, 0 slack; `utilisation` [-]: the largest, nan also where no strength is known.
    """

    stress: Floats
    state: Floats
    utilisation: Floats


def cloth_scalars(system: System, x: Floats) -> ClothScalars:
    """Of cloth whose particles are at x (n, 3) [length]. The largest of the triangles about a particle, not their mean,
    so that what is read off a picture is on the safe side."""
    found = ClothScalars(*np.full((3, system.slots.count), np.nan))
    for group in system.groups:
        if group.cls.kind_name != "membrane":
            continue
        for part in group.parts:
            block = group.of(part)
            columns = part.force.measure(block, x, np.zeros_like(block.parameters))
            used = utilisation(part.force, system.places, columns)
            for corner in group.particles[part.rows].T:
                np.fmax.at(found.stress, corner, columns["largest"])
                np.fmin.at(found.state, corner, columns["state"])
                if used is not None:
                    np.fmax.at(found.utilisation, corner, used)
    return found
