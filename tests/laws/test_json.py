"""A force as JSON is the force: round trips are the identity, for lists and for buffers."""

from __future__ import annotations

import base64
import json
from typing import Any

import numpy as np
import pytest

from hookean.forces import KINDS, Force
from hookean.scene.scene import Scene
from hookean.values.columns import Model
from soak import seeds

from .cases import scene_of

kinds = pytest.mark.parametrize("kind", KINDS)


def shaken(kind: str, seed: int) -> Scene:
    """The example of a kind with positions, and all columns above zero, changed a little: digits in every place."""
    rng = np.random.default_rng(seed)
    force, x = KINDS[kind].example()
    changes = {}
    for name in type(force).model_fields:
        value = getattr(force, name)
        if isinstance(value, np.ndarray) and value.dtype == np.float64:
            changes[name] = value * (1.0 - 0.1 * rng.random(value.shape))
    given = {name: getattr(force, name) for name in force.model_fields_set} | changes
    return scene_of(type(force)(**given), x + 0.01 * rng.normal(size=x.shape))


def buffers(value: Any, floats: str = "<f8", whole: str = "<i8") -> Any:
    """A model as plain values in which every array is {"dtype", "shape", "base64"}."""
    if isinstance(value, np.ndarray):
        dtype = floats if value.dtype == np.float64 else whole
        text = base64.b64encode(np.ascontiguousarray(value, dtype).tobytes()).decode()
        return {"dtype": dtype, "shape": list(value.shape), "base64": text}
    if isinstance(value, Model):
        return {name: buffers(getattr(value, name), floats, whole) for name in type(value).model_fields}
    if isinstance(value, dict):
        return {k: buffers(v, floats, whole) for k, v in value.items()}
    return [buffers(v, floats, whole) for v in value] if isinstance(value, list | tuple) else value


@pytest.mark.thinned
@kinds
@seeds(10, soak=30)
def test_canonical_json_read_again_is_the_same_scene(kind: str, seed: int) -> None:
    """Scene -> canonical JSON -> Scene: equal, same digest, same text; every number to the last bit."""
    scene = shaken(kind, seed)
    again = Scene.read(scene.canonical)
    assert again == scene and again.digest == scene.digest and again.canonical == scene.canonical
    assert (again.particles == scene.particles).all()
    for name in KINDS[kind].model_fields:
        assert np.array_equal(getattr(again.forces[0], name), getattr(scene.forces[0], name)), name


@pytest.mark.thinned
@kinds
@pytest.mark.parametrize("whole", ["<i8", "<i4", "<u4"])
def test_arrays_as_buffers_are_the_same_scene(kind: str, whole: str) -> None:
    """With every array as {"dtype", "shape", "base64"}: the same digest as with lists."""
    scene = shaken(kind, 5)
    packed = json.dumps(buffers(scene, whole=whole))
    assert '"base64"' in packed
    assert Scene.read(packed).digest == scene.digest


@kinds
def test_buffers_of_single_precision_are_the_rounded_numbers(kind: str) -> None:
    """<f4 buffers give the numbers that float32 holds."""
    force, x = KINDS[kind].example()
    scene = scene_of(force, x)
    packed = Scene.read(json.dumps(buffers(scene, floats="<f4")))
    assert (packed.particles == x.astype(np.float32)).all()


@kinds
def test_every_field_counts(kind: str) -> None:
    """Negative control: changing any number of a force changes the digest."""
    force, x = KINDS[kind].example()
    before = scene_of(force, x).digest
    changed = 0
    for name in type(force).model_fields:
        value = getattr(force, name)
        if isinstance(value, bool | str | int) or value is None:
            continue
        other = value + 0.25 if not isinstance(value, np.ndarray) or value.dtype == np.float64 else value[::-1].copy()
        if np.array_equal(other, value):
            continue
        try:
            edited: Force = type(force)(**{**{n: getattr(force, n) for n in force.model_fields_set}, name: other})
            assert scene_of(edited, x).digest != before, name
            changed += 1
        except ValueError:
            continue  # outside what the field allows
    assert changed
