"""Endings: whether the films of a run are still a shape, why they are not, and which was the last good one."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from hookean.films import EDGE
from hookean.forces.soapfilm import SHARE, TENSION, SoapFilm, shapes

if TYPE_CHECKING:
    from hookean.system.group import Group
    from hookean.system.state import State
    from hookean.system.system import System

THINNEST, LARGEST = 0.02, 2.0  # of what triangles and the area were at first: a good shape
HALF, NEEDLE = 0.5, 1e-4  # thinner than that and with less of its area, or as thin as this, a triangle has collapsed
BURST = 100.0  # and films of so many times the area have burst


class Endings:
    """Looks at the films of a run; `good` is the last good shape.

    Shapes are compared with the one first looked at, not with the start: as drawn a film may be anything.
    """

    def __init__(self, *, physical: bool) -> None:
        self.good: State | None = None
        self._physical = physical  # anchors may be led anywhere
        self._first: State | None = None

    def begin(self, system: System, state: State) -> str:
        """A sentence where nothing holds the edge of a film, so that it has no equilibrium; else empty."""
        films, group = system.films, _group(system)
        if self._physical or films is None:
            return ""
        taut = np.zeros(len(state.x), bool)
        taut[films.corners[group.block.parameters[:, TENSION] > 0.0]] = True
        loose = np.flatnonzero((films.kind == EDGE) & films.pure & films.rim & taut & (state.free > 0.0).all(axis=1))
        if not len(loose):
            return ""
        number = next(p.number for p in group.parts if (group.block.indices[p.rows] == loose[0]).any())
        many = f" and {len(loose) - 1} more" if len(loose) > 1 else ""
        return (
            f"/forces/{number}: the film's edge at particle {loose[0]}{many} is unsupported, and a free edge shrinks "
            "until the film is gone. Anchor the edge, or put springs along it; if it is a seam, raise weld_tolerance "
            "above its gap"
        )

    def look(self, system: System, state: State) -> str:
        """A sentence once triangles have become needles, or films have burst: nothing spans the edges any more."""
        block = _group(system).block
        self._first = first = self._first or state.copy()
        (area, before), (grown, now) = (shapes(x, block.indices) for x in (first.x, state.x))
        thin = ~(now >= NEEDLE * before)
        if not self._physical:  # on its way a film that swings may get thin
            thin |= (now < THINNEST * before) & (grown < HALF * area)
        if thin.any():
            return self._collapsed(system, thin)
        size = float(block.parameters[:, SHARE] @ grown) / (float(block.parameters[:, SHARE] @ area) or 1.0)
        if size > BURST and not self._physical:
            return (
                f"The films have burst: their area is more than {BURST:g} times what it was. Their tension "
                "cannot carry the pressure or the loads; lower these, or raise the tension"
            )
        if (now >= THINNEST * before).all() and size <= LARGEST:
            self.good = state.copy()
        return ""

    def _collapsed(self, system: System, thin: np.ndarray) -> str:
        group = _group(system)
        part = next(p for p in group.parts if thin[p.rows].any())
        own = thin[part.rows]
        a, b, c = group.block.indices[part.rows][int(np.argmax(own))]
        loaded = any(g.cls.role == "load" for g in system.groups)
        bears, lower = (" or carries these loads", ", or lower the loads") if loaded else ("", "")
        return (
            f"/forces/{part.number}: the film has collapsed: {int(own.sum())} of {len(own)} triangles have become "
            f"needles, the first at particles {a}, {b} and {c}. No film spans these edges{bears} from this start; "
            f"bring the edges nearer to each other, or support the film in between{lower}"
        )


def _group(system: System) -> Group:
    return next(g for g in system.groups if g.cls is SoapFilm)
