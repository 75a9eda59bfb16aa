"""Lines on a mesh: lines of equal height, and the ways of water that runs down."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hookean.discretize.duplicates import _checked
from hookean.discretize.mapping import Closest
from hookean.discretize.meshes import as_mesh, boundary, triangles
from hookean.errors import InputError
from hookean.values.mesh import Mesh

Array = NDArray[np.float64]
Index = NDArray[np.int64]

MOST_LEVELS = 1000
LINES = 20  # levels at most where no step is given
NEAR = 1e-9  # barycentric: nearer to a corner is at the corner


@dataclass(frozen=True, eq=False)
class HeightLines:
    """Pieces `(k, 2, 3)` [length] of lines of equal height, the `heights` `(k,)` [length] of each, and the `step`
    [length] from line to line."""

    pieces: Array
    heights: Array
    step: float


@dataclass(frozen=True, eq=False)
class WaterLines:
    """Ways of drops of water: `lines`, points `(k, 3)` [length] of each from top to bottom, and whether each `stays`
    `(m,)` on the surface, in a hollow or on a level face, where others run off its boundary."""

    lines: list[Array]
    stays: NDArray[np.bool_]


def height_lines(mesh: Any, step: float | None = None) -> HeightLines:
    """Lines of equal height on a mesh, at the multiples of `step` [length]; default: 1, 2 or 5 times a power of ten, so
    that there are 20 lines at most.

    Heights are linear in each triangle (quads are cut along their shorter diagonals), so the error on a smooth surface
    is of second order in the size of the faces. A level face has no lines. Raises InputError for a step that is not
    positive or makes more than 1000 levels.
    """
    m = as_mesh(mesh)
    z = m.vertices[np.unique(m.faces), 2]
    low, high = (float(z.min()), float(z.max())) if len(z) else (0.0, 0.0)
    if step is None:
        step = _round_step((high - low) / LINES)
    if not (np.isfinite(step) and step > 0.0):
        raise InputError("step", f"{step!r} given; give a length above 0")
    if (high - low) / step > MOST_LEVELS:
        said = f"{step:g} given, for heights from {low:g} to {high:g}; at most {MOST_LEVELS} levels: give a longer one"
        raise InputError("step", said)
    t = triangles(m)
    levels = step * np.arange(np.ceil(low / step), np.floor(high / step) + 1.0)
    pieces = [_level(m.vertices, t, float(level)) for level in levels]
    heights = [np.full(len(some), level) for some, level in zip(pieces, levels, strict=True)]
    none: Array = np.zeros((0, 2, 3))
    return HeightLines(np.concatenate([none, *pieces]), np.concatenate([np.zeros(0), *heights]), float(step))


def water_lines(mesh: Any, points: ArrayLike | None = None, count: int = 200) -> WaterLines:
    """Ways of drops of water on a mesh: from each point down along the steepest descent, to the boundary or to where
    the drop stays, in a hollow or on a level face.

    In a triangle a drop runs against the gradient of its height, along an edge between two triangles that both slope
    towards it, from a vertex in the steepest of all directions, and across a level face to a corner with a lower
    neighbour. The ways are exact for the flat triangles; quads are cut along the diagonal whose middle is lower, so
    that no cut is a dam.

    - `points`: Where drops fall (k, 3) [length]; each starts on the closest triangle. Default: on the middles of
      `count` triangles at most, evenly chosen from all.

    Raises InputError for points that are not rows of three numbers, or a mesh without faces if there are points.
    Source: de Berg et al., Trekking in the Alps without freezing or getting tired, 1997 (trickle paths).
    """
    m = as_mesh(mesh)
    t = _undammed(m)
    if not len(t):
        if points is not None and len(np.asarray(points)):
            raise InputError("mesh", "it has no faces; give a mesh with faces")
        return WaterLines([], np.zeros(0, bool))
    if points is None:
        chosen = np.linspace(0, len(t) - 1, min(count, len(t))).round().astype(np.int64)
        starts = m.vertices[t[chosen]].mean(axis=1)
    else:
        given = _checked("points", points, (3,))
        chosen, starts = Closest(m.vertices, t)(given)[:2]
    slopes = _Slopes(m.vertices, t, boundary(m)[0])
    ways = [slopes.way(int(first), start) for first, start in zip(chosen, starts, strict=True)]
    return WaterLines([np.array(line) for line, _ in ways], np.array([stays for _, stays in ways], bool))


def _undammed(mesh: Mesh) -> Index:
    """Triangles (t, 3) of a mesh, quads cut along the diagonal with the lower middle; of equals along the shorter."""
    a, b, c, d = mesh.faces.T
    z = mesh.vertices[:, 2]
    one, other = z[a] + z[c], z[b] + z[d]
    quad = c != d
    size = np.abs(z).max(initial=0.0)
    turned = np.where(quad & (other < one - 1e-12 * size), 1, 0)
    level = quad & (np.abs(other - one) <= 1e-12 * size)
    rolled = np.take_along_axis(mesh.faces, (np.arange(4) + turned[:, None]) % 4, axis=1)
    a, b, c, d = rolled[quad & ~level].T
    cut = np.stack([np.stack([a, b, c], 1), np.stack([a, c, d], 1)], 1).reshape(-1, 3)
    return np.concatenate([mesh.faces[~quad, :3], cut, triangles(Mesh(mesh.vertices, mesh.faces[level]))])


def _round_step(step: float) -> float:
    """The next of 1, 2 and 5 times a power of ten."""
    if not step > 0.0:
        return 1.0
    power = 10.0 ** np.floor(np.log10(step))
    return float(power * next(part for part in (1.0, 2.0, 5.0, 10.0) if part * power >= step * (1.0 - 1e-12)))


def _level(x: Array, t: Index, level: float) -> Array:
    """Pieces (k, 2, 3) of the line at one height. A corner at this height counts as above, so that lines through
    vertices are neither doubled nor interrupted."""
    above = x[t, 2] >= level
    count = above.sum(axis=1)
    cut = (count == 1) | (count == 2)
    rows, t = above[cut], t[cut]
    alone = np.where(count[cut, None] == 1, rows, ~rows).argmax(axis=1)  # the corner on the other side of the two
    own = np.arange(len(t))
    peak = x[t[own, alone]]
    ends = [x[t[own, (alone + k) % 3]] for k in (1, 2)]
    parts = [(level - peak[:, 2]) / (end[:, 2] - peak[:, 2]) for end in ends]
    found: Array = np.stack(
        [peak + part[:, None] * (end - peak) for part, end in zip(parts, ends, strict=True)], axis=1
    )
    found[..., 2] = level
    seen: Array = found[np.linalg.norm(found[:, 0] - found[:, 1], axis=1) > 0.0]
    return seen


class _Slopes:
    """Triangles with the direction in which water runs in each."""

    def __init__(self, x: Array, t: Index, naked: Index) -> None:
        self.x, self.t = x, t
        self.naked = set(naked.tolist())
        a, b, c = x[t].transpose(1, 0, 2)
        normal = np.cross(b - a, c - a)
        twice = (normal**2).sum(axis=1, keepdims=True)
        safe = np.where(twice > 0.0, twice, 1.0)
        self.down = normal * normal[:, 2:] / safe - [0.0, 0.0, 1.0]  # -z without its part across the plane
        self.down[twice[:, 0] == 0.0] = 0.0
        sides = np.stack([np.cross(normal, c - b), np.cross(normal, a - c), np.cross(normal, b - a)], axis=1)
        self.rates = sides / safe[:, None]  # gradients of the barycentric coordinates
        self.change = np.einsum("tkc,tc->tk", self.rates, self.down)
        self.steep = np.linalg.norm(self.down, axis=1)  # the sine of the slope
        self.of_edge: dict[tuple[int, int], list[int]] = {}
        self.of_vertex: dict[int, list[int]] = {}
        for number, corners in enumerate(t.tolist()):
            for k, corner in enumerate(corners):
                self.of_vertex.setdefault(corner, []).append(number)
                self.of_edge.setdefault(_edge(corner, corners[k - 1]), []).append(number)

    def way(self, triangle: int, start: Array) -> tuple[list[Array], bool]:
        """Points of the way of a drop, and whether it stays on the surface."""
        line, corner = [np.asarray(start, float)], None
        for _ in range(10 * len(self.t) + 100):  # steps go down
            if corner is not None:
                if not np.array_equal(line[-1], self.x[corner]):
                    line.append(self.x[corner])
                if corner in self.naked:
                    return line, False
                _, following, corner = self._from(corner)
                if following is None and corner is None:
                    return line, True
                triangle = triangle if following is None else following
                continue
            step = self._across(triangle, line[-1])
            if step is None:
                corner = self._outlet(self.t[triangle].tolist())
            else:
                point, corner, edge = step
                line.append(point)
                if corner is not None:
                    continue
                following, corner = self._over(triangle, edge)
                if following is not None:
                    triangle = following
                    continue
                if len(self.of_edge[edge]) == 1:
                    return line, False
                corner = self._outlet(list(edge)) if corner is None else corner
            if corner is None:
                return line, True
        return line, True

    def _across(self, triangle: int, point: Array) -> tuple[Array, int | None, tuple[int, int]] | None:
        """Where a drop leaves a triangle: the point, its corner if it is one, and the edge; None where it is level."""
        corners, change = self.t[triangle], self.change[triangle]
        own = np.einsum("kc,kc->k", self.rates[triangle], point - self.x[np.roll(corners, -1)])
        with np.errstate(divide="ignore", invalid="ignore"):
            times = np.where(change < 0.0, np.maximum(own, 0.0) / -change, np.inf)
        k = int(times.argmin())
        if not np.isfinite(times[k]) or self.steep[triangle] < NEAR:
            return None
        left = own + times[k] * change
        left[k] = -np.inf
        edge = _edge(int(corners[(k + 1) % 3]), int(corners[(k + 2) % 3]))
        if left.max() > 1.0 - NEAR:
            corner = int(corners[left.argmax()])
            return self.x[corner], corner, edge
        return point + times[k] * self.down[triangle], None, edge

    def _over(self, triangle: int, edge: tuple[int, int]) -> tuple[int | None, int | None]:
        """The triangle on the other side of an edge if water runs into it, else the lower corner of the edge; neither
        on the boundary, nor where the edge is level."""
        beyond = next((other for other in self.of_edge[edge] if other != triangle), None)
        if beyond is None:
            return None, None
        k = next(k for k, corner in enumerate(self.t[beyond].tolist()) if corner not in edge)
        if self.change[beyond, k] > 0.0:
            return beyond, None
        one, other = (float(self.x[corner, 2]) for corner in edge)
        return None, None if one == other else edge[one > other]

    def _from(self, corner: int) -> tuple[float, int | None, int | None]:
        """The triangle or the corner into or to which water runs from a corner, whichever is steepest, and the sine of
        that slope; 0 and neither in a hollow."""
        best, into, to = NEAR, None, None
        z = self.x[corner]
        for triangle in self.of_vertex[corner]:
            corners = self.t[triangle].tolist()
            opens = min(self.change[triangle, k] for k in range(3) if corners[k] != corner) > 0.0
            if opens and self.steep[triangle] > best:
                best, into, to = float(self.steep[triangle]), triangle, None
            for other in corners:
                apart = self.x[other] - z
                if -apart[2] > best * np.linalg.norm(apart):
                    best, into, to = float(-apart[2] / np.linalg.norm(apart)), None, other
        return best if into is not None or to is not None else 0.0, into, to

    def _outlet(self, corners: list[int]) -> int | None:
        """Of the corners of a level face or edge the one from which water runs on most steeply; None where it stays."""
        slopes = [self._from(corner)[0] for corner in corners]
        return corners[int(np.argmax(slopes))] if max(slopes) > 0.0 else None


def _edge(one: int, other: int) -> tuple[int, int]:
    return (one, other) if one < other else (other, one)
