"""Which number of a column each element reads, of columns that a force takes as a whole: one for each face, vertex or
point, and not for each element. Found by what changes as some numbers do: number by number that takes a compilation
each, by the digits of their numbers a few for all.

The code of a number is half of n digits that are set. An element that reads one number changes with its digits alone,
one that reads several with more than half. Source: constant-weight codes as in group testing, Kautz and Singleton,
"Nonrandom binary superimposed codes", 1964.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import combinations, islice
from math import comb

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


def readers(count: int, changed: Callable[[NDArray[np.bool_]], NDArray[np.bool_]]) -> Ints | None:
    """The number, of `count`, that each element reads, -1 for none; None where an element reads several.

    `changed` gives the elements (m,) that change as some of the numbers (count,) do."""
    codes = balanced(count)
    seen = np.column_stack([changed(digit) for digit in codes.T])
    weight = codes.shape[1] // 2
    own = seen.sum(axis=1)
    if not np.isin(own, (0, weight)).all():
        return None
    order = {code.tobytes(): number for number, code in enumerate(codes)}
    found = np.array([order.get(row.tobytes(), -1) for row in seen], dtype=np.int64)
    return None if ((found < 0) & (own > 0)).any() else found


def balanced(count: int) -> NDArray[np.bool_]:
    """Codes (count, n) of an even number n of digits, half of them set, each once."""
    digits = 2
    while comb(digits, digits // 2) < count:
        digits += 2
    found = np.zeros((count, digits), dtype=bool)
    chosen = np.array(list(islice(combinations(range(digits), digits // 2), count)))
    found[np.arange(count)[:, None], chosen] = True
    return found
