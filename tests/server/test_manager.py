"""What watchers of a session are told, in whatever order its process and the store come to it."""

from __future__ import annotations

import asyncio
from typing import Any, cast

from hookean_server.sessions.manager import Live, Manager
from hookean_server.sessions.process import SessionProcess
from hookean_server.settings import Settings
from hookean_server.store import Store

BEFORE = {"revision": 0, "status": "running", "playing": False}
AFTER = {**BEFORE, "revision": 1}


def test_a_new_topology_is_told_where_the_process_tells_its_revision_first() -> None:
    """The process answers, sends a sign of life, and only then is the new scene stored: a watcher that has seen the
    revision by then still hears of the topology."""

    class Process:
        lost = False

        async def call(self, *given: Any, **named: Any) -> tuple[dict[str, Any], bytes]:
            return dict(AFTER), b""

    async def replaced() -> list[str]:
        live = Live("a", "", dict(BEFORE), topology="first")
        live.process = cast(SessionProcess, Process())

        class Kept:
            async def run(self, work: Any) -> None:
                manager._event(live, cast(SessionProcess, live.process), {"event": "beat", **AFTER}, b"")
                await asyncio.sleep(0)  # the watcher looks

        manager = Manager(Settings(), cast(Store, Kept()))
        manager.sessions["a"] = live
        seen: list[str] = []

        async def watch() -> None:
            while True:
                news = live.news
                seen.append(live.topology)
                await news.wait()

        watching = asyncio.create_task(watch())
        await asyncio.sleep(0)
        await manager.put("a", b"{}")
        await asyncio.sleep(0)
        watching.cancel()
        assert seen[-1] == live.topology
        return seen

    assert asyncio.run(replaced())[:2] == ["first", "first"]
