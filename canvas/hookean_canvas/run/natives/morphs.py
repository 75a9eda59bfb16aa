"""Natives that bend geometry from a box into another box with eight free corners, or over a surface."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from hookean_canvas.run.natives import shapes
from hookean_canvas.run.natives.declare import Unfit, native
from hookean_canvas.run.natives.shapes import Array
from hookean_canvas.run.natives.surfaces_at import domain2
from hookean_canvas.run.rhino import rhino3dm

_BY_POINTS = "curves but polylines, and surfaces, are bent by their control points"


@dataclass(frozen=True, eq=False)
class TwistedBox:
    """A box by its corners `(2, 2, 2, 3)`: the first index goes along x, or u, the last along z, or w."""

    corners: Array

    def at(self, places: Array) -> Array:
        """Points `(n, 3)` at parts `(n, 3)` of the three sides: linear in each."""
        found = self.corners[None]
        for axis in range(3):
            part = places[:, axis].reshape(-1, *[1] * (found.ndim - 2))
            found = (1.0 - part) * found[:, 0] + part * found[:, 1]
        return np.asarray(found)


@native("4f65c681-9331-4818-9d54-6290cae686c3", "Surface Box", "SBox",
        "Surface (S): surface; Domain (D): any; Height (H): number = 1.0", "Twisted Box (B)")  # fmt: skip
def surface_box(surface: Any, domain: Any, height: float) -> TwistedBox:
    """The box of four points of a surface at the corners of a domain, and those at a height along its normals."""
    part = domain2(domain)
    rows = []
    for u in part.u:
        for v in part.v:
            foot = shapes.xyz(surface.PointAt(u, v))
            rows += [foot, foot + height * shapes.unit(shapes.xyz(surface.NormalAt(u, v)))]
    return TwistedBox(np.array(rows).reshape(2, 2, 2, 3))


@native("d8940ff0-dd4a-4e74-9361-54df537b50db", "Box Morph", "Morph",
        "Geometry (G): geometry; Reference (R): anybox; Target (T): any", "Geometry (G)",
        remark=_BY_POINTS)  # fmt: skip
def box_morph(geometry: Any, reference: Any, target: Any) -> Any:
    """Geometry bent from a box into another, which may be twisted."""
    into = target if isinstance(target, TwistedBox) else _straight(target)
    return _bent(geometry, lambda places: into.at(_parts(reference, places)))


@native("5889b68f-fd88-4032-860f-869fb69654dd", "Surface Morph", "SrfMorph",
        "Geometry (G): geometry; Reference (R): anybox; Surface (S): surface; U Domain (U): domain; "
        "V Domain (V): domain; W Domain (W): domain", "Geometry (G)",
        remark=_BY_POINTS)  # fmt: skip
def surface_morph(geometry: Any, reference: Any, surface: Any, u: Any, v: Any, w: Any) -> Any:
    """Geometry bent from a box over a surface: x and y by the parameters u and v, z by the height w over it."""

    def over(places: Array) -> Array:
        parts = _parts(reference, places)
        at = [
            [end.T0 + part * (end.T1 - end.T0) for end, part in zip((u, v, w), row, strict=True)]
            for row in parts.tolist()
        ]
        feet = [shapes.xyz(surface.PointAt(a, b)) for a, b, _ in at]
        ways = [shapes.unit(shapes.xyz(surface.NormalAt(a, b))) for a, b, _ in at]
        found: Array = np.array(feet) + np.array([row[2] for row in at])[:, None] * np.array(ways)
        return found

    return _bent(geometry, over)


def _straight(box: Any) -> TwistedBox:
    """A box along the world's axes."""
    if isinstance(box, rhino3dm.GeometryBase):
        box = box.GetBoundingBox()
    if not isinstance(box, rhino3dm.BoundingBox):
        raise Unfit(f"Data conversion failed from {type(box).__name__} to Twisted Box")
    ends = np.array([shapes.xyz(box.Min), shapes.xyz(box.Max)])
    rows = [[ends[i, 0], ends[j, 1], ends[k, 2]] for i in (0, 1) for j in (0, 1) for k in (0, 1)]
    return TwistedBox(np.array(rows).reshape(2, 2, 2, 3))


def _parts(box: Any, places: Array) -> Array:
    """Coordinates in a box, 0 at its least corner and 1 at the greatest; of a flat box 0 across it."""
    low, along, size = shapes.box_axes(box)
    return np.where(size > 0.0, (places - low) @ along.T / np.where(size > 0.0, size, 1.0), 0.0)


def _bent(geometry: Any, change: Any) -> Any:
    """A copy of geometry with its points moved by a function of rows."""
    if isinstance(geometry, rhino3dm.Mesh):
        vertices, faces = shapes.mesh_parts(geometry)
        return shapes.mesh(change(vertices), faces)
    if isinstance(geometry, rhino3dm.Point3d | rhino3dm.Point):
        place = geometry.Location if isinstance(geometry, rhino3dm.Point) else geometry
        return shapes.point(change(shapes.rows([place]))[0])
    if isinstance(geometry, rhino3dm.Line | rhino3dm.Curve):
        corners = shapes.corners(geometry)
        if corners is not None:
            return shapes.polyline(change(corners))
    copy = geometry.ToNurbsCurve() if isinstance(geometry, rhino3dm.Curve) else _nurbs(geometry)
    points = copy.Points
    for key in _keys(copy):
        old = points[key] if isinstance(key, int) else points.GetControlPoint(*key)
        weight = old.W or 1.0
        x, y, z = change(np.array([[old.X, old.Y, old.Z]]) / weight)[0] * weight
        points[key] = rhino3dm.Point4d(float(x), float(y), float(z), old.W)
    return copy


def _nurbs(geometry: Any) -> Any:
    """The NURBS surface of a surface, or of a Brep of one face that is not trimmed."""
    if isinstance(geometry, rhino3dm.Brep) and len(geometry.Faces) == 1 and geometry.IsSurface:
        geometry = geometry.Faces[0].UnderlyingSurface()
    if isinstance(geometry, rhino3dm.Surface):
        return geometry.ToNurbsSurface()
    raise Unfit("points, curves, meshes and untrimmed surfaces alone are bent")


def _keys(made: Any) -> list[Any]:
    if isinstance(made, rhino3dm.NurbsCurve):
        return list(range(len(made.Points)))
    return [(i, j) for i in range(made.Points.CountU) for j in range(made.Points.CountV)]
