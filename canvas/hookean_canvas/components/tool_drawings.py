"""Drawings of the tools for meshes and of the drivers, by the family of icon_drawings."""

from __future__ import annotations

import math
from collections.abc import Callable

from hookean_canvas.components.icon_drawings import GRID, pen_dots, squares, wave
from hookean_canvas.components.pen import BLUE, GLASS, INK, ORANGE, PALE, Pen, Spot, arc, bent

CORNERS: list[Spot] = [(3.0, 3.0), (21.0, 3.0), (21.0, 21.0), (3.0, 21.0)]


def remove_duplicate_points(pen: Pen) -> None:
    pen.dot((6.0, 16.0), 2.6)
    for spot in ((9.0, 9.5), (12.5, 6.5)):
        pen.ring(spot, 2.4, PALE, 1.4)
    pen.line((15.5, 15.5), (21.5, 21.5), colour=ORANGE, width=2.2)
    pen.line((21.5, 15.5), (15.5, 21.5), colour=ORANGE, width=2.2)


def combine_clean(pen: Pen) -> None:
    for x in (2.5, 12.8):
        pen.area((x, 4.0), (x + 8.7, 4.0), (x + 8.7, 20.0), (x, 20.0), colour=GLASS)
        pen.line((x, 4.0), (x + 8.7, 4.0), (x + 8.7, 20.0), (x, 20.0), closed=True, colour=BLUE, width=1.4)
    pen_dots(pen, ((12.0, 4.0), (12.0, 12.0), (12.0, 20.0)), ORANGE, 2.4)


def load_case(pen: Pen) -> None:
    for x in (5.0, 12.0, 19.0):
        pen.arrow((x, 3.0), (x, 13.5), width=1.8, head=4.6)
    pen.line(*bent((2.5, 15.0), (12.0, 21.5), (21.5, 15.0)), width=2.0)


def combination(pen: Pen) -> None:
    for y, colour in ((6.0, BLUE), (18.0, ORANGE)):
        pen.arrow((3.0, y), (13.0, 12.0), width=1.6, head=4.0)
        pen.dot((3.6, y), 2.2, colour)
    pen.line((13.0, 12.0), (21.0, 12.0), width=2.2)
    pen.line((17.0, 8.0), (17.0, 16.0), width=2.2)


def load_cases(pen: Pen) -> None:
    for depth, colour in ((10.0, PALE), (15.0, BLUE), (21.0, ORANGE)):
        pen.line(*bent((2.5, 5.0), (12.0, 2.0 * depth - 5.0), (21.5, 5.0)), colour=colour, width=1.7)
    for x in (2.5, 21.5):
        pen.dot((x, 5.0), 2.2, INK)


def refine(pen: Pen) -> None:
    pen.line((12.0, 3.0), (12.0, 21.0), colour=ORANGE, width=1.8)
    pen.line((3.0, 12.0), (21.0, 12.0), colour=ORANGE, width=1.8)
    pen.line(*CORNERS, closed=True, width=2.0)


def refine_strips(pen: Pen) -> None:
    for x in (7.5, 16.5):
        pen.line((x, 7.0), (x, 17.0), colour=ORANGE, width=1.7)
    for x in (3.0, 12.0, 21.0):
        pen.line((x, 7.0), (x, 17.0), width=1.7)
    for y in (7.0, 17.0):
        pen.line((3.0, y), (21.0, y), width=2.0)


def diagonalize(pen: Pen) -> None:
    squares(pen, PALE, 1.0)
    for j in range(3):
        for i in range(3):
            x, y = GRID[j][i]
            pen.line((x + 3.2, y), (x + 6.3, y + 3.0), (x + 3.2, y + 6.0), (x, y + 3.0), closed=True, colour=BLUE,
                     width=1.3)  # fmt: skip


def checkerboard(pen: Pen) -> None:
    for j in range(3):
        for i in range(3):
            a, c = GRID[j][i], GRID[j + 1][i + 1]
            if (i + j) % 2 == 0:
                pen.area(a, (c[0], a[1]), c, (a[0], c[1]), colour=BLUE)
    squares(pen, INK, 1.1)


def hinge_points(pen: Pen) -> None:
    spots = ((12.0, 3.0), (12.0, 21.0), (2.8, 13.5), (21.2, 10.5))
    pen.line(spots[0], spots[2], spots[1], spots[3], width=1.2, colour=PALE, closed=True)
    pen.line(spots[0], spots[1], colour=ORANGE, width=1.8)
    pen_dots(pen, spots, BLUE, 2.4)


def fold_angle(pen: Pen) -> None:
    pen.line((2.5, 18.0), (12.0, 18.0), (20.5, 7.0), width=2.0)
    pen.line(*arc((12.0, 18.0), 7.0, 180, 308), colour=ORANGE, width=1.6)
    pen.dot((12.0, 18.0), 2.2)


def vertex_neighbours(pen: Pen) -> None:
    ring = [(12.0 + 8.6 * math.cos(k * math.pi / 3), 12.0 + 8.6 * math.sin(k * math.pi / 3)) for k in range(6)]
    for spot in ring:
        pen.line((12.0, 12.0), spot, width=1.3)
    pen_dots(pen, ring, BLUE, 2.1)
    pen.dot((12.0, 12.0), 2.7, ORANGE)


def mesh_map(pen: Pen) -> None:
    pen.line(*[(1.5 + 8.0 * i, 18.5) for i in (0, 1)], colour=BLUE, width=1.8)
    pen.line(*bent((13.0, 20.5), (17.5, 15.0), (22.5, 20.5)), colour=BLUE, width=1.8)
    pen.dot((5.5, 12.5), 2.2)
    pen.dot((17.8, 11.0), 2.2, ORANGE)
    pen.line(*bent((5.5, 8.5), (11.5, 1.0), (17.0, 7.0)), width=1.3)


def split_at_corners(pen: Pen) -> None:
    pen.line((3.0, 20.5), (7.5, 6.5), width=2.0)
    pen.line((10.0, 4.8), (20.0, 9.2), colour=BLUE, width=2.0)
    pen.line((20.5, 12.4), (14.5, 21.0), width=2.0)
    pen_dots(pen, ((8.2, 4.4), (21.2, 10.4)), ORANGE, 2.2)


def remesh(pen: Pen) -> None:
    for j in range(4):
        y = 3.0 + 6.0 * j
        pen.line((3.0, y), (21.0, y), colour=BLUE, width=1.3)
    for i in range(-3, 4):
        for lean in (3.0, -3.0):
            points = [(12.0 + 6.0 * i + lean * (k - 1.5), 3.0 + 6.0 * k) for k in range(4)]
            inside = [spot for spot in points if 2.9 < spot[0] < 21.1]
            if len(inside) > 1:
                pen.line(*inside, colour=BLUE, width=1.3)


def interconnect_points(pen: Pen) -> None:
    spots = [(12.0 + 9.0 * math.sin(k * 0.4 * math.pi), 12.5 - 9.0 * math.cos(k * 0.4 * math.pi)) for k in range(5)]
    for k, spot in enumerate(spots):
        for other in spots[k + 1 :]:
            pen.line(spot, other, width=1.1)
    pen_dots(pen, spots, BLUE, 2.3)


def bipartite(pen: Pen) -> None:
    for a, b in ((0, 0), (0, 1), (1, 0), (1, 2), (2, 1), (2, 2)):
        pen.line((5.0, 4.0 + 8.0 * a), (19.0, 4.0 + 8.0 * b), width=1.2)
    pen_dots(pen, [(5.0, 4.0 + 8.0 * k) for k in range(3)], BLUE, 2.5)
    pen_dots(pen, [(19.0, 4.0 + 8.0 * k) for k in range(3)], ORANGE, 2.5)


def moebius_transformation(pen: Pen) -> None:
    for radius, lift in ((9.5, 0.0), (5.5, 3.2), (2.2, 5.4)):
        pen.line(*arc((12.0, 12.0 - lift), radius, 0, 360), colour=BLUE, width=1.4)
    pen.arrow((12.0, 21.0), (12.0, 8.0))


def pipes(pen: Pen) -> None:
    for end in ((2.5, 19.5), (21.5, 19.5), (12.0, 2.0)):
        pen.line((12.0, 13.0), end, colour=INK, width=6.4)
        pen.line((12.0, 13.0), end, colour=(214, 228, 240, 255), width=4.0)
    pen.dot((12.0, 13.0), 4.6, BLUE)


def align_quads(pen: Pen) -> None:
    squares(pen, PALE, 1.0)
    for j in range(3):
        pen.arrow((4.0, 6.0 + 6.0 * j), (20.5, 6.0 + 6.0 * j), width=1.3, head=3.4)


def turn_quads(pen: Pen) -> None:
    pen.line(*CORNERS, closed=True, colour=PALE, width=1.4)
    path = arc((12.0, 12.0), 5.6, 180, 430)
    pen.line(*path, colour=ORANGE, width=1.8)
    pen.arrow(path[-2], (path[-1][0] + 1.2, path[-1][1] + 1.4), head=4.4)


def strips(pen: Pen) -> None:
    for k, colour in enumerate((BLUE, PALE, ORANGE)):
        x = 3.0 + 6.2 * k
        pen.area((x, 3.0), (x + 5.6, 3.0), (x + 5.6, 21.0), (x, 21.0), colour=(*colour[:3], 90))
        for y in (3.0, 9.0, 15.0, 21.0):
            pen.line((x, y), (x + 5.6, y), colour=colour, width=1.2)


def unroll_strips(pen: Pen) -> None:
    pen.line(*arc((8.0, 10.0), 6.0, 90, 360), width=1.8)
    pen.line((8.0, 16.0), (22.0, 16.0), colour=BLUE, width=2.2)
    for x in (10.0, 14.0, 18.0, 22.0):
        pen.line((x, 14.0), (x, 18.0), colour=BLUE, width=1.3)


def reciprocal_diagram(pen: Pen) -> None:
    for end in ((2.5, 5.0), (21.5, 5.0), (12.0, 22.0)):
        pen.line((12.0, 11.0), end, width=1.6)
    pen.line((12.0, 3.5), (18.5, 15.5), (5.5, 15.5), closed=True, colour=ORANGE, width=1.6)


def live_film(pen: Pen) -> None:
    for y in (4.0, 20.0):
        pen.line(*[(12.0 + 9.5 * math.cos(k * 0.2618), y + 2.4 * math.sin(k * 0.2618)) for k in range(24)], closed=True,
                 width=1.5)  # fmt: skip
    for side in (-1.0, 1.0):
        neck = [(12.0 + side * (5.0 + 4.5 * (k / 4.0) ** 2), 12.0 + 2.0 * k) for k in range(-4, 5)]
        pen.line(*neck, colour=BLUE, width=1.8)
    for k in range(-2, 3):
        pen.line((12.0 - 4.6, 12.0 + 3.0 * k), (12.0 + 4.6, 12.0 + 3.0 * (k + (1 if k % 2 else -1) * 0.5)), colour=PALE,
                 width=1.0)  # fmt: skip


def counter(pen: Pen) -> None:
    for k in range(4):
        pen.line((4.0 + 4.2 * k, 4.5), (4.0 + 4.2 * k, 19.5), width=2.0)
    pen.line((1.8, 16.0), (20.6, 8.0), colour=ORANGE, width=2.0)


def sequence(pen: Pen) -> None:
    for k, colour in enumerate((PALE, BLUE, ORANGE)):
        x, y = 3.0 + 4.0 * k, 3.0 + 4.0 * k
        pen.area((x, y), (x + 10.0, y), (x + 10.0, y + 10.0), (x, y + 10.0), colour=GLASS)
        pen.line((x, y), (x + 10.0, y), (x + 10.0, y + 10.0), (x, y + 10.0), closed=True, colour=colour, width=1.6)


def trail(pen: Pen) -> None:
    path = wave(12.0, 6.0)
    pen.line(*path, colour=PALE, width=1.4)
    pen_dots(pen, path[::4], BLUE, 1.3)
    pen.dot(path[-1], 2.8, ORANGE)


def variables(pen: Pen) -> None:
    for y, x in ((5.5, 8.0), (12.0, 16.5), (18.5, 11.0)):
        pen.line((2.5, y), (21.5, y), width=1.5)
        pen.dot((x, y), 2.6, ORANGE)


def goals(pen: Pen) -> None:
    for radius in (9.0, 5.2):
        pen.ring((12.0, 12.0), radius, BLUE, 1.7)
    pen.dot((12.0, 12.0), 2.4, ORANGE)


def constraints(pen: Pen) -> None:
    pen.line((2.5, 4.0), (21.5, 4.0), colour=BLUE, width=1.8)
    pen.line((2.5, 20.0), (21.5, 20.0), colour=BLUE, width=1.8)
    pen.line(*[(2.5 + 19 * i / 40, 12.0 - 5.6 * math.sin(i / 5.0)) for i in range(41)], colour=ORANGE, width=1.8)


def design(pen: Pen) -> None:
    for control, colour in ((14.0, PALE), (22.0, PALE), (31.0, BLUE)):
        pen.line(*bent((3.0, 4.0), (12.0, control), (21.0, 4.0)), colour=colour, width=1.7)
    pen.ring((12.0, 17.6), 3.6, ORANGE, 1.6)
    pen.dot((12.0, 17.6), 1.4, ORANGE)


DRAWINGS: dict[str, Callable[[Pen], None]] = {
    draw.__name__.replace("_", ""): draw
    for draw in (
        *(remove_duplicate_points, combine_clean, refine, refine_strips, diagonalize, checkerboard, hinge_points),
        *(fold_angle, vertex_neighbours, mesh_map, split_at_corners, remesh, counter, sequence, trail),
        *(interconnect_points, bipartite, moebius_transformation, pipes, align_quads, turn_quads, strips),
        *(unroll_strips, reciprocal_diagram, live_film),
        *(variables, goals, constraints, design, load_case, combination, load_cases),
    )
}
"""Drawings by the name of the bundle, in small letters without blanks."""
