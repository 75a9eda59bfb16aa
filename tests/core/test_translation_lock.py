"""Translation locks: pairs keep their vector of the start, or get another one."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean import InputError, Scene, relax

X = np.array([[1.0, 0.3, -0.2], [0.4, 1.5, 0.9]])
AIMS = np.array([[2.0, 0.0, 0.0], [0.0, 1.0, 0.5]])


@pytest.mark.parametrize("translation", [None, [0.0, 0.5, -1.0]])
@pytest.mark.parametrize("stiffness", [5.0, 1000.0])
def test_two_soft_anchors_share_the_change_of_the_vector(translation: Any, stiffness: float) -> None:
    """With soft anchors S to aims a: r = p2 - p1 - t = (a2 - a1 - t) / (1 + 2 k / S), p2 = a2 - k r / S."""
    given = {} if translation is None else {"translation": translation}
    found = relax(
        Scene(
            particles=X,
            forces=[
                {"kind": "translation_lock", "particles": [[0, 1]], "stiffness": stiffness, **given},
                {"kind": "anchor_spring", "particles": [0, 1], "targets": AIMS, "strength": 10.0},
            ],
            settings={"tolerance": 1e-11},
        )
    )
    t = X[1] - X[0] if translation is None else np.array(translation)
    missed = (AIMS[1] - AIMS[0] - t) / (1.0 + 2.0 * stiffness / 10.0)
    assert found.converged
    assert found.particles[1] == pytest.approx(AIMS[1] - stiffness * missed / 10.0, abs=1e-8)
    assert found.particles[0] == pytest.approx(AIMS[0] + stiffness * missed / 10.0, abs=1e-8)
    assert found.forces[0]["distance"][0] == pytest.approx(np.linalg.norm(missed), abs=1e-8)


def test_as_many_vectors_as_pairs_or_one() -> None:
    with pytest.raises(InputError, match="/forces/0/translation: 2 values for 1 elements; give one value or one for"):
        relax(
            Scene(
                particles=X,
                forces=[{"kind": "translation_lock", "particles": [[0, 1]], "translation": [[1, 0, 0], [0, 1, 0]]}],
            )
        )
