"""Functions for other machine code to contain: numba types and lowers them, and makes no code of them that runs.

numba gives every function that it compiles two ways in for Python and C, optimises it with all that it calls, and makes
machine code of it, though a device is only ever a part of its callers, and the code of a kernel comes from its file.
Here LLVM optimises each function by itself, and a kernel once with all of its devices. Import this module only where
numba is needed anyway.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from llvmlite import binding
from numba import njit
from numba.core import caching, codegen, compiler


def linked(function: Callable[..., Any], whole: bool = False) -> Any:
    """numba's dispatcher of a function that is never run; `whole`: no other function contains it."""
    made = njit(
        nogil=True, error_model="numpy", no_cpython_wrapper=True, no_cfunc_wrapper=True,
        pipeline_class=_WholeCompiler if whole else _PartCompiler,
    )(function)  # fmt: skip
    if not whole:
        made._cache = _Cache(function)
    return made


class _Part(codegen.JITCodeLibrary):  # type: ignore[misc]
    """LLVM's code of a function and of what it calls, without machine code."""

    def __init__(self, own: Any, name: str) -> None:
        super().__init__(own, name)
        self._codegen = _NoCode(own)

    def _optimize_final_module(self) -> None:
        """Left to the kernel."""

    def _finalize_final_module(self) -> None:
        self._finalize_dynamic_globals()
        self._verify_declare_only_symbols()
        self._finalized = True

    def get_pointer_to_function(self, name: str) -> int:
        """None: there is no machine code."""
        self._ensure_finalized()
        return 0

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


class _Whole(_Part):
    """The same of a kernel or a loop, optimised with all that it calls."""

    def _optimize_final_module(self) -> None:
        codegen.JITCodeLibrary._optimize_final_module(self)


class _NoCode:
    """numba's generator of code, for a library without any: there is no place for the objects of Python that code can
    refer to, which compiled code does not need."""

    def __init__(self, own: Any) -> None:
        self.own = own

    def __getattr__(self, name: str) -> Any:
        return getattr(self.own, name)

    def set_env(self, name: str, environment: Any) -> None:
        """Nowhere to put it."""


class _PartCompiler(compiler.Compiler):  # type: ignore[misc]
    library: type[_Part] = _Part

    def define_pipelines(self) -> Any:
        """numba's own, into a library of ours."""
        state = self.state
        state.library = self.library(state.targetctx.codegen(), state.func_id.func_qualname)
        state.library.enable_object_caching()
        return super().define_pipelines()


class _WholeCompiler(_PartCompiler):
    library = _Whole


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
