"""Drawn positions and masses as variables: derivatives against whole solves, closed forms, refusals."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import hookean
from hookean.designing.drawn import coloured
from hookean.designing.equilibrium import settle
from hookean.designing.problem import Problem
from hookean.designing.search import design
from hookean.designing.sensitivity import sensitivity
from hookean.designing.unknowns import Unknowns
from hookean.errors import InputError
from hookean.forces import KINDS
from hookean.scene.scene import Scene
from hookean.system.system import compile
from soak import SOAK

from .held import held
from .test_gradients import FOUND, cable, difference, step_of

MEASURED = {
    "anchor_spring": "targets", "angle": "rest_angle", "bend": "rest_angle", "clamp_length": "upper_limit",
    "hinge": "rest_angle", "rigid_body": "shape", "sliding_cable": "force", "support": "targets",
    "translation_lock": "translation", "beam": "", "box_collide": "", "gas": "", "membrane": "", "polygon_area": "",
    "shell": "", "smooth": "", "springs": "", "volume": "",
}  # fmt: skip
"""Forces that measure something of the drawn form, with the column that has a number of its own in their example."""
UNMEASURED = sorted(FOUND - set(MEASURED) - {"soapfilm", "rigid_collide"})
SEEDS = range(50 if SOAK else 1)


def drawn(kind: str, seed: int) -> Problem:
    """The force by where its particles are drawn, with random weights on all positions."""
    rng = np.random.default_rng(seed + 1)
    scene = held(kind, seed)["scene"]
    if MEASURED.get(kind):
        force = scene.forces[0].model_copy(update={MEASURED[kind]: None})
        scene = Scene.read({**scene.model_dump(), "forces": [force, *scene.forces[1:]]})
    count = len(KINDS[kind].example()[1])
    goals = [
        {"kind": "position", "particles": [i], "axes": axis, "weight": float(rng.uniform(0.5, 1.5))}
        for i in range(count)
        for axis in "xyz"
    ]
    variables = [{"particles": list(range(count)), "field": "drawn"}]
    return Problem.read({"scene": scene, "variables": variables, "goals": goals})


@pytest.mark.thinned
@pytest.mark.parametrize("kind", [*MEASURED, *(UNMEASURED if SOAK else UNMEASURED[::12])])
def test_the_drawn_form_by_differences_of_whole_solves(kind: str) -> None:
    """As for columns (test_gradients): differences of order 4 leave 1e-9, of a tangent by differences 1e-7: 1e-6 of
    the largest derivative. Forces that measure nothing have none; a cable has none where it is slack."""
    sizes: list[float] = []
    for seed in SEEDS:
        given = drawn(kind, seed)
        found = sensitivity(given)
        gradient, own = found.gradient[0].ravel(), Unknowns(given, compile(given.scene))
        largest = float(np.abs(gradient).max())
        sizes.append(largest)
        assert found.result.converged
        size = sum(g.weight * np.abs(v).sum() for g, v in zip(given.goals, found.values, strict=True))
        rng = np.random.default_rng(seed)
        for unknown in {int(np.argmax(np.abs(gradient))), int(rng.integers(len(gradient)))}:
            for part in (1e-3, 1e-4, 1e-5):
                expected = difference(given, own.start, own.lower, unknown, part)
                rounding = 1e-14 * size / step_of(own.start, unknown, part)
                close = gradient[unknown] == pytest.approx(expected, abs=1e-6 * largest + rounding)
                if close:
                    break
            assert close, (seed, unknown, gradient[unknown], expected)
    assert (max(sizes) > 0.0) == (kind in MEASURED)


def net(points: np.ndarray) -> dict[str, Any]:
    """A hanging net of lines between drawn points (4 x 4), with its corners held where they are drawn."""
    grid = points.reshape(4, 4, 3)
    pairs = [(grid[i, j], grid[i + 1, j]) for i in range(3) for j in range(4)]
    pairs += [(grid[i, j], grid[i, j + 1]) for i in range(4) for j in range(3)]
    return {
        "forces": [
            {"kind": "springs", "name": "net", "lines": [[a.tolist(), b.tolist()] for a, b in pairs],
             "stiffness": 40.0, "rest_factor": 0.9},
            {"kind": "unary", "points": points.tolist(), "vector": [0, 0, -0.5]},
        ],
        "anchors": [{"points": [grid[i, j].tolist()]} for i in (0, 3) for j in (0, 3)],
        "settings": {"tolerance": 1e-12},
    }  # fmt: skip


def drawing(seed: int = 2) -> np.ndarray:
    """Points of an irregular grid."""
    rng = np.random.default_rng(seed)
    flat = np.array([[i, j, 0.0] for i in range(4) for j in range(4)], dtype=float)
    return flat + 0.1 * rng.normal(size=flat.shape)


def number_of(scene: Scene, point: np.ndarray) -> int:
    """The particle drawn at a point."""
    return int(np.linalg.norm(compile(scene).points - point, axis=1).argmin())


def test_coordinates_move_with_their_particles() -> None:
    """A net given by lines and points, with anchors at points: derivatives by a corner, which is held where it is
    drawn, and by an inner point are differences of nets that are drawn elsewhere, to 1e-6 of the largest."""
    points = drawing()
    scene = Scene.read(net(points))
    at = [number_of(scene, points[i]) for i in (0, 5)]
    mid = number_of(scene, points[10])
    goal = [{"kind": "position", "particles": [mid], "axes": "z"}]
    found = sensitivity(scene, goals=goal, variables=[{"particles": at, "field": "drawn"}]).gradient[0]
    expected = np.zeros((2, 3))
    for row, point in enumerate((0, 5)):
        for axis in range(3):
            sides = []
            for way in (1e-4, -1e-4):
                moved = points.copy()
                moved[point, axis] += way
                sides.append(hookean.relax(Scene.read(net(moved))).particles[mid, 2])
            expected[row, axis] = (sides[0] - sides[1]) / 2e-4
    assert found.shape == (2, 3) and found == pytest.approx(expected, abs=1e-6 * np.abs(expected).max())


def test_a_form_is_drawn_so_that_it_hangs_where_it_should() -> None:
    """The height of the middle by the drawn height of all but the corners: the scene of the answer, drawn there,
    relaxes to the target by itself."""
    points = drawing()
    scene = Scene.read(net(points))
    inner = [number_of(scene, points[i]) for i in range(16) if i not in (0, 3, 12, 15)]
    mid = number_of(scene, points[5])
    found = design(
        {
            "scene": scene,
            "variables": [{"particles": inner, "field": "drawn", "axes": "z", "tie": "all", "lower": -2, "upper": 2}],
            "goals": [{"kind": "position", "particles": [mid], "axes": "z", "target": -0.9}],
        }
    )
    assert found.status == "converged" and found.variables[0]["unit"] == "length"
    again = hookean.relax(Scene.read(found.scene.model_dump()))
    assert again.particles[mid, 2] == pytest.approx(-0.9, abs=1e-6)


def test_a_frequency_by_the_mass() -> None:
    """f = sqrt(k / m) / 2 pi: df/dm = -f / (2 m) with all masses tied, and as the sum of those by single masses."""
    masses = np.array([1.0, 2.5, 1.0])
    scene = {**cable(), "masses": masses.tolist()}
    goal = [{"kind": "frequency"}]
    whole = sensitivity(scene, goals=goal, variables=[{"particles": [1], "field": "mass"}])
    assert whole.gradient[0] == pytest.approx([-whole.value / (2.0 * 2.5)], rel=1e-10)
    m = {"field": "mass", "particles": [0, 1, 2]}
    equal = sensitivity({**scene, "masses": 2.5}, goals=goal, variables=[{**m, "tie": "all"}])
    each = sensitivity({**scene, "masses": 2.5}, goals=goal, variables=[m])
    assert equal.gradient[0] == pytest.approx([-equal.value / 5.0], rel=1e-10)
    assert each.gradient[0].sum() == pytest.approx(equal.gradient[0][0], rel=1e-10)
    found = design({"scene": scene, "variables": [{"particles": [1], "field": "mass"}],
                    "goals": [{**goal[0], "target": 0.5 * whole.value}]})  # fmt: skip
    assert np.ravel(found.variables[0]["value"]) == pytest.approx([10.0], rel=1e-6)
    assert found.scene.masses[1] == pytest.approx(10.0, rel=1e-6)


def test_the_mass_of_particles_that_only_forces_name() -> None:
    """A particle between two springs that give coordinates: m = 4 k / (2 pi f)², of the scene found as well, and
    beside a drawn position."""
    springs = {"kind": "springs", "lines": [[[0, 0, 0], [1, 0, 0]], [[1, 0, 0], [2, 0, 0]]], "stiffness": 3.0}
    scene = {"forces": [{**springs, "rest_length": 0.5}], "anchors": [{"points": [[0, 0, 0], [2, 0, 0]]}]}
    middle = {"points": [[1, 0, 0]], "field": "mass"}
    goal = {"kind": "frequency", "mode": 2, "target": 0.25}
    drawn = {"points": [[0, 0, 0]], "field": "drawn", "axes": "x", "lower": 0.0, "upper": 0.0}
    for variables in ([middle], [middle, drawn], [drawn, middle]):
        found = design({"scene": scene, "variables": variables, "goals": [goal]})
        mass = next(np.ravel(v["value"]) for v in found.variables if v["name"] == "mass")
        assert found.status == "converged" and mass == pytest.approx([2.0 * 3.0 / (0.5 * np.pi) ** 2], rel=1e-6)
        assert hookean.frequencies(found.scene, 3).frequencies[2] == pytest.approx(0.25, rel=1e-6)
    with pytest.raises(InputError, match="particle 3 does not exist; there are 3, from 0"):
        design({"scene": scene, "variables": [{"particles": [3], "field": "mass"}], "goals": [goal]})


def test_particles_that_vary_are_checked() -> None:
    """Each fault with its place: fields, numbers, films, and what stands beside particles."""
    goal = [{"kind": "position", "particles": [1], "axes": "z"}]
    for variable, at in (
        ({"particles": [1], "field": "stiffness"}, "/variables/0/field"),
        ({"particles": [9], "field": "drawn"}, "/variables/0/particles"),
        ({"particles": [1, 1], "field": "mass"}, "/variables/0/particles"),
        ({"particles": [1], "field": "drawn", "anchor": "left"}, "/variables/0"),
    ):
        with pytest.raises(InputError) as error:
            sensitivity(cable(), goals=goal, variables=[variable])
        assert error.value.pointer == at
    film = {"meshes": {"f": {"vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "faces": [[0, 1, 2]]}},
            "forces": [{"kind": "soapfilm", "mesh": "f", "tension": 1.0}],
            "anchors": [{"points": [[0, 0, 0], [1, 0, 0]]}]}  # fmt: skip
    with pytest.raises(InputError, match="drawn positions do not vary beside soap films"):
        sensitivity(film, goals=goal, variables=[{"particles": [2], "field": "drawn"}])


def test_points_name_particles_of_variables() -> None:
    """As in goals: by where they are drawn."""
    goal = [{"kind": "position", "particles": [1], "axes": "z"}]
    ways = [{"particles": [1]}, {"points": [[0, 0, -0.2]]}]
    one, two = (sensitivity(cable(), goals=goal, variables=[{**w, "field": "drawn"}]).gradient[0] for w in ways)
    assert np.array_equal(one, two)


def test_particles_apart_share_no_element() -> None:
    """Each of the particles that vary is in one list, and no two of a list in one element."""
    index = np.random.default_rng(3).integers(0, 60, (90, 3))
    varying = np.unique(index)[::2]
    lists = coloured(index, varying, 60)
    assert sorted(np.concatenate(lists).tolist()) == varying.tolist()
    for each in lists:
        assert all(len(set(row) & set(each.tolist())) <= 1 for row in index.tolist())


def test_a_net_takes_a_few_compilations(monkeypatch: pytest.MonkeyPatch) -> None:
    """The drawn points of a square net are apart in two lists, of three axes each, and derivatives are those of
    one particle at a time, to the rounding of differences, 1e-9."""
    points = drawing()
    scene = Scene.read(net(points))
    goal = [{"kind": "position", "particles": [5], "axes": "z"}]
    problem = Problem.read({"scene": scene, "variables": [{"particles": list(range(16)), "field": "drawn"}],
                            "goals": goal})  # fmt: skip
    system = compile(problem.scene)
    unknowns, state = Unknowns(problem, system), system.start()
    found = settle(system, state)
    y = np.random.default_rng(1).normal(size=state.x.shape)
    column = next(v for v, _ in unknowns.parts[1:] if v.group.cls.kind_name == "springs")
    quick = unknowns.work(found, y)
    assert len(column._own) == 2
    column._own = [np.array([p]) for p in range(16)]
    assert quick == pytest.approx(unknowns.work(found, y), abs=1e-9 * np.abs(quick).max())
