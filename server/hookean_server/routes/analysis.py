"""Analyses: one address for each analysis of the table."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Awaitable, Callable, Coroutine
from typing import Any

from fastapi import APIRouter, Request
from starlette.responses import Response

from hookean_server.http import openapi
from hookean_server.http.handling import Run, compute, compute_steps
from hookean_server.routes.relax import Arrays
from hookean_server.workers.analysis_task import ANALYSES
from hookean_server.workers.pool import Reply

router = APIRouter(tags=["analysis"])


def _route(name: str) -> Callable[..., Awaitable[Response]]:
    async def analysis(request: Request, arrays: Arrays = None) -> Response:
        options: dict[str, Any] = {"analysis": name, "arrays": arrays}
        options["seconds"] = request.app.state.settings.solve_seconds
        return await compute(request, "analyse", options)

    analysis.__name__ = name.replace("-", "_")
    analysis.__doc__ = ANALYSES[name].function.__doc__
    return analysis


for _name in ANALYSES:
    router.add_api_route(
        f"/v1/analysis/{_name}",
        _route(_name),
        methods=["POST"],
        summary=ANALYSES[_name].summary,
        **openapi.analysis(_name),
    )


@router.post("/v1/analysis/load-cases", summary="Load cases and combinations on a frozen form", **openapi.load_cases())
async def load_cases(request: Request) -> Response:
    """The form of a scene, frozen, under its load cases and combinations, side by side on the workers: displacements,
    forces, reactions, slack elements and stability of each, and their envelope."""
    seconds = request.app.state.settings.solve_seconds

    async def steps(run: Run, body: bytes) -> Reply:
        head, form, model = (await run("freeze", {"seconds": seconds}, body)).body.split(b"\n")
        names = json.loads(head)["names"]
        cases = await _together([run("case", {"name": name}, model) for name in names])
        return await run("cases", {}, b"\n".join([head, form, *(reply.body for reply in cases)]))

    return await compute_steps(request, steps)


@router.post("/v1/analysis/report", summary="Report of a scene as one HTML page, fit to print", **openapi.report())
async def report(request: Request) -> Response:
    """Loads, cases, largest values and where they are, with pictures, as an HTML page without other files. With load
    cases the form is found and frozen, and all cases are solved; else the scene is relaxed."""
    return await compute(request, "report", {})


@router.post("/v1/analysis/export", summary="Result of a scene as a file for another program", **openapi.export())
async def export(request: Request) -> Response:
    """The relaxed scene, or one load case of it, as DXF, VTU, Abaqus input, IFC or COMPAS JSON."""
    return await compute(request, "export", {"seconds": request.app.state.settings.solve_seconds})


async def _together(running: list[Coroutine[Any, Any, Reply]]) -> list[Reply]:
    """All answers; if one fails or the client leaves, the others are stopped."""
    tasks = [asyncio.ensure_future(one) for one in running]
    try:
        return list(await asyncio.gather(*tasks))
    finally:
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
