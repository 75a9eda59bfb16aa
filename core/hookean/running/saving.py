"""Files of saved simulations: how they are opened, and what is read back from their arrays."""

from __future__ import annotations

import contextlib
from pathlib import Path
from typing import IO

import numpy as np
from numpy.typing import NDArray

from hookean.errors import InputError
from hookean.system.system import Held, System


def opened(path: str | Path | IO[bytes], mode: str) -> contextlib.AbstractContextManager[IO[bytes]]:
    """A file by its path, or a stream that its owner closes."""
    return open(path, mode) if isinstance(path, str | Path) else contextlib.nullcontext(path)


def no_simulation(path: str | Path | IO[bytes]) -> InputError:
    where = str(path) if isinstance(path, str | Path) else "file"
    return InputError(where, "not a saved simulation; give a file written by Simulation.save")


def anchor_of(arrays: dict[str, NDArray[np.generic]], i: int, system: System) -> Held:
    """The i-th anchor of a saved simulation; ValueError where it does not fit the system."""
    rows = np.asarray(arrays.pop(f"held_{i}"), np.float64).reshape(-1, 4)
    axes = np.asarray(arrays.pop(f"axes_{i}"), np.float64).reshape(4)
    particles = rows[:, 0].astype(np.int64)
    if len(rows) and not (particles.min() >= 0 and particles.max() < len(system.x) and np.isfinite(rows).all()):
        raise ValueError
    name = str(arrays.pop(f"name_{i}"))
    return Held(int(axes[0]), particles, np.ascontiguousarray(rows[:, 1:]), axes[1:].copy(), name)
