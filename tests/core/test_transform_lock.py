"""Transform locks: images of held particles, originals of held images, scales and matrices that are not affine."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean import InputError, Scene, relax

X = np.array([[1.0, 0.3, -0.2], [0.4, 1.5, 0.9]])
LOAD = np.array([3.0, -1.0, 2.0])
TURNED = np.array([[0.0, -1.0, 0.0, 0.3], [1.0, 0.0, 0.0, -0.2], [0.0, 0.0, 1.0, 0.5]])
LARGER = TURNED * [[2.0], [2.0], [2.0]]
SHEARED = np.array([[1.0, 0.5, 0.0, 0.0], [0.0, 1.2, 0.0, 1.0], [0.1, 0.0, 0.7, 0.0]])


def locked(matrix: Any, held: int) -> Any:
    """Two particles, one of them held; the load acts on the other one."""
    return relax(
        Scene(
            particles=X,
            forces=[
                {"kind": "transform_lock", "particles": [[0, 1]], "stiffness": 25.0, "matrix": matrix},
                {"kind": "unary", "particles": [1 - held], "vector": LOAD},
            ],
            anchors=[{"particles": [held]}],
            settings={"tolerance": 1e-11},
        )
    )


@pytest.mark.parametrize("matrix", [TURNED, LARGER, SHEARED], ids=["turned", "larger", "sheared"])
def test_the_image_of_a_held_particle_and_the_original_of_a_held_image(matrix: np.ndarray) -> None:
    """k (p2 - A p1 - t) = P; and with the image held k A^T (A p1 + t - p2) = P."""
    a, t = matrix[:, :3], matrix[:, 3]
    found = locked(matrix, 0)
    assert found.converged
    assert found.particles[1] == pytest.approx(a @ X[0] + t + LOAD / 25.0, abs=1e-9)
    assert found.forces[0]["distance"][0] == pytest.approx(np.linalg.norm(LOAD) / 25.0, abs=1e-9)
    assert found.forces[0]["force"][0] == pytest.approx(-LOAD, abs=1e-8)
    found = locked(matrix, 1)
    assert found.converged
    assert found.particles[0] == pytest.approx(np.linalg.solve(a.T @ a, a.T @ (X[1] - t) + LOAD / 25.0), abs=1e-8)


def test_a_matrix_may_have_four_rows_or_be_one_row() -> None:
    whole = np.vstack([SHEARED, [0, 0, 0, 1]])
    shapes = [locked(m, 0).particles for m in (SHEARED, whole, whole.ravel(), SHEARED.ravel())]
    assert all(np.array_equal(shape, shapes[0]) for shape in shapes)


@pytest.mark.parametrize(
    ("matrix", "said"),
    [
        (np.eye(3), r"shape \[3, 3\] given; 3 or 4 rows of 4 numbers expected"),
        (np.ones((4, 4)), "the last row must be 0, 0, 0, 1: a projection is not an affine transformation"),
        ([["a"] * 4] * 3, "numbers are expected, not text, true, false or null"),
    ],
)
def test_what_is_not_an_affine_transformation_is_refused(matrix: Any, said: str) -> None:
    with pytest.raises(InputError, match=rf"/forces/0/matrix[/0]*: {said}"):
        locked(matrix, 0)
