"""Sheet: one picture of several panels, results and graphs side by side, as a figure in a book shows them."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from hookean.atomic_write import check_target, put
from hookean.errors import InputError
from hookean.pictures.chart import Graph as Graph
from hookean.pictures.layout import Cell, GraphCell, SpaceCell, compose
from hookean.running.result import Result
from hookean.scene.scene import Scene
from hookean.values.units import METRES

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Panel:
    """A result seen in space. `frames` are earlier shapes (n, 3) [length], by label, drawn fainter and behind it, the
    first one faintest; `curves` further lines (k, 3) [length] by label, such as a closed form or a smooth curve for
    display. Without a result only the curves are drawn, in the scene's unit of length or else in `unit`."""

    result: Result | None = None
    scene: Scene | None = None
    title: str = ""
    view: str | tuple[float, float] | None = None
    frames: Mapping[str, Floats] = field(default_factory=dict)
    curves: Mapping[str, Floats] = field(default_factory=dict)
    unit: str = "m"


def sheet(
    panels: Sequence[Panel | Graph],
    path: str | os.PathLike[str],
    *,
    title: str = "",
    size: tuple[int, int] | None = None,
    columns: int | None = None,
    same_scale: bool = True,
) -> None:
    """Draw panels to one PNG file of `size` pixels, in rows of `columns`; without these as fits the panels.

    `same_scale` gives all panels in space the same length per pixel, and one legend of forces whose ends are the
    extremes over all of them; else each has its own. Raises InputError where a panel, view or size makes no sense, or
    the file cannot be written.
    """
    check_picture(path)
    put(path, drawn(panels, title=title, size=size, columns=columns, same_scale=same_scale), _is_png)


def check_picture(path: str | os.PathLike[str]) -> None:
    """InputError where a picture cannot be written to this path."""
    check_target(path)
    name = os.fspath(path)
    if "\0" in name:
        raise InputError("path", "has a character that is invalid in file names; check it")
    if not name.lower().endswith(".png"):
        raise InputError(os.path.basename(name), "is not a .png file; give a name that ends in .png.")


def drawn(
    panels: Sequence[Panel | Graph],
    *,
    title: str = "",
    size: tuple[int, int] | None = None,
    columns: int | None = None,
    same_scale: bool = True,
) -> bytes:
    """What `sheet` writes: a picture as the bytes of a PNG file."""
    if size is not None and (len(size) != 2 or not all(200 <= side <= 10_000 for side in size)):
        raise InputError("size", f"{size} given; two numbers of pixels from 200 to 10000 are allowed")
    if not len(panels):
        raise InputError("panels", "is empty; give at least one Panel or Graph")
    if columns is not None and not 1 <= columns <= 12:
        raise InputError("columns", f"{columns} given; 1 to 12 are allowed")
    cells = [_cell(i, panel) for i, panel in enumerate(panels)]
    return compose(cells, title, size, columns, same_scale)


def _cell(i: int, panel: Panel | Graph) -> Cell:
    """A panel, checked and ready to be laid out; InputError names which one is at fault."""
    try:
        if isinstance(panel, Graph):
            return GraphCell(panel)
        if not isinstance(panel, Panel):
            raise InputError("", f"is a {type(panel).__name__}; give a Panel or a Graph")
        units = panel.result.units if panel.result else panel.scene.units if panel.scene else None
        unit = str(units.length) if units else panel.unit
        if unit not in METRES:
            raise InputError("unit", f"{unit!r} given; {', '.join(METRES)} are allowed")
        return SpaceCell(panel.result, panel.scene, panel.title, panel.view, panel.frames, panel.curves, unit)
    except InputError as error:
        raise InputError(f"panels/{i}" + f"/{error.pointer}" * bool(error.pointer), error.sentence) from None


def _is_png(data: bytes) -> None:
    if not data.startswith(b"\x89PNG"):
        raise InputError("picture", "could not be written as PNG; try another version of matplotlib")
