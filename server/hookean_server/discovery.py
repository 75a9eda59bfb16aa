"""How clients find the server of this user: a folder with its address, its token, and the Python that starts it.

`server.json` is there while a server runs and is trusted only where its process lives and `GET /v1/health` at its
address answers with the same instance. `python.json` names the interpreter that has hookean, for programs whose own
Python has not. Locks are held by the operating system: a server that is killed leaves none behind.
"""

from __future__ import annotations

import http.client
import json
import os
import sys
import tempfile
import time
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import platformdirs

from hookean_server.problems import MEDIA_TYPE

SERVER, PYTHON, LOCK, SESSIONS = "server.json", "python.json", "server.lock", "sessions.db"
CONNECT = 0.5  # seconds a server may take to be reached
ANSWER = 5.0  # seconds it may take to say how it is


def folder() -> Path:
    """Where the server of this user is found and keeps its sessions; HOOKEAN_STATE moves it."""
    given = os.environ.get("HOOKEAN_STATE")
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
    wire: int = 1
    """Version of the frames."""
    keeps: bool = True
    """Whether sessions outlive it."""

    def write(self, place: Path) -> None:
        """Say it to clients of this user."""
        _write(place / SERVER, asdict(self))

    def remove(self, place: Path) -> None:
        """Take the file away, if it is ours."""
        told = _read(place / SERVER)
        if told is not None and told.get("instance") == self.instance:
            with suppress(OSError):
                (place / SERVER).unlink()


def find(place: Path) -> Found | None:
    """The server of a folder: the file says where, its process lives, and what answers there is that instance."""
    told = _read(place / SERVER)
    try:
        found = Found(**told) if told is not None else None
    except TypeError:
        return None  # a file of another version
    if found is None or not (type(found.pid) is int and type(found.port) is int and alive(found.pid)):
        return None
    health = ask(found, "GET", "/v1/health")
    return found if health is not None and health.get("instance") == found.instance else None


def ask(found: Found, method: str, path: str, token: str = "") -> dict[str, Any] | None:
    """The JSON that a server answers; none where it cannot be reached or answers otherwise."""
    connection = http.client.HTTPConnection(found.url.split("//")[1].rsplit(":", 1)[0], found.port, timeout=CONNECT)
    try:
        connection.connect()
        connection.sock.settimeout(ANSWER)
        connection.request(method, path, headers={"authorization": f"Bearer {token}"} if token else {})
        answer = connection.getresponse()
        value = json.loads(answer.read(1 << 20)) if answer.headers.get_content_type() != MEDIA_TYPE else None
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
    """Make the folder, for this user alone; raises OSError."""
    place.mkdir(parents=True, exist_ok=True, mode=0o700)


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
    try:
        stat = path.stat()
        if hasattr(os, "getuid") and (stat.st_uid != os.getuid() or stat.st_mode & 0o022):
            return None
        value = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    return value if isinstance(value, dict) else None


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
    """What tells a process from a later one of the same number; "" where the system does not say, "ended" for one that
    waits to be collected."""
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
