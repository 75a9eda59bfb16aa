"""Builds the documentation from docs/, gh_examples/ and the docstrings into server/hookean_server/site.

Warnings are errors. What is there already stays until the new one is complete. By hand: `make site`; another folder:
`python docsite/build.py FOLDER`.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).parent
# this tree, whatever is installed
TREE = [str(HERE.parent / folder) for folder in (".", "core", "server", "components", "canvas")]
sys.path[:0] = TREE

import hatch_build  # noqa: E402

REFERENCE = ("swagger-ui-bundle.js", "swagger-ui.css", "LICENSE", "NOTICE")


def build(into: Path) -> None:
    """Builds into a folder, which is replaced."""
    digest = hatch_build.site_digest()
    hatch_build.install(HERE)
    into.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=into.parent, prefix=".site-") as folder:
        made = Path(folder) / "site"
        pages(made)
        reference(made / "http")
        (made / "sources.sha256").write_text(digest)
        shutil.rmtree(into, ignore_errors=True)
        made.rename(into)


def pages(into: Path, config: Path = HERE / "mkdocs.yml") -> None:
    """The pages by MkDocs; exits with its words where there is a warning."""
    command = [sys.executable, "-m", "mkdocs", "build", "--strict", "-f", str(config)]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(TREE), "NO_MKDOCS_2_WARNING": "1"}
    done = subprocess.run([*command, "-d", str(into)], env=environment, capture_output=True, text=True)
    if done.returncode:
        print(done.stdout + done.stderr, file=sys.stderr)
        sys.exit("The documentation has the mistakes above.")


def reference(into: Path) -> None:
    """The files beside the page of the HTTP reference: Swagger UI and the description of the service."""
    from docsite.reference import older

    from hookean_server.app import create_app
    from hookean_server.settings import Settings

    for name in REFERENCE:
        shutil.copy(HERE / "node_modules" / "swagger-ui-dist" / name, into / name)
    described = create_app(Settings()).openapi()
    (into / "openapi.json").write_text(json.dumps(older(described), ensure_ascii=False), "utf-8")


if __name__ == "__main__":
    build(Path(sys.argv[1]) if sys.argv[1:] else hatch_build.SITE)
