"""Unions of models by their kind: as pydantic's own, with models that are built when they are given."""

from __future__ import annotations

from typing import Annotated, Any, Literal, Union

import pytest
from pydantic import Field, TypeAdapter, ValidationError

from hookean.values.by_kind import ByKind
from hookean.values.columns import Model, NonNegatives


class Cable(Model):
    """One kind."""

    kind: Literal["cable"] = "cable"
    length: NonNegatives = Field(default=1.0)
    note: str = Field(default="", max_length=3)


class Bar(Model):
    """Another."""

    kind: Literal["bar"] = "bar"
    area: float


KINDS: dict[str, type[Model]] = {"cable": Cable, "bar": Bar}
ALL: Any = Union[Cable, Bar]  # noqa: UP007
GIVEN: tuple[Any, ...] = (
    {"kind": "cable", "length": 2}, {"kind": "cable", "length": [1, 2]}, Cable(length=3), {"kind": "bar", "area": 1},
    {"kind": "cable", "length": -1, "note": "four"}, {"kind": "bar"}, {"kind": "bar", "area": 1, "width": 2},
    {"kind": "strut"}, {}, {"kind": None}, {"kind": ["cable"]}, 5, None, "cable", [],
)  # fmt: skip


def told(adapter: TypeAdapter[Any], value: Any) -> Any:
    """What a reader makes of a value, as JSON, or its errors."""
    try:
        return adapter.dump_json(adapter.validate_python((value, value)))
    except ValidationError as error:
        return error.errors(include_url=False, include_context=False)


def test_it_reads_writes_and_reports_as_the_union_of_pydantic() -> None:
    own: TypeAdapter[Any] = TypeAdapter(tuple[Annotated[ALL, ByKind(KINDS)], ...])
    plain: TypeAdapter[Any] = TypeAdapter(tuple[Annotated[ALL, Field(discriminator="kind")], ...])
    assert own.json_schema() == plain.json_schema()
    for value in GIVEN:
        assert told(own, value) == told(plain, value), value


def test_only_kinds_that_are_given_are_built() -> None:
    class Rope(Cable):
        kind: Literal["rope"] = "rope"  # type: ignore[assignment]

    class Chain(Cable):
        kind: Literal["chain"] = "chain"  # type: ignore[assignment]

    by_kind = ByKind({"rope": Rope, "chain": Chain})
    read: TypeAdapter[Any] = TypeAdapter(Annotated[Union[Rope, Chain], by_kind])  # noqa: UP007
    assert read.validate_python({"kind": "chain"}) == Chain()
    assert Chain.__pydantic_complete__ and not Rope.__pydantic_complete__


@pytest.mark.parametrize("kind", [Cable, Bar])
def test_signatures_name_types_as_the_source_does(kind: type[Model]) -> None:
    """Also of a model that nothing has built yet."""
    import inspect

    fields = inspect.signature(kind).parameters
    assert fields["kind"].annotation == f"Literal['{kind.called}']"
    assert {"length": "NonNegatives", "area": "float"}[list(fields)[1]] == fields[list(fields)[1]].annotation


def test_one_thread_at_a_time_builds_a_model() -> None:
    """While another model is being built a thread that needs one waits."""
    import threading

    from hookean.values import columns

    class Strut(Bar):
        pass

    with columns._BUILDING:
        waiting = threading.Thread(target=Strut, kwargs={"area": 2.0})
        waiting.start()
        waiting.join(0.05)
        assert waiting.is_alive() and not Strut.__pydantic_complete__
    waiting.join()
    assert Strut.__pydantic_complete__
