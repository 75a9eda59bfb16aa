"""Nets of springs, their equilibrium and what is measured of it, by code of its own: Newton's method on the energy with
dense matrices, and formulas written once more."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

Quantity = dict[str, Any]
AXES = {"x": 0, "y": 1, "z": 2}


@dataclass
class Net:
    """Springs between `pairs`, with loads at free particles; the others are held where they are in `x`."""

    x: np.ndarray
    pairs: np.ndarray
    stiffness: np.ndarray
    rest: np.ndarray
    loads: np.ndarray
    held: np.ndarray
    faces: np.ndarray | None = None
    units: tuple[float, float] = (1.0, 1.0)  # of length and force

    @property
    def free(self) -> np.ndarray:
        return np.setdiff1d(np.arange(len(self.x)), self.held)

    def copy(self) -> Net:
        arrays = (self.x, self.pairs, self.stiffness, self.rest, self.loads, self.held)
        return Net(*(each.copy() for each in arrays), self.faces, self.units)

    def along(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """From end to end (m, 3), and lengths (m,)."""
        d = x[self.pairs[:, 1]] - x[self.pairs[:, 0]]
        return d, np.linalg.norm(d, axis=1)

    def forces(self, x: np.ndarray) -> np.ndarray:
        return np.asarray(self.stiffness * (self.along(x)[1] - self.rest))

    def energy(self, x: np.ndarray) -> float:
        stretch = self.along(x)[1] - self.rest
        return float(0.5 * self.stiffness @ stretch**2 - (self.loads * x)[self.free].sum())

    def gradient(self, x: np.ndarray) -> np.ndarray:
        d, length = self.along(x)
        pull = (self.forces(x) / length)[:, None] * d
        total = -self.loads.copy()
        np.add.at(total, self.pairs[:, 0], -pull)
        np.add.at(total, self.pairs[:, 1], pull)
        return total

    def hessian(self, x: np.ndarray) -> np.ndarray:
        d, length = self.along(x)
        unit, n = d / length[:, None], len(x)
        outer = unit[:, :, None] * unit[:, None, :]
        blocks = self.stiffness[:, None, None] * outer
        blocks = blocks + (self.forces(x) / length)[:, None, None] * (np.eye(3) - outer)
        whole = np.zeros((n, n, 3, 3))
        for one, other, sign in ((0, 0, 1), (1, 1, 1), (0, 1, -1), (1, 0, -1)):
            np.add.at(whole, (self.pairs[:, one], self.pairs[:, other]), sign * blocks)
        free = self.free
        return whole[np.ix_(free, free)].transpose(0, 2, 1, 3).reshape(3 * len(free), -1)

    def size(self, x: np.ndarray) -> float:
        return float(np.abs(self.loads).max() + np.abs(self.forces(x)).max())

    def settled(self, x: np.ndarray) -> np.ndarray:
        """The equilibrium from a shape, by Newton's method with steps down the energy."""
        x = x.copy()
        x[self.held] = self.x[self.held]
        free = self.free
        for _ in range(200):
            slope = self.gradient(x)[free].ravel()
            if not np.abs(slope).max() >= 1e-13 * self.size(x):
                break
            step = _down(self.hessian(x), slope).reshape(-1, 3)
            before, part = self.energy(x), 1.0
            while part > 1e-6:
                new = x.copy()
                new[free] += part * step
                if self.energy(new) <= before + 1e-12 * abs(before):
                    break
                part /= 2
            else:
                break
            x = new
        return x


def _down(hessian: np.ndarray, slope: np.ndarray) -> np.ndarray:
    try:
        np.linalg.cholesky(hessian)
        return -np.linalg.solve(hessian, slope)
    except np.linalg.LinAlgError:
        values, vectors = np.linalg.eigh(hessian)
        return -vectors @ ((vectors.T @ slope) / np.maximum(np.abs(values), 1e-9 * np.abs(values).max()))


def measured(net: Net, x: np.ndarray, q: Quantity) -> np.ndarray:
    """The values of a quantity, in the order of docs/design.md."""
    kind, (d, length), force = q["kind"], net.along(x), net.forces(x)
    axes = [AXES[a] for a in q.get("axes", "xyz")]
    if kind in ("length", "force", "force_density"):
        return _of_elements(net, {"length": length, "force": force, "force_density": force / length}[kind], q)
    if kind == "position":
        return x[q["particles"]][:, axes].ravel()
    if kind == "load_path":
        return np.array([np.abs(force) @ length])
    if kind == "strain_energy":
        return np.array([0.5 * net.stiffness @ (length - net.rest) ** 2])
    if kind == "direction":
        return (d / length[:, None])[:, axes].ravel()
    if kind == "offset":
        normal = np.array(q["normal"], float) / np.linalg.norm(q["normal"])
        return (x[q["particles"]] - np.array(q["origin"])) @ normal
    if kind == "reaction":
        pull = net.gradient(x)[net.held][:, axes]
        pull = pull.sum(axis=0, keepdims=True) if q.get("total") else pull
        return np.linalg.norm(pull, axis=1) if q.get("size") else pull.ravel()
    return _of_faces(net, x, kind)


def _of_elements(net: Net, values: np.ndarray, q: Quantity) -> np.ndarray:
    if q.get("equal"):
        return np.asarray(values - values.mean())
    if q.get("total"):
        return np.array([values.sum()])
    if q.get("smooth"):
        meets = (net.pairs[:, None, :, None] == net.pairs[None, :, None, :]).any(axis=(2, 3))
        np.fill_diagonal(meets, False)
        return np.array([v - values[near].mean() if near.any() else 0.0 for v, near in zip(values, meets, strict=True)])
    return values


def _of_faces(net: Net, x: np.ndarray, kind: str) -> np.ndarray:
    assert net.faces is not None
    a, b, c, e = x[net.faces].transpose(1, 0, 2)
    if kind == "planarity":
        normal = np.cross(c - a, e - b)
        return np.asarray(((b - a) * normal).sum(axis=1) / np.linalg.norm(normal, axis=1))
    halves = [(a, b, c), (a, c, e)]
    if kind == "area":
        return np.array([sum(0.5 * np.linalg.norm(np.cross(q - p, r - p), axis=1).sum() for p, q, r in halves)])
    return np.array([sum((p * np.cross(q, r)).sum() / 6 for p, q, r in halves)])
