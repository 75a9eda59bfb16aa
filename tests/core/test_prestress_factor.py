"""The factor on `prestress` in combinations: cloth and sliding cables as drawn, and what hangs slack in the form."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import hookean
from hookean import Scene

from .balances import balanced

Spec = dict[str, Any]
FACTORS = {"ULS": {"prestress": 1.5}, "none": {"prestress": 0.0}}


def drawn_cloth(**more: Any) -> Spec:
    """A square of cloth of 2 x 2 faces, held at its rim; snow on the middle."""
    x = [[i, j, 0] for j in range(3) for i in range(3)]
    faces = [[0, 1, 4, 3], [1, 2, 5, 4], [3, 4, 7, 6], [4, 5, 8, 7]]
    cloth = {"kind": "membrane", "name": "cloth", "mesh": "m", "warp_stiffness": 500.0, "prestress": [2, 1.5, 0.2]}
    return {
        "particles": x,
        "meshes": {"m": {"vertices": x, "faces": faces}},
        "forces": [
            {**cloth, "warp": [1, 0, 0], **more},
            {"kind": "unary", "name": "snow", "particles": [4], "vector": [0, 0, -0.1]},
        ],
        "anchors": [{"particles": [0, 1, 2, 3, 5, 6, 7, 8]}],
        "load_cases": {"snow": {"forces": ["snow"]}},
        "combinations": FACTORS,
    }  # fmt: skip


def test_drawn_cloth_has_its_prestress_times_the_factor() -> None:
    """Flat cloth does not move, so that its stress is the factor times what was given."""
    cases = hookean.load_cases(Scene.read(drawn_cloth()), ["ULS", "none"]).cases
    for name, factor in (("ULS", 1.5), ("none", 0.0)):
        found = cases[name].result.force("cloth")
        for column, given in (("warp", 2.0), ("weft", 1.5), ("shear", 0.2)):
            assert found[column] == pytest.approx(np.full(16, factor * given), abs=1e-12)


def test_strained_cloth_has_its_stress_in_the_form_times_the_factor() -> None:
    """Cloth that is pulled to 1.01 of its size in the form: second Piola stress S of the form, by the law of the cloth
    and by its prestress, times the factor; no part of it moves, as all of it is alike."""
    spec = drawn_cloth(poisson=0.3, prestress=[0, 0, 0])
    held = [0, 1, 2, 3, 5, 6, 7, 8]
    spec["anchors"] = [{"particles": held, "targets": np.array(spec["particles"])[held] * [1.01, 1.0, 1.0]}]
    case = hookean.load_cases(Scene.read(spec), ["ULS"]).cases["ULS"]
    strain = 0.5 * (1.01**2 - 1.0)
    warp, weft = 500.0 * strain / (1.0 - 0.09), 150.0 * strain / (1.0 - 0.09)
    found = case.result.force("cloth")  # stresses as they are: by the present widths
    assert found["warp"] == pytest.approx(np.full(16, 1.5 * warp * 1.01), rel=1e-9)
    assert found["weft"] == pytest.approx(np.full(16, 1.5 * weft / 1.01), rel=1e-9)
    assert np.abs(case.displacements).max() < 1e-12


def test_a_sliding_cable_has_its_tension_times_the_factor() -> None:
    """A straight one between supports does not move, so its force is the factor times that of the form. Two cables of
    one force are named in a note, which the summary shows, and keep their tension."""
    cable = {
        "kind": "sliding_cable",
        "name": "tie",
        "particles": [[0, 1], [1, 2]],
        "axial_stiffness": 100.0,
        "force": 3.0,
    }
    spec = {
        "particles": [[0, 0, 0], [1, 0, 0], [2, 0, 0]],
        "forces": [cable, {"kind": "unary", "name": "wind", "particles": [1], "vector": [0, 1, 0]}],
        "anchors": [{"particles": [0, 2]}],
        "load_cases": {"wind": {"forces": ["wind"]}},
        "combinations": FACTORS,
    }  # fmt: skip
    with balanced() as checked:
        found = hookean.load_cases(Scene.read(spec), ["ULS"])
    assert checked.checked == 1 and found.frozen.notes == ()
    assert found.cases["ULS"].result.force("tie")["force"] == pytest.approx([4.5, 4.5], rel=1e-12)
    spec["forces"] = [{**cable, "group": [0, 1]}, *spec["forces"][1:]]  # type: ignore[misc]
    both = hookean.load_cases(Scene.read(spec), ["ULS"])
    assert both.cases["ULS"].result.force("tie")["force"] == pytest.approx([3.0, 3.0], rel=1e-12)
    assert "tie has several cables, which keep their tension" in both.summary()[-1]


@pytest.mark.parametrize("factor", [1.0, 1.000001, 1.35])
@pytest.mark.parametrize("frozen", [{}, {"stages": {"freeze": {"slack": {"axial_stiffness": 100.0}}}}])
def test_what_hangs_slack_keeps_its_length(factor: float, frozen: Spec) -> None:
    """A bar of EA / l = 100 alone holds 3 until the other cable has lost its slack of 0.05: u = 3 / 100, and it is the
    one element that is slack. Further, 13 are carried by both: 100 u + 100 / 1.05 (u - 0.05) = 13 (Hooke)."""
    for load, moved, force in ((3.0, 0.03, 0.0), (13.0, (13.0 + 5.0 / 1.05) / (100.0 + 100.0 / 1.05), None)):
        slack = {"kind": "springs", "name": "slack", "particles": [[1, 2]], "axial_stiffness": 100.0}
        spec = {
            "particles": [[0, 0, 0], [1, 0, 0], [2, 0, 0]],
            "forces": [
                {"kind": "springs", "name": "tie", "particles": [[0, 1]], "axial_stiffness": 100.0},
                {**slack, "rest_length": 1.05, "tension_only": True},
                {"kind": "unary", "name": "P", "particles": [1], "vector": [-load, 0, 0]},
            ],
            "anchors": [{"particles": [0, 2]}, {"particles": [1], "axes": "yz"}],
            "load_cases": {"P": {"forces": ["P"]}},
            "combinations": {"U": {"prestress": factor, "P": 1.0}},
            "settings": {"tolerance": 1e-11},
            **frozen,
        }
        case = hookean.load_cases(Scene.read(spec), ["U"]).cases["U"]
        assert -case.displacements[1, 0] == pytest.approx(moved, rel=1e-9)
        if force is not None:
            assert case.result.force("slack")["force"] == pytest.approx([force], abs=1e-9)
        assert case.slack_count == (1 if force == 0.0 else 0)
