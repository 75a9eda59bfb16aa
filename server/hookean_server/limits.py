"""What stands before the routes: problems for whatever fails, whom the service answers, and how much it reads.

Pure ASGI, so that streams and sockets pass the same guards.
"""

from __future__ import annotations

import asyncio
import logging
import uuid
from contextlib import suppress
from typing import Any

from starlette.requests import ClientDisconnect
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from hookean_server.problems import MEDIA_TYPE, Problem
from hookean_server.settings import Settings

log = logging.getLogger("hookean.server")
SAFE = {"GET", "HEAD", "OPTIONS"}


class Problems:
    """Outermost: numbers the request and turns whatever is raised into a problem document."""

    def __init__(self, app: ASGIApp) -> None:
        self.app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """One request."""
        if scope["type"] not in ("http", "websocket"):
            await self.app(scope, receive, send)
            return
        instance = f"urn:uuid:{uuid.uuid4()}"
        scope["instance"] = instance
        started = False

        async def numbered(message: Message) -> None:
            nonlocal started
            if message["type"] == "http.response.start":
                started = True
                message["headers"] = [*message.get("headers", []), (b"x-request-id", instance.encode())]
            await send(message)

        try:
            await self.app(scope, receive, numbered)
        except ClientDisconnect:
            return  # nobody is left to answer
        except Problem as problem:
            if scope["type"] == "websocket":
                await send({"type": "websocket.close", "code": 1008, "reason": problem.detail[:100]})
            elif not started:
                await refuse(problem, scope, receive, numbered)
        except asyncio.CancelledError:
            # only the shutdown cancels requests: those that did not end by themselves in its grace time
            if scope["type"] == "http" and not started:
                gone = Problem("shutting-down", "The service stopped before this was done.")
                with suppress(asyncio.CancelledError, OSError):
                    await answer(gone, scope, numbered)
        except Exception:
            log.exception("%s failed", instance)
            if scope["type"] != "http" or started:
                raise
            await refuse(Problem("internal", "The service failed; its log tells more."), scope, receive, numbered)


async def answer(problem: Problem, scope: Scope, send: Send, *, more: bool = False) -> None:
    """Send a problem; with `more` the last, empty part of the body is still to come."""
    body = problem.body(scope.get("instance", "urn:uuid:0"))
    headers = [
        (b"content-type", MEDIA_TYPE.encode()),
        (b"content-length", str(len(body)).encode()),
        (b"cache-control", b"no-store"),
        *((k.lower().encode(), v.encode()) for k, v in problem.headers.items()),
    ]
    await send({"type": "http.response.start", "status": problem.status, "headers": headers})
    await send({"type": "http.response.body", "body": body, "more_body": more})


async def refuse(problem: Problem, scope: Scope, receive: Receive, send: Send) -> None:
    """Send a problem before the body has been read: the rest of it is thrown away for a moment, never kept.

    Closing at once would reset the connection and many clients would lose the answer.
    """
    if scope.get("body_done", scope["method"] in SAFE):
        await answer(problem, scope, send)
        return
    problem.headers = {**problem.headers, "connection": "close"}
    await answer(problem, scope, send, more=True)
    with suppress(TimeoutError, OSError):
        async with asyncio.timeout(2.0):
            while True:
                message = await scope.get("raw_receive", receive)()
                if message["type"] != "http.request" or not message.get("more_body"):
                    break
    await send({"type": "http.response.body", "body": b""})


class Guard:
    """Refuses other hosts, other sites' pages, compressed bodies and huge headers, before anything is read."""

    def __init__(self, app: ASGIApp, settings: Settings) -> None:
        self.app, self.settings = app, settings
        self.names = {"127.0.0.1", "localhost", "[::1]", *(h.lower() for h in settings.hosts)}

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """One request."""
        if scope["type"] in ("http", "websocket"):
            self._check(scope)
        await self.app(scope, receive, send)

    def _check(self, scope: Scope) -> None:
        raw: list[tuple[bytes, bytes]] = scope["headers"]
        size = sum(len(k) + len(v) + 4 for k, v in raw) + len(scope.get("raw_path") or b"") + len(scope["query_string"])
        if size > self.settings.header_limit:
            raise Problem("headers-too-large", f"At most {self.settings.header_limit} bytes of headers are taken.")
        hosts = [v.decode("latin-1").lower() for k, v in raw if k == b"host"]
        if len(hosts) != 1 or not self._ours(hosts[0], scope):
            raise Problem("forbidden-host", "Address this service as 127.0.0.1, localhost or [::1] with its port.")
        headers = {k: v.decode("latin-1").lower() for k, v in raw}
        if scope["type"] == "websocket" or scope["method"] not in SAFE:
            origin = headers.get(b"origin")
            if origin is not None and origin != f"http://{hosts[0]}":
                raise Problem("forbidden-origin", "This came from a page of another origin, which may not do this.")
            if headers.get(b"sec-fetch-site", "none") not in ("none", "same-origin"):
                raise Problem("forbidden-origin", "This came from a page of another site, which may not do this.")
        if headers.get(b"content-encoding", "identity") not in ("identity", ""):
            raise Problem("unsupported-media", "The body is compressed; send it as it is, without Content-Encoding.")

    def _ours(self, host: str, scope: Scope) -> bool:
        name, colon, port = host.rpartition(":")
        if not colon or host.endswith("]"):
            name, port = host, "80"
        served = scope.get("server") or (None, None)
        return name in self.names and port == str(served[1] if served[1] is not None else 80)


class BodyLimit:
    """Counts a body as it streams: too much, or too slow, is refused; a stated length before anything is read."""

    def __init__(self, app: ASGIApp, settings: Settings) -> None:
        self.app, self.settings = app, settings

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """One request."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        headers: dict[bytes, bytes] = dict(scope["headers"])
        form = headers.get(b"content-type", b"").lower().startswith(b"multipart/form-data")
        limit = self.settings.file_limit if form else self.settings.json_limit
        stated = headers.get(b"content-length", b"0" if b"transfer-encoding" not in headers else b"")
        scope["raw_receive"], scope["body_done"] = receive, stated == b"0"
        if stated.isdigit() and int(stated[:20]) > limit:
            raise _too_large(limit)
        await self.app(scope, self._counted(scope, receive, limit), send)

    def _counted(self, scope: Scope, receive: Receive, limit: int) -> Receive:
        seen = 0
        until = asyncio.get_running_loop().time() + self.settings.body_seconds

        async def counted() -> Message:
            nonlocal seen
            if scope["body_done"]:
                return await receive()
            try:
                async with asyncio.timeout_at(until):
                    message = await receive()
            except TimeoutError:
                raise Problem("slow-body", f"The body took longer than {self.settings.body_seconds:g} s.") from None
            if message["type"] == "http.request":
                seen += len(message.get("body", b""))
                if seen > limit:
                    raise _too_large(limit)
                scope["body_done"] = not message.get("more_body")
            return message

        return counted


def _too_large(limit: int) -> Problem:
    return Problem("too-large", f"At most {limit} bytes are taken.", [("/", f"more than {limit} bytes given")])


def media_type(headers: Any) -> str:
    """The media type of a request in lower case, without its parameters."""
    return str(headers.get("content-type", "")).split(";")[0].strip().lower()
