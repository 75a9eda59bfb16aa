"""`hookean design`: a design problem in, the best values and their equilibrium out, and an exit code."""

from __future__ import annotations

import contextlib
import json
import signal
import sys
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from hookean.commands import outputs, relax
from hookean.commands.command import taking
from hookean.errors import InputError

if TYPE_CHECKING:
    from hookean.designing.answer import Design
    from hookean.designing.problem import Problem
    from hookean.files.readers import Source

CONVERGED, INFEASIBLE, NOT_CONVERGED = 0, 1, 3


@dataclass(frozen=True)
class Options:
    """Search the values of variables for which a scene's equilibrium meets goals and constraints.

    The problem is a file (TOML, JSON) with a scene, or the path of one beside it (.3dm, .json, .obj, with `recipe` the
    path of a recipe or a table of one), with variables and goals. Exits with 0 if the search converged, 1 if no values
    meet the constraints, 2 for bad input, 3 if it ended otherwise, 130 if it was stopped by Ctrl-C.
    """

    problem: Annotated[Path, typer.Argument(metavar="FILE", help="Problem (TOML, JSON)")]
    output: Annotated[
        str | None,
        typer.Option(
            "--output", "-o", metavar="PATH", help=".3dm, .json, .obj, .dxf, .vtu, .inp or .ifc file, or a folder/"
        ),
    ] = None
    report: Annotated[
        str | None, typer.Option(metavar="PATH", help="Write the whole answer as JSON, to a file or folder/")
    ] = None
    csv: Annotated[
        str | None, typer.Option(metavar="PATH", help="Write a table (CSV), a row for each element and reaction")
    ] = None
    picture: Annotated[str | None, typer.Option(metavar="PATH", help="Draw a picture (PNG) of the shape")] = None
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Only print errors and notes")] = False


def run(options: Options) -> int:
    """Search, print and write."""
    try:
        source = options.problem
        targets = {
            "output": outputs.place(options.output, source, ".3dm"),
            "report": outputs.place(options.report, source, ".design.json"),
            "csv": outputs.place(options.csv, source, ".csv"),
            "picture": outputs.place(options.picture, source, ".png"),
        }
        relax.check_picture(targets["picture"])
        problem, read, drawing = opened(source)
        outputs.check(targets.values(), [source, drawing])
        with outputs.folders(targets.values()):
            found = _searched(problem, options)
            _write(found, read, drawing, targets)
    except InputError as error:
        return relax.bad(error)
    except KeyboardInterrupt:
        typer.echo(f"hookean: {options.problem.name}: stopped, nothing written", err=True)
        return relax.STOPPED
    if not options.quiet:
        _print(found)
    if str(found.status) == "converged":
        return CONVERGED
    return INFEASIBLE if str(found.status) == "infeasible" else NOT_CONVERGED


def _searched(problem: Problem, options: Options) -> Design:
    from hookean.designing.search import design

    shown = sys.stderr.isatty() and not options.quiet
    stop = Stop()

    def progress(count: int, objective: float) -> None:
        if shown:
            typer.echo(f"\r{count} equilibria, objective {objective:.6g} ", nl=False, err=True)

    with stop:
        found = design(problem, progress=progress, cancelled=stop)
    if shown:
        typer.echo(err=True)
    return found


def opened(path: Path) -> tuple[Problem, Source, Path]:
    """The problem in a file, what was read for its scene, and the file of that. A scene that is a text is the path of a
    file, from the folder of the problem."""
    from hookean.atomic_write import read_bytes
    from hookean.designing.problem import Problem
    from hookean.files.readers import Source, read_path
    from hookean.scene.text import parse_tables

    try:
        tables = parse_tables(read_bytes(path, path.name).decode("utf-8-sig"), path.name)
    except UnicodeDecodeError:
        raise InputError(path.name, "is not UTF-8 text; save it as UTF-8") from None
    recipe, given = tables.pop("recipe", None), tables.get("scene")
    if given is None:
        raise InputError("/scene", f"{path.name} has no scene; give a table, or the path of a file beside it")
    if isinstance(given, str):
        place = path.parent / given
        read = read_path(place, _recipe(recipe, path.parent))
        return Problem.read({**tables, "scene": read.scene}), read, place
    if recipe is not None:
        raise InputError("/recipe", "a recipe is for a scene that is a .3dm file")
    problem = Problem.read(tables)
    return problem, Source(problem.scene, [], unit=str(problem.scene.units.length)), path


def _recipe(given: Any, folder: Path) -> tuple[str, str] | None:
    """Text and name of a recipe: a path from the problem's folder, or a table in the problem."""
    if given is None:
        return None
    if isinstance(given, dict):
        return json.dumps(given), "recipe"
    if not isinstance(given, str):
        raise InputError("/recipe", "the path of a recipe, or a table of one, is expected")
    return relax.text_of(folder / given), given


def _write(found: Design, read: Source, drawing: Path, targets: dict[str, Path | None]) -> None:
    """Files of the best shape; a .3dm file that was read is written back with its objects moved."""
    from hookean.atomic_write import put
    from hookean.files.exchange.write import EXCHANGED, ending_of
    from hookean.files.relax_file import check_output, conclude
    from hookean.system.system import compile

    output, table, picture, report = (targets[name] for name in ("output", "csv", "picture", "report"))
    if output is not None and ending_of(output) in EXCHANGED:
        notes = found.result.save(output)
    elif output is not None or table is not None:
        check_output(output, drawing)
        whole = conclude(replace(read, scene=found.scene), drawing, compile(found.scene), found.result, output)
        notes = whole.unwritten
        if table is not None:
            put(table, whole.csv.encode(), lambda back: None)
    else:
        notes = []
    relax.print_notes(drawing, notes)
    if picture is not None:
        from hookean.pictures.picture import render

        render(found.result, picture, scene=found.scene, title=picture.stem)
    if report is not None:
        put(report, json.dumps(found.to_dict()).encode(), lambda back: None)


class Stop:
    """Ctrl-C ends the search with the best so far; a second one ends the command."""

    def __init__(self) -> None:
        self.asked = False
        self._before: Any = None

    def __call__(self) -> bool:
        return self.asked

    def __enter__(self) -> Stop:
        def ask(number: int, frame: Any) -> None:
            if self.asked:
                raise KeyboardInterrupt
            self.asked = True

        with contextlib.suppress(ValueError):  # only the main thread has signals
            self._before = signal.signal(signal.SIGINT, ask)
        return self

    def __exit__(self, *error: object) -> None:
        if self._before is not None:
            signal.signal(signal.SIGINT, self._before)


def _print(found: Design) -> None:
    typer.echo(found.message)
    for line in found.lines():
        typer.echo(f"  {line}")
    for warning in found.warnings:
        typer.echo(f"hookean: {warning}", err=True)


app = taking(Options, run)
