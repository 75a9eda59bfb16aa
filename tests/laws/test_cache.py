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


@pytest.fixture(scope="module")
def copied(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[str, str]]:
    """A copy of the package that nobody else edits, and the environment that uses it with a cache of its own."""
    top = tmp_path_factory.mktemp("cache")
    ignored = shutil.ignore_patterns("__pycache__")
    shutil.copytree(Path(hookean.__file__).parent, top / "package" / "hookean", ignore=ignored)
    cache = {"HOOKEAN_CACHE": str(top / "cache"), "PYTHONDONTWRITEBYTECODE": "1"}
    return top / "package" / "hookean", {"PYTHONPATH": str(top / "package"), **cache}


@pytest.fixture(scope="module")
def first(copied: tuple[Path, dict[str, str]]) -> Any:
    """What the first process of this cache finds of one spring."""
    return probe("energy", **copied[1])


def found(functions: dict[str, list[int]]) -> bool:
    """Whether every function was on the disk."""
    return all(hits > 0 and not misses for hits, misses in functions.values())


@pytest.mark.soak
@pytest.mark.slow
def test_the_second_process_compiles_nothing(copied: tuple[Path, dict[str, str]], first: Any) -> None:
    """One spring: in the first process its kernel, the loop and what is beside misses; in the second all of it hits."""
    second = probe("energy", **copied[1])
    assert set(first["functions"]) == set(second["functions"]) and len(first["functions"]) > 2
    assert {"springs_kernel", "relaxation_loop"} <= {name.rpartition(".")[2] for name in first["functions"]}
    assert all(misses > 0 for _, misses in first["functions"].values())
    assert found(second["functions"]), second


@pytest.mark.soak
def test_the_second_process_compiles_nothing_of_any_force(copied: tuple[Path, dict[str, str]], tmp_path: Path) -> None:
    """First process: every kernel, hook and loop misses. Second: every one of them hits, and none misses."""
    environment = {**copied[1], "HOOKEAN_CACHE": str(tmp_path)}
    first, second = probe("cache", **environment), probe("cache", **environment)
    assert set(first) == set(second) and len(first) > 10
    assert any("_loop" in name for name in first) and any("springs_kernel" in name for name in first)
    assert all(misses > 0 for _, misses in first.values())
    assert found(second), second


@pytest.mark.soak
@pytest.mark.slow
def test_an_edited_kernel_gives_the_new_answer_and_a_revert_is_found_again(
    copied: tuple[Path, dict[str, str]], first: Any
) -> None:
    """E = k s^2/2 = 50; with the kernel's tension doubled it is 100; reverted, 50 again without compiling.

    The relaxation loop, in a file of its own that was not edited, follows as well.
    """
    package, environment = copied
    assert first["energy"] == 50.0
    file = package / "forces" / "springs.py"
    text = file.read_text(encoding="utf-8")
    edited = text.replace("tension = k * (length - rest)", "tension = 2.0 * k * (length - rest)")
    assert edited != text
    file.write_text(edited, encoding="utf-8")
    try:
        changed = probe("energy", **environment)
    finally:
        file.write_text(text, encoding="utf-8")
    assert changed["energy"] == 100.0 and not found(changed["functions"])
    assert changed["moved"] - 1.0 == pytest.approx(2.0 * (first["moved"] - 1.0), rel=1e-12)
    again = probe("energy", **environment)
    assert {**again, "functions": {}} == {**first, "functions": {}} and found(again["functions"])
