"""Recipes: selectors, divisions, units, and what is said where they do not fit."""

from __future__ import annotations

import copy
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rhino3dm as _rhino3dm

from hookean.errors import InputError
from hookean.files.recipe.recipe import understand
from hookean.files.recipe.select import terms
from hookean.files.rhino import threedm
from hookean.files.rhino.threedm import NewLayer, NewObject, Points
from hookean.scene.text import parse_tables
from hookean.values.mesh import Mesh

rhino: Any = _rhino3dm
SQUARE = Mesh(
    np.array([[i, j, 0.0] for i in range(3) for j in range(3)]),
    np.array([[0, 3, 4, 1], [1, 4, 5, 2], [3, 6, 7, 4], [4, 7, 8, 5]]),
)
LINE = np.array([[0.0, 0, 0], [10, 0, 0]])


def springs(**table: Any) -> dict[str, Any]:
    return {"forces": [{"kind": "springs", **table}]}


def scene_of(model: Any, recipe: dict[str, Any]) -> Any:
    return understand(model, recipe).built.scene


def refused(model: Any, recipe: dict[str, Any]) -> InputError:
    with pytest.raises(InputError) as caught:
        understand(model, recipe)
    return caught.value


@pytest.mark.parametrize(
    ("selector", "count"),
    [
        ("layer:cables", 3),  # a name in any case, its sublayer too
        ("layer:CABLES::upper", 1),
        ("layer:upper", 1),
        ("layer:cab*", 3),
        ("layer:cables, layer:struts", 4),
        (["layer:upper", "name:tie"], 2),
        ("name:tie", 1),
        ("name:t*", 2),
        ("text:EA=1200 kN", 1),
        ("text:ea", 2),
        ("text:EA=*9*", 1),
        ("*", 4),
    ],
)
def test_selectors_find_by_layer_name_text_and_wildcards(draw: Callable[..., Any], selector: Any, count: int) -> None:
    model = draw(
        NewObject(LINE, "cables", "tie", user_text={"EA": "1200 kN"}),
        NewObject(LINE + [0, 1, 0], "cables", "t2", user_text={"EA": "900 kN"}),
        NewObject(LINE + [0, 2, 0], "cables::upper"),
        NewObject(LINE + [0, 3, 0], "struts", "a, b"),
    )
    assert len(scene_of(model, springs(lines=selector)).forces[0].lines) == count


def test_ids_and_names_with_commas(draw: Callable[..., Any]) -> None:
    model = draw(NewObject(LINE, "a", "left, lower"), NewObject(LINE + [0, 1, 0], "a", "right"))
    wanted = model.objects[1].id
    assert scene_of(model, springs(lines=f"id:{wanted}")).forces[0].lines.tolist() == (LINE + [0, 1, 0])[None].tolist()
    assert len(scene_of(model, springs(lines="name:left, lower")).forces[0].lines) == 1
    assert len(scene_of(model, springs(lines="name:left, lower, name:right")).forces[0].lines) == 2
    assert [str(t) for t in terms("ends:name:a, b, naked:*, layer:c", "")] == ["ends:name:a, b", "naked:*", "layer:c"]


@pytest.mark.parametrize(
    ("selector", "said"),
    [
        ("layer:ropes", '"cables"'),
        ("name:rope", '"tie"'),
        ("text:colour", '"EA"'),
        ("id:nonsense", "not an object id"),
        ("cables", "not a selector"),
        ("colour:red", "not a selector"),
        ("ends:layer:cables", "allowed in points = only"),
        ("layer:shade", "hidden"),
        ("layer:dots", "lines and curves"),
    ],
)
def test_what_is_not_found_is_told_with_what_the_file_has(draw: Callable[..., Any], selector: Any, said: str) -> None:
    model = draw(
        NewObject(LINE, "cables", "tie", user_text={"EA": "1"}),
        NewObject(LINE, "shade"),
        NewObject(np.zeros(3), "dots"),
        layers=[NewLayer("shade", visible=False)],
    )
    error = refused(model, springs(lines=selector))
    assert said in error.sentence
    assert error.pointer == "/forces/0/lines"


def test_hidden_objects_take_part_when_asked(draw: Callable[..., Any]) -> None:
    model = draw(
        NewObject(LINE, "cables"), NewObject(LINE + [0, 1, 0], "shade"), layers=[NewLayer("shade", visible=False)]
    )
    shown = understand(model, springs(lines="*"))
    assert len(shown.built.scene.forces[0].lines) == 1
    assert any('hidden, left out: 1 LineCurve on layer "shade"' in line for line in shown.lines)
    assert len(scene_of(model, {"hidden": True, **springs(lines="*")}).forces[0].lines) == 2
    assert refused(model, {"hidden": "yes", **springs(lines="*")}).pointer == "/hidden"


def test_lines_are_segments_or_equal_arcs(draw: Callable[..., Any]) -> None:
    polyline = np.array([[0.0, 0, 0], [4, 0, 0], [4, 3, 0]])
    arc = rhino.Arc(rhino.Point3d(0, 0, 0), rhino.Point3d(1, 1, 0), rhino.Point3d(2, 0, 0)).ToNurbsCurve()
    model = draw(NewObject(polyline, "poly"), NewObject(arc, "arc"))
    assert scene_of(model, springs(lines="layer:poly")).forces[0].lines.tolist() == [
        [[0, 0, 0], [4, 0, 0]],
        [[4, 0, 0], [4, 3, 0]],
    ]
    cut = scene_of(model, springs(lines="layer:arc", divide=6)).forces[0].lines
    lengths = np.linalg.norm(cut[:, 1] - cut[:, 0], axis=1)
    assert np.allclose(lengths, 2 * np.sin(np.pi / 12), atol=1e-12)
    error = refused(model, springs(lines="layer:arc"))
    assert "divide = N" in error.sentence and "curved" in error.sentence
    for wrong in (0, -1, 2.5, "many", [1, 2, 3], True):
        assert "whole number" in refused(model, springs(lines="layer:arc", divide=wrong)).sentence


def test_a_division_holds_for_the_tables_that_do_not_divide(draw: Callable[..., Any]) -> None:
    model = draw(NewObject(LINE, "cable"))
    recipe = {
        "forces": [
            {"kind": "unary", "points": "inner:layer:cable", "vector": [0, 0, -1]},
            {"kind": "springs", "lines": "layer:cable", "divide": 5},
        ],
        "anchors": [{"points": "ends:layer:cable"}, {"points": "layer:cable", "divide": 2}],
    }
    scene = scene_of(model, recipe)
    assert scene.forces[0].points[:, 0].tolist() == [2, 4, 6, 8]
    assert scene.anchors[0].points[:, 0].tolist() == [0, 10]
    assert scene.anchors[1].points[:, 0].tolist() == [0, 5, 10]
    own = draw(NewObject(LINE, "cable", user_text={"divide": "4"}))
    assert len(scene_of(own, springs(lines="*")).forces[0].lines) == 4


def test_points_of_meshes_and_surfaces(draw: Callable[..., Any]) -> None:
    model = draw(NewObject(SQUARE, "net"), NewObject(Points(np.eye(3)), "dots"), NewObject(np.ones(3), "dots"))

    def points(selector: str, **more: Any) -> int:
        recipe = {**springs(mesh="layer:net"), "anchors": [{"points": selector, **more}]}
        return len(scene_of(model, recipe).anchors[0].points)

    assert points("naked:layer:net") == 8
    assert points("corners:layer:net") == 4
    assert points("inner:layer:net") == 1
    assert points("vertices:layer:net") == 9
    assert points("layer:dots") == 4
    assert points("corners:layer:net, layer:dots, corners:layer:net") == 8  # one and the same point counts once
    error = refused(model, {"anchors": [{"points": "layer:net"}]})
    assert "naked:" in error.sentence


def test_loose_ends_are_those_that_no_spring_meets(draw: Callable[..., Any]) -> None:
    """Three lines from (0, 0, 0) and a ring have three loose ends, the far ones. A line that goes on from one of them
    makes its end loose no more only where it is of a force, too."""
    rays = [NewObject(np.array([[0.0, 0, 0], np.eye(3)[i]]), "rays") for i in range(3)]
    ring = NewObject(np.array([[5.0, 0, 0], [6, 0, 0], [6, 1, 0], [5, 0, 0]]), "rays", "ring")
    over = NewObject(np.array([[1.0, 0, 0], [2, 0, 0]]), "axes")
    model = draw(*rays, ring, over)

    def held(lines: str, points: str = "loose:layer:rays") -> Any:
        return scene_of(model, {**springs(lines=lines), "anchors": [{"points": points}]}).anchors[0].points.tolist()

    assert held("layer:rays") == np.eye(3).tolist()
    assert held("layer:rays", "loose:layer:rays, loose:layer:axes") == [*np.eye(3).tolist(), [2, 0, 0]]
    assert held("*") == np.eye(3).tolist()[1:]
    assert held("*", "loose:*") == [*np.eye(3).tolist()[1:], [2, 0, 0]]
    error = refused(model, {**springs(lines="*"), "anchors": [{"points": "loose:name:ring"}]})
    assert "whose ends all meet" in error.sentence


def test_meshes_that_meet_are_one(draw: Callable[..., Any]) -> None:
    beside = Mesh(SQUARE.vertices + [2, 0, 0], SQUARE.faces)
    model = draw(NewObject(SQUARE, "net", "a"), NewObject(beside, "net", "b"))
    recipe = {
        "forces": [
            {"kind": "springs", "mesh": "layer:net", "edges": "warp"},
            {"kind": "springs", "mesh": "layer:net", "edges": "weft"},
        ],
        "anchors": [{"points": "naked:layer:net"}],
    }
    scene = scene_of(model, recipe)
    assert len(scene.meshes) == 1
    assert len(scene.anchors[0].points) == 12  # of 15 vertices; the seam is inside


def test_a_surface_needs_a_division(draw: Callable[..., Any]) -> None:
    sphere = rhino.Sphere(rhino.Point3d(0, 0, 0), 2.0).ToBrep()
    model = draw(NewObject(sphere, "skin", "ball"))
    assert "divide = [u, v]" in refused(model, springs(mesh="layer:skin")).sentence
    scene = scene_of(model, springs(mesh="layer:skin", divide_u=8, divide_v=4))
    (mesh,) = scene.meshes.values()
    assert len(mesh.vertices) == 8 * 3 + 2
    assert np.allclose(np.linalg.norm(mesh.vertices, axis=1), 2.0)
    assert refused(model, springs(mesh="layer:skin", divide_u=8)).pointer == "/forces/0"
    error = refused(model, {**springs(mesh="layer:skin", divide=[8, 4]), "anchors": [{"points": "naked:*"}]})
    assert "closed" in error.sentence


def test_geometry_rides_along(draw: Callable[..., Any]) -> None:
    arc = rhino.Arc(rhino.Point3d(0, 0, 0), rhino.Point3d(1, 1, 0), rhino.Point3d(2, 0, 0)).ToNurbsCurve()
    model = draw(NewObject(LINE, "cable"), NewObject(LINE, "deck", "edge"), NewObject(arc, "bow"))
    recipe = {
        **springs(lines="layer:cable"),
        "geometry": [
            {"kind": "polyline", "points": "layer:deck"},
            {"kind": "curve", "points": "layer:bow"},
            {"kind": "lines", "lines": "layer:deck"},
        ],
    }
    understood = understand(model, recipe)
    assert any("geometry[2] lines that is carried along: 1 line " in line for line in understood.lines)
    assert any("carried curve" in line for line in understood.lines)
    deck, bow, lines = understood.built.scene.geometry
    assert (deck.name, deck.points.tolist()) == ("edge", LINE.tolist())
    assert (bow.degree, len(bow.points), len(bow.knots)) == (arc.Degree, len(arc.Points), len(arc.Knots))
    assert lines.lines.tolist() == LINE[None].tolist()


def test_tension_only_is_slack_below_the_rest_length(draw: Callable[..., Any]) -> None:
    model = draw(NewObject(LINE, "cable"), NewObject(SQUARE, "net"))
    force = scene_of(model, springs(lines="*", divide=4, rest_factor=0.9, tension_only=True)).forces[0]
    assert force.tension_only and np.allclose(force.rest_factor, 0.9)
    assert scene_of(model, springs(mesh="*", divide=[1, 1], tension_only=True)).forces[0].tension_only


def test_a_membrane_has_a_cloth_of_the_recipe_and_its_warp_along_lines_of_the_file(draw: Callable[..., Any]) -> None:
    model = draw(NewObject(LINE, "warp"), NewObject(SQUARE, "net"))
    cloth = {"warp_stiffness": 600.0, "weft_stiffness": 500.0, "shear_stiffness": 20.0, "poisson": 0.3}
    table = {"kind": "membrane", "mesh": "layer:net", "material": "cloth", "warp_lines": "layer:warp"}
    recipe = {"materials": {"cloth": cloth}, "sections": {"tube": {"area": 1.0}}, "forces": [table]}
    scene = scene_of(model, {"units": {"length": "m", "force": "kN"}, **recipe})
    (membrane,) = scene.forces
    assert membrane.warp_lines.tolist() == [LINE.tolist()] and membrane.mesh in scene.meshes
    assert scene.materials["cloth"].weft_stiffness == 500.0 and scene.sections["tube"].area == 1.0
    assert "finds" in refused(model, {**recipe, "forces": [{**table, "warp_lines": "layer:net"}]}).sentence


@pytest.mark.parametrize(("unit", "factor"), [("Millimeters", 1e-3), ("Inches", 0.0254), ("Miles", 1609.344)])
def test_lengths_of_the_file_become_those_of_the_recipe(draw: Callable[..., Any], unit: str, factor: float) -> None:
    model = draw(NewObject(LINE, "cable"), unit=unit)
    understood = understand(model, {"units": {"length": "m", "force": "kN"}, **springs(lines="*")})
    scene = understood.built.scene
    assert scene.forces[0].lines[0, 1, 0] == pytest.approx(10 * factor, rel=1e-15)
    assert (scene.units.length, scene.units.force) == ("m", "kN")
    assert scene.weld_tolerance == pytest.approx(0.001 * factor)
    assert any("solved in m" in line for line in understood.lines)


def test_files_without_known_units_are_solved_with_a_sentence(draw: Callable[..., Any]) -> None:
    miles = understand(draw(NewObject(LINE, "cable"), unit="Miles"), springs(lines="*"))
    assert miles.built.scene.units.length == "m" and any("miles" in line for line in miles.lines)
    own = understand(draw(NewObject(LINE, "cable"), unit="Feet"), springs(lines="*"))
    assert own.built.scene.units.length == "ft"
    assert own.built.scene.forces[0].lines.tolist() == LINE[None].tolist()
    error = refused(draw(NewObject(LINE, "cable")), {"units": {"length": "cubit"}, **springs(lines="*")})
    assert error.pointer == "/units/length"


def test_a_file_without_units_takes_those_of_the_recipe(tmp_path: Path) -> None:
    file = rhino.File3dm()
    file.Settings.ModelUnitSystem = getattr(rhino.UnitSystem, "None")
    file.Objects.AddLine(rhino.Point3d(0, 0, 0), rhino.Point3d(10, 0, 0))
    assert file.Write(str(tmp_path / "none.3dm"), 8)
    understood = understand(threedm.read(tmp_path / "none.3dm"), {"units": {"length": "cm"}, **springs(lines="*")})
    assert understood.built.scene.forces[0].lines[0, 1, 0] == 10.0
    assert any("read as cm" in line for line in understood.lines)


def test_recipes_are_toml_or_json() -> None:
    toml = parse_tables('[[forces]]\nkind = "springs"\nlines = "*"\n')
    assert parse_tables('{"forces": [{"kind": "springs", "lines": "*"}]}') == toml
    for text in ("a = " + "[" * 5000, "a = " + "9" * 5000):
        with pytest.raises(InputError, match=r"bridge.toml: (nested too deeply|a whole number with too many)"):
            parse_tables(text, "bridge.toml")
    with pytest.raises(InputError, match=r"bridge.toml: not valid TOML"):
        parse_tables("[[forces", "bridge.toml")
    with pytest.raises(InputError, match="not valid JSON"):
        parse_tables("{,}")


def test_faults_of_the_scene_keep_their_place(draw: Callable[..., Any]) -> None:
    model = draw(NewObject(LINE, "cable"))
    assert refused(model, {**springs(lines="*"), "colour": "red"}).pointer == "/colour"
    assert refused(model, springs(lines="*", stiffness=-1)).pointer == "/forces/0/stiffness"
    assert refused(model, {"forces": "springs"}).pointer == "/forces"
    assert refused(model, {"forces": [{"kind": "rope", "lines": "*"}]}).pointer.startswith("/forces/0")


def test_blocks_are_expanded_and_go_by_the_id_of_their_instance(tmp_path: Path) -> None:
    file = rhino.File3dm()
    file.Settings.ModelUnitSystem = rhino.UnitSystem.Meters
    line = rhino.LineCurve(rhino.Point3d(0, 0, 0), rhino.Point3d(1, 0, 0))
    file.InstanceDefinitions.Add("bay", "", "", "", rhino.Point3d(0, 0, 0), (line,), (rhino.ObjectAttributes(),))
    for x in (0, 1):
        file.Objects.AddInstanceObject(
            rhino.InstanceReference(file.InstanceDefinitions[0].Id, rhino.Transform.Translation(x, 0, 0))
        )
    assert file.Write(str(tmp_path / "blocks.3dm"), 8)
    model = threedm.read(tmp_path / "blocks.3dm")
    understood = understand(model, springs(lines="*"))
    assert understood.built.scene.forces[0].lines[:, 0, 0].tolist() == [0, 1]
    assert [i.id for i in understood.built.forces[0].items] == [o.id for o in model.objects]
    assert any("2 block instances (expanded)" in line for line in understood.lines)
    assert len(scene_of(model, springs(lines=f"id:{model.objects[1].id}")).forces[0].lines) == 1


FULL: dict[str, Any] = {
    "hidden": False,
    "weld_tolerance": 0.001,
    "units": {"length": "m", "force": "N"},
    "forces": [
        {"kind": "springs", "lines": "layer:cable", "divide": 3, "tension_only": True, "rest_factor": 1.0},
        {"kind": "springs", "mesh": "layer:net", "divide": [2, 2], "edges": "all"},
        {"kind": "unary", "points": "vertices:layer:cable", "vector": [0, 0, -1]},
    ],
    "anchors": [{"points": "ends:layer:cable", "axes": "xyz"}],
    "geometry": [{"kind": "curve", "points": "layer:cable"}, {"kind": "mesh", "mesh": "layer:net"}],
    "settings": {"tolerance": 1e-6},
    "meshes": {"a": {"vertices": [[0, 0, 0], [1, 0, 0], [1, 1, 0]], "faces": [[0, 1, 2]]}},
}
ODD = [None, True, -1, 1e300, float("nan"), "", "*", "naked:*", "layer:", "a", [], ["*", 3], [[0, 0, 0]], {"a": 1}]


def _places(value: Any, at: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    inner = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    return [at, *(place for key, item in inner for place in _places(item, (*at, key)))]


@pytest.mark.soak
def test_no_odd_value_anywhere_gets_past_as_anything_but_a_sentence(draw: Callable[..., Any]) -> None:
    model = draw(NewObject(LINE, "cable"), NewObject(SQUARE, "net"))
    understand(model, FULL)
    refusals = 0
    for place in _places(FULL)[1:]:
        for odd in ODD:
            recipe = copy.deepcopy(FULL)
            table: Any = recipe
            for key in place[:-1]:
                table = table[key]
            table[place[-1]] = odd
            try:
                understand(model, recipe)
            except InputError as error:
                refusals += 1
                assert error.sentence and "\n" not in str(error), place
    assert refusals > 500


def test_points_may_be_asked_to_lie_on_curves(draw: Callable[..., Any]) -> None:
    edge = np.array([[0.0, 0, 0], [0, 2, 0]])
    model = draw(NewObject(SQUARE, "net"), NewObject(edge, "beam"), NewObject(edge + [9, 0, 0], "far"))

    def points(selector: str, on: Any) -> Any:
        recipe = {**springs(mesh="layer:net"), "anchors": [{"points": selector, "on": on}]}
        return scene_of(model, recipe).anchors[0].points.tolist()

    assert points("vertices:layer:net", "layer:beam") == [[0, 0, 0], [0, 1, 0], [0, 2, 0]]
    assert points("naked:layer:net", ["layer:beam", "layer:far"]) == [[0, 0, 0], [0, 1, 0], [0, 2, 0]]
    net = springs(mesh="layer:net")
    error = refused(model, {**net, "anchors": [{"points": "vertices:layer:net", "on": "layer:far"}]})
    assert error.pointer == "/anchors/0/on" and "the nearest is 7 away" in error.sentence
    for wrong in ("layer:net", "ends:layer:beam", "layer:rope", 3):
        assert refused(model, {**net, "anchors": [{"points": "vertices:layer:net", "on": wrong}]}).pointer.endswith(
            "on"
        )
    assert refused(model, springs(mesh="layer:net", on="layer:beam")).pointer == "/forces/0/on"


def test_a_pull_names_its_curve_and_several_share_the_points(draw: Callable[..., Any]) -> None:
    edge = np.array([[0.0, 0, 0], [0, 2, 0]])
    ring = rhino.Circle(rhino.Point3d(1, 1, 0), 5.0).ToNurbsCurve()
    model = draw(
        NewObject(SQUARE, "net"),
        NewObject(edge, "beams"),
        NewObject(edge + [2, 0, 0], "beams"),
        NewObject(ring, "ring"),
    )

    def pulls(**table: Any) -> dict[str, Any]:
        pull = {"kind": "pull_to_curve", "points": "naked:layer:net", **table}
        net = {"kind": "springs", "mesh": "layer:net"}
        return {"forces": [pull, net]}

    one = scene_of(model, pulls(curve="layer:ring", curve_divide=100)).forces[0]
    assert one.closed and len(one.points) == 8 and len(one.curve) >= 100
    assert np.allclose(np.linalg.norm(one.curve - [1, 1, 0], axis=1), 5.0, rtol=1e-14)
    # a point between two beams goes to the first of those equally near; tables after it keep their numbers
    first, net, second = scene_of(model, pulls(curve="layer:beams", name="edges")).forces
    assert (first.name, net.kind, second.name) == ("edges", "springs", "edges/2")
    assert first.points[:, 0].max() == 1 and second.points.tolist() == [[2, 0, 0], [2, 1, 0], [2, 2, 0]]
    assert first.curve.tolist() == edge.tolist() and second.curve.tolist() == (edge + [2, 0, 0]).tolist()
    understood = understand(model, pulls(curve="layer:beams", name="edges"))
    assert any('layer beams: 2 LineCurves -> curve of pull_to_curve "edges"' in line for line in understood.lines)
    assert "curve_divide = N" in refused(model, pulls(curve="layer:ring")).sentence
    assert refused(model, pulls(curve="layer:net")).pointer == "/forces/0/curve"
    mesh = {"kind": "pull_to_curve", "mesh": "layer:net", "curve": "layer:beams"}
    assert "points" in refused(model, {"forces": [mesh]}).sentence
    assert refused(model, pulls(curve="layer:beams", strength=[1.0] * 8)).pointer == "/forces/0/strength"
