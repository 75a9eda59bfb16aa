"""One session as the server knows it, awake or asleep."""

from __future__ import annotations

import asyncio
import time
from dataclasses import dataclass, field
from typing import Any

from hookean_server.sessions.process import SessionProcess


@dataclass(eq=False)
class Live:
    """One session as the server knows it. `described` is how it stood when its process last said so."""

    key: str
    label: str
    described: dict[str, Any]
    notes: list[str] = field(default_factory=list)  # on the file it was made of
    lock: asyncio.Lock = field(default_factory=asyncio.Lock)  # of edits, which have an order
    waking: asyncio.Lock = field(default_factory=asyncio.Lock)
    process: SessionProcess | None = None
    playing: bool = False
    fast: bool = False
    going: str = "play"  # the command by which it plays
    watchers: int = 0
    frame: bytes = b""
    frame_number: int = 0
    asked: bool = False
    scene: str = ""  # another one for each scene that it was given
    wiring: str = ""  # and for the forces that act, as edits have left them
    news: asyncio.Event = field(default_factory=asyncio.Event)
    used: float = field(default_factory=time.monotonic)
    losses: list[float] = field(default_factory=list)
    edits: int = 0

    @property
    def topology(self) -> str:
        """A tag of its topology."""
        return f"{self.scene}{self.wiring}"

    @property
    def rests(self) -> bool:
        """Whether nobody uses it just now."""
        return not (self.playing or self.watchers or self.lock.locked())

    def tell(self) -> None:
        """Wake everyone who waits for news."""
        self.news.set()
        self.news = asyncio.Event()

    def want_frame(self) -> None:
        """Ask the process for its next frame, once."""
        if self.process is not None and not self.asked:
            self.asked = True
            self.process.credit()


def summary(live: Live) -> dict[str, Any]:
    """A session in the answers of routes."""
    warnings = [*live.notes, *live.described.get("warnings", ())]
    awake = live.process is not None
    return {"key": live.key, "label": live.label, **live.described, "warnings": warnings, "awake": awake}
