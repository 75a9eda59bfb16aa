"""Loads along soap films: nothing carries them, and the result has their sum."""

from __future__ import annotations

import re

import numpy as np
import pytest

import hookean


def film(load: dict[str, object], n: int = 6) -> hookean.Result:
    """A film on a sloping hypar of 6 x 6, under a load."""
    side = np.linspace(0.0, 6.0, n + 1)
    vertices = [[a, b, 0.1 * a * b] for a in side for b in side]
    number = np.arange((n + 1) ** 2).reshape(n + 1, n + 1)
    corners = [number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]]
    rim = np.unique(np.concatenate([number[0], number[-1], number[:, 0], number[:, -1]]))
    return hookean.relax(
        hookean.Scene.read(
            {
                "particles": vertices,
                "meshes": {"m": {"vertices": vertices, "faces": np.stack(corners, axis=-1).reshape(-1, 4).tolist()}},
                "forces": [{"kind": "soapfilm", "mesh": "m", "tension": 2.0}, load],
                "anchors": [{"particles": rim.tolist()}],
                "settings": {"tolerance": 1e-10},
            }
        )
    )


def test_the_result_has_the_sum_of_loads_that_no_film_carries() -> None:
    # snow on a slope: what the warning names is what reactions and loads lack, to its three digits
    result = film({"kind": "area_weight", "mesh": "m", "weight": 0.5, "per": "plan"})
    (said,) = result.report.warnings
    assert result.converged
    named = np.array(re.findall(r"\(([-\d., e]+)\) N, not", said)[0].split(", "), float)
    sums = result.reactions["force"].sum(axis=0) + result.loads["resultant"].sum(axis=0)
    assert np.abs(sums).max() > 1.0
    assert named == pytest.approx(sums, rel=5e-3)


@pytest.mark.parametrize(
    "load",
    [
        {"kind": "pressure", "mesh": "m", "pressure": 0.3},
        {"kind": "unary", "particles": [24], "vector": [0, 0, 0]},
    ],
)
def test_pressure_and_no_load_at_all_have_no_part_along_a_film(load: dict[str, object]) -> None:
    assert film(load).report.warnings == []
