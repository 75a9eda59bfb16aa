"""Page: a figure measured in inches from its lower left corner, with text that fits; ends as the bytes of a PNG."""

from __future__ import annotations

import io
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from hookean.values.colours import INK

WIDTH = 14.0
"""Inches of a page's width; text of 12 points is then legible where a page is shown 900 pixels wide."""
LARGE, MEDIUM, SMALL = 21.0, 15.0, 12.0
"""Sizes of text in points: of the page, of a panel, of all else."""
ROW = 0.29
"""Height of a row of a legend in inches."""
LARGE_FILE = 160_000
"""Bytes from which on a picture is saved with a palette."""


class Box(NamedTuple):
    """A rectangle of the page in inches."""

    x: float
    y: float
    width: float
    height: float


@dataclass
class Entry:
    """A sample and its words in a legend; `style` are the properties of the sample's line."""

    label: str
    style: dict[str, Any] = field(default_factory=dict)


class Page:
    """A white figure of `width` x `height` inches."""

    def __init__(self, width: float, height: float, dpi: float) -> None:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure

        self.width, self.height, self.dpi = width, height, dpi
        # a hundredth of a pixel more, lest rounding takes one away
        size = ((width * dpi + 0.01) / dpi, (height * dpi + 0.01) / dpi)
        self.figure = Figure(figsize=size, dpi=dpi, facecolor="white")
        self.canvas = FigureCanvasAgg(self.figure)
        self.inches = self.figure.dpi_scale_trans
        self.colours: list[tuple[int, ...]] = []  # that a palette must have

    def axes(self, box: Box) -> Any:
        """Axes that fill a box."""
        w, h = self.width, self.height
        return self.figure.add_axes((box.x / w, box.y / h, box.width / w, box.height / h))

    def text(self, x: float, y: float, text: str, size: float = SMALL, colour: str = INK, **more: Any) -> None:
        """Words at a place; a `$` is only a `$`."""
        self.figure.text(x, y, text, fontsize=size, color=colour, transform=self.inches, parse_math=False, **more)

    def line(self, x: Any, y: Any, **style: Any) -> None:
        from matplotlib.lines import Line2D

        self.figure.add_artist(Line2D(x, y, transform=self.inches, **style))

    def legend(self, rows: list[list[Entry]], box: Box) -> None:
        """Rows of entries in the middle of a box, from its top."""
        for i, row in enumerate(rows):
            y = box.y + box.height - (i + 0.5) * ROW
            x = box.x + 0.5 * (box.width - sum(_span(e, box.width) for e in row) + _GAP)
            for entry in row:
                sample = _sample(entry)
                at = [x + 0.5 * (sample - 0.12)] if entry.style.get("linestyle") == "" else [x, x + sample - 0.12]
                self.line(at, [y] * len(at), **entry.style)
                self.text(x + sample, y, fitted(entry.label, box.width - sample), va="center_baseline")
                x += _span(entry, box.width)

    def png(self) -> bytes:
        """The page as a PNG file; a large one with a palette of 256 colours, where that shows no difference."""
        from PIL import Image

        self.canvas.draw()
        pixels = np.asarray(self.canvas.buffer_rgba())[..., :3]
        full = _saved(Image.fromarray(pixels.copy()), 6)
        few = None if len(full) <= LARGE_FILE else _few(pixels, self.colours)
        return full if few is None else _saved(few, 9)


def _saved(image: Any, level: int) -> bytes:
    buffer = io.BytesIO()
    image.save(buffer, format="png", compress_level=level)
    return buffer.getvalue()


def _few(pixels: Any, kept: list[tuple[int, ...]]) -> Any:
    """The same image with a palette that has white and the colours `kept`; None where it would show."""
    from PIL import Image
    from scipy.spatial import cKDTree

    packed = pixels.astype(np.uint32) @ np.array([65536, 256, 1], np.uint32)
    values, places, counts = np.unique(packed, return_inverse=True, return_counts=True)
    colours = np.stack([values >> 16, (values >> 8) & 255, values & 255], axis=-1).astype(np.uint8)
    palette = _palette(colours, counts, np.array([(255, 255, 255), *kept], np.uint8))
    if palette is None:
        return None
    off, nearest = cKDTree(palette.astype(float)).query(colours.astype(float))
    # areas keep their colour; only a few pixels on the edges of lines may be off
    if counts[off > 24.0].sum() > 1e-4 * counts.sum() or (off * counts).sum() > 1.5 * counts.sum():
        return None
    image = Image.fromarray(nearest.astype(np.uint8)[places].reshape(packed.shape))
    image.putpalette(palette.ravel().tolist())
    return image


def _palette(colours: Any, counts: Any, kept: Any) -> Any:
    """256 colours: those `kept`, and others spread over all there are and moved to where most pixels are; None
    where too many are kept."""
    from PIL import Image
    from scipy.spatial import cKDTree

    kept = np.unique(kept, axis=0)
    room = 256 - len(kept)
    if room < 64:
        return None  # many colour bars; full colour then
    spread = Image.fromarray(colours[None]).quantize(room // 2, method=Image.Quantize.MAXCOVERAGE)
    wide = np.array(spread.getpalette(), float).reshape(-1, 3)[: room // 2]
    often = colours[np.argsort(-counts, kind="stable")[: room - len(wide)]]
    moving, weights = np.concatenate([wide, often]), np.sqrt(counts)
    for _ in range(6):
        _, nearest = cKDTree(np.concatenate([kept, moving])).query(colours.astype(float))
        mine = nearest >= len(kept)
        index = nearest[mine] - len(kept)
        total = np.bincount(index, weights[mine], len(moving))
        sums = [np.bincount(index, weights[mine] * colours[mine, i], len(moving)) for i in range(3)]
        moving = np.where(total[:, None] > 0, np.stack(sums, axis=1) / np.maximum(total, 1e-9)[:, None], moving)
    return np.concatenate([kept, np.round(moving)]).astype(np.uint8)


_GAP = 0.32


def _sample(entry: Entry) -> float:
    """Inches from the start of a sample to its words."""
    return 0.28 if entry.style.get("marker") in ("s", "o") and entry.style.get("linestyle") == "" else 0.46


def flow(entries: list[Entry], width: float) -> list[list[Entry]]:
    """The entries of a legend in rows of at most `width` inches, about equally long."""

    def rows(most: float) -> list[list[Entry]]:
        found: list[list[Entry]] = []
        used = np.inf
        for entry in entries:
            span = _span(entry, width)
            if used + span > most + _GAP:
                found.append([])
                used = 0.0
            found[-1].append(entry)
            used += span
        return found

    if not entries:
        return []
    fewest = len(rows(width))
    return next(r for part in (0.5, 0.6, 0.7, 0.8, 0.9, 1.0) if len(r := rows(part * width)) == fewest)


def _span(entry: Entry, width: float) -> float:
    return min(_sample(entry) + measured(entry.label), width) + _GAP


@lru_cache(maxsize=1024)
def measured(text: str, size: float = SMALL, weight: str = "normal") -> float:
    """Width of a line of text in inches."""
    from matplotlib.font_manager import FontProperties
    from matplotlib.textpath import text_to_path

    width: float = text_to_path.get_text_width_height_descent(text, FontProperties(size=size, weight=weight), False)[0]
    return width / 72.0


def fitted(text: str, width: float, size: float = SMALL, weight: str = "normal") -> str:
    """Text cut to a width in inches, with an ellipsis where it was longer."""
    text = " ".join(text.split())
    if measured(text, size, weight) <= width:
        return text
    low, high = 0, len(text)
    while low < high:
        middle = (low + high + 1) // 2
        fits = measured(text[:middle].rstrip() + "…", size, weight) <= width
        low, high = (middle, high) if fits else (low, middle - 1)
    return text[:low].rstrip() + "…"


def wrapped(text: str, width: float, size: float, weight: str = "normal", most: int = 2) -> list[str]:
    """Text in at most so many lines of a width in inches; the last one cut where there is more."""
    words, lines = text.split(), list[str]()
    while words and len(lines) < most - 1:
        taken = next((n for n in range(len(words), 1, -1) if measured(" ".join(words[:n]), size, weight) <= width), 1)
        lines.append(fitted(" ".join(words[:taken]), width, size, weight))
        words = words[taken:]
    return [*lines, fitted(" ".join(words), width, size, weight)] if words else lines
