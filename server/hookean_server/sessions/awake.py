"""Sessions awake: each in a process of its own, started from the store, put to sleep, and brought back when lost."""

from __future__ import annotations

import asyncio
import logging
import secrets
import time
from collections.abc import Coroutine
from typing import Any

from hookean_server.http.logs import short_hash
from hookean_server.problems import Problem
from hookean_server.sessions import rows
from hookean_server.sessions.conditions import stale
from hookean_server.sessions.live import Live
from hookean_server.sessions.process import Gone, SessionProcess
from hookean_server.sessions.register import Deleted, Register
from hookean_server.settings import Settings
from hookean_server.store import Store

log = logging.getLogger("hookean.sessions")

ANSWER = 60.0  # seconds a process may take to answer; compiling a force for the first time takes a few
PAUSE = 1.5  # seconds it may take to pause, before it is killed and brought back paused
UNSTORED = ("not-stored", "over-quota", "too-large")
LOSSES, WITHIN = 3, 60.0  # a session that loses its process so often in so many seconds stays down until it is used


class Awake(Register):
    """Sessions and their processes, as many at a time as settings allow."""

    def __init__(self, settings: Settings, store: Store) -> None:
        super().__init__(settings.sessions)
        self.settings, self.store = settings, store
        self.wanting: set[Live] = set()  # a place among those awake
        self.restarts = 0
        self.closing = False
        self._tasks: set[asyncio.Task[None]] = set()

    async def _ask(
        self, live: Live, do: str, body: bytes = b"", *, seconds: float, **head: Any
    ) -> tuple[SessionProcess, dict[str, Any], bytes]:
        """What the session's process answers, and which one it was; one that ends meanwhile is brought back and asked
        once more."""
        for last in (False, True):
            try:
                process = await self._awake(live)
                return process, *await process.call(do, body, seconds=seconds, **head)
            except Gone:
                if live.gone:
                    raise Deleted from None
                if last:
                    raise
            except Problem as problem:
                raise stale(live, problem.detail) if problem.slug == "stale-revision" else problem from None
        raise AssertionError

    async def _awake(self, live: Live) -> SessionProcess:
        """The session's process, started from the store where there is none."""
        async with live.waking:
            if live.process is not None and not live.process.lost:
                return live.process
            try:
                return await self._restored(live)
            except BaseException:
                self.end(live, playing=live.playing)  # half restored it is of no use
                raise

    async def _restored(self, live: Live) -> SessionProcess:
        found: rows.Stored | None = None if live.gone else await self.store.run(rows.load(live.key))
        if found is None or live.gone:
            raise Deleted
        process = await self._process(live)
        sizes = [len(part) for part in (found.base, found.state, *found.edits)]
        body = b"".join((found.base, found.state, *found.edits))
        described, _ = await process.call(
            "restore", body, seconds=ANSWER, sizes=sizes, revisions=found.revisions, revision=found.revision
        )
        live.edits = len(found.edits)
        live.scene = live.scene or secrets.token_hex(8)
        live.note(described)
        live.tell()  # who watches has frames of the last process, which may have been further
        return process

    async def _process(self, live: Live) -> SessionProcess:
        """A process for a session, which counts among those awake from now on."""
        self.wanting.add(live)
        try:
            await self._make_room()
        finally:
            self.wanting.discard(live)
        live.starting = True
        try:
            return await self._started(live)
        finally:
            live.starting = False

    async def _make_room(self) -> None:
        """Put sessions to sleep until one more may be awake; raises `busy`."""
        while not self.closing:
            awake = [live for live in (*self.sessions.values(), *self.making.values()) if live.awake]
            if len(awake) < self.settings.awake:
                return
            # one that wants a process itself would wait for us
            unused = [other for other in awake if not (other.in_use or other in self.wanting)]
            if not unused:
                break
            other = min(unused, key=lambda o: (o.lock.locked(), o.used))
            try:
                async with asyncio.timeout(ANSWER) as patience, other.lock, other.waking:
                    patience.reschedule(None)
                    if not other.in_use:  # who wants it meanwhile waits, and wakes it again
                        await self._sleep(other, PAUSE, unsaved=False)
            except TimeoutError:
                break
        if self.closing:
            raise Problem("shutting-down", "The service is shutting down; start it again and repeat the request.")
        said = f"{len(awake)} sessions are running or being watched; pause one, or retry later."
        raise Problem("busy", said, headers={"retry-after": "5"})

    async def _started(self, live: Live) -> SessionProcess:
        loop = asyncio.get_running_loop()
        process: SessionProcess | None = None  # until it is ours, and if it never is

        def on_event(head: dict[str, Any], body: bytes) -> None:
            if not loop.is_closed():
                loop.call_soon_threadsafe(self._event, live, process, head, body)

        process = await SessionProcess.begun(self.settings.worker_memory, on_event)
        if live.gone:
            process.kill()
            raise Deleted
        live.process, live.asked, live.frame, live.saving = process, False, b"", False
        return process

    def _event(self, live: Live, process: SessionProcess | None, head: dict[str, Any], body: bytes) -> None:
        if process is None or live.process is not process:
            return
        event = head["event"]
        if event == "frame":
            live.show(body, changes=head["changes"])
        elif event == "lost":
            live.process = None
            live.asked = False
            if not (self.closing or live.gone):
                self._spawn(self._bring_back(live))
        else:
            live.note(head)
            if event == "checkpoint":
                live.saving = False
                self._checkpoint(live, head, body, process)
            elif head.get("unsaved") and not live.saving:
                live.saving = self.store.budget.allows(live.key, resting=not head["playing"])
                if live.saving:
                    process.keep()

    def _checkpoint(self, live: Live, head: dict[str, Any], state: bytes, process: SessionProcess) -> None:
        self.store.budget.spend(len(state))
        stored = self.store.submit(rows.checkpoint(live.key, head, state))
        stored.add_done_callback(lambda done: process.unstored() if done.exception() else None)

    async def _bring_back(self, live: Live) -> None:
        """A new process for a session that lost its own, if somebody is using it."""
        self.restarts += 1
        log.info("process of a session ended", extra={"fields": {"session": short_hash(live.key)}})
        now = time.monotonic()
        live.losses = [t for t in live.losses if now - t < WITHIN] + [now]
        if len(live.losses) > LOSSES:
            live.playing = False
            said = f"Its process ended {len(live.losses)} times in a minute; it is paused at its last checkpoint."
            live.described = {**live.described, "status": "stalled", "playing": False, "message": said}
            live.tell()
            return
        if not (live.playing or live.watchers):
            return
        try:
            async with self.held(live):
                process = await self._awake(live)
            if live.playing:
                described, _ = await process.call(live.going, seconds=ANSWER, fast=live.fast)
                live.note(described)
        except Problem:
            live.tell()

    async def _sleep(self, live: Live, seconds: float, *, unsaved: bool = True) -> None:
        """Checkpoint a session and end its process. Where it cannot be stored, `unsaved` decides whether to end it all
        the same; else raises Problem."""
        process = live.process
        if process is None:
            return
        try:
            described, state = await process.call("checkpoint", seconds=seconds)
            if state:
                self.store.budget.spend(len(state))
                await self.store.run(rows.checkpoint(live.key, described, state))
            live.note({**described, "playing": False})
        except Problem as problem:
            if problem.slug in UNSTORED and not unsaved:
                raise
        if live.process is process:
            self.end(live)

    def end(self, live: Live, *, playing: bool = False) -> None:
        """End the process of a session; `playing`: it is to play on in another one."""
        process, live.process = live.process, None
        live.playing = playing
        if process is not None:
            process.kill()

    def drop(self, live: Live) -> None:
        """A session is no longer in the store: its process ends, and its watchers are notified."""
        self.forget(live)
        self.end(live)
        live.tell()

    def _spawn(self, work: Coroutine[Any, Any, Any]) -> asyncio.Task[Any]:
        task = asyncio.create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._done)
        return task

    def _done(self, task: asyncio.Task[Any]) -> None:
        self._tasks.discard(task)
        if not task.cancelled():
            task.exception()  # whoever waits for it hears of it
