"""Ends what a library computes for too long, and explains exit codes."""

from __future__ import annotations

import math
import signal
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager


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
    """The meaning of an exit code after input that a library could not read; "" for other exits."""
    name = signal.Signals(-code).name if code is not None and -code in set(signal.Signals) else ""
    if name in ("SIGXCPU", "SIGALRM"):
        return "reading it took too long; open it in the program that wrote it and save it again"
    if name in ("SIGSEGV", "SIGABRT", "SIGBUS", "SIGFPE", "SIGILL"):
        return "damaged: its contents cannot be read; open it in the program that wrote it and save it again"
    return ""
