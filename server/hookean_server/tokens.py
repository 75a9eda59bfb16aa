"""Who may: one token for each start of the server, and cookies that a page gets for it.

Programs send `Authorization: Bearer <token>`. A page is opened as `/#t=<token>`: the part behind # stays in the
browser; its script sends it once to `/v1/login` and gets a cookie that scripts cannot read. The token ends with the
server; cookies outlive it, so that a page goes on where the server is started again. Of them the store has hashes.
"""

from __future__ import annotations

import hashlib
import hmac
import os
import re
import secrets
import sqlite3
import time
from collections.abc import Iterable
from contextlib import suppress

from hookean_server.problems import Problem
from hookean_server.store import Store, Work

VARIABLE = "HOOKEAN_TOKEN"
SHORTEST = 16
LOGINS = 64  # cookies that are valid at a time; the one longest unused goes first
UNUSED = 30 * 24 * 3600.0  # seconds after which a cookie that nobody used is worth nothing
NOTED = 3600.0  # seconds of use that may be missing in the store


class Unfit(ValueError):
    """A token that cannot be one; the sentence says what it takes."""


def chosen(given: str = "") -> str:
    """The token of this start: the given one, that of HOOKEAN_TOKEN, or 256 random bits. Raises Unfit.

    The variable is taken out of the environment: processes that read foreign files need no secret.
    """
    named = os.environ.pop(VARIABLE, "")
    token = given or named or secrets.token_urlsafe(32)
    if not re.fullmatch(rf"[A-Za-z0-9._~+/-]{{{SHORTEST},200}}=*", token):
        raise Unfit(f"{VARIABLE} takes {SHORTEST} to 200 letters, digits and . _ ~ + / -.")
    return token


class Tokens:
    """The token of one server, and the cookies given for it and for those before it. Methods run on the event loop."""

    def __init__(self, token: str, store: Store) -> None:
        self.token, self.store = token, store
        self._logins: dict[str, float] = {}  # when each was last used [s since 1970], by its hash
        self._noted: dict[str, float] = {}  # the same as the store has it

    async def start(self) -> None:
        """Take up the cookies that the store has; none where it cannot be read."""
        with suppress(Problem):
            self._noted = await self.store.run(_kept)
        self._logins = dict(self._noted)

    def named(self, authorization: str) -> bool:
        """Whether a header Authorization holds the token."""
        scheme, _, given = authorization.strip().partition(" ")
        return scheme.lower() == "bearer" and hmac.compare_digest(given.strip().encode(), self.token.encode())

    async def login(self) -> str:
        """The value of a new cookie. Where it cannot be stored it ends with the server."""
        value = secrets.token_urlsafe(32)
        self._logins[_hash(value)] = time.time()
        while len(self._logins) > LOGINS:
            del self._logins[min(self._logins, key=lambda known: self._logins[known])]
        with suppress(Problem):
            await self._store()
        return value

    def logged_in(self, values: Iterable[str]) -> bool:
        """Whether one of these values of the cookie was given, used since, and not taken back."""
        now = time.time()
        for known in map(_hash, values):
            if known in self._logins and now - self._logins[known] < UNUSED:
                self._logins[known] = now
                if now - self._noted.get(known, now) > NOTED:
                    self._noted[known] = now
                    self.store.submit(_put({known: now}))
                return True
        return False

    async def logout(self, values: Iterable[str]) -> None:
        """Take cookies back for good. Raises the problem `not-stored`; they are worth nothing even then, until the
        server is started again."""
        for known in map(_hash, values):
            self._logins.pop(known, None)
        await self._store()

    async def _store(self) -> None:
        """Make the store's cookies those that are known."""
        kept = dict(self._logins)
        await self.store.run(_put(kept, only=True))
        self._noted = kept


def _hash(value: str) -> str:
    """What is kept of a cookie: 256 random bits need no salt, and nobody finds them by their hash."""
    return hashlib.sha256(value.encode()).hexdigest()


def _kept(db: sqlite3.Connection) -> dict[str, float]:
    """When each cookie was last used, by its hash; those long unused are forgotten."""
    db.execute("DELETE FROM logins WHERE used < ?", (time.time() - UNUSED,))
    rows = db.execute("SELECT hash, used FROM logins WHERE typeof(used) = 'real' ORDER BY used DESC LIMIT ?", (LOGINS,))
    return {str(known): float(used) for known, used in rows}


def _put(logins: dict[str, float], *, only: bool = False) -> Work:
    """Store when cookies were last used; with `only` no other is kept."""

    def work(db: sqlite3.Connection) -> None:
        if only:
            db.execute("DELETE FROM logins")
        db.executemany("INSERT OR REPLACE INTO logins VALUES (?, ?)", list(logins.items()))

    return work


def cookie_name(port: object) -> str:
    """Browsers send a cookie to every port of a host: the name tells servers apart."""
    return f"hookean-{port}"


def cookies(header: str, name: str) -> list[str]:
    """The values of one name in a header Cookie."""
    pairs = [part.strip().partition("=") for part in header.split(";")]
    return [value for key, _, value in pairs if key == name]


def set_cookie(name: str, value: str) -> str:
    """The header Set-Cookie for a login; an empty value takes the cookie back."""
    ends = "" if value else "; Max-Age=0"
    return f"{name}={value}; Path=/; HttpOnly; SameSite=Strict{ends}"
