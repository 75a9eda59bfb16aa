"""Hinges of beams that turn far: they carry what they carry where the beams are drawn that way."""

from __future__ import annotations

from itertools import product
from typing import Any

import numpy as np
import pytest

from hookean import Beam, Result, Scene, Simulation, mechanisms, relax

from ..laws import laws
from ..laws.cases import case_of

SECTION = {"E": 1e5, "G": 4e4, "A": 0.1, "Iy": 3e-4, "Iz": 2e-4, "J": 4e-4}
RELEASES = ("", "x", "y", "z", "xy", "xz", "yz", "xyz")
LOAD, ARM = 0.01, 1.5


def turned(spec: dict[str, Any], way: list[list[float]]) -> Result:
    """What is at rest once the anchor `end` has been led along a way."""
    settings = {"tolerance": 1e-10, "solver": "newton"}
    simulation = Simulation(Scene.read({**spec, "settings": settings}))
    for target in way:
        simulation.patch({"move": [{"anchor": "end", "targets": [target]}]})
        result = simulation.relax()
        assert result.converged
    return result


def elbow(degrees: float, release: str) -> tuple[dict[str, Any], list[float]]:
    """Two beams, drawn at an angle in the xy plane: the second is hinged about z to the first, which is clamped, and
    its end, held in the plane, carries a load along z; and where that end is."""
    angle = np.radians(degrees)
    end = [2.0 + ARM * np.cos(angle), ARM * np.sin(angle), 0.0]
    beam = {"kind": "beam", **SECTION}
    normals = [[0, 0, 1], [0, 0, 1]] if release == "z" else [[0, 1, 0], [-np.sin(angle), np.cos(angle), 0]]
    spec: dict[str, Any] = {
        "particles": [[0, 0, 0], [2, 0, 0], end],
        "forces": [
            {**beam, "name": "root", "particles": [[0, 1]], "normal": normals[0]},
            {**beam, "name": "arm", "particles": [[1, 2]], "normal": normals[1], "release_start": release},
            {"kind": "unary", "particles": [2], "vector": [0, 0, -LOAD]},
        ],
        "anchors": [{"particles": [0], "rotations": "xyz"}, {"name": "end", "particles": [2], "axes": "xy"}],
    }
    return spec, end


@pytest.mark.parametrize("degrees", [20.0, 90.0, 150.0])
@pytest.mark.parametrize(("release", "moment"), [("z", "My0"), ("y", "Mz0")])
def test_an_elbow_that_is_bent_carries_what_one_drawn_bent_does(release: str, moment: str, degrees: float) -> None:
    """The moment at the hinge is load times arm (statics; the hinge is twisted by less than 0.02), and the deflection
    that of the elbow drawn bent: the same equilibrium, each to 1e-10 of the load."""
    straight, _ = elbow(0.0, release)
    way = [elbow(part, release)[1] for part in np.linspace(0.0, degrees, max(3, int(degrees / 5.0)))[1:]]
    bent, drawn = turned(straight, way), relax(Scene.read(elbow(degrees, release)[0]))
    assert np.abs(bent.force("arm")[moment]) == pytest.approx(LOAD * ARM, rel=1e-3)
    np.testing.assert_allclose(bent.particles, drawn.particles, atol=1e-8 * np.abs(drawn.particles[:, 2]).max())
    assert mechanisms(bent).summary() == mechanisms(drawn).summary()


def crank(degrees: float, side: str) -> tuple[dict[str, Any], list[float]]:
    """A shaft along x from a clamped bearing in which it turns, with Iy = 1.5 Iz and a crank that is drawn turned by an
    angle from y to z, whose end is held across x and carries a load there; and where that end is."""
    cosine, sine = float(np.cos(np.radians(degrees))), float(np.sin(np.radians(degrees)))
    end, ends = [2.0, cosine, sine], [0, 1] if side == "release_start" else [1, 0]
    spec: dict[str, Any] = {
        "particles": [[0, 0, 0], [2, 0, 0], end],
        "forces": [
            {"kind": "beam", "name": "shaft", "particles": [ends], side: "x", "normal": [0, -sine, cosine], **SECTION},
            {"kind": "beam", "particles": [[1, 2]], "normal": [1, 0, 0], **SECTION},
            {"kind": "unary", "particles": [1], "vector": [0, 0, -LOAD]},
        ],
        "anchors": [{"particles": [0], "rotations": "xyz"}, {"name": "end", "particles": [2], "axes": "yz"}],
    }
    return spec, end


@pytest.mark.parametrize("side", ["release_start", "release_end"])
def test_a_shaft_that_turns_in_its_bearing_bends_about_the_axes_that_it_has_turned(side: str) -> None:
    """As one drawn that way: the same equilibrium, each to 1e-10 of the load. Half a turn and more changes no sign."""
    straight, _ = crank(0.0, side)
    for degrees in (60.0, 90.0, 200.0):
        way = [crank(part, side)[1] for part in np.linspace(0.0, degrees, int(degrees / 5.0))[1:]]
        found, drawn = turned(straight, way), relax(Scene.read(crank(degrees, side)[0]))
        np.testing.assert_allclose(found.particles, drawn.particles, atol=1e-11)
        for name in ("My0", "Mz0", "My1", "Mz1"):
            np.testing.assert_allclose(found.force("shaft")[name], drawn.force("shaft")[name], atol=1e-6 * LOAD)


@pytest.mark.parametrize("law", [laws.force_is_the_gradient, laws.tangent_is_the_gradient_of_the_force])
def test_forces_of_hinges_that_are_turned_far_have_an_energy(law: Any) -> None:
    """Of all pairs of releases, with rotations of up to 90 degrees about each axis."""
    start, end = (list(row) for row in zip(*product(RELEASES, RELEASES), strict=True))
    x = np.array([[0.2, 0.1, 0.3], [1.3, 0.4, 0.2]])
    section: dict[str, Any] = {"E": 200.0, "G": 80.0, "A": 1.0, "Iy": 0.08, "Iz": 0.05, "J": 0.14}
    beams = Beam(
        particles=[[0, 1]] * len(start), release_start=start, release_end=end, offset_end=[0.0, 0.1, 0.05],
        normal=[0.1, 0.3, 1.0], **section,
    )  # fmt: skip
    law(case_of("hinged", beams, x), np.random.default_rng(4), 0.45)


def test_a_bar_between_balls_may_turn_round() -> None:
    """Two bars in a row, pinned at all ends: the second is pulled back over the first one, to the other side."""
    bar = {"kind": "beam", "release_start": "xyz", "release_end": "xyz", "normal": [0, 0, 1], **SECTION}
    spec: dict[str, Any] = {
        "particles": [[0, 0, 0], [1, 0, 0], [2, 0, 0]],
        "forces": [
            {**bar, "particles": [[0, 1], [1, 2]]},
            {"kind": "unary", "particles": [2], "vector": [-1, 1e-3, 0]},
        ],
        "anchors": [{"particles": [0], "rotations": "xyz"}],
    }
    result = relax(Scene.read(spec))
    assert result.converged
    np.testing.assert_allclose(result.particles[2], [-2.0, 2e-3, 0.0], atol=1e-3)
