"""The sweep's component: the rows of the core, partial results, cancelled by a change, one sentence where it fails."""

from __future__ import annotations

import itertools
import json
from typing import Any

import httpx
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from canvas.canvasing import Bench, line, point, sentences
from canvas.test_tools import Placed, branches
from hookean import Scene
from hookean.running.sweep import solve
from hookean_canvas.run import stand_in
from hookean_client import canvas_link, canvas_sweep
from server.conftest import endless
from serving import SWING, Home, wait_for
from soak import examples

pytestmark = pytest.mark.usefixtures("canvas")


def tree(*rows: list[Any]) -> Any:
    made = stand_in.DataTree()
    for i, row in enumerate(rows):
        made.AddRange(row, stand_in.GH_Path(i))
    return made


def cable(bench: Bench) -> dict[str, Any]:
    """The engine's inputs of a cable, from the components of forces."""
    lines = [line((2 * i, 0, 0), (2 * i + 2, 0, 0)) for i in range(5)]
    springs = Placed("Springs", bench).run(_connection=lines)["force"]
    load = Placed("Unary", bench).run(
        _point=[point(2 * i, 0, 0) for i in range(6)], _force=[stand_in.Vector3d(0, 0, -20)]
    )["force"]
    return {"_forces": tree([springs], [load]), "anchors_": [point(0, 0, 0), point(10, 0, 0)]}


def states(home: Home) -> list[str]:
    """How the jobs of the server stand, the oldest first."""
    known = {"authorization": f"Bearer {home.told['token']}"}
    answer = httpx.get(f"{home.told['url']}/v1/jobs", headers=known)
    return [job["status"] for job in answer.json()["jobs"]]


def slow(seconds: float) -> str:
    """A scene that swings for so long: too many particles to stall before."""
    return json.dumps(endless(seconds))


def test_every_value_with_every_other(home: Home) -> None:
    """The rows of the core, in branches, with units; results chosen by name."""
    bench = Bench()
    placed, given = Placed("Sweep", bench), cable(bench)
    loads = [stand_in.Vector3d(0, 0, -20), stand_in.Vector3d(0, 0, -40)]
    given |= {"_parameters": ["Springs.stiffness", "UForce.vector"], "_values": tree([500.0, 1000.0], loads)}
    found = placed.run(**given, results_=["displacement", "Springs.largest", "iterations"], _run=True)
    assert not placed.ghenv.Component.messages and placed.ghenv.Component.Message == "4 of 4"
    assert branches(found["parameters"]) == {"{0}": [500.0, 500.0, 1000.0, 1000.0], "{1}": loads * 2}
    assert found["names"] == ["displacement [m]", "Springs.largest [N]", "iterations"]
    assert found["statuses"] == ["converged"] * 4
    scene = {
        "forces": [
            {"kind": "springs", "name": "Springs", "lines": [[[2 * i, 0, 0], [2 * i + 2, 0, 0]] for i in range(5)]},
            {"kind": "unary", "name": "Unary", "points": [[2 * i, 0, 0] for i in range(6)], "vector": [0, 0, -20]},
        ],
        "anchors": [{"points": [[0, 0, 0]]}, {"points": [[10, 0, 0]]}],
    }
    rows = [
        solve(Scene.read(scene), {"forces": {"Springs": {"stiffness": k}, "Unary": {"vector": [0, 0, z]}}})
        for k in (500.0, 1000.0)
        for z in (-20, -40)
    ]
    figures = branches(found["results"])
    assert figures["{0}"] == pytest.approx([row["displacement"] for row in rows], rel=1e-9)
    assert figures["{1}"] == pytest.approx([row["forces"]["Springs"][1] for row in rows], rel=1e-9)
    text = found["table"].splitlines()
    assert text[0] == ", ".join(["number", "Springs.stiffness", "UForce.vector", "status", *found["names"]])
    assert text[1].startswith("0, 500.0, 0.0 0.0 -20.0, converged, ") and len(text) == 5


def test_loads_and_anchors_that_meet_no_particle_are_warnings_or_an_error(home: Home) -> None:
    """As on the engine: a sentence for each, by the names of components; none of the anchors met is an error."""
    bench = Bench()
    placed, given = Placed("Sweep", bench), cable(bench)
    given |= {"_parameters": ["Springs.stiffness"], "_values": [500.0, 1000.0], "_run": True}
    some = placed.run(**given | {"anchors_": [*given["anchors_"], point(3, 0, 0)]})
    [sentence] = sentences(placed.ghenv, "Warning")
    assert sentence.startswith("Anchor 2 of anchors_, branch {0}: its point met no particle; the nearest is 1 m away")
    assert some["statuses"] == ["converged"] * 2
    none = Placed("Sweep", bench)
    none.run(**given | {"anchors_": [point(3, 0, 0)]}, until=lambda found: bool(sentences(none.ghenv, "Error")))
    assert sentences(none.ghenv, "Error")[0].startswith("Anchor 0 of anchors_, branch {0}: its point met no particle")


@settings(max_examples=examples(40), deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.lists(st.lists(st.integers(), min_size=1, max_size=4), min_size=1, max_size=4))
def test_items_are_counted_with_the_last_parameter_fastest(rows: list[list[int]]) -> None:
    assert list(zip(*canvas_sweep._columns(rows, "product"), strict=True)) == list(itertools.product(*rows))


def test_side_by_side_and_settings_of_a_scene_as_text(home: Home) -> None:
    scene = json.dumps({**SWING, "settings": {}})
    given = {"scene_": scene, "_parameters": ["settings.tolerance", "0.stiffness"], "_mode_": ["zip"]}
    found = Placed("Sweep").run(**given, _values=tree([1e-3, 1e-6], ["900", 1000]), _run=["True"])
    assert branches(found["parameters"]) == {"{0}": [1e-3, 1e-6], "{1}": [900.0, 1000.0]}
    assert found["progress"] == "2 of 2 items are solved."


def test_the_same_sweep_is_one_job(home: Home) -> None:
    given = {"scene_": json.dumps(SWING), "_parameters": ["settings.max_iterations"], "_values": [20, 30], "_run": True}
    first, count = Placed("Sweep").run(**given), len(states(home))
    again = Placed("Sweep").run(**given)
    assert len(states(home)) == count
    assert again["table"] == first["table"]


@pytest.mark.soak
def test_partial_results_and_a_change_that_cancels(home: Home) -> None:
    """What is done is shown; other values cancel the job; _run False cancels it too, and the same values begin anew."""
    placed = Placed("Sweep")
    given = {"scene_": slow(60.0), "_parameters": ["settings.max_iterations"]}
    many = placed.run(
        **given, _values=[10, 10**9, 10**9 - 1], _run=True, until=lambda f: (f["statuses"] or [None])[0] is not None
    )
    assert many["statuses"] == ["max_iterations", None, None]
    assert branches(many["results"])["{0}"] == [10, None, None]
    assert placed.ghenv.Component.Message == "1 of 3"
    assert not placed.ghenv.Component.messages
    few = placed.run(**given, _values=[11], _run=True)
    assert few["statuses"] == ["max_iterations"] and branches(few["results"])["{0}"] == [11]
    wait_for(lambda: states(home)[-2:] == ["cancelled", "done"])
    placed.run(**given, _values=[10**9], _run=True, until=lambda f: f["statuses"] == [None])
    placed.run(**given, _values=[10**9], _run=False)
    assert placed.ghenv.Component.Message == "off"
    wait_for(lambda: states(home)[-1] == "cancelled")
    placed.run(**given, _values=[10**9], _run=True, until=lambda f: f["statuses"] == [None])
    assert states(home)[-2:] == ["cancelled", "running"]
    placed.run(**given, _values=[10**9], _run=False)


FAULTS: list[tuple[dict[str, Any], str]] = [
    ({"_parameters": None}, "_parameters is missing; give names of fields, such as Springs.stiffness."),
    ({"_parameters": ["stiffness"]}, 'Parameters: the text "stiffness" is not a parameter; give the name of a force or '
                                     "settings, a dot and a field."),
    ({"_values": None}, "Values: 0 branches for 1 parameters; give a branch of values for each parameter."),
    ({"_values": [1.0], "_mode_": ["all"]}, 'Mode: the text "all" is unknown; give one of 0 product, 1 zip.'),
    ({"scene_": None}, "_forces is missing; connect the outputs of force components, or a scene."),
    ({"scene_": "{"}, "Scene: it is not the JSON text of a scene."),
    ({"results_": ["force"]}, 'Results: unknown "force"; known: iterations, residual, energy, displacement, '
                              "reaction, springs.smallest, springs.largest, unary.smallest, unary.largest."),
    ({"_parameters": ["0.stiffnes"]}, "0 stiffnes: springs has no field \"stiffnes\"; did you mean "
                                      "stiffness?"),
]  # fmt: skip


@pytest.mark.parametrize(("changed", "sentence"), FAULTS)
def test_what_does_not_fit_is_one_sentence(home: Home, changed: dict[str, Any], sentence: str) -> None:
    scene = json.dumps({**SWING, "settings": {"max_iterations": 10}})
    placed = Placed("Sweep")
    placed.run(**{"scene_": scene, "_parameters": ["0.stiffness"], "_values": [1000.0], "_run": True, **changed})
    assert sentences(placed.ghenv) == [sentence]


@pytest.mark.soak
def test_a_server_that_is_killed_is_told_of_and_the_sweep_goes_on(tmp_path: Any, monkeypatch: Any) -> None:
    """One sentence while it is away; once it is back, the job that was kept goes on."""
    home = Home(tmp_path / "state")
    monkeypatch.setenv("HOOKEAN_STATE", str(home.folder))
    monkeypatch.delenv("HOOKEAN_PYTHON", raising=False)
    canvas_link.service.forget()
    try:
        home.serve()
        placed = Placed("Sweep")
        given = {"_parameters": ["settings.max_iterations"], "_values": [10, 10**9], "_run": True}
        for seconds in (2.0, 20.0, 200.0):  # on a busy machine a short one may be over before it is looked at
            given["scene_"] = slow(seconds)
            found = placed.run(**given, until=lambda f: f["statuses"] is not None)
            if None in found["statuses"]:
                break
        home.kill()
        (home.folder / "python.json").unlink(missing_ok=True)
        placed.run(**given, until=lambda f: placed.ghenv.Component.messages)
        assert len(sentences(placed.ghenv)) == 1 and "server" in sentences(placed.ghenv)[0]
        home.serve()
        found = placed.run(**given)
        assert found["statuses"][0] == "max_iterations" and None not in found["statuses"]
    finally:
        canvas_link.service.forget()
        home.end()
