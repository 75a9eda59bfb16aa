"""Natives of the tab Mesh: what meshes consist of, and how they are made, joined, welded and cut."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from hookean.discretize import meshes as core
from hookean.discretize.duplicates import unique_points
from hookean_canvas.run import stand_in as untyped
from hookean_canvas.run.natives import shapes
from hookean_canvas.run.natives.declare import Unfit, native
from hookean_canvas.run.natives.shapes import Array, Faces
from hookean_canvas.run.rhino import rhino3dm

stand_in: Any = untyped
_MESH = "Mesh (M): mesh"
SAME = 1e-9  # vertices nearer than this, relative to the size, are in one place


def sides(face: tuple[int, ...]) -> list[tuple[int, int]]:
    """The sides of a face in its direction."""
    return list(pairwise((*face, face[0])))


def in_place(vertices: Array) -> list[int]:
    """For each vertex the first one in the same place: Rhino's topology, where unwelded vertices are one."""
    kept, place = unique_points(vertices, SAME * float(np.ptp(vertices, axis=0).max(initial=0.0)))
    return [int(kept[i]) for i in place]


def edges(vertices: Array, faces: Faces) -> dict[tuple[int, int], list[int]]:
    """The faces at each edge, in order of first appearance; vertices in one place count as one."""
    of = in_place(vertices)
    found: dict[tuple[int, int], list[int]] = {}
    for number, face in enumerate(faces):
        for a, b in sides(face):
            if of[a] != of[b]:
                found.setdefault((min(of[a], of[b]), max(of[a], of[b])), []).append(number)
    return found


def normals(vertices: Array, faces: Faces) -> Array:
    """Unit normals `(m, 3)` of faces; of a quad across its diagonals."""
    corners = vertices[[face if len(face) == 4 else (*face, face[2]) for face in faces]].reshape(-1, 4, 3)
    across = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    length = np.linalg.norm(across, axis=1, keepdims=True)
    return _over(across, length)


def vertex_normals(vertices: Array, faces: Faces) -> Array:
    """Unit normals `(n, 3)` of vertices: the mean of those of their faces."""
    found = np.zeros_like(vertices)
    for face, normal in zip(faces, normals(vertices, faces), strict=True):
        found[list(face)] += normal
    length = np.linalg.norm(found, axis=1, keepdims=True)
    return _over(found, length)


def _over(ways: Array, length: Array) -> Array:
    """Directions over their lengths; those of length zero stay zero."""
    found: Array = np.divide(ways, length, out=np.zeros_like(ways), where=length > 0)
    return found


@native("2b9bf01d-5fe5-464c-b0b3-b469eb5f2efb", "Mesh Edges", "MEdges", _MESH,
        "Naked Edges (E1): list; Interior Edges (E2): list; Non-Manifold Edges (E3): list")  # fmt: skip
def mesh_edges(mesh: Any) -> tuple[list[Any], list[Any], list[Any]]:
    """Edges of one face, of two faces, and of more."""
    vertices, faces = shapes.mesh_parts(mesh)
    found: tuple[list[Any], list[Any], list[Any]] = ([], [], [])
    places = shapes.points(vertices)
    for (a, b), at in edges(vertices, faces).items():
        found[min(len(at), 3) - 1].append(rhino3dm.Line(places[a], places[b]))
    return found


@native("ba2d8f57-0738-42b4-b5a5-fe4d853517eb", "Deconstruct Mesh", "DeMesh", _MESH,
        "Vertices (V): list; Faces (F): list; Colours (C): list; Normals (N): list")  # fmt: skip
def deconstruct_mesh(mesh: Any) -> tuple[list[Any], ...]:
    """Vertices, faces, colours and normals of the vertices of a mesh."""
    vertices, faces = shapes.mesh_parts(mesh)
    colours = [stand_in.Color(c[3], *c[:3]) for c in (mesh.VertexColors[i] for i in range(len(mesh.VertexColors)))]
    ways = [shapes.vector(row) for row in vertex_normals(vertices, faces)]
    return shapes.points(vertices), [stand_in.MeshFace(*face) for face in faces], colours, ways


@native("e2c0f9db-a862-4bd9-810c-ef2610e7a56f", "Construct Mesh", "ConMesh",
        "Vertices (V): point list; Faces (F): face list; Colours (C): colour list optional", "Mesh (M)")  # fmt: skip
def construct_mesh(vertices: list[Any], faces: list[Any], colours: list[Any] | None) -> Any:
    """A mesh of vertices and faces; faces that name missing vertices are an error."""
    rows = [(f.A, f.B, f.C) if f.C == f.D else (f.A, f.B, f.C, f.D) for f in faces if f is not None]
    if rows and not 0 <= min(map(min, rows)) <= max(map(max, rows)) < len(vertices):
        raise Unfit("a face names a vertex that does not exist")
    made = shapes.mesh(shapes.rows(vertices), rows)
    for colour in colours or []:
        made.VertexColors.Add(colour.R, colour.G, colour.B)
    return made


@native("1cb59c86-7f6b-4e52-9a0c-6441850e9520", "Mesh Quad", "Quad",
        "Corner A (A): integer = 0; Corner B (B): integer = 1; Corner C (C): integer = 2; Corner D (D): integer = 3",
        "Face (F)")  # fmt: skip
def mesh_quad(a: int, b: int, c: int, d: int) -> Any:
    """A face of four vertices, by their numbers."""
    return stand_in.MeshFace(a, b, c, d)


@native("5a4ddedd-5af9-49e5-bace-12910a8b9366", "Mesh Triangle", "Triangle",
        "Corner A (A): integer = 0; Corner B (B): integer = 1; Corner C (C): integer = 2", "Face (F)")  # fmt: skip
def mesh_triangle(a: int, b: int, c: int) -> Any:
    """A face of three vertices, by their numbers."""
    return stand_in.MeshFace(a, b, c)


@native(
    "aab142b1-b870-46de-8e86-654c9a554d90", "Deconstruct Face", "DeFace", "Face (F): face", "A (A); B (B); C (C); D (D)"
)
def deconstruct_face(face: Any) -> tuple[int, int, int, int]:
    """The numbers of the vertices of a face; the last two agree for a triangle."""
    return face.A, face.B, face.C, face.D


@native("0b4ac802-fc4a-4201-9c66-0078b837c1eb", "Face Boundaries", "FaceB", _MESH, "Boundaries (B): list")
def face_boundaries(mesh: Any) -> list[Any]:
    """A closed polyline round each face."""
    vertices, faces = shapes.mesh_parts(mesh)
    return [shapes.polyline(vertices[list(face)], closed=True) for face in faces]


@native("cb4ca22c-3419-4962-a078-ad4ff7f1f929", "Face Normals", "FaceN", _MESH, "Centers (C): list; Normals (N): list")
def face_normals(mesh: Any) -> tuple[list[Any], list[Any]]:
    """The mean of the corners of each face, and its unit normal."""
    vertices, faces = shapes.mesh_parts(mesh)
    centres = [shapes.point(vertices[list(face)].mean(axis=0)) for face in faces]
    return centres, [shapes.vector(row) for row in normals(vertices, faces)]


@native("4bc9dbbf-fec8-4348-a3af-e33e7edc8e7b", "Mesh Join", "MJoin", "Meshes (M): mesh list", "Mesh (M)")
def mesh_join(given: list[Any]) -> Any:
    """Meshes as one; vertices in one place stay apart, as in Rhino."""
    places, faces = [np.zeros((0, 3))], []
    for mesh in given:
        if mesh is not None:
            vertices, more = shapes.mesh_parts(mesh)
            start = sum(map(len, places))
            places.append(vertices)
            faces += [tuple(i + start for i in face) for face in more]
    return shapes.mesh(np.concatenate(places), faces)


def combined(given: list[Any]) -> Any:
    """Meshes as one without unused vertices, and vertices in one place made one."""
    vertices, faces = shapes.mesh_parts(mesh_join(given))
    of = in_place(vertices)
    return _compact(vertices, [tuple(of[i] for i in face) for face in faces])


@native("9f6d85c9-1143-4538-bca7-69dcb11a74ef", "Weld Mesh", "Weld",
        f"{_MESH}; Angle (A): number = 3.141592653589793", "Result (R)")  # fmt: skip
def weld_mesh(mesh: Any, angle: float) -> Any:
    """Vertices in one place made one where the normals of their faces differ by less than an angle in radians."""
    vertices, faces = shapes.mesh_parts(mesh)
    groups: dict[int, list[int]] = {}
    for i, first in enumerate(in_place(vertices)):
        groups.setdefault(first, []).append(i)
    ways = vertex_normals(vertices, faces)
    of = list(range(len(vertices)))
    for group in groups.values():
        for k, i in enumerate(group):
            of[i] = next((of[j] for j in group[:k] if float(ways[i] @ ways[j]) >= math.cos(angle) - 1e-9), i)
    return _compact(vertices, [tuple(of[i] for i in face) for face in faces])


@native("47814a17-ca9e-4305-9400-3a9c8d71c19d", "Unweld Mesh", "Unweld",
        f"{_MESH}; Angle (A): number = 0.0", "Result (R)")  # fmt: skip
def unweld_mesh(mesh: Any, angle: float) -> Any:
    """A vertex of its own for each group of faces round it whose neighbours differ by less than an angle in radians."""
    vertices, faces = shapes.mesh_parts(mesh)
    ways = normals(vertices, faces)
    corner = {(number, i): (number, i) for number, face in enumerate(faces) for i in face}

    def root(key: tuple[int, int]) -> tuple[int, int]:
        while corner[key] != key:
            key = corner[key]
        return key

    at: dict[tuple[int, int], list[int]] = {}
    for number, face in enumerate(faces):
        for a, b in sides(face):
            at.setdefault((min(a, b), max(a, b)), []).append(number)
    for (a, b), near in at.items():
        if len(near) == 2 and float(ways[near[0]] @ ways[near[1]]) > math.cos(angle):
            for i in (a, b):
                corner[root((near[1], i))] = root((near[0], i))
    numbers: dict[tuple[int, int], int] = {}
    made = [tuple(numbers.setdefault(root((n, i)), len(numbers)) for i in face) for n, face in enumerate(faces)]
    return shapes.mesh(vertices[[i for _, i in numbers]], made)


def _compact(vertices: Array, faces: Faces) -> Any:
    """A mesh without the vertices that no face names, and without faces of fewer than three different vertices."""
    good = [tuple(i for i, j in sides(face) if i != j) for face in faces]
    good = [face for face in good if len(face) > 2]
    used = sorted({i for face in good for i in face})
    number = {i: k for k, i in enumerate(used)}
    return shapes.mesh(vertices[used], [tuple(number[i] for i in face) for face in good])


@native("3fba11d5-b30a-4146-8d80-d591e7a0a287", "Triangulate", "Tri", _MESH, "Mesh (M); Count (N)")
def triangulate(mesh: Any) -> tuple[Any, int]:
    """Each quad cut along its shorter diagonal, and how many quads there were."""
    vertices, faces = shapes.mesh_parts(mesh)
    return shapes.mesh(vertices, core.triangles((vertices, faces))), sum(len(face) == 4 for face in faces)


@native("ca6a48f4-b681-4989-b0c1-301a2929a84c", "Unify Mesh", "UniM", _MESH, "Result (R); Count (N)")
def unify_mesh(mesh: Any) -> tuple[Any, int]:
    """Faces turned to the direction of the first one of their part, and how many were turned."""
    vertices, faces = shapes.mesh_parts(mesh)
    of = in_place(vertices)
    ways = [{(of[a], of[b]) for a, b in sides(face)} for face in faces]
    at: dict[frozenset[int], list[int]] = {}
    for number, directed in enumerate(ways):
        for pair in directed:
            at.setdefault(frozenset(pair), []).append(number)
    turned: dict[int, bool] = {}
    for seed in range(len(faces)):
        waiting = deque([seed] if seed not in turned else [])
        turned.setdefault(seed, False)
        while waiting:
            number = waiting.popleft()
            for pair in ways[number]:
                for other in at[frozenset(pair)]:
                    if other not in turned:
                        turned[other] = turned[number] != (pair in ways[other])
                        waiting.append(other)
    made = [face[::-1] if turned[number] else face for number, face in enumerate(faces)]
    return shapes.mesh(vertices, made), sum(turned.values())


@native("47fbc929-e88a-4a13-882e-dad84763256d", "Flip Mesh", "FlipM",
        f"{_MESH}; Vertex normals (Vn): boolean = True; Face normals (Fn): boolean = True; "
        "Orientations (Fo): boolean = True", "Result (R)")  # fmt: skip
def flip_mesh(mesh: Any, vertex: bool, face: bool, orientation: bool) -> Any:
    """Faces in the other direction; normals follow from it."""
    vertices, faces = shapes.mesh_parts(mesh)
    return shapes.mesh(vertices, [one[::-1] if orientation else one for one in faces])


@native("57edd208-760a-4f0f-87e6-ca1bbd74133b", "Cull Faces", "CullF",
        f"{_MESH}; Cull Pattern (P): boolean list", "Mesh (M)")  # fmt: skip
def cull_faces(mesh: Any, pattern: list[bool]) -> Any:
    """A mesh without the faces at which a repeated pattern is False."""
    if not pattern:
        raise Unfit("the pattern is empty")
    vertices, faces = shapes.mesh_parts(mesh)
    return _compact(vertices, [face for i, face in enumerate(faces) if pattern[i % len(pattern)]])


@native("d0f1311b-8287-4484-b2ea-1475c6770926", "Delete Faces", "DeleteF",
        f"{_MESH}; Face indices (I): integer list", "Mesh (M)")  # fmt: skip
def delete_faces(mesh: Any, indices: list[int]) -> Any:
    """A mesh without some of its faces."""
    vertices, faces = shapes.mesh_parts(mesh)
    return _compact(vertices, [face for i, face in enumerate(faces) if i not in set(indices)])


@native("4dce5963-dc1a-4710-8991-9437ea23888d", "Disjoint Mesh", "Disjoint", _MESH, "Mesh (M): list")
def disjoint_mesh(mesh: Any) -> list[Any]:
    """The parts of a mesh that share no edge, each as a mesh."""
    vertices, faces = shapes.mesh_parts(mesh)
    near: dict[int, set[int]] = {i: set() for i in range(len(faces))}
    for at in edges(vertices, faces).values():
        for a, b in pairwise(at):
            near[a].add(b)
            near[b].add(a)
    found, seen = [], set()
    for seed in range(len(faces)):
        if seed not in seen:
            part, waiting = {seed}, [seed]
            while waiting:
                new = near[waiting.pop()] - part
                part |= new
                waiting += new
            seen |= part
            found.append(_compact(vertices, [faces[i] for i in sorted(part)]))
    return found


@dataclass(frozen=True)
class MeshPlace:
    """A mesh parameter: a face and a point on it."""

    face: int
    place: tuple[float, ...]


@native("a559fee2-4b76-4370-8042-c7440cd75049", "Mesh Closest Point", "MeshCP",
        f"Point (P): point; {_MESH}", "Point (P); Index (I); Parameter (P)")  # fmt: skip
def mesh_closest_point(place: Any, mesh: Any) -> tuple[Any, int, Any]:
    """The nearest point of a mesh, the number of its face, and both as a mesh parameter."""
    vertices, faces = shapes.mesh_parts(mesh)
    if not faces:
        raise Unfit("the mesh has no faces")
    rows = [((face[0], face[k], face[k + 1]), n) for n, face in enumerate(faces) for k in range(1, len(face) - 1)]
    near = _nearest(vertices[[row for row, _ in rows]], shapes.xyz(place))
    k = int(np.linalg.norm(near - shapes.xyz(place), axis=1).argmin())
    return shapes.point(near[k]), rows[k][1], MeshPlace(rows[k][1], tuple(near[k].tolist()))


def _nearest(triangles: Array, place: Array) -> Array:
    """The nearest point `(t, 3)` of each triangle `(t, 3, 3)`: its foot in the plane, or the nearest on its sides."""
    a, b, c = triangles.transpose(1, 0, 2)
    normal = np.cross(b - a, c - a)
    area = np.einsum("ij,ij->i", normal, normal)
    safe = np.where(area > 0, area, 1.0)
    foot = place - (np.einsum("ij,ij->i", place - a, normal) / safe)[:, None] * normal
    inside = area > 0
    best: Array = foot.copy()
    reach = np.full(len(a), np.inf)
    for p, q in ((a, b), (b, c), (c, a)):
        inside &= np.einsum("ij,ij->i", np.cross(q - p, foot - p), normal) >= 0
        span = np.einsum("ij,ij->i", q - p, q - p)
        t = np.clip(np.einsum("ij,ij->i", place - p, q - p) / np.where(span > 0, span, 1.0), 0.0, 1.0)
        on = p + t[:, None] * (q - p)
        far = np.linalg.norm(on - place, axis=1)
        best[far < reach], reach = on[far < reach], np.minimum(far, reach)
    best[inside] = foot[inside]
    return best
