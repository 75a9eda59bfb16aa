"""Utilisation of cables, beams and cloth: closed forms; of frozen cables, limits and envelopes."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import hookean
from hookean import InputError, Scene, relax
from hookean.files import limits as limit_file
from hookean.files import tables
from hookean.files.report import report
from hookean.system.system import compile

ROPE = {"shape": "rope", "diameter": 0.02, "fill_factor": 0.75}
BREAKS = 0.75 * np.pi * 0.02**2 / 4.0 * 1570e3  # kN: fill factor x circle x 1570 MPa


def cable(**stage: Any) -> dict[str, Any]:
    """A straight cable of constant tension [kN] and what it is frozen to, with snow on its middle."""
    return {
        "units": {"force": "kN"},
        "particles": [[0, 0, 0], [2, 0, 0], [4, 0, 0]],
        "sections": {"rope": ROPE},
        "forces": [
            {"kind": "constant_tension", "name": "cable", "particles": [[0, 1], [1, 2]], "tension": 30},
            {"kind": "unary", "name": "snow load", "particles": [1], "vector": [0, 0, -10.0]},
        ],
        "anchors": [{"particles": [0, 2]}],
        "load_cases": {"snow": {"forces": ["snow load"]}},
        "stages": {"freeze": {"cable": stage}},
    }


@pytest.mark.parametrize(
    ("stage", "breaks"),
    [
        ({"material": "spiral strand 1570", "section": "rope"}, BREAKS),
        ({"axial_stiffness": 35e3, "strength": 400.0}, 400.0),
    ],
)
def test_a_frozen_cable_has_its_tension_over_its_breaking_force(stage: Any, breaks: float) -> None:
    found = hookean.load_cases(Scene.read(cable(**stage)))
    own = found.cases["snow"].result.force("cable")
    assert own["force"].min() > 30.0
    np.testing.assert_allclose(own["utilisation"], own["force"] / breaks, rtol=1e-14)
    extremes = found.envelope.forces[0]["columns"]["utilisation"]
    np.testing.assert_array_equal(extremes.largest, own["utilisation"])
    assert f"utilisation up to {100 * own['utilisation'].max():.4g} %" in "\n".join(found.summary())
    assert own["utilisation"][0] == found.cases["snow"].result.table("cable")[0]["utilisation [-]"]


def test_a_material_gives_the_frozen_cable_its_stiffness() -> None:
    frozen = hookean.freeze(Scene.read(cable(material="spiral strand 1570", section="rope")))
    force: Any = frozen.scene.forces[0]
    np.testing.assert_allclose(force.stiffness * force.rest_length, 150e6 * BREAKS / 1570e3, rtol=1e-14)


AREA = BREAKS / 1570e3


@pytest.mark.parametrize(
    "stage",
    [
        {"material": "spiral strand 1570", "section": "rope"},
        {"axial_stiffness": 35e3, "section": "rope", "strength": 400.0},
        {"axial_stiffness": 35e3, "section": "rope"},
    ],
)
def test_a_frozen_cable_of_a_section_has_its_stress(stage: Any) -> None:
    """T / A, of each case and as an extreme; without a strength, the report names the missing utilisation."""
    scene = Scene.read(cable(**stage))
    found = hookean.load_cases(scene)
    own = found.cases["snow"].result.force("cable")
    np.testing.assert_allclose(own["stress"], own["force"] / AREA, rtol=1e-14)
    np.testing.assert_array_equal(found.envelope.forces[0]["columns"]["stress"].largest, own["stress"])
    known = "utilisation" in own
    assert known is (len(stage) == 3 or "material" in stage)
    said = "<p>cable has no utilisation: give its strength.</p>"
    assert (said in report(scene, pictures=False, cases=found)) is not known


def test_springs_keep_their_section_when_they_are_frozen() -> None:
    """Bars of a material and a section, and of EA with a section; the report names what has none of them."""
    spec = cable()
    bars = {"kind": "springs", "particles": [[0, 1], [1, 2]], "force": 1.0, "section": "rope"}
    spec["forces"] += [{**bars, "name": "steel", "material": "spiral strand 1570"},
                       {**bars, "name": "bar", "axial_stiffness": 5e3},
                       {"kind": "springs", "name": "tie", "particles": [[0, 1]], "axial_stiffness": 1.0}]  # fmt: skip
    spec["stages"]["freeze"]["cable"] = {"axial_stiffness": 1e3}
    scene = Scene.read(spec)
    found = hookean.load_cases(scene)
    for name in ("steel", "bar"):
        own = found.cases["snow"].result.force(name)
        np.testing.assert_allclose(own["stress"], own["force"] / AREA, rtol=1e-14)
        assert ("utilisation" in own) is (name == "steel")
    text = report(scene, pictures=False, cases=found)
    for name in ("cable", "tie"):
        assert f"<p>{name} has no stress and no utilisation: give its section and strength.</p>" in text
    assert "<p>bar has no utilisation: give its strength.</p>" in text and "<p>steel has no" not in text


def test_a_sliding_cable_of_an_area_has_its_stress() -> None:
    """One with EA and a section beside it; a section that does not exist is refused."""
    spec = cable()
    spec["forces"][0] = {"kind": "sliding_cable", "name": "rope", "particles": [[0, 1], [1, 2]],
                         "axial_stiffness": 1e3, "force": 30.0, "section": "rope"}  # fmt: skip
    spec |= {"load_cases": {}, "stages": None, "settings": {"tolerance": 1e-12}}
    own = relax(Scene.read(spec)).force("rope")
    np.testing.assert_allclose(own["stress"], own["force"] / AREA, rtol=1e-14)
    spec["forces"][0]["section"] = "bar"
    with pytest.raises(InputError, match="section 'bar' does not exist"):
        relax(Scene.read(spec))


@pytest.mark.parametrize(
    ("stage", "said"),
    [
        ({"material": "S355"}, "material given without a section"),
        ({"axial_stiffness": 1.0, "section": "bar"}, "section 'bar' does not exist"),
        ({"material": "S355", "section": "rope", "axial_stiffness": 1.0}, "axial_stiffness and material given"),
        ({"material": "S35", "section": "rope"}, 'material "S35" does not exist; did you mean S355'),
        ({"material": "S355", "section": "bar"}, "section 'bar' does not exist"),
    ],
)
def test_stages_that_cannot_be_are_refused(stage: Any, said: str) -> None:
    with pytest.raises(InputError, match=said):
        hookean.freeze(Scene.read(cable(**stage)))


def test_a_cantilever_uses_axial_force_and_bending() -> None:
    """N / (A f) + M / (W f), M = P l at the clamp, of a small deflection (EN 1993-1-1, 6.2.1(7), linear summation)."""
    diameter, thickness, f, load = 0.1, 0.005, 355e6, 10.0
    scene = Scene.read({
        "particles": [[0, 0, 0], [1, 0, 0], [2, 0, 0]],
        "sections": {"tube": {"shape": "tube", "diameter": diameter, "thickness": thickness}},
        "forces": [
            {"kind": "beam", "particles": [[0, 1], [1, 2]], "material": "S355", "section": "tube"},
            {"kind": "unary", "particles": [2], "vector": [50.0, 0, -load]},
        ],
        "anchors": [{"particles": [0], "rotations": "xyz"}],
        "settings": {"tolerance": 1e-10},
    })  # fmt: skip
    area = np.pi * thickness * (diameter - thickness)
    modulus = np.pi / 64 * (diameter**4 - (diameter - 2 * thickness) ** 4) / (diameter / 2)
    expected = [50.0 / area + 2.0 * load / modulus, 50.0 / area + 1.0 * load / modulus]
    # the tip falls by P l^3 / 3EI = 7e-5 m, so that 50 N have a moment of 4e-3 N m of 20 N m
    np.testing.assert_allclose(relax(scene).force("beam")["utilisation"], np.array(expected) / f, rtol=5e-4)


def test_moments_about_both_axes_count_where_they_meet() -> None:
    """A clamped beam with a force along y and a moment about y at its end, which is held along z: My is 0.9 there and
    -0.45 at the clamp (a propped cantilever carries half of it over, Timoshenko), Mz 1 at the clamp and 0 at the end.
    The clamp uses 0.45 + 1, the end 0.9 of W f = 1."""
    scene = Scene.read({
        "particles": [[0, 0, 0], [1, 0, 0]],
        "materials": {"m": {"E": 1e6, "G": 4e5, "strength": 10.0}},
        "sections": {"s": {"area": 1.0, "Iy": 1.0, "Iz": 1.0, "J": 1.0, "Wy": 0.1, "Wz": 0.1}},
        "forces": [
            {"kind": "beam", "particles": [[0, 1]], "material": "m", "section": "s"},
            {"kind": "unary", "particles": [1], "vector": [0, 1.0, 0], "moment": [0, 0.9, 0]},
        ],
        "anchors": [{"particles": [0], "rotations": "xyz"}, {"particles": [1], "axes": "z"}],
        "settings": {"tolerance": 1e-10},
    })  # fmt: skip
    # angles of 1e-6 rad, of which N is 1e-6 of W f
    assert relax(scene).force("beam")["utilisation"] == pytest.approx([1.45], rel=1e-5)


@pytest.mark.parametrize(
    ("section", "by_force", "by_y", "by_z", "corners"),
    [
        ({"shape": "rod", "diameter": 0.2}, 100 / np.pi, 4000 / np.pi, 4000 / np.pi, False),
        ({"shape": "tube", "diameter": 0.2, "thickness": 0.05}, 400 / 3 / np.pi, 12800 / 3 / np.pi,
         12800 / 3 / np.pi, False),
        ({"shape": "rectangle", "width": 0.1, "height": 0.2}, 50.0, 1500.0, 3000.0, True),
        ({"shape": "I", "width": 0.2, "height": 0.2, "flange_thickness": 0.05, "web_thickness": 0.1}, 100 / 3,
         1 / 1.25e-3, 1 / 0.75e-3, True),
    ],
)  # fmt: skip
def test_a_section_bends_about_both_axes(
    section: Any, by_force: float, by_y: float, by_z: float, corners: bool
) -> None:
    """Stresses by N, My and Mz = (3, 4) l at a clamp: at a corner they add up, a round section has the stress of the
    one moment 5 l. Closed forms 1 / A and 1 / W; deflections of 1e-7 l change the moments by less than 1e-6."""
    scene = Scene.read({
        "particles": [[0, 0, 0], [1, 0, 0]],
        "sections": {"s": section},
        "forces": [
            {"kind": "beam", "particles": [[0, 1]], "material": "S355", "section": "s"},
            {"kind": "unary", "particles": [1], "vector": [7.0, 4.0, -3.0]},
        ],
        "anchors": [{"particles": [0], "rotations": "xyz"}],
        "settings": {"tolerance": 1e-10},
    })  # fmt: skip
    bent = 3.0 * by_y + 4.0 * by_z if corners else 5.0 * by_y
    found = relax(scene)
    assert found.force("beam")["stress"] == pytest.approx([7.0 * by_force + bent], rel=1e-5)
    assert found.force("beam")["utilisation"] == pytest.approx(found.force("beam")["stress"] / 355e6, rel=1e-14)
    assert list(found.table("beam")[0])[-2:] == ["stress [N/m^2]", "utilisation [-]"]


def test_lines_with_a_section_have_their_stress_with_its_sign() -> None:
    """A bar of 2 cm^2 under 3 kN, pulled and pushed: 15 MPa, of a material without strength; of EA it is not known."""
    scene = {
        "units": {"length": "cm", "force": "kN"},
        "particles": [[0, 0, 0], [10, 0, 0], [20, 0, 0]],
        "materials": {"m": {"E": 2e4}},
        "sections": {"s": {"area": 2.0}},
        "forces": [{"kind": "unary", "particles": [1], "vector": [6.0, 0, 0]}],
        "anchors": [{"particles": [0, 2]}, {"particles": [1], "axes": "yz"}],
        "settings": {"tolerance": 1e-11},
    }
    bar = {"kind": "springs", "name": "bar", "particles": [[0, 1], [1, 2]]}
    made = Scene.read({**scene, "forces": [{**bar, "material": "m", "section": "s"}, *scene["forces"]]})
    found = relax(made)
    assert found.force("bar")["stress"] == pytest.approx([1.5, -1.5], rel=1e-9) and "utilisation" not in found.force(
        "bar"
    )
    heads = list(tables.rows(tables.sections(compile(made), found), found)[0])
    assert "stress [kN/cm^2]" in heads
    other = relax(Scene.read({**scene, "forces": [{**bar, "axial_stiffness": 4e4}, *scene["forces"]]}))
    assert "stress" not in other.force("bar")


def test_cloth_uses_its_warp_or_its_weft() -> None:
    """Held all round, cloth has its prestress: 3 of 88 kN/m along the warp, 4 of 79 kN/m along the weft."""
    scene = Scene.read({
        "particles": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]],
        "meshes": {"m": {"vertices": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], "faces": [[0, 1, 2, 3]]}},
        "forces": [{"kind": "membrane", "mesh": "m", "material": "PVC-polyester II", "warp": [1, 0, 0],
                    "prestress": [3e3, 4e3, 0]}],
        "anchors": [{"particles": [0, 1, 2, 3]}],
    })  # fmt: skip
    np.testing.assert_allclose(relax(scene).force("membrane")["utilisation"], 4.0 / 79.0, rtol=1e-12)


def test_a_limit_on_utilisation_names_the_element_or_what_is_missing() -> None:
    case = hookean.load_cases(Scene.read(cable(material="spiral strand 1570", section="rope"))).cases["snow"].result
    assert case.scene is not None
    system = compile(case.scene)
    parts, used = tables.sections(system, case), case.force("cable")["utilisation"].max().item()

    def exceeded(most: float) -> list[str]:
        limits = limit_file.read_limits(f"[force.cable]\nmax_utilisation = {most!r}")
        return limit_file.exceeded(limits, parts, system, case)

    assert exceeded(used * 1.001) == []
    said = f"force cable: max utilisation {used:.6g} at element 0 of cable exceeds the limit {used / 2:g}"
    assert exceeded(used / 2) == [said]
    with pytest.raises(InputError, match="no element has a known strength"):
        limit_file.exceeded(limit_file.read_limits('[force."snow load"]\nmax_utilisation = 1.0'), parts, system, case)


def test_stress_and_moment_have_limits() -> None:
    """A cantilever of 2 m under 10 N has 20 N m at its clamp, and a stress of that over W = 1e-3."""
    scene = Scene.read({
        "particles": [[0, 0, 0], [2, 0, 0], [0, 1, 0], [1, 1, 0]],
        "materials": {"m": {"E": 1e9, "G": 4e8}},
        "sections": {"s": {"area": 1.0, "Iy": 1.0, "Iz": 1.0, "J": 1.0, "Wy": 1e-3, "Wz": 1e-3}},
        "forces": [
            {"kind": "beam", "name": "arm", "particles": [[0, 1]], "material": "m", "section": "s"},
            {"kind": "unary", "particles": [1], "vector": [0, 0, -10.0]},
            {"kind": "springs", "name": "wire", "particles": [[2, 3]]},
        ],
        "anchors": [{"particles": [0], "rotations": "xyz"}, {"particles": [2, 3]}],
        "settings": {"tolerance": 1e-10},
    })  # fmt: skip
    found, system = relax(scene), compile(scene)
    parts = tables.sections(system, found)

    def said(text: str) -> list[str]:
        return limit_file.exceeded(limit_file.read_limits(text), parts, system, found)

    assert said("max_moment = 20.1\nmax_stress = 20100") == []
    assert said("max_moment = 19") == ["model: max moment 20 N m at element 0 of arm exceeds the limit 19 N m"]
    [stress] = said('max_stress = 1.9\nunits = {length = "cm"}')
    assert stress == "model: max stress 2 N/cm^2 at element 0 of arm exceeds the limit 1.9 N/cm^2"
    for limit, words in (("max_stress", "no element has a known section"), ("max_moment", "no element is a beam")):
        with pytest.raises(InputError, match=words):
            said(f"[force.wire]\n{limit} = 1")
