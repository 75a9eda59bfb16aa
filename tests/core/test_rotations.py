"""Orientations of particles: how they are moved, held, saved, patched, and balanced."""

from __future__ import annotations

import io
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from hookean import Simulation, relax
from hookean.compiled import dispatch
from hookean.forces.rotations import fold, quaternions
from hookean.running.result import kinetic
from hookean.system.system import compile

from .beam_scenes import CLAMP, SLENDER, load, rotation, row, scene, straight

STIFF = {"E": 300.0, "G": 100.0, "A": 1.0, "Iy": 0.05, "Iz": 0.1, "J": 0.1}
KINKED = np.array([[0.0, 0, 0], [1.1, 0.2, -0.1], [1.9, 0.8, 0.2], [2.4, 0.9, 1.1]])


def test_folding_is_the_product_of_both_rotations() -> None:
    """exp(theta) exp(rho) by scipy, for angles up to 3 pi, near 0 and near pi; velocities become angular ones, here by
    differences of the rotation; nothing moves where theta is 0, to the bit."""
    rng = np.random.default_rng(1)
    lengths = rng.uniform(0.1, 3.0, 40)
    size = np.concatenate([np.full(10, 1e-9), rng.uniform(0.0, 9.0, 20), np.pi + rng.uniform(-1e-7, 1e-7, 10)])
    theta, rho, speed = (rng.normal(size=(40, 3)) for _ in range(3))
    theta *= (size / np.linalg.norm(theta, axis=1))[:, None]
    x = np.concatenate([theta, rho]) * np.tile(lengths, 2)[:, None]
    v = np.concatenate([speed * lengths[:, None], np.zeros((40, 3))])
    dispatch.compiled(fold)(x, v, 0, lengths)
    now = Rotation.from_rotvec(theta) * Rotation.from_rotvec(rho)
    back = Rotation.from_rotvec(x[40:] / lengths[:, None])
    assert (x[:40] == 0.0).all()
    assert (now * back.inv()).magnitude().max() < 1e-14
    step = 1e-6
    omega = (Rotation.from_rotvec(theta + step * speed) * Rotation.from_rotvec(theta - step * speed).inv()).as_rotvec()
    assert v[:40] / lengths[:, None] == pytest.approx(omega / (2.0 * step), abs=1e-8)
    assert np.abs(quaternions(x[40:] / lengths[:, None]) @ np.ones(4)).max() <= 2.0 + 1e-12
    before = x.copy(), v.copy()
    dispatch.compiled(fold)(x, v, 0, lengths)
    assert (x == before[0]).all() and (v == before[1]).all()


def test_a_slot_has_the_radius_of_gyration_of_the_elements_there() -> None:
    """l / sqrt(12) of a rod of length l about its middle, l the mean of the elements at the particle."""
    size = np.linalg.norm(np.diff(KINKED, axis=0), axis=1)
    mean = np.array([size[0], (size[0] + size[1]) / 2.0, (size[1] + size[2]) / 2.0, size[2]])
    slots = compile(scene(KINKED, [row(3, STIFF)], [CLAMP])).slots
    assert slots.lengths == pytest.approx(mean / np.sqrt(12.0), rel=1e-12)


def moving(solver: str, step: float, anchors: list[Any]) -> Simulation:
    """Three beams that spin and bend, without drag."""
    velocities = np.cross([2.0, 1.0, 3.0], KINKED) + np.sin(np.arange(12.0)).reshape(4, 3)
    given = scene(KINKED, [row(3, STIFF)], anchors, solver=solver, time_step=step, divide_steps=False, drag=0.0)
    return Simulation(given.replaced(velocities=velocities))


def drift(solver: str, step: float, anchors: list[Any]) -> float:
    """The largest change of energy in a time of 1, by the energy."""
    run = moving(solver, step, anchors)
    start, worst = run.energy, 0.0
    assert start is not None
    for _ in range(round(1.0 / step / 10)):
        run.advance(10)
        now = run.energy
        assert now is not None
        worst = max(worst, abs(now - start))
    return worst / start


@pytest.mark.parametrize(("solver", "order"), [("verlet", 2), ("yoshida", 4)])
@pytest.mark.parametrize("anchors", [[], [CLAMP]], ids=["free", "clamped"])
def test_energy_errors_have_the_order_of_the_scheme(solver: str, order: int, anchors: list[Any]) -> None:
    """Half the step, 2^-order of the error: rotations go by the exponential map, with the moments before and after it
    (Simo and Vu-Quoc 1988). The fastest period has 30 to 60 steps; the next order is a fifth of the error at most."""
    coarse, fine = (drift(solver, step, anchors) for step in (4e-3, 2e-3))
    assert np.log2(coarse / fine) == pytest.approx(order, abs=0.4)


def test_what_is_free_keeps_its_angular_momentum() -> None:
    """sum of m x cross v + J omega, J = m l^2, to 1e-12 in 500 steps: forces and moments of beams sum to zero."""
    run = moving("verlet", 4e-3, [])
    slots, state, mass = run.system.slots, run.state, run.system.mass

    def momentum() -> np.ndarray:
        x, v = state.x[: slots.count], state.v[: slots.count]
        spin = mass[slots.first, None] * state.v[slots.first] * slots.lengths[:, None]
        return np.asarray((mass[: slots.count, None] * np.cross(x, v)).sum(axis=0) + spin.sum(axis=0))

    first = momentum()
    run.advance(500)
    assert np.abs(momentum() - first).max() < 1e-12 * np.abs(first).max()
    assert kinetic(run.system, state) > 0.0


def test_a_turned_scene_has_the_turned_result() -> None:
    """Everything turned by 2 rad about a skew axis and shifted: the same shape, reactions and moments, turned, and
    orientations Q R Q^T, to the tolerance of the equilibrium."""
    turn, shift = Rotation.from_rotvec([1.2, -0.9, 1.3]), np.array([3.0, -2.0, 1.0])
    results = []
    for q, s in ((Rotation.identity(), np.zeros(3)), (turn, shift)):
        force, moment, normal = (q.apply(a) for a in ([2.0, 5.0, -4.0], [1.0, 3.0, 2.0], [0.0, 0.0, 1.0]))
        beams = row(3, STIFF, normal=normal.tolist())
        results.append(relax(scene(q.apply(KINKED) + s, [beams, load(3, force, moment)], tolerance=1e-12)))
    one, other = results
    assert one.converged and other.converged
    assert other.particles == pytest.approx(turn.apply(one.particles) + shift, abs=1e-9)
    for name in ("force", "moment"):
        assert other.reactions[name] == pytest.approx(turn.apply(one.reactions[name]), abs=1e-9)
    for place in range(4):
        assert (rotation(other, place) * (turn * rotation(one, place) * turn.inv()).inv()).magnitude() < 1e-9
    assert other.force("beam")["My0"] == pytest.approx(one.force("beam")["My0"], abs=1e-9)


def test_forces_and_moments_balance() -> None:
    """Reactions + loads = 0, and so are their moments, with supports that give way and a hinged end: 1e-9 of all."""
    support = {"kind": "support", "particles": [3], "stiffness": [0, 40.0, 40.0], "rotation_stiffness": [5.0, 0, 2.0]}
    loads = [load(2, (4.0, -3.0, -9.0), (2.0, 1.0, 3.0)), load(1, (0.0, 6.0, 1.0))]
    beams = row(3, STIFF, offset_end=[0.0, 0.0, 0.1], release_end="y")
    found = relax(scene(KINKED, [beams, support, *loads], tolerance=1e-12))
    assert found.converged and found.stability == "stable"
    x, held = found.particles, found.reactions["particles"]
    total, moment = found.reactions["force"].sum(axis=0), found.reactions["moment"].sum(axis=0)
    moment = moment + np.cross(x[held], found.reactions["force"]).sum(axis=0)
    for columns in found.forces[2:]:  # the support is among the reactions
        at = columns["particles"][:, 0]
        total = total + columns["force"].sum(axis=0)
        moment = moment + columns["moment"].sum(axis=0) + np.cross(x[at], columns["force"]).sum(axis=0)
    assert np.abs(total).max() < 1e-9 * 16.0
    assert np.abs(moment).max() < 1e-9 * 16.0 * 3.0
    assert np.abs(found.forces[1]["moment"]).max() > 0.1  # the support turns


@pytest.mark.parametrize("far", [0.0, 1e3])
def test_a_beam_that_nothing_holds_has_six_mechanisms(far: float) -> None:
    """Three shifts and three rotations; twist, bending and stretching resist. So it is far from the origin."""
    found = relax(scene(KINKED + far, [row(3, STIFF)], []))
    assert found.stability == "mechanism" and found.soft_modes == 6


def test_anchors_hold_the_rotations_they_name() -> None:
    """A beam on two supports, its ends held about x alone: it bends freely about y (P L^3 / 48 EI) and does not twist
    under a torque in its middle: T / 2 at both ends."""
    ends = [{"particles": [0, 2], "rotations": "x"}]
    found = relax(scene(straight(2), [row(2), load(1, (0, 0, -1e-4), (1e-3, 0, 0))], ends, tolerance=1e-11))
    assert found.particles[1, 2] == pytest.approx(-1e-4 / 48.0, rel=1e-5)
    assert found.reactions["moment"][:, 0] == pytest.approx([-5e-4, -5e-4], rel=1e-6)
    assert found.reactions["moment"][:, 1:] == pytest.approx(0.0, abs=1e-12)
    assert found.force("beam")["Mt"] == pytest.approx([5e-4, -5e-4], rel=1e-6)
    only = relax(scene(straight(1), [row(1)], [{"particles": [0, 1], "axes": "", "rotations": "xyz"}]))
    assert only.reactions["particles"].tolist() == [0, 1] and only.soft_modes == 3


def bending() -> Simulation:
    """A clamped row with a load at its end, in motion."""
    given = scene(straight(4), [row(4), load(4, (0, 0, -1.0), (0.3, 0.1, 0))], None, solver="verlet", time_step=1e-4)
    return Simulation(given)


def test_a_saved_simulation_goes_on_to_the_bit() -> None:
    """200 steps at once, and 100 steps, saved and read back, and 100 more, with orientations far from their start."""
    whole, half, file = bending(), bending(), io.BytesIO()
    whole.advance(200)
    half.advance(60)
    half.advance(40)
    half.save(file)
    file.seek(0)
    again = Simulation.load(file)
    again.advance(100)
    assert (again.state.x == whole.state.x).all() and (again.state.v == whole.state.v).all()
    frame = again.frame()
    assert frame.particles.shape == (5, 3) and (frame.rotations == again.result().rotations["quaternions"]).all()


def test_patches_hold_release_and_turn() -> None:
    """Another moment, a pin that holds a rotation, a release that frees both; undo takes them back."""
    run = bending()
    slots = run.system.slots
    run.patch({"forces": {"1": {"moment": [0.0, -1.0, 0.0]}}, "pin": [{"particles": [2], "rotations": "xyz"}]})
    run.advance(50)
    held = run.state.free[slots.rows(np.array([0, 2, 3]))]
    assert held.tolist() == [[0, 0, 0], [0, 0, 0], [1, 1, 1]]
    assert run.result().forces[1]["moment"].tolist() == [[0.0, -1.0, 0.0]]
    run.patch({"release": [2]})
    assert (run.state.free[slots.rows(np.array([2]))] == 1.0).all()
    run.undo()
    assert (run.state.free[slots.rows(np.array([2]))] == 0.0).all()
    assert (run.state.free[slots.references] == 0.0).all()
    edited = run.edited_scene()
    assert [anchor.rotations for anchor in edited.anchors] == ["xyz", "xyz"]


def test_beams_that_come_and_go_take_their_rotations_along() -> None:
    """Another beam gives another particle an orientation; those that were there keep theirs, and it goes with undo."""
    x = np.vstack([straight(2), [[1.0, 1.0, 0.0]]])
    run = Simulation(scene(x, [row(2), load(2, (0, 0, -1.0))], None, solver="verlet", time_step=1e-4))
    run.advance(200)
    before = run.result()
    run.patch({"add": [{"kind": "beam", "particles": [[2, 3]], **SLENDER}]})
    after = run.result()
    assert after.rotations["particles"].tolist() == [0, 1, 2, 3]
    assert after.rotations["quaternions"][:3] == pytest.approx(before.rotations["quaternions"], abs=1e-15)
    assert after.particles.tolist() == before.particles.tolist()
    run.undo()
    assert run.result().rotations["quaternions"] == pytest.approx(before.rotations["quaternions"], abs=1e-15)
    run.advance(10)
    assert run.finite


def test_scenes_without_beams_have_no_slots() -> None:
    """No row more than particles, and empty rotations and moments."""
    springs = {"kind": "springs", "particles": [[0, 1], [1, 2]]}
    found = relax(scene(straight(2), [springs, load(1, (0, 0, -1.0))], [{"particles": [0, 2]}]))
    assert found.rotations["quaternions"].shape == (0, 4) and found.reactions["moment"].shape == (0, 3)
    system = compile(scene(straight(2), [springs]))
    assert len(system.x) == len(system.start().x) == 3
