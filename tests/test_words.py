"""Documents use plain technical English: phrases that a reader has to decode are found, with the words to use instead.

Code, names in backticks, quotations of the software, addresses of links, and tables made from code are left out.
"""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from hookean_canvas.kangaroo import table

ROOT = Path(__file__).parents[1]
PAGES = [
    *(ROOT / name for name in ("README.md", "CHANGELOG.md", "CONTRIBUTING.md", "SECURITY.md")),
    *(page for page in sorted((ROOT / "docs").glob("**/*.md")) if page.name != "forces.md"),  # made from the classes
    *sorted((ROOT / "gh_examples").glob("**/README.md")),
    *sorted((ROOT / "core").glob("**/README.md")),
    ROOT / "components" / "README.md",
    ROOT / "benchmarks" / "results.md",
]

# pattern, the better words, a phrase that it has to find
AVOIDED = [
    (r"\banew\b", "again; regenerate", "takes the pictures anew"),
    (r"(?<!there )\b(is|are) none\b", "an invalid ..., an unknown ..., not a ...", "a row that is none"),
    (r"\b(tell|tells|told|says|said)\b", "report, warn, print, return, raise", "where it runs already, that is said"),
    (r"\bsay (what|so|how|where|which|that)\b", "report, print, describe", "a file may say how"),
    (r"\b(hear|hears|heard)\b", "receive", "the last numbers that were heard"),
    (r"\b(whoever|nobody|somebody|everybody)\b", "clients, users; no one by name", "for whoever draws"),
    (r"\bwhat is (what|no|looked|given|held|left)\b", "name the thing: an invalid scene", "what is no scene"),
    (r"\b(let in|gets? in)\b", "has access", "who is let in"),
    (r"(^|[.:;] )Who\b", "clients that ...; you ...", "Who works on the page has Node"),
    (r"\b(in the hand|the hand that|a hand that|answers the hand)\b", "controlled by you", "held in the hand"),
    (r"\bhangs? on nothing\b|\bnothing (holds|supports)\b", "is unsupported", "a part that nothing holds"),
    (r"\bstands?\b(?!-in)", "is, is listed, is shown; status", "how they stand"),
    (r"\b(goes|go|went) on\b", "continues", "the engine goes on"),
    (r"\b(unfit|fit to)\b", "invalid, unsupported; ready for", "a scene fit to move"),
    (r"\bheld to\b", "compared with", "the numbers it is held to"),
    (r"\btaken (back|for|as|along)\b", "revoked; undone; read as", "edits taken back"),
    (r"\bsprings? push\b|\bpush as well as\b", "springs are in compression", "some springs push"),
    (r"\bbeg[ia]ns? without length\b", "has zero length", "springs that begin without length"),
    (r"\bof our own\b|\bours\b", "hookean's; its own", "components of ours"),
    (r"\bgood for\b", "valid for", "a code that is good for one login"),
]

# on these pages a phrase stays: the page, and the words around it
ALLOWED = [("gh_examples/hanging-vault/README.md", "what hangs in tension stands in compression")]  # Hooke's


def prose(text: str) -> str:
    """The text with everything but prose blanked; each line stays where it is."""

    def blank(found: re.Match[str]) -> str:
        return "_" + "\n" * found[0].count("\n")

    text = text.replace(table.markdown(), "\n" * table.markdown().count("\n"))
    text = re.sub(r"<!-- (?:speed|all components).*?<!-- end.*?-->", blank, text, flags=re.S)
    text = re.sub(r"^```.*?^```$", blank, text, flags=re.S | re.M)
    text = re.sub(r"(?<=\n\n)(?: {4}.*\n)+", blank, text)
    text = re.sub(r"`[^`\n]*\n?[^`\n]*`|\"[^\"\n]*\n?[^\"\n]*\"", blank, text)
    return re.sub(r"<[^>\n]*>|\]\([^)\n]*\)", "", text)


@pytest.mark.parametrize("path", PAGES, ids=lambda p: str(p.relative_to(ROOT)))
def test_a_page_is_written_in_plain_words(path: Path) -> None:
    name, text = path.relative_to(ROOT).as_posix(), path.read_text(encoding="utf-8")
    for page, phrase in ALLOWED:
        text = text.replace(phrase, "") if page == name else text
    found = [
        f"{name}:{number}: {match[0].strip()!r}; better: {better}"
        for number, line in enumerate(prose(text).splitlines(), 1)
        for pattern, better, _ in AVOIDED
        for match in re.finditer(pattern, line)
    ]
    assert not found, "\n".join(found)


@pytest.mark.parametrize(("pattern", "better", "phrase"), AVOIDED, ids=[phrase for _, _, phrase in AVOIDED])
def test_a_pattern_finds_its_phrase(pattern: str, better: str, phrase: str) -> None:
    """In prose, and not in code or a quotation of the software."""
    assert better and re.search(pattern, prose(phrase))
    assert not re.search(pattern, prose(f'`{phrase}` and "{phrase}"\n\n```\n{phrase}\n```\n'))
