"""Anchors that are drawn beside the particles they are meant to hold: moved to the nearest one."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from hookean.errors import InputError
from hookean.files.recipe.shapes import Shape
from hookean.scene.scene import Scene
from hookean.system.weld import Welded

Floats = NDArray[np.float64]


def distances(scene: Scene, points: Floats) -> Floats:
    """How far each point (n, 3) is from the nearest particle of a scene [length]; infinite without particles."""
    x = Welded(scene).x
    return np.asarray(cKDTree(x).query(points)[0]) if len(x) else np.full(len(points), np.inf)


def snapped(scene: Scene, reach: Mapping[int, float]) -> Scene:
    """The scene with the points of some anchors, by their number, moved to the nearest particle within their reach
    [length]. Two points that would move to one particle are one."""
    x = Welded(scene).x
    if not reach or not len(x):
        return scene
    anchors = list(scene.anchors)
    for number, most in reach.items():
        points = np.asarray(anchors[number].points)
        apart, nearest = cKDTree(x).query(points)
        moved = np.where((apart <= most)[:, None], x[nearest], points)
        anchors[number] = anchors[number].replaced(points=np.unique(moved, axis=0))
    return scene.replaced(anchors=tuple(anchors))


def reach_of(table: Mapping[str, object], pointer: str) -> float:
    """The value of `snap` [length] in the table of an anchor; 0 without one."""
    given = table.get("snap", 0.0)
    if isinstance(given, bool) or not isinstance(given, int | float) or not 0 <= given < np.inf:
        raise InputError(f"{pointer}/snap", f"{given!r} given; give the largest distance to a particle, at least 0")
    return float(given)


def drawn_on(anchors: Sequence[Shape | None]) -> list[Any]:
    """Coordinates of anchors that no force connects: particles between which lines can be drawn [length]."""
    found = [shape.array.reshape(-1, 3) for shape in anchors if shape is not None]
    return np.unique(np.concatenate(found), axis=0).tolist() if found else []
