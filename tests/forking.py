"""Servers that start in a moment: forked from a process that has imported the service and loaded its kernels once.

`Forked` looks like `subprocess.Popen`. Where a process cannot be forked - no Linux, `make soak`, an environment that
the interpreter or numpy reads at their start - `process` starts it in the ordinary way.
"""

from __future__ import annotations

import atexit
import gc
import json
import os
import select
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import threading
from contextlib import suppress
from multiprocessing import util
from types import ModuleType
from typing import IO, Any

from soak import SOAK

EARLY = ("PYTHON", "LD_", "NUMBA_", "OPENBLAS_", "OMP_", "HOOKEAN_CACHE", "HOME", "XDG_", "LANG", "LC_")
"""Beginnings of the names of variables that may be read before the code that is to run."""
LONGEST = 900.0
"""Seconds after which a process hangs."""
COMMAND = "from hookean.cli import main; main()"
_ROOM = 2**20  # bytes of a request: its environment and its code


def process(code: str, words: list[str], environment: dict[str, str], stdout: Any, stderr: Any, fresh: bool) -> Any:
    """Run `code` with the arguments `words`; `fresh`: in a new interpreter. A pipe is read as text."""
    origin = None if fresh or SOAK else Origin.get(environment)
    if origin is not None:
        return Forked(origin, code, words, environment, stdout, stderr)
    start = hears if os.name == "posix" else None
    command = [sys.executable, *(["-m", "hookean.cli"] if code == COMMAND else ["-c", code]), *words]
    return subprocess.Popen(command, env=environment, stdout=stdout, stderr=stderr, text=True, preexec_fn=start)


def hears() -> None:
    """For a child before it starts: signals end it that the shell of these tests may ignore (nohup, background)."""
    for number in (signal.SIGINT, signal.SIGHUP):
        signal.signal(number, signal.SIG_DFL)


def run(
    code: str, *words: str, environment: dict[str, str] | None = None, fresh: bool = False
) -> subprocess.CompletedProcess[str]:
    """The same to its end, with what it wrote."""
    pipe, known = subprocess.PIPE, dict(os.environ) if environment is None else environment
    started = process(code, [*words], known, pipe, pipe, fresh)
    try:
        said = started.communicate(timeout=LONGEST)
    finally:
        started.kill()
    return subprocess.CompletedProcess([code, *words], started.returncode, *said)


class Origin:
    """The process that others are forked from."""

    _found: Origin | None = None

    def __init__(self) -> None:
        self.socket, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, _ROOM)
        self.environment = dict(os.environ)
        self.lock = threading.Lock()
        command = [sys.executable, __file__, str(theirs.fileno())]
        self.process = subprocess.Popen(command, pass_fds=[theirs.fileno()])
        theirs.close()
        atexit.register(self.close)

    @classmethod
    def get(cls, environment: dict[str, str]) -> Origin | None:
        """The one of this process; none where what it has read at its start may differ."""
        if not sys.platform.startswith("linux") or not hasattr(os, "pidfd_open"):
            return None
        cls._found = cls._found or cls()
        return cls._found if _early(environment) == _early(cls._found.environment) else None

    def close(self) -> None:
        self.socket.close()
        self.process.wait()


def _early(environment: dict[str, str]) -> dict[str, str]:
    return {name: value for name, value in environment.items() if name.startswith(EARLY)}


class Forked:
    """A process forked from the origin."""

    def __init__(
        self, origin: Origin, code: str, words: list[str], environment: dict[str, str], stdout: Any, stderr: Any
    ) -> None:
        self.returncode: int | None = None
        (self.stdout, out), (self.stderr, err) = _end(stdout), _end(stderr)
        ours, status = os.pipe()
        self._status = os.fdopen(ours, "rb", buffering=0)
        told = {"code": code, "words": words, "environment": environment, "folder": os.getcwd()}
        with origin.lock:
            socket.send_fds(origin.socket, [json.dumps(told).encode()], [out, err, status])
            self.pid: int = struct.unpack("q", origin.socket.recv(8))[0]
        for file, given in ((out, stdout), (err, stderr), (status, subprocess.PIPE)):
            if given == subprocess.PIPE:
                os.close(file)

    def wait(self, timeout: float | None = None) -> int:
        """The exit code, once it has ended."""
        if self.returncode is None:
            if not select.select([self._status], [], [], timeout)[0]:
                raise subprocess.TimeoutExpired("a forked process", timeout or 0.0)
            with self._status:
                self.returncode = struct.unpack("q", self._status.read(8))[0]
        return self.returncode

    def poll(self) -> int | None:
        """The exit code, or none while it runs."""
        try:
            return self.wait(0.0)
        except subprocess.TimeoutExpired:
            return None

    def communicate(self, timeout: float | None = None) -> tuple[str | None, str | None]:
        """What is left to read, once it has ended."""
        said: dict[int, str] = {}

        def read(number: int, pipe: IO[str]) -> None:
            with pipe:
                said[number] = pipe.read()

        pipes = [(number, pipe) for number, pipe in enumerate((self.stdout, self.stderr)) if pipe and not pipe.closed]
        readers = [threading.Thread(target=read, args=pair, daemon=True) for pair in pipes]
        for reader in readers:
            reader.start()
        self.wait(timeout)
        for reader in readers:
            reader.join(timeout)
            if reader.is_alive():
                raise subprocess.TimeoutExpired("a forked process", timeout or 0.0)
        return (said.get(0, "" if self.stdout else None), said.get(1, "" if self.stderr else None))

    def send_signal(self, number: int) -> None:
        if self.poll() is None:
            with suppress(ProcessLookupError):  # it has ended since, and its end is not told yet
                os.kill(self.pid, number)

    def terminate(self) -> None:
        self.send_signal(signal.SIGTERM)

    def kill(self) -> None:
        self.send_signal(signal.SIGKILL)


def _end(given: Any) -> tuple[IO[str] | None, int]:
    """Our end of a pipe, where there is one, and the file that the other process writes to."""
    if given != subprocess.PIPE:
        return None, given.fileno()
    ours, theirs = os.pipe()
    return os.fdopen(ours), theirs


# ---- in the origin


def _main(requests: socket.socket) -> None:
    """Fork for each request; returns, in the forked process, after its code. Ends when nobody asks any more."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    _warm()
    running: dict[int, tuple[int, int]] = {}  # by pidfd: its number, and where its exit code is written
    while True:
        for file in select.select([requests, *running], [], [])[0]:
            if file is not requests:
                _report(file, *running.pop(file))
                continue
            message, files, _, _ = socket.recv_fds(requests, _ROOM, 3)
            if not message:
                os._exit(0)
            if not (pid := os.fork()):
                requests.detach()
                return _become(json.loads(message), files)
            running[os.pidfd_open(pid)] = (pid, files[2])
            for given in files[:2]:
                os.close(given)
            requests.send(struct.pack("q", pid))


def _report(file: int, pid: int, status: int) -> None:
    """Write the exit code of a process that has ended."""
    code = os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])
    with suppress(BrokenPipeError):  # nobody wants to know
        os.write(status, struct.pack("q", code))
    os.close(file)
    os.close(status)


def _warm() -> None:
    """Import the service and the command line, and load the kernels. Where numba had to compile them this starts a
    second time, without numba, as every later process does."""
    for name in ("hookean.cli", "hookean_server.app", "hookean_server.lifecycle.running"):
        __import__(name)
    from hookean_server.workers.warm import warm

    warm()
    if "numba" in sys.modules and not sys.argv[2:]:
        os.execv(sys.executable, [sys.executable, *sys.argv, "again"])
    gc.collect()
    gc.freeze()  # pages that no collection writes to stay shared


def _become(request: dict[str, Any], files: list[int]) -> None:
    """Turn into the process that was asked for, in all that its code may look at, and run that."""
    os.dup2(files[0], 1)
    os.dup2(files[1], 2)
    os.closerange(3, 65536)
    os.environ.clear()
    os.environ.update(request["environment"])
    os.chdir(request["folder"])
    sys.argv, sys.path[0] = ["hookean", *request["words"]], ""
    tempfile.tempdir = None  # as the environment says now
    main = sys.modules["__main__"] = ModuleType("__main__")
    signal.signal(signal.SIGHUP, signal.SIG_DFL)
    _reserve()
    signal.signal(signal.SIGINT, signal.default_int_handler)
    exec(compile(request["code"], "<string>", "exec"), main.__dict__)


def _reserve() -> None:
    """Keep a process for workers to be forked from, as it was before the code has changed anything. It takes the place
    of the first such process that multiprocessing starts."""
    ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    pid, start = os.fork(), util.spawnv_passfds
    if not pid:
        ours.close()
        message, files, _, _ = socket.recv_fds(theirs, _ROOM, 8)
        theirs.close()
        if message:
            _fork_workers(json.loads(message), files)
        os._exit(0)
    theirs.close()

    def spawn(path: Any, arguments: list[str], files: list[int]) -> int:
        if "multiprocessing.forkserver" not in arguments[-1] or ours.fileno() < 0:
            return int(start(path, arguments, files))
        told = {"code": arguments[-1], "files": list(files), "environment": dict(os.environ)}
        with ours:
            socket.send_fds(ours, [json.dumps(told).encode()], list(files))
        return pid

    util.spawnv_passfds = spawn


def _fork_workers(told: dict[str, Any], files: list[int]) -> None:
    """Be multiprocessing's fork server, whose two files have other numbers here than its code says."""
    from multiprocessing import forkserver

    numbers, serve = dict(zip(told["files"], files, strict=True)), forkserver.main
    os.environ.clear()
    os.environ.update(told["environment"])
    forkserver.main = lambda listener, alive, *rest, **named: serve(numbers[listener], numbers[alive], *rest, **named)
    exec(told["code"], {"__name__": "__main__"})


if __name__ == "__main__":
    _main(socket.socket(fileno=int(sys.argv[1])))
