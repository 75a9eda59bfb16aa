"""Circle image: circles, as large as an image says where they are, that push each other apart."""

from __future__ import annotations

from typing import Any, ClassVar, Literal, Self

import numpy as np
from pydantic import model_validator

from hookean.compiled import dispatch
from hookean.compiled.dispatch import keep, rows
from hookean.compiled.marks import device
from hookean.forces import groups
from hookean.forces.base import Block, Floats, Force, Ints, Places
from hookean.forces.collide import Crowd, crowd, overlapping
from hookean.forces.crowd_rows import NEAREST, SKIN, STIFFNESS, end_of_crowd
from hookean.forces.neighbours import order_in, pairs_listed, tables
from hookean.forces.runs import ends
from hookean.forces.strays import listed, some_pairs
from hookean.values.columns import IndexRows, Labels, Points, Table, fault
from hookean.values.fields import Field, Maybe

# columns of the parameters: address of the table, its numbers along x and y, its corner, size of a pixel
IMAGE, WIDE, TALL, LEFT, PIXEL = 7, 8, 9, 10, 12
SHORTEST = 1e-40  # side below which an image has none: squares of its slopes would overflow
R, X, Y, XX, XY, YY = range(6)  # of a place: radius, its slopes and its second derivatives
ROOM = 4  # column of the address of the room


@device
def weights(at: Any, count: Any, b: Any) -> Any:
    """The pixel about a place, in pixels from the middle of the first, and the weights (3, 3) of it and its neighbours
    with their derivatives: a quadratic B-spline. Beyond its rim the image goes on as there."""
    at = min(max(at, -2.0), count + 1.0)
    middle = np.floor(at + 0.5)
    s = at - middle
    b[0, 0], b[0, 1], b[0, 2] = 0.5 * (0.5 - s) * (0.5 - s), 0.75 - s * s, 0.5 * (0.5 + s) * (0.5 + s)
    b[1, 0], b[1, 1], b[1, 2] = s - 0.5, -2.0 * s, s + 0.5
    b[2, 0], b[2, 1], b[2, 2] = 1.0, -2.0, 1.0
    return int(middle)


@device
def radius_at(parameters: Any, e: Any, x: Any, y: Any, b: Any, g: Any) -> None:
    """Write the radius at a place and its derivatives, (6,)."""
    wide, tall = int(parameters[e, WIDE]), int(parameters[e, TALL])
    table = rows(parameters[e, IMAGE], parameters[e, WIDE] * parameters[e, TALL], 1)
    across, along = parameters[e, PIXEL], parameters[e, PIXEL + 1]
    i = weights((x - parameters[e, LEFT]) / across - 0.5, wide, b[0:3])
    j = weights((y - parameters[e, LEFT + 1]) / along - 0.5, tall, b[3:6])
    for c in range(6):
        g[c] = 0.0
    for p in range(3):
        column = min(max(i + p - 1, 0), wide - 1)
        for q in range(3):
            value = table[min(max(j + q - 1, 0), tall - 1) * wide + column, 0]
            g[R] += b[0, p] * b[3, q] * value
            g[X] += b[1, p] * b[3, q] * value / across
            g[Y] += b[0, p] * b[4, q] * value / along
            g[XX] += b[2, p] * b[3, q] * value / (across * across)
            g[XY] += b[1, p] * b[4, q] * value / (across * along)
            g[YY] += b[0, p] * b[5, q] * value / (along * along)


@device
def steepness(g: Any) -> Any:
    """Of the radius."""
    return np.sqrt(g[X] * g[X] + g[Y] * g[Y])


@device
def press(here, sums, counts, i, j, parameters, start, b, g) -> Any:  # type: ignore[no-untyped-def]
    """Add the forces of two circles, and what they count for the stiffness; returns their energy."""
    square, stiffness = 0.0, parameters[start, STIFFNESS]
    for c in range(3):
        square += (here[j, c] - here[i, c]) * (here[j, c] - here[i, c])
    length, reach = np.sqrt(square), here[i, 3] + here[j, 3]
    if length >= reach + parameters[start, SKIN]:
        return 0.0
    overlap = max(reach - length, 0.0)
    radius_at(parameters, start, here[i, 0], here[i, 1], b, g[0])
    radius_at(parameters, start, here[j, 0], here[j, 1], b, g[1])
    steep = 2.0 + steepness(g[0]) + steepness(g[1])
    for side in range(2):
        own = i if side == 0 else j
        bend = g[side, XX] * g[side, XX] + 2.0 * g[side, XY] * g[side, XY] + g[side, YY] * g[side, YY]
        counts[own] += (1.0 + steepness(g[side])) * steep + overlap * np.sqrt(bend)
        for c in range(3):
            away = (here[j, c] - here[i, c]) / length if length > NEAREST else 0.0
            slope = (away if side == 0 else -away) + (g[side, X + c] if c < 2 else 0.0)
            sums[own, c] -= stiffness * overlap * slope
    return 0.5 * stiffness * overlap * overlap


def circle_kernel(x, v, indices, parameters, memory, f, w):  # type: ignore[no-untyped-def]
    energy, b, g, stop = 0.0, np.zeros((6, 3)), np.zeros((2, 6)), 0
    while stop < indices.shape[0]:
        start = stop
        room, skin, stop = parameters[start, ROOM], parameters[start, SKIN], end_of_crowd(parameters, start)
        size, several = stop - start, 1
        here, sums, counts = tables(room, size)
        order = order_in(room, size)
        # the list has all that would touch as large as they can be
        short = listed(x, indices, parameters, start, here, sums, counts, order, room, skin)
        pairs, reach, number = pairs_listed(room)
        if not short:
            pairs, reach, several = np.empty(size, np.int64), np.empty(size), size
        for i in range(size):
            radius_at(parameters, start, here[i, 0], here[i, 1], b, g[0])
            here[i, 3] = g[0, R]
        for row in range(several):
            if not short:
                number = some_pairs(parameters, start, order, row, pairs, reach)
            for n in range(number):
                one, other = ends(pairs[n])
                energy += press(here, sums, counts, one, other, parameters, start, b, g)
        for i in range(size):
            a = indices[start + int(order[i]), 0]
            w[a] += parameters[start, STIFFNESS] * (2.0 + counts[i])
            for c in range(3):
                f[a, c] += sums[i, c]
    return energy


def radii(x, indices, parameters, found):  # type: ignore[no-untyped-def]
    """Write the radius of every circle and its derivatives (m, 6)."""
    b = np.zeros((6, 3))
    for e in range(indices.shape[0]):
        radius_at(parameters, e, x[indices[e, 0], 0], x[indices[e, 0], 1], b, found[e])


class CircleImage(Crowd):
    """Circles, as large as an image says where they are, that push each other apart: E = k (R(p) + R(q) - d)^2 / 2.

    d is the distance of two centres, and the radius R at each is that of the image there, by x and y: a grid of numbers
    from 0 to 1 over a rectangle, 0 for the smallest radius and 1 for the largest. Between the numbers R is a quadratic
    B-spline, which follows linear images exactly, blurs edges by about a pixel and has no creases. Overlapping circles
    are also pushed to where they are smaller, as the energy has it: the image carries that part of the forces, so their
    sum is not zero. Circles that just touch feel nothing. For a fixed radius of each circle see `collide`. Those of one
    `collision_group` ignore each other.
    """

    kind: Literal["circle_image"] = "circle_image"
    particles: Maybe[IndexRows] = Field(default=None, description="Particles in the centres of circles")
    points: Maybe[Points] = Field(default=None, description="Coordinates of the centres of circles")
    image: Table = Field(description="Rows of numbers from 0 to 1 [-], the first row at the lowest y")
    corners: Points = Field(description="Two opposite corners of the image [length]; their z is ignored")
    minimum_radius: float = Field(default=0.2, gt=0, le=1e12, description="Radius where the image is 0 [length]")
    maximum_radius: float = Field(default=1.0, gt=0, le=1e12, description="Radius where the image is 1 [length]")
    strength: float = Field(default=1000.0, ge=0, le=1e12, description="k, stiffness of a contact [force/length]")
    collision_group: Maybe[Labels] = Field(
        default=None, description="A number for each circle [-]: those of one group ignore each other; 0: of no group"
    )

    formula: ClassVar[str] = "E = k (R(p) + R(q) - d)²/2"
    role: ClassVar[Literal["internal", "load", "support"]] = "support"
    shared: ClassVar[tuple[str, ...]] = ("image", "corners")
    outputs: ClassVar[dict[str, str]] = {"radius": "length", "force": "force"}
    kernel: ClassVar[Any] = staticmethod(circle_kernel)

    @model_validator(mode="after")
    def _is_an_image(self) -> Self:
        if self.image.ndim != 2 or not self.image.size:
            raise fault(f"shape {list(self.image.shape)} given; rows of numbers expected", "/image")
        if self.image.min() < 0.0 or self.image.max() > 1.0:
            said = f"{self.image.min():g} to {self.image.max():g} given; numbers from 0 to 1 allowed"
            raise fault(said, "/image")
        if len(self.corners) != 2 or not (np.ptp(self.corners[:, :2], axis=0) > SHORTEST).all():
            raise fault("two opposite corners of a rectangle expected, apart along x and y", "/corners")
        return self

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: those of all that collide, and the table of radii with its place."""
        index = places.elements(self)
        low, size = self.corners[:, :2].min(axis=0), np.ptp(self.corners[:, :2], axis=0)
        span = self.maximum_radius - self.minimum_radius
        table = keep((self.minimum_radius + span * self.image).reshape(-1, 1))
        each, (tall, wide) = np.ones((len(index), 1)), self.image.shape
        numbers = [table, wide, tall, *low, *(size / [wide, tall])]
        largest = max(self.minimum_radius, self.maximum_radius)
        ends = np.repeat(index, 2, axis=1)
        return crowd(places, index, largest, self.collision_group, self.strength, joints=ends, image=each * [numbers])

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """Radius of each circle where it is [length], and the force of all contacts on it [force]."""
        return {"radius": _radii(block, x)[:, R], "force": element_forces.sum(axis=1)}

    @classmethod
    def pack(cls, block: Block, memory: Floats, damped: bool) -> tuple[Ints, Floats] | None:
        """As they are: radii change on the way."""
        return None

    @classmethod
    def gathered(
        cls, block: Block, memory: Floats, x: Floats, node: int | None
    ) -> list[tuple[type[Force], Block]] | None:
        """The pairs that overlap: k (s s' + overlap S), s and S the first and second derivatives of the overlap."""
        pair, field = overlapping(block, x)[0], _radii(block, x)
        away = x[block.indices[pair[:, 1], 0]] - x[block.indices[pair[:, 0], 0]]
        length = np.sqrt((away**2).sum(axis=1))
        overlap = field[pair, R].sum(axis=1) - length
        touching = overlap > 0.0
        pair, away, length, overlap = pair[touching], away[touching], length[touching], overlap[touching]
        away /= np.maximum(length, NEAREST)[:, None]
        slope, bend = np.zeros((len(pair), 2, 3)), np.zeros((len(pair), 2, 3, 2, 3))
        across = (np.eye(3) - away[:, :, None] * away[:, None]) / np.maximum(length, NEAREST)[:, None, None]
        for i in range(2):
            own = field[pair[:, i]]
            slope[:, i] = away if i == 0 else -away
            slope[:, i, :2] += own[:, X : Y + 1]
            bend[:, i, :2, i, :2] = own[:, [[XX, XY], [XY, YY]]]
            bend[:, i, :, i] -= across
            bend[:, i, :, 1 - i] += across
        stiffness = slope.reshape(-1, 6, 1) * slope.reshape(-1, 1, 6)
        stiffness += overlap[:, None, None] * bend.reshape(-1, 6, 6)
        stiffness *= block.parameters[pair[:, 0], STIFFNESS, None, None]
        return [(groups.Whole, groups.stiff(block.indices[pair, 0], stiffness))] if len(pair) else []

    @classmethod
    def example(cls) -> tuple[CircleImage, Floats]:
        """Five circles on an image with a hill, most of which overlap; two ignore each other."""
        x = np.array([[0.0, 0.0, 0.0], [1.0, 0.1, 0.2], [0.4, 0.9, -0.1], [1.3, 1.0, 0.4], [0.7, 0.5, 1.1]])
        image = [[0.1, 0.4, 0.2, 0.0], [0.3, 0.8, 0.7, 0.1], [0.2, 0.5, 0.9, 0.4]]
        force = cls(
            particles=range(5), image=image, corners=[[-1, -1, 0], [2.5, 2, 0]], minimum_radius=0.6,
            strength=50.0, collision_group=[0, 1, 1, 0, 0],
        )  # fmt: skip
        return force, x


def _radii(block: Block, x: Floats) -> Floats:
    found = np.zeros((len(block.indices), 6))
    dispatch.compiled(radii)(np.ascontiguousarray(x), block.indices, block.parameters, found)
    return found
