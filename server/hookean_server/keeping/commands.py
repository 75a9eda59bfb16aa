"""`hookean store`: check, repair, copy and compact the file of sessions and jobs."""

from __future__ import annotations

import sqlite3
import sys
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from pathlib import Path
from typing import Annotated

import typer

from hookean.commands.command import new
from hookean_server.keeping import backups, manifest
from hookean_server.keeping.opening import Broken, inspect, open_store, refuse_other, reports
from hookean_server.lifecycle.discovery import SESSIONS, Held, Lock, folder

RUNS = "A hookean server uses this store; stop it first with: hookean serve --stop"


app = new()


@app.command()
def store(
    action: Annotated[str, typer.Argument(help="check, salvage, backup or compact")],
    target: Annotated[Path | None, typer.Argument(help="The file to write; for backup only")] = None,
) -> None:
    """Check, repair, copy or compact the file in which the service stores sessions and jobs.

    check: print damage and losses. salvage: repair the file and keep a copy. backup: copy it to another file,
    also while the service runs. compact: free unused space. Exits with 0 if nothing is damaged or lost, 1 if something
    is, 2 if the action is not possible. HOOKEAN_STATE sets the folder of the file.
    """
    raise typer.Exit(run(action, folder() / SESSIONS, target))


def run(action: str, path: Path, target: Path | None) -> int:
    """Run an action on the store at `path`; the exit code: 0 if nothing is damaged or lost, 1 if something is,
    2 if the action is not possible."""
    actions: dict[str, Callable[[Path, Path | None], int]] = {
        "check": check,
        "salvage": salvage,
        "backup": backup,
        "compact": compact,
    }
    if action not in actions:
        return _refuse(f'unknown action "{action}" (known: {", ".join(actions)})')
    if target is not None and action != "backup":
        return _refuse(f"{action} does not accept a file; only backup writes one")
    if not path.parent.is_dir() or not any(path.parent.glob(f"{path.name}*")):
        return _refuse(f"there is no store at {path}")
    try:
        return actions[action](path, target)
    except Held:
        return _refuse(RUNS)
    except (OSError, sqlite3.Error) as error:
        return _refuse(str(error))


def check(path: Path, target: Path | None = None) -> int:
    """Print whether the store is damaged, and all losses of repairs whose copies still exist. Changes nothing."""
    said = manifest.read(manifest.place(path))  # before the file: a server may write meanwhile
    refuse_other(path, said)
    found = 0
    try:
        note = inspect(path, said)
        print(note or f"{path} is not damaged.")
        found = int(bool(note))
    except Broken as broken:
        print(f"{path} is damaged: {broken}. `hookean store salvage` or the next start of the service repairs it.")
        found = 1
    for report in reports(path):
        print(report.sentence)
        found = found or int(bool(report.losses))
    return found


def salvage(path: Path, target: Path | None = None) -> int:
    """Repair the store, if it is damaged, and print what is lost."""
    with _alone(path):
        opened = open_store(path)
        opened.db.close()
        if opened.manifest is not None:
            opened.manifest.close()
    if opened.note:  # the manifest is written again, so this is seen once
        print(opened.note)
    return max(check(path), int(bool(opened.note)))


def backup(path: Path, target: Path | None = None) -> int:
    """Copy the store as it is at this moment to a file, or to the first of its backups."""
    if target is None:
        made = backups.rotate(path, backups.COUNT)
        print(f"{backups.place(path, 1)} is " + ("a copy of the store." if made else "up to date."))
        return 0
    if target.exists():
        return _refuse(f"{target} exists; name a new file")
    backups.write(path, target)
    print(f"{target} is a copy of the store.")
    return 0


def compact(path: Path, target: Path | None = None) -> int:
    """Free unused space."""
    with _alone(path):
        opened = open_store(path)
        before = path.stat().st_size
        with closing(opened.db) as db:
            db.execute("PRAGMA wal_checkpoint(TRUNCATE)")
            db.execute("VACUUM")
            db.execute("PRAGMA wal_checkpoint(TRUNCATE)")
        if opened.manifest is not None:
            opened.manifest.close()
    if opened.note:
        print(opened.note)
    print(f"The size of {path} is {path.stat().st_size / 1e6:.1f} MB; it was {before / 1e6:.1f} MB.")
    return int(bool(opened.note))


@contextmanager
def _alone(path: Path) -> Iterator[None]:
    """The right to change a store that no server uses. Raises Held."""
    lock = Lock(path.with_name(path.name + ".lock"))
    try:
        yield
    finally:
        lock.release()


def _refuse(sentence: str) -> int:
    print(f"hookean: {sentence}", file=sys.stderr)
    return 2
