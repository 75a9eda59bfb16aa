"""All sessions of a server: kept in the store, awake in a process while somebody uses them, brought back when lost."""

from __future__ import annotations

import asyncio
import logging
import math
import secrets
import time
from collections.abc import Coroutine
from contextlib import suppress
from typing import Any

from hookean_server.http.logs import short_hash
from hookean_server.problems import Problem
from hookean_server.sessions import rows, upkeep
from hookean_server.sessions.conditions import Conditions, stale
from hookean_server.sessions.live import Live
from hookean_server.sessions.process import Gone, SessionProcess
from hookean_server.sessions.register import Deleted, Register
from hookean_server.settings import Settings
from hookean_server.store import Store

log = logging.getLogger("hookean.sessions")

ANSWER = 60.0  # seconds a process may take to answer; compiling a force for the first time takes a few
PAUSE = 1.5  # seconds it may take to pause, before it is killed and brought back paused
TICK = 15.0  # seconds between looks at what to put to sleep and to forget
UNSTORED = ("not-stored", "over-quota", "too-large")
LOSSES, WITHIN = 3, 60.0  # a session that loses its process so often in so many seconds stays down until it is used
MANY_EDITS = 400  # after so many those that cannot be taken back any more become part of the base
ALWAYS = Conditions()


class Manager(Register):
    """The sessions of one server. All methods run on the event loop, and take a session or its key."""

    def __init__(self, settings: Settings, store: Store) -> None:
        super().__init__(settings.sessions)
        self.settings, self.store = settings, store
        self.wanting: set[Live] = set()  # a place among those awake
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
            paused = {**described, "playing": False}
            live = Live(kept.key, kept.label, paused, kept.notes, kept.nonce, used=-math.inf)
            self.sessions[kept.key] = live
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

    async def put(
        self, key: str | None, body: bytes, label: str = "", notes: list[str] | None = None, when: Conditions = ALWAYS
    ) -> tuple[Live, dict[str, Any], bool]:
        """A session from a scene, or the scene of one that exists; how it stands then; whether it is new. `notes` on
        the file it came from stay until there are others; None: it came from none. Raises Problem."""
        key = key or secrets.token_hex(16)
        while (live := await self.settled(key)) is not None:
            with suppress(Deleted):  # meanwhile; this scene is the first of another one then
                return live, await self._replace(self.find(live), body, label, notes, when), False
        when.check(None)
        live = Live(key, label, {}, notes or [])
        with self.reserved(live):
            async with live.lock, live.waking:
                try:
                    process = await self._process(live)
                    described, base = await process.call("create", body, seconds=ANSWER, slug="invalid-scene")
                    await self.store.run(rows.put(live.key, label, base, described, live.notes, live.nonce))
                except BaseException:
                    self.end(live)
                    raise
            live.note(described)
            live.scene = secrets.token_hex(8)
        return live, live.described, True

    async def edit(
        self, key: str | Live, body: bytes, revision: int | None = None, when: Conditions = ALWAYS
    ) -> dict[str, Any]:
        """Make an edit; it is in the store when this returns how the session stands with it. Raises Problem.

        A client that leaves meanwhile does not stop it: an edit that was made is stored, or taken back.
        """
        work = self._spawn(self._edit(self.find(key), body, revision, when))
        found: dict[str, Any] = await asyncio.shield(work)
        return found

    async def _edit(self, live: Live, body: bytes, revision: int | None, when: Conditions) -> dict[str, Any]:
        async with self.held(live):
            when.check(live)
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
            found = live.note(described)
            if live.edits > max(MANY_EDITS, live.fold_at) and not live.folding:
                live.folding = True
                self._spawn(upkeep.fold(self, live))
        return found

    async def command(self, key: str | Live, do: str, when: Conditions = ALWAYS, **options: Any) -> dict[str, Any]:
        """play, relax, pause or step; how the session stands then."""
        live = self.find(key)
        if do == "pause":
            when.check(live)
            return await self._pause(live)
        async with self.held(live):
            await self._awake(live)
            revision = when.check(live)
            live.playing, live.going, live.fast = do in ("play", "relax"), do, bool(options.get("fast"))
        seconds = self.settings.solve_seconds if do == "step" else ANSWER
        _, described, _ = await self._ask(live, do, seconds=seconds, revision=revision, **options)
        found = live.note(described)
        if live.playing:
            live.playing = live.playing and described["playing"]
        return found

    async def export(self, key: str | Live, form: str, arrays: str = "list") -> tuple[dict[str, Any], bytes]:
        """The session in some format; its head has the media `type`."""
        live = self.find(key)
        _, head, body = await self._ask(live, "export", seconds=ANSWER, format=form, arrays=arrays)
        live.use()
        return head, body

    async def branch(self, key: str | Live, new: str | None, label: str, when: Conditions = ALWAYS) -> Live:
        """Another session that goes on from where this one is, paused."""
        live = self.find(key)
        other = Live(new or secrets.token_hex(16), label or live.label, {}, live.notes)
        with self.reserved(other):
            async with self.held(live):
                when.check(live)
                _, described, base = await self._ask(live, "save", seconds=ANSWER)
            other.notes = live.notes
            await self.store.run(rows.put(other.key, other.label, base, described, other.notes, other.nonce))
            other.described = {**described, "playing": False}
        return other

    async def delete(self, key: str | Live, when: Conditions = ALWAYS) -> None:
        """Forget a session and end its process."""
        live = self.find(key)
        when.check(live)
        if live.lock.locked():
            await self._pause(live)  # what holds it may hang
        async with self.held(live):
            when.check(live)
            await self.store.run(rows.delete(live.key))
            self.drop(live)

    async def watch(self, key: str | Live) -> Live:
        """A session whose frames somebody wants to see: awake, with one watcher more; raises Problem."""
        live = self.find(key)
        live.watchers += 1
        try:
            async with self.held(live):
                await self._awake(live)
        except BaseException:
            self.unwatch(live)
            raise
        return live

    def unwatch(self, live: Live) -> None:
        """A watcher has left; until now the session was in use."""
        live.watchers -= 1
        live.use()

    # processes

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
            live.frame, live.frame_number, live.asked = body, live.frame_number + 1, False
            live.tell()
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

    async def _pause(self, live: Live) -> dict[str, Any]:
        live.playing = False
        process = live.process
        if process is not None:
            try:
                described, _ = await process.call("pause", seconds=PAUSE)
                live.note(described)
            except Problem:
                live.described = {**live.described, "playing": False}
        return live.described

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

    async def _replace(
        self, live: Live, body: bytes, label: str, notes: list[str] | None, when: Conditions
    ) -> dict[str, Any]:
        async with self.held(live):
            when.check(live)
            process, described, base = await self._ask(live, "replace", body, seconds=ANSWER, slug="invalid-scene")
            if not described.pop("same", False):
                notes = live.notes if notes is None else notes
                async with live.waking:
                    try:
                        kept = rows.put(live.key, label or live.label, base, described, notes, live.nonce)
                        await self.store.run(kept)
                    except Problem:
                        await self._revert(live, process)
                        raise
                live.notes = notes
                live.scene, live.wiring = secrets.token_hex(8), described.get("wiring", "")
                live.edits = 0
                live.tell()  # its process may have told the new revision before the new topology was known
            live.label = label or live.label
            return live.note(described)

    async def _revert(self, live: Live, process: SessionProcess) -> None:
        """What was done last could not be stored: the session goes on as if it had never been asked."""
        try:
            described, _ = await process.call("revert", seconds=ANSWER)
            live.note(described)
        except Problem:
            self.end(live)  # it comes back as the store has it

    # bookkeeping

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
            await upkeep.forget(self, TICK)


_KEPT = ("revision", "iteration", "status", "message", "particles", "created")
