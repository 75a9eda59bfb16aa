"""`hookean.show`: opens the studio on a scene from Python, and what a program does with the page afterwards."""

from __future__ import annotations

import re
import secrets
import sys
from collections.abc import Mapping
from typing import Any
from urllib.parse import quote

import hookean_client
from hookean.errors import InputError
from hookean.running.result import Result
from hookean.running.simulation import Simulation
from hookean.scene.scene import Scene
from hookean_server.lifecycle.discovery import find, folder
from hookean_server.lifecycle.studio import Refused, open_page
from hookean_server.lifecycle.view import View

STARTED = 60.0  # seconds a service may take to start; kernels may have to be compiled first
IDLE = 60.0  # minutes without use after which a service that was started here ends


def show(
    scene: Scene | Result | Simulation | Mapping[str, Any], *, name: str = "", browser: bool | None = None
) -> View:
    """Open the studio, the page of the service, on a scene, a result or a simulation; returns its `View`.

    The service of this user is used, or started; it outlives this program, and ends after an hour without use. A result
    is shown in its shape, a simulation as it stands. The same `name` (letters, digits and . _ : ~ -) shows the next
    scene in the same page. `browser`: whether to open a browser; None: unless this is a notebook, where the last line
    of a cell shows the page below it.

    Raises InputError for an invalid scene or name, ConnectionError where no service can be started or none answers.
    """
    if name and not re.fullmatch(r"[A-Za-z0-9._:~-]{1,160}", name):
        raise InputError("name", f"{name[:40]!r} given; give 1 to 160 letters, digits and . _ : ~ -")
    view = View(_service(), name or f"python-{secrets.token_hex(6)}")
    view.update(scene)
    if browser or (browser is None and not _is_notebook()):
        _open(view)
    return view


def _service() -> hookean_client.Client:
    """A client of the service of this user, which is started where none runs."""
    try:
        return hookean_client.connect(python=sys.executable, timeout=STARTED, folder=str(folder()), parent=0, idle=IDLE)
    except hookean_client.Problem as problem:
        raise ConnectionError(problem.detail) from None


def _open(view: View) -> None:
    """Open a browser on it; where there is none, print the address."""
    found = find(folder())
    try:
        if found is not None and open_page(found, f"&s={quote(view.key)}"):
            return
    except Refused as error:
        raise ConnectionError(str(error)) from None
    print(f"No browser could be opened; open {view.url} in one. `hookean token` prints the token that it asks for.")


def _is_notebook() -> bool:
    """Whether what runs this shows `_repr_html_` of the last line."""
    shell = getattr(sys.modules.get("IPython"), "get_ipython", lambda: None)()
    return hasattr(shell, "kernel")
