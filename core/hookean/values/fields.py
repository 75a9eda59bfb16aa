"""What annotates the fields of a model: for pydantic what a field holds, for type checkers also what it accepts.

    particles: Maybe[IndexRows] = Field(default=None)    # holds an array or None; accepts lists, too
    settings: Part[Settings] = Field(default=Settings())  # holds Settings; accepts a dict, too

Type checkers see descriptors: what a field gives is the type of `__get__`, what a constructor accepts the type of the
value of `__set__` (PEP 681). Without a plugin they accept `Springs(particles=[[0, 1]], stiffness=1000)`, know that
`springs.particles` is an array, and report misspelt names.
"""

from __future__ import annotations

import inspect
from typing import TYPE_CHECKING, Any

import pydantic

from hookean.values.faults import first_fault

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence
    from typing import Generic, TypeVar, dataclass_transform

    from numpy.typing import ArrayLike
    from pydantic._internal._model_construction import ModelMetaclass

    T = TypeVar("T")
    Got = TypeVar("Got", covariant=True)
    Inner = TypeVar("Inner", covariant=True)
    Array = ArrayLike | Sequence[Any] | Mapping[str, Any]

    class Column(Generic[Got]):
        """An array, or one number or an array."""

        def __get__(self, instance: object, owner: Any) -> Got: ...
        def __set__(self, instance: object, value: Array) -> None: ...

    class Maybe(Generic[Inner]):
        """A column, or None."""

        def __get__(self: Maybe[Column[T]], instance: object, owner: Any) -> T | None: ...
        def __set__(self, instance: object, value: Array | None) -> None: ...

    class Part(Generic[Got]):
        """A model, given as itself or as a dict of its fields."""

        def __get__(self, instance: object, owner: Any) -> Got: ...
        def __set__(self, instance: object, value: Got | Mapping[str, Any]) -> None: ...

    class Switch(Generic[Got]):
        """A model or None; true and false are its defaults and None."""

        def __get__(self, instance: object, owner: Any) -> Got | None: ...
        def __set__(self, instance: object, value: Got | Mapping[str, Any] | bool | None) -> None: ...

    class Parts(Generic[Got]):
        """Models in an order."""

        def __get__(self, instance: object, owner: Any) -> tuple[Got, ...]: ...
        def __set__(self, instance: object, value: Iterable[Got | Mapping[str, Any]]) -> None: ...

    class Named(Generic[Got]):
        """Models by their names."""

        def __get__(self, instance: object, owner: Any) -> dict[str, Got]: ...
        def __set__(self, instance: object, value: Mapping[str, Got | Mapping[str, Any]]) -> None: ...

    def Field(default: Any = ..., *, default_factory: Any = ..., **more: Any) -> Any:
        """A field: its default and, by keyword, what else pydantic's Field takes."""

    @dataclass_transform(kw_only_default=True, frozen_default=True, field_specifiers=(Field,))
    class OneError(ModelMetaclass):
        """Of models whose constructors raise InputError."""

else:
    Field = pydantic.Field

    class _Made:
        """A name in brackets that stands for a type made of what is in them."""

        def __init__(self, make):  # type: ignore[no-untyped-def]
            self.make = make

        def __getitem__(self, inner):  # type: ignore[no-untyped-def]
            return self.make(inner)

    Maybe = Switch = _Made(lambda inner: inner | None)
    Part = _Made(lambda inner: inner)
    Parts = _Made(lambda inner: tuple[inner, ...])
    Named = _Made(lambda inner: dict[str, inner])

    class OneError(type(pydantic.BaseModel)):
        """Of models whose constructors raise InputError, as reading does."""

        def __call__(cls, *given: Any, **named: Any) -> Any:
            try:
                return super().__call__(*given, **named)
            except pydantic.ValidationError as error:
                raise first_fault(error) from None

        @property
        def __signature__(cls) -> inspect.Signature:
            """The signature, with types as the source names them: what pydantic makes of them is pages long."""
            cls.model_rebuild()  # does nothing where it was built
            written = {
                name: text for base in reversed(cls.__mro__) for name, text in inspect.get_annotations(base).items()
            }
            built: inspect.Signature = cls._built_signature
            fields = built.parameters.values()
            plain = [f.replace(annotation=written.get(f.name, f.annotation)) for f in fields]
            return built.replace(parameters=plain)

        @__signature__.setter
        def __signature__(cls, built: Any) -> None:
            """What pydantic gives a class as it is built: a descriptor that makes the signature when it is asked."""
            cls._built_signature = built
