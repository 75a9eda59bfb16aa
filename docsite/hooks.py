"""Hooks of MkDocs: pages from the whole repository, formulas as MathML, no script within a page."""

from __future__ import annotations

import hashlib
import html
import posixpath
import re
import shutil
from pathlib import Path

from docsite.api import expand
from latex2mathml.converter import convert
from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page
from mkdocs.utils import get_relative_url

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
SIGNS = {"φ": r"\varphi", "θ": r"\theta", "μ": r"\mu", "≥": r"\ge", "≤": r"\le", "·": r" \cdot "}
FIGURE = re.compile(r"^## \[(.*?)\]\((.*?)\): (.*)$", re.M)
LONG = re.compile(r"(?<=<code>)[^<]{20,}(?=</code>)")
"""Code that would make a column of a table too wide for the others."""
LINK = re.compile(r"(?<=\[)([^\[\]]*)\]\(([^)\s#:]+)(#[^)\s]*)?\)")


def on_config(config: MkDocsConfig) -> MkDocsConfig:
    """Puts the figures of the gallery into the navigation, in the gallery's order."""
    listed = FIGURE.findall((ROOT / "gh_examples" / "README.md").read_text("utf-8"))
    for section in config.nav or []:
        if "Gallery" in section:
            section["Gallery"] += [{f"{name}: {title}": f"gallery/{folder}/index.md"} for name, folder, title in listed]
    return config


def on_files(files: Files, *, config: MkDocsConfig) -> Files:
    """Adds the pages of the project, the gallery and those of docsite/pages, and removes what is not in a page."""
    PLACES.clear()
    PLACES.update({f"docs/{file.src_uri}": file.src_uri for file in files if not file.abs_src_path or _is_doc(file)})
    added = dict(PROJECT)
    for folder in sorted(path.parent for path in (ROOT / "gh_examples").glob("*/README.md")):
        added[f"gh_examples/{folder.name}/README.md"] = f"gallery/{folder.name}/index.md"
        added |= {
            f"gh_examples/{folder.name}/{p.name}": f"gallery/{folder.name}/{p.name}" for p in folder.glob("*.png")
        }
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
        page.meta["hide"] = ["navigation", "toc"]
    if place == "benchmarks/results.md":
        page.meta["hide"] = ["toc"]  # its tables are wide
    if place == "docs/forces.md":
        markdown = _forces(markdown)
    if place.startswith("gh_examples/"):
        title = re.search(r"^# (.*)$", markdown, re.M)
        markdown = markdown.replace("![](", f"![{title[1] if title else ''}](")
    if page.file.src_uri == "api/hookean.md":
        markdown = expand(markdown)
    parts = FENCE.split(markdown)
    for n in range(0, len(parts), 2):  # between the fences
        parts[n] = LINK.sub(lambda m: _link(m, place, page.file.src_uri), parts[n])
        parts[n] = re.sub(r"^(?!(?:[-*]|\d+\.)? |\||\s*$)(.+)\n(?=(?:[-*]|\d+\.) )", r"\1\n\n", parts[n], flags=re.M)
    return "".join(parts)


def _link(match: re.Match[str], place: str, uri: str) -> str:
    """A link of a page in the repository as one of that page in the site; a file's name becomes the page's title."""
    text, target, anchor = match[1], match[2], match[3] or ""
    wanted = posixpath.normpath(posixpath.join(posixpath.dirname(place), target))
    wanted = wanted if wanted in PLACES else f"{wanted}/README.md"
    if wanted not in PLACES:
        return match[0]  # MkDocs warns
    if text == posixpath.basename(target):
        title = re.search(r"^# (.*)$", (ROOT / wanted).read_text("utf-8"), re.M)
        text = title[1] if title else text
    return f"{text}]({posixpath.relpath(PLACES[wanted], posixpath.dirname(uri) or '.')}{anchor})"


def _forces(markdown: str) -> str:
    """The formula of every force, below its heading and in the table of all."""
    lines = []
    for line in markdown.splitlines():
        kind = re.match(r"(?:## |\| \[`)(\w+)(?:$|`\])", line)
        if kind and kind[1] in KINDS:
            plain, formula = KINDS[kind[1]].formula.replace("|", "\\|"), tex(KINDS[kind[1]].formula)
            line = (
                line.replace(f"| {plain} |", f"| ${formula}$ |") if line[0] == "|" else f"{line}\n\n$$\n{formula}\n$$"
            )
        lines.append(line)
    return "\n".join(lines) + "\n"


def _gallery(markdown: str) -> str:
    """The figures as cards: a picture with its title, in rows."""
    cards = []
    for name, folder, title in FIGURE.findall(markdown):
        picture = f'<img src="{folder}/picture.png" alt="" loading="lazy" width="640" height="400">'
        words = f"<strong>{html.escape(name)}</strong> {html.escape(title)}"
        cards.append(f'<a class="card" href="{folder}/">{picture}<span>{words}</span></a>')
    return "\n".join([markdown.partition("\n## ")[0], "", '<div class="gallery">', *cards, "</div>", ""])


def tex(formula: str) -> str:
    """A formula of a force as TeX: `E = k (l - L0)²/2` is `E = \\frac{k\\,(l - L_0)^2}{2}`."""
    clauses = []
    for clause in formula.split(", "):
        left, equals, right = clause.rpartition("= ")
        clauses.append("".join([left, equals, *map(_fraction, _terms(right))]))
    found = re.sub(r"(?<=[\w)]) (?=[\w(|])", r"\\,", ", ".join(clauses))
    found = re.sub(
        r"_([a-z]{2,})", r"_{\\mathrm{\1}}", re.sub(r"(?<!\\)\b([a-z]{4,}|ln|tr)(?![a-z])", r"\\mathrm{\1}", found)
    )
    found = re.sub(r"(?<![A-Za-z])([A-Za-zφθ])(\d)", r"\1_\2", found).replace("²", "^2").replace("EI", r"E\!I")
    found = re.sub(r"\^\(([^)]*)\)", r"^{\1}", found)
    found = re.sub(r"\|([^|]*)\|", r"\\left\\vert \1 \\right\\vert", found)
    for sign, name in SIGNS.items():
        found = found.replace(sign, name)
    return found


def _terms(total: str) -> list[str]:
    """The terms of a sum and the signs between them; what is in brackets or bars is one."""
    found = [""]
    for piece in re.split(r"( [+-] )", total):
        whole = found[-1].count("(") == found[-1].count(")") and found[-1].count("|") % 2 == 0
        if whole and piece in (" + ", " - "):
            found += [piece, ""]
        else:
            found[-1] += piece
    return found


def _fraction(term: str) -> str:
    """What is divided at the end of a term, as a fraction; the sign of a sum stands before it."""
    divided = re.fullmatch(r"(-?(?:Σ )?)(.*?) ?/ ?(?:\(([^()]*)\)|(\w+))", term)
    return rf"{divided[1]}\frac{{{divided[2]}}}{{{divided[3] or divided[4]}}}" if divided else term


def on_page_content(content: str, *, page: Page, config: MkDocsConfig, files: Files) -> str:
    """Formulas as MathML, which browsers draw without a script; long code of tables with places where it may break."""
    content = re.sub(r"(<td[^>]*>)(.*?)(?=</td>)", lambda m: m[1] + LONG.sub(_breakable, m[2]), content, flags=re.S)
    content = re.sub(
        r'<span class="arithmatex">\\\((.*?)\\\)</span>', lambda m: _math(m[1], "inline"), content, flags=re.S
    )
    return re.sub(
        r'<div class="arithmatex">\s*\\\[(.*?)\\\]\s*</div>', lambda m: _math(m[1], "block"), content, flags=re.S
    )


def _breakable(match: re.Match[str]) -> str:
    """Code of a table that may break at its spaces and after the signs below."""
    return re.sub(r"(?<=[\w{}])(?:[/_,(.]|::)(?=\w)", r"\g<0><wbr>", match[0]) + "<wbr>"


def _math(text: str, display: str) -> str:
    drawn: str = convert(html.unescape(text).strip(), display=display)
    return f'<div class="formula">{drawn}</div>' if display == "block" else drawn


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
