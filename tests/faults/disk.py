"""A disk that fails on demand: a library preloaded into the server refuses the Nth write below a folder."""

from __future__ import annotations

import mmap
import shutil
import struct
import subprocess
import sys
from pathlib import Path

import pytest

from server.conftest import Served

SOURCE = Path(__file__).with_name("failing_disk.c")
_LAYOUT = struct.Struct("<5q")  # until, sticky, error, failed, seen


class Disk:
    """The folder `path`, and when writes below it fail. `sticky`: all after the first that fails do too."""

    def __init__(self, folder: Path) -> None:
        compiler = shutil.which("cc")
        if not sys.platform.startswith("linux") or compiler is None:
            pytest.skip("failing writes are injected by a preloaded library: this takes Linux and a C compiler")
        library, control = folder / "failing_disk.so", folder / "control"
        subprocess.run([compiler, "-shared", "-fPIC", "-O1", "-o", str(library), str(SOURCE), "-ldl"], check=True)
        control.write_bytes(bytes(4096))
        with control.open("r+b") as file:
            self._shared = mmap.mmap(file.fileno(), 4096)
        self.path = folder / "disk"
        self.path.mkdir()
        self._environment = {
            "LD_PRELOAD": str(library),
            "HOOKEAN_FAULT_FOLDER": str(self.path),
            "HOOKEAN_FAULT_CONTROL": str(control),
            "TMPDIR": str(self.path),
        }

    def serve(self, patch: pytest.MonkeyPatch) -> Served:
        """A server whose state and temporary files are on this disk."""
        with patch.context() as patched:
            for name, value in self._environment.items():
                patched.setenv(name, value)
            return Served(state=str(self.path / "sessions.db"), workers=1)

    def fail(self, number: int, error: int, *, sticky: bool) -> None:
        """The write of this number from now fails with `error`."""
        _LAYOUT.pack_into(self._shared, 0, number, sticky, error, 0, 0)

    def mend(self) -> int:
        """No write fails any more; how many have."""
        failed = int(_LAYOUT.unpack_from(self._shared)[3])
        _LAYOUT.pack_into(self._shared, 0, 0, 0, 0, 0, 0)
        return failed

    @property
    def names(self) -> set[str]:
        """What is on the disk, but for the folder of the sockets of the server's processes."""
        return {entry.name for entry in self.path.iterdir() if not any(entry.glob("listener-*"))}
