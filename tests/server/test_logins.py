"""A page's login outlives the server, not its end: cookies are kept as hashes, used up after a month, taken back."""

from __future__ import annotations

import asyncio
import os
import signal
import sqlite3
from collections.abc import Callable, Coroutine
from pathlib import Path
from typing import Any

import httpx
import pytest

from hookean_server import tokens
from hookean_server.problems import Problem
from hookean_server.store import Store
from hookean_server.tokens import LOGINS, UNUSED, Tokens
from serving import HANG

from .conftest import Served, problem


def with_store(path: Path | None, work: Callable[[Tokens], Coroutine[Any, Any, Any]]) -> Any:
    """What `work` returns of the tokens of a server that starts with the file of its sessions, and ends."""
    store = Store(path)
    store.start()

    async def run() -> Any:
        known = Tokens("t" * 20, store)
        await known.start()
        return await work(known)

    try:
        return asyncio.run(run())
    finally:
        store.close()


def given(many: int = 1) -> Callable[[Tokens], Coroutine[Any, Any, Any]]:
    async def work(known: Tokens) -> list[str]:
        return [await known.login() for _ in range(many)]

    return work


def let_in(values: list[str]) -> Callable[[Tokens], Coroutine[Any, Any, Any]]:
    async def work(known: Tokens) -> list[bool]:
        return [known.logged_in([value]) for value in values]

    return work


def test_a_page_goes_on_after_the_server_was_killed(tmp_path: Path) -> None:
    """The server is killed and started again on its port: the cookie still lets in, the old token does not, and a
    cookie that was taken back is worth nothing for good."""
    state = str(tmp_path / "sessions.db")
    first = Served(state=state, workers=1)
    try:
        cookies = [first.client.post("/v1/login").headers["set-cookie"].split(";")[0] for _ in range(2)]
        with httpx.Client(base_url=first.url, timeout=HANG) as page:
            assert page.get("/v1/sessions", headers={"cookie": cookies[0]}).status_code == 200
            assert page.delete("/v1/login", headers={"cookie": cookies[1]}).status_code == 204
        os.kill(first.process.pid, signal.SIGKILL)
        first.process.wait(HANG)
    finally:
        first.end()
    second = Served(state=state, workers=1)
    try:
        assert second.token != first.token
        # the name says which port of this machine the cookie is of, and this one is another
        named = [cookie.replace(str(first.port), str(second.port)) for cookie in cookies]
        with httpx.Client(base_url=second.url, timeout=HANG) as page:
            assert page.get("/v1/sessions", headers={"cookie": named[0]}).status_code == 200
            assert page.post("/v1/sessions/none/pause", headers={"cookie": named[0]}).status_code == 404
            problem(page.get("/v1/sessions", headers={"cookie": named[1]}), 401, "unauthorized")
            problem(page.get("/v1/sessions", headers=first.known), 401, "unauthorized")
        stored = b"".join(path.read_bytes() for path in tmp_path.iterdir())
        assert all(cookie.partition("=")[2].encode() not in stored for cookie in cookies)
    finally:
        second.end()


def test_cookies_of_another_folder_are_strangers(tmp_path: Path) -> None:
    values = with_store(tmp_path / "a.db", given())
    assert with_store(tmp_path / "a.db", let_in(values)) == [True]
    assert with_store(tmp_path / "b.db", let_in(values)) == [False]
    assert with_store(None, let_in(values)) == [False]


def test_old_cookies_make_room(tmp_path: Path) -> None:
    values = with_store(tmp_path / "a.db", given(LOGINS + 1))
    assert len(set(values)) == len(values)
    for _ in range(2):
        assert with_store(tmp_path / "a.db", let_in(values)) == [False] + [True] * LOGINS
    assert with_store(tmp_path / "a.db", let_in([""])) == [False]


def test_the_one_longest_unused_makes_room(monkeypatch: pytest.MonkeyPatch) -> None:
    now = 1e9
    monkeypatch.setattr(tokens.time, "time", lambda: now)

    async def work(known: Tokens) -> None:
        nonlocal now
        values = []
        for _ in range(LOGINS):
            values.append(await known.login())
            now += 1.0
        assert known.logged_in(values[:1])
        now += 1.0
        await known.login()
        assert [known.logged_in([value]) for value in values[:3]] == [True, False, True]

    with_store(None, work)


def test_a_cookie_ends_a_month_after_its_last_use(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Use is noted in the file too, so that the month begins anew whoever is started next."""
    now = 1e9
    monkeypatch.setattr(tokens.time, "time", lambda: now)
    values = with_store(tmp_path / "a.db", given(2))
    for _ in range(3):
        now += 0.9 * UNUSED
        used = values if now < 1e9 + UNUSED else values[:1]
        assert with_store(tmp_path / "a.db", let_in(used)) == [True] * len(used)
    assert with_store(tmp_path / "a.db", let_in(values)) == [True, False]
    now += UNUSED + 1.0
    assert with_store(tmp_path / "a.db", let_in(values)) == [False, False]
    with sqlite3.connect(tmp_path / "a.db") as db:
        assert db.execute("SELECT count(*) FROM logins").fetchone() == (0,)
    db.close()


def test_what_cannot_be_stored_is_said_where_it_matters(tmp_path: Path) -> None:
    """A login works without a disk until the server ends; taking one back for good does not, and is refused."""

    async def work(known: Tokens) -> None:
        def fails(work: Any) -> Any:
            raise Problem("not-stored", "the disk is full")

        kept, known.store.run = known.store.run, fails  # type: ignore[method-assign]
        value = await known.login()
        assert known.logged_in([value])
        with pytest.raises(Problem) as raised:
            await known.logout([value])
        assert raised.value.slug == "not-stored" and not known.logged_in([value])
        known.store.run = kept  # type: ignore[method-assign]

    with_store(tmp_path / "a.db", work)


def test_files_from_before_there_were_logins_are_taken_up(tmp_path: Path) -> None:
    path = tmp_path / "a.db"
    with_store(path, given())
    db = sqlite3.connect(path)
    db.execute("DROP TABLE logins")
    db.commit()
    db.close()
    values = with_store(path, given())
    assert with_store(path, let_in(values)) == [True]
    assert [p.name for p in tmp_path.iterdir() if "damaged" in p.name] == []
