"""The command line. It starts light: a command imports what it needs."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated, Any, NoReturn

import typer

from hookean import InputError, __version__

app = typer.Typer(
    name="hookean",
    help="Particle-spring form finding: cables, nets, membranes and shells relax to equilibrium.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)


def _version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"hookean {__version__}")
        raise typer.Exit


@app.callback()
def _options(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Say the version and stop.")
    ] = False,
) -> None:
    pass


@app.command()
def relax(
    files: Annotated[list[Path], typer.Argument(help=".3dm, .obj, .json or .npz files")],
    output: Annotated[
        str | None,
        typer.Option("--output", "-o", metavar="PATH", help=".3dm, .json or .obj file to write, or a folder/"),
    ] = None,
    recipe: Annotated[
        Path | None, typer.Option("--recipe", "-r", help="Recipe (TOML, JSON); without it layer names decide")
    ] = None,
    explain: Annotated[bool, typer.Option("--explain", help="Tell how the files are read; solve nothing")] = False,
    report: Annotated[
        str | None, typer.Option(metavar="PATH", help="Everything as JSON; a file or folder/, as for the next two")
    ] = None,
    csv: Annotated[str | None, typer.Option(metavar="PATH", help="A row for each element and reaction")] = None,
    picture: Annotated[str | None, typer.Option(metavar="PATH", help="A picture (PNG) of the result")] = None,
    check: Annotated[
        Path | None, typer.Option(help="Limits (TOML, JSON) of force, strain, displacement, reaction")
    ] = None,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Say only what is wrong")] = False,
) -> None:
    """Relax files: cables, nets and membranes go to equilibrium. The input is never changed.

    Exits with 0 if all converged, 1 if a limit is exceeded, 2 for bad input, 3 where there is no equilibrium.

    Without a recipe, layers named springs, cables, membrane, anchors, loads, floor and geometry and the objects' user
    text (stiffness, rest_factor, divide, load, axes ...) say what is what; without such layers curves become springs
    and meshes membranes, held at loose ends and naked vertices. Numbers are in m, N and s.
    --explain tells. Folders to write to are made; where there are many files, or with a slash at its end, a path is a
    folder, and the files in it are named as their input.
    """
    from hookean.commands.relax import Options, run

    raise typer.Exit(run(Options(files, output, recipe, explain, report, csv, picture, check, quiet)))


@app.command()
def simulate(
    file: Annotated[Path, typer.Argument(help=".3dm, .obj, .json or .npz file")],
    recipe: Annotated[
        Path | None, typer.Option("--recipe", "-r", help="Recipe (TOML, JSON); without it layer names decide")
    ] = None,
    script: Annotated[
        Path | None, typer.Option(help="Paths of anchors and forces, and drives (TOML, JSON), in the scene's units")
    ] = None,
    stream: Annotated[
        str | None, typer.Option(help="Values over time for the drives (CSV); - is standard input")
    ] = None,
    frames: Annotated[int | None, typer.Option(help="Stop after so many frames", min=0)] = None,
    csv: Annotated[
        str | None, typer.Option(metavar="PATH", help="A row for each frame, as it comes; - is standard output")
    ] = None,
    picture: Annotated[
        str | None, typer.Option(metavar="PATH", help="A picture (PNG) of the frames over each other")
    ] = None,
    output: Annotated[
        str | None, typer.Option("--output", "-o", metavar="PATH", help=".3dm, .json or .obj file for the last shape")
    ] = None,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Say only what is wrong")] = False,
) -> None:
    """Run a file in motion: it bounces, anchors move, loads change. The input is never changed.

    Ends at rest, after --frames, or with the stream; exits with 0 then, with 2 for bad input, with 3 if it diverged or
    never came to rest, with 130 after Ctrl-C. The frames until then are written in each case.
    """
    from hookean.commands.simulate import Options, run

    raise typer.Exit(run(Options(file, recipe, script, stream, frames, csv, picture, output, quiet)))


@app.command()
def example(
    figure: Annotated[
        str | None, typer.Argument(help="Figure or name, such as 9.11, or the folder of a copy; without it a list")
    ] = None,
    picture: Annotated[str | None, typer.Option(metavar="PATH", help="Draw it to this .png file or folder/")] = None,
    copy: Annotated[
        str | None, typer.Option(metavar="FOLDER", help="Copy it to this new folder, or into one that is there")
    ] = None,
    figures: Annotated[Path | None, typer.Option(help="Run and draw all, a folder for each in this one")] = None,
) -> None:
    """The figures of the chapter that hookean implements: list them, or run one and check its numbers.

    Exits with 0 if all numbers are as expected, 1 if one is not, 2 for bad input. A copy may give other numbers: they
    are told beside those it had.
    """
    from hookean.commands import example as command

    if figures is not None:
        raise typer.Exit(command.figures(figures))
    if figure is None and picture is None and copy is None:
        raise typer.Exit(command.listing())
    raise typer.Exit(command.run(figure, picture, copy))


@app.command()
def serve(
    host: Annotated[str, typer.Option(help="Address to listen on")] = "127.0.0.1",
    port: Annotated[
        int | None, typer.Option(help="Port to listen on; 0: any free one; default 8765", min=0, max=65535)
    ] = None,
    any_port: Annotated[bool, typer.Option("--any-port", help="Take any free port where this one is taken")] = False,
    no_keep: Annotated[bool, typer.Option("--no-keep", help="Keep no sessions when it ends")] = False,
    stop: Annotated[bool, typer.Option("--stop", help="Stop the service that runs")] = False,
    parent_pid: Annotated[int, typer.Option(help="End with this process", min=0)] = 0,
    idle_exit: Annotated[float, typer.Option(help="End after so many minutes without use; 0: never", min=0)] = 0.0,
) -> None:
    """Start the local service: the same over HTTP, until Ctrl-C. There is one for each user, which keeps the sessions.

    Where it runs already, that is said, with its address. HOOKEAN_STATE moves the folder it is found in.
    """
    service = _service()
    if stop:
        raise typer.Exit(service.stop())
    options = service.Options(host, port, any_port, not no_keep, parent_pid, idle_exit)
    raise typer.Exit(service.run(options) or 0)


@app.command()
def studio(
    file: Annotated[
        Path | None, typer.Argument(help=".3dm, .obj, .json or .npz file to open; none: the start page")
    ] = None,
    no_browser: Annotated[bool, typer.Option("--no-browser", help="Print the address only")] = False,
) -> None:
    """Look at simulations and play with them in a browser. Starts the service, or joins the one that runs.

    A .json file has a scene or COMPAS documents; what names no forces is taken as drawn. A file that has not changed is
    opened as it was left. What follows the # of the address lets the browser in: keep it to yourself.
    """
    raise typer.Exit(_service().studio(file, not no_browser))


@app.command()
def token(
    url: Annotated[bool, typer.Option("--url", help="The address that lets a browser in, instead")] = False,
    header: Annotated[bool, typer.Option("--header", help="The header for curl -H @-, instead")] = False,
    renew: Annotated[bool, typer.Option("--renew", help="Log everybody out: give the service another token")] = False,
) -> None:
    """Print the token of the service: what HOOKEAN_TOKEN says, else that of the service that runs.

    Every start of the service has another token. --renew replaces it while the service runs: the old token, the log-ins
    of all browsers and open connections end.
    """
    raise typer.Exit(_service().token(url, header, renew))


def _service() -> Any:
    return _package("serve", "hookean_server", "the service")


def _package(command: str, package: str, what: str) -> Any:
    """The commands of another package of ours, imported when one is wanted."""
    import importlib

    try:
        return importlib.import_module(f"{package}.command")
    except ModuleNotFoundError as error:
        if not (error.name or "").startswith(package):
            raise
        fail(InputError(command, f"{what} ({package}) is not installed; install hookean with it"))


@app.command(
    context_settings={"allow_extra_args": True, "ignore_unknown_options": True},
    add_help_option=False,
    help="Grasshopper without Rhino: build components, look into archives, run and import definitions.",
)
def canvas(context: typer.Context) -> None:
    """Hand the rest of the line to the commands of `hookean_canvas`."""
    commands = _package("canvas", "hookean_canvas", "what reads Grasshopper's files").app
    try:
        commands(context.args, prog_name="hookean canvas")
    except InputError as error:
        fail(error)


@app.command()
def store(
    action: Annotated[str, typer.Argument(help="check, salvage, backup or compact")],
    target: Annotated[Path | None, typer.Argument(help="Of backup: the file to write; of the others: none")] = None,
) -> None:
    """Look after the file in which the service keeps sessions and jobs.

    check: is it whole, and what was lost from it? salvage: repair it, keeping a copy. backup: copy it to a file, while
    the service runs or not. compact: give unused space back. Exits with 0 if all is well, 1 if something is damaged or
    lost, 2 where the action is not possible. HOOKEAN_STATE moves the folder of the file.
    """
    raise typer.Exit(_service().store(action, target))


@app.command()
def forces() -> None:
    """List all forces with their formulas, columns, defaults and units."""
    from hookean.commands.forces import text

    typer.echo(text())


def fail(error: InputError) -> NoReturn:
    """Say what is wrong in one line and stop with 2."""
    typer.echo(f"hookean: {' '.join(str(error).split())}", err=True)
    raise typer.Exit(2)


def main() -> None:
    """Run the command line; exit codes as `hookean relax --help` tells. Ctrl-C stops cleanly with 130."""
    try:
        app()
    except KeyboardInterrupt:
        typer.echo("hookean: stopped", err=True)
        sys.exit(130)


if __name__ == "__main__":
    main()
