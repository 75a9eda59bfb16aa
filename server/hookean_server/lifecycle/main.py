"""The service from its port and its lock to its end. What answers requests is imported while workers warm up."""

from __future__ import annotations

import signal
import sys
from dataclasses import replace
from pathlib import Path

from hookean_server.http.tokens import Unfit, chosen
from hookean_server.lifecycle import leftovers
from hookean_server.lifecycle.discovery import Held, Lock
from hookean_server.lifecycle.ports import Taken, take
from hookean_server.settings import Settings
from hookean_server.workers.pool import FORKED, context, end_fork_server

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
    """Serve until Ctrl-C or SIGTERM; the exit code: 0 after a clean end, 2 if the port or the file of sessions
    is not available.

    Prints the address and an example. Port 0: any free port; `any_port`: any free port if `port` is in use. The
    address is written to the folder `place`, for clients to find. It ends with the process `parent_pid`, and after
    `idle_seconds` without use. A host beyond this machine gives a warning: traffic is not encrypted, nor is the token.
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
            f"Warning: other machines can connect to {host}, and traffic (with the token) is not encrypted.",
            file=sys.stderr,
        )
    code = 0
    try:
        leftovers.sweep(place)
        _start_fork_server()
        from hookean_server.lifecycle.running import run

        code = run(settings, sock, place, parent_pid, idle_seconds)
    except KeyboardInterrupt:
        pass
    finally:
        end_fork_server()
        sock.close()
        if lock is not None:
            lock.release()
    return code


def _own(state: Path) -> Lock:
    """The right to a file of sessions; raises Held with a sentence."""
    try:
        state.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
        return Lock(state.with_name(state.name + ".lock"))
    except Held:
        raise Held(
            f"Another hookean server keeps its sessions in {state}; stop it, or give this one another file."
        ) from None
    except OSError as error:
        raise Held(f"Sessions cannot be kept in {state} ({error.strerror}).") from None


def _start_fork_server() -> None:
    """Start the process that workers are forked from. It ignores Ctrl-C, which goes to the whole group."""
    if not FORKED:
        return
    from multiprocessing import current_process, forkserver, resource_tracker

    # its sockets; in a folder of the interpreter's they would stay behind a process that is killed
    current_process()._config["tempdir"] = leftovers.folder_of_sockets()  # type: ignore[attr-defined]
    context()
    resource_tracker.ensure_running()  # it unblocks the signal after its own start
    signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])
    try:
        forkserver.ensure_running()
    finally:
        signal.pthread_sigmask(signal.SIG_UNBLOCK, [signal.SIGINT])
