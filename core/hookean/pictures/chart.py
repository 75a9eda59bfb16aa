"""Graph: lines and dots over two axes, in the look of the panels in space."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.errors import InputError
from hookean.pictures.page import SMALL, Box, Entry, Page
from hookean.values.colours import INK, LINES, MUTED, PALE

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Graph:
    """Lines over an axis: `lines` by label are (x, y); `dots` likewise, drawn as points. Axis labels have units.
    `x_log` and `y_log` make an axis logarithmic."""

    title: str = ""
    x_label: str = ""
    y_label: str = ""
    lines: Mapping[str, tuple[Floats, Floats]] = field(default_factory=dict)
    dots: Mapping[str, tuple[Floats, Floats]] = field(default_factory=dict)
    x_log: bool = False
    y_log: bool = False


def check(graph: Graph) -> None:
    """InputError where nothing is to be drawn, or x and y do not fit."""
    if not graph.lines and not graph.dots:
        raise InputError("graph", "has neither lines nor dots; give one of them")
    for kind, given in (("line", graph.lines), ("dots", graph.dots)):
        for label, pair in given.items():
            _check_pair(f"{kind} {label!r}", pair, graph)


def _check_pair(pointer: str, pair: Any, graph: Graph) -> None:
    try:
        x, y = (np.asarray(part, dtype=np.float64) for part in pair)
    except (TypeError, ValueError):
        raise InputError(pointer, "is not a pair of arrays of numbers; give (x, y)") from None
    if x.ndim != 1 or x.shape != y.shape or not len(x):
        raise InputError(pointer, f"has x of the shape {x.shape} and y of {y.shape}; give as many x as y, at least one")
    if not (np.isfinite(x).all() and np.isfinite(y).all()):
        raise InputError(pointer, "has a number that is not finite; give finite numbers")
    if (graph.x_log and (x <= 0).any()) or (graph.y_log and (y <= 0).any()):
        raise InputError(pointer, "has numbers that are not positive on a logarithmic axis; remove them")


def entries(graph: Graph) -> list[Entry]:
    """The legend; dots of a line's label have its colour and share its entry."""
    styles: dict[str, dict[str, Any]] = {}
    for label in graph.lines:
        styles[str(label)] = {"linewidth": 2.2}
    for label in graph.dots:
        styles.setdefault(str(label), {"linestyle": ""}).update(marker="o", markersize=7, markeredgecolor="white")
    for i, style in enumerate(styles.values()):
        style["color"] = LINES[i % len(LINES)]
    return [Entry(label, style) for label, style in styles.items()]


def paint(page: Page, box: Box, graph: Graph) -> None:
    """The axes of a graph within a box, labels included."""
    axes = page.axes(Box(box.x + 0.85, box.y + 0.62, box.width - 1.0, box.height - 0.72))
    styles = {entry.label: entry.style for entry in entries(graph)}
    for label, (x, y) in graph.lines.items():
        axes.plot(x, y, color=styles[str(label)]["color"], linewidth=2.2, zorder=3)
    for label, (x, y) in graph.dots.items():
        axes.plot(x, y, "o", color=styles[str(label)]["color"], markersize=7, markeredgecolor="white", zorder=4)
    if graph.x_log:
        axes.set_xscale("log")
    if graph.y_log:
        axes.set_yscale("log")
    axes.set_xlabel(graph.x_label, fontsize=SMALL, color=INK, parse_math=False)
    axes.set_ylabel(graph.y_label, fontsize=SMALL, color=INK, parse_math=False)
    axes.grid(color="#dfe4e8", linewidth=0.8)
    axes.set_axisbelow(True)
    axes.tick_params(labelsize=SMALL, colors=INK, length=4)
    axes.tick_params(which="minor", color=MUTED)
    for name, spine in axes.spines.items():
        spine.set_visible(name in ("left", "bottom"))
        spine.set_color(PALE)
