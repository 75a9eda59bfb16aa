"""Problems on their way out: every exception becomes a problem document with the number of its request."""

from __future__ import annotations

import asyncio
import logging
import uuid
from contextlib import suppress
from typing import Any

from starlette.requests import ClientDisconnect
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from hookean_server.problems import MEDIA_TYPE, Problem, is_function

log = logging.getLogger("hookean.server")

CLOSED = {"unauthorized": 4401, "forbidden-host": 4403, "forbidden-origin": 4403, "read-only": 4403, "not-found": 4404}
"""Codes a WebSocket is closed with, where its handshake cannot be refused."""
NOT_LET_IN = ("unauthorized", "forbidden-host", "forbidden-origin")
"""Problems of those who may not use the service; what they ask for does not keep it running."""
LINGER = 2.0  # seconds in which a refused client may take notice before its connection is closed


class Problems:
    """Numbers the request and turns every exception into a problem document."""

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
            if message["type"] in ("http.response.start", "websocket.http.response.start"):
                started = True
                message["headers"] = [*message.get("headers", []), (b"x-request-id", instance.encode())]
            started = started or message["type"] == "websocket.accept"
            await send(message)

        try:
            await self.app(scope, receive, numbered)
        except ClientDisconnect:
            return  # nobody is left to answer
        except Problem as problem:
            scope["refused"] = problem.slug in NOT_LET_IN
            if not started or scope["type"] == "websocket":
                with suppress(OSError):  # a client that has left needs no answer
                    await refuse(problem, scope, receive, numbered, accepted=started)
        except asyncio.CancelledError:
            # only the shutdown cancels requests: those that did not end by themselves in its grace time
            if scope["type"] == "http" and not started:
                gone = Problem("shutting-down", "The service stopped before this was finished.")
                with suppress(asyncio.CancelledError, OSError):
                    await answer(gone, scope, numbered)
        except Exception:
            log.exception("%s failed", instance)
            if scope["type"] != "http" or started:
                raise
            await refuse(
                Problem("internal", "Internal error; the log of the service has the details."), scope, receive, numbered
            )


async def answer(problem: Problem, scope: Scope, send: Send, *, more: bool = False) -> None:
    """Send a problem; with `more` the last, empty part of the body is still to come."""
    scope["problem"] = problem.slug
    body = problem.body(scope.get("instance", "urn:uuid:0"), hops=is_function(scope["path"]))
    headers = [
        (b"content-type", MEDIA_TYPE.encode()),
        (b"content-length", str(len(body)).encode()),
        (b"cache-control", b"no-store"),
        *((k.lower().encode(), v.encode()) for k, v in problem.headers.items()),
    ]
    kind = "websocket.http.response" if scope["type"] == "websocket" else "http.response"
    await send({"type": f"{kind}.start", "status": problem.status, "headers": headers})
    await send({"type": f"{kind}.body", "body": body, "more_body": more})


async def refuse(problem: Problem, scope: Scope, receive: Receive, send: Send, *, accepted: bool = False) -> None:
    """Send a problem; a WebSocket's handshake is refused with it, or an open one closed.

    Of a body that has not been read, no more is read than would have been taken, and that is thrown away: closing at
    once would reset the connection and many clients would lose the answer.
    """
    if scope["type"] == "websocket":
        if accepted or "websocket.http.response" not in scope.get("extensions", {}):
            scope["problem"] = problem.slug
            close: dict[str, Any] = {"type": "websocket.close", "code": CLOSED.get(problem.slug, 1008)}
            await send({**close, "reason": problem.detail[:100]})
        else:
            await answer(problem, scope, send)
        return
    body = scope.get("body")
    if body is None and not _has_body(scope) or body is not None and body.done:
        await answer(problem, scope, send)
        return
    problem.headers = {**problem.headers, "connection": "close"}
    await answer(problem, scope, send, more=True)
    if body is not None:
        await body.drain(LINGER)
    else:
        await _drained(receive)
    await send({"type": "http.response.body", "body": b""})


def _has_body(scope: Scope) -> bool:
    return any(k == b"transfer-encoding" or k == b"content-length" and v != b"0" for k, v in scope["headers"])


async def _drained(receive: Receive) -> None:
    """Throw away a moment's worth of a body that was refused before its limit was known."""
    seen = 0
    with suppress(TimeoutError, OSError):
        async with asyncio.timeout(LINGER):
            while seen < 2**20:
                message = await receive()
                seen += len(message.get("body", b""))
                if message["type"] != "http.request" or not message.get("more_body"):
                    return
