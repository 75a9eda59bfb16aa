"""Families: scenes to begin with, from parameters; one address for each of the table."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from typing import Any

from fastapi import APIRouter, Request
from starlette.responses import Response

from hookean.scene.families import FAMILIES, families
from hookean_server.http import openapi
from hookean_server.http.handling import compute
from hookean_server.problems import Problem

router = APIRouter(tags=["families"])


@router.get("/v1/families", summary="The families of scenes", responses=openapi.problems(openapi.FAMILIES))
async def listing() -> dict[str, Any]:
    """Every family with its parameters: description, unit, default, bounds, choices."""
    return {"families": await asyncio.to_thread(families)}


def _route(name: str) -> Callable[..., Awaitable[Response]]:
    async def make(request: Request) -> Response:
        return await compute(request, "family", {"name": name})

    make.__name__ = name
    return make


for _name, _family in FAMILIES.items():
    router.add_api_route(
        f"/v1/families/{_name}",
        _route(_name),
        methods=["POST"],
        summary=f"The scene of the family {_name}",
        description=f"{_family.entry()['summary']} The answer is a body for `POST /v1/sessions`; an edit `rebuild` of "
        "that session changes its parameters.",
        **openapi.family(_family.model.model_json_schema()["properties"]),
    )


@router.post("/v1/families/{family}", include_in_schema=False)
async def unknown(family: str) -> Response:
    """Any other family."""
    raise Problem("not-found", "Unknown family; GET /v1/families lists all.")
