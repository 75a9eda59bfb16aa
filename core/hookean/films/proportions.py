"""Proportions: how the triangles of films want to be spread, as kernels, and films whose shape as drawn is torn.

The Dirichlet energy of a map from triangles with cotangents c (opposite to edges l) is D = T sum(c l^2) / 4: a
quadratic form, of a block for each triangle.
"""

from __future__ import annotations

import numpy as np

from hookean.forces.soapfilm import SHARE, TENSION, THREADS, YARNS, plane, thread

CREASED = 0.9  # of a particle's triangles: length of the mean of their unit normals
UNEVEN = 1.5  # ratio of the largest to the smallest of a particle's triangles on a crease
LOPSIDED = 100.0  # and anywhere


def find_torn(x, corners, signs, inside, sheet, room, torn):  # type: ignore[no-untyped-def]
    """Mark sheets that are torn. Room (n, 6): sum of unit normals, their number, least and largest area."""
    room[:] = 0.0
    g, n = np.zeros((3, 3)), np.zeros(3)
    for t in range(corners.shape[0]):
        area = plane(x, corners, t, g, n)
        for i in range(3):
            a = corners[t, i]
            room[a, 4] = area if room[a, 3] == 0.0 else min(room[a, 4], area)
            room[a, 5] = max(room[a, 5], area)
            room[a, 3] += 1.0
            for k in range(3):
                room[a, k] += signs[t, i] * n[k]
    for t in range(corners.shape[0]):
        for i in range(3):
            a = corners[t, i]
            size = np.sqrt(room[a, 0] * room[a, 0] + room[a, 1] * room[a, 1] + room[a, 2] * room[a, 2])
            most = UNEVEN if size < CREASED * room[a, 3] else LOPSIDED
            if inside[a] and room[a, 5] > most * room[a, 4]:
                torn[sheet[t]] = True


def conduct(x, indices, parameters, equal, blocks):  # type: ignore[no-untyped-def]
    """Blocks (m, 3, 3) of T D, and of yarns as springs of their present force density, which bound their energy.

    Triangles without area, and those that are `equal` (m,), count as if they had equal sides."""
    g, n, d = np.zeros((3, 3)), np.zeros(3), np.zeros(3)
    for e in range(indices.shape[0]):
        double = plane(x, indices, e, g, n)
        sound = not equal[e] and (n[0] != 0.0 or n[1] != 0.0 or n[2] != 0.0)
        tension = parameters[e, TENSION] * parameters[e, SHARE]
        for i in range(3):
            for j in range(3):
                dot = g[i, 0] * g[j, 0] + g[i, 1] * g[j, 1] + g[i, 2] * g[j, 2]
                part = 0.5 * dot / double if sound else (1.0 if i == j else -0.5) / np.sqrt(3.0)
                blocks[e, i, j] = tension * part
        for family in range(2):
            force = parameters[e, YARNS + family] * parameters[e, SHARE]
            length = thread(x, indices, parameters, e, family, d)
            if force == 0.0 or not length > 1e-150:
                continue
            first = THREADS + 3 * family
            for i in range(3):
                for j in range(3):
                    blocks[e, i, j] += force / length * parameters[e, first + i] * parameters[e, first + j]
