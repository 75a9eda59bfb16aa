"""Limits of results: of a floor or a support by its name, and of what no part of a model has."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import hookean
from hookean import InputError, Scene
from hookean.files import limits, tables
from hookean.system.system import compile

PUSHED = {
    "particles": [[0, 0, 0], [2, 0, 0], [0, 0, 5], [3, 0, 0]],
    "forces": [
        {"kind": "unary", "name": "crates", "particles": [0, 1, 3], "vector": [[-1, 0, -2], [0, 0, -3], [0, 0, -4]]},
        {"kind": "floor", "name": "ground"},
        {"kind": "floor", "name": "wall", "normal": [1, 0, 0]},
        {"kind": "floor", "name": "far", "point": [9, 0, 0], "normal": [-1, 0, 0]},
        {"kind": "support", "name": "soil", "particles": [3], "stiffness": [400, 400, 400], "targets": [[3, 0, 0.5]]},
    ],
    "anchors": [{"name": "top", "particles": [2]}],
}  # fmt: skip


def said(text: str, given: dict[str, Any] = PUSHED) -> list[str]:
    """What exceeds the limits."""
    scene = Scene.read(given)
    result, system = hookean.relax(scene), compile(scene)
    assert result.converged
    return limits.exceeded(limits.read_limits(text), tables.sections(system, result), system, result)


@pytest.mark.parametrize(
    ("name", "most", "at"),
    [("ground", 3.0, 1), ("wall", 5**0.5, 0), ("floor", 3.0, 1), ("far", None, None), ("soil", 4.0, 3)],
)
def test_one_floor_or_support_has_a_limit(name: str, most: float | None, at: int | None) -> None:
    """Crates of 2 and 1 N in a corner, of 3 N on the ground, and of 4 N on soil that lifts it off; the far wall carries
    nothing, which no limit forbids. What lies on two floors counts for both, as it is the force of both."""
    if most is None:
        assert said(f"[force.{name}]\nmax_reaction = 0") == []
        return
    assert said(f"[force.{name}]\nmax_reaction = {most * 1.001}") == []
    (sentence,) = said(f"[force.{name}]\nmax_reaction = {most * 0.999}")
    where = f"element 0 of {name}" if name == "soil" else f"particle {at}"
    assert sentence.startswith(f"force {name}: max reaction {most:.6g} N at {where} exceeds the limit")


def test_the_floor_of_the_settings_is_named_by_its_kind() -> None:
    lying = {
        "particles": [[0, 0, 0]],
        "forces": [{"kind": "unary", "particles": [0], "vector": [0, 0, -5]}],
        "settings": {"floor": True},
    }
    assert said("[force.floor]\nmax_reaction = 5.01", lying) == []
    assert len(said("[force.floor]\nmax_reaction = 4.99", lying)) == 1


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[force.grond]\nmax_reaction = 1", 'no such force; it has .*"ground", "floor", "wall", "far"'),
        ("[force.far]\nmax_force = 1", "force far max_force: no element has a force along a line"),
        ("[force.crates]\nmax_reaction = 1", "force crates max_reaction: no anchor, support or floor"),
        ("[anchor.top]\nmax_force = 1", "anchor top max_force: no element has a force along a line"),
        ("max_strain = 0.01", "model max_strain: no element has a strain"),
    ],
)
def test_a_limit_that_nothing_could_exceed_is_refused(text: str, words: str) -> None:
    """It would be met whatever happened, and its user would trust it."""
    with pytest.raises(InputError, match=words):
        said(text)


def test_a_model_without_supports_meets_any_limit_of_reactions() -> None:
    """Nothing holds it, and nothing is exceeded; two particles are drawn together."""
    free = {"particles": [[0, 0, 0], [1, 0, 0]], "forces": [{"kind": "springs", "particles": [[0, 1]], "force": 2}]}
    assert said("max_reaction = 0\nmax_force = 1e9", free) == []
    assert np.isfinite(limits.read_limits("max_reaction = 0")["max_reaction"])


def test_a_displacement_is_at_the_particle_that_moved_most() -> None:
    hanging = {
        "particles": [[0, 0, 0], [0, 0, -1], [0, 0, -2]],
        "forces": [
            {"kind": "springs", "name": "rope", "particles": [[0, 1], [1, 2]], "stiffness": 10},
            {"kind": "unary", "particles": [2], "vector": [0, 0, -1]},
        ],
        "anchors": [{"particles": [0]}],
    }
    (sentence,) = said("max_displacement = 0.1", hanging)
    assert "at particle 2 of rope exceeds" in sentence
