"""The description of jobs in the API."""

from __future__ import annotations

from typing import Any

from hookean.running.sweep import Sweep
from hookean_server.http.openapi import problems
from hookean_server.http.schemas import EXAMPLES, SCHEMAS

STATUSES = ["waiting", "running", "cancelling", "done", "failed", "cancelled"]
_NUMBER = {"type": "number"}
_COUNT = {"type": "integer", "minimum": 0}
_TEXT = {"type": "string"}
_PROGRESS = {
    "type": "object",
    "properties": {"iteration": _COUNT, "residual": _NUMBER, "time": _NUMBER},
    "required": ["iteration", "residual", "time"],
}
_SEARCHED = {
    "type": "object",
    "properties": {
        "iteration": {**_COUNT, "description": "Equilibria so far"},
        "objective": {**_NUMBER, "description": "The least so far"},
    },
    "required": ["iteration", "objective"],
}
_JOB = {
    "id": _TEXT,
    "kind": {"enum": ["relaxation", "sweep", "design"]},
    "status": {"enum": STATUSES},
    "message": {"type": "string", "description": "One sentence on its status"},
    "total": {"type": "integer", "minimum": 1, "description": "Items"},
    "done": {"type": "integer", "minimum": 0, "description": "Items that are solved"},
    "failed": {"type": "integer", "minimum": 0, "description": "Items that could not be solved"},
    "created": {"type": "number", "description": "Time of the request [s since 1970]"},
}
_ROW: dict[str, Any] = {
    "type": "object",
    "description": "The figures of one item, in the scene's units; `failed` ones have only a message",
    "properties": {
        "number": {"type": "integer", "minimum": 0, "description": "Place in the sweep"},
        "parameters": {"type": "object", "description": "Its values, such as net.rest_factor"},
        "objective": {"type": ["number", "null"], "description": "Of a design"},
        "status": _TEXT,
        "message": _TEXT,
        "iterations": _COUNT,
        "residual": {"type": ["number", "null"]},
        "energy": {"type": ["number", "null"]},
        "displacement": {"type": ["number", "null"], "description": "Largest of any particle"},
        "reaction": {"type": ["number", "null"], "description": "Largest of any anchor"},
        "forces": {
            "type": "object",
            "description": "By force: its smallest and largest, tension +",
            "additionalProperties": {"type": "array", "minItems": 2, "maxItems": 2},
        },
    },
    "required": ["number", "parameters", "status", "message"],
}
SCHEMAS["Job"] = {
    "type": "object",
    "properties": {**_JOB, "progress": {"anyOf": [_PROGRESS, _SEARCHED, {"type": "null"}]}},
    "required": list(_JOB),
}
SCHEMAS["Jobs"] = {
    "type": "object",
    "properties": {"jobs": {"type": "array", "items": {"$ref": "#/components/schemas/Job"}}},
    "required": ["jobs"],
}
SCHEMAS["JobRow"] = _ROW
SCHEMAS["JobTable"] = {
    "type": "object",
    "properties": {
        **SCHEMAS["Job"]["properties"],
        "parameters": {"type": "array", "items": _TEXT},
        "warnings": {
            "type": "array",
            "items": _TEXT,
            "description": "Warnings on the scene, such as points that met no particle",
        },
        "columns": {
            "type": "array",
            "items": {"type": "object", "properties": {"name": _TEXT, "unit": _TEXT}, "required": ["name", "unit"]},
        },
        "rows": {"type": "array", "items": {"$ref": "#/components/schemas/JobRow"}},
    },
    "required": [*_JOB, "parameters", "warnings", "columns", "rows"],
}
SCHEMAS["JobEvent"] = {
    "type": "object",
    "description": "Each event",
    "properties": {
        "id": {"type": "string", "description": "Its number, for Last-Event-ID"},
        "event": {"enum": ["progress", "item", "done", "failed", "cancelled"]},
        "data": {
            "type": "string",
            "contentMediaType": "application/json",
            "contentSchema": {
                "anyOf": [
                    _PROGRESS,
                    _SEARCHED,
                    *({"$ref": f"#/components/schemas/{name}"} for name in ("JobRow", "Job")),
                ]
            },
        },
    },
    "required": ["id", "event", "data"],
}
SCHEMAS["Sweep"] = {**Sweep.model_json_schema(), "description": Sweep.__doc__}
SCHEMAS["JobRequest"] = {
    "type": "object",
    "properties": {
        "scene": {"$ref": "#/components/schemas/Scene"},
        "sweep": {"anyOf": [{"$ref": "#/components/schemas/Sweep"}, {"type": "null"}]},
        "design": {"anyOf": [{"$ref": "#/components/schemas/Design"}, {"type": "null"}]},
    },
    "required": ["scene"],
    "additionalProperties": False,
    "examples": [
        {
            "scene": EXAMPLES["relax"]["hanging cable"],
            "sweep": {"forces": {"0": {"stiffness": [900.0, 1000.0]}, "1": {"vector": [[0.0, 0.0, -20.0]]}}},
        },
        {"scene": EXAMPLES["relax"]["pulled net"]},
    ],
}


def _json(name: str) -> dict[str, Any]:
    return {"application/json": {"schema": {"$ref": f"#/components/schemas/{name}"}}}


def created() -> dict[str, Any]:
    """Description of the route that creates jobs."""
    return _created("JobRequest")


def designed() -> dict[str, Any]:
    """Description of the route that creates jobs of design."""
    return _created("DesignProblem")


def _created(request: str) -> dict[str, Any]:
    headers = {
        "Location": {"description": "Address of the job", "schema": _TEXT},
        "Idempotency-Replayed": {
            "description": "`true` if this request was answered before",
            "schema": {"const": "true"},
        },
    }
    accepted = {202: {"description": "It is stored and will run", "content": _json("Job"), "headers": headers}}
    body = {"requestBody": {"required": True, "content": _json(request)}}
    return {"responses": {**problems(None, live=True), **accepted}, "openapi_extra": body}


def told(name: str) -> dict[int | str, dict[str, Any]]:
    """Responses that are JSON."""
    return problems(_json(name), live=True)


def cancelled() -> dict[int | str, dict[str, Any]]:
    """Responses of the end of a job."""
    return {**problems(None, live=True), 204: {"description": "It is ending, or has ended"}}


def streamed() -> dict[int | str, dict[str, Any]]:
    """Responses of the events of a job."""
    found = problems({"text/event-stream": _json("JobEvent")["application/json"]}, live=True)
    return {**found, 204: {"description": "All events have been sent"}}


def table() -> dict[int | str, dict[str, Any]]:
    """Responses of the results of a job."""
    return problems({**_json("JobTable"), "text/csv": {"schema": _TEXT}}, live=True)


def item() -> dict[int | str, dict[str, Any]]:
    """Responses of one item: a result, or the row of one that failed."""
    return problems({"application/json": {"schema": {"type": "object"}}}, live=True)
