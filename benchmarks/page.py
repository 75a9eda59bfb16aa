"""The bench's tables as Markdown: the whole page, and the short one that the README shows."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

Table = list[list[str]]
BEGIN, END = "<!-- speed: written by make bench -->", "<!-- end of speed -->"


@dataclass
class Row:
    """One solver on one problem."""

    problem: str
    size: int
    solver: str
    median: float
    least: float
    runs: int
    iterations: int
    work: float
    residual: float
    allowed: float
    error: float  # of the shape, by the size of the model
    left: float  # residual of the reference
    ratio: float  # times as fast as numba-dr
    memory: float  # MB; 0: not measured

    @property
    def missed(self) -> bool:
        """Whether it ended short of the target."""
        return not self.residual <= self.allowed


def markdown(head: list[str], body: Table) -> str:
    """A table as Markdown, its columns aligned."""
    wide = [max(len(row[i]) for row in [head, *body]) for i in range(len(head))]
    lines = [head, ["-" * w for w in wide], *body]
    return "\n".join("| " + " | ".join(c.ljust(w) for c, w in zip(row, wide, strict=True)) + " |" for row in lines)


def figure(value: float, digits: int = 3) -> str:
    """A number to three figures, without an exponent where it is of ordinary size."""
    if not math.isfinite(value):
        return "-"
    if value == 0.0 or not 1e-4 <= abs(value) < 1e6:
        return f"{value:.{digits - 1}e}"
    return f"{value:.{max(0, digits - 1 - math.floor(math.log10(abs(value))))}f}"


def solved(table: list[Row]) -> str:
    """All solves."""
    head = ["problem", "size", "solver", "seconds", "least", "runs", "iterations", "work", "residual", "shape",
            "times as fast", "peak MB"]  # fmt: skip
    body = [
        [
            r.problem, str(r.size), r.solver, figure(r.median), figure(r.least), str(r.runs), str(r.iterations or ""),
            f"{r.work:.0f}" if r.work else "", f"{r.residual:.1e}{' (missed)' if r.missed else ''}",
            f"{r.error:.1e}{'?' if r.left > 1e-7 and r.left > r.allowed / 2 else ''}", figure(r.ratio),
            f"{r.memory:.0f}" if r.memory else "",
        ]
        for r in table
    ]  # fmt: skip
    told = "A ? after a shape error: the reference itself is no more accurate than 1e-7."
    return "## Equilibrium\n\n" + markdown(head, body) + "\n\n" + told


def stepped(steps: dict[tuple[str, int], float]) -> str:
    """Time steps on the membrane's net."""
    sizes, names = sorted({size for _, size in steps}), list(dict.fromkeys(name for name, _ in steps))
    body = []
    for name in names:
        cells = []
        for size in sizes:
            rate = steps.get((name, size))
            beside = steps.get(("C, scalar", size))
            part = f" ({rate / beside:.2f})" if rate and beside and name != "C, scalar" else ""
            cells.append(f"{rate / 1e6:.1f}{part}" if rate else "-")
        body.append([name, *cells])
    told = "Millions of particle steps per second on the membrane. In brackets: the ratio to step.c, run in turn."
    return f"## Steps\n\n{told}\n\n" + markdown(["", *(str(s) for s in sizes)], body)


def framed(found: dict[int, float]) -> str:
    """Frames of the falling shell."""
    body = [[str(count), f"{rate:.0f}"] for count, rate in found.items()]
    told = "A mesh sphere with springs and shell lands on a floor; 20 time steps per frame."
    return f"## Shell\n\n{told}\n\n" + markdown(["particles", "frames/s"], body)


def started(starts: list[tuple[str, list[float]]]) -> str:
    """Whole processes."""
    told = "Seconds from starting a process to the result, for the cable of 50 springs."
    body = [[what, str(len(s)), figure(min(s)), figure(sorted(s)[len(s) // 2])] for what, s in starts]
    return f"## Start\n\n{told}\n\n" + markdown(["", "runs", "least", "median"], body)


def short(
    table: list[Row], steps: dict[tuple[str, int], float] | None, starts: list[tuple[str, list[float]]] | None,
    machine: str,
) -> str:  # fmt: skip
    """The README's table: hookean beside numba-dr and the quickest package, with the page's figures."""
    ours = ("hookean", "numba-dr", "numba-k2")
    body = []
    for row in (r for r in table if r.solver == "hookean"):
        same = {r.solver: r for r in table if (r.problem, r.size) == (row.problem, row.size) and not r.missed}
        base = same.get("numba-dr")
        others = sorted((r for name, r in same.items() if name not in ours), key=lambda r: r.median)
        best = f"{others[0].solver} {figure(others[0].median)}" if others else "-"
        body.append([
            f"{row.problem} {row.size}", figure(row.median) + (" (missed)" if row.missed else ""),
            figure(base.median) if base else "-", best,
        ])  # fmt: skip
    lines = [f"Seconds on one thread to a residual of 1e-6: {machine}.", ""]
    lines.append(markdown(["problem, size", "hookean", "numba-dr", "quickest package"], body))
    if steps:
        rates = [f"{rate / 1e6:.0f} at {size}" for (name, size), rate in steps.items() if name.startswith("hookean")]
        lines += ["", f"Time steps, in millions of particles per second: {', '.join(rates)}."]
    for what, seconds in starts or []:
        lines += [
            "",
            f"{what}: {figure(sorted(seconds)[len(seconds) // 2])} s from starting the process to the result.",
        ]
    return "\n".join(lines)


def put(readme: Path, text: str) -> None:
    """Write the short table between its marks; ValueError where there are none."""
    whole = readme.read_text(encoding="utf-8")
    before, begin, rest = whole.partition(BEGIN)
    _, end, after = rest.partition(END)
    if not begin or not end:
        raise ValueError(f"{readme} has no place for the speed table: {BEGIN} ... {END}")
    readme.write_text(f"{before}{BEGIN}\n{text}\n{END}{after}", encoding="utf-8")
