"""The component of moments: the positions of the engine's motion at whole steps, and one sentence where it cannot."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest

from canvas.canvasing import Bench, line, point, sentences, xyz
from canvas.test_tools import Placed, branches
from hookean import Scene, simulate
from hookean_canvas.run import stand_in
from serving import Home

pytestmark = pytest.mark.usefixtures("canvas")


def cable(bench: Bench, **settings: Any) -> dict[str, Any]:
    """Inputs of a cable of five springs between two anchors, the second one raised by 1 m."""
    lines = [line((2 * i, 0, 0), (2 * i + 2, 0, 0)) for i in range(5)]
    springs = Placed("Springs", bench).run(_connection=lines)["force"]
    places = [point(2 * i, 0, 0) for i in range(6)]
    load = Placed("Unary", bench).run(_point=places, _force=[stand_in.Vector3d(0, 0, -20)])["force"]
    ends, targets = [places[0], places[-1]], [places[0], point(10, 0, 1)]
    held = Placed("Anchors", bench).run(_point=ends, targets_=targets)["anchors"]
    setting = Placed("Settings", bench).run(_time_step_=[0.005], **settings)["settings"]
    return {"_forces": [springs, load], "anchors_": held, "settings_": setting, "geometry_": [lines[0], places[2]]}


def test_shapes_are_the_frames_of_the_simulation(home: Home) -> None:
    bench = Bench()
    placed = Placed("Moments", bench)
    found = placed.run(**cable(bench), _times=[0.5, 0.0, "1.251"])
    assert not placed.ghenv.Component.messages
    assert found["times"] == pytest.approx([0.5, 0.0, 1.25])
    scene = Scene.read(
        {
            "forces": [
                {"kind": "springs", "lines": [[[2 * i, 0, 0], [2 * i + 2, 0, 0]] for i in range(5)]},
                {"kind": "unary", "points": [[2 * i, 0, 0] for i in range(6)], "vector": [0, 0, -20]},
            ],
            "anchors": [{"points": [[0, 0, 0], [10, 0, 0]], "targets": [[0, 0, 0], [10, 0, 1]]}],
            "settings": {"time_step": 0.005, "sub_iterations": 50, "tolerance": 0},
        }
    )
    wanted = [frame.particles for frame in simulate(scene, frames=5)]
    rows = branches(found["particles"])
    for path, number in (("{0}", 2), ("{1}", 0), ("{2}", 5)):
        assert np.allclose([xyz(place) for place in rows[path]], wanted[number], rtol=0, atol=1e-12)
    drawn = branches(found["geometry"])
    assert xyz(drawn["{0}"][0].To) == pytest.approx(wanted[2][1].tolist())
    assert xyz(drawn["{2}"][1]) == pytest.approx(wanted[5][2].tolist())


@pytest.mark.parametrize(
    ("change", "level", "said"),
    [
        ({"_times": None}, "Warning", "_times is missing; connect one moment or more"),
        ({"_forces": None}, "Warning", "_forces is missing"),
        ({"_times": [-1.0]}, "Error", "-1 is before the start"),
        ({"_times": ["soon"]}, "Error", '_times: the text "soon" is not a number'),
        ({"solver": "newton"}, "Error", "newton has no physical time; moments need verlet or yoshida"),
        ({"anchor": (9, 9, 9)}, "Warning", "its point met no particle; the nearest is"),
    ],
)
def test_what_does_not_fit_is_one_sentence(home: Home, change: dict[str, Any], level: str, said: str) -> None:
    bench, settings = Bench(), {"_solver_": [change["solver"]]} if "solver" in change else {}
    given = {**cable(bench, **settings), "_times": [0.1]} | {k: v for k, v in change.items() if k.startswith("_")}
    if "anchor" in change:
        given["anchors_"] = [given["anchors_"], point(*change["anchor"])]
    placed = Placed("Moments", bench)
    found = placed.run(**given)
    [sentence] = sentences(placed.ghenv, level)
    assert said in sentence
    assert (found["particles"] is None) == ("anchor" not in change)
    assert json.dumps(sentence).count("\\n") == 0
