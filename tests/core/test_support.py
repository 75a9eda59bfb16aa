"""Elastic supports: how far they give way, a beam on an elastic foundation, and what they refuse."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest

import hookean
from hookean import InputError, Scene, relax
from hookean.files.report import report
from hookean.pictures.visible import _of_result

from .beam_scenes import load, rotation, row, scene, straight


@pytest.mark.soak
def test_a_support_resists_as_stiff_as_it_is() -> None:
    """A rigid bar on springs: d = F / k at its middle and phi = M / kr; beyond half a turn it pulls the shorter way."""
    rigid = {"E": 1e9, "G": 1e9, "A": 1.0, "Iy": 1.0, "Iz": 1.0, "J": 1.0}
    support = {"kind": "support", "particles": [0], "stiffness": [10, 20, 40], "rotation_stiffness": [5, 5, 5]}
    found = relax(scene(straight(1), [row(1, rigid), support, load(0, (1, 1, 1), (4.0, 0, 0))], [], tolerance=1e-10))
    assert found.particles[0] == pytest.approx([0.1, 0.05, 0.025], abs=1e-7)
    assert rotation(found, 0).as_rotvec() == pytest.approx([0.8, 0.0, 0.0], abs=1e-7)
    assert found.force("support")["moment"][0] == pytest.approx([-4.0, 0.0, 0.0], abs=1e-7)
    with pytest.raises(InputError, match="rotation_stiffness of -1"):
        relax(scene(straight(1), [row(1), {**support, "rotation_stiffness": [-1, 0, 0]}]))
    with pytest.raises(InputError, match="no rotation"):
        relax(scene(straight(1), [{"kind": "springs", "particles": [[0, 1]]}, support]))


def test_a_long_beam_on_an_elastic_foundation() -> None:
    """Hetenyi, Beams on elastic foundation, 1946: under a load P on an infinite beam w = P b / 2k and M = P / 4b,
    b = (k / 4 EI)^1/4 [1/length], k the foundation's stiffness per length. Ends are 6 / b away, where e^-6 is left; a
    foundation in points h apart, and M between them, differ by (b h)^2 / 12 of each and less: 1e-3 at b h = 0.1."""
    count, h, p = 120, 0.1, 1e-3
    springs = {"kind": "support", "particles": list(range(count + 1)), "stiffness": [1.0, 1.0, 4.0 * h]}
    x = straight(count, count * h)  # EI = 1 and k = 4: b = 1
    found = relax(scene(x, [row(count), springs, load(count // 2, (0, 0, -p))], [], tolerance=1e-11))
    assert found.converged
    assert found.particles[count // 2, 2] == pytest.approx(-p / 8.0, rel=3e-3)
    assert np.abs(found.force("beam")["My1"][count // 2 - 1]) == pytest.approx(p / 4.0, rel=3e-3)


def test_targets_are_where_there_is_no_force() -> None:
    """A free beam is drawn to targets a step aside, and has no stress there."""
    step = np.array([0.1, -0.2, 0.3])
    support = {"kind": "support", "particles": [0, 1], "stiffness": [3, 3, 3], "targets": (straight(1) + step).tolist()}
    found = relax(scene(straight(1), [row(1), support], [], tolerance=1e-10))
    assert found.particles == pytest.approx(straight(1) + step, abs=1e-7)
    assert found.force("support")["force"] == pytest.approx(0.0, abs=1e-6)


BEARING = {
    "kind": "support", "name": "bearing", "particles": [0, 3],
    "stiffness": [[1e4, 2e4, 3e4], [1e3, 0, 5e3]], "rotation_stiffness": [[10, 20, 30], [0, 0, 0]],
}  # fmt: skip


def on_bearings() -> Scene:
    """A bent beam in three pieces on an elastic support, and at its other end on one and an anchor."""
    x = np.array([[0, 0, 0], [1, 0, 0.2], [2, 0.1, 0], [3, 0, 0]])
    stiff = {"E": 1e7, "G": 5e6, "A": 1e-2, "Iy": 1e-5, "Iz": 2e-5, "J": 2e-5}
    push = {"kind": "unary", "name": "push", "particles": [1, 2], "vector": [[1, 2, -30], [0, 4, -5]],
            "moment": [[1, 0, 0], [0, 2, 1]]}  # fmt: skip
    feet = {"name": "feet", "particles": [3], "axes": "y", "rotations": "xz"}
    made = scene(x, [row(3, stiff), BEARING, push], [feet], tolerance=1e-10)
    return made.model_copy(update={"load_cases": {"push": {"forces": ["push"]}}})


def test_what_elastic_supports_carry_is_among_the_reactions() -> None:
    """Reactions and loads balance, forces and moments about the origin, to what is out of balance; where an anchor
    holds other axes of the same particle both are one reaction, of the anchor's name."""
    found = hookean.load_cases(on_bearings())
    result = found.cases["push"].result
    assert result.converged and result.reactions["particles"].tolist() == [0, 3]
    assert result.reactions["names"] == ["bearing", "feet"] and result.reactions["exact"] == [False, True]
    at, force = result.particles[[0, 3]], result.reactions["force"]
    loads, size = result.loads, np.abs(force).sum()
    assert np.abs(force.sum(axis=0) + loads["resultant"].sum(axis=0)).max() < 1e-9 * size
    turning = result.reactions["moment"] + np.cross(at, force)
    turned = loads["moment"] + np.cross(loads["centre"], loads["resultant"])
    assert np.abs(turning.sum(axis=0) + turned.sum(axis=0)).max() < 1e-9 * 3.0 * size
    np.testing.assert_array_equal(force[0], result.force("bearing")["force"][0])
    assert result.force("bearing")["force"][1, 1] == 0.0 and abs(force[1, 1]) > 1.0  # y is the anchor's
    np.testing.assert_allclose(found.envelope.reaction.largest, np.linalg.norm(force, axis=1), rtol=1e-15)
    assert "2 reactions" in result.summary()[-1]


def test_tables_and_reports_have_them(tmp_path: Path) -> None:
    """The CSV has both, and the report adds both up to the loads."""
    made = on_bearings()
    result = hookean.load_cases(made).cases["push"].result
    result.save(tmp_path / "result.csv")
    with (tmp_path / "result.csv").open(newline="", encoding="utf-8") as file:
        rows = [line for line in csv.DictReader(file) if line["kind"] == "reaction"]
    assert [line["force"] for line in rows] == ["bearing", "feet"]
    assert sum(float(line["force z [N]"]) for line in rows) == pytest.approx(35.0, abs=1e-8)
    assert "Reactions together: -1, -6, 35 N." in report(made, pictures=False)


def test_bearings_are_drawn_as_reactions_and_not_as_anchors() -> None:
    result = hookean.load_cases(on_bearings()).cases["push"].result
    things = _of_result(result, result.scene)
    np.testing.assert_array_equal(things.held, result.particles[[3]])
    np.testing.assert_allclose(things.reactions[:, 1], result.reactions["force"])
