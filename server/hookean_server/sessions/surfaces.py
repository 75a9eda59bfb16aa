"""The surface of a session's shape, as the core describes it: numbers at particles, height lines, ways of water."""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import APIRouter, Query, Request
from starlette.responses import Response

from hookean_server.http import openapi
from hookean_server.http.access import reading
from hookean_server.sessions.conditions import When
from hookean_server.sessions.routes import Key, manager, unless_same

router = APIRouter(tags=["sessions"])


@router.get("/v1/sessions/{key}/surface", summary="The surface of the present shape", responses=openapi.exported(304))
@reading
async def surface(
    request: Request,
    key: Key,
    when: When,
    step: Annotated[
        float | None, Query(gt=0, allow_inf_nan=False, description="From height line to height line [length]")
    ] = None,
    drops: Annotated[int, Query(ge=0, le=10_000, description="How many drops of water fall, at most")] = 0,
) -> Response:
    """Displacement from the start, slope and curvature at each particle, stress, state and utilisation of cloth, lines
    of equal height, and the ways of drops of water, as `hookean.surface` returns them; null where a number is
    undefined."""
    live = manager(request).find(key)
    options: dict[str, Any] = {"step": step, "drops": drops}
    head, data = await manager(request).export(live, "surface", "list", options)
    headers = {"etag": live.etag(head), "cache-control": "no-cache"}
    return unless_same(Response(data, media_type="application/json", headers=headers), when)
