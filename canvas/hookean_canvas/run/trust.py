"""Which definitions may be run: their scripts run as the person who runs them, with all that this person may do.

A file is trusted by the digest of its bytes: one that is shipped with hookean, or that the user has trusted once
(`--trust`), which is remembered in the person's data folder; with HOOKEAN_TRUST=1 every file is. The bytes that are
judged are those that are run.
"""

from __future__ import annotations

import hashlib
import os
import stat
import sys
from pathlib import Path

import platformdirs

from hookean.commands.examples import home
from hookean.errors import InputError
from hookean_canvas.run.graph import Graph
from hookean_canvas.run.scripts import SCRIPTS, code_of

VARIABLE = "HOOKEAN_TRUST"
FILE = "trusted-definitions.txt"


def scripts(graph: Graph) -> int:
    """How many components of a definition have code that would run."""
    return sum(node.guid in SCRIPTS and code_of(node) is not None for node in graph.nodes)


def require(graph: Graph, data: bytes, file: Path, given: bool) -> None:
    """Warn that scripts run as the person who runs them; InputError where this file has some and is not trusted.
    `given`: the person trusts it, and it is remembered."""
    count = scripts(graph)
    if not count:
        return
    what = f"its {count} scripts run with your rights" if count > 1 else "its script runs with your rights"
    if not (given or os.environ.get(VARIABLE) == "1" or _is_shipped(data) or digest(data) in _remembered()):
        advice = f"read it with `hookean canvas show --code {file.name}`, then add --trust to run it"
        raise InputError(str(file), f"was not run here before, and {what}; {advice}")
    if given:
        _remember(data)
    print(f"hookean: {file}: {what}", file=sys.stderr, flush=True)


def digest(data: bytes) -> str:
    """What a file is known by: SHA-256, in hex."""
    return hashlib.sha256(data).hexdigest()


def _is_shipped(data: bytes) -> bool:
    """Whether these are the bytes of a definition that was installed with hookean."""
    shipped = [path for path in home().glob("*/definition.gh*") if path.stat().st_size == len(data)]
    return any(digest(path.read_bytes()) == digest(data) for path in shipped)


def _place() -> Path:
    return Path(platformdirs.user_data_dir("hookean", appauthor=False)) / FILE


def _remembered() -> set[str]:
    """The digests in the person's file; none where another user could have written it."""
    flags = os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0)
    try:
        with os.fdopen(os.open(_place(), flags), encoding="ascii") as file:
            about = os.fstat(file.fileno())
            ours = not hasattr(os, "getuid") or about.st_uid == os.getuid() and not about.st_mode & 0o022
            return set(file.read().split()) if ours and stat.S_ISREG(about.st_mode) else set()
    except (OSError, ValueError):
        return set()


def _remember(data: bytes) -> None:
    """Add a digest to the person's file; what cannot be remembered is asked again, and that is printed."""
    if digest(data) in _remembered():
        return
    flags = os.O_WRONLY | os.O_APPEND | os.O_CREAT | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0)
    why = "it is not a file that only you can write to"
    try:
        _place().parent.mkdir(parents=True, exist_ok=True, mode=0o700)
        with os.fdopen(os.open(_place(), flags, 0o600), "a", encoding="ascii") as file:
            file.write(digest(data) + "\n")
    except OSError as error:
        why = str(error.strerror)
    if digest(data) not in _remembered():
        print(f"hookean: {_place()} cannot be used ({why}); the next run needs --trust again.", file=sys.stderr)
