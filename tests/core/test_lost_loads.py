"""Loads that act on less than was drawn: what welding makes of small elements, and what is given without a place."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean import InputError, Scene, load_cases, relax

SMALL = 0.05  # width of the second face, below the tolerance
MESH = {
    "vertices": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [1 + SMALL, 0, 0], [1 + SMALL, 1, 0]],
    "faces": [[0, 1, 2, 3], [1, 4, 5, 2]],
}


def told(load: dict[str, Any], *, tolerance: float) -> tuple[list[str], np.ndarray]:
    """Warnings of a small net under a load, and the sum of its reactions."""
    scene = Scene.read(
        {
            "weld_tolerance": tolerance,
            "meshes": {"sheet": MESH},
            "forces": [{"kind": "springs", "mesh": "sheet", "stiffness": 10.0}, load],
            "anchors": [{"points": MESH["vertices"]}],
        }
    )
    result = relax(scene)
    return [said for said in result.report.warnings if said.startswith("/forces/1")], result.reactions["force"].sum(0)


LOST = {
    "line": ({"kind": "line_weight", "lines": [[[1, 0, 0], [1 + SMALL, 0, 0]]], "weight": 2.0}, "1 of 1", 2.0 * SMALL),
    "edges": ({"kind": "self_weight", "mesh": "sheet", "per_length": 2.0}, "2 of 7", None),
    "area": ({"kind": "self_weight", "mesh": "sheet", "material": "S235", "thickness": 0.01}, "1 of 2", None),
    "pressure": ({"kind": "pressure", "mesh": "sheet", "pressure": 3.0}, "1 of 2", 3.0 * SMALL),
}


@pytest.mark.parametrize("name", LOST)
def test_a_load_that_welding_loses_is_named(name: str) -> None:
    """The warning counts the elements. The reactions are smaller by the load of these elements: length times load per
    length, area times pressure."""
    load, count, missing = LOST[name]
    warned, less = told(load, tolerance=2 * SMALL)
    silent, whole = told(load, tolerance=SMALL / 50)
    assert silent == []
    assert len(warned) == 1 and f"{count} elements" in warned[0] and "their load is lost" in warned[0]
    lost = float(np.linalg.norm(whole)) - float(np.linalg.norm(less))
    assert lost > 0.0
    if missing is not None:
        assert lost == pytest.approx(missing, rel=1e-12)


def test_a_face_that_keeps_an_area_is_not_named() -> None:
    """A quadrilateral with one side at one particle is a triangle: its area is half, and the load acts on it."""
    corner = {"vertices": [[0, 0, 0], [1, 0, 0], [1, SMALL, 0], [0, 1, 0]], "faces": [[0, 1, 2, 3]]}
    scene = {
        "weld_tolerance": 2 * SMALL,
        "meshes": {"sheet": corner},
        "forces": [
            {"kind": "springs", "mesh": "sheet", "stiffness": 10.0},
            {"kind": "pressure", "mesh": "sheet", "pressure": 3.0},
        ],
        "anchors": [{"points": corner["vertices"]}],
    }
    assert not any("their load is lost" in said for said in relax(Scene.read(scene)).report.warnings)


@pytest.mark.parametrize(
    "load",
    [
        {"kind": "unary", "points": [], "vector": [0, 0, -1]},
        {"kind": "self_weight", "points": [], "total": 9.0},
        {"kind": "line_weight", "lines": [], "weight": 1.0},
    ],
    ids=lambda load: load["kind"],
)
def test_a_load_without_a_place_is_named(load: dict[str, Any]) -> None:
    """The report names a load that has no points, lines or faces."""
    warned, total = told(load, tolerance=1e-6)
    assert len(warned) == 1 and "acts on nothing" in warned[0]
    assert not total.any()


def test_an_anchor_without_a_place_is_named() -> None:
    """An anchor that holds nothing is reported, beside one that does."""
    scene = {
        "forces": [{"kind": "springs", "lines": [[[0, 0, 0], [1, 0, 0]]], "stiffness": 10.0}],
        "anchors": [{"points": [[0, 0, 0]]}, {"points": []}],
    }
    warned = [said for said in relax(Scene.read(scene)).report.warnings if "holds nothing" in said]
    assert len(warned) == 1 and warned[0].startswith("/anchors/1")


def test_each_line_that_met_keeps_its_own_weight() -> None:
    """Of lines with a weight per length each, one meets nothing: the others carry theirs, 2 N/m and 5 N/m on 1 m."""
    ends = [[0, 0, 0], [1, 0, 0], [2, 0, 0]]
    scene = {
        "strict": False,
        "forces": [
            {"kind": "springs", "lines": [ends[:2], ends[1:]], "stiffness": 10.0},
            {
                "kind": "self_weight",
                "lines": [ends[:2], [[0, 0, 9], [1, 0, 9]], ends[1:]],
                "per_length": [2.0, 3.0, 5.0],
            },
        ],
        "anchors": [{"points": ends}],
    }
    total = relax(Scene.read(scene)).reactions["force"].sum(0)
    assert total == pytest.approx([0.0, 0.0, 7.0], rel=1e-12)


def test_a_load_case_says_that_its_load_met_nothing() -> None:
    """What is printed of load cases names a load that is left out, not only its reactions of 0."""
    scene = {
        "strict": False,
        "forces": [
            {"kind": "springs", "lines": [[[0, 0, 0], [1, 0, 0]], [[1, 0, 0], [2, 0, 0]]], "force": 9, "stiffness": 99},
            {"kind": "unary", "name": "snow", "points": [[1, 0, 0.2]], "vector": [0, 0, -1]},
        ],
        "anchors": [{"points": [[0, 0, 0], [2, 0, 0]]}],
        "load_cases": {"snow": {"forces": ["snow"]}},
    }
    assert "its point met no particle" in repr(load_cases(Scene.read(scene)))


def row(*loads: dict[str, Any], **more: Any) -> Scene:
    """Three particles on a line, at 0, 1 and 2 m, with springs between them; the first and last are held."""
    scene = {
        "particles": [[0, 0, 0], [1, 0, 0], [2, 0, 0]],
        "forces": [{"kind": "springs", "particles": [[0, 1], [1, 2]], "stiffness": 100.0, "rest_factor": 0.8}, *loads],
        "anchors": [{"particles": [0, 2]}],
        "settings": {"tolerance": 1e-10},
    }
    return Scene.read({**scene, **more})


def test_a_point_that_is_nearer_to_another_particle_is_named() -> None:
    """A point at 0.9 m meets particle 0, the first within 0.95 m, although particle 1 is 0.1 m away."""
    load = {"kind": "unary", "points": [[0.9, 0, 0], [1, 0, 0]], "vector": [0, 0, -1]}
    (said,) = (one for one in relax(row(load, weld_tolerance=0.95)).report.warnings if "nearer" in one)
    assert said.startswith("/forces/1/points: 1 of 2 points")
    assert "point 0 met particle 0, 0.9 m away, and particle 1 is 0.1 m away" in said
    wide = relax(row({**load, "points": [[0.9, 0, 0]]}, weld_tolerance=0.45))
    assert not any("nearer" in one for one in wide.report.warnings)


def test_a_load_on_a_held_particle_that_nothing_touches_is_named() -> None:
    """Of 12 N on four particles, 3 N go straight into the anchor of one that is no part of the net."""
    lonely = {"particles": [[0, 0, 0], [1, 0, 0], [2, 0, 0], [1, 5, 0]], "anchors": [{"particles": [0, 2, 3]}]}
    result = relax(row({"kind": "self_weight", "total": 12.0}, **lonely))
    assert any(said.startswith("particle 3 passes its load straight to its anchor") for said in result.report.warnings)
    assert result.reactions["force"][list(result.reactions["particles"]).index(3), 2] == pytest.approx(3.0)
    assert not any(
        "straight to its anchor" in said for said in relax(row({"kind": "self_weight", "total": 12.0})).report.warnings
    )


def test_a_load_of_a_case_that_meets_nothing_is_an_error_before_the_case_runs() -> None:
    """`relax` raises the error although the case does not act in the form. With `strict` false it does not."""
    snow = {"kind": "unary", "name": "snow", "points": [[1, 0, 0.2]], "vector": [0, 0, -1]}
    cases = {"load_cases": {"snow": {"forces": ["snow"]}}}
    with pytest.raises(InputError, match="snow: its point met no particle"):
        relax(row(snow, **cases))
    assert relax(row(snow, strict=False, **cases)).status == "converged"
    assert relax(row({**snow, "points": [[1, 0, 0]]}, **cases)).status == "converged"


def test_what_is_drawn_without_a_size_loses_nothing() -> None:
    """A point given twice makes a line of no length, which has no load to lose."""
    twice = [[[0, 0, 0], [1, 0, 0]], [[1, 0, 0], [1, 0, 0]], [[1, 0, 0], [2, 0, 0]]]
    warned = relax(row({"kind": "line_weight", "lines": twice, "weight": 1.0})).report.warnings
    assert not any("load is lost" in said for said in warned)


@pytest.mark.parametrize("load", ["pressure", "wind_pressure", "hydrostatic"])
def test_faces_that_run_both_ways_round_are_told(load: str) -> None:
    """Loads along normals cancel out on them, silently otherwise. Three quads and a triangle, of which one is turned:
    it shares two edges with its neighbours. Edges of three faces have no side."""
    points = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0], [2, 1, 0], [3, 0.5, 0], [1, 0.5, 1]]
    flat, turned, tip, fin = [0, 1, 2, 3], [2, 5, 4, 1], [4, 6, 5], [1, 7, 2]
    for faces, said in [
        ([flat, turned, tip], "at 2 edges (first: faces 0 and 1)"),
        ([flat, turned[::-1], tip], ""),
        ([flat, turned, tip[::-1], fin], ""),
    ]:
        scene = Scene.read(
            {
                "particles": points,
                "meshes": {"sheet": {"vertices": points, "faces": faces}},
                "forces": [{"kind": "springs", "mesh": "sheet"}, {"kind": load, "mesh": "sheet"}],
                "anchors": [{"particles": range(8)}],
            }
        )
        told = [warning for warning in relax(scene).report.warnings if warning.startswith("/forces/1/mesh: faces")]
        assert len(told) == (1 if said else 0) and said in "".join(told)
