"""What a task gives and gets: its answer, the times of its parts, and whether it should stop."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field

Cancelled = Callable[[], bool]


@dataclass
class Done:
    """A finished task: its answer, and how long its parts took [s]."""

    body: bytes
    media_type: str = "application/json"
    headers: dict[str, str] = field(default_factory=dict)
    timing: dict[str, float] = field(default_factory=dict)


class Clock:
    """Times the parts of a task for the header Server-Timing."""

    def __init__(self) -> None:
        self.parts: dict[str, float] = {}
        self._last = time.perf_counter()

    def lap(self, name: str) -> None:
        """The time since the last lap was spent on `name`."""
        now = time.perf_counter()
        self.parts[name] = self.parts.get(name, 0.0) + now - self._last
        self._last = now
