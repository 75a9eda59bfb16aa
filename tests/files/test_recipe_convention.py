"""Files without a recipe: layer names, user text, and what is done where nothing is named."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rhino3dm as _rhino3dm

from hookean.errors import InputError
from hookean.files.recipe.recipe import understand
from hookean.files.rhino import threedm
from hookean.files.rhino.plain import plain
from hookean.files.rhino.threedm import Additions, NewLayer, NewObject
from hookean.values.mesh import Mesh

rhino: Any = _rhino3dm
SQUARE = Mesh(np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]), np.array([[0, 1, 2, 3]]))
LINE = np.array([[0.0, 0, 0], [10, 0, 0]])
POLYLINE = np.array([[0.0, 0, 0], [5, 0, -1], [10, 0, 0]])


@pytest.fixture
def draw(tmp_path: Path) -> Callable[..., Any]:
    """Writes objects to a file as a person would draw them, and reads it."""

    def build(*objects: NewObject, layers: Sequence[NewLayer] = ()) -> Any:
        path = tmp_path / "drawn.3dm"
        threedm.write_new(path, Additions(layers, objects), own=False)
        return threedm.read(path)

    return build


def scene_of(model: Any) -> Any:
    return understand(model).built.scene


def test_layers_say_what_is_what(draw: Callable[..., Any]) -> None:
    model = draw(
        NewObject(POLYLINE, "Cables"),
        NewObject(LINE + [0, 5, 0], "Structure::springs::upper"),
        NewObject(SQUARE, "NET"),
        NewObject(np.array([0.0, 0, 0]), "anchors", "foot", user_text={"axes": "zx"}),
        NewObject(LINE[:, [1, 0, 2]], "supports"),
        NewObject(np.array([5.0, 0, -1]), "loads", user_text={"load": "-20"}),
        NewObject(np.array([[5.0, 0, -1], [5, 3, -1]]), "loads", "wind", user_text={"load": "4"}),
        NewObject(SQUARE, "floor"),
        NewObject(POLYLINE, "geometry", "deck"),
        NewObject(np.zeros(3), "notes"),
    )
    understood = understand(model)
    scene = understood.built.scene
    cables, springs, net, load, wind = scene.forces
    assert (cables.name, cables.lines.shape) == ("Cables", (2, 2, 3))
    assert cables.tension_only
    assert (springs.name, springs.rest_factor, springs.lower_cutoff) == ("Structure springs upper", 1.0, 0.0)
    assert (net.rest_factor, net.edges) == (0.0, "all")
    assert load.vector.tolist() == [0, 0, -20] and wind.vector.tolist() == [0, 4, 0]
    assert wind.points.tolist() == [[5, 0, -1]]
    foot, support = scene.anchors
    assert (foot.name, foot.axes, support.axes, len(support.points)) == ("foot", "xz", "xyz", 2)
    assert scene.settings.floor.point.tolist() == [0, 0, 0]
    assert scene.geometry[0].name == "deck"
    assert "layer notes: 1 Point -> left out: its layer has no meaning for hookean" in understood.lines
    assert understood.lines[0].endswith("read by layer names and user text")


def test_user_text_overrides_for_each_object(draw: Callable[..., Any]) -> None:
    model = draw(
        NewObject(LINE, "springs", user_text={"stiffness": "50", "divide": "4", "load": "1, 0, -2.5"}),
        NewObject(LINE + [0, 1, 0], "springs", user_text={"rest_factor": "0.8", "damping": "0"}),
        NewObject(LINE + [0, 2, 0], "springs"),
        NewObject(SQUARE, "membrane", user_text={"edges": "Diagonals", "rest_factor": "1"}),
    )
    first, load, second, third, sheet = scene_of(model).forces
    assert (first.stiffness, len(first.lines), second.rest_factor, second.damping) == (50.0, 4, 0.8, 0.0)
    assert (third.stiffness, third.rest_factor, sheet.edges, sheet.rest_factor) == (1000.0, 1.0, "diagonals", 1.0)
    assert len(load.points) == 5 and load.vector.tolist() == [1, 0, -2.5]


@pytest.mark.parametrize(
    ("key", "text"),
    [
        ("stiffness", "stiff"),
        ("rest_factor", "-1"),
        ("divide", "0"),
        ("divide", "1.5"),
        ("load", "1, 2"),
        ("load", "nan"),
        ("stiffness", "1,000"),  # 1 or 1000
    ],
)
def test_user_text_that_is_no_number_is_told_with_its_object(draw: Callable[..., Any], key: str, text: str) -> None:
    model = draw(NewObject(LINE, "springs", "tie", user_text={key: text}))
    with pytest.raises(InputError, match=rf'"tie" .*user text {key}'):
        understand(model)


def test_a_comma_in_user_text_is_a_decimal_one(draw: Callable[..., Any]) -> None:
    """Where it cannot be one of thousands."""
    model = draw(NewObject(LINE, "springs", user_text={"stiffness": "2,5", "rest_factor": "0,125"}))
    (force,) = scene_of(model).forces
    assert (np.asarray(force.stiffness).item(), np.asarray(force.rest_factor).item()) == (2.5, 0.125)


def test_an_empty_cloud_of_points_holds_nothing(draw: Callable[..., Any], tmp_path: Path) -> None:
    """rhino3dm has no list of its points."""
    model = rhino.File3dm()
    for name in ("springs", "anchors"):
        layer = rhino.Layer()
        layer.Name = name
        model.Layers.Add(layer)
    attributes = rhino.ObjectAttributes()
    attributes.LayerIndex = 1
    model.Objects.AddPointCloud(rhino.PointCloud(), attributes)
    model.Objects.AddPoint(rhino.Point3d(0, 0, 0), attributes)
    attributes.LayerIndex = 0
    model.Objects.AddLine(rhino.Point3d(0, 0, 0), rhino.Point3d(1, 0, 0), attributes)
    assert model.Write(str(tmp_path / "cloud.3dm"), 8)
    read = threedm.read(tmp_path / "cloud.3dm")
    assert scene_of(read).anchors[0].points.tolist() == [[0, 0, 0]]
    clouds = [one["points"] for one in plain(read, None)["objects"] if one["kind"] == "points"]
    assert [len(points) for points in clouds] == [0]


def test_loads_without_a_size_are_left_out(draw: Callable[..., Any]) -> None:
    understood = understand(draw(NewObject(LINE, "springs"), NewObject(LINE[0], "loads")))
    assert len(understood.built.scene.forces) == 1
    assert any('left out: has no user text "load"' in line for line in understood.lines)


def test_where_nothing_is_named_curves_are_springs_held_at_loose_ends(draw: Callable[..., Any]) -> None:
    star = [np.array([[0.0, 0, 0], [x, y, 0]]) for x, y in ((1, 0), (-1, 1), (-1, -1))]
    understood = understand(draw(*(NewObject(line, "Default") for line in star)))
    scene = understood.built.scene
    assert len(scene.forces[0].lines) == 3
    assert sorted(scene.anchors[0].points.tolist()) == [[-1, -1, 0], [-1, 1, 0], [1, 0, 0]]
    assert "no layer has a name" in understood.lines[0] and "loose ends" in understood.lines[0]


def test_where_nothing_is_named_points_are_anchors_and_open_meshes_membranes(draw: Callable[..., Any]) -> None:
    held = scene_of(draw(NewObject(SQUARE, "Default"), NewObject(np.zeros(3), "Default")))
    assert held.anchors[0].points.tolist() == [[0, 0, 0]]
    loose = scene_of(draw(NewObject(SQUARE, "Default")))
    assert (len(loose.anchors[0].points), loose.anchors[0].name) == (4, "naked vertices")
    assert loose.forces[0].rest_factor == 0.0


def test_curved_things_get_the_default_division(draw: Callable[..., Any]) -> None:
    arc = rhino.Arc(rhino.Point3d(0, 0, 0), rhino.Point3d(1, 1, 0), rhino.Point3d(2, 0, 0)).ToNurbsCurve()
    ball = rhino.Sphere(rhino.Point3d(0, 0, 0), 2.0).ToBrep()
    understood = understand(draw(NewObject(arc, "bows"), NewObject(ball, "bows")))
    assert len(understood.built.scene.forces) == 1
    assert len(understood.built.scene.forces[0].lines) == 10
    assert any("closed, so it has no naked vertices" in line for line in understood.lines)


def test_a_file_of_nothing_to_relax_is_told(draw: Callable[..., Any]) -> None:
    understood = understand(draw(NewObject(np.zeros(3), "Default")))
    assert understood.nothing.startswith("has nothing to relax")
    assert understood.lines[-1].endswith(understood.nothing)
    assert understand(draw(NewObject(LINE, "springs"))).nothing == ""


def test_hidden_and_locked_objects_are_counted(draw: Callable[..., Any], tmp_path: Path) -> None:
    model = draw(
        NewObject(LINE, "springs"), NewObject(LINE + [0, 1, 0], "off"), layers=[NewLayer("off", visible=False)]
    )
    lines = understand(model).lines
    assert any("1 hidden (left out)" in line for line in lines)
    file = rhino.File3dm.Read(str(tmp_path / "drawn.3dm"))
    next(layer for layer in file.Layers if layer.Name == "springs").Locked = True
    assert file.Write(str(tmp_path / "locked.3dm"), 8)
    locked = understand(threedm.read(tmp_path / "locked.3dm"))
    assert any("1 of them locked (used like the others)" in line for line in locked.lines)
    assert len(locked.built.scene.forces[0].lines) == 1


def test_what_is_left_out_or_misspelt_is_noted(draw: Callable[..., Any]) -> None:
    model = draw(
        NewObject(LINE, "springs", user_text={"stifness": "50"}),
        NewObject(LINE[0], "anchers"),
        NewObject(LINE[0], "loads"),
        NewObject(LINE[1], "loads"),
    )
    found = understand(model)
    notes = "\n".join(found.notes)
    assert "1 Point on layer anchers left out" in notes and "did you mean anchors?" in notes
    assert '2 Points on layer loads left out: has no user text "load"' in notes
    assert "nothing is marked as an anchor: loose ends are held (2 particles)" in notes
    assert "user text stifness" in notes and "did you mean stiffness?" in notes
    loop = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 0, 0]])
    bare = understand(draw(NewObject(loop, "springs")))
    assert "nothing is held" in bare.notes
    assert "nothing is held" in bare.lines and "nothing is held" in bare.lines[0]
    caught = understand(draw(NewObject(loop, "springs"), NewObject(LINE[0], "floor")))
    assert not [note for note in caught.notes if "held" in note]
    assert understand(draw(NewObject(LINE, "springs"), NewObject(LINE[0], "anchors"))).notes == ()


def test_forces_of_one_layer_have_names_of_their_own(draw: Callable[..., Any]) -> None:
    lines = [NewObject(LINE + [0, i, 0], "ties", user_text={"stiffness": str(9 + i)}) for i in range(3)]
    model = draw(
        NewObject(LINE, "ties::springs"), *(NewObject(o.geometry, "springs", "", None, o.user_text) for o in lines)
    )
    assert [f.name for f in scene_of(model).forces] == ["ties springs", "springs", "springs/2", "springs/3"]
