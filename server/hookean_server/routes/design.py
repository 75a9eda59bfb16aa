"""Derivatives of results through the equilibrium of a scene. Design problems are jobs."""

from __future__ import annotations

from fastapi import APIRouter, Request
from starlette.responses import Response

from hookean_server.http import openapi
from hookean_server.http.handling import compute
from hookean_server.routes.relax import Arrays

router = APIRouter(tags=["design"])


@router.post("/v1/sensitivity", summary="Derivatives of results by what may vary", **openapi.sensitivity())
async def sensitivity(request: Request, arrays: Arrays = None) -> Response:
    """The values of goals at the equilibrium of a scene, and their derivatives by its variables, by one solve with the
    tangent stiffness: `gradient` has an array for each variable."""
    options = {"seconds": request.app.state.settings.solve_seconds, "arrays": arrays}
    return await compute(request, "sensitivity", options)
