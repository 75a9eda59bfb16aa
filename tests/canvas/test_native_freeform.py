"""Natives of cells, offsets, revolutions, sweeps and networks, by formulas of what they are given."""

from __future__ import annotations

import math
from itertools import chain, pairwise
from typing import Any

import numpy as np
import pytest

from canvas.native_values import called, made, near, plain
from canvas.natives_table import XY
from hookean.discretize import curves as arc_lengths
from hookean_canvas.run.natives import BY_NAME, Unfit, shapes
from hookean_canvas.run.rhino import rhino3dm

HIGH = 0.5 * math.sqrt(3.0)
SQUARE = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 0)]
TILTED = ("plane", (1, 2, 3), (0, 0.6, 0.8), (1, 0, 0))


def raw(name: str, *given: Any) -> Any:
    """The only output of a native, as it is."""
    return BY_NAME[name].run(*(made(one) for one in given))[0]


def circle(radius: float, frame: Any = XY) -> Any:
    return BY_NAME["Circle"].run(made(frame), radius)[0]


def at(surface: Any, u: float, v: float) -> np.ndarray:
    """A point of a surface by parts of its domains."""
    ends = [(surface.Domain(k).T0, surface.Domain(k).T1) for k in range(2)]
    return shapes.xyz(surface.PointAt(*(a + part * (b - a) for (a, b), part in zip(ends, (u, v), strict=True))))


def test_hexagons_are_regular_and_fill_the_plane() -> None:
    """Each has six sides and a centre at the distance of its size, and shares a side with each neighbour: as many as
    3 n m less those of the rim, 2 m in the first and last columns and so on; here n = m = 2: 5 sides are shared."""
    for frame in (XY, TILTED):
        cells, centres = called("Hexagonal", frame, 2.0, 2, 2)
        assert [len(column) for column in cells] == [len(column) for column in centres] == [2, 2]
        middles = set()
        for cell, centre in zip(list(chain(*cells)), list(chain(*centres)), strict=True):
            ring = np.array(cell)
            assert np.linalg.norm(np.diff(ring, axis=0), axis=1) == pytest.approx(np.full(6, 2.0))
            assert np.linalg.norm(ring - centre, axis=1) == pytest.approx(np.full(7, 2.0))
            middles |= {tuple(np.round(0.5 * (a + b), 9) + 0.0) for a, b in pairwise(ring)}
        assert len(middles) == 4 * 6 - 5
    assert near(called("Hexagonal", XY, 2.0, 2, 1)[1], [[(2, 2 * HIGH, 0)], [(5, 4 * HIGH, 0)]])


def test_triangles_point_up_and_down_in_turn() -> None:
    cells, centres = called("Triangular", XY, 1.0, 2, 2)
    assert near(cells[0][0], [(0, 0, 0), (1, 0, 0), (0.5, HIGH, 0), (0, 0, 0)])
    assert near(centres, [[(0.5, HIGH / 3, 0), (0.5, HIGH * 5 / 3, 0)], [(1, HIGH * 2 / 3, 0), (1, HIGH * 4 / 3, 0)]])
    for cell in list(chain(*cells)):
        assert np.linalg.norm(np.diff(np.array(cell), axis=0), axis=1) == pytest.approx(np.ones(3))


def test_a_radial_grid_goes_round_clockwise_from_the_y_axis() -> None:
    cells, corners = called("Radial", XY, 2.0, 2, 4)
    assert near(corners, [[(0, 0, 0)] * 4, *([(0, r, 0), (r, 0, 0), (0, -r, 0), (-r, 0, 0)] for r in (2, 4))])
    assert near(cells[0][0], [(0, 0, 0), (0, 2, 0), (2, 0, 0), (0, 0, 0)])
    assert near(sorted(cells[1][0][:4]), sorted([(0, 2, 0), (2, 0, 0), (0, 4, 0), (4, 0, 0)]))
    assert [len(ring) for ring in cells] == [4, 4]


@pytest.mark.parametrize(("name", "counts"), [("Hexagonal", (0, 1)), ("Triangular", (1, 0)), ("Radial", (0, 4))])
def test_a_grid_without_cells_is_refused(name: str, counts: tuple[int, int]) -> None:
    with pytest.raises(Unfit, match="a grid needs at least one cell each way"):
        called(name, XY, 1.0, *counts)


def test_an_offset_is_to_the_right_with_sharp_corners() -> None:
    """Of a square that runs to the left outwards; an open L keeps its ends beside its own."""
    big, small = ([(-d, -d, 0), (2 + d, -d, 0), (2 + d, 2 + d, 0), (-d, 2 + d, 0), (-d, -d, 0)] for d in (0.5, -0.5))
    assert near(called("Offset Curve", SQUARE, 0.5, XY, 1), [[big]])
    assert near(called("Offset Curve", SQUARE, -0.5, XY, 1), [[small]])
    bent = called("Offset Curve", SQUARE[:3], 1.0, XY, 1)
    assert near(bent, [[[(0, -1, 0), (3, -1, 0), (3, 2, 0)]]])
    with pytest.raises(Unfit, match="crosses itself"):
        called("Offset Curve", SQUARE, -1.5, XY, 1)


def test_an_offset_circle_is_a_circle() -> None:
    frame = made(TILTED)
    for turned, sign in ((False, 1), (True, -1)):
        curve = circle(2.0, TILTED)
        if turned:
            curve.Reverse()
        (found,) = BY_NAME["Offset Curve"].run(curve, 0.5, frame, 1)[0]
        assert arc_lengths.length(found) == pytest.approx(2.0 * math.pi * (2.0 + 0.5 * sign), rel=1e-9)
        assert found.IsCircle()
    with pytest.raises(Unfit, match="larger than the radius"):
        BY_NAME["Offset Curve"].run(circle(2.0), -2.0, made(XY), 1)


def test_a_revolved_line_is_a_cone() -> None:
    """Radius 1 + v at height 3 v, from one angle to another."""
    axis, profile = rhino3dm.Line(shapes.point((0, 0, 0)), shapes.point((0, 0, 1))), [(1, 0, 0), (2, 0, 3)]
    cone = BY_NAME["Revolution"].run(made(profile), axis, rhino3dm.Interval(0.5, 0.5 + math.pi))[0]
    for v in (0.0, 0.3, 1.0):
        for u, angle in ((0.0, 0.5), (0.5, 0.5 + math.pi / 2), (1.0, 0.5 + math.pi)):
            r = 1.0 + v
            assert at(cone, u, v) == pytest.approx([r * math.cos(angle), r * math.sin(angle), 3.0 * v], abs=1e-9)
        assert np.linalg.norm(at(cone, 0.17, v)[:2]) == pytest.approx(1.0 + v)


def test_a_section_swept_along_a_polyline_fills_prisms_that_meet_in_its_corners() -> None:
    """A square of side 2 r along an L: each face of the sweep lies at r from the line of its piece."""
    rail, r = [(0, 0, 0), (5, 0, 0), (5, 4, 0)], 0.5
    ring = [(0, y, z) for y, z in ((-r, -r), (r, -r), (r, r), (-r, r), (-r, -r))]
    (surface,) = raw("Sweep1", rail, [ring], 0)
    net = np.array([[shapes.xyz(surface.PointAt(0.5 * i, 0.25 * j)) for j in range(5)] for i in range(3)])
    assert net[0] == pytest.approx(np.array(ring))
    assert np.abs(net[1] - [5, 0, 0])[:, 2] == pytest.approx(np.full(5, r))
    assert sorted(map(tuple, np.round(net[1][:4, :2], 9))) == [(4.5, 0.5), (4.5, 0.5), (5.5, -0.5), (5.5, -0.5)]
    assert net[2][:, 1] == pytest.approx(np.full(5, 4.0))


def test_sections_change_along_the_rail_in_proportion_to_its_length() -> None:
    rail = [(0, 0, 0), (0, 0, 1), (0, 0, 4)]
    first, last = [(1, 0, 0), (0, 1, 0)], [(3, 0, 4), (0, 5, 4)]
    (surface,) = raw("Sweep1", rail, [last, first], 0)
    assert [tuple(np.round(at(surface, 0.5, v), 9)) for v in (0, 1)] == [(1.5, 0, 1), (0, 2, 1)]
    with pytest.raises(Unfit, match="two sections are at one place"):
        raw("Sweep1", rail, [first, first], 0)


def test_a_section_swept_round_a_circle_is_a_ring() -> None:
    """Every point keeps its distance from the axis, to the 1 / cos of half a piece, and its height."""
    rail = circle(5.0)
    (surface,) = BY_NAME["Sweep1"].run(rail, [made([(5, 0, 0), (6, 0, 1)])], 0)[0]
    for u in np.linspace(0, 1, 51):
        low, high = at(surface, u, 0), at(surface, u, 1)
        assert np.linalg.norm(low[:2]) == pytest.approx(5.0, rel=1e-9)
        assert np.linalg.norm(high[:2]) == pytest.approx(6.0, rel=1.0 / math.cos(math.pi / 50) - 1.0)
        assert high[2] - low[2] == pytest.approx(1.0, abs=1e-9)


def test_a_network_surface_goes_through_its_curves() -> None:
    """Sections of z = x (1 - x) + 2 y, quadratic one way and straight the other: Gordon's surface is that surface.
    Curves may run either way and come in any order."""

    def parabola(y: float, turned: bool) -> Any:
        tip = (0.5, y, 2 * y + 0.5)  # control point of the parabola through z = 0 at both ends with slope 1
        ends = [(0, y, 2 * y), (1, y, 2 * y)]
        places = [ends[0], tip, ends[1]]
        return rhino3dm.NurbsCurve.Create(False, 2, shapes.points(places[::-1] if turned else places))

    us = [parabola(1.0, True), parabola(0.0, False), parabola(0.5, False)]
    vs = [made([(x, 0, x * (1 - x)), (x, 1, 2 + x * (1 - x))][:: -1 if x else 1]) for x in (0.0, 1.0, 0.25, 0.5)]
    surface = BY_NAME["Network Surface"].run(us, vs, 1)[0]
    net = np.array([at(surface, u, v) for u in np.linspace(0, 1, 26) for v in np.linspace(0, 1, 5)])
    x, y, z = net.T
    assert np.ptp(x) == pytest.approx(1.0) and np.ptp(y) == pytest.approx(1.0)
    assert np.abs(z - x * (1 - x) - 2 * y).max() < 0.25 / 25**2 + 1e-6  # of a chord of one piece in x
    with pytest.raises(Unfit, match="does not meet"):
        BY_NAME["Network Surface"].run(us, [vs[0], made([(0.5, 0, 9), (0.5, 1, 9)])], 1)


def test_plain_values_of_a_grid_are_those_of_its_plane() -> None:
    """A tilted plane moves cells and points as one."""
    flat, tilted = (called("Radial", frame, 1.0, 2, 5)[1] for frame in (XY, TILTED))
    moved = shapes.in_plane(made(TILTED), np.array(list(chain(*flat)))[:, :2])
    assert moved == pytest.approx(np.array(list(chain(*tilted))), abs=1e-12)
    assert plain(shapes.point(moved[0])) == (1, 2, 3)
