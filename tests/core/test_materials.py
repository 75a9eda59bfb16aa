"""Materials, sections, and springs that are made of them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean import InputError, Material, Scene, Section, Simulation, Units, relax
from hookean.forces.elastic import section_columns
from hookean.system.system import compile
from hookean.values.materials import converted, gravity, known

EPS = float(np.finfo(float).eps)
PI = np.pi


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ({"shape": "rod", "diameter": 2.0}, {"area": PI, "Iy": PI / 4, "Iz": PI / 4, "J": PI / 2, "Wy": PI / 4}),
        (
            {"shape": "tube", "diameter": 2.0, "thickness": 0.5},
            {"area": 0.75 * PI, "Iy": PI / 4 * 15 / 16, "J": PI / 2 * 15 / 16, "Wz": PI / 4 * 15 / 16},
        ),
        (
            {"shape": "rectangle", "width": 2.0, "height": 3.0},
            {"area": 6.0, "Iy": 4.5, "Iz": 2.0, "Wy": 3.0, "Wz": 2.0},
        ),
        (
            {"shape": "I", "width": 4.0, "height": 6.0, "flange_thickness": 1.0, "web_thickness": 0.5},
            # the flanges by Steiner's rule: 2 (b t^3 / 12 + b t 2.5^2) + 0.5 x 4^3 / 12
            {"area": 10.0, "Iy": 2 * (4 / 12 + 25.0) + 32 / 12, "Iz": 2 * 64 / 12 + 0.5 / 12, "J": (8.0 + 0.5) / 3},
        ),
        ({"shape": "rope", "diameter": 2.0, "fill_factor": 0.75}, {"area": 0.75 * PI}),
    ],
    ids=lambda value: value.get("shape", "") if isinstance(value, dict) else "",
)
def test_a_shape_has_its_closed_form(given: Any, expected: dict[str, float]) -> None:
    """Area and second moments of circles, rings, rectangles and I-sections; J of thin open walls, sum b t^3 / 3."""
    found = Section(**given).properties
    for name, value in expected.items():
        assert found[name] == pytest.approx(value, rel=1e-14)
    assert set(found) == ({"area"} if given["shape"] == "rope" else {"area", "Iy", "Iz", "J", "Wy", "Wz"})


@pytest.mark.parametrize(("ratio", "expected"), [(1.0, 0.1406), (2.0, 0.229), (10.0, 0.312)])
def test_the_torsion_of_a_rectangle_is_saint_venants(ratio: float, expected: float) -> None:
    """J / (a b^3), to the digits of the table of Timoshenko and Goodier, Theory of Elasticity, 109."""
    found = Section(shape="rectangle", width=1.0, height=ratio).properties["J"] / ratio
    assert found == pytest.approx(expected, abs=0.5e-3)
    assert Section(shape="rectangle", width=ratio, height=1.0).properties["J"] == found * ratio


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        ({}, "give a shape and its dimensions, or the area"),
        ({"diameter": 1.0}, "diameter given without a shape"),
        ({"shape": "tube", "diameter": 1.0}, "thickness is missing; the shape tube needs diameter and thickness"),
        ({"shape": "rod", "diameter": 1.0, "area": 2.0}, "area given; the shape rod needs diameter, and nothing else"),
        ({"shape": "tube", "diameter": 1.0, "thickness": 0.6}, "at most half of the diameter"),
        ({"shape": "I", "width": 1, "height": 1, "flange_thickness": 0.5, "web_thickness": 0.1}, "less than half"),
        ({"shape": "I", "width": 1, "height": 9, "flange_thickness": 1, "web_thickness": 2}, "at most the width"),
    ],
)
def test_a_section_is_given_in_one_way(given: Any, sentence: str) -> None:
    with pytest.raises(InputError) as refused:
        Section(**given)
    assert sentence in refused.value.sentence


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        ({}, "give E, or the warp_stiffness of a cloth"),
        ({"E": 1.0, "warp_stiffness": 1.0}, "a material is either a solid, with E, or a cloth"),
        ({"E": 1.0, "G": 1.0, "poisson": 0.3}, "give one of them"),
        ({"E": 1.0, "poisson": 0.6}, "more than -1 and at most 0.5"),
        ({"area_density": 1.0}, "a cloth needs it"),
        ({"warp_stiffness": 1.0, "weft_stiffness": 4.0, "poisson": 0.6}, "its square must be below"),
    ],
)
def test_a_material_is_a_solid_or_a_cloth(given: Any, sentence: str) -> None:
    with pytest.raises(InputError) as refused:
        Material(**given)
    assert sentence in refused.value.sentence


def test_known_materials_are_in_the_units_of_the_scene() -> None:
    """Steel of 210 GPa is 21,000 kN/cm^2 and weighs 7.85 t/m^3; in N, cm and s mass has the unit 100 kg, so its density
    is 7850 / 1e6 / 100; PVC-polyester of 115 kN/m is 115 N/mm; gravity is 980.665 cm/s^2."""
    steel = converted(known()["S355"], Units(length="cm", force="kN"))
    assert (steel.E, steel.strength) == (pytest.approx(21000.0, rel=1e-14), pytest.approx(35.5, rel=1e-14))
    assert converted(known()["S355"], Units(force="kN")).density == pytest.approx(7.85, rel=1e-14)
    assert converted(known()["S355"], Units(length="cm")).density == pytest.approx(7850e-8, rel=1e-14)
    cloth = converted(known()["PVC-polyester III"], Units(length="mm"))
    assert cloth.warp_strength == pytest.approx(115.0, rel=1e-14) and cloth.poisson == 0.3
    assert gravity(Units(length="cm")) == pytest.approx(980.665, rel=1e-15)
    for name, material in known().items():
        assert (material.E is None) != (material.warp_stiffness is None), name
        assert material.strength or material.warp_strength, name


SCENE: dict[str, Any] = {
    "particles": [[0, 0, 0], [2, 0, 0], [2, 4, 0]],
    "materials": {"steel": {"E": 210e9, "G": 81e9, "density": 7850, "strength": 355e6, "expansion": 12e-6}},
    "sections": {"tube": {"shape": "tube", "diameter": 0.1, "thickness": 0.005}, "rope": {"area": 1e-4}},
}


def columns(force: dict[str, Any], **more: Any) -> dict[str, np.ndarray]:
    """Columns of the springs 0-1 and 1-2, 2 and 4 long, as they are compiled."""
    given = {"kind": "springs", "particles": [[0, 1], [1, 2]], **force}
    block = compile(Scene.read({**SCENE, **more, "forces": [given]})).groups[0].block
    return {name: block.parameters[:, i] for i, name in enumerate(block.names)}


def test_axial_stiffness_is_divided_by_the_rest_length_of_each_element() -> None:
    """k = EA / L0; of a material and a section EA = E x area; a factor on the rest length counts."""
    assert columns({"axial_stiffness": 1e6})["stiffness"] == pytest.approx([5e5, 2.5e5], rel=1e-15)
    assert columns({"axial_stiffness": [1e6, 3e6], "rest_length": [4, 2]})["stiffness"].tolist() == [2.5e5, 1.5e6]
    assert columns({"axial_stiffness": 1e6, "rest_factor": 0.5})["stiffness"] == pytest.approx([1e6, 5e5], rel=1e-15)
    area = PI * 0.005 * 0.095
    made = columns({"material": "steel", "section": "tube"})["stiffness"]
    assert made == pytest.approx(210e9 * area / np.array([2.0, 4.0]), rel=1e-14)


@pytest.mark.parametrize("stiff", [{"stiffness": 100.0}, {"axial_stiffness": 400.0}], ids=["k", "EA"])
@pytest.mark.parametrize("force", [30.0, [-20.0, 50.0]], ids=["one", "each"])
def test_prestress_is_the_force_at_the_start(stiff: Any, force: Any) -> None:
    """Every spring has the given force at its start length: k (l - L0), or EA (l - L0) / L0."""
    given = {"kind": "springs", "particles": [[0, 1], [1, 2]], "force": force, **stiff}
    scene = Scene.read({**SCENE, "forces": [given], "anchors": [{"particles": [0, 1, 2]}]})
    assert relax(scene).force("springs")["force"] == pytest.approx(np.broadcast_to(force, 2), rel=1e-12)


def test_strain_and_temperature_set_the_rest_length() -> None:
    """(l - L0) / L0 = strain; a temperature lengthens L0 by 1 + expansion x temperature, on top of what else there is.
    A held steel bar that cools by T pulls with E A alpha T / (1 - alpha T), k being EA / L0."""
    assert columns({"stiffness": 1.0, "strain": 0.25})["rest_length"] == pytest.approx([1.6, 3.2], rel=1e-15)
    bar = {"kind": "springs", "particles": [[0, 1]], "material": "steel", "section": "rope", "temperature": -30}
    scene = Scene.read({**SCENE, "forces": [bar], "anchors": [{"particles": [0, 1]}]})
    less = 12e-6 * 30
    assert relax(scene).force("springs")["force"] == pytest.approx([210e9 * 1e-4 * less / (1 - less)], rel=1e-9)
    both = columns({"material": "steel", "section": "rope", "strain": 0.25, "temperature": 100})["rest_length"]
    assert both == pytest.approx(np.array([1.6, 3.2]) * (1 + 12e-4), rel=1e-14)


def tension(length: float, memory: float = 0.0, **force: Any) -> tuple[float, float]:
    """Tension and energy of a spring of rest length 2 and k = 100."""
    given = {"kind": "springs", "particles": [[0, 1]], "stiffness": 100.0, **force}
    system = compile(Scene.read({**SCENE, "forces": [given]}))
    state = system.start()
    state.memory[0][:] = memory
    state.x[1, 0] = length
    f, _, energy = system.evaluate(state)
    return float(f[0, 0]), float(energy.sum())


def test_cables_do_not_push_and_struts_do_not_pull() -> None:
    """Slack below the rest length, or without force above it, at no energy; else as a spring. What has yielded is
    slack below the rest length that it has now."""
    assert tension(1.5, tension_only=True) == (0.0, 0.0)
    assert tension(2.5, tension_only=True) == (50.0, 12.5)
    assert tension(1.5, compression_only=True) == pytest.approx((-50.0, 12.5), rel=1e-14)
    assert tension(2.5, compression_only=True) == (0.0, 0.0)
    assert tension(2.2, memory=0.25, tension_only=True, plasticity=0.5) == (0.0, 0.0)
    assert tension(2.5, memory=0.25, tension_only=True, plasticity=0.5) == (25.0, 3.125)


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        ({"stiffness": 1.0, "axial_stiffness": 1.0}, "stiffness and axial_stiffness given; give exactly one of"),
        ({"axial_stiffness": 1.0, "material": "steel", "section": "tube"}, "give exactly one of stiffness"),
        (
            {"material": "steel"},
            "material given; give exactly one of stiffness, axial_stiffness, or material and section",
        ),
        ({"stiffness": None}, "the stiffness is missing"),
        ({"force": 1.0, "strain": 0.1}, "force and strain given; give at most one of rest_length, force, strain"),
        ({"strain": -1.0}, "more than -1 allowed"),
        ({"temperature": 1.0}, "temperature needs a material"),
        ({"tension_only": True, "compression_only": True}, "give one of them"),
        ({"tension_only": True, "lower_cutoff": 1.0}, "tension_only and lower_cutoff given"),
        ({"material": "PTFE-glass", "section": "tube"}, "is a cloth, which has no modulus E"),
        ({"material": "steel", "section": "beam"}, "section 'beam' does not exist; the scene has 'tube', 'rope'"),
        ({"material": "steal", "section": "tube"}, 'material "steal" does not exist; did you mean steel?'),
        ({"stiffness": 1.0, "force": 5.0}, "element 0 with k = 1 and length 2 cannot have a force of 5"),
        ({"axial_stiffness": 1.0, "force": -1.0}, "element 0 with EA = 1 cannot have a force of -1"),
        ({"axial_stiffness": 1.0, "rest_factor": 0.0}, "has no rest length"),
    ],
)
def test_springs_are_given_in_one_way(given: Any, sentence: str) -> None:
    """One sentence, at the force."""
    with pytest.raises(InputError) as refused:
        columns(given)
    assert sentence in refused.value.sentence and refused.value.pointer.startswith("/forces/0")


def test_a_scene_keeps_its_materials_and_comes_back_from_json() -> None:
    """The same text, the same digest, frozen."""
    given = {"kind": "springs", "particles": [[1, 2]], "material": "steel", "section": "tube"}
    scene = Scene.read({**SCENE, "forces": [given]})
    again = Scene.read(scene.canonical)
    assert again == scene and again.digest == scene.digest and again.forces[0].stiffness is None
    assert scene.materials["steel"].contraction("steel") == pytest.approx(210 / 162 - 1, rel=1e-15)
    with pytest.raises(ValueError, match="frozen"):
        scene.materials["steel"].E = 1.0  # type: ignore[misc]


def test_a_patch_of_a_material_reaches_all_that_is_made_of_it() -> None:
    """As the scene with the other value, also when it is undone; what it cannot be is one sentence, and changes
    nothing."""
    bars = {"kind": "springs", "particles": [[0, 1], [1, 2]], "material": "steel", "section": "tube"}
    plain = {"kind": "springs", "particles": [[0, 2]]}
    running = Simulation(Scene.read({**SCENE, "forces": [bars, plain]}))
    before = running.system.groups[0].block.parameters.copy()
    running.patch({"materials": {"steel": {"E": 420e9}}, "sections": {"tube": {"thickness": 0.01}}})
    changed = running.system.groups[0].block.parameters
    ratio = 2.0 * (0.01 * 0.09) / (0.005 * 0.095)
    assert changed[:2, 0] == pytest.approx(before[:2, 0] * ratio, rel=1e-13) and changed[2, 0] == before[2, 0]
    assert running.edited_scene().materials["steel"].E == 420e9
    again = compile(running.edited_scene()).groups[0].block.parameters
    assert (again == changed).all()
    running.patch({"forces": {"0": {"rest_factor": 0.5}}})
    assert running.system.groups[0].block.parameters[0, 0] == pytest.approx(2.0 * again[0, 0], rel=1e-13)
    running.undo()
    running.undo()
    assert (running.system.groups[0].block.parameters == before).all()
    for edit, sentence in (
        ({"materials": {"steel": {"E": -1}}}, "more than 0 allowed"),
        ({"materials": {"S355": {"E": 1}}}, "no material of its own with this name; there are 'steel'"),
        ({"sections": {"tube": {"thickness": 0.06}}}, "at most half of the diameter"),
    ):
        with pytest.raises(InputError) as refused:
            running.patch(edit)
        assert sentence in refused.value.sentence
        assert (running.system.groups[0].block.parameters == before).all()


def test_columns_of_a_material_and_a_section() -> None:
    """What a beam of both is made of; a rope does not bend, timber has its own G, and without both there is nothing."""

    class Bar:
        def __init__(self, material: str | None, section: str | None) -> None:
            self.material, self.section = material, section

    ropes = {"strand": {"shape": "rope", "diameter": 0.02, "fill_factor": 0.75}}
    places = compile(Scene.read({**SCENE, "sections": {**SCENE["sections"], **ropes}})).places
    found = section_columns(Bar("steel", "tube"), places)
    tube = Section(shape="tube", diameter=0.1, thickness=0.005).properties
    assert found == {"E": 210e9, "G": 81e9, "A": tube["area"], **{n: tube[n] for n in ("Iy", "Iz", "J")}}
    assert section_columns(Bar("GL24h", "tube"), places)["G"] == 650e6
    assert section_columns(Bar(None, None), places) == {}
    with pytest.raises(InputError, match='section "strand" has no Iy; a rope does not bend'):
        section_columns(Bar("steel", "strand"), places)
    with pytest.raises(InputError, match="GL24h is not isotropic"):
        known()["GL24h"].contraction("GL24h")


def weighed(force: dict[str, Any], **more: Any) -> np.ndarray:
    """Weights on the particles of the scene, along -z."""
    given = {"kind": "self_weight", **force}
    system = compile(Scene.read({**SCENE, **more, "forces": [given]}))
    return np.asarray(-system.evaluate(system.start())[0][:, 2])


def test_materials_have_their_weight() -> None:
    """density x area x 9.80665 m/s^2 x start length, half of it on each end; density x thickness, or the mass per area
    of a cloth, on faces, a third on each corner; the same in other units."""
    tube = 7850 * PI * 0.005 * 0.095 * 9.80665
    along = weighed({"particles": [[0, 1], [1, 2]], "material": "steel", "section": "tube"})
    assert along == pytest.approx(tube * np.array([1.0, 3.0, 2.0]), rel=1e-14)
    mesh = {"m": {"vertices": SCENE["particles"], "faces": [[0, 1, 2]]}}  # of area 4
    plate = weighed({"mesh": "m", "material": "steel", "thickness": 0.01, "gravity": 10.0}, meshes=mesh)
    assert plate == pytest.approx(np.full(3, 7850 * 0.01 * 4 * 10 / 3), rel=1e-14)
    cloth = weighed({"mesh": "m", "material": "PVC-polyester I"}, meshes=mesh)
    assert cloth == pytest.approx(np.full(3, 0.75 * 4 * 9.80665 / 3), rel=1e-14)
    in_kn = weighed({"mesh": "m", "material": "PVC-polyester I"}, meshes=mesh, units={"force": "kN"})
    assert in_kn == pytest.approx(cloth / 1e3, rel=1e-14)


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        ({"total": 1.0, "material": "steel"}, "give exactly one of total, per_length, material"),
        ({"total": 1.0, "gravity": 9.81}, "gravity belongs to a material"),
        ({"material": "steel"}, "a material needs a section along lines, or a mesh"),
        ({"mesh": "m", "material": "steel"}, "steel is a solid; give its thickness on the mesh, or a section"),
        ({"mesh": "m", "material": "PTFE-glass", "thickness": 1.0}, "whose mass is per area; remove thickness"),
        ({"mesh": "m", "material": "bare", "thickness": 1.0}, "bare has no density; give it"),
        ({"mesh": "m", "material": "bare", "section": "tube", "thickness": 1.0}, "section and thickness given"),
    ],
)
def test_a_weight_is_given_in_one_way(given: Any, sentence: str) -> None:
    mesh = {"m": {"vertices": SCENE["particles"], "faces": [[0, 1, 2]]}}
    with pytest.raises(InputError) as refused:
        weighed(given, meshes=mesh, materials={**SCENE["materials"], "bare": {"E": 1.0}})
    assert sentence in refused.value.sentence


def test_a_shell_of_a_material_has_its_plate_stiffness() -> None:
    """D = E t^3 / (12 (1 - nu^2)) and nu of steel; or a given nu."""
    mesh = {"m": {"vertices": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], "faces": [[0, 1, 2], [0, 2, 3]]}}

    def numbers(**force: Any) -> list[float]:
        scene = {**SCENE, "meshes": mesh, "forces": [{"kind": "shell", "mesh": "m", **force}]}
        block = compile(Scene.read(scene)).groups[0].block
        return [float(block.parameters[0, block.names.index(name)]) for name in ("strength", "poisson")]

    nu = 210 / 162 - 1
    made = numbers(material="steel", thickness=0.02)
    assert made == pytest.approx([210e9 * 8e-6 / (12 * (1 - nu**2)), nu], rel=1e-13)
    assert numbers(material="steel", thickness=0.02, poisson=0.0) == pytest.approx([140e3, 0.0], rel=1e-13)
    assert numbers() == [500.0, 0.0] and numbers(strength=3.0, poisson=0.25) == [3.0, 0.25]
    for given in ({"material": "steel"}, {"strength": 1.0, "thickness": 1.0}, {"strength": None}):
        with pytest.raises(InputError, match="give either strength, or both material and thickness"):
            numbers(**given)


def test_a_beam_is_made_of_a_material_and_a_section() -> None:
    """The same, to the bit, as with their numbers; given in one way."""
    tube = Section(**SCENE["sections"]["tube"]).properties
    own = {"E": 210e9, "G": 81e9, "A": tube["area"], **{name: tube[name] for name in ("Iy", "Iz", "J")}}
    blocks = []
    for given in (own, {"material": "steel", "section": "tube"}):
        beam = {"kind": "beam", "particles": [[0, 1], [1, 2]], "normal": [0, 0, 1], **given}
        blocks.append(compile(Scene.read({**SCENE, "forces": [beam]})).groups[0].block)
    assert (blocks[0].parameters == blocks[1].parameters).all()
    for given in ({}, {"E": 1.0}, {"material": "steel"}, {**own, "material": "steel", "section": "tube"}):
        with pytest.raises(InputError, match="give either E, G, A, Iy, Iz, J, or both material and section"):
            compile(Scene.read({**SCENE, "forces": [{"kind": "beam", "particles": [[0, 1]], **given}]}))


@pytest.mark.parametrize(
    ("units", "steel", "wood", "fields"),
    [
        ({}, (210e9, 7850.0), (11e9, 420.0), []),
        ({"force": "kN"}, (210e6, 7.85), (11e6, 0.42), []),
        ({"length": "mm", "force": "N"}, (210e3, 7.85e-9), (11e3, 4.2e-10), []),
        ({"length": "in", "force": "kip"}, (30e3, 7.35e-7), (1.6e3, 4e-8), []),
        ({"force": "kN"}, (210e9, 7.85), (11e6, 420.0), ["steel/E", "wood/density"]),
        ({"length": "mm", "force": "N"}, (210e9, 7850.0), (11e3, 4.2e-10), ["steel/E", "steel/density"]),
    ],
)
def test_a_material_in_other_units_is_doubted(
    units: dict[str, str], steel: tuple[float, float], wood: tuple[float, float], fields: list[str]
) -> None:
    """Steel of 210 GPa and 7850 kg/m3 and wood of 11 GPa and 420 kg/m3, right in the units of the scene; or as they
    would be in N, m and kg, which no material is there: stiffer than diamond, 1.2e12 N/m2, or heavier than osmium,
    22.6 t/m3."""
    made = {name: {"E": E, "density": of} for name, (E, of) in {"steel": steel, "wood": wood}.items()}
    springs = {"kind": "springs", "particles": [[0, 1]]}
    scene = Scene.read(
        {"units": units, "particles": [[0, 0, 0], [1, 0, 0]], "materials": made, "forces": [springs],
         "anchors": [{"particles": [0, 1]}]}
    )  # fmt: skip
    said = compile(scene).report.warnings
    assert [sentence.removeprefix("/materials/").split(":")[0] for sentence in said] == fields


def test_the_doubt_names_the_value_and_the_unit() -> None:
    """7850 with kN, m and s is 7.85 million kg/m3, and belongs into tonnes."""
    (said,) = Material(E=210e6, density=7850.0).doubts(Units(force="kN")).values()
    assert said.startswith("7850 given, which is 7.85e+06 kg/m^3, more than any material has; give it per m^3 in units")
    assert "units of 1000 kg" in said
