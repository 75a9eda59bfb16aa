"""The documentation site: it builds without a warning, its links resolve, and it loads nothing from elsewhere."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urljoin, urlsplit

import hatch_build
import pytest

import hookean
from soak import SOAK

pytestmark = pytest.mark.slow
pytest.importorskip("material", reason="what builds the site is not installed: pip install -e .[site]")

ROOT = Path(__file__).parents[2]
OWN = "http://site.invalid/docs/"
LOADED = {("script", "src"), ("img", "src"), ("link", "href"), ("source", "src"), ("iframe", "src"), ("object", "data")}


class Page(HTMLParser):
    """What a page names: its anchors, its links, what it loads; and what no policy of the service permits."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.anchors: set[str] = set()
        self.links: list[str] = []
        self.loaded: list[str] = []
        self.inline: list[str] = []
        self._script = False
        self.feed(text)

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        given = dict(attributes)
        self.anchors |= {value for name in ("id", "name") if (value := given.get(name))}
        self._script = tag == "script" and "src" not in given and given.get("type") != "application/json"
        self.inline += [f"{tag} {name}" for name in given if name == "style" or name.startswith("on")]
        self.inline += ["style"] * (tag == "style")
        for name, value in given.items():
            passive = tag == "link" and given.get("rel") in ("canonical", "prev", "next")
            if (tag, name) in LOADED and value and not passive:
                self.loaded.append(value)
            elif name == "href" and value:
                self.links.append(value)

    def handle_data(self, data: str) -> None:
        self.inline += ["script"] * bool(self._script and data.strip())
        self._script = False


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The site, without a warning, or it would not be there: that of these sources, or one built now."""
    if hatch_build.site_is_built() and not SOAK:
        return hatch_build.SITE
    folder = tmp_path_factory.mktemp("docs") / "site"
    command = [sys.executable, str(ROOT / "docsite" / "build.py"), str(folder)]
    done = subprocess.run(command, cwd=folder.parent, env=dict(os.environ), capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return folder


@pytest.fixture(scope="module")
def pages(site: Path) -> dict[str, Page]:
    """Every page by its place below /docs/."""
    found = {path.relative_to(site).as_posix(): Page(path.read_text("utf-8")) for path in site.rglob("*.html")}
    assert len(found) > 50
    return found


def target(page: str, link: str) -> tuple[str, str] | None:
    """File and anchor that a link of a page names; none beyond the site."""
    there = urlsplit(urljoin(OWN + page.removesuffix("index.html"), link))
    if f"{there.scheme}://{there.netloc}/docs/" != OWN:
        return None
    assert there.path.startswith("/docs/"), (page, link)
    name = unquote(there.path.removeprefix("/docs/"))
    return (f"{name}index.html" if name == "" or name.endswith("/") else name), unquote(there.fragment)


def test_every_link_and_anchor_resolves(site: Path, pages: dict[str, Page]) -> None:
    """Pages, pictures and headings; a link to a page ends in a slash, so that nothing is redirected."""
    broken = []
    for page, content in pages.items():
        for link in [*content.links, *content.loaded]:
            found = target(page, link)
            if found is None:
                continue
            file, anchor = found
            # the reference makes its anchors in the browser
            known = not anchor or file not in pages or anchor in pages[file].anchors or anchor == "__consent"
            if not (site / file).is_file() or not known:
                broken.append((page, link))
    assert not broken


def test_nothing_is_loaded_from_elsewhere(site: Path, pages: dict[str, Page]) -> None:
    """No script, style, font or picture of another origin, in pages and in style sheets; no source maps."""
    assert [(page, one) for page, content in pages.items() for one in content.loaded if re.match(r"\w+:|//", one)] == []
    for path in site.rglob("*.css"):
        found = re.findall(r"url\(['\"]?(.*?)['\"]?\)|@import\s+['\"](.*?)['\"]", path.read_text("utf-8"))
        assert [one for pair in found for one in pair if one and not one.startswith(("data:", "#"))] == [], path.name
    assert list(site.rglob("*.map")) == []


def test_pages_need_no_exception_from_the_policy(pages: dict[str, Page]) -> None:
    """No script, style or handler in a page, which the service's policy would refuse."""
    assert [(page, one) for page, content in pages.items() for one in content.inline] == []


def test_the_reference_has_every_public_name(pages: dict[str, Page]) -> None:
    anchors = pages["api/hookean/index.html"].anchors
    assert {name.rpartition(".")[2] for name in anchors if name.startswith("hookean.")} >= set(hookean.__all__) - {
        "Anchors"
    }
    client = pages["api/client/index.html"].anchors
    names = ("connect", "Problem", "client.Client", "sessions.Session", "sessions.Frames")
    assert {f"hookean_client.{name}" for name in names} <= client


def test_the_reference_of_http_is_of_this_service(site: Path) -> None:
    """The description beside it is what `GET /v1/openapi.json` answers, in words of OpenAPI 3.0: it is there without a
    token, too."""
    from docsite.reference import older

    from hookean_server.app import create_app
    from hookean_server.settings import Settings

    shown = json.loads((site / "http" / "openapi.json").read_text("utf-8"))
    assert shown == json.loads(json.dumps(older(create_app(Settings()).openapi())))


def test_every_force_has_its_formula(site: Path) -> None:
    """MathML beneath the heading of each kind."""
    from hookean.forces import KINDS

    text = (site / "forces" / "index.html").read_text("utf-8")
    for kind in KINDS:
        assert re.search(rf'<h2 id="{kind}">.*?</h2>\s*<div class="formula"><math', text, re.S), kind


def test_every_figure_is_in_the_gallery(site: Path, pages: dict[str, Page]) -> None:
    links = pages["gallery/index.html"].links
    for folder in (path.parent.name for path in (ROOT / "gh_examples").glob("*/README.md")):
        assert f"{folder}/" in links and (site / "gallery" / folder / "picture.png").is_file()


def test_search_knows_the_pages(site: Path) -> None:
    text = (site / "search" / "search_index.json").read_text("utf-8")
    for place in ("tutorials/cable/", "forces/#springs", "api/hookean/", "how-to/soap-film/"):
        assert f'"{place}' in text


def test_a_digest_names_the_sources(site: Path) -> None:
    """By it a package knows whether to build the site again."""
    assert (site / "sources.sha256").read_text() == hatch_build.site_digest()


def test_a_warning_fails_the_build(tmp_path: Path) -> None:
    """A page in the navigation that does not exist is a warning of MkDocs: exit code 1, and its name is printed."""
    source = ROOT / "docsite"
    (tmp_path / "docs").mkdir()
    (tmp_path / "docs" / "index.md").write_text("# Start\n")
    lines = [f"INHERIT: {source}/mkdocs.yml", "docs_dir: docs", f"hooks: [{source}/hooks.py]"]
    lines += [f"theme: {{custom_dir: {source}/theme}}", "nav: [nothing-here.md]"]
    (tmp_path / "mkdocs.yml").write_text("\n".join(lines))
    call = "import sys; from pathlib import Path; from docsite.build import pages; pages(*map(Path, sys.argv[1:]))"
    command = [sys.executable, "-c", call, str(tmp_path / "site"), str(tmp_path / "mkdocs.yml")]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 1 and "nothing-here.md" in done.stderr, done.stderr
    assert done.stderr.rstrip().endswith("The documentation has the mistakes above.")


@pytest.mark.parametrize(
    ("plain", "drawn"),
    [
        ("E = k (l - L0)²/2", r"E = \frac{k\,(l - L_0)^2}{2}"),
        ("E = EA u²/(2L) + GJ φ²/(2L)", r"E = \frac{EA\,u^2}{2L} + \frac{GJ\,\varphi^2}{2L}"),
        ("E = k (1/φ - 1/L)²/2, φ = Σ q/r", r"E = \frac{k\,(1/\varphi - 1/L)^2}{2}, \varphi = Σ \frac{q}{r}"),
        ("E = -p0 V0 ln(V/V0) + p_out V", r"E = -p_0\,V_0\,\mathrm{ln}(V/V_0) + p_{\mathrm{out}}\,V"),
    ],
)
def test_a_fraction_divides_its_term_alone(plain: str, drawn: str) -> None:
    """A formula as it is drawn divides what the plain one divides: a sum has one fraction for each term."""
    from docsite.hooks import tex

    assert tex(plain) == drawn
