"""Copies of the store as it was at its last starts, made by SQLite's backup interface beside the running server."""

from __future__ import annotations

import logging
import os
import sqlite3
import threading
from contextlib import closing, suppress
from pathlib import Path

from hookean_server.keeping.opening import BACKUP, reading

COUNT = 3
log = logging.getLogger("hookean.store")


def begin(path: Path, count: int) -> threading.Thread:
    """Make a backup on a thread of its own; the store is used meanwhile."""
    thread = threading.Thread(target=_rotated, args=(path, count), name="hookean-backup", daemon=True)
    thread.start()
    return thread


def _rotated(path: Path, count: int) -> None:
    try:
        rotate(path, count)
    except (OSError, sqlite3.Error) as error:
        log.warning("no backup of the store was made: %s", error)


def rotate(path: Path, count: int) -> bool:
    """Make a backup of what changed since the last one; the oldest beyond `count` go. Whether anything had changed."""
    names = [place(path, number) for number in range(1, count + 1)]
    if names[0].exists() and commit(names[0]) == commit(path):
        return False
    new = path.with_name(f"{path.name}{BACKUP}new")
    write(path, new)
    for older, newer in zip(reversed(names), [*reversed(names[:-1]), new], strict=True):
        if newer.exists():
            os.replace(newer, older)
    return True


def place(path: Path, number: int) -> Path:
    """Where a backup of a store is; the last one is number 1."""
    return path.with_name(f"{path.name}{BACKUP}{number}")


def write(path: Path, target: Path) -> None:
    """A copy of the store at one moment, synced to disk. Raises OSError or sqlite3.Error; nothing is left then."""
    target.unlink(missing_ok=True)
    os.close(os.open(target, os.O_CREAT | os.O_RDWR, 0o600))
    try:
        with closing(reading(path)) as source, closing(sqlite3.connect(target)) as copy:
            source.execute("PRAGMA busy_timeout = 2000")
            source.backup(copy, pages=-1)  # in one go: in steps it would begin again at each write
            copy.execute("PRAGMA journal_mode = DELETE")
        with target.open("rb") as file:
            os.fsync(file.fileno())
    except BaseException:
        target.unlink(missing_ok=True)
        raise


def commit(path: Path) -> str:
    """The number of the last write in a store or a backup; "" where it cannot be read."""
    with suppress(sqlite3.Error), closing(reading(path)) as db:
        return f"{db.marked('store')} {db.marked('commit')}"
    return ""
