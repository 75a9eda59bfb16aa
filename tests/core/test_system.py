"""A compiled scene: what its elements do, by closed forms."""

from __future__ import annotations

import numpy as np
import pytest

from hookean import Scene
from hookean.forces.springs import Springs
from hookean.system.system import compile
from hookean.system.two_ended import spring_ends, spring_forces


@pytest.mark.parametrize("exact", [True, False])
def test_the_tangent_of_a_spring_is_its_closed_form(monkeypatch: pytest.MonkeyPatch, exact: bool) -> None:
    """k along it, k (1 - L0 / l) across: by its own kernel, and by differences of its forces where a force has none.

    A step of h = 1e-6 of the reach of an element, 2 m at least: the truncation is (h / l)^2 k = 1e-12 k, the rounding
    of coordinates up to 5 m leaves u k 5 m / h = 6e-10 k at most.
    """
    if not exact:
        monkeypatch.setattr(Springs, "hessian", None)
    x = np.array([[0.0, 0.0, 0.0], [1.0, 2.0, 2.0], [1.0, 2.0, 5.0]])
    springs = {"kind": "springs", "particles": [[0, 1], [1, 2]], "stiffness": [10.0, 70.0], "rest_length": [2.0, 3.5]}
    system = compile(Scene.read({"particles": x, "forces": [springs]}))
    (group,), state = system.groups, system.start()
    blocks = system.stiffness_blocks(group, state, state.memory[0])
    for block, (a, b), k, rest in zip(blocks, [(0, 1), (1, 2)], [10.0, 70.0], [2.0, 3.5], strict=True):
        length = np.linalg.norm(x[b] - x[a])
        along = np.outer(x[b] - x[a], x[b] - x[a]) / length**2
        own = k * along + k * (1.0 - rest / length) * (np.eye(3) - along)
        assert block == pytest.approx(np.block([[own, -own], [-own, own]]), abs=1e-9 * k)


def test_springs_are_listed_with_their_ends_and_their_forces() -> None:
    """Two tables of springs in one group beside a load: k (l - L0) by hand, and the tables by their numbers."""
    load = {"kind": "unary", "particles": [1], "vector": [0.0, 0.0, -1.0]}
    soft, stiff = (
        {"kind": "springs", "particles": pairs, "stiffness": k, "rest_length": 1.0}
        for pairs, k in (([[0, 1]], 10.0), ([[1, 2], [0, 2]], 20.0))
    )
    system = compile(Scene(particles=[[0, 0, 0], [3, 0, 0], [3, 4, 0]], forces=[soft, load, stiff]))
    pairs, numbers = spring_ends(system)
    assert pairs.tolist() == [[0, 1], [1, 2], [0, 2]] and numbers.tolist() == [0, 2, 2]
    assert spring_forces(system, system.start()) == pytest.approx([20.0, 60.0, 80.0], rel=1e-14)
