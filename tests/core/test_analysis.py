"""Frequencies, buckling, load paths and mechanisms against closed forms of discrete structures."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import scipy.optimize
import scipy.special

import hookean
from hookean import InputError, Scene, Simulation

Spec = dict[str, Any]


def chain(count: int) -> np.ndarray:
    return np.column_stack([np.arange(count), np.arange(1, count + 1)])


def string(masses: int = 9, tension: float = 5.0, spacing: float = 0.3, mass: float = 2.0) -> Spec:
    """A string of springs that carry a tension, between two anchors."""
    x = np.zeros((masses + 2, 3))
    x[:, 0] = np.arange(masses + 2) * spacing
    k = 1e4 / spacing
    springs = {"kind": "springs", "particles": chain(masses + 1), "stiffness": k, "rest_length": spacing - tension / k}
    return {"particles": x, "masses": mass, "forces": [springs], "anchors": [{"particles": [0, masses + 1]}]}


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


def column(n: int, stiffness: float = 1e9) -> Spec:
    """A column of n bars between pins, EI = 3, length 2, in the plane x z, under a unit load."""
    x = np.zeros((n + 1, 3))
    x[:, 2] = np.arange(n + 1) * 2.0 / n
    corners = np.column_stack([np.arange(n - 1), np.arange(1, n), np.arange(2, n + 1)])
    forces = [
        {"kind": "springs", "particles": chain(n), "stiffness": stiffness},
        {"kind": "bend", "particles": corners, "stiffness": 3.0},
        {"kind": "unary", "name": "load", "particles": [n], "vector": [0, 0, -1.0]},
        {"kind": "unary", "name": "wind", "particles": [n // 2], "vector": [0.0, 0, 0]},
    ]
    anchors = [{"particles": [0]}, {"particles": [n], "axes": "xy"}, {"particles": np.arange(1, n), "axes": "y"}]
    return {"particles": x, "forces": forces, "anchors": anchors, "settings": {"tolerance": 1e-9}}


@pytest.mark.parametrize("n", [4, 20, 450])
def test_a_column_buckles_as_henckys_bar_chain(n: int) -> None:
    """P_j = (4 n^2 EI / L^2) sin^2(j pi / 2 n) (Hencky 1920; Wang et al. 2020). The bars shorten by P / k, a part
    P n / (k L) of their length, by which the factors may be off: 1e-5 at n = 450, where the tangent's bending terms
    beside k = 1e9 lose as much; dense and by iteration."""
    found = hookean.buckling(Scene.read(column(n)), count=2, loads=["load"])
    wanted = 4.0 * n**2 * 3.0 / 4.0 * np.sin(np.arange(1, 3) * np.pi / (2 * n)) ** 2
    np.testing.assert_allclose(found.factors, wanted, rtol=1e-6 if n < 100 else 3e-5)
    mode = found.modes[0][:, 0]
    np.testing.assert_allclose(mode / mode[n // 2], np.sin(np.arange(n + 1) * np.pi / n), atol=1e-5)


def test_a_column_in_tension_does_not_buckle() -> None:
    spec = column(6)
    spec["forces"][2]["vector"] = [0, 0, 1.0]
    found = hookean.buckling(Scene.read(spec))
    assert not len(found.factors)
    assert found.summary() == ["the loads do not make the structure buckle"]


def test_prestress_and_other_loads_count_in_full() -> None:
    """A load of P1 that is not among the growing ones takes its part of the critical load: lambda = (P - P1) / P2."""
    spec = column(8)
    critical = float(hookean.buckling(Scene.read(spec), count=1, loads=["load"]).factors[0])
    first = {"kind": "unary", "name": "dead", "particles": [8], "vector": [0, 0, -3.0]}
    spec["forces"].append(first)
    found = hookean.buckling(Scene.read(spec), count=1, loads=["load"])
    np.testing.assert_allclose(found.factors, critical - 3.0, rtol=1e-6)


def truss(half: float, rise: float, stiffness: float = 100.0) -> Scene:
    """Von Mises' truss of two bars in the plane x z."""
    springs = {"kind": "springs", "particles": [[0, 1], [1, 2]], "stiffness": stiffness}
    load = {"kind": "unary", "particles": [1], "vector": [0, 0, -1.0]}
    return Scene.read(
        {
            "particles": [[-half, 0, 0], [0, 0, rise], [half, 0, 0]],
            "forces": [springs, load],
            "anchors": [{"particles": [0, 2]}, {"particles": [1], "axes": "y"}],
            "settings": {"tolerance": 1e-10},
        }
    )


def test_a_shallow_truss_snaps_through_along_its_closed_form() -> None:
    """P = 2 k z (L0 / l - 1) at height z, with both limit points where l^3 = L0 b^2 (von Mises 1923)."""
    half, rise, k = 1.0, 0.3, 100.0
    found = hookean.load_path(truss(half, rise), steps=60, increment=0.3)
    z = found.particles[:, 1, 2]
    rest, length = np.hypot(half, rise), np.hypot(half, z)
    np.testing.assert_allclose(found.factors, 2.0 * k * z * (rest / length - 1.0), atol=1e-9)
    assert z[-1] < -rise
    there = np.cbrt(rest * half**2)
    limit = 2.0 * k * np.sqrt(there**2 - half**2) * (rest / there - 1.0)
    assert [point.kind for point in found.critical_points] == ["limit", "limit"]
    np.testing.assert_allclose([point.factor for point in found.critical_points], [limit, -limit], rtol=1e-12)
    between = np.abs(z) < np.sqrt(there**2 - half**2)
    np.testing.assert_array_equal(found.stable, ~between)
    assert found.limit == found.critical_points[0].factor


def test_a_steep_truss_leaves_its_plane_of_symmetry_first() -> None:
    """It sways where l^3 = L0 z^2 (the tangent across, 2 k (1 - L0 z^2 / l^3), vanishes), before its limit point."""
    half, rise, k = 1.0, 3.0, 100.0
    found = hookean.load_path(truss(half, rise), steps=30, increment=5.0)
    rest = np.hypot(half, rise)
    z = scipy.optimize.brentq(lambda z: np.hypot(half, z) ** 3 - rest * z**2, 1.5, rise - 1e-9, xtol=1e-14)
    first = found.critical_points[0]
    assert first.kind == "bifurcation"
    np.testing.assert_allclose(first.factor, 2.0 * k * z * (rest / np.hypot(half, z) - 1.0), rtol=1e-7)
    assert not found.stable[first.step + 1] and found.stable[first.step]


def test_a_path_ends_at_the_factor_that_is_asked_for() -> None:
    """And there it is the shape that relaxing under these loads gives."""
    scene = truss(1.0, 0.3)
    found = hookean.load_path(scene, increment=0.1, largest_factor=0.75)
    assert found.factors[-1] == pytest.approx(0.75, abs=1e-9)
    load = scene.forces[1].model_copy(update={"vector": [0, 0, -0.75]})
    relaxed = hookean.relax(scene.model_copy(update={"forces": (scene.forces[0], load)}))
    np.testing.assert_allclose(found.particles[-1], relaxed.particles, atol=1e-8)


def star_dome(stiffness: float = 100.0) -> Spec:
    """The star dome of 24 bars: crown, six nodes at radius 25 and height 6.216, six supports; EA = 100."""
    turn = np.arange(6) * np.pi / 3.0
    ring = np.column_stack([25.0 * np.cos(turn), 25.0 * np.sin(turn), np.full(6, 6.216)])
    out = np.column_stack([np.cos(turn + np.pi / 6.0), np.sin(turn + np.pi / 6.0), np.zeros(6)]) * [43.3, 43.3, 1.0]
    x = np.concatenate([[[0.0, 0.0, 8.216]], ring, out])
    i = np.arange(6)
    pairs = [[0 * i, 1 + i], [1 + i, 1 + (i + 1) % 6], [1 + i, 7 + i], [1 + (i + 1) % 6, 7 + i]]
    pairs = np.concatenate(pairs, axis=1).T
    size = np.linalg.norm(x[pairs[:, 1]] - x[pairs[:, 0]], axis=1)
    springs = {"kind": "springs", "particles": pairs, "stiffness": stiffness / size}
    load = {"kind": "unary", "particles": [0], "vector": [0, 0, -1.0]}
    return {"particles": x, "forces": [springs, load], "anchors": [{"particles": np.arange(7, 13)}]}


def test_a_star_dome_has_the_limit_load_of_its_symmetric_motion() -> None:
    """Independent: by symmetry three heights and radii remain; for each height of the crown the ring is solved for
    with SciPy, and the load is that of six bars at the crown. Its first maximum is the limit load. To 1e-6, what
    minimising over the height by parabolas reaches."""
    rest = np.sqrt(25.0**2 + 2.0**2), 25.0, np.linalg.norm([25.0 - 43.3 * np.cos(np.pi / 6), 43.3 / 2, 6.216])

    def parts(crown: float, ring: np.ndarray) -> tuple[np.ndarray, float]:
        radius, height = ring
        one = np.array([radius, 0.0, height - crown])
        two = np.array([radius - 43.3 * np.cos(np.pi / 6), 43.3 / 2, height])
        sizes = np.linalg.norm(one), radius, np.linalg.norm(two)
        pulls = [100.0 * (size / first - 1.0) for size, first in zip(sizes, rest, strict=True)]
        along = pulls[0] * one[[0, 2]] / sizes[0] + 2.0 * pulls[2] * two[[0, 2]] / sizes[2]
        return np.array([along[0] + pulls[1], along[1]]), 6.0 * pulls[0] * one[2] / sizes[0]

    def load(crown: float) -> float:
        ring = scipy.optimize.fsolve(lambda r: parts(crown, r)[0], [25.0, 6.216], xtol=1e-13)
        return -float(parts(crown, ring)[1])

    best = scipy.optimize.minimize_scalar(
        lambda z: load(z), bounds=(6.5, 8.2), method="bounded", options={"xatol": 1e-9}
    )
    found = hookean.load_path(Scene.read(star_dome()), steps=25, increment=0.01)
    limits = [point.factor for point in found.critical_points if point.kind == "limit"]
    np.testing.assert_allclose(limits[0], abs(best.fun), rtol=1e-6)


def simplex(turn: float) -> Spec:
    """Three struts and nine cables: two triangles, the upper one turned by an angle [degrees]."""
    lower, upper = (np.radians([0, 120, 240]) + np.radians(a) for a in (0.0, turn))
    x = np.concatenate(
        [np.column_stack([np.cos(a), np.sin(a), np.full(3, z)]) for a, z in ((lower, 0.0), (upper, 1.5))]
    )
    sides = [[0, 1], [1, 2], [2, 0], [3, 4], [4, 5], [5, 3]]
    upright = [[i, 3 + i] for i in range(3)] + [[i, 3 + (i + 2) % 3] for i in range(3)]
    return {"particles": x, "forces": [{"kind": "springs", "particles": sides + upright}]}


def test_a_simplex_tensegrity_has_one_mechanism_and_one_self_stress() -> None:
    """At the twist of 150 degrees (Calladine 1978; Pellegrino and Calladine 1986), and at no other: m = s = 1, and
    Maxwell's rule m - s = f - 6 - b. Struts push and all cables pull, in the proportions of symmetry."""
    found = hookean.mechanisms(Scene.read(simplex(150.0)))
    assert (found.bars, found.free_axes, found.rank) == (12, 18, 11)
    assert (found.mechanisms, found.rigid_motions, found.self_stress_states) == (1, 6, 1)
    stress = found.self_stresses[0] * np.sign(found.self_stresses[0, 0])
    assert (stress[:6] > 0).all() and np.unique(np.sign(stress[6:9])).size == 1
    assert np.sign(stress[6]) == -np.sign(stress[9])
    other = hookean.mechanisms(Scene.read(simplex(140.0)))
    assert (other.mechanisms, other.self_stress_states) == (0, 0)
    # to first order the mechanism changes no length, and the self-stress leaves no force
    x, pairs = found.particles, found.pairs
    along = x[pairs[:, 1]] - x[pairs[:, 0]]
    along /= np.linalg.norm(along, axis=1)[:, None]
    mode = found.modes[0]
    assert np.abs(((mode[pairs[:, 1]] - mode[pairs[:, 0]]) * along).sum(axis=1)).max() < 1e-12
    left = np.zeros_like(x)
    np.add.at(left, pairs[:, 0], found.self_stresses[0][:, None] * along)
    np.add.at(left, pairs[:, 1], -found.self_stresses[0][:, None] * along)
    assert np.abs(left).max() < 1e-12


@pytest.mark.parametrize(
    ("spec", "counts"),
    [
        ({"pairs": [[0, 1], [1, 2]], "held": [0, 2]}, (1, 0, 1)),  # in line in the plane: one of each
        ({"pairs": [[0, 1], [1, 2]], "held": [0]}, (2, 0, 0)),
        ({"pairs": [[0, 1]], "held": []}, (0, 3, 0)),  # a bar afloat in a plane
    ],
)
def test_counts_of_bars_in_a_plane(spec: Spec, counts: tuple[int, int, int]) -> None:
    """Textbook cases in the plane x y: mechanisms, rigid motions and states of self-stress."""
    count = 1 + max(max(pair) for pair in spec["pairs"])
    anchors: list[Spec] = [{"particles": np.arange(count), "axes": "z"}]
    if spec["held"]:
        anchors.append({"particles": spec["held"]})
    x = np.column_stack([np.arange(count), np.zeros((count, 2))])
    forces = [{"kind": "springs", "particles": spec["pairs"]}]
    found = hookean.mechanisms(Scene.read({"particles": x, "forces": forces, "anchors": anchors}))
    rigid = 1 if spec["held"] == [0] else counts[1]  # about its one support it turns as a whole
    mechanisms = counts[0] - 1 if spec["held"] == [0] else counts[0]
    assert (found.mechanisms, found.rigid_motions, found.self_stress_states) == (mechanisms, rigid, counts[2])


def test_bad_input_is_one_sentence() -> None:
    scene = Scene.read(string())
    loose = scene.model_copy(update={"settings": hookean.Settings(max_iterations=0), "anchors": ()})
    falling = loose.model_copy(update={"forces": (*loose.forces, hookean.Unary(particles=[1], vector=[0, 0, -1]))})
    for call, said in [
        (lambda: hookean.frequencies(falling), "is not in equilibrium"),
        (lambda: hookean.frequencies(3), "a Scene, Result or Simulation is expected"),
        (lambda: hookean.frequencies(scene, count=0), "a whole number from 1"),
        (lambda: hookean.frequencies(scene, masses=[1.0, 2.0]), "one for each of the 11 particles"),
        (lambda: hookean.frequencies(scene, masses=0.0), "more than 0"),
        (lambda: hookean.buckling(scene), "has no loads"),
        (lambda: hookean.buckling(truss(1.0, 0.3), loads=["snow"]), "no load is called 'snow'"),
        (lambda: hookean.load_path(truss(1.0, 0.3), increment=0.0), "that is not 0"),
        (lambda: hookean.load_path(truss(1.0, 0.3), steps=0), "a whole number from 1"),
        (lambda: hookean.load_path(truss(1.0, 0.3), largest_factor=-1.0), "of the sign of increment"),
        (lambda: hookean.load_path(truss(1.0, 0.3), arc_length=0.0), "a length above 0"),
        (lambda: hookean.mechanisms(Scene.read({"particles": [[0, 0, 0]]})), "has no bars"),
    ]:
        with pytest.raises(InputError, match=said):
            call()


def test_a_slack_net_has_no_linear_buckling() -> None:
    """Without its load a flat net without stress has no stiffness across itself."""
    spec = string(3)
    spec["forces"][0].pop("rest_length")
    spec["forces"].append({"kind": "unary", "particles": [2], "vector": [0, 0, -1.0]})
    with pytest.raises(InputError, match="no stiffness against some motion"):
        hookean.buckling(Scene.read(spec))
    with pytest.raises(InputError, match="no stiffness against some motion"):
        hookean.load_path(Scene.read(spec))
