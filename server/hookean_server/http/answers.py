"""Results as JSON: the names of `Result.to_dict`, arrays as lists or buffers, meshes plain or as COMPAS documents."""

from __future__ import annotations

import base64
import dataclasses
import json
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.files import compas_json
from hookean.running.result import Result
from hookean.scene.scene import Scene

Documents = dict[str | int, compas_json.Document]
_EMPTY: dict[str, Any] = {"geometry": [], "forces": [], "reactions": {}, "rotations": {}, "contacts": {}}


def encode(result: Result, scene: Scene, arrays: str, documents: Documents | None) -> bytes:
    """A result as JSON text. `arrays`: `list` or `buffer`.

    `documents`: meshes, and geometry that was a document, as COMPAS documents with the keys, faces and edges of those
    given, by the mesh's name or the geometry's number; none: plain.
    """
    values = dataclasses.replace(result, particles=np.zeros((0, 3)), **_EMPTY).to_dict()
    geometry = [dict(item) for item in result.geometry]
    if documents is not None:
        pairs = zip(geometry, scene.geometry, strict=True)
        geometry = [_with_document(g, i, item.mesh, documents) for i, (g, item) in enumerate(pairs)]
    values.update(
        particles=result.particles,
        geometry=geometry,
        forces=result.forces,
        reactions=result.reactions,
        rotations=result.rotations,
        contacts=result.contacts,
    )
    return dump(values, arrays)


def dump(values: Any, arrays: str) -> bytes:
    """JSON text of values with arrays in them; a number that is not finite becomes null."""
    plain = _plain(values, arrays == "buffer")
    try:
        return json.dumps(plain, allow_nan=False).encode()
    except ValueError:
        return json.dumps(_finite(plain)).encode()


def buffer(array: NDArray[Any]) -> dict[str, Any]:
    """An array as `{"dtype", "shape", "base64"}`, little endian."""
    kind = {"f": "<f8", "i": "<i8", "u": "<i8", "b": "<i4"}[array.dtype.kind]
    data = np.ascontiguousarray(array, dtype=kind)
    return {"dtype": kind, "shape": list(array.shape), "base64": base64.b64encode(data.tobytes()).decode("ascii")}


def has_buffers(value: Any) -> bool:
    """Whether a request gave any array as a buffer."""
    if isinstance(value, dict):
        return "base64" in value or any(has_buffers(v) for v in value.values())
    if isinstance(value, list):
        return any(has_buffers(v) for v in value) if value and isinstance(value[0], dict) else False
    return False


def _plain(value: Any, buffers: bool) -> Any:
    if isinstance(value, np.ndarray):
        return buffer(value) if buffers else value.tolist()
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, dict):
        return {k: _plain(v, buffers) for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(v, buffers) for v in value]
    return value


def _finite(value: Any) -> Any:
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, dict):
        return {k: _finite(v) for k, v in value.items()}
    return [_finite(v) for v in value] if isinstance(value, list) else value


def _with_document(entry: dict[str, Any], number: int, name: str | None, documents: Documents) -> dict[str, Any]:
    """A carried geometry with `mesh`, of a mesh, or `document`, of anything else that was one, in place of arrays."""
    kept = {key: entry[key] for key in ("name", "kind")}
    if number in documents and entry["kind"] != "mesh":
        return {**kept, "document": compas_json.moved(documents[number], entry)}
    if entry["kind"] != "mesh":
        return entry
    given = documents.get(number) or documents.get(name or "")
    title = (given.name if given else "") or entry["name"] or name or ""
    if given is None:
        return {**kept, "mesh": compas_json.mesh(entry["vertices"], entry["faces"], name=title)}
    return {**kept, "mesh": compas_json.mesh(entry["vertices"], given.faces, given.keys, title)}
