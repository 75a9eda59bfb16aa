"""Sessions over HTTP: made, edited, played, taken out in the formats of other programs, forgotten."""

from __future__ import annotations

import json
import re
from typing import Annotated, Any, Literal, get_args
from urllib.parse import quote

from fastapi import APIRouter, Path, Query, Request
from starlette.convertors import StringConvertor, register_url_convertor
from starlette.responses import JSONResponse, Response

from hookean.errors import InputError
from hookean.scene.text import parse
from hookean_server.http import claimed, openapi, packing
from hookean_server.http.access import reading
from hookean_server.http.handling import read_json, uploaded_scene
from hookean_server.http.limits import media_type
from hookean_server.problems import faulty
from hookean_server.sessions.conditions import Conditions, When
from hookean_server.sessions.exports import FORMATS
from hookean_server.sessions.live import Live, summary
from hookean_server.sessions.manager import Manager

router = APIRouter(tags=["sessions"])

KEY = r"^[A-Za-z0-9._:~-]{1,160}$"
Key = Annotated[str, Path(pattern=KEY, description="Key of a session: letters, digits and . _ : ~ -")]
Label = Annotated[str, Query(max_length=200, description="A name to display")]
Action = Literal["play", "relax", "pause", "step", "reset", "undo", "redo"]
Arrays = Annotated[Literal["list", "buffer"], Query(description="Arrays as lists, or as base64 of their bytes")]


class _Actions(StringConvertor):
    """The part of an address that is an action: of other addresses, POST to /scene is 405 and to /none is 404."""

    regex = "|".join(get_args(Action))


register_url_convertor("action", _Actions())


def manager(request: Request) -> Manager:
    """The sessions of the server."""
    found: Manager = request.app.state.sessions
    return found


async def _body(request: Request) -> tuple[bytes, list[str] | None]:
    """A scene as JSON; the file in a form is read in a worker that is then replaced, with notes on it."""
    if media_type(request.headers) == "multipart/form-data":
        return await uploaded_scene(request)
    return await read_json(request), None


def _answer(live: Live, status: int = 200, described: dict[str, Any] | None = None) -> Response:
    """A session as it stands, or as it was `described` when what was asked for was done."""
    headers = {"etag": live.etag(described), "cache-control": "no-store"}
    if status == 201:
        headers["location"] = f"/v1/sessions/{live.key}"
    return JSONResponse(summary(live, described), status, headers)


@router.post("/v1/sessions", status_code=201, summary="A session of a scene or a file", **openapi.session_body(201))
async def create(request: Request, label: Label = "") -> Response:
    """A new session under a random key, paused. A form takes a .3dm file, an .obj file, a .json file with a scene or
    with COMPAS documents, or a saved simulation (.npz), which continues as it was saved; a file without recipe and
    forces is read as drawn: lines become springs with their loose ends held, meshes membranes with their naked
    vertices held."""
    body, notes = await _body(request)
    live, described, _ = await manager(request).put(None, body, label, notes)
    return _answer(live, 201, described)


@router.put("/v1/sessions/{key}", summary="The session of a key, with this scene", **openapi.session_body(200, 201))
async def put(request: Request, key: Key, when: When, label: Label = "") -> Response:
    """Makes the session, or gives the one that exists this scene: particles that start where one of the old scene did
    stay where they are now, and it continues. The same scene again changes nothing."""
    body, notes = await _body(request)
    live, described, new = await manager(request).put(key, body, label, notes, when)
    return _answer(live, 201 if new else 200, described)


@router.get("/v1/sessions", summary="All sessions", responses=openapi.problems(openapi.SESSIONS))
async def listing(request: Request) -> dict[str, Any]:
    """Every session with its state and the sentence on it; and the store, with what was lost from it by name."""
    sessions = manager(request)
    listed = [summary(live) for live in sessions.sessions.values()]
    return {"sessions": listed, "store": sessions.store.described(names=True)}


@router.get(
    "/v1/sessions/{key}", summary="Status of a session", responses=openapi.problems(openapi.SESSION, 304, live=True)
)
@reading
async def read(request: Request, key: Key, when: When) -> Response:
    """Revision, iteration, time, residual, status and the sentence on it. The header hookean-silence has how long its
    process has sent nothing [s]: longer than 0.5 in a long step, or if it hangs."""
    live = manager(request).find(key)
    answer = unless_same(_answer(live), when)
    if (silence := live.silence) is not None:
        answer.headers["hookean-silence"] = f"{silence:.3f}"
    return answer


@router.delete("/v1/sessions/{key}", status_code=204, summary="Delete a session", responses=openapi.problems(live=True))
async def delete(request: Request, key: Key, when: When) -> Response:
    """Deletes it; its watchers are disconnected."""
    await manager(request).delete(key, when)
    return Response(status_code=204)


@router.patch("/v1/sessions/{key}", summary="Edit a running session", **openapi.edit())
async def edit(request: Request, key: Key, when: When) -> Response:
    """A patch: `pin`, `release`, `move`, `forces`, `settings`, `add`, `remove`, all of it or nothing; those of one
    `gesture` are undone as one. It is stored when this is answered, and in every frame of this revision or a later
    one."""
    body = await read_json(request)
    live = manager(request).find(key)
    return _answer(live, 200, await manager(request).edit(live, body, when=when))


@router.put("/v1/sessions/{key}/label", summary="Rename a session", **openapi.renamed())
async def rename(request: Request, key: Key, when: When, label: Label = "") -> Response:
    """Another name to display; none is the key. The model and its revision stay."""
    return _answer(await manager(request).rename(key, label, when))


@router.post("/v1/sessions/{key}/branches", status_code=201, summary="Branch a session", **openapi.branched())
async def branch(
    request: Request,
    key: Key,
    when: When,
    to: Annotated[str | None, Query(pattern=KEY, description="Key of the branch; default: a random one")] = None,
    label: Label = "",
) -> Response:
    """Another session that continues from here, paused; earlier edits cannot be undone in it."""
    return _answer(await manager(request).branch(key, to, label, when), 201)


@router.post(
    "/v1/sessions/{key}/{action:action}",
    summary="Play, relax, pause, step, reset, undo, redo",
    responses=openapi.acted(),
)
async def act(
    request: Request,
    key: Key,
    action: Action,
    when: When,
    frames: Annotated[int, Query(ge=1, le=100_000, description="Of `step`: number of frames")] = 1,
    fast: Annotated[bool, Query(description="Of `play`: at full speed, not at 60 frames a second")] = False,
) -> Response:
    """`relax` runs to rest with the scene's own solver, as `POST /v1/relax`; the session plays until then. `step` is
    answered when its frames are done; the others at once."""
    sessions, live = manager(request), manager(request).find(key)
    if action in ("reset", "undo", "redo"):
        described = await sessions.edit(live, json.dumps({action: True}).encode(), when=when)
    else:
        options: dict[str, Any] = {"frames": frames} if action == "step" else {"fast": fast} if action == "play" else {}
        described = await sessions.command(live, action, when, **options)
    return _answer(live, 200, described)


@router.get("/v1/sessions/{key}/scene", summary="The scene with all edits", responses=openapi.exported(304))
@reading
async def scene(request: Request, key: Key, when: When) -> Response:
    """The whole scene as canonical JSON, with forces, anchors and settings after all edits, and particles where
    they started: the same model where it is PUT or opened as a file."""
    return await _exported(request, manager(request).find(key), when, "scene")


@router.get(
    "/v1/sessions/{key}/topology", summary="The parts that do not change while it runs", responses=openapi.exported(304)
)
@reading
async def topology(request: Request, key: Key, when: When, arrays: Arrays = "list") -> Response:
    """Springs, meshes and geometry by particles, and the units. Its ETag changes with the scene and with forces that
    edits add or remove, not with other edits."""
    live = manager(request).find(key)
    if live.topology and when.same(tag := f'"{live.topology}"'):
        return Response(status_code=304, headers={"etag": tag})
    return await _exported(request, live, when, "topology", arrays)


@router.get("/v1/sessions/{key}/anchors", summary="The anchors with all edits", responses=openapi.exported(304))
@reading
async def anchors(request: Request, key: Key, when: When, arrays: Arrays = "list") -> Response:
    """Particles, targets and axes of every anchor, pinned ones included."""
    return await _exported(request, manager(request).find(key), when, "anchors", arrays)


@router.get("/v1/sessions/{key}/state", summary="The present shape and its forces", responses=openapi.exported(304))
@reading
async def state(
    request: Request,
    key: Key,
    when: When,
    form: Annotated[Literal["json", "npz", "hookean", "3dm", "obj", "compas", "csv"], Query(alias="format")] = "json",
    arrays: Arrays = "list",
    view: Annotated[
        str,
        Query(
            max_length=16_000,
            description="Of `hookean`: how it is looked at, a JSON object as text, or that as raw deflate in base64url",
        ),
    ] = "{}",
) -> Response:
    """A result as JSON; or a file: .hookean with scene, state and view, .npz of Simulation.save, .3dm, .obj,
    COMPAS Mesh or Graph, CSV with a row for each element and each reaction, units in its first line. Files of .hookean,
    .npz, .3dm and COMPAS open again as the same model; what a file does not store is in the header
    `hookean-warnings`, a JSON list of sentences."""
    live = manager(request).find(key)
    answer = await _exported(request, live, when, form, arrays, _view(view))
    if form != "json":
        answer.headers["content-disposition"] = _attached(live.label or live.key, "json" if form == "compas" else form)
    return answer


def _view(told: str) -> dict[str, Any]:
    """How a session is looked at; the problem of a request whose view is not a JSON object."""
    try:
        found = parse(packing.unpacked(told, "view") if packing.is_packed(told) else told, "view")
        if not isinstance(found, dict):
            raise InputError("view", f"{told[:40]!r} given; give a JSON object")
    except InputError as error:
        raise faulty("invalid-input", [error]) from None
    return found


def _attached(name: str, ending: str) -> str:
    """A download under a session's name, made safe for every system; in full for clients that read RFC 5987."""
    whole = re.sub(r"[\s/\\:*?\"<>|\x00-\x1f\x7f]+", " ", name).strip(" .")[:80] or "session"
    plain = re.sub(r"[^A-Za-z0-9 ._~-]+", "_", whole)
    also = f"; filename*=UTF-8''{quote(whole, safe='')}.{ending}" if plain != whole else ""
    return f'attachment; filename="{plain}.{ending}"' + also


async def _exported(
    request: Request, live: Live, when: Conditions, form: str, arrays: str = "list", view: Any = None
) -> Response:
    scene = live.scene  # as it is asked for: an edit that is made before the answer is ours has another tag
    head, data = await manager(request).export(live, form, arrays, view)
    tag = f'"{scene}{head["wiring"]}"' if form == "topology" else live.etag(head)
    headers = {"etag": tag, "cache-control": "no-cache", **claimed.warned(head["notes"])}
    answer = Response(data, media_type=FORMATS.get(form, "application/json"), headers=headers)
    return unless_same(answer, when)


def unless_same(answer: Response, when: Conditions) -> Response:
    """The answer, or 304 where the client has it."""
    if not when.same(answer.headers["etag"]):
        return answer
    kept = ("etag", "cache-control", "hookean-warnings")
    return Response(status_code=304, headers={name: answer.headers[name] for name in kept if name in answer.headers})
