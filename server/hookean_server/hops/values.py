"""Values as Hops sends and takes them: JSON as text with the name of a .NET type, geometry as rhino3dm's `Encode`
writes it. Readers take what is needed and leave other members aside; writers give what the component can turn into
Grasshopper's own values."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np

from hookean.errors import InputError
from hookean.scene.text import parse
from hookean.values.mesh import Mesh

TYPES = {
    "Number": "System.Double",
    "Integer": "System.Int32",
    "Boolean": "System.Boolean",
    "Text": "System.String",
    "Point": "Rhino.Geometry.Point3d",
    "Vector": "Rhino.Geometry.Vector3d",
    "Line": "Rhino.Geometry.Line",
    "Plane": "Rhino.Geometry.Plane",
    "Curve": "Rhino.Geometry.Curve",
    "Surface": "Rhino.Geometry.Brep",
    "Mesh": "Rhino.Geometry.Mesh",
}
"""Grasshopper's name of a type: the .NET type of its values."""
SIZES = {"Number": 60, "Integer": 50, "Boolean": 45, "Text": 100, "Point": 135, "Vector": 135, "Line": 275,
         "Plane": 550, "Curve": 35, "Surface": 100, "Mesh": 75}  # fmt: skip
"""About how many bytes a value has as text: each corner of a curve, each vertex and face of a mesh."""
LARGEST = 1e12  # a coordinate or number beyond is a slip
INT32 = 2**31 - 1


def read(kind: str, item: Any, where: str) -> Any:
    """One value of a branch. `where` names its input in an InputError."""
    if not isinstance(item, dict) or not isinstance(item.get("data"), str):
        raise InputError(where, "a value has type and data, which is JSON as text")
    return _READERS[kind](parse(item["data"], where), where)


def write(kind: str, values: Iterable[Any]) -> list[dict[str, str]]:
    """Values of one kind as items of a branch."""
    writer = _WRITERS[kind]
    return [{"type": TYPES[kind], "data": writer(value)} for value in values]


def size(kind: str, values: Iterable[Any]) -> int:
    """About how many bytes `write` makes of values."""
    parts = {"Mesh": lambda mesh: len(mesh.vertices) + len(mesh.faces), "Curve": len}.get(kind, lambda value: 1)
    return SIZES[kind] * sum(1 if hasattr(value, "Encode") else parts(value) for value in values)


def _number(value: Any, where: str) -> float:
    if type(value) in (int, float) and abs(value) < LARGEST:
        return float(value)
    raise InputError(where, "a finite number is expected")


def _integer(value: Any, where: str) -> int:
    if type(value) in (int, float) and abs(value) <= INT32 and value == int(value):
        return int(value)
    raise InputError(where, "a whole number is expected")


def _boolean(value: Any, where: str) -> bool:
    if type(value) is bool:
        return value
    raise InputError(where, "true or false is expected")


def _text(value: Any, where: str) -> str:
    if isinstance(value, str):
        return value
    raise InputError(where, "a text is expected")


def _point(value: Any, where: str) -> list[float]:
    if isinstance(value, dict) and {"X", "Y", "Z"} <= set(value):
        return [_number(value[axis], where) for axis in "XYZ"]
    raise InputError(where, "a point or vector with X, Y and Z is expected")


def _plane(value: Any, where: str) -> list[list[float]]:
    if isinstance(value, dict) and {"Origin", "XAxis", "YAxis"} <= set(value):
        return [_point(value[part], where) for part in ("Origin", "XAxis", "YAxis")]
    raise InputError(where, "a plane with Origin, XAxis and YAxis is expected")


def _line(value: Any, where: str) -> Any:
    """The straight pieces of a line, or of a curve made of such."""
    if isinstance(value, dict) and {"From", "To"} <= set(value):
        return [[_point(value["From"], where), _point(value["To"], where)]]
    from hookean.discretize.curves import explode

    return _at(where, lambda: explode(_geometry(value, where)).tolist())


def _curve(value: Any, where: str) -> Any:
    """A rhino3dm curve; the ends of a line."""
    if isinstance(value, dict) and {"From", "To"} <= set(value):
        return [_point(value["From"], where), _point(value["To"], where)]
    return _geometry(value, where)


def _mesh(value: Any, where: str) -> Any:
    from hookean.discretize.meshes import as_mesh

    def made() -> Any:
        found = _geometry(value, where)
        if type(found).__name__ != "Mesh":
            return as_mesh(found)
        rows = [(p.X, p.Y, p.Z) for p in found.Vertices.ToPoint3dArray()]  # items have single precision
        return as_mesh((np.array(rows).reshape(-1, 3), [found.Faces[i] for i in range(len(found.Faces))]))

    return _at(where, made)


def _geometry(value: Any, where: str) -> Any:
    from hookean_server.workers.discretize_task import decode

    if not isinstance(value, dict) or "archive3dm" not in value:
        raise InputError(where, "geometry as Hops sends it is expected")
    return _at(where, lambda: decode(value, where))


def _at(where: str, made: Callable[[], Any]) -> Any:
    """What `made` gives; its InputError is one of the input `where`."""
    try:
        return made()
    except InputError as error:
        raise InputError(where, error.sentence) from None


_READERS: dict[str, Callable[[Any, str], Any]] = {
    "Number": _number,
    "Integer": _integer,
    "Boolean": _boolean,
    "Text": _text,
    "Point": _point,
    "Vector": _point,
    "Line": _line,
    "Plane": _plane,
    "Curve": _curve,
    "Surface": _geometry,
    "Mesh": _mesh,
}


def _plain(value: Any) -> str:
    # the component strips quotes and reads what is left as it stands: no escapes
    return json.dumps(value, allow_nan=False, ensure_ascii=False)


def _xyz(row: Any) -> dict[str, float]:
    x, y, z = np.asarray(row, dtype=np.float64).tolist()
    return {"X": x, "Y": y, "Z": z}


def _written_line(ends: Any) -> str:
    return _plain({"From": _xyz(ends[0]), "To": _xyz(ends[1])})


def _written_plane(axes: Any) -> str:
    origin, x, y = np.asarray(axes, dtype=np.float64)
    parts = {"Origin": origin, "XAxis": x, "YAxis": y, "ZAxis": np.cross(x, y)}
    return _plain({name: _xyz(row) for name, row in parts.items()})


def _written_curve(curve: Any) -> str:
    """A rhino3dm curve, or the corners (n, 3) of a polyline."""
    if not hasattr(curve, "Encode"):
        import rhino3dm

        polyline: Any = rhino3dm.PolylineCurve
        corners = [rhino3dm.Point3d(*row) for row in np.asarray(curve, dtype=np.float64).tolist()]
        curve = polyline(corners)
    return _plain(curve.Encode())


def _written_mesh(mesh: Any) -> str:
    """A rhino3dm mesh, or one with vertices (n, 3) and faces (m, 4) or (m, 3)."""
    return _plain(mesh.Encode() if hasattr(mesh, "Encode") else rhino_mesh(mesh).Encode())


def rhino_mesh(mesh: Mesh) -> Any:
    """A rhino3dm mesh; its vertices keep their doubles."""
    import rhino3dm

    made: Any = rhino3dm.Mesh()
    for x, y, z in mesh.vertices.tolist():
        made.Vertices.AddPoint3d(x, y, z)
    for face in mesh.faces.tolist():
        corners = face[:-1] if len(face) == 4 and face[-1] in (-1, face[-2]) else face
        made.Faces.AddFace(*corners)
    made.Normals.ComputeNormals()
    return made


_WRITERS: dict[str, Callable[[Any], str]] = {
    "Number": lambda value: _plain(float(value)),
    "Integer": lambda value: _plain(int(value)),
    "Boolean": lambda value: _plain(bool(value)),
    "Text": lambda value: _plain(str(value).replace("\\", "/").replace('"', "'").replace("\n", " ")),
    "Point": lambda value: _plain(_xyz(value)),
    "Vector": lambda value: _plain(_xyz(value)),
    "Line": _written_line,
    "Plane": _written_plane,
    "Curve": _written_curve,
    "Surface": lambda value: _plain(value.Encode()),
    "Mesh": _written_mesh,
}
