"""Loads along beams act on their ends: a warning reports the moments that are missing between."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import hookean
from hookean import Scene
from hookean.files.report import report

LENGTH, WEIGHT = 6.0, 2.0


def warnings(parts: int, load: dict[str, Any], end: Any = (LENGTH, 0.0, 0.0), **more: Any) -> tuple[str, ...]:
    """Warnings on a beam from the origin to `end`, of so many elements, with both ends clamped."""
    pairs = [[i, i + 1] for i in range(parts)]
    scene = Scene.read(
        {
            "units": {"force": "kN"},
            "particles": np.linspace([0.0, 0.0, 0.0], end, parts + 1),
            "materials": {"steel": {"E": 210e6, "G": 81e6, "density": 7.85}},
            "sections": {"tube": {"shape": "tube", "diameter": 0.2, "thickness": 0.01}},
            "forces": [
                {"kind": "beam", "name": "girder", "particles": pairs, "material": "steel", "section": "tube"},
                {"particles": [pair[::-1] for pair in pairs], **load},
            ],
            "anchors": [{"particles": [0, parts], "rotations": "xyz"}],
            **more,
        }
    )
    return tuple(hookean.relax(scene).report.warnings)


EVEN = {"kind": "line_weight", "weight": WEIGHT}


def test_a_member_of_one_element_has_no_moment_and_a_warning() -> None:
    """W l / 8 of what hangs between the ends of a clamped girder, which has moments of W l / 12 and W l / 24."""
    (said,) = warnings(1, EVEN)
    missing = WEIGHT * LENGTH**2 / 8.0
    assert said.startswith("/forces/0: loads along girder act on the ends of its beams.")
    assert f"moments of up to {missing:.3g} kN m are missing; at the ends there are up to 0." in said


@pytest.mark.parametrize(("parts", "warned"), [(2, True), (3, True), (5, False), (8, False)])
def test_more_elements_miss_less(parts: int, warned: bool) -> None:
    """Of n elements W l / 8 n^2 is missing, beside W l / 12 (1 - 1 / n^2) of a clamped girder under forces: above a
    tenth below n = 4."""
    assert (12.0 / (8.0 * (parts**2 - 1.0)) > 0.1) is warned
    assert bool(warnings(parts, EVEN)) is warned


def test_weights_of_a_material_count_and_loads_along_a_beam_do_not() -> None:
    """A level girder, one that leans 3 in 4 (its part across, 0.6 of the length), and a column, which is not bent."""
    steel = {"kind": "self_weight", "material": "steel", "section": "tube"}
    weight = np.pi * 0.01 * 0.19 * 7.85 * 9.80665 * LENGTH
    for end, across in (((LENGTH, 0, 0), 1.0), ((0.6 * LENGTH, 0, 0.8 * LENGTH), 0.6)):
        (said,) = warnings(1, steel, end)
        assert f"up to {weight * across * LENGTH / 8.0:.3g} kN m" in said
    assert warnings(1, steel, (0.0, 0.0, LENGTH)) == ()
    assert warnings(1, {"kind": "self_weight", "total": 3.0, "particles": [0, 1]}) == ()


def test_cases_and_reports_have_the_warning() -> None:
    """The load of a case, which the form is without."""
    scene = Scene.read(
        {
            "particles": [[0, 0, 0], [LENGTH, 0, 0]],
            "forces": [
                {"kind": "beam", "particles": [[0, 1]], "E": 1e6, "G": 1e6, "A": 1, "Iy": 1, "Iz": 1, "J": 1},
                {"kind": "line_weight", "name": "snow", "particles": [[0, 1]], "weight": WEIGHT},
            ],
            "anchors": [{"particles": [0, 1], "rotations": "xyz"}],
            "load_cases": {"snow": {"forces": ["snow"]}},
        }
    )
    found = hookean.load_cases(scene)
    assert found.form.report.warnings == [] and "are missing; at the ends" in repr(found)
    assert report(scene, cases=found, pictures=False).count("<p>Warning: /forces/0: loads along beam") == 1
