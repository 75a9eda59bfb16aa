"""`hookean explore`: a design problem in, a table of samples of its variables and the best of them as pictures out."""

from __future__ import annotations

import csv
import io
import json
import sys
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from hookean.commands import outputs, relax
from hookean.commands.command import taking
from hookean.commands.design import opened
from hookean.errors import InputError

if TYPE_CHECKING:
    from hookean.designing.exploring import Exploration

DONE, NOTHING = 0, 3
THUMBNAILS = 8
Sampling = StrEnum("Sampling", {"sobol": "sobol", "latin_hypercube": "latin-hypercube", "grid": "grid"})


@dataclass(frozen=True)
class Options:
    """Sample the variables of a design problem between their bounds, and show the samples that no other one beats.

    The problem is that of `hookean design`, with lower and upper of every variable; with several goals the best samples
    are their front of Pareto. Exits with 0, with 2 for bad input, 3 if no sample is at rest within the constraints, 130
    if it was stopped by Ctrl-C.
    """

    problem: Annotated[Path, typer.Argument(metavar="FILE", help="Problem (TOML, JSON)")]
    count: Annotated[int, typer.Option("--count", "-n", help="Samples; of a grid the most")] = 64
    sampling: Annotated[Sampling, typer.Option(help="How to sample")] = Sampling.sobol
    seed: Annotated[int, typer.Option(help="Seed of the samples")] = 0
    workers: Annotated[int, typer.Option(min=1, help="Processes that solve side by side")] = 1
    csv: Annotated[str | None, typer.Option(metavar="PATH", help="Write a table (CSV), a row for each sample")] = None
    picture: Annotated[
        str | None, typer.Option(metavar="PATH", help="Draw goals and the best samples as a picture (PNG)")
    ] = None
    report: Annotated[str | None, typer.Option(metavar="PATH", help="Write everything as JSON")] = None
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Only print errors and notes")] = False


def run(options: Options) -> int:
    """Explore, print and write."""
    from hookean.atomic_write import put

    try:
        source = options.problem
        table = outputs.place(options.csv, source, ".explored.csv")
        picture = outputs.place(options.picture, source, ".explored.png")
        report = outputs.place(options.report, source, ".explored.json")
        relax.check_picture(picture)
        problem, _, drawing = opened(source)
        outputs.check((table, picture, report), [source, drawing])
        with outputs.folders((table, picture, report)):
            found = _explored(problem, options)
            if table is not None:
                put(table, text(found).encode(), lambda back: None)
            if report is not None:
                put(report, json.dumps(found.to_dict()).encode(), lambda back: None)
            if picture is not None:
                from hookean.pictures.explored import draw

                draw(found, picture, title=source.stem, most=THUMBNAILS)
    except InputError as error:
        return relax.bad(error)
    except KeyboardInterrupt:
        typer.echo(f"hookean: {options.problem.name}: stopped, nothing written", err=True)
        return relax.STOPPED
    if not options.quiet:
        _print(found)
    return DONE if found.front else NOTHING


def _explored(problem: Any, options: Options) -> Exploration:
    from hookean.designing.exploring import explore

    shown = sys.stderr.isatty() and not options.quiet

    def progress(done: int) -> None:
        if shown:
            typer.echo(f"\r{done} samples ", nl=False, err=True)

    sampling: Any = options.sampling.name
    with _workers(options.workers) as executor:
        found = explore(
            problem, options.count, sampling=sampling, seed=options.seed, executor=executor, progress=progress
        )
    if shown:
        typer.echo(err=True)
    return found


def _workers(count: int) -> AbstractContextManager[Any]:
    if count == 1:
        return nullcontext()
    from concurrent.futures import ProcessPoolExecutor
    from multiprocessing import get_context

    return ProcessPoolExecutor(count, mp_context=get_context("spawn"))


def text(found: Exploration) -> str:
    """The table as CSV, with units in its first line."""
    from hookean.files import cells

    heads = ["number", *found.names, "status", *(f"{g} [{u}]" for g, u in zip(found.goals, found.units, strict=True))]
    stream = io.StringIO()
    writer = csv.writer(stream)
    writer.writerow(cells.row([*heads, "met", "front"]))
    for row in found.rows():
        writer.writerow(cells.row(["" if value != value else value for value in row.values()]))
    return stream.getvalue()


def _print(found: Exploration) -> None:
    typer.echo(repr(found).removeprefix("Exploration: "))
    rows = found.rows()
    for number in found.front[:20]:
        row = rows[number]
        pairs = ((name.rstrip("]").partition(" ["), row[name]) for name in found.names[:6])
        values = ", ".join(f"{name} {value:.4g} {unit}".rstrip() for (name, _, unit), value in pairs)
        more = ", ..." if len(found.names) > 6 else ""
        goals = ", ".join(f"{g} {row[g]:.4g} {u}" for g, u in zip(found.goals, found.units, strict=True))
        typer.echo(f"  {number}: {goals} ({values}{more})")
    if len(found.front) > 20:
        typer.echo(f"  ... {len(found.front) - 20} more; --csv writes all")


app = taking(Options, run)
