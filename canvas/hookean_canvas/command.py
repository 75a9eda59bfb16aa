"""`hookean canvas`: Grasshopper's files on the command line."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any

import typer

from hookean.commands.command import fail, new
from hookean.errors import InputError

app = new(
    help="Grasshopper without Rhino: build components, inspect archives, run and import definitions.",
    no_args_is_help=True,
)


@app.callback()
def _options() -> None:
    pass


@app.command()
def show(
    file: Annotated[Path, typer.Argument(help="A .gh, .ghx or .ghuser file")],
    code: Annotated[bool, typer.Option("--code", help="Include the source of every script")] = False,
    json: Annotated[bool, typer.Option("--json", help="Print JSON")] = False,
    everything: Annotated[
        bool, typer.Option("--all", help="Print every chunk and item, without interpretation")
    ] = False,
) -> None:
    """Print the contents of a Grasshopper file: objects with inputs, outputs, wires, values and scripts."""
    from hookean_canvas.inspect.show import show

    show(file, code, json, everything)


@app.command()
def check(
    files: Annotated[list[Path], typer.Argument(help=".gh, .ghx and .ghuser files")],
    strict: Annotated[
        bool, typer.Option("--strict", help="Also report what Grasshopper repairs, drops or ignores")
    ] = False,
) -> None:
    """Print why Grasshopper would refuse files or objects in them, a line for each fault; exits with 1 for faults."""
    from hookean_canvas.inspect.show import check

    raise typer.Exit(check(files, strict))


@app.command()
def build(
    output: Annotated[Path, typer.Option("--output", "-o", help="Folder to write to")] = Path("dist"),
) -> None:
    """Build all components: .ghuser files for Rhino 8 and 9 and for Rhino 7, and a package (.yak) of each."""
    from hookean_canvas.components.build import build

    try:
        built = build(output)
    except InputError as error:
        fail(error)
    for folder in sorted({path.parent for path in built.user_objects}):
        typer.echo(f"{folder}: {sum(path.parent == folder for path in built.user_objects)} components")
    for package in built.packages:
        typer.echo(f"{package}")


@app.command()
def install(
    rhino: Annotated[int, typer.Option(min=7, max=9, help="The Rhino to install for: 7, 8 or 9")] = 8,
    folder: Annotated[
        Path | None, typer.Option(help="Grasshopper's User Object Folder; default: search for it")
    ] = None,
) -> None:
    """Install the components: copy them to Grasshopper's user objects; they appear when Rhino is next started."""
    from hookean_canvas.components.build import install

    try:
        files = install(rhino, folder)
    except InputError as error:
        fail(error)
    typer.echo(f"{files[0].parent}: {len(files)} components for Rhino {rhino}; restart Rhino to see them.")


@app.command()
def run(
    file: Annotated[Path, typer.Argument(help="A definition, .ghx or .gh")],
    set_: Annotated[list[str] | None, typer.Option("--set", help="A slider, toggle or panel: 'name=value'")] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON")] = False,
    seconds: Annotated[float, typer.Option(help="Longest run [s]", min=0)] = 120.0,
    trust: Annotated[
        bool, typer.Option("--trust", help="Trust its scripts, now and later: they run with your rights")
    ] = False,
    rhino: Annotated[
        Path | None, typer.Option(help="A .3dm file with the objects that it refers to, by id, layer or name")
    ] = None,
) -> None:
    """Evaluate a definition without Rhino: print its panels, compare its numbers with an expected.json beside it.

    Scripts in it run with your rights, so a file that you run for the first time needs --trust, unless it is part of
    hookean or HOOKEAN_TRUST is 1. Exits with 0; with 1 if a number is not as expected, a component fails or it does
    not come to rest; with 2 if it cannot be run.
    """
    from hookean_canvas.run import checking

    raise typer.Exit(_printed(lambda: checking.run(file, set_ or [], as_json, seconds, trust, rhino)))


@app.command()
def draw(
    file: Annotated[Path, typer.Argument(help="A definition, .ghx or .gh")],
    output: Annotated[Path, typer.Option("--output", "-o", help="The picture, .png")],
) -> None:
    """Draw the canvas of a definition: boxes, groups and wires."""
    from hookean_canvas.inspect import drawing
    from hookean_canvas.run import graph

    left = _printed(lambda: drawing.draw(graph.read(file, decode=False), output))
    if left:
        typer.echo(f"{output}: drawn without {', '.join(left)}; the file gives them no place on the canvas", err=True)


@app.command()
def convert(
    source: Annotated[Path, typer.Argument(help="A .gh, .ghx or .ghuser file")],
    target: Annotated[Path, typer.Argument(help="The file to write: .ghx in XML, .gh and .ghuser binary")],
    check: Annotated[
        bool,
        typer.Option("--check", help="Write nothing; compare both files item by item and exit with 1 if they differ"),
    ] = False,
) -> None:
    """Convert a Grasshopper file to the other form, XML or binary, with everything in it."""
    from hookean_canvas import archive
    from hookean_canvas.archive import compare

    if not check:
        root = _printed(lambda: compare.convert(source, target))
        typer.echo(f"{target}: {sum(len(chunk.items) for chunk in root.walk())} items")
        return
    found = _printed(lambda: compare.difference(archive.read(source), archive.read(target)))
    if found:
        typer.echo(f"the first difference is at {found}")
        raise typer.Exit(1)
    typer.echo(f"{source} and {target} hold the same")


@app.command("import")
def import_(
    file: Annotated[Path, typer.Argument(help="A .gh or .ghx file with components of Kangaroo 0.099 or Kangaroo 2")],
    output: Annotated[Path | None, typer.Option("--output", "-o", help="Default: NAME-hookean.ghx beside it")] = None,
) -> None:
    """Translate a definition made for Kangaroo: replace its components by hookean's and report which could not be."""
    from hookean_canvas.kangaroo import translate as kangaroo

    target, report = _printed(lambda: kangaroo.import_file(file, output))
    typer.echo(f"{report.text()}\n\nwritten: {target}")


def _printed(work: Callable[[], Any]) -> Any:
    """The result of the work; an InputError becomes one line, or a line for each of its faults, and exit code 2."""
    try:
        return work()
    except InputError as error:
        if len(error.faults) == 1:
            fail(error)
        typer.echo(f"hookean: {error.pointer}: {error.sentence.split(': ')[0]}:", err=True)
        for fault in error.faults:
            typer.echo(f"  {fault}", err=True)
        raise typer.Exit(2) from None
