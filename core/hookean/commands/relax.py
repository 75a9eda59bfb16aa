"""`hookean relax`: files in, files out, and an exit code."""

from __future__ import annotations

import contextlib
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from hookean.commands import command, outputs
from hookean.errors import InputError

if TYPE_CHECKING:
    from hookean.files.relax_file import FileResult

CONVERGED, EXCEEDED, BAD_INPUT, NOT_CONVERGED, STOPPED = 0, 1, 2, 3, 130
_VERBS = ("is ", "has ", "holds ", "ends ", "cannot ", "would ", "needs ")
SHOW_AFTER = 0.5  # seconds of solving before a progress line appears


@dataclass(frozen=True)
class Options:
    """Relax files: cables, nets and membranes go to equilibrium. The input is never changed.

    Exits with 0 if all converged, 1 if a limit is exceeded, 2 for bad input, 3 if no equilibrium was found.

    Without a recipe, the names of layers (springs, cables, membrane, anchors, loads, floor, geometry) and the user text
    of objects (stiffness, rest_factor, divide, load, axes ...) define the model; without such layers curves become
    springs and meshes membranes, held at loose ends and naked vertices. Numbers are in m, N and s.
    --explain prints how each file is read. Missing output folders are made. With several input files, or if it ends in
    a slash, an output path is a folder, and files in it are named after their input.
    """

    files: Annotated[list[Path], typer.Argument(help=".3dm, .obj, .json, .npz or .hookean files")]
    output: Annotated[
        str | None,
        typer.Option(
            "--output", "-o", metavar="PATH", help=".3dm, .json, .obj, .dxf, .vtu, .inp, .ifc file, or a folder/"
        ),
    ] = None
    recipe: Annotated[
        Path | None, typer.Option("--recipe", "-r", help="Recipe (TOML, JSON); default: layer names define the model")
    ] = None
    explain: Annotated[
        bool, typer.Option("--explain", help="Print how the files would be interpreted, without solving")
    ] = False
    report: Annotated[
        str | None,
        typer.Option(metavar="PATH", help="Write all results as JSON, to a file or folder/ (so do the next two)"),
    ] = None
    csv: Annotated[
        str | None, typer.Option(metavar="PATH", help="Write a table (CSV), a row for each element and reaction")
    ] = None
    picture: Annotated[str | None, typer.Option(metavar="PATH", help="Draw a picture (PNG) of the result")] = None
    check: Annotated[
        Path | None,
        typer.Option(help="Limits (TOML, JSON) of force, stress, moment, strain, displacement, reaction, slack"),
    ] = None
    case: Annotated[
        str | None,
        typer.Option(metavar="NAME", help="Freeze the form and solve this load case or combination of the recipe"),
    ] = None
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Only print errors and notes")] = False


@dataclass(frozen=True)
class _Job:
    source: Path
    output: Path | None
    report: Path | None
    csv: Path | None
    picture: Path | None

    @property
    def targets(self) -> tuple[Path | None, ...]:
        return self.output, self.report, self.csv, self.picture


def run(options: Options) -> int:
    """Relax every file; the exit code is the most severe: bad input, then not converged, then a limit exceeded."""
    codes: list[int] = []
    try:
        recipe = None if options.recipe is None else text_of(options.recipe)
        name = str(options.recipe) if options.recipe is not None else ""
        if options.explain:
            return max(_explained(file, recipe, name) for file in options.files)
        limits = _limits(options.check), str(options.check) if options.check is not None else ""
        jobs = _jobs(options)
    except InputError as error:
        return bad(error)
    for job in jobs:
        try:
            with outputs.folders(job.targets):
                codes.append(_one(job, recipe, name, limits, options))
        except InputError as error:
            codes.append(bad(error))
            if "nothing to relax" in error.sentence:
                print_notes(job.source, forgotten(job.source, options.recipe))
        except KeyboardInterrupt:
            typer.echo(f"hookean: {job.source.name}: stopped, nothing written", err=True)
            return STOPPED
    return next((code for code in (BAD_INPUT, NOT_CONVERGED, EXCEEDED) if code in codes), CONVERGED)


def _one(job: _Job, recipe: str | None, name: str, limits: tuple[dict[str, Any] | None, str], options: Options) -> int:
    from hookean.atomic_write import put
    from hookean.files.relax_file import LimitsError, relax_file, report_json

    fault: InputError | None = None
    quiet = options.quiet
    with _progress(job.source.name, quiet) as progress:
        try:
            found = relax_file(
                job.source, job.output, recipe, recipe_name=name, limits=limits[0], limits_name=limits[1],
                progress=progress, case=options.case,
            )  # fmt: skip
        except LimitsError as error:
            found, fault = error.found, error
    if job.report is not None:
        put(job.report, report_json(found), lambda back: None)
    if job.csv is not None:
        put(job.csv, found.csv.encode(), lambda back: None)
    if job.picture is not None:
        from hookean.pictures.picture import render

        render(found.result, job.picture, scene=found.scene, title=job.source.stem)
    print_notes(job.source, [*found.warnings, *forgotten(job.source, recipe)])
    for sentence in found.exceeded:
        typer.echo(f"hookean: {job.source.name}: limit exceeded: {sentence}", err=True)
    if not found.result.converged:
        wrote = f" The last good shape was written to {job.output}." if job.output is not None else ""
        typer.echo(f"hookean: {job.source.name}: {found.result.message}{wrote}", err=True)
    if fault is not None:
        raise fault
    if not found.result.converged:
        return NOT_CONVERGED
    if not quiet:
        written = ", ".join(str(target) for target in job.targets if target is not None)
        where = f"-> {written}" if written else "(nothing written; use -o to write a file)"
        typer.echo(f"{job.source.name}: {found.result.message} {where}")
        for line in summary(found):
            typer.echo(f"  {line}")
    return EXCEEDED if found.exceeded else CONVERGED


def summary(found: FileResult) -> list[str]:
    """A few lines on a result: particles, largest displacement, forces of each table, reactions."""
    first, *more = found.result.summary()
    merged, unit, z = found.result.report.merged, found.result.units.length, found.result.particles[:, 2]
    where = [f"moved by up to {found.moved:.4g} {unit}; z from {z.min():.4g} to {z.max():.4g} {unit}"] if len(z) else []
    return [first, *([f"{merged} point{'s' * (merged != 1)} merged"] if merged else []), *where, *more]


def print_notes(source: Path, notes: Sequence[str]) -> None:
    """Notes on a file, on standard error."""
    for sentence in notes:
        typer.echo(f"hookean: {source.name}: note: {sentence}", err=True)


def forgotten(source: Path, recipe: Path | str | None) -> list[str]:
    """A note if there are recipes beside a model that is read without one."""
    beside = sorted(source.parent.glob("recipe*.toml"), key=lambda p: (p.name != "recipe.toml", p.name))
    if recipe is not None or source.suffix.lower() != ".3dm" or not beside:
        return []
    return [f"{beside[0].name} in the same folder is not used; to use it, add -r {beside[0]}"]


def _explained(file: Path, recipe: str | None, name: str) -> int:
    from hookean.files.relax_file import explained

    try:
        lines, fault = explained(file, recipe, name)
    except InputError as error:
        return bad(error)
    typer.echo("\n".join(lines))
    print_notes(file, forgotten(file, recipe))
    return CONVERGED if fault is None else bad(fault)


def bad(error: InputError) -> int:
    """Print an error in one line; returns the exit code for it."""
    # a sentence that goes on from what it is about needs no colon: "a.toml is a recipe"
    joint = " " if error.sentence.startswith(_VERBS) and not error.pointer.startswith("/") else ": "
    line = f"{error.pointer}{joint}{error.sentence}" if error.pointer else error.sentence
    typer.echo(f"hookean: {' '.join(line.split())}", err=True)
    return BAD_INPUT


def text_of(path: Path) -> str:
    """The text in a file; raises InputError if it cannot be read."""
    if path.suffix.lower() == ".3dm":
        raise InputError(
            str(path),
            "is a Rhino model, not a recipe; swap the two: the model is an argument, the recipe (.toml) follows -r",
        )
    try:
        return path.read_bytes().decode("utf-8")
    except UnicodeDecodeError:
        raise InputError(str(path), "is not UTF-8 text; save it as UTF-8") from None
    except (OSError, ValueError) as error:
        why = getattr(error, "strerror", None) or "invalid path"
        raise InputError(str(path), f"cannot be read ({why}); check the path") from None


def _limits(path: Path | None) -> dict[str, Any] | None:
    if path is None:
        return None
    text = text_of(path)
    from hookean.files.limits import read_limits

    return read_limits(text, path.name)


def _jobs(options: Options) -> list[_Job]:
    """The output files of each input; raises InputError, before solving, if two are the same or one is an input."""
    many = len(options.files) > 1
    jobs = [
        _Job(
            file,
            outputs.place(options.output, file, file.suffix or ".3dm", many=many),
            outputs.place(options.report, file, ".report.json", many=many),
            outputs.place(options.csv, file, ".csv", many=many),
            outputs.place(options.picture, file, ".png", many=many),
        )
        for file in options.files
    ]
    for job in jobs:
        check_picture(job.picture)
    targets = [target for job in jobs for target in job.targets]
    outputs.check(targets, (*options.files, options.recipe, options.check))
    return jobs


def check_picture(path: Path | None) -> None:
    """Raises InputError for a picture that is not a PNG."""
    if path is not None and path.suffix.lower() != ".png":
        raise InputError(path.name, "is not a .png file; give a name that ends in .png")


@contextlib.contextmanager
def _progress(name: str, quiet: bool) -> Iterator[Callable[[int, float], None] | None]:
    """A progress line of a long relaxation, on a terminal only."""
    if quiet or not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console
    from rich.progress import Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

    columns = (SpinnerColumn(), TextColumn("{task.description}"), TimeElapsedColumn())
    line = Progress(*columns, console=Console(stderr=True), transient=True)
    task = line.add_task(name, total=None)
    began, shown = time.monotonic(), False

    def advance(iteration: int, residual: float) -> None:
        nonlocal shown
        if not shown and time.monotonic() - began > SHOW_AFTER:
            line.start()
            shown = True
        if shown:
            line.update(task, description=f"{name}: iteration {iteration}, residual {residual:.2g}")

    try:
        yield advance
    finally:
        if shown:
            line.stop()


app = command.taking(Options, run)
