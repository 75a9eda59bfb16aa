"""Schemas that are not pydantic models, and examples; the tests run every example."""

from __future__ import annotations

import json
from typing import Any

from hookean.files.compas_json import ACCEPTED
from hookean.running.result import Status
from hookean_server.workers.discretize_task import OPERATIONS

_NUMBER = {"type": "number"}
_POINT = {"type": "array", "items": _NUMBER, "minItems": 3, "maxItems": 3}
_BUFFER = {"$ref": "#/components/schemas/Buffer"}
_ARRAY: dict[str, Any] = {"anyOf": [{"type": "array"}, _BUFFER]}
_POINTS: dict[str, Any] = {"anyOf": [{"type": "array", "items": _POINT}, _BUFFER]}
_LINES: dict[str, Any] = {
    "anyOf": [{"type": "array", "items": {"type": "array", "items": _POINT, "minItems": 2, "maxItems": 2}}, _BUFFER]
}
_DOCUMENT = {"$ref": "#/components/schemas/CompasDocument"}
_RHINO = {"$ref": "#/components/schemas/RhinoObject"}
_CURVES = {"$ref": "#/components/schemas/NurbsCurve"}
_SURFACES = {"$ref": "#/components/schemas/NurbsSurface"}
_MESH: dict[str, Any] = {"anyOf": [{"$ref": "#/components/schemas/MeshData"}, _DOCUMENT, _RHINO]}


def _object(**properties: Any) -> dict[str, Any]:
    return {"type": "object", "properties": properties, "required": list(properties)}


def _optional(schema: dict[str, Any], **properties: Any) -> dict[str, Any]:
    """An object with further properties that may be left out."""
    return {**schema, "properties": {**schema["properties"], **properties}}


_DEGREE = {"type": "integer", "minimum": 1, "maximum": 25}
_TEXT = {"type": "string"}
_NULL = {"type": "null"}
_SENTENCES = {"type": "array", "items": _TEXT}
_TREES = {"type": "array", "items": _object(ParamName=_TEXT, InnerTree={"type": "object"})}
_AT = _object(particles=_ARRAY, force=_ARRAY)

SCHEMAS: dict[str, dict[str, Any]] = {
    "Buffer": {
        **_object(dtype={"enum": ["<f8", "<i8", "<i4"]}, shape={"type": "array", "items": {"type": "integer"}}),
        "description": "An array as base64 of its little-endian bytes, C order",
    },
    "CompasDocument": {
        **_object(dtype={"type": "string"}, data={}),
        "description": f"A document as COMPAS 2 writes it; supported: {', '.join(ACCEPTED)}",
    },
    "RhinoObject": {
        **_object(version={"type": "integer"}, archive3dm={"type": "integer"}, opennurbs={"type": "integer"}),
        "description": "Geometry as rhino3dm's CommonObject.Encode writes it",
    },
    "NurbsCurve": {
        **_optional(_object(degree=_DEGREE, points=_POINTS, knots=_ARRAY), weights=_ARRAY),
        "description": "A NURBS curve; points + degree + 1 knots, or two less (first and last) as in Rhino",
    },
    "NurbsSurface": {
        **_optional(
            _object(degree_u=_DEGREE, degree_v=_DEGREE, points=_ARRAY, knots_u=_ARRAY, knots_v=_ARRAY), weights=_ARRAY
        ),
        "description": "A NURBS surface; a row of points for each step in the first direction, knots as of curves",
    },
    "Problem": {
        "type": "object",
        "description": "RFC 9457",
        "properties": {
            "type": {"type": "string", "format": "uri-reference"},
            "title": {"type": "string"},
            "status": {"type": "integer"},
            "detail": {"type": "string"},
            "instance": {"type": "string", "format": "uri"},
            "errors": {
                "type": "array",
                "maxItems": 20,
                "items": _object(pointer={"type": "string"}, detail={"type": "string"}),
            },
        },
        "required": ["type", "title", "status", "detail", "instance"],
    },
    "HopsFunction": {
        **_object(Uri=_TEXT, Name=_TEXT, Inputs={"type": "array"}, Outputs={"type": "array"}),
        "description": "A function as Grasshopper's Hops component reads it",
    },
    "HopsRequest": {
        **_object(pointer=_TEXT, values=_TREES),
        "description": "Inputs as Hops sends them; data is JSON as text, geometry as rhino3dm's Encode writes it",
    },
    "HopsAnswer": _object(values=_TREES, errors=_SENTENCES, warnings=_SENTENCES),
    "HopsProblem": {
        **_object(
            type=_TEXT,
            title=_TEXT,
            status={"type": "integer"},
            detail=_TEXT,
            instance=_TEXT,
            values=_TREES,
            errors=_SENTENCES,
            warnings=_SENTENCES,
        ),
        "description": "RFC 9457, with errors as Hops shows them",
    },
    "Health": _object(
        service={"const": "hookean"},
        version={"type": "string"},
        api={"const": "v1"},
        status={"enum": ["starting", "ok", "full", "stopping"]},
        instance={"type": "string"},
        workers={"type": "object"},
        requests={"type": "object"},
        store={"$ref": "#/components/schemas/Store"},
    ),
    "Proof": _object(instance={"type": "string"}, proof={"type": "string", "pattern": "^[0-9a-f]{64}$"}),
    "Guest": _object(token={"type": ["string", "null"], "description": "Of the read-only link; null: none"}),
    "Code": _object(
        code={"type": "string"},
        seconds={"type": "number"},
        frame={
            "type": "string",
            "description": "In /?frame=..., lets pages of this machine frame the studio",
        },
    ),
    "Store": {
        "type": "object",
        "properties": {
            "bytes": {"type": "integer", "description": "Size of sessions and jobs on disk"},
            "quota": {"type": "integer", "description": "Largest size; 0: no limit"},
            "warnings": {"type": "array", "items": _TEXT},
            "losses": {"type": "integer", "description": "Sessions and jobs with losses"},
            "repairs": {
                "type": "array",
                "description": "For clients with the token: each repair whose copy of the damaged files still exists",
                "items": _object(
                    when=_TEXT,
                    why=_TEXT,
                    copy=_TEXT,
                    losses={"type": "array", "items": _object(kind=_TEXT, key=_TEXT, what=_TEXT)},
                ),
            },
        },
        "required": ["bytes", "quota", "warnings", "losses"],
    },
    "Examples": _object(
        examples={
            "type": "array",
            "items": _object(id=_TEXT, figure=_TEXT, title=_TEXT, sentence=_TEXT, picture=_TEXT, scene=_TEXT),
        }
    ),
    "Families": _object(families={"type": "array", "items": {"type": "object"}}),
    "Catalogue": _object(forces={"type": "array", "items": {"type": "object"}}),
    "Result": _object(
        status={"enum": ["converged", "stalled", "diverged", "max_iterations", "time_limit", "cancelled"]},
        message={"type": "string", "description": "One sentence about how the run ended"},
        particles=_POINTS,
        geometry={"type": "array", "items": _object(name={"type": "string"}, kind={"type": "string"})},
        forces={
            "type": "array",
            "description": "Columns of each force of the scene, see GET /v1/forces",
            "items": _object(kind={"type": "string"}, name={"type": "string"}),
        },
        reactions={**_AT, "description": "Forces and moments of anchors and elastic supports on particles"},
        rotations={
            **_object(particles=_ARRAY, quaternions=_ARRAY),
            "description": "Particles at the ends of beams, and the unit quaternions w, x, y, z that turn them",
        },
        contacts={**_AT, "description": "Forces of floors on particles"},
        loads={
            "type": "object",
            "description": "Columns of the loads: force (number), kind, name, resultant [force], centre [length], "
            "moment about it [force length]",
            "additionalProperties": {"type": "array"},
        },
        residual={"type": ["number", "null"]},
        rounding_floor={"type": ["number", "null"]},
        out_of_balance={"type": ["number", "null"]},
        components={
            "type": "object",
            "description": "Columns of the connected components, empty where there is only one",
            "additionalProperties": {"type": "array"},
        },
        stability={"enum": ["stable", "unstable", "mechanism", "unknown"]},
        stability_reason={"type": "string", "description": "Why it is unstable or unknown, or joints that turn freely"},
        soft_particle={"type": ["integer", "null"], "description": "The particle that moves most in the softest mode"},
        soft_modes={
            "type": ["integer", "null"],
            "description": "Number of modes that are unstable or have no stiffness",
        },
        position_error={
            "type": ["number", "null"],
            "description": "The largest movement that one more exact step would make [length]; null if unknown",
        },
        position_reason={"type": "string", "description": "Why the position error is unknown; empty if known"},
        energy={"type": "object", "additionalProperties": {"type": ["number", "null"]}},
        iterations={"type": "integer"},
        time=_NUMBER,
        solver={"type": "string"},
        report=_object(
            merged={"type": "integer"},
            unmatched={"type": "array", "description": "Each point of an anchor or load that met no particle"},
            missed={"type": "array", "description": "Each force and anchor with such points: count, total, message"},
            warnings={"type": "array"},
        ),
        units={"$ref": "#/components/schemas/Units"},
    ),
}
SCHEMAS["Session"] = {
    "type": "object",
    "description": "Status of a session",
    "properties": {
        "key": {"type": "string"},
        "label": {"type": "string"},
        "etag": {"type": "string", "description": "Its ETag: of this creation, revision and shape"},
        "revision": {"type": "integer", "description": "Number of edits"},
        "scene_revision": {"type": "integer", "description": "Revision that last changed more than its anchors"},
        "anchors_revision": {"type": "integer", "description": "Revision that last changed its anchors"},
        "iteration": {"type": "integer"},
        "time": {**_NUMBER, "description": "[time]"},
        "residual": {**_NUMBER, "description": "[-]"},
        "status": {"enum": [str(status) for status in Status]},
        "message": {"type": "string", "description": "One sentence on its status"},
        "particles": {"type": "integer"},
        "playing": {"type": "boolean"},
        "solving": {"type": "boolean", "description": "Whether it plays to rest by the scene's solver"},
        "undo": {"type": "integer", "description": "Edits that can be undone"},
        "redo": {"type": "integer"},
        "awake": {"type": "boolean", "description": "Whether it has a process"},
        "created": _NUMBER,
        "energy": {"type": ["number", "null"], "description": "Of all forces and of motion [force length]"},
        "units": {"$ref": "#/components/schemas/Units"},
        "warnings": {**_SENTENCES, "description": "Notes on the file it was made of, and on the present scene"},
    },
    "required": ["key", "label", "revision", "status", "message", "particles", "playing", "warnings", "awake"],
}
SCHEMAS["Sessions"] = _object(
    sessions={"type": "array", "items": {"$ref": "#/components/schemas/Session"}},
    store={"$ref": "#/components/schemas/Store"},
)
SCHEMAS["View"] = {
    "type": "object",
    "description": "How a session is looked at; not stored",
    "properties": {
        "picked": {
            "anyOf": [_object(kind={"enum": ["particle", "spring"]}, index={"type": "integer", "minimum": 0}), _NULL],
            "description": "What is picked in the page",
        },
        "colours": {
            "anyOf": [
                _optional(
                    _object(
                        title=_TEXT,
                        of={"enum": ["springs", "particles"]},
                        values={"type": "array", "items": _NUMBER, "minItems": 1},
                    ),
                    unit=_TEXT,
                ),
                _NULL,
            ],
            "description": "Numbers that colour the springs",
        },
    },
}
SCHEMAS["Edits"] = _object(
    edits={"type": "array", "items": _object(revision={"type": "integer"}, edit={"type": "object"})}
)
SCHEMAS["Edit"] = {
    "type": "object",
    "description": "A change of a running session, all of it or nothing",
    "properties": {
        "pin": {"type": "array", "items": {"type": "object"}, "description": "Anchors by particles"},
        "release": {"type": "array", "items": {"type": "integer", "minimum": 0}},
        "move": {"type": "array", "items": {"type": "object"}, "description": "Anchors and their targets"},
        "forces": {"type": "object", "description": "By a force's name or number, values of its columns"},
        "materials": {"type": "object", "description": "By a material's name, values of its fields"},
        "sections": {"type": "object", "description": "By a section's name, values of its fields"},
        "settings": {"type": "object"},
        "add": {
            "type": "array",
            "items": {"type": "object"},
            "description": "Forces as in a scene, on existing particles",
        },
        "remove": {
            "type": "array",
            "items": {"type": ["string", "integer"]},
            "description": "Forces by name or number",
        },
        "rebuild": {"type": "object", "description": "Alone: parameters of the family that the model was made from"},
        "draw": {
            "type": "object",
            "description": "Alone: exactly one of `add` (points, faces, forces), `divide` (springs, faces, pieces), "
            "`extrude` (edges, by, mesh) and `delete` (particles, springs, faces); see `Simulation.draw`",
        },
        "units": {"type": "object", "description": "Alone: other units of the same numbers"},
        "gesture": {"type": "string", "maxLength": 80, "description": "Edits of one gesture are undone as one"},
    },
    "additionalProperties": False,
}
SCHEMAS["Buffer"]["properties"]["base64"] = {"type": "string"}
SCHEMAS["Buffer"]["required"].append("base64")
SCHEMAS["RhinoObject"]["properties"]["data"] = {"type": "string"}
SCHEMAS["RhinoObject"]["required"].append("data")

_TAKES: dict[str, dict[str, Any]] = {
    "curve": {"anyOf": [_POINTS["anyOf"][0], _BUFFER, _CURVES, _DOCUMENT, _RHINO]},
    "surface": {"anyOf": [_SURFACES, _RHINO]},
    "mesh": _MESH,
    "meshes": {"type": "array", "items": _MESH, "minItems": 1},
    "points": {"anyOf": [*_POINTS["anyOf"], _DOCUMENT, {"type": "array", "items": _DOCUMENT, "minItems": 1}]},
    "lines": {"anyOf": [*_LINES["anyOf"], _DOCUMENT, {"type": "array", "items": _DOCUMENT, "minItems": 1}]},
}
_GIVES: dict[str, dict[str, Any]] = {
    "points": _POINTS,
    "lines": _LINES,
    "mesh": {"anyOf": _MESH["anyOf"][:2]},
    "length": _NUMBER,
    "neighbours": {"type": "array", "items": _ARRAY},
    "first_points": _POINTS,
    "second_points": _POINTS,
}
_OPTIONS: dict[str, dict[str, Any]] = {
    "count": {"type": "integer", "minimum": 1},
    "whole": {"type": "integer", "minimum": 1, "maximum": 1000},
    "level": {"type": "integer", "minimum": 0, "maximum": 30},
    "indices": _ARRAY,
    "mesh": _MESH,
    "points": _POINTS,
    "number": _NUMBER,
    "numbers": {"anyOf": [_NUMBER, *_ARRAY["anyOf"]]},
    "vectors": {"anyOf": [_POINT, *_POINTS["anyOf"]]},
    "flag": {"type": "boolean"},
}


def operation_schema(name: str) -> tuple[dict[str, Any], dict[str, Any]]:
    """Schemas of the body and the answer of an operation."""
    operation = OPERATIONS[name]
    properties: dict[str, Any] = {operation.takes: _TAKES[operation.takes]}
    for option, (kind, default) in operation.options.items():
        schema = _OPTIONS.get(kind) or {"enum": kind.split()}
        properties[option] = schema if default is None else {**schema, "default": default}
    required = [operation.takes, *(n for n, (_, default) in operation.options.items() if default is None)]
    takes = {"type": "object", "properties": properties, "required": required, "additionalProperties": False}
    return takes, _object(**{given: _GIVES.get(given, _ARRAY) for given in operation.gives})


_CURVE = [[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [3.0, 4.0, 0.0]]
_GRID = {
    "vertices": [[float(i), float(j), 0.0] for i in range(3) for j in range(3)],
    "faces": [[3 * i + j, 3 * i + j + 3, 3 * i + j + 4, 3 * i + j + 1] for i in range(2) for j in range(2)],
}
_SMALL = {
    "curve": _CURVE,
    "mesh": _GRID,
    "meshes": [_GRID, _GRID],
    "points": [[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, 0.0, 0.0]],
    "lines": [[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]], [[1.0, 0.0, 0.0], [0.0, 0.0, 0.0]]],
}
_CROSS = [[[0.0, 0.0, 0.0], end] for end in ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.5])]
_OTHER: dict[str, dict[str, Any]] = {
    "fold_angle": {"end": [[1.0, 0.0, 1.0]], "tip_1": [[0.0, 0.0, 9.0]], "tip_2": [[-3.0, 7.0, 2.0]]},
    "pipes": {"lines": _CROSS, "radius": 0.1},
    "moebius_transformation": {"angle": 0.7},
}
"""Options of which a sample is not like that of others of their kind."""
_CABLE = {
    "particles": [[2.0 * i, 0.0, 0.0] for i in range(6)],
    "forces": [
        {"kind": "springs", "particles": [[i, i + 1] for i in range(5)], "stiffness": 1000.0},
        {"kind": "unary", "particles": list(range(6)), "vector": [0.0, 0.0, -20.0]},
    ],
    "anchors": [{"particles": [0, 5]}],
}
_NET = {
    "meshes": {"net": _GRID},
    "forces": [
        {"kind": "springs", "mesh": "net", "stiffness": 50.0, "rest_factor": 0.8},
        {"kind": "unary", "points": [[1.0, 1.0, 0.0]], "vector": [0.0, 0.0, 5.0]},
    ],
    "anchors": [{"points": [[0.0, 0.0, 0.0], [0.0, 2.0, 0.0], [2.0, 0.0, 0.0], [2.0, 2.0, 0.0]]}],
    "geometry": [{"kind": "mesh", "mesh": "net"}],
}
_ARCH = {
    "particles": [[0.0, 0.0, 0.0], [1.0, 0.0, 0.6], [2.0, 0.0, 0.6], [3.0, 0.0, 0.0]],
    "forces": [
        {
            "kind": "beam",
            "name": "arch",
            "particles": [[0, 1], [1, 2], [2, 3]],
            "normal": [0.0, 0.0, 1.0],
            "E": 210e9,
            "G": 81e9,
            "A": 1.5e-3,
            "Iy": 1.7e-6,
            "Iz": 1.7e-6,
            "J": 3.4e-6,
        },
        {"kind": "unary", "particles": [1], "vector": [0.0, 100.0, -600.0], "moment": [0.0, 50.0, 0.0]},
    ],
    "anchors": [{"particles": [0], "rotations": "xyz"}, {"particles": [3], "rotations": "x"}],
}


def _tree(kind: str, *values: Any) -> dict[str, Any]:
    return {"{0}": [{"type": kind, "data": json.dumps(value)} for value in values]}


def _xyz(x: float, z: float = 0.0) -> dict[str, float]:
    return {"X": x, "Y": 0.0, "Z": z}


_HOPS = {
    "pointer": "relax",
    "absolutetolerance": 0.001,
    "modelunits": "Meters",
    "values": [
        {
            "ParamName": "Lines",
            "InnerTree": _tree(
                "Rhino.Geometry.Line", *({"From": _xyz(i), "To": _xyz(i + 1.0)} for i in (0.0, 1.0, 2.0))
            ),
        },
        {"ParamName": "Anchors", "InnerTree": _tree("Rhino.Geometry.Point3d", _xyz(0.0), _xyz(3.0))},
        {"ParamName": "Load", "InnerTree": _tree("Rhino.Geometry.Vector3d", _xyz(0.0, -9.0))},
    ],
}
EXAMPLES: dict[str, dict[str, Any]] = {
    "relax": {"hanging cable": _CABLE, "pulled net": _NET, "arch of beams": _ARCH},
    "hops": {"hanging cable": _HOPS},
    "discretize": {
        name: {
            o.takes: _SMALL[o.takes],
            **{option: _SMALL.get(kind, 4) for option, (kind, default) in o.options.items() if default is None},
            **_OTHER.get(name, {}),
        }
        for name, o in OPERATIONS.items()
        if o.takes in _SMALL
    },
}
