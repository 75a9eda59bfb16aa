"""Convex solids as tables, and what they press on each other where they overlap.

A solid is the convex hull of points: a table with rows of four numbers (`hull`). Of all faces of two solids that
overlap, that which is nearest to the centroid of the overlap is the reference. Inside its solid it presses on the
surface of the other, along that surface's normal, by the depth below its plane. These pressures have an energy, the
integral of the depth over the overlap. The overlap is bounded by the faces of both, clipped by the planes of the other;
all integrals over these polygons are exact. Sources: Sutherland and Hodgman, "Reentrant polygon clipping", 1974;
Johnson, Contact Mechanics, 1985, 4.3 (elastic foundation); Gottschalk, Lin and Manocha, "OBBTree", 1996 (separating
axes).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from hookean.compiled.dispatch import rows
from hookean.compiled.marks import device
from hookean.forces.base import Floats, lengths

WIDTH = 4  # columns of a table
POINTS, FACES, CORNERS, MOST = range(4)  # its first row: how many of each, and the most corners of a face
FLAT = 1e-9  # part of the size of a solid within which points are on one plane
# of a body: its pose (see `rigid_body`), the inverse of the matrix that turns moments into rotations, force, moment,
# stiffness, number of particles, where its points and planes are, its table, its first row, its radius
TURN, INVERSE, FORCE, MOMENT, STIFF, COUNT, POINT, PLANE, TABLE, ROWS, HEAD, RADIUS, BODY = (
    3, 13, 22, 25, 28, 29, 30, 31, 32, 33, 34, 35, 36,
)  # fmt: skip
# of a contact: energy, force and moment on the other solid, pressing force, area, its centroid, its polar moment,
# normal, stiffness of the particles of both, which is the reference
ENERGY, PUSH, TWIST, PRESS, AT, AREA, POLAR, AXIS, OTHERS, OWN, BASE, HIT = 0, 1, 4, 7, 8, 11, 12, 13, 16, 17, 18, 19
SHALLOW = 1e-9  # part of the sizes summed below which a volume is mostly rounding
FIRST, LAST, NORMAL, WHOSE, NOTE = 0, 1, 2, 3, 4  # of a polygon: its corners, its plane, its solid


def hull(points: Floats) -> Floats:
    """The table of the convex hull of points (n, 3), which must not be flat: counts, points, planes (normal and
    distance), first corner and number of corners of each face, corners in turn about the outward normal."""
    from scipy.spatial import ConvexHull

    found = ConvexHull(points)
    size = float(np.ptp(points, axis=0).max())
    kept, planes, faces = found.vertices, [], []
    left = np.ones(len(found.equations), bool)
    at = points[kept]
    while left.any():
        seed = int(np.argmax(left))
        normal = found.equations[seed, :3]
        height = float((at @ normal).max())
        flat = np.flatnonzero(at @ normal > height - FLAT * size)
        left &= (np.abs(points[found.simplices] @ normal - height) > FLAT * size).any(axis=1)
        left[seed] = False
        if len(flat) < 3:
            continue
        middle = at[flat] - at[flat].mean(axis=0)
        u = middle[0] / np.linalg.norm(middle[0])
        turn = np.argsort(np.arctan2(middle @ np.cross(normal, u), middle @ u))
        planes.append([*normal, height])
        faces.append(flat[turn])
    count = np.array([len(face) for face in faces])
    start = np.cumsum(count) - count
    corners = np.concatenate(faces)
    table = np.zeros((1 + len(kept) + 2 * len(faces) + len(corners), WIDTH))
    table[0] = len(kept), len(faces), len(corners), count.max()
    table[1 : 1 + len(kept), :3] = at
    last = 1 + len(kept) + len(faces)
    table[1 + len(kept) : last] = planes
    table[last : last + len(faces), :2] = np.column_stack([start, count])
    table[last + len(faces) :, 0] = corners
    return table


def radius(table: Floats) -> float:
    """Of the sphere about a solid and the origin of its points."""
    return float(lengths(table[1 : 1 + int(table[0, POINTS]), :3]).max())


@device
def turned(bodies: Any, b: Any, given: Any, to: Any) -> None:
    """A vector of a body as the body has turned."""
    for i in range(3):
        to[i] = 0.0
        for k in range(3):
            to[i] += bodies[b, TURN + 3 * i + k] * given[k]


@device
def lay_out(bodies: Any, b: Any, points: Any, planes: Any) -> None:
    """Points of a body from its centre, and its planes."""
    table = rows(bodies[b, TABLE], bodies[b, ROWS], WIDTH)
    count, first, plane = int(table[0, POINTS]), int(bodies[b, POINT]), int(bodies[b, PLANE])
    for i in range(count):
        turned(bodies, b, table[1 + i], points[first + i])
    for i in range(int(table[0, FACES])):
        turned(bodies, b, table[1 + count + i], planes[plane + i])
        planes[plane + i, 3] = table[1 + count + i, 3]


@device
def under(solids: Any, base: Any, plane: Any, other: Any) -> Any:
    """How far a solid is below a plane of another."""
    bodies, points, planes = solids
    first, low, shift = int(bodies[other, POINT]), np.inf, 0.0
    for c in range(3):
        shift += (bodies[other, c] - bodies[base, c]) * planes[plane, c]
    for i in range(first, first + int(rows(bodies[other, TABLE], 1.0, WIDTH)[0, POINTS])):
        height = points[i, 0] * planes[plane, 0] + points[i, 1] * planes[plane, 1] + points[i, 2] * planes[plane, 2]
        low = min(low, height)
    return planes[plane, 3] - low - shift


@device
def overlap(solids: Any, base: Any, other: Any, least: Any, margin: Any) -> Any:
    """How far a solid is below the faces of another; the least of these and of `least`, at once where it is as much
    above as a margin."""
    plane = int(solids[0][base, PLANE])
    for r in range(plane, plane + int(rows(solids[0][base, TABLE], 1.0, WIDTH)[0, FACES])):
        if least <= -margin:
            return least
        least = min(least, under(solids, base, r, other))
    return least


@device
def clip(given: Any, count: Any, to: Any, n: Any, most: Any) -> Any:
    """The part of a polygon with n . x <= most; how many corners it has."""
    found = 0
    for k in range(count):
        j = k + 1 if k + 1 < count else 0
        a, b = -most, -most
        for c in range(3):
            a += n[c] * given[k, c]
            b += n[c] * given[j, c]
        if a <= 0.0:
            for c in range(3):
                to[found, c] = given[k, c]
            found += 1
        if (a < 0.0 and b > 0.0) or (a > 0.0 and b < 0.0):
            s = a / (a - b)
            for c in range(3):
                to[found, c] = given[k, c] + s * (given[j, c] - given[k, c])
            found += 1
    return found


@device
def take(solids: Any, whose: Any, face: Any, origin: Any, poly: Any) -> Any:
    """Put a face of a solid, from the centre of another, first of two polygons; how many corners it has."""
    bodies, points, _ = solids
    table = rows(bodies[whose, TABLE], bodies[whose, ROWS], WIDTH)
    count = 1 + int(table[0, POINTS]) + int(table[0, FACES])
    corner, corners = count + int(table[0, FACES]) + int(table[count + face, 0]), int(table[count + face, 1])
    for k in range(corners):
        p = int(bodies[whose, POINT]) + int(table[corner + k, 0])
        for c in range(3):
            poly[0, k, c] = points[p, c] + (bodies[whose, c] - bodies[origin, c])
    return corners


@device
def cut(solids: Any, whose: Any, origin: Any, count: Any, poly: Any) -> Any:
    """Clip the first of two polygons by all planes of a solid; how many corners are left, again in the first."""
    bodies, _, planes = solids
    plane = int(bodies[whose, PLANE])
    for r in range(plane, plane + int(rows(bodies[whose, TABLE], 1.0, WIDTH)[0, FACES])):
        most, high = planes[r, 3], -np.inf
        for c in range(3):
            most += planes[r, c] * (bodies[whose, c] - bodies[origin, c])
        for k in range(count):
            high = max(high, planes[r, 0] * poly[0, k, 0] + planes[r, 1] * poly[0, k, 1] + planes[r, 2] * poly[0, k, 2])
        if high <= most:
            continue
        count = clip(poly[0], count, poly[1], planes[r], most)
        if count < 3:
            return 0
        for k in range(count):
            for c in range(3):
                poly[0, k, c] = poly[1, k, c]
    return count


@device
def bound(solids: Any, i: Any, j: Any, desk: Any) -> Any:
    """Find the polygons that bound the overlap of two solids, from the centre of the second; how many."""
    bodies, _, _ = solids
    poly, corners, notes = desk[0], desk[3], desk[4]
    found, end = 0, 0
    for which in range(2):
        own, other = (i, j) if which == 0 else (j, i)
        for face in range(int(rows(bodies[own, TABLE], 1.0, WIDTH)[0, FACES])):
            count = cut(solids, other, j, take(solids, own, face, j, poly), poly)
            if count < 3:
                continue
            notes[found, FIRST], notes[found, LAST] = end, end + count
            notes[found, NORMAL], notes[found, WHOSE] = int(bodies[own, PLANE]) + face, own
            for k in range(count):
                for c in range(3):
                    corners[end + k, c] = poly[0, k, c]
            found, end = found + 1, end + count
    return found


@device
def triangle(corners: Any, first: Any, k: Any, n: Any, shape: Any) -> Any:
    """A third of the area of a triangle of a polygon, and the midpoints of its sides: exact for what is of second
    order."""
    area = 0.0
    for c in range(3):
        p, q = (c + 1) % 3, (c + 2) % 3
        cross = (corners[k, p] - corners[first, p]) * (corners[k + 1, q] - corners[first, q])
        area += n[c] * (cross - (corners[k, q] - corners[first, q]) * (corners[k + 1, p] - corners[first, p])) / 6.0
        shape[0, c] = 0.5 * (corners[first, c] + corners[k, c])
        shape[1, c] = 0.5 * (corners[k, c] + corners[k + 1, c])
        shape[2, c] = 0.5 * (corners[k + 1, c] + corners[first, c])
    return area


@device
def centroid(planes: Any, count: Any, desk: Any) -> Any:
    """The volume of the overlap; its centroid into the room, or that of its surface where it is very shallow."""
    room, corners, notes = desk[2], desk[3], desk[4]
    shape, middle, skin = room[:3], room[3], room[4]
    volume, sizes, surface = 0.0, 0.0, 0.0
    for c in range(3):
        middle[c] = skin[c] = 0.0
    for p in range(count):
        n = planes[notes[p, NORMAL]]
        for k in range(notes[p, FIRST] + 1, notes[p, LAST] - 1):
            area = triangle(corners, notes[p, FIRST], k, n, shape)
            surface += 3.0 * area
            for s in range(3):
                for c in range(3):
                    x = shape[s, c] - corners[0, c]
                    volume += area * n[c] * x / 3.0
                    sizes += abs(area * n[c] * x)
                    middle[c] += 0.5 * area * n[c] * x * x
                    skin[c] += area * x
    shallow = not volume > SHALLOW * sizes
    for c in range(3):
        middle[c] = skin[c] / surface if shallow and surface > 0.0 else (0.0 if shallow else middle[c] / volume)
        middle[c] += corners[0, c]
    return volume


@device
def reference(solids: Any, i: Any, j: Any, middle: Any) -> Any:
    """Of all faces of two solids that which is nearest to a point inside, from the centre of the second: its solid and
    its number."""
    bodies, _, planes = solids
    least, whose, face = np.inf, j, 0
    for which in range(2):
        own = j if which == 0 else i
        plane = int(bodies[own, PLANE])
        for r in range(int(rows(bodies[own, TABLE], 1.0, WIDTH)[0, FACES])):
            depth = planes[plane + r, 3]
            for c in range(3):
                depth -= planes[plane + r, c] * (middle[c] - bodies[own, c] + bodies[j, c])
            if depth < least:
                least, whose, face = depth, own, r
    return whose, face


@device
def press(solids: Any, base: Any, face: Any, j: Any, count: Any, desk: Any) -> None:
    """What a face of one solid presses on the other, with a stiffness of 1; all from the centre of the second."""
    bodies, _, planes = solids
    hit, room, corners, notes = desk[1][0], desk[2], desk[3], desk[4]
    n, shape = planes[int(bodies[base, PLANE]) + face], room[:3]
    high = n[3]
    for c in range(3):
        high += n[c] * (bodies[base, c] - bodies[j, c])
        hit[AXIS + c] = n[c]
    for p in range(count):
        normal, slope = planes[notes[p, NORMAL]], 0.0
        for c in range(3):
            slope -= n[c] * normal[c]
        for k in range(notes[p, FIRST] + 1, notes[p, LAST] - 1):
            area = triangle(corners, notes[p, FIRST], k, normal, shape)
            for s in range(3):
                m = shape[s]
                depth = high - n[0] * m[0] - n[1] * m[1] - n[2] * m[2]
                hit[ENERGY] += 0.5 * slope * depth * depth * area
                if notes[p, WHOSE] != base:
                    add_pressure(m, depth, area, slope, normal, hit)
    if hit[PRESS] > 0.0:
        square = 0.0
        for c in range(3):
            hit[AT + c] /= hit[AREA]
            square += hit[AT + c] * hit[AT + c]
        hit[POLAR] = max(hit[POLAR] - hit[AREA] * square, 0.0)


@device
def add_pressure(m: Any, depth: Any, area: Any, slope: Any, normal: Any, hit: Any) -> None:
    """Add what a pressure on a small area at m gives."""
    part = depth * area
    for i in range(3):
        p, q = (i + 1) % 3, (i + 2) % 3
        hit[PUSH + i] -= part * normal[i]
        hit[TWIST + i] -= part * (m[p] * normal[q] - m[q] * normal[p])
        hit[AT + i] += max(slope, 0.0) * area * m[i]
    hit[PRESS] += slope * part
    if slope > 0.0:
        hit[AREA] += slope * area
        hit[POLAR] += slope * area * (m[0] * m[0] + m[1] * m[1] + m[2] * m[2])


@device
def lever(bodies: Any, b: Any, r: Any, n: Any, rough: Any) -> Any:
    """What a unit force along n at r from the centre of a body puts on its particles, squared and summed; the largest
    of any direction if `rough`."""
    found = 1.0 / bodies[b, COUNT]
    for axis in range(3 if rough else 1):
        if rough:
            i, k = (axis + 1) % 3, (axis + 2) % 3
            a, o, e = INVERSE + 3 * i, INVERSE + 3 * k, r[k] * r[i]
            found += r[k] * r[k] * bodies[b, a + i] + r[i] * r[i] * bodies[b, o + k] - 2.0 * e * bodies[b, a + k]
        else:
            m0, m1, m2 = r[1] * n[2] - r[2] * n[1], r[2] * n[0] - r[0] * n[2], r[0] * n[1] - r[1] * n[0]
            found += m0 * (bodies[b, INVERSE] * m0 + bodies[b, INVERSE + 1] * m1 + bodies[b, INVERSE + 2] * m2)
            found += m1 * (bodies[b, INVERSE + 3] * m0 + bodies[b, INVERSE + 4] * m1 + bodies[b, INVERSE + 5] * m2)
            found += m2 * (bodies[b, INVERSE + 6] * m0 + bodies[b, INVERSE + 7] * m1 + bodies[b, INVERSE + 8] * m2)
    return max(found, 0.0)


@device
def column(solids: Any, base: Any, face: Any, count: Any, poly: Any, side: Any) -> Any:
    """Clip the first of two polygons by the column of a face, the planes through its sides square to it; how many
    corners are left, again in the first."""
    bodies, points, planes = solids
    table = rows(bodies[base, TABLE], bodies[base, ROWS], WIDTH)
    point, plane = int(bodies[base, POINT]), int(bodies[base, PLANE])
    faces = 1 + int(table[0, POINTS]) + int(table[0, FACES])
    corner = faces + int(table[0, FACES]) + int(table[faces + face, 0])
    corners = int(table[faces + face, 1])
    n = planes[plane + face]
    which = 0
    for k in range(corners):
        a = points[point + int(table[corner + k, 0])]
        b = points[point + int(table[corner + (k + 1 if k + 1 < corners else 0), 0])]
        most = 0.0
        for i in range(3):
            p, q = (i + 1) % 3, (i + 2) % 3
            side[i] = (b[p] - a[p]) * n[q] - (b[q] - a[q]) * n[p]
            most += side[i] * a[i]
        count = clip(poly[which], count, poly[1 - which], side, most)
        which = 1 - which
        if count < 3:
            return 0
    if which == 1:
        for k in range(count):
            for c in range(3):
                poly[0, k, c] = poly[1, k, c]
    return count


@device
def stiffen(solids: Any, base: Any, face: Any, other: Any, margin: Any, rough: Any, desk: Any) -> None:
    """What a face of a solid adds to the stiffness of the particles of both: of all of the other in its column that is
    below its plane, or less above it than a margin, as it may come to press there."""
    bodies, _, planes = solids
    poly, hit, room = desk[0], desk[1][0], desk[2]
    n, shape, r = planes[int(bodies[base, PLANE]) + face], room[:3], room[4]
    plane = int(bodies[other, PLANE])
    for g in range(int(rows(bodies[other, TABLE], 1.0, WIDTH)[0, FACES])):
        normal, slope = planes[plane + g], 0.0
        for c in range(3):
            slope -= n[c] * normal[c]
        if slope <= 0.0:
            continue
        count = column(solids, base, face, take(solids, other, g, base, poly), poly, room[3])
        count = clip(poly[0], count, poly[1], n, n[3] + margin)
        for k in range(1, count - 1):
            area = slope * triangle(poly[1], 0, k, normal, shape)
            for s in range(3):
                for c in range(3):
                    r[c] = shape[s, c] + (bodies[base, c] - bodies[other, c])
                hit[OTHERS] += area * lever(bodies, other, r, n, rough)
                hit[OWN] += area * lever(bodies, base, shape[s], n, rough)


@device
def nearest_face(solids: Any, i: Any, j: Any) -> Any:
    """Of all faces of two solids that of which the other is the farthest above, or the least below."""
    least, whose, face = np.inf, j, 0
    for which in range(2):
        base, other = (j, i) if which == 0 else (i, j)
        plane = int(solids[0][base, PLANE])
        for r in range(int(rows(solids[0][base, TABLE], 1.0, WIDTH)[0, FACES])):
            below = under(solids, base, r + plane, other)
            if below < least:
                least, whose, face = below, base, r
    return whose, face


@device
def touch(solids: Any, i: Any, j: Any, margin: Any, rough: Any, quiet: Any, desk: Any) -> Any:
    """What two solids feel of each other, into the first row of the hits, counted from the centre of the second; False
    if it is nothing. `quiet` leaves out what they add to the stiffness."""
    hit = desk[1][0]
    least = overlap(solids, j, i, np.inf, 0.0 if quiet else margin)
    least = overlap(solids, i, j, least, 0.0 if quiet else margin)
    if least <= (0.0 if quiet else -margin):
        return False
    for k in range(HIT):
        hit[k] = 0.0
    hit[BASE] = -1.0
    base, face = j, 0
    count = bound(solids, i, j, desk) if least > 0.0 else 0
    if count > 0:
        centroid(solids[2], count, desk)
        base, face = reference(solids, i, j, desk[2][3])
        press(solids, base, face, j, count, desk)
        hit[BASE] = base
    elif not quiet:
        base, face = nearest_face(solids, i, j)
        hit[BASE] = base
    if not quiet:
        stiffen(solids, base, face, i + j - base, margin, rough, desk)
    return hit[BASE] >= 0.0
