"""A connection to the store's file that signs what it writes and notes which sessions and jobs that belongs to."""

from __future__ import annotations

import errno
import os
import shutil
import sqlite3
from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

from hookean_server.keeping.manifest import Key, Owner
from hookean_server.keeping.schema import APPLICATION, PAGE, SCHEMA, STATE, TABLES, VERSION, Table
from hookean_server.problems import Problem

LARGEST = 10**9 - PAGE  # bytes of one value: SQLite's own limit
SPARE = 4 << 20
"""Bytes of the disk that are left for deletions: that of a value of 1 GB puts 600 pages with the numbers of free ones
into the log, before any of its own are free."""
MARK = "INSERT INTO marks VALUES (?, ?) ON CONFLICT (name) DO UPDATE SET value = excluded.value"


class Database(sqlite3.Connection):
    """A connection whose rows are written by `keep` and `change`. What they belong to is in `touched` until the
    transaction ends: the owners as they will be, None for those deleted."""

    owners: dict[Key, Owner]
    touched: dict[Key, Owner | None]
    seq: int
    quota: int
    """Bytes that the file may take; 0: no limit."""
    path: Path | None
    """The file, where the room on its disk is looked at before rows are written."""

    def keep(self, table: str, **values: Any) -> None:
        """Insert a row, or put it in place of the one with its key. Raises the problems `over-quota`, `too-large`, and
        OSError where only what deletions take is left of the disk."""
        found = TABLES[table]
        self.seq += 1
        row = [values.get(name) for name in found.columns]
        row[len(found.key) + 1] = self.seq
        row[len(found.key)] = found.digest(row)
        self._room(found, row)
        self.execute(_upsert(found), row)

    def change(self, table: str, key: Sequence[Any], **values: Any) -> bool:
        """Set some columns of the row of a key; whether there is one."""
        found = TABLES[table]
        where = " AND ".join(f"{name} = ?" for name in found.key)
        row = self.execute(f"SELECT {', '.join(found.columns)} FROM {table} WHERE {where}", tuple(key)).fetchone()
        if row is not None:
            self.keep(table, **{**dict(zip(found.columns, row, strict=True)), **values})
        return row is not None

    def mark(self, name: str, value: object) -> None:
        """Set one of the marks of the file."""
        self.execute(MARK, (name, str(value)))

    def marked(self, name: str) -> str:
        """One of the marks of the file; "" where it has none of this name."""
        found = self.execute("SELECT value FROM marks WHERE name = ?", (name,)).fetchone()
        return "" if found is None else str(found[0])

    @property
    def size(self) -> int:
        """Bytes that the file takes, apart from those that are free in it."""
        pages, free = (self.execute(f"PRAGMA {name}").fetchone()[0] for name in ("page_count", "freelist_count"))
        return int(pages - free) * PAGE

    def _room(self, table: Table, row: list[Any]) -> None:
        last = row[-1]
        if not isinstance(last, bytes):
            return
        if len(last) > LARGEST:
            size, most = len(last) / 1e6, LARGEST / 1e6
            raise Problem("too-large", f"This has {size:,.0f} MB; one scene or result may have {most:,.0f} MB.")
        self._fits(len(last))
        if not self.quota or self.size + len(last) <= self.quota:
            return
        used = self.size
        where = " AND ".join(f"{name} = ?" for name in table.key)
        query = f"SELECT length({table.columns[-1]}) FROM {table.name} WHERE {where}"
        before = self.execute(query, row[: len(table.key)]).fetchone()
        if used + len(last) - (before[0] or 0 if before else 0) > self.quota:
            said = (
                f"The store has {used / 1e6:,.1f} MB of the {self.quota / 1e6:,.1f} MB allowed, and this needs "
                f"{len(last) / 1e6:,.1f} MB. Delete sessions or jobs, or raise HOOKEAN_QUOTA."
            )
            raise Problem("over-quota", said)

    def _fits(self, size: int) -> None:
        """Raises OSError where the disk has no room for `size` bytes in the log, for all that is not in the file yet
        there and in the log, and for a deletion: a log that cannot be emptied into its file takes none either."""
        if self.path is None or not self.path.exists():
            return
        pages, free = (self.execute(f"PRAGMA {name}").fetchone()[0] for name in ("page_count", "freelist_count"))
        grown = pages * PAGE + max(size - free * PAGE, 0) - self.path.stat().st_size
        if shutil.disk_usage(self.path.parent).free < size + 2 * max(grown, 0) + SPARE:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(self.path))

    def watch(self, owners: dict[Key, Owner]) -> None:
        """Note from now on what writes belong to. `owners` is what there is."""
        self.owners, self.touched = owners, {}
        self.create_function("note", 6, self._note)
        self.create_function("name", 4, self._name)
        for table in TABLES.values():
            for event, row in (("INSERT", "NEW"), ("UPDATE OF sum", "NEW"), ("DELETE", "OLD")):
                self.execute(_trigger(table, event, row))

    def _note(self, kind: str, key: str, part: str, old: bytes | None, new: bytes | None, seq: int) -> None:
        self._touched(kind, key).turn(part, old, new, seq)

    def _name(self, kind: str, key: str, label: str | None, revision: int) -> None:
        owner = self._touched(kind, key)
        if label is not None:
            owner.label, owner.revision = label, revision

    def _touched(self, kind: str, key: str) -> Owner:
        owner = self.touched.get((kind, key))
        if owner is None:
            owner = self.touched[kind, key] = replace(self.owners.get((kind, key), Owner()))
        return owner

    def settle(self) -> dict[Key, Owner | None]:
        """What the transaction changes: the owners as they will be, None for those of which nothing is left."""
        return {key: owner if owner is not None and owner.count else None for key, owner in self.touched.items()}


@cache
def _upsert(table: Table) -> str:
    names, key = table.columns, ", ".join(table.key)
    sets = ", ".join(f"{name} = excluded.{name}" for name in names if name not in table.key)
    marks = ", ".join("coalesce(?, 0)" if name == "idle" else "?" for name in names)
    return f"INSERT INTO {table.name} ({', '.join(names)}) VALUES ({marks}) ON CONFLICT ({key}) DO UPDATE SET {sets}"


def _trigger(table: Table, event: str, row: str) -> str:
    key = f"{row}.{table.of}"
    old = "NULL" if event == "INSERT" else "OLD.sum"
    new, seq = ("NULL", "0") if event == "DELETE" else ("NEW.sum", "NEW.seq")
    part = "state" if table.name in STATE else "row"
    said = f"SELECT note('{table.kind}', {key}, '{part}', {old}, {new}, {seq});"
    if table.name in ("sessions", "jobs") and event != "DELETE":
        shown = "NEW.label, NEW.revision" if table.name == "sessions" else "NEW.kind, 0"
        said += f" SELECT name('{table.kind}', {key}, {shown});"
    name = f"noted_{table.name}_{event.split()[0].lower()}"
    return f"CREATE TEMP TRIGGER {name} AFTER {event} ON main.{table.name} BEGIN {said} END"


def connect(path: Path | None) -> Database:
    """A connection to a file, or to one in memory."""
    name = ":memory:" if path is None else str(path)
    db = sqlite3.connect(name, check_same_thread=False, isolation_level=None, factory=Database)
    db.text_factory = lambda text: text.decode("utf-8", "replace")
    db.seq, db.quota, db.path, db.owners, db.touched = 0, 0, None, {}, {}
    return db


def create(db: Database, store: str) -> None:
    """Make the tables of a new file."""
    db.execute("PRAGMA auto_vacuum = INCREMENTAL")
    head = f"PRAGMA application_id = {APPLICATION};PRAGMA user_version = {VERSION};"
    db.executescript(f"BEGIN;{SCHEMA}{head}COMMIT;")
    for name, value in (("store", store), ("commit", 0)):
        db.mark(name, value)


def prepare(db: Database) -> None:
    """Set a connection up for writing."""
    for pragma in (
        "journal_mode = WAL",
        "secure_delete = FAST",  # some builds write zeros over what is deleted: as much in the log as a session had
        "synchronous = FULL",
        "foreign_keys = ON",
        "busy_timeout = 2000",
        "wal_autocheckpoint = 0",
        "temp_store = MEMORY",  # of pages that a statement changes SQLite keeps copies meanwhile
        "cache_spill = OFF",  # nothing of a write is in the log before the manifest names it
    ):
        db.execute(f"PRAGMA {pragma}")


def owners(db: Database) -> tuple[dict[Key, Owner], int]:
    """What there is of each session and job in a file, and the number of the last row."""
    found: dict[Key, Owner] = {}
    last = 0
    for table in TABLES.values():
        part = "state" if table.name in STATE else "row"
        for key, sum, seq in db.execute(f"SELECT {table.of}, sum, seq FROM {table.name}"):
            found.setdefault((table.kind, key), Owner()).turn(part, None, sum, seq)
            last = max(last, seq)
    for key, label, revision in db.execute("SELECT key, label, revision FROM sessions"):
        found["session", key].label, found["session", key].revision = label, revision
    for key, kind in db.execute("SELECT id, kind FROM jobs"):
        found["job", key].label = kind
    return found, last
