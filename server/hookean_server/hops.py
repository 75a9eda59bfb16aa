"""Functions for Grasshopper's Hops component: their descriptions, and the task that runs one, in a worker.

Values come as text inside JSON, in branches of data trees; geometry as rhino3dm's `Encode` writes it. Hops keeps
answers for ever, so everything here depends on its inputs alone.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.errors import InputError
from hookean.files.scene_json import parse
from hookean_server.tasks import Cancelled, Clock, Done

Floats = NDArray[np.float64]

MANY = 2147483647
LONGEST = 90.0  # seconds of solving; Hops waits for 100
UNITS = {"Millimeters": "mm", "Centimeters": "cm", "Decimeters": "dm", "Meters": "m", "Kilometers": "km",
         "Inches": "in", "Feet": "ft", "Yards": "yd"}  # fmt: skip
TYPES = {"Number": "System.Double", "Text": "System.String", "Point": "Rhino.Geometry.Point3d",
         "Vector": "Rhino.Geometry.Vector3d", "Line": "Rhino.Geometry.Line", "Mesh": "Rhino.Geometry.Mesh"}  # fmt: skip


@dataclass(frozen=True)
class Parameter:
    """An input or output: `kind` is Grasshopper's name of its type, at least and at most so many values."""

    name: str
    nickname: str
    kind: str
    description: str
    least: int = 1
    most: int = MANY
    default: float | None = None

    def described(self) -> dict[str, Any]:
        """As Hops reads it."""
        found: dict[str, Any] = {"Name": self.name, "Nickname": self.nickname, "Description": self.description,
                                 "ParamType": self.kind, "ResultType": TYPES[self.kind], "AtLeast": self.least,
                                 "AtMost": self.most}  # fmt: skip
        return found if self.default is None else {**found, "Default": self.default}


@dataclass(frozen=True)
class Function:
    """One function: what Hops shows of it, and the code behind."""

    title: str
    nickname: str
    description: str
    inputs: tuple[Parameter, ...]
    outputs: tuple[Parameter, ...]
    run: Callable[[Inputs, Cancelled], tuple[list[list[dict[str, str]]], list[str]]]

    def described(self, name: str) -> dict[str, Any]:
        """The answer to GET /<name>."""
        return {"Uri": f"/{name}", "Name": self.title, "Nickname": self.nickname, "Description": self.description,
                "Category": "Hookean", "Subcategory": "Relax", "Inputs": [p.described() for p in self.inputs],
                "Outputs": [p.described() for p in self.outputs]}  # fmt: skip


def solve(options: dict[str, Any], body: bytes, cancelled: Cancelled) -> Done:
    """The answer to POST /solve. Raises InputError with a sentence a person at the canvas understands."""
    clock = Clock()
    value = parse(body)
    if not isinstance(value, dict) or not isinstance(value.get("values"), list):
        raise InputError("/values", "a request of Hops has a list of values")
    name = str(value.get("pointer")).strip("/")
    if name not in FUNCTIONS:
        known = ", ".join(f"/{one}" for one in FUNCTIONS)
        raise InputError("/pointer", f"there is no such function; there are {known}")
    function = FUNCTIONS[name]
    inputs = Inputs(function, value, min(LONGEST, options["seconds"]))
    clock.lap("decode")
    found, warnings = function.run(inputs, cancelled)
    clock.lap("solve")
    values = [{"ParamName": p.name, "InnerTree": {"{0}": v}} for p, v in zip(function.outputs, found, strict=True)]
    text = json.dumps({"values": values, "errors": [], "warnings": [*inputs.warnings, *warnings]}).encode()
    clock.lap("encode")
    return Done(text, timing=clock.parts)


class Inputs:
    """The values of a request by the names of their inputs: every branch of a tree, in order, is one list."""

    def __init__(self, function: Function, value: dict[str, Any], seconds: float) -> None:
        self.warnings: list[str] = []
        self.seconds = seconds
        units = str(value.get("modelunits") or "Meters")
        self.units = UNITS.get(units, "m")
        if units not in UNITS:
            self.warnings.append("The unit of this model is not known here; its lengths are taken as metres.")
        tolerance: Any = value.get("absolutetolerance")
        self.tolerance = float(tolerance) if type(tolerance) in (int, float) and 0 < tolerance < 1e9 else 0.001
        self._parameters = {p.name: p for p in function.inputs}
        self._given = dict(self._read(i, entry) for i, entry in enumerate(value["values"]))

    def _read(self, index: int, entry: Any) -> tuple[str, list[Any]]:
        where = f"/values/{index}"
        tree = entry.get("InnerTree") if isinstance(entry, dict) else None
        if not isinstance(tree, dict) or not all(isinstance(branch, list) for branch in tree.values()):
            raise InputError(where, "an input has ParamName and InnerTree, whose branches are lists")
        items = [item for branch in tree.values() for item in branch]
        name = str(entry.get("ParamName")).removeprefix("RH_IN:")
        parameter = self._parameters.get(name)
        if parameter is None:
            return name, []  # of an older version of the definition
        return name, [_READERS[parameter.kind](_data(item, where), where, name) for item in items]

    def many(self, name: str) -> list[Any]:
        """The values of an input."""
        found, parameter = self._given.get(name, []), self._parameters[name]
        if len(found) < parameter.least:
            raise InputError(f"/{name}", f"{name} is missing; connect at least one {parameter.kind.lower()}")
        return found

    def one(self, name: str) -> Any:
        """The value of an input that takes one; its default where there is none."""
        found, parameter = self._given.get(name, []), self._parameters[name]
        if not found and parameter.default is not None:
            return parameter.default
        if len(found) != 1:
            raise InputError(f"/{name}", f"{name} takes one {parameter.kind.lower()}; {len(found)} are given")
        return found[0]

    def points(self, name: str) -> Floats:
        """The values of an input of points as rows."""
        return np.array(self.many(name), dtype=np.float64).reshape(-1, 3)


def _data(item: Any, where: str) -> Any:
    if not isinstance(item, dict) or not isinstance(item.get("data"), str):
        raise InputError(where, "a value has type and data, which is JSON as text")
    return parse(item["data"], where)


def _number(value: Any, where: str, name: str) -> float:
    if type(value) in (int, float) and abs(value) < 1e12:
        return float(value)
    raise InputError(where, f"{name}: a finite number is expected")


def _point(value: Any, where: str, name: str) -> list[float]:
    if isinstance(value, dict) and {"X", "Y", "Z"} <= set(value):
        return [_number(value[axis], where, name) for axis in "XYZ"]
    raise InputError(where, f"{name}: a point or vector with X, Y and Z is expected")


def _line(value: Any, where: str, name: str) -> Any:
    """The straight pieces of a line, or of a curve made of such."""
    if isinstance(value, dict) and {"From", "To"} <= set(value):
        return [[_point(value["From"], where, name), _point(value["To"], where, name)]]
    from hookean.discretize.curves import explode

    try:
        return explode(_geometry(value, where, name)).tolist()
    except InputError as error:
        raise InputError(where, f"{name}: {error.sentence}") from None


def _mesh(value: Any, where: str, name: str) -> Any:
    from hookean.discretize.meshes import as_mesh

    try:
        return as_mesh(_geometry(value, where, name))
    except InputError as error:
        raise InputError(where, f"{name}: {error.sentence}") from None


def _geometry(value: Any, where: str, name: str) -> Any:
    from hookean_server.operations import decode

    if not isinstance(value, dict) or "archive3dm" not in value:
        raise InputError(where, f"{name}: geometry as Hops sends it is expected")
    return decode(value, where)


_READERS: dict[str, Callable[[Any, str, str], Any]] = {
    "Number": _number,
    "Point": _point,
    "Vector": _point,
    "Line": _line,
    "Mesh": _mesh,
}


def _items(kind: str, values: Iterable[Any]) -> list[dict[str, str]]:
    return [{"type": TYPES[kind], "data": json.dumps(value)} for value in values]


def _xyz(rows: Any) -> list[dict[str, float]]:
    return [dict(zip("XYZ", row, strict=True)) for row in np.asarray(rows, dtype=np.float64).reshape(-1, 3).tolist()]


def _segments(ends: Floats) -> list[dict[str, Any]]:
    return [{"From": a, "To": b} for a, b in zip(_xyz(ends[:, 0]), _xyz(ends[:, 1]), strict=True)]


def _relax_lines(inputs: Inputs, cancelled: Cancelled) -> tuple[list[list[dict[str, str]]], list[str]]:
    from hookean.discretize.duplicates import unique_points

    lines = np.array([piece for pieces in inputs.many("Lines") for piece in pieces], dtype=np.float64).reshape(-1, 2, 3)
    kept, place = unique_points(lines.reshape(-1, 3), inputs.tolerance)
    springs = {"particles": place.reshape(-1, 2), "name": "lines"}
    result = _relaxed(inputs, lines.reshape(-1, 3)[kept], springs, inputs.points("Anchors"), cancelled)
    found = result.force("lines")
    return [
        _items("Point", _xyz(result.particles)),
        _items("Line", _segments(result.particles[found["particles"]])),
        _items("Number", found["force"].tolist()),
        _items("Vector", _xyz(result.reactions["force"])),
        _items("Text", [str(result.status)]),
    ], _remarks(result)


def _relax_mesh(inputs: Inputs, cancelled: Cancelled) -> tuple[list[list[dict[str, str]]], list[str]]:
    from hookean.discretize.meshes import edges, naked_vertices

    mesh = inputs.one("Mesh")
    anchors = inputs.points("Anchors")
    if not len(anchors):
        anchors = mesh.vertices[naked_vertices(mesh)]
    result = _relaxed(inputs, mesh.vertices, {"particles": edges(mesh), "name": "edges"}, anchors, cancelled)
    found = result.force("edges")
    return [
        _items("Mesh", [_encoded(result.particles, mesh.faces)]),
        _items("Line", _segments(result.particles[found["particles"]])),
        _items("Number", found["force"].tolist()),
        _items("Vector", _xyz(result.reactions["force"])),
        _items("Text", [str(result.status)]),
    ], _remarks(result)


def _relaxed(inputs: Inputs, particles: Floats, springs: Any, anchors: Floats, cancelled: Cancelled) -> Any:
    from hookean.run import relax
    from hookean.scene import Scene

    stiffness, factor = inputs.one("Stiffness"), inputs.one("Rest factor")
    load = inputs.one("Load")
    forces: list[dict[str, Any]] = [
        {"kind": "springs", "stiffness": stiffness, "rest_factor": factor, **springs},
        {"kind": "unary", "particles": np.arange(len(particles)), "vector": load},
    ]
    scene = Scene.model_validate(
        {
            "units": {"length": inputs.units},
            "weld_tolerance": inputs.tolerance,
            "particles": particles,
            "forces": forces,
            "anchors": [{"points": anchors}] if len(anchors) else [],
            "settings": {"time_limit": inputs.seconds},
        }
    )
    return relax(scene, cancelled=cancelled)


def _remarks(result: Any) -> list[str]:
    said = [] if result.converged else [result.message]
    return said + [u.sentence for u in result.report.unmatched][:5] + list(result.report.warnings)[:5]


def _encoded(vertices: Floats, faces: NDArray[np.int64]) -> dict[str, Any]:
    """A mesh as Hops takes it."""
    import rhino3dm

    mesh: Any = rhino3dm.Mesh()
    for x, y, z in vertices.tolist():
        mesh.Vertices.Add(x, y, z)
    for face in faces.tolist():
        corners = face if face[-1] >= 0 else face[:-1]
        mesh.Faces.AddFace(*corners)
    mesh.Normals.ComputeNormals()
    encoded: dict[str, Any] = mesh.Encode()
    return encoded


_ANCHORS = "Where particles are held; each must be the end of a line"
_FORCED = (
    Parameter("Load", "P", "Vector", "Force on every particle [N]", 1, 1),
    Parameter("Stiffness", "k", "Number", "Stiffness of every spring [N/model unit]", 1, 1, 1000.0),
    Parameter("Rest factor", "R", "Number", "Rest length as a part of the drawn length [-]", 1, 1, 1.0),
)
_FOUND = (
    Parameter("Forces", "F", "Number", "Force of every spring [N], tension positive"),
    Parameter("Reactions", "Re", "Vector", "Force of every anchor on its particle [N]"),
    Parameter("Status", "S", "Text", "converged, or how the run ended", 1, 1),
)

FUNCTIONS: dict[str, Function] = {
    "relax": Function(
        "Relax",
        "Relax",
        "Lines become springs and go to equilibrium",
        (
            Parameter("Lines", "L", "Line", "Springs; ends that meet are one particle"),
            Parameter("Anchors", "A", "Point", _ANCHORS),
            *_FORCED,
        ),
        (
            Parameter("Particles", "Pt", "Point", "Particles in equilibrium"),
            Parameter("Springs", "L", "Line", "Springs in equilibrium, in the order of the lines"),
            *_FOUND,
        ),
        _relax_lines,
    ),
    "relax_mesh": Function(
        "Relax mesh",
        "RelaxMesh",
        "The edges of a mesh become springs and go to equilibrium",
        (
            Parameter("Mesh", "M", "Mesh", "The mesh", 1, 1),
            Parameter("Anchors", "A", "Point", "Vertices that are held; none: those at the boundary", 0),
            *_FORCED,
        ),
        (
            Parameter("Mesh", "M", "Mesh", "The mesh in equilibrium", 1, 1),
            Parameter("Edges", "L", "Line", "Springs in equilibrium"),
            *_FOUND,
        ),
        _relax_mesh,
    ),
}
"""Every function by its name; the routes and their guard walk this table."""
