"""Sessions in the store: what is written and read, each a function of the connection."""

from __future__ import annotations

import hashlib
import secrets
import sqlite3
import time
from dataclasses import dataclass
from typing import Any

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


_COLUMNS = (
    "sessions.key, label, revision, iteration, status, message, particles, created, idle, notes.sentences, "
    "creations.nonce"
)


def listed() -> Work:
    """All sessions, the latest first."""

    def work(db: sqlite3.Connection) -> list[Kept]:
        joined = "sessions LEFT JOIN notes USING (key) LEFT JOIN creations USING (key)"
        found = db.execute(f"SELECT {_COLUMNS} FROM {joined} ORDER BY created DESC, sessions.key").fetchall()
        return [Kept(*[*row[:-2], (row[-2] or "").splitlines(), row[-1] or _creation(db, row[0])]) for row in found]

    return work


def _creation(db: sqlite3.Connection, key: str) -> str:
    """The nonce of a session of a file that has none for it yet."""
    nonce = secrets.token_hex(8)
    db.execute("INSERT OR REPLACE INTO creations VALUES (?, ?)", (key, nonce))
    return nonce


def put(key: str, label: str, base: bytes, described: dict[str, Any], notes: list[str], nonce: str = "") -> Work:
    """A session begun, or given another scene: its edits and checkpoint are those of the old one no more. `notes` are
    sentences on the file it came from; `nonce` stands for its creation."""

    def work(db: sqlite3.Connection) -> None:
        db.execute("DELETE FROM edits WHERE key = ?", (key,))
        db.execute(
            "INSERT INTO sessions (key, label, base, revision, iteration, status, message, particles, created, idle) "
            "VALUES (:key, :label, :base, :revision, :iteration, :status, :message, :particles, :now, 0) ON CONFLICT "
            "(key) DO UPDATE SET label = :label, base = :base, revision = :revision, iteration = :iteration, "
            "status = :status, message = :message, particles = :particles, state = NULL, idle = 0",
            {name: described[name] for name in ("revision", "iteration", "status", "message", "particles")}
            | {"key": key, "label": label, "base": _signed(base), "now": time.time()},
        )
        db.execute("DELETE FROM notes WHERE key = ?", (key,))
        if notes:
            lines = "\n".join(" ".join(note.split()) for note in notes)
            db.execute("INSERT INTO notes VALUES (?, ?)", (key, lines))
        if nonce:
            db.execute("INSERT OR REPLACE INTO creations VALUES (?, ?)", (key, nonce))

    return work


def edit(key: str, revision: int, sets: str, body: bytes) -> Work:
    """An edit that has been made, in place of the last one where that belongs to the same gesture and `sets` the same.
    Returns how many there are."""

    def work(db: sqlite3.Connection) -> int:
        query = "SELECT number, sets FROM edits WHERE key = ? ORDER BY number DESC LIMIT 1"
        number, before = db.execute(query, (key,)).fetchone() or (0, "")
        if not sets or sets != before:
            number += 1
        db.execute("INSERT OR REPLACE INTO edits VALUES (?, ?, ?, ?, ?)", (key, number, revision, sets, _signed(body)))
        db.execute("UPDATE sessions SET revision = ?, idle = 0 WHERE key = ?", (revision, key))
        return int(number)

    return work


def checkpoint(key: str, described: dict[str, Any], state: bytes) -> Work:
    """How far a session has come."""

    def work(db: sqlite3.Connection) -> None:
        db.execute(
            "UPDATE sessions SET state = :state, iteration = :iteration, status = :status, message = :message "
            "WHERE key = :key",
            {name: described[name] for name in ("iteration", "status", "message")}
            | {"key": key, "state": _signed(state)},
        )

    return work


def rebase(key: str, base: bytes, revision: int) -> Work:
    """A new base in place of all edits up to a revision, which can then not be taken back any more."""

    def work(db: sqlite3.Connection) -> None:
        db.execute("DELETE FROM edits WHERE key = ? AND revision <= ?", (key, revision))
        db.execute("UPDATE sessions SET base = ?, state = NULL WHERE key = ?", (_signed(base), key))

    return work


def load(key: str) -> Work:
    """Base, checkpoint (may be empty), edits with their revisions, and label; None where there is no such session."""

    def work(db: sqlite3.Connection) -> tuple[bytes, bytes, list[bytes], list[int], str] | None:
        row = db.execute("SELECT base, state, label FROM sessions WHERE key = ?", (key,)).fetchone()
        if row is None:
            return None
        found = db.execute("SELECT body, revision FROM edits WHERE key = ? ORDER BY number", (key,)).fetchall()
        state = b"" if row[1] is None else _verified(row[1], b"")
        base = _verified(row[0], None)
        edits = [_verified(body, None) for body, _ in found]
        return base, state, edits, [int(revision) for _, revision in found], row[2]

    return work


def delete(key: str) -> Work:
    """Forget a session; whether there was one."""

    def work(db: sqlite3.Connection) -> bool:
        return db.execute("DELETE FROM sessions WHERE key = ?", (key,)).rowcount > 0

    return work


def age(seconds: float, longest: float, awake: list[str]) -> Work:
    """So many seconds of service have passed; returns the keys of sessions that are untouched for `longest`."""

    def work(db: sqlite3.Connection) -> list[str]:
        db.execute("UPDATE sessions SET idle = idle + ?", (seconds,))
        db.executemany("UPDATE sessions SET idle = 0 WHERE key = ?", [(key,) for key in awake])
        return [row[0] for row in db.execute("SELECT key FROM sessions WHERE idle > ?", (longest,))]

    return work


def _signed(data: bytes) -> bytes:
    return hashlib.sha256(data).digest() + data


def _verified(data: bytes, fallback: bytes | None) -> bytes:
    """The bytes that were stored; the fallback, or an error of the store, where they were damaged."""
    sign, body = bytes(data[:32]), bytes(data[32:])
    if hashlib.sha256(body).digest() == sign:
        return body
    if fallback is None:
        raise sqlite3.DatabaseError("a stored session is malformed")
    return fallback
