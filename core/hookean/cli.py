"""The command line: it finds the commands of all packages, and imports the one that runs."""

from __future__ import annotations

import errno
import os
import sys
from functools import cache
from importlib.metadata import EntryPoint, entry_points
from typing import Annotated, Any

import typer
from typer.core import TyperGroup

from hookean import __version__
from hookean.commands.command import fail, new
from hookean.errors import InputError

FULL = (errno.ENOSPC, getattr(errno, "EDQUOT", errno.ENOSPC), errno.EFBIG, errno.EIO)


class Commands(TyperGroup):
    """The entry points of the group `hookean.commands`, by name."""

    def list_commands(self, context: Any) -> list[str]:
        """Names of all commands."""
        return sorted(_known())

    def get_command(self, context: Any, name: str) -> Any:
        """A command by its name, imported now; or None."""
        if name not in _known():
            return None
        command = typer.main.get_command(_load(_known()[name]))
        command.name = name
        return command

    def invoke(self, context: Any) -> Any:
        """Run a command; bad input that it does not handle becomes one line and exit code 2."""
        try:
            return super().invoke(context)
        except InputError as error:
            fail(error)


@cache
def _known() -> dict[str, EntryPoint]:
    return {entry.name: entry for entry in entry_points(group="hookean.commands")}


def _load(entry: EntryPoint) -> typer.Typer:
    """The command of an entry point; if its package is not installed, one that reports this and exits with 2."""
    package = entry.module.partition(".")[0]
    try:
        found: typer.Typer = entry.load()
        return found
    except ModuleNotFoundError as error:
        if (error.name or "").partition(".")[0] != package:
            raise
    absent = new()

    @absent.command(context_settings={"allow_extra_args": True, "ignore_unknown_options": True})
    def missing() -> None:
        """Not installed."""
        fail(InputError(entry.name, f"{package} is not installed; install hookean with this package"))

    return absent


app = new(
    name="hookean",
    cls=Commands,
    help="Particle-spring form finding: cables, nets, membranes and shells relax to equilibrium.",
    no_args_is_help=True,
)


def _version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"hookean {__version__}")
        raise typer.Exit


@app.callback()
def _options(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version and stop.")
    ] = False,
) -> None:
    pass


def main() -> None:
    """Run the command line; exit codes as `hookean relax --help` lists them. Ctrl-C stops cleanly with 130."""
    try:
        app()
    except KeyboardInterrupt:
        typer.echo("hookean: stopped", err=True)
        sys.exit(130)
    except OSError as error:
        if error.errno not in FULL:
            raise
        sys.stdout = open(os.devnull, "w")  # noqa: SIM115  # what is left in the old one fails again at the end
        typer.echo(f"hookean: standard output cannot be written ({error.strerror}); check free space", err=True)
        sys.exit(2)


if __name__ == "__main__":
    main()
