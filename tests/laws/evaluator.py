"""An evaluator that shares nothing with the engine: the textbook formulas, in plain numpy, from the scene itself."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

Spec = dict[str, Any]


@dataclass
class Evaluated:
    """Forces on the particles (n, 3) by where they come from, and what happened to the elements."""

    internal: np.ndarray
    soft: np.ndarray
    loads: np.ndarray
    free: np.ndarray
    element_sizes: np.ndarray
    moved: np.ndarray  # whether an element has a particle that can move
    slack: int
    cut: int
    yielded: int

    @property
    def total(self) -> np.ndarray:
        """Everything but anchors and floors."""
        return self.internal + self.soft + self.loads

    @property
    def scale(self) -> float:
        """Mean load on loaded free particles, or the mean force of the elements that have a particle that can move."""
        sizes = np.linalg.norm(self.loads * self.free, axis=1)
        loaded = sizes > 0
        return float(sizes[loaded].mean() if loaded.any() else self.element_sizes[self.moved].mean())


def evaluate(spec: Spec, x: np.ndarray) -> Evaluated:
    """Forces at positions `x` (n, 3) of a scene of springs, hinges, loads and anchor springs, never yielded before."""
    start = np.asarray(spec["particles"], float)
    internal, soft, loads = (np.zeros_like(x) for _ in range(3))
    sizes, ends, counts = [np.zeros(0)], [], np.zeros(3, int)
    for force in spec["forces"]:
        if force["kind"] == "springs":
            tension, direction, seen = _tension(force, start, x)
            pull = tension[:, None] * direction
            np.add.at(internal, force["particles"][:, 0], pull)
            np.add.at(internal, force["particles"][:, 1], -pull)
            sizes.append(np.abs(tension))
            ends += list(force["particles"])
            counts += seen
        elif force["kind"] == "unary":
            np.add.at(loads, force["particles"], np.broadcast_to(force["vector"], (len(force["particles"]), 3)))
        elif force["kind"] == "self_weight":
            loads[:, 2] -= force["total"] / len(x)
        elif force["kind"] == "anchor_spring":
            away = force["targets"] - x[force["particles"]]
            np.add.at(soft, force["particles"], force["strength"][:, None] * away)
            sizes.append(force["strength"] * np.linalg.norm(away, axis=1))
            ends += [[i] for i in force["particles"]]
        elif force["kind"] == "hinge":
            pushes = _bending(force, start, x)
            np.add.at(internal, force["particles"], pushes)
            sizes.append(np.linalg.norm(pushes, axis=2).max(axis=1))
            ends += list(force["particles"])
        else:
            raise KeyError(force["kind"])
    free = np.ones_like(x)
    for anchor in spec.get("anchors", []):
        for axis in anchor.get("axes", "xyz"):
            free[np.asarray(anchor["particles"]), "xyz".index(axis)] = 0.0
    slack, cut, yielded = (int(c) for c in counts)
    moved = np.array([free[at].any() for at in ends], dtype=bool)
    return Evaluated(internal, soft, loads, free, np.concatenate(sizes), moved, slack, cut, yielded)


def _tension(force: Spec, start: np.ndarray, x: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Tension of each spring, its direction, and how many are slack, cut off and yielded."""
    a, b = np.asarray(force["particles"]).T
    zero = np.zeros(len(a))
    rest = np.linalg.norm(start[b] - start[a], axis=1) * force.get("rest_factor", 1.0)
    length = np.linalg.norm(x[b] - x[a], axis=1)
    stretch = length - rest
    limit = force.get("plasticity", zero) * rest
    yielded = (limit > 0) & (np.abs(stretch) > limit)
    tension = force["stiffness"] * np.where(yielded, np.sign(stretch) * limit, stretch)
    upper, lower = force.get("upper_cutoff", zero), force.get("lower_cutoff", zero)
    cut, slack = (upper > 0) & (length > upper), (lower > 0) & (length < lower)
    tension = np.where(cut | slack, 0.0, tension)
    direction = (x[b] - x[a]) / np.where(length > 0, length, 1.0)[:, None]
    return tension, direction, np.array([slack.sum(), cut.sum(), (yielded & ~cut & ~slack).sum()])


def _angles(corners: np.ndarray) -> np.ndarray:
    """Fold angles of hinges start-end-tip-tip (m, 4, 3): the normals' angle, by its sine along the edge and cosine."""
    a, b, c, d = (corners[:, i] for i in range(4))
    edge = (b - a) / np.linalg.norm(b - a, axis=1)[:, None]
    one, two = np.cross(b - a, c - a), np.cross(d - a, b - a)
    one /= np.linalg.norm(one, axis=1)[:, None]
    two /= np.linalg.norm(two, axis=1)[:, None]
    return -np.arctan2((np.cross(one, two) * edge).sum(axis=1), (one * two).sum(axis=1))


def _bending(force: Spec, start: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Forces of hinges (m, 4, 3): minus moment times the angle's gradient, the latter by fourth-order differences."""
    corners = x[force["particles"]]
    rest = _angles(start[force["particles"]]) * force.get("angle_factor", 1.0)
    turn = _angles(corners) - rest
    moment = force["strength"] * (turn - 2.0 * np.pi * np.round(turn / (2.0 * np.pi)))
    gradient = np.zeros_like(corners)
    h = 1e-3 * np.linalg.norm(corners[:, 1] - corners[:, 0], axis=1)
    for i in range(4):
        for c in range(3):
            for factor, weight in ((1.0, 2.0 / 3.0), (2.0, -1.0 / 12.0)):
                for sign in (1.0, -1.0):
                    moved = corners.copy()
                    moved[:, i, c] += sign * factor * h
                    difference = _angles(moved) - _angles(corners)
                    difference -= 2.0 * np.pi * np.round(difference / (2.0 * np.pi))
                    gradient[:, i, c] += sign * weight / h * difference
    return -moment[:, None, None] * gradient


def carried(floor: Spec | None, found: Evaluated, x: np.ndarray) -> np.ndarray:
    """What a floor carries at rest (n, 3): pressing forces, and tangential ones up to mu_s N (Coulomb)."""
    given = np.zeros_like(x)
    if floor is None:
        return given
    normal = np.asarray(floor["normal"]) / np.linalg.norm(floor["normal"])
    height = (x - floor["point"]) @ normal
    f = found.total * found.free
    for i in np.flatnonzero(height <= 1e-12 * (1.0 + np.abs(x).max())):
        along = normal * found.free[i]
        reach = float(along @ along)
        press = -float(f[i] @ along)
        if press <= 0.0 or reach < 1e-12:
            continue
        lift = press / reach * along
        shear = f[i] + lift
        size = float(np.linalg.norm(shear))
        hold = min(1.0, floor["static_friction"] * press / reach / size) if size > 0 else 0.0
        given[i] = lift - hold * shear
    return given
