"""Mirror images: two soft anchors meet each other's image, a load moves a particle from it."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean import InputError, Scene, relax

POINT, NORMAL = np.array([0.4, -1.0, 0.3]), np.array([2.0, 1.0, -2.0])
X = np.array([[1.0, 0.3, -0.2], [0.4, 1.5, 0.9]])


def image(p: np.ndarray) -> np.ndarray:
    """The mirror image of a point, from its distance to the plane; |NORMAL| = 3."""
    n = NORMAL / 3.0
    return p - 2.0 * ((p - POINT) @ n) * n


def mirrored(stiffness: float, *forces: Any, anchors: Any = (), **columns: Any) -> Any:
    """Two particles, mirror images of each other, and other forces."""
    given = {"point": POINT, "normal": NORMAL, **columns}
    return relax(
        Scene(
            particles=X,
            forces=[{"kind": "mirror", "particles": [[0, 1]], "stiffness": stiffness, **given}, *forces],
            anchors=anchors,
            settings={"tolerance": 1e-11},
        )
    )


@pytest.mark.parametrize("stiffness", [5.0, 1000.0])
def test_two_soft_anchors_share_the_distance_from_their_images(stiffness: float) -> None:
    """r = p2 - M p1 = (t2 - M t1) / (1 + 2 k / S), p2 = t2 - k r / S and p1 the image of the same motion."""
    found = mirrored(stiffness, {"kind": "anchor_spring", "particles": [0, 1], "targets": X, "strength": 10.0})
    missed = (X[1] - image(X[0])) / (1.0 + 2.0 * stiffness / 10.0)
    assert found.converged
    assert found.particles[1] == pytest.approx(X[1] - stiffness * missed / 10.0, abs=1e-8)
    assert found.particles[1] - image(found.particles[0]) == pytest.approx(missed, abs=1e-8)
    assert found.forces[0]["distance"][0] == pytest.approx(np.linalg.norm(missed), abs=1e-8)


def test_a_load_moves_a_particle_from_the_image_of_a_held_one() -> None:
    """p2 = M p1 + P / k."""
    load = np.array([3.0, -1.0, 2.0])
    found = mirrored(20.0, {"kind": "unary", "particles": [1], "vector": load}, anchors=[{"particles": [0]}])
    assert found.converged
    assert found.particles[1] == pytest.approx(image(X[0]) + load / 20.0, abs=1e-9)


def test_by_default_the_plane_is_that_of_y_and_z() -> None:
    found = relax(Scene(particles=X, forces=[{"kind": "mirror", "particles": [[0, 1]]}], anchors=[{"particles": [0]}]))
    assert found.particles[1] == pytest.approx([-1.0, 0.3, -0.2], abs=1e-5)


def test_a_plane_without_a_normal_is_refused() -> None:
    with pytest.raises(
        InputError, match="/forces/0/normal: a vector of zero length given; give one that is not 0, 0, 0"
    ):
        mirrored(1.0, normal=[0, 0, 0])
