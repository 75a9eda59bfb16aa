"""Furniture of a panel: the legend of forces, the directions of space and a bar of a round length."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.pictures.page import SMALL, Box, Page
from hookean.values.colours import INK, MUTED, PALE, Scale, number, ticks

Floats = NDArray[np.float64]

BAR = 1.5
"""Inches of width that a legend of forces takes."""
FOOT = 0.95
"""Inches of height that the directions and the bar take."""


def colour_bar(page: Page, box: Box, scale: Scale, words: str = "") -> None:
    """The legend of forces: a bar that ends at the two extremes; `words` are its title."""
    top = box.y + box.height
    page.text(box.x, top - 0.20, f"force [{scale.unit}]", weight="bold")
    low, high = scale.low, scale.high
    if low == high == 0.0:
        page.text(box.x, top - 0.42, "no force", colour=MUTED)
        return
    page.text(box.x, top - 0.42, "tension +", colour=MUTED)
    if words:
        page.text(box.x, top - 0.64, words, colour=MUTED)
    height = box.height - (0.84 if words else 0.62)
    bar = page.axes(Box(box.x + 0.06, box.y, 0.22, height))
    values = np.linspace(low, high, 400)
    page.colours += [tuple(c) for c in np.round(255 * scale.colours(values[::8])[:, :3]).astype(int).tolist()]
    bottom, upper = (low, high) if high > low else (low - 0.5, low + 0.5)
    bar.imshow(scale.colours(values).reshape(-1, 1, 4), origin="lower", aspect="auto", extent=(0, 1, bottom, upper))
    bar.set_xticks([])
    at = ticks(low, high, 0.24 / height, int(np.clip(height / 0.5, 1, 7)))
    bar.set_yticks(at, [number(t) for t in at])
    bar.yaxis.tick_right()
    bar.tick_params(labelsize=SMALL, colors=INK, length=4)
    for spine in bar.spines.values():
        spine.set_color(PALE)


def triad(page: Page, x: float, y: float, eye: Floats) -> None:
    """The directions of x, y and z; the lower left corner stands at (x, y)."""
    side = 0.95
    corner = page.axes(Box(x, y, side, side))
    corner.set_axis_off()
    corner.set_xlim(-1.5, 1.5)
    corner.set_ylim(-1.5, 1.5)
    spread = eye[:2].T * 0.95
    shift = -0.5 * (spread.min(axis=0) + spread.max(axis=0))
    for name, arm in zip("xyz", spread, strict=True):
        if np.linalg.norm(arm) > 0.05:
            arrow: dict[str, Any] = {"arrowstyle": "-|>", "color": INK, "shrinkA": 0, "shrinkB": 0}
            corner.annotate("", shift + arm, shift, arrowprops=arrow)
            at = shift + arm * (1.0 + 0.32 / np.linalg.norm(arm))
            corner.text(*at, name, fontsize=SMALL, color=INK, ha="center", va="center")


def scale_bar(page: Page, right: float, y: float, room: float, per_inch: float, unit: str) -> None:
    """A bar of a round length, at most `room` inches long, that ends at `right`."""
    room *= per_inch
    power = 10.0 ** np.floor(np.log10(room))
    length = max(step for step in (1.0, 2.0, 5.0) if step * power <= room) * power
    left = right - length / per_inch
    page.line([left, right], [y, y], color=INK, linewidth=2.6, solid_capstyle="butt")
    for x in (left, right):
        page.line([x, x], [y - 0.06, y + 0.06], color=INK, linewidth=1.4)
    page.text(right, y + 0.12, f"{number(length)} {unit}", ha="right")
