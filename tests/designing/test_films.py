"""Derivatives through soap films, whose vertices may lie anywhere in the film: at the place where they are most even
they are those of whole solves, whatever the mesh."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from hookean.designing import even_films
from hookean.designing.search import design
from hookean.designing.sensitivity import sensitivity
from hookean.running.run import relax

MESH = 4
STEP = 1e-3  # of fourth order: 1e-12 of values of size 1, and rounding of shapes by 1e-12 / 1e-3


def saddle(name: str, pressure: float = 0.4, shift: float = 0.0, tension: float = 2.0,
           mesh: int = MESH) -> dict[str, Any]:  # fmt: skip
    """A film over a saddle of mesh x mesh faces, a side of the rim moved by a shift along z, with what a name adds."""
    number = np.arange((mesh + 1) ** 2).reshape(mesh + 1, mesh + 1)
    x, y = np.divmod(np.arange(number.size), mesh + 1) / np.array([[mesh], [mesh]])
    points = np.column_stack([x, y, 0.8 * ((x - 0.5) ** 2 - (y - 0.5) ** 2 + 0.3 * x * y * y)])
    faces = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=-1).reshape(-1, 4)
    free_side = number[-1, 1:-1].tolist() if name in ("cable", "sliding") else []
    rim = [p for p in np.setdiff1d(number, number[1:-1, 1:-1]).tolist() if p not in free_side]
    targets = points[rim].copy()
    targets[: mesh + 1, 2] += shift
    forces: list[dict[str, Any]] = [
        {"kind": "soapfilm", "name": "film", "mesh": "skin", "tension": tension},
        {"kind": "pressure", "name": "air", "mesh": "skin", "pressure": pressure},
    ]
    side = [number[-1, j].item() for j in range(mesh + 1)]
    if name == "cable":
        pairs = [[a, b] for a, b in pairwise(side)]
        forces.append({"kind": "springs", "particles": pairs, "stiffness": 40.0, "rest_length": 0.2})
    if name == "sliding":
        forces.append({"kind": "pull_to_curve", "particles": free_side, "curve": points[side], "strength": 1e3})
    if name == "fin":  # a second film on the line in the middle, so that three meet there
        middle = number[mesh // 2]
        fin = points[middle] - [0.0, 0.0, 0.5]
        new = len(points) + np.arange(mesh + 1)
        points = np.vstack([points, fin])
        strip = np.stack([middle[:-1], middle[1:], new[1:], new[:-1]], axis=-1)
        faces, rim, targets = np.vstack([faces, strip]), [*rim, *new.tolist()], np.vstack([targets, fin])
        forces[1]["mesh"] = "roof"
    skin = {"vertices": points.tolist(), "faces": faces.tolist()}
    roof = {"vertices": points.tolist(), "faces": faces[: mesh**2].tolist()}
    return {
        "particles": points.tolist(),
        "meshes": {"skin": skin, "roof": roof},
        "forces": forces,
        "anchors": [{"name": "rim", "particles": rim, "targets": targets.tolist()}],
    }


VARIABLES = [
    {"force": "air", "field": "pressure"},
    {"force": "film", "field": "tension"},
    {"anchor": "rim", "axes": "z"},
]


def slope(name: str, goal: dict[str, Any], **way: float) -> float:
    """The derivative by whole solves, of fourth order."""

    def value(by: float) -> float:
        given = {key: start + by * STEP for key, start in way.items()}
        return sensitivity(saddle(name, **given), goals=[goal], variables=VARIABLES).value

    return (8.0 * (value(1.0) - value(-1.0)) - (value(2.0) - value(-2.0))) / (12.0 * STEP)


@pytest.mark.thinned
@pytest.mark.slow
@pytest.mark.parametrize("name", ["plain", "cable", "sliding", "fin"])
def test_derivatives_through_a_coarse_film_are_those_of_whole_solves(name: str) -> None:
    """By pressure, tension and a shift of the rim, of the places of vertices along the film, too, of its area and of
    its pull: within the film, at an edge that a cable holds, at one that slides, and where three films meet."""
    places = {"kind": "position", "particles": [7, 12, 13, 18], "axes": "xz"}
    for goal in (places, {"kind": "area", "mesh": "roof"}, {"kind": "reaction", "anchor": "rim", "axes": "z"}):
        found = sensitivity(saddle(name), goals=[goal], variables=VARIABLES)
        assert not found.warnings
        pressure, tension, moved = found.gradient
        own = [pressure.sum(), tension.sum(), moved.ravel()[: MESH + 1].sum()]
        whole = [slope(name, goal, **{key: start}) for key, start in
                 (("pressure", 0.4), ("tension", 2.0), ("shift", 0.0))]  # fmt: skip
        assert own == pytest.approx(whole, rel=1e-6, abs=1e-8 * max(map(abs, whole)))


def test_a_search_through_a_coarse_film_ends_where_its_goals_are_met() -> None:
    """Three heights that a pressure and a shift of the rim gave are found again, to the last digits."""
    goal = {"kind": "position", "particles": [7, 12, 18], "axes": "z"}
    wanted = sensitivity(saddle("plain", pressure=0.9, shift=0.05), goals=[goal], variables=VARIABLES).values[0]
    side = {"anchor": "rim", "axes": "z", "tie": [list(range(MESH + 1))]}
    problem = {"scene": saddle("plain"), "variables": [{**VARIABLES[0], "tie": "all"}, side],
               "goals": [{**goal, "target": wanted}]}  # fmt: skip
    found = design(problem)
    assert found.status == "converged" and found.goals[0]["met"] and found.objective < 1e-16
    assert found.variables[0]["value"] == pytest.approx(0.9, rel=1e-6)


@pytest.mark.slow
def test_films_of_more_than_a_thousand_particles_have_derivatives_of_whole_solves_along_them() -> None:
    """How a vertex moves within the film as the pressure grows; across the film alone it would be three times as
    much."""
    mesh = 34
    goal = {"kind": "position", "particles": [(mesh + 1) * (mesh // 4) + mesh // 3], "axes": "x"}
    air = [{**VARIABLES[0], "tie": "all"}]

    def at(pressure: float) -> Any:
        return sensitivity(saddle("plain", pressure, mesh=mesh), goals=[goal], variables=air)

    found, (before, after) = at(0.4), (at(0.4 - STEP).value, at(0.4 + STEP).value)
    assert not found.warnings and len(found.result.particles) > 1000
    # of second order: 1e-6, as the pressure is of size 1
    assert found.gradient[0][0] == pytest.approx((after - before) / (2.0 * STEP), rel=1e-5)


def test_films_of_many_particles_are_differentiated_across(monkeypatch: pytest.MonkeyPatch) -> None:
    """There the error of the mesh is slight, and a warning names it."""
    monkeypatch.setattr(even_films, "MOST", 0)
    goal = {"kind": "position", "particles": [13], "axes": "x"}
    said = sensitivity(saddle("plain"), goals=[goal], variables=VARIABLES).warnings
    assert len(said) == 1 and "where in a soap film its vertices lie" in said[0]


@pytest.mark.slow
def test_the_same_film_is_no_other_equilibrium() -> None:
    """A relaxation finds the film of a design with vertices elsewhere along it: a warning is there only where a goal
    depends on their places."""
    scene = saddle("air", pressure=0.4)
    variables = [{"force": "air", "field": "pressure", "tie": "all"}]
    for particle, axes, target, warned in ((12, "z", 0.19, False), (6, "z", 0.1, True)):
        goal = {"kind": "position", "particles": [particle], "axes": axes, "target": target}
        found = design({"scene": scene, "variables": variables, "goals": [goal]})
        again = relax(found.scene).particles
        apart = np.abs(again - found.result.particles).max() / np.linalg.norm(np.ptp(again, axis=0))
        assert found.status == "converged" and apart > 1e-3
        assert not any("another equilibrium" in said for said in found.warnings)
        assert any("same films" in said and "lie: position" in said for said in found.warnings) == warned
