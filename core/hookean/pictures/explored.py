"""An exploration drawn: its goals against one another with the front of Pareto, and the best samples as thumbnails."""

from __future__ import annotations

import os

import numpy as np

from hookean.designing.exploring import Exploration
from hookean.errors import InputError
from hookean.pictures.chart import Graph
from hookean.pictures.sheet import Panel, sheet


def draw(found: Exploration, path: str | os.PathLike[str], *, title: str = "", most: int = 8) -> None:
    """Draw goals and at most so many samples of the front as a PNG file. Raises InputError if no sample is on it."""
    if not found.front:
        raise InputError("picture", "no sample is at rest within the constraints, so there is nothing to draw")
    panels: list[Panel | Graph] = [*graphs(found)]
    for number in chosen(found.front, most):
        result = found.result(number)
        goals = ", ".join(f"{v:.4g} {u}" for v, u in zip(found.values[number], found.units, strict=True))
        panels.append(Panel(result, result.scene, f"{number}: {goals}"))
    count = len(panels)
    sheet(panels, path, title=title, columns=min(3, count), size=(1600, 160 + 480 * -(-count // 3)))


def chosen(front: list[int], most: int) -> list[int]:
    """At most so many of the front, evenly along it, its ends among them."""
    places = np.unique(np.linspace(0, len(front) - 1, min(most, len(front))).round().astype(int))
    return [front[i] for i in places]


def graphs(found: Exploration) -> list[Graph]:
    """The first goal against each other one; of one goal its values by the first unknown."""
    heads = [f"{name} [{unit}]" for name, unit in zip(found.goals, found.units, strict=True)]
    right = np.isfinite(found.values).all(axis=1)
    if len(heads) == 1:
        pairs = [(found.points[:, 0], found.values[:, 0], found.names[0], heads[0])]
    else:
        pairs = [(found.values[:, 0], found.values[:, k], heads[0], heads[k]) for k in range(1, min(3, len(heads)))]
    return [
        Graph(
            f"{len(found.points)} samples", x_label, y_label,
            x_log=_wide(x[right]), y_log=_wide(y[right]),
            dots={"samples": (x[right], y[right]), "front": (x[found.front], y[found.front])},
        )
        for x, y, x_label, y_label in pairs
    ]  # fmt: skip


def _wide(values: np.ndarray) -> bool:
    """Whether values need a logarithmic axis."""
    return bool((values > 0.0).all() and values.max(initial=0.0) > 1000.0 * values.min(initial=np.inf))
