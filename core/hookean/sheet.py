"""Sheet: one picture of several panels, results and graphs side by side, as a figure in a book shows them."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from hookean.picture import render
from hookean.result import Result
from hookean.scene import Scene

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Panel:
    """A result seen in space. `frames` are earlier shapes [length], by label, drawn fainter and behind it, the first
    one faintest; `curves` further lines (k, 3) [length] by label, such as a closed form or a smooth curve for display.
    Without a result only the curves are drawn."""

    result: Result | None = None
    scene: Scene | None = None
    title: str = ""
    view: str | tuple[float, float] | None = None
    frames: Mapping[str, Floats] = field(default_factory=dict)
    curves: Mapping[str, Floats] = field(default_factory=dict)


@dataclass(frozen=True)
class Graph:
    """Lines over an axis: `lines` by label are (x, y); `dots` likewise, drawn as points. Axis labels have units."""

    title: str = ""
    x_label: str = ""
    y_label: str = ""
    lines: Mapping[str, tuple[Floats, Floats]] = field(default_factory=dict)
    dots: Mapping[str, tuple[Floats, Floats]] = field(default_factory=dict)


def sheet(
    panels: Sequence[Panel | Graph],
    path: str | os.PathLike[str],
    *,
    title: str = "",
    size: tuple[int, int] | None = None,
    columns: int | None = None,
    same_scale: bool = True,
) -> None:
    """Draw panels to one PNG file; `same_scale` gives all panels the same length per pixel and the same colours."""
    shown = next(p for p in panels if isinstance(p, Panel) and p.result is not None)
    assert shown.result is not None
    render(shown.result, path, scene=shown.scene, title=title, view=shown.view)
