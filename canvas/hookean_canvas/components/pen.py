"""The pen that draws icons."""

from __future__ import annotations

import math
from collections.abc import Callable

from PIL import Image, ImageDraw, ImageFont

SIZE, SCALE = 24, 8
INK = (44, 48, 56, 255)
ORANGE = (226, 88, 34, 255)  # what acts
BLUE = (38, 118, 184, 255)  # what is held, chosen or made
PALE = (150, 158, 170, 255)
GLASS = (38, 118, 184, 60)
WHITE = (255, 255, 255, 255)

Colour = tuple[int, int, int, int]
Spot = tuple[float, float]


class Pen:
    """Draws in units of the small icon, (0, 0) top left, (24, 24) bottom right."""

    def __init__(self) -> None:
        self.image = Image.new("RGBA", (SIZE * SCALE, SIZE * SCALE), (0, 0, 0, 0))

    def line(self, *spots: Spot, colour: Colour = INK, width: float = 1.5, closed: bool = False) -> None:
        """A polyline with round joints and ends."""
        path = [*spots, spots[0]] if closed else list(spots)
        with _Layer(self) as draw:
            draw.line([_large(s) for s in path], fill=colour, width=round(width * SCALE))
            for spot in path:
                draw.ellipse(_disc(spot, width / 2), fill=colour)

    def dot(self, spot: Spot, radius: float = 2.0, colour: Colour = INK) -> None:
        """A filled disc."""
        with _Layer(self) as draw:
            draw.ellipse(_disc(spot, radius), fill=colour)

    def ring(self, spot: Spot, radius: float = 2.0, colour: Colour = INK, width: float = 1.5) -> None:
        """A circle, white inside."""
        self.dot(spot, radius + width / 2, colour)
        self.dot(spot, radius - width / 2, WHITE)

    def area(self, *spots: Spot, colour: Colour = GLASS) -> None:
        """A filled polygon."""
        with _Layer(self) as draw:
            draw.polygon([_large(s) for s in spots], fill=colour)

    def arrow(self, start: Spot, end: Spot, colour: Colour = ORANGE, width: float = 1.8, head: float = 4.0) -> None:
        """An arrow with a filled head at `end`."""
        length = math.dist(start, end)
        u = ((end[0] - start[0]) / length, (end[1] - start[1]) / length)
        neck = (end[0] - u[0] * head * 0.8, end[1] - u[1] * head * 0.8)
        back = (end[0] - u[0] * head, end[1] - u[1] * head)
        side = (-u[1] * head * 0.62, u[0] * head * 0.62)
        if length > head:
            self.line(start, neck, colour=colour, width=width)
        self.area(end, (back[0] + side[0], back[1] + side[1]), (back[0] - side[0], back[1] - side[1]), colour=colour)

    def spring(self, start: Spot, end: Spot, turns: int = 4, swing: float = 2.6, colour: Colour = ORANGE) -> None:
        """A zigzag with straight ends."""
        along = (end[0] - start[0], end[1] - start[1])
        length = math.hypot(*along)
        across = (-along[1] / length * swing, along[0] / length * swing)
        path = [start]
        for i in range(2 * turns + 1):
            t = 0.16 + 0.68 * i / (2 * turns)
            side = 0 if i in (0, 2 * turns) else 1 if i % 2 else -1
            path.append((start[0] + along[0] * t + across[0] * side, start[1] + along[1] * t + across[1] * side))
        self.line(*path, end, colour=colour, width=1.4)

    def support(self, spot: Spot, size: float = 4.5, colour: Colour = BLUE) -> None:
        """The engineer's sign of a support: a triangle under a point."""
        x, y = spot
        self.area((x, y), (x - size * 0.62, y + size), (x + size * 0.62, y + size), colour=colour)
        self.line((x - size * 0.8, y + size), (x + size * 0.8, y + size), colour=colour, width=1.2)

    def text(self, words: str, middle: Spot, height: float, colour: Colour = INK) -> None:
        """Words around `middle`, as high as said."""
        font = ImageFont.load_default(size=height * SCALE)
        with _Layer(self) as draw:
            draw.text(_large(middle), words, fill=colour, font=font, anchor="mm", stroke_width=SCALE // 4)

    def small(self) -> Image.Image:
        """The icon at its size."""
        return self.image.resize((SIZE, SIZE), Image.Resampling.BOX)


def curve(at: Callable[[float], Spot], pieces: int = 24) -> list[Spot]:
    """Spots along a curve given for 0 to 1."""
    return [at(i / pieces) for i in range(pieces + 1)]


def bent(a: Spot, control: Spot, b: Spot) -> list[Spot]:
    """A parabola from a to b, drawn towards the control spot."""
    return curve(
        lambda t: (
            (1 - t) ** 2 * a[0] + 2 * t * (1 - t) * control[0] + t * t * b[0],
            (1 - t) ** 2 * a[1] + 2 * t * (1 - t) * control[1] + t * t * b[1],
        )
    )


def arc(middle: Spot, radius: float, first: float, last: float) -> list[Spot]:
    """Spots of an arc, angles in degrees, clockwise on the screen."""
    return curve(
        lambda t: (
            middle[0] + radius * math.cos(math.radians(first + (last - first) * t)),
            middle[1] + radius * math.sin(math.radians(first + (last - first) * t)),
        )
    )


class _Layer:
    """A transparent sheet laid over the drawing, so that glass mixes with what is below."""

    def __init__(self, pen: Pen) -> None:
        self.pen = pen
        self.sheet = Image.new("RGBA", pen.image.size, (0, 0, 0, 0))

    def __enter__(self) -> ImageDraw.ImageDraw:
        return ImageDraw.Draw(self.sheet)

    def __exit__(self, *_: object) -> None:
        self.pen.image = Image.alpha_composite(self.pen.image, self.sheet)


def _large(spot: Spot) -> tuple[float, float]:
    return (spot[0] * SCALE, spot[1] * SCALE)


def _disc(spot: Spot, radius: float) -> list[float]:
    x, y, r = spot[0] * SCALE, spot[1] * SCALE, radius * SCALE
    return [x - r, y - r, x + r, y + r]
