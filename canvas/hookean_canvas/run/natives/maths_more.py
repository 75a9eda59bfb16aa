"""Natives of the tab Maths beside the usual ones: triangles, interpolation, smoothed lists, domains."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from hookean_canvas.run.natives import shapes
from hookean_canvas.run.natives.declare import Unfit, native
from hookean_canvas.run.natives.surfaces_at import Domain2, domain2
from hookean_canvas.run.rhino import rhino3dm

_FUNCTIONS: list[tuple[str, str, Callable[[float], float], str]] = [
    ("Sinc", "Sinc", lambda x: math.sin(x) / x if x else 1.0, "The sine of a number over it, 1 at 0."),
    ("CoSecant", "CoSec", lambda x: 1.0 / math.sin(x), "One over the sine."),
    ("Secant", "Sec", lambda x: 1.0 / math.cos(x), "One over the cosine."),
    ("CoTangent", "CoTan", lambda x: 1.0 / math.tan(x), "One over the tangent."),
]


def _declare(name: str, nickname: str, function: Callable[[float], float], does: str) -> None:
    def run(x: float) -> float:
        return function(x)

    run.__doc__ = does
    native("", name, nickname, "Value (x): number", "Result (y)")(run)


for _row in _FUNCTIONS:
    _declare(*_row)


@native("", "Factorial", "Fac", "Number (N): integer", "Factorial (F)")
def factorial(number: int) -> float:
    """The product of all whole numbers up to one."""
    if not 0 <= number <= 170:
        raise Unfit("Number must be from 0 to 170")
    return float(math.factorial(number))


@native("", "Interpolate data", "Interp", "Data (D): any list; Parameter (t): number", "Value (V)")
def interpolate_data(values: list[Any], t: float) -> Any:
    """The value at a part of the way along a list, 0 at its first item and 1 at its last, straight between two."""
    known = [value for value in values if value is not None]
    if not known:
        raise Unfit("the list is empty")
    place = min(max(t, 0.0), 1.0) * (len(known) - 1)
    k = min(int(place), len(known) - 2) if len(known) > 1 else 0
    a, b = known[k], known[min(k + 1, len(known) - 1)]
    part = place - k
    if isinstance(a, (int, float)) and isinstance(b, (int, float)):
        return (1.0 - part) * a + part * b
    if hasattr(a, "Z") and hasattr(b, "Z"):
        row = (1.0 - part) * shapes.xyz(a) + part * shapes.xyz(b)
        return shapes.vector(row) if isinstance(a, rhino3dm.Vector3d) else shapes.point(row)
    raise Unfit("numbers, points and vectors are interpolated")


@native("", "Blur Numbers", "NBlur",
        "Numbers (N): number list; Strength (S): number = 0.5; Iterations (I): integer = 1; Lock (L): boolean = False; "
        "Wrap (W): boolean = False", "Numbers (N): list")  # fmt: skip
def blur_numbers(numbers: list[float], strength: float, rounds: int, lock: bool, wrap: bool) -> list[float]:
    """Numbers that go so far to the mean of their neighbours, so often; with Lock the first and the last stay."""
    row = np.array(numbers, dtype=float)
    if len(row) < 2 or rounds < 0 or rounds * len(row) > 10_000_000:
        return list(map(float, numbers))
    for _ in range(rounds):
        before, after = np.roll(row, 1), np.roll(row, -1)
        if not wrap:
            before[0], after[-1] = row[1] if len(row) > 1 else row[0], row[-2]
        blurred = row + strength * (0.5 * (before + after) - row)
        if lock and not wrap:
            blurred[[0, -1]] = row[[0, -1]]
        row = blurred
    return [float(one) for one in row]


@native("", "Truncate", "Trunc", "Input (I): number list; Truncation factor (t): number = 0.25",
        "Truncated set (T): list")  # fmt: skip
def truncate(numbers: list[float], part: float) -> list[float]:
    """Sorted numbers without a part of them, half of it at each end."""
    gone = int(min(max(part, 0.0), 1.0) * len(numbers) / 2.0)
    ordered = sorted(numbers)
    return ordered[gone : len(ordered) - gone]


@native("", "Find Domain", "FDom", "Domains (D): domain list; Number (N): number; Strict (S): boolean = False",
        "Index (I); Neighbour (N)")  # fmt: skip
def find_domain(domains: list[Any], number: float, strict: bool) -> tuple[int, int]:
    """The number of the first domain that holds a number, or -1; and that of the nearest one."""
    ends = [(min(one.T0, one.T1), max(one.T0, one.T1)) for one in domains]
    holds = [a < number < b if strict else a <= number <= b for a, b in ends]
    gaps = [max(a - number, number - b, 0.0) for a, b in ends]
    return (holds.index(True) if any(holds) else -1), (gaps.index(min(gaps)) if gaps else -1)


@native("", "Deconstruct Domain²", "DeDom2",
        "Domain (I): any", "U component (U); V component (V) ...", sees=True)  # fmt: skip
def deconstruct_domain2(domain: Any, node: Any) -> tuple[Any, ...]:
    """The two domains of a domain in u and v, or its four ends where there are four outputs."""
    found = domain2(domain)
    if node is not None and len(node.outputs) == 4:
        return (*found.u, *found.v)
    return rhino3dm.Interval(*found.u), rhino3dm.Interval(*found.v)


@native("", "Bounds 2D", "Bnd", "Coordinates (C): point list", "Domain (I)")
def bounds2(places: list[Any]) -> Domain2:
    """The domain in u and v that holds points."""
    rows = shapes.rows(places)
    (u0, v0, _), (u1, v1, _) = rows.min(axis=0).tolist(), rows.max(axis=0).tolist()
    return Domain2((u0, u1), (v0, v1))


@native("", "Right Trigonometry", "RTrig",
        "Alpha (α): number optional; Beta (β): number optional; P length (P): number optional; "
        "Q length (Q): number optional; R length (R): number optional",
        "Alpha (α); Beta (β); P length (P); Q length (Q); R length (R)")  # fmt: skip
def right_triangle(
    alpha: float | None, beta: float | None, p: float | None, q: float | None, r: float | None
) -> tuple[float, float, float, float, float]:
    """A right triangle of two of its parts: alpha is opposite to P, beta to Q, and R is opposite to the right angle."""
    angle = alpha if alpha is not None else 0.5 * math.pi - beta if beta is not None else None
    if p is not None and q is not None:
        angle = math.atan2(p, q)
    elif r is not None and (p is not None or q is not None):
        angle = math.asin(p / r) if p is not None else math.acos((q or 0.0) / r)
    if angle is None or (p is None and q is None and r is None):
        raise Unfit("two parts are needed, one of them a length")
    long = r if r is not None else p / math.sin(angle) if p is not None else (q or 0.0) / math.cos(angle)
    return angle, 0.5 * math.pi - angle, long * math.sin(angle), long * math.cos(angle), long


@native("", "Triangle Trigonometry", "Trig",
        "Alpha (α): number optional; Beta (β): number optional; Gamma (γ): number optional; "
        "A length (A): number optional; B length (B): number optional; C length (C): number optional",
        "Alpha (α); Beta (β); Gamma (γ); A length (A); B length (B); C length (C)",
        remark="of three sides, two sides and the angle between them, or a side and two angles")  # fmt: skip
def triangle(*given: float | None) -> tuple[float, ...]:
    """A triangle of three of its parts."""
    angles, sides = list(given[:3]), list(given[3:])
    if sum(one is not None for one in sides) == 2:
        k = sides.index(None)
        i, j = (k + 1) % 3, (k + 2) % 3
        if angles[k] is None:
            raise Unfit("the angle between the two sides is needed")
        a, b = float(sides[i] or 0.0), float(sides[j] or 0.0)
        sides[k] = math.sqrt(a * a + b * b - 2.0 * a * b * math.cos(float(angles[k] or 0.0)))
    elif sum(one is not None for one in sides) == 1 and sum(one is not None for one in angles) >= 2:
        known = [math.pi - sum(x for x in angles if x is not None) if one is None else one for one in angles]
        k = next(i for i, one in enumerate(sides) if one is not None)
        over = float(sides[k] or 0.0) / math.sin(known[k])
        sides = [over * math.sin(one) for one in known]
    if any(one is None or one <= 0.0 for one in sides):
        raise Unfit("three parts are needed, one of them a side")
    a, b, c = (float(one or 0.0) for one in sides)
    if max(a, b, c) >= a + b + c - max(a, b, c):
        raise Unfit("no triangle has these sides")
    found = [math.acos((y * y + z * z - x * x) / (2.0 * y * z)) for x, y, z in ((a, b, c), (b, c, a), (c, a, b))]
    return (*found, a, b, c)
