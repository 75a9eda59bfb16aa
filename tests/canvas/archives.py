"""Archives for tests: real ones where they are installed, and strategies for any."""

from __future__ import annotations

import importlib.metadata
import math
import uuid
from decimal import Decimal
from pathlib import Path

import pytest
from hypothesis import strategies as st

from hookean_canvas.archive import Chunk, Item, Type

SHARED = Path(__file__).parents[3] / "shared" / "data" / "grasshopper"
PACKAGES = {"compas": 5, "ladybug-grasshopper": 122, "honeybee-grasshopper-core": 70}
"""Installed packages that carry user objects, and how many at least."""


def user_objects(package: str) -> list[Path]:
    """The .ghuser files of an installed package; the test is skipped where it is not installed."""
    try:
        files = importlib.metadata.files(package) or []
    except importlib.metadata.PackageNotFoundError:
        pytest.skip(f"{package} is not installed: its user objects are the files to read")
    return sorted(Path(str(file.locate())) for file in files if file.suffix == ".ghuser")


def samples() -> list[Path]:
    """The .gh and .ghuser of the shared folder; the test is skipped where it is absent."""
    found = sorted(SHARED.glob("*.gh*")) if SHARED.is_dir() else []
    if not found:
        pytest.skip("the shared folder with Grasshopper files is absent")
    return found


# ------------------------------------------------------------------------------------------------------- strategies

TEXT = st.text(max_size=40)
# what an XML file may hold: no control characters but tab and the line ends
XML_TEXT = st.text(
    st.characters(exclude_categories=["Cs", "Cc"], include_characters="\t\n\r", exclude_characters="￾￿"),
    max_size=40,
)
INT32, INT64 = st.integers(-(2**31), 2**31 - 1), st.integers(-(2**63), 2**63 - 1)
DOUBLE, SINGLE = st.floats(), st.floats(width=32).filter(lambda x: not math.isnan(x)) | st.just(math.nan)
DOUBLE = DOUBLE.filter(lambda x: not math.isnan(x)) | st.just(math.nan)  # one NaN: XML has no payloads
DECIMAL = st.builds(
    lambda sign, number, scale: Decimal((sign, tuple(map(int, str(number))), -scale)),
    st.integers(0, 1),
    st.integers(0, 2**96 - 1),
    st.integers(0, 28),
)


def values(text: st.SearchStrategy[str]) -> dict[Type, st.SearchStrategy]:
    """A strategy for the values of each type."""

    def several(count: int, part: st.SearchStrategy) -> st.SearchStrategy:
        return st.tuples(*[part] * count)

    return {
        Type.BOOL: st.booleans(),
        Type.BYTE: st.integers(0, 255),
        Type.INT32: INT32,
        Type.INT64: INT64,
        Type.SINGLE: SINGLE,
        Type.DOUBLE: DOUBLE,
        Type.DECIMAL: DECIMAL,
        Type.DATE: INT64,
        Type.GUID: st.uuids() | st.just(uuid.UUID(int=0)),
        Type.STRING: text,
        Type.BYTEARRAY: st.binary(max_size=40),
        Type.DOUBLEARRAY: st.lists(DOUBLE, max_size=5).map(tuple),
        Type.DRAWING_POINT: several(2, INT32),
        Type.DRAWING_POINTF: several(2, SINGLE),
        Type.DRAWING_SIZE: several(2, INT32),
        Type.DRAWING_SIZEF: several(2, SINGLE),
        Type.DRAWING_RECTANGLE: several(4, INT32),
        Type.DRAWING_RECTANGLEF: several(4, SINGLE),
        Type.DRAWING_COLOR: several(4, st.integers(0, 255)),
        Type.DRAWING_BITMAP: st.binary(max_size=40),
        Type.POINT2D: several(2, DOUBLE),
        Type.POINT3D: several(3, DOUBLE),
        Type.POINT4D: several(4, DOUBLE),
        Type.INTERVAL1D: several(2, DOUBLE),
        Type.INTERVAL2D: several(4, DOUBLE),
        Type.LINE: several(6, DOUBLE),
        Type.BOUNDINGBOX: several(6, DOUBLE),
        Type.PLANE: several(9, DOUBLE),
        Type.VERSION: several(3, INT32),
    }


def chunks(text: st.SearchStrategy[str]) -> st.SearchStrategy[Chunk]:
    """Any archive whose texts are of that strategy: all types, names of any kind, some levels deep."""
    of_type = values(text)
    item = st.sampled_from(list(Type)).flatmap(
        lambda type: st.builds(Item, text, st.integers(-1, 20), st.just(type), of_type[type])
    )
    items = st.lists(item, max_size=6, unique_by=lambda item: (item.name, item.index))
    leaf = st.builds(Chunk, text, INT32, items, st.just([]))
    return st.recursive(
        leaf, lambda inner: st.builds(Chunk, text, INT32, items, st.lists(inner, max_size=3)), max_leaves=12
    )
