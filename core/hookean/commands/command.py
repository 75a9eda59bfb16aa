"""What commands of the command line have in common.

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
    """A command, or a group of commands, without anything in it."""
    return typer.Typer(add_completion=False, pretty_exceptions_enable=False, **settings)


def taking(options: type[T], run: Callable[[T], int]) -> typer.Typer:
    """A command whose options are the fields of a dataclass, annotated as typer takes them; its docstring is the help,
    and what `run` returns the exit code."""

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
    """Print what is wrong in one line and stop with 2."""
    typer.echo(f"hookean: {' '.join(str(error).split())}", err=True)
    raise typer.Exit(2)
