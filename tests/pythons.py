"""Other Pythons on this machine: those of pyenv, and those on the path."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from functools import cache
from pathlib import Path


@cache
def interpreter(version: str) -> str | None:
    """The newest Python of a version, such as "3.9", that runs; None where there is none."""
    if sys.version_info[:2] == tuple(map(int, version.split("."))):
        return sys.executable
    found = [str(path) for root in _roots() for path in sorted(root.glob(f"versions/{version}.*/bin/python"))[::-1]]
    for python in [*found, shutil.which(f"python{version}")]:
        if python and _says(python) == version:
            return python
    return None


def _roots() -> list[Path]:
    """Where pyenv keeps its versions: by its variable, at home, and by its programs on the path."""
    shim = shutil.which("pyenv") or shutil.which("python2.7")
    told = [os.environ.get("PYENV_ROOT"), str(Path.home() / ".pyenv"), shim and str(Path(shim).parents[1])]
    return [Path(root) for root in dict.fromkeys(told) if root and Path(root, "versions").is_dir()]


def _says(python: str) -> str:
    """The version that an interpreter says it is; "" where it does not run, as a shim of none."""
    try:
        code = "import sys; print('%d.%d' % sys.version_info[:2])"
        return subprocess.run([python, "-c", code], capture_output=True, text=True, timeout=60).stdout.strip()
    except (OSError, subprocess.TimeoutExpired):
        return ""
