"""What the service allows: sizes, times and places. Every limit has a default that suits one person's machine."""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from pathlib import Path

MIB = 2**20


def _quota() -> int:
    """Bytes that the store may take, from HOOKEAN_QUOTA in MiB. Raises ValueError."""
    given = os.environ.get("HOOKEAN_QUOTA") or "8192"
    if not (given.isascii() and given.isdigit()):
        raise ValueError(
            f"HOOKEAN_QUOTA is {given[:20]!r}; it accepts a whole number of MiB, such as 8192, or 0 for no limit"
        )
    return int(given) * MIB


@dataclass(frozen=True)
class Settings:
    """Limits of one server. Sizes in bytes, times in seconds."""

    host: str = "127.0.0.1"
    port: int = 8765
    workers: int = 0
    """Processes that solve; 0: one for each core, at most four."""
    queue: int = 16
    """Requests that may wait or be read while all workers are busy; the next one is answered 503."""
    visits: int = 8
    """Requests without a token that may wait or be read; the next one is answered 503. See `visits`."""
    visit_limit: int = 160 * MIB
    """Largest answer to a request without a token, as estimated from the request."""
    json_limit: int = 16 * MIB
    file_limit: int = 64 * MIB
    header_limit: int = 16 * 1024
    body_seconds: float = 30.0
    """Time a client has to send its body."""
    write_seconds: float = 30.0
    """Time a client may read nothing of an answer that waits for it; of a large one, also each MiB more takes a second
    at most."""
    solve_seconds: float = 300.0
    """Longest solve; a scene with a longer or no `time_limit` ends here with the status `time_limit`."""
    file_seconds: float = 180.0
    """Longest solve of an uploaded file; it ends here with the status `time_limit`."""
    read_seconds: float = 60.0
    """Longest time for reading one file: of computing, and twice that by the clock."""
    grace_seconds: float = 10.0
    """What a worker may take beyond these before it is stopped by force."""
    cancel_seconds: float = 1.5
    """What a worker may take to notice that its client has left before it is stopped by force."""
    worker_memory: int = 4096 * MIB
    """Memory one worker may allocate, where the system can limit it."""
    largest_count: int = 1_000_000
    """Most points, pieces or faces an operation may be asked to make."""
    state: Path | str | None = None
    """The file that sessions and jobs are stored in; None: they end with the server."""
    quota: int = field(default_factory=lambda: _quota())
    """Bytes that this file may take, by default the MiB of HOOKEAN_QUOTA, or 8 GiB; 0: any number."""
    backups: int = 3
    """Copies of the file as it was at its last starts."""
    sessions: int = 200
    """Most sessions kept."""
    awake: int = 16
    """Most sessions that have a process, which is what it takes to run, to be edited or watched."""
    sleep_seconds: float = 60.0
    """A session that rests and is not watched for so long is put to sleep: it stays in the store only."""
    session_seconds: float = 24 * 3600.0
    """A session that nobody used for so long, while the server ran, is forgotten."""
    jobs: int = 100
    """Most jobs that wait or run."""
    kept_jobs: int = 1000
    """Most jobs kept that have ended; they are forgotten like sessions, too."""
    items: int = 100_000
    """Most items of one sweep; each may take `solve_seconds`."""
    job_seconds: float = 24 * 3600.0
    """Longest relaxation of a job; a scene with a longer or no `time_limit` ends here."""
    dask: str = field(default_factory=lambda: os.environ.get("HOOKEAN_DASK", ""))
    """Address of a Dask scheduler that sweeps are sent to, by default that of HOOKEAN_DASK; None: they run here."""
    message_limit: int = 64 * 1024
    """Longest message of a client over a WebSocket."""
    token: str = field(default="", repr=False)
    """The token of clients; default: that of HOOKEAN_TOKEN, or a random one for each start."""
    log: str = ""
    """`json`: a line of JSON for each request and event, as with HOOKEAN_LOG=json; else only what is wrong."""
    origins: tuple[str, ...] = ()
    """Origins, such as http://localhost:3000, whose pages may use the service, with the token."""
    header_seconds: float = 30.0
    """Time a client has to send the headers of a request."""
    hosts: tuple[str, ...] = ()
    """Further names the service answers to, besides 127.0.0.1, localhost and [::1]."""
    page: Path | str = field(default_factory=lambda: Path(__file__).with_name("page"))
    """The folder of the page that browsers get."""
    site: Path | str = field(default_factory=lambda: Path(__file__).with_name("site"))
    """The folder of the documentation."""

    @property
    def lanes(self) -> int:
        """How many workers there are."""
        return self.workers or max(1, min(os.cpu_count() or 1, 4))
