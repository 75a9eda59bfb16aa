"""Films at rest: whether they are stable, and how well their place is known. Along itself a film has no stiffness."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq, root

from hookean import relax
from hookean.running.result import Status
from hookean.stability.equilibrium import Stability

from .film_meshes import area, inside, scene, square, tube

AROUND, HALF = 12, 0.4


def waist(radius: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Two rings of radius 1 and one of this radius half way, with trapezoids between them; and the outer two."""
    x, faces, rings = tube(AROUND, 2, HALF, "quads")
    x[AROUND : 2 * AROUND, :2] *= radius
    return x, faces, rings


def slopes(radius: float) -> tuple[float, float]:
    """First and second derivative of the area of a waist, over 4 n sin(pi / n) / 2: of (1 + r) s with the slant height
    s^2 = h^2 + k^2 (1 - r)^2, k = cos(pi / n)."""
    k = np.cos(np.pi / AROUND)
    s = np.sqrt(HALF**2 + (k * (1 - radius)) ** 2)
    first, second = -(k**2) * (1 - radius) / s, (k * HALF) ** 2 / s**3
    return s + (1 + radius) * first, 2 * first + (1 + radius) * second


def at_rest(sign: float) -> float:
    """Where the first derivative vanishes: r^2 - r + h^2 / (2 k^2) = 0."""
    return float(0.5 + sign * np.sqrt(0.25 - 0.5 * (HALF / np.cos(np.pi / AROUND)) ** 2))


def falling(radius: float) -> int:
    """How many motions of a waist along its normals, which are radial, lessen the area: by differences of areas."""
    x, faces, _ = waist(radius)
    ring, step = np.arange(AROUND, 2 * AROUND), 1e-4
    out = np.zeros((AROUND, *x.shape))
    out[np.arange(AROUND), ring, :2] = x[ring, :2] / radius * step
    here = area(x, faces)
    one = np.array([[area(x + sign * motion, faces) for motion in out] for sign in (1, -1)])
    both = np.array([[area(x + a + b, faces) for a in out] for b in out])
    bends = both - one[0][:, None] - one[0] + here
    np.fill_diagonal(bends, one.sum(axis=0) - 2 * here)
    return int((np.linalg.eigvalsh(bends) < 0.0).sum())


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_of_two_films_between_rings_one_is_stable(sign: float) -> None:
    """Both radii at which a waist rests; the smaller one is unstable, and held there only if that is asked for."""
    assert slopes(at_rest(sign))[0] == pytest.approx(0.0, abs=1e-15)
    x, faces, rings = waist(at_rest(sign))
    result = relax(scene(x, faces, rings, settings={"allow_unstable": True}))
    assert result.converged and result.particles == pytest.approx(x, abs=1e-14)
    unstable = falling(at_rest(sign))
    assert (unstable > 0) == (sign < 0) == (slopes(at_rest(sign))[1] < 0)
    assert (result.stability, result.soft_modes) == (
        (Stability.UNSTABLE, unstable) if unstable else (Stability.STABLE, None)
    )
    assert result.position_error is not None and result.position_error <= 1e-12
    left = relax(scene(x, faces, rings))
    if sign > 0:
        assert left.converged
    else:  # it draws together, or apart
        assert left.status is Status.DIVERGED or left.stability is Stability.STABLE


@pytest.mark.parametrize("solver", ["auto", "newton", "relaxation"])
def test_the_position_error_of_a_film_is_that_across_it(solver: str) -> None:
    """A waist off its place: one more exact step would change its radius by the first derivative over the second."""
    radius = at_rest(1.0) + 1e-3
    x, faces, rings = waist(radius)
    settings = {"solver": solver, "position_tolerance": None}
    result = relax(scene(x, faces, rings, tolerance=0.1, settings=settings))
    assert result.converged and np.array_equal(result.particles, x)
    first, second = slopes(radius)
    assert result.stability is Stability.STABLE
    assert result.position_error == pytest.approx(first / second, rel=1e-6)


def test_the_place_of_a_film_is_found_to_the_position_tolerance() -> None:
    """Whatever the tolerance of forces: a waist within 1e-8 of its size, (2^2 + 2^2 + 0.8^2)^0.5, of where it rests."""
    x, faces, rings = waist(at_rest(1.0) + 0.05)
    result = relax(scene(x, faces, rings, tolerance=0.5, settings={"position_tolerance": 1e-8}))
    assert result.converged
    radii = np.linalg.norm(result.particles[AROUND : 2 * AROUND, :2], axis=1)
    assert np.abs(radii - at_rest(1.0)).max() <= 1e-8 * np.sqrt(8.64)


@pytest.mark.parametrize("solver", ["auto", "newton", "relaxation"])
def test_a_film_is_no_mechanism_along_itself(solver: str) -> None:
    """A flat film is at rest and stable wherever its vertices are, in it and on an edge in a plane of symmetry."""
    x, faces, rim = square(8, lambda u, v: 0.0 * u, "triangles")
    x[inside(x, rim), :2] += np.random.default_rng(2).uniform(-0.05, 0.05, (len(x) - len(rim), 2))
    side = np.arange(1, 8)
    x[side, 1] += 0.05 * np.sin(side)
    held = np.setdiff1d(rim, side)
    plane = [{"particles": side, "axes": "x"}]
    result = relax(scene(x, faces, held, anchors=plane, settings={"solver": solver}))
    assert result.converged and np.array_equal(result.particles, x)
    assert (result.stability, result.position_error) == (Stability.STABLE, 0.0)


@pytest.mark.slow
@pytest.mark.parametrize("height", [0.3, 0.5, 0.64])
def test_a_film_that_collapses_on_one_side_rests_on_the_other(height: float) -> None:
    """Between two rings hang two catenoids r = c cosh(z / c): the slim one is unstable, and on one side of it lies
    collapse, on the other the stout one, which is stable. `auto` arrives there, whichever side it tries first; its
    waist is that of the same rows at equal heights to 1 %, as particles may slide along the film.
    """
    least = height / 1.19967864025773  # the waist where both are one: x tanh x = 1
    slim, stout = (
        _rows(height, brentq(lambda c: c * np.cosh(height / c) - 1.0, *b)) for b in ((0.02, least), (least, 1))
    )
    x, faces, rings = tube(16, 10, height, "quads")
    x[:, :2] *= (np.repeat(slim, 16) / np.linalg.norm(x[:, :2], axis=1))[:, None]
    kept = relax(scene(x, faces, rings, settings={"allow_unstable": True}))
    assert (kept.status, kept.stability) == (Status.CONVERGED, Stability.UNSTABLE)
    left = relax(scene(x, faces, rings))
    assert (left.status, left.stability) == (Status.CONVERGED, Stability.STABLE)
    assert np.linalg.norm(left.particles[16 * 5, :2]) == pytest.approx(stout[5], rel=0.01)


def _rows(height: float, waist: float) -> np.ndarray:
    """Radii of 11 rows of 16 particles at equal heights where the area of the trapezoids between them, sums of
    (r + r') s with the slant height s^2 = h^2 + k^2 (r' - r)^2, has no slope; near the catenoid of this waist."""
    k, high = np.cos(np.pi / 16), 2.0 * height / 10

    def slope(inner: np.ndarray) -> np.ndarray:
        r = np.concatenate([[1.0], inner, [1.0]])
        wide, apart = r[1:] + r[:-1], np.diff(r)
        slant = np.sqrt(high**2 + (k * apart) ** 2)
        pull = wide * k**2 * apart / slant
        return slant[:-1] + slant[1:] + pull[:-1] - pull[1:]

    z = np.linspace(-height, height, 11)[1:-1]
    found = root(slope, waist * np.cosh(z / waist), tol=1e-13)
    assert np.abs(found.fun).max() < 1e-10
    return np.concatenate([[1.0], found.x, [1.0]])
