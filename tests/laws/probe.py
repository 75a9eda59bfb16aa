"""Run in a process of its own (`python -m tests.laws.probe MODE`): prints what a fresh interpreter finds, as JSON."""

from __future__ import annotations

import hashlib
import json
import sys
from typing import Any

import numpy as np

from hookean import Scene
from hookean.compiled import dispatch
from hookean.forces import KINDS
from hookean.running.run import relax_state
from hookean.solvers import solver
from hookean.stability.time_steps import stable_time_step
from hookean.system.state import State
from hookean.system.system import System, compile

from .scenes import FAMILIES, Spec, random_scene

LOOPS = ("relaxation", "momentum", "verlet")


def watched() -> dict[str, Any]:
    """Every compiled function that is asked for from now on, by its name."""
    seen: dict[str, Any] = {}
    original = dispatch.compiled

    def noted(function: Any, role: str | None = None) -> Any:
        found = original(function, role)
        seen[f"{function.__module__}.{function.__qualname__}"] = found
        return found

    dispatch.compiled = noted  # type: ignore[assignment]
    return seen


def counted(seen: dict[str, Any]) -> dict[str, list[int]]:
    """For each of these functions: how often its code was on disk, and was not."""
    return {name: [found.loaded, found.made] for name, found in seen.items()}


def cache() -> dict[str, list[int]]:
    """What is counted of every compiled function that the examples of all forces use."""
    seen = watched()
    from .cases import example_system  # compiles the examples of all forces

    for kind in KINDS:
        system = example_system(kind, settings={"floor": True})
        for name in LOOPS:
            state = system.start()
            method = solver(name)
            method.start(system, state)
            method.advance(system, state, 2, 0.0)
        system.remember(state)
        system.support(state, np.zeros_like(state.x))
        for group, memory in zip(system.groups, state.memory, strict=True):
            system.stiffness_blocks(group, state, memory)
    return counted(seen)


def energy() -> dict[str, Any]:
    """Energy of one spring stretched by one, from its kernel, where one relaxation step takes its end, and what is
    counted of the functions that this takes."""
    seen = watched()
    scene = Scene(
        particles=[[0, 0, 0], [1, 0, 0]],
        forces=[{"kind": "springs", "particles": [[0, 1]], "stiffness": 100.0, "rest_length": 0.0}],
        anchors=[{"particles": [0]}],
        settings={"solver": "relaxation"},
    )
    system = compile(scene)
    state = system.start()
    energies = system.evaluate(state)[2]
    method = solver("relaxation")
    method.start(system, state)
    method.advance(system, state, 1, 0.0)
    return {"energy": float(energies.sum()), "moved": float(state.x[1, 0]), "functions": counted(seen)}


def digest(array: np.ndarray) -> str:
    """SHA-256 of an array's bytes."""
    return hashlib.sha256(np.ascontiguousarray(array).tobytes()).hexdigest()


def prepared(spec: Spec) -> System:
    """The scene with a time step that is stable."""
    system = compile(Scene.read(spec))
    step = 0.3 * min(stable_time_step(system, system.start()), 0.1)
    settings = {**spec["settings"], "time_step": step}
    return compile(Scene.read({**spec, "settings": settings}))


def hashes() -> dict[str, str]:
    """Shapes after relaxing and after 200 steps of Verlet, by family of random scenes, and of every example."""
    found = {}
    systems = {f: prepared(random_scene(i)) for i, f in enumerate(FAMILIES)}
    from .cases import example_system

    systems.update({kind: example_system(kind, settings={"time_step": 1e-3}) for kind in KINDS})
    for name, system in systems.items():
        for method in ("auto", "momentum"):
            state = system.start()
            limited = system.scene.settings.model_copy(update={"max_iterations": 2000})
            system.scene = system.scene.model_copy(update={"settings": limited})
            relax_state(system, state, solver(method))
            found[f"{name}, {method}"] = digest(state.x)
        state = system.start()
        run_verlet(system, state, 200)
        found[f"{name}, verlet"] = digest(np.concatenate([state.x, state.v]))
    return found


def run_verlet(system: System, state: State, steps: int) -> None:
    """So many time steps."""
    solver("verlet").advance(system, state, steps, 0.0)


if __name__ == "__main__":
    print(json.dumps(globals()[sys.argv[1]]()))
