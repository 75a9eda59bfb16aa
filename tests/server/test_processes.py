"""Workers and their ends: health while solving, clients that leave, workers that die or hang, shutdown, taken ports."""

from __future__ import annotations

import http.client
import os
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from concurrent.futures import Future
from typing import Any

import httpx
import psutil
import pytest

from hookean_server.ports import owner
from serving import CABLE, wait_for

from .conftest import Served, endless, problem

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
JSON = {"content-type": "application/json"}


@pytest.fixture(scope="module")
def broken() -> Iterator[Served]:
    found = Served(workers=1, queue=2)
    yield found.ready()
    found.end()


@pytest.fixture
def alone(broken: Served) -> Served:
    """A server of one worker for tests that break it; whole again before each."""
    wait_for(lambda: broken.health()["requests"]["taken"] == 0)
    return broken.ready()


@pytest.fixture(scope="module")
def strict() -> Iterator[Served]:
    """A server of one worker and small limits."""
    limits = {"solve_seconds": 1.0, "grace_seconds": 3.0, "body_seconds": 0.5}
    found = Served(workers=1, **limits)
    yield found.ready()
    found.end()


def post_later(served: Served, scene: dict[str, Any], path: str = "/v1/relax") -> Future[httpx.Response]:
    future: Future[httpx.Response] = Future()

    def post() -> None:
        try:
            future.set_result(httpx.post(served.url + path, json=scene, timeout=60, headers=served.known))
        except Exception as error:
            future.set_exception(error)

    threading.Thread(target=post, daemon=True).start()
    return future


def busy(served: Served, count: int = 1) -> None:
    wait_for(lambda: served.health()["workers"]["busy"] >= count)


def test_health_answers_while_all_workers_solve(served: Served) -> None:
    count = served.health()["workers"]["idle"]
    running = [post_later(served, endless(3.0)) for _ in range(count)]
    busy(served, count)
    answers = 0
    while not running[0].done():
        assert served.health()["service"] == "hookean"
        answers += 1
        time.sleep(0.01)
    assert [r.result().json()["status"] for r in running] == ["time_limit"] * count
    assert answers > 20


def test_the_servers_own_limit_ends_a_solve_with_an_answer(strict: Served) -> None:
    scene = endless()
    del scene["settings"]["time_limit"]
    before = strict.health()["workers"]["restarts"]
    answer = strict.client.post("/v1/relax", json=scene)
    assert answer.status_code == 200 and answer.json()["status"] == "time_limit"
    assert strict.health()["workers"]["restarts"] == before


def test_a_client_that_leaves_frees_the_worker(alone: Served) -> None:
    worker = alone.workers()
    with pytest.raises(httpx.ReadTimeout):
        httpx.post(f"{alone.url}/v1/relax", json=endless(), timeout=0.5, headers=alone.known)
    wait_for(lambda: alone.health()["workers"]["idle"] == 1, 4.0)
    assert alone.client.post("/v1/relax", json=CABLE).json()["status"] == "converged"
    assert alone.health()["requests"]["taken"] == 0
    assert [p.pid for p in alone.workers()] == [p.pid for p in worker]  # it stopped by itself


def test_a_client_that_leaves_the_queue_is_forgotten(alone: Served) -> None:
    running = post_later(alone, endless(2.0))
    busy(alone)
    with pytest.raises(httpx.ReadTimeout):
        httpx.post(f"{alone.url}/v1/relax", json=endless(), timeout=0.3, headers=alone.known)
    wait_for(lambda: alone.health()["requests"]["taken"] == 1)
    assert running.result().json()["status"] == "time_limit"
    assert alone.client.post("/v1/relax", json=CABLE).status_code == 200


def test_a_worker_that_hangs_is_stopped(strict: Served) -> None:
    worker = strict.ready().workers()[0]
    worker.suspend()
    started = time.monotonic()
    problem(strict.client.post("/v1/relax", json=CABLE), 504, "out-of-time")
    assert time.monotonic() - started < 6.0
    assert strict.client.post("/v1/relax", json=CABLE).json()["status"] == "converged"
    assert not alive(worker)


def test_a_suspended_worker_whose_client_leaves_is_killed_after_two_seconds(alone: Served) -> None:
    worker = alone.workers()[0]
    before = alone.health()["workers"]["restarts"]
    worker.suspend()
    started = time.monotonic()
    with pytest.raises(httpx.ReadTimeout):
        httpx.post(f"{alone.url}/v1/relax", json=endless(), timeout=0.3, headers=alone.known)
    wait_for(lambda: alone.health()["workers"]["restarts"] > before, 5.0)
    assert 1.5 < time.monotonic() - started < 5.0
    assert alone.client.post("/v1/relax", json=CABLE).status_code == 200


def test_killing_a_worker_in_the_middle_of_a_solve(alone: Served) -> None:
    for _ in range(3):
        running = post_later(alone, endless())
        busy(alone)
        time.sleep(0.1)
        alone.workers()[0].kill()
        problem(running.result(timeout=5), 500, "worker-lost")
        assert alone.client.post("/v1/relax", json=CABLE).json()["status"] == "converged"


def test_a_worker_that_dies_idle_is_not_noticed_by_the_next_request(alone: Served) -> None:
    alone.workers()[0].kill()
    time.sleep(0.1)
    assert alone.client.post("/v1/relax", json=CABLE).json()["status"] == "converged"


def test_a_solve_that_needs_too_much_memory() -> None:
    """Two million particles in a worker of 200 MiB: refused, and the next request works. Time is no limit here."""
    small = Served(workers=1, worker_memory=200 * 2**20)
    try:
        small.ready()
        body = b'{"particles": [' + b"[0,0,0]," * 1_800_000 + b"[0,0,0]]}"
        problem(small.client.post("/v1/relax", content=body, headers=JSON, timeout=120), 413, "too-large")
        assert small.client.post("/v1/relax", json=CABLE, timeout=60).status_code == 200
    finally:
        small.end()


def test_a_full_service_says_so_before_it_reads(alone: Served) -> None:
    running = [post_later(alone, endless(2.5)) for _ in range(3)]
    wait_for(lambda: alone.health()["requests"]["taken"] == 3)
    assert alone.health()["status"] == "full"
    refused = alone.client.post("/v1/relax", json=CABLE)
    problem(refused, 503, "busy")
    assert int(refused.headers["retry-after"]) >= 1
    problem(alone.client.post("/v1/relax/3dm", files={"file": b"x" * 10**7}), 503, "busy")
    assert alone.health()["status"] == "full"
    running[0].result()
    wait_for(lambda: alone.health()["requests"]["taken"] < 3)


def test_a_body_that_does_not_come(strict: Served) -> None:
    head = f"POST /v1/relax HTTP/1.1\r\nHost: 127.0.0.1:{strict.port}\r\n{strict.head}"
    head += "Content-Type: application/json\r\nContent-Length: 100\r\n\r\n{"
    with socket.create_connection(("127.0.0.1", strict.port), timeout=10) as sock:
        sock.sendall(head.encode())
        assert sock.recv(65536).startswith(b"HTTP/1.1 408")
    wait_for(lambda: strict.health()["requests"]["taken"] == 0)


def test_a_client_that_leaves_in_the_middle_of_its_body(alone: Served) -> None:
    head = f"POST /v1/relax HTTP/1.1\r\nHost: 127.0.0.1:{alone.port}\r\n{alone.head}"
    head += "Content-Type: application/json\r\nContent-Length: 100\r\n\r\n{"
    with socket.create_connection(("127.0.0.1", alone.port), timeout=10) as sock:
        sock.sendall(head.encode())
        wait_for(lambda: alone.health()["requests"]["taken"] == 1)
    wait_for(lambda: alone.health()["requests"]["taken"] == 0)
    assert alone.client.post("/v1/relax", json=CABLE).status_code == 200


def test_a_connection_is_kept_longer_than_clients_keep_it(served: Served) -> None:
    """httpx gives one up after 5 s without a request. A server that did so at the same moment would end connections
    just as requests go down them, which then come to nothing."""
    connection = http.client.HTTPConnection("127.0.0.1", served.port, timeout=20)
    for pause in (6.0, 0.0):
        connection.request("GET", "/v1/health", headers={"Connection": "keep-alive"})
        assert connection.getresponse().read()
        time.sleep(pause)
    connection.close()


@pytest.mark.parametrize(
    ("what", "number"),
    [
        ("idle", signal.SIGTERM),
        ("solving", signal.SIGTERM),
        ("solving", signal.SIGINT),
        ("starting", signal.SIGTERM),
        ("reading", signal.SIGTERM),
    ],
)
def test_a_clean_end(what: str, number: int) -> None:
    served = Served(workers=2)
    running = None
    if what != "starting":
        served.ready()
        wait_for(lambda: served.health()["workers"]["starting"] == 0)
    if what == "solving":
        running = post_later(served, endless())
        busy(served)
    if what == "reading":
        sock = socket.create_connection(("127.0.0.1", served.port))
        sock.sendall(f"POST /v1/relax HTTP/1.1\r\nHost: 127.0.0.1:{served.port}\r\n{served.head}".encode())
        sock.sendall(b"Content-Type: application/json\r\nContent-Length: 100\r\n\r\n{")
        wait_for(lambda: served.health()["requests"]["taken"] == 1)
    family = served.family()
    code, seconds, said = served.end(number)
    if what == "reading":
        sock.close()
    assert code == 0 and seconds < 3.0, (code, seconds, said)
    assert "Traceback" not in said and "rror" not in said, said
    wait_for(lambda: not any(alive(p) for p in family), 2.0)
    if running is not None:
        problem(running.result(timeout=5), 503, "shutting-down")


def alive(process: psutil.Process) -> bool:
    try:
        return process.is_running() and process.status() != psutil.STATUS_ZOMBIE
    except psutil.NoSuchProcess:
        return False


def test_no_worker_outlives_a_server_that_is_killed() -> None:
    served = Served(workers=2).ready()
    running = post_later(served, endless())
    busy(served)
    family = served.family()
    assert family
    served.end(signal.SIGKILL)
    wait_for(lambda: not any(alive(p) for p in family), 5.0)
    with pytest.raises(httpx.HTTPError):
        running.result(timeout=5)


def test_ctrl_c_reaches_the_whole_group() -> None:
    """In a terminal every process of the group gets the signal; workers leave the decision to the server."""
    process = subprocess.Popen(
        [sys.executable, "-m", "hookean_server", "0"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    assert process.stdout is not None
    url = process.stdout.readline().split()[3]
    wait_for(lambda: httpx.get(f"{url}/v1/health").json()["workers"]["idle"] > 0, 60)
    os.killpg(process.pid, signal.SIGINT)
    _, said = process.communicate(timeout=10)
    assert process.returncode == 0 and said == ""


@pytest.mark.parametrize("seconds", [0.0, 0.05, 0.15, 0.3, 1.0])
def test_ctrl_c_soon_after_the_start(seconds: float) -> None:
    """While the fork server starts and warms up too: nothing said, exit code 0, no process left."""
    process = subprocess.Popen(
        [sys.executable, "-m", "hookean_server", "0"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    assert process.stdout is not None
    process.stdout.readline()
    time.sleep(seconds)
    family = psutil.Process(process.pid).children(recursive=True)
    os.killpg(process.pid, signal.SIGINT)
    _, said = process.communicate(timeout=10)
    assert process.returncode == 0 and said == ""
    wait_for(lambda: not any(alive(p) for p in family), 2.0)


def test_it_says_where_it_is_and_what_to_try(served: Served) -> None:
    assert served.said.startswith(f"hookean serves at {served.url}")
    line = served.process.stdout.readline()  # type: ignore[union-attr]
    assert served.token not in line
    known = {**os.environ, "HOOKEAN_TOKEN": served.token}
    done = subprocess.run(line, shell=True, capture_output=True, text=True, timeout=60, env=known)
    assert '"status": "converged"' in done.stdout, (line, done.stderr)


def test_a_taken_port_is_named_with_its_owner(served: Served) -> None:
    done = subprocess.run(
        [sys.executable, "-m", "hookean_server", str(served.port)], capture_output=True, text=True, timeout=30
    )
    assert done.returncode == 2 and done.stdout == ""
    assert done.stderr.count("\n") == 1
    assert f"Port {served.port} is taken" in done.stderr and f"(process {served.process.pid})" in done.stderr


def test_the_owner_of_a_port_without_psutil(monkeypatch: pytest.MonkeyPatch) -> None:
    with socket.create_server(("127.0.0.1", 0)) as sock:
        port = sock.getsockname()[1]
        assert f"(process {os.getpid()})" in owner(port)
        monkeypatch.setitem(sys.modules, "psutil", None)
        if sys.platform == "linux":
            assert f"(process {os.getpid()})" in owner(port)
    assert owner(port) == ""


def test_a_port_that_is_none() -> None:
    done = subprocess.run([sys.executable, "-m", "hookean_server", "99999"], capture_output=True, text=True, timeout=30)
    assert done.returncode == 2 and "Traceback" not in done.stderr
