"""Figures of the live service on this machine: frames, edits, health, small solves, sweeps, coming back.

Run it with `make bench-service` on a quiet machine. It starts a server of its own on a free port, with a store in a
temporary folder, and prints one line for each figure with the bar it is held to.
"""

from __future__ import annotations

import asyncio
import http.client
import json
import math
import os
import re
import signal
import statistics
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import httpx
import psutil
import websockets

from hookean_server.sessions.wire import HEADER

SIDE = 100  # 10,000 particles, 19,800 springs
SECONDS = 8.0
TOKEN = "figures-of-the-live-service"


class Server:
    """A server of its own, and a client of it."""

    def __init__(self, state: Path) -> None:
        began = time.monotonic()
        code = (
            "import sys; from hookean_server.lifecycle.main import serve; from hookean_server.settings import Settings;"
            f"sys.exit(serve(port=0, settings=Settings(state={str(state)!r}, sessions=400)))"
        )
        environment = {**os.environ, "HOOKEAN_TOKEN": TOKEN, "HOOKEAN_STATE": str(state.parent)}
        self.process = subprocess.Popen(
            [sys.executable, "-c", code], stdout=subprocess.PIPE, text=True, env=environment
        )
        assert self.process.stdout is not None
        found = None
        while found is None:
            line = self.process.stdout.readline()
            if not line:
                raise SystemExit("the server did not start")
            found = re.search(r"http://127\.0\.0\.1:\d+", line)
        self.url = found.group(0)
        self.headers = {"authorization": f"Bearer {TOKEN}"}
        self.client = httpx.Client(base_url=self.url, timeout=120.0, headers=self.headers)
        self.client.get("/v1/health")
        self.ready = time.monotonic() - began

    def socket(self, key: str) -> Any:
        return websockets.connect(
            f"{self.url.replace('http', 'ws')}/v1/sessions/{key}/frames",
            max_size=2**26,
            additional_headers=self.headers,
        )

    def memory(self) -> float:
        """Memory of the server and its processes [MB]; what they share counts once, where the system tells."""
        me = psutil.Process(self.process.pid)
        full = [p.memory_full_info() for p in [me, *me.children(recursive=True)]]
        return sum(getattr(f, "pss", f.rss) for f in full) / 1e6


def net(side: int) -> dict[str, Any]:
    """A square net hung from its corners, its weight on it."""
    vertices = [[float(i), float(j), 0.0] for i in range(side) for j in range(side)]
    faces = [
        [i * side + j, (i + 1) * side + j, (i + 1) * side + j + 1, i * side + j + 1]
        for i in range(side - 1)
        for j in range(side - 1)
    ]
    corners = [0, side - 1, side * (side - 1), side * side - 1]
    return {
        "meshes": {"net": {"vertices": vertices, "faces": faces}},
        "forces": [
            {"kind": "springs", "name": "net", "mesh": "net", "stiffness": 1000},
            {"kind": "self_weight", "name": "weight", "mesh": "net", "total": 0.1 * side * side},
        ],
        "anchors": [{"name": "corners", "points": [vertices[c] for c in corners]}],
    }


def catenary() -> dict[str, Any]:
    """The chapter's cable of 51 particles: an arc of radius 10 and length 20 that falls through to a catenary."""
    particles = [
        [10.0 * math.sin(t), 0.0, 10.0 * (math.cos(t) - math.cos(1.0))] for t in (0.04 * i - 1.0 for i in range(51))
    ]
    return {
        "particles": particles,
        "forces": [
            {"kind": "springs", "particles": [[i, i + 1] for i in range(50)], "stiffness": 7000, "rest_factor": 0.995},
            {"kind": "unary", "particles": list(range(51)), "vector": [0, 0, -1]},
        ],
        "anchors": [{"particles": [0, 50]}],
    }


async def watched(server: Server, key: str, seconds: float, *, drag: bool = False) -> tuple[float, list[float]]:
    """Frames a second one client gets, and the milliseconds from its edits to the first frame with each."""
    base = int(server.client.get(f"/v1/sessions/{key}").json()["revision"])
    targets = next(a["targets"] for a in server.client.get(f"/v1/sessions/{key}/anchors").json()["anchors"])
    waits: list[float] = []
    sent: dict[int, float] = {}
    async with server.socket(key) as socket:
        frames, edits = 0, 0
        began = time.monotonic()
        due = began + 0.5
        while time.monotonic() < began + seconds:
            if drag and time.monotonic() > due:
                edits, due = edits + 1, time.monotonic() + 0.1
                moved = [[x, y, z + 0.01 * edits] for x, y, z in targets]
                sent[base + edits] = time.monotonic()
                edit = {"move": [{"anchor": 0, "targets": moved}], "gesture": "drag"}
                await socket.send(json.dumps({"id": edits, "edit": edit}))
            message = await socket.recv()
            if isinstance(message, bytes):
                head = HEADER.unpack_from(message)
                frames += 1
                await socket.send(json.dumps({"ack": head[4]}))
                for revision in [r for r in sent if r <= head[5]]:
                    waits.append(1000 * (time.monotonic() - sent.pop(revision)))
        return frames / (time.monotonic() - began), waits


def show(name: str, value: str, bar: str) -> None:
    print(f"{name:<58} {value:>22}   bar {bar}", flush=True)


def quantile(values: list[float], part: float) -> float:
    return sorted(values)[min(len(values) - 1, int(part * len(values)))] if values else float("nan")


def frames(server: Server) -> None:
    """Frames and edits of 10,000 particles."""
    server.client.put("/v1/sessions/net", json=net(SIDE)).raise_for_status()
    for fast in (False, True):
        server.client.post("/v1/sessions/net/play", params={"fast": fast})
        rate, _ = asyncio.run(watched(server, "net", SECONDS))
        what = "as fast as it can" if fast else "60 a second"
        show(f"frames to one client, 10,000 particles, {what}", f"{rate:.0f} /s", ">= 60 /s")
    server.client.post("/v1/sessions/net/play")
    _, waits = asyncio.run(watched(server, "net", 2 * SECONDS, drag=True))
    show("edit to first frame with it, p50", f"{quantile(waits, 0.5):.1f} ms", "<= 25 ms")
    show("edit to first frame with it, p99", f"{quantile(waits, 0.99):.1f} ms", "<= 60 ms")

    async def four() -> list[tuple[float, list[float]]]:
        return await asyncio.gather(*(watched(server, "net", SECONDS) for _ in range(4)))

    rates = [rate for rate, _ in asyncio.run(four())]
    show("frames to each of four clients", f"{min(rates):.0f} /s", ">= 30 /s")
    server.client.delete("/v1/sessions/net")


def health(server: Server) -> None:
    """Health while both cores solve."""
    for key in "ab":
        server.client.put(f"/v1/sessions/{key}", json={**net(SIDE), "settings": {"drag": 0}}).raise_for_status()
        server.client.post(f"/v1/sessions/{key}/play", params={"fast": True})
    time.sleep(1.0)
    waits = []
    for _ in range(400):
        began = time.monotonic()
        server.client.get("/v1/health")
        waits.append(1000 * (time.monotonic() - began))
        time.sleep(0.01)
    show("health while both cores solve, p99", f"{quantile(waits, 0.99):.1f} ms", "<= 50 ms")
    for key in "ab":
        server.client.delete(f"/v1/sessions/{key}")


def solves(server: Server) -> None:
    """Small solves over HTTP, each client with a connection of its own."""
    body = json.dumps(catenary()).encode()
    head = {"content-type": "application/json", **server.headers}

    def one(until: float) -> int:
        connection = http.client.HTTPConnection(server.url.removeprefix("http://"))
        done = 0
        while time.monotonic() < until:
            connection.request("POST", "/v1/relax", body, head)
            answer = connection.getresponse()
            if answer.status != 200 or b'"converged"' not in answer.read():
                raise SystemExit(f"a relaxation failed: {answer.status}")
            done += 1
        connection.close()
        return done

    for clients in (1, 4):
        with ThreadPoolExecutor(clients) as pool:
            rate = sum(pool.map(one, [time.monotonic() + SECONDS] * clients)) / SECONDS
        show(f"51-particle catenary over POST /v1/relax, {clients} at once", f"{rate:.0f} /s", ">= 100 /s")


def idle(server: Server) -> None:
    """Memory of sessions that rest."""
    body = json.dumps(net(SIDE)).encode()
    head = {"content-type": "application/json"}
    for number in range(20):
        server.client.put(f"/v1/sessions/idle-{number}", content=body, headers=head).raise_for_status()
    show("memory with 20 sessions of 10,000 particles awake", f"{server.memory():.0f} MB", "none; they sleep soon")


def back(state: Path) -> None:
    """How long a killed server takes to come back with its sessions."""
    times = []
    for _ in range(5):
        server = Server(state)
        server.client.put("/v1/sessions/kept", json=catenary()).raise_for_status()
        server.client.post("/v1/sessions/kept/play", params={"fast": True})
        os.kill(server.process.pid, signal.SIGKILL)
        server.process.wait()
        began = time.monotonic()
        server = Server(state)
        server.client.get("/v1/sessions/kept/scene").raise_for_status()
        times.append(time.monotonic() - began)
        server.process.terminate()
        server.process.wait()
    show("killed, started again, a session's scene is there", f"{statistics.median(times):.2f} s", "<= 3 s")


def sweep(server: Server) -> None:
    """A sweep of 10,000 small scenes."""
    loads = [[0.0, 0.0, -1.0 - 0.0001 * i] for i in range(10_000)]
    request = {"scene": catenary(), "sweep": {"forces": {"1": {"vector": loads}}}}
    began = time.monotonic()
    answer = server.client.post("/v1/jobs", json=request)
    if answer.status_code != 202:
        show("sweep", f"refused: {answer.status_code}", ">= 300 /s")
        return
    place = answer.headers["location"]
    while server.client.get(place).json()["status"] in ("waiting", "running"):
        time.sleep(0.1)
    show("sweep of 10,000 catenaries", f"{10_000 / (time.monotonic() - began):.0f} /s", ">= 300 /s")


def main() -> None:
    print(f"{os.cpu_count()} cores, Python {sys.version.split()[0]}, load {os.getloadavg()[0]:.1f}")
    with tempfile.TemporaryDirectory(prefix="hookean-bench-") as folder:
        state = Path(folder) / "sessions.db"
        server = Server(state)
        show("start to the first answer", f"{server.ready:.2f} s", "<= 3 s")
        while not server.client.get("/v1/health").json()["workers"]["idle"]:
            time.sleep(0.05)
        try:
            for part in (frames, health, solves, idle, sweep):
                part(server)
        finally:
            server.process.terminate()
            server.process.wait()
        back(Path(folder) / "back.db")


if __name__ == "__main__":
    main()
