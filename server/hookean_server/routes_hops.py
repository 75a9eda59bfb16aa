"""Hops' own calls: GET / lists the functions, GET /<name> describes one, POST /solve runs one. Without a token, for
Hops knows none; so these are pure functions, and pages of any origin are refused.
"""

from __future__ import annotations

from typing import Any

from fastapi import APIRouter, Request
from starlette.responses import JSONResponse, Response

from hookean_server import openapi
from hookean_server.handling import compute
from hookean_server.hops import FUNCTIONS
from hookean_server.operations import uses_rhino
from hookean_server.routes_about import page_response

router = APIRouter(tags=["hops"])


@router.get("/", summary="The page, or Hops' list of functions", **openapi.hops_list())
async def root(request: Request) -> Response:
    """A browser, which asks for text/html, gets the page; Hops, which does not say, gets its functions."""
    if "text/html" in request.headers.get("accept", ""):
        answer = page_response("index.html")
    else:
        answer = JSONResponse([function.described(name) for name, function in FUNCTIONS.items()])
    answer.headers["vary"] = "Accept"
    return answer


def _describe(name: str) -> None:
    description = FUNCTIONS[name].described(name)

    @router.get(
        f"/{name}",
        summary=f"Hops' description of {name}",
        operation_id=f"hops_{name}",
        **openapi.hops_description(),
    )
    async def described() -> dict[str, Any]:
        """Inputs and outputs as Hops reads them."""
        return description


for _name in FUNCTIONS:
    _describe(_name)


@router.post("/solve", summary="Run a function for Hops", **openapi.hops_solve())
async def solve(request: Request) -> Response:
    """Answers and refusals are both as Hops reads them: `values`, `errors` and `warnings`."""
    seconds = request.app.state.settings.solve_seconds
    return await compute(request, "hops", {"seconds": seconds}, once=uses_rhino)
