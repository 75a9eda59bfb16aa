"""Requests for one key that come at once: each succeeds or conflicts, and what is acknowledged is held."""

from __future__ import annotations

import asyncio
import json
import threading
from collections import Counter
from collections.abc import Callable, Iterator
from typing import Any

import httpx
import pytest
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

from hookean_server.problems import Problem
from hookean_server.sessions import rows, upkeep
from hookean_server.sessions.frames import _Client
from hookean_server.sessions.live import Live
from hookean_server.sessions.manager import Manager
from hookean_server.sessions.process import SessionProcess
from hookean_server.settings import Settings
from hookean_server.store import Store
from serving import CABLE, HANG, wait_for

from .conftest import Served
from .test_manager import SlowStore

MOST = 6
FAULTY = {"particles": [[0, 0, "x"]]}


@pytest.fixture(scope="module")
def served() -> Iterator[Served]:
    server = Served(sessions=MOST, awake=4)
    yield server.ready()
    server.end()


@pytest.fixture
def client(served: Served) -> Iterator[httpx.Client]:
    def keys() -> list[str]:
        return [session["key"] for session in served.client.get("/v1/sessions").json()["sessions"]]

    for key in keys():
        served.client.delete(f"/v1/sessions/{key}")
    workers = served.health()["workers"]
    yield served.client
    for key in keys():
        served.client.delete(f"/v1/sessions/{key}")
    # the processes that solve are left, and no session's
    wait_for(lambda: len(served.workers()) == sum(workers.values()))


def at_once(*requests: Callable[[], httpx.Response]) -> list[httpx.Response]:
    """The answers to requests that are sent at one moment."""
    start, found = threading.Barrier(len(requests)), {}

    def ask(number: int, request: Callable[[], httpx.Response]) -> None:
        start.wait(HANG)
        found[number] = request()

    threads = [threading.Thread(target=ask, args=pair) for pair in enumerate(requests)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return [found[number] for number in range(len(requests))]


def branch(client: httpx.Client, to: str) -> Callable[[], httpx.Response]:
    return lambda: client.post("/v1/sessions/a/branches", params={"to": to})


def put(client: httpx.Client, key: str, scene: Any = CABLE) -> Callable[[], httpx.Response]:
    return lambda: client.put(f"/v1/sessions/{key}", json=scene)


def test_of_branches_to_one_key_at_once_one_is_made(client: httpx.Client) -> None:
    put(client, "a")()
    found = at_once(*[branch(client, "b")] * 8)
    assert Counter(answer.status_code for answer in found) == {201: 1, 409: 7}
    assert {answer.json()["type"] for answer in found if answer.status_code == 409} == {"/problems/key-taken"}
    assert [s["key"] for s in client.get("/v1/sessions").json()["sessions"]] == ["a", "b"]


def test_a_branch_and_a_scene_for_one_key_make_one_session(client: httpx.Client) -> None:
    """The scene comes second, on the branch, or the branch is refused: both answers never report a new session."""
    put(client, "a")()
    longer = {**CABLE, "particles": [*CABLE["particles"], [12, 0, 0]]}
    for _ in range(10):
        branched, made = at_once(branch(client, "b"), put(client, "b", longer))
        assert (branched.status_code, made.status_code) in ((201, 200), (409, 201))
        assert client.get("/v1/sessions/b").json()["particles"] == 7
        assert client.delete("/v1/sessions/b").status_code == 204


@pytest.mark.parametrize("keys", [["b"] * 32, [f"b{i}" for i in range(32)]], ids=["one key", "their own keys"])
def test_with_room_for_one_of_32_branches_one_is_made(client: httpx.Client, keys: list[str]) -> None:
    put(client, "a")()
    for number in range(MOST - 2):
        put(client, f"full-{number}")()
    found = at_once(*(branch(client, key) for key in keys))
    counted = Counter(answer.status_code for answer in found)
    assert counted[201] == 1 and counted[409] + counted[429] == 31
    assert len(client.get("/v1/sessions").json()["sessions"]) == MOST


def test_a_scene_beside_a_faulty_one_makes_its_session(client: httpx.Client) -> None:
    for _ in range(12):
        one, faulty, other = at_once(put(client, "a"), put(client, "a", FAULTY), put(client, "a"))
        assert faulty.status_code == 422
        assert sorted((one.status_code, other.status_code)) == [200, 201]
        client.delete("/v1/sessions/a")


def test_a_scene_beside_a_deletion_makes_a_session_or_is_deleted(client: httpx.Client) -> None:
    for _ in range(12):
        first = put(client, "a")().json()
        again, gone = at_once(put(client, "a"), lambda: client.delete("/v1/sessions/a"))
        assert gone.status_code == 204
        left = client.get("/v1/sessions/a")
        assert (again.status_code, left.status_code) in ((200, 404), (201, 200))
        assert left.status_code == 404 or left.json()["etag"] == again.json()["etag"] != first["etag"]
        client.delete("/v1/sessions/a")


def test_who_watches_a_session_that_is_made_again_is_sent_away(served: Served, client: httpx.Client) -> None:
    """Close code 4404, though another session has the key by then; an edit of the old watcher reaches neither."""
    address = f"{served.url.replace('http', 'ws')}/v1/sessions/a/frames"
    for _ in range(5):
        put(client, "a")()
        with connect(address, additional_headers=served.known) as socket:
            assert "hello" in json.loads(socket.recv(timeout=HANG))
            gone, made = at_once(lambda: client.delete("/v1/sessions/a"), put(client, "a"))
            assert gone.status_code == 204
            if made.status_code == 200:
                made = put(client, "a")()
            with pytest.raises(ConnectionClosed) as closed:
                socket.send(json.dumps({"id": 1, "edit": {"release": [0]}}))
                while True:
                    assert "problem" in (said := socket.recv(timeout=HANG)) or '"id": 1' not in str(said)
        assert closed.value.rcvd is not None and closed.value.rcvd.code == 4404
        assert client.get("/v1/sessions/a").json()["revision"] == 0
        client.delete("/v1/sessions/a")


def test_what_is_acknowledged_is_in_the_session_that_acknowledged_it(served: Served, client: httpx.Client) -> None:
    """One client deletes a session and makes it again; others edit it. The creation is in the ETag of each answer: the
    scene of the same creation has the last edit that it acknowledged, and those of others are not in it."""
    edits: list[tuple[str, int, float]] = []
    over = threading.Event()

    def edit(number: int) -> None:
        with httpx.Client(base_url=served.url, headers=served.known, timeout=HANG) as own:
            load = float(-1 - number)
            while not over.is_set():
                load -= 3.0
                answer = own.patch("/v1/sessions/a", json={"forces": {"1": {"vector": [0, 0, load]}}})
                assert answer.status_code in (200, 404), answer.text
                if answer.status_code == 200:
                    creation, revision, _ = answer.headers["etag"].strip('"').split("-")
                    edits.append((creation, int(revision), load))

    editors = [threading.Thread(target=edit, args=(number,)) for number in range(3)]
    put(client, "a")()
    for editor in editors:
        editor.start()
    ends: list[tuple[str, int, float]] = []
    for _ in range(15):
        wait_for(lambda count=len(edits): len(edits) > count + 3)
        answer = client.get("/v1/sessions/a/scene")
        creation, revision, _ = answer.headers["etag"].strip('"').split("-")
        ends.append((creation, int(revision), answer.json()["forces"][1]["vector"][2]))
        assert client.delete("/v1/sessions/a").status_code == 204
        assert put(client, "a")().status_code == 201
    over.set()
    for editor in editors:
        editor.join()
    acknowledged = {(creation, revision): load for creation, revision, load in edits}
    assert len(acknowledged) == len(edits), "no revision of a creation is acknowledged twice"
    assert len({creation for creation, _, _ in ends}) == 15
    for creation, revision, load in ends:
        assert load == (acknowledged[creation, revision] if revision else -20)


# with a store and processes that take as long as the test wants


async def opened(store: Store, **settings: Any) -> Manager:
    manager = Manager(Settings(**settings), store)
    await manager.start()
    await manager.put("a", json.dumps(CABLE).encode())
    return manager


def test_a_second_deletion_does_not_take_the_session_made_after_the_first() -> None:
    async def raced() -> tuple[list[Any], Any]:
        store = SlowStore("delete")
        manager = await opened(store)
        old, body = manager.find("a"), json.dumps(CABLE).encode()
        first = asyncio.create_task(manager.delete("a"))
        await store.begun.wait()
        others = [manager.put("a", body), manager.delete("a"), manager.edit("a", b'{"release": [0]}')]
        waiting = [asyncio.create_task(other) for other in others]
        await asyncio.sleep(0.1)
        store.gate.set()
        await first
        found = await asyncio.gather(*waiting, return_exceptions=True)
        assert old.gone and manager.find("a") is not old
        kept = await store.run(rows.load("a"))
        await manager.close()
        store.close()
        return found, kept

    (made, gone, edited), kept = asyncio.run(raced())
    assert made[2] is True and kept is not None
    assert all(isinstance(refused, Problem) and refused.slug == "not-found" for refused in (gone, edited))
    assert kept.edits == [], "the edit of the old session is not in the new one"


@pytest.mark.parametrize("meanwhile", ["nothing", "read", "watched", "made again"])
def test_a_session_that_is_used_while_old_ones_are_looked_for_is_not_forgotten(meanwhile: str) -> None:
    """Nor is one that was made again under its key. What nobody used is, with its process."""

    async def raced() -> tuple[bool, bool]:
        store = SlowStore("age")
        manager = await opened(store, session_seconds=-1.0)
        old, process = manager.sessions["a"], manager.sessions["a"].process
        forgetting = asyncio.create_task(upkeep.forget(manager, 0.0))
        await store.begun.wait()
        if meanwhile == "read":
            manager.find("a")
        elif meanwhile == "watched":
            await manager.watch("a")
        elif meanwhile == "made again":
            await manager.delete("a")
            await manager.put("a", json.dumps(CABLE).encode())
        store.gate.set()
        await forgetting
        assert old.gone == (old.process is None) == (meanwhile in ("nothing", "made again")) and process is not None
        found = "a" in manager.sessions, await store.run(rows.load("a")) is not None
        await manager.close()
        store.close()
        return found

    assert asyncio.run(raced()) == ((False, False) if meanwhile == "nothing" else (True, True))


def test_an_edit_that_comes_while_its_session_is_forgotten_is_refused() -> None:
    async def raced() -> tuple[list[Any], Any]:
        store = SlowStore("delete")
        manager = await opened(store, session_seconds=-1.0)
        forgetting = asyncio.create_task(upkeep.forget(manager, 0.0))
        await store.begun.wait()
        others = [manager.edit("a", b'{"release": [0]}'), manager.watch("a")]
        waiting = [asyncio.create_task(other) for other in others]
        await asyncio.sleep(0.1)
        store.gate.set()
        await forgetting
        found, kept = await asyncio.gather(*waiting, return_exceptions=True), await store.run(rows.load("a"))
        await manager.close()
        store.close()
        return found, kept

    found, kept = asyncio.run(raced())
    assert kept is None
    assert all(isinstance(refused, Problem) and refused.slug == "not-found" for refused in found)


@pytest.mark.parametrize("making", [False, True])
def test_what_nobody_knows_of_is_forgotten_but_not_what_is_being_made(making: bool) -> None:
    """A row of the store whose maker has left, under a key that is free, or that somebody else makes a session of."""

    async def raced() -> bool:
        store = Store(None)
        manager = await opened(store, session_seconds=-1.0)
        await store.run(rows.put("b", "", b"base", manager.find("a").described, []))
        if making:
            manager.making["b"] = Live("b", "", {})
        await upkeep.forget(manager, 0.0)
        found = await store.run(rows.load("b")) is not None
        await manager.close()
        store.close()
        return found

    assert asyncio.run(raced()) is making


class Begun(list[SessionProcess]):
    """Every process of a session that is started; its start is over once `gate` is open."""

    def __init__(self) -> None:
        super().__init__()
        self.gate = threading.Event()
        self.gate.set()


@pytest.fixture
def begun(monkeypatch: pytest.MonkeyPatch) -> Iterator[Begun]:
    found = Begun()
    init = SessionProcess.__init__

    def noted(self: SessionProcess, *given: Any) -> None:
        init(self, *given)
        found.append(self)
        assert found.gate.wait(HANG)

    monkeypatch.setattr(SessionProcess, "__init__", noted)
    yield found
    for process in found:
        process.kill()


def test_a_session_that_is_deleted_while_it_wakes_leaves_no_process(begun: Begun) -> None:
    async def raced() -> None:
        store = Store(None)
        manager = await opened(store)
        await manager._sleep(manager.find("a"), HANG)
        begun.gate.clear()
        waking = asyncio.create_task(manager.export("a", "scene"))
        while len(begun) < 2:
            await asyncio.sleep(0.01)
        await manager.delete("a")
        begun.gate.set()
        found = await asyncio.gather(waking, return_exceptions=True)
        assert isinstance(found[0], Problem) and "deleted" in found[0].detail
        assert all(not process.process.is_alive() or process.lost for process in await ended(begun))
        await manager.close()
        store.close()

    asyncio.run(raced())


async def ended(begun: Begun) -> Begun:
    """The processes, once they had the time to end that they are given."""
    await asyncio.to_thread(lambda: [process.join(5.0) for process in begun])
    return begun


def test_a_client_that_leaves_while_a_session_wakes_leaves_it_whole(begun: Begun) -> None:
    """What it had begun is ended, and the next one to ask has the session awake."""

    async def left() -> None:
        store = Store(None)
        manager = await opened(store)
        live = manager.find("a")
        for moments in range(8):
            await manager._sleep(live, HANG)
            asking = asyncio.create_task(manager.command("a", "play"))
            for _ in range(moments * 3):
                await asyncio.sleep(0.002)
            asking.cancel()
            await asyncio.gather(asking, return_exceptions=True)
            assert json.loads((await manager.export("a", "scene"))[1])["forces"]
            await manager.command("a", "pause")
        await manager.delete("a")
        await asyncio.to_thread(wait_for, lambda: all(process.lost for process in begun))
        await manager.close()
        store.close()

    asyncio.run(left())


@pytest.mark.soak
def test_no_more_are_awake_than_may_be_however_many_are_asked_for_at_once(begun: Begun) -> None:
    async def asked() -> int:
        store = Store(None)
        manager = await opened(store, awake=2)
        body = json.dumps(CABLE).encode()
        for key in "bcdef":
            await manager.put(key, body)
        most = 0

        async def count() -> None:
            nonlocal most
            while True:
                most = max(most, sum(live.process is not None for live in manager.sessions.values()))
                await asyncio.sleep(0)

        counting = asyncio.create_task(count())
        found = await asyncio.gather(*(manager.export(key, "scene") for key in "abcdef"))
        made = await asyncio.gather(*(manager.put(key, body) for key in "uvwxyz"))
        counting.cancel()
        assert len(found) == len(made) == 6
        await manager.close()
        store.close()
        return most

    assert asyncio.run(asked()) <= 2


def test_news_that_come_late_do_not_replace_newer_ones() -> None:
    """The answer to a step is taken up after that to a later edit: the session stays at the edit's revision, which is
    what conditions are compared with."""
    live = Live("a", "", {"revision": 0, "status": "running"})
    for revision, told in ((2, 20), (1, 10)):
        then = live.note({"revision": revision, "status": "running", "told": told})
        assert then["revision"] == revision
    assert live.described["revision"] == 2


def test_an_answer_over_the_socket_is_never_older_than_the_state_before_it() -> None:
    """A run that ends while its order is being answered: the last message tells that it ended, so a page that shows
    the last message does not show it as playing for ever."""
    live = Live("quick", "", {"revision": 0, "status": "running", "playing": False})
    told: list[dict[str, Any]] = []

    class Sessions:
        closing = False

        async def command(self, live: Live, do: str, **options: Any) -> dict[str, Any]:
            begun = live.note({"revision": 0, "status": "running", "playing": True, "told": 1})
            live.note({"revision": 0, "status": "converged", "playing": False, "told": 2})
            await asyncio.sleep(0.01)  # the state goes out meanwhile
            return begun

    class Socket:
        asked, scope = asyncio.Event(), dict[str, Any]()

        async def receive(self) -> dict[str, Any]:
            if self.asked.is_set():
                await asyncio.Event().wait()
            self.asked.set()
            return {"type": "websocket.receive", "text": json.dumps({"id": 1, "do": "relax"})}

        async def send_text(self, text: str) -> None:
            told.append(json.loads(text))

    async def watched() -> None:
        client = _Client(Socket(), Sessions(), live, changes=False)  # type: ignore[arg-type]
        tasks = [asyncio.create_task(client.send()), asyncio.create_task(client.receive())]
        while not any("id" in message for message in told):
            await asyncio.sleep(0.001)
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)

    asyncio.run(asyncio.wait_for(watched(), HANG))
    state, answer = told[-2]["state"], told[-1]["session"]
    assert state["status"] == answer["status"] == "converged"
    assert state["playing"] is answer["playing"] is False
