"""The other side of the pool: what a worker process does. It reads foreign bytes and solves; it may be killed any time.

Messages are raw bytes, never pickles: a JSON head, then a body, each way. An empty message asks to stop.
"""

from __future__ import annotations

import os
import signal
import sys
import threading
from contextlib import suppress
from multiprocessing import parent_process
from multiprocessing.connection import Connection, wait
from typing import Any

from hookean_server.workers import channel
from hookean_server.workers.memory import limit_memory

STOP = b""


def work(connection: Connection, memory: int, forked: bool, nice: int = 0) -> None:
    """Serve requests until the parent closes its end, dies or kills us. `memory` [bytes] is ours to allocate; `nice`:
    how far we give way to others."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C reaches the whole group; the parent decides
    _die_with_parent(forked)
    if not forked:
        from hookean_server.workers import preload  # noqa: F401
    limit_memory(memory)
    if nice and hasattr(os, "nice"):
        os.nice(nice)
    with suppress(EOFError, OSError):
        connection.send_bytes(b"ready")
        while True:
            head = connection.recv_bytes()
            if head == STOP:
                continue  # meant for a request that was done before it came
            _answer(connection, *channel.receive(connection, head))


def _answer(connection: Connection, request: dict[str, Any], body: bytes) -> None:
    from hookean_server.workers.registry import perform

    head, answer = perform(request, body, Link(connection))
    channel.send(connection, head, answer)


class Link:
    """What a task has of its server: called, whether it should stop; `say` reports its progress."""

    def __init__(self, connection: Connection) -> None:
        self.connection = connection
        self.stopped = False

    def __call__(self) -> bool:
        """Whether nobody waits for the answer any more."""
        try:
            self.stopped = self.stopped or (self.connection.poll(0) and self.connection.recv_bytes() == STOP)
        except (EOFError, OSError):
            os._exit(1)  # the parent is gone
        return self.stopped

    def say(self, said: dict[str, Any], body: bytes = b"") -> None:
        """Send the server a message before the answer."""
        channel.send(self.connection, {"said": said}, body)


def _die_with_parent(forked: bool) -> None:
    """End when the server does, even in the middle of a kernel that never returns."""
    parent = parent_process()

    def watch() -> None:
        if parent is not None:
            wait([parent.sentinel])
            os._exit(1)

    threading.Thread(target=watch, daemon=True).start()
    if forked and sys.platform == "linux":
        # libraries that hold the interpreter's lock stall the thread above; the kernel waits for nobody.
        # Our parent is the fork server, which ends with the server.
        with suppress(OSError, AttributeError):
            import ctypes

            ctypes.CDLL(None).prctl(1, signal.SIGKILL)
