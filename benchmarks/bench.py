"""Times hookean beside its peers and writes one page of tables; `run.py` starts it on one thread.

All solvers of a problem run in turn, in one process, on one thread, round after round; figures are medians and
minima over the rounds. A run ends when the largest out-of-balance force is at most 1e-6 of the larger of the mean
load and the mean spring force, which the bench works out itself. hookean is timed over all of `relax`, its own
checks and the compilation of the scene to arrays included; the peers' clocks stand still while they are judged.
Nobody's import and first (compiling) call counts; hookean's are told apart below the table. The last columns compare
with numba-dr, kinetic damping written by hand (of the shared bench, where one was given). A run marked missed ran out
of time.
"""

from __future__ import annotations

import argparse
import os
import platform
import statistics
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from importlib.metadata import version
from pathlib import Path

import problems
from peers import Peer, Run, Unfit, available, describe
from problems import Problem
from startup import startup

TARGET = 1e-6
CASES = [("cable", 50), ("cable", 1_000), ("membrane", 1_000), ("membrane", 10_000), ("soapfilm", 1_000),
         ("soapfilm", 10_000), ("sheet", 1_000), ("tent", 1_000)]  # fmt: skip
QUICK = [("cable", 50), ("membrane", 1_000), ("soapfilm", 1_000)]
BASE = "numba-dr"

Table = list[list[str]]


@dataclass
class Timed:
    """All runs of one solver on one problem, or why there are none."""

    runs: list[Run] = field(default_factory=list)
    said: str = ""

    @property
    def median(self) -> float:
        """Median seconds."""
        return statistics.median(r.seconds for r in self.runs)

    @property
    def least(self) -> float:
        """Fewest seconds."""
        return min(r.seconds for r in self.runs)


def hookean(p: Problem, solver: str, most: float) -> Callable[[], Run]:
    """A solve of a scene that is built already, to the bench's target by its own tolerance."""
    from hookean.run import relax

    first = relax(problems.scene(p, solver))
    # its residual has another scale; the same force is left over at this tolerance
    _, ours = problems.left_over(p, first.particles)
    scale = first.out_of_balance / first.residual if first.residual > 0 else ours
    scene = problems.scene(p, solver, min(0.99 * TARGET * ours / scale, 1.0))
    scene = scene.model_copy(update={"settings": scene.settings.model_copy(update={"time_limit": most})})
    relax(scene)

    def run() -> Run:
        begun = time.perf_counter()
        result = relax(scene)
        return Run(time.perf_counter() - begun, result.iterations, result.particles)

    return run


def compare(p: Problem, peers: dict[str, Peer], rounds: int, most: float) -> dict[str, Timed]:
    """All solvers on one problem, in turn, `rounds` times over; slow ones once."""
    solves: dict[str, Callable[[], Run]] = {}
    timed: dict[str, Timed] = {}
    for name in ("auto", "relaxation"):
        solves[f"hookean {name}"] = hookean(p, name, most)
    for name, peer in peers.items():
        solves[name] = lambda peer=peer: peer(p, TARGET, most)  # type: ignore[misc]
        if name.startswith(BASE):
            peer(problems.make(p.name, 8), TARGET, 1.0)  # compile
    for turn in range(rounds):
        for name, solve in solves.items():
            entry = timed.setdefault(name, Timed())
            if entry.said or (turn and entry.median > 4.0):
                continue
            try:
                entry.runs.append(solve())
            except Unfit as error:
                entry.said = str(error)
            except Exception as error:  # a peer may fail: that is a result too
                entry.said = describe(error)
    return timed


def rows(p: Problem, size: int, timed: dict[str, Timed]) -> Table:
    """One row for each solver that ran."""
    base = timed.get(f"{BASE} (shared)", timed[BASE])
    table = []
    for name, entry in timed.items():
        if not entry.runs:
            continue
        last = entry.runs[-1]
        reached = problems.residual(p, last.x)
        missed = "" if reached <= TARGET else " (missed)"
        table.append([
            p.name, str(size), name, f"{entry.median:.4f}", f"{entry.least:.4f}", str(len(entry.runs)),
            str(last.iterations or ""), f"{reached:.1e}{missed}", f"{entry.median / base.median:.2f}",
            f"{entry.least / base.least:.2f}",
        ])  # fmt: skip
    return table


def scenes(cases: list[tuple[str, int]], rounds: int) -> Table:
    """Seconds of building the scene (validation) and of compiling it to arrays."""
    from hookean.system import compile

    table = []
    for name, size in cases:
        p = problems.make(name, size)
        built, compiled = [], []
        for _ in range(rounds):
            begun = time.perf_counter()
            scene = problems.scene(p)
            built.append(time.perf_counter() - begun)
            compile(scene)
            compiled.append(time.perf_counter() - begun - built[-1])
        table.append([name, str(size), f"{statistics.median(built):.4f}", f"{statistics.median(compiled):.4f}"])
    return table


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


HEAD = ["problem", "size", "solver", "median s", "min s", "runs", "iterations", "residual",
        "median / numba-dr", "min / numba-dr"]  # fmt: skip


def markdown(head: list[str], body: Table) -> str:
    """A table as Markdown, its columns aligned."""
    wide = [max(len(row[i]) for row in [head, *body]) for i in range(len(head))]
    lines = [head, ["-" * w for w in wide], *body]
    return "\n".join("| " + " | ".join(c.ljust(w) for c, w in zip(row, wide, strict=True)) + " |" for row in lines)


def main() -> None:
    """Run the bench and write its page."""
    parser = argparse.ArgumentParser(description="Times hookean beside its peers.")
    parser.add_argument("--quick", action="store_true", help="three problems, three rounds")
    parser.add_argument("--rounds", type=int, default=0, help="runs of each solver (9, quick: 3)")
    parser.add_argument("--most", type=float, default=20.0, help="seconds after which a run is given up")
    parser.add_argument("--shared", type=Path, help="folder with a numba_dr of its own in base.py, run beside ours")
    parser.add_argument("--only", nargs="*", default=[], help="problems to run, such as cable:50 membrane:1000")
    parser.add_argument("--out", type=Path, default=Path(__file__).parent / "results.md", help="the page to write")
    given = parser.parse_args()
    cases = [(n, int(s)) for n, _, s in (o.partition(":") for o in given.only)] or (QUICK if given.quick else CASES)
    rounds = given.rounds or (3 if given.quick else 9)
    peers, said = available(given.shared)
    body: Table = []
    for name, size in cases:
        p = problems.make(name, size)
        timed = compare(p, peers, rounds, given.most)
        body += rows(p, size, timed)
        said += [f"{solver}, not on {name}: {entry.said}." for solver, entry in timed.items() if entry.said]
        print(f"{name} {size} done", file=sys.stderr)
    starts = [[what, *(f"{s:.2f}" for s in seconds)] for what, seconds in startup()]
    page = [
        "# Benchmark", machine() + ".", (__doc__ or "").split("\n\n", 1)[1].strip(), markdown(HEAD, body),
        "Scene: seconds of building it (validation) and of compiling it to arrays (part of every solve above).",
        markdown(["problem", "size", "build s", "compile s"], scenes(cases, min(rounds, 5))),
        "Start-up of a new process, seconds: a cable of five springs.",
        markdown(["", "import", "first solve", "second solve", "whole process"], starts),
        "\n".join(f"- {line.rstrip('.')}." for line in dict.fromkeys(said)),
    ]  # fmt: skip
    text = "\n\n".join(part for part in page if part) + "\n"
    given.out.write_text(text, encoding="utf-8")
    print(text)
