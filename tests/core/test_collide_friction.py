"""Spheres that lose speed and rub: rebound by closed form, sticking and slipping on a dome, momentum, bits."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean import InputError, Scene, Simulation, relax
from hookean.compiled import dispatch
from hookean.solvers import solver
from hookean.system.state import State
from hookean.system.system import System, compile


def spheres(x: Any, **columns: Any) -> dict[str, Any]:
    return {"kind": "collide", "particles": list(range(len(x))), "radius": 0.5, **columns}


def advanced(system: System, state: State, steps: int) -> State:
    """The state after some steps of its scene's solver."""
    method = solver(system.scene.settings.solver)
    method.start(system, state)
    method.advance(system, state, steps, 0.0)
    return state


@pytest.mark.parametrize("e", [1.0, 0.7, 0.3])
@pytest.mark.parametrize("masses", [[1.0, 1.0], [1.0, 3.0]])
def test_two_spheres_part_with_a_part_of_their_speed(e: float, masses: list[float]) -> None:
    """Newton's law of impact: v1 = u (m1 - e m2) / (m1 + m2), v2 = u (1 + e) m1 / (m1 + m2) for the second at rest.
    The contact is half a damped period; it ends within a step, which leaves up to c dt / m = 2 zeta w dt of the speed:
    w dt = 0.0012 at k = 1000, dt = 3e-5, m >= 0.5."""
    k, dt, u = 1000.0, 3e-5, 2.0
    scene = Scene(
        particles=[[0.0, 0, 0], [1.01, 0, 0]], masses=masses, velocities=[[u, 0, 0], [0, 0, 0]],
        forces=[spheres([0, 1], strength=k, restitution=e)],
        settings={"solver": "verlet", "drag": 0.0, "time_step": dt},
    )  # fmt: skip
    system = compile(scene)
    after = advanced(system, system.start(), 5000)
    m1, m2 = masses
    w = np.sqrt(k * (m1 + m2) / (m1 * m2))
    expected = u / (m1 + m2) * np.array([m1 - e * m2, (1.0 + e) * m1])
    assert after.v[:, 0] == pytest.approx(expected, abs=(2.0 * w * dt + (w * dt) ** 2) * u)
    assert np.array(masses) @ after.v == pytest.approx([m1 * u, 0, 0], abs=1e-13)


def test_a_held_sphere_counts_as_infinitely_heavy() -> None:
    """A sphere that meets one which an anchor holds comes back with e u, whatever the mass of the other."""
    scene = Scene(
        particles=[[0.0, 0, 0], [1.01, 0, 0]], masses=[1.0, 0.01], velocities=[[2.0, 0, 0], [0, 0, 0]],
        anchors=[{"particles": [1]}], forces=[spheres([0, 1], strength=1000.0, restitution=0.6)],
        settings={"solver": "verlet", "drag": 0.0, "time_step": 3e-5},
    )  # fmt: skip
    system = compile(scene)
    after = advanced(system, system.start(), 5000)
    assert after.v[0].tolist() == pytest.approx([-1.2, 0, 0], abs=2.0 * 2.0 * np.sqrt(1000.0) * 3e-5)


def on_a_dome(angle: float, friction: float, k: float = 2e4, dt: float = 2e-4, **more: Any) -> Scene:
    """A small sphere that touches a large held one, at an angle from its top; overlapping so that k d = m g cos."""
    mass, gravity = 0.5, 9.81
    reach = 2.0 + 0.5 - mass * gravity * np.cos(angle) / k
    x = [[0.0, 0, 0], [reach * np.sin(angle), 0, reach * np.cos(angle)]]
    touch = {"kind": "collide", "particles": [0, 1], "radius": [2.0, 0.5], "strength": k, "friction": friction}
    weight = {"kind": "unary", "particles": [1], "vector": [0, 0, -mass * gravity]}
    return Scene(
        particles=x, masses=mass, anchors=[{"particles": [0]}], forces=[{**touch, **more}, weight],
        settings={"solver": "verlet", "drag": 0.0, "time_step": dt},
    )  # fmt: skip


@pytest.mark.parametrize("friction", [0.3, 0.6])
def test_a_sphere_on_a_dome_sticks_below_the_angle_of_friction(friction: float) -> None:
    """Coulomb: it stays where tan a < mu. Let go, it swings about its hold by m g sin a / k, twice that at most: with
    the first step's slip of g sin a dt^2 before it holds; and it is there still after 4,000 steps."""
    angle = 0.8 * np.arctan(friction)
    system = compile(on_a_dome(angle, friction, restitution=0.3))
    after = advanced(system, system.start(), 4000)
    assert np.linalg.norm(after.x[1] - system.x[1]) <= 2.0 * 0.5 * 9.81 * np.sin(angle) / 2e4 + 9.81 * 2e-4**2
    assert np.abs(after.v[1]).max() < 1e-9


@pytest.mark.parametrize("friction", [0.0, 0.3])
def test_a_sphere_on_a_dome_slides_above_the_angle_of_friction(friction: float) -> None:
    """Along the dome R a'' = g sin a - mu (g cos a - R a'^2), integrated by a Runge-Kutta method. Until the hold has
    grown to mu N, by a slip of mu N / k in t = sqrt(2 mu N / (k g sin a)) = 0.8 ms, half of the friction is missing,
    which adds mu g cos a t 0.2 s / 2 = 0.2 mm to a way of 70 mm."""
    from scipy.integrate import solve_ivp

    start, reach, gravity = np.arctan(0.3) + 0.35, 2.5, 9.81
    system = compile(on_a_dome(start, friction, 5e5, 5e-5))
    after = advanced(system, system.start(), 4000)

    def slope(_: float, y: Any) -> Any:
        press = gravity * np.cos(y[0]) - reach * y[1] ** 2
        return [y[1], (gravity * np.sin(y[0]) - friction * press) / reach]

    end = solve_ivp(slope, (0.0, 0.2), [start, 0.0], rtol=1e-10).y[0, -1]
    assert end - start > 0.02
    assert np.arctan2(after.x[1, 0], after.x[1, 2]) - start == pytest.approx(end - start, rel=0.01)


def test_a_heap_keeps_its_momentum_and_loses_energy() -> None:
    """Forty spheres that collide in space: the sum of m v stays, to rounding (1e-12); their energy falls."""
    rng = np.random.default_rng(5)
    x, masses = rng.uniform(0.0, 3.0, (40, 3)), rng.uniform(0.5, 2.0, 40)
    v = -3.0 * (x - 1.5) + rng.normal(size=x.shape)
    scene = Scene(
        particles=x, masses=masses, velocities=v, forces=[spheres(x, restitution=0.5, friction=0.4, strength=500.0)],
        settings={"solver": "verlet", "drag": 0.0, "time_step": 5e-4},
    )  # fmt: skip
    system = compile(scene)
    state = system.start()
    before = masses @ state.v, system.evaluate(state)[2].sum() + 0.5 * (masses * (state.v**2).sum(axis=1)).sum()
    after = advanced(system, state, 3000)
    assert masses @ after.v == pytest.approx(before[0], abs=1e-12 * np.abs(before[0]).sum() + 1e-11)
    assert 0.5 * (masses * (after.v**2).sum(axis=1)).sum() < 0.7 * before[1]
    assert after.memory[0].any()


def test_forces_of_a_pair_follow_coulombs_law() -> None:
    """On random shapes, speeds and histories no tangential force exceeds mu N, the two forces are opposite, and the
    power of what depends on speed is never positive."""
    rng = np.random.default_rng(2)
    for _ in range(200):
        x = np.array([[0.0, 0, 0], rng.normal(size=3)])
        x[1] *= rng.uniform(0.5, 0.99) / np.linalg.norm(x[1])
        e, mu = rng.uniform(0.0, 1.0), rng.uniform(0.0, 1.0)
        system = compile(Scene(particles=x, forces=[spheres(x, restitution=e, friction=mu, strength=70.0)]))
        state, block = system.start(), system.groups[0].block
        system.remember(state)
        state.x[1] += 0.2 * rng.normal(size=3)
        state.v[:] = rng.normal(size=(2, 3))
        f = system.evaluate(state, still=False)[0]
        assert f[0] == pytest.approx(-f[1], abs=1e-12)
        apart = state.x[1] - state.x[0]
        n = apart / np.linalg.norm(apart)
        push = f[1] @ n
        assert np.linalg.norm(f[1] - push * n) <= mu * max(push, 0.0) + 1e-12
        changed = f - system.evaluate(state)[0]
        if mu == 0.0:
            assert (state.v * changed).sum() <= 1e-12
        assert len(block.indices) == 2


def test_runs_in_pieces_are_runs_as_a_whole() -> None:
    """Saved, read and resumed while spheres stick and slip: the same bits."""
    rng = np.random.default_rng(3)
    x = rng.uniform(0.0, 2.0, (20, 3))
    scene = Scene(
        particles=x, forces=[spheres(x, restitution=0.5, friction=0.4)],
        settings={"solver": "verlet", "drag": 0.0, "time_step": 1e-3},
    )  # fmt: skip
    system = compile(scene)
    whole, state = advanced(system, system.start(), 60), system.start()
    for several in (1, 7, 22, 30):
        state = State.of(state.arrays())
        solver("verlet").advance(compile(scene), state, several, 0.0)
    for key, array in whole.arrays().items():
        assert array.tobytes() == state.arrays().get(key, array).tobytes(), key


def test_at_rest_it_is_collide() -> None:
    """Equilibria are those without friction, to the bit of `collide`'s own kernel but for rounding of other sums."""
    x = np.array([[0.0, 0, 0], [0.95, 0, 0], [0.5, 0, 0.8]])
    held = [{"particles": [0, 1]}, {"particles": [2], "axes": "y"}]
    found = []
    for more in ({}, {"friction": 0.5, "restitution": 0.5}):
        forces = [spheres(x, **more), {"kind": "unary", "particles": [2], "vector": [0, 0, -1.0]}]
        found.append(relax(Scene(particles=x, anchors=held, forces=forces)))
    assert all(one.converged for one in found)
    assert np.abs(found[0].particles - found[1].particles).max() < 1e-9


def test_the_kernel_of_collide_is_untouched_without_them() -> None:
    """Default columns compile to the quick kernel: no memory, no damping."""
    x = np.array([[0.0, 0, 0], [0.9, 0, 0]])
    plain, rough = (compile(Scene(particles=x, forces=[spheres(x, friction=mu)])).groups[0] for mu in (0.0, 0.1))
    assert not plain.damped and plain.block.memory.shape == (2, 0)
    assert rough.cls.kind_name == "collide" and rough.yields and rough.block.memory.shape[1] > 0
    assert dispatch.compiled(plain.cls.kernel, "force") is not dispatch.compiled(rough.cls.kernel, "force")


def test_a_patch_cannot_make_smooth_spheres_rough() -> None:
    """But it can change how rough they are."""
    x = np.array([[0.0, 0, 0], [0.9, 0, 0]])
    simulation = Simulation(Scene(particles=x, forces=[spheres(x)], settings={"solver": "verlet"}))
    with pytest.raises(InputError, match="/forces/0: this field sets how it acts; send a new scene"):
        simulation.patch({"forces": {"0": {"friction": 0.3}}})
    rough = Simulation(Scene(particles=x, forces=[spheres(x, friction=0.5)], settings={"solver": "verlet"}))
    rough.patch({"forces": {"0": {"friction": 0.3, "restitution": 0.5}}})
    assert rough.system.groups[0].block.parameters[0, 6] == 0.3
    assert rough.system.groups[0].block.parameters[0, 7] > 0.0
