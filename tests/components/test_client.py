"""The client against real servers: found, started once, every method, frames, and what happens when a server dies."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from http.server import BaseHTTPRequestHandler, HTTPServer
from pathlib import Path
from typing import Any

import psutil
import pytest

import hookean_client
from hookean_client import Problem, buffer, connect, finding, transport
from hookean_client.client import Client
from serving import CABLE, HANG, SOAK, SWING, Home, living, wait_for

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")


CLIENTS: list[Client] = []


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Home]:
    found = Home(tmp_path / "state")
    monkeypatch.delenv("HOOKEAN_TOKEN", raising=False)
    monkeypatch.delenv("HOOKEAN_PYTHON", raising=False)
    yield found
    for client in CLIENTS:
        client.close()
    CLIENTS.clear()
    found.end()
    for child in finding._children.values():
        child.wait(HANG)
    finding._children.clear()


@pytest.fixture(scope="module")
def client(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Client]:
    """A client of a server that runs, which it may not start."""
    home = Home(tmp_path_factory.mktemp("client") / "state")
    home.serve()
    found = connect(start=False, folder=str(home.folder))
    yield found
    found.close()
    home.end()


def started(home: Home) -> Client:
    CLIENTS.append(connect(folder=str(home.folder), python=sys.executable, timeout=HANG))
    return CLIENTS[-1]


def beside(home: Home) -> Client:
    """The same of a server that runs already."""
    home.serve()
    return started(home)


# methods


def test_relaxing_and_arrays(client: Client) -> None:
    result = client.relax(CABLE, timeout=HANG)  # kernels may have to be compiled first
    assert result["status"] == "converged"
    springs, load = CABLE["forces"]
    scene = {
        **CABLE,
        "particles": buffer(CABLE["particles"]),
        "forces": [{**springs, "particles": buffer(springs["particles"], "q")}, load],
    }
    assert scene["particles"]["shape"] == [6, 3]
    assert client.relax(scene, query={"arrays": "list"}, timeout=HANG)["particles"] == result["particles"]


def test_a_connection_counts_as_idle_since_its_last_request(client: Client, monkeypatch: pytest.MonkeyPatch) -> None:
    """The service ends idle ones after 16 s. A process that gets no processor for so long sees its answer late, and
    must not send a request that cannot be repeated down a connection that has ended meanwhile."""
    real, now, late = transport.read, transport.now, [0.0]

    def slow(answer: Any, most: int) -> Any:
        found = real(answer, most)
        late[0] += 20.0
        return found

    monkeypatch.setattr(transport, "now", lambda: now() + late[0])
    client.get("/v1/health")
    first = client._idle[-1][2]
    monkeypatch.setattr(transport, "read", slow)
    client.get("/v1/health")
    assert client._idle[-1][2] is first
    client.get("/v1/health")
    assert client._idle[-1][2] is not first


def test_every_method_of_a_session(client: Client) -> None:
    session = client.session("a document:component ~1".replace(" ", "_"))
    assert session.put(CABLE, query={"label": "Cable"})["revision"] == 0
    assert session.read()["label"] == "Cable"
    assert session.edit({"forces": {"1": {"vector": [0, 0, -30]}}, "gesture": "drag"})["revision"] == 1
    seen = {"if-match": session.read()["etag"]}
    assert session.edit({"pin": [{"particles": [2]}]}, headers=seen)["revision"] == 2
    with pytest.raises(Problem) as stale:
        session.edit({"release": [2]}, headers=seen)
    assert (stale.value.slug, stale.value.status) == ("stale-revision", 412)
    assert session.undo()["redo"] == 1 and session.redo()["redo"] == 0
    assert session.step(frames=2)["iteration"] > 0
    assert session.play(fast="true")["key"] == session.key
    assert session.pause()["playing"] is False
    assert session.reset()["iteration"] == 0
    assert len(session.state()["particles"]) == 6
    assert b"3D Geometry File Format" in session.state("3dm")[:64]
    assert session.state("obj").startswith(b"#") or b"v " in session.state("obj")
    assert session.read("topology")["springs"][0] == [0, 1]
    assert [a["particles"] for a in session.read("anchors")["anchors"]] == [[0, 5], [2]]
    assert session.read("scene")["forces"][1]["vector"] == [0, 0, -30]
    other = client.session(session.branches(to="other")["key"])
    assert {s["key"] for s in client.get("/v1/sessions")["sessions"]} >= {session.key, "other"}
    assert other.delete() is None and session.delete() is None
    with pytest.raises(Problem) as gone:
        session.read()
    assert (gone.value.slug, gone.value.status) == ("not-found", 404)


def test_a_problem_points_and_says(client: Client) -> None:
    with pytest.raises(Problem) as found:
        client.relax({"particles": [[0, 0, "x"]]})
    problem = found.value
    assert (problem.slug, problem.status) == ("invalid-scene", 422)
    [(pointer, sentence)] = problem.errors
    assert pointer.startswith("/particles") and sentence and sentence in str(problem)


def test_what_it_waits_for_ends_with_its_timeout(client: Client) -> None:
    count = 20_000  # far more than is solved in the time
    springs = {"kind": "springs", "particles": [[i, i + 1] for i in range(count - 1)], "damping": 0}
    scene = {
        "particles": [[float(i), 0.0, 0.0] for i in range(count)],
        "forces": [springs, {"kind": "self_weight", "total": 20.0 * count}],
        "anchors": [{"particles": [0, count - 1]}],
        "settings": {**SWING["settings"], "time_limit": 60.0},
    }
    with pytest.raises(Problem) as found:
        client.relax(scene, timeout=0.3)
    assert (found.value.slug, found.value.status) == ("lost", 0)
    assert client.get("/v1/health")["service"] == "hookean"


def test_frames_show_each_edit(client: Client) -> None:
    session = client.session("frames")
    session.put(SWING)
    frames = session.frames()
    try:
        session.play()
        first = frames.wait(lambda frame: frame["playing"], timeout=HANG)
        assert first is not None and len(first["particles"]) == 18 and len(first["scalars"]) == 5
        assert first["status"] == "running"
        for i in range(10):
            revision = session.edit({"forces": {"1": {"vector": [0, 0, -20.0 - i]}}})["revision"]
            shown = frames.wait(lambda frame, revision=revision: frame["revision"] >= revision, timeout=HANG)
            assert shown is not None
        assert frames.latest()["number"] >= shown["number"] > first["number"]
        session.pause()
        wait_for(lambda: frames.session.get("playing") is False)
        state = session.state()
        last = frames.wait(lambda frame: not frame["playing"], timeout=HANG)
        assert last["particles"] == pytest.approx([x for row in state["particles"] for x in row], abs=1e-5)
        assert frames.topology and frames.lost == [] and frames.message == ""
        before = frames.topology
        session.put({**CABLE, "particles": [*CABLE["particles"], [1, 1, 1]]})
        wait_for(lambda: frames.topology != before)
    finally:
        frames.close()
    session.delete()


def test_frames_of_no_session_end_with_a_sentence(client: Client) -> None:
    frames = client.session("nobody").frames()
    wait_for(lambda: frames.ended)
    assert "no session with this key" in frames.message and frames.latest() is None
    assert frames.wait(timeout=5.0) is None


def test_frames_end_when_the_session_is_forgotten(client: Client) -> None:
    session = client.session("forgotten")
    session.put(CABLE)
    frames = session.frames()
    assert frames.wait(timeout=HANG) is not None
    session.delete()
    wait_for(lambda: frames.ended)


def test_threads_share_a_client(client: Client) -> None:
    found: list[str] = []

    def solve() -> None:
        found.extend(client.relax(CABLE)["status"] for _ in range(5))

    threads = [threading.Thread(target=solve) for _ in range(6)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == ["converged"] * 30


# found and started

RACER = """
import sys
sys.path.insert(0, sys.argv[1])
import hookean_client
client = hookean_client.connect(folder=sys.argv[2], python=sys.argv[3], timeout=240.0, parent=int(sys.argv[4]))
print(client.instance)
sys.stdout.flush()
"""


@pytest.mark.parametrize("times", [50 if SOAK else 1])
def test_eight_that_race_get_one_server(home: Home, times: int) -> None:
    components = str(Path(hookean_client.__file__).parents[1])
    for _ in range(times):
        words = [components, str(home.folder), sys.executable, str(os.getpid())]
        racers = [
            subprocess.Popen([sys.executable, "-S", "-c", RACER, *words], stdout=subprocess.PIPE, text=True)
            for _ in range(8)
        ]
        said = [racer.communicate(timeout=HANG)[0].strip() for racer in racers]
        assert [racer.returncode for racer in racers] == [0] * 8
        assert set(said) == {home.told["instance"]}
        assert home.serving() == [home.told["pid"]]
        assert home.command("serve", "--stop").returncode == 0
        assert not home.told and home.serving() == []


@pytest.mark.soak
def test_threads_that_race_get_one_server(home: Home, tmp_path: Path) -> None:
    """What is open here is not kept open there."""
    found: list[str] = []
    with (tmp_path / "model.3dm").open("w") as file:
        os.set_inheritable(file.fileno(), True)
        threads = [threading.Thread(target=lambda: found.append(started(home).instance)) for _ in range(8)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        family = [psutil.Process(home.told["pid"]), *psutil.Process(home.told["pid"]).children(recursive=True)]
        assert not any("model.3dm" in opened.path for process in family for opened in process.open_files())
    assert found == [home.told["instance"]] * 8
    assert home.serving() == [home.told["pid"]]


def test_it_ends_with_the_process_that_asked(home: Home) -> None:
    components = str(Path(hookean_client.__file__).parents[1])
    code = RACER.replace(", parent=int(sys.argv[4])", "") + "sys.stdin.readline()\n"
    pipes: Any = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
    words = [components, str(home.folder), sys.executable]
    with subprocess.Popen([sys.executable, "-c", code, *words], **pipes) as parent:
        assert parent.stdout is not None and parent.stdout.readline()
        pid = home.told["pid"]
        parent.kill()
    wait_for(lambda: not living(pid))
    assert not home.told and (home.folder / "sessions.db").exists()


def test_none_is_started_where_none_is_wanted(home: Home) -> None:
    with pytest.raises(Problem) as found:
        connect(start=False, folder=str(home.folder))
    assert found.value.slug == "no-server" and "hookean serve" in str(found.value)
    assert not home.folder.exists()


def test_which_python_starts_it(home: Home, monkeypatch: pytest.MonkeyPatch) -> None:
    """The argument, else HOOKEAN_PYTHON, else what was recorded; a sentence where it is not known or does not do."""
    folder = str(home.folder)
    with pytest.raises(Problem) as found:
        connect(folder=folder)
    assert found.value.slug == "no-python" and "HOOKEAN_PYTHON" in str(found.value)
    home.folder.mkdir(mode=0o700)
    (home.folder / "python.json").write_text(json.dumps({"python": str(home.folder / "recorded")}))
    with pytest.raises(Problem, match=r"recorded cannot be started") as found:
        connect(folder=folder)
    monkeypatch.setenv("HOOKEAN_PYTHON", str(home.folder / "named"))
    with pytest.raises(Problem, match=r"named cannot be started") as found:
        connect(folder=folder)
    wrong = home.folder / "wrong"
    wrong.write_text("#!/bin/sh\necho No module named hookean >&2\nexit 1\n")
    wrong.chmod(0o700)
    with pytest.raises(Problem, match=r"did not start: No module named hookean") as found:
        connect(folder=folder, python=str(wrong))
    assert found.value.slug == "not-started" and not (home.folder / "starting").exists()


@pytest.mark.soak
def test_the_first_serve_tells_the_client_which_python(home: Home) -> None:
    process = home.serve()
    process.terminate()
    process.communicate(timeout=HANG)
    CLIENTS.append(connect(folder=str(home.folder), timeout=HANG))
    assert CLIENTS[-1].instance == home.told["instance"]


@pytest.mark.soak
def test_a_start_that_died_is_begun_again(home: Home, monkeypatch: pytest.MonkeyPatch) -> None:
    """It goes on where nobody waits for it."""
    home.folder.mkdir(mode=0o700)
    lock = home.folder / "starting"
    lock.write_text("")
    with pytest.raises(Problem) as found:
        connect(folder=str(home.folder), python=sys.executable, timeout=0.1)
    assert found.value.slug == "starting" and lock.exists(), "somebody else is at it"
    os.utime(lock, (1, 1))
    with pytest.raises(Problem) as found:
        connect(folder=str(home.folder), python=sys.executable, timeout=0.0)
    assert found.value.slug == "starting"
    wait_for(lambda: home.told)
    monkeypatch.setattr(transport, "ANSWER", HANG)  # it has just started, and may be slow
    client = connect(folder=str(home.folder), start=False)
    assert client.instance == home.told["instance"]
    assert not lock.exists()


# strangers and versions


def test_a_stranger_is_told_nothing(home: Home) -> None:
    heard: list[Any] = []

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            heard.append((self.command, self.path, dict(self.headers)))
            self.send_response(200)
            self.send_header("content-length", "22")
            self.end_headers()
            self.wfile.write(b'{"instance": "0000000"}'[:22])

        do_POST = do_PUT = do_GET

        def log_message(self, *_: Any) -> None:
            pass

    client = beside(home)
    home.kill()
    with HTTPServer(("127.0.0.1", 0), Handler) as server:  # as if it had the port of the server that died
        threading.Thread(target=server.serve_forever, daemon=True).start()
        client.close()
        client.url, client._start = f"http://127.0.0.1:{server.server_port}", False
        told = {**home.told, "pid": os.getpid(), "port": server.server_port, "url": client.url}
        (home.folder / "server.json").write_text(json.dumps(told))
        with pytest.raises(Problem) as found:
            client.post("/v1/relax", CABLE)
        server.shutdown()
    assert found.value.slug == "no-server"
    assert heard and {(method, path.split("=")[0]) for method, path, _ in heard} == {("GET", "/v1/proof?nonce")}
    assert client.token not in str(heard) and client.proof not in str(heard)


def test_a_renewed_token_is_taken_up(home: Home) -> None:
    """`hookean token --renew` logs programs out, too; those of the same user read the file again and go on: requests
    of every kind, and frames."""
    client = beside(home)
    session = client.session("a")
    session.put(CABLE)
    frames = session.frames()
    assert frames.wait(timeout=HANG) is not None
    before, received = client.token, frames.received
    for ask in (lambda: session.read(), lambda: session.step(), lambda: client.relax(CABLE)):
        assert home.command("token", "--renew").returncode == 0
        assert ask() is not None and client.token == home.told["token"] != before
        before = client.token
    wait_for(lambda: frames.received > received and not frames.message)
    frames.close()


def test_a_token_that_is_wrong_for_good_is_a_problem(home: Home) -> None:
    client = beside(home)
    file = home.folder / "server.json"
    file.write_text(json.dumps({**home.told, "token": "another-token-than-the-servers"}))
    client.token = "a-third-token"
    with pytest.raises(Problem) as found:
        client.get("/v1/sessions")
    assert (found.value.slug, found.value.status) == ("unauthorized", 401)


def test_a_server_of_other_frames_is_refused_with_a_sentence(home: Home) -> None:
    home.serve()
    file = home.folder / "server.json"
    file.write_text(json.dumps({**home.told, "wire": 2}))
    with pytest.raises(Problem) as found:
        connect(folder=str(home.folder), start=False)
    assert found.value.slug == "wrong-version" and "--stop" in str(found.value)


@pytest.mark.parametrize("text", ["", "{", "[]", "null", '{"pid": 1}', '{"pid": "x"}', '{"pid": -1, "url": 3}'])
def test_a_file_that_is_none(home: Home, text: str) -> None:
    home.folder.mkdir(mode=0o700)
    (home.folder / "server.json").write_text(text)
    with pytest.raises(Problem) as found:
        connect(folder=str(home.folder), start=False)
    assert found.value.slug == "no-server"


def test_both_sides_mean_the_same_folder(monkeypatch: pytest.MonkeyPatch) -> None:
    from hookean_server.lifecycle import discovery

    for name, value in (("XDG_STATE_HOME", "/anywhere/x"), ("HOOKEAN_STATE", "/anywhere/y"), ("HOOKEAN_STATE", "")):
        monkeypatch.setenv(name, value)
        assert hookean_client.state_folder() == str(discovery.folder())
    monkeypatch.delenv("XDG_STATE_HOME")
    assert hookean_client.state_folder() == str(discovery.folder())


# servers that die


def test_a_server_killed_under_a_client_is_started_again(home: Home) -> None:
    """Requests start it, frames come back by themselves and say what was lost; sessions have kept every edit."""
    client = beside(home)
    session = client.session("a")
    session.put(SWING)
    revision = session.edit({"pin": [{"particles": [2]}]})["revision"]
    frames = session.frames()
    session.play()
    assert frames.wait(lambda frame: frame["revision"] == revision, timeout=HANG) is not None
    before = client.instance
    home.kill()
    wait_for(lambda: frames.message)
    assert not frames.ended and frames.lost == []
    found = session.read()
    assert found["revision"] == revision and found["playing"] is False
    assert client.instance == home.told["instance"] != before
    wait_for(lambda: frames.lost)
    assert "revision" in frames.lost[0] and frames.message == ""
    session.play()
    number = frames.received
    wait_for(lambda: frames.received > number + 3)
    frames.close()


def test_frames_start_no_server(home: Home) -> None:
    client = beside(home)
    client.session("a").put(CABLE)
    frames = client.session("a").frames()
    assert frames.wait(timeout=HANG) is not None
    client.post("/v1/shutdown")
    wait_for(lambda: not home.told)
    wait_for(lambda: "No hookean server is running" in frames.message)
    assert not home.told and not frames.ended
    frames.close()


def test_an_edit_that_may_have_been_made_is_not_made_twice(home: Home) -> None:
    client = beside(home)
    session = client.session("a")
    session.put(CABLE)
    [pid] = home.serving()
    os.kill(pid, signal.SIGSTOP)
    with pytest.raises(Problem) as found:
        session.edit({"pin": [{"particles": [2]}]}, timeout=0.5)
    assert found.value.slug in ("lost", "no-answer", "starting")
    os.kill(pid, signal.SIGCONT)
    wait_for(lambda: session.read()["revision"] <= 1)
