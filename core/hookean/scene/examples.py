"""The example of each kind of force as a whole scene that comes to rest."""

from __future__ import annotations

from typing import Any

from hookean.discretize.meshes import naked_vertices
from hookean.forces.base import Force


def example_scene(cls: type[Force]) -> dict[str, Any]:
    """A scene with the example of a kind of force, as plain values: particles, meshes, the force first, and what it
    comes to rest with. A load has something to act on, and supports; another force has its `example_beside`.

    Raises TypeError where the class gives no example.
    """
    force, x = cls.example()
    given = {"kind": cls.kind_name, **force.model_dump(mode="json", exclude_unset=True)}
    scene: dict[str, Any] = {"particles": x.tolist()}
    if given.get("mesh"):
        scene["meshes"] = {given["mesh"]: {"vertices": x.tolist(), "faces": cls.example_faces}}  # type: ignore[attr-defined]
    beside = cls.example_beside or (_supports(cls, scene, given) if cls.role == "load" else {})
    return {**scene, **beside, "forces": [given, *beside.get("forces", [])]}


def _supports(cls: type[Force], scene: dict[str, Any], given: dict[str, Any]) -> dict[str, Any]:
    """What a load acts on: the springs of a net whose edge is held, of a chain whose ends are, or elastic supports."""
    if given.get("mesh"):
        rim = naked_vertices((scene["particles"], scene["meshes"][given["mesh"]]["faces"])).tolist()
        return {"forces": [{"kind": "springs", "mesh": given["mesh"]}], "anchors": [{"particles": rim}]}
    if cls.arity == 2:
        lines = given["particles"]
        ends = [lines[0][0], lines[-1][1]]
        return {"forces": [{"kind": "springs", "particles": lines}], "anchors": [{"particles": ends}]}
    return {"forces": [{"kind": "anchor_spring", "particles": given["particles"], "strength": 100.0}]}
