"""The component of streams: the frames that `simulate` makes of the same table, and one sentence where it cannot."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from canvas.canvasing import Bench, line, point, sentences, xyz
from canvas.test_tools import Placed, branches
from hookean import Scene, simulate
from hookean_canvas.run import stand_in
from serving import Home

TABLE = "time [s],gust [m/s],speed [m/s]\n2.0,0,3.0\n2.2,1,4.5\n2.6,2,4.0\n3.0,3,1.0\n"
DRIVE = {"force": "wind", "column": "vector", "source": "speed [m/s]", "scale": [0.1, 0, 0.613], "power": 2}


pytestmark = pytest.mark.usefixtures("canvas")


def cable(bench: Bench) -> dict[str, Any]:
    """Inputs of a cable of three springs with a load called wind."""
    lines = [line((i, 0, 0), (i + 1, 0, 0)) for i in range(3)]
    springs = Placed("Springs", bench).run(_connection=lines)["force"]
    places = [point(i, 0, 0) for i in range(4)]
    still = [stand_in.Vector3d(0, 0, 0)]
    load = Placed("Unary", bench).run(_point=places, _force=still, name_=["wind"])["force"]
    setting = Placed("Settings", bench).run(_time_step_=[0.005])["settings"]
    given = {"_forces": [springs, load], "anchors_": [places[0], places[-1]], "settings_": setting}
    return {**given, "geometry_": lines, "_column": ["speed [m/s]"], "_force": ["wind"], "_power_": [2.0],
            "_scale": [stand_in.Vector3d(0.1, 0, 0.613)], "_every_": [0.1]}  # fmt: skip


def test_frames_are_those_of_the_simulation(home: Home, tmp_path: Path) -> None:
    """Rows that start at 2 s are played from the start; every digit agrees."""
    (tmp_path / "wind.csv").write_text(TABLE)
    bench = Bench(str(tmp_path / "sail.gh"))
    placed = Placed("Stream", bench)
    found = placed.run(**cable(bench), _file=["wind.csv"])
    assert not placed.ghenv.Component.messages
    assert found["times"] == pytest.approx([0.1 * i for i in range(11)])
    assert found["values"] == [3.0, 3.0, 4.5, 4.5, 4.5, 4.5, 4.0, 4.0, 4.0, 4.0, 1.0]
    scene = Scene.read(
        {
            "forces": [
                {"kind": "springs", "name": "net", "lines": [[[i, 0, 0], [i + 1, 0, 0]] for i in range(3)]},
                {"kind": "unary", "name": "wind", "points": [[i, 0, 0] for i in range(4)], "vector": [0, 0, 0]},
            ],
            "anchors": [{"points": [[0, 0, 0], [3, 0, 0]]}],
            "settings": {"time_step": 0.005, "sub_iterations": 20, "tolerance": 0},
        }
    )
    wanted = list(simulate(scene, script={"drives": [DRIVE]}, stream=TABLE.splitlines()))
    shapes = branches(found["geometry"])
    for i, frame in enumerate(wanted[:11]):
        drawn = [xyz(shapes[f"{{{i}}}"][0].From), *(xyz(one.To) for one in shapes[f"{{{i}}}"])]
        assert np.allclose(drawn, frame.particles, rtol=0, atol=1e-12), i
    largest = branches(found["largest"])
    assert largest["{1}"] == pytest.approx([np.hypot(0.1, 0.613) * value**2 for value in found["values"]])
    assert len(largest["{0}"]) == 11 and max(largest["{0}"]) > 0


def test_an_anchor_that_meets_no_particle_is_a_warning(home: Home, tmp_path: Path) -> None:
    """The motion goes on with the anchors that did meet."""
    (tmp_path / "wind.csv").write_text(TABLE)
    bench = Bench(str(tmp_path / "sail.gh"))
    placed, given = Placed("Stream", bench), cable(bench)
    given["anchors_"] = [*given["anchors_"], point(1, 0, 5)]
    found = placed.run(**given, _file=["wind.csv"])
    [sentence] = sentences(placed.ghenv, "Warning")
    assert sentence.startswith("Anchor 2 of anchors_, branch {0}: its point met no particle; the nearest is 5 m away")
    assert found["times"] is not None


@pytest.mark.parametrize(
    ("change", "level", "said"),
    [
        ({"_file": None}, "Warning", "_file is missing"),
        ({"_file": ["none.csv"]}, "Error", "does not exist"),
        ({"_column": ["speed"]}, "Error", 'a column time and "speed" are needed'),
        ({"_force": ["rain"]}, "Error", 'no force has the name "rain"; there are Springs, wind'),
        ({"_force": ["Springs"]}, "Error", '"Springs" is not a load'),
        ({"_every_": [1e-9]}, "Error", "frames are more than"),
        ({"table": "time [s],speed [m/s]\n0,1\n1,fast\n"}, "Error", "line 3 is not a row of numbers"),
        ({"table": "time [s],speed [m/s]\n0,1\n0,2\n"}, "Error", "line 3 goes back in time"),
        ({"table": "time [s],speed [m/s]\n"}, "Error", "it has 0 rows"),
    ],
)
def test_what_does_not_fit_is_one_sentence(
    home: Home, tmp_path: Path, change: dict[str, Any], level: str, said: str
) -> None:
    (tmp_path / "wind.csv").write_text(change.get("table", TABLE))
    bench = Bench(str(tmp_path / "sail.gh"))
    placed = Placed("Stream", bench)
    given = {**cable(bench), "_file": ["wind.csv"]} | {k: v for k, v in change.items() if k.startswith("_")}
    if "_every_" in change:
        given["settings_"] = Placed("Settings", bench).run(_time_step_=[1e-6])["settings"]
    found = placed.run(**given)
    assert [known for known, _ in placed.ghenv.Component.messages] == [level]
    assert said in sentences(placed.ghenv)[0] and found["times"] is None
