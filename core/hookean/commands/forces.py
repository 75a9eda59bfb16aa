"""`hookean forces`: the catalogue of forces as text."""

from __future__ import annotations

from typing import Any

from hookean.catalogue import catalogue


def text() -> str:
    """For each force its kind, formula and summary, and a line for each field: name, meaning, default, choices."""
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
