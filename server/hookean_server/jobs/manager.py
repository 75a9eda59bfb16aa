"""All jobs of a server: created, run, reported, cancelled, restored after a restart, deleted."""

from __future__ import annotations

import asyncio
import hashlib
import json
import logging
import secrets
import time
from collections import Counter, OrderedDict
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from typing import Any

from hookean_server.jobs import rows
from hookean_server.jobs.cluster import Cluster
from hookean_server.jobs.executors import Executor, Local
from hookean_server.jobs.runner import PROGRESS, Live, Runner
from hookean_server.problems import Problem
from hookean_server.settings import Settings
from hookean_server.store import Store
from hookean_server.workers.pool import Job, Pool

log = logging.getLogger("hookean.jobs")
TICK = 15.0  # seconds between looks at what to forget
FINAL = ("done", "failed", "cancelled")


class Jobs:
    """The jobs of one server. All methods run on the event loop."""

    def __init__(self, settings: Settings, store: Store, pool: Pool) -> None:
        self.settings, self.store, self.pool = settings, store, pool
        self.jobs: OrderedDict[str, Live] = OrderedDict()
        self.local = Local(settings)
        self.executor: Executor = Cluster(settings) if settings.dask else self.local
        self.coming = 0
        self._runner = Runner(settings, store, self.local, self.executor)
        self._ticking: asyncio.Task[None] | None = None
        self._keys: dict[str, tuple[asyncio.Lock, Counter[str]]] = {}
        self._used: set[str] = set()

    async def start(self) -> None:
        """Bring back what the store has; what was not finished goes on."""
        for kept in await self.store.run(rows.listed()):
            live = Live(kept, event=kept.event, ended=kept.status in FINAL, cancelled=kept.status == "cancelled")
            self.jobs[kept.id] = live
            if kept.kind != "sweep" and not live.ended:
                await self._recall(live)
            if not live.ended:
                live.task = asyncio.create_task(self._run(live))
        self._ticking = asyncio.create_task(self._tick())

    async def close(self) -> None:
        """Stop; what is not finished goes on at the next start."""
        tasks = [live.task for live in self.jobs.values() if live.task is not None]
        for task in [*tasks, *([self._ticking] if self._ticking else [])]:
            task.cancel()
        self.local.pool.stop()
        await asyncio.gather(*tasks, return_exceptions=True)
        for live in self.jobs.values():
            live.tell()
        await asyncio.gather(self.local.close(), *([self.executor.close()] if self.executor is not self.local else []))

    # what routes call

    def find(self, job: str) -> Live:
        """The job of an id; raises `not-found`."""
        if job not in self.jobs:
            raise Problem("not-found", "There is no job with this id; GET /v1/jobs lists all.")
        self._used.add(job)
        return self.jobs[job]

    def states(self) -> dict[str, int]:
        """How many jobs are in each state."""
        found = dict.fromkeys((*rows.UNFINISHED, *FINAL), 0)
        for live in list(self.jobs.values()):
            found[live.kept.status] += 1
        return found

    @property
    def busy(self) -> bool:
        """Whether any job is not at its end. From any thread."""
        return any(not live.ended for live in list(self.jobs.values()))

    async def add(self, body: bytes, key: str, kind: str = "") -> tuple[str, bytes, bool]:
        """A job of a request, of kind `design` if its body is a problem: its address, its description and whether both
        were given before, to the same request under the same Idempotency-Key. It is in the store when this returns.
        Raises Problem."""
        if not key:
            return *(await self._add(body, kind, "", "")), False
        key = hashlib.sha256(f"POST /v1/{kind or 'jobs'}\n{key}".encode()).hexdigest()
        digest = await asyncio.to_thread(lambda: hashlib.sha256(body).hexdigest())
        async with self._alone(key):
            before: rows.Answer | None = await self.store.run(rows.answered(key))
            if before is None:
                return *(await self._add(body, kind, key, digest)), False
            if before.digest != digest:
                said = "This Idempotency-Key was used with another body before; use another key for another request."
                raise Problem("key-reused", said)
            return before.location, before.body, True

    async def cancel(self, job: str) -> None:
        """End a job; its finished items stay. Nothing happens where it has ended already."""
        live = self.find(job)
        if live.ended or live.ending or live.cancelled:
            return
        live.cancelled = True
        try:
            await self.store.run(rows.status(job, "cancelled", ""))
        except Problem:
            live.cancelled = False
            raise
        if live.ending:
            return  # as cancelled
        if live.solving is not None:
            live.solving.left.set()
        elif live.task is not None:
            live.task.cancel()

    async def pages(self, live: Live, most: int = 500) -> AsyncIterator[list[rows.Row]]:
        """The finished items in the order of their numbers, some at a time."""
        after = -1
        while True:
            found: list[rows.Row] = await self.store.run(rows.rows(live.kept.id, after, most))
            yield found
            if len(found) < most:
                return
            after = found[-1].number

    async def about(self, live: Live) -> tuple[dict[str, Any], bytes]:
        """The header of a job's table, and its request."""
        found: tuple[dict[str, Any], bytes] | None = await self.store.run(rows.request(live.kept.id))
        if found is None:
            raise Problem("not-found", "This job has been deleted.")
        return found

    # inside

    async def _add(self, body: bytes, kind: str, key: str, digest: str) -> tuple[str, bytes]:
        unfinished = sum(not live.ended for live in self.jobs.values()) + self.coming
        if unfinished >= self.settings.jobs:
            said = f"{unfinished} jobs are waiting or running, the most allowed; cancel one, or retry later."
            raise Problem("job-limit", said, headers={"retry-after": "10"})
        self.coming += 1
        try:
            task = Job("job", {"items": self.settings.items, "kind": kind}, body, self.settings.file_seconds)
            reply = await self.pool.run(task)
            about = json.loads(reply.head["headers"]["about"])
            kept = rows.Kept(secrets.token_hex(16), about["kind"], about["total"], "waiting", "Waiting.", time.time())
            location, live = f"/v1/jobs/{kept.id}", Live(kept)
            answer = json.dumps(summary(live)).encode()
            request = json.dumps(about).encode() + b"\n" + reply.body
            await self.store.run(rows.add(kept, request, key, digest, location, answer))
        finally:
            self.coming -= 1
        self.jobs[kept.id] = live
        live.task = asyncio.create_task(self._run(live))
        return location, answer

    @asynccontextmanager
    async def _alone(self, key: str) -> AsyncIterator[None]:
        """One request of a key at a time; the others wait for its answer."""
        lock, waiting = self._keys.setdefault(key, (asyncio.Lock(), Counter()))
        waiting["all"] += 1
        try:
            async with lock:
                yield
        finally:
            waiting["all"] -= 1
            if not waiting["all"]:
                self._keys.pop(key, None)

    async def _run(self, live: Live) -> None:
        """Run a job to its end, and keep how it ended."""
        try:
            status, message = await self._runner.run(live)
        except asyncio.CancelledError:
            if not live.cancelled:
                raise  # the server ends, the job does not
            status, message = "cancelled", ""
        except Exception as error:
            if isinstance(error, Problem) and (error.slug == "shutting-down" or self.pool.stopping.is_set()):
                return
            if not isinstance(error, Problem):
                log.exception("a job failed")
            said = (
                error.detail
                if isinstance(error, Problem)
                else "Internal error on this job; the log of the service has the details."
            )
            status, message = "failed", said
        live.ending = True
        if live.cancelled:
            status = "cancelled"
        task = asyncio.current_task()
        while task is not None and task.cancelling():
            task.uncancel()
        await self._end(live, status, message)

    async def _end(self, live: Live, status: str, message: str) -> None:
        found: rows.Kept | None = await self._runner.stored(rows.one(live.kept.id))
        if found is not None:
            live.kept.done, live.kept.failed = found.done, found.failed
            live.event = max(live.event, found.event)
        if status == "cancelled":
            done = f"{live.kept.done} of {live.kept.total} items are done"
            message = message or f"Cancelled; {done if live.kept.kind == 'sweep' else 'its last shape is kept'}."
        await self._runner.stored(rows.status(live.kept.id, status, message))
        live.kept.status, live.kept.message = status, message
        live.ended, live.task = True, None
        live.tell()

    async def _recall(self, live: Live) -> None:
        """The progress of a relaxation or design, as its last checkpoint has it."""
        found: rows.Row | None = await self.store.run(rows.item(live.kept.id, 0))
        if found is not None and found.status == rows.PARTIAL:
            said = json.loads(found.body.partition(b"\n")[0])
            live.progress.extend((int(event), values) for event, values in said["progress"])
            live.event = found.event + PROGRESS  # some may have been shown that were not stored

    async def _tick(self) -> None:
        """Forget what nobody used for long."""
        while True:
            await asyncio.sleep(TICK)
            used, self._used = list(self._used), set()
            settings = self.settings
            try:
                gone = await self.store.run(rows.age(TICK, settings.session_seconds, used, settings.kept_jobs))
            except Problem:
                continue
            for job in gone:
                self.jobs.pop(job, None)


def summary(live: Live) -> dict[str, Any]:
    """A job in the answers of routes."""
    kept = live.kept
    status = "cancelling" if live.cancelled and not live.ended else kept.status
    found = {"id": kept.id, "kind": kept.kind, "status": status, "message": kept.message, "total": kept.total}
    found.update(done=kept.done, failed=kept.failed, created=kept.created)
    if kept.kind != "sweep":
        found["progress"] = live.progress[-1][1] if live.progress else None
    return found
