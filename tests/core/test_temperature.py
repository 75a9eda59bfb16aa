"""Changes of temperature of beams and membranes against closed forms: a = expansion x degrees."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean import InputError, Scene, load_cases, relax

STEEL = {"E": 200e9, "G": 80e9, "density": 7850.0, "expansion": 1.2e-5}
PLATE = {"E": 70e9, "poisson": 0.3, "density": 2700.0, "expansion": 2.3e-5}
ROD = {"shape": "rod", "diameter": 0.1}
AREA, INERTIA = np.pi * 0.05**2, np.pi * 0.05**4 / 4
LENGTH, COUNT = 4.0, 16
SHARED = ("name", "particles", "material", "section", "temperature")  # fields of beams that springs have, too


def column(degrees: Any, *, ends: str, **more: Any) -> Scene:
    """A horizontal rod of steel of 16 beams; `ends` "both": its ends are pinned, "one": its start is clamped."""
    points = [[x, 0.0, 0.0] for x in np.linspace(0.0, LENGTH, COUNT + 1)]
    beam = {"kind": "beam", "name": "rod", "particles": [[i, i + 1] for i in range(COUNT)], "normal": [0, 0, 1]}
    anchors = {
        "both": [{"particles": [0, COUNT], "axes": "xyz", "rotations": "x"}],
        "one": [{"particles": [0], "axes": "xyz", "rotations": "xyz"}],
    }
    return Scene.read(
        {
            "particles": points,
            "materials": {"steel": STEEL},
            "sections": {"rod": ROD},
            "forces": [{**beam, "material": "steel", "section": "rod", "temperature": degrees}],
            "anchors": anchors[ends],
            "settings": {"tolerance": 1e-11},
            **more,
        }
    )


@pytest.mark.parametrize("degrees", [-40.0, 25.0])
def test_a_heated_cantilever_grows_without_force(degrees: float) -> None:
    """Its end moves by a L, to three times the position error that the result states, and rounding of 4 m; no force is
    left but that of as much movement."""
    result = relax(column(degrees, ends="one"))
    assert result.status == "converged"
    far = 3 * result.position_error + 1e-14
    assert far < 1e-9
    assert result.particles[-1] == pytest.approx([LENGTH * (1 + 1.2e-5 * degrees), 0.0, 0.0], abs=far)
    assert np.abs(result.forces[0]["force"]).max() <= 2 * far * 200e9 * AREA / (LENGTH / COUNT)


def test_a_rod_between_supports_is_stressed() -> None:
    """Cooled by 30 K: N = -EA a / (1 + a), as each beam is stretched by -a of a length of 1 + a."""
    growth = 1.0 - 1.2e-5 * 30.0
    result = relax(column(-30.0, ends="both"))
    assert result.forces[0]["force"] == pytest.approx(200e9 * AREA * (1.0 - growth) / growth, rel=1e-9)


def test_a_rod_buckles_at_its_critical_temperature() -> None:
    """Euler: EA a = pi^2 EI / L^2, so a = pi^2 I / (A L^2) = 3.9e-4, but for parts of the size of a itself (how long
    the rod is then) and of the angle of one beam to the fourth, (pi / 16)^4 / 720 = 2e-6: at 0.998 of it the rod is
    stable and at 1.002 not."""
    critical = np.pi**2 * INERTIA / (AREA * LENGTH**2)
    for a, wanted in ((0.998 * critical, "stable"), (1.002 * critical, "unstable")):
        found = relax(column(a / 1.2e-5, ends="both", settings={"allow_unstable": True}))
        assert (found.status, found.stability) == ("converged", wanted), a


def test_each_beam_has_its_own_temperature() -> None:
    """Of a cantilever half the beams are heated: its end moves by half as much, to the position error as above."""
    degrees = [60.0] * (COUNT // 2) + [0.0] * (COUNT // 2)
    result = relax(column(degrees, ends="one"))
    far = 3 * result.position_error + 1e-14
    assert result.particles[-1, 0] == pytest.approx(LENGTH * (1 + 0.5 * 1.2e-5 * 60.0), abs=far)


def sheet(degrees: float | None, *, held: bool, **more: Any) -> Scene:
    """A square sheet of aluminium, 1 x 1 m, 2 mm thick; its edge is held, or only as far as it may not move away."""
    side = np.linspace(0.0, 1.0, 5)
    vertices = [[x, y, 0.0] for y in side for x in side]
    edge = [p for p in vertices if p[0] in (0.0, 1.0) or p[1] in (0.0, 1.0)]
    flat = [{"points": vertices, "axes": "z"}, {"points": [p for p in vertices if p[0] == 0.0], "axes": "x"}]
    faces = [[5 * j + i, 5 * j + i + 1, 5 * j + i + 6, 5 * j + i + 5] for j in range(4) for i in range(4)]
    cloth = {"kind": "membrane", "mesh": "sheet", "material": "plate", "thickness": 0.002, "temperature": degrees}
    return Scene.read(
        {
            "meshes": {"sheet": {"vertices": vertices, "faces": faces}},
            "materials": {"plate": PLATE},
            "forces": [{k: v for k, v in cloth.items() if v is not None}],
            "anchors": [{"points": vertices, "axes": "z"}, {"points": edge}]
            if held
            else [*flat, {"points": [p for p in vertices if p[1] == 0.0], "axes": "y"}],
            "settings": {"tolerance": 1e-11},
            **more,
        }
    )


def test_a_cooled_sheet_in_a_frame_is_stressed() -> None:
    """The same in all directions: -E t (a + a^2/2) / (1 - nu)."""
    a = -2.3e-5 * 20.0
    result = relax(sheet(-20.0, held=True))
    wanted = -70e9 * 0.002 * (a + 0.5 * a * a) / 0.7
    assert result.forces[0]["warp"] == pytest.approx(wanted, rel=1e-9)
    assert result.forces[0]["weft"] == pytest.approx(wanted, rel=1e-9)


def test_a_free_sheet_grows_without_stress() -> None:
    """Every particle moves away from the corner by a times its distance, to the position error as above."""
    start = sheet(35.0, held=False)
    result = relax(start)
    grown = np.array(start.meshes["sheet"].vertices) * (1 + 2.3e-5 * 35.0)
    np.testing.assert_allclose(result.particles, grown, atol=3 * result.position_error + 1e-14)


@pytest.mark.parametrize("kind", ["beam", "membrane"])
def test_load_cases_change_the_temperature(kind: str) -> None:
    """A case of -20 K with the factor 1.5 is a scene of -30 K."""
    case = {"load_cases": {"winter": {"temperature": {kind: -20.0}, "factor": 1.5}}}
    if kind == "beam":
        found, wanted = load_cases(column(None, ends="both", **case)), relax(column(-30.0, ends="both"))
        name = "force"
    else:
        found, wanted = load_cases(sheet(None, held=True, **case)), relax(sheet(-30.0, held=True))
        name = "warp"
    assert found.cases["winter"].result.forces[0][name] == pytest.approx(wanted.forces[0][name], rel=1e-9)


@pytest.mark.parametrize("kind", ["springs", "beam", "membrane"])
def test_the_temperature_of_a_case_adds_to_that_of_the_form(kind: str) -> None:
    """Thermal strains add: a form cooled by 4,000 K and a case of 3,000 K are a model cooled by 7,000 K. If growths
    were multiplied they would differ by a^2 4,000 x 3,000, 2e-3 of the length, and the force by as much of EA."""
    name = "membrane" if kind == "membrane" else "rod"
    case = {"load_cases": {"cold": {"temperature": {name: -3000.0}}}}
    if kind == "membrane":
        found, wanted = load_cases(sheet(-4000.0, held=True, **case)), relax(sheet(-7000.0, held=True))
    else:
        one, other = column(-4000.0, ends="both", **case), column(-7000.0, ends="both")
        if kind == "springs":
            own = [{k: v for k, v in s.forces[0].model_dump().items() if k in SHARED} for s in (one, other)]
            along = [{"particles": list(range(COUNT + 1)), "axes": "yz"}, {"particles": [0, COUNT]}]
            one, other = (
                Scene.read({**s.model_dump(mode="json"), "forces": [{**f, "kind": kind}], "anchors": along})
                for s, f in zip((one, other), own, strict=True)
            )
        found, wanted = load_cases(one), relax(other)
    measure = "warp" if kind == "membrane" else "force"
    got = found.cases["cold"].result.forces[0][measure]
    assert got == pytest.approx(wanted.forces[0][measure], rel=1e-9)


def test_what_has_no_expansion_has_no_temperature() -> None:
    """A sentence, by the scene itself and by a load case."""
    plain = {"kind": "beam", "particles": [[0, 1]], "E": 1.0, "G": 1.0, "A": 1.0, "Iy": 1.0, "Iz": 1.0, "J": 1.0}
    scene = {"particles": [[0, 0, 0], [1, 0, 0]], "forces": [{**plain, "temperature": 5.0}]}
    with pytest.raises(InputError, match="temperature needs a material with expansion"):
        relax(Scene.read({**scene, "anchors": [{"particles": [0], "rotations": "xyz"}]}))
    with pytest.raises(InputError, match="has no thermal expansion; give it, or freeze it to, a material"):
        load_cases(
            Scene.read(
                {
                    **scene,
                    "forces": [plain],
                    "anchors": [{"particles": [0], "rotations": "xyz"}],
                    "load_cases": {"summer": {"temperature": {"beam": 30.0}}},
                }
            )
        )
    with pytest.raises(InputError, match="leaves no length"):
        relax(column(-1e5, ends="one"))


def test_a_film_that_becomes_cloth_has_a_temperature() -> None:
    """A flat film in a square frame, frozen to cloth of E t and nu = 0.3: 20 K less add -E t (a + a^2/2) / (1 - nu) to
    its tension in all directions."""
    cloth = {"material": "plate", "thickness": 0.002}
    film = {"kind": "soapfilm", "name": "roof", "mesh": "sheet", "tension": 500.0}
    cases = {"stages": {"films": {"roof": cloth}}, "load_cases": {"winter": {"temperature": {"roof": -20.0}}}}
    scene = sheet(None, held=True, forces=[film], **cases)
    a = -2.3e-5 * 20.0
    wanted = 500.0 - 70e9 * 0.002 * (a + 0.5 * a * a) / 0.7
    found = load_cases(scene).cases["winter"].result.forces[0]
    assert found["warp"] == pytest.approx(wanted, rel=1e-9) and found["weft"] == pytest.approx(wanted, rel=1e-9)


def test_a_rope_is_named_by_its_kind() -> None:
    """Of constant tension when the form is found, it is named so in its load cases: N = (T - EA a) / (1 + a)."""
    found = load_cases(rope(30.0)).cases["warm"].result.forces[0]["force"]
    a = 1.2e-5 * 30.0
    assert found == pytest.approx((1e6 - 200e9 * AREA * a) / (1 + a), rel=1e-9)


def rope(degrees: float) -> Scene:
    """Two pieces under 1 MN between supports 2 m apart, frozen to rods of steel; a load case changes their
    temperature."""
    return Scene.read(
        {
            "particles": [[0, 0, 0], [1, 0, 0], [2, 0, 0]],
            "materials": {"steel": STEEL},
            "sections": {"rod": ROD},
            "forces": [{"kind": "constant_tension", "particles": [[0, 1], [1, 2]], "tension": 1e6}],
            "anchors": [{"particles": [0, 2]}],
            "stages": {"freeze": {"constant_tension": {"material": "steel", "section": "rod"}}},
            "load_cases": {"warm": {"temperature": {"constant_tension": degrees}}},
        }
    )


def test_changes_of_temperature_that_cannot_be_are_one_sentence() -> None:
    """Two for one force; more than its length."""
    twice = {"load_cases": {"winter": {"temperature": {"rod": -20.0, "beam": -10.0}}}}
    with pytest.raises(InputError, match="'beam' and 'rod' name the same force"):
        column(None, ends="both", **twice)
    with pytest.raises(InputError, match="temperature"):
        sheet(1e300, held=True)
    with pytest.raises(InputError, match="leaves no length of springs"):
        load_cases(rope(-1e5))
