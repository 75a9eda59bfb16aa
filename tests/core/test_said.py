"""What has no effect, or another one than it seems, is refused or reported in one sentence with its place."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest

from hookean import InputError, Scene, Simulation, relax

CABLE = {"kind": "springs", "name": "c", "particles": [[0, 1], [1, 2]], "stiffness": 100.0}
LOAD = {"kind": "unary", "name": "l", "particles": [1], "vector": [0, 0, -9]}
ENDS = {"name": "e", "particles": [0, 2]}
SQUARE = {"vertices": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], "faces": [[0, 1, 2], [0, 2, 3]]}


def scene(*more: dict[str, Any], **fields: Any) -> dict[str, Any]:
    """A cable over three particles with a load in the middle, and other forces."""
    row = [[0, 0, 0], [1, 0, 0], [2, 0, 0]]
    return {"particles": row, "forces": [CABLE, LOAD, *more], "anchors": [ENDS], **fields}


def refused(given: dict[str, Any]) -> str:
    with pytest.raises(InputError) as error:
        Scene.read(given)
    return str(error.value)


@pytest.mark.parametrize(
    ("fields", "said"),
    [
        ({"settings": {"tolerance": True}}, "/settings/tolerance: true given; a number expected"),
        ({"settings": {"max_iterations": "50"}}, "/settings/max_iterations: a text given; a number expected"),
        ({"settings": {"drag": False}}, "/settings/drag: false given; a number expected"),
        ({"settings": {"floor": {"restitution": "0"}}}, "/settings/floor/restitution: a text given; a number expected"),
        ({"weld_tolerance": True}, "/weld_tolerance: true given; a number expected"),
        ({"strict": "no"}, "/strict: a text given; true or false expected"),
        ({"strict": 0}, "/strict: 0 given; true or false expected"),
        ({"strict": 10**5000}, "/strict: a number given; true or false expected"),
        (
            {"units": 10**5000},
            "/units: a number of more than 80 digits given; an object of names and values expected",
        ),
        ({"settings": {"floor": {"point": []}}}, "/settings/floor/point: shape [0] given; x, y, z expected"),
    ],
)
def test_a_value_of_another_type_is_not_converted(fields: dict[str, Any], said: str) -> None:
    """A schema that says number or boolean means it: true is no tolerance of 1, "no" is not false."""
    assert refused(scene(**fields)) == said


def test_numbers_of_numpy_are_numbers() -> None:
    """Whole and decimal numbers of numpy, and whole numbers written with a point, are as those of Python."""
    read = Scene.read(
        scene(settings={"max_iterations": np.int64(50), "tolerance": np.float32(0.5), "sub_iterations": 2.0})
    )
    assert (read.settings.max_iterations, read.settings.tolerance, read.settings.sub_iterations) == (50, 0.5, 2)


@pytest.mark.parametrize(
    ("force", "place"),
    [
        ({"kind": "bend", "particles": [[0, 1, 2]], "rest_angle": 90}, "rest_angle"),
        ({"kind": "angle_snap", "particles": [[0, 1, 1, 2]], "multiple": 90}, "multiple"),
    ],
)
def test_an_angle_in_degrees_is_refused(force: dict[str, Any], place: str) -> None:
    """No lines or corners have an angle beyond half a turn; 90 is a right angle in degrees."""
    said = refused(scene(force))
    assert said.startswith(f"/forces/2/{place}: ") and "90 given" in said and "in radians" in said


def test_cutoffs_between_which_there_is_no_length_are_refused() -> None:
    """A spring that works from 5 on and up to 1 never works; those of each spring are compared."""
    crossed = {**CABLE, "lower_cutoff": [0.0, 5.0], "upper_cutoff": 1.0}
    assert refused(scene(crossed)) == "/forces/2/lower_cutoff: 5 given, above the upper cutoff, 1; exchange them"
    Scene.read(scene({**CABLE, "lower_cutoff": 5.0}, {**CABLE, "lower_cutoff": 1.0, "upper_cutoff": 5.0}))


def test_edges_of_no_mesh_are_refused() -> None:
    """Which edges become springs says nothing where springs are given as pairs."""
    assert refused(scene({**CABLE, "edges": "warp"})).startswith("/forces/2/edges: edges are those of a mesh")


def test_an_impulse_before_the_start_is_refused() -> None:
    """A moment before 0 never comes."""
    assert refused(scene({"kind": "impulse", "time": -1.0})).startswith("/forces/2/time: -1 given; at least 0")


@pytest.mark.parametrize(
    "kind", ["planarize", "isothermic", "conical", "developable", "cyclic_quad", "smooth", "tangential_smooth"]
)
def test_a_force_for_which_a_mesh_has_no_element_is_named(kind: str) -> None:
    """Two triangles have no quad and no interior vertex: nothing on them for these forces to act on."""
    given = scene(
        {"kind": "springs", "mesh": "m"}, {"kind": kind, "mesh": "m"}, {"kind": "springs", "mesh": "m"},
        meshes={"m": SQUARE}, settings={"max_iterations": 0},
    )  # fmt: skip
    warned = [said for said in relax(Scene.read(given)).report.warnings if "acts on nothing" in said]
    assert len(warned) == 1 and warned[0].startswith(f'/forces/3: {kind} acts on nothing: mesh "m" has no element')


def test_springs_without_an_element_are_named() -> None:
    """As loads without a place are."""
    given = scene({"kind": "springs", "particles": []}, settings={"max_iterations": 0})
    assert [said for said in relax(Scene.read(given)).report.warnings if "acts on nothing" in said] == [
        "/forces/2: springs acts on nothing: no elements are given; give some, or remove the force"
    ]


@pytest.mark.parametrize(
    ("anchors", "said"),
    [
        ([ENDS, {"particles": [1, 0], "axes": "z", "targets": [[0, 0, 0], [0, 0, 1]]}],
         "/anchors/1: particle 0 is held at z = 1, and by /anchors/0 at 0; the last counts: give it one target"),
        ([{"particles": [2, 0, 0], "targets": [[2, 0, 0], [0, 0, 0], [0, 0, 1]]}],
         "/anchors/0: particle 0 is held at z = 0, and by this anchor, too, at 1; the last counts: give it one target"),
        ([ENDS, ENDS, {"particles": [0], "axes": "xy"}], ""),
        ([{"particles": [0, 2], "axes": "xy"}, {"particles": [0, 2], "axes": "z", "targets": [[9, 9, 1], [9, 9, 1]]}],
         ""),
    ],
    ids=["two", "one", "alike", "other axes"],
)  # fmt: skip
def test_a_particle_that_is_held_in_two_places_is_named(anchors: list[dict[str, Any]], said: str) -> None:
    """Where an axis of a particle has several targets that differ, all but the last are lost."""
    report = relax(Scene.read(scene(anchors=anchors, settings={"max_iterations": 0}))).report
    assert [warning for warning in report.warnings if "the last counts" in warning] == ([said] if said else [])


def test_a_fault_of_a_patched_force_as_a_whole_has_the_place_of_the_force() -> None:
    """The pointer does not end in a slash, which would be a field without a name."""
    with pytest.raises(InputError) as error:
        Simulation(Scene.read(scene())).patch({"forces": {"c": {"stiffness": None}}})
    assert str(error.value).startswith("/forces/c: the stiffness is missing")


@pytest.mark.parametrize(
    ("force", "column"),
    [
        ({**CABLE, "rest_factor": 5e-324}, "strain"),
        ({"kind": "angle_snap", "particles": [[0, 1, 1, 2]], "multiple": 5e-324}, "moment"),
        ({"kind": "length_snap", "particles": [[0, 1]], "multiple": 5e-324}, "force"),
    ],
    ids=lambda force: force["kind"] if isinstance(force, dict) else "",
)
def test_what_is_smaller_than_any_quotient_gives_no_infinite_columns(force: dict[str, Any], column: str) -> None:
    """The smallest number that is more than 0 is allowed where more than 0 is, and divides nothing to infinity."""
    result = relax(Scene.read(scene(force, settings={"max_iterations": 3})))
    assert np.isfinite(result.forces[2][column]).all() and np.isfinite(result.particles).all()


def test_only_the_first_faults_have_a_suggestion() -> None:
    """A scene with thousands of misspelt fields is refused as soon as it would have been read; each has its place."""
    with pytest.raises(InputError) as error:
        Scene.read(scene(*[{**CABLE, "stifness": 1.0} for _ in range(150)]))
    sentences = [fault.sentence for fault in error.value.faults]
    assert len(sentences) == 150 and error.value.faults[-1].pointer == "/forces/151/stifness"
    assert ["did you mean" in said for said in sentences] == [True] * 100 + [False] * 50


def test_names_of_any_length_are_cut_in_sentences() -> None:
    """A field or kind of a million letters is not sent back, nor compared with every known one."""
    for given in (scene({**CABLE, "k" * 10**6: 1}), scene({**CABLE, "kind": "k" * 10**6})):
        assert len(refused(given)) < 2000


@pytest.mark.parametrize("name", ['"\\ud800"', '"a\\udfff"', '"\\udc00\\ud800"'])
def test_half_a_character_is_refused(name: str) -> None:
    """A name with one surrogate of a pair cannot be written to any file; a whole pair is a character."""
    text = json.dumps(scene())
    with pytest.raises(InputError, match="is half of a character"):
        Scene.read(text.replace('"c"', name))
    assert Scene.read(text.replace('"c"', '"\\ud83c\\udfdb"')).forces[0].name == "\U0001f3db"


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"stiffness": "100"}, "/forces/2/stiffness: a text given where numbers are expected"),
        ({"damping": None}, "/forces/2/damping: null given where numbers are expected"),
        ({"stiffness": 10**30}, "/forces/2/stiffness: larger than the limit, 1e+12"),
        ({"stiffness": [1, 10**400]}, "/forces/2/stiffness/1: larger than the limit, 1e+12"),
        ({"edges": True}, "/forces/2/edges: true given; a text expected, one of all, warp, weft, "),
    ],
)
def test_what_was_given_is_named_in_the_words_of_the_file(given: dict[str, Any], said: str) -> None:
    """A text, null, a number beyond all limits: not str, NoneType, or no number."""
    assert refused(scene({**CABLE, **given})).startswith(said)


def test_an_empty_text_is_listed_as_one() -> None:
    """Where "" is one of the texts that are allowed, the sentence shows it."""
    assert 'allowed: "", x, y' in refused(scene(anchors=[{**ENDS, "rotations": "w"}]))


@pytest.mark.soak
def test_a_run_that_a_moment_keeps_from_rest_says_how_it_may_end() -> None:
    """A cantilever whose end moment would roll it up to a circle leaves the plane, where the moment has no energy; held
    in the plane it rolls up, as it does with Newton steps that keep an unstable shape."""
    spec: dict[str, Any] = {
        "particles": [[10.0 * i / 3, 0, 0] for i in range(4)],
        "forces": [
            {"kind": "beam", "particles": [[0, 1], [1, 2], [2, 3]], "E": 1e4, "G": 5e3, "A": 1, "Iy": 0.01, "Iz": 0.01}
            | {"J": 0.02},
            {"kind": "unary", "particles": [3], "vector": [0, 0, 0], "moment": [0, -2e1 * np.pi, 0]},
        ],
        "anchors": [{"particles": [0], "rotations": "xyz"}],
    }
    loose = relax(Scene.read(spec))
    assert str(loose.status) == "stalled" and "A moment keeps its direction and has no energy" in loose.message
    plane = [*spec["anchors"], {"particles": [1, 2, 3], "axes": "y", "rotations": "xz"}]
    assert relax(Scene.read({**spec, "anchors": plane})).converged
    assert relax(Scene.read({**spec, "settings": {"solver": "newton", "allow_unstable": True}})).converged
