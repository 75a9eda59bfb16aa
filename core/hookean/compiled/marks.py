"""Marks on functions that numba compiles."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

F = TypeVar("F", bound=Callable[..., Any])


def device(function: F) -> F:
    """Mark a function that kernels may call; it is compiled with them."""
    function.__device__ = True  # type: ignore[attr-defined]
    return function
