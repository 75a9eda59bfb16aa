"""Reactions and loads of structures so stiff that rounding of their coordinates leaves more than the tolerance."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean import Scene, load_cases, relax
from hookean.system.balance import balance
from hookean.system.system import compile

AXIAL = 4e8  # EA [N], under loads of 1 N: a last digit of 4 m is 4e-16 / 0.4 of EA, 4e-7 N
PUSH = [[0.3, 0.2, 0.0], [0.0, 0.0, -1.0]]


def portal(kind: str, **more: Any) -> Scene:
    """Two columns and a beam of clamped tubes, or six bars between two particles and three supports."""
    s = np.linspace(0.0, 1.0, 9)[:, None]
    corners = np.array([[0, 0, 0], [0, 0, 3], [4, 0.5, 3], [4, 0.5, 0.0]])
    x = np.concatenate([corners[i] + (corners[i + 1] - corners[i]) * s[i > 0 :] for i in range(3)])
    tube = {"E": AXIAL / 2e-3, "G": AXIAL / 5.2e-3, "A": 2e-3, "Iy": 2e-6, "Iz": 2e-6, "J": 4e-6}
    frame: dict[str, Any] = {"kind": "beam", "particles": [[i, i + 1] for i in range(24)], **tube}
    held, at = [{"particles": [0, 24], "rotations": "xyz"}], [8, 12]
    if kind == "springs":
        x = np.array([[0, 0, 3.1], [2.3, 0.1, 0], [-1.2, 1.7, 0], [-0.9, -1.9, 0.2], [0.4, 0.3, 5.0]])
        legs = [[0, 1], [0, 2], [0, 3], [4, 1], [4, 2], [4, 3]]
        frame = {"kind": "springs", "particles": legs, "axial_stiffness": AXIAL}
        held, at = [{"particles": [1, 2, 3]}], [0, 4]
    push = {"kind": "unary", "name": "push", "particles": at, "vector": PUSH}
    spec = {"particles": x, "forces": [frame, push], "anchors": held, "settings": {"tolerance": 1e-9}}
    return Scene.read({**spec, **more})


def unbalanced(result: Any) -> tuple[float, float]:
    """The largest part of the sum of reactions and loads by their size [-], and that of their moments about the origin
    by their size [length]."""
    hold, loads = result.reactions, result.loads
    at, pull = result.particles[hold["particles"]], np.asarray(hold["force"])
    moment = np.cross(at, pull).sum(axis=0) + np.asarray(hold.get("moment", np.zeros((1, 3)))).sum(axis=0)
    moment += (np.cross(loads["centre"], loads["resultant"]) + loads["moment"]).sum(axis=0)
    size = np.abs(pull).sum()
    force = np.abs(pull.sum(axis=0) + loads["resultant"].sum(axis=0)).max() / size
    return float(force), float(np.abs(moment).max() / size)


def assert_balanced(result: Any) -> None:
    """Forces to 1e-12, a few hundred times the rounding of a sum. Moments are about where the particles are in the
    result, which is off by the position error, known within a factor of 3: far less than 1e-9 of the size."""
    force, arm = unbalanced(result)
    assert force < 1e-12
    assert arm < 3.0 * result.position_error + 1e-12 < 1e-9


@pytest.mark.parametrize("kind", ["beam", "springs"])
def test_reactions_of_what_is_stiff_balance_small_loads(kind: str) -> None:
    """Where the shape itself leaves more than 1e-9, which the result still says."""
    result = relax(portal(kind))
    assert result.converged and result.rounding_floor > 1e-9
    assert_balanced(result)


def test_without_that_step_they_differ_by_what_is_left() -> None:
    """What `balance` finds in the same shape: reactions, loads and what is out of balance add up to nothing, and what
    is out of balance is what the result says; that is more than the step leaves."""
    scene = portal("springs")
    result = relax(scene)
    system = compile(scene)
    state = system.start()
    system.slots.put(state, result.particles, result.rotations["quaternions"])
    found = balance(system, state)
    assert found.out_of_balance == result.out_of_balance
    whole = found.reactions.sum(axis=0) + result.loads["resultant"].sum(axis=0)
    np.testing.assert_allclose(whole, found.forces.sum(axis=0), atol=1e-14)
    np.testing.assert_allclose(result.reactions["force"], found.reactions[[1, 2, 3]], atol=2e-5)
    assert np.abs(whole).max() > 1e-9 and unbalanced(result)[0] < 1e-12


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["beam", "springs"])
def test_so_do_those_of_load_cases(kind: str) -> None:
    """Each case by itself, as any other shape."""
    more = {"load_cases": {"one": {"forces": ["push"]}}, "combinations": {"two": {"one": -1.7}}}
    for case in load_cases(portal(kind, **more)).cases.values():
        assert case.result.converged
        assert_balanced(case.result)


def test_a_floor_that_nothing_touches_takes_no_step_away() -> None:
    """A cable above a floor, to the tolerance of 1e-6; the exact steps of its case make reactions balance to 1e-12, as
    without the floor. On the floor, exact reactions do not exist, and the result is within the tolerance."""
    spec: dict[str, Any] = {
        "particles": [[0, 0, 0.2], [1, 0, 0.5], [2, 0, 0.2]],
        "forces": [
            {"kind": "springs", "particles": [[0, 1], [1, 2]], "axial_stiffness": 500},
            {"kind": "unary", "name": "push", "particles": [1], "vector": [0, 0, -400]},
            {"kind": "floor"},
        ],
        "anchors": [{"particles": [0, 2]}],
        "load_cases": {"one": {"forces": ["push"]}},
    }
    low, deep = spec, {**spec, "forces": [*spec["forces"][:2], {"kind": "floor", "point": [0, 0, -3]}]}
    lying, above = (load_cases(Scene.read(of)).cases["one"].result for of in (low, deep))
    assert len(above.contacts["force"]) == 0 and len(lying.contacts["force"]) == 1
    assert_balanced(above)
    whole = sum(np.sum(of, axis=0) for of in (lying.reactions["force"], lying.loads["resultant"]))
    assert np.abs(whole + np.sum(lying.contacts["force"], axis=0)).max() <= 400.0 * 1e-6
