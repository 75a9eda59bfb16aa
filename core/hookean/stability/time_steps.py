"""Stability: the longest time step that an explicit scheme can take in a scene, before the motion explodes.

The highest frequency depends on the shape. Where every force has a stiffness that no shape exceeds (`Force.steady`),
one step holds in all motions; else a step holds in the shape that it was found for.
"""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from hookean.stability.limit import Limit
from hookean.system.group import Group, Part
from hookean.system.state import State
from hookean.system.system import System

if TYPE_CHECKING:
    from hookean.solvers.base import Solver

Floats = NDArray[np.float64]
VERLET = Limit()
DAMPED, UNDAMPED = 0.9, 0.5  # parts of the step that is stable for small vibrations, for motions of any size
LIGHT = 0.02  # part of the highest frequency below which a rate of damping counts as none
MOST_PARTS = 10_000  # of a step that are taken; one that needs more covers less time
LEAST_MOST = 200  # of them in any system
MOST_WORK = 50_000_000  # parts of a frame times the numbers of indices: less than a second
MANY = 64  # times MOST_PARTS, or the parts that a shape asks for
CAUTION = 0.8  # of the step that held in a shape, for the shapes that may follow


def critical_time_step(omega: float, damping_ratio: float = 0.0) -> float:
    """(2 / omega) (sqrt(1 + zeta^2) - zeta) [time]: the limit of central differences with explicit damping.

    `omega` [1/time] is the highest circular frequency, `damping_ratio` zeta [-] its part of critical damping. The
    `verlet` solver treats damping to second order and stays stable up to this step and a little beyond.
    """
    # 1 / (sqrt + zeta) is the same number without cancellation
    return 2.0 / omega / float(np.hypot(1.0, damping_ratio) + damping_ratio) if omega > 0.0 else np.inf


def highest_rates(system: System, state: State) -> tuple[float, float]:
    """Largest eigenvalues of M^-1 K [1/time^2] and of M^-1 C [1/time] for small vibrations about a state.

    K is every force's tangent stiffness, hinges included, C the damping along springs and the drag. Held axes do not
    move.
    """
    stiffness, damping, drag = _rates(system, state)
    return stiffness, damping + drag


def _rates(system: System, state: State) -> tuple[float, float, float]:
    """The same, with the rates of damping along springs and of the drag by themselves."""
    matrix, free, scale = _scaled_stiffness(system, state)
    stiffness = 0.0 if matrix is None or matrix.nnz == 0 else max(_largest(matrix), 0.0)
    drag = system.drag * float(scale.max(initial=0.0)) ** 2
    if not system.damped or not len(free):
        return stiffness, 0.0, drag

    def damping(u: Floats) -> Floats:
        motion = np.zeros(state.x.size)
        motion[free] = u.ravel() * scale
        return _damping_force(system, state, motion.reshape(state.x.shape)).ravel()[free] * scale

    from scipy.sparse.linalg import LinearOperator

    operator = LinearOperator((len(free), len(free)), matvec=damping, dtype=np.float64)
    return stiffness, max(_largest(operator), 0.0), drag


def highest_mode(system: System, state: State) -> tuple[float, float]:
    """Highest circular frequency [1/time] of small vibrations about a state, and the damping ratio [-] it would have
    with the largest damping of any motion."""
    stiffness, damping = highest_rates(system, state)
    omega = float(np.sqrt(stiffness))
    return omega, damping / (2.0 * omega) if omega > 0.0 else 0.0


def stable_time_step(system: System, state: State, limit: Limit = VERLET) -> float:
    """The step [time] up to which explicit time steps are stable in the shape of a state; infinite without stiffness.

    `limit` is that of the scheme; verlet: dt^2 k / 4 + dt c / 2 <= 1 with the highest rates k of stiffness and c of
    damping, drag included.
    """
    return limit.step(*_rates(system, state))


def time_step_of_all_shapes(system: System, state: State, limit: Limit = VERLET) -> float:
    """The step [time] up to which small vibrations about every shape of a system are stable; 0 where some force
    stiffens without bound.

    A spring's tangent is k along it and k (1 - L0 / l) across, so k at most in any direction. The highest rate of any
    shape is at most that of springs of rest length 0, whose matrix no shape changes.
    """
    if not system.steady:
        return 0.0
    groups = [g for g in system.groups if not g.cls.constant]
    moving = np.flatnonzero(state.moving)
    scale = 1.0 / np.sqrt(system.mass[moving])
    stiffness = _steady_rate(moving, scale, [(g, _column(g, g.cls.steady)) for g in groups])
    damping = _steady_rate(moving, scale, [(g, _column(g, "damping")) for g in groups if g.damped])
    return limit.step(stiffness, damping, system.drag * float(scale.max(initial=0.0)) ** 2)


def warning(system: System, state: State, method: Solver) -> str:
    """A sentence if the time step that a scene gives is too long for small vibrations about a shape, with one that
    leaves room for large motions; else empty. Steps that are divided are never too long."""
    settings, unit = system.scene.settings, system.scene.units.time
    if settings.divide_steps or settings.time_step <= method.limit.step(*Bounds.of(system, state).highest(state)):
        return ""
    rates = _foreseen(system, state)
    stable = method.limit.step(*rates)
    if settings.time_step <= stable:
        return ""
    steady = time_step_of_all_shapes(system, state, method.limit)
    damped = margin(*Bounds.of(system, state).extremes(state)) == DAMPED
    holds = min(DAMPED * steady if damped and steady else roomy(system, state, method), CAUTION * settings.time_step)
    where = "in any motion" if damped and steady else "in most motions"
    cause, less = _cause(system, state, rates)
    return (
        f"/settings/time_step: {settings.time_step:g} {unit} is too large for {cause}. Steps up to "
        f"{floored(holds):.4g} {unit} are stable {where}, {floored(stable):.4g} {unit} in small ones: use one of "
        f"these, or omit time_step{less}"
    )


def too_long(system: System, state: State, method: Solver, held: tuple[float, float]) -> str:
    """A sentence on a given time step that a motion which led to a shape did not bear; `held` is a step that did, and
    the time for which (see `trial`), 0 where none is known."""
    settings, unit = system.scene.settings, system.scene.units.time
    rates = _rates(system, state)
    stable = method.limit.step(*rates)
    cause, less = _cause(system, state, rates) if settings.time_step > stable else ("this motion", "")
    step, time = held
    small = f", {floored(stable):.4g} {unit} in small ones" if stable < np.inf else ""
    advice = f"Steps of {step:.4g} {unit} were stable for {time:.4g} {unit} of the same motion{small}: use one"
    if step == 0.0:
        advice = f"No stable step is known{small and '; steps up to ' + small[2:]}: use a smaller one"
    given = f"/settings/time_step: {settings.time_step:g} {unit}"
    return f"{given} is too large for {cause}. {advice}, or omit time_step{less}"


def roomy(system: System, state: State, method: Solver) -> float:
    """A step [time] that is short enough for large motions from a shape, as far as can be known before they happen."""
    bounds = Bounds.of(system, state)
    steady = time_step_of_all_shapes(system, state, method.limit)
    stable = steady or CAUTION * method.limit.step(*_foreseen(system, state))
    damped = margin(*bounds.extremes(state)) == DAMPED
    return (DAMPED if damped else 0.5 * UNDAMPED) * stable


def _cause(system: System, state: State, rates: tuple[float, float, float]) -> tuple[str, str]:
    """What a time step is too large for, and what else to do about it."""
    # by the larger part of the limit: overdamped motion is limited by its damping
    what = "damping" if 0.5 * (rates[1] + rates[2]) > np.sqrt(rates[0]) else "stiffness"
    where = _greatest(system, state, what)
    what = "drag" if where == "/settings/drag" else what
    return f"this mass and the {what} of {where}; the motion will be unstable", f", or use more mass or less {what}"


def _greatest(system: System, state: State, what: str) -> str:
    """What gives a particle the most `stiffness` or `damping` for its mass: /forces/1, springs "cable"."""
    moving = state.moving
    found, most = "this scene", 0.0
    if what == "damping" and system.drag > 0.0 and moving.any():
        found, most = "/settings/drag", float(system.drag / system.mass[moving].min())
    for group, memory in zip(system.groups, state.memory, strict=True):
        for part in group.parts:
            rows = _lumped(system, state, group, part, memory) if what == "stiffness" else _damping(system, group, part)
            rate = float((rows / system.mass * moving).max(initial=0.0))
            if rate > most and part.number >= 0:
                kind, name = group.cls.kind_name, part.force.name
                found, most = f"/forces/{part.number}, {kind}" + (f' "{name}"' if name else ""), rate
    return found


def _lumped(system: System, state: State, group: Group, part: Part, memory: Floats) -> Floats:
    """Lumped stiffness (n,) of one force."""
    alone = copy(system)
    rows = slice(0, part.rows.stop - part.rows.start)
    alone.groups = [Group(group.cls, group.of(part), [Part(part.number, part.force, rows, part.inputs)])]
    return alone.evaluate(replace(state, memory=[memory[part.rows]]))[1]


def _damping(system: System, group: Group, part: Part) -> Floats:
    """A bound (n,) of the damping of one force: row sums."""
    block = group.of(part)
    if "damping" not in block.names:
        return np.zeros(len(system.x))
    c = block.parameters[:, block.names.index("damping")]
    ends = block.indices.shape[1]
    return np.asarray(np.bincount(block.indices.ravel(), np.repeat(ends * c, ends), len(system.x)), np.float64)


def longest(system: System, state: State, limit: Limit) -> float:
    """The step [time] that hookean takes itself. Where every force is steady it holds in motions of any size, else
    about the shape of a state and somewhat stiffer ones."""
    holds = Bounds.of(system, state).holds(state, limit)
    if system.steady or system.scene.settings.time_step <= holds:
        return holds
    return max(holds, min(CAUTION * stable_time_step(system, state, limit), contact_step(system, state, limit)))


def contact_step(system: System, state: State, limit: Limit) -> float:
    """The step [time] that holds while what may touch does, wherever it is now; infinite without contacts.

    At this step nothing that a contact can stop passes through it: at omega dt <= 1 a speed v moves it by v / omega at
    most, which is how deep it comes.
    """
    bounds = _contacts(system, state)
    return np.inf if bounds is None else bounds.holds(state, limit)


def _contacts(system: System, state: State) -> Bounds | None:
    """Bounds with the stiffness of contacts alone, whether they touch or not; None without any. A free pair with a
    contact k between two particles of mass m vibrates with 2 k / m, twice what either has."""
    groups = [(g, memory) for g, memory in zip(system.groups, state.memory, strict=True) if g.cls.touches]
    if not groups:
        return None
    alone = copy(system)
    alone.groups = [group for group, _ in groups]
    w = alone.evaluate(replace(state, memory=[memory for _, memory in groups]))[1]
    return Bounds.of(system, state, 2.0 * w)


def _foreseen(system: System, state: State) -> tuple[float, float, float]:
    """`_rates`, with the stiffness of contacts as if they touched."""
    (stiffness, damping, drag), bounds = _rates(system, state), _contacts(system, state)
    return max(stiffness, bounds.highest(state)[0] if bounds is not None else 0.0), damping, drag


def parts(system: System, state: State, limit: Limit) -> int:
    """In how many parts a time step is divided, where it may be, so that they hold; `most_parts` of them are taken."""
    step = system.scene.settings.time_step
    if not system.scene.settings.divide_steps or step <= (holds := longest(system, state, limit)):
        return 1
    return int(np.ceil(step / holds))


def most_parts(system: System) -> int:
    """How many parts of a step are taken at most: so many that a frame is not long to compute. A number that follows
    from the system alone, so that the same scene moves in the same way on every machine."""
    size = 100 + sum(group.block.indices.size for group in system.groups)
    return int(np.clip(MOST_WORK // (size * system.scene.settings.sub_iterations), LEAST_MOST, MOST_PARTS))


def often(system: System, state: State, method: Solver) -> int:
    """Parts of a step beyond which it is not their length that feeds energy into a motion about a shape."""
    return MANY * max(MOST_PARTS, parts(system, state, method.limit))


def slowed(system: System, parts: int) -> str:
    """A sentence if a time step needs more parts than are taken; else empty."""
    if parts <= (most := most_parts(system)):
        return ""
    step, unit = system.scene.settings.time_step, system.scene.units.time
    return (
        f"/settings/time_step: each step covers {step * most / parts:.3g} {unit}, not {step:g} {unit}: motion is "
        f"{parts / most:.3g} times slower than asked for. Stable steps with this stiffness, damping and mass are "
        f"{step / parts:.3g} {unit} long, and {most:,} are computed; use more mass or less stiffness for more"
    )


def margin(stiffness: float, damping: float) -> float:
    """The part of the stable step that holds for motions of any size, by the highest rate of stiffness [1/time^2] and
    the least of damping [1/time].

    Large motions meet nonlinear resonances below the limit of small vibrations: of order n at omega dt = 2 sin(pi / n),
    which is 0.87, 0.71, 0.59 and 0.5 of it for n = 3 to 6. Light damping takes what they feed in. Source: Schlick et
    al., "Nonlinear resonance artifacts in molecular dynamics simulations", 1998.
    """
    return DAMPED if damping >= LIGHT * np.sqrt(stiffness) else UNDAMPED


@dataclass(frozen=True)
class Bounds:
    """Bounds of the rates of stiffness [1/time^2], damping along springs and drag [1/time] by particle (n,), in one
    pass: no eigenvalue of M^-1 K exceeds the largest w / m (Gershgorin), and that of a spring's damping is 2 c."""

    stiffness: Floats
    damping: Floats
    drag: Floats

    @classmethod
    def of(cls, system: System, state: State, w: Floats | None = None) -> Bounds:
        """Those of a shape, and of every shape where all forces are steady; `w` is its lumped stiffness, if known."""
        damping = np.zeros(len(system.mass))
        for group in system.groups:
            if group.damped:
                index, c = group.block.indices, _column(group, "damping")
                count = index.shape[1]
                damping += np.bincount(index.ravel(), np.repeat(count * c, count), len(damping))
        w = system.evaluate(state)[1] if w is None else w
        return cls(w / system.mass, damping / system.mass, system.drag / system.mass)

    def highest(self, state: State) -> tuple[float, float, float]:
        """Of all that may move."""
        moving = state.moving
        stiffness, damping, drag = (r[moving].max(initial=0.0) for r in (self.stiffness, self.damping, self.drag))
        return float(stiffness), float(damping), float(drag)

    def least(self, state: State) -> float:
        """The least rate of damping of all that may move [1/time]."""
        return float((self.damping + self.drag)[state.moving].min(initial=np.inf))

    def extremes(self, state: State) -> tuple[float, float]:
        """The highest rate of stiffness and the least of damping: what `margin` depends on."""
        return self.highest(state)[0], self.least(state)

    def holds(self, state: State, limit: Limit) -> float:
        """The step [time] that holds in motions of any size, in the shape that this was found for."""
        return margin(*self.extremes(state)) * limit.step(*self.highest(state))


def _column(group: Group, name: str) -> Floats:
    return group.block.parameters[:, group.block.names.index(name)]


def _steady_rate(moving: NDArray[np.int64], scale: Floats, elements: list[tuple[Group, Floats]]) -> float:
    """The highest rate of elements of one or two particles with a stiffness each, the same in all directions."""
    import scipy.sparse as sparse

    size = int(moving.max(initial=-1)) + 1
    whole = sparse.csr_matrix((size, size))
    for group, k in elements:
        index = group.block.indices
        ends = np.minimum(index, size)  # what is beyond does not move
        signs = np.tile([1.0, -1.0][: index.shape[1]], len(index))
        rows = np.repeat(np.arange(len(index)), index.shape[1])
        spread = sparse.csr_matrix((signs, (rows, ends.ravel())), shape=(len(index), size + 1))[:, :size]
        whole = whole + spread.T @ sparse.diags(k) @ spread
    if not len(moving):
        return 0.0
    diagonal = sparse.diags(scale)
    return max(_largest((diagonal @ whole[moving][:, moving] @ diagonal).tocsr()), 0.0)


def _largest(operator: Any) -> float:
    """Largest eigenvalue of a symmetric matrix or operator."""
    from scipy.sparse.linalg import ArpackNoConvergence, eigsh

    size = operator.shape[0]
    if size <= 60:
        return float(np.linalg.eigvalsh(operator @ np.eye(size))[-1])
    start = 1.0 + 0.5 * np.sin(np.arange(size) * 12.9898)
    if not (operator @ start).any():
        return 0.0
    try:
        return float(eigsh(operator, k=1, which="LA", v0=start, tol=1e-6, return_eigenvectors=False)[0])
    except ArpackNoConvergence as error:
        # Ritz values come from below; a tenth more is on the safe side
        found = error.eigenvalues
        return 1.1 * float(found[-1]) if len(found) else float(np.abs(operator @ np.ones(size)).max())


def floored(value: float) -> float:
    """Rounded down to four digits, so that the number reported is itself safe."""
    digits = 10.0 ** (np.floor(np.log10(value)) - 3)
    return float(np.floor(value / digits * (1 + 1e-12)) * digits)


def _scaled_stiffness(system: System, state: State) -> tuple[Any, NDArray[np.int64], Floats]:
    import scipy.sparse as sparse

    free = np.flatnonzero(state.free.ravel() > 0)
    number = np.full(state.x.size, -1)
    number[free] = np.arange(len(free))
    rows, columns, values = [], [], []
    for group, memory in system.elements(state.x, state.memory):
        if group.cls.role == "load" or not len(group.block.indices):
            continue
        blocks = system.stiffness_blocks(group, state, memory)
        index = group.block.indices
        mine = number[(3 * index[:, :, None] + np.arange(3)).reshape(len(index), -1)]
        row, column = np.repeat(mine, mine.shape[1], axis=1).ravel(), np.tile(mine, (1, mine.shape[1])).ravel()
        take = (row >= 0) & (column >= 0)
        rows.append(row[take])
        columns.append(column[take])
        values.append(blocks.ravel()[take])
    scale = 1.0 / np.sqrt(np.repeat(system.mass, 3)[free])
    if not rows:
        return None, free, scale
    whole = sparse.csr_matrix(
        (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))), shape=(len(free), len(free))
    )
    diagonal = sparse.diags(scale)
    return (diagonal @ whole @ diagonal).tocsr(), free, scale


def _damping_force(system: System, state: State, motion: Floats) -> Floats:
    """C u of a motion u (n, 3), without drag: damping forces are linear in the velocity."""
    trial = state.copy()
    trial.v = motion
    moving, _, _ = system.evaluate(trial, still=False)
    resting, _, _ = system.evaluate(trial)
    return resting - moving
