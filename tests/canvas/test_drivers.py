"""Counter, Sequence and Trail on a canvas of stand-ins: what each solution gives, and what it schedules."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from canvas.canvasing import point, sentences
from canvas.test_tools import Placed, branches
from hookean_canvas.run import stand_in
from hookean_client import canvas_geometry


@pytest.fixture(autouse=True)
def canvas() -> Iterator[Any]:
    made = stand_in.Canvas().install()
    yield made
    made.remove()


def scheduled(placed: Placed) -> list[int]:
    """The waits of what was scheduled since, which are forgotten."""
    found = [wait for wait, _ in placed.bench.document.scheduled]
    placed.bench.document.scheduled[:] = []
    return found


def test_a_counter_counts_solutions_from_reset_on() -> None:
    """1 more for each, 0 while reset; each component by itself."""
    one, other = Placed("Counter"), Placed("Counter")
    assert [one.once(_reset_=[held])["count"] for held in (True, True, False, False, False)] == [0, 0, 1, 2, 3]
    assert other.once()["count"] == 0 and other.once()["count"] == 1
    assert one.once(_reset_=[True])["count"] == 0 and scheduled(one) == scheduled(other) == []


def test_a_counter_with_an_interval_schedules_itself_until_it_is_reset() -> None:
    placed = Placed("Counter")
    for held, waits in ((True, []), (False, [25]), (False, [25]), (True, [])):
        placed.once(_reset_=[held], _interval_=[25])
        assert scheduled(placed) == waits


def test_a_sequence_resets_once_runs_and_ends() -> None:
    """Frame 0 resets; 3 frames schedule 3 more solutions, then none."""
    placed = Placed("Sequence")
    found = []
    while not found or scheduled(placed) == [40]:
        found.append(placed.once(_frames_=[3]))
    assert [one["reset"] for one in found] == [True, False, False, False]
    assert [one["frame"] for one in found] == [0, 1, 2, 3]
    assert placed.once(_frames_=[3])["frame"] == 3 and scheduled(placed) == []
    assert placed.once(_frames_=[3], _restart_=[True]) == {"reset": True, "frame": 0} and scheduled(placed) == []
    assert placed.once(_frames_=[3]) == {"reset": False, "frame": 1} and scheduled(placed) == [40]


def test_a_trail_is_the_path_of_each_point() -> None:
    placed = Placed("Trail")
    still, rows = point(9, 9, 9), [(0, 0, 0), (1, 0, 0), (1, 0, 0), (1, 2, 0)]
    for row in rows:
        found = placed.once(_points=[point(*row), still])
    path, none = found["trail"]
    assert canvas_geometry.polyline(path) == [[0, 0, 0], [1, 0, 0], [1, 2, 0]] and none is None
    assert [len(branch) for branch in branches(found["points"]).values()] == [3, 1]
    kept = placed.once(_points=[point(5, 5, 5), still], _record_=[False])
    assert canvas_geometry.polyline(kept["trail"][0]) == canvas_geometry.polyline(path)
    assert placed.once(_points=[point(5, 5, 5), still], _reset_=[True])["trail"] == [None, None]
    again = placed.once(_points=[point(7, 5, 5), still])
    assert canvas_geometry.polyline(again["trail"][0]) == [[5, 5, 5], [7, 5, 5]]
    assert placed.once(_points=[still])["trail"] == [None]  # another number of points begins again


@pytest.mark.parametrize(
    ("name", "inputs", "sentence"),
    [
        ("Counter", {"_interval_": [-5]}, "Interval: -5 given; a whole number from 0 on is expected."),
        ("Sequence", {"_frames_": [0]}, "Frames: 0 given; a whole number from 1 on is expected."),
        ("Trail", {}, "Points are missing; connect them."),
        ("Trail", {"_points": ["x"]}, 'The text "x" is not a point; connect points.'),
    ],
)
def test_one_sentence_says_what_does_not_fit(name: str, inputs: dict[str, Any], sentence: str) -> None:
    placed = Placed(name)
    assert all(value is None for value in placed.once(**inputs).values())
    assert sentences(placed.ghenv) == [sentence]
