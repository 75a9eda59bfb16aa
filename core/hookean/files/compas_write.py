"""A model as one COMPAS document in the shape it has now: a Mesh of its meshes' faces, else a Graph of its springs.

The document is the model as well: it holds the scene as an attribute (see `embedded`), for as long as nobody changes
its vertices, faces or edges. For programs that read COMPAS, supports and loads are attributes of its vertices, by the
names that `hookean_client.compas` reads: `is_support`, `px`, `py`, `pz`.
"""

from __future__ import annotations

import hashlib
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from hookean.files import compas_json, embedded

if TYPE_CHECKING:
    from hookean.scene.scene import Scene
    from hookean.system.state import State
    from hookean.system.system import System

SHAPE = "hookean-shape"
CHANGED = "the document was changed after hookean wrote it: it is read as drawn, and the scene stored in it is ignored"


def document(system: System, state: State, scene: Scene) -> dict[str, Any]:
    """The COMPAS document of a system at a state; `scene` is what it holds as its model."""
    faces = _faces(system)
    if len(faces):
        used, renumbered = np.unique(faces, return_inverse=True)
        name = next(iter(system.scene.meshes))
        made = compas_json.mesh(state.x[used], renumbered.reshape(faces.shape), name=name)
        vertices = made["data"]["vertex"]
    else:
        used = np.arange(system.slots.count)
        made = compas_json.graph(state.x[used], _edges(system))
        vertices = made["data"]["node"]
    held, load = (state.free == 0).any(axis=1), system.evaluate(state, only="load")[0]
    for particle, vertex in zip(used.tolist(), vertices.values(), strict=True):
        if held[particle]:
            vertex["is_support"] = True
        if load[particle].any():
            vertex.update(zip(("px", "py", "pz"), load[particle].tolist(), strict=True))
    units = scene.units.model_dump()
    made["data"]["attributes"] = {
        "units": units,
        embedded.KEY: embedded.packed(scene),
        SHAPE: _shape(compas_json.read(made)),
    }
    return made


def stored(value: dict[str, Any], read: compas_json.Document) -> tuple[Any, tuple[str, ...]]:
    """The scene that `document` stored in a COMPAS document, as plain values, or None; a warning where it was changed
    since."""
    data = value["data"]
    attributes = data.get("attributes") if isinstance(data, dict) else None
    text = attributes.get(embedded.KEY) if isinstance(attributes, dict) else None
    if not isinstance(text, str) or not isinstance(attributes, dict):
        return None, ()
    if attributes.get(SHAPE) != _shape(read):
        return None, (CHANGED,)
    return embedded.unpacked(text, f"/data/attributes/{embedded.KEY}"), ()


def _faces(system: System) -> NDArray[np.int64]:
    """Faces (m, 4) of all meshes of the scene, in particles, each once."""
    found = [faces for name in system.scene.meshes if (faces := system.places.faces(name)).min(initial=0) >= 0]
    faces = np.concatenate(found) if found else np.zeros((0, 4), np.int64)
    _, first = np.unique(np.sort(faces, axis=1), axis=0, return_index=True)
    return faces[np.sort(first)]


def _edges(system: System) -> NDArray[np.int64]:
    """Pairs (m, 2) of particles that something pulls together, each once."""
    found = [g.particles for g in system.groups if g.cls.role == "internal" and g.particles.shape[1] == 2]
    pairs = np.concatenate(found) if found else np.zeros((0, 2), np.int64)
    _, first = np.unique(np.sort(pairs, axis=1), axis=0, return_index=True)
    return pairs[np.sort(first)]


def _shape(read: compas_json.Document) -> str:
    """A digest of vertices, faces and edges, whatever their attributes and keys."""
    digest = hashlib.sha256(np.ascontiguousarray(read.points, "<f8").tobytes())
    edges = np.sort(np.asarray(read.edges, np.int64), axis=1)
    digest.update(repr(read.faces).encode() + edges[np.lexsort(edges.T)].astype("<i8").tobytes())
    return digest.hexdigest()
