"""Natives of the tab Surface that evaluate surfaces, cut them by domains, and make flat ones."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from hookean_canvas.run.natives import shapes
from hookean_canvas.run.natives.declare import Unfit, bounded, native
from hookean_canvas.run.rhino import rhino3dm

GRID = 24
"""Places each way from which the closest one on a surface is sought."""


@dataclass(frozen=True)
class Domain2:
    """A domain in u and one in v, each as its two ends."""

    u: tuple[float, float]
    v: tuple[float, float]


@native("353b206e-bde5-4f02-a913-b3b8a977d4b9", "Evaluate Surface", "EvalSrf",
        "Surface (S): surface; Point (uv): point",
        "Point (P); Normal (N); U direction (U); V direction (V); Frame (F)")  # fmt: skip
def evaluate_surface(surface: Any, uv: Any) -> tuple[Any, ...]:
    """The point of a surface at parameters (u, v), with the normal, unit vectors along u and v, and the plane there."""
    u, v = uv.X, uv.Y
    along_u, along_v = _directions(surface, u, v)
    at, normal = surface.PointAt(u, v), surface.NormalAt(u, v)
    frame = shapes.plane(shapes.xyz(at), along_u, np.cross(shapes.xyz(normal), along_u))
    return at, normal, shapes.vector(along_u), shapes.vector(along_v), frame


def _directions(surface: Any, u: float, v: float) -> tuple[shapes.Array, shapes.Array]:
    """Unit vectors along the parameters, by central differences; at an edge by one-sided ones."""
    found = []
    for axis, at in enumerate((u, v)):
        domain = surface.Domain(axis)
        step = 1e-6 * (domain.T1 - domain.T0)
        low, high = (min(max(at + s, domain.T0), domain.T1) for s in (-step, step))
        ends = [surface.PointAt(*((t, v) if axis == 0 else (u, t))) for t in (low, high)]
        found.append(shapes.unit(shapes.xyz(ends[1]) - shapes.xyz(ends[0])))
    return found[0], found[1]


@native("4a9e9a8e-0943-4438-b360-129c30f2bb0f", "Surface Closest Point", "Srf CP",
        "Point (P): point; Surface (S): surface", "Point (P); UV Point (uvP); Distance (D)")  # fmt: skip
def surface_closest_point(place: Any, surface: Any) -> tuple[Any, Any, float]:
    """The point of a surface that is nearest to a point, its parameters, and the distance."""
    from scipy.optimize import least_squares

    (u0, u1), (v0, v1) = _ends(surface, 0), _ends(surface, 1)
    p = shapes.xyz(place)

    def offset(at: Sequence[float]) -> shapes.Array:
        return shapes.xyz(surface.PointAt(float(at[0]), float(at[1]))) - p

    starts = [(u, v) for u in np.linspace(u0, u1, GRID + 1) for v in np.linspace(v0, v1, GRID + 1)]
    start = min(starts, key=lambda at: float(np.linalg.norm(offset(at))))
    found = least_squares(offset, start, bounds=((u0, v0), (u1, v1)), xtol=1e-15, ftol=1e-15, gtol=1e-15)
    best = min((start, tuple(found.x)), key=lambda at: float(np.linalg.norm(offset(at))))
    u, v = float(best[0]), float(best[1])
    return surface.PointAt(u, v), rhino3dm.Point3d(u, v, 0.0), float(np.linalg.norm(offset(best)))


def _ends(surface: Any, axis: int) -> tuple[float, float]:
    domain = surface.Domain(axis)
    return domain.T0, domain.T1


def domain2(value: Any) -> Domain2:
    """A value as a domain in u and v, as Grasshopper takes it: itself, or that of a surface."""
    if isinstance(value, Domain2):
        return value
    if isinstance(value, rhino3dm.Brep):
        value = value.Faces[0].UnderlyingSurface()
    if isinstance(value, rhino3dm.Surface):
        return Domain2(_ends(value, 0), _ends(value, 1))
    raise Unfit(f"Data conversion failed from {type(value).__name__} to Domain²")


@native("9083b87f-a98c-4e41-9591-077ae4220b19 8555a743-36c1-42b8-abcc-06d9cb94519f", "Construct Domain²", "Dom²",
        "U (U): any; V (V): any ...", "2D Domain (I²)")  # fmt: skip
def constructdomain2(*given: Any) -> Domain2:
    """A domain in u and v of two domains, or of four numbers."""
    if len(given) == 2 and all(isinstance(one, rhino3dm.Interval) for one in given):
        return Domain2(*((one.T0, one.T1) for one in given))
    if len(given) == 4 and all(isinstance(one, (int, float)) for one in given):
        u0, u1, v0, v1 = map(float, given)
        return Domain2((u0, u1), (v0, v1))
    raise Unfit("two domains, or four numbers, are needed")


@native("75ac008b-1bc2-4edd-b967-667d628b9d24", "Divide Domain²", "Divide",
        "Domain (I): any; U Count (U): integer = 10; V Count (V): integer = 10", "Segments (S): list")  # fmt: skip
def dividedomain2(domain: Any, nu: int, nv: int) -> list[Domain2]:
    """The equal parts of a domain in u and v: for each part of u, those of v."""
    if min(nu, nv) < 1:
        raise Unfit("U Count and V Count must be at least 1")
    bounded(nu * nv)
    whole = domain2(domain)
    us, vs = (np.linspace(*ends, count + 1).tolist() for ends, count in ((whole.u, nu), (whole.v, nv)))
    return [Domain2((us[i], us[i + 1]), (vs[j], vs[j + 1])) for i in range(nu) for j in range(nv)]


@native("6a9ccaab-1b03-484e-bbda-be9c81584a66", "Isotrim", "SubSrf", "Surface (S): surface; Domain (D): any",
        "Surface (S)")  # fmt: skip
def isotrim(surface: Any, domain: Any) -> Any:
    """The part of a surface within a domain of its parameters."""
    part = domain2(domain)
    found = _of_nurbs(surface.ToNurbsSurface())
    for axis, ends in enumerate((part.u, part.v)):
        found = _cut(found, axis, ends)
    return _to_nurbs(found)


_Net = tuple[list[int], list[list[float]], shapes.Array]
"""Orders, knots and homogeneous control points (nu, nv, 4), coordinates times weight, of a surface."""


def _of_nurbs(surface: Any) -> _Net:
    counts = surface.Points.CountU, surface.Points.CountV
    net = [[_four(surface.Points.GetControlPoint(i, j)) for j in range(counts[1])] for i in range(counts[0])]
    knots = [[side[i] for i in range(len(side))] for side in (surface.KnotsU, surface.KnotsV)]
    return [surface.OrderU, surface.OrderV], knots, np.array(net)


def _four(point: Any) -> list[float]:
    return [point.X, point.Y, point.Z, point.W]


def _cut(net: _Net, axis: int, ends: tuple[float, float]) -> _Net:
    """A net between two parameters: each row of control points is a curve, which is trimmed."""
    orders, knots, points = net
    rows = [_trimmed(orders[axis], knots[axis], row, ends) for row in np.swapaxes(points, 0, 1 - axis)]
    cut = np.swapaxes(np.array([row for _, row in rows]), 0, 1 - axis)
    return orders, [rows[0][0] if i == axis else side for i, side in enumerate(knots)], cut


def _trimmed(order: int, knots: list[float], row: shapes.Array, ends: tuple[float, float]) -> tuple[Any, Any]:
    """Knots and weighted points of the part of a curve; x, y, z are trimmed in one curve, weights in another."""
    parts = []
    for places in (row[:, :3], np.repeat(row[:, 3:], 3, axis=1)):
        curve = rhino3dm.NurbsCurve(3, False, order, len(row))
        for i, place in enumerate(places):
            curve.Points[i] = rhino3dm.Point4d(*map(float, place), 1.0)
        for i, knot in enumerate(knots):
            curve.Knots[i] = knot
        low, high = max(ends[0], curve.Domain.T0), min(ends[1], curve.Domain.T1)
        found = curve.Trim(low, high) if low < high else None
        if found is None:
            raise Unfit("the domain is not within that of the surface")
        parts.append(found.ToNurbsCurve())
    first, weights = parts
    cut = [[*_xyz(first.Points[i]), weights.Points[i].X] for i in range(len(first.Points))]
    return [first.Knots[i] for i in range(len(first.Knots))], np.array(cut)


def _xyz(point: Any) -> tuple[float, float, float]:
    return point.X, point.Y, point.Z


def _to_nurbs(net: _Net) -> Any:
    (order_u, order_v), (knots_u, knots_v), points = net
    rational = bool(np.ptp(points[:, :, 3]) > 0.0)
    found = rhino3dm.NurbsSurface.Create(3, rational, order_u, order_v, *points.shape[:2])
    for side, knots in ((found.KnotsU, knots_u), (found.KnotsV, knots_v)):
        for i, knot in enumerate(knots):
            side[i] = knot
    for i, row in enumerate(points):
        for j, (x, y, z, w) in enumerate(row.tolist()):
            found.Points[i, j] = rhino3dm.Point4d(x, y, z, w)
    return found


@native("d1d57181-d594-41e8-8efb-041e29f8a5ca", "Iso Curve", "Iso", "Surface (S): surface; UV Point (uv): point",
        "U isocurve (U); V isocurve (V)")  # fmt: skip
def iso_curve(surface: Any, uv: Any) -> tuple[Any, Any]:
    """The curves of a surface through parameters (u, v): along u, and along v."""
    return surface.IsoCurve(0, uv.Y), surface.IsoCurve(1, uv.X)


@native("439a55a5-2f9e-4f66-9de2-32f24fec2ef5", "Plane Surface", "PlaneSrf",
        "Plane (P): plane; X Size (X): domain; Y Size (Y): domain", "Plane (P)")  # fmt: skip
def plane_surface(frame: Any, x: Any, y: Any) -> Any:
    """A rectangle in a plane as surface."""
    a, b, c, d = shapes.in_plane(frame, [(x.T0, y.T0), (x.T1, y.T0), (x.T1, y.T1), (x.T0, y.T1)])
    return _bilinear(a, b, c, d)


@native("c77a8b3b-c569-4d81-9b59-1c27299a1c45", "4Point Surface", "Srf4Pt",
        "Corner A (A): point; Corner B (B): point; Corner C (C): point; Corner D (D): point optional", "Surface (S)",
        )  # fmt: skip
def four_point_surface(a: Any, b: Any, c: Any, d: Any) -> Any:
    """The surface with straight edges between four corners, or three."""
    return _bilinear(*(shapes.xyz(one) for one in (a, b, c, d if d is not None else c)))


def _bilinear(a: shapes.Array, b: shapes.Array, c: shapes.Array, d: shapes.Array) -> Any:
    ends = [rhino3dm.LineCurve(shapes.point(p), shapes.point(q)) for p, q in ((a, b), (d, c))]
    return rhino3dm.NurbsSurface.CreateRuledSurface(*ends)


@native("c3f9cea5-6fd4-4db5-959b-08cd08ed9fe1", "Simple Mesh", "SMesh", "Brep (B): brep", "Mesh (M)")
def simple_mesh(brep: Any) -> Any:
    """A mesh with one face for each face of a Brep, between its corners."""
    surfaces = [brep.Faces[i] for i in range(len(brep.Faces))] if isinstance(brep, rhino3dm.Brep) else [brep]
    vertices: list[shapes.Array] = []
    faces: list[tuple[int, ...]] = []
    for surface in surfaces:
        (u0, u1), (v0, v1) = _ends(surface, 0), _ends(surface, 1)
        faces.append(tuple(range(len(vertices), len(vertices) + 4)))
        vertices += [shapes.xyz(surface.PointAt(*at)) for at in ((u0, v0), (u1, v0), (u1, v1), (u0, v1))]
    return shapes.mesh(vertices, faces)
