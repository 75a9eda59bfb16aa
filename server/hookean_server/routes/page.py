"""The page: its built files as browsers get them. It loads nothing from elsewhere. No other page shows it, but those of
this machine for which a client with the token has asked for it."""

from __future__ import annotations

import hmac
import re
from pathlib import Path

from fastapi import APIRouter, Request
from starlette.responses import Response

from hookean_server.http.access import Access, marked
from hookean_server.problems import Problem
from hookean_server.routes.built_files import FILE, answer

router = APIRouter()

NAME = re.compile(rf"(assets/)?{FILE}", re.ASCII)
HEADERS = {
    "content-security-policy": "default-src 'self'; connect-src 'self' ws://127.0.0.1:* ws://localhost:*; "
    "img-src 'self' data: blob:; frame-ancestors 'none'; base-uri 'none'",
    "referrer-policy": "no-referrer",
    "x-content-type-options": "nosniff",
}
LOCAL = "http://127.0.0.1:* http://localhost:*"  # such as notebooks
FOR_EVER = "public, max-age=31536000, immutable"
NOT_BUILT = (
    '<!doctype html>\n<html lang="en">\n<meta charset="utf-8">\n<title>hookean</title>\n<p>The page of hookean is not '
    "built: run <code>python hatch_build.py</code> in the checkout, or install hookean, and reload.</p>\n"
    "</html>\n"
)


@router.get("/page/{path:path}", include_in_schema=False)
@marked(Access.OPEN)
async def page_file(request: Request, path: str) -> Response:
    """A file of the page."""
    return _answer(request, path)


def start_page(request: Request) -> Response:
    """The page itself; where it was not built, how to build it."""
    try:
        shown = _answer(request, "index.html")
    except Problem:
        shown = Response(NOT_BUILT, media_type="text/html", headers={**HEADERS, "cache-control": "no-cache"})
    shown.headers["vary"] = "Accept"
    frame, known = request.query_params.get("frame", ""), request.app.state.tokens.frame
    if hmac.compare_digest(frame.encode(), known.encode()):
        policy = shown.headers["content-security-policy"]
        shown.headers["content-security-policy"] = policy.replace("frame-ancestors 'none'", f"frame-ancestors {LOCAL}")
    return shown


def _answer(request: Request, name: str) -> Response:
    """A file in the page's folder or its folder `assets`, whose names change with what is in them."""
    found = NAME.fullmatch(name)
    if found is None:
        raise Problem("not-found", "This file does not exist.")
    headers = {**HEADERS, "cache-control": FOR_EVER if found[1] else "no-cache"}
    return answer(request, Path(request.app.state.settings.page), name, headers)
