"""Stores under two faults at once: damage, and a repair, a start or a command that is cut short or comes between."""

from __future__ import annotations

import os
import shutil
import sqlite3
import time
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import pytest

import forking
from hookean_server.keeping import commands, manifest, opening
from hookean_server.sessions import rows
from hookean_server.store import Store

from .stores import FILES, Ledger, copied, described, lived
from .test_damaged_stores import account, opened

pytestmark = pytest.mark.skipif(os.name != "posix", reason="kill -9")

KILLED = """
import os, signal, sys, time
from hookean_server.keeping import opening
real, now = os.replace, time.strftime
def replace(source, target):
    if str(source).endswith(sys.argv[2]):
        os.kill(os.getpid(), signal.SIGKILL)
    real(source, target)
os.replace = replace
time.strftime = lambda form, *given: now(form, time.localtime(time.time() - float(sys.argv[3])))
opening.open_store(opening.Path(sys.argv[1]))
"""
HOT = """
import os, signal, sys
from hookean_server.keeping import database
db = database.connect(database.Path(sys.argv[1]))
db.execute("PRAGMA cache_size = 1")
db.execute("BEGIN")
db.execute("UPDATE marks SET value = 'x'")
db.execute("CREATE TABLE long (a)")
db.executemany("INSERT INTO long VALUES (?)", [(bytes(5000),)] * 50)
os.kill(os.getpid(), signal.SIGKILL)
"""


@pytest.fixture(scope="module")
def memory(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("lives")


@pytest.fixture(scope="module")
def life(memory: Path) -> tuple[Ledger, Path]:
    ledger, _, after = lived(memory / "life", 4)
    return ledger, after


@pytest.fixture
def path(life: tuple[Ledger, Path], tmp_path: Path) -> Iterator[Path]:
    copied(life[1], tmp_path / "s")
    yield tmp_path / "s" / "sessions.db"


def accounted(ledger: Ledger, path: Path) -> tuple[int, int]:
    """What is whole and what is named as lost after the next start; nothing else is missing."""
    store, sessions, jobs = opened(path)
    try:
        assert not store.note
        return account(ledger, store, sessions, jobs)
    finally:
        store.close()


def begun(path: Path) -> None:
    """Open the store and close it again: all is in the file then."""
    store = Store(path)
    store.start()
    store.close()


def changed(path: Path, name: str, value: str) -> None:
    """Put a value into a mark, as damage would, with all else as it was."""
    with closing(sqlite3.connect(path)) as db:
        db.execute("UPDATE marks SET value = ? WHERE name = ?", (value, name))
        db.commit()


@pytest.mark.parametrize("harm", ["log", "gone", "empty"])
def test_a_backup_of_a_damaged_store_takes_nothing_from_it(
    harm: str, life: tuple[Ledger, Path], path: Path, tmp_path: Path
) -> None:
    """SQLite empties a log into its file when the last connection closes, up to the first frame that is damaged, and
    deletes the log of a file without pages (https://www.sqlite.org/walformat.html, 4.5)."""
    if harm == "log":
        log = bytearray((path.parent / FILES[1]).read_bytes())
        log[32 + 4120 * 3 + 500] ^= 1
        (path.parent / FILES[1]).write_bytes(log)
    elif harm == "gone":
        path.unlink()
    else:
        path.write_bytes(b"")
    copied(path.parent, tmp_path / "same")
    before = {name: (path.parent / name).read_bytes() for name in FILES if (path.parent / name).exists()}
    commands.run("backup", path, None)
    assert {name: (path.parent / name).read_bytes() for name in FILES if (path.parent / name).exists()} == before
    assert accounted(life[0], path) == accounted(life[0], tmp_path / "same" / "sessions.db")


def test_a_repair_of_an_empty_file_that_is_killed_keeps_the_log(
    life: tuple[Ledger, Path], path: Path, tmp_path: Path
) -> None:
    """Killed before the log is aside: SQLite deletes the log of an empty file also where it may only read."""
    path.write_bytes(b"")
    copied(path.parent, tmp_path / "same")
    assert forking.run(KILLED, str(path), "-wal", "0").returncode < 0
    assert accounted(life[0], path) == accounted(life[0], tmp_path / "same" / "sessions.db")


def test_a_repair_that_is_killed_after_the_clock_was_set_back_goes_on(path: Path) -> None:
    """The folder of the second repair has an earlier name than that of the first, whose report is in the database."""
    path.with_name("sessions.db-wal").unlink()
    store = Store(path)
    store.start()
    store.submit(rows.put("n", "Label n", b"base", described(0), [])).result(20.0)
    store.submit(rows.edit("n", 1, "", b"{}")).result(20.0)
    folder = path.parent.with_name("killed")
    shutil.copytree(path.parent, folder)
    store.close()
    path = folder / "sessions.db"
    log = bytearray((folder / FILES[1]).read_bytes())
    log[32 + 300] ^= 1
    (folder / FILES[1]).write_bytes(log)
    assert forking.run(KILLED, str(path), "sessions.db", "3600").returncode < 0
    assert accounted(Ledger({"n": b"base"}, {"n": [b"{}"]}, {"n": b""}), path) == (1, 0)


def test_files_of_two_repairs_in_the_same_second_are_kept(
    life: tuple[Ledger, Path], path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also where the folder of a third one was deleted: the number of folders is the one in a name then."""
    monkeypatch.setattr(time, "strftime", lambda form, *given: "20260101-000000")
    path.with_name("sessions.db-wal").unlink()
    kept = path.with_name("sessions.db.damaged-20260101-000000-001")
    kept.mkdir()
    (kept / "sessions.db").write_bytes(b"first")
    (kept / "report.json").write_text("{}")
    found = path.read_bytes()
    assert accounted(life[0], path)[0]
    assert (kept / "sessions.db").read_bytes() == b"first"
    assert found in [file.read_bytes() for file in path.parent.glob("*damaged*/sessions.db")]


@pytest.mark.parametrize("what", ["report.json.new", "sessions.db.manifest.new"])
def test_names_of_losses_survive_a_full_disk(
    what: str, life: tuple[Ledger, Path], path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The report, and the copy of the manifest that it is made of, are whole or not there."""
    path.with_name("sessions.db-wal").unlink()
    real = os.fsync

    def full(file: int) -> None:
        if os.path.basename(os.readlink(f"/proc/self/fd/{file}")) == what and ".damaged-" in os.readlink(
            f"/proc/self/fd/{file}"
        ):
            os.ftruncate(file, 40)
            raise OSError(28, "No space left on device")
        real(file)

    if not Path("/proc/self/fd").exists():
        pytest.skip("names of open files are in /proc")
    with monkeypatch.context() as patch:
        patch.setattr(os, "fsync", full)
        with pytest.raises(OSError, match="No space left"):
            opening.open_store(path)
    whole, lost = accounted(life[0], path)
    assert whole and lost


@pytest.mark.parametrize("name", ["seq", "store"])
def test_a_mark_with_a_damaged_character_is_repaired(name: str, life: tuple[Ledger, Path], path: Path) -> None:
    """Marks have no checksum: a last row number that does not exist, and the id of the store with another digit."""
    begun(path)
    with closing(sqlite3.connect(path)) as db:
        (value,) = db.execute("SELECT value FROM marks WHERE name = ?", (name,)).fetchone()
    changed(path, name, value[:-1] + ("q" if name == "seq" else "0" if value[-1] != "0" else "1"))
    assert accounted(life[0], path) == (len(life[0].bases) + len(life[0].requests), 0)


def test_a_file_that_says_it_is_only_read_is_repaired(life: tuple[Ledger, Path], path: Path) -> None:
    """SQLite only reads a file whose write version it does not know (https://www.sqlite.org/fileformat2.html, 1.3.3);
    every write would be refused."""
    begun(path)
    data = bytearray(path.read_bytes())
    data[18] ^= 4
    path.write_bytes(data)
    assert accounted(life[0], path)[1] == 0
    store = Store(path)
    store.submit(rows.put("n", "Label n", b"base", described(0), [])).result(20.0)
    store.close()


def interrupted(path: Path) -> Path:
    """The journal of a transaction that was killed, beside the file that it is of."""
    begun(path)
    with closing(sqlite3.connect(path)) as db:
        assert db.execute("PRAGMA journal_mode = DELETE").fetchone() == ("delete",)
    assert forking.run(HOT, str(path)).returncode < 0
    journal = path.with_name("sessions.db-journal")
    assert journal.stat().st_size
    return journal


def test_a_transaction_in_a_journal_is_undone_at_the_start(life: tuple[Ledger, Path], path: Path) -> None:
    """A file is put into write-ahead mode by a transaction with a journal, at the first start and after each repair;
    where that is killed a look that changes nothing is refused."""
    journal = interrupted(path)
    assert accounted(life[0], path)[1] == 0
    assert not journal.exists() and not list(path.parent.glob("*damaged*"))


def test_a_journal_of_another_store_undoes_nothing(
    memory: Path, life: tuple[Ledger, Path], path: Path, tmp_path: Path
) -> None:
    """As beside a copy that somebody has put back. SQLite puts the pages of any journal into its file: all of the file
    would be lost (https://www.sqlite.org/howtocorrupt.html, section 1.4)."""
    _, _, other = lived(memory / "other", 6)
    copied(other, tmp_path / "other")
    journal = interrupted(tmp_path / "other" / "sessions.db")
    begun(path)
    shutil.copyfile(journal, path.parent / journal.name)
    assert accounted(life[0], path) == (len(life[0].bases) + len(life[0].requests), 0)


def test_a_log_of_another_store_adds_nothing(
    memory: Path, life: tuple[Ledger, Path], path: Path, tmp_path: Path
) -> None:
    """Its sessions have the same keys, and its rows are whole; the ids of the stores differ."""
    _, _, other = lived(memory / "logged", 5)
    begun(path)
    shutil.copyfile(other / FILES[1], path.parent / FILES[1])
    assert accounted(life[0], path) == (len(life[0].bases) + len(life[0].requests), 0)


@pytest.mark.parametrize("name", ["100%25", "a%00b", "%zz", "a?b#c"])
def test_a_folder_may_have_any_name(name: str, life: tuple[Ledger, Path], path: Path) -> None:
    """SQLite reads a file that must not change by a URI, in which %25 is another character (RFC 3986, 2.1)."""
    path = path.parent.rename(path.parent.with_name(name)) / path.name
    assert accounted(life[0], path) == (len(life[0].bases) + len(life[0].requests), 0)


def test_a_line_of_a_manifest_does_not_go_on_in_a_torn_one(tmp_path: Path) -> None:
    """The disk takes half of the line that follows a write, and later the next write."""
    told = manifest.Manifest(tmp_path / "m", "0" * 16, 0, {})
    real = told._file

    class Full:
        def write(self, line: bytes) -> int:
            assert real is not None
            return real.write(line[: len(line) // 2 if b"done" in line and told.commit == 1 else len(line)])

        def __getattr__(self, name: str) -> object:
            return getattr(real, name)

    told._file = Full()  # type: ignore[assignment]
    for _ in range(2):
        changes: dict[manifest.Key, manifest.Owner | None] = {("session", "a"): manifest.Owner("a", 1, 1, 1, 1, 1)}
        told.prepare(changes)
        told.done(changes)
    told.close()
    found = manifest.read(tmp_path / "m")
    assert found is not None and found.whole and found.commit + (found.pending is not None) == 2


def test_a_command_says_that_losses_cannot_be_named(path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The manifest is written again by whatever opens the store first: that has to say that it was missing."""
    path.with_name("sessions.db.manifest").unlink()
    assert commands.run("salvage", path, None) == 1
    assert "it is unknown whether anything is missing" in capsys.readouterr().out
