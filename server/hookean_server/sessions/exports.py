"""A session in the formats that other programs read. Runs in the session's process."""

from __future__ import annotations

import json
import tempfile
from pathlib import Path
from typing import Any

from hookean.files import obj, project
from hookean.running.simulation import Simulation
from hookean.system.addressed import axes_held
from hookean.system.two_ended import spring_ends
from hookean_server.http import answers
from hookean_server.lifecycle import leftovers
from hookean_server.sessions import parts

LACKS = {
    "obj": obj.LACKS,
    "csv": "A CSV file stores forces and reactions, not the model, and cannot be opened; save the scene too.",
}
"""What a format does not store of a model, in a sentence; other formats open again as the same model."""

FORMATS = {
    "json": "application/json",
    "npz": "application/octet-stream",
    "hookean": "application/octet-stream",
    "3dm": "model/vnd.3dm",
    "obj": "model/obj",
    "compas": "application/json",
    "csv": "text/csv",
}
"""Formats of a session's state, with their media types."""


def export(
    simulation: Simulation, form: str, arrays: str, view: dict[str, Any] | None = None
) -> tuple[str, bytes, list[str]]:
    """Media type, bytes, and sentences on what is not in them. `form` is one of FORMATS, or scene, topology, anchors or
    surface; `view` is kept in a .hookean file, and of a surface it has the options."""
    if form == "scene":
        return "application/json", simulation.edited_scene().canonical.encode(), []
    if form == "topology":
        return "application/json", answers.dump(topology(simulation), arrays), []
    if form == "anchors":
        return "application/json", answers.dump({"anchors": anchors(simulation)}, arrays), []
    if form == "surface":
        from hookean.analysis.surfaces import surface

        return "application/json", answers.dump(surface(simulation, **(view or {})).to_dict(), arrays), []
    if form == "hookean":
        return FORMATS[form], project.write(project.Project(simulation, view or {})), []
    if form == "3dm":
        return FORMATS[form], *_threedm(simulation)
    made: bytes = globals()[f"_{form}"](simulation, arrays)
    return FORMATS[form], made, [LACKS[form]] if form in LACKS else []


def topology(simulation: Simulation) -> dict[str, Any]:
    """What stays while a session runs: springs, meshes, geometry and forces by particles, and the units."""
    system = simulation.system
    pairs, numbers = spring_ends(system)
    scene = simulation.scene
    geometry = []
    for item, particles in zip(scene.geometry, system.carried, strict=True):
        entry: dict[str, Any] = {"name": item.name, "kind": item.kind, "particles": particles}
        if item.mesh is not None:
            entry["faces"] = scene.meshes[item.mesh].faces
        geometry.append(entry)
    return {
        "particles": system.slots.count,
        "start": system.points,
        "springs": pairs,
        "spring_forces": numbers,
        "forces": [{"kind": f.kind_name, "name": f.name, "role": type(f).role} for f in scene.forces],
        "meshes": {name: {"faces": system.places.faces(name)} for name in scene.meshes},
        "geometry": geometry,
        "loads": loads(simulation),
        "units": scene.units.model_dump(),
    }


def loads(simulation: Simulation) -> list[dict[str, Any]]:
    """Particles and vectors of the loads, by the number of their force."""
    found = []
    system, state = simulation.system, simulation.state
    for group, memory in zip(system.groups, state.memory, strict=True):
        if group.cls.role == "load" and group.block.indices.shape[1] == 1:
            vectors = system.element_forces(group, state, memory)[:, 0]
            for part in group.parts:
                particles = group.block.indices[part.rows, 0]
                found.append({"force": part.number, "particles": particles, "vectors": vectors[part.rows]})
    return found


def anchors(simulation: Simulation) -> list[dict[str, Any]]:
    """The anchors as they are now. `number` is the place in the scene, -1 for one pinned while running."""
    return [
        {
            "number": h.number,
            "name": h.name,
            "particles": h.particles,
            "targets": h.targets,
            "axes": axes_held(h.free),
            "rotations": axes_held(h.turning),
        }
        for h in simulation.system.held
    ]


def _json(simulation: Simulation, arrays: str) -> bytes:
    return answers.encode(simulation.result(), simulation.scene, arrays, None)


def _npz(simulation: Simulation, arrays: str) -> bytes:
    return parts.saved(simulation)


def _threedm(simulation: Simulation) -> tuple[bytes, list[str]]:
    from hookean.files.readers import Source
    from hookean.files.relax_file import conclude

    read = Source(simulation.edited_scene(), [], unit=simulation.scene.units.length)
    with tempfile.TemporaryDirectory(prefix=leftovers.prefix()) as folder:
        target = Path(folder) / "session.3dm"
        done = conclude(read, Path("session.json"), simulation.system, simulation.result(), target)
        return target.read_bytes(), done.unwritten


def _obj(simulation: Simulation, arrays: str) -> bytes:
    from hookean.running.claims import document_text

    result = simulation.result()
    said = document_text(result, result.report.sentences())
    return obj.text(simulation.system, result.particles, simulation.state.free, said).encode()


def _csv(simulation: Simulation, arrays: str) -> bytes:
    from hookean.files import tables

    result = simulation.result()
    return tables.csv_text(tables.rows(tables.sections(simulation.system, result), result)).encode()


def _compas(simulation: Simulation, arrays: str) -> bytes:
    """A COMPAS Mesh of the scene's meshes, else a Graph of its springs, which holds the scene as well."""
    from hookean.files import compas_write

    scene = simulation.edited_scene()
    return json.dumps(compas_write.document(simulation.system, simulation.state, scene)).encode()
