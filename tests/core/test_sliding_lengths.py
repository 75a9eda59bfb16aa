"""Unstressed lengths of sliding cables: their own, in parts by the tension of each line."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import hookean
from hookean import Scene

POINTS = [[0, 0, 0], [2, 0, -1], [5, 0.5, -0.8], [7, 0, 0]]
DRAWN = float(np.linalg.norm(np.diff(np.array(POINTS), axis=0), axis=1).sum())


def roof(**given: Any) -> Scene:
    """A cable over two weights that a tie keeps apart."""
    main: dict[str, Any] = {"kind": "sliding_cable", "name": "main", "particles": [[0, 1], [1, 2], [2, 3]]}
    main |= {"axial_stiffness": 2000.0, **given}
    tie = {"kind": "springs", "name": "tie", "particles": [[1, 2]], "axial_stiffness": 900.0, "force": 1.0}
    load = {"kind": "unary", "particles": [1, 2], "vector": [[0, 0, -9.0], [0, 0, -7.0]]}
    return Scene.read({"particles": POINTS, "forces": [main, tie, load], "anchors": [{"particles": [0, 3]}]})


@pytest.mark.parametrize("given", [{}, {"friction": 0.05}])
def test_a_sliding_cable_is_as_long_as_its_rest_length_with_and_without_friction(given: dict[str, Any]) -> None:
    found = hookean.cables(roof(force=20.0, **given), stretch=0.01, fitting=0.1)
    main, tie = found.cables
    assert [main.force, tie.force] == ["main", "tie"]
    np.testing.assert_array_equal(main.particles, [0, 1, 2, 3])
    rest = DRAWN * 2000.0 / 2020.0
    assert main.clamps[-1] == pytest.approx(rest, rel=1e-12)
    assert main.cut == pytest.approx(rest / 1.01 - 0.2, rel=1e-12)
    # each line is elastic: l = u (1 + T / EA), to the tolerance of the form
    np.testing.assert_allclose(main.stressed, main.unstressed * (1.0 + main.tension / 2000.0), rtol=1e-6)
    assert (np.ptp(main.tension) > 1e-3) == bool(given)


def test_a_slack_sliding_cable_is_elastic_and_has_its_rest_length() -> None:
    scene = {
        "particles": [[0, 0, 0], [1, 0, -1], [2, 0, 0]],
        "forces": [
            {"kind": "sliding_cable", "particles": [[0, 1], [1, 2]], "rest_length": 4.0},
            {"kind": "springs", "particles": [[0, 1], [1, 2]], "axial_stiffness": 100.0},
            {"kind": "unary", "particles": [1], "vector": [0, 0, -1.0]},
        ],
        "anchors": [{"particles": [0, 2]}, {"particles": [1], "axes": "xy"}],
    }
    frozen = hookean.freeze(Scene.read(scene))
    assert not [note for note in frozen.notes if "not elastic" in note]
    (slack, *_) = hookean.cables(frozen).cables
    assert slack.clamps[-1] == pytest.approx(4.0, rel=1e-12)
    assert not slack.tension.any()
