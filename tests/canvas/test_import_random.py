"""Definitions for Kangaroo drawn at random are translated whole, and come to the shape at rest."""

from __future__ import annotations

from pathlib import Path

import pytest

from canvas.kangaroo_random import GOALS, SOLVERS, Drawn, Varied
from canvas.kangaroo_samples import wires
from hookean_canvas.archive import write
from hookean_canvas.inspect import lint
from hookean_canvas.kangaroo import translate as kangaroo
from hookean_canvas.run import graph
from hookean_canvas.run.clusters import opened
from hookean_canvas.run.evaluate import Canvas
from hookean_canvas.run.unsupported import unsupported
from serving import HANG, Home

BOUNCY = next(line for line in SOLVERS if line.startswith("BouncySolver"))
FREE = ("PolygonArea",)
"""Goals that leave a shape free to wander: in these definitions nothing but an area holds a polygon."""
LOOSE = {"Direction", "Angle"}
"""Goals of the same two lines, whose lengths neither holds: together they may draw a line to a point."""
LOST = {"Strength > Floor.Strength"}
"""What a translation cannot keep of these definitions: the strength of a floor, which is hard here."""


def translated_whole(seed: int, kind: type[Drawn] = Drawn) -> None:
    """Every solver with all its goals, no wire and no value lost but those of LOST, and no fault in the file."""
    before = kind(seed).archive()
    after, report = kangaroo.translate(before)
    assert (report.whole, report.stays) == (report.solvers, []), report.text()
    assert report.kangaroo == len(report.swapped)
    assert report.wires == len(wires(before)) == report.kept + len(report.lost) + len(report.idle)
    assert {wire for wire, _ in report.lost} <= LOST and report.values == [], report.text()
    known = "and the file names no library for it"  # of older versions, whose ids are in no list
    assert [one for one in lint.faults(after) if kind is Drawn or known not in one] == []


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(6))
def test_a_definition_drawn_at_random_is_translated_whole(seed: int) -> None:
    translated_whole(seed)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
def test_a_varied_definition_is_translated_whole_and_nothing_of_it_is_unknown(seed: int) -> None:
    """With clusters, groups, recorders, older versions of components, and disabled objects of a plug-in."""
    translated_whole(seed, Varied)
    after, _ = kangaroo.translate(Varied(seed).archive())
    assert unsupported(opened(graph.of(after))) == {}


@pytest.mark.soak
@pytest.mark.parametrize("first", range(0, 300, 50))
def test_many_definitions_drawn_at_random_are_translated_whole(first: int) -> None:
    for seed in range(6 + first, 56 + first):
        translated_whole(seed)


def rests(d: Drawn, folder: Path) -> None:
    """The translated file, written and read, comes to equilibrium; no component complains."""
    root, _ = kangaroo.translate(d.archive())
    write(root, folder / "drawn.gh")
    outcome = Canvas(opened(graph.read(folder / "drawn.gh"))).run(HANG)
    assert [m for m in outcome.messages if m.level == "error"] == [], d.told
    assert outcome.at_rest and "In equilibrium" in outcome.engines[0], (d.told, outcome.engines)
    assert len(outcome.panels["particles"].values_in_order()) >= 9


@pytest.mark.slow
def test_a_bouncing_net_comes_to_rest_without_a_canvas_to_watch_it(home: Home, tmp_path: Path) -> None:
    """It keeps 0.99 of its velocity in a step, so rest is some 10,000 steps away; nobody watches, so they are run at
    full speed."""
    rests(Drawn(2, (GOALS[1], GOALS[4], GOALS[2]), BOUNCY), tmp_path)


@pytest.mark.soak
@pytest.mark.parametrize("first", range(0, 150, 50))
def test_varied_definitions_come_to_rest(first: int, home: Home, tmp_path: Path) -> None:
    for seed in range(first, first + 50):
        d = Varied(seed)
        if not (set(FREE) & set(d.told) or set(d.told) >= LOOSE):
            rests(d, tmp_path)
    home.delete_sessions()


@pytest.mark.soak
@pytest.mark.parametrize("solver", [SOLVERS[1], BOUNCY])
def test_a_net_with_any_goal_of_the_table_comes_to_rest(solver: str, home: Home, tmp_path: Path) -> None:
    for seed, line in enumerate(GOALS):
        if not line.startswith(FREE):
            rests(Drawn(seed, tuple(dict.fromkeys([GOALS[1], GOALS[4], line])), solver), tmp_path)
    home.delete_sessions()
