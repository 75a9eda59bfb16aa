"""The store: one SQLite file that outlives the server. Everything acknowledged is in it, and named in its manifest.

One thread owns the connection; work is a function of it and runs in a transaction, synced to disk before its caller
goes on. The write-ahead log is emptied into the file whenever the store is idle, and at most 1 MB or 10 s behind. How a
file is checked and repaired at the start is in `keeping.opening`. Where the disk is full or fails, work is rolled back
and raises the problem `not-stored`.
"""

from __future__ import annotations

import asyncio
import logging
import queue
import sqlite3
import threading
import time
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path
from typing import Any

from hookean_server.keeping import backups
from hookean_server.keeping.budget import Budget
from hookean_server.keeping.database import Database
from hookean_server.keeping.manifest import apply
from hookean_server.keeping.opening import Opened, Report, open_store, reopened, reports
from hookean_server.problems import Problem, not_stored

log = logging.getLogger("hookean.store")

Work = Callable[[Database], Any]
BEHIND = 1 << 20  # bytes that the log may hold before it is emptied into the file
LATE = 10.0  # seconds that it may hold anything
IDLE = 0.5  # seconds without work after which it is emptied
FREE = 256  # pages without use that the file may keep
STEP = 512  # pages by which it shrinks at a time
NEARLY = 0.8  # of the quota: what is reported before it is reached


class Store:
    """The file at `path`, which may take `quota` bytes (0: any number); without a path it is in memory, for a server
    that keeps nothing."""

    def __init__(
        self, path: Path | str | None, quota: int = 0, clock: Callable[[], float] = time.monotonic, keep: int = 0
    ) -> None:
        self.path = None if path is None else Path(path)
        self.quota, self.clock, self.backups = quota, clock, keep
        self.budget = Budget(clock=clock)
        self.failing = ""
        self.note = ""  # what could not be checked at the start
        self.reports: list[Report] = []  # repairs whose copies are still there
        self.size = 0  # bytes in use
        self.seconds = 0.0  # that the last work took
        self._near = False
        self._emptied = 0.0  # when the log was last empty
        self._work: queue.SimpleQueue[tuple[Work, Future[Any]] | None] = queue.SimpleQueue()
        self._thread: threading.Thread | None = None
        self._lock = threading.Lock()

    def start(self) -> None:
        """Open the file, or begin a new one; raises OSError where that is not possible."""
        with self._lock:
            if self._thread is None:
                opened = open_store(self.path)
                opened.db.quota = self.quota
                self.note, self.reports = opened.note, reports(self.path)
                self.size = opened.db.size
                if self.path is not None and self.backups:
                    backups.begin(self.path, self.backups)
                self._thread = threading.Thread(target=self._run, args=(opened,), name="hookean-store", daemon=True)
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
        """What `work` returns, once it is on disk. Raises the problems `not-stored`, `over-quota`, `too-large`."""
        return await asyncio.wrap_future(self.submit(work))

    @property
    def warnings(self) -> list[str]:
        """What a person should know of the store, in sentences that name no session."""
        found = [self.note] if self.note else []
        if self.failing:
            found.append(f"The last write was not stored: {self.failing}.")
        if self._near:
            used, most = self.size / 1e6, self.quota / 1e6
            found.append(f"The store has {used:,.1f} MB of the {most:,.1f} MB it may take; delete sessions or jobs.")
        return found

    def described(self, *, names: bool) -> dict[str, Any]:
        """The store in the answers of routes; `names`: with the repairs, which name sessions."""
        found: dict[str, Any] = {"bytes": self.size, "quota": self.quota}
        repaired = [f"{report.head} The damaged files are kept in {report.copy}." for report in self.reports]
        found["warnings"] = [*repaired, *self.warnings]
        found["losses"] = sum(len(report.losses) for report in self.reports)
        if names:
            found["repairs"] = [asdict(report) for report in self.reports]
        return found

    def _run(self, opened: Opened) -> None:
        writer = _Writer(opened, self.path)
        self._emptied = self.clock()
        while True:
            try:
                task = self._work.get(timeout=IDLE if writer.untidy else None)
            except queue.Empty:
                self._tidy(writer)
                continue
            if task is None:
                break
            work, future = task
            if future.set_running_or_notify_cancel():
                began = time.perf_counter()
                self._do(writer, work, future)
                self.seconds = time.perf_counter() - began
            if writer.log > BEHIND or (writer.behind and self.clock() - self._emptied > LATE):
                self._empty(writer)
        self._empty(writer)
        writer.close()

    def _do(self, writer: _Writer, work: Work, future: Future[Any]) -> None:
        try:
            found = writer.transaction(work)
        except (sqlite3.Error, OSError) as error:
            self.failing = str(error)
            log.error("not stored: %s", error)
            future.set_exception(not_stored(error))
        except BaseException as error:
            if isinstance(error, Problem) and error.slug in ("over-quota", "too-large"):
                log.warning("not stored: %s", error.detail)
            future.set_exception(error)
        else:
            self.failing = ""
            future.set_result(found)

    def _empty(self, writer: _Writer) -> None:
        """Empty the log into the file, and notice how large that has become."""
        with suppress(sqlite3.Error, OSError):
            writer.checkpoint()
            self._emptied = self.clock()
            self.size = writer.db.size
        near = bool(self.quota) and self.size > NEARLY * self.quota
        if near and not self._near:
            log.warning("the store has %d of %d bytes it may take", self.size, self.quota)
        self._near = near

    def _tidy(self, writer: _Writer) -> None:
        """What is done while nobody waits: the log is emptied, the file shrinks, the manifest is written again."""
        self._empty(writer)
        with suppress(sqlite3.Error, OSError):
            while self._work.empty() and writer.shrink():
                self._empty(writer)
            writer.tidy()
        writer.untidy = writer.behind or not self._work.empty()


def _file(path: Path) -> tuple[int, int] | None:
    """Which file is at a path."""
    try:
        found = path.stat()
    except FileNotFoundError:
        return None
    return found.st_dev, found.st_ino


class _Writer:
    """The connection of an open store, and its manifest."""

    def __init__(self, opened: Opened, path: Path | None) -> None:
        self._path = path
        self._log = None if path is None else path.with_name(path.name + "-wal")
        self._take(opened)
        self.behind = self.untidy = False
        self._sync = ThreadPoolExecutor(1, "hookean-manifest")

    def _take(self, opened: Opened) -> None:
        self.db, self.manifest = opened.db, opened.manifest
        self._file = None if self._path is None else _file(self._path)

    def _present(self) -> None:
        """A file that was deleted while it is open takes writes that nobody would find again."""
        if self._path is not None and _file(self._path) != self._file:
            quota = self.db.quota
            self._take(reopened(self._path, Opened(self.db, self.manifest)))
            self.db.quota = quota

    def transaction(self, work: Work) -> Any:
        """What `work` returns, once all it wrote is on disk; where it raises nothing has changed."""
        self._present()
        db = self.db
        db.touched, changes = {}, db.total_changes
        db.execute("BEGIN IMMEDIATE")
        try:
            found = work(db)
            self._commit()
            if self._log is not None and db.total_changes != changes:
                self.behind = self.untidy = True
            return found
        except BaseException:
            if db.in_transaction:
                db.execute("ROLLBACK")
            raise

    def _commit(self) -> None:
        """The manifest names the write before it is committed, and both are synced side by side."""
        db, changes = self.db, self.db.settle()
        if not changes or self.manifest is None:
            db.execute("COMMIT")
            apply(db.owners, changes)
            return
        db.mark("commit", self.manifest.commit + 1)
        db.mark("seq", db.seq)
        self.manifest.prepare(changes)
        synced = self._sync.submit(self.manifest.sync)
        try:
            db.execute("COMMIT")
        except BaseException:
            synced.exception()
            self.manifest.undo()
            raise
        self.manifest.done(changes)  # which are the owners of `db` as well
        if (error := synced.exception()) is not None:
            log.warning("the manifest is not synced: %s", error)

    @property
    def log(self) -> int:
        """Bytes of the write-ahead log."""
        if not self.behind or self._log is None:
            return 0
        try:
            return self._log.stat().st_size
        except OSError:
            return 0

    def checkpoint(self) -> None:
        """Empty the log into the file. Where somebody reads the file, the next time does it."""
        self.db.execute("PRAGMA busy_timeout = 0")
        try:
            busy = self.db.execute("PRAGMA wal_checkpoint(TRUNCATE)").fetchone()[0]
        finally:
            self.db.execute("PRAGMA busy_timeout = 2000")
        self.behind = bool(busy)

    def shrink(self) -> bool:
        """Give some pages without use back to the system; whether there were any."""
        (free,) = self.db.execute("PRAGMA freelist_count").fetchone()
        if free <= FREE:
            return False
        # `execute` would free one page: it stops at the first step of a statement without columns
        self.db.executescript(f"PRAGMA incremental_vacuum({min(STEP, free - FREE // 2)})")
        return True

    def tidy(self) -> None:
        """Write the manifest again, once most of it no longer counts."""
        if self.manifest is not None and self.manifest.grown:
            self.manifest.rewrite()

    def close(self) -> None:
        """Close the file and its manifest."""
        self._sync.shutdown()
        with suppress(sqlite3.Error):
            self.db.close()
        if self.manifest is not None:
            self.manifest.close()
