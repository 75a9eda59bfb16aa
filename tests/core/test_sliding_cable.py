"""Sliding cables: one force all along, a pulley at the bisector, slack below the rest length; friction on saddles."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

from hookean import InputError, Scene, Simulation, SlidingCable, relax
from hookean.compiled import dispatch
from hookean.designing.sensitivity import sensitivity
from hookean.forces import capstan
from hookean.system.system import System, compile

SADDLES = np.array([[0, 0, 0], [2, 0, 1], [3, 1, 0], [5, 1, 2], [6, -1, 0.0]])
PAIRS = [[0, 1], [1, 2], [2, 3], [3, 4]]


def test_the_force_is_the_same_all_along() -> None:
    """Over held saddles T = EA (L - L0) / L0 in every line, however long, and each saddle carries T (u - v) of the unit
    vectors along its two lines."""
    whole = float(np.linalg.norm(np.diff(SADDLES, axis=0), axis=1).sum())
    cable = SlidingCable(particles=PAIRS, axial_stiffness=500.0, rest_length=0.9 * whole)
    found = relax(Scene(particles=SADDLES, forces=[cable], anchors=[{"particles": range(5)}]))
    tension = 500.0 * (1 / 0.9 - 1)
    assert found.force("sliding_cable")["force"] == pytest.approx(np.full(4, tension), rel=1e-13)
    along = np.diff(SADDLES, axis=0) / np.linalg.norm(np.diff(SADDLES, axis=0), axis=1)[:, None]
    carried = tension * (along[:-1] - along[1:])
    assert found.reactions["force"][1:4] == pytest.approx(carried, abs=1e-12 * tension)


@pytest.mark.parametrize("solver", ["auto", "newton"])
def test_a_pulley_hangs_at_the_bisector(solver: str) -> None:
    """A free pulley with a weight W on a cable of length L between supports d apart, one higher by h: both lines make
    the angle a with the vertical, sin a = d / L, T = W / (2 cos a), and L = L0 (1 + T / EA), one equation for L."""
    d, h, weight, axial, rest = 4.0, 1.0, 30.0, 400.0, 6.0
    cable = {"kind": "sliding_cable", "particles": [[0, 1], [1, 2]], "axial_stiffness": axial, "rest_length": rest}
    scene = Scene(
        particles=[[0, 0, 0], [1, 0, -2], [d, 0, h]],
        forces=[cable, {"kind": "unary", "particles": [1], "vector": [0, 0, -weight]}],
        anchors=[{"particles": [0, 2]}, {"particles": [1], "axes": "y"}],
        settings={"solver": solver, "tolerance": 1e-12},
    )
    found = relax(scene)
    assert found.converged and found.stability == "stable"

    def tension(length: float) -> float:
        return 0.5 * weight / np.sqrt(1.0 - (d / length) ** 2)

    length = brentq(lambda own: own - rest * (1.0 + tension(own) / axial), d + 0.1, 50.0, xtol=1e-14)
    assert found.force("sliding_cable")["force"] == pytest.approx(np.full(2, tension(length)), rel=1e-9)
    cosine = np.sqrt(1.0 - (d / length) ** 2)
    first = 0.5 * (length - h / cosine)  # the lines' heights differ by h
    assert found.particles[1] == pytest.approx([first * d / length, 0.0, -first * cosine], abs=1e-8)


def test_prestress_and_materials() -> None:
    """The force at the start; EA of steel and a rope; two cables by their numbers, each with its own length."""
    materials = {"materials": {"steel": {"E": 160e3}}, "sections": {"rope": {"area": 0.01}}}
    cable = {"kind": "sliding_cable", "particles": PAIRS, "material": "steel", "section": "rope", "force": 70.0}
    held = [{"particles": range(5)}]
    found = relax(Scene.read({"particles": SADDLES, **materials, "forces": [cable], "anchors": held}))
    assert found.force("sliding_cable")["force"] == pytest.approx(np.full(4, 70.0), rel=1e-12)
    two = SlidingCable(particles=PAIRS, group=[3, 1, 3, 1], rest_length=4.0, axial_stiffness=10.0)
    found = relax(Scene(particles=SADDLES, forces=[two], anchors=held))
    length = np.linalg.norm(np.diff(SADDLES, axis=0), axis=1)
    tension = 10.0 * (np.array([length[0] + length[2], length[1] + length[3]]) - 4.0) / 4.0
    assert found.force("sliding_cable")["force"] == pytest.approx(np.tile(tension, 2), rel=1e-13)


def test_a_long_cable_is_slack() -> None:
    cable = SlidingCable(particles=PAIRS, rest_length=12.0)
    system = compile(Scene(particles=SADDLES, forces=[cable]))
    f, _, energy = system.evaluate(system.start())
    assert not f.any() and not energy.any()


def tangent(system: System, x: np.ndarray, node: int | None) -> np.ndarray:
    """The tangent of the whole system by gathered elements; nodes are eliminated by their least energy."""
    (group,) = system.groups
    found = SlidingCable.gathered(group.block, group.block.memory, x, node)
    assert found is not None
    count = 1 + max(int(block.indices.max()) for _, block in found)
    whole = np.zeros((3 * count, 3 * count))
    for cls, block in found:
        for index, part in zip(block.indices, cls.tangent(block, x), strict=True):
            at = (3 * index[:, None] + np.arange(3)).ravel()
            np.add.at(whole, (at[:, None], at), part)
    own = 3 * len(x)
    if node is None:
        return whole[:own, :own]
    kept = np.arange(own, len(whole), 3)  # nodes have one axis
    cross = whole[:own, kept]
    return np.asarray(whole[:own, :own] - cross @ np.linalg.solve(whole[np.ix_(kept, kept)], cross.T))


def test_both_tangents_are_the_gradient_of_the_force() -> None:
    """Whole cables, and lines with nodes between them, give K = -df/dx, by central differences of the forces: to the
    square of their step, and for the nodes to the little stiffness that they have besides."""
    force, x = SlidingCable.example()
    system = compile(Scene(particles=x, forces=[force]))
    (group,) = system.groups
    kernel, step = dispatch.compiled(SlidingCable.kernel, "force"), 1e-5
    numeric = np.zeros((x.size, x.size))
    for i in range(x.size):
        sides = []
        for sign in (1.0, -1.0):
            moved = x.copy()
            moved.flat[i] += sign * step
            f = np.zeros_like(x)
            kernel(moved, f * 0, group.block.indices, group.block.parameters, group.block.memory, f, np.zeros(len(x)))
            sides.append(f.ravel())
        numeric[:, i] = (sides[1] - sides[0]) / (2.0 * step)
    size = np.abs(numeric).max()
    for node in (None, len(x)):
        assert tangent(system, x, node) == pytest.approx(numeric, abs=1e-8 * size)


def over(x: np.ndarray, friction: Any, **more: Any) -> Scene:
    """A cable along held places."""
    pairs = np.column_stack([np.arange(len(x) - 1), np.arange(1, len(x))])
    cable = SlidingCable(particles=pairs, friction=friction, **more)
    return Scene(particles=x, forces=[cable], anchors=[{"particles": range(len(x))}])


def pulled(scene: Scene, by: np.ndarray) -> np.ndarray:
    """Forces in the lines after the last place has moved; nothing else does."""
    system = compile(scene)
    state = system.start()
    state.x[-1] += by
    (group,) = system.groups
    forces = system.element_forces(group, state, state.memory[0])
    return np.asarray(group.parts[0].force.measure(group.block, state.x, forces)["force"])


def turns(x: np.ndarray) -> np.ndarray:
    """Angles [rad] by which a polyline turns at its corners, by the law of cosines."""
    u = np.diff(x, axis=0) / np.linalg.norm(np.diff(x, axis=0), axis=1)[:, None]
    return np.asarray(np.arccos((u[:-1] * u[1:]).sum(axis=1)))


@pytest.mark.parametrize("mu", [0.05, 0.2, 0.6])
def test_over_one_saddle_the_forces_have_the_ratio_of_euler(mu: float) -> None:
    """Pulled far enough along its last line, the cable slips: T2 = T1 exp(mu phi), and what both lines are longer is
    what the cable is, T1 l1 / EA + T2 l2 / EA = L - L0, which is one equation for T1."""
    x = np.array([[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [3.0, 2.0, 0.0]])
    found = pulled(over(x, mu, axial_stiffness=100.0, force=5.0), np.array([0.0, 1.0, 0.0]))
    ratio, rest = np.exp(mu * np.pi / 2.0), 5.0 * 100.0 / 105.0
    least = 100.0 * (6.0 - rest) / (rest * (3.0 + 2.0 * ratio) / 5.0)
    assert found == pytest.approx([least, least * ratio], rel=1e-12)


def test_over_many_saddles_the_angles_add_up() -> None:
    """A polygon in space of 40 saddles: the last force over the first is exp(mu times the sum of all angles); given
    the other way round or from either end of its lines, it is the same cable."""
    t = np.linspace(0.0, 4.0, 42)
    x = np.column_stack([np.cos(t), np.sin(t), 0.3 * t])
    along = 5.0 * (x[-1] - x[-2])
    scene = over(x, 0.15, axial_stiffness=1e3, force=1.0)
    found = pulled(scene, along)
    assert found[-1] / found[0] == pytest.approx(np.exp(0.15 * turns(x).sum()), rel=1e-12)
    assert found[1:] / found[:-1] == pytest.approx(np.exp(0.15 * turns(x)), rel=1e-12)
    pairs = np.array(scene.forces[0].particles)
    for other in (pairs[:, ::-1], np.where(np.arange(len(pairs))[:, None] % 3 == 1, pairs[:, ::-1], pairs)):
        turned = SlidingCable(particles=other, friction=0.15, axial_stiffness=1e3, force=1.0)
        assert pulled(scene.replaced(forces=(turned,)), along) == pytest.approx(found, rel=1e-13)
    back = SlidingCable(particles=pairs[::-1], friction=0.15, axial_stiffness=1e3, force=1.0)
    assert pulled(scene.replaced(forces=(back,)), along)[::-1] == pytest.approx(found, rel=1e-12)


def test_within_the_limit_each_line_is_elastic_on_its_own() -> None:
    """Moved a little, only the last line has another force, T + EA d / L0 of its own part; with one saddle of less
    friction the cable slips on that one alone."""
    x = np.array([[0.0, 0, 0], [2, 0, 0], [2, 1, 0], [4, 1, 0]])
    by = np.array([0.02, 0.0, 0.0])
    found = pulled(over(x, 0.4, axial_stiffness=100.0, force=10.0), by)
    assert found == pytest.approx([10.0, 10.0, 10.0 + 0.02 * 110.0 / 2.0], rel=1e-12)
    found = pulled(over(x, [0.0, 0.4, 0.0], axial_stiffness=100.0, force=10.0), by)
    assert found == pytest.approx([10.0, *[10.0 + 0.02 * 110.0 / 3.0] * 2], rel=1e-12)


def test_with_nearly_no_friction_it_is_the_cable_without() -> None:
    """Forces differ by at most exp(mu times all angles) - 1, here 1e-9 of them; slack at the same length."""
    for rest in (4.0, 12.0):
        for numbers in (None, [3, 1, 3, 1]):
            rough, smooth = (over(SADDLES, mu, rest_length=rest, group=numbers) for mu in (1e-10, 0.0))
            by = np.array([0.1, 0.2, 0.3])
            assert pulled(rough, by) == pytest.approx(pulled(smooth, by), rel=1e-9, abs=0.0)


def test_a_symmetric_cable_stays_symmetric() -> None:
    """Two free saddles with weights, an even friction: the same heights and forces on both sides, and what supports
    and saddles carry balances the weights."""
    x = [[-3, 0, 0], [-1, 0, -1.0], [1, 0, -1.0], [3, 0, 0]]
    cable = {"kind": "sliding_cable", "particles": [[0, 1], [1, 2], [2, 3]], "friction": 0.1, "axial_stiffness": 500.0}
    scene = Scene(
        particles=x,
        forces=[cable, {"kind": "unary", "particles": [1, 2], "vector": [0, 0, -20.0]}],
        anchors=[{"particles": [0, 3]}, {"particles": [1, 2], "axes": "xy"}],
        settings={"tolerance": 1e-11},
    )
    found = relax(scene)
    assert found.converged and found.stability == "unknown"
    force = found.force("sliding_cable")["force"]
    assert force[0] == pytest.approx(force[2], rel=1e-8) and force[0] > force[1] > 0.0
    turned = turns(found.particles)
    assert force[0] / force[1] <= np.exp(0.1 * turned[0]) * (1.0 + 1e-9)
    assert found.particles[1, 2] == pytest.approx(found.particles[2, 2], rel=1e-8)
    assert found.reactions["force"].sum(axis=0) == pytest.approx([0.0, 0.0, 40.0], abs=1e-7)


def test_saddles_carry_what_both_lines_pull() -> None:
    """Held saddles: T1 u - T2 v each, of the unit vectors along its lines; all reactions sum to zero."""
    x = SADDLES.astype(float)
    scene = over(x, 0.3, axial_stiffness=50.0, force=4.0)
    held = [{"particles": [4], "targets": [[8.0, -3.0, 0.0]]}, {"particles": range(4)}]
    found = relax(Scene(particles=x, forces=scene.forces, anchors=held))
    force = found.force("sliding_cable")["force"]
    apart = np.diff(found.particles, axis=0)
    along = force[:, None] * apart / np.linalg.norm(apart, axis=1)[:, None]
    assert force[3] / force[2] == pytest.approx(np.exp(0.3 * turns(found.particles)[2]), rel=1e-12)
    assert found.reactions["force"][1:4] == pytest.approx(along[:-1] - along[1:], abs=1e-12 * force.max())
    assert found.reactions["force"].sum(axis=0) == pytest.approx(np.zeros(3), abs=1e-12 * force.max())


def test_what_has_slipped_stays() -> None:
    """Pulled out and back: the cable that slipped to the pulled line now is longer there, so that its force falls
    below the one it started with, down to the ratio the other way round."""
    x = np.array([[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [3.0, 2.0, 0.0]])
    system = compile(over(x, 0.2, axial_stiffness=100.0, force=5.0))
    (group,), state = system.groups, system.start()
    ratio, forces = np.exp(0.2 * np.pi / 2.0), []
    for y in (2.0, 3.0, 2.0):
        state.x[-1, 1] = y
        found = system.element_forces(group, state, state.memory[0])
        forces.append(np.linalg.norm(found[:, 0], axis=1))
        system.remember(state)
    assert forces[0] == pytest.approx([5.0, 5.0], rel=1e-12)
    assert forces[1][1] / forces[1][0] == pytest.approx(ratio, rel=1e-12)
    assert forces[2][0] / forces[2][1] == pytest.approx(ratio, rel=1e-12)
    assert state.memory[0].sum() == pytest.approx(0.0, abs=1e-14)


@pytest.mark.soak
def test_in_physical_time_slips_take_energy() -> None:
    """A weight that bounces on a cable over a rough saddle: memory changes with the steps, its sum stays 0, and the
    bounces halve at least without any damping; without friction they stay."""
    x = [[0, 0, 0], [3, 0, 0], [3, 0, -2.0]]
    ends = []
    for mu in (0.0, 0.1):
        cable = {"kind": "sliding_cable", "particles": [[0, 1], [1, 2]], "friction": mu, "axial_stiffness": 200.0}
        scene = Scene(
            particles=x,
            masses=1.0,
            forces=[cable, {"kind": "unary", "particles": [2], "vector": [0, 0, -10.0]}],
            anchors=[{"particles": [0, 1]}],
            settings={"solver": "verlet", "time_step": 0.01, "drag": 0.0, "sub_iterations": 1},
        )
        simulation = Simulation(scene)
        heights = []
        for _ in range(1200):
            simulation.step()
            heights.append(simulation.state.x[2, 2])
        ends.append((np.ptp(heights[:200]), np.ptp(heights[-200:]), simulation.state.memory[0]))
    (first, last, _), (rough, less, memory) = ends
    assert last == pytest.approx(first, rel=0.01)
    assert less < 0.5 * rough and memory.any() and abs(memory.sum()) < 1e-12


def test_a_patch_changes_friction_but_does_not_bring_it() -> None:
    """Nor has a cable with friction derivatives; both are one sentence."""
    smooth, rough = (over(SADDLES, mu) for mu in (0.0, [0.0, 0.1, 0.2, 0.3]))
    assert compile(smooth).groups[0].conservative and not compile(rough).groups[0].conservative
    with pytest.raises(InputError, match="/forces/0: this field sets how it acts; send a new scene"):
        Simulation(smooth).patch({"forces": {"0": {"friction": 0.3}}})
    simulation = Simulation(rough)
    simulation.patch({"forces": {"0": {"friction": 0.4}}})
    block = simulation.system.groups[0].block
    assert (block.parameters[:, block.names.index("friction")] == 0.4).all()
    variables, goals = [{"force": 0, "field": "friction"}], [{"kind": "position", "particles": [1], "axes": "z"}]
    with pytest.raises(InputError, match="a sliding_cable with friction has no tangent, so nothing can be"):
        sensitivity({"scene": rough, "variables": variables, "goals": goals})


def laid(longer: np.ndarray, ratio: float) -> np.ndarray:
    """The table of a cable whose lines have the rest length 1."""
    table = np.zeros((len(longer), capstan.TABLE))
    table[:, capstan.OWN], table[:, capstan.LONGER], table[:, capstan.RATIO] = 1.0, longer, ratio
    return table


@pytest.mark.parametrize("seed", range(20))
def test_random_cables_keep_the_law_of_each_saddle(seed: int) -> None:
    """Ratios within exp(+-mu phi); where something has slipped, at that limit and in the right direction; the whole
    length is kept. To 1e-9 of what all lines together are longer: 1e6 roundings."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(2, 60))
    table = laid(rng.normal(rng.choice([0.1, 0.5]), 1.0, count), np.exp(rng.uniform(0.0, [0.01, 0.3, 2.0][seed % 3])))
    table[:, capstan.OWN] = rng.uniform(0.1, 2.0, count)
    table[:, capstan.LONGER] += max(0.0, 0.1 - table[:, capstan.LONGER].mean())  # taut
    capstan.prefixes(table, count)
    capstan.strains(table, count)
    strain, ratio, near = table[:, capstan.STRAIN], table[1:, capstan.RATIO], 1e-9
    slipped = np.cumsum(table[:, capstan.OWN] * strain - table[:, capstan.LONGER])
    size = np.abs(table[:, capstan.LONGER]).sum() * near
    assert abs(slipped[-1]) <= size and (strain > 0.0).all()
    change = strain[1:] / strain[:-1]
    assert (change <= ratio * (1.0 + near)).all() and (change >= (1.0 - near) / ratio).all()
    assert change[slipped[:-1] > size] == pytest.approx(ratio[slipped[:-1] > size], rel=near)
    assert 1.0 / change[slipped[:-1] < -size] == pytest.approx(ratio[slipped[:-1] < -size], rel=near)


@pytest.mark.parametrize("ratio", [1.0, 1.001, 1.1, 3.0])
def test_the_work_grows_with_the_number_of_saddles(ratio: float) -> None:
    """A cable pulled at either end, at both, in waves, or in every other line looks at each saddle at most three times,
    however many slip; without friction also one that is pulled in its middle."""
    for count in (200, 800):
        place = np.arange(count)
        pulls = [place == 0, place == count - 1, place % (count - 1) == 0, 0.05 + 0.03 * np.sin(12.0 * place / count)]
        pulls += [np.where(place % 2, -0.09, 0.1), *([place == count // 2] if ratio < 1.01 else [])]
        for pull in pulls:
            assert capstan.prefixes(laid(10.0 * pull, ratio), count) <= 3 * count


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        ({"axial_stiffness": 1.0, "material": "S355", "section": "a"}, "give either axial_stiffness, or both"),
        ({"section": "a"}, "section given; give either axial_stiffness, or both material and section"),
        ({"axial_stiffness": None}, "nothing given"),
        ({"force": 1.0, "rest_length": 1.0}, "at most one of them"),
        ({"force": 1.0, "axial_stiffness": 0.0}, "a cable without stiffness cannot have a force"),
        ({"particles": [[0, 0]]}, "has no length at the start"),
        ({"friction": -0.1}, "-0.1"),
        ({"friction": [0.1, 0.2]}, "2 values for 4 elements"),
    ],
)
def test_what_cannot_be_is_one_sentence(given: dict[str, Any], sentence: str) -> None:
    scene = {"particles": SADDLES, "sections": {"a": {"area": 1.0}}}
    with pytest.raises(InputError) as refused:
        compile(Scene.read({**scene, "forces": [{"kind": "sliding_cable", "particles": PAIRS, **given}]}))
    assert sentence in refused.value.sentence
