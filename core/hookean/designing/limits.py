"""Limits of values: by how much they are missed, and what counts as met."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

FAR = 1e3  # of its size: an unknown there that is no minimum has no end
LIMIT = 1e-6  # part of the size of values by which a constraint may be missed
AT_BOUND = 1e-9  # of an unknown's scale


def beyond(values: Floats, lower: Floats, upper: Floats) -> Floats:
    """By how much values miss their limits; 0 where they do not."""
    return np.maximum(np.maximum(lower - values, values - upper), 0.0)


def size(values: Floats, lower: Floats, upper: Floats, natural: float) -> float:
    """What values are measured by: the largest of them, of their limits, and what is natural in the model."""
    limits = [np.where(np.isfinite(limit), np.abs(limit), 0.0) for limit in (lower, upper)]
    return float(np.max([np.abs(values), *limits], initial=natural)) or 1.0
