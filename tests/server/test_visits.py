"""What requests without a token may cost: workers, places, memory, time to read their answers."""

from __future__ import annotations

import json
import os
import select
import socket
from collections.abc import Callable, Iterator
from contextlib import ExitStack, suppress
from typing import Any

import httpx
import psutil
import pytest

from serving import CABLE, HANG, wait_for
from soak import sampled

from .conftest import Served

LINE = {"From": {"X": 0, "Y": 0, "Z": 0}, "To": {"X": 10, "Y": 0, "Z": 0}}
EIGHT = 8


def tree(name: str, kind: str, *values: Any) -> dict[str, Any]:
    return {"ParamName": name, "InnerTree": {"{0}": [{"type": kind, "data": json.dumps(value)} for value in values]}}


def divide(count: int) -> dict[str, Any]:
    """A line in so many pieces: about 135 bytes for each point of the answer."""
    values = [tree("Curve", "Rhino.Geometry.Line", LINE), tree("Count", "System.Int32", count)]
    return {"pointer": "divide", "values": values}


def ask(served: Served, request: dict[str, Any]) -> socket.socket:
    """A connection with little room that has asked, without a token, and reads nothing."""
    body = json.dumps(request).encode()
    head = f"POST /solve HTTP/1.1\r\nHost: 127.0.0.1:{served.port}\r\nContent-Type: application/json\r\n"
    sock = socket.socket()
    sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 16 * 1024)
    sock.settimeout(HANG)
    sock.connect(("127.0.0.1", served.port))
    sock.sendall(f"{head}Content-Length: {len(body)}\r\n\r\n".encode() + body)
    return sock


def answered(sockets: list[socket.socket], seconds: float = 0.0) -> list[socket.socket]:
    """Those for which there is something to read."""
    return select.select(sockets, [], [], seconds)[0]


def read(sock: socket.socket) -> bytes:
    """All that comes until the other side closes."""
    found = b""
    with sock:
        try:
            while more := sock.recv(1 << 20):
                found += more
        except ConnectionResetError:
            pass
    return found


@pytest.fixture(scope="module")
def served() -> Iterator[Served]:
    server = Served(workers=2, visits=EIGHT - 1)
    yield server.ready()
    server.end()


@pytest.mark.soak
def test_unread_answers_wait_for_each_other_and_not_in_memory(served: Served) -> None:
    """Eight cost no more than twice what one costs, and it is given back; meanwhile the owner is served. The next one
    is refused at once."""
    process, request = psutil.Process(served.process.pid), divide(90_000)

    def memory() -> int:
        return int(process.memory_info().rss)

    assert served.client.post("/v1/relax", json=CABLE).status_code == 200
    before = memory()
    with ask(served, request) as one:
        answered([one], HANG)
        single = max(memory() - before, 20_000_000)
    assert served.client.post("/solve", json=divide(3)).status_code == 200, "its turn is over"
    with ExitStack() as open_ones:
        sockets = [open_ones.enter_context(ask(served, request)) for _ in range(EIGHT)]
        [first] = answered(sockets, HANG)
        for _ in range(30):
            assert served.client.post("/v1/relax", json=CABLE).status_code == 200
            assert memory() - before <= 2 * single
        assert answered(sockets) == [first]
        with ask(served, request) as late:
            assert late.recv(1000).startswith(b"HTTP/1.1 503")
        first.close()
        sockets.remove(first)
        assert len(answered(sockets, HANG)) == 1, "the next one has its turn"
        assert memory() - before <= 2 * single
    wait_for(lambda: memory() - before < single)
    assert served.client.post("/solve", json=divide(3)).status_code == 200


def test_bodies_that_do_not_come_take_no_place_of_the_owner(served: Served) -> None:
    head = f"POST /solve HTTP/1.1\r\nHost: 127.0.0.1:{served.port}\r\nContent-Type: application/json\r\n"
    with ExitStack() as open_ones:
        sockets = []
        for _ in range(40):
            sock = open_ones.enter_context(socket.create_connection(("127.0.0.1", served.port), timeout=HANG))
            sock.sendall(f"{head}Content-Length: 1000\r\n\r\n".encode())
            sockets.append(sock)
        wait_for(lambda: len(answered(sockets)) == 40 - EIGHT)
        assert served.client.post("/solve", json=divide(3)).status_code == 503
        assert served.health()["requests"]["taken"] == 0
        assert served.client.post("/v1/relax", json=CABLE).status_code == 200
    wait_for(lambda: served.client.post("/solve", json=divide(3)).status_code == 200)


@pytest.mark.skipif(os.name != "posix", reason="limits of open files")
def test_connections_that_say_nothing_leave_room_for_the_owner() -> None:
    """Each takes one of 200 open files; 400 are opened. The oldest that no token came on is closed, so sessions are
    made, which takes files too, others can connect, and the owner's connection stays."""
    served = Served("import resource; resource.setrlimit(resource.RLIMIT_NOFILE, (200, 200));", workers=1).ready()
    with ExitStack() as stack:
        stack.callback(served.end)
        stream = stack.enter_context(served.client.stream("GET", "/v1/sessions"))
        for _ in range(400):
            sock = stack.enter_context(socket.create_connection(("127.0.0.1", served.port), timeout=HANG))
            with suppress(OSError):  # it is closed already
                sock.sendall(b"GET /v1/he")
        served.client.put("/v1/sessions/a", json=CABLE).raise_for_status()
        served.client.post("/v1/sessions/a/step").raise_for_status()
        assert stream.read() and httpx.get(f"{served.url}/v1/health", timeout=HANG).status_code == 200
        assert "Too many open files" not in served.log()


@pytest.mark.parametrize("path", sampled(["/solve", "/v1/discretize/divide"], 2))
def test_who_reads_nothing_is_cut_off(path: str) -> None:
    """An answer that is larger than what the two ends keep of it: the rest never comes, and the next one is served."""
    served = Served(workers=2, write_seconds=0.5).ready()
    try:
        if path == "/solve":
            stuck = ask(served, divide(120_000))
        else:
            body = json.dumps({"curve": [[0, 0, 0], [10, 0, 0]], "count": 600_000}).encode()
            head = f"POST {path} HTTP/1.1\r\nHost: 127.0.0.1:{served.port}\r\n{served.head}"
            stuck = socket.create_connection(("127.0.0.1", served.port), timeout=HANG)
            stuck.sendall(
                f"{head}Content-Type: application/json\r\nContent-Length: {len(body)}\r\n\r\n".encode() + body
            )
        answered([stuck], HANG)
        assert served.client.post("/solve", json=divide(3)).status_code == 200
        wait_for(lambda: not [c for c in psutil.Process(served.process.pid).net_connections() if _is_of(c, stuck)])
        got = read(stuck)
        assert b"200 OK" in got[:30] and len(got) < 15_000_000
    finally:
        _, said = served.end()
    assert "Traceback" not in said and "ERROR" not in said


def _is_of(connection: Any, sock: socket.socket) -> bool:
    return bool(connection.raddr) and connection.raddr.port == sock.getsockname()[1]


@pytest.mark.soak
def test_who_reads_too_slowly_is_cut_off() -> None:
    """A reader of drips, each of which is progress, ends with the time that its whole answer has."""
    first = "from hookean_server.http import limits; limits.RATE = 2**30;"
    served = Served(first, workers=2, write_seconds=1.0).ready()
    try:
        sock = ask(served, divide(120_000))
        answered([sock], HANG)
        got = 0
        with sock:
            try:
                while more := sock.recv(100):
                    got += len(more)
                    if got % 100_000 < 100:
                        served.health()
            except ConnectionResetError:
                pass
        assert 0 < got < 15_000_000
    finally:
        served.end()


SMALL = 1_000_000  # bytes


@pytest.fixture(scope="module")
def small() -> Iterator[Served]:
    server = Served(workers=2, visit_limit=SMALL)
    yield server.ready()
    server.end()


def grid(side: int) -> dict[str, Any]:
    import rhino3dm

    mesh: Any = rhino3dm.Mesh()
    for i in range(side):
        for j in range(side):
            mesh.Vertices.Add(i, j, 0)
    for i in range(side - 1):
        for j in range(side - 1):
            corner = i * side + j
            mesh.Faces.AddFace(corner, corner + 1, corner + side + 1, corner + side)
    found: dict[str, Any] = mesh.Encode()
    return found


def box() -> dict[str, Any]:
    import rhino3dm

    corners = rhino3dm.BoundingBox(rhino3dm.Point3d(0, 0, 0), rhino3dm.Point3d(1, 1, 1))
    found: dict[str, Any] = rhino3dm.Brep.CreateFromBox(rhino3dm.Box(corners)).Encode()
    return found


def frames(chains: int, links: int) -> list[dict[str, Any]]:
    other = {"From": {"X": 0, "Y": 5, "Z": 0}, "To": {"X": 10, "Y": 5, "Z": 0}}
    return [
        tree("Near frame", "Rhino.Geometry.Line", LINE),
        tree("Far frame", "Rhino.Geometry.Line", other),
        tree("Chains", "System.Int32", chains),
        tree("Links", "System.Int32", links),
    ]


REQUESTS: dict[str, Callable[[], tuple[dict[str, Any], str]]] = {
    "points": lambda: (divide(20_000), "/Count"),
    "faces of a Brep": lambda: (
        {
            "pointer": "mesh_faces",
            "values": [
                tree("Surface", "Rhino.Geometry.Brep", box()),
                *(tree(name, "System.Int32", 60) for name in "UV"),
            ],
        },
        "/V",
    ),
    "links of chains": lambda: ({"pointer": "chains_between_frames", "values": frames(1000, 500)}, "/Links"),
    "edges of a mesh that is given": lambda: (
        {"pointer": "edges", "values": [tree("Mesh", "Rhino.Geometry.Mesh", grid(60))]},
        "/",
    ),
}


@pytest.mark.parametrize("name", REQUESTS)
def test_an_answer_that_would_be_too_large_is_not_made(small: Served, name: str) -> None:
    request, pointer = REQUESTS[name]()
    answer = small.client.post("/solve", json=request)
    assert answer.status_code == 422, answer.text[:300]
    [said] = answer.json()["errors"]
    assert said.startswith(f"{pointer}: the answer would have about") and "at most 1 MB" in said


def test_answers_are_as_large_as_is_estimated(small: Served) -> None:
    """Of what is allowed nothing is much larger than the limit, nor is half of it refused."""
    from hookean_server.hops.values import SIZES

    count = SMALL // SIZES["Point"] - 10
    size = len(small.client.post("/solve", json=divide(count)).content)
    assert SMALL / 2 < size <= SMALL
