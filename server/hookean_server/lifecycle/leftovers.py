"""Temporary folders of this package have the number of their process in their name; those of processes that were killed
are taken away at the next start."""

from __future__ import annotations

import atexit
import os
import re
import shutil
import tempfile
from contextlib import suppress
from pathlib import Path

from hookean_server.lifecycle.discovery import alive

DEEPEST = 60
"""Bytes of a folder's path: the path of a socket in a folder of it has at most 103, as macOS allows."""


def prefix() -> str:
    """How the name of a temporary folder of this process begins."""
    return f"hookean-{os.getpid()}-"


def folder_of_sockets() -> str:
    """A new temporary folder of this process, taken away at its end, in which names of sockets are short enough."""
    place = tempfile.gettempdir()
    made = tempfile.mkdtemp(prefix=prefix(), dir=place if len(os.fsencode(place)) <= DEEPEST else "/tmp")
    atexit.register(shutil.rmtree, made, ignore_errors=True)
    return made


def sweep(place: Path | None) -> None:
    """Take away what killed processes of this user have left in the system's temporary folder, and half-written files
    of the folder `place`, whose lock the caller has."""
    me = os.getuid() if hasattr(os, "getuid") else None
    for folder in (f for place in {tempfile.gettempdir(), "/tmp"} for f in Path(place).glob("hookean-*-*")):
        found = re.fullmatch(r"hookean-(\d+)-\w+", folder.name)
        with suppress(OSError):
            mine = me is None or folder.lstat().st_uid == me
            if found and mine and folder.is_dir() and not folder.is_symlink() and not alive(int(found[1])):
                shutil.rmtree(folder, ignore_errors=True)
    for file in place.glob("*.json*.new") if place is not None else ():
        with suppress(OSError):
            file.unlink()
