"""The source chapter's own experiments, at the numbers of independent solutions."""

from __future__ import annotations

import numpy as np
import pytest

from hookean import Scene, Simulation, relax, simulate
from samples import cable


def test_loaded_cable_has_the_length_of_an_independent_solution():
    """9.4, figure 9.11 at k = 1000: total length 10.4679154891668 and the tensions of an independent Newton solve."""
    result = relax(cable(tolerance=1e-12))
    springs = result.force("cable")
    assert result.converged
    assert springs["length"].sum() == pytest.approx(10.4679154891668, rel=1e-12)
    lengths = [2.09782876, 2.09149025, 2.08927747, 2.09149025, 2.09782876]
    assert springs["length"] == pytest.approx(lengths, abs=5e-9)
    assert springs["force"][:3] == pytest.approx([97.82876, 91.49025, 89.27747], abs=5e-6)
    assert abs(result.reactions["force"][0, 0]) == pytest.approx(89.2774672004597, rel=1e-9)
    assert -result.particles[:, 2].min() == pytest.approx(1.3149604882, abs=5e-11)


def test_springs_nearer_the_supports_stretch_more():
    """9.4: the springs at the supports carry the weight of the others; lengths fall towards the middle."""
    length = relax(cable(tolerance=1e-12)).force("cable")["length"]
    assert length[0] > length[1] > length[2]
    assert length == pytest.approx(length[::-1], rel=1e-10)


def hooke(load: float, damping: float = 10.0, length: float = 80.0) -> Scene:
    """Figure 9.13: a vertical spring of 80 cm, k = 2 N/cm; its end starts `length` below the anchor."""
    return Scene(
        units={"length": "cm"},
        particles=[[0, 0, 0], [0, 0, -length]],
        forces=[
            {"kind": "springs", "particles": [[0, 1]], "stiffness": 2, "rest_length": 80, "damping": damping},
            {"kind": "unary", "particles": [1], "vector": [0, 0, -load]},
        ],
        anchors=[{"particles": [0]}],
        settings={"tolerance": 1e-12},
    )


@pytest.mark.parametrize("damping", [0.0, 1.0, 10.0, 100.0])
def test_hooke_extends_by_force_over_stiffness_for_every_damping(damping: float):
    """F = k X: 100 N / 2 N/cm = 50 cm, and back to 80 cm without the load; damping changes neither."""
    assert relax(hooke(100.0, damping)).force("springs")["length"][0] == pytest.approx(130.0, rel=1e-12)
    released = relax(hooke(0.0, damping, length=130.0))
    assert released.converged
    assert released.force("springs")["length"][0] == pytest.approx(80.0, rel=1e-9)


def test_damping_changes_how_long_it_takes_and_nothing_else():
    """9.4: with more damping the oscillation of a loaded spring dies sooner; the length it settles at is 130 cm."""

    def swing(damping: float) -> np.ndarray:
        scene = hooke(100.0, damping)
        scene = scene.model_copy(update={"settings": scene.settings.model_copy(update={"drag": 0.0})})
        return np.array([-frame.particles[1, 2] for frame in simulate(scene, 300)])

    little, much = swing(0.1), swing(1.0)
    # amplitude decays as exp(-c t / 2m): 60 s of c = 0.1 leave e^-3 of 50 cm, of c = 1 they leave e^-30
    assert np.ptp(little[-60:]) > 1.0
    assert much[-60:] == pytest.approx(130.0, abs=1e-6)


def arc(chord: float, chord_rest: bool) -> Scene:
    """Figures 9.18 to 9.21: an arc of length 20 over a chord, 50 equal pieces, k 7000, -1 z on every particle."""
    from scipy.optimize import brentq

    half = brentq(lambda a: chord * a - 20.0 * np.sin(a), 0.1, np.pi - 1e-9)
    angle = np.linspace(-half, half, 51)
    radius = 10.0 / half
    points = np.stack([radius * np.sin(angle), 0 * angle, radius * (np.cos(angle) - np.cos(half))], axis=1)
    return Scene(
        particles=points,
        forces=[
            {
                "kind": "springs",
                "particles": [[i, i + 1] for i in range(50)],
                "stiffness": 7000,
                "rest_length": None if chord_rest else 0.4,
                "rest_factor": 0.995,
            },
            {"kind": "unary", "particles": list(range(51)), "vector": [0, 0, -1]},
        ],
        anchors=[{"particles": [0, 50]}],
        settings={"tolerance": 1e-12},
    )


@pytest.mark.parametrize(
    ("chord", "chord_rest", "length", "sag", "shortest", "longest"),
    [
        (10.0, False, 20.001882, 7.968775, 0.398825, 0.401595),
        (14.0, False, 20.027107, 6.414536, 0.399649, 0.401868),
        (10.0, True, 19.997125, 7.966111, None, None),
        (14.0, True, 20.024488, 6.412823, None, None),
    ],
)
def test_arc_becomes_the_catenary(chord, chord_rest, length, sag, shortest, longest):
    """9.5: rest length 0.995 of the piece's arc, or of its chord (what the canvas measures)."""
    result = relax(arc(chord, chord_rest))
    lengths = result.force("springs")["length"]
    assert result.converged
    assert lengths.sum() == pytest.approx(length, abs=1e-6)
    assert -result.particles[:, 2].min() == pytest.approx(sag, abs=1e-6)
    if shortest is not None:
        assert (lengths.min(), lengths.max()) == pytest.approx((shortest, longest), abs=1e-6)


def test_self_weight_is_the_total_over_the_number_of_particles():
    """9.5: 10 N on 51 particles is 0.19607843 N each."""
    scene = Scene(
        particles=[[0.4 * i, 0, 0] for i in range(51)],
        forces=[
            {"kind": "springs", "particles": [[i, i + 1] for i in range(50)]},
            {"kind": "self_weight", "total": 10},
        ],
        anchors=[{"particles": [0, 50]}],
    )
    weights = relax(scene).force("self_weight")["force"]
    assert weights[:, 2] == pytest.approx(np.full(51, -10 / 51), rel=1e-15)


def test_weight_per_length_follows_the_start_lengths():
    """Half of each line's weight at its ends: 3 N/m on lines of 1 m and 2 m."""
    scene = Scene(
        forces=[
            {"kind": "springs", "lines": [[[0, 0, 0], [1, 0, 0]], [[1, 0, 0], [3, 0, 0]]]},
            {"kind": "self_weight", "lines": [[[0, 0, 0], [1, 0, 0]], [[1, 0, 0], [3, 0, 0]]], "per_length": 3},
        ],
        anchors=[{"particles": []}, {"points": [[0, 0, 0], [3, 0, 0]]}],
    )
    assert relax(scene).force("self_weight")["force"][:, 2] == pytest.approx([-1.5, -4.5, -3.0], rel=1e-15)


def test_bouncing_cable_approaches_its_motion_with_order_two():
    """Frames 3 to 6 of the cable in physical time: limits for dt -> 0, errors falling as dt^2 (slope 2 +- 0.15)."""
    exact = np.array([10.91177, 10.39787, 10.20220, 10.25620])

    def lengths(step: float) -> np.ndarray:
        scene = cable(time_step=step, sub_iterations=round(0.2 / step))
        frames = [f.particles for f in simulate(scene, 6)][3:]
        return np.array([np.linalg.norm(np.diff(x, axis=0), axis=1).sum() for x in frames])

    coarse, middle, fine = lengths(0.01), lengths(0.005), lengths(0.0025)
    assert fine == pytest.approx(exact, abs=4e-5)
    extrapolated = fine + (fine - middle) / 3.0
    assert extrapolated == pytest.approx(exact, abs=6e-6)
    slope = np.log2(np.abs(coarse - middle).max() / np.abs(middle - fine).max())
    assert slope == pytest.approx(2.0, abs=0.15)
    assert coarse == pytest.approx([10.91138, 10.39792, 10.20197, 10.25700], abs=6e-4)


def test_anchor_dragged_away_and_back_returns_to_the_first_equilibrium():
    """Figures 9.7 and 9.8: the cable follows its anchor; put back, so is the shape. A reset keeps the supports."""
    simulation = Simulation(cable(tolerance=1e-10))
    first = simulation.relax()
    simulation.patch({"move": [{"anchor": "ends", "targets": [[0, 0, 0], [8, 1, 2]]}]})
    moved = simulation.relax()
    assert moved.converged
    assert moved.particles[5] == pytest.approx([8, 1, 2], abs=0)
    simulation.patch({"move": [{"anchor": "ends", "targets": [[0, 0, 0], [10, 0, 0]]}]})
    # a residual of 1e-10 of 20 N over the softest stiffness (transverse, about 45 N/m) is 5e-11 m; two such ends
    assert simulation.relax().particles == pytest.approx(first.particles, abs=2e-9)
    simulation.patch({"move": [{"anchor": "ends", "targets": [[0, 0, 0], [8, 1, 2]]}]})
    simulation.reset()
    again = simulation.relax()
    assert list(again.reactions["particles"]) == [0, 5]
    assert again.particles == pytest.approx(moved.particles, abs=2e-9)


def test_anchor_that_meets_no_particle_is_told_with_the_nearest():
    """9.3: an anchor drawn in the middle of a spring has no influence; here it is reported, not silent."""
    base = cable().model_dump(exclude={"anchors"})
    anchors = [{"particles": [0, 5]}, {"name": "mid", "points": [[5.0, 0, 0]]}]
    result = relax(Scene(**base, anchors=anchors))
    (unmatched,) = result.report.unmatched
    assert (unmatched.pointer, unmatched.name) == ("/anchors/1/points/0", "mid")
    assert unmatched.nearest in (2, 3)
    assert unmatched.distance == pytest.approx(1.0)
    assert len(result.reactions["particles"]) == 2


def test_rest_length_factor_below_one_tightens_and_above_one_slackens():
    """9.4: rest < start pre-tensions (k L (1 - f)), rest = start is stress-free, rest > start pushes."""
    forces = []
    for factor in (0.8, 1.0, 1.2):
        scene = Scene(
            particles=[[0, 0, 0], [1, 0, 0], [2, 0, 0]],
            forces=[{"kind": "springs", "particles": [[0, 1], [1, 2]], "stiffness": 100, "rest_factor": factor}],
            anchors=[{"particles": [0, 2]}],
        )
        forces.append(relax(scene).force("springs")["force"])
    assert np.array(forces) == pytest.approx(np.array([[20.0] * 2, [0.0] * 2, [-20.0] * 2]), abs=1e-12)
