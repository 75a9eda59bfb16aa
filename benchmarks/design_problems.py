"""Design problems by force densities after the published examples of jax_fdm (MIT), as plain arrays for both programs.

All are in compression there; here densities are positive and loads point up, which has the same shapes. The vault's
target is a formula in the place of a file.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Goal = tuple[str, Ints, Any, float]
"""Kind (z, point, plane, length, force, reaction), particles or edges, targets, weight."""


@dataclass
class Problem:
    """A net, its loads, and goals on its equilibrium. Densities start at `start` (m,) and stay within bounds."""

    name: str
    points: Floats
    edges: Ints
    supports: Ints
    loads: Floats
    start: Floats
    bounds: tuple[float, float]
    goals: list[Goal]
    optimizer: str
    tolerance: float
    most: int

    @property
    def free(self) -> Ints:
        """Particles that move."""
        return np.setdiff1d(np.arange(len(self.points)), self.supports)

    def shape(self, q: Floats) -> tuple[Floats, Floats]:
        """Places (n, 3) and reactions (n, 3): C^T Q C x = p."""
        from scipy.sparse import csr_matrix, diags
        from scipy.sparse.linalg import splu

        m, n = len(self.edges), len(self.points)
        rows = np.tile(np.arange(m), 2)
        c = csr_matrix((np.repeat([-1.0, 1.0], m), (rows, self.edges.T.ravel())), (m, n))
        k = (c.T @ diags(q) @ c).tocsc()
        x, free = self.points.copy(), self.free
        right = self.loads[free] - k[free][:, self.supports] @ x[self.supports]
        x[free] = splu(k[free][:, free].tocsc()).solve(right)
        return x, self.loads - k @ x

    def objective(self, q: Floats) -> float:
        """The sum of weight (value - target)²."""
        x, forces = self.shape(q)
        along = x[self.edges[:, 1]] - x[self.edges[:, 0]]
        length = np.linalg.norm(along, axis=1)
        total = 0.0
        for kind, which, target, weight in self.goals:
            value = {
                "z": lambda w=which: x[w, 2],
                "point": lambda w=which: x[w],
                "plane": lambda w=which: x[w, 0],
                "length": lambda w=which: length[w],
                "force": lambda w=which: q[w] * length[w],
                "reaction": lambda w=which: np.linalg.norm(forces[w], axis=1),
            }[kind]()
            total += weight * float(((value - target) ** 2).sum())
        return total


def up(n: int, supports: Ints, load: float) -> Floats:
    """Loads (n, 3) on all but the supports."""
    found = np.zeros((n, 3))
    found[:, 2] = load
    found[supports] = 0.0
    return found


def arch() -> Problem:
    """An arch of 10 segments to a parabola with a rise of 1.5, its loads one half higher on one side."""
    n, span = 10, 5.0
    points = np.array([[span * (i / n - 0.5), 0.0, 0.0] for i in range(n + 1)])
    edges, supports = np.array([[i, i + 1] for i in range(n)]), np.array([0, n])
    loads = up(n + 1, supports, 0.3)
    loads[n // 2 + 1 : -1] *= 1.5
    inner = np.arange(1, n)
    target = 1.5 * (1.0 - (2.0 * points[inner, 0] / span) ** 2)
    goals: list[Goal] = [("z", inner, target, 1.0)]
    return Problem("arch", points, edges, supports, loads, np.ones(n), (0.05, 20.0), goals, "SLSQP", 1e-9, 500)


def pringle() -> Problem:
    """A vault of 9 arches: reactions that grow to its middle, transversal planes, and lengths across."""
    num_u, num_v, long, wide = 10, 9, 6.0, 3.0
    at = np.arange(num_u * num_v).reshape(num_v, num_u)
    points = np.array(
        [[long * (j / (num_u - 1) - 0.5), wide * (i / (num_v - 1) - 0.5), 0.0] for i, j in np.ndindex(at.shape)]
    )
    along = np.stack([at[:, :-1].ravel(), at[:, 1:].ravel()], axis=1)
    across = np.stack([at[:-1, 1:-1].ravel(), at[1:, 1:-1].ravel()], axis=1)
    edges, ends = np.concatenate([along, across]), at[:, [0, -1]]
    supports = np.sort(ends.ravel())
    sizes = np.concatenate([np.linspace(0.45, 2.0, num_v // 2 + 1), np.linspace(0.45, 2.0, num_v // 2 + 1)[-2::-1]])
    inner = np.setdiff1d(at.ravel(), supports)
    goals: list[Goal] = [
        ("reaction", ends.ravel(), np.repeat(sizes, 2), 100.0),
        ("plane", inner, points[inner, 0], 10.0),
        ("length", len(along) + np.arange(len(across)), np.full(len(across), wide / (num_v - 1)), 1.0),
    ]
    start = np.full(len(edges), 0.25)
    return Problem(
        "pringle", points, edges, supports, up(len(points), supports, 0.1), start, (0.1, 5.0), goals, "SLSQP", 1e-9, 200
    )


def dome(sides: int = 8, rings: int = 20) -> Problem:
    """A dome of rings: all its meridians of one length and of one force."""
    turn = 2.0 * np.pi * np.arange(sides) / sides
    radius = 0.5 - 0.02 * np.arange(rings + 1)
    points = np.array([[r * np.cos(t), r * np.sin(t), 0.0] for r in radius for t in turn])
    at = np.arange((rings + 1) * sides).reshape(rings + 1, sides)
    hoops = np.stack([at[1:].ravel(), np.roll(at[1:], -1, axis=1).ravel()], axis=1)
    meridians = np.stack([at[:-1].ravel(), at[1:].ravel()], axis=1)
    own = len(hoops) + np.arange(len(meridians))
    goals: list[Goal] = [
        ("length", own, np.full(len(own), 0.03), 100.0),
        ("force", own, np.full(len(own), 2.0), 0.01),
    ]
    start = np.concatenate([np.full(len(hoops), 2.0), np.repeat(8.0 * (rings - np.arange(rings)), sides)])
    loads = up(len(points), at[0], 0.1)
    return Problem(
        "dome",
        points,
        np.concatenate([hoops, meridians]),
        at[0],
        loads,
        start,
        (0.01, 500.0),
        goals,
        "LBFGSB",
        1e-9,
        5000,
    )


def vault(m: int = 20) -> Problem:
    """The compression-only net nearest to a cushion over a square plan, supported along its rim, its plan kept."""
    at = np.arange((m + 1) ** 2).reshape(m + 1, m + 1)
    points = np.array([[10.0 * i / m, 10.0 * j / m, 0.0] for i, j in np.ndindex(at.shape)])
    edges = np.concatenate(
        [np.stack([at[:-1].ravel(), at[1:].ravel()], axis=1), np.stack([at[:, :-1].ravel(), at[:, 1:].ravel()], axis=1)]
    )
    rim = np.setdiff1d(at.ravel(), at[1:-1, 1:-1].ravel())
    edges = edges[~(np.isin(edges[:, 0], rim) & np.isin(edges[:, 1], rim))]
    inner = at[1:-1, 1:-1].ravel()
    u, v = points[inner, 0] / 10.0, points[inner, 1] / 10.0
    target = points[inner].copy()
    target[:, 2] = 3.0 * np.sin(np.pi * u) * np.sin(np.pi * v) * (1.0 + 0.3 * u)
    goals: list[Goal] = [("point", inner, target, 1.0)]
    start = np.full(len(edges), 2.0)
    return Problem(
        "vault", points, edges, rim, up(len(points), rim, 0.2), start, (1e-3, 20.0), goals, "LBFGSB", 1e-9, 5000
    )


def recovery(m: int) -> Problem:
    """Heights of a square net of m x m meshes that random densities gave, from equal densities."""
    at = np.arange((m + 1) ** 2).reshape(m + 1, m + 1)
    points = np.array([[10.0 * i / m, 10.0 * j / m, 0.0] for i, j in np.ndindex(at.shape)])
    edges = np.concatenate(
        [np.stack([at[:-1].ravel(), at[1:].ravel()], axis=1), np.stack([at[:, :-1].ravel(), at[:, 1:].ravel()], axis=1)]
    )
    rim, inner = np.setdiff1d(at.ravel(), at[1:-1, 1:-1].ravel()), at[1:-1, 1:-1].ravel()
    loads, count = up(len(points), rim, 0.8 * (12 / m) ** 2), len(edges)
    name = f"heights of {len(points)} nodes"
    found = Problem(name, points, edges, rim, loads, np.ones(count), (0.1, 10.0), [], "LBFGSB", 1e-12, 500)
    wanted = found.shape(np.random.default_rng(7).uniform(0.5, 2.0, count))[0]
    found.goals.append(("z", inner, wanted[inner, 2], 1.0))
    return found


PROBLEMS: dict[str, Callable[[], Problem]] = {"arch": arch, "pringle": pringle, "dome": dome, "vault": vault}
PROBLEMS |= {f"heights-{(m + 1) ** 2}": partial(recovery, m) for m in (12, 30, 100)}
