"""The equilibrium matrix of beams: what each of the six forces of a beam puts on its ends.

A beam of length L from the end a to the end b, its chord along e, its section's axes y and z, is strained by

    e . (u_b - u_a),  L e . (theta_b - theta_a),  L n . (theta_i - e x (u_b - u_a) / L)  for n = y, z and i = a, b,

u the movement of the ends of its axis and theta their rotations. Motions as a whole make none of these, and all other
motions some; the columns of the matrix are their derivatives. Source: Argyris and others, Finite element method - the
natural approach, 1979.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.errors import InputError
from hookean.forces.beam import Beam
from hookean.forces.beam_element import ABOUT_Y, ABOUT_Z, ARM, FRAME, HINGE, OFFSET

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True)
class BeamPlaces:
    """All beams of a system: rows of their ends (m, 2) and of the slots of these (m, 2), their parameters (m, p), and
    which of their forces there are (m, 6): N, Mt, My at both ends, Mz at both ends."""

    ends: Ints
    slots: Ints
    parameters: Floats
    kept: NDArray[np.bool_]


def beam_places(system: Any) -> BeamPlaces:
    """The beams of a system, in the order of the scene's forces."""
    found: list[tuple[int, Ints, Floats, NDArray[np.bool_]]] = []
    for group in system.groups:
        if group.cls is not Beam:
            continue
        for part in group.parts:
            index = group.block.indices[part.rows]
            y, z = (part.force.hinged(axis, len(index)) for axis in "yz")
            torque = part.force.hinged("x", len(index)).any(axis=1)
            released = np.column_stack([np.zeros(len(index), bool), torque, y, z])
            found.append((part.number, index, group.block.parameters[part.rows], ~released))
    found.sort(key=lambda item: item[0])
    if not found:
        none = np.zeros((0, 2), np.int64)
        return BeamPlaces(none, none, np.zeros((0, 0)), np.zeros((0, 6), bool))
    index = np.concatenate([item[1] for item in found])
    parameters, kept = (np.concatenate([item[i] for item in found]) for i in (2, 3))
    return BeamPlaces(index[:, :2], index[:, 2:4], parameters, kept)


def beam_columns(system: Any, state: Any, beams: BeamPlaces) -> Floats:
    """The columns (3 n, 6 m) of all beams, of the rows of a state whose slots are folded; InputError where one has no
    length."""
    count, rows = len(beams.ends), np.zeros((len(state.x), 3, len(beams.ends), 6))
    if not count:
        return rows.reshape(3 * len(state.x), 0)
    turned = _matrices(system.slots.quaternions(state.x))[beams.slots - system.slots.first.start]
    frames = beams.parameters[:, FRAME : FRAME + 18].reshape(count, 2, 3, 3)  # t, y, z of both ends, by rows
    axes = np.einsum("mick,mijk->mijc", turned, frames)
    arms = np.einsum("mick,mik->mic", turned, beams.parameters[:, OFFSET : OFFSET + 6].reshape(count, 2, 3))
    chord = state.x[beams.ends[:, 1]] + arms[:, 1] - state.x[beams.ends[:, 0]] - arms[:, 0]
    length = np.linalg.norm(chord, axis=1)
    if (length == 0.0).any():
        raise InputError(
            "model", f"beam {int(np.argmin(length))} has zero length and no direction; move its ends apart"
        )
    e = chord / length[:, None]
    for hinge, axis, other, sign in ((ABOUT_Y, 1, 2, -1.0), (ABOUT_Z, 2, 1, 1.0)):  # turned to the chord
        turned_to = sign * np.cross(axes[:, :, axis], e[:, None])
        axes[:, :, other] = np.where(
            (beams.parameters[:, HINGE : HINGE + 2] == hinge)[:, :, None], turned_to, axes[:, :, other]
        )
    moved, twisted = np.zeros((count, 6, 2, 3)), np.zeros((count, 6, 2, 3))  # by force and end: of u, and of theta
    for end, sign in ((0, -1.0), (1, 1.0)):
        moved[:, 0, end] = sign * e
        twisted[:, 1, end] = sign * length[:, None] * e
        for place, axis in ((2, 1), (4, 2)):
            for other in (0, 1):
                n = axes[:, other, axis] - (axes[:, other, axis] * e).sum(axis=1)[:, None] * e
                n /= np.linalg.norm(n, axis=1)[:, None]
                moved[:, place + other, end] = -sign * np.cross(n, e)
                twisted[:, place + other, end] = length[:, None] * n * float(other == end)
    twisted += np.cross(arms[:, None], moved)  # the end of the axis moves by theta x arm
    twisted /= beams.parameters[:, None, ARM : ARM + 2, None]
    number = np.arange(count)
    for end in range(2):
        for force in range(6):
            rows[beams.ends[:, end], :, number, force] += moved[:, force, end]
            rows[beams.slots[:, end], :, number, force] += twisted[:, force, end]
    return np.asarray(rows.reshape(3 * len(state.x), 6 * count))


def _matrices(quaternions: Floats) -> Floats:
    """Rotation matrices (r, 3, 3) of unit quaternions w, x, y, z (r, 4)."""
    from scipy.spatial.transform import Rotation

    if not len(quaternions):
        return np.zeros((0, 3, 3))
    return np.asarray(Rotation.from_quat(quaternions[:, [1, 2, 3, 0]]).as_matrix())
