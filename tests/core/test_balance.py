"""How a shape is judged: the residual by its definition, whatever is held and whatever touches it."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as some

from hookean import Scene
from hookean.balance import ROUNDING, Balance, balance
from hookean.state import State
from hookean.system import System, compile


def judged(seed: int, *, loads: bool, floor: bool) -> tuple[System, State, Balance]:
    """Eight particles in disorder, springs between them, some held on some axes."""
    rng = np.random.default_rng(seed)
    pairs = [[a, b] for a in range(8) for b in range(a)]
    forces = [{"kind": "springs", "particles": pairs, "stiffness": rng.uniform(1.0, 1e3, len(pairs))}]
    if loads:
        forces.append({"kind": "unary", "particles": [0, 3, 4], "vector": rng.normal(size=(3, 3))})
    axes = ["x", "yz", "xyz"]
    spec = {
        "particles": rng.normal(size=(8, 3)) + [0.0, 0.0, 5.0 * floor],
        "forces": forces,
        "anchors": [{"particles": [int(p)], "axes": axes[int(p) % 3]} for p in rng.permutation(8)[:4]],
        "settings": {"floor": {"point": [0.0, 0.0, 5.0]}} if floor else {},
    }
    system = compile(Scene.read(spec))
    state = system.start()
    state.x += rng.normal(size=(8, 3)) * (not floor)
    return system, state, balance(system, state)


@settings(max_examples=60, derandomize=True, deadline=None)
@given(seed=some.integers(0, 2**32 - 1), loads=some.booleans(), floor=some.booleans())
def test_the_residual_is_what_its_definition_says(seed: int, loads: bool, floor: bool) -> None:
    """max |out of balance| / mean |load| on the free axes; reactions and what is left add up to all forces; the floor
    u (w |x| + |f| + |load|) / scale. Sums in another order: 8 terms, 16 roundings at most."""
    system, state, found = judged(seed, loads=loads, floor=floor)
    f, w, _ = system.evaluate(state)
    left = f * state.free
    contact = system.support(state, left)
    close = {"rtol": 16 * ROUNDING, "atol": 0.0}
    assert np.array_equal(found.forces, left) and np.array_equal(found.contact, contact)
    assert np.array_equal(found.reactions, -(f + contact) * (1.0 - state.free))
    sizes = np.linalg.norm(left, axis=1)
    assert found.worst == np.argmax(sizes)
    np.testing.assert_allclose(found.out_of_balance, sizes.max(), **close)
    load = np.linalg.norm(system.evaluate(state, only="load")[0] * state.free, axis=1)
    if loads and load.any():
        np.testing.assert_allclose(found.scale, load[load > 0.0].mean(), **close)
    noise = ROUNDING * (w * np.abs(state.x).max(axis=1) + np.abs(f).max(axis=1) + load)
    np.testing.assert_allclose(found.floor * found.scale, noise[state.free.any(axis=1)].max(), rtol=1e-14)
    np.testing.assert_allclose(found.residual, sizes.max() / found.scale, rtol=1e-14)


@pytest.mark.parametrize("particle", [0, 5])
def test_a_number_that_is_none_is_told(particle: int) -> None:
    """A position that is not a number leaves a residual that is none: nothing calls that balanced."""
    system, state, _ = judged(1, loads=True, floor=False)
    state.free[:] = 1.0
    state.x[particle] = np.nan
    found = balance(system, state)
    assert np.isnan(found.residual) and not found.met(1e9)
