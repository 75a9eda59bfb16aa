"""The pool's own promises: what is written to a worker that has ended reaches no other one."""

from __future__ import annotations

import os
import threading
from contextlib import suppress
from multiprocessing.connection import Connection
from typing import Any

import pytest

from hookean_server.problems import Problem
from hookean_server.settings import Settings
from hookean_server.workers import channel
from hookean_server.workers.pool import Job, Pool
from serving import HANG, wait_for

MESSAGE = b"\0\0\0\1x"
"""What a worker would read as a message, to which it has no answer."""


def test_what_an_ended_exchange_still_writes_reaches_no_other_worker(monkeypatch: pytest.MonkeyPatch) -> None:
    """A worker is killed while a thread is about to write to its pipe, and gets no processor until the next worker is
    there: the number of the pipe's end is not given again before the thread has done with it."""
    send, go, written = channel.send, threading.Event(), threading.Event()

    def late(connection: Connection, head: dict[str, Any], body: bytes = b"") -> None:
        if head["task"] != "late":
            return send(connection, head, body)
        number = connection.fileno()
        assert go.wait(HANG)
        with suppress(OSError):
            os.write(number, MESSAGE)
        written.set()
        return None

    monkeypatch.setattr(channel, "send", late)
    pool = Pool(Settings(), lanes=1)
    try:
        pool.start()
        unsent = Job("late", {}, b"", seconds=0.0)
        pool.jobs.put(unsent)
        with pytest.raises(Problem, match="not finished in 0 s"):
            unsent.future.result(HANG)
        wait_for(lambda: pool.restarts == 1 and pool.states()["idle"] == 1)
        go.set()
        assert written.wait(HANG)
        job = Job("none of its tasks", {}, b"", seconds=HANG)
        pool.jobs.put(job)
        assert job.future.result(HANG).head["problem"] == "internal"
    finally:
        go.set()
        pool.close()
