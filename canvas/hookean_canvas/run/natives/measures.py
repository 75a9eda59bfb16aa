"""Natives of the tab Surface that meshes, closed polylines and boxes suffice for."""

from __future__ import annotations

from typing import Any

import numpy as np

from hookean.discretize import measures
from hookean.discretize.breps import mesh_faces
from hookean.discretize.pieces import bezier_pieces
from hookean.errors import InputError
from hookean_canvas.run.natives import shapes
from hookean_canvas.run.natives.declare import Unfit, native
from hookean_canvas.run.natives.flat_faces import flat_mesh
from hookean_canvas.run.natives.shapes import Array
from hookean_canvas.run.rhino import rhino3dm

FINE = 64  # quads along each side of a face of a Brep that is measured
NODES = 32  # of each piece of an outline


@native("2e205f24-9279-47b2-b414-d06dcd0b21a7", "Area", "Area", "Geometry (G): geometry", "Area (A); Centroid (C)",
        remark=f"faces of Breps are measured by {FINE} by {FINE} quads")  # fmt: skip
def area(geometry: Any) -> tuple[float, Any]:
    """The area of a mesh, a Brep, a surface or a closed planar curve, and its centroid."""
    if isinstance(geometry, rhino3dm.Curve):
        return _region(geometry)
    vertices, faces = _mesh(geometry)
    a, b, c = _triangles(vertices, faces)
    sizes = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
    if not sizes.sum() > 0.0:
        raise Unfit("the area is zero")
    return measures.area((vertices, faces)), shapes.point(sizes @ ((a + b + c) / 3.0) / sizes.sum())


def _region(curve: Any) -> tuple[float, Any]:
    """Area and centroid of the region within a closed planar curve, by Green's theorem on its Bezier pieces."""
    at, along, weights = _sampled(bezier_pieces(curve))
    if np.linalg.norm(shapes.xyz(curve.PointAtEnd) - shapes.xyz(curve.PointAtStart)) > 1e-9 * np.ptp(at, axis=0).max():
        raise Unfit("the curve is not closed")
    centre = at.mean(axis=0)
    parts = 0.5 * weights[:, None] * np.cross(at - centre, along)
    whole = parts.sum(axis=0)
    size = float(np.linalg.norm(whole))
    if not size > 0.0:
        raise Unfit("the area is zero")
    shares = parts @ (whole / size)
    return size, shapes.point(centre + 2.0 / 3.0 * (shares @ (at - centre)) / size)


def _sampled(pieces: Array) -> tuple[Array, Array, Array]:
    """Points and derivatives `(n, 3)` of rational pieces `(s, p + 1, 4)` at Gauss's nodes, and the weights `(n,)`."""
    nodes, weights = np.polynomial.legendre.leggauss(NODES)
    t = 0.5 * (nodes + 1.0)[:, None]
    d = np.repeat(pieces[:, :, None, :], NODES, axis=2)
    while d.shape[1] > 2:
        d = (1.0 - t) * d[:, :-1] + t * d[:, 1:]
    value, slope = (1.0 - t) * d[:, 0] + t * d[:, 1], (pieces.shape[1] - 1) * (d[:, 1] - d[:, 0])
    at = value[..., :3] / value[..., 3:]
    along = (slope[..., :3] - at * slope[..., 3:]) / value[..., 3:]
    return at.reshape(-1, 3), along.reshape(-1, 3), np.tile(0.5 * weights, len(pieces))


@native("224f7648-5956-4b26-80d9-8d771f3dfd5d", "Volume", "Volume", "Geometry (G): geometry",
        "Volume (V); Centroid (C)",
        remark=f"faces of Breps are measured by {FINE} by {FINE} quads")  # fmt: skip
def volume(geometry: Any) -> tuple[float, Any]:
    """The volume that a closed mesh or Brep encloses, and its centroid."""
    vertices, faces = _mesh(geometry)
    a, b, c = _triangles(vertices, faces)
    parts = np.einsum("ij,ij->i", a, np.cross(b, c)) / 6.0
    if not parts.any():
        raise Unfit("the volume is zero")
    return abs(measures.volume((vertices, faces))), shapes.point(parts @ ((a + b + c) / 4.0) / parts.sum())


def _mesh(geometry: Any) -> tuple[Array, Any]:
    if isinstance(geometry, rhino3dm.Mesh):
        return shapes.mesh_parts(geometry)
    if isinstance(geometry, (rhino3dm.BoundingBox, shapes.TiltedBox)):
        geometry = geometry.ToBrep()
    if not isinstance(geometry, (rhino3dm.Brep, rhino3dm.Surface)):
        raise Unfit(f"a {type(geometry).__name__} is not measured here")
    try:
        made = mesh_faces(geometry, FINE, FINE)
    except InputError as error:
        if not isinstance(geometry, rhino3dm.Brep) or "trimmed" not in str(error):
            raise Unfit(str(error)) from None
        return shapes.mesh_parts(flat_mesh(geometry, FINE))
    return made.vertices, made.faces


def surface_mesh(geometry: Any) -> tuple[Array, Array, Array]:
    """The corners `(n, 3)` each of the triangles of a mesh, a surface or a Brep."""
    return _triangles(*_mesh(geometry))


def _triangles(vertices: Array, faces: Any) -> tuple[Array, Array, Array]:
    rows = [tuple(map(int, face)) for face in faces]
    cut = np.array([(row[0], row[k], row[k + 1]) for row in rows for k in range(1, len(row) - 1)])
    a, b, c = vertices[cut].transpose(1, 0, 2)
    return a, b, c


@native("0bb3d234-9097-45db-9998-621639c87d3b", "Bounding Box", "BBox",
        "Content (C): geometry; Plane (P): plane optional", "Box (B); Box (B)")  # fmt: skip
def bounding_box(geometry: Any, frame: Any) -> tuple[Any, Any]:
    """The box along the axes of a plane, or the world's, round geometry."""
    if isinstance(geometry, (rhino3dm.Point3d, rhino3dm.Point)):
        raise Unfit("a point has no box")
    if isinstance(geometry, shapes.TiltedBox):
        geometry = geometry.ToBrep()
    if isinstance(geometry, rhino3dm.Line):
        geometry = rhino3dm.LineCurve(geometry.From, geometry.To)
    if frame is not None and not isinstance(geometry, rhino3dm.BoundingBox):
        world = shapes.plane((0, 0, 0), (1, 0, 0), (0, 1, 0))
        geometry = shapes.transformed(geometry, rhino3dm.Transform.PlaneToPlane(frame, world))
    box = geometry if isinstance(geometry, rhino3dm.BoundingBox) else geometry.GetBoundingBox()
    if frame is not None and not isinstance(geometry, rhino3dm.BoundingBox):
        box = shapes.box_in(frame, shapes.xyz(box.Min), shapes.xyz(box.Max))
    return box, box


@native("2a43ef96-8f87-4892-8b94-237a47e8d3cf", "Box 2Pt", "Box",
        "Point A (A): point; Point B (B): point; Plane (P): plane optional", "Box (B)")  # fmt: skip
def box_between(a: Any, b: Any, frame: Any) -> Any:
    """The box between two opposite corners, along the axes of a plane or the world's."""
    axes = frame if frame is not None else shapes.plane((0, 0, 0), (1, 0, 0), (0, 1, 0))
    return shapes.box_in(axes, *shapes.coordinates(axes, shapes.rows([a, b])))


@native("28061aae-04fb-4cb5-ac45-16f3b66bc0a4", "Center Box", "Box",
        "Base (B): plane; X (X): number = 1.0; Y (Y): number = 1.0; Z (Z): number = 1.0", "Box (B)")  # fmt: skip
def centre_box(frame: Any, x: float, y: float, z: float) -> Any:
    """The box that reaches a distance to both sides of the origin of a plane."""
    return shapes.box_in(frame, (-x, -y, -z), (x, y, z))


@native(
    "dabc854d-f50e-408a-b001-d043c7de151d", "Sphere", "Sph", "Base (B): plane; Radius (R): number = 1.0", "Sphere (S)"
)
def sphere(frame: Any, radius: float) -> Any:
    """A sphere about the origin of a plane."""
    if radius <= 0.0:
        raise Unfit("Radius must be above 0")
    return rhino3dm.Sphere(frame.Origin, radius).ToBrep()
