"""The other side of the pool: what a worker process does. It reads foreign bytes and solves; it may be killed any time.

Messages are raw bytes, never pickles: a JSON head, then a body, each way. An empty message asks to stop.
"""

from __future__ import annotations

import json
import math
import os
import signal
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from multiprocessing import parent_process
from multiprocessing.connection import Connection, wait
from typing import Any

STOP = b""


def warm() -> None:
    """Load and compile what every solve needs, once: later workers inherit it or find it in the cache."""
    from hookean.run import relax
    from hookean.scene import Scene

    scene = {
        "particles": [[0.0, 0.0, 0.0], [1.0, 0.0, 0.1], [2.0, 0.0, 0.0]],
        "forces": [
            {"kind": "springs", "particles": [[0, 1], [1, 2]]},
            {"kind": "unary", "particles": [1], "vector": [0.0, 0.0, -1.0]},
        ],
        "anchors": [{"particles": [0, 2]}],
    }
    for settings in ({}, {"solver": "relaxation"}, {"solver": "verlet", "max_iterations": 10}):
        relax(Scene.model_validate({**scene, "settings": settings}))
    for name in ("hookean_server.solve", "hookean_server.operations", "hookean.files.compas_json"):
        __import__(name)


def work(connection: Connection, memory: int, forked: bool, nice: int = 0) -> None:
    """Serve requests until the parent closes its end, dies or kills us. `memory` [bytes] is ours to allocate; `nice`:
    how far we give way to others."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C reaches the whole group; the parent decides
    _die_with_parent(forked)
    if not forked:
        with suppress(Exception):
            __import__("hookean_server.preload")
    _limit_memory(memory)
    if nice and hasattr(os, "nice"):
        os.nice(nice)
    with suppress(EOFError, OSError):
        connection.send_bytes(b"ready")
        while True:
            head = connection.recv_bytes()
            if head == STOP:
                continue  # meant for a request that was done before it came
            _answer(connection, json.loads(head), connection.recv_bytes())


def _answer(connection: Connection, request: dict[str, Any], body: bytes) -> None:
    from hookean_server.tasks import perform

    head, answer = perform(request, body, Link(connection))
    connection.send_bytes(json.dumps(head).encode())
    connection.send_bytes(answer)


@contextmanager
def limited(seconds: float) -> Iterator[None]:
    """What is done inside ends this process where it computes longer than `seconds`, or twice that by the clock: for
    libraries that may never return and hold the interpreter. Systems without such limits wait for the pool's."""
    if sys.platform == "win32":
        yield
        return
    import resource

    soft, hard = resource.getrlimit(resource.RLIMIT_CPU)
    until = math.ceil(time.process_time() + seconds)
    resource.setrlimit(resource.RLIMIT_CPU, (until if hard < 0 else min(until, hard), hard))
    signal.setitimer(signal.ITIMER_REAL, 2.0 * seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        resource.setrlimit(resource.RLIMIT_CPU, (soft, hard))


def ended(code: int | None) -> str:
    """What an exit code says of input that a library could not digest; "" where it says nothing about that."""
    name = signal.Signals(-code).name if code is not None and -code in set(signal.Signals) else ""
    if name in ("SIGXCPU", "SIGALRM"):
        return "reading it does not end; open it in the program that wrote it and save it anew"
    if name in ("SIGSEGV", "SIGABRT", "SIGBUS", "SIGFPE", "SIGILL"):
        return "damaged: its contents cannot be read; open it in the program that wrote it and save it anew"
    return ""


class Link:
    """What a task has of its server: called, whether it should stop; `say` tells of how far it is."""

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
        """Tell the server something before the answer."""
        self.connection.send_bytes(json.dumps({"said": said}).encode())
        self.connection.send_bytes(body)


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
        with suppress(Exception):
            import ctypes

            ctypes.CDLL(None).prctl(1, signal.SIGKILL)


def _limit_memory(memory: int) -> None:
    """At most `memory` bytes more than now, where the system can hold us to it; and no memory left in a core file."""
    if sys.platform != "linux":
        return
    with suppress(Exception):
        import resource

        with open("/proc/self/statm", encoding="ascii") as file:
            now = int(file.read().split()[0]) * resource.getpagesize()
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_AS, (now + memory, now + memory))


def return_pages() -> None:
    """Give the memory of large values back to the system as soon as they are gone, not when its neighbours are."""
    if sys.platform != "linux":
        return
    with suppress(Exception):
        import ctypes

        ctypes.CDLL(None).mallopt(-3, 256 * 2**10)  # M_MMAP_THRESHOLD; set once, it does not grow


def keep_pages() -> None:
    """Take arrays up to 64 MB from memory that was used before: fresh pages cost more than the sums on them."""
    if sys.platform != "linux":
        return
    with suppress(Exception):
        import ctypes

        libc = ctypes.CDLL(None)
        libc.mallopt(-3, 64 * 2**20)  # M_MMAP_THRESHOLD
        libc.mallopt(-1, 256 * 2**20)  # M_TRIM_THRESHOLD
