"""Every quantity of an equilibrium: its derivatives against differences of whole solves, and closed forms."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean.designing.equilibrium import settle
from hookean.designing.problem import Problem
from hookean.designing.quantities import QUANTITIES
from hookean.designing.search import design
from hookean.designing.sensitivity import jacobian, sensitivity
from hookean.designing.unknowns import Unknowns
from hookean.errors import InputError
from hookean.system.system import compile

N = 4
POINTS = [[float(i), float(j), 0.1 * i * j] for i in range(N) for j in range(N)]
FACES = [[N * i + j, N * i + j + N, N * i + j + N + 1, N * i + j + 1] for i in range(N - 1) for j in range(N - 1)]
CORNERS = [0, N - 1, N * N - N, N * N - 1]


def roof() -> dict[str, Any]:
    """A net on a mesh of 3 x 3 faces, held at its corners, under loads; and a surface beside it."""
    ground = [[-5, -5, -3], [8, -5, -3.5], [8, 8, -2], [-5, 8, -3]]
    return {
        "meshes": {
            "roof": {"vertices": POINTS, "faces": FACES},
            "ground": {"vertices": ground, "faces": [[0, 1, 2], [0, 2, 3]]},
        },
        "particles": POINTS,
        "forces": [
            {"kind": "springs", "name": "net", "mesh": "roof", "stiffness": 20.0, "rest_factor": 0.8},
            {"kind": "unary", "particles": list(range(N * N)), "vector": [0.1, 0.0, -1.0]},
        ],
        "anchors": [{"name": "corners", "particles": CORNERS[:2]}, {"particles": CORNERS[2:]}],
        "masses": [2.0] * (N * N),
    }


VARIABLES = [
    {"force": "net", "field": "stiffness", "tie": [[0, 1, 2, 3], [9, 10]]},
    {"force": "net", "field": "rest_factor", "tie": "all"},
    {"anchor": "corners", "axes": "z", "tie": [[0], [1]]},
]
INNER = [5, 6, 9]
KINDS: list[dict[str, Any]] = [
    {"kind": "position", "particles": INNER, "axes": "xz"},
    {"kind": "offset", "particles": INNER, "origin": [0, 1, -2], "direction": [1, 0.2, 0.3]},
    {"kind": "offset", "particles": INNER, "origin": [0, 1, -2], "normal": [1, 2, 3]},
    {"kind": "offset", "particles": INNER, "curve": [[0, 0, 0], [2, 1, -1], [3, 3, -2], [3, 9, -2]]},
    {"kind": "offset", "particles": INNER, "mesh": "ground"},
    {"kind": "length", "force": "net", "equal": True},
    {"kind": "length", "force": "net", "total": True},
    {"kind": "force", "force": "net", "elements": [0, 3, 7]},
    {"kind": "force", "force": "net", "smooth": True},
    {"kind": "force_density", "force": "net"},
    {"kind": "load_path", "force": "net"},
    {"kind": "output", "force": "net", "column": "strain"},
    {"kind": "strain_energy", "force": "net"},
    {"kind": "reaction", "anchor": "corners", "size": True},
    {"kind": "reaction", "anchor": "corners", "direction": [1, 1, 1]},
    {"kind": "reaction", "anchor": "corners", "axes": "xy", "total": True},
    {"kind": "area", "mesh": "roof"},
    {"kind": "volume", "mesh": "roof"},
    {"kind": "planarity", "mesh": "roof"},
    {"kind": "fairness", "force": "net"},
    {"kind": "frequency", "mode": 2},
    {"kind": "curvature", "mesh": "roof"},
    {"kind": "direction", "force": "net", "elements": [2, 5], "axes": "xz"},
]


@pytest.fixture(scope="module")
def moved() -> Any:
    """The equilibria of the roof at its unknowns and at four others beside each."""

    def at(values: np.ndarray | None) -> tuple[Any, Unknowns]:
        problem = Problem.read({"scene": roof(), "variables": VARIABLES, "goals": KINDS[:1]})
        system = compile(problem.scene)
        unknowns, state = Unknowns(problem, system), system.start()
        unknowns.put(system, state, unknowns.start if values is None else values)
        return settle(system, state), unknowns

    found, unknowns = at(None)
    steps = 1e-3 * np.eye(unknowns.count)
    around = [[at(unknowns.start + way * step)[0] for way in (-2, -1, 1, 2)] for step in steps]
    return found, unknowns, around


@pytest.mark.parametrize("given", KINDS, ids=lambda given: "-".join(map(str, list(given.values())[:3:2])))
def test_derivatives_are_those_of_whole_solves(given: dict[str, Any], moved: Any) -> None:
    """Differences of order 4 with steps of 1e-3 leave 1e-9; those of the kernels add 1e-7: 1e-6 of the largest."""
    found, unknowns, around = moved
    quantity = Problem.read({"scene": roof(), "variables": VARIABLES, "goals": [given]}).goals[0].quantity
    own = jacobian(found, unknowns, [(quantity, "")])
    expected = np.stack(
        [np.array([1 / 12, -2 / 3, 2 / 3, -1 / 12]) @ [quantity.values(f, "") for f in each] / 1e-3 for each in around],
        axis=1,
    )
    assert own.shape == expected.shape and np.abs(own).max() > 1e-3
    assert own == pytest.approx(expected, abs=1e-6 * np.abs(own).max())


def test_all_quantities_are_tried() -> None:
    """No kind without its derivatives in the test before; those of buckling factors are differences themselves."""
    assert {given["kind"] for given in KINDS} | {"buckling_factor"} == set(QUANTITIES)


@pytest.mark.soak
def test_a_braced_post_has_the_buckling_factor_that_is_asked_for() -> None:
    """A post of height h under a load P at its top, which springs of stiffness c / 2 hold on either side: it buckles at
    c h / P times the load (rigid post on a spring; Timoshenko and Gere, Theory of Elastic Stability, 1961, 2.1)."""
    scene = {
        "particles": [[0, 0, 0], [0, 0, 2], [1, 0, 2], [-1, 0, 2], [0, 1, 2], [0, -1, 2]],
        "forces": [
            {"kind": "springs", "particles": [[0, 1]], "stiffness": 1e6},
            {"kind": "springs", "name": "brace", "particles": [[1, 2], [1, 3], [1, 4], [1, 5]], "stiffness": 4.0},
            {"kind": "unary", "particles": [1], "vector": [0, 0, -5]},
        ],
        "anchors": [{"particles": [0, 2, 3, 4, 5]}],
    }
    problem = {
        "scene": scene,
        "variables": [{"force": "brace", "field": "stiffness", "tie": [[0, 1], [2, 3]], "lower": 1.0}],
        "goals": [{"kind": "buckling_factor", "mode": mode, "target": 2.0 + mode} for mode in (0, 1)],
    }
    found = design(problem)
    c = 2.0 * np.sort(found.variables[0]["value"])
    assert c == pytest.approx([2.0 * 5.0 / 2.0, 3.0 * 5.0 / 2.0], rel=1e-5)  # the post shortens by P / 1e6 h


def test_an_octahedron_has_its_curvature() -> None:
    """Four angles of 60 degrees leave 2 pi / 3 at each vertex, and a third of the four triangles of edge a is
    a² / sqrt(3): 2 pi / (sqrt(3) a²) (angle defect; the sum is 4 pi, Gauss and Bonnet)."""
    vertices = [[1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]]
    faces = [[i, (i + 1) % 4, 4] for i in range(4)] + [[(i + 1) % 4, i, 5] for i in range(4)]
    scene = {
        "meshes": {"solid": {"vertices": vertices, "faces": faces}},
        "forces": [{"kind": "springs", "name": "edges", "mesh": "solid"}],
        "anchors": [{"points": vertices[:2]}, {"points": vertices[4:5]}],
    }
    variable = {"force": "edges", "field": "rest_factor", "tie": "all"}
    found = sensitivity(scene, goals=[{"kind": "curvature", "mesh": "solid"}], variables=[variable])
    assert found.values[0] == pytest.approx(np.full(6, 2.0 * np.pi / (np.sqrt(3.0) * 2.0)), rel=1e-9)


def test_a_mass_on_a_spring_has_the_frequency_that_is_asked_for() -> None:
    """f = sqrt(k / m) / 2 pi of one mass between two springs of rest length 0: k = 2 pi² f² m for both together."""
    scene = {
        "particles": [[-1, 0, 0], [0, 0, 0], [1, 0, 0]],
        "forces": [{"kind": "springs", "name": "s", "particles": [[0, 1], [1, 2]], "stiffness": 5, "rest_length": 0}],
        "anchors": [{"particles": [0, 2]}],
        "masses": [3.0] * 3,
    }
    variables = [{"force": "s", "field": "stiffness", "tie": "all"}]
    found = design({"scene": scene, "variables": variables, "goals": [{"kind": "frequency", "target": 2.0}]})
    assert found.variables[0]["value"] == pytest.approx(2.0 * np.pi**2 * 2.0**2 * 3.0, rel=1e-6)


def test_a_range_asks_for_nothing_within_it() -> None:
    """Forces between 9 and 11: the nearest limit is the target of those outside, and the others keep their weight 0."""
    found = design(
        {
            "scene": roof(),
            "variables": [{"force": "net", "field": "rest_factor", "lower": 0.1, "upper": 2.0}],
            "goals": [{"kind": "force", "force": "net", "lower": 2.0, "upper": 9.0}],
        }
    )
    forces = np.asarray(found.goals[0]["value"])
    assert found.goals[0]["met"] and forces.min() >= 2.0 - 1e-5 and forces.max() <= 9.0 + 1e-5
    assert np.ptp(forces) > 0.1  # not made equal


def test_lengths_that_are_equal_but_for_rounding_meet_the_goal() -> None:
    """A cable of three equal springs under its ends' pull alone: their lengths differ by rounding, which is
    measured by the lengths, not by itself."""
    springs = {"kind": "springs", "name": "cable", "particles": [[0, 1], [1, 2], [2, 3]], "stiffness": 7.3}
    scene = {
        "particles": [[0, 0, 0], [0.3, 0.1, 0], [0.7, 0.3, 0], [1, 0.3, 0.7]],
        "forces": [{**springs, "rest_length": 0.1}],
    }
    problem = {
        "scene": {**scene, "anchors": [{"particles": [0, 3]}]},
        "variables": [{"force": "cable", "field": "rest_length", "tie": "all", "lower": 0.05, "upper": 0.2}],
    }
    for way in ("equal", "smooth"):
        found = design({**problem, "goals": [{"kind": "length", "force": "cable", way: True, "target": 0.0}]})
        assert 0.0 < np.abs(found.goals[0]["value"]).max() < 1e-12
        assert found.goals[0]["met"] is True and found.status == "converged"


@pytest.mark.parametrize(
    "given, pointer, said",
    [
        ({"kind": "offset", "particles": [1]}, "/goals/0", "exactly one of direction"),
        ({"kind": "offset", "particles": [1], "mesh": "hill"}, "/goals/0/mesh", "'hill' does not exist"),
        ({"kind": "offset", "particles": [1], "curve": [[0, 0, 0]]}, "/goals/0/curve", "at least 2 points"),
        ({"kind": "planarity", "mesh": "ground"}, "/goals/0/mesh", "meet no particle"),
        ({"kind": "length", "force": "net", "equal": True, "smooth": True}, "/goals/0", "at most one of"),
        ({"kind": "frequency", "mode": 99}, "/goals/0/mode", "there are 36 free axes"),
        ({"kind": "length", "force": "net", "target": 1, "lower": 0}, "/goals/0/target", "not both"),
        ({"kind": "length", "force": "net", "lower": 2, "upper": 1}, "/goals/0/lower", "more than upper"),
        ({"particles": [1], "axes": "z"}, "/goals/0", "kind is required; known: position, offset, length"),
    ],
)
def test_faults_say_where_and_what(given: dict[str, Any], pointer: str, said: str) -> None:
    """One clear sentence each."""
    with pytest.raises(InputError) as error:
        design({"scene": roof(), "variables": VARIABLES, "goals": [given]})
    assert error.value.faults[0].pointer == pointer and said in error.value.sentence


BARS = 50


def truss(factors: np.ndarray) -> dict[str, Any]:
    """A lattice of bars that are longer or shorter than their places, under loads."""
    rng = np.random.default_rng(224)
    x = np.array([[i, j, 0.2 * k] for i in range(3) for j in range(2) for k in range(2)]) + rng.normal(0, 0.05, (12, 3))
    bars = [[a, b] for a in range(12) for b in range(a + 1, 12) if np.linalg.norm(x[a] - x[b]) < 1.8]
    return {
        "particles": x,
        "forces": [
            {"kind": "springs", "name": "s", "particles": bars, "axial_stiffness": 500.0,
             "rest_factor": rng.uniform(0.97, 1.03, len(bars)) + factors},
            {"kind": "unary", "particles": list(range(4, 12)), "vector": [0, 0.1, -0.5]},
        ],
        "anchors": [{"particles": [0, 1, 2, 3]}],
        "settings": {"tolerance": 1e-12},
    }  # fmt: skip


def test_a_frequency_of_a_stiff_truss_by_its_rest_lengths() -> None:
    """Derivatives of a tangent are differences of fourth order, as are those of whole solves here: with steps of 1e-3
    these leave 1e-9 of the largest."""
    goals, variables = [{"kind": "frequency", "mode": 0}], [{"force": "s", "field": "rest_factor"}]

    def value(step: float) -> float:
        return sensitivity(truss(step * np.eye(BARS)[20]), goals, variables).value

    gradient = sensitivity(truss(np.zeros(BARS)), goals, variables).gradient[0]
    expected = (8.0 * (value(1e-3) - value(-1e-3)) - (value(2e-3) - value(-2e-3))) / 12e-3
    assert gradient[20] == pytest.approx(expected, abs=1e-8 * np.abs(gradient).max())
