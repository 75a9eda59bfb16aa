"""Jobs in the store: what is written and read, each a function of the connection."""

from __future__ import annotations

import json
import time
from dataclasses import dataclass
from typing import Any

from hookean_server.keeping.database import Database
from hookean_server.store import Work

UNFINISHED = ("waiting", "running")
PARTIAL = "running"
"""Status of the item of a relaxation that is not done: its body is a checkpoint, a line on it and the state."""
STOPPED = "cancelled"
"""Status of the item of a relaxation that was cancelled: a row and the state."""


@dataclass
class Kept:
    """A job as the store has it, without request and rows."""

    id: str
    kind: str
    total: int
    status: str
    message: str
    created: float
    done: int = 0
    failed: int = 0
    event: int = 0
    """Number of the last event that is in the store."""


@dataclass(frozen=True)
class Row:
    """One item: its place in the sweep, its event, its status and its row of figures (JSON). A relaxation has more
    behind it, and a line feed between."""

    number: int
    event: int
    status: str
    body: bytes


@dataclass
class Answer:
    """What was answered to a request with an Idempotency-Key."""

    digest: str
    location: str
    body: bytes


_JOB = (
    "SELECT id, kind, total, status, message, created, "
    "(SELECT count(*) FROM items WHERE job = id AND status = 'done'), "
    "(SELECT count(*) FROM items WHERE job = id AND status = 'failed'), "
    "(SELECT coalesce(max(event), 0) FROM items WHERE job = id) FROM jobs"
)


def listed() -> Work:
    """All jobs, the oldest first."""

    def work(db: Database) -> list[Kept]:
        return [Kept(*row) for row in db.execute(f"{_JOB} ORDER BY created, id")]

    return work


def add(job: Kept, request: bytes, key: str, digest: str, location: str, answer: bytes) -> Work:
    """A new job, and with a `key` the answer to its request."""

    def work(db: Database) -> None:
        created = time.time()
        said = {"kind": job.kind, "total": job.total, "status": job.status, "message": job.message}
        db.keep("jobs", id=job.id, created=created, **said)
        db.keep("requests", job=job.id, request=request)
        if key:
            db.keep("answers", key=key, job=job.id, digest=digest, status=202, head=location, body=answer)

    return work


def answered(key: str) -> Work:
    """The answer under an Idempotency-Key, or None."""

    def work(db: Database) -> Answer | None:
        row = db.execute("SELECT digest, head, body FROM answers WHERE key = ?", (key,)).fetchone()
        if row is not None:
            db.execute("UPDATE answers SET idle = 0 WHERE key = ?", (key,))
        return None if row is None else Answer(row[0], row[1], bytes(row[2]))

    return work


def request(job: str) -> Work:
    """The header of a job's table, and its request; None if the job does not exist."""

    def work(db: Database) -> tuple[dict[str, Any], bytes] | None:
        row = db.execute("SELECT request FROM requests WHERE job = ?", (job,)).fetchone()
        if row is None:
            return None
        about, _, rest = bytes(row[0]).partition(b"\n")
        return json.loads(about), rest

    return work


def status(job: str, status: str, message: str) -> Work:
    """How a job stands."""

    def work(db: Database) -> None:
        db.change("jobs", (job,), status=status, message=message, idle=0.0)

    return work


def store(job: str, found: list[Row]) -> Work:
    """Items that are done; of one that is there already the first stays. Returns the numbers of new ones."""

    def work(db: Database) -> list[int]:
        new = []
        for row in found:
            db.execute("DELETE FROM items WHERE job = ? AND number = ? AND status = ?", (job, row.number, PARTIAL))
            query = "SELECT 1 FROM items WHERE job = ? AND number = ?"
            if db.execute(query, (job, row.number)).fetchone() is None:
                db.keep("items", job=job, number=row.number, event=row.event, status=row.status, body=row.body)
                new.append(row.number)
        return new

    return work


def checkpoint(job: str, event: int, body: bytes) -> Work:
    """How far a relaxation has come."""

    def work(db: Database) -> None:
        db.keep("items", job=job, number=0, event=event, status=PARTIAL, body=body)

    return work


def finished(job: str) -> Work:
    """Numbers of the items that are done or failed."""

    def work(db: Database) -> set[int]:
        query = "SELECT number FROM items WHERE job = ? AND status <> ?"
        return {row[0] for row in db.execute(query, (job, PARTIAL))}

    return work


def rows(job: str, after: int, most: int, *, by: str = "number") -> Work:
    """At most `most` finished items after a number, in the order of their numbers; or after an event, in the order of
    their arrival (by `event`)."""
    assert by in ("number", "event")

    def work(db: Database) -> list[Row]:
        query = (
            f"SELECT number, event, status, body FROM items WHERE job = ? AND {by} > ? AND status <> ? "
            f"ORDER BY {by} LIMIT ?"
        )
        return [Row(n, e, s, bytes(b)) for n, e, s, b in db.execute(query, (job, after, PARTIAL, most))]

    return work


def item(job: str, number: int) -> Work:
    """One item, finished or a checkpoint; None where there is none."""

    def work(db: Database) -> Row | None:
        query = "SELECT number, event, status, body FROM items WHERE job = ? AND number = ?"
        row = db.execute(query, (job, number)).fetchone()
        return None if row is None else Row(row[0], row[1], row[2], bytes(row[3]))

    return work


def age(seconds: float, longest: float, used: list[str], most: int) -> Work:
    """So many seconds of service have passed: finished jobs untouched for `longest` are forgotten, and the oldest
    beyond `most`; with them the answers to their requests. Returns their ids."""

    def work(db: Database) -> list[str]:
        db.execute("UPDATE jobs SET idle = idle + ?", (seconds,))
        db.execute("UPDATE answers SET idle = idle + ?", (seconds,))
        db.executemany("UPDATE jobs SET idle = 0 WHERE id = ?", [(job,) for job in used])
        done = f"status NOT IN {UNFINISHED!r}"
        gone = [row[0] for row in db.execute(f"SELECT id FROM jobs WHERE {done} AND idle > ?", (longest,))]
        beyond = f"SELECT id FROM jobs WHERE {done} ORDER BY created DESC, id LIMIT -1 OFFSET ?"
        gone = list(dict.fromkeys(gone + [row[0] for row in db.execute(beyond, (most,))]))
        db.executemany("DELETE FROM jobs WHERE id = ?", [(job,) for job in gone])
        db.execute("DELETE FROM answers WHERE idle > ?", (longest,))
        return gone

    return work


def one(job: str) -> Work:
    """One job; None where there is none."""

    def work(db: Database) -> Kept | None:
        row = db.execute(f"{_JOB} WHERE id = ?", (job,)).fetchone()
        return None if row is None else Kept(*row)

    return work
