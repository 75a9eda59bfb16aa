"""Natives of the tab Mesh: primitives, triangulation of points, subdivision."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from hookean.discretize.breps import mesh_faces
from hookean.discretize.meshing import mesh_surface as core_mesh_surface
from hookean.errors import InputError
from hookean_canvas.run.natives import shapes
from hookean_canvas.run.natives.declare import Unfit, bounded, native
from hookean_canvas.run.natives.flat_faces import flat_mesh
from hookean_canvas.run.natives.meshes import sides
from hookean_canvas.run.natives.shapes import Array, Faces
from hookean_canvas.run.rhino import rhino3dm

QUADS = 10  # along each side of a face of a Brep, at least
TURN = math.pi / 20.0  # by which the normals of a curved face differ from one row of quads to the next, at most
LOOKED_AT = 13  # normals along each side


@native("8adbf481-7589-4a40-b490-006531ea001d", "Mesh Plane", "MPlane",
        "Boundary (B): rectangle; Width count (W): integer = 5; Height count (H): integer = 5",
        "Mesh (M); Area (A)")  # fmt: skip
def mesh_plane(boundary: tuple[Any, float, float], nx: int, ny: int) -> tuple[Any, float]:
    """Equal quads over a rectangle, and its area."""
    frame, width, height = boundary
    if min(nx, ny) < 1:
        raise Unfit("Width count and Height count must be at least 1")
    bounded(nx * ny)
    vertices, faces = _grid(nx, ny)
    return shapes.mesh(shapes.in_plane(frame, vertices * (width, height)), faces), width * height


def _grid(nx: int, ny: int) -> tuple[Array, Faces]:
    """Vertices over the unit square, x fastest, and quads."""
    y, x = np.meshgrid(np.linspace(0, 1, ny + 1), np.linspace(0, 1, nx + 1), indexing="ij")
    row = nx + 1
    quads = [
        (j * row + i, j * row + i + 1, (j + 1) * row + i + 1, (j + 1) * row + i) for j in range(ny) for i in range(nx)
    ]
    return np.stack([x.ravel(), y.ravel()], axis=1), [tuple(quad) for quad in quads]


@native("2696bd14-3fb5-4750-827f-86df6c31d664", "Mesh Box", "MBox",
        "Base (B): anybox; X Count (X): integer = 10; Y Count (Y): integer = 10; Z Count (Z): integer = 10",
        "Mesh (M)")  # fmt: skip
def mesh_box(box: Any, nx: int, ny: int, nz: int) -> Any:
    """Equal quads on the six sides of a box, normals outwards; the sides do not share vertices."""
    if min(nx, ny, nz) < 1:
        raise Unfit("counts must be at least 1")
    bounded(2 * (nx * ny + ny * nz + nz * nx))
    low, along, size = shapes.box_axes(box)
    count = (nx, ny, nz)
    vertices: list[Array] = []
    faces: Faces = []
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for far in (False, True):
            local, quads = _grid(count[u], count[v])
            places = np.zeros((len(local), 3))
            places[:, u], places[:, v], places[:, axis] = local[:, 0], local[:, 1], float(far)
            start = sum(map(len, vertices))
            vertices.append(low + (places * size) @ along)
            faces += [tuple(i + start for i in (quad if far else quad[::-1])) for quad in quads]
    return shapes.mesh(np.concatenate(vertices), faces)


@native("0a391eac-5048-443c-9c1b-f592299b6dd6", "Mesh Sphere", "MSphere",
        "Base (B): plane; Radius (R): number = 1.0; U Count (U): integer = 10; V Count (V): integer = 10",
        "Mesh (M)")  # fmt: skip
def mesh_sphere(frame: Any, radius: float, nu: int, nv: int) -> Any:
    """A sphere of faces round it and from pole to pole; those at the poles are triangles."""
    if nu < 3 or nv < 2:
        raise Unfit("U Count must be at least 3 and V Count at least 2")
    bounded(nu * nv)
    rings = [(math.sin(math.pi * j / nv), -math.cos(math.pi * j / nv)) for j in range(1, nv)]
    turns = 2.0 * math.pi * np.arange(nu) / nu
    local = [(0.0, 0.0, -1.0)] + [(r * math.cos(t), r * math.sin(t), z) for r, z in rings for t in turns] + [(0, 0, 1)]
    last = len(local) - 1
    faces: Faces = []
    for i in range(nu):
        k = (i + 1) % nu
        faces.append((0, 1 + k, 1 + i))
        faces += [(1 + j * nu + i, 1 + j * nu + k, 1 + (j + 1) * nu + k, 1 + (j + 1) * nu + i) for j in range(nv - 2)]
        faces.append((1 + (nv - 2) * nu + i, 1 + (nv - 2) * nu + k, last))
    return shapes.mesh(shapes.in_plane(frame, radius * np.array(local)), faces)


@native("60e7defa-8b21-4ee1-99aa-a9223d6134ff", "Mesh Brep", "Mesh",
        "Brep (B): faces; Settings (S): any optional", "Mesh (M)",
        remark=f"{QUADS} by {QUADS} quads on each face, more where it turns by more than 90 degrees, or as many "
               "triangles where it is cut, whatever the settings; Rhino makes another mesh")  # fmt: skip
def mesh_brep(brep: Any, settings: Any) -> Any:
    """The faces of a Brep as quads; trimmed ones by the mesh that the file has for them, or, if flat, as triangles.

    A mesh stays as it is.
    """
    return meshed(brep, QUADS)


def meshed(brep: Any, least: int) -> Any:
    """The mesh of a Brep with at least so many quads along each side of a face."""
    if isinstance(brep, rhino3dm.Mesh):
        return brep
    try:
        made = mesh_faces(brep, *_counts(brep, least))
    except InputError as error:
        if not isinstance(brep, rhino3dm.Brep) or "trimmed" not in str(error):
            raise Unfit(str(error)) from None
        return flat_mesh(brep, least)
    return shapes.mesh(made.vertices, made.faces)


@native("58cf422f-19f7-42f7-9619-fc198c51c657", "Mesh Surface", "Mesh UV",
        "Surface (S): surface; U Count (U): integer = 10; V Count (V): integer = 10; "
        "Overhang (H): boolean = False; Equalize (Q): boolean = False", "Mesh (M)",
        remark="quads are at even steps of the parameters, also with Equalize")  # fmt: skip
def mesh_surface(surface: Any, nu: int, nv: int, overhang: bool, equalize: bool) -> Any:
    """Quads at even steps over a surface."""
    bounded(nu * nv)
    return _of_core(lambda: core_mesh_surface(surface, nu, nv))


def _counts(brep: Any, least: int) -> tuple[int, int]:
    """Quads each way: so many that normals turn little from one to the next, and that each corner of a surface of
    straight pieces is one of theirs."""
    faces = [brep.Faces[i] for i in range(len(brep.Faces))] if isinstance(brep, rhino3dm.Brep) else [brep]
    faces = [face for face in faces if isinstance(face, rhino3dm.Surface)]
    spans = [faces[0].SpanCount(k) if faces[0].Degree(k) == 1 else 1 for k in (0, 1)] if len(faces) == 1 else [1, 1]
    turns = [max((_turn(face, k) for face in faces), default=0.0) for k in (0, 1)]
    counts = [max(least, math.ceil(turn / TURN - 1e-9)) for turn in turns]
    u, v = (one * max(math.ceil(count / one), 1) for one, count in zip(spans, counts, strict=True))
    return (u, v) if u * v <= MOST_QUADS else (QUADS, QUADS)


def _turn(face: Any, way: int) -> float:
    """By what angle [rad] the normal of a face turns along a direction, at most; straight pieces turn at their ends."""
    if face.Degree(way) == 1:
        return 0.0
    steps = [np.linspace(face.Domain(k).T0, face.Domain(k).T1, LOOKED_AT) for k in (0, 1)]
    places = [[face.NormalAt(u, v) for v in steps[1]] for u in steps[0]]
    normals = np.array([[shapes.xyz(normal) for normal in row] for row in places])
    normals = normals.swapaxes(0, way)
    cosines = (normals[1:] * normals[:-1]).sum(axis=-1)
    return float(np.arccos(np.clip(cosines, -1.0, 1.0)).sum(axis=0).max())


MOST_QUADS = 10_000
"""Quads of one face, however many pieces it has."""


def _of_core(work: Any) -> Any:
    try:
        made = work()
    except InputError as error:
        raise Unfit(str(error)) from None
    return shapes.mesh(made.vertices, made.faces)


def _flat(places: list[Any], frame: Any) -> tuple[Array, Array, Any]:
    """Points, their coordinates in a plane, and Delaunay's triangles of these."""
    from scipy.spatial import Delaunay, QhullError

    found = shapes.rows(place for place in places if place is not None)
    if len(found) < 3:
        raise Unfit("a triangulation needs three points")
    local = shapes.coordinates(frame or shapes.fitted_plane(found), found)[:, :2]
    try:
        return found, local, Delaunay(local).simplices
    except QhullError:
        raise Unfit("the points are on a line") from None


_CLOUD = "Points (P): point list; Plane (Pl): plane optional"


@native("1eb4f6ff-3547-4184-bead-1b01e7cfd668", "Delaunay Mesh", "Del", _CLOUD, "Mesh (M)")
def delaunay_mesh(places: list[Any], frame: Any) -> Any:
    """Points joined by Delaunay's triangles in a plane, the best fitting one if none is given."""
    found, local, triangles = _flat(places, frame)
    a, b, c = local[triangles].transpose(1, 0, 2)
    left = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0] > 0
    return shapes.mesh(found, [tuple(t if up else t[::-1]) for t, up in zip(triangles.tolist(), left, strict=True)])


@native("db2a4d25-23fa-4887-8983-ee5293cc82c0", "Delaunay Edges", "Con",
        _CLOUD, "Connectivity (C): branches; Edges (E): list")  # fmt: skip
def delaunay_edges(places: list[Any], frame: Any) -> tuple[list[list[int]], list[Any]]:
    """The neighbours of each point in Delaunay's triangles, and the edges."""
    found, _, triangles = _flat(places, frame)
    pairs = sorted({(min(a, b), max(a, b)) for t in triangles.tolist() for a, b in sides(tuple(t))})
    near: list[list[int]] = [[] for _ in found]
    for a, b in pairs:
        near[a].append(b)
        near[b].append(a)
    points = shapes.points(found)
    return [sorted(one) for one in near], [rhino3dm.Line(points[a], points[b]) for a, b in pairs]
