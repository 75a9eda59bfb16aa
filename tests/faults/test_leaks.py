"""Nothing stays behind: no descriptor, thread or task of sessions that came and went, of clients that vanished or
never finish a sentence. Slow ones are closed and hold up nobody."""

from __future__ import annotations

import asyncio
import json
import os
import socket
import struct
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing, suppress

import psutil
import pytest
import websockets

from hookean_server.sessions.wire import decode
from server.conftest import Served
from serving import CABLE, HANG, SOAK, wait_for

CYCLES, WARM = 50 if SOAK else 10, 10
VANISHING = 500 if SOAK else 60
SLOW = 200 if SOAK else 10
MIB = 2**20
SPARE = 4
"""Descriptors that come and go: fewer than one for each of what could leave some behind."""
POOL = min(32, (os.cpu_count() or 1) + 4)
"""Threads that asyncio starts when they are needed at the same time, and keeps."""


@pytest.fixture(scope="module")
def running() -> Iterator[Served]:
    found = Served(workers=1, header_seconds=2.0, body_seconds=2.0)
    found.ready()
    # at once, so that the server's pool of threads, which is bounded and never shrinks, has all it will have
    with ThreadPoolExecutor(WARM) as together:
        for done in [together.submit(_cycle, found, 1000 + number) for number in range(2 * WARM if SOAK else WARM)]:
            done.result()
    yield found
    assert found.end()[0] == 0


def figures(served: Served) -> tuple[int, int, int]:
    """Descriptors, threads and bytes of the server's process."""
    process = psutil.Process(served.process.pid)
    descriptors = process.num_fds() if hasattr(process, "num_fds") else process.num_handles()
    return descriptors, process.num_threads(), process.memory_info().rss


def settled(served: Served, before: tuple[int, int, int]) -> bool:
    """Whether no more descriptors and threads are in use than before, but for those to spare and a pool of threads."""
    now = figures(served)
    return now[0] <= before[0] + SPARE and now[1] <= before[1] + POOL + 2


async def _watched(served: Served, key: str, frames: int) -> int:
    """Frames seen of a session that plays."""
    seen = 0
    address = served.url.replace("http", "ws") + f"/v1/sessions/{key}/frames"
    async with websockets.connect(address, additional_headers=served.known) as stream:
        await stream.send(json.dumps({"id": 1, "do": "play"}))
        async for message in stream:
            if isinstance(message, bytes):
                seen += 1
                await stream.send(json.dumps({"ack": decode(message).number}))
                if seen == frames:
                    break
    return seen


def _cycle(served: Served, number: int) -> None:
    key = f"cycle-{number}"
    scene = {**CABLE, "settings": {"drag": 0.0, "tolerance": 0.0}}
    assert served.client.put(f"/v1/sessions/{key}", json=scene).status_code == 201
    assert asyncio.run(asyncio.wait_for(_watched(served, key, 3), HANG)) == 3
    assert served.client.patch(f"/v1/sessions/{key}", json={"pin": [{"particles": [2]}]}).status_code == 200
    assert served.client.get(f"/v1/sessions/{key}/state", params={"format": "npz"}).status_code == 200
    assert served.client.delete(f"/v1/sessions/{key}").status_code == 204


@pytest.mark.soak
def test_sessions_made_watched_and_deleted_leave_nothing(running: Served) -> None:
    with ThreadPoolExecutor(8) as several:  # threads that the service keeps once they were needed
        list(several.map(lambda number: _cycle(running, number), range(-8, 0)))
    family = len(running.family())
    before = figures(running)
    for number in range(CYCLES):
        _cycle(running, number)
    wait_for(lambda: settled(running, before))
    wait_for(lambda: len(running.family()) <= family)
    assert figures(running)[2] - before[2] <= 5 * MIB
    assert running.client.get("/v1/sessions").json()["sessions"] == []


def _opened(served: Served, said: bytes) -> socket.socket:
    found = socket.create_connection(("127.0.0.1", served.port), timeout=HANG)
    found.sendall(said)
    return found


def _reset(given: socket.socket) -> None:
    """Close it so that the other side gets a RST."""
    given.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
    given.close()


def _upgrade(served: Served, key: str) -> bytes:
    lines = (
        f"GET /v1/sessions/{key}/frames HTTP/1.1",
        f"Host: 127.0.0.1:{served.port}",
        served.head.strip(),
        "Connection: Upgrade",
        "Upgrade: websocket",
        "Sec-WebSocket-Version: 13",
        "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==",
    )
    return "".join(f"{line}\r\n" for line in (*lines, "")).encode()


def test_clients_that_vanish_leave_nothing(running: Served) -> None:
    """With a RST, at the end of a request, in its middle, in a body, while frames come, and without a word."""
    client, host = running.client, f"Host: 127.0.0.1:{running.port}\r\n{running.head}"
    assert client.put("/v1/sessions/seen", json=CABLE).status_code == 201
    client.post("/v1/sessions/seen/play")
    kinds = [
        f"GET /v1/health HTTP/1.1\r\n{host}\r\n".encode(),
        b"GET /v1/hea",
        f"POST /v1/relax HTTP/1.1\r\n{host}Content-Type: application/json\r\nContent-Length: 9000\r\n\r\n{{".encode(),
        _upgrade(running, "seen"),
        b"",
    ]
    for number in range(VANISHING):
        if number == len(kinds):  # by now the session's process and all that clients need has been started
            before = figures(running)
        found = _opened(running, kinds[number % len(kinds)])
        if number % 3 == 0 and kinds[number % len(kinds)][-4:] == b"\r\n\r\n":
            found.recv(64)  # in the middle of an answer or of a frame
        if number % 2:
            _reset(found)
        else:
            found.close()
    wait_for(lambda: settled(running, before))
    wait_for(lambda: running.health()["requests"].get("running", 0) == 0)
    assert running.health()["status"] == "ok"
    client.delete("/v1/sessions/seen")


def test_a_half_open_watcher_holds_up_nobody(running: Served) -> None:
    """A client that takes frames in but reads and acknowledges none: the session runs on, others see it."""
    scene = {**CABLE, "settings": {"drag": 0.0, "tolerance": 0.0}}
    assert running.client.put("/v1/sessions/half", json=scene).status_code == 201
    with closing(_opened(running, _upgrade(running, "half"))):
        assert asyncio.run(asyncio.wait_for(_watched(running, "half", 20), HANG)) == 20
    assert running.client.delete("/v1/sessions/half").status_code == 204


def test_sockets_that_drip_are_closed_and_others_are_served(running: Served) -> None:
    """Headers and bodies that come a byte at a time: each is ended by the time it has, meanwhile others are served."""
    host = f"Host: 127.0.0.1:{running.port}\r\n{running.head}"
    slow = f"POST /v1/relax HTTP/1.1\r\n{host}Content-Type: application/json\r\nContent-Length: 9000\r\n\r\n".encode()
    before = figures(running)
    sockets = [_opened(running, slow if number % 2 else b"GET / HTTP/1.1\r\nX: ") for number in range(SLOW)]
    left = dict(enumerate(sockets))
    served = 0

    def drip() -> bool:
        nonlocal served
        for number, found in list(left.items()):
            found.settimeout(0.001)
            with suppress(TimeoutError):
                try:
                    found.sendall(b"1")
                    if found.recv(4096) == b"":
                        left.pop(number).close()
                except OSError as error:
                    if isinstance(error, TimeoutError):
                        raise
                    left.pop(number).close()
        served += running.client.get("/v1/forces").status_code == 200
        return not left

    wait_for(drip)
    assert served
    wait_for(lambda: settled(running, before))
    assert running.client.post("/v1/relax", json=CABLE).json()["status"] == "converged"
