"""What loads along beams would bend between the ends, on which they act: a warning where that is much."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.forces.beam import Beam
from hookean.forces.line_weight import LineWeight
from hookean.forces.self_weight import SelfWeight
from hookean.running.result import Result
from hookean.system.system import System

Floats = NDArray[np.float64]

MUCH = 0.1  # of the largest moment at the ends of a force's beams
BENDING = ("My0", "Mz0", "My1", "Mz1")


def bent_between(system: System, result: Result) -> list[str]:
    """Sentences on beams between whose ends loads along them would add more than `MUCH` of their moments.

    Loads along lines act on particles, half on each end, so a beam has no moment of its own between them; a load W
    across one of length l would add W l / 8 there (simply supported, or from the line between both end moments)."""
    pairs, loads = _along(system, result)
    if not len(pairs):
        return []
    said = []
    for number, (force, entry) in enumerate(zip(system.scene.forces, result.forces, strict=True)):
        if not isinstance(force, Beam) or not np.size(entry.get("particles", ())):
            continue
        own = np.asarray(entry["particles"])
        chord = np.diff(result.particles[own], axis=1)[:, 0]
        length = np.linalg.norm(chord, axis=1)
        along = chord / np.where(length > 0.0, length, 1.0)[:, None]
        load = _of(own, pairs, loads)
        load -= (load * along).sum(axis=1)[:, None] * along
        missing = float((np.linalg.norm(load, axis=1) * length).max() / 8.0)
        there = float(max(np.abs(entry[name]).max() for name in BENDING))
        if missing > MUCH * there:
            unit = result.units.of("moment")
            said.append(
                f"/forces/{number}: loads along {force.name or force.kind_name} act on the ends of its beams. Between "
                f"these, moments of up to {missing:.3g} {unit} are missing; at the ends there are up to {there:.3g}. "
                "Divide the beams into more: with two for each, a quarter is missing"
            )
    return said


def _along(system: System, result: Result) -> tuple[Any, Floats]:
    """The pairs (k, 2) of particles that loads along lines are on, and the load (k, 3) [force] on each."""
    pairs, loads = [np.zeros((0, 2), np.int64)], [np.zeros((0, 3))]
    for force, entry in zip(system.scene.forces, result.forces, strict=True):
        if not np.size(entry.get("particles", ())):
            continue
        if isinstance(force, LineWeight):
            pairs.append(np.asarray(entry["particles"]))
            loads.append(np.asarray(entry["force"]))
        elif isinstance(force, SelfWeight) and force.element_arity == 2:
            index, half = force.shares(system.places, system.places.x)
            down = np.asarray(force.direction) / np.linalg.norm(force.direction)
            pairs.append(index)
            loads.append(2.0 * half[:, None] * down)
    return np.concatenate(pairs), np.concatenate(loads)


def _of(own: Any, pairs: Any, loads: Floats) -> Floats:
    """The load (m, 3) on each of the pairs `own` (m, 2), whichever way round."""
    count = int(max(own.max(), pairs.max())) + 1
    keys, mine = (np.sort(rows, axis=1) @ [count, 1] for rows in (pairs, own))
    unique, which = np.unique(keys, return_inverse=True)
    sums = np.stack([np.bincount(which, loads[:, axis], len(unique)) for axis in range(3)], axis=1)
    place = np.minimum(np.searchsorted(unique, mine), len(unique) - 1)
    return np.where((unique[place] == mine)[:, None], sums[place], 0.0)
