"""Makes room on a canvas for components that become larger: what is below or beside them moves on.

Two objects that do not overlap before do not overlap after it: all that starts below a line moves down by the same
distance, and all that starts right of a line moves right.
"""

from __future__ import annotations

from collections.abc import Mapping

from hookean_canvas.archive import Chunk, Item, Type
from hookean_canvas.archive.parts import Rectangle, bounds_of, parts
from hookean_canvas.kangaroo.space import GAP

SLACK = 6.0
"""So far two objects may overlap by the hand of the person who placed them, in pixels."""
_PLACES = {"Bounds", "Pivot", "Ca", "Cb", "Cc", "Cd"}
"""Items of places: of attributes, and the corners of a scribble."""
_TYPES = (Type.DRAWING_POINT, Type.DRAWING_POINTF, Type.DRAWING_RECTANGLE, Type.DRAWING_RECTANGLEF)


def make_room(root: Chunk, larger: Mapping[int, tuple[float, float]]) -> int:
    """Move objects so that those in `larger` may have these widths and heights; how many were moved.

    `larger`: sizes by the ids (`id(...)`) of containers.
    """
    containers = [part.container for part in parts(root) if part.container is not None]
    boxes = {id(one): box for one in containers if (box := bounds_of(one))}
    start = dict(boxes)
    for key in sorted(set(larger) & set(boxes), key=lambda key: (boxes[key][1], boxes[key][0])):
        for axis in (1, 0):
            _open(boxes, key, larger[key], axis)
        x, y, *_ = boxes[key]
        boxes[key] = (x, y, *larger[key])
    moved = 0
    for one in containers:
        before, after = start.get(id(one)), boxes.get(id(one))
        if before and after and before[:2] != after[:2]:
            move(one, after[0] - before[0], after[1] - before[1])
            moved += 1
    return moved


def _open(boxes: dict[int, Rectangle], key: int, size: tuple[float, float], axis: int) -> None:
    """Move all that starts beyond a box along an axis (0: to the right, 1: down) until a larger box has room."""
    own, other = boxes[key], 1 - axis
    line = own[axis] + max(own[axis + 2] - SLACK, 0.0)
    beyond = [one for one, box in boxes.items() if one != key and box[axis] >= line]
    met = [
        boxes[one][axis]
        for one in beyond
        if boxes[one][other] < own[other] + size[other] and own[other] < boxes[one][other] + boxes[one][other + 2]
    ]
    far = own[axis] + size[axis] + GAP - min(met, default=float("inf"))
    if far > 0.0:
        for one in beyond:
            x, y, width, height = boxes[one]
            boxes[one] = (x + far, y, width, height) if axis == 0 else (x, y + far, width, height)


def move(container: Chunk, right: float, down: float) -> None:
    """Move an object with its inputs and outputs; a definition within it stays as it is."""
    for chunk in container.walk():
        for item in chunk.items:
            if item.name in _PLACES and item.type in _TYPES:
                _shift(item, right, down)


def _shift(item: Item, right: float, down: float) -> None:
    whole = item.type in (Type.DRAWING_POINT, Type.DRAWING_RECTANGLE)
    x, y, *size = item.value
    at = (x + right, y + down)
    item.value = (*(map(round, at) if whole else at), *size)
