"""Pulls particles onto a mesh, each to the point of it that is closest; the search is shared with `pull_to_curve` and
contacts with solids."""

from __future__ import annotations

from typing import Any, ClassVar, Literal, Self

import numpy as np
from pydantic import model_validator

from hookean.compiled.dispatch import keep, rows
from hookean.compiled.marks import device
from hookean.errors import InputError
from hookean.forces.base import Block, Floats, Force, Ints, OnFilm, Places
from hookean.values.columns import Faces, IndexRows, NonNegatives, Points, fault
from hookean.values.fields import Field, Maybe

WIDTH = 10  # columns of a tree's table
LEAF = 4  # triangles in a leaf
DEEPEST = 64  # of the tree: it is halved at every level
CORNER, EDGE, FACE = 0, 3, 6  # what of a triangle is closest: a corner from 0, an edge from 3 (from that corner), it


@device
def on_segment(a, b, p, at, axis) -> Any:  # type: ignore[no-untyped-def]
    # closest point `at` of a-b to p, and what is left free: axis = the unit direction within a-b, else 0 (an end).
    # Returns the squared distance and how far along it is, from 0 to 1.
    ee = 0.0
    along = 0.0
    for c in range(3):
        ee += (b[c] - a[c]) * (b[c] - a[c])
        along += (p[c] - a[c]) * (b[c] - a[c])
    t = 0.0
    if along > 0.0 and ee > 0.0:
        t = 1.0 if along >= ee else along / ee
    free = 0.0 < t < 1.0
    apart = 0.0
    for c in range(3):
        # from the nearer end, so that ends are met exactly
        at[c] = a[c] + t * (b[c] - a[c]) if t <= 0.5 else b[c] + (t - 1.0) * (b[c] - a[c])
        axis[c] = (b[c] - a[c]) / np.sqrt(ee) if free else 0.0
        apart += (p[c] - at[c]) * (p[c] - at[c])
    return apart, t


@device
def on_triangle(t, row, p, at, axis, spare, spare_axis) -> Any:  # type: ignore[no-untyped-def]
    # the same for the triangle in a row of a table; returns the squared distance and what is closest: FACE (axis = its
    # normal), from EDGE on which edge (axis = its direction), else which corner
    a = t[row, 0:3]
    n = spare
    e = spare_axis
    for c in range(3):
        u = (c + 1) % 3
        d = (c + 2) % 3
        n[c] = (t[row, 3 + u] - a[u]) * (t[row, 6 + d] - a[d]) - (t[row, 3 + d] - a[d]) * (t[row, 6 + u] - a[u])
    nn = n[0] * n[0] + n[1] * n[1] + n[2] * n[2]
    if nn > 1e-280:
        inside = True
        height = 0.0
        for c in range(3):
            height += (p[c] - a[c]) * n[c]
        for i in range(3):
            j = 3 * ((i + 1) % 3)
            turn = 0.0
            for c in range(3):
                u = (c + 1) % 3
                d = (c + 2) % 3
                e[c] = (t[row, j + u] - t[row, 3 * i + u]) * (p[d] - t[row, 3 * i + d])
                e[c] -= (t[row, j + d] - t[row, 3 * i + d]) * (p[u] - t[row, 3 * i + u])
                turn += n[c] * e[c]
            inside = inside and turn > 0.0
        if inside:
            length = np.sqrt(nn)
            for c in range(3):
                axis[c] = n[c] / length
                at[c] = p[c] - height / length * axis[c]
            return (height / length) * (height / length), FACE
    best = np.inf
    part = CORNER
    for i in range(3):
        j = 3 * ((i + 1) % 3)
        apart, along = on_segment(t[row, 3 * i : 3 * i + 3], t[row, j : j + 3], p, spare, spare_axis)
        if apart < best:
            best = apart
            part = EDGE + i if 0.0 < along < 1.0 else CORNER + (i if along <= 0.5 else (i + 1) % 3)
            for c in range(3):
                at[c] = spare[c]
                axis[c] = spare_axis[c]
    return best, part


@device
def box_distance(t, row, p) -> Any:  # type: ignore[no-untyped-def]
    # squared distance of a box to p, 0 inside
    apart = 0.0
    for c in range(3):
        out = max(t[row, c] - p[c], p[c] - t[row, 3 + c], 0.0)
        apart += out * out
    return apart


@device
def beyond_triangle(t, row, p) -> Any:  # type: ignore[no-untyped-def]
    # squared distance of the box about a triangle to p, 0 inside: many times quicker than that of the triangle
    apart = 0.0
    for c in range(3):
        low = min(t[row, c], t[row, 3 + c], t[row, 6 + c])
        high = max(t[row, c], t[row, 3 + c], t[row, 6 + c])
        out = max(low - p[c], p[c] - high, 0.0)
        apart += out * out
    return apart


@device
def closest(t, p, at, axis, room, stack, most) -> Any:  # type: ignore[no-untyped-def]
    # closest point `at` to p of the triangles in a tree's table; equal distances: the triangle given first.
    # Returns which part of which triangle is closest, as `on_triangle`. `room` (4, 3) and `stack` are to work in.
    # `most`: more than the squared distance, where that is known.
    found = room[0]
    found_axis = room[1]
    stack[0] = 0
    best = most
    first = np.inf
    part = CORNER
    top = 1
    while top > 0:
        top -= 1
        node = stack[top]
        # a little wider, so that rounding of the boxes never hides an equally near triangle
        if box_distance(t, node, p) > best * (1.0 + 1e-12):
            continue
        start = int(t[node, 6])
        count = int(t[node, 7])
        if count == 0:
            other = int(t[node, 8])
            near, far = start, other
            if box_distance(t, other, p) < box_distance(t, start, p):
                near, far = other, start
            stack[top] = far
            stack[top + 1] = near
            top += 2
            continue
        for row in range(start, start + count):
            if beyond_triangle(t, row, p) > best * (1.0 + 1e-12):
                continue
            apart, which = on_triangle(t, row, p, found, found_axis, room[2], room[3])
            if apart < best or (apart == best and t[row, 9] < first):
                best = apart
                first = t[row, 9]
                part = which
                for c in range(3):
                    at[c] = found[c]
                    axis[c] = found_axis[c]
    return part, int(first) if first < np.inf else 0


def pull_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy = 0.0
    room = np.zeros((6, 3))
    stack = np.zeros(2 * DEEPEST, np.int64)
    at = room[4]
    axis = room[5]
    for e in range(indices.shape[0]):
        a = indices[e, 0]
        strength = parameters[e, 0]
        if strength == 0.0:
            continue
        closest(rows(parameters[e, 1], parameters[e, 2], WIDTH), x[a], at, axis, room, stack, np.inf)
        w[a] += strength
        for c in range(3):
            d = at[c] - x[a, c]
            f[a, c] += strength * d
            energy += 0.5 * strength * d * d
    return energy


def pull_hessian(x, indices, parameters, memory, blocks):  # type: ignore[no-untyped-def]
    room = np.zeros((6, 3))
    stack = np.zeros(2 * DEEPEST, np.int64)
    at = room[4]
    axis = room[5]
    for e in range(indices.shape[0]):
        tree_rows = rows(parameters[e, 1], parameters[e, 2], WIDTH)
        part, _ = closest(tree_rows, x[indices[e, 0]], at, axis, room, stack, np.inf)
        for i in range(3):
            for j in range(3):
                entry = axis[i] * axis[j]
                if part < FACE:
                    entry = (1.0 if i == j else 0.0) - entry
                blocks[e, i, j] = parameters[e, 0] * entry


class Pull(Force):
    """Base of forces that pull particles to what stays where it is."""

    kind: str = ""
    particles: Maybe[IndexRows] = Field(default=None, description="Pulled particles")
    points: Maybe[Points] = Field(default=None, description="Coordinates of pulled particles")

    role: ClassVar[Literal["internal", "load", "support"]] = "support"
    creates: ClassVar[bool] = False
    steady: ClassVar[str] = "strength"
    on_film: ClassVar[OnFilm] = "spread"
    outputs: ClassVar[dict[str, str]] = {"distance": "length", "force": "force"}

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """Distance to the target [length] and the force on the particle [force]."""
        return away(block, element_forces)


class ToMesh(Force):
    """Base of forces between particles and a mesh that itself stays where it is: the fields that name both."""

    particles: Maybe[IndexRows] = Field(default=None, description="Particles on which it acts")
    points: Maybe[Points] = Field(default=None, description="Coordinates of these particles")
    mesh: str | None = Field(default=None, description="Name of a mesh on whose vertices it acts")
    target: str | None = Field(default=None, description="Name of the scene's mesh that stays where it is")
    vertices: Maybe[Points] = Field(default=None, description="Or that mesh's vertices [length]")
    faces: Maybe[Faces] = Field(default=None, description="and its faces, three or four vertices each")

    role: ClassVar[Literal["internal", "load", "support"]] = "support"
    creates: ClassVar[bool] = False
    shared: ClassVar[tuple[str, ...]] = ("vertices", "faces")
    on_film: ClassVar[OnFilm] = "spread"
    example_faces: ClassVar[list[list[int]]] = []

    @model_validator(mode="after")
    def _one_target(self) -> Self:
        if (self.target is None) == (self.vertices is None) or (self.vertices is None) != (self.faces is None):
            raise fault("give the name of a mesh as target, or vertices and faces")
        if self.vertices is not None and self.faces is not None:
            if not len(self.faces):
                raise fault("a target without faces given; give at least one", "/faces")
            if (self.faces >= len(self.vertices)).any():
                raise fault(f"a vertex beyond the last of {len(self.vertices)} given, counted from 0", "/faces")
        return self

    def geometry(self, places: Places) -> tuple[Floats, Ints]:
        """Vertices (n, 3) and faces (m, 4) of the target; InputError where it has no faces."""
        if self.vertices is not None and self.faces is not None:
            return self.vertices, self.faces
        vertices, faces = places.geometry(str(self.target))
        if not len(faces):
            raise InputError(f"/meshes/{self.target}/faces", "a target without faces given; give at least one")
        return vertices, faces


class PullToMesh(ToMesh):
    """Particles pulled to the closest point C of a mesh that itself stays where it is: E = S |C - x|^2 / 2.

    The target is one of the scene's meshes by name, or vertices and faces of its own; it makes no particles and does
    not move with any. Quads count as both of their cuts into triangles. Of points equally near, that on the triangle
    given first is taken. A particle rests at a distance load / S from the mesh; a strength of 0 has no effect (it
    is not a hard constraint). Pulls do not know inside from outside (`collide_solid` does). Source: Ericson, Real-Time
    Collision Detection, 2005, chapters 5 and 6 (closest points, trees of boxes).
    """

    kind: Literal["pull_to_mesh"] = "pull_to_mesh"
    strength: NonNegatives = Field(default=1000.0, description="S [force/length]")

    formula: ClassVar[str] = "E = S |C - x|²/2"
    steady: ClassVar[str] = "strength"
    outputs: ClassVar[dict[str, str]] = {"distance": "length", "force": "force"}
    kernel: ClassVar[Any] = staticmethod(pull_kernel)
    hessian: ClassVar[Any] = staticmethod(pull_hessian)

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: strength, address and rows of the target's tree."""
        vertices, faces = self.geometry(places)
        return pulls(places.elements(self), self.strength, *tree(vertices[cuts(faces)]))

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """Distance to the target [length] and the force on the particle [force]."""
        return away(block, element_forces)

    @classmethod
    def example(cls) -> tuple[PullToMesh, Floats]:
        """Three particles about a roof of two faces: above a face, beyond an edge and off a corner."""
        vertices = [[-2, -2, 0], [2, -2, 0], [2, 2, 1], [-2, 2, 1.0], [0, 5, -3]]
        x = [[0.3, -0.5, 2.0], [4.0, 0.2, 0.5], [-4.0, -5.0, 1.0]]
        faces = [[0, 1, 2], [0, 2, 3], [3, 2, 4]]
        return cls(particles=[0, 1, 2], vertices=vertices, faces=faces, strength=[100.0, 20.0, 3.0]), np.array(x)


def cuts(faces: Ints) -> Ints:
    """Triangles (m, 3) of faces (k, 4), a quad cut along both diagonals."""
    quad = faces[:, 2] != faces[:, 3]
    both = np.stack([faces[:, [0, 1, 2]], faces[:, [0, 2, 3]], faces[:, [0, 1, 3]], faces[:, [1, 2, 3]]], axis=1)
    return np.ascontiguousarray(both[np.stack([np.ones_like(quad), quad, quad, quad], axis=1)])


def pulls(index: Ints, strength: float | Floats, address: float, size: int) -> Block:
    """The block of a pull to a kept tree."""
    return Block.of(index, strength=strength, tree=np.tile([address, float(size)], (len(index), 1)))


def away(block: Block, element_forces: Floats, column: int = 0) -> dict[str, Floats]:
    """Distance to the target [length] and force [force] of every pull, its strength in a column."""
    force = element_forces[:, 0]
    strength = block.parameters[:, column]
    distance = np.linalg.norm(force, axis=1) / np.where(strength > 0, strength, 1.0)
    return {"distance": distance, "force": force}


def tree(corners: Floats) -> tuple[float, int]:
    """A tree of boxes about triangles (m, 3, 3), kept for kernels: address and rows of its table.

    Rows are boxes, then triangles. A box: low (3), high (3), first child or triangle, triangles (0: has children),
    second child, 0. A triangle: corners (9), its number.
    """
    middle = corners.mean(axis=1)
    boxes: list[list[float]] = []
    order: list[Ints] = []

    def grow(chosen: Ints) -> int:
        here = len(boxes)
        low, high = corners[chosen].min(axis=(0, 1)), corners[chosen].max(axis=(0, 1))
        boxes.append([*low, *high, 0.0, float(len(chosen)), 0.0, 0.0])
        if len(chosen) <= LEAF:
            boxes[here][6] = float(sum(len(o) for o in order))
            order.append(chosen)
            return here
        wide = int(np.argmax(np.ptp(middle[chosen], axis=0)))
        chosen = chosen[np.argsort(middle[chosen, wide], kind="stable")]
        half = len(chosen) // 2
        boxes[here][7] = 0.0
        boxes[here][6], boxes[here][8] = float(grow(chosen[:half])), float(grow(chosen[half:]))
        return here

    grow(np.arange(len(corners)))
    table = np.array(boxes)
    leaf = table[:, 7] > 0
    table[leaf, 6] += len(table)
    number = np.concatenate(order)
    triangles = np.column_stack([corners[number].reshape(-1, 9), number.astype(np.float64)])
    whole = np.concatenate([table, triangles])
    return keep(whole), len(whole)
