"""Rigid solids of a force where they are now, and which of them lie in one another."""

from __future__ import annotations

from typing import Any

import numpy as np

from hookean.compiled.dispatch import rows
from hookean.compiled.marks import device
from hookean.forces.convex import (
    BODY,
    COUNT,
    FACES,
    HEAD,
    INVERSE,
    MOST,
    PLANE,
    POINT,
    POINTS,
    RADIUS,
    ROWS,
    TABLE,
    WIDTH,
    lay_out,
)
from hookean.forces.groups import begins
from hookean.forces.rigid_body import CENTRE, POSE, find_pose

# columns of the parameters, after those that `find_pose` reads
# the start of a body is at 6
STRENGTH, FRICTION, LABEL, REACH, HULL, LENGTH, SKIN, ROOM, QUIET = 9, 10, 11, 12, 13, 14, 15, 16, 17
SINGULAR = 1e-12  # part of its size, to the third power, below which a matrix has no inverse


@device
def crowd_sizes(indices: Any, parameters: Any, start: Any, sizes: Any) -> Any:
    """Where the elements of one room end; how many bodies, points, planes they have, and the most corners of
    a face and faces of a body."""
    stop = start
    for k in range(5):
        sizes[k] = 0
    while stop < indices.shape[0] and parameters[stop, ROOM] == parameters[start, ROOM]:
        if begins(parameters, stop):
            table = rows(parameters[stop, HULL], 1.0, WIDTH)
            sizes[0] += 1
            sizes[1] += int(table[0, POINTS])
            sizes[2] += int(table[0, FACES])
            sizes[3] = max(sizes[3], int(table[0, MOST]))
            sizes[4] = max(sizes[4], int(table[0, FACES]))
        stop += 1
    return stop


@device
def invert(bodies: Any, b: Any, s: Any, room: Any) -> None:
    """The inverse of tr(R S) - R S, S the sum of q y^T: a moment times it is a rotation per stiffness."""
    trace = 0.0
    for i in range(3):
        for k in range(3):
            room[i, k] = 0.0
            for c in range(3):
                room[i, k] += 0.5 * (bodies[b, 3 + 3 * i + c] * s[c, k] + bodies[b, 3 + 3 * k + c] * s[c, i])
        trace += room[i, i]
    for i in range(3):
        for k in range(3):
            room[i, k] = (trace if i == k else 0.0) - room[i, k]
    inverse = bodies[b, INVERSE : INVERSE + 9].reshape(3, 3)
    for i in range(3):
        p, q = (i + 1) % 3, (i + 2) % 3
        for k in range(3):
            u, o = (k + 1) % 3, (k + 2) % 3
            inverse[k, i] = room[p, u] * room[q, o] - room[p, o] * room[q, u]
    whole = room[0, 0] * inverse[0, 0] + room[0, 1] * inverse[1, 0] + room[0, 2] * inverse[2, 0]
    part = 1.0 / whole if abs(whole) > SINGULAR * abs(trace) ** 3 and abs(trace) > 1e-100 else 0.0
    for i in range(3):
        for k in range(3):
            inverse[i, k] *= part


@device
def gather(x: Any, indices: Any, parameters: Any, start: Any, stop: Any, solids: Any, centres: Any, room: Any) -> None:
    """Where the bodies of one room are, with their points and planes, and no forces yet."""
    bodies, points, planes = solids
    b, point, plane = 0, 0, 0
    for e in range(start, stop):
        if not begins(parameters, e):
            continue
        for c in range(BODY):
            bodies[b, c] = 0.0
        bodies[b, COUNT] = find_pose(x, indices, parameters, e, bodies[b, :POSE], room)
        invert(bodies, b, room[:4], room[4:8])
        bodies[b, POINT], bodies[b, PLANE], bodies[b, HEAD] = point, plane, e
        bodies[b, TABLE], bodies[b, ROWS] = parameters[e, HULL], parameters[e, LENGTH]
        bodies[b, RADIUS] = parameters[e, REACH]
        lay_out(bodies, b, points, planes)
        table = rows(parameters[e, HULL], 1.0, WIDTH)
        point, plane = point + int(table[0, POINTS]), plane + int(table[0, FACES])
        for c in range(3):
            centres[b, c] = bodies[b, CENTRE + c]
        centres[b, 3], centres[b, 4] = parameters[e, REACH], parameters[e, LABEL]
        b += 1


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
