"""Pointers: compiled kernels as values that loops call by address.

numba passes a compiled function to a loop too, but looks up its type and address anew at every call, which takes as
long as a thousand iterations of a small scene. A pointer looks them up once. Import this module only where numba is
needed anyway.
"""

from __future__ import annotations

from typing import Any

from numba.core import cgutils, types
from numba.experimental.function_type import FunctionModel
from numba.extending import NativeValue, register_model, typeof_impl, unbox


class PointerType(types.FunctionType):
    """The type of all pointers to kernels of one signature."""


class Pointer:
    """The addresses of one compiled kernel, for calls from C and from other compiled code."""

    def __init__(self, dispatcher: Any, kind: PointerType) -> None:
        made = dispatcher.get_compile_result(kind.signature)
        self.kind = kind
        self.kernel = dispatcher  # keeps the code alive
        self.c_addr = made.library.get_pointer_to_function(made.fndesc.llvm_cfunc_wrapper_name)
        self.jit_addr = made.library.get_pointer_to_function(made.fndesc.llvm_func_name)


register_model(PointerType)(FunctionModel)


@typeof_impl.register(Pointer)  # type: ignore[untyped-decorator]
def _kind(value: Pointer, _: Any) -> PointerType:
    return value.kind


@unbox(PointerType)  # type: ignore[untyped-decorator]
def _addresses(kind: Any, value: Any, c: Any) -> Any:
    made = cgutils.create_struct_proxy(kind)(c.context, c.builder)
    made.py_addr = c.builder.ptrtoint(value, c.context.get_value_type(types.voidptr))
    for name in ("c_addr", "jit_addr"):
        number = c.pyapi.object_getattr_string(value, name)
        setattr(made, name, c.pyapi.long_as_voidptr(number))
        c.pyapi.decref(number)
    return NativeValue(made._getvalue())
