"""`hookean.show`: finds the service of this user, or starts it, and opens the studio on what a program shows."""

from __future__ import annotations

import os
import re
import secrets
import subprocess
import sys
import tempfile
import time
from typing import Any
from urllib.parse import quote

from hookean.errors import InputError
from hookean.running.showing import View
from hookean_server.lifecycle.discovery import Distrusted, Found, check, find, folder
from hookean_server.lifecycle.studio import STARTED, Refused, open_page
from hookean_server.lifecycle.view import Page, Shown

_children: list[subprocess.Popen[str]] = []  # services that were started here: known until this program ends
IDLE = 60.0  # minutes without use after which a service that was started here ends


def show(scene: Shown, name: str, browser: bool | None) -> View:
    """See `hookean.show`."""
    if name and not re.fullmatch(r"[A-Za-z0-9._:~-]{1,160}", name):
        raise InputError("name", f"{name[:40]!r} given; give 1 to 160 letters, digits and . _ : ~ -")
    try:
        check(folder())
    except Distrusted as error:
        raise ConnectionError(str(error)) from None
    found = find(folder()) or _started()
    page = Page(found, name or f"python-{secrets.token_hex(6)}")
    page.begin(scene)
    if browser or (browser is None and not _is_notebook()):
        _open(found, page)
    return page


def _started() -> Found:
    """The service, started as `hookean serve` starts it, apart from this program."""
    command = [sys.executable, "-m", "hookean.cli", "serve", "--any-port", "--idle-exit", str(IDLE)]
    apart: dict[str, Any] = {"creationflags": 0x08000200} if os.name == "nt" else {"start_new_session": True}
    until = time.monotonic() + STARTED
    with tempfile.TemporaryFile("w+") as said:
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=said, stderr=said, **apart)
        _children.append(process)
        while (found := find(folder())) is None and time.monotonic() < until and not process.poll():
            time.sleep(0.05)
        if found is None:
            said.seek(0)
            lines = said.read().strip().splitlines() or ["it does not answer."]
            raise ConnectionError(f"The service could not be started: {lines[-1]}")
    return found


def _open(found: Found, page: Page) -> None:
    """Open a browser on it, or print the address if this machine has no browser."""
    try:
        if open_page(found, f"&s={quote(page.key)}"):
            return
    except Refused as error:
        raise ConnectionError(str(error)) from None
    print(f"No browser could be opened; open {page.url} in one. `hookean token` prints the token that it asks for.")


def _is_notebook() -> bool:
    """Whether what runs this shows `_repr_html_` of the last line."""
    shell = getattr(sys.modules.get("IPython"), "get_ipython", lambda: None)()
    return hasattr(shell, "kernel")
