"""Files of other programs as the objects that recipes select from: OBJ by its objects and groups, COMPAS documents by
their names. Each name is a layer.

Lines of one name that go on from each other are polylines. Ids follow from the names and the order, so that a recipe
finds the same objects when the file is read again.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any
from uuid import NAMESPACE_URL, UUID, uuid5

import numpy as np
from numpy.typing import NDArray

from hookean.files.drawn import WELD, Drawn
from hookean.files.recipe.drawing import UNIT_NAMES, UNSTATED
from hookean.files.rhino.geometry import build
from hookean.files.rhino.model import Layer, Model, Object
from hookean.values.mesh import Mesh
from hookean.values.units import METRES

BLACK = (0, 0, 0, 255)
SUFFIXES = (".obj", ".json")


def drawn_in(data: bytes, kind: str) -> Drawn | None:
    """What is drawn in an OBJ file or in COMPAS documents, by the suffix of their reader; None for a file that holds a
    whole model, such as a scene. InputError for a fault in the file."""
    from hookean.files import documents, obj_read
    from hookean.scene.text import parse

    if kind == ".obj":
        return obj_read.read(data)
    return documents.drawn(parse(data, "/")) if kind == ".json" else None


def model_of(drawn: Drawn, name: str) -> Model:
    """It as a model with a layer for each name. Where no unit is stated, numbers are those of the recipe's unit."""
    shapes = [*_meshes(drawn), *_lines(drawn), *_points(drawn)]
    names = list(dict.fromkeys(called for called, _ in shapes))
    unit = next((rhino for rhino, own in UNIT_NAMES.items() if own == drawn.unit), UNSTATED)
    ends = [np.asarray(shape.vertices if isinstance(shape, Mesh) else shape).reshape(-1, 3) for _, shape in shapes]
    size = float(np.ptp(np.concatenate(ends), axis=0).max()) if ends else 0.0
    return Model(
        name=name,
        version=0,
        unit=unit if drawn.stated else UNSTATED,
        metres=METRES[drawn.unit] if drawn.stated else None,
        tolerance=float(f"{max(WELD[1] * size, 1e-12):.3g}"),
        layers=tuple(_layer(i, called) for i, called in enumerate(names)),
        objects=tuple(_object(i, called, shape) for i, (called, shape) in enumerate(shapes)),
        blocks=(),
        lights=0,
        text={},
        lost=(),
        warnings=tuple(drawn.warnings),
    )


def _layer(number: int, called: str) -> Layer:
    id = uuid5(NAMESPACE_URL, f"layer {called}")
    return Layer(number, id, called, _path(called), None, True, False, BLACK, False)


def _path(called: str) -> str:
    """A name as a layer: of one level, and not of hookean's own."""
    path = called.replace("::", " / ").strip()
    return f"{path} (of the file)" if path.casefold() == "hookean" else path


def _object(number: int, called: str, shape: Any) -> Object:
    built = build(shape, None, called).geometry
    return Object(
        id=_id(number, called, built),
        index=number,
        name="",
        layer=_path(called),
        geometry=built,
        kind=type(built).__name__,
        user_text={},
        visible=True,
        locked=False,
        colour=BLACK,
        by_parent=False,
        is_instance=False,
        own=False,
        marked=False,
        page=False,
    )


def _id(number: int, called: str, built: Any) -> UUID:
    return uuid5(NAMESPACE_URL, f"{number} {called} {type(built).__name__}")


def _meshes(drawn: Drawn) -> Iterator[tuple[str, Mesh]]:
    yield from drawn.meshes


def _lines(drawn: Drawn) -> Iterator[tuple[str, NDArray[np.float64]]]:
    """Segments that go on where the one before ends as polylines."""
    for called, lines in drawn.lines:
        goes_on = (lines[1:, 0] == lines[:-1, 1]).all(axis=1)
        for part in np.split(lines, np.flatnonzero(~goes_on) + 1):
            yield called, np.concatenate([part[:1, 0], part[:, 1]])


def _points(drawn: Drawn) -> Iterator[tuple[str, NDArray[np.float64]]]:
    for called, points in drawn.points:
        yield from ((called, point) for point in points)
