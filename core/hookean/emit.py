"""The object code of a function that numba has compiled, for `machine` to load. Imported only where numba is."""

from __future__ import annotations

import ctypes
import hashlib
import json
import sys
from typing import Any

import numba
from llvmlite import binding, ir
from numba.core import cgutils, types
from numba.core.compiler_lock import global_compiler_lock

from hookean.machine import Unfit, helpers, readable

WORD = ir.IntType(64)
DATA, SIZES = 2, 4  # words of numpy's array: where its numbers are, and its sizes; see `machine.readable`


@global_compiler_lock  # type: ignore[untyped-decorator]
def emit(dispatcher: Any, values: tuple[Any, ...]) -> bytes:
    """The content of a file for arguments like `values` (none: for what it was declared to take).

    Raises Unfit where the function takes or returns what a row of numbers does not hold, or calls what it cannot find
    in a process without numba.
    """
    if sys.platform == "win32" or not readable():
        raise Unfit
    made = _made(dispatcher, values)
    entry, result = _entry(made)
    whole = binding.parse_bitcode(made.library._get_module_for_linking().as_bitcode())
    whole.link_in(binding.parse_assembly(cgutils.normalize_ir_text(entry)))
    machine = made.library.codegen._tm
    _only_entry(whole, machine)
    process, helped = ctypes.CDLL(None), helpers()
    for one in (*whole.functions, *whole.global_variables):
        known = not one.is_declaration or one.name.startswith("llvm.") or one.name in helped
        if not known and not hasattr(process, one.name):
            raise Unfit(one.name)
    code = machine.emit_object(whole)
    told = {"digest": hashlib.sha256(code).hexdigest(), "result": result}
    return json.dumps(told).encode() + b"\n" + bytes(code)


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


def _entry(made: Any) -> tuple[str, str]:
    """The function that takes a row of numbers, as LLVM's text, and a letter for each number it returns."""
    context, signature = made.target_context, made.signature
    module = context.codegen()._create_empty_module("hookean_entry")
    entry = ir.Function(module, ir.FunctionType(ir.IntType(32), [WORD.as_pointer()]), "hookean_entry")
    row = _Row(context, ir.IRBuilder(entry.append_basic_block()), entry.args[0])
    arguments = [row.read(kind) for kind in signature.args]
    function = context.declare_function(module, made.fndesc)
    native = ir.GlobalVariable(module, function.type, "hookean_native")
    native.global_constant, native.initializer = True, function
    call = context.call_conv.call_function
    status, value = call(row.builder, function, signature.return_type, signature.args, arguments)
    result = row.write(signature.return_type, value)
    row.builder.ret(row.builder.zext(row.builder.not_(status.is_ok), ir.IntType(32)))
    return str(module), result


class _Row:
    """The row of numbers, read and written word by word."""

    def __init__(self, context: Any, builder: Any, start: Any) -> None:
        self.context, self.builder, self.start, self.at = context, builder, start, 0

    def word(self) -> Any:
        """Where the next word is."""
        self.at += 1
        return self.builder.gep(self.start, [WORD(self.at - 1)])

    def read(self, kind: Any) -> Any:
        """A value of numba's."""
        if isinstance(kind, types.BaseTuple):  # type: ignore[attr-defined]
            return self.context.make_tuple(self.builder, kind, [self.read(k) for k in kind.types])
        value = self.builder.load(self.word())
        if isinstance(kind, types.Array) and kind.layout == "C":
            return self._array(kind, value)
        if kind == types.float64:
            return self.builder.bitcast(value, ir.DoubleType())
        if kind == types.boolean:
            return self.builder.trunc(value, self.context.get_value_type(kind))
        if kind == types.int64:
            return value
        raise Unfit(str(kind))

    def _array(self, kind: Any, address: Any) -> Any:
        """An array from the address of numpy's object."""
        build = self.builder
        words = build.inttoptr(address, WORD.as_pointer())
        data, sizes = (build.load(build.gep(words, [WORD(i)])) for i in (DATA, SIZES))
        sizes = build.inttoptr(sizes, WORD.as_pointer())
        shape = [build.load(build.gep(sizes, [WORD(i)])) for i in range(kind.ndim)]
        item = self.context.get_abi_sizeof(self.context.get_data_type(kind.dtype))
        strides, count = [WORD(item)], WORD(1)
        for size in reversed(shape[1:]):
            strides.insert(0, build.mul(strides[0], size))
        for size in shape:
            count = build.mul(count, size)
        made = self.context.make_array(kind)(self.context, build)
        made.meminfo, made.parent = (cgutils.get_null_value(p.type) for p in (made.meminfo, made.parent))
        made.nitems, made.itemsize = count, WORD(item)
        made.data = build.inttoptr(data, made.data.type)
        made.shape, made.strides = (cgutils.pack_array(build, v, ty=WORD) for v in (shape, strides))
        return made._getvalue()

    def write(self, kind: Any, value: Any) -> str:
        """Put what is returned behind what was read; a letter for each word."""
        if kind == types.none:
            return ""
        if isinstance(kind, types.BaseTuple):  # type: ignore[attr-defined]
            parts = [self.builder.extract_value(value, i) for i in range(len(kind))]
            return "".join(self.write(k, v) for k, v in zip(kind.types, parts, strict=True))
        if kind == types.float64:
            letter, value = "d", self.builder.bitcast(value, WORD)
        elif kind == types.boolean:
            letter, value = "b", self.builder.zext(value, WORD)
        elif kind == types.int64:
            letter = "q"
        else:
            raise Unfit(str(kind))
        self.builder.store(value, self.word())
        return letter
