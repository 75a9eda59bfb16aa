"""Discretizing: one address for each operation of the table."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from typing import Any

from fastapi import APIRouter, Request
from starlette.responses import Response

from hookean_server.http import openapi
from hookean_server.http.handling import compute
from hookean_server.problems import Problem
from hookean_server.routes.relax import Arrays, Meshes
from hookean_server.workers.discretize_task import OPERATIONS, uses_rhino

router = APIRouter(tags=["discretize"])


@router.get("/v1/discretize", summary="The operations", responses=openapi.problems())
async def operations() -> dict[str, Any]:
    """Every operation with its inputs, options and outputs."""
    return {
        "operations": [
            {
                "operation": name,
                "summary": o.summary,
                "takes": o.takes,
                "options": [
                    {"name": n, "required": default is None, "default": default}
                    for n, (_, default) in o.options.items()
                ],
                "gives": list(o.gives),
            }
            for name, o in OPERATIONS.items()
        ]
    }


def _route(name: str) -> Callable[..., Awaitable[Response]]:
    async def operation(request: Request, arrays: Arrays = None, meshes: Meshes = None) -> Response:
        options = {"operation": name, "arrays": arrays, "meshes": meshes}
        options["largest"] = request.app.state.settings.largest_count
        return await compute(request, "discretize", options, once=uses_rhino)

    operation.__name__ = name
    operation.__doc__ = OPERATIONS[name].function.__doc__
    return operation


for _name in OPERATIONS:
    router.add_api_route(
        f"/v1/discretize/{_name}",
        _route(_name),
        methods=["POST"],
        summary=OPERATIONS[_name].summary.replace("`", ""),  # shown as plain text
        **openapi.discretize(_name),
    )


@router.post("/v1/discretize/{operation}", include_in_schema=False)
async def unknown(operation: str) -> Response:
    """Any other operation."""
    raise Problem("not-found", f"Unknown operation; known: {', '.join(OPERATIONS)}.")
