"""COMPAS documents as plain data: read by a whitelist and written, without importing compas.

`compas.json_loads` imports whatever module a document names. Here a document is a dict `{"dtype", "data"}` whose
dtype is looked up in a short table; nothing else of it is believed.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any
from uuid import NAMESPACE_URL, uuid5

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hookean.errors import InputError

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_NO_EDGES = np.zeros((0, 2), np.int64)
_POINTS = ("points", "targets", "velocities")
_VECTORS = ("vector", "direction", "normal", "point")


@dataclass(frozen=True, eq=False)
class Document:
    """A COMPAS document read: `points` (n, 3) in its order, faces or edges by position in `points`.

    `kind` is `mesh`, `graph`, `point`, `vector`, `line`, `polyline`, `polygon` or `pointcloud`; `keys` are the names
    its vertices or nodes had.
    """

    kind: str
    points: Floats
    faces: tuple[tuple[int, ...], ...] = ()
    edges: Ints = field(default_factory=lambda: _NO_EDGES)
    keys: tuple[str, ...] = ()
    name: str = ""

    @property
    def lines(self) -> Floats:
        """Straight lines `(m, 2, 3)`: edges of a mesh or graph, segments of a polyline."""
        pairs: dict[tuple[int, int], tuple[int, int]] = {}
        for face in self.faces:
            for a, b in zip(face, face[1:] + face[:1], strict=True):
                pairs.setdefault((min(a, b), max(a, b)), (a, b))
        edges = np.array(list(pairs.values()), np.int64) if pairs else self.edges
        return np.ascontiguousarray(self.points[edges])


def is_document(value: Any) -> bool:
    """Whether `value` looks like a COMPAS document: an object with `dtype` and `data`."""
    return isinstance(value, dict) and "dtype" in value and "data" in value


def read(value: Any, pointer: str = "") -> Document:
    """The COMPAS document `value`, as `json.loads` gives it.

    A document of a class derived from an accepted one is read as that (see its `inheritance`). Raises InputError
    with a pointer under `pointer` for an unknown dtype or data that is not as compas 2 writes it.
    """
    if not is_document(value):
        raise InputError(pointer or "/", 'a COMPAS document is an object with "dtype" and "data"')
    inherited = value.get("inheritance")
    names = [value["dtype"], *(inherited if isinstance(inherited, list) else [])]
    for name in names:
        if isinstance(name, str) and name in _READERS:
            document = _READERS[name](value["data"], f"{pointer}/data")
            given = value.get("name")
            return replace(document, name=given if isinstance(given, str) else "")
    said = repr(value["dtype"])[:80] if isinstance(value["dtype"], str) else "a value that is not text"
    raise InputError(f"{pointer}/dtype", f"{said} is not supported; supported are {', '.join(_READERS)}")


def mesh(vertices: ArrayLike, faces: Any, keys: Sequence[str] = (), name: str = "") -> dict[str, Any]:
    """A Mesh document of vertices `(n, 3)` [length] and faces that name them by position.

    A side of no length, as in `(a, b, c, c)`, goes. `keys` names the vertices by whole numbers (none: 0, 1, ...).
    """
    xyz = np.asarray(vertices, dtype=np.float64).reshape(-1, 3).tolist()
    number = [int(k) for k in keys] if keys else list(range(len(xyz)))
    rows = [[number[int(v)] for v in _without_repeats(face)] for face in faces]
    data = {
        "attributes": {},
        "default_vertex_attributes": {"x": 0.0, "y": 0.0, "z": 0.0},
        "default_edge_attributes": {},
        "default_face_attributes": {},
        "vertex": {str(k): {"x": x, "y": y, "z": z} for k, (x, y, z) in zip(number, xyz, strict=True)},
        "face": {str(i): row for i, row in enumerate(rows)},
        "facedata": {},
        "edgedata": {},
        "max_vertex": max(number, default=-1),
        "max_face": len(rows) - 1,
    }
    return _written("compas.datastructures/Mesh", data, name)


def graph(points: ArrayLike, edges: ArrayLike, name: str = "", keys: Sequence[str] = ()) -> dict[str, Any]:
    """A Graph document of nodes `(n, 3)` [length] and edges `(m, 2)` that name them by position.

    `keys` are the nodes' keys as a document has them, such as `0` or `'a'` (none: 0, 1, ...).
    """
    xyz = np.asarray(points, dtype=np.float64).reshape(-1, 3).tolist()
    known = list(keys) or [str(i) for i in range(len(xyz))]
    adjacency: dict[str, dict[str, Any]] = {key: {} for key in known}
    for a, b in np.asarray(edges, dtype=np.int64).reshape(-1, 2).tolist():
        adjacency[known[a]][known[b]] = {}
    data = {
        "attributes": {},
        "default_node_attributes": {"x": 0.0, "y": 0.0, "z": 0.0},
        "default_edge_attributes": {},
        "node": {key: {"x": x, "y": y, "z": z} for key, (x, y, z) in zip(known, xyz, strict=True)},
        "edge": adjacency,
        "max_node": max((int(key) for key in known if key.isdecimal()), default=-1),
    }
    return _written("compas.datastructures/Graph", data, name)


def moved(document: Document, entry: dict[str, Any]) -> dict[str, Any]:
    """The document that a carried geometry was given as, in the shape of its `entry` in a result.

    Names, keys, faces and edges stay; other attributes of the document were never read.
    """
    points = document.points.copy()
    if document.kind == "mesh":
        return mesh(entry["vertices"], document.faces, document.keys, document.name)
    if "lines" in entry:
        points[document.edges] = entry["lines"]
    else:
        points = np.asarray(entry["points"])[: len(points)]  # a polygon is carried closed
    if document.kind == "graph":
        return graph(points, document.edges, document.name, document.keys)
    rows = points.tolist()
    several: dict[str, Any] = {"points": rows}
    data: dict[str, Any] = {"point": rows[0], "vector": rows[0]} if len(rows) == 1 else {}
    if document.kind == "line":
        data["line"] = {"start": rows[0], "end": rows[1]}
    dtype = f"compas.geometry/{document.kind.capitalize()}"
    return _written(dtype, data.get(document.kind, several), document.name)


def plain_scene(value: Any) -> tuple[Any, dict[str | int, Document], bool]:
    """A scene's JSON values with every COMPAS document replaced by arrays, the documents that come back moved, and
    whether there were any documents.

    Meshes may be Mesh documents; `lines` Mesh, Graph, Line or Polyline documents or a list of them; coordinates Point,
    Pointcloud, Polyline, Mesh or Graph documents or a list of them; vectors Vector documents; a carried geometry any
    document. What comes back are mesh documents by their names and documents of geometry by their numbers. `value`
    stays as it is; for documents that are no scene see `documents.plain`. Raises what `read` raises.
    """
    if not isinstance(value, dict):
        return value, {}, False
    meshes: dict[str | int, Document] = {}
    scene, seen = _plain_fields(value, "", (*_POINTS, "particles"))
    if isinstance(value.get("meshes"), dict):
        scene["meshes"] = dict(value["meshes"])
        for name, entry in value["meshes"].items():
            if is_document(entry):
                meshes[name], scene["meshes"][name] = plain_mesh(entry, f"/meshes/{_escaped(name)}")
    _carry_documents(scene, meshes)
    for group in ("forces", "anchors", "geometry"):
        if isinstance(value.get(group), list):
            found = [_plain_fields(item, f"/{group}/{i}", _POINTS) for i, item in enumerate(scene[group])]
            scene[group] = [item for item, _ in found]
            seen = seen or any(s for _, s in found)
    return scene, meshes, seen or bool(meshes)


def alone(document: Document, value: Any) -> dict[str, Any]:
    """The scene of a Mesh or Graph alone: its edges springs of rest factor 0, naked vertices or nodes of one edge held.

    Raises InputError for a document of another kind.
    """
    geometry: dict[str, Any] = {"kind": "lines", "name": document.name, "lines": document.lines}
    scene: dict[str, Any] = {"particles": document.points, "geometry": [geometry]}
    if document.kind == "mesh":
        from hookean.discretize.meshes import as_mesh, edges, naked_vertices

        plain = plain_mesh(value)[1]
        drawn = as_mesh((document.points, plain["faces"]))
        pairs, held = edges(drawn), naked_vertices(drawn)
        scene["meshes"] = {"document": plain}
        geometry.update(kind="mesh", mesh="document")
        del geometry["lines"]
    elif document.kind == "graph":
        pairs = np.asarray(document.edges)
        held = np.flatnonzero(np.bincount(pairs.ravel(), minlength=len(document.points)) == 1)
    else:
        raise InputError("/dtype", f"a {document.kind} alone cannot be relaxed; give a Mesh, a Graph or a scene")
    scene["forces"] = [{"kind": "springs", "particles": pairs, "rest_factor": 0.0}]
    return {**scene, "anchors": [{"particles": held, "name": "held"}] if len(held) else []}


def _carry_documents(scene: dict[str, Any], documents: dict[str | int, Document]) -> None:
    """Geometry of the scene that is a document as plain geometry, the documents kept by its number."""
    if not isinstance(scene.get("geometry"), list):
        return
    scene["geometry"] = list(scene["geometry"])
    for i, value in enumerate(scene["geometry"]):
        if not is_document(value):
            continue
        documents[i] = document = read(value, f"/geometry/{i}")
        entry: dict[str, Any] = {"name": document.name, "kind": "points", "points": document.points}
        if document.kind == "mesh":
            name = f"geometry {i}"
            meshes = scene.get("meshes") or {}
            if not isinstance(meshes, dict) or name in meshes:
                raise InputError(
                    "/meshes",
                    f'the document /geometry/{i} needs the mesh name "{name}", which is in use; rename that mesh',
                )
            scene["meshes"] = {**meshes, name: plain_mesh(value, f"/geometry/{i}")[1]}
            entry = {"name": document.name, "kind": "mesh", "mesh": name}
        elif document.kind in ("graph", "line"):
            entry = {"name": document.name, "kind": "lines", "lines": document.lines}
        elif document.kind in ("polyline", "polygon"):
            closed = document.kind == "polygon"
            points = np.concatenate([document.points, document.points[:1]]) if closed else document.points
            entry.update(kind="polyline", points=points)
        scene["geometry"][i] = entry


def plain_mesh(value: Any, pointer: str = "") -> tuple[Document, dict[str, Any]]:
    """A Mesh document, and its `{"vertices", "faces"}` with faces of more than four sides cut into triangles."""
    document = read(value, pointer)
    if document.kind != "mesh":
        raise InputError(f"{pointer}/dtype", f"a {document.kind} given; a Mesh expected")
    faces: Any = [list(f) for f in document.faces]
    if any(len(f) > 4 for f in faces):
        from hookean.discretize.meshes import as_mesh

        faces = as_mesh((document.points, faces)).faces
    return document, {"vertices": document.points, "faces": faces}


def _plain_fields(item: Any, pointer: str, points: Sequence[str]) -> tuple[Any, bool]:
    if not isinstance(item, dict):
        return item, False
    out, seen = dict(item), False
    for name, value in item.items():
        several = isinstance(value, list) and len(value) > 0 and is_document(value[0])
        if not (several or is_document(value)) or name not in ("lines", *points, *_VECTORS):
            continue
        at = f"{pointer}/{name}"
        entries = [(v, f"{at}/{i}") for i, v in enumerate(value)] if several else [(value, at)]
        documents = [read(v, where) for v, where in entries]
        seen = True
        if name == "lines":
            out[name] = np.concatenate([d.lines for d in documents])
        elif name in _VECTORS and not several:
            out[name] = documents[0].points[0] if len(documents[0].points) == 1 else documents[0].points
        else:
            out[name] = np.concatenate([d.points for d in documents])
    return out, seen


def _mesh(data: Any, pointer: str) -> Document:
    keys, points = _vertices(data, "vertex", pointer)
    place = {key: i for i, key in enumerate(keys)}
    faces = []
    for name, corners in _object(data, "face", pointer).items():
        at = f"{pointer}/face/{_escaped(name)}"
        if not isinstance(corners, list):
            raise InputError(at, "a face is a list of vertices")
        try:
            face = tuple(place[str(v)] for v in corners)
        except KeyError:
            raise InputError(at, "a vertex of this face does not exist in the mesh") from None
        if len(set(face)) < 3:
            raise InputError(at, "a face needs at least three different vertices")
        faces.append(face)
    return Document("mesh", points, faces=tuple(faces), keys=tuple(keys))


def _graph(data: Any, pointer: str) -> Document:
    keys, points = _vertices(data, "node", pointer)
    place = {key: i for i, key in enumerate(keys)}
    pairs = []
    for start, ends in _object(data, "edge", pointer).items():
        at = f"{pointer}/edge/{_escaped(start)}"
        if not isinstance(ends, dict):
            raise InputError(at, "the edges from a node are an object by the node they go to")
        for end in ends:
            if start not in place or end not in place:
                raise InputError(at, "a node of this edge does not exist in the graph")
            pairs.append((place[start], place[end]))
    edges = np.array(pairs, dtype=np.int64).reshape(-1, 2)
    return Document("graph", points, edges=edges, keys=tuple(keys))


def _vertices(data: Any, name: str, pointer: str) -> tuple[list[str], Floats]:
    """Keys and coordinates of the vertices or nodes, defaults filled in."""
    table = _object(data, name, pointer)
    defaults = data.get(f"default_{name}_attributes")
    defaults = {"x": 0.0, "y": 0.0, "z": 0.0, **(defaults if isinstance(defaults, dict) else {})}
    rows = []
    for key, attributes in table.items():
        at = f"{pointer}/{name}/{_escaped(key)}"
        if not isinstance(attributes, dict):
            raise InputError(at, "the attributes of a vertex are an object with x, y and z")
        rows.append(_triple([attributes.get(c, defaults[c]) for c in "xyz"], at))
    return list(table), np.array(rows, dtype=np.float64).reshape(-1, 3)


def _object(data: Any, name: str, pointer: str) -> dict[str, Any]:
    value = data.get(name) if isinstance(data, dict) else None
    if not isinstance(value, dict):
        raise InputError(f"{pointer}/{name}", "an object is expected here, as compas 2 writes it")
    return value


def _triple(value: Any, pointer: str) -> list[float]:
    good = isinstance(value, list) and len(value) == 3 and all(type(c) in (int, float) for c in value)
    if not good:
        raise InputError(pointer, "three numbers x, y, z are expected")
    try:
        finite = all(math.isfinite(c) for c in value)
    except OverflowError:
        finite = False
    if not finite:
        raise InputError(pointer, "not a finite number")
    return [float(c) for c in value]


def _rows(value: Any, pointer: str) -> Floats:
    if not isinstance(value, list):
        raise InputError(pointer, "a list of points is expected")
    return np.array([_triple(p, f"{pointer}/{i}") for i, p in enumerate(value)], dtype=np.float64).reshape(-1, 3)


def _single(kind: str) -> Callable[[Any, str], Document]:
    def reader(data: Any, pointer: str) -> Document:
        if isinstance(data, dict) and isinstance(data.get("point"), list):  # written by older versions
            data = data["point"]
        return Document(kind, np.array([_triple(data, pointer)]))

    return reader


def _line(data: Any, pointer: str) -> Document:
    ends = [data.get(n) for n in ("start", "end")] if isinstance(data, dict) else [None, None]
    points = np.array([_triple(p, f"{pointer}/{n}") for p, n in zip(ends, ("start", "end"), strict=True)])
    return Document("line", points, edges=np.array([[0, 1]], dtype=np.int64))


def _several(kind: str) -> Callable[[Any, str], Document]:
    def reader(data: Any, pointer: str) -> Document:
        points = _rows(data.get("points") if isinstance(data, dict) else None, f"{pointer}/points")
        order = np.arange(len(points), dtype=np.int64)
        if kind == "pointcloud" or len(points) < 2:
            return Document(kind, points)
        after = np.roll(order, -1)
        edges = np.stack([order, after], axis=1)
        return Document(kind, points, edges=edges if kind == "polygon" else edges[:-1])

    return reader


_READERS: dict[str, Callable[[Any, str], Document]] = {
    "compas.datastructures/Mesh": _mesh,
    "compas.datastructures/Graph": _graph,
    "compas.datastructures/Network": _graph,
    "compas.geometry/Point": _single("point"),
    "compas.geometry/Vector": _single("vector"),
    "compas.geometry/Line": _line,
    "compas.geometry/Polyline": _several("polyline"),
    "compas.geometry/Polygon": _several("polygon"),
    "compas.geometry/Pointcloud": _several("pointcloud"),
}

ACCEPTED = tuple(_READERS)
"""Every dtype that is read."""


def _written(dtype: str, data: dict[str, Any], name: str) -> dict[str, Any]:
    # the same content gives the same id: no clock, no chance
    guid = str(uuid5(NAMESPACE_URL, f"hookean {dtype} {name} {data!r}"))
    return {"dtype": dtype, "data": data, "inheritance": [], **({"name": name} if name else {}), "guid": guid}


def _without_repeats(face: Any) -> list[int]:
    corners = [int(v) for v in face]
    return [v for i, v in enumerate(corners) if v != corners[i - 1] or len(corners) == 1]


def _escaped(key: str) -> str:
    return key[:80].replace("~", "~0").replace("/", "~1")
