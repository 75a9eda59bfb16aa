"""Authentication: hosts, origins and tokens of requests and WebSockets, checked before anything is read."""

from __future__ import annotations

import asyncio
from contextlib import suppress

from starlette.datastructures import MutableHeaders
from starlette.requests import ClientDisconnect
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from hookean_server.http import access
from hookean_server.http.access import Access, Table
from hookean_server.http.claimed import NAMES
from hookean_server.http.guests import BEARER, Entry, Guest
from hookean_server.http.tokens import Tokens, bearer, cookie_name, cookies, set_cookie
from hookean_server.problems import Problem
from hookean_server.settings import Settings

SAFE = {"GET", "HEAD", "OPTIONS"}
CORS = {
    "access-control-allow-methods": "GET, POST, PUT, PATCH, DELETE",
    "access-control-allow-headers": (
        "authorization, content-type, if-match, if-none-match, idempotency-key, last-event-id"
    ),
    "access-control-max-age": "600",
}
READ_ONLY = (
    "This link only reads its session; ask the person who shared it to change something, or to open another session."
)
EXPOSED = ", ".join(("etag", "location", "retry-after", "server-timing", "x-request-id", *NAMES))


class Guard:
    """Refuses other hosts, pages of other sites, clients without the token, compressed bodies and huge headers."""

    def __init__(self, app: ASGIApp, settings: Settings, tokens: Tokens, table: Table) -> None:
        self.app, self.settings, self.tokens, self.table = app, settings, tokens, table
        self.names = {"127.0.0.1", "localhost", "[::1]", *(h.lower() for h in settings.hosts)}
        self.origins = {o.lower() for o in settings.origins}

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """One request."""
        if scope["type"] not in ("http", "websocket"):
            await self.app(scope, receive, send)
            return
        headers = _Headers(scope)
        self._check_host(scope, headers)
        if not access.is_plain(scope["path"]):
            raise Problem("not-found", "This address does not exist; GET /v1/openapi.json lists every one.")
        if scope.get("preflight"):  # of a listed origin; the answer's headers are added further out
            await send({"type": "http.response.start", "status": 204, "headers": []})
            await send({"type": "http.response.body", "body": b""})
            return
        # a socket has no method, and none is open
        needed = self.table.access(scope["method"], scope["path"]) if scope["type"] == "http" else Access.TOKEN
        self._check_origin(scope, headers, needed)
        entry, renewal = self._entry(scope, headers, needed)
        if isinstance(entry, Guest):
            self._only_read(scope, entry)
        if any(encoding not in ("identity", "") for encoding in headers.all(b"content-encoding")):
            said = "The body is compressed; send it uncompressed, without Content-Encoding."
            raise Problem("unsupported-media", said)
        if entry is not None and (known := scope.get("state", {}).get("known")):
            known()
        if entry is None:
            await self.app(scope, receive, send)
        elif scope["type"] == "websocket":
            await _Watched(entry, receive, send).run(self.app, scope)
        else:
            await self.app(scope, receive, _while_in(entry, renewal, _cookie_of(scope), send))

    def _check_host(self, scope: Scope, headers: _Headers) -> None:
        if headers.size > self.settings.header_limit:
            raise Problem("headers-too-large", f"At most {self.settings.header_limit} bytes of headers are accepted.")
        hosts = headers.all(b"host")
        if len(hosts) != 1 or not self._ours(hosts[0], scope):
            raise Problem("forbidden-host", "Address this service as 127.0.0.1, localhost or [::1] with its port.")

    def _ours(self, host: str, scope: Scope) -> bool:
        name, colon, port = host.rpartition(":")
        if not colon or host.endswith("]"):
            name, port = host, "80"
        served = scope.get("server") or (None, None)
        return name in self.names and port == str(served[1] if served[1] is not None else 80)

    def _check_origin(self, scope: Scope, headers: _Headers, needed: Access) -> None:
        origins, sites = headers.all(b"origin"), headers.all(b"sec-fetch-site")
        if origins and needed is Access.HOPS:
            raise Problem("forbidden-origin", "These addresses are for Hops only; web pages may not use them.")
        if scope["type"] == "http" and scope["method"] in SAFE:
            return
        if len(origins) > 1 or any(o != headers.own and o not in self.origins for o in origins):
            raise Problem("forbidden-origin", "Pages of another origin may not send this request.")
        if not _same_site(sites) and not (origins and origins[0] in self.origins):
            raise Problem("forbidden-origin", "Pages of another site may not send this request.")

    def _entry(self, scope: Scope, headers: _Headers, needed: Access) -> tuple[Entry | None, str]:
        """The client that sends this, and a new value for its cookie if due; None for open operations. Raises the
        problem `unauthorized`."""
        if needed in (Access.OPEN, Access.HOPS):
            return None, ""
        given = headers.all(b"authorization", lower=False)
        entry: Entry | None = None
        renewal = ""
        if links := headers.links if scope["type"] == "websocket" else []:
            entry = self.tokens.guests.named(links[0])  # whatever cookie a browser adds
        elif len(given) == 1:
            entry = self.tokens.named(given[0])
            if entry is None and needed is Access.TOKEN:
                entry = self.tokens.guests.named(bearer(given[0]))
            if entry is None and needed is Access.CODE:
                entry = self.tokens.spend(given[0])
        elif not given and needed is Access.TOKEN:
            entry, renewal = self._by_cookie(scope, headers)
        if entry is None:
            raise Problem(
                "unauthorized",
                "Requests need the service's token: Authorization: Bearer TOKEN; `hookean token` prints it.",
                headers={"www-authenticate": 'Bearer realm="hookean"'},
            )
        return entry, renewal

    def _only_read(self, scope: Scope, guest: Guest) -> None:
        """Refuses all but reading its session to a client with a read-only link. Raises the problem `read-only`."""
        scope["guest"] = True
        method = scope["method"] if scope["type"] == "http" else None
        if not self.table.reads(method, scope["path"], guest.session.key):
            raise Problem("read-only", READ_ONLY)

    def _by_cookie(self, scope: Scope, headers: _Headers) -> tuple[Entry | None, str]:
        """A page's cookie counts for requests of that page alone: browsers send it to every port of this machine, and
        for requests that other pages cause."""
        if any(o != headers.own for o in headers.all(b"origin")) or not _same_site(headers.all(b"sec-fetch-site")):
            return None, ""
        name = _cookie_of(scope)
        given = [v for header in headers.all(b"cookie", lower=False) for v in cookies(header, name)]
        return self.tokens.logged_in(name, given)


def _cookie_of(scope: Scope) -> str:
    return cookie_name(scope["server"][1] if scope.get("server") else 80)


def _while_in(entry: Entry, renewal: str, cookie: str, send: Send) -> Send:
    """Sends an answer, with the new value of the cookie; one that streams ends when its client is logged out."""

    async def sent(message: Message) -> None:
        if message["type"] == "http.response.start" and renewal and not entry.ended.is_set():
            headers = MutableHeaders(raw=list(message.get("headers", [])))
            headers.setdefault("set-cookie", set_cookie(cookie, renewal))
            message["headers"] = headers.raw
        if message.get("more_body") and entry.ended.is_set():
            raise ClientDisconnect
        await send(message)

    return sent


class _Watched:
    """A WebSocket that is closed with 4401 when its client is logged out."""

    def __init__(self, entry: Entry, receive: Receive, send: Send) -> None:
        self.entry, self._receive, self._send = entry, receive, send
        self.open = False

    async def run(self, app: ASGIApp, scope: Scope) -> None:
        """Until either ends."""
        serving = asyncio.ensure_future(app(scope, self._receive, self._sent))
        ended = asyncio.ensure_future(self.entry.ended.wait())
        try:
            await asyncio.wait({serving, ended}, return_when=asyncio.FIRST_COMPLETED)
            if not serving.done() and self.open:
                with suppress(OSError, RuntimeError):
                    await self._send({"type": "websocket.close", "code": 4401, "reason": "Logged out."})
        finally:
            ended.cancel()
            serving.cancel()
            with suppress(asyncio.CancelledError):
                await serving

    async def _sent(self, message: Message) -> None:
        if message["type"] == "websocket.accept":
            self.open = True
        elif self.entry.ended.is_set():
            raise OSError("logged out")
        await self._send(message)


class Origins:
    """Lets pages of listed origins read answers, and answers what their browsers ask first. None are listed: CORS is
    off."""

    def __init__(self, app: ASGIApp, settings: Settings, table: Table) -> None:
        self.app, self.origins, self.table = app, set(settings.origins), table

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """One request."""
        if scope["type"] != "http" or not self.origins:
            await self.app(scope, receive, send)
            return
        given = [v.decode("latin-1") for k, v in scope["headers"] if k == b"origin"]
        listed = len(given) == 1 and given[0] in self.origins

        async def told(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers = MutableHeaders(raw=list(message.get("headers", [])))
                headers.add_vary_header("Origin")
                if listed:
                    headers["access-control-allow-origin"] = given[0]
                    headers["access-control-expose-headers"] = EXPOSED
                    if scope.get("preflight"):
                        headers.update(CORS)
                message["headers"] = headers.raw
            await send(message)

        asks = scope["method"] == "OPTIONS" and any(k == b"access-control-request-method" for k, _ in scope["headers"])
        scope["preflight"] = asks and listed and not self.table.is_for_hops(scope["path"])
        await self.app(scope, receive, told)


def _same_site(sites: list[str]) -> bool:
    return all(site in ("none", "same-origin") for site in sites)


class _Headers:
    def __init__(self, scope: Scope) -> None:
        self.raw: list[tuple[bytes, bytes]] = scope["headers"]
        target = len(scope.get("raw_path") or b"") + len(scope["query_string"])
        self.size = sum(len(k) + len(v) + 4 for k, v in self.raw) + target
        self.own = "http://" + ",".join(self.all(b"host"))  # the origin of our own pages

    @property
    def links(self) -> list[str]:
        """Tokens of read-only links among the subprotocols that a socket offers."""
        offered = [one.strip() for line in self.all(b"sec-websocket-protocol", lower=False) for one in line.split(",")]
        return [one.removeprefix(BEARER) for one in offered if one.startswith(BEARER)]

    def all(self, name: bytes, *, lower: bool = True) -> list[str]:
        found = [v.decode("latin-1").strip() for k, v in self.raw if k == name]
        return [v.lower() for v in found] if lower else found
