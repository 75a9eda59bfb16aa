"""Circles against closed curves in a plane: sides by turning numbers, and rest positions in closed form."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.test_pulls import on_segments
from hookean import Scene, relax
from hookean.errors import InputError
from hookean.forces import CollideCurve
from hookean.system.system import compile
from soak import examples

SEEDED = settings(derandomize=True, deadline=None, max_examples=examples(60), database=None)
SQUARE = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]]


def evaluated(x: Any, **fields: Any) -> tuple[np.ndarray, np.ndarray]:
    """Force on particles and their depth."""
    x = np.asarray(x, float)
    force = CollideCurve(particles=range(len(x)), **fields)
    system = compile(Scene(particles=x, forces=[force]))
    f, _, _ = system.evaluate(system.start())
    return f, force.measure(system.groups[0].block, x, f[:, None])["depth"]


def turning(p: np.ndarray, curve: np.ndarray) -> float:
    """How often a closed polyline (n, 2) goes round p."""
    a = curve - p
    b = np.roll(a, -1, axis=0)
    return float(np.arctan2(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0], (a * b).sum(1)).sum() / (2 * np.pi))


@pytest.mark.parametrize("inside", [False, True])
@SEEDED
@given(seed=st.integers(0, 2**32 - 1))
def test_the_depth_is_that_of_the_turning_number_and_the_closest_point(inside: bool, seed: int) -> None:
    """Of stars with radii 0.3 to 2, in any plane and at any height above it, whichever way the curve goes: d = r - s
    or r + s; forces k d are square to the normal. Distances have errors of a few eps."""
    rng = np.random.default_rng(seed)
    count, k = int(rng.integers(3, 12)), 7.0
    turn = 2 * np.pi * np.arange(count) / count
    star = np.column_stack([np.cos(turn), np.sin(turn)]) * rng.uniform(0.3, 2.0, (count, 1))
    near = star[rng.integers(0, count, 10)] + 0.1 * rng.normal(size=(10, 2))
    p, radius = np.concatenate([rng.uniform(-2, 2, (10, 2)), near]), rng.uniform(0.0, 0.4, 20)
    frame = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    way = 1 if rng.random() < 0.5 else -1
    curve, x = star[::way] @ frame[:2] + frame[2], p @ frame[:2] + rng.normal(size=(20, 1)) * frame[2]
    fields = {"normal": 3.0 * frame[2], "radius": radius, "inside": inside, "strength": k}
    f, depth = evaluated(x, curve=curve, **fields)
    flat, after = np.column_stack([star, 0 * turn]), np.column_stack([np.roll(star, -1, axis=0), 0 * turn])
    for i in range(20):
        apart = np.linalg.norm(on_segments(np.array([*p[i], 0.0]), flat, after) - [*p[i], 0.0], axis=1).min()
        within = turning(p[i], star) > 0.5
        expected = max(radius[i] + (apart if within != inside else -apart), 0.0)
        assert depth[i] == pytest.approx(expected, abs=1e-12)
    assert np.abs(f @ frame[2]).max() <= 1e-12 * max(np.abs(f).max(), 1.0)


@pytest.mark.parametrize(("inside", "rest"), [(False, 1.0 + 0.2), (True, -1.0 + 0.2)])
def test_a_circle_pressed_on_a_side_sinks_in_by_its_part_of_the_stiffness(inside: bool, rest: float) -> None:
    """P / k, on a side of a square or in it; the height above its plane stays what it is."""
    load, k = 3.0, 200.0
    scene = Scene(
        particles=[[0.3, 0.9 if inside else 1.15, 7.0]],
        forces=[
            {
                "kind": "collide_curve",
                "particles": [0],
                "curve": SQUARE,
                "inside": inside,
                "radius": 0.2,
                "strength": k,
            },
            {"kind": "unary", "particles": [0], "vector": [0, -load, 0]},
        ],
        anchors=[{"particles": [0], "axes": "xz"}],
        settings={"tolerance": 1e-10},
    )
    found = relax(scene)
    assert found.converged
    assert found.particles[0] == pytest.approx([0.3, rest - load / k, 7.0], abs=1e-9)
    assert found.force("collide_curve")["depth"] == pytest.approx([load / k], rel=1e-8)


def test_circles_in_a_square_are_packed_by_it() -> None:
    """Four of them, pulled to a corner outside each, rest in the corners: both walls carry S (t - c) = k (c + r - 1)
    along each axis, so c = (S t + k (1 - r)) / (S + k)."""
    r, k, pull, t = 0.4, 500.0, 2.0, 3.0
    corners = np.array([[1, 1, 0], [-1, 1, 0], [-1, -1, 0], [1, -1, 0.0]])
    walls = [
        np.array([[-9, -1, 0], [9, -1, 0], [9, 1, 0], [-9, 1, 0.0]]),
        np.array([[-1, -9, 0], [1, -9, 0], [1, 9, 0], [-1, 9, 0.0]]),
    ]
    contact = {"kind": "collide_curve", "particles": range(4), "inside": True, "radius": r, "strength": k}
    scene = Scene(
        particles=0.1 * corners,
        forces=[
            *({**contact, "curve": wall} for wall in walls),
            {"kind": "anchor_spring", "particles": range(4), "targets": t * corners, "strength": pull},
        ],
        settings={"tolerance": 1e-10},
    )
    found = relax(scene)
    assert found.converged
    assert found.particles == pytest.approx((pull * t + k * (1 - r)) / (pull + k) * corners, abs=1e-8)


def test_a_curve_given_with_its_first_corner_again_is_the_same() -> None:
    x = np.random.default_rng(1).uniform(-1.5, 1.5, (30, 3))
    f, _ = evaluated(x, curve=SQUARE, radius=0.3)
    assert (evaluated(x, curve=[*SQUARE, SQUARE[0]], radius=0.3)[0] == f).all() and np.abs(f).max() > 0.0


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        *(
            ({"curve": curve, "normal": normal}, "/forces/0/curve: the curve encloses no area square to its normal")
            for curve, normal in (
                ([], [0, 0, 1]),
                (SQUARE[:2], [0, 0, 1]),
                (SQUARE[:1] * 5, [0, 0, 1]),
                (SQUARE, [1, 0, 0]),
            )
        ),
        ({"curve": SQUARE, "normal": [0, 0, 0]}, "/forces/0/normal"),
    ],
)
def test_a_curve_has_an_inside(fields: Any, message: str) -> None:
    with pytest.raises(InputError, match=message):
        Scene(particles=[[0, 0, 0]], forces=[{"kind": "collide_curve", "particles": [0], **fields}])
