"""Pointers: compiled kernels as addresses in a table, that loops call row by row.

A loop that takes tables is compiled once for any number of kernels, and counts no references: numba hands functions and
arrays to a loop one by one, and looks up their types again at every call, which takes as long as a thousand iterations
of a small scene. Import this module only where numba is needed anyway.
"""

from __future__ import annotations

from functools import cache
from typing import Any

from numba import carray, njit, types
from numba.extending import intrinsic

from hookean.compiled.marks import device


def address(dispatcher: Any, signature: Any) -> int:
    """Where the machine code of a compiled function starts; it lives as long as the process."""
    made = dispatcher.get_compile_result(signature)
    return int(made.library.get_pointer_to_function(made.fndesc.llvm_func_name))


@intrinsic
def real(typing, where):  # type: ignore[no-untyped-def]
    """The address of numbers, as a pointer to them."""

    def generate(context, builder, signature, arguments):  # type: ignore[no-untyped-def]
        return builder.inttoptr(arguments[0], context.get_value_type(signature.return_type))

    return types.CPointer(types.float64)(types.int64), generate


@intrinsic
def whole(typing, where):  # type: ignore[no-untyped-def]
    """The address of whole numbers, as a pointer to them."""

    def generate(context, builder, signature, arguments):  # type: ignore[no-untyped-def]
        return builder.inttoptr(arguments[0], context.get_value_type(signature.return_type))

    return types.CPointer(types.int64)(types.int64), generate


def caller(signature: Any) -> Any:
    """An intrinsic that calls the kernel of this signature at an address; what it returns is dropped."""

    def generate(context, builder, _, given):  # type: ignore[no-untyped-def]
        convention, (where, *arguments) = context.call_conv, given
        kind = convention.get_function_type(signature.return_type, signature.args)
        function = builder.inttoptr(where, kind.as_pointer())
        convention.call_function(builder, function, signature.return_type, signature.args, arguments)
        return context.get_dummy_value()

    typed = types.void(types.int64, *signature.args)
    # one argument after the other: a tuple would count references
    if len(signature.args) == 4:
        return intrinsic(lambda typing, where, a, b, c, d: (typed, generate))
    if len(signature.args) == 7:
        return intrinsic(lambda typing, where, a, b, c, d, e, f, g: (typed, generate))
    return intrinsic(lambda typing, where, a, b, c, d, e, f, g, h: (typed, generate))


@njit(error_model="numpy")
def numbers(rows, b, i):  # type: ignore[no-untyped-def]
    """The array whose address and shape stand in a table."""
    return carray(real(rows[b, i]), (rows[b, i + 1], rows[b, i + 2]))


@njit(error_model="numpy")
def integers(rows, b, i):  # type: ignore[no-untyped-def]
    """The same for whole numbers."""
    return carray(whole(rows[b, i]), (rows[b, i + 1], rows[b, i + 2]))


@njit(error_model="numpy")
@device
def kept(where, count, columns):  # type: ignore[no-untyped-def]
    """`dispatch.rows` as machine code."""
    return carray(real(types.int64(where)), (types.int64(count), columns))


@cache
def runner(role: str, signature: Any) -> Any:
    """The function that calls all kernels of a table of this role in turn, for loops to call."""
    call = caller(signature)

    def force(rows, x, v, f, w):  # type: ignore[no-untyped-def]
        for b in range(rows.shape[0]):
            call(rows[b, 0], x, v, integers(rows, b, 1), numbers(rows, b, 4), numbers(rows, b, 7), f, w)

    def remember(rows, x):  # type: ignore[no-untyped-def]
        for b in range(rows.shape[0]):
            call(rows[b, 0], x, integers(rows, b, 1), numbers(rows, b, 4), numbers(rows, b, 7))

    def impact(rows, x_before, v_before, acceleration, x, v, free, dt):  # type: ignore[no-untyped-def]
        for b in range(rows.shape[0]):
            call(rows[b, 0], x_before, v_before, acceleration, x, v, free, dt, numbers(rows, b, 1))

    def support(rows, x, v, f, carried, free, mass, dt):  # type: ignore[no-untyped-def]
        for b in range(rows.shape[0]):
            call(rows[b, 0], x, v, f, carried, free, mass, dt, numbers(rows, b, 1))

    made: Any = {"force": force, "remember": remember, "impact": impact, "support": support}[role]
    return njit(error_model="numpy")(device(made))
