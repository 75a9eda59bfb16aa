"""State: what changes while a system runs. Saved and resumed bit for bit."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@dataclass
class State:
    """Positions `x` and velocities `v` (n, 3); `free` (n, 3) is 0 on held axes; `memory` of each group of elements.

    `scratch` is what a solver keeps between steps (kinetic energy, fictitious masses); `force_scale` the largest forces
    of each component in this run; `revision` counts patches.
    """

    x: Floats
    v: Floats
    free: Floats
    time: float = 0.0
    iteration: int = 0
    revision: int = 0
    memory: list[Floats] = field(default_factory=list)
    scratch: dict[str, Floats] = field(default_factory=dict)
    force_scale: Floats = field(default_factory=lambda: np.zeros(0))

    @property
    def moving(self) -> NDArray[np.bool_]:
        """Which particles (n,) are free on some axis."""
        x, y, z = (self.free > 0.0).T  # column by column: reducing an axis of three is slow
        return np.asarray(x | y | z)

    def copy(self) -> State:
        """An independent copy."""
        return State(
            self.x.copy(),
            self.v.copy(),
            self.free.copy(),
            self.time,
            self.iteration,
            self.revision,
            [m.copy() for m in self.memory],
            {k: a.copy() for k, a in self.scratch.items()},
            self.force_scale.copy(),
        )

    def fits(self, other: State) -> bool:
        """Whether both are states of one system: equal shapes and types, finite numbers."""
        mine, others = [self.x, self.v, self.free, *self.memory], [other.x, other.v, other.free, *other.memory]
        same = len(mine) == len(others) and all(
            (a.shape, a.dtype) == (b.shape, b.dtype) for a, b in zip(mine, others, strict=True)
        )
        return same and all(np.isfinite(a).all() for a in mine)

    def arrays(self) -> dict[str, Floats]:
        """Everything as named arrays, for a file."""
        named = {"x": self.x, "v": self.v, "free": self.free, "force_scale": self.force_scale}
        named["clock"] = np.array([self.time, float(self.iteration), float(self.revision)])
        named.update({f"memory_{i}": m for i, m in enumerate(self.memory)})
        named.update({f"scratch_{k}": a for k, a in self.scratch.items()})
        return named

    @classmethod
    def of(cls, arrays: dict[str, Floats]) -> State:
        """The state that `arrays` wrote."""
        time, iteration, revision = (float(c) for c in arrays["clock"])
        count = sum(k.startswith("memory_") for k in arrays)
        return cls(
            np.ascontiguousarray(arrays["x"]),
            np.ascontiguousarray(arrays["v"]),
            np.ascontiguousarray(arrays["free"]),
            time,
            int(iteration),
            int(revision),
            [np.ascontiguousarray(arrays[f"memory_{i}"]) for i in range(count)],
            {k.removeprefix("scratch_"): np.array(a) for k, a in arrays.items() if k.startswith("scratch_")},
            np.ascontiguousarray(arrays["force_scale"]),
        )
