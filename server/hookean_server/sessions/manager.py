"""All sessions of a server: kept in the store, awake in a process while somebody uses them, brought back when lost."""

from __future__ import annotations

import asyncio
import logging
import secrets
import time
from collections.abc import Coroutine, Iterator
from contextlib import contextmanager, suppress
from typing import Any

from hookean_server.logs import short_hash
from hookean_server.problems import Problem
from hookean_server.sessions import rows
from hookean_server.sessions.live import Live
from hookean_server.sessions.process import Gone, SessionProcess
from hookean_server.settings import Settings
from hookean_server.store import Store

log = logging.getLogger("hookean.sessions")

ANSWER = 60.0  # seconds a process may take to answer; compiling a force for the first time takes a few
PAUSE = 1.5  # seconds it may take to pause, before it is killed and brought back paused
TICK = 15.0  # seconds between looks at what to put to sleep and to forget
LOSSES, WITHIN = 3, 60.0  # a session that loses its process so often in so many seconds stays down until it is used
MANY_EDITS = 400  # after so many the store gets a new base


class Manager:
    """The sessions of one server. All methods run on the event loop."""

    def __init__(self, settings: Settings, store: Store) -> None:
        self.settings, self.store = settings, store
        self.sessions: dict[str, Live] = {}
        self.restarts = 0
        self.closing = False
        self.frames_sent = self.frames_skipped = 0
        self._loop: asyncio.AbstractEventLoop | None = None
        self._ticking: asyncio.Task[None] | None = None
        self._tasks: set[asyncio.Task[None]] = set()

    async def start(self) -> None:
        """Bring back what the store has, paused."""
        self._loop = asyncio.get_running_loop()
        for kept in await self.store.run(rows.listed()):
            described = {name: getattr(kept, name) for name in _KEPT}
            self.sessions[kept.key] = Live(kept.key, kept.label, {**described, "playing": False}, kept.notes)
        self._ticking = asyncio.create_task(self._tick())

    async def close(self) -> None:
        """Checkpoint everything that is awake, then end its processes."""
        self.closing = True
        if self._ticking is not None:
            self._ticking.cancel()
        awake = [live for live in self.sessions.values() if live.process is not None]
        await asyncio.gather(*(self._sleep(live, 1.0) for live in awake), return_exceptions=True)
        for task in self._tasks:
            task.cancel()
        for live in self.sessions.values():
            live.tell()

    # what routes call

    def find(self, key: str) -> Live:
        """The session of a key; raises `not-found`."""
        if key not in self.sessions:
            raise Problem("not-found", "There is no session of this key; GET /v1/sessions lists those there are.")
        live = self.sessions[key]
        live.used = time.monotonic()
        return live

    async def put(
        self, key: str | None, body: bytes, label: str = "", notes: list[str] | None = None
    ) -> tuple[Live, bool]:
        """A session from a scene, or the scene of one that exists; whether it is new. `notes` on the file it came from
        stay until there are others; None: it came from none. Raises Problem."""
        if key is not None and key in self.sessions:
            return await self._replace(self.find(key), body, label, notes), False
        with self._room():
            live = Live(key or secrets.token_hex(16), label, {}, notes or [])
            # its place is taken at once: a second request with the same key waits for the first
            self.sessions[live.key] = live
            async with live.lock, live.waking:
                try:
                    process = await self._process(live)
                    described, base = await process.call("create", body, seconds=ANSWER, slug="invalid-scene")
                    await self.store.run(rows.put(live.key, label, base, described, live.notes))
                except BaseException:
                    self.sessions.pop(live.key, None)
                    self._end(live)
                    raise
            self._heard(live, described)
            live.scene = secrets.token_hex(8)
            return live, True

    async def edit(self, key: str, body: bytes, revision: int | None = None) -> dict[str, Any]:
        """Make an edit; it is in the store when this returns. Raises Problem.

        A client that leaves meanwhile does not stop it: an edit that was made is stored, or taken back.
        """
        work = self._spawn(self._edit(self.find(key), body, revision))
        return await asyncio.shield(work)

    async def _edit(self, live: Live, body: bytes, revision: int | None) -> dict[str, Any]:
        async with live.lock:
            process, described, made = await self._ask(
                live, "edit", body, seconds=ANSWER, revision=revision, slug="invalid-input"
            )
            sets = described.pop("sets", "")
            async with live.waking:  # one that is lost meanwhile comes back with this edit
                try:
                    live.edits = await self.store.run(rows.edit(live.key, described["revision"], sets, made))
                except Problem:
                    await self._revert(live, process)
                    raise
            self._heard(live, described)
            if live.edits > MANY_EDITS:
                with suppress(Problem):  # the edit is stored; the next one tries again
                    await self._rebase(live, process)
        return live.described

    async def command(self, key: str, do: str, **options: Any) -> dict[str, Any]:
        """play, relax, pause or step; how the session stands then."""
        live = self.find(key)
        if do == "pause":
            return await self._pause(live)
        async with live.lock:
            await self._awake(live)
            live.playing, live.going, live.fast = do in ("play", "relax"), do, bool(options.get("fast"))
        seconds = self.settings.solve_seconds if do == "step" else ANSWER
        _, described, _ = await self._ask(live, do, seconds=seconds, **options)
        self._heard(live, described)
        if live.playing:
            live.playing = live.playing and described["playing"]
        return live.described

    async def export(self, key: str, form: str, arrays: str = "list") -> tuple[dict[str, Any], bytes]:
        """The session in some format; its head has the media `type`."""
        _, head, body = await self._ask(self.find(key), "export", seconds=ANSWER, format=form, arrays=arrays)
        return head, body

    async def branch(self, key: str, new: str | None, label: str) -> Live:
        """Another session that goes on from where this one is, paused."""
        live = self.find(key)
        if new is not None and new in self.sessions:
            raise Problem("key-taken", "There is a session of this key already; choose another, or none.")
        with self._room():
            async with live.lock:
                process = await self._awake(live)
                described, base = await process.call("save", seconds=ANSWER)
            paused = {**described, "playing": False}
            other = Live(new or secrets.token_hex(16), label or live.label, paused, live.notes)
            await self.store.run(rows.put(other.key, other.label, base, described, other.notes))
            self.sessions[other.key] = other
        return other

    async def delete(self, key: str) -> None:
        """Forget a session and end its process."""
        live = self.find(key)
        if live.lock.locked():
            await self._pause(live)  # what holds it may hang
        async with live.lock:
            await self.store.run(rows.delete(key))
            self.sessions.pop(key, None)
            self._end(live)
            live.tell()

    async def watch(self, key: str) -> Live:
        """A session whose frames somebody wants to see: awake, with one watcher more; raises Problem."""
        live = self.find(key)
        live.watchers += 1
        try:
            async with live.lock:
                await self._awake(live)
        except BaseException:
            live.watchers -= 1
            raise
        return live

    # processes

    async def _ask(
        self, live: Live, do: str, body: bytes = b"", *, seconds: float, **head: Any
    ) -> tuple[SessionProcess, dict[str, Any], bytes]:
        """What the session's process answers, and which one it was; one that ends meanwhile is brought back and asked
        once more."""
        for last in (False, True):
            process = await self._awake(live)
            try:
                return process, *await process.call(do, body, seconds=seconds, **head)
            except Gone:
                if last:
                    raise
        raise AssertionError

    async def _awake(self, live: Live) -> SessionProcess:
        """The session's process, started from the store where there is none."""
        async with live.waking:
            if live.process is not None and not live.process.lost:
                return live.process
            return await self._restored(live)

    async def _restored(self, live: Live) -> SessionProcess:
        if live.key not in self.sessions:
            raise Problem("not-found", "This session has been deleted.")
        found = await self.store.run(rows.load(live.key))
        if found is None:
            raise Problem("not-found", "This session has been deleted.")
        base, state, edits, revisions, _ = found
        process = await self._process(live)
        sizes = [len(part) for part in (base, state, *edits)]
        body = b"".join((base, state, *edits))
        described, _ = await process.call("restore", body, seconds=ANSWER, sizes=sizes, revisions=revisions)
        live.edits = len(edits)
        live.scene = live.scene or secrets.token_hex(8)
        self._heard(live, described)
        return process

    async def _process(self, live: Live) -> SessionProcess:
        if self.closing:
            raise Problem("shutting-down", "The service is shutting down; start it again and repeat the request.")
        while len(awake := [other for other in self.sessions.values() if other.process is not None]) >= (
            self.settings.awake
        ):
            resting = [other for other in awake if other.rests]
            if not resting:
                said = f"{len(awake)} sessions are running or being watched; pause one, or come back later."
                raise Problem("busy", said, headers={"retry-after": "5"})
            other = min(resting, key=lambda o: o.used)
            async with other.lock:  # who wants it meanwhile waits, and wakes it again
                await self._sleep(other, PAUSE, unsaved=False)
        loop = asyncio.get_running_loop()

        def on_event(head: dict[str, Any], body: bytes) -> None:
            if not loop.is_closed():
                loop.call_soon_threadsafe(self._event, live, process, head, body)

        process = await asyncio.to_thread(SessionProcess, self.settings.worker_memory, on_event)
        live.process, live.asked, live.frame = process, False, b""
        return process

    def _event(self, live: Live, process: SessionProcess, head: dict[str, Any], body: bytes) -> None:
        if live.process is not process:
            return
        event = head["event"]
        if event == "frame":
            live.frame, live.frame_number, live.asked = body, live.frame_number + 1, False
            live.tell()
        elif event == "lost":
            live.process = None
            live.asked = False
            if not self.closing and live.key in self.sessions:
                self._spawn(self._bring_back(live))
        else:
            self._heard(live, head)
            if event == "checkpoint":
                stored = self.store.submit(rows.checkpoint(live.key, head, body))
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
            async with live.lock:
                process = await self._awake(live)
            if live.playing:
                described, _ = await process.call(live.going, seconds=ANSWER, fast=live.fast)
                self._heard(live, described)
        except Problem:
            live.tell()

    async def _pause(self, live: Live) -> dict[str, Any]:
        live.playing = False
        process = live.process
        if process is not None:
            try:
                described, _ = await process.call("pause", seconds=PAUSE)
                self._heard(live, described)
            except Problem:
                live.described = {**live.described, "playing": False}
        return live.described

    async def _sleep(self, live: Live, seconds: float, *, unsaved: bool = True) -> None:
        """Checkpoint a session and end its process. Where it cannot be stored, `unsaved` says whether to end it all the
        same; else raises Problem."""
        process = live.process
        if process is None:
            return
        try:
            described, state = await process.call("checkpoint", seconds=seconds)
            await self.store.run(rows.checkpoint(live.key, described, state))
            self._heard(live, {**described, "playing": False})
        except Problem as problem:
            if problem.slug == "not-stored" and not unsaved:
                raise
        self._end(live)

    def _end(self, live: Live) -> None:
        process, live.process = live.process, None
        live.playing = False
        if process is not None:
            process.kill()

    async def _replace(self, live: Live, body: bytes, label: str, notes: list[str] | None) -> Live:
        async with live.lock:
            process = await self._awake(live)
            described, base = await process.call("replace", body, seconds=ANSWER, slug="invalid-scene")
            if not described.pop("same", False):
                notes = live.notes if notes is None else notes
                async with live.waking:
                    try:
                        await self.store.run(rows.put(live.key, label or live.label, base, described, notes))
                    except Problem:
                        await self._revert(live, process)
                        raise
                live.notes = notes
                live.scene, live.wiring = secrets.token_hex(8), described.get("wiring", "")
                live.edits = 0
                live.tell()  # its process may have told the new revision before the new topology was known
            live.label = label or live.label
            self._heard(live, described)
        return live

    async def _revert(self, live: Live, process: SessionProcess) -> None:
        """What was done last could not be stored: the session goes on as if it had never been asked."""
        try:
            described, _ = await process.call("revert", seconds=ANSWER)
            self._heard(live, described)
        except Problem:
            self._end(live)  # it comes back as the store has it

    async def _rebase(self, live: Live, process: SessionProcess) -> None:
        described, base = await process.call("save", seconds=ANSWER)
        await self.store.run(rows.rebase(live.key, base, described["revision"]))
        live.edits = 0

    # bookkeeping

    def _heard(self, live: Live, head: dict[str, Any]) -> None:
        described = {name: head[name] for name in _DESCRIBED if name in head}
        if not described:
            return
        said = {name: live.described.get(name) for name in ("status", "playing", "revision", "warnings")}
        live.described = {**live.described, **described}
        live.wiring = head.get("wiring", live.wiring)
        if not live.described.get("playing") and live.described.get("status") != "running":
            live.playing = False  # it came to an end; one that was just brought back is about to play on
        if any(live.described.get(name) != value for name, value in said.items()):
            live.tell()

    @contextmanager
    def _room(self) -> Iterator[None]:
        if len(self.sessions) >= self.settings.sessions:
            said = f"There are {len(self.sessions)} sessions, as many as are kept; delete one that is not needed."
            raise Problem("session-limit", said, headers={"retry-after": "60"})
        yield

    def _spawn(self, work: Coroutine[Any, Any, Any]) -> asyncio.Task[Any]:
        task = asyncio.create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._done)
        return task

    def _done(self, task: asyncio.Task[Any]) -> None:
        self._tasks.discard(task)
        if not task.cancelled():
            task.exception()  # whoever waits for it hears of it

    async def _tick(self) -> None:
        """Put to sleep what nobody uses, forget what nobody used for long."""
        while True:
            await asyncio.sleep(TICK)
            now = time.monotonic()
            awake = [live for live in self.sessions.values() if live.process is not None]
            for live in awake:
                if live.rests and now - live.used > self.settings.sleep_seconds:
                    async with live.lock:
                        with suppress(Problem):
                            await self._sleep(live, PAUSE, unsaved=False)
            used = [live.key for live in awake if live.playing or live.watchers or now - live.used < TICK]
            try:
                gone = await self.store.run(rows.age(TICK, self.settings.session_seconds, used))
            except Problem:
                continue
            for key in gone:
                if key in self.sessions:
                    self._end(self.sessions.pop(key))


_DESCRIBED = ("revision", "iteration", "time", "residual", "status", "message", "particles", "undo", "redo", "playing",
              "energy", "units", "warnings")  # fmt: skip
_KEPT = ("revision", "iteration", "status", "message", "particles", "created")
