"""What every computing route does: take a place, read the body, hand it to a worker, watch the client, answer."""

from __future__ import annotations

import asyncio
import json
import shutil
import tempfile
from collections.abc import Callable, Coroutine
from contextlib import suppress
from pathlib import Path
from typing import Any

from starlette.requests import ClientDisconnect, Request
from starlette.responses import Response

from hookean_server.http.limits import media_type
from hookean_server.lifecycle import leftovers
from hookean_server.problems import Problem, not_stored
from hookean_server.settings import Settings
from hookean_server.workers.pool import Job, Pool, Reply

Run = Callable[[str, dict[str, Any], bytes], Coroutine[Any, Any, Reply]]


async def read_json(request: Request) -> bytes:
    """The body of a JSON request; it is parsed in a worker. Raises the problem `unsupported-media`."""
    kind = media_type(request.headers)
    if kind != "application/json" and not (kind.startswith("application/") and kind.endswith("+json")):
        raise Problem("unsupported-media", "Send JSON with the header Content-Type: application/json.")
    return b"".join([chunk async for chunk in request.stream()])


async def compute(request: Request, task: str, options: dict[str, Any], *, once: Any = False) -> Response:
    """Run a task on the JSON body of a request. `once`: whether to replace the worker afterwards, or a function of the
    body that returns this."""
    pool, settings = _service(request)
    with pool.place():
        job = _job(settings, task, options, await read_json(request), once)
        return respond(await answered(request, pool.run(job)))


async def compute_steps(request: Request, steps: Callable[[Run, bytes], Coroutine[Any, Any, Reply]]) -> Response:
    """Run several tasks for one request with a JSON body: `steps` gets the body, and what runs a task with its options
    and body on a worker."""
    pool, settings = _service(request)

    async def run(task: str, options: dict[str, Any], body: bytes) -> Reply:
        return await pool.run(_job(settings, task, options, body, False))

    with pool.place():
        return respond(await answered(request, steps(run, await read_json(request))))


async def compute_for_anyone(request: Request, task: str, options: dict[str, Any], *, once: Any = False) -> Response:
    """`compute` for a request that needs no token, within the budgets of visits."""
    pool, settings = _service(request)
    job = _job(settings, task, options, await read_json(request), once)
    return respond(await answered(request, request.scope["visit"].run(pool, job)))


def _job(settings: Settings, task: str, options: dict[str, Any], body: bytes, once: Any) -> Job:
    single = once(body) if callable(once) else bool(once)
    return Job(task, options, body, settings.solve_seconds + settings.grace_seconds, single)


async def compute_upload(request: Request, task: str, options: dict[str, Any], *, seconds: float = 0.0) -> Response:
    """Run a task on the multipart body of a request, which is streamed to disk; the worker is replaced afterwards.
    `seconds` that it may take on top of what reading a file may."""
    return respond(await _uploaded(request, task, options, seconds))


async def uploaded_scene(request: Request) -> tuple[bytes, list[str]]:
    """The scene, as JSON, of the file in a form, and the notes on the file."""
    reply = await _uploaded(request, "scene", {})
    return reply.body, json.loads(reply.head["headers"].get("hookean-warnings", "[]"))


async def _uploaded(request: Request, task: str, options: dict[str, Any], seconds: float = 0.0) -> Reply:
    pool, settings = _service(request)
    if media_type(request.headers) != "multipart/form-data":
        raise Problem("unsupported-media", "Send the file as a form: Content-Type: multipart/form-data.")
    with pool.place():
        folder = ""
        try:
            try:
                folder = tempfile.mkdtemp(prefix=leftovers.prefix())
                path = Path(folder) / "body"
                with path.open("wb") as file:
                    async for chunk in request.stream():
                        file.write(chunk)
            except OSError as error:
                raise not_stored(error) from None
            told = {"content_type": request.headers["content-type"], "read_seconds": settings.read_seconds}
            given = {**options, "path": str(path), **told}
            longest = 2.0 * settings.read_seconds + seconds + settings.grace_seconds
            job = Job(task, given, b"", longest, once=True)
            return await answered(request, pool.run(job))
        finally:
            await asyncio.to_thread(shutil.rmtree, folder, ignore_errors=True)


def _service(request: Request) -> tuple[Pool, Settings]:
    return request.app.state.pool, request.app.state.settings


async def answered(request: Request, running: Coroutine[Any, Any, Reply]) -> Reply:
    """The worker's answer; a client that leaves stops the worker."""
    work = asyncio.ensure_future(running)
    gone = asyncio.ensure_future(_left(request))
    try:
        await asyncio.wait({work, gone}, return_when=asyncio.FIRST_COMPLETED)
        if not work.done():
            raise ClientDisconnect
        return work.result()
    finally:
        for task in (work, gone):
            task.cancel()
            with suppress(asyncio.CancelledError, Problem):
                await task


def respond(reply: Reply) -> Response:
    """A worker's answer as a response."""
    timing = ", ".join(f"{name};dur={1000 * seconds:.3f}" for name, seconds in reply.head["timing"].items())
    headers = {**reply.head["headers"], "cache-control": "no-store", "server-timing": timing}
    return Response(reply.body, media_type=reply.head["type"], headers=headers)


async def _left(request: Request) -> None:
    while (await request.receive())["type"] != "http.disconnect":
        pass
