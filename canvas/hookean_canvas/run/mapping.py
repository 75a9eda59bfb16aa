"""The Graph Mapper: the curve that a person has drawn in it, as a function of numbers.

Grasshopper stores it in the chunk `LocalGraph`: in `Domain` x0, x1, y0 and y1 of both axes, and in `Graph` the id and
the name of the kind of curve, and its grips. A Bézier curve has four, cpx and cpy, the first and the last at the ends.
Older files may name the numbers in another way, so they are read by their letters x and y; where these do not give four
grips from one side to the other, the object is named as one that cannot run. Names and ids: public code that reads such
files, and that draws such a curve elsewhere.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from decimal import Decimal
from uuid import UUID

import numpy as np
from scipy.optimize import brentq

from hookean_canvas.archive import Chunk, Item
from hookean_canvas.run.graph import Node
from hookean_canvas.run.natives.shapes import Array

BEZIER = UUID("7026a6d2-9b94-4314-b6d3-6850eff942fe")
UNKNOWN = "the kind of its curve is not known; put its values on a panel instead"
_AXIS = re.compile(r"(?:(?P<x>.*?)[._ ]?(?P<end>[xy])|(?P<front>[xy])[._ ]?(?P<y>.*))", re.IGNORECASE)
_NEAR = 1e-6  # of the width; grips are stored with the precision of the screen


def mapper_of(node: Node) -> Callable[[float], float] | None:
    """What a Graph Mapper does with a number; None where its curve is of a kind that is not known."""
    held = node.container.chunk("LocalGraph")
    graph = held.chunk("Graph") if held is not None else None
    if held is None or graph is None:
        return None
    if graph.value("container_id") != BEZIER and graph.value("container_name") != "Bezier":
        return None
    grips = _grips([item for chunk in graph.walk() for item in chunk.items])
    (x0, x1), (y0, y1) = (_ends(held, axis) for axis in "XY")
    if grips is None or x0 == x1:
        return None

    def mapped(number: float) -> float:
        return y0 + (y1 - y0) * bezier_at(grips, (number - x0) / (x1 - x0))

    return mapped


def _ends(chunk: Chunk, axis: str) -> tuple[float, float]:
    """The domain of an axis; 0 to 1 where none is stored."""
    stored = {
        item.name.lower(): float(item.value)
        for held in (chunk, chunk.chunk("Domain"))
        for item in (held.items if held is not None else ())
        if isinstance(item.value, (int, float, Decimal)) and not isinstance(item.value, bool)
    }
    first, last = (f"{axis}{end}".lower() for end in (0, 1))
    return (stored[first], stored[last]) if first in stored and last in stored else (0.0, 1.0)


def _grips(items: list[Item]) -> Array | None:
    """The four grips (4, 2) of a Bézier curve from one side to the other; None where the numbers are no such grips."""
    found: dict[tuple[str, int], dict[int, float]] = {}
    for item in items:
        if isinstance(item.value, (tuple, list)) and len(item.value) >= 2:
            found[item.name.lower(), item.index] = {0: float(item.value[0]), 1: float(item.value[1])}
        elif isinstance(item.value, (float, Decimal)) and (match := _AXIS.fullmatch(item.name)):
            axis = (match["end"] or match["front"]).lower()
            key = ((match["x"] if match["end"] else match["y"]) or "").lower(), item.index
            found.setdefault(key, {})["xy".index(axis)] = float(item.value)
    if len(found) != 4 or any(len(one) != 2 for one in found.values()):
        return None
    grips = np.array([[found[key][0], found[key][1]] for key in sorted(found)])
    sound = np.isfinite(grips).all() and abs(grips[0, 0]) < _NEAR and abs(grips[3, 0] - 1.0) < _NEAR
    return grips if sound else None


def bezier_at(grips: Array, x: float) -> float:
    """The height at x of a cubic Bézier curve from x = 0 to x = 1; beyond its ends that of the end.

    Inner grips are between the ends, so that x grows along the curve.
    """
    ways = np.array([[1, 0, 0, 0], [-3, 3, 0, 0], [3, -6, 3, 0], [-1, 3, -3, 1]]) @ grips
    if x <= 0.0 or x >= 1.0:
        return float(grips[0 if x <= 0.0 else 3, 1])
    along = brentq(lambda t: float(np.polyval(ways[::-1, 0], t)) - x, 0.0, 1.0, xtol=1e-15, rtol=1e-14)
    return float(np.polyval(ways[::-1, 1], along))
