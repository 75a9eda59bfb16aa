"""Texts of the software are plain technical English: phrases that read as riddles have a standard one in its place.

Checked are all string literals and docstrings of the Python sources, the strings and comments of the page's sources,
and the texts of component bundles. Terms of one's own choice cannot be checked; these are the phrases a pattern can
find.
"""

from __future__ import annotations

import ast
import json
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
HOMES = ("core", "server", "canvas", "components")

BETTER = {
    r"\b(?:anew|afresh)\b": "again; to write a file again: rewrite, regenerate; to start again: restart",
    r"\bwhoever\b": "clients that ..., all users",
    r"(?<!there )\b(?:is|are) (?-i:none)\b": 'invalid X, unknown X, "is not an X", "is not one of"',
    r"\bwhat is no\b": '"anything that is not a ..."',
    r"\b(?:tells?|told) (?:you|that|so|what|how|of|whether|which|about)\b": "report, warn, print, return",
    r"\b(?:is|are|was|were) (?:told|said)\b": "is reported, is printed, you are warned",
    r"\b(?:is|are|was|were) heard\b": "is received",
    r"\b(?:says|said) (?:so|what|that|how|which|whether)\b": "report, print, state",
    r"\bsays (?:of|about) (?:itself|themselves)\b": '"description of ..."',
    r"\bis let in\b|\blets? [a-z ]+ in\b|\bget(?:s|ting)? in\b": "authenticate; clients with the token",
    r"\bheld in the hand\b": "controlled by you",
    r"\bbegin without length\b|\bwithout length\b": "have zero length",
    r"\bhangs? on nothing\b": "is unsupported",
}
"""Pattern (any case), and what to write instead."""
ANY = re.compile("|".join(f"(?:{pattern})" for pattern in BETTER), re.IGNORECASE)

ALLOWED = {
    "core/hookean/files/recipe/recipe.py": ("hangs on nothing",),
}
"""Phrases that a file needs, such as those that it reads."""


def texts(path: Path) -> Iterator[tuple[int, str]]:
    """The texts in a source file, each with the number of its line."""
    source = path.read_text(encoding="utf-8")
    if path.suffix == ".py":
        yield from python_texts(ast.parse(source))
    elif path.suffix == ".json":
        yield from ((0, text) for text in json_texts(json.loads(source)))
    else:
        yield from enumerate(source.splitlines(), 1)


def python_texts(tree: ast.AST) -> Iterator[tuple[int, str]]:
    """String literals and docstrings; an f-string as one text, {} in place of its values."""
    waiting = [tree]
    while waiting:
        node = waiting.pop()
        if isinstance(node, ast.JoinedStr):
            parts = [str(part.value) if isinstance(part, ast.Constant) else "{}" for part in node.values]
            yield node.lineno, "".join(parts)
            waiting += [part.value for part in node.values if isinstance(part, ast.FormattedValue)]
        elif isinstance(node, ast.Constant):
            if isinstance(node.value, str):
                yield node.lineno, node.value
        else:
            waiting += ast.iter_child_nodes(node)


def json_texts(value: object) -> Iterator[str]:
    """All strings in a JSON document."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, dict | list):
        for part in value.values() if isinstance(value, dict) else value:
            yield from json_texts(part)


def faults(path: Path) -> list[str]:
    """A line for each phrase to replace: where it is, what it is, what to write instead."""
    name = path.relative_to(ROOT).as_posix()
    found = []
    for line, text in texts(path):
        flat = " ".join(text.split())
        for pattern, better in BETTER.items() if ANY.search(flat) else ():
            for match in re.finditer(pattern, flat, re.IGNORECASE):
                if match[0].lower() not in ALLOWED.get(name, ()):
                    spot = flat[max(0, match.start() - 40) : match.end() + 20]
                    found.append(f'{name}:{line}: "{match[0]}" in "{spot}"; write {better}')
    return found


def test_python_texts_are_plain() -> None:
    """Messages, help, descriptions and docstrings of all packages."""
    found = [line for home in HOMES for path in sorted((ROOT / home).rglob("*.py")) for line in faults(path)]
    assert not found, "\n".join(found)


def test_page_texts_are_plain() -> None:
    """Labels, tooltips, notices and comments of the page."""
    sources = sorted(path for ending in ("ts", "tsx") for path in (ROOT / "studio/src").rglob(f"*.{ending}"))
    found = [line for path in (*sources, ROOT / "studio/index.html") for line in faults(path)]
    assert sources and not found, "\n".join(found)


def test_component_texts_are_plain() -> None:
    """Descriptions and tooltips of the components on the canvas."""
    bundles = sorted((ROOT / "components").glob("*/metadata.json"))
    found = [line for path in bundles for line in faults(path)]
    assert bundles and not found, "\n".join(found)


@pytest.mark.parametrize(
    "text",
    ["kind sprngs is none; there are springs", "Start it anew.", "you are told so", "Whoever asks", "it tells what"],
)
def test_patterns_find_what_they_are_for(text: str) -> None:
    """One example of each kind of phrase is found."""
    assert any(re.search(pattern, text, re.IGNORECASE) for pattern in BETTER)
