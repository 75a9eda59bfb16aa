"""Wind on faces: plates at an angle, either side, all round."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from core.test_volume import icosahedron
from hookean import InputError, Scene, relax
from hookean.solvers import solver
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


def plate(height: float) -> np.ndarray:
    """A plate across the wind, 2 wide, from z = 0 to a height."""
    return np.array([[0, 0, 0], [0, 2, 0], [0, 2, height], [0, 0, height]], float)


@pytest.mark.parametrize("below", [False, True])
@pytest.mark.parametrize("level", [-1.0, 0.0, 0.7, 2.0, 4.0])
def test_a_waterline_cuts_the_wind_exactly(level: float, below: bool) -> None:
    """On a plate across the wind: the resultant is q b times the height in the wind, with its line of action in the
    middle of that."""
    x, force = plate(3.0), {"kind": "wind", "mesh": "m", "pressure": Q, "waterline": level, "below": below}
    system = compile(Scene(particles=x, meshes={"m": {"vertices": x, "faces": [[0, 1, 2, 3]]}}, forces=[force]))
    f = system.evaluate(system.start())[0]
    low, high = (0.0, min(max(level, 0.0), 3.0)) if below else (min(max(level, 0.0), 3.0), 3.0)
    assert f.sum(axis=0) == pytest.approx([Q * 2.0 * (high - low), 0, 0], abs=1e-13)
    assert (x[:, 2] * f[:, 0]).sum() == pytest.approx(Q * (high**2 - low**2), abs=1e-13)


def test_a_plate_free_in_the_wind_comes_to_its_speed() -> None:
    """m u' = q A (1 - u / W): u = W (1 - exp(-q A t / (m W))). A step of verlet has order 2: (dt q A / m W)^2."""
    x, speed, mass, dt = plate(1.5), 4.0, 0.8, 0.01
    force = {"kind": "wind", "mesh": "m", "pressure": Q, "speed": speed}
    scene = Scene(
        particles=x, masses=mass / 4.0, meshes={"m": {"vertices": x, "faces": [[0, 1, 2, 3]]}}, forces=[force],
        settings={"solver": "verlet", "drag": 0.0, "time_step": dt},
    )  # fmt: skip
    system = compile(scene)
    state, method = system.start(), solver("verlet")
    method.start(system, state)
    method.advance(system, state, 200, 0.0)
    rate = Q * 3.0 / (mass * speed)
    expected = speed * (1.0 - np.exp(-rate * 2.0))
    assert state.v[:, 0] == pytest.approx(np.full(4, expected), rel=2.0 * (rate * dt) ** 2)


def test_wind_takes_the_energy_of_a_plate_that_vibrates_across_it() -> None:
    """A plate on a spring k: m x'' = -k x - q A / W x', so that amplitudes fall by exp(-q A t / (2 m W)); along the
    plate nothing is taken."""
    x, speed, mass, k = plate(1.5), 2.0, 1.0, 100.0
    forces = [
        {"kind": "wind", "mesh": "m", "pressure": Q, "speed": speed},
        {"kind": "anchor_spring", "particles": range(4), "strength": k / 4.0},
    ]
    velocities = np.tile([1.0, 0.0, 1.0], (4, 1))
    scene = Scene(
        particles=x, masses=mass / 4.0, velocities=velocities, forces=forces,
        meshes={"m": {"vertices": x, "faces": [[0, 1, 2, 3]]}},
        settings={"solver": "verlet", "drag": 0.0, "time_step": 0.001},
    )  # fmt: skip
    system = compile(scene)
    state, method = system.start(), solver("verlet")
    method.start(system, state)
    method.advance(system, state, 3000, 0.0)
    c, rest = Q * 3.0 / (2.0 * mass * speed), Q * 3.0 / k
    w = np.sqrt(k / mass - c * c)
    a, b = -rest, (1.0 - c * rest) / w  # x - rest = exp(-c t) (a cos w t + b sin w t)
    away = np.exp(-c * 3.0) * (a * np.cos(3.0 * w) + b * np.sin(3.0 * w))
    assert state.x[0, 0] == pytest.approx(rest + away, abs=1e-4)
    assert state.x[0, 2] == pytest.approx(np.sin(30.0) / 10.0, abs=1e-4)


def test_a_suction_has_no_speed() -> None:
    """It would feed vibrations."""
    x = np.eye(3)
    force = {"kind": "wind", "mesh": "m", "pressure": -1.0, "speed": 2.0}
    with pytest.raises(InputError, match="/forces/0/pressure: a negative pressure given with a speed"):
        Scene(particles=x, meshes={"m": {"vertices": x, "faces": [[0, 1, 2]]}}, forces=[force])


def test_a_wind_without_direction_is_refused() -> None:
    x = np.eye(3)
    force = {"kind": "wind", "mesh": "m", "direction": [0, 0, 0]}
    with pytest.raises(InputError, match="/forces/0/direction: a vector of zero length given"):
        Scene(particles=x, meshes={"m": {"vertices": x, "faces": [[0, 1, 2]]}}, forces=[force])
