"""All forces, found by the files of this folder: a file here with a Force class is a force everywhere.

A file has the name of its kind, so that a program loads the forces that it uses and no others.
"""

from __future__ import annotations

import importlib
from collections.abc import Iterator, Mapping
from importlib.util import find_spec
from pkgutil import iter_modules
from typing import Any

from hookean.forces.base import Block, Force, Places


class _Kinds(Mapping[str, type[Force]]):
    """Every force class by its kind, in the order of file names: one is loaded when it is asked for, all to go through
    them."""

    def __init__(self) -> None:
        self._known: dict[str, type[Force] | None] = {}

    def __getitem__(self, kind: str) -> type[Force]:
        if kind not in self._known:
            if not kind.isidentifier() or find_spec(f"{__name__}.{kind}") is None:
                raise KeyError(kind)
            self._known[kind] = _class_in(kind)
        found = self._known[kind]
        if found is None:
            raise KeyError(kind)
        return found

    def __iter__(self) -> Iterator[str]:
        return iter([found.name for found in iter_modules(__path__) if found.name in self])

    def __len__(self) -> int:
        return sum(1 for _ in self)


def _class_in(file: str) -> type[Force] | None:
    """The force of a file, if it has one."""
    module = importlib.import_module(f"{__name__}.{file}")
    for value in vars(module).values():
        own = isinstance(value, type) and value.__module__ == module.__name__
        kind = value.model_fields.get("kind") if own and issubclass(value, Force) else None
        if kind is not None and kind.default and not value.variant:
            if kind.default != file:
                raise TypeError(f"{file}.py has the force {kind.default!r}: call the file {kind.default}.py")
            return value  # type: ignore[no-any-return]
    return None


KINDS: Mapping[str, type[Force]] = _Kinds()
"""Every force class by its kind, in the order of file names."""


__all__ = ["KINDS", "Block", "Force", "Places"]


def __getattr__(name: str) -> Any:
    for cls in KINDS.values() if name[0].isupper() else ():  # an import of a file asks for its name, too
        if cls.__name__ == name:
            return cls
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
