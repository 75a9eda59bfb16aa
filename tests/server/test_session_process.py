"""The server's side of a session's process: whoever waits hears of its end, whichever thread learns of it first."""

from __future__ import annotations

import asyncio
import json
import os
import threading
from concurrent.futures import Future
from contextlib import suppress
from typing import Any

import pytest

from hookean import Scene, Simulation
from hookean_server.problems import Problem
from hookean_server.sessions import parts, rows
from hookean_server.sessions import process as module
from hookean_server.sessions.process import Gone, SessionProcess
from hookean_server.store import Store
from serving import CABLE, HANG, wait_for

from .test_pool import MESSAGE

MEMORY = 4 << 30


class Raced(Future[Any]):
    """Another thread is always a moment quicker with the answer."""

    def set_result(self, result: Any) -> None:
        super().set_result(result)
        super().set_result(result)


async def _asked_until_gone(process: SessionProcess) -> None:
    process.kill()
    while True:
        await process.call("describe", seconds=30.0)


def test_the_end_is_told_by_two_threads_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """A caller that finds the process lost and the thread that listens to it answer the same call: neither fails."""
    monkeypatch.setattr(module, "Future", Raced)
    lost = threading.Event()
    process = SessionProcess(MEMORY, lambda head, _: lost.set() if head["event"] == "lost" else None)
    for _ in range(2):  # while it ends, and after
        with pytest.raises(Gone):
            asyncio.run(_asked_until_gone(process))
    assert lost.wait(HANG)


def test_what_is_still_written_reaches_no_other_session(monkeypatch: pytest.MonkeyPatch) -> None:
    """As for workers (see test_pool): the thread that writes may get no processor until the next process is there."""
    send, go, written, lost = module.channel.send, threading.Event(), threading.Event(), threading.Event()

    def late(connection: Any, head: dict[str, Any], body: bytes = b"") -> None:
        if head["do"] != "late":
            return send(connection, head, body)
        number = connection.fileno()
        assert go.wait(HANG)
        with suppress(OSError):
            os.write(number, MESSAGE)
        written.set()
        return None

    async def answered(process: SessionProcess, do: str) -> None:
        await process.call(do, seconds=HANG)

    monkeypatch.setattr(module.channel, "send", late)
    others = threading.enumerate()
    first = SessionProcess(MEMORY, lambda head, _: lost.set() if head["event"] == "lost" else None)
    first._send({"do": "late"}, b"")
    first.kill()
    assert lost.wait(HANG)
    wait_for(lambda: sum(thread not in others for thread in threading.enumerate()) == 1)  # the one that writes
    second = SessionProcess(MEMORY, lambda head, _: None)
    try:
        go.set()
        assert written.wait(HANG)
        with pytest.raises(Problem, match="not open yet"):
            asyncio.run(answered(second, "describe"))
    finally:
        second.kill()


def test_drags_by_pins_are_few_rows_and_come_back_whole() -> None:
    """Of a pull the store has the last pin and the release, of a drag the last pin: made again from there, the anchors,
    the revision and what can be taken back are those of the session itself."""
    simulation, store = Simulation(Scene.read(CABLE)), Store(None)
    base = parts.saved(simulation)
    store.submit(rows.put("a", "", base, parts.describe(simulation), [])).result(20.0)

    def make(edit: dict[str, Any]) -> None:
        made, sets = parts.make(simulation, json.dumps(edit).encode())
        store.submit(rows.edit("a", simulation.state.revision, sets, made)).result(20.0)

    for step in range(30):
        make({"pin": [{"particles": [2], "targets": [[4, 0.1 * step, 0]]}], "gesture": "pull"})
    make({"release": [2], "gesture": "pull"})
    for step in range(30):
        make({"pin": [{"particles": [5], "targets": [[10, 0, 0.1 * step]]}], "gesture": "drag"})
    make({"pin": [{"particles": [3], "targets": [[6, 0, 1]]}], "gesture": "drag"})
    stored = store.submit(rows.load("a")).result(20.0)
    store.close()
    assert len(stored.edits) == 4 and stored.revisions == [30, 31, 61, 62] and stored.revision == 62
    again = parts.restored(stored.base, stored.state, stored.edits, stored.revisions)
    for _ in range(2):
        for one, other in zip(again.system.held, simulation.system.held, strict=True):
            assert (one.number, one.particles.tolist()) == (other.number, other.particles.tolist())
            assert one.targets.tolist() == other.targets.tolist()
        assert again.state.revision == simulation.state.revision
        assert len(again.history.before) == len(simulation.history.before)
        again.undo(), simulation.undo()
