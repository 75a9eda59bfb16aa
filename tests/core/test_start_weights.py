"""Weights of materials, which count the start shape: freezing reports a form that is longer or larger."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean import Scene
from hookean.analysis.freezing import freeze

LINES = [[0, 1], [1, 2]]
AREA, DENSITY, GRAVITY = 1e-3, 7850.0, 9.80665
ROPE: dict[str, Any] = {
    "materials": {"steel": {"E": 160e9, "poisson": 0.3, "density": DENSITY}},
    "sections": {"rope": {"area": AREA}},
    "stages": {"freeze": {"rope": {"material": "steel", "section": "rope"}}},
    "settings": {"tolerance": 1e-12},
}


def notes(drawn: float, weight: dict[str, Any]) -> tuple[tuple[str, ...], float, float]:
    """Notes on a rope of two force densities that is drawn `drawn` below its supports; its weight as a load, and by
    the length that it has in the form."""
    scene = Scene.read(
        {
            **ROPE,
            "particles": [[0, 0, 0], [4, 0, -drawn], [8, 0, 0]],
            "forces": [
                {"kind": "springs", "name": "rope", "particles": LINES, "stiffness": 1e4, "rest_factor": 0},
                {"name": "dead", **weight},
            ],
            "anchors": [{"particles": [0, 2]}],
        }
    )
    frozen = freeze(scene)
    form = frozen.form
    assert form is not None
    length = float(form.force("rope")["length"].sum())
    return frozen.notes, -float(form.loads["resultant"][0, 2]), length * AREA * DENSITY * GRAVITY


OF_STEEL = {"kind": "self_weight", "particles": LINES, "material": "steel", "section": "rope"}


def test_a_rope_that_is_drawn_deep_weighs_what_is_drawn_and_a_note_has_the_weight_of_the_form() -> None:
    """Two lines of 5 m are drawn, 770 N, which bend to little more than 8 m."""
    said, weight, true = notes(3.0, OF_STEEL)
    assert weight == pytest.approx(10.0 * AREA * DENSITY * GRAVITY, rel=1e-12)
    assert said == (
        f"/forces/1: dead is the weight of the start shape, {weight:.4g} N; the form weighs {true:.4g} N, "
        "which line_weight gives",
    )


def test_what_is_drawn_near_its_form_has_no_note() -> None:
    """And `line_weight` weighs the form wherever it is drawn; the total of a self-weight is what is given."""
    said, weight, true = notes(0.5, OF_STEEL)
    assert said == () and weight == pytest.approx(true, rel=0.03)
    said, weight, true = notes(
        3.0, {"kind": "line_weight", "particles": [[0, 1], [1, 2]], "weight": AREA * DENSITY * GRAVITY}
    )
    assert said == () and weight == pytest.approx(true, rel=1e-9)
    assert notes(3.0, {"kind": "self_weight", "total": 50.0})[0] == ()


def test_the_faces_of_a_mesh_are_weighed_too() -> None:
    """A net that is drawn as a gable roof of 45 degrees, sqrt(2) times its plan, becomes flat."""
    side = np.linspace(-1.0, 1.0, 5)
    points = np.array([[x, y, 1.0 - abs(x)] for x in side for y in side])
    number = np.arange(25).reshape(5, 5)
    faces = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=-1).reshape(-1, 4)
    scene = Scene.read(
        {
            "units": {"force": "kN"},
            "meshes": {"roof": {"vertices": points, "faces": faces}},
            "forces": [
                {"kind": "springs", "name": "net", "mesh": "roof", "stiffness": 5, "rest_factor": 0},
                {"kind": "self_weight", "mesh": "roof", "material": "PVC-polyester I"},
            ],
            "anchors": [{"points": points[points[:, 2] == 0.0]}],
            "stages": {"freeze": {"net": {"axial_stiffness": 500}}},
        }
    )
    (note,) = freeze(scene).notes
    start = 4.0 * 2.0**0.5 * 0.75e-3 * GRAVITY
    assert f"is the weight of the start shape, {start:.4g} kN" in note and note.endswith("kN, which area_weight gives")
