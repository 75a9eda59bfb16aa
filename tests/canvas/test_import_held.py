"""Anchors by axes with a strength of their own, and the damping of BouncySolver, come across as in Kangaroo."""

from __future__ import annotations

from pathlib import Path
from typing import Any
from uuid import UUID

import pytest

from canvas.kangaroo_samples import LENGTH, Kangaroo, solver_of
from hookean_canvas.archive import Chunk
from hookean_canvas.kangaroo import translate as kangaroo
from hookean_canvas.kangaroo.held import DRAG
from hookean_canvas.kangaroo.report import Report
from hookean_canvas.run import graph
from hookean_canvas.run.evaluate import Canvas
from serving import HANG, Home

BOUNCY = (
    ("GoalObjects", None), ("Reset", False), ("Threshold", 1e-15), ("Tolerance", 0.01), ("Damping", 0.99),
    ("Iterations", 10), ("On", True),
)  # fmt: skip


def named(root: Chunk) -> list[str]:
    """The nicknames of all objects."""
    return [node.nickname for node in graph.of(root).nodes]


def held(strength: float, damping: float = 0.99, slid: bool = False) -> tuple[Chunk, Report]:
    """A line of 1 m between an anchor by axes and a soft load, for BouncySolver."""
    d = Kangaroo(f"held {strength} {damping} {slid}", "Held", "A line held by axes.")
    a, b = d.point(0, 0, 0), d.point(1, 0, 0)
    axes = (("Point", None), ("X", True), ("Y", True), ("Z", True), ("Strength", strength))
    goals = [
        d.kangaroo("Length(Line)", LENGTH, ["Spring"], line=d.native("Line", start_point=a, end_point=b)),
        d.kangaroo("AnchorXYZ", axes, ["A"], point=[a, b]),
        d.kangaroo("Load", (("Point", None), ("Force vector", (0.0, 0.0, -2.0))), ["Unary"], point=b),
    ]
    wired = {"damping": d.slider("Damping", damping, 0, 1, 2)} if slid else {}
    typed = [(name, damping if name == "Damping" else value) for name, value in BOUNCY]
    solver = d.kangaroo("BouncySolver", typed, ["I", "V", "O"], goalobjects=goals, **wired)
    d.panel("particles", solver["V"])
    return kangaroo.translate(d.archive())


@pytest.mark.parametrize(("strength", "planes"), [(1000.0, False), (50.0, True)])
def test_anchors_by_axes_are_exact_unless_a_strength_of_their_own_is_given(strength: float, planes: bool) -> None:
    root, report = held(strength)
    assert report.complete, report.text()
    assert ("Axes" in named(root)) is planes


@pytest.mark.parametrize(("damping", "slid", "script"), [(0.99, False, False), (0.9, False, True), (0.99, True, True)])
def test_another_damping_than_that_of_the_settings_becomes_drag(damping: float, slid: bool, script: bool) -> None:
    root, report = held(1000.0, damping, slid)
    assert report.complete, report.text()
    assert ("Drag" in named(root)) is script
    assert solver_of(root) == "bouncy"


@pytest.mark.parametrize("part", [0.5, 0.9, 0.99, 1.0])
def test_a_step_of_verlet_keeps_the_part_of_the_velocity_that_the_script_is_given(part: float, canvas: Any) -> None:
    """Half a step takes v to v (1 - h c / 2), the other divides it by 1 + h c / 2; h is 0.01 and the mass 1."""
    names: dict[str, Any] = {"_parts": [part]}
    exec(DRAG, names)
    (drag,) = names["drag"]
    assert (1 - 0.005 * drag) / (1 + 0.005 * drag) == pytest.approx(part, abs=1e-12)


@pytest.mark.soak
def test_a_soft_anchor_by_axes_gives_way_by_force_over_strength(home: Home, tmp_path: Path) -> None:
    """The load of 2 pulls the point down 2 / 50; the line turns, and stays as long but for the square of that."""
    root, _ = held(50.0, 0.9)
    found = graph.of(root)
    found.file = tmp_path / "held.ghx"
    outcome = Canvas(found).run(HANG)
    assert outcome.at_rest and [m for m in outcome.messages if m.level == "error"] == []
    heights = sorted(p.Z for p in outcome.panels["particles"].values_in_order())
    assert heights == pytest.approx([-0.04, 0.0], abs=2e-3)


def test_the_limit_of_zombie_solver_and_the_weight_of_a_load_that_kangaroo_types_in_say_nothing() -> None:
    d = Kangaroo("usual", "Usual", "What Kangaroo types in.")
    load = (("Point", None), ("Force vector", (0.0, 0.0, 1.0)), ("Weighting", 1.0))
    a, b = d.point(0, 0, 0), d.point(1, 0, 0)
    goals = [
        d.kangaroo("Length(Line)", LENGTH, ["Spring"], line=d.native("Line", start_point=a, end_point=b)),
        d.kangaroo("Load", load, ["Unary"], guid=UUID("2019c995-53af-4eb2-976d-95b1fdc823fa"), point=b),
    ]
    typed = (("GoalObjects", None), ("Threshold", 1e-10), ("Tolerance", 0.01), ("MaxIterations", 50000))
    d.panel("particles", d.kangaroo("ZombieSolver", typed, ["I", "V", "O"], goalobjects=goals)["V"])
    _, report = kangaroo.translate(d.archive())
    assert report.complete, report.text()
