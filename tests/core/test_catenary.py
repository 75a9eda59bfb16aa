"""Catenaries: exact shapes at every slackness, checked against the definition with 50 digits."""

from __future__ import annotations

from collections.abc import Callable
from decimal import Decimal, localcontext
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hookean.discretize.catenary import catenary, catenary_of, parameter, sag, tensions
from hookean.errors import InputError
from soak import examples

SEEDED = settings(derandomize=True, deadline=None, max_examples=examples(200), database=None)
EPS = float(np.finfo(float).eps)


def exact(span: float, rise: float, length: float, count: int) -> tuple[np.ndarray, float]:
    """Points (count + 1, 2) and parameter by bisection of 2a sinh(b/2a) = sqrt(L^2 - h^2) in 60 decimal digits."""
    with localcontext() as context:
        context.prec = 60
        b, h, l = Decimal(span), Decimal(rise), Decimal(length)

        def sinh(t: Decimal) -> Decimal:
            return (t.exp() - (-t).exp()) / 2

        def asinh(s: Decimal) -> Decimal:
            root = (abs(s) + (s * s + 1).sqrt()).ln()
            return root if s >= 0 else -root

        reach = (l * l - h * h).sqrt()
        low, high = Decimal(0), Decimal(400)
        for _ in range(200):
            u = (low + high) / 2
            low, high = (u, high) if u == 0 or sinh(u) / u < reach / b else (low, u)
        a = b / (2 * u)
        middle = ((l + h) / (l - h)).ln() / 2
        first = middle - u
        points = []
        for k in range(count + 1):
            t = asinh(sinh(first) + l * k / (count * a))
            points.append(
                [float(a * (t - first)), float(a * ((t.exp() + (-t).exp()) - (first.exp() + (-first).exp())) / 2)]
            )
        return np.array(points), float(a)


def plane(gravity: Any) -> np.ndarray:
    """Rows: two directions across gravity, and up."""
    up = -np.asarray(gravity, float) / np.linalg.norm(gravity)
    across = np.cross(up, [0.3, -0.5, 0.8])
    across /= np.linalg.norm(across)
    return np.array([across, np.cross(up, across), up])


GRAVITIES = {"down": (0, 0, -1), "sideways": (2.0, 0, 0), "aslant": (1.0, -2.0, 0.5)}
SHAPES = {
    "nearly taut": (6.0, 2.5, 6.5001),
    "level": (10.0, 0.0, 12.0),
    "rising": (4.0, 3.0, 7.0),
    "falling": (1.0, -8.0, 8.5),
    "very slack": (3.0, -1.0, 60.0),
}


@pytest.mark.parametrize("gravity", GRAVITIES)
@pytest.mark.parametrize("shape", SHAPES)
def test_points_lie_on_the_closed_form(shape: str, gravity: str) -> None:
    """Five shapes, nearly taut to very slack, under three gravities: every point to 1e-12 of the length (some eps of a,
    sinh and the frame)."""
    (span, rise, length), frame = SHAPES[shape], plane(GRAVITIES[gravity])
    start = np.array([1.0, -2.0, 0.5])
    end = start + span * frame[0] + rise * frame[2]
    # the frame rounds: the exact answer is that of the span and rise there are
    chord = end - start
    found = catenary(start, end, length, count=12, gravity=GRAVITIES[gravity])
    right, _ = exact(float(np.linalg.norm(chord - (chord @ frame[2]) * frame[2])), float(chord @ frame[2]), length, 12)
    assert found.shape == (13, 3) and (found[0] == start).all() and (found[-1] == end).all()
    assert (
        np.abs((found - start) @ frame.T - np.column_stack([right[:, 0], 0 * right[:, 0], right[:, 1]])).max()
        <= 1e-12 * length
    )


@pytest.mark.parametrize("rise", [0.0, 0.5, -3.0])
@pytest.mark.parametrize("more", [2.0**-50, 1e-12, 1e-9, 1e-6, 1e-3, 0.1, 1.0, 100.0, 1e6])
def test_from_nearly_taut_to_very_slack(more: float, rise: float) -> None:
    """length / chord - 1 from 1e-15 to 1e6: points to 1e-14 of the length."""
    chord = float(np.hypot(2.0, rise))
    length = chord * (1.0 + more)
    found = catenary([0, 0, 0], [2.0, 0, rise], length, count=8)
    right, a = exact(2.0, rise, length, 8)
    assert np.abs(found[:, [0, 2]] - right).max() <= 1e-14 * length
    assert parameter(2.0, length, rise) == pytest.approx(a, rel=1e-12)
    y = tensions([0, 0, 0], [2.0, 0, rise], length, count=8)
    assert y.min() >= a * (1 - 1e-12)
    assert y - y[0] == pytest.approx(right[:, 1], abs=1e-14 * y.max() + 1e-14 * length)


@SEEDED
@given(st.floats(0.01, 100), st.floats(-50, 50), st.floats(1e-3, 3), st.integers(1, 40))
def test_pieces_have_equal_arc_length(span: float, rise: float, more: float, count: int) -> None:
    """Arc length of every piece, from the tensions at its ends: l = sqrt(y2^2 - a^2) -+ sqrt(y1^2 - a^2)."""
    length = float(np.hypot(span, rise)) * (1.0 + more)
    x = catenary([0, 0, 0], [span, 0, rise], length, count=count)
    y, a = tensions([0, 0, 0], [span, 0, rise], length, count=count), parameter(span, length, rise)
    # along the curve dz/dx = sinh(t), and the chord of a piece between t1 and t2 tells both
    steps = np.diff(x, axis=0)
    t = np.arcsinh(steps[:, 2] / (2.0 * a * np.sinh(0.5 * steps[:, 0] / a)))
    arc = 2.0 * a * np.cosh(t) * np.sinh(0.5 * steps[:, 0] / a)
    assert arc == pytest.approx(np.full(count, length / count), rel=1e-9)
    assert y[:-1] + y[1:] == pytest.approx(2.0 * a * np.cosh(t) * np.cosh(0.5 * steps[:, 0] / a), rel=1e-9)


def test_the_published_cable() -> None:
    """Span 10, length 12: a 4.69541523, sag 2.92343798, largest tension 7.61885321 at unit weight (Irvine)."""
    assert parameter(10.0, 12.0) == pytest.approx(4.69541523, abs=5e-9)
    assert sag(10.0, 12.0) == pytest.approx(2.92343798, abs=5e-9)
    assert tensions([0, 0, 0], [10, 0, 0], 12.0).max() == pytest.approx(7.61885321, abs=5e-9)
    assert tensions([0, 0, 0], [10, 0, 0], 12.0, weight=3.0).max() == pytest.approx(3.0 * 7.61885321, abs=2e-8)
    a = parameter(10.0, 12.0)
    assert catenary_of(a, 5.0) - a == pytest.approx(sag(10.0, 12.0), rel=1e-14)
    assert catenary_of(2.0, [0.0, 2.0]) == pytest.approx([2.0, 2.0 * np.cosh(1.0)], rel=EPS)


def test_ends_above_each_other_hang_down_and_up() -> None:
    """A above B, B above A, and A on B: straight down by (L - rise)/2 and up again, at equal arc lengths."""
    for rise in (-3.0, 3.0, 0.0):
        x = catenary([1, 2, 0], [1, 2, rise], 5.0, count=10)
        arc = np.linspace(0.0, 5.0, 11)
        deep = 0.5 * (5.0 - rise)
        assert (x[:, :2] == [1, 2]).all()
        assert x[:, 2] == pytest.approx(np.where(arc < deep, -arc, arc - 2 * deep), abs=8 * EPS)
        assert tensions([1, 2, 0], [1, 2, rise], 5.0, count=10) == pytest.approx(np.abs(arc - deep), abs=8 * EPS)
    assert parameter(0.0, 5.0) == 0.0 and sag(0.0, 5.0) == 2.5
    near = catenary([0, 0, 0], [1e-300, 0, 0], 2.0, count=4)
    assert near[:, 2] == pytest.approx([0, -0.5, -1, -0.5, 0], abs=4 * EPS) and (near[:, 0] <= 1e-300).all()


def test_the_loop_joins_the_catenary() -> None:
    """Ends nearer and nearer: the deviation from down-and-up falls like a; at b = 1e-9 it is below 1e-9."""
    for b in (1e-3, 1e-6, 1e-9):
        x = catenary([0, 0, 0], [b, 0, 0], 2.0, count=4)
        assert np.abs(x[:, 2] - [0, -0.5, -1, -0.5, 0]).max() <= b


def test_straight_cables() -> None:
    """As long as its chord, also by rounding: points on the line, no sag, infinite tension."""
    end = np.array([0.1, 0.2, 0.7])
    length = float(np.linalg.norm(end))
    for given_length in (length, np.nextafter(length, 0.0)):
        x = catenary([0, 0, 0], end, given_length, count=4)
        assert x == pytest.approx(np.linspace(0, 1, 5)[:, None] * end, abs=1e-8)
    assert catenary([0, 0, 0], [3, 4, 0], 5.0, count=2)[1] == pytest.approx([1.5, 2.0, 0.0], abs=4 * EPS)
    assert parameter(3.0, 5.0, 4.0) == np.inf and sag(5.0, 5.0) == 0.0
    assert np.isinf(tensions([0, 0, 0], [3, 4, 0], 5.0)).all()


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"length": 4.999}, "length: 4.99.* the ends are 5 apart"),
        ({"length": float("nan")}, "length: nan given"),
        ({"length": -1.0}, "length: -1.0 given"),
        ({"count": 0}, "count: 0 given"),
        ({"count": True}, "count: True given"),
        ({"gravity": (0, 0, 0)}, "gravity: a zero vector"),
        ({"gravity": "down"}, "gravity: 'down' given"),
        ({"start": (0, 0)}, "start: .* x, y, z expected"),
        ({"end": (0, 0, float("inf"))}, "end: .* finite"),
    ],
)
def test_what_cannot_be_is_refused(change: dict[str, Any], says: str) -> None:
    """One sentence with the place, and for cables too short the least length there is."""
    call = {"start": (0, 0, 0), "end": (3, 4, 0), "length": 6.0, "count": 4, **change}
    with pytest.raises(InputError, match=says):
        catenary(call.pop("start"), call.pop("end"), call.pop("length"), **call)


NO_NUMBER = float("nan")


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (lambda: catenary([0, 0, 0], [3, 4, 0], "long"), "length: 'long' given; .* finite number"),  # type: ignore[arg-type]
        (lambda: catenary([0, 0, 0], [3, 4, 0], 1e300), r"length: 1e\+300 given; .* up to 1e100"),
        (lambda: tensions([0, 0, 0], [3, 4, 0], 6.0, weight=NO_NUMBER), "weight: nan given"),
        (lambda: tensions([0, 0, 0], [3, 4, 0], 5.0, weight=0.0), "weight: 0 given; .* above 0"),
        (lambda: parameter(NO_NUMBER, 6.0), "span: nan given"),
        (lambda: parameter(4.0, 6.0, float("inf")), "rise: inf given"),
        (lambda: sag(None, 6.0), "span: None given"),  # type: ignore[arg-type]
        (lambda: sag(4.0, 3.0), "length: 3 given; the ends are 4 apart"),
        (lambda: catenary_of(0.0, [1.0]), "a: 0 given; .* above 0"),
        (lambda: catenary_of(-2.0, [1.0]), "a: -2 given; .* above 0"),
        (lambda: catenary_of(NO_NUMBER, [1.0]), "a: nan given"),
        (lambda: catenary_of(2.0, [1.0, NO_NUMBER]), "x: a distance that is not finite"),
        (lambda: catenary_of(2.0, "wide"), "x: 'wide' given"),
        (lambda: catenary_of(1.0, [0.0, -1e5]), "x: 100000 given with a = 1; .* within 700 a"),
    ],
)
def test_numbers_that_are_none_are_refused(call: Callable[[], Any], says: str) -> None:
    """No function of catenaries returns what is not a number, and none answers with an error of its libraries."""
    with pytest.raises(InputError, match=says):
        call()
