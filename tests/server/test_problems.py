"""Every refusal has one shape, whoever refuses; hosts, origins, sizes and kinds of bodies are guarded."""

from __future__ import annotations

import json
import re
import socket
from collections.abc import Iterator
from typing import Any

import httpx
import pytest

from hookean.scene.families import FAMILIES
from hookean_server.app import create_app
from hookean_server.problems import CATALOGUE
from hookean_server.settings import Settings
from hookean_server.workers.analysis_task import ANALYSES
from hookean_server.workers.discretize_task import OPERATIONS
from serving import CABLE, HANG, app
from soak import sampled

from .conftest import Served, problem

PATHS = {
    "/v1/health": "GET",
    "/v1/proof": "GET",
    "/v1/forces": "GET",
    "/v1/discretize": "GET",
    "/v1/relax": "POST",
    "/v1/design": "POST",
    "/v1/sensitivity": "POST",
    "/v1/relax/3dm": "POST",
    "/v1/geometry/3dm": "POST",
    "/v1/recipes": "POST",
    "/v1/recipes/3dm": "POST",
    "/v1/examples": "GET",
    "/v1/examples/9.4-cable/picture": "GET",
    "/v1/examples/9.4-cable/scene": "GET",
    "/v1/families": "GET",
    "/problems/busy": "GET",
    "/v1/openapi.json": "GET",
    "/metrics": "GET",
    "/": "GET",
    "/{function}": "GET",
    **{f"/v1/discretize/{name}": "POST" for name in OPERATIONS},
    **{f"/v1/families/{name}": "POST" for name in FAMILIES},
    **{f"/v1/analysis/{name}": "POST" for name in (*ANALYSES, "load-cases", "report", "export")},
}
METHODS = ("GET", "POST", "PUT", "PATCH", "DELETE", "OPTIONS", "TRACE")
JSON = {"content-type": "application/json"}


def test_every_path_is_in_the_list() -> None:
    kept = (
        "/v1/sessions",
        "/v1/jobs",
        "/v1/login",
        "/v1/token",
        "/v1/shutdown",
        "/solve",
    )  # tested where they are told of
    described = {path for path in app().openapi()["paths"] if not path.startswith(kept)}
    listed = {re.sub(r"^/problems/.*", "/problems/{slug}", p).replace("9.4-cable", "{example}") for p in PATHS}
    assert listed - {"/v1/openapi.json"} == described


@pytest.mark.thinned
@pytest.mark.parametrize("path", sampled(PATHS, 3))
def test_other_methods_are_refused_in_one_shape(client: httpx.Client, path: str) -> None:
    for method in METHODS:
        if method == PATHS[path] or (method == "GET" and path == "/v1/openapi.json"):
            continue
        response = client.request(method, path)
        found = problem(response, 405, "method-not-allowed")
        assert PATHS[path] in response.headers["allow"], found


@pytest.mark.parametrize("path", [p for p, m in PATHS.items() if m == "POST"])
def test_posts_without_a_body_of_the_right_kind(client: httpx.Client, path: str) -> None:
    for kind in (
        "text/plain",
        "application/x-www-form-urlencoded",
        "",
        "multipart/form-data; boundary=x",
        "application/json",
    ):
        right = kind.startswith("multipart") == path.endswith(("3dm", "/recipes")) and kind not in ("", "text/plain")
        if right and kind != "application/x-www-form-urlencoded":
            continue
        problem(client.post(path, content=b"{}", headers={"content-type": kind}), 415, "unsupported-media")
    problem(client.post(path, content=b"{}", headers={**JSON, "content-encoding": "gzip"}), 415, "unsupported-media")


@pytest.mark.parametrize("path", ["/v1", "/v1/relax/", "/v1/nothing", "/v1/relax/3dm/x", "/%00", "/v1/%2e%2e"])
def test_other_addresses(client: httpx.Client, path: str) -> None:
    problem(client.get(path), 404, "not-found")


def test_every_problem_has_a_page(client: httpx.Client) -> None:
    for slug, (status, title, advice) in CATALOGUE.items():
        page = client.get(f"/problems/{slug}")
        assert page.status_code == 200 and title in page.text and advice in page.text and str(status) in page.text
    problem(client.get("/problems/none"), 404, "not-found")


@pytest.mark.parametrize(
    "host", ["evil.example", "evil.example:{port}", "127.0.0.1", "localhost:1", "127.0.0.1.evil:{port}", ""]
)
def test_other_hosts(served: Served, host: str) -> None:
    headers = {"host": host.format(port=served.port)}
    for method, path in (("GET", "/v1/health"), ("POST", "/v1/relax"), ("GET", "/nothing")):
        problem(served.client.request(method, path, headers=headers), 403, "forbidden-host")


@pytest.mark.parametrize("host", ["127.0.0.1:{port}", "localhost:{port}", "LOCALHOST:{port}", "[::1]:{port}"])
def test_our_hosts(served: Served, host: str) -> None:
    headers = {"host": host.format(port=served.port)}
    assert served.client.get("/v1/health", headers=headers).status_code == 200


@pytest.mark.parametrize(
    "headers",
    [
        {"origin": "http://evil.example"},
        {"origin": "null"},
        {"origin": "http://127.0.0.1:1"},
        {"origin": "https://127.0.0.1:{port}"},
        {"sec-fetch-site": "cross-site"},
        {"sec-fetch-site": "same-site"},
    ],
)
def test_other_sites(served: Served, headers: dict[str, str]) -> None:
    headers = {k: v.format(port=served.port) for k, v in headers.items()}
    for path in ("/v1/relax", "/v1/relax/3dm", "/v1/discretize/divide"):
        response = served.client.post(path, json=CABLE, headers=headers)
        problem(response, 403, "forbidden-origin")
        assert not [h for h in response.headers if h.startswith("access-control")]
    problem(served.client.options("/v1/relax", headers=headers), 405, "method-not-allowed")  # no preflight is answered


def test_our_own_page_may(served: Served) -> None:
    headers = {"origin": served.url, "sec-fetch-site": "same-origin"}
    assert served.client.post("/v1/relax", json=CABLE, headers=headers).status_code == 200


def test_sockets_are_guarded_too(served: Served) -> None:
    """Addresses where nothing listens too; those of sessions are in test_guard.py."""
    key = "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
    key += "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA=="
    for extra in ("Origin: http://evil.example\r\n", ""):
        head = raw(served, f"GET /v1/x HTTP/1.1\r\nHost: 127.0.0.1:{served.port}\r\n{extra}{key}\r\n\r\n".encode())
        assert b" 101 " not in head.split(b"\r\n")[0]


def raw(served: Served, data: bytes) -> bytes:
    """What the server answers to raw bytes."""
    with socket.create_connection(("127.0.0.1", served.port), timeout=HANG) as sock:
        sock.sendall(data)
        return sock.recv(65536)


def test_large_bodies_are_refused_by_their_stated_length_alone(served: Served) -> None:
    """Nothing of the body is sent: a server that waited for it would answer 408."""
    head = f"POST /v1/relax HTTP/1.1\r\nHost: 127.0.0.1:{served.port}\r\n{served.head}"
    head += "Content-Type: application/json\r\n"
    found = raw(served, f"{head}Content-Length: 99999999999\r\n\r\n".encode())
    assert found.startswith(b"HTTP/1.1 413")
    assert b"application/problem+json" in found and b"connection: close" in found.lower()


def test_large_bodies_without_a_length_are_counted(served: Served) -> None:
    def chunks() -> Iterator[bytes]:
        for _ in range(400):
            yield b" " * 100_000

    found = problem(served.client.post("/v1/relax", content=chunks(), headers=JSON), 413, "too-large")
    assert found["errors"][0]["pointer"] == "/"


def test_files_have_a_limit_of_their_own(served: Served) -> None:
    problem(served.client.post("/v1/relax/3dm", files={"file": b"0" * 65 * 2**20}), 413, "too-large")


def test_large_bodies_do_not_stay_in_memory(served: Served) -> None:
    import psutil

    process = psutil.Process(served.process.pid)
    before = process.memory_info().rss
    for _ in range(3):
        served.client.post("/v1/relax", content=b" " * 40_000_000, headers=JSON)
    assert process.memory_info().rss - before < 60 * 2**20


def test_large_headers(served: Served) -> None:
    problem(served.client.get("/v1/health", headers={"x": "y" * 17_000}), 431, "headers-too-large")
    problem(served.client.get("/v1/health?" + "y" * 17_000), 431, "headers-too-large")
    for sent in (b"GET / HTTP/1.1\r\nX: " + b"y" * 200_000, b"GET /v1/health?" + b"y" * 200_000):
        assert raw(served, sent).startswith(b"HTTP/1.1 431 Request Header Fields Too Large\r\n")
    assert raw(served, b"\x00\x01\r\n\r\n").startswith(b"HTTP/1.1 400 Bad Request\r\n")
    assert served.health()["status"] == "ok"


def test_input_is_not_repeated(client: httpx.Client) -> None:
    for scene in ({**CABLE, "particles": [["secret"]]}, {**CABLE, "weld_tolerance": "secret"}):
        assert "secret" not in client.post("/v1/relax", json=scene).text


def test_what_a_sentence_may_quote_is_short(client: httpx.Client) -> None:
    response = client.post("/v1/relax", json={"forces": [{"kind": "x" * 10_000}], "y" * 10_000: 1})
    problem(response, 422, "invalid-scene")
    assert len(response.content) < 4000


def test_a_failure_of_the_service_itself() -> None:
    import asyncio

    app = create_app(Settings(token="token-of-this-test"))
    known = {"authorization": "Bearer token-of-this-test"}

    @app.get("/v1/broken")
    async def broken() -> None:
        raise RuntimeError("secret of the implementation")

    async def ask() -> httpx.Response:
        transport = httpx.ASGITransport(app=app)
        async with httpx.AsyncClient(transport=transport, base_url="http://127.0.0.1:8765", headers=known) as client:
            return await client.get("/v1/broken")

    response = asyncio.run(ask())
    assert "secret" not in response.text
    problem(response, 500, "internal")


@pytest.mark.thinned
@pytest.mark.parametrize(
    ("form", "pointer"),
    [
        ({"files": {"other": b"x"}}, "/other"),
        ({"files": {"file": b""}}, "/file"),
        ({"files": {"file": b"no 3dm file"}}, "/file"),
        ({"files": {"recipe": b"{}"}}, "/file"),
        ({"files": [("file", b"x"), ("file", b"y")]}, "/file"),
        ({"files": {"file": b"x"}, "data": {"recipe": "{"}}, "/"),
        ({"content": b"--x--", "headers": {"content-type": "multipart/form-data"}}, "/"),
        ({"content": b"none", "headers": {"content-type": "multipart/form-data; boundary=x"}}, "/"),
    ],
)
def test_faulty_forms(client: httpx.Client, form: dict[str, Any], pointer: str) -> None:
    found = problem(client.post("/v1/relax/3dm", **form), 422, "invalid-input")
    assert found["errors"][0]["pointer"].startswith(pointer)
    assert "/tmp" not in json.dumps(found)


@pytest.mark.parametrize(
    ("address", "faults"),
    [
        ("/v1/sessions?arays=list", ["/query/arays"]),
        ("/v1/health?x=1&x=2&y", ["/query/x", "/query/y"]),
        ("/v1/health?y=&x=1", ["/query/y", "/query/x"]),
        ("/v1/sessions/none/state?format=npz&format=json", ["/query/format"]),
    ],
)
def test_unknown_and_repeated_parameters_are_named(client: httpx.Client, address: str, faults: list[str]) -> None:
    """A misspelt one, or one of two, would have no effect, unseen; the sentence lists those that there are."""
    said = problem(client.get(address), 422, "invalid-input")
    assert [fault["pointer"] for fault in said["errors"]] == faults


def test_the_parameters_of_an_operation_are_listed_where_one_is_misspelt(client: httpx.Client) -> None:
    said = problem(client.get("/v1/sessions/none/state?fromat=npz"), 422, "invalid-input")
    assert "format" in said["detail"]
