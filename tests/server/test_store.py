"""The store: how far its log is behind, what it may take, other versions, backups, and its commands."""

from __future__ import annotations

import json
import os
import shutil
import sqlite3
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest

import forking
from hookean_server import store as module
from hookean_server.keeping import backups, database, schema
from hookean_server.keeping.opening import Refused
from hookean_server.problems import Problem
from hookean_server.sessions import rows
from hookean_server.store import Store
from serving import CABLE, wait_for

from .conftest import Served, problem

DESCRIBED = {"revision": 0, "iteration": 0, "status": "running", "message": "", "particles": 1}
MB = 10**6


class Clock:
    """Time that a test lets pass."""

    def __init__(self) -> None:
        self.now = 1000.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def opened(tmp_path: Path) -> Iterator[Callable[..., Store]]:
    """Opens the store of a test, again and again; each is closed before the next."""
    stores: list[Store] = []

    def opening(**options: Any) -> Store:
        for store in stores:
            store.close()
        stores.append(Store(tmp_path / "sessions.db", **options))
        stores[-1].start()
        return stores[-1]

    yield opening
    for store in stores:
        store.close()


def do(store: Store, work: Any) -> Any:
    return store.submit(work).result(20.0)


def put(key: str, size: int = 100) -> Any:
    return rows.put(key, key, os.urandom(size), DESCRIBED, [])


def keys(store: Store) -> set[str]:
    return {kept.key for kept in do(store, rows.listed())}


def nonces(store: Store) -> dict[str, str]:
    """Of the creation of each session."""
    return {kept.key: kept.nonce for kept in do(store, rows.listed())}


def wal(tmp_path: Path) -> int:
    path = tmp_path / "sessions.db-wal"
    return path.stat().st_size if path.exists() else 0


def test_the_log_is_empty_once_the_store_is_idle(opened: Callable[..., Store], tmp_path: Path) -> None:
    store = opened()
    do(store, put("a"))
    wait_for(lambda: wal(tmp_path) == 0)
    assert b"SQLite" in (tmp_path / "sessions.db").read_bytes()


@pytest.mark.parametrize("limit", ["bytes", "seconds"])
def test_the_log_is_at_most_so_far_behind(
    limit: str, opened: Callable[..., Store], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """1 MB or 10 s of a clock, where the store is never idle."""
    monkeypatch.setattr(module, "IDLE", 1e6)
    clock = Clock()
    store = opened(clock=clock)
    do(store, put("a", 400_000))
    assert wal(tmp_path) > 400_000

    def passes(db: Any) -> None:
        clock.now += 11.0

    do(store, put("b", 900_000) if limit == "bytes" else passes)
    do(store, lambda db: None)  # what follows a piece of work has been done
    assert wal(tmp_path) == 0


def test_a_file_shrinks(opened: Callable[..., Store], tmp_path: Path) -> None:
    """30 MB of sessions are deleted: once the store is idle the file takes less than 2 MB."""
    store = opened()
    for number in range(10):
        do(store, put(str(number), 3 * MB))
    wait_for(lambda: (tmp_path / "sessions.db").stat().st_size > 30 * MB)
    for number in range(10):
        do(store, rows.delete(str(number)))
    wait_for(lambda: (tmp_path / "sessions.db").stat().st_size < 2 * MB)


def test_what_is_over_the_quota_is_refused_as_that(opened: Callable[..., Store]) -> None:
    """With a warning before, what was stored stays, the same place may be written again, and a deletion makes room."""
    store = opened(quota=10 * MB)
    for number in range(4):
        do(store, put(str(number), 2 * MB))
    wait_for(lambda: any("8." in said and "10.0 MB" in said for said in store.warnings))
    with pytest.raises(Problem) as refused:
        do(store, put("more", 3 * MB))
    assert refused.value.slug == "over-quota" and "10.0 MB" in refused.value.detail and not store.failing
    assert keys(store) == {"0", "1", "2", "3"}
    do(store, put("1", 2 * MB))
    do(store, rows.delete("0"))
    do(store, put("more", 2 * MB))


def test_what_is_too_large_is_refused_as_that(opened: Callable[..., Store], monkeypatch: pytest.MonkeyPatch) -> None:
    """SQLite takes values of at most 1e9 bytes (https://www.sqlite.org/limits.html)."""
    store = opened()
    assert sqlite3.connect(":memory:").getlimit(sqlite3.SQLITE_LIMIT_LENGTH) > database.LARGEST
    monkeypatch.setattr(database, "LARGEST", MB)
    with pytest.raises(Problem) as refused:
        do(store, put("a", 2 * MB))
    assert refused.value.slug == "too-large" and not store.failing and keys(store) == set()


@pytest.mark.parametrize("version", [1, schema.VERSION + 5])
def test_a_store_of_another_version_is_refused_and_left_as_it_is(
    version: int, opened: Callable[..., Store], tmp_path: Path
) -> None:
    store = opened()
    do(store, put("a"))
    store.close()
    path = tmp_path / "sessions.db"
    with sqlite3.connect(path) as db:
        db.execute(f"PRAGMA user_version = {version}")
    db.close()
    (tmp_path / "sessions.db.manifest").unlink()
    given = path.read_bytes()
    with pytest.raises(Refused, match="another version"):
        Store(path).start()
    code = "import sys; from hookean_server.lifecycle.main import serve; from hookean_server.settings import Settings;"
    code += f"sys.exit(serve(port=0, settings=Settings(state={str(path)!r})))"
    served = forking.run(code)
    assert served.returncode == 2 and "another version" in served.stderr and "Traceback" not in served.stderr
    assert path.read_bytes() == given
    assert {entry.name for entry in tmp_path.iterdir()} <= {"sessions.db", "sessions.db.lock"}


def test_backups_of_the_last_starts(opened: Callable[..., Store], tmp_path: Path) -> None:
    """The last three in which something had changed; each opens by itself."""
    path, names = tmp_path / "sessions.db", "abcde"
    for name in names:
        store = opened()
        do(store, put(name))
        store.close()
        assert backups.rotate(path, 3)
        assert not backups.rotate(path, 3)
    assert sorted(f.name for f in tmp_path.glob("*.backup-*")) == [f"sessions.db.backup-{n}" for n in (1, 2, 3)]
    for number in (1, 2, 3):
        copy = tmp_path / "other" / f"{number}.db"
        copy.parent.mkdir(exist_ok=True)
        shutil.copyfile(backups.place(path, number), copy)
        taken = Store(copy)
        assert keys(taken) == set(names[: 6 - number])
        taken.close()


def test_what_is_lost_comes_back_from_a_backup(opened: Callable[..., Store], tmp_path: Path) -> None:
    """The file is gone: sessions come from the backup, with a loss for each that has changed since. ETags of a session
    that is whole match still; of one that lost an edit none does, as its nonce is another one."""
    store = opened()
    for key in "ab":
        do(store, put(key, 5000))
    first, known = do(store, rows.load("a")), nonces(store)
    store.close()
    backups.rotate(tmp_path / "sessions.db", 3)
    store = opened()
    do(store, rows.edit("b", 1, "", b"{}"))
    do(store, put("c"))
    store.close()
    (tmp_path / "sessions.db").unlink()
    store = opened()
    assert do(store, rows.load("a")) == first and keys(store) == {"a", "b"}
    (report,) = store.reports
    assert {loss.key for loss in report.losses} == {"b", "c"}
    assert do(store, rows.load("b")).revision == 2  # of 1, which is lost, nobody gets another version
    assert nonces(store)["a"] == known["a"] and nonces(store)["b"] not in ("", known["b"])


def test_a_nonce_is_of_a_creation(opened: Callable[..., Store]) -> None:
    """Another scene, an edit and a start leave it as it is; a session made again under the key has another one."""
    store = opened()
    do(store, put("a"))
    known = nonces(store)
    do(store, put("a"))
    do(store, rows.edit("a", 1, "", b"{}"))
    store = opened()
    assert nonces(store) == known
    do(store, rows.delete("a"))
    do(store, put("a"))
    assert nonces(store)["a"] not in ("", known["a"])


@pytest.mark.skipif(sys.platform == "win32", reason="Windows deletes no file that is open")
@pytest.mark.parametrize("how", ["deleted", "replaced", "emptied"])
def test_a_file_that_is_deleted_in_use_is_written_again(how: str, opened: Callable[..., Store], tmp_path: Path) -> None:
    """What is acknowledged after it, and before, is there at the next start; a file put in its place is kept."""
    path = tmp_path / "sessions.db"
    store = opened()
    do(store, put("a"))
    path.unlink() if how != "emptied" else None
    if how == "replaced":
        path.write_bytes(b"another file")
    if how == "emptied":
        os.replace(path, tmp_path / "moved.db")
        path.touch()
    do(store, put("b"))
    do(store, rows.edit("a", 1, "", b"{}"))
    store = opened()
    assert keys(store) == {"a", "b"} and not store.reports and len(do(store, rows.load("a")).edits) == 1
    assert [f.read_bytes() for f in tmp_path.glob("*.replaced-*")] == (
        {"deleted": [], "replaced": [b"another file"], "emptied": [b""]}[how]
    )


def command(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, "HOOKEAN_STATE": str(folder)}
    return forking.run(forking.COMMAND, "store", *words, environment=environment)


def test_the_commands_of_a_store(opened: Callable[..., Store], tmp_path: Path) -> None:
    """check, backup, compact and salvage: what they print and how they exit."""
    assert command(tmp_path, "check").returncode == 2
    store = opened()
    for number in range(3):
        do(store, put(str(number), MB))
    store.close()
    assert "is not damaged" in (said := command(tmp_path, "check")).stdout and said.returncode == 0
    assert command(tmp_path, "backup", str(tmp_path / "copy.db")).returncode == 0
    assert "exists" in (said := command(tmp_path, "backup", str(tmp_path / "copy.db"))).stderr and said.returncode == 2
    assert command(tmp_path, "compact").returncode == 0
    assert "unknown action" in (said := command(tmp_path, "polish")).stderr and said.returncode == 2
    path = tmp_path / "sessions.db"
    data = bytearray(path.read_bytes())
    data[len(data) // 2] ^= 4
    path.write_bytes(data)
    said = command(tmp_path, "check")
    assert said.returncode == 1 and "is damaged" in said.stdout and path.read_bytes() == bytes(data)
    said = command(tmp_path, "salvage")
    assert said.returncode == 1 and "is lost" in said.stdout and "damaged-" in said.stdout
    assert len(keys(opened())) == 2


def test_losses_are_named_over_http(tmp_path: Path) -> None:
    """In the list of sessions and, to clients with the token, in health; others get their number."""
    path = tmp_path / "sessions.db"
    served = Served(state=str(path), workers=1)
    for key in ("roof", "wall"):
        assert served.client.put(f"/v1/sessions/{key}", json=CABLE, params={"label": f"The {key}"}).is_success
    assert served.health()["store"]["warnings"] == []
    served.end()
    data = path.read_bytes()
    at = data.index(b"PK\x03\x04", data.index(b"roof"))
    path.write_bytes(data[:at] + b"??" + data[at + 2 :])
    for backup in tmp_path.glob("*.backup-*"):
        backup.unlink()
    served = Served(state=str(path), workers=1)
    try:
        found = served.client.get("/v1/sessions").json()
        left = {session["key"] for session in found["sessions"]}
        assert len(left) == 1
        lost = ({"roof", "wall"} - left).pop()
        (repair,) = found["store"]["repairs"]
        assert [loss["key"] for loss in repair["losses"]] == [lost] and f"The {lost}" in repair["losses"][0]["what"]
        assert (tmp_path / repair["copy"] / "sessions.db").exists()
        assert served.health()["store"] == found["store"]
        others = httpx.get(f"{served.url}/v1/health").json()["store"]
        assert others["losses"] == 1 and "repairs" not in others and lost not in json.dumps(others)
    finally:
        said = served.end()[1]
    assert f"The {lost}" in said and repair["copy"] in said


def test_the_quota_over_http(tmp_path: Path) -> None:
    """A scene that does not fit is 507 `over-quota`; the session is not there, others go on."""
    served = Served(state=str(tmp_path / "sessions.db"), workers=1, quota=400_000)
    try:
        assert served.client.put("/v1/sessions/a", json=CABLE).status_code == 201
        large = {**CABLE, "particles": [*CABLE["particles"], *([i, 1, 0] for i in range(5000))]}
        problem(served.client.put("/v1/sessions/b", json=large), 507, "over-quota")
        problem(served.client.get("/v1/sessions/b"), 404, "not-found")
        assert served.client.patch("/v1/sessions/a", json={"settings": {"drag": 1.0}}).status_code == 200
    finally:
        served.end()


def test_a_quota_that_is_no_number_is_refused(tmp_path: Path) -> None:
    environment = {**os.environ, "HOOKEAN_STATE": str(tmp_path), "HOOKEAN_QUOTA": "8 GB"}
    done = forking.run(forking.COMMAND, "serve", "--port", "0", environment=environment)
    assert done.returncode == 2 and "HOOKEAN_QUOTA" in done.stderr and "Traceback" not in done.stderr
