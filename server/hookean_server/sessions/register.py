"""The keys of sessions: which sessions there are, which are being made, which have been deleted.

A session is one creation under a key. Callers that wait for it hold the object, never the key alone,
and find out that it was deleted even if another one has its key by then.
"""

from __future__ import annotations

from collections.abc import AsyncIterator, Iterator
from contextlib import asynccontextmanager, contextmanager

from hookean_server.problems import Problem
from hookean_server.sessions.live import Live


class Deleted(Problem):
    """The session has been deleted while the request waited for it."""

    def __init__(self) -> None:
        super().__init__("not-found", "This session has been deleted.")


class Register:
    """Sessions by their keys, at most `most`. All methods run on the event loop."""

    def __init__(self, most: int) -> None:
        self.most = most
        self.sessions: dict[str, Live] = {}
        self.making: dict[str, Live] = {}

    def find(self, key: str | Live) -> Live:
        """The session of a key, or the one given where it is not deleted; raises `not-found`."""
        if isinstance(key, Live):
            if key.gone:
                raise Deleted
            live = key
        elif key in self.sessions:
            live = self.sessions[key]
        else:
            raise Problem("not-found", "There is no session with this key; GET /v1/sessions lists all.")
        live.use()
        return live

    @asynccontextmanager
    async def held(self, live: Live) -> AsyncIterator[None]:
        """The lock of a session that is still there then; raises Deleted."""
        async with live.lock:
            if live.gone:
                raise Deleted
            yield

    @contextmanager
    def reserved(self, live: Live) -> Iterator[None]:
        """The key of a session, and its place among those that are kept, from before any work on it begins.

        The session is there once the block is done; where that raises, its key is free again. Raises `key-taken`,
        `session-limit`.
        """
        if live.key in self.sessions or live.key in self.making:
            raise Problem("key-taken", "A session with this key exists already; choose another key, or omit it.")
        if (count := len(self.sessions) + len(self.making)) >= self.most:
            said = f"There are {count} sessions, the most allowed; delete one that you do not need."
            raise Problem("session-limit", said, headers={"retry-after": "60"})
        self.making[live.key] = live
        try:
            yield
            self.sessions[live.key] = live
        except BaseException:
            live.gone = True
            raise
        finally:
            del self.making[live.key]
            live.made.set()

    async def settled(self, key: str) -> Live | None:
        """The session of a key once none is being made under it."""
        while key in self.making:
            await self.making[key].made.wait()
        return self.sessions.get(key)

    def forget(self, live: Live) -> None:
        """A session is deleted: its key is free, and all that hold it are notified."""
        live.gone = True
        if self.sessions.get(live.key) is live:
            del self.sessions[live.key]
