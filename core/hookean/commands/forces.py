"""`hookean forces`: the catalogue of forces as text."""

from __future__ import annotations

import difflib
import json
from typing import Annotated, Any

import typer

from hookean.commands import command
from hookean.errors import InputError

app = command.new()


@app.command()
def forces(
    kind: Annotated[str | None, typer.Argument(help="Kind of force, such as springs; default: all")] = None,
    scene: Annotated[
        bool, typer.Option("--scene", help="Print a scene with this force that comes to rest, for hookean relax")
    ] = False,
) -> None:
    """List all forces with their formulas, columns, defaults and units, or one of them."""
    try:
        typer.echo(example(kind) if scene else text(kind))
    except InputError as error:
        command.fail(error)


def text(kind: str | None = None) -> str:
    """For each force, or the one of a kind, its kind, formula and summary, and a line for each field: name, meaning,
    default, choices; raises InputError for an unknown kind."""
    from hookean.scene.catalogue import catalogue

    entries = catalogue() if kind is None else [_entry(kind)]
    return "\n\n".join("\n".join(_force(entry)) for entry in entries)


def example(kind: str | None) -> str:
    """The scene of the catalogue with a force of a kind, as JSON; raises InputError for an unknown kind, or none."""
    if kind is None:
        raise InputError("--scene", "needs a kind of force: hookean forces springs --scene")
    return json.dumps(_entry(kind)["scene"], indent=1)


def _entry(kind: str) -> dict[str, Any]:
    from hookean.forces import KINDS
    from hookean.scene.catalogue import entry

    if kind not in KINDS:
        near = difflib.get_close_matches(kind, KINDS, 1)
        hint = f"did you mean {near[0]}?" if near else "hookean forces lists all"
        raise InputError("", f"unknown kind of force {kind!r}; {hint}")
    return entry(KINDS[kind])


def _force(entry: dict[str, Any]) -> list[str]:
    lines = [f"{entry['kind']}  {entry['formula']}".rstrip(), f"    {entry['summary']}"]
    return lines + [f"    {field['name']:<16} {_field(field)}" for field in entry["fields"]]


def _field(field: dict[str, Any]) -> str:
    if field["required"]:
        more = "required"
    elif field["default"] in (None, ""):
        more = "optional"
    else:
        more = f"default {field['default']}"
    if field.get("choices"):
        more += f"; {', '.join(map(str, field['choices']))}"
    return f"{field['description']} ({more})"
