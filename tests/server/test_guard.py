"""Nobody is let in who should not be: hosts, origins, sites and tokens on every kind of request; bodies of any size."""

from __future__ import annotations

import asyncio
import itertools
import json
import os
import re
import socket
import threading
import time
from collections.abc import Iterator
from typing import Any

import httpx
import psutil
import pytest
from starlette.types import Message

from hookean_server.http.limits import BodyLimit
from hookean_server.http.refusals import Problems
from hookean_server.http.tokens import Unfit, chosen
from hookean_server.settings import Settings
from serving import CABLE, HANG, app, wait_for
from soak import sampled

from .conftest import Served, problem

FRIEND = "http://friend.example:3000"
JSON_LIMIT = 2**20


@pytest.fixture(scope="module")
def served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    page = tmp_path_factory.mktemp("page")
    (page / "index.html").write_text('<title>hookean</title><script type="module" src="/page/app.js"></script>')
    (page / "app.js").write_text("export {};")
    limits = {"json_limit": JSON_LIMIT, "body_seconds": 3.0, "header_seconds": 2.0}
    found = Served(origins=(FRIEND,), workers=1, page=str(page), **limits)
    found.ready()
    assert found.client.put("/v1/sessions/a", json=CABLE).status_code == 201
    yield found
    found.end()


def say(served: Served, head: str, body: bytes = b"", seconds: float = HANG) -> bytes:
    """What the server answers to a request written by hand, until it closes or falls silent after a whole head."""
    with socket.create_connection(("127.0.0.1", served.port), timeout=seconds) as sock:
        sock.sendall(head.replace("\n", "\r\n").encode("latin-1") + b"\r\n\r\n" + body)
        found = b""
        while b"\r\n\r\n" not in found and (part := sock.recv(65536)):
            found += part
        return found


# the matrix: every line is one way to come, and what of it is ours

HOSTS = {"ours": "127.0.0.1:{port}", "name": "localhost:{port}", "other": "evil.example:{port}", "no port": "127.0.0.1"}
ORIGINS = {"none": None, "own": "http://{host}", "foreign": "http://evil.example", "null": "null", "listed": FRIEND}
SITES = {"none": None, "same-origin": "same-origin", "cross-site": "cross-site"}
KINDS = ("GET", "HEAD", "POST", "PUT", "SOCKET")
TOKENS = ("right", "wrong", "missing", "cookie")


def passes(kind: str, host: str, origin: str, site: str, token: str) -> bool:
    """The rule in one place: our host; changing things or watching, no page but ours and listed ones; the token, or
    the cookie from our own page."""
    if host not in ("ours", "name"):
        return False
    if kind not in ("GET", "HEAD"):
        if origin in ("foreign", "null"):
            return False
        if site == "cross-site" and origin != "listed":
            return False
    if token == "cookie":
        return origin in ("none", "own") and site != "cross-site"
    return token == "right"


MATRIX = list(itertools.product(KINDS, HOSTS, ORIGINS, SITES))


def headers_of(served: Served, host: str, origin: str, site: str, token: str, cookie: str) -> str:
    named = HOSTS[host].format(port=served.port)
    lines = [f"Host: {named}"]
    if (given := ORIGINS[origin]) is not None:
        lines.append(f"Origin: {given.format(host=named)}")
    if SITES[site] is not None:
        lines.append(f"Sec-Fetch-Site: {SITES[site]}")
    lines += {
        "right": [f"Authorization: Bearer {served.token}"],
        "wrong": [f"Authorization: Bearer {served.token[:-1]}"],
        "missing": [],
        "cookie": [f"Cookie: a=b; {cookie}"],
    }[token]
    return "\n".join(lines)


@pytest.fixture(scope="module")
def cookie(served: Served) -> str:
    return served.client.post("/v1/login").headers["set-cookie"].split(";")[0]


@pytest.mark.thinned
@pytest.mark.parametrize(("kind", "host", "origin", "site"), sampled(MATRIX, 7))
def test_only_ours_pass(served: Served, cookie: str, kind: str, host: str, origin: str, site: str) -> None:
    """300 lines, outside soak every seventh, with four kinds of token each: what passes is what the rule lets pass."""
    scene = json.dumps(CABLE).encode()
    for token in TOKENS:
        head = headers_of(served, host, origin, site, token, cookie)
        if kind in ("GET", "HEAD"):
            found = say(served, f"{kind} /v1/sessions/a HTTP/1.1\n{head}\nConnection: close")
        elif kind == "PUT":
            start = f"PUT /v1/sessions/a HTTP/1.1\nContent-Type: application/json\nContent-Length: {len(scene)}"
            found = say(served, f"{start}\n{head}\nConnection: close", scene)
        elif kind == "POST":
            start = "POST /v1/sessions/a/pause HTTP/1.1"
            found = say(served, f"{start}\n{head}\nConnection: close\nContent-Length: 0")
        else:
            upgrade = "Upgrade: websocket\nConnection: Upgrade\nSec-WebSocket-Version: 13"
            upgrade += "\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA=="
            found = say(served, f"GET /v1/sessions/a/frames HTTP/1.1\n{head}\n{upgrade}")
        status = int(found.split()[1])
        if passes(kind, host, origin, site, token):
            assert status == (101 if kind == "SOCKET" else 200), (token, found)
        else:
            assert status in (401, 403), (token, found)
            assert b"application/problem+json" in found
        listed = f"access-control-allow-origin: {FRIEND}".encode() in found.lower()
        assert listed == (origin == "listed" and kind != "SOCKET"), (token, found)


def test_every_address_needs_the_token_but_for_the_open_ones(served: Served) -> None:
    """Walks the description: without a token everything is 401 except health, problems, the page and Hops' calls."""
    opened = set()
    with httpx.Client(base_url=served.url, timeout=HANG) as nobody:
        for path, item in app().openapi()["paths"].items():
            for method in item:
                answer = nobody.request(method.upper(), re.sub(r"\{.*?\}", "busy", path))
                if answer.status_code != 401:
                    opened.add((method, path))
                else:
                    problem(answer, 401, "unauthorized")
                    assert answer.headers["www-authenticate"].startswith("Bearer")
        assert nobody.get("/v1/openapi.json").status_code == 401
        assert nobody.get("/v1/nothing").status_code == nobody.post("/nothing").status_code == 401
        assert nobody.get("/nothing").status_code == 404  # a function of Hops that there is not
        assert nobody.get("/page/app.js").status_code == 200
    hops = {("get", "/"), ("get", "/{function}"), ("post", "/solve")}
    assert opened == {("get", "/v1/health"), ("get", "/v1/proof"), ("get", "/problems/{slug}"), *hops}


@pytest.mark.parametrize(
    "sent",
    [
        "",
        "Bearer",
        "Bearer ",
        "Basic {token}",
        "{token}",
        "Bearer {token}x",
        "Bearer {token} {token}",
        "bearer: {token}",
    ],
)
def test_what_is_no_token(served: Served, sent: str) -> None:
    given = sent.format(token=served.token)
    head = f"GET /v1/sessions HTTP/1.1\nHost: 127.0.0.1:{served.port}\nAuthorization: {given}"
    assert say(served, head).startswith(b"HTTP/1.1 401")


def test_no_token_in_the_address_or_twice(served: Served) -> None:
    with httpx.Client(base_url=served.url, timeout=HANG) as nobody:
        for query in (f"token={served.token}", f"t={served.token}", f"access_token={served.token}"):
            assert nobody.get(f"/v1/sessions?{query}").status_code == 401
    twice = f"Authorization: Bearer {served.token}\nAuthorization: Bearer {served.token}"
    assert say(served, f"GET /v1/sessions HTTP/1.1\nHost: 127.0.0.1:{served.port}\n{twice}").startswith(b"HTTP/1.1 401")


def test_two_hosts_or_two_origins_are_refused(served: Served) -> None:
    host = f"Host: 127.0.0.1:{served.port}"
    known = f"Authorization: Bearer {served.token}"
    assert b" 40" in say(served, f"GET /v1/health HTTP/1.1\n{host}\n{host}")[:14]
    own = f"Origin: http://127.0.0.1:{served.port}"
    head = f"POST /v1/sessions/a/pause HTTP/1.1\n{host}\n{known}\nContent-Length: 0"
    assert say(served, f"{head}\n{own}").startswith(b"HTTP/1.1 200")
    for two in (f"{own}\nOrigin: http://evil.example", f"Origin: http://evil.example\n{own}"):
        assert say(served, f"{head}\n{two}").startswith(b"HTTP/1.1 403")


def test_a_page_logs_in_once_and_out(served: Served) -> None:
    """The cookie is hidden from scripts and from other sites, works for its own page, and is worth nothing after."""
    answer = served.client.post("/v1/login")
    said = answer.headers["set-cookie"]
    assert answer.status_code == 204 and answer.content == b""
    assert "HttpOnly" in said and "SameSite=Strict" in said and "Path=/" in said
    assert said.startswith(f"hookean-{served.port}=") and served.token not in said
    cookie = {"cookie": said.split(";")[0], "origin": served.url, "sec-fetch-site": "same-origin"}
    with httpx.Client(base_url=served.url, timeout=HANG) as page:
        assert page.get("/v1/sessions", headers=cookie).status_code == 200
        assert page.post("/v1/sessions/a/pause", headers=cookie).status_code == 200
        beside = {**cookie, "sec-fetch-site": "same-site"}  # a page of another port of this machine
        problem(page.get("/v1/sessions", headers=beside), 401, "unauthorized")
        out = page.delete("/v1/login", headers=cookie)
        assert out.status_code == 204 and "Max-Age=0" in out.headers["set-cookie"]
        problem(page.get("/v1/sessions", headers=cookie), 401, "unauthorized")
        problem(page.post("/v1/login", headers={"authorization": "Bearer no"}), 401, "unauthorized")


def test_tokens_are_random_or_as_set(monkeypatch: pytest.MonkeyPatch) -> None:
    """256 random bits; the variable is taken out of the environment, so that no worker inherits it."""
    monkeypatch.delenv("HOOKEAN_TOKEN", raising=False)
    assert len({chosen() for _ in range(100)}) == 100 and len(chosen()) == 43
    monkeypatch.setenv("HOOKEAN_TOKEN", "set-by-the-environment")
    assert chosen() == "set-by-the-environment" and "HOOKEAN_TOKEN" not in os.environ
    for unfit in ("short", "with space" * 3, "é" * 20, "x" * 300, "line\nbreak" * 3):
        with pytest.raises(Unfit, match="16 to 200") as raised:
            chosen(unfit)
        assert unfit not in str(raised.value)
    assert "secret-of-somebody" not in repr(Settings(token="secret-of-somebody"))


def test_the_page_is_closed_to_other_pages(served: Served) -> None:
    with httpx.Client(base_url=served.url, timeout=HANG) as browser:
        page = browser.get("/", headers={"accept": "text/html,*/*;q=0.8"})
        assert page.headers["content-type"].startswith("text/html") and "hookean" in page.text
        assert "default-src 'self'" in page.headers["content-security-policy"]
        assert served.token not in page.text and "<script>" not in page.text
        scripts = re.findall(r'src="(/.*?)"', page.text)
        assert scripts
        for path in scripts:
            assert browser.get(path).status_code == 200
        for path in ("/page/guard.py", "/page/..%2fguard.py", "/page/%2e%2e/guard.py", "/page/"):
            assert browser.get(path).status_code in (401, 404), path


# cors


def test_cors_is_off_by_default_and_exact_where_it_is_on(served: Served) -> None:
    asks = {"access-control-request-method": "PATCH", "access-control-request-headers": "authorization"}
    with httpx.Client(base_url=served.url, timeout=HANG) as browser:
        listed = browser.options("/v1/sessions/a", headers={"origin": FRIEND, **asks})
        assert listed.status_code == 204 and listed.headers["access-control-allow-origin"] == FRIEND
        assert "authorization" in listed.headers["access-control-allow-headers"] and "Origin" in listed.headers["vary"]
        assert "access-control-allow-credentials" not in listed.headers
        for origin in ("http://friend.example", FRIEND + "0", FRIEND.upper(), "null", "*"):
            other = browser.options("/v1/sessions/a", headers={"origin": origin, **asks})
            assert other.status_code in (401, 403) and "Origin" in other.headers["vary"]
            assert not [h for h in other.headers if h.startswith("access-control")]
        hops = browser.options("/solve", headers={"origin": FRIEND, **asks})
        assert hops.status_code in (401, 403, 405)
        host = browser.options("/v1/sessions/a", headers={"origin": FRIEND, "host": "evil.example", **asks})
        problem(host, 403, "forbidden-host")


# bodies


def head_of(served: Served, length: str, path: str = "/v1/relax") -> str:
    known = f"Authorization: Bearer {served.token}\nContent-Type: application/json"
    return f"POST {path} HTTP/1.1\nHost: 127.0.0.1:{served.port}\n{known}\n{length}"


def pour(served: Served, head: str, chunked: bool, most: int = 2**31) -> tuple[int, bytes]:
    """Send up to 2 GB, whatever comes back; how many bytes were taken, and the answer."""
    block = b" " * 65536
    part = b"10000\r\n" + block + b"\r\n" if chunked else block
    taken, said = 0, b""
    with socket.socket() as sock:
        sock.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 65536)
        sock.settimeout(15.0)
        sock.connect(("127.0.0.1", served.port))
        sock.sendall(head.replace("\n", "\r\n").encode() + b"\r\n\r\n")
        try:
            while taken < most:
                sock.sendall(part)
                taken += len(block)
        except (ConnectionError, TimeoutError):
            pass
        try:
            while got := sock.recv(65536):
                said += got
        except (ConnectionError, TimeoutError):
            pass
    return taken, said


@pytest.mark.parametrize("path", ["/v1/sessions", "/solve"])
@pytest.mark.parametrize(
    ("length", "chunked"),
    [
        ("Transfer-Encoding: chunked", True),
        ("Content-Length: 2147483648", False),
        ("Content-Length: 0\nTransfer-Encoding: chunked", True),
        ("Content-Length: 100\nTransfer-Encoding: chunked", True),
    ],
)
def test_two_gigabytes_are_refused_early_and_cost_no_memory(
    served: Served, path: str, length: str, chunked: bool
) -> None:
    """What the server takes is its limit and what the kernel's buffers hold, a small part of what is offered."""
    process = psutil.Process(served.process.pid)
    before, highest, over = process.memory_info().rss, [0], threading.Event()

    def watch() -> None:
        while not over.wait(0.02):
            highest[0] = max(highest[0], process.memory_info().rss)

    watching = threading.Thread(target=watch)
    watching.start()
    try:
        taken, said = pour(served, head_of(served, length, path), chunked)
    finally:
        over.set()
        watching.join()
    assert taken < JSON_LIMIT + 16 * 2**20, taken  # the kernel may hold some megabytes of a connection
    assert highest[0] - before < 12 * 2**20
    if said:
        assert said.startswith((b"HTTP/1.1 413", b"HTTP/1.1 404", b"HTTP/1.1 400")), said
    wait_for(lambda: served.health()["requests"]["taken"] == 0)


@pytest.mark.parametrize("path", ["/v1/relax", "/solve", "/v1/nothing"])
def test_no_more_than_the_limit_and_64_kb_is_read(path: str) -> None:
    """Counted where the server reads: a body without end, in pieces of 64 kB, and one that says it is small."""
    for headers in ([(b"transfer-encoding", b"chunked")], [(b"content-length", b"3000000000")]):
        read = asyncio.run(_read_of(path, [(b"content-type", b"application/json"), *headers]))
        assert read <= JSON_LIMIT + 65536, (path, headers, read)


async def _read_of(path: str, headers: list[tuple[bytes, bytes]]) -> int:
    read, sent = 0, []
    settings = Settings(json_limit=JSON_LIMIT)

    async def reads_all(scope: Any, receive: Any, send: Any) -> None:
        while (await receive()).get("more_body"):
            pass
        raise AssertionError("the end of an endless body")

    async def receive() -> Message:
        nonlocal read
        read += 65536
        return {"type": "http.request", "body": b" " * 65536, "more_body": True}

    async def send(message: Message) -> None:
        sent.append(message)

    scope = {"type": "http", "method": "POST", "path": path, "raw_path": path.encode(), "query_string": b"",
             "headers": headers}  # fmt: skip
    await Problems(BodyLimit(reads_all, settings))(scope, receive, send)
    assert sent[0]["status"] == 413 and (b"connection", b"close") in sent[0]["headers"]
    return read


def test_a_length_that_is_too_small_ends_the_connection(served: Served) -> None:
    """The rest of the body is no second request: it is refused as one."""
    head = head_of(served, "Content-Length: 2", "/v1/sessions/a/pause")
    with socket.create_connection(("127.0.0.1", served.port), timeout=HANG) as sock:
        sock.sendall(head.replace("\n", "\r\n").encode() + b"\r\n\r\n{}" + b"x" * 200_000)
        said = b""
        try:
            while part := sock.recv(65536):
                said += part
        except ConnectionError:
            pass
    assert said.startswith(b"HTTP/1.1 200") and said.count(b"HTTP/1.1 200") == 1
    assert b"HTTP/1.1 431" in said and b"application/problem+json" in said


def test_a_length_that_is_too_large_is_waited_for_in_vain(served: Served) -> None:
    with socket.create_connection(("127.0.0.1", served.port), timeout=HANG) as sock:
        sock.sendall(head_of(served, "Content-Length: 1000").replace("\n", "\r\n").encode() + b"\r\n\r\n{}")
        said = sock.recv(65536)
        assert said.startswith(b"HTTP/1.1 408") and b"connection: close" in said.lower()
        while sock.recv(65536):
            pass  # until it is closed


def test_a_body_that_trickles_is_closed(served: Served) -> None:
    """A byte now and then does not lengthen the time."""
    with socket.create_connection(("127.0.0.1", served.port), timeout=HANG) as sock:
        sock.sendall(head_of(served, "Content-Length: 100000").replace("\n", "\r\n").encode() + b"\r\n\r\n")
        with pytest.raises(OSError):
            for _ in range(99_999):  # one less than it says it has
                sock.sendall(b" ")
                time.sleep(0.1)
    wait_for(lambda: served.health()["requests"]["taken"] == 0)


@pytest.mark.parametrize("begun", [b"", b"GET /v1/health HTTP/1.1\r\nHost: 127"])
@pytest.mark.parametrize("second", [False, True])
def test_headers_that_do_not_come_are_closed(served: Served, begun: bytes, second: bool) -> None:
    """Also those of the second request of a connection."""
    with socket.create_connection(("127.0.0.1", served.port), timeout=HANG) as sock:
        if second:
            sock.sendall(f"GET /v1/health HTTP/1.1\r\nHost: 127.0.0.1:{served.port}\r\n\r\n".encode())
            assert sock.recv(65536).startswith(b"HTTP/1.1 200")
        sock.sendall(begun)
        while sock.recv(65536):
            pass


def test_what_is_no_http_is_answered_as_a_problem(served: Served) -> None:
    for rubbish in (b"\x16\x03\x01\x02\x00\x01\x00", b"GET\r\n\r\n", b"GET / HTTP/1.1\r\nHost 1\r\n\r\n"):
        with socket.create_connection(("127.0.0.1", served.port), timeout=HANG) as sock:
            sock.sendall(rubbish + b"\r\n" * 3)
            said = sock.recv(65536)
        assert said.startswith(b"HTTP/1.1 400") and b"application/problem+json" in said, (rubbish, said)


def test_a_long_message_closes_its_socket_only(served: Served) -> None:
    from websockets.exceptions import ConnectionClosed
    from websockets.sync.client import connect

    url = f"ws://127.0.0.1:{served.port}/v1/sessions/a/frames"
    with connect(url, additional_headers=served.known) as watcher, connect(url, additional_headers=served.known) as bad:
        bad.send("x" * 70_000)
        with pytest.raises(ConnectionClosed) as closed:
            while True:
                bad.recv(timeout=HANG)
        assert closed.value.rcvd is not None and closed.value.rcvd.code == 1009
        watcher.send('{"id": 1, "do": "pause"}')
        wait_for(lambda: '"id": 1' in str(watcher.recv(timeout=HANG)))
