"""Workers that hang, here by SIGSTOP, which no code of theirs can answer: what is asked of them ends all the same."""

from __future__ import annotations

import json
import signal
import threading
from collections.abc import Iterator
from typing import Any

import httpx
import numpy as np
import psutil
import pytest

from server.conftest import Served, asked, endless
from server.test_sessions import frame, watch
from serving import CABLE, HANG, living, wait_for

pytestmark = pytest.mark.skipif(not hasattr(signal, "SIGSTOP"), reason="this system cannot stop a process")


@pytest.fixture(scope="module")
def running() -> Iterator[Served]:
    found = Served(workers=1)
    yield found.ready()
    assert found.end()[0] == 0


def _of_session(served: Served, before: set[int]) -> psutil.Process:
    """The process of the session made last."""
    (new,) = [process for process in served.workers() if process.pid not in before]
    return new


def _begun(served: Served, key: str) -> psutil.Process:
    """A session that has taken a few steps; its process."""
    before = {process.pid for process in served.workers()}
    assert served.client.put(f"/v1/sessions/{key}", json=CABLE).status_code == 201
    process = _of_session(served, before)
    served.client.post(f"/v1/sessions/{key}/step", params={"frames": 5})
    return process


def _answered(served: Served, key: str, action: str, **options: Any) -> list[httpx.Response]:
    """What an action is answered, in a thread, as a client waits for it."""
    found: list[httpx.Response] = []

    def ask() -> None:
        with httpx.Client(base_url=served.url, headers=served.known, timeout=HANG) as client:
            found.append(client.post(f"/v1/sessions/{key}/{action}", **options))

    threading.Thread(target=ask, daemon=True).start()
    return found


@pytest.mark.soak
def test_pause_reaches_a_session_whose_process_hangs(running: Served) -> None:
    """It is ended and comes back, paused, where its checkpoint was, with its edits, and goes on as any other."""
    process = _begun(running, "a")
    assert running.client.patch("/v1/sessions/a", json={"forces": {"1": {"vector": [0, 0, -7.0]}}}).status_code == 200
    running.client.post("/v1/sessions/a/play", params={"fast": True})
    process.send_signal(signal.SIGSTOP)
    paused = _answered(running, "a", "pause")
    wait_for(lambda: paused)
    assert paused[0].status_code == 200 and paused[0].json()["playing"] is False
    wait_for(lambda: not living(process.pid))
    found = running.client.get("/v1/sessions/a/scene")
    assert found.status_code == 200, found.text + running.log()
    assert found.json()["forces"][1]["vector"] == [0, 0, -7.0]
    stands = running.client.get("/v1/sessions/a").json()
    assert (stands["playing"], stands["revision"], stands["awake"]) == (False, 1, True)
    went = running.client.post("/v1/sessions/a/step", params={"frames": 2}).json()
    assert went["iteration"] > stands["iteration"] or went["status"] != "running"
    assert running.client.post("/v1/sessions/a/undo").json()["revision"] == 2


def test_a_session_reports_how_long_its_process_has_sent_nothing(running: Served) -> None:
    """A process reports twice a second; a stopped one does not, until it goes on; no process, no silence."""
    process = _begun(running, "silent")

    def silence() -> float:
        return float(running.client.get("/v1/sessions/silent").headers["hookean-silence"])

    wait_for(lambda: silence() < 0.5)
    process.send_signal(signal.SIGSTOP)
    wait_for(lambda: silence() > 1.0)
    process.send_signal(signal.SIGCONT)
    wait_for(lambda: silence() < 0.5)


def test_a_paused_session_that_lost_its_process_is_seen_where_it_came_back(running: Served) -> None:
    """Whoever watches gets a frame of the new process, which is at the last checkpoint, though nothing was asked."""
    process = _begun(running, "watched")
    with watch(running, "watched") as socket:
        frame(socket)
        process.kill()
        came_back = frame(socket)
    state = running.client.get("/v1/sessions/watched/state").json()
    assert np.allclose(came_back.particles, state["particles"], atol=1e-6)  # of single precision


def test_others_go_on_while_one_hangs(running: Served) -> None:
    """Large messages wait for the stopped process: neither other sessions nor health wait with them."""
    stopped = _begun(running, "stopped")
    _begun(running, "other")
    stopped.send_signal(signal.SIGSTOP)
    large = json.dumps({"pin": [{"particles": [1], "name": "n" * 300_000}]}).encode()
    stuck = [threading.Thread(target=_patched, args=(running, large), daemon=True) for _ in range(12)]
    for thread in stuck:
        thread.start()
    for value in range(5):
        done = running.client.patch("/v1/sessions/other", json={"forces": {"1": {"vector": [0, 0, -float(value)]}}})
        assert done.status_code == 200
        assert running.health()["status"] == "ok"
    paused = _answered(running, "stopped", "pause")
    wait_for(lambda: paused)
    for thread in stuck:
        thread.join(HANG)
        assert not thread.is_alive()
    assert running.client.get("/v1/sessions/stopped/state").status_code == 200


def _patched(served: Served, body: bytes) -> None:
    with httpx.Client(base_url=served.url, headers=served.known, timeout=HANG) as client:
        client.patch("/v1/sessions/stopped", content=body, headers={"content-type": "application/json"})


def test_a_session_whose_process_hangs_is_deleted(running: Served) -> None:
    process = _begun(running, "gone")
    process.send_signal(signal.SIGSTOP)
    assert running.client.delete("/v1/sessions/gone").status_code == 204
    wait_for(lambda: not living(process.pid))
    assert running.client.get("/v1/sessions/gone").status_code == 404


def test_a_client_that_leaves_ends_a_worker_that_hangs(running: Served) -> None:
    """Its place is free again and the next request is solved, by another process."""
    for listed in running.client.get("/v1/sessions").json()["sessions"]:
        running.client.delete(f"/v1/sessions/{listed['key']}")
    wait_for(lambda: len(running.workers()) == 1)
    (worker,) = running.workers()
    worker.send_signal(signal.SIGSTOP)
    with asked(running, endless()):
        wait_for(lambda: running.health()["workers"]["busy"] == 1)
    wait_for(lambda: running.health()["workers"]["idle"] == 1)
    assert worker.pid not in {process.pid for process in running.workers()}
    assert running.client.post("/v1/relax", json=CABLE).json()["status"] == "converged"


@pytest.mark.soak
def test_the_service_ends_with_workers_that_hang() -> None:
    served = Served(workers=1).ready()
    processes = [_begun(served, "a"), *served.workers()]
    for process in processes:
        process.send_signal(signal.SIGSTOP)
    assert served.end()[0] == 0
    wait_for(lambda: not any(living(p.pid) for p in processes))
