"""The server's side of a session's process: whoever waits hears of its end, whichever thread learns of it first."""

from __future__ import annotations

import asyncio
import threading
from concurrent.futures import Future
from typing import Any

import pytest

from hookean_server.sessions import process as module
from hookean_server.sessions.process import Gone, SessionProcess

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
    assert lost.wait(60.0)
