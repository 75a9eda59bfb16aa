"""The range of numbers that a column of a force takes, where its model refuses others."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray
from pydantic import TypeAdapter, ValidationError

from hookean.forces.base import Force

Floats = NDArray[np.float64]
Accepts = Callable[[Floats], bool]

LARGE = 1e9  # a field that takes it has no largest value that a search meets
SLIGHT = 1e-3  # of the largest value, by which values are below 0 where it is asked whether they may be
HALVES = 50  # of the way to values that are refused: to the last digit
DIGITS = 9  # of a limit that itself is allowed
INSIDE = 1e-2  # part of one that is not: the nearest value that is used, for stiffnesses have no end beside it


def natural(cls: type[Force], field: str, values: Floats, accepts: Accepts) -> tuple[float, float]:
    """The least and the largest value of a column, -inf and inf where it has none; `accepts`: whether the force takes
    these values in the place of `values`, which it takes."""
    return _least(cls, field, values, accepts), _most(cls, field, values, accepts)


def _least(cls: type[Force], field: str, values: Floats, accepts: Accepts) -> float:
    """0 where the column takes no negative numbers."""
    if not values.size:
        return -np.inf
    if (values >= 0.0).all() and _refuses(cls, field, -1.0):
        return 0.0
    largest = float(np.abs(values).max())
    shift = -1.0 - values.max() - largest  # all together: of the vertices of a solid it stays one
    if accepts(values + shift):
        return -np.inf
    below = -values.max() - SLIGHT * (largest or 1.0)
    if (values >= 0.0).all() and not accepts(values + below):
        return 0.0
    return float(_last(values, shift, accepts, np.min))


def _most(cls: type[Force], field: str, values: Floats, accepts: Accepts) -> float:
    """Infinite where the field by itself takes large numbers."""
    if not values.size or not _refuses(cls, field, LARGE):
        return np.inf
    shift = 1.0 + 2.0 * float(np.abs(values).max()) - values.min()
    return np.inf if accepts(values + shift) else float(_last(values, shift, accepts, np.max))


def _last(values: Floats, shift: float, accepts: Accepts, end: Callable[[Floats], Any]) -> float:
    """The extreme value on the way to a shift at which values are refused, or one a little inside it."""
    good, bad = 0.0, 1.0
    for _ in range(HALVES):
        middle = 0.5 * (good + bad)
        good, bad = (middle, bad) if accepts(values + middle * shift) else (good, middle)
    first, last = float(end(values)), float(end(values + good * shift))
    limit = float(np.format_float_positional(last, precision=DIGITS, fractional=False))
    beyond = abs(limit - first) >= abs(last - first)
    return limit if beyond and accepts(values + (limit - first)) else last + INSIDE * (first - last)


@cache
def _refuses(cls: type[Force], field: str, number: float) -> bool:
    """Whether a field by itself takes the number 1, and not this one; the force as a whole may refuse more."""
    info = cls.model_fields[field]
    given: Any = Annotated[info.annotation, info]
    check: TypeAdapter[Any] = TypeAdapter(given)
    try:
        check.validate_python(1.0)
    except ValidationError:
        return False
    try:
        check.validate_python(number)
    except ValidationError:
        return True
    return False
