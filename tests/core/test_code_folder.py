"""Compiled code is kept by what it depends on: an edit of that makes a new folder, another edit does not."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from hookean.compiled import dispatch
from hookean.forces import KINDS, line_lengths
from hookean.solvers.relaxation import relaxation_loop

ROLES = ("kernel", "hessian", "central", "end_of_step", "impact", "support")
KERNELS = sorted(
    {kernel for cls in KINDS.values() for role in ROLES if (kernel := getattr(cls, role, None)) is not None},
    key=lambda kernel: f"{kernel.__module__}.{kernel.__qualname__}",
)


def folder(function: Any, monkeypatch: pytest.MonkeyPatch, edited: str = "") -> Path:
    """Where its code is kept when a file of the core has another content."""
    digest = dispatch._digest
    with monkeypatch.context() as patch:
        patch.setattr(dispatch, "_digest", lambda source: b"edited" if source.name == edited else digest(source))
        return dispatch.cache_folder.__wrapped__(function)


@pytest.mark.parametrize("edited", ["clamp_length.py", "line_lengths.py", "dispatch.py", "object_code.py"])
def test_an_edit_of_what_a_kernel_calls_makes_a_new_folder(edited: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Its own file, a helper's and the whole room of the compiler."""
    kernel = KINDS["clamp_length"].kernel
    assert folder(kernel, monkeypatch, edited) != folder(kernel, monkeypatch)


def test_an_edit_of_another_force_does_not(monkeypatch: pytest.MonkeyPatch) -> None:
    """A solver's loop calls kernels by their addresses, and contains none."""
    for function in (KINDS["clamp_length"].kernel, relaxation_loop):
        assert folder(function, monkeypatch, "springs.py") == folder(function, monkeypatch)


def test_a_number_from_another_module_is_part_of_the_code(monkeypatch: pytest.MonkeyPatch) -> None:
    """numba writes constants into the code, wherever they are defined."""
    kernel = KINDS["rigid_collide"].kernel
    before = folder(kernel, monkeypatch)
    monkeypatch.setattr("hookean.forces.rigid_collide.MARGIN", 0.5)
    assert folder(kernel, monkeypatch) != before


def test_helpers_of_helpers_are_reached() -> None:
    """Of two files away, too; and the same of an attribute of a module as of a name."""
    files = {dispatch._source(one).name for one in dispatch.reached(KINDS["rigid_collide"].kernel)[0]}
    assert {"rigid_collide.py", "rigid_places.py", "neighbours.py", "cells.py"} <= files

    def by_module(x: float) -> float:
        return line_lengths.pull(x)  # type: ignore[call-arg, arg-type]

    assert line_lengths.pull in dispatch.reached(by_module)[0]


def test_all_that_a_kernel_is_linked_with_is_reached() -> None:
    """The functions marked with `@device` are what the compiler puts into code; every kernel of every force."""
    for kernel in KERNELS:
        reached, constants = dispatch.reached(kernel)
        left, linked = [kernel], set()
        while left:
            one = left.pop()
            module = one.__globals__
            named = [module.get(name) for name in one.__code__.co_names]
            new = {other for other in named if getattr(other, "__device__", False)} - linked
            linked |= new
            left += new
        assert linked <= reached, kernel
        assert not [one for one in constants if " at 0x" in one], "an address is another one in every process"
