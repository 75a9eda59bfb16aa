"""`hookean analyse`: frequencies, buckling, load paths and mechanisms of the model in a file."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from hookean.commands import outputs, relax
from hookean.commands.command import taking
from hookean.errors import InputError

if TYPE_CHECKING:
    from hookean.scene.scene import Scene

DONE, BAD_INPUT = relax.CONVERGED, relax.BAD_INPUT


@dataclass(frozen=True)
class Options:
    """Analyse the model in a file: how it vibrates, buckles and moves under load. The input is never changed.

    Without options prints six natural frequencies and the counts of mechanisms. Lengths, forces and times are in the
    units of the file. Exits with 0, or with 2 for bad input or a model that is not in equilibrium.
    """

    source: Annotated[Path, typer.Argument(metavar="FILE", help=".3dm, .obj, .json, .npz or .hookean file")]
    recipe: Annotated[
        Path | None, typer.Option("--recipe", "-r", help="Recipe (TOML, JSON); default: layer names define the model")
    ] = None
    frequencies: Annotated[int, typer.Option(help="How many natural frequencies", min=0)] = 0
    weight_masses: Annotated[
        bool,
        typer.Option("--weight-masses", help="Masses from the self_weight of the model instead of its particles"),
    ] = False
    buckling: Annotated[int, typer.Option(help="How many linear buckling factors", min=0)] = 0
    load_path: Annotated[int, typer.Option(help="Follow the load-displacement path by so many steps", min=0)] = 0
    mechanisms: Annotated[bool, typer.Option("--mechanisms", help="Count mechanisms and states of self-stress")] = False
    load: Annotated[
        list[str] | None, typer.Option(metavar="NAME", help="A load that grows, by name; may be repeated; default: all")
    ] = None
    case: Annotated[
        str | None,
        typer.Option(metavar="NAME", help="Load case or combination to analyse; its loads grow from the form"),
    ] = None
    increment: Annotated[float, typer.Option(help="Load factor of the first step of a path")] = 0.1
    report: Annotated[
        str | None, typer.Option(metavar="PATH", help="Write all results as JSON, with modes and shapes")
    ] = None
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Only print errors and notes")] = False


def run(options: Options) -> int:
    """Analyse one file; the exit code."""
    try:
        target = outputs.place(options.report, options.source, ".analysis.json")
        outputs.check([target], (options.source, options.recipe))
        scene = scene_of(options.source, options.recipe)
        found = {name: analyse(scene) for name, analyse in _chosen(options, scene).items()}
        if target is not None:
            from hookean.atomic_write import put

            text = json.dumps({name: result.to_dict() for name, result in found.items()}, allow_nan=False)
            with outputs.folders([target]):
                put(target, text.encode(), lambda back: None)
    except InputError as error:
        return relax.bad(error)
    if not options.quiet:
        for name, result in found.items():
            typer.echo(f"{options.source.name}: {name}")
            for line in result.summary():
                typer.echo(f"  {line}")
        if target is not None:
            typer.echo(f"-> {target}")
    return DONE


def scene_of(source: Path, recipe: Path | None) -> Scene:
    """The scene in a file; prints notes on how it was read. InputError where it cannot be relaxed as it is."""
    from hookean.files.readers import read_path

    given = None if recipe is None else (relax.text_of(recipe), str(recipe))
    read = read_path(source, given)
    relax.print_notes(source, [*read.warnings, *relax.forgotten(source, recipe)])
    if read.nothing or read.unheld:
        raise InputError(source.name, read.nothing or read.unheld)
    return read.scene


def _chosen(options: Options, scene: Scene) -> dict[str, Callable[[Scene], Any]]:
    """The analyses that the options ask for, by the names of their sections."""
    import hookean
    from hookean.analysis.load_cases import of_case

    loads, case = options.load, options.case
    plain = not (options.frequencies or options.buckling or options.load_path or options.mechanisms)
    at_rest = plain or options.frequencies or options.mechanisms
    shape = of_case(scene, case if at_rest else None)
    chosen: dict[str, Callable[[Scene], Any]] = {}
    if options.frequencies or plain:
        masses = "self_weight" if options.weight_masses else None
        chosen["frequencies"] = lambda _: hookean.frequencies(shape, options.frequencies or 6, masses=masses)
    if options.buckling:
        chosen["buckling"] = lambda scene: hookean.buckling(scene, options.buckling, loads=loads, case=case)
    if options.load_path:
        chosen["load_path"] = lambda scene: hookean.load_path(
            scene, loads=loads, steps=options.load_path, increment=options.increment, case=case
        )
    if options.mechanisms or plain:
        chosen["mechanisms"] = lambda _: hookean.mechanisms(shape)
    return chosen


app = taking(Options, run)
