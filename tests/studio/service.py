"""A service of its own for the browser tests, and the truth about its sessions as HTTP and the Python API tell it."""

from __future__ import annotations

import os
import secrets
import signal
import socket
import subprocess
import sys
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import psutil
from numpy.typing import NDArray

from hookean import Scene, Simulation
from serving import HANG, living, wait_for


class Service:
    """`hookean serve` in a state folder of its own; it can be killed and started again under its pages."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.token = secrets.token_urlsafe(24)
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self.port: int = free.getsockname()[1]
        self.url = f"http://127.0.0.1:{self.port}"
        known = {"authorization": f"Bearer {self.token}"}
        self.client = httpx.Client(base_url=self.url, timeout=HANG, headers=known)
        self.start()

    def start(self) -> None:
        """Serve, at the same port as before, and wait until something can be solved."""
        environment = {**os.environ, "HOOKEAN_STATE": str(self.folder / "state"), "HOOKEAN_TOKEN": self.token}
        command = [sys.executable, "-m", "hookean.cli", "serve", "--port", str(self.port)]
        # a pipe that nobody reads would hold the service up once it is full
        with open(self.folder / "service.log", "a") as log:
            self.process = subprocess.Popen(command, env=environment, stdout=log, stderr=log)
        wait_for(self._ready)  # kernels may have to be compiled first

    def _ready(self) -> bool:
        assert self.process.poll() is None, (self.folder / "service.log").read_text()
        try:
            return bool(self.client.get("/v1/health").json()["workers"]["idle"])
        except httpx.TransportError:
            return False

    def kill(self) -> None:
        """kill -9, as a machine that loses power."""
        family = [psutil.Process(self.process.pid), *psutil.Process(self.process.pid).children(recursive=True)]
        os.kill(self.process.pid, signal.SIGKILL)
        self.process.wait(HANG)
        wait_for(lambda: not any(living(process.pid) for process in family))

    def end(self) -> None:
        self.process.terminate()
        try:
            self.process.wait(HANG)
        finally:
            self.process.kill()
            self.client.close()

    # what is true of a session

    def put(self, key: str, scene: dict[str, Any]) -> dict[str, Any]:
        return self._done(self.client.put(f"/v1/sessions/{key}", json=scene))

    def act(self, key: str, action: str) -> dict[str, Any]:
        return self._done(self.client.post(f"/v1/sessions/{key}/{action}"))

    def edit(self, key: str, patch: dict[str, Any]) -> dict[str, Any]:
        return self._done(self.client.patch(f"/v1/sessions/{key}", json=patch))

    def summary(self, key: str) -> dict[str, Any]:
        return self._done(self.client.get(f"/v1/sessions/{key}"))

    def summaries(self) -> list[dict[str, Any]]:
        found: list[dict[str, Any]] = self._done(self.client.get("/v1/sessions"))["sessions"]
        return found

    def scene(self, key: str) -> dict[str, Any]:
        return self._done(self.client.get(f"/v1/sessions/{key}/scene"))

    def example(self, name: str) -> dict[str, Any]:
        """The scene of a figure of the gallery."""
        return self._done(self.client.get(f"/v1/examples/{name}/scene"))

    def anchors(self, key: str) -> list[dict[str, Any]]:
        found: list[dict[str, Any]] = self._done(self.client.get(f"/v1/sessions/{key}/anchors"))["anchors"]
        return found

    def state(self, key: str) -> dict[str, Any]:
        return self._done(self.client.get(f"/v1/sessions/{key}/state"))

    def particles(self, key: str) -> NDArray[np.float64]:
        return np.array(self.state(key)["particles"], float)

    def at_rest(self, key: str, seconds: float = HANG) -> None:
        """Wait until it is in equilibrium and nothing is on its way."""
        wait_for(lambda: self.summary(key)["status"] == "converged", seconds)

    @staticmethod
    def _done(answer: httpx.Response) -> dict[str, Any]:
        assert answer.is_success, answer.text
        found: dict[str, Any] = answer.json()
        return found


def equilibrium(scene: dict[str, Any], *patches: dict[str, Any]) -> NDArray[np.float64]:
    """Where the particles of a scene come to rest after these edits, by the Python API alone."""
    simulation = Simulation(Scene.model_validate(scene))
    for patch in patches:
        simulation.patch(patch)
    result = simulation.relax()
    assert result.status == "converged", result.message
    return np.asarray(result.particles, float)
