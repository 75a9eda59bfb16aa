"""`hookean report`: one HTML file on a model, its load cases and their maxima."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from hookean.commands import analyse, outputs, relax
from hookean.commands.command import taking
from hookean.errors import InputError

MANY = 2_000  # particles from which on cases take longer than processes need to start


@dataclass(frozen=True)
class Options:
    """Write a report of the model in a file as one HTML file, ready to print: form, loads, load cases, maxima and where
    they are, reactions, pictures. The input is never changed.

    Exits with 0 if all converged, 1 if a limit is exceeded, 2 for bad input or a form that cannot be found or frozen, 3
    if no equilibrium was found; the report is written if not 2.
    """

    source: Annotated[Path, typer.Argument(metavar="FILE", help=".3dm, .obj, .json, .npz or .hookean file")]
    recipe: Annotated[
        Path | None, typer.Option("--recipe", "-r", help="Recipe (TOML, JSON); default: layer names define the model")
    ] = None
    output: Annotated[
        str | None, typer.Option("--output", "-o", metavar="PATH", help=".html file; default: beside the input")
    ] = None
    title: Annotated[str | None, typer.Option(help="Title of the report; default: the name of the file")] = None
    check: Annotated[Path | None, typer.Option(help="Limits (TOML, JSON) to check in each case")] = None
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Only print errors and notes")] = False


def run(options: Options) -> int:
    """Report on one file; the exit code."""
    try:
        beside = f"{options.source.with_suffix('')}.report.html"
        target = outputs.place(options.output or beside, options.source, ".html")
        assert target is not None
        if target.suffix.lower() not in (".html", ".htm"):
            raise InputError(target.name, "is not an .html file; give a name that ends in .html")
        outputs.check([target], (options.source, options.recipe, options.check))
        from hookean.atomic_write import put
        from hookean.files.limits import read_limits
        from hookean.files.report import reported

        limits = None if options.check is None else read_limits(relax.text_of(options.check), options.check.name)
        scene = analyse.scene_of(options.source, options.recipe)
        with outputs.folders([target]):
            processes = (os.cpu_count() or 1) if len(scene.particles) >= MANY else 1
            found = reported(scene, title=options.title or options.source.stem, limits=limits, processes=processes)
            put(target, found.text.encode(), lambda back: None)
    except InputError as error:
        return relax.bad(error)
    name = options.source.name
    for sentence in found.exceeded:
        typer.echo(f"hookean: {name}: limit exceeded: {sentence}", err=True)
    for sentence in found.unsettled:
        typer.echo(f"hookean: {name}: {sentence}", err=True)
    if not options.quiet:
        typer.echo(f"{name} -> {target}")
    return relax.NOT_CONVERGED if found.unsettled else relax.EXCEEDED if found.exceeded else relax.CONVERGED


app = taking(Options, run)
