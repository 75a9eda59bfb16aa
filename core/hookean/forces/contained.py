"""Solids that lie in one another: which they are."""

from __future__ import annotations

from typing import Any

import numpy as np

from hookean.compiled.dispatch import rows
from hookean.compiled.marks import device
from hookean.forces.convex import BODY, FACES, HEAD, PLANE, POINT, POINTS, RADIUS, TABLE, WIDTH
from hookean.forces.rigid_places import STRENGTH, crowd_sizes, gather


@device
def contains(solids: Any, i: Any, j: Any) -> Any:
    """Whether no point of the second of two solids is above a face of the first."""
    bodies, points, planes = solids
    plane, point = int(bodies[i, PLANE]), int(bodies[j, POINT])
    for r in range(plane, plane + int(rows(bodies[i, TABLE], 1.0, WIDTH)[0, FACES])):
        shift = planes[r, 3]
        for c in range(3):
            shift -= (bodies[j, c] - bodies[i, c]) * planes[r, c]
        for p in range(point, point + int(rows(bodies[j, TABLE], 1.0, WIDTH)[0, POINTS])):
            if points[p, 0] * planes[r, 0] + points[p, 1] * planes[r, 1] + points[p, 2] * planes[r, 2] > shift:
                return False
    return True


def find_inside(x, indices, parameters, found):  # type: ignore[no-untyped-def]
    """Write the first particles of a solid inside another and of that one; returns how many such pairs there are."""
    stop, sizes, many = 0, np.zeros(5, np.int64), 0
    while stop < indices.shape[0]:
        start = stop
        stop = crowd_sizes(indices, parameters, start, sizes)
        bodies, points, planes = np.zeros((sizes[0], BODY)), np.zeros((sizes[1], 3)), np.zeros((sizes[2], 4))
        centres, room = np.zeros((sizes[0], 5)), np.zeros((12, 4))
        gather(x, indices, parameters, start, stop, (bodies, points, planes), centres, room)
        for i in range(sizes[0]):
            for j in range(sizes[0]):
                apart, one, other = 0.0, int(bodies[i, HEAD]), int(bodies[j, HEAD])
                for c in range(3):
                    apart += (bodies[i, c] - bodies[j, c]) ** 2
                alike = centres[i, 4] != 0.0 and centres[i, 4] == centres[j, 4]
                if i == j or alike or apart > bodies[i, RADIUS] ** 2:
                    continue
                pushed = parameters[one, STRENGTH] > 0.0 and parameters[other, STRENGTH] > 0.0
                if pushed and contains((bodies, points, planes), i, j):
                    if many == 0:
                        found[0], found[1] = indices[other, 0], indices[one, 0]
                    many += 1
    return many
