from __future__ import annotations

import math
from itertools import pairwise
from types import SimpleNamespace
from typing import Any

import compas.geometry as cg
import numpy as np
import pytest
import rhino3dm as r
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.interpolate import BSpline
from scipy.optimize import brentq
from scipy.special import ellipe

from hookean.discretize import divide, end_points, explode, length, shatter
from hookean.errors import InputError
from soak import examples

EPS = np.finfo(float).eps
few = settings(derandomize=True, deadline=None, max_examples=examples(40))

# a knot of degree + 1 fold multiplicity inside tears the curve
BROKEN = SimpleNamespace(
    points=[[0, 0, 0], [1, 0, 0], [5, 0, 0], [6, 0, 0]], knots=(), knotvector=[0, 0, 1, 1, 2, 2], degree=1
)


def xyz(p: Any) -> np.ndarray:
    return np.array([p.X, p.Y, p.Z])


@few
@given(st.floats(1e-3, 1e3), st.floats(0.01, 6.28), st.integers(1, 60), st.floats(0, 3))
def test_arc_is_cut_at_equal_angles(radius: float, angle: float, count: int, turn: float) -> None:
    plane = r.Plane(r.Point3d(1, -2, 3), r.Vector3d(math.sin(turn), 0.3, math.cos(turn)))
    circle = r.Circle(radius)
    circle.Plane = plane
    arc = r.Arc(circle, angle)
    frame = cg.Frame(*[[p.X, p.Y, p.Z] for p in (plane.Origin, plane.XAxis, plane.YAxis)])
    t = angle * np.arange(count + 1) / count
    want = xyz(plane.Origin) + radius * (np.cos(t)[:, None] * xyz(plane.XAxis) + np.sin(t)[:, None] * xyz(plane.YAxis))
    for curve in (arc, arc.ToNurbsCurve(), cg.Arc(radius, 0.0, angle, frame=frame)):
        assert length(curve) == pytest.approx(radius * angle, rel=1e-12)
        # a position is as good as the whole length (1e-12 L) and float64 at the coordinates' size
        assert np.abs(divide(curve, count) - want).max() <= 1e-12 * radius * angle + 20 * EPS * (4 + radius)


def test_closed_curves_give_distinct_points_and_the_first_again() -> None:
    for circle in (r.Circle(r.Point3d(0, 0, 0), 2.0), cg.Circle(2.0)):
        points = divide(circle, 12)
        assert points.shape == (13, 3)
        assert np.array_equal(points[0], points[-1])
        chords = np.linalg.norm(np.diff(points, axis=0), axis=1)
        assert chords == pytest.approx(np.full(12, 4 * math.sin(math.pi / 12)), rel=1e-12)
        assert divide(circle, 1).shape == (2, 3)


@few
@given(st.floats(0.05, 1.0))
def test_ellipse_has_its_complete_integral_as_length(ratio: float) -> None:
    # 4 a E(e^2)
    want = 4 * 3.0 * ellipe(1 - ratio**2)
    assert length(cg.Ellipse(3.0, 3.0 * ratio)) == pytest.approx(want, rel=1e-11)


def test_parabola_has_its_closed_form_length() -> None:
    # y = x^2 from 0 to 1: (2 sqrt 5 + asinh 2) / 4
    want = (2 * math.sqrt(5) + math.asinh(2)) / 4
    assert length(cg.Bezier([[0, 0, 0], [0.5, 0, 0], [1, 1, 0]])) == pytest.approx(want, rel=1e-13)


def test_cusp_inside_a_span() -> None:
    cusp = cg.Bezier([[0, 0, 0], [1, 1, 0], [0, 1, 0], [1, 0, 0]])
    # x' = 3 (1 - 2 t)^2, y' = 3 (1 - 2 t): with s = |1 - 2 t| the length is 3 times the integral of s sqrt(s^2 + 1)
    want = (2**1.5 - 1) / 3 * 3
    assert length(cusp) == pytest.approx(want, rel=1e-11)
    points = divide(cusp, 4)
    assert points[2] == pytest.approx([0.5, 0.75, 0.0], abs=1e-7)  # speed is zero here: s ~ sqrt of the error
    assert points[1] == pytest.approx([1 - points[3][0], points[3][1], 0.0], abs=1e-10)


@few
@given(st.lists(st.tuples(*[st.integers(-50, 50)] * 3), min_size=2, max_size=12), st.integers(1, 30))
def test_polyline_is_cut_where_interpolation_says(corners: list[tuple[int, int, int]], count: int) -> None:
    points = np.array(corners, dtype=float)
    upto = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    if upto[-1] == 0:
        with pytest.raises(InputError, match="zero length"):
            divide(points, count)
        return
    at = upto[-1] * np.arange(count + 1) / count
    apart = np.concatenate([[True], np.diff(upto) > 0])
    want = np.stack([np.interp(at, upto[apart], points[apart, i]) for i in range(3)], axis=1)
    assert np.abs(divide(points, count) - want).max() <= 50 * EPS * upto[-1] + 50 * EPS * 50
    lines = explode(points)
    assert np.array_equal(lines, np.stack([points[:-1], points[1:]], 1)[np.diff(upto) > 0])


@pytest.mark.slow
@settings(few, max_examples=examples(25))
@given(st.integers(0, 10**6), st.integers(1, 5), st.integers(0, 6), st.booleans())
def test_nurbs_pieces_are_equal_by_quadrature(seed: int, degree: int, more: int, kink: bool) -> None:
    rng = np.random.default_rng(seed)
    n = degree + 1 + more
    points, weights = rng.uniform(-1, 1, (n, 3)), rng.uniform(0.3, 3, n)
    inner = np.sort(rng.uniform(0.1, 1.9, more))
    if kink and more >= degree:
        inner[:degree] = inner[0]  # full multiplicity: the direction jumps
    knots = np.concatenate([np.zeros(degree + 1), np.sort(inner), np.full(degree + 1, 2.0)])
    curve = SimpleNamespace(points=points, weights=weights, knots=(), knotvector=knots, degree=degree)
    spline = BSpline(knots, np.c_[points * weights[:, None], weights], degree)
    slope = spline.derivative()

    def at(t: float) -> np.ndarray:
        return spline(t)[:3] / spline(t)[3]

    def speed(t: float) -> float:
        a, d = spline(t), slope(t)
        return float(np.linalg.norm((d[:3] - a[:3] / a[3] * d[3]) / a[3]))

    def integral(a: float, b: float) -> float:
        inside = [k for k in np.unique(knots) if a < k < b]
        stops = [a, *inside, b]
        return sum(quad(speed, x, y, epsabs=1e-12, epsrel=1e-11, limit=500)[0] for x, y in pairwise(stops))

    whole = integral(0.0, 2.0)
    assert length(curve) == pytest.approx(whole, rel=1e-10)
    cut = divide(curve, 2)
    assert cut[0] == pytest.approx(points[0], abs=1e-14) and cut[2] == pytest.approx(points[-1], abs=1e-14)
    t = brentq(lambda t: integral(0.0, t) - whole / 2, 0.0, 2.0, xtol=1e-12)
    assert np.abs(at(t) - cut[1]).max() <= 1e-10 * whole + 2e-12 * speed(t)


def test_periodic_curve() -> None:
    ring = [r.Point3d(math.cos(t), math.sin(t), 0.2 * math.sin(3 * t)) for t in np.linspace(0, 2 * np.pi, 10)[:-1]]
    curve = r.NurbsCurve.Create(True, 3, ring)
    assert curve.IsPeriodic and curve.IsClosed
    points = divide(curve, 9)
    assert np.array_equal(points[0], points[-1])
    assert points[0] == pytest.approx(xyz(curve.PointAtStart), abs=1e-15)

    def speed(t: float) -> float:
        return float(np.linalg.norm(xyz(curve.DerivativeAt(t, 1)[1])))

    knots = sorted({k for k in curve.Knots if curve.Domain.T0 <= k <= curve.Domain.T1})
    want = sum(quad(speed, a, b, epsrel=1e-12)[0] for a, b in pairwise(knots))
    assert length(curve) == pytest.approx(want, rel=1e-11)


def test_polycurve_with_a_kink() -> None:
    poly = r.PolyCurve()
    poly.AppendSegment(r.LineCurve(r.Point3d(0, 0, 0), r.Point3d(2, 0, 0)))
    poly.AppendSegment(r.LineCurve(r.Point3d(2, 0, 0), r.Point3d(2, 1, 0)))
    poly.AppendSegment(r.Arc(r.Point3d(2, 1, 0), r.Point3d(1, 2, 0), r.Point3d(0, 1, 0)).ToNurbsCurve())
    assert length(poly) == pytest.approx(3 + math.pi, rel=1e-12)
    angle = (3 + math.pi) / 2 - 3  # the middle lies on the arc, this far round it
    assert divide(poly, 2)[1] == pytest.approx([1 + math.cos(angle), 1 + math.sin(angle), 0], abs=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("degree", [1, 2, 3])
def test_nurbs_of_rhino_against_its_own_evaluation(degree: int) -> None:
    corners = [r.Point3d(*p) for p in ((0, 0, 0), (1, 2, 0), (3, -1, 1), (4, 0, 2), (6, 1, 0))]
    curve = r.NurbsCurve.Create(False, degree, corners)
    dense = divide(curve, 200)
    marks = np.array([xyz(curve.PointAt(t)) for t in np.linspace(curve.Domain.T0, curve.Domain.T1, 20001)])
    for p in dense:
        near = np.linalg.norm(marks - p, axis=1).min()
        assert near <= length(curve) / 20000  # half a step of at most twice the mean speed


def test_value_types_and_plain_lines() -> None:
    line = r.Line(r.Point3d(0, 0, 0), r.Point3d(3, 0, 0))
    compas_line = cg.Line([0, 0, 0], [3, 0, 0])
    poly = r.Polyline()
    for p in ((0, 0, 0), (1, 0, 0), (3, 0, 0)):
        poly.Add(*p)
    want = [[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0]]
    for curve in (line, compas_line, poly, poly.ToPolylineCurve(), cg.Polyline([[0, 0, 0], [3, 0, 0]])):
        assert divide(curve, 3).tolist() == want
    assert length(cg.Polygon([[0, 0, 0], [3, 0, 0], [3, 4, 0]])) == 12.0
    assert np.array_equal(*end_points(cg.Polygon([[0, 0, 0], [3, 0, 0], [3, 4, 0]])))


@few
@given(st.integers(-300, 300))
def test_scaling_by_a_power_of_two_scales_the_answer_exactly(power: int) -> None:
    bend = np.array([[0, 0, 0], [1, 2, 0], [3, -1, 1.0], [4, 1, 2]])
    scaled = [list(p) for p in bend * 2.0**power]
    assert np.array_equal(divide(cg.Bezier(scaled), 5), divide(cg.Bezier([list(p) for p in bend]), 5) * 2.0**power)


def test_shatter_joins_the_points() -> None:
    lines = shatter(cg.Circle(1.0), 8)
    assert lines.shape == (8, 2, 3)
    assert np.array_equal(lines[:, 1], np.roll(lines[:, 0], -1, axis=0))


@pytest.mark.parametrize(
    ("curve", "count", "says"),
    [
        ([[0, 0, 0], [1, 0, 0]], 0, "at least 1"),
        ([[0, 0, 0], [1, 0, 0]], -3, "at least 1"),
        ([[0, 0, 0], [1, 0, 0]], 2.5, "whole number"),
        ([[0, 0, 0], [1, 0, 0]], True, "whole number"),
        ([[1, 2, 3], [1, 2, 3]], 2, "zero length"),
        ([[1, 2, 3], [1, np.nan, 3]], 2, "not finite"),
        ([[1, 2, 3], [np.inf, 0, 3]], 2, "not finite"),
        ([[-1e308, 0, 0], [1e308, 0, 0]], 2, "too large"),
        ([[1, 2, 3]], 2, "n >= 2"),
        ([[1, 2], [2, 3]], 2, "n >= 2"),
        ("a line", 2, "not a curve"),
        (None, 2, "not a curve"),
        (r.Plane(r.Point3d(0, 0, 0), r.Vector3d(0, 0, 1)), 2, "not a curve"),
        (SimpleNamespace(points=[[0, 0, 0], [1, 0, 0]], weights=[1, -1], degree=1), 2, "weights must be positive"),
        (SimpleNamespace(points=[[0, 0, 0], [1, 0, 0]], knots=(), knotvector=[0, 1], degree=1), 2, "knots"),
        (BROKEN, 2, "gap"),
    ],
)
def test_bad_input_gets_a_sentence(curve: Any, count: Any, says: str) -> None:
    with pytest.raises(InputError, match=says) as caught:
        divide(curve, count)
    assert "\n" not in str(caught.value)


def test_explode_refuses_what_is_curved() -> None:
    with pytest.raises(InputError, match="shatter"):
        explode(r.Circle(r.Point3d(0, 0, 0), 1))
