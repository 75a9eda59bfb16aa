"""Wind on faces: plates at an angle, either side, all round."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from core.test_volume import icosahedron
from hookean import InputError, Scene, relax
from hookean.system.system import compile

Q = 0.6


def force_on(x: np.ndarray, faces: Any, direction: Any = (1.0, 0, 0)) -> np.ndarray:
    force = {"kind": "wind", "mesh": "m", "pressure": Q, "direction": direction}
    system = compile(Scene(particles=x, meshes={"m": {"vertices": x, "faces": faces}}, forces=[force]))
    return np.asarray(system.evaluate(system.start())[0])


@pytest.mark.parametrize("degrees", [0.0, 25.0, 60.0, 90.0, 140.0])
@pytest.mark.parametrize("faces", [[[0, 1, 2, 3]], [[3, 2, 1, 0]], [[0, 1, 2], [0, 2, 3]]])
def test_a_plate_at_an_angle(degrees: float, faces: Any) -> None:
    """q A cos(theta) along its normal, to the lee side, whichever way its corners run; a quarter on each of a quad."""
    angle = np.radians(degrees)
    normal = np.array([np.cos(angle), 0.0, np.sin(angle)])
    across = np.array([-np.sin(angle), 0.0, np.cos(angle)])
    x = np.array([[0, 0], [2, 0], [2, 3], [0, 3]]) @ np.array([across, [0, 1, 0]])
    f = force_on(x, faces, (7.0, 0, 0))
    assert f.sum(axis=0) == pytest.approx(Q * 6.0 * np.cos(angle) * normal, abs=1e-14 * 10)
    if len(faces) == 1:
        assert f == pytest.approx(np.tile(Q * 1.5 * np.cos(angle) * normal, (4, 1)), abs=1e-14 * 10)


@pytest.mark.parametrize("direction", [(1.0, 0, 0), (0.3, -2.0, 1.0)])
def test_all_round_the_wind_pushes_with_a_third_of_the_area(direction: Any) -> None:
    """sum A n n = A / 3 on a body with the symmetry of an icosahedron, so that f = q A d / 3 whatever d."""
    x, faces = icosahedron()
    along = np.array(direction) / np.linalg.norm(direction)
    total = Q * ConvexHull(x).area / 3.0
    assert force_on(x, faces, direction).sum(axis=0) == pytest.approx(total * along, abs=1e-13 * total * 10)


def test_a_hanging_plate_leans_with_the_wind() -> None:
    """A plate of height h that hinges about its upper edge, with the weight W at its lower one: moments about the edge,
    q b h^2 / 2 cos(theta) = W h sin(theta), so tan(theta) = q b h / (2 W). Springs keep h as they are stretched by what
    they carry: h of the result."""
    width, height, weight = 2.0, 1.0, 1.5
    x = np.array([[0, 0, 0], [0, width, 0], [0, width, -height], [0, 0, -height]])
    forces: list[dict[str, Any]] = [
        {"kind": "wind", "mesh": "m", "pressure": Q},
        {"kind": "springs", "particles": [[0, 3], [1, 2]], "stiffness": 1e4},
        {"kind": "unary", "particles": [2, 3], "vector": [0, 0, -weight / 2.0]},
    ]
    held = [{"particles": [0, 1]}, {"particles": [2, 3], "axes": "y"}]
    model = Scene(
        particles=x, meshes={"m": {"vertices": x, "faces": [[0, 1, 2, 3]]}}, forces=forces, anchors=held,
        settings={"tolerance": 1e-10},
    )  # fmt: skip
    found = relax(model)
    lower = found.particles[3]
    reach = np.hypot(lower[0], lower[2])
    assert found.converged
    assert lower[0] / -lower[2] == pytest.approx(Q * width * reach / (2.0 * weight), rel=1e-7)


def test_a_wind_without_direction_is_refused() -> None:
    x = np.eye(3)
    force = {"kind": "wind", "mesh": "m", "direction": [0, 0, 0]}
    with pytest.raises(InputError, match="/forces/0/direction: a vector of zero length given"):
        Scene(particles=x, meshes={"m": {"vertices": x, "faces": [[0, 1, 2]]}}, forces=[force])
