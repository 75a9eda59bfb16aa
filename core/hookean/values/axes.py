"""A field type of forces: names of axes, one for all elements or one for each."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
from numpy.typing import NDArray
from pydantic import PlainSerializer, PlainValidator, WithJsonSchema

from hookean.values.columns import fault

if TYPE_CHECKING:
    from hookean.values.fields import Column

Names = NDArray[np.str_]

ALL = ("", "x", "y", "z", "xy", "xz", "yz", "xyz")


def _axes(value: Any) -> str | Names:
    if isinstance(value, str):
        return _known(value, "")
    if not isinstance(value, list | tuple | np.ndarray) or (isinstance(value, np.ndarray) and value.ndim != 1):
        raise fault("one text or one for each element expected, of " + _words())
    array = np.array([_known(item, f"/{i}") for i, item in enumerate(value)], dtype="<U3")
    array.flags.writeable = False
    return array


def _known(value: Any, at: str) -> str:
    if not isinstance(value, str) or value not in ALL:
        said = repr(str(value)) if isinstance(value, str) else str(value)
        raise fault(f"{said} given; {_words()} allowed", at)
    return str(value)


def _words() -> str:
    return ", ".join(repr(name) for name in ALL[:-1]) + f" or {ALL[-1]!r}"


def named(axes: str | Names, axis: str, count: int) -> NDArray[np.bool_]:
    """Whether each of `count` elements has this axis among its own."""
    return np.broadcast_to(np.char.find(np.asarray(axes), axis) >= 0, count)


_NAME = {"type": "string", "enum": list(ALL)}

if TYPE_CHECKING:
    AxisNames = Column[str | Names]
else:
    AxisNames = Annotated[
        str | Names,
        PlainValidator(_axes),
        PlainSerializer(lambda value: value if isinstance(value, str) else value.tolist()),
        WithJsonSchema({"anyOf": [_NAME, {"type": "array", "items": _NAME}]}),
    ]
    """Axes such as "yz", or one text for each element."""
