"""A picture of a definition as its canvas looks: boxes, groups and wires where the file says they stand."""

from __future__ import annotations

import textwrap
from pathlib import Path
from typing import Any
from uuid import UUID

import numpy as np

from hookean_canvas.graph import Graph, Node
from hookean_canvas.guids import BOOLEAN_TOGGLE, NUMBER_SLIDER, PANEL

SCALE = 96.0  # pixels of the canvas to an inch, as on a screen


def draw(graph: Graph, path: Path) -> None:
    """Write a PNG. Objects without bounds are left out."""
    from matplotlib.figure import Figure

    shown = [node for node in graph.nodes if node.bounds is not None]
    boxes = np.array([node.bounds for node in shown])
    low, high = boxes[:, :2].min(axis=0) - 50.0, (boxes[:, :2] + boxes[:, 2:]).max(axis=0) + 50.0
    figure = Figure(figsize=tuple((high - low) / SCALE), facecolor=(0.83, 0.82, 0.78))
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set_xlim(low[0], high[0])
    axes.set_ylim(high[1], low[1])
    axes.axis("off")
    places = {node.id: node for node in shown}
    for group in graph.groups:
        _group(axes, group.title, group.colour, [places[key] for key in group.members if key in places])
    for start, out, end, given in graph.wires():
        _wire(axes, _place(start, out.id, right=True), _place(end, given.id, right=False), 0.15 if given.faint else 1.0)
    for node in shown:
        _node(axes, node)
    figure.savefig(path, dpi=SCALE, metadata={"Software": None})


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


def _group(axes: Any, title: str, colour: tuple[int, int, int, int], members: list[Node]) -> None:
    from matplotlib.patches import Rectangle

    boxes = np.array([node.bounds for node in members])
    low, high = boxes[:, :2].min(axis=0) - 12.0, (boxes[:, :2] + boxes[:, 2:]).max(axis=0) + 12.0
    alpha, *rgb = (value / 255.0 for value in colour)
    axes.add_patch(Rectangle(low, *(high - low), color=rgb, alpha=alpha, zorder=1))
    axes.text(low[0] + 4.0, low[1] - 6.0, title, fontsize=13, weight="bold", zorder=1)


def _node(axes: Any, node: Node) -> None:
    from matplotlib.patches import Rectangle

    assert node.bounds is not None
    x, y, width, height = node.bounds
    panel = node.guid == PANEL
    colour = (1.0, 0.98, 0.7) if panel else (0.93, 0.93, 0.93) if node.floating else (0.8, 0.85, 0.85)
    axes.add_patch(Rectangle((x, y), width, height, facecolor=colour, edgecolor="black", linewidth=0.8, zorder=3))
    words: dict[str, Any] = {"zorder": 4, "va": "center", "fontsize": 7}
    if panel:
        text = str(node.container.value("UserText", default="")) if not node.inputs[0].sources else ""
        body = "\n".join(line for part in text.split("\n") for line in textwrap.wrap(part, 62) or [""])
        label = f"{node.nickname}\n{body}" if node.nickname and node.nickname != "Panel" else body
        axes.text(x + 6.0, y + 0.5 * height, label, ha="left", **words)
    elif node.floating:
        axes.text(x + 6.0, y + 0.5 * height, f"{node.label}{_value(node)}", ha="left", **words)
    else:
        for ports, at, side in ((node.inputs, x + 4.0, "left"), (node.outputs, x + width - 4.0, "right")):
            for i, port in enumerate(ports):
                row = y + 2.0 + (i + 0.5) * (height - 4.0) / len(ports)
                axes.text(at, row, port.nickname + " ↓↑"[port.mapping].strip(), ha=side, **words)
        axes.text(x + 0.5 * width, y - 7.0, node.label, ha="center", weight="bold", **words)


def _value(node: Node) -> str:
    if node.guid == NUMBER_SLIDER:
        slider = node.container.chunk("Slider")
        return "" if slider is None else f"   ◇ {slider.value('Value', default=0.0):g}"
    if node.guid == BOOLEAN_TOGGLE:
        return f"   [{node.container.value('ToggleValue', default=False)}]"
    return ""
