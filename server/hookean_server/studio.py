"""What `hookean studio` does: joins or starts the service, makes a session of a file, and opens a browser on it."""

from __future__ import annotations

import hashlib
import http.client
import json
import re
import secrets
import sys
import threading
import time
import webbrowser
from pathlib import Path
from typing import Any
from urllib.parse import quote

from hookean_server.discovery import Found, ask, find, folder

STARTED = 60.0  # seconds a server may take to start; kernels may have to be compiled first
READ = 240.0  # seconds it may take to read a file


class Refused(Exception):
    """Why there is no session of a file, in a sentence."""


def run(file: Path | None, browser: bool) -> int:
    """Show a file, or the start page, in a browser; without `browser` only its address. The exit code: that of the
    server where one was started for it, 2 where the file cannot be opened, else 0."""
    try:
        data = None if file is None else file.read_bytes()
    except OSError as error:
        from hookean.files.readers import endings

        return _say_no(f"{file} cannot be read ({error.strerror}); give a {endings()} file.")
    if (found := find(folder())) is not None:
        return _show(found, file, data, browser)
    return _served(file, data, browser)


def _served(file: Path | None, data: bytes | None, browser: bool) -> int:
    """Serve until told to end; what is to be shown is shown once the server answers."""
    from hookean_server import command

    codes: list[int] = []
    over = threading.Event()

    def show() -> None:
        until = time.monotonic() + STARTED
        while (found := find(folder())) is None:
            if over.wait(0.05) or time.monotonic() > until:
                return
        codes.append(_show(found, file, data, browser))
        if codes[0] and not over.is_set():
            ask(found, "POST", "/v1/shutdown", found.token)

    shown = threading.Thread(target=show, name="hookean-studio", daemon=True)
    shown.start()
    code = command.run(command.Options(any_port=True))
    over.set()
    shown.join(1.0 if code else READ)
    return code or next(iter(codes), 0)


def _show(found: Found, file: Path | None, data: bytes | None, browser: bool) -> int:
    """Open the page of a server; with a file, on a session of it."""
    address = f"{found.url}/#t={quote(found.token)}"
    if file is not None and data is not None:
        try:
            key, notes = opened(found, file, data)
        except Refused as error:
            return _say_no(str(error))
        for note in notes:
            print(f"{file.name}: {note}", file=sys.stderr)
        address += f"&s={quote(key)}"
    if not browser:
        print(address, flush=True)
    elif webbrowser.open(address):
        print(f"The studio is open in a browser, at {found.url}.", flush=True)
    else:
        print(f"No browser could be opened; open this address in one:\n{address}", flush=True)
    return 0


def opened(found: Found, file: Path, data: bytes) -> tuple[str, list[str]]:
    """The key of a file's session and what is to be known of the file. As long as the file stays the same it has the
    same session, with what was changed there by hand. Raises Refused."""
    content = hashlib.sha256(str(file.resolve()).encode() + b"\0" + data).hexdigest()[:12]
    key = f"{re.sub(r'[^A-Za-z0-9._-]+', '-', file.stem)[:80]}-{content}"
    if ask(found, "GET", f"/v1/sessions/{key}", found.token) is not None:
        return key, []
    boundary = secrets.token_hex(16)
    name = re.sub(r'[^ -~]|["\\]', "_", file.name)
    head = f'--{boundary}\r\nContent-Disposition: form-data; name="file"; filename="{name}"\r\n\r\n'
    body = b"".join([head.encode(), data, f"\r\n--{boundary}--\r\n".encode()])
    status, value = _put(found, f"/v1/sessions/{key}?label={quote(file.name[:200])}", body, boundary)
    if status not in (200, 201):
        raise Refused(f"{file.name}: {re.sub(r'^/file:? ?', '', str(value.get('detail')))}")
    return key, [str(note) for note in value.get("warnings", [])]


def _put(found: Found, path: str, body: bytes, boundary: str) -> tuple[int, dict[str, Any]]:
    headers = {"authorization": f"Bearer {found.token}", "content-type": f"multipart/form-data; boundary={boundary}"}
    connection = http.client.HTTPConnection(found.url.split("//")[1].rsplit(":", 1)[0], found.port, timeout=READ)
    try:
        connection.request("PUT", path, body, headers)
        answer = connection.getresponse()
        return answer.status, json.loads(answer.read())
    except (OSError, http.client.HTTPException, ValueError):
        raise Refused(f"The service at {found.url} does not answer; try again.") from None
    finally:
        connection.close()


def _say_no(sentence: str) -> int:
    print(sentence, file=sys.stderr, flush=True)
    return 2
