"""The store: one SQLite file that outlives the server. Everything acknowledged is in it.

One thread owns the connection; work is a function of it and runs in a transaction, synced to disk before its caller
goes on. A file that cannot be read is put aside and a new one begun. Where the disk is full or fails, work is rolled
back and raises the problem `not-stored`.
"""

from __future__ import annotations

import asyncio
import logging
import os
import queue
import sqlite3
import threading
import time
from collections.abc import Callable
from concurrent.futures import Future
from contextlib import suppress
from pathlib import Path
from typing import Any

from hookean_server.problems import not_stored

log = logging.getLogger("hookean.store")

APPLICATION = 0x686F6F6B  # "hook"
VERSION = 1
SCHEMA = """
CREATE TABLE sessions (
    key TEXT PRIMARY KEY,
    label TEXT NOT NULL,
    base BLOB NOT NULL,          -- a saved simulation: scene, anchors, state
    revision INTEGER NOT NULL,   -- of the last stored edit
    iteration INTEGER NOT NULL,
    status TEXT NOT NULL,
    message TEXT NOT NULL,
    particles INTEGER NOT NULL,
    state BLOB,                  -- the last checkpoint: arrays of the state
    created REAL NOT NULL,
    idle REAL NOT NULL           -- seconds of service since it was last touched
);
CREATE TABLE edits (
    key TEXT NOT NULL REFERENCES sessions(key) ON DELETE CASCADE,
    number INTEGER NOT NULL,
    revision INTEGER NOT NULL,
    sets TEXT NOT NULL,          -- what it sets, if an edit of the same gesture may replace it
    body BLOB NOT NULL,
    PRIMARY KEY (key, number)
);
CREATE TABLE jobs (
    id TEXT PRIMARY KEY,
    kind TEXT NOT NULL,
    request BLOB NOT NULL,
    total INTEGER NOT NULL,
    status TEXT NOT NULL,        -- waiting, running, done, failed, cancelled
    message TEXT NOT NULL,
    created REAL NOT NULL,
    idle REAL NOT NULL
);
CREATE TABLE items (
    job TEXT NOT NULL REFERENCES jobs(id) ON DELETE CASCADE,
    number INTEGER NOT NULL,     -- place in the sweep
    event INTEGER NOT NULL,      -- order of arrival, from 1
    status TEXT NOT NULL,        -- done, failed
    body BLOB NOT NULL,
    PRIMARY KEY (job, number)
);
CREATE TABLE answers (
    key TEXT PRIMARY KEY,        -- of Idempotency-Key and route
    digest TEXT NOT NULL,
    status INTEGER NOT NULL,
    head TEXT NOT NULL,
    body BLOB NOT NULL,
    idle REAL NOT NULL
);
"""
LATER = """
CREATE TABLE IF NOT EXISTS notes (
    key TEXT PRIMARY KEY REFERENCES sessions(key) ON DELETE CASCADE,
    sentences TEXT NOT NULL      -- on the file a session was made of, one in a line
);
CREATE TABLE IF NOT EXISTS creations (
    key TEXT PRIMARY KEY REFERENCES sessions(key) ON DELETE CASCADE,
    nonce TEXT NOT NULL          -- of the creation of the session, part of its ETags
);
"""
"""Tables that files of this version may not have yet; who does not know them leaves them alone."""
Work = Callable[[sqlite3.Connection], Any]


class Store:
    """The file at `path`; none: in memory, for a server that keeps nothing."""

    def __init__(self, path: Path | str | None) -> None:
        self.path = None if path is None else Path(path)
        self.failing = ""
        self.seconds = 0.0  # that the last work took
        self._work: queue.SimpleQueue[tuple[Work, Future[Any]] | None] = queue.SimpleQueue()
        self._thread: threading.Thread | None = None
        self._lock = threading.Lock()

    def start(self) -> None:
        """Open the file, or begin a new one; raises OSError where its folder cannot be written."""
        with self._lock:
            if self._thread is None:
                connection = _opened(self.path)
                self._thread = threading.Thread(target=self._run, args=(connection,), name="hookean-store", daemon=True)
                self._thread.start()

    def close(self) -> None:
        """Finish what is waiting and close the file."""
        with self._lock:
            thread, self._thread = self._thread, None
        if thread is not None:
            self._work.put(None)
            thread.join(2.0)

    def submit(self, work: Work) -> Future[Any]:
        """Run `work` on the store's thread, in a transaction."""
        self.start()
        future: Future[Any] = Future()
        self._work.put((work, future))
        return future

    async def run(self, work: Work) -> Any:
        """What `work` returns, once it is on disk. Raises the problem `not-stored`."""
        return await asyncio.wrap_future(self.submit(work))

    def _run(self, connection: sqlite3.Connection) -> None:
        while (task := self._work.get()) is not None:
            work, future = task
            if not future.set_running_or_notify_cancel():
                continue
            began = time.perf_counter()
            try:
                found = _transaction(connection, work)
            except sqlite3.Error as error:
                self.failing = str(error)
                log.error("not stored: %s", error)
                future.set_exception(not_stored(error))
            except BaseException as error:
                future.set_exception(error)
            else:
                self.failing = ""
                future.set_result(found)
            self.seconds = time.perf_counter() - began
        with suppress(sqlite3.Error):
            connection.close()


def _transaction(connection: sqlite3.Connection, work: Work) -> Any:
    connection.execute("BEGIN IMMEDIATE")
    try:
        found = work(connection)
        connection.execute("COMMIT")
        return found
    except BaseException:
        if connection.in_transaction:
            connection.execute("ROLLBACK")
        raise


def _opened(path: Path | None) -> sqlite3.Connection:
    if path is None:
        return _prepared(sqlite3.connect(":memory:", check_same_thread=False, isolation_level=None))
    path.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
    try:
        return _checked(path)
    except (sqlite3.DatabaseError, UnicodeDecodeError) as error:  # what is wrong may be told in damaged words
        if isinstance(error, sqlite3.OperationalError) and not _damaged(error):
            raise OSError(f"{path} cannot be opened ({error})") from None
        aside = path.with_name(f"{path.name}.damaged-{time.strftime('%Y%m%d-%H%M%S')}-{os.getpid()}")
        log.error("%s cannot be read (%s); it is kept as %s and a new one begun", path.name, error, aside.name)
        for end in ("-wal", "-shm"):
            with suppress(OSError):
                path.with_name(path.name + end).replace(aside.with_name(aside.name + end))
        path.replace(aside)
        return _checked(path)


def _damaged(error: sqlite3.Error) -> bool:
    words = ("malformed", "not a database", "no such", "has no column", "corrupt", "already exists")
    return any(word in str(error) for word in words)


def _checked(path: Path) -> sqlite3.Connection:
    fresh = not path.exists()
    if fresh:
        os.close(os.open(path, os.O_CREAT | os.O_RDWR, 0o600))
    connection = sqlite3.connect(path, check_same_thread=False, isolation_level=None)
    try:
        connection.text_factory = lambda text: text.decode("utf-8", "replace")
        found = connection.execute("PRAGMA integrity_check(1)").fetchone()
        if found != ("ok",) or connection.execute("PRAGMA foreign_key_check").fetchone():
            raise sqlite3.DatabaseError("malformed: its parts do not fit together")
        (version,) = connection.execute("PRAGMA user_version").fetchone()
        (application,) = connection.execute("PRAGMA application_id").fetchone()
        if version not in (0, VERSION) or (version and application != APPLICATION):
            raise sqlite3.DatabaseError(f"malformed: version {version} of application {application:#x}")
        return _prepared(connection, version)
    except BaseException:
        connection.close()
        raise


def _prepared(connection: sqlite3.Connection, version: int = 0) -> sqlite3.Connection:
    connection.execute("PRAGMA journal_mode = WAL")
    connection.execute("PRAGMA synchronous = FULL")
    connection.execute("PRAGMA foreign_keys = ON")
    connection.execute("PRAGMA busy_timeout = 2000")
    if version == 0:
        script = f"BEGIN;{SCHEMA}PRAGMA application_id = {APPLICATION};PRAGMA user_version = {VERSION};COMMIT;"
        connection.executescript(script)
    else:
        for table in ("sessions", "edits", "jobs", "items", "answers"):
            connection.execute(f"SELECT * FROM {table} LIMIT 0")
    connection.executescript(LATER)
    return connection
