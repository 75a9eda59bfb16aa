"""What components share: forces, anchors and settings as text, lists matched, sentences for what does not fit."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from typing import Any

import pytest
import rhino3dm
from hypothesis import given
from hypothesis import strategies as st

from canvas.canvasing import Bench, line, point, sentences
from hookean import Scene
from hookean_canvas.run import stand_in
from hookean_client import canvas, canvas_discretize, canvas_geometry, canvas_packed, canvas_scene
from hookean_server.workers.discretize_task import OPERATIONS


@pytest.fixture(params=["stand-ins", "rhino3dm"])
def rhino(request: pytest.FixtureRequest) -> Iterator[Any]:
    """Rhino.Geometry: of the stand-ins, and rhino3dm's."""
    made = stand_in.Canvas(rhino3dm if request.param == "rhino3dm" else None).install()
    yield made.modules["Rhino.Geometry"]
    made.remove()


def told(name: str, kind: str, **fields: Any) -> tuple[dict[str, Any], Any]:
    """A force read back, and the component that made it."""
    ghenv = Bench().component(name)
    text = canvas.force(ghenv, kind, **fields)
    return (canvas_packed.unpacked(json.loads(text)) if text else {}), ghenv


def test_lines_polylines_and_curves_become_springs_in_their_order(rhino: Any) -> None:
    bent = rhino.PolylineCurve([point(1, 0, 0), point(2, 0, 0), point(3, 1, 0)])
    straight = rhino.LineCurve(point(5, 0, 0), point(6, 0, 0))
    force, _ = told("Springs", "springs", lines=[line((0, 0, 0), (1, 0, 0)), bent, straight], stiffness=[1.0, 2.0, 3.0])
    assert force["lines"] == [
        [[0, 0, 0], [1, 0, 0]], [[1, 0, 0], [2, 0, 0]], [[2, 0, 0], [3, 1, 0]], [[5, 0, 0], [6, 0, 0]],
    ]  # fmt: skip
    assert force["stiffness"] == [1.0, 2.0, 2.0, 3.0]


def test_lists_of_different_lengths_repeat_their_last_value(rhino: Any) -> None:
    places = [point(0, 0, 0), point(1, 0, 0), point(2, 0, 0)]
    vectors = [rhino.Vector3d(0, 0, -1), rhino.Vector3d(0, 0, -2)]
    force, _ = told("Load", "unary", points=places, vector=vectors)
    assert force["vector"] == [[0, 0, -1], [0, 0, -2], [0, 0, -2]]
    longer, _ = told("Load", "unary", points=places[:1], vector=[*vectors, *vectors])
    assert longer["points"] == [[0, 0, 0]] * 4
    corners = told("Bend", "bend", points=(places, places[1:], places[2:]), stiffness=["2.5"])[0]
    assert corners["points"] == [[[0, 0, 0], [1, 0, 0], [2, 0, 0]], [[1, 0, 0], [2, 0, 0], [2, 0, 0]],
                                 [[2, 0, 0], [2, 0, 0], [2, 0, 0]]]  # fmt: skip
    assert corners["stiffness"] == 2.5


def test_each_point_has_a_direction_of_its_own_and_no_value_is_dropped(rhino: Any) -> None:
    """Pull to Line takes one direction or one for each point; truth values are one for all."""
    places, ways = [point(0, 0, 0), point(1, 0, 0)], [rhino.Vector3d(0, 0, 1), rhino.Vector3d(1, 0, 0)]
    force, _ = told("PullToLine", "pull_to_line", points=places, direction=ways)
    assert force["direction"] == [[0, 0, 1], [1, 0, 0]]
    assert told("PullToLine", "pull_to_line", points=places, direction=ways[:1])[0]["direction"] == [0, 0, 1]
    same, _ = told("Springs", "springs", lines=[line((0, 0, 0), (1, 0, 0))], sections=["free", "free"])
    assert same["sections"] == "free"
    other, ghenv = told("Springs", "springs", lines=[line((0, 0, 0), (1, 0, 0))], sections=["free", "closed"])
    assert other == {}
    assert sentences(ghenv) == ["Springs, sections: several values are connected; it takes one for all."]
    lines = [line((0, 0, 0), (1, 0, 0)), line((1, 0, 0), (2, 0, 0))]
    assert told("Beam", "beam", lines=lines, release_start=["yz", ""])[0]["release_start"] == ["yz", ""]


def test_meshes_come_back_as_they_were(rhino: Any) -> None:
    plain = {"vertices": [[0.1, 0, 0], [1, 0, 1e6], [1, 1, 0], [0, 1, 0], [2, 0, 1 / 3]],
             "faces": [[0, 1, 2, 3], [1, 4, 2, 2]]}  # fmt: skip
    mesh = canvas_geometry.to_mesh(plain)
    assert canvas_geometry.mesh(mesh) == plain
    force, _ = told("Springs", "springs", lines=[mesh], stiffness=[2.0])
    assert force["mesh"] == plain
    assert "lines" not in force
    mixed, _ = told("Springs", "springs", lines=[mesh, line((0, 0, 0), (0, 0, 9))])
    assert len(mixed["lines"]) == 6 + 1


def test_curves_and_surfaces_come_back_as_they_were(rhino: Any) -> None:
    plain = {"degree": 2, "points": [[0.0, 0.0, 0.0], [1.0, 2.0, 0.5], [2.0, 0.0, 1 / 3]],
             "knots": [0.0, 0.0, 1.0, 1.0], "weights": [1.0, 0.5, 1.0]}  # fmt: skip
    curve = canvas_geometry.to_curve(plain)
    assert canvas_geometry.curve(curve) == plain
    corners = canvas_geometry.straight(curve)
    assert corners[0] == [0, 0, 0]
    assert corners[100] == pytest.approx([1.0, 2 / 3, (1 / 12 + 0.25 / 2 + 0.0) / 0.75], abs=1e-12)
    polyline = canvas_geometry.to_polyline(plain["points"])
    assert canvas_geometry.curve(polyline) == plain["points"]


@pytest.mark.parametrize(
    ("fields", "level", "said"),
    [
        ({"lines": None}, "Warning", "Springs: its place is missing; connect lines, points or a mesh."),
        ({"lines": ["hello"]}, "Error", 'The text "hello" is not straight; connect lines, polylines or meshes, or '
                                        "divide it first."),
        ({"lines": 1, "stiffness": [float("nan")]}, "Error", "Springs, stiffness: nan is too large or not a number."),
    ],
)  # fmt: skip
def test_what_does_not_fit_is_one_sentence(rhino: Any, fields: dict[str, Any], level: str, said: str) -> None:
    if fields["lines"] == 1:
        fields = {**fields, "lines": [line((0, 0, 0), (1, 0, 0))]}
    force, ghenv = told("Springs", "springs", **fields)
    assert not force
    assert ghenv.Component.messages == [(level, said)]


def test_anchors_are_held_in_the_directions_asked_for(rhino: Any) -> None:
    ghenv = Bench().component("Anchors")
    text = canvas.anchors(ghenv, [point(0, 0, 0), "{1, 2, 3}"], x=[True, False], y=[False], z=["True"])
    assert [(i["point"], i["axes"]) for i in json.loads(text)["items"]] == [([0, 0, 0], "xz"), ([1, 2, 3], "z")]
    assert canvas.anchors(ghenv, None) is None
    assert sentences(ghenv) == ["Anchors: points are missing; connect points."]


def test_forces_make_a_scene_that_the_core_takes(rhino: Any) -> None:
    springs, _ = told("Springs", "springs", lines=[line((0, 0, 0), (1, 0, 0)), line((1, 0, 0), (2, 0, 0))])
    load, _ = told("Load", "unary", points=[point(1, 0, 0)], vector=[rhino.Vector3d(0, 0, -1)])
    settings = json.loads(canvas.settings(Bench().component("Settings"), tolerance=[1e-8], length=["cm"], floor=True))
    anchor = {"name": "a {0} 0", "home": [0, 0, 0], "target": [0, 0, 1], "axes": "xyz"}
    scene = Scene.read(canvas_scene.compose([springs, load], [anchor], settings, []))
    assert [force.name for force in scene.forces] == ["Springs", "Load"]
    assert (scene.units.length, scene.settings.tolerance, scene.settings.floor is not None) == ("cm", 1e-8, True)


def test_trees_keep_their_paths_and_order(rhino: Any) -> None:
    pairs = [("{0;1}", [1, 2]), ("{0;0}", []), ("{2}", ["x"])]
    found = canvas_geometry.branches(canvas_geometry.to_tree(pairs))
    assert found == [("{0;0}", []), ("{0;1}", [1, 2]), ("{2}", ["x"])]
    assert canvas_geometry.branches([1, None, 2]) == [("{0}", [1, 2])]
    assert canvas_geometry.branches(None) == []


PATHS = st.lists(st.integers(0, 99), min_size=1, max_size=4).map(lambda p: "{" + ";".join(map(str, p)) + "}")


@given(st.dictionaries(PATHS, st.lists(st.integers()), max_size=6))
def test_any_tree_comes_back(branches: dict[str, list[int]]) -> None:
    """With its empty branches, its paths in Grasshopper's order."""
    made = stand_in.Canvas().install()
    try:
        found = canvas_geometry.branches(canvas_geometry.to_tree(branches.items()))
    finally:
        made.remove()
    assert dict(found) == branches
    paths = [tuple(map(int, path.strip("{}").split(";"))) for path, _ in found]
    assert paths == sorted(paths)


ROWS = st.integers(1, 3).flatmap(
    lambda n: st.lists(st.lists(st.floats(allow_nan=False), min_size=n, max_size=n), min_size=1)
)


@given(st.dictionaries(st.text(max_size=3), ROWS | st.text() | st.lists(st.floats(allow_nan=False)) | st.booleans()))
def test_arrays_come_back_from_buffers_bit_for_bit(value: dict[str, Any]) -> None:
    sent = json.loads(json.dumps(canvas_packed.packed(value)))
    assert canvas_packed.unpacked(sent) == value


@given(st.lists(st.lists(st.integers(), max_size=5), min_size=1, max_size=4))
def test_the_longest_list_rules(lists: list[list[int]]) -> None:
    found = canvas.matched(*lists)
    longest = max(map(len, lists))
    for before, after in zip(lists, found, strict=True):
        assert after == (before + [before[-1]] * (longest - len(before)) if before else [])


def test_operations_take_what_the_service_says() -> None:
    found = {name: canvas_discretize.TAKES.get(name, "mesh") for name in OPERATIONS}
    assert found == {name: operation.takes for name, operation in OPERATIONS.items()}


def test_a_sentence_is_said_once_in_a_solution(rhino: Any) -> None:
    ghenv = Bench().component("Springs")
    for run in (1, 2, 3):
        ghenv.Component.RunCount = run
        canvas.warning(ghenv, "Look.")
    assert sentences(ghenv) == ["Look."]
    ghenv.Component.messages = []
    canvas.warning(ghenv, "Look.")
    assert sentences(ghenv) == ["Look."]


def test_stand_ins_go_as_they_came() -> None:
    before = sys.modules.get("Rhino")
    stand_in.Canvas().install().remove()
    assert sys.modules.get("Rhino") is before
