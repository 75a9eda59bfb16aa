"""Critical points of load paths are singular: at each one the tangent has an eigenvalue of zero.

Wriggers and Simo, A general procedure for the direct computation of turning and bifurcation points, 1990: K phi = 0.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import hookean
from hookean import Scene
from hookean.analysis import load_path as paths
from hookean.analysis.arc_length import Follower
from soak import seeds

Floats = np.ndarray


def singular(scene: Scene, monkeypatch: pytest.MonkeyPatch, **how: Any) -> Floats:
    """Of each critical point the smallest eigenvalue of the tangent beside the largest."""
    kept: list[Follower] = []

    class Kept(Follower):
        def __init__(self, *given: Any) -> None:
            super().__init__(*given)
            kept.append(self)

    monkeypatch.setattr(paths, "Follower", Kept)
    found, follower = hookean.load_path(scene, **how), kept[0]
    parts = []
    for point in found.critical_points:
        follower.state.x = point.particles
        values = np.abs(np.linalg.eigvalsh(follower.unknowns.tangent(follower.rest.system, follower.state).toarray()))
        parts.append(values.min() / values.max())
    return np.array(parts)


def trussed(x: Floats, pairs: Floats, supports: Floats) -> Scene:
    """Bars of EA = 100 between particles, with a load down on the first one."""
    size = np.linalg.norm(x[pairs[:, 1]] - x[pairs[:, 0]], axis=1)
    springs = {"kind": "springs", "particles": pairs, "stiffness": 100.0 / size}
    load = {"kind": "unary", "particles": [0], "vector": [0, 0, -1.0]}
    settings = {"tolerance": 1e-10}
    anchors = [{"particles": supports}]
    return Scene.read({"particles": x, "forces": [springs, load], "anchors": anchors, "settings": settings})


@pytest.mark.soak
@seeds(4, soak=100)
def test_random_trusses_of_von_mises_snap_where_they_are_singular(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Three to five bars from a ring to an apex that is not in its middle. The tangent changes in proportion to the
    arc, which is bracketed to 1e-9 of a step: 1e-6 leaves room for its slope."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(3, 6))
    turn = np.arange(count) * 2.0 * np.pi / count
    ring = np.column_stack([np.cos(turn), np.sin(turn), 0.0 * turn]) * rng.uniform(0.8, 1.2, (count, 1))
    apex = [*rng.uniform(-0.2, 0.2, 2), rng.uniform(0.15, 0.5)]
    pairs = np.column_stack([np.zeros(count, int), 1 + np.arange(count)])
    parts = singular(
        trussed(np.vstack([apex, ring]), pairs, 1 + np.arange(count)), monkeypatch, steps=25, arc_length=0.06
    )
    assert len(parts) >= 2
    assert parts.max() <= 1e-6


@pytest.mark.slow
@seeds(1, soak=20)
def test_random_star_domes_have_singular_critical_points(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Their paths lie close to one another: a step that leaves one for another finds no critical point between its
    ends, and without shorter ones most of these paths had such points at up to 2e-3 of the stiffness. A first step of
    several times the load that snaps them must not pass over the snap, as it did for four of the twenty: both of its
    ends were stable."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(4, 7))
    turn = np.arange(count) * 2.0 * np.pi / count
    inner = np.column_stack([np.cos(turn), np.sin(turn), np.full(count, rng.uniform(0.15, 0.25))])
    shifted = turn + np.pi / count
    outer = 2.0 * np.column_stack([np.cos(shifted), np.sin(shifted), 0.0 * turn])
    x = np.vstack([[0.0, 0.0, rng.uniform(0.25, 0.4)], inner + rng.normal(0.0, 0.03, inner.shape), outer])
    i = np.arange(count)
    pairs = [[0 * i, 1 + i], [1 + i, 1 + (i + 1) % count], [1 + i, 1 + count + i], [1 + (i + 1) % count, 1 + count + i]]
    scene = trussed(x, np.concatenate(pairs, axis=1).T, 1 + count + i)
    parts = singular(scene, monkeypatch, steps=24, increment=0.5)
    assert len(parts) >= 2
    assert parts.max() <= 1e-6
