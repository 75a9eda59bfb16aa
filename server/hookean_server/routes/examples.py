"""The gallery: the figures of the chapter, each with a picture and a scene to begin a session with."""

from __future__ import annotations

import asyncio
from typing import Annotated, Any

from fastapi import APIRouter, Path, Request
from starlette.responses import FileResponse, Response

from hookean.commands.examples import Example
from hookean_server.http import openapi
from hookean_server.http.handling import answered, respond
from hookean_server.problems import Problem
from hookean_server.workers.example_task import by_name
from hookean_server.workers.pool import Job

router = APIRouter(tags=["examples"])

Id = Annotated[str, Path(description="Id of an example, from the list")]


@router.get("/v1/examples", summary="The examples", responses=openapi.problems(openapi.GALLERY))
async def listing(request: Request) -> dict[str, Any]:
    """Every figure that can be a session, in the order of the chapter: its id, figure numbers, title,
    a sentence on what to see and try, and the addresses of its picture and its scene."""
    return {
        "examples": [
            {
                "id": name,
                "figure": example.figure,
                "title": example.expected.title,
                "sentence": example.expected.sentence,
                "picture": f"/v1/examples/{name}/picture",
                "scene": f"/v1/examples/{name}/scene",
            }
            for name, example in (await asyncio.to_thread(by_name)).items()
        ]
    }


@router.get(
    "/v1/examples/{example}/picture",
    summary="The picture of a figure",
    responses=openapi.problems(openapi.PICTURE, 304),
)
async def picture(request: Request, example: Id) -> Response:
    """A PNG file."""
    path = (await _found(example)).picture
    answer = FileResponse(path, media_type="image/png", headers={"cache-control": "no-cache"}, stat_result=path.stat())
    if request.headers.get("if-none-match") == answer.headers["etag"]:
        return Response(status_code=304, headers={"etag": answer.headers["etag"]})
    return answer


@router.get("/v1/examples/{example}/scene", summary="The scene of a figure", **openapi.example_scene())
async def scene(request: Request, example: Id) -> Response:
    """A body for `POST /v1/sessions`. If the figure gives no time step and the default would be unstable, it has a
    stable one."""
    name = (await _found(example)).name
    pool, settings = request.app.state.pool, request.app.state.settings
    with pool.place():
        job = Job("example", {"name": name}, b"", settings.file_seconds + settings.grace_seconds)
        return respond(await answered(request, pool.run(job)))


async def _found(name: str) -> Example:
    known = await asyncio.to_thread(by_name)
    if name not in known:
        raise Problem("not-found", "Unknown example; GET /v1/examples lists all.")
    return known[name]
