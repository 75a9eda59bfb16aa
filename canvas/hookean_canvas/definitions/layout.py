"""Where boxes stand on a canvas: left to right in columns by their depth, groups as blocks, few crossings.

A layered drawing: columns by longest path (sources stand next to what they feed), boxes in a column ordered by the
barycentre of their neighbours, then moved towards them without overlaps [Sugiyama, Tagawa and Toda 1981].
"""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

ACROSS, DOWN = 70.0, 14.0
"""Room between columns and between boxes of a column, in pixels of the canvas."""
_IN, _OUT, _WAY = object(), object(), object()
STIFF = 20.0
"""How much more a wire wants to be straight than a box wants to be level with its neighbours."""
MARGIN, TITLE = 24.0, 34.0
"""Room between a group's boxes and the next block, and for its title."""


@dataclass
class Box:
    """A rectangle to place: its size in, its upper left corner out."""

    width: float
    height: float
    x: float = 0.0
    y: float = 0.0


@dataclass(frozen=True)
class Link:
    """A wire between boxes, with the heights at which it leaves and enters them."""

    start: Hashable
    end: Hashable
    leaves: float
    enters: float


Boxes = dict[Hashable, Box]
Wires = dict[Hashable, list[tuple[Link, bool]]]
"""The wires of each box, with whether it is at their end."""


def arrange(
    boxes: Boxes, links: Sequence[Link], blocks: Sequence[Sequence[Hashable]], heads: Sequence[tuple[float, float]] = ()
) -> None:
    """Place all boxes; those of a block stand together, and no two blocks or boxes overlap.

    `heads` are widths and heights to leave free over the boxes of each block. Raises ValueError where
    wires run in a circle, also where they do so between blocks.
    """
    inside: dict[Hashable, int] = {key: i for i, block in enumerate(blocks) for key in block}
    loose = [[key] for key in boxes if key not in inside]
    parts = [list(block) for block in blocks] + loose
    number = {key: i for i, part in enumerate(parts) for key in part}
    for _ in range(3):  # boxes in a block follow where the other blocks stand, and the blocks follow them
        frames: Boxes = {}
        for i, part in enumerate(parts):
            frames[i] = _block(part, boxes, links, heads[i] if i < len(heads) else (0.0, 0.0), titled=i < len(blocks))
        outer = [
            Link(number[link.start], number[link.end], *_heights(link, boxes, frames, number))
            for link in links
            if number[link.start] != number[link.end]
        ]
        _layered(frames, outer, 2.0 * ACROSS, 2.0 * MARGIN, {})
        for key, box in boxes.items():
            frame = frames[number[key]]
            box.x += frame.x
            box.y += frame.y


def _heights(link: Link, boxes: Boxes, frames: Boxes, number: dict[Hashable, int]) -> tuple[float, float]:
    return boxes[link.start].y + link.leaves, boxes[link.end].y + link.enters


def _block(
    part: Sequence[Hashable], boxes: Boxes, links: Sequence[Link], head: tuple[float, float], titled: bool
) -> Box:
    """Places the boxes of a block from (0, 0) on; the size of the block."""
    own = {key: boxes[key] for key in part}
    within = [link for link in links if link.start in own and link.end in own]
    gates: Boxes = {}  # where wires from and to other blocks come through this one's sides
    pulls: dict[Hashable, list[float]] = {}
    for link in links:
        if link.end in own and link.start not in own:
            gate = (_IN, link.start, link.leaves)
            within.append(Link(gate, link.end, 1.0, link.enters))
        elif link.start in own and link.end not in own:
            gate = (_OUT, link.end, link.enters)
            within.append(Link(link.start, gate, link.leaves, 1.0))
        else:
            continue
        height = boxes[gate[1]].y + gate[2]
        gates[gate], pulls[gate] = Box(0.0, 2.0, 0.0, height), [height]
    _layered({**own, **gates}, within, ACROSS, DOWN, pulls)
    _close(own, MARGIN)
    edge = MARGIN if titled else 0.0
    left, top = min(box.x for box in own.values()) - edge, min(box.y for box in own.values())
    top -= edge + (TITLE if titled else 0.0) + head[1]
    for box in own.values():
        box.x -= left
        box.y -= top
    width = max(*(box.x + box.width for box in own.values()), edge + head[0]) + edge
    return Box(width, max(box.y + box.height for box in own.values()) + edge)


def _close(boxes: Boxes, room: float) -> None:
    """Take out bands that are empty across all boxes, as far as they are higher than `room`."""
    shift, bottom = 0.0, None
    for box in sorted(boxes.values(), key=lambda box: box.y):
        if bottom is not None and box.y > bottom + room:
            shift += box.y - bottom - room
        bottom = max(box.y + box.height, box.y if bottom is None else bottom)
        box.y -= shift


def _layered(
    boxes: Boxes, links: Sequence[Link], across: float, down: float, pulls: dict[Hashable, list[float]]
) -> None:
    columns = _columns(boxes, links)
    boxes, links = _ways(columns, boxes, links)
    feeding = {link.start for link in links}
    wires: Wires = {}  # of each box, in the order of the links
    for link in links:
        wires.setdefault(link.end, []).append((link, True))
        wires.setdefault(link.start, []).append((link, False))
    below = _own_matters(boxes, links)
    x = 0.0
    for column in columns:
        width = max(boxes[key].width for key in column)
        for key in column:
            boxes[key].x = x + (width - boxes[key].width if key in feeding else 0.0)  # outputs in one line
        x += width + across
    for column in columns:
        _stack(column, boxes, {key: boxes[key].y for key in column}, down)
    best = (1_000_000, columns)
    for sweep in range(10):
        backward = sweep % 2 == 1
        for column in columns[::-1] if backward else columns:
            wanted = {key: _wanted(key, boxes, wires, pulls, (not backward, backward)) for key in column}
            column.sort(key=lambda key: (key in below, wanted[key] + 0.5 * boxes[key].height))
            _stack(column, boxes, wanted, down)
        count = crossings(boxes, links)
        if count < best[0]:
            best = (count, [list(column) for column in columns])
    for sweep in range(8):
        for column in best[1][::-1] if sweep % 2 else best[1]:
            # other blocks have a say in the order only, so that a block stays together
            _stack(column, boxes, {key: _wanted(key, boxes, wires, {}, (True, True)) for key in column}, down)


def _own_matters(boxes: Boxes, links: Sequence[Link]) -> set[Hashable]:
    """Boxes of a block that nothing from other blocks reaches, where something does: settings, loads; they go below."""
    reached: set[Hashable] = {key for key in boxes if isinstance(key, tuple) and key and key[0] is _IN}
    if not reached:
        return set()
    for _ in boxes:
        reached |= {link.end for link in links if link.start in reached}
    return {key for key in boxes if key not in reached}


def _columns(boxes: Boxes, links: Sequence[Link]) -> list[list[Hashable]]:
    """Boxes by depth; one without inputs stands in the column before the first that it feeds, gates at the sides."""
    side = {key: key[0] for key in boxes if isinstance(key, tuple) and key[0] in (_IN, _OUT)}
    gated, links = boxes, [link for link in links if link.start not in side and link.end not in side]
    boxes = {key: box for key, box in boxes.items() if key not in side}
    depth = dict.fromkeys(boxes, 0)
    for round_ in range(len(boxes) + 1):
        changed = False
        for link in links:
            if depth[link.end] < depth[link.start] + 1:
                depth[link.end] = depth[link.start] + 1
                changed = True
        if not changed:
            break
        if round_ == len(boxes):
            raise ValueError("wires run in a circle")
    fed = {link.end for link in links}
    for key in boxes:
        after = [depth[link.end] for link in links if link.start == key]
        if key not in fed and after:
            depth[key] = min(after) - 1
    columns: list[list[Hashable]] = [[] for _ in range(max(depth.values()) + 3)]
    for key in gated:
        columns[{_IN: 0, _OUT: -1}[side[key]] if key in side else depth[key] + 1].append(key)
    return [column for column in columns if column]


def _ways(columns: list[list[Hashable]], boxes: Boxes, links: Sequence[Link]) -> tuple[Boxes, list[Link]]:
    """Room for wires through the columns between their ends: a thin box in each, added to `columns`."""
    column_of = {key: i for i, column in enumerate(columns) for key in column}
    boxes, found = dict(boxes), []
    for link in links:
        before, leaves = link.start, link.leaves
        for i in range(column_of[link.start] + 1, column_of[link.end]):
            way = (_WAY, link.start, link.end, i)
            if way not in boxes:
                boxes[way] = Box(0.0, 2.0, 0.0, boxes[link.start].y)
                columns[i].append(way)
            found.append(Link(before, way, leaves, 1.0))
            before, leaves = way, 1.0
        found.append(Link(before, link.end, leaves, link.enters))
    return boxes, found


def _wanted(
    key: Hashable, boxes: Boxes, wires: Wires, pulls: dict[Hashable, list[float]], sides: tuple[bool, bool]
) -> float:
    """The y at which the wires of a box, those on its left, its right or both, would be level, on average."""
    found = list(pulls.get(key, ()))
    for link, at_end in wires.get(key, ()):
        if at_end and sides[0]:
            found.append(boxes[link.start].y + link.leaves - link.enters)
        elif not at_end and sides[1]:
            found.append(boxes[link.end].y + link.enters - link.leaves)
    return sum(found) / len(found) if found else boxes[key].y


def _stack(column: Sequence[Hashable], boxes: Boxes, wanted: dict[Hashable, float], down: float) -> None:
    """Boxes in this order as near as can be to where they want to be: means of runs that would overlap."""
    runs: list[tuple[float, float, float, list[Hashable]]] = []  # mean wish of the top, weight, height, boxes
    for key in column:
        runs.append((wanted[key], STIFF if _is_way(key) else 1.0, boxes[key].height + down, [key]))
        while len(runs) > 1 and runs[-2][0] + runs[-2][2] > runs[-1][0]:
            top, weight, height, keys = runs.pop()
            above = runs.pop()
            mean = (above[0] * above[1] + (top - above[2]) * weight) / (above[1] + weight)
            runs.append((mean, above[1] + weight, above[2] + height, above[3] + keys))
    for top, _, _, keys in runs:
        for key in keys:
            boxes[key].y = top
            top += boxes[key].height + down


def _is_way(key: Hashable) -> bool:
    return isinstance(key, tuple) and bool(key) and key[0] in (_IN, _OUT, _WAY)


def crossings(boxes: Boxes, links: Sequence[Link]) -> int:
    """Pairs of wires that cross, taken as straight lines between boxes: a measure for tests and for looking."""
    lines = [
        (
            boxes[link.start].x + boxes[link.start].width, boxes[link.start].y + link.leaves,
            boxes[link.end].x, boxes[link.end].y + link.enters,
        )
        for link in links
    ]  # fmt: skip
    if not lines:
        return 0
    x1, y1, x2, y2 = np.array(lines).T

    def side(x: Any, y: Any) -> Any:
        """On which side of each line (rows) each point (columns) is."""
        return (x2 - x1)[:, None] * (y - y1[:, None]) - (y2 - y1)[:, None] * (x - x1[:, None])

    apart = side(x1, y1) * side(x2, y2) < -1e-9
    return int((apart & apart.T).sum()) // 2
