"""Tables of the store. Every row has a checksum, `sum`, over all that was acknowledged of it, and `seq`, the number of
the write: of two versions of a row the one with the larger number is the later one, wherever it was found.
"""

from __future__ import annotations

import hashlib
import sqlite3
from collections.abc import Sequence
from contextlib import closing
from dataclasses import dataclass
from functools import cached_property
from typing import Any

APPLICATION = 0x686F6F6B  # "hook"
VERSION = 2
PAGE = 4096
STATE = ("states", "shapes")
"""Tables of checkpoints, without which a session is whole but for its last shape."""
UNSUMMED = ("sum", "idle")
REALS = ("created", "idle")


@dataclass(frozen=True)
class Table:
    """One table: its key and all of its columns: the key, `sum`, `seq`, and values; one that may be large is last."""

    name: str
    key: tuple[str, ...]
    columns: tuple[str, ...]

    @property
    def kind(self) -> str:
        """What its rows belong to: a session or a job."""
        return "job" if self.name == "jobs" or "job" in self.columns else "session"

    @property
    def of(self) -> str:
        """The column with the key of the session or job that a row belongs to."""
        return "job" if "job" in self.columns else self.key[0]

    @cached_property
    def summed(self) -> tuple[int, ...]:
        """The places of those that the checksum covers."""
        return tuple(i for i, name in enumerate(self.columns) if name not in UNSUMMED)

    def digest(self, row: Sequence[Any]) -> bytes:
        """The checksum of a row (SHA-256): of the table's name and, for each value, its type, length and bytes."""
        digest = hashlib.sha256(self.name.encode())
        for place in self.summed:
            value = row[place]
            if self.columns[place] in REALS:
                value = float(value)
            data = value if isinstance(value, bytes) else b"" if value is None else str(value).encode()
            digest.update(f" {type(value).__name__} {len(data)} ".encode())
            digest.update(data)
        return digest.digest()

    def whole(self, row: Sequence[Any]) -> bool:
        """Whether a row of the file is as it was written."""
        try:
            return bool(row[len(self.key)] == self.digest(row))
        except (TypeError, ValueError):
            return False

    def owner(self, row: Sequence[Any]) -> str:
        """The key of the session or job that a row belongs to."""
        return str(row[self.columns.index(self.of)])


SCHEMA = """
CREATE TABLE sessions (
    key TEXT PRIMARY KEY, sum BLOB NOT NULL, seq INTEGER NOT NULL,
    since INTEGER NOT NULL,      -- the write that gave it its scene: rows of an earlier scene have another number
    label TEXT NOT NULL,
    nonce TEXT NOT NULL,         -- of its creation, part of its ETags
    revision INTEGER NOT NULL,   -- of the last stored edit
    particles INTEGER NOT NULL,
    created REAL NOT NULL,
    idle REAL NOT NULL           -- seconds of service since it was last used
);
CREATE TABLE bases (
    key TEXT PRIMARY KEY REFERENCES sessions(key) ON DELETE CASCADE, sum BLOB NOT NULL, seq INTEGER NOT NULL,
    since INTEGER NOT NULL,
    number INTEGER NOT NULL,     -- edits up to this one are in the base
    revision INTEGER NOT NULL,   -- of the last of them
    base BLOB NOT NULL           -- a saved simulation: scene, anchors, state
);
CREATE TABLE states (
    key TEXT PRIMARY KEY REFERENCES sessions(key) ON DELETE CASCADE, sum BLOB NOT NULL, seq INTEGER NOT NULL,
    since INTEGER NOT NULL,
    iteration INTEGER NOT NULL,
    status TEXT NOT NULL,
    message TEXT NOT NULL
);
CREATE TABLE shapes (            -- apart from what has another length each time: it is then written over in its place
    key TEXT PRIMARY KEY REFERENCES sessions(key) ON DELETE CASCADE, sum BLOB NOT NULL, seq INTEGER NOT NULL,
    since INTEGER NOT NULL,
    state BLOB NOT NULL          -- the last checkpoint: arrays of the state
);
CREATE TABLE edits (
    key TEXT NOT NULL REFERENCES sessions(key) ON DELETE CASCADE, number INTEGER NOT NULL,
    sum BLOB NOT NULL, seq INTEGER NOT NULL,
    since INTEGER NOT NULL,
    revision INTEGER NOT NULL,
    sets TEXT NOT NULL,          -- what it sets, if an edit of the same gesture may replace it
    body BLOB NOT NULL,
    PRIMARY KEY (key, number)
);
CREATE TABLE notes (
    key TEXT PRIMARY KEY REFERENCES sessions(key) ON DELETE CASCADE, sum BLOB NOT NULL, seq INTEGER NOT NULL,
    since INTEGER NOT NULL,
    sentences TEXT NOT NULL      -- on the file a session was made of, one in a line
);
CREATE TABLE jobs (
    id TEXT PRIMARY KEY, sum BLOB NOT NULL, seq INTEGER NOT NULL,
    kind TEXT NOT NULL,
    total INTEGER NOT NULL,
    status TEXT NOT NULL,        -- waiting, running, done, failed, cancelled
    message TEXT NOT NULL,
    created REAL NOT NULL,
    idle REAL NOT NULL
);
CREATE TABLE requests (
    job TEXT PRIMARY KEY REFERENCES jobs(id) ON DELETE CASCADE, sum BLOB NOT NULL, seq INTEGER NOT NULL,
    request BLOB NOT NULL
);
CREATE TABLE items (
    job TEXT NOT NULL REFERENCES jobs(id) ON DELETE CASCADE, number INTEGER NOT NULL, -- place in the sweep
    sum BLOB NOT NULL, seq INTEGER NOT NULL,
    event INTEGER NOT NULL,      -- order of arrival, from 1
    status TEXT NOT NULL,        -- done, failed
    body BLOB NOT NULL,
    PRIMARY KEY (job, number)
);
CREATE INDEX items_by_event ON items (job, event);
CREATE TABLE answers (
    key TEXT PRIMARY KEY, sum BLOB NOT NULL, seq INTEGER NOT NULL, -- of Idempotency-Key and route
    job TEXT NOT NULL REFERENCES jobs(id) ON DELETE CASCADE,
    digest TEXT NOT NULL,
    status INTEGER NOT NULL,
    head TEXT NOT NULL,
    idle REAL NOT NULL,
    body BLOB NOT NULL
);
CREATE INDEX answers_by_job ON answers (job);
CREATE TABLE marks (
    name TEXT PRIMARY KEY,       -- store: its id; commit: number of the last acknowledged write; seq: of the last row
    value TEXT NOT NULL
);
"""


def _tables() -> dict[str, Table]:
    """The tables of the schema, as SQLite reads them."""
    with closing(sqlite3.connect(":memory:")) as db:
        db.executescript(SCHEMA)
        names = [
            name for (name,) in db.execute("SELECT name FROM sqlite_schema WHERE type = 'table' AND name != 'marks'")
        ]
        columns = {name: db.execute("SELECT name, pk FROM pragma_table_info(?)", (name,)).fetchall() for name in names}
    return {
        name: Table(name, tuple(column for column, key in found if key), tuple(column for column, _ in found))
        for name, found in columns.items()
    }


TABLES = _tables()
