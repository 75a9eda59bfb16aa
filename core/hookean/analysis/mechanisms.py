"""Mechanisms and states of self-stress of a pin-jointed bar net."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.errors import InputError
from hookean.forces import KINDS
from hookean.running.result import Result
from hookean.scene.scene import Scene
from hookean.system.system import compile
from hookean.values.units import Units

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

RANK = 1e-10  # of the largest singular value: what is below counts as zero
LARGEST = 4_000  # bars or free axes


@dataclass(frozen=True)
class Mechanisms:
    """Mechanisms and states of self-stress of a bar net.

    With b `bars`, f `free_axes` and the `rank` r of the equilibrium matrix (f, b): s = b - r `self_stress_states`, and
    f - r motions that change no length to first order, of which `rigid_motions` move the net as a whole and the others
    are its `mechanisms`. `modes` (mechanisms, n, 3) [-] are those, at right angles to each other and to the rigid
    motions; `self_stresses` (s, b) [-] forces in the bars (tension +) that balance without loads, the largest part of
    each 1. `pairs` (b, 2) are the particles of the bars.
    """

    bars: int
    free_axes: int
    rank: int
    mechanisms: int
    rigid_motions: int
    self_stress_states: int
    modes: Floats = field(repr=False)
    self_stresses: Floats = field(repr=False)
    pairs: Ints = field(repr=False)
    particles: Floats = field(repr=False)
    units: Units = field(default_factory=Units)

    @property
    def kind(self) -> str:
        """Statically and kinematically determinate or not, as one of Pellegrino and Calladine's four types."""
        statically = "statically indeterminate" if self.self_stress_states else "statically determinate"
        kinematically = "kinematically indeterminate" if self.mechanisms else "kinematically determinate"
        return f"{statically} and {kinematically}"

    def summary(self) -> list[str]:
        """The counts, for a person."""
        return [
            f"{self.bars} bars, {self.free_axes} free axes, rank {self.rank} of the equilibrium matrix",
            f"mechanisms: {self.mechanisms}, rigid motions: {self.rigid_motions}",
            f"states of self-stress: {self.self_stress_states}",
            f"the net is {self.kind}",
        ]

    def to_dict(self) -> dict[str, Any]:
        """As plain lists and numbers, by the names of the HTTP answer."""
        counts = ("bars", "free_axes", "rank", "mechanisms", "rigid_motions", "self_stress_states", "kind")
        arrays = ("modes", "self_stresses", "pairs", "particles")
        return {
            **{name: getattr(self, name) for name in counts},
            **{name: getattr(self, name).tolist() for name in arrays},
            "units": self.units.model_dump(),
        }


def mechanisms(model: Scene | Result) -> Mechanisms:
    """Count the mechanisms and the states of self-stress of a net of bars, by the rank of its equilibrium matrix.

    Every element of two particles that acts along the line between them is a bar, in tension or compression, whatever
    its stiffness. Forces of other kinds are left out. The shape is that of a result, or the start of a scene.

    Raises InputError where there are no bars, a bar has zero length, or the net is too large for dense matrices.
    Source: Calladine, Buckminster Fuller's "tensegrity" structures and Clerk Maxwell's rules, 1978; Pellegrino and
    Calladine, Matrix analysis of statically and kinematically indeterminate frameworks, 1986.
    """
    scene = model.scene if isinstance(model, Result) else model
    if not isinstance(scene, Scene):
        raise InputError("model", f"a Scene or Result is expected, not a {type(model).__name__}")
    system = compile(scene)
    state = system.start()
    x = np.asarray(model.particles) if isinstance(model, Result) else state.x
    pairs = _bars(system)
    free = state.free > 0.0
    touched = np.zeros(len(x), bool)
    touched[pairs] = True
    dofs = np.flatnonzero((free & touched[:, None]).ravel())
    if max(len(dofs), len(pairs)) > LARGEST:
        raise InputError("model", f"{len(pairs)} bars on {len(dofs)} free axes; at most {LARGEST} are supported")
    matrix = _equilibrium(x, pairs)[dofs]
    left, sizes, right = np.linalg.svd(matrix)
    rank = int((sizes > RANK * sizes.max(initial=0.0)).sum()) if sizes.size else 0
    loose, stress = left[:, rank:], right[rank:]
    rigid = _rigid(x, dofs, ~free & touched[:, None])
    inner = _apart(loose, rigid)
    modes = np.zeros((inner.shape[1], x.size))
    modes[:, dofs] = inner.T
    stress = stress / np.abs(stress).max(axis=1, keepdims=True) if len(stress) else stress
    return Mechanisms(
        len(pairs),
        len(dofs),
        rank,
        inner.shape[1],
        rigid.shape[1],
        len(pairs) - rank,
        modes.reshape(-1, len(x), 3),
        stress,
        pairs,
        x,
        scene.units,
    )


def _bars(system: Any) -> Ints:
    """Pairs of particles of all bars, in the order of the scene's forces."""
    found: list[tuple[int, Ints]] = []
    for group in system.groups:
        if KINDS.get(group.cls.kind_name) is None or group.cls.central is None or group.cls.role != "internal":
            continue
        found += [(part.number, group.block.indices[part.rows]) for part in group.parts]
    if not found:
        raise InputError("model", "has no bars; add springs or other elements along a line between two particles")
    return np.concatenate([pairs for _, pairs in sorted(found, key=lambda item: item[0])])


def _equilibrium(x: Floats, pairs: Ints) -> Floats:
    """The equilibrium matrix (3 n, b): what a unit tension of each bar puts on the particles, with its sign turned."""
    along = x[pairs[:, 1]] - x[pairs[:, 0]]
    size = np.linalg.norm(along, axis=1)
    if (size == 0.0).any():
        raise InputError("model", f"bar {int(np.argmin(size))} has zero length and no direction; move its ends apart")
    along = along / size[:, None]
    matrix = np.zeros((len(x), 3, len(pairs)))
    number = np.arange(len(pairs))
    for axis in range(3):
        np.add.at(matrix[:, axis], (pairs[:, 0], number), -along[:, axis])
        np.add.at(matrix[:, axis], (pairs[:, 1], number), along[:, axis])
    return matrix.reshape(3 * len(x), len(pairs))


def _rigid(x: Floats, dofs: Ints, fixed: NDArray[np.bool_]) -> Floats:
    """Motions (f, k) of the net as a whole that its supports allow, at right angles."""
    middle = x - x.mean(axis=0)
    size = float(np.abs(middle).max(initial=0.0)) or 1.0
    whole = np.zeros((x.size, 6))
    for axis in range(3):
        whole[axis::3, axis] = 1.0
        turn = np.zeros(3)
        turn[axis] = 1.0
        whole[:, 3 + axis] = np.cross(turn, middle / size).ravel()
    held = np.flatnonzero(fixed.ravel())
    _, sizes, ways = np.linalg.svd(whole[held]) if len(held) else (None, np.zeros(0), np.eye(6))
    count = int((sizes > RANK * max(sizes.max(initial=0.0), 1e-300)).sum())
    allowed = whole[dofs] @ ways[count:].T
    basis, sizes, _ = np.linalg.svd(allowed, full_matrices=False)
    return np.asarray(basis[:, sizes > RANK * max(sizes.max(initial=0.0), 1e-300)])


def _apart(loose: Floats, rigid: Floats) -> Floats:
    """What is left of motions (f, k) at right angles to the rigid ones, at right angles to each other."""
    rest = loose - rigid @ (rigid.T @ loose)
    basis, sizes, _ = np.linalg.svd(rest, full_matrices=False)
    return np.asarray(basis[:, sizes > 0.5])
