"""It ends: when told to, at signals, with sockets open and work running, and whatever hangs. Exit code 0."""

from __future__ import annotations

import asyncio
import json
import os
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import httpx
import psutil
import pytest
import websockets

from hookean_server.lifecycle.ending import LONGEST
from serving import CABLE, HANG, SWING, Home, living, wait_for

from .conftest import PATIENT, endless, problem

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")


@pytest.fixture
def home(tmp_path: Path) -> Iterator[Home]:
    found = Home(tmp_path / "state")
    yield found
    found.end()


def client(home: Home) -> httpx.Client:
    known = {"authorization": f"Bearer {home.told['token']}"}
    return httpx.Client(base_url=home.told["url"], headers=known, timeout=HANG)


def family(pid: int) -> list[int]:
    return [p.pid for p in psutil.Process(pid).children(recursive=True)]


def suspended(home: Home, pid: int) -> list[int]:
    """All processes of a server, which now has a session whose own process is suspended."""
    with client(home) as asks:
        wait_for(lambda: not asks.get("/v1/health").json()["workers"]["starting"])
        before = set(family(pid))
        asks.put("/v1/sessions/a", json=CABLE).raise_for_status()
    [session] = set(family(pid)) - before
    os.kill(session, signal.SIGSTOP)
    return [*before, session]


class Watcher(threading.Thread):
    """A client that watches a session until its socket is closed; `code` tells how."""

    def __init__(self, home: Home, key: str) -> None:
        super().__init__(daemon=True)
        self.url = f"{home.told['url'].replace('http', 'ws')}/v1/sessions/{key}/frames"
        self.known = {"authorization": f"Bearer {home.told['token']}"}
        self.frames, self.code = 0, 0

    def run(self) -> None:
        asyncio.run(self._watch())

    async def _watch(self) -> None:
        async with websockets.connect(self.url, additional_headers=self.known) as socket:
            try:
                while True:
                    message = await socket.recv()
                    if isinstance(message, bytes):
                        self.frames += 1
                        await socket.send(json.dumps({"ack": int.from_bytes(message[12:16], "little")}))
            except websockets.ConnectionClosed as error:
                self.code = error.rcvd.code if error.rcvd else -1


def test_with_nothing_to_stop(home: Home) -> None:
    for _ in range(2):  # before there is a folder, and after
        done = home.command("serve", "--stop")
        assert (done.returncode, done.stdout, done.stderr) == (0, "No hookean server is running.\n", "")


def test_told_to_stop_with_sockets_open_and_work_running(home: Home) -> None:
    """A solve, a session that plays and is watched, one socket that says nothing: all end; what was edited is kept."""
    process = home.serve()
    url = home.told["url"]
    with client(home) as asks:
        asks.put("/v1/sessions/a", json=SWING).raise_for_status()
        revision = asks.patch("/v1/sessions/a", json={"pin": [{"particles": [2]}]}).json()["revision"]
        asks.post("/v1/sessions/a/play").raise_for_status()
        watcher, answers = Watcher(home, "a"), []  # type: Watcher, list[httpx.Response]
        watcher.start()

        def solve() -> None:
            with client(home) as other:
                answers.append(other.post("/v1/relax", json=endless()))

        solving = threading.Thread(target=solve, daemon=True)
        solving.start()
        wait_for(lambda: watcher.frames > 3 and asks.get("/v1/health").json()["workers"]["busy"])
        pids = family(process.pid)
        done = home.command("serve", "--stop")
    assert (done.returncode, done.stderr) == (0, "") and url in done.stdout and "are saved" in done.stdout
    _, said = process.communicate(timeout=HANG)
    assert process.returncode == 0 and "Traceback" not in said, said
    solving.join(HANG)
    watcher.join(HANG)
    problem(answers[0], 503, "shutting-down")
    assert watcher.code == 1012
    wait_for(lambda: not any(living(pid) for pid in pids))
    assert not home.told
    home.serve()
    with client(home) as asks:
        session = asks.get("/v1/sessions/a").json()
    assert session["revision"] == revision and session["playing"] is False and session["iteration"] > 0


def test_a_stop_needs_the_token(home: Home) -> None:
    process = home.serve()
    url = f"{home.told['url']}/v1/shutdown"
    problem(httpx.post(url, timeout=HANG), 401, "unauthorized")
    problem(httpx.post(url, headers={"authorization": "Bearer " + "x" * 43}, timeout=HANG), 401, "unauthorized")
    assert process.poll() is None
    with client(home) as asks:
        told = asks.post("/v1/shutdown")
    assert told.status_code == 202 and told.json() == {"status": "stopping"}
    assert process.wait(HANG) == 0


@pytest.mark.slow
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT, signal.SIGHUP])
def test_a_session_that_hangs_holds_up_nothing(home: Home, number: int) -> None:
    """Its process is suspended; it is killed with the rest, and the exit code is 0."""
    process = home.serve()
    pids = suspended(home, process.pid)
    process.send_signal(number)
    process.communicate(timeout=HANG)
    assert process.returncode == 0
    wait_for(lambda: not any(living(pid) for pid in pids))
    assert not home.told


def hanging(home: Home, first: str = "") -> subprocess.Popen[str]:
    """A server whose end hangs, as on a disk that does not answer; `first` is code that it runs before."""
    code = (
        f"{first}\n"
        "import asyncio, sys\n"
        "from hookean_server.lifecycle import command\n"
        "from hookean_server.sessions.manager import Manager\n"
        "async def hangs(self): await asyncio.sleep(3600)\n"
        "Manager.close = hangs\n"
        "sys.exit(command.run(command.Options(port=0)))\n"
    )
    process: subprocess.Popen[str] = home.run(code)
    wait_for(lambda: home.told)
    return process


def test_an_end_that_hangs_is_cut_short(home: Home) -> None:
    """No more than LONGEST, with exit code 0."""
    assert LONGEST < 3.0
    process = hanging(home)
    pids = family(process.pid)
    process.terminate()
    _, said = process.communicate(timeout=HANG)
    assert process.returncode == 0 and "was forced" in said
    wait_for(lambda: not any(living(pid) for pid in pids))
    assert not home.told


def test_the_second_signal_ends_it_now(home: Home) -> None:
    process = hanging(home, PATIENT)  # so nothing else ends it
    pids = family(process.pid)
    process.send_signal(signal.SIGINT)
    wait_for(lambda: not httpx_answers(home))
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=HANG)
    assert process.returncode == 130
    wait_for(lambda: not any(living(pid) for pid in pids))
    assert not home.told


def httpx_answers(home: Home) -> bool:
    try:
        return httpx.get(f"{home.told['url']}/v1/health", timeout=HANG).status_code == 200
    except (httpx.HTTPError, KeyError):
        return False


def test_one_that_hangs_is_not_said_to_have_ended(home: Home) -> None:
    process = home.serve()
    process.send_signal(signal.SIGSTOP)
    done = home.command("serve", "--stop")
    assert done.returncode == 1 and done.stdout == "" and "does not answer" in done.stderr
    process.send_signal(signal.SIGCONT)
    assert home.command("serve", "--stop").returncode == 0
    assert process.wait(HANG) == 0
