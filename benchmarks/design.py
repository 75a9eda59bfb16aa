"""Design problems of jax_fdm's examples by hookean and by jax_fdm: objective, seconds from process start, warm, and
until hookean has the objective that jax_fdm ends with. Seconds are those of the processor: other programs do not count.

    python benchmarks/design.py --peer PYTHON     # a Python that has jax_fdm (pip install jax_fdm)

Both get the same arrays, start and stops, one thread, double precision. The objective is that of an evaluation of its
own.

"""

from __future__ import annotations

import argparse
import json
import os
import resource
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
from design_problems import PROBLEMS, Problem

HERE = Path(__file__).parent


def given(p: Problem) -> dict[str, Any]:
    """The problem as hookean takes it."""
    free = p.free
    forces = [
        {"kind": "springs", "name": "net", "particles": p.edges, "stiffness": p.start, "rest_length": 0.0},
        {"kind": "unary", "particles": free, "vector": p.loads[free]},
    ]
    goals: list[dict[str, Any]] = []
    for kind, which, target, weight in p.goals:
        if kind == "load_path":
            goals.append({"kind": kind, "force": "net", "weight": weight})
        elif kind in ("z", "plane", "point"):
            axes = {"z": "z", "plane": "x", "point": "xyz"}[kind]
            goals.append({"kind": "position", "particles": which, "axes": axes, "target": target, "weight": weight})
        elif kind == "reaction":
            order = np.argsort(which)  # as the anchor has its particles
            wanted = np.asarray(target)[order]
            goals.append({"kind": "reaction", "anchor": "rim", "size": True, "target": wanted, "weight": weight})
        else:
            goals.append({"kind": kind, "force": "net", "elements": which, "target": target, "weight": weight})
    lower, upper = (end if np.isfinite(end) else None for end in p.bounds)
    anchors = [{"name": "rim", "particles": p.supports}]
    return {
        "scene": {"particles": p.points, "forces": forces, "anchors": anchors},
        "variables": [{"force": "net", "field": "stiffness", "lower": lower, "upper": upper}],
        "goals": goals,
        "constraints": [
            {"kind": "length", "force": "net", "lower": low, "upper": high}
            for low, high in ([p.lengths] if p.lengths else [])
        ],
        "settings": {"tolerance": p.tolerance, "max_iterations": min(p.most, 200)},
    }


def own(name: str) -> None:
    """Solve twice."""
    import hookean

    seconds = []
    way: list[tuple[float, float]] = []
    for _ in range(2):
        way.clear()
        start = time.process_time()
        found = hookean.design(
            given(PROBLEMS[name]()), progress=lambda _, best, at=start: way.append((time.process_time() - at, best))
        )
        seconds.append(time.process_time() - start)
    q = np.asarray(found.variables[0]["value"]).tolist()
    print("ANSWER" + json.dumps({"q": q, "seconds": seconds, "status": str(found.status), "way": way}))


def used() -> float:
    """Seconds of the processor that processes that have ended took."""
    spent = resource.getrusage(resource.RUSAGE_CHILDREN)
    return spent.ru_utime + spent.ru_stime


def run(command: list[str]) -> tuple[dict[str, Any] | None, float]:
    """What a program answered, and the seconds of the whole process."""
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1", "MKL_NUM_THREADS": "1",
                   "XLA_FLAGS": "--xla_cpu_multi_thread_eigen=false intra_op_parallelism_threads=1"}  # fmt: skip
    environment.pop("PYTHONDONTWRITEBYTECODE", None)  # as installed: packages of both are compiled once
    start = used()
    done = subprocess.run(command, capture_output=True, text=True, env=environment, cwd=HERE, check=False)
    seconds = used() - start
    lines = [line for line in done.stdout.splitlines() if line.startswith("ANSWER")]
    if not lines:
        print(done.stderr[-2000:], file=sys.stderr)
        return None, seconds
    return json.loads(lines[0].removeprefix("ANSWER")), seconds


def row(name: str, who: str, answer: dict[str, Any] | None, whole: float, peer: dict[str, Any] | None) -> str:
    """A line of the table."""
    if answer is None:
        return f"| {name} | {who} | failed | | | |"
    p, q = PROBLEMS[name](), np.asarray(answer["q"])
    missed = p.missed(q)
    value = f"{p.objective(q):.6g}" + (f", limits missed by {missed:.1e}" if missed > 1e-9 else "")
    _, again = answer["seconds"]
    reached = ""
    if peer is not None and "way" in answer:
        goal = p.objective(np.asarray(peer["q"]))
        goal = goal**2 * len(p.free) if p.loss == "RootMeanSquaredError" else goal
        reached = next((f"{at:.2f}" for at, best in answer["way"] if best <= goal), "not reached")
    return f"| {name} | {who} | {value} | {whole - again:.2f} | {again:.2f} | {reached} |"


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--peer", help="a Python that has jax_fdm")
    parser.add_argument("--most", type=int, default=2000, help="largest net [nodes] that the peer gets (default 2000)")
    parser.add_argument("--run", help=argparse.SUPPRESS)
    parser.add_argument("names", nargs="*", default=list(PROBLEMS))
    args = parser.parse_args()
    if args.run:
        own(args.run)
        return
    print("| problem | program | objective | from process start [s] | warm [s] | warm, to jax_fdm's objective [s] |")
    print("| --- | --- | --- | --- | --- | --- |")
    for name in args.names:
        own_answer, whole = run([sys.executable, "design.py", "--run", name])
        other = None
        if args.peer and len(PROBLEMS[name]().points) <= args.most:
            other, long = run([str(Path(args.peer).absolute()), "design_peer.py", name])
        print(row(name, "hookean", own_answer, whole, other), flush=True)
        if other is not None:
            print(row(name, "jax_fdm", other, long, None), flush=True)


if __name__ == "__main__":
    main()
