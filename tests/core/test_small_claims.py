"""Parts of the judgement of a shape, each by itself: scales, bounds of steps, holds, and what follows from modes."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from hookean import InputError, Scene, Springs
from hookean.running.watch import Watch
from hookean.solvers import solver
from hookean.stability import equilibrium, nets, time_steps
from hookean.stability.equilibrium import Equilibrium, Stability
from hookean.stability.modes import Modes
from hookean.system.balance import balance
from hookean.system.state import State
from hookean.system.system import System, compile, widen
from hookean.system.weld import Welded

Spec = dict[str, Any]


def started(spec: Spec) -> tuple[System, State]:
    system = compile(Scene.read(spec))
    return system, system.start()


def pair(**settings: Any) -> Spec:
    """Two masses of 4 kg on a spring at its rest length of 1 m, 100 N/m."""
    springs = {"kind": "springs", "particles": [[0, 1]], "stiffness": 100.0, "damping": 0.0}
    return {"particles": [[0, 0, 0], [1, 0, 0]], "masses": 4.0, "forces": [springs], "settings": settings}


@pytest.mark.parametrize(
    ("kind", "elements"),
    [
        ("hinge", [[0, 1, 2, 3], [1, 2, 3, 4]]),
        ("power_law", [[0, 1], [1, 2], [2, 3], [3, 4]]),
        ("springs", [[0, 1], [3, 4]]),
    ],
)
def test_without_loads_the_scale_is_the_mean_of_the_largest_end_forces(kind: str, elements: list[list[int]]) -> None:
    """The mean over all elements of the largest force on one of their particles, each from a scene of its own; a
    rounding a coordinate."""
    x = np.random.default_rng(3).normal(size=(5, 3))
    whole = {"kind": "springs", "particles": [[0, 2], [2, 3]], "stiffness": 1e-30, "rest_length": 1.0}
    moved = x + 0.3 * np.random.default_rng(4).normal(size=x.shape)

    def strained(forces: list[Spec]) -> tuple[System, State]:
        system, state = started({"particles": x, "forces": forces})
        state.x[:] = moved
        return system, state

    sizes = [np.linalg.norm(system.evaluate(state)[0], axis=1).max() for system, state in
             (strained([{"kind": kind, "particles": [one]}]) for one in elements)]  # fmt: skip
    sizes += [0.0, 0.0] if kind == "springs" else []
    forces = [{"kind": kind, "particles": elements}, *([whole] if kind == "springs" else [])]
    found = balance(*strained(forces))
    assert found.scale == pytest.approx(np.mean(sizes), rel=1e-14)


def test_rounding_that_hides_a_thousandth_of_the_loads_is_not_converged() -> None:
    """A floor of 0.9e-3 leaves enough of a shape, one of 1.1e-3 does not."""
    from dataclasses import replace

    system, state = started({**pair(), "anchors": [{"particles": [0]}]})
    found = balance(system, state)
    assert replace(found, floor=0.9e-3, beyond=0.0).met(1e-9)
    assert not replace(found, floor=1.1e-3, beyond=0.0).met(1e-9)


def test_rates_are_forces_by_masses() -> None:
    """Drag of 3 N s/m on 4 kg: 0.75 1/s; springs of 100 N/m: both ends of each side, 2 k / m = 50 1/s2."""
    system, state = started(pair(drag=3.0))
    stiffness, damping, drag = time_steps.Bounds.of(system, state).highest(state)
    assert (stiffness, damping, drag) == (50.0, 0.0, 0.75)


@pytest.mark.parametrize(("drag", "part"), [(0.0, 0.25), (1.0, 0.9)])
def test_a_roomy_step_is_a_part_of_that_of_all_shapes(drag: float, part: float) -> None:
    """omega = sqrt(2 k / m), the same in all shapes: 2 / omega, 0.9 of it with damping, a quarter without."""
    system, state = started(pair(drag=drag))
    limit = time_steps.VERLET.step(2.0 * 100.0 / 4.0, 0.0, drag / 4.0)
    method = SimpleNamespace(limit=time_steps.VERLET)
    assert time_steps.time_step_of_all_shapes(system, state) == pytest.approx(limit, rel=1e-12)
    assert time_steps.roomy(system, state, method) == pytest.approx(part * limit, rel=1e-12)  # type: ignore[arg-type]


def test_drag_alone_limits_the_step_of_all_shapes() -> None:
    """4 kg that fall with 3 N s/m: dt c / m <= 2."""
    weight = {"kind": "unary", "particles": [0, 1], "vector": [0, 0, -1]}
    system, state = started({**pair(drag=3.0), "forces": [weight]})
    assert time_steps.time_step_of_all_shapes(system, state) == pytest.approx(2.0 * 4.0 / 3.0, rel=1e-12)


def test_the_step_about_a_shape_that_may_stiffen_is_most_of_what_holds_there() -> None:
    """0.8 of the stable step where no bound holds in all shapes and the given one is longer; F = S d^-2 at d = 1."""
    repulsion = {"kind": "power_law", "particles": [[0, 1]], "strength": 100.0, "exponent": -2.0}
    system, state = started({**pair(time_step=10.0, drag=0.0), "forces": [repulsion]})
    stable = time_steps.stable_time_step(system, state)
    assert not system.steady and 0.0 < stable < 10.0
    holds = time_steps.Bounds.of(system, state).holds(state, time_steps.VERLET)
    assert time_steps.longest(system, state, time_steps.VERLET) == max(holds, 0.8 * stable)
    assert holds < 0.8 * stable


def test_steps_in_more_parts_than_are_taken_cover_less_time() -> None:
    """A step of 2 s in twice as many parts as are taken covers 1 s, and the motion is half as fast."""
    system, _ = started(pair(time_step=2.0))
    most = time_steps.most_parts(system)
    assert time_steps.slowed(system, most) == ""
    said = time_steps.slowed(system, 2 * most)
    assert "each step covers 1 s, not 2 s" in said and "2 times slower" in said


@pytest.mark.parametrize("size", [2.0**-10, 1.0, 2.0**10])
def test_stiffness_by_differences_is_as_good_at_any_size(size: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """Central differences of 1e-6 of an element's size: truncation 1e-12, rounding eps / 1e-6 = 2e-10 of k (1e-8)."""
    system, state = started({**pair(), "particles": size * np.array([[0, 0, 0], [1, 0.5, 0.25]])})
    state.x *= 1.2
    (group,) = system.groups
    exact = system.stiffness_blocks(group, state, state.memory[0])
    monkeypatch.setattr(Springs, "hessian", None)
    np.testing.assert_allclose(system.stiffness_blocks(group, state, state.memory[0]), exact, atol=1e-8 * 100.0)


def test_a_box_holds_all_points() -> None:
    """Its columns: the largest coordinates, and the negatives of the least, of what it held before as well."""
    box = np.array([[0.5, 5.0, -1.0], [2.0, 0.0, 9.0]])
    widen(np.array([[1.0, 2.0, -3.0], [0.0, -4.0, -7.0]]), box)
    assert box.tolist() == [[1.0, 5.0, -1.0], [2.0, 4.0, 9.0]]


def test_held_rotations_are_still_and_others_free() -> None:
    """A clamp about all axes at one end of a beam: its rotation does not move, that of the other end does."""
    beam = {"kind": "beam", "particles": [[0, 1]], "E": 1.0, "G": 1.0, "A": 1.0, "Iy": 1.0, "Iz": 1.0, "J": 1.0}
    spec = {**pair(), "forces": [beam], "anchors": [{"particles": [0], "rotations": "xz"}]}
    system, state = started(spec)
    held, loose = system.slots.rows(np.array([0, 1]))
    assert state.free[held].tolist() == [0.0, 1.0, 0.0] and state.free[loose].tolist() == [1.0, 1.0, 1.0]
    assert np.isfinite(state.v).all()


def test_the_first_anchor_braces_rods() -> None:
    """A rod ends where an anchor holds it, the first in the list as well as the second: the same forces either way."""
    x = [[0, 0, 0], [1, 0, 0.2], [2, 0, 0.1], [3, 0, 0.3], [4, 0, 0]]
    rod = {"kind": "bend", "particles": [[i - 1, i, i + 1] for i in range(1, 4)], "stiffness": 1.0}
    links = {"kind": "springs", "particles": [[i, i + 1] for i in range(4)], "stiffness": 10.0}
    ends = [{"particles": [2]}, {"particles": [0], "axes": "z"}]
    blocks = []
    for anchors in (ends, ends[::-1]):
        system, _ = started({"particles": x, "forces": [rod, links], "anchors": anchors})
        blocks.append([group.block.parameters for group in system.groups])
    assert all(np.array_equal(a, b) for a, b in zip(*blocks, strict=True))


def test_an_empty_list_of_elements_has_whole_numbers() -> None:
    """Elements of no particles and of no points: none, of the type that all indices have."""
    for place in ({"particles": []}, {"lines": np.zeros((0, 2, 3))}):
        scene = Scene.read({**pair(), "forces": [*pair()["forces"], {"kind": "springs", **place}]})
        rows = Welded(scene).elements(scene.forces[1])
        assert rows.shape == (0, 2) and rows.dtype == np.int64


def test_an_error_of_a_force_as_a_whole_has_its_place() -> None:
    """An error that a force raises when it is compiled has the pointer of the force."""
    cable = {"kind": "sliding_cable", "particles": [[0, 1]], "force": 1.0, "axial_stiffness": 0.0}
    with pytest.raises(InputError) as caught:
        started({**pair(), "forces": [cable]})
    assert caught.value.pointer == "/forces/0"


def test_columns_of_the_edges_of_a_mesh_are_counted() -> None:
    """A triangle has three edges: four values are refused where they stand."""
    triangle = {"vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "faces": [[0, 1, 2]]}
    springs = {"kind": "springs", "mesh": "one", "stiffness": [1.0, 2.0, 3.0, 4.0]}
    with pytest.raises(InputError, match="4 values for 3 elements") as caught:
        started({"meshes": {"one": triangle}, "forces": [springs]})
    assert caught.value.pointer == "/forces/0/stiffness"


@pytest.mark.parametrize(
    ("parts", "driven", "divided", "cooled"),
    [(10**9, False, True, True), (1, False, True, False), (10**9, True, True, False), (10**9, False, False, False)],
)
def test_what_is_added_by_jumps_of_forces_is_taken_out(parts: int, driven: bool, divided: bool, cooled: bool) -> None:
    """Only where steps may be divided, are divided often already, and nothing drives the motion from outside."""
    moving = {**pair(), "anchors": [{"particles": [0]}], "velocities": [[0, 0, 0], [1, 0, 0]]}
    system, state = started(moving)
    watch = Watch(system, state, solver("relaxation"))
    watch.method = SimpleNamespace(limit=watch.method.limit, parts=lambda system, state: parts)  # type: ignore[assignment]
    watch.settings, watch.driven = watch.settings.model_copy(update={"divide_steps": divided}), driven
    assert watch._cooled(system, state, balance(system, state)) is cooled
    assert ("energy" in state.scratch) is cooled  # the energy that the motion may have from now on


def test_a_proof_of_stability_stands_against_modes_that_are_not_sure(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where all springs pull, the tangent is positive definite, whatever an iteration made of a small eigenvalue."""
    system, state = started({**pair(), "anchors": [{"particles": [0]}]})
    doubtful = Equilibrium(Stability.UNSTABLE, "the energy falls", 1, position_errors=np.array([0.5]))
    monkeypatch.setattr(equilibrium, "LARGE_NET", 0)
    monkeypatch.setattr(equilibrium, "_certain", lambda *_: True)
    monkeypatch.setattr(equilibrium, "_by_modes", lambda *_: doubtful)
    found = equilibrium.assess(system, state, balance(system, state))
    assert found.stability is Stability.STABLE and found.position_errors == np.array([0.5])


@pytest.mark.parametrize("counted", [True, False])
def test_modes_that_were_not_counted_have_no_number(counted: bool) -> None:
    """Two loose modes, or at least two."""
    system, state = started(pair())
    modes = Modes(loose=2, mode=np.eye(2, 3), counted=counted)
    found = equilibrium._concluded(modes, balance(system, state))
    assert found.stability is Stability.MECHANISM and found.soft_modes == (2 if counted else None)
    assert found.stability_reason == ("2 motions meet no resistance" if counted else "a motion meets no resistance")


def test_each_spring_has_a_force_density() -> None:
    """k (1 - L0 / l), at a length of 1 with a rest length of half of it: 50 N/m; nothing of other forces."""
    spec = pair()
    spec["forces"] = [
        {**spec["forces"][0], "rest_length": 0.5},
        {"kind": "unary", "particles": [1], "vector": [1, 0, 0]},
    ]
    pairs, densities = nets._densities(*started(spec))
    assert pairs.tolist() == [[0, 1]] and densities.tolist() == [50.0]
