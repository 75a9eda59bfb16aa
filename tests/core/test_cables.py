"""Cables against closed forms: exact where the discrete model is exact, orders of convergence where it converges."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq, fsolve

from hookean import Scene, relax


def chain(points, stiffness, rest, loads, **settings):
    count = len(points)
    return Scene(
        particles=points,
        forces=[
            {
                "kind": "springs",
                "particles": [[i, i + 1] for i in range(count - 1)],
                "stiffness": stiffness,
                "rest_length": rest,
            },
            {"kind": "unary", "particles": list(range(count)), "vector": loads},
        ],
        anchors=[{"particles": [0, count - 1]}],
        settings={"tolerance": 1e-12, **settings},
    )


def sagging(span, length, segments):
    """A parabola of about the right length to start from; any start would do."""
    t = np.linspace(0.0, 1.0, segments + 1)
    sag = np.sqrt(max(3.0 * span * (length - span) / 8.0, 0.01 * span**2))
    return np.stack([span * t, 0 * t, -4.0 * sag * t * (1 - t)], axis=1)


def weights(weight, segments):
    """Self-weight of a cable lumped to its particles: half at the ends."""
    loads = np.zeros((segments + 1, 3))
    loads[:, 2] = -weight / segments
    loads[[0, -1], 2] /= 2.0
    return loads


def test_elastic_catenary_is_approached_with_order_two():
    """span = H L0/EA + (2H/w) asinh(w L0/2H); span 10, L0 10, EA 1000, w 10: H 69.97639580, sag 1.72776504,
    L 10.75541873."""
    exact = np.array([69.97639580, 1.72776504, 10.75541873])
    found = []
    for segments in (10, 20, 40):
        rest = 10.0 / segments
        scene = chain(sagging(10, 10.5, segments), 1000 / rest, rest, weights(100.0, segments))
        result = relax(scene)
        assert result.converged
        thrust = abs(result.reactions["force"][0, 0])
        sag = -result.particles[:, 2].min()
        length = result.force("springs")["length"].sum()
        found.append([thrust, sag, length])
    errors = np.abs(np.array(found) / exact - 1.0)
    assert np.log2(errors[:-1] / errors[1:]) == pytest.approx(np.full((2, 3), 2.0), abs=0.15)
    # Richardson: without the h^2 term, h^4 is left, about the square of the error at 40 segments
    better = np.array(found[2]) + (np.array(found[2]) - found[1]) / 3.0
    assert better == pytest.approx(exact, rel=10 * errors[-1].max() ** 2)


def test_an_elastic_catenary_with_a_point_load_is_approached_with_order_two():
    """Irvine, Cable Structures, 1981, section 1.3: with s the unstressed length from the left end, z down, H the thrust
    and T(s) = V - w s, less P beyond the load, what pulls down across it, x' = H / EA + H / N, z' = T / EA + T / N, N^2
    = H^2 + T^2. Both integrals are closed forms (asinh and a root). Span 10, L0 11, EA 500, w 2, P 30 at three tenths
    of L0."""
    span, length, axial, weight, load, at = 10.0, 11.0, 500.0, 2.0, 30.0, 3.3

    def piece(thrust, up, size):
        """x and z of a piece without a point load, from the force across its start."""
        over = up - weight * size
        ends = np.array([up, over])
        x = thrust * size / axial + thrust / weight * -np.diff(np.arcsinh(ends / thrust))[0]
        z = 0.5 * (up**2 - over**2) / (weight * axial) - np.diff(np.hypot(thrust, ends))[0] / weight
        return np.array([x, z])

    def parts(u):
        return piece(u[0], u[1], at), piece(u[0], u[1] - weight * at - load, length - at)

    u, _, fine, said = fsolve(lambda u: sum(parts(u)) - [span, 0.0], [30.0, 25.0], full_output=True, xtol=1e-13)
    assert fine == 1, said
    exact, found = np.array([*u, *parts(u)[0]]), []
    for segments in (10, 20, 40):
        rest, loaded = length / segments, 3 * segments // 10
        loads = weights(weight * length, segments)
        loads[loaded, 2] -= load
        result = relax(chain(sagging(span, length, segments), axial / rest, rest, loads))
        assert result.converged
        pull, place = result.reactions["force"][0], result.particles[loaded]
        found.append([-pull[0], pull[2], place[0], -place[2]])
    found = np.array(found)
    errors = np.abs(found / exact - 1.0)
    assert np.log2(errors[:-1] / errors[1:]) == pytest.approx(np.full((2, 4), 2.0), abs=0.15)
    better = found[1:] + np.diff(found, axis=0) / 3.0  # Richardson: without the h^2 term, h^4 is left
    errors = np.abs(better / exact - 1.0)
    assert np.log2(errors[0] / errors[1]) == pytest.approx(np.full(4, 4.0), abs=0.3)


def test_inextensible_catenary_is_the_limit_of_stiff_cables():
    """y = a cosh(x/a), L = 2a sinh(b/2a); span 10, L 12: a 4.69541523, sag 2.92343798, Tmax 7.61885321 (w = 1)."""
    errors = []
    for segments in (20, 40, 80):
        # stiffness grows with n so that stretch (about T/EA) falls as fast as the mesh error, h^2
        axial = 200.0 * segments**2
        rest = 12.0 / segments
        result = relax(chain(sagging(10, 12, segments), axial / rest, rest, weights(12.0, segments)))
        assert result.converged
        tension = np.linalg.norm(result.reactions["force"][0])
        errors.append([-result.particles[:, 2].min() / 2.92343798 - 1, tension / 7.61885321 - 1])
    errors = np.abs(errors)
    slopes = np.log2(errors[:-1] / errors[1:])
    assert slopes == pytest.approx(np.full((2, 2), 2.0), abs=0.15)
    assert errors[-1].max() < 3e-4


@pytest.mark.parametrize("segments", [3, 8, 31])
def test_nodes_of_an_equally_loaded_force_density_chain_lie_on_a_parabola(segments: int):
    """Equal q and equal nodal loads P: q (z[i+1] - 2 z[i] + z[i-1]) = P, so z = -P x (n - x)/2q at x = i: exact."""
    points = np.stack([np.linspace(0, 10, segments + 1), np.zeros(segments + 1), np.zeros(segments + 1)], axis=1)
    result = relax(chain(points, 5.0, 0.0, [0, 0, -2.0]))
    i = np.arange(segments + 1)
    assert result.solver == "auto: force_density"
    assert result.particles[:, 2] == pytest.approx(-2.0 * i * (segments - i) / 10.0, rel=1e-12, abs=1e-12)
    assert result.particles[:, 0] == pytest.approx(points[:, 0], abs=1e-12)
    # tangents in arithmetic progression
    assert np.diff(np.diff(result.particles[:, 2])) == pytest.approx(np.full(segments - 1, 0.4), rel=1e-10)


def test_parabola_under_uniform_horizontal_load_has_the_thrust_of_the_closed_form():
    """H = w b^2/8s: w 1, span 10, sag 1: H 12.5; the discrete chain with equal horizontal spacing is exact, and its
    end tension tends to Tmax 13.46291202 = sqrt(H^2 + (w b/2)^2)."""
    segments = 40
    spacing = 10.0 / segments
    density = 12.5 / spacing
    points = np.stack([np.linspace(0, 10, segments + 1), np.zeros(segments + 1), np.zeros(segments + 1)], axis=1)
    result = relax(chain(points, density, 0.0, weights(10.0, segments)))
    force = result.reactions["force"][0]
    assert -result.particles[:, 2].min() == pytest.approx(1.0, rel=1e-12)
    assert abs(force[0]) == pytest.approx(12.5, rel=1e-12)
    assert np.linalg.norm(force) == pytest.approx(13.46291202, abs=5e-9)


@pytest.mark.parametrize(("tension", "stiffness", "load"), [(5.0, 100.0, 1.0), (0.0, 100.0, 3.0), (20.0, 1e4, 7.0)])
def test_two_link_string_meets_the_exact_load(tension: float, stiffness: float, load: float):
    """P = 2 (T0 + k (sqrt(L^2 + d^2) - L)) d / sqrt(L^2 + d^2) with L = 1 per link."""

    def pull(d: float) -> float:
        length = np.hypot(1.0, d)
        return 2.0 * (tension + stiffness * (length - 1.0)) * d / length - load

    expected = brentq(pull, 0.0, 10.0, xtol=1e-15)
    loads = [[0, 0, 0], [0, 0, -load], [0, 0, 0]]
    rest = 1.0 - tension / stiffness
    result = relax(chain([[-1, 0, 0], [0, 0, 0], [1, 0, 0]], stiffness, rest, loads))
    assert result.converged
    assert -result.particles[1, 2] == pytest.approx(expected, rel=1e-9)


def test_one_free_node_of_a_force_density_net():
    """z = (sum q z_i + P)/sum q; supports at 0, 0, 1, 1, q 1, P -1: 0.25."""
    scene = Scene(
        particles=[[0, 0, 0], [1, 0, 0], [-1, 0, 0], [0, 1, 1], [0, -1, 1]],
        forces=[
            {"kind": "springs", "particles": [[0, i] for i in range(1, 5)], "stiffness": 1, "rest_length": 0},
            {"kind": "unary", "particles": [0], "vector": [0, 0, -1]},
        ],
        anchors=[{"particles": [1, 2, 3, 4]}],
    )
    for name in ("auto", "relaxation", "newton", "momentum"):
        settings = {"solver": name, "tolerance": 1e-12}
        result = relax(Scene.read({**scene.model_dump(exclude={"settings"}), "settings": settings}))
        assert result.particles[0] == pytest.approx([0, 0, 0.25], abs=1e-11)


def test_momentum_is_the_published_iteration_of_kangaroo_2():
    """Golden case: springs of rest length 0 and soft anchors of strength 10000; 50 iterations, to 1e-12."""
    from hookean import Simulation

    scene = Scene(
        particles=[[0, 0, 0], [-1, 1, 0], [1, 0, 0], [0, 2, 0]],
        forces=[
            {
                "kind": "springs",
                "particles": [[0, 1], [0, 2], [0, 3]],
                "stiffness": [3.5355339059327373, 6, 2.5],
                "rest_length": 0,
            },
            {"kind": "anchor_spring", "particles": [1, 2, 3], "strength": 10000},
        ],
        settings={"solver": "momentum", "tolerance": 0},
    )
    simulation = Simulation(scene)
    simulation.iterate(50)
    golden = [
        [0.204663774296581, 0.709309307605647, 0],
        [-0.999574237567416, 0.999897261645, 0],
        [0.999523084414622, 0.00042533038873443, 0],
        [5.11531555739133e-05, 1.99967740797591, 0],
    ]
    assert simulation.state.iteration == 50
    assert simulation.state.x == pytest.approx(np.array(golden), abs=1e-12)
