"""Reports that code is compiled, for who waits: a line on the terminal, and an entry of the log `hookean.compiled`."""

from __future__ import annotations

import logging
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

log = logging.getLogger("hookean.compiled")

AFTER = 1.0  # seconds of compiling in a process that are not reported
LINE = "Compiling the engine for this computer: once, up to a minute for the first scenes ..."


def later(seconds: float, act: Callable[[], None]) -> Callable[[], None]:
    """Call a function in a thread after some seconds; returns the function that cancels it."""
    timer = threading.Timer(seconds, act)
    timer.daemon = True
    timer.start()
    return timer.cancel


class Waiting:
    """How long a process has compiled, or waited for another process that does. It reports that once, after `AFTER`.

    `clock` is the time in seconds, `later` calls a function after some seconds.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic, later: Any = later) -> None:
        self.clock, self.later = clock, later
        self._spent, self._reported, self._lock = 0.0, False, threading.Lock()

    @contextmanager
    def on(self, name: str) -> Iterator[None]:
        """Measure the time in which the code of a function is made."""
        began = self.clock()
        cancel = None if self._reported else self.later(max(AFTER - self._spent, 0.0), lambda: self._report(name))
        try:
            yield
        finally:
            if cancel is not None:
                cancel()
            took = self.clock() - began
            with self._lock:
                self._spent += took
            log.debug("%s: %.1f s until it was compiled", name, took)

    def _report(self, name: str) -> None:
        with self._lock:
            if self._reported:
                return
            self._reported = True
        log.info("code is being compiled, now that of %s; later processes load it from the disk", name)
        if sys.stderr is not None and sys.stderr.isatty():
            print(LINE, file=sys.stderr, flush=True)


WAITING = Waiting()
