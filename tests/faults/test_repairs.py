"""Repairs of a store under faults of their own: kill -9 at each of their steps, a full disk, two at once."""

from __future__ import annotations

import os
import shutil
import signal
import tempfile
from collections.abc import Iterator
from pathlib import Path

import pytest

import forking
from hookean_server.keeping import opening
from hookean_server.keeping.manifest import Manifest
from hookean_server.sessions import rows
from hookean_server.store import Store
from serving import SOAK
from soak import sampled

from .stores import copied, lived
from .test_damaged_stores import account, opened

pytestmark = pytest.mark.skipif(os.name != "posix", reason="kill -9")

CODE = """
import os, signal, sys
from hookean_server.keeping import opening, manifest
left = int(sys.argv[2])
def counted(place, name):
    real = getattr(place, name)
    def call(*given, **named):
        global left
        left -= 1
        if left == 0:
            os.kill(os.getpid(), signal.SIGKILL)
        return real(*given, **named)
    setattr(place, name, call)
for place, name in ((os, "replace"), (os, "open"), (os, "fsync"), (opening, "_write"), (opening, "_writable"),
                    (opening.Path, "open"), (opening.Path, "unlink"), (opening.Path, "mkdir")):
    counted(place, name)
opened = opening.open_store(opening.Path(sys.argv[1]))
opened.db.close()
"""


@pytest.fixture
def tmp_path() -> Iterator[Path]:
    """A folder in memory, where there is one: a kill -9 does not depend on the disk, and waits for it take minutes."""
    with tempfile.TemporaryDirectory(dir="/dev/shm" if os.access("/dev/shm", os.W_OK) else None) as folder:
        yield Path(folder)


METHODS = {"checkpoint": "checkpoint", "shrink": "shrink", "rewrite": "tidy"}


def repaired(path: Path, step: int) -> int:
    """Open a store in a process of its own that is killed at a step; its exit code."""
    return forking.run(CODE, str(path), str(step)).returncode


@pytest.mark.parametrize("harm", sampled(["bits", "wal gone"], 2))
def test_a_repair_that_is_killed_goes_on_at_the_next_start(harm: str, tmp_path: Path) -> None:
    """At every step that changes a file: afterwards all is there or named as it would be without the kill, and nothing
    unfinished is left."""
    ledger, _, after = lived(tmp_path / "life", 3)
    if harm == "bits":
        data = bytearray((after / "sessions.db").read_bytes())
        for place in range(5000, len(data), 9001):
            data[place] ^= 16
        (after / "sessions.db").write_bytes(data)
    else:
        (after / ("sessions.db" if harm == "db gone" else "sessions.db-wal")).unlink()
    expected, kills = None, 0
    for step in range(60):
        folder = tmp_path / f"{step}"
        copied(after, folder)
        killed = repaired(folder / "sessions.db", step) == -signal.SIGKILL if step else False
        store, sessions, jobs = opened(folder / "sessions.db")
        try:
            account(ledger, store, sessions, jobs)
            losses = sorted((loss.key, loss.what) for report in store.reports for loss in report.losses)
        finally:
            store.close()
        expected = expected or (sessions, jobs, sorted(set(losses)))
        assert (sessions, jobs, sorted(set(losses))) == expected, step
        names = {entry.name for entry in folder.iterdir() if opening.DAMAGED not in entry.name}
        assert names <= {"sessions.db", "sessions.db.manifest"}, step
        shutil.rmtree(folder)
        kills += killed
        if step and not killed:
            break
    else:
        pytest.fail("killed in every step")
    assert kills >= 15


def test_a_repair_without_room_is_refused_and_goes_on_later(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The disk is full while the new file is made: a sentence, and all damaged files are kept."""
    ledger, _, after = lived(tmp_path / "life", 4)
    copied(after, tmp_path / "s")
    (tmp_path / "s" / "sessions.db-wal").unlink()

    def full(*given: object) -> None:
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as patch:
        patch.setattr(opening, "build", full)
        with pytest.raises(OSError, match="No space left"):
            Store(tmp_path / "s" / "sessions.db").start()
    store, sessions, jobs = opened(tmp_path / "s" / "sessions.db")
    try:
        whole, lost = account(ledger, store, sessions, jobs)
    finally:
        store.close()
    assert whole and lost


@pytest.mark.parametrize("what", ["checkpoint", "shrink", "rewrite"])
def test_a_kill_in_the_middle_of_tidying_loses_nothing(what: str, tmp_path: Path) -> None:
    """kill -9 of a process that empties the log, shrinks the file or writes the manifest again, without a pause."""
    code = f"""
import os, signal, sys, threading
from pathlib import Path
sys.path.insert(0, {str(Path(__file__).parents[1])!r})
from faults.stores import Life
from hookean_server import store as module
from hookean_server.keeping import manifest
module.IDLE, module.BEHIND, module.FREE, module.STEP, manifest.LARGEST = 0.0, 0, 0, 1, 0
store = module.Store(Path(sys.argv[1]))
life = Life(store, int(sys.argv[2]))
real, count = getattr(module._Writer, {METHODS[what]!r}), [0]
def call(self):
    count[0] += 1
    if count[0] == 3 + int(sys.argv[2]) % 7:
        threading.Timer(0.0005 * (int(sys.argv[2]) % 5), lambda: os.kill(os.getpid(), signal.SIGKILL)).start()
    return real(self)
setattr(module._Writer, {METHODS[what]!r}, call)
for key in "abcde":
    life.put(key)
while True:
    life.some(1)
    print(len(life.ledger.bases), sum(map(len, life.ledger.edits.values())), flush=True)
"""
    for seed in range(6 if SOAK else 1):
        path = tmp_path / str(seed) / "sessions.db"
        path.parent.mkdir()
        done = forking.run(code, str(path), str(seed))
        assert done.returncode == -signal.SIGKILL, done.stderr
        store, sessions, _ = opened(path)
        store.close()
        assert not store.reports and not store.note
        if said := done.stdout.strip().splitlines():
            least = int(said[-1].split()[0])
            assert abs(len(sessions) - least) <= 1  # one more may have been made or deleted


def test_a_store_opens_while_the_disk_is_full(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The manifest cannot be written again then: it goes on as it is, and nothing is missing at the next start."""
    ledger, _, after = lived(tmp_path / "life", 5)
    copied(after, tmp_path / "s")
    path = tmp_path / "s" / "sessions.db"
    with (tmp_path / "s" / "sessions.db.manifest").open("ab") as file:
        file.write(b"0123 torn")

    def full(self: Manifest) -> Iterator[bytes]:
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as patch:
        patch.setattr(Manifest, "_lines", full)
        store, _, _ = opened(path)
        store.submit(rows.delete(sorted(ledger.bases)[0])).result(20.0)
        store.close()
    del ledger.bases[sorted(ledger.bases)[0]]
    store, sessions, jobs = opened(path)
    try:
        assert account(ledger, store, sessions, jobs)[1] == 0 and set(sessions) == set(ledger.bases)
        assert not store.reports and not store.note
    finally:
        store.close()


def test_a_server_whose_store_cannot_be_opened_says_why(tmp_path: Path) -> None:
    """A sentence and the exit code 2, no traceback: here a folder is in its place."""
    (tmp_path / "sessions.db.manifest").mkdir()
    code = "import sys; from hookean_server.lifecycle.main import serve; from hookean_server.settings import Settings;"
    code += f"sys.exit(serve(port=0, settings=Settings(state={str(tmp_path / 'sessions.db')!r})))"
    done = forking.run(code)
    assert done.returncode == 2 and "sessions.db.manifest" in done.stderr and "Traceback" not in done.stderr
