"""What hookean is measured beside. A peer takes a problem and a target and returns a run, or says why it cannot.

`numba-dr` is the baseline that a good programmer writes in a day: dynamic relaxation with kinetic damping, masses
0.55 sum k, half a step after every restart, fast-math. The packages are optional: those that import take part.
"""

from __future__ import annotations

import importlib.util
import os
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numba
import numpy as np
from problems import Floats, Problem, residual


@dataclass
class Run:
    """One solve: its seconds, iterations (0: not told), and the shape it ended at."""

    seconds: float
    iterations: int
    x: Floats


class Unfit(Exception):
    """A peer cannot do this problem; the message says why."""


Peer = Callable[[Problem, float, float], Run]
"""(problem, target residual, most seconds) -> run. The clock stands still while a shape is being judged."""


@numba.njit(fastmath=True)  # type: ignore[untyped-decorator]
def _relax(x, v, f, load, mass, inverse, a, b, k, l0, count, energy, fresh):  # type: ignore[no-untyped-def]
    for _ in range(count):
        f[:] = load
        for e in range(len(k)):
            i, j = a[e], b[e]
            dx, dy, dz = x[j, 0] - x[i, 0], x[j, 1] - x[i, 1], x[j, 2] - x[i, 2]
            q = k[e]
            if l0[e] > 0.0:
                q -= k[e] * l0[e] / np.sqrt(dx * dx + dy * dy + dz * dz)
            f[i, 0] += q * dx
            f[i, 1] += q * dy
            f[i, 2] += q * dz
            f[j, 0] -= q * dx
            f[j, 1] -= q * dy
            f[j, 2] -= q * dz
        now = 0.0
        part = 0.5 if fresh else 1.0
        for i in range(len(x)):
            for c in range(3):
                v[i, c] += part * f[i, c] * inverse[i]
                x[i, c] += v[i, c]
                now += mass[i] * v[i, c] * v[i, c]
        fresh = now < energy
        energy = now
        if fresh:
            energy = 0.0
            for i in range(len(x)):
                for c in range(3):
                    x[i, c] += 0.5 * f[i, c] * inverse[i] - 1.5 * v[i, c]
                    v[i, c] = 0.0
    return energy, fresh


def numba_dr(p: Problem, target: float, most: float) -> Run:
    """The baseline, judged every 10 iterations at first, every 50th part of them later."""
    begun = time.perf_counter()
    mass = 0.55 * np.bincount(p.springs.ravel(), np.repeat(p.k, 2), len(p.x))
    inverse = 1.0 / mass
    inverse[p.fixed] = 0.0
    x, v, f = p.x.copy(), np.zeros_like(p.x), np.zeros_like(p.x)
    a, b = (np.ascontiguousarray(p.springs[:, c], dtype=np.int32) for c in (0, 1))
    done, energy, fresh, aside = 0, 0.0, True, 0.0
    while True:
        count = max(10, done // 50)
        energy, fresh = _relax(x, v, f, p.load, mass, inverse, a, b, p.k, p.l0, count, energy, fresh)
        done += count
        paused = time.perf_counter()
        seconds = paused - begun - aside
        if residual(p, x) <= target or seconds > most:
            return Run(seconds, done, x)
        aside += time.perf_counter() - paused


def compas_dr(p: Problem, target: float, most: float) -> Run:
    """compas_dr: viscous relaxation with c = 0.02; EA / l0 = k, and a rest length of 0 as a force density k."""
    from compas_dr.numdata import InputData
    from compas_dr.solvers import dr_numpy

    begun = time.perf_counter()
    none, zeros = p.l0 == 0, [0.0] * len(p.k)
    data = InputData(
        vertices=p.x.tolist(), edges=p.springs.tolist(), fixed=p.fixed.tolist(), loads=p.load.tolist(),
        qpre=np.where(none, p.k, 0.0).tolist(), fpre=zeros, lpre=zeros, linit=np.where(none, 1.0, p.l0).tolist(),
        E=np.where(none, 0.0, p.k * p.l0 / 3.14159).tolist(), radius=[1.0] * len(p.k),
    )  # fmt: skip
    run, due, aside = Run(0.0, 0, p.x), 0, 0.0

    def look(step: int, x: Floats, *_: Any) -> None:
        nonlocal run, due, aside
        if step < due:
            return
        paused = time.perf_counter()
        run = Run(paused - begun - aside, step + 1, np.array(x))
        if residual(p, run.x) <= target or run.seconds > most:
            raise _Enough
        due = step + max(10, step // 50)
        aside += time.perf_counter() - paused

    try:
        dr_numpy(data, kmax=10**8, tol1=0.0, tol2=0.0, c=0.02, callback=look)
    except _Enough:
        return run
    return run


class _Enough(Exception):
    pass


def compas_fd(p: Problem, target: float, most: float) -> Run:
    """compas_fd: the force density method, exact where every rest length is 0."""
    from compas_fd.solvers import fd_numpy

    _only_linear(p)
    begun = time.perf_counter()
    result = fd_numpy(vertices=p.x.tolist(), fixed=p.fixed.tolist(), edges=p.springs.tolist(),
                      forcedensities=p.k.tolist(), loads=p.load.tolist())  # fmt: skip
    return Run(time.perf_counter() - begun, 1, np.asarray(result.vertices, dtype=float))


def jax_fdm(p: Problem, target: float, most: float) -> Run:
    """jax_fdm: the force density method on JAX; the first call compiles and is not counted."""
    from jax_fdm.datastructures import FDNetwork
    from jax_fdm.equilibrium import fdm

    _only_linear(p)
    net = FDNetwork.from_nodes_and_edges(p.x.tolist(), [tuple(e) for e in p.springs.tolist()])
    for node in p.fixed.tolist():
        net.node_support(node)
    for edge, k in zip(p.springs.tolist(), p.k, strict=True):
        net.edge_forcedensity(tuple(edge), float(k))
    net.nodes_loads([0.0, 0.0, 0.0])
    fdm(net, sparse=True)
    begun = time.perf_counter()
    solved = fdm(net, sparse=True)
    seconds = time.perf_counter() - begun
    return Run(seconds, 1, np.array([solved.node_coordinates(i) for i in range(len(p.x))]))


def _only_linear(p: Problem) -> None:
    if p.l0.any():
        raise Unfit("force density takes rest length 0 only")


def shared_dr(folder: Path) -> Peer:
    """The `numba_dr` of another bench folder (its base.py and common.py), timed by its own recorder."""
    sys.path.insert(0, str(folder))
    ours = sys.modules.pop("problems")
    try:
        base, common, theirs = (importlib.import_module(name) for name in ("base", "common", "problems"))
    finally:
        sys.path.remove(str(folder))
        sys.modules["problems"] = ours

    def run(p: Problem, target: float, most: float) -> Run:
        problem = theirs.Problem(
            p.name, len(p.x), p.x, p.springs.astype(np.int32), p.k, p.l0, p.load, p.fixed, np.zeros((0, 4), np.int32)
        )
        recorder = common.Recorder(problem, most, None, target)
        x = base.numba_dr(problem, recorder)
        return Run(float(recorder.hist[-1][0]), int(recorder.hist[-1][1]), x)

    return run


PACKAGES: dict[str, tuple[str, Peer]] = {
    "compas_dr": ("compas_dr", compas_dr),
    "compas_fd": ("compas_fd", compas_fd),
    "jax_fdm": ("jax_fdm", jax_fdm),
}


def available(shared: Path | None) -> tuple[dict[str, Peer], list[str]]:
    """Peers that can run here, and a sentence for each that cannot."""
    peers: dict[str, Peer] = {"numba-dr": numba_dr}
    said = []
    if shared is not None and os.path.exists(shared / "base.py"):
        peers["numba-dr (shared)"] = shared_dr(shared)
    elif shared is not None:
        said.append(f"numba-dr (shared): there is no base.py in {shared}.")
    for name, (module, peer) in PACKAGES.items():
        if importlib.util.find_spec(module) is None:
            said.append(f"{name} is not installed; 'pip install {module}' adds it to the table.")
        else:
            peers[name] = peer
    return peers, said


def describe(error: Exception) -> str:
    """One line about a peer that failed."""
    text: Any = str(error) or type(error).__name__
    return " ".join(str(text).split())[:120]
