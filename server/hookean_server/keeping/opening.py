"""The store's file at the start: checked, taken up as it is, or salvaged.

Damage never deletes anything: the files as they were found go into a dated folder beside the store, and its
`report.json` names what could not be read out of them. The report is shown until that folder is deleted.
"""

from __future__ import annotations

import itertools
import json
import logging
import mmap
import os
import re
import secrets
import shutil
import sqlite3
import time
from collections.abc import Iterator
from contextlib import closing, suppress
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any

from hookean_server.keeping import database, manifest, pages
from hookean_server.keeping.choosing import Chosen, Found, Loss
from hookean_server.keeping.database import Database
from hookean_server.keeping.manifest import Manifest, Read
from hookean_server.keeping.schema import APPLICATION, TABLES, VERSION

log = logging.getLogger("hookean.store")

CUT = "The manifest of the store was damaged, so it is unknown whether the last writes are missing from the store."
DAMAGED, BACKUP, NEW = ".damaged-", ".backup-", ".salvage"
REPORT = "report.json"
MARRED = 4
"""Characters of the id of a store that damage may have changed: those of two stores differ in 15 of 16."""


class Refused(OSError):
    """A store that this version does not open; the sentence has the reason and the remedy."""


class Broken(Exception):
    """A damaged store; the sentence has the first damage that was found."""


@dataclass(frozen=True)
class Report:
    """A salvage: why, what is lost, and the folder with the files as they were found."""

    when: str
    why: str
    copy: str
    losses: list[Loss] = field(default_factory=list)

    @property
    def sentence(self) -> str:
        """The report in a sentence, with the names of losses."""
        lost = f"{len(self.losses)} losses" if len(self.losses) != 1 else "1 loss"
        what = f"{lost}: {' '.join(loss.what for loss in self.losses)}" if self.losses else "Nothing is lost."
        return f"{self.head} {what} The damaged files are kept in {self.copy}."

    @property
    def head(self) -> str:
        """The same without names."""
        return f"The store was damaged on {self.when} ({self.why}) and has been repaired."


@dataclass
class Opened:
    """A store that is open for writing."""

    db: Database
    manifest: Manifest | None
    note: str = ""


def open_store(path: Path | None) -> Opened:
    """Open the file at `path`, or make one; without a path a store in memory. Raises OSError."""
    if path is None:
        db = database.connect(None)
        database.create(db, "")
        database.prepare(db)
        db.watch({})
        return Opened(db, None)
    path.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
    _sweep(path)
    try:
        return _opened(path)
    except (sqlite3.Error, UnicodeDecodeError) as error:
        raise OSError(f"{path} cannot be opened ({error})") from None


def _opened(path: Path) -> Opened:
    said = manifest.read(manifest.place(path))
    refuse_other(path, said)
    _roll_back(path, said)
    unfinished = _unfinished(path)
    if not (unfinished or said is not None or path.exists() or _wal(path).exists() or _backups(path)):
        _create(path)
        return _writable(path)
    if unfinished and (report := _built(path)) is not None and report.copy in [f.name for f in unfinished]:
        return _finished(path, report)
    try:
        if unfinished:
            raise Broken("a repair was interrupted")
        note = inspect(path, said)
    except Broken as broken:
        return salvage(path, said, str(broken))
    return _writable(path, note)


def reopened(path: Path, opened: Opened) -> Opened:
    """The same store where its file was deleted, or another one put in its place, while it is open: all that it holds
    is written to that place again. What was put there stays beside it. Raises OSError or sqlite3.Error."""
    log.error("%s was deleted or replaced while in use; it is being rewritten", path.name)
    new = path.with_name(path.name + NEW)
    new.unlink(missing_ok=True)
    opened.db.execute("VACUUM INTO ?", (str(new),))
    os.chmod(new, 0o600)
    with new.open("rb") as written:
        os.fsync(written.fileno())
    opened.db.close()
    if opened.manifest is not None:
        opened.manifest.close()
    if path.exists():
        os.replace(path, path.with_name(f"{path.name}.replaced-{time.strftime('%Y%m%d-%H%M%S')}"))
    for file in (_wal(path), _shm(path)):
        file.unlink(missing_ok=True)
    os.replace(new, path)
    return _writable(path)


def refuse_other(path: Path, said: Read | None) -> None:
    """Raises Refused where a store has another version than this one writes."""
    version = _version(path, said)
    if version not in (0, VERSION):
        raise Refused(
            f"{path} was written by another version of hookean (store version {version}; this one supports {VERSION}). "
            "Install that version, or set HOOKEAN_STATE to another folder. Nothing was changed."
        )


def _create(path: Path) -> None:
    """A new file, whole or not at all: one that is there and empty has been damaged."""
    new = path.with_name(path.name + NEW)
    _empty(new, secrets.token_hex(8)).close()
    for old in (_journal(path), _wal(path), _shm(path)):
        old.unlink(missing_ok=True)
    os.replace(new, path)


def _roll_back(path: Path, said: Read | None) -> None:
    """Undo what was interrupted before the file had a write-ahead log: a look that changes nothing is refused until
    then. In a copy, which counts if it is whole: the journal may be damaged, or of another file."""
    if not (_there(_journal(path)) and _there(path)) or _there(_wal(path)):
        return
    new = path.with_name(path.name + NEW)
    shutil.copyfile(path, new)
    shutil.copyfile(_journal(path), _journal(new))
    with suppress(sqlite3.Error, Broken):
        with closing(database.connect(new)) as db:
            db.execute("PRAGMA user_version").fetchone()
        inspect(new, said)
        os.chmod(new, 0o600)
        with new.open("rb") as file:
            os.fsync(file.fileno())
        os.replace(new, path)
        _journal(path).unlink()
    _sweep(path)


def _writable(path: Path, note: str = "") -> Opened:
    """The file, checked before, open for writing, with its manifest."""
    db = database.connect(path)
    try:
        database.prepare(db)
        db.path = path
        owners, last = database.owners(db)
        db.seq = max(last, int(db.marked("seq") or 0))
        db.watch(owners)
        return Opened(db, Manifest(manifest.place(path), db.marked("store"), int(db.marked("commit")), owners), note)
    except BaseException:
        db.close()
        raise


def _version(path: Path, said: Read | None) -> int:
    """The version of a file by its header; 0 where it has none. A version that its manifest does not know is damage."""
    try:
        with path.open("rb") as file:
            head = file.read(100)
    except FileNotFoundError:
        return 0
    if len(head) < 100 or not head.startswith(b"SQLite format 3\0"):
        return 0
    version, application = int.from_bytes(head[60:64], "big"), int.from_bytes(head[68:72], "big")
    if application != APPLICATION or (said is not None and said.version and version != said.version):
        return 0
    return version


# checking


def inspect(path: Path, said: Read | None) -> str:
    """Check that a file is whole and that nothing is missing of what its manifest names; a note where that cannot be
    seen. Nothing is written. Raises Broken."""
    if not _there(path):
        raise Broken("the database is missing" if not path.exists() else "the database is empty")
    with path.open("rb") as file:
        if (form := file.read(19)[18:]) > b"\2":
            raise Broken(f"its header says write version {form[0]}, which nothing can be written to")
    db = reading(path)
    try:
        db.execute("BEGIN")
        _structure(db)
        return _complete(db, said)
    except sqlite3.OperationalError as error:
        if "readonly" in str(error) and _there(_journal(path)):
            raise Broken("a transaction that was interrupted cannot be undone") from None
        if any(words in str(error) for words in ("unable to open", "locked", "readonly", "read-only", "I/O")):
            raise
        raise Broken(str(error)) from None
    except (sqlite3.Error, UnicodeDecodeError, ValueError, TypeError) as error:
        raise Broken(str(error)) from None
    finally:
        db.close()


def reading(path: Path) -> Database:
    """A connection that changes nothing. Raises sqlite3.Error, also where the file is empty: SQLite would delete its
    log."""
    if not _there(path):
        raise sqlite3.OperationalError(f"{path} is missing or empty")
    name = f"{path.resolve().as_uri()}?mode=ro"
    db = sqlite3.connect(name, uri=True, isolation_level=None, factory=Database)
    db.text_factory = lambda text: text.decode("utf-8", "replace")
    return db


def _structure(db: Database) -> None:
    """All pages fit together, and all rows are as they were written."""
    found = db.execute("PRAGMA integrity_check(1)").fetchone()
    if found != ("ok",):
        raise Broken(" ".join(str(found[0]).split())[:200])
    if db.execute("PRAGMA foreign_key_check").fetchone():
        raise Broken("rows are missing that others belong to")
    (version,) = db.execute("PRAGMA user_version").fetchone()
    (application,) = db.execute("PRAGMA application_id").fetchone()
    if (version, application) != (VERSION, APPLICATION):
        raise Broken(f"its header says version {version} of application {application:#x}")
    for table in TABLES.values():
        for row in db.execute(f"SELECT {', '.join(table.columns)} FROM {table.name}"):
            if not table.whole(row):
                raise Broken(f"a row of {table.name} differs from its checksum")


def _complete(db: Database, said: Read | None) -> str:
    """All that the manifest names is there, and nothing else."""
    owners, _ = database.owners(db)
    commit, _ = int(db.marked("commit") or -1), int(db.marked("seq") or 0)
    if said is None or not said.store:
        return "The manifest of the store was missing, so it is unknown whether anything is missing from the store."
    if said.store != db.marked("store"):
        raise Broken("the database belongs to another store")
    said = said.settled(commit)
    if commit < said.commit:
        raise Broken(f"the last {said.commit - commit} writes are missing")
    if commit > said.commit:
        return CUT
    missing = []
    for key in {*owners, *said.owners}:
        mine, known = owners.get(key), said.owners.get(key)
        if mine is not None and known is not None and mine.same(known):
            continue
        if said.whole or (mine is not None and mine.seq <= (known.seq if known is not None else 0)):
            raise Broken(f"{key[0]} {key[1]} differs from its manifest")
        if mine is None:  # the line of its deletion may be what cannot be read
            missing.append(f"{key[0]} {key[1]}")
    if said.whole:
        return ""
    return f"{CUT} It names {', '.join(sorted(missing))}, which may have been deleted." if missing else CUT


# salvaging


def salvage(path: Path, said: Read | None, why: str) -> Opened:
    """Put the files aside and make a new one of all rows that are whole. Raises OSError; the next start goes on from
    there then."""
    log.error("%s is damaged (%s) and is being repaired", path.name, why)
    copy = _put_aside(path)
    folders = _unfinished(path)
    if (before := manifest.read(manifest.place(folders[0] / path.name))) is not None:
        said = before
    chosen = Found(_rows(path, folders, said), said).choose()
    store = said.store if said is not None and said.store else secrets.token_hex(8)
    new = path.with_name(path.name + NEW)
    report = Report(time.strftime("%Y-%m-%d %H:%M:%S"), why, copy.name, chosen.losses)
    build(new, chosen, store, said.commit if said is not None else 0, report)
    os.replace(new, path)
    return _finished(path, report)


def _finished(path: Path, report: Report) -> Opened:
    """The new file is in its place; the rest may be done again, where it is interrupted."""
    manifest.place(path).unlink(missing_ok=True)
    opened = _writable(path)
    try:
        for folder in sorted(_unfinished(path), key=lambda found: found.name == report.copy):  # that of the report last
            _write(folder / REPORT, json.dumps(asdict(report), indent=1).encode())
    except OSError:
        opened.db.close()
        if opened.manifest is not None:
            opened.manifest.close()
        raise
    _log(report)
    return opened


def _built(path: Path) -> Report | None:
    """The report of the repair that made a file; None where none did, or it cannot be read."""
    with suppress(sqlite3.Error, ValueError, TypeError, KeyError), closing(reading(path)) as db:
        return _report(json.loads(db.marked("repair")))
    return None


def _report(values: dict[str, Any]) -> Report:
    return Report(**{**values, "losses": [Loss(**loss) for loss in values["losses"]]})


def _log(report: Report) -> None:
    """The log has only the number of losses: names are for clients that may read the sessions."""
    log.error("%s It has %d losses; `hookean store check` lists them.", report.head, len(report.losses))


def _rows(path: Path, folders: list[Path], said: Read | None) -> Iterator[pages.Row]:
    """All versions of all rows of this store, in the damaged files and in the backups. A log has the id of its store in
    each transaction: it may be of another one than its file."""
    store = said.store if said is not None else ""
    for file in [*(folder / path.name for folder in folders), *_backups(path)]:
        yield from pages.rows(*(part if not store or _belongs(part, store) else None for part in (file, _wal(file))))


def _belongs(file: Path, store: str) -> bool:
    """Whether a file may be of this store: it may unless it names another one."""
    if not _there(file):
        return True
    with file.open("rb") as opened, mmap.mmap(opened.fileno(), 0, access=mmap.ACCESS_READ) as data:
        found = set(re.findall(rb"store([0-9a-f]{16})", data))
    return not found or any(sum(map(int.__ne__, one, store.encode())) <= MARRED for one in found)


def _put_aside(path: Path) -> Path:
    """Move the files into a dated folder; into that of a repair that was interrupted before it had them all."""
    begun = [folder for folder in _unfinished(path) if not (folder / path.name).exists()]
    copy = begun[-1] if begun else _dated(path)
    copy.mkdir(mode=0o700, exist_ok=True)
    if manifest.place(path).exists() and not manifest.place(copy / path.name).exists():
        _write(manifest.place(copy / path.name), manifest.place(path).read_bytes())
    _shm(path).unlink(missing_ok=True)
    for file in (_journal(path), _wal(path), path):
        if (copy / file.name).exists():  # the log is there, and a look at the database has made an empty one
            file.unlink(missing_ok=True)
        elif file.exists():
            os.replace(file, copy / file.name)
    return copy


def build(path: Path, chosen: Chosen, store: str, commit: int, report: Report) -> None:
    """A new file of the rows that are kept, with the report."""
    order = list(TABLES)
    with closing(_empty(path, store)) as db:
        db.seq = chosen.seq
        db.execute("BEGIN IMMEDIATE")
        for name, values in chosen.changed:
            db.keep(name, **values)
        for name, row in sorted(chosen.rows, key=lambda found: order.index(found[0])):
            db.execute(f"INSERT OR REPLACE INTO {name} VALUES ({', '.join('?' * len(row))})", row)
        db.mark("commit", commit)
        db.mark("seq", db.seq)
        db.execute("COMMIT")
        db.mark("repair", json.dumps(asdict(report)))
    with path.open("rb") as file:
        os.fsync(file.fileno())


def _empty(path: Path, store: str) -> Database:
    path.unlink(missing_ok=True)
    os.close(os.open(path, os.O_CREAT | os.O_RDWR, 0o600))
    db = database.connect(path)
    database.create(db, store)
    return db


# what is beside it


def reports(path: Path | None) -> list[Report]:
    """Salvages whose copies are still there, the latest last."""
    found = []
    for folder in _copies(path) if path is not None else []:
        with suppress(OSError, ValueError, TypeError, KeyError):
            values: dict[str, Any] = json.loads((folder / REPORT).read_text(encoding="utf-8"))
            found.append(replace(_report(values), copy=folder.name))
    return found


def _dated(path: Path) -> Path:
    """A new folder for damaged files; later ones have later names, also within a second."""
    name = f"{path.name}{DAMAGED}{time.strftime('%Y%m%d-%H%M%S')}"
    numbered = (path.with_name(f"{name}-{number:03}") for number in itertools.count(len(_copies(path))))
    return next(folder for folder in numbered if not folder.exists())


def _copies(path: Path) -> list[Path]:
    return sorted(f for f in path.parent.glob(f"{path.name}{DAMAGED}*") if f.is_dir())


def _unfinished(path: Path) -> list[Path]:
    """Copies of repairs that were interrupted."""
    return [folder for folder in _copies(path) if not (folder / REPORT).exists()]


def _backups(path: Path) -> list[Path]:
    return sorted(f for f in path.parent.glob(f"{path.name}{BACKUP}[0-9]"))


def _sweep(path: Path) -> None:
    """Take away what an interrupted start or end has left unfinished."""
    for pattern in (f"{path.name}{NEW}*", f"{path.name}{BACKUP}new*", f"{path.name}.manifest.new"):
        for file in path.parent.glob(pattern):
            with suppress(OSError):
                file.unlink()


def _there(path: Path) -> bool:
    return path.exists() and path.stat().st_size > 0


def _write(path: Path, data: bytes) -> None:
    """A file with these bytes, whole or not at all. Raises OSError."""
    new = path.with_name(path.name + ".new")
    with new.open("wb") as file:
        file.write(data)
        file.flush()
        os.fsync(file.fileno())
    os.replace(new, path)


def _journal(path: Path) -> Path:
    return path.with_name(path.name + "-journal")


def _wal(path: Path) -> Path:
    return path.with_name(path.name + "-wal")


def _shm(path: Path) -> Path:
    return path.with_name(path.name + "-shm")
