"""Which corners make a rod, to which side it bends, and what patches and anchors change of that while it runs."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean import Scene, relax
from hookean.linear.subsystem import cut
from hookean.running.simulation import Simulation
from hookean.system.system import compile

from .rods import RISE, apart, arch, bending, coil, corners_of, rod, several, shaken


def evaluated(x: np.ndarray, shape: np.ndarray, **bend: Any) -> tuple[np.ndarray, np.ndarray, float]:
    """Forces, lumped stiffness and energy of a rod drawn at x, in another shape."""
    system = compile(Scene(particles=x, forces=[{"kind": "bend", **bend}]))
    state = system.start()
    state.x = np.ascontiguousarray(shape)
    f, w, energies = system.evaluate(state)
    return f, w, float(energies.sum())


@pytest.mark.parametrize("closed", [False, True])
def test_corners_are_given_in_any_order_and_direction(closed: bool) -> None:
    """The same numbers to the bit; and to rounding from the other end, with particles numbered backwards."""
    rng = np.random.default_rng(3)
    x, _, _ = several()["closed"]
    rows, k = corners_of(10, closed=closed), rng.uniform(1, 3, 10 if closed else 8)
    shape = x + 0.2 * rng.uniform(-1, 1, x.shape)
    f, w, energy = evaluated(x, shape, particles=rows, stiffness=k)
    for _ in range(20):
        order, turned = rng.permutation(len(rows)), rng.integers(0, 2, len(rows)) == 1
        given = np.where(turned[:, None], rows[:, ::-1], rows)[order]
        g, u, same = evaluated(x, shape, particles=given, stiffness=k[order])
        assert (f == g).all() and (w == u).all() and energy == same
    back = 9 - rows
    g, _, same = evaluated(x[::-1], shape[::-1], particles=back, stiffness=k)
    assert same == pytest.approx(energy, rel=1e-13)
    assert np.abs(g[::-1] - f).max() <= 1e-13 * w.max()


@pytest.mark.parametrize("origin", [0.0, -7.0, 1e3])
def test_what_makes_a_rod_does_not_depend_on_where_it_is_drawn(origin: float) -> None:
    """Corners of segments with lengths that do not fold back make one rod, two links of three corners; beside one that
    folds back, or that has a segment of zero length, there are no links."""
    straight = np.array([[0, 0, 0], [1, 0, 0], [2, 0.3, 0], [3, 0.1, 0.2], [4, 0, 0]], float)
    folded = straight.copy()
    folded[3] = straight[2] + 0.7 * (straight[1] - straight[2])
    short = straight.copy()
    short[3] = short[2]
    for x, links in ((straight, 2), (folded, 0), (short, 0)):
        bend = {"kind": "bend", "particles": corners_of(5), "rest_angle": 0.1}
        block = compile(Scene(particles=x + origin, forces=[bend])).groups[0].block
        assert np.count_nonzero(block.parameters[:, block.names.index("next")]) == links


def test_rows_of_results_are_those_of_the_input() -> None:
    """In disorder, angles and moments belong to the corners given, and so do their particles."""
    x = coil(6, 1.0, 0.2)
    rows, order = corners_of(7), np.array([3, 0, 4, 1, 2])
    k = np.arange(1.0, 6.0)
    anchors = [{"particles": np.arange(7)}]
    plain, mixed = (
        relax(Scene(particles=x, forces=[{"kind": "bend", "particles": r, "stiffness": s, "rest_angle": 0.2}],
                    anchors=anchors)).force("bend")
        for r, s in ((rows, k), (rows[order][:, ::-1], k[order]))
    )  # fmt: skip
    assert np.array_equal(mixed["particles"], rows[order][:, ::-1])
    for column in ("angle", "moment"):
        assert mixed[column] == pytest.approx(plain[column][order], rel=1e-13)


def test_where_three_corners_share_a_segment_chains_end() -> None:
    """A spin of one limb about its own axis costs nothing; where the limb goes on as one rod it does. A rod that is
    drawn twice in one force has no chains either."""
    x = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0.3, 0], [3, 1.0, 0], [2.9, -0.6, 0.2]])
    turn = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])
    shape = x.copy()  # what is beyond particle 2 is turned by 90 degrees about the segment 1-2
    axis = (x[2] - x[1]) / np.linalg.norm(x[2] - x[1])
    side = np.cross(axis, [0, 0, 1])
    basis = np.array([axis, side, np.cross(axis, side)])
    shape[3:] = (x[3:] - x[2]) @ basis.T @ turn.T @ basis + x[2]
    one = {"particles": [[0, 1, 2], [1, 2, 3]]}
    assert evaluated(x, shape, **one)[2] > 1e-2
    for rows in ([[0, 1, 2], [1, 2, 3], [1, 2, 4]], [[0, 1, 2], [1, 2, 3], [3, 2, 1]]):
        assert evaluated(x, shape, particles=rows)[2] <= 1e-25


@pytest.mark.parametrize("sections", ["tied", "free"])
def test_a_straight_rod_with_a_rest_angle_bends_to_one_side(sections: str) -> None:
    """Tied sections: pushed a little out of line it becomes the arc of that angle, in a plane of its own; distances of
    particles j apart are sin(j phi / 2) / sin(phi / 2). Corners that spin freely bend each where it was pushed."""
    n, phi = 12, 0.15
    x = np.column_stack([np.arange(n + 1.0), np.zeros(n + 1), np.zeros(n + 1)])
    scene = Scene(particles=x, forces=rod(x, 1e3, rest_angle=phi, sections=sections), settings={"tolerance": 1e-9})
    result = shaken(scene, 1e-3)
    assert result.converged, result.message
    j = np.abs(np.subtract.outer(np.arange(n + 1), np.arange(n + 1)))
    off = np.abs(apart(result.particles) - np.sin(j * phi / 2) / np.sin(phi / 2)).max()
    assert off <= 1e-6 if sections == "tied" else off > 0.1


def test_corners_drawn_straight_take_the_side_of_the_bend_before_them() -> None:
    """Straight, bent to the left, straight, and 0.2 rad wanted at every corner: an arc to the left."""
    heading = np.array([0, 0, 0, 0.1, 0.1, 0.1, 0.1])
    wanted = 0.2 * np.arange(7)
    drawn, arc = (np.vstack([np.zeros(3), np.cumsum(np.column_stack([np.cos(h), np.sin(h), 0 * h]), axis=0)])
                  for h in (heading, wanted))  # fmt: skip
    assert evaluated(drawn, arc, particles=corners_of(8), rest_angle=0.2)[2] <= 1e-28
    assert evaluated(drawn, arc * [1, -1, 1], particles=corners_of(8), rest_angle=0.2)[2] <= 1e-28


def test_rods_that_want_to_be_straight_are_as_they_were() -> None:
    """No chains: sections make no difference to any bit, and solvers' loops have the three columns of a corner."""
    x = coil(8, 1.0, 0.2)
    shape = x + 0.1 * np.random.default_rng(4).normal(size=x.shape)
    for more in ({"angle_factor": 0.0}, {"rest_angle": 0.0}):
        tied, free = (evaluated(x, shape, particles=corners_of(9), sections=s, **more) for s in ("tied", "free"))
        assert (tied[0] == free[0]).all() and (tied[1] == free[1]).all() and tied[2] == free[2]
        system = compile(Scene(particles=x, forces=[{"kind": "bend", "particles": corners_of(9), **more}]))
        (group,) = system.groups
        packed = group.cls.pack(group.block, group.block.memory, False)
        assert packed is not None and packed[1].shape == (7, 3)


@pytest.mark.parametrize("name", several())
def test_a_part_of_a_rod_is_taken_with_all_that_it_feels(name: str) -> None:
    """Solvers that smooth a few particles alone cut them out: the forces on these are those of the whole, to the bit.

    Corners are in disorder, so that the rows of a part do not follow one another as those of the whole do.
    """
    x, corners, held = several()[name]
    rng = np.random.default_rng(6)
    corners = corners[rng.permutation(len(corners))]
    anchors = [{"particles": held}] if held else []
    system = compile(Scene(particles=x, forces=[{"kind": "bend", "particles": corners}], anchors=anchors))
    state = system.start()
    state.x = x + 0.1 * rng.uniform(-1, 1, x.shape)
    whole = system.evaluate(state)[0]
    for chosen in range(len(x)):
        moving = np.arange(len(x)) == chosen
        part, own, particles = cut(system, state, moving)
        assert np.array_equal(part.evaluate(own)[0][particles == chosen], whole[moving])
    if name.startswith("two"):
        assert len(part.groups[0].block.indices) == 5  # of the other rod nothing


# --- while it runs ---------------------------------------------------------------------------------------------------


def test_a_patch_gives_a_rod_its_curvature_and_takes_it() -> None:
    """Drawn as an arc and relaxed straight, then with factor 1: the arc again; with 0 straight again. An anchor at its
    end keeps its side, so that it need not be pushed out of line."""
    x = arch(12)
    settings = {"solver": "relaxation", "tolerance": 1e-8}
    forces, anchors = rod(x, 1e3, angle_factor=0.0), [{"particles": [0]}]
    running = Simulation(Scene(particles=x, forces=forces, anchors=anchors, settings=settings))
    for factor, rise in ((0.0, 0.0), (1.0, RISE), (0.0, 0.0)):
        running.patch({"forces": {"1": {"angle_factor": factor}}})
        result = running.relax()
        assert result.converged, result.message
        ends, middle = result.particles[[0, 12]], result.particles[6]
        assert np.linalg.norm(middle - ends.mean(axis=0)) == pytest.approx(rise, abs=1e-5)


def test_an_end_that_is_let_go_spins_and_one_that_is_held_again_does_not(tmp_path: Any) -> None:
    """The energy of the arch turned inside out follows its anchors, and is the same after saving and loading."""
    x, n = arch(24), 24
    anchors = [{"name": "left", "particles": [0]}, {"name": "right", "particles": [n]}]
    running = Simulation(Scene(particles=x, forces=[rod(x, 1.0)[1]], anchors=anchors))

    def energy(simulation: Simulation) -> float:
        state = simulation.state.copy()
        state.x = x * [1, 1, -1]
        return float(simulation.system.evaluate(state)[2].sum())

    held = energy(running)
    assert held == pytest.approx(bending(x, x * [1, 1, -1], [0, n]), rel=1e-14)
    running.patch({"release": [0]})
    assert energy(running) == pytest.approx(held, rel=1e-12)
    running.patch({"release": [n]})
    assert energy(running) <= 1e-20
    running.save(tmp_path / "free.npz")
    assert energy(Simulation.load(tmp_path / "free.npz")) == energy(running)
    running.undo()
    assert energy(running) == pytest.approx(held, rel=1e-12)
    running.save(tmp_path / "held.npz")
    assert energy(Simulation.load(tmp_path / "held.npz")) == energy(running)
