"""Opens a port, or reports which program uses it."""

from __future__ import annotations

import errno
import socket
import sys
from contextlib import suppress
from pathlib import Path

_IN_USE = (errno.EADDRINUSE, getattr(errno, "WSAEADDRINUSE", errno.EADDRINUSE))


class Taken(OSError):
    """The port is not available; the sentence gives the reason."""


def take(host: str, port: int, *, or_any: bool = False) -> socket.socket:
    """A listening socket; port 0: any free port; with `or_any` also if this one is in use. Raises Taken with one
    sentence."""
    try:
        return _take(host, port)
    except (OSError, OverflowError) as error:
        if or_any and getattr(error, "errno", None) in _IN_USE:
            return take(host, 0)
        raise Taken(_why(host, port, error)) from None


def _take(host: str, port: int) -> socket.socket:
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    # named as TCP, or asyncio would not switch off the delay of small writes
    sock = socket.socket(family, socket.SOCK_STREAM, socket.IPPROTO_TCP)
    try:
        if sys.platform == "win32":
            sock.setsockopt(socket.SOL_SOCKET, socket.SO_EXCLUSIVEADDRUSE, 1)
        else:
            sock.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        sock.bind((host, port))
        sock.listen(128)
    except BaseException:
        sock.close()
        raise
    return sock


def _why(host: str, port: int, error: Exception) -> str:
    if getattr(error, "errno", None) in _IN_USE:
        holder = owner(port)
        return (
            f"Port {port} is in use by {holder or 'another program'}; stop it, or choose another with --port "
            "(make: PORT=9000 make run)."
        )
    if getattr(error, "errno", None) == errno.EACCES:
        return f"This user may not listen on port {port}; choose one above 1023 with --port."
    return f"Cannot listen on {host}:{port} ({getattr(error, 'strerror', None) or error}); choose another address."


def owner(port: int) -> str:
    """The program that listens on a TCP port, as `name (process 123)`; empty if unknown."""
    for ask in (_by_psutil, _by_proc):
        with suppress(Exception):
            if found := ask(port):
                return found
    return ""


def _by_psutil(port: int) -> str:
    import psutil  # type: ignore[import-untyped,unused-ignore]

    for connection in psutil.net_connections("tcp"):
        if connection.status == psutil.CONN_LISTEN and connection.laddr.port == port and connection.pid:
            process = psutil.Process(connection.pid)
            return f"{_called(process.name(), process.cmdline())} (process {connection.pid})"
    return ""


def _by_proc(port: int) -> str:
    inodes = set()
    for table in ("tcp", "tcp6"):
        with suppress(OSError):
            for line in Path(f"/proc/net/{table}").read_text().splitlines()[1:]:
                cells = line.split()
                if cells[3] == "0A" and int(cells[1].rsplit(":", 1)[1], 16) == port:
                    inodes.add(f"socket:[{cells[9]}]")
    for folder in Path("/proc").glob("[0-9]*"):
        with suppress(OSError):
            if any(str(fd.readlink()) in inodes for fd in (folder / "fd").iterdir()):
                command = (folder / "cmdline").read_bytes().decode("utf-8", "replace").split("\0")
                return f"{_called((folder / 'comm').read_text().strip(), command)} (process {folder.name})"
    return ""


def _called(name: str, command: list[str]) -> str:
    """`hookean` where a Python program is that."""
    return "hookean" if any("hookean" in Path(part).name for part in command[:4]) else name
