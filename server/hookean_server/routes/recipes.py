"""Recipes: a draft of one for a file, by what is on its layers, or under the names of its objects."""

from __future__ import annotations

from typing import Any

from fastapi import APIRouter, Request
from starlette.responses import Response

from hookean_server.http.handling import compute_upload
from hookean_server.http.openapi import problems
from hookean_server.http.schemas import SCHEMAS

router = APIRouter(tags=["relax"])

_TEXT = {"type": "string"}
_TEXTS = {"type": "array", "items": _TEXT}
_VALUES = {"type": "object", "description": "By the names of the fields of the role, in the units of the recipe"}
_OBJECT = {
    "type": "object",
    "properties": {
        "id": _TEXT,
        "name": _TEXT,
        "kind": {**_TEXT, "description": "Its class, such as LineCurve"},
        "role": {"type": ["string", "null"], "description": "Its own role; null: that of its row"},
        "values": _VALUES,
        "why": {**_TEXT, "description": "Why it is left out"},
    },
    "required": ["id", "name", "kind", "role", "values"],
}
_ROW = {
    "type": "object",
    "description": "The objects of one family on one layer",
    "properties": {
        "layer": {**_TEXT, "description": "Full path, such as roof::cables; empty: no layer"},
        "family": {"enum": ["points", "curves", "surfaces", ""]},
        "kinds": {**_TEXT, "description": "How many objects of each class"},
        "roles": {**_TEXTS, "description": "The roles that they may have"},
        "role": _TEXT,
        "values": _VALUES,
        "becomes": {**_TEXTS, "description": "What the recipe makes of them, such as 20 springs"},
        "objects": {"type": "array", "items": _OBJECT},
    },
    "required": ["layer", "family", "kinds", "roles", "role", "values", "becomes", "objects"],
}
_ROLE = {
    "type": "object",
    "properties": {
        "role": _TEXT,
        "family": _TEXT,
        "summary": _TEXT,
        "fields": {"type": "array", "items": {"type": "object"}},
    },
    "required": ["role", "family", "summary", "fields"],
}
SCHEMAS["RecipeDraft"] = {
    "type": "object",
    "description": "What is on the layers of a file, a role for each, and the recipe of these roles",
    "properties": {
        "name": _TEXT,
        "unit": {**_TEXT, "description": "Unit of length of the file"},
        "said": {**_TEXT, "description": "A sentence on the unit of the file"},
        "size": {**_TEXT, "description": "Size of what forces act on, in the unit of the file"},
        "units": {"$ref": "#/components/schemas/Units"},
        "weld_tolerance": {"type": "number"},
        "rows": {"type": "array", "items": _ROW},
        "roles": {"type": "array", "items": _ROLE},
        "recipe": {"type": "object", "description": "For the part `recipe` of other forms"},
        "fault": {**_TEXT, "description": "Why the recipe cannot be solved; empty if it can"},
        "notes": _TEXTS,
        "particles": {"type": "integer"},
        "held": {"type": "integer", "description": "Number of held particles"},
    },
    "required": ["name", "units", "rows", "roles", "recipe", "fault", "notes", "particles", "held"],
}
_CHOICES = (
    "JSON with any of `rows` (each with `layer`, `family`, `role` and `values`), `objects` (each with `id`, `role` and "
    "`values`), `units` of the recipe, `values_in` (units of the values; default: `units`) and `weld_tolerance`"
)
_FORM: dict[str, Any] = {
    "type": "object",
    "properties": {
        "file": {
            "type": "string",
            "format": "binary",
            "description": "The file: .3dm, .obj, or .json with COMPAS documents",
        },
        "choices": {**_TEXT, "description": _CHOICES},
    },
    "required": ["file"],
}
_SUCCESS = {"application/json": {"schema": {"$ref": "#/components/schemas/RecipeDraft"}}}
_TAKES = {"requestBody": {"required": True, "content": {"multipart/form-data": {"schema": _FORM}}}}


@router.post(
    "/v1/recipes/3dm",
    summary="Draft a recipe for a .3dm file",
    responses=problems(_SUCCESS, computed=True),
    openapi_extra=_TAKES,
)
async def recipe(request: Request) -> Response:
    """The layers and objects of the file, each with a role by guess or by the part `choices`, what these become, and
    the recipe for `POST /v1/sessions` and `POST /v1/relax/3dm`. A recipe that cannot be solved is answered with its
    `fault`."""
    return await compute_upload(request, "recipe", {})


@router.post(
    "/v1/recipes",
    summary="Draft a recipe for a file",
    responses=problems(_SUCCESS, computed=True),
    openapi_extra=_TAKES,
)
async def recipe_of_any(request: Request) -> Response:
    """As `POST /v1/recipes/3dm`, also for .obj files, by their objects and groups, and for .json files with COMPAS
    documents, by their names. A file that holds a whole model has no rows."""
    return await compute_upload(request, "recipe", {"any": True})
