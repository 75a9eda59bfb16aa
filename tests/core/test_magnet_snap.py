"""Magnets: all near pairs and no others, and what they become."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import cKDTree

from hookean import InputError, Scene, relax
from hookean.forces import magnet_snap
from hookean.system.system import compile

STRENGTH = 30.0


@pytest.mark.parametrize(("count", "reach"), [(2, 0.5), (60, 0.3), (800, 0.07), (800, 3.0)])
def test_every_near_pair_attracts_once(count: int, reach: float) -> None:
    """Energy and stiffness against all pairs of a tree, for two groups in one space; sums of that many terms."""
    rng = np.random.default_rng(count)
    x, group = rng.uniform(-1.0, 1.0, (count, 3)), np.arange(count) % 2 * 5
    force = {"kind": "magnet_snap", "particles": range(count), "group": group, "range": reach, "strength": STRENGTH}
    system = compile(Scene(particles=x, forces=[force]))
    f, w, energies = system.evaluate(system.start())
    pairs = cKDTree(x).query_pairs(reach, output_type="ndarray")
    pairs = pairs[group[pairs[:, 0]] == group[pairs[:, 1]]]
    apart = x[pairs[:, 1]] - x[pairs[:, 0]]
    expected = np.zeros_like(x)
    np.add.at(expected, pairs[:, 0], STRENGTH * apart)
    np.add.at(expected, pairs[:, 1], -STRENGTH * apart)
    assert energies.sum() == pytest.approx(0.5 * STRENGTH * ((apart**2).sum(axis=1) - reach**2).sum(), rel=1e-12)
    assert np.abs(f - expected).max() <= 1e-13 * STRENGTH * reach * count
    assert (w == 2.0 * STRENGTH * np.bincount(pairs.ravel(), minlength=count)).all()


def test_what_is_near_meets_and_what_is_far_stays() -> None:
    """Two clusters of three and two within the range, and one alone: each meets in its mean."""
    x = np.array([[0, 0, 0], [0.3, 0, 0], [0, 0.3, 0], [5, 5, 5], [5, 5.2, 5], [9, 0, 0.0]])
    force = {"kind": "magnet_snap", "particles": range(6), "strength": STRENGTH}
    found = relax(Scene(particles=x, forces=[force], settings={"tolerance": 1e-11}))
    expected = np.concatenate([np.tile(x[:3].mean(axis=0), (3, 1)), np.tile(x[3:5].mean(axis=0), (2, 1)), x[5:]])
    assert found.converged
    assert np.abs(found.particles - expected).max() < 1e-9


@pytest.mark.parametrize("count", [magnet_snap.LARGEST, magnet_snap.LARGEST + 1])
def test_a_large_group_relaxes_and_its_stability_is_unknown(count: int) -> None:
    """Up to 100 particles there is a tangent, with soft anchors a stable one; beyond that the reason is reported, and
    newton is refused with it. Particles at distance 1 with range 0.5 feel their anchors only."""
    x = np.arange(count)[:, None] * [1.0, 0.0, 0.0]
    forces = [{"kind": "magnet_snap", "particles": range(count)}, {"kind": "anchor_spring", "particles": range(count)}]
    found = relax(Scene(particles=x, forces=forces))
    small = count <= magnet_snap.LARGEST
    reason = "a group of 101 particles that snap is too large for a tangent"
    assert found.converged
    assert (found.stability, found.stability_reason) == (("stable", "") if small else ("unknown", reason))
    if not small:
        with pytest.raises(InputError, match=f"/settings/solver: {reason}"):
            relax(Scene(particles=x, forces=forces, settings={"solver": "newton"}))


def test_a_range_is_positive() -> None:
    """Without a range nothing is near."""
    with pytest.raises(InputError, match="/forces/0/range"):
        Scene(particles=np.eye(3), forces=[{"kind": "magnet_snap", "particles": [0, 1], "range": 0}])
