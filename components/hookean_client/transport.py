"""How bytes travel: times, ends, whole answers and refusals. For Python 2.7 to 3.13."""

import json
import socket
import threading
import time

from . import FAILURES, WIRE, Problem

REACH, ANSWER = 0.2, 2.0  # seconds to reach a server, and for it to prove who it is
LARGEST = 1 << 30  # bytes of an answer
PIECE = 1 << 20  # bytes of it that are read at once
now = getattr(time, "monotonic", time.time)


def cut(connection, until):
    """What ends a connection at a time, whatever drips down it, unless it is cancelled before."""
    timer = threading.Timer(max(0.01, until - now()), shut, [connection, connection.sock])
    timer.daemon = True
    timer.start()
    return timer


def shut(connection, sock=None):
    """End a connection, also one that is waited for elsewhere."""
    try:
        sock = sock or connection.sock
        getattr(sock, "_sock", sock).shutdown(socket.SHUT_RDWR)
    except FAILURES:
        pass


def read(answer, most):
    """The body; None where it has more than `most` bytes."""
    data, whole = None, False
    try:
        data = None if (answer.length or 0) > most else _pieces(answer, most + 1)
        whole = data is not None and len(data) <= most
        if whole and answer.length:
            raise EOFError("the server has gone")
        return data if whole else None
    finally:
        if not whole:
            answer.close()


def _pieces(answer, count):
    """Up to `count` bytes of the body; Python 3.9 fills a buffer with as many zeros as it is asked to read."""
    pieces, left, piece = [], count, b"-"
    while left and piece:
        piece = answer.read(min(left, PIECE))
        pieces.append(piece)
        left -= len(piece)
    return b"".join(pieces)


def refusal(status, data):
    """The problem that an answer of the server reports."""
    try:
        said = json.loads(data.decode("utf-8"))
        errors = [(e["pointer"], e["detail"]) for e in said.get("errors", [])]
        return Problem(said["type"].split("/")[-1], said["detail"], status, errors)
    except FAILURES:
        return Problem("unknown", "The server answered with %d." % status, status)


def check(wire):
    """Raise `Problem` where the frames of a server have another version."""
    if wire != WIRE:
        said = "Its frames have version %s, not %d; stop it with `hookean serve --stop`." % (wire, WIRE)
        raise Problem("wrong-version", said)
