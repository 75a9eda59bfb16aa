"""Cases for the laws: every force class by its own example, and some variants with cutoffs and yielding."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from hookean.compiled import dispatch
from hookean.forces import KINDS, Force
from hookean.forces.base import PLACES, Block
from hookean.forces.beam import Beam
from hookean.forces.bend import Bend
from hookean.forces.springs import Springs
from hookean.forces.support import Support
from hookean.forces.unary import Unary
from hookean.scene.scene import Scene
from hookean.system.system import System, compile


@dataclass(frozen=True)
class Case:
    """One force compiled alone: what it declares, its functions and arrays, and the positions it was made at.

    `plain` runs the kernels as the Python functions they are; toys of the negative controls do.
    """

    name: str
    block: Block
    x: np.ndarray
    kernel: Any
    hessian: Any
    end_of_step: Any
    role: str
    conservative: bool
    damped: bool
    remembers: bool
    oriented: bool = False
    plain: bool = False
    arms: tuple[float, ...] = ()
    """Lengths of its slots, where particles have orientations; `x` has their rows and those of references behind."""
    reordered: Callable[[np.ndarray], Block] | None = None
    """The block of the same elements given in another order, where they feel one another and cannot just be moved."""

    def run(self, function: Any, role: str) -> Any:
        """The function as compiled machine code, or as Python."""
        return function if self.plain else dispatch.compiled(function, role)

    def force(
        self, x: np.ndarray, v: np.ndarray | None = None, memory: np.ndarray | None = None
    ) -> tuple[np.ndarray, np.ndarray, float]:
        """Forces (n, 3), lumped stiffness (n,), energy."""
        f, w = np.zeros_like(x), np.zeros(len(x))
        v = np.zeros_like(x) if v is None else v
        memory = self.block.memory if memory is None else memory
        energy = self.run(self.kernel, "force")(x, v, self.block.indices, self.block.parameters, memory, f, w)
        return f, w, float(energy)

    def noted(self, x: np.ndarray, memory: np.ndarray | None = None) -> np.ndarray:
        """The memory after a step that ended at `x`."""
        memory = (self.block.memory if memory is None else memory).copy()
        if self.end_of_step is not None:
            self.run(self.end_of_step, "remember")(x, self.block.indices, self.block.parameters, memory)
        return memory

    def moved(self, rng: np.random.Generator, amount: float = 0.15) -> np.ndarray:
        """Positions up to `amount` x the shortest distance within an element away, on every axis.

        With amount <= 0.15 no distance changes by more than 0.52 of itself: cutoffs below 0.4 or above 1.6 of a
        start length are never crossed.
        """
        return self.x + amount * self.spacing * rng.uniform(-1.0, 1.0, self.x.shape)

    def past(self, rng: np.random.Generator) -> np.ndarray:
        """A memory that some earlier motion left."""
        return self.noted(self.moved(rng), self.noted(self.moved(rng)))

    @property
    def spacing(self) -> float:
        """Shortest distance between two particles of one element; 1 where elements have one."""
        index = self.block.indices
        corners = self.x[index if not self.arms else index[:, : index.shape[1] // 3]]
        apart = np.linalg.norm(corners[:, :, None] - corners[:, None], axis=3)
        apart = apart[apart > 0]
        return float(apart.min()) if len(apart) else 1.0

    def scales(self, x: np.ndarray, f: np.ndarray, w: np.ndarray) -> tuple[float, float]:
        """What rounding is measured by: a force and a length."""
        reach = float(np.ptp(x, axis=0).max()) or 1.0
        return float(np.abs(f).max() + w.max() * reach) or 1.0, reach


def scene_of(force: Force, x: np.ndarray, **more: Any) -> Scene:
    """A scene of one force: on given particles, or on a mesh named as the force names it."""
    mesh = getattr(force, "mesh", None)
    if mesh is not None:
        vertices = {"vertices": x, "faces": type(force).example_faces}  # type: ignore[attr-defined]
        return Scene(particles=x, meshes={mesh: vertices}, forces=(force,), **more)
    return Scene(particles=x, forces=(force,), **more)


def case_of(name: str, force: Force, x: np.ndarray, held: tuple[int, ...] = ()) -> Case:
    """A force compiled alone; with anchors at `held` particles, to which it may then hold on."""
    cls, system = force.compiled_as, compile(scene_of(force, x, anchors=[{"particles": held}] if held else []))
    (group,) = system.groups or system.contacts

    def reordered(order: np.ndarray) -> Block:
        given = {n: getattr(force, n) for n in force.model_fields_set}
        rows = {
            n: v[order] for n, v in given.items() if isinstance(v, np.ndarray) and len(v) == len(group.block.indices)
        }
        return case_of(name, type(force)(**{**given, **rows}), x, held).block

    together = cls.gathered(group.block, group.block.memory, system.x, None) is not None
    return Case(
        name, group.block, system.x, cls.kernel, cls.hessian, cls.end_of_step,
        "support" if held else cls.role, cls.conservative, cls.damped, cls.remembers,
        cls.oriented, arms=tuple(system.slots.lengths), reordered=reordered if together else None,
    )  # fmt: skip


def _variants() -> list[Case]:
    """Springs on their cutoffs, yielding, slack, and of all kinds in one block."""
    _, x = Springs.example()
    pairs = np.array([[0, 1], [1, 2], [2, 3], [3, 0], [0, 2], [1, 3]])
    start = np.linalg.norm(x[pairs[:, 1]] - x[pairs[:, 0]], axis=1)
    off = Springs(
        particles=pairs, stiffness=[1.0, 10.0, 100.0, 1e3, 1e4, 50.0], rest_factor=[0.9, 1.0, 1.1, 0.5, 1.3, 1.0],
        upper_cutoff=start * [0.3, 2.0, 0.0, 0.3, 2.0, 0.0], lower_cutoff=start * [0.0, 0.3, 2.0, 0.2, 0.3, 0.0],
    )  # fmt: skip
    yielding = Springs(particles=pairs, stiffness=[1.0, 10.0, 100.0, 300.0, 7.0, 50.0], plasticity=[0.05] * 5 + [0.0])
    far = Springs(particles=pairs, plasticity=0.03, rest_factor=0.7, upper_cutoff=start * 0.35, damping=3.0)
    linear = Springs(particles=pairs, rest_length=0.0, damping=0.0)
    half = [0.4, 1.8, 0.4, 1.8, 0.4, 1.8]  # taut, and slack
    tie = Springs(particles=pairs, axial_stiffness=50.0, rest_factor=half, tension_only=True, plasticity=0.05)
    strut = Springs(particles=pairs, axial_stiffness=50.0, rest_factor=half, compression_only=True)
    named = {
        "cut off": off, "yielding": yielding, "cut off and yielded": far, "rest length 0": linear,
        "tension only": tie, "compression only": strut,
    }  # fmt: skip
    return [case_of(f"springs, {name}", force, x) for name, force in named.items()]


def _rods() -> list[Case]:
    """Rods drawn curved: closed, given in disorder, held at their ends, with free sections, branched."""
    _, helix = Bend.example()
    turn = np.arange(7) * 2.0 * np.pi / 7.0
    ring = np.column_stack([np.cos(turn), np.sin(turn), 0.2 * np.sin(2.0 * turn)])
    i = np.arange(7)
    round_it = np.column_stack([i, (i + 1) % 7, (i + 2) % 7])
    row = np.array([[0, 1, 2], [3, 2, 1], [2, 3, 4]])
    stiffness = [5.0, 20.0, 1.0]
    branched = [[0, 1, 2], [1, 2, 3], [2, 3, 4], [1, 2, 5], [6, 2, 1]]
    limbs = np.vstack([helix, helix[2] + [0.3, 0.9, -0.2], helix[2] + [0.9, -0.1, -0.5]])
    made = {
        "closed": (Bend(particles=round_it[[3, 0, 6, 1, 2, 5, 4]], stiffness=[1, 2, 3, 1, 4, 2, 5]), ring, ()),
        "half as curved": (Bend(particles=row[[2, 0, 1]], stiffness=stiffness, angle_factor=0.5), helix, ()),
        "free sections": (Bend(particles=row, stiffness=stiffness, rest_angle=0.3, sections="free"), helix, ()),
        "held at its start": (Bend(particles=row, stiffness=stiffness), helix, (0,)),
        "held at its end": (Bend(particles=row, stiffness=stiffness), helix, (4,)),
        "held at both ends": (Bend(particles=row, stiffness=stiffness), helix, (0, 4)),
        "one corner, held": (Bend(particles=row[:1]), helix[:3], (0, 2)),
        "branched": (Bend(particles=branched, stiffness=3.0), limbs, ()),
    }
    return [case_of(f"bend, {name}", *given) for name, given in made.items()]


def _beams() -> list[Case]:
    """Beams bent in, with hinged ends; and what acts on their orientations: moments, and supports of rotations."""
    beam, x = Beam.example()
    bent = beam.replaced(curvature="straight", release_start="y", release_end="z", offset_end=np.zeros(3))
    spun = beam.replaced(release_start=["x", "xyz"])
    found = [case_of("beam, bent in and hinged", bent, x), case_of("beam, hinged about x, and about all", spun, x)]
    for name, more in (
        ("unary, moments", Unary(particles=[0, 2], vector=[0, 0, 1], moment=[[3.0, 1.0, -2.0], [0.0, 4.0, 1.0]])),
        ("support, rotations", Support(particles=[1, 2], rotation_stiffness=[[3.0, 1.0, 2.0], [0.0, 4.0, 4.0]])),
    ):
        system = compile(Scene(particles=x, forces=[beam, more]))
        group = next(group for group in system.groups if group.cls is type(more).rider)
        cls, arms = group.cls, tuple(system.slots.lengths)
        functions = cls.kernel, cls.hessian, None
        found.append(Case(name, group.block, system.x, *functions, cls.role, cls.conservative, False, False, arms=arms))
    return found


def _examples() -> list[Case]:
    """The example of every kind with a kernel; one that fails is left to the test that misses it, and is told."""
    found: list[Case] = []
    for kind, cls in KINDS.items():
        if cls.kernel is not None:
            found += _tried(kind, lambda kind=kind, cls=cls: [case_of(kind, *cls.example())])  # type: ignore[misc]
    return found + _tried("springs", _variants) + _tried("bend", _rods) + _tried("beam", _beams)


def _tried(kind: str, made: Callable[[], list[Case]]) -> list[Case]:
    """What `made` gives; nothing where it fails, so that one bad example does not keep others from being tested."""
    try:
        return made()
    except Exception as error:
        BROKEN[kind] = f"{type(error).__name__}: {error}"
        return []


BROKEN: dict[str, str] = {}
"""Kinds whose example fails, and how."""

KERNELS = _examples()
"""All cases with a kernel."""


def resting() -> list[Case]:
    """Internal forces with rest values from the start shape (and a factor on them), given a place and nothing else."""
    found: list[Case] = []
    for kind, cls in KINDS.items():
        rests = [n for n in cls.model_fields if n.endswith("_factor")]
        if cls.kernel is not None and cls.role == "internal" and rests:
            found += _tried(kind, lambda kind=kind, cls=cls: [_placed(kind, cls)])  # type: ignore[misc]
    return found


def _placed(kind: str, cls: type[Force]) -> Case:
    force, x = cls.example()
    place = {n: getattr(force, n) for n in PLACES if getattr(force, n, None) is not None}
    return case_of(kind, cls(**place), x)


def replaced(case: Case, **changes: Any) -> Case:
    """A case with other functions or another declaration."""
    return replace(case, **changes)


def example_system(kind: str, **more: Any) -> System:
    """The example of a kind as a system."""
    force, x = KINDS[kind].example()
    return compile(scene_of(force, x, **more))


def identity(value: Any) -> str:
    """For the names of parametrized tests."""
    return value.name if isinstance(value, Case) else str(value)
