"""Functions for other machine code to contain: numba types and lowers them, and makes no code of them that runs.

numba gives every function that it compiles two ways in, for Python and C, and makes machine code of it and of them,
though a device is only ever a part of its callers, and the code of a kernel comes from its file. LLVM optimises each
device before it is linked, as numba has it: a kernel that is optimised only with all of its devices takes less time to
compile and runs up to 5 % slower. Import this module only where numba is needed anyway.
"""

from __future__ import annotations

import copy
import ctypes
from collections.abc import Callable
from typing import Any

from llvmlite import binding
from numba import njit
from numba.core import caching, codegen, compiler


def linked(function: Callable[..., Any], whole: bool = False) -> Any:
    """numba's dispatcher of a function that is never run; `whole`: no other function contains it."""
    options = {"nogil": True, "error_model": "numpy", "no_cpython_wrapper": True, "no_cfunc_wrapper": True}
    made = njit(pipeline_class=_Compiler, **options)(function)
    if not whole:
        made._cache = _Cache(function)
    return made


class _Part(codegen.JITCodeLibrary):  # type: ignore[misc]
    """LLVM's code of a function and of what it calls, without machine code."""

    def __init__(self, own: Any, name: str) -> None:
        super().__init__(_without_engine(own), name)

    def _finalize_final_module(self) -> None:
        self._finalize_dynamic_globals()
        self._verify_declare_only_symbols()
        self._finalized = True

    def serialize_using_object_code(self) -> Any:
        """What another process links."""
        return self.name, self._get_module_for_linking().as_bitcode()

    @classmethod
    def read(cls, own: Any, stored: Any) -> _Part:
        """The same, from the disk."""
        name, code = stored
        made = cls(own, name)
        made._final_module = binding.parse_bitcode(code)
        made._finalized = True
        return made


class _NoEngine:
    """What numba asks, of machine code, for a library that has none."""

    def __init__(self) -> None:
        self.nowhere = ctypes.c_void_p()

    def is_symbol_defined(self, name: str) -> bool:
        """Nothing is."""
        return False

    def get_global_value_address(self, name: str) -> int:
        """Where numba puts the objects of Python that code can refer to; ours refers to none."""
        return ctypes.addressof(self.nowhere)


def _without_engine(own: Any) -> Any:
    """numba's generator of code, that generates none."""
    made = copy.copy(own)
    if not hasattr(made, "_engine"):
        raise AttributeError("numba's generator of code has no attribute '_engine'")
    made._engine = _NoEngine()
    return made


class _Compiler(compiler.Compiler):  # type: ignore[misc]
    def define_pipelines(self) -> Any:
        """numba's own, into a library of ours."""
        state = self.state
        state.library = _Part(state.targetctx.codegen(), state.func_id.func_qualname)
        state.library.enable_object_caching()
        return super().define_pipelines()


class _Stored(caching.CompileResultCacheImpl):  # type: ignore[misc]
    """Results of numba's on disk, without machine code."""

    def rebuild(self, target_context: Any, payload: Any) -> Any:
        """From the disk."""
        found = compiler.CompileResult._rebuild(_Reading(target_context), *payload)
        return found._replace(target_context=target_context)


class _Reading:
    """numba's context, for reading a library of ours."""

    def __init__(self, own: Any) -> None:
        self.own = own

    def __getattr__(self, name: str) -> Any:
        return getattr(self.own, name)

    def codegen(self) -> _Reading:
        """What reads libraries."""
        return self

    def unserialize_library(self, stored: Any) -> _Part:
        """Ours."""
        return _Part.read(self.own.codegen(), stored)


class _Cache(caching.FunctionCache):  # type: ignore[misc]
    _impl_class = _Stored
