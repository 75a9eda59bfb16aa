"""What loads put along soap films, which nothing carries: a warning where that is much."""

from __future__ import annotations

import numpy as np

from hookean.forces.base import lengths
from hookean.forces.soapfilm import SoapFilm
from hookean.system.state import State
from hookean.system.system import System

MUCH = 0.01  # of all loads


def uncarried(system: System, state: State) -> list[str]:
    """A sentence on loads that have more than `MUCH` of their sizes [force] along films.

    The tension of a film is the same everywhere, so of a load b it balances the part along its normal n alone,
    T (κ1 + κ2) = -b·n. The rest, b - (b·n) n, is out of balance: with the error of the mesh it is the sum of loads and
    reactions, which is named. Pressure has no such part; weight has where the film slopes."""
    films = system.films
    loads = system.evaluate(state, only="load")[0]
    if films is None or not (whole := float(lengths(loads).sum())):
        return []
    along = films.along(state.x, state.free, loads)
    lost = float(lengths(along).sum())
    if not lost > MUCH * whole:
        return []
    group = next(g for g in system.groups if g.cls is SoapFilm)
    most = int(lengths(along).argmax())
    number = next(p.number for p in group.parts if (group.block.indices[p.rows] == most).any())
    total = films.along(state.x, state.free, system.evaluate(state)[0]).sum(axis=0)
    missing = ", ".join(f"{c:.3g}" for c in np.where(np.abs(total) > 1e-9 * whole, total, 0.0))
    force = system.scene.units.force
    return [
        f"/forces/{number}: loads of {lost:.3g} {force} (of {whole:.3g} {force}, their sizes added up) act along the "
        f"film, and nothing carries them: its tension is the same everywhere. Loads and reactions add up to "
        f"({missing}) {force}, not to zero. Use pressure, or a membrane or net, which can carry them"
    ]
