"""The description of the service for the page of the HTTP reference: OpenAPI 3.0.3, with nothing of 3.1 left."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest
from docsite.reference import older

from serving import app


def parts(value: Any) -> Iterator[dict[str, Any]]:
    """All objects in a document."""
    if isinstance(value, dict):
        yield value
    for one in value.values() if isinstance(value, dict) else value if isinstance(value, list) else ():
        yield from parts(one)


@pytest.mark.parametrize(
    ("given", "wanted"),
    [
        ({"type": ["number", "null"]}, {"type": "number", "nullable": True}),
        ({"type": ["string", "integer"]}, {"anyOf": [{"type": "string"}, {"type": "integer"}]}),
        ({"anyOf": [{"type": "array"}, {"type": "null"}], "default": None},
         {"type": "array", "nullable": True, "default": None}),
        ({"const": "springs", "type": "string"}, {"enum": ["springs"], "type": "string"}),
        ({"exclusiveMinimum": 0.0, "type": "number"}, {"minimum": 0.0, "exclusiveMinimum": True, "type": "number"}),
        ({"properties": {"type": {"type": "string"}}}, {"properties": {"type": {"type": "string"}}}),
    ],
)  # fmt: skip
def test_a_schema_says_the_same_in_older_words(given: dict[str, Any], wanted: dict[str, Any]) -> None:
    assert older(given) == wanted


def test_the_service_is_described_without_words_of_the_newer_version() -> None:
    """All operations and schemas are there; no list of types, null, constant or numeric strict bound is."""
    whole = app().openapi()
    told = older(whole)
    assert whole["openapi"].startswith("3.1") and told["openapi"] == "3.0.3"
    assert told["paths"].keys() == whole["paths"].keys()
    assert told["components"]["schemas"].keys() == whole["components"]["schemas"].keys()
    for part in parts(told):
        kinds = part.get("type")
        assert kinds != "null" and not isinstance(kinds, list) and not isinstance(part.get("const"), str), part
        for name in ("exclusiveMinimum", "exclusiveMaximum"):
            assert isinstance(part.get(name, True), bool | dict), part
