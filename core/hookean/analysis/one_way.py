"""Cables, ties and struts that go slack or taut, which linear analyses do not follow."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

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
    for name, index, limits in _springs(rest):
        first = _first(rest.state.x, moved, index, limits, factor)
        if count := int(np.isfinite(first).sum()):
            notes.append(
                f"{count} of {len(index)} elements of {name} go slack or taut before the first factor, element "
                f"{int(np.argmin(first))} at {first.min():.3g} times the loads; the factors leave this out and may be "
                "far too high. Follow the load with load_path, or prestress them"
            )
    return tuple(notes)


def between(rest: AtRest) -> tuple[str, ...]:
    """A sentence for each force of springs of which some are in a shape just where they go slack."""
    notes = list[str]()
    for name, index, limits in _springs(rest):
        length = _lengths(rest.state.x, index)[1]
        near = (np.abs(limits - length) <= ROUNDING * length).any(axis=0)
        if count := int(near.sum()):
            notes.append(
                f"{count} of {len(index)} elements of {name} are just where they go slack, the first is element "
                f"{int(np.argmax(near))}; they count as if they worked both ways, so frequencies may be too high. "
                "Prestress them, or leave out those that are slack in the motion"
            )
    return tuple(notes)


def _springs(rest: AtRest) -> Iterator[tuple[str, Any, Floats]]:
    """Of each force of springs its name, the particles (m, 2) and the lengths (2, m) from which on and up to which they
    work, infinite for none."""
    for group, memory in zip(rest.system.groups, rest.state.memory, strict=True):
        if group.cls is not Springs:
            continue
        for part in group.parts:
            p = group.block.parameters[part.rows]
            own = p[:, 2] * p[:, 3] + memory[part.rows, 0]
            high = np.where(p[:, 4] < 0.0, np.maximum(own, 0.0), np.where(p[:, 4] == 0.0, np.inf, p[:, 4]))
            low = np.where(p[:, 5] < 0.0, own, np.where(p[:, 5] == 0.0, -np.inf, p[:, 5]))
            yield part.force.name or part.force.kind_name, group.block.indices[part.rows], np.stack([low, high])


def _lengths(x: Floats, index: Any) -> tuple[Floats, Floats]:
    """The chords (m, 3) of springs and their lengths (m,)."""
    chord = x[index[:, 1]] - x[index[:, 0]]
    return chord, lengths(chord)


def _first(x: Floats, moved: Floats, index: Any, limits: Floats, factor: float) -> Floats:
    """Times which movement each spring (m,) comes to one of its limits and passes it; inf for none up to a factor."""
    chord, length = _lengths(x, index)
    rate = (chord * (moved[index[:, 1]] - moved[index[:, 0]])).sum(axis=1) / np.where(length > 0.0, length, np.inf)
    found = np.full(len(index), np.inf)
    for limit, works_beyond in zip(limits, (True, False), strict=True):
        known = np.isfinite(limit)
        before = np.where(known, length - np.where(known, limit, 0.0), 0.0)
        beyond = np.where(np.abs(before) <= ROUNDING * length, works_beyond, before > 0.0)  # at its limit it works
        passed = known & (np.abs(factor * rate) > ROUNDING * length) & (beyond != (before + factor * rate > 0.0))
        times = np.abs(before) / np.where(passed, np.abs(rate), 1.0)
        found = np.where(passed, np.minimum(found, times), found)
    return found
