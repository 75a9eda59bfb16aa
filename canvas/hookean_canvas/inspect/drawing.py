"""A picture of a definition as its canvas looks: boxes, groups and wires where the file says they stand."""

from __future__ import annotations

import math
import textwrap
import warnings
from collections.abc import Iterable
from pathlib import Path
from typing import Any
from uuid import UUID

import numpy as np

from hookean.errors import InputError
from hookean_canvas.archive.guids import BOOLEAN_TOGGLE, NUMBER_SLIDER, PANEL
from hookean_canvas.archive.parts import Rectangle, given
from hookean_canvas.run.graph import Graph, Group, Node

SCALE = 96.0  # pixels of the canvas to an inch, as on a screen
WIDEST, MOST = 30_000.0, 60e6  # pixels of a picture: along a side, and in all
LINE = 11.0  # height of a line of text, in pixels of the canvas
LEGIBLE = 0.1  # of the size on the canvas; a smaller picture has no words


def draw(graph: Graph, path: Path) -> list[str]:
    """Write a PNG; returns the labels of the objects without bounds, which are left out.

    A canvas larger than a picture can be is drawn smaller.

    InputError where no object has bounds, or the picture cannot be written.
    """
    from matplotlib.figure import Figure

    if path.suffix.lower() != ".png":
        raise InputError(str(path), f"ends in {path.suffix!r}; give a name that ends in .png")
    shown = [node for node in graph.nodes if node.bounds is not None]
    if not shown:
        raise InputError(
            str(graph.file or graph.name), "none of its objects has a place on the canvas, so no picture was drawn"
        )
    left, top, right, bottom = _around(shown, 50.0)
    size = np.array([right - left, bottom - top])
    factor = min(1.0, WIDEST / float(size.max()), math.sqrt(MOST / float(size.prod())))
    figure = Figure(figsize=tuple(size / SCALE), facecolor=(0.83, 0.82, 0.78))
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set_xlim(left, right)
    axes.set_ylim(bottom, top)
    axes.axis("off")
    _fill(axes, graph, shown, factor >= LEGIBLE)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # about letters that matplotlib's font lacks; it draws a box for each
            figure.savefig(path, format="png", dpi=SCALE * factor, metadata={"Software": None})
    except OSError as error:
        raise InputError(str(path), f"cannot be written: {error.strerror or error}") from None
    return [node.label for node in graph.nodes if node.bounds is None]


def _fill(axes: Any, graph: Graph, shown: list[Node], words: bool) -> None:
    places = {node.id: node for node in shown}
    groups = {group.id: group for group in graph.groups}
    for group in graph.groups:
        members = [places[key] for key in _members(group, groups) if key in places]
        if members:
            _group(axes, group, members, words)
    for start, out, end, into in graph.wires():
        if start.bounds is not None and end.bounds is not None:
            faint = 0.15 if into.faint else 1.0
            _wire(axes, _place(start, out.id, right=True), _place(end, into.id, right=False), faint)
    for node in shown:
        _node(axes, node, words)


def _members(group: Group, groups: dict[UUID, Group]) -> list[UUID]:
    """The objects in a group and in the groups within it, each once; a group within itself ends there."""
    found: dict[UUID, None] = {}
    waiting, seen = list(group.members), {group.id}
    while waiting:
        key = waiting.pop()
        if key not in groups:
            found[key] = None
        elif key not in seen:
            seen.add(key)
            waiting += groups[key].members
    return list(found)


def _around(nodes: Iterable[Node], margin: float) -> Rectangle:
    """Left, top, right and bottom of a frame at this distance around objects."""
    boxes = np.array([node.bounds for node in nodes])
    low, high = boxes[:, :2].min(axis=0) - margin, (boxes[:, :2] + boxes[:, 2:]).max(axis=0) + margin
    return float(low[0]), float(low[1]), float(high[0]), float(high[1])


def _place(node: Node, port: UUID, right: bool) -> tuple[float, float]:
    """Where a wire meets an object."""
    assert node.bounds is not None
    x, y, width, height = node.bounds
    ports = [p.id for p in (node.outputs if right else node.inputs)]
    row = (ports.index(port) + 0.5) / len(ports)
    return (x + width if right else x), y + 2.0 + row * (height - 4.0)


def _wire(axes: Any, start: tuple[float, float], end: tuple[float, float], alpha: float) -> None:
    reach = max(0.5 * abs(end[0] - start[0]), 20.0)
    t = np.linspace(0.0, 1.0, 40)[:, None]
    control = np.array([start, (start[0] + reach, start[1]), (end[0] - reach, end[1]), end])
    weights = np.hstack([(1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3])
    axes.plot(*(weights @ control).T, color=(0.2, 0.2, 0.2), linewidth=1.2, alpha=alpha, zorder=2)


def _group(axes: Any, group: Group, members: list[Node], words: bool) -> None:
    from matplotlib.patches import Rectangle

    left, top, right, bottom = _around(members, 12.0)
    alpha, *rgb = (value / 255.0 for value in group.colour)
    axes.add_patch(Rectangle((left, top), right - left, bottom - top, color=rgb, alpha=alpha, zorder=1))
    if words:
        _text(axes, left + 4.0, top - 6.0, group.title, fontsize=13, weight="bold", zorder=1)


def _node(axes: Any, node: Node, words: bool) -> None:
    from matplotlib.patches import Rectangle

    assert node.bounds is not None
    x, y, width, height = node.bounds
    panel = node.guid == PANEL
    colour = (1.0, 0.98, 0.7) if panel else (0.93, 0.93, 0.93) if node.floating else (0.8, 0.85, 0.85)
    axes.add_patch(Rectangle((x, y), width, height, facecolor=colour, edgecolor="black", linewidth=0.8, zorder=3))
    if not words:
        return
    small: dict[str, Any] = {"zorder": 4, "va": "center", "fontsize": 7}
    if panel and node.floating:
        _text(axes, x + 6.0, y + 0.5 * height, _note(node, height), ha="left", **small)
    elif node.floating:
        _text(axes, x + 6.0, y + 0.5 * height, f"{node.label}{_value(node)}", ha="left", **small)
    else:
        for ports, at, side in ((node.inputs, x + 4.0, "left"), (node.outputs, x + width - 4.0, "right")):
            for i, port in enumerate(ports):
                row = y + 2.0 + (i + 0.5) * (height - 4.0) / len(ports)
                _text(axes, at, row, port.nickname + " ↓↑"[port.mapping].strip(), ha=side, **small)
        _text(axes, x + 0.5 * width, y - 7.0, node.label, ha="center", weight="bold", **small)


def _text(axes: Any, x: float, y: float, text: str, **style: Any) -> None:
    """Text as it stands: no formula between dollar signs, no control characters."""
    plain = "".join(letter if letter.isprintable() or letter == "\n" else " " for letter in text)
    axes.text(x, y, plain, parse_math=False, **style)


def _note(node: Node, height: float) -> str:
    """The words on a panel, as many lines as it has room for."""
    text = given(node.container, "UserText", "") if not node.inputs[0].sources else ""
    room = max(1, int(height / LINE))
    head = [node.nickname] if node.nickname and node.nickname != "Panel" else []
    body = [line for part in text.split("\n")[:room] for line in textwrap.wrap(part[: 62 * room], 62) or [""]]
    return "\n".join(head + body[:room])


def _value(node: Node) -> str:
    if node.guid == NUMBER_SLIDER:
        slider = node.container.chunk("Slider")
        return "" if slider is None else f"   ◇ {given(slider, 'Value', 0.0):g}"
    if node.guid == BOOLEAN_TOGGLE:
        return f"   [{given(node.container, 'ToggleValue', False)}]"
    return ""
