"""One small drawing for each component."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable

from hookean_canvas.components.pen import BLUE, GLASS, INK, ORANGE, PALE, WHITE, Colour, Pen, Spot, arc, bent, curve

# a flat mesh: rows and columns of spots
GRID = [[(2.5 + 6.33 * i, 3.0 + 6.0 * j) for i in range(4)] for j in range(4)]


def springs(pen: Pen) -> None:
    pen.spring((4.0, 20.0), (20.0, 4.0))
    pen.dot((3.6, 20.4), 2.2)
    pen.dot((20.4, 3.6), 2.2)


def unary(pen: Pen) -> None:
    pen.arrow((12.0, 5.0), (12.0, 22.5), width=2.2, head=6.0)
    pen.dot((12.0, 4.2), 2.8)


def anchor_spring(pen: Pen) -> None:
    pen.spring((12.0, 3.5), (12.0, 17.0), turns=3, swing=3.4)
    pen.dot((12.0, 3.2), 2.3)
    pen.support((12.0, 16.5), 5.0)


def bend(pen: Pen) -> None:
    pen.line((3.0, 19.0), (12.0, 8.0), (21.0, 19.0), width=2.0)
    pen.line(*arc((12.0, 8.0), 7.5, 52, 128), colour=ORANGE, width=1.6)
    for spot in ((3.0, 19.0), (12.0, 8.0), (21.0, 19.0)):
        pen.dot(spot, 2.0)


def beam(pen: Pen) -> None:
    pen.area((2.5, 15.0), (19.5, 6.0), (21.5, 9.8), (4.5, 18.8), colour=GLASS)
    pen.line((2.5, 15.0), (19.5, 6.0), (21.5, 9.8), (4.5, 18.8), closed=True, width=1.6)
    pen.line((3.5, 16.9), (20.5, 7.9), colour=ORANGE, width=1.4)


def support(pen: Pen) -> None:
    pen.line((3.0, 6.0), (21.0, 6.0), width=2.6)
    pen.spring((12.0, 6.5), (12.0, 17.5), turns=3, swing=3.2)
    pen.support((12.0, 17.0), 4.6)
    pen.line(*arc((12.0, 6.0), 5.0, 200, 340), colour=ORANGE, width=1.4)


def floor(pen: Pen) -> None:
    pen.line((1.5, 18.0), (22.5, 18.0), colour=BLUE, width=1.8)
    for x in (3.5, 8.0, 12.5, 17.0, 21.5):
        pen.line((x, 18.6), (x - 2.6, 22.4), colour=BLUE, width=1.0)
    pen.line(*bent((2.5, 3.0), (7.0, 8.0), (9.0, 16.0)), colour=PALE, width=1.2)
    pen.line(*bent((9.0, 16.0), (12.5, 4.0), (17.5, 8.0)), colour=PALE, width=1.2)
    pen.dot((18.5, 8.6), 3.0, ORANGE)


def hinge(pen: Pen) -> None:
    pen.area((12.0, 3.0), (12.0, 21.0), (2.0, 15.5))
    pen.area((12.0, 3.0), (12.0, 21.0), (22.0, 12.0), colour=(38, 118, 184, 110))
    pen.line((12.0, 3.0), (2.0, 15.5), (12.0, 21.0), (22.0, 12.0), width=1.3, closed=True)
    pen.line((12.0, 3.0), (12.0, 21.0), colour=ORANGE, width=2.2)


def pressure(pen: Pen) -> None:
    pen.line(*bent((2.5, 21.0), (12.0, 3.0), (21.5, 21.0)), width=2.0)
    pen.arrow((12.0, 9.5), (12.0, 1.5), head=4.2)
    pen.arrow((6.6, 12.6), (2.4, 6.8), head=4.0)
    pen.arrow((17.4, 12.6), (21.6, 6.8), head=4.0)


def pull_to_curve(pen: Pen) -> None:
    pen.line(*wave(17.5, 3.0), colour=BLUE, width=2.0)
    pen.arrow((12.0, 5.0), (12.0, 16.5), width=1.8, head=4.6)
    pen.dot((12.0, 4.0), 2.4)


def pull_to_mesh(pen: Pen) -> None:
    net(pen, slanted, BLUE, 1.2, fill=True)
    pen.arrow((12.0, 4.5), (12.0, 16.6), width=1.8, head=4.6)
    pen.dot((12.0, 3.4), 2.4)


def self_weight(pen: Pen) -> None:
    pen.line((1.5, 4.0), *bent((1.5, 4.0), (12.0, 9.0), (22.5, 4.0)), (22.5, 4.0), width=2.0)
    for x, top in ((4.5, 6.6), (12.0, 8.0), (19.5, 6.6)):
        pen.arrow((x, top), (x, top + 13.0), width=1.6, head=4.4)


def shell(pen: Pen) -> None:
    net(pen, vault, INK, 1.2, fill=True)
    pen.line(*[vault(i / 12, 1.0) for i in range(13)], colour=ORANGE, width=2.0)


def soapfilm(pen: Pen) -> None:
    film = [*bent((3.0, 3.5), (12.0, 11.0), (21.0, 3.5)), *bent((21.0, 3.5), (13.5, 12.0), (21.0, 20.5))]
    film += [*bent((21.0, 20.5), (12.0, 13.0), (3.0, 20.5)), *bent((3.0, 20.5), (10.5, 12.0), (3.0, 3.5))]
    pen.area(*film, colour=(38, 118, 184, 90))
    pen.line(*film, colour=BLUE, width=1.4)
    for spot in ((3.0, 3.5), (21.0, 3.5), (21.0, 20.5), (3.0, 20.5)):
        pen.dot(spot, 2.1)


def engine(pen: Pen) -> None:
    for turn in range(8):
        a = math.radians(45 * turn)
        pen.line(
            (12 + 8.6 * math.cos(a), 12 + 8.6 * math.sin(a)),
            (12 + 10.2 * math.cos(a), 12 + 10.2 * math.sin(a)),
            width=3.4,
        )
    pen.dot((12.0, 12.0), 9.2)
    pen.dot((12.0, 12.0), 7.0, WHITE)
    pen.area((9.6, 7.4), (9.6, 16.6), (17.4, 12.0), colour=ORANGE)


def settings(pen: Pen) -> None:
    for y, x in ((5.0, 16.0), (12.0, 8.0), (19.0, 13.0)):
        pen.line((2.5, y), (21.5, y), width=1.6)
        pen.ring((x, y), 2.5, BLUE, 1.8)


def anchors(pen: Pen) -> None:
    pen.support((6.5, 11.0), 8.0)
    pen.support((17.5, 11.0), 8.0)
    pen.line(*bent((6.5, 9.5), (12.0, 15.0), (17.5, 9.5)), width=1.4)
    pen.dot((6.5, 9.2), 2.6)
    pen.dot((17.5, 9.2), 2.6)


def server(pen: Pen) -> None:
    for y in (3.5, 9.8, 16.1):
        pen.area((3.0, y), (21.0, y), (21.0, y + 4.9), (3.0, y + 4.9), colour=INK)
        pen.line((10.5, y + 2.45), (18.0, y + 2.45), colour=PALE, width=1.0)
        pen.dot((6.0, y + 2.45), 1.2, ORANGE if y < 4 else WHITE)


def divide(pen: Pen) -> None:
    path = wave(12.0, 5.5)
    pen.line(*path, width=1.6)
    for i in (0, 6, 12, 18, 24):
        pen.dot(path[i], 2.2, BLUE)


def shatter(pen: Pen) -> None:
    path = wave(12.0, 5.5)
    for first, last, colour in ((0, 7, BLUE), (9, 15, ORANGE), (17, 24, BLUE)):
        pen.line(*path[first : last + 1], colour=colour, width=2.4)


def catenary(pen: Pen) -> None:
    scale = math.cosh(2.0) - 1.0
    path = curve(lambda t: (3.5 + 17.0 * t, 20.0 - 14.0 * (math.cosh(4.0 * t - 2.0) - 1.0) / scale))
    pen.line(*path, colour=ORANGE, width=2.0)
    pen.dot((3.5, 5.6), 2.3)
    pen.dot((20.5, 5.6), 2.3)


def mesh_surface(pen: Pen) -> None:
    net(pen, vault, BLUE, 1.3, fill=True)


def mesh_edges(pen: Pen) -> None:
    squares(pen, ORANGE, 2.0)


def mesh_vertices(pen: Pen) -> None:
    squares(pen, PALE, 1.0)
    pen_dots(pen, (spot for row in GRID for spot in row), BLUE, 1.8)


def mesh_corners(pen: Pen) -> None:
    squares(pen, PALE, 1.0)
    pen_dots(pen, (GRID[j][i] for i in (0, 3) for j in (0, 3)), ORANGE, 2.5)


def naked_vertices(pen: Pen) -> None:
    squares(pen, PALE, 1.0)
    pen_dots(pen, (GRID[j][i] for i in range(4) for j in range(4) if {i, j} & {0, 3}), ORANGE, 1.8)
    pen_dots(pen, (GRID[j][i] for i in (1, 2) for j in (1, 2)), PALE, 1.2)


def warp_weft(pen: Pen) -> None:
    for row in GRID:
        pen.line(row[0], row[3], colour=BLUE, width=1.9)
    for i in range(4):
        pen.line(GRID[0][i], GRID[3][i], colour=ORANGE, width=1.9)
    for j, row in enumerate(GRID):  # weft over warp at every other crossing
        for i, (x, y) in enumerate(row):
            if (i + j) % 2:
                pen.line((max(2.5, x - 2.0), y), (min(21.5, x + 2.0), y), colour=BLUE, width=1.9)


def diagonals(pen: Pen) -> None:
    for j in range(2):
        for i in range(2):
            a, b = (3.0 + 9.0 * i, 3.0 + 9.0 * j), (12.0 + 9.0 * i, 12.0 + 9.0 * j)
            pen.line(a, b, colour=ORANGE, width=1.7)
            pen.line((b[0], a[1]), (a[0], b[1]), colour=ORANGE, width=1.7)
    for k in range(3):
        pen.line((3.0, 3.0 + 9.0 * k), (21.0, 3.0 + 9.0 * k), colour=INK, width=1.1)
        pen.line((3.0 + 9.0 * k, 3.0), (3.0 + 9.0 * k, 21.0), colour=INK, width=1.1)


def remove_duplicate_lines(pen: Pen) -> None:
    pen.line((3.0, 17.0), (15.0, 3.0), width=2.0)
    for t in (0.0, 0.28, 0.56, 0.84):
        a = (6.5 + 12.0 * t, 20.0 - 14.0 * t)
        pen.line(a, (a[0] + 1.6, a[1] - 1.87), colour=PALE, width=1.7)
    pen.line((15.5, 15.5), (21.5, 21.5), colour=ORANGE, width=2.2)
    pen.line((21.5, 15.5), (15.5, 21.5), colour=ORANGE, width=2.2)


def interpolate(pen: Pen) -> None:
    path = curve(lambda t: (2.5 + 19.0 * t, 12.5 + 7.0 * math.sin(2.2 * math.pi * t + 2.4)))
    pen.line(*path, colour=ORANGE, width=1.8)
    for i in (0, 8, 16, 24):
        pen.ring(path[i], 1.8, INK, 1.3)


def sweep(pen: Pen) -> None:
    for sag, colour in ((5.0, BLUE), (19.0, PALE), (33.0, ORANGE)):
        pen.line(*bent((3.0, 4.5), (12.0, 4.5 + sag), (21.0, 4.5)), colour=colour, width=1.8)
    pen.dot((3.0, 4.5), 2.2)
    pen.dot((21.0, 4.5), 2.2)


def moments(pen: Pen) -> None:
    for control, colour in ((-9.0, PALE), (5.0, PALE), (30.0, BLUE)):
        pen.line(*bent((3.0, 9.0), (12.0, control), (21.0, 9.0)), colour=colour, width=1.6)
    pen.ring((18.6, 18.6), 4.0, ORANGE, 1.6)
    pen.line((18.6, 16.0), (18.6, 18.6), (20.4, 19.8), colour=ORANGE, width=1.2)


def stream(pen: Pen) -> None:
    pen.line(*[(2.5 + 19 * i / 40, 8.0 - 4.5 * math.sin(i / 4.5)) for i in range(41)], colour=BLUE, width=1.8)
    for x, tip in ((5.0, 19.0), (12.0, 22.0), (19.0, 17.5)):
        pen.arrow((x, 12.5), (x, tip), width=1.6, head=3.6)


def rhino_file(pen: Pen) -> None:
    pen.area((4.5, 1.5), (14.5, 1.5), (19.5, 6.5), (19.5, 22.5), (4.5, 22.5), colour=WHITE)
    pen.line((4.5, 1.5), (14.5, 1.5), (19.5, 6.5), (19.5, 22.5), (4.5, 22.5), width=1.4, closed=True)
    pen.line((14.5, 1.5), (14.5, 6.5), (19.5, 6.5), width=1.2)
    pen.text("3dm", (12.0, 10.4), 5.8, BLUE)
    pen.arrow((12.0, 14.0), (12.0, 21.2), width=1.8, head=4.4)


def compas(pen: Pen, key: str) -> None:
    """A pair of compasses, and in the corner what the component makes of COMPAS."""
    pen.line((8.0, 5.5), (2.6, 19.5), width=1.9)
    pen.line((8.0, 5.5), (13.4, 19.5), width=1.9)
    pen.line(*arc((8.0, 5.5), 9.5, 66, 114), colour=PALE, width=1.1)
    pen.ring((8.0, 4.4), 2.0, INK, 1.6)
    if "mesh" in key:
        corner = [[(14.5 + 3.6 * i, 3.0 + 3.6 * j) for i in range(3)] for j in range(3)]
        for k in range(3):
            pen.line(corner[k][0], corner[k][2], colour=BLUE, width=1.2)
            pen.line(corner[0][k], corner[2][k], colour=BLUE, width=1.2)
    elif any(word in key for word in ("graph", "network", "structure")):
        spots = ((15.0, 9.6), (18.2, 3.2), (21.4, 9.6))
        pen.line(*spots, colour=BLUE, width=1.2, closed=True)
        pen_dots(pen, spots, BLUE, 1.7)
    elif "relax" in key:
        pen.area((14.6, 2.4), (14.6, 11.0), (22.0, 6.7), colour=ORANGE)
    elif "anchor" in key:
        pen.support((18.0, 4.0), 6.0)
        pen.dot((18.0, 3.4), 1.9)
    elif "load" in key:
        pen.arrow((18.0, 2.6), (18.0, 12.0), width=1.8, head=4.6)
        pen.dot((18.0, 2.8), 1.8)
    elif "spring" in key:
        pen.spring((14.2, 10.6), (22.4, 2.4), turns=3, swing=1.9)
    else:
        pen.arrow((14.0, 6.7), (22.4, 6.7), width=1.8, head=4.6)


def unknown(pen: Pen, letters: str) -> None:
    """A force without a drawing of its own: an arrow and its letters, in one line or two."""
    pen.arrow((4.0, 3.0), (4.0, 21.5), width=2.0, head=5.2)
    lines = letters.split()
    for i, line in enumerate(lines):
        pen.text(line, (15.3, 12.0 + 9.5 * (i - 0.5 * (len(lines) - 1))), 8.5)


def wave(middle: float, swing: float) -> list[Spot]:
    """A curve from left to right, once up and down."""
    return curve(lambda t: (2.8 + 18.4 * t, middle - swing * math.sin(2 * math.pi * t)))


def vault(u: float, v: float) -> Spot:
    """A barrel of a shell, u along the span, v towards the viewer."""
    return (2.2 + 13.6 * u + 6.0 * (1 - v), 13.0 + 8.0 * v - 9.0 * (1 - (2 * u - 1) ** 2))


def slanted(u: float, v: float) -> Spot:
    """A flat patch seen at an angle."""
    return (1.8 + 14.4 * u + 6.0 * (1 - v), 13.0 + 8.5 * v)


def net(pen: Pen, at: Callable[[float, float], Spot], colour: Colour, width: float, fill: bool = False) -> None:
    """Lines of a surface, three by three."""
    if fill:
        rim = [at(i / 12, 1.0) for i in range(13)] + [at(1 - i / 12, 0.0) for i in range(13)]
        pen.area(*rim, colour=GLASS)
    for k in range(4):
        pen.line(*[at(i / 12, k / 3) for i in range(13)], colour=colour, width=width)
        pen.line(*[at(k / 3, i / 12) for i in range(13)], colour=colour, width=width)


def squares(pen: Pen, colour: Colour, width: float) -> None:
    """A flat mesh of three by three faces."""
    for k in range(4):
        pen.line(GRID[k][0], GRID[k][3], colour=colour, width=width)
        pen.line(GRID[0][k], GRID[3][k], colour=colour, width=width)


def pen_dots(pen: Pen, spots: Iterable[Spot], colour: Colour, radius: float) -> None:
    """The same dot at many spots."""
    for spot in spots:
        pen.dot(spot, radius, colour)


DRAWINGS: dict[str, Callable[[Pen], None]] = {
    draw.__name__.replace("_", ""): draw
    for draw in (
        *(
            springs,
            unary,
            anchor_spring,
            bend,
            beam,
            support,
            floor,
            hinge,
            pressure,
            pull_to_curve,
            pull_to_mesh,
            self_weight,
        ),
        *(shell, soapfilm, engine, settings, anchors, server, divide, shatter, catenary, interpolate, sweep),
        *(mesh_surface, mesh_edges, mesh_vertices, mesh_corners, naked_vertices, warp_weft, diagonals),
        *(remove_duplicate_lines, rhino_file, moments, stream),
    )
}
"""Drawings by the name of the bundle, in small letters without blanks."""
