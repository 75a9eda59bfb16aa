"""Read-only links: each has a token that reads one session, and nothing else, until it is revoked.

A session has at most one. It ends with the session, with the token of the service, and with the service. A page opened
by it sends `Authorization: Bearer <token>` with each request, never a cookie: a browser that is also logged in keeps
its log-in, and the page of the link still only reads. Sockets of browsers have no headers of their own: there the token
is the subprotocol `bearer.<token>`, offered beside `hookean`.
"""

from __future__ import annotations

import asyncio
import hashlib
import secrets
from dataclasses import dataclass, field
from typing import Protocol

SUBPROTOCOL = "hookean"
BEARER = "bearer."


class Shared(Protocol):
    """A session, as far as links are concerned."""

    key: str
    gone: bool


@dataclass(eq=False)
class Entry:
    """An authenticated client. `ended`: it is logged out, and its streams end."""

    used: float = 0.0
    ended: asyncio.Event = field(default_factory=asyncio.Event)


@dataclass(eq=False, kw_only=True)
class Guest(Entry):
    """A client with a read-only link to a session."""

    session: Shared
    token: str = field(repr=False)


class Guests:
    """The links of one server. Methods run on the event loop."""

    def __init__(self) -> None:
        self._guests: dict[str, Guest] = {}  # by the hash of the token

    def link(self, session: Shared) -> str:
        """The token of a session's link; a session without a link gets one."""
        if not (token := self.token(session)):
            token = secrets.token_urlsafe(32)
            self._guests[_hash(token)] = Guest(session=session, token=token)
        return token

    def token(self, session: Shared) -> str:
        """The token of a session's link; "" for a session without a link."""
        self._forget()
        return next((guest.token for guest in self._guests.values() if guest.session is session), "")

    def revoke(self, session: Shared) -> None:
        """Take the link of a session back, and close its sockets."""
        for guest in [guest for guest in self._guests.values() if guest.session is session]:
            self._end(guest)

    def close(self) -> None:
        """Take all links back."""
        for guest in list(self._guests.values()):
            self._end(guest)

    def named(self, token: str) -> Guest | None:
        """The client that sends this token; None if it is not that of a link."""
        self._forget()
        return self._guests.get(_hash(token))

    def _forget(self) -> None:
        """Links of deleted sessions end; another session under the same key has none."""
        for guest in [guest for guest in self._guests.values() if guest.session.gone]:
            self._end(guest)

    def _end(self, guest: Guest) -> None:
        self._guests.pop(_hash(guest.token), None)
        guest.ended.set()


def _hash(token: str) -> str:
    """A token is found by its hash: the time this takes tells nothing about how much of a guess was right."""
    return hashlib.sha256(token.encode()).hexdigest()
