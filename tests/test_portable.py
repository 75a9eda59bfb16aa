"""It works where there is no fork and no Unix module: the core's tests run with those taken away."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]

BARE = """
import importlib.abc, multiprocessing, os, pkgutil, importlib, sys

class Absent(importlib.abc.MetaPathFinder):
    def find_spec(self, name, path=None, target=None):
        if name in ("resource", "fcntl", "pwd", "grp", "termios"):
            raise ModuleNotFoundError(f"No module named {name!r} (not on this system)", name=name)

for name in ("resource", "fcntl", "pwd", "grp", "termios"):
    sys.modules.pop(name, None)
sys.meta_path.insert(0, Absent())
for name in ("fork", "forkpty", "register_at_fork"):
    if hasattr(os, name):
        delattr(os, name)
multiprocessing.set_start_method("spawn")
multiprocessing.get_all_start_methods = lambda: ["spawn"]
"""


def run(code: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-c", BARE + code], cwd=ROOT, capture_output=True, text=True, timeout=500, check=False
    )


def test_every_module_imports_without_unix_modules():
    """All modules of the three packages, one after the other."""
    done = run(
        "import hookean, hookean_server, hookean_client\n"
        "for package in (hookean, hookean_server, hookean_client):\n"
        "    for found in pkgutil.walk_packages(package.__path__, package.__name__ + '.'):\n"
        "        if not found.name.endswith('__main__'):\n"
        "            importlib.import_module(found.name)\n"
        "            print(found.name)\n"
    )
    assert done.returncode == 0, done.stderr
    assert "hookean.running.run" in done.stdout


@pytest.mark.soak
def test_the_cores_tests_pass_without_unix_modules():
    """The chapter, the cables, the nets, and a file written and read back."""
    done = run(
        "import pytest\n"
        "sys.exit(pytest.main(['-q', '-p', 'no:cacheprovider', '-p', 'no:xdist', '-p', 'no:faulthandler',"
        " '--capture=sys', 'tests/core/test_chapter.py', 'tests/core/test_cables.py', 'tests/core/test_nets.py']))\n"
    )
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
    assert " passed" in done.stdout
