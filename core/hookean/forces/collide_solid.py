"""Collide solid: spheres that do not enter a closed mesh, or do not leave it; shared with `collide_curve`."""

from __future__ import annotations

from typing import Any, ClassVar, Literal, Self

import numpy as np
from pydantic import model_validator

from hookean.compiled.dispatch import compiled, keep, rows
from hookean.compiled.marks import device
from hookean.errors import InputError
from hookean.forces.base import Block, Floats, Ints, Places, lengths
from hookean.forces.clearance import bounds, kept, middles
from hookean.forces.enclosed import unclosed, volumes
from hookean.forces.pull_to_mesh import DEEPEST, EDGE, FACE, WIDTH, ToMesh, box_distance, closest, tree
from hookean.values import near
from hookean.values.columns import NonNegatives, fault
from hookean.values.fields import Field

STRENGTH, RADIUS, SIDE, NORMAL, TREE, NORMALS, GRID = 0, 1, 2, 3, 6, 8, 10  # columns of the parameters
PARTS = 21  # columns of the table of normals: x y z at three corners, on three edges, on the face
NEAREST = 1e-12  # part of its coordinates: what is nearer to an edge or corner has no direction from it
CLOSE = 1e-9  # part of the width of a grid: bounds of distances are that much wider
MERGED = 1e-9  # part of a mesh's size within which vertices are one
AXIS, AT, OUT, PLACE = 5, 6, 7, 8  # rows of the room of a kernel, after those of `closest`
ROOM = 9


@device
def press(x, a, parameters, e, room, stack) -> Any:  # type: ignore[no-untyped-def]
    """Overlap of a sphere with the solid; how its direction, left in the room, turns as the sphere slides round an edge
    or a corner: times the stiffness, that is the one across; and which part of the solid is closest."""
    p, at, out = room[PLACE], room[AT], room[OUT]
    height = 0.0
    for c in range(3):
        height += x[a, c] * parameters[e, NORMAL + c]
    plane = 0.0
    for c in range(3):
        p[c] = x[a, c] - height * parameters[e, NORMAL + c]
        plane += abs(parameters[e, NORMAL + c])
    table = rows(parameters[e, TREE], parameters[e, TREE + 1], WIDTH)
    side, most = parameters[e, SIDE], np.inf
    if parameters[e, GRID] != 0.0:
        distance, away, width = bounds(parameters[e, GRID], p)
        least, most = side * distance - away, (abs(distance) + away) * (abs(distance) + away)
        if side > 0.0:
            least = max(least, np.sqrt(box_distance(table, 0, p)) - CLOSE * width)
        if least > parameters[e, RADIUS]:
            return parameters[e, RADIUS] - least, 0.0, FACE
    part, number = closest(table, p, at, room[AXIS], room, stack, most)
    normals = rows(parameters[e, NORMALS], parameters[e, NORMALS + 1], PARTS)
    along, square, size = 0.0, 0.0, 0.0
    for c in range(3):
        out[c] = normals[number, 3 * part + c]
        along += (p[c] - at[c]) * out[c]
        square += (p[c] - at[c]) * (p[c] - at[c])
        size += abs(p[c])
    apart = np.sqrt(square)
    round_it = part < EDGE or (part < FACE and plane == 0.0)
    if not round_it or not apart > NEAREST * size:
        return parameters[e, RADIUS] - side * along, 0.0, part
    sign = 1.0 if along >= 0.0 else -1.0
    for c in range(3):
        out[c] = sign * (p[c] - at[c]) / apart
    overlap = parameters[e, RADIUS] - side * sign * apart
    return overlap, -overlap * side * sign / apart, part


def heights(x, parameters, found):  # type: ignore[no-untyped-def]
    """Signed distances of places from the solid of one row of parameters, with radius 0 and side 1."""
    room = np.zeros((ROOM, 3))
    stack = np.zeros(2 * DEEPEST, np.int64)
    for a in range(x.shape[0]):
        found[a] = -press(x, a, parameters, 0, room, stack)[0]


def solid_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy = 0.0
    room = np.zeros((ROOM, 3))
    stack = np.zeros(2 * DEEPEST, np.int64)
    for e in range(indices.shape[0]):
        a, strength = indices[e, 0], parameters[e, STRENGTH]
        if strength == 0.0:
            continue
        overlap, turn, _ = press(x, a, parameters, e, room, stack)
        # what does not touch counts as well: it may before the stiffness is asked for again
        w[a] += strength * (max(1.0, turn) if overlap > 0.0 else 1.0)
        if overlap > 0.0:
            energy += 0.5 * strength * overlap * overlap
            for c in range(3):
                f[a, c] += strength * overlap * parameters[e, SIDE] * room[OUT, c]
    return energy


def solid_hessian(x, indices, parameters, memory, blocks):  # type: ignore[no-untyped-def]
    room = np.zeros((ROOM, 3))
    stack = np.zeros(2 * DEEPEST, np.int64)
    out, axis = room[OUT], room[AXIS]
    for e in range(indices.shape[0]):
        overlap, turn, part = press(x, indices[e, 0], parameters, e, room, stack)
        strength = parameters[e, STRENGTH] if overlap > 0.0 else 0.0
        for i in range(3):
            for j in range(3):
                across = (1.0 if i == j else 0.0) - out[i] * out[j]
                across -= parameters[e, NORMAL + i] * parameters[e, NORMAL + j]
                across -= axis[i] * axis[j] if part < FACE else 0.0
                blocks[e, i, j] = strength * (out[i] * out[j] + (turn * across if turn != 0.0 else 0.0))


class CollideSolid(ToMesh):
    """Spheres that a solid pushes out where they overlap it: E = k d^2 / 2, d the depth.

    The solid is a closed mesh that itself stays where it is: one of the scene's meshes by name, or vertices and faces
    of its own. d = r - s, where s is the distance of a particle to the closest point of the mesh, negative inside; with
    `inside` the free side is the inside, and d = r + s. With a radius of 0 particles themselves are kept out. One that
    is pressed on a face with a force F sinks in by F / k.

    Vertices at the same place count as one, quads are cut along the diagonal that leaves no sliver, and all faces are
    turned outwards together. A mesh may not cross itself. Centres deep inside a thin solid leave it by the side that is
    closest. Sources: Baerentzen and Aanaes, "Signed distance computation using the angle weighted pseudonormal", 2005
    (which side); Ericson, Real-Time Collision Detection, 2005 (closest points).
    """

    kind: Literal["collide_solid"] = "collide_solid"
    radius: NonNegatives = Field(default=0.0, description="r, radius of each sphere [length]")
    inside: bool = Field(default=False, description="Whether particles are kept inside, not outside")
    strength: NonNegatives = Field(default=1000.0, description="k, stiffness of a contact [force/length]")

    formula: ClassVar[str] = "E = k d²/2"
    touches: ClassVar[bool] = True
    outputs: ClassVar[dict[str, str]] = {"depth": "length", "force": "force"}
    kernel: ClassVar[Any] = staticmethod(solid_kernel)
    hessian: ClassVar[Any] = staticmethod(solid_hessian)

    @model_validator(mode="after")
    def _is_closed(self) -> Self:
        if self.vertices is not None and self.faces is not None:
            reason = solid(np.asarray(self.vertices), np.asarray(self.faces))[1]
            if reason:
                raise fault(reason, "/faces")
        return self

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: stiffness, radius, side, and the tables of the solid."""
        vertices, faces = self.geometry(places)
        triangles, reason = solid(vertices, faces)
        if reason:
            raise InputError(f"/meshes/{self.target}/faces", reason)
        index = places.elements(self)
        return contacts(
            index, vertices[triangles], pseudonormals(vertices, triangles), self.inside, self.strength, self.radius
        )

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """Depth of each sphere in the solid [length] and the force on it [force]."""
        return depths(block, element_forces)

    @classmethod
    def example(cls) -> tuple[CollideSolid, Floats]:
        """Spheres about a block with a valley: on a face, an edge, a corner, below the valley, and one that is free."""
        outline = [[-2, 0], [2, 0], [2, 2], [0, 1], [-2, 2]]
        vertices = [[u, y, z] for y in (-2.0, 2.0) for u, z in outline]
        sides = [[i, (i + 1) % 5, (i + 1) % 5 + 5, i + 5] for i in range(5)]
        faces = [*sides, [4, 3, 1, 0], [3, 2, 1, 1], [5, 6, 8, 9], [6, 7, 8, 8]]
        x = [[1.2, 0.2, 1.9], [-2.25, 0.3, 2.2], [2.2, 2.15, 2.2], [0.02, -0.4, 0.7], [4.0, 0.0, 1.0]]
        radius, strength = [0.6, 0.7, 0.8, 0.1, 0.5], [100.0, 20.0, 3.0, 50.0, 10.0]
        return cls(particles=range(5), vertices=vertices, faces=faces, radius=radius, strength=strength), np.array(x)


def contacts(
    index: Ints, corners: Floats, normals: Floats, inside: bool, strength: Any, radius: Any, normal: Any = (0, 0, 0)
) -> Block:
    """The block of contacts with a solid of triangles (m, 3, 3) and normals (m, 21) of their parts; with a unit
    `normal`, that of the plane of a curve, whose pieces repeat their last corner."""
    each = np.ones((len(index), 1))
    address, size = tree(corners)
    shared = [*np.asarray(normal, np.float64), address, float(size), keep(normals), float(len(normals))]
    head, places = middles(corners, len(index))
    found = np.empty(len(places))
    compiled(heights)(places, np.array([[0.0, 0.0, 1.0, *shared, 0.0]]), found)
    return Block.of(
        index,
        strength=strength,
        radius=radius,
        inside=-1.0 if inside else 1.0,
        normal=each * shared[:3],
        tree=each * shared[3:5],
        normals=each * shared[5:],
        grid=kept(head, found),
    )


def depths(block: Block, element_forces: Floats) -> dict[str, Floats]:
    """Depth [length] and force [force] of every contact."""
    force, strength = element_forces[:, 0], block.parameters[:, STRENGTH]
    return {"depth": lengths(force) / np.where(strength > 0.0, strength, 1.0), "force": force}


def solid(vertices: Floats, faces: Ints) -> tuple[Ints, str]:
    """Triangles (m, 3) of a closed mesh, turned outwards, of the first of vertices at the same place; and why it is no
    solid, as a sentence, empty where it is one."""
    size = float(np.ptp(vertices, axis=0).max(initial=0.0)) if len(vertices) else 0.0
    faces = near.first(vertices, vertices, MERGED * size)[faces]
    triangles = _cut(vertices, faces)
    triangles = triangles[(triangles != np.roll(triangles, 1, axis=1)).all(axis=1)]
    if not len(triangles):
        return triangles, "all faces are without an area; give a closed mesh"
    if reason := unclosed(triangles, "vertices"):
        return triangles, reason
    thin = lengths(_normals(vertices[triangles])) <= MERGED * size * _longest(vertices[triangles])
    if thin.any():
        a, b, c = triangles[np.argmax(thin)]
        return triangles, f"the face of vertices {a}, {b} and {c} has no area; merge it with its neighbours"
    volume = float(volumes(vertices[triangles], vertices[triangles[0, :1]]).sum())
    if not abs(volume) > 1e-12 * size**3:
        return triangles, "the mesh encloses no volume; give a closed mesh with an inside"
    return np.ascontiguousarray(triangles if volume > 0.0 else triangles[:, ::-1]), ""


def pseudonormals(vertices: Floats, triangles: Ints) -> Floats:
    """Outward unit normals (m, 21) at the corners, on the edges and on the faces of a closed mesh (m, 3).

    At a corner they are weighted by the angles of its faces, on an edge both faces count the same: for these, what is
    outside is on the side of the normal (Baerentzen and Aanaes, 2005).
    """
    corners = vertices[triangles]
    face = _normals(corners)
    size = lengths(face)
    face /= size[:, None]
    at = np.zeros_like(vertices)
    for i in range(3):
        u, v = corners[:, (i + 1) % 3] - corners[:, i], corners[:, (i + 2) % 3] - corners[:, i]
        np.add.at(at, triangles[:, i], np.arctan2(size, (u * v).sum(axis=1))[:, None] * face)
    after, count = np.roll(triangles, -1, axis=1), len(vertices)
    way, back = (triangles * count + after).ravel(), (after * count + triangles).ravel()
    order = np.argsort(way)
    other = order[np.searchsorted(way, back, sorter=order)].reshape(-1, 3) // 3
    parts = [*(at[triangles[:, i]] for i in range(3)), *(face + face[other[:, i]] for i in range(3)), face]
    return np.column_stack([unit(part) for part in parts])


def unit(vectors: Floats) -> Floats:
    """Unit vectors (m, 3); zero ones stay zero (at an edge between both sides of a sheet without thickness)."""
    size = lengths(vectors)
    return np.asarray(vectors / np.where(size > 1e-12, size, np.inf)[:, None])


def _cut(vertices: Floats, faces: Ints) -> Ints:
    """Two triangles of each face (m, 4): of the two cuts that whose smaller triangle is larger."""
    cuts = [faces[:, np.array(cut)] for cut in ([[0, 1, 2], [0, 2, 3]], [[0, 1, 3], [1, 2, 3]])]
    first, other = (lengths(_normals(vertices[cut.reshape(-1, 3)])).reshape(-1, 2).min(axis=1) for cut in cuts)
    return np.where((other > first * (1.0 + MERGED))[:, None, None], cuts[1], cuts[0]).reshape(-1, 3)


def _normals(corners: Floats) -> Floats:
    """Twice the area vectors of triangles (m, 3, 3)."""
    return np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])


def _longest(corners: Floats) -> Floats:
    """The longest edge of triangles (m, 3, 3)."""
    return np.asarray(np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1))
