"""Every kind of force by a recipe: the scene of the catalogue, with coordinates and the drawn mesh, comes to rest."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rhino3dm

from hookean.files.relax_file import relax_file
from hookean.forces import KINDS
from hookean.scene.examples import example_scene
from soak import sampled


def table(force: dict[str, Any], x: np.ndarray) -> str:
    """The table of a force, lists and numbers as in JSON: coordinates in place of particles, the layer of its mesh."""
    given = dict(force)
    if "particles" in given:
        places = x[np.asarray(given.pop("particles"))]
        lines = "lines" in KINDS[given["kind"]].model_fields and places.shape[1:] == (2, 3)
        given["lines" if lines else "points"] = places.tolist()
    if "mesh" in given:
        given["mesh"] = "layer:skin"
    return "[[forces]]\n" + "".join(f"{name} = {json.dumps(value)}\n" for name, value in given.items())


def drawn(scene: dict[str, Any], path: Path) -> None:
    """A .3dm file with the scene's mesh, or else its points, on a layer."""
    model, layer, attributes = rhino3dm.File3dm(), rhino3dm.Layer(), rhino3dm.ObjectAttributes()
    model.Settings.ModelUnitSystem, layer.Name = rhino3dm.UnitSystem.Meters, "skin"
    attributes.LayerIndex = model.Layers.Add(layer)
    for mesh in scene.get("meshes", {}).values():
        made = rhino3dm.Mesh()
        for place in mesh["vertices"]:
            made.Vertices.Add(*place)
        for face in mesh["faces"]:
            made.Faces.AddFace(*face)
        model.Objects.AddMesh(made, attributes)
    for place in scene["particles"] if "meshes" not in scene else ():
        model.Objects.AddPoint(rhino3dm.Point3d(*place), attributes)
    assert model.Write(str(path), 8)


@pytest.mark.parametrize("kind", sampled(list(KINDS), 12))
def test_the_scene_of_the_catalogue_is_relaxed_by_a_recipe(kind: str, tmp_path: Path) -> None:
    scene = example_scene(KINDS[kind])
    x = np.array(scene["particles"])
    drawn(scene, tmp_path / "model.3dm")
    recipe = f'particles = {json.dumps(scene["particles"])}\n[units]\nlength = "m"\nforce = "N"\n'
    recipe += "".join(table(force, x) for force in scene["forces"])
    for anchor in scene.get("anchors", []):
        recipe += f"[[anchors]]\npoints = {json.dumps(x[anchor['particles']].tolist())}\n"
    found = relax_file(tmp_path / "model.3dm", tmp_path / "relaxed.3dm", recipe)
    assert found.result.converged, found.result.message
