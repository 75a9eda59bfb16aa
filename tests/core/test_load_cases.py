"""Forms frozen into elastic models, their load cases and combinations: closed forms, and 100 random forms."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
import pytest
import scipy.optimize
from hypothesis import Phase, assume, given, settings
from hypothesis import strategies as st

import hookean
from hookean import InputError, Scene
from hookean.analysis.envelope import first_largest
from hookean.analysis.freezing import freeze
from hookean.analysis.load_factors import magnitudes, scaled
from hookean.forces import KINDS
from hookean.running.run import relax_state
from hookean.solvers import solver
from hookean.system.balance import balance
from hookean.system.system import compile
from soak import sampled

from .formed import FAMILIES, formed

Spec = dict[str, Any]
EA, T, L = 2000.0, 30.0, 4.0


def cable(**more: Any) -> Spec:
    """A straight cable of constant tension T over two spans of L / 2, frozen with EA, and a load on its middle."""
    return {
        "particles": [[0, 0, 0], [L / 2, 0, 0], [L, 0, 0]],
        "forces": [
            {"kind": "constant_tension", "name": "cable", "particles": [[0, 1], [1, 2]], "tension": T},
            {"kind": "unary", "name": "snow load", "particles": [1], "vector": [0, 0, -10.0]},
            {"kind": "unary", "name": "wind load", "particles": [1], "vector": [0, 4.0, 2.0]},
        ],
        "anchors": [{"name": "ends", "particles": [0, 2]}],
        "load_cases": {"snow": {"forces": ["snow load"]}, "wind": {"forces": ["wind load"], "factor": 0.5}},
        "combinations": {"ULS 1": {"prestress": 1.35, "snow": 1.5}, "both": {"snow": 1.0, "wind": -2.0}},
        "stages": {"freeze": {"cable": {"axial_stiffness": EA}}},
        **more,
    }


def sag(load: float, tension: float) -> tuple[float, float]:
    """Sag and tension of the elastic cable with a tension at rest under a load on its middle: 2 S sin a = P, with the
    rest length of EA (l0 / L0 - 1) = T."""
    half = L / 2
    rest = half * EA / (EA + tension)

    def pull(z: float) -> float:
        return EA * (np.hypot(half, z) / rest - 1.0)

    z = scipy.optimize.brentq(lambda z: 2.0 * pull(z) * z / np.hypot(half, z) - load, 0.0, half, xtol=1e-15)
    return z, pull(z)


def test_a_cable_under_its_cases_has_closed_forms() -> None:
    found = hookean.load_cases(Scene.read(cable()))
    assert list(found.cases) == ["snow", "wind", "ULS 1", "both"]
    for name, load, prestress in (("snow", 10.0, T), ("ULS 1", 15.0, 1.35 * T)):
        z, tension = sag(load, prestress)
        case = found.cases[name]
        assert case.result.converged
        np.testing.assert_allclose(case.displacements[1], [0.0, 0.0, -z], atol=1e-6 * L)
        np.testing.assert_allclose(case.result.force("cable")["force"], tension, rtol=1e-5)
    # across the cable any direction is like another: the load (0, -4, -12) of the combination
    z, _ = sag(float(np.hypot(4.0, 12.0)), T)
    np.testing.assert_allclose(np.linalg.norm(found.cases["both"].displacements[1]), z, atol=1e-6 * L)
    moved = found.cases["wind"].displacements[1]
    np.testing.assert_allclose(np.linalg.norm(moved), sag(0.5 * np.hypot(4.0, 2.0), T)[0], atol=1e-6 * L)
    np.testing.assert_allclose(moved[1:] / np.linalg.norm(moved), [2 / 5**0.5, 1 / 5**0.5], atol=1e-6)


def test_loads_of_cases_do_not_act_while_the_form_is_found() -> None:
    scene = Scene.read(cable())
    form = hookean.relax(scene)
    np.testing.assert_array_equal(form.particles[1], [L / 2, 0.0, 0.0])
    assert "force" not in form.forces[1]
    np.testing.assert_array_equal(hookean.load_cases(scene, ["snow"]).form.particles, form.particles)


def test_prestress_alone_scales_the_tension_of_the_form() -> None:
    scene = Scene.read(cable(combinations={"jacked": {"prestress": 1.35}, "eased": {"prestress": 0.0}}))
    found = hookean.load_cases(scene, ["jacked", "eased"])
    np.testing.assert_allclose(found.cases["jacked"].result.force("cable")["force"], 1.35 * T, rtol=1e-12)
    np.testing.assert_allclose(found.cases["eased"].result.force("cable")["force"], 0.0, atol=1e-9 * T)


def test_frozen_lines_have_the_lengths_of_their_tension() -> None:
    """L0 = l EA / (EA + T), k = EA / L0 (Schek 1974)."""
    frozen = hookean.freeze(Scene.read(cable()))
    springs = frozen.scene.forces[0]
    np.testing.assert_allclose(springs.rest_length, (L / 2) * EA / (EA + T), rtol=1e-15)
    np.testing.assert_allclose(springs.stiffness * springs.rest_length, EA, rtol=1e-15)
    system, state = frozen.system()
    np.testing.assert_allclose(balance(system, state).forces, 0.0, atol=1e-12 * T)


def assert_stays(seed: int) -> None:
    """A frozen form, pushed by 1e-5 of its size, comes back to where it was within 1e-9 of its size."""
    scene = Scene.read(formed(seed))
    frozen = hookean.freeze(scene)
    tight = frozen.scene.model_copy(update={"settings": {"solver": "newton", "tolerance": 1e-13}})
    system, state = frozen.system(tight)
    size = float(np.linalg.norm(np.ptp(frozen.particles, axis=0)))
    state.x += 1e-5 * size * np.random.default_rng(seed).normal(size=state.x.shape) * state.free
    result = relax_state(system, state, solver("newton"))
    assert np.abs(result.particles - frozen.particles).max() < 1e-9 * size
    # and the stress is the same: what the form had, the frozen model has
    for before, after in zip(hookean.freeze(scene).form.forces, result.forces, strict=True):
        if "force" in before and np.ndim(before["force"]) == 1:
            scale = np.abs(before["force"]).max()
            np.testing.assert_allclose(after["force"], before["force"], atol=1e-6 * scale)


@pytest.mark.slow
@pytest.mark.parametrize("seed", sampled(range(len(FAMILIES)), 3))
def test_a_frozen_form_does_not_move(seed: int) -> None:
    """One of each family."""
    assert_stays(seed)


@pytest.mark.soak
@given(st.integers(0, 2**32 - 1))
@settings(max_examples=200, phases=(Phase.generate,), derandomize=True)
def test_more_frozen_forms_do_not_move(seed: int) -> None:
    """200 scenes whose form is found: a tent may have none, where its cables are too slack for its film."""
    try:
        assert_stays(seed)
    except InputError as error:
        assume("no form was found" not in str(error))
        raise


def test_a_film_becomes_cloth_of_its_shape_and_stress() -> None:
    """A flat film has its tension in all directions, and so has the cloth; its Poisson's ratio and the load factor on
    prestress do not change its shape."""
    spec = formed(4)
    x = np.array(spec["particles"]) * [1, 1, 0]
    spec = {**spec, "particles": x, "meshes": {"skin": {**spec["meshes"]["skin"], "vertices": x}}}
    spec["forces"][0] = {"kind": "soapfilm", "name": "film", "mesh": "skin", "tension": 3.0}
    spec["combinations"] = {"jacked": {"prestress": 1.5}}
    found = hookean.load_cases(Scene.read(spec), ["jacked"])
    np.testing.assert_array_equal(found.frozen.particles, found.form.particles)
    assert not found.frozen.notes and found.frozen.scene.forces[0].kind_name == "membrane"
    for name, wanted in (("warp", 4.5), ("weft", 4.5), ("shear", 0.0)):
        np.testing.assert_allclose(found.cases["jacked"].result.force("film")[name], wanted, atol=1e-9)


def test_cloth_of_a_curved_film_keeps_its_shape_and_notes_the_change_of_stress() -> None:
    """Its vertices are where the film's were, to the bit; the mean stress is the film's tension to the error of flat
    triangles."""
    spec = formed(7)
    frozen = hookean.freeze(Scene.read(spec))
    np.testing.assert_allclose(frozen.particles, frozen.form.particles, atol=1e-9)
    assert len(frozen.notes) == 1 and "balanced across itself only" in frozen.notes[0]
    stress, tension = frozen.scene.forces[0].prestress, spec["forces"][0]["tension"]
    np.testing.assert_allclose(stress.mean(axis=0), [tension, tension, 0.0], atol=0.05 * tension)


@pytest.mark.slow
@pytest.mark.parametrize("seed", sampled([1, 2, 6], 3))
def test_cases_in_any_order_give_the_same_bits(seed: int) -> None:
    """And side by side on an executor."""
    spec = formed(seed)
    spec["load_cases"]["less"] = {"forces": ["snow"], "factor": 0.4}
    spec["combinations"] = {"ULS": {"snow": 1.5, "prestress": 1.1}}
    scene = Scene.read(spec)
    names = ["snow", "less", "ULS"]
    wanted = hookean.load_cases(scene, names)
    with ThreadPoolExecutor(2) as executor:
        for order, pool in ((names[::-1], None), (["ULS", "snow"], None), (names, executor)):
            found = hookean.load_cases(scene, order, executor=pool)
            assert list(found.cases) == order
            for name in order:
                result, same = found.cases[name].result, wanted.cases[name].result
                assert result.particles.tobytes() == same.particles.tobytes()
                for column, values in same.forces[0].items():
                    assert np.asarray(result.forces[0][column]).tobytes() == np.asarray(values).tobytes()


@pytest.mark.parametrize("seed", range(4))
def test_reactions_and_loads_balance_in_every_case(seed: int) -> None:
    """Forces and moments, to 1e-9 of their scale where the shape is known to 1e-12."""
    spec = formed(seed)
    spec["settings"] = {"tolerance": 1e-12}
    spec["combinations"] = {"ULS": {"snow": 1.5, "permanent": 1.35, "prestress": 1.2}}
    for case in hookean.load_cases(Scene.read(spec)).cases.values():
        result = case.result
        x, pulls = [result.particles[result.reactions["particles"]]], [np.asarray(result.reactions["force"])]
        for force, entry in zip(result.scene.forces, result.forces, strict=True):
            if KINDS[force.kind_name].role == "load":
                x.append(result.particles[np.asarray(entry["particles"]).ravel()])
                pulls.append(np.asarray(entry["force"]))
        where, what = np.concatenate(x), np.concatenate(pulls)
        scale = np.abs(what).sum()
        assert np.abs(what.sum(axis=0)).max() < 1e-9 * scale
        assert np.abs(np.cross(where, what).sum(axis=0)).max() < 1e-9 * scale * np.abs(where).max()


def test_a_combination_is_the_scene_that_has_its_loads() -> None:
    """With permanent loads times their factor."""
    dead = {"kind": "self_weight", "name": "dead", "particles": [1], "total": 2.0}
    spec = cable(combinations={"ULS": {"permanent": 1.35, "snow": 1.5, "wind": 0.9}})
    spec["forces"].append(dead)
    found = hookean.load_cases(Scene.read(spec), ["ULS"])
    frozen = found.frozen.scene.forces[0]
    load = hookean.Unary(particles=[1], vector=[0.0, 0.45 * 4.0, -15.0 + 0.45 * 2.0 - 2.7])
    by_hand = Scene(
        particles=found.frozen.particles, forces=[frozen, load], anchors=[hookean.Anchors(particles=[0, 2])]
    )
    np.testing.assert_allclose(found.cases["ULS"].result.particles, hookean.relax(by_hand).particles, atol=1e-8)


def mast() -> Spec:
    """A mast on a hinge between two stays of tension-only cables; wind pushes it to one side."""
    stays = {"kind": "springs", "name": "stays", "particles": [[0, 1], [1, 2]], "stiffness": 1e4, "rest_length": 4.9995}
    strut = {"kind": "springs", "name": "strut", "particles": [[1, 3]], "stiffness": 1e6}
    wind = {"kind": "unary", "name": "wind", "particles": [1], "vector": [40.0, 0, 0]}
    return {
        "particles": [[-3, 0, 0], [0, 0, 4], [3, 0, 0], [0, 0, 0]],
        "forces": [stays, strut, wind],
        "anchors": [{"particles": [0, 2, 3]}, {"particles": [1], "axes": "y"}],
        "load_cases": {"wind": {"forces": ["wind"]}},
        "stages": {"freeze": {"stays": {"tension_only": True}}},
    }


def test_a_stay_goes_slack() -> None:
    """The lee stay hangs slack, and the other carries all of the wind: T = H / cos(a) = 40 5 / 3. To 5e-3: the
    mast leans by T l / (EA cos(a)), 3e-3 of its height."""
    found = hookean.load_cases(Scene.read(mast()))
    case = found.cases["wind"]
    np.testing.assert_allclose(case.result.force("stays")["force"], [200.0 / 3.0, 0.0], rtol=5e-3, atol=1e-12)
    assert {number: rows.tolist() for number, rows in case.slack.items()} == {0: [1]}
    assert case.slack_count == 1 and "1 elements are slack" in case.summary()


def test_a_line_of_constant_tension_goes_slack_where_it_is_tension_only() -> None:
    """A load H = 100 along the cable, more than its prestress, hangs on one span alone: l = L0 (1 + H / EA), with
    L0 = l0 EA / (EA + T); else both share it, and one is in compression."""
    spec = cable(combinations={})
    spec["forces"][1]["vector"] = [100.0, 0, 0]
    pushed = hookean.load_cases(Scene.read(spec), ["snow"]).cases["snow"]
    assert pushed.result.force("cable")["force"][1] < 0.0 and not pushed.slack
    spec["stages"]["freeze"]["cable"]["tension_only"] = True
    found = hookean.load_cases(Scene.read(spec), ["snow"]).cases["snow"]
    np.testing.assert_allclose(found.result.force("cable")["force"], [100.0, 0.0], rtol=1e-6, atol=1e-12)
    moved = L / 2 * EA / (EA + T) * (1.0 + 100.0 / EA) - L / 2
    np.testing.assert_allclose(found.displacements[1], [moved, 0.0, 0.0], atol=1e-7)
    assert found.slack[0].tolist() == [1]


def test_the_envelope_has_the_extremes_and_their_cases() -> None:
    found = hookean.load_cases(Scene.read(cable()))
    names, envelope = list(found.cases), found.envelope
    far = np.array([np.linalg.norm(case.displacements, axis=1) for case in found.cases.values()])
    np.testing.assert_array_equal(envelope.displacement.largest, far.max(axis=0))
    assert envelope.cases == tuple(names) and envelope.displacement.largest_case[1] == far[:, 1].argmax()
    pulls = np.array([case.result.force("cable")["force"] for case in found.cases.values()])
    forces = envelope.forces[0]["columns"]["force"]
    np.testing.assert_array_equal(forces.smallest, pulls.min(axis=0))
    np.testing.assert_array_equal(forces.largest, pulls.max(axis=0))
    np.testing.assert_array_equal(forces.smallest_case, pulls.argmin(axis=0))
    np.testing.assert_array_equal(envelope.particles, [0, 2])
    assert any(line.startswith("displacement: largest") for line in envelope.summary())
    assert found.to_dict()["envelope"]["displacement"]["largest_case"][1] == names[far[:, 1].argmax()]


STEEL = {"materials": {"steel": {"E": 2e5, "G": 8e4, "expansion": 1.2e-5}}, "sections": {"rope": {"area": 0.01}}}
WARM: Spec = {
    **STEEL,
    "stages": {"freeze": {"cable": {"material": "steel", "section": "rope"}}},
    "load_cases": {
        "warm": {"temperature": {"cable": 40.0}},
        "snow": {"forces": ["snow load"]},
        "wind": {"forces": ["wind load"]},
    },
    "combinations": {"both": {"snow": 1.0, "warm": 1.5, "prestress": 1.1}},
}


def test_of_values_that_symmetry_makes_equal_the_first_is_named() -> None:
    """Solutions leave differences of the size of their tolerance, which may not decide; more than 1e-6 does."""
    assert first_largest(np.array([1.0, 5.0 - 4e-6, 5.0, 5.0 - 1e-5])) == 1
    assert first_largest(np.array([1.0, 5.0 - 6e-6, 5.0, 5.0])) == 2
    assert first_largest(np.array([-3.0, -2.0, -2.0])) == 1 and first_largest(np.zeros(0)) == 0


def test_the_envelope_has_the_moments_of_supports() -> None:
    """Of a cantilever of length 1 under 2 down and, in another case, 3 up at its end: 3 at the clamp, but for the part
    that its sag of P / (3 EI) makes."""
    section = {"E": 1e6, "G": 4e5, "A": 0.1, "Iy": 1e-3, "Iz": 1e-3, "J": 1e-3}
    forces = [{"kind": "beam", "particles": [[0, 1]], **section}]
    forces += [
        {"kind": "unary", "name": n, "particles": [1], "vector": [0, 0, p]} for n, p in (("a", -2.0), ("b", 3.0))
    ]
    cases = {name: {"forces": [name]} for name in ("a", "b")}
    anchors = [{"particles": [0], "rotations": "xyz"}]
    scene = {"particles": [[0, 0, 0], [1, 0, 0]], "forces": forces, "anchors": anchors, "load_cases": cases}
    found = hookean.load_cases(Scene.read(scene)).envelope
    assert found.moment is not None and found.moment.largest == pytest.approx([3.0], rel=1e-5)
    assert found.to_dict()["reactions"]["moment"]["largest_case"] == ["b"]
    assert found.moment.smallest == pytest.approx([2.0], rel=1e-5)
    assert any(line.startswith("reaction moment: largest 3") for line in found.summary())


def test_summaries_have_the_bending_of_beams_and_the_stress_of_cloth() -> None:
    """Of the cantilever above 3 at the clamp, under the load that lifts; of a square of cloth of stiffness 100 that is
    pulled at rest by 2 and 1 per width: as it is made."""
    section = {"E": 1e6, "G": 4e5, "A": 0.1, "Iy": 1e-3, "Iz": 1e-3, "J": 1e-3}
    square = {"vertices": [[0, 5, 0], [1, 5, 0], [1, 6, 0], [0, 6, 0]], "faces": [[0, 1, 2, 3]]}
    cloth = {"kind": "membrane", "name": "cloth", "mesh": "m", "warp_stiffness": 100, "warp": [1, 0, 0], "poisson": 0.0}
    pushes = [{"kind": "unary", "name": n, "particles": [1], "vector": [0, 0, p]} for n, p in (("a", -2.0), ("b", 3.0))]
    beam = {"kind": "beam", "name": "arm", "particles": [[0, 1]], **section}
    scene = {
        "particles": [[0, 0, 0], [1, 0, 0]],
        "meshes": {"m": square},
        "forces": [beam, {**cloth, "prestress": [2, 1, 0]}, *pushes],
        "anchors": [{"particles": [0], "rotations": "xyz"}, {"points": square["vertices"]}],
        "load_cases": {name: {"forces": [name]} for name in ("a", "b")},
    }
    found = hookean.load_cases(Scene.read(scene))
    assert "arm moment My: largest 3 N m at element 0 in b" in found.envelope.summary()
    assert "cloth warp: largest 2 N/m at element 0 in a" in found.envelope.summary()
    said = found.cases["b"].result.summary()
    assert any(line.startswith("arm (beam): ") and line.endswith("moments up to 3 N m") for line in said)
    assert "cloth (membrane): 4 elements, warp 2 to 2 N/m, weft 1 to 1 N/m" in said


def test_warmth_lengthens_a_cable() -> None:
    """Between its ends a cable of EA = 2000 keeps its length: T' = EA (l / (L0 (1 + a dT)) - 1), L0 = l EA / (EA + T).
    With snow on it, it is the cable of that tension at rest, and its sag has a closed form."""
    found = hookean.load_cases(Scene.read(cable(**WARM)))

    def tension(prestress: float, degrees: float) -> float:
        return (EA + prestress) / (1.0 + 1.2e-5 * degrees) - EA

    np.testing.assert_allclose(found.cases["warm"].result.force("cable")["force"], tension(T, 40.0), rtol=1e-12)
    z, pull = sag(10.0, tension(1.1 * T, 60.0))
    case = found.cases["both"]
    np.testing.assert_allclose(case.displacements[1], [0.0, 0.0, -z], atol=1e-6 * L)
    np.testing.assert_allclose(case.result.force("cable")["force"], pull, rtol=1e-5)


def test_what_has_no_thermal_expansion_is_one_sentence() -> None:
    stages = cable()["stages"]
    with pytest.raises(InputError, match="/load_cases/warm/temperature/cable: cable has no thermal expansion; give"):
        hookean.load_cases(Scene.read(cable(**{**WARM, "stages": stages})), ["warm"])


LOADS = [kind for kind, cls in KINDS.items() if cls.role == "load" and not cls.momentary]


@pytest.mark.parametrize("kind", LOADS)
def test_a_load_times_a_factor_is_that_times_its_force(kind: str) -> None:
    """Of every load there is, at its example: the fields whose unit begins with force are its magnitudes."""
    force, x = KINDS[kind].example()
    assert magnitudes(KINDS[kind])

    def pull(load: Any) -> np.ndarray:
        meshes = {load.mesh: hookean.MeshData(vertices=x, faces=faces(load))} if getattr(load, "mesh", None) else {}
        system = compile(Scene(particles=x, forces=[load], meshes=meshes, weld_tolerance=0.0))
        return system.evaluate(system.start())[0]

    before = pull(force)
    assert np.abs(before).max() > 0.0
    factor = 1.5 if kind == "wind" else -1.5  # a negative pressure has no speed: the direction turns round instead
    np.testing.assert_allclose(pull(scaled(force, factor)), factor * before, rtol=1e-12, atol=1e-15)
    assert scaled(force, 1.0) is force


def test_the_weight_of_a_material_is_multiplied_too() -> None:
    """It has no field of its own in units of force."""
    spec = {**cable(), "sections": {"rod": {"area": 0.01}}}
    own: Spec = {"particles": [[0, 1]], "material": "S355", "section": "rod"}
    pulls = []
    for factor in (1.0, -1.5):
        load = scaled(hookean.SelfWeight(**own), factor)
        system = compile(Scene(particles=spec["particles"], sections=spec["sections"], forces=[load]))
        pulls.append(system.evaluate(system.start())[0])
    assert np.abs(pulls[0]).max() > 0.0
    np.testing.assert_allclose(pulls[1], -1.5 * pulls[0], rtol=1e-14)


def test_ties_and_struts_stay_so_when_they_are_frozen() -> None:
    """A cable with EA and a force, slack below its rest length, and a strut: frozen they have the stiffness, the rest
    length and the one side that they had."""
    spec = cable(stages={})
    spec["forces"][0] = {
        "kind": "springs", "name": "cable", "particles": [[0, 1], [1, 2]], "axial_stiffness": EA, "force": T,
        "tension_only": True,
    }  # fmt: skip
    spec["forces"].append({"kind": "springs", "name": "prop", "particles": [[0, 2]], "compression_only": True})
    frozen = freeze(Scene.read(spec)).scene
    tie, prop = frozen.forces[0], frozen.forces[-1]
    assert tie.tension_only and not tie.compression_only and prop.compression_only
    rest = L / 2 * EA / (EA + T)
    assert tie.rest_length == pytest.approx([rest, rest], rel=1e-9)
    assert tie.stiffness == pytest.approx([EA / rest, EA / rest], rel=1e-9)


def faces(load: Any) -> list[list[int]]:
    return [[0, 1, 2], [0, 2, 3]] if load is not None else []


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"load_cases": {"snow": {"forces": ["snow"]}}}, "/load_cases/snow/forces/0: no load is called 'snow'"),
        ({"load_cases": {"s": {"forces": ["cable"]}}}, "'cable' is not a load"),
        ({"load_cases": {"s": {}}}, "/load_cases/s: neither forces nor temperature given"),
        (
            {"load_cases": {"s": {"temperature": {"snow load": 5}}}},
            "'snow load' names no springs, lines of constant tension, beams or membranes; the scene has cable",
        ),
        ({"load_cases": {"permanent": {"forces": ["unary"]}}}, "is a reserved name"),
        ({"combinations": {"ULS": {"fog": 1.0}}}, "/combinations/ULS/fog: no load case is called 'fog'"),
        ({"combinations": {"snow": {"snow": 1.0}}}, "a load case has this name, too"),
        ({"stages": {"freeze": {"net": {}}}}, "/stages/freeze/net: no force is called 'net'"),
        ({"stages": {"freeze": {"snow load": {}}}}, "'snow load' names no springs or lines of constant tension"),
        ({"stages": {"films": {"cable": {"warp_stiffness": 1.0}}}}, "/stages/films/cable: no film is called 'cable'"),
        ({"stages": {"films": {"cable": {}}}}, "/stages/films/cable: its stiffness is missing"),
    ],
)
def test_faults_in_a_scene_are_one_sentence(change: Spec, said: str) -> None:
    with pytest.raises(InputError, match=said):
        Scene.read(cable(**change))


def test_what_cannot_be_frozen_is_one_sentence() -> None:
    for spec, said in [
        (cable(stages=None), "keep their tension at any length; give their EA"),
        (cable(stages={"freeze": {"cable": {"axial_stiffness": [1.0, 2.0, 3.0]}}}), "3 values of axial_stiffness"),
    ]:
        with pytest.raises(InputError, match=said):
            hookean.freeze(Scene.read(spec))
    spec = cable()
    spec["forces"][0] = {"kind": "springs", "name": "cable", "particles": [[0, 1], [1, 2]], "rest_factor": 0.0}
    spec["stages"] = None
    with pytest.raises(InputError, match="have no rest length; give their EA"):
        hookean.freeze(Scene.read(spec))
    with pytest.raises(InputError, match="film keeps its stress at any strain; give the cloth that it becomes"):
        hookean.freeze(Scene.read({**formed(4), "stages": {}}))
    with pytest.raises(InputError, match="'rain' is not a load case or combination; the scene has snow, wind"):
        hookean.load_cases(Scene.read(cable()), ["rain"])
    with pytest.raises(InputError, match="the scene has none"):
        hookean.load_cases(Scene.read(cable(load_cases={}, combinations={})))


def test_forces_that_are_not_elastic_are_noted() -> None:
    spec = cable()
    spec["forces"].append({"kind": "equal_length", "particles": [[0, 1], [1, 2]]})
    notes = hookean.freeze(Scene.read(spec)).notes
    assert len(notes) == 1 and notes[0].startswith("/forces/3: equal_length is not elastic")


def test_a_drawn_form_is_the_start_shape() -> None:
    spec = mast()
    spec["stages"]["form"] = "drawn"
    spec["particles"][1] = [0.5, 0, 4]
    frozen = hookean.freeze(Scene.read(spec))
    np.testing.assert_array_equal(frozen.particles[1], [0.5, 0.0, 4.0])


def test_beams_keep_their_form_and_their_rotations() -> None:
    """A cantilever of beams under a load of a case: the frozen form does not move, the case bends it by P L³ / (3 E I),
    and by nothing else: 1e-4 of it, as the sag is 0.4 % of the length."""
    spec = {
        "particles": [[0.5 * i, 0, 0] for i in range(5)],
        "forces": [
            {"kind": "beam", "particles": [[i, i + 1] for i in range(4)], "E": 2e9, "G": 1e9, "A": 1e-2,
             "Iy": 1e-5, "Iz": 1e-5, "J": 1e-5},
            {"kind": "unary", "name": "tip", "particles": [4], "vector": [0, 0, -60]},
        ],
        "anchors": [{"particles": [0], "rotations": "xyz"}],
        "load_cases": {"down": {"forces": ["tip"]}},
        "stages": {},
    }  # fmt: skip
    found = hookean.load_cases(Scene.read(spec))
    moved = found.cases["down"].displacements
    assert moved.shape == (5, 3)
    assert moved[4, 2] == pytest.approx(-60 * 2.0**3 / (3 * 2e9 * 1e-5), rel=1e-4)
