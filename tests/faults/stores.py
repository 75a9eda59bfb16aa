"""Stores with a ledger of what was acknowledged, as files of a server that was killed; and ways to damage them."""

from __future__ import annotations

import random
import shutil
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from hookean_server.jobs import rows as job_rows
from hookean_server.sessions import rows
from hookean_server.store import Store

FILES = ("sessions.db", "sessions.db-wal", "sessions.db.manifest")


@dataclass
class Ledger:
    """All that was acknowledged and not deleted since."""

    bases: dict[str, bytes] = field(default_factory=dict)
    edits: dict[str, list[bytes]] = field(default_factory=dict)
    states: dict[str, bytes] = field(default_factory=dict)
    requests: dict[str, bytes] = field(default_factory=dict)
    items: dict[str, dict[int, bytes]] = field(default_factory=dict)


def described(revision: int) -> dict[str, Any]:
    return {"revision": revision, "iteration": 5, "status": "running", "message": "é", "particles": 3}


class Life:
    """Random work on a store, noted as it is acknowledged."""

    def __init__(self, store: Store, seed: int) -> None:
        self.store, self.chance, self.ledger = store, random.Random(seed), Ledger()
        self.revisions: dict[str, int] = {}

    def do(self, work: Any) -> Any:
        return self.store.submit(work).result(20.0)

    def put(self, key: str) -> None:
        base = self.chance.randbytes(self.chance.choice((300, 5000, 40_000)))
        self.revisions[key] = self.revisions.get(key, -1) + 1
        self.do(rows.put(key, f"Label {key}", base, described(self.revisions[key]), ["a note"]))
        self.ledger.bases[key], self.ledger.edits[key] = base, []
        self.ledger.states[key] = b""

    def edit(self, key: str) -> None:
        body = b'{"n": "%s"}' % self.chance.randbytes(self.chance.choice((8, 8, 8, 3000))).hex().encode()
        self.revisions[key] += 1
        self.do(rows.edit(key, self.revisions[key], "", body))
        self.ledger.edits[key].append(body)

    def checkpoint(self, key: str) -> None:
        state = self.chance.randbytes(self.chance.choice((500, 9000)))
        self.do(rows.checkpoint(key, described(self.revisions[key]), state))
        self.ledger.states[key] = state

    def delete(self, key: str) -> None:
        self.do(rows.delete(key))
        for kept in (self.ledger.bases, self.ledger.edits, self.ledger.states, self.revisions):
            kept.pop(key, None)

    def job(self, name: str, count: int) -> None:
        request = b'{"a": 1}\n' + self.chance.randbytes(2000)
        kept = job_rows.Kept(name, "sweep", count, "waiting", "", 0.0)
        self.do(job_rows.add(kept, request, f"key-{name}", "d", f"/v1/jobs/{name}", b"{}"))
        self.ledger.requests[name], self.ledger.items[name] = request, {}
        for number in range(count):
            body = b'{"number": %d, "x": "%s"}' % (number, self.chance.randbytes(100).hex().encode())
            self.do(job_rows.store(name, [job_rows.Row(number, number + 1, "done", body)]))
            self.ledger.items[name][number] = body
        self.do(job_rows.status(name, "done", ""))

    def some(self, count: int) -> None:
        """So many random pieces of work on the sessions that there are."""
        for _ in range(count):
            keys, draw = sorted(self.ledger.bases), self.chance.random()
            key = self.chance.choice(keys)
            if draw < 0.65:
                self.edit(key)
            elif draw < 0.85:
                self.checkpoint(key)
            elif draw < 0.93:
                self.put(key)
            elif len(keys) > 3:
                self.delete(key)
            else:
                self.put(f"more-{self.chance.randrange(100)}")


def lived(folder: Path, seed: int) -> tuple[Ledger, Path, Path]:
    """A ledger, the files as a kill left them, and the same files as they were some time before."""
    store = Store(folder / "live" / "sessions.db")
    before, after = folder / "before", folder / "after"
    try:
        life = Life(store, seed)
        for key in "abcde":
            life.put(key)
        life.job("j", 12)
        life.some(40)
        copied(folder / "live", before)
        if seed % 2:  # the log is emptied into the file in between, or holds all of it
            emptied(store)
        life.some(25)
        copied(folder / "live", after)
        return life.ledger, before, after
    finally:
        store.close()


def emptied(store: Store) -> None:
    """Empty the log of a running store now."""

    def work(db: Any) -> None:
        db.execute("COMMIT")
        db.execute("PRAGMA wal_checkpoint(TRUNCATE)")
        db.execute("BEGIN IMMEDIATE")

    store.submit(work).result(20.0)


def copied(source: Path, target: Path) -> None:
    """The files of a store and no others."""
    target.mkdir(parents=True)
    for name in FILES:
        if (source / name).exists():
            shutil.copyfile(source / name, target / name)


def _bits(path: Path, chance: random.Random) -> None:
    data = bytearray(path.read_bytes())
    for _ in range(chance.choice((1, 8, 64)) if data else 0):
        data[chance.randrange(len(data))] ^= 1 << chance.randrange(8)
    path.write_bytes(data)


def _cut(path: Path, chance: random.Random) -> None:
    data = path.read_bytes()
    path.write_bytes(data[: chance.randrange(len(data) + 1)])


def _zeros(path: Path, chance: random.Random) -> None:
    data = bytearray(path.read_bytes())
    start = chance.randrange(max(1, len(data)))
    data[start : start + 4096] = bytes(len(data[start : start + 4096]))
    path.write_bytes(data)


def _head(path: Path, chance: random.Random) -> None:
    data = bytearray(path.read_bytes())
    data[: chance.choice((16, 100, 4096))] = chance.randbytes(16)
    path.write_bytes(data)


def _swapped(path: Path, chance: random.Random) -> None:
    data = bytearray(path.read_bytes())
    start, size = (32, 4120) if path.name.endswith("-wal") else (0, 4096)
    count = (len(data) - start) // size
    if count > 1:
        one, other = (start + size * place for place in chance.sample(range(count), 2))
        data[one : one + size], data[other : other + size] = data[other : other + size], data[one : one + size]
    path.write_bytes(data)


HARMS: dict[str, Callable[[Path, random.Random], None]] = {
    "bits": _bits,
    "cut": _cut,
    "zeros": _zeros,
    "head": _head,
    "swapped": _swapped,
    "gone": lambda path, chance: path.unlink(missing_ok=True),
    "empty": lambda path, chance: path.write_bytes(b""),
}
