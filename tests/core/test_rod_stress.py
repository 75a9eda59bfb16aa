"""Linear buckling counts the moments that loads bring to `bend`: by its definition, and closed forms in space."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import pytest

import hookean
from hookean import Scene
from hookean.forces.bend import bend_bent
from hookean.system.system import compile

Floats = np.ndarray
STEP = 1e-4  # of differences, twice: to 1e-7 of what they are of


def carried(u: Floats, s: Floats, t: Floats) -> Floats:
    """u after the smallest rotation from s to t (Rodrigues)."""
    n = np.cross(s, t)
    return np.asarray(u + np.cross(n, u) + np.cross(n, np.cross(n, u)) / (1.0 + s @ t))


def turns(x: Floats, u: Floats, s: Floats, spin: float) -> Floats:
    """The turns (n, 2) of a rod's corners in the frame that leaves its start with u, square to s, spun about it."""
    way = np.diff(x, axis=0) / np.linalg.norm(np.diff(x, axis=0), axis=1)[:, None]
    u, found = carried(u, s, way[0]), []
    u = np.cos(spin) * u + np.sin(spin) * np.cross(way[0], u)
    for one, other in pairwise(way):
        n = np.cross(one, other)
        turn = n / np.linalg.norm(n) * np.arctan2(np.linalg.norm(n), one @ other)
        found.append([turn @ u, turn @ np.cross(one, u)])
        u = carried(u, one, other)
    return np.array(found)


def derivatives(f: Any, at: Floats) -> tuple[Floats, Floats]:
    """First and second derivatives of a number by central differences."""
    unit, size = STEP * np.eye(len(at)), len(at)
    first = np.array([(f(at + e) - f(at - e)) / (2.0 * STEP) for e in unit])
    second = np.zeros((size, size))
    for i in range(size):
        for j in range(i + 1):
            a, b = unit[i], unit[j]
            sides = f(at + a + b) - f(at + a - b) - f(at - a + b) + f(at - a - b)
            second[i, j] = second[j, i] = sides / (4.0 * STEP**2)
    return first, second


@pytest.mark.soak
@pytest.mark.parametrize(("held", "seed"), [(True, 0), (False, 0), pytest.param(False, 1, marks=pytest.mark.soak)])
def test_it_is_what_the_change_of_moments_makes_of_the_second_derivatives(held: bool, seed: int) -> None:
    """Sum of k s' (u, psi) . s'' of the turns s in the frame, with the spin psi of a free rod as an unknown that goes
    along by its least energy; of a rod drawn curved in space and bent on. To 1e-5 of the largest: differences of
    differences, twice."""
    rng = np.random.default_rng(seed)
    drawn = np.column_stack([np.arange(6.0), *rng.normal(0.0, 0.4, (2, 6))])
    corners = [[i, i + 1, i + 2] for i in range(4)]
    stiffness = rng.uniform(1.0, 3.0, 4)
    bend = {"kind": "bend", "particles": corners, "stiffness": stiffness}
    anchors = [{"particles": [0]}] if held else []
    system = compile(Scene.read({"particles": drawn, "forces": [bend], "anchors": anchors}))
    block = system.groups[0].block
    k = block.parameters[:, 0]
    x, moved = drawn + rng.normal(0.0, 0.1, drawn.shape), rng.normal(0.0, 1.0, drawn.shape)
    s = (drawn[1] - drawn[0]) / np.linalg.norm(drawn[1] - drawn[0])
    u = np.cross(s, [0.0, 0.0, 1.0]) / np.linalg.norm(np.cross(s, [0.0, 0.0, 1.0]))
    rest = turns(drawn, u, s, 0.0)
    here = turns(x, u, s, 0.0)
    real, imaginary = (k[:, None] * here * rest).sum(), (k * (here[:, 0] * rest[:, 1] - here[:, 1] * rest[:, 0])).sum()
    spin = 0.0 if held else -np.arctan2(imaginary, real)  # of a free rod: where the energy is least
    way = (x[1] - x[0]) / np.linalg.norm(x[1] - x[0])
    start = (u, s) if held else (carried(u, s, way), way)

    def strains(q: Floats) -> Floats:
        return turns(q[:-1].reshape(-1, 3), *start, q[-1])

    at = np.append(x.ravel(), spin)
    slope, stiff = derivatives(lambda q: float((0.5 * k[:, None] * (strains(q) - rest) ** 2).sum()), at)
    spun = np.zeros(x.size) if held else -stiff[-1, :-1] / stiff[-1, -1]
    assert held or abs(slope[-1]) < 1e-6
    along = np.append(moved.ravel(), spun @ moved.ravel())
    change = (strains(at + 1e-5 * along) - strains(at - 1e-5 * along)) / 2e-5
    _, second = derivatives(lambda q: float((k[:, None] * change * strains(q)).sum()), at)
    onto = np.vstack([np.eye(x.size), spun])
    wanted = onto.T @ second @ onto
    found = np.zeros((x.size, x.size))
    for index, blocks in bend_bent(block, x, moved):
        for row, part in zip(index, blocks, strict=True):
            places = (3 * row[:, None] + np.arange(3)).ravel()
            found[np.ix_(places, places)] += part
    np.testing.assert_allclose(found, wanted, atol=1e-5 * np.abs(wanted).max())


def ring(count: int) -> float:
    """q R^3 / EI at which a ring of bars under a dead radial load q leaves its plane."""
    turn = np.arange(count) * 2.0 * np.pi / count
    x = np.column_stack([np.cos(turn), np.sin(turn), 0.0 * turn])
    i = np.arange(count)
    forces = [
        {"kind": "springs", "particles": np.column_stack([i, (i + 1) % count]), "stiffness": 1e7},
        {"kind": "bend", "particles": np.column_stack([i - 1, i, i + 1]) % count, "stiffness": 2.0},
        {"kind": "unary", "particles": i, "vector": -x * 2.0 * np.pi / count * 2.0},
    ]
    anchors = [
        {"particles": [0, count // 2], "axes": "y"},
        {"particles": [count // 4], "axes": "x"},
        {"particles": [count // 8, 3 * count // 8, 5 * count // 8, 7 * count // 8], "axes": "z"},
    ]
    spec = {"particles": x, "forces": forces, "anchors": anchors, "settings": {"tolerance": 1e-9}}
    found = hookean.buckling(Scene.read(spec), count=1)
    return float(found.factors[0])


def test_a_ring_leaves_its_plane() -> None:
    """q = 9 / 4 EI / R^3, from EI (w + w'')^2 against q R w'^2 for w = cos 2 theta without twist, of a ring on four
    supports that such a w does not move. Bars lead to it with their square."""
    off = [ring(count) / 2.25 - 1.0 for count in (16, 32)]
    assert (4.0 * off[1] - off[0]) / 3.0 == pytest.approx(0.0, abs=1e-3)
    assert 3.8 < off[0] / off[1] < 4.2
