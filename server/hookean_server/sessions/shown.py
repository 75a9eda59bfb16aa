"""What programs and the page share about a session beside its model: what is picked, colours, the edits so far.

Nothing of it changes the model, and what is picked and the colours are not stored: they end with the service.
"""

from __future__ import annotations

import json
from typing import Annotated, Any, Literal

import pydantic
from fastapi import APIRouter, Query, Request
from starlette.responses import JSONResponse

from hookean.errors import InputError
from hookean.scene.text import parse
from hookean.values.columns import Model
from hookean_server.http import openapi
from hookean_server.http.access import reading
from hookean_server.http.handling import read_json
from hookean_server.problems import faulty
from hookean_server.sessions import rows
from hookean_server.sessions.routes import Key, manager

router = APIRouter(tags=["sessions"])

MOST = 1_000_000  # numbers in colours


class Picked(Model):
    """A particle, or a spring of the topology, by its number."""

    kind: Literal["particle", "spring"]
    index: int = pydantic.Field(ge=0, le=MOST, strict=True)


class Colours(Model):
    """Numbers that colour the springs: one for each spring of the topology, or for each particle."""

    title: str = pydantic.Field(min_length=1, max_length=80, description="As in the legend")
    unit: str = pydantic.Field(default="-", max_length=20, description="As in the legend; - for none")
    of: Literal["springs", "particles"]
    values: tuple[Annotated[float, pydantic.Field(strict=True)], ...] = pydantic.Field(min_length=1, max_length=MOST)


class Looked(Model):
    """What changes of how a session is looked at; null takes it back."""

    called = "view"

    picked: Picked | None = None
    colours: Colours | None = None


@router.get("/v1/sessions/{key}/view", summary="How a session is looked at", responses=openapi.looked())
@reading
async def view(request: Request, key: Key) -> JSONResponse:
    """`picked`: the particle or spring that is picked in the page, or null; `colours`: numbers that a program gave to
    colour the springs with, or null."""
    live = manager(request).find(key)
    return JSONResponse({"picked": None, "colours": None, **live.view}, headers={"cache-control": "no-store"})


@router.patch("/v1/sessions/{key}/view", summary="Look at a session in another way", **openapi.look())
async def look(request: Request, key: Key) -> JSONResponse:
    """`colours`: numbers by which every page that shows the session colours its springs; `picked`: what is picked, as a
    page reports it. This is no edit: the model and its revision stay, and nothing is stored."""
    body = await read_json(request)
    live = manager(request).find(key)
    try:
        given = Looked.read(parse(body))
    except InputError as error:
        raise faulty("invalid-input", [error]) from None
    told = given.model_dump()
    changed = {name: told[name] for name in given.model_fields_set}
    others = "colours" in changed and live.view.get("colours") != changed["colours"]
    live.view = {**live.view, **changed}
    if others:
        live.views += 1
        live.tell()
    return await view(request, key)


@router.get("/v1/sessions/{key}/edits", summary="The edits of a session", responses=openapi.edits())
async def edits(
    request: Request,
    key: Key,
    after: Annotated[int, Query(ge=0, lt=2**53, description="Only edits that led to a later revision")] = 0,
) -> JSONResponse:
    """Each edit with the `revision` it led to, in their order: patches, and `undo`, `redo`, `reset`. Those of one
    gesture that set the same are one. After 400 edits the oldest, which cannot be undone any more, are left out."""
    sessions = manager(request)
    live = sessions.find(key)
    found: list[Any] = await sessions.store.run(rows.edits(live.key, after))
    listed = [{"revision": revision, "edit": json.loads(body)} for revision, body in found]
    return JSONResponse({"edits": listed}, headers={"cache-control": "no-store"})
