"""Natives of the tab Surface beside the usual ones: sums, nets of points, offsets, patches, boxes and cones."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from hookean.discretize import curves as arc_lengths
from hookean_canvas.run.natives import shapes
from hookean_canvas.run.natives.declare import Unfit, bounded, native
from hookean_canvas.run.natives.edges import _grid, surface_points
from hookean_canvas.run.natives.flat_faces import divided, filled
from hookean_canvas.run.natives.freeform import _cut
from hookean_canvas.run.natives.surfaces import deconstruct_brep, ruled_surface
from hookean_canvas.run.natives.surfaces_at import _of_nurbs, _to_nurbs
from hookean_canvas.run.rhino import rhino3dm

Array = shapes.Array
STEPS = 32
"""Flat quads each way of surfaces that are made of points."""
_GRIDDED = f"in {STEPS} by {STEPS} quads where it is curved"


def _run(curve: Any, steps: int = STEPS) -> Array:
    """Places at even steps of the parameter of a curve; the ends of a straight one."""
    count = 1 if curve.IsLinear() else steps
    first, last = curve.Domain.T0, curve.Domain.T1
    return shapes.rows(curve.PointAt(t) for t in np.linspace(first, last, count + 1).tolist())


@native(
    "5e33c760-adcd-4235-b1dd-05cf72eb7a38",
    "Sum Surface",
    "SumSrf",
    "Curve A (A): curve; Curve B (B): curve",
    "Sum surface (S)",
    remark=_GRIDDED,
)
def sum_surface(a: Any, b: Any) -> Any:
    """The surface that one curve leaves on its way along another, without turning."""
    u, v = _run(a), _run(b)
    return _grid(u[:, None] + v[None] - v[0])


@native("", "Extrude Along", "ExtrCrv", "Base (B): curve; Curve (C): curve", "Extrusion (E)", remark=_GRIDDED)
def extrude_along(base: Any, curve: Any) -> Any:
    """The surface that a curve leaves on its way along another, without turning."""
    return sum_surface(base, curve)


@native("", "Extrude Point", "Extr", "Base (B): curve; Point (P): point", "Extrusion (E)")
def extrude_point(base: Any, tip: Any) -> Any:
    """The surface of straight lines between a curve and a point."""
    other = base.ToNurbsCurve()
    for i in range(len(other.Points)):
        weight = other.Points[i].W
        other.Points[i] = rhino3dm.Point4d(tip.X * weight, tip.Y * weight, tip.Z * weight, weight)
    return ruled_surface(base.ToNurbsCurve(), other)


@native("", "Extrude Linear", "Extr",
        "Profile (P): curve; Orientation (P) (Po): plane optional; Axis (A): line; "
        "Orientation (A) (Ao): plane optional", "Extrusion (E)", remark="curves alone are extruded")  # fmt: skip
def extrude_linear(profile: Any, first: Any, axis: Any, second: Any) -> Any:
    """The surface that a curve leaves on its way along a line, taken from one plane to another if both are given."""
    base = profile.ToNurbsCurve()
    if first is not None and second is not None:
        base.Transform(rhino3dm.Transform.PlaneToPlane(first, second))
    moved = base.Duplicate()
    moved.Translate(shapes.vector(shapes.xyz(axis.To) - shapes.xyz(axis.From)))
    return ruled_surface(base, moved)


@native("4b04a1e1-cddf-405d-a7db-335aaa940541", "Surface From Points", "SrfGrid",
        "Points (P): point list; U Count (U): integer; Interpolate (I): boolean = True", "Surface (S)")  # fmt: skip
def surface_from_points(places: list[Any], count: int, through: bool) -> Any:
    """The surface through a grid of points, or with these as control points; `U Count` rows."""
    from scipy.interpolate import make_interp_spline

    if count < 2 or len(places) % count or len(places) // count < 2:
        raise Unfit(f"{len(places)} points are not {count} rows of two or more")
    rows = shapes.rows(places).reshape(count, -1, 3)
    orders, knots = [], []
    for axis in (0, 1):
        n = rows.shape[axis]
        k = min(3, n - 1)
        if through:
            spline = make_interp_spline(np.linspace(0.0, 1.0, n), rows, k=k, axis=axis)
            rows, found = np.moveaxis(spline.c, 0, axis) if spline.c.shape[axis] != n else spline.c, spline.t
        else:
            found = np.concatenate([[0.0] * k, np.linspace(0.0, 1.0, n - k + 1), [1.0] * k])
        orders.append(k + 1)
        knots.append(found[1:-1].tolist())
    return _to_nurbs((orders, knots, np.concatenate([rows, np.ones((*rows.shape[:2], 1))], axis=2)))


@native("75164624-395a-4d24-b60b-6bf91cab0194", "Sweep2", "Swp2",
        "Rail 1 (R1): curve; Rail 2 (R2): curve; Sections (S): curve list; Same Height (H): boolean = False",
        "Brep (S): list",
        remark="sections keep their shape relative to the distance of the rails; the surface has straight "
               "pieces")  # fmt: skip
def sweep_two(first: Any, second: Any, sections: list[Any], same_height: bool) -> list[Any]:
    """The surface that sections leave on their way between two curves."""
    given = [_cut(one) for one in sections if one is not None]
    if not given:
        raise Unfit("a section is needed")
    if len({len(one) for one in given}) > 1:
        given = [np.array(arc_lengths.divide(one, STEPS)) for one in sections if one is not None]
    if np.linalg.norm(shapes.xyz(first.PointAtStart) - shapes.xyz(second.PointAtStart)) > np.linalg.norm(
        shapes.xyz(first.PointAtStart) - shapes.xyz(second.PointAtEnd)
    ):
        second = second.Duplicate()
        second.Reverse()
    rails = [np.array(arc_lengths.divide(one, STEPS)) for one in (first, second)]
    frames = _between(*rails)
    near = [int(np.linalg.norm(rails[0][:, None] - one, axis=2).min(axis=1).argmin()) for one in given]
    order = np.argsort(near, kind="stable")
    local = np.array([(given[k] - rails[0][near[k]]) @ np.linalg.inv(frames[near[k]]) for k in order])
    for one in local:  # a section may run from the second rail to the first
        if abs(one[0, 0]) > abs(one[-1, 0]):
            one[:] = one[::-1]
    stops = np.array(near)[order].astype(float)
    rows = []
    for i, (place, frame) in enumerate(zip(rails[0], frames, strict=True)):
        weights = [float(np.interp(i, stops, np.eye(len(stops))[k])) for k in range(len(stops))]
        rows.append(place + np.tensordot(weights, local, axes=1) @ frame)
    return [_grid(np.array(rows))]


def _between(a: Array, b: Array) -> Array:
    """Axes (n, 3, 3) at places of a rail: to the other rail, along, and across, as long as the rails are apart."""
    to = b - a
    size = np.linalg.norm(to, axis=1)[:, None]
    if (size <= 1e-9 * float(np.ptp(a, axis=0).max())).any():
        raise Unfit("the rails meet")
    along = np.gradient(a, axis=0)
    up = np.cross(to, along)
    up *= size / np.linalg.norm(up, axis=1)[:, None]
    on = np.cross(up, to)
    on *= size / np.linalg.norm(on, axis=1)[:, None]
    return np.stack([to, on, up], axis=1)


@native("57b2184c-8931-4e70-9220-612ec5b3809a", "Patch", "Patch",
        "Curves (C): curve list optional; Points (P): point list optional; Spans (S): integer = 10; "
        "Flexibility (F): number = 1.0; Trim (T): boolean = True", "Patch (P)",
        remark="a mesh within the first closed curve, with the heights of a thin plate through all curves and "
               "points")  # fmt: skip
def patch(curves: list[Any] | None, places: list[Any] | None, spans: int, flexible: float, trim: bool) -> Any:
    """A smooth surface through curves and points, as a mesh."""
    from scipy.interpolate import RBFInterpolator

    given = [one for one in curves or [] if one is not None]
    loop = next((one for one in given if one.IsClosed), None)
    if loop is None:
        from hookean_canvas.run.natives.curves import join_curves

        loop = next((one for one in join_curves(given, False) if one.IsClosed), None)
    if loop is None:
        raise Unfit("a closed curve, or curves that are one when joined, are needed")
    edge = _outline(loop, 8 * max(spans, 1))
    edge = divided(edge, float(np.ptp(edge, axis=0).max()) / max(spans, 1))
    extra = [_outline(one, 4 * max(spans, 1)) for one in given if one is not loop]
    rows = np.concatenate([edge, *extra, shapes.rows(one for one in places or [] if one is not None)])
    frame = shapes.fitted_plane(edge)
    local = np.unique(np.round(shapes.coordinates(frame, rows), 12), axis=0)
    plate = RBFInterpolator(local[:, :2], local[:, 2], kernel="thin_plate_spline")
    flat, faces = filled(shapes.coordinates(frame, edge)[:, :2], [], max(spans, 1))
    return shapes.mesh(shapes.in_plane(frame, np.column_stack([flat, plate(flat)])), faces)


def _outline(curve: Any, pieces: int) -> Array:
    """The corners of a curve, or places at equal lengths of a curved one; a closed one ends before its start."""
    corners = shapes.corners(curve)
    rows = corners if corners is not None else np.array(arc_lengths.divide(curve, pieces))
    return rows[:-1] if curve.IsClosed else rows


@native("1addcc85-b04e-46e6-bd4a-6f6c93bf7efd", "Brep Join", "Join",
        "Breps (B): brep list", "Breps (B): list; Closed (C): list",
        remark="surfaces stay apart, each a Brep of its own")  # fmt: skip
def brep_join(breps: list[Any]) -> tuple[list[Any], list[bool]]:
    """Breps as they are."""
    found = [one for one in breps if one is not None]
    return found, [bool(one.IsSolid) if isinstance(one, rhino3dm.Brep) else False for one in found]


@native("d6b43673-55dd-4e2f-95c4-6c69a14513a6", "Merge Faces", "FMerge",
        "Brep (B): brep", "Brep (B); Before (N0); After (N1)",
        remark="faces stay as they are")  # fmt: skip
def merge_faces(brep: Any) -> tuple[Any, int, int]:
    """A Brep, and how many faces it has."""
    count = len(brep.Faces) if isinstance(brep, rhino3dm.Brep) else 1
    return brep, count, count


@native("fa92858a-a180-4545-ad4d-0dc644b3a2a8", "Untrim", "Untrim", "Surface (S): surface", "Surface (S)")
def untrim(surface: Any) -> Any:
    """A surface without its cuts."""
    return surface.UnderlyingSurface() if isinstance(surface, rhino3dm.BrepFace) else surface


@native(
    "c3d1f2b8-8596-4e8d-8861-c28ba8ffb4f4",
    "Flip",
    "Flip",
    "Surface (S): surface; Guide (G): surface optional",
    "Surface (S); Result (R)",
)
def flip_surface(surface: Any, guide: Any) -> tuple[Any, bool]:
    """A surface with its normals turned round; with a guide only where they point the other way in the middle."""
    if guide is not None:
        ways = [shapes.xyz(one.NormalAt(*(0.5 * (one.Domain(k).T0 + one.Domain(k).T1) for k in (0, 1))))
                for one in (surface, guide)]  # fmt: skip
        if float(ways[0] @ ways[1]) >= 0.0:
            return surface, False
    orders, (us, vs), net = _of_nurbs(surface.ToNurbsSurface())
    return _to_nurbs((orders, [[us[0] + us[-1] - one for one in reversed(us)], vs], net[::-1])), True


@native("e7e43403-f913-4d83-8aff-5b1c7a7f9fbc", "Offset Surface Loose", "Offset (L)",
        "Surface (S): surface; Distance (D): number = 1.0; Retrim (T): boolean = True", "Surface (S)",
        remark="cuts are lost")  # fmt: skip
def offset_loose(surface: Any, distance: float, retrim: bool) -> Any:
    """A surface whose control points are moved along its normals."""
    nurbs = surface.ToNurbsSurface()
    _, _, at, nu, nv = surface_points(nurbs)
    orders, knots, net = _of_nurbs(nurbs)
    normals = shapes.rows(nurbs.NormalAt(uv.X, uv.Y) for uv in at).reshape(nu, nv, 3)
    net[:, :, :3] += distance * normals * net[:, :, 3:]
    return _to_nurbs((orders, knots, net))


@native("b25c5762-f90e-4839-9fc5-74b74ab42b1e", "Offset Surface", "Offset",
        "Surface (S): surface; Distance (D): number = 1.0; Retrim (T): boolean = True", "Surface (S)",
        remark=f"{_GRIDDED}; cuts are lost")  # fmt: skip
def offset_surface(surface: Any, distance: float, retrim: bool) -> Any:
    """The surface at a distance from a surface."""
    flat = bool(surface.IsPlanar())
    ends = [np.linspace(surface.Domain(k).T0, surface.Domain(k).T1, (1 if flat else STEPS) + 1) for k in (0, 1)]
    rows = [[shapes.xyz(surface.PointAt(u, v)) + distance * shapes.unit(shapes.xyz(surface.NormalAt(u, v)))
             for v in ends[1].tolist()] for u in ends[0].tolist()]  # fmt: skip
    return _grid(np.array(rows))


@native("", "Brep Wireframe", "Wires", "Brep (B): brep; Density (D): integer = 0", "Wireframe (W): list",
        remark="the edges alone, whatever the density")  # fmt: skip
def brep_wireframe(brep: Any, density: int) -> list[Any]:
    """The edges of a Brep."""
    edges: list[Any] = deconstruct_brep(brep)[1]
    return edges


@native("", "Deconstruct Box", "DeBox", "Box (B): anybox", "Plane (P); X (X); Y (Y); Z (Z)")
def deconstruct_box(box: Any) -> tuple[Any, Any, Any, Any]:
    """The plane at the middle of a box, and its reach along the three axes."""
    low, along, size = shapes.box_axes(box)
    sides = (rhino3dm.Interval(-0.5 * one, 0.5 * one) for one in size.tolist())
    return (shapes.plane(low + (0.5 * size) @ along, along[0], along[1]), *sides)


@native("", "Evaluate Box", "BoxEval",
        "Box (B): anybox; U parameter (U): number = 0.5; V parameter (V): number = 0.5; W parameter (W): number = 0.5",
        "Plane (Pl); Point (Pt); Include (I)")  # fmt: skip
def evaluate_box(box: Any, u: float, v: float, w: float) -> tuple[Any, Any, bool]:
    """The point at parts of the sides of a box, the plane there, and whether it is in the box."""
    low, along, size = shapes.box_axes(box)
    at = low + (np.array([u, v, w]) * size) @ along
    return shapes.plane(at, along[0], along[1]), shapes.point(at), all(0.0 <= one <= 1.0 for one in (u, v, w))


@native("", "Box Rectangle", "BoxRec", "Rectangle (R): rectangle; Height (H): domain", "Box (B)")
def box_rectangle(outline: tuple[Any, float, float], height: Any) -> Any:
    """The box over a rectangle between two heights."""
    frame, x, y = outline
    return shapes.box_in(frame, (0.0, 0.0, height.T0), (x, y, height.T1))


@native("", "Domain Box", "Box", "Base (B): plane; X (X): domain; Y (Y): domain; Z (Z): domain", "Box (B)")
def domain_box(frame: Any, x: Any, y: Any, z: Any) -> Any:
    """The box of three domains along the axes of a plane."""
    return shapes.box_in(frame, (x.T0, y.T0, z.T0), (x.T1, y.T1, z.T1))


@native("", "Cone", "Cone", "Base (B): plane; Radius (R): number = 1.0; Length (L): number = 1.0",
        "Cone (C); Tip (T)")  # fmt: skip
def cone(frame: Any, radius: float, length: float) -> tuple[Any, Any]:
    """The wall of a cone over a plane, and its tip."""
    if radius <= 0.0 or length == 0.0:
        raise Unfit("Radius must be positive, and Length not 0")
    circle = rhino3dm.ArcCurve.CreateFromCircle(rhino3dm.Circle(radius))
    circle.Transform(rhino3dm.Transform.PlaneToPlane(shapes.plane((0, 0, 0), (1, 0, 0), (0, 1, 0)), frame))
    tip = shapes.point(shapes.in_plane(frame, [(0.0, 0.0, length)])[0])
    return extrude_point(circle, tip), tip


@native("", "Quad Sphere", "QSph", "Base (B): plane; Radius (R): number = 1.0", "Sphere (S)")
def quad_sphere(frame: Any, radius: float) -> Any:
    """A sphere of six faces about the origin of a plane."""
    if radius <= 0.0:
        raise Unfit("Radius must be above 0")
    return rhino3dm.Brep.CreateQuadSphere(rhino3dm.Sphere(frame.Origin, radius))


@native("", "Sphere Fit", "SFit", "Points (P): point list", "Sphere (S); Radius (R)")
def sphere_fit(places: list[Any]) -> tuple[Any, float]:
    """The sphere of least squares of |p|^2 - 2 p . c + (|c|^2 - r^2) = 0 through points."""
    rows = shapes.rows(places)
    if len(rows) < 4 or np.linalg.matrix_rank(rows[1:] - rows[0], tol=1e-9 * float(np.ptp(rows, axis=0).max())) < 3:
        raise Unfit("four points that are not in a plane are needed")
    middle = rows.mean(axis=0)
    local = rows - middle
    system = np.column_stack([2.0 * local, np.ones(len(local))])
    *centre, rest = np.linalg.lstsq(system, (local**2).sum(axis=1), rcond=None)[0].tolist()
    radius = math.sqrt(max(rest + float(np.dot(centre, centre)), 0.0))
    return rhino3dm.Sphere(shapes.point(middle + centre), radius).ToBrep(), radius


@native("", "Sphere 4Pt", "Sph4Pt",
        "Point 1 (P1): point; Point 2 (P2): point; Point 3 (P3): point; Point 4 (P4): point",
        "Center (C); Radius (R); Sphere (S)")  # fmt: skip
def sphere_of_four(*places: Any) -> tuple[Any, float, Any]:
    """The sphere through four points."""
    ball, radius = sphere_fit(list(places))
    box = ball.GetBoundingBox()
    return shapes.point(0.5 * (shapes.xyz(box.Min) + shapes.xyz(box.Max))), radius, ball


@native("", "Is Planar", "Planar", "Surface (S): surface; Interior (I): boolean = False", "Planar (F); Plane (P)")
def is_planar(surface: Any, interior: bool) -> tuple[bool, Any]:
    """Whether a surface is flat within 0.001, and its plane."""
    ends = [np.linspace(surface.Domain(k).T0, surface.Domain(k).T1, 9).tolist() for k in (0, 1)]
    rows = shapes.rows(surface.PointAt(u, v) for u in ends[0] for v in ends[1])
    frame = shapes.fitted_plane(rows)
    bounded(len(rows))
    return float(np.abs(shapes.coordinates(frame, rows)[:, 2]).max()) <= 1e-3, frame
