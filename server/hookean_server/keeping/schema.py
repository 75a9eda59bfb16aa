"""Tables of the store. Every row has a checksum, `sum`, over all that was acknowledged of it, and `seq`, the number of
the write: of two versions of a row the one with the larger number is the later one, wherever it was found.
"""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
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
    """One table: `key` and `values` are its columns, apart from `sum` and `seq`; the one that may be large is last."""

    name: str
    key: tuple[str, ...]
    values: tuple[str, ...]
    kind: str
    """What its rows belong to: a session or a job."""

    @property
    def of(self) -> str:
        """The column with the key of the session or job that a row belongs to."""
        return "job" if "job" in self.columns else self.key[0]

    @cached_property
    def columns(self) -> tuple[str, ...]:
        """All columns, in the order of the file."""
        return (*self.key, "sum", "seq", *self.values)

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


TABLES = {
    table.name: table
    for table in (
        Table("sessions", ("key",), ("since", "label", "nonce", "revision", "particles", "created", "idle"), "session"),
        Table("bases", ("key",), ("since", "number", "revision", "base"), "session"),
        Table("states", ("key",), ("since", "iteration", "status", "message"), "session"),
        Table("shapes", ("key",), ("since", "state"), "session"),
        Table("edits", ("key", "number"), ("since", "revision", "sets", "body"), "session"),
        Table("notes", ("key",), ("since", "sentences"), "session"),
        Table("jobs", ("id",), ("kind", "total", "status", "message", "created", "idle"), "job"),
        Table("requests", ("job",), ("request",), "job"),
        Table("items", ("job", "number"), ("event", "status", "body"), "job"),
        Table("answers", ("key",), ("job", "digest", "status", "head", "idle", "body"), "job"),
    )
}

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
