"""A real server on a free port, in a process of its own."""

from __future__ import annotations

import json
import os
import re
import secrets
import signal
import socket
import subprocess
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import Any

import httpx
import psutil
import pytest

import forking
from serving import HANG, wait_for


def endless(seconds: float = 60.0) -> dict[str, Any]:
    """A scene that is solved until its time is over: a long swinging chain without damping."""
    count = 20_000
    settings = {"solver": "verlet", "drag": 0, "time_step": 0.001, "max_iterations": 10**9, "tolerance": 0}
    return {
        "particles": [[float(i), 0.0, 0.0] for i in range(count)],
        "forces": [
            {"kind": "springs", "particles": [[i, i + 1] for i in range(count - 1)], "damping": 0},
            {"kind": "self_weight", "total": 20.0 * count},
        ],
        "anchors": [{"particles": [0, count - 1]}],
        "settings": {**settings, "time_limit": seconds},
    }


PATIENT = f"from hookean_server.lifecycle import ending; ending.LONGEST = {2 * HANG};"
"""For a server whose end is never cut short: it ends by itself, or hangs for the test to see."""


class Served:
    """One running server; `first` is code that its process runs before anything else; `fresh`: in a new interpreter."""

    def __init__(self, first: str = "", *, fresh: bool = False, **settings: Any) -> None:
        settings.setdefault("token", secrets.token_urlsafe(32))
        self.token: str = settings["token"]
        self.known = {"authorization": f"Bearer {self.token}"}
        self.head = f"Authorization: Bearer {self.token}\r\n"  # for requests written by hand
        code = first + (
            "import sys; from hookean_server.lifecycle.main import serve; from hookean_server.settings import Settings;"
            f"sys.exit(serve(port=0, settings=Settings(**{settings!r})))"
        )
        # a pipe that nobody reads would hold the server up once it is full
        self._log = tempfile.TemporaryFile("w+")  # noqa: SIM115
        self.process = forking.process(code, [], dict(os.environ), subprocess.PIPE, self._log, fresh)
        assert self.process.stdout is not None
        self.said = self.process.stdout.readline()
        found = re.search(r"http://127\.0\.0\.1:(\d+)", self.said)
        assert found, (self.process.wait(HANG), self.log())
        self.url, self.port = found.group(0), int(found.group(1))
        self.client = httpx.Client(base_url=self.url, timeout=HANG, headers=self.known)

    def log(self) -> str:
        """What was written to stderr so far."""
        size = os.fstat(self._log.fileno()).st_size
        return os.pread(self._log.fileno(), size, 0).decode()

    def ready(self) -> Served:
        """Wait until a worker is idle."""
        wait_for(lambda: self.health()["workers"]["idle"] > 0)  # kernels may have to be compiled first
        return self

    def health(self) -> dict[str, Any]:
        found: dict[str, Any] = self.client.get("/v1/health").json()
        return found

    def workers(self) -> list[psutil.Process]:
        """The processes that solve: children of the fork server or of the server."""
        found = []
        for child in psutil.Process(self.process.pid).children(recursive=True):
            with suppress(psutil.NoSuchProcess):  # it may end while it is looked at
                if (
                    child.status() != psutil.STATUS_ZOMBIE
                    and not child.children()
                    and "tracker" not in " ".join(child.cmdline())
                ):
                    found.append(child)
        return found

    def family(self) -> list[psutil.Process]:
        return psutil.Process(self.process.pid).children(recursive=True)

    def end(self, number: int = signal.SIGTERM) -> tuple[int, str]:
        """Exit code and what was written to stderr."""
        if self.process.poll() is None:
            self.process.send_signal(number)
        try:
            self.process.communicate(timeout=HANG)
        finally:
            self.process.kill()
            self.client.close()
        said = self.log()
        self._log.close()
        return self.process.returncode, said


def computing(process: psutil.Process) -> None:
    """Wait until a process has computed for some while, longer than it takes to be idle for a minute."""
    begun = sum(process.cpu_times()[:2])
    wait_for(lambda: sum(process.cpu_times()[:2]) > begun + 0.3)


@contextmanager
def asked(served: Served, scene: dict[str, Any], path: str = "/v1/relax") -> Iterator[None]:
    """A client that has asked for a solve, and leaves at the end of the block."""
    body = json.dumps(scene).encode()
    head = f"POST {path} HTTP/1.1\r\nHost: 127.0.0.1:{served.port}\r\n{served.head}"
    head += f"Content-Type: application/json\r\nContent-Length: {len(body)}\r\n\r\n"
    with socket.create_connection(("127.0.0.1", served.port), timeout=HANG) as sock:
        sock.sendall(head.encode() + body)
        yield


@pytest.fixture(scope="session")
def served() -> Iterator[Served]:
    found = Served(fresh=True)  # one at least that no test helps to start
    yield found.ready()
    found.end()


@pytest.fixture
def client(served: Served) -> httpx.Client:
    return served.client


def problem(response: httpx.Response, status: int, slug: str) -> dict[str, Any]:
    """The problem document of a response, checked."""
    assert response.status_code == status, response.text[:500]
    assert response.headers["content-type"] == "application/problem+json"
    found: dict[str, Any] = response.json()
    assert found["type"] == f"/problems/{slug}"
    assert found["status"] == status
    assert found["title"] and found["detail"]
    assert found["instance"].startswith("urn:uuid:") and found["instance"] == response.headers["x-request-id"]
    if "values" in found:  # as Hops reads it as well
        assert [found.pop(name) for name in ("values", "warnings", "Inputs", "Outputs")] == [[]] * 4
        assert found.pop("errors") == [found["detail"]]
    assert set(found) <= {"type", "title", "status", "detail", "instance", "errors"}
    for error in found.get("errors", []):
        assert set(error) == {"pointer", "detail"}
        assert error["pointer"].startswith("/") and len(error["pointer"]) <= 200
        assert 0 < len(error["detail"]) <= 600
    assert len(found.get("errors", [])) <= 20
    assert "Traceback" not in response.text and "site-packages" not in response.text
    return found
