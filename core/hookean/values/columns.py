"""Field types of a scene: numbers and arrays that are finite, of the right shape, and read-only once given."""

from __future__ import annotations

import base64
import binascii
import functools
import inspect
import math
import threading
from collections.abc import Mapping
from itertools import chain
from types import NoneType, UnionType
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Self, Union, get_args, get_origin

import numpy as np
from numpy.typing import NDArray
from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    PlainSerializer,
    PlainValidator,
    ValidationError,
    WithJsonSchema,
    model_validator,
)
from pydantic_core import PydanticCustomError

from hookean.values.faults import first_fault
from hookean.values.fields import OneError

if TYPE_CHECKING:
    from hookean.values.fields import Column

LARGEST = 1e12  # beyond this, squares of lengths and products with stiffness lose all meaning in float64

_BUILDING = threading.RLock()


class Model(BaseModel, metaclass=OneError):
    """Base of everything a person describes: frozen, no unknown names, finite numbers only.

    Constructors and `model_copy` raise InputError.
    """

    called: ClassVar[str] = ""  # the name of the class in sentences: its own in small letters where it gives none

    model_config = ConfigDict(
        extra="forbid",
        frozen=True,
        allow_inf_nan=False,
        arbitrary_types_allowed=True,
        validate_default=True,
        defer_build=True,  # of a hundred models a scene has ten: the others cost a program that starts half a second
    )

    @model_validator(mode="before")
    @classmethod
    def _as_the_schema_has_it(cls, given: Any) -> Any:
        """No text for a number, no true or false for one, and no number or text for true or false: pydantic would
        convert them, and `"tolerance": true` would be a tolerance of 1."""
        for name, value in given.items() if isinstance(given, dict) else ():
            if isinstance(value, bool | int | str) and name in cls.model_fields:
                expected = _plain_kind(cls, name)
                if expected is float and isinstance(value, bool | str):
                    raise fault(f"{_named_kind(value)} given; a number expected", f"/{name}")
                if expected is bool and not isinstance(value, bool):
                    raise fault(f"{_named_kind(value)} given; true or false expected", f"/{name}")
        return given

    @classmethod
    def __pydantic_init_subclass__(cls, **kwargs: Any) -> None:
        """Name the class, and leave annotations of class variables out, of which pydantic now has the names: it would
        evaluate them again for each class that is derived from this one."""
        super().__pydantic_init_subclass__(**kwargs)
        cls.called = cls.__dict__.get("called", cls.__name__.lower())
        written = inspect.get_annotations(cls)
        cls.__annotations__ = {name: text for name, text in written.items() if name not in cls.__class_vars__}

    @classmethod
    def model_rebuild(cls, *, _parent_namespace_depth: int = 2, **given: Any) -> bool | None:
        """Build it, one thread at a time: the oldest pydantic that is allowed has no lock of its own."""
        if cls.__pydantic_complete__ and not given.get("force"):
            return None
        with _BUILDING:
            return super().model_rebuild(_parent_namespace_depth=_parent_namespace_depth + 1, **given)

    @classmethod
    def read(cls, value: Any) -> Self:
        """The model of a dict, or the one given; InputError with a pointer and one sentence."""
        if isinstance(value, cls):
            return value
        try:
            return cls.model_validate(value)
        except ValidationError as error:
            raise first_fault(error) from None

    def __eq__(self, other: object) -> bool:
        return type(other) is type(self) and self.model_dump() == other.model_dump()

    def __hash__(self) -> int:
        return hash(self.model_dump_json())

    def model_copy(self, *, update: Mapping[str, Any] | None = None, deep: bool = False) -> Self:
        """A copy with other values of some fields; InputError for an unknown name or a value that is not allowed."""
        if not update:
            return super().model_copy(deep=deep)
        given = {name: getattr(self, name) for name in self.model_fields_set}
        copied = type(self)(**{**given, **update})
        return copied.model_copy(deep=True) if deep else copied

    def replaced(self, **values: Any) -> Self:
        """A copy with other values of some fields that are known to be right: nothing is checked."""
        return super().model_copy(update=values)


@functools.cache
def _plain_kind(model: type[BaseModel], name: str) -> type | None:
    """float where a field holds numbers alone, bool where it holds true or false alone (or nothing); else None."""
    hint = model.model_fields[name].annotation
    kinds = set(get_args(hint) if get_origin(hint) in (Union, UnionType) else [hint]) - {NoneType}
    if kinds and kinds <= {int, float}:
        return float
    return bool if kinds == {bool} else None


def _named_kind(value: bool | int | str) -> str:
    if isinstance(value, str):
        return "a text"
    return str(value).lower() if abs(value) < 1e15 else "a number"


def fault(sentence: str, at: str = "") -> PydanticCustomError:
    """A validation error; `at` is the rest of the pointer inside the field, such as `/17/2`."""
    return PydanticCustomError("column", "{sentence}", {"sentence": sentence, "at": at})


def _decoded(value: Any) -> NDArray[Any]:
    """The array in `value`: nested lists, a numpy array, or {"dtype", "shape", "base64"} (little endian)."""
    if isinstance(value, dict):
        if set(value) != {"dtype", "shape", "base64"}:
            raise fault('an array given as an object has exactly the keys "dtype", "shape" and "base64"')
        return _from_buffer(value["dtype"], value["shape"], value["base64"])
    if isinstance(value, str | bytes) or value is None:
        raise fault(f"{'null' if value is None else 'a text'} given where numbers are expected")
    if isinstance(value, list | tuple) and _mixes_truth(value):
        raise fault("whole or decimal numbers are expected, not true or false", _truth(value))
    try:
        return np.asarray(value)
    except (ValueError, TypeError, OverflowError):
        raise fault("rows have different lengths; every row needs the same number of values") from None


def _mixes_truth(value: Any) -> bool:
    """Whether there is true or false among numbers: numpy would convert them to 1 and 0."""
    while value:
        kinds = set(map(type, value))
        if bool in kinds:
            return True
        if not kinds <= {list, tuple}:
            return False
        value = list(chain.from_iterable(value))
    return False


def _truth(value: Any, at: str = "") -> str:
    for i, item in enumerate(value):
        if isinstance(item, bool):
            return f"{at}/{i}"
        if isinstance(item, list | tuple) and (found := _truth(item, f"{at}/{i}")):
            return found
    return ""


def _from_buffer(dtype: Any, shape: Any, text: Any) -> NDArray[Any]:
    allowed = {"<f8", "<f4", "<i8", "<i4", "<u4", "<u8", "float64", "float32", "int64", "int32", "uint32"}
    if not isinstance(dtype, str) or dtype not in allowed:
        raise fault(f"dtype must be one of {', '.join(sorted(allowed))}", "/dtype")
    sizes = isinstance(shape, list | tuple) and len(shape) <= 3 and all(type(s) is int and s >= 0 for s in shape)
    if not sizes or max(shape, default=0) >= 2**40:
        raise fault("shape must be a list of at most three whole numbers", "/shape")
    try:
        raw = base64.b64decode(text, validate=True)
    except (binascii.Error, ValueError, TypeError):
        raise fault("the text is not valid base64", "/base64") from None
    kind = np.dtype(dtype).newbyteorder("<")
    expected = math.prod(shape) * kind.itemsize
    if len(raw) != expected:
        raise fault(f"{len(raw)} bytes given, shape and dtype need {expected}", "/base64")
    return np.frombuffer(raw, kind).reshape(shape)


def _first(mask: NDArray[Any]) -> str:
    """Pointer to the first true entry of `mask`."""
    spot = np.argwhere(mask)
    return "".join(f"/{i}" for i in spot[0]) if len(spot) else ""


def _real(value: Any) -> NDArray[np.float64]:
    array = _decoded(value)
    if array.dtype == object and all(type(item) in (int, float) for item in array.flat):
        raise fault(f"larger than the limit, {LARGEST:g}", _first(abs(array) > LARGEST))  # whole, and of no type
    if array.dtype == object or array.dtype.kind not in "fiu":
        raise fault("numbers are expected, not text, true, false or null", _odd(value))
    array = np.array(array, dtype=np.float64, order="C")
    bad = ~np.isfinite(array)
    if bad.any():
        raise fault("not a finite number", _first(bad))
    large = np.abs(array) > LARGEST
    if large.any():
        raise fault(f"larger than the limit, {LARGEST:g}", _first(large))
    array.flags.writeable = False
    return array


def _odd(value: Any, at: str = "") -> str:
    """Pointer to the first entry that is not a number."""
    if isinstance(value, list | tuple):
        for i, item in enumerate(value):
            if isinstance(item, list | tuple | bool) or not isinstance(item, int | float):
                found = _odd(item, f"{at}/{i}") if isinstance(item, list | tuple) else f"{at}/{i}"
                if found:
                    return found
        return ""
    return at


def _shaped(value: Any, *shape: int | None, what: str) -> NDArray[np.float64]:
    array = _real(value)
    if array.size == 0 and shape[0] is None:
        array = np.zeros([0 if s is None else s for s in shape])
    if array.ndim != len(shape) or any(s is not None and s != a for s, a in zip(shape, array.shape, strict=True)):
        raise fault(f"shape {list(array.shape)} given; {what} expected")
    return array


def _points(value: Any) -> NDArray[np.float64]:
    return _shaped(value, None, 3, what="rows of x, y, z")


def _lines(value: Any) -> NDArray[np.float64]:
    return _shaped(value, None, 2, 3, what="pairs of points [[x, y, z], [x, y, z]]")


def _point_rows(value: Any) -> NDArray[np.float64]:
    return _shaped(value, None, None, 3, what="for each element a row of points")


def _vector(value: Any) -> NDArray[np.float64]:
    return _shaped(value, 3, what="x, y, z")


def _vectors(value: Any) -> NDArray[np.float64]:
    array = _real(value)
    if array.ndim not in (1, 2) or array.shape[-1] != 3:
        raise fault(f"shape {list(array.shape)} given; one x, y, z or one for each element expected")
    return array


def _nonzero(vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    zero = np.flatnonzero(~np.atleast_2d(vectors).any(axis=1))
    if len(zero):
        spot = f"/{zero[0]}" if vectors.ndim > 1 else ""
        raise fault("a vector of zero length given; give one that is not 0, 0, 0", spot)
    return vectors


def _whole(value: Any) -> NDArray[np.int64]:
    array = _decoded(value)
    if array.size == 0:
        return np.zeros((0,) if array.ndim < 2 else array.shape, np.int64)
    if array.dtype == object or array.dtype.kind not in "iu":
        raise fault("whole numbers are expected; particles are counted from 0", _not_whole(value))
    if array.dtype.kind == "u" and (array > 2**62).any():
        raise fault("larger than any possible particle number", _first(array > 2**62))
    negative = array < 0
    if negative.any():
        spot = _first(negative)
        raise fault(f"{int(array[negative][0])} given; particles are counted from 0", spot)
    return np.array(array, dtype=np.int64, order="C")


def _not_whole(value: Any, at: str = "") -> str:
    if isinstance(value, list | tuple):
        for i, item in enumerate(value):
            if type(item) is not int and (spot := _not_whole(item, f"{at}/{i}")):
                return spot
        return ""
    return at


def _labels(value: Any) -> NDArray[np.int64]:
    array = _decoded(value)
    if array.size and (array.dtype == object or array.dtype.kind not in "iu"):
        raise fault("whole numbers are expected", _not_whole(value))
    if array.ndim != 1:
        raise fault(f"shape {list(array.shape)} given; one whole number for each element expected")
    if array.dtype.kind == "u" and (array > 2**62).any():
        raise fault("larger than the limit, 2^62", _first(array > 2**62))
    return _frozen(np.array(array, dtype=np.int64))


def _frozen(array: NDArray[np.int64]) -> NDArray[np.int64]:
    array.flags.writeable = False
    return array


def _indices(value: Any) -> NDArray[np.int64]:
    array = _whole(value)
    if array.ndim != 1:
        raise fault(f"shape {list(array.shape)} given; a plain list of particles expected")
    return _frozen(array)


def _index_rows(value: Any) -> NDArray[np.int64]:
    array = _whole(value)
    if array.size and array.ndim not in (1, 2):
        raise fault(f"shape {list(array.shape)} given; a row of particles for each element expected")
    return _frozen(array)


def _faces(value: Any) -> NDArray[np.int64]:
    """Faces `(m, 4)`; triangles may come as three and repeat their last corner."""
    if isinstance(value, list | tuple):
        rows = []
        for i, face in enumerate(value):
            if not isinstance(face, list | tuple | np.ndarray) or len(face) not in (3, 4):
                raise fault("a face has three or four vertices", f"/{i}")
            rows.append([*face, face[2]] if len(face) == 3 else list(face))
        value = rows
    array = _whole(value)
    if array.size == 0:
        return _frozen(np.zeros((0, 4), np.int64))
    if array.ndim == 2 and array.shape[1] == 3:
        array = np.ascontiguousarray(array[:, [0, 1, 2, 2]])
    if array.ndim != 2 or array.shape[1] != 4:
        raise fault(f"shape {list(array.shape)} given; three or four vertices a face expected")
    return _frozen(array)


def _numbers(low: float, *, strictly: bool = False) -> PlainValidator:
    def check(value: Any) -> float | NDArray[np.float64]:
        if type(value) is float and -LARGEST <= value <= LARGEST and (value > low or (value == low and not strictly)):
            return value  # many times quicker than as an array
        array = _real(value)
        if array.ndim > 1:
            raise fault(f"shape {list(array.shape)} given; one value or one for each element expected")
        small = array <= low if strictly else array < low
        if small.any():
            spot = _first(small) if array.ndim else ""
            given = float(array[small][0]) if array.ndim else float(array)
            raise fault(f"{given:g} given; {'more than' if strictly else 'at least'} {low:g} allowed", spot)
        return array if array.ndim else float(array)

    return PlainValidator(check)


def _plain(value: Any) -> Any:
    return value.tolist() if isinstance(value, np.ndarray) else value


_BUFFER = {
    "type": "object",
    "description": "a large array as little-endian bytes",
    "properties": {
        "dtype": {"type": "string"},
        "shape": {"type": "array", "items": {"type": "integer"}},
        "base64": {"type": "string"},
    },
    "required": ["dtype", "shape", "base64"],
    "additionalProperties": False,
}


def _json(items: dict[str, Any], *others: dict[str, Any]) -> WithJsonSchema:
    return WithJsonSchema({"anyOf": [*others, {"type": "array", "items": items}, _BUFFER]})


_NUMBER = {"type": "number"}
_TRIPLE = {"type": "array", "items": _NUMBER, "minItems": 3, "maxItems": 3}
_WHOLE = {"type": "integer", "minimum": 0}
_out = PlainSerializer(_plain)

if TYPE_CHECKING:
    Floats = NDArray[np.float64]
    Ints = NDArray[np.int64]
    Points = Column[Floats]
    PointRows = Column[Floats]
    Lines = Column[Floats]
    Table = Column[Floats]
    Vector = Column[Floats]
    Vectors = Column[Floats]
    Direction = Column[Floats]
    Directions = Column[Floats]
    Indices = Column[Ints]
    Labels = Column[Ints]
    IndexRows = Column[Ints]
    Faces = Column[Ints]
    NonNegatives = Column[float | Floats]
    Positives = Column[float | Floats]
    Reals = Column[float | Floats]
else:
    Points = Annotated[NDArray[np.float64], PlainValidator(_points), _out, _json(_TRIPLE)]
    """Coordinates `(n, 3)`."""
    PointRows = Annotated[
        NDArray[np.float64], PlainValidator(_point_rows), _out, _json({"type": "array", "items": _TRIPLE})
    ]
    """Coordinates of each element's particles `(m, arity, 3)`."""
    Lines = Annotated[
        NDArray[np.float64],
        PlainValidator(_lines),
        _out,
        _json({"type": "array", "items": _TRIPLE, "minItems": 2, "maxItems": 2}),
    ]
    """Straight lines `(m, 2, 3)`."""
    Table = Annotated[NDArray[np.float64], PlainValidator(_real), _out, _json({})]
    """Numbers of any shape."""
    Vector = Annotated[NDArray[np.float64], PlainValidator(_vector), _out, WithJsonSchema(_TRIPLE)]
    """One vector `(3,)`."""
    Vectors = Annotated[NDArray[np.float64], PlainValidator(_vectors), _out, _json(_TRIPLE, _TRIPLE)]
    """One vector `(3,)` or one for each element `(m, 3)`."""
    Direction = Annotated[Vector, AfterValidator(_nonzero)]
    """One vector `(3,)` of any length but 0."""
    Directions = Annotated[Vectors, AfterValidator(_nonzero)]
    """Vectors of any length but 0, one `(3,)` or one for each element `(m, 3)`."""
    Indices = Annotated[NDArray[np.int64], PlainValidator(_indices), _out, _json(_WHOLE)]
    """Particles `(m,)`, counted from 0."""
    Labels = Annotated[NDArray[np.int64], PlainValidator(_labels), _out, _json({"type": "integer"})]
    """Whole numbers `(m,)`, one for each element: those with the same number belong together."""
    IndexRows = Annotated[
        NDArray[np.int64],
        PlainValidator(_index_rows),
        _out,
        _json({"anyOf": [_WHOLE, {"type": "array", "items": _WHOLE}]}),
    ]
    """Particles of each element `(m, arity)`."""
    Faces = Annotated[
        NDArray[np.int64],
        PlainValidator(_faces),
        _out,
        _json({"type": "array", "items": _WHOLE, "minItems": 3, "maxItems": 4}),
    ]
    """Faces of a mesh `(m, 4)`; a triangle repeats its last corner."""
    NonNegatives = Annotated[
        float | NDArray[np.float64],
        _numbers(0.0),
        _out,
        _json({"type": "number", "minimum": 0}, {"type": "number", "minimum": 0}),
    ]
    """One value >= 0, or one for each element."""
    Positives = Annotated[
        float | NDArray[np.float64],
        _numbers(0.0, strictly=True),
        _out,
        _json({"type": "number", "exclusiveMinimum": 0}, {"type": "number", "exclusiveMinimum": 0}),
    ]
    """One value > 0, or one for each element."""
    Reals = Annotated[float | NDArray[np.float64], _numbers(-LARGEST), _out, _json(_NUMBER, _NUMBER)]
    """One value, or one for each element."""
