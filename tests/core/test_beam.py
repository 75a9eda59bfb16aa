"""Beams against closed forms of bending, torsion and shear, and against rods solved as differential equations."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from hookean import InputError, relax
from hookean.forces.base import Block
from hookean.forces.moments import moment_kernel, moment_skew

from .beam_scenes import CLAMP, SLENDER, load, rod, row, scene, straight

TIGHT = {"tolerance": 1e-10}


def planar(count: int) -> list[dict[str, Any]]:
    """A clamp, and everything held in the xz plane."""
    return [CLAMP, {"particles": list(range(count + 1)), "axes": "y", "rotations": "xz"}]


def rolled(count: int, part: float) -> float:
    """How far a cantilever bent by an end moment of `part` of 2 pi EI / L is from its circle, by its length."""
    moment = 2.0 * np.pi * part
    found = relax(scene(straight(count), [row(count), load(count, moment=(0.0, -moment, 0.0))], planar(count), **TIGHT))
    assert found.converged
    turn = moment * np.linspace(0.0, 1.0, count + 1)
    circle = np.column_stack([np.sin(turn), 0.0 * turn, 1.0 - np.cos(turn)]) / moment
    # what is left of 1e-10 of the load M / l at every particle, at arms of up to 1: l = L / count / 12^0.5
    assert found.reactions["moment"][0] == pytest.approx([0.0, moment, 0.0], abs=4e-10 * count**2 * moment)
    return float(np.abs(found.particles - circle).max())


def test_an_end_moment_rolls_a_cantilever_up_to_a_circle() -> None:
    """M = 2 pi EI / L closes it: kappa = M / EI everywhere. Within 1e-3 of the length with 20 beams is asked for; as
    bending shortens the chord by L phi^2 / 6 of a true arc's phi^2 / 6 - phi^4 / 120, the error is of order 4."""
    coarse, fine = rolled(10, 1.0), rolled(20, 1.0)
    assert fine < 1e-5
    assert np.log2(coarse / fine) == pytest.approx(4.0, abs=0.3)
    assert rolled(8, 0.25) < 1e-5


@pytest.mark.slow
def test_a_quarter_bend_under_a_load_out_of_its_plane() -> None:
    """Bathe and Bolourchi, 1979: an arc of 45 degrees with radius 100, E = 1e7, a unit square section, 600 at its tip
    across its plane. Their 8 elements: tip at (15.9, 47.2, 53.4), within 1 % of the way of 60 it goes; and the rod's
    differential equation, to which 8 beams are within 0.2 % of that."""
    angle = np.linspace(0.0, np.pi / 4.0, 9)
    x = 100.0 * np.column_stack([1.0 - np.cos(angle), np.sin(angle), 0.0 * angle])
    section = {"E": 1e7, "G": 5e6, "A": 1.0, "Iy": 1.0 / 12.0, "Iz": 1.0 / 12.0, "J": 0.1406}
    found = relax(scene(x, [row(8, section, normal=[0, 0, 1]), load(8, (0.0, 0.0, 600.0))], **TIGHT))
    assert found.converged and found.stability == "stable"
    way = np.linalg.norm(found.particles[-1] - x[-1])
    assert np.abs(found.particles[-1] - [15.9, 47.2, 53.4]).max() < 0.01 * way
    frame = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])  # t = y, z up
    stiff = np.array([5e6 * 0.1406, 1e7 / 12.0, 1e7 / 12.0])
    exact = rod(frame, 25.0 * np.pi, np.array([0.0, 0.0, -0.01]), stiff, 1e7, np.array([0.0, 0.0, 600.0]))
    assert np.abs(found.particles[-1] - exact(25.0 * np.pi)[:3]).max() < 2e-3 * way


def wound(count: int, moment: np.ndarray) -> tuple[Any, float]:
    """A cantilever with EI = GJ under an end moment, and how far its tip is from that of the helix."""
    found = relax(scene(straight(count), [row(count), load(count, moment=moment)], **TIGHT))
    s = (np.arange(1000) + 0.5) / 1000
    tip = Rotation.from_rotvec(s[:, None] * moment).apply([1.0, 0.0, 0.0]).mean(axis=0)  # midpoints: to 1e-6
    return found, float(np.abs(found.particles[-1] - tip).max())


@pytest.mark.parametrize("axis", [[1.0, -1.0, 0.0], [1.0, 1.0, 1.0], [0.3, -1.0, 0.2]])
def test_a_moment_oblique_to_its_axis_winds_a_rod_to_a_helix(axis: list[float]) -> None:
    """Where EI = GJ the moment is curvature and twist times EI, whatever its axis: a section at s has turned by
    s M / EI about M, so the rod is a helix. Such a moment has no energy and its tangent is not symmetric, and
    still Newton steps lead there: with the symmetric part alone they take thousands. Errors are of order 2 in the
    length of a beam."""
    moment = 2.5 * np.array(axis) / np.linalg.norm(axis)
    (coarse, far), (fine, near) = wound(10, moment), wound(20, moment)
    for found in (coarse, fine):
        assert found.converged and found.stability == "stable" and found.solver == "auto: newton"
        assert found.iterations < 100
    assert near < 1e-3 and far / near == pytest.approx(4.0, abs=0.2)


def test_the_skew_part_of_a_moments_tangent_is_the_rate_of_its_force() -> None:
    """By central differences of what it adds to a slot, of which the symmetric part is zero; rounding over the step."""
    block = Block.of(np.array([[0, 1, 2]]), arm=0.7, moment=[[3.0, -1.0, 2.0]])
    rates, step = np.zeros((3, 3)), 1e-5
    for axis in range(3):
        for sign in (1.0, -1.0):
            x, f = np.zeros((3, 3)), np.zeros((3, 3))
            x[1, axis] = sign * step
            moment_kernel(x, np.zeros((3, 3)), block.indices, block.parameters, np.zeros((1, 0)), f, np.zeros(3))
            rates[:, axis] -= sign * f[1] / (2.0 * step)
    np.testing.assert_allclose(moment_skew(block)[0, 3:6, 3:6], rates, atol=1e-9)


def test_a_cantilever_bends_far_under_an_end_load() -> None:
    """P L^2 / EI = 2: w / L = 0.49346, u / L = 0.16064 (Bisshopp and Drucker, 1945; Mattiasson, 1981). Its axial strain
    of at most P / EA = 2e-4 moves the end by less than that; the rest is rounding of five digits."""
    found = relax(scene(straight(10), [row(10, {**SLENDER, "A": 100.0}), load(10, (0.0, 0.0, -2.0))], **TIGHT))
    assert found.converged
    assert found.particles[-1] == pytest.approx([1.0 - 0.16064, 0.0, -0.49346], abs=1e-5)


def test_small_loads_bend_twist_and_shear_as_in_handbooks() -> None:
    """One beam, loads so small that angles are 1e-8: P L^3 / 3EI + P L / GAs, rotation P L^2 / 2EI, twist T L / GJ, the
    strong and the weak axis, and N L / EA; terms of second order are less than 1e-5 of all these."""
    section = {"E": 3.0, "G": 1.0, "A": 2.0, "Iy": 0.05, "Iz": 0.02, "J": 0.06, "shear_y": 1.5, "shear_z": 0.9}
    p, length = 1e-9, 2.0
    x = straight(1, length)
    found = relax(scene(x, [row(1, section), load(1, (p, p, p), (p, 0.0, 0.0))], solver="newton", **TIGHT))
    moved = found.particles[1] - x[1]
    y = p * length**3 / (3.0 * 3.0 * 0.02) + p * length / 1.5
    z = p * length**3 / (3.0 * 3.0 * 0.05) + p * length / 0.9
    assert moved == pytest.approx([p * length / 6.0, y, z], rel=1e-4)
    turned = 2.0 * found.rotations["quaternions"][1, 1:]
    bent = [p * length / 0.06, -p * length**2 / (6.0 * 0.05), p * length**2 / (6.0 * 0.02)]
    assert turned == pytest.approx(bent, rel=1e-4)
    assert found.rotations["particles"].tolist() == [0, 1]


def test_a_section_reports_its_forces() -> None:
    """A cantilever along x with an end force: N = Fx, Vy = Fy, Vz = Fz; at its start My = -Fz L, Mz = Fy L and at its
    end none; Mt is the end's moment about x."""
    found = relax(scene(straight(1, 2.0), [row(1), load(1, (3e-5, 2e-5, 1e-5), (4e-5, 0.0, 0.0))], **TIGHT))
    got = found.force("beam")
    expected = {"force": 3e-5, "Vy": 2e-5, "Vz": 1e-5, "Mt": 4e-5, "My0": -2e-5, "Mz0": 4e-5, "My1": 0.0, "Mz1": 0.0}
    for name, value in expected.items():
        assert got[name][0] == pytest.approx(value, rel=1e-3, abs=1e-8), name
    assert got["energy"].sum() == pytest.approx(found.energy["beam"], rel=1e-12)


@pytest.mark.parametrize(("end", "free"), [("release_start", 0), ("release_end", 1)])
def test_a_hinged_end_carries_no_moment(end: str, free: int) -> None:
    """A beam between clamps, one end hinged about y, that end moved by d: 3 EI d / L^3 and the moment 3 EI d / L^2 at
    the other end (handbooks), against 12 and 6 without the hinge."""
    d, held = 1e-5, [{"particles": [0, 1], "targets": [[0, 0, 0], [1, 0, 1e-5]], "rotations": "xyz"}]
    for hinged, force, moment in ((True, 3.0, 3.0), (False, 12.0, 6.0)):
        more = {end: "y"} if hinged else {}
        found = relax(scene(straight(1), [row(1, **more)], held))
        assert found.reactions["force"][1, 2] == pytest.approx(force * d, rel=1e-6)
        assert abs(found.reactions["moment"][1 - free, 1]) == pytest.approx(moment * d, rel=1e-6)
        assert abs(found.reactions["moment"][free, 1]) == pytest.approx(0.0 if hinged else moment * d, abs=1e-12)


def test_a_beam_beside_its_particle_turns_it() -> None:
    """A bar that starts h above its particle and carries N pulls at an arm: a moment of N h at the clamp."""
    offset = {"offset_start": [0.0, 0.0, 0.2], "offset_end": [0.0, 0.0, 0.2]}
    held = [CLAMP, {"particles": [1], "targets": [[1.0001, 0, 0]], "rotations": "xyz"}]
    found = relax(scene(straight(1), [row(1, **offset)], held))
    assert found.force("beam")["force"][0] == pytest.approx(1.0, rel=1e-9)
    assert found.reactions["moment"][:, 1] == pytest.approx([-0.2, 0.2], rel=1e-9)


@pytest.mark.parametrize("lean", [0.3, 1.2, 1.37, 1.5, 1.7])
def test_what_is_bent_in_does_not_depend_on_the_section_s_axes(lean: float) -> None:
    """A kink of 0.4 rad between two beams that are held as drawn, wherever it is to the vertical, where the default z
    axis changes its side: each half of it bends a beam whose far end is a hinge, M = 3 EI / l 0.2, but for tension."""
    turn = np.cumsum([lean, 0.4])
    x = np.concatenate([[[0, 0, 0]], np.cumsum(np.column_stack([np.cos(turn), 0 * turn, np.sin(turn)]), axis=0)])
    section = {"E": 1e4, "G": 4e3, "A": 1.0, "Iy": 1e-3, "Iz": 1e-3, "J": 1e-3}
    held = [{"particles": [0, 1, 2], "rotations": "xz"}]
    found = {}
    for axis, normal in (("My1", None), ("Mz1", [0, 1, 0])):
        more = {"curvature": "straight"} if normal is None else {"curvature": "straight", "normal": normal}
        beams = relax(scene(x, [row(2, section, **more)], held, tolerance=1e-10)).force("beam")
        found[axis] = abs(float(beams[axis][0]))
        assert np.abs(beams["Mt"]).max() < 1e-9
    assert found["My1"] == pytest.approx(found["Mz1"], rel=1e-9)
    assert found["My1"] == pytest.approx(7.415, rel=1e-3)


def test_a_rod_drawn_bent_is_free_of_stress_or_bent_in() -> None:
    """Drawn on a quarter circle: as drawn it stays. Bent in from straight, it springs back to a straight line of the
    same length, for its frames are those of the circle: turned by half a segment at the ends, where the clamp is."""
    count = 8
    angle = np.linspace(0.0, 0.5 * np.pi, count + 1)
    x = np.column_stack([np.sin(angle), 0.0 * angle, 1.0 - np.cos(angle)])
    still = relax(scene(x, [row(count)]))
    assert still.particles == pytest.approx(x, abs=1e-12)
    sprung = relax(scene(x, [row(count, curvature="straight")], **TIGHT)).particles
    first = (x[1] - x[0]) / np.linalg.norm(x[1] - x[0])
    sides = np.linalg.norm(np.diff(x, axis=0), axis=1)
    assert sprung == pytest.approx(np.append(0.0, np.cumsum(sides))[:, None] * first, abs=1e-7)


@pytest.mark.parametrize(
    ("faulty", "words"),
    [
        (row(1, normal=[1, 0, 0]), "along beam 0"),
        (row(1) | {"particles": [[0, 0]]}, "no length"),
        (row(1) | {"E": 0.0}, "more than 0"),
        (row(1, offset_end=[[0, 0, 0]] * 2), "2 values for 1 elements"),
    ],
)
def test_bad_beams_are_refused_in_one_sentence(faulty: dict[str, Any], words: str) -> None:
    """Where, what was given, what to do."""
    with pytest.raises(InputError, match=words):
        relax(scene(straight(1), [faulty]))


def test_a_load_with_moments_reports_both() -> None:
    """The resultant of a force and moments at two ends of beams, the centre, and M and r x F about that: reactions and
    loads add up to nothing, forces and moments about the origin, to 1e-9 of their sizes."""
    forces = np.array([[0.0, 0.0, -2e-3], [1e-3, 0.0, -2e-3]])
    moments = np.array([[0.0, 3e-3, 0.0], [0.0, 0.0, 1e-3]])
    push = {"kind": "unary", "particles": [1, 2], "vector": forces, "moment": moments}
    found = relax(scene(straight(2), [row(2), push], **TIGHT))
    loads, hold = found.loads, found.reactions
    at = found.particles[[1, 2]]
    np.testing.assert_allclose(loads["resultant"][0], forces.sum(axis=0), rtol=1e-15)
    whole = np.cross(loads["centre"][0], loads["resultant"][0]) + loads["moment"][0]
    np.testing.assert_allclose(whole, np.cross(at, forces).sum(axis=0) + moments.sum(axis=0), atol=1e-17)
    np.testing.assert_allclose(hold["force"].sum(axis=0) + loads["resultant"][0], 0.0, atol=1e-9 * 5e-3)
    turned = np.cross(found.particles[hold["particles"]], hold["force"]).sum(axis=0) + hold["moment"].sum(axis=0)
    np.testing.assert_allclose(turned + whole, 0.0, atol=1e-9 * 1e-2)


def test_moments_need_a_rotation() -> None:
    """A moment on a particle of springs alone is refused; held rotations there are a warning."""
    springs = {"kind": "springs", "particles": [[1, 2]]}
    x = straight(2)
    with pytest.raises(InputError, match="particle 2 has a moment but no rotation"):
        relax(scene(x, [row(1), springs, load(2, moment=(1, 0, 0))]))
    held = [CLAMP, {"particles": [2], "rotations": "x"}]
    said = relax(scene(x, [row(1), springs], held)).report.warnings
    assert any("/anchors/1/rotations: particle 2 has no rotation" in one for one in said)
