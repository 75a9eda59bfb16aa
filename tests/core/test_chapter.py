"""The source chapter's own experiments beside its statements (test_statements.py)."""

from __future__ import annotations

import numpy as np
import pytest

from hookean import InputError, Scene, Simulation, relax, simulate
from hookean.forces.self_weight import SelfWeight
from samples import cable


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


def test_a_total_of_nothing_weighs_nothing():
    """0 N shared by two particles is 0 N each."""
    scene = Scene(
        particles=[[0, 0, 0], [1, 0, 0]],
        forces=[{"kind": "springs", "particles": [[0, 1]]}, {"kind": "self_weight", "particles": [0, 1], "total": 0}],
        anchors=[{"particles": [0, 1]}],
    )
    assert (relax(scene).force("self_weight")["force"] == 0.0).all()


@pytest.mark.parametrize("places", [{"particles": [[0, 1]]}, {"lines": [[[0, 0, 0], [1, 0, 0]]]}])
def test_a_weight_per_length_needs_lengths(places):
    """Pairs and lines have them; points do not, and nothing given has none."""
    assert SelfWeight(**places, per_length=2.0).element_arity == 2
    with pytest.raises(InputError, match="per_length needs lines, pairs of particles or a mesh"):
        SelfWeight(per_length=2.0)
    with pytest.raises(InputError, match="per_length needs lines, pairs of particles or a mesh"):
        SelfWeight(points=[[0, 0, 0]], per_length=2.0)


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
    """9.3: an anchor drawn in the middle of a spring has no influence; here it is an error, or reported, not silent."""
    base = cable().model_dump(exclude={"anchors"})
    anchors = [{"particles": [0, 5]}, {"name": "mid", "points": [[5.0, 0, 0]]}]
    with pytest.raises(InputError, match=r"^/anchors/1/points: mid: its point met no particle"):
        relax(Scene(**base, anchors=anchors))
    result = relax(Scene(**{**base, "strict": False}, anchors=anchors))
    (unmatched,) = result.report.unmatched
    assert (unmatched.pointer, unmatched.name) == ("/anchors/1/points/0", "mid")
    assert unmatched.nearest in (2, 3)
    assert unmatched.distance == pytest.approx(1.0)
    assert len(result.reactions["particles"]) == 2
