"""Shapes at rest as systems and states: what every analysis starts from; and loads told apart from the rest."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hookean.errors import InputError
from hookean.forces.base import Block
from hookean.running.result import Result, Status
from hookean.running.run import relax_state
from hookean.running.simulation import Simulation
from hookean.scene.load_cases import IDLE, case_loads
from hookean.scene.scene import Scene
from hookean.solvers import solver
from hookean.stability.equilibrium import movable
from hookean.system.balance import balance
from hookean.system.group import Group, Part
from hookean.system.state import State
from hookean.system.system import System, compile

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class AtRest:
    """A shape in equilibrium: its system, its state, and the axes `free` (n, 3) on which its particles may move."""

    system: System
    state: State
    free: Floats

    @classmethod
    def of(cls, model: Scene | Result | Simulation) -> AtRest:
        """The equilibrium of a scene (which is relaxed), a result or a simulation; InputError if it is not at rest."""
        if isinstance(model, Simulation):
            system, state = model.system, model.state.copy()
            return cls.checked(system, state, model.status is Status.CONVERGED, str(model.status))
        if isinstance(model, Result):
            return cls._of_result(model)
        if not isinstance(model, Scene):
            said = f"a Scene, Result or Simulation is expected, not a {type(model).__name__}; give one of these"
            raise InputError("model", said)
        system = compile(model)
        state = system.start()
        result = relax_state(system, state, solver(model.settings.solver))
        return cls.checked(system, state, result.converged, result.message)

    @classmethod
    def _of_result(cls, result: Result) -> AtRest:
        if result.scene is None:
            raise InputError("result", "has no scene; give a result of relax")
        system = compile(result.scene)
        state = system.start()
        count = system.slots.count
        held = np.flatnonzero((state.free[:count] == 0).any(axis=1))
        fits = len(result.particles) == count and len(result.rotations["quaternions"]) == len(system.slots)
        if not fits or not np.isin(held, result.reactions["particles"]).all():
            raise InputError("result", "holds other particles than its scene; give the Simulation that it is of")
        system.slots.put(state, result.particles, result.rotations["quaternions"])
        system.remember(state)
        return cls.checked(system, state, result.converged, result.message)

    @classmethod
    def checked(cls, system: System, state: State, converged: bool, message: str) -> AtRest:
        """With what a floor holds, as `movable` finds it; InputError where the shape is not at rest."""
        if not converged:
            raise InputError("model", f"is not in equilibrium: {message.rstrip('.')}; relax it first")
        if missing := system.no_tangent():
            raise InputError("model", f"has no tangent stiffness: {missing}; remove that force")
        free, reason = movable(system, state, balance(system, state))
        if reason:
            raise InputError("model", f"{reason}, so its free motions are unknown; hold it or remove the floor")
        return cls(system, state, free)


def relaxed(system: System, state: State, what: str) -> AtRest:
    """A system brought to rest from a state; `what` names it in the error where that fails."""
    settings = system.scene.settings
    result = relax_state(system, state, solver(settings.solver))
    return AtRest.checked(system, state, result.converged, f"{what}: {result.message}")


def load_numbers(scene: Scene, names: Sequence[str] | None, pointer: str = "loads") -> tuple[int, ...]:
    """The numbers of the loads of these names (or kinds) in a scene, of all without names; InputError for others, and
    for loads of load cases, which do not act by themselves."""
    from hookean.forces import KINDS

    later = {i: scene.forces[i].name or scene.forces[i].kind_name for i in sorted(case_loads(scene))}
    loads = {i: f for i, f in enumerate(scene.forces) if KINDS[f.kind_name].role == "load"}
    known = ", ".join(dict.fromkeys(f.name or f.kind_name for f in loads.values())) or "none"
    if isinstance(names, str):
        names = [names]
    found: list[int] = []
    for place, name in enumerate(names if names is not None else ()):
        mine = [i for i, f in loads.items() if name in (f.name, f.kind_name)]
        if not mine:
            raise InputError(f"{pointer}/{place}", f"no load is called {name!r}; the scene has {known}")
        found += mine
    asleep = list(dict.fromkeys(name for i, name in later.items() if name != IDLE and (names is None or i in found)))
    if asleep:
        said = f"{', '.join(asleep)}: of load cases, which do not act by themselves; give the name of one as case"
        raise InputError(pointer, said if names is not None else f"{said}, or loads that act as loads")
    if names is None:
        found = [i for i in loads if i not in later]
    if not found:
        raise InputError(pointer, "the scene has no loads; add a load, such as unary or self_weight")
    return tuple(sorted(set(found)))


def divided(system: System, state: State, numbers: Sequence[int]) -> tuple[tuple[System, State], tuple[System, State]]:
    """A system without the forces of these numbers, and one of these alone, each with its state."""
    chosen = set(numbers)
    return _some(system, state, lambda part: part.number not in chosen), _some(
        system, state, lambda part: part.number in chosen
    )


def _some(system: System, state: State, wanted) -> tuple[System, State]:  # type: ignore[no-untyped-def]
    groups, memory = [], []
    for group, own in zip(system.groups, state.memory, strict=True):
        parts = [part for part in group.parts if wanted(part)]
        if len(parts) == len(group.parts):
            groups.append(group)
            memory.append(own.copy())
        elif parts:
            block, rows = _joined(group, parts)
            groups.append(Group(group.cls, block, _renumbered(parts)))
            memory.append(own[rows])
    other = replace(system, groups=groups, _components=None)
    return other, replace(state, x=state.x.copy(), v=state.v.copy(), memory=memory, scratch={})


def _joined(group: Group, parts: list[Part]) -> tuple[Block, NDArray[np.int64]]:
    rows = np.concatenate([np.arange(part.rows.start, part.rows.stop) for part in parts])
    return group.block.some(rows), rows


def _renumbered(parts: list[Part]) -> list[Part]:
    """Parts with the rows that they have once the others are gone."""
    made, start = [], 0
    for part in parts:
        count = part.rows.stop - part.rows.start
        made.append(replace(part, rows=slice(start, start + count)))
        start += count
    return made
