"""Sweeps on a real Dask cluster on loopback: the bits of the pool, nothing lost with its workers or its scheduler."""

from __future__ import annotations

import importlib.util
import json
import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from typing import Any

import httpx
import psutil
import pytest

from serving import SOAK, wait_for

from .conftest import Served, computing
from .jobbing import NET, end_all, ended, events, post, product, rows_of, sweep, table

if importlib.util.find_spec("distributed") is None:
    pytest.skip("distributed is not installed: pip install 'hookean[dask]'", allow_module_level=True)


class Dask:
    """A scheduler and workers, each a process of its own, on loopback."""

    def __init__(self, port: int = 0) -> None:
        command = [sys.executable, "-m", "distributed.cli.dask_scheduler", "--host", "127.0.0.1"]
        self.scheduler = subprocess.Popen(
            [*command, "--port", str(port), "--no-dashboard", "--no-jupyter"],
            stderr=subprocess.PIPE,
            text=True,
        )
        assert self.scheduler.stderr is not None
        self.address = ""
        for line in self.scheduler.stderr:
            if "Scheduler at:" in line:
                self.address = line.split()[-1]
                break
        assert self.address.startswith("tcp://127.0.0.1:"), self.address
        # nobody reads the rest; a full pipe would stop the scheduler
        self.drain = subprocess.Popen(["cat"], stdin=self.scheduler.stderr, stdout=subprocess.DEVNULL)
        self.workers: list[subprocess.Popen[str]] = []

    def worker(self, *, nanny: bool = False) -> subprocess.Popen[str]:
        """One more worker, of one thread; with a `nanny` that starts it anew when it is told to."""
        command = [sys.executable, "-m", "distributed.cli.dask_worker", self.address, "--host", "127.0.0.1"]
        process = subprocess.Popen(
            [*command, "--nthreads", "1", "--nanny" if nanny else "--no-nanny", "--no-dashboard"],
            stderr=subprocess.DEVNULL,
            text=True,
            env={**os.environ, "OMP_NUM_THREADS": "1"},
        )
        self.workers.append(process)
        return process

    def end(self) -> None:
        for process in (*self.workers, self.scheduler, self.drain):
            for child in psutil.Process(process.pid).children(recursive=True) if process.poll() is None else []:
                child.kill()
            process.kill()
            process.wait()
        assert self.scheduler.stderr is not None
        self.scheduler.stderr.close()


@pytest.fixture(scope="module")
def dask() -> Iterator[Dask]:
    found = Dask()
    found.worker()
    yield found
    found.end()


@pytest.fixture(scope="module")
def served(dask: Dask) -> Iterator[Served]:
    found = Served(dask=dask.address)
    yield found.ready()
    assert found.end()[0] == 0


@pytest.fixture
def jobs(served: Served) -> Iterator[httpx.Client]:
    yield served.client
    end_all(served.client)


@pytest.mark.soak
def test_rows_are_byte_for_byte_those_of_the_pool(jobs: httpx.Client) -> None:
    request = sweep(100, 100) if SOAK else sweep(20, 10)
    address = post(jobs, request)
    local = Served()
    try:
        other = post(local.ready().client, request)
        assert ended(local.client, other)["done"] == ended(jobs, address)["done"] == product(request)
        assert rows_bytes(jobs, address) == rows_bytes(local.client, other)
        assert table(jobs, address)[:20] == rows_of(request, list(range(20)))
    finally:
        local.end()
    assert [n for n, _, _ in events(jobs, address)] == list(range(1, product(request) + 2))


def rows_bytes(client: httpx.Client, address: str) -> bytes:
    """The rows as they were written."""
    return client.get(f"{address}/results").content.partition(b'"rows": ')[2]


@pytest.mark.soak
def test_a_killed_worker_loses_nothing(dask: Dask, jobs: httpx.Client) -> None:
    request = sweep(100, 100) if SOAK else sweep(20, 10)
    count = product(request)
    address = post(jobs, request)
    wait_for(lambda: jobs.get(address).json()["done"] > count // 10)
    for worker in list(dask.workers):  # all there are
        worker.kill()
        worker.wait()
        dask.workers.remove(worker)
    dask.worker()
    job = ended(jobs, address)
    assert (job["status"], job["done"]) == ("done", count)
    found = table(jobs, address)
    assert [row["number"] for row in found] == list(range(count))
    some = list(range(0, count, 41))
    assert [found[n] for n in some] == rows_of(request, some)


@pytest.mark.soak
def test_an_item_that_does_not_fit_fails_alone(jobs: httpx.Client) -> None:
    address = post(jobs, {"scene": NET, "sweep": {"forces": {"net": {"stiffness": [1000, -1, 2000]}}}})
    assert ended(jobs, address)["failed"] == 1
    assert [row["status"] for row in table(jobs, address)] == ["converged", "failed", "converged"]


@pytest.mark.soak
def test_a_cancelled_sweep_frees_the_cluster(dask: Dask, jobs: httpx.Client) -> None:
    settings = {"solver": "verlet", "drag": 0, "max_iterations": 10**9, "time_limit": 3600}
    endless: dict[str, Any] = {"scene": {**NET, "settings": settings}, "sweep": {"settings": {"tolerance": [0.0] * 9}}}
    address = post(jobs, endless)
    wait_for(lambda: jobs.get(address).json()["status"] == "running")
    computing(psutil.Process(dask.workers[0].pid))
    jobs.delete(address)
    assert ended(jobs, address)["status"] == "cancelled"
    # its worker has one thread, which is free again
    assert ended(jobs, post(jobs, sweep(2, 2)))["status"] == "done"


@pytest.mark.soak
@pytest.mark.skipif(not hasattr(signal, "SIGSTOP"), reason="a process cannot be stopped here")
def test_a_worker_that_hangs_is_started_anew() -> None:
    dask = Dask()
    nanny = dask.worker(nanny=True)
    served = Served(dask=dask.address, solve_seconds=3.0, grace_seconds=1.0)
    try:
        request = sweep(15, 10)
        address = post(served.ready().client, request)
        wait_for(lambda: served.client.get(address).json()["done"] > 20)
        hung = [p for p in psutil.Process(nanny.pid).children(recursive=True) if not p.children()]
        for process in hung:
            if "tracker" not in " ".join(process.cmdline()):
                process.suspend()
        job = ended(served.client, address)
        assert (job["status"], job["done"], job["failed"]) == ("done", 150, 0)
    finally:
        dask.end()
        assert served.end()[0] == 0


@pytest.mark.soak
def test_a_cluster_that_is_away_is_waited_for() -> None:
    first = Dask()
    first.worker()
    served = Served(dask=first.address)
    second = None
    try:
        request = sweep(20, 10)
        address = post(served.ready().client, request)
        wait_for(lambda: served.client.get(address).json()["done"] > 20)
        first.end()
        wait_for(lambda: "waits for it" in served.client.get(address).json()["message"])
        assert served.client.get("/v1/health").json()["status"] == "ok"
        second = Dask(int(first.address.rsplit(":", 1)[1]))
        second.worker()
        job = ended(served.client, address)
        assert (job["status"], job["done"], job["failed"]) == ("done", 200, 0)
        assert json.dumps(table(served.client, address)[199]) == json.dumps(rows_of(request, [199])[0])
    finally:
        first.end()
        if second is not None:
            second.end()
        assert served.end()[0] == 0
