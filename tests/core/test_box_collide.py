"""Boxes along the axes: overlaps by brute force, a cube squeezed from all sides, and boxes pressed on each other."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean import Scene, relax
from hookean.errors import InputError
from hookean.system.system import compile


def boxes(low: Any, high: Any, **fields: Any) -> tuple[np.ndarray, dict[str, Any]]:
    """Positions and the force of boxes from lower and upper corners (m, 3)."""
    x = np.stack([np.asarray(low, float), np.asarray(high, float)], axis=1).reshape(-1, 3)
    return x, {"kind": "box_collide", "particles": np.arange(len(x)).reshape(-1, 2), **fields}


def settled(x: np.ndarray, *forces: dict[str, Any], solver: str = "relaxation", **more: Any) -> Any:
    found = relax(Scene(particles=x, forces=forces, settings={"tolerance": 1e-11, "solver": solver}, **more))
    assert found.converged
    return found


def test_overlaps_are_those_of_all_pairs() -> None:
    """E = k o^2 / 2 with o the least way along an axis that parts two boxes, of 150 boxes of any sizes; what keeps the
    shape of each has no force at the start. Forces sum to zero."""
    rng = np.random.default_rng(5)
    low, size = rng.uniform(-5.0, 5.0, (150, 3)), rng.uniform(0.2, 2.0, (150, 3))
    x, force = boxes(low, low + size, strength=40.0)
    system = compile(Scene(particles=x, forces=[force]))
    f, _, energies = system.evaluate(system.start())
    high, expected = low + size, 0.0
    for i in range(150):
        for j in range(i):
            overlap = np.minimum(high[i] - low[j], high[j] - low[i]).min()
            expected += 20.0 * max(overlap, 0.0) ** 2
    assert expected > 100.0 and energies.sum() == pytest.approx(expected, rel=1e-12)
    assert np.abs(f.sum(axis=0)).max() <= 1e-12 * np.abs(f).sum()


@pytest.mark.parametrize("solver", ["relaxation", "newton"])
def test_a_box_squeezed_alike_keeps_its_proportions(solver: str) -> None:
    """To s times its size: K l^2 (s^3 - 1) s^2 / a is the force on each face of the size a, whatever S is."""
    size, stiffness, s = np.array([1.0, 2.0, 4.0]), 50.0, 0.9
    x, force = boxes([[0, 0, 0]], [size], volume_strength=stiffness, proportion_strength=7.0)
    push = stiffness * 2.0**2 * (1.0 - s**3) * s**2 / size  # l^3 = 8
    load = {"kind": "unary", "particles": [1], "vector": -push}
    found = settled(x, force, load, solver=solver, anchors=[{"particles": [0]}])
    assert found.particles[1] == pytest.approx(s * size, abs=1e-8)
    assert found.forces[0]["volume"] == pytest.approx([s**3], rel=1e-8)


def test_a_rectangle_squeezed_alike_keeps_its_proportions() -> None:
    """All boxes are flat along y: they are rectangles, and K l^2 (s^2 - 1) s / a pushes each side, l^2 the area."""
    stiffness, s = 50.0, 0.9
    x, force = boxes([[0, 3, 0]], [[1, 3, 4]], volume_strength=stiffness, proportion_strength=7.0)
    push = stiffness * 4.0 * (1.0 - s**2) * s / np.array([1.0, np.inf, 4.0])
    load = {"kind": "unary", "particles": [1], "vector": -push}
    found = settled(x, force, load, anchors=[{"particles": [0]}])
    assert found.particles[1] == pytest.approx([s, 3.0, 4.0 * s], abs=1e-8)


@pytest.mark.parametrize("solver", ["relaxation", "newton"])
def test_a_box_on_another_sinks_in_by_its_part_of_the_stiffness(solver: str) -> None:
    """The lower one is held, the upper one cannot move sideways and its weight P is on the lower corner: o = P / k, and
    it keeps its size. Given by other corners of the boxes the same."""
    k, load = 200.0, 5.0
    for corners in ([0, 1], [1, 0]):
        x, force = boxes([[0, 0, 0], [0.3, 0.2, 0.98]], [[2, 2, 1], [1.3, 1.2, 1.98]], strength=k)
        force["particles"] = force["particles"][:, corners]
        weight = {"kind": "unary", "particles": [2], "vector": [0, 0, -load]}
        held = [{"particles": [0, 1]}, {"particles": [2, 3], "axes": "xy"}]
        found = settled(x, force, weight, solver=solver, anchors=held)
        assert found.particles[2:, 2] == pytest.approx([1.0 - load / k, 2.0 - load / k], abs=1e-8)


def test_boxes_of_two_forces_do_not_touch() -> None:
    """Only those of one force do."""
    x, force = boxes([[0, 0, 0], [0.5, 0.5, 0.5]], [[1, 1, 1], [1.5, 1.5, 1.5]])
    apart = [{**force, "particles": [[0, 1]]}, {**force, "particles": [[2, 3]]}]
    one, other = (compile(Scene(particles=x, forces=forces)) for forces in ([force], apart))
    assert one.evaluate(one.start())[2].sum() == pytest.approx(0.5 * 1000.0 * 0.25, rel=1e-12)
    assert other.evaluate(other.start())[2].sum() == 0.0


def test_overlapping_boxes_come_apart() -> None:
    """Pushed from a heap, without loads: no two overlap any more, and volumes are as before, to 1e-6."""
    rng = np.random.default_rng(2)
    low = rng.uniform(0.0, 2.0, (12, 3))
    size = rng.uniform(0.5, 1.0, (12, 3))
    x, force = boxes(low, low + size)
    found = settled(x, force)
    assert found.forces[0]["volume"] == pytest.approx(np.ones(12), abs=1e-6)
    low, high = found.particles[::2], found.particles[1::2]
    for i in range(12):
        for j in range(i):
            assert np.minimum(high[i] - low[j], high[j] - low[i]).min() <= 1e-6


def test_a_box_without_a_size_among_others_is_refused() -> None:
    x, force = boxes([[0, 0, 0], [3, 0, 0]], [[1, 1, 1], [4, 0, 1]])
    with pytest.raises(InputError, match="/forces/0: box 1 is flat along y, others are not; give it a size there"):
        compile(Scene(particles=x, forces=[force]))


def test_boxes_with_a_corner_in_common_float() -> None:
    """Two boxes by themselves keep three sizes each, of nine coordinates: three motions meet no resistance, though
    nothing at all is out of balance."""
    force = {"kind": "box_collide", "particles": [[0, 1], [1, 2]]}
    found = relax(Scene.read({"particles": [[0, 0, 0], [1, 1, 1], [3, 2.5, 2]], "forces": [force]}))
    assert found.converged and found.residual == 0.0
    assert (found.stability, found.soft_modes) == ("mechanism", 3)
