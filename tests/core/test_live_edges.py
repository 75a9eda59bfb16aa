"""Edges of live systems: patches that fail, solvers that change, files that are damaged, shapes out of bounds."""

from __future__ import annotations

import numpy as np
import pytest

from hookean import InputError, Scene, Simulation, relax
from hookean.running.result import Status
from hookean.stability.time_steps import critical_time_step, stable_time_step
from hookean.system.system import compile
from hookean.system.weld import weld
from samples import cable


def chain(springs: dict[str, object] | None = None, **settings: object) -> Scene:
    """Five particles on a line, 1 N of weight, anchors L and R."""
    return Scene(
        particles=[[float(i), 0, 0] for i in range(5)],
        forces=[
            {"kind": "springs", "particles": [[i, i + 1] for i in range(4)], **(springs or {})},
            {"kind": "self_weight", "total": 1},
        ],
        anchors=[{"name": "L", "particles": [0]}, {"name": "R", "particles": [4]}],
        settings=settings,
    )


@pytest.mark.parametrize("anchors", [[], [{"particles": [0], "axes": "z"}]])
def test_a_floating_force_density_net_is_no_accident(anchors: list[dict[str, object]]):
    """Nothing holds it, so K is singular: the default relaxes it to a point; force_density alone says it stalled."""
    scene = Scene(
        particles=[[0, 0, 0], [1, 0, 0]],
        forces=[{"kind": "springs", "particles": [[0, 1]], "rest_factor": 0}],
        anchors=anchors,
    )
    result = relax(scene)
    assert result.converged
    assert result.force("springs")["length"][0] < 1e-6
    forced = relax(scene.model_copy(update={"settings": scene.settings.model_copy(update={"solver": "force_density"})}))
    assert forced.status is Status.STALLED


def test_pins_have_names_move_and_replace_each_other():
    """A pin is an anchor: it is named, moved by its name, and the last one with a name to hold a particle holds it."""
    simulation = Simulation(chain())
    simulation.patch({"pin": [{"name": "P", "particles": [2]}]})
    assert simulation.result().reactions["names"] == ["L", "P", "R"]
    simulation.patch({"move": [{"anchor": "P", "targets": [[2, 0, 5]]}]})
    assert simulation.state.x[2].tolist() == [2, 0, 5]
    for _ in range(20):
        simulation.patch({"pin": [{"particles": [2]}]})
    assert len(simulation.system.held) == 3
    simulation.patch({"pin": [{"particles": [4], "targets": [[5, 0, 0]]}]})
    simulation.patch({"move": [{"anchor": "R", "targets": [[6, 0, 0]]}]})
    assert simulation.state.x[4].tolist() == [6, 0, 0] and len(simulation.system.held) == 3
    simulation.patch({"pin": [{"name": "Q", "particles": [4]}]})
    with pytest.raises(InputError, match="0"):
        simulation.patch({"move": [{"anchor": "R", "targets": [[6, 0, 0]]}]})
    for wrong in (-1, True, ""):
        with pytest.raises(InputError):
            simulation.patch({"move": [{"anchor": wrong, "targets": [[2, 0, 5]]}]})


def test_pinning_a_scene_without_anchors():
    """The reaction of a pin is reported where the scene has no anchor of its own."""
    simulation = Simulation(
        Scene(particles=[[0, 0, 0], [1, 0, 0]], forces=[{"kind": "springs", "particles": [[0, 1]]}])
    )
    simulation.patch({"pin": [{"particles": [0]}]})
    assert simulation.result().reactions["names"] == [""]


@pytest.mark.parametrize("solver", ["auto", "verlet", "momentum"])
def test_a_particle_below_the_floor_is_put_onto_it(solver: str):
    """The plane is one no particle passes, not even at the start."""
    scene = Scene(
        particles=[[0, 0, -1]],
        forces=[{"kind": "self_weight", "total": 1}],
        settings={"floor": {}, "solver": solver},
    )
    result = relax(scene)
    assert result.converged
    assert result.particles[0].tolist() == [0, 0, 0]
    assert result.contacts["force"][0] == pytest.approx([0, 0, 1])


def test_a_refused_patch_leaves_everything_as_it_was():
    """A solver that cannot take the scene, with a pin beside it: neither lands."""
    simulation = Simulation(chain(solver="relaxation"))
    simulation.step()
    before = simulation.state.copy()
    with pytest.raises(InputError, match="force_density supports"):
        simulation.patch({"settings": {"solver": "force_density"}, "pin": [{"particles": [1]}]})
    assert simulation.scene.settings.solver == simulation.solver.name == "relaxation"
    assert simulation.state.revision == 0
    assert simulation.state.free[1].tolist() == [1, 1, 1]
    assert (simulation.state.x == before.x).all()
    assert simulation.step() is not None


def test_a_patch_that_changes_which_particles_a_force_has_is_refused():
    """Weight per length sits on vertices with edges, a total on all: other particles, so a new scene."""
    mesh = {"vertices": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [9, 9, 9]], "faces": [[0, 1, 2]]}
    scene = Scene(
        meshes={"m": mesh},
        forces=[{"kind": "springs", "mesh": "m"}, {"kind": "self_weight", "mesh": "m", "total": 1}],
    )
    with pytest.raises(InputError, match="send a new scene"):
        Simulation(scene).patch({"forces": {"1": {"total": None, "per_length": 1.0}}})


def test_the_step_warning_goes_when_its_reason_goes():
    """A shorter step, or a solver without steps, takes the warning back."""
    simulation = Simulation(chain({"stiffness": 1e6}, time_step=0.01))
    assert any("time_step" in w for w in simulation.system.report.warnings)
    told = simulation.result()
    simulation.patch({"settings": {"time_step": 1e-5}})
    assert not any("time_step" in w for w in simulation.system.report.warnings)
    assert any("time_step" in w for w in told.report.warnings)


def test_damping_alone_can_limit_the_step():
    """dt c / 2m <= 1 without stiffness: c along a spring between two unit masses has the rate 2 c, so dt = 1 / c."""
    damped = {"kind": "springs", "particles": [[0, 1]], "stiffness": 0, "damping": 1e6}
    system = compile(Scene(particles=[[0, 0, 0], [1, 0, 0]], forces=[damped], settings={"drag": 0}))
    assert stable_time_step(system, system.start()) == pytest.approx(1e-6, rel=1e-6)
    assert critical_time_step(1.0, 1e12) == pytest.approx(1e-12)
    mixed = {"kind": "springs", "particles": [[0, 1], [2, 3]], "stiffness": [1, 4000], "damping": [1000, 0]}
    scene = Scene(
        particles=[[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]],
        forces=[mixed],
        anchors=[{"particles": [0, 2]}],
        settings={"solver": "verlet", "max_iterations": 1, "time_step": 0.01},
    )
    assert any("time_step" in w for w in relax(scene).report.warnings)


def test_a_moving_shape_has_not_arrived():
    """A spring at rest length with its end in motion is not in equilibrium, and its kinetic energy is m v^2 / 2."""
    scene = Scene(
        particles=[[0, 0, 0], [1, 0, 0]],
        velocities=[[0, 0, 0], [1, 0, 0]],
        forces=[{"kind": "springs", "particles": [[0, 1]]}],
        anchors=[{"particles": [0]}],
        settings={"solver": "verlet"},
    )
    assert Simulation(scene).result().energy["kinetic"] == pytest.approx(0.5)
    assert relax(scene).iterations > 10


def test_fictitious_speeds_stay_in_their_solver():
    """After a relaxation that was cut short nothing moves in physical time."""
    simulation = Simulation(chain(max_iterations=30, tolerance=1e-12))
    simulation.step(2)
    assert simulation.relax().energy["kinetic"] == 0.0
    assert (simulation.state.v == 0).all()
    other = Simulation(chain(solver="relaxation", tolerance=0))
    other.iterate(7)
    other.patch({"settings": {"solver": "verlet"}})
    assert (other.state.v == 0).all()


def test_momentum_resumes_bit_for_bit(tmp_path):
    """Its velocities are its only memory, and they are kept."""
    straight = Simulation(chain(solver="momentum", sub_iterations=7))
    straight.step(2)
    straight.save(tmp_path / "m.npz")
    resumed = Simulation.load(tmp_path / "m.npz")
    straight.step()
    resumed.step()
    assert straight.state.x.tobytes() == resumed.state.x.tobytes()


def test_damaged_saves_end_in_a_sentence(tmp_path):
    """Cut, emptied, flipped, of another shape: InputError, whatever the archive reader makes of it."""
    good = tmp_path / "good.npz"
    simulation = Simulation(chain())
    simulation.save(good)
    data = good.read_bytes()
    np.savez(tmp_path / "other.npz", x=np.zeros(3))
    broken = [b"", data[: len(data) // 2], (tmp_path / "other.npz").read_bytes()]
    broken += [data[:i] + bytes([data[i] ^ 255]) + data[i + 1 :] for i in range(40, len(data), len(data) // 25)]
    refused = 0
    for i, text in enumerate(broken):
        path = tmp_path / f"{i}.npz"
        path.write_bytes(text)
        try:
            Simulation.load(path)
        except InputError:
            refused += 1
    assert refused >= 3 + 10


def test_a_diverged_run_takes_its_yielding_back():
    """The last good shape comes with the rest lengths it had: at the start, no force."""
    result = relax(
        chain({"stiffness": 1e9, "plasticity": 0.1, "damping": 0}, solver="verlet", max_iterations=2000, time_step=0.01)
    )
    assert result.status is Status.DIVERGED
    assert np.abs(result.force("springs")["force"]).max() < 1e9 * 0.1
    assert " were stable for " in result.message


def test_a_spring_of_rest_length_0_does_not_yield():
    """Plasticity is a part of the rest length: of 0 it is 0, which means none."""
    scene = Scene(
        particles=[[0, 0, 0], [1, 0, 0]],
        forces=[
            {"kind": "springs", "particles": [[0, 1]], "rest_factor": 0, "plasticity": 0.1, "stiffness": 10},
            {"kind": "unary", "particles": [1], "vector": [1, 0, 0]},
        ],
        anchors=[{"particles": [0]}],
    )
    assert relax(scene).force("springs")["force"][0] == pytest.approx(1.0, rel=1e-5)


def test_a_cancelled_run_leaves_no_mark():
    """Overshoot on no physical path is not remembered by plastic springs."""
    simulation = Simulation(chain({"plasticity": 1e-4, "stiffness": 10}, tolerance=1e-13, max_iterations=20))
    simulation.relax()
    assert all((m == 0).all() for m in simulation.state.memory)


def test_a_tilted_floor_and_a_guide_share_a_load():
    """Held in x over a plane tilted by 45 degrees, without friction: contact (1, 0, 1), reaction (-1, 0, 0)."""
    scene = Scene(
        particles=[[0, 0, 1]],
        forces=[{"kind": "self_weight", "total": 1}],
        anchors=[{"particles": [0], "axes": "x"}],
        settings={"floor": {"normal": [1, 0, 1], "static_friction": 0, "kinetic_friction": 0}},
    )
    result = relax(scene)
    assert result.contacts["force"][0] == pytest.approx([1, 0, 1])
    assert result.reactions["force"][0] == pytest.approx([-1, 0, 0])


def test_springs_loads_and_anchors_mean_the_same_particle():
    """Two particles within the tolerance of a point: the first wins, whoever asks."""
    point = [0.0005, 0, 0]
    scene = Scene(
        particles=[[0, 0, 0], point, point],
        forces=[
            {"kind": "springs", "lines": [[point, [1, 0, 0]]]},
            {"kind": "unary", "points": [point], "vector": [0, 0, 1]},
        ],
        anchors=[{"points": [point]}],
    )
    system = compile(scene)
    meant = {int(system.groups[0].block.indices[0, 0]), int(system.groups[1].block.indices[0, 0])}
    assert meant | {int(system.held[0].particles[0])} == {0}


def test_a_large_tolerance_welds_everything_into_one():
    """4000 points within the tolerance of the first."""
    points, which = weld(np.zeros((0, 3)), np.random.default_rng(1).random((4000, 3)), 10.0)
    assert len(points) == 1
    assert (which == 0).all()


def test_targets_far_away_are_no_divergence():
    """Anchors may move a net a million times its size."""
    scene = Scene(
        particles=[[0, 0, 0], [1e-3, 0, 0], [2e-3, 0, 0]],
        weld_tolerance=0,
        forces=[{"kind": "springs", "particles": [[0, 1], [1, 2]], "rest_factor": 0}],
        anchors=[{"particles": [0, 2], "targets": [[0, 0, 0], [1000, 0, 0]]}],
    )
    result = relax(scene)
    assert result.converged
    assert result.particles[1, 0] == pytest.approx(500)


def test_names_must_say_which():
    """An empty name means no force, a name given twice is refused, other scripts' digits are no numbers."""
    base = cable().model_dump()
    base["forces"] += ({**base["forces"][0], "name": "cable"},)
    simulation = Simulation(Scene(**base))
    for key, says in (("", "no force"), ("cable", "select one by number"), ("²", "no force"), ("99", "no force")):
        with pytest.raises(InputError, match=says):
            simulation.patch({"forces": {key: {"stiffness": 1}}})


def test_a_patched_scene_has_a_digest_of_its_own():
    """Equal scenes, equal digests; changed scenes, changed ones."""
    simulation = Simulation(cable())
    before = simulation.scene.digest
    simulation.patch({"forces": {"cable": {"stiffness": 5}}})
    assert simulation.scene.digest != before


@pytest.mark.parametrize("solver", ["newton", "auto"])
def test_a_slow_solver_can_be_cancelled(solver: str):
    """Newton hands back after a few steps, so that a run stops soon after it is told to."""
    asked = iter([False, False, True])
    result = relax(cable(solver=solver, tolerance=0.0), cancelled=lambda: next(asked, True))
    assert result.status in (Status.CANCELLED, Status.CONVERGED, Status.STALLED)
    if solver == "newton" and result.status is Status.CANCELLED:
        assert result.iterations <= 6


def test_a_coarse_rounding_floor_is_no_equilibrium():
    """1e12 N/m under a load of 1e-6 N: u k x / F = 1e-16 1e12 10 / 1e-6 = 1e3, so nothing is known of the balance."""
    scene = cable().model_dump()
    scene["forces"][0]["stiffness"] = 1e12
    scene["forces"][1]["vector"] = [0, 0, -1e-6]
    result = relax(Scene(**scene))
    assert result.rounding_floor > 1
    assert not result.converged and "Rounding alone causes a residual" in result.message


def test_messages_remember_the_run_they_speak_of():
    """After relax the frame says how many iterations that took, not how many since."""
    simulation = Simulation(cable())
    said = simulation.relax().message
    assert simulation.frame().message == said
    assert " 0 iterations" not in said
