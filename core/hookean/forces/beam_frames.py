"""Frames of beams at the start: along each beam, and its section's axes y and z."""

from __future__ import annotations

import numpy as np

from hookean.forces.base import Floats, Ints, lengths, units

UPRIGHT = 1e-3  # sine of the angle to the z axis below which a beam counts as vertical


def drawn_frames(chords: Floats, normal: Floats | None) -> Floats:
    """Frames (m, 3, 3) by rows t, y, z: t along the chords (m, 3), z in the plane of t and the normal (m, 3).

    Without a normal: that of the z axis; of vertical beams, the x axis. NaN where a normal is along its beam.
    """
    t = units(chords) if len(chords) else chords
    if normal is None:
        upright = np.hypot(t[:, 0], t[:, 1]) < UPRIGHT
        normal = np.where(upright[:, None], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0])
    normal = np.broadcast_to(normal, t.shape)
    normal = normal / np.where((size := np.abs(normal).max(axis=1, initial=0.0)) > 0.0, size, 1.0)[:, None]
    z = normal - (normal * t).sum(axis=1)[:, None] * t
    size = lengths(z)
    z = np.where((size > 1e-9)[:, None], z / np.where(size > 0.0, size, 1.0)[:, None], np.nan)
    return np.stack([t, np.cross(z, t), z], axis=1)


def _across(z: Floats, t: Floats) -> Floats:
    """The direction of the part of a z axis that is square to another direction."""
    part = z - (z @ t) / (t @ t) * t
    return np.asarray(part / np.sqrt(part @ part))


def straight_frames(indices: Ints, chords: Floats, frames: Floats) -> tuple[Floats, Floats]:
    """Frames (m, 3, 3) of the first and last ends of beams that are straight without stress: where two beams follow
    each other, both have the mean direction of the two there, and the mean z axis; at the ends of rows their own. Where
    z axes point away from each other, as those of default normals do on either side of the vertical, that is no twist:
    one of the sections is taken as turned by half a turn.

    `indices` (m, 2) particles of the beams, `frames` their own, which `drawn_frames` gives.
    """
    t, ends = frames[:, 0], indices.ravel()
    order = np.argsort(ends, kind="stable")
    first = np.flatnonzero(np.diff(ends[order], prepend=-1))
    count = np.diff(np.append(first, len(order)))
    found = np.repeat(frames[:, None], 2, axis=1)
    for place in first[count == 2]:
        one, two = order[place], order[place + 1]
        (a, i), (b, j) = divmod(int(one), 2), divmod(int(two), 2)
        way = -1.0 if i == j else 1.0  # drawn against each other
        mean = t[a] + way * t[b]
        if a == b or lengths(mean[None])[0] < 1e-6:
            continue
        one_z, other_z = (_across(frames[k, 2], mean) for k in (a, b))
        half = -1.0 if one_z @ other_z < 0.0 else 1.0
        joint = drawn_frames(mean[None], (one_z + half * other_z)[None])[0]
        if not np.isfinite(joint).all():
            continue
        found[a, i], found[b, j] = joint, joint
        found[b, j, 1:] *= half
        if way < 0.0:  # the second one runs the other way: turned about z
            found[b, j, :2] *= -1.0
    return found[:, 0], found[:, 1]
