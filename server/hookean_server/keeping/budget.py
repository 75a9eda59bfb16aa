"""How much may be written to disk while simulations run: bytes by the clock, of all writers together."""

from __future__ import annotations

import time
from collections.abc import Callable

RATE = 17e6 / 60.0  # bytes a second, all sessions and jobs together: with what one write is ahead 20 MB a minute
DEBT = 60e6  # bytes that shapes at rest may be ahead of that
FORGOTTEN = 2.0  # seconds after which who asked no more does not wait
OVERHEAD = 12 * 4096  # bytes of pages that any write changes


class Budget:
    """An allowance that grows by `rate` bytes a second. It may be overdrawn by one write, and then it is repaid before
    the next: in any time t at most `rate` t and one write. Shapes at rest may go `DEBT` further."""

    def __init__(self, rate: float = RATE, clock: Callable[[], float] = time.monotonic) -> None:
        self.rate, self.clock = rate, clock
        self._owed = 0.0
        self._at = clock()
        self._waiting: dict[str, tuple[float, float]] = {}  # since when, and when it was last asked for

    def spend(self, size: int) -> None:
        """A value of `size` bytes is written: once to the log, once to the file."""
        self._owed = self.owed + 2.0 * size * 4096 / 4072 + OVERHEAD

    @property
    def owed(self) -> float:
        """Bytes that were written ahead of the allowance."""
        now = self.clock()
        self._owed = max(0.0, self._owed - self.rate * max(0.0, now - self._at))
        self._at = now
        return self._owed

    def allows(self, key: str, *, resting: bool = False) -> bool:
        """Whether the one of this key may write now. Of those that ask again and again, the one that has waited longest
        is next; what has come to rest need not wait for them."""
        now = self.clock()
        since, _ = self._waiting.get(key, (now, now))
        self._waiting[key] = since, now
        if self.owed > (DEBT if resting else 0.0):
            return False
        self._waiting = {k: (a, b) for k, (a, b) in self._waiting.items() if now - b < FORGOTTEN}
        if not resting and min(self._waiting, key=lambda k: self._waiting[k][0]) != key:
            return False
        del self._waiting[key]
        return True
