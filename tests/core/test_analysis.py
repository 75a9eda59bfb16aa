"""Buckling of columns, mechanisms and states of self-stress against closed forms; bad input of all analyses."""

from __future__ import annotations

import numpy as np
import pytest

import hookean
from hookean import InputError, Scene

from .bar_scenes import Spec, chain, string, truss


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
