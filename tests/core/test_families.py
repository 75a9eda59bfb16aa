"""Families of scenes come to rest at the shapes that their docstrings state."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import brentq

from hookean import InputError, Scene, Simulation, family, relax
from hookean.scene.families import FAMILIES, families

SMALL: dict[str, Any] = {
    **{key: {"across": 4, "along": 4} for key in ("grid", "saddle", "vault", "gridshell", "cushion")},
    **{key: {"rings": 3, "rays": 8} for key in ("radial_net", "dome", "catenoid")},
    "cable": {"parts": 6},
    "tensegrity": {},
}
TIGHT = 1e-5  # of 10 m: a residual of 1e-6 of forces of 1 to 100 kN on springs of at least 10 kN/m


def shape(name: str, **parameters: Any) -> NDArray[np.float64]:
    """The particles of a family at rest."""
    result = relax(family(name, **parameters))
    assert result.status == "converged", result.message
    return np.asarray(result.particles)


@pytest.mark.parametrize("name", FAMILIES)
def test_a_family_remembers_its_parameters_and_rests(name: str) -> None:
    """Its scene reads back as it is, names what made it, and comes to rest."""
    scene = family(name, {"length": "m", "force": "kN"}, **SMALL[name])
    assert scene.family is not None and (scene.family.name, scene.units.force) == (name, "kN")
    assert SMALL[name].items() <= scene.family.parameters.items()
    assert Scene.read(scene.canonical).canonical == scene.canonical
    assert relax(scene).status == "converged"


@pytest.mark.parametrize("name", ["grid", "saddle", "vault", "gridshell"])
def test_a_family_as_small_as_its_bounds_allow_stays_whole(name: str) -> None:
    """A net 0.01 m wide has points 2.5 mm or less apart: no two become one particle, and it comes to rest."""
    sizes = {key: 0.01 for key in ("width", "depth", "rise") if key in FAMILIES[name].model.model_fields}
    result = relax(family(name, across=20, along=20, **sizes))
    assert len(result.particles) == 21 * 21
    assert result.status == "converged", result.message


def test_every_parameter_is_described_with_its_unit_and_has_a_default() -> None:
    for entry in families():
        assert entry["summary"].endswith(".")
        for one in entry["parameters"]:
            assert one["default"] is not None and (one.get("choices") or one["description"].endswith("]")), one


def test_a_cable_without_rest_length_hangs_as_a_parabola() -> None:
    """k (z_(i-1) - 2 z_i + z_(i+1)) = p has the solution z_i = -p i (n - i) / (2 k)."""
    i = np.arange(9)
    x = shape("cable", parts=8, rest_factor=0, load=2, stiffness=50)
    assert x[:, 2] == pytest.approx(-2 * i * (8 - i) / 100, abs=TIGHT)
    assert x[:, 0] == pytest.approx(10 * i / 8, abs=TIGHT)


def test_a_grid_held_at_its_edges_solves_the_discrete_poisson_equation() -> None:
    """The discrete sine series of p = 1 (L. Collatz, Numerical Treatment of Differential Equations, V)."""
    n = 6
    x = shape("grid", across=n, along=n, held="edges", rest_factor=0, load=3, stiffness=10)
    assert x[:, 2].reshape(n + 1, n + 1) == pytest.approx(-0.3 * poisson(n), abs=TIGHT)


def poisson(n: int) -> NDArray[np.float64]:
    """Heights (n + 1, n + 1) at which 4 z - (sum of its four neighbours) is 1 within a square, 0 on its border."""
    i = np.arange(n + 1)
    sines = np.sin(np.pi * np.outer(i, i[1:-1]) / n)
    load = sines[1:-1].sum(axis=0) * 2 / n
    values = 2 - 2 * np.cos(np.pi * i[1:-1] / n)
    return np.asarray(sines @ (np.outer(load, load) / (values[:, None] + values)) @ sines.T)


def test_a_saddle_with_held_edges_is_a_hyperbolic_paraboloid_and_symmetric_with_cables() -> None:
    """u + v - 2 u v is linear along both rows of springs; with edge cables the net is symmetric about its diagonals."""
    u, v = np.meshgrid(np.linspace(0, 1, 6), np.linspace(0, 1, 6), indexing="ij")
    x = shape("saddle", across=5, along=5, held="edges", rise=4)
    assert x == pytest.approx(np.stack([10 * u, 10 * v, 4 * (u + v - 2 * u * v)], axis=-1).reshape(-1, 3), abs=TIGHT)
    x = shape("saddle", across=5, along=5).reshape(6, 6, 3)
    assert x == pytest.approx(x.swapaxes(0, 1)[..., [1, 0, 2]], abs=10 * TIGHT)


@pytest.mark.parametrize("name", ["radial_net", "dome"])
def test_rings_rest_where_forces_along_rays_and_rings_agree(name: str) -> None:
    """r_(i+1) - 2 r_i + r_(i-1) = 4 sin^2(pi / m) r_i; heights: linear, or those of the docstring."""
    n, m, height = 4, 10, 3.0
    x = shape(name, rings=n, rays=m, **({"height": height} if name == "radial_net" else {"rise": height}))
    i = np.arange(n + 1)
    a = np.arccosh(1 + 2 * np.sin(np.pi / m) ** 2)
    first = x[[0, *(1 + m * np.arange(n))]]
    assert first[:, 0] == pytest.approx(5 * np.sinh(i * a) / np.sinh(n * a), abs=TIGHT)
    sums = (n - i) / m + (n * (n - 1) - i * (i - 1)) / 2
    heights = 1 - i / n if name == "radial_net" else sums / sums[0]
    assert first[:, 2] == pytest.approx(height * heights, abs=TIGHT)


def test_a_vault_rises_to_its_rise_as_a_parabola_on_two_edges() -> None:
    """z_i = 4 h i (n - i) / n^2 without edge cables; on four edges it is the Poisson shape, scaled to the rise."""
    n, i = 6, np.arange(7)
    x = shape("vault", across=n, along=3, supports="two edges", edge_stiffness=0, rise=2)
    assert x[:, 2].reshape(n + 1, 4) == pytest.approx(np.tile(8 * i * (n - i) / n**2, (4, 1)).T, abs=TIGHT)
    x = shape("vault", across=n, along=n, rise=2)
    assert x[:, 2].reshape(n + 1, n + 1) == pytest.approx(2 * poisson(n) / poisson(n).max(), abs=TIGHT)
    assert shape("vault", across=n, along=4, supports="corners", rise=2)[:, 2].max() == pytest.approx(2, abs=TIGHT)


def test_a_gridshell_on_two_edges_is_a_chain_of_equal_links() -> None:
    """Slopes of the links rise by p / H; H follows from the span. Members stretch by the strain T / (k l), at most
    p n / 2 / sin(end) / (k l) = 7e-4 here, which raises the crown by less than 7 times that part of its height (the
    sag of a chain 15 % longer than its span changes 2.2 times as much as its length does)."""
    n, length, stiffness = 6, 10 / 6 * 1.15, 10_000.0
    x = shape("gridshell", across=n, along=2, supports="two edges", load=1.0, stiffness=stiffness).reshape(n + 1, 3, 3)

    def angles(pull: float) -> NDArray[np.float64]:
        return np.asarray(np.arctan(((n - 1) / 2 - np.arange(n)) / pull))

    pull = brentq(lambda pull: length * np.cos(angles(pull)).sum() - 10, 0.1, 100)
    crown = length * np.sin(angles(pull))[: n // 2].sum()
    strain = 0.5 * n / np.sin(angles(pull)[0]) / (stiffness * length)
    assert x[n // 2, :, 2] == pytest.approx(crown, rel=7 * strain)
    assert np.ptp(x[..., 2], axis=1) == pytest.approx(0, abs=TIGHT)


def test_a_catenoid_has_the_neck_of_the_closed_form_and_none_beyond_its_limit() -> None:
    """a cosh(h / (2 a)) = R. A polygon of m sides lies inside of its circle by the part pi^2 / (2 m^2) at most, and
    its film pulls as much less; faces along the height add the part (h / (n a))^2 / 12."""
    n, m = 8, 24
    neck = brentq(lambda a: a * np.cosh(2.5 / a) - 5, 3, 5)
    x = shape("catenoid", rings=n, rays=m)
    middle = np.hypot(*x.reshape(n + 1, m, 3)[n // 2, :, :2].T)
    assert middle == pytest.approx(neck, rel=2 * np.pi**2 / (2 * m**2) + (5 / (n * neck)) ** 2 / 12)
    assert np.ptp(middle) < 1e-3 * neck
    with pytest.raises(InputError, match=r"where the film collapses; give at most 6\.627"):
        family("catenoid", height=6.63)


@pytest.mark.parametrize("struts", [3, 5])
def test_a_tensegrity_finds_its_twist_radius_and_height(struts: int) -> None:
    """90 deg + 180 deg / n from foot to head of a strut (Connelly and Terrell, 1995); upper ring as large as the
    lower. Turning the ring is its softest motion, 1e3 times softer than a spring, so it rests within 100 x TIGHT."""
    x = shape("tensegrity", struts=struts, radius=2, height=3)[struts:]
    angle = np.unwrap(np.arctan2(x[:, 1], x[:, 0])) - 2 * np.pi * np.arange(struts) / struts
    turned = np.mod(angle - np.pi / 2 - np.pi / struts + np.pi, 2 * np.pi) - np.pi
    assert turned == pytest.approx(0, abs=100 * TIGHT)
    assert np.hypot(x[:, 0], x[:, 1]) == pytest.approx(2, abs=100 * TIGHT)
    assert x[:, 2] == pytest.approx(3, abs=100 * TIGHT)


@pytest.mark.soak
def test_a_cushion_at_low_pressure_is_a_stretched_membrane() -> None:
    """0.07367 p a^2 / s at the middle (Timoshenko and Goodier, art. 107); a mesh of n quads is off by (pi / n)^2 / 4 of
    it, and a rise of 0.3 % of the side stretches it by 1e-5 of E, 0.2 % of the prestress."""
    n = 12
    x = shape("cushion", across=n, along=n, pressure=0.01)
    assert x[:, 2].max() == pytest.approx(0.07367 * 0.01 * 16, rel=np.pi**2 / n**2 / 4 + 0.002)


@pytest.mark.parametrize(
    ("name", "given", "said"),
    [
        ("tent", {}, "unknown family 'tent'; known: cable, grid"),
        ("cable", {"parts": 0}, "/parts: .*at least 1"),
        ("grid", {"held": "nowhere"}, "/held: .*edges.*corners"),
        ("dome", {"width": 3}, "/width: .*rise"),
    ],
)
def test_bad_parameters_are_refused_with_their_place(name: str, given: dict[str, Any], said: str) -> None:
    with pytest.raises(InputError, match=said):
        family(name, **given)


def test_parameters_rebuild_a_running_model_and_are_undone() -> None:
    """Across systems of different numbers of particles, with the scenes they came from; a gesture is one edit."""
    simulation = Simulation(family("cable", parts=4))
    first = simulation.scene.canonical
    for parts in (5, 6):
        simulation.rebuild({"parts": parts}, gesture="slide")
    assert (simulation.system.slots.count, simulation.scene.family) == (7, family("cable", parts=6).family)
    simulation.undo()
    assert (simulation.system.slots.count, simulation.edited_scene().canonical) == (5, first)
    simulation.redo()
    assert simulation.edited_scene().canonical == family("cable", parts=6).canonical
    simulation.revert()
    assert simulation.edited_scene().canonical == first


def test_what_has_no_place_of_its_own_survives_a_rebuilding_and_other_edits_forbid_it() -> None:
    """Stiffness by hand, settings and a load on all of a mesh stay, and a load on a particle whose number stays; a pin
    forbids it, as does that load where there are other particles."""
    simulation = Simulation(family("grid", across=2, along=2))
    simulation.patch({"forces": {"net": {"stiffness": 7.0}}, "settings": {"drag": 3.0}})
    simulation.patch({"add": [{"kind": "self_weight", "name": "snow", "mesh": "net", "total": 5.0}]})
    simulation.rebuild({"across": 3})
    assert simulation.system.slots.count == 12
    net, *_, snow = simulation.scene.forces
    assert (np.asarray(net.stiffness).tolist(), snow.name, simulation.scene.settings.drag) == (7.0, "snow", 3.0)
    simulation.patch({"add": [{"kind": "unary", "name": "lamp", "particles": [5], "vector": [0, 0, -1]}]})
    simulation.rebuild({"width": 9.0})
    assert [force.name for force in simulation.scene.forces][-2:] == ["snow", "lamp"]
    with pytest.raises(InputError, match=r"edited after it was made \(the added force 'lamp'\)"):
        simulation.rebuild({"across": 4})
    simulation.patch({"remove": ["lamp"]})
    before = simulation.state.x.copy(), simulation.state.revision
    simulation.patch({"pin": [{"particles": [5]}]})
    with pytest.raises(InputError, match=r"edited after it was made \(anchors\).*undo these edits"):
        simulation.rebuild({"across": 4})
    assert np.array_equal(simulation.state.x, before[0]) and simulation.state.revision == before[1] + 1
    simulation.undo()
    simulation.rebuild({"across": 4})
    with pytest.raises(InputError, match="/family: this model was not made from a family"):
        Simulation(Scene(particles=[[0, 0, 0]])).rebuild({})


def test_a_parameter_that_adds_or_drops_a_force_rebuilds_what_nobody_edited() -> None:
    """Edge cables go where the edges are held, and come back with the corners; a value of the net stays on the way.
    Edge cables that somebody has given another stiffness are not dropped without a word."""
    simulation = Simulation(family("saddle", across=4, along=4))
    simulation.patch({"forces": {"net": {"stiffness": 7.0}}})
    simulation.rebuild({"held": "edges"})
    assert [force.name for force in simulation.scene.forces] == ["net"]
    simulation.rebuild({"held": "corners"})
    assert [force.name for force in simulation.scene.forces] == ["net", "edges"]
    assert np.asarray(simulation.scene.forces[0].stiffness).tolist() == 7.0
    simulation.patch({"forces": {"edges": {"stiffness": 9.0}}})
    with pytest.raises(InputError, match=r"edited after it was made \(edges\)"):
        simulation.rebuild({"held": "edges"})
