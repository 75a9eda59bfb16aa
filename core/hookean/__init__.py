"""hookean: particle-spring form finding. Describe a Scene, relax it, read the forces.

    from hookean import Scene, relax

    scene = Scene.read({"forces": [{"kind": "springs", "lines": [[[0, 0, 0], [1, 0, 0]]]}]})  # or JSON text
    result = relax(scene)
    print(result.message, result.force("springs")["force"])

`relax` brings a Scene to equilibrium and returns a Result with its Status. `simulate` yields the Frames of a scene in
motion; a Simulation is stepped, patched (Patch), saved and loaded; a Script and a Stream lead either through time. Bad
input raises InputError, one sentence with its place. Every force is a class here by its name (`hookean.Springs`,
`hookean.Unary` ...). docs/scene.md tells of every field, docs/forces.md of every force.
"""

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
    from hookean.script import Script as Script
    from hookean.simulation import Frame as Frame
    from hookean.simulation import Simulation as Simulation
    from hookean.simulation import simulate as simulate
    from hookean.stream import Stream as Stream

__version__ = "0.1.0"

_HOMES = {
    "Scene": "scene",
    "Result": "result",
    "Status": "result",
    "Frame": "simulation",
    "Simulation": "simulation",
    "Patch": "patch",
    "Script": "script",
    "Stream": "stream",
    "relax": "run",
    "simulate": "simulation",
}

__all__ = [
    "Frame",
    "InputError",
    "Patch",
    "Result",
    "Scene",
    "Script",
    "Simulation",
    "Status",
    "Stream",
    "relax",
    "simulate",
]


def __getattr__(name: str) -> Any:
    # loaded when first used: `import hookean` alone costs nothing
    if name in _HOMES:
        return getattr(importlib.import_module(f"hookean.{_HOMES[name]}"), name)
    from hookean.forces import KINDS

    for cls in KINDS.values():
        if cls.__name__ == name:
            return cls
    raise AttributeError(f"module 'hookean' has no attribute {name!r}")


def __dir__() -> list[str]:
    from hookean.forces import KINDS

    return sorted([*__all__, *(cls.__name__ for cls in KINDS.values()), "__doc__", "__version__"])
