"""Files of saved simulations: what is written to them and read back."""

from __future__ import annotations

import contextlib
import zipfile
import zlib
from dataclasses import dataclass
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from hookean.errors import InputError
from hookean.running.result import Status
from hookean.scene.scene import Scene
from hookean.system.state import State
from hookean.system.system import Held, System

if TYPE_CHECKING:
    from hookean.running.simulation import Simulation, Source

UNREADABLE = (
    OSError, KeyError, ValueError, IndexError, TypeError, EOFError, NotImplementedError, zipfile.BadZipFile, zlib.error
)  # fmt: skip
"""What reading a damaged file raises."""


@dataclass
class Saved:
    """What a file of a saved simulation has: the scene, the script (JSON, or None) and whether it had finished, the
    status, and the arrays of the state and the anchors."""

    scene: Scene
    script: str | None
    finished: bool
    status: Status
    arrays: dict[str, NDArray[Any]]


def write(path: str | Path | IO[bytes], saved: Saved, held: list[Held]) -> None:
    """Write a simulation with its anchors to an .npz file."""
    texts = {"scene": np.array(saved.scene.canonical), "status": np.array(str(saved.status))}
    if saved.script is not None:
        texts["script"], texts["finished"] = np.array(saved.script), np.array(saved.finished)
    with opened(path, "wb") as file:
        np.savez(file, allow_pickle=False, **texts, **saved.arrays, **arrays_of(held))


def read(path: str | Path | IO[bytes]) -> Saved:
    """What `write` wrote; one of UNREADABLE or InputError where it is damaged."""
    with opened(path, "rb") as source, np.load(source, allow_pickle=False) as file:
        arrays = {name: file[name] for name in file.files}
    script = str(arrays.pop("script")) if "script" in arrays else None
    finished = bool(arrays.pop("finished", False))
    scene = Scene.read(str(arrays.pop("scene")))
    return Saved(scene, script, finished, Status(str(arrays.pop("status"))), arrays)


def loaded(cls: type[Simulation], path: str | Path | IO[bytes], stream: Source | None) -> Simulation:
    """The simulation of a file that `write` wrote, of the class `cls`; InputError where the file is not one."""
    try:
        saved = read(path)
        found = cls(saved.scene, saved.script, stream)
        found.system.held = anchors_of(saved.arrays, found.system)
        found.system.brace()
        found.take_up(State.of(saved.arrays), saved.status)
    except InputError as error:
        if stream is not None or error.pointer == "/drives":
            raise
        raise no_simulation(path) from None
    except UNREADABLE:
        raise no_simulation(path) from None
    if found._playing is not None:
        found._playing.finished = saved.finished  # what patches moved after its end stays moved
    return found


def opened(path: str | Path | IO[bytes], mode: str) -> contextlib.AbstractContextManager[IO[bytes]]:
    """A file by its path, or a stream that its owner closes."""
    return open(path, mode) if isinstance(path, str | Path) else contextlib.nullcontext(path)


def no_simulation(path: str | Path | IO[bytes]) -> InputError:
    where = str(path) if isinstance(path, str | Path) else "file"
    return InputError(where, "not a saved simulation; give a file written by Simulation.save")


def arrays_of(held: list[Held]) -> dict[str, NDArray[Any]]:
    """Anchors as named arrays, for a file."""
    arrays: dict[str, NDArray[Any]] = {}
    for i, anchor in enumerate(held):
        arrays[f"held_{i}"] = np.column_stack([anchor.particles, anchor.targets])
        arrays[f"axes_{i}"] = np.array([float(anchor.number), *anchor.free, *anchor.turning])
        arrays[f"name_{i}"] = np.array(anchor.name)
    return arrays


def anchors_of(arrays: dict[str, NDArray[Any]], system: System) -> list[Held]:
    """The anchors that `arrays_of` wrote; ValueError where they do not fit the system."""
    count = sum(name.startswith("held_") for name in arrays)
    return [_anchor(arrays, i, system) for i in range(count)]


def _anchor(arrays: dict[str, NDArray[np.generic]], i: int, system: System) -> Held:
    rows = np.asarray(arrays.pop(f"held_{i}"), np.float64).reshape(-1, 4)
    axes = np.asarray(arrays.pop(f"axes_{i}"), np.float64).ravel()
    if len(axes) == 4:  # written before anchors held rotations
        axes = np.append(axes, np.ones(3))
    axes = axes.reshape(7)
    particles = rows[:, 0].astype(np.int64)
    if len(rows) and not (particles.min() >= 0 and particles.max() < system.slots.count and np.isfinite(rows).all()):
        raise ValueError
    name = str(arrays.pop(f"name_{i}"))
    return Held(int(axes[0]), particles, np.ascontiguousarray(rows[:, 1:]), axes[1:4].copy(), name, axes[4:].copy())
