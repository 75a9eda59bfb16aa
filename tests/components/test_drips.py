"""The client against a server that drips, redirects, talks without end or answers nonsense: its time and its memory are
bounded, and what it raises is its own Problem."""

from __future__ import annotations

import hmac
import json
import socket
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from typing import Any

import pytest

import hookean_client.transport
import hookean_client.websocket
from hookean_client import Problem
from hookean_client.client import Client
from serving import HANG, wait_for

INSTANCE, KEY = "of-a-test", "k" * 40
OK = "HTTP/1.1 200 OK\r\nContent-Type: application/json\r\n"
Script = Callable[["Hostile", socket.socket], None]


class Hostile:
    """A server that proves who it is, and then does as its script says until `over`."""

    def __init__(self) -> None:
        self.script: Script = lambda server, sock: None
        self.over = threading.Event()
        self.dripping = threading.Event()
        self.ended = threading.Event()
        self.listening = socket.create_server(("127.0.0.1", 0))
        self.threads: list[threading.Thread] = []
        self.url = f"http://127.0.0.1:{self.listening.getsockname()[1]}"
        self._begin(self._accept)

    def _begin(self, work: Callable[..., None], *given: object) -> None:
        thread = threading.Thread(target=work, args=given, daemon=True)
        self.threads.append(thread)
        thread.start()

    def _accept(self) -> None:
        with suppress(OSError):
            while True:
                self._begin(self._serve, self.listening.accept()[0])

    def _serve(self, sock: socket.socket) -> None:
        with sock, suppress(OSError):
            heard = b""
            while b"\r\n\r\n" not in heard:
                heard += sock.recv(65536)
            nonce = heard.partition(b"nonce=")[2].split()[0].decode()
            text = f"hookean {INSTANCE} 127.0.0.1 {self.url.rpartition(':')[2]} {nonce}"
            body = json.dumps({"proof": hmac.new(KEY.encode(), text.encode(), "sha256").hexdigest()})
            sock.sendall(f"{OK}Content-Length: {len(body)}\r\n\r\n{body}".encode())
            if sock.recv(65536):
                self.script(self, sock)
        self.ended.set()

    def drip(self, sock: socket.socket, drop: bytes, pause: float = 0.02) -> None:
        """One drop after the other until the client leaves."""
        while not self.over.wait(pause):
            sock.sendall(drop)
            self.dripping.set()

    def close(self) -> None:
        self.over.set()
        self.listening.close()


@pytest.fixture
def server() -> Iterator[Hostile]:
    found = Hostile()
    yield found
    found.close()


@pytest.fixture
def client(server: Hostile) -> Iterator[Client]:
    found = Client(lambda start, until: {"url": server.url, "token": "t", "instance": INSTANCE, "proof": KEY})
    found.renew()
    yield found
    found.close()


def drips(first: str, drop: bytes, pause: float = 0.02) -> Script:
    def script(server: Hostile, sock: socket.socket) -> None:
        sock.sendall(first.encode())
        server.drip(sock, drop, pause)

    return script


SLOW: dict[str, Script] = {
    "headers": drips("HTTP/1.1 200 OK\r\nX-Slow: ", b"x"),
    "status": drips("", b"H"),
    "body": drips(f"{OK}Content-Length: 1000000\r\n\r\n", b" "),
    "chunks": drips(f"{OK}Transfer-Encoding: chunked\r\n\r\n", b"1\r\n \r\n"),
    "a body without an end": drips(OK + "Connection: close\r\n\r\n", b" "),
    "continue": drips("", b"HTTP/1.1 100 Continue\r\n\r\n", 0.0),
}


@pytest.mark.parametrize("name", SLOW)
@pytest.mark.parametrize("method", ["GET", "POST"])
def test_the_timeout_is_that_of_the_whole_call(server: Hostile, client: Client, name: str, method: str) -> None:
    """It ends by the client while the server goes on: the connection is cut, whatever comes down it. (A busy
    machine may need longer than the first timeouts for the first drop.)"""
    server.script = SLOW[name]
    for timeout in (0.5, 5.0, HANG):
        server.ended.clear()
        with pytest.raises(Problem) as found:
            client.request(method, "/v1/health", b"{}" if method == "POST" else None, timeout=timeout)
        assert (found.value.slug, found.value.status) in (("lost", 0), ("no-answer", 0))
        if server.dripping.is_set():
            break
    assert server.dripping.is_set() and not server.over.is_set()
    assert server.ended.wait(HANG), "the server is left"


def answers(head: str, body: bytes = b"") -> Script:
    return lambda server, sock: sock.sendall(f"{head}Content-Length: {len(body)}\r\n\r\n".encode() + body)


@pytest.mark.parametrize("status", [301, 302, 303, 307, 308])
@pytest.mark.parametrize("method", ["POST", "PUT", "PATCH", "DELETE"])
def test_a_redirect_is_an_error(server: Hostile, client: Client, status: int, method: str) -> None:
    server.script = answers(f"HTTP/1.1 {status} Elsewhere\r\nLocation: http://127.0.0.1:9/\r\n", b"gone")
    with pytest.raises(Problem) as found:
        client.request(method, "/v1/relax", b"{}")
    assert found.value.status == status and str(status) in str(found.value)


@pytest.mark.parametrize("body", [b"{", b"\xff\xfe", b'{"a": nonsense}', b"[" * 100_000])
def test_broken_json_is_a_problem(server: Hostile, client: Client, body: bytes) -> None:
    server.script = answers(OK, body)
    with pytest.raises(Problem) as found:
        client.get("/v1/health")
    assert (found.value.slug, found.value.status) == ("broken", 200)


def test_an_answer_cut_short_is_lost(server: Hostile, client: Client) -> None:
    server.script = lambda server, sock: sock.sendall(f"{OK}Content-Length: 100\r\n\r\n[1]".encode())
    with pytest.raises(Problem) as found:
        client.post("/v1/relax", b"{}")
    assert found.value.slug == "lost"


@pytest.mark.parametrize("head", ["Content-Length: 3000000\r\n\r\n", "Connection: close\r\n\r\n"])
def test_a_body_has_a_limit(server: Hostile, client: Client, head: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(hookean_client.transport, "LARGEST", 1_000_000)
    server.script = drips(OK + head, b" " * 100_000, 0.0)
    with pytest.raises(Problem) as found:
        client.post("/v1/relax", b"{}")
    assert found.value.slug == "too-large" and "1000000 bytes" in str(found.value)


def upgraded(server: Hostile, sock: socket.socket) -> None:
    """The handshake is complete; then a frame that never ends, and nothing is read."""
    import base64
    import hashlib

    key = server.key + b"258EAFA5-E914-47DA-95CA-C5AB0DC85B11"  # type: ignore[attr-defined]
    accept = base64.b64encode(hashlib.sha1(key).digest()).decode()
    sock.sendall(
        "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
        f"Sec-WebSocket-Accept: {accept}\r\n\r\n".encode()
        + b"\x82\x7f\x00\x00\x00\x00\x00\x10\x00\x00"
    )
    server.drip(sock, b"x")


@pytest.mark.parametrize("name", ["handshake", "frame"])
def test_frames_close_while_the_server_drips(
    server: Hostile, client: Client, name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """`close` returns at once, also while the receiving thread is in the middle of a message: 2 s is what
    the call may take, and the socket is shut with it."""
    if name == "handshake":
        server.script = drips("HTTP/1.1 101 Switching Protocols\r\nX-Slow: ", b"x")
    else:
        import base64
        import os

        monkeypatch.setattr(os, "urandom", lambda count: b"k" * count)
        server.key = base64.b64encode(b"k" * 16)  # type: ignore[attr-defined]
        server.script = upgraded
    frames = client.session("a").frames()
    assert server.dripping.wait(HANG)
    closing = threading.Thread(target=frames.close, daemon=True)
    began = time.process_time()
    closing.start()
    closing.join(HANG)
    assert not closing.is_alive() and time.process_time() - began < 2.0
    assert server.ended.wait(HANG), "the connection is shut"
    assert frames.ended


def test_a_connection_that_becomes_no_link_is_closed(client: Client, monkeypatch: pytest.MonkeyPatch) -> None:
    """Frames are closed while their thread has a connection, and no link yet."""
    made, closed = [], threading.Event()

    def shut_before_it_is_asked(connection: Any, path: str, token: str) -> None:
        made.append(connection)
        assert closed.wait(HANG)
        connection.sock.sendall(b"GET")

    monkeypatch.setattr(hookean_client.websocket, "Link", shut_before_it_is_asked)
    frames = client.session("a").frames()
    wait_for(lambda: made)
    frames.close()
    closed.set()
    wait_for(lambda: made[0].sock is None)
