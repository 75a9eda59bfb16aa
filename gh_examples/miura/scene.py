"""Origami: a sheet of Miura folds, rigid panels that hinges fold further."""

from typing import Any

import numpy as np

from hookean import Scene
from hookean.discretize import quads


def scene(
    fold: float = 60.0, start: float = 10.0, rows: int = 6, columns: int = 8, side: float = 1.0, height: float = 1.0,
    angle: float = 60.0, strength: float = 1e4, **settings: Any,
) -> Scene:  # fmt: skip
    """Parallelograms in `rows` and `columns`, of sides `side` and `height` [m] at an `angle` [degrees], folded by
    `start` [degrees]: so much each panel leans. Hinges in all level creases turn them on to `fold`.

    Each panel is a rigid body of its four corners, of a `strength` [N/m]; neighbours share two corners.
    """
    x = folded(start, rows, columns, side, height, angle)
    faces = quads(x.reshape(rows + 1, columns + 1, 3)).faces
    crease = creases(rows, columns)
    turn = np.radians(2.0 * fold) * np.where(np.arange(rows - 1).repeat(columns) % 2, 1.0, -1.0)
    return Scene(
        particles=x,
        meshes={"sheet": {"vertices": x, "faces": faces}},
        forces=[
            {"kind": "rigid_body", "name": "panels", "particles": faces.ravel(), "strength": strength,
             "group": np.arange(len(faces)).repeat(4)},
            {"kind": "hinge", "name": "creases", "particles": crease, "strength": 10.0, "rest_angle": turn},
        ],
        anchors=[
            {"particles": [0]}, {"particles": [2], "axes": "yz"}, {"particles": [2 * (columns + 1)], "axes": "z"},
        ],
        geometry=[{"name": "sheet", "kind": "mesh", "mesh": "sheet"}],
        settings={"tolerance": 1e-9, **settings},
    )  # fmt: skip


def folded(fold: float, rows: int, columns: int, side: float, height: float, angle: float) -> np.ndarray:
    """Corners of the sheet when each panel leans by `fold` [degrees] (Schenk and Guest, "Geometry of Miura-folded
    metamaterials", PNAS 110, 2013): zigzags of `columns` panels, level, `rows` of them up and down."""
    lean, corner = np.radians(fold), np.radians(angle)
    up = height * np.sin(lean) * np.sin(corner)
    across = np.sqrt(1.0 + (np.cos(lean) * np.tan(corner)) ** 2)
    along, aside = side * np.cos(lean) * np.tan(corner) / across, side / across
    forward = height * np.sqrt(1.0 - (np.sin(lean) * np.sin(corner)) ** 2)
    j, i = np.divmod(np.arange((rows + 1) * (columns + 1)), columns + 1)
    return np.column_stack([along * i, forward * j + aside * (i % 2), up * (j % 2)])


def creases(rows: int, columns: int) -> np.ndarray:
    """The level creases between two panels: their ends, and a corner of the panel on either side."""
    j, i = np.divmod(np.arange((rows - 1) * columns), columns)
    first = (j + 1) * (columns + 1) + i
    return np.column_stack([first, first + 1, first + columns + 1, first - columns - 1])
