"""Polygons against each other in a plane: corners by turning numbers and closest points, and squares on each other."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.test_collide_curve import turning
from hookean import Scene, relax
from hookean.errors import InputError
from hookean.system.system import compile
from soak import examples

SEEDED = settings(derandomize=True, deadline=None, max_examples=examples(40), database=None)


def loops(counts: Any) -> np.ndarray:
    """Edges of polygons with so many corners each, one after the other."""
    found, start = [], 0
    for count in counts:
        i = np.arange(count)
        found.append(start + np.column_stack([i, (i + 1) % count]))
        start += count
    return np.concatenate(found)


def stars(rng: np.random.Generator, many: int) -> list[np.ndarray]:
    """Polygons (n, 2) that do not cross themselves, of both orientations, over each other."""
    found = []
    for _ in range(many):
        count = int(rng.integers(3, 12))
        turn = 2 * np.pi * np.arange(count) / count
        star = np.column_stack([np.cos(turn), np.sin(turn)]) * rng.uniform(0.3, 1.5, (count, 1))
        found.append((star + rng.uniform(-1.5, 1.5, 2))[:: 1 if rng.random() < 0.5 else -1])
    return found


def pushed(polygons: list[np.ndarray], k: float) -> tuple[np.ndarray, float]:
    """Forces (n, 2) and energy, corner by corner."""
    force, energy = [np.zeros_like(p) for p in polygons], 0.0
    for i, one in enumerate(polygons):
        for j, other in enumerate(polygons):
            for n, p in enumerate(one):
                if i == j or abs(turning(p, other)) < 0.5:
                    continue
                after = np.roll(other, -1, axis=0)
                e = after - other
                t = np.clip(((p - other) * e).sum(1) / (e * e).sum(1), 0.0, 1.0)
                away = p - other - t[:, None] * e
                m = int(np.argmin((away**2).sum(1)))
                energy += 0.5 * k * away[m] @ away[m]
                force[i][n] -= k * away[m]
                force[j][m] += k * (1.0 - t[m]) * away[m]
                force[j][(m + 1) % len(other)] += k * t[m] * away[m]
    return np.concatenate(force), energy


@SEEDED
@given(seed=st.integers(0, 2**32 - 1))
def test_corners_inside_are_pushed_to_the_closest_point(seed: int) -> None:
    """In any plane and at any heights above it, whichever way polygons go: by turning numbers, to 1e-12. Forces sum to
    zero, and so do their moments about the normal."""
    rng = np.random.default_rng(seed)
    polygons, k = stars(rng, 4), 7.0
    frame = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    flat = np.concatenate(polygons)
    x = flat @ frame[:2] + rng.normal(size=(len(flat), 1)) * frame[2]
    force = {"kind": "collide_2d", "particles": loops([len(p) for p in polygons]), "normal": 3.0 * frame[2]}
    system = compile(Scene(particles=x, forces=[{**force, "strength": k}]))
    f, _, energies = system.evaluate(system.start())
    expected, energy = pushed(polygons, k)
    size = max(np.abs(expected).max(), 1.0)
    assert np.abs(f - expected @ frame[:2]).max() <= 1e-12 * size
    assert energies.sum() == pytest.approx(energy, rel=1e-11, abs=1e-20)
    assert np.abs(f.sum(axis=0)).max() <= 1e-12 * size
    assert abs(np.cross(x, f).sum(axis=0) @ frame[2]) <= 1e-12 * size * np.abs(x).max()


@pytest.mark.parametrize("solver", ["relaxation", "newton"])
def test_corners_pressed_on_a_side_sink_in_by_their_part_of_the_stiffness(solver: str) -> None:
    """P / k, below the side of a square that is held; its corners carry the load by the lever rule."""
    k, load = 200.0, np.array([3.0, 5.0])
    lower = [[0, 0, 0], [4, 0, 0], [4, 2, 0], [0, 2, 0]]
    upper = [[1, 1.99, 0], [3, 1.99, 0], [2.5, 4, 0], [1.5, 4, 0]]
    weights = [[0, -p, 0] for p in load]
    scene = Scene(
        particles=[*lower, *upper],
        forces=[
            {"kind": "collide_2d", "particles": loops([4, 4]), "strength": k},
            {"kind": "unary", "particles": [4, 5], "vector": weights},
        ],
        anchors=[{"particles": [0, 1, 2, 3, 6, 7]}, {"particles": [4, 5], "axes": "xz"}],
        settings={"tolerance": 1e-11, "solver": solver},
    )
    found = relax(scene)
    assert found.converged
    assert found.particles[4:6, 1] == pytest.approx(2.0 - load / k, abs=1e-9)
    right = (load * [1.0, 3.0]).sum() / 4.0  # moments about the left corner
    carried = found.forces[0]["force"]
    assert carried[4:].sum(axis=0) == pytest.approx([0.0, load.sum(), 0.0], abs=1e-8)
    held = dict(zip(found.reactions["particles"], found.reactions["force"], strict=True))
    assert [held[3][1], held[2][1]] == pytest.approx([load.sum() - right, right], abs=1e-8)


def test_the_edges_may_come_in_any_order_and_other_forces_are_apart() -> None:
    """The same forces to rounding; polygons of two forces do not feel each other."""
    polygons = stars(np.random.default_rng(8), 4)
    x, edges = np.concatenate(polygons), loops([len(p) for p in polygons])
    x = np.column_stack([x, np.zeros(len(x))])
    last = edges[-len(polygons[-1]) :]
    mixed = np.random.default_rng(1).permutation(edges)
    forces = ([edges], [mixed], [edges[: -len(last)], last])
    found = []
    for some in forces:
        scene = Scene(particles=x, forces=[{"kind": "collide_2d", "particles": one} for one in some])
        system = compile(scene)
        found.append(system.evaluate(system.start())[0])
    assert np.abs(found[1] - found[0]).max() <= 1e-12 * np.abs(found[0]).max()
    without, _ = pushed(polygons[:-1], 1000.0)
    assert np.abs(found[0][len(without) :]).max() > 1.0 and not found[2][len(without) :].any()
    assert np.abs(found[2][: len(without), :2] - without).max() <= 1e-12 * np.abs(without).max()


def test_open_lines_are_no_polygons() -> None:
    force = {"kind": "collide_2d", "particles": [[0, 1], [1, 2]]}
    with pytest.raises(InputError, match="/forces/0: the edges of a collide_2d are no closed loops; give closed"):
        compile(Scene(particles=np.eye(3), forces=[force]))
