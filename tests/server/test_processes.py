"""Workers and their ends: health while solving, clients that leave, workers that die or hang, shutdown, taken ports."""

from __future__ import annotations

import http.client
import os
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from concurrent.futures import Future
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import httpx
import psutil
import pytest

import forking
from hookean_server.lifecycle.ports import owner
from serving import CABLE, HANG, living, wait_for

from .conftest import PATIENT, Served, asked, computing, endless, problem

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
JSON = {"content-type": "application/json"}
NEVER = 10 * HANG
MODULE = "import runpy; runpy.run_module('hookean_server', run_name='__main__')"


@pytest.fixture(scope="module")
def broken() -> Iterator[Served]:
    found = Served(workers=1, queue=2, solve_seconds=NEVER, cancel_seconds=NEVER)
    yield found.ready()
    found.end()


@pytest.fixture
def alone(broken: Served) -> Served:
    """A server of one worker, which stops nothing by force, for tests that break it; whole again before each."""
    wait_for(lambda: broken.health()["requests"]["taken"] == 0)
    return broken.ready()


@pytest.fixture(scope="module")
def strict() -> Iterator[Served]:
    """A server of one worker and small limits; a worker has all the time it wants to keep them by itself."""
    found = Served(workers=1, solve_seconds=1.0, grace_seconds=NEVER, body_seconds=0.5)
    yield found.ready()
    found.end()


def post_later(served: Served, scene: dict[str, Any], path: str = "/v1/relax") -> Future[httpx.Response]:
    future: Future[httpx.Response] = Future()

    def post() -> None:
        try:
            future.set_result(httpx.post(served.url + path, json=scene, timeout=HANG, headers=served.known))
        except Exception as error:
            future.set_exception(error)

    threading.Thread(target=post, daemon=True).start()
    return future


def busy(served: Served, count: int = 1) -> None:
    wait_for(lambda: served.health()["workers"]["busy"] >= count)


def test_health_answers_while_all_workers_solve(served: Served) -> None:
    wait_for(lambda: served.health()["workers"]["starting"] == 0)
    count = served.health()["workers"]["idle"]
    with ExitStack() as clients:
        for _ in range(count):
            clients.enter_context(asked(served, endless(NEVER)))
        busy(served, count)
        assert [served.health()["workers"]["busy"] for _ in range(20)] == [count] * 20


def test_the_servers_own_limit_ends_a_solve_with_an_answer(strict: Served) -> None:
    scene = endless()
    del scene["settings"]["time_limit"]
    before = strict.health()["workers"]["restarts"]
    answer = strict.client.post("/v1/relax", json=scene)
    assert answer.status_code == 200 and answer.json()["status"] == "time_limit"
    assert strict.health()["workers"]["restarts"] == before


def test_a_client_that_leaves_frees_the_worker(alone: Served) -> None:
    """The solve has no end of its own and nothing stops it by force: the worker stops because the client has left."""
    worker = alone.workers()
    with asked(alone, endless(NEVER)):
        computing(worker[0])
    wait_for(lambda: alone.health()["workers"]["idle"] == 1)
    assert alone.client.post("/v1/relax", json=CABLE).json()["status"] == "converged"
    assert alone.health()["requests"]["taken"] == 0
    assert [p.pid for p in alone.workers()] == [p.pid for p in worker]


def test_a_client_that_leaves_the_queue_is_forgotten(alone: Served) -> None:
    with asked(alone, endless(NEVER)):
        busy(alone)
        with asked(alone, endless(NEVER)):
            wait_for(lambda: alone.health()["requests"]["taken"] == 2)
        wait_for(lambda: alone.health()["requests"]["taken"] == 1)
        assert alone.health()["workers"]["busy"] == 1
    assert alone.client.post("/v1/relax", json=CABLE).status_code == 200


def test_a_worker_that_hangs_is_stopped() -> None:
    """Checking a job has a second here, after which whoever does it is stopped; a solve has all the time it wants."""
    served = Served(workers=1, file_seconds=1.0).ready()
    try:
        worker = served.workers()[0]
        worker.suspend()
        problem(served.client.post("/v1/jobs", json={"scene": CABLE}), 504, "out-of-time")
        assert not living(worker.pid)
        assert served.client.post("/v1/relax", json=CABLE).json()["status"] == "converged"
    finally:
        served.end()


def test_a_suspended_worker_whose_client_leaves_is_killed(strict: Served) -> None:
    """By the time that a worker has to stop, `cancel_seconds`: those of a solve do not end within this test."""
    worker = strict.ready().workers()[0]
    before = strict.health()["workers"]["restarts"]
    worker.suspend()
    with asked(strict, endless()):
        busy(strict)
    wait_for(lambda: strict.health()["workers"]["restarts"] > before)
    assert not living(worker.pid)
    assert strict.client.post("/v1/relax", json=CABLE).json()["status"] == "converged"


def test_killing_a_worker_in_the_middle_of_a_solve(alone: Served) -> None:
    for _ in range(2):
        worker = alone.ready().workers()[0]
        running = post_later(alone, endless())
        computing(worker)
        worker.kill()
        problem(running.result(timeout=HANG), 500, "worker-lost")
        assert alone.client.post("/v1/relax", json=CABLE).json()["status"] == "converged"


def test_a_worker_that_dies_idle_is_not_noticed_by_the_next_request(alone: Served) -> None:
    """Also where the fork server, here suspended, has not reported its end yet."""
    worker = alone.workers()[0]
    parent = worker.parent()
    assert parent is not None
    parent.suspend()
    try:
        worker.kill()
        wait_for(lambda: ended(worker))
        answer = post_later(alone, CABLE)
        wait_for(lambda: answer.done() or alone.health()["workers"]["starting"])
    finally:
        parent.resume()
    assert answer.result().json()["status"] == "converged"


def test_a_solve_that_needs_too_much_memory() -> None:
    """Two million particles in a worker of 200 MiB: refused, and the next request works. Time is no limit here."""
    small = Served(workers=1, worker_memory=200 * 2**20)
    try:
        small.ready()
        body = b'{"particles": [' + b"[0,0,0]," * 1_800_000 + b"[0,0,0]]}"
        problem(small.client.post("/v1/relax", content=body, headers=JSON, timeout=HANG), 413, "too-large")
        assert small.client.post("/v1/relax", json=CABLE, timeout=HANG).status_code == 200
    finally:
        small.end()


def test_a_full_service_says_so_before_it_reads(alone: Served) -> None:
    with ExitStack() as clients:
        for _ in range(3):
            clients.enter_context(asked(alone, endless(NEVER)))
        wait_for(lambda: alone.health()["requests"]["taken"] == 3)
        assert alone.health()["status"] == "full"
        refused = alone.client.post("/v1/relax", json=CABLE)
        problem(refused, 503, "busy")
        assert int(refused.headers["retry-after"]) >= 1
        problem(alone.client.post("/v1/relax/3dm", files={"file": b"x" * 10**7}), 503, "busy")
        assert alone.health()["status"] == "full"
    wait_for(lambda: alone.health()["status"] == "ok")


def test_a_body_that_does_not_come(strict: Served) -> None:
    head = f"POST /v1/relax HTTP/1.1\r\nHost: 127.0.0.1:{strict.port}\r\n{strict.head}"
    head += "Content-Type: application/json\r\nContent-Length: 100\r\n\r\n{"
    with socket.create_connection(("127.0.0.1", strict.port), timeout=HANG) as sock:
        sock.sendall(head.encode())
        assert sock.recv(65536).startswith(b"HTTP/1.1 408")
    wait_for(lambda: strict.health()["requests"]["taken"] == 0)


def test_a_client_that_leaves_in_the_middle_of_its_body(alone: Served) -> None:
    head = f"POST /v1/relax HTTP/1.1\r\nHost: 127.0.0.1:{alone.port}\r\n{alone.head}"
    head += "Content-Type: application/json\r\nContent-Length: 100\r\n\r\n{"
    with socket.create_connection(("127.0.0.1", alone.port), timeout=HANG) as sock:
        sock.sendall(head.encode())
        wait_for(lambda: alone.health()["requests"]["taken"] == 1)
    wait_for(lambda: alone.health()["requests"]["taken"] == 0)
    assert alone.client.post("/v1/relax", json=CABLE).status_code == 200


def test_a_connection_is_kept_longer_than_clients_keep_it(served: Served) -> None:
    """httpx gives one up after 5 s without a request. A server that did so at the same moment would end connections
    just as requests go down them, which then come to nothing."""
    connection = http.client.HTTPConnection("127.0.0.1", served.port, timeout=HANG)
    for pause in (6.0, 0.0):
        connection.request("GET", "/v1/health", headers={"Connection": "keep-alive"})
        assert connection.getresponse().read()
        time.sleep(pause)
    connection.close()


@pytest.mark.slow
@pytest.mark.thinned
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
    """It ends by itself: nothing cuts it short here."""
    served = Served(PATIENT, fresh=what == "starting", workers=2)
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
    code, said = served.end(number)
    if what == "reading":
        sock.close()
    assert code == 0, (code, said)
    assert "Traceback" not in said and "rror" not in said, said
    wait_for(lambda: not any(living(p.pid) for p in family))
    if running is not None:
        problem(running.result(timeout=HANG), 503, "shutting-down")


def ended(process: psutil.Process) -> bool:
    """Whether a process has ended with all of its threads, which share its pipes."""
    try:
        return not living(process.pid) and process.num_threads() <= 1
    except psutil.NoSuchProcess:
        return True


def started() -> tuple[subprocess.Popen[str], str]:
    """`python -m hookean_server 0` in a group of its own, whose end nothing cuts short; and where it serves."""
    code = f"{PATIENT} import runpy, sys; sys.argv = ['', '0']; runpy.run_module('hookean_server', run_name='__main__')"
    process = subprocess.Popen(
        [sys.executable, "-c", code],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    assert process.stdout is not None
    return process, process.stdout.readline().split()[3]


def test_no_worker_outlives_a_server_that_is_killed() -> None:
    served = Served(workers=2).ready()
    running = post_later(served, endless())
    busy(served)
    family = served.family()
    assert family
    served.end(signal.SIGKILL)
    wait_for(lambda: not any(living(p.pid) for p in family))
    with pytest.raises(httpx.HTTPError):
        running.result(timeout=HANG)


@pytest.mark.skipif(sys.platform == "win32", reason="processes of POSIX")
def test_what_a_killed_server_leaves_is_taken_away_at_the_next_start(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of its temporary files too; a server that ends by itself leaves nothing."""
    with tempfile.TemporaryDirectory() as folder:
        monkeypatch.setenv("TMPDIR", folder)
        first = Served(workers=1).ready()
        family = first.family()
        first.end(signal.SIGKILL)
        wait_for(lambda: not any(living(p.pid) for p in family))
        killed = set(os.listdir(folder))
        assert killed and all(name.startswith("hookean-") for name in killed)
        second = Served(workers=1).ready()
        assert not killed & set(os.listdir(folder))
        second.end()
        assert not os.listdir(folder)


@pytest.mark.skipif(sys.platform == "win32", reason="processes of POSIX")
def test_a_server_starts_with_a_deep_temporary_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The path of a socket has at most 103 bytes."""
    (tmp_path / ("deep" * 30)).mkdir()
    monkeypatch.setenv("TMPDIR", str(tmp_path / ("deep" * 30)))
    served = Served(workers=1).ready()
    assert served.end() == (0, "")


def test_ctrl_c_reaches_the_whole_group() -> None:
    """In a terminal every process of the group gets the signal; workers leave the decision to the server."""
    process, url = started()
    wait_for(lambda: httpx.get(f"{url}/v1/health", timeout=HANG).json()["workers"]["idle"] > 0)
    os.killpg(process.pid, signal.SIGINT)
    _, said = process.communicate(timeout=HANG)
    assert process.returncode == 0 and said == ""


@pytest.mark.soak
@pytest.mark.parametrize(
    "seconds", [0.15, *(pytest.param(late, marks=pytest.mark.soak) for late in (0.0, 0.05, 0.3, 1.0))]
)
def test_ctrl_c_soon_after_the_start(seconds: float) -> None:
    """While the fork server starts and warms up too: nothing said, exit code 0, no process left."""
    process, _ = started()
    time.sleep(seconds)  # whatever it does by then
    family = psutil.Process(process.pid).children(recursive=True)
    os.killpg(process.pid, signal.SIGINT)
    _, said = process.communicate(timeout=HANG)
    assert process.returncode == 0 and said == ""
    wait_for(lambda: not any(living(p.pid) for p in family))


def test_it_says_where_it_is_and_what_to_try(served: Served) -> None:
    assert served.said.startswith(f"hookean serves at {served.url}")
    line = served.process.stdout.readline()  # type: ignore[union-attr]
    assert served.token not in line
    known = {**os.environ, "HOOKEAN_TOKEN": served.token}
    done = subprocess.run(line, shell=True, capture_output=True, text=True, timeout=HANG, env=known)
    assert '"status": "converged"' in done.stdout, (line, done.stderr)


def test_a_taken_port_is_named_with_its_owner(served: Served) -> None:
    done = forking.run(MODULE, str(served.port))
    assert done.returncode == 2 and done.stdout == ""
    assert done.stderr.count("\n") == 1
    assert f"Port {served.port} is in use" in done.stderr and f"(process {served.process.pid})" in done.stderr


def test_the_owner_of_a_port_without_psutil(monkeypatch: pytest.MonkeyPatch) -> None:
    with socket.create_server(("127.0.0.1", 0)) as sock:
        port = sock.getsockname()[1]
        assert f"(process {os.getpid()})" in owner(port)
        monkeypatch.setitem(sys.modules, "psutil", None)
        if sys.platform == "linux":
            assert f"(process {os.getpid()})" in owner(port)
    assert owner(port) == ""


def test_a_port_that_is_none() -> None:
    done = forking.run(MODULE, "99999")
    assert done.returncode == 2 and "Traceback" not in done.stderr
