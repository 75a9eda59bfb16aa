"""Forces that pull each group of particles to the plane, line, sphere or circle that is nearest to it."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np

from hookean.compiled import dispatch
from hookean.forces import groups
from hookean.forces.base import Block, Floats, OnFilm, Places
from hookean.forces.fits import (
    CIRCLE,
    KIND,
    LINE,
    NORMAL,
    PLANE,
    POINT,
    RADIUS,
    SIZE,
    SPHERE,
    STRENGTH,
    WIDE,
    U,
    find_fits,
    fit_kernel,
)  # fmt: skip
from hookean.forces.pull_to_mesh import away
from hookean.values.columns import IndexRows, Labels, NonNegatives, Points
from hookean.values.fields import Field, Maybe


class Fit(groups.Grouped):
    """Base of forces with E = sum k d^2 / 2, d the distance of each particle of a group to the shape for which this is
    least.

    As the energy is stationary by the shape, the force on a particle is k d towards it, exactly.
    """

    formula: ClassVar[str] = "E = Σ k d²/2"
    solid: ClassVar[bool] = False
    steady: ClassVar[str] = "strength"
    on_film: ClassVar[OnFilm] = "spread"
    outputs: ClassVar[dict[str, str]] = {"distance": "length", "force": "force"}
    kernel: ClassVar[Any] = staticmethod(fit_kernel)
    shape: ClassVar[float] = PLANE
    axes: ClassVar[tuple[int, ...]] = (2, 4, 5)  # of the shape that are unknown, see `second`

    def measure(self, block: Block, x: Floats, element_forces: Floats) -> dict[str, Floats]:
        """Distance to the shape [length], the force on the particle [force], and a radius [length], infinite where a
        group is flat."""
        found = away(block, element_forces, STRENGTH)
        if "radius" in self.outputs:
            fit = fits(block, x)
            found["radius"] = np.where(fit[:, RADIUS] > 0.0, fit[:, RADIUS], np.inf)
        return found

    @classmethod
    def second(cls, block: Block, memory: Floats, x: Floats) -> Floats:
        """Of k d^2 / 2 by a particle and its shape."""
        return second(block, x, cls.axes)

    @classmethod
    def __pydantic_init_subclass__(cls, **given: Any) -> None:
        super().__pydantic_init_subclass__(**given)
        cls.unknowns = len(cls.axes)


class Fitted(Fit):
    """Base of those whose particles and groups are given."""

    particles: Maybe[IndexRows] = Field(default=None, description="Particles")
    points: Maybe[Points] = Field(default=None, description="Coordinates of particles")
    group: Maybe[Labels] = Field(
        default=None, description="Number of the group of each particle; default: all are in one"
    )
    strength: NonNegatives = Field(default=1000.0, description="k [force/length]")

    creates: ClassVar[bool] = False

    def compile(self, places: Places) -> Block:
        """Arrays for the kernel: links of the groups, strength and shape."""
        index = places.elements(self)
        return Block.of(index, links=groups.links(index, self.group), strength=self.strength, shape=self.shape)


def fits(block: Block, x: Floats) -> Floats:
    """The fit of the group of each particle (m, WIDE), see `hookean.forces.fits`."""
    found = np.zeros((len(block.indices), WIDE))
    dispatch.compiled(find_fits)(x, block.indices, block.parameters, found)
    return found


def second(block: Block, x: Floats, axes: tuple[int, ...]) -> Floats:
    """Second derivatives (m, 3 + q, 3 + q) of k d^2 / 2 by a particle and the q `axes` of its shape: 0 to 2 its place
    in the frame of the fit, 3 its radius, 4 and 5 its tilts."""
    fit = fits(block, x)
    kind, frame = fit[:, KIND], fit[:, U : NORMAL + 3].reshape(-1, 3, 3)
    y = np.einsum("mij,mj->mi", frame, x[block.indices[:, 0]] - fit[:, POINT : POINT + 3])
    whole = np.zeros((len(y), 9, 9))
    for kinds, found in (((PLANE,), _of_plane), ((LINE,), _of_line), ((SPHERE, CIRCLE), _of_round)):
        rows = np.isin(kind, kinds)
        whole[rows] = found(y[rows], fit[rows])
    turn = np.tile(np.eye(9), (len(y), 1, 1))
    turn[:, :3, :3] = frame.transpose(0, 2, 1)
    turn[:, 7, 7] = turn[:, 8, 8] = 1.0 / np.where(fit[:, SIZE] > 0.0, fit[:, SIZE], 1.0)
    whole = block.parameters[:, STRENGTH, None, None] * (turn @ whole @ turn.transpose(0, 2, 1))
    taken = np.array([0, 1, 2, *(3 + axis for axis in axes)])
    return np.ascontiguousarray(whole[:, taken[:, None], taken])


def _of_plane(y: Floats, fit: Floats) -> Floats:
    """Of d^2 / 2, d = n . y, by place, shape's place, radius and tilts."""
    slope, bend = np.zeros((len(y), 9)), np.zeros((len(y), 9, 9))
    slope[:, 2], slope[:, 5], slope[:, 7:] = 1.0, -1.0, y[:, :2]
    for axis in (0, 1):
        bend[:, axis, 7 + axis] = bend[:, 7 + axis, axis] = 1.0
        bend[:, 3 + axis, 7 + axis] = bend[:, 7 + axis, 3 + axis] = -1.0
        bend[:, 7 + axis, 7 + axis] = -y[:, 2]
    found: Floats = slope[:, :, None] * slope[:, None] + y[:, 2, None, None] * bend
    return found


def _of_line(y: Floats, fit: Floats) -> Floats:
    """Of the square of the distance from an axis, halved."""
    return _half_square(y, np.ones(len(y)))[1]


def _of_round(y: Floats, fit: Floats) -> Floats:
    """Of |y|^2 / 2 - r rho + r^2 / 2, rho the distance from the centre or the axis."""
    level = (fit[:, KIND] == CIRCLE).astype(np.float64)
    slope, bend = _half_square(y, level)
    rho, r = np.sqrt((y**2).sum(axis=1) - level * y[:, 2] ** 2), fit[:, RADIUS]
    inverse = np.where(rho > 1e-9 * r, 1.0 / np.where(rho > 0.0, rho, 1.0), 0.0)[:, None, None]
    whole = -r[:, None, None] * inverse * (bend - inverse**2 * slope[:, :, None] * slope[:, None])
    for axis in range(3):
        ends = np.array([axis, 3 + axis])
        whole[:, ends[:, None], ends] += [[1.0, -1.0], [-1.0, 1.0]]
    whole[:, 6] -= inverse[:, 0] * slope
    whole[:, :, 6] -= inverse[:, 0] * slope
    whole[:, 6, 6] += 1.0
    return whole


def _half_square(y: Floats, level: Floats) -> tuple[Floats, Floats]:
    """Gradient (m, 9) and Hessian (m, 9, 9) of |y|^2 / 2, with `level` 1 of its part across the axis."""
    slope, bend = np.zeros((len(y), 9)), np.zeros((len(y), 9, 9))
    a, b, h = y.T
    slope[:, :2], slope[:, 2] = y[:, :2], (1.0 - level) * h
    slope[:, 3:6] = -slope[:, :3]
    slope[:, 7], slope[:, 8] = -level * h * a, -level * h * b
    for axis in range(3):
        ends = np.array([axis, 3 + axis])
        size = 1.0 - level if axis == 2 else np.ones(len(y))
        bend[:, ends[:, None], ends] = size[:, None, None] * np.array([[1.0, -1.0], [-1.0, 1.0]])
    for tilt, along in ((7, 0), (8, 1)):
        for place, value in ((along, h), (2, y[:, along])):
            bend[:, place, tilt] = bend[:, tilt, place] = -level * value
            bend[:, 3 + place, tilt] = bend[:, tilt, 3 + place] = level * value
        bend[:, tilt, tilt] = level * (h**2 - y[:, along] ** 2)
    bend[:, 7, 8] = bend[:, 8, 7] = -level * a * b
    return slope, bend
