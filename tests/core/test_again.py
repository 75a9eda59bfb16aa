"""What was relaxed and is called stable is relaxed again, and has no lower energy to find.

A shape that was read back from a file is the first one but for its last digits. From an unstable equilibrium these
are enough to fall, and the second run ends lower than the first: then the first has to say `unstable` (a principle of
Dirichlet: stable means a strict minimum of the potential energy).
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean import Scene
from hookean.running.run import relax_state
from hookean.solvers import solver
from hookean.system.system import compile
from soak import SOAK, sampled

from ..laws.scenes import FAMILIES, random_scene

SEEDS = range(500 if SOAK else 40)
Spec = dict[str, Any]


def again(scene: Scene, digits: float) -> tuple[Any, Any]:
    """Two results: of the scene, and of what the first left, with `digits` of its size changed at random."""
    system = compile(scene)
    state = system.start()
    first = relax_state(system, state, solver(scene.settings.solver))
    size = np.ptp(first.particles, axis=0).max()
    change = np.random.default_rng(1).standard_normal(first.particles.shape) * digits * size
    # springs keep their rest lengths: the system is that of the first run, its start the shape found
    moved = system.start()
    moved.x[:] = first.particles + change * moved.free
    return first, relax_state(system, moved, solver(scene.settings.solver))


def lower(first: Any, second: Any) -> bool:
    """Whether the second run ended below the first by more than the two tolerances explain."""
    one, two = first.energy["total"], second.energy["total"]
    size = np.ptp(first.particles, axis=0).max()
    force = max(first.out_of_balance, second.out_of_balance)
    # a residual of `force` over what moved, and digits of the sum
    slack = force * len(first.particles) * 1e-3 * size + 1e-9 * sum(map(abs, first.energy.values()))
    return bool(two < one - slack)


def remembers(spec: Spec) -> bool:
    """Whether forces depend on the way: what yielded, and what rubs on a floor."""
    rubs = (spec["settings"].get("floor") or {}).get("static_friction", 0.0)
    return bool(rubs) or any(np.any(force.get("plasticity", 0)) for force in spec["forces"])


def pressed(seed: int) -> Spec:
    """A net that is 2 to 30 % too large for the rim that holds it, so that it has creases in many ways; with or
    without diagonals, flat or nearly flat at the start, with or without weight."""
    rng = np.random.default_rng(seed)
    n, weight = int(rng.integers(4, 9)), float(rng.choice([0.0, 0.1, 1.0]))
    place = np.stack(np.meshgrid(np.arange(n + 1.0), np.arange(n + 1.0), indexing="ij"), -1).reshape(-1, 2)
    number = np.arange(len(place)).reshape(n + 1, n + 1)
    pairs = [number[:-1].ravel(), number[1:].ravel()], [number[:, :-1].ravel(), number[:, 1:].ravel()]
    one, other = [number[:-1, :-1].ravel(), number[1:, 1:].ravel()], [number[1:, :-1].ravel(), number[:-1, 1:].ravel()]
    kinds = [*pairs, *([one, other] if rng.random() < 0.7 else [])]
    joined = np.concatenate([np.transpose(kind) for kind in kinds])
    rim = np.unique(np.concatenate([number[0], number[-1], number[:, 0], number[:, -1]]))
    x = np.column_stack([place, rng.choice([0.0, 1e-3]) * rng.standard_normal(len(place))])
    forces = [{"kind": "springs", "particles": joined, "stiffness": 100.0, "rest_factor": rng.uniform(1.02, 1.3)}]
    if weight:
        forces.append({"kind": "unary", "particles": np.arange(len(x)), "vector": [0.0, 0.0, -weight]})
    return {"particles": x, "forces": forces, "anchors": [{"particles": rim}], "settings": {}}


@pytest.mark.thinned
@pytest.mark.slow
@pytest.mark.parametrize("family", sampled(("pressed", *(f for f in FAMILIES if f != "shell"), "shell"), 3))
def test_a_stable_shape_has_no_lower_one_beside_it(family: str) -> None:
    for seed in SEEDS[::4] if family == "pressed" else (s for s in SEEDS if FAMILIES[s % len(FAMILIES)] == family):
        spec = pressed(seed) if family == "pressed" else random_scene(seed)
        if remembers(spec):
            continue
        first, second = again(Scene.read(spec), 1e-7)
        if first.converged and first.stability == "stable":
            assert not lower(first, second), (seed, first.energy, second.energy)


def test_an_unstable_shape_that_is_kept_has_a_lower_one_and_says_so() -> None:
    """Two struts in a line, too long for their place: straight they are a maximum of the energy, aside it is 0."""
    scene = Scene.read({
        "particles": [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]],
        "forces": [{"kind": "springs", "particles": [[0, 1], [1, 2]], "stiffness": 10.0, "rest_length": 1.1}],
        "anchors": [{"particles": [0, 2]}],
        "settings": {"allow_unstable": True},
    })  # fmt: skip
    first, second = again(scene, 1e-4)
    assert first.stability == "unstable" and first.energy["total"] == pytest.approx(0.1)  # 2 * 10 * 0.1**2 / 2
    assert lower(first, second) and second.energy["total"] == pytest.approx(0.0, abs=1e-9)
