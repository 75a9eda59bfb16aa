"""Who may: one token for each start of the server, and cookies that a page gets for it.

Programs send `Authorization: Bearer <token>`. A page is opened as `/#t=<token>`: the part behind # stays in the
browser; its script sends it once to `/v1/login` and gets a cookie that scripts cannot read.
"""

from __future__ import annotations

import hmac
import os
import re
import secrets
from collections import OrderedDict
from collections.abc import Iterable

VARIABLE = "HOOKEAN_TOKEN"
SHORTEST = 16
LOGINS = 64  # cookies that are valid at a time; the oldest goes first


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
    """The token of one server and the cookies given for it."""

    def __init__(self, token: str) -> None:
        self.token = token
        self._logins: OrderedDict[str, None] = OrderedDict()

    def named(self, authorization: str) -> bool:
        """Whether a header Authorization holds the token."""
        scheme, _, given = authorization.strip().partition(" ")
        return scheme.lower() == "bearer" and hmac.compare_digest(given.strip().encode(), self.token.encode())

    def login(self) -> str:
        """The value of a new cookie."""
        value = secrets.token_urlsafe(32)
        self._logins[value] = None
        while len(self._logins) > LOGINS:
            self._logins.popitem(last=False)
        return value

    def logged_in(self, values: Iterable[str]) -> bool:
        """Whether one of these values of the cookie was given and not taken back."""
        known = [k.encode() for k in self._logins]
        return any(hmac.compare_digest(v.encode(), k) for v in values for k in known)

    def logout(self, values: Iterable[str]) -> None:
        """Take cookies back."""
        for value in values:
            self._logins.pop(value, None)


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
