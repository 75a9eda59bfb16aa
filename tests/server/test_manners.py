"""What HTTP asks of every answer: HEAD as GET, Allow, Date, no ranges, headers that keep other sites' pages out."""

from __future__ import annotations

import http.client
import json
import re
from email.utils import parsedate_to_datetime

import pytest

from serving import CABLE, HANG, app
from soak import sampled

from .conftest import Served, problem

METHODS = ("GET", "HEAD", "POST", "PUT", "PATCH", "DELETE")
DOCUMENT = app().openapi()
TEMPLATES = sorted({route.path_format for route in app().state.table.routes})
CHANGING = {"date", "x-request-id", "server-timing", "content-length", "transfer-encoding", "hookean-silence"}


@pytest.fixture(scope="module")
def known(served: Served) -> dict[str, str]:
    """What stands for the parameters of addresses, so that every GET has something to answer with."""
    served.client.put("/v1/sessions/manners", json=CABLE).raise_for_status()
    job = served.client.post("/v1/jobs", json={"scene": CABLE})
    job.raise_for_status()
    example = served.client.get("/v1/examples").json()["examples"][0]["id"]
    named = {"key": "manners", "job": job.headers["location"].rsplit("/", 1)[1], "example": example, "slug": "busy"}
    return {
        **named,
        "function": "cable",
        "path": "index.html",
        "number": "0",
        "sha256": "0" * 64,
        "action": "pause",
    }


def filled(template: str, known: dict[str, str]) -> str:
    return re.sub(r"\{(.*?)\}", lambda found: known.get(found[1], "busy"), template)


def asked(served: Served, method: str, path: str, **headers: str) -> tuple[int, http.client.HTTPMessage, bytes]:
    """An answer by a client that knows nothing of what it asks for: what follows the head of a HEAD would be seen as
    the next answer."""
    connection = http.client.HTTPConnection("127.0.0.1", served.port, timeout=HANG)
    try:
        connection.request(method, path, headers={**served.known, **headers})
        answer = connection.getresponse()
        found = answer.status, answer.headers, answer.read()
        connection.request("GET", "/v1/health")
        assert connection.getresponse().status == 200
    finally:
        connection.close()
    return found


@pytest.mark.thinned
@pytest.mark.parametrize("template", sampled([t for t in TEMPLATES if not t.endswith("/events")], 3))
def test_head_is_get_without_its_body(served: Served, known: dict[str, str], template: str) -> None:
    """The same status and headers, an empty body, and a connection that goes on (RFC 9110, 9.3.2)."""
    path = filled(template, known)
    headers = {"accept": "*/*"}
    status, got, _ = asked(served, "GET", path, **headers)
    status_of_head, said, body = asked(served, "HEAD", path, **headers)
    assert body == b"" and status_of_head == status, path
    names = {name.lower() for name in got} - CHANGING
    assert {name.lower() for name in said} - CHANGING == names
    for name in names - {"etag"}:
        assert said[name] == got[name], name


def test_head_of_events_does_not_wait_for_them(served: Served, known: dict[str, str]) -> None:
    """A stream of events has no end while its job runs; its head is there at once, and the connection goes on."""
    job = served.client.post("/v1/jobs", json={"scene": {**CABLE, "settings": ENDLESS}}).headers["location"]
    try:
        status, headers, body = asked(served, "HEAD", f"{job}/events")
        assert (status, headers["content-type"].split(";")[0], body) == (200, "text/event-stream", b"")
    finally:
        served.client.delete(job)


ENDLESS = {"solver": "verlet", "drag": 0, "time_step": 0.001, "max_iterations": 10**9, "tolerance": 0}


@pytest.mark.thinned
@pytest.mark.parametrize("template", TEMPLATES)
def test_allow_lists_every_method_and_no_other(served: Served, known: dict[str, str], template: str) -> None:
    """A method that Allow does not list is 405 with the same Allow; one that it lists is not 405 (RFC 9110, 15.5.6).
    Oracle: the methods of the description's paths."""
    path = filled(template, known)
    methods = {m.upper() for m in DOCUMENT["paths"].get(template, {"get": {}})}
    methods = {"POST"} if path in ("/v1/discretize/busy", "/v1/families/busy") else methods
    wanted = sorted(methods | ({"HEAD"} if "GET" in methods else set()))
    refused = served.client.request("BREW", path)
    problem(refused, 405, "method-not-allowed")
    assert refused.headers["allow"] == ", ".join(wanted)
    for method in set(METHODS) - set(wanted) - {"HEAD"}:
        answer = served.client.request(method, path)
        if answer.status_code == 405:
            assert answer.headers["allow"] == ", ".join(wanted), method
        else:  # a template with more parameters takes it, and does not know the name
            assert answer.status_code == 404, (method, path)


@pytest.mark.parametrize(
    ("method", "path", "status"),
    [
        ("GET", "/v1/health", 200),
        ("GET", "/v1/nothing", 404),
        ("GET", "/problems/busy", 200),
        ("PUT", "/v1/health", 405),
        ("GET", "/v1/forces", 200),
        ("POST", "/v1/relax", 415),
        ("GET", "/", 200),
        ("GET", "/v1/sessions/none", 404),
    ],
)
def test_every_answer_has_a_date_and_keeps_other_sites_out(served: Served, method: str, path: str, status: int) -> None:
    answer = served.client.request(method, path)
    assert answer.status_code == status
    assert parsedate_to_datetime(answer.headers["date"]).utcoffset() is not None
    assert answer.headers["cross-origin-resource-policy"] == "same-origin"
    assert answer.headers["cross-origin-opener-policy"] == "same-origin"
    assert answer.headers["x-content-type-options"] == "nosniff"
    assert len(answer.headers.get_list("date")) == len(answer.headers.get_list("x-content-type-options")) == 1


def test_what_is_no_http_and_refused_sockets_have_these_headers_too(served: Served) -> None:
    import socket

    for sent in (
        b"rubbish\r\n\r\n",
        f"GET /v1/sessions/a/frames HTTP/1.1\r\nHost: 127.0.0.1:{served.port}\r\nUpgrade: websocket\r\nConnection: "
        "Upgrade\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n".encode(),
    ):
        with socket.create_connection(("127.0.0.1", served.port), timeout=HANG) as sock:
            sock.sendall(sent)
            said = sock.recv(65536).lower()
        assert said.startswith((b"http/1.1 400", b"http/1.1 401"))
        assert b"\r\ndate: " in said and b"\r\ncross-origin-resource-policy: same-origin\r\n" in said, said


@pytest.mark.parametrize("given", ["bytes=0-1", "bytes=5-", "bytes=99999999-", "bytes=-0", "rubbish", "bytes=9-1,2-3"])
def test_ranges_are_ignored(served: Served, known: dict[str, str], given: str) -> None:
    """The whole with status 200, as RFC 9110 (14.2) lets a server answer; never another form of error."""
    for path in (f"/v1/examples/{known['example']}/picture", "/v1/forces", "/v1/openapi.json"):
        whole = served.client.get(path)
        for more in ({}, {"if-range": '"x"'}, {"if-range": whole.headers.get("etag", '"x"')}):
            part = served.client.get(path, headers={"range": given, **more})
            assert (part.status_code, part.content) == (200, whole.content), path
            assert "content-range" not in part.headers and part.headers.get("accept-ranges", "none") == "none"


@pytest.mark.parametrize("bom", [b"", b"\xef\xbb\xbf"])
def test_json_may_begin_with_a_byte_order_mark(served: Served, bom: bytes) -> None:
    """RFC 8259 (8.1) lets a reader ignore it; programs on Windows write it."""
    kind = {"content-type": "application/json"}
    relaxed = served.client.post("/v1/relax", content=bom + json.dumps(CABLE).encode(), headers=kind)
    assert relaxed.status_code == 200, relaxed.text
    made = served.client.put("/v1/sessions/bom", content=bom + json.dumps(CABLE).encode(), headers=kind)
    assert made.status_code in (200, 201), made.text
    edit = bom + b'{"pin": [{"particles": [2]}]}'
    assert served.client.patch("/v1/sessions/bom", content=edit, headers=kind).status_code == 200
    form = served.client.put("/v1/sessions/bom", files={"file": ("a.json", bom + json.dumps(CABLE).encode())})
    assert form.status_code == 200, form.text
    curve = bom + b'{"curve": [[0, 0, 0], [10, 0, 0]], "count": 5}'
    divided = served.client.post("/v1/discretize/divide", content=curve, headers=kind)
    assert divided.status_code == 200, divided.text
    job = served.client.post("/v1/jobs", content=bom + json.dumps({"scene": CABLE}).encode(), headers=kind)
    assert job.status_code == 202, job.text
    hops = served.client.post("/solve", content=bom + b'{"pointer": "cable", "values": []}', headers=kind)
    assert hops.status_code == 200, hops.text
    served.client.delete("/v1/sessions/bom")
