"""Batches of sweeps on a Dask cluster, by its address in HOOKEAN_DASK. Its workers need the same version of hookean."""

from __future__ import annotations

import asyncio
import hashlib
import logging
import uuid
from collections.abc import Callable, Iterator
from concurrent.futures import CancelledError as FutureCancelled
from contextlib import contextmanager, suppress
from typing import Any

import hookean
from hookean_server.jobs import work
from hookean_server.problems import Problem
from hookean_server.settings import Settings

log = logging.getLogger("hookean.jobs")
LOST = "The connection to the Dask cluster was lost; the job waits for it."
LOOK = 0.5  # seconds between looks at whether the cluster is still there
CONNECT = 5.0  # seconds a scheduler may take to answer
SLOTS = 16  # batches at once at most
EACH = 2  # batches for each thread of the cluster, so that none waits for the next


class Cluster:
    """A Dask cluster. Found when it is first needed, and again when it was lost."""

    def __init__(self, settings: Settings) -> None:
        self.settings, self.slots = settings, SLOTS
        self.client: Any = None
        self._finding = asyncio.Lock()
        self.threads = self._flying = 0

    async def ready(self) -> None:
        """Wait for the scheduler and one worker; raises Problem where there are none."""
        with _own_cancels():
            await self._ready()

    async def _ready(self) -> None:
        async with self._finding:
            if self.client is not None and self.client.status != "running":
                await self._leave()
            if self.client is None:
                self.client = await self._found()
        if not await self._count():
            raise Problem("busy", "The Dask cluster has no workers; the job waits for one.")

    async def _found(self) -> Any:
        try:
            from distributed import Client
        except ImportError:
            raise Problem("busy", "HOOKEAN_DASK is set, but distributed is not installed: hookean[dask].") from None
        logging.getLogger("distributed.client").setLevel(logging.CRITICAL)  # what is lost is told by us
        client = Client(self.settings.dask, asynchronous=True, timeout=CONNECT, name="hookean", set_as_default=False)
        try:
            async with asyncio.timeout(2 * CONNECT):
                return await client
        except Exception as error:
            log.warning("the Dask cluster cannot be reached: %s", type(error).__name__)
            with suppress(Exception):
                await client.close(timeout=1)
            raise Problem("busy", "The Dask cluster cannot be reached; the job waits for it.") from None

    async def _count(self) -> int:
        """Threads of the cluster; 0 where it does not answer."""
        try:
            async with asyncio.timeout(CONNECT):
                self.threads = sum((await self.client.nthreads()).values())
        except Exception:
            self.threads = 0
        return self.threads

    async def batch(self, request: bytes, numbers: list[int], seconds: float) -> list[bytes]:
        """See `Executor`."""
        await self.ready()
        while self._flying >= EACH * max(1, self.threads):
            await asyncio.sleep(0.02)
        self._flying += 1
        try:
            client = self.client
            if client is None or client.status != "running":  # it was lost meanwhile
                raise Problem("busy", LOST)
            with _own_cancels():
                found = await self._batch(client, request, numbers, seconds)
        finally:
            self._flying -= 1
        if not found:
            raise Problem("worker-lost", "A worker gave no answer.")
        return found

    async def _batch(self, client: Any, request: bytes, numbers: list[int], seconds: float) -> list[bytes]:
        digest = hashlib.sha256(request).hexdigest()[:16]
        # the request is a task of its own: it is sent once, and made again where the worker that held it is lost
        held = client.submit(_same, request, key=f"hookean-request-{digest}")
        key = f"hookean-batch-{uuid.uuid4().hex}"
        future = client.submit(_solve, held, numbers, seconds, hookean.__version__, key=key, pure=False)
        result = asyncio.ensure_future(_result(future))
        try:
            until = asyncio.get_running_loop().time() + 2.0 * (seconds + self.settings.grace_seconds)
            while not (await asyncio.wait({result}, timeout=LOOK))[0]:
                if client.status != "running":  # then nobody would tell us
                    raise Problem("busy", LOST)
                if asyncio.get_running_loop().time() > until:
                    await self._end_worker(client, key)
                    raise Problem("out-of-time", f"This was not finished in {seconds:g} s and has been stopped.")
            return _rows(result, client)
        except asyncio.CancelledError:
            with suppress(Exception):
                await asyncio.wait_for(client.cancel([future]), LOOK)
            raise
        finally:
            result.cancel()
            future.release()
            held.release()

    async def _end_worker(self, client: Any, key: str) -> None:
        """Restart the worker that hangs on a task."""
        with suppress(Exception):
            busy = [worker for worker, keys in (await client.processing()).items() if key in map(str, keys)]
            await client.restart_workers(busy, timeout=CONNECT, raise_for_error=False)

    async def _leave(self) -> None:
        client, self.client = self.client, None
        if client is not None:
            with suppress(Exception, asyncio.CancelledError):
                await asyncio.wait_for(client.close(timeout=1), 1.5)

    async def close(self) -> None:
        """Leave the cluster; it goes on without us."""
        await self._leave()


@contextmanager
def _own_cancels() -> Iterator[None]:
    """A client that loses its scheduler cancels whatever waits for it: only what we cancelled ourselves is one."""
    try:
        yield
    except asyncio.CancelledError:
        task = asyncio.current_task()
        if task is None or task.cancelling():
            raise
        raise Problem("busy", LOST) from None


async def _result(future: Any) -> list[bytes]:
    found: list[bytes] = await future
    return found


def _rows(result: asyncio.Future[list[bytes]], client: Any) -> list[bytes]:
    """What was found; `busy` where the cluster must be mended first, else its worker was lost."""
    if result.cancelled():
        raise Problem("busy", LOST)
    error = result.exception()
    if error is None:
        return result.result()
    if isinstance(error, Problem):
        raise error
    if isinstance(error, ImportError):
        raise Problem(
            "busy", "The workers of the Dask cluster do not have hookean; install the service's version there."
        )
    if client.status != "running" or isinstance(error, OSError | FutureCancelled):
        raise Problem("busy", LOST)
    raise Problem("worker-lost", "The workers of the cluster that worked on this ended.")


def _same(request: bytes) -> bytes:
    return request


def _solve(request: bytes, numbers: list[int], seconds: float, version: str) -> list[bytes]:
    """A batch, on a worker of the cluster."""
    if version != hookean.__version__:
        raise Problem("busy", f"The Dask cluster has hookean {hookean.__version__}, the service {version}.")
    return work.solve(request, numbers, seconds, _asked_to_stop())


def _asked_to_stop() -> Callable[[], bool] | None:
    """Whether the task that runs on this thread was cancelled: the worker notes it while the task goes on."""
    from distributed.worker import get_worker, thread_state

    with suppress(Exception):
        tasks, key = get_worker().state.tasks, thread_state.key

        def asked() -> bool:
            task = tasks.get(key)
            return task is not None and task.state == "cancelled"

        return asked
    return None
