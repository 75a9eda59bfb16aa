"""Contacts push and never pull, keep particles out, slow and never drive, and tell exactly what they carry."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hookean.compiled import dispatch
from hookean.forces import KINDS
from hookean.forces.floor import Floor
from hookean.system.system import compile
from soak import examples

from .cases import scene_of
from .laws import guarded

SEEDED = settings(derandomize=True, deadline=None, max_examples=examples(200), database=None)
CONTACTS = {kind: cls for kind, cls in KINDS.items() if cls.support is not None or cls.impact is not None}
every = pytest.mark.parametrize("kind", CONTACTS)
seeds = st.integers(0, 2**32 - 1)


def table(kind: str) -> np.ndarray:
    """Parameters of the example."""
    (group,) = compile(scene_of(*CONTACTS[kind].example())).contacts
    return group.block.parameters


def plane(rng: np.random.Generator) -> np.ndarray:
    """Parameters of a floor of any place, slope and roughness."""
    holds = rng.uniform(0, 1)
    floor = Floor(
        point=rng.normal(size=3), normal=rng.normal(size=3), restitution=rng.uniform(0, 1),
        static_friction=holds, kinetic_friction=holds * rng.uniform(0, 1),
    )  # fmt: skip
    (group,) = compile(scene_of(floor, np.zeros((1, 3)))).contacts
    return group.block.parameters


def supported(parameters: np.ndarray, rng: np.random.Generator, dt: float, run: Any = None) -> dict[str, np.ndarray]:
    """Particles on, above and below the plane under random forces: before and after the support hook."""
    n, point, normal = 12, parameters[0, :3], parameters[0, 3:6]
    x, f, v = rng.normal(size=(n, 3)), rng.normal(size=(n, 3)), 0.1 * rng.normal(size=(n, 3))
    height = (x - point) @ normal
    on = rng.random(n) < 0.7
    x[on] -= height[on, None] * normal
    v[rng.random(n) < 0.3] = 0.0
    free = (rng.random((n, 3)) < 0.8).astype(float)
    f, v = f * free, v * free
    mass, carried = rng.uniform(0.5, 2.0, n), np.zeros((n, 3))
    told = {"f": f.copy(), "v": v.copy(), "x": x.copy(), "free": free}
    hook = run or dispatch.compiled(Floor.support, "support")
    hook(x, v, f, carried, free, mass, dt, parameters)
    return {**told, "x_after": x, "f_after": f, "v_after": v, "carried": carried, "normal": normal}


@every
@SEEDED
@given(seed=seeds, dt=st.sampled_from([0.0, 0.01]))
def test_what_is_carried_is_what_was_taken(kind: str, seed: int, dt: float) -> None:
    """f after = f before + carried on free axes, to rounding; positions stay. On held axes the anchor answers what the
    contact pushes, so forces there are not touched, and what is carried there only comes with a pressing contact."""
    rng = np.random.default_rng(seed)
    if CONTACTS[kind].support is None:
        return
    hook = dispatch.compiled(CONTACTS[kind].support, "support")
    told = supported(plane(rng) if kind == "floor" else table(kind), rng, dt, hook)
    assert np.abs(told["f_after"] - told["f"] - told["carried"] * told["free"]).max() <= 1e-13
    assert (told["x_after"] == told["x"]).all()
    assert (told["f_after"][told["free"] == 0] == told["f"][told["free"] == 0]).all()
    idle = (told["carried"] * told["free"] == 0).all(axis=1)
    assert (told["carried"][idle] == 0).all()


@SEEDED
@given(seed=seeds, dt=st.sampled_from([0.0, 0.01]))
def test_a_floor_pushes_and_friction_obeys_coulomb(seed: int, dt: float) -> None:
    """N >= 0 and |T| <= max(mu_s, mu_k) N where all axes are free; nothing presses through, nothing acts above."""
    rng = np.random.default_rng(seed)
    parameters = plane(rng)
    told = supported(parameters, rng, dt)
    normal = told["normal"]
    pressing = told["carried"] @ normal
    assert (pressing >= -1e-14).all()
    sideways = np.linalg.norm(told["carried"] - pressing[:, None] * normal, axis=1)
    whole = (told["free"] == 1).all(axis=1)
    rough = max(parameters[0, 7], parameters[0, 8])
    assert (sideways[whole] <= rough * pressing[whole] + 1e-13).all()
    height = (told["x"] - parameters[0, :3]) @ normal
    assert (told["carried"][height > 1e-9] == 0).all()
    # after the support no free particle on the plane is pressed into it
    touched = np.abs(told["carried"]).max(axis=1) > 0
    assert ((told["f_after"] * told["free"]) @ normal)[touched].min(initial=0.0) >= -1e-13


@SEEDED
@given(seed=seeds)
def test_friction_never_drives(seed: int) -> None:
    """Sliding: the friction force has no part along the velocity; speeds never grow by the support."""
    rng = np.random.default_rng(seed)
    told = supported(plane(rng), rng, 0.01)
    before, after = np.linalg.norm(told["v"], axis=1), np.linalg.norm(told["v_after"], axis=1)
    assert (after <= before * (1 + 1e-12) + 1e-15).all()
    normal = told["normal"]
    whole = (told["free"] == 1).all(axis=1)
    slip = told["v"] - (told["v"] @ normal)[:, None] * normal
    drag = told["carried"] - (told["carried"] @ normal)[:, None] * normal
    sliding = whole & (np.linalg.norm(slip, axis=1) > 0.1)
    assert (slip * drag).sum(axis=1)[sliding].max(initial=-1.0) <= 1e-13


def dropped(parameters: np.ndarray, rng: np.random.Generator, dt: float, run: Any = None) -> dict[str, np.ndarray]:
    """Particles near the plane take a step of velocity Verlet into or past it; the impact hook answers."""
    n, point, normal = 12, parameters[0, :3], parameters[0, 3:6]
    x_before = rng.normal(size=(n, 3))
    x_before += (np.abs(rng.normal(size=n)) * 0.05 - (x_before - point) @ normal)[:, None] * normal
    v_before, acceleration = rng.normal(size=(n, 3)) * 5.0, rng.normal(size=(n, 3)) * 10.0
    free = np.ones((n, 3))
    v = v_before + 0.5 * dt * acceleration
    x = x_before + dt * v
    missed = x.copy()
    hook = run or dispatch.compiled(Floor.impact, "impact")
    hook(x_before, v_before, acceleration, x, v, free, dt, parameters)
    return {"x": x, "v": v, "v_before": v_before, "missed": missed, "x_before": x_before, "a": acceleration}


@SEEDED
@given(seed=seeds, dt=st.sampled_from([0.001, 0.01, 0.1]))
def test_nothing_passes_a_floor_and_a_bounce_gains_no_speed(seed: int, dt: float) -> None:
    """After an impact no particle is below the plane, what missed it is untouched, and energy does not grow.

    Energy of free flight in the field of the acceleration a: |v|^2/2 - a.x, at the end of the step.
    """
    rng = np.random.default_rng(seed)
    parameters = plane(rng)
    told = dropped(parameters, rng, dt)
    point, normal = parameters[0, :3], parameters[0, 3:6]
    height = (told["x"] - point) @ normal
    assert height.min() >= -1e-13 * (1.0 + np.abs(told["x"]).max())
    clear = (told["missed"] - point) @ normal >= 0
    assert (told["x"][clear] == told["missed"][clear]).all()
    final = told["v"] + 0.5 * dt * told["a"]
    before = 0.5 * (told["v_before"] ** 2).sum(axis=1) - (told["a"] * told["x_before"]).sum(axis=1)
    after = 0.5 * (final**2).sum(axis=1) - (told["a"] * told["x"]).sum(axis=1)
    assert (after <= before + 1e-12 * (1.0 + np.abs(before))).all()


@SEEDED
@given(seed=seeds, dt=st.sampled_from([0.001, 0.01, 0.1]))
def test_a_bounce_is_that_of_a_body_thrown_at_the_plane(seed: int, dt: float) -> None:
    """height h + u t + a t^2 / 2 = 0 at the smallest t > 0, found by numpy; from there up at e times the speed for the
    rest of the step, or on the plane where it comes down again within it. Without friction nothing changes along it."""
    rng = np.random.default_rng(seed)
    parameters = plane(rng)
    parameters[:, 7:9] = 0.0  # friction
    point, normal, restitution = parameters[0, :3], parameters[0, 3:6], parameters[0, 6]
    told = dropped(parameters, rng, dt)
    hits = 0
    for i in np.flatnonzero((told["missed"] - point) @ normal < 0):
        height = (told["x_before"][i] - point) @ normal
        speed, pull = told["v_before"][i] @ normal, told["a"][i] @ normal
        roots = np.roots([0.5 * pull, speed, height])
        time = min(t.real for t in roots if abs(t.imag) < 1e-12 and t.real > 0)
        rebound, rest = -restitution * (speed + pull * time), dt - time
        above = rebound * rest + 0.5 * pull * rest**2
        assert (told["x"][i] - point) @ normal == pytest.approx(max(above, 0.0), abs=1e-12)
        if above > 1e-12:
            hits += 1
            assert (told["v"][i] + 0.5 * dt * told["a"][i]) @ normal == pytest.approx(rebound + pull * rest, abs=1e-10)
        along = (told["x"][i] - told["missed"][i]) - (told["x"][i] - told["missed"][i]) @ normal * normal
        assert along == pytest.approx(np.zeros(3), abs=1e-12)
    assert hits or dt < 0.1


def degenerate() -> dict[str, np.ndarray]:
    """Positions and speeds at which a contact might divide by zero."""
    rng = np.random.default_rng(0)
    return {
        "on the plane": np.zeros((4, 3)), "far below": np.full((4, 3), -1e9), "far above": np.full((4, 3), 1e9),
        "just below": np.full((4, 3), -1e-300), "scattered": rng.normal(size=(4, 3)),
    }  # fmt: skip


@every
@pytest.mark.parametrize("where", degenerate())
@pytest.mark.parametrize("speed", [0.0, 1e-300, 1.0, 1e9])
@pytest.mark.parametrize("dt", [0.0, 0.01])
def test_degenerate_contacts_stay_finite(kind: str, where: str, speed: float, dt: float) -> None:
    """At rest or fast, on, below or far from the contact, held or free: positions, velocities and forces are finite."""
    cls, parameters = CONTACTS[kind], table(kind)
    x = degenerate()[where].copy()
    v, a = speed * np.array([[0, 0, -1.0], [0, 0, 1.0], [1.0, 0, 0], [0, 0, 0]]), np.zeros((4, 3))
    for free in (np.ones((4, 3)), np.zeros((4, 3)), np.tile([1.0, 1.0, 0.0], (4, 1))):
        y, u, f, carried = x + dt * v, v.copy(), -x, np.zeros((4, 3))
        if cls.impact is not None:
            dispatch.compiled(cls.impact, "impact")(x, v, a, y, u, free, dt, parameters)
        if cls.support is not None:
            dispatch.compiled(cls.support, "support")(y, u, f, carried, free, np.ones(4), dt, parameters)
        assert all(np.isfinite(array).all() for array in (y, u, f, carried))


@pytest.mark.parametrize("dt", [0.0, 0.01])
def test_contacts_as_plain_python_give_the_same(dt: float) -> None:
    """Every index checked, and the same numbers as machine code to rounding."""

    def checked(function: Any) -> Any:
        def run(*arguments: Any) -> None:
            copies = [guarded(a) if isinstance(a, np.ndarray) else a for a in arguments]
            with np.errstate(all="ignore"):
                function(*copies)
            for original, copy in zip(arguments, copies, strict=True):
                if isinstance(original, np.ndarray):
                    original[:] = copy

        return run

    for seed in range(20):
        for does, hook in ((supported, Floor.support), (dropped, Floor.impact)):
            parameters = plane(np.random.default_rng(seed))
            machine = does(parameters, np.random.default_rng(seed), dt)
            python = does(parameters, np.random.default_rng(seed), dt, checked(hook))
            for name, array in machine.items():
                assert np.abs(array - python[name]).max() <= 1e-13 * (1.0 + np.abs(array).max()), name


def test_a_floor_that_pulls_would_be_seen() -> None:
    """Negative control: a support that also holds particles back fails Coulomb's law."""

    def sticky(x, v, f, carried, free, mass, dt, parameters):  # type: ignore[no-untyped-def]
        carried -= f * free
        f -= f * free

    rng = np.random.default_rng(1)
    told = supported(plane(rng), rng, 0.0, sticky)
    assert (told["carried"] @ told["normal"]).min() < -0.1
