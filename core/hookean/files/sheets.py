"""Sheets: cutting patterns side by side, as .3dm, DXF or SVG with the same layers."""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from xml.sax.saxutils import escape

import numpy as np
from numpy.typing import NDArray

from hookean.atomic_write import put
from hookean.errors import InputError
from hookean.workshop.patterns import Patterns, Strip

Floats = NDArray[np.float64]

LAYERS = {"cut": 1, "seam": 5, "marks": 3, "warp": 8, "labels": 7}
"""Layers, and their colours as AutoCAD numbers them."""
COLOURS = {"cut": "#d00000", "seam": "#0000d0", "marks": "#008000", "warp": "#808080", "labels": "#000000"}
ENDINGS = (".3dm", ".dxf", ".svg")
GAP = 0.1  # between strips, of the widest


@dataclass(frozen=True)
class Line:
    """A polyline (k, 2) [length] on a layer; `name` is that of its strip or mark."""

    layer: str
    points: Floats
    closed: bool
    name: str


@dataclass(frozen=True)
class Label:
    """A text that begins at a point (2,) [length], of a height [length]."""

    text: str
    point: Floats
    height: float
    layer: str = "labels"


def write_sheets(patterns: Patterns, path: str | os.PathLike[str]) -> None:
    """Write strips side by side to a .3dm, .dxf or .svg file, in the unit of length of the patterns.

    Layers: cut (outlines with allowances), seam, marks (ticks across the seam, with the name that the other strip has,
    too), warp (an arrow along the warp), labels. Raises InputError for another ending, or where the file cannot be
    written.
    """
    target = Path(path)
    ending = target.suffix.lower()
    if ending not in ENDINGS:
        raise InputError(target.name or str(path), f"has an unknown ending; end the name in {', '.join(ENDINGS)}")
    lines, labels = drawing(patterns)
    unit = str(patterns.units.length)
    {".3dm": _threedm, ".dxf": _dxf, ".svg": _svg}[ending](target, unit, lines, labels)


def drawing(patterns: Patterns) -> tuple[list[Line], list[Label]]:
    """All lines and texts of the sheets, strips one above another."""
    lines, labels, top = list[Line](), list[Label](), 0.0
    gap = GAP * max(strip.size[1] for strip in patterns.strips)
    height = 0.2 * min(strip.size[1] for strip in patterns.strips)
    for strip in patterns.strips:
        shift = np.array([0.0, top]) - strip.cut.min(axis=0)
        lines += _lines(strip, shift, height)
        middle = strip.points.mean(axis=0) + shift
        labels.append(Label(strip.name, middle + [0.0, 0.3 * height], height))
        labels += [Label(m.name, m.point + shift - 0.6 * height * m.way, 0.25 * height, "marks") for m in strip.marks]
        top += strip.size[1] + gap
    return lines, labels


def _lines(strip: Strip, shift: Floats, height: float) -> Iterator[Line]:
    yield Line("cut", strip.cut + shift, True, strip.name)
    yield Line("seam", strip.points[strip.seam] + shift, True, strip.name)
    for mark in strip.marks:
        inner = mark.point + shift
        yield Line("marks", np.array([inner - 0.3 * height * mark.way, inner]), False, mark.name)
    middle, long = strip.points.mean(axis=0) + shift, 0.2 * strip.size[0]
    tip = middle + [long, 0.0]
    barb = 0.25 * height
    arrow = [middle - [long, 0.0], tip, tip - [barb, barb], tip, tip - [barb, -barb]]
    yield Line("warp", np.array(arrow), False, strip.name)


def _dxf(target: Path, unit: str, lines: list[Line], labels: list[Label]) -> None:
    from hookean.files import dxf

    made = dxf.document(target.name, unit, LAYERS)
    space = made.modelspace()
    for line in lines:
        space.add_lwpolyline(line.points.tolist(), close=line.closed, dxfattribs={"layer": line.layer})
    for label in labels:
        text = space.add_text(label.text, height=label.height, dxfattribs={"layer": label.layer})
        text.set_placement(tuple(label.point.tolist()))
    dxf.write(made, target)


def _svg(target: Path, unit: str, lines: list[Line], labels: list[Label]) -> None:
    """With a width and height in true size, where the unit is one of SVG; y upwards."""
    every = np.concatenate([line.points for line in lines])
    left, low = every.min(axis=0).tolist()
    right, high = every.max(axis=0).tolist()
    wide, tall = right - left, high - low
    scale = {"mm": 1.0, "cm": 10.0, "dm": 100.0, "m": 1000.0, "km": 1e6, "in": 25.4, "ft": 304.8, "yd": 914.4}[unit]
    thin = 0.001 * max(wide, tall)
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{wide * scale!r}mm" height="{tall * scale!r}mm" '
        f'viewBox="0 0 {wide!r} {tall!r}" fill="none" stroke-width="{thin!r}">'
    ]
    for layer in LAYERS:
        parts.append(f'<g id="{layer}" stroke="{COLOURS[layer]}">')
        for line in (line for line in lines if line.layer == layer):
            points = " ".join(f"{x - left!r},{high - y!r}" for x, y in line.points.tolist())
            shape = "polygon" if line.closed else "polyline"
            parts.append(f'<{shape} points="{points}"><title>{escape(line.name)}</title></{shape}>')
        for label in (label for label in labels if label.layer == layer):
            x, y = float(label.point[0]) - left, high - float(label.point[1])
            style = (
                f'font-size="{float(label.height)!r}" stroke="none" fill="{COLOURS[layer]}" font-family="sans-serif"'
            )
            parts.append(f'<text x="{x!r}" y="{y!r}" {style}>{escape(label.text)}</text>')
        parts.append("</g>")
    put(target, "\n".join([*parts, "</svg>\n"]).encode(), lambda back: None)


def _threedm(target: Path, unit: str, lines: list[Line], labels: list[Label]) -> None:
    from hookean.files.recipe.drawing import UNIT_NAMES
    from hookean.files.rhino import threedm

    def flat(points: Floats) -> Floats:
        return np.column_stack([points, np.zeros(len(points))])

    objects = [
        threedm.NewObject(flat(np.concatenate([line.points, line.points[: int(line.closed)]])), line.layer, line.name)
        for line in lines
    ]
    objects += [
        threedm.NewObject(np.append(label.point, 0.0), "labels", label.text)
        for label in labels
        if label.layer == "labels"
    ]
    names = {short: name for name, short in UNIT_NAMES.items()}
    colours = {layer: _rgba(COLOURS[layer]) for layer in LAYERS}
    layers = [threedm.NewLayer(layer, colour=colours[layer]) for layer in LAYERS]
    threedm.write_new(target, threedm.Additions(layers, objects), unit=names[unit], own=False)


def _rgba(colour: str) -> tuple[int, int, int, int]:
    red, green, blue = (int(colour[i : i + 2], 16) for i in (1, 3, 5))
    return red, green, blue, 255
