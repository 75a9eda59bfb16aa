"""A disk that is full or broken: a problem, nothing partial, and the session goes on; also a damaged database."""

from __future__ import annotations

import errno
import os
import random
import resource
import shutil
import signal
import sqlite3
import subprocess
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import httpx
import pytest

from hookean import atomic_write
from hookean.errors import InputError
from hookean_server.keeping.database import SPARE
from hookean_server.sessions import rows
from hookean_server.store import Store
from server.conftest import Served, problem
from serving import CABLE, SOAK, wait_for

from .disk import Disk

MOST = 200  # writes that one edit may take
TRIES = 3 if SOAK else 1  # of each: a write of the background may be the one that fails
STRIDE = 1 if SOAK else 2  # every write is failed in `make soak`, the first, third, fifth ... in all runs
OURS = {"sessions.db", "sessions.db-wal", "sessions.db-shm", "sessions.db.lock", "sessions.db.manifest"}
OURS |= {f"sessions.db.backup-{number}" for number in (1, 2, 3)}
FAULTS = [(errno.ENOSPC, True), (errno.EIO, True), (errno.EIO, False), (errno.ENOSPC, False)]


@pytest.fixture(scope="module")
def disk() -> Iterator[Disk]:
    with tempfile.TemporaryDirectory(prefix="hk") as folder:  # its sockets need a short path
        yield Disk(Path(folder))


@pytest.fixture(scope="module")
def served(disk: Disk) -> Iterator[Served]:
    with pytest.MonkeyPatch.context() as patch:
        found = disk.serve(patch)
    yield found
    disk.mend()
    assert found.end()[0] == 0


def load(value: float) -> dict[str, Any]:
    return {"forces": {"1": {"vector": [0, 0, value]}}}


def standing(client: httpx.Client, key: str) -> dict[str, Any]:
    """All that must not change where nothing was stored."""
    found = client.get(f"/v1/sessions/{key}").json()
    scene = client.get(f"/v1/sessions/{key}/scene").json()
    anchors = client.get(f"/v1/sessions/{key}/anchors").json()
    return {
        **{name: found[name] for name in ("revision", "undo", "redo", "status", "particles")},
        "scene": scene,
        "anchors": anchors,
    }


WORK: dict[str, Callable[[httpx.Client, str], httpx.Response]] = {
    "edit": lambda client, key: client.patch(f"/v1/sessions/{key}", json=load(-31.0)),
    "gesture": lambda client, key: client.patch(f"/v1/sessions/{key}", json={**load(-32.0), "gesture": "drag"}),
    "pin": lambda client, key: client.patch(f"/v1/sessions/{key}", json={"pin": [{"particles": [2]}]}),
    "undo": lambda client, key: client.post(f"/v1/sessions/{key}/undo"),
    "redo": lambda client, key: client.post(f"/v1/sessions/{key}/redo"),
    "reset": lambda client, key: client.post(f"/v1/sessions/{key}/reset"),
    "scene": lambda client, key: client.put(f"/v1/sessions/{key}", json={**CABLE, "weld_tolerance": 1e-5}),
    "branch": lambda client, key: client.post(f"/v1/sessions/{key}/branches", params={"to": f"{key}-branch"}),
    "delete": lambda client, key: client.delete(f"/v1/sessions/{key}"),
}


def _begun(client: httpx.Client, key: str) -> None:
    """A session with an edit to take back, one to make again and a gesture that goes on."""
    assert client.put(f"/v1/sessions/{key}", json=CABLE).status_code in (200, 201)
    for value in (-21.0, -22.0):
        assert client.patch(f"/v1/sessions/{key}", json=load(value)).status_code == 200


def cases() -> list[Any]:
    """Every work with every fault; all but one fault of each are left to
    `make soak`."""
    found = []
    for place, work in enumerate(sorted(WORK)):
        for fault in FAULTS:
            here = fault == FAULTS[place % len(FAULTS)]
            name = f"{work}-{errno.errorcode[fault[0]]}-sticky{fault[1]}"
            found.append(pytest.param(work, *fault, id=name, marks=[] if here else [pytest.mark.soak]))
    return found


@pytest.mark.thinned
@pytest.mark.parametrize(("work", "error", "sticky"), cases())
def test_what_cannot_be_stored_is_refused_and_changes_nothing(
    work: str, error: int, sticky: bool, disk: Disk, served: Served
) -> None:
    """The Nth write fails, N = 1, 2, ... until none does: each time a problem, the session as it was, no file left."""
    client, key = served.client, f"{work}-{error}-{sticky}"
    _begun(client, key)
    if work == "redo":
        assert client.post(f"/v1/sessions/{key}/undo").status_code == 200
    if work == "gesture":
        first = client.patch(f"/v1/sessions/{key}", json={**load(-23.0), "gesture": "drag"})
        assert first.status_code == 200
    before, refused = standing(client, key), 0
    for number in (number for number in range(1, MOST, STRIDE) for _ in range(TRIES)):
        disk.fail(number, error, sticky=sticky)
        answer = WORK[work](client, key)
        failed = disk.mend()
        if answer.is_success:
            if not failed:
                break
            # a write of the background failed, or one that is made again: it is stored, so this begins anew
            before = standing(client, _again(client, key, work))
            continue
        problem(answer, 507, "not-stored")
        assert failed
        refused += 1
        assert standing(client, key) == before
        assert disk.names <= OURS
    else:
        pytest.fail(f"not done in {MOST} writes")
    assert refused, "no write of this work ever failed"
    if work not in ("delete", "branch"):
        after = standing(client, key)
        assert after["revision"] > before["revision"]
        assert client.patch(f"/v1/sessions/{key}", json=load(-99.0)).json()["revision"] == after["revision"] + 1


def _again(client: httpx.Client, key: str, work: str) -> str:
    """The session as it was before `work`, whatever of it landed."""
    for name in (key, f"{key}-branch"):
        client.delete(f"/v1/sessions/{name}")
    _begun(client, key)
    if work == "redo":
        client.post(f"/v1/sessions/{key}/undo")
    if work == "gesture":
        client.patch(f"/v1/sessions/{key}", json={**load(-23.0), "gesture": "drag"})
    return key


def test_a_session_that_cannot_be_made_is_not_there(disk: Disk, served: Served) -> None:
    refused = 0
    for number in range(1, MOST, STRIDE):
        disk.fail(number, errno.ENOSPC, sticky=True)
        answer = served.client.put("/v1/sessions/new", json=CABLE)
        failed = disk.mend()
        if answer.status_code == 201:
            if not failed:
                break
            served.client.delete("/v1/sessions/new")
            continue
        problem(answer, 507, "not-stored")
        problem(served.client.get("/v1/sessions/new"), 404, "not-found")
        refused += 1
    assert refused


def test_a_session_goes_on_while_the_disk_is_full(disk: Disk, served: Served) -> None:
    """It plays and answers; edits are refused, and taken again without a new start once there is room."""
    client = served.client
    client.put("/v1/sessions/full", json=CABLE)
    assert client.post("/v1/sessions/full/play").json()["playing"]
    disk.fail(1, errno.ENOSPC, sticky=True)
    try:
        problem(client.patch("/v1/sessions/full", json=load(-5.0)), 507, "not-stored")
        at = client.get("/v1/sessions/full").json()
        assert at["revision"] == 0
        assert client.post("/v1/sessions/full/step", params={"frames": 3}).status_code == 200
        assert client.get("/v1/sessions/full/state").status_code == 200
    finally:
        assert disk.mend()
    kept = client.patch("/v1/sessions/full", json=load(-6.0))
    assert kept.status_code == 200 and kept.json()["revision"] == 1
    assert client.get("/v1/sessions/full/scene").json()["forces"][1]["vector"] == [0, 0, -6.0]


def test_what_was_acknowledged_between_faults_is_there_after_a_kill(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    with tempfile.TemporaryDirectory(prefix="hk") as folder:
        _killed_between_faults(Disk(Path(folder)), monkeypatch)


def _killed_between_faults(other: Disk, monkeypatch: pytest.MonkeyPatch) -> None:
    first = other.serve(monkeypatch)
    first.client.put("/v1/sessions/a", json=CABLE)
    chance, told = random.Random(5), (0, -20.0)
    for number in range(100 if SOAK else 12):
        other.fail(chance.randrange(1, 30), chance.choice((errno.EIO, errno.ENOSPC)), sticky=chance.random() < 0.5)
        answer = first.client.patch("/v1/sessions/a", json=load(-float(number)))
        other.mend()
        if answer.status_code == 200:
            told = (answer.json()["revision"], -float(number))
        else:
            problem(answer, 507, "not-stored")
    first.end(signal.SIGKILL)
    assert told[0] > 0
    with sqlite3.connect(other.path / "sessions.db") as database:
        assert database.execute("PRAGMA integrity_check").fetchone() == ("ok",)
    second = Served(state=str(other.path / "sessions.db"), workers=1)  # without faults
    try:
        assert second.client.get("/v1/sessions/a").json()["revision"] == told[0]
        scene = second.client.get("/v1/sessions/a/scene").json()
        assert scene["forces"][1].get("vector") == [0, 0, told[1]]
    finally:
        second.end()


@pytest.mark.soak
def test_an_upload_that_finds_no_room_is_a_problem(disk: Disk, served: Served) -> None:
    """Its body, its copy for the reader and the answer are files for a moment: none stays, whichever cannot be
    written."""
    from fuzz.damage import _lines, _written

    drawing, recipe = (
        _written(_lines(), 7),
        b'{"forces": [{"kind": "springs", "lines": "*"}], "anchors": [{"points": "ends:*"}]}',
    )
    refused = 0
    for number in range(1, MOST, STRIDE):
        disk.fail(number, errno.ENOSPC, sticky=True)
        answer = served.client.post("/v1/relax/3dm", files={"file": ("a.3dm", drawing), "recipe": ("r", recipe)})
        failed = disk.mend()
        wait_for(lambda: disk.names <= OURS)
        if answer.status_code == 200:
            if not failed:
                break
            continue
        problem(answer, 507, "not-stored")
        refused += 1
    assert refused >= 3


def test_a_file_that_may_grow_no_further_is_a_full_disk(tmp_path: Path) -> None:
    """RLIMIT_FSIZE instead of a preloaded library: the store refuses and goes on, with what it had."""
    store = Store(tmp_path / "sessions.db")
    store.start()
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    before = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)

    def put(number: int, size: int) -> Any:
        described = {"revision": 0, "iteration": 0, "status": "running", "message": "", "particles": 1}
        return store.submit(rows.put(str(number), "", b"x" * size, described, [])).exception(20.0)

    try:
        assert put(1, 1000) is None
        resource.setrlimit(resource.RLIMIT_FSIZE, (400_000, hard))
        assert getattr(put(2, 1_000_000), "slug", "") == "not-stored"
        assert store.failing
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
        assert put(3, 1_000_000) is None
        assert not store.failing
        kept = store.submit(lambda db: [row[0] for row in db.execute("SELECT key FROM bases ORDER BY key")])
        assert kept.result(20.0) == ["1", "3"]
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
        signal.signal(signal.SIGXFSZ, before)
        store.close()


@contextmanager
def mounted(folder: Path, size: str) -> Iterator[Path]:
    """A disk of this size, where one may be mounted."""
    folder.mkdir()
    mount = shutil.which("mount")
    command = [mount or "mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", str(folder)]
    if mount is None or os.geteuid() != 0 or subprocess.run(command, capture_output=True).returncode:
        pytest.skip("no disk can be mounted here")
    try:
        yield folder
    finally:
        subprocess.run(["umount", "-l", str(folder)], check=True)


def test_a_small_disk_fills_and_empties(tmp_path: Path) -> None:
    """A real full disk."""
    with mounted(tmp_path / "small", "8m") as folder:
        served = Served(state=str(folder / "sessions.db"), workers=1).ready()
        try:
            served.client.put("/v1/sessions/a", json=CABLE)
            (folder / "filler").write_bytes(b"x" * max(0, shutil.disk_usage(folder).free - 4096))
            large = {"pin": [{"particles": [2], "name": "n" * 100}], "gesture": ""}
            answers = [served.client.patch("/v1/sessions/a", json=large) for _ in range(3)]
            problem(answers[-1], 507, "not-stored")
            held = served.client.get("/v1/sessions/a").json()["revision"]
            assert held == sum(answer.status_code == 200 for answer in answers)
            (folder / "filler").unlink()
            assert served.client.patch("/v1/sessions/a", json=large).json()["revision"] == held + 1
        finally:
            served.end()


def _kept(store: Store, key: str, size: int) -> BaseException | None:
    """What refuses a session of this size; None where it is stored."""
    described = {"revision": 0, "iteration": 0, "status": "running", "message": "", "particles": 1}
    return store.submit(rows.put(key, "", os.urandom(size), described, [])).exception(20.0)


@pytest.mark.parametrize("size", [200_000, 1_200_000])
def test_a_disk_that_sessions_have_filled_takes_deletions(size: int, tmp_path: Path) -> None:
    """A deletion writes a log as well, and a log that does not fit into its file is never emptied. The file gives the
    space of the deleted back to the disk."""
    with mounted(tmp_path / "small", "12m") as folder:
        store, made = Store(folder / "sessions.db"), 0
        for each in (size, 4_000):  # until not even a small one fits
            while (refused := _kept(store, str(made), each)) is None:
                made += 1
            assert getattr(refused, "slug", "") == "not-stored"
        for key in range(made):
            assert store.submit(rows.delete(str(key))).result(20.0)
        wait_for(lambda: shutil.disk_usage(folder).free > 10_000_000)
        assert _kept(store, "new", size) is None
        store.close()


def test_the_last_of_a_disk_is_for_deletions(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A row takes its size in the log and in the file; what is left beside them is for the log of a deletion."""
    store, free, size = Store(tmp_path / "sessions.db"), SPARE, 100_000
    assert _kept(store, "a", size) is None
    monkeypatch.setattr(shutil, "disk_usage", lambda folder: SimpleNamespace(free=free))
    assert getattr(_kept(store, "b", size), "slug", "") == "not-stored"
    assert store.submit(rows.delete("a")).result(20.0)
    free = SPARE + 4 * size
    assert _kept(store, "b", size) is None
    store.close()


@pytest.mark.parametrize("error", [errno.ENOSPC, errno.EIO, errno.EROFS, errno.EACCES])
@pytest.mark.parametrize("over", [False, True])
def test_a_file_is_written_whole_or_not_at_all(
    error: int, over: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The Nth call that touches the disk fails, N = 1, 2, ... until none does."""
    target = tmp_path / "model.3dm"
    if over:
        target.write_bytes(b"before")
    refused = 0
    for number in range(1, 50):
        calls = 0

        def failing(real: Callable[..., Any], number: int = number) -> Callable[..., Any]:
            def call(*given: Any, **named: Any) -> Any:
                nonlocal calls
                calls += 1
                if calls == number:
                    raise OSError(error, os.strerror(error))
                return real(*given, **named)

            return call

        with monkeypatch.context() as patch:
            for place, name in ((os, "fsync"), (os, "replace"), (atomic_write.shutil, "copymode")):
                patch.setattr(place, name, failing(getattr(place, name)))
            patch.setattr(atomic_write, "open", failing(open), raising=False)
            try:
                atomic_write.put(target, b"after" * 1000, lambda data: None)
            except InputError as fault:
                assert fault.pointer == "model.3dm" and "cannot be written" in fault.sentence
                refused += 1
        assert [entry.name for entry in tmp_path.iterdir()] == (["model.3dm"] if target.exists() else [])
        if calls < number:
            break
        done = target.exists() and target.read_bytes() == b"after" * 1000
        assert done or (target.read_bytes() == b"before" if over else not target.exists())
        if done and over:
            target.write_bytes(b"before")
        elif done:
            target.unlink()
    assert refused >= 3
    assert target.read_bytes() == b"after" * 1000


@pytest.fixture(scope="module")
def database(tmp_path_factory: pytest.TempPathFactory) -> tuple[bytes, bytes]:
    """A database and its log as a killed server leaves them: three sessions with edits and a checkpoint."""
    folder = tmp_path_factory.mktemp("database")
    served = Served(state=str(folder / "sessions.db"), workers=1)
    for key in "abc":
        served.client.put(f"/v1/sessions/{key}", json=CABLE)
        for value in (-21.0, -22.0, -23.0):
            served.client.patch(f"/v1/sessions/{key}", json=load(value))
        served.client.post(f"/v1/sessions/{key}/step", params={"frames": 2})
    served.end(signal.SIGKILL)
    return (folder / "sessions.db").read_bytes(), (folder / "sessions.db-wal").read_bytes()


def test_sessions_of_a_damaged_database_answer(database: tuple[bytes, bytes], tmp_path: Path) -> None:
    """A running server on one: each session it lists is whole, or is told to be damaged; others are made and edited."""
    for number in range(30 if SOAK else 1):
        chance, folder = random.Random(1000 + number), tmp_path / f"s{number}"
        folder.mkdir()
        main, _ = _merged(database, tmp_path)
        data = bytearray(main)
        for _ in range(40):  # in the pages of the contents rather than in their frame
            data[chance.randrange(4096 * 3, len(data))] ^= 1 << chance.randrange(8)
        (folder / "sessions.db").write_bytes(data)
        served = Served(state=str(folder / "sessions.db"), workers=1)
        try:
            for listed in served.client.get("/v1/sessions").json()["sessions"]:
                answer = served.client.get(f"/v1/sessions/{listed['key']}/state")
                assert answer.status_code in (200, 507), answer.text
            assert served.client.put("/v1/sessions/new", json=CABLE).status_code == 201
            assert served.client.patch("/v1/sessions/new", json=load(-3.0)).status_code == 200
        finally:
            assert served.end()[0] == 0


def _merged(database: tuple[bytes, bytes], folder: Path) -> tuple[bytes, bytes]:
    """The same with all of the log in the database."""
    path = folder / "merged.db"
    for end, data in zip(("", "-wal"), database, strict=True):
        path.with_name(path.name + end).write_bytes(data)
    connection = sqlite3.connect(path)
    connection.execute("PRAGMA wal_checkpoint(TRUNCATE)")
    connection.close()
    return path.read_bytes(), b""
