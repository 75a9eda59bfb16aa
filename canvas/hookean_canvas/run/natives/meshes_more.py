"""More natives of the tab Mesh, of boxes and solids, and components of MeshEdit by their names."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from hookean_canvas.run.natives import shapes
from hookean_canvas.run.natives.curves import divide_curve
from hookean_canvas.run.natives.declare import Unfit, bounded, native
from hookean_canvas.run.natives.meshes import edges, in_place, unify_mesh
from hookean_canvas.run.natives.meshes_made import mesh_brep
from hookean_canvas.run.rhino import rhino3dm


@native("e45aa4a0-e40d-421c-a335-5185dd131836", "Smooth Mesh", "MSmooth",
        "Mesh (M): mesh; Strength (S): number = 0.5; Skip Naked (N): boolean = True; "
        "Iterations (I): integer = 1; Displacement Limit (L): number optional", "Mesh (M)")  # fmt: skip
def smooth_mesh(mesh: Any, strength: float, skip: bool, rounds: int, limit: float | None) -> Any:
    """Vertices moved by a part of the way to the mean of their neighbours; none further than a limit from the start."""
    vertices, faces = shapes.mesh_parts(mesh)
    of = np.array(in_place(vertices), dtype=int)
    around = edges(vertices, faces)
    bounded(max(rounds, 0) * (len(around) + 1))
    pairs = np.array(list(around), dtype=int).reshape(-1, 2)
    naked = np.zeros(len(vertices), bool)
    naked[[end for pair, beside in around.items() if len(beside) == 1 for end in pair]] = skip
    start, count = vertices.copy(), np.bincount(pairs.reshape(-1), minlength=len(vertices))
    moves = (count > 0) & ~naked
    for _ in range(max(rounds, 0)):
        total = np.zeros_like(vertices)
        np.add.at(total, pairs[:, 0], vertices[pairs[:, 1]])
        np.add.at(total, pairs[:, 1], vertices[pairs[:, 0]])
        vertices[moves] += strength * (total[moves] / count[moves, None] - vertices[moves])
    if limit is not None:
        way = vertices - start
        size = np.linalg.norm(way, axis=1, keepdims=True)
        vertices = start + way * np.minimum(1.0, limit / np.where(size > 0.0, size, np.inf) if limit > 0.0 else 0.0)
    return shapes.mesh(vertices[of], faces)


@native("01e3991d-18bd-474f-9fbd-076a8700159f", "Mesh Inclusion", "MInc",
        "Mesh (M): mesh; Point (P): point; Strict (S): boolean = False", "Inside (I)")  # fmt: skip
def mesh_inclusion(mesh: Any, place: Any, strict: bool) -> bool:
    """Whether a point is in a closed mesh; strict: points on it are outside."""
    return _inside(mesh, shapes.xyz(place), strict)


@native("e03561f8-0e66-41d3-afde-62049f152443", "Point In Brep", "BrepInc",
        "Brep (B): brep; Point (P): point; Strict (S): boolean = False", "Inside (I)",
        remark="the mesh of the Brep counts, as of Mesh Brep")  # fmt: skip
def point_in_brep(brep: Any, place: Any, strict: bool) -> bool:
    """Whether a point is in a closed Brep; strict: points on it are outside."""
    return _inside(mesh_brep(brep, None), shapes.xyz(place), strict)


def _inside(mesh: Any, place: shapes.Array, strict: bool) -> bool:
    """By the solid angle of all faces as seen from the point, 4 pi inside (Van Oosterom and Strackee, 1983)."""
    vertices, faces = shapes.mesh_parts(mesh)
    rows = [(face[0], face[k], face[k + 1]) for face in faces for k in range(1, len(face) - 1)]
    if not rows:
        raise Unfit("the mesh has no faces")
    a, b, c = (vertices[list(column)] - place for column in zip(*rows, strict=True))
    la, lb, lc = (np.linalg.norm(one, axis=1) for one in (a, b, c))
    turned = np.einsum("ij,ij->i", a, np.cross(b, c))
    dot = [np.einsum("ij,ij->i", p, q) for p, q in ((a, b), (b, c), (c, a))]
    below = la * lb * lc + dot[0] * lc + dot[1] * la + dot[2] * lb
    size = float(np.ptp(vertices, axis=0).max())
    on = bool(np.any((np.abs(turned) <= 1e-9 * size**3) & (below <= 1e-9 * size**3)))
    if on:
        return not strict
    return abs(2.0 * float(np.arctan2(turned, below).sum())) > 2.0 * math.pi


@native("a10e8cdf-7c7a-4aac-aa70-ddb7010ab231", "Box Corners", "Box Corners", "Box (B): anybox",
        "Corner A (A); Corner B (B); Corner C (C); Corner D (D); Corner E (E); Corner F (F); Corner G (G); "
        "Corner H (H)")  # fmt: skip
def box_corners(box: Any) -> tuple[Any, ...]:
    """The corners of a box: four below, counter-clockwise from the least, then those over them."""
    low, along, size = shapes.box_axes(box)
    plan = ((0, 0), (1, 0), (1, 1), (0, 1))
    return tuple(shapes.point(low + (np.array([x, y, z]) * size) @ along) for z in (0, 1) for x, y in plan)


@native("0373008a-80ee-45be-887d-ab5a244afc29", "Cylinder", "Cyl",
        "Base (B): plane; Radius (R): number = 1.0; Length (L): number = 1.0", "Cylinder (C)")  # fmt: skip
def cylinder(base: Any, radius: float, length: float) -> Any:
    """The wall of a cylinder over a plane."""
    if radius <= 0.0 or length == 0.0:
        raise Unfit("Radius must be positive, and Length not 0")
    circle = rhino3dm.Circle(rhino3dm.Point3d(0, 0, 0), radius)
    found = rhino3dm.Cylinder(circle, length).ToNurbsSurface()
    found.Transform(rhino3dm.Transform.PlaneToPlane(shapes.plane((0, 0, 0), (1, 0, 0), (0, 1, 0)), base))
    return found


@native("0e94542a-2e46-4793-9f98-2200b06b28f4", "Curve Frames", "Frames",
        "Curve (C): curve; Count (N): integer = 10", "Frames (F): list; Parameters (t): list",
        remark="the frame may be turned about the curve otherwise")  # fmt: skip
def curve_frames(curve: Any, count: int) -> tuple[list[Any], list[float]]:
    """Planes at the ends of equal parts of a curve, x along it and y towards the side to which it bends."""
    places, ways, at = divide_curve(curve, count, False)
    frames = []
    for place, way, t in zip(places, ways, at, strict=True):
        along, bent = shapes.unit(shapes.xyz(way)), shapes.xyz(curve.CurvatureAt(t))
        if np.linalg.norm(bent) < 1e-12:
            bent = np.cross((0.0, 0.0, 1.0), along) if abs(along[2]) < 0.999 else np.array([0.0, 1.0, 0.0])
        frames.append(shapes.plane(shapes.xyz(place), along, bent))
    return frames, at


@native("", "Mesh UnifyNormals", "UnifyNormals", "Mesh (M): mesh", "Mesh (M)", plugin=True)
def unify_normals(mesh: Any) -> Any:
    """Faces turned to the direction of the first one of their part."""
    return unify_mesh(mesh)[0]


@native("", "Mesh FromPoints", "FromPoints", "Points (P): point list; U Count (U): integer; V Count (V): integer",
        "Mesh (M)", plugin=True)  # fmt: skip
def mesh_from_points(places: list[Any], nu: int, nv: int) -> Any:
    """Quads between points in rows: V points in each of U rows."""
    if min(nu, nv) < 2 or nu * nv != len(places):
        raise Unfit(f"{len(places)} points are not {nu} rows of {nv}; U times V must be their number")
    faces = [
        (i * nv + j, (i + 1) * nv + j, (i + 1) * nv + j + 1, i * nv + j + 1)
        for i in range(nu - 1)
        for j in range(nv - 1)
    ]
    return shapes.mesh(shapes.rows(places), faces)
