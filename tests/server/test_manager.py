"""What watchers of a session are told, in whatever order its process and the store come to it."""

from __future__ import annotations

import asyncio
import json
from types import SimpleNamespace
from typing import Any, cast

from starlette.requests import Request

from hookean_server.sessions import routes
from hookean_server.sessions.conditions import Conditions
from hookean_server.sessions.live import Live
from hookean_server.sessions.manager import Manager
from hookean_server.sessions.process import SessionProcess
from hookean_server.settings import Settings
from hookean_server.store import Store
from serving import HANG

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
        live = Live("a", "", dict(BEFORE), scene="first")
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


CABLE = {
    "particles": [[0, 0, 0], [1, 0, 0], [2, 0, 0]],
    "anchors": [{"particles": [0, 2]}],
    "forces": [
        {"kind": "springs", "particles": [[0, 1], [1, 2]]},
        {"kind": "unary", "particles": [1], "vector": [0, 0, -9]},
    ],
}
LIFTED = {"move": [{"anchor": 0, "targets": [[0, 0, 5], [2, 0, 5]]}]}


class SlowStore(Store):
    """A store on a disk that is slow: each write of some kind takes as long as `gate` is closed."""

    def __init__(self, kind: str) -> None:
        super().__init__(None)
        self.kind, self.begun, self.gate = kind, asyncio.Event(), asyncio.Event()

    async def run(self, work: Any) -> Any:
        if self.kind in work.__qualname__:
            self.begun.set()
            await self.gate.wait()
        return await super().run(work)


async def opened(store: Store, scene: dict[str, Any] = CABLE, **settings: Any) -> Manager:
    """A manager with one session, `a`."""
    manager = Manager(Settings(**settings), store)
    await manager.start()
    await manager.put("a", json.dumps(scene).encode())
    return manager


def test_an_edit_is_in_the_session_whose_process_ends_while_it_is_stored() -> None:
    """Somebody else asks for the session meanwhile: it comes back with the edit, as that is acknowledged later."""

    async def edited() -> tuple[int, int, bytes]:
        store = SlowStore("edit")
        manager = await opened(store)
        live = manager.find("a")
        editing = asyncio.create_task(manager.edit("a", json.dumps(LIFTED).encode()))
        await store.begun.wait()
        assert live.process is not None
        live.process.kill()
        exporting = asyncio.create_task(manager.export("a", "anchors"))
        await asyncio.sleep(0.5)  # long enough to come back from a store without the edit
        store.gate.set()
        acknowledged = (await editing)["revision"]
        head, anchors = await exporting
        await manager.close()
        store.close()
        return acknowledged, head["revision"], anchors

    acknowledged, now, anchors = asyncio.run(edited())
    assert now == acknowledged == 1
    assert json.loads(anchors)["anchors"][0]["targets"] == LIFTED["move"][0]["targets"]


def test_who_plays_a_session_that_is_being_put_to_sleep_plays_it() -> None:
    """There is room for one: `a` makes room for `b`, and is played while its state is being stored."""

    async def played() -> tuple[bool, bool]:
        store = SlowStore("checkpoint")
        manager = await opened(store, awake=1)
        opening = asyncio.create_task(manager.put("b", json.dumps(CABLE).encode()))
        await store.begun.wait()
        watched = manager.find("a")
        playing = asyncio.create_task(manager.command("a", "play"))
        await asyncio.sleep(0.2)
        store.gate.set()
        await opening
        told = (await playing)["playing"]
        await asyncio.sleep(0.2)
        found = watched.process is not None and not watched.process.lost
        await manager.close()
        store.close()
        return told, found

    told, found = asyncio.run(played())
    assert told and found


def test_a_session_that_is_played_while_it_steps_plays() -> None:
    """Another client's step ends then, and its answer does not say that nothing plays."""

    async def stepped() -> bool:
        store = Store(None)
        endless = {"solver": "verlet", "drag": 0, "tolerance": 0, "sub_iterations": 10_000}
        manager = await opened(store, {**CABLE, "settings": endless})
        stepping = asyncio.create_task(manager.command("a", "step", frames=100_000))
        while not manager.find("a").described["iteration"]:
            await asyncio.sleep(0.01)
        await manager.command("a", "play")
        await asyncio.wait_for(stepping, HANG)
        playing = manager.find("a").playing
        await manager.close()
        store.close()
        return playing

    assert asyncio.run(stepped())


def test_a_topology_has_the_tag_of_its_own_wiring() -> None:
    """An edit is made between the answer of the process and that to the client: a client that kept the old topology
    under the new tag would be told by 304 that it is the new one."""
    live = Live("a", "", dict(BEFORE), scene="scene ", wiring="before")

    class Sessions:
        def find(self, key: str) -> Live:
            return live

        async def export(self, *given: Any) -> tuple[dict[str, Any], bytes]:
            live.wiring = "after"
            return {**BEFORE, "wiring": "before", "notes": []}, b"{}"

    request = SimpleNamespace(app=SimpleNamespace(state=SimpleNamespace(sessions=Sessions())))
    answer = asyncio.run(routes.topology(cast(Request, request), "a", Conditions()))
    assert answer.headers["etag"] == '"scene before"'
