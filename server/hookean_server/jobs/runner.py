"""Running jobs: the items of a sweep in batches, a relaxation or a design with its progress. What is done is stored
before it is shown; a lost worker is replaced, and its unfinished items are done again."""

from __future__ import annotations

import asyncio
import json
from collections import Counter, deque
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

from hookean_server.jobs import rows, work
from hookean_server.jobs.executors import NOTICE, Executor, Local
from hookean_server.problems import Problem
from hookean_server.settings import Settings
from hookean_server.store import Store
from hookean_server.workers.pool import Job

TRIES = 3
LARGEST = 500  # items in a batch
PROGRESS = 1000  # words on a relaxation that are kept
AGAIN = 1.0  # seconds until the next try where the store or the cluster refuses


@dataclass(eq=False)
class Live:
    """One job as the server knows it."""

    kept: rows.Kept
    event: int = 0
    progress: deque[tuple[int, dict[str, Any]]] = field(default_factory=lambda: deque(maxlen=PROGRESS))
    ended: bool = False
    cancelled: bool = False
    ending: bool = False
    task: asyncio.Task[None] | None = None
    solving: Job | None = None
    news: asyncio.Event = field(default_factory=asyncio.Event)

    def tell(self) -> None:
        """Wake everyone who waits for news."""
        self.news.set()
        self.news = asyncio.Event()


class Pending:
    """Items that are still to do: `next` ones in batches, `suspects` one by one."""

    def __init__(self, numbers: Iterable[int]) -> None:
        self.next = deque(numbers)
        self.suspects: deque[int] = deque()

    def take(self, slots: int) -> list[int]:
        """Numbers for one batch, fewer towards the end so that all slots end together; empty where none are left."""
        if self.next:
            count = max(1, min(LARGEST, len(self.next) // (2 * slots)))
            return [self.next.popleft() for _ in range(count)]
        return [self.suspects.popleft()] if self.suspects else []

    def back(self, numbers: list[int]) -> None:
        """These were not done yet."""
        self.next.extendleft(reversed(numbers))


class Runner:
    """Runs jobs side by side: a sweep batch by batch, in turn with others; relaxations leave one worker to sweeps."""

    def __init__(self, settings: Settings, store: Store, local: Local, executor: Executor) -> None:
        self.settings, self.store, self.local, self.executor = settings, store, local, executor
        self.turns = asyncio.Semaphore(executor.slots)
        self.relaxing = asyncio.Semaphore(local.slots - 1)

    async def run(self, live: Live) -> tuple[str, str]:
        """Do what is left of a job; how it ended, and a sentence on it. Raises Problem `shutting-down`."""
        return await (self._sweep(live) if live.kept.kind == "sweep" else self._relaxation(live))

    # sweeps

    async def _sweep(self, live: Live) -> tuple[str, str]:
        kept = live.kept
        _, request = await self.stored(rows.request(kept.id))
        tries = Counter[int]()
        while len(done := await self.stored(rows.finished(kept.id))) < kept.total:
            pending = Pending(n for n in range(kept.total) if n not in done)
            await self._reach(live)
            try:
                async with asyncio.TaskGroup() as group:
                    for _ in range(self.executor.slots):
                        group.create_task(self._pull(live, request, pending, tries))
            except BaseExceptionGroup as several:
                raise several.exceptions[0] from None
        if kept.failed == kept.total:
            return "failed", "No item could be solved; each row has the reason."
        return "done", f"{kept.done} of {kept.total} items are solved" + (
            f", {kept.failed} failed." if kept.failed else "."
        )

    async def _reach(self, live: Live) -> None:
        """Wait until the executor takes batches, and report this while it does not."""
        while True:
            try:
                await self.executor.ready()
                return
            except Problem as problem:
                live.kept.message = problem.detail
                live.tell()
                await asyncio.sleep(AGAIN)

    async def _pull(self, live: Live, request: bytes, pending: Pending, tries: Counter[int]) -> None:
        """One of the slots: batch after batch until none are left."""
        while numbers := pending.take(self.executor.slots):
            async with self.turns:
                await self._begun(live)
                found = await self._solved(live, request, numbers, pending, tries)
            if found:
                await self._keep(live, found)

    async def _solved(
        self, live: Live, request: bytes, numbers: list[int], pending: Pending, tries: Counter[int]
    ) -> list[tuple[int, str, bytes]]:
        """Number, status and row of what was done of a batch; the rest is pending again."""
        try:
            lines = await self.executor.batch(request, numbers, self.settings.solve_seconds)
        except Problem as problem:
            if problem.slug == "shutting-down":
                raise
            if problem.slug == "busy":  # nobody has begun it
                pending.back(numbers)
                await self._reach(live)
                return []
            if len(numbers) > 1:
                pending.suspects.extend(numbers)  # one of them may be what ended the worker
                return []
            (number,) = numbers
            tries[number] += 1
            if tries[number] < TRIES:
                pending.suspects.append(number)
                return []
            said = f"Stopped after {TRIES} tries: {problem.detail}"
            lines = [await asyncio.to_thread(work.failed, request, number, said)]
        pending.back(numbers[len(lines) :])
        return [(n, "failed" if _is_failed(line) else "done", line) for n, line in zip(numbers, lines, strict=False)]

    async def _keep(self, live: Live, found: list[tuple[int, str, bytes]]) -> None:
        """Store rows, then count and show them."""
        statuses = {number: status for number, status, _ in found}

        def numbered() -> list[rows.Row]:
            first = live.event + 1
            live.event += len(found)
            return [rows.Row(n, first + i, status, line) for i, (n, status, line) in enumerate(found)]

        while True:
            try:
                new = await self.store.run(rows.store(live.kept.id, numbered()))
                break
            except Problem as problem:
                live.kept.message = problem.detail
                await asyncio.sleep(AGAIN)
        for number in new:
            live.kept.failed += statuses[number] == "failed"
            live.kept.done += statuses[number] == "done"
        live.kept.message = f"{live.kept.done + live.kept.failed} of {live.kept.total} items are done."
        live.tell()

    # relaxations and designs

    async def _relaxation(self, live: Live) -> tuple[str, str]:
        kept = live.kept
        _, request = await self.stored(rows.request(kept.id))
        tries, reached = 0, -1
        while True:
            before: rows.Row | None = await self.stored(rows.item(kept.id, 0))
            if before is not None and before.status != rows.PARTIAL:
                return "done", ""
            said, state = (b"{}", b"") if before is None else _cut(before.body)
            iteration = json.loads(said).get("iteration", -1)
            tries, reached = (tries + 1, reached) if iteration <= reached else (1, iteration)
            if tries > TRIES:
                return "failed", f"Stopped after {TRIES} tries; the last shape is kept."
            options = {"size": len(request), "seconds": self.settings.job_seconds}
            options["longest"] = self.settings.solve_seconds
            job = Job(kept.kind, options, request + state, self.settings.solve_seconds, notice=NOTICE)
            try:
                async with self.relaxing:
                    await self._begun(live)
                    return await self._relaxed(live, job)
            except Problem as problem:
                if problem.slug == "shutting-down":
                    raise
                if live.cancelled:
                    return "cancelled", ""
                if problem.slug not in ("worker-lost", "out-of-time"):
                    return "failed", problem.detail

    async def _relaxed(self, live: Live, job: Job) -> tuple[str, str]:
        loop = asyncio.get_running_loop()

        def heard(said: dict[str, Any], state: bytes) -> None:
            if not loop.is_closed():
                loop.call_soon_threadsafe(self._progress, live, said, state)

        job.heard, live.solving = heard, job
        try:
            body = (await self.local.pool.run(job)).body
        finally:
            live.solving = None
        line, _ = _cut(body)
        row = json.loads(line)
        status = rows.STOPPED if row["status"] == "cancelled" else "done"
        await self._keep(live, [(0, status, body)])
        return status, row["message"]

    def _progress(self, live: Live, said: dict[str, Any], state: bytes) -> None:
        if live.ended:
            return
        live.event += 1
        live.progress.append((live.event, said))
        if "objective" in said:
            live.kept.message = f"Running: {said['iteration']} equilibria, objective {said['objective']:.4g}."
        else:
            live.kept.message = f"Running: {said['iteration']} iterations, residual {said['residual']:.3g}."
        live.tell()
        if state and self.store.budget.allows(live.kept.id):
            self.store.budget.spend(len(state))
            head = json.dumps({**said, "progress": list(live.progress)}).encode()
            stored = self.store.submit(rows.checkpoint(live.kept.id, live.event, head + b"\n" + state))
            stored.add_done_callback(lambda future: future.exception())  # the next one may be stored

    # both

    async def _begun(self, live: Live) -> None:
        if live.kept.status != "running":
            live.kept.status = "running"
            await self.stored(rows.status(live.kept.id, "running", ""))
            live.tell()

    async def stored(self, task: Any) -> Any:
        """What work on the store returns, tried until the store takes it."""
        while True:
            try:
                return await self.store.run(task)
            except Problem:
                await asyncio.sleep(AGAIN)


def _cut(body: bytes) -> tuple[bytes, bytes]:
    """The line of a relaxation's item, and what is behind it."""
    line, _, rest = body.partition(b"\n")
    return line, rest


def _is_failed(line: bytes) -> bool:
    return b'"status":"failed"' in line and json.loads(line)["status"] == "failed"
