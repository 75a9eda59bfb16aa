"""The description of the API: schemas from the scene's models, problems for every operation, examples that run."""

from __future__ import annotations

import json
from typing import Any

from fastapi import FastAPI
from fastapi.openapi.utils import get_openapi

import hookean
from hookean_server.http import claimed
from hookean_server.http.access import Access
from hookean_server.http.analysis_schemas import (
    ANALYSIS_EXAMPLES,
    CASES_EXAMPLE,
    EXPORT_EXAMPLE,
    REPORT_EXAMPLE,
    analysis_schema,
    cases_schema,
    export_schema,
    report_schema,
)
from hookean_server.http.design_schemas import SLOPES, design_schemas
from hookean_server.http.schemas import EXAMPLES, SCHEMAS, operation_schema
from hookean_server.http.tokens import cookie_name
from hookean_server.problems import CATALOGUE, MEDIA_TYPE
from hookean_server.workers.paper_tasks import MEDIA

HEALTH = {"application/json": {"schema": {"$ref": "#/components/schemas/Health"}}}
PROOF = {"application/json": {"schema": {"$ref": "#/components/schemas/Proof"}}}
SESSION = {"application/json": {"schema": {"$ref": "#/components/schemas/Session"}}}
SESSIONS = {"application/json": {"schema": {"$ref": "#/components/schemas/Sessions"}}}
FORCES = {"application/json": {"schema": {"$ref": "#/components/schemas/Catalogue"}}}
FAMILIES = {"application/json": {"schema": {"$ref": "#/components/schemas/Families"}}}
GALLERY = {"application/json": {"schema": {"$ref": "#/components/schemas/Examples"}}}
PICTURE = {"image/png": {"schema": {"type": "string", "format": "binary"}}}
METRICS = {"text/plain": {"schema": {"type": "string"}}}
_ALWAYS = (401, 403, 404, 405, 431, 500)
_COMPUTED = (*_ALWAYS, 408, 413, 415, 422, 503, 504, 507)
_LIVE = (*_COMPUTED, 409, 412, 429)
MADE = {
    ("/v1/sessions/{key}", "$response.body#/key"): (
        ("/v1/sessions", "post"),
        ("/v1/sessions/{key}", "put"),
        ("/v1/sessions/{key}/branches", "post"),
    ),
    ("/v1/jobs/{job}", "$response.body#/id"): (("/v1/jobs", "post"), ("/v1/design", "post")),
}
"""By the address of what is made, and where its name is in the answer: the operations that make it."""


def problems(
    success: dict[str, Any] | None = None,
    *codes: int,
    computed: bool = False,
    live: bool = False,
    open_to_all: bool = False,
    asked: bool = False,
    headers: dict[str, Any] | None = None,
) -> dict[int | str, dict[str, Any]]:
    """`responses` of an operation: its success, with `headers`, and every problem it can give; `asked`: of parameters
    that may be faulty, too."""
    found: dict[int | str, dict[str, Any]] = {}
    if success is not None:
        found[200] = {"description": "Done", "content": success, **({"headers": headers} if headers else {})}
    for code in codes:
        found[code] = {"description": "As before"} if code == 304 else {"description": "Done", "content": success or {}}
    content = {MEDIA_TYPE: {"schema": {"$ref": "#/components/schemas/Problem"}}}
    for status in _LIVE if live else _COMPUTED if computed else (*_ALWAYS, 422) if asked else _ALWAYS:
        if status == 401 and open_to_all:
            continue
        titles = [f"{title} (`{slug}`)" for slug, (code, title, _) in CATALOGUE.items() if code == status]
        found[status] = {"description": "; ".join(titles), "content": content}
        if status == 412:
            found[status]["headers"] = {"etag": {"description": "The current revision", "schema": {"type": "string"}}}
    return found


def _takes(schema: dict[str, Any], examples: dict[str, Any], kind: str = "application/json") -> dict[str, Any]:
    named = {name: {"value": value} for name, value in examples.items()}
    content = {"schema": schema, **({"examples": named} if named else {})}
    return {"requestBody": {"required": True, "content": {kind: content}}}


def _form(file: str) -> dict[str, Any]:
    return {
        "type": "object",
        "properties": {
            "file": {"type": "string", "format": "binary", "description": file},
            "recipe": {
                "type": "string",
                "description": "Recipe for a .3dm file, as TOML or JSON text; default: read as drawn",
            },
        },
        "required": ["file"],
    }


def relax() -> dict[str, Any]:
    """Description of the route `/v1/relax`."""
    success = {"application/json": {"schema": {"$ref": "#/components/schemas/Result"}}}
    scene = {"$ref": "#/components/schemas/Scene"}
    found = problems(success, computed=True, headers=claimed.described())
    return {"responses": found, "openapi_extra": _takes(scene, EXAMPLES["relax"])}


def example_scene() -> dict[str, Any]:
    """Description of the route of an example's scene."""
    success = {"application/json": {"schema": {"$ref": "#/components/schemas/Scene"}}}
    found = problems(success)
    return {"responses": {**found, **{code: problems(computed=True)[code] for code in (503, 504)}}}


def family(parameters: dict[str, Any]) -> dict[str, Any]:
    """Description of the route of a family's scene, from the schema of its parameters."""
    success = {"application/json": {"schema": {"$ref": "#/components/schemas/Scene"}}}
    body = {
        "type": "object",
        "properties": {
            "units": {"$ref": "#/components/schemas/Units"},
            "parameters": {"type": "object", "properties": parameters, "additionalProperties": False},
        },
        "additionalProperties": False,
    }
    examples = {"all parameters at their defaults": {"units": {"length": "m", "force": "kN"}}}
    return {"responses": problems(success, computed=True), "openapi_extra": _takes(body, examples)}


def relax_file() -> dict[str, Any]:
    """Description of the route `/v1/relax/3dm`."""
    success = {
        "model/vnd.3dm": {"schema": {"type": "string", "format": "binary"}},
        "application/json": {"schema": {"type": "object"}},
    }
    return {
        "responses": problems(success, computed=True, headers=claimed.described()),
        "openapi_extra": _takes(_form("The .3dm file"), {}, "multipart/form-data"),
    }


def discretize(name: str) -> dict[str, Any]:
    """Description of the route of one operation."""
    takes, gives = operation_schema(name)
    success = {"application/json": {"schema": gives}}
    return {
        "responses": problems(success, computed=True),
        "openapi_extra": _takes(
            takes, {"small": EXAMPLES["discretize"][name]} if name in EXAMPLES["discretize"] else {}
        ),
        "operation_id": f"discretize_{name}",
    }


def analysis(name: str) -> dict[str, Any]:
    """Description of the route of one analysis."""
    takes, gives = analysis_schema(name)
    examples = {"small": ANALYSIS_EXAMPLES[name]}
    return {
        "responses": problems({"application/json": {"schema": gives}}, computed=True),
        "openapi_extra": _takes(takes, examples),
        "operation_id": f"analysis_{name.replace('-', '_')}",
    }


def load_cases() -> dict[str, Any]:
    """Description of the route of load cases."""
    takes, gives = cases_schema()
    return {
        "responses": problems({"application/json": {"schema": gives}}, computed=True),
        "openapi_extra": _takes(takes, {"small": CASES_EXAMPLE}),
    }


def report() -> dict[str, Any]:
    """Description of the route of reports."""
    success = {"text/html": {"schema": {"type": "string"}}}
    extra = _takes(report_schema(), {"small": REPORT_EXAMPLE})
    return {"responses": problems(success, computed=True), "openapi_extra": extra}


def export() -> dict[str, Any]:
    """Description of the route of files for other programs."""
    binary = {"schema": {"type": "string", "format": "binary"}}
    success = dict.fromkeys((*MEDIA.values(), "application/octet-stream"), binary)
    extra = _takes(export_schema(), {"small": EXPORT_EXAMPLE})
    return {"responses": problems(success, computed=True), "openapi_extra": extra}


def sensitivity() -> dict[str, Any]:
    """Description of the route of derivatives."""
    success = {"application/json": {"schema": {"$ref": "#/components/schemas/Sensitivity"}}}
    takes = {"$ref": "#/components/schemas/SensitivityRequest"}
    return {"responses": problems(success, computed=True), "openapi_extra": _takes(takes, {"small": SLOPES})}


def session_body(*codes: int) -> dict[str, Any]:
    """Description of the routes that make a session of a scene or a file."""
    found = problems(None, live=True)
    found.update({code: {"description": "The session", "content": SESSION} for code in codes})
    extra = _takes({"$ref": "#/components/schemas/Scene"}, EXAMPLES["relax"])
    form = _form("A .3dm or .obj file, or a .json file with a scene or COMPAS documents")
    extra["requestBody"]["content"]["multipart/form-data"] = {"schema": form}
    return {"responses": found, "openapi_extra": extra}


def edit() -> dict[str, Any]:
    """Description of the route of edits."""
    examples = {
        "a load": {"forces": {"1": {"vector": [0.0, 0.0, -5.0]}}},
        "a pin": {"pin": [{"particles": [2]}]},
        "another load": {"add": [{"kind": "unary", "name": "snow", "particles": [2], "vector": [0.0, 0.0, -9.0]}]},
    }
    extra = _takes({"$ref": "#/components/schemas/Edit"}, examples)
    return {"responses": problems(SESSION, live=True), "openapi_extra": extra}


def looked() -> dict[int | str, dict[str, Any]]:
    """Responses of how a session is looked at."""
    return problems({"application/json": {"schema": {"$ref": "#/components/schemas/View"}}}, live=True)


def guest(*codes: int) -> dict[int | str, dict[str, Any]]:
    """Responses of the read-only link of a session; with `codes` it is not returned."""
    success = {"application/json": {"schema": {"$ref": "#/components/schemas/Guest"}}}
    return problems(None if codes else success, asked=True)


def look() -> dict[str, Any]:
    """Description of the route that changes how a session is looked at."""
    colours = {"title": "Utilisation", "unit": "-", "of": "springs", "values": [0.2, 0.9, 0.4, 0.3, 0.5]}
    examples = {"a pick": {"picked": {"kind": "particle", "index": 2}}, "colours": {"colours": colours}}
    extra = _takes({"$ref": "#/components/schemas/View"}, examples)
    return {"responses": looked(), "openapi_extra": extra}


def edits() -> dict[int | str, dict[str, Any]]:
    """Responses of the edits of a session."""
    return problems({"application/json": {"schema": {"$ref": "#/components/schemas/Edits"}}}, live=True)


def acted() -> dict[int | str, dict[str, Any]]:
    """Responses of commands to a session."""
    return problems(SESSION, live=True)


def forgotten() -> dict[int | str, dict[str, Any]]:
    """Responses of taking something back that is stored."""
    return {**problems(), 507: problems(live=True)[507]}


def branched() -> dict[str, Any]:
    """Description of the route of branches."""
    return {"responses": {**problems(None, live=True), 201: {"description": "The branch", "content": SESSION}}}


def renamed() -> dict[str, Any]:
    """Description of the route of names."""
    return {"responses": problems(SESSION, live=True)}


def exported(*codes: int) -> dict[int | str, dict[str, Any]]:
    """Responses of what is taken out of a session."""
    files = ("application/octet-stream", "model/vnd.3dm", "model/obj", "text/csv")
    content = {"application/json": {"schema": {"type": "object"}}, **{kind: {} for kind in files}}
    return problems(content, *codes, live=True)


def shutdown() -> dict[str, Any]:
    """Description of the route `/v1/shutdown`."""
    success = {"schema": {"type": "object", "properties": {"status": {"const": "stopping"}}, "required": ["status"]}}
    told = {202: {"description": "The service stops", "content": {"application/json": success}}}
    return {"responses": {**problems(None, computed=True), **told}}


def code() -> dict[str, Any]:
    """Description of the route of codes."""
    success = {"application/json": {"schema": {"$ref": "#/components/schemas/Code"}}}
    return {"responses": {**problems(), 201: {"description": "The code", "content": success}}}


def hops_list() -> dict[str, Any]:
    """Description of GET /."""
    listed = {"type": "array", "items": {"$ref": "#/components/schemas/HopsFunction"}}
    page = {"schema": {"type": "string"}}
    return {"responses": problems({"application/json": {"schema": listed}, "text/html": page}, open_to_all=True)}


def hops_description() -> dict[str, Any]:
    """Description of GET /<name>."""
    success = {"application/json": {"schema": {"$ref": "#/components/schemas/HopsFunction"}}}
    found = _for_hops(problems(success, open_to_all=True))
    either = {"anyOf": [{"$ref": f"#/components/schemas/{name}"} for name in ("HopsProblem", "Problem")]}
    found[404] = {**found[404], "content": {MEDIA_TYPE: {"schema": either}}}  # a name with a slash is none
    return {"responses": found}


def hops_solve() -> dict[str, Any]:
    """Description of POST /solve: its problems have the sentences that Hops shows."""
    success = {"application/json": {"schema": {"$ref": "#/components/schemas/HopsAnswer"}}}
    found = _for_hops(problems(success, computed=True, open_to_all=True))
    return {"responses": found, "openapi_extra": _takes({"$ref": "#/components/schemas/HopsRequest"}, EXAMPLES["hops"])}


def _for_hops(found: dict[int | str, dict[str, Any]]) -> dict[int | str, dict[str, Any]]:
    """Responses whose problems are as Hops reads them."""
    problem = {MEDIA_TYPE: {"schema": {"$ref": "#/components/schemas/HopsProblem"}}}
    return {
        status: response if status == 200 else {**response, "content": problem} for status, response in found.items()
    }


def install(app: FastAPI) -> None:
    """Give the app its description, made when first asked for."""

    def build() -> dict[str, Any]:
        if app.openapi_schema is None:
            app.openapi_schema = _build(app)
        return app.openapi_schema

    app.openapi = build  # type: ignore[method-assign]


def _build(app: FastAPI) -> dict[str, Any]:
    from hookean.scene.catalogue import schema

    document = get_openapi(
        title="hookean",
        version=hookean.__version__,
        summary="Particle-spring form finding on this machine",
        description="Bodies are JSON unless stated otherwise; every failure is a problem document (RFC 9457).",
        routes=app.routes,
    )
    _secure(app, document)
    _link(document["paths"])
    scene = json.loads(json.dumps(schema()).replace("#/$defs/", "#/components/schemas/"))
    schemas = scene.pop("$defs")
    schemas["Scene"] = scene
    _accept_documents(schemas)
    for path in document["paths"].values():
        for operation in path.values():
            if "HTTPValidationError" in str(operation["responses"].get("422")):
                del operation["responses"]["422"]
    found = document.setdefault("components", {}).setdefault("schemas", {})
    found.clear()  # the framework's own forms of validation errors are not ours
    found.update(sorted({**schemas, **SCHEMAS, **design_schemas()}.items()))
    return document


def _secure(app: FastAPI, document: dict[str, Any]) -> None:
    """Add to every operation the clients that may call it, as the guard has them."""
    table, settings = app.state.table, app.state.settings
    document.setdefault("components", {})["securitySchemes"] = {
        "token": {
            "type": "http",
            "scheme": "bearer",
            "description": "The token that `hookean token` prints; it changes with each start of the service",
        },
        "code": {
            "type": "http",
            "scheme": "bearer",
            "description": "A code of POST /v1/login/codes, valid for one log-in within a minute",
        },
        "link": {
            "type": "http",
            "scheme": "bearer",
            "description": "The token of PUT /v1/sessions/{key}/guest, for this session alone",
        },
        "cookie": {
            "type": "apiKey",
            "in": "cookie",
            "name": cookie_name(settings.port),
            "description": "From POST /v1/login, for the service's own page; its name contains the service's port",
        },
    }
    by: dict[Access, list[dict[str, list[str]]]] = {
        Access.TOKEN: [{"token": []}, {"cookie": []}],
        Access.PROGRAM: [{"token": []}],
        Access.CODE: [{"token": []}, {"code": []}],
        Access.OPEN: [],
        Access.HOPS: [],
    }
    for path, item in document["paths"].items():
        for method, operation in item.items():
            link: list[dict[str, list[str]]] = [{"link": []}] * table.declared_reading(method.upper(), path)
            operation["security"] = by[table.declared(method.upper(), path)] + link


def _link(paths: dict[str, Any]) -> None:
    """Add to every answer that made something the operations on it, as links (OpenAPI 3.1.1, section 4.8.20)."""
    for (address, name), makers in MADE.items():
        parameter = address[address.index("{") + 1 : -1]
        links = {
            operation["operationId"]: {
                "operationId": operation["operationId"],
                "parameters": {f"path.{parameter}": name},
                "description": operation["summary"],
            }
            for path, item in paths.items()
            if path.startswith(address)
            for operation in item.values()
        }
        for path, method in makers:
            for status, response in paths[path][method]["responses"].items():
                if status.startswith("2"):
                    response["links"] = links


def _accept_documents(schemas: dict[str, Any]) -> None:
    """Where a scene takes COMPAS documents: meshes, carried geometry, lines and coordinates."""
    document = {"$ref": "#/components/schemas/CompasDocument"}
    meshes = schemas["Scene"]["properties"]["meshes"]
    meshes["additionalProperties"] = {"anyOf": [meshes["additionalProperties"], document]}
    geometry = schemas["Scene"]["properties"]["geometry"]
    geometry["items"] = {"anyOf": [geometry["items"], document]}
    for schema in schemas.values():
        for name, field in schema.get("properties", {}).items():
            if name in ("lines", "points", "targets", "velocities", "vector") and "anyOf" in field:
                field["anyOf"] = [*field["anyOf"], document, {"type": "array", "items": document, "minItems": 1}]
