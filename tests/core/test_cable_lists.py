"""Which elements are one cable in the list for the workshop."""

from __future__ import annotations

from typing import Any

import pytest

import hookean
from hookean import Scene

MASTS: dict[str, dict[str, Any]] = {
    "beam": {"kind": "beam", "E": 2e8, "G": 8e7, "A": 4e-3, "Iy": 1e-5, "Iz": 1e-5, "J": 2e-5},
    "springs": {"kind": "springs", "axial_stiffness": 8e5},
    "support": {"kind": "support", "stiffness": [0, 0, 1e5]},
}


@pytest.mark.parametrize("mast", MASTS)
def test_stays_that_meet_on_a_mast_are_a_cable_each(mast: str) -> None:
    """Two stays of one force turn by 100 degrees on the top of a mast, which moves: of beams, a strut, or a spring. The
    tension is from stretching: with 9 kN it is shorter by l T / (EA + T) than the 7.81 m in the form."""
    places = {"particles": [1]} if mast == "support" else {"particles": [[0, 1]]}
    stays = {"kind": "springs", "name": "stays", "particles": [[2, 1], [1, 3]], "axial_stiffness": 2e4, "force": 9}
    scene = Scene.read(
        {
            "particles": [[0, 0, 0], [0, 0, 6], [5, 0, 0], [-5, 0, 0]],
            "forces": [{**MASTS[mast], "name": "mast", **places}, stays],
            "anchors": [{"particles": [0, 2, 3]}, {"particles": [1], "axes": "xy"}],
        }
    )
    rows = [row for row in hookean.cables(scene).table() if row["force"] == "stays"]
    assert [(row["from particle"], row["to particle"]) for row in rows] == [(2, 1), (1, 3)]
    for row in rows:
        length, tension = row["stressed length [m]"], row["largest force [N]"]
        assert length == pytest.approx(61.0**0.5, rel=1e-3)
        assert row["unstressed length [m]"] == pytest.approx(length * 2e4 / (2e4 + tension), rel=1e-9)


def test_a_cable_that_a_heavy_load_bends_goes_on() -> None:
    """One cable that turns by 90 degrees where nothing but a load is."""
    cable = {"kind": "constant_tension", "name": "cable", "particles": [[0, 1], [1, 2]], "tension": 5.0}
    scene = Scene.read(
        {
            "particles": [[0, 0, 0], [2, 0, -1.8], [4, 0, 0]],
            "forces": [cable, {"kind": "unary", "particles": [1], "vector": [0, 0, -(50.0**0.5)]}],
            "anchors": [{"particles": [0, 2]}],
            "stages": {"freeze": {"cable": {"axial_stiffness": 1e4}}},
        }
    )
    assert [row["elements"] for row in hookean.cables(scene).table()] == [2]
