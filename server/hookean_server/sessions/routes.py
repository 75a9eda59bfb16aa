"""Sessions over HTTP: made, edited, played, taken out in the formats of other programs, forgotten."""

from __future__ import annotations

import json
import re
from typing import Annotated, Any, Literal
from urllib.parse import quote

from fastapi import APIRouter, Header, Path, Query, Request
from starlette.responses import JSONResponse, Response

from hookean_server import claimed, openapi
from hookean_server.handling import read_json, uploaded_scene
from hookean_server.limits import media_type
from hookean_server.problems import Problem
from hookean_server.sessions.exports import FORMATS
from hookean_server.sessions.live import Live, summary
from hookean_server.sessions.manager import Manager

router = APIRouter(tags=["sessions"])

KEY = r"^[A-Za-z0-9._:~-]{1,160}$"
Key = Annotated[str, Path(pattern=KEY, description="Key of a session: letters, digits and . _ : ~ -")]
Label = Annotated[str, Query(max_length=200, description="A name for people")]
Arrays = Annotated[Literal["list", "buffer"], Query(description="Arrays as lists, or as base64 of their bytes")]
IfMatch = Annotated[str | None, Header(description='The revision the edit is for, such as "7"; none: whatever it is')]


def manager(request: Request) -> Manager:
    """The sessions of the server."""
    found: Manager = request.app.state.sessions
    return found


async def _body(request: Request) -> tuple[bytes, list[str] | None]:
    """A scene as JSON; the file in a form is read in a worker that is then replaced, with notes on it."""
    if media_type(request.headers) == "multipart/form-data":
        return await uploaded_scene(request)
    return await read_json(request), None


def _answer(live: Live, status: int = 200) -> Response:
    headers = {"etag": _tag(live), "cache-control": "no-store"}
    if status == 201:
        headers["location"] = f"/v1/sessions/{live.key}"
    return JSONResponse(summary(live), status, headers)


@router.post("/v1/sessions", status_code=201, summary="A session of a scene or a file", **openapi.session_body(201))
async def create(request: Request, label: Label = "") -> Response:
    """A new session under a random key, paused. A form takes a .3dm file, an .obj file, a .json file with a scene or
    with COMPAS documents, or a saved simulation (.npz), which goes on as it was saved; what has no recipe and names no
    forces is taken as drawn: lines become springs with their loose ends held, meshes membranes with their naked
    vertices held."""
    body, notes = await _body(request)
    live, _ = await manager(request).put(None, body, label, notes)
    return _answer(live, 201)


@router.put("/v1/sessions/{key}", summary="The session of a key, with this scene", **openapi.session_body(200, 201))
async def put(request: Request, key: Key, label: Label = "") -> Response:
    """Makes the session, or gives the one that exists this scene: particles that start where one of the old scene did
    stay where they are now, and it goes on. The same scene again changes nothing."""
    body, notes = await _body(request)
    live, new = await manager(request).put(key, body, label, notes)
    return _answer(live, 201 if new else 200)


@router.get("/v1/sessions", summary="All sessions", responses=openapi.problems(openapi.SESSIONS))
async def listing(request: Request) -> dict[str, Any]:
    """Every session with its state and the sentence on it."""
    return {"sessions": [summary(live) for live in manager(request).sessions.values() if live.described]}


@router.get(
    "/v1/sessions/{key}", summary="How a session stands", responses=openapi.problems(openapi.SESSION, live=True)
)
async def read(request: Request, key: Key) -> Response:
    """Revision, iteration, time, residual, status and the sentence on it."""
    return _answer(manager(request).find(key))


@router.delete("/v1/sessions/{key}", status_code=204, summary="Forget a session", responses=openapi.problems(live=True))
async def delete(request: Request, key: Key) -> Response:
    """It is gone, for its watchers too."""
    await manager(request).delete(key)
    return Response(status_code=204)


@router.patch("/v1/sessions/{key}", summary="Edit a running session", **openapi.edit())
async def edit(request: Request, key: Key, if_match: IfMatch = None) -> Response:
    """A patch: `pin`, `release`, `move`, `forces`, `settings`, `add`, `remove`, all of it or nothing; those of one
    `gesture` are undone as one. It is stored when this is answered, and in every frame of this revision or a later
    one."""
    body = await read_json(request)
    live = manager(request).find(key)
    await manager(request).edit(key, body, _revision(if_match, live))
    return _answer(live)


@router.post("/v1/sessions/{key}/branches", status_code=201, summary="Branch a session", **openapi.branched())
async def branch(
    request: Request,
    key: Key,
    to: Annotated[str | None, Query(pattern=KEY, description="Key of the branch; none: a random one")] = None,
    label: Label = "",
) -> Response:
    """Another session that goes on from here, paused; it can take back nothing from before."""
    return _answer(await manager(request).branch(key, to, label), 201)


@router.post(
    "/v1/sessions/{key}/{action}", summary="Play, relax, pause, step, reset, undo, redo", responses=openapi.acted()
)
async def act(
    request: Request,
    key: Key,
    action: Literal["play", "relax", "pause", "step", "reset", "undo", "redo"],
    frames: Annotated[int, Query(ge=1, le=100_000, description="Of `step`: how many frames")] = 1,
    fast: Annotated[bool, Query(description="Of `play`: as quickly as it can, not 60 frames a second")] = False,
) -> Response:
    """`relax` goes to rest with the scene's own solver, as `POST /v1/relax`; the session plays until then. `step` is
    answered when its frames are done; the others at once."""
    sessions = manager(request)
    if action in ("reset", "undo", "redo"):
        await sessions.edit(key, json.dumps({action: True}).encode())
    else:
        options: dict[str, Any] = {"frames": frames} if action == "step" else {"fast": fast} if action == "play" else {}
        await sessions.command(key, action, **options)
    return _answer(sessions.find(key))


@router.get("/v1/sessions/{key}/scene", summary="The scene as edits have left it", responses=openapi.exported(304))
async def scene(request: Request, key: Key) -> Response:
    """The whole scene as canonical JSON, with forces, anchors and settings as edits have left them and particles where
    they started: the same model where it is PUT or opened as a file."""
    return await _exported(request, key, "scene")


@router.get("/v1/sessions/{key}/topology", summary="What stays while it runs", responses=openapi.exported(304))
async def topology(request: Request, key: Key, arrays: Arrays = "list") -> Response:
    """Springs, meshes and geometry by particles, and the units. Its ETag changes with the scene and with forces that
    edits add or remove, not with other edits."""
    live = manager(request).find(key)
    tag = f'"{live.topology}"'
    if live.topology and request.headers.get("if-none-match") == tag:
        return Response(status_code=304, headers={"etag": tag})
    answer = await _exported(request, key, "topology", arrays)
    answer.headers["etag"] = f'"{live.topology}"'
    return answer


@router.get("/v1/sessions/{key}/anchors", summary="The anchors as they are now", responses=openapi.exported())
async def anchors(request: Request, key: Key, arrays: Arrays = "list") -> Response:
    """Particles, targets and axes of every anchor, pinned ones included."""
    return await _exported(request, key, "anchors", arrays)


@router.get("/v1/sessions/{key}/state", summary="The present shape and its forces", responses=openapi.exported())
async def state(
    request: Request,
    key: Key,
    form: Annotated[Literal["json", "npz", "3dm", "obj", "compas", "csv"], Query(alias="format")] = "json",
    arrays: Arrays = "list",
) -> Response:
    """A result as JSON; or a file: .npz of Simulation.save, .3dm, .obj, COMPAS Mesh or Graph, CSV with a row for each
    element and each reaction, units in its first line. Files of .npz, .3dm and COMPAS open again as the same model;
    what a file does not hold is in the header `hookean-warnings`, a JSON list of sentences."""
    answer = await _exported(request, key, form, arrays)
    if form != "json":
        live = manager(request).find(key)
        answer.headers["content-disposition"] = _attached(live.label or live.key, "json" if form == "compas" else form)
    return answer


def _attached(name: str, ending: str) -> str:
    """A download under a session's name, made safe for every system; in full for clients that read RFC 5987."""
    whole = re.sub(r"[\s/\\:*?\"<>|\x00-\x1f\x7f]+", " ", name).strip(" .")[:80] or "session"
    plain = re.sub(r"[^A-Za-z0-9 ._~-]+", "_", whole)
    also = f"; filename*=UTF-8''{quote(whole, safe='')}.{ending}" if plain != whole else ""
    return f'attachment; filename="{plain}.{ending}"' + also


async def _exported(request: Request, key: str, form: str, arrays: str = "list") -> Response:
    head, data = await manager(request).export(key, form, arrays)
    headers = {"etag": f'"{head["revision"]}-{head["iteration"]}"', "cache-control": "no-cache"}
    headers |= claimed.warned(head["notes"])
    if request.headers.get("if-none-match") == headers["etag"]:
        return Response(status_code=304, headers=headers)
    return Response(data, media_type=FORMATS.get(form, "application/json"), headers=headers)


def _revision(if_match: str | None, live: Live) -> int | None:
    """The revision that an edit is for; None: whatever it is. What is no revision matches none."""
    if if_match is None or if_match.strip() == "*":
        return None
    found = re.fullmatch(r'"?(\d{1,18})"?', if_match.strip())
    if found is None:
        tag = _tag(live)
        said = f"If-Match accepts one revision, such as {tag}, or *; the session is at revision {tag}."
        raise Problem("stale-revision", said, headers={"etag": tag})
    return int(found[1])


def _tag(live: Live) -> str:
    """The ETag of a session: its revision."""
    return f'"{live.described["revision"]}"'
