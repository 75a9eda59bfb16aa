"""Frames and sockets, bit by bit: what the server writes is what the client reads; what is damaged is refused."""

from __future__ import annotations

import base64
import hashlib
import os
import socket
import struct
import threading
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import hookean_client
from hookean_client import Problem, buffer
from hookean_client.sessions import decode
from hookean_client.websocket import Link
from hookean_server.sessions import wire
from serving import HANG

FLOATS = st.floats(-(2.0**100), 2.0**100, width=32)


@st.composite
def shown(draw: st.DrawFn) -> wire.Shown:
    n, m, k = draw(st.integers(0, 6)), draw(st.integers(0, 6)), draw(st.integers(0, 3))

    def array(*shape: int) -> Any:
        size = int(np.prod(shape))
        return np.array(draw(st.lists(FLOATS, min_size=size, max_size=size)), float).reshape(shape)

    whole = st.integers(0, 2**64 - 1)
    return wire.Shown(
        draw(st.integers(0, 2**32 - 1)), draw(whole), draw(whole), draw(FLOATS), draw(FLOATS),
        draw(st.sampled_from(wire.STATUSES)), draw(st.booleans()), draw(FLOATS), array(n, 3), array(m), array(k, 3),
    )  # fmt: skip


@given(shown())
def test_a_frame_is_read_as_it_was_written(frame: wire.Shown) -> None:
    found = decode(wire.encode(frame))
    for name in ("number", "revision", "iteration", "time", "residual", "status", "playing", "kinetic"):
        assert found[name] == getattr(frame, name)
    for name in ("particles", "scalars", "reactions"):
        assert list(found[name]) == getattr(frame, name).ravel().tolist()


@given(shown(), st.data())
def test_both_sides_refuse_the_same_damage(frame: wire.Shown, data: st.DataObject) -> None:
    """Where the server's own reader takes damaged bytes the client reads the same; else it raises, and only as told."""
    raw = bytearray(wire.encode(frame))
    for _ in range(data.draw(st.integers(1, 3))):
        place = data.draw(st.integers(0, min(len(raw), 64) - 1))
        raw[place] = data.draw(st.integers(0, 255))
    raw = raw[: data.draw(st.integers(0, len(raw)))] if data.draw(st.booleans()) else raw
    try:
        found: Any = decode(bytes(raw))
    except (*hookean_client.FAILURES, Problem):
        found = None
    try:
        theirs = wire.decode(bytes(raw))
    except ValueError:
        return
    assert found is not None
    assert np.array_equal(found["particles"], theirs.particles.ravel(), equal_nan=True)


def test_a_frame_of_another_version_says_so() -> None:
    raw = bytearray(wire.encode(wire.Shown(1, 0, 0, 0, 0, "running", False, 0, *map(np.zeros, [(1, 3), 0, (0, 3)]))))
    raw[4] = 2
    with pytest.raises(Problem) as found:
        decode(bytes(raw))
    assert found.value.slug == "wrong-version" and "version 2" in str(found.value)


@given(st.lists(st.tuples(FLOATS, FLOATS, FLOATS), min_size=1))
def test_rows_of_numbers_are_what_a_scene_reads(rows: list[tuple[float, float, float]]) -> None:
    from hookean.values.columns import _decoded

    assert _decoded(buffer(rows)).tolist() == [list(row) for row in rows]
    assert _decoded(buffer([row[0] for row in rows])).tolist() == [row[0] for row in rows]


def test_whole_numbers_are_what_a_scene_reads() -> None:
    from hookean.values.columns import _decoded

    assert _decoded(buffer([[0, 1], [1, 2]], "q")).dtype == np.int64
    assert _decoded(buffer([])).shape == (0,)


# WebSockets: RFC 6455


def pair() -> tuple[Link, socket.socket]:
    """A client's end without its handshake, and the other end as it is."""
    ours, theirs = socket.socketpair()
    ours.settimeout(10.0)
    theirs.settimeout(10.0)
    link = Link.__new__(Link)
    link._connection = SimpleNamespace(sock=ours, close=ours.close)
    link._sending = threading.Lock()
    link._answer = SimpleNamespace(fp=ours.makefile("rb"))
    return link, theirs


def part(
    code: int, data: bytes, *, last: bool = True, first: int = 0, masked: int = 0, size: int | None = None
) -> bytes:
    size = len(data) if size is None else size
    head = bytes([code | first | (0x80 if last else 0)])
    if size < 126:
        return head + bytes([size | masked]) + data
    if size < 65536:
        return head + bytes([126 | masked]) + struct.pack(">H", size) + data
    return head + bytes([127 | masked]) + struct.pack(">Q", size) + data


def read(theirs: socket.socket) -> tuple[int, bytes]:
    """Kind and bytes of a message of the client, which must be masked."""

    def exactly(size: int) -> bytes:
        return theirs.recv(size, socket.MSG_WAITALL) if size else b""

    first, second = exactly(2)
    assert first & 0x80 and second & 0x80
    size = second & 127
    if size == 126:
        [size] = struct.unpack(">H", exactly(2))
    mask, data = exactly(4), exactly(size)
    return first & 15, bytes(octet ^ mask[i % 4] for i, octet in enumerate(data))


def end(link: Link, theirs: socket.socket) -> None:
    link._answer.fp.close()
    link._connection.close()
    theirs.close()


@given(st.lists(st.binary(max_size=300), min_size=1, max_size=5), st.lists(st.integers(0, 4)), st.sampled_from([1, 2]))
def test_messages_in_parts_with_pings_between(parts: list[bytes], pings: list[int], kind: int) -> None:
    link, theirs = pair()
    sent = b""
    for i, data in enumerate(parts):
        sent += b"".join(part(9, b"ping") for place in pings if place == i)
        sent += part(0 if i else kind, data, last=i == len(parts) - 1)
    theirs.sendall(sent + part(2, b"next"))
    assert link.receive() == (kind, b"".join(parts))
    assert link.receive() == (2, b"next")
    for place in pings:
        if place < len(parts):
            assert read(theirs) == (10, b"ping")
    end(link, theirs)


@pytest.mark.parametrize("size", [0, 1, 125, 126, 127, 65535, 65536, 300_000])
def test_every_size(size: int) -> None:
    link, theirs = pair()
    data = os.urandom(size)
    sender = threading.Thread(target=theirs.sendall, args=(part(2, data),))
    sender.start()
    assert link.receive() == (2, data)
    sender.join()
    if size < 65536:
        link.send(1, data)
        assert read(theirs) == (1, data)
    end(link, theirs)


@pytest.mark.parametrize(
    ("raw", "sentence"),
    [
        (
            part(8, struct.pack(">H", 4404) + b"There is no session with this key."),
            "There is no session with this key.",
        ),
        (part(8, struct.pack(">H", 1012)), "1012"),
        (part(8, b""), "1005"),
    ],
)
def test_a_close_says_why(raw: bytes, sentence: str) -> None:
    link, theirs = pair()
    theirs.sendall(raw)
    with pytest.raises(Problem) as found:
        link.receive()
    assert sentence in str(found.value) and (found.value.slug == "not-found") == ("no session" in sentence)
    end(link, theirs)


@pytest.mark.parametrize(
    "raw",
    [
        part(2, b"x", masked=0x80),
        part(2, b"x", first=0x40),
        part(3, b"x"),
        part(0, b"x"),
        part(2, b"x", last=False) + part(1, b"y"),
        part(9, b"x" * 126),
        part(9, b"x", last=False),
        part(2, b"", size=2**40),
        part(2, b"", size=2**63),
    ],
)
def test_what_is_no_websocket_is_refused(raw: bytes) -> None:
    link, theirs = pair()
    theirs.sendall(raw)
    with pytest.raises(ValueError, match="invalid message"):
        link.receive()
    end(link, theirs)


@given(st.binary(max_size=40))
def test_any_bytes_end_in_a_message_or_a_failure(raw: bytes) -> None:
    link, theirs = pair()
    theirs.sendall(raw)
    theirs.close()
    try:
        while True:
            kind, data = link.receive()
            assert kind in (1, 2) and isinstance(data, bytes)
    except (*hookean_client.FAILURES, Problem):
        pass
    end(link, theirs)


@pytest.mark.parametrize("accept", ["right", "wrong", "none"])
def test_the_answer_to_the_handshake_is_checked(accept: str) -> None:
    import http.client

    def answer(listening: socket.socket) -> None:
        theirs, _ = listening.accept()
        with theirs:
            head = theirs.recv(65536).decode()
            fields = dict(line.lower().split(": ", 1) for line in head.split("\r\n")[1:] if line)
            asked = next(line for line in head.split("\r\n") if line.lower().startswith("sec-websocket-key"))
            key = asked.split(": ")[1] if accept == "right" else "x"
            digest = hashlib.sha1((key + "258EAFA5-E914-47DA-95CA-C5AB0DC85B11").encode()).digest()
            assert fields["upgrade"] == "websocket" and fields["sec-websocket-version"] == "13"
            told = "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
            if accept != "none":
                told += f"Sec-WebSocket-Accept: {base64.b64encode(digest).decode()}\r\n"
            theirs.sendall(told.encode() + b"\r\n" + part(1, b"{}"))
            theirs.recv(1)

    with socket.create_server(("127.0.0.1", 0)) as listening:
        thread = threading.Thread(target=answer, args=(listening,))
        thread.start()
        connection = http.client.HTTPConnection("127.0.0.1", listening.getsockname()[1], timeout=HANG)
        connection.connect()
        if accept == "right":
            assert Link(connection, "/v1/sessions/a/frames", "token").receive() == (1, b"{}")
        else:
            with pytest.raises(ValueError, match="not a WebSocket"):
                Link(connection, "/v1/sessions/a/frames", "token")
        connection.close()
        thread.join()
