"""What compiled code and its callers agree on: the types of arguments, how numpy keeps arrays in memory, and the C
functions that numba's code calls."""

from __future__ import annotations

import ctypes
import importlib.util
import sys
from functools import cache
from importlib.machinery import EXTENSION_SUFFIXES, ExtensionFileLoader
from pathlib import Path
from typing import Any

import numpy as np

Kind = tuple[Any, ...]
"""Types of arguments: (numpy's letter of the type, dimensions) for an array, else `float`, `int` or `bool`."""

DIFFERS = 2  # what an entry returns where an array is not what it takes


class Unstorable(Exception):
    """For numba: arguments that a row of numbers does not hold, or code that needs more than a process has."""


def letters(kind: Kind) -> list[str]:
    """The types of arrays among arguments, in the order in which an entry takes them."""
    return sorted({one[0] for one in kind if isinstance(one, tuple)})


@cache
def readable() -> bool:
    """Whether arrays lie in memory as entries expect: numpy's object word by word, which no interface promises."""
    seen = np.zeros((3, 5))
    if ctypes.sizeof(ctypes.c_void_p) != 8:
        return False
    words = (ctypes.c_int64 * 9).from_address(id(seen))
    if (words[1], words[2], words[7]) != (id(np.ndarray), seen.ctypes.data, id(seen.dtype)):
        return False
    good = words[3] & 0xFFFFFFFF == 2 and words[8] & 0xFFFFFFFF == seen.flags.num
    return good and list((ctypes.c_int64 * 2).from_address(words[4])) == [3, 5]


@cache
def helpers() -> dict[str, int]:
    """Addresses of the C functions by which numba's code takes memory, reshapes arrays and fails, by their names."""
    memory, others = _extension("numba.core.runtime._nrt_python"), _extension("numba._helperlib")
    memory.memsys_use_cpython_allocator()  # as numba has it
    found = {name if name.startswith("_") else f"NRT_{name}": at for name, at in memory.c_helpers.items()}
    return {**found, **{f"numba_{name}": at for name, at in others.c_helpers.items()}}


def _extension(name: str) -> Any:
    """An extension module of numba's, without importing numba, which finds it loaded when it is."""
    if name in sys.modules:
        return sys.modules[name]
    home = importlib.util.find_spec("numba")
    assert home is not None and home.origin is not None
    *folders, last = name.split(".")[1:]
    place = Path(home.origin).parent.joinpath(*folders)
    path = next(p for suffix in EXTENSION_SUFFIXES if (p := place / f"{last}{suffix}").exists())
    spec = importlib.util.spec_from_file_location(name, path, loader=ExtensionFileLoader(name, str(path)))
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module
