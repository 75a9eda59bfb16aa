"""System: a scene compiled once to contiguous arrays. Nothing validates after this point."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from hookean.compiled import dispatch
from hookean.errors import InputError
from hookean.forces import Block, Force
from hookean.scene.report import Report
from hookean.scene.scene import Scene
from hookean.system import components
from hookean.system.components import Components
from hookean.system.state import State
from hookean.system.weld import Welded

if TYPE_CHECKING:
    from hookean.films import Films

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass
class Part:
    """The elements of one force inside a group: `rows` of the group's arrays, and which inputs they came from."""

    number: int  # index in scene.forces, or -1 for the floor of the settings
    force: Force
    rows: slice
    inputs: Ints  # element of the input of every row


@dataclass
class Group:
    """All elements that share a kernel, in one block."""

    cls: type[Force]
    block: Block
    parts: list[Part]

    @property
    def damped(self) -> bool:
        """Whether it reads the velocities."""
        return self.cls.damped and self._uses("damping")

    @property
    def yields(self) -> bool:
        """Whether it may change at the end of a step because of what it remembers."""
        return self.cls.remembers and any(self._uses(column) for column in self.cls.yielding)

    def _uses(self, column: str) -> bool:
        """Whether the parameters of this name are not all zero; yes where there are none of this name."""
        columns = [i for i, name in enumerate(self.block.names) if name == column]
        return not columns or any(np.count_nonzero(self.block.parameters[:, i]) for i in columns)

    def of(self, part: Part) -> Block:
        """The part's own rows, as views."""
        return self.block.some(part.rows)


@dataclass
class Held:
    """One anchor of the scene, compiled: its particles, targets and axes."""

    number: int
    particles: Ints
    targets: Floats
    free: Floats  # (3,) 0 where held
    name: str = ""


@dataclass
class System:
    """Arrays of one scene: start positions `x` (n, 3), masses (n,), groups of elements, anchors."""

    scene: Scene
    x: Floats
    v: Floats
    mass: Floats
    groups: list[Group]
    contacts: list[Group]
    held: list[Held]
    carried: list[Ints]
    places: Welded
    load_count: Floats
    drag: float = 0.0
    _components: Components | None = None
    _films: Films | None = field(default=None, init=False, repr=False)

    @property
    def report(self) -> Report:
        """What welding did, and what a person should know."""
        return self.places.report

    @property
    def size(self) -> float:
        """Length scale of the model [length]: the diagonal of its start and its anchors' targets, or how far from
        the origin it is."""
        box = np.full((2, 3), -np.inf)
        for points in (self.x, *(anchor.targets for anchor in self.held)):
            dispatch.compiled(widen)(points, box)
        return math.hypot(*(box[0] + box[1]).tolist()) or float(np.abs(box).max()) or 1.0

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
        if not any(g.cls.is_film and len(g.block.indices) for g in self.groups):
            return None
        from hookean.films import Films

        if self._films is None or self._films.stale:
            self._films = Films(self)
        return self._films

    def start(self) -> State:
        """The state before the first iteration: anchors at their targets, memories empty."""
        free = np.ones(self.x.shape)
        state = State(x=self.x.copy(), v=self.v.copy(), free=free)
        for anchor in self.held:
            hold(state, anchor)
        self.put_outside(state)
        state.memory = [np.zeros(g.block.memory.shape) for g in self.groups]
        return state

    def components(self, state: State) -> Components:
        """The connected components of what may move."""
        if self._components is None or not dispatch.same(self._components.free, state.free):
            self._components = components.components(self.groups, state.free)
        return self._components

    def put_outside(self, state: State) -> None:
        """Put particles that contacts do not allow where they are onto the surface of the contact."""
        for group in self.contacts:
            hook = dispatch.compiled(group.cls.impact, "impact")
            hook(state.x, state.v, state.v, state.x, state.v, state.free, 0.0, group.block.parameters)

    def evaluate(
        self, state: State, *, only: str = "", still: bool = True, loads: Floats | None = None
    ) -> tuple[Floats, Floats, Floats]:
        """Forces (n, 3) on the particles, lumped stiffness (n,) and the energy of each group.

        `only` restricts to groups of one role; `still` leaves damping out; to `loads` (n, 3) the part of the forces
        that is loads is added.
        """
        f, w = np.zeros(self.x.shape), np.zeros(len(self.x))
        v = np.zeros(self.x.shape) if still else state.v
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
        for group in self.contacts:
            hook = dispatch.compiled(group.cls.support, "support")
            hook(state.x, still, f, carried, state.free, self.mass, 0.0, group.block.parameters)
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

    def no_tangent(self, *, sparse: bool = True) -> str:
        """Why the system has no tangent, as a sentence without its full stop; empty where it has one."""
        found = (group.cls.no_tangent(group.block, sparse=sparse) for group in self.groups)
        return next((reason for reason in found if reason), "")

    def brace(self) -> None:
        """Let forces know which particles the scene's anchors hold on some axis."""
        self._components = None  # a patch may have changed which elements belong together
        held = np.zeros(len(self.x), dtype=bool)
        for anchor in self.held:
            if anchor.number >= 0 and (anchor.free == 0).any():
                held[anchor.particles] = True
        for group in self.groups:
            group.cls.brace(group.block, held)

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


def hold(state: State, anchor: Held) -> None:
    """Hold an anchor's particles at its targets, on its axes."""
    held, particles = anchor.free == 0, anchor.particles
    for values, there in ((state.free, 0.0), (state.x, anchor.targets), (state.v, 0.0)):
        values[particles] = there if held.all() else np.where(held, there, values[particles])


def compile(scene: Scene) -> System:
    """Compile a scene; raises InputError if its parts are inconsistent, or it is not a Scene."""
    if not isinstance(scene, Scene):
        said = f"a Scene is expected, not a {type(scene).__name__}; make one with hookean.Scene.read(...)"
        raise InputError("scene", said)
    welded = Welded(scene)
    x = welded.x
    if not len(x):
        raise InputError("/particles", "the scene has no particles; give particles, or a force with lines or a mesh")
    given = list(enumerate(scene.forces))
    if scene.settings.floor is not None:
        given.append((-1, scene.settings.floor))
    groups, contacts = _groups(given, welded)
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
    held = _anchors(welded)
    welded.report.settle(strict=scene.strict, held=any(len(anchor.particles) for anchor in held))
    carried = [_carried(welded, i) for i in range(len(scene.geometry))]
    system = System(scene, np.ascontiguousarray(x), v, mass, groups, contacts, held, carried, welded, load_count)
    system.drag = scene.settings.drag
    system.brace()
    _warn(system)
    return system


def _groups(given: list[tuple[int, Force]], welded: Welded) -> tuple[list[Group], list[Group]]:
    """Blocks of all forces, joined where they share a kernel."""
    joined: dict[type[Force], list[tuple[int, Force, Block, Ints]]] = {}
    for number, force in given:
        pointer = f"/forces/{number}" if number >= 0 else "/settings/floor"
        block = welded.block(force, pointer)
        welded.check_force(force, pointer)
        inputs = np.arange(len(block.indices))
        if block.indices.min(initial=0) < 0:
            inputs = np.flatnonzero((block.indices >= 0).all(axis=1))
            block = block.some(inputs)
        joined.setdefault(type(force), []).append((number, force, block, inputs))
    groups: list[Group] = []
    contacts: list[Group] = []
    for cls, members in joined.items():
        parts: list[Part] = []
        start = 0
        for number, force, block, inputs in members:
            parts.append(Part(number, force, slice(start, start + len(block.indices)), inputs))
            start += len(block.indices)
        blocks = [block for _, _, block, _ in members]
        indices = np.ascontiguousarray(np.concatenate([b.indices for b in blocks]))  # may be the scene's own
        whole = replace(blocks[0], indices=indices, plan=[])
        if len(blocks) > 1:
            whole.parameters = np.concatenate([b.parameters for b in blocks])
            whole.memory = np.concatenate([b.memory for b in blocks])
            whole.rooms = tuple(room for b in blocks for room in b.rooms)
        (groups if cls.kernel is not None else contacts).append(Group(cls, whole, parts))
    return groups, contacts


def _anchors(welded: Welded) -> list[Held]:
    held = []
    for i, anchor in enumerate(welded.scene.anchors):
        if anchor.particles is not None:
            particles = np.asarray(anchor.particles)
        else:
            points = np.asarray(anchor.points)
            particles = welded.meet(points)
            welded.check(f"/anchors/{i}/points", anchor.name, points, particles, "point", "anchor")
        met = particles >= 0
        targets = welded.x[particles] if anchor.targets is None else np.asarray(anchor.targets)
        free = np.array([0.0 if axis in anchor.axes else 1.0 for axis in "xyz"])
        held.append(Held(i, particles[met], np.ascontiguousarray(targets[met]), free, anchor.name))
    return held


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


def coincide(x, indices, rest, touched, same, closed):  # type: ignore[no-untyped-def]
    """Note which particles elements touch, which of those between two begin and end at one, and which of the others
    have a rest length and no length at the start; how many of each."""
    alike, short = 0, 0
    for e in range(indices.shape[0]):
        for j in range(indices.shape[1]):
            touched[indices[e, j]] = 1
        if indices.shape[1] == 2:
            a, b = np.uint64(indices[e, 0]), np.uint64(indices[e, 1])
            here = x[a, 0] == x[b, 0] and x[a, 1] == x[b, 1] and x[a, 2] == x[b, 2]
            same[e] = a == b
            closed[e] = here and a != b and rest[e] > 0.0
            alike += same[e]
            short += closed[e]
    return alike, short


def _rests(block: Block) -> Floats:
    """Rest lengths (m,) [length] of elements that have one, else zeros."""
    rest = [block.parameters[:, i] for i, name in enumerate(block.names) if name in ("rest_length", "rest_factor")]
    return np.asarray(rest[0] * rest[1]) if len(rest) == 2 else np.zeros(len(block.indices))


def _warn(system: System) -> None:
    """Warnings before a run: springs of zero length, loads on unsupported particles."""
    warnings = system.report.warnings
    touched = np.zeros(len(system.x), dtype=np.int8)
    for group in system.groups:
        if group.cls.role == "load":
            continue
        for part in group.parts:
            block = group.of(part)
            same, closed = np.zeros((2, len(block.indices)), dtype=np.int8)
            alike, short = dispatch.compiled(coincide)(system.x, block.indices, _rests(block), touched, same, closed)
            if alike:
                warnings.append(
                    f"/forces/{part.number}: {alike} of {len(same)} elements start and end at one particle (first: "
                    f"element {int(np.argmax(same))}) and have no length; lengthen them or lower weld_tolerance"
                )
            if short:
                warnings.append(
                    f"/forces/{part.number}: {short} of {len(closed)} elements have zero length (first: element "
                    f"{int(np.argmax(closed))}), so their forces have no direction; move their ends apart"
                )
    for anchor in system.held:
        if (anchor.free == 0).all():
            touched[anchor.particles] = 1
    alone = np.flatnonzero((system.load_count > 0) & (touched == 0))
    if len(alone) and not system.contacts:
        warnings.append(
            f"particle {alone[0]} carries a load but is unsupported: no spring, other force or anchor holds it"
            + (f" (and {len(alone) - 1} more)" if len(alone) > 1 else "")
        )
    if sum(len(group.parts) for group in system.groups if group.cls.role == "internal") > 1:
        from hookean.system.near_misses import near_misses

        warnings += near_misses(system)
