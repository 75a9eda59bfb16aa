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
from collections.abc import Callable, Sequence
from functools import cache
from pathlib import Path
from typing import Any

from hookean.compiled.abi import Kind
from hookean.compiled.marks import device
from hookean.compiled.object_cache import Compiled

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


def rows(address: float, count: float, columns: int) -> Any:
    """The kept table at an address, inside a kernel: (count, columns), to be read only."""
    import ctypes

    import numpy as np

    start = ctypes.cast(int(address), ctypes.POINTER(ctypes.c_double))
    return np.ctypeslib.as_array(start, (int(count), columns))


@cache
def compiled(function: Callable[..., Any], role: str | None = None) -> Compiled:
    """Machine code of `function`, from the cache on disk when its source is unchanged.

    `role` names the signature, one of `_ROLES`; without one the types of each call decide (the solvers' loops). Sums
    keep their written order: no fast-math.
    """
    kind = None if role is None else _kind(role)
    name = f"{function.__module__.rpartition('.')[2]}.{function.__qualname__}"
    return Compiled(
        name, cache_folder(function), lambda: dispatcher(function, role), kind, lambda: part(function, role, True)
    )


@cache
def dispatcher(function: Callable[..., Any], role: str | None = None) -> Any:
    """What numba makes of `function`, to run it where its code cannot be on disk."""
    import numba

    if function in _NATIVE:
        return _native(function)
    prepared = _with_devices(function, dispatcher)
    _prepare(cache_folder(function))
    options: dict[str, Any] = {"cache": True, "nogil": True, "error_model": "numpy"}
    if role is None:
        return _without_literals(numba.njit(**options)(prepared))
    return numba.njit(_signature(role), **options)(prepared)


@cache
def part(function: Callable[..., Any], role: str | None = None, whole: bool = False) -> Any:
    """The same for other machine code to contain; `whole`: for the disk."""
    from hookean.compiled.linking import linked

    if function in _NATIVE:
        return _native(function)
    prepared = _with_devices(function, part)
    _prepare(cache_folder(function) / "parts")  # what numba runs has files of the same names
    made = _without_literals(linked(prepared, whole))
    if role is not None:
        made.compile(_signature(role))
    return made


def _native(function: Callable[..., Any]) -> Any:
    from hookean.compiled import call_table as pointers

    task = _RUNNERS.get(function)
    return pointers.runner(task, _signature(task)) if task else pointers.kept


def _prepare(folder: Path) -> None:
    """numba's settings for a function whose files are in a folder."""
    import numba

    numba.config.CACHE_DIR = str(folder)
    numba.config.SLP_VECTORIZE = 1  # the columns of a particle in one operation; no sum changes its order


def same(a: Any, b: Any) -> bool:
    """Whether two arrays of one shape hold the same numbers."""
    return not a.size or bool(compiled(_same_numbers)(a.reshape(-1), b.reshape(-1)))


def _same_numbers(a, b):  # type: ignore[no-untyped-def]
    differ = 0
    for i in range(a.size):
        differ |= a[i] != b[i]
    return differ == 0


def table(role: str, calls: Sequence[tuple[Callable[..., Any], tuple[Any, ...]]]) -> Any:
    """What a loop needs to call kernels of one role on their own arrays: in each row the address of a kernel, and of
    each of its arrays with their shape. The arrays must outlive it."""
    import numpy as np

    rows = [[_address(f, role), *(n for a in arrays for n in (a.ctypes.data, *a.shape))] for f, arrays in calls]
    return np.array(rows, dtype=np.int64) if rows else np.zeros((0, 1), np.int64)


def forces(calls: Any, x: Any, v: Any, f: Any, w: Any) -> None:
    """All force kernels of a table, inside a loop."""


def notes(calls: Any, x: Any) -> None:
    """All notes of what is remembered, inside a loop."""


def impacts(calls: Any, x_before: Any, v_before: Any, acceleration: Any, x: Any, v: Any, free: Any, dt: Any) -> None:
    """All impacts of a table, inside a loop."""


def supports(calls: Any, x: Any, v: Any, f: Any, carried: Any, free: Any, mass: Any, dt: Any) -> None:
    """All supports of a table, inside a loop."""


_RUNNERS = {forces: "force", notes: "remember", impacts: "impact", supports: "support"}
_NATIVE: tuple[Any, ...] = (rows, *_RUNNERS)
for _function in _NATIVE:
    device(_function)


@cache
def _address(function: Callable[..., Any], role: str) -> int:
    if (entry := compiled(function, role).entry(_kind(role))) is not None:
        return entry.address
    from hookean.compiled.call_table import address

    return address(dispatcher(function, role), _signature(role))


@cache
def cache_folder(function: Callable[..., Any]) -> Path:
    """Folder of compiled code: the user's cache, then a digest of every source and constant that it can depend on."""
    digest = hashlib.sha256()
    functions, constants = reached(function)
    sources = {_source(one) for one in functions} | set(Path(__file__).parent.glob("*.py"))
    for content in sorted(_digest(source) for source in sources):
        digest.update(content)
    digest.update("\n".join(sorted(constants)).encode())
    return _writable_root() / digest.hexdigest()[:16]


def reached(function: Any) -> tuple[set[Any], set[str]]:
    """All that machine code of a function can contain: functions and classes of the core that it names, and those that
    these name, and the numbers that they take from modules, which are part of the code as well."""
    found: set[Any] = set()
    constants: set[str] = set()
    left = [function]
    while left:
        one = left.pop()
        if one in found:
            continue
        found.add(one)
        for name, value in _named(one):
            value = inspect.unwrap(value) if callable(value) else value
            if isinstance(value, types.FunctionType | type):
                if value.__module__.partition(".")[0] == "hookean":
                    left.append(value)
            elif not isinstance(value, types.ModuleType):
                constants.add(f"{name} {value.tolist() if hasattr(value, 'tolist') else value!r}")
    return found, constants


def _named(function: Any) -> list[tuple[str, Any]]:
    """What the code of a function names: in its module, in modules that are there, and in functions around it."""
    code = getattr(function, "__code__", None)
    if code is None:  # a class: its file counts
        return []
    inner, names = [code], set()
    while inner:
        part = inner.pop()
        names.update(part.co_names)
        inner += [one for one in part.co_consts if isinstance(one, types.CodeType)]
    given = [(name, function.__globals__[name]) for name in names if name in function.__globals__]
    for _, module in tuple(given):
        if isinstance(module, types.ModuleType) and module.__name__.partition(".")[0] == "hookean":
            given += [(name, vars(module)[name]) for name in names if name in vars(module)]
    cells = zip(code.co_freevars, function.__closure__ or (), strict=False)
    return [*given, *((name, cell.cell_contents) for name, cell in cells)]


@cache
def _source(function: Any) -> Path:
    return Path(inspect.getfile(function))


@cache
def _digest(source: Path) -> bytes:
    return hashlib.sha256(source.read_bytes()).digest()


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


def _with_devices(function: Callable[..., Any], compiled_as: Callable[..., Any]) -> Callable[..., Any]:
    """The same function with the `@device` functions it names replaced by their compiled selves."""
    module = vars(sys.modules[function.__module__])
    used = {
        name: compiled_as(module[name])
        for name in function.__code__.co_names
        if getattr(module.get(name), "__device__", False)
    }
    if not used:
        return function
    twin = types.FunctionType(function.__code__, {**module, **used}, function.__name__)
    twin.__module__, twin.__qualname__ = function.__module__, function.__qualname__
    twin.__dict__.update(vars(function))
    return twin


def _without_literals(made: Any) -> Any:
    """The same, compiled once for all numbers of a type: numba compiles it for the constants of each call, too."""
    from numba.core.types.misc import unliteral

    found = getattr(made, "get_call_template", None)
    if found is None:  # a private part; without it functions are compiled more often
        return made
    made.get_call_template = lambda args, kws: found(
        [unliteral(one) for one in args], {name: unliteral(one) for name, one in dict(kws).items()}
    )
    return made


def _signature(role: str) -> Any:
    from numba import types as t

    result, words = _ROLES[role]
    known = {"real": t.float64, "none": t.void, **{f"x{n}": t.Array(t.float64, n, "C") for n in (1, 2, 3)}}
    known["i2"] = t.Array(t.int64, 2, "C")
    return known[result](*(known[word] for word in words.split()))


def _kind(role: str) -> Kind:
    """The same for code from the disk."""
    import numpy as np

    real, whole = np.dtype(np.float64).char, np.dtype(np.int64).char
    known: dict[str, Any] = {"real": float, "i2": (whole, 2), **{f"x{n}": (real, n) for n in (1, 2, 3)}}
    return tuple(known[word] for word in _ROLES[role][1].split())


_ROLES = {  # what a kernel returns and takes: arrays of numbers x and of whole numbers i, with their dimensions
    # x, v, indices, parameters, memory, f, w -> energy
    "force": ("real", "x2 x2 i2 x2 x2 x2 x1"),
    # x, indices, parameters, memory, blocks
    "hessian": ("none", "x2 i2 x2 x2 x3"),
    # x, indices, parameters, memory, stiffness
    "central": ("none", "x2 i2 x2 x2 x2"),
    # x, indices, parameters, memory
    "remember": ("none", "x2 i2 x2 x2"),
    # x_before, v_before, acceleration, x, v, free, dt, parameters
    "impact": ("none", "x2 x2 x2 x2 x2 x2 real x2"),
    # x, v, f, carried, free, mass, dt, parameters
    "support": ("none", "x2 x2 x2 x2 x2 x1 real x2"),
}
