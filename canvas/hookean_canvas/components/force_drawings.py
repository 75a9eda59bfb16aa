"""Drawings of contacts and of other forces that are often used, by the family of icon_drawings."""

from __future__ import annotations

import math
from collections.abc import Callable

from hookean_canvas.components.icon_drawings import pen_dots
from hookean_canvas.components.pen import BLUE, GLASS, INK, ORANGE, PALE, Pen, arc, bent


def collide(pen: Pen) -> None:
    pen.ring((7.5, 13.5), 5.5, BLUE, 1.6)
    pen.ring((16.8, 11.0), 4.6, BLUE, 1.6)
    pen.arrow((7.5, 13.5), (1.5, 15.2), head=3.6, width=1.6)
    pen.arrow((16.8, 11.0), (22.6, 9.4), head=3.6, width=1.6)


def collide_lines(pen: Pen) -> None:
    for a, b in (((4.5, 19.5), (19.5, 4.5)), ((4.5, 5.5), (18.5, 19.5))):
        pen.line(a, b, colour=BLUE, width=6.0)
        pen.line(a, b, colour=(214, 228, 240, 255), width=3.4)
    pen.dot((11.8, 12.4), 2.4, ORANGE)


def collide_solid(pen: Pen) -> None:
    box = ((5.0, 9.5), (12.0, 13.0), (12.0, 22.0), (5.0, 18.0)), ((12.0, 13.0), (19.5, 9.5), (19.5, 18.0), (12.0, 22.0))
    for side in (*box, ((5.0, 9.5), (12.5, 6.5), (19.5, 9.5), (12.0, 13.0))):
        pen.area(*side)
        pen.line(*side, closed=True, colour=BLUE, width=1.2)
    pen.arrow((12.2, 9.5), (12.2, 1.2), head=3.8)
    pen.dot((12.2, 9.6), 2.2)


def collide_curve(pen: Pen) -> None:
    pen.line(*arc((10.5, 13.5), 8.2, 0, 360), colour=BLUE, width=1.8)
    pen.arrow((15.0, 9.5), (22.3, 3.0), head=4.0)
    pen.dot((14.6, 9.8), 2.4)


def collide_2d(pen: Pen) -> None:
    pen.line((2.5, 6.0), (13.5, 4.5), (12.5, 17.0), (3.5, 16.0), closed=True, colour=BLUE, width=1.7)
    pen.line((11.0, 9.5), (21.5, 8.0), (20.5, 20.5), (12.0, 19.0), closed=True, width=1.7)
    pen.area((11.0, 9.5), (13.1, 9.2), (12.5, 17.0), (11.8, 16.9), colour=ORANGE)


def soft_collide(pen: Pen) -> None:
    left, right = arc((7.0, 12.0), 6.0, 40, 320), arc((17.0, 12.0), 6.0, 220, 500)
    for body, colour in ((left, BLUE), (right, INK)):
        pen.line(*body, colour=colour, width=1.8)
    pen.line((11.8, 8.0), (12.2, 12.0), (11.8, 16.0), colour=ORANGE, width=2.2)


def box_collide(pen: Pen) -> None:
    for x, y, w, h, colour in ((2.0, 9.0, 11.0, 12.0, BLUE), (11.0, 3.0, 10.5, 11.5, INK)):
        pen.area((x, y), (x + w, y), (x + w, y + h), (x, y + h))
        pen.line((x, y), (x + w, y), (x + w, y + h), (x, y + h), closed=True, colour=colour, width=1.6)
    pen.area((11.0, 9.0), (13.0, 9.0), (13.0, 14.5), (11.0, 14.5), colour=ORANGE)


def rigid_collide(pen: Pen) -> None:
    pen.line((2.0, 21.5), (22.0, 21.5), colour=PALE, width=1.4)
    pen.area((3.0, 12.5), (14.0, 12.5), (14.0, 20.8), (3.0, 20.8), colour=(38, 118, 184, 110))
    pen.line((3.0, 12.5), (14.0, 12.5), (14.0, 20.8), (3.0, 20.8), closed=True, width=1.4)
    pen.area((9.5, 11.6), (12.0, 2.5), (20.5, 5.0), (17.5, 14.2))
    pen.line((9.5, 11.6), (12.0, 2.5), (20.5, 5.0), (17.5, 14.2), closed=True, width=1.4)
    pen.dot((10.8, 12.2), 2.2, ORANGE)


def rigid_body(pen: Pen) -> None:
    spots = ((5.0, 17.5), (7.5, 5.5), (19.0, 8.0), (16.5, 20.0))
    pen.area(*spots, colour=(38, 118, 184, 110))
    for k, spot in enumerate(spots):
        for other in spots[k + 1 :]:
            pen.line(spot, other, colour=BLUE, width=1.2)
    pen_dots(pen, spots, INK, 2.3)


def solid_plane_collide(pen: Pen) -> None:
    pen.line((1.5, 20.5), (22.5, 14.5), colour=BLUE, width=2.0)
    pen.area((6.5, 8.0), (15.0, 5.6), (17.4, 15.4), (9.0, 17.8))
    pen.line((6.5, 8.0), (15.0, 5.6), (17.4, 15.4), (9.0, 17.8), closed=True, width=1.5)
    pen_dots(pen, ((9.0, 17.8), (17.4, 15.4)), ORANGE, 2.2)


def impulse(pen: Pen) -> None:
    for k in range(8):
        turn = k * math.pi / 4.0 + 0.2
        u = (math.cos(turn), math.sin(turn))
        pen.arrow((12.0 + 4.5 * u[0], 12.0 + 4.5 * u[1]), (12.0 + 11.0 * u[0], 12.0 + 11.0 * u[1]), width=1.4, head=3.4)
    pen.dot((12.0, 12.0), 2.8)


def coincident(pen: Pen) -> None:
    for x in (3.5, 20.5):
        pen.dot((x, 12.0), 2.4)
    pen.arrow((6.5, 12.0), (11.4, 12.0), head=3.6)
    pen.arrow((17.5, 12.0), (12.6, 12.0), head=3.6)
    pen.ring((12.0, 12.0), 2.0, BLUE, 1.2)


def pull_to_plane(pen: Pen) -> None:
    corners = ((2.0, 19.0), (8.5, 13.0), (22.0, 15.5), (15.5, 21.8))
    pen.area(*corners, colour=GLASS)
    pen.line(*corners, closed=True, colour=BLUE, width=1.4)
    pen.arrow((11.8, 4.5), (11.8, 16.5))
    pen.dot((11.8, 3.8), 2.4)


def smooth(pen: Pen) -> None:
    pen.line((2.0, 16.0), (8.0, 10.0), (12.0, 4.0), (16.0, 10.0), (22.0, 16.0), colour=PALE, width=1.3)
    pen.line(*bent((2.0, 16.0), (12.0, 5.0), (22.0, 16.0)), colour=BLUE, width=2.0)
    pen.arrow((12.0, 4.2), (12.0, 10.0), head=3.6)


def volume(pen: Pen) -> None:
    pen.line(*arc((12.0, 12.0), 8.8, 0, 360), colour=BLUE, width=1.8)
    for k in range(4):
        u = (math.cos(k * math.pi / 2.0), math.sin(k * math.pi / 2.0))
        pen.arrow((12.0 + 2.0 * u[0], 12.0 + 2.0 * u[1]), (12.0 + 7.4 * u[0], 12.0 + 7.4 * u[1]), width=1.4, head=3.4)


def planarize(pen: Pen) -> None:
    corners = ((3.0, 9.0), (12.0, 4.0), (21.0, 10.0), (12.0, 18.0))
    pen.area(*corners)
    pen.line(*corners, closed=True, width=1.6)
    pen.line(corners[0], corners[2], colour=PALE, width=1.2)
    pen.line(corners[1], corners[3], colour=PALE, width=1.2)
    pen.arrow((12.0, 22.5), (12.0, 18.6), head=3.2, width=1.5)
    pen.arrow((21.0, 4.0), (21.0, 9.0), head=3.2, width=1.5)


def wind(pen: Pen) -> None:
    for y, reach in ((6.0, 11.0), (12.0, 13.0), (18.0, 11.0)):
        pen.arrow((1.5, y), (reach, y), head=4.0)
    pen.line(*bent((16.0, 2.5), (22.5, 12.0), (16.0, 21.5)), colour=BLUE, width=2.2)


def wind_pressure(pen: Pen) -> None:
    pen.line((2.0, 19.0), (8.0, 9.0), (16.0, 9.0), (22.0, 19.0), colour=BLUE, width=2.2)
    pen.arrow((0.8, 9.5), (4.4, 13.4), head=3.6)
    pen.arrow((12.0, 7.5), (12.0, 1.5), head=3.6)
    pen.arrow((20.0, 13.0), (23.2, 9.5), head=3.2)


def hydrostatic(pen: Pen) -> None:
    pen.line((2.0, 5.0), (16.0, 5.0), colour=BLUE, width=1.4)
    pen.line((17.0, 2.0), (17.0, 22.0), width=2.2)
    for k in range(4):
        y = 8.0 + 4.2 * k
        pen.arrow((16.0 - 2.2 - 3.0 * k, y), (16.4, y), width=1.4, head=3.2)


DRAWINGS: dict[str, Callable[[Pen], None]] = {
    draw.__name__.replace("_", ""): draw
    for draw in (
        *(collide, collide_lines, collide_solid, collide_curve, collide_2d, soft_collide, box_collide, rigid_collide),
        *(rigid_body, solid_plane_collide, impulse, coincident, pull_to_plane, smooth, volume, planarize, wind),
        *(hydrostatic, wind_pressure),
    )
}
"""Drawings by the name of the bundle, in small letters without blanks."""
