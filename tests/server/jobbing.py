"""Jobs in tests: scenes to sweep, rows as the core has them, streams of events read."""

from __future__ import annotations

import json
import re
from typing import Any

import httpx
import psutil

from hookean_server.jobs.work import solve
from serving import wait_for

from .conftest import Served

NET: dict[str, Any] = {
    "particles": [[0.4 * i, 0.0, 0.0] for i in range(21)],
    "forces": [
        {"kind": "springs", "name": "net", "particles": [[i, i + 1] for i in range(20)], "stiffness": 7000},
        {"kind": "unary", "name": "load", "particles": list(range(1, 20)), "vector": [0, 0, -1]},
    ],
    "anchors": [{"particles": [0, 20]}],
}
COUNT = 3000
ENDLESS: dict[str, Any] = {
    "particles": [[float(i), 0.0, 0.0] for i in range(COUNT)],
    "forces": [
        {"kind": "springs", "particles": [[i, i + 1] for i in range(COUNT - 1)], "damping": 0},
        {"kind": "self_weight", "total": 20.0 * COUNT},
    ],
    "anchors": [{"particles": [0, COUNT - 1]}],
    "settings": {"solver": "verlet", "drag": 0, "time_step": 0.001, "max_iterations": 10**9, "tolerance": 0},
}
LONG = (600, 100)
"""The sizes of a sweep that no test sees the end of: minutes of work."""
FINAL = ("done", "failed", "cancelled")


def sweep(*sizes: int) -> dict[str, Any]:
    """A request of a sweep over stiffness and load."""
    stiffness = [6000.0 + 10 * i for i in range(sizes[0])]
    vectors = [[0, 0, -1 - 0.01 * i] for i in range(sizes[1])]
    return {"scene": NET, "sweep": {"forces": {"net": {"stiffness": stiffness}, "load": {"vector": vectors}}}}


def rows_of(request: dict[str, Any], numbers: list[int] | None = None) -> list[dict[str, Any]]:
    """The rows of a sweep, solved here."""
    body = json.dumps({"sweep": None, **request}).encode()
    left = list(range(product(request))) if numbers is None else numbers
    found: list[dict[str, Any]] = []
    while left:
        some = [json.loads(line) for line in solve(body, left, 300.0)]
        found, left = found + some, left[len(some) :]
    return found


def product(request: dict[str, Any]) -> int:
    """How many items a request of `sweep` has."""
    forces = request["sweep"]["forces"]
    return len(forces["net"]["stiffness"]) * len(forces["load"]["vector"])


def post(client: httpx.Client, request: dict[str, Any], **headers: str) -> str:
    """A job begun; its address."""
    answer = client.post("/v1/jobs", json=request, headers=headers)
    assert answer.status_code == 202, answer.text
    return str(answer.headers["location"])


def ended(client: httpx.Client, address: str) -> dict[str, Any]:
    """The job when it has ended."""
    wait_for(lambda: client.get(address).json()["status"] in FINAL)
    found: dict[str, Any] = client.get(address).json()
    return found


def end_all(client: httpx.Client) -> None:
    """Cancel what a test has left, so that the next one has all workers."""
    left = [f"/v1/jobs/{job['id']}" for job in client.get("/v1/jobs").json()["jobs"] if job["status"] not in FINAL]
    for address in left:
        client.delete(address)
    for address in left:
        ended(client, address)


def table(client: httpx.Client, address: str) -> list[dict[str, Any]]:
    """The rows that there are."""
    found: list[dict[str, Any]] = client.get(f"{address}/results").json()["rows"]
    return found


def parsed(text: str) -> list[tuple[int, str, Any]]:
    """Number, name and data of the events in a stream."""
    found = []
    for block in text.replace("\r\n", "\n").split("\n\n"):
        fields = dict(line.split(": ", 1) for line in block.split("\n") if ": " in line and not line.startswith(":"))
        if "event" in fields:
            found.append((int(fields["id"]), fields["event"], json.loads(fields["data"])))
    return found


def events(client: httpx.Client, address: str, after: int | None = None) -> list[tuple[int, str, Any]]:
    """All events to the end of a job."""
    headers = {} if after is None else {"last-event-id": str(after)}
    answer = client.get(f"{address}/events", headers=headers)
    assert answer.status_code == (200 if answer.content else 204)
    return parsed(answer.text)


def states(client: httpx.Client) -> dict[str, int]:
    """How many workers, of requests and of jobs, are starting, idle and busy."""
    samples = re.findall(r'^workers\{state="(\w+)"\} (\d+)', client.get("/metrics").text, re.MULTILINE)
    return {state: int(count) for state, count in samples}


def job_workers(served: Served) -> list[psutil.Process]:
    """The processes that work on jobs: those that give way to others."""
    found = []
    for process in served.workers():
        try:
            if process.nice() > psutil.Process().nice():
                found.append(process)
        except psutil.NoSuchProcess:
            pass
    return found
