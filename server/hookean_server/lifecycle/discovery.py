"""How clients find the server of this user: a folder with its address, its token, and the Python that starts it.

`server.json` is there while a server runs. Only its user can read it, and it is trusted only where no other user could
have written it, and where what answers at its address proves that it knows the key in it: HMAC-SHA256 of a random
nonce, by `GET /v1/proof`. A token is sent down a connection that has proven this, and no other. `python.json` names the
interpreter that has hookean, for programs whose own Python has not. Locks are held by the operating system: a server
that is killed leaves none behind.
"""

from __future__ import annotations

import hashlib
import hmac
import http.client
import json
import os
import secrets
import socket
import stat
import sys
import tempfile
import threading
import time
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import platformdirs

from hookean_server.problems import MEDIA_TYPE

VARIABLE = "HOOKEAN_STATE"
SERVER, PYTHON, LOCK, SESSIONS = "server.json", "python.json", "server.lock", "sessions.db"
CONNECT = 0.5  # seconds a server may take to be reached
ANSWER = 5.0  # seconds it may take to say how it is


def folder() -> Path:
    """Where the server of this user is found and keeps its sessions; HOOKEAN_STATE moves it."""
    given = os.environ.get(VARIABLE)
    return Path(given) if given else Path(platformdirs.user_state_dir("hookean", appauthor=False))


@dataclass(frozen=True)
class Found:
    """A running server, as its file has it."""

    pid: int
    port: int
    url: str
    token: str
    version: str
    instance: str
    started: float
    """Seconds since 1970."""
    proof: str
    """Key by which it proves that it wrote this file."""
    wire: int = 1
    """Version of the frames."""
    keeps: bool = True
    """Whether sessions outlive it."""

    def write(self, place: Path) -> None:
        """Write the file that clients of this user read."""
        _write(place / SERVER, asdict(self))

    def remove(self, place: Path) -> None:
        """Remove the file, if this server wrote it."""
        written = _read(place / SERVER)
        if written is not None and written.get("instance") == self.instance:
            with suppress(OSError):
                (place / SERVER).unlink()


class Distrusted(OSError):
    """A folder, or a file in it, that other users could have written; the sentence gives the remedy."""


def check(place: Path) -> None:
    """Raise Distrusted if other users can write to the folder, or wrote a file in it; a missing folder is
    accepted."""
    if not hasattr(os, "getuid"):
        return
    advice = f"check who made it, then remove it, or set {VARIABLE} to a folder that is yours alone."
    try:
        about = place.stat()
    except OSError:
        return
    if about.st_uid != os.getuid():
        raise Distrusted(f"{place} belongs to another user; {advice}")
    if about.st_mode & 0o022:
        raise Distrusted(f"Other users may write to {place}; chmod 700 it, or set {VARIABLE} to another folder.")
    for path in (place / SERVER, place / PYTHON):
        if not _private_or_none(path):
            raise Distrusted(f"{path} is not a file that you alone can write to; {advice}")


def find(place: Path) -> Found | None:
    """The server of a folder: what answers at the address in its file proves that it wrote that file."""
    told = _read(place / SERVER)
    try:
        found = Found(**told) if told is not None else None
    except TypeError:
        return None  # a file of another version
    connection = proven(found) if found is not None else None
    if connection is None:
        return None
    connection.close()
    return found


def proven(found: Found, patience: float = ANSWER) -> http.client.HTTPConnection | None:
    """A connection to a server that has proven who it is; None where nothing there can. Once it has closed it is not
    opened again, as somebody else may have taken the port."""
    nonce = secrets.token_hex(32)
    connection = http.client.HTTPConnection("")
    patient = threading.Timer(ANSWER, lambda: _end(connection))  # also of what trickles
    patient.daemon = True
    try:
        host, _, port = found.url.split("//")[1].rpartition(":")
        connection = http.client.HTTPConnection(host.strip("[]"), int(port), timeout=CONNECT)
        connection.connect()
        connection.auto_open = 0
        connection.sock.settimeout(ANSWER)
        patient.start()
        connection.request("GET", f"/v1/proof?nonce={nonce}")
        said = json.loads(connection.getresponse().read(1 << 16))
        address = connection.sock.getpeername()[0]
        text = f"hookean {found.instance} {address} {port} {nonce}"
        known = hmac.new(found.proof.encode(), text.encode(), hashlib.sha256)
        if hmac.compare_digest(known.hexdigest().encode(), str(said["proof"]).encode()):
            connection.sock.settimeout(patience)
            return connection
    except (OSError, http.client.HTTPException, ValueError, TypeError, LookupError, AttributeError):
        pass
    finally:
        patient.cancel()
    connection.close()
    return None


def _end(connection: http.client.HTTPConnection) -> None:
    with suppress(OSError, AttributeError):
        connection.sock.shutdown(socket.SHUT_RDWR)


def ask(found: Found, method: str, path: str) -> dict[str, Any] | None:
    """The JSON object that a server answers to its user, empty for an answer without a body; None where it cannot be
    reached or answers with a problem."""
    connection = proven(found)
    if connection is None:
        return None
    try:
        connection.request(method, path, headers={"authorization": f"Bearer {found.token}"})
        answer = connection.getresponse()
        body = answer.read(1 << 20)
        if answer.status == 204:
            return {}
        value = json.loads(body) if answer.headers.get_content_type() != MEDIA_TYPE else None
        return value if isinstance(value, dict) else None
    except (OSError, http.client.HTTPException, ValueError):
        return None
    finally:
        connection.close()


def record_python(place: Path) -> None:
    """Record which Python starts the server, once; again where that one is gone."""
    told = _read(place / PYTHON)
    if told is None or not Path(str(told.get("python"))).exists():
        _write(place / PYTHON, {"python": sys.executable})


def prepare(place: Path) -> None:
    """Make the folder, for this user alone; raises OSError, or Distrusted with a sentence."""
    place.mkdir(parents=True, exist_ok=True, mode=0o700)
    check(place)


def _write(path: Path, value: dict[str, Any]) -> None:
    """Readers see the old file or the whole new one; nobody else may read it."""
    handle, name = tempfile.mkstemp(dir=path.parent, prefix=path.name, suffix=".new")  # made with mode 0600
    try:
        with os.fdopen(handle, "w", encoding="utf-8") as file:
            json.dump(value, file)
        _replace(name, path)
    except BaseException:
        with suppress(OSError):
            os.unlink(name)
        raise


def _replace(name: str, path: Path) -> None:
    """Windows refuses while somebody reads; readers are quick."""
    until = time.monotonic() + 1.0
    while True:
        try:
            os.replace(name, path)
            return
        except PermissionError:
            if sys.platform != "win32" or time.monotonic() > until:
                raise
            time.sleep(0.01)


def _read(path: Path) -> dict[str, Any] | None:
    """The object in a file that is this user's and that no other user could have written."""
    # no link is followed, and nothing waits for somebody to write to a pipe
    flags = os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0)
    try:
        with os.fdopen(os.open(path, flags), encoding="utf-8") as file:
            value = json.load(file) if _private(os.fstat(file.fileno())) else None
    except (OSError, ValueError):
        return None
    return value if isinstance(value, dict) else None


def _private(file: os.stat_result) -> bool:
    """Whether a file is one that no other user could have written: where the system has users."""
    ours = not hasattr(os, "getuid") or file.st_uid == os.getuid() and not file.st_mode & 0o022
    return ours and stat.S_ISREG(file.st_mode)


def _private_or_none(path: Path) -> bool:
    try:
        return _private(path.lstat())
    except OSError:
        return True


class Held(OSError):
    """A lock that another process holds."""


class Lock:
    """An exclusive lock on a file, which ends with the process that holds it. Raises Held, or OSError."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.handle = os.open(path, os.O_RDWR | os.O_CREAT, 0o600)
        try:
            _lock(self.handle)
        except OSError:
            os.close(self.handle)
            raise Held(f"{path.name} is held by another process") from None

    def release(self) -> None:
        """Let others have it; the file stays, as removing it would let two hold it."""
        with suppress(OSError):
            os.close(self.handle)


def _lock(handle: int) -> None:
    if sys.platform == "win32":
        import msvcrt

        msvcrt.locking(handle, msvcrt.LK_NBLCK, 1)
    else:
        with suppress(ModuleNotFoundError):
            import fcntl

            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)


def alive(pid: int) -> bool:
    """Whether a process runs; one that has ended and waits to be collected does not."""
    if pid <= 0:
        return False
    if sys.platform == "win32":
        return _alive_on_windows(pid)
    try:
        os.kill(pid, 0)
    except PermissionError:
        return True
    except (OSError, OverflowError):
        return False
    return birth(pid) != "ended"


def birth(pid: int) -> str:
    """Distinguishes a process from a later one with the same number; "" if the system has no such information, "ended"
    for one that waits to be collected."""
    try:
        cells = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    except (OSError, IndexError):
        return ""
    return "ended" if cells[0] in "ZX" else cells[19]


def _alive_on_windows(pid: int) -> bool:
    import ctypes

    kernel: Any = vars(ctypes)["windll"].kernel32
    kernel.OpenProcess.restype = ctypes.c_void_p
    handle = kernel.OpenProcess(0x00100000, False, pid)  # SYNCHRONIZE
    if not handle:
        return bool(kernel.GetLastError() == 5)  # denied: it runs, as somebody else
    try:
        return bool(kernel.WaitForSingleObject(ctypes.c_void_p(handle), 0) == 0x102)  # still running
    finally:
        kernel.CloseHandle(ctypes.c_void_p(handle))
