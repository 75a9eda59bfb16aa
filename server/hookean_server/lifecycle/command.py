"""`hookean serve`: joins the running server, or starts one, or stops it."""

from __future__ import annotations

import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from hookean.commands.command import taking
from hookean_server.lifecycle.discovery import (
    LOCK,
    SESSIONS,
    Distrusted,
    Found,
    Held,
    Lock,
    ask,
    check,
    find,
    folder,
    prepare,
    record_python,
)

PORT = 8765
WAIT = 20.0  # seconds for another server of this user to start or to end


@dataclass(frozen=True)
class Options:
    """Start the local HTTP service, until Ctrl-C. Each user has one server, which keeps the sessions.

    If a server is already running, prints its address. HOOKEAN_STATE sets the folder of its address and sessions.
    """

    host: Annotated[str, typer.Option(help="Address to listen on")] = "127.0.0.1"
    port: Annotated[
        int | None, typer.Option(help="Port to listen on; 0: any free port; default 8765", min=0, max=65535)
    ] = None
    any_port: Annotated[bool, typer.Option("--any-port", help="Use any free port if this one is in use")] = False
    no_keep: Annotated[bool, typer.Option("--no-keep", help="Do not save sessions when it ends")] = False
    stop: Annotated[bool, typer.Option("--stop", help="Stop the running service")] = False
    parent_pid: Annotated[int, typer.Option(help="Process id; stop when this process ends", min=0)] = 0
    idle_exit: Annotated[float, typer.Option(help="Stop after this many minutes without use; 0: never", min=0)] = 0.0


def run(options: Options) -> int:
    """Serve until a stop is requested; the exit code: 0 after a clean end or if a server runs, 2 if it cannot start."""
    if options.stop:
        return stop()
    place = folder()
    try:
        prepare(place)
        record_python(place)
    except Distrusted as error:
        return refuse(str(error))
    except OSError as error:
        return refuse(
            f"{place} cannot be written ({error.strerror}); set HOOKEAN_STATE to a folder that you can write to."
        )
    if options.port and options.no_keep and find(place) is not None:
        return _serve(options, None)  # a second one, for itself
    until = time.monotonic() + WAIT
    while True:
        if (found := find(place)) is not None:
            return _join(found, options)
        try:
            lock = Lock(place / LOCK)
            break
        except Held:
            if time.monotonic() > until:
                return refuse(
                    f"Another hookean server holds {place / LOCK} and does not answer; end its process first."
                )
            time.sleep(0.1)
        except OSError as error:
            return refuse(f"{place / LOCK} cannot be written ({error.strerror}).")
    try:
        return _serve(options, place)
    finally:
        lock.release()


def stop() -> int:
    """Stop the server of this user; the exit code: 0 if none runs afterwards, else 1."""
    place = folder()
    try:
        check(place)
    except Distrusted as error:
        return refuse(str(error))
    found = find(place)
    if found is None:
        if not (place / LOCK).exists() or _free(place):
            print("No hookean server is running.")
            return 0
        print("A hookean server is starting or does not answer; try again, or end its process.", file=sys.stderr)
        return 1
    ask(found, "POST", "/v1/shutdown")
    until = time.monotonic() + WAIT
    while not _free(place):
        if time.monotonic() > until:
            print(f"The hookean server at {found.url} (process {found.pid}) has not ended.", file=sys.stderr)
            return 1
        time.sleep(0.05)
    print(f"The hookean server at {found.url} has ended" + ("; its sessions are saved." if found.keeps else "."))
    return 0


def _join(found: Found, options: Options) -> int:
    if options.port in (None, 0, found.port) or options.any_port:
        print(
            f"A hookean server is already running at {found.url} (process {found.pid}). `hookean studio` opens it in a "
            "browser, `hookean serve --stop` stops it."
        )
        return 0
    return refuse(
        f"A hookean server with the sessions of this user is already running at {found.url} (process {found.pid}). Use "
        "it, stop it with `hookean serve --stop`, or add --no-keep for a second server that saves nothing."
    )


def _serve(options: Options, place: Path | None) -> int:
    from hookean_server.lifecycle.main import serve
    from hookean_server.settings import Settings

    state = place / SESSIONS if place is not None and not options.no_keep else None
    try:
        settings = Settings(state=state)
    except ValueError as error:
        return refuse(str(error))
    return serve(
        options.host,
        PORT if options.port is None else options.port,
        settings,
        place=place,
        any_port=options.any_port,
        parent_pid=options.parent_pid,
        idle_seconds=60.0 * options.idle_exit,
    )


def _free(place: Path) -> bool:
    try:
        Lock(place / LOCK).release()
    except Held:
        return False
    return True


def refuse(sentence: str) -> int:
    """Print why something failed; returns the exit code."""
    print(f"hookean: {sentence}", file=sys.stderr, flush=True)
    return 2


serve = taking(Options, run)
