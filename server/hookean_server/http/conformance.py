"""What HTTP asks of every answer, whatever the route: HEAD as GET, no ranges, and headers that keep other sites out."""

from __future__ import annotations

from starlette.datastructures import MutableHeaders
from starlette.requests import ClientDisconnect
from starlette.types import ASGIApp, Message, Receive, Scope, Send

RANGES = {b"range", b"if-range"}
ALWAYS = {
    "cross-origin-resource-policy": "same-origin",
    "cross-origin-opener-policy": "same-origin",
    "x-content-type-options": "nosniff",
}


class Always:
    """Adds the headers of every answer, refusals included."""

    def __init__(self, app: ASGIApp) -> None:
        self.app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """One request."""

        async def with_headers(message: Message) -> None:
            if message["type"] in ("http.response.start", "websocket.http.response.start"):
                headers = MutableHeaders(raw=list(message.get("headers", [])))
                for name, value in ALWAYS.items():
                    headers.setdefault(name, value)
                if "accept-ranges" in headers:
                    headers["accept-ranges"] = "none"
                message["headers"] = headers.raw
            await send(message)

        await self.app(scope, receive, with_headers if scope["type"] in ("http", "websocket") else send)


class Manners:
    """Answers HEAD as GET without its body, and reads no ranges: an answer is the whole."""

    def __init__(self, app: ASGIApp) -> None:
        self.app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """One request."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        scope["headers"] = [(k, v) for k, v in scope["headers"] if k not in RANGES]
        if scope["method"] == "HEAD":
            await self._head(scope, receive, send)
        else:
            await self.app(scope, receive, send)

    async def _head(self, scope: Scope, receive: Receive, send: Send) -> None:
        """As GET until the head is there; what it takes to make a body, such as events that come, is not waited for."""
        asked = {**scope, "method": "GET"}
        answered = False

        async def head_only(message: Message) -> None:
            nonlocal answered
            if answered:
                raise ClientDisconnect  # nobody wants the body
            await send(message)
            if message["type"] == "http.response.start":
                answered = True
                await send({"type": "http.response.body", "body": b""})

        try:
            await self.app(asked, receive, head_only)
        except ClientDisconnect:
            if not answered:
                raise
        finally:
            scope.update({name: value for name, value in asked.items() if name != "method"})
