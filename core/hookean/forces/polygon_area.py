"""Polygon area: closed polygons that keep an area."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from hookean.compiled import dispatch
from hookean.compiled.marks import device
from hookean.errors import InputError
from hookean.forces import groups
from hookean.forces.base import Block, Floats, Force, Ints, Places
from hookean.forces.groups import begins, following
from hookean.values.columns import IndexRows, Labels, Lines
from hookean.values.fields import Field, Maybe

STIFF, START = 2, 3  # columns of the parameters, after the links
LEAST = 1e-3  # part of the area wanted, from which on steps are as for there
LARGEST = 100  # edges of a polygon up to which it is one element of a tangent


@device
def enclose(x: Any, indices: Any, parameters: Any, first: Any, n: Any) -> Any:
    """Area and length of a polygon, and its unit normal into `n`; 0, 0, 0 where it has no area."""
    start, length = indices[first, 0], 0.0
    for i in range(3):
        n[i] = 0.0
    e = first
    while e >= 0:
        a, b, square = indices[e, 0], indices[e, 1], 0.0
        for i in range(3):
            j, k = (i + 1) % 3, (i + 2) % 3
            n[i] += 0.5 * ((x[a, j] - x[start, j]) * (x[b, k] - x[start, k]))
            n[i] -= 0.5 * ((x[a, k] - x[start, k]) * (x[b, j] - x[start, j]))
            square += (x[b, i] - x[a, i]) * (x[b, i] - x[a, i])
        length += np.sqrt(square)
        e = following(parameters, e)
    area = np.sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2])
    for i in range(3):
        n[i] = n[i] / area if area > 0.0 else 0.0
    return area, length


def polygon_area_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy, n = 0.0, np.zeros(3)
    for first in range(indices.shape[0]):
        if not begins(parameters, first):
            continue
        stiff, wanted, start = parameters[first, STIFF], parameters[first, START], indices[first, 0]
        area, length = enclose(x, indices, parameters, first, n)
        apart = (area - wanted) / wanted
        energy += 0.5 * stiff * apart * apart * wanted
        pull = -stiff * apart
        # as stiff as on the way to the area wanted, and twice that: the tangent has one stiff mode (see `enclosed`)
        rate = 2.0 * stiff / wanted * max(1.0, wanted / max(area, LEAST * wanted))
        if pull < 0.0:
            rate -= pull / area  # the normal turns
        e = first
        while e >= 0:
            a, b, square = indices[e, 0], indices[e, 1], 0.0
            for i in range(3):
                j, k = (i + 1) % 3, (i + 2) % 3
                square += (x[b, i] - x[a, i]) * (x[b, i] - x[a, i])
                f[a, i] += 0.5 * pull * ((x[b, j] - x[start, j]) * n[k] - (x[b, k] - x[start, k]) * n[j])
                f[b, i] += 0.5 * pull * (n[j] * (x[a, k] - x[start, k]) - n[k] * (x[a, j] - x[start, j]))
            bound = 0.5 * rate * np.sqrt(square) * length + 0.5 * np.abs(pull)
            w[a] += bound
            w[b] += bound
            e = following(parameters, e)
    return energy


class PolygonArea(groups.Grouped):
    """Closed polygons that resist a change of their area A: E = K (A - A0)^2 / (2 A0), K [force/length].

    A is the size of the area vector, sum (a x b) / 2 over the edges a-b: of a polygon that is not flat the area of
    its largest flat shadow. Edges of a polygon are given head to tail, in any order; each polygon is a group. A0 is
    the area at the start times a factor. Forces and moments sum to zero; each edge is pushed square to itself
    within the plane, by K (A0 - A) / A0 times its length. Polygons of more than 100 edges have no tangent: such
    models relax, and their stability is unknown.
    """

    kind: Literal["polygon_area"] = "polygon_area"
    particles: Maybe[IndexRows] = Field(default=None, description="Edges, pairs of particles")
    lines: Maybe[Lines] = Field(default=None, description="Straight edges; their ends become particles")
    group: Maybe[Labels] = Field(default=None, description="Number of the polygon of each edge; default: all are one")
    stiffness: float = Field(default=1000.0, ge=0, le=1e12, description="K [force/length]")
    area_factor: float = Field(default=1.0, ge=1e-6, le=1e6, description="Factor on the area at the start [-]")

    formula: ClassVar[str] = "E = K (A - A0)²/(2 A0)"
    arity: ClassVar[int] = 2
    solid: ClassVar[bool] = False
    outputs: ClassVar[dict[str, str]] = {"area": "", "force": "force"}
    kernel: ClassVar[Any] = staticmethod(polygon_area_kernel)

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: links of the groups, K and A0; InputError unless polygons are closed and have area."""
        index = places.elements(self)
        links, met = groups.links(index, self.group), (index >= 0).all(axis=1)
        block = Block.of(index, links=links, stiffness=self.stiffness, area=1.0)
        block = Block(block.indices[met], block.parameters[met], block.memory[met], block.names)
        head, size = groups.heads(block), len(places.x)
        out, into = (np.sort(head * size + end) for end in block.indices.T)
        if (out != into).any():
            at = int(out[np.argmax(out != into)] % size)
            raise InputError("", f"the edges of a polygon_area are open near particle {at}; give closed polygons")
        area = self.area_factor * areas(block, places.x)
        if not (area > 0.0).all():
            raise InputError("", "a polygon of a polygon_area has no area at the start; give it a shape with area")
        found = np.zeros(len(index))
        found[met] = area
        return Block.of(index, links=links, stiffness=self.stiffness, area=np.where(met, found, 1.0))

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """Area of the polygon of each edge [length^2], and the force on the edge [force]."""
        return {"area": areas(block, x), "force": element_forces.sum(axis=1)}

    @classmethod
    def gathered(
        cls, block: Block, memory: Floats, x: Floats, node: int | None
    ) -> list[tuple[type[Force], Block]] | None:
        """Whole polygons; particles of large ones by themselves, as stiff as they feel: a bound from above."""
        found: list[tuple[type[Force], Block]] = []
        for row in (row for rows in groups.by_size(block) for row in rows):
            own, place = np.unique(block.indices[row], return_inverse=True)
            if len(row) <= LARGEST:
                numbers = np.concatenate([block.parameters[row[0], STIFF:], place.ravel()])
                found.append((Framed, Block(own[None, :], numbers[None, :], np.zeros((1, 0)))))
                continue
            part, w = cls.taken(block, row[:1])[1], np.zeros(len(x))
            still = np.zeros_like(x)
            dispatch.compiled(cls.kernel, "force")(
                x, still, part.indices, part.parameters, part.memory, still.copy(), w
            )
            found.append((groups.Whole, groups.bounded(own[:, None], w[own])))
        return found

    @classmethod
    def no_tangent(cls, block: Block, *, sparse: bool) -> str:
        """All particles of a polygon feel one another, whichever unknowns there are."""
        most = int(np.unique(groups.heads(block), return_counts=True)[1].max(initial=0))
        return f"a polygon of {most} edges that keeps its area is too large for a tangent" if most > LARGEST else ""

    @classmethod
    def example(cls) -> tuple[PolygonArea, Floats]:
        """A pentagon and a quad, neither of them flat, with more area than they want."""
        x = [[0, 0.1, 0], [2.1, 0, 0.3], [2.6, 1.5, 0.1], [1, 2.4, -0.2], [-0.4, 1.2, 0.2]]
        x += [[5, 0, 1], [5.2, 2.0, 1.1], [5.1, 2.1, 3.4], [5, -0.2, 3.0]]
        edges = [[0, 1], [1, 2], [2, 3], [3, 4], [4, 0], [5, 6], [6, 7], [7, 8], [8, 5]]
        return cls(particles=edges, group=[0] * 5 + [1] * 4, stiffness=5.0, area_factor=0.8), np.array(x)


class Framed(Force):
    """Whole polygons as elements of any number of particles: for their tangents alone."""

    tangent: ClassVar[Any] = staticmethod(lambda block, x: _stiffness(block, x))


def areas(block: Block, x: Floats) -> Floats:
    """The area of the polygon of each edge (m,)."""
    head: Ints = groups.heads(block)
    a, b = (x[end] - x[block.indices[head, 0]] for end in block.indices.T)
    own = 0.5 * np.cross(a, b)
    vector = np.column_stack([np.bincount(head, part, len(head)) for part in own.T])
    return np.asarray(np.linalg.norm(vector, axis=1)[head])


def _turning(vectors: Floats) -> Floats:
    """Matrices (m, 3, 3) of the cross products with vectors (m, 3) from the left."""
    return np.asarray(np.cross(vectors[:, None], np.eye(3)).transpose(0, 2, 1))


def _stiffness(block: Block, x: Floats) -> Floats:
    """Stiffness (k, 3 n, 3 n) of polygons: K / A0 g g + E' d2A, g = n Da the gradient of the area, with Da that of the
    area vector and d2A = n d2a + Da (1 - n n) Da / A."""
    found = np.zeros((len(block.indices), 3 * block.indices.shape[1], 3 * block.indices.shape[1]))
    for own, parameters, whole in zip(block.indices, block.parameters, found, strict=True):
        stiff, wanted = parameters[:2]
        ends, place = parameters[2:].astype(np.int64).reshape(-1, 2), x[own] - x[own[0]]
        vector = 0.5 * np.cross(place[ends[:, 0]], place[ends[:, 1]]).sum(axis=0)
        area = float(np.linalg.norm(vector))
        if area == 0.0:
            continue
        normal, slope = vector / area, np.zeros((len(own), 3, 3))  # slope[i] = transposed d a / d x_i
        np.add.at(slope, ends[:, 0], 0.5 * _turning(place[ends[:, 1]]))
        np.add.at(slope, ends[:, 1], -0.5 * _turning(place[ends[:, 0]]))
        flat = slope.reshape(-1, 3)
        first, more = flat @ normal, stiff * (area - wanted) / wanted
        across = flat @ (np.eye(3) - np.outer(normal, normal)) @ flat.T / area
        turn, blocks = 0.5 * more * _turning(normal[None])[0], whole.reshape(len(own), 3, len(own), 3)
        for a, b in ends:
            blocks[a, :, b] -= turn
            blocks[b, :, a] += turn
        whole += stiff / wanted * np.outer(first, first) + more * across
    return found
