"""What a run that diverges advises: it names the cause, and whoever follows it does not diverge.

Oracles: the change that made it diverge, and the limit 2 / omega of central differences for one mass on one spring.
"""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest

from hookean import Scene, Simulation, relax

CHAIN: dict[str, Any] = {
    "particles": [[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0]],
    "forces": [
        {"kind": "springs", "particles": [[0, 1], [1, 2]], "stiffness": 100, "name": "soft"},
        {"kind": "springs", "particles": [[2, 3]], "stiffness": 100, "name": "end"},
        {"kind": "unary", "particles": [1, 2], "vector": [0, 0, -1]},
    ],
    "anchors": [{"particles": [0, 3]}],
    "settings": {"time_step": 0.01},
}


def run(scene: dict[str, Any], *edits: dict[str, Any]) -> Simulation:
    """A scene in motion, edited, until it ends or for 4,000 steps."""
    simulation = Simulation(Scene.read(scene))
    for edit in edits:
        simulation.patch(edit)
    simulation.step(400)
    return simulation


@pytest.mark.slow
@pytest.mark.parametrize(
    ("edit", "what", "where"),
    [
        ({"forces": {"1": {"stiffness": 1e6}}}, "stiffness", '/forces/1, springs "end"'),
        ({"forces": {"0": {"stiffness": 1e6}}}, "stiffness", '/forces/0, springs "soft"'),
        ({"forces": {"1": {"damping": 1e4}}}, "damping", '/forces/1, springs "end"'),
        ({"settings": {"time_step": 1.0}}, "stiffness", '/forces/0, springs "soft"'),
    ],
)
def test_a_time_step_that_is_too_large_is_blamed_on_what_limits_it(edit: dict[str, Any], what: str, where: str) -> None:
    """The force that was made stiff or damped, by its number and name; the step that is said to hold holds."""
    simulation = run(CHAIN, edit)
    assert f"for this mass and the {what} of {where}; " in simulation.message
    assert simulation.message.endswith(f"more mass or less {what}.")
    found = re.search(r"Steps of (\S+) s were stable", simulation.message)
    assert found is not None
    assert run(CHAIN, edit, {"settings": {"time_step": float(found[1])}}).status != "diverged"


def test_drag_is_named_in_the_warning() -> None:
    [warning] = run(CHAIN, {"settings": {"drag": 1e4}}).system.report.warnings
    assert "the drag of /settings/drag" in warning and warning.endswith("less drag")


def test_the_step_that_holds_is_that_of_one_mass_on_one_spring() -> None:
    """A mass of 1 kg between two springs of 5e5 N/m in line: omega^2 = 1e6 / s^2, 2 / omega = 2 ms."""
    scene = {
        "particles": [[0, 0, 0], [1, 0, 0], [2, 0, 0]],
        "forces": [{"kind": "springs", "particles": [[0, 1], [1, 2]], "stiffness": 5e5, "damping": 0}],
        "anchors": [{"particles": [0, 2]}],
        "velocities": [[0, 0, 0], [0.01, 0, 0], [0, 0, 0]],
        "settings": {"solver": "verlet", "drag": 0, "time_step": 0.01},
    }
    found = re.search(r"(\S+) s in small ones", run(scene).message)
    assert found is not None and float(found[1]) == pytest.approx(0.002, rel=1e-3)


SPRING = {"kind": "springs", "particles": [[0, 1]], "stiffness": 1}
HUGE = {"kind": "unary", "particles": [1], "vector": [0, 0, -5e9]}
TWO = {"particles": [[0, 0, 0], [1, 0, 0]], "forces": [SPRING, HUGE], "anchors": [{"particles": [0]}]}
ON_A_SPRING = {
    **TWO,
    "anchors": [],
    "forces": [SPRING, HUGE, {"kind": "anchor_spring", "particles": [0], "strength": 1}],
}


@pytest.mark.parametrize("scene", [TWO, ON_A_SPRING], ids=["anchored", "on a spring"])
def test_a_load_that_is_too_large_is_named(scene: dict[str, Any]) -> None:
    """Everything is supported, by an anchor or elastically: no sentence about missing supports. With a load that the
    springs can carry it does not diverge."""
    told = [run(scene).message, relax(Scene.read(scene)).message]
    for said in told:
        assert "Diverged" in said and "add anchors" not in said and "Nothing supports" not in said
        assert "load of 5e+09 N on particle 1 (of /forces/1, unary) is too large" in said
    lower = {**scene, "forces": [SPRING, {**HUGE, "vector": [0, 0, -1]}, *scene["forces"][2:]]}
    assert run(lower).status != "diverged" and relax(Scene.read(lower)).status == "converged"


@pytest.mark.parametrize("anchored", [False, True], ids=["nothing held", "another part held"])
def test_what_flies_away_unsupported_is_named(anchored: bool) -> None:
    """Two parts; the one that nothing supports moves at 1e6 m/s. An anchor in it ends that."""
    scene: dict[str, Any] = {
        "particles": [[0, 0, 0], [1, 0, 0], [5, 0, 0], [6, 0, 0]],
        "forces": [{"kind": "springs", "particles": [[0, 1], [2, 3]], "damping": 0}],
        "anchors": [{"particles": [0]}] if anchored else [],
        "velocities": [[0, 0, 0], [0, 0, 0], [1e6, 0, 0], [1e6, 0, 0]],
        "settings": {"drag": 0, "solver": "verlet"},
    }
    simulation = run(scene)
    assert simulation.status == "diverged"
    assert "Nothing supports the 2 particles connected with particle 2 (of /forces/0, springs): add anchors" in (
        simulation.message
    )
    still = {**scene, "anchors": [*scene["anchors"], {"particles": [2, 3]}], "velocities": np.zeros((4, 3)).tolist()}
    assert run(still).status != "diverged"
