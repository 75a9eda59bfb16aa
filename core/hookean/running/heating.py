"""Heating: energy that time steps that are too long feed into a motion, found while the shape is still a good one.

Forces that have an energy exchange it with the motion, and damping takes some: nothing adds to the total, unless
anchors are led. The books of a run are kept in `state.scratch`, so that a run that is resumed ends where it
would have ended.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from hookean.stability.time_steps import Bounds, stable_time_step
from hookean.system.balance import Balance, balance

if TYPE_CHECKING:
    from hookean.solvers.base import Solver
    from hookean.system.state import State
    from hookean.system.system import System

GAIN = 2.0  # times the energy that a motion has exchanged: a total above that ends a run whose steps are given
SHARE = 0.25  # of it: a gain beyond the swing of the total for which steps are divided further
WORTH = 0.1  # of it: a gain beyond the swing that is reported
MOST_SWING = 100.0  # of the total energy at steps that are nearly too long
DIVIDED_SWING = 3.0  # the same, of steps that are divided where shapes stiffen
TELLING = 0.7  # the part of the total that stays at least, for a bound to be as good as the frequency
FAR = 1e5  # sizes of the model: what is farther away is lost
LEAST = 1e-6  # of the energy of a system, below which gains are rounding

# the books [force length]: the total at the start; the least energy of forces since; by what factor the total swings
# (0: not yet known) [-]; the total from which gains count, higher than at the start once steps have been divided for a
# gain; and what was taken out of the motion
START, LOWEST, SWING, BASE, TAKEN = range(5)


def entered(system: System, state: State, found: Balance, *, driven: bool) -> tuple[float, float] | None:
    """Energies of forces and of motion [force length], entered into the books of a run; None if they are unknown:
    anchors are led (`driven`), or a force has no energy."""
    led = driven or state.v[state.free == 0.0].any()
    if led or not all(group.conservative for group in system.groups):
        state.scratch.pop("energy", None)
        return None
    given = float(state.scratch.get("given", np.zeros(1))[0])  # by impulses, which no step has made
    still, motion = float(found.energies.sum()) - given, float(_moving(system, state).sum())
    if len(state.scratch.get("energy", ())) != TAKEN + 1:
        state.scratch["energy"] = np.array([still + motion, still, 0.0, still + motion, 0.0])
    books = state.scratch["energy"]
    books[LOWEST] = min(books[LOWEST], still)
    return still, motion


def heated(system: System, state: State, method: Solver, found: Balance, *, driven: bool) -> int | None:
    """The particle that moves most, where time steps have fed more energy into the motion than is borne; else None.

    With stable steps dt, the total swings by up to 1 / (1 - (dt / longest)^2).
    """
    energies = entered(system, state, found, driven=driven)
    if energies is None:
        return None
    books = state.scratch["energy"]
    gain, exchanged = sum(energies) - books[BASE], books[BASE] - books[LOWEST]
    divided = system.scene.settings.divide_steps and not driven
    swing = max(books[SWING], 1.0)
    most = (swing - 1.0 + SHARE) * exchanged if divided else GAIN * swing * exchanged
    least = GAIN * _rounding(found, energies)
    if np.isfinite(gain) and gain <= max(most, least):
        return None
    if system.films is not None:  # what keeps them even does work
        step = system.scene.settings.time_step / method.parts(system, state)
        bounds = Bounds.of(system, state, found.stiffness)
        if step <= (bounds.holds(state, method.limit) if divided else method.limit.step(*bounds.highest(state))):
            return None
    if not gain <= MOST_SWING * max(exchanged, least):  # no swing: beyond it numbers may be too large for factors
        return int(np.argmax(_moving(system, state)))
    if books[SWING] == 0.0:
        books[SWING] = _swing(system, state, method)
        return heated(system, state, method, found, driven=driven)
    return int(np.argmax(_moving(system, state)))


def gained(system: System, state: State, method: Solver, found: Balance, *, driven: bool) -> str:
    """A sentence on the energy that time steps have fed into a motion since its start, if it is worth one."""
    energies = entered(system, state, found, driven=driven)
    if energies is None:
        return ""
    books, units = state.scratch["energy"], system.scene.units
    gain, exchanged = sum(energies) - books[START] + books[TAKEN], books[START] - books[LOWEST]
    least = GAIN * _rounding(found, energies)
    worth = WORTH if system.films is None else 1.0  # what spreads the vertices of a film does work, too
    if gain <= max(worth * exchanged, least):
        return ""
    if books[SWING] == 0.0:
        books[SWING] = _swing(system, state, method)
    if gain <= (books[SWING] - 1.0 + worth) * exchanged:
        return ""
    unit = units.of("energy")
    # one digit: what changes from frame to frame is not reported again
    part = f", {100.0 * gain / exchanged:,.1g} % of the energy it exchanges" if exchanged > least else ""
    taken = f"; about {books[TAKEN]:.1g} {unit} were removed again" if books[TAKEN] > 0.0 else ""
    who = "steps have" if system.films is None else "steps, and the even spacing of film vertices, have"
    what = "use a smaller step, or omit it"
    if system.scene.settings.divide_steps:
        what = "to reduce this, add damping, or mass at the lightest particles"
    return f"/settings/time_step: {who} added about {gain:.1g} {unit} to the energy of this motion{part}{taken}: {what}"


def accept(system: System, state: State, found: Balance) -> None:
    """Count gains from the total of a state on, after steps have been divided; what it has gained stays."""
    energies = entered(system, state, found, driven=False)
    if energies is not None:
        books = state.scratch["energy"]
        books[BASE], books[SWING] = max(books[BASE], sum(energies)), 0.0


def give_back(state: State, good: State) -> None:
    """Take impulses given since a good state out of the books: they are given again."""
    state.scratch.pop("given", None)
    if "given" in good.scratch:
        state.scratch["given"] = good.scratch["given"].copy()


def cool(system: System, state: State, found: Balance) -> None:
    """Take what steps have added out of the motion, all velocities alike."""
    energies = entered(system, state, found, driven=False)
    if energies is None:
        return
    books, motion = state.scratch["energy"], energies[1]
    left = max(motion - max(sum(energies) - books[BASE], 0.0), 0.0)
    books[TAKEN] += motion - left
    state.v *= np.sqrt(left / motion) if motion > 0.0 else 0.0


def flown(system: System, state: State, found: Balance, particle: int, *, driven: bool) -> bool:
    """Whether a particle that is far away went there by its loads and velocities: with no energy of the steps' making,
    or where energies are not known as one of a part that nothing holds and that went as a whole, for what steps add
    moves no centre of mass."""
    if not (np.isfinite(state.x).all() and np.isfinite(state.v).all()):
        return False
    with np.errstate(all="ignore"):  # far away numbers are large
        there = balance(system, state)
        energies = entered(system, state, there, driven=driven)
        # what keeps films even does work, so that their energies are no measure
        if energies is not None and system.films is None:
            books, least = state.scratch["energy"], _rounding(there, energies)
            gain, exchanged = sum(energies) - books[BASE], books[BASE] - books[LOWEST]
            return bool(np.isfinite(gain) and gain <= GAIN * max(exchanged, least))
        parts = found.components
        part = parts.label[particle]
        if part < 0 or not parts.loose[part].any():
            return False
        some = parts.label == part
        moved = system.mass[some] @ (state.x - system.x)[some] / system.mass[some].sum()
        return float(np.abs(moved).max()) > 0.5 * FAR * system.size


def _moving(system: System, state: State) -> np.ndarray:
    return np.asarray(0.5 * system.mass * np.einsum("ij,ij->i", state.v, state.v))  # a sum along three is slow


def _rounding(found: Balance, energies: tuple[float, float]) -> float:
    return LEAST * (float(np.abs(found.energies).sum()) + energies[1])


def _swing(system: System, state: State, method: Solver) -> float:
    """By what factor the total of a stable vibration swings; at most, where a bound of the stiffness is enough."""
    step = system.scene.settings.time_step / method.parts(system, state)
    bound = 1.0 - (step / method.limit.step(*Bounds.of(system, state).highest(state))) ** 2
    if bound > TELLING:
        return 1.0 / bound
    rest = 1.0 - (step / stable_time_step(system, state, method.limit)) ** 2
    # steps that may be divided have no reason to swing for long in a shape that has grown stiff
    most = DIVIDED_SWING if system.scene.settings.divide_steps and not system.steady else MOST_SWING
    return min(1.0 / rest, most) if rest > 0.0 else 1.0
