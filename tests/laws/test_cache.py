"""Compiled kernels are found again by the next process, and never stale."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

import hookean

ROOT = Path(__file__).parents[2]
LONGEST = 3600.0
"""Seconds after which a process hangs: compiling every kernel takes a minute of a processor that does nothing else."""


def probe(mode: str, **environment: str) -> Any:
    """What `tests.laws.probe` prints in a fresh process."""
    done = subprocess.run(
        [sys.executable, "-W", "error", "-m", "tests.laws.probe", mode],
        cwd=ROOT, env={**os.environ, **environment}, capture_output=True, text=True, timeout=LONGEST,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr[-3000:]
    return json.loads(done.stdout)


@pytest.fixture
def copied(tmp_path: Path) -> tuple[Path, dict[str, str]]:
    """A copy of the package that nobody else edits, and the environment that uses it with an empty cache."""
    home = tmp_path / "package"
    ignored = shutil.ignore_patterns("__pycache__")
    shutil.copytree(Path(hookean.__file__).parent, home / "hookean", ignore=ignored)
    cache = {"HOOKEAN_CACHE": str(tmp_path / "cache"), "PYTHONDONTWRITEBYTECODE": "1"}
    return home / "hookean", {"PYTHONPATH": str(home), **cache}


def test_the_second_process_compiles_nothing(copied: tuple[Path, dict[str, str]]) -> None:
    """First process: every kernel, hook and loop misses. Second: every one of them hits, and none misses."""
    _, environment = copied
    first, second = probe("cache", **environment), probe("cache", **environment)
    assert set(first) == set(second) and len(first) > 10
    assert any("_loop" in name for name in first) and any("springs_kernel" in name for name in first)
    assert all(misses > 0 for _, misses in first.values())
    assert {name for name, (hits, misses) in second.items() if hits < 1 or misses} == set()


def test_an_edited_kernel_gives_the_new_answer_and_a_revert_is_found_again(copied: tuple[Path, dict[str, str]]) -> None:
    """E = k s^2/2 = 50; with the kernel's tension doubled it is 100; reverted, 50 again without compiling.

    The relaxation loop, in a file of its own that was not edited, follows as well.
    """
    package, environment = copied
    before = probe("energy", **environment)
    assert before["energy"] == 50.0 and before["hits"] == 0
    file = package / "forces" / "springs.py"
    text = file.read_text(encoding="utf-8")
    edited = text.replace("tension = k * (length - rest)", "tension = 2.0 * k * (length - rest)")
    assert edited != text
    file.write_text(edited, encoding="utf-8")
    changed = probe("energy", **environment)
    assert changed["energy"] == 100.0 and changed["hits"] == 0
    assert changed["moved"] - 1.0 == pytest.approx(2.0 * (before["moved"] - 1.0), rel=1e-12)
    file.write_text(text, encoding="utf-8")
    again = probe("energy", **environment)
    assert again == {**before, "hits": 1}
