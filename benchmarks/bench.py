"""Times hookean and other solvers and writes one page of tables; `run.py` starts it on one thread.

The solvers of a problem run in turn, round after round, in one process on one thread. `seconds` is the median over the
rounds and `least` the shortest time. A run ends when the largest out-of-balance force is at most 1e-6 of the larger of
the mean load and the mean spring force (or rounding allows no less). The benchmark computes this residual itself.
`shape` is the largest distance from a reference solution of the highest possible accuracy, divided by the size of the
model. The time of hookean includes all of `relax`: its own checks and the compilation of the scene to arrays. The
clocks of the other solvers are stopped while their residual is computed. Imports and the first (compiling) call are not
timed. `work` is in passes over all springs: the number that the solver reports, otherwise its iterations. `times as
fast` compares medians with numba-dr, a hand-written dynamic relaxation with kinetic damping. Peak memory is that of a
process that does nothing else. A run marked missed ran out of time or, of Kratos, has another law of springs.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import platform
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
import page
import problems
from peers import Floats, Peer, Run, Unfit, available, describe
from problems import Problem
from startup import startup
from stepping import frames, stepping

TARGET = 1e-6
SIZES = [50, 1_000, 10_000, 100_000, 1_000_000]
LARGE = 1_000_000  # in processes of their own, hookean alone
HEAVY = 100_000  # from here on memory is told
BASE = "numba-dr"
OURS = "hookean"
SPEND = 4.0  # seconds for all rounds of one solver on one problem; one run there is always
PARTS = ("solve", "steps", "start")


@dataclass
class Timed:
    """All runs of one solver on one problem, or why there are none."""

    runs: list[Run] = field(default_factory=list)
    said: str = ""
    memory: float = 0.0  # MB, where it was measured

    @property
    def median(self) -> float:
        """Median seconds."""
        return statistics.median(r.seconds for r in self.runs)

    @property
    def least(self) -> float:
        """Fewest seconds."""
        return min(r.seconds for r in self.runs)


def cases(names: list[str], sizes: list[int]) -> list[tuple[str, int]]:
    """What to solve: cables of 50 to 1e5, nets of 1e3 to 1e5, a membrane and a soap film of 1e6."""
    found = [(n, s) for n in problems.PROBLEMS for s in SIZES if (s >= 1_000 or n == "cable")]
    found = [(n, s) for n, s in found if s < LARGE or n in ("membrane", "soapfilm")]
    return [(n, s) for n, s in found if (not names or n in names) and (not sizes or s in sizes)]


def scene_for(p: Problem, most: float, solver: str = "auto") -> Any:
    """The problem as a scene that hookean solves to the bench's target by its own residual.

    That has another scale, the mean load; a shape found to 1e-3 tells how the two compare.
    """
    from hookean.running.run import relax

    def limited(tolerance: float) -> Any:
        scene = problems.scene(p, solver, min(tolerance, 1.0))
        return scene.model_copy(update={"settings": scene.settings.model_copy(update={"time_limit": most})})

    first = relax(limited(1e-3))
    _, ours = problems.left_over(p, first.particles)
    theirs = first.out_of_balance / first.residual if first.residual > 0 else ours
    return limited(0.98 * TARGET * ours / theirs)


def hookean(p: Problem, most: float) -> Callable[[], Run]:
    """A solve of a scene that is built already: `relax`, with its solver at hand to ask for its work."""
    from hookean.running.run import relax_state
    from hookean.solvers import solver
    from hookean.system.system import compile

    scene = scene_for(p, most)

    def run() -> Run:
        begun = time.perf_counter()
        system, method = compile(scene), solver(scene.settings.solver)
        result = relax_state(system, system.start(), method)
        seconds = time.perf_counter() - begun
        return Run(seconds, result.iterations, result.particles, method.work)

    return run


def alone(name: str, size: int, most: float) -> tuple[Run, float]:
    """One solve by hookean in a process of its own, and the megabytes it took."""
    with tempfile.TemporaryDirectory() as folder:
        shape = Path(folder) / "x.npy"
        command = [sys.executable, __file__, "--child", name, str(size), str(shape), "--most", str(most)]
        done = subprocess.run(command, capture_output=True, text=True, check=True, timeout=10.0 * most + 120.0)
        told = json.loads(done.stdout.splitlines()[-1])
        return Run(told["seconds"], told["iterations"], np.load(shape), told["work"]), told["memory"]


def child(name: str, size: int, shape: Path, most: float) -> None:
    """The other side of `alone`: a small problem first, to compile; then this one, at the bench's scale for large."""
    import resource

    hookean(problems.make(name, 8 if size >= 1_000 else size), most)()
    run = hookean(problems.make(name, size), most)()
    np.save(shape, run.x)
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
    print(json.dumps({"seconds": run.seconds, "iterations": run.iterations, "work": run.work, "memory": memory}))


def compare(p: Problem, peers: dict[str, Peer], rounds: int, most: float, slow: dict[str, str]) -> dict[str, Timed]:
    """All solvers on one problem, in turn, `rounds` times over; slow ones once, those in `slow` never."""
    solves: dict[str, Callable[[], Run]] = {OURS: hookean(p, most)}
    timed = {name: Timed(said=slow.get(name, "")) for name in (OURS, *peers)}
    for name, peer in peers.items():
        solves[name] = lambda peer=peer: peer(p, TARGET, most)  # type: ignore[misc]
        if name.startswith("numba"):
            peer(problems.make(p.name, 8), TARGET, 600.0)  # compile all of it, however long that takes
    for _ in range(rounds):
        for name, solve in solves.items():
            entry = timed[name]
            if entry.said or sum(r.seconds for r in entry.runs) > SPEND:
                continue
            try:
                entry.runs.append(solve())
            except Unfit as error:
                entry.said = str(error)
            except Exception as error:  # a peer may fail: that is a result too
                entry.said = describe(error)
    return timed


def reference(p: Problem, timed: dict[str, Timed], most: float) -> tuple[Floats, float]:
    """The shape with the least left over, of all runs and of one solved as far as it goes; and what is left of it."""
    from hookean.running.run import relax

    shapes = [entry.runs[-1].x for entry in timed.values() if entry.runs]
    if len(p.x) < LARGE // 2:
        scene = problems.scene(p, "auto", 1e-10)
        settings = scene.settings.model_copy(update={"time_limit": most})
        shapes.append(relax(scene.model_copy(update={"settings": settings})).particles)
    return min(((x, problems.residual(p, x)) for x in shapes), key=lambda found: found[1])


def rows(p: Problem, size: int, timed: dict[str, Timed], most: float) -> list[page.Row]:
    """One row for each solver that ran."""
    best, left = reference(p, timed, most)
    extent = float(np.ptp(p.x, axis=0).max())
    base = timed[BASE].median if BASE in timed and timed[BASE].runs else math.nan
    found = []
    for name, entry in timed.items():
        if entry.runs:
            last = entry.runs[-1]
            error = float(np.linalg.norm(last.x - best, axis=1).max()) / extent
            found.append(
                page.Row(
                    p.name,
                    size,
                    name,
                    entry.median,
                    entry.least,
                    len(entry.runs),
                    last.iterations,
                    last.work,
                    problems.residual(p, last.x),
                    max(TARGET, 2.0 * problems.rounding(p, best)),
                    error,
                    left,
                    base / entry.median,
                    entry.memory,
                )
            )
    return found


def solve(given: argparse.Namespace, peers: dict[str, Peer]) -> tuple[list[page.Row], list[str]]:
    """All problems of the table; and what to say of those that did not run."""
    table: list[page.Row] = []
    said: list[str] = []
    last: dict[tuple[str, str], tuple[int, float]] = {}
    for name, size in cases(given.only, given.sizes):
        begun = time.perf_counter()
        p = problems.make(name, size)
        if size >= LARGE:
            run, memory = alone(name, size, 10.0 * given.most)
            timed = {OURS: Timed([run], memory=memory)}
            if name == "soapfilm":
                timed["scipy FDM"] = Timed(said="the factorization takes minutes")
        else:
            slow = {}
            for peer in peers:
                before, seconds = last.get((name, peer), (size, 0.0))
                if seconds * size / before > given.most:
                    slow[peer] = f"it took {seconds:.3g} s at {before}"
            timed = compare(p, peers, given.rounds, given.most, slow)
            if size >= HEAVY:
                _, timed[OURS].memory = alone(name, size, given.most)
        for solver, entry in timed.items():
            if entry.runs:
                last[name, solver] = size, entry.median
        table += rows(p, size, timed, given.most)
        said += [
            f"{solver} was not run on {name} {size}: {entry.said}." for solver, entry in timed.items() if entry.said
        ]
        print(f"{name} {size}: {time.perf_counter() - begun:.1f} s", file=sys.stderr, flush=True)
    return table, said


def machine() -> str:
    """The machine and what ran on it, in one line."""
    cpu = platform.processor() or platform.machine()
    try:
        names = [line for line in Path("/proc/cpuinfo").read_text().splitlines() if line.startswith("model name")]
        cpu = names[0].split(":", 1)[1].strip()
    except (OSError, IndexError):
        pass
    versions = ", ".join(f"{name} {version(name)}" for name in ("hookean", "numpy", "scipy", "numba"))
    system = f"{platform.system()}, Python {platform.python_version()}"
    return f"{cpu}, {os.cpu_count()} cores (one used), {system}, {versions}"


def options() -> argparse.Namespace:
    """What the command line asks for."""
    parser = argparse.ArgumentParser(description="Times hookean beside its peers.")
    parser.add_argument("--only", nargs="*", default=[], choices=list(problems.PROBLEMS), help="problems to solve")
    parser.add_argument("--sizes", nargs="*", type=int, default=[], help="their sizes, such as 50 1000 100000")
    parser.add_argument("--parts", nargs="*", default=PARTS, choices=PARTS, help="parts of the bench")
    parser.add_argument("--rounds", type=int, default=11, help="runs of each quick solver")
    parser.add_argument("--most", type=float, default=25.0, help="seconds after which a run is given up")
    parser.add_argument("--shared", type=Path, help="folder with a numba_dr of its own in base.py, run for ours")
    parser.add_argument("--out", type=Path, default=Path(__file__).parent / "results.md", help="the page to write")
    parser.add_argument("--readme", type=Path, help="a README whose speed table is written too")
    parser.add_argument("--child", nargs=3, help=argparse.SUPPRESS)
    return parser.parse_args()


def main() -> None:
    """Run the bench and write its page."""
    given = options()
    if given.child is not None:
        name, size, shape = given.child
        child(name, int(size), Path(shape), given.most)
        return
    here = machine()
    peers, said = available(given.shared)
    parts: list[str] = []
    table: list[page.Row] = []
    if "solve" in given.parts:
        table, more = solve(given, peers)
        said += more
        parts.append(page.solved(table))
    steps = stepping() if "steps" in given.parts else None
    if steps is not None:
        parts += [page.stepped(steps), page.framed(frames())]
    starts = startup() if "start" in given.parts else None
    if starts is not None:
        parts.append(page.started(starts))
    notes = "\n".join(f"- {line.rstrip('.')}." for line in dict.fromkeys(said))
    text = "\n\n".join(["# Benchmark", here + ".", (__doc__ or "").split("\n\n", 1)[1].strip(), *parts, notes])
    given.out.write_text(text + "\n", encoding="utf-8")
    print(text)
    if given.readme is not None:
        page.put(given.readme, page.short(table, steps, starts, here))


if __name__ == "__main__":
    main()
