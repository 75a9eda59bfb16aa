"""`hookean studio`: joins or starts the service, makes a session of a file, and opens it in a browser."""

from __future__ import annotations

import hashlib
import html
import http.client
import io
import json
import os
import re
import secrets
import sys
import tempfile
import threading
import time
import webbrowser
import zipfile
import zlib
from contextlib import suppress
from pathlib import Path
from typing import Annotated, Any, TypeGuard
from urllib.parse import quote

import typer

from hookean.commands.command import new
from hookean_server.http import packing
from hookean_server.lifecycle import command
from hookean_server.lifecycle.discovery import Distrusted, Found, ask, check, find, folder, proven

STARTED = 60.0  # seconds a server may take to start; kernels may have to be compiled first
READ = 240.0  # seconds it may take to read a file
PAUSE = 0.2  # seconds between looks whether a page has logged in
VIEW = "view.json"  # the part of a saved model that has how it was looked at
LONGEST_VIEW = 60_000  # characters of an address, which every browser takes
DOOR = "open-"  # what names of files begin with that lead a browser to the page
REDIRECT = """<!doctype html>
<html lang="en">
<meta charset="utf-8">
<meta name="referrer" content="no-referrer">
<title>hookean studio</title>
<meta http-equiv="refresh" content="0; url={address}">
<p><a href="{address}">Open the studio</a></p>
</html>
"""


class Refused(Exception):
    """A file that cannot be opened; the sentence gives the reason."""


app = new()


@app.command()
def studio(
    file: Annotated[
        Path | None, typer.Argument(help=".3dm, .obj, .json, .npz or .hookean file to open; default: the start page")
    ] = None,
    no_browser: Annotated[bool, typer.Option("--no-browser", help="Only print the address")] = False,
) -> None:
    """View and edit simulations in a browser. Starts the service, or joins the running one.

    A .json file holds a scene or COMPAS documents; geometry without forces is read as drawn. An unchanged file opens
    as you left it. The part after the # of the address authenticates the browser: do not share it.
    """
    raise typer.Exit(run(file, not no_browser))


def run(file: Path | None, browser: bool) -> int:
    """Show a file, or the start page, in a browser; without `browser` only its address. The exit code: that of the
    server if one was started for it, 2 if the file cannot be opened, else 0."""
    try:
        check(folder())
    except Distrusted as error:
        return command.refuse(str(error))
    try:
        data = None if file is None else file.read_bytes()
    except OSError as error:
        from hookean.files.readers import endings

        return command.refuse(f"{file} cannot be read ({error.strerror}); give a {endings()} file.")
    if (found := find(folder())) is not None:
        return _show(found, file, data, browser)
    return _served(file, data, browser)


def _served(file: Path | None, data: bytes | None, browser: bool) -> int:
    """Serve until a stop is requested; the page is opened once the server answers."""
    codes: list[int] = []
    over = threading.Event()

    def show() -> None:
        until = time.monotonic() + STARTED
        while (found := find(folder())) is None:
            if over.wait(0.05) or time.monotonic() > until:
                return
        codes.append(_show(found, file, data, browser))
        if codes[0] and not over.is_set():
            ask(found, "POST", "/v1/shutdown")

    shown = threading.Thread(target=show, name="hookean-studio", daemon=True)
    shown.start()
    code = command.run(command.Options(any_port=True))
    over.set()
    shown.join(1.0 if code else READ)
    return code or next(iter(codes), 0)


def _show(found: Found, file: Path | None, data: bytes | None, browser: bool) -> int:
    """Open the page of a server; with a file, on a session of it."""
    session = ""
    if file is not None and data is not None:
        try:
            key, notes, new = opened(found, file, data)
        except Refused as error:
            return command.refuse(str(error))
        view, left_out = view_in(data) if new else ("", "")
        for note in [*notes, *filter(None, [left_out])]:
            print(f"{file.name}: {note}", file=sys.stderr)
        session = f"&s={quote(key)}{view}"
    address = f"{found.url}/#t={quote(found.token)}{session}"
    if not browser:
        print(address, flush=True)
        return 0
    try:
        if open_page(found, session):
            return 0
    except Refused as error:
        return command.refuse(str(error))
    print(f"No browser could be opened; open this address in one:\n{address}", flush=True)
    return 0


def open_page(found: Found, session: str) -> bool:
    """Whether a browser was opened. It is given a file that only this user can read, which leads it to the page with a
    code that is valid for one log-in: every user of this machine can read the arguments of a program. The file exists
    until the code is used or expires."""
    made = ask(found, "POST", "/v1/login/codes")
    if made is None:
        raise Refused(f"The service at {found.url} does not answer; try again.")
    _sweep()
    code, until = str(made["code"]), time.monotonic() + float(made["seconds"])
    handle, name = tempfile.mkstemp(dir=folder(), prefix=DOOR, suffix=".html")  # made with mode 0600
    path = Path(name)
    try:
        with os.fdopen(handle, "w", encoding="utf-8") as file:
            file.write(REDIRECT.format(address=html.escape(f"{found.url}/#t={quote(code)}{session}")))
        if not webbrowser.open(path.as_uri()):
            return False
        print(f"The studio is open in a browser, at {found.url}.", flush=True)
        with suppress(KeyboardInterrupt):
            if not _used(found, code, until):
                print(
                    "The browser has not logged in; open the address that `hookean token --url` prints.",
                    file=sys.stderr,
                )
        return True
    finally:
        path.unlink(missing_ok=True)


def _used(found: Found, code: str, until: float) -> bool:
    """Wait until a code was used, or the server has ended; returns whether it was in time."""
    known = hashlib.sha256(code.encode()).hexdigest()
    while ask(found, "GET", f"/v1/login/codes/{known}") is not None:
        if time.monotonic() > until - 2 * PAUSE:
            return False
        time.sleep(PAUSE)
    return True


def _sweep() -> None:
    """Remove the files of commands that were killed; their codes are of no use any more."""
    for path in folder().glob(f"{DOOR}*.html"):
        with suppress(OSError):
            if time.time() - path.stat().st_mtime > 10 * STARTED:
                path.unlink()


def view_in(data: bytes) -> tuple[str, str]:
    """How a saved model was looked at, as the part of the page's address from which the page takes it, "" for a file
    without a view; and a sentence where it is too long for an address, else ""."""
    if not zipfile.is_zipfile(io.BytesIO(data)):
        return "", ""
    with (
        suppress(zipfile.BadZipFile, KeyError, ValueError, NotImplementedError, zlib.error),
        zipfile.ZipFile(io.BytesIO(data)) as parts,
    ):
        view = json.loads(parts.read(VIEW))
        if isinstance(view, dict) and view:
            told = packing.packed(json.dumps(stepped(view), separators=(",", ":")))
            if len(told) <= LONGEST_VIEW:
                return f"&v={told}", ""
            return (
                "",
                "the view is too long for an address; drop the file on the studio's page to see it as it was saved",
            )
    return "", ""


def stepped(view: dict[str, Any]) -> dict[str, Any]:
    """A view with its sets of particles as differences of their numbers, which compress well."""
    groups, marked = view.get("groups"), view.get("marked")
    steps: dict[str, Any] = {}
    if isinstance(groups, dict) and all(map(_is_set, groups.values())):
        steps["groups"] = {name: _steps(group) for name, group in groups.items()}
    if _is_set(marked):
        steps["marked"] = _steps(marked)
    return {**{name: value for name, value in view.items() if name not in steps}, "steps": steps} if steps else view


def _is_set(value: Any) -> TypeGuard[list[int]]:
    return isinstance(value, list) and all(type(one) is int for one in value)


def _steps(particles: list[int]) -> list[int]:
    return [one - before for one, before in zip(particles, [0, *particles], strict=False)]


def opened(found: Found, file: Path, data: bytes) -> tuple[str, list[str], bool]:
    """The key of a file's session, the notes on the file, and whether the session is new. While the file stays the same
    it has the same session, with the edits made there. Raises Refused."""
    content = hashlib.sha256(str(file.resolve()).encode() + b"\0" + data).hexdigest()[:12]
    key = f"{re.sub(r'[^A-Za-z0-9._-]+', '-', file.stem)[:80]}-{content}"
    if ask(found, "GET", f"/v1/sessions/{key}") is not None:
        return key, [], False
    body, kind = form(file.name, data)
    address = f"/v1/sessions/{key}?label={quote(file.name[:200])}"
    status, value = request(found, "PUT", address, body, kind)
    if status not in (200, 201):
        said = re.sub(r"^/file:? ?", "", str(value.get("detail")))
        raise Refused(f"{file.name}{' ' if said.startswith('has ') else ': '}{said}")
    return key, [str(note) for note in value.get("warnings", [])], True


def form(file: str, data: bytes) -> tuple[bytes, str]:
    """A form with a file, and its media type."""
    boundary = secrets.token_hex(16)
    name = re.sub(r'[^ -~]|["\\]', "_", file)
    head = f'--{boundary}\r\nContent-Disposition: form-data; name="file"; filename="{name}"\r\n\r\n'
    body = b"".join([head.encode(), data, f"\r\n--{boundary}--\r\n".encode()])
    return body, f"multipart/form-data; boundary={boundary}"


def request(
    found: Found, method: str, path: str, body: bytes = b"", kind: str = "application/json"
) -> tuple[int, dict[str, Any]]:
    """The status and the JSON object that a server answers to its user; empty without a body. Raises Refused where it
    does not answer."""
    headers = {"authorization": f"Bearer {found.token}", "content-type": kind}
    connection = proven(found, READ)
    try:
        if connection is not None:
            connection.request(method, path, body or None, headers)
            answer = connection.getresponse()
            data = answer.read()
            return answer.status, json.loads(data) if data else {}
    except (OSError, http.client.HTTPException, ValueError):
        pass
    finally:
        if connection is not None:
            connection.close()
    raise Refused(f"The service at {found.url} does not answer; try again.")
