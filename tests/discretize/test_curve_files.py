"""Every curve of the real files, against an integration that shares nothing with the one tested:
scipy's adaptive quadrature of rhino3dm's own derivative, in the curve's own parameter."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
import rhino3dm
from scipy.integrate import quad
from scipy.optimize import brentq

from hookean.discretize import divide, end_points, length, shatter

COUNTS = {
    "v3_Terrain.3dm": 7,
    "v3_UntrimmedSurfaces.3dm": 38,
    "v5_extrusions.3dm": 10,
    "v7_my_brep.3dm": 0,
    "v7_my_curves.3dm": 4,
    "v7_my_mesh.3dm": 0,
    "v7_my_points.3dm": 0,
    "v7_my_surfaces.3dm": 0,
    "v7_my_trimmed_surface.3dm": 0,
    "v7_rhino_logo_nurbs.3dm": 0,
}
PIECES = 7


def xyz(p: Any) -> np.ndarray:
    return np.array([p.X, p.Y, p.Z])


def speed(curve: Any) -> Callable[[float], float]:
    return lambda t: float(np.linalg.norm(xyz(curve.DerivativeAt(t, 1)[1])))


def arc(curve: Any, a: float, b: float) -> float:
    return quad(speed(curve), a, b, epsabs=1e-12, epsrel=1e-11, limit=200)[0] if b > a else 0.0


def breaks(curve: Any) -> list[float]:
    """Knots in the curve's own parameter, between which it is smooth."""
    knots = sorted({float(k) for k in curve.ToNurbsCurve().Knots})
    at = [curve.GetCurveParameterFromNurbsFormParameter(k) for k in knots]
    at = [a[1] if isinstance(a, tuple) else a for a in at]
    inside = [t for t in at if curve.Domain.T0 < t < curve.Domain.T1]
    return [curve.Domain.T0, *inside, curve.Domain.T1]


@pytest.mark.parametrize("file", sorted(COUNTS))
def test_pieces_are_equal_by_an_independent_integration(file: str, rhino_objects: Any) -> None:
    curves = [g for g, _ in rhino_objects(file) if isinstance(g, rhino3dm.Curve)]
    assert len(curves) == COUNTS[file]
    for curve in curves:
        at = breaks(curve)
        upto = np.concatenate([[0.0], np.cumsum([arc(curve, a, b) for a, b in pairwise(at)])])
        whole = float(upto[-1])
        assert length(curve) == pytest.approx(whole, rel=1e-10)
        points = divide(curve, PIECES)
        for k in range(1, PIECES):
            target = whole * k / PIECES
            span = int(np.searchsorted(upto, target, side="right")) - 1
            a, b, rest = at[span], at[span + 1], target - upto[span]
            t = brentq(lambda t, a=a, rest=rest, c=curve: arc(c, a, t) - rest, a, b, xtol=1e-14, rtol=1e-14)
            # two ends off by 6e-11 L / 7 each leave a piece off by at most 1.3e-10 < 1e-9 of itself
            assert np.linalg.norm(xyz(curve.PointAt(t)) - points[k]) <= 6e-11 * whole / PIECES


@pytest.mark.parametrize("file", sorted(f for f, n in COUNTS.items() if n))
def test_ends_and_closing(file: str, rhino_objects: Any) -> None:
    for curve, _ in rhino_objects(file):
        if not isinstance(curve, rhino3dm.Curve):
            continue
        points, ends = divide(curve, 5), end_points(curve)
        size = np.abs(points).max()
        assert np.array_equal(points[[0, -1]], ends)
        assert np.abs(ends[0] - xyz(curve.PointAtStart)).max() <= 1e-14 * size
        assert np.abs(ends[1] - xyz(curve.PointAtEnd)).max() <= 1e-9 * size
        assert np.array_equal(points[0], points[-1]) == curve.IsClosed
        lines = shatter(curve, 5)
        assert np.array_equal(lines[1:, 0], lines[:-1, 1])


def test_edges_of_breps_are_curves_too(rhino_objects: Any) -> None:
    ((brep, _),) = rhino_objects("v7_my_brep.3dm")
    for i in range(len(brep.Edges)):
        edge = brep.Edges[i]
        ends = end_points(edge)
        # straight edges of a twisted box
        assert length(edge) == pytest.approx(float(np.linalg.norm(ends[1] - ends[0])), rel=1e-12)
