"""Machine code without its compiler: what numba compiled once, later processes load from disk without numba.

Importing numba and its tables takes longer than most solves. So the object code of a compiled function is put on disk,
with an entry that takes all arguments as one row of numbers; llvmlite alone loads and calls it. The file's name holds
a digest of all that the code depends on: every source it may inline (in the folder's name), numba, llvmlite, the
processor and its abilities, numba's settings, the types of the arguments. Where there is no such file, or a damaged
one, numba compiles; numba runs, too, what cannot be stored (see `object_code`). With HOOKEAN_OBJECT_CACHE=0 in the
environment, numba does everything. README.md in this folder has the whole picture.
"""

from __future__ import annotations

import ctypes
import hashlib
import importlib.util
import json
import logging
import os
import struct
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from functools import cache, partial
from pathlib import Path
from typing import Any

import numpy as np

from hookean.compiled import announcing
from hookean.compiled.abi import DIFFERS, Kind, Unstorable, helpers, letters, readable

log = logging.getLogger("hookean.compiled")


class Compiled:
    """A function as machine code. `dispatcher` makes numba's, to be run, and `part` what the disk keeps; `kind` is what
    it takes, None: whatever it is given."""

    def __init__(
        self, name: str, folder: Path, dispatcher: Callable[[], Any], kind: Kind | None, part: Callable[[], Any]
    ) -> None:
        self.name, self.folder, self.dispatcher, self.kind, self.part = name, folder, dispatcher, kind, part
        self.loaded = self.made = 0  # how many were found on disk, and how many were not
        self._entries: dict[Kind, Entry | None] = {}
        self._called: tuple[Callable[[tuple[Any, ...]], Any], ...] = ()

    def __call__(self, *values: Any) -> Any:
        for run in self._called:  # quicker than looking what values are
            if (found := run(values)) is not REFUSED:
                return found
        kind = kind_of(values)
        if kind is not None and (self.kind is None or kind == self.kind):
            new = self.entry(kind, values)
            if new is not None:
                if new.run not in self._called:
                    self._called = (*self._called, new.run)
                if (found := new.run(values)) is not REFUSED:
                    return found
        return self.dispatcher()(*values)

    def entry(self, kind: Kind, values: tuple[Any, ...] = ()) -> Entry | None:
        """The code for arguments of a kind, such as `values`; None where only numba can run it."""
        if kind not in self._entries:
            self._entries[kind] = self._find(kind, values) if switched_on() else None
        return self._entries[kind]

    def _find(self, kind: Kind, values: tuple[Any, ...]) -> Entry | None:
        """The code from disk, where it is put if it was not there."""
        try:
            path = self.folder / f"{self.name}-{hashlib.sha256(f'{kind} {surroundings()}'.encode()).hexdigest()[:24]}.o"
        except Exception as error:  # private parts of numba may have gone to other places
            _report("compiled code is not stored", error)
            return None
        found = _load(path, kind)
        if found is None:
            with announcing.WAITING.on(self.name), _alone(path):
                found = _load(path, kind)  # another process may have compiled it meanwhile
                if found is None:
                    self.made += 1
                    return self._make(path, kind, values)
        self.loaded += 1
        return found

    def _make(self, path: Path, kind: Kind, values: tuple[Any, ...]) -> Entry | None:
        """Compile the code and put it on disk."""
        try:
            from hookean.compiled.object_code import emit

            _store(path, emit(self.part, kind, values if self.kind is None else ()))
        except Unstorable as reason:
            log.debug("%s is left to numba: %s", self.name, reason)
            return None
        except Exception as error:  # private parts of numba and llvmlite may change in any way; numba still runs it
            _report(f"{self.name} was compiled but not stored", error)
            return None
        return _load(path, kind)


def kind_of(values: tuple[Any, ...]) -> Kind | None:
    """The kind of arguments; None where there is one that is for numba."""
    kinds: list[Any] = []
    for value in values:
        if type(value) is np.ndarray and value.flags.carray and value.dtype.isnative:
            kinds.append((value.dtype.char, value.ndim))
        elif (scalar := SCALARS.get(type(value))) is not None:
            kinds.append(scalar)
        else:
            return None
    return tuple(kinds)


ENGINES: list[Any] = []  # never freed: others keep addresses of their code
PATIENCE = 120.0  # seconds that a process waits for code that another one compiles
SCALARS: dict[type, type] = {float: float, np.float64: float, int: int, bool: bool}
REFUSED = object()


class Entry:
    """Code from a file, called with a row of numbers: where numpy's types are, the arguments (of arrays, where they
    are), and room for what it returns. The code itself looks whether arrays are what it takes."""

    def __init__(self, path: Path, kind: Kind) -> None:
        head, _, code = path.read_bytes().partition(b"\n")
        told = json.loads(head)
        if hashlib.sha256(code).hexdigest() != told["digest"]:
            raise ValueError("damaged")
        self.kind = kind
        self.numbers = [(place, one) for place, one in enumerate(kind) if not isinstance(one, tuple)]
        self.head = [id(np.ndarray), *(id(np.dtype(letter)) for letter in letters(kind))]
        self.end = len(self.head) + len(kind)
        self.returned = struct.Struct(f"={told['result']}")
        numbers = "".join("d" if one is float else "q" for one in kind)
        self.row = struct.Struct(f"={len(self.head)}q{numbers}{self.returned.size}x")
        binding = _llvm()
        target = binding.Target.from_default_triple().create_target_machine(codemodel="jitdefault", jit=True)
        self.engine = binding.create_mcjit_compiler(binding.parse_assembly(""), target)
        self.engine.add_object_file(binding.ObjectFileRef.from_data(code))
        self.engine.finalize_object()
        ENGINES.append(self.engine)
        where = self.engine.get_function_address("hookean_entry")
        native = self.engine.get_function_address("hookean_native")
        if not where or not native:
            raise ValueError("no entry")
        self.call = ctypes.CFUNCTYPE(ctypes.c_int32)(where)  # with types of arguments it would be slower to call
        self.address: int = ctypes.c_int64.from_address(native).value  # for numba's own way of calling
        self.run = self._caller()  # what the code returns for values; REFUSED where it does not take these

    def _caller(self) -> Callable[[tuple[Any, ...]], Any]:
        """The function behind `run`; what it needs is in its own variables, which is quicker to reach than ours."""
        numbers, end, size = self.numbers, 8 * self.end, len(self.kind)
        pack, call, returned = partial(self.row.pack, *self.head), self.call, self.returned.unpack_from
        count = len(self.returned.unpack(bytes(self.returned.size)))

        def run(values: tuple[Any, ...]) -> Any:
            if len(values) != size:
                return REFUSED
            words: Any = map(id, values)  # where arrays are: the code looks whether they are arrays
            if numbers:
                words = list(words)
                for place, kind in numbers:
                    value = words[place] = values[place]
                    if type(value) is not kind and SCALARS.get(type(value)) is not kind:
                        return REFUSED
            try:
                row = pack(*words)  # bytes of nobody else's: the code may write at their end
            except struct.error:  # an integer of more than 64 bits
                return REFUSED
            if ended := call(row):
                if ended == DIFFERS:
                    return REFUSED
                raise MemoryError("compiled code got no memory")
            if not count:
                return None
            found = returned(row, end)
            return found[0] if count == 1 else found

        return run


def _load(path: Path, kind: Kind) -> Entry | None:
    """The code in a file, or None if the file is missing or damaged."""
    if not path.exists() or not readable():
        return None
    try:
        return Entry(path, kind)
    except Exception as error:  # llvmlite raises errors of its own
        _report(f"{path.name} was not loaded and is compiled again", error)
        return None


_reported: set[str] = set()


def _report(what: str, error: Exception) -> None:
    """Log a failure, each once for a process."""
    said = f"{what}: {type(error).__name__}: {error}"
    if said not in _reported:
        _reported.add(said)
        log.warning("%s", said)


@cache
def switched_on() -> bool:
    """Whether code is kept as objects on disk; HOOKEAN_OBJECT_CACHE=0 turns it off."""
    return os.environ.get("HOOKEAN_OBJECT_CACHE", "1") != "0"


@contextmanager
def _alone(path: Path) -> Iterator[None]:
    """Let one process at a time compile the code of a file; others wait for it, but not for ever. Without file locks,
    as on Windows, where code is not kept as objects, and in a folder that cannot be written, none waits."""
    with ExitStack() as stack:
        try:
            import fcntl

            path.parent.mkdir(parents=True, exist_ok=True)
            file = stack.enter_context(path.with_suffix(".lock").open("w"))
        except (ImportError, OSError):
            yield
            return
        stack.callback(Path(file.name).unlink, missing_ok=True)
        until = time.monotonic() + PATIENCE
        while time.monotonic() < until and not path.exists():
            try:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
                stack.callback(fcntl.flock, file, fcntl.LOCK_UN)  # who was forked meanwhile has it open too
                break
            except BlockingIOError:
                time.sleep(0.02)
            except OSError:  # a file system without locks
                break
        yield


def _store(path: Path, data: bytes) -> None:
    """Put a file where other processes find it whole or not at all."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.NamedTemporaryFile(dir=path.parent, delete=False) as file:
        file.write(data)
    os.replace(file.name, path)


@cache
def surroundings() -> str:
    """Digest of what machine code depends on besides sources: compiler, processor, settings."""
    binding = _llvm()
    told = [binding.get_default_triple(), binding.get_host_cpu_name(), binding.get_host_cpu_features().flatten()]
    told += [f"{k}={v}" for k, v in sorted(os.environ.items()) if k.startswith("NUMBA_")]
    digest = hashlib.sha256("\n".join(told).encode())
    for package in ("numba", "llvmlite"):  # their versions, without importing numba
        found = importlib.util.find_spec(package)
        assert found is not None and found.origin is not None
        digest.update(Path(found.origin).with_name("_version.py").read_bytes())
    return digest.hexdigest()


@cache
def _llvm() -> Any:
    from llvmlite import binding

    binding.initialize_native_target()
    binding.initialize_native_asmprinter()
    for name, address in helpers().items():
        binding.add_symbol(name, address)
    return binding
