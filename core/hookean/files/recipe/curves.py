"""Curves in a recipe that no particles lie along: those that points are pulled to (`curve`), and those that sort out
which points a table takes (`on`)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from hookean.discretize.closest import distances, polyline
from hookean.errors import InputError
from hookean.files.recipe import shapes
from hookean.files.recipe.drawing import Item
from hookean.files.recipe.select import count
from hookean.files.recipe.shapes import Floats, Shape

Placed = list[tuple[dict[str, Any], Shape | None]]

CURVE_FIELDS = ("curve_divide", "on")


def lying_on(shape: Shape, items: Sequence[Item], factor: float, tolerance: float, pointer: str) -> Shape:
    """The points of a shape within the tolerance of one of the curves; InputError where none is."""
    apart = _apart(shape.array, items, factor, pointer).min(axis=0, initial=np.inf)
    kept = apart <= tolerance
    if not kept.any():
        raise InputError(
            pointer,
            f"none of {count(len(apart), 'point')} lies within {tolerance:.6g} (weld_tolerance) of "
            f"{shapes.counted(items)}; the nearest is {apart.min():.6g} away",
        )
    return Shape(shape.items, shape.array[kept], shape.owner[kept])


def pulled(table: dict[str, Any], shape: Shape | None, items: Sequence[Item], factor: float, pointer: str) -> Placed:
    """A table of `pull_to_curve` with the polyline of its curve; with several curves a table for each, of the points
    that are nearest to it."""
    split = shapes.split_of(table.get("curve_divide"), f"{pointer}/curve_divide")
    given = {k: v for k, v in table.items() if k not in CURVE_FIELDS}
    if len(items) == 1:
        return [({**given, **_polyline(items[0], split, factor, pointer)}, shape)]
    if shape is None or shape.array.ndim != 2 or shape.faces is not None:
        raise InputError(
            f"{pointer}/curve", f"finds {shapes.counted(items)}; for several curves give points = a selector"
        )
    columns = [k for k in ("strength",) if np.ndim(given.get(k, 0.0)) > 0]
    if columns:
        raise InputError(f"{pointer}/{columns[0]}", "give one value where points are pulled to several curves")
    nearest = _apart(shape.array, items, factor, pointer).argmin(axis=0)
    found: Placed = []
    for number in np.unique(nearest):
        rows = nearest == number
        part = Shape(shape.items, shape.array[rows], shape.owner[rows])
        named = {"name": f"{given.get('name', given['kind'])}/{len(found) + 1}"} if found else {}
        drawn = _polyline(items[number], split, factor, pointer)
        found.append(({**given, **named, "points": part.array, **drawn}, part))
    return found


def _apart(points: Floats, items: Sequence[Item], factor: float, pointer: str) -> Floats:
    """Distances (curves, points) in the scene's units."""
    rows = []
    for item in items:
        try:
            rows.append(distances(points / factor, item.geometry) * factor)
        except InputError as error:
            raise InputError(pointer, f"{item.label}: {error.sentence}") from None
    return np.array(rows)


def _polyline(item: Item, split: shapes.Split | None, factor: float, pointer: str) -> dict[str, Any]:
    """The fields `curve` and, where it is, `closed`."""
    if split is None and not shapes.straight(item):
        raise InputError(
            f"{pointer}/curve", f"{item.label} is curved; give curve_divide = N to pull to a polyline of N pieces"
        )
    try:
        corners = polyline(item.geometry, split[0] if split else 1) * factor
    except InputError as error:
        raise InputError(f"{pointer}/curve", f"{item.label}: {error.sentence}") from None
    if len(corners) > 2 and (corners[0] == corners[-1]).all():
        return {"curve": corners[:-1], "closed": True}
    return {"curve": corners}
