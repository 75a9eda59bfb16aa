"""What is logged: with HOOKEAN_LOG=json one line of JSON for each request and event, else only errors.

A line names the request, its route's template, status and time; of a session a hash of its key. Never a token, an
address as it was sent, a body or a coordinate.
"""

from __future__ import annotations

import atexit
import datetime
import hashlib
import json
import logging
import os
import queue
import sys
import time
import traceback
from contextlib import suppress
from logging.handlers import QueueHandler, QueueListener
from pathlib import Path
from typing import Any

from starlette.types import ASGIApp, Message, Receive, Scope, Send

from hookean_server.http.metrics import Metrics

VARIABLE = "HOOKEAN_LOG"
MANY = 10_000  # lines that wait to be written
PATIENCE = 1.0  # seconds for the last of them at the end
LEFT = 499  # status of a request whose client left before the answer

log = logging.getLogger("hookean.request")


class JsonLines(logging.Formatter):
    """One JSON object a line. Of an exception its type and places, not its words, which may quote the input."""

    def format(self, record: logging.LogRecord) -> str:
        """One line."""
        moment = datetime.datetime.fromtimestamp(record.created, datetime.UTC)
        line: dict[str, Any] = {
            "time": moment.isoformat(timespec="milliseconds").replace("+00:00", "Z"),
            "level": record.levelname.lower(),
            "logger": record.name,
            "event": record.getMessage().strip(),
            **getattr(record, "fields", {}),
        }
        if record.exc_info and record.exc_info[0] is not None:
            frames = traceback.extract_tb(record.exc_info[2])
            line["error"] = record.exc_info[0].__name__
            line["at"] = [f"{Path(f.filename).name}:{f.lineno} {f.name}" for f in frames[-12:]]
        return json.dumps(line)


class Queued(QueueHandler):
    """Hands lines to a thread that writes them: a stderr that nobody reads holds up no request. Where it is behind by
    too many, lines are left out."""

    def __init__(self, writer: logging.Handler) -> None:
        super().__init__(queue.Queue(MANY))
        self.writer = Writer(self.queue, writer)
        self.writer.start()

    def prepare(self, record: logging.LogRecord) -> logging.LogRecord:
        """As it is: it stays in this process."""
        return record

    def enqueue(self, record: logging.LogRecord) -> None:
        """Never waits."""
        with suppress(queue.Full):
            self.queue.put_nowait(record)


class Writer(QueueListener):
    """The thread that writes."""

    def end(self) -> None:
        """Write what is left, for a moment."""
        if self._thread is not None:
            with suppress(queue.Full):
                self.enqueue_sentinel()
            self._thread.join(PATIENCE)


def begin(given: str = "", *, queued: bool = False) -> bool:
    """Log as JSON on stderr if that is asked for, here and in the processes started from here; whether it is."""
    if (given or os.environ.get(VARIABLE, "")) != "json":
        return False
    os.environ[VARIABLE] = "json"
    handler: logging.Handler = logging.StreamHandler(sys.stderr)
    handler.setFormatter(JsonLines())
    if queued:
        handler = Queued(handler)
        atexit.register(handler.writer.end)
    root = logging.getLogger()
    root.handlers = [handler]
    logging.getLogger("hookean").setLevel(logging.INFO)
    return True


def short_hash(text: str) -> str:
    """A name for something whose own name is secret."""
    return hashlib.sha256(text.encode()).hexdigest()[:12]


class Seen:
    """Outermost: times every request, counts it and logs it."""

    def __init__(self, app: ASGIApp, metrics: Metrics) -> None:
        self.app, self.metrics = app, metrics

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """One request or WebSocket."""
        if scope["type"] not in ("http", "websocket"):
            await self.app(scope, receive, send)
            return
        began, status, closed = time.perf_counter(), LEFT, 0

        async def watched(message: Message) -> None:
            nonlocal status, closed
            if message["type"] in ("http.response.start", "websocket.http.response.start"):
                status = message["status"]
            elif message["type"] == "websocket.accept":
                status = 101
            elif message["type"] == "websocket.close":
                closed = message.get("code", 1000)
            await send(message)

        try:
            await self.app(scope, receive, watched)
        finally:
            self._note(scope, status, closed, time.perf_counter() - began)

    def _note(self, scope: Scope, status: int, closed: int, seconds: float) -> None:
        route = template(scope)
        method = scope.get("method", "WEBSOCKET")
        self.metrics.request(method, route, status, seconds, scope.get("problem", ""))
        if not log.isEnabledFor(logging.INFO):
            return
        fields = {"id": scope.get("instance", ""), "method": self.metrics.method(method), "route": route,
                  "status": status, "ms": round(1000 * seconds, 3)}  # fmt: skip
        if closed:
            fields["closed"] = closed
        if "problem" in scope:
            fields["problem"] = scope["problem"]
        if key := scope.get("path_params", {}).get("key"):
            fields["session"] = short_hash(str(key))
        log.info("socket" if scope["type"] == "websocket" else "request", extra={"fields": fields})


def template(scope: Scope) -> str:
    """The template of the route that was found, such as /v1/sessions/{key}; `other` where there was none."""
    return str(getattr(scope.get("route"), "path", "other"))
