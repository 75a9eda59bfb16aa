"""System: a scene compiled once to contiguous arrays. Nothing validates after this point."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from hookean.compiled import dispatch
from hookean.errors import InputError
from hookean.scene.load_cases import case_loads
from hookean.scene.report import Report
from hookean.scene.scene import Scene
from hookean.system import components
from hookean.system.cautions import cautions
from hookean.system.components import Components
from hookean.system.group import Group, groups_of
from hookean.system.slots import Slots
from hookean.system.state import State
from hookean.system.weld import Welded

if TYPE_CHECKING:
    from hookean.films import Films

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

SUNK = 1e-9  # part of the size of a model below a contact that may be rounding


@dataclass
class Held:
    """One anchor of the scene, compiled: its particles, targets and axes."""

    number: int
    particles: Ints
    targets: Floats
    free: Floats  # (3,) 0 where held
    name: str = ""
    turning: Floats = field(default_factory=lambda: np.ones(3))  # (3,) 0 where rotations are held

    # lists: numpy takes five times as long to look at three numbers
    @property
    def whole(self) -> bool:
        """Whether it holds all axes."""
        return not any(self.free.tolist())

    @property
    def some(self) -> bool:
        """Whether it holds any axis."""
        return not all(self.free.tolist())

    @property
    def turns(self) -> bool:
        """Whether it holds rotations."""
        return not all(self.turning.tolist())


@dataclass
class System:
    """Arrays of one scene: start positions `x` (n, 3), masses (n,), groups of elements, anchors.

    Behind the rows of particles there are those of slots and references, where particles have orientations (`slots`).
    """

    scene: Scene
    x: Floats
    v: Floats
    mass: Floats
    groups: list[Group]
    contacts: list[Group]
    impulses: list[Group]
    held: list[Held]
    carried: list[Ints]
    places: Welded
    load_count: Floats
    slots: Slots
    drag: float = 0.0
    _components: Components | None = None
    _size: float | None = None
    _films: Films | None = field(default=None, init=False, repr=False)
    _braced: list[tuple[int, bytes, bytes]] | None = field(default=None, init=False, repr=False)

    @property
    def all_groups(self) -> list[Group]:
        """All elements of the scene: those with forces, contacts, impulses."""
        return self.groups + self.contacts + self.impulses

    @property
    def report(self) -> Report:
        """What welding did, and what a person should know."""
        return self.places.report

    @property
    def points(self) -> Floats:
        """Start positions of the particles, without slots."""
        return self.x[: self.slots.count]

    @property
    def size(self) -> float:
        """Length scale of the model [length]: the diagonal of its start and its anchors' targets, or how far from
        the origin it is."""
        if self._size is None:
            box = np.full((2, 3), -np.inf)
            for points in (self.points, *(anchor.targets for anchor in self.held)):
                dispatch.compiled(widen)(points, box)
            self._size = math.hypot(*(box[0] + box[1]).tolist()) or float(np.abs(box).max()) or 1.0
        return self._size

    @property
    def steady(self) -> bool:
        """Whether no shape stiffens any force beyond a bound that is known (`Force.steady`)."""
        return all(g.cls.constant or g.cls.steady for g in self.groups)

    @property
    def damped(self) -> bool:
        """Whether any force reads the velocities."""
        return any(g.damped for g in self.groups)

    @property
    def yields(self) -> bool:
        """Whether any force may change at the end of a step because of what it remembers."""
        return any(g.yields for g in self.groups)

    @property
    def films(self) -> Films | None:
        """Its soap films, and what counts at their particles; None where there are none."""
        for group in self.groups:
            if group.cls.is_film and len(group.block.indices):
                break
        else:
            return None
        from hookean.films import Films

        if self._films is None or self._films.stale:
            self._films = Films(self)
        return self._films

    @cached_property
    def _at_rest(self) -> Floats:
        """Velocities (n, 3) for kernels to read, which write none."""
        return np.zeros(self.x.shape)

    def start(self) -> State:
        """The state before the first iteration: anchors at their targets, memories empty."""
        state = State(x=self.x.copy(), v=self.v.copy(), free=np.ones(self.x.shape))
        self.hold(state)
        self.put_outside(state)
        state.memory = [np.zeros(g.block.memory.shape) for g in self.groups]
        return state

    def hold(self, state: State) -> None:
        """Hold what the anchors hold, where they hold it, and nothing else."""
        state.free[:] = 1.0
        self.slots.hold_references(state)
        for anchor in self.held:
            hold(state, anchor, self.slots)

    def components(self, state: State) -> Components:
        """The connected components of what may move."""
        if self._components is None or not dispatch.same(self._components.free, state.free):
            self._components = components.components(self.groups, state.free)
        return self._components

    def put_outside(self, state: State) -> None:
        """Put particles that contacts do not allow where they are onto the surface of the contact."""
        x, v, free = (rows[: self.slots.count] for rows in (state.x, state.v, state.free))
        for group in self.contacts:
            hook = dispatch.compiled(group.cls.impact, "impact")
            hook(x, v, v, x, v, free, 0.0, group.block.parameters)

    def sunk(self, state: State) -> tuple[int, float]:
        """The particle that lies deepest where contacts do not allow it, and how deep [length]; (-1, 0) where none lies
        deeper than rounding brings it."""
        if not self.contacts:
            return -1, 0.0
        other = replace(state, x=state.x.copy(), v=state.v.copy())
        self.put_outside(other)
        depth = np.linalg.norm(other.x - state.x, axis=1)[: self.slots.count]
        deepest = int(np.argmax(depth))
        return (deepest, float(depth[deepest])) if depth[deepest] > SUNK * self.size else (-1, 0.0)

    def evaluate(
        self, state: State, *, only: str = "", still: bool = True, loads: Floats | None = None
    ) -> tuple[Floats, Floats, Floats]:
        """Forces (n, 3) on the particles, lumped stiffness (n,) and the energy of each group.

        `only` restricts to groups of one role; `still` leaves damping out; to `loads` (n, 3) the part of the forces
        that is loads is added.
        """
        f, w = np.zeros(self.x.shape), np.zeros(len(self.x))
        v = self._at_rest if still else state.v
        energies = np.zeros(len(self.groups))
        for i, (group, memory) in enumerate(zip(self.groups, state.memory, strict=True)):
            if only and group.cls.role != only:
                continue
            kernel = dispatch.compiled(group.cls.kernel, "force")
            target = f if loads is None or group.cls.role != "load" else loads
            energies[i] = kernel(state.x, v, *group.cls.whole(group.block, memory), target, w)
        return (f if loads is None else f + loads), w, energies

    def support(self, state: State, f: Floats) -> Floats:
        """Take from `f` what contacts carry at rest; returns their force on the particles (n, 3)."""
        carried, still = np.zeros(f.shape), np.zeros(f.shape)
        rows = [a[: self.slots.count] for a in (state.x, still, f, carried, state.free, self.mass)]
        for group in self.contacts:
            hook = dispatch.compiled(group.cls.support, "support")
            hook(*rows, 0.0, group.block.parameters)
        return carried

    def remember(self, state: State) -> None:
        """Let the elements that remember take note of the shape (plastic rest lengths)."""
        for group, memory in zip(self.groups, state.memory, strict=True):
            if group.cls.end_of_step is not None:
                note = dispatch.compiled(group.cls.end_of_step, "remember")
                note(state.x, group.block.indices, group.block.parameters, memory)

    def element_forces(self, group: Group, state: State, memory: Floats) -> Floats:
        """Force of each element on each of its particles `(m, arity, 3)`: the kernel run on private copies."""
        b = group.block
        count, arity = b.indices.shape
        private = state.x.take(b.indices.ravel(), axis=0)  # many times quicker than an index
        index = np.arange(count * arity, dtype=np.int64).reshape(count, arity)
        f, w = np.zeros(private.shape), np.zeros(len(private))
        kernel = dispatch.compiled(group.cls.kernel, "force")
        kernel(private, np.zeros(private.shape), index, b.parameters, memory, f, w)
        return f.reshape(count, arity, 3)

    def elements(self, x: Floats, memory: list[Floats], *, sparse: bool = False) -> list[tuple[Group, Floats]]:
        """All groups with what they remember, for their tangent at `x`: elements that feel one another are gathered to
        larger ones, or if `sparse` joined by unknowns of their own (see `Force.gathered`)."""
        found: list[tuple[Group, Floats]] = []
        node = len(x)
        for group, own in zip(self.groups, memory, strict=True):
            gathered = group.cls.gathered(group.block, own, x, node if sparse else None)
            if gathered is None:
                found.append((group, own))
                continue
            found += [(Group(cls, block, []), block.memory) for cls, block in gathered]
            for _, block in gathered:
                node = max(node, int(block.indices.max(initial=-1)) + 1)
        return found

    def no_tangent(self, *, sparse: bool = True, steps: bool = False) -> str:
        """Why the system has no tangent, as a sentence without its full stop; empty where it has one. `steps`: whether
        one that Newton steps can use is enough."""
        asked = [group for group in self.groups if not (steps and group.cls.steps(group.block))]
        found = (group.cls.no_tangent(group.block, sparse=sparse) for group in asked)
        return next((reason for reason in found if reason), "")

    def brace(self, *, changed: bool = True) -> None:
        """Let forces know which particles the scene's anchors hold on some axis, and the masses of those that move;
        `changed`: whether elements may have other parameters than when this was called last."""
        self._size = None  # targets count
        anchors = [(anchor.number, anchor.free.tobytes(), anchor.particles.tobytes()) for anchor in self.held]
        if not changed and anchors == self._braced:
            return
        self._braced = anchors
        self._components = None  # a patch may have changed which elements belong together
        held, mass = np.zeros(len(self.x), dtype=bool), self.mass.copy()
        for anchor in self.held:
            if anchor.whole:
                mass[anchor.particles] = np.inf
            if anchor.number >= 0 and anchor.some:
                held[anchor.particles] = True
        for group in self.groups:
            group.cls.brace(group.block, held, mass)

    def stiffness_blocks(self, group: Group, state: State, memory: Floats) -> Floats:
        """Hessian of the energy of each element `(m, 3 arity, 3 arity)`, exact or by differences of its forces.

        For a group of `elements`: what feels one another is not gathered here.
        """
        b = group.block
        count, arity = b.indices.shape
        blocks = np.zeros((count, 3 * arity, 3 * arity))
        if group.cls.tangent is not None:
            return group.cls.tangent(b, state.x)
        if group.cls.hessian is not None:
            dispatch.compiled(group.cls.hessian, "hessian")(state.x, b.indices, b.parameters, memory, blocks)
            return blocks
        private = state.x.take(b.indices.ravel(), axis=0)  # many times quicker than an index
        if group.cls.role == "internal":  # the same anywhere, and far from the origin differences lose digits
            private -= np.repeat(private[::arity], arity, axis=0)
        index = np.arange(count * arity, dtype=np.int64).reshape(count, arity)
        kernel = dispatch.compiled(group.cls.kernel, "force")
        still, w = np.zeros(private.shape), np.zeros(len(private))
        reach = np.ptp(private.reshape(count, arity, 3), axis=1).max(axis=1) if count else np.zeros(0)
        step = 1e-6 * np.where(reach > 0, reach, 1.0)
        for i in range(arity):
            for c in range(3):
                sides = []
                for sign in (1.0, -1.0):
                    moved = private.copy()
                    moved[i::arity, c] += sign * step
                    f = np.zeros(private.shape)
                    kernel(moved, still, index, b.parameters, memory, f, w)
                    sides.append(f.reshape(count, -1))
                blocks[:, :, 3 * i + c] = (sides[1] - sides[0]) / (2.0 * step)[:, None]
        return 0.5 * (blocks + blocks.transpose(0, 2, 1))


def widen(points, box):  # type: ignore[no-untyped-def]
    """Widen a box, its largest coordinates and the negatives of its least ones, to hold points."""
    for i in range(points.shape[0]):
        for c in range(3):
            box[0, c] = max(box[0, c], points[i, c])
            box[1, c] = max(box[1, c], -points[i, c])


def hold(state: State, anchor: Held, slots: Slots) -> None:
    """Hold an anchor's particles at its targets, on its axes, and their rotations as they are."""
    held, particles, whole = anchor.free == 0, anchor.particles, anchor.whole
    if len(slots) and anchor.turns:
        turned = slots.rows(particles)
        for values in (state.free, state.v):
            values[turned[turned >= 0]] *= anchor.turning
    for values, there in ((state.free, 0.0), (state.x, anchor.targets), (state.v, 0.0)):
        values[particles] = there if whole else np.where(held, there, values[particles])


def a_scene(given: Any) -> Scene:
    """What is given, if it is a scene; else InputError."""
    if not isinstance(given, Scene):
        said = f"a Scene is expected, not a {type(given).__name__}; make one with hookean.Scene.read(...)"
        raise InputError("scene", said)
    return given


def compile(scene: Scene, *, empty: bool = False) -> System:
    """Compile a scene; raises InputError if its parts are inconsistent, it is not a Scene, or it has no particles,
    unless it may be `empty`, as one that is about to be drawn."""
    welded = Welded(a_scene(scene))
    if not len(welded.x) and not empty:
        said = "the scene has no particles; give particles, or a force with lines or a mesh"
        if scene.forces:
            kinds = ", ".join(dict.fromkeys(force.kind_name for force in scene.forces))
            said = f"the scene has no particles, and {kinds} alone create none; give their coordinates, or springs"
        raise InputError("/particles", said)
    later = case_loads(scene)
    given = [(i, force) for i, force in enumerate(scene.forces) if i not in later]
    if scene.settings.floor is not None:
        given.append((-1, scene.settings.floor))
    if scene.strict:
        for number in later:
            welded.check_place(scene.forces[number], f"/forces/{number}")
    groups, contacts, impulses, slots = groups_of(given, welded)
    x = slots.extended(welded.x)
    load_count = np.zeros(len(x))
    for group in groups:
        if group.cls.role == "load":
            load_count += np.bincount(group.block.indices.ravel(), minlength=len(x))
    v = np.zeros(x.shape)
    if scene.velocities is not None:
        v[: len(scene.velocities)] = scene.velocities
    mass = np.ones(len(x))
    if isinstance(scene.masses, np.ndarray):
        mass[: len(scene.masses)] = scene.masses
    else:
        mass[:] = scene.masses
    if len(slots):
        mass[slots.first] = mass[slots.particles]
    held = _anchors(welded)
    welded.report.settle(strict=scene.strict, held=any(len(anchor.particles) for anchor in held))
    carried = [_carried(welded, i) for i in range(len(scene.geometry))]
    system = System(
        scene, np.ascontiguousarray(x), v, mass, groups, contacts, impulses, held, carried, welded, load_count, slots
    )
    system.drag = scene.settings.drag
    system.brace()
    system.report.warnings += cautions(system)
    return system


def _anchors(welded: Welded) -> list[Held]:
    held = []
    for i, anchor in enumerate(welded.scene.anchors):
        if anchor.particles is not None:
            particles = np.asarray(anchor.particles)
        else:
            points = np.asarray(anchor.points)
            particles = welded.meet(points)
            welded.check(f"/anchors/{i}/points", anchor.name, points, particles, "point", "anchor")
            welded.check_nearest(f"/anchors/{i}/points", points, particles)
        met = particles >= 0
        targets = welded.x[particles[met]] if anchor.targets is None else np.asarray(anchor.targets)[met]
        free, turning = (axes_free(axes) for axes in (anchor.axes, anchor.rotations))
        held.append(Held(i, particles[met], np.ascontiguousarray(targets), free, anchor.name, turning))
    return held


def axes_free(held: str) -> Floats:
    """0 for each axis that is held, such as "xz", and 1 for the others (3,)."""
    return np.array([0.0 if axis in held else 1.0 for axis in "xyz"])


def _carried(welded: Welded, number: int) -> Ints:
    """Particles that carry a geometry's points; -1 where a point rides on none and stays."""
    item = welded.scene.geometry[number]
    if item.particles is not None:
        return np.asarray(item.particles)
    if item.mesh is not None:
        found = welded.vertices(item.mesh)
    else:
        found = welded.meet(np.asarray(item.points if item.points is not None else item.lines).reshape(-1, 3))
    if (found < 0).any():
        welded.report.warnings.append(
            f"/geometry/{number}: {int((found < 0).sum())} of {len(found)} points meet no particle and stay in place"
        )
    return found
