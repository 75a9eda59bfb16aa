"""The read-only link of a session, for its owner: made, read, revoked."""

from __future__ import annotations

from fastapi import APIRouter, Request
from starlette.responses import JSONResponse, Response

from hookean_server.http import openapi
from hookean_server.http.guests import Guests
from hookean_server.sessions.routes import Key, manager

router = APIRouter(tags=["sessions"])


def _guests(request: Request) -> Guests:
    found: Guests = request.app.state.tokens.guests
    return found


def _answer(token: str) -> JSONResponse:
    return JSONResponse({"token": token or None}, headers={"cache-control": "no-store"})


@router.put("/v1/sessions/{key}/guest", summary="A read-only link", responses=openapi.guest())
async def link(request: Request, key: Key) -> JSONResponse:
    """`token`: with it clients read this session and watch its frames, and nothing else; every other request is refused
    with the problem `read-only`. The page takes it as `/#g=TOKEN&s=KEY`. A session has one link: the same again until
    it is revoked. It ends with the session, and with the service."""
    return _answer(_guests(request).link(manager(request).find(key)))


@router.get("/v1/sessions/{key}/guest", summary="Whether there is a read-only link", responses=openapi.guest())
async def linked(request: Request, key: Key) -> JSONResponse:
    """`token`: that of the link, or null if the session has none."""
    return _answer(_guests(request).token(manager(request).find(key)))


@router.delete(
    "/v1/sessions/{key}/guest", status_code=204, summary="Revoke the read-only link", responses=openapi.guest(204)
)
async def revoke(request: Request, key: Key) -> Response:
    """The link becomes invalid and its sockets are closed; the next one has another token."""
    _guests(request).revoke(manager(request).find(key))
    return Response(status_code=204)
