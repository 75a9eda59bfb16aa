"""The scheduler of `conftest.py`: a run ends whichever worker dies."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

HERE = Path(__file__).parent
TESTS = {
    "test_a.py": """
import os, pathlib

def test_dies_once():
    died = pathlib.Path(__file__).with_name("died")
    if not died.exists():
        died.touch()
        os._exit(1)
""",
    "test_b.py": """
import pathlib, time

def test_is_busy_until_the_other_is_replaced():
    while not pathlib.Path(__file__).with_name("replaced").exists():
        time.sleep(0.01)
""",
    "test_c.py": "def test_waits_with_the_worker_that_dies(): pass",
    "test_d.py": "def test_is_the_last(): pass",
    "conftest.py": f"""
import pathlib
import runpy

pytest_xdist_make_scheduler = runpy.run_path({str(HERE / "conftest.py")!r})["pytest_xdist_make_scheduler"]

def pytest_collection_finish(session):
    here = pathlib.Path(__file__)
    if hasattr(session.config, "workerinput") and here.with_name("died").exists():
        here.with_name("replaced").touch()
""",
}


@pytest.mark.soak
def test_a_worker_that_dies_near_the_end_does_not_stop_the_run(tmp_path: Path) -> None:
    """One worker dies with two units of one test each. The one that replaces it ends them, with no more to come."""
    for name, text in TESTS.items():
        (tmp_path / name).write_text(text, "utf-8")
    (tmp_path / "none.ini").write_text("[pytest]\n", "utf-8")
    xdist = ["-n", "2", "--dist", "loadfile", "--no-loadscope-reorder"]
    command = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", "--rootdir", str(tmp_path), *xdist]
    done = subprocess.run(
        [*command, "-c", str(tmp_path / "none.ini"), "-o", f"pythonpath={HERE}", str(tmp_path)],
        cwd=tmp_path, capture_output=True, text=True, timeout=300,
    )  # fmt: skip
    assert done.returncode == 1, done.stdout + done.stderr
    assert "1 failed, 4 passed" in done.stdout and "crashed while running 'test_a.py::test_dies_once'" in done.stdout
