"""The lowest versions of the dependencies that pyproject.toml states: an environment that has them, and tests in it.

    python tests/floors.py .venv/floors

Laws, core and a server's answers; what these versions warn of is no error here. Other packages are as new as they can
be beside them. `make floors` runs it.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tomllib
import venv
from pathlib import Path

ROOT = Path(__file__).parents[1]
TOOLS = ("httpx", "hypothesis", "psutil", "pytest", "pytest-xdist")
TESTS = ("tests/laws", "tests/core", "tests/server/test_relax.py")


def floors() -> list[str]:
    """Each dependency with its lowest version, as pip writes it."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    found = [re.fullmatch(r"([\w.-]+)>=([\w.]+)", stated) for stated in project["dependencies"]]
    assert all(found), "a dependency states no lowest version alone"
    return [f"{one[1]}=={one[2]}" for one in found if one]


def make(folder: Path) -> Path:
    """The Python of an environment with these versions and this tree, made anew where they have changed."""
    python = folder / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    stated, done = "\n".join(floors()), folder / "floors.txt"
    if not done.is_file() or done.read_text("utf-8") != stated:
        venv.create(folder, clear=True, with_pip=True)
        pip = [str(python), "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
        subprocess.run([*pip, *floors(), *TOOLS], check=True)
        subprocess.run([*pip, "--no-deps", "--editable", str(ROOT)], check=True)
        done.write_text(stated, "utf-8")
    return python


def main(folder: Path) -> int:
    """The exit code of the tests."""
    python = make(folder.resolve())
    command = [str(python), "-W", "default", "-m", "pytest", "-q", "-n", "2", "--dist", "loadfile", "-W", "default"]
    return subprocess.run([*command, "-p", "no:cacheprovider", "-m", "not slow", *TESTS], cwd=ROOT).returncode


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
