"""Authentication: one token for each start of the server, cookies that a page gets for it, and codes for one log-in.

Programs send `Authorization: Bearer <token>`. A page is opened as `/#t=<token or code>`: the part after # stays in
the browser; its script sends it once to `/v1/login` and gets a cookie that scripts cannot read. All of it ends with the
server; a cookie is good for its port alone and for hours, and is renewed while it is used.
"""

from __future__ import annotations

import hashlib
import hmac
import os
import re
import secrets
import time
from collections.abc import Callable, Iterable

from hookean_server.http.guests import Entry, Guests

VARIABLE = "HOOKEAN_TOKEN"
SHORTEST = 16
LOGINS = 64  # browsers that are logged in at a time; the one longest unused goes first
LIFE = 12 * 3600.0  # seconds a cookie is good for
RENEWED = 600.0  # seconds after which an answer brings a new one
CODES = 16  # codes that wait to be used at a time; the oldest goes first
CODE_LIFE = 60.0  # seconds


class Unfit(ValueError):
    """An invalid token; the sentence names the allowed ones."""


def chosen(given: str = "") -> str:
    """The token of this start: the given one, that of HOOKEAN_TOKEN, or 256 random bits. Raises Unfit.

    The variable is taken out of the environment: processes that read foreign files need no secret.
    """
    named = os.environ.pop(VARIABLE, "")
    token = given or named or secrets.token_urlsafe(32)
    if not re.fullmatch(rf"[A-Za-z0-9._~+/-]{{{SHORTEST},200}}=*", token):
        raise Unfit(f"{VARIABLE} accepts {SHORTEST} to 200 letters, digits and . _ ~ + / -.")
    return token


class Tokens:
    """The token of one server, the cookies given for it, and codes. Methods run on the event loop.

    `proof` is the key by which this server shows clients that it is the one that wrote the file they read. `publish`
    writes that file for a new token and key; it may raise OSError.
    """

    def __init__(self, token: str) -> None:
        self.token, self.proof = token, secrets.token_hex(32)
        self.publish: Callable[[str, str], None] = lambda token, proof: None
        self._begin()

    def _begin(self) -> None:
        self._key = secrets.token_bytes(32)
        self._bearer = Entry()
        self._logins: dict[str, Entry] = {}
        self._codes: dict[str, float] = {}  # when each ends, by its hash
        self.guests = Guests()

    def renew(self) -> None:
        """Log all clients out: a new token, no cookies, no codes. Raises OSError, and changes nothing, where
        clients cannot be given the new one."""
        token, proof = secrets.token_urlsafe(32), secrets.token_hex(32)
        self.publish(token, proof)
        before, guests = [self._bearer, *self._logins.values()], self.guests
        self.token, self.proof = token, proof
        self._begin()
        for entry in before:
            entry.ended.set()
        guests.close()

    def named(self, authorization: str) -> Entry | None:
        """The client that sends this header Authorization; None if it does not have the token."""
        return self._bearer if hmac.compare_digest(bearer(authorization).encode(), self.token.encode()) else None

    def proven(self, instance: str, address: str, port: int, nonce: str) -> str:
        """What only a process that knows the key can answer to a nonce that reached it at this address: HMAC-SHA256,
        in hex. What was passed on from elsewhere reached it at another."""
        said = f"hookean {instance} {address.removeprefix('::ffff:')} {port} {nonce}"
        return hmac.new(self.proof.encode(), said.encode(), hashlib.sha256).hexdigest()

    @property
    def frame(self) -> str:
        """What an address of the page has by which a client with the token allows pages of this machine to show it in
        a frame. It opens nothing: who is in the frame logs in there."""
        return self._mac("frame", "page")

    # codes

    def code(self) -> str:
        """A code that replaces the token for one log-in within a minute."""
        self._forget_codes()
        code = secrets.token_urlsafe(32)
        self._codes[_hash(code)] = time.monotonic() + CODE_LIFE
        while len(self._codes) > CODES:
            del self._codes[next(iter(self._codes))]
        return code

    def waits(self, known: str) -> bool:
        """Whether a code can still be used, by its hash."""
        self._forget_codes()
        return known in self._codes

    def spend(self, authorization: str) -> Entry | None:
        """The client that sends this header Authorization; None if it has no unused code. The code is then used."""
        self._forget_codes()
        return self._bearer if self._codes.pop(_hash(bearer(authorization)), None) is not None else None

    def _forget_codes(self) -> None:
        now = time.monotonic()
        self._codes = {known: until for known, until in self._codes.items() if until > now}

    # cookies

    def login(self, name: str) -> str:
        """The value of a new cookie of this name."""
        who = secrets.token_urlsafe(16)
        self._logins[who] = Entry(time.monotonic())
        while len(self._logins) > LOGINS:
            self._end(min(self._logins, key=lambda known: self._logins[known].used))
        return self._signed(name, who)

    def logged_in(self, name: str, values: Iterable[str]) -> tuple[Entry | None, str]:
        """The client that sends one of these values of the cookie, None if they are invalid or expired; a new value,
        empty if the one sent stays valid."""
        now = time.monotonic()
        for value in values:
            who, given = self._read(name, value)
            entry = self._logins.get(who)
            if entry is not None and now - given < LIFE:
                entry.used = now
                return entry, self._signed(name, who) if now - given > RENEWED else ""
        return None, ""

    def logout(self, name: str, values: Iterable[str]) -> None:
        """Take cookies back, and all that they were renewed by."""
        for value in values:
            self._end(self._read(name, value)[0])

    def _end(self, who: str) -> None:
        entry = self._logins.pop(who, None)
        if entry is not None:
            entry.ended.set()

    def _signed(self, name: str, who: str) -> str:
        said = f"{who}.{int(time.monotonic())}"
        return f"{said}.{self._mac(name, said)}"

    def _read(self, name: str, value: str) -> tuple[str, float]:
        """The client with this value of a cookie, and when it was issued; None if this server did not issue it."""
        said, _, mac = value.rpartition(".")
        if not hmac.compare_digest(mac.encode(), self._mac(name, said).encode()):
            return "", 0.0
        who, _, given = said.rpartition(".")
        return who, float(given)

    def _mac(self, name: str, said: str) -> str:
        return hmac.new(self._key, f"{name}={said}".encode(), hashlib.sha256).hexdigest()


def bearer(authorization: str) -> str:
    """The token in a header Authorization; "" if it has none."""
    scheme, _, given = authorization.strip().partition(" ")
    return given.strip() if scheme.lower() == "bearer" else ""


def _hash(value: str) -> str:
    """What is kept of a code: 256 random bits need no salt, and nobody finds them by their hash."""
    return hashlib.sha256(value.encode()).hexdigest()


def cookie_name(port: object) -> str:
    """Browsers send a cookie to every port of a host: the name distinguishes servers."""
    return f"hookean-{port}"


def cookies(header: str, name: str) -> list[str]:
    """The values of one name in a header Cookie."""
    pairs = [part.strip().partition("=") for part in header.split(";")]
    return [value for key, _, value in pairs if key == name]


def set_cookie(name: str, value: str) -> str:
    """The header Set-Cookie for a login; an empty value takes the cookie back."""
    return f"{name}={value}; Path=/; HttpOnly; SameSite=Strict; Max-Age={int(LIFE) if value else 0}"
