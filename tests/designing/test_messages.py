"""What is wrong with a problem is one sentence with its place; what an answer names, it names once."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import pytest

import hookean
from hookean.errors import InputError

VARIABLE = {"force": "s", "field": "rest_length", "tie": "all", "lower": 0.5, "upper": 2.0}
GOAL = {"kind": "position", "particles": [1], "axes": "z", "target": -0.4}


def problem(**parts: Any) -> dict[str, Any]:
    """Three links that meet, and a load where they do."""
    springs = {"kind": "springs", "name": "s", "particles": [[0, 1], [1, 2], [1, 3]], "stiffness": 100.0}
    scene = {
        "particles": [[-1, 0, 0], [0, 0, -0.2], [1, 0, 0], [0, 1, 0]],
        "forces": [{**springs, "rest_length": [1.0, 1.0, 1.0]}, {"kind": "unary", "name": "l", "particles": [1]}],
        "anchors": [{"name": "a", "particles": [0, 2, 3]}],
    }
    scene["forces"][1]["vector"] = [0, 0, -5]
    return {"scene": scene, "variables": [VARIABLE], "goals": [GOAL], **parts}


@pytest.mark.parametrize(
    ("parts", "pointer", "sentence"),
    [
        ({"variables": [{**VARIABLE, "force": True}]}, "/variables/0/force", "true given; a text or a whole number"),
        ({"variables": [{**VARIABLE, "force": 1.5}]}, "/variables/0/force", "1.5 given; a text or a whole number"),
        ({"variables": [{"anchor": [0]}]}, "/variables/0/anchor", "a list given; a text or a whole number"),
        ({"variables": [{**VARIABLE, "tie": []}]}, "/variables/0/tie", "an empty list given"),
        ({"variables": [{**VARIABLE, "tie": [[-1]]}]}, "/variables/0/tie/0/0", "-1 given; particles are counted"),
        ({"variables": [{**VARIABLE, "tie": "some"}]}, "/variables/0/tie", '"some" given; allowed: each, all, or a'),
        ({"variables": [{**VARIABLE, "tie": 3}]}, "/variables/0/tie", "3 given; a list expected"),
        ({"variables": [{**VARIABLE, "lower": None, "upper": -1}]}, "/variables/0/upper", "rest_length is at least 0"),
        ({"variables": [{**VARIABLE, "drives": [{"force": "s", "field": "stiffness", "factor": 0}]}]},
         "/variables/0/drives/0/factor", "0 given; give a factor that is not 0"),
        ({"variables": [{**VARIABLE, "drives": [{"force": "s", "field": "stiffness", "factor": -1}]}]},
         "/variables/0/drives/0", "stiffness is at least 0, so its variable must be able to be at most 0"),
        ({"goals": [{**GOAL, "weight": 1e300}]}, "/goals/0/weight", "1e+300 given; at most 1e+50 allowed"),
        ({"settings": {"speed": 3}}, "/settings/speed", 'settings has no field "speed"'),
    ],
)  # fmt: skip
def test_what_is_wrong_is_one_sentence(parts: dict[str, Any], pointer: str, sentence: str) -> None:
    with pytest.raises(InputError) as refused:
        hookean.design(problem(**parts))
    assert refused.value.pointer == pointer
    assert refused.value.sentence.startswith(sentence) or sentence in refused.value.sentence
    assert "more fault" not in refused.value.sentence


def test_faults_of_the_scene_have_their_place_in_the_problem() -> None:
    """Faults of its fields and those that compiling finds, with particles given by number and by place."""
    near = {"kind": "position", "points": [[0, 0, -0.2]], "axes": "z", "target": -0.4}
    faults: list[tuple[dict[str, Any], str]] = [
        ({"colour": 1}, "/scene/colour"),
        ({"particles": None}, "/scene/particles"),
    ]
    odd = {"kind": "springs", "particles": [[0, 1, 2]]}
    faults.append(({"forces": [*problem()["scene"]["forces"], odd]}, "/scene/forces/2/particles"))
    for goal in (GOAL, near):
        for changed, pointer in faults:
            given = problem(goals=[goal])
            given["scene"] |= changed
            for ask in (hookean.design, hookean.sensitivity):
                with pytest.raises(InputError) as refused:
                    ask(given)
                assert refused.value.pointer == pointer


def test_two_variables_of_one_column_have_names_of_their_own() -> None:
    """Elements in two variables: in the answer, its gains and derivatives each has its name."""
    parts = [{**VARIABLE, "tie": [[0, 1]], "upper": 1.1}, {**VARIABLE, "tie": [[2]], "upper": 1.05}]
    low = {**GOAL, "target": -3.0}
    found = hookean.design(problem(variables=parts, goals=[low]))
    names = ["s.rest_length", "s.rest_length 2"]
    assert [v["name"] for v in found.variables] == names and set(found.goals[0]["gains"]) == set(names)
    assert hookean.sensitivity(problem(variables=parts)).names == names


def test_many_names_are_counted() -> None:
    """Of goals that conflict, all but the one at their mean, the first ten are named."""
    goals = [{**GOAL, "target": -0.1 * i} for i in range(13)]
    message = hookean.design(problem(goals=goals)).message
    assert message.endswith("position 10, position 11 and 2 more.")


def test_a_variable_far_beyond_its_size_is_reported() -> None:
    """An arch of least load path whose joints are free in plan: loads move to the supports as densities grow without
    end, and what is left, 0.01 N/m of the one link between them along 10 m, is 1 N m; a bound ends their way."""
    links = {"kind": "springs", "name": "arch", "particles": [[i, i + 1] for i in range(4)], "rest_length": 0.0}
    scene = {
        "particles": [[2.5 * i, 0, 0] for i in range(5)],
        "forces": [{**links, "stiffness": 5.0}, {"kind": "unary", "particles": [1, 2, 3], "vector": [0, 0, 3]}],
        "anchors": [{"particles": [0, 4]}],
    }
    goal = {"kind": "load_path", "force": "arch"}
    for upper, far in ((None, 1), (100.0, 0)):
        density = {"force": "arch", "field": "stiffness", "lower": 0.01, "upper": upper}
        found = hookean.design({"scene": scene, "variables": [density], "goals": [goal]})
        assert found.status == "converged" and (found.objective < 1.01) is (upper is None)
        assert sum(said.startswith("arch.stiffness went beyond 1000 times") for said in found.warnings) == far


def test_no_tolerance_or_weight_makes_a_search_warn() -> None:
    """What settings allow gives no warnings of libraries, and the same rest length."""
    extremes: list[dict[str, Any]] = [{"settings": {"tolerance": 1e-300}}]
    extremes += [{"goals": [{**GOAL, "weight": weight}]} for weight in (1e-50, 1e50)]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = [hookean.design(problem(**parts)) for parts in extremes]
    assert [str(f.status) for f in found] == 3 * ["converged"]
    values = [f.variables[0]["value"] for f in found]
    np.testing.assert_allclose(values, values[0], rtol=1e-9)  # sag by rest length: 1 to 3; the search ends below 1e-9


def test_loads_of_load_cases_are_told_of() -> None:
    """They do not act in the shape that is designed: a sentence where nothing needs them, an error where something
    does."""
    given = problem()
    given["scene"] |= {"load_cases": {"snow": {"forces": ["l"]}}}
    said = "l: of load cases, which do not act in this shape"
    assert [w for w in hookean.design(given).warnings if w.startswith(said)]
    assert [w for w in hookean.sensitivity(given).warnings if w.startswith(said)]
    for parts, pointer in (
        ({"variables": [{"force": "l", "field": "vector"}]}, "/variables/0/force"),
        ({"goals": [{"kind": "output", "force": "l", "column": "force"}]}, "/goals/0/force"),
    ):
        with pytest.raises(InputError, match="l is of load cases, which do not act") as refused:
            hookean.design({**given, **parts})
        assert refused.value.pointer == pointer


def test_contacts_have_no_columns_that_vary() -> None:
    given = problem(variables=[{"force": "floor", "field": "stiffness"}])
    given["scene"]["forces"].append({"kind": "floor", "point": [0, 0, -9], "normal": [0, 0, 1]})
    with pytest.raises(InputError, match="floor is a contact or an impulse; it has no columns"):
        hookean.sensitivity(given)
