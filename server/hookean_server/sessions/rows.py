"""Sessions in the store: what is written and read, each a function of the connection."""

from __future__ import annotations

import secrets
import sqlite3
import time
from dataclasses import dataclass
from typing import Any

from hookean_server.keeping.database import Database
from hookean_server.keeping.schema import TABLES
from hookean_server.store import Work


@dataclass(frozen=True)
class Kept:
    """A session as the store has it, without its large parts."""

    key: str
    label: str
    revision: int
    iteration: int
    status: str
    message: str
    particles: int
    created: float
    idle: float
    notes: list[str]
    nonce: str  # of its creation, part of its ETags


def listed() -> Work:
    """All sessions, the latest first."""

    def work(db: Database) -> list[Kept]:
        query = (
            "SELECT s.key, label, revision, coalesce(iteration, 0), coalesce(status, 'running'), "
            "coalesce(message, ''), particles, created, idle, coalesce(sentences, ''), nonce "
            "FROM sessions s LEFT JOIN states USING (key) LEFT JOIN notes USING (key) ORDER BY created DESC, s.key"
        )
        found = db.execute(query)
        return [Kept(*[*values, notes.splitlines(), nonce]) for *values, notes, nonce in found]

    return work


def put(key: str, label: str, base: bytes, described: dict[str, Any], notes: list[str], nonce: str = "") -> Work:
    """A session begun, or begun again from another scene: its edits and checkpoint are no longer those of the old one.
    `notes` are sentences on the file it came from; `nonce` stands for its creation, "" for that which it has, or a new
    one."""

    def work(db: Database) -> None:
        row = db.execute("SELECT created, nonce FROM sessions WHERE key = ?", (key,)).fetchone()
        created, before = row or (time.time(), secrets.token_hex(8))
        since, revision = db.seq + 1, described["revision"]
        told = {name: described[name] for name in ("iteration", "status", "message")}
        lines = "\n".join(" ".join(note.split()) for note in notes)
        db.execute("DELETE FROM edits WHERE key = ?", (key,))
        said = {"label": label, "nonce": nonce or before, "revision": revision, "particles": described["particles"]}
        db.keep("sessions", key=key, since=since, created=created, idle=0.0, **said)
        db.keep("bases", key=key, since=since, number=0, revision=revision, base=base)
        db.execute("DELETE FROM shapes WHERE key = ?", (key,))
        db.keep("states", key=key, since=since, **told)
        db.keep("notes", key=key, since=since, sentences=lines)

    return work


def rename(key: str, label: str) -> Work:
    """Another name to display."""

    def work(db: Database) -> None:
        db.change("sessions", (key,), label=label)

    return work


def edit(key: str, revision: int, sets: str, body: bytes) -> Work:
    """An edit that has been made, in place of the last one where that belongs to the same gesture and `sets` the same.
    Returns how many there are."""

    def work(db: Database) -> int:
        since, first = db.execute("SELECT since, number FROM bases WHERE key = ?", (key,)).fetchone()
        query = "SELECT number, sets FROM edits WHERE key = ? ORDER BY number DESC LIMIT 1"
        number, before = db.execute(query, (key,)).fetchone() or (first, "")
        if not sets or sets != before:
            number += 1
        db.keep("edits", key=key, number=number, since=since, revision=revision, sets=sets, body=body)
        db.change("sessions", (key,), revision=revision, idle=0.0)
        return int(number - first)

    return work


def edits(key: str, after: int) -> Work:
    """The edits of a session that led to revisions later than `after`, in their order, each with its revision."""

    def work(db: Database) -> list[tuple[int, bytes]]:
        query = "SELECT revision, body FROM edits WHERE key = ? AND revision > ? ORDER BY number"
        return [(int(revision), body) for revision, body in db.execute(query, (key, after))]

    return work


def checkpoint(key: str, described: dict[str, Any], state: bytes) -> Work:
    """How far a session has come."""

    def work(db: Database) -> None:
        row = db.execute("SELECT since FROM bases WHERE key = ?", (key,)).fetchone()
        if row is not None:
            told = {name: described[name] for name in ("iteration", "status", "message")}
            db.keep("states", key=key, since=row[0], **told)
            db.keep("shapes", key=key, since=row[0], state=state)

    return work


def rebase(key: str, since: int, number: int, revision: int, base: bytes) -> Work:
    """A new base in place of the edits up to a number, which led to a revision; those after it stay, and can be taken
    back. Nothing happens where the session has another scene by now than that of `since`."""

    def work(db: Database) -> None:
        row = db.execute("SELECT since, number FROM bases WHERE key = ?", (key,)).fetchone()
        if row is not None and row[0] == since and row[1] < number:
            db.execute("DELETE FROM edits WHERE key = ? AND number <= ?", (key, number))
            db.keep("bases", key=key, since=since, number=number, revision=revision, base=base)

    return work


@dataclass(frozen=True)
class Stored:
    """A session as it is brought back: its base, a checkpoint (may be empty), and the edits after the base, each with
    the revision that it led to."""

    base: bytes
    state: bytes
    edits: list[bytes]
    revisions: list[int]
    revision: int
    since: int
    number: int
    """Edits up to this one are in the base."""


def load(key: str) -> Work:
    """A session; None if it does not exist. Raises an error of the store if a row is not as it was written."""

    def work(db: Database) -> Stored | None:
        row = db.execute("SELECT revision FROM sessions WHERE key = ?", (key,)).fetchone()
        if row is None:
            return None
        (base,) = _whole(db, "bases", key)
        (shape,) = _whole(db, "shapes", key) or ({"state": b""},)
        edits = sorted(_whole(db, "edits", key), key=lambda found: int(found["number"]))
        bodies, revisions = [found["body"] for found in edits], [int(found["revision"]) for found in edits]
        return Stored(base["base"], shape["state"], bodies, revisions, int(row[0]), base["since"], base["number"])

    return work


def _whole(db: Database, table: str, key: str) -> list[dict[str, Any]]:
    """The rows of a session, each as it was written."""
    columns, found = TABLES[table].columns, []
    for row in db.execute(f"SELECT {', '.join(columns)} FROM {table} WHERE key = ?", (key,)):
        if not TABLES[table].whole(row):
            raise sqlite3.DatabaseError("a stored session is malformed")
        found.append(dict(zip(columns, row, strict=True)))
    return found


def delete(key: str) -> Work:
    """Forget a session; whether there was one."""

    def work(db: Database) -> bool:
        return db.execute("DELETE FROM sessions WHERE key = ?", (key,)).rowcount > 0

    return work


def age(seconds: float, longest: float, used: list[str]) -> Work:
    """So many seconds of service have passed; the keys of sessions that were not used for `longest`."""

    def work(db: Database) -> list[str]:
        db.execute("UPDATE sessions SET idle = idle + ?", (seconds,))
        db.executemany("UPDATE sessions SET idle = 0 WHERE key = ?", [(key,) for key in used])
        return [row[0] for row in db.execute("SELECT key FROM sessions WHERE idle > ?", (longest,))]

    return work
