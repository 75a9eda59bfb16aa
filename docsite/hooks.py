"""Hooks of MkDocs: pages from the whole repository, formulas as MathML, no script within a page."""

from __future__ import annotations

import hashlib
import html
import posixpath
import re
import shutil
from pathlib import Path
from typing import Any

from latex2mathml.converter import convert
from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page
from mkdocs.utils import get_relative_url

from docsite.api import expand
from hookean.forces import KINDS

ROOT = Path(__file__).parents[1]
PROJECT = {
    "CHANGELOG.md": "project/changes.md",
    "CONTRIBUTING.md": "project/contributing.md",
    "benchmarks/results.md": "project/speed.md",
    "gh_examples/README.md": "gallery/index.md",
}
"""Pages that lie outside docs/, by their place in the repository."""
PLACES: dict[str, str] = {}
"""Place in the site of every page and picture, by its place in the repository."""
FENCE = re.compile(r"(^ *```.*?^ *```$)", re.S | re.M)
LINK = re.compile(r"(\]\()([^)\s#:]+)(#[^)\s]*)?(\))")


def on_files(files: Files, *, config: MkDocsConfig) -> Files:
    """Adds the pages of the project, the gallery and those of docsite/pages, and removes what is not in a page."""
    PLACES.clear()
    PLACES.update({f"docs/{file.src_uri}": file.src_uri for file in files if not file.abs_src_path or _is_doc(file)})
    added = dict(PROJECT)
    for folder in sorted(path.parent for path in (ROOT / "gh_examples").glob("*/README.md")):
        added[f"gh_examples/{folder.name}/README.md"] = f"gallery/{folder.name}/index.md"
        added |= {f"gh_examples/{folder.name}/{p.name}": f"gallery/{folder.name}/{p.name}" for p in folder.glob("*.png")}
    for path in (ROOT / "docsite" / "pages").rglob("*.md"):
        added[path.relative_to(ROOT).as_posix()] = path.relative_to(ROOT / "docsite" / "pages").as_posix()
    for place, uri in added.items():
        files.append(File.generated(config, uri, abs_src_path=str(ROOT / place)))
    PLACES.update(added)
    return files


def _is_doc(file: File) -> bool:
    return str(ROOT / "docs") in str(file.abs_src_path)


def on_page_markdown(markdown: str, *, page: Page, config: MkDocsConfig, files: Files) -> str:
    """Turns GitHub's Markdown into that of the site: links between folders, lists without a line before them."""
    place = next(place for place, uri in PLACES.items() if uri == page.file.src_uri)
    if place == "gh_examples/README.md":
        markdown = _gallery(markdown)
    if place == "docs/forces.md":
        markdown = re.sub(r"^## (\w+)$", lambda m: f"{m[0]}\n\n$$\n{tex(KINDS[m[1]].formula)}\n$$", markdown, flags=re.M)
    if place.startswith("gh_examples/"):
        title = re.search(r"^# (.*)$", markdown, re.M)
        markdown = markdown.replace("![](", f"![{title[1] if title else ''}](")
    if page.file.src_uri == "api/hookean.md":
        markdown = expand(markdown)
    parts = FENCE.split(markdown)
    for n in range(0, len(parts), 2):  # between the fences
        parts[n] = LINK.sub(lambda m: f"{m[1]}{_moved(m[2], place, page.file.src_uri)}{m[3] or ''}{m[4]}", parts[n])
        parts[n] = re.sub(r"^(?! *(?:[-*]|\d+\.) |\s*$|\|)(.+)\n(?=(?:[-*]|\d+\.) )", r"\1\n\n", parts[n], flags=re.M)
    return "".join(parts)


def _moved(target: str, place: str, uri: str) -> str:
    """A link of a page in the repository as one of that page in the site."""
    wanted = posixpath.normpath(posixpath.join(posixpath.dirname(place), target))
    found = PLACES.get(wanted) or PLACES.get(f"{wanted}/README.md")
    return posixpath.relpath(found, posixpath.dirname(uri) or ".") if found else target


def _gallery(markdown: str) -> str:
    """The figures as cards: a picture with its title, in rows."""
    head, *figures = re.split(r"^## ", markdown, flags=re.M)
    cards = []
    for figure in figures:
        name, folder, title = re.match(r"\[(.*?)\]\((.*?)\): (.*)", figure).groups()  # type: ignore[union-attr]
        picture = f'<img src="{folder}/picture.png" alt="" loading="lazy" width="640" height="400">'
        words = f"<strong>{html.escape(name)}</strong> {html.escape(title)}"
        cards.append(f'<a class="card" href="{folder}/">{picture}<span>{words}</span></a>')
    return "\n".join([head, '<div class="gallery">', *cards, "</div>", ""])


def tex(formula: str) -> str:
    """A formula of a force as TeX: `E = k (l - L0)²/2` is `E = \\frac{k\\,(l - L_0)^2}{2}`."""
    found = re.sub(r"([A-Zφθ])0", r"\1_0", formula).replace("²", "^2")
    found = re.sub(r"\^\(([^)]*)\)", r"^{\1}", found)
    found = re.sub(r"\|([^|]*)\|", r"\\lvert \1 \\rvert", found)
    found = re.sub(r"= (-?)(.*?) ?/ ?(?:\(([^)]*)\)|(\d+))$", lambda m: rf"= {m[1]}\frac{{{m[2]}}}{{{m[3] or m[4]}}}", found)
    found = re.sub(r"(?<=[\w)]) (?=[\w(\\](?!ge|le))", r"\\,", found)
    for sign, name in {"φ": r"\varphi ", "θ": r"\theta ", "μ": r"\mu ", "≥": r"\ge ", "≤": r"\le ", "·": r"\cdot "}.items():
        found = found.replace(sign, name)
    return found.replace("EI", r"E\!I")


def on_page_content(content: str, *, page: Page, config: MkDocsConfig, files: Files) -> str:
    """Formulas as MathML, which browsers draw without a script; tables in a box that scrolls."""
    content = re.sub(r'<span class="arithmatex">\\\((.*?)\\\)</span>', lambda m: _math(m[1], "inline"), content, flags=re.S)
    return re.sub(r'<div class="arithmatex">\s*\\\[(.*?)\\\]\s*</div>', lambda m: _math(m[1], "block"), content, flags=re.S)


def _math(text: str, display: str) -> str:
    return convert(html.unescape(text).strip(), display=display)


def on_post_page(output: str, *, page: Page, config: MkDocsConfig) -> str:
    """Moves scripts that stand in a page to files: the service's policy allows no others."""

    def moved(match: re.Match[str]) -> str:
        name = f"assets/javascripts/inline-{hashlib.sha256(match[1].encode()).hexdigest()[:12]}.js"
        file = Path(config.site_dir) / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(match[1], "utf-8")
        return f'<script src="{get_relative_url(name, page.url)}"></script>'

    return re.sub(r"<script>(.*?)</script>", moved, output, flags=re.S)


def on_post_build(*, config: MkDocsConfig) -> None:
    """Removes what only a site with an address of its own needs, maps of scripts, and search in other languages."""
    site = Path(config.site_dir)
    shutil.rmtree(site / "assets" / "javascripts" / "lunr", ignore_errors=True)
    for path in [site / "404.html", *site.glob("sitemap.*"), *site.rglob("*.map")]:
        path.unlink(missing_ok=True)
