"""How the client reads an answer: no more memory than the answer takes."""

from __future__ import annotations

import io
from http.client import HTTPResponse
from typing import Any

import pytest

from hookean_client import transport


class Socket:
    """What a server sends, to be read once."""

    def __init__(self, data: bytes) -> None:
        self.data = data

    def makefile(self, *_: object) -> io.BytesIO:
        return io.BytesIO(self.data)


class Answer(HTTPResponse):
    """An answer that notes how many bytes are read at once."""

    most = 0

    def read(self, amt: int | None = None) -> bytes:
        assert amt is not None
        Answer.most = max(Answer.most, amt)
        return super().read(amt)


def answer(body: bytes, *headers: bytes) -> Answer:
    socket: Any = Socket(b"\r\n".join([b"HTTP/1.1 200 OK", *headers, b"", body]))
    found = Answer(socket)
    found.begin()
    return found


@pytest.mark.parametrize("size", [0, 1, transport.PIECE - 1, transport.PIECE, 3 * transport.PIECE + 1])
def test_an_answer_is_read_in_pieces(size: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Python 3.9, which Rhino 8 has, makes a buffer of all bytes that it is asked to read and fills it with zeros: a
    gigabyte for each answer, however short, where all that is allowed is asked for."""
    monkeypatch.setattr(Answer, "most", 0)
    body = bytes(i % 251 for i in range(1000)) * (size // 1000 + 1)
    body = body[:size]
    length = b"Content-Length: %d" % size
    assert transport.read(answer(body, length), transport.LARGEST) == body
    chunked = b"%x\r\n%b\r\n" % (size, body) if size else b""
    assert transport.read(answer(chunked + b"0\r\n\r\n", b"Transfer-Encoding: chunked"), transport.LARGEST) == body
    assert transport.read(answer(body), transport.LARGEST) == body
    assert Answer.most <= transport.PIECE


def test_what_is_longer_than_allowed_is_not_read() -> None:
    """Where the length is known nothing, else one byte more than allowed."""
    assert transport.read(answer(b"12345", b"Content-Length: 5"), 4) is None
    assert transport.read(answer(b"12345"), 4) is None
    assert transport.read(answer(b"12345"), 5) == b"12345"


def test_an_answer_that_is_cut_off_is_an_error() -> None:
    with pytest.raises(EOFError):
        transport.read(answer(b"123", b"Content-Length: 5"), 10)
