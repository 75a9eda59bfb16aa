"""`hookean forces`: the catalogue of forces as text."""

from __future__ import annotations

from typing import Any

import typer

from hookean.commands import command

app = command.new()


@app.command()
def forces() -> None:
    """List all forces with their formulas, columns, defaults and units."""
    typer.echo(text())


def text() -> str:
    """For each force its kind, formula and summary, and a line for each field: name, meaning, default, choices."""
    from hookean.scene.catalogue import catalogue

    return "\n\n".join("\n".join(_force(entry)) for entry in catalogue())


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
