"""What the service says of itself: health, the catalogue of forces, its problems, its description."""

from __future__ import annotations

import asyncio
import hashlib
import json
from typing import Any

from fastapi import APIRouter, Request
from starlette.responses import PlainTextResponse, Response

import hookean
from hookean_server import openapi
from hookean_server.metrics import TYPE, Metrics
from hookean_server.problems import CATALOGUE, Problem, page
from hookean_server.tokens import cookie_name, cookies, set_cookie

router = APIRouter(tags=["about"])


@router.get(
    "/v1/health", summary="Whether the service is well", responses=openapi.problems(openapi.HEALTH, open_to_all=True)
)
async def health(request: Request) -> dict[str, Any]:
    """Answers at once, whatever is being solved. `status`: `starting`, `ok`, `full` or `stopping`."""
    state = request.app.state
    workers = state.pool.states()
    room = state.settings.lanes + state.settings.queue
    status = "ok"
    if state.pool.stopping.is_set():
        status = "stopping"
    elif state.pool.taken >= room:
        status = "full"
    elif workers["starting"] and not workers["idle"] + workers["busy"]:
        status = "starting"
    return {
        "service": "hookean",
        "version": hookean.__version__,
        "api": "v1",
        "status": status,
        "instance": state.instance,
        "workers": {**workers, "restarts": state.pool.restarts},
        "requests": {"taken": state.pool.taken, "room": room},
    }


@router.get("/v1/forces", summary="The catalogue of forces", responses=openapi.problems(openapi.FORCES, 304))
async def forces(request: Request) -> Response:
    """Every kind of force: formula, role, fields with unit, default and bounds, outputs with units, an example."""
    body, tag = await asyncio.to_thread(_catalogue)
    if request.headers.get("if-none-match") == tag:
        return Response(status_code=304, headers={"etag": tag})
    return Response(body, media_type="application/json", headers={"etag": tag})


@router.get(
    "/problems/{slug}",
    summary="What a problem means",
    responses=openapi.problems(open_to_all=True),
    response_class=PlainTextResponse,
)
async def problem(slug: str) -> Response:
    """The page that a problem's `type` names."""
    if slug not in CATALOGUE:
        raise Problem("not-found", f"There is no such problem; there are {', '.join(CATALOGUE)}.")
    return PlainTextResponse(page(slug))


@router.get("/metrics", summary="Figures for Prometheus", responses=openapi.problems(openapi.METRICS))
async def metrics(request: Request) -> Response:
    """Requests, sessions, workers, frames, the queue and the store."""
    found: Metrics = request.app.state.metrics
    return Response(found.text(), headers={"content-type": TYPE, "cache-control": "no-store"})


@router.post("/v1/login", status_code=204, summary="A cookie for a page", responses=openapi.problems())
async def login(request: Request) -> Response:
    """For the page that was opened with the token behind the # of its address: it sends the token as programs do, once,
    and its browser keeps a cookie that scripts cannot read and other sites' pages cannot use. It stays valid
    when the service is started again, until it was not used for 30 days or is taken back."""
    value = await request.app.state.tokens.login()
    return Response(status_code=204, headers={"set-cookie": set_cookie(_cookie(request), value)})


@router.delete("/v1/login", status_code=204, summary="Take the cookie back", responses=openapi.forgotten())
async def logout(request: Request) -> Response:
    """The cookie is worth nothing from now on, wherever it is kept."""
    name = _cookie(request)
    await request.app.state.tokens.logout(cookies(request.headers.get("cookie", ""), name))
    return Response(status_code=204, headers={"set-cookie": set_cookie(name, "")})


def _cookie(request: Request) -> str:
    return cookie_name(request.scope["server"][1])


_made: tuple[bytes, str] | None = None


def _catalogue() -> tuple[bytes, str]:
    global _made
    if _made is None:
        from hookean.catalogue import catalogue

        body = json.dumps({"forces": catalogue()}).encode()
        _made = body, f'"{hashlib.sha256(body).hexdigest()[:16]}"'
    return _made
