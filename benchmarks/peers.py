"""What hookean is measured beside. A peer takes a problem and a target and returns a run, or says why it cannot.

`numba-dr` is the baseline that a good programmer writes in a day: dynamic relaxation with kinetic damping, masses
0.55 sum k, half a step after every restart, fast-math. The packages are optional: those that import take part.
"""

from __future__ import annotations

import contextlib
import importlib.util
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
    """One solve: its seconds, iterations (0: not told), the shape it ended at, and passes over all springs."""

    seconds: float
    iterations: int
    x: Floats
    work: float = 0.0

    def __post_init__(self) -> None:
        self.work = self.work or float(self.iterations)


class Unfit(Exception):
    """A peer cannot do this problem; the message says why."""


class _Enough(Exception):
    pass


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


@numba.njit(fastmath=True)  # type: ignore[untyped-decorator]
def _momentum(x, v, f, load, inverse, a, b, k, l0, count):  # type: ignore[no-untyped-def]
    for _ in range(count):
        for i in range(len(x)):
            for c in range(3):
                x[i, c] += v[i, c]
                f[i, c] = load[i, c]
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
        for i in range(len(x)):
            against = 0.0
            for c in range(3):
                push = f[i, c] * inverse[i]
                v[i, c] += push
                x[i, c] += push
                against += push * v[i, c]
            if against < 0.0:
                for c in range(3):
                    v[i, c] *= 0.9


def numba_k2(p: Problem, target: float, most: float) -> Run:
    """Kangaroo 2's iteration: weighted means of what springs (weight 2k) and loads (1) propose, with momentum."""
    begun = time.perf_counter()
    weight = 2.0 * np.bincount(p.springs.ravel(), np.repeat(p.k, 2), len(p.x)) + p.load.any(axis=1)
    inverse = 1.0 / weight
    inverse[p.fixed] = 0.0
    x, v, f = p.x.copy(), np.zeros_like(p.x), np.zeros_like(p.x)
    a, b = (np.ascontiguousarray(p.springs[:, c], dtype=np.int32) for c in (0, 1))
    done, aside = 0, 0.0
    while True:
        count = max(10, done // 50)
        _momentum(x, v, f, p.load, inverse, a, b, p.k, p.l0, count)
        done += count
        paused = time.perf_counter()
        seconds = paused - begun - aside
        if residual(p, x) <= target or seconds > most:
            return Run(seconds, done, x)
        aside += time.perf_counter() - paused


def lbfgsb(p: Problem, target: float, most: float) -> Run:
    """scipy's L-BFGS-B on the energy, with 20 pairs."""
    from scipy import optimize, sparse

    begun = time.perf_counter()
    count, free = len(p.springs), np.flatnonzero(p.free)
    incidence = sparse.csr_array(
        (np.tile([-1.0, 1.0], count), (np.repeat(np.arange(count), 2), p.springs.ravel())), (count, len(p.x))
    )
    back = incidence.T.tocsr()
    steps, due, aside, run = 0, 0, 0.0, Run(0.0, 0, p.x)

    def placed(u: Floats) -> Floats:
        x = p.x.copy()
        x[free] = u.reshape(-1, 3)
        return x

    def energy(u: Floats) -> tuple[float, Floats]:
        x = placed(u)
        d = incidence @ x
        length = np.sqrt((d * d).sum(axis=1))
        q = p.k - np.divide(p.k * p.l0, length, out=np.zeros(count), where=length > 0)
        gradient = back @ (q[:, None] * d) - p.load
        return float(0.5 * (p.k * (length - p.l0) ** 2).sum() - (p.load * x).sum()), gradient[free].ravel()

    def look(u: Floats) -> None:
        nonlocal steps, due, aside, run
        steps += 1
        if steps >= due:
            paused = time.perf_counter()
            run = Run(paused - begun - aside, steps, placed(u))
            if residual(p, run.x) <= target or run.seconds > most:
                raise _Enough
            due = steps + max(10, steps // 50)
            aside += time.perf_counter() - paused

    with contextlib.suppress(_Enough):
        options = {"maxcor": 20, "ftol": 0, "gtol": 0, "maxiter": 10**7, "maxfun": 10**7}
        found = optimize.minimize(
            energy, p.x[free].ravel(), jac=True, method="L-BFGS-B", callback=look, options=options
        )
        run = Run(time.perf_counter() - begun - aside, steps, placed(found.x))
    return run


def scipy_fdm(p: Problem, target: float, most: float) -> Run:
    """The force density method with scipy's sparse solver: one factor, three right-hand sides."""
    from scipy import sparse
    from scipy.sparse.linalg import splu

    _only_linear(p)
    begun = time.perf_counter()
    free, n = np.flatnonzero(p.free), len(p.x)
    a, b = p.springs.T
    rows, columns = np.concatenate([a, b, a, b]), np.concatenate([a, b, b, a])
    whole = sparse.csr_array((np.concatenate([p.k, p.k, -p.k, -p.k]), (rows, columns)), (n, n))[free]
    x = p.x.copy()
    right = p.load[free] - whole[:, p.fixed] @ x[p.fixed]
    x[free] = splu(whole[:, free].tocsc(), permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True}).solve(right)
    return Run(time.perf_counter() - begun, 1, x)


def shapeop(p: Problem, target: float, most: float) -> Run:
    """ShapeOp (C++, projective dynamics) in its static mode: edge strains of weight k L, anchors of weight 1e6."""
    from compas_shapeop.shapeop import Solver

    if p.load.any() and np.ptp(p.load, axis=0).any():
        raise Unfit("loads that differ cost it the square of their number")
    begun = time.perf_counter()
    solver = Solver()
    solver.points = p.x
    length = np.linalg.norm(p.x[p.springs[:, 1]] - p.x[p.springs[:, 0]], axis=1)
    for (a, b), w, part in zip(p.springs.tolist(), (p.k * length).tolist(), (p.l0 / length).tolist(), strict=True):
        solver.add_edge_strain_constraint(a, b, w, part, part)
    for i in p.fixed.tolist():
        solver.add_closeness_constraint(i, 1e6)
    if p.load.any():
        solver.add_gravity_force(*p.load[0].tolist())
    solver.init()
    done, due, aside = 0, 0, 0.0
    while True:
        solver.solve(10)
        done += 10
        if done < due:
            continue
        paused = time.perf_counter()
        run = Run(paused - begun - aside, done, np.array(solver.points))
        if residual(p, run.x) <= target or run.seconds > most:
            return run
        due = done + done // 50
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
        raise Unfit("force density supports rest length 0 only")


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


def kratos(p: Problem, target: float, most: float) -> Run:
    """Kratos Multiphysics, see kratos.py."""
    from kratos import kratos as run

    return run(p, target, most)


PACKAGES: dict[str, tuple[str, Peer]] = {
    "ShapeOp": ("compas_shapeop", shapeop),
    "compas_dr": ("compas_dr", compas_dr),
    "compas_fd": ("compas_fd", compas_fd),
    "jax_fdm": ("jax_fdm", jax_fdm),
    "Kratos": ("KratosMultiphysics", kratos),
}


def available(shared: Path | None) -> tuple[dict[str, Peer], list[str]]:
    """Peers that can run here, and a sentence for each that cannot."""
    given = shared is not None and (shared / "base.py").exists()
    peers: dict[str, Peer] = {"numba-dr": shared_dr(shared) if given and shared is not None else numba_dr}
    peers.update({"numba-k2": numba_k2, "L-BFGS-B": lbfgsb, "scipy FDM": scipy_fdm})
    said = ["The numba-dr solver is the one of --shared." if given else "The numba-dr solver is the one of peers.py."]
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
