"""Natives of texts, trees, sets, maths, transformations, surfaces and meshes, each on values with a known answer."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from canvas.native_values import called as run
from canvas.native_values import made, near, plain
from canvas.natives_table import XY
from canvas.test_natives_more import BOX, SQUARE, circle, size
from hookean.discretize import measures
from hookean_canvas.run.natives import BY_NAME, PLUGINS, Unfit, as_kind, shapes
from hookean_canvas.run.natives.flat_faces import filled
from hookean_canvas.run.natives.texts import formatted
from hookean_canvas.run.natives.trees_more import matches
from hookean_canvas.run.rhino import rhino3dm
from hookean_canvas.run.trees import Tree

ABC = ["a", "b", "c"]
TWO = ("mesh", [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2), (0, 2, 3)])
TRI = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 0)]
WIDE = [(0, 0, 0), (4, 0, 0), (0, 2, 0), (0, 0, 0)]
RIGHT = (math.asin(0.6), math.asin(0.8), math.pi / 2, 3, 4, 5)
HALVED = (math.pi / 6, math.pi / 3, math.pi / 2, 1, math.sqrt(3), 2)
UNIT = ("plane", (0, 0, 0), (1, 0, 0), (0, 1, 0))


def native(name: str) -> Any:
    return (BY_NAME.get(name) or PLUGINS[name]).run


CASES: list[tuple[str, tuple[Any, ...], tuple[Any, ...]]] = [
    ("Text Length", ("shell",), (5,)),
    ("Characters", ("aZ",), (["a", "Z"], [97, 90])),
    ("Text Case", ("Net", None), ("NET", "net")),
    ("Text Fragment", ("catenary", 3, 2), ("en",)),
    ("Text Fragment", ("catenary", 3, None), ("enary",)),
    ("Text Trim", ("  a ", True, False), ("a ",)),
    ("Text Trim", ("  a ", True, True), ("a",)),
    ("Replace Text", ("a-b-c", "-", "+"), ("a+b+c",)),
    ("Replace Text", ("a-b", "-", None), ("ab",)),
    ("Text Distance", ("kitten", "sitting", False), (3,)),
    ("Match Text", ("Cable 12", "cable *", None, False), (True,)),
    ("Match Text", ("Cable 12", "cable *", None, True), (False,)),
    ("Match Text", ("Cable 12", None, r"\d\d", False), (True,)),
    ("Sort Text", (["b", "A", "a"], [1, 2, 3], None), (["a", "A", "b"], [3, 2, 1])),
    ("Format", ("{0:0.00} of {1}, {{x}}", None, 2.5, "three"), ("2.50 of three, {x}",)),
    ("Path Compare", ((0, 1, 2), "{0;?;*}"), (True,)),
    ("Set Difference (S)", (ABC, ["b", "d"]), (["a", "c", "d"],)),
    ("Set Majority", (["a", "b"], ["b", "c"], ["c", "d"]), (["b", "c"],)),
    ("SubSet", (ABC, ["a", "c"]), (True,)),
    ("Disjoint", (ABC, ["d"]), (True,)),
    ("Carthesian Product", (["a", "b"], [1, 2]), ([["a", 1], ["b", 2]],)),
    ("Delete Consecutive", (["a", "a", "b", "a"], False), (["a", "b", "a"], 1)),
    ("Delete Consecutive", (["a", "a", "b", "a"], True), (["a", "b"], 2)),
    ("Key/Value Search", (ABC, [1, 2, 3], "b"), (2,)),
    ("Replace Members", (ABC, ["a", "c"], ["x"]), (["x", "b", "x"],)),
    ("Find similar member", (2.2, [1.0, 2.0, 5.0]), (2.0, 1)),
    ("Char Sequence", (28, "ABCDEFGHIJKLMNOPQRSTUVWXYZ", None), ([*"ABCDEFGHIJKLMNOPQRSTUVWXYZ", "AA", "AB"],)),
    ("Char Sequence", (2, "AB", "no {0}"), (["no A", "no B"],)),
    ("Sequence", ("{n-1} + {n-2}", 6, [1.0, 1.0]), ([1, 1, 2, 3, 5, 8],)),
    ("Sequence", ("Pr * 2 + N", 4, [1.0]), ([1, 3, 8, 19],)),
    ("Sinc", (math.pi / 2,), (2 / math.pi,)),
    ("Sinc", (0.0,), (1.0,)),
    ("Secant", (math.pi / 3,), (2.0,)),
    ("CoSecant", (math.pi / 6,), (2.0,)),
    ("CoTangent", (math.pi / 4,), (1.0,)),
    ("Factorial", (5,), (120.0,)),
    ("Interpolate data", ([0.0, 10.0, 40.0], 0.75), (25.0,)),
    ("Interpolate data", ([("point", 0, 0, 0), ("point", 2, 4, 0)], 0.5), ((1, 2, 0),)),
    ("Blur Numbers", ([0.0, 4.0, 0.0], 0.5, 1, True, False), ([0, 2, 0],)),
    ("Blur Numbers", ([0.0, 4.0, 8.0], 1.0, 1, False, True), ([6, 4, 2],)),
    ("Truncate", ([5.0, 1.0, 9.0, 3.0], 0.5), ([3, 5],)),
    ("Find Domain", ([("domain", 0, 1), ("domain", 2, 4)], 3.0, False), (1, 1)),
    ("Find Domain", ([("domain", 0, 1), ("domain", 2, 4)], 1.2, False), (-1, 0)),
    ("Right Trigonometry", (None, None, 3.0, 4.0, None), (math.atan(0.75), math.atan(4 / 3), 3, 4, 5)),
    ("Right Trigonometry", (math.pi / 6, None, None, None, 2.0), (math.pi / 6, math.pi / 3, 1, math.sqrt(3), 2)),
    ("Triangle Trigonometry", (None, None, None, 3.0, 4.0, 5.0), RIGHT),
    ("Triangle Trigonometry", (None, None, math.pi / 2, 3.0, 4.0, None), RIGHT),
    ("Triangle Trigonometry", (math.pi / 6, None, math.pi / 2, 1.0, None, None), HALVED),
    ("Rectangle Mapping", (("point", 1, 1, 0), (shapes.plane((0, 0, 0), (1, 0, 0), (0, 1, 0)), 2.0, 2.0),
     (shapes.plane((9, 0, 0), (0, 1, 0), (-1, 0, 0)), 4.0, 6.0)), ((6, 2, 0), "change")),
    ("Triangle Mapping", (("point", 0.5, 0.5, 0), TRI, WIDE), ((2, 1, 0), "change")),
    ("Camera Obscura", (("point", 1, 0, 0), ("point", 0, 0, 0), 2.0), ((-2, 0, 0), "change")),
    ("Project Along", (("point", 1, 0, 2), UNIT, ("vector", 1, 0, 1)), ((-1, 0, 0), "change")),
    ("Shear", (("point", 0, 0, 4), UNIT, ("point", 0, 0, 2), ("point", 1, 0, 2)), ((2, 0, 4), "change")),
    ("Shear Angle", (("point", 0, 0, 2), UNIT, 0.0, math.pi / 4), ((2, 0, 2), "change")),
    ("Orient Direction", (("point", 1, 0, 0), ("point", 0, 0, 0), ("vector", 1, 0, 0), ("point", 5, 0, 0),
     ("vector", 0, 3, 0)), ((5, 3, 0), "change")),
    ("Move Away From", (("point", 3, 0, 0), ("point", 0, 0, 0), 2.0), ((5, 0, 0), "change")),
    ("Stretch", (("point", 1, 1, 0), ("line", (0, 0, 0), (2, 0, 0)), 6.0, False), ((3, 1, 0),)),
    ("Twist", (("point", 1, 0, 2), ("line", (0, 0, 0), (0, 0, 4)), math.pi, False, False), ((0, 1, 2),)),
    ("Twist", (("point", 1, 0, 9), ("line", (0, 0, 0), (0, 0, 4)), math.pi, False, False), ((-1, 0, 9),)),
    ("Taper", (("point", 1, 0, 2), ("line", (0, 0, 0), (0, 0, 4)), 1.0, 0.5, False, False, False), ((0.75, 0, 2),)),
    ("Maelstrom", (("point", 1, 0, 3), UNIT, 1.0, 5.0, math.pi / 2, False), ((0, 1, 3),)),
    ("Maelstrom", (("point", 6, 0, 3), UNIT, 1.0, 5.0, math.pi / 2, False), ((6, 0, 3),)),
    ("Spatial Deform", (("point", 1, 0, 0), [("point", 1, 0, 0)], [("vector", 0, 0, 2)]), ((1, 0, 2),)),
    ("Point Deform", ([(0, 0, 0), (1, 0, 0), (2, 0, 0)], [("point", 1, 0, 0)], [("vector", 0, 0, 2)]),
     ([(0, 0, 0), (1, 0, 2), (2, 0, 0)],)),
    ("Flow", (("point", 2, 1, 0), [(0, 0, 0), (9, 0, 0)], [(0, 0, 5), (9, 0, 5)], False, False, False, False),
     ((2, 1, 5),)),
    ("Quadrangulate", (TWO, 0.1, 0.9), (([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(1, 2, 3, 0)]), 2)),
    ("Align Vertices", (("mesh", [(0, 0, 0), (0.1, 0, 0), (2, 0, 0), (0, 2, 0)], [(0, 2, 3), (1, 2, 3)]), 0.2),
     (([(0.05, 0, 0), (0.05, 0, 0), (2, 0, 0), (0, 2, 0)], [(0, 2, 3), (1, 2, 3)]), 2)),
    ("Delete Vertices", (TWO, [1], True), (([(0, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2)]),)),
    ("Cull Vertices", (TWO, [True, False, True, True], False), (([(0, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2)]),)),
    ("Mesh WeldVertices", (("mesh", [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0.001, 0)], [(0, 1, 2), (3, 1, 2)]), 0.01),
     (([(0, 0.0005, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2), (0, 1, 2)]),)),
    ("Mesh Explode", (TWO,), ([([(0, 0, 0), (1, 0, 0), (1, 1, 0)], [(0, 1, 2)]),
     ([(0, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2)])],)),
    ("Face Circles", (TWO,), ([(0.5, 0.5, 0), (0.5, 0.5, 0)], [0.5, 0.5])),
]  # fmt: skip


@pytest.mark.parametrize(("name", "given", "expected"), CASES, ids=lambda part: str(part)[:30])
def test_a_native_does_what_its_tooltip_describes(name: str, given: Any, expected: Any) -> None:
    found = [one for one, other in zip(run(name, *given), expected, strict=True) if other != "change"]
    assert near(found, [one for one in expected if one != "change"]), found


TREE = Tree({(0, 0): [1, 2], (0, 1): [3], (1, 0): [4]})


@pytest.mark.parametrize(
    ("path", "mask", "fits"),
    [
        ((0, 1), "{0;1}", True), ((0, 1), "{0;?}", True), ((0, 1), "{*}", True), ((0, 1), "{?}", False),
        ((0, 1), "{*;1}", True), ((2, 1), "{(0 to 2);1}", True), ((3, 1), "{(0 to 2);1}", False),
        ((3,), "{(1,3)}", True), ((4,), "{>3}", True), ((0, 1), "!{0;1}", False), ((), "{}", True),
    ],
)  # fmt: skip
def test_a_path_has_a_pattern_or_not(path: tuple[int, ...], mask: str, fits: bool) -> None:
    assert matches(path, mask) is fits


@pytest.mark.parametrize(
    ("name", "given", "expected"),
    [
        ("Split Tree", [TREE, Tree.of(["{0;*}"])], [{(0, 0): [1, 2], (0, 1): [3]}, {(1, 0): [4]}]),
        ("Replace Paths", [TREE, Tree.of(["{0;?}", "{*}"]), Tree.of([(7,), (8,)])], [{(7,): [1, 2, 3], (8,): [4]}]),
        ("Match Tree", [TREE, Tree({(5,): [0], (6,): [0], (7,): [0]})], [{(5,): [1, 2], (6,): [3], (7,): [4]}]),
        ("Relative Item", [TREE, Tree.of(["{0;0}(1)"]), Tree(), Tree()], [{(0, 0): [1]}, {(0, 0): [2]}]),
        ("Relative Item", [TREE, Tree.of(["{0;1}(0)"]), Tree(), Tree()], [{(0, 0): [1]}, {(0, 0): [3]}]),
        ("Relative Item", [Tree.of([1, 2, 3]), Tree.of(["{0}(1)"]), Tree(), Tree.of([True])],
         [{(0,): [1, 2, 3]}, {(0,): [2, 3, 1]}]),
    ],
)  # fmt: skip
def test_a_native_of_trees_does_what_its_tooltip_describes(name: str, given: Any, expected: Any) -> None:
    assert [plain(one) for one in BY_NAME[name].run(*given)] == expected


@pytest.mark.parametrize(
    ("value", "form", "text"),
    [
        (3.14159, "0.00", "3.14"), (3.0, "0.##", "3"), (3.5, "0.0#", "3.5"), (7, "000", "007"),
        (1234.5, "#,##0.0", "1,234.5"), (0.5, "P0", "50 %"), (1e-3, "", "0.001"), (True, "0.0", "True"),
        (0.25, "0%", "25%"), (2.0, "F1", "2.0"), (1234.5, "N1", "1,234.5"), (7, "D3", "007"), (-0.001, "0.00", "0.00"),
        (-2.5, "0.0", "-2.5"), (1500.0, "E2", "1.50E+03"),
    ],
)  # fmt: skip
def test_numbers_are_written_by_their_formats(value: Any, form: str, text: str) -> None:
    assert formatted(value, form) == text


@pytest.mark.parametrize(("name", "given", "sentence"), [
    ("Format", ("{5}", None, 1, 2), "there is no Data 5"),
    ("Format", ("{0:yyyy}", None, 1, 2), "is not known here"),
    ("Match Text", ("a", None, "(a+)+b", False), "may take too long"),
    ("Match Text", ("a", None, "(", False), "RegEx"),
    ("Sequence", ("{n-99}", 4, [1.0]), "braces"),
    ("Triangle Trigonometry", (None, None, None, 1.0, 1.0, 3.0), "no triangle"),
    ("Interpolate data", ([], 0.5), "empty"),
    ("Taper", (("point", 1, 0, 0), ("line", (0, 0, 0), (0, 0, 1)), 0.0, 1.0, False, False, False), "must not be 0"),
])  # fmt: skip
def test_what_cannot_be_is_a_sentence(name: str, given: Any, sentence: str) -> None:
    with pytest.raises(Unfit, match=sentence):
        run(name, *given)


def test_groups_are_moved_as_one_and_taken_apart() -> None:
    (held,) = native("Group")([made(("point", 0, 0, 0)), made([(0, 0, 0), (1, 0, 0)])])
    moved, _ = BY_NAME["Move"].run(held, made(("vector", 0, 0, 2)))
    assert near([plain(one) for one in native("Ungroup")(moved)[0]], [(0, 0, 2), [(0, 0, 2), (1, 0, 2)]])
    both = native("Merge Group")(held, moved)[0]
    first, rest = native("Split Group")(both, [0, -1], True)
    assert len(first.members) == len(rest.members) == 2


def test_transformations_are_combined_and_undone() -> None:
    there = BY_NAME["Move"].run(made(("point", 0, 0, 0)), made(("vector", 1, 2, 3)))[1]
    turn = BY_NAME["Rotate"].run(made(("point", 0, 0, 0)), math.pi / 2, made(XY))[1]
    (both,) = native("Compound")([there, turn])
    assert near(plain(shapes.transformed(made(("point", 0, 0, 0)), both)), (-2, 1, 3))
    (back,) = native("Inverse Transform")(both)
    assert near(plain(shapes.transformed(made(("point", -2, 1, 3)), back)), (0, 0, 0))


def test_copies_lie_along_a_curve_in_a_box_and_round_a_plane() -> None:
    copies, _ = native("Curve Array")(made(("point", 0, 0, 0)), made([(0, 0, 0), (6, 0, 0)]), 4)
    assert near([plain(one) for one in copies], [(0, 0, 0), (2, 0, 0), (4, 0, 0), (6, 0, 0)])
    cell = rhino3dm.BoundingBox(0, 0, 0, 1, 2, 3)
    boxed, _ = native("Box Array")(made(("point", 0, 0, 0)), cell, 2, 1, 2)
    assert near([plain(one) for one in boxed], [(0, 0, 0), (1, 0, 0), (0, 0, 3), (1, 0, 3)])
    turned, _ = native("Kaleidoscope")(made(("point", 1, 1, 0)), made(XY), 2)
    assert near([plain(one) for one in turned], [(1, 1, 0), (1, -1, 0), (-1, -1, 0), (-1, 1, 0)])


def test_a_line_is_bent_to_an_arc_with_its_length() -> None:
    """A quarter of a circle of radius 2 about (0, 2): the point at length pi on it is (2, 2)."""
    arc = rhino3dm.ArcCurve.CreateFromArc(
        rhino3dm.Arc(*(rhino3dm.Point3d(*p) for p in ((0, 0, 0), (math.sqrt(2), 2 - math.sqrt(2), 0), (2, 2, 0))))
    )
    (bent,) = native("Bend Deform")(made([(0, 0, 0), (math.pi, 0, 0), (math.pi + 1, 0, 0)]), arc)
    assert near(plain(bent), [(0, 0, 0), (2, 2, 0), (2, 3, 0)])


def test_a_curve_is_mapped_from_one_surface_to_another() -> None:
    flat = BY_NAME["Plane Surface"].run(made(XY), made(("domain", 0, 2)), made(("domain", 0, 2)))[0]
    up = BY_NAME["Plane Surface"].run(made(("plane", (0, 0, 0), (1, 0, 0), (0, 0, 1))), made(("domain", 0, 4)),
                                      made(("domain", 0, 4)))[0]  # fmt: skip
    (found,) = native("Map to Surface")(made([(0.5, 0.5, 0), (1, 1.5, 0)]), flat, up)
    rows = shapes.corners(found)
    assert rows is not None and np.abs(rows - [(1, 0, 1), (2, 0, 3)]).max() < 1e-6


def test_surfaces_are_made_of_curves_and_points() -> None:
    """A plane 4 by 3, a pyramid of slant height 5, a cone of pi r l, and a hyperbolic paraboloid through its points."""
    a, b = made([(0, 0, 0), (4, 0, 0)]), made([(0, 0, 0), (0, 3, 0)])
    for name in ("Sum Surface", "Extrude Along"):
        assert plain(native(name)(a, b)[0].PointAt(1.0, 1.0)) == pytest.approx((4, 3, 0))
    (walls,) = native("Extrude Point")(made([(-3, -3, 0), (3, -3, 0), (3, 3, 0)]), made(("point", 0, 0, 4)))
    mesh = BY_NAME["Mesh Surface"].run(walls, 8, 2, False, False)[0]
    assert measures.area(shapes.mesh_parts(mesh)) == pytest.approx(2 * 0.5 * 6 * 5)
    wall, tip = native("Cone")(made(XY), 3.0, 4.0)
    assert near(plain(tip), (0, 0, 4)) and BY_NAME["Area"].run(wall)[0] == pytest.approx(15 * math.pi, rel=2e-3)
    (lifted,) = native("Extrude Linear")(a, None, made(("line", (9, 9, 0), (9, 9, 2))), None)
    assert plain(lifted.PointAt(lifted.Domain(0).T1, lifted.Domain(1).T1)) == pytest.approx((4, 0, 2))
    grid = [made(("point", x, y, x * y)) for x in range(5) for y in range(4)]
    (net,) = native("Surface From Points")(grid, 5, True)
    assert plain(net.PointAt(0.5, 1 / 3)) == pytest.approx((2, 1, 2), abs=1e-9)
    with pytest.raises(Unfit, match="20 points are not 3 rows"):
        native("Surface From Points")(grid, 3, True)


def test_a_sweep_between_two_rails_follows_their_distance() -> None:
    """An arch over rails 2 apart that widen to 4: its height doubles with them."""
    rails = made([(0, 0, 0), (0, 6, 0)]), made([(2, 0, 0), (4, 6, 0)])
    (swept,) = native("Sweep2")(*rails, [made([(0, 0, 0), (1, 0, 1), (2, 0, 0)])], False)[0]
    (u0, u1), (v0, v1) = ((swept.Domain(k).T0, swept.Domain(k).T1) for k in (0, 1))
    assert near(plain(swept.PointAt(u0, 0.5 * (v0 + v1))), (1, 0, 1))
    assert plain(swept.PointAt(u1, 0.5 * (v0 + v1)))[2] == pytest.approx(2.0, rel=0.02)


def test_offsets_and_flips_keep_the_distance_and_turn_the_normal() -> None:
    flat = BY_NAME["Plane Surface"].run(made(XY), made(("domain", 0, 2)), made(("domain", 0, 2)))[0]
    for name in ("Offset Surface", "Offset Surface Loose"):
        moved = native(name)(flat, 1.5, True)[0]
        assert plain(moved.PointAt(moved.Domain(0).T1, moved.Domain(1).T1)) == pytest.approx((2, 2, 1.5))
    turned, done = native("Flip")(flat, None)
    assert done and plain(turned.NormalAt(0.5, 0.5)) == pytest.approx((0, 0, -1))
    assert plain(turned.PointAt(turned.Domain(0).T0, turned.Domain(1).T0)) == pytest.approx((2, 0, 0))
    assert native("Flip")(turned, flat)[1] is True and native("Flip")(flat, flat)[1] is False
    ball = rhino3dm.NurbsSurface.CreateFromSphere(rhino3dm.Sphere(rhino3dm.Point3d(0, 0, 0), 2.0))
    far = native("Offset Surface")(ball, 1.0, True)[0]
    assert np.linalg.norm(plain(far.PointAt(far.Domain(0).T0, 0.5 * far.Domain(1).T1))) == pytest.approx(3.0, rel=1e-3)
    assert native("Is Planar")(flat, False)[0] is True and native("Is Planar")(ball, False)[0] is False


def test_boxes_are_taken_apart_and_made() -> None:
    box = rhino3dm.BoundingBox(0, 0, 0, 2, 4, 6)
    frame, x, y, z = native("Deconstruct Box")(box)
    assert near([plain(frame)[0], plain(x), plain(y), plain(z)], [(1, 2, 3), (-1, 1), (-2, 2), (-3, 3)])
    _, at, inside = native("Evaluate Box")(box, 0.5, 0.25, 2.0)
    assert near(plain(at), (1, 1, 12)) and inside is False
    domains = [made(("domain", 0, 2)), made(("domain", 1, 4)), made(("domain", -1, 1))]
    assert near(plain(native("Domain Box")(made(XY), *domains)[0]), ((0, 1, -1), (2, 4, 1)))


def test_boxes_may_be_tilted() -> None:
    """A box of 2 x 4 x 6 in a plane turned by 45 degrees has its corners, its volume and its mesh there."""
    turned = made(("plane", (0, 0, 0), (1, 1, 0), (-1, 1, 0)))
    (box,) = native("Center Box")(turned, 1.0, 2.0, 3.0)
    corner = plain(native("Box Corners")(box)[2])
    assert near(corner, ((1 - 2) * math.sqrt(0.5), (1 + 2) * math.sqrt(0.5), -3))
    assert native("Volume")(box)[0] == pytest.approx(48.0)
    mesh = native("Mesh Box")(box, 2, 2, 2)[0]
    assert measures.area(shapes.mesh_parts(mesh)) == pytest.approx(2 * (8 + 24 + 12))
    assert near(plain(native("Evaluate Box")(box, 0.5, 0.5, 0.5)[1]), (0, 0, 0))
    again, _ = native("Bounding Box")(box.ToBrep(), turned)
    assert near(shapes.box_axes(again)[2].tolist(), [2, 4, 6])
    between = native("Box 2Pt")(made(("point", 0, 0, 0)), made(("point", 0, 2, 1)), turned)[0]
    assert near(shapes.box_axes(between)[2].tolist(), [math.sqrt(2), math.sqrt(2), 1])
    upright = native("Center Box")(made(("plane", (0, 0, 0), (0, 1, 0), (-1, 0, 0))), 1.0, 2.0, 3.0)[0]
    assert near(plain(upright), ((-2, -1, -3), (2, 1, 3)))  # turned by a right angle it is along the world's axes


def test_surfaces_are_extruded_to_solids_and_holes_are_filled() -> None:
    flat = BY_NAME["Plane Surface"].run(made(XY), made(("domain", 0, 2)), made(("domain", 0, 3)))[0]
    (solid,) = native("Extrude")(flat, made(("vector", 0, 0, 4)))
    assert measures.volume(shapes.mesh_parts(solid)) == pytest.approx(24.0)
    (tube,) = native("Extrude")(
        made([(0, 0, 0), (2, 0, 0), (2, 3, 0), (0, 3, 0), (0, 0, 0)]), made(("vector", 0, 0, 4))
    )
    (closed,) = native("Cap Holes")(tube)
    assert abs(measures.volume(shapes.mesh_parts(closed))) == pytest.approx(24.0)
    box = rhino3dm.BoundingBox(0, 0, 0, 1, 1, 1).ToBrep()
    assert native("Cap Holes")(box)[0] is box


def test_closed_flat_curves_are_taken_for_faces() -> None:
    assert native("Area")(as_kind("brep", made(SQUARE)))[0] == pytest.approx(16.0)
    assert shapes.mesh_parts(as_kind("mesh", made(SQUARE)))[1] == [(0, 1, 2, 3)]
    assert as_kind("surface", circle()).IsPlanar()
    with pytest.raises(Unfit):
        as_kind("mesh", made([(0, 0, 0), (1, 0, 0)]))


def test_spheres_go_through_points() -> None:
    rows = np.array([(2, 0, 0), (0, 2, 0), (0, 0, 2), (-2, 0, 0), (0, -2, 0)]) + (1, 2, 3)
    _, radius = native("Sphere Fit")([made(("point", *row)) for row in rows.tolist()])
    centre, other, _ = native("Sphere 4Pt")(*(made(("point", *row)) for row in rows[:4].tolist()))
    assert radius == pytest.approx(2.0) and other == pytest.approx(2.0) and near(plain(centre), (1, 2, 3))
    face = native("Quad Sphere")(made(XY), 2.0)[0].Faces[0]
    assert np.linalg.norm(plain(face.PointAt(0.3 * face.Domain(0).T1, 0.2 * face.Domain(1).T1))) == pytest.approx(
        2.0, rel=1e-4
    )
    with pytest.raises(Unfit, match="four points"):
        native("Sphere Fit")([made(("point", x, 0, 0)) for x in range(4)])


def test_a_flat_region_is_filled_with_triangles_that_cover_it() -> None:
    """A square of side 4 with a hole of side 2 has an area of 12; its edges are sides of triangles."""
    square = np.array([(0, 0), (4, 0), (4, 4), (0, 4)], dtype=float)
    hole = np.array([(1, 1), (3, 1), (3, 3), (1, 3)], dtype=float)
    rows, faces = filled(square, [hole], 12)
    a, b, c = (rows[[face[k] for face in faces]] for k in range(3))
    areas = 0.5 * ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])
    assert areas.min() > 0.0 and areas.sum() == pytest.approx(12.0)


def test_a_region_within_a_circle_becomes_a_mesh() -> None:
    """Boundary Surfaces of a circle of radius 2, meshed: the polygon of its 65 corners has nearly 4 pi."""
    (region,) = BY_NAME["Boundary Surfaces"].run([circle()])[0]
    mesh = BY_NAME["Mesh Brep"].run(region, None)[0]
    assert measures.area(shapes.mesh_parts(mesh)) == pytest.approx(4 * math.pi, rel=2e-3)
    assert BY_NAME["Area"].run(region)[0] == pytest.approx(4 * math.pi, rel=2e-3)
    assert BY_NAME["Mesh Brep"].run(mesh, None)[0] is mesh


def test_a_patch_goes_through_its_curve_and_its_points() -> None:
    (mesh,) = native("Patch")([made(SQUARE)], [made(("point", 2, 2, 1))], 8, 1.0, True)
    vertices, faces = shapes.mesh_parts(mesh)
    middle = vertices[np.linalg.norm(vertices[:, :2] - 2.0, axis=1).argmin()]
    assert 0.8 < middle[2] <= 1.05 and np.abs(vertices[np.abs(vertices[:, 0]) < 1e-9, 2]).max() < 0.02
    assert len(faces) > 50
    with pytest.raises(Unfit, match="closed curve"):
        native("Patch")([made([(0, 0, 0), (1, 0, 0)])], None, 8, 1.0, True)


def test_breps_pass_where_nothing_can_be_joined() -> None:
    box = rhino3dm.BoundingBox(0, 0, 0, 1, 1, 1).ToBrep()
    found, closed = native("Brep Join")([box, None])
    assert len(found) == 1 and closed == [True] and native("Merge Faces")(box)[1:] == (6, 6)
    assert len(native("Brep Wireframe")(box, 0)[0]) == 12


def test_a_plane_splits_a_box_in_two_of_its_area() -> None:
    """A box of side 2 without its cut: 2 x 4 of walls at half height and a lid of 4 on both sides."""
    above, below = native("Mesh Split Plane")(made(BOX), made(("plane", (0, 0, 1), (1, 0, 0), (0, 1, 0))))
    assert [measures.area(shapes.mesh_parts(one)) for (one,) in (above, below)] == pytest.approx([12.0, 12.0])
    assert shapes.mesh_parts(above[0])[0][:, 2].min() == pytest.approx(1.0)


def test_a_sphere_of_patches_is_round_and_closed() -> None:
    (ball,) = native("Mesh Sphere Ex")(made(XY), 2.0, 6)
    vertices, faces = shapes.mesh_parts(ball)
    assert len(vertices) == 6 * 36 + 2 and len(faces) == 6 * 36
    assert np.linalg.norm(vertices, axis=1) == pytest.approx(np.full(len(vertices), 2.0))
    assert measures.volume((vertices, faces)) == pytest.approx(4 / 3 * math.pi * 8, rel=0.05)


def test_a_mesh_is_evaluated_where_it_is_nearest() -> None:
    _, _, parameter = BY_NAME["Mesh Closest Point"].run(made(("point", 1, 1, 9)), made(BOX))
    at, normal, _ = native("Mesh Eval")(made(BOX), parameter)
    assert near(plain(at), (1, 1, 2)) and plain(normal)[2] > 0.9


def test_twisted_boxes_have_their_corners() -> None:
    corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 2), (1, 0, 2), (1, 1, 2), (0, 1, 2)]
    (box,) = native("Twisted Box")(*(made(("point", *one)) for one in corners))
    moved = BY_NAME["Box Morph"].run(made(("point", 0.5, 0.5, 0.5)), rhino3dm.BoundingBox(0, 0, 0, 1, 1, 1), box)[0]
    assert near(plain(moved), (0.5, 0.5, 1))


def test_by_chance_is_the_same_in_every_run() -> None:
    (first,), (again,) = (native("RandomEx")(3, 5, 200, 7) for _ in range(2))
    assert first == again and set(first) == {3, 4, 5}


def test_domains_are_taken_apart_by_the_number_of_outputs() -> None:
    domain = native("Bounds 2D")([made(("point", 1, 5, 0)), made(("point", 3, 2, 0))])[0]
    assert (domain.u, domain.v) == ((1, 3), (2, 5))
    assert near([plain(one) for one in native("Deconstruct Domain²")(domain, node=None)], [(1, 3), (2, 5)])
    four = type("Node", (), {"outputs": [0, 1, 2, 3]})()
    assert native("Deconstruct Domain²")(domain, node=four) == (1, 3, 2, 5)


def test_the_length_of_a_square_is_known_to_these_tests() -> None:
    assert size(made(SQUARE)) == pytest.approx(16.0)
