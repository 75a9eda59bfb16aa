"""A plugin of pytest for the tests of a mutant: the tests are on the copy, and most compiled code stays what it was."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

from hypothesis import Phase, settings

import hookean
from hookean.compiled import dispatch

CACHE = Path(os.environ["HOOKEAN_CACHE"])
REACHED = os.environ["HOOKEAN_REACHED"].split()

assert Path(hookean.__file__).is_relative_to(CACHE.parent), hookean.__file__

# one failure is enough: nobody reads a smaller example of it
settings.register_profile("mutants", phases=[Phase.explicit, Phase.generate])
settings.load_profile("mutants")


def cache_folder(function: Callable[..., Any]) -> Path:
    """Where the code of a function is kept: apart where the mutation reaches its module, and then only for one run."""
    return CACHE / ("reached" if function.__module__ in REACHED else "kept")


dispatch.cache_folder = cache_folder  # type: ignore[assignment]
