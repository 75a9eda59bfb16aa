"""Membranes: patch tests, tension fields, Hencky's film, the square airbag, and what they are made of."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.spatial import Delaunay

from hookean import InputError, Membrane, Result, Scene, relax
from hookean.compiled import dispatch
from hookean.discretize import grid
from hookean.forces.tension_field import SLACK, TAUT, WRINKLED, respond
from hookean.system.system import compile

from .film_meshes import concentric

EPS = float(np.finfo(float).eps)
CLOTH = {"warp_stiffness": 600.0, "weft_stiffness": 450.0, "shear_stiffness": 30.0, "poisson": 0.3}


def compliance(warp_stiffness: float, weft_stiffness: float, shear_stiffness: float, poisson: float) -> np.ndarray:
    """C^-1 of a cloth, of stresses (S11, S22, S12)."""
    cross = -poisson / warp_stiffness
    return np.array([[1 / warp_stiffness, cross, 0], [cross, 1 / weft_stiffness, 0], [0, 0, 1 / shear_stiffness]])


def stressed(deformation: Any, **cloth: float) -> np.ndarray:
    """Stress per width as it is (2, 2), along the warp at x and across it, of a plane deformation gradient."""
    f = np.asarray(deformation, dtype=float)
    green = 0.5 * (f.T @ f - np.eye(2))
    s = np.linalg.solve(compliance(**{**CLOTH, **cloth}), [green[0, 0], green[1, 1], 2.0 * green[0, 1]])
    true = f @ np.array([[s[0], s[2]], [s[2], s[1]]]) @ f.T / np.linalg.det(f)
    along = f[:, 0] / np.linalg.norm(f[:, 0])
    frame = np.array([along, [-along[1], along[0]]])
    return np.asarray(frame @ true @ frame.T)


def patch(count: int = 20, seed: int = 3) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """An irregular mesh of the unit square, and its rim."""
    rng = np.random.default_rng(seed)
    side = np.linspace(0.0, 1.0, 5)
    rim = np.array([(a, b) for a in side for b in side if a in (0, 1) or b in (0, 1)])
    points = np.vstack([rim, rng.uniform(0.15, 0.85, (count, 2))])
    return np.column_stack([points, np.zeros(len(points))]), Delaunay(points).simplices, np.arange(len(rim))


def turned(vectors: np.ndarray) -> np.ndarray:
    """Out of the plane z = 0 into a slanting one."""
    angle = np.radians([20.0, 50.0])
    c, s = np.cos(angle), np.sin(angle)
    return vectors @ (
        np.array([[c[0], s[0], 0], [-s[0], c[0], 0], [0, 0, 1]]) @ [[1, 0, 0], [0, c[1], s[1]], [0, -s[1], c[1]]]
    )


@pytest.mark.parametrize(
    "deformation",
    [[[1.05, 0], [0, 1.0]], [[1.03, 0], [0, 1.02]], [[1.02, 0.04], [0, 1.02]]],
    ids=["uniaxial", "biaxial", "shear"],
)
def test_a_patch_has_the_same_stress_everywhere(deformation: Any) -> None:
    """Its rim moved as a whole, an irregular patch of orthotropic cloth in a slanting plane deforms as its rim: the
    inner particles go with it, and each triangle has the closed-form stress. The positions are known to the tolerance
    of the residual, over a stiffness of the size of the cloth's."""
    x, faces, rim = patch()
    moved = x.copy()
    moved[:, :2] = x[:, :2] @ np.asarray(deformation).T
    start, end = turned(x), turned(moved)
    scene = Scene(
        particles=start,
        meshes={"m": {"vertices": start, "faces": faces}},
        forces=[Membrane(mesh="m", warp=turned(np.eye(3))[0], **CLOTH)],
        anchors=[{"particles": rim, "targets": end[rim]}],
        settings={"tolerance": 1e-11},
    )
    found = relax(scene)
    assert found.converged and found.stability == "stable"
    assert found.particles == pytest.approx(end, abs=1e-9)
    expected = stressed(deformation)
    cloth = found.force("membrane")
    for name, value in (("warp", expected[0, 0]), ("weft", expected[1, 1]), ("shear", expected[0, 1])):
        assert cloth[name] == pytest.approx(np.full(len(faces), value), abs=1e-6)
    assert cloth["largest"] == pytest.approx(np.full(len(faces), np.linalg.eigvalsh(expected)[1]), abs=1e-6)
    assert (cloth["state"] == TAUT).all()


@pytest.mark.parametrize("wrinkling", [False, True])
def test_a_strip_contracts_by_poissons_ratio(wrinkling: bool) -> None:
    """Pulled along the warp between rollers: S = Ew e along, and the strain across is -nu e. With wrinkling it may be
    narrower than that by folds, which cost nothing, and pulls the same."""
    mesh, stretch = grid(np.linspace(0, 2.0, 5), np.linspace(0, 1.0, 4)), 1.08
    x = np.array(mesh.vertices)
    ends, low = np.flatnonzero((x[:, 0] == 0) | (x[:, 0] == 2.0)), np.flatnonzero(x[:, 1] == 0)
    scene = Scene(
        particles=x,
        meshes={"m": vars(mesh)},
        forces=[Membrane(mesh="m", wrinkling=wrinkling, warp=[1, 0, 0], **CLOTH)],
        anchors=[
            {"particles": ends, "axes": "x", "targets": x[ends] * [stretch, 1, 1]},
            {"particles": low, "axes": "y"},
            {"particles": np.arange(len(x)), "axes": "z"},
        ],
        settings={"tolerance": 1e-11},
    )
    found = relax(scene)
    strain = 0.5 * (stretch**2 - 1.0)
    across = np.sqrt(1.0 - 2.0 * CLOTH["poisson"] * strain)
    assert found.converged
    width = np.ptp(found.particles[:, 1])
    assert width < across + 1e-9 if wrinkling else width == pytest.approx(across, abs=1e-9)
    pulled = CLOTH["warp_stiffness"] * strain * stretch  # per width of the start
    reaction = np.abs(found.reactions["force"][:, 0]).sum() / 2.0
    assert reaction == pytest.approx(pulled, rel=1e-9)


def relaxed(cloth: Any, strain: Any) -> tuple[np.ndarray, float, float]:
    """Stress, energy and state that the kernels use."""
    found = np.zeros((1, 5))

    dispatch.compiled(_respond)(np.array([cloth], dtype=float), np.array([strain], dtype=float), found)
    return found[0, :3], float(found[0, 3]), float(found[0, 4])


def _respond(cloth, strains, found):  # type: ignore[no-untyped-def]
    s = np.zeros(3)
    for e in range(strains.shape[0]):
        energy, state, _ = respond(cloth[e], strains[e], s, True)
        found[e, 0], found[e, 1], found[e, 2], found[e, 3], found[e, 4] = s[0], s[1], s[2], energy, state


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(5))
def test_the_relaxed_energy_is_the_least(seed: int) -> None:
    """min over a >= 0 of W(e + a) is a convex problem: S is its stress if and only if S >= 0, a = C^-1 S - e >= 0 and
    S : a = 0 (Karush, Kuhn and Tucker), and the energy is then S C^-1 S / 2. Cloths up to a shear stiffness of a
    thousandth of that of the yarns, and all ratios of strains."""
    rng = np.random.default_rng(seed)
    states = set()
    for _ in range(200):
        warp, weft = 10.0 ** rng.uniform(-2, 2, 2)
        poisson = rng.uniform(-0.3, 0.95) * np.sqrt(warp / weft)
        shear = np.sqrt(warp * weft) * 10.0 ** rng.uniform(-3, 0.5)
        strain = rng.normal(size=3) * 10.0 ** rng.uniform(-2, 0, 3)
        s, energy, state = relaxed((warp, weft, shear, poisson), strain)
        states.add(state)
        inverse = compliance(warp, weft, shear, poisson)
        a = inverse @ s - strain
        # in axes in which both yarns are as stiff; there rounding is a part of the largest entry
        scale = np.array([warp**-0.5, weft**-0.5, (warp * weft) ** -0.25])
        size_s, size_a = np.abs(s * scale).max(), np.abs(strain / scale).max()
        tight = 1e-10
        s, a = s * scale, a / scale
        assert min(s[0], s[1]) >= -tight * size_s and s[0] * s[1] - s[2] ** 2 >= -tight * size_s**2
        assert min(a[0], a[1]) >= -tight * size_a and a[0] * a[1] - 0.25 * a[2] ** 2 >= -tight * size_a**2
        assert abs(s @ a) <= tight * size_s * size_a
        own = s / scale
        assert energy == pytest.approx(0.5 * own @ inverse @ own, rel=1e-9, abs=1e-300)
    assert states == {SLACK, WRINKLED, TAUT}


def test_a_sheared_sheet_wrinkles_at_45_degrees() -> None:
    """A sheet between two rigid bars that is sheared by gamma is a tension field at 45 degrees, of stress E t gamma / 2
    and shear E t gamma / 4: half or so of the G t gamma it would carry without wrinkles (Wagner 1929, Reissner 1938),
    all but for terms of the order gamma."""
    gamma, stiff = 1e-4, 1000.0
    mesh = grid(np.linspace(0, 3.0, 7), np.linspace(0, 1.0, 4))
    x = np.array(mesh.vertices)
    rim = np.flatnonzero(np.isin(x[:, 0], [0, 3.0]) | np.isin(x[:, 1], [0, 1.0]))
    end = x.copy()
    end[:, 0] += gamma * x[:, 1]
    membrane = Membrane(mesh="m", warp_stiffness=stiff, poisson=0.3, wrinkling=True)
    held = [{"particles": rim, "targets": end[rim]}, {"particles": np.arange(len(x)), "axes": "z"}]
    tight = {"tolerance": 1e-10}
    found = relax(Scene(particles=x, meshes={"m": vars(mesh)}, forces=[membrane], anchors=held, settings=tight))
    cloth = found.force("membrane")
    assert found.converged and (cloth["state"] == WRINKLED).all()
    assert cloth["largest"] == pytest.approx(np.full(len(cloth["state"]), stiff * gamma / 2), rel=5 * gamma)
    assert (cloth["least"] == 0.0).all()
    assert cloth["shear"] == pytest.approx(np.full(len(cloth["state"]), stiff * gamma / 4), rel=5 * gamma)


def test_compressed_cloth_is_slack() -> None:
    """Pushed together in both directions it has no force, no energy and no stiffness."""
    mesh = grid(np.linspace(0, 1.0, 3), np.linspace(0, 1.0, 3))
    scene = Scene(
        particles=mesh.vertices,
        meshes={"m": vars(mesh)},
        forces=[Membrane(mesh="m", wrinkling=True, warp=[1, 0, 0], **CLOTH)],
    )
    system = compile(scene)
    state = system.start()
    state.x *= [0.9, 0.95, 1.0]
    f, _, energy = system.evaluate(state)
    (group,) = system.groups
    assert not f.any() and not energy.any()
    assert not system.stiffness_blocks(group, state, state.memory[0]).any()
    columns = group.parts[0].force.measure(group.block, state.x, np.zeros((len(group.block.indices), 3, 3)))
    assert (columns["state"] == SLACK).all() and not columns["largest"].any()


def blown(rings: int) -> tuple[float, float]:
    """Rise and stress at the middle of Hencky's film, as parts of those of his series at nu = 0.3."""
    x, faces, (*_, rim) = concentric(rings)
    stiff, q = 1e5, 0.1  # rise 0.0065 of the radius: what his theory leaves out is its square
    film = Membrane(mesh="m", warp_stiffness=stiff, poisson=0.3, warp=[1, 0, 0])
    scene = Scene(
        particles=x,
        meshes={"m": {"vertices": x, "faces": faces}},
        forces=[film, {"kind": "pressure", "mesh": "m", "pressure": q}],
        anchors=[{"particles": rim}],
        settings={"tolerance": 1e-8},
    )
    found = relax(scene)
    assert found.converged
    rise = 0.653443 * (q / stiff) ** (1 / 3)
    stress = 0.431101 * (stiff * q * q) ** (1 / 3)
    return found.particles[0, 2] / rise, found.force("membrane")["largest"][:6].mean() / stress


@pytest.mark.slow
def test_a_blown_disc_is_henckys() -> None:
    """w0 = 0.653443 a (q a / E t)^(1/3), N_r(0) = 0.431101 (E t q^2 a^2)^(1/3) (Hencky 1915, with the coefficients of
    Fichter, NASA TP-3658, 1997): errors of the order h^2, so a quarter with half of the mesh width."""
    coarse, fine = np.array(blown(4)) - 1.0, np.array(blown(8)) - 1.0
    assert (np.abs(fine) < [0.004, 0.008]).all()
    assert (np.abs(fine) < 0.4 * np.abs(coarse)).all()


def airbag(count: int) -> Result:
    """An eighth of the square airbag of Contri and Schrefler: its diagonal 120 cm, E 588 MPa, nu 0.4, t 0.6 mm, under
    5 kPa; the seam stays in its plane."""
    side = 1.2 / np.sqrt(2.0) / 2.0
    mesh = grid(np.linspace(0, side, count + 1), np.linspace(0, side, count + 1))
    x = np.array(mesh.vertices)
    seam = np.flatnonzero((x > side - 1e-9).any(axis=1))
    middle = [{"particles": np.flatnonzero(x[:, i] == 0), "axes": axis} for i, axis in enumerate("xy")]
    cloth = Membrane(mesh="m", warp_stiffness=588e6 * 0.6e-3, poisson=0.4, wrinkling=True)
    pressure = {"kind": "pressure", "mesh": "m", "pressure": 5e3}
    held = [{"particles": seam, "axes": "z"}, *middle]
    tight = {"tolerance": 1e-10}
    return relax(Scene(particles=x, meshes={"m": vars(mesh)}, forces=[cloth, pressure], anchors=held, settings=tight))


@pytest.mark.slow
@pytest.mark.parametrize("count", [8, pytest.param(16, marks=pytest.mark.soak)])
def test_the_square_airbag_rises_as_published(count: int) -> None:
    """The centre rises by 21.5 cm (Contri and Schrefler, "A geometrically nonlinear finite element analysis of wrinkled
    membrane surfaces by a no-compression material model", 1988): within 2 %, with wrinkles along the seam."""
    found = airbag(count)
    assert found.converged
    assert found.particles[:, 2].max() == pytest.approx(0.215, rel=0.02)
    assert np.count_nonzero(found.force("membrane")["state"] == WRINKLED) > count


QUAD = np.array([[0, 0, 0], [2, 0, 0], [2, 1, 0], [0, 1.0, 0]])


def start_stress(x: np.ndarray = QUAD, **more: Any) -> dict[str, Any]:
    """What the result of a held quad of cloth reports at its start."""
    scene = Scene(
        particles=x,
        meshes={"m": {"vertices": x, "faces": [[0, 1, 2, 3]]}},
        forces=[{"kind": "membrane", "mesh": "m", **more}],
        anchors=[{"particles": np.arange(4)}],
    )
    found: dict[str, Any] = relax(scene).force("membrane")
    return found


@pytest.mark.parametrize(
    "way",
    [
        {"warp": [0, 3.0, 1.0]},
        {"warp_lines": [[[0, 0, 0], [0, 5, 1]], [[9, 0, 0], [10, 0, 0]]]},
        {"warp": [[0, 1.0, 0]]},
    ],
    ids=["vector", "lines", "one for each face"],
)
def test_prestress_is_that_of_the_start(way: Any) -> None:
    """The start shape has the prestress, along a warp at y however it is given."""
    found = start_stress(prestress=[3.0, 2.0, 0.5], **way, **CLOTH)
    assert found["warp"] == pytest.approx(np.full(4, 3.0), rel=1e-12)
    assert found["weft"] == pytest.approx(np.full(4, 2.0), rel=1e-12)
    assert np.abs(found["shear"]) == pytest.approx(np.full(4, 0.5), rel=1e-12)


def test_each_triangle_may_have_a_prestress_of_its_own() -> None:
    """A quad has four triangles, the two of either cut."""
    rows = np.array([[3.0, 2.0, 0.5], [1.0, 4.0, 0.0], [2.0, 2.0, -0.5], [5.0, 1.0, 0.2]])
    found = start_stress(prestress=rows, warp=[1, 0, 0], **CLOTH)
    for i, name in enumerate(("warp", "weft", "shear")):
        assert found[name] == pytest.approx(rows[:, i], rel=1e-12, abs=1e-15)
    with pytest.raises(InputError, match="3 stresses for 1 faces of 4 triangles; give one, or one for each"):
        start_stress(prestress=rows[:3], warp=[1, 0, 0], **CLOTH)


def test_the_prestress_is_that_of_another_shape() -> None:
    """A sheet made in a smaller shape has the closed-form stress of the stretch (1.05, 1.02) to the start, and its
    prestress if it was made there."""
    x = np.array([[0, 0, 0], [1.05, 0, 0], [1.05, 1.02, 0], [0, 1.02, 0]])
    found = start_stress(x, shape=x / [1.05, 1.02, 1.0], warp=[1, 0, 0], **CLOTH)
    expected = stressed(np.diag([1.05, 1.02]))
    assert found["warp"] == pytest.approx(np.full(4, expected[0, 0]), rel=1e-12)
    assert found["weft"] == pytest.approx(np.full(4, expected[1, 1]), rel=1e-12)
    with pytest.raises(InputError, match="3 points of shape for a mesh of 4 vertices; give one for each vertex"):
        start_stress(x, shape=x[:3], warp=[1, 0, 0], **CLOTH)


def test_without_a_warp_it_runs_along_the_rows() -> None:
    """The first edge of the first face, and on through the mesh: each face from another corner, the stress along x is
    that of the warp. A quad mesh has rows; triangles have none."""
    x = np.array([[i, j, 0.0] for i in range(3) for j in range(2)])
    rows = [[0, 2, 3, 1], [4, 5, 3, 2]]  # the second starts with an edge along y
    scene = Scene(
        particles=x,
        meshes={"m": {"vertices": x, "faces": rows}},
        forces=[Membrane(mesh="m", prestress=[5.0, 1.0, 0], **CLOTH)],
        anchors=[{"particles": np.arange(6)}],
    )
    found = relax(scene)
    along = found.reactions["force"][np.isin(found.reactions["particles"], [0, 1]), 0]
    assert along.sum() == pytest.approx(-5.0, rel=1e-12)
    cut = scene.model_copy(update={"meshes": {"m": {"vertices": x, "faces": [[0, 2, 3], [0, 3, 1], [4, 5, 3, 2]]}}})
    with pytest.raises(InputError, match=r"no rows .* give warp or warp_lines"):
        compile(cut)


def test_a_solid_material_has_the_stiffness_of_its_thickness() -> None:
    """E t and nu of steel; and a cloth that the scene names, or that is known, has its own."""
    x = np.array([[0, 0, 0], [1, 0, 0], [0, 1.0, 0]])

    def numbers(materials: Any, **force: Any) -> list[float]:
        scene = Scene(
            particles=x, meshes={"m": {"vertices": x, "faces": [[0, 1, 2]]}}, materials=materials,
            forces=[{"kind": "membrane", "mesh": "m", "warp": [1, 0, 0], **force}],
        )  # fmt: skip
        block = compile(scene).groups[0].block
        return [float(v) for n, v in zip(block.names, block.parameters[0], strict=True) if n == "cloth"]

    steel = {"steel": {"E": 210e9, "G": 81e9}}
    nu = 210 / 162 - 1
    assert numbers(steel, material="steel", thickness=0.001) == pytest.approx([210e6, 210e6, 81e6, nu], rel=1e-12)
    own = {"cloth": {"warp_stiffness": 6e5, "weft_stiffness": 5e5, "shear_stiffness": 2e4, "poisson": 0.3}}
    assert numbers(own, material="cloth") == [6e5, 5e5, 2e4, 0.3]
    assert numbers({}, material="PVC-polyester III")[0] == 1000e3


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        ({}, "its stiffness is missing; give either material or warp_stiffness"),
        ({"warp_stiffness": 1.0, "material": "S355"}, "material and warp_stiffness given"),
        ({"warp_stiffness": 1.0, "thickness": 1.0}, "thickness given without a material"),
        ({"material": "S355"}, "S355 is a solid; give the thickness"),
        ({"material": "PTFE-glass", "thickness": 1.0}, "is a cloth, whose stiffness is per width; remove thickness"),
        ({"material": "S365"}, 'material "S365" does not exist; did you mean S355'),
        ({"warp_stiffness": 1.0, "weft_stiffness": 4.0, "poisson": 0.6}, "between -0.5 and 0.5 allowed"),
        ({"warp_stiffness": 1.0, "warp": [0, 0, 1.0]}, "the warp runs square to face 0"),
        ({"warp_stiffness": 1.0, "warp": [[1.0, 0, 0], [1, 0, 0]]}, "2 directions of warp for 1 faces"),
        ({"warp_stiffness": 1.0, "warp": [1.0, 0, 0], "warp_lines": [[[0, 0, 0], [1, 0, 0]]]}, "at most one of them"),
        ({"warp_stiffness": 1.0, "warp_lines": [[[0, 0, 0], [0, 0, 0]]]}, "has no length; remove it"),
        ({"warp_stiffness": 1.0, "warp_lines": []}, "no line given"),
    ],
)
def test_what_cannot_be_is_one_sentence(given: Any, sentence: str) -> None:
    """Where, what was given, what is allowed."""
    with pytest.raises(InputError) as refused:
        start_stress(**given)
    assert sentence in refused.value.sentence and refused.value.pointer.startswith("/forces/0")
