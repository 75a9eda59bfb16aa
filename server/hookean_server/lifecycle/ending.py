"""How the server ends: at a signal, on request, with its parent process, when unused; in three seconds at most."""

from __future__ import annotations

import contextlib
import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from socket import socket
from types import FrameType
from typing import Any

import uvicorn
from fastapi import APIRouter, FastAPI, Request
from starlette.responses import JSONResponse
from starlette.types import ASGIApp, Receive, Scope, Send

from hookean_server.http import openapi
from hookean_server.lifecycle.discovery import alive, birth
from hookean_server.workers.pool import end_fork_server

SIGNALS = [s for name in ("SIGINT", "SIGTERM", "SIGBREAK") if (s := getattr(signal, name, None)) is not None]
LONGEST = 2.8  # seconds that a clean end may take before it is cut short
LOOK = 1.0  # seconds between looks at the parent and at who uses the service
UNCOUNTED = {"/v1/health", "/v1/proof", "/metrics"}  # asking these is not using the service

router = APIRouter(tags=["about"])


@router.post("/v1/shutdown", status_code=202, summary="Stop the service", **openapi.shutdown())
async def shutdown(request: Request) -> JSONResponse:
    """Sessions are saved, sockets are closed with 1012, solves end; this takes three seconds at most."""
    request.app.state.end()
    return JSONResponse({"status": "stopping"}, 202)


class Server(uvicorn.Server):
    """A server that cancels its solves when it ends, and ends without raising the signal again."""

    def __init__(self, config: uvicorn.Config, app: FastAPI) -> None:
        super().__init__(config)
        self.app = app
        self.on_start: Callable[[], None] = lambda: None
        self.on_end: Callable[[], None] = lambda: None
        self.cut = threading.Timer(LONGEST, self._force_end)
        self.cut.daemon = True
        app.state.end = self.end

    async def startup(self, sockets: list[socket] | None = None) -> None:
        """Start, then call `on_start`."""
        await super().startup(sockets=sockets)
        self.on_start()

    def end(self) -> None:
        """End cleanly; returns at once. From any thread."""
        if not self.should_exit:
            self.should_exit = True
            self.app.state.pool.stop()
            self.cut.start()

    def handle_exit(self, sig: int, frame: FrameType | None) -> None:
        """The first signal ends cleanly, the second now."""
        if self.should_exit:
            self._leave(130)
        self.end()

    def close(self) -> None:
        """The last of a clean end."""
        self.on_end()
        self.app.state.pool.stop()
        end_fork_server()
        self.app.state.pool.close()
        self.cut.cancel()

    def _force_end(self) -> None:
        print(
            f"hookean: shutdown took longer than {LONGEST:g} s and was forced; acknowledged edits are saved",
            file=sys.stderr,
        )
        self._leave(0)

    def _leave(self, code: int) -> None:
        """End this process and all it started, without waiting for anything."""
        self.on_end()
        state = self.app.state
        holders = [*state.pool.lanes, *state.sessions.sessions.values()]
        for process in [holder.process for holder in holders]:
            with contextlib.suppress(Exception):
                process.kill()
        end_fork_server()
        with contextlib.suppress(Exception):
            sys.stdout.flush()
            sys.stderr.flush()
        os._exit(code)

    @contextlib.contextmanager
    def capture_signals(self) -> Iterator[None]:
        """Handle the signals ourselves while serving."""
        if threading.current_thread() is not threading.main_thread():
            yield
            return
        numbers = list(SIGNALS)
        hang_up = getattr(signal, "SIGHUP", None)  # the terminal was closed; nohup has it ignored
        if hang_up is not None and signal.getsignal(hang_up) is not signal.SIG_IGN:
            numbers.append(hang_up)
        before: dict[Any, Any] = {s: signal.signal(s, self.handle_exit) for s in numbers}
        try:
            yield
        finally:
            for number, handler in before.items():
                signal.signal(number, handler)


class Activity:
    """The outermost middleware: records whether the service is used."""

    def __init__(self, app: FastAPI) -> None:
        self.app: ASGIApp = app
        self.state = app.state
        self.running = 0
        self.last = time.monotonic()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """One request or socket."""
        counts = scope["type"] in ("http", "websocket") and scope["path"] not in UNCOUNTED
        self.running += counts
        try:
            await self.app(scope, receive, send)
        finally:
            self.running -= counts
            if counts and not scope.get("refused"):  # who is not let in uses nothing
                self.last = time.monotonic()

    def idle(self) -> float:
        """Seconds since the last use; sessions that play, solves that run and jobs are use."""
        playing = any(live.playing for live in list(self.state.sessions.sessions.values()))
        if self.running or playing or self.state.jobs.busy or self.state.pool.states()["busy"]:
            self.last = time.monotonic()
        return time.monotonic() - self.last


class Watch(threading.Thread):
    """Ends the server with its parent, or when it was idle for so many seconds; 0: never for that reason. A thread, so
    that nothing the server does holds it up."""

    def __init__(self, server: Server, activity: Activity, parent: int = 0, idle: float = 0.0) -> None:
        super().__init__(name="hookean-watch", daemon=True)
        self.server, self.activity, self.parent, self.idle = server, activity, parent, idle
        self.born = birth(parent) if parent else ""

    def run(self) -> None:
        """Look once a second."""
        while not self.server.should_exit:
            orphaned = self.parent and not (alive(self.parent) and birth(self.parent) == self.born)
            if orphaned or (self.idle and self.activity.idle() > self.idle):
                self.server.end()
                return
            time.sleep(LOOK)
