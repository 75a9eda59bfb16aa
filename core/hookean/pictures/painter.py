"""Drawing: one model projected to the plane of its picture and painted from back to front.

No 3D axes of a plotting library: a net of 100,000 springs takes seconds and equal models give equal bytes.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.pictures.page import Entry
from hookean.pictures.visible import Shape, Things
from hookean.values.colours import FLOOR, INK, LINES, LOAD, REACTION, SLACK, Scale, number

Floats = NDArray[np.float64]

MOST_ARROWS = 600
ARROWS = {"load": (LOAD, 0.06), "reaction": (REACTION, 0.1)}
"""Colour of arrows and the length of the longest as a part of the model's extent."""
DASHES = ((0, (6, 4)), (0, (2, 2.4)), (0, (9, 3, 2, 3)))
"""In widths of the line; a spring under a curve shows beside it and in its gaps."""


class Drawing:
    """A model seen by an eye; `reach` [length/force] is how long its arrows are drawn."""

    def __init__(self, things: Things, eye: Floats) -> None:
        self.things, self.eye = things, eye
        self.flat = things.body @ eye[:2].T
        self.extent = float(np.linalg.norm(np.ptp(self.flat, axis=0))) or 1.0
        self.given = {"load": _seen(things.loads), "reaction": _seen(things.reactions)}
        self.reach = {kind: self.reach_of(kind, self.extent, *self.most(kind)) for kind in ARROWS}

    def most(self, kind: str) -> tuple[float, int]:
        """The largest force of a kind of arrows, and how many there are."""
        vectors = self.given[kind][:, 1]
        return float(np.linalg.norm(vectors, axis=1).max(initial=0.0)), len(vectors)

    @staticmethod
    def reach_of(kind: str, extent: float, largest: float, count: int) -> float:
        """Length of an arrow for a unit of force; shorter where there are many."""
        few = float(min(1.0, (30.0 / max(count, 1)) ** 0.3))
        return extent * ARROWS[kind][1] * few / (largest or 1.0)

    def bounds(self) -> tuple[Floats, Floats]:
        """The two corners of all that is seen, arrows and floors included, with a margin."""
        seen = [self.flat, *(corners for corners, _ in self._floors())]
        for kind in ARROWS:
            arrows = self._arrows(kind)
            seen += [arrows[:, 0], arrows.sum(axis=1)]
        every = np.concatenate(seen)
        low, high = every.min(axis=0), every.max(axis=0)
        pad = 0.03 * max(float((high - low).max()), 1e-9 * self.extent) + (0.5 if np.allclose(low, high) else 0.0)
        return low - pad, high + pad

    def entries(self, unit: str) -> list[Entry]:
        """The legend of all that is drawn, its forces in `unit`."""
        found = [Entry("slack spring (no force)", {"color": SLACK, "linewidth": 2})] if self._slack.any() else []
        if len(self.things.held):
            found.append(Entry("anchor", {"color": INK, "marker": "s", "markersize": 8, "linestyle": ""}))
        for kind, (colour, _) in ARROWS.items():
            if len(self.given[kind]):
                style = {"color": colour, "marker": r"$\rightarrow$", "markersize": 17, "linestyle": ""}
                found.append(Entry(self._arrow_label(kind, unit), style))
        if self.things.shape.strokes:
            found.append(Entry("carried geometry", {"color": INK, "linewidth": 1.6}))
        found += [Entry(label, {"color": shade, "linewidth": 2.4}) for label, shade in self._shades().items()]
        return [*found, *(Entry(label, style) for label, style in self._styles().items())]

    def paint(self, axes: Any, scale: Scale, boldness: float, point: float) -> None:
        """Paint everything; lines are `boldness` times as thick as in a large picture, a `point` is so long there."""
        for corners, lines in self._floors():
            _paint_floor(axes, corners, lines)
        for i, (label, shade) in enumerate(self._shades().items()):
            order = 1.2 + 0.1 * i / len(self.things.frames)  # over the floor, under the model
            _paint_frame(axes, self.things.frames[label], self.eye, shade, order, boldness)
        _paint_body(axes, self.things, self.eye, scale, self._slack, boldness)
        for stroke in self.things.shape.strokes:
            axes.plot(*(stroke @ self.eye[:2].T).T, color=INK, linewidth=1.6 * boldness, zorder=3)
        for label, style in self._styles().items():
            axes.plot(*(self.things.curves[label] @ self.eye[:2].T).T, zorder=3.5, **style)
        _paint_points(axes, self.things, self.eye, boldness)
        for kind, (colour, _) in ARROWS.items():
            arrows = self._arrows(kind)
            if len(arrows):
                _paint_arrows(axes, arrows, colour, max(0.0032 * self.extent, 1.3 * point))

    @property
    def _slack(self) -> NDArray[np.bool_]:
        size = np.abs(self.things.forces)
        return np.asarray(size <= 1e-12 * size.max(initial=0.0))

    def _shades(self) -> dict[str, Any]:
        """Colours of the frames, the first one faintest."""
        count = len(self.things.frames)
        strength = [0.32 + 0.48 * i / max(count - 1, 1) for i in range(count)]
        shades = [tuple(1.0 - s * (1.0 - np.array([0.24, 0.38, 0.54]))) for s in strength]
        return dict(zip(self.things.frames, shades, strict=True))

    def _styles(self) -> dict[str, dict[str, Any]]:
        """Lines of the curves: dashed over a model, else solid; a curve of one point is a dot."""
        found: dict[str, dict[str, Any]] = {}
        alone = not len(self.things.shape.body)
        for i, (label, curve) in enumerate(self.things.curves.items()):
            found[label] = {"color": LINES[i % len(LINES)], "linewidth": 2.0 if alone else 1.4}
            if len(curve) == 1:
                found[label].update(marker="o", markersize=7.0, linestyle="", markeredgecolor="white")
            else:
                found[label].update(linestyle="-" if alone else DASHES[i % len(DASHES)])
        return found

    def _floors(self) -> Iterator[tuple[Floats, Floats]]:
        """Corners and grid lines, in the picture, of the parts of floors under the model."""
        for point, normal in self.things.floors:
            first = np.cross(normal, [0.0, 1.0, 0.0] if abs(normal[1]) < 0.9 else [1.0, 0.0, 0.0])
            first /= np.linalg.norm(first)
            axes = np.stack([first, np.cross(normal, first)])
            flat = (self.things.body - point) @ axes.T
            low, high = flat.min(axis=0) - 0.08 * self.extent, flat.max(axis=0) + 0.08 * self.extent
            at = [np.linspace(a, b, 11) for a, b in zip(low, high, strict=True)]
            ends = [[(s, low[1]), (s, high[1])] for s in at[0]] + [[(low[0], s), (high[0], s)] for s in at[1]]
            lines = (point + np.array(ends) @ axes) @ self.eye[:2].T
            yield lines[[0, 10]].reshape(-1, 2)[[0, 1, 3, 2]], lines

    def _arrows(self, kind: str) -> Floats:
        """Feet and vectors in the picture (k, 2, 2); thinned where there are many."""
        arrows = self.given[kind]
        arrows = arrows[:: max(-(-len(arrows) // MOST_ARROWS), 1)]
        vectors = arrows[:, 1] * self.reach[kind]
        # what pushes from outside ends at its particle, so that it does not cross the model
        foot = arrows[:, 0].copy()
        if kind == "reaction" and len(arrows):
            pushes = ((foot - self.things.shape.body.mean(axis=0)) * vectors).sum(axis=1) < 0
            foot[pushes] -= 1.15 * vectors[pushes]
        return np.stack([foot @ self.eye[:2].T, vectors @ self.eye[:2].T], axis=1)

    def _arrow_label(self, kind: str, unit: str) -> str:
        sizes = np.linalg.norm(self.given[kind][:, 1], axis=1)
        thinned = -(-len(sizes) // MOST_ARROWS)
        few = f", 1 of {thinned} drawn" if thinned > 1 else ""
        alike = number(sizes.min()) == number(sizes.max())
        return f"{kind}{' ' if alike else ', longest '}{number(sizes.max())} {unit}{few}"


def _seen(arrows: Floats) -> Floats:
    """Arrows without those that are too small to be seen."""
    size = np.linalg.norm(arrows[:, 1], axis=1)
    seen: Floats = arrows[size > 1e-3 * size.max(initial=0.0)]
    return seen


def _paint_floor(axes: Any, corners: Floats, lines: Floats) -> None:
    from matplotlib.collections import LineCollection

    axes.fill(*corners.T, facecolor=FLOOR, edgecolor="none", zorder=0)
    axes.add_collection(LineCollection(list(lines), colors="#cfd5db", linewidths=0.9, zorder=1), autolim=False)


def _paint_frame(axes: Any, shape: Shape, eye: Floats, shade: Any, zorder: float, boldness: float) -> None:
    """A shape in one colour, its faces as a pale film of it."""
    colour = np.array([*shade, 1.0])
    width = _width(len(shape.springs), boldness) * (0.75 if len(shape.springs) <= 60 else 0.45)
    film = np.append(1.0 - 0.22 * (1.0 - colour[:3]), 0.6)
    widths, edge = np.full(len(shape.springs), width), colour * [1, 1, 1, 0.5]
    _paint_shape(axes, shape, eye, colour[None], widths, film[None], edge, boldness, zorder)
    for stroke in shape.strokes:
        axes.plot(*(stroke @ eye[:2].T).T, color=shade, linewidth=1.6 * boldness, zorder=zorder)
    if not len(shape.springs) and not len(shape.faces) and not shape.strokes:
        axes.scatter(*(shape.points @ eye[:2].T).T, s=30.0 * boldness, color=[shade], linewidths=0, zorder=zorder)


def _width(springs: int, boldness: float) -> float:
    """Thickness of springs in points: thin where there are many."""
    return float(np.clip(90.0 * boldness / np.sqrt(springs + 1.0), 0.45, 4.5 * boldness))


def _edge_width(faces: int, boldness: float) -> float:
    return float(np.clip(16.0 * boldness / np.sqrt(faces + 1.0), 0.12, 0.8))


def _paint_body(
    axes: Any, things: Things, eye: Floats, scale: Scale, slack: NDArray[np.bool_], boldness: float
) -> None:
    """Springs in the colours of their forces, faces lit."""
    from matplotlib.colors import to_rgba

    colours = scale.colours(things.forces)
    colours[slack] = to_rgba(SLACK)
    width = _width(len(slack), boldness)
    widths = np.where(slack, max(0.7 * width, 1.2 * boldness), width)
    light = _light(things.shape.faces, eye)
    _paint_shape(axes, things.shape, eye, colours, widths, light, np.array(to_rgba("#4d6275", 0.75)), boldness, 2.0)


def _paint_shape(
    axes: Any, shape: Shape, eye: Floats, colours: Floats, widths: Floats, fill: Floats, thin: Floats,
    boldness: float, zorder: float,
) -> None:  # fmt: skip
    """Faces (m) of the colours `fill` and edges `thin`, and springs (k) of `colours` and `widths`, in one pass from
    back to front; (1, 4) colours are for all."""
    from matplotlib.collections import PolyCollection

    lines = shape.points[shape.springs]
    count = len(shape.faces)
    # springs on the edges of faces lie on top of them: the faces step back by a part of their size
    reach = np.linalg.norm(np.ptp(shape.faces, axis=1), axis=1).mean() if count else 0.0
    depth = np.concatenate([(shape.faces @ eye[2]).mean(axis=1) - 0.6 * reach, (lines @ eye[2]).mean(axis=1)])
    faces = np.concatenate([shape.faces, shape.faces[:, :1]], axis=1) @ eye[:2].T
    order = np.argsort(depth, kind="stable")
    shapes = [*faces, *(lines @ eye[:2].T)]
    inside = np.concatenate([np.broadcast_to(fill, (count, 4)), np.zeros((len(lines), 4))])
    outline = np.concatenate([shape.edged[:, None] * thin, np.broadcast_to(colours, (len(lines), 4))])
    thickness = np.concatenate([shape.edged * _edge_width(count, boldness), widths])
    antialiased = np.concatenate([shape.edged, np.ones(len(lines), bool)])
    drawn = PolyCollection(
        [shapes[i] for i in order], closed=False, facecolors=inside[order], edgecolors=outline[order],
        antialiaseds=antialiased[order], capstyle="round", zorder=zorder,
    )  # fmt: skip
    drawn.set_linewidth(thickness[order].tolist())  # afterwards: it is gone through once then, not twice
    axes.add_collection(drawn, autolim=False)


def _light(faces: Floats, eye: Floats) -> Floats:
    """Colours of faces: lit from above the eye's left shoulder, both sides alike, translucent."""
    normal = np.cross(faces[:, 2] - faces[:, 0], faces[:, 3] - faces[:, 1])
    triangle = (faces[:, 3] == faces[:, 2]).all(axis=1)
    normal[triangle] = np.cross(faces[triangle, 1] - faces[triangle, 0], faces[triangle, 2] - faces[triangle, 0])
    length = np.linalg.norm(normal, axis=1)
    normal /= np.where(length > 0, length, 1.0)[:, None]
    lamp = np.array([-0.45, 0.65, 0.62]) @ eye
    towards = np.where((normal @ eye[2]) < 0, -1.0, 1.0)
    shine = 0.62 + 0.38 * np.clip((normal @ lamp) * towards, 0.0, 1.0)
    colour = np.array([0.79, 0.88, 0.96])[None] * shine[:, None]
    return np.column_stack([colour, np.full(len(faces), 0.84)])


def _paint_points(axes: Any, things: Things, eye: Floats, boldness: float) -> None:
    """Held particles, and free ones where nothing else shows them."""
    shape = things.shape
    if not len(shape.springs) and not len(shape.faces) or len(shape.points) <= 60:
        area = (26.0 * min(1.0, 15.0 / len(shape.points)) if len(shape.points) > 3 else 90.0) * boldness**2
        axes.scatter(*(shape.points @ eye[:2].T).T, s=area, color="white", edgecolors=INK,
                     linewidths=1.2 * boldness, zorder=4)  # fmt: skip
    if len(things.held):
        area = float(np.clip(4000.0 / len(things.held), 14.0, 150.0)) * boldness**2
        axes.scatter(*(things.held @ eye[:2].T).T, s=area, marker="s", color=INK, edgecolors="white",
                     linewidths=0.8 * boldness, zorder=6)  # fmt: skip


def _paint_arrows(axes: Any, arrows: Floats, colour: str, width: float) -> None:
    many = len(arrows) > 60  # then they go behind the model, so that it stays legible
    width *= float(np.clip((30.0 / len(arrows)) ** 0.4, 0.3, 1.0))
    axes.quiver(
        *arrows[:, 0].T, *arrows[:, 1].T, angles="xy", scale_units="xy", scale=1.0, units="xy", width=width,
        headwidth=4.2, headlength=5.0, headaxislength=4.6, minlength=0.0, color=colour, zorder=1.5 if many else 5.0,
    )  # fmt: skip
