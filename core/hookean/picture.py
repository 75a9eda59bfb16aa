"""Picture: a result drawn to a PNG file, to be read like a figure: forces in colour, true proportions, a scale.

Everything is projected to the plane of the picture by this module and painted from back to front, so that a net of
100,000 springs takes seconds and equal results give equal bytes.
"""

from __future__ import annotations

import io
import os
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.errors import InputError
from hookean.files.threedm_atomic import check_target, put
from hookean.result import Result
from hookean.scene import Scene
from hookean.view import Things, collect, eye_of, springs

Floats = NDArray[np.float64]

INK, PALE, SLACK = "#22303c", "#8b98a5", "#b9c0c7"
LOAD, REACTION, FLOOR = "#2a9d5c", "#8e44ad", "#e9ecef"
COLD = ["#06306e", "#1f66b0", "#5ea2d6", "#a9c9e2"]
WARM = ["#f3b58e", "#e27a4c", "#c2352b", "#6f0a1e"]
MOST_ARROWS = 600


def legend(result: Result) -> tuple[float, float, str]:
    """Ends of the colour scale: the smallest and largest spring force and their unit; zeros without springs."""
    _, forces = springs(result)
    unit = str(result.units.force)
    return (float(forces.min()), float(forces.max()), unit) if len(forces) else (0.0, 0.0, unit)


def render(
    result: Result,
    path: str | os.PathLike[str],
    *,
    scene: Scene | None = None,
    title: str = "",
    size: tuple[int, int] = (1600, 1200),
    view: str | tuple[float, float] | None = None,
) -> None:
    """Draw `result` to a PNG file of `size` pixels.

    Springs by force (tension +, slack ones grey), carried meshes, held particles, loads and reactions; with its
    `scene` also the floor and the meshes that forces act on. `view` is front, right, top, isometric or the two angles
    (azimuth, elevation) of the eye [degrees]; without one, plane shapes are seen face on and all others at a slant.
    Raises InputError where the view or size makes no sense, or the file cannot be written.
    """
    check_target(path)
    if "\0" in os.fspath(path):
        raise InputError("path", "has a character that no file name may have; check it for odd characters")
    if not os.fspath(path).lower().endswith(".png"):
        raise InputError(os.path.basename(os.fspath(path)), "is not a .png file; pictures are PNG, end the name so.")
    if len(size) != 2 or not all(200 <= side <= 10_000 for side in size):
        raise InputError("size", f"{size} given; two numbers of pixels from 200 to 10000 are allowed")
    things = collect(result, scene)
    eye = eye_of(view, things)
    put(path, _paint(result, things, eye, title, size), _is_png)


def _is_png(data: bytes) -> None:
    if not data.startswith(b"\x89PNG"):
        raise InputError("picture", "did not come out as PNG; try again with another version of matplotlib")


def ramp(low: float, high: float) -> tuple[list[str], float, float]:
    """Colours at even steps and the forces at their two ends: about 0 where both signs occur, else over the extremes
    `low` and `high`; where there are no forces, not finite, as for zeros."""
    low, high = (low, high) if low <= high else (0.0, 0.0)
    largest = max(abs(low), abs(high))
    if low < -1e-9 * largest and high > 1e-9 * largest:
        return [*COLD, "#d3d3d3", *WARM], -largest, largest
    colours = COLD if high <= 1e-9 * largest and largest > 0 else WARM
    margin = 0.0 if high > low else max(abs(high), 1.0) * 1e-3
    return colours, low - margin, high + margin


def _colours(low: float, high: float) -> tuple[Any, float, float]:
    """Colour map and the forces at its two ends."""
    from matplotlib.colors import LinearSegmentedColormap as Map

    colours, first, last = ramp(low, high)
    return Map.from_list("forces", colours), first, last


def _paint(result: Result, things: Things, eye: Floats, title: str, size: tuple[int, int]) -> bytes:
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    dpi = 100.0 * min(size[0] / 1600, size[1] / 1200)
    figure = Figure(figsize=(size[0] / dpi, size[1] / dpi), dpi=dpi, facecolor="white")
    FigureCanvasAgg(figure)
    low, high, unit = legend(result)
    scale = _colours(low, high)
    drawing = figure.add_axes((0.03, 0.10, 0.84 if len(things.forces) else 0.94, 0.775))
    drawing.set_axis_off()
    drawing.set_aspect("equal")
    entries = _draw(drawing, things, eye, scale, unit)
    _headings(figure, result, title)
    _triad(figure, eye)
    _scale_bar(figure, drawing, str(result.units.length))
    if entries:
        figure.legend(
            handles=entries, loc="lower center", bbox_to_anchor=(0.5, 0.012), ncol=len(entries), frameon=False,
            fontsize=13, labelcolor=INK, handletextpad=0.6, columnspacing=2.2,
        )  # fmt: skip
    if len(things.forces) and low == high == 0.0:
        figure.text(0.885, 0.845, "no force", fontsize=14, color=INK, va="bottom", weight="bold")
    elif len(things.forces):
        _colour_bar(figure, low, high, unit, scale)
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=dpi, metadata={"Software": None})
    return buffer.getvalue()


def _draw(drawing: Any, things: Things, eye: Floats, scale: tuple[Any, float, float], unit: str) -> list[Any]:
    """Everything in the drawing itself; returns the entries of the legend."""
    flat = things.body @ eye[:2].T
    extent = float(np.linalg.norm(np.ptp(flat, axis=0))) or 1.0
    seen = [flat]
    for point, normal in things.floors:
        seen.append(_draw_floor(drawing, things, eye, extent, point, normal))
    slack = _draw_body(drawing, things, eye, scale)
    for stroke in things.strokes:
        drawing.plot(*(stroke @ eye[:2].T).T, color=INK, linewidth=1.2, zorder=3)
    entries = _draw_points(drawing, things, eye, slack)
    centre = things.body.mean(axis=0)
    kinds = ((things.loads, LOAD, "load", 0.06), (things.reactions, REACTION, "reaction", 0.1))
    for arrows, colour, name, share in kinds:
        share *= min(1.0, (30.0 / max(len(arrows), 1)) ** 0.3)
        drawn = _arrows(arrows, eye, extent * share, centre, inward=name == "reaction")
        if len(drawn):
            seen.append((drawn[:, 0] + drawn[:, 1]).reshape(-1, 2))
            seen.append(drawn[:, 0])
            entries.append(_draw_arrows(drawing, drawn, colour, extent, _arrow_label(arrows, name, unit)))
    every = np.concatenate(seen)
    low, high = every.min(axis=0), every.max(axis=0)
    pad = 0.03 * max(float((high - low).max()), 1e-9 * extent) + (0.5 if np.allclose(low, high) else 0.0)
    drawing.set_xlim(low[0] - pad, high[0] + pad)
    drawing.set_ylim(low[1] - pad, high[1] + pad)
    return entries


def _draw_body(drawing: Any, things: Things, eye: Floats, scale: tuple[Any, float, float]) -> bool:
    """Faces and springs in one pass from back to front; returns whether any spring is slack."""
    from matplotlib.collections import PolyCollection
    from matplotlib.colors import Normalize, to_rgba

    cmap, low, high = scale
    lines = things.points[things.springs]
    largest = np.abs(things.forces).max(initial=0.0)
    slack = np.abs(things.forces) <= 1e-12 * largest
    colours = cmap(Normalize(low, high)(things.forces)).reshape(-1, 4)
    colours[slack] = to_rgba(SLACK)
    # springs on the edges of faces lie on top of them: the faces step back by a part of their size
    reach = np.linalg.norm(np.ptp(things.faces, axis=1), axis=1).mean() if len(things.faces) else 0.0
    depth = np.concatenate([(things.faces @ eye[2]).mean(axis=1) - 0.6 * reach, (lines @ eye[2]).mean(axis=1)])
    faces = np.concatenate([things.faces, things.faces[:, :1]], axis=1) @ eye[:2].T
    order = np.argsort(depth, kind="stable")
    shapes = [*faces, *(lines @ eye[:2].T)]
    fill = np.concatenate([_light(things.faces, eye), np.zeros((len(lines), 4))])
    edge = np.concatenate([np.zeros((len(faces), 4)), colours])
    width = float(np.clip(90.0 / np.sqrt(len(lines) + 1.0), 0.45, 4.5))
    widths = np.concatenate([np.zeros(len(faces)), np.where(slack, max(0.7 * width, 1.2), width)])
    smooth = np.concatenate([np.zeros(len(faces), bool), np.ones(len(lines), bool)])
    drawing.add_collection(
        PolyCollection(
            [shapes[i] for i in order], closed=False, facecolors=fill[order], edgecolors=edge[order],
            linewidths=widths[order], antialiaseds=smooth[order], capstyle="round", zorder=2,
        ),
        autolim=False,
    )  # fmt: skip
    return bool(slack.any())


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
    colour = np.array([0.80, 0.87, 0.93])[None] * shine[:, None]
    return np.column_stack([colour, np.full(len(faces), 0.80)])


def _draw_floor(drawing: Any, things: Things, eye: Floats, extent: float, point: Floats, normal: Floats) -> Floats:
    """A part of the plane under the model, with its grid; returns its corners in the picture."""
    from matplotlib.collections import LineCollection

    first = np.cross(normal, [0.0, 1.0, 0.0] if abs(normal[1]) < 0.9 else [1.0, 0.0, 0.0])
    first /= np.linalg.norm(first)
    axes = np.stack([first, np.cross(normal, first)])
    flat = (things.body - point) @ axes.T
    low, high = flat.min(axis=0) - 0.08 * extent, flat.max(axis=0) + 0.08 * extent
    at = [np.linspace(a, b, 11) for a, b in zip(low, high, strict=True)]
    ends = [[(s, low[1]), (s, high[1])] for s in at[0]] + [[(low[0], s), (high[0], s)] for s in at[1]]
    lines = (point + np.array(ends) @ axes) @ eye[:2].T
    corners: Floats = lines[[0, 10]].reshape(-1, 2)[[0, 1, 3, 2]]
    drawing.fill(*corners.T, facecolor=FLOOR, edgecolor="none", zorder=0)
    drawing.add_collection(LineCollection(list(lines), colors="#cfd5db", linewidths=0.9, zorder=1), autolim=False)
    return corners


def _draw_points(drawing: Any, things: Things, eye: Floats, slack: bool) -> list[Any]:
    """Held particles, and free ones where nothing else shows them; returns legend entries."""
    from matplotlib.lines import Line2D

    entries: list[Any] = []
    if slack:
        entries.append(Line2D([], [], color=SLACK, linewidth=2, label="slack spring (no force)"))
    if not len(things.springs) and not len(things.faces) or len(things.points) <= 60:
        area = 26.0 if len(things.points) > 3 else 90.0
        drawing.scatter(*(things.points @ eye[:2].T).T, s=area, color="white", edgecolors=INK, linewidths=1.2, zorder=4)
    if len(things.held):
        area = float(np.clip(4000.0 / len(things.held), 14.0, 150.0))
        drawing.scatter(*(things.held @ eye[:2].T).T, s=area, marker="s", color=INK, edgecolors="white",
                        linewidths=0.8, zorder=6)  # fmt: skip
        entries.append(Line2D([], [], color=INK, marker="s", markersize=9, linestyle="", label="anchor"))
    return entries


def _arrows(arrows: Floats, eye: Floats, longest: float, centre: Floats, *, inward: bool) -> Floats:
    """Feet and vectors in the picture (k, 2, 2), the longest of length `longest`; thinned where there are many."""
    size = np.linalg.norm(arrows[:, 1], axis=1)
    arrows = arrows[size > 1e-3 * size.max(initial=0.0)]
    if len(arrows) > MOST_ARROWS:
        arrows = arrows[:: -(-len(arrows) // MOST_ARROWS)]
    if not len(arrows):
        return np.zeros((0, 2, 2))
    vectors = arrows[:, 1] * (longest / size.max())
    # what pushes from outside ends at its particle, so that it does not cross the model
    foot = arrows[:, 0].copy()
    if inward:
        pushes = ((foot - centre) * vectors).sum(axis=1) < 0
        foot[pushes] -= 1.15 * vectors[pushes]
    return np.stack([foot @ eye[:2].T, vectors @ eye[:2].T], axis=1)


def _arrow_label(arrows: Floats, name: str, unit: str) -> str:
    sizes = np.linalg.norm(arrows[:, 1], axis=1)
    shown = int((sizes > 1e-3 * sizes.max()).sum())
    thinned = -(-shown // MOST_ARROWS)
    few = f", 1 of {thinned} drawn" if thinned > 1 else ""
    if np.ptp(sizes[sizes > 1e-3 * sizes.max()]) <= 1e-9 * sizes.max():
        return f"{name} {_number(sizes.max())} {unit}{few}"
    return f"{name}, longest {_number(sizes.max())} {unit}{few}"


def _draw_arrows(drawing: Any, arrows: Floats, colour: str, extent: float, label: str) -> Any:
    from matplotlib.lines import Line2D

    many = len(arrows) > 60  # then they go behind the model, so that it stays legible
    width = extent * float(np.clip(0.0032 * (30.0 / len(arrows)) ** 0.4, 0.001, 0.0032))
    drawing.quiver(
        *arrows[:, 0].T, *arrows[:, 1].T, angles="xy", scale_units="xy", scale=1.0, units="xy", width=width,
        headwidth=4.2, headlength=5.0, headaxislength=4.6, minlength=0.0, color=colour, zorder=1.5 if many else 5.0,
    )  # fmt: skip
    return Line2D([], [], color=colour, marker=r"$\rightarrow$", markersize=20, linestyle="", label=label)


def _number(value: float) -> str:
    return f"{value:.4g}".replace("e+0", "e").replace("e-0", "e-").replace("-", "\N{MINUS SIGN}")


def _headings(figure: Any, result: Result, title: str) -> None:
    heading = title or "Hookean result"
    state = str(result.status).replace("_", " ")
    count = f"{result.iterations} iteration{'s' * (result.iterations != 1)}"
    line = f"{state}  ·  residual {_number(result.residual)}  ·  {count}  ·  {result.solver}"
    figure.text(0.03, 0.965, _fitted(heading, 75), fontsize=24, color=INK, weight="bold", va="top", parse_math=False)
    figure.text(0.03, 0.918, _fitted(line, 130), fontsize=14, color="#52606d", va="top", parse_math=False)


def _fitted(text: str, most: int) -> str:
    text = " ".join(text.split())
    return text if len(text) <= most else text[: most - 1].rstrip() + "…"


def _colour_bar(figure: Any, low: float, high: float, unit: str, scale: tuple[Any, float, float]) -> None:
    """The legend of forces: a bar that ends at the two extremes."""
    cmap, first, last = scale
    bar = figure.add_axes((0.895, 0.17, 0.018, 0.64))
    values = np.linspace(low, high, 400)
    shades = cmap(np.clip((values - first) / (last - first), 0.0, 1.0)).reshape(-1, 1, 4)
    bottom, top = (low, high) if high > low else (low - 0.5, low + 0.5)
    bar.imshow(shades, origin="lower", aspect="auto", extent=(0.0, 1.0, bottom, top))
    bar.set_xticks([])
    ticks = _ticks(low, high)
    bar.set_yticks(ticks, [_number(t) for t in ticks])
    bar.yaxis.tick_right()
    bar.tick_params(labelsize=13, colors=INK, length=5)
    for spine in bar.spines.values():
        spine.set_color(PALE)
    figure.text(0.885, 0.845, f"force [{unit}]", fontsize=14, color=INK, va="bottom", weight="bold")
    figure.text(0.885, 0.842, "tension +", fontsize=12, color="#52606d", va="top")


def _ticks(low: float, high: float) -> list[float]:
    """The two ends and round numbers between them that keep clear of the ends."""
    from matplotlib.ticker import MaxNLocator

    if not high > low:
        return [low]
    clear = 0.05 * (high - low)
    between = [float(t) for t in MaxNLocator(7).tick_values(low, high)]
    return [low, *(t for t in between if low + clear < t < high - clear), high]


def _triad(figure: Any, eye: Floats) -> None:
    """The directions of x, y and z in the lower left corner."""
    width, height = figure.get_size_inches()
    corner = figure.add_axes((0.02, 0.015, 1.15 / width, 1.15 / height))
    corner.set_axis_off()
    corner.set_xlim(-1.5, 1.5)
    corner.set_ylim(-1.5, 1.5)
    spread = eye[:2].T * 0.95
    shift = -0.5 * (spread.min(axis=0) + spread.max(axis=0))
    for name, arm in zip("xyz", spread, strict=True):
        if np.linalg.norm(arm) > 0.05:
            corner.annotate("", shift + arm, shift, arrowprops={"arrowstyle": "-|>", "color": INK, "shrinkA": 0,
                                                                "shrinkB": 0})  # fmt: skip
            corner.text(*(shift + arm * (1.0 + 0.28 / np.linalg.norm(arm))), name, fontsize=13, color=INK,
                        ha="center", va="center")  # fmt: skip


def _scale_bar(figure: Any, drawing: Any, unit: str) -> None:
    """A bar of a round length in the lower right corner."""
    drawing.apply_aspect()
    box = drawing.get_position()
    per_length = box.width / float(np.ptp(drawing.get_xlim()))
    room = 0.17 / per_length
    power = 10.0 ** np.floor(np.log10(room))
    length = max(step for step in (1.0, 2.0, 5.0) if step * power <= room) * power
    from matplotlib.lines import Line2D

    right, y, span = 0.97, 0.032, length * per_length
    figure.add_artist(Line2D([right - span, right], [y, y], color=INK, linewidth=3, solid_capstyle="butt"))
    for x in (right - span, right):
        figure.add_artist(Line2D([x, x], [y - 0.006, y + 0.006], color=INK, linewidth=1.5))
    figure.text(right - 0.5 * span, y + 0.012, f"{_number(length)} {unit}", fontsize=13, color=INK, ha="center")
