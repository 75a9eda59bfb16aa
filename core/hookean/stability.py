"""Stability: the largest time step an explicit scheme can take in a scene, told before it explodes."""

from __future__ import annotations

from copy import copy
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from hookean.state import State
from hookean.system import Group, Part, System

if TYPE_CHECKING:
    from hookean.scene import Scene

Floats = NDArray[np.float64]
MOST_STEPS = 200  # in a frame of a simulation, where that is chosen here


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
    matrix, free, scale = _scaled_stiffness(system, state)
    stiffness = 0.0 if matrix is None or matrix.nnz == 0 else max(_largest(matrix), 0.0)
    drag = system.drag * float(scale.max(initial=0.0)) ** 2
    if not system.damped or not len(free):
        return stiffness, drag

    def damping(u: Floats) -> Floats:
        motion = np.zeros(state.x.size)
        motion[free] = u.ravel() * scale
        return _damping_force(system, state, motion.reshape(state.x.shape)).ravel()[free] * scale

    from scipy.sparse.linalg import LinearOperator

    return stiffness, max(_largest(LinearOperator((len(free), len(free)), matvec=damping, dtype=np.float64)), drag)


def highest_mode(system: System, state: State) -> tuple[float, float]:
    """Highest circular frequency [1/time] of small vibrations about a state, and the damping ratio [-] it would have
    with the largest damping of any motion."""
    stiffness, damping = highest_rates(system, state)
    omega = float(np.sqrt(stiffness))
    return omega, damping / (2.0 * omega) if omega > 0.0 else 0.0


def stable_time_step(system: System, state: State) -> float:
    """The step [time] up to which explicit time stepping of this state is stable; infinite without stiffness.

    dt^2 k / 4 + dt c / 2 <= 1 with the highest rates k and c: `critical_time_step`, also where only damping limits.
    """
    return _step(*highest_rates(system, state))


def _step(stiffness: float, damping: float) -> float:
    half = 0.5 * damping
    below = half + float(np.hypot(half, np.sqrt(stiffness)))
    return 2.0 / below if below > 0.0 else np.inf


def warning(system: System, state: State) -> str:
    """A sentence if the scene's time step is too large, with the step that would hold; else empty."""
    given = system.scene.settings.time_step
    if given <= _step(*_bounds(system, state)):
        return ""
    stiffness, damping = highest_rates(system, state)
    holds = _step(stiffness, damping)
    if given <= holds:
        return ""
    unit = system.scene.units.time
    # by the larger part of the limit: overdamped motion is limited by its damping
    what = "damping" if 0.5 * damping > np.sqrt(stiffness) else "stiffness"
    where = _greatest(system, state, what)
    what = "drag" if where == "/settings/drag" else what
    return (
        f"/settings/time_step: {given:g} {unit} is too large for this mass and the {what} of {where}; the motion will "
        f"explode. Steps up to {_down(holds):.4g} {unit} hold: use one of those, more mass or less {what}"
    )


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
                kind, name = group.cls.model_fields["kind"].default, part.force.name
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


def in_motion(scene: Scene) -> tuple[Scene, str]:
    """A scene for a simulation: where nobody chose its time step and the usual one would explode, with one that holds,
    and a sentence on it; else the scene as it is, and "".

    The step is four fifths of what holds at the start, as springs that are stretched are stiffer. Where nobody chose
    how many make a frame, it is as long as usual, in at most MOST_STEPS.
    """
    from hookean.system import compile

    settings = scene.settings
    if "time_step" in settings.model_fields_set or settings.solver not in ("auto", "verlet", "yoshida"):
        return scene, ""
    system = compile(scene)
    state = system.start()
    if not warning(system, state):
        return scene, ""
    step = float(f"{_down(0.8 * stable_time_step(system, state)):.4g}")
    changed: dict[str, float] = {"time_step": step}
    if "sub_iterations" not in settings.model_fields_set:
        changed["sub_iterations"] = min(round(settings.sub_iterations * settings.time_step / step), MOST_STEPS)
    said = f"time goes on in steps of {step:g} {scene.units.time}; longer ones explode with this stiffness and mass"
    return scene.replaced(settings=settings.replaced(**changed)), said


def _bounds(system: System, state: State) -> tuple[float, float]:
    """Bounds of the highest rates that cost one pass: row sums of stiffness and of damping over mass."""
    _, w, _ = system.evaluate(state)
    rows = np.full(len(w), system.drag)
    for group in system.groups:
        if not group.cls.damped:
            continue
        if group.cls.arity != 2 or "damping" not in group.block.names:
            return np.inf, np.inf
        c = group.block.parameters[:, group.block.names.index("damping")]
        rows += np.bincount(group.block.indices.ravel(), np.repeat(2.0 * c, 2), len(w))
    return float((w / system.mass).max()), float((rows / system.mass).max())


def _largest(operator: Any) -> float:
    """Largest eigenvalue of a symmetric matrix or operator."""
    from scipy.sparse.linalg import ArpackNoConvergence, eigsh

    size = operator.shape[0]
    if size <= 60:
        return float(np.linalg.eigvalsh(operator @ np.eye(size))[-1])
    start = 1.0 + 0.5 * np.sin(np.arange(size) * 12.9898)
    try:
        return float(eigsh(operator, k=1, which="LA", v0=start, tol=1e-6, return_eigenvectors=False)[0])
    except ArpackNoConvergence as error:
        # Ritz values come from below; a tenth more is on the safe side
        found = error.eigenvalues
        return 1.1 * float(found[-1]) if len(found) else float(np.abs(operator @ np.ones(size)).max())


def _down(value: float) -> float:
    """Rounded down to four digits, so that the number told is itself safe."""
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
    """C u of a motion u (n, 3): damping forces are linear in the velocity."""
    trial = state.copy()
    trial.v = motion
    moving, _, _ = system.evaluate(trial, still=False)
    resting, _, _ = system.evaluate(trial)
    return resting - moving + system.drag * motion
