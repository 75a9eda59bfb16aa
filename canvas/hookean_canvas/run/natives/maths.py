"""Natives of the tab Maths: operators, domains, trigonometry, utilities."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable
from functools import reduce
from itertools import pairwise
from typing import Any

import numpy as np

from hookean_canvas.run.natives import shapes
from hookean_canvas.run.natives.declare import Unfit, bounded, native
from hookean_canvas.run.natives.kinds import as_kind
from hookean_canvas.run.rhino import rhino3dm


def _operand(value: Any) -> Any:
    """A number, or a point or vector as array; text as the number that it is."""
    if hasattr(value, "Z"):
        return shapes.xyz(value)
    if isinstance(value, bool):
        return int(value)
    return value if isinstance(value, (int, float)) else as_kind("number", value)


def _as(result: Any, *values: Any) -> Any:
    """The result as point where an operand was one, as vector where one was a vector, else as number."""
    if not hasattr(result, "shape") or result.shape == ():
        return float(result) if hasattr(result, "shape") else result
    of_points = any(isinstance(value, rhino3dm.Point3d) for value in values)
    return shapes.point(result) if of_points else shapes.vector(result)


def _both(calculate: Callable[[Any, Any], Any], a: Any, b: Any) -> Any:
    return _as(calculate(_operand(a), _operand(b)), a, b)


_TWO = "A (A): any; B (B): any ..."


@native("a0d62394-a118-422d-abb3-6af115c75b25", "Addition", "A+B", _TWO, "Result (R)")
def addition(*values: Any) -> Any:
    """The sum of numbers, points or vectors."""
    return reduce(lambda a, b: _both(operator.add, a, b), values)


@native("9c007a04-d0d9-48e4-9da3-9ba142bc4d46", "Subtraction", "A-B", "A (A): any; B (B): any", "Result (R)")
def subtraction(a: Any, b: Any) -> Any:
    """The difference A - B of numbers, points or vectors."""
    return _both(operator.sub, a, b)


def _product(a: Any, b: Any) -> Any:
    x, y = _operand(a), _operand(b)
    both = hasattr(x, "shape") and hasattr(y, "shape")
    return float(x @ y) if both else _as(x * y, a, b)


@native("ce46b74e-00c9-43c4-805a-193b69ea4a11 b8963bb1-aa57-476e-a20e-ed6cf635a49c", "Multiplication", "A×B",
        _TWO, "Result (R)")  # fmt: skip
def multiplication(*values: Any) -> Any:
    """The product of numbers, of a number and a vector, or the dot product of two vectors."""
    return reduce(_product, values)


@native("9c85271f-89fa-4e9f-9f4a-d75802120ccc", "Division", "A/B", "A (A): any; B (B): any", "Result (R)")
def division(a: Any, b: Any) -> Any:
    """The quotient A / B of numbers, or of a point or vector and a number."""
    if _operand(b) == 0:
        raise Unfit("Division by zero")
    return _both(operator.truediv, a, b)


@native("54db2568-3441-4ae2-bcef-92c4cc608e11", "Integer Division", "A\\B",
        "A (A): integer; B (B): integer", "Result (R)")  # fmt: skip
def integer_division(a: int, b: int) -> int:
    """The quotient of whole numbers without its fraction."""
    if b == 0:
        raise Unfit("Division by zero")
    return math.trunc(a / b) if max(abs(a), abs(b)) < 2**53 else abs(a) // abs(b) * (1 if (a < 0) == (b < 0) else -1)


@native("431bc610-8ae1-4090-b217-1a9d9c519fe2", "Modulus", "Mod", "A (A): any; B (B): any", "Result (R)")
def modulus(a: Any, b: Any) -> Any:
    """The remainder of A / B, with the sign of A."""
    x, y = _operand(a), _operand(b)
    if y == 0:
        raise Unfit("Division by zero")
    found = math.fmod(x, y)
    return int(found) if isinstance(x, int) and isinstance(y, int) else found


@native("78fed580-851b-46fe-af2f-6519a9d378e0", "Power", "Pow", "A (A): number; B (B): number", "Result (R)")
def power(a: float, b: float) -> float:
    """A to the power B."""
    return _real(lambda: math.pow(a, b))


def _real(calculate: Callable[[], float]) -> float:
    try:
        return calculate()
    except (ValueError, OverflowError, ZeroDivisionError) as error:
        raise Unfit(f"no real result: {error}") from None


@native("a3371040-e552-4bc8-b0ff-10a840258e88", "Negative", "Neg", "Value (x): any", "Result (y)")
def negative(value: Any) -> Any:
    """The negative of a number, point or vector."""
    return _as(-_operand(value), value)


@native("28124995-cf99-4298-b6f4-c75a8e379f18", "Absolute", "Abs", "Value (x): any", "Result (y)")
def absolute(value: Any) -> Any:
    """The absolute value of a number; the length of a vector."""
    found = _operand(value)
    return float((found @ found) ** 0.5) if hasattr(found, "shape") else abs(found)


_FUNCTIONS: list[tuple[str, str, str, Callable[[float], float], str]] = [
    ("2280dde4-9fa2-4b4a-ae2f-37d554861367", "Square", "Sqr", lambda x: x * x, "The square of a number."),
    ("ad476cb7-b6d1-41c8-986b-0df243a64146", "Square Root", "Sqrt", math.sqrt, "The square root of a number."),
    ("7e3185eb-a38c-4949-bcf2-0e80dee3a344", "Cube", "Cube", lambda x: x**3, "The cube of a number."),
    ("5b0be57a-31f5-4446-a11a-ae0d348bca90", "Cube Root", "Cbrt", math.cbrt, "The cube root of a number."),
    ("797d922f-3a1d-46fe-9155-358b009b5997", "One Over X", "1/x", lambda x: 1.0 / x, "One over a number."),
    ("27d6f724-a701-4585-992f-3897488abf08", "Logarithm", "Log", math.log10, "The logarithm to base 10."),
    ("23afc7aa-2d2f-4ae7-b876-bf366246b826", "Natural logarithm", "Ln", math.log, "The logarithm to base e."),
    ("2ebb82ef-1f90-4ac9-9a71-1fe0f4ef7044", "Power of 10", "10º", lambda x: 10.0**x, "10 to a power."),
    ("7a1e5fd7-b7da-4244-a261-f1da66614992", "Power of 2", "2º", lambda x: 2.0**x, "2 to a power."),
    ("c717f26f-e4a0-475c-8e1c-b8f77af1bc99", "Power of E", "Eº", math.exp, "e to a power."),
    ("7663efbb-d9b8-4c6a-a0da-c3750a7bbe77", "Sine", "Sin", math.sin, "The sine of an angle in radians."),
    ("d2d2a900-780c-4d58-9a35-1f9d8d35df6f", "Cosine", "Cos", math.cos, "The cosine of an angle in radians."),
    ("0f31784f-7177-4104-8500-1f4f4a306df4", "Tangent", "Tan", math.tan, "The tangent of an angle in radians."),
    ("cc15ba56-fae7-4f05-b599-cb7c43b60e11", "ArcSine", "ASin", math.asin, "The angle in radians with this sine."),
    ("49584390-d541-41f7-b5f6-1f9515ac0f73", "ArcCosine", "ACos", math.acos, "The angle with this cosine."),
    ("b4647919-d041-419e-99f5-fa0dc0ddb8b6", "ArcTangent", "ATan", math.atan, "The angle with this tangent."),
]


def _declare(guid: str, name: str, nickname: str, calculate: Callable[[float], float], does: str) -> None:
    def run(x: float) -> float:
        return _real(lambda: calculate(x))

    run.__doc__ = does
    native(guid, name, nickname, "Value (x): number", "Result (y)")(run)


for _row in _FUNCTIONS:
    _declare(*_row)


@native("0d77c51e-584f-44e8-aed2-c2ddf4803888", "Degrees", "Deg", "Radians (R): number", "Degrees (D)")
def degrees(angle: float) -> float:
    """Radians as degrees."""
    return math.degrees(angle)


@native("a4cd2751-414d-42ec-8916-476ebf62d7fe", "Radians", "Rad", "Degrees (D): number", "Radians (R)")
def radians(angle: float) -> float:
    """Degrees as radians."""
    return math.radians(angle)


@native("0d2ccfb3-9d41-4759-9452-da6a522c3eaa", "Pi", "Pi", "Factor (N): number = 1.0", "Output (y)")
def pi(factor: float) -> float:
    """A multiple of pi."""
    return factor * math.pi


@native("cb22d3ed-93d8-4629-bdf2-c0c7c25afd2c", "Golden Ratio", "Phi", "Factor (N): number = 1.0", "Output (y)")
def golden_ratio(factor: float) -> float:
    """A multiple of the golden ratio (1 + sqrt 5) / 2."""
    return factor * (1.0 + math.sqrt(5.0)) / 2.0


@native("b6cac37c-21b9-46c6-bd0d-17ff67796578", "Natural logarithm", "E", "Factor (N): number = 1.0", "Output (y)")
def natural_number(factor: float) -> float:
    """A multiple of e."""
    return factor * math.e


def _present(values: list[Any]) -> list[Any]:
    found = [value for value in values if value is not None]
    if not found:
        raise Unfit("the list has no values")
    return found


@native("7986486c-621a-48fb-8f27-a28a22c91cc9", "Average", "Avr", "Input (I): any list", "Arithmetic mean (AM)")
def average(values: list[Any]) -> Any:
    """The mean of numbers, points or vectors."""
    found = _present(values)
    total = sum(map(_operand, found[1:]), _operand(found[0]))
    return _as(total / len(found), *found)


@native("5b850221-b527-4bd6-8c62-e94168cd6efa", "Mass Addition", "MA",
        "Input (I): any list", "Result (R); Partial Results (Pr): list")  # fmt: skip
def mass_addition(values: list[Any]) -> tuple[Any, list[Any]]:
    """The sum of a list, and the sums up to each of its items."""
    return _partial(operator.add, values)


@native("e44c1bd7-72cc-4697-80c9-02787baf7bb4", "Mass Multiplication", "MM",
        "Input (I): any list", "Result (R); Partial Results (Pr): list")  # fmt: skip
def mass_multiplication(values: list[Any]) -> tuple[Any, list[Any]]:
    """The product of a list, and the products up to each of its items."""
    return _partial(operator.mul, values)


def _partial(calculate: Callable[[Any, Any], Any], values: list[Any]) -> tuple[Any, list[Any]]:
    found = _present(values)
    sums = [_operand(found[0])]
    for value in found[1:]:
        sums.append(calculate(sums[-1], _operand(value)))
    results = [_as(one, *found) for one in sums]
    return results[-1], results


@native("dd17d442-3776-40b3-ad5b-5e188b56bd4c", "Relative Differences", "RelDif",
        "Values (V): any list", "Differenced (D): list")  # fmt: skip
def relative_differences(values: list[Any]) -> list[Any]:
    """Differences between an item of a list and the one before it; one less than items."""
    found = [_operand(value) for value in _present(values)]
    results = [b - a for a, b in pairwise(found)]
    return [shapes.vector(one) if hasattr(one, "shape") else one for one in results]


@native("0d1e2027-f153-460d-84c0-f9af431b08cb", "Maximum", "Max", "A (A): number; B (B): number ...", "Result (R)")
def maximum(*values: float) -> float:
    """The largest number."""
    return max(values)


@native("57308b30-772d-4919-ac67-e86c18f3a996", "Minimum", "Min", "A (A): number; B (B): number ...", "Result (R)")
def minimum(*values: float) -> float:
    """The smallest number."""
    return min(values)


@native("a50c4a3b-0177-4c91-8556-db95de6c56c8", "Round", "Round",
        "Number (x): number", "Nearest (N); Floor (F); Ceiling (C)")  # fmt: skip
def rounded(x: float) -> tuple[int, int, int]:
    """The nearest whole number, halves to the even one, the one below or equal, and the one above or equal."""
    return round(x), math.floor(x), math.ceil(x)


@native("338666eb-14c5-4d9b-82e2-2b5be60655df", "Weighted Average", "Wav",
        "Input (I): any list; Weights (W): number list", "Arithmetic mean (AM)")  # fmt: skip
def weighted_average(values: list[Any], weights: list[float]) -> Any:
    """The mean of numbers, points or vectors, each times its weight; the last weight repeats."""
    sizes = [weights[min(i, len(weights) - 1)] for i in range(len(values))] if weights else []
    if not values or sum(sizes) == 0.0:
        raise Unfit("values are needed, and weights with a sum other than 0")
    if all(hasattr(one, "Z") for one in values):
        mean = np.average(shapes.rows(values), axis=0, weights=sizes)
        return (shapes.vector if isinstance(values[0], rhino3dm.Vector3d) else shapes.point)(mean)
    return float(np.average([as_kind("number", one) for one in values], weights=sizes))


@native("fe99f302-3d0d-4389-8494-bd53f7935a02", "Fibonacci", "Fib",
        "Seed A (A): number = 0.0; Seed B (B): number = 1.0; Number (N): integer = 10", "Series (S): list")  # fmt: skip
def fibonacci(first: float, second: float, count: int) -> list[float]:
    """Numbers of which each is the sum of the two before it."""
    bounded(count)
    found = [first, second]
    while len(found) < count:
        found.append(found[-2] + found[-1])
    return found[: max(count, 0)]
