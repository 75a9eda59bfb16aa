"""Arcs through three points and curves through particles."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hookean.discretize.arcs import arc, arc_of_length, interpolate
from hookean.errors import InputError
from soak import examples

SEEDED = settings(derandomize=True, deadline=None, max_examples=examples(200), database=None)
EPS = float(np.finfo(float).eps)


@SEEDED
@given(st.integers(0, 2**32 - 1), st.floats(0.02, 2 * np.pi - 0.02), st.floats(0.1, 0.9), st.integers(1, 30))
def test_an_arc_is_that_of_its_circle(seed: int, angle: float, at: float, count: int) -> None:
    """Any circle in space, any part of it, b anywhere between: the points at equal angles.

    The circle's centre is found to eps radius / sine^2 of its smallest angle; with 0.001 that is 1e-9.
    """
    rng = np.random.default_rng(seed)
    frame = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    radius, centre = 10.0 ** rng.uniform(-3, 3), rng.normal(size=3)

    def on(t: Any) -> np.ndarray:
        t = np.asarray(t)[..., None]
        return centre + radius * (np.cos(t) * frame[0] + np.sin(t) * frame[1])

    found = arc(on(0.0), on(at * angle), on(angle), count)
    noise = EPS * (1.0 + 1.0 / radius) * radius
    assert np.abs(found - on(np.linspace(0, angle, count + 1))).max() <= 1e-9 * radius + 1e6 * noise
    assert (found[0] == on(0.0)).all() and (found[-1] == on(angle)).all()


def test_a_half_and_three_quarters_of_a_circle() -> None:
    """Radius 2 about (1, 0, 0): points at 0, 45, 90, 135, 180 degrees, and of 270 degrees the middle."""
    found = arc([3, 0, 0], [1, 0, 2], [-1, 0, 0], 4)
    turn = np.radians([0, 45, 90, 135, 180])
    assert found == pytest.approx(np.column_stack([1 + 2 * np.cos(turn), 0 * turn, 2 * np.sin(turn)]), abs=8 * EPS)
    assert arc([3, 0, 0], [-1, 0, 0], [1, 0, -2], 2)[1] == pytest.approx(
        [1 + 2 * np.cos(np.radians(135)), 0, 2 * np.sin(np.radians(135))], abs=8 * EPS
    )


def test_a_flat_arc_keeps_its_rise() -> None:
    """Rise 1e-6 over a chord of 2: the quarter points are at 3/4 of the rise, but for eps / rise = 1e-10."""
    found = arc([-1, 0, 0], [0, 0, 1e-6], [1, 0, 0], 4)
    assert found[1, 2] == pytest.approx(0.75e-6, rel=1e-9) and found[2, 2] == pytest.approx(1e-6, rel=1e-9)


def test_the_arc_of_length_20_in_50_pieces() -> None:
    """Chapter 9.5: equal pieces, each with chord 2 r sin(angle / 100)."""
    x = arc([-5, 0, 0], [0, 0, 8], [5, 0, 0], 50)
    piece = np.linalg.norm(np.diff(x, axis=0), axis=1)
    radius = (25 + 64) / 16
    angle = 2 * (np.pi - np.arcsin(5 / radius))
    assert piece == pytest.approx(np.full(50, 2 * radius * np.sin(angle / 100)), rel=1e-12)


@pytest.mark.parametrize("b", [(0.5, 0, 0), (2, 0, 0), (0, 0, 0), (1, 0, 0), (0.5, 1e-12, 0)])
def test_points_in_a_row_are_refused(b: Any) -> None:
    """Collinear, outside the ends, or on one of them."""
    with pytest.raises(InputError, match="b: the three points are in line"):
        arc([0, 0, 0], b, [1, 0, 0], 4)
    with pytest.raises(InputError, match="in line or coincide"):
        arc([1, 1, 1], [1, 1, 1], [1, 1, 1], 4)


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (lambda: arc([0, 0], [1, 1, 1], [2, 0, 0], 4), "a: .* x, y, z expected"),
        (lambda: arc([0, 0, 0], "b", [2, 0, 0], 4), "b: 'b' given"),
        (lambda: arc([0, 0, 0], [1, 1, 1], [2, 0, np.nan], 4), "c: .* finite"),
        (lambda: arc([0, 0, 0], [1, 1, 1], [2, 0, 0], 0), "count: 0 given"),
        (lambda: interpolate([[0, 0, 0]], 4), "points: shape"),
        (lambda: interpolate("x", 4), "points: rows"),
        (lambda: interpolate([[0, 0, 0]] * 3, 4), "points: all points coincide"),
        (lambda: interpolate([[0, 0, 0], [1, 0, 0]], 4, degree=0), "degree: 0 given"),
        (lambda: interpolate([[0, 0, 0], [1, 0, 0]], 2.5), "count: 2.5 given"),  # type: ignore[arg-type]
    ],
)
def test_what_cannot_be_is_refused(call: Any, says: str) -> None:
    """One sentence with the name of what was given."""
    with pytest.raises(InputError, match=says):
        call()


def test_a_curve_passes_the_points() -> None:
    """Sampled at the points' own chord parameters (equal chords here) it meets them, to rounding."""
    turn = np.linspace(0, 4, 9)
    x = np.column_stack([np.cos(turn), np.sin(turn), turn])
    assert interpolate(x, 8 * 5)[::5] == pytest.approx(x, abs=1e-13)
    assert interpolate(x, 16, degree=1)[1::2] == pytest.approx((x[1:] + x[:-1]) / 2, abs=1e-13)
    doubled = np.repeat(x, 2, axis=0)
    assert interpolate(doubled, 16) == pytest.approx(interpolate(x, 16), abs=1e-13)


def test_a_cubic_is_fourth_order() -> None:
    """Between the points of a circle the error of a cubic spline falls like h^4: slope 4 +- 0.3 (de Boor)."""
    errors = []
    for n in (16, 32, 64):
        turn = np.linspace(0, 2, n + 1)
        x = np.column_stack([np.cos(turn), np.sin(turn), 0 * turn])
        errors.append(np.abs(np.linalg.norm(interpolate(x, 7 * n), axis=1) - 1).max())
    slopes = np.log2(np.array(errors[:-1]) / errors[1:])
    assert slopes == pytest.approx([4, 4], abs=0.3)


def test_few_points_lower_the_degree() -> None:
    """Two points: a straight line; three: a parabola through them."""
    assert interpolate([[0, 0, 0], [2, 4, 6]], 2)[1] == pytest.approx([1, 2, 3], abs=4 * EPS)
    assert interpolate([[-1, 1, 0], [0, 0, 0], [1, 1, 0]], 4)[1] == pytest.approx([-0.5, 0.25, 0], abs=4 * EPS)


@SEEDED
@given(st.floats(1.0, 900.0), st.floats(1e-3, 1e3), st.integers(2, 40))
def test_an_arc_of_a_length_stands_over_its_span(times: float, span: float, count: int) -> None:
    """Ends a span apart; chords c of a circle of radius r, each the part 2 r asin(c / 2r) of the length: to 1e-7, for
    the radius of a flat arc is lost with the square root of what rounds its height."""
    found = arc_of_length(times * span, span, count)
    assert found[-1] - found[0] == pytest.approx([span, 0.0, 0.0], abs=1e-9 * times * span)
    chords = np.linalg.norm(np.diff(found, axis=0), axis=1)
    assert chords == pytest.approx(np.full(count, chords[0]), rel=1e-9, abs=1e-12 * times * span)
    finer = arc_of_length(times * span, span, 2000 * count)
    assert np.linalg.norm(np.diff(finer, axis=0), axis=1).sum() == pytest.approx(times * span, rel=1e-5)
    assert (found[:, 1] == 0.0).all() and (found[:, 2] >= -1e-9 * times * span).all()


@pytest.mark.parametrize("length", [0.999, 1001.0, float("nan")])
def test_an_arc_shorter_than_its_span_is_refused(length: float) -> None:
    with pytest.raises(InputError, match="given for a span of 1; at least the span, at most 1000 times it allowed"):
        arc_of_length(length, 1.0, 8)
