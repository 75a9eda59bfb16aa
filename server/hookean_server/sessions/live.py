"""One session as the server knows it, awake or asleep."""

from __future__ import annotations

import asyncio
import hashlib
import json
import secrets
import time
from dataclasses import dataclass, field
from typing import Any

from hookean_server.sessions import wire
from hookean_server.sessions.process import SessionProcess

_DESCRIBED = ("revision", "iteration", "time", "residual", "status", "message", "particles", "undo", "redo", "playing",
              "solving", "energy", "units", "warnings", "scene_revision", "anchors_revision")  # fmt: skip


@dataclass(eq=False)
class Live:
    """One session as the server knows it. `described` is the status that its process sent last."""

    key: str
    label: str
    described: dict[str, Any]
    notes: list[str] = field(default_factory=list)  # on the file it was made of
    nonce: str = field(default_factory=lambda: secrets.token_hex(8))  # of its creation, another one for each
    made: asyncio.Event = field(default_factory=asyncio.Event)  # or not, whichever is settled
    gone: bool = False  # deleted, or never made; its key may be that of another one
    lock: asyncio.Lock = field(default_factory=asyncio.Lock)  # of edits, which have an order
    waking: asyncio.Lock = field(default_factory=asyncio.Lock)
    process: SessionProcess | None = None
    starting: bool = False  # whether a process is being started
    told: int = 0  # when its process gave the description [ns]
    playing: bool = False
    fast: bool = False
    going: str = "play"  # the command by which it plays
    watchers: int = 0
    frame: bytes = b""
    changes: bytes = b""  # to the frame before it, where they are fewer bytes
    frame_number: int = 0
    asked: bool = False
    scene: str = ""  # another one for each scene that it was given
    wiring: str = ""  # and for the forces that act, as edits have left them
    news: asyncio.Event = field(default_factory=asyncio.Event)
    used: float = field(default_factory=time.monotonic)
    losses: list[float] = field(default_factory=list)
    edits: int = 0
    folding: bool = False
    fold_at: int = 0  # how many edits there must be for it
    saving: bool = False  # whether a checkpoint is on its way
    view: dict[str, Any] = field(default_factory=dict)  # what is picked, and colours; see `shown`
    views: int = 0  # how often colours have changed

    def etag(self, described: dict[str, Any] | None = None) -> str:
        """The ETag of how it stands, or stood: creation, revision, and a digest of what else of it changes."""
        now = self.described if described is None else described
        shown = [now.get("iteration"), now.get("status"), now.get("message"), bool(now.get("playing"))]
        digest = hashlib.sha256(json.dumps([*shown, self.label, self.notes]).encode()).hexdigest()[:8]
        return f'"{self.nonce}-{now["revision"]}-{digest}"'

    @property
    def awake(self) -> bool:
        """Whether it has a process, or is about to."""
        return self.starting or self.process is not None

    @property
    def silence(self) -> float | None:
        """How long its process has sent nothing [s]; None where it has none."""
        return None if self.process is None else max(0.0, time.monotonic() - self.process.heard)

    @property
    def topology(self) -> str:
        """A tag of its topology."""
        return f"{self.scene}{self.wiring}"

    @property
    def in_use(self) -> bool:
        """Whether it plays or is watched."""
        return self.playing or self.watchers > 0

    @property
    def rests(self) -> bool:
        """Whether nobody uses it just now."""
        return not (self.in_use or self.lock.locked())

    def note(self, head: dict[str, Any]) -> dict[str, Any]:
        """Note how it stands by what its process answered, unless later news were first; returns how it stood then."""
        described = {name: head[name] for name in _DESCRIBED if name in head}
        then = {**self.described, **described}
        if not described or head.get("told", self.told) < self.told:
            return then
        before, self.described = self.described, then
        self.told, self.wiring = head.get("told", self.told), head.get("wiring", self.wiring)
        if not then.get("playing") and then.get("status") != "running":
            self.playing = False  # it came to an end; one that was just brought back is about to play on
        if any(then.get(name) != before.get(name) for name in ("status", "playing", "revision", "warnings")):
            self.tell()
        return then

    def use(self) -> None:
        """Somebody uses it: it is neither put to sleep nor forgotten for a while."""
        self.used = time.monotonic()

    def tell(self) -> None:
        """Wake everyone who waits for news."""
        self.news.set()
        self.news = asyncio.Event()

    def show(self, frame: bytes, *, changes: bool) -> None:
        """Its process has sent a frame, or the changes to the last one."""
        self.frame, self.changes = (wire.changed(self.frame, frame), frame) if changes else (frame, b"")
        self.frame_number += 1
        self.asked = False
        self.tell()

    def want_frame(self) -> None:
        """Ask the process for its next frame, once."""
        if self.process is not None and not self.asked:
            self.asked = True
            self.process.credit()


def summary(live: Live, described: dict[str, Any] | None = None) -> dict[str, Any]:
    """A session in the answers of routes, as it stands or as it was `described`."""
    now = live.described if described is None else described
    warnings = [*live.notes, *now.get("warnings", ())]
    names = {"key": live.key, "label": live.label, "etag": live.etag(now)}
    return {**names, **now, "warnings": warnings, "awake": live.process is not None}
