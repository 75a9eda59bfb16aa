"""Loose ends: where a line of a force ends on another line of the same force without being joined to it.

An end is loose where no other element and no anchor is at its particle. It is reported where another line, which does
not begin where its own does, is within a tenth of both lines' lengths, and within `ASIDE` of its own length from the
straight line that its own goes on in: a line that misses its node by a little, or ends between two nodes. Strings that
hang side by side do not count.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from hookean.forces.base import lengths

if TYPE_CHECKING:
    from hookean.system.near_misses import Force, Near
    from hookean.system.system import System

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
ASIDE = 0.02  # of the length of a line


def loose_ends(system: System, once: NDArray[np.bool_]) -> list[str]:
    """A sentence for each force with such ends in the start shape; `once` (n,): one end of an element alone is at that
    particle."""
    loose = once.copy() if system.held else once
    for anchor in system.held:
        loose[anchor.particles] = False
    if not loose.any():
        return []
    lines = [
        (part, group.particles[part.rows])
        for group in system.groups
        if group.cls.role == "internal" and group.cls.solid and group.particles.shape[1] == 2
        for part in group.parts
        if part.rows.stop - part.rows.start > 1
    ]
    if not lines:
        return []
    from hookean.system.near_misses import Force

    forces = [Force(system, part, index) for part, index in lines]
    return [said for force in forces if (said := _sentence(force, loose))]


def _aside(force: Force, near: Near, own: Ints) -> Floats:
    """How far the nearest point of each other line is from the straight line along its own, in lengths of its own."""
    x, p = force.system.points, near.particles
    a, b = (x[force.index[near.rows, side]] for side in (0, 1))
    along = b - a
    size = np.einsum("ij,ij->i", along, along)
    at = np.clip(np.einsum("ij,ij->i", x[p] - a, along) / np.where(size > 0.0, size, 1.0), 0.0, 1.0)
    gap = a + at[:, None] * along - x[p]
    ends = force.index[own]
    way = x[p] - x[np.where(ends[:, 0] == p, ends[:, 1], ends[:, 0])]
    long = np.where(force.along[own] > 0.0, force.along[own], np.inf)
    return np.asarray(lengths(np.cross(way, gap)) / long / long)


def _sentence(force: Force, loose: NDArray[np.bool_]) -> str:
    """What a person reads of a force; empty where all is well."""
    from hookean.system.near_misses import MOST, NEAR, compared, spot

    rows, ends = np.nonzero(loose[force.index])
    if not len(rows):
        return ""
    near = compared(force.system.points, force, force.index[rows, ends], MOST)
    mine = np.empty(len(loose), np.int64)
    mine[force.index[rows, ends]] = rows
    own = mine[near.particles]
    beside = (force.index[near.rows][:, :, None] == force.index[own][:, None, :]).any(axis=(1, 2))
    near = near.take(~beside & (near.distance < NEAR * force.along[own]) & (_aside(force, near, own) < ASIDE))
    if not len(near.rows):
        return ""
    order = np.lexsort((near.distance, near.particles))
    found, first = np.unique(near.particles[order], return_index=True)
    particle, away = int(found[0]), float(near.distance[order][first[0]])
    name = force.part.force.name or f"/forces/{force.part.number}"
    numbered = getattr(force.part.force, "particles", None) is not None  # particles that are given are never welded
    join = "give both lines the same particle" if numbered else "raise weld_tolerance"
    return (
        f"{name}: {'' if near.all else 'at least '}{len(found)} of {len(rows)} loose ends lie on other lines of this "
        f"force, within a tenth of their length, but are not joined to them; the first is "
        f"{spot(force, particle, away)}. Draw lines from node to node, or {join}"
    )
