"""The pool: a few worker processes, each driven by one thread. Solves never touch the event loop.

A worker that dies, hangs or has read foreign files is replaced; clients that waited for it get a problem.
"""

from __future__ import annotations

import asyncio
import logging
import multiprocessing
import os
import queue
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from multiprocessing.connection import Connection, wait
from multiprocessing.context import BaseContext
from multiprocessing.process import BaseProcess
from typing import Any

from hookean.errors import InputError
from hookean_server.problems import Problem, faulty
from hookean_server.settings import Settings
from hookean_server.workers import channel
from hookean_server.workers.deadline import ended
from hookean_server.workers.process import STOP, work

log = logging.getLogger("hookean.pool")

FORKED = sys.platform != "win32" and "forkserver" in multiprocessing.get_all_start_methods()
UPLOADS = ("file", "scene")
LOOK = 0.05  # seconds between looks at whether a client has left


@dataclass
class Reply:
    """What a worker answered: a head (media type, headers, timing) and a body."""

    head: dict[str, Any]
    body: bytes


@dataclass
class Job:
    """One request to a worker. `seconds`: when it is stopped by force, from its start or from its last message; `once`:
    the worker is not used again; `heard`: called on the lane's thread with each message of the worker; `notice`:
    seconds it may take to stop, default: those of the settings."""

    task: str
    options: dict[str, Any]
    body: bytes
    seconds: float
    once: bool = False
    heard: Callable[[dict[str, Any], bytes], None] | None = None
    notice: float | None = None
    left: threading.Event = field(default_factory=threading.Event)
    future: Future[Reply] = field(default_factory=Future)


class Pool:
    """Worker processes for one server. Made idle; `start` or the first job starts the workers: `lanes` of them, or as
    many as in the settings; with `nice` they give way to others (in the system's steps, 0 to 19)."""

    def __init__(self, settings: Settings, lanes: int = 0, nice: int = 0) -> None:
        self.settings, self.nice = settings, nice
        self.count = lanes or settings.lanes
        self.stopping = threading.Event()
        self.restarts = 0
        self.taken = 0
        self.jobs: queue.SimpleQueue[Job | None] = queue.SimpleQueue()
        self.lanes: list[Lane] = []
        self._lock = threading.Lock()

    def start(self) -> None:
        """Start the workers, each in its thread; returns at once."""
        with self._lock:
            if not self.lanes and not self.stopping.is_set():
                self.lanes = [Lane(self, context()) for _ in range(self.count)]
                for lane in self.lanes:
                    lane.start()

    @contextmanager
    def place(self) -> Iterator[None]:
        """A place for one request, held from before its body is read; raises the problem `busy` where there is none."""
        with self._lock:
            if self.stopping.is_set():
                raise Problem("shutting-down", "The service is shutting down; start it again and repeat the request.")
            if self.taken >= self.settings.lanes + self.settings.queue:
                said = f"{self.taken} requests are running or waiting; retry in a second."
                raise Problem("busy", said, headers={"retry-after": "1"})
            self.taken += 1
        try:
            yield
        finally:
            with self._lock:
                self.taken -= 1

    async def run(self, job: Job) -> Reply:
        """What a worker answers to `job`; cancelling this stops the worker. Raises Problem."""
        if self.stopping.is_set():
            raise Problem("shutting-down", "The service stopped before this was finished.")
        self.start()
        self.jobs.put(job)
        try:
            reply = await asyncio.wrap_future(job.future)
        except asyncio.CancelledError:
            job.left.set()
            raise
        if (problem := Problem.from_wire(reply.head)) is not None:
            raise problem
        return reply

    def stop(self) -> None:
        """Ask everything to end now: solves are killed, their requests get `shutting-down`. Returns at once."""
        self.stopping.set()
        for _ in self.lanes:
            self.jobs.put(None)

    def close(self, seconds: float = 0.5) -> None:
        """`stop`, and wait until no worker is left; after `seconds` they are killed from here."""
        self.stop()
        until = time.monotonic() + seconds
        for lane in self.lanes:
            lane.join(max(0.0, until - time.monotonic()))
        for lane in self.lanes:
            lane.kill()

    def states(self) -> dict[str, int]:
        """How many workers are in each state: starting, idle, busy."""
        found = dict.fromkeys(("starting", "idle", "busy"), 0)
        for lane in self.lanes:
            found[lane.state] += 1
        return found


class Lane(threading.Thread):
    """One thread and its worker process. Only this thread speaks with the worker; anyone may kill it."""

    def __init__(self, pool: Pool, context: BaseContext) -> None:
        super().__init__(name="hookean-lane", daemon=True)
        self.pool, self.context = pool, context
        self.state = "starting"
        self.process: BaseProcess | None = None
        self.connection: Connection | None = None

    def run(self) -> None:
        """Take jobs until the pool stops."""
        self._begin()
        while not self.pool.stopping.is_set():
            self.state = "idle"
            job = self.pool.jobs.get()
            if job is None or not job.future.set_running_or_notify_cancel():
                continue
            self.state = "busy"
            self._serve(job)
            del job  # and its answer, which is the client's now
            if self.process is None and not self.pool.stopping.is_set():
                self._replace()
        self.kill()
        self._refuse_the_rest()

    def _begin(self) -> None:
        """A fresh worker; waits until it is ready."""
        self.state = "starting"
        with suppress(OSError, EOFError, RuntimeError):
            ours, theirs = multiprocessing.Pipe()
            process = self.context.Process(  # type: ignore[attr-defined]
                target=work,
                args=(theirs, self.pool.settings.worker_memory, FORKED, self.pool.nice),
                daemon=True,
                name="hookean-worker",
            )
            process.start()
            theirs.close()
            self.process, self.connection = process, ours
            while not self.pool.stopping.is_set():
                if wait([ours, process.sentinel], LOOK):
                    ours.recv_bytes()
                    return
        self.kill()

    def _replace(self) -> None:
        """A fresh worker for one that has ended."""
        self.kill()
        self.pool.restarts += 1
        log.info("worker replaced")
        self._begin()

    def _serve(self, job: Job) -> None:
        if self._ended():
            self._replace()
        try:
            reply = self._exchange(job)
        except Problem as problem:
            self.kill()
            job.future.set_exception(problem)
        except Exception:
            job.future.set_exception(self._lost(job))
            self.kill()
        else:
            if job.once:
                self.kill()
            job.future.set_result(reply)

    def _ended(self) -> bool:
        """Whether there is no worker, or it has ended while it was idle. Its end of the pipe is closed at that moment;
        the fork server reports the end of a process later."""
        if self.process is None or self.connection is None or not self.process.is_alive():
            return True
        try:
            return self.connection.poll()
        except OSError:
            return True

    def _lost(self, job: Job) -> Problem:
        """Why the worker ended: foreign geometry that it could not digest, or something of ours."""
        if job.once and self.process is not None:
            self.process.join(1.0)
            if why := ended(self.process.exitcode):
                return faulty("invalid-input", [InputError("/file" if job.task in UPLOADS else "/", why)])
        return Problem("worker-lost", "The worker process of this request ended; try again.")

    def _exchange(self, job: Job) -> Reply:
        """Hand the job over and wait for the answer, the client's leaving, the deadline or the end of the service."""
        if self.connection is None:
            raise EOFError
        talk = _Talk(self.connection, job)
        talk.start()
        notice = self.pool.settings.cancel_seconds if job.notice is None else job.notice
        asked = 0.0
        while not talk.done.wait(LOOK):
            if self.pool.stopping.is_set():
                raise Problem("shutting-down", "The service stopped before this was finished.")
            if job.left.is_set() and not asked:
                asked = time.monotonic()
                if talk.sent:
                    self.connection.send_bytes(STOP)
            if time.monotonic() > (asked + notice if asked else talk.heard + job.seconds):
                raise Problem("out-of-time", f"This was not finished in {job.seconds:g} s and has been stopped.")
        if talk.reply is None:
            raise EOFError
        return talk.reply

    def kill(self) -> None:
        """End the worker now."""
        process, self.process = self.process, None
        # closed once no thread has it: what one is about to write must not reach the next worker by the same number
        self.connection = None
        if process is not None:
            with suppress(OSError, ValueError, AttributeError):
                process.kill()
                process.join(1.0)

    def _refuse_the_rest(self) -> None:
        with suppress(queue.Empty):
            while True:
                job = self.pool.jobs.get_nowait()
                if job is not None and job.future.set_running_or_notify_cancel():
                    job.future.set_exception(Problem("shutting-down", "The service stopped before this was finished."))


class _Talk(threading.Thread):
    """One exchange with a worker. A worker that hangs blocks this thread only; killing it ends the exchange."""

    def __init__(self, connection: Connection, job: Job) -> None:
        super().__init__(name="hookean-talk", daemon=True)
        self.connection, self.job = connection, job
        self.sent = False
        self.heard = time.monotonic()
        self.reply: Reply | None = None
        self.done = threading.Event()

    def run(self) -> None:
        """Send the job, receive the answer; no answer where the worker died."""
        job = self.job
        try:
            channel.send(self.connection, {"task": job.task, "options": job.options}, job.body)
            self.sent = True
            head, body = channel.receive(self.connection)
            while "said" in head:
                self.heard = time.monotonic()
                if job.heard is not None:
                    job.heard(head["said"], body)
                head, body = channel.receive(self.connection)
            self.reply = Reply(head, body)
        except (OSError, EOFError, ValueError):
            pass
        finally:
            self.done.set()


def context() -> BaseContext:
    """`forkserver` with warmed kernels where there is one (never `fork`: the server has threads), else `spawn`."""
    context = multiprocessing.get_context("forkserver" if FORKED else "spawn")
    if FORKED:
        context.set_forkserver_preload(["hookean_server.workers.preload"])
    return context


def end_fork_server() -> None:
    """End the process that workers are forked from; for the last moment of a server's own process."""
    if FORKED:
        from multiprocessing import forkserver

        with suppress(Exception):
            server: Any = vars(forkserver)["_forkserver"]
            os.kill(server._forkserver_pid, signal.SIGKILL)  # it may be busy warming up
            server._stop()
