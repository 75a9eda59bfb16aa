"""Natives of the tab Transform that bend geometry: twisted, tapered, stretched, flowing along curves.

Curves but polylines, and surfaces, are bent by their control points.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from hookean.discretize import curves as arc_lengths
from hookean_canvas.run.natives import shapes
from hookean_canvas.run.natives.curves import _at_length, _upto
from hookean_canvas.run.natives.curves_at import _across, _carried, nearest
from hookean_canvas.run.natives.declare import Unfit, native
from hookean_canvas.run.natives.morphs import _BY_POINTS, TwistedBox, _bent
from hookean_canvas.run.natives.surfaces_at import domain2

Array = shapes.Array
_GEOMETRY = "Geometry (G): geometry"
_AXIS = f"{_GEOMETRY}; Axis (X): line"
_RIGID = "Rigid (R): boolean = False"
FRAMES = 200
"""Places along a curve at which its frame is known."""


def bent(geometry: Any, change: Callable[[Array], Array], rigid: bool = False) -> Any:
    """Geometry, or that of a group, with its points moved by a function of rows (n, 3)."""
    if rigid:
        raise Unfit("geometry that is moved without being deformed is not made here")
    if isinstance(geometry, shapes.Group):
        return shapes.Group(tuple(bent(one, change) for one in geometry.members))
    return _bent(geometry, change)


def _line(axis: Any) -> tuple[Array, Array, float]:
    """Start, unit direction and length of an axis."""
    start = shapes.xyz(axis.From)
    way = shapes.xyz(axis.To) - start
    length = float(np.linalg.norm(way))
    if length == 0.0:
        raise Unfit("the axis has no length")
    return start, way / length, length


@native("9509cb30-d24f-4f55-a5ac-bf0b12a06cfa", "Twist", "Twist",
        f"{_AXIS}; Angle (A): number; Infinite (I): boolean = False; {_RIGID}", "Geometry (G)",
        remark=_BY_POINTS)  # fmt: skip
def twist(geometry: Any, axis: Any, angle: float, infinite: bool, rigid: bool) -> Any:
    """Geometry turned about an axis, more and more from its start to its end; beyond it as at its ends."""
    start, way, length = _line(axis)

    def change(rows: Array) -> Array:
        along = (rows - start) @ way
        turn = angle * (along / length if infinite else np.clip(along / length, 0.0, 1.0))
        across = rows - start - along[:, None] * way
        return np.asarray(
            start
            + along[:, None] * way
            + np.cos(turn)[:, None] * across
            + np.sin(turn)[:, None] * np.cross(way, across)
        )

    return bent(geometry, change, rigid)


@native("ad0ee51e-c86f-4668-8de5-b55b850f6001", "Taper", "Taper",
        f"{_AXIS}; Start (R0): number = 1.0; End (R1): number = 0.5; Flat (F): boolean = False; "
        f"Infinite (I): boolean = False; {_RIGID}", "Geometry (G)", remark=_BY_POINTS)  # fmt: skip
def taper(
    geometry: Any, axis: Any, first: float, second: float, flat: bool, infinite: bool, rigid: bool
) -> Any:  # fmt: skip
    """Geometry drawn to an axis or away from it: by a factor of 1 at its start, and of the radii's ratio at its end."""
    start, way, length = _line(axis)
    if first == 0.0 or flat:
        raise Unfit("Start must not be 0, and Flat is not made here")

    def change(rows: Array) -> Array:
        along = (rows - start) @ way
        part = along / length if infinite else np.clip(along / length, 0.0, 1.0)
        across = rows - start - along[:, None] * way
        return np.asarray(start + along[:, None] * way + (1.0 + part * (second / first - 1.0))[:, None] * across)

    return bent(geometry, change, rigid)


@native("2a27f87c-61c5-47c2-a0b7-7863f31a3594", "Stretch", "Stretch",
        f"{_AXIS}; Length (L): number; {_RIGID}", "Geometry (G)", remark=_BY_POINTS)  # fmt: skip
def stretch(geometry: Any, axis: Any, new: float, rigid: bool) -> Any:
    """Geometry stretched between the ends of an axis to another length; what is beyond its end is moved."""
    start, way, length = _line(axis)

    def change(rows: Array) -> Array:
        along = (rows - start) @ way
        return np.asarray(rows + (np.clip(along, 0.0, length) * (new / length - 1.0))[:, None] * way)

    return bent(geometry, change, rigid)


@native("134a849b-0ff4-4f36-bdd5-95e3996bae8b", "Maelstrom", "Maelstrom",
        f"{_GEOMETRY}; Plane (P): plane; First radius (R0): number = 1.0; Second radius (R1): number = 10.0; "
        f"Angle (A): number; {_RIGID}", "Geometry (G)", remark=_BY_POINTS)  # fmt: skip
def maelstrom(geometry: Any, frame: Any, first: float, second: float, angle: float, rigid: bool) -> Any:
    """Geometry turned about the normal of a plane: by an angle within the first radius, by none beyond the second."""
    if first == second:
        raise Unfit("the radii must differ")

    def change(rows: Array) -> Array:
        x, y, z = shapes.coordinates(frame, rows).T
        turn = angle * (1.0 - np.clip((np.hypot(x, y) - first) / (second - first), 0.0, 1.0))
        cos, sin = np.cos(turn), np.sin(turn)
        return shapes.in_plane(frame, np.stack([cos * x - sin * y, sin * x + cos * y, z], axis=1))

    return bent(geometry, change, rigid)


@native("539f5564-4fc0-4fc1-a7d3-b802fa2ef072", "Bend Deform", "Bend", f"{_GEOMETRY}; Bending Arc (B): curve",
        "Geometry (G)", remark=_BY_POINTS)  # fmt: skip
def bend_deform(geometry: Any, arc: Any) -> Any:
    """Geometry along the tangent at the start of an arc bent to the arc; beyond its end it goes on straight."""
    start, way = shapes.xyz(arc.PointAtStart), shapes.unit(shapes.xyz(arc.TangentAtStart))
    middle, end = (shapes.xyz(one) for one in (arc.PointAt(0.5 * (arc.Domain.T0 + arc.Domain.T1)), arc.PointAtEnd))
    normal = np.cross(middle - start, end - start)
    if not normal.any():
        return geometry
    normal = shapes.unit(normal)
    inward = np.cross(normal, way)
    chord = end - start
    radius = float(chord @ chord) / (2.0 * float(chord @ inward))
    most = arc_lengths.length(arc)

    def change(rows: Array) -> Array:
        along, inside = (rows - start) @ way, (rows - start) @ inward
        over = np.clip(along, 0.0, most)
        turn, rest = over / radius, along - over
        out = radius - inside
        x = out * np.sin(turn) + rest * np.cos(turn)
        y = radius - out * np.cos(turn) + rest * np.sin(turn)
        across = (rows - start) @ normal
        return np.asarray(start + x[:, None] * way + y[:, None] * inward + across[:, None] * normal)

    return bent(geometry, change)


@native("c3249da4-3f8e-4400-833e-e4e984d28657", "Flow", "Flow",
        f"{_GEOMETRY}; Base (C0): curve; Target (C1): curve; Reverse Base (R0): boolean = False; "
        f"Reverse Target (R1): boolean = False; Stretch (S): boolean = False; {_RIGID}", "Geometry (G)",
        remark=f"{_BY_POINTS}; frames turn as little as they can along both curves")  # fmt: skip
def flow(
    geometry: Any, base: Any, target: Any, back: bool, turned: bool, stretched: bool, rigid: bool
) -> Any:  # fmt: skip
    """Geometry along one curve put along another, at equal lengths, or at equal parts of both."""
    runs = [_framed(curve, other) for curve, other in ((base, back), (target, turned))]
    scale = runs[1][0] / runs[0][0] if stretched else 1.0

    def change(rows: Array) -> Array:
        found = []
        for row in rows:
            at = _upto(base, nearest(base, row))
            at = runs[0][0] - at if back else at
            place, axes = runs[0][1](at)
            moved_to, turned_to = runs[1][1](at * scale)
            found.append(moved_to + axes @ (row - place) @ turned_to)
        return np.array(found)

    return bent(geometry, change, rigid)


def _framed(curve: Any, back: bool) -> tuple[float, Callable[[float], tuple[Array, Array]]]:
    """The length of a curve, and its point and axes (rows: along, two across) at a length from its start."""
    if back:
        curve = curve.Duplicate()
        curve.Reverse()
    length = arc_lengths.length(curve)
    at = [_at_length(curve, s) for s in np.linspace(0.0, length, FRAMES + 1).tolist()]
    places, ways = shapes.rows(map(curve.PointAt, at)), shapes.rows(map(curve.TangentAt, at))
    sides = [_across(ways[0])]
    for i in range(1, len(at)):
        sides.append(_carried(sides[-1], places[i - 1], ways[i - 1], places[i], ways[i]))

    def frame(s: float) -> tuple[Array, Array]:
        t = _at_length(curve, min(max(s, 0.0), length))
        place, way = shapes.xyz(curve.PointAt(t)), shapes.unit(shapes.xyz(curve.TangentAt(t)))
        k = min(round(s / length * FRAMES), FRAMES) if s > 0.0 else 0
        side = shapes.unit(sides[k] - float(sides[k] @ way) * way)
        return place + (s - min(max(s, 0.0), length)) * way, np.array([way, side, np.cross(way, side)])

    return length, frame


@native("fc5b7d12-7247-4de0-81bc-9b2c2f8f72f6", "Map to Surface", "Map Srf",
        "Curve (C): curve; Source (S): surface; Target (T): surface", "Curve (C)", remark=_BY_POINTS)  # fmt: skip
def map_to_surface(curve: Any, source: Any, target: Any) -> Any:
    """A curve with its points at the same parameters of another surface."""
    from hookean_canvas.run.natives.surfaces_at import surface_closest_point

    ends = [[(one.Domain(k).T0, one.Domain(k).T1) for k in (0, 1)] for one in (source, target)]

    def change(rows: Array) -> Array:
        found = []
        for row in rows:
            _, uv, _ = surface_closest_point(shapes.point(row), source)
            parts = [(w - a) / (b - a) for w, (a, b) in zip((uv.X, uv.Y), ends[0], strict=True)]
            u, v = (a + part * (b - a) for part, (a, b) in zip(parts, ends[1], strict=True))
            found.append(shapes.xyz(target.PointAt(u, v)))
        return np.array(found)

    return bent(curve, change)


@native("66e6596f-6c8f-4ac3-99e0-0c4b7a59a7f7", "Spatial Deform", "Deform",
        f"{_GEOMETRY}; Syntax (S): point list; Forces (F): vector list", "Geometry (G)",
        remark=f"{_BY_POINTS}; forces are weighted by the inverse square of the distance")  # fmt: skip
def spatial_deform(geometry: Any, places: list[Any], forces: list[Any]) -> Any:
    """Geometry moved by the mean of vectors at points, weighted by nearness."""
    if not places or not forces:
        raise Unfit("points and forces are needed")
    at = shapes.rows(places)
    by = shapes.rows([forces[min(i, len(forces) - 1)] for i in range(len(places))])

    def change(rows: Array) -> Array:
        square = ((rows[:, None] - at) ** 2).sum(axis=2)
        weights = 1.0 / np.maximum(square, 1e-24)
        return np.asarray(rows + (weights @ by) / weights.sum(axis=1)[:, None])

    return bent(geometry, change)


@native("4dbd15c7-ebcb-4af6-b3bd-32e80502520c", "Point Deform", "PDeform",
        f"{_GEOMETRY}; Points (P): point list; Motion (M): vector list", "Geometry (G)")  # fmt: skip
def point_deform(geometry: Any, places: list[Any], motions: list[Any]) -> Any:
    """Geometry whose control points, corners or vertices nearest to points are moved by vectors."""
    if not places or not motions:
        raise Unfit("points and motions are needed")
    at = shapes.rows(places)
    by = shapes.rows([motions[min(i, len(motions) - 1)] for i in range(len(places))])
    size = max(float(np.ptp(at, axis=0).max()), 1e-3)

    def change(rows: Array) -> Array:
        apart = np.linalg.norm(rows[:, None] - at, axis=2)
        near = apart.argmin(axis=1)
        return np.asarray(rows + np.where((apart.min(axis=1) <= 1e-6 * size)[:, None], by[near], 0.0))

    return bent(geometry, change)


@native("124de0f5-65f8-4ae0-8f61-8fb066e2ba02", "Twisted Box", "TBox",
        "; ".join(f"Corner {name} ({name}): point" for name in "ABCDEFGH"), "Twisted Box (B)")  # fmt: skip
def twisted_box(*corners: Any) -> TwistedBox:
    """The box between eight corners: four below, in their order round, and four above them."""
    rows = shapes.rows(corners)
    order = [0, 4, 3, 7, 1, 5, 2, 6]  # by x, then y, then z
    return TwistedBox(rows[order].reshape(2, 2, 2, 3))


@native("6283fb37-e273-4eb2-8d2a-e347881e3928", "Blend Box", "BlendBox",
        "Surface A (Sa): surface; Domain A (Da): any; Surface B (Sb): surface; Domain B (Db): any",
        "Twisted Box (B)")  # fmt: skip
def blend_box(a: Any, first: Any, b: Any, second: Any) -> TwistedBox:
    """The box between the corners of a domain on one surface and those on another."""
    parts = [(a, domain2(first)), (b, domain2(second))]
    rows = [shapes.xyz(one.PointAt(part.u[i], part.v[j])) for i in (0, 1) for j in (0, 1) for one, part in parts]
    return TwistedBox(np.array(rows).reshape(2, 2, 2, 3))
