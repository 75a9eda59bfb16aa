"""How much the service reads, and for how long: bodies as they stream, headers as they arrive."""

from __future__ import annotations

import asyncio
import sys
from contextlib import suppress
from http import HTTPStatus
from typing import Any, ClassVar

import h11
from starlette.requests import ClientDisconnect
from starlette.types import ASGIApp, Message, Receive, Scope, Send
from uvicorn.protocols.http.h11_impl import H11Protocol
from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol

from hookean_server.http.conformance import ALWAYS
from hookean_server.problems import MEDIA_TYPE, Problem
from hookean_server.settings import Settings

AT_ONCE = 32 * 1024  # bytes taken from a socket at a time
PART = 256 * 1024  # bytes of an answer given to a socket at a time
RATE = 2**20  # bytes of an answer that a client reads in a second, at least


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
        # where both are given the length is a lie: the chunks count
        stated = b"" if b"transfer-encoding" in headers else headers.get(b"content-length", b"0")
        none = stated != b"" and stated.strip(b"0") == b""
        scope["body"] = body = Body(receive, limit, self.settings.body_seconds, done=none)
        if stated.isdigit() and int(stated[:20]) > limit:
            raise _too_large(limit)
        await self.app(scope, body.receive, send)


class Body:
    """The body of one request, counted. Where its length is not stated, or is, no more than the limit is kept."""

    def __init__(self, receive: Receive, limit: int, seconds: float, *, done: bool) -> None:
        self.limit, self.seconds, self.done = limit, seconds, done
        self.seen = 0
        self._receive = receive
        self._until = asyncio.get_running_loop().time() + seconds

    async def receive(self) -> Message:
        """The next message; raises the problems `too-large` and `slow-body`."""
        if self.done:
            return await self._receive()
        try:
            async with asyncio.timeout_at(self._until):
                message = await self._next()
        except TimeoutError:
            raise Problem("slow-body", f"The body took longer than {self.seconds:g} s.") from None
        if self.seen > self.limit:
            raise _too_large(self.limit)
        return message

    async def drain(self, seconds: float) -> None:
        """Throw away what still comes, within the limit; then wait for the client to leave, reading nothing."""
        with suppress(TimeoutError, OSError):
            async with asyncio.timeout(seconds):
                while not self.done and self.seen <= self.limit:
                    if (await self._next())["type"] != "http.request":
                        return
        if not self.done and self.seen > self.limit:
            await asyncio.sleep(min(seconds, 0.3))  # the answer is on its way; clients that look will see it

    async def _next(self) -> Message:
        message = await self._receive()
        if message["type"] == "http.request":
            self.seen += len(message.get("body", b""))
            self.done = not message.get("more_body")
        return message


class Paced:
    """Gives a socket large answers in parts as they are read: the socket copies what it has to keep. A client that
    reads too slowly is cut off."""

    def __init__(self, app: ASGIApp, settings: Settings) -> None:
        self.app, self.seconds = app, settings.write_seconds

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """One request."""

        async def paced(message: Message) -> None:
            body = message.get("body", b"")
            if message["type"] != "http.response.body" or len(body) <= PART:
                await send(message)
                return
            try:
                async with asyncio.timeout(self.seconds + len(body) / RATE):
                    for start in range(0, len(body), PART):
                        more = start + PART < len(body) or message.get("more_body", False)
                        await send({**message, "body": body[start : start + PART], "more_body": more})
                        await asyncio.sleep(0)  # a connection that ended is noticed, and others have their turn
            except TimeoutError:
                if cut := scope.get("state", {}).get("cut"):
                    cut()
                    await asyncio.sleep(0)  # the connection takes notice
                raise ClientDisconnect from None

        await self.app(scope, receive, paced if scope["type"] == "http" else send)


class Connection(H11Protocol):
    """One connection: takes little at a time, gives headers a time to arrive and answers a time to be read, answers
    what is not HTTP with a problem."""

    header_seconds = 30.0
    write_seconds = 30.0
    most = 256
    strangers: ClassVar[dict[Connection, None]] = {}
    """The connections that no credentials came on, the oldest first: `most`, as each takes one of the open files."""

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Begin to wait for headers; where there are too many, the oldest connection without credentials is cut."""
        transport.max_size = AT_ONCE  # type: ignore[attr-defined]  # of asyncio's transports for sockets
        super().connection_made(transport)  # type: ignore[arg-type]
        self._unread: asyncio.TimerHandle | None = None
        self.app_state = {**self.app_state, "cut": self.transport.abort, "known": self._known}  # of each request
        self.strangers[self] = None
        if len(self.strangers) > self.most:
            oldest = next(iter(self.strangers))
            oldest._known()
            oldest.transport.abort()
        self._late: asyncio.TimerHandle | None = None
        self._expect()

    def data_received(self, data: bytes) -> None:
        """Part of a request; headers that began must end in time."""
        super().data_received(data)
        if self.conn.their_state is not h11.IDLE or self.transport.get_protocol() is not self:
            self._expect_no_more()
        elif self._late is None:
            self._expect()

    def connection_lost(self, exc: Exception | None) -> None:
        """The connection is closed."""
        self._known()
        self._expect_no_more()
        self._is_read()
        super().connection_lost(exc)

    def pause_writing(self) -> None:
        """The client reads more slowly than it is answered."""
        super().pause_writing()
        self._is_read()
        self._unread = self.loop.call_later(self.write_seconds, self.transport.abort)

    def resume_writing(self) -> None:
        """It has read most of what there is."""
        self._is_read()
        super().resume_writing()

    def send_400_response(self, msg: str) -> None:
        """Bytes that are not HTTP, or headers that have no end within what is read of them."""
        problem = Problem("bad-request", "This is not an HTTP request.")
        if getattr(sys.exception(), "error_status_hint", 400) == 431:
            problem = Problem("headers-too-large", "The address and headers of this request are too large.")
        body = problem.body("urn:uuid:00000000-0000-0000-0000-000000000000")
        own = {"content-type": MEDIA_TYPE, "content-length": str(len(body)), "connection": "close", **ALWAYS}
        headers = [*self.server_state.default_headers, *((k.encode(), v.encode()) for k, v in own.items())]
        with suppress(h11.LocalProtocolError):
            for event in (
                h11.Response(status_code=problem.status, headers=headers, reason=HTTPStatus(problem.status).phrase),
                h11.Data(data=body),
                h11.EndOfMessage(),
            ):
                self.transport.write(self.conn.send(event) or b"")
        self.transport.close()

    def handle_websocket_upgrade(self, event: h11.Request) -> None:
        """It goes on as a WebSocket, which is closed at once without credentials."""
        self._known()
        super().handle_websocket_upgrade(event)

    def _known(self) -> None:
        self.strangers.pop(self, None)

    def _is_read(self) -> None:
        if self._unread is not None:
            self._unread.cancel()
            self._unread = None

    def _expect(self) -> None:
        self._late = self.loop.call_later(self.header_seconds, self.transport.close)

    def _expect_no_more(self) -> None:
        if self._late is not None:
            self._late.cancel()
            self._late = None


class Socket(WebSocketsSansIOProtocol):
    """One WebSocket: a handshake that was refused with an answer is complete, and no failure to be logged."""

    async def send(self, message: Any) -> None:
        """A message of the application."""
        await super().send(message)
        if message["type"] == "websocket.http.response.body" and not message.get("more_body"):
            self.handshake_complete = True


def _too_large(limit: int) -> Problem:
    return Problem("too-large", f"At most {limit} bytes are accepted.", [("/", f"more than {limit} bytes given")])


def media_type(headers: Any) -> str:
    """The media type of a request in lower case, without its parameters."""
    return str(headers.get("content-type", "")).split(";")[0].strip().lower()
