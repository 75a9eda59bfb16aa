"""Catenaries: the shape of a hanging cable or chain that does not stretch, y = a cosh(x / a).

A cable of length L with its ends b apart across gravity and h along it has the parameter a of
sinh(u) / u = sqrt(L^2 - h^2) / b, u = b / 2a. Weight per length times a is the horizontal part H of its tension; the
tension at a point is the weight per length times y. Source: Irvine, Cable Structures, 1981, chapter 1.
"""

from __future__ import annotations

from fractions import Fraction
from math import factorial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hookean.errors import InputError

Floats = NDArray[np.float64]

DOWN = (0.0, 0.0, -1.0)
LOOP = 300.0  # from this u on the cable hangs straight down and up again, in float64

_BERNOULLI = (
    Fraction(1, 6), Fraction(-1, 30), Fraction(1, 42), Fraction(-1, 30), Fraction(5, 66), Fraction(-691, 2730),
    Fraction(7, 6), Fraction(-3617, 510), Fraction(43867, 798), Fraction(-174611, 330), Fraction(854513, 138),
)  # fmt: skip
# log(sinh(u) / u) = sum of c_n u^2n, n = 1, 2 ...
_SERIES = [float(4**n * b / (2 * n * factorial(2 * n))) for n, b in enumerate(_BERNOULLI, start=1)]


def catenary(start: ArrayLike, end: ArrayLike, length: float, *, count: int = 50, gravity: ArrayLike = DOWN) -> Floats:
    """Points (count + 1, 3) [length] at equal arc lengths on the cable of this length from start to end.

    It hangs along `gravity`, a direction of any length. Ends above each other or in one place give a cable that
    hangs straight down and up again. InputError where the ends are further apart than the cable is long.
    """
    shape = _hang(start, end, length, count, gravity)
    points = shape.origin + np.outer(shape.across, shape.level) + np.outer(shape.up, -shape.down)
    points[0], points[-1] = start, end
    return np.asarray(points)


def catenaries(lines: ArrayLike, length: ArrayLike, *, count: int = 50, gravity: ArrayLike = DOWN) -> Floats:
    """Points (m, count + 1, 3) [length] of m cables, each from the first to the second end of a line (m, 2, 3).

    `length` and `gravity` are one for all, or one for each. InputError as `catenary`, naming the cable.
    """
    try:
        ends = np.array(lines, dtype=float)
        lengths = np.broadcast_to(np.array(length, dtype=float), (len(ends),))
        downs = np.broadcast_to(np.array(gravity, dtype=float), (len(ends), 3))
    except (TypeError, ValueError):
        said = "the numbers of cables, lengths and gravity directions differ; give one for all or one for each cable"
        raise InputError("length", said) from None
    if ends.ndim != 3 or ends.shape[1:] != (2, 3):
        raise InputError("lines", f"shape {list(ends.shape)} given; pairs of points expected")
    found = []
    for number, (line, long, down) in enumerate(zip(ends, lengths, downs, strict=True)):
        try:
            found.append(catenary(line[0], line[1], float(long), count=count, gravity=down))
        except InputError as error:
            raise InputError(f"{error.pointer}/{number}", error.sentence) from None
    return np.array(found, dtype=np.float64).reshape(len(ends), -1 if found else count + 1, 3)


def tensions(
    start: ArrayLike,
    end: ArrayLike,
    length: float,
    *,
    count: int = 50,
    gravity: ArrayLike = DOWN,
    weight: float = 1.0,
) -> Floats:
    """Tensions (count + 1,) [force] at the points of `catenary`, with `weight` per length [force/length].

    Infinite where the cable is straight. InputError as `catenary`, and for a weight that is not above 0.
    """
    heavy = _number(weight, "weight", "the weight per length is a finite number above 0")
    if heavy <= 0.0:
        raise InputError("weight", f"{heavy:g} given; the weight per length is above 0")
    shape = _hang(start, end, length, count, gravity)
    return heavy * shape.y


def catenary_of(a: float, x: ArrayLike) -> Floats:
    """Heights y = a cosh(x / a) [length] at distances x [length] from the lowest point; the directrix is y = 0.

    InputError where a is not above 0, a distance is not finite, or a height is beyond the largest float64.
    """
    above = _number(a, "a", "the parameter is a finite number above 0")
    if above <= 0.0:
        raise InputError("a", f"{above:g} given; the parameter is the height of the lowest point, above 0")
    try:
        across = np.array(x, dtype=float)
    except (TypeError, ValueError):
        raise InputError("x", f"{x!r} given; a distance or a row of distances expected") from None
    if not np.isfinite(across).all():
        raise InputError("x", "a distance that is not finite given; all are finite numbers")
    with np.errstate(over="ignore"):
        heights = np.asarray(above * np.cosh(across / above))
    if not np.isfinite(heights).all():
        furthest = float(np.abs(across).max())
        raise InputError("x", f"{furthest:g} given with a = {above:g}; the height is too large; stay within 700 a")
    return heights


def parameter(span: float, length: float, rise: float = 0.0) -> float:
    """The parameter a [length] of a cable with its ends `span` apart across gravity and `rise` along it.

    Infinite where the cable is straight, 0 where the ends are above each other. InputError where it is too short,
    or a number is not finite.
    """
    span = abs(_number(span, "span", "the distance of the ends across gravity is a finite number"))
    rise = abs(_number(rise, "rise", "the distance of the ends along gravity is a finite number"))
    u = _half_angle(span, _excess(np.array([span, 0.0, rise]), length))
    return np.inf if u == 0.0 else 0.0 if np.isinf(u) else 0.5 * span / u


def sag(span: float, length: float) -> float:
    """How far the middle hangs below ends at one height [length]: a (cosh(b / 2a) - 1)."""
    a = parameter(span, length)
    if np.isinf(a):
        return 0.0
    return 0.5 * float(length) if a == 0.0 else float(2.0 * a * np.sinh(0.25 * abs(span) / a) ** 2)


class _Shape(NamedTuple):
    """A cable in its plane: `across` and `up` (n,) from its start, y (n,) over the directrix."""

    origin: Floats
    level: Floats
    down: Floats
    across: Floats
    up: Floats
    y: Floats


def _hang(start: ArrayLike, end: ArrayLike, length: float, count: int, gravity: ArrayLike) -> _Shape:
    a, b, down = _point(start, "start"), _point(end, "end"), _point(gravity, "gravity")
    if not down.any():
        raise InputError("gravity", "a zero vector given; give the direction in which the cable hangs")
    if isinstance(count, bool) or not isinstance(count, int | np.integer) or count < 1:
        raise InputError("count", f"{count!r} given; the number of pieces is a whole number from 1 on")
    down = down / np.abs(down).max()
    down /= np.linalg.norm(down)
    chord = b - a
    rise = -float(chord @ down)
    level = np.cross(down, np.cross(chord, down))
    span = float(np.linalg.norm(level))
    level = level / span if span > 0.0 else np.zeros(3)
    excess = _excess(chord, length)
    u = _half_angle(span, excess)
    arc: Floats = np.arange(count + 1, dtype=np.float64) * (float(length) / count)
    if u == 0.0:
        part = np.arange(count + 1) / count
        return _Shape(a, level, down, part * span, part * rise, np.full(count + 1, np.inf))
    if u > LOOP:
        deep = 0.5 * (float(length) - rise)
        up = np.where(arc <= deep, -arc, arc - 2.0 * deep)
        return _Shape(a, level, down, span * np.arange(count + 1) / count, up, up + deep)
    across, up, y = _along(0.5 * span / u, u, float(np.hypot(span, np.sqrt(excess))), rise, float(length), arc)
    return _Shape(a, level, down, across, up, y)


def _along(a: float, u: float, reach: float, rise: float, length: float, arc: Floats) -> tuple[Floats, Floats, Floats]:
    """Distance across, height over the start and over the directrix at arc lengths; `reach` = sqrt(L^2 - h^2)."""
    first = np.copysign(np.log((length + abs(rise)) / reach), rise) - u  # x / a of the start
    q = np.sinh(first)
    p = q + arc / a
    # x / a further on: asinh(p) - asinh(q), without loss where both are nearly the same
    cq, cp = np.hypot(1.0, q), np.hypot(1.0, p)
    alike = p * q > 0.0
    with np.errstate(divide="ignore", invalid="ignore"):
        near = (arc / a) * (p + q) / (p * cq + q * cp)
    further = np.arcsinh(np.where(alike, near, p * cq - q * cp))
    return a * further, 2.0 * a * np.sinh(first + 0.5 * further) * np.sinh(0.5 * further), a * cp


def _excess(chord: Floats, length: float) -> float:
    """L^2 - |chord|^2 [length^2], exact but for the last rounding; InputError where the cable is too short."""
    length = _number(length, "length", "the length of the cable is a finite number, not below 0")
    if length < 0.0:
        raise InputError("length", f"{length!r} given; the length of the cable is a finite number, not below 0")
    apart = sum(Fraction(float(c)) ** 2 for c in chord)
    excess = float(Fraction(length) ** 2 - apart)
    if excess < -8.0 * np.finfo(float).eps * float(apart):
        shortest = float(np.linalg.norm(chord))
        raise InputError(
            "length",
            f"{length:.17g} given; the ends are {shortest:.17g} apart and no shorter cable joins them. Give at least "
            "that, or bring the ends nearer",
        )
    return max(excess, 0.0)


def _half_angle(span: float, excess: float) -> float:
    """u = b / 2a of sinh(u) / u = sqrt(b^2 + excess) / b; 0 for a straight cable, infinite for a loop."""
    if excess == 0.0:
        return 0.0
    reach = float(np.hypot(span, np.sqrt(excess)))
    if span == 0.0 or reach / span > 1e200:
        return np.inf
    wanted = float(np.log1p(excess / (span * (span + reach))))
    low, high = 0.0, 2.0 * wanted + 2.0 * np.sqrt(wanted) + 10.0
    u = float(np.sqrt(6.0 * wanted)) if wanted < 1.0 else wanted + np.log(2.0 * wanted + 2.0)
    for _ in range(200):
        off = _log_ratio(u) - wanted
        low, high = (low, u) if off > 0.0 else (u, high)
        better = u - off / _slope(u)
        if not low < better < high:
            better = 0.5 * (low + high)
        if abs(better - u) <= 4e-16 * u:
            return better
        u = better
    return u


def _log_ratio(u: float) -> float:
    """log(sinh(u) / u)."""
    if u > 0.7:
        return float(u + np.log1p(-np.exp(-2.0 * u)) - np.log(2.0 * u))
    total = 0.0
    for c in reversed(_SERIES):
        total = (total + c) * u * u
    return total


def _slope(u: float) -> float:
    """coth(u) - 1/u."""
    if u > 0.7:
        return float(1.0 / np.tanh(u) - 1.0 / u)
    total = 0.0
    for n, c in reversed(list(enumerate(_SERIES, start=1))):
        total = total * u * u + 2.0 * n * c
    return total * u


def _point(value: ArrayLike, name: str) -> Floats:
    try:
        point = np.array(value, dtype=float)
    except (TypeError, ValueError):
        raise InputError(name, f"{value!r} given; x, y, z expected") from None
    if point.shape != (3,) or not (np.abs(point) <= 1e100).all():
        raise InputError(name, f"{value!r} given; x, y, z expected, finite and below 1e100")
    return point


def _number(value: Any, name: str, allowed: str) -> float:
    """A finite number; raises InputError with the given value and the allowed ones."""
    try:
        number = float(value)
    except (TypeError, ValueError, OverflowError):
        raise InputError(name, f"{value!r} given; {allowed}") from None
    if not abs(number) <= 1e100:
        raise InputError(name, f"{number!r} given; {allowed}" + (", up to 1e100" if np.isfinite(number) else ""))
    return number
