"""Hops' own calls: GET / lists the functions, GET /<name> describes one, POST /solve runs one. Without a token, for
Hops knows none; so these are pure functions, and pages of any origin are refused.
"""

from __future__ import annotations

from typing import Any

from fastapi import APIRouter, Request
from starlette.responses import JSONResponse, Response

from hookean_server.hops.functions import FUNCTIONS
from hookean_server.http import openapi
from hookean_server.http.access import Access, marked
from hookean_server.http.handling import compute_for_anyone
from hookean_server.problems import Problem
from hookean_server.routes.page import start_page
from hookean_server.workers.discretize_task import uses_rhino

router = APIRouter(tags=["hops"])


@router.get("/", summary="The page, or Hops' list of functions", **openapi.hops_list())
@marked(Access.HOPS)
async def root(request: Request) -> Response:
    """Browsers, which ask for text/html, get the page; Hops, which names no type, gets its functions."""
    if "text/html" in request.headers.get("accept", ""):
        return start_page(request)
    return JSONResponse([function.described(name) for name, function in FUNCTIONS.items()], headers={"vary": "Accept"})


@router.post("/solve", summary="Run a function for Hops", **openapi.hops_solve())
@marked(Access.HOPS)
async def solve(request: Request) -> Response:
    """Answers and refusals are both as Hops reads them: `values`, `errors` and `warnings`."""
    settings = request.app.state.settings
    options = {"seconds": settings.solve_seconds, "largest": settings.largest_count, "bytes": settings.visit_limit}
    return await compute_for_anyone(request, "hops", options, once=uses_rhino)


@router.get("/{function}", summary="Hops' description of a function", **openapi.hops_description())
@marked(Access.HOPS)
async def described(function: str) -> dict[str, Any]:
    """Inputs and outputs as Hops reads them."""
    if function == "solve":
        raise Problem("method-not-allowed", "Functions are run with POST /solve.", headers={"allow": "POST"})
    if function not in FUNCTIONS:
        raise Problem("not-found", "There is no function with this name; GET / of this server lists all.")
    return FUNCTIONS[function].described(function)
