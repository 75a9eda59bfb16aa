"""Icons of the components, one family: 24 x 24, transparent, drawn eight times as large and made small."""

from __future__ import annotations

import io
import re
from collections.abc import Sequence

from PIL import Image, ImageDraw

from hookean_canvas.components import force_drawings, icon_drawings, tool_drawings
from hookean_canvas.components.icon_drawings import compas, unknown
from hookean_canvas.components.pen import SIZE, Pen

DRAWINGS = icon_drawings.DRAWINGS | force_drawings.DRAWINGS | tool_drawings.DRAWINGS


def known(name: str) -> bool:
    """Whether the component `name` has a drawing of its own."""
    return re.sub("[^a-z0-9]", "", name.lower()) in DRAWINGS


def png(name: str) -> bytes:
    """The icon of the component `name` as PNG; an unknown one gets a force's arrow and its letters."""
    pen = Pen()
    key = re.sub("[^a-z0-9]", "", name.lower())
    if key in DRAWINGS:
        DRAWINGS[key](pen)
    elif "compas" in key:
        compas(pen, key)
    else:
        unknown(pen, letters(name))
    stream = io.BytesIO()
    pen.small().save(stream, "PNG", optimize=True)
    return stream.getvalue()


def letters(name: str) -> str:
    """The first and the last word of a name, each by its first two letters and its last: "Trn Lok" for
    TranslationLock."""
    words = re.findall("[A-Z0-9][a-z]*", name)
    return " ".join(word if len(word) < 3 else word[:2] + word[-1] for word in {words[0]: 0, words[-1]: 0})


def same_picture(one: bytes, other: bytes) -> bool:
    """Whether two PNGs show the same, give or take what two versions of Pillow may differ by in some edges."""
    images = [Image.open(io.BytesIO(data)).convert("RGBA") for data in (one, other)]
    if images[0].size != images[1].size:
        return False
    ours, theirs = bytes(images[0].tobytes()), bytes(images[1].tobytes())
    return sum(abs(a - b) > 24 for a, b in zip(ours, theirs, strict=True)) <= len(ours) // 100


def sheet(icons: Sequence[tuple[str, bytes]], columns: int = 8, zoom: int = 4) -> Image.Image:
    """All icons on one page, `zoom` times as large, with their names, to be looked at."""
    cell = (SIZE * zoom + 44, SIZE * zoom + 30)
    rows = -(-len(icons) // columns)
    page = Image.new("RGB", (cell[0] * columns, cell[1] * rows), (214, 217, 222))
    draw = ImageDraw.Draw(page)
    for i, (name, data) in enumerate(icons):
        x, y = i % columns * cell[0], i // columns * cell[1]
        icon = Image.open(io.BytesIO(data))
        large = icon.resize((SIZE * zoom, SIZE * zoom), Image.Resampling.NEAREST)
        page.paste(large, (x + 8, y + 6), large)
        page.paste(icon, (x + SIZE * zoom + 12, y + 6), icon)
        draw.text((x + 8, y + SIZE * zoom + 10), name, fill=(20, 20, 20))
    return page
