"""Natural frequencies against closed forms of strings, chains and nets."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import scipy.optimize
import scipy.special

import hookean
from hookean import Scene, Simulation

from .bar_scenes import chain, string
from .beam_scenes import SLENDER


def test_a_prestressed_string_has_its_frequencies() -> None:
    """Lagrange's loaded string: omega_j = 2 sqrt(T / m a) sin(j pi / (2 n + 2)), each in two planes. To 1e-9: the
    eigenvalues beside the axial stiffness, 2e4 times that across, lose 5 digits of 16."""
    n, tension, spacing, mass = 9, 5.0, 0.3, 2.0
    found = hookean.frequencies(Scene.read(string()), count=2 * n)
    wanted = 2.0 * np.sqrt(tension / (mass * spacing)) * np.sin(np.arange(1, n + 1) * np.pi / (2 * n + 2))
    np.testing.assert_allclose(found.angular_frequencies, np.repeat(wanted, 2), rtol=1e-9)
    np.testing.assert_allclose(found.frequencies, found.angular_frequencies / (2.0 * np.pi), rtol=1e-15)
    shape = np.sin(np.arange(n + 2) * np.pi / (n + 1))
    np.testing.assert_allclose(np.linalg.norm(found.modes[0], axis=1) / np.linalg.norm(found.modes[0, 5]), shape,
                               atol=1e-9)  # fmt: skip
    assert np.abs(found.modes[:, [0, -1]]).max() == 0.0  # held ends do not move


def test_effective_masses_add_up() -> None:
    """Over all modes they are the mass that is free (Clough and Penzien, 1993, section 12-5)."""
    found = hookean.frequencies(Scene.read(string(4)), count=12)
    np.testing.assert_allclose(found.effective_masses.sum(axis=0), [8.0, 8.0, 8.0], rtol=1e-9)
    np.testing.assert_allclose(found.mass, 8.0)


def test_effective_masses_of_beams_add_up() -> None:
    """Also where orientations move with the modes: over all modes of a cantilever they are the mass of its four free
    particles (Clough and Penzien, 1993, section 12-5), and turns add none along x, y or z."""
    beam = {"kind": "beam", "particles": chain(4), "E": 1e4, "G": 5e3, "A": 1.0, "Iy": 1e-2, "Iz": 2e-2, "J": 2e-2}
    x = np.linspace([0, 0, 0], [2.0, 1.0, 0.5], 5)
    held = [{"particles": [0], "rotations": "xyz"}]
    found = hookean.frequencies(
        Scene.read({"particles": x, "masses": 3.0, "forces": [beam], "anchors": held}), count=24
    )
    assert len(found.frequencies) == 24
    np.testing.assert_allclose(found.effective_masses.sum(axis=0), [12.0, 12.0, 12.0], rtol=1e-9)
    np.testing.assert_allclose(found.mass, 12.0)


def test_a_hanging_chain_has_laguerres_frequencies() -> None:
    """n masses on links that keep their length a: omega^2 = (g / a) times the zeros of the Laguerre polynomial L_n.
    To 1e-6: links are 1e7 times as stiff as they are heavy, which shortens nothing at rest (their rest length allows
    for the pull), but lets them give by 1e-7 in motion."""
    n, length, g, mass, k = 10, 3.0, 9.81, 0.7, 1e9
    a = length / n
    x = np.zeros((n + 1, 3))
    x[:, 2] = -np.arange(n + 1) * a
    rest = a - mass * g * np.arange(n, 0, -1) / k
    springs = {"kind": "springs", "particles": chain(n), "stiffness": k, "rest_length": rest}
    weight = {"kind": "unary", "particles": np.arange(1, n + 1), "vector": [0, 0, -mass * g]}
    scene = Scene.read({"particles": x, "masses": mass, "forces": [springs, weight], "anchors": [{"particles": [0]}]})
    found = hookean.frequencies(scene, count=6).angular_frequencies * np.sqrt(length / g)
    zeros = scipy.special.roots_laguerre(n)[0]
    np.testing.assert_allclose(found, np.repeat(np.sqrt(n * zeros[:3]), 2), rtol=1e-6)
    np.testing.assert_allclose(found[::2], [1.173855, 2.700842, 4.252462], atol=1e-6)  # published to these digits


@pytest.mark.parametrize("n", [6, 25])
def test_a_prestressed_net_has_its_frequencies(n: int) -> None:
    """A square net of n x n masses: omega_ij^2 = 4 T / (m a) (sin^2(i pi / (2 n + 2)) + sin^2(j pi / (2 n + 2))) across
    it; by dense matrices (n = 6) and by shift-invert iteration (n = 25, 1,875 unknowns)."""
    tension, a, mass, k = 3.0, 0.5, 0.2, 600.0
    number = np.arange((n + 2) ** 2).reshape(n + 2, n + 2)
    x = np.zeros((number.size, 3))
    x[:, :2] = a * np.stack(np.divmod(np.arange(number.size), n + 2), axis=1)
    pairs = [
        [number[:-1, 1:-1].ravel(), number[1:, 1:-1].ravel()],
        [number[1:-1, :-1].ravel(), number[1:-1, 1:].ravel()],
    ]
    springs = {
        "kind": "springs",
        "particles": np.concatenate(pairs, axis=1).T,
        "stiffness": k,
        "rest_length": a - tension / k,
    }
    inner = np.isin(number, number[1:-1, 1:-1])
    scene = Scene.read(
        {"particles": x, "masses": mass, "forces": [springs], "anchors": [{"particles": number[~inner]}]}
    )
    sines = np.sin(np.arange(1, n + 1) * np.pi / (2 * n + 2)) ** 2
    wanted = np.sort(np.sqrt(4.0 * tension / (mass * a) * (sines[:, None] + sines)).ravel())
    found = hookean.frequencies(scene, count=6)
    np.testing.assert_allclose(found.angular_frequencies, wanted[:6], rtol=1e-9)
    assert np.abs(found.modes[0][:, :2]).max() < 1e-6  # across the net
    again = hookean.frequencies(scene, count=6)
    assert again.modes.tobytes() == found.modes.tobytes()


def test_results_and_simulations_have_the_frequencies_of_their_scene() -> None:
    """To 1e-10: two ways to the same shape differ by rounding, and 5 digits are lost beside the axial stiffness."""
    scene = Scene.read(string())
    wanted = hookean.frequencies(scene).frequencies
    np.testing.assert_allclose(hookean.frequencies(hookean.relax(scene)).frequencies, wanted, rtol=1e-10)
    running = Simulation(scene)
    running.step()
    np.testing.assert_allclose(hookean.frequencies(running).frequencies, wanted, rtol=1e-10)


def test_masses_given_are_those_that_count() -> None:
    """omega falls with the root of the mass."""
    scene = Scene.read(string())
    light, heavy = (hookean.frequencies(scene, masses=m).frequencies for m in (2.0, 8.0))
    np.testing.assert_allclose(light, 2.0 * heavy, rtol=1e-12)


@pytest.mark.parametrize("hinged", ["yz", "xyz"])
def test_a_truss_of_hinged_beams_has_the_frequencies_of_its_bars(hinged: str) -> None:
    """All nine, with masses that are not alike: turns of hinged joints, which are left out, neither take the place of
    one nor change it. To 1e-9: the stiffness of the bars is 1e4 times that of their twist."""
    x = [[0, 0, 0], [2, 0, 0], [1, 1.7, 0], [0.1, 0.1, 2], [1.9, 0.2, 2.1], [1, 1.5, 1.9]]
    pairs = [[0, 3], [1, 4], [2, 5], [3, 4], [4, 5], [5, 3], [0, 4], [1, 5], [2, 3]]
    beams = {"kind": "beam", "particles": pairs, **SLENDER, "release_start": hinged, "release_end": "xyz"}
    bars = {"kind": "springs", "particles": pairs, "axial_stiffness": SLENDER["E"] * SLENDER["A"]}
    found, wanted = (
        hookean.frequencies(Scene.read({"particles": x, "forces": [force], "anchors": [{"particles": [0, 1, 2]}]}),
                            count=9, masses=[1.0, 1.0, 1.0, 0.7, 1.3, 20.0]).frequencies
        for force in (beams, bars)
    )  # fmt: skip
    np.testing.assert_allclose(found, wanted, rtol=1e-9)


def test_a_strut_on_balls_twists_as_its_masses_say() -> None:
    """Its ends turn against each other, omega^2 = (G J / L) (1 / I + 1 / I'), I = m L^2 / 12; that it turns as a whole
    moves nothing and changes nothing, though that turn is not even across the unlike masses."""
    beam = {"kind": "beam", "particles": [[0, 1]], **SLENDER, "release_start": "yz", "release_end": "yz"}
    scene = {"particles": [[0, 0, 0], [1.2, 1.6, 0]], "forces": [beam], "anchors": [{"particles": [0, 1]}]}
    found = hookean.frequencies(Scene.read({**scene, "masses": [1.0, 5.0]}))
    wanted = np.sqrt(SLENDER["G"] * SLENDER["J"] / 2.0 * 12.0 / 2.0**2 * (1.0 + 1.0 / 5.0))
    np.testing.assert_allclose(found.angular_frequencies, [wanted], rtol=1e-12)


def test_a_motion_that_nothing_resists_has_frequency_zero() -> None:
    """A bar on one anchor turns freely about it: two rotations are free, its length is not (omega^2 = k / m)."""
    bar = {"kind": "springs", "particles": [[0, 1]], "stiffness": 50.0}
    scene = Scene.read(
        {"particles": [[0, 0, 0], [2, 1, 2]], "masses": 2.0, "forces": [bar], "anchors": [{"particles": [0]}]}
    )
    found = hookean.frequencies(scene)
    np.testing.assert_allclose(found.angular_frequencies, [0.0, 0.0, 5.0], atol=1e-12)
    assert found.periods[:2] == [None, None]
    assert "no resistance" in found.summary()[0]


def test_an_unstable_shape_has_a_negative_frequency() -> None:
    """A bar pushed along itself by P on an anchor falls over: omega^2 = -P / (l m)."""
    bar = {"kind": "springs", "particles": [[0, 1]], "stiffness": 1e3, "rest_length": 1.01}
    push = {"kind": "unary", "particles": [1], "vector": [0, 0, -10.0]}
    settings = {"allow_unstable": True, "solver": "newton"}
    spec = {"particles": [[0, 0, 0], [0, 0, 1.0]], "forces": [bar, push], "anchors": [{"particles": [0]}]}
    found = hookean.frequencies(Scene.read({**spec, "settings": settings}), count=1)
    np.testing.assert_allclose(found.angular_frequencies, [-np.sqrt(10.0)], rtol=1e-9)


def ties(n: int = 8) -> dict[str, Any]:
    """A pinned beam of steel, 4 m long, with its weight, in kN and m, held in its plane."""
    made = {"material": "steel", "section": "bar"}
    return {
        "units": {"force": "kN"},
        "particles": np.linspace([0, 0, 0], [4.0, 0, 0], n + 1),
        "materials": {"steel": {"E": 210e6, "G": 81e6, "density": 7.85}},
        "sections": {"bar": {"shape": "rectangle", "width": 0.05, "height": 0.1}},
        "forces": [
            {"kind": "beam", "particles": chain(n), **made},
            {"kind": "self_weight", "particles": chain(n), **made, "factor": 1.0},
        ],
        "anchors": [{"particles": [0, n], "axes": "xyz", "rotations": "x"},
                    {"particles": list(range(1, n)), "axes": "y", "rotations": "xz"}],
    }  # fmt: skip


def test_masses_of_the_self_weight_give_a_beam_its_frequency() -> None:
    """f = pi / 2 sqrt(EI / (m L^4)) (Clough and Penzien, 1993, section 18-2), m = 7.85 t/m3 x A: masses on particles
    along a sine have its energy of motion exactly; they turn as rods of their length, which adds (pi / n)^2 / 12 of it.
    The cubic bends as a sine up to (pi / n)^4 / 720 (Taylor's theorem), and the beam's own sag w stiffens it by
    (w / r)^2 at most, r the radius of gyration. Without masses a note reports that they are 1."""
    n, bending, mass = 8, 210e6 * 0.05 * 0.1**3 / 12.0, 7.85 * 0.005
    found = hookean.frequencies(Scene.read(ties(n)), 1, masses="self_weight")
    exact = 0.5 * np.pi * np.sqrt(bending / (mass * 4.0**4) / (1.0 + (np.pi / n) ** 2 / 12.0))
    sag = 5.0 * mass * 9.80665 * 4.0**4 / (384.0 * bending)
    assert found.frequencies[0] == pytest.approx(exact, rel=(np.pi / n) ** 4 / 720.0 + (sag / (0.1 / 12.0**0.5)) ** 2)
    assert found.notes == () and found.mass[2] == pytest.approx(mass * 4.0 * (n - 1) / n, rel=1e-12)
    light = hookean.frequencies(Scene.read(ties(n)), 1)
    assert light.summary()[-1].startswith("every particle has the mass 1, the default")
    assert "mode 1" in repr(light) and "array" not in repr(light)


def test_masses_of_the_self_weight_are_there_or_missed() -> None:
    """A factor on the weight multiplies masses; who moves without one is named, and so is a word that means nothing."""
    heavy, bare, light = ties(), ties(), ties()
    heavy["forces"][1]["factor"] = 4.0
    once, twice = (hookean.frequencies(Scene.read(of), 1, masses="self_weight") for of in (ties(), heavy))
    assert twice.mass[2] == pytest.approx(4.0 * once.mass[2], rel=1e-12)
    bare["forces"] = bare["forces"][:1]
    with pytest.raises(hookean.InputError, match="masses: particle 0 moves and has no self_weight"):
        hookean.frequencies(Scene.read({**bare, "anchors": [{"particles": [8], "rotations": "xyz"}]}), 1,
                            masses="self_weight")  # fmt: skip
    with pytest.raises(hookean.InputError, match=r"masses: 'weight' given; give numbers, or \"self_weight\""):
        hookean.frequencies(Scene.read(light), 1, masses="weight")
