"""`hookean patterns`: cutting patterns and cable lengths of the model in a file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from hookean.commands import analyse, outputs, relax
from hookean.commands.command import taking
from hookean.errors import InputError

if TYPE_CHECKING:
    from hookean.scene.scene import Scene
    from hookean.workshop.patterns import Patterns

DONE, NOT_CONVERGED = relax.CONVERGED, relax.NOT_CONVERGED


@dataclass(frozen=True)
class Options:
    """Cut a relaxed surface into strips, and list the unstressed lengths of its cables. The input is never changed.

    Strips follow the rows of a quad mesh and are laid flat with the least distortion, the warp along the strip. Exits
    with 0, 2 for bad input, 3 if no equilibrium was found.
    """

    source: Annotated[Path, typer.Argument(metavar="FILE", help=".3dm, .obj, .json, .npz or .hookean file")]
    recipe: Annotated[
        Path | None, typer.Option("--recipe", "-r", help="Recipe (TOML, JSON); default: layer names define the model")
    ] = None
    output: Annotated[
        str | None, typer.Option("--output", "-o", metavar="PATH", help=".3dm, .dxf or .svg file for the sheets")
    ] = None
    mesh: Annotated[str | None, typer.Option(help="Name of the mesh to cut; default: the only one")] = None
    along: Annotated[str, typer.Option(help="Direction of the strips: warp or weft")] = "warp"
    rows: Annotated[int, typer.Option(help="Rows of faces to a strip", min=1)] = 1
    compensation: Annotated[
        tuple[float, float], typer.Option(metavar="WARP WEFT", help="Strains of the cloth under prestress [-]")
    ] = (0.0, 0.0)
    allowance: Annotated[float, typer.Option(help="Cloth beyond seams and edges [length]", min=0.0)] = 0.0
    table: Annotated[str | None, typer.Option(metavar="PATH", help="Write the report of distortions (CSV)")] = None
    cables: Annotated[str | None, typer.Option(metavar="PATH", help="Write the lengths of the cables (CSV)")] = None
    stretch: Annotated[float, typer.Option(help="Construction stretch of the cables [-]", min=0.0)] = 0.0
    fitting: Annotated[float, typer.Option(help="Length of a fitting at each end [length]", min=0.0)] = 0.0
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Only print errors and notes")] = False


def run(options: Options) -> int:
    """Cut one file; the exit code."""
    try:
        targets = [
            outputs.place(options.output, options.source, ".dxf"),
            outputs.place(options.table, options.source, ".strips.csv"),
            outputs.place(options.cables, options.source, ".cables.csv"),
        ]
        outputs.check(targets, (options.source, options.recipe))
        scene = analyse.scene_of(options.source, options.recipe)
        with outputs.folders(targets):
            return _written(options, scene, targets)
    except InputError as error:
        return relax.bad(error)


def _written(options: Options, scene: Scene, targets: list[Path | None]) -> int:
    import hookean

    sheet, table, cables = targets
    said: list[str] = []
    if cables is not None:
        rows = hookean.cables(scene, stretch=options.stretch, fitting=options.fitting).table()
        _csv(cables, rows)
        said.append(f"{len(rows)} cables")
    if sheet is not None or table is not None or cables is None:
        result = hookean.relax(scene)
        if not result.converged:
            typer.echo(f"hookean: {options.source.name}: {result.message}", err=True)
            return NOT_CONVERGED
        patterns = _patterns(options, result)
        said[:0] = patterns.summary()
        if sheet is not None:
            from hookean.files.sheets import write_sheets

            write_sheets(patterns, sheet)
        if table is not None:
            _csv(table, patterns.table())
    if not options.quiet:
        written = ", ".join(str(target) for target in targets if target is not None)
        typer.echo(f"{options.source.name}{f' -> {written}' if written else ''}")
        for line in said:
            typer.echo(f"  {line}")
    return DONE


def _patterns(options: Options, result: Any) -> Patterns:
    import hookean

    if options.along not in ("warp", "weft"):
        raise InputError("--along", f"{options.along!r} given; warp or weft is expected")
    return hookean.cutting_patterns(
        result,
        mesh=options.mesh,
        along=options.along,  # type: ignore[arg-type]
        rows=options.rows,
        compensation=options.compensation,
        allowance=options.allowance,
    )


def _csv(target: Path, rows: Sequence[Mapping[str, Any]]) -> None:
    from hookean.atomic_write import put
    from hookean.files.tables import csv_text

    put(target, csv_text([dict(row) for row in rows]).encode(), lambda back: None)


app = taking(Options, run)
