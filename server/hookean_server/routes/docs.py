"""`/docs/`: the documentation as `make site` has built it. It loads nothing from elsewhere and needs no token."""

from __future__ import annotations

import re
from pathlib import Path

from fastapi import APIRouter, Request
from starlette.responses import RedirectResponse, Response

from hookean_server.http.access import Access, marked
from hookean_server.routes.built_files import FILE, FOLDER, answer

router = APIRouter()

HEADERS = {
    # icons in the style sheets are data; search runs in a worker
    "content-security-policy": "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; "
    "font-src 'self'; connect-src 'self'; worker-src 'self'; frame-ancestors 'none'; base-uri 'none'; "
    "form-action 'none'",
    "referrer-policy": "no-referrer",
    "cache-control": "no-cache",
}
NOT_BUILT = (
    '<!doctype html>\n<html lang="en">\n<meta charset="utf-8">\n<title>hookean documentation</title>\n'
    "<p>The documentation has not been built here: run <code>make site</code> in the checkout, or install a wheel of "
    "hookean, and reload. Its sources are in the folder <code>docs</code>.</p>\n</html>\n"
)


@router.get("/docs", include_in_schema=False)
@marked(Access.OPEN)
async def docs() -> Response:
    """The address of the first page."""
    return _moved("/docs/")


@router.get("/docs/{path:path}", include_in_schema=False)
@marked(Access.OPEN)
async def docs_file(request: Request, path: str) -> Response:
    """A page or a file of the documentation; where it was not built, how to build it."""
    site = Path(request.app.state.settings.site)
    if path in ("", "index.html") and not (site / "index.html").is_file():
        return Response(NOT_BUILT, media_type="text/html", headers=HEADERS)
    if path == "" or path.endswith("/"):
        return answer(request, site, f"{path}index.html", HEADERS)
    if not re.fullmatch(FOLDER + FILE, path, re.ASCII):
        answer(request, site, f"{path}/index.html", HEADERS)  # raises where there is no such page
        return _moved(f"/docs/{path}/")
    return answer(request, site, path, HEADERS)


def _moved(to: str) -> Response:
    return RedirectResponse(to, status_code=307, headers=HEADERS)
