"""Mechanisms and states of self-stress of bars and beams."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.analysis.beam_strains import BeamPlaces, beam_columns, beam_places
from hookean.analysis.load_cases import of_case
from hookean.errors import InputError
from hookean.forces import KINDS
from hookean.forces.beam import Beam
from hookean.forces.beam_element import OFFSET
from hookean.running.result import Result
from hookean.scene.scene import Scene
from hookean.system.system import compile
from hookean.values.units import Units

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

RANK = 1e-10  # of the largest singular value: what is below counts as zero
TURNS = 1e-6  # a turn with less than this part at right angles to the rigid motions is a rigid motion
LARGEST = 4_000  # bars or free axes


@dataclass(frozen=True)
class Mechanisms:
    """Mechanisms and states of self-stress of bars and beams.

    With b `bars`, the 6 forces of each of the `beams` less those that are released, f `free_axes`, of rotations as
    well, and the `rank` r of the equilibrium matrix: b + 6 beams - released - r are the `self_stress_states`, and f - r
    motions strain nothing to first order, of which `rigid_motions` move all as a whole, `free_turns` only turn hinged
    joints and struts about themselves, so that no particle moves, and the others are its `mechanisms`. `modes`
    (mechanisms, n, 3) [-] are the last, at right angles to each other and to all of the others, and
    `turns` (mechanisms, r, 3) [1/length] the rotation vectors of particles with orientations in them; `self_stresses`
    (s, b) [-] forces in the bars (tension +) that balance without loads, the largest part of each 1, and
    `beam_stresses` (s, beams, 6) in the beams: N, and Mt, My at both ends, Mz at both ends over the beam's length.
    `pairs` (b, 2) are the particles of the bars. `left_out` are the names of other forces that hold particles, such as
    cloth and elastic supports: the counts are those without them.
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
    beams: int = 0
    turns: Floats = field(default_factory=lambda: np.zeros((0, 0, 3)), repr=False)
    beam_stresses: Floats = field(default_factory=lambda: np.zeros((0, 0, 6)), repr=False)
    free_turns: int = 0
    left_out: tuple[str, ...] = ()

    @property
    def kind(self) -> str:
        """Statically and kinematically determinate or not, as one of Pellegrino and Calladine's four types."""
        statically = "statically indeterminate" if self.self_stress_states else "statically determinate"
        kinematically = "kinematically indeterminate" if self.mechanisms else "kinematically determinate"
        return f"{statically} and {kinematically}"

    def __repr__(self) -> str:
        return "\n".join(["Mechanisms", *(f"  {line}" for line in self.summary())])

    def summary(self) -> list[str]:
        """The counts, for a person."""
        beams = f"{self.beams} beams, " if self.beams else ""
        turns = f", free turns of hinged joints: {self.free_turns}" if self.free_turns else ""
        return [
            f"{self.bars} bars, {beams}{self.free_axes} free axes, rank {self.rank} of the equilibrium matrix",
            f"mechanisms: {self.mechanisms}, rigid motions: {self.rigid_motions}{turns}",
            f"states of self-stress: {self.self_stress_states}",
            f"the net is {self.kind}",
            *([f"counted without {', '.join(self.left_out)}"] if self.left_out else []),
        ]

    def to_dict(self) -> dict[str, Any]:
        """As plain lists and numbers, by the names of the HTTP answer."""
        counts = (
            "bars",
            "beams",
            "free_axes",
            "rank",
            "mechanisms",
            "rigid_motions",
            "free_turns",
            "self_stress_states",
            "kind",
        )
        arrays = ("modes", "turns", "self_stresses", "beam_stresses", "pairs", "particles")
        return {
            **{name: getattr(self, name) for name in counts},
            **{name: getattr(self, name).tolist() for name in arrays},
            "left_out": list(self.left_out),
            "units": self.units.model_dump(),
        }


def mechanisms(model: Scene | Result, *, case: str | None = None) -> Mechanisms:
    """Count the mechanisms and the states of self-stress of bars and beams, by the rank of their equilibrium matrix.

    Every element of two particles that acts along the line between them is a bar, in tension or compression, whatever
    its stiffness; beams have six forces each, less those that are released. Forces of other kinds are left out. The
    shape is that of a result, the start of a scene, or with `case` that of a load case or combination of the scene.

    Raises InputError for an unknown case, and where there are neither, one has zero length, or there are too many for
    dense matrices.
    Source: Calladine, Buckminster Fuller's "tensegrity" structures and Clerk Maxwell's rules, 1978; Pellegrino and
    Calladine, Matrix analysis of statically and kinematically indeterminate frameworks, 1986.
    """
    model = of_case(model, case)
    scene = model.scene if isinstance(model, Result) else model
    if not isinstance(scene, Scene):
        raise InputError("model", f"a Scene or Result is expected, not a {type(model).__name__}")
    system = compile(scene)
    state = system.start()
    if isinstance(model, Result):
        system.slots.put(state, np.asarray(model.particles), model.rotations["quaternions"])
    count, x, pairs, beams = system.slots.count, state.x, _bars(system), beam_places(system)
    if not len(pairs) and not len(beams.ends):
        raise InputError(
            "model", "has no bars and no beams; add springs, beams or other elements along a line between two particles"
        )
    free = state.free > 0.0
    touched = np.zeros(len(x), bool)
    touched[pairs] = touched[beams.ends] = touched[beams.slots] = True
    dofs, columns = np.flatnonzero((free & touched[:, None]).ravel()), len(pairs) + 6 * len(beams.ends)
    if max(len(dofs), columns) > LARGEST:
        raise InputError("model", f"{columns} forces on {len(dofs)} free axes; at most {LARGEST} are supported")
    whole = np.hstack([_equilibrium(x, pairs), beam_columns(system, state, beams)])
    kept = np.append(np.ones(len(pairs), bool), beams.kept.ravel())
    left, sizes, right = np.linalg.svd(whole[dofs][:, kept])
    rank = int((sizes > RANK * sizes.max(initial=0.0)).sum()) if sizes.size else 0
    loose, found = left[:, rank:], right[rank:]
    rigid = _rigid(system, x, dofs, ~free & touched[:, None])
    turns = _apart(loose @ _unmoved(system, beams, dofs, loose), rigid, TURNS)
    inner = _apart(loose, np.hstack([rigid, turns]))
    modes = np.zeros((inner.shape[1], x.size))
    modes[:, dofs] = inner.T
    moved = modes.reshape(-1, len(x), 3)
    stress = np.zeros((len(found), columns))
    stress[:, kept] = found / np.abs(found).max(axis=1, keepdims=True) if len(found) else found
    return Mechanisms(
        len(pairs),
        len(dofs),
        rank,
        inner.shape[1],
        rigid.shape[1],
        len(found),
        moved[:, :count],
        stress[:, : len(pairs)],
        pairs,
        x[:count],
        scene.units,
        len(beams.ends),
        moved[:, system.slots.first] / system.slots.lengths[:, None],
        stress[:, len(pairs) :].reshape(len(found), len(beams.ends), 6),
        turns.shape[1],
        _others(system),
    )


def _counted(group: Any) -> bool:
    """Whether the elements of a group are bars."""
    known = KINDS.get(group.cls.kind_name) is not None
    return known and group.cls.central is not None and group.cls.role == "internal"


def _others(system: Any) -> tuple[str, ...]:
    """The names of forces that are neither loads nor bars nor beams, in the order of the scene."""
    found = set[int]()
    for group in system.groups:
        if group.cls.role != "load" and group.cls is not Beam and not _counted(group):
            found.update(part.number for part in group.parts if part.number >= 0)
    forces = system.scene.forces
    return tuple(forces[i].name or forces[i].kind_name for i in sorted(found))


def _bars(system: Any) -> Ints:
    """Pairs of particles of all bars, in the order of the scene's forces."""
    found: list[tuple[int, Ints]] = []
    for group in system.groups:
        if not _counted(group):
            continue
        found += [(part.number, group.block.indices[part.rows]) for part in group.parts]
    if not found:
        return np.zeros((0, 2), np.int64)
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


def _rigid(system: Any, x: Floats, dofs: Ints, fixed: NDArray[np.bool_]) -> Floats:
    """Motions (f, k) of all as a whole that its supports allow, at right angles."""
    slots = system.slots
    count = slots.count
    middle = x[:count] - x[:count].mean(axis=0)
    size = float(np.abs(middle).max(initial=0.0)) or 1.0
    ways = np.zeros((len(x), 3, 6))
    for axis in range(3):
        ways[:count, axis, axis] = 1.0
        turn = np.zeros(3)
        turn[axis] = 1.0
        ways[:count, :, 3 + axis] = np.cross(turn, middle / size)
        ways[slots.first, axis, 3 + axis] = slots.lengths / size
    whole = ways.reshape(x.size, 6)
    held = np.flatnonzero(fixed.ravel())
    _, sizes, turned = np.linalg.svd(whole[held]) if len(held) else (None, np.zeros(0), np.eye(6))
    count = int((sizes > RANK * max(sizes.max(initial=0.0), 1e-300)).sum())
    allowed = whole[dofs] @ turned[count:].T
    basis, sizes, _ = np.linalg.svd(allowed, full_matrices=False)
    return np.asarray(basis[:, sizes > RANK * max(sizes.max(initial=0.0), 1e-300)])


def _unmoved(system: Any, beams: BeamPlaces, dofs: Ints, loose: Floats) -> Floats:
    """Combinations (k, m) of motions (f, k) that move no particle and no eccentric end of a beam."""
    moving = np.zeros((2 * len(system.slots) + system.slots.count, 3), bool)
    moving[: system.slots.count] = True
    if len(beams.ends):
        moving[beams.slots[beams.parameters[:, OFFSET : OFFSET + 6].reshape(-1, 2, 3).any(axis=2)]] = True
    _, sizes, right = np.linalg.svd(loose[moving.ravel()[dofs]])
    return np.asarray(right[int((sizes > TURNS).sum()) :].T)


def _apart(loose: Floats, others: Floats, least: float = 0.5) -> Floats:
    """What is left of motions (f, k) at right angles to some others, at right angles to each other."""
    rest = loose - others @ (others.T @ loose)
    basis, sizes, _ = np.linalg.svd(rest, full_matrices=False)
    return np.asarray(basis[:, sizes > least])
