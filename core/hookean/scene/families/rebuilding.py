"""Other parameters for a scene of a family, with what was changed of it since."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from hookean.errors import InputError
from hookean.forces.base import PLACES, Force
from hookean.scene.families import found
from hookean.scene.scene import Scene

CARRIED = ("family", "forces", "settings")


def rebuilt(scene: Scene, parameters: Mapping[str, Any]) -> Scene:
    """The scene of the same family with other values of some parameters.

    Settings, changed numbers of the family's forces, and forces that were added on all particles or on a mesh are
    carried over; where the particles keep their numbers, also forces on these. InputError where anything else was
    changed: it may have no place there.
    """
    if scene.family is None:
        raise InputError("/family", "this model was not made from a family, so it has no parameters")
    one, old = found(scene.family.name), scene.family.parameters
    given = {name: value for name, value in parameters.items() if name not in old or value != old[name]}
    made, fresh = one.scene(old, scene.units), one.scene({**old, **given}, scene.units)
    changed = [n for n in type(scene).model_fields if n not in CARRIED and _value(scene, n) != _value(made, n)]
    if changed:
        raise _edited(", ".join(changed))
    if len(scene.forces) < len(made.forces):
        raise _edited("forces")
    forces = _all_carried(scene, made, fresh)
    places = {"mesh", "particles"} if _numbered(made) == _numbered(fresh) else {"mesh"}
    for force in scene.forces[len(made.forces) :]:
        if any(getattr(force, place, None) is not None for place in PLACES if place not in places):
            raise _edited(f"the added force {force.name or force.called!r}")
        forces.append(force)
    return fresh.replaced(forces=tuple(forces), settings=scene.settings)


def _all_carried(scene: Scene, made: Scene, fresh: Scene) -> list[Force]:
    """The forces of the fresh scene with what was changed of their namesakes. One that the fresh scene has no more, as
    edge cables where the edges are held, may not have been changed."""
    forces = {(force.called, force.name): force for force in fresh.forces}
    for force, old in zip(scene.forces, made.forces, strict=False):
        place = old.called, old.name
        if place in forces:
            forces[place] = _carried(force, old, forces[place])
        elif force.model_dump(mode="json") != old.model_dump(mode="json"):
            raise _edited(old.name)
    return list(forces.values())


def _carried(force: Force, made: Force, fresh: Force) -> Force:
    """A force of the fresh scene with those single values that differ from what was made, unless a parameter has
    changed them, too."""
    kept = {}
    for name in type(made).model_fields if force.called == made.called else ("kind",):
        value = _value(force, name)
        if value == _value(made, name):
            continue
        if np.ndim(value) or isinstance(value, dict) or name in (*PLACES, "kind"):
            raise _edited(f"{name} of {made.name}")
        if _value(fresh, name) == _value(made, name):
            kept[name] = getattr(force, name)
    return fresh.replaced(**kept) if kept else fresh


def _numbered(scene: Scene) -> list[Any]:
    """What is the same in scenes whose particles have the same numbers."""
    faces = [mesh.faces.tolist() for mesh in scene.meshes.values()]
    return [len(scene.particles), faces, [_value(force, "particles") for force in scene.forces if _placed(force)]]


def _placed(force: Force) -> bool:
    return getattr(force, "particles", None) is not None


def _value(part: Any, name: str) -> Any:
    """A field as plain values, which can be compared."""
    return part.model_dump(mode="json", include={name})[name]


def _edited(what: str) -> InputError:
    said = f"the model was edited after it was made ({what}), so its parameters cannot change it any more"
    return InputError("/family", f"{said}; undo these edits, or make a new model")
