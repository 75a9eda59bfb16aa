"""Information about the service: health, the catalogue of forces, its problems, its description."""

from __future__ import annotations

import asyncio
import hashlib
import json
from typing import Annotated, Any

from fastapi import APIRouter, Query, Request
from starlette.responses import JSONResponse, PlainTextResponse, Response

import hookean
from hookean_server.http import openapi
from hookean_server.http.access import Access, marked, reading
from hookean_server.http.metrics import TYPE, Metrics
from hookean_server.http.tokens import CODE_LIFE, cookie_name, cookies, set_cookie
from hookean_server.problems import CATALOGUE, Problem, not_stored, page

router = APIRouter(tags=["about"])


@router.get("/v1/health", summary="Health of the service", responses=openapi.problems(openapi.HEALTH, open_to_all=True))
@marked(Access.OPEN)
async def health(request: Request) -> dict[str, Any]:
    """Answers at once, also while solving. `status`: `starting`, `ok`, `full` or `stopping`. `store`: damage of
    the file of sessions and jobs, and the number of losses; with the token also their names."""
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
        "store": state.store.described(names=state.tokens.named(request.headers.get("authorization", ""))),
    }


@router.get("/v1/forces", summary="The catalogue of forces", responses=openapi.problems(openapi.FORCES, 304))
@reading
async def forces(request: Request) -> Response:
    """Every kind of force: formula, role, fields with unit, default and bounds, outputs with units, an example."""
    body, tag = await asyncio.to_thread(_catalogue)
    if request.headers.get("if-none-match") == tag:
        return Response(status_code=304, headers={"etag": tag})
    return Response(body, media_type="application/json", headers={"etag": tag})


@router.get(
    "/problems/{slug}",
    summary="Meaning of a problem",
    responses=openapi.problems(open_to_all=True),
    response_class=PlainTextResponse,
)
@marked(Access.OPEN)
async def problem(slug: str) -> Response:
    """The page that a problem's `type` names."""
    if slug not in CATALOGUE:
        raise Problem("not-found", f"Unknown problem; known: {', '.join(CATALOGUE)}.")
    return PlainTextResponse(page(slug))


@router.get("/metrics", summary="Figures for Prometheus", responses=openapi.problems(openapi.METRICS))
async def metrics(request: Request) -> Response:
    """Requests, sessions, workers, frames, the queue and the store."""
    found: Metrics = request.app.state.metrics
    return Response(found.text(), headers={"content-type": TYPE, "cache-control": "no-store"})


@router.get(
    "/v1/proof",
    summary="Proof that this server wrote the file its clients read",
    responses=openapi.problems(openapi.PROOF, open_to_all=True, asked=True),
)
@marked(Access.OPEN)
async def proof(
    request: Request,
    nonce: Annotated[str, Query(pattern="^[0-9a-f]{32,128}$", description="16 to 64 random bytes, in hex")],
) -> dict[str, str]:
    """For clients of this user, before they send a token down the same connection: `proof` is the HMAC-SHA256, in hex,
    of `hookean <instance> <address> <port> <nonce>` by the key `proof` of server.json, which no other user can read;
    address and port are those that the client has connected to."""
    state, (address, port) = request.app.state, request.scope["server"]
    return {"instance": state.instance, "proof": state.tokens.proven(state.instance, str(address), int(port), nonce)}


@router.post("/v1/login", status_code=204, summary="A cookie for a page", responses=openapi.problems())
@marked(Access.CODE)
async def login(request: Request) -> Response:
    """For the page that was opened with the token, or a code, after the # of its address: it sends this once, as
    programs send the token, and its browser keeps a cookie that scripts and pages of other sites cannot use. The
    cookie is valid until the service stops, it was not used for 12 hours, or it is revoked."""
    name = cookie_name(_port(request))
    value = request.app.state.tokens.login(name)
    return Response(status_code=204, headers={"set-cookie": set_cookie(name, value)})


@router.delete("/v1/login", status_code=204, summary="Log out a page", responses=openapi.problems())
async def logout(request: Request) -> Response:
    """Revokes the cookie and closes the sockets that it opened."""
    name = cookie_name(_port(request))
    request.app.state.tokens.logout(name, cookies(request.headers.get("cookie", ""), name))
    return Response(status_code=204, headers={"set-cookie": set_cookie(name, "")})


@router.post("/v1/login/codes", status_code=201, summary="A code for one log-in", **openapi.code())
@marked(Access.PROGRAM)
async def code(request: Request) -> JSONResponse:
    """A code that a page may send to `/v1/login` instead of the token, once, within `seconds`. With `frame` in its
    address, `/?frame=...`, notebooks on this machine can show the page in a cell."""
    tokens = request.app.state.tokens
    body = {"code": tokens.code(), "seconds": CODE_LIFE, "frame": tokens.frame}
    return JSONResponse(body, 201, headers={"cache-control": "no-store"})


@router.get(
    "/v1/login/codes/{sha256}", status_code=204, summary="Whether a code can be used", responses=openapi.problems()
)
@marked(Access.PROGRAM)
async def code_waits(request: Request, sha256: str) -> Response:
    """204 until the code was used or has expired, then 404. The code is identified by its SHA-256, in hex."""
    if not request.app.state.tokens.waits(sha256):
        raise Problem("not-found", "Unknown or used code; run hookean studio again for a new one.")
    return Response(status_code=204)


@router.post("/v1/token", status_code=204, summary="Log out all clients", responses=openapi.forgotten())
@marked(Access.PROGRAM)
async def renew(request: Request) -> Response:
    """Gives the service a new token, which clients of this user read in its file. The old token, every cookie and
    every code become invalid, and their sockets and streams are closed."""
    try:
        request.app.state.tokens.renew()
    except OSError as error:
        raise not_stored(error) from None
    return Response(status_code=204)


def _port(request: Request) -> int:
    return int(request.scope["server"][1])


_made: tuple[bytes, str] | None = None


def _catalogue() -> tuple[bytes, str]:
    global _made
    if _made is None:
        from hookean.scene.catalogue import catalogue

        body = json.dumps({"forces": catalogue()}).encode()
        _made = body, f'"{hashlib.sha256(body).hexdigest()[:16]}"'
    return _made
