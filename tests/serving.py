"""A folder of a user's own in which `hookean serve` runs, is found and ends."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any

import httpx
import psutil

import forking
from forking import hears as hears
from soak import SOAK as SOAK

CABLE: dict[str, Any] = {
    "particles": [[0, 0, 0], [2, 0, 0], [4, 0, 0], [6, 0, 0], [8, 0, 0], [10, 0, 0]],
    "forces": [
        {"kind": "springs", "particles": [[0, 1], [1, 2], [2, 3], [3, 4], [4, 5]], "stiffness": 1000},
        {"kind": "unary", "particles": [0, 1, 2, 3, 4, 5], "vector": [0, 0, -20]},
    ],
    "anchors": [{"particles": [0, 5]}],
}
SWING: dict[str, Any] = {
    **CABLE,
    "forces": [{**CABLE["forces"][0], "damping": 0}, CABLE["forces"][1]],
    "settings": {"solver": "verlet", "drag": 0, "time_step": 0.001, "max_iterations": 10**9, "tolerance": 0},
}
"""The same without damping: it never comes to rest."""


@cache
def app() -> Any:
    """The service's app as it is without settings, for what does not change it: its description takes a second."""
    from hookean_server.app import create_app

    return create_app()


HANG = forking.LONGEST
"""Seconds after which a test takes what it waits for to hang. Workers of jobs give way to everything else (nice 10),
kernels may have to be compiled first: on a loaded machine a second of work takes a minute."""


def wait_for(true: Callable[[], Any], seconds: float = HANG) -> Any:
    """What `true()` is, once it is; fails after `seconds`."""
    until, pause = time.monotonic() + seconds, 0.005
    while not (found := true()):
        assert time.monotonic() < until, "waited too long"
        time.sleep(pause)  # longer and longer: looking takes time from what is waited for
        pause = min(1.3 * pause, 0.06)
    return found


def living(pid: int) -> bool:
    """Whether a process runs; one that waits to be collected does not."""
    try:
        return bool(psutil.Process(pid).status() != psutil.STATUS_ZOMBIE)
    except psutil.NoSuchProcess:
        return False


class Home:
    """A state folder and the servers started in it; `fresh`: each in a new interpreter."""

    def __init__(self, folder: Path, fresh: bool = False) -> None:
        self.folder, self.fresh = folder, fresh
        self.environment = {**os.environ, "HOOKEAN_STATE": str(folder), "HOOKEAN_PYTHON": sys.executable}
        self.environment.pop("HOOKEAN_TOKEN", None)
        self.started: list[subprocess.Popen[str]] = []

    def start(self, *options: str) -> subprocess.Popen[str]:
        """`hookean serve` with any free port."""
        return self.run(forking.COMMAND, "serve", *(options or ("--port", "0")))

    def run(self, code: str, *words: str) -> Any:
        """A process of this code with these arguments, which ends with the rest of what was started here."""
        pipe = subprocess.PIPE
        self.started.append(forking.process(code, [*words], self.environment, pipe, pipe, self.fresh))
        return self.started[-1]

    def serve(self, *options: str) -> subprocess.Popen[str]:
        """The same, once it says that it serves."""
        process = self.start("--port", "0", *options)
        assert process.stdout is not None
        said = process.stdout.readline()
        assert said.startswith("hookean serves at"), (said, process.communicate(timeout=20))
        return process

    def command(self, *words: str) -> subprocess.CompletedProcess[str]:
        """`hookean` with these words, to its end."""
        return forking.run(forking.COMMAND, *words, environment=self.environment, fresh=self.fresh)

    @property
    def told(self) -> dict[str, Any]:
        """What server.json says; empty where there is none."""
        try:
            found: dict[str, Any] = json.loads((self.folder / "server.json").read_text())
        except FileNotFoundError:
            return {}
        return found

    def delete_sessions(self) -> None:
        """No session is left: a server keeps 200."""
        told = self.told
        with httpx.Client(base_url=told["url"], headers={"Authorization": f"Bearer {told['token']}"}) as client:
            for session in client.get("/v1/sessions").raise_for_status().json()["sessions"]:
                client.delete(f"/v1/sessions/{session['key']}").raise_for_status()

    def serving(self) -> list[int]:
        """The processes that hold the lock of this folder open: those that serve, or look whether one does."""
        lock, found = self.folder / "server.lock", []
        for process in psutil.process_iter():
            with suppress(psutil.Error, OSError):
                if process.pid == os.getpid() or "python" not in process.name().lower():
                    continue  # looking at what every process has open takes long
                if any(Path(file.path) == lock for file in process.open_files()):
                    found.append(process.pid)
        return found

    def kill(self) -> int:
        """kill -9 of the server that is told of; its number."""
        [pid] = self.serving()  # never by the number in a file, which may be anybody's
        os.kill(pid, signal.SIGKILL)
        wait_for(lambda: not living(pid))
        return pid

    def end(self) -> None:
        """End all that was started here, and what they started, whatever state it is in."""
        pids = {process.pid for process in self.started if process.poll() is None} | set(self.serving())
        processes = []
        for pid in pids:
            with suppress(psutil.NoSuchProcess):
                processes += [psutil.Process(pid), *psutil.Process(pid).children(recursive=True)]
        for process in processes:
            with suppress(psutil.NoSuchProcess):
                process.kill()
        for started in self.started:
            started.communicate(timeout=30)
        wait_for(lambda: not any(living(process.pid) for process in processes))
