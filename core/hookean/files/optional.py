"""Packages that come with an extra of hookean: imported when a file needs them."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from hookean.errors import InputError


def needed(package: str, extra: str, name: str) -> Any:
    """A package, or InputError with how to install it; `name` is that of the file that needs it."""
    try:
        return import_module(package)
    except ImportError:
        raise InputError(name, f"needs the package {package}; install it with pip install 'hookean[{extra}]'") from None
