"""Linear buckling names cables and struts that go slack or taut before its first factor, and frequencies those that are
just where they do."""

from __future__ import annotations

from typing import Any

import pytest

import hookean
from hookean import Scene


def braced(push: float = 0.0, **ties: Any) -> Scene:
    """A square frame of bars in a plane, which two diagonals brace, under a load of 1 on both of its upper corners."""
    return Scene.read(
        {
            "particles": [[0, 0, 0], [0, 0, 3], [4, 0, 3], [4, 0, 0]],
            "forces": [
                {"kind": "springs", "name": "bars", "particles": [[0, 1], [3, 2], [1, 2]], "axial_stiffness": 1e5},
                {"kind": "springs", "name": "ties", "particles": [[0, 2], [3, 1]], "axial_stiffness": 1e4, **ties},
                {"kind": "unary", "name": "roof", "particles": [1, 2], "vector": [0, 0, -1]},
                {"kind": "unary", "name": "wind", "particles": [1], "vector": [push, 0, 0]},
            ],
            "anchors": [{"particles": [0, 3]}, {"particles": [1, 2], "axes": "y"}],
        }
    )


def test_ties_without_prestress_that_the_load_makes_slack_are_named() -> None:
    """Both ties count without the load, twice what one of them gives, E A / L cos^2 h / 2 (sway of two columns); the
    load shortens the columns, so that both are slack at once."""
    found = hookean.buckling(braced(tension_only=True), 1, loads=["roof"])
    assert found.factors[0] == pytest.approx(2.0 * (1e4 / 5.0 * 0.8**2) * 3.0 / 2.0, rel=0.01)
    (said,) = found.notes
    assert said.startswith("2 of 2 elements of ties go slack or taut before the first factor, element 0 at 0 times")
    assert said in found.summary() and said in found.to_dict()["notes"]


def test_prestress_lasts_until_the_load_has_taken_it() -> None:
    """At -N0 / N1 times the load, N0 the prestress and N1 what the load brings to ties that can be pushed."""
    before = hookean.relax(braced(force=1.0).model_copy(update={"forces": braced(force=1.0).forces[:2]}))
    rate = hookean.relax(braced()).force("ties")["force"][0]
    (said,) = hookean.buckling(braced(force=1.0, tension_only=True), 1, loads=["roof"]).notes
    factor = float(said.split(" times")[0].split()[-1])
    assert factor == pytest.approx(-before.force("ties")["force"][0] / rate, rel=0.01)


@pytest.mark.parametrize("ties", [{}, {"force": 1.0}, {"compression_only": True}])
def test_what_works_both_ways_or_goes_on_to_work_is_not_named(ties: dict[str, Any]) -> None:
    """The load pushes both diagonals."""
    assert hookean.buckling(braced(**ties), 1, loads=["roof"]).notes == ()


def test_of_two_ties_the_one_that_the_wind_stretches_braces_alone() -> None:
    """The other one is slack without the roof and stays so: half the factor of both, and no note."""
    found = hookean.buckling(braced(push=1.0, tension_only=True), 1, loads=["roof"])
    assert found.factors[0] == pytest.approx(1e4 / 5.0 * 0.8**2 * 3.0 / 2.0, rel=0.05)


@pytest.mark.parametrize(("way", "count"), [({"tension_only": True}, 2), ({"compression_only": True}, 2), ({}, 0)])
def test_frequencies_name_ties_without_prestress(way: dict[str, Any], count: int) -> None:
    """At rest both ties are as long as drawn. They count in full, k = 2 E A / L cos^2 for the sway of two masses of 1,
    while only one of them works at a time."""
    scene = braced(**way)
    shape = hookean.relax(scene.model_copy(update={"forces": scene.forces[:2]}))
    found = hookean.frequencies(shape, 1, masses=1.0)
    assert found.angular_frequencies[0] ** 2 == pytest.approx(1e4 / 5.0 * 0.8**2, rel=0.03)
    assert len(found.notes) == (count > 0)
    if count:
        assert found.notes[0].startswith("2 of 2 elements of ties are just where they go slack, the first is element 0")
    taut = braced(force=1.0, tension_only=True)
    shape = hookean.relax(taut.model_copy(update={"forces": taut.forces[:2]}))
    assert hookean.frequencies(shape, 1, masses=1.0).notes == ()
