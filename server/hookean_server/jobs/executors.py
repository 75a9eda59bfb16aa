"""Where the items of sweeps are solved: by processes of this server, or by a Dask cluster."""

from __future__ import annotations

from typing import Protocol

from hookean_server.problems import Problem
from hookean_server.settings import Settings
from hookean_server.workers.pool import Job, Pool

NICE = 10  # how far jobs give way to requests and sessions
NOTICE = 1.5  # seconds a worker may take to notice that its job is cancelled


class Executor(Protocol):
    """Solves batches. `slots`: how many at once."""

    slots: int

    async def ready(self) -> None:
        """Wait until batches are taken; raises Problem where they cannot be."""

    async def batch(self, request: bytes, numbers: list[int], seconds: float) -> list[bytes]:
        """Rows of items in their order, as many as were done; each may take `seconds`. Cancelling this stops them.
        Raises Problem if their worker was lost."""

    async def close(self) -> None:
        """Let go of everything."""


class Local:
    """Processes of this server, apart from those that answer requests."""

    def __init__(self, settings: Settings) -> None:
        self.settings = settings
        self.pool = Pool(settings, lanes=max(2, settings.lanes), nice=NICE)
        self.slots = self.pool.count

    async def ready(self) -> None:
        """Always."""

    async def batch(self, request: bytes, numbers: list[int], seconds: float) -> list[bytes]:
        """See `Executor`."""
        options = {"numbers": numbers, "seconds": seconds}
        job = Job("batch", options, request, seconds + self.settings.grace_seconds, notice=NOTICE)
        found = (await self.pool.run(job)).body.split(b"\n")
        if found == [b""]:
            raise Problem("worker-lost", "A worker gave no answer.")
        return found

    async def close(self) -> None:
        """End the processes."""
        self.pool.close(0.3)
