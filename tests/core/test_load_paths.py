"""Load paths of trusses and domes of bars against closed forms."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.optimize

import hookean
from hookean import Scene

from .bar_scenes import Spec, truss


@pytest.mark.slow
def test_a_shallow_truss_snaps_through_along_its_closed_form() -> None:
    """P = 2 k z (L0 / l - 1) at height z, with both limit points where l^3 = L0 b^2 (von Mises 1923)."""
    half, rise, k = 1.0, 0.3, 100.0
    found = hookean.load_path(truss(half, rise), steps=60, increment=0.3)
    z = found.particles[:, 1, 2]
    rest, length = np.hypot(half, rise), np.hypot(half, z)
    np.testing.assert_allclose(found.factors, 2.0 * k * z * (rest / length - 1.0), atol=1e-9)
    assert z[-1] < -rise
    there = np.cbrt(rest * half**2)
    limit = 2.0 * k * np.sqrt(there**2 - half**2) * (rest / there - 1.0)
    assert [point.kind for point in found.critical_points] == ["limit", "limit"]
    np.testing.assert_allclose([point.factor for point in found.critical_points], [limit, -limit], rtol=1e-12)
    between = np.abs(z) < np.sqrt(there**2 - half**2)
    np.testing.assert_array_equal(found.stable, ~between)
    assert found.limit == found.critical_points[0].factor


@pytest.mark.parametrize("increment", [5.0, 500.0, 5e6])
def test_no_first_step_is_so_long_that_it_passes_over_a_snap(increment: float) -> None:
    """The limit load of the closed form, from first steps of up to a million times that: both ends of such a step are
    stable, and the way between them is straight. Points are in balance to 1e-11 of the load."""
    half, rise, k = 1.0, 0.3, 100.0
    there, rest = np.cbrt(np.hypot(half, rise) * half**2), np.hypot(half, rise)
    limit = 2.0 * k * np.sqrt(there**2 - half**2) * (rest / there - 1.0)
    found = hookean.load_path(truss(half, rise), steps=40, increment=increment)
    np.testing.assert_allclose([point.factor for point in found.critical_points], [limit, -limit], rtol=1e-11)


def test_a_steep_truss_leaves_its_plane_of_symmetry_first() -> None:
    """It sways where l^3 = L0 z^2 (the tangent across, 2 k (1 - L0 z^2 / l^3), vanishes), before its limit point."""
    half, rise, k = 1.0, 3.0, 100.0
    found = hookean.load_path(truss(half, rise), steps=30, increment=5.0)
    rest = np.hypot(half, rise)
    z = scipy.optimize.brentq(lambda z: np.hypot(half, z) ** 3 - rest * z**2, 1.5, rise - 1e-9, xtol=1e-14)
    first = found.critical_points[0]
    assert first.kind == "bifurcation"
    np.testing.assert_allclose(first.factor, 2.0 * k * z * (rest / np.hypot(half, z) - 1.0), rtol=1e-7)
    assert not found.stable[first.step + 1] and found.stable[first.step]


def test_a_path_ends_at_the_factor_that_is_asked_for() -> None:
    """And there it is the shape that relaxing under these loads gives."""
    scene = truss(1.0, 0.3)
    found = hookean.load_path(scene, increment=0.1, largest_factor=0.75)
    assert found.factors[-1] == pytest.approx(0.75, abs=1e-9)
    load = scene.forces[1].model_copy(update={"vector": [0, 0, -0.75]})
    relaxed = hookean.relax(scene.model_copy(update={"forces": (scene.forces[0], load)}))
    np.testing.assert_allclose(found.particles[-1], relaxed.particles, atol=1e-8)


def star_dome(stiffness: float = 100.0) -> Spec:
    """The star dome of 24 bars: crown, six nodes at radius 25 and height 6.216, six supports; EA = 100."""
    turn = np.arange(6) * np.pi / 3.0
    ring = np.column_stack([25.0 * np.cos(turn), 25.0 * np.sin(turn), np.full(6, 6.216)])
    out = np.column_stack([np.cos(turn + np.pi / 6.0), np.sin(turn + np.pi / 6.0), np.zeros(6)]) * [43.3, 43.3, 1.0]
    x = np.concatenate([[[0.0, 0.0, 8.216]], ring, out])
    i = np.arange(6)
    pairs = [[0 * i, 1 + i], [1 + i, 1 + (i + 1) % 6], [1 + i, 7 + i], [1 + (i + 1) % 6, 7 + i]]
    pairs = np.concatenate(pairs, axis=1).T
    size = np.linalg.norm(x[pairs[:, 1]] - x[pairs[:, 0]], axis=1)
    springs = {"kind": "springs", "particles": pairs, "stiffness": stiffness / size}
    load = {"kind": "unary", "particles": [0], "vector": [0, 0, -1.0]}
    return {"particles": x, "forces": [springs, load], "anchors": [{"particles": np.arange(7, 13)}]}


def test_a_star_dome_has_the_limit_load_of_its_symmetric_motion() -> None:
    """Independent: by symmetry three heights and radii remain; for each height of the crown the ring is solved for
    with SciPy, and the load is that of six bars at the crown. Its first maximum is the limit load. To 1e-6, what
    minimising over the height by parabolas reaches."""
    rest = np.sqrt(25.0**2 + 2.0**2), 25.0, np.linalg.norm([25.0 - 43.3 * np.cos(np.pi / 6), 43.3 / 2, 6.216])

    def parts(crown: float, ring: np.ndarray) -> tuple[np.ndarray, float]:
        radius, height = ring
        one = np.array([radius, 0.0, height - crown])
        two = np.array([radius - 43.3 * np.cos(np.pi / 6), 43.3 / 2, height])
        sizes = np.linalg.norm(one), radius, np.linalg.norm(two)
        pulls = [100.0 * (size / first - 1.0) for size, first in zip(sizes, rest, strict=True)]
        along = pulls[0] * one[[0, 2]] / sizes[0] + 2.0 * pulls[2] * two[[0, 2]] / sizes[2]
        return np.array([along[0] + pulls[1], along[1]]), 6.0 * pulls[0] * one[2] / sizes[0]

    def load(crown: float) -> float:
        ring = scipy.optimize.fsolve(lambda r: parts(crown, r)[0], [25.0, 6.216], xtol=1e-13)
        return -float(parts(crown, ring)[1])

    best = scipy.optimize.minimize_scalar(
        lambda z: load(z), bounds=(6.5, 8.2), method="bounded", options={"xatol": 1e-9}
    )
    found = hookean.load_path(Scene.read(star_dome()), steps=25, increment=0.01)
    limits = [point.factor for point in found.critical_points if point.kind == "limit"]
    np.testing.assert_allclose(limits[0], abs(best.fun), rtol=1e-6)


@pytest.mark.parametrize("force", [0.01, 5.0])
def test_a_load_far_smaller_than_the_stiffness_is_followed_beside_a_prestressed_stay(force: float) -> None:
    """Rounding of coordinates leaves u EA/l |x| = 1e-16 x 8.4e6 x 4 = 4e-9 at a particle, 4e-8 of the load of 0.1 in
    the first step. A straight column shortens in proportion, and so do equal steps divide its path."""
    n, tall = 16, 4.0
    column = {"kind": "beam", "particles": [[i, i + 1] for i in range(n)], "E": 2.1e8, "G": 8e7, "A": 1e-2}
    column |= {"Iy": 8e-6, "Iz": 2.4e-5, "J": 8e-6, "normal": [1, 0, 0]}
    stay = {"kind": "springs", "particles": [[n + 1, n], [n, n + 2]], "axial_stiffness": 500.0, "force": force}
    load = {"kind": "unary", "name": "load", "particles": [n], "vector": [0, 0, -1.0]}
    plane = {"particles": list(range(1, n + 1)), "axes": "y", "rotations": "xz"}
    scene = {
        "particles": [[0, 0, tall * i / n] for i in range(n + 1)] + [[-3, 0, 0], [3, 0, 0]],
        "forces": [column, stay, load],
        "anchors": [{"particles": [0], "rotations": "xyz"}, plane, {"particles": [n + 1, n + 2]}],
    }
    found = hookean.load_path(Scene.read(scene), steps=3)
    np.testing.assert_allclose(found.factors, [0.0, 0.1, 0.2, 0.3], rtol=1e-6)
