"""The page: its built files as browsers get them. It loads nothing from elsewhere and is shown in no other page."""

from __future__ import annotations

import re
from pathlib import Path

from fastapi import APIRouter, Request
from starlette.responses import FileResponse, Response

from hookean_server.http.access import Access, marked
from hookean_server.problems import Problem

router = APIRouter()

KINDS = {
    "html": "text/html",
    "js": "text/javascript",
    "css": "text/css",
    "svg": "image/svg+xml",
    "png": "image/png",
    "woff2": "font/woff2",
    "json": "application/json",
}
"""Media types by the ending of a name; other files are not served. Listed here, as systems differ in some."""
NAME = re.compile(rf"(assets/)?[\w-][\w.-]*\.({'|'.join(KINDS)})", re.ASCII)
HEADERS = {
    "content-security-policy": "default-src 'self'; connect-src 'self' ws://127.0.0.1:* ws://localhost:*; "
    "img-src 'self' data: blob:; frame-ancestors 'none'; base-uri 'none'",
    "referrer-policy": "no-referrer",
    "x-content-type-options": "nosniff",
}
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
        answer = _answer(request, "index.html")
    except Problem:
        answer = Response(NOT_BUILT, media_type="text/html", headers={**HEADERS, "cache-control": "no-cache"})
    answer.headers["vary"] = "Accept"
    return answer


def _answer(request: Request, name: str) -> Response:
    """A file in the page's folder or its folder `assets`, whose names change with what is in them."""
    found = NAME.fullmatch(name)
    file = Path(request.app.state.settings.page) / name
    if found is None or not file.is_file():
        raise Problem("not-found", "This file does not exist.")
    headers = {**HEADERS, "cache-control": FOR_EVER if found[1] else "no-cache"}
    answer = FileResponse(file, headers=headers, media_type=KINDS[found[2]], stat_result=file.stat())
    if request.headers.get("if-none-match") == answer.headers["etag"]:
        return Response(status_code=304, headers={**headers, "etag": answer.headers["etag"]})
    return answer
