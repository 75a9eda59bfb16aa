"""Shared code of all commands of the command line.

A command is a `typer.Typer` that the group `hookean.commands` of the entry points names (see pyproject.toml), in any
package. It starts light: what it needs is imported when it runs.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any, NoReturn, TypeVar, get_type_hints

import typer

from hookean.errors import InputError

T = TypeVar("T")


def new(**settings: Any) -> typer.Typer:
    """An empty command, or group of commands."""
    return typer.Typer(add_completion=False, pretty_exceptions_enable=False, **settings)


def taking(options: type[T], run: Callable[[T], int]) -> typer.Typer:
    """A command whose options are the fields of a dataclass, annotated for typer; its docstring is the help text,
    and `run` returns the exit code."""

    def called(**given: Any) -> None:
        raise typer.Exit(run(options(**given)))

    hints = get_type_hints(options, include_extras=True)
    fields = inspect.signature(options).parameters.values()
    called.__signature__ = inspect.Signature([f.replace(annotation=hints[f.name]) for f in fields])  # type: ignore[attr-defined]
    called.__annotations__ = hints
    called.__doc__ = options.__doc__
    app = new()
    app.command()(called)
    return app


def fail(error: InputError) -> NoReturn:
    """Print the error in one line and exit with 2."""
    typer.echo(f"hookean: {' '.join(str(error).split())}", err=True)
    raise typer.Exit(2)
