"""hookean: particle-spring form finding. Describe a Scene, relax it, read the forces."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from hookean.errors import InputError as InputError

if TYPE_CHECKING:
    from hookean.patch import Patch as Patch
    from hookean.result import Result as Result
    from hookean.result import Status as Status
    from hookean.run import relax as relax
    from hookean.scene import Scene as Scene
    from hookean.simulation import Frame as Frame
    from hookean.simulation import Simulation as Simulation
    from hookean.simulation import simulate as simulate

__version__ = "0.1.0"

_HOMES = {
    "Scene": "scene",
    "Result": "result",
    "Status": "result",
    "Frame": "simulation",
    "Simulation": "simulation",
    "Patch": "patch",
    "relax": "run",
    "simulate": "simulation",
}

__all__ = ["InputError", *_HOMES]


def __getattr__(name: str) -> Any:
    # loaded when first used: `import hookean` alone costs nothing
    if name in _HOMES:
        return getattr(importlib.import_module(f"hookean.{_HOMES[name]}"), name)
    from hookean.forces import KINDS

    for cls in KINDS.values():
        if cls.__name__ == name:
            return cls
    raise AttributeError(f"module 'hookean' has no attribute {name!r}")
