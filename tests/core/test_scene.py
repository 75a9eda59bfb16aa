"""The scene: one description in Python and in JSON, strict, with a canonical form."""

from __future__ import annotations

import base64
import json

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydantic import ValidationError

from hookean import (
    Anchor,
    Floor,
    Geometry,
    InputError,
    MeshData,
    Patch,
    Scene,
    Script,
    SelfWeight,
    Settings,
    Springs,
    Unary,
    Units,
    relax,
)
from hookean.running.sweep import Sweep
from hookean.values.columns import Model
from hookean.values.faults import faults
from hookean.values.units import METRES, NEWTONS, SECONDS

EXAMPLE = {
    "units": {"length": "m", "force": "N", "time": "s"},
    "weld_tolerance": 0.001,
    "particles": [[0, 0, 0], [2, 0, 0]],
    "masses": 1.0,
    "velocities": None,
    "meshes": {"skin": {"vertices": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], "faces": [[0, 1, 2, 3]]}},
    "forces": [
        {
            "kind": "springs",
            "name": "cable",
            "particles": [[0, 1]],
            "stiffness": 1000,
            "damping": 10,
            "rest_length": None,
            "rest_factor": 1.0,
            "upper_cutoff": 0,
            "lower_cutoff": 0,
            "plasticity": 0,
        },
        {"kind": "unary", "points": [[2, 0, 0]], "vector": [0, 0, -20]},
        {"kind": "shell", "mesh": "skin", "strength": 500, "angle_factor": 1},
    ],
    "anchors": [
        {"name": "left", "particles": [0]},
        {"name": "mast", "points": [[10, 0, 0]], "targets": [[10, 0, 1]], "axes": "xyz"},
    ],
    "geometry": [{"name": "skin", "kind": "mesh", "mesh": "skin"}],
    "settings": {
        "solver": "auto",
        "tolerance": 1e-6,
        "max_iterations": 100000,
        "time_limit": None,
        "time_step": 0.01,
        "sub_iterations": 20,
        "drag": 1.0,
        "floor": None,
    },
}


def changed(path: str, value: object) -> dict[str, object]:
    """The example with one value replaced; `path` is a JSON pointer."""
    scene = json.loads(json.dumps(EXAMPLE))
    *steps, last = path.strip("/").split("/")
    spot = scene
    for step in steps:
        spot = spot[int(step)] if isinstance(spot, list) else spot[step]
    if isinstance(spot, list):
        spot[int(last)] = value
    else:
        spot[last] = value
    return scene


def test_the_documented_scene_is_a_scene_and_json_brings_it_back():
    """Python -> canonical JSON -> Python is the identity, and so is the digest."""
    scene = Scene.read(EXAMPLE)
    again = Scene.read(scene.canonical)
    assert again == scene
    assert again.digest == scene.digest
    assert Scene.read(changed("/forces/0/stiffness", 1001)).digest != scene.digest


def test_order_of_keys_and_spelling_of_numbers_do_not_change_the_digest():
    """The canonical form has sorted keys; 2 and 2.0 are one number."""
    shuffled = dict(reversed(list(EXAMPLE.items())))
    assert Scene.read(json.dumps(shuffled)).digest == Scene.read(EXAMPLE).digest
    assert Scene.read(changed("/particles/1/0", 2.0)).digest == Scene.read(EXAMPLE).digest


@settings(derandomize=True, deadline=None)
@given(st.lists(st.tuples(*[st.floats(-1e6, 1e6)] * 3), min_size=1, max_size=20))
def test_arrays_may_come_as_buffers(points: list[tuple[float, float, float]]):
    """{"dtype", "shape", "base64"}: the same array, to the bit."""
    array = np.array(points)
    buffer = {
        "dtype": "<f8",
        "shape": list(array.shape),
        "base64": base64.b64encode(array.astype("<f8").tobytes()).decode(),
    }
    from_buffer, from_list = Scene.read({"particles": buffer}), Scene.read({"particles": points})
    assert from_buffer.particles.tobytes() == from_list.particles.tobytes()


@pytest.mark.parametrize(
    ("path", "value", "pointer", "says"),
    [
        ("/forces/0/stiffness", -1, "/forces/0/stiffness", "at least 0"),
        ("/forces/0/stiffness", float("nan"), "/forces/0/stiffness", "finite"),
        ("/particles/1/2", float("inf"), "/particles/1/2", "finite"),
        ("/particles/1/2", 1e308, "/particles/1/2", "limit"),
        ("/particles/1", [1, 2], "/particles", "same number"),
        ("/forces/0/particles", [[0, 2]], "/forces/0/particles/0/1", "particle 2 does not exist; the scene gives 2"),
        ("/forces/0/particles", [[0, -1]], "/forces/0/particles/0/1", "counted from 0"),
        ("/forces/0/particles", [[0, 1.5]], "/forces/0/particles/0/1", "whole"),
        ("/forces/0/particles", [[0, True]], "/forces/0/particles/0/1", "whole"),
        ("/particles", {"dtype": [], "shape": [], "base64": ""}, "/particles/dtype", "must be one of"),
        ("/particles", {"dtype": "<f8", "shape": [0] * 99, "base64": ""}, "/particles/shape", "at most three"),
        ("/forces/0/kind", "sprngs", "/forces/0", 'unknown kind "sprngs"; did you mean springs? (known: align'),
        ("/forces/0/kind", "sprngs", "/forces/0", "wind_pressure)"),
        ("/forces/0/stifness", 10, "/forces/0/stifness", 'springs has no field "stifness"; did you mean stiffness?'),
        ("/forces/0/qqq", 10, "/forces/0/qqq", 'springs has no field "qqq"; its fields: name, '),
        (
            "/anchors/0/partikles",
            [0],
            "/anchors/0/partikles",
            'anchor has no field "partikles"; did you mean particles?',
        ),
        ("/settings/tolerence", 1, "/settings/tolerence", 'no field "tolerence"; did you mean tolerance?'),
        ("/settings/floor", {"hight": 1}, "/settings/floor/hight", "floor has no field"),
        ("/meshes/skin/face", [], "/meshes/skin/face", 'mesh has no field "face"; did you mean faces?'),
        ("/ancors", [], "/ancors", 'scene has no field "ancors"; did you mean anchors?'),
        ("/forces/0", {"kind": "unary", "points": []}, "/forces/0/vector", "vector is required: F [force], one vector"),
        ("/forces/0", {"particles": []}, "/forces/0", "kind is required; known: align_faces"),
        ("/forces", 3, "/forces", "3 given; a list expected"),
        ("/forces/2/mesh", "skn", "/forces/2/mesh", "'skin'"),
        ("/forces/0/particles", None, "/forces/0", "exactly one of particles, lines, mesh"),
        ("/meshes/skin/faces/0/3", 4, "/meshes/skin/faces/0/3", "vertex 4 does not exist"),
        ("/anchors/1/targets", [[0, 0, 0], [1, 1, 1]], "/anchors/1/targets", "2 targets for 1"),
        ("/anchors/0/axes", "w", "/anchors/0/axes", "xyz"),
        ("/settings/solver", "magic", "/settings/solver", "relaxation"),
        ("/settings/time_step", 0, "/settings/time_step", "0 given; more than 0 allowed"),
        ("/masses", 0, "/masses", "more than 0"),
        ("/masses", [1, 2, 3], "/masses", "3 masses for 2 particles"),
        ("/units/length", "parsec", "/units/length", '"parsec" given; allowed: mm, cm, dm'),
        ("/units/force", "KN", "/units/force", '"KN" given; did you mean kN? (allowed: mN, N, kN, MN, lbf, kip)'),
    ],
)
def test_a_fault_is_one_sentence_with_its_place(path: str, value: object, pointer: str, says: str):
    """Where, what was given, what is allowed."""
    with pytest.raises(InputError) as caught:
        Scene.read(changed(path, value))
    assert caught.value.pointer == pointer
    assert says in caught.value.sentence
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ('{"particles": [[0, 0, NaN]]}', "NaN"),
        ('{"particles": [], "particles": []}', "twice"),
        ('{"particles": [', "not valid JSON"),
        ("[" * 100_000, "nested"),
        ("[" + "9" * 5000 + "]", "digits"),
        (b"\xff\xfe{}", "UTF-8"),
    ],
)
def test_json_is_read_strictly(text: str | bytes, says: str):
    """No NaN, no repeated keys, no endless nesting, no other encoding."""
    with pytest.raises(InputError, match=says):
        Scene.read(text)


def test_a_scene_does_not_change():
    """Frozen: neither fields nor arrays can be written."""
    scene = Scene.read(EXAMPLE)
    with pytest.raises(ValueError, match="frozen"):
        scene.weld_tolerance = 1.0
    with pytest.raises(ValueError, match="read-only"):
        scene.particles[0, 0] = 5.0


def test_units_are_one_consistent_system():
    """The mass unit follows: force x time^2 / length. N, cm, s: 100 kg."""
    assert Units().mass == "kg"
    assert Units(length="cm").mass == "100 kg"
    assert Units(length="mm", force="kN").of("stiffness") == "kN/mm"
    metres, millimetres = Units(), Units(length="mm", force="kN")
    assert metres.factor("stiffness", millimetres) == pytest.approx(1e-6)
    assert millimetres.factor("force length^2", metres) == pytest.approx(1e-3)


def test_units_are_what_they_are_by_definition():
    """NIST SP 811: an inch is 25.4 mm, twelve a foot, 36 a yard; a pound weighs 0.45359237 kg x 9.80665 m/s^2."""
    pound = 0.45359237 * 9.80665
    metres = {"km": 1000, "m": 1, "dm": 0.1, "cm": 0.01, "mm": 0.001, "in": 0.0254, "ft": 0.3048, "yd": 0.9144}
    newtons = {"MN": 1e6, "kN": 1000, "N": 1, "mN": 0.001, "lbf": pound, "kip": 1000 * pound}
    seconds = {"ms": 0.001, "s": 1, "min": 60}
    for table, defined in ((METRES, metres), (NEWTONS, newtons), (SECONDS, seconds)):
        assert table == pytest.approx(defined, rel=1e-15)


@pytest.mark.parametrize(
    ("dimension", "force", "length", "time"),
    [
        ("", 0, 0, 0), ("angle", 0, 0, 0), ("length", 0, 1, 0), ("force", 1, 0, 0), ("time", 0, 0, 1),
        ("mass", 1, -1, 2), ("moment", 1, 1, 0), ("energy", 1, 1, 0), ("stiffness", 1, -1, 0),
        ("force/length", 1, -1, 0), ("force length", 1, 1, 0), ("force length^2", 1, 2, 0),
        ("force time/length", 1, -1, 1), ("length/time", 0, 1, -1), ("length^2", 0, 2, 0), ("force/length^2", 1, -2, 0),
        ("force/length^3", 1, -3, 0),
    ],
)  # fmt: skip
def test_a_number_changes_its_units_by_the_powers_of_its_dimension(dimension: str, force: int, length: int, time: int):
    """A force is mass x length / time^2, so a mass is force x time^2 / length; exact powers of ten and of two.

    From kN, ft, min to N, in, s, where a number of force^a length^b time^c grows by 1000^a 12^b 60^c.
    """
    ours, theirs = Units(force="kN", length="ft", time="min"), Units(force="N", length="in", time="s")
    assert ours.factor(dimension, theirs) == pytest.approx(1000.0**force * 12.0**length * 60.0**time, rel=1e-14)
    assert theirs.factor(dimension, ours) == pytest.approx(1000.0**-force * 12.0**-length * 60.0**-time, rel=1e-14)


def test_a_unit_is_named_by_what_it_is_made_of():
    """kN, cm, min: a moment in kN cm; the mass unit is 1000 N (60 s)^2 / 0.01 m = 3.6e8 kg."""
    units = Units(force="kN", length="cm", time="min")
    named = {
        "": "", "angle": "rad", "length": "cm", "force": "kN", "time": "min", "mass": "360000000 kg",
        "moment": "kN cm", "energy": "kN cm", "stiffness": "kN/cm", "force length^2": "kN cm^2",
        "force time/length": "kN min/cm", "length/time": "cm/min", "force/length^2": "kN/cm^2",
    }  # fmt: skip
    assert {dimension: units.of(dimension) for dimension in named} == named


def test_one_vector_is_one_value_whatever_its_name():
    """A new force's own columns of type Vector or Vectors: three numbers fit any count of elements."""
    from hookean.forces.unary import Unary
    from hookean.system.weld import Welded, fits
    from hookean.values.columns import Reals, Vector, Vectors

    class Wind(Unary):
        blow: Vectors | None = None
        lee: Vector | None = None
        gusts: Reals = 1.0

    places = Welded(Scene.read({"particles": [[0, 0, 0], [1, 0, 0]]}))
    given = {"particles": [0, 1], "vector": [0, 0, 1]}
    fits(Wind(**given, blow=[1, 0, 0], lee=[0, 1, 0]), "/forces/0", places)
    fits(Wind(**given, blow=[[1, 0, 0], [2, 0, 0]]), "/forces/0", places)
    for wrong in ({"blow": [[1, 0, 0]] * 3}, {"gusts": [1, 2, 3]}):
        with pytest.raises(InputError, match="3 values for 2 elements"):
            fits(Wind(**given, **wrong), "/forces/0", places)


@pytest.mark.parametrize("wrong", [{"particles": [[0, 0, 0]]}, '{"particles": []}', None])
def test_what_is_no_scene_is_told_how_to_become_one(wrong):
    """The JSON that the service takes is one step away from a scene: the sentence says which."""
    with pytest.raises(InputError, match=rf"scene: a Scene is expected, not a {type(wrong).__name__}; .*Scene\.read"):
        relax(wrong)


@pytest.mark.parametrize("bad", [{"stifness": 5}, {"stiffness": -5}, {"particles": [[0, 7]]}])
def test_a_scene_made_by_name_tells_faults_as_one_that_is_read(bad: dict[str, object]) -> None:
    """`Scene(...)` and `Scene.read(...)`: one InputError, the same place and sentence."""
    spec = {"particles": [[0, 0, 0], [1, 0, 0]], "forces": [{"kind": "springs", "particles": [[0, 1]], **bad}]}
    with pytest.raises(InputError) as read:
        Scene.read(spec)
    with pytest.raises(InputError) as made:
        Scene(**spec)  # type: ignore[arg-type]
    assert str(made.value) == str(read.value) and made.value.pointer.startswith("/forces/0")


MODELS = {
    Springs: ({"particles": [[0, 1]]}, {"stiffness": -1}, "/stiffness", "-1 given; at least 0 allowed"),
    Unary: ({"particles": [0], "vector": [0, 0, 1]}, {"vector": [0, 0]}, "/vector", "shape [2] given"),
    SelfWeight: ({"total": 1}, {"per_length": 1}, "/", "give exactly one of total, per_length, material"),
    Floor: ({}, {"restitution": 2}, "/restitution", "2 given; at most 1 allowed"),
    Anchor: ({"particles": [0]}, {"axes": "zx"}, "/axes", '"zx" given'),
    Settings: ({}, {"tolerance": "small"}, "/tolerance", "a number expected"),
    MeshData: ({"vertices": [[0, 0, 0]], "faces": []}, {"faces": [[0, 0, 1]]}, "/faces/0/2", "vertex 1 does not exist"),
    Geometry: ({"kind": "points", "points": []}, {"degree": 0}, "/degree", "0 given; at least 1 allowed"),
    Units: ({}, {"length": "mile"}, "/length", '"mile" given'),
    Patch: ({}, {"pin": [{"axes": "x"}]}, "/pin/0", "give exactly one of particles, points"),
    Script: ({}, {"anchors": [{}]}, "/anchors/0/anchor", "anchor is required"),
    Sweep: ({"patches": [{}]}, {"mode": "both"}, "/mode", '"both" given'),
    Scene: ({}, {"forces": [{"kind": "springs", "mesh": "m"}]}, "/forces/0/mesh", "mesh 'm' does not exist"),
}  # fmt: skip


@pytest.mark.parametrize("model", MODELS, ids=lambda model: model.__name__)
def test_every_class_raises_the_same_error(model: type[Model]) -> None:
    """Made by name, and copied with other values: pointer and sentence; a misspelt name is refused in both."""
    right, change, pointer, sentence = MODELS[model]
    made = model(**right)
    for make in (lambda more: model(**{**right, **more}), lambda more: made.model_copy(update=more)):
        with pytest.raises(InputError) as caught:
            make(change)
        assert caught.value.pointer == pointer and sentence in caught.value.sentence
        with pytest.raises(InputError, match=r"^/nam: \w+ has no field \"nam\"; ") as caught:
            make({"nam": 1})
        assert caught.value.__cause__ is None and caught.value.__suppress_context__
    assert made.model_copy(update={}) == made == made.model_copy(deep=True)


def test_a_copy_is_checked_as_a_whole_and_keeps_the_rest() -> None:
    """References are those of the copy; unchanged parts are the same objects, changed arrays frozen."""
    scene = Scene.read(EXAMPLE)
    with pytest.raises(InputError, match=r"^/forces/0/particles/0/1: particle 1 does not exist; the scene gives 1"):
        scene.model_copy(update={"particles": [[0, 0, 0]]})
    copied = scene.model_copy(update={"particles": [[0, 0, 0], [3, 0, 0]], "settings": {"drag": 2}})
    assert copied.forces[0] is scene.forces[0] and copied.settings.drag == 2 and scene.settings.drag == 1
    assert not copied.particles.flags.writeable and copied.particles[1, 0] == 3 and scene.particles[1, 0] == 2
    assert copied.model_fields_set == scene.model_fields_set
    assert copied == Scene.read({**EXAMPLE, "particles": [[0, 0, 0], [3, 0, 0]], "settings": {"drag": 2}})
    assert scene.model_copy(update={"strict": False}).model_copy(update={"strict": True}).digest == scene.digest


def test_several_faults_are_told_apart() -> None:
    with pytest.raises(InputError) as caught:
        Springs(particles=[[0, 1]], stiffness=-1, damping="much", kind="spring")
    assert [fault.pointer for fault in caught.value.faults] == ["/kind", "/stiffness", "/damping"]
    assert caught.value.sentence == f"{caught.value.faults[0].sentence} (and 2 more faults)"
    with pytest.raises(InputError) as caught:
        Springs()
    assert caught.value.faults == (caught.value,)


def test_only_what_a_person_makes_raises_it() -> None:
    """Inside of pydantic's own reading the faults stay its own, all of them, whatever is nested in what."""
    with pytest.raises(ValidationError) as caught:
        Scene.model_validate({"settings": {"drag": -1}, "forces": [{"kind": "springs", "stiffness": -1}]})
    assert [fault.pointer for fault in faults(caught.value)] == ["/forces/0/stiffness", "/settings/drag"]
