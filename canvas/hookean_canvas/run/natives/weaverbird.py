"""Components of Weaverbird and MeshEdit that take meshes apart, offset and frame their faces, by their names.

Inputs and outputs: the component index (https://grasshopperdocs.com), Weaverbird and MeshEdit.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from hookean_canvas.run.natives import measures, shapes
from hookean_canvas.run.natives.curves import join_curves
from hookean_canvas.run.natives.declare import Unfit, bounded, native
from hookean_canvas.run.natives.meshes import (
    edges,
    face_boundaries,
    mesh_edges,
    normals,
    sides,
    triangulate,
    unify_mesh,
)
from hookean_canvas.run.natives.meshes import vertex_normals as at_vertices
from hookean_canvas.run.natives.shapes import Array, Faces
from hookean_canvas.run.natives.subdivision import subdivided, welded
from hookean_canvas.run.rhino import rhino3dm

_MESH = "Mesh (M): mesh"
_LEVELS = "Mesh/Curves (M): mesh; Level (L): integer = 1"
_NAKED = "Smooth Naked Edges (S): integer = 0"
_ROWS = "Mesh/Polylines (M): mesh; Distance (D): number list"
SPLIT = "Weaverbird's Split Triangles Subdivision"
CONSTANT = "Weaverbird's Constant Quads Split Subdivision"
_DIAGONALS = "the distance is along the normals of the vertices, whatever the type"


@native("", SPLIT, "wbSplit", _LEVELS, "Output Mesh/Curves (O)", plugin=True, remark="quads are cut first")
def split_triangles(mesh: Any, level: int) -> Any:
    """Each triangle cut into four at the middles of its edges."""
    return subdivided(mesh, level, 1, _quarters)


def _quarters(vertices: Array, faces: Faces) -> tuple[Array, Faces]:
    cut: Faces = [(face[0], face[k], face[k + 1]) for face in faces for k in range(1, len(face) - 1)]
    pairs = list(edges(vertices, cut))
    number = {pair: len(vertices) + k for k, pair in enumerate(pairs)}
    middles = vertices[np.array(pairs, dtype=int).reshape(-1, 2)].mean(axis=1)
    found: Faces = []
    for face in cut:
        a, b, c = face
        ab, bc, ca = (number[min(p, q), max(p, q)] for p, q in sides(face))
        found += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    return np.concatenate([vertices, middles]), found


@native("", CONSTANT, "wbCQuads", f"{_LEVELS}; {_NAKED}", "Output Mesh/Curves (O)", plugin=True,
        remark="naked edges: 0 fixed, 1 smooth, 2 smooth with fixed corners")  # fmt: skip
def constant_quads(mesh: Any, level: int, naked: int) -> Any:
    """Each face cut into a quad for each corner at its centre and the middles of its edges; inner vertices stay."""
    return subdivided(mesh, level, naked, _cornered)


def _cornered(vertices: Array, faces: Faces) -> tuple[Array, Faces]:
    at = edges(vertices, faces)
    pairs = np.array(list(at), dtype=int).reshape(-1, 2)
    centres = np.array([vertices[list(face)].mean(axis=0) for face in faces]).reshape(-1, 3)
    number = {pair: len(vertices) + k for k, pair in enumerate(at)}
    start = len(vertices) + len(at)
    quads: Faces = []
    for k, face in enumerate(faces):
        ring = [number[min(a, b), max(a, b)] for a, b in sides(face)]
        quads += [(face[i], ring[i], start + k, ring[i - 1]) for i in range(len(face))]
    rim = np.array([pair for pair, near in at.items() if len(near) == 1], dtype=int).reshape(-1, 2)
    both = np.concatenate([rim, rim[:, ::-1]])
    total, count = np.zeros_like(vertices), np.bincount(both[:, 0], minlength=len(vertices))
    np.add.at(total, both[:, 0], vertices[both[:, 1]])
    moved = np.where((count == 2)[:, None], 0.75 * vertices + 0.125 * total, vertices)  # a cubic B-spline
    return np.concatenate([moved, vertices[pairs].mean(axis=1), centres]), quads


@native("", "Weaverbird's Mesh Edges", "wbEdges", "Mesh or Polylines (G): mesh", "Lines (L): list", plugin=True)
def wireframe(mesh: Any) -> list[Any]:
    """All edges of a mesh as lines."""
    return [line for group in mesh_edges(mesh) for line in group]


@native("", "Weaverbird's Naked Boundary", "wbNaked", "Mesh (M): mesh", "Polylines (P): list", plugin=True)
def naked_boundary(mesh: Any) -> list[Any]:
    """The naked edges of a mesh, joined to polylines."""
    naked, _, _ = mesh_edges(mesh)
    found: list[Any] = join_curves([rhino3dm.LineCurve(line.From, line.To) for line in naked], False)
    return found


@native("", "Weaverbird's Face Polylines", "wbFaces", "Mesh (M): mesh", "Polylines (P): list", plugin=True)
def face_polylines(mesh: Any) -> list[Any]:
    """A closed polyline round each face."""
    found: list[Any] = face_boundaries(mesh)
    return found


@native("", "Weaverbird's Unify Face Windings", "wbUnify", "Mesh (M): mesh", "Mesh (M)", plugin=True)
def unify_windings(mesh: Any) -> Any:
    """Faces turned to the direction of the first one of their part."""
    return unify_mesh(mesh)[0]


_POINTS = "Mesh (G): mesh; Weld (W): boolean = True", "Points (P): list"


@native("", "Weaverbird's Vertices", "wbVertices", *_POINTS, plugin=True)
@native("", "Weaverbird's Vertices Component", "wbVertices", *_POINTS, plugin=True)
def wb_vertices(mesh: Any, weld: bool) -> list[Any]:
    """The vertices of a mesh, those in one place once if wanted."""
    return shapes.points(welded(mesh)[0] if weld else shapes.mesh_parts(mesh)[0])


def _each(values: Sequence[float], count: int) -> Array:
    """One number for each of so many, the last one again where they do not suffice."""
    if not values:
        raise Unfit("Distance is missing")
    return np.array([values[min(k, len(values) - 1)] for k in range(count)], dtype=float)


@native("", "Weaverbird's Picture Frame", "wbFrame", f"{_ROWS}; InsetType (T): integer = 0", "OutMesh (O)",
        plugin=True, remark="the distance is in percent of the edges, or a length for type 1")  # fmt: skip
def picture_frame(mesh: Any, distances: list[float], inset: int) -> Any:
    """A frame of quads in each face: its corners moved in along both of their edges."""
    vertices, faces = welded(mesh)
    size = _each(distances, len(faces))
    places, found = [vertices], []
    start = len(vertices)
    for face, distance in zip(faces, size, strict=True):
        at = vertices[list(face)]
        ways = np.roll(at, -1, axis=0) - at, np.roll(at, 1, axis=0) - at
        lengths = (np.linalg.norm(way, axis=1, keepdims=True) for way in ways)
        parts = (0.01 * distance if inset == 0 else distance / np.where(one > 0.0, one, 1.0) for one in lengths)
        places.append(at + sum(part * way for part, way in zip(parts, ways, strict=True)))
        inner = range(start, start + len(face))
        found += [(a, b, inner[k + 1 - len(face)], inner[k]) for k, (a, b) in enumerate(sides(face))]
        start += len(face)
    return shapes.mesh(np.concatenate(places), found)


@native("", "Weaverbird's Stellate/Cumulation", "wbStellate", _ROWS, "OutMesh (O)", plugin=True)
def stellate(mesh: Any, distances: list[float]) -> Any:
    """A pyramid on each face, as high as a distance along its normal."""
    vertices, faces = welded(mesh)
    heights = _each(distances, len(faces))[:, None] * normals(vertices, faces)
    tips = np.array([vertices[list(face)].mean(axis=0) for face in faces]).reshape(-1, 3) + heights
    found = [(a, b, len(vertices) + k) for k, face in enumerate(faces) for a, b in sides(face)]
    return shapes.mesh(np.concatenate([vertices, tips]), found)


_OFFSET = "Mesh/Curves (M): mesh; Distance (D): number list; OffsetType (T): integer = 0"


@native("", "Weaverbird's Offset Mesh", "wbOffset", _OFFSET, "Output Mesh/Curves (O)", plugin=True, remark=_DIAGONALS)
def offset_mesh(mesh: Any, distances: list[float], _: int) -> Any:
    """A mesh whose vertices are moved along their normals by distances."""
    vertices, faces = welded(mesh)
    return shapes.mesh(vertices + _each(distances, len(vertices))[:, None] * at_vertices(vertices, faces), faces)


@native("", "Weaverbird's Mesh Thicken", "wbThicken", _OFFSET, "Output Mesh/Curves (O)", plugin=True, remark=_DIAGONALS)
def thicken(mesh: Any, distances: list[float], _: int) -> Any:
    """A mesh and its offset, turned apart, and closed along the naked edges."""
    vertices, faces = welded(mesh)
    moved = vertices + _each(distances, len(vertices))[:, None] * at_vertices(vertices, faces)
    n, naked = len(vertices), {pair for pair, near in edges(vertices, faces).items() if len(near) == 1}
    rim = [(a, b) for face in faces for a, b in sides(face) if (min(a, b), max(a, b)) in naked]
    found = [face[::-1] for face in faces] + [tuple(i + n for i in face) for face in faces]
    return shapes.mesh(np.concatenate([vertices, moved]), [*found, *((a, b, b + n, a + n) for a, b in rim)])


@native("", "Weaverbird's Laplacian Smoothing", "wbLaplacian", f"{_LEVELS}; {_NAKED}; Thin (T): number = 0.0",
        "Output Mesh/Curves (O)", plugin=True, remark="Thin has no effect")  # fmt: skip
def laplacian(mesh: Any, level: int, naked: int, _: float) -> Any:
    """Vertices moved to the mean of their neighbours; naked ones stay, or move along the rim, or all but corners."""
    vertices, faces = welded(mesh)
    around = edges(vertices, faces)
    bounded(max(level, 0) * (len(around) + 1))
    rim = {pair for pair, near in around.items() if len(near) == 1}
    bare = {end for pair in rim for end in pair}
    used = [pair for pair in around if pair in rim or not bare.intersection(pair)]
    half = [(a, b) for pair in around if pair not in used for a, b in (pair, pair[::-1]) if a not in bare]
    ends = np.array([*used, *(pair[::-1] for pair in used), *half], dtype=int).reshape(-1, 2)
    count = np.bincount(ends[:, 0], minlength=len(vertices))
    at = np.bincount([i for face in faces for i in face], minlength=len(vertices))
    stays = np.zeros(len(vertices), bool)
    stays[list(bare)] = naked == 0
    stays |= (at == 1) & (naked == 2)
    moves = (count > 0) & ~stays
    for _round in range(max(level, 0)):
        total = np.zeros_like(vertices)
        np.add.at(total, ends[:, 0], vertices[ends[:, 1]])
        vertices[moves] = total[moves] / count[moves, None]
    return shapes.mesh(vertices, faces)


@native("", "Mesh NakedEdge", "NakedEdge", _MESH, "V (V): list; A (A): list; B (B): list", plugin=True)
def naked_edge(mesh: Any) -> tuple[list[Any], list[int], list[int]]:
    """The vertices of a mesh, and the numbers of those at the start and the end of each naked edge."""
    vertices, faces = shapes.mesh_parts(mesh)
    pairs = [pair for pair, near in edges(vertices, faces).items() if len(near) == 1]
    return shapes.points(vertices), [a for a, _ in pairs], [b for _, b in pairs]


@native("", "Mesh Flip", "Flip", _MESH, "Mesh (M)", plugin=True)
def mesh_flip(mesh: Any) -> Any:
    """A mesh with its faces the other way round."""
    vertices, faces = shapes.mesh_parts(mesh)
    return shapes.mesh(vertices, [face[::-1] for face in faces])


@native("", "Mesh Area", "Area", _MESH, "Area (A); Centroid (C)", plugin=True)
def mesh_area(mesh: Any) -> tuple[float, Any]:
    """The area of a mesh and its centroid."""
    found: tuple[float, Any] = measures.area(mesh)
    return found


@native("", "Mesh Volume", "Volume", _MESH, "Volume (V); Centroid (C)", plugin=True)
def mesh_volume(mesh: Any) -> tuple[float, Any]:
    """The volume that a closed mesh encloses and its centroid."""
    found: tuple[float, Any] = measures.volume(mesh)
    return found


@native("", "Mesh Triangulate", "Triangulate", f"{_MESH}; ShortDiagonal (S): boolean = True", "Mesh (M)", plugin=True)
def mesh_triangulate(mesh: Any, short: bool) -> Any:
    """Each quad cut along its shorter diagonal, or along that from its first corner."""
    if short:
        return triangulate(mesh)[0]
    vertices, faces = shapes.mesh_parts(mesh)
    return shapes.mesh(vertices, [(f[0], f[k], f[k + 1]) for f in faces for k in range(1, len(f) - 1)])
