"""All forces, found by walking this folder: a file here with a Force class is a force everywhere."""

from __future__ import annotations

import importlib
import pkgutil

from hookean.forces.base import Block, Force, Places

KINDS: dict[str, type[Force]] = {}
"""Every force class by its kind, in the order of file names."""

for _found in pkgutil.iter_modules(__path__):
    _module = importlib.import_module(f"{__name__}.{_found.name}")
    for _value in vars(_module).values():
        _own = isinstance(_value, type) and _value.__module__ == _module.__name__
        _kind = _value.model_fields.get("kind") if _own and issubclass(_value, Force) else None
        if _kind is not None and _kind.default and not _value.variant:
            KINDS[_value.kind_name] = _value

globals().update({cls.__name__: cls for cls in KINDS.values()})
__all__ = ["KINDS", "Block", "Force", "Places", *sorted(cls.__name__ for cls in KINDS.values())]
