"""All sessions of a server: kept in the store, awake in a process while somebody uses them, brought back when lost."""

from __future__ import annotations

import asyncio
import math
import secrets
import time
from contextlib import suppress
from typing import Any

from hookean_server.problems import Problem
from hookean_server.sessions import rows, upkeep
from hookean_server.sessions.awake import ANSWER, PAUSE, Awake
from hookean_server.sessions.conditions import Conditions
from hookean_server.sessions.live import Live
from hookean_server.sessions.process import SessionProcess
from hookean_server.sessions.register import Deleted
from hookean_server.settings import Settings
from hookean_server.store import Store

TICK = 15.0  # seconds between looks at what to put to sleep and to forget
MANY_EDITS = 400  # after so many those that cannot be taken back any more become part of the base
ALWAYS = Conditions()


class Manager(Awake):
    """The sessions of one server. All methods run on the event loop, and take a session or its key."""

    def __init__(self, settings: Settings, store: Store) -> None:
        super().__init__(settings, store)
        self.frames_sent = self.frames_skipped = 0
        self._loop: asyncio.AbstractEventLoop | None = None
        self._ticking: asyncio.Task[None] | None = None

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

    async def export(
        self, key: str | Live, form: str, arrays: str = "list", view: dict[str, Any] | None = None
    ) -> tuple[dict[str, Any], bytes]:
        """The session in some format, a .hookean file with a view; its head has the media `type`."""
        live = self.find(key)
        _, head, body = await self._ask(live, "export", seconds=ANSWER, format=form, arrays=arrays, view=view or {})
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

    async def rename(self, key: str | Live, label: str, when: Conditions = ALWAYS) -> Live:
        """Give a session another name to display; its model and revision stay."""
        live = self.find(key)
        async with self.held(live):
            when.check(live)
            await self.store.run(rows.rename(live.key, label))
            live.label = label
        return live

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
