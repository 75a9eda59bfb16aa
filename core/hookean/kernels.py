"""How kernels are compiled: on first use, into a cache on disk that an edit can never leave stale.

A kernel is a plain module-level function, marked by where it is used (`Force.kernel`, a contact's hooks) and
compiled here with a fixed signature. All kernels of one role share that signature, so the solvers' loops call
them through function pointers: a loop is compiled once and works for every force, present and future.
Small functions that several kernels share are marked with `@device`.
"""

from __future__ import annotations

import hashlib
import inspect
import os
import sys
import tempfile
import types
import warnings
from collections.abc import Callable, Sequence
from functools import cache
from pathlib import Path
from typing import Any, TypeVar

F = TypeVar("F", bound=Callable[..., Any])


def device(function: F) -> F:
    """Mark a function that kernels may call; it is compiled with them."""
    function.__device__ = True  # type: ignore[attr-defined]
    return function


_TABLES: dict[bytes, Any] = {}


def keep(table: Any) -> float:
    """Keep a table (rows, columns) for the kernels of this process; returns the address for `rows`, a whole number.

    For what all elements of a force share and is too large to repeat in each one's parameters, such as the triangles
    of a target. Equal tables are kept once. The address goes into a column of parameters, and never into a file.
    """
    import numpy as np

    table = np.array(table, dtype=np.float64, order="C")
    key = hashlib.sha256(repr(table.shape).encode() + table.tobytes()).digest()
    return float(_TABLES.setdefault(key, table).ctypes.data)


@device
def rows(address: float, count: float, columns: int) -> Any:
    """The kept table at an address, inside a kernel: (count, columns), to be read only."""
    import ctypes

    import numpy as np

    start = ctypes.cast(int(address), ctypes.POINTER(ctypes.c_double))
    return np.ctypeslib.as_array(start, (int(count), columns))


@cache
def _native_rows() -> Any:
    """`rows` as machine code."""
    import numba
    from numba.extending import intrinsic

    @intrinsic
    def pointer(typing, address):  # type: ignore[no-untyped-def]
        def generate(context, builder, signature, arguments):  # type: ignore[no-untyped-def]
            return builder.inttoptr(arguments[0], context.get_value_type(signature.return_type))

        return numba.types.CPointer(numba.types.float64)(numba.types.int64), generate

    @numba.njit
    @device
    def native(address, count, columns):  # type: ignore[no-untyped-def]
        return numba.carray(pointer(numba.int64(address)), (numba.int64(count), columns))

    return native


@cache
def compiled(function: Callable[..., Any], role: str | None = None) -> Any:
    """Machine code of `function`, from the cache on disk when its source is unchanged.

    `role` names the signature (`force`, `impact`, `support`, `remember`, `hessian`); without one the types of
    the first call decide (the solvers' loops). Sums keep their written order: no fast-math.
    """
    import numba

    if function is rows:
        return _native_rows()
    prepared = _with_devices(function)
    numba.config.CACHE_DIR = str(cache_folder(function))
    options: dict[str, Any] = {"cache": True, "nogil": True, "error_model": "numpy"}
    if role is None:
        return numba.njit(**options)(prepared)
    return numba.njit(_signature(role), **options)(prepared)


def call(loop: Any, *arguments: Any) -> Any:
    """Call a compiled loop that takes tuples of kernels."""
    from numba.core.errors import NumbaExperimentalFeatureWarning

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", NumbaExperimentalFeatureWarning)
        return loop(*arguments)


def pointers(functions: Sequence[Callable[..., Any] | None], role: str) -> tuple[Any, ...]:
    """Pointers to functions of one role (none: idle), padded to 2, 4, 8 ... so that loops meet few tuple sizes."""
    idle = _pointer(_IDLE[role], role)
    filled = [idle if f is None else _pointer(f, role) for f in functions]
    size = 2
    while size < len(filled):
        size *= 2
    return (*filled, *[idle] * (size - len(filled)))


@cache
def _pointer(function: Callable[..., Any], role: str) -> Any:
    from hookean.pointers import Pointer

    return Pointer(compiled(function, role), _pointer_type(role))


@cache
def _pointer_type(role: str) -> Any:
    from hookean.pointers import PointerType

    return PointerType(_signature(role))


@cache
def cache_folder(function: Callable[..., Any]) -> Path:
    """Folder of compiled code: the user's cache, then a digest of every source a kernel may inline."""
    digest = hashlib.sha256()
    home = Path(__file__).parent
    sources = {Path(__file__), home / "pointers.py", Path(inspect.getfile(function))}
    sources.update(home.glob("forces/*.py"), home.glob("solvers/*.py"))
    for source in sorted(sources):
        digest.update(source.read_bytes())
    return _writable_root() / digest.hexdigest()[:16]


@cache
def _writable_root() -> Path:
    import platformdirs

    root = Path(os.environ.get("HOOKEAN_CACHE") or platformdirs.user_cache_dir("hookean", appauthor=False))
    try:
        root.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile(dir=root):
            return root
    except OSError:
        return Path(tempfile.mkdtemp(prefix="hookean-"))


def _with_devices(function: Callable[..., Any]) -> Callable[..., Any]:
    """The same function with the `@device` functions it names replaced by their compiled selves."""
    module = vars(sys.modules[function.__module__])
    used = {
        name: compiled(module[name])
        for name in function.__code__.co_names
        if getattr(module.get(name), "__device__", False)
    }
    if not used:
        return function
    twin = types.FunctionType(function.__code__, {**module, **used}, function.__name__)
    twin.__module__, twin.__qualname__ = function.__module__, function.__qualname__
    twin.__dict__.update(vars(function))
    return twin


def _signature(role: str) -> Any:
    from numba import types as t

    flat = t.Array(t.float64, 1, "C")
    real = t.Array(t.float64, 2, "C")
    whole = t.Array(t.int64, 2, "C")
    cube = t.Array(t.float64, 3, "C")
    return {
        # x, v, indices, parameters, memory, f, w -> energy
        "force": t.float64(real, real, whole, real, real, real, flat),
        # x, indices, parameters, memory, blocks
        "hessian": t.void(real, whole, real, real, cube),
        # x, indices, parameters, memory
        "remember": t.void(real, whole, real, real),
        # x_before, v_before, acceleration, x, v, free, dt, parameters
        "impact": t.void(real, real, real, real, real, real, t.float64, real),
        # x, v, f, carried, free, mass, dt, parameters
        "support": t.void(real, real, real, real, real, flat, t.float64, real),
    }[role]


def _no_force(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    return 0.0


def _no_impact(x_before, v_before, acceleration, x, v, free, dt, parameters):  # type: ignore[no-untyped-def]
    pass


def _no_support(x, v, f, carried, free, mass, dt, parameters):  # type: ignore[no-untyped-def]
    pass


def _no_memory(x, indices, parameters, memory):  # type: ignore[no-untyped-def]
    pass


_IDLE: dict[str, Callable[..., Any]] = {
    "force": _no_force,
    "impact": _no_impact,
    "support": _no_support,
    "remember": _no_memory,
}
