"""Live play over real sockets: the same start and the same edits end at the same iteration, with the same bits.

At full speed and in real time, beside load, watched, exported, paused and played again: the clock decides how quickly
a session gets there, never where it ends.
"""

from __future__ import annotations

import json
import multiprocessing
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from typing import Any

import httpx
import pytest
from websockets.sync.client import connect

from hookean_server.sessions import host
from hookean_server.workers import channel
from serving import HANG, SOAK, wait_for

from .conftest import Served

SIDE = 8
PAIRS = [[i * SIDE + j, i * SIDE + j + 1] for i in range(SIDE) for j in range(SIDE - 1)]
PAIRS += [[i * SIDE + j, i * SIDE + SIDE + j] for i in range(SIDE - 1) for j in range(SIDE)]
CORNERS = [0, SIDE - 1, SIDE * SIDE - SIDE, SIDE * SIDE - 1]
NET: dict[str, Any] = {
    "particles": [[float(i), float(j), 0.0] for i in range(SIDE) for j in range(SIDE)],
    "forces": [{"kind": "springs", "particles": PAIRS, "stiffness": 100, "rest_factor": 0.8}],
    "anchors": [{"particles": CORNERS, "targets": [[0, 0, 3], [0, SIDE - 1, 0], [SIDE - 1, 0, 0], [7, 7, 3]]}],
}
"""Without loads, so that its residual is measured by its own forces, which die out while it comes to rest."""
SETTINGS = {
    "verlet": {"solver": "verlet", "sub_iterations": 100},
    "relaxation": {"solver": "relaxation", "sub_iterations": 11, "tolerance": 1e-8},
}
Disturb = Callable[[Served, str, threading.Event], None]


def polled(served: Served, key: str, over: threading.Event) -> None:
    """How it stands is asked all the time, and everything of it taken out."""
    with httpx.Client(base_url=served.url, timeout=HANG, headers=served.known) as client:
        while not over.is_set():
            for form in ("json", "npz", "csv"):
                assert client.get(f"/v1/sessions/{key}/state", params={"format": form}).status_code == 200
            assert client.get(f"/v1/sessions/{key}").status_code == 200


def watched(served: Served, key: str, over: threading.Event) -> None:
    """Every frame is acknowledged at once."""
    url = f"{served.url.replace('http', 'ws')}/v1/sessions/{key}/frames"
    with connect(url, additional_headers=served.known) as socket:
        while not over.is_set():
            try:
                message = socket.recv(timeout=0.2)
            except TimeoutError:
                continue
            if isinstance(message, bytes):
                socket.send(json.dumps({"ack": int.from_bytes(message[12:16], "little")}))


def left_alone(served: Served, key: str, over: threading.Event) -> None:
    """Nobody looks."""


@contextmanager
def load() -> Iterator[None]:
    """Processes that never rest."""
    busy = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(2 if SOAK else 1)]
    try:
        yield
    finally:
        for process in busy:
            process.kill()
            process.wait()


def to_rest(served: Served, key: str, disturb: Disturb, *, fast: bool, halts: int = 0) -> dict[str, Any]:
    """Play until it is at rest, paused and played again so many times on the way; how it stands then."""
    over = threading.Event()
    beside = threading.Thread(target=disturb, args=(served, key, over))
    client, address = served.client, f"/v1/sessions/{key}"
    beside.start()
    try:
        for _ in range(halts):
            client.post(f"{address}/play", params={"fast": fast})
            client.post(f"{address}/pause")
        client.post(f"{address}/play", params={"fast": fast})
        wait_for(lambda: not client.get(address).json()["playing"])
    finally:
        over.set()
        beside.join(HANG)
    found: dict[str, Any] = client.get(address).json()
    return found


def ended(served: Served, key: str, solver: str, disturb: Disturb, **how: Any) -> tuple[Any, ...]:
    """A fresh session: seven frames, a corner moved, played to rest, another corner moved at rest, played to rest."""
    client, address = served.client, f"/v1/sessions/{key}"
    assert client.put(address, json={**NET, "settings": SETTINGS[solver]}).status_code == 201
    try:
        client.post(f"{address}/step", params={"frames": 7})
        ends: list[Any] = []
        for corner, place in ((CORNERS[0], [0, 0, 1]), (CORNERS[3], [7, 8, 4])):
            edit = {"pin": [{"particles": [corner], "targets": [place]}]}
            assert client.patch(address, json=edit).status_code == 200
            found = to_rest(served, key, disturb, **how)
            shape = client.get(f"{address}/state").json()
            ends.append([found[name] for name in ("status", "iteration", "time", "residual", "energy", "revision")])
            ends.append([shape["particles"], shape["message"]])
        return tuple(ends)
    finally:
        client.delete(address)


@pytest.fixture(scope="module")
def server() -> Iterator[Served]:
    """A server of its own, which nothing else of these tests keeps busy."""
    found = Served()
    yield found.ready()
    found.end()


@pytest.mark.slow
@pytest.mark.parametrize("solver", SETTINGS)
def test_the_same_start_and_edits_end_at_the_same_iteration(server: Served, solver: str) -> None:
    first = ended(server, "first", solver, left_alone, fast=True)
    assert first[0][0] == first[2][0] == "converged"
    assert ended(server, "watched", solver, watched, fast=True) == first
    assert ended(server, "halted", solver, left_alone, fast=True, halts=5) == first
    assert ended(server, "real", solver, polled, fast=False) == first
    with load():
        assert ended(server, "busy", solver, watched, fast=True, halts=2) == first
        if SOAK:
            assert ended(server, "busy-real", solver, polled, fast=False) == first


def stepped(slice_of: float, monkeypatch: pytest.MonkeyPatch) -> list[tuple[Any, ...]]:
    """Status of a session after each of its steps of a frame, where slices of computing are this long [s]."""
    monkeypatch.setattr(host, "SLICE", slice_of)
    ours, theirs = multiprocessing.Pipe()

    def serve() -> None:
        with suppress(EOFError, OSError):
            host.Host(theirs).run()

    serving = threading.Thread(target=serve)
    serving.start()
    scene = json.dumps({**NET, "settings": SETTINGS["verlet"]}).encode()
    stands: list[tuple[Any, ...]] = []
    try:
        for command in [{"do": "create"}, *[{"do": "step", "frames": 1}] * 60, {"do": "step", "frames": 3}]:
            channel.send(ours, {**command, "id": len(stands)}, scene)
            head: dict[str, Any] = {}
            while head.get("id") != len(stands):
                assert ours.poll(HANG)
                head, _ = channel.receive(ours)
            stands.append(tuple(head[name] for name in ("status", "iteration", "residual", "energy")))
    finally:
        ours.close()
        serving.join(HANG)
    return stands


def test_a_step_from_rest_is_a_whole_frame_however_quick_the_machine_is(monkeypatch: pytest.MonkeyPatch) -> None:
    """`Simulation.step`: every step does its first frame whole, and several end with the frame that is at rest."""
    slow, quick = stepped(0.0, monkeypatch), stepped(10.0, monkeypatch)
    assert slow == quick
    assert [status for status, *_ in slow[-3:]] == ["converged"] * 3
    assert [iteration for _, iteration, *_ in slow] == [100 * i for i in range(62)]
