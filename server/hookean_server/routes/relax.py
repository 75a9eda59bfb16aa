"""Relaxing: a scene as JSON, or a .3dm file."""

from __future__ import annotations

from typing import Annotated, Literal

from fastapi import APIRouter, Query, Request
from starlette.responses import Response

from hookean_server.http import openapi
from hookean_server.http.handling import compute, compute_upload

router = APIRouter(tags=["relax"])

Arrays = Annotated[
    Literal["list", "buffer"] | None,
    Query(description="Arrays as lists of numbers, or as base64 of their bytes; default: as in the request"),
]
Meshes = Annotated[
    Literal["plain", "compas"] | None,
    Query(description="Meshes as vertices and faces, or as COMPAS Mesh documents; default: as in the request"),
]


@router.post("/v1/relax", summary="Relax a scene to equilibrium", **openapi.relax())
async def relax(request: Request, arrays: Arrays = None, meshes: Meshes = None) -> Response:
    """The shape in equilibrium, its forces and reactions. Every run that ends by itself has status 200: one
    that stalled, diverged or reached its limit of iterations or time returns its last good shape and reports this in
    `status`, `message` and the headers."""
    seconds = request.app.state.settings.solve_seconds
    return await compute(request, "relax", {"arrays": arrays, "meshes": meshes, "seconds": seconds})


@router.post("/v1/relax/3dm", summary="Relax the geometry in a .3dm file", **openapi.relax_file())
async def relax_file(
    request: Request,
    answer: Annotated[
        Literal["file", "report"] | None,
        Query(description="The relaxed file, or its results as JSON; default: by the header Accept, else the file"),
    ] = None,
) -> Response:
    """The uploaded file with the relaxed shape added to it. Parts of the form: `file`, and optionally `recipe`. As with
    `/v1/relax`, every run that ends by itself is answered with status 200, with its last good shape: headers such as
    `Hookean-Status` report how it ended, and so does the document text of the file (`hookean:status`)."""
    seconds = request.app.state.settings.file_seconds
    wanted = request.headers.get("accept", "").split(",")[0].split(";")[0].strip().lower()
    chosen = answer or ("report" if wanted == "application/json" else "file")
    return await compute_upload(request, "file", {"answer": chosen, "seconds": seconds}, seconds=seconds)
