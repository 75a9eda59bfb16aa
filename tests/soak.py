"""Whether this is `make soak`: tests marked `soak` run, and counts are in full."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import Any

import pytest

SOAK = os.environ.get("HOOKEAN_SOAK") == "1"


def sampled(values: Iterable[Any], every: int) -> list[Any]:
    """Values of a parametrized test: the first of each `every` in all runs, the others in `make soak` only."""
    return [pytest.param(v, marks=[pytest.mark.soak] if i % every else []) for i, v in enumerate(values)]
