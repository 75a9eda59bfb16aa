"""Meshes of films, films relaxed, and what independent code finds of them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from hookean import Scene, relax
from hookean.discretize import grid, naked_vertices
from hookean.running.result import Result

Heights = Callable[[np.ndarray, np.ndarray], np.ndarray]


def scene(x: np.ndarray, faces: Any, rim: Any, forces: Any = (), anchors: Any = (), **more: Any) -> Scene:
    """A film on a mesh, its rim held, with further forces and anchors; `more` goes to the film or to the settings."""
    settings = {"tolerance": more.pop("tolerance", 1e-10), **more.pop("settings", {})}
    return Scene(
        particles=x, meshes={"skin": {"vertices": x, "faces": faces}},
        forces=[{"kind": "soapfilm", "mesh": "skin", **more}, *forces],
        anchors=[*([{"particles": rim}] if len(rim) else []), *anchors], settings=settings, weld_tolerance=1e-9,
    )  # fmt: skip


def film(*given: Any, **more: Any) -> Result:
    """The film of `scene`, relaxed by its solver, in equilibrium."""
    result = relax(scene(*given, **more))
    assert result.converged, result.message
    return result


def cut(quads: np.ndarray, kind: str) -> np.ndarray:
    """Quads, or triangles along one diagonal."""
    return quads if kind == "quads" else np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def patch(number: np.ndarray) -> np.ndarray:
    """Quads of a grid of particles."""
    return np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=-1).reshape(-1, 4)


def square(n: int, height: Heights, kind: str, power: float = 1.0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """n x n faces over [-1, 1]^2, finer towards the rim by a power above 1, and the rim."""
    t = np.linspace(-1, 1, n + 1)
    t = np.sign(t) * (1.0 - (1.0 - np.abs(t)) ** power)
    mesh = grid(t, t, height(*np.meshgrid(t, t, indexing="ij")))
    return mesh.vertices, cut(mesh.faces, kind), naked_vertices(mesh)


def inside(x: np.ndarray, rim: np.ndarray) -> np.ndarray:
    """All particles but those of the rim."""
    return np.setdiff1d(np.arange(len(x)), rim)


def tube(n: int, m: int, half: float, kind: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A tube of radius 1 between rings at heights +-half, n faces around and m high, and the rings."""
    number = np.arange(n * (m + 1)).reshape(m + 1, n)
    turn, level = np.meshgrid(2 * np.pi * np.arange(n) / n, half * (2 * np.arange(m + 1) / m - 1))
    x = np.stack([np.cos(turn), np.sin(turn), level], axis=-1).reshape(-1, 3)
    after = np.roll(number, -1, axis=1)
    quads = np.stack([number[:-1], after[:-1], after[1:], number[1:]], axis=-1).reshape(-1, 4)
    return x, cut(quads, kind), np.concatenate([number[0], number[-1]])


def disc(n: int, rings: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A polar mesh of the unit disc, triangles at its centre and quads around, and the rim."""
    turn = 2 * np.pi * np.arange(n) / n
    radius = np.arange(1, rings + 1)[:, None] / rings
    x = np.stack([radius * np.cos(turn), radius * np.sin(turn), 0 * radius * turn], axis=-1).reshape(-1, 3)
    number = 1 + np.arange(n * rings).reshape(rings, n)
    after = np.roll(number, -1, axis=1)
    middle = np.stack([0 * number[0], number[0], after[0], after[0]], axis=-1)
    quads = np.stack([number[:-1], number[1:], after[1:], after[:-1]], axis=-1).reshape(-1, 4)
    return np.concatenate([np.zeros((1, 3)), x]), np.concatenate([middle, quads]), number[-1]


def triangles(faces: Any) -> tuple[np.ndarray, np.ndarray]:
    """Both cuts of quads and triangles once, and the share of each in the area."""
    found, shares = [], []
    for face in np.asarray(faces).tolist():
        if len(set(face)) == 3:
            found.append(list(dict.fromkeys(face)))
            shares.append(1.0)
        else:
            a, b, c, d = face
            found += [[a, b, c], [a, c, d], [a, b, d], [b, c, d]]
            shares += [0.5] * 4
    return np.array(found), np.array(shares)


def area(x: np.ndarray, faces: Any) -> float:
    """Area of a mesh, a quad as the mean of its cuts."""
    corners, shares = triangles(faces)
    a, b, c = (x[corners[:, i]] for i in range(3))
    return float(0.5 * shares @ np.linalg.norm(np.cross(b - a, c - a), axis=1))


def thinnest(x: np.ndarray, faces: Any) -> float:
    """The least ratio of height to longest side of all triangles: 0.87 if they have equal sides, 0 of a needle."""
    corners, _ = triangles(faces)
    a, b, c = (x[corners[:, i]] for i in range(3))
    sides = np.stack([b - a, c - b, a - c])
    longest = np.linalg.norm(sides, axis=2).max(axis=0)
    return float((np.linalg.norm(np.cross(b - a, c - a), axis=1) / longest**2).min())


def slopes(errors: Any) -> np.ndarray:
    """Orders of convergence of errors at h, h/2, h/4."""
    size = np.abs(np.asarray(errors))
    return np.log2(size[:-1] / size[1:])


def concentric(rings: int) -> tuple[np.ndarray, list[list[int]], list[np.ndarray]]:
    """A unit disc of six sectors, as many rings of triangles, and the vertices of each ring."""
    x, faces, ring = [[0.0, 0.0, 0.0]], [], [np.zeros(1, int)]
    for r in range(1, rings + 1):
        turn = np.arange(6 * r) * np.pi / (3 * r)
        ring.append(len(x) + np.arange(6 * r))
        x += [[r / rings * np.cos(t), r / rings * np.sin(t), 0.0] for t in turn]
        for s in range(6):
            for j in range(r):
                a, b = ring[r][s * r + j], ring[r][(s * r + j + 1) % (6 * r)]
                c = ring[r - 1][(s * (r - 1) + j) % max(6 * (r - 1), 1)]
                faces.append([c, a, b])
                if j < r - 1:
                    faces.append([c, b, ring[r - 1][(s * (r - 1) + j + 1) % (6 * (r - 1))]])
    return np.array(x), faces, ring
