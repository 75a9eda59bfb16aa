"""What `hookean serve` does: joins the server that runs, or starts one, or stops it."""

from __future__ import annotations

import os
import sys
import time
from dataclasses import dataclass
from pathlib import Path

from hookean_server.discovery import (
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
from hookean_server.tokens import VARIABLE

PORT = 8765
WAIT = 20.0  # seconds for another server of this user to start or to end


@dataclass(frozen=True)
class Options:
    """What a person or a client asks for."""

    host: str = "127.0.0.1"
    port: int | None = None
    """None: the usual one; 0: any."""
    any_port: bool = False
    """Where the port is taken, any free one."""
    keep: bool = True
    """Whether sessions outlive the server."""
    parent_pid: int = 0
    idle_exit: float = 0.0
    """Minutes; 0: never."""


def run(options: Options) -> int:
    """Serve until told to end; the exit code: 0 after a clean end or where one runs already, 2 where it cannot be."""
    place = folder()
    try:
        prepare(place)
        record_python(place)
    except Distrusted as error:
        return _refuse(str(error))
    except OSError as error:
        return _refuse(f"{place} cannot be written ({error.strerror}); set HOOKEAN_STATE to a folder of yours.")
    if options.port and not options.keep and find(place) is not None:
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
                return _refuse(f"Another hookean server has {place / LOCK} and does not answer; end it first.")
            time.sleep(0.1)
        except OSError as error:
            return _refuse(f"{place / LOCK} cannot be written ({error.strerror}).")
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
        return _refuse(str(error))
    found = find(place)
    if found is None:
        if not (place / LOCK).exists() or _free(place):
            print("No hookean server is running.")
            return 0
        print("A hookean server is starting, or does not answer; try again, or end its process.", file=sys.stderr)
        return 1
    ask(found, "POST", "/v1/shutdown")
    until = time.monotonic() + WAIT
    while not _free(place):
        if time.monotonic() > until:
            print(f"The hookean server at {found.url} (process {found.pid}) has not ended.", file=sys.stderr)
            return 1
        time.sleep(0.05)
    print(f"The hookean server at {found.url} has ended" + ("; its sessions are kept." if found.keeps else "."))
    return 0


def studio(file: Path | None, browser: bool) -> int:
    """Show the page, or a file in it; the exit code (see `studio.run`)."""
    from hookean_server.studio import run

    try:
        check(folder())
    except Distrusted as error:
        return _refuse(str(error))
    return run(file, browser)


def store(action: str, target: Path | None) -> int:
    """Look after the file of sessions; the exit code (see `keeping.commands`)."""
    from hookean_server.keeping.commands import run

    return run(action, folder() / SESSIONS, target)


def token(url: bool = False, header: bool = False, renew: bool = False) -> int:
    """Print the token that HOOKEAN_TOKEN gives, else that of the running server; the exit code: 0, or 1 for neither.

    `url`: the address that lets a browser in, instead; what follows its # stays in the browser. `header`: the header
    that a program sends. `renew`: make the running server take another token first, which logs everybody out.
    """
    place = folder()
    try:
        check(place)
    except Distrusted as error:
        return _refuse(str(error))
    given = "" if renew else os.environ.get(VARIABLE, "")
    found = find(place) if url or not given else None
    if found is None and not given:
        print("No hookean server is running; start one with: hookean serve", file=sys.stderr)
        return 1
    if renew and found is not None:
        if ask(found, "POST", "/v1/token") is None or (found := find(place)) is None:
            print("The token was not renewed: the server could not write its file, or has ended.", file=sys.stderr)
            return 1
        print("Everybody is logged out; programs and pages need this token.", file=sys.stderr)
    known = given or (found.token if found is not None else "")
    at = found.url if found is not None else f"http://127.0.0.1:{PORT}"
    print(f"{at}/#t={known}" if url else f"Authorization: Bearer {known}" if header else known)
    return 0


def _join(found: Found, options: Options) -> int:
    if options.port in (None, 0, found.port) or options.any_port:
        print(
            f"hookean already serves at {found.url} (process {found.pid}). `hookean studio` shows it in a browser, "
            "`hookean serve --stop` ends it."
        )
        return 0
    return _refuse(
        f"hookean already serves at {found.url} (process {found.pid}) and keeps the sessions of this user. Use that "
        "one, end it with `hookean serve --stop`, or add --no-keep for a second one that keeps nothing."
    )


def _serve(options: Options, place: Path | None) -> int:
    from hookean_server.main import serve
    from hookean_server.settings import Settings

    state = place / SESSIONS if place is not None and options.keep else None
    try:
        settings = Settings(state=state)
    except ValueError as error:
        return _refuse(str(error))
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


def _refuse(sentence: str) -> int:
    print(sentence, file=sys.stderr)
    return 2
