"""Cables, ties and struts that go slack or taut on the way to a load factor, which linear buckling does not follow."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hookean.analysis.at_rest import AtRest
from hookean.forces.base import lengths
from hookean.forces.springs import Springs

Floats = NDArray[np.float64]

ROUNDING = 1e-9  # part of a length that counts as none


def passing(rest: AtRest, moved: Floats, factor: float) -> tuple[str, ...]:
    """A sentence for each force of springs of which some begin or cease to work between a shape and the one that
    `factor` times a linear movement `moved` (n, 3) [length] leads to."""
    notes = list[str]()
    for group, memory in zip(rest.system.groups, rest.state.memory, strict=True):
        if group.cls is not Springs:
            continue
        for part in group.parts:
            index, p = group.block.indices[part.rows], group.block.parameters[part.rows]
            first = _first(rest.state.x, moved, index, p, memory[part.rows, 0], factor)
            if not (count := int(np.isfinite(first).sum())):
                continue
            name = part.force.name or part.force.kind_name
            notes.append(
                f"{count} of {len(index)} elements of {name} go slack or taut before the first factor, element "
                f"{int(np.argmin(first))} at {first.min():.3g} times the loads; the factors leave this out and may be "
                "far too high. Follow the load with load_path, or prestress them"
            )
    return tuple(notes)


def _first(x: Floats, moved: Floats, index: NDArray[np.int64], p: Floats, slack: Floats, factor: float) -> Floats:
    """Times which movement each spring (m,) comes to one of its cutoffs and passes it; inf for none up to a factor."""
    chord = x[index[:, 1]] - x[index[:, 0]]
    length = lengths(chord)
    rate = (chord * (moved[index[:, 1]] - moved[index[:, 0]])).sum(axis=1) / np.where(length > 0.0, length, np.inf)
    rest, little = p[:, 2] * p[:, 3] + slack, ROUNDING * length
    high = np.where(p[:, 4] < 0.0, np.maximum(rest, 0.0), np.where(p[:, 4] == 0.0, np.inf, p[:, 4]))
    low = np.where(p[:, 5] < 0.0, rest, np.where(p[:, 5] == 0.0, -np.inf, p[:, 5]))
    found = np.full(len(index), np.inf)
    for limit in (low, high):
        known = np.isfinite(limit)
        before = np.where(known, length - np.where(known, limit, 0.0), 0.0)
        after = before + factor * rate
        passed = known & (np.abs(factor * rate) > little)
        passed &= np.where(np.abs(before) <= little, limit is low, before > 0.0) != (after > 0.0)
        times = np.abs(before) / np.where(passed, np.abs(rate), 1.0)
        found = np.where(passed, np.minimum(found, times), found)
    return found
