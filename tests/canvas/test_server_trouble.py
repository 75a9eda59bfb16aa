"""Whatever happens to the server, every component says one clear sentence soon, holds nothing up, and recovers."""

from __future__ import annotations

import hmac
import json
import re
import socket
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from http.server import BaseHTTPRequestHandler, HTTPServer
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import httpx
import psutil
import pytest

import hookean_client
from canvas.canvasing import Bench, let_go, line, point, sentences
from hookean_canvas.components import bundles
from hookean_canvas.run import stand_in
from hookean_client import canvas, canvas_engine, canvas_geometry, canvas_link, canvas_server, finding
from serving import HANG, SOAK, Home

SOON = 1.0 if SOAK else HANG  # seconds to the sentence; the strict one on a machine with nothing else to do
TABLE = Path(__file__).parents[2] / "gh_examples" / "wind" / "wind.csv"
MODEL = Path(__file__).parents[2] / "gh_examples" / "9.4-cable" / "model.3dm"


@pytest.fixture(scope="module", autouse=True)
def rhino() -> Iterator[None]:
    made = stand_in.Canvas().install()
    yield
    made.remove()


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Home]:
    """A state folder without a server, and without a Python to start one."""
    monkeypatch.setenv("HOOKEAN_STATE", str(tmp_path / "state"))
    monkeypatch.delenv("HOOKEAN_PYTHON", raising=False)
    canvas_link.service.forget()
    found = Home(tmp_path / "state")
    found.folder.mkdir()
    yield found
    let_go()
    canvas_server._looks.clear()
    found.end()
    for child in finding._children.values():  # started by components, perhaps just now
        child.kill()
        child.wait(HANG)
    finding._children.clear()


def samples() -> dict[str, dict[str, Any]]:
    """Inputs for every component that asks the service."""
    mesh = canvas_geometry.to_mesh({"vertices": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], "faces": [[0, 1, 2, 3]]})
    row = [point(0, 0, 0), point(1, 0, 0), point(2, 1, 0)]
    curve = [stand_in.PolylineCurve(row)]
    surface = stand_in.NurbsSurface(3, False, 2, 2, 2, 2)
    for i in range(2):
        for j in range(2):
            surface.Points.SetPoint(i, j, float(i), float(j), 0.0)
    surface.KnotsU, surface.KnotsV = [0.0, 1.0], [0.0, 1.0]
    ghenv, load = Bench().component("Springs"), Bench().component("Load")
    spans = [line((i, 0, 0), (i + 1, 0, 0)) for i in range(8)]
    places = [point(i, 0, 0) for i in range(9)]
    forces = [
        canvas.force(ghenv, "springs", lines=spans, damping=0.0),
        canvas.force(load, "unary", points=places, vector=stand_in.Vector3d(0, 0, -20)),
    ]
    held = {"_forces": forces, "anchors_": [places[0], places[-1]]}
    meshes = ("Diagonals", "MeshCorners", "MeshEdges", "NakedVertices", "WarpWeft", "Refine", "RefineStrips")
    meshes += ("Checkerboard", "Diagonalize", "HingePoints", "VertexNeighbours", "AlignQuads", "TurnQuads", "Strips")
    meshes += ("UnrollStrips",)
    net = {"vertices": [[i, j, 0] for j in range(3) for i in range(3)]}
    net["faces"] = [[i, i + 1, i + 4, i + 3] for i in (0, 1, 3, 4)]  # with inner edges about an inner vertex
    return {
        **{name: {"_mesh": [mesh]} for name in meshes},
        "CombineClean": {"_meshes": [mesh, mesh]},
        "InterconnectPoints": {"_points": row},
        "Bipartite": {"_lines": [line((0, 0, 0), (1, 0, 0))]},
        "MoebiusTransformation": {"_points": row, "_angle": [0.5]},
        "LiveFilm": {"_mesh": [mesh], "_length": [0.5]},
        "Pipes": {"_lines": [line((0, 0, 0), (1, 0, 0))], "_radius": [0.1]},
        "FoldAngle": {"_start": row[:1], "_end": row[1:2], "_tip_1": row[2:], "_tip_2": [point(1, -1, 0)]},
        "MeshMap": {"_point": row, "_source": [mesh], "_target": [mesh]},
        "Remesh": {"_mesh": [mesh], "_length": [0.5]},
        "ReciprocalDiagram": {"_mesh": [canvas_geometry.to_mesh(net)]},
        "RemoveDuplicatePoints": {"_points": row},
        "SplitAtCorners": {"_polyline": curve},
        "Catenary": {"_start": row[:1], "_end": row[2:], "_length": [4.0]},
        "Divide": {"_curve": curve, "_count_": [4]},
        "Engine": {**held, "_reset": False, "settings_": [settings(drag=5.0)]},
        "Interpolate": {"_points": row, "_count_": [5]},
        "Moments": {**held, "_times": [0.1]},
        "Stream": {
            **held,
            "_file": [str(TABLE)],
            "_column": ["speed [m/s]"],
            "_force": ["Load"],
            "_every_": [1.0],
            "_scale": [stand_in.Vector3d(0, 1, 0)],
        },
        "MeshSurface": {"_surface": [surface], "_u_": [3], "_v_": [2]},
        "RemoveDuplicateLines": {"_lines": [spans[0], spans[0]]},
        "RhinoFile": {"_file": [str(MODEL)]},
        "Server": {},
        "Shatter": {"_curve": curve, "_count_": [3]},
        "Sweep": {**held, "_parameters": ["Springs.stiffness"], "_values": [1.0, 2.0], "_run": True},
    }


def settings(**fields: Any) -> str:
    found: str = canvas.settings(Bench().component("Settings"), fast=True, **fields)
    return found


class Canvas:
    """One of each component, solved together as often as any of them asks for it."""

    def __init__(self, names: list[str] | None = None) -> None:
        self.bench = Bench()
        self.inputs = {name: given for name, given in samples().items() if names is None or name in names}
        self.ghenvs = {name: self.bench.component(name, tuple(given)) for name, given in self.inputs.items()}
        self.codes = {}
        self.outputs: dict[str, dict[str, Any]] = {name: {} for name in self.inputs}
        self.longest = 0.0
        for name in self.inputs:
            bundle = bundles.read(name)
            self.codes[name] = (bundle, compile(bundle.code, name, "exec"))

    def solve(self, name: str) -> Any:
        """One solution of one component."""
        bundle, code = self.codes[name]
        scope = {p.name: self.inputs[name].get(p.name) for p in bundle.inputs}
        scope["ghenv"] = self.ghenvs[name]
        began = time.monotonic()
        self.bench.solve(self.ghenvs[name], lambda: exec(code, scope))
        self.longest = max(self.longest, time.monotonic() - began)
        self.outputs[name] = {p.name: scope.get(p.name) for p in bundle.outputs}

    def until(self, fits: Any, seconds: float = HANG) -> dict[str, float]:
        """Solutions of all until `fits(name)` for each; how long each took. What is fit rests."""
        began, taken = time.monotonic(), {}
        while len(taken) < len(self.inputs):
            for name in self.inputs:
                if name not in taken:
                    self.solve(name)
                    if fits(name):
                        taken[name] = time.monotonic() - began
            left = {name: self.said(name) for name in self.inputs if name not in taken}
            assert time.monotonic() - began < seconds, left
            time.sleep(0.03)
        return taken

    def said(self, name: str) -> list[str]:
        return sentences(self.ghenvs[name])

    def rests(self, name: str) -> bool:
        """Whether a component shows a server that runs, and has nothing to wait for."""
        return name == "Server" and self.ghenvs[name].Component.Message == "running" and not self.said(name)

    def works(self, name: str) -> bool:
        """Whether a component says nothing and has something in its outputs."""
        values = self.outputs[name].values()
        idle = name != "Engine" or not self.bench.document.scheduled
        return not self.said(name) and idle and any(value is not None and value != [] for value in values)


def each_says(canvas: Canvas, *words: str) -> None:
    """Every component of the canvas says one sentence with one of these words, soon, and looks again by itself. One
    that has seen the server a moment ago shows what it saw, once."""
    began, left = time.monotonic(), list(canvas.inputs)
    while left:
        for name in list(left):
            canvas.solve(name)
            said = canvas.said(name)
            assert canvas.bench.document.scheduled or canvas.rests(name), name
            if said and any(word in said[0] for word in words):
                left.remove(name)
                assert len(said) == 1 and said[0].endswith(".") and "Traceback" not in said[0], (name, said)
                assert not sentences(canvas.ghenvs[name], "Error"), name  # it is nobody's fault
        assert time.monotonic() - began < SOON, {name: canvas.said(name) for name in left}
        time.sleep(0.03)


@contextmanager
def told(home: Home, port: int, wire: int = 1) -> Iterator[None]:
    """What a server would tell of itself, of a process that lives."""
    entry = {"url": f"http://127.0.0.1:{port}", "token": "t", "instance": "i", "proof": "p", "wire": wire}
    (home.folder / "server.json").write_text(json.dumps(entry))
    yield
    (home.folder / "server.json").unlink()


@contextmanager
def silent(home: Home) -> Iterator[None]:
    """A server that accepts and says nothing."""
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        listener.listen(64)
        with told(home, listener.getsockname()[1]):
            yield


class Health(BaseHTTPRequestHandler):
    """Proves who it is, as a server of another version would."""

    protocol_version = "HTTP/1.1"  # what is proven is the connection, which stays

    def do_GET(self) -> None:
        text = f"hookean i 127.0.0.1 {self.server.server_port} {self.path.partition('=')[2]}"  # type: ignore[attr-defined]
        body = json.dumps({"proof": hmac.new(b"p", text.encode(), "sha256").hexdigest()}).encode()
        self.send_response(200)
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, *_: Any) -> None:
        pass


@contextmanager
def older(home: Home) -> Iterator[None]:
    """A server of another version."""
    server = HTTPServer(("127.0.0.1", 0), Health)
    thread = threading.Thread(target=server.serve_forever, daemon=True)
    thread.start()
    with told(home, server.server_port, wire=99):
        yield
    server.shutdown()
    server.server_close()
    thread.join()


def moving(canvas: Canvas) -> None:
    """From the start on the engine moves: without damping it never comes to rest."""
    canvas.inputs["Engine"]["settings_"] = [settings(drag=0.0)]
    for reset, word in ((True, "held at the start"), (False, "iteration")):
        canvas.inputs["Engine"]["_reset"] = reset
        canvas.until(lambda name, word=word: name != "Engine" or word in canvas.ghenvs[name].Component.Message)


@contextmanager
def hanging(home: Home) -> Iterator[None]:
    """The server and its processes stand still."""
    [pid] = home.serving()
    family = [psutil.Process(pid), *psutil.Process(pid).children(recursive=True)]
    for process in family:
        process.suspend()
    try:
        yield
    finally:
        for process in family:
            with suppress(psutil.NoSuchProcess):
                process.resume()


def test_one_trouble_after_the_other(home: Home) -> None:
    """Every component says each of them, of which it looks again by itself, and works once there is a server. The form
    stays while there is none, and moves on from there; a server that was killed is started by the components."""
    canvas = Canvas()
    each_says(canvas, "cannot start one", "No hookean server is running")
    with silent(home):
        each_says(canvas, "has not answered")
    with older(home):
        each_says(canvas, "is not compatible with this component")
        assert "99" in canvas.said("Engine")[0] and "hookean serve --stop" in canvas.said("Engine")[0]
    home.serve()
    canvas.until(canvas.works)
    canvas.inputs = {name: canvas.inputs[name] for name in ("Engine", "Divide", "Server")}
    moving(canvas)
    with hanging(home):
        canvas.inputs["Divide"]["_count_"] = [5]  # what was asked before is known
        each_says(canvas, "has not answered", "does not answer", "was lost")
    moving(canvas)
    home.kill()
    canvas.inputs["Divide"]["_count_"] = [6]
    each_says(canvas, "is starting", "was lost", "No hookean server is running", "does not answer", "has not answered")
    assert canvas.outputs["Engine"]["particles"]
    canvas.inputs["Engine"]["settings_"] = [settings(drag=5.0)]
    canvas.until(canvas.works)
    assert len(canvas.outputs["Divide"]["points"]) == 7


def test_a_session_is_left_without_starting_a_server(home: Home) -> None:
    """Nobody looks at it any more, and its server is gone: none is started for a pause."""
    home.serve()
    canvas = Canvas(["Engine"])
    moving(canvas)
    [player] = canvas_engine._players.values()
    assert player.wait(HANG)
    home.kill()
    canvas_link.service.lose()  # as whoever asked it in vain does
    player.leave()
    for thread in threading.enumerate():
        if thread.name == "hookean-task":
            thread.join(HANG)
    assert not finding._children and not home.serving()


def test_a_client_whose_server_is_gone_is_closed(home: Home) -> None:
    """All of its connections, also those that were not tried."""
    home.serve()
    service = canvas_link.Service()
    client = service.client()
    until = time.monotonic() + HANG
    for connection in [client._connection(until) for _ in range(3)]:
        client._idle.append((client.instance, time.monotonic(), connection))
    home.kill()
    service.doubt()
    client._start = False
    with pytest.raises(hookean_client.Problem):
        service.client()
    assert client._idle == []


def test_nothing_holds_the_canvas_up(home: Home, monkeypatch: pytest.MonkeyPatch) -> None:
    """A solution of a component returns while its server is silent: whatever speaks with the server does so in a thread
    of its own, and a solution waits for that for `WAIT` at most."""
    spoke, waited = set(), []  # type: set[int], list[float]
    reach, wait = finding.reach, canvas_link.Task.wait

    def opened(*given: Any) -> Any:
        spoke.add(threading.get_ident())
        return reach(*given)

    def waits(task: Any, seconds: float) -> Any:
        waited.append(seconds)
        return wait(task, seconds)

    monkeypatch.setattr(finding, "reach", opened)
    monkeypatch.setattr(canvas_link.Task, "wait", waits)
    with silent(home):
        canvas = Canvas()
        for name in canvas.inputs:
            canvas.solve(name)
    assert spoke and threading.get_ident() not in spoke
    assert waited and max(waited) <= canvas_link.WAIT
    assert canvas.longest < (0.5 if SOAK else HANG)


def test_the_studio_is_opened_by_a_file_of_this_user(home: Home, monkeypatch: pytest.MonkeyPatch) -> None:
    """The component gives the browser no token: a file that this user alone can read leads to the page, with a code
    that logs in once; it is removed when the code is worth nothing."""
    opened: list[str] = []
    removing: list[Any] = []

    home.serve()
    client = hookean_client.connect(start=False, timeout=HANG)
    monkeypatch.setattr(canvas_server.webbrowser, "open", opened.append)
    monkeypatch.setattr(canvas_server, "_later", lambda *given: removing.append(given))
    canvas_server._show(client)
    try:
        [address], [(seconds, remove, path)] = opened, removing
        file = Path(urlsplit(address).path)
        assert address == file.as_uri() and file.parent == home.folder and file.stat().st_mode & 0o777 == 0o600
        page = file.read_text()
        [code] = set(re.findall(r"#t=([\w-]+)", page))
        assert client.token not in address + page and code not in address and seconds == 60.0
        for status in (204, 401):
            login = httpx.post(f"{client.url}/v1/login", headers={"authorization": f"Bearer {code}"}, timeout=HANG)
            assert login.status_code == status
        for _ in range(2):
            remove(path)
            assert not file.exists()
    finally:
        client.close()
