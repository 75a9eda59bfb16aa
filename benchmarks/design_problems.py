"""Design problems by force densities for both programs, as plain arrays: the published examples of jax_fdm (MIT) with
their own data, goals, bounds and stops (PUBLISHED), and others after them.

All are in compression there; here densities are positive and loads point up, which has the same shapes. Densities that
have no bounds there are at least 0 in hookean. The vault's target is a formula in the place of a file.
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
SMALL = 1000  # particles up to which NumPy solves
Goal = tuple[str, Ints, Any, float]
"""Kind (z, point, plane, length, direction, force, reaction, load_path), particles or edges, targets, weight."""


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
    loss: str = "SquaredError"
    lengths: tuple[float, float] | None = None  # between which all edges must be

    @property
    def free(self) -> Ints:
        """Particles that move."""
        return np.setdiff1d(np.arange(len(self.points)), self.supports)

    def shape(self, q: Floats) -> tuple[Floats, Floats]:
        """Places (n, 3) and reactions (n, 3): C^T Q C x = p."""
        x, free, k = self.points.copy(), self.free, _stiffness(self.edges, q, len(self.points))
        right = self.loads[free] - k[free][:, self.supports] @ x[self.supports]
        x[free] = _solved(k[free][:, free], right)
        return x, self.loads - k @ x

    def values(self, q: Floats, kind: str, which: Ints) -> Floats:
        """What a goal measures."""
        x, forces = self.shape(q)
        along = x[self.edges[:, 1]] - x[self.edges[:, 0]]
        length = np.linalg.norm(along, axis=1)
        measured = {"z": x[:, 2], "point": x, "plane": x[:, 0], "length": length, "force": q * length,
                    "reaction": np.linalg.norm(forces, axis=1), "direction": along / length[:, None],
                    "load_path": np.abs(q) * length**2}  # fmt: skip
        return np.asarray(measured[kind][which])

    def objective(self, q: Floats) -> float:
        """The sum of weight (value - target)², or of weight x value without a target; the root of the mean square of
        the distances if that is the loss."""
        total = 0.0
        for kind, which, target, weight in self.goals:
            value = self.values(q, kind, which)
            total += weight * float(value.sum() if target is None else ((value - target) ** 2).sum())
        return float(np.sqrt(total / len(self.free))) if self.loss == "RootMeanSquaredError" else total

    def missed(self, q: Floats) -> float:
        """By how much lengths or bounds are missed, at most."""
        low, high = self.bounds
        over = max(float((low - q).max()), float((q - high).max()))
        if self.lengths is not None:
            length = self.values(q, "length", np.arange(len(self.edges)))
            over = max(over, float((self.lengths[0] - length).max()), float((length - self.lengths[1]).max()))
        return over


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
    """A vault of 9 arches: reactions that grow to its middle, transversal planes, and lengths across (its
    examples/pringle/pringle.py)."""
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


def _stiffness(edges: Ints, q: Floats, n: int) -> Any:
    """C^T Q C (n, n); by NumPy where it is small, since SciPy's sparse matrices take long to load."""
    ends = edges.ravel()
    rows, columns = np.repeat(ends, 2), np.repeat(edges, 2, axis=0).ravel()
    values = np.outer(q, [1.0, -1.0, -1.0, 1.0]).ravel()
    if n <= SMALL:
        k = np.zeros((n, n))
        np.add.at(k, (rows, columns), values)
        return k
    from scipy.sparse import coo_matrix

    return coo_matrix((values, (rows, columns)), (n, n)).tocsc()


def _solved(k: Any, right: Floats) -> Floats:
    """K^-1 of a right side."""
    if isinstance(k, np.ndarray):
        return np.linalg.solve(k, right)
    from scipy.sparse.linalg import splu

    return np.asarray(splu(k.tocsc()).solve(right))


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


def load_path() -> Problem:
    """The arch of least load path whose segments are between 0.75 and 1 long (its examples/arch/arch_loadpath.py)."""
    n, span = 10, 5.0
    points = np.array([[span * (i / n - 0.5), 0.0, 0.0] for i in range(n + 1)])
    edges, supports = np.array([[i, i + 1] for i in range(n)]), np.array([0, n])
    goals: list[Goal] = [("load_path", np.arange(n), None, 1.0)]
    bounds = (-np.inf, np.inf)
    loads = up(n + 1, supports, 0.3)
    return Problem("arch of least load path", points, edges, supports, loads, np.ones(n), bounds, goals, "SLSQP", 1e-6,
                   100, "PredictionError", (0.75, 1.0))  # fmt: skip


def steep_dome(sides: int = 8, rings: int = 40) -> Problem:
    """A dome of rings: its meridians of one length, and from 20 to 30 degrees off the vertical (its
    examples/dome/dome.py)."""
    turn = 2.0 * np.pi * np.arange(sides) / sides
    radius = 0.5 - 0.01 / np.cos(np.pi / sides) * np.arange(1, rings + 2)
    points = np.array([[r * np.cos(t), r * np.sin(t), 0.0] for r in radius for t in turn])
    at = np.arange((rings + 1) * sides).reshape(rings + 1, sides)
    hoops = np.stack([at[1:].ravel(), np.roll(at[1:], -1, axis=1).ravel()], axis=1)
    meridians = np.stack([at[:-1].ravel(), at[1:].ravel()], axis=1)
    own = len(hoops) + np.arange(len(meridians))
    lean = np.radians(20.0 + 10.0 * np.arange(rings) / (rings - 1))
    inwards = [[-np.sin(a) * np.cos(t), -np.sin(a) * np.sin(t), np.cos(a)] for a in lean for t in turn]
    goals: list[Goal] = [("length", own, np.full(len(own), 0.03), 1.0), ("direction", own, np.array(inwards), 1.0)]
    edges = np.concatenate([hoops, meridians])
    scale = np.sqrt(len(edges)) / 2.0
    start = np.concatenate([np.full(len(hoops), 2.0), np.repeat(0.5 * scale * (rings - np.arange(rings)), sides)])
    loads, bounds = up(len(points), at[0], 0.1), (-np.inf, np.inf)
    return Problem("dome to directions", points, edges, at[0], loads, start, bounds, goals, "LBFGSB", 1e-6, 10_000)


CREASE = [3.7403, 3.9054, 4.3180, 4.9720, 5.8672, 7.0037, 8.3814, 9.9850]  # x, from the middle to either side
EDGE = [9.7335, 9.7486, 9.8148, 9.9330, 10.0899, 10.3030, 10.6219, 11.0866]
HEIGHTS = """
.6489 1.1637 1.5387 1.7718 1.8572 1.7907 1.5745 1.1998 .6584 .6752 .7939 1.0195
1.1167 1.9795 2.6219 3.0324 3.2011 3.1173 2.7681 2.1424 1.2253 1.2696 1.4810 1.9030
1.4024 2.4837 3.2996 3.8349 4.0705 3.9939 3.5848 2.8199 1.6782 1.7653 2.0689 2.6739
1.5256 2.7016 3.5947 4.1918 4.4717 4.4171 4.0071 3.2158 2.0186 2.1585 2.5453 3.3063
1.4908 2.6396 3.5168 4.1092 4.4054 4.3850 4.0325 3.3273 2.2495 2.4498 2.9099 3.7726
1.2932 2.2942 3.0622 3.5919 3.8774 3.9067 3.6739 3.1674 2.3792 2.6434 3.1653 4.0803
.9131 1.6363 2.2078 2.6274 2.8931 3.0055 2.9630 2.7675 2.4174 2.7388 3.3097 4.2184
1.2665 2.2495 3.0048 3.5255 3.8072 3.8406 3.6185 3.1317 2.3731 2.6598 3.1867 4.1021
1.4839 2.6252 3.4975 4.0869 4.3788 4.3563 4.0037 3.3015 2.2302 2.4785 2.9467 3.8142
1.5354 2.7177 3.6153 4.2114 4.4855 4.4258 4.0071 3.2023 1.9890 2.1993 2.5940 3.3632
1.4272 2.5276 3.3547 3.8954 4.1321 4.0454 3.6157 2.8269 1.6495 1.8163 2.1283 2.7498
1.1559 2.0494 2.7117 3.1334 3.3039 3.2104 2.8370 2.1754 1.2117 1.3315 1.5544 1.9914
.7063 1.2600 1.6640 1.9138 2.0032 1.9265 1.6839 1.2672 .6757 .7476 .8757 1.1209
"""


def shell() -> Problem:
    """The compression-only net nearest to a creased shell (its examples/creased_shell/creased_shell.py and
    data/json/creased_shell.json, to 4 decimals; the shape is of Panozzo and others 2013)."""
    grid = np.zeros((15, 13, 3))
    for row, y in enumerate(np.arange(-7, 8)):
        crease, end = CREASE[abs(y)], EDGE[abs(y)]
        x = np.concatenate([np.linspace(-11.0866, crease, 10), np.linspace(crease, end, 4)[1:]])
        grid[row, :, 0], grid[row, :, 1] = x, 10.0 * y / 7.0
    grid[1:-1, 1:, 2] = np.array(HEIGHTS.split(), float).reshape(13, 12)
    at = np.arange(15 * 13).reshape(15, 13)
    edges = np.concatenate([np.stack([at[1:-1, :-1].ravel(), at[1:-1, 1:].ravel()], axis=1),
                            np.stack([at[:-1, 1:].ravel(), at[1:, 1:].ravel()], axis=1)])  # fmt: skip
    used, edges = np.unique(edges, return_inverse=True)
    edges, points = edges.reshape(-1, 2), grid.reshape(-1, 3)[used]
    supports = np.flatnonzero(np.bincount(edges.ravel()) == 1)
    inner = np.setdiff1d(np.arange(len(points)), supports)
    goals: list[Goal] = [("point", inner, points[inner], 1.0)]
    loads, start = up(len(points), supports, 0.2), np.ones(len(edges))
    return Problem("shell nearest to a shape", points, edges, supports, loads, start, (0.0, 20.0), goals, "LBFGSB",
                   1e-6, 1000, "RootMeanSquaredError")  # fmt: skip


PUBLISHED: dict[str, Callable[[], Problem]] = {
    "load-path": load_path,
    "pringle": pringle,
    "steep-dome": steep_dome,
    "shell": shell,
}
PROBLEMS: dict[str, Callable[[], Problem]] = PUBLISHED | {"arch": arch, "dome": dome, "vault": vault}
PROBLEMS |= {f"heights-{(m + 1) ** 2}": partial(recovery, m) for m in (12, 30, 100)}
