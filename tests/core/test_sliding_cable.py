"""Sliding cables: one force all along, a pulley at the bisector, slack below the rest length."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

from hookean import InputError, Scene, SlidingCable, relax
from hookean.compiled import dispatch
from hookean.system.system import System, compile

SADDLES = np.array([[0, 0, 0], [2, 0, 1], [3, 1, 0], [5, 1, 2], [6, -1, 0.0]])
PAIRS = [[0, 1], [1, 2], [2, 3], [3, 4]]


def test_the_force_is_the_same_all_along() -> None:
    """Over held saddles T = EA (L - L0) / L0 in every line, however long, and each saddle carries T (u - v) of the unit
    vectors along its two lines."""
    whole = float(np.linalg.norm(np.diff(SADDLES, axis=0), axis=1).sum())
    cable = SlidingCable(particles=PAIRS, axial_stiffness=500.0, rest_length=0.9 * whole)
    found = relax(Scene(particles=SADDLES, forces=[cable], anchors=[{"particles": range(5)}]))
    tension = 500.0 * (1 / 0.9 - 1)
    assert found.force("sliding_cable")["force"] == pytest.approx(np.full(4, tension), rel=1e-13)
    along = np.diff(SADDLES, axis=0) / np.linalg.norm(np.diff(SADDLES, axis=0), axis=1)[:, None]
    carried = tension * (along[:-1] - along[1:])
    assert found.reactions["force"][1:4] == pytest.approx(carried, abs=1e-12 * tension)


@pytest.mark.parametrize("solver", ["auto", "newton"])
def test_a_pulley_hangs_at_the_bisector(solver: str) -> None:
    """A free pulley with a weight W on a cable of length L between supports d apart, one higher by h: both lines make
    the angle a with the vertical, sin a = d / L, T = W / (2 cos a), and L = L0 (1 + T / EA), one equation for L."""
    d, h, weight, axial, rest = 4.0, 1.0, 30.0, 400.0, 6.0
    cable = {"kind": "sliding_cable", "particles": [[0, 1], [1, 2]], "axial_stiffness": axial, "rest_length": rest}
    scene = Scene(
        particles=[[0, 0, 0], [1, 0, -2], [d, 0, h]],
        forces=[cable, {"kind": "unary", "particles": [1], "vector": [0, 0, -weight]}],
        anchors=[{"particles": [0, 2]}, {"particles": [1], "axes": "y"}],
        settings={"solver": solver, "tolerance": 1e-12},
    )
    found = relax(scene)
    assert found.converged and found.stability == "stable"

    def tension(length: float) -> float:
        return 0.5 * weight / np.sqrt(1.0 - (d / length) ** 2)

    length = brentq(lambda own: own - rest * (1.0 + tension(own) / axial), d + 0.1, 50.0, xtol=1e-14)
    assert found.force("sliding_cable")["force"] == pytest.approx(np.full(2, tension(length)), rel=1e-9)
    cosine = np.sqrt(1.0 - (d / length) ** 2)
    first = 0.5 * (length - h / cosine)  # the lines' heights differ by h
    assert found.particles[1] == pytest.approx([first * d / length, 0.0, -first * cosine], abs=1e-8)


def test_prestress_and_materials() -> None:
    """The force at the start; EA of steel and a rope; two cables by their numbers, each with its own length."""
    materials = {"materials": {"steel": {"E": 160e3}}, "sections": {"rope": {"area": 0.01}}}
    cable = {"kind": "sliding_cable", "particles": PAIRS, "material": "steel", "section": "rope", "force": 70.0}
    held = [{"particles": range(5)}]
    found = relax(Scene.read({"particles": SADDLES, **materials, "forces": [cable], "anchors": held}))
    assert found.force("sliding_cable")["force"] == pytest.approx(np.full(4, 70.0), rel=1e-12)
    two = SlidingCable(particles=PAIRS, group=[3, 1, 3, 1], rest_length=4.0, axial_stiffness=10.0)
    found = relax(Scene(particles=SADDLES, forces=[two], anchors=held))
    length = np.linalg.norm(np.diff(SADDLES, axis=0), axis=1)
    tension = 10.0 * (np.array([length[0] + length[2], length[1] + length[3]]) - 4.0) / 4.0
    assert found.force("sliding_cable")["force"] == pytest.approx(np.tile(tension, 2), rel=1e-13)


def test_a_long_cable_is_slack() -> None:
    cable = SlidingCable(particles=PAIRS, rest_length=12.0)
    system = compile(Scene(particles=SADDLES, forces=[cable]))
    f, _, energy = system.evaluate(system.start())
    assert not f.any() and not energy.any()


def tangent(system: System, x: np.ndarray, node: int | None) -> np.ndarray:
    """The tangent of the whole system by gathered elements; nodes are eliminated by their least energy."""
    (group,) = system.groups
    found = SlidingCable.gathered(group.block, group.block.memory, x, node)
    assert found is not None
    count = 1 + max(int(block.indices.max()) for _, block in found)
    whole = np.zeros((3 * count, 3 * count))
    for cls, block in found:
        for index, part in zip(block.indices, cls.tangent(block, x), strict=True):
            at = (3 * index[:, None] + np.arange(3)).ravel()
            np.add.at(whole, (at[:, None], at), part)
    own = 3 * len(x)
    if node is None:
        return whole[:own, :own]
    kept = np.arange(own, len(whole), 3)  # nodes have one axis
    cross = whole[:own, kept]
    return np.asarray(whole[:own, :own] - cross @ np.linalg.solve(whole[np.ix_(kept, kept)], cross.T))


def test_both_tangents_are_the_gradient_of_the_force() -> None:
    """Whole cables, and lines with nodes between them, give K = -df/dx, by central differences of the forces: to the
    square of their step, and for the nodes to the little stiffness that they have besides."""
    force, x = SlidingCable.example()
    system = compile(Scene(particles=x, forces=[force]))
    (group,) = system.groups
    kernel, step = dispatch.compiled(SlidingCable.kernel, "force"), 1e-5
    numeric = np.zeros((x.size, x.size))
    for i in range(x.size):
        sides = []
        for sign in (1.0, -1.0):
            moved = x.copy()
            moved.flat[i] += sign * step
            f = np.zeros_like(x)
            kernel(moved, f * 0, group.block.indices, group.block.parameters, group.block.memory, f, np.zeros(len(x)))
            sides.append(f.ravel())
        numeric[:, i] = (sides[1] - sides[0]) / (2.0 * step)
    size = np.abs(numeric).max()
    for node in (None, len(x)):
        assert tangent(system, x, node) == pytest.approx(numeric, abs=1e-8 * size)


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        ({"axial_stiffness": 1.0, "material": "S355", "section": "a"}, "give either axial_stiffness, or both"),
        ({"section": "a"}, "section given; give either axial_stiffness, or both material and section"),
        ({"axial_stiffness": None}, "nothing given"),
        ({"force": 1.0, "rest_length": 1.0}, "at most one of them"),
        ({"force": 1.0, "axial_stiffness": 0.0}, "a cable without stiffness cannot have a force"),
        ({"particles": [[0, 0]]}, "has no length at the start"),
    ],
)
def test_what_cannot_be_is_one_sentence(given: dict[str, Any], sentence: str) -> None:
    scene = {"particles": SADDLES, "sections": {"a": {"area": 1.0}}}
    with pytest.raises(InputError) as refused:
        compile(Scene.read({**scene, "forces": [{"kind": "sliding_cable", "particles": PAIRS, **given}]}))
    assert sentence in refused.value.sentence
