"""Natives of the panel Grid whose cells are not rectangles.

Layouts: the notes of a public re-implementation that compared them with Grasshopper (pyhopper, components of the panel
Grid): hexagons lie flat, odd columns are half a cell higher, sectors go round clockwise from the y axis.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from hookean_canvas.run.natives import shapes
from hookean_canvas.run.natives.declare import Unfit, bounded, native

_FLAT = "Plane (P): plane; Size (S): number = 1.0; Extent X (Ex): integer = 5; Extent Y (Ey): integer = 5"
_GRID = "Cells (C): branches; Points (P): branches"
_Made = tuple[list[list[Any]], list[list[Any]]]


def _checked(*counts: int) -> None:
    if min(counts) < 1:
        raise Unfit("a grid needs at least one cell each way")
    bounded(math.prod(counts))


def _cells(frame: Any, columns: list[list[Any]], middles: Any) -> _Made:
    cells = [[shapes.polyline(shapes.in_plane(frame, cell), closed=True) for cell in column] for column in columns]
    return cells, [shapes.points(shapes.in_plane(frame, column)) for column in middles]


@native("125dc122-8544-4617-945e-bb9a0c101c50", "Hexagonal", "HexGrid", _FLAT, _GRID,
        remark="the first cell touches both axes of the plane; where it lies there is not documented")  # fmt: skip
def hexagonal_grid(frame: Any, size: float, nx: int, ny: int) -> _Made:
    """A grid of regular hexagons of a radius: outlines and centres, a branch for each column."""
    _checked(nx, ny)
    high = 0.5 * math.sqrt(3.0) * size
    turns = math.pi / 3.0 * np.arange(6)
    ring = size * np.stack([np.cos(turns), np.sin(turns)], axis=1)
    i, j = np.meshgrid(np.arange(nx), np.arange(ny), indexing="ij")
    middles = np.stack([size * (1.0 + 1.5 * i), high * (1.0 + 2.0 * j + i % 2)], axis=-1)
    return _cells(frame, list(middles[:, :, None] + ring), middles)


@native("86a9944b-dea5-4126-9433-9e95ff07927a", "Triangular", "TriGrid", _FLAT, _GRID,
        remark="the first cell touches both axes of the plane; where it lies there is not documented")  # fmt: skip
def triangular_grid(frame: Any, size: float, nx: int, ny: int) -> _Made:
    """A grid of regular triangles of a side: outlines and centres, a branch for each column."""
    _checked(nx, ny)
    high = 0.5 * math.sqrt(3.0) * size
    up = np.array([[0.0, 0.0], [size, 0.0], [0.5 * size, high]])
    down = np.array([[0.5 * size, 0.0], [size, high], [0.0, high]])
    columns = [
        [(down if (i + j) % 2 else up) + [0.5 * size * i, high * j] for j in range(ny)] for i in range(nx)
    ]  # fmt: skip
    return _cells(frame, columns, np.array(columns).mean(axis=2))


@native("66eedc35-187d-4dab-b49b-408491b1255f", "Radial", "RadGrid",
        "Plane (P): plane; Size (S): number = 1.0; Extent R (Er): integer = 5; Extent P (Ep): integer = 20",
        _GRID)  # fmt: skip
def radial_grid(frame: Any, size: float, rings: int, sectors: int) -> _Made:
    """Rings of cells round the origin of a plane, the first of triangles: outlines and corners, a branch for a ring."""
    _checked(rings, sectors)
    turns = 2.0 * math.pi * np.arange(sectors + 1) / sectors
    spokes = np.stack([np.sin(turns), np.cos(turns)], axis=1)
    at = size * np.arange(rings + 1)[:, None, None] * spokes
    columns = [
        [
            [*([at[0, 0]] if r == 0 else [at[r, k + 1], at[r, k]]), at[r + 1, k], at[r + 1, k + 1]]
            for k in range(sectors)
        ]
        for r in range(rings)
    ]
    return _cells(frame, columns, at[:, :-1])
