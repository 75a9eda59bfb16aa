"""The object code of a function that numba has compiled, for `object_cache` to load. Imported only where numba is."""

from __future__ import annotations

import ctypes
import gc
import hashlib
import json
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import numba
from llvmlite import binding, ir
from numba.core import cgutils, types
from numba.core.compiler_lock import global_compiler_lock

from hookean.compiled.abi import DIFFERS, Kind, Unstorable, helpers, letters, readable

WORD = ir.IntType(64)
TYPE, DATA, DIMENSIONS, SIZES, LETTER, FLAGS = 1, 2, 3, 4, 7, 8  # words of numpy's array; see `abi.readable`
GOOD = 0x501  # in C order, aligned, may be written


@global_compiler_lock  # type: ignore[untyped-decorator]
def emit(part: Callable[[], Any], kind: Kind, values: tuple[Any, ...]) -> bytes:
    """The content of a file for arguments of a kind, such as `values` (none: what it was declared to take).

    `part` makes numba's dispatcher.

    Raises Unstorable where the function takes or returns what a row of numbers does not hold, or calls what it cannot
    find in a process without numba.
    """
    if sys.platform == "win32" or not readable():
        raise Unstorable("this system has no object cache")
    with _uncollected():
        made = _made(part(), values)
    entry, result = _entry(made, kind)
    whole = binding.parse_bitcode(made.library._get_module_for_linking().as_bitcode())
    whole.link_in(binding.parse_assembly(cgutils.normalize_ir_text(entry)))
    machine = made.library.codegen._tm
    _only_entry(whole, machine)
    process, helped = ctypes.CDLL(None), helpers()
    for one in (*whole.functions, *whole.global_variables):
        known = not one.is_declaration or one.name.startswith("llvm.") or one.name in helped
        if not known and not hasattr(process, one.name):
            raise Unstorable(f"it calls {one.name}")
    code = machine.emit_object(whole)
    told = {"digest": hashlib.sha256(code).hexdigest(), "result": result}
    return json.dumps(told).encode() + b"\n" + bytes(code)


@contextmanager
def _uncollected() -> Iterator[None]:
    """Collect what numba drops afterwards: looking through all that it holds takes a tenth of the time."""
    if not gc.isenabled():
        yield
        return
    gc.disable()
    try:
        yield
    finally:
        gc.enable()


def _made(dispatcher: Any, values: tuple[Any, ...]) -> Any:
    """What numba made of a function for these values."""
    if values:
        kinds = tuple(numba.typeof(value) for value in values)
        dispatcher.compile(kinds)
        return dispatcher.overloads[kinds]
    (made,) = dispatcher.overloads.values()
    return made


def _only_entry(whole: Any, machine: Any) -> None:
    """Drop what the entry does not need, such as the ways in for Python."""
    for one in (*whole.functions, *whole.global_variables):
        if not one.is_declaration and one.name not in ("hookean_entry", "hookean_native"):
            one.linkage = "internal"
    passes = binding.create_new_module_pass_manager()
    passes.add_global_dead_code_eliminate_pass()
    passes.run(whole, binding.create_pass_builder(machine, binding.create_pipeline_tuning_options()))


def _entry(made: Any, kind: Kind) -> tuple[str, str]:
    """The function that takes a row of numbers, as LLVM's text, and what it returns, as `struct` has it."""
    context, signature = made.target_context, made.signature
    module = context.codegen()._create_empty_module("hookean_entry")
    entry = ir.Function(module, ir.FunctionType(ir.IntType(32), [WORD.as_pointer()]), "hookean_entry")
    row = _Row(context, ir.IRBuilder(entry.append_basic_block()), entry.args[0], kind)
    row.check()
    arguments = [row.read(one) for one in signature.args]
    function = context.declare_function(module, made.fndesc)
    native = ir.GlobalVariable(module, function.type, "hookean_native")
    native.global_constant, native.initializer = True, function
    call = context.call_conv.call_function
    status, value = call(row.builder, function, signature.return_type, signature.args, arguments)
    result = row.write(signature.return_type, value)
    row.builder.ret(row.builder.zext(row.builder.not_(status.is_ok), ir.IntType(32)))
    return str(module), result


class _Row:
    """The row of numbers, read and written word by word; see `object_cache.Entry`."""

    def __init__(self, context: Any, builder: Any, start: Any, kind: Kind) -> None:
        self.context, self.builder, self.start, self.kind = context, builder, start, kind
        self.letters = letters(kind)
        self.at = 1 + len(self.letters)

    def word(self, at: int | None = None) -> Any:
        """Where the next word is, or the one at a place."""
        if at is None:
            at, self.at = self.at, self.at + 1
        return self.builder.gep(self.start, [WORD(at)])

    def check(self) -> None:
        """Return `DIFFERS` unless every array is one of numpy's, of its type and dimensions."""
        build, first = self.builder, self.at
        places = [(build.load(self.word(first + i)), k) for i, k in enumerate(self.kind) if isinstance(k, tuple)]
        expected = build.load(self.word(0))
        self._only_if([build.icmp_signed("==", self._field(a, TYPE), expected) for a, _ in places])
        tests = []
        for array, (letter, dimensions) in places:
            own = build.load(self.word(1 + self.letters.index(letter)))
            flags = build.and_(self._field(array, FLAGS), WORD(GOOD))
            count = build.and_(self._field(array, DIMENSIONS), WORD(0xFFFFFFFF))
            tests += [
                build.icmp_signed("==", self._field(array, LETTER), own),
                build.icmp_signed("==", flags, WORD(GOOD)),
                build.icmp_signed("==", count, WORD(dimensions)),
            ]
        self._only_if(tests)

    def _only_if(self, tests: list[Any]) -> None:
        good = ir.IntType(1)(1)
        for test in tests:
            good = self.builder.and_(good, test)
        with self.builder.if_then(self.builder.not_(good)):
            self.builder.ret(ir.IntType(32)(DIFFERS))

    def _field(self, address: Any, at: int) -> Any:
        words = self.builder.inttoptr(address, WORD.as_pointer())
        return self.builder.load(self.builder.gep(words, [WORD(at)]))

    def read(self, kind: Any) -> Any:
        """A value of numba's."""
        value = self.builder.load(self.word())
        if isinstance(kind, types.Array) and kind.layout == "C":
            return self._array(kind, value)
        if kind == types.float64:
            return self.builder.bitcast(value, ir.DoubleType())
        if kind == types.boolean:
            return self.builder.trunc(value, self.context.get_value_type(kind))
        if kind == types.int64:
            return value
        raise Unstorable(f"it takes or returns {kind}")

    def _array(self, kind: Any, address: Any) -> Any:
        """An array from the address of numpy's object."""
        build = self.builder
        sizes = self._field(address, SIZES)
        shape = [self._field(sizes, i) for i in range(kind.ndim)]
        item = self.context.get_abi_sizeof(self.context.get_data_type(kind.dtype))
        strides, count = [WORD(item)], WORD(1)
        for size in reversed(shape[1:]):
            strides.insert(0, build.mul(strides[0], size))
        for size in shape:
            count = build.mul(count, size)
        made = self.context.make_array(kind)(self.context, build)
        made.meminfo, made.parent = (cgutils.get_null_value(p.type) for p in (made.meminfo, made.parent))
        made.nitems, made.itemsize = count, WORD(item)
        made.data = build.inttoptr(self._field(address, DATA), made.data.type)
        made.shape, made.strides = (cgutils.pack_array(build, v, ty=WORD) for v in (shape, strides))
        return made._getvalue()

    def write(self, kind: Any, value: Any) -> str:
        """Put what is returned behind what was read; what each word is, as `struct` has it."""
        if kind == types.none:
            return ""
        if isinstance(kind, types.BaseTuple):  # type: ignore[attr-defined]
            parts = [self.builder.extract_value(value, i) for i in range(len(kind))]
            return "".join(self.write(k, v) for k, v in zip(kind.types, parts, strict=True))
        if kind == types.float64:
            letter, value = "d", self.builder.bitcast(value, WORD)
        elif kind == types.boolean:
            letter, value = "?7x", self.builder.zext(value, WORD)
        elif kind == types.int64:
            letter = "q"
        else:
            raise Unstorable(f"it takes or returns {kind}")
        self.builder.store(value, self.word())
        return letter
