"""Running the service until it is told to stop."""

from __future__ import annotations

import contextlib
import signal
import sys
import threading
from collections.abc import Iterator
from dataclasses import replace
from socket import socket
from types import FrameType
from typing import Any

import uvicorn
from fastapi import FastAPI

from hookean_server.app import create_app
from hookean_server.pool import FORKED, context, end_fork_server
from hookean_server.ports import Taken, take
from hookean_server.settings import Settings

SIGNALS = [s for name in ("SIGINT", "SIGTERM", "SIGBREAK") if (s := getattr(signal, name, None)) is not None]
LOOPBACK = ("127.0.0.1", "localhost", "::1")


def serve(host: str = "127.0.0.1", port: int = 8765, settings: Settings | None = None) -> int:
    """Serve until Ctrl-C or SIGTERM; the exit code: 0 after a clean end, 2 where the port cannot be had.

    Prints the address and what to try. Port 0 takes any free one. A host beyond this machine is told about: the
    service asks nobody who they are.
    """
    try:
        sock = take(host, port)
    except Taken as error:
        print(error, file=sys.stderr, flush=True)
        return 2
    port = sock.getsockname()[1]
    settings = replace(settings or Settings(), host=host, port=port)
    if host not in LOOPBACK:
        settings = replace(settings, hosts=(*settings.hosts, host))
        print(
            f"Warning: {host} can be reached from other machines, and nobody is asked for a password.", file=sys.stderr
        )
    app = create_app(settings)
    config = uvicorn.Config(
        app,
        log_level="warning",
        access_log=False,
        ws="websockets-sansio",
        ws_per_message_deflate=False,
        ws_max_size=settings.message_limit,
        server_header=False,
        date_header=False,
        http="h11",
        h11_max_incomplete_event_size=2 * settings.header_limit,
        timeout_graceful_shutdown=1,
        lifespan="on",
    )
    server = Server(config, app)
    try:
        _start_fork_server()
        server.run(sockets=[sock])
    except KeyboardInterrupt:
        pass
    finally:
        app.state.pool.stop()
        end_fork_server()
        app.state.pool.close()
    return 0


def _start_fork_server() -> None:
    """Start the process that workers are forked from deaf to Ctrl-C, which reaches the whole group, from its birth."""
    if not FORKED:
        return
    from multiprocessing import forkserver, resource_tracker

    context()
    resource_tracker.ensure_running()  # it unblocks the signal after its own start
    signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])
    try:
        forkserver.ensure_running()
    finally:
        signal.pthread_sigmask(signal.SIG_UNBLOCK, [signal.SIGINT])


class Server(uvicorn.Server):
    """A server that ends its solves when a signal comes, and ends without raising the signal again."""

    def __init__(self, config: uvicorn.Config, app: FastAPI) -> None:
        super().__init__(config)
        self.app = app

    @contextlib.contextmanager
    def capture_signals(self) -> Iterator[None]:
        """Handle the signals ourselves while serving."""
        if threading.current_thread() is not threading.main_thread():
            yield
            return
        before: dict[Any, Any] = {s: signal.signal(s, self.handle_exit) for s in SIGNALS}
        try:
            yield
        finally:
            for number, handler in before.items():
                signal.signal(number, handler)

    def handle_exit(self, sig: int, frame: FrameType | None) -> None:
        """The first signal ends cleanly, the second now."""
        self.force_exit = self.should_exit
        self.should_exit = True
        self.app.state.pool.stop()

    async def startup(self, sockets: list[socket] | None = None) -> None:
        """Start, and say where."""
        await super().startup(sockets=sockets)
        settings: Settings = self.app.state.settings
        name = f"[{settings.host}]" if ":" in settings.host else settings.host
        url = f"http://{name}:{settings.port}"
        scene = '{"particles": [[0,0,0],[1,0,0],[2,0,0]], "anchors": [{"particles": [0,2]}], "forces": ['
        scene += (
            '{"kind": "springs", "particles": [[0,1],[1,2]]}, {"kind": "unary", "particles": [1], "vector": [0,0,-9]}]}'
        )
        print(f"hookean serves at {url} (Ctrl-C ends it). Try:")
        print(f"  curl {url}/v1/relax -H 'Content-Type: application/json' -d '{scene}'", flush=True)
