"""Buckling and load paths of load cases: from the form, under the loads of the case times their factors."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import hookean
from hookean import InputError, Scene
from hookean.files.report import report

LENGTH, PARTS, EI = 3.0, 8, 210e9 * np.pi / 64.0 * (0.06**4 - 0.054**4)
EULER = np.pi**2 * EI / LENGTH**2


def column(**more: Any) -> Scene:
    """A pinned column of a tube under two loads of 1 kN and 0.5 kN in cases, and one of 0.2 kN that always acts."""
    down = [("P", -1000.0), ("Q", -500.0), ("dead", -200.0)]
    pushes = [{"kind": "unary", "name": n, "particles": [PARTS], "vector": [0, 0, f]} for n, f in down]
    return Scene.read(
        {
            "particles": np.linspace([0, 0, 0], [0, 0, LENGTH], PARTS + 1),
            "materials": {"steel": {"E": 210e9, "G": 81e9}},
            "sections": {"tube": {"shape": "tube", "diameter": 0.06, "thickness": 0.003}},
            "forces": [
                {"kind": "beam", "particles": [[i, i + 1] for i in range(PARTS)], "material": "steel"}
                | {"section": "tube"},
                *pushes,
            ],
            "anchors": [{"particles": [0], "rotations": "z"}, {"particles": [PARTS], "axes": "xy"}],
            "load_cases": {"P": {"forces": ["P"]}, "Q": {"forces": ["Q"], "factor": 2.0}},
            "combinations": {"ULS": {"permanent": 1.35, "P": 1.5, "Q": 0.5}},
            **more,
        }
    )


@pytest.mark.parametrize(
    ("case", "loads", "grows", "rests"),
    [
        ("P", None, 1200.0, 0.0),
        ("Q", None, 1200.0, 0.0),
        ("ULS", None, 1.35 * 200.0 + 1500.0 + 500.0, 0.0),
        ("ULS", ["P"], 1500.0, 1.35 * 200.0 + 500.0),
        (None, ["dead"], 200.0, 0.0),
    ],
)
def test_a_column_buckles_under_the_loads_of_a_case(
    case: str | None, loads: list[str] | None, grows: float, rests: float
) -> None:
    """factor x what grows + what rests = Euler's load; beams of a cubic are stiffer by (pi / n)^4 / 720 at most, and
    what rests shortens the column by its strain, of which the load takes twice."""
    found = hookean.buckling(column(), 1, loads=loads, case=case)
    area = np.pi / 4.0 * (0.06**2 - 0.054**2)
    rel = (np.pi / PARTS) ** 4 / 720.0 + 2.0 * rests / (210e9 * area)
    assert found.factors[0] * grows + rests == pytest.approx(EULER, rel=rel)


def test_loads_of_cases_are_not_taken_for_none() -> None:
    """They would not act: all loads, or one of them by name, without a case."""
    with pytest.raises(InputError, match=r"loads: P, Q: of load cases, which .* as case, or loads that act"):
        hookean.buckling(column())
    with pytest.raises(InputError, match="loads: P: of load cases, which do not act by themselves"):
        hookean.load_path(column(), loads=["dead", "P"])
    with pytest.raises(InputError, match="case: 'snow' is not a load case or combination; the scene has P, Q, ULS"):
        hookean.load_path(column(), case="snow")


def test_a_result_names_the_loads_of_cases_that_it_is_without() -> None:
    """And the result of a case does not name those of others."""
    assert repr(hookean.relax(column())).endswith("without P, Q, of load cases")
    assert "without" not in repr(hookean.load_cases(column(), ["P"]).cases["P"].result)


def test_the_load_path_of_a_case_goes_through_its_equilibrium() -> None:
    """A net that is formed, frozen and loaded: where the factor is 1, it is where the case has it."""
    side = range(5)
    net = Scene.read(
        {
            "particles": [[x, y, 1.0 if x == y else 0.0] for x in side for y in side],
            "forces": [
                {"kind": "springs", "name": "net", "stiffness": 30.0, "rest_factor": 0.0}
                | {"particles": [[5 * x + y, 5 * x + y + 1] for x in side for y in range(4)]
                   + [[5 * x + y, 5 * x + y + 5] for x in range(4) for y in side]},
                {"kind": "unary", "name": "snow", "particles": [6, 7, 8, 11, 12, 13, 16, 17, 18], "vector": [0, 0, -4]},
            ],
            "anchors": [{"particles": [i for i in range(25) if {i // 5, i % 5} & {0, 4}]}],
            "load_cases": {"snow": {"forces": ["snow"]}},
            "stages": {"freeze": {"net": {"axial_stiffness": 500.0}}},
            "settings": {"tolerance": 1e-12},
        }
    )  # fmt: skip
    cases = hookean.load_cases(net)
    path = hookean.load_path(net, case="snow", largest_factor=1.0, increment=0.5)
    assert path.loads == ("snow",) and path.factors[-1] == pytest.approx(1.0, abs=1e-12)
    np.testing.assert_allclose(path.particles[0], cases.form.particles, atol=1e-9)
    np.testing.assert_allclose(path.particles[-1], cases.cases["snow"].result.particles, atol=1e-6)


def test_what_is_no_scene_is_named() -> None:
    """A result or the cases themselves, where a scene is meant."""
    scene = column()
    result, cases = hookean.relax(scene), hookean.load_cases(scene, ["P"])
    wanted = "scene: a Scene is expected, not a Result"
    for asked in (hookean.load_cases, report, hookean.cables, lambda given: hookean.buckling(given, case="P")):
        with pytest.raises(InputError, match=wanted):
            asked(result)
    with pytest.raises(InputError, match="scene: a Scene is expected, not a LoadCases"):
        hookean.cables(cases)


@pytest.mark.parametrize("weight", [{"total": 50.0, "particles": [1]}, {"per_length": 50.0, "particles": [[0, 1]]}])
def test_factors_on_a_weight_are_no_masses(weight: dict[str, Any]) -> None:
    """A weight on a vertical wire of k, of which all or half is on its lower end: omega^2 = k g / W, whatever the
    factors on the weight, in a case and in combinations."""
    scene = Scene.read(
        {
            "particles": [[0, 0, 0], [0, 0, -1]],
            "forces": [
                {"kind": "springs", "particles": [[0, 1]], "stiffness": 1e5},
                {"kind": "self_weight", "name": "weight", **weight},
            ],
            "anchors": [{"particles": [0]}, {"particles": [1], "axes": "xy"}],
            "load_cases": {"dead": {"forces": ["weight"], "factor": 2.0}},
            "combinations": {"ULS": {"dead": 1.35}, "up": {"dead": -0.9}},
        }
    )
    square = 1e5 * 9.80665 / (50.0 if "total" in weight else 25.0)
    for case in hookean.load_cases(scene).cases.values():
        found = hookean.frequencies(case.result, 1, masses="self_weight")
        assert found.angular_frequencies[0] == pytest.approx(square**0.5, rel=1e-9)


def test_frequencies_and_mechanisms_of_a_case_are_those_of_its_result() -> None:
    """By its name, the bits of its result; a result has its loads already."""
    scene = column()
    shape = hookean.load_cases(scene, ["ULS"]).cases["ULS"].result
    assert (hookean.frequencies(scene, case="ULS").frequencies == hookean.frequencies(shape).frequencies).all()
    assert (hookean.frequencies(scene).frequencies != hookean.frequencies(shape).frequencies).any()
    assert hookean.mechanisms(scene, case="ULS").to_dict() == hookean.mechanisms(shape).to_dict()
    with pytest.raises(InputError, match="case: 'ULS' given with a Result; give the scene that has this case"):
        hookean.frequencies(shape, case="ULS")
    with pytest.raises(InputError, match="case: 'snow' is not a load case or combination; the scene has P, Q, ULS"):
        hookean.mechanisms(scene, case="snow")
