"""The description of the service as the page of the HTTP reference reads it: OpenAPI 3.0.3 in place of 3.1.

Swagger UI takes five times as long to open an operation of a 3.1 document. The service itself tells 3.1, at
/v1/openapi.json.
"""

from __future__ import annotations

from typing import Any

BOUNDS = {"exclusiveMinimum": "minimum", "exclusiveMaximum": "maximum"}


def older(value: Any) -> Any:
    """A document, or a part of it, in the words of OpenAPI 3.0.3 with its version. https://spec.openapis.org"""
    if isinstance(value, list):
        return [older(one) for one in value]
    if not isinstance(value, dict):
        return value
    if isinstance(value.get("openapi"), str):
        value = {**value, "openapi": "3.0.3"}
    return _schema({name: older(part) for name, part in value.items()})


def _schema(told: dict[str, Any]) -> dict[str, Any]:
    """A schema without types that are lists, nulls, constants, bounds that are numbers and items by their place."""
    types, choices = told.get("type"), told.get("anyOf")
    if isinstance(types, list) and all(isinstance(one, str) for one in types):
        told.pop("type")
        choices = [{"type": one} for one in types]
    if isinstance(choices, list):
        real = [one for one in choices if one != {"type": "null"}]
        told.pop("anyOf", None)
        if len(real) < len(choices):
            told["nullable"] = True
        if len(real) == 1 and "$ref" not in real[0]:
            told = {**real[0], **told}
        elif real:
            told["anyOf"] = real
    if isinstance(told.get("const"), str):
        told["enum"] = [told.pop("const")]
    for strict, bound in BOUNDS.items():
        if isinstance(told.get(strict), int | float) and not isinstance(told[strict], bool):
            told |= {bound: told[strict], strict: True}
    if isinstance(told.get("prefixItems"), list):
        told["items"] = {"anyOf": told.pop("prefixItems")}
    if isinstance(told.get("examples"), list):
        told["example"] = told.pop("examples")[0]
    return told
