"""The example of every force is one that a person can copy: as a whole scene it comes to rest."""

from __future__ import annotations

import json

import pytest

from hookean import Scene, relax
from hookean.forces import KINDS
from hookean.scene.catalogue import entry
from laws.cases import scene_of


@pytest.mark.thinned
@pytest.mark.parametrize("kind", KINDS)
def test_the_scene_of_the_catalogue_comes_to_rest(kind: str) -> None:
    """As text and back, by the default settings. The force is the first of the scene, and what else it may have to act
    on or be held by is there."""
    given = json.loads(json.dumps(entry(KINDS[kind])))
    result = relax(Scene.read(given["scene"]))
    assert result.converged and result.residual <= 1e-6, result.message
    assert given["scene"]["forces"][0] == given["example"]


@pytest.mark.parametrize("kind", ["hinge", "power_law", "projected_force"])
def test_forces_without_an_equilibrium_are_named_as_the_cause(kind: str) -> None:
    """Alone, these drive their particles apart or into each other, which no support of the whole would end."""
    result = relax(scene_of(*KINDS[kind].example()))
    assert result.status == "diverged"
    assert f"of /forces/0, {kind}), and no shape was found that balances them: add springs" in result.message


def test_a_load_without_supports_is_named_as_the_cause() -> None:
    """Every kind of load alone on free particles: nothing supports what it acts on."""
    loads = [kind for kind, cls in KINDS.items() if cls.role == "load" and not cls.bears and not cls.momentary]
    for kind in loads:
        result = relax(scene_of(*KINDS[kind].example()))
        assert result.status == "diverged" and "Nothing supports" in result.message, (kind, result.message)
    assert {"unary", "wind", "vortex", "self_weight"} <= set(loads)
