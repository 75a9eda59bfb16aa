"""Unions of models that differ by their `kind`, of which pydantic builds those that are given.

    AnyForce = Annotated[Force, ByKind({"springs": Springs, "unary": Unary, ...})]

Errors and schemas are those of a union with `Field(discriminator="kind")`. Such a union builds all its models before
it reads the first, which takes as long as the rest of a small program.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache, cached_property
from typing import Annotated, Any, Union

from pydantic import BaseModel, Field, TypeAdapter
from pydantic_core import SchemaValidator, core_schema


class ByKind:
    """What makes a union of models by their kinds; the serializer of each is its own."""

    def __init__(self, models: Mapping[str, type[BaseModel]]) -> None:
        self.models = models

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> Any:
        return core_schema.no_info_plain_validator_function(self._checked)

    def __get_pydantic_json_schema__(self, schema: Any, handler: Any) -> Any:
        return handler(self._union.core_schema)

    def _checked(self, value: Any) -> Any:
        kind = value.get("kind") if isinstance(value, Mapping) else getattr(value, "kind", None)
        if isinstance(kind, str) and kind in self.models:
            return _alone(self.models[kind], kind).validate_python(value)
        return self._union.validate_python(value)  # its error names all kinds

    @cached_property
    def _union(self) -> TypeAdapter[Any]:
        union: Any = Annotated[Union[tuple(self.models.values())], Field(discriminator="kind")]  # noqa: UP007
        return TypeAdapter(union)


@cache
def _alone(model: type[BaseModel], kind: str) -> SchemaValidator:
    """A union of one kind, so that errors have the places that they have in a union of many."""
    model.model_rebuild()
    choices = {kind: model.__pydantic_core_schema__}
    return SchemaValidator(core_schema.tagged_union_schema(choices, "kind", strict=False, from_attributes=True))
