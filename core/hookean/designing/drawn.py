"""Where particles are drawn as variables: what rest lengths, rest angles, areas and supports are measured from.

A force depends on the drawn form by the parameters that it is compiled to, at fixed positions. Particles that share no
element change together, so that differences of a whole net take a few compilations; where elements depend on particles
that are not theirs, such as the frames of a chain, particles change one by one. Masses are variables here, too.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from hookean.designing.columns import AXES, STEP, Column, Entries, Give, compiled, shape_of, tied
from hookean.errors import InputError
from hookean.forces.base import PLACES, Force
from hookean.running.patch import take_again
from hookean.scene.scene import Scene
from hookean.system.group import Group, Part
from hookean.system.system import Held, System
from hookean.values.mesh import Mesh

if TYPE_CHECKING:
    from hookean.designing.problem import Variable

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

ALIKE = 1e-3  # part of the largest change by which parameters may differ from the sum of changes of single particles
SEED = 7  # of the change with which that is checked
LEAST = 1e-9  # part of the mean mass: the least one


@dataclass
class Shared(Entries):
    """Entries of some of the `whole` unknowns of a variable."""

    whole: int = 0

    @property
    def count(self) -> int:
        """The unknowns of the variable."""
        return self.whole


def _particles(variable: Variable, system: System, pointer: str) -> Ints:
    found = np.asarray(variable.particles)
    count = system.slots.count
    if len(found) and found.max() >= count:
        raise InputError(f"{pointer}/particles", f"particle {found.max()} does not exist; there are {count}, from 0")
    if len(np.unique(found)) < len(found) or not len(found):
        raise InputError(f"{pointer}/particles", "a list of particles is expected, each once")
    return found


class Mass:
    """A variable that is the mass of some particles."""

    unit = "mass"

    def __init__(self, variable: Variable, system: System, pointer: str) -> None:
        self.variable, self.pointer = variable, pointer
        self.particles = _particles(variable, system, pointer)
        values = system.mass[self.particles][:, None]
        self.entries = Entries(values, tied(variable, len(values), np.array([0]), 1, pointer))
        self.shape = shape_of(1, self.entries.count, False)
        self.lower = LEAST * float(values.mean())

    def put(self, system: System, values: Floats) -> None:
        """Give the particles these masses."""
        scene, own = system.scene, self.entries.with_values(values)[:, 0]
        masses = np.broadcast_to(scene.masses, len(scene.particles)).astype(np.float64)
        masses[self.particles] = own
        system.mass[self.particles] = own
        system.mass[system.slots.first] = system.mass[system.slots.particles]
        system.scene = scene.replaced(masses=masses)

    def by_masses(self, slopes: Floats) -> Floats:
        """Derivatives (count,) by the unknowns, of derivatives (n,) by the masses of all particles."""
        tie = self.entries.tie[:, 0]
        kept = tie >= 0
        return np.asarray(np.bincount(tie[kept], slopes[self.particles[kept]], self.entries.count), np.float64)


class Drawn:
    """A variable that is where some particles are drawn; tied, they move together and the value is their shift."""

    unit = "length"

    def __init__(self, variable: Variable, system: System, pointer: str) -> None:
        if system.films is not None:
            said = (
                "drawn positions do not vary beside soap films, which have no form of their own; vary anchors, or the"
            )
            raise InputError(f"{pointer}/field", f"{said} tension")
        self.variable, self.pointer = variable, pointer
        self.particles = _particles(variable, system, pointer)
        columns = np.array([AXES[a] for a in variable.axes])
        self.home = system.points[self.particles].copy()
        self.shifts = variable.tie != "each"
        values = np.zeros_like(self.home) if self.shifts else self.home
        self.entries = Entries(values, tied(variable, len(self.home), columns, 3, pointer))
        self.shape = shape_of(len(columns), self.entries.count, variable.axes)
        self.lower = -np.inf
        self.first = system.points.copy()
        self.given = system.scene
        self.rows = {i: system.places.elements(f) for i, f in enumerate(system.scene.forces) if _drawn(f)}

    def tie(self, count: int) -> Ints:
        """The unknown of each coordinate (count, 3) of all particles, -1 for none."""
        found = np.full((count, 3), -1)
        found[self.particles] = self.entries.tie
        return found

    def put(self, system: System, values: Floats) -> None:
        """Draw the particles there: what the scene measures from its drawn form changes."""
        own = self.entries.with_values(values)
        system.x[self.particles] = self.home + own if self.shifts else own
        system.places.x = system.points.copy()
        shift = system.points - self.first
        take_again(system, self._moved(system, shift))

    def _moved(self, system: System, shift: Floats) -> Scene:
        """The scene with all coordinates of particles moved with them."""
        scene, first, meet = system.scene, self.given, system.places.vertices

        def along(points: Floats, which: Ints) -> Floats:
            which = which.reshape(points.shape[:-1])
            return points + np.where(which[..., None] >= 0, shift[which], 0.0)

        meshes = {
            name: Mesh(along(mesh.vertices, meet(name)), mesh.faces) if self._is_drawn(name) else mesh
            for name, mesh in first.meshes.items()
        }
        forces = list(scene.forces)
        for i, rows in self.rows.items():
            field = _drawn(first.forces[i])
            forces[i] = forces[i].replaced(**{field: along(getattr(first.forces[i], field), rows)})
        anchors = list(scene.anchors)
        for held in system.held:
            if held.number >= 0 and first.anchors[held.number].points is not None:
                points = np.asarray(first.anchors[held.number].points)
                if len(points) == len(held.particles):
                    anchors[held.number] = anchors[held.number].replaced(points=along(points, held.particles))
        particles = first.particles + shift[: len(first.particles)]
        return scene.replaced(particles=particles, meshes=meshes, forces=tuple(forces), anchors=tuple(anchors))

    def _is_drawn(self, name: str) -> bool:
        """Whether a mesh has elements of a force; others are geometry that stays in place."""
        return any(getattr(force, "mesh", None) == name for force in self.given.forces)

    def columns(self, system: System, skipped: set[int]) -> list[Any]:
        """What follows the variable: the parameters of each force, and the anchors that hold particles where they are
        drawn, without those that other variables move."""
        found: list[Any] = [
            DrawnColumn(self, system, group, part)
            for group in system.groups
            for part in group.parts
            if part.number >= 0 and not group.block.rooms
        ]
        tie = self.tie(system.slots.count)
        for held in system.held:
            free = held.number < 0 or self.given.anchors[held.number].targets is not None
            if not free and id(held) not in skipped and (tie[held.particles] >= 0).any():
                found.append(DrawnAnchor(self, held, tie))
        return found


def _drawn(force: Force) -> str:
    """The field of a force with coordinates of its own, if it has one."""
    return next((n for n in PLACES if n in ("points", "lines") and getattr(force, n, None) is not None), "")


class DrawnAnchor:
    """An anchor that holds its particles where they are drawn."""

    def __init__(self, drawn: Drawn, anchor: Held, tie: Ints) -> None:
        self.drawn, self.variable, self.anchor, self.lower = drawn, drawn.variable, anchor, -np.inf
        own = np.where(anchor.free == 0.0, tie[anchor.particles], -1)
        self.entries = Shared(anchor.targets.copy(), own, drawn.entries.count)

    def put(self, system: System) -> None:
        """Hold them where they are drawn now."""
        self.anchor.targets = np.ascontiguousarray(system.x[self.anchor.particles])


class DrawnColumn(Column):
    """The parameters of a force as they depend on where particles are drawn."""

    def __init__(self, drawn: Drawn, system: System, group: Group, part: Part) -> None:
        self.variable, self.pointer, self.factor = drawn.variable, drawn.pointer, 1.0
        self.drawn, self.number, self.group, self.part = drawn, part.number, group, part
        self.lower, self.by_element = -np.inf, False
        self.elements = len(part.inputs)
        tie = drawn.tie(system.slots.count)
        self.entries = Shared(np.zeros(tie.shape), tie, drawn.entries.count)
        self.reach = STEP * system.size
        self._own: list[Ints] = []

    def changed(self, scene: Scene, unknowns: Floats) -> Force:
        """The force as it is: its parameters change alone."""
        return scene.forces[self.number]

    def numbers(self, unknowns: Floats) -> Floats:
        """No column of the force changes."""
        return self.entries.values

    def step(self, unknown: int) -> float:
        """A length, small for derivatives."""
        return self.reach

    def slope(self, system: System, change: Floats, give: Give) -> Floats:
        """By how much what `give` says changes as particles are drawn elsewhere by a change (n, 3)."""
        places, first, given = system.places, system.places.x, []
        for way in (1.0, -1.0):
            places.x = first + way * change
            force = self.force.replaced()  # another one, so that it is compiled again
            given.append(give(force, compiled(system, self.group, self.number, force)))
        places.x = first
        return np.asarray(0.5 * (given[0] - given[1]))

    def differences(self, system: System, give: Give, *, linear: bool = False) -> Iterator[tuple[Ints, Floats]]:
        """Derivatives of what `give` says of each element, with the unknown by which."""
        tie, index = self.entries.tie, self._index
        if not self._own:
            self._own = self._apart(system)
        for particles in self._own:
            some = np.zeros(len(tie), dtype=bool)
            some[particles] = True
            mine = some[index]
            at = index[np.arange(len(index)), mine.argmax(axis=1)]
            for axis in range(3):
                if not (tie[particles, axis] >= 0).any():
                    continue
                change = np.zeros(tie.shape)
                change[some, axis] = np.where(tie[some, axis] >= 0, self.reach, 0.0)
                unknown = np.where(mine.any(axis=1), tie[at, axis], -1)
                if len(particles) == 1:
                    unknown = np.full(len(index), tie[particles[0], axis])
                yield unknown, self.slope(system, change, give) / self.reach

    @cached_property
    def _index(self) -> Ints:
        """The particles of each element."""
        return np.asarray(self.group.particles[self.part.rows])

    def _apart(self, system: System) -> list[Ints]:
        """Lists of particles that vary, no two of them in one element; one by one where elements depend on others."""
        varying = np.flatnonzero((self.entries.tie >= 0).any(axis=1))
        lists = coloured(self._index, varying, len(self.entries.tie))
        steps = self.reach * np.random.default_rng(SEED).uniform(-1.0, 1.0, self.entries.tie.shape)
        change = np.where(self.entries.tie >= 0, steps, 0.0)

        def parameters(_: Any, block: Any) -> Floats:
            return np.asarray(block.parameters)

        together = self.slope(system, change, parameters)
        total = np.zeros(together.shape)
        for particles in lists:
            one = np.zeros(change.shape)
            one[particles] = change[particles]
            slope = self.slope(system, one, parameters)
            mine = np.isin(self._index, particles).any(axis=1)
            if slope[~mine].any():
                return [np.array([p]) for p in varying]
            total += slope
        largest = np.abs(together).max(axis=0, initial=0.0)
        same = (np.abs(total - together) <= ALIKE * largest).all()
        return lists if same and not self._reads_others(system, lists, parameters) else [np.array([p]) for p in varying]

    def _reads_others(self, system: System, lists: list[Ints], parameters: Give) -> bool:
        """Whether elements change with particles of a list that are not theirs: half of each list changes alone."""
        rng = np.random.default_rng(SEED)
        for particles in lists:
            some = particles[rng.random(len(particles)) < 0.5]
            change = np.zeros(self.entries.tie.shape)
            change[some] = self.reach * rng.uniform(0.5, 1.0, (len(some), 3))
            others = ~np.isin(self._index, some).any(axis=1)
            if self.slope(system, change, parameters)[others].any():
                return True
        return False


def coloured(index: Ints, varying: Ints, count: int) -> list[Ints]:
    """Lists of the `varying` particles, of `count`, no two of them in one row of `index`; greedy."""
    from scipy.sparse import csr_matrix

    at = csr_matrix(
        (np.ones(index.size), (np.repeat(np.arange(len(index)), index.shape[1]), index.ravel())), (len(index), count)
    )
    near = (at.T @ at).tocsr()
    colour = np.full(count, -1)
    kept = varying[np.diff(near.indptr)[varying] > 0]
    for particle in kept:
        taken = set(colour[near.indices[near.indptr[particle] : near.indptr[particle + 1]]].tolist())
        colour[particle] = next(c for c in range(len(taken) + 1) if c not in taken)
    return [np.flatnonzero(colour == c) for c in range(int(colour.max(initial=-1)) + 1)]
