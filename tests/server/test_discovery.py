"""Found by clients: one server for each user, its file, who is trusted, with whom it ends."""

from __future__ import annotations

import asyncio
import json
import os
import signal
import socket
import subprocess
import sys
import threading
from collections.abc import Iterator
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import httpx
import psutil
import pytest

import forking
from hookean_server.app import create_app
from hookean_server.lifecycle import discovery, ending
from hookean_server.lifecycle.discovery import Found, Held, Lock, find
from hookean_server.lifecycle.ending import Activity
from hookean_server.settings import Settings
from serving import CABLE, HANG, SOAK, Home, living, wait_for

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")


@pytest.fixture
def home(tmp_path: Path) -> Iterator[Home]:
    found = Home(tmp_path / "state")
    yield found
    found.end()


@pytest.fixture(scope="module")
def stranger() -> Iterator[tuple[int, list[dict[str, str]]]]:
    """A program of somebody else: it answers every question like a server of ours, as far as it knows, and notes what
    it is sent."""
    heard: list[dict[str, str]] = []

    class Handler(BaseHTTPRequestHandler):
        protocol_version = "HTTP/1.1"

        def do_GET(self) -> None:
            heard.append({k.lower(): v for k, v in self.headers.items()})
            body = json.dumps({"service": "hookean", "instance": "a" * 32, "proof": "0" * 64}).encode()
            self.send_response(200)
            self.send_header("content-type", "application/json")
            self.send_header("content-length", str(len(body)))
            self.end_headers()
            self.wfile.write(body)

        do_POST = do_PUT = do_GET

        def log_message(self, *_: Any) -> None:
            pass

    server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    server.daemon_threads = True
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield server.server_port, heard
    server.shutdown()
    server.server_close()


def told(pid: int, port: int) -> Found:
    return Found(pid, port, f"http://127.0.0.1:{port}", "t" * 43, "0.1.0", "a" * 32, 0.0, "b" * 64)


def test_the_file_is_for_this_user_alone_and_true(home: Home) -> None:
    process = home.serve()
    file = home.folder / "server.json"
    assert file.stat().st_mode & 0o777 == 0o600 and home.folder.stat().st_mode & 0o777 == 0o700
    found = find(home.folder)
    assert found is not None and found.pid == process.pid and found.keeps
    assert httpx.get(f"{found.url}/v1/health", timeout=HANG).json()["instance"] == found.instance
    known = {"authorization": f"Bearer {found.token}"}
    assert httpx.get(f"{found.url}/v1/sessions", headers=known, timeout=HANG).status_code == 200
    assert home.command("token").stdout.strip() == found.token
    assert (home.folder / "sessions.db").stat().st_mode & 0o777 == 0o600
    process.send_signal(signal.SIGTERM)
    out, said = process.communicate(timeout=HANG)
    assert process.returncode == 0 and not file.exists()
    assert found.token not in out + said
    assert find(home.folder) is None and home.command("token").returncode == 1


def test_a_second_one_joins_the_first(home: Home) -> None:
    process = home.serve()
    url, before = home.told["url"], home.told
    for options in ((), ("--port", "0"), ("--port", str(home.told["port"])), ("--any-port",)):
        joined = home.command("serve", *options)
        assert joined.returncode == 0 and f"is already running at {url} (process {process.pid})" in joined.stdout
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    refused = home.command("serve", "--port", str(port))
    assert refused.returncode == 2 and url in refused.stderr and "--no-keep" in refused.stderr
    second = home.start("--port", str(port), "--no-keep")
    assert second.stdout is not None and f":{port} " in second.stdout.readline()
    assert home.told == before, "the second one is not told of"
    second.terminate()
    second.communicate(timeout=HANG)
    assert second.returncode == 0 and home.told == before


@pytest.mark.parametrize("count", [50] if SOAK else [5])
def test_of_many_that_start_at_once_one_serves(home: Home, count: int) -> None:
    for _ in range(count // 5):
        processes = [home.start("--port", "0") for _ in range(5)]
        wait_for(lambda: sum(p.poll() is None for p in processes) == 1 and home.told)  # noqa: B023
        [left] = [p for p in processes if p.poll() is None]
        assert home.told["pid"] == left.pid
        for process in processes:
            if process is not left:
                assert process.returncode == 0
                assert "is already running" in process.communicate()[0]
        left.terminate()
        assert left.wait(HANG) == 0


def test_a_file_left_behind_is_replaced_and_the_sessions_are_kept(home: Home) -> None:
    process = home.serve()
    known = {"authorization": f"Bearer {home.told['token']}"}
    assert httpx.put(f"{home.told['url']}/v1/sessions/a", json=CABLE, headers=known, timeout=HANG).status_code == 201
    before = home.told
    home.kill()
    process.communicate()
    assert home.told == before and find(home.folder) is None
    home.serve()
    assert home.told["instance"] != before["instance"] and home.told["token"] != before["token"]
    known = {"authorization": f"Bearer {home.told['token']}"}
    [session] = httpx.get(f"{home.told['url']}/v1/sessions", headers=known, timeout=HANG).json()["sessions"]
    assert session["key"] == "a" and session["playing"] is False


def test_a_process_of_the_same_number_is_no_server(tmp_path: Path) -> None:
    with socket.socket() as closed:
        closed.bind(("127.0.0.1", 0))  # nobody listens
        told(os.getpid(), closed.getsockname()[1]).write(tmp_path)
        assert find(tmp_path) is None


def test_a_stranger_on_the_port_is_told_nothing(tmp_path: Path, stranger: tuple[int, list[dict[str, str]]]) -> None:
    port, heard = stranger
    told(os.getpid(), port).write(tmp_path)
    heard.clear()
    assert find(tmp_path) is None
    assert len(heard) == 1 and "authorization" not in heard[0]
    home = Home(tmp_path)
    assert home.command("serve", "--stop").returncode == 0
    assert home.command("token").returncode == 1
    assert not any("authorization" in headers or "t" * 43 in str(headers) for headers in heard)


@pytest.mark.parametrize("text", ["", "{", "[]", "null", '{"pid": 1}', '{"pid": "x", "port": []}'])
def test_a_file_that_is_none(tmp_path: Path, text: str) -> None:
    (tmp_path / "server.json").write_text(text)
    assert find(tmp_path) is None


def test_a_file_that_others_may_write_is_not_trusted(home: Home) -> None:
    home.serve()
    assert find(home.folder) is not None
    (home.folder / "server.json").chmod(0o666)
    assert find(home.folder) is None
    (home.folder / "server.json").chmod(0o600)


def test_only_its_own_file_is_removed(tmp_path: Path) -> None:
    mine, other = told(1, 1), Found(2, 2, "u", "t", "v", "b" * 32, 0.0, "p")
    other.write(tmp_path)
    mine.remove(tmp_path)
    assert (tmp_path / "server.json").exists()
    other.remove(tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_the_python_that_started_it_first_is_recorded(tmp_path: Path) -> None:
    discovery.record_python(tmp_path)
    file = tmp_path / "python.json"
    assert json.loads(file.read_text()) == {"python": sys.executable}
    assert file.stat().st_mode & 0o777 == 0o600
    file.write_text(json.dumps({"python": "/bin/sh"}))
    discovery.record_python(tmp_path)
    assert json.loads(file.read_text()) == {"python": "/bin/sh"}, "the first one stays"
    file.write_text(json.dumps({"python": str(tmp_path / "gone")}))
    discovery.record_python(tmp_path)
    assert json.loads(file.read_text()) == {"python": sys.executable}, "but not one that is gone"


def test_a_lock_ends_with_its_process(tmp_path: Path) -> None:
    code = (
        "import sys, time; from pathlib import Path; from hookean_server.lifecycle.discovery import Lock;"
        "held = Lock(Path(sys.argv[1])); print('held', flush=True); time.sleep(600)"
    )
    path = tmp_path / "lock"
    with subprocess.Popen([sys.executable, "-c", code, str(path)], stdout=subprocess.PIPE, text=True) as other:
        assert other.stdout is not None and other.stdout.readline() == "held\n"
        with pytest.raises(Held):
            Lock(path)
        other.kill()
    mine = Lock(path)
    with pytest.raises(Held):
        Lock(path)
    mine.release()
    Lock(path).release()


def test_two_servers_do_not_share_one_file_of_sessions(home: Home) -> None:
    home.serve()
    code = (
        "import sys; from hookean_server.lifecycle.main import serve; from hookean_server.settings import Settings;"
        f"sys.exit(serve(port=0, settings=Settings(state={str(home.folder / 'sessions.db')!r})))"
    )
    done = forking.run(code)
    assert done.returncode == 2 and done.stdout == "" and done.stderr.count("\n") == 1
    assert "Another hookean server keeps its sessions in" in done.stderr


def test_a_folder_that_cannot_be(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    done = Home(tmp_path / "file" / "state").command("serve")
    assert done.returncode == 2 and done.stdout == "" and done.stderr.count("\n") == 1
    assert "HOOKEAN_STATE" in done.stderr


def test_what_is_refused_at_the_door_is_no_use(monkeypatch: pytest.MonkeyPatch) -> None:
    """Requests without the token or for another host leave the time without use as it is; one with it begins anew."""
    app = create_app(Settings(token="of-a-test-0123456789"))
    now = 1000.0
    monkeypatch.setattr(ending, "time", SimpleNamespace(monotonic=lambda: now))
    activity = Activity(app)
    now += 100.0

    async def asked(host: str, **headers: str) -> int:
        async with httpx.AsyncClient(transport=httpx.ASGITransport(activity), base_url=f"http://{host}:8765") as client:
            return (await client.get("/v1/forces", headers=headers)).status_code

    assert asyncio.run(asked("127.0.0.1")) == 401
    assert asyncio.run(asked("elsewhere", authorization="Bearer of-a-test-0123456789")) == 403
    assert activity.idle() == 100.0
    assert asyncio.run(asked("127.0.0.1", authorization="Bearer of-a-test-0123456789")) == 200
    assert activity.idle() == 0.0


@pytest.mark.parametrize("collected", [True, False])
def test_it_ends_with_its_parent_and_keeps_its_sessions(home: Home, collected: bool) -> None:
    parent = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(600)"])
    process = home.serve("--parent-pid", str(parent.pid))
    known = {"authorization": f"Bearer {home.told['token']}"}
    url = f"{home.told['url']}/v1/sessions/a"
    assert httpx.put(url, json=CABLE, headers=known, timeout=HANG).status_code == 201
    revision = httpx.patch(url, json={"pin": [{"particles": [2]}]}, headers=known, timeout=HANG).json()["revision"]
    httpx.post(f"{url}/play", params={"fast": "true"}, headers=known, timeout=HANG)
    family = [p.pid for p in psutil.Process(process.pid).children(recursive=True)]
    assert family
    parent.kill()
    if collected:
        parent.wait()
    _, said = process.communicate(timeout=HANG)
    assert process.returncode == 0 and "Traceback" not in said
    parent.wait()
    wait_for(lambda: not any(living(pid) for pid in family))
    home.serve()
    known = {"authorization": f"Bearer {home.told['token']}"}
    session = httpx.get(f"{home.told['url']}/v1/sessions/a", headers=known, timeout=HANG).json()
    assert session["revision"] == revision and session["playing"] is False and session["iteration"] > 0


def test_it_ends_where_its_parent_is_gone_before_it_starts(home: Home) -> None:
    parent = subprocess.Popen([sys.executable, "-c", ""])
    parent.wait()
    process = home.start("--port", "0", "--parent-pid", str(parent.pid))
    process.communicate(timeout=HANG)
    assert process.returncode == 0


def test_it_ends_when_nobody_uses_it(home: Home) -> None:
    process = home.serve("--idle-exit", "0.01")
    process.communicate(timeout=HANG)
    assert process.returncode == 0


def test_what_use_is(monkeypatch: pytest.MonkeyPatch) -> None:
    """Requests and sockets, sessions that play, workers that solve, jobs that are not done; not health and figures, and
    not what is refused at the door."""
    live, states, jobs = SimpleNamespace(playing=False), {"busy": 0}, SimpleNamespace(busy=False)
    app: Any = lambda scope, receive, send: _nothing()  # noqa: E731
    app.state = SimpleNamespace(
        sessions=SimpleNamespace(sessions={"a": live}), pool=SimpleNamespace(states=lambda: states), jobs=jobs
    )
    now = 1000.0  # sums of round numbers are exact
    monkeypatch.setattr(ending, "time", SimpleNamespace(monotonic=lambda: now))
    activity = Activity(app)
    now += 100.0
    assert activity.idle() == 100.0
    asyncio.run(activity({"type": "http", "path": "/v1/health"}, _nothing, _nothing))
    assert activity.idle() == 100.0
    asyncio.run(activity({"type": "http", "path": "/v1/relax"}, _nothing, _nothing))
    assert activity.idle() == 0.0
    now += 50.0
    asyncio.run(activity({"type": "http", "path": "/v1/relax", "refused": True}, _nothing, _nothing))
    assert activity.idle() == 50.0
    live.playing = True
    assert activity.idle() == 0.0
    live.playing = False
    now += 50.0
    states["busy"] = 1
    assert activity.idle() == 0.0
    states["busy"] = 0
    now += 50.0
    assert activity.idle() == 50.0
    jobs.busy = True
    assert activity.idle() == 0.0


async def _nothing(*_: Any) -> Any:
    return None
