"""Nothing acknowledged is lost: the server and its workers are killed at random moments and come back.

Three kills in `make test`, a hundred of each in `make soak`.
"""

from __future__ import annotations

import os
import random
import signal
import sqlite3
import threading
import time
from pathlib import Path
from typing import Any

import httpx
import psutil
import pytest

from serving import CABLE, HANG, SOAK, wait_for

from .conftest import Served

KILLS = 100 if SOAK else 3


class Ledger(threading.Thread):
    """A client that creates, edits and plays sessions, and notes what was acknowledged."""

    def __init__(self, served: Served, number: int, seed: int) -> None:
        super().__init__(daemon=True)
        self.client = httpx.Client(base_url=served.url, headers=served.client.headers, timeout=HANG)
        self.number, self.random = number, random.Random(seed)
        self.acknowledged: dict[str, tuple[int, float]] = {}
        self.answers = 0
        self.stop = threading.Event()

    def run(self) -> None:
        """Until the server is gone."""
        try:
            while not self.stop.is_set():
                key = f"{self.number}-{self.random.randrange(3)}"
                if key not in self.acknowledged:
                    answer = self.client.put(f"/v1/sessions/{key}", json=CABLE)
                    if answer.status_code in (200, 201):
                        self.acknowledged[key] = (answer.json()["revision"], -20.0)
                    continue
                load = -float(self.random.randrange(1, 10**6))
                answer = self.client.patch(f"/v1/sessions/{key}", json={"forces": {"1": {"vector": [0, 0, load]}}})
                self.answers += answer.status_code == 200
                if answer.status_code == 200:
                    self.acknowledged[key] = (answer.json()["revision"], load)
                if self.random.random() < 0.3:
                    self.client.post(f"/v1/sessions/{key}/{self.random.choice(['play', 'pause', 'step'])}")
        except httpx.HTTPError:
            return
        finally:
            self.client.close()


class Solver(threading.Thread):
    """A client that relaxes scenes and begins a sweep, and notes what was acknowledged."""

    def __init__(self, served: Served) -> None:
        super().__init__(daemon=True)
        self.client = httpx.Client(base_url=served.url, headers=served.client.headers, timeout=HANG)
        self.jobs: list[str] = []
        self.stop = threading.Event()

    def run(self) -> None:
        """Until the server is gone."""
        loads = [[0, 0, -1.0 - i] for i in range(20)]
        try:
            job = self.client.post("/v1/jobs", json={"scene": CABLE, "sweep": {"forces": {"1": {"vector": loads}}}})
            if job.status_code == 202:
                self.jobs.append(job.headers["location"])
            while not self.stop.is_set():
                relaxed = self.client.post("/v1/relax", json=CABLE)
                assert relaxed.status_code != 200 or relaxed.json()["status"] == "converged"
        except httpx.HTTPError:
            return
        finally:
            self.client.close()


def test_no_acknowledged_edit_is_lost_when_the_server_is_killed(tmp_path: Path) -> None:
    """kill -9 under load (create, edit, play, solve, sweep), time and again: every acknowledged revision, value and job
    is there afterwards, the database is whole, sessions have their keys and are paused."""
    state, known = tmp_path / "sessions.db", {}  # type: Path, dict[str, tuple[int, float]]
    jobs: list[str] = []
    listed: list[float] = []  # seconds from the start until all sessions are listed with their revisions
    ready: list[float] = []  # and until each has told its scene
    chance = random.Random(11)
    for kill in range(KILLS):
        began = time.monotonic()
        served = Served(state=str(state))
        try:
            assert len(served.client.get("/v1/sessions").json()["sessions"]) >= len(known)
            listed.append(time.monotonic() - began)
            _check(served, known)
            ready.append(time.monotonic() - began)
            assert all(served.client.get(job).status_code == 200 for job in jobs)
            solver = Solver(served)
            solver.start()
            ledgers = [Ledger(served, number, 100 * kill + number) for number in range(3)]
            for ledger in ledgers:
                ledger.acknowledged = {k: v for k, v in known.items() if k.startswith(f"{ledger.number}-")}
                ledger.start()
            wait_for(lambda ledgers=ledgers: any(ledger.answers for ledger in ledgers))
            if kill == 0:  # at least one job is known in the end, however slow the machine
                wait_for(lambda solver=solver: solver.jobs)
            time.sleep(chance.uniform(0.0, 1.0 if SOAK else 0.3))  # at whatever it does by then
            os.kill(served.process.pid, signal.SIGKILL)
            for ledger in ledgers:
                ledger.stop.set()
                ledger.join(HANG)
                known.update(ledger.acknowledged)
            solver.stop.set()
            solver.join(HANG)
            jobs = [*jobs, *solver.jobs][-5:]
        finally:
            served.end(signal.SIGKILL)
        with sqlite3.connect(state) as database:
            assert database.execute("PRAGMA integrity_check").fetchone() == ("ok",)
        database.close()
    middle, last = sorted(ready)[KILLS // 2], max(ready)
    first = sorted(listed)[KILLS // 2]
    print(
        f"\n{KILLS} kills: all sessions are listed {first:.2f} s after the start (median), {max(listed):.2f} s at most;"
    )
    print(f"all {len(known)} scenes, one after the other, after {middle:.2f} s, {last:.2f} s at most")
    assert jobs and len(known) >= 3 and sum(revision for revision, _ in known.values()) > KILLS
    served = Served(state=str(state))
    try:
        _check(served, known)
        for job in jobs:
            wait_for(lambda job=job: served.client.get(job).json()["status"] == "done")
    finally:
        served.end()


def _check(served: Served, known: dict[str, tuple[int, float]]) -> None:
    """An edit after the last acknowledged one may have been stored: then the revision is higher, never lower."""
    sessions: dict[str, Any] = {s["key"]: s for s in served.client.get("/v1/sessions").json()["sessions"]}
    for key, (revision, load) in known.items():
        assert not sessions[key]["playing"]
        scene = served.client.get(f"/v1/sessions/{key}/scene").json()
        found = served.client.get(f"/v1/sessions/{key}").json()["revision"]
        assert found >= revision
        if found == revision:
            assert scene["forces"][1]["vector"] == [0, 0, load]
        known[key] = (found, scene["forces"][1]["vector"][2])


@pytest.fixture
def swinging() -> dict[str, Any]:
    """A cable that never comes to rest."""
    scene: dict[str, Any] = {**CABLE, "settings": {"drag": 0, "time_step": 0.001}}
    scene["forces"] = [{**CABLE["forces"][0], "damping": 0}, CABLE["forces"][1]]
    return scene


@pytest.mark.soak
def test_a_session_goes_on_when_its_process_is_killed(swinging: dict[str, Any]) -> None:
    """The process of a playing session is killed: it goes on by itself, from a checkpoint less than the iterations of
    a second old, with all edits; after a third kill within a minute it waits to be used."""
    served = Served().ready()
    back: list[float] = []
    try:
        wait_for(lambda: not served.health()["workers"]["starting"])
        others = {process.pid for process in served.workers()}
        for number in range(KILLS // 3):
            key = f"s{number}"
            served.client.put(f"/v1/sessions/{key}", json=swinging)
            served.client.post(f"/v1/sessions/{key}/play", params={"fast": True})
            for kill in range(3):
                answer = served.client.patch(f"/v1/sessions/{key}", json={"settings": {"drag": 1e-6 * (kill + 1)}})
                assert answer.status_code == 200 and answer.json()["revision"] == kill + 1, answer.text
                since = _iteration(served, key)
                wait_for(lambda key=key, since=since: _iteration(served, key) > since + 100)
                hosts = [process for process in served.workers() if process.pid not in others]
                assert hosts, "the session has no process"
                before = _iteration(served, key)
                began = time.monotonic()
                for process in hosts:
                    process.kill()
                psutil.wait_procs(hosts, HANG)
                before = max(before, _iteration(served, key))  # it may have told of more on its last breath
                wait_for(lambda key=key, before=before: _iteration(served, key) > before)
                back.append(time.monotonic() - began)
                found = served.client.get(f"/v1/sessions/{key}").json()
                assert found["revision"] == kill + 1
                assert found["playing"]
            served.client.delete(f"/v1/sessions/{key}")
        print(f"\n{len(back)} kills: past where it was after {max(back):.2f} s at most")
    finally:
        served.end()


def _iteration(served: Served, key: str) -> int:
    return int(served.client.get(f"/v1/sessions/{key}").json()["iteration"])
