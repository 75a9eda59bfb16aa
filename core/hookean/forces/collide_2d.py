"""Collide 2d: closed polygons in a plane that push each other apart; contacts of corners are shared with
`soft_collide`."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.compiled import dispatch
from hookean.compiled.marks import device
from hookean.errors import InputError
from hookean.forces import groups
from hookean.forces.base import Block, Floats, Force, Ints, Places, lengths, units
from hookean.forces.collide import Crowd
from hookean.forces.groups import begins, following
from hookean.values.columns import Direction, IndexRows, Lines
from hookean.values.fields import Field, Maybe

# columns of the parameters, after the links of a polygon: the row's number in its force, stiffness, skin, plane
CROWD, STRENGTH, SKIN, PLANE = 2, 3, 4, 5
SKIN_PART = 0.1  # of the mean edge: how far outside corners already count for the stiffness
U, V, T, INSIDE = 0, 1, 2, 3  # of a contact: from the nearest point to the corner, where on its edge, inside or not


@device
def prepare(x: Any, indices: Any, parameters: Any, flat: Any, box: Any, heads: Any) -> Any:
    """Write both ends of each edge in the plane (m, 4), the boxes of polygons at their first rows (m, 4), and these
    rows; returns how many polygons there are."""
    count = 0
    for e in range(indices.shape[0]):
        for c in range(4):
            flat[e, c] = 0.0
            for i in range(3):
                flat[e, c] += x[indices[e, c // 2], i] * parameters[e, PLANE + 3 * (c % 2) + i]
        if begins(parameters, e):
            heads[count] = e
            count += 1
    for i in range(count):
        first = e = heads[i]
        for c in range(2):
            box[first, c], box[first, 2 + c] = np.inf, -np.inf
        while e >= 0:
            for c in range(2):
                box[first, c] = min(box[first, c], flat[e, c])
                box[first, 2 + c] = max(box[first, 2 + c], flat[e, c])
            e = following(parameters, e)
    return count


@device
def within(box: Any, first: Any, u: Any, v: Any, skin: Any) -> Any:
    """Whether a point is in the box of a polygon or near it."""
    across = box[first, 0] - skin <= u <= box[first, 2] + skin
    return across and box[first, 1] - skin <= v <= box[first, 3] + skin


@device
def apart(parameters: Any, box: Any, a: Any, b: Any) -> Any:
    """Whether two polygons cannot touch, or are of different forces."""
    if a - int(parameters[a, CROWD]) != b - int(parameters[b, CROWD]):
        return True
    skin = parameters[a, SKIN]
    if box[a, 0] > box[b, 2] + skin or box[b, 0] > box[a, 2] + skin:
        return True
    return box[a, 1] > box[b, 3] + skin or box[b, 1] > box[a, 3] + skin


@device
def nearest_edge(parameters: Any, flat: Any, first: Any, u: Any, v: Any, spot: Any) -> Any:
    """The edge of a polygon that is nearest to a point, and what is in `spot` of it.

    Inside is where a ray crosses an odd number of edges; an edge counts where it passes the height of the point.
    """
    best, nearest, odd, e = np.inf, first, 0, first
    while e >= 0:
        a, b, c, d = flat[e, 0], flat[e, 1], flat[e, 2], flat[e, 3]
        if (b > v) != (d > v):
            at = a + (v - b) / (d - b) * (c - a) if d > b else c + (v - d) / (b - d) * (a - c)
            if at > u:
                odd = 1 - odd
        along, square = (u - a) * (c - a) + (v - b) * (d - b), (c - a) * (c - a) + (d - b) * (d - b)
        t = min(max(along / square, 0.0), 1.0) if square > 0.0 else 0.0
        p, q = u - a - t * (c - a), v - b - t * (d - b)
        if p * p + q * q < best:
            best, nearest = p * p + q * q, e
            spot[U], spot[V], spot[T] = p, q, t
        e = following(parameters, e)
    spot[INSIDE] = odd
    return nearest


def collide_2d_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy, spot, rows = 0.0, np.zeros(4), indices.shape[0]
    flat, box, heads = np.empty((rows, 4)), np.empty((rows, 4)), np.empty(rows, np.int64)
    count = prepare(x, indices, parameters, flat, box, heads)
    for i in range(count):
        for j in range(count):
            e, other = heads[i], heads[j]
            if i == j or apart(parameters, box, e, other):
                continue
            while e >= 0:
                if within(box, other, flat[e, 0], flat[e, 1], parameters[e, SKIN]):
                    near, k = (
                        nearest_edge(parameters, flat, other, flat[e, 0], flat[e, 1], spot),
                        parameters[e, STRENGTH],
                    )
                    square = spot[U] * spot[U] + spot[V] * spot[V]
                    # what nearly touches counts for the stiffness as well: it may before that is asked for again
                    if spot[INSIDE] == 1.0 or square < parameters[e, SKIN] * parameters[e, SKIN]:
                        push = k if spot[INSIDE] == 1.0 else 0.0
                        energy += 0.5 * push * square
                        for n in range(3):
                            a = indices[e, 0] if n == 0 else indices[near, n - 1]
                            share = 1.0 if n == 0 else spot[T] - 1.0 if n == 1 else -spot[T]
                            w[a] += 2.0 * k * np.abs(share)
                            for c in range(3):
                                away = spot[U] * parameters[e, PLANE + c] + spot[V] * parameters[e, PLANE + 3 + c]
                                f[a, c] -= push * share * away
                e = following(parameters, e)
    return energy


def contacts_2d(x, indices, parameters, pair, place):  # type: ignore[no-untyped-def]
    """Write the rows of a corner and of the edge that is nearest to it, where it is inside the polygon (k, 2), and
    where on that edge (k,), as many as there is place for; returns how many there are."""
    spot, rows, many = np.zeros(4), indices.shape[0], 0
    flat, box, heads = np.empty((rows, 4)), np.empty((rows, 4)), np.empty(rows, np.int64)
    count = prepare(x, indices, parameters, flat, box, heads)
    for i in range(count):
        for j in range(count):
            e, other = heads[i], heads[j]
            if i == j or apart(parameters, box, e, other):
                continue
            while e >= 0:
                if within(box, other, flat[e, 0], flat[e, 1], 0.0):
                    near = nearest_edge(parameters, flat, other, flat[e, 0], flat[e, 1], spot)
                    if spot[INSIDE] == 1.0:
                        if many < pair.shape[0]:
                            pair[many, 0], pair[many, 1], place[many] = e, near, spot[T]
                        many += 1
                e = following(parameters, e)
    return many


class Collide2d(Crowd):
    """Closed polygons in a plane that push each other apart: E = k d^2 / 2 for each corner of one inside another, d its
    distance to the nearest point of that one's outline.

    The corner is pushed by k d, and both ends of the edge by the opposite, shared as the point lies between them: the
    forces sum to zero, and so do their moments about the normal of the plane. Only what is square to `normal` counts:
    where polygons are at different heights above the plane, it holds the rest of the moments. Polygons are closed loops
    of edges, given head to tail in any order; each loop is one, and does not feel itself. Where sides cross without a
    corner inside, nothing is pushed: divide long sides. Polygons keep their shapes by other forces (springs,
    `rigid_body`, `polygon_area`). For one curve that stays where it is see `collide_curve`. Source: Kangaroo 2's
    Collide2d.
    """

    kind: Literal["collide_2d"] = "collide_2d"
    particles: Maybe[IndexRows] = Field(default=None, description="Edges of the polygons, pairs of particles")
    lines: Maybe[Lines] = Field(default=None, description="Straight edges of the polygons; their ends become particles")
    normal: Direction = Field(
        default=np.array([0.0, 0.0, 1.0]), description="Normal of the plane; its length is ignored"
    )
    strength: float = Field(default=1000.0, ge=0, le=1e12, description="k, stiffness of a contact [force/length]")

    formula: ClassVar[str] = "E = k d²/2"
    role: ClassVar[Literal["internal", "load", "support"]] = "support"
    arity: ClassVar[int] = 2
    creates: ClassVar[bool] = True
    shared: ClassVar[tuple[str, ...]] = ("normal",)
    kernel: ClassVar[Any] = staticmethod(collide_2d_kernel)

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: links of the polygons, place in the force, stiffness, skin, and axes of the plane."""
        index = places.elements(self)
        met = (index >= 0).all(axis=1)
        starts, ends = (np.sort(column) for column in index[met].T)
        if (starts != ends).any():
            raise InputError("", "the edges of a collide_2d are no closed loops; give closed polygons, head to tail")
        normal = units(self.normal)[0]
        u = np.cross(normal, np.eye(3)[np.argmin(np.abs(normal))])
        plane = [*units(u)[0], *np.cross(normal, units(u)[0])]
        reach = lengths(places.x[index[met, 1]] - places.x[index[met, 0]])
        return Block.of(
            index,
            links=groups.links(index, bodies(index)),
            crowd=numbered(met),
            strength=self.strength,
            skin=SKIN_PART * float(reach.mean()) if met.any() else 0.0,
            plane=np.ones((len(index), 1)) * [plane],
        )

    @classmethod
    def gathered(
        cls, block: Block, memory: Floats, x: Floats, node: int | None
    ) -> list[tuple[type[Force], Block]] | None:
        """Corners that are inside, each with both ends of its edge."""
        x, pair, at = np.ascontiguousarray(x), np.empty((0, 2), np.int64), np.empty(0)
        given = x, block.indices, block.parameters
        while (count := int(dispatch.compiled(contacts_2d)(*given, pair, at))) > len(pair):
            pair, at = np.empty((count, 2), np.int64), np.empty(count)
        if not len(pair):
            return []
        index = np.column_stack([block.indices[pair[:, 0], 0], block.indices[pair[:, 1]]])
        axes = block.parameters[pair[:, 0], PLANE : PLANE + 6].reshape(-1, 2, 3)
        share = np.column_stack([0.0 * at + 1.0, at - 1.0, -at])
        slides = ((at > 0.0) & (at < 1.0))[:, None]
        turns = np.tile([[[0.0, 1.0, -1.0]]], (len(at), 1, 1))
        k = block.parameters[pair[:, 0], STRENGTH]
        stiffness = contact_stiffness(k, x[index], share, turns, slides, np.einsum("mai,maj->mij", axes, axes))
        return [(groups.Whole, groups.stiff(index, stiffness))]

    @classmethod
    def example(cls) -> tuple[Collide2d, Floats]:
        """A pentagon and a quad with corners in each other, and a triangle with one in the quad, in a tilted plane."""
        flat = [[0, 0], [2, -0.1], [2.6, 1.5], [1, 2.4], [-0.4, 1.2], [1.7, 0.7], [4.2, 0.4], [4.5, 2.6], [2.2, 1.9]]
        flat += [[4.0, 1.4], [6.0, 0.2], [6.1, 2.0]]
        edges = [[0, 1], [1, 2], [2, 3], [3, 4], [4, 0], [5, 6], [6, 7], [7, 8], [8, 5], [9, 10], [10, 11], [11, 9]]
        axes = np.array([[1.0, 0.0, 0.2], [0.1, 1.0, 0.3]])
        force = cls(particles=edges, normal=np.cross(*axes), strength=50.0)
        return force, np.array(flat) @ axes


def bodies(index: Ints) -> Ints:
    """The number of the body of each element (m,): those that share particles, directly or by others, are one."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    count = int(index.max(initial=-1)) + 1
    met = index[(index >= 0).all(axis=1)]
    start, end = np.repeat(met[:, :1], index.shape[1], axis=1).ravel(), met.ravel()
    label = connected_components(coo_array((np.ones(len(start)), (start, end)), (count, count)), directed=False)[1]
    found: Ints = label.astype(np.int64)[index[:, 0]] if count else np.zeros(len(index), np.int64)
    return found


def numbered(met: Any) -> Ints:
    """How many of the elements that met particles (m,) are before each."""
    return np.asarray(np.cumsum(met) - met, np.int64)


def contact_stiffness(k: Floats, x: Floats, share: Floats, turns: Floats, slides: Any, plane: Floats) -> Floats:
    """Stiffness (m, 3 n, 3 n) of contacts with k |r|^2 / 2, r = sum share x in a plane, least by how the `share` (m, n)
    of particles x (m, n, 3) changes, by `turns` (m, q, n), where it `slides` (m, q): K_xx - K_xq K_qq^-1 K_qx."""
    x = np.einsum("mic,mcd->mid", x, plane)
    r = np.einsum("mi,mic->mc", share, x)
    ways = np.einsum("mqi,mic->mqc", turns, x)
    mixed = np.einsum("mi,mqc->mqic", share, ways) + np.einsum("mqi,mc->mqic", turns, r)
    mixed = np.where(slides[:, :, None], mixed.reshape(*turns.shape[:2], -1), 0.0)
    gram = np.einsum("mqc,mpc->mqp", ways, ways)
    gram = np.where(slides[:, :, None] & slides[:, None], gram, np.eye(turns.shape[1]))
    whole = np.einsum("mi,mj,mcd->micjd", share, share, plane).reshape(len(k), mixed.shape[2], mixed.shape[2])
    whole -= np.einsum("mqi,mqj->mij", mixed, np.linalg.solve(gram, mixed))
    return np.asarray(k[:, None, None] * whole)
