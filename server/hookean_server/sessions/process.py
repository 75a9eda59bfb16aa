"""The server's side of a session's process: commands out, answers and events in, on one thread for each process."""

from __future__ import annotations

import asyncio
import itertools
import queue
import threading
import time
from collections.abc import Callable
from concurrent.futures import Future, InvalidStateError
from contextlib import suppress
from multiprocessing import Pipe
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from typing import Any

from hookean_server.problems import Problem
from hookean_server.sessions.host import host
from hookean_server.workers import channel
from hookean_server.workers.pool import FORKED, context

Event = Callable[[dict[str, Any], bytes], None]


class Gone(Problem):
    """The process ended before it answered: nothing that was asked of it has happened."""

    def __init__(self) -> None:
        super().__init__("worker-lost", "The process of this session ended and is being restarted; try again.")


GONE: dict[str, Any] = {}


class SessionProcess:
    """One process that holds one simulation. `on_event` receives its events, and with {"event": "lost"} of its end; it
    is called on a thread of ours."""

    def __init__(self, memory: int, on_event: Event) -> None:
        self.on_event = on_event
        self.lost = False
        self.heard = time.monotonic()  # when it last sent anything, which it does twice a second between steps
        self._ids = itertools.count(1)
        self._waiting: dict[int, Future[tuple[dict[str, Any], bytes]]] = {}
        self._orders: queue.SimpleQueue[tuple[dict[str, Any], bytes] | None] = queue.SimpleQueue()
        ours, theirs = Pipe()
        process: BaseProcess = context().Process(  # type: ignore[attr-defined]
            target=host, args=(theirs, memory, FORKED), daemon=True, name="hookean-session"
        )
        process.start()
        theirs.close()
        self.process = process
        for side in (self._listen, self._speak):
            threading.Thread(target=side, args=(ours,), name="hookean-session", daemon=True).start()

    @classmethod
    async def begun(cls, memory: int, on_event: Event) -> SessionProcess:
        """A process, started beside the event loop; it is ended if the caller is cancelled meanwhile."""
        starting = asyncio.ensure_future(asyncio.to_thread(cls, memory, on_event))
        try:
            return await asyncio.shield(starting)
        except asyncio.CancelledError:
            starting.add_done_callback(lambda done: None if done.exception() else done.result().kill())
            raise

    async def call(self, do: str, body: bytes = b"", *, seconds: float, **head: Any) -> tuple[dict[str, Any], bytes]:
        """What the process answers. A process silent for `seconds` is killed; raises Problem."""
        future: Future[tuple[dict[str, Any], bytes]] = Future()
        number = next(self._ids)
        self._waiting[number] = future
        if self.lost:
            self._fail()
        self._send({"id": number, "do": do, **head}, body)
        try:
            answer, data = await asyncio.wait_for(asyncio.wrap_future(future), seconds)
        except TimeoutError:
            self.kill()
            raise Problem(
                "out-of-time", f"The session did not answer in {seconds:g} s; it is being restarted."
            ) from None
        finally:
            self._waiting.pop(number, None)
        if answer is GONE:
            raise Gone
        if (problem := Problem.from_wire(answer)) is not None:
            raise problem
        return answer, data

    def credit(self) -> None:
        """One more frame is wanted."""
        self._send({"do": "credit"}, b"")

    def keep(self) -> None:
        """A checkpoint is wanted, if there is anything to store."""
        self._send({"do": "keep"}, b"")

    def unstored(self) -> None:
        """The last checkpoint could not be stored; another one is wanted."""
        self._send({"do": "unstored"}, b"")

    def kill(self) -> None:
        """End the process now; clients that wait for it get a problem."""
        with suppress(OSError, ValueError, AttributeError):
            self.process.kill()

    def join(self, seconds: float) -> None:
        """Wait until the process has ended."""
        with suppress(OSError, ValueError, AssertionError):
            self.process.join(seconds)

    def _send(self, head: dict[str, Any], body: bytes) -> None:
        self._orders.put((head, body))

    def _speak(self, connection: Connection) -> None:
        """Send what is asked for, in its order; a process that hangs blocks this thread only."""
        with suppress(OSError, ValueError):
            while (order := self._orders.get()) is not None:
                channel.send(connection, *order)

    def _listen(self, connection: Connection) -> None:
        with suppress(OSError, EOFError, ValueError):
            while True:
                head, body = channel.receive(connection)
                self.heard = time.monotonic()
                if "id" not in head:
                    self.on_event(head, body)
                elif (future := self._waiting.get(head["id"])) is not None:
                    _settle(future, head, body)
        self.lost = True
        self.kill()
        self._fail()
        self.on_event({"event": "lost"}, b"")
        self.join(1.0)
        self._orders.put(None)  # the pipe is closed once neither thread has it

    def _fail(self) -> None:
        for future in list(self._waiting.values()):
            _settle(future, GONE, b"")


def _settle(future: Future[tuple[dict[str, Any], bytes]], answer: dict[str, Any], body: bytes) -> None:
    """Answer who waits, unless the event loop's thread or ours was first: asking before would race with the other."""
    with suppress(InvalidStateError):
        future.set_result((answer, body))
