"""Visits: requests that need no token and compute, as Hops' do. They have budgets of their own.

At most half of the workers work for visits, and at least one. A visit has its worker's place until its answer has been
read, so that answers which nobody reads wait for each other, not in memory. Others wait in a queue of their own, from
before their bodies are read; requests with the token are not affected.
"""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from contextlib import contextmanager

from starlette.types import ASGIApp, Receive, Scope, Send

from hookean_server.http.access import Access, Table
from hookean_server.problems import Problem
from hookean_server.settings import Settings
from hookean_server.workers.pool import Job, Pool, Reply


class Visits:
    """Gives each visit a place in the queue, from before its body is read until its answer has been sent."""

    def __init__(self, app: ASGIApp, settings: Settings, table: Table) -> None:
        self.app, self.table = app, table
        self.workers = max(1, settings.lanes // 2)
        self.room = self.workers + settings.visits
        self.taken = 0
        self.turns = asyncio.Semaphore(self.workers)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """One request."""
        visits = scope["type"] == "http" and scope["method"] == "POST"
        if not visits or self.table.access("POST", scope["path"]) is not Access.HOPS:
            await self.app(scope, receive, send)
            return
        with self._place() as scope["visit"]:
            await self.app(scope, receive, send)

    @contextmanager
    def _place(self) -> Iterator[Visit]:
        if self.taken >= self.room:
            said = f"{self.taken} requests without a token are running or waiting; retry in a second."
            raise Problem("busy", said, headers={"retry-after": "1"})
        visit = Visit(self.turns)
        self.taken += 1
        try:
            yield visit
        finally:
            self.taken -= 1
            visit.end()


class Visit:
    """One visit; it waits for its turn before a worker works for it."""

    def __init__(self, turns: asyncio.Semaphore) -> None:
        self._turns = turns
        self._has_turn = False

    async def run(self, pool: Pool, job: Job) -> Reply:
        """What a worker answers to `job`, as `Pool.run`."""
        await self._turns.acquire()
        self._has_turn = True
        return await pool.run(job)

    def end(self) -> None:
        """Give the turn to the next one."""
        if self._has_turn:
            self._has_turn = False
            self._turns.release()
