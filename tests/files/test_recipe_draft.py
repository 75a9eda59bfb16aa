"""Drafted recipes: a role for each layer, the recipe of these roles, and what choices change."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rhino3dm as _rhino3dm

from hookean.errors import InputError
from hookean.files.readers import read
from hookean.files.recipe.draft import draft, model_in
from hookean.files.recipe.recipe import understand
from hookean.files.rhino import threedm
from hookean.files.rhino.threedm import NewObject
from hookean.system.system import compile
from hookean.values.mesh import Mesh
from soak import sampled

rhino: Any = _rhino3dm
SQUARE = Mesh(np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]), np.array([[0, 1, 2, 3]]))
BOX = Mesh(
    np.array([[i, j, k] for i in (0.0, 1) for j in (0.0, 1) for k in (0.0, 1)]),
    np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]),
)
LINE = np.array([[0.0, 0, 0], [10, 0, 0]])
POLYLINE = np.array([[0.0, 0, 0], [5, 0, -1], [10, 0, 0]])
SHARED = Path(__file__).parents[3] / "shared" / "data" / "rhino"


def start(scene: Any) -> np.ndarray[Any, Any]:
    """A row for each particle, in an order of its own: where it is, the force on it, and what of it is free."""
    system = compile(scene)
    state = system.start()
    count = len(system.points)
    rows = np.hstack([part[:count] for part in (state.x, system.evaluate(state)[0], state.free)])
    return rows[np.lexsort(np.round(rows[:, :3], 9).T)]


def drafted(model: Any, **choices: Any) -> Any:
    """The scene of a drafted recipe, read as a user's file."""
    return understand(model, json.loads(json.dumps(draft(model, choices).recipe))).built.scene


def same(one: Any, other: Any) -> None:
    """Two scenes have the same particles, forces and supports, but for the rounding of sums in another order."""
    first, second = start(one), start(other)
    assert first.shape == second.shape
    assert np.allclose(first, second, rtol=1e-12, atol=1e-12 * np.abs(first).max())


NAMED = (
    NewObject(POLYLINE, "Cables", user_text={"stiffness": "70", "load": "1, 2, -3"}),
    NewObject(POLYLINE + [0, 1, 0], "Cables"),
    NewObject(LINE + [0, 5, 0], "Structure::springs::upper", user_text={"divide": "4", "rest_length": "2"}),
    NewObject(SQUARE, "NET", user_text={"edges": "warp", "load": "-2"}),
    NewObject(SQUARE, "springs"),
    NewObject(np.array([0.0, 0, 0]), "anchors", "foot", user_text={"axes": "zx"}),
    NewObject(POLYLINE + [0, 1, 0], "supports"),
    NewObject(np.array([5.0, 0, -1]), "loads", user_text={"load": "-20"}),
    NewObject(np.array([[5.0, 0, -1], [5, 3, -1]]), "loads", "wind", user_text={"load": "4"}),
    NewObject(SQUARE, "floor"),
    NewObject(POLYLINE, "geometry", "deck"),
    NewObject(np.zeros(3), "notes"),
)
LOOSE = (NewObject(POLYLINE, "a"), NewObject(LINE + [10, 0, 0], "b"), NewObject(SQUARE, "b"), NewObject(BOX, "c"))


@pytest.mark.parametrize("objects", [NAMED, LOOSE], ids=["named layers", "other layers"])
@pytest.mark.parametrize("unit", ["Meters", "Millimeters"])
def test_a_draft_means_what_the_file_means_without_it(
    draw: Callable[..., Any], objects: Sequence[NewObject], unit: str
) -> None:
    """Also where layers have no known names; and for other units of the recipe up to the factor of their unit."""
    model = draw(*objects, unit=unit)
    plain = understand(model).built.scene
    same(plain, drafted(model))
    assert len(drafted(model).geometry) == len(plain.geometry)
    factors = np.repeat([1e3, 1e-3, 1.0], 3)  # mm/m, kN/N
    other = start(drafted(model, units={"length": "mm", "force": "kN"}))
    assert np.allclose(start(plain) * factors, other, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize(
    ("layer", "role"),
    [
        ("Edge rope 02", "cables"),
        ("01_EdgeCables", "cables"),
        ("Struts::upper", "springs"),
        ("bar", "springs"),
        ("roof", "ignore"),  # of curves: a membrane is a surface
        ("axes", "springs"),  # no layer means anything, so curves are springs
    ],
)
def test_words_of_layers_suggest_roles(draw: Callable[..., Any], layer: str, role: str) -> None:
    [row] = draft(draw(NewObject(LINE, layer))).rows
    assert row.role == role


def test_where_some_layers_have_a_meaning_others_are_left_out(draw: Callable[..., Any]) -> None:
    found = draft(draw(NewObject(LINE, "ropes"), NewObject(LINE, "axes"), NewObject(SQUARE, "Roof")))
    assert [row.role for row in found.rows] == ["cables", "ignore", "net"]


def test_counts_are_those_of_the_model(draw: Callable[..., Any]) -> None:
    """Two squares side by side are one mesh of six vertices; one of them is an end of the cable."""
    beside = Mesh(SQUARE.vertices + [1, 0, 0], SQUARE.faces)
    model = draw(NewObject(POLYLINE, "cables"), NewObject(SQUARE, "roof"), NewObject(beside, "roof"))
    found = draft(model)
    assert [row.becomes for row in found.rows] == [["2 springs", "2 held points"], ["7 springs", "6 held points"]]
    assert (found.particles, found.held) == (8, 7)
    roof = {"layer": "roof", "family": "surfaces", "role": "membrane", "values": {"held": "corners", "load": -1}}
    assert draft(model, {"rows": [roof]}).rows[1].becomes == ["2 faces of membrane", "6 loads", "4 held points"]


def test_selectors_are_layers_where_these_hold_nothing_else(draw: Callable[..., Any]) -> None:
    """A layer with sublayers, or with objects of other roles, is selected by ids."""
    model = draw(
        NewObject(LINE, "cables"), NewObject(SQUARE, "cables"), NewObject(LINE + 1, "a"), NewObject(LINE, "a::b")
    )
    recipe = draft(model).recipe
    assert recipe["forces"][0]["lines"] == "layer:cables"
    rows = [{"layer": name, "family": "curves", "role": "cables"} for name in ("a", "a::b")]
    lines = [table["lines"] for table in draft(model, {"rows": rows}).recipe["forces"]]
    assert lines[0] == "layer:cables" and lines[1].startswith("id:") and lines[2] == "layer:a::b"


def test_values_are_converted_with_the_units(draw: Callable[..., Any]) -> None:
    """Values stay what they are in other units: 50 kN/m are 50 N/mm."""
    model = draw(NewObject(LINE, "cables"))
    row = {"layer": "cables", "family": "curves", "role": "cables", "values": {"stiffness": 50, "load": -2}}
    choices = {"rows": [row], "units": {"length": "mm", "force": "N"}, "values_in": {"length": "m", "force": "kN"}}
    [found] = draft(model, choices).rows
    assert (found.values["stiffness"], found.values["load"]) == (50.0, -2000.0)


def test_single_objects_have_roles_of_their_own(draw: Callable[..., Any]) -> None:
    model = draw(*(NewObject(LINE + [0, i, 0], "cables", str(i)) for i in range(3)))
    ids = [str(entry.item.ids[-1]) for entry in draft(model).rows[0].entries]
    choices = {
        "objects": [
            {"id": ids[0], "role": "ignore"},
            {"id": ids[1], "role": "cables", "values": {"stiffness": 7}},
        ]
    }
    scene = drafted(model, **choices)
    assert [(force.stiffness, len(force.lines)) for force in scene.forces] == [(7.0, 1), (1000.0, 1)]


def test_closed_surfaces_have_a_choice(draw: Callable[..., Any]) -> None:
    """A box has no edge to hold, so it is left out with a sentence; held whole, or with an anchor, it is a model."""
    model = draw(NewObject(BOX, "box"))
    found = draft(model)
    assert "no edge to hold" in found.rows[0].entries[0].why and "give a layer" in found.fault
    row = {"layer": "box", "family": "surfaces", "role": "net"}
    found = draft(model, {"rows": [row]})
    assert found.notes == ["nothing is held"] and not found.fault and found.held == 0
    assert draft(model, {"rows": [{**row, "values": {"held": "all"}}]}).held == 8
    assert draft(draw(NewObject(BOX, "box"), NewObject(np.zeros(3), "foot"))).held == 1


def test_a_fault_names_the_layer(draw: Callable[..., Any]) -> None:
    ring = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 0, 0]])
    row = {"layer": "ring", "family": "curves", "role": "cables", "values": {"held": "loose ends"}}
    assert 'layer "ring": ' in draft(draw(NewObject(ring, "ring")), {"rows": [row]}).fault


def test_one_particle_is_a_fault(draw: Callable[..., Any]) -> None:
    assert "all points become one particle" in draft(draw(NewObject(LINE, "cables")), {"weld_tolerance": 50}).fault


ROW = {"layer": "cables", "family": "curves", "role": "cables"}


@pytest.mark.parametrize(
    ("choices", "pointer", "said"),
    [
        ({"rows": [{**ROW, "role": "net"}]}, "/rows/0/role", "curves may be springs, cables"),
        ({"rows": [{**ROW, "layer": "cable"}]}, "/rows/0/layer", '"cables" (curves)'),
        ({"rows": [{**ROW, "values": {"stiffness": -1}}]}, "/rows/0/values/stiffness", "-1"),
        ({"rows": [{**ROW, "values": {"stifness": 1}}]}, "/rows/0/values/stifness", "stiffness"),
        ({"rows": [{**ROW, "values": {"held": "rim"}}]}, "/rows/0/values/held", "loose ends"),
        ({"rows": [{"layer": "cables"}]}, "/rows/0/family", "required"),
        ({"objects": [{"id": "x", "role": "cables"}]}, "/objects/0/id", '"x"'),
        ({"rows": [ROW, {**ROW, "role": "springs"}]}, "/rows/1", "have a role already, by /rows/0"),
        ({"rows": [{**ROW, "role": "ignore", "values": {"load": 1}}]}, "/rows/0/values", '"ignore" has no values'),
        (
            {"values_in": {"force": "MN"}, "rows": [{**ROW, "values": {"stiffness": 1e11}}]},
            "/rows/0/values/stiffness",
            "1e+17 given",
        ),
        ({"units": {"length": "mile"}}, "/units/length", "mile"),
        ({"weld_tolerance": -1}, "/weld_tolerance", "-1"),
        ([], "/", "object"),
    ],
)
def test_choices_that_cannot_be_are_refused(draw: Callable[..., Any], choices: Any, pointer: str, said: str) -> None:
    with pytest.raises(InputError) as caught:
        draft(draw(NewObject(LINE, "cables")), choices)
    assert caught.value.pointer == pointer and said in caught.value.sentence


@pytest.mark.parametrize(
    ("layer", "text", "said"),
    [
        ("cables", {"stiffness": "stiff"}, 'user text stiffness: "stiff" given'),
        ("cables", {"divide": "0"}, "user text divide"),
        ("cables", {"divide": "90000"}, "user text divide: 90000 given; at most 2000 allowed"),
        ("anchors", {"axes": "q"}, 'user text axes: "q" given'),
        ("loads", {"load": "down"}, 'user text load: "down" given'),
    ],
)
def test_user_text_that_cannot_be_read_is_refused_by_object(
    draw: Callable[..., Any], layer: str, text: dict[str, str], said: str
) -> None:
    with pytest.raises(InputError) as caught:
        draft(draw(NewObject(LINE, layer, "one", user_text=text)))
    assert '"one"' in str(caught.value) and said in str(caught.value)


@pytest.mark.slow
@pytest.mark.parametrize("path", sampled(sorted(SHARED.glob("*.3dm")), 2), ids=lambda path: path.stem)
def test_files_of_others_have_a_draft(path: Path) -> None:
    """The recipe of the draft gives the same model as the file without a recipe. Where that has no model, the draft has
    a fault, or only points, all held, between which lines can be drawn."""
    model = threedm.read(path)
    found = draft(model)
    assert found.to_dict()["rows"]
    understood = understand(model)
    if understood.nothing:
        are_points = {row.family for row in found.rows} == {"points"}
        assert are_points == any("draw lines between them" in note for note in found.notes)
        roles = "give a layer one of these roles"
        assert are_points or roles in found.fault or "without a render" in found.fault
        assert found.held == found.particles and (found.particles > 0) == are_points
    else:
        same(understood.built.scene, understand(model, found.recipe).built.scene)


def test_groups_of_an_obj_file_are_layers_and_anchors_snap() -> None:
    """The head of a mast is drawn sqrt(0.05^2 + 0.1^2) m beside the end of the tie; within its reach it moves there.
    The recipe of the draft gives the same scene when the file is read by it."""
    told = (
        b"o roof\nv 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nf 1 2 3 4\ng ties\nv 2 2 3\nl 3 5\ng masts\nv 2.05 2 3.1\np 6\n"
    )
    rows = [{"layer": "masts", "family": "points", "role": "anchors", "values": {}}]
    model = model_in(told, "roof.obj")
    assert model is not None
    found = draft(model, {"rows": rows})
    assert [row.layer for row in found.rows] == ["roof", "ties", "masts"]
    assert found.rows[2].becomes[1] == "1 of them 0.112 m or more from the nearest particle; raise snap"
    rows[0]["values"] = {"snap": 0.2}
    found = draft(model, {"rows": rows})
    assert found.rows[2].becomes[1] == "1 of them moved to the nearest particle, by 0.112 m at most"
    made = read(told, "roof.obj", (json.dumps(found.recipe), "")).scene
    assert made.anchors[-1].points.tolist() == [[2.0, 2.0, 3.0]]
    assert model_in(b'{"forces": []}', "scene.json") is None


def test_groups_of_an_obj_file_share_the_particles_of_their_seam() -> None:
    """3 x 3 squares: the left column and the rest are groups of their own, with a role each. 16 vertices are 16
    particles, and held is the rim of the whole, 12 of them: the seam between the groups is free. A second skin on the
    same faces, and a group without any rim, change nothing."""
    corners = [(i, j) for i in range(4) for j in range(4)]
    squares = {(i, j): [4 * i + j + 1, 4 * i + 5 + j, 4 * i + 6 + j, 4 * i + 2 + j] for i in range(3) for j in range(3)}
    groups = {"left": [(0, 0), (0, 1), (0, 2)], "right": [p for p in squares if p[0] and p != (1, 1)], "eye": [(1, 1)]}
    groups["lining"] = groups["right"]
    text = "".join(f"v {i} {j} 0\n" for i, j in corners)
    for name, own in groups.items():
        text += f"g {name}\n" + "".join("f " + " ".join(map(str, squares[p])) + "\n" for p in own)
    model = model_in(text.encode(), "roof.obj")
    assert model is not None
    rows = [{"layer": "right", "family": "surfaces", "role": "membrane", "values": {}}]
    found = draft(model, {"rows": rows})
    assert (found.particles, found.held, found.fault) == (16, 12, "")
    scene = understand(model, found.recipe).built.scene
    assert [(force.kind, force.name) for force in scene.forces] == [
        ("springs", "left"),
        ("membrane", "right"),
        ("springs", "eye"),
        ("springs", "lining"),
    ]
    system = compile(scene)
    assert len(system.points) == 16
    free = system.points[system.start().free[:16].all(axis=1), :2]
    assert sorted(map(tuple, free.tolist())) == [(1, 1), (1, 2), (2, 1), (2, 2)]


def test_curves_guide_the_rim(draw: Callable[..., Any]) -> None:
    """A square of 1 m between two rails 0.1 m beside it: each corner is pulled to the nearer rail, by strength times
    distance. Guides alone give nothing to relax."""
    rails = [np.array([[-1.0, -0.1, 0], [2, -0.1, 0]]), np.array([[-1.0, 1.1, 0], [2, 1.1, 0]])]
    model = draw(NewObject(SQUARE, "skin"), *(NewObject(rail, "rails") for rail in rails))
    values = {"strength": 50.0, "pulls": "edges"}
    rows = [
        {"layer": "skin", "family": "surfaces", "role": "net", "values": {"held": "nothing"}},
        {"layer": "rails", "family": "curves", "role": "guide", "values": values},
    ]
    found = draft(model, {"rows": rows})
    assert (found.fault, found.rows[1].becomes) == ("", ["2 guides"])
    assert found.recipe["forces"][1]["points"] == ["rim:layer:skin"]
    scene = understand(model, json.loads(json.dumps(found.recipe))).built.scene
    assert [force.kind for force in scene.forces] == ["springs", "pull_to_curve", "pull_to_curve"]
    pull, first = (start(scene.replaced(forces=forces)) for forces in (scene.forces, scene.forces[:1]))
    assert np.allclose((pull - first)[:, 3:6], [[0, y, 0] for y in (-5, -5, 5, 5)], rtol=1e-12)
    rows[0]["role"], rows[0]["values"] = "ignore", {}
    assert "nothing becomes springs or a membrane" in draft(model, {"rows": rows}).fault


def test_surfaces_guide_all_particles_of_a_layer_or_those_nearest(draw: Callable[..., Any]) -> None:
    """Two squares of 1 m between two level plates: one reaches over their left corners, 0.25 m above, one over the
    right ones, 0.5 m below. A pull is the strength of 10 N/m times the distance to a plate or, 0.875 m beside, to its
    edge."""

    def plate(left: float, right: float, z: float) -> Mesh:
        corners = [[left, -1.0, z], [right, -1.0, z], [right, 4.0, z], [left, 4.0, z]]
        return Mesh(np.array(corners), SQUARE.faces)

    second = Mesh(SQUARE.vertices + [0.0, 1.2, 0.0], SQUARE.faces)
    plates = {"left": plate(-1.0, 0.125, 0.25), "right": plate(0.875, 2.0, -0.5)}
    nets = {"first": SQUARE, "second": second}
    model = draw(*(NewObject(mesh, layer) for layer, mesh in {**nets, **plates}.items()))

    def choices(**values: Any) -> dict[str, Any]:
        of = {**dict.fromkeys(nets, ("net", {"held": "nothing"}))}
        of |= dict.fromkeys(plates, ("guide", {"strength": 10.0, **values}))
        return {"rows": [{"layer": n, "family": "surfaces", "role": r, "values": v} for n, (r, v) in of.items()]}

    def pulls(**values: Any) -> Any:
        found = draft(model, choices(**values))
        assert (found.fault, found.rows[2].becomes, found.rows[3].becomes) == ("", ["1 guide"], ["1 guide"])
        scene = understand(model, json.loads(json.dumps(found.recipe))).built.scene
        pull, first = (start(scene.replaced(forces=forces)) for forces in (scene.forces, scene.forces[:2]))
        return (pull - first)[:, 3:6].round(12).tolist()

    nearest, none, both = [[0, 0, 2.5], [0, 0, -5]], [[0, 0, 0], [0, 0, 0]], [[8.75, 0, -2.5], [-8.75, 0, -2.5]]
    assert pulls(pulls="nearest") == 4 * nearest
    assert pulls(pulls="nearest edges", layer="first") == 2 * nearest + 2 * none
    assert pulls(pulls="all", layer="second") == 2 * none + 2 * both
    assert "finds no object; its layers with visible objects are" in draft(model, choices(layer="third")).fault


def test_a_shell_is_a_membrane_without_prestress_and_its_bending(draw: Callable[..., Any]) -> None:
    model = draw(NewObject(SQUARE, "skin"))
    rows = [{"layer": "skin", "family": "surfaces", "role": "shell", "values": {"bending": 7}}]
    found = draft(model, {"rows": rows})
    kinds = [(table["kind"], table["mesh"]) for table in found.recipe["forces"]]
    assert kinds == [("membrane", "layer:skin"), ("shell", "layer:skin")]
    assert "prestress" not in found.recipe["forces"][0] and found.recipe["forces"][1]["strength"] == 7
    assert found.fault == ""
