"""Natives that make curves and surfaces beside or along curves: offsets, revolutions, sweeps, networks.

Surfaces that Rhino would fit are of degree 1 here, through points on what they fit.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from hookean.discretize import curves as arc_lengths
from hookean_canvas.run.natives import shapes
from hookean_canvas.run.natives.curves_at import _across, _carried
from hookean_canvas.run.natives.declare import Unfit, native
from hookean_canvas.run.natives.edges import _grid
from hookean_canvas.run.rhino import rhino3dm

PIECES = 50
"""Of a curved curve where it is cut."""
SHARPEST = 1e-3  # of 2: below it a polyline turns back
STEPS = 12  # towards where two curves cross
MET = 1e-3  # how far curves of a network may miss each other, as a part of its size


@native("1a38d325-98de-455c-93f1-bca431bc1243", "Offset Curve", "Offset",
        "Curve (C): curve; Distance (D): number = 1.0; Plane (P): plane; Corners (C): integer = 1", "Curve (C): list",
        remark="corners are sharp; curved curves but circles become polylines of 50 pieces; what would cross itself is "
               "an error")  # fmt: skip
def offset_curve(curve: Any, distance: float, frame: Any, corners: int) -> list[Any]:
    """A curve at a distance in a plane: to its right seen from above, so that circles that run to the left grow."""
    circle = curve.TryGetCircle() if curve.IsCircle() else None
    if circle is not None and abs(float(shapes.axes(frame)[3] @ shapes.xyz(circle.Plane.ZAxis))) > 1.0 - 1e-9:
        # by which way it runs round about the axis of the plane
        start, centre = shapes.xyz(curve.PointAtStart), shapes.xyz(circle.Center)
        left = float(np.cross(start - centre, shapes.xyz(curve.TangentAtStart)) @ shapes.axes(frame)[3])
        circle.Radius += math.copysign(distance, distance * left)
        if not circle.Radius > 0.0:
            raise Unfit("the distance is larger than the radius")
        return [rhino3dm.ArcCurve.CreateFromCircle(circle)]
    at = shapes.corners(curve)
    local = shapes.coordinates(frame, np.array(arc_lengths.divide(curve, PIECES)) if at is None else at)
    local[:, :2] = _beside(local[:, :2], distance)
    return [shapes.polyline(shapes.in_plane(frame, local))]


def _beside(at: shapes.Array, distance: float) -> shapes.Array:
    """Corners (n, 2) of a polyline moved to its right, so that each side is at the distance."""
    sides = np.diff(at, axis=0)
    lengths = np.linalg.norm(sides, axis=1, keepdims=True)
    if not lengths.all():
        raise Unfit("a piece of the curve has no length in the plane")
    right = np.stack([sides[:, 1], -sides[:, 0]], axis=1) / lengths
    closed = np.linalg.norm(at[0] - at[-1]) <= 1e-9 * np.ptp(at, axis=0).max()
    before = np.concatenate([right[-1:] if closed else right[:1], right])
    after = np.concatenate([right, right[:1] if closed else right[-1:]])
    turn = 1.0 + (before * after).sum(axis=1, keepdims=True)
    if (turn < SHARPEST).any():
        raise Unfit("the curve turns back on itself")
    found: shapes.Array = at + distance * (before + after) / turn
    if ((np.diff(found, axis=0) * sides).sum(axis=1) <= 0.0).any():
        raise Unfit("the distance is too large: the offset crosses itself")
    return found


@native("cdee962f-4202-456b-a1b4-f3ed9aa0dc29", "Revolution", "RevSrf",
        "Profile curve (P): curve; Axis (A): line; Domain (D): domain = (0.0, 6.283185307179586)",
        "Surface (S)")  # fmt: skip
def revolution(profile: Any, axis: Any, angles: Any) -> Any:
    """The surface that a curve leaves on its way round an axis, between two angles in radians."""
    found = rhino3dm.RevSurface.Create(profile, axis, angles.T0, angles.T1) if angles.T0 < angles.T1 else None
    if found is None:
        raise Unfit("no surface can be made round this axis")
    return found.ToNurbsSurface()


@native("bb6666e7-d0f4-41ec-a257-df2371619f13", "Sweep1", "Swp1",
        "Rail (R): curve; Sections (S): curve list; Miter (M): integer = 0", "Brep (S): list",
        remark="sections turn as little as they can, and change in proportion to the length of the rail between them; "
               "the surface has straight pieces")  # fmt: skip
def sweep_along(rail: Any, sections: list[Any], miter: int) -> list[Any]:
    """The surface that sections leave on their way along a curve."""
    given = [_cut(section) for section in sections if section is not None]
    if not given:
        raise Unfit("a section is needed")
    if len({len(section) for section in given}) > 1:
        given = [np.array(arc_lengths.divide(section, PIECES)) for section in sections if section is not None]
    places, frames = _frames(rail)
    nearest = [int(np.linalg.norm(places[:, None] - one, axis=2).min(axis=1).argmin()) for one in given]
    order = np.argsort(nearest, kind="stable")
    if len(set(nearest)) < len(nearest):
        raise Unfit("two sections are at one place of the rail")
    local = np.array([(given[k] - places[nearest[k]]) @ np.linalg.inv(frames[nearest[k]]) for k in order])
    along = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(places, axis=0), axis=1)))
    stops = along[np.array(nearest)[order]]
    row = []
    for place, frame, at in zip(places, frames, along, strict=True):
        k = min(max(int(np.searchsorted(stops, at)), 1), len(stops) - 1)
        part = np.clip((at - stops[k - 1]) / (stops[k] - stops[k - 1]), 0.0, 1.0) if len(stops) > 1 else 0.0
        row.append(place + ((1.0 - part) * local[k - 1] + part * local[k]) @ frame if k else place + local[0] @ frame)
    return [_grid(np.array(row))]


def _cut(curve: Any) -> shapes.Array:
    at = shapes.corners(curve)
    return np.array(arc_lengths.divide(curve, PIECES)) if at is None else at


def _frames(rail: Any) -> tuple[shapes.Array, shapes.Array]:
    """Places (n, 3) along a rail and there the rows across, across and along it; across a corner they are longer."""
    places = _cut(rail)
    ways = np.array([shapes.unit(step) for step in np.diff(places, axis=0)])
    closed = bool(rail.IsClosed)
    before = np.concatenate([ways[-1:] if closed else ways[:1], ways])
    after = np.concatenate([ways, ways[:1] if closed else ways[-1:]])
    tangents = np.array([shapes.unit(step) for step in before + after])
    if not ((before + after) ** 2).sum(axis=1).min() > SHARPEST:
        raise Unfit("the rail turns back on itself")
    across = [_across(tangents[0])]
    for i in range(1, len(places)):
        across.append(_carried(across[-1], places[i - 1], tangents[i - 1], places[i], tangents[i]))
    x = np.array(across)
    frames = np.stack([x, np.cross(tangents, x), tangents], axis=1)
    for i, (one, two, t) in enumerate(zip(before, after, tangents, strict=True)):
        bend = shapes.unit(two - one)
        frames[i] += (1.0 / float(one @ t) - 1.0) * np.outer(frames[i] @ bend, bend)
    return places, frames


@native("71506fa8-9bf0-432d-b897-b2e0c5ac316c", "Network Surface", "NetSurf",
        "Curves U (U): curve list; Curves V (V): curve list; Continuity (C): integer = 1", "Surface (S)",
        remark="Gordon's surface between the outer curves, which all have to meet; the surface has straight "
               "pieces")  # fmt: skip
def network_surface(us: list[Any], vs: list[Any], continuity: int) -> Any:
    """A surface through two families of curves that cross (Gordon 1969)."""
    families = [[curve for curve in family if curve is not None] for family in (us, vs)]
    if min(map(len, families)) < 2:
        raise Unfit("two curves or more are needed each way")
    met = np.array([[_crossing(u, v) for v in families[1]] for u in families[0]])
    size = max(float(np.ptp(_cut(curve), axis=0).max()) for family in families for curve in family)
    if met[:, :, 2].max() > MET * size:
        raise Unfit("a curve of one family does not meet one of the other")
    turned = [_turned(met[:, :, 0]), _turned(met[:, :, 1].T)]
    s = np.where(turned[0][:, None], 1.0 - met[:, :, 0], met[:, :, 0])
    t = np.where(turned[1], 1.0 - met[:, :, 1], met[:, :, 1])
    rows, columns = np.argsort(t.mean(axis=1), kind="stable"), np.argsort(s.mean(axis=0), kind="stable")
    s, t = s[rows][:, columns], t[rows][:, columns]
    if (np.diff(s, axis=1) <= 0.0).any() or (np.diff(t, axis=0) <= 0.0).any():
        raise Unfit("the curves do not cross one another in one order")
    u_lines = [_run(families[0][k], turned[0][k]) for k in rows]
    v_lines = [_run(families[1][k], turned[1][k]) for k in columns]
    return _grid(_gordon(u_lines, v_lines, s, t))


def _run(curve: Any, turned: bool) -> Callable[[float], shapes.Array]:
    """Places of a curve by a parameter from 0 to 1, from its end on if it is turned."""
    start, end = (curve.Domain.T1, curve.Domain.T0) if turned else (curve.Domain.T0, curve.Domain.T1)
    return lambda part: shapes.xyz(curve.PointAt((1.0 - part) * start + part * end))


def _turned(met: shapes.Array) -> Any:
    """Which curves (rows) meet the others the other way round than the first."""
    return ((met - met.mean(axis=1, keepdims=True)) @ (met[0] - met[0].mean())) < 0.0


def _crossing(one: Any, other: Any) -> tuple[float, float, float]:
    """Where two curves are nearest, as parameters from 0 to 1, and how far they are apart there (Gauss-Newton)."""
    at = np.linspace(0.0, 1.0, 2 * PIECES + 1)
    lines = [_run(one, False), _run(other, False)]
    a, b = (np.array([line(part) for part in at]) for line in lines)
    found = at[list(np.unravel_index(int(((a[:, None] - b) ** 2).sum(axis=2).argmin()), (len(at), len(at))))]
    for _ in range(STEPS):
        off = lines[0](found[0]) - lines[1](found[1])
        slopes = [
            shapes.xyz(curve.DerivativeAt(curve.Domain.T0 + part * width, 1)[1]) * width
            for curve, part, width in (
                (c, p, c.Domain.T1 - c.Domain.T0) for c, p in zip((one, other), found, strict=True)
            )
        ]
        step = np.linalg.lstsq(np.column_stack([slopes[0], -slopes[1]]), off, rcond=None)[0]
        found = np.clip(found - np.clip(step, -1.0 / PIECES, 1.0 / PIECES), 0.0, 1.0)
    s, t = found.tolist()
    return s, t, float(np.linalg.norm(lines[0](s) - lines[1](t)))


def _gordon(u_lines: list[Any], v_lines: list[Any], s: shapes.Array, t: shapes.Array) -> shapes.Array:
    """Points [i, j] of the surface: that through the U lines and that through the V lines, less that through where they
    cross; s and t are the parameters there."""
    from scipy.interpolate import make_interp_spline

    def through(knots: shapes.Array, places: shapes.Array, at: shapes.Array) -> shapes.Array:
        found: shapes.Array = make_interp_spline(knots, places, k=min(3, len(knots) - 1))(at)
        return found

    knots = [(mean - mean[0]) / (mean[-1] - mean[0]) for mean in (s.mean(axis=0), t.mean(axis=1))]
    across, up = (np.unique(np.append(np.linspace(0.0, 1.0, PIECES // 2 + 1), one)) for one in knots)
    along_u = np.array([[line(part) for part in np.interp(across, knots[0], s[i])] for i, line in enumerate(u_lines)])
    along_v = np.array([[line(part) for part in np.interp(up, knots[1], t[:, j])] for j, line in enumerate(v_lines)])
    corners = np.array([[line(part) for part in s[i]] for i, line in enumerate(u_lines)])
    lofted = through(knots[1], along_u, up).swapaxes(0, 1)
    crossed = through(knots[1], through(knots[0], corners.swapaxes(0, 1), across).swapaxes(0, 1), up).swapaxes(0, 1)
    return lofted + through(knots[0], along_v, across) - crossed
