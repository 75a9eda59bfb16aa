"""Long relaxations as jobs: progress, shapes on the way, cancelling whatever the worker does, going on after losses."""

from __future__ import annotations

import asyncio
import json
import signal
import threading
import time
from collections.abc import Iterator
from contextlib import suppress
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import httpx
import jsonschema
import psutil
import pytest

from hookean_server.jobs import rows, tables
from hookean_server.jobs.manager import Jobs
from hookean_server.jobs.runner import Live
from hookean_server.lifecycle.ending import Activity
from hookean_server.settings import Settings
from hookean_server.store import Store
from hookean_server.workers.pool import Pool
from serving import CABLE, HANG, living, wait_for

from .conftest import PATIENT, Served, problem
from .jobbing import COUNT, ENDLESS, LONG, end_all, ended, events, job_workers, parsed, post, states, sweep, table


@pytest.fixture(scope="module")
def runner() -> Iterator[Served]:
    found = Served()
    yield found.ready()
    assert found.end()[0] == 0


@pytest.fixture
def jobs(runner: Served) -> Iterator[httpx.Client]:
    yield runner.client
    end_all(runner.client)


def going(client: httpx.Client) -> str:
    """A relaxation that goes on and on, and has been shown once."""
    address = post(client, {"scene": ENDLESS})
    wait_for(lambda: client.get(f"{address}/results/0").status_code == 200)
    return address


def iteration(client: httpx.Client, address: str) -> int:
    return int(client.get(address).json()["progress"]["iteration"])


def kept(client: httpx.Client, address: str) -> int:
    """The iteration of the last checkpoint."""
    return int(client.get(f"{address}/results/0").json()["iterations"])


def test_it_ends_with_the_result_of_a_request(jobs: httpx.Client) -> None:
    address = post(jobs, {"scene": CABLE})
    job = ended(jobs, address)
    assert (job["kind"], job["status"], job["total"], job["done"]) == ("relaxation", "done", 1, 1)
    relaxed = jobs.post("/v1/relax", json=CABLE)
    assert jobs.get(f"{address}/results/0").content == relaxed.content
    assert job["message"] == relaxed.json()["message"]
    (row,) = table(jobs, address)
    assert (row["status"], row["residual"]) == ("converged", relaxed.json()["residual"])
    stream = events(jobs, address)
    ends = [told for _, name, told in stream if name != "progress"]  # of that there is some where it takes long
    assert {name for _, name, _ in stream[-2:]} == {"item", "done"} and ends == [row, job]


def test_a_diverged_one_is_done_and_says_so(jobs: httpx.Client) -> None:
    scene = {**CABLE, "settings": {"solver": "verlet", "time_step": 100.0}}
    address = post(jobs, {"scene": scene})
    assert ended(jobs, address)["status"] == "done"
    assert table(jobs, address)[0]["status"] == "diverged"


def test_progress_streams_and_the_shape_is_readable(jobs: httpx.Client) -> None:
    address = going(jobs)
    text = ""
    with jobs.stream("GET", f"{address}/events") as stream:
        for chunk in stream.iter_text():
            text += chunk
            if text.count("event: progress") > 5:
                break
    seen = parsed(text[: text.rindex("\n\n") + 2])
    assert {name for _, name, _ in seen} == {"progress"}
    numbers, steps = [n for n, _, _ in seen], [said["iteration"] for _, _, said in seen]
    assert numbers == list(range(1, len(seen) + 1))
    assert steps == sorted(steps) and steps[0] > 0
    part = jobs.get(f"{address}/results/0").json()
    assert part["status"] == "running" and part["iterations"] > 0
    assert part["particles"][COUNT // 2][2] < 0.0
    assert table(jobs, address) == []
    jobs.delete(address)
    job = ended(jobs, address)
    again = events(jobs, address)
    assert again[: len(seen)] == seen
    assert again[-1][1:] == ("cancelled", job)
    assert [n for n, _, _ in again] == list(range(1, len(again) + 1))
    assert events(jobs, address, numbers[2]) == again[3:]


def test_cancelled_it_keeps_its_last_shape(jobs: httpx.Client) -> None:
    address = going(jobs)
    for _ in range(2):
        assert jobs.delete(address).status_code == 204
    job = ended(jobs, address)
    assert job["status"] == "cancelled" and job["message"].startswith("Cancelled")
    assert jobs.delete(address).status_code == 204
    shape = jobs.get(f"{address}/results/0").json()
    assert shape["status"] == "cancelled" and shape["iterations"] > 0 and len(shape["particles"]) == COUNT
    for row in table(jobs, address):  # none where it was stopped by force
        assert (row["status"], row["iterations"]) == ("cancelled", shape["iterations"])


@pytest.mark.skipif(not hasattr(signal, "SIGSTOP"), reason="a process cannot be stopped here")
def test_cancelled_while_its_worker_hangs(runner: Served, jobs: httpx.Client) -> None:
    address = going(jobs)
    before = job_workers(runner)
    for worker in before:
        worker.suspend()
    jobs.delete(address)
    assert ended(jobs, address)["status"] == "cancelled"
    shape = jobs.get(f"{address}/results/0").json()
    assert shape["status"] == "cancelled" and shape["iterations"] > 0
    stream = events(jobs, address)
    assert [name for _, name, _ in stream].count("cancelled") == 1 and stream[-1][1] == "cancelled"
    for worker in before:
        with suppress(psutil.NoSuchProcess):
            worker.resume()
    assert ended(jobs, post(jobs, {"scene": CABLE}))["status"] == "done"
    assert {p.pid for p in job_workers(runner)} != {p.pid for p in before}


@pytest.mark.skipif(not hasattr(signal, "SIGSTOP"), reason="a process cannot be stopped here")
def test_a_sweep_cancelled_while_its_workers_hang(runner: Served, jobs: httpx.Client) -> None:
    wait_for(lambda: states(jobs)["starting"] == 0)
    address = post(jobs, sweep(*LONG))
    wait_for(lambda: jobs.get(address).json()["done"] > 10 and states(jobs)["starting"] == 0)
    before = job_workers(runner)
    for worker in before:
        worker.suspend()
    wait_for(lambda: states(jobs)["busy"] == len(before))  # those that waited for a batch have one by then
    jobs.delete(address)
    job = ended(jobs, address)
    assert job["status"] == "cancelled" and len(table(jobs, address)) == job["done"] < job["total"]
    assert ended(jobs, post(jobs, sweep(2, 2)))["status"] == "done"
    assert not {p.pid for p in job_workers(runner)} & {p.pid for p in before}


def test_a_killed_worker_goes_on_from_the_checkpoint(runner: Served, jobs: httpx.Client) -> None:
    """Where the iterations fall back, they do so because of a kill, and no further than to what was kept before it.
    Of the n-th fall that is the n-th kill or a later one, before which at least as much was kept."""
    address = going(jobs)
    known: list[int] = []
    for _ in range(4):  # more often than it is tried without getting on
        known.append(kept(jobs, address))
        wait_for(lambda: iteration(jobs, address) > known[-1])
        for worker in job_workers(runner):
            worker.kill()
        wait_for(lambda: kept(jobs, address) > known[-1])
    assert jobs.get(address).json()["status"] == "running"
    jobs.delete(address)
    assert ended(jobs, address)["status"] == "cancelled"
    steps = [said["iteration"] for _, name, said in events(jobs, address) if name == "progress"]
    falls = [after for before, after in pairwise(steps) if after <= before]
    assert steps[-1] > known[-1]
    assert all(after > least for after, least in zip(falls, known, strict=False)) and len(falls) <= len(known)


def seen_so_far(client: httpx.Client, address: str) -> list[tuple[int, str, Any]]:
    """Events up to one of the iteration where it is now."""
    text = ""
    last = iteration(client, address)
    with client.stream("GET", f"{address}/events") as stream:
        for chunk in stream.iter_text():
            text += chunk
            if f'"iteration": {last},' in text:
                break
    return parsed(text[: text.rindex("\n\n") + 2])


@pytest.mark.soak
def test_kill_9_of_the_server_goes_on_from_the_checkpoint(tmp_path: Path) -> None:
    state = str(tmp_path / "state.db")
    first = Served(state=state)
    address = going(first.client)
    known = kept(first.client, address)
    first.end(signal.SIGKILL)
    second = Served(state=state)
    try:
        assert kept(second.client, address) >= known
        wait_for(lambda: kept(second.client, address) > known)
        numbers = [n for n, _, _ in seen_so_far(second.client, address)]
        assert numbers == sorted(set(numbers))
        assert second.client.delete(address).status_code == 204
    finally:
        second.end(signal.SIGKILL)
    third = Served(state=state)
    try:
        job = third.client.get(address).json()
        assert job["status"] == "cancelled"
        assert kept(third.client, address) >= known
        assert [name for _, name, _ in events(third.client, address)].count("cancelled") == 1
    finally:
        assert third.end()[0] == 0


def test_a_relaxation_leaves_room_for_sweeps(jobs: httpx.Client) -> None:
    both = [post(jobs, {"scene": ENDLESS}) for _ in range(4)]
    assert ended(jobs, post(jobs, sweep(3, 3)))["status"] == "done"
    for address in both:
        jobs.delete(address)
    for address in both:
        assert ended(jobs, address)["status"] == "cancelled"


def test_the_server_ends_with_streams_open_and_jobs_running() -> None:
    served = Served(PATIENT)
    address = going(served.client)
    post(served.client, sweep(*LONG))
    opened = threading.Event()

    def listen() -> None:
        try:
            with served.client.stream("GET", f"{address}/events") as stream:
                for _ in stream.iter_text():
                    opened.set()
        except httpx.HTTPError:
            pass

    listener = threading.Thread(target=listen)
    listener.start()
    assert opened.wait(HANG)
    family = served.family()
    code, said = served.end()
    listener.join(HANG)
    assert (code, said) == (0, "")
    wait_for(lambda: not any(living(p.pid) for p in family))


def test_what_is_not_there(jobs: httpx.Client) -> None:
    for path in ("/v1/jobs/none", "/v1/jobs/none/events", "/v1/jobs/none/results", "/v1/jobs/none/results/0"):
        problem(jobs.get(path), 404, "not-found")
    problem(jobs.delete("/v1/jobs/none"), 404, "not-found")
    problem(jobs.put("/v1/jobs", json={}), 405, "method-not-allowed")
    problem(jobs.post("/v1/jobs", content="x", headers={"content-type": "text/plain"}), 415, "unsupported-media")
    address = post(jobs, {"scene": CABLE})
    ended(jobs, address)
    problem(jobs.get(f"{address}/results/1"), 404, "not-found")
    for number in ("-1", "x", str(2**40)):
        problem(jobs.get(f"{address}/results/{number}"), 422, "invalid-input")
    problem(jobs.get(f"{address}/results", params={"format": "xml"}), 422, "invalid-input")
    assert events(jobs, address, None) == parsed(jobs.get(f"{address}/events", headers={"last-event-id": "?"}).text)


def test_answers_fit_the_description(jobs: httpx.Client) -> None:
    document = jobs.get("/v1/openapi.json").json()

    def check(path: str, answer: httpx.Response, method: str = "get") -> None:
        told = document["paths"][path][method]["responses"][str(answer.status_code)]
        schema = told["content"]["application/json"]["schema"]
        jsonschema.Draft202012Validator({**schema, "components": document["components"]}).validate(answer.json())

    request = document["components"]["schemas"]["JobRequest"]
    for example in request["examples"]:
        jsonschema.Draft202012Validator({**request, "components": document["components"]}).validate(example)
        answer = jobs.post("/v1/jobs", json=example)
        check("/v1/jobs", answer, "post")
        address = answer.headers["location"]
        assert ended(jobs, address)["failed"] == 0
        check("/v1/jobs/{job}", jobs.get(address))
        check("/v1/jobs/{job}/results", jobs.get(f"{address}/results"))
        check("/v1/jobs/{job}/results/{number}", jobs.get(f"{address}/results/0"))
    check("/v1/jobs", jobs.get("/v1/jobs"))


def test_a_silent_stream_has_heartbeats(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tables, "HEARTBEAT", 0.02)
    monkeypatch.setattr(tables, "LOOK", 0.01)
    store = Store(None)

    async def go() -> list[bytes]:
        kept = rows.Kept("j", "relaxation", 1, "running", "", 0.0)
        live = Live(kept)
        served: Any = SimpleNamespace(store=store, pool=SimpleNamespace(stopping=threading.Event()))
        await store.run(rows.add(kept, b"{}\n{}", "", "", "", b""))
        seen: list[bytes] = []
        async for chunk in tables.events(served, live, 0):
            seen.append(chunk)
            if seen.count(b": still here\n\n") == 3 and not live.ended:
                await store.run(rows.store("j", [rows.Row(0, 1, "done", b'{"number":0}\n{}')]))
                live.event, live.ended, kept.status = 1, True, "done"
                live.tell()
        return seen

    try:
        seen = asyncio.run(go())
    finally:
        store.close()
    assert seen.count(b": still here\n\n") == 3
    assert [(n, name) for n, name, _ in parsed(b"".join(seen).decode())] == [(1, "item"), (2, "done")]
    assert json.loads(seen[-1].split(b"data: ")[1])["status"] == "done"


def test_a_job_is_use_of_the_service() -> None:
    jobs = Jobs(Settings(), Store(None), Pool(Settings()))
    pool, sessions = SimpleNamespace(states=lambda: {"busy": 0}), SimpleNamespace(sessions={})
    app: Any = SimpleNamespace(state=SimpleNamespace(jobs=jobs, pool=pool, sessions=sessions))
    activity = Activity(app)
    for ended_, idle in ((True, True), (False, False)):
        jobs.jobs["j"] = Live(rows.Kept("j", "sweep", 1, "running", "", 0.0), ended=ended_)
        activity.last = time.monotonic() - 1000.0
        assert (activity.idle() > 999.0) == idle
