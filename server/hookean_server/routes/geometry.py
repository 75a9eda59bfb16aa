"""The geometry in a .3dm file, for programs that cannot read such files."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from fastapi import APIRouter, Query, Request
from starlette.responses import Response

from hookean_server.http.handling import compute_upload
from hookean_server.http.openapi import problems
from hookean_server.http.schemas import SCHEMAS
from hookean_server.problems import Problem

router = APIRouter(tags=["geometry"])

KINDS = ["point", "points", "line", "polyline", "curve", "surface", "brep", "mesh"]
_TEXT = {"type": "string"}
_OBJECT: dict[str, Any] = {
    "type": "object",
    "description": "Points, the NURBS form of a curve or surface, or vertices and faces; lengths in the file's unit",
    "properties": {
        "id": _TEXT,
        "name": _TEXT,
        "layer": {**_TEXT, "description": "Full path, such as roof::cables"},
        "visible": {"type": "boolean"},
        "kind": {"enum": KINDS},
        "mesh": {"$ref": "#/components/schemas/MeshData"},
        "fault": {**_TEXT, "description": "Why a surface has no mesh"},
    },
    "required": ["id", "name", "layer", "visible", "kind"],
}
SCHEMAS["FileGeometry"] = {
    "type": "object",
    "description": "The geometry in a .3dm file",
    "properties": {
        "name": _TEXT,
        "unit": {**_TEXT, "description": "Rhino's name of the unit, such as Millimeters"},
        "metres": {"type": ["number", "null"], "description": "One unit in metres"},
        "tolerance": {"type": "number", "description": "Of the file, in its unit"},
        "layers": {"type": "array", "items": {"type": "object"}},
        "objects": {"type": "array", "items": _OBJECT},
        "warnings": {"type": "array", "items": _TEXT},
    },
    "required": ["unit", "metres", "tolerance", "layers", "objects", "warnings"],
}
_FORM = {
    "type": "object",
    "properties": {"file": {"type": "string", "format": "binary", "description": "The .3dm file"}},
    "required": ["file"],
}
_SUCCESS = {"application/json": {"schema": {"$ref": "#/components/schemas/FileGeometry"}}}
_TAKES = {"requestBody": {"required": True, "content": {"multipart/form-data": {"schema": _FORM}}}}
Divisions = Annotated[int | None, Query(ge=1, le=2000, description="Faces of a surface's mesh in this direction")]


@router.post(
    "/v1/geometry/3dm",
    summary="The geometry in a .3dm file",
    responses=problems(_SUCCESS, computed=True),
    openapi_extra=_TAKES,
)
async def geometry(
    request: Request,
    u: Divisions = None,
    v: Divisions = None,
    arrays: Annotated[Literal["list", "buffer"], Query(description="Arrays as lists or as base64")] = "list",
) -> Response:
    """Every object in the order of the file, by layer and name: points, lines, polylines, curves and surfaces as NURBS,
    meshes. Blocks are expanded, objects added by hookean left out. With `u` and `v` surfaces and Breps also come as
    meshes."""
    if (u is None) != (v is None):
        name = "u" if u is None else "v"
        raise Problem("invalid-input", "Give both u and v, or neither.", [(f"/{name}", "this is required")])
    largest = request.app.state.settings.largest_count
    if u is not None and v is not None and u * v > largest:
        said = f"this makes {u * v} faces; at most {largest} are allowed"
        raise Problem("invalid-input", f"v: {said}", [("/v", said)])
    options = {"divisions": None if u is None else [u, v], "arrays": arrays}
    return await compute_upload(request, "geometry", options)
