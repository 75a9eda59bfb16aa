"""Running the service until it is told to stop."""

from __future__ import annotations

import os
import shlex
import shutil
import signal
import sys
import time
from dataclasses import replace
from pathlib import Path

import uvicorn

import hookean
from hookean_server import logs
from hookean_server.app import create_app
from hookean_server.discovery import Found, Held, Lock
from hookean_server.ending import Activity, Server, Watch
from hookean_server.limits import Connection, Socket
from hookean_server.pool import FORKED, context
from hookean_server.ports import Taken, take
from hookean_server.sessions import wire
from hookean_server.settings import Settings
from hookean_server.tokens import Unfit, chosen

LOOPBACK = ("127.0.0.1", "localhost", "::1")


def serve(
    host: str = "127.0.0.1",
    port: int = 8765,
    settings: Settings | None = None,
    *,
    place: Path | None = None,
    any_port: bool = False,
    parent_pid: int = 0,
    idle_seconds: float = 0.0,
) -> int:
    """Serve until Ctrl-C or SIGTERM; the exit code: 0 after a clean end, 2 where the port or the file of sessions
    cannot be had.

    Prints the address and what to try. Port 0 takes any free one; `any_port`: any free one if `port` is taken. A
    folder `place` is told where the server is, for clients to find. It ends with the process `parent_pid`, and after
    `idle_seconds` without use. A host beyond this machine is told about: what is said to the service, the token too,
    can be read on the way.
    """
    settings = settings or Settings()
    try:
        settings = replace(settings, token=chosen(settings.token))
        sock = take(host, port, or_any=any_port)
        lock = _own(Path(settings.state)) if settings.state is not None else None
    except (Taken, Unfit, Held) as error:
        print(error, file=sys.stderr, flush=True)
        return 2
    port = sock.getsockname()[1]
    settings = replace(settings, host=host, port=port)
    if host not in LOOPBACK:
        settings = replace(settings, hosts=(*settings.hosts, host))
        print(
            f"Warning: {host} can be reached from other machines, and nothing said to it is encrypted.", file=sys.stderr
        )
    Connection.header_seconds = settings.header_seconds
    as_json = logs.begin(settings.log, queued=True)
    app = create_app(settings)
    activity = Activity(app)
    config = uvicorn.Config(
        activity,
        log_level="warning",
        log_config=None if as_json else uvicorn.config.LOGGING_CONFIG,
        proxy_headers=False,
        access_log=False,
        ws=Socket,
        ws_per_message_deflate=False,
        ws_max_size=settings.message_limit,
        server_header=False,
        date_header=False,
        http=Connection,
        h11_max_incomplete_event_size=2 * settings.header_limit,
        timeout_graceful_shutdown=1,
        lifespan="on",
    )
    server = Server(config, app)
    found = _found(app.state.instance, settings)

    def on_start() -> None:
        if place is not None:
            found.write(place)
        _say(found.url)

    server.on_start = on_start
    server.on_end = lambda: found.remove(place) if place is not None else None
    Watch(server, activity, parent_pid, idle_seconds).start()
    try:
        _start_fork_server()
        server.run(sockets=[sock])
    except KeyboardInterrupt:
        pass
    finally:
        server.close()
        if lock is not None:
            lock.release()
    return 0


def _own(state: Path) -> Lock:
    """The right to a file of sessions; raises Held with a sentence."""
    try:
        state.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
        return Lock(state.with_name(state.name + ".lock"))
    except Held:
        raise Held(f"Another hookean server keeps its sessions in {state}; end it, or give this one another.") from None
    except OSError as error:
        raise Held(f"Sessions cannot be kept in {state} ({error.strerror}).") from None


def _found(instance: str, settings: Settings) -> Found:
    """What clients are told."""
    name = settings.host if settings.host not in ("0.0.0.0", "::") else "127.0.0.1"
    url = f"http://{f'[{name}]' if ':' in name else name}:{settings.port}"
    return Found(
        os.getpid(), settings.port, url, settings.token, hookean.__version__, instance, time.time(), wire.VERSION,
        settings.state is not None,
    )  # fmt: skip


def _say(url: str) -> None:
    """Where it is, and what to try. The token stays out of sight."""
    scene = '{"particles": [[0,0,0],[1,0,0],[2,0,0]], "anchors": [{"particles": [0,2]}], "forces": ['
    scene += (
        '{"kind": "springs", "particles": [[0,1],[1,2]]}, {"kind": "unary", "particles": [1], "vector": [0,0,-9]}]}'
    )
    command = shlex.quote(shutil.which("hookean") or str(Path(sys.executable).with_name("hookean")))
    print(f"hookean serves at {url} (Ctrl-C ends it). Try:")
    print(
        f'  curl {url}/v1/relax -H "Authorization: Bearer $({command} token)" '
        f"-H 'Content-Type: application/json' -d '{scene}'",
        flush=True,
    )


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
