"""Time steps: how many a second, beside a plain loop in C; and frames of a shell that falls on a floor."""

from __future__ import annotations

import ctypes
import shutil
import statistics
import subprocess
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import problems
from problems import Problem

SIZES = (1_000, 10_000, 100_000)
SPHERES = ((50, 41), (100, 100))  # faces around and along: 2,002 and 9,902 particles
SUB_STEPS = 20
ROUNDS = 7
FLAGS = ("-Ofast", "-march=native", "-mprefer-vector-width=512", "-fPIC")

Stepper = Callable[[int], Any]


def stepping(sizes: tuple[int, ...] = SIZES, rounds: int = ROUNDS) -> dict[tuple[str, int], float]:
    """Particle steps a second of each way on the membrane's net, medians of rounds in turn."""
    found: dict[tuple[str, int], float] = {}
    with tempfile.TemporaryDirectory() as folder:
        compiled = compile_c(Path(folder))
        for size in sizes:
            p = problems.make("membrane", size)
            ways: dict[str, Stepper] = {
                "hookean verlet": verlet(p),
                f"in calls of {SUB_STEPS}": in_frames(verlet(p)),
                "with damped springs": verlet(p, damping=0.1),
            }
            if compiled is not None:
                ways["C, scalar"] = scalar(p, compiled)
            count = max(1, int(2_000_000 / len(p.x) / SUB_STEPS)) * SUB_STEPS
            for name, rate in _rates(ways, count, rounds).items():
                found[name, size] = rate * len(p.x)
    return found


def _rates(ways: dict[str, Stepper], count: int, rounds: int) -> dict[str, float]:
    """Steps a second of each way."""
    times: dict[str, list[float]] = {name: [] for name in ways}
    for step in ways.values():
        step(2)
    for _ in range(rounds):
        for name, step in ways.items():
            begun = time.perf_counter()
            step(count)
            times[name].append(time.perf_counter() - begun)
    return {name: count / statistics.median(seconds) for name, seconds in times.items()}


def in_frames(step: Stepper) -> Stepper:
    """The same steps, as few in a call as a live frame takes."""

    def several(count: int) -> None:
        for _ in range(count // SUB_STEPS):
            step(SUB_STEPS)

    return several


def verlet(p: Problem, damping: float = 0.0) -> Stepper:
    """hookean's time steps, with the step a stable part of the period."""
    from hookean.scene.scene import Scene
    from hookean.solvers import solver
    from hookean.system.system import compile

    springs = {"kind": "springs", "particles": p.springs, "stiffness": p.k, "rest_length": p.l0, "damping": damping}
    load = {"kind": "unary", "particles": np.arange(len(p.x)), "vector": p.load}
    scene = Scene.read(
        {"particles": p.x, "forces": [springs, load], "anchors": [{"particles": p.fixed}],
         "settings": {"solver": "verlet", "time_step": 0.02, "drag": 1.0}}
    )  # fmt: skip
    system = compile(scene)
    state, method = system.start(), solver("verlet")
    method.start(system, state)
    return lambda count: method.advance(system, state, count, 0.0)


def compile_c(folder: Path) -> Any:
    """The loop of step.c; None where there is no compiler."""
    gcc = shutil.which("gcc")
    if gcc is None:
        return None
    part, target = folder / "step.o", folder / "step.so"
    source = Path(__file__).with_name("step.c")
    subprocess.run([gcc, *FLAGS, "-c", str(source), "-o", str(part)], check=True)
    # linked without the flags: with them, loading it would turn numbers near zero off in the whole process
    subprocess.run([gcc, "-shared", str(part), "-o", str(target), "-lm"], check=True)
    return ctypes.CDLL(str(target)).steps


def scalar(p: Problem, steps: Any) -> Stepper:
    """The same net in C."""
    x, v, f = p.x.copy(), np.zeros_like(p.x), np.zeros_like(p.x)
    x[:, 2] = 0.01 * np.sin(np.arange(len(x)))
    inverse = np.full(len(x), 0.01 / 260.0)
    inverse[p.fixed] = 0.0
    ends = np.ascontiguousarray(p.springs, dtype=np.int32)
    arrays = (x, v, f, ends, p.k, p.l0, p.load, inverse)
    places = [ctypes.c_void_p(a.ctypes.data) for a in arrays]

    def step(count: int, kept: Any = arrays) -> None:
        steps(*(ctypes.c_long(c) for c in (len(x), len(p.springs), count)), *places)

    return step


def sphere(around: int, along: int) -> dict[str, Any]:
    """A mesh sphere of radius 5 just above a floor, as in section 9.7: springs on edges and diagonals, and a shell."""
    turn = 2.0 * np.pi * np.arange(around) / around
    tilt = np.pi * np.arange(1, along) / along
    rings = [
        np.column_stack([5 * np.sin(t) * np.sin(turn), np.full(around, -5 * np.cos(t)), 5 * np.sin(t) * np.cos(turn)])
        for t in tilt
    ]
    vertices = np.concatenate([[[0, -5, 0]], *rings, [[0, 5, 0]]]) + [0.0, 0.0, 5.01]
    i, last = np.arange(around), len(vertices) - 1
    k = (i + 1) % around
    faces = [[0, 1 + b, 1 + a] for a, b in zip(i, k, strict=True)]
    for j in range(along - 2):
        near, far = 1 + around * j, 1 + around * (j + 1)
        faces += [[near + a, near + b, far + b, far + a] for a, b in zip(i, k, strict=True)]
    faces += [[last - around + a, last - around + b, last] for a, b in zip(i, k, strict=True)]
    return {
        "meshes": {"sphere": {"vertices": vertices, "faces": [[int(v) for v in face] for face in faces]}},
        "forces": [
            {"kind": "springs", "mesh": "sphere", "stiffness": 5000},
            {"kind": "springs", "mesh": "sphere", "edges": "diagonals", "stiffness": 5000},
            {"kind": "unary", "points": vertices, "vector": [0, 0, -9.81]},
            {"kind": "shell", "mesh": "sphere", "strength": 500},
        ],
        "settings": {"solver": "verlet", "floor": True, "sub_iterations": SUB_STEPS},
    }


def frames(spheres: tuple[tuple[int, int], ...] = SPHERES, seconds: float = 3.0) -> dict[int, float]:
    """Frames a second by the number of particles."""
    from hookean.running.simulation import Simulation
    from hookean.scene.scene import Scene
    from hookean.stability.time_steps import stable_time_step
    from hookean.system.system import compile

    found = {}
    for around, along in spheres:
        scene = sphere(around, along)
        system = compile(Scene.read(scene))
        scene["settings"]["time_step"] = 0.5 * min(stable_time_step(system, system.start()), 0.008)
        running = Simulation(Scene.read(scene))
        running.step()
        begun, count = time.perf_counter(), 0
        while time.perf_counter() - begun < seconds:
            running.step()
            count += 1
        found[len(system.x)] = count / (time.perf_counter() - begun)
    return found
