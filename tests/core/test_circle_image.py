"""Circles as large as an image says: radii in closed form, contacts on a slope, and circles of one size."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean import Scene, relax
from hookean.errors import InputError
from hookean.forces import CircleImage
from hookean.system.system import compile

CORNERS = [[-10.0, -10.0, 0.0], [10.0, 10.0, 0.0]]


def slope(low: float, high: float, count: int = 20) -> np.ndarray:
    """An image whose numbers grow along x, linearly: those in the middle of pixels, between its rims."""
    return np.tile(low + (high - low) * (np.arange(count) + 0.5) / count, (3, 1))


def compiled(x: Any, **fields: Any) -> Any:
    force = CircleImage(particles=range(len(x)), **{"corners": CORNERS, **fields})
    return force, compile(Scene(particles=x, forces=[force]))


def test_on_a_linear_image_the_radius_is_linear() -> None:
    """B-splines repeat linear functions: R = r0 + (r1 - r0) (x + 10) / 20, from a pixel within the rims, at any y; 10
    pixels outside it is that of the rim."""
    x = np.random.default_rng(0).uniform([-8.9, -30.0, -5.0], [8.9, 30.0, 5.0], (20, 3))
    x = np.vstack([x, [[-20.0, 0, 0], [20.0, 0, 0]]])
    force, system = compiled(x, image=slope(0.0, 1.0), minimum_radius=0.3, maximum_radius=0.7)
    found = force.measure(system.groups[0].block, x, np.zeros((22, 1, 3)))["radius"]
    assert found[:20] == pytest.approx(0.3 + 0.4 * (x[:20, 0] + 10.0) / 20.0, abs=1e-14)
    assert found[20:] == pytest.approx([0.31, 0.69], abs=1e-14)


def test_one_bright_pixel_is_a_blot_of_a_quadratic_spline() -> None:
    """In the middle of the pixel 9/16 of its brightness (3/4 along each axis), at its corner 1/4, and nothing from one
    and a half pixels on."""
    image = np.zeros((20, 20))
    image[10, 10] = 1.0
    x = np.array([[0.5, 0.5, 0], [1.0, 1.0, 0], [2.0, 0.5, 0], [0.5, 3.0, 0], [1.5, 0.5, 0]])
    force, system = compiled(x, image=image, minimum_radius=1.0, maximum_radius=2.0)
    found = force.measure(system.groups[0].block, x, np.zeros((5, 1, 3)))["radius"]
    assert found - 1.0 == pytest.approx([9 / 16, 1 / 4, 0.0, 0.0, 3 / 4 * 1 / 8], abs=1e-14)


def test_of_one_grey_it_is_collide() -> None:
    """The same forces and energy as with that radius for all, to rounding."""
    x = np.random.default_rng(1).uniform(-6.0, 6.0, (300, 3))
    given = {"particles": range(300), "strength": 40.0, "collision_group": np.arange(300) % 7}
    one = {"kind": "circle_image", "image": [[0.5]], "corners": CORNERS, "minimum_radius": 0.2, "maximum_radius": 1.4}
    systems = [
        compile(Scene(particles=x, forces=[{**given, **kind}])) for kind in (one, {"kind": "collide", "radius": 0.8})
    ]
    (f, _, energy), (g, _, same) = (system.evaluate(system.start()) for system in systems)
    assert np.abs(f - g).max() <= 1e-13 * np.abs(g).max() and np.abs(g).max() > 1.0
    assert energy.sum() == pytest.approx(same.sum(), rel=1e-13)


def test_contacts_are_those_of_all_pairs() -> None:
    """By brute force on a steep image, with the slope of the radius: the force on a circle is minus the sum of k o
    (n + R'), n towards the other one."""
    rng = np.random.default_rng(3)
    x = rng.uniform([-8, -8, -1], [8, 8, 1], (120, 3))
    k, low, high = 30.0, 0.3, 1.5
    _, system = compiled(x, image=slope(0.0, 1.0), minimum_radius=low, maximum_radius=high, strength=k)
    f, _, energies = system.evaluate(system.start())
    rate = (high - low) / 20.0
    radius, expected, energy = low + rate * (x[:, 0] + 10.0), np.zeros_like(x), 0.0
    for i in range(len(x)):
        for j in range(len(x)):
            length = np.linalg.norm(x[j] - x[i])
            overlap = radius[i] + radius[j] - length
            if i != j and overlap > 0.0:
                expected[i] -= k * overlap * ((x[j] - x[i]) / length + [rate, 0.0, 0.0])
                energy += 0.25 * k * overlap * overlap
    assert np.abs(f - expected).max() <= 1e-12 * np.abs(expected).max() and np.abs(expected).max() > 1.0
    assert energies.sum() == pytest.approx(energy, rel=1e-12)


@pytest.mark.parametrize("solver", ["relaxation", "newton"])
def test_a_circle_pressed_against_a_held_one_on_a_slope(solver: str) -> None:
    """R = a + b x. A load P towards the held one: k o (1 - b) = P, and with o = 2 a + b (s + x) - (x - s) it rests at
    x = (2 a + (1 + b) s - o) / (1 - b)."""
    low, high, k, load, start = 0.5, 1.5, 200.0, 3.0, -2.0
    b = (high - low) / 20.0
    a = low + 10.0 * b
    force = {"kind": "circle_image", "particles": [0, 1], "image": slope(0.0, 1.0), "corners": CORNERS}
    force |= {"minimum_radius": low, "maximum_radius": high, "strength": k}
    scene = Scene(
        particles=[[start, 0, 0], [-0.2, 0, 0]],
        forces=[force, {"kind": "unary", "particles": [1], "vector": [-load, 0, 0]}],
        anchors=[{"particles": [0]}, {"particles": [1], "axes": "yz"}],
        settings={"tolerance": 1e-11, "solver": solver},
    )
    found = relax(scene)
    overlap = load / (k * (1.0 - b))
    assert found.converged
    assert found.particles[1, 0] == pytest.approx((2.0 * a + (1.0 + b) * start - overlap) / (1.0 - b), abs=1e-9)


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"image": [0.1, 0.2]}, r"/forces/0/image: shape \[2\] given; rows of numbers expected"),
        ({"image": [[0.1, 1.2]]}, "/forces/0/image: 0.1 to 1.2 given; numbers from 0 to 1 allowed"),
        ({"corners": [[0, 0, 0], [1, 0, 5]]}, "/forces/0/corners: two opposite corners of a rectangle expected"),
        ({"corners": [[0, 0, 0], [1e-300, 1, 0]]}, "/forces/0/corners: two opposite corners of a rectangle expected"),
        ({"minimum_radius": 0.0}, "/forces/0/minimum_radius"),
    ],
)
def test_an_image_is_a_grid_over_a_rectangle(fields: Any, message: str) -> None:
    force = {"kind": "circle_image", "particles": [0], "image": [[0.5]], "corners": CORNERS, **fields}
    with pytest.raises(InputError, match=message):
        Scene(particles=[[0, 0, 0]], forces=[force])
