"""Files that were built beforehand, as browsers get them: each with its media type and its ETag."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

from fastapi import Request
from starlette.responses import FileResponse, Response

from hookean_server.problems import Problem

KINDS = {
    "html": "text/html",
    "js": "text/javascript",
    "css": "text/css",
    "svg": "image/svg+xml",
    "png": "image/png",
    "woff2": "font/woff2",
    "json": "application/json",
}
"""Media types by the ending of a name; other files are not served. Listed here, as systems disagree about some."""
_PART = r"[\w-][\w.-]*"
FILE = rf"{_PART}\.({'|'.join(KINDS)})"
"""The name of a file, as a pattern: it begins with no dot, so it leads to no folder above."""
FOLDER = rf"(?:{_PART}/)*"


def answer(request: Request, folder: Path, name: str, headers: Mapping[str, str]) -> Response:
    """A file of a folder with these headers; 304 where the client has it. Raises the problem `not-found`."""
    found, file = re.fullmatch(FOLDER + FILE, name, re.ASCII), folder / name
    if found is None or not file.is_file():
        raise Problem("not-found", "There is no such file.")
    full = FileResponse(file, headers=dict(headers), media_type=KINDS[found[1]], stat_result=file.stat())
    if request.headers.get("if-none-match") == full.headers["etag"]:
        return Response(status_code=304, headers={**headers, "etag": full.headers["etag"]})
    return full
