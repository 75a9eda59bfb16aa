"""Stores of version 1: their rows, as many as SQLite can read, written as this version has them."""

from __future__ import annotations

import hashlib
import secrets
import sqlite3
from collections.abc import Iterator
from contextlib import closing, suppress
from pathlib import Path
from typing import Any

from hookean_server.keeping.choosing import Loss
from hookean_server.keeping.database import Database

TOP = 1 << 16


def read(path: Path, new: Database) -> list[Loss]:
    """Write all rows of the store at `path` into a new one; what cannot be read of it."""
    if not path.exists():
        return []
    losses: list[Loss] = []
    with closing(sqlite3.connect(path, isolation_level=None)) as old:
        old.row_factory = sqlite3.Row
        old.text_factory = lambda text: text.decode("utf-8", "replace")
        new.execute("BEGIN IMMEDIATE")
        _sessions(old, new, losses)
        _jobs(old, new, losses)
        new.mark("seq", new.seq)
        new.execute("COMMIT")
    return losses


def _sessions(old: sqlite3.Connection, new: Database, losses: list[Loss]) -> None:
    edits: dict[str, list[Any]] = {}
    for row in _rows(old, "edits"):
        edits.setdefault(row["key"], []).append(row)
    notes = {row["key"]: row["sentences"] for row in _rows(old, "notes")}
    nonces = {row["key"]: row["nonce"] for row in _rows(old, "creations")}
    for row in _rows(old, "sessions"):
        key, label, base = row["key"], row["label"], _verified(row["base"])
        called = f'Session "{label or key}"'
        if base is None:
            losses.append(Loss("session", key, f"{called} is lost; it was at revision {row['revision']}."))
            continue
        state = _verified(row["state"]) if row["state"] is not None else None
        made = sorted(edits.get(key, ()), key=lambda found: found["number"])
        last = made[0]["revision"] - 1 if made else row["revision"]
        since, before = new.seq + 1, made[0]["number"] - 1 if made else 0
        names = ("key", "label", "revision", "particles", "created", "idle")
        nonce = nonces.get(key) or secrets.token_hex(8)
        new.keep("sessions", since=since, nonce=nonce, **{name: row[name] for name in names})
        new.keep("bases", key=key, since=since, number=0, revision=last, base=base)
        said = {name: row[name] for name in ("iteration", "status", "message")}
        new.keep("states", key=key, since=since, **said)
        if state is not None:
            new.keep("shapes", key=key, since=since, state=state)
        new.keep("notes", key=key, since=since, sentences=notes.get(key, ""))
        for number, edit in enumerate(made, 1):
            body = _verified(edit["body"])
            if body is None or edit["number"] != before + number:
                break
            last = edit["revision"]
            new.keep("edits", key=key, number=number, since=since, revision=last, sets=edit["sets"], body=body)
        if last < row["revision"]:
            losses.append(Loss("session", key, f"{called}: edits after revision {last} are lost."))
        elif row["state"] is not None and state is None:
            losses.append(
                Loss("session", key, f"{called}: its last shape is lost, so it continues from an earlier one.")
            )


def _jobs(old: sqlite3.Connection, new: Database, losses: list[Loss]) -> None:
    known = set()
    for row in _rows(old, "jobs"):
        known.add(row["id"])
        new.keep("jobs", **{n: row[n] for n in ("id", "kind", "total", "status", "message", "created", "idle")})
        new.keep("requests", job=row["id"], request=row["request"])
    for row in _rows(old, "items"):
        if row["job"] in known:
            new.keep("items", **{n: row[n] for n in ("job", "number", "event", "status", "body")})
    for row in _rows(old, "answers"):
        job = str(row["head"]).rsplit("/", 1)[-1]
        if job in known:
            new.keep("answers", job=job, **{n: row[n] for n in ("key", "digest", "status", "head", "idle", "body")})


def _rows(old: sqlite3.Connection, table: str) -> Iterator[Any]:
    """The rows of a table that can be read: all, or by ever smaller ranges of their numbers where some cannot."""
    ranges = [(0, TOP)]
    with suppress(sqlite3.Error):
        ranges = [(0, old.execute(f"SELECT coalesce(max(rowid), 0) FROM {table}").fetchone()[0])]
    while ranges:
        first, last = ranges.pop()
        try:
            found = old.execute(f"SELECT * FROM {table} WHERE rowid BETWEEN ? AND ?", (first, last)).fetchall()
        except sqlite3.Error as error:
            if "no such" in str(error) or "not a database" in str(error):
                return
            if last > first:
                middle = (first + last) // 2
                ranges += [(middle + 1, last), (first, middle)]
            continue
        yield from found


def _verified(data: Any) -> bytes | None:
    """The bytes behind their SHA-256; None where they are damaged."""
    if not isinstance(data, bytes):
        return None
    sign, body = data[:32], data[32:]
    return body if hashlib.sha256(body).digest() == sign else None
