"""Relaxation: dynamic relaxation with kinetic damping and a fictitious mass for every particle.

Masses follow the stiffness each particle feels, so that a unit step is stable for any scene; at every peak of kinetic
energy all motion stops and starts again with half a step. Source: Barnes, "Form finding and analysis of tension
structures by dynamic relaxation", 1999.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from hookean import kernels
from hookean.kernels import device
from hookean.solvers.base import Solver

if TYPE_CHECKING:
    from hookean.state import State
    from hookean.system import System

# a unit step is stable while mass > w / 4 (w bounds the stiffness of a particle); a tenth more for safety
MASS = 0.275


@device
def push(f: Any, v: Any, free: Any, mass: Any, inverse: Any, part: Any) -> Any:
    """Speeds after one step of the forces; returns the largest squared force left and twice the kinetic energy."""
    worst = 0.0
    kinetic = 0.0
    for i in range(f.shape[0]):
        step = part * inverse[i]
        fx = f[i, 0] * free[i, 0]
        fy = f[i, 1] * free[i, 1]
        fz = f[i, 2] * free[i, 2]
        vx = v[i, 0] + step * fx
        vy = v[i, 1] + step * fy
        vz = v[i, 2] + step * fz
        f[i, 0] = fx
        f[i, 1] = fy
        f[i, 2] = fz
        v[i, 0] = vx
        v[i, 1] = vy
        v[i, 2] = vz
        kinetic += mass[i] * (vx * vx + vy * vy + vz * vz)
        worst = max(worst, fx * fx + fy * fy + fz * fz)
    return worst, kinetic


@device
def move(x: Any, v: Any) -> Any:
    """One step, over flat arrays; `x += v` takes ten times as long."""
    flat, speed = x.reshape(x.size), v.reshape(x.size)
    for i in range(x.size):
        flat[i] += speed[i]


@device
def step_back(x: Any, v: Any, f: Any, inverse: Any) -> Any:
    """To about where the peak of kinetic energy was, and at rest."""
    for i in range(x.shape[0]):
        for c in range(3):
            x[i, c] += 0.5 * inverse[i] * f[i, c] - 0.5 * v[i, c]
            v[i, c] = 0.0


@device
def weigh(mass: Any, inverse: Any, w: Any, caution: Any) -> Any:
    """Fictitious masses that make a unit step stable."""
    for i in range(mass.shape[0]):
        mass[i] = caution * w[i] if w[i] > 0.0 else 1.0
        inverse[i] = 1.0 / mass[i]


def relaxation_loop(  # type: ignore[no-untyped-def]
    functions, indices, parameters, memory, impacts, supports, planes, x, v, free, still, f, w, mass, carried, clock,
    count, goal,
):  # fmt: skip
    energy_before = clock[0]
    fresh = clock[1] != 0.0
    contacts = 0
    for p in range(len(planes)):
        contacts += planes[p].shape[0]
    inverse = 1.0 / mass
    for step in range(count):
        f[:] = 0.0
        w[:] = 0.0
        for b in range(len(functions)):
            functions[b](x, still, indices[b], parameters[b], memory[b], f, w)
        if contacts > 0:
            f *= free
            for p in range(len(supports)):
                supports[p](x, v, f, carried, free, mass, 0.0, planes[p])
        if fresh:
            weigh(mass, inverse, w, clock[2])
        worst, kinetic = push(f, v, free, mass, inverse, 0.5 if fresh else 1.0)
        if worst <= goal * goal:
            v[:] = 0.0
            clock[0] = 0.0
            clock[1] = 1.0
            return step
        fresh = kinetic < energy_before
        if fresh:
            step_back(x, v, f, inverse)
            energy_before = 0.0
        else:
            move(x, v)
            energy_before = kinetic
        if contacts > 0:
            for p in range(len(impacts)):
                impacts[p](x, v, v, x, v, free, 0.0, planes[p])
    clock[0] = energy_before
    clock[1] = 1.0 if fresh else 0.0
    return count


def undamped(system: System, parameters: tuple[Any, ...]) -> tuple[Any, ...]:
    """The parameters without damping: kernels see no speed here, and need not look for one at every spring."""
    tables = list(parameters)
    for i, group in enumerate(system.groups):
        if group.cls.damped:
            tables[i] = parameters[i].copy()
            tables[i][:, [name == "damping" for name in group.block.names]] = 0.0
    return tuple(tables)


class Method(Solver):
    """Kinetic damping; the work horse for nets, membranes and shells."""

    name: ClassVar[str] = "relaxation"

    def start(self, system: System, state: State) -> None:
        """Rest, and the first step a half one."""
        n = len(state.x)
        state.v[:] = 0.0
        caution = float(state.scratch["clock"][2]) if "clock" in state.scratch else MASS
        state.scratch = {"clock": np.array([0.0, 1.0, caution]), "mass": np.ones(n)}

    def advance(self, system: System, state: State, count: int, goal: float) -> int:
        """At most `count` iterations, stopping at the first shape within `goal`."""
        still, f, carried = (np.zeros_like(state.x) for _ in range(3))
        functions, indices, parameters, memory = system.tuples(state)
        done = kernels.call(
            kernels.compiled(relaxation_loop),
            functions, indices, undamped(system, parameters), memory, *system.hooks(),
            state.x, state.v, state.free, still, f, np.zeros(len(state.x)), state.scratch["mass"], carried,
            state.scratch["clock"], count, goal,
        )  # fmt: skip
        state.iteration += int(done)
        return int(done)
