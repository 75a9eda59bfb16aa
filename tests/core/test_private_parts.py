"""Parts of numba, llvmlite and numpy that are nobody's promise: where one has another name, numba runs the code.

The results are the same to the bit, the log has one line, and nothing fails. The README of core/hookean/compiled lists
the parts. One that the engine reads is hidden from the engine alone, since numba reads it as well. A method of numba's
that the engine replaces is taken away from the engine's class: numba would call its own, by its new name.
"""

from __future__ import annotations

import importlib
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hookean.compiled import announcing, dispatch
from hookean.compiled import object_cache as machine
from hookean.compiled.object_cache import Compiled, readable
from soak import sampled

pytestmark = pytest.mark.skipif(sys.platform == "win32" or not readable(), reason="numba compiles here")

READ = {
    "codegen._create_empty_module": ("numba.core.codegen", "JITCPUCodegen", "_create_empty_module"),
    "codegen._engine": ("numba.core.codegen", "JITCPUCodegen", "_engine"),
    "codegen._tm": ("numba.core.codegen", "JITCPUCodegen", "_tm"),
    "library._get_module_for_linking": ("numba.core.codegen", "CPUCodeLibrary", "_get_module_for_linking"),
    "library._finalize_dynamic_globals": ("numba.core.codegen", "CPUCodeLibrary", "_finalize_dynamic_globals"),
    "dispatcher.overloads": ("numba.core.dispatcher", "_DispatcherBase", "overloads"),
    "dispatcher.get_call_template": ("numba.core.dispatcher", "_DispatcherBase", "get_call_template"),
    "context.call_conv": ("numba.core.cpu", "CPUContext", "call_conv"),
    "CompileResult._rebuild": ("numba.core.compiler", "CompileResult", "_rebuild"),
}
REPLACED = {
    "library._finalize_final_module": ("hookean.compiled.linking", "_Part", "_finalize_final_module"),
    "library.serialize_using_object_code": ("hookean.compiled.linking", "_Part", "serialize_using_object_code"),
    "engine.is_symbol_defined": ("hookean.compiled.linking", "_NoEngine", "is_symbol_defined"),
    "engine.get_global_value_address": ("hookean.compiled.linking", "_NoEngine", "get_global_value_address"),
    "compiler.define_pipelines": ("hookean.compiled.linking", "_Compiler", "define_pipelines"),
    "cache._impl_class": ("hookean.compiled.linking", "_Cache", "_impl_class"),
    "cache.rebuild": ("hookean.compiled.linking", "_Stored", "rebuild"),
}
"""Of each the module, the class and the name there; importing numba takes half a second."""
HARMLESS = {"dispatcher.get_call_template", "compiler.define_pipelines"}
"""Without these, more is compiled than has to be, and stored all the same."""
READING = {"CompileResult._rebuild", "cache._impl_class", "cache.rebuild"}


def found(module: str, owner: str, name: str) -> tuple[type, str]:
    """The class in a module, and the name of its part."""
    return getattr(importlib.import_module(module), owner), name


def again(number):  # type: ignore[no-untyped-def]
    """A number half as large again."""
    return 1.5 * number


again = dispatch.device(again)


def grow(x, count):  # type: ignore[no-untyped-def]
    """Let numbers grow; returns their sum and how often they grew."""
    total = 0.0
    for i in range(x.shape[0]):
        for _ in range(count):
            x[i] = again(x[i]) + 1.0 / 3.0
        total += x[i]
    return total, count


class Hidden:
    """An attribute of a class, or of its objects, that the engine does not find."""

    def __init__(self, owner: type, name: str) -> None:
        self.name, self.inherited = name, next((vars(c)[name] for c in owner.__mro__ if name in vars(c)), None)

    def __get__(self, instance: Any, owner: type) -> Any:
        if str(sys._getframe(1).f_globals["__name__"]).startswith("hookean.compiled"):
            raise AttributeError(f"{owner.__name__!r} object has no attribute {self.name!r}")
        if instance is not None and self.name in vars(instance):
            return vars(instance)[self.name]
        return self.inherited.__get__(instance, owner)

    def __set__(self, instance: Any, value: Any) -> None:
        vars(instance)[self.name] = value


@pytest.fixture(autouse=True)
def as_in_a_new_process(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """An empty folder; nothing compiled, nothing reported, and nobody who waits."""
    monkeypatch.setattr(machine, "_reported", set())
    monkeypatch.setattr(announcing, "WAITING", announcing.Waiting(later=lambda seconds, act: lambda: None))
    monkeypatch.setattr(dispatch, "cache_folder", lambda function: tmp_path)
    forget()
    yield
    forget()


def forget() -> None:
    """What this process has compiled."""
    dispatch.part.cache_clear()
    dispatch.dispatcher.cache_clear()


def grown(folder: Path) -> tuple[Any, bytes, int]:
    """What `grow` returns and leaves, and how much code is stored."""
    x = np.linspace(0.1, 0.7, 5)
    dispatcher, part = (lambda: dispatch.dispatcher(grow)), (lambda: dispatch.part(grow, None, True))
    found = Compiled("grow", folder, dispatcher, None, part)(x, 7)
    return found, x.tobytes(), len(list(folder.glob("*.o")))


def expected() -> tuple[Any, bytes]:
    """The same, in Python."""
    x = np.linspace(0.1, 0.7, 5)
    found = grow(x, 7)
    return found, x.tobytes()


def test_with_all_parts_the_code_is_stored(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    """What the tests below compare with."""
    assert grown(tmp_path) == (*expected(), 1) and caplog.messages == []


def before(part: str, folder: Path) -> None:
    """For a part that reads what is stored of `again`: another process has stored that."""
    if part in READING:
        grown(folder)
        for file in folder.glob("*.o"):
            file.unlink()
        forget()


def check(part: str, folder: Path, caplog: pytest.LogCaptureFixture) -> None:
    """The same bits; one line if the code could not be stored, and none if it was."""
    stored = int(part in HARMLESS)
    assert grown(folder) == (*expected(), stored)
    assert len(caplog.messages) == 1 - stored, (part, caplog.messages)


@pytest.mark.slow
@pytest.mark.parametrize("part", sampled(READ, 4))
def test_a_part_that_the_engine_reads_has_another_name(
    part: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """The engine gets an AttributeError."""
    owner, name = found(*READ[part])
    before(part, tmp_path)
    monkeypatch.setattr(owner, name, Hidden(owner, name), raising=False)
    check(part, tmp_path, caplog)


@pytest.mark.slow
@pytest.mark.parametrize("part", sampled(REPLACED, 4))
def test_a_method_that_the_engine_replaces_has_another_name(
    part: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """numba calls its own, in the engine's place."""
    owner, name = found(*REPLACED[part])
    before(part, tmp_path)
    monkeypatch.delattr(owner, name)
    check(part, tmp_path, caplog)


@pytest.mark.parametrize("gone", [StopIteration(), AttributeError("no attribute 'c_helpers'")], ids=["module", "names"])
def test_the_functions_for_memory_are_elsewhere(
    gone: Exception, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """`_nrt_python` and `_helperlib`, which are looked up without importing numba."""

    def helpers() -> dict[str, int]:
        raise gone

    monkeypatch.setattr(machine, "helpers", helpers)
    for name in ("_llvm", "surroundings"):
        monkeypatch.setattr(machine, name, getattr(machine, name).__wrapped__)
    check("helpers", tmp_path, caplog)


def test_arrays_lie_in_memory_in_another_way(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """numpy's object is not as entries expect: nothing is stored, as on Windows, which is no failure."""
    monkeypatch.setattr("hookean.compiled.object_code.readable", lambda: False)
    assert grown(tmp_path) == (*expected(), 0) and caplog.messages == []


def test_numba_has_other_modules(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """The file that compiles for the disk cannot even be imported."""
    monkeypatch.setitem(sys.modules, "hookean.compiled.linking", None)
    check("modules", tmp_path, caplog)
