"""Sweeps over HTTP: every item once, in the bits of the core, whatever happens to workers and server meanwhile."""

from __future__ import annotations

import asyncio
import csv
import io
import json
import signal
import sqlite3
import threading
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest

from hookean_server.jobs import rows
from hookean_server.jobs.executors import Local
from hookean_server.jobs.runner import Live, Pending, Runner
from hookean_server.problems import Problem
from hookean_server.settings import Settings
from hookean_server.store import Store
from serving import CABLE, SOAK, wait_for

from .conftest import Served, problem
from .jobbing import LONG, NET, end_all, ended, events, job_workers, parsed, post, product, rows_of, sweep, table


@pytest.fixture(scope="module")
def sweeper() -> Iterator[Served]:
    found = Served()
    yield found.ready()
    assert found.end()[0] == 0


@pytest.fixture
def jobs(sweeper: Served) -> Iterator[httpx.Client]:
    yield sweeper.client
    end_all(sweeper.client)


def test_rows_are_those_of_the_core(jobs: httpx.Client) -> None:
    request = sweep(4, 3)
    address = post(jobs, request)
    job = ended(jobs, address)
    assert (job["status"], job["total"], job["done"], job["failed"]) == ("done", 12, 12, 0)
    assert table(jobs, address) == rows_of(request)
    whole = jobs.get(f"{address}/results").json()
    assert whole["parameters"] == ["net.stiffness", "load.vector"]
    assert {"name": "net.largest", "unit": "N"} in whole["columns"]


def test_the_table_as_csv_says_the_same(jobs: httpx.Client) -> None:
    request = sweep(2, 2)
    address = post(jobs, request)
    ended(jobs, address)
    by_accept = jobs.get(f"{address}/results", headers={"accept": "text/csv"})
    by_query = jobs.get(f"{address}/results", params={"format": "csv"})
    assert by_accept.content == by_query.content
    assert by_accept.headers["content-type"].startswith("text/csv")
    lines = list(csv.DictReader(io.StringIO(by_accept.text, newline="")))
    for line, row in zip(lines, table(jobs, address), strict=True):
        assert int(line["number"]) == row["number"]
        assert float(line["net.stiffness"]) == row["parameters"]["net.stiffness"]
        assert json.loads(line["load.vector"]) == row["parameters"]["load.vector"]
        assert [float(line["net.smallest [N]"]), float(line["net.largest [N]"])] == row["forces"]["net"]
        assert float(line["energy [N m]"]) == row["energy"]
        assert (line["status"], line["message"]) == (row["status"], row["message"])


def test_one_item_is_the_result_of_its_scene(jobs: httpx.Client) -> None:
    request = sweep(2, 2)
    address = post(jobs, request)
    ended(jobs, address)
    net, load = NET["forces"]
    changed = [{**net, "stiffness": 6010.0}, {**load, "vector": [0, 0, -1.01]}]
    relaxed = jobs.post("/v1/relax", json={**NET, "forces": changed})
    assert jobs.get(f"{address}/results/3").content == relaxed.content
    problem(jobs.get(f"{address}/results/4"), 404, "not-found")


def test_events_tell_of_every_item_once_and_of_the_end_once(jobs: httpx.Client) -> None:
    address = post(jobs, sweep(20, 3))
    live = events(jobs, address)
    assert [number for number, _, _ in live] == list(range(1, 62))
    assert [name for _, name, _ in live] == ["item"] * 60 + ["done"]
    assert sorted((row for _, _, row in live[:-1]), key=lambda row: row["number"]) == table(jobs, address)
    assert live[-1][2] == jobs.get(address).json()
    for after in (0, 1, 30, 59, 60):
        assert events(jobs, address, after) == live[after:]
    assert events(jobs, address, 61) == events(jobs, address, 10**8) == []


def test_a_stream_that_breaks_off_goes_on_where_it_was(jobs: httpx.Client) -> None:
    address = post(jobs, sweep(40, 10))
    seen: list[tuple[int, str, Any]] = []
    while not seen or seen[-1][1] != "done":
        headers = {"last-event-id": str(seen[-1][0] if seen else 0)}
        text = ""
        with jobs.stream("GET", f"{address}/events", headers=headers) as stream:
            for chunk in stream.iter_text():
                text += chunk
                if len(text) > 20_000:
                    break
        seen += parsed(text[: text.rindex("\n\n") + 2])
    assert [number for number, _, _ in seen] == list(range(1, 402))
    assert Counter(name for _, name, _ in seen) == {"item": 400, "done": 1}


def test_an_item_that_does_not_fit_fails_alone(jobs: httpx.Client) -> None:
    request = {"scene": NET, "sweep": {"forces": {"net": {"stiffness": [6000, -1, "much", 7000]}}}}
    address = post(jobs, request)
    job = ended(jobs, address)
    assert (job["status"], job["done"], job["failed"]) == ("done", 2, 2)
    found = table(jobs, address)
    assert [row["status"] for row in found] == ["converged", "failed", "failed", "converged"]
    assert "/forces/net/stiffness" in found[1]["message"]
    assert jobs.get(f"{address}/results/1").json() == found[1]
    lines = list(csv.DictReader(io.StringIO(jobs.get(f"{address}/results?format=csv").text, newline="")))
    assert [line["iterations"] == "" for line in lines] == [False, True, True, False]


@pytest.mark.parametrize(
    ("request_", "slug", "pointer"),
    [
        ([], "invalid-input", "/"),
        ({}, "invalid-input", "/scene"),
        ({"scene": NET, "sweeps": {}}, "invalid-input", "/sweeps"),
        ({"scene": {**NET, "anchors": 1}}, "invalid-scene", "/scene/anchors"),
        ({"scene": {}}, "invalid-scene", "/scene/particles"),
        ({"scene": {**CABLE, "settings": {"solver": "force_density"}}}, "invalid-scene", "/scene/settings/solver"),
        ({"scene": NET, "sweep": {}}, "invalid-input", "/sweep"),
        ({"scene": NET, "sweep": {"settings": {"drag": []}}}, "invalid-input", "/sweep/settings/drag"),
        ({"scene": NET, "sweep": {"forces": {"no": {"stiffness": [1]}}}}, "invalid-input", "/sweep/forces/no"),
        ({"scene": NET, "sweep": {"forces": {"net": {"kind": [1]}}}}, "invalid-input", "/sweep/forces/net/kind"),
        ({"scene": NET, "sweep": {"patches": [{}] * 200_000}}, "invalid-input", "/sweep"),
    ],
)
def test_faults_of_a_request(jobs: httpx.Client, request_: Any, slug: str, pointer: str) -> None:
    before = len(jobs.get("/v1/jobs").json()["jobs"])
    found = problem(jobs.post("/v1/jobs", json=request_), 422, slug)
    assert found["errors"][0]["pointer"] == pointer
    assert len(jobs.get("/v1/jobs").json()["jobs"]) == before


def test_a_sweep_larger_than_allowed_is_refused() -> None:
    from hookean_server.workers.registry import perform

    body = json.dumps(sweep(10, 10)).encode()
    head, _ = perform({"task": "job", "options": {"items": 99}}, body, lambda: False)
    assert head["problem"] == "invalid-input"
    assert "100 items" in head["detail"] and "99" in head["detail"]


def test_requests_are_answered_while_a_sweep_runs(jobs: httpx.Client) -> None:
    address = post(jobs, sweep(*LONG))
    wait_for(lambda: jobs.get(address).json()["done"] > 0)
    for _ in range(5):
        assert jobs.post("/v1/relax", json=CABLE).status_code == 200
    assert jobs.get(address).json()["status"] == "running"
    assert jobs.delete(address).status_code == 204
    assert ended(jobs, address)["status"] == "cancelled"


def test_a_cancelled_sweep_keeps_its_rows(jobs: httpx.Client) -> None:
    request = sweep(*LONG)
    address = post(jobs, request)
    wait_for(lambda: jobs.get(address).json()["done"] > 10)
    for _ in range(2):
        assert jobs.delete(address).status_code == 204
    job = ended(jobs, address)
    assert job["status"] == "cancelled" and 10 < job["done"] < product(request)
    found = table(jobs, address)
    assert len(found) == job["done"]
    assert found == rows_of(request, [row["number"] for row in found])
    stream = events(jobs, address)
    assert len(stream) == job["done"] + 1 and stream[-1][1] == "cancelled"
    assert jobs.delete(address).status_code == 204
    assert jobs.get(address).json() == job
    assert events(jobs, address) == stream


def test_killed_workers_lose_nothing(sweeper: Served, jobs: httpx.Client) -> None:
    request = sweep(100, 100) if SOAK else sweep(25, 20)
    count = product(request)
    address = post(jobs, request)
    for reached in range(count // 10, count, count // 5):
        wait_for(lambda reached=reached: jobs.get(address).json()["done"] > reached)
        for worker in job_workers(sweeper)[:1]:
            worker.kill()
    job = ended(jobs, address)
    assert (job["status"], job["done"]) == ("done", count)
    found = table(jobs, address)
    assert [row["number"] for row in found] == list(range(count))
    some = list(range(0, count, 37))
    assert [found[n] for n in some] == rows_of(request, some)
    assert [number for number, _, _ in events(jobs, address)] == list(range(1, count + 2))


def test_the_same_key_is_the_same_job(jobs: httpx.Client) -> None:
    first = jobs.post("/v1/jobs", json=sweep(2, 1), headers={"idempotency-key": "a"})
    again = jobs.post("/v1/jobs", json=sweep(2, 1), headers={"idempotency-key": "a"})
    assert (first.status_code, again.status_code) == (202, 202)
    assert "idempotency-replayed" not in first.headers and again.headers["idempotency-replayed"] == "true"
    assert (first.content, first.headers["location"]) == (again.content, again.headers["location"])
    problem(jobs.post("/v1/jobs", json=sweep(3, 1), headers={"idempotency-key": "a"}), 422, "key-reused")
    other = jobs.post("/v1/jobs", json=sweep(2, 1), headers={"idempotency-key": "b"})
    assert other.headers["location"] != first.headers["location"]
    for bad in ("", "x" * 256, "with space"):
        problem(jobs.post("/v1/jobs", json=sweep(2, 1), headers={"idempotency-key": bad}), 422, "invalid-input")


def test_a_key_of_a_refused_request_is_free(jobs: httpx.Client) -> None:
    problem(jobs.post("/v1/jobs", json={"scene": {}}, headers={"idempotency-key": "c"}), 422, "invalid-scene")
    assert jobs.post("/v1/jobs", json=sweep(1, 1), headers={"idempotency-key": "c"}).status_code == 202


def test_a_storm_of_one_key_makes_one_job(jobs: httpx.Client) -> None:
    body, found = sweep(1, 2), []

    def ask() -> None:
        found.append(jobs.post("/v1/jobs", json=body, headers={"idempotency-key": "storm"}))

    threads = [threading.Thread(target=ask) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len({answer.headers["location"] for answer in found}) == 1
    assert sum("idempotency-replayed" in answer.headers for answer in found) == 7


def test_kill_9_of_the_server_in_the_middle(tmp_path: Path) -> None:
    request, state = sweep(20, 10), str(tmp_path / "state.db")
    first = Served(state=state)
    key = {"idempotency-key": "once"}
    address = post(first.client, request, **key)
    cancelled = post(first.client, sweep(20, 10))
    assert first.client.delete(cancelled).status_code == 204
    wait_for(lambda: first.client.get(address).json()["done"] > 20)
    with first.client.stream("GET", f"{address}/events") as stream:
        text = ""
        for chunk in stream.iter_text():
            text += chunk
            if text.count("\n\n") > 20:
                break
    seen = parsed(text[: text.rindex("\n\n") + 2])
    first.end(signal.SIGKILL)
    second = Served(state=state)
    try:
        assert second.client.get(cancelled).json()["status"] == "cancelled"
        again = second.client.post("/v1/jobs", json=request, headers=key)
        assert again.headers["location"] == address and again.headers["idempotency-replayed"] == "true"
        job = ended(second.client, address)
        assert (job["status"], job["done"]) == ("done", product(request))
        after = events(second.client, address)
        assert after[: len(seen)] == seen  # what was shown is as it was, and is not solved again
        assert [number for number, _, _ in after] == list(range(1, product(request) + 2))
        assert [row["number"] for row in table(second.client, address)] == list(range(product(request)))
    finally:
        assert second.end()[0] == 0


def test_as_many_jobs_as_are_taken(tmp_path: Path) -> None:
    served = Served(jobs=2, state=str(tmp_path / "state.db"))
    try:
        slow = {"scene": NET, "sweep": {"settings": {"tolerance": [0.0] * 50}}}
        slow["scene"] = {**NET, "settings": {"solver": "verlet", "max_iterations": 10**9, "drag": 0}}
        addresses = [post(served.client, slow) for _ in range(2)]
        refused = served.client.post("/v1/jobs", json=slow)
        problem(refused, 429, "job-limit")
        assert int(refused.headers["retry-after"]) > 0
        served.client.delete(addresses[0])
        ended(served.client, addresses[0])
        addresses.append(post(served.client, slow))
    finally:
        assert served.end()[0] == 0


class Breaking:
    """An executor whose workers break at some items."""

    slots = 3

    def __init__(self, poison: set[int]) -> None:
        self.poison, self.asked = poison, Counter[int]()

    async def ready(self) -> None:
        pass

    async def batch(self, request: bytes, numbers: list[int], seconds: float) -> list[bytes]:
        await asyncio.sleep(0)
        self.asked.update(numbers if len(numbers) == 1 else [])
        if self.poison & set(numbers):
            raise Problem("worker-lost", "A worker ended.")
        done = numbers[: max(1, len(numbers) // 2)]
        return [json.dumps({"number": n, "status": "converged"}).encode() for n in done]

    async def close(self) -> None:
        pass


def run(
    executor: Breaking, store: Store, count: int = 200, seen: Any = None
) -> tuple[tuple[str, str], Live, list[rows.Row]]:
    """A sweep run without a server: how it ended, and what is in the store."""

    async def go() -> Any:
        kept = rows.Kept("j", "sweep", count, "waiting", "", 0.0)
        request = json.dumps({"scene": NET, "sweep": {"patches": [{}] * count}}).encode()
        await store.run(rows.add(kept, b"{}\n" + request, "", "", "", b""))
        live = Live(kept)
        settings = Settings()
        end = await Runner(settings, seen or store, Local(settings), executor).run(live)
        return end, live, await store.run(rows.rows("j", -1, 10**6))

    return asyncio.run(go())  # type: ignore[no-any-return]


@pytest.fixture
def store() -> Iterator[Store]:
    found = Store(None)
    yield found
    found.close()


def test_items_that_end_their_workers_fail_after_three_tries_and_the_rest_goes_on(store: Store) -> None:
    executor = Breaking({7, 8, 150})
    (status, said), live, found = run(executor, store)
    assert status == "done" and "3 failed" in said
    assert {row.number for row in found if row.status == "failed"} == {7, 8, 150}
    assert [row.number for row in found] == list(range(200))
    assert (live.kept.done, live.kept.failed) == (197, 3)
    assert all(executor.asked[n] == 3 for n in (7, 8, 150))
    assert "3 tries" in json.loads(found[7].body)["message"]


def test_a_sweep_whose_items_all_fail_has_failed(store: Store) -> None:
    (status, _), live, found = run(Breaking(set(range(9))), store, 9)
    assert status == "failed" and live.kept.failed == len(found) == 9


class Failing:
    """A store whose disk refuses two of three."""

    def __init__(self, store: Store) -> None:
        self.store, self.calls = store, 0

    async def run(self, task: Any) -> Any:
        self.calls += 1

        def work(db: sqlite3.Connection) -> Any:
            task(db)
            raise sqlite3.OperationalError("database or disk is full")

        return await self.store.run(work if self.calls % 3 else task)


def test_a_store_that_fails_now_and_then_gets_every_row(store: Store, monkeypatch: pytest.MonkeyPatch) -> None:
    from hookean_server.jobs import runner

    monkeypatch.setattr(runner, "AGAIN", 0.0)
    failing = Failing(store)
    (status, _), live, found = run(Breaking({3}), store, 100, seen=failing)
    assert failing.calls > 30
    assert status == "done" and (live.kept.done, live.kept.failed) == (99, 1)
    assert [row.number for row in found] == list(range(100))
    assert len({row.event for row in found}) == 100


def test_batches_shrink_towards_the_end_and_lose_no_item() -> None:
    pending, sizes, seen = Pending(range(5000)), [], []
    while numbers := pending.take(2):
        sizes.append(len(numbers))
        seen += numbers[:400]
        pending.back(numbers[400:])
    assert seen == list(range(5000))
    assert sizes[0] == 500 and sizes[-1] == 1


def test_old_jobs_are_forgotten_with_their_keys_and_running_ones_never(store: Store) -> None:
    async def go() -> None:
        for name, status in (("old", "done"), ("used", "done"), ("runs", "running")):
            kept = rows.Kept(name, "sweep", 1, status, "", 0.0)
            await store.run(rows.add(kept, b"{}\n{}", f"key-{name}", "d", f"/v1/jobs/{name}", b"{}"))
            await store.run(rows.store(name, [rows.Row(0, 1, "done", b"{}")]))
        assert await store.run(rows.age(10.0, 15.0, [], 100)) == []
        assert await store.run(rows.age(10.0, 15.0, ["used"], 100)) == ["old"]
        assert await store.run(rows.answered("key-old")) is None
        assert await store.run(rows.item("old", 0)) is None
        assert {kept.id for kept in await store.run(rows.listed())} == {"used", "runs"}
        assert await store.run(rows.age(0.0, 15.0, [], 0)) == ["used"]

    asyncio.run(go())
