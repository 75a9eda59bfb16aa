"""Running the service on a socket until a stop is requested."""

from __future__ import annotations

import os
import shlex
import shutil
import sys
import time
from dataclasses import replace
from pathlib import Path
from socket import socket

import uvicorn

import hookean
from hookean_server.app import create_app
from hookean_server.http import logs
from hookean_server.http.limits import Connection, Socket
from hookean_server.lifecycle.discovery import Found
from hookean_server.lifecycle.ending import Activity, Server, Watch
from hookean_server.sessions import wire
from hookean_server.settings import Settings
from hookean_server.workers.memory import return_pages


def run(settings: Settings, sock: socket, place: Path | None, parent_pid: int, idle_seconds: float) -> int:
    """Serve on a socket that listens; the exit code. See `main.serve`."""
    Connection.header_seconds, Connection.write_seconds = settings.header_seconds, settings.write_seconds
    files = _open_files()
    Connection.most = min(Connection.most, files // 4)
    return_pages()
    as_json = logs.begin(settings.log, queued=True)
    app = create_app(settings)
    try:
        app.state.store.start()
    except OSError as error:
        print(f"hookean: the store cannot be opened: {error}", file=sys.stderr, flush=True)
        return 2
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
        date_header=True,
        http=Connection,
        backlog=min(64, files // 16),  # as many again and again are accepted before the oldest are closed
        h11_max_incomplete_event_size=2 * settings.header_limit,
        timeout_graceful_shutdown=1,
        timeout_keep_alive=16,  # longer than clients do: a request down a connection that just ended is lost
        lifespan="on",
    )
    server = Server(config, app)
    tokens = app.state.tokens
    found = _found(app.state.instance, settings, tokens.proof, sock.getsockname()[0])

    def publish(token: str, proof: str) -> None:
        if place is not None:
            replace(found, token=token, proof=proof).write(place)

    def on_start() -> None:
        publish(tokens.token, tokens.proof)
        _print_address(found.url)
        for report in app.state.store.reports:
            print(report.sentence, file=sys.stderr, flush=True)

    tokens.publish = publish

    server.on_start = on_start
    server.on_end = lambda: found.remove(place) if place is not None else None
    Watch(server, activity, parent_pid, idle_seconds).start()
    try:
        server.run(sockets=[sock])
    finally:
        server.close()
    return 0


def _open_files() -> int:
    """How many files may be open at once; raised to what the system allows. Each connection is one of them."""
    if sys.platform == "win32":
        return 4096
    import resource

    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    wanted = 4096 if hard == resource.RLIM_INFINITY else min(hard, 4096)
    if soft == resource.RLIM_INFINITY or soft >= wanted:
        return wanted
    try:
        resource.setrlimit(resource.RLIMIT_NOFILE, (wanted, hard))
    except (OSError, ValueError):
        return soft
    return wanted


def _found(instance: str, settings: Settings, proof: str, address: str) -> Found:
    """What clients read. An address, not a name: other programs may listen at another address of the same name."""
    name = {"0.0.0.0": "127.0.0.1", "::": "::1"}.get(address, address)
    url = f"http://{f'[{name}]' if ':' in name else name}:{settings.port}"
    return Found(
        os.getpid(), settings.port, url, settings.token, hookean.__version__, instance, time.time(), proof,
        wire.VERSION, settings.state is not None,
    )  # fmt: skip


def _print_address(url: str) -> None:
    """Print the address and an example, without the token."""
    scene = '{"particles": [[0,0,0],[1,0,0],[2,0,0]], "anchors": [{"particles": [0,2]}], "forces": ['
    scene += (
        '{"kind": "springs", "particles": [[0,1],[1,2]]}, {"kind": "unary", "particles": [1], "vector": [0,0,-9]}]}'
    )
    command = shlex.quote(shutil.which("hookean") or str(Path(sys.executable).with_name("hookean")))
    print(f"hookean serves at {url} (Ctrl-C stops it). Open it in a browser with: hookean studio. Example request:")
    # by a pipe, as every user of this machine can read the arguments of a command
    print(
        f"  {command} token --header | curl {url}/v1/relax -H @- -H 'Content-Type: application/json' -d '{scene}'",
        flush=True,
    )
