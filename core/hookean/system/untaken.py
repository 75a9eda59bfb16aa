"""Moments on particles all of whose beams are hinged about their axis: nothing takes them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from hookean.forces.base import lengths

if TYPE_CHECKING:
    from hookean.system.state import State
    from hookean.system.system import System

NOTHING = 1e-12  # part of the stiffness of the elements at a particle that counts as none against its turns
PART = 1e-6  # of the largest load, moments as forces M / l: what of a moment along such an axis is rounding


def untaken_moment(system: System, state: State) -> str:
    """Which particle has a moment [force length] about an axis n about which no element resists its turning, as a
    sentence without its full stop: n of the part K of the tangent of its own turns, K n = 0. Such turns move nothing
    and never stop. Returns an empty text if every moment is taken."""
    own, first = system.slots, system.slots.first
    if not len(own):
        return ""
    given = system.evaluate(state, only="load")[0] * state.free
    loads, least = given[first] * own.lengths[:, None], PART * lengths(given).max() * own.lengths
    if not loads.any():
        return ""
    stiffness, about = np.zeros((len(own), 3, 3)), np.zeros(len(own))
    for group, memory in zip(system.groups, state.memory, strict=True):
        if group.cls.role == "load" or not group.cls.turns:
            continue
        blocks = system.stiffness_blocks(group, state, memory)
        for place, rows in enumerate(group.block.indices.T):
            mine = (rows >= first.start) & (rows < first.stop)
            along = slice(3 * place, 3 * place + 3)
            np.add.at(stiffness, rows[mine] - first.start, blocks[mine, along, along])
            np.maximum.at(about, rows[mine] - first.start, np.abs(blocks[mine]).max(axis=(1, 2), initial=0.0))
    free = state.free[first]
    stiffness *= free[:, :, None] * free[:, None, :]
    values, axes = np.linalg.eigh(stiffness)
    loose = np.abs(values) <= NOTHING * about[:, None]
    parts = np.einsum("rij,ri->rj", axes, loads) * loose
    left = np.einsum("rij,rj->ri", axes, parts)
    lost = np.flatnonzero(lengths(left) > least)
    if not len(lost):
        return ""
    moment, unit = left[lost[0]], system.scene.units.of("moment")
    said = ", ".join(f"{c:.3g}" for c in np.where(np.abs(moment) > least[lost[0]], moment, 0.0))
    more = f" (and {len(lost) - 1} more)" if len(lost) > 1 else ""
    return (
        f"Nothing takes the moment ({said}) {unit} on particle {own.particles[lost[0]]}{more}: all beams there are "
        "hinged about its axis. Release fewer axes of one of them, hold the rotation by an anchor, or remove the moment"
    )
