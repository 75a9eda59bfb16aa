"""`hookean design`: a design problem in, the best values and their equilibrium out, and an exit code."""

from __future__ import annotations

import json
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from hookean.commands import command
from hookean.commands.command import taking
from hookean.errors import InputError

if TYPE_CHECKING:
    from hookean.designing.answer import Design

CONVERGED, INFEASIBLE, NOT_CONVERGED = 0, 1, 3


@dataclass(frozen=True)
class Options:
    """Search the values of variables for which a scene's equilibrium meets goals and constraints.

    The problem is a file (TOML, JSON) with a scene, or the path of one beside it, with variables and goals. Exits
    with 0 if the search converged, 1 if no values meet the constraints, 2 for bad input, 3 if it ended otherwise.
    """

    problem: Annotated[Path, typer.Argument(metavar="FILE", help="Problem (TOML, JSON)")]
    output: Annotated[
        str | None, typer.Option("--output", "-o", metavar="PATH", help=".3dm, .json, .obj, .csv or .png of the shape")
    ] = None
    report: Annotated[str | None, typer.Option(metavar="PATH", help="Write the whole answer as JSON")] = None
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Only print errors")] = False


def run(options: Options) -> int:
    """Search, print and write."""
    try:
        found = _searched(options)
        if options.output is not None:
            for sentence in found.result.save(options.output):
                typer.echo(f"hookean: {sentence}", err=True)
        if options.report is not None:
            from hookean.atomic_write import put

            put(Path(options.report), json.dumps(found.to_dict()).encode(), lambda back: None)
    except InputError as error:
        command.fail(error)
    if not options.quiet:
        _print(found)
    if str(found.status) == "converged":
        return CONVERGED
    return INFEASIBLE if str(found.status) == "infeasible" else NOT_CONVERGED


def _searched(options: Options) -> Design:
    from hookean.designing.search import design

    shown = sys.stderr.isatty() and not options.quiet

    def progress(count: int, objective: float) -> None:
        if shown:
            typer.echo(f"\r{count} equilibria, objective {objective:.6g} ", nl=False, err=True)

    found = design(read(options.problem), progress=progress)
    if shown:
        typer.echo(err=True)
    return found


def read(path: Path) -> dict[str, Any]:
    """The problem in a file; a scene that is a text is the path of a file, from the folder of the problem."""
    from hookean.atomic_write import read_bytes
    from hookean.files.save import open
    from hookean.scene.text import parse_tables

    try:
        tables = parse_tables(read_bytes(path, path.name).decode("utf-8-sig"), path.name)
    except UnicodeDecodeError:
        raise InputError(path.name, "is not UTF-8 text; save it as UTF-8") from None
    recipe = tables.pop("recipe", None)
    if isinstance(tables.get("scene"), str):
        tables["scene"] = open(path.parent / tables["scene"], None if recipe is None else path.parent / str(recipe))
    return tables


def _print(found: Design) -> None:
    units = found.result.units
    typer.echo(found.message)
    for entry in found.variables:
        bound = " (at a bound)" if _any(entry["at_bound"]) else ""
        typer.echo(f"  {entry['name']}: {_numbers(entry['value'])}{bound}")
    for entry in found.goals:
        unit = units.of(entry["unit"]) if entry["unit"] else "-"
        target = "minimised" if entry["target"] is None else f"target {_numbers(entry['target'])}"
        typer.echo(f"  goal {entry['name']}: {_numbers(entry['value'])} {unit}, {target}")
    for entry in found.constraints:
        unit = units.of(entry["unit"]) if entry["unit"] else "-"
        typer.echo(
            f"  constraint {entry['name']}: {_numbers(entry['value'])} {unit}, {'met' if entry['met'] else 'not met'}"
        )
    for warning in found.warnings:
        typer.echo(f"hookean: {warning}", err=True)


def _any(value: Any) -> bool:
    import numpy as np

    return bool(np.any(value))


def _numbers(value: Any) -> str:
    from hookean.designing.answer import shown

    return str(shown(value))


app = taking(Options, run)
