"""Damaged stores: what was acknowledged is there, or is named as lost; nothing is lost without a word.

Every claim is checked against a ledger that the test keeps itself. `make soak` tries a thousand stores.
"""

from __future__ import annotations

import os
import random
import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path

import pytest

from hookean_server.jobs import rows as job_rows
from hookean_server.keeping.opening import Report, reports
from hookean_server.sessions import rows
from hookean_server.store import Store
from serving import SOAK

from .stores import FILES, HARMS, Ledger, copied, lived

STORES = 1000 if SOAK else 20
LIVES = 8


@pytest.fixture(scope="module")
def memory() -> Iterator[Path]:
    """A folder in memory, where there is one: syncing thousands of files to a disk takes minutes."""
    with tempfile.TemporaryDirectory(dir="/dev/shm" if os.access("/dev/shm", os.W_OK) else None) as folder:
        yield Path(folder)


@pytest.fixture(scope="module")
def lives(memory: Path) -> list[tuple[Ledger, Path, Path]]:
    return [lived(memory / f"life{seed}", seed) for seed in range(LIVES)]


@pytest.fixture
def tmp_path(memory: Path) -> Path:
    return Path(tempfile.mkdtemp(dir=memory))


def opened(path: Path) -> tuple[Store, dict[str, rows.Stored], dict[str, dict[int, bytes]]]:
    """A store, its sessions, and the items of its jobs."""
    store = Store(path)
    store.start()
    keys = [kept.key for kept in store.submit(rows.listed()).result(20.0)]
    sessions = {key: store.submit(rows.load(key)).result(20.0) for key in keys}
    jobs = {}
    for job in store.submit(job_rows.listed()).result(20.0):
        assert store.submit(job_rows.request(job.id)).result(20.0) is not None
        items = store.submit(job_rows.rows(job.id, -1, 10**6)).result(20.0)
        assert job.status == "waiting" or len(items) == job.total or named(store, job.id)
        jobs[job.id] = {item.number: item.body for item in items}
    return store, sessions, jobs


def named(store: Store, key: str) -> bool:
    """Whether a loss of this session or job is reported, in a sentence with its key or label."""
    found = [loss.what for report in store.reports for loss in report.losses if loss.key == key]
    return any(key in what or f"Label {key}" in what for what in found)


def account(
    ledger: Ledger, store: Store, sessions: dict[str, rows.Stored], jobs: dict[str, dict[int, bytes]]
) -> tuple[int, int]:
    """Check all that was acknowledged; how many sessions and jobs are whole, and how many have a loss that is named."""
    whole = lost = 0
    for key, base in ledger.bases.items():
        found = sessions.get(key)
        state = found is not None and found.state == ledger.states[key]
        if found is not None and state and (found.base, found.edits) == (base, ledger.edits[key]):
            whole += 1
            continue
        assert named(store, key) or store.note, key
        lost += 1
        if found is not None and found.base == base:
            assert found.edits == ledger.edits[key][: len(found.edits)]  # those that are there are the first ones
    for job, request in ledger.requests.items():
        if job in jobs and jobs[job] == ledger.items[job]:
            assert store.submit(job_rows.request(job)).result(20.0)[1] == request.partition(b"\n")[2]
            whole += 1
            continue
        assert named(store, job) or store.note, job
        lost += 1
        assert all(ledger.items[job][number] == body for number, body in jobs.get(job, {}).items())
    return whole, lost


def test_all_that_was_acknowledged_is_there_or_is_named(lives: list[tuple[Ledger, Path, Path]], tmp_path: Path) -> None:
    """Bits, cuts, zeros, torn headers, swapped pages, missing and emptied files, of the database and of its log, alone
    and together: the store opens, what is whole is there, and all else is named. Started again it is a whole store."""
    whole = lost = repaired = 0
    for number in range(STORES):
        chance = random.Random(number)
        ledger, before, after = lives[number % LIVES]
        folder = tmp_path / str(number)
        copied(after, folder)
        for name in chance.choice([FILES[:1], FILES[1:2], FILES[:2]]):
            if chance.random() < 0.1:
                shutil.copyfile(before / name, folder / name)  # an older one of its own
            else:
                HARMS[chance.choice(sorted(HARMS))](folder / name, chance)
        store, sessions, jobs = opened(folder / "sessions.db")
        try:
            found = account(ledger, store, sessions, jobs)
            assert set(sessions) <= set(ledger.bases) and set(jobs) <= set(ledger.requests)
        except AssertionError as error:
            raise AssertionError(f"store {number}") from error
        finally:
            store.close()
        whole, lost = whole + found[0], lost + found[1]
        repaired += bool(store.reports)
        again, same, _ = opened(folder / "sessions.db")
        again.close()
        assert same == sessions and again.reports == store.reports and not again.note
        shutil.rmtree(folder)
    print(f"\n{STORES} stores, {repaired} repaired: {whole} sessions and jobs whole, {lost} with a loss that is named")
    assert repaired > STORES // 2 and whole > lost > 0


def test_without_a_whole_manifest_it_is_said_that_losses_cannot_be_named(
    lives: list[tuple[Ledger, Path, Path]], tmp_path: Path
) -> None:
    """The manifest damaged alone: nothing is lost. Together with the rest: what is there is right, and it is reported
    that more may be missing."""
    for number in range(STORES // 2):
        chance = random.Random(10_000 + number)
        ledger, _, after = lives[number % LIVES]
        folder = tmp_path / str(number)
        copied(after, folder)
        alone = number % 2 == 0
        for name in FILES[2:] if alone else FILES:
            HARMS[chance.choice(sorted(HARMS))](folder / name, chance)
        gone = not any((folder / name).exists() for name in FILES)
        store, sessions, jobs = opened(folder / "sessions.db")
        try:
            if alone:
                assert account(ledger, store, sessions, jobs)[1] == 0
                assert set(sessions) == set(ledger.bases)
            else:
                assert store.note or store.reports or gone
                for key, found in sessions.items():
                    if key in ledger.bases and found.base == ledger.bases[key]:
                        assert found.edits == ledger.edits[key][: len(found.edits)]
        except AssertionError as error:
            raise AssertionError(f"store {number}") from error
        finally:
            store.close()
        shutil.rmtree(folder)


@pytest.mark.parametrize("harm", ["wal cut", "wal gone", "db gone", "db empty"])
def test_an_edit_behind_is_named(harm: str, lives: list[tuple[Ledger, Path, Path]], tmp_path: Path) -> None:
    """Acknowledged writes that only the log or only the file had: each session is whole or named."""
    ledger, _, after = lives[1]
    copied(after, tmp_path / "s")
    file, how = harm.split()
    path = tmp_path / "s" / FILES[("db", "wal").index(file)]
    data = path.read_bytes()
    left = b"" if how == "empty" else data[: len(data) // 2]
    path.unlink() if how == "gone" else path.write_bytes(left)
    store, sessions, jobs = opened(tmp_path / "s" / "sessions.db")
    try:
        _, lost = account(ledger, store, sessions, jobs)
    finally:
        store.close()
    (report,) = store.reports
    assert lost == len(report.losses) > 0
    assert how == "gone" or (tmp_path / "s" / report.copy / path.name).read_bytes() == left
    assert report.copy in report.sentence and all(loss.what in report.sentence for loss in report.losses)


def test_the_copy_keeps_the_files_and_the_report_stays_until_it_is_deleted(
    lives: list[tuple[Ledger, Path, Path]], tmp_path: Path
) -> None:
    _, _, after = lives[0]
    folder = tmp_path / "s"
    copied(after, folder)
    (folder / FILES[0]).write_bytes(b"")
    given = [(folder / name).read_bytes() for name in FILES]
    store, _, _ = opened(folder / "sessions.db")
    store.close()
    (report,) = reports(folder / "sessions.db")
    assert isinstance(report, Report) and report.why == "the database is empty"
    assert [(folder / report.copy / name).read_bytes() for name in FILES] == given
    shutil.rmtree(folder / report.copy)
    again, _, _ = opened(folder / "sessions.db")
    again.close()
    assert again.reports == []
