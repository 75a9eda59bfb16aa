"""Soft collide: closed meshes that deform and push each other apart."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.compiled import dispatch
from hookean.compiled.marks import device
from hookean.errors import InputError
from hookean.forces import groups
from hookean.forces.base import Block, Floats, Force, Places, lengths
from hookean.forces.collide import Crowd
from hookean.forces.collide_2d import SKIN_PART, bodies, contact_stiffness, numbered
from hookean.forces.collide_solid import solid
from hookean.forces.groups import begins, following
from hookean.values.fields import Field

# columns of the parameters, after the links of a body: the row's number in its force, stiffness, skin, and for which of
# its corners a triangle stands
CROWD, STRENGTH, SKIN, OWN = 2, 3, 4, 5
FLAT = 1e-12  # square of a sine below which a triangle has no inside


@device
def bound(x: Any, indices: Any, parameters: Any, box: Any, heads: Any) -> Any:
    """Write the boxes of bodies at their first rows (m, 6), and these rows; returns how many bodies there are."""
    count = 0
    for first in range(indices.shape[0]):
        if not begins(parameters, first):
            continue
        heads[count] = first
        count += 1
        for c in range(3):
            box[first, c], box[first, 3 + c] = np.inf, -np.inf
        e = first
        while e >= 0:
            for i in range(3):
                for c in range(3):
                    box[first, c] = min(box[first, c], x[indices[e, i], c])
                    box[first, 3 + c] = max(box[first, 3 + c], x[indices[e, i], c])
            e = following(parameters, e)
    return count


@device
def apart(parameters: Any, box: Any, a: Any, b: Any) -> Any:
    """Whether two bodies cannot touch, or are of different forces."""
    if a - int(parameters[a, CROWD]) != b - int(parameters[b, CROWD]):
        return True
    for c in range(3):
        if box[a, c] > box[b, 3 + c] + parameters[a, SKIN] or box[b, c] > box[a, 3 + c] + parameters[a, SKIN]:
            return True
    return False


@device
def within(box: Any, first: Any, p: Any, skin: Any) -> Any:
    """Whether a point is in the box of a body or near it."""
    inside = True
    for c in range(3):
        inside = inside and box[first, c] - skin <= p[c] <= box[first, 3 + c] + skin
    return inside


@device
def passes(a: Any, b: Any, p: Any) -> Any:
    """Whether in the plane of y and z the edge a-b passes the height of p beyond it along y. The same for b-a."""
    if (a[2] > p[2]) == (b[2] > p[2]):
        return False
    low, high = (a, b) if a[2] < b[2] else (b, a)
    return low[1] + (p[2] - low[2]) / (high[2] - low[2]) * (high[1] - low[1]) > p[1]


@device
def crosses(x: Any, indices: Any, e: Any, p: Any) -> Any:
    """Whether the ray from p along x crosses a triangle. Of two with a common edge it crosses one, on the edge too."""
    a, b, c = x[indices[e, 0]], x[indices[e, 1]], x[indices[e, 2]]
    if max(a[0], b[0], c[0]) <= p[0]:
        return False
    if (passes(a, b, p) != passes(b, c, p)) == passes(c, a, p):
        return False
    n = (b[1] - a[1]) * (c[2] - a[2]) - (b[2] - a[2]) * (c[1] - a[1])
    if n == 0.0:
        return False
    rest = (b[2] - a[2]) * (c[0] - a[0]) - (b[0] - a[0]) * (c[2] - a[2])
    rest *= p[1] - a[1]
    rest += ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) * (p[2] - a[2])
    return a[0] - rest / n > p[0]


@device
def on_face(x: Any, indices: Any, e: Any, p: Any, best: Any, share: Any) -> Any:
    """Squared distance of a point to a triangle and the share (3,) of its corners in the closest point; only if it is
    less than the best so far."""
    a, b, c = x[indices[e, 0]], x[indices[e, 1]], x[indices[e, 2]]
    for i in range(3):
        gap = max(min(a[i], b[i], c[i]) - p[i], p[i] - max(a[i], b[i], c[i]), 0.0)
        if gap * gap >= best:
            return np.inf
    uu, uv, vv, pu, pv = 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(3):
        u, v, r = b[i] - a[i], c[i] - a[i], p[i] - a[i]
        uu, uv, vv, pu, pv = uu + u * u, uv + u * v, vv + v * v, pu + u * r, pv + v * r
    det, found = uu * vv - uv * uv, np.inf
    if det > FLAT * uu * vv:
        s, t = (vv * pu - uv * pv) / det, (uu * pv - uv * pu) / det
        if s > 0.0 and t > 0.0 and s + t < 1.0:
            share[0], share[1], share[2] = 1.0 - s - t, s, t
            found = 0.0
            for i in range(3):
                d = p[i] - share[0] * a[i] - s * b[i] - t * c[i]
                found += d * d
            return found
    for k in range(3):
        start, end = x[indices[e, k]], x[indices[e, (k + 1) % 3]]
        along, square, distance = 0.0, 0.0, 0.0
        for i in range(3):
            along += (p[i] - start[i]) * (end[i] - start[i])
            square += (end[i] - start[i]) * (end[i] - start[i])
        t = min(max(along / square, 0.0), 1.0) if square > 0.0 else 0.0
        for i in range(3):
            d = p[i] - (1.0 - t) * start[i] - t * end[i]
            distance += d * d
        if distance < found:
            found = distance
            share[k], share[(k + 1) % 3], share[(k + 2) % 3] = 1.0 - t, t, 0.0
    return found


@device
def nearest_face(x: Any, indices: Any, parameters: Any, first: Any, p: Any, share: Any, spare: Any) -> Any:
    """The triangle of a body that is nearest to a point, the square of its distance, and whether it is inside: where a
    ray crosses an odd number of triangles."""
    best, nearest, odd, e = np.inf, first, False, first
    while e >= 0:
        odd = odd != crosses(x, indices, e, p)
        square = on_face(x, indices, e, p, best, spare)
        if square < best:
            best, nearest = square, e
            for i in range(3):
                share[i] = spare[i]
        e = following(parameters, e)
    return nearest, best, odd


def soft_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy, room, rows = 0.0, np.zeros((3, 3)), indices.shape[0]
    box, heads = np.empty((rows, 6)), np.empty(rows, np.int64)
    share, spare, away = room[0], room[1], room[2]
    count = bound(x, indices, parameters, box, heads)
    for n in range(count * count):
        e, other = heads[n // count], heads[n % count]
        if e == other or apart(parameters, box, e, other):
            continue
        while e >= 0:
            for i in range(3):
                a, k, skin = indices[e, i], parameters[e, STRENGTH], parameters[e, SKIN]
                if parameters[e, OWN + i] == 0.0 or not within(box, other, x[a], skin):
                    continue
                near, square, inside = nearest_face(x, indices, parameters, other, x[a], share, spare)
                # what nearly touches counts for the stiffness as well: it may before that is asked for again
                if not inside and square >= skin * skin:
                    continue
                push = k if inside else 0.0
                energy += 0.5 * push * square
                w[a] += 2.0 * k
                for c in range(3):
                    away[c] = x[a, c]
                    for j in range(3):
                        away[c] -= share[j] * x[indices[near, j], c]
                    f[a, c] -= push * away[c]
                for j in range(3):
                    w[indices[near, j]] += 2.0 * k * share[j]
                    for c in range(3):
                        f[indices[near, j], c] += push * share[j] * away[c]
            e = following(parameters, e)
    return energy


def soft_contacts(x, indices, parameters, pair, place):  # type: ignore[no-untyped-def]
    """Write the rows of a corner and of the triangle that is nearest to it, and which corner, where it is inside the
    body (k, 3), and the share of the triangle's corners (k, 3), as many as there is place for; returns how many."""
    room, rows, many = np.zeros((2, 3)), indices.shape[0], 0
    box, heads = np.empty((rows, 6)), np.empty(rows, np.int64)
    count = bound(x, indices, parameters, box, heads)
    for n in range(count * count):
        e, other = heads[n // count], heads[n % count]
        if e == other or apart(parameters, box, e, other):
            continue
        while e >= 0:
            for i in range(3):
                if parameters[e, OWN + i] == 0.0 or not within(box, other, x[indices[e, i]], 0.0):
                    continue
                near, _, inside = nearest_face(x, indices, parameters, other, x[indices[e, i]], room[0], room[1])
                if inside:
                    if many < pair.shape[0]:
                        pair[many, 0], pair[many, 1], pair[many, 2] = e, near, i
                        for c in range(3):
                            place[many, c] = room[0, c]
                    many += 1
            e = following(parameters, e)
    return many


class SoftCollide(Crowd):
    """Closed meshes that deform and push each other apart: E = k d^2 / 2 for each vertex of one inside another, d its
    distance to the nearest point of that one's surface.

    The vertex is pushed by k d, and the corners of the nearest face by the opposite, shared by the barycentric
    coordinates of the point: forces and moments sum to zero. The bodies are the parts of one mesh that are not joined:
    each is closed, and does not feel itself. Quads are cut along the diagonal that leaves no sliver at the start. Where
    edges cross without a vertex inside, nothing is pushed: sharp bodies need fine meshes. Bodies keep their shapes by
    other forces (springs, `volume`, `rigid_body`). For a solid that stays where it is see `collide_solid`. Sources:
    Ericson, Real-Time Collision Detection, 2005, 5.1.5 (closest points); Kangaroo 2's SoftBodyCollide.
    """

    kind: Literal["soft_collide"] = "soft_collide"
    mesh: str = Field(description="Name of a mesh of two closed bodies or more")
    strength: float = Field(default=1000.0, ge=0, le=1e12, description="k, stiffness of a contact [force/length]")

    formula: ClassVar[str] = "E = k d²/2"
    arity: ClassVar[int] = 3
    kernel: ClassVar[Any] = staticmethod(soft_kernel)
    example_faces: ClassVar[list[list[int]]] = [
        *([0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]),
        *([4, 6, 5], [4, 5, 7], [5, 6, 7], [6, 4, 7]),
    ]

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: links of the bodies, place in the force, stiffness, skin, corners of each triangle."""
        faces = places.faces(self.mesh)
        if len(faces) and not (faces >= 0).all(axis=1).any():
            said = "no face has particles at all of its corners; put a force on this mesh, or particles at its vertices"
            raise InputError(f"/meshes/{self.mesh}/faces", said)
        triangles, reason = solid(places.x, faces[(faces >= 0).all(axis=1)])
        if reason:
            raise InputError(f"/meshes/{self.mesh}/faces", reason)
        first = np.unique(triangles.ravel(), return_index=True)[1]
        own = np.zeros(triangles.size)
        own[first] = 1.0
        edges = lengths((places.x[triangles] - places.x[np.roll(triangles, 1, axis=1)]).reshape(-1, 3))
        return Block.of(
            triangles,
            links=groups.links(triangles, bodies(triangles)),
            crowd=numbered(np.ones(len(triangles), bool)),
            strength=self.strength,
            skin=SKIN_PART * float(edges.mean()),
            own=own.reshape(-1, 3),
        )

    @classmethod
    def gathered(
        cls, block: Block, memory: Floats, x: Floats, node: int | None
    ) -> list[tuple[type[Force], Block]] | None:
        """Vertices that are inside, each with the corners of its face."""
        x, pair, at = np.ascontiguousarray(x), np.empty((0, 3), np.int64), np.empty((0, 3))
        given = x, block.indices, block.parameters
        while (count := int(dispatch.compiled(soft_contacts)(*given, pair, at))) > len(pair):
            pair, at = np.empty((count, 3), np.int64), np.empty((count, 3))
        if not len(pair):
            return []
        index = np.column_stack([block.indices[pair[:, 0], pair[:, 2]], block.indices[pair[:, 1]]])
        share = np.column_stack([np.ones(len(at)), -at])
        # along two sides within a face, along one on an edge: from the corner with the largest share
        order = np.argsort(-at, axis=1, kind="stable")
        turns, each = np.zeros((len(at), 2, 4)), np.arange(len(at))
        for q in range(2):
            turns[each, q, 1 + order[:, 0]] = 1.0
            turns[each, q, 1 + order[:, 1 + q]] = -1.0
        slides = np.take_along_axis(at, order[:, 1:], axis=1) > 0.0
        plane = np.tile(np.eye(3), (len(at), 1, 1))
        stiffness = contact_stiffness(block.parameters[pair[:, 0], STRENGTH], x[index], share, turns, slides, plane)
        return [(groups.Whole, groups.stiff(index, stiffness))]

    @classmethod
    def example(cls) -> tuple[SoftCollide, Floats]:
        """Two tetrahedra with a vertex in each other."""
        x = [[0, 0, 0], [3, 0.2, 0.1], [1.2, 2.8, -0.1], [1.3, 0.9, 2.4]]
        x += [[1.1, 1.0, 1.5], [3.5, 0.4, 3.9], [1.6, 3.2, 4.1], [0.2, 0.3, 3.8]]
        return cls(mesh="skin", strength=50.0), np.array(x)
